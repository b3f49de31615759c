//! `pleach diagram`.

use super::arguments::{Automaton as Which, DiagramArguments, DiagramFormat};
use super::status::{Failure, Status};
use pleach::automaton::network::{dealing_automaton, duty_automaton, mission_automaton};
use pleach::automaton::{Automaton, diagram};
use pleach::discrete::{Event, Location};
use pleach::guards::Valuation;

/// Prints the drawing of an automaton.
pub fn print(arguments: &DiagramArguments) -> Result<Status, Failure> {
    let internal = |error: pleach::automaton::BuildError| Failure::Internal(error.to_string());
    let drawing = match arguments.automaton {
        Which::Duty => draw(&duty_automaton().map_err(internal)?, arguments.format),
        Which::Exchange => draw(&dealing_automaton().map_err(internal)?, arguments.format),
        Which::Mission => draw(&mission_automaton().map_err(internal)?, arguments.format),
    };
    println!("{}", drawing.trim_end());
    Ok(Status::Done)
}

fn draw<L: Location, E: Event, S: Valuation>(
    automaton: &Automaton<L, E, S>,
    format: DiagramFormat,
) -> String {
    match format {
        DiagramFormat::Mermaid => diagram::mermaid(automaton),
        DiagramFormat::Dot => diagram::dot(automaton),
        DiagramFormat::Svg => diagram::svg(automaton),
    }
}
