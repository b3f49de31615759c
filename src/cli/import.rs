//! `pleach import`: maps of other programs as scenarios.

use super::arguments::ImportArguments;
use super::output;
use super::remarks;
use super::source::STANDARD;
use super::status::{Failure, Status};
use pleach::automaton::network::scenario::{LONGEST_NAME, Remark};
use pleach::import::{self, Choices, Reading};
use pleach::task_list;
use std::path::Path;

/// Reads a map and writes a scenario.
pub(super) fn import(arguments: &ImportArguments) -> Result<Status, Failure> {
    output::check_places(
        &import::files(&arguments.map)?,
        arguments.output.iter().chain(&arguments.look),
    )?;
    let reading = Reading {
        tolerance: arguments.tolerance,
        scale: arguments.scale,
        planar: arguments.planar,
        resolution: arguments.resolution,
        clearance: arguments.robot_radius,
        accepted_loss: arguments.accept_loss / 100.0,
        specks: arguments.specks,
        wall_width: arguments.wall_width,
        level: arguments.level.clone(),
        walls: arguments.wall.clone(),
        floors: arguments.floor.clone(),
    };
    let plan = import::read(&arguments.map, &reading)?;
    let listed = arguments.tasks.as_deref().map(task_list::read).transpose()?.unwrap_or_default();
    let choices = Choices {
        name: arguments.name.clone().unwrap_or_else(|| name_of(&arguments.map)),
        radio: arguments.radio,
        full_range: arguments.full_range,
        max_range: arguments.max_range,
        clearance: arguments.robot_radius,
        access_points: arguments.access_point.clone(),
        robots: usize::from(arguments.robots),
        near: arguments.near.clone(),
        tasks: arguments.task.clone(),
        listed_tasks: listed.into_iter().map(|listed| listed.task).collect(),
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
    match &arguments.look {
        Some(page) => {
            let page_text = import::page(
                &plan,
                &scenario,
                &choices,
                &notes,
                &command(std::env::args().skip(1)),
            );
            output::write(page, &page_text)?;
            output::say(&format!("page: open {}\n", page.display()))?;
        }
        None => {
            let text = import::text(&scenario, &origin, &notes);
            output::write(arguments.output.as_deref().unwrap_or(Path::new(STANDARD)), &text)?;
        }
    }
    Ok(Status::Done)
}

/// The call without the options that a page sets, as a shell reads it.
fn command(arguments: impl Iterator<Item = String>) -> String {
    const SET: [&str; 6] =
        ["--access-point", "--far-tasks", "--look", "--near", "--robots", "--task"];
    let mut words = vec!["pleach".to_owned()];
    let mut is_value = false;
    for word in arguments {
        let option = word.split('=').next().unwrap_or_default();
        let is_set = SET.contains(&option);
        if !is_value && !is_set {
            words.push(quoted(&word));
        }
        is_value = is_set && option == word;
    }
    words.join(" ")
}

/// A word as a shell takes it for one.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:+%@".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

/// A name for the scenario: that of the file, with `-` for what cannot be in a name, as far as a name may be long.
fn name_of(map: &Path) -> String {
    let stem = map.file_stem().unwrap_or_default().to_string_lossy();
    let mut name: String =
        stem.chars().map(|c| if c.is_alphanumeric() || c == '_' { c } else { '-' }).collect();
    name.truncate(name.floor_char_boundary(LONGEST_NAME));
    if name.is_empty() { "map".into() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_repeats_the_call_but_for_what_it_sets() {
        let call = [
            "import",
            "my map.svg",
            "--robots",
            "9",
            "--scale=0.1",
            "--task=1,2",
            "--look",
            "a.html",
            "--name",
            "x",
            "--output",
            "x.toml",
        ];
        let command = command(call.into_iter().map(String::from));
        assert_eq!(command, "pleach import 'my map.svg' --scale=0.1 --name x --output x.toml");
    }
}
