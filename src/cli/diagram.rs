//! `pleach diagram`.

use super::arguments::{Automaton as Which, DiagramArguments, DiagramFormat};
use super::output;
use super::status::{Failure, Status};
use pleach::automaton::network::Automata;
use pleach::automaton::{Automaton, diagram};
use pleach::discrete::{Event, Location};
use pleach::guards::Valuation;

/// Prints the drawing of an automaton.
pub(super) fn print(arguments: &DiagramArguments) -> Result<Status, Failure> {
    let automata = Automata::new().map_err(|error| Failure::Internal(error.to_string()))?;
    let format = arguments.format;
    let drawing = match arguments.automaton {
        Which::Duty => draw(&automata.duty, format),
        Which::Exchange => draw(&automata.exchange, format),
        Which::Mission => draw(&automata.mission, format),
        Which::Place => draw(&automata.attachment, format),
        Which::Control => draw(&automata.control, format),
        Which::Service => draw(&automata.service, format),
        Which::Attendance => draw(&automata.attendance, format),
        Which::Rounds => draw(&automata.rounds, format),
        Which::Request => draw(&automata.request, format),
    };
    output::say(&format!("{}\n", drawing.trim_end()))?;
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
