//! `pleach import`: maps of other programs as scenarios.

use super::arguments::ImportArguments;
use super::output;
use super::remarks;
use super::source::STANDARD;
use super::status::{Failure, Status};
use pleach::automaton::network::scenario::{LONGEST_NAME, Remark};
use pleach::import::{self, Choices, Reading};
use std::path::Path;

/// Reads a map and writes a scenario.
pub fn import(arguments: &ImportArguments) -> Result<Status, Failure> {
    output::check_places(&import::files(&arguments.map)?, &arguments.output)?;
    let reading = Reading {
        tolerance: arguments.tolerance,
        scale: arguments.scale,
        planar: arguments.planar,
    };
    let plan = import::read(&arguments.map, &reading)?;
    let choices = Choices {
        name: arguments.name.clone().unwrap_or_else(|| name_of(&arguments.map)),
        full_range: arguments.full_range,
        max_range: arguments.max_range,
        clearance: arguments.clearance,
        access_points: arguments.access_point.iter().map(|place| place.0).collect(),
        robots: usize::from(arguments.robots),
        tasks: arguments.task.iter().map(|place| place.0).collect(),
        far_tasks: usize::from(arguments.far_tasks),
    };
    let (scenario, more) = import::skeleton(&plan, &choices)?;
    let notes: Vec<String> = plan.notes.iter().cloned().chain(more).collect();
    for note in &notes {
        output::tell(format_args!("{}: {note}", arguments.map.display()));
    }
    // What was repaired is among the notes.
    let remarks = scenario.remarks();
    for line in
        remarks::lines(remarks.iter().filter(|remark| !matches!(remark, Remark::Outline(_))))
    {
        output::tell(format_args!("{}: {line}", arguments.map.display()));
    }
    let origin = arguments.map.file_name().unwrap_or_default().to_string_lossy();
    let text = import::text(&scenario, &origin, &notes);
    output::write(arguments.output.as_deref().unwrap_or(Path::new(STANDARD)), &text)?;
    Ok(Status::Done)
}

/// A name for the scenario: that of the file, with `-` for what cannot be in a name, as far as a name may be long.
fn name_of(map: &Path) -> String {
    let stem = map.file_stem().unwrap_or_default().to_string_lossy();
    let mut name: String =
        stem.chars().map(|c| if c.is_alphanumeric() || c == '_' { c } else { '-' }).collect();
    name.truncate(name.floor_char_boundary(LONGEST_NAME));
    if name.is_empty() { "map".into() } else { name }
}
