//! What locations and transitions say about themselves, the same in every kind of diagram.

use petgraph::visit::EdgeRef;
use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::{Expression, Valuation, constant};

use crate::automaton::{Automaton, Transition};
use crate::reset::Reset;

/// An automaton in words, without its types: diagrams only have to arrange it.
#[derive(Clone, Debug)]
pub(crate) struct Sketch {
    /// In the order of `L::ALL`.
    pub modes: Vec<Mode>,
    /// In the order of the rows of the table.
    pub links: Vec<Link>,
    /// The number of the initial location.
    pub initial: Option<usize>,
    /// The state in which runs start, a variable a line; empty where the model does not say it.
    pub start: Vec<String>,
}

/// A location.
#[derive(Clone, Debug)]
pub(crate) struct Mode {
    pub name: &'static str,
    /// The rates, each by itself; or the name of the flow.
    pub flow: Vec<String>,
    pub invariant: Option<String>,
    /// What is chosen at each sample, without the conditions, and with them.
    pub commands: Vec<(String, String)>,
    /// Whether runs have left it out.
    pub is_missed: bool,
}

/// A transition.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub source: usize,
    pub target: usize,
    /// Its number among those that leave the source, in their total order.
    pub rank: usize,
    pub event: String,
    /// The number of the event in `E::ALL`.
    pub event_number: usize,
    /// The formula.
    pub guard: String,
    /// The assignments, each by itself; or the name of the reset.
    pub reset: Vec<String>,
    pub urgency: Urgency,
    pub priority: u8,
    /// Whether runs have left it out.
    pub is_missed: bool,
}

/// What is said of a part that runs have left out.
pub(super) const MISSED: &str = "never taken";

impl Sketch {
    pub fn of<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> Sketch {
        let mode = |&location: &L| {
            let mode = automaton.mode(location);
            let flow = mode.and_then(|mode| mode.flow.as_ref());
            let flow = flow.map_or_else(Vec::new, |flow| match flow.rates() {
                Some(rates) => rates.iter().map(ToString::to_string).collect(),
                None => vec![flow.name().into_owned()],
            });
            let invariant = mode.and_then(|mode| mode.invariant.as_ref()).map(ToString::to_string);
            let commands = mode.map_or(&[][..], |mode| &mode.commands);
            let commands = commands
                .iter()
                .map(|it| (format!("{} := {}", it.commanded, it.name), it.to_string()))
                .collect();
            Mode { name: location.name(), flow, invariant, commands, is_missed: false }
        };
        let rank = |edge| {
            let ranks = automaton
                .leaving
                .iter()
                .filter_map(|leaving: &Vec<_>| leaving.iter().position(|listed| *listed == edge));
            ranks.min().unwrap_or_default()
        };
        let edges = automaton.graph().edge_references();
        Sketch {
            modes: automaton.graph().node_weights().map(mode).collect(),
            links: edges
                .map(|edge| {
                    let (source, target) = (edge.source().index(), edge.target().index());
                    let event = &edge.weight().event;
                    let number = automaton.events().iter().position(|one| one == event);
                    Link::of(edge.weight(), source, target, rank(edge.id()), number.unwrap_or(0))
                })
                .collect(),
            initial: automaton.node(automaton.initial()).map(|node| node.index()),
            start: start(automaton),
        }
    }
}

impl Sketch {
    /// The transitions, those on the event that is declared first before the others.
    pub fn links_by_event(&self) -> Vec<&Link> {
        let mut links: Vec<&Link> = self.links.iter().collect();
        links.sort_by_key(|link| link.event_number);
        links
    }
}

impl Mode {
    /// The name, then the flow, the invariant, and what is chosen at samples, if there are any.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = vec![self.name.to_owned()];
        lines.extend(self.flow.iter().cloned());
        lines.extend(self.invariant.iter().map(|invariant| format!("while {invariant}")));
        lines.extend(self.commands.iter().enumerate().map(|(number, (short, _))| {
            if number == 0 { short.clone() } else { format!("else {short}") }
        }));
        lines
    }
}

impl Link {
    fn of<E: Event, S>(
        transition: &Transition<E, S>,
        source: usize,
        target: usize,
        rank: usize,
        event_number: usize,
    ) -> Link {
        Link {
            source,
            target,
            rank,
            event: transition.event.name().to_owned(),
            event_number,
            guard: transition.guard.predicate().to_string(),
            reset: reset_formulas(&transition.reset),
            urgency: transition.urgency,
            priority: transition.priority,
            is_missed: false,
        }
    }

    /// The event, the guard in brackets, the reset after a stroke if there is one, and the urgency
    /// with the priority.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = vec![self.event.clone(), format!("[{}]", self.guard)];
        if !self.reset.is_empty() {
            lines.push(format!("/ {}", self.reset.join(", ")));
        }
        lines.push(format!("({}, {})", self.urgency, self.priority));
        lines.extend(self.is_missed.then(|| MISSED.to_owned()));
        lines
    }

    /// As [`lines`](Self::lines), but short: each assignment by itself, and only what is not as
    /// usual. The urgency is up to the stroke.
    pub fn short_lines(&self) -> Vec<String> {
        let mut lines = vec![match self.priority {
            0 => self.event.clone(),
            priority => format!("{} (priority {priority})", self.event),
        }];
        if self.guard != pleach_guards::always().to_string() {
            lines.push(format!("[{}]", self.guard));
        }
        let last = self.reset.len().saturating_sub(1);
        lines.extend(self.reset.iter().enumerate().map(|(number, assignment)| {
            let stroke = if number == 0 { "/ " } else { "" };
            let comma = if number == last { "" } else { "," };
            format!("{stroke}{assignment}{comma}")
        }));
        lines.extend(self.is_missed.then(|| MISSED.to_owned()));
        lines
    }
}

/// The assignments, each by itself; or the name, if there is one.
fn reset_formulas<S>(reset: &Reset<S>) -> Vec<String> {
    match reset.assignments() {
        Some(assignments) => assignments.iter().map(ToString::to_string).collect(),
        None if reset.name().is_empty() => Vec::new(),
        None => vec![reset.name().into_owned()],
    }
}

/// The initial state, as far as formulas name its variables: those that flow come first.
fn start<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) -> Vec<String> {
    let Some(state) = automaton.initial_state() else { return Vec::new() };
    let mut names: Vec<String> = Vec::new();
    let mut note = |name: &str| {
        if !names.iter().any(|listed| listed == name) {
            names.push(name.to_owned());
        }
    };
    let flows = || automaton.modes.iter().filter_map(|mode| mode.flow.as_ref()?.rates()).flatten();
    flows().for_each(|rate| note(rate.coordinate()));
    flows().flat_map(|rate| rate.rate().variables()).for_each(&mut note);
    let invariants = automaton.modes.iter().filter_map(|mode| mode.invariant.as_ref());
    invariants.flat_map(|invariant| invariant.variables()).for_each(&mut note);
    for transition in automaton.graph().edge_weights() {
        transition.guard.predicate().variables().into_iter().for_each(&mut note);
        for assignment in transition.reset.assignments().into_iter().flatten() {
            note(assignment.coordinate());
            let formulas = assignment.value().formulas();
            formulas.flat_map(Expression::variables).for_each(&mut note);
        }
    }
    let line = |name: &String| Some(equation(name, state.value(name)?));
    names.iter().filter_map(line).collect()
}

/// A variable and its value.
pub(crate) fn equation(name: &str, value: f64) -> String {
    format!("{name} = {}", constant(value))
}
