//! The formal definition of an automaton in LaTeX.

use std::fmt::Write as _;

use petgraph::visit::EdgeRef;
use pleach_discrete::{Event, Location};
use pleach_guards::{constant, variable};

use crate::automaton::{Automaton, Transition};
use crate::coordinates::Coordinates;
use crate::flow::DOTTED;
use crate::flow::Flow;
use crate::reset::NewValue;

/// H = (Q, X, Init, f, Inv, E, G, R) with the sets and maps of this automaton (Lygeros et al. 2003,
/// [doi:10.1109/TAC.2002.806650](https://doi.org/10.1109/TAC.2002.806650)), as an `align*` of the
/// package amsmath; the sets of numbers are of amssymb.
///
/// An edge is (source, event, target) with its urgency and priority behind it. X is the box of the
/// ranges that are declared. What is a function and not a formula stands under its name. Names of
/// other scripts than Latin and Greek need LuaLaTeX or XeLaTeX.
pub fn latex<L: Location, E: Event, S: Coordinates>(automaton: &Automaton<L, E, S>) -> String {
    let mut definition = Definition { lines: Vec::new() };
    definition.put("H", r"(Q, X, \mathrm{Init}, f, \mathrm{Inv}, E, G, R)");
    let names: Vec<String> =
        automaton.locations().iter().map(|location| text(location.name())).collect();
    definition.put("Q", &set(&names));
    definition.put("X", &states(automaton));
    definition.put(r"\mathrm{Init}", &initial(automaton));
    let modes = automaton
        .locations()
        .iter()
        .map(|&location| (text(location.name()), automaton.mode(location)));
    let modes: Vec<_> = modes.filter_map(|(name, mode)| Some((name, mode?))).collect();
    for (name, mode) in &modes {
        definition.put(&format!("f({name}, x)"), &flow(automaton.names(), mode.flow.as_ref()));
    }
    for (name, mode) in &modes {
        let invariant = mode.invariant.as_ref().map(|invariant| invariant.to_latex());
        definition.put(&format!(r"\mathrm{{Inv}}({name})"), &where_it_holds(invariant));
    }
    let graph = automaton.graph();
    let numbers = || (1..).zip(graph.edge_references());
    let edges: Vec<String> = numbers().map(|(number, _)| format!("e_{{{number}}}")).collect();
    definition.put("E", &set(&edges));
    for (number, edge) in numbers() {
        let Transition { event, urgency, priority, .. } = edge.weight();
        let ends = [graph[edge.source()].name(), event.name(), graph[edge.target()].name()];
        let [source, event, target] = ends.map(text);
        let how = format!(r"\quad\text{{({urgency}, {priority})}}");
        definition.put(&format!("e_{{{number}}}"), &format!("({source}, {event}, {target}) {how}"));
    }
    for (number, edge) in numbers() {
        let guard = &edge.weight().guard;
        let is_always = *guard.predicate() == pleach_guards::always();
        let formula = (!is_always).then(|| guard.predicate().to_latex());
        definition.put(&format!("G(e_{{{number}}})"), &where_it_holds(formula));
    }
    for (number, edge) in numbers() {
        definition.put(&format!("R(e_{{{number}}}, x)"), &reset(automaton.names(), edge.weight()));
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

fn states<L: Location, E: Event, S: Coordinates>(automaton: &Automaton<L, E, S>) -> String {
    let number = |value: f64| constant(value).to_latex();
    let ranges = automaton.names().iter().map(|name| {
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
    format!(r"{product}, \quad x = {}", column(&names(automaton.names())))
}

fn initial<L: Location, E: Event, S: Coordinates>(automaton: &Automaton<L, E, S>) -> String {
    let location = text(automaton.initial().name());
    match automaton.initial_state() {
        None => format!(r"\{{{location}\}} \times X"),
        Some(state) => {
            let values: Vec<String> =
                state.to_values().into_iter().map(|value| constant(value).to_latex()).collect();
            let state = column(&values);
            format!(r"\left\{{\left({location}, {state}\right)\right\}}")
        }
    }
}

/// The rates of all coordinates, or the name of the flow.
fn flow<S>(names: &[&'static str], flow: Option<&Flow<S>>) -> String {
    let rates = match flow {
        None => Some(&[][..]),
        Some(flow) => flow.rates(),
    };
    match (rates, flow) {
        (Some(rates), _) => column(&of_coordinates(names, |name| {
            let rate = rates.iter().find(|rate| rate.coordinate() == name);
            rate.map_or_else(|| "0".to_owned(), |rate| rate.rate().to_latex())
        })),
        (None, flow) => flow.map_or_else(String::new, |flow| text(&flow.name())),
    }
}

/// What becomes of all coordinates, or the name of the reset.
fn reset<E, S>(names: &[&'static str], transition: &Transition<E, S>) -> String {
    match transition.reset.assignments() {
        Some([]) => "x".to_owned(),
        Some(assignments) => column(&of_coordinates(names, |name| {
            let assignment = assignments.iter().find(|one| one.coordinate() == name);
            assignment.map_or_else(|| variable(name).to_latex(), |one| new_value(one.value()))
        })),
        None => text(&transition.reset.name()),
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
