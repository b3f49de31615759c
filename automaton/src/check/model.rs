//! An automaton as checks read it: without its types, and with its formulas as data.

use std::collections::BTreeSet;

use pleach_discrete::Urgency;
use pleach_guards::{Expression, Guard, Interval, Predicate, Substitution, always, not, variable};

use super::report::FindingPlace;
use crate::decision::{Region, State};
use crate::outline::{self, Outline};
use crate::reset::{Assignment, NewValue};
use crate::signals::Signal;

/// An automaton, alone or as a component.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    /// The name, of a component.
    pub(crate) component: Option<String>,
    pub(crate) modes: Vec<Mode>,
    /// In the order of the table.
    pub(crate) transitions: Vec<Transition>,
    /// What the events are called.
    pub(crate) events: Vec<String>,
    /// By event: whether other components take part in it.
    pub(crate) is_label: Vec<bool>,
    pub(crate) initial: usize,
    pub(crate) initial_state: Option<State>,
    /// Whether the type of the state says its coordinates, so that runs can start in one.
    pub(crate) has_coordinates: bool,
    /// All variables that are known to be there.
    pub(crate) region: Region,
    /// What holds in every state because states are made so.
    pub(crate) given: Predicate,
    /// What belongs to another component.
    pub(crate) inputs: Vec<String>,
    /// The event that is taken beyond an accumulation of jumps, whatever its guards say.
    pub(crate) continuation: Option<usize>,
}

/// A location with what is said of it.
#[derive(Clone, Debug)]
pub(crate) struct Mode {
    pub(crate) name: &'static str,
    pub(crate) motion: Motion,
    pub(crate) invariant: Predicate,
    /// The transitions that leave it, in their total order.
    pub(crate) leaving: Vec<usize>,
}

/// A flow.
#[derive(Clone, Debug)]
pub(crate) enum Motion {
    Rates(Vec<(String, Expression)>),
    Function(String),
}

/// A transition.
#[derive(Clone, Debug)]
pub(crate) struct Transition {
    pub(crate) source: usize,
    pub(crate) target: usize,
    pub(crate) event: usize,
    pub(crate) urgency: Urgency,
    pub(crate) priority: u8,
    pub(crate) guard: Guard,
    pub(crate) effect: Effect,
    /// The intervals from which it takes new values: the variable and both ends.
    pub(crate) intervals: Vec<(String, [Expression; 2])>,
}

/// A reset.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Effect {
    /// What becomes any number of an interval is its lower end and a share of its width: the share is
    /// a variable between 0 and 1, of which a witness says what was taken.
    Assignments(Vec<(String, Expression)>),
    Function(String),
}

impl Model {
    /// The automaton, with formulas in the place of the coordinates that are wired.
    pub(crate) fn of(automaton: &Outline<'_>, wiring: &[Signal]) -> Self {
        let modes = automaton.modes.iter().map(|mode| Mode {
            name: mode.name,
            motion: mode.flow.map_or(Motion::Rates(Vec::new()), motion),
            invariant: mode.invariant.map_or_else(always, in_numbers),
            leaving: mode.leaving.iter().map(|edge| edge.index()).collect(),
        });
        let transitions = automaton.transitions.iter().map(|transition| Transition {
            source: transition.source,
            target: transition.target,
            event: transition.event,
            urgency: transition.urgency,
            priority: transition.priority,
            guard: Guard::new(transition.guard.name(), in_numbers(transition.guard.predicate())),
            effect: effect(transition.effect),
            intervals: intervals(transition.effect),
        });
        let mut model = Model {
            component: None,
            modes: modes.collect(),
            transitions: transitions.collect(),
            events: automaton.events.iter().map(|&event| event.to_owned()).collect(),
            is_label: vec![false; automaton.events.len()],
            initial: automaton.initial,
            initial_state: None,
            has_coordinates: automaton.known.is_some(),
            region: Region::new(),
            given: Predicate::all(automaton.exclusive.iter().map(|group| at_most_one(group))),
            inputs: Vec::new(),
            continuation: None,
        };
        if let Some(formulas) = automaton.formulas(wiring) {
            model.substitute(&formulas);
        }
        let is_wired = |name: &str| wiring.iter().any(|(wired, _)| wired == name);
        let declared = automaton.known.into_iter().flatten().map(|name| (*name).to_owned());
        let declared = declared.filter(|name| !is_wired(name));
        let propositions = propositions_of(automaton);
        let named = model.variables().into_iter().chain(propositions.iter().cloned());
        let names: Vec<String> = declared.chain(named).collect();
        for name in names {
            let is_fraction = propositions.contains(&name) || name.starts_with(SHARE);
            let range = if is_fraction { 0.0..=1.0 } else { automaton.range(&name) };
            let range = Interval::new(*range.start(), *range.end()).unwrap_or(Interval::WHOLE);
            model.region.insert(name, range);
        }
        model.initial_state = automaton.initial_state.map(|state| {
            let value = |name: &String| Some((name.clone(), state.value(name)?));
            model.region.keys().filter_map(value).collect()
        });
        model
    }

