//! Tables of an automaton.

use pleach_discrete::{Event, Location};
use pleach_guards::Valuation;

use super::sketch::{Mode, Sketch};
use crate::automaton::Automaton;
use crate::outline::{Arrow, Outline, Source, Transition};

/// The automaton in Markdown: the full location × event table; below it guard and reset, a row an
/// event where all its transitions agree, and else a row a transition or superstate; and, where time changes or
/// restricts anything, flow and invariant of every location, and what is chosen there at samples.
///
/// The name of a guard is left out where it is the formula itself.
pub fn table<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> String {
    let mut text = automaton.table().to_markdown();
    text.push_str(&parts(&automaton.outline()));
    text
}

fn parts(automaton: &Outline<'_>) -> String {
    let mut text = format!("\n{}", markdown(&transitions(automaton)));
    if !automaton.superstates.is_empty() {
        text.push('\n');
        text.push_str(&markdown(&superstates(automaton)));
    }
    let modes = modes(&Sketch::of(automaton));
    if modes.len() > 1 {
        text.push('\n');
        text.push_str(&markdown(&modes));
    }
    text
}

/// Column by column: its head and its cells.
type Columns = Vec<(&'static str, Vec<String>)>;

const NOTHING: &str = "—";

fn transitions(automaton: &Outline<'_>) -> Columns {
    let rows = rows(automaton);
    let column = |cell: &dyn Fn(&Row<'_>) -> String| rows.iter().map(cell).collect();
    let event = |row: &Row<'_>| format!("**{}**", automaton.events[row.transition.event]);
    let mut columns: Columns = vec![("event", column(&event))];
    if rows.iter().any(|row| row.stands == Stands::Alone) {
        columns.push(("transition", column(&|row| row.way(automaton))));
    }
    let has_name = |row: &Row<'_>| {
        let guard = row.transition.guard;
        guard.name() != guard.predicate().to_string()
    };
    if rows.iter().any(has_name) {
        let name = |row: &Row<'_>| match has_name(row) {
            true => row.transition.guard.name().to_owned(),
            false => NOTHING.to_owned(),
        };
        columns.push(("guard", column(&name)));
    }
    columns.push(("holds where", column(&|row| row.transition.guard.predicate().to_string())));
    columns.push(("reset", column(&|row| or_nothing(row.transition.effect.to_string()))));
    columns
}

/// A row of the table.
struct Row<'a> {
    arrow: Arrow,
    transition: &'a Transition<'a>,
    stands: Stands,
}

/// What a row stands for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stands {
    /// One of the arrows on its event, which differ.
    Alone,
    /// The only arrow on its event.
    Only,
    /// All transitions on its event.
    ForAll,
}

impl Row<'_> {
    fn way(&self, automaton: &Outline<'_>) -> String {
        if self.stands == Stands::ForAll {
            return "all".to_owned();
        }
        let name = |location: usize| automaton.modes[location].name;
        match (self.arrow.source, self.arrow.target) {
            (Source::Location(source), target) => {
                format!("{} → {}", name(source), name(target.unwrap_or(source)))
            }
            (Source::Superstate(number), Some(target)) => {
                format!("*{}* → {}", automaton.superstates[number].0, name(target))
            }
            (Source::Superstate(number), None) => {
                format!("*{}*, stays", automaton.superstates[number].0)
            }
        }
    }
}

fn rows<'a>(automaton: &'a Outline<'a>) -> Vec<Row<'a>> {
    let arrows = automaton.arrows();
    let mut rows = Vec::new();
    for event in 0..automaton.events.len() {
        let of = |arrow: &Arrow| &automaton.transitions[arrow.transitions[0]];
        let of_event: Vec<_> = arrows.iter().filter(|arrow| of(arrow).event == event).collect();
        let stands = match &of_event[..] {
            [_] => Stands::Only,
            [first, others @ ..]
                if others.iter().all(|other| of(first).reads_like(of(other)))
                    && is_one_from_each_source(automaton, event) =>
            {
                Stands::ForAll
            }
            _ => Stands::Alone,
        };
        let shown = if stands == Stands::ForAll { 1 } else { of_event.len() };
        rows.extend(of_event.into_iter().take(shown).map(|arrow| Row {
            arrow: arrow.clone(),
            transition: of(arrow),
            stands,
        }));
    }
    rows
}

/// Whether the location × event table shows all transitions on an event: no location has two.
fn is_one_from_each_source(automaton: &Outline<'_>, event: usize) -> bool {
    let on_event = automaton.transitions.iter().filter(|transition| transition.event == event);
    let mut sources: Vec<usize> = on_event.map(|transition| transition.source).collect();
    sources.sort_unstable();
    sources.is_sorted_by(|one, next| one < next)
}

/// The superstates, with their locations.
fn superstates(automaton: &Outline<'_>) -> Columns {
    let all = || automaton.superstates.iter();
    let locations = |members: &[usize]| -> String {
        let names: Vec<&str> = members.iter().map(|&it| automaton.modes[it].name).collect();
        names.join(", ")
    };
    vec![
        ("superstate", all().map(|(name, _)| format!("*{name}*")).collect()),
        ("locations", all().map(|(_, members)| locations(members)).collect()),
    ]
}

/// The locations, with what is said of any of them.
fn modes(sketch: &Sketch) -> Columns {
    let all = || sketch.modes.iter();
    let column = |cell: &dyn Fn(&Mode) -> String| -> Vec<String> {
        all().map(|mode| or_nothing(cell(mode))).collect()
    };
    let mut columns: Columns = vec![("location", column(&|mode| format!("**{}**", mode.name)))];
    if all().any(|mode| !mode.flow.is_empty() || mode.invariant.is_some()) {
        let invariant = |mode: &Mode| mode.invariant.clone().unwrap_or_default();
        columns.push(("flow", column(&|mode| mode.flow.join(", "))));
        columns.push(("time passes while", column(&invariant)));
    }
    if all().any(|mode| !mode.commands.is_empty()) {
        let chosen = |mode: &Mode| -> String {
            let cases: Vec<&str> = mode.commands.iter().map(|(_, case)| case.as_str()).collect();
            cases.join("; else ")
        };
        columns.push(("chosen at a sample", column(&chosen)));
    }
    columns
}

fn or_nothing(text: String) -> String {
    if text.is_empty() { NOTHING.to_owned() } else { text }
}

/// A bar would end the cell.
fn markdown(columns: &Columns) -> String {
    let row = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let mut text = row(columns.iter().map(|(head, _)| (*head).to_owned()).collect());
    text.push_str(&row(columns.iter().map(|_| "---".to_owned()).collect()));
    let height = columns.first().map_or(0, |(_, cells)| cells.len());
    for number in 0..height {
        let cells = columns.iter().map(|(_, cells)| cells[number].replace('|', r"\|"));
        text.push_str(&row(cells.collect()));
    }
    text
}
