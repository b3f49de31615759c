//! Pictures as SVG documents: arcs between boxes for models as textbooks draw them, and columns
//! for everything larger.

mod arcs;
mod canvas;
mod columns;
mod composition;
mod overview;

use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::Valuation;

use super::sketch::{MISSED, Sketch};
use crate::automaton::Automaton;
use crate::coverage::ComponentCoverage;
use canvas::{Canvas, Size};

pub use composition::composition_svg;
pub use overview::overview_svg;

/// The automaton as an SVG document. Transitions that only may be taken are dashed, and those that
/// happen at once are bold.
///
/// Up to four locations are drawn as boxes in a row, joined by arcs; more locations, very many transitions, or
/// superstates, as columns that the arrows cross, with a bracket over the columns of a superstate.
pub fn svg<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> String {
    let (canvas, size) = draw(&Sketch::of(&automaton.outline()));
    canvas.finish(size)
}

/// The automaton as an SVG document in which everything that runs have left out is red, and says
/// so. `coverage` is that of a component which runs this automaton.
pub fn coverage_svg<L: Location, E: Event, S: Valuation>(
    automaton: &Automaton<L, E, S>,
    coverage: &ComponentCoverage,
) -> String {
    let mut sketch = Sketch::of(&automaton.outline());
    coverage.mark(&mut sketch);
    let (canvas, size) = draw(&sketch);
    canvas.finish(size)
}

fn draw(sketch: &Sketch) -> (Canvas, Size) {
    if arcs::suit(sketch) { arcs::draw(sketch) } else { columns::draw(sketch) }
}

/// The classes of an arrow.
fn stroke_class(urgency: Urgency, is_missed: bool) -> String {
    let class = match urgency {
        Urgency::May => "may",
        Urgency::Must => "must",
        Urgency::AtOnce => "at-once",
    };
    if is_missed { format!("{class} missed") } else { class.to_owned() }
}

/// The class of a line of a label: the first names the transition.
fn label_class(number: usize, line: &str) -> &'static str {
    match number {
        0 => "name",
        _ if line == MISSED => "missed-text",
        _ => "condition",
    }
}

/// Breaks a line between words, where it becomes longer than `length` characters.
fn wrapped(line: &str, length: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in line.split(' ') {
        match lines.last_mut() {
            Some(last) if last.chars().count() + 1 + word.chars().count() <= length => {
                last.push(' ');
                last.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Breaks a formula where it becomes longer than `length` characters: before a ∧ or ∨ if that is
/// enough, else between words.
fn broken(formula: &str, length: usize) -> Vec<String> {
    let mut clauses: Vec<String> = vec![String::new()];
    for word in formula.split(' ') {
        let starts_clause = matches!(word, "∧" | "∨");
        match clauses.last_mut() {
            Some(last) if !starts_clause => {
                if !last.is_empty() {
                    last.push(' ');
                }
                last.push_str(word);
            }
            _ => clauses.push(word.to_owned()),
        }
    }
    let mut lines: Vec<String> = Vec::new();
    for clause in clauses {
        match lines.last_mut() {
            Some(last) if last.chars().count() + 1 + clause.chars().count() <= length => {
                last.push(' ');
                last.push_str(&clause);
            }
            _ => lines.extend(wrapped(&clause, length)),
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_break_before_their_operators() {
        assert_eq!(broken("[h ≤ 0 ∧ v < 0]", 20), ["[h ≤ 0 ∧ v < 0]"]);
        assert_eq!(broken("[h ≤ 0 ∧ v < 0]", 12), ["[h ≤ 0", "∧ v < 0]"]);
        assert_eq!(broken("a + b + c ≤ 0", 5), ["a + b", "+ c ≤", "0"]);
    }
}