    /// The first location in which the variable called `name` flows or is given a value.
    pub(crate) fn changes(&self, name: &str) -> Option<&'static str> {
        let is_given = |given: &[(String, Expression)]| given.iter().any(|(own, _)| own == name);
        let flows = self.modes.iter().find(|mode| is_given(mode.rates()));
        let resets = self.transitions.iter().filter(|one| is_given(one.assignments()));
        let resets = resets.map(|one| &self.modes[one.source]);
        flows.into_iter().chain(resets).map(|mode| mode.name).next()
    }

    /// Whether all flows and resets are formulas.
    pub(crate) fn is_data(&self) -> bool {
        let is_function = |one: &Transition| matches!(one.effect, Effect::Function(_));
        let flows = self.modes.iter().any(|mode| matches!(mode.motion, Motion::Function(_)));
        !(flows || self.transitions.iter().any(is_function))
    }

    fn substitute(&mut self, formulas: &Substitution) {
        let change = |listed: &mut Vec<(String, Expression)>| {
            listed.iter_mut().for_each(|(_, formula)| *formula = formula.substitute(formulas));
        };
        for mode in &mut self.modes {
            mode.invariant = mode.invariant.substitute(formulas);
            if let Motion::Rates(rates) = &mut mode.motion {
                change(rates);
            }
        }
        for transition in &mut self.transitions {
            let guard = transition.guard.predicate().substitute(formulas);
            transition.guard = Guard::new(transition.guard.name(), guard);
            if let Effect::Assignments(assignments) = &mut transition.effect {
                change(assignments);
            }
            let ends = transition.intervals.iter_mut().flat_map(|(_, ends)| ends);
            ends.for_each(|end| *end = end.substitute(formulas));
        }
    }

    /// What formulas name.
    pub(crate) fn variables(&self) -> Vec<String> {
        let predicates = self.modes.iter().map(|mode| &mode.invariant);
        let guards = self.transitions.iter().map(|one| one.guard.predicate());
        let in_predicates = predicates.chain(guards).flat_map(Predicate::variables);
        let in_rates = self.modes.iter().flat_map(Mode::rates);
        let in_resets = self.transitions.iter().flat_map(Transition::assignments);
        let in_formulas = in_rates.chain(in_resets).flat_map(|(_, formula)| formula.variables());
        in_predicates.chain(in_formulas).map(str::to_owned).collect()
    }

    /// What reads the variable called `name`, besides the transitions on an event.
    pub(crate) fn reader_of(&self, name: &str, except: Option<usize>) -> Option<String> {
        let reads = |formula: &Expression| formula.variables().contains(name);
        let is_read = |predicate: &Predicate| predicate.variables().contains(name);
        let of_mode = |mode: &Mode| {
            let part = match mode {
                _ if mode.rates().iter().any(|(_, rate)| reads(rate)) => "flow",
                _ if is_read(&mode.invariant) => "invariant",
                _ => return None,
            };
            Some(format!("the {part} of location `{}`", mode.name))
        };
        let others = self.transitions.iter().filter(|one| Some(one.event) != except);
        let of_transition = |one: &Transition| {
            let ends = || one.intervals.iter().flat_map(|(_, ends)| ends);
            let part = match one {
                _ if is_read(one.guard.predicate()) => "guard",
                _ if one.assignments().iter().any(|(_, value)| reads(value))
                    || ends().any(reads) =>
                {
                    "reset"
                }
                _ => return None,
            };
            Some(format!("the {part} of event `{}`", self.events[one.event]))
        };
        self.modes.iter().find_map(of_mode).or_else(|| others.into_iter().find_map(of_transition))
    }

    pub(crate) fn mode_at(&self, location: usize) -> FindingPlace {
        FindingPlace {
            component: self.component.clone(),
            location: Some(self.modes[location].name),
            ..FindingPlace::default()
        }
    }

    pub(crate) fn place_of(&self, transitions: &[usize]) -> FindingPlace {
        let location = transitions.first().map(|&first| self.transitions[first].source);
        let events = transitions.iter().map(|&one| self.event(one).to_owned()).collect();
        let location = location.map(|location| self.modes[location].name);
        FindingPlace { component: self.component.clone(), location, events, variable: None }
    }

    pub(crate) fn event(&self, transition: usize) -> &str {
        &self.events[self.transitions[transition].event]
    }

    /// Whether the component takes the transition by itself.
    pub(crate) fn is_own(&self, transition: usize) -> bool {
        !self.is_label[self.transitions[transition].event]
    }

    /// Whether time has to wait for the transition, whatever other components do.
    pub(crate) fn is_forced(&self, transition: usize) -> bool {
        self.is_own(transition) && self.transitions[transition].urgency.is_forced()
    }

    /// What the declared ranges say of one variable; nothing if it has none.
    pub(crate) fn range_of(&self, name: &str) -> Predicate {
        let range = self.region.get(name).copied().unwrap_or(Interval::WHOLE);
        let lower = variable(name).at_least(range.lower());
        let upper = variable(name).at_most(range.upper());
        let ends = [(range.lower(), lower), (range.upper(), upper)];
        Predicate::all(ends.into_iter().filter(|(end, _)| end.is_finite()).map(|(_, bound)| bound))
    }
}

