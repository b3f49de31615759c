//! Scenarios as files for people.

use crate::automaton::network::scenario::{AccessPoint, LinkRanges, RobotStart, Scenario};
use std::fmt::Write;

/// The scenario as a file for people: places in rows, with comments; the first of the notes, the account of the floor,
/// stands in the first line.
pub fn text(scenario: &Scenario, origin: &str, notes: &[String]) -> String {
    let (account, notes) =
        notes.split_first().map_or(("", notes), |(first, rest)| (first.as_str(), rest));
    let mut text = format!("# {}: {}.\n", in_a_line(origin), in_a_line(account));
    for note in notes {
        // Writing into a text does not fail.
        let _ = writeln!(text, "# - {}", in_a_line(note));
    }
    let _ = write!(text, "\nname = {:?}\n\n[workspace]\n", scenario.name);
    let _ = writeln!(text, "boundary = {}", polygon(&scenario.workspace.boundary, ""));
    if !scenario.workspace.holes.is_empty() {
        text += "holes = [\n";
        for hole in &scenario.workspace.holes {
            let _ = writeln!(text, "    {},", polygon(hole, "    "));
        }
        text += "]\n";
    }
    let LinkRanges { full_range, max_range, .. } = scenario.link;
    let _ = write!(
        text,
        "\n[link] # links reach through walls: choose ranges that hold through them\n\
         full_range = {full_range}\nmax_range = {max_range}\n"
    );
    if let Some(clearance) = scenario.control.clearance {
        let _ = write!(text, "\n[control]\nclearance = {clearance}\n");
    }
    for AccessPoint { position } in &scenario.access_point {
        let _ = write!(text, "\n[[access_point]]\nposition = {position:?}\n");
    }
    for RobotStart { position, rate, .. } in &scenario.robot {
        let _ = write!(text, "\n[[robot]]\nposition = {position:?}\nrate = {rate}\n");
    }
    for task in &scenario.task {
        // A task has numbers only, which can be written.
        let _ = write!(text, "\n[[task]]\n{}", toml::to_string(task).unwrap_or_default());
    }
    text
}

/// A text as a comment can hold it: line breaks and other control characters are escaped.
fn in_a_line(text: &str) -> String {
    let escaped = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.into() };
    text.chars().map(escaped).collect()
}

/// A polygon with a few corners in each line.
fn polygon(ring: &[[f64; 2]], indent: &str) -> String {
    const IN_A_LINE: usize = 6;
    let line = |corners: &[[f64; 2]]| {
        let corners: Vec<String> = corners.iter().map(|corner| format!("{corner:?}")).collect();
        format!("{indent}    {},\n", corners.join(", "))
    };
    format!("[\n{}{indent}]", ring.chunks(IN_A_LINE).map(line).collect::<String>())
}
