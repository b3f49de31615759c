//! The formal definition of an automaton in LaTeX.

use std::fmt::Write as _;

use pleach_discrete::{Event, Location};
use pleach_guards::{constant, variable};

use crate::automaton::Automaton;
use crate::coordinates::Coordinates;
use crate::flow::DOTTED;
use crate::outline::{Effect, Motion, Outline, Transition};
use crate::reset::NewValue;

/// H = (Q, X, Init, f, Inv, E, G, R) with the sets and maps of this automaton (Lygeros et al. 2003,
/// [doi:10.1109/TAC.2002.806650](https://doi.org/10.1109/TAC.2002.806650)), as an `align*` of the
/// package amsmath; the sets of numbers are of amssymb.
///
/// An edge is (source, event, target) with its urgency and priority behind it. X is the box of the
/// ranges that are declared. What is a function and not a formula stands under its name. Names of
/// other scripts than Latin and Greek need LuaLaTeX or XeLaTeX.
pub fn latex<L: Location, E: Event, S: Coordinates>(automaton: &Automaton<L, E, S>) -> String {
    let values = automaton.initial_state().map(Coordinates::to_values);
    definition(&automaton.outline(), automaton.names(), values)
}

/// The definition over coordinates of these names, which start with these values, if they are known.
fn definition(automaton: &Outline<'_>, names: &[&'static str], values: Option<Vec<f64>>) -> String {
    let mut definition = Definition { lines: Vec::new() };
    definition.put("H", r"(Q, X, \mathrm{Init}, f, \mathrm{Inv}, E, G, R)");
    let locations: Vec<String> = automaton.modes.iter().map(|mode| text(mode.name)).collect();
    definition.put("Q", &set(&locations));
    definition.put("X", &states(automaton, names));
    definition.put(r"\mathrm{Init}", &initial(&locations[automaton.initial], values));
    for (location, mode) in locations.iter().zip(&automaton.modes) {
        definition.put(&format!("f({location}, x)"), &flow(names, mode.flow));
    }
    for (location, mode) in locations.iter().zip(&automaton.modes) {
        let invariant = mode.invariant.map(|invariant| invariant.to_latex());
        definition.put(&format!(r"\mathrm{{Inv}}({location})"), &where_it_holds(invariant));
    }
    let numbers = || (1..).zip(&automaton.transitions);
    let edges: Vec<String> = numbers().map(|(number, _)| format!("e_{{{number}}}")).collect();
    definition.put("E", &set(&edges));
    for (number, edge) in numbers() {
        let Transition { source, event, target, urgency, priority, .. } = edge;
        let (source, target) = (&locations[*source], &locations[*target]);
        let event = text(automaton.events[*event]);
        let how = format!(r"\quad\text{{({urgency}, {priority})}}");
        definition.put(&format!("e_{{{number}}}"), &format!("({source}, {event}, {target}) {how}"));
    }
    for (number, edge) in numbers() {
        let is_always = *edge.guard.predicate() == pleach_guards::always();
        let formula = (!is_always).then(|| edge.guard.predicate().to_latex());
        definition.put(&format!("G(e_{{{number}}})"), &where_it_holds(formula));
    }
    for (number, edge) in numbers() {
        definition.put(&format!("R(e_{{{number}}}, x)"), &reset(names, edge.effect));
    }
    definition.finish()
}

/// Equations, aligned at their equals signs.
struct Definition {
    lines: Vec<String>,
}

impl Definition {
    fn put(&mut self, left: &str, right: &str) {
        self.lines.push(format!("  {left} &= {right}"));
    }

    fn finish(self) -> String {
        format!("\\begin{{align*}}\n{}\n\\end{{align*}}\n", self.lines.join(" \\\\\n"))
    }
}

fn set(members: &[String]) -> String {
    match members.is_empty() {
        true => r"\emptyset".to_owned(),
        false => format!(r"\{{{}\}}", members.join(", ")),
    }
}

/// All states, or those where the formula holds.
fn where_it_holds(formula: Option<String>) -> String {
    formula.map_or_else(|| "X".to_owned(), |formula| format!(r"\{{x \in X \mid {formula}\}}"))
}

/// A state as the column of its coordinates.
fn column(entries: &[String]) -> String {
    match entries {
        [] => "()".to_owned(),
        [single] => single.clone(),
        several => format!(r"\begin{{pmatrix}} {} \end{{pmatrix}}", several.join(r" \\ ")),
    }
}

