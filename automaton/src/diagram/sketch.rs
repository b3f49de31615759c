//! What locations and transitions say about themselves, the same in every kind of diagram.

use pleach_discrete::Urgency;
use pleach_guards::{Expression, Predicate, constant};

use crate::outline::{self, Arrow, Effect, Motion, Outline, Source, Transition};

/// An automaton in words, without its types: diagrams only have to arrange it.
#[derive(Clone, Debug)]
pub(crate) struct Sketch {
    /// In the order of `L::ALL`.
    pub modes: Vec<Mode>,
    /// In the order of the rows of the table.
    pub links: Vec<Link>,
    /// The same, with those together that leave a superstate.
    pub arrows: Vec<Arrow>,
    /// By name the locations of each superstate, those with more of them first.
    pub superstates: Vec<(&'static str, Vec<usize>)>,
    /// The number of the initial location.
    pub initial: usize,
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
    pub(crate) fn of(automaton: &Outline<'_>) -> Sketch {
        let mode = |mode: &outline::Mode<'_>| Mode {
            name: mode.name,
            flow: mode.flow.map_or_else(Vec::new, flow_formulas),
            invariant: mode.invariant.map(ToString::to_string),
            commands: mode
                .commands
                .iter()
                .map(|it| (format!("{} := {}", it.commanded, it.name), it.to_string()))
                .collect(),
            is_missed: false,
        };
        let link = |(number, transition): (usize, &Transition<'_>)| {
            let leaving = automaton.modes[transition.source].leaving;
            let rank = leaving.iter().position(|edge| edge.index() == number).unwrap_or_default();
            Link::of(transition, automaton.events[transition.event], rank)
        };
        Sketch {
            modes: automaton.modes.iter().map(mode).collect(),
            links: automaton.transitions.iter().enumerate().map(link).collect(),
            arrows: automaton.arrows(),
            superstates: automaton.superstates.to_vec(),
            initial: automaton.initial,
            start: start(automaton),
        }
    }
}

impl Sketch {
    /// The transitions, those together that leave a superstate: the first of them stands for all. Within a superstate, where
    /// graphs have no arrow from its border, each stands for itself.
    pub(super) fn drawn_links(&self) -> Vec<(Source, &Link)> {
        let drawn = |arrow: &Arrow| -> Vec<(Source, &Link)> {
            let links = || arrow.transitions.iter().map(|&number| &self.links[number]);
            match (arrow.source, arrow.target) {
                (Source::Superstate(number), Some(target))
                    if !self.superstates[number].1.contains(&target) =>
                {
                    links().take(1).map(|link| (arrow.source, link)).collect()
                }
                _ => links().map(|link| (Source::Location(link.source), link)).collect(),
            }
        };
        self.arrows.iter().flat_map(drawn).collect()
    }

    /// The locations in their order, but those of a superstate one after another.
    pub(super) fn order(&self) -> Vec<usize> {
        let mut order: Vec<usize> = Vec::new();
        for location in 0..self.modes.len() {
            let of_location = |(_, members): &&(_, Vec<usize>)| members.contains(&location);
            // The innermost superstate comes last.
            let mut superstates = self.superstates.iter().rev().filter(of_location);
            let last = superstates
                .find_map(|(_, members)| order.iter().rposition(|it| members.contains(it)));
            order.insert(last.map_or(order.len(), |last| last + 1), location);
        }
        order
    }

    /// The superstates and locations that stand directly in a superstate, or in none.
    pub(super) fn within(&self, outer: Option<usize>) -> Contents {
        let members = |number: usize| &self.superstates[number].1;
        let is_in = |location: &usize| outer.is_none_or(|outer| members(outer).contains(location));
        // Those with more locations come first: what a superstate contains comes after it.
        let first = outer.map_or(0, |outer| outer + 1);
        let mut superstates: Vec<usize> = Vec::new();
        for number in first..self.superstates.len() {
            let is_inner = superstates.iter().any(|&it| members(it).contains(&members(number)[0]));
            if is_in(&members(number)[0]) && !is_inner {
                superstates.push(number);
            }
        }
        let is_direct = |location: &usize| {
            is_in(location) && !superstates.iter().any(|&it| members(it).contains(location))
        };
        let locations = (0..self.modes.len()).filter(is_direct).collect();
        Contents { superstates, locations }
    }
}

/// What stands directly in a superstate, by number.
pub(crate) struct Contents {
    pub superstates: Vec<usize>,
    pub locations: Vec<usize>,
}

impl Mode {
    /// The name, then the flow, the invariant, and what is chosen at samples, if there are any.
    pub(super) fn lines(&self) -> Vec<String> {
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
    fn of(transition: &Transition<'_>, event: &str, rank: usize) -> Link {
        Link {
            source: transition.source,
            target: transition.target,
            rank,
            event: event.to_owned(),
            event_number: transition.event,
            guard: transition.guard.predicate().to_string(),
            reset: reset_formulas(transition.effect),
            urgency: transition.urgency,
            priority: transition.priority,
            is_missed: false,
        }
    }

    /// The event, the guard in brackets, the reset after a stroke if there is one, and the urgency
    /// with the priority.
    pub(super) fn lines(&self) -> Vec<String> {
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
    pub(super) fn short_lines(&self) -> Vec<String> {
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

/// The rates, each by itself; or the name of the flow.
fn flow_formulas(flow: Motion<'_>) -> Vec<String> {
    match flow {
        Motion::Rates(rates) => rates.iter().map(ToString::to_string).collect(),
        Motion::Function(name) => vec![name.to_owned()],
    }
}

/// The assignments, each by itself; or the name, if there is one.
fn reset_formulas(reset: Effect<'_>) -> Vec<String> {
    match reset {
        Effect::Assignments(assignments) => assignments.iter().map(ToString::to_string).collect(),
        Effect::Function("") => Vec::new(),
        Effect::Function(name) => vec![name.to_owned()],
    }
}

/// The initial state, as far as formulas name its variables: those that flow come first.
fn start(automaton: &Outline<'_>) -> Vec<String> {
    let Some(state) = automaton.initial_state else { return Vec::new() };
    let mut names: Vec<&str> = Vec::new();
    let mut note = |name| {
        if !names.contains(&name) {
            names.push(name);
        }
    };
    let flows = || automaton.modes.iter().filter_map(|mode| mode.flow?.rates()).flatten();
    flows().for_each(|rate| note(rate.coordinate()));
    flows().flat_map(|rate| rate.rate().variables()).for_each(&mut note);
    automaton.invariants().flat_map(Predicate::variables).for_each(&mut note);
    for transition in &automaton.transitions {
        transition.guard.predicate().variables().into_iter().for_each(&mut note);
        for assignment in transition.effect.assignments().into_iter().flatten() {
            note(assignment.coordinate());
            let formulas = assignment.value().formulas();
            formulas.flat_map(Expression::variables).for_each(&mut note);
        }
    }
    names.iter().filter_map(|name| Some(equation(name, state.value(name)?))).collect()
}

/// A variable and its value.
pub(crate) fn equation(name: &str, value: f64) -> String {
    format!("{name} = {}", constant(value))
}