impl Mode {
    /// The rates that are formulas.
    pub(crate) fn rates(&self) -> &[(String, Expression)] {
        match &self.motion {
            Motion::Rates(rates) => rates,
            Motion::Function(_) => &[],
        }
    }

    pub(crate) fn rests(&self) -> bool {
        matches!(&self.motion, Motion::Rates(rates) if rates.is_empty())
    }
}

impl Transition {
    /// The assignments, as far as the reset is data.
    pub(crate) fn assignments(&self) -> &[(String, Expression)] {
        match &self.effect {
            Effect::Assignments(assignments) => assignments,
            Effect::Function(_) => &[],
        }
    }

    /// The values of the variables after the jump as formulas over x⁻, if the reset is data.
    pub(crate) fn substitution(&self) -> Option<Substitution> {
        match &self.effect {
            Effect::Assignments(assignments) => {
                Some(Substitution::new(assignments.iter().cloned()))
            }
            Effect::Function(_) => None,
        }
    }

    pub(crate) fn refused(&self) -> Predicate {
        not(self.guard.predicate().clone())
    }
}

/// At most one of these propositions is true, in numbers.
fn at_most_one(propositions: &[&str]) -> Predicate {
    let sum: Expression = propositions.iter().map(|name| variable(name)).sum();
    sum.at_most(1.0)
}

/// A predicate in which every proposition is a number, at least 1 where it is true: numbers are
/// what decisions are about.
fn in_numbers(predicate: &Predicate) -> Predicate {
    let each = |parts: &[Predicate]| parts.iter().map(in_numbers).collect();
    match predicate {
        Predicate::Proposition(name) => variable(name).at_least(1.0),
        Predicate::Not(inner) => not(in_numbers(inner)),
        Predicate::All(parts) => Predicate::All(each(parts)),
        Predicate::Any(parts) => Predicate::Any(each(parts)),
        other => other.clone(),
    }
}

fn propositions_of(automaton: &Outline<'_>) -> BTreeSet<String> {
    let predicates = automaton.invariants().chain(automaton.guards());
    let named = predicates.flat_map(Predicate::propositions);
    named.chain(automaton.exclusive.iter().flatten().copied()).map(str::to_owned).collect()
}

fn motion(flow: outline::Motion<'_>) -> Motion {
    match flow {
        outline::Motion::Rates(rates) => Motion::Rates(
            rates.iter().map(|one| (one.coordinate().to_owned(), one.rate().clone())).collect(),
        ),
        outline::Motion::Function(name) => Motion::Function(name.to_owned()),
    }
}

/// How the names of shares begin.
const SHARE: &str = "share of the interval of ";

fn effect(reset: outline::Effect<'_>) -> Effect {
    let value = |one: &Assignment| {
        let value = match one.value() {
            NewValue::Exactly(value) => value.clone(),
            NewValue::Within(lower, upper) => {
                let share = variable(&format!("{SHARE}{}", one.coordinate()));
                lower + share * (upper - lower)
            }
        };
        (one.coordinate().to_owned(), value)
    };
    match reset {
        outline::Effect::Assignments(assignments) => {
            Effect::Assignments(assignments.iter().map(value).collect())
        }
        outline::Effect::Function(name) => Effect::Function(name.to_owned()),
    }
}

fn intervals(reset: outline::Effect<'_>) -> Vec<(String, [Expression; 2])> {
    let assignments = reset.assignments().into_iter().flatten();
    let interval = |one: &Assignment| match one.value() {
        NewValue::Exactly(_) => None,
        NewValue::Within(lower, upper) => {
            Some((one.coordinate().to_owned(), [lower.clone(), upper.clone()]))
        }
    };
    assignments.filter_map(interval).collect()
}