fn names(coordinates: &[&'static str]) -> Vec<String> {
    coordinates.iter().map(|name| variable(name).to_latex()).collect()
}

fn states(automaton: &Outline<'_>, coordinates: &[&'static str]) -> String {
    let number = |value: f64| constant(value).to_latex();
    let ranges = coordinates.iter().map(|name| {
        let range = automaton.range(name);
        let (lower, upper) = (*range.start(), *range.end());
        match (lower.is_finite(), upper.is_finite()) {
            (true, true) => format!("[{}, {}]", number(lower), number(upper)),
            (true, false) => format!(r"[{}, \infty)", number(lower)),
            (false, true) => format!(r"(-\infty, {}]", number(upper)),
            (false, false) => r"\mathbb{R}".to_owned(),
        }
    });
    let ranges: Vec<String> = ranges.collect();
    let product = match &ranges[..] {
        [] => r"\{()\}".to_owned(),
        all if all.iter().all(|range| range == r"\mathbb{R}") && all.len() > 1 => {
            format!(r"\mathbb{{R}}^{{{}}}", all.len())
        }
        some => some.join(r" \times "),
    };
    format!(r"{product}, \quad x = {}", column(&names(coordinates)))
}

fn initial(location: &str, values: Option<Vec<f64>>) -> String {
    match values {
        None => format!(r"\{{{location}\}} \times X"),
        Some(values) => {
            let values: Vec<String> =
                values.into_iter().map(|value| constant(value).to_latex()).collect();
            let state = column(&values);
            format!(r"\left\{{\left({location}, {state}\right)\right\}}")
        }
    }
}

/// The rates of all coordinates, or the name of the flow.
fn flow(names: &[&'static str], flow: Option<Motion<'_>>) -> String {
    match flow.unwrap_or(Motion::Rates(&[])) {
        Motion::Rates(rates) => column(&of_coordinates(names, |name| {
            let rate = rates.iter().find(|rate| rate.coordinate() == name);
            rate.map_or_else(|| "0".to_owned(), |rate| rate.rate().to_latex())
        })),
        Motion::Function(name) => text(name),
    }
}

/// What becomes of all coordinates, or the name of the reset.
fn reset(names: &[&'static str], reset: Effect<'_>) -> String {
    match reset {
        Effect::Assignments([]) => "x".to_owned(),
        Effect::Assignments(assignments) => column(&of_coordinates(names, |name| {
            let assignment = assignments.iter().find(|one| one.coordinate() == name);
            assignment.map_or_else(|| variable(name).to_latex(), |one| new_value(one.value()))
        })),
        Effect::Function(name) => text(name),
    }
}

fn new_value(value: &NewValue) -> String {
    match value {
        NewValue::Exactly(value) => value.to_latex(),
        NewValue::Within(lower, upper) => {
            format!(r"\left[{}, {}\right]", lower.to_latex(), upper.to_latex())
        }
    }
}

fn of_coordinates(names: &[&'static str], entry: impl Fn(&'static str) -> String) -> Vec<String> {
    names.iter().map(|name| entry(name)).collect()
}

/// Words in upright type within mathematics.
fn text(words: &str) -> String {
    const DOT_ABOVE: char = '\u{307}';
    let mut escaped = String::new();
    let mut letters = words.chars().peekable();
    while let Some(letter) = letters.next() {
        // Writing into a string cannot fail.
        let _ = match letter {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => write!(escaped, r"\{letter}"),
            '\\' => write!(escaped, r"\textbackslash{{}}"),
            '~' => write!(escaped, r"\textasciitilde{{}}"),
            '^' => write!(escaped, r"\textasciicircum{{}}"),
            '−' => write!(escaped, "$-$"),
            '·' => write!(escaped, r"$\cdot$"),
            '×' => write!(escaped, r"$\times$"),
            '÷' => write!(escaped, r"$\div$"),
            '≤' => write!(escaped, r"$\le$"),
            '≥' => write!(escaped, r"$\ge$"),
            '<' => write!(escaped, "$<$"),
            '>' => write!(escaped, "$>$"),
            '∧' => write!(escaped, r"$\land$"),
            '∨' => write!(escaped, r"$\lor$"),
            '¬' => write!(escaped, r"$\lnot$"),
            '→' => write!(escaped, r"$\to$"),
            '…' => write!(escaped, r"\ldots{{}}"),
            _ if letters.next_if_eq(&DOT_ABOVE).is_some() => write!(escaped, r"\.{{{letter}}}"),
            _ => match undotted(letter) {
                Some(plain) => write!(escaped, r"\.{{{plain}}}"),
                None => write!(escaped, "{}", in_text(letter)),
            },
        };
    }
    format!(r"\text{{{escaped}}}")
}

/// The letter without the dot above it, if it has one.
fn undotted(letter: char) -> Option<char> {
    DOTTED.iter().find(|(_, dotted)| *dotted == letter).map(|(plain, _)| *plain)
}

/// Greek letters as mathematics.
fn in_text(letter: char) -> String {
    let formula = variable(&letter.to_string()).to_latex();
    if letter.is_alphabetic() && formula.starts_with('\\') {
        format!("${formula}$")
    } else {
        letter.to_string()
    }
}
