//! An automaton without its types.
//!
//! Locations and events are numbers with names here, formulas are data, and functions are names. Checks,
//! compositions and diagrams read automata in this form, so that they are compiled once, and not anew for
//! the types of each automaton.

use std::fmt;
use std::ops::RangeInclusive;

use petgraph::graph::EdgeIndex;
use pleach_discrete::{Event, Location, Urgency};
use pleach_guards::{Guard, Predicate, Substitution, Valuation, constant};

use crate::automaton::Automaton;
use crate::flow::{Flow, Rate};
use crate::law::Command;
use crate::lists::{names_of, place_of};
use crate::reset::{Assignment, listed};
use crate::signals::Signal;

pub(crate) struct Outline<'a> {
    /// By location.
    pub(crate) modes: Vec<Mode<'a>>,
    pub(crate) events: Vec<&'static str>,
    /// In the order of the table.
    pub(crate) transitions: Vec<Transition<'a>>,
    pub(crate) initial: usize,
    /// By name the locations of each superstate, those with more of them first.
    pub(crate) superstates: &'a [(&'static str, Vec<usize>)],
    /// The state in which runs start, where the model says it.
    pub(crate) initial_state: Option<&'a dyn Valuation>,
    /// The names of all variables, where the type of the state tells.
    pub(crate) known: Option<&'a [&'static str]>,
    pub(crate) parameters: &'a [(String, f64)],
    pub(crate) ranges: &'a [(String, RangeInclusive<f64>)],
    /// Propositions of which at most one is true at a time.
    pub(crate) exclusive: Vec<Vec<&'a str>>,
    /// The coordinates of which no other component may say how they move.
    pub(crate) own: &'a [&'static str],
}

/// A location with what is said of it.
pub(crate) struct Mode<'a> {
    pub(crate) name: &'static str,
    pub(crate) flow: Option<Motion<'a>>,
    pub(crate) invariant: Option<&'a Predicate>,
    pub(crate) commands: &'a [Command],
    /// The transitions that leave it, in their total order.
    pub(crate) leaving: &'a [EdgeIndex],
}

pub(crate) struct Transition<'a> {
    pub(crate) source: usize,
    pub(crate) event: usize,
    pub(crate) target: usize,
    pub(crate) urgency: Urgency,
    pub(crate) priority: u8,
    pub(crate) guard: &'a Guard,
    pub(crate) effect: Effect<'a>,
}

/// Transitions as one says them: one, or those that leave all locations of a superstate and read alike.
#[derive(Clone, Debug)]
pub(crate) struct Arrow {
    pub(crate) source: Source,
    /// The location that is entered; none: the location stays the same.
    pub(crate) target: Option<usize>,
    /// The transitions, at least one.
    pub(crate) transitions: Vec<usize>,
}

/// Where an arrow begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    Location(usize),
    Superstate(usize),
}

/// A flow: its rates, or its name.
#[derive(Clone, Copy)]
pub(crate) enum Motion<'a> {
    Rates(&'a [Rate]),
    Function(&'a str),
}

/// A reset: its assignments, or its name.
#[derive(Clone, Copy)]
pub(crate) enum Effect<'a> {
    Assignments(&'a [Assignment]),
    Function(&'a str),
}

impl<L: Location, E: Event, S: Valuation> Automaton<L, E, S> {
    pub(crate) fn outline(&self) -> Outline<'_> {
        let mut modes = Vec::with_capacity(self.modes.len());
        for (node, mode) in self.modes.iter().enumerate() {
            modes.push(Mode {
                name: self.locations[node].name(),
                flow: mode.flow.as_ref().map(Flow::outline),
                invariant: mode.invariant.as_ref(),
                commands: &mode.commands,
                leaving: &self.leaving[node],
            });
        }
        let mut transitions = Vec::with_capacity(self.rows.len());
        for edge in self.graph.raw_edges() {
            let transition = &edge.weight;
            // The builder sees to it that its event is among them, as the initial location is.
            transitions.push(Transition {
                source: edge.source().index(),
                event: place_of(&self.events, transition.event).unwrap_or_default(),
                target: edge.target().index(),
                urgency: transition.urgency,
                priority: transition.priority,
                guard: &transition.guard,
                effect: transition.reset.outline(),
            });
        }
        Outline {
            modes,
            events: names_of(&self.events, E::name),
            transitions,
            initial: place_of(&self.locations, self.initial).unwrap_or_default(),
            superstates: &self.superstates,
            initial_state: self.initial_state.as_ref().map(|state| state as &dyn Valuation),
            known: self.known.as_deref(),
            parameters: &self.parameters,
            ranges: &self.ranges,
            exclusive: self.exclusion.names(),
            own: &self.own,
        }
    }
}

impl Outline<'_> {
    /// What stands for parameters and for coordinates that are wired. None if there are neither: formulas
    /// then stay as they are, and functions the ones they were.
    pub(crate) fn formulas(&self, wiring: &[Signal]) -> Option<Substitution> {
        let numbers = self.parameters.iter().map(|(name, value)| (name, constant(*value)));
        let formulas = numbers.chain(wiring.iter().map(|(name, formula)| (name, formula.clone())));
        (!(self.parameters.is_empty() && wiring.is_empty())).then(|| Substitution::new(formulas))
    }

    /// The transitions in the order of the table, with those together that leave a superstate.
    pub(crate) fn arrows(&self) -> Vec<Arrow> {
        let mut arrows = Vec::new();
        let mut is_shown = vec![false; self.transitions.len()];
        for (first, transition) in self.transitions.iter().enumerate() {
            if is_shown[first] {
                continue;
            }
            let mut superstates = self.superstates.iter().enumerate();
            let together = superstates.find_map(|(number, (_, members))| {
                Some((number, self.alike(transition, members, &is_shown)?))
            });
            let arrow = match together {
                None => Arrow {
                    source: Source::Location(transition.source),
                    target: Some(transition.target),
                    transitions: vec![first],
                },
                Some((number, transitions)) => {
                    let stay = transitions.iter().all(|&at| self.transitions[at].is_loop());
                    let target = (!stay).then_some(transition.target);
                    Arrow { source: Source::Superstate(number), target, transitions }
                }
            };
            arrow.transitions.iter().for_each(|&other| is_shown[other] = true);
            arrows.push(arrow);
        }
        arrows
    }

    /// The transitions that read like this one, one from each of these locations of which one is its source.
    fn alike(
        &self,
        transition: &Transition<'_>,
        members: &[usize],
        is_shown: &[bool],
    ) -> Option<Vec<usize>> {
        if !members.contains(&transition.source) {
            return None;
        }
        let from = |member: usize| {
            let mut others = self.transitions.iter().enumerate();
            let reads_alike = |(number, other): &(usize, &Transition<'_>)| {
                other.source == member && !is_shown[*number] && transition.reads_like(other)
            };
            others.find(reads_alike).map(|(number, _)| number)
        };
        let alike: Vec<usize> =
            members.iter().map(|&member| from(member)).collect::<Option<_>>()?;
        let mut ends = alike.iter().map(|&at| &self.transitions[at]);
        let stay = ends.clone().all(|it| it.is_loop());
        (stay || ends.all(|it| it.target == transition.target)).then_some(alike)
    }

    /// The range that the model declares for a variable; without a declaration, all numbers.
    pub(crate) fn range(&self, name: &str) -> RangeInclusive<f64> {
        range_of(self.ranges, name)
    }

    pub(crate) fn invariants(&self) -> impl Iterator<Item = &Predicate> {
        self.modes.iter().filter_map(|mode| mode.invariant)
    }

    pub(crate) fn guards(&self) -> impl Iterator<Item = &Predicate> {
        self.transitions.iter().map(|transition| transition.guard.predicate())
    }
}

impl Transition<'_> {
    fn is_loop(&self) -> bool {
        self.source == self.target
    }

    /// Whether it reads like another in all but its ends; functions read alike if they have one name.
    pub(crate) fn reads_like(&self, other: &Transition<'_>) -> bool {
        (self.event, self.urgency, self.priority) == (other.event, other.urgency, other.priority)
            && self.guard == other.guard
            && self.effect.to_string() == other.effect.to_string()
    }
}

impl<'a> Motion<'a> {
    /// The rates, unless it is a function.
    pub(crate) fn rates(self) -> Option<&'a [Rate]> {
        match self {
            Motion::Rates(rates) => Some(rates),
            Motion::Function(_) => None,
        }
    }
}

impl<'a> Effect<'a> {
    /// The assignments, unless it is a function.
    pub(crate) fn assignments(self) -> Option<&'a [Assignment]> {
        match self {
            Effect::Assignments(assignments) => Some(assignments),
            Effect::Function(_) => None,
        }
    }
}

impl fmt::Display for Effect<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Effect::Assignments(assignments) => formatter.write_str(&listed(assignments)),
            Effect::Function(name) => formatter.write_str(name),
        }
    }
}

/// The range that is declared for a variable; without a declaration, all numbers.
pub(crate) fn range_of(
    ranges: &[(String, RangeInclusive<f64>)],
    name: &str,
) -> RangeInclusive<f64> {
    let declared = ranges.iter().find(|(variable, _)| variable == name);
    declared.map_or(f64::NEG_INFINITY..=f64::INFINITY, |(_, range)| range.clone())
}
