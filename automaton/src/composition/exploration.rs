//! Exploring a composition in which no time passes: all states that it can reach.
//!
//! A protocol or a logic without clocks is a composition whose flows move nothing. Its runs are
//! sequences of jumps, and what any of them can lead to is found by looking at every state once,
//! breadth first, so that no way to a state is shorter than the one that is found.
//!
//! From a state every jump can be taken whose guards hold, a label by all its participants
//! together. Where one of them has to be taken (*must* or *at once*), those that only may be have
//! to wait, as in a run. Priorities and the order of components settle what a run does first; here
//! they settle nothing, and each order is explored. Invariants say whether time may pass, and so
//! they say nothing.
//!
//! Which numbers can be reached from 1 by adding 1 and by doubling, as long as they are at most 5?
//!
//! ```
//! use pleach_automaton::{coordinates, from, Automaton, Composition};
//! use pleach_discrete::vocabulary;
//! use pleach_guards::Valuation;
//!
//! vocabulary! {
//!     enum Calculator: Location { Ready = "ready" }
//!     enum Key: Event { AddOne = "add one", Double = "double" }
//! }
//! coordinates! { struct Display { number = "n" } }
//! use Calculator::Ready;
//!
//! let Display { number } = Display::coordinates();
//! let is_small = number.at_most(5.0);
//! let (increased, doubled) = (number.becomes(&number + 1.0), number.becomes(2.0 * &number));
//! let calculator = Automaton::starting_in(Ready)
//!     .initially(Display { number: 1.0 })
//!     .transition(from(Ready).on(Key::AddOne).to(Ready).may(is_small.clone()).then(increased))
//!     .transition(from(Ready).on(Key::Double).to(Ready).may(is_small.clone()).then(doubled))
//!     .build()?;
//!
//! let exploration = Composition::builder().add("calculator", &calculator).build()?.explore(100)?;
//! assert_eq!(exploration.states().len(), 8); // 1, 2, 3, 4, 5, 6, 8 and 10
//! assert_eq!(exploration.deadlocks().count(), 3);
//!
//! let ten = exploration.find(|state| state.value("n") == Some(10.0)).expect("10 = 2 · (2 · 2 + 1)");
//! assert_eq!(ten.path(), ["add one", "double", "add one", "double"]);
//!
//! let large = exploration.counterexample(&is_small)?.expect("6 is not small");
//! assert_eq!(large.path(), ["add one", "add one", "double"]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::collections::BTreeMap;

use pleach_guards::{EvaluationError, Predicate, Valuation};
use thiserror::Error;

use super::Composition;
use super::blueprint::Leaving;
use super::jumps::{Joint, Standing};
use super::simulation::Failure;

/// All states that a composition can reach without time; see the [module](crate::composition).
#[derive(Clone)]
pub struct Exploration {
    composition: Composition,
    /// In the order in which they have been found.
    states: Vec<State>,
    transitions: usize,
}

#[derive(Clone)]
struct State {
    locations: Box<[usize]>,
    values: Box<[f64]>,
    /// The state that it was found from, and by which jump; nothing for the first.
    origin: Option<(usize, Joint)>,
    /// How many jumps leave it.
    leaving: usize,
}

/// A state that an [`Exploration`] has found; its variables can be read as those of a trajectory.
#[derive(Clone, Copy)]
pub struct Reached<'a> {
    exploration: &'a Exploration,
    number: usize,
}

/// Why a composition cannot be explored.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ExplorationError {
    /// Something changes while time passes.
    #[error(
        "`{mover}` changes while time passes in {locations}: only a composition in which nothing \
         does can be explored"
    )]
    Moves {
        /// The variable, or the component that solves its flow itself.
        mover: String,
        /// The locations of the components.
        locations: String,
    },
    /// There are more states than allowed.
    #[error("there are more than {limit} states: allow more, or bound the variables by guards")]
    TooManyStates {
        /// How many are allowed.
        limit: usize,
    },
    /// A jump takes a value from an interval, and so leads to more states than can be listed.
    #[error(
        "`{variable}` becomes any number of an interval on `{event}`: only resets to single values \
         can be explored"
    )]
    Interval {
        /// The variable.
        variable: String,
        /// The event, or the label.
        event: String,
    },
    /// A guard or a reset has no value.
    #[error(transparent)]
    Failure(#[from] Failure),
}

impl Composition {
    /// Finds all states, of which there may be `limit`, that can be reached from the initial one
    /// by jumps alone.
    ///
    /// # Errors
    ///
    /// [`ExplorationError`] if time changes something, if there are more states, or if a formula
    /// has no value.
    pub fn explore(&self, limit: usize) -> Result<Exploration, ExplorationError> {
        let initial = self.components.iter().map(|component| component.blueprint.initial);
        let mut explorer = Explorer {
            composition: self,
            limit,
            numbers: BTreeMap::new(),
            states: Vec::new(),
            transitions: 0,
        };
        explorer.find(initial.collect(), self.initial.clone().into(), None)?;
        let mut next = 0;
        while next < explorer.states.len() {
            explorer.leave(next)?;
            next += 1;
        }
        let Explorer { states, transitions, .. } = explorer;
        Ok(Exploration { composition: self.clone(), states, transitions })
    }
}

/// An exploration under way.
struct Explorer<'a> {
    composition: &'a Composition,
    limit: usize,
    /// By locations and the bit patterns of the values: the number of a state.
    numbers: BTreeMap<Box<[u64]>, usize>,
    states: Vec<State>,
    transitions: usize,
}

impl Explorer<'_> {
    /// Takes note of a state, unless it is known.
    fn find(
        &mut self,
        locations: Box<[usize]>,
        values: Box<[f64]>,
        origin: Option<(usize, Joint)>,
    ) -> Result<(), ExplorationError> {
        // −0 and 0 are one state.
        let bits = values.iter().map(|value| (value + 0.0).to_bits());
        let key = locations.iter().map(|&location| location as u64).chain(bits).collect();
        if self.numbers.contains_key(&key) {
            return Ok(());
        }
        if self.states.len() >= self.limit {
            return Err(ExplorationError::TooManyStates { limit: self.limit });
        }
        if let Some(mover) = self.composition.mover(&locations, &values) {
            let standing = Standing::new(self.composition, &locations);
            let all: Vec<usize> = (0..locations.len()).collect();
            return Err(ExplorationError::Moves { mover, locations: standing.names(&all) });
        }
        self.numbers.insert(key, self.states.len());
        self.states.push(State { locations, values, origin, leaving: 0 });
        Ok(())
    }

    /// Takes every jump from the state of that number.
    fn leave(&mut self, number: usize) -> Result<(), ExplorationError> {
        let State { locations, values, .. } = self.states[number].clone();
        let standing = Standing::new(self.composition, &locations);
        let (mut forced, mut free) = (Vec::new(), Vec::new());
        for jump in standing.all(&values)? {
            let is_forced = |leaving: &Leaving| leaving.urgency.is_forced();
            match standing.is_for_one(&jump, &values, is_forced)? {
                true => forced.push(jump),
                false => free.push(jump),
            }
        }
        let jumps = if forced.is_empty() { free } else { forced };
        self.states[number].leaving = jumps.len();
        self.transitions += jumps.len();
        for jump in jumps {
            if let Some(variable) = standing.chosen(&jump) {
                let (variable, event) =
                    (variable.to_owned(), self.composition.name_of(&locations, &jump));
                return Err(ExplorationError::Interval { variable, event });
            }
            let taken = standing.taken(&jump, &values, &mut || 0.0)?;
            let mut target = locations.clone();
            for one in &taken.moves {
                target[one.component] = one.target;
            }
            let mut reached = values.clone();
            taken.changes.iter().for_each(|&(slot, value)| reached[slot] = value);
            self.find(target, reached, Some((number, jump)))?;
        }
        Ok(())
    }
}

impl Exploration {
    /// The states in the order of the lengths of their paths; the first is the initial one.
    pub fn states(&self) -> impl ExactSizeIterator<Item = Reached<'_>> {
        (0..self.states.len()).map(|number| Reached { exploration: self, number })
    }

    /// How many jumps there are between the states, those that lead back to where they begin
    /// among them.
    pub fn transitions(&self) -> usize {
        self.transitions
    }

    /// The states that nothing leaves: deadlocks, and the ends that are meant.
    pub fn deadlocks(&self) -> impl Iterator<Item = Reached<'_>> {
        self.states().filter(|state| state.get().leaving == 0)
    }

    /// A state in which `is_sought` holds, of those the one with the shortest path.
    pub fn find(&self, is_sought: impl Fn(&Reached<'_>) -> bool) -> Option<Reached<'_>> {
        self.states().find(is_sought)
    }

    /// A state in which `always` does not hold, of those the one with the shortest path; none if
    /// it holds always.
    ///
    /// # Errors
    ///
    /// [`EvaluationError`] where it has no value before such a state is found.
    pub fn counterexample(
        &self,
        always: &Predicate,
    ) -> Result<Option<Reached<'_>>, EvaluationError> {
        for state in self.states() {
            if !always.holds(&state)? {
                return Ok(Some(state));
            }
        }
        Ok(None)
    }
}

impl<'a> Reached<'a> {
    /// The location of a component.
    pub fn location(&self, component: usize) -> Option<&'static str> {
        self.locations().nth(component)
    }

    /// The locations of all components in their order.
    pub fn locations(&self) -> impl Iterator<Item = &'static str> + use<'a> {
        let components = self.exploration.composition.components.iter();
        let locations = &*self.get().locations;
        components.zip(locations).map(|(component, &location)| component.mode(location).name)
    }

    /// The values of all variables in their order.
    pub fn values(&self) -> &'a [f64] {
        &self.get().values
    }

    /// The jumps that lead here from the initial state, as few as can be: labels by their name, and
    /// an event of one component of several as `component.event`.
    pub fn path(&self) -> Vec<String> {
        let exploration = self.exploration;
        let mut names = Vec::new();
        let mut state = self.get();
        while let Some((origin, jump)) = &state.origin {
            state = &exploration.states[*origin];
            names.push(exploration.composition.name_of(&state.locations, jump));
        }
        names.reverse();
        names
    }

    fn get(&self) -> &'a State {
        &self.exploration.states[self.number]
    }
}

impl Valuation for Reached<'_> {
    fn value(&self, variable: &str) -> Option<f64> {
        let names = &self.exploration.composition.variables;
        let place = names.iter().position(|name| name == variable)?;
        self.values().get(place).copied()
    }
}

impl Composition {
    /// The label of a jump from these locations, or its event.
    fn name_of(&self, locations: &[usize], jump: &Joint) -> String {
        if let Some(label) = jump.label {
            return self.labels[label].name.clone();
        }
        let standing = Standing::new(self, locations);
        let named = jump.parts.iter().zip(standing.parts(jump)).map(|((index, _), leaving)| {
            let component = &self.components[*index];
            let event = &component.events[leaving.event];
            let is_alone = self.components.len() == 1;
            if is_alone { event.clone() } else { format!("{}.{event}", component.name) }
        });
        named.collect()
    }
}

#[cfg(test)]
mod tests {
    use pleach_discrete::vocabulary;
    use pleach_guards::{always, never};

    use super::*;
    use crate::{Automaton, Flow, coordinates, from};

    vocabulary! {
        enum Place: Location { Here = "here", There = "there", Nowhere = "nowhere" }
        enum Way: Event { Go = "go", Leap = "leap", Vanish = "vanish" }
    }
    coordinates! {
        struct Count { n }
    }
    use Place::{Here, Nowhere, There};

    fn one(automaton: &Automaton<Place, Way, ()>) -> Composition {
        Composition::builder().add("one", automaton).build().expect("it is sound")
    }

    #[test]
    fn what_may_be_taken_waits_for_what_has_to_be() {
        let automaton = |guard: Predicate| {
            let built = Automaton::starting_in(Here)
                .initially(())
                .transition(from(Here).on(Way::Go).to(There).may(always()))
                .transition(from(Here).on(Way::Leap).to(Nowhere).at_once(guard))
                .build();
            one(&built.expect("it is sound")).explore(10).expect("there is no time")
        };
        let forced = automaton(always());
        assert_eq!((forced.states().len(), forced.transitions()), (2, 1));
        assert!(forced.find(|state| state.location(0) == Some("there")).is_none());
        assert!(forced.find(|state| state.location(0) == Some("nowhere")).is_some());
        let free = automaton(never());
        assert_eq!((free.states().len(), free.transitions()), (2, 1));
        assert!(free.find(|state| state.location(0) == Some("nowhere")).is_none());
    }

    #[test]
    fn labels_are_taken_together_and_events_alone() {
        let walker = Automaton::starting_in(Here)
            .initially(())
            .transition(from(Here).on(Way::Go).to(There).may(always()))
            .transition(from(There).on(Way::Leap).to(Here).may(always()))
            .build()
            .expect("it is sound");
        let pair = Composition::builder().add("left", &walker).add("right", &walker).label("leap");
        let exploration = pair.build().expect("sound").explore(10).expect("there is no time");
        // Two ways to go from the start, one from each of the two states after it, one leap.
        assert_eq!((exploration.states().len(), exploration.transitions()), (4, 5));
        let both = exploration.find(|state| state.locations().eq(["there", "there"]));
        assert_eq!(both.expect("both can go").path(), ["left.go", "right.go"]);
        assert_eq!(exploration.deadlocks().count(), 0);
    }

    #[test]
    fn states_without_bound_and_flows_are_refused() {
        let Count { n } = Count::coordinates();
        let counter = |flow: Flow<Count>| {
            let up = from(Here).on(Way::Go).to(Here).may(always()).then(n.becomes(&n + 1.0));
            let built = Automaton::starting_in(Here).initially(Count { n: -0.0 }).flow(Here, flow);
            let counter = built.transition(up).build().expect("it is sound");
            Composition::builder().add("counter", &counter).build().expect("it is sound")
        };
        let refused = |flow| counter(flow).explore(100).err();
        let limit = Some(ExplorationError::TooManyStates { limit: 100 });
        assert_eq!(refused(n.rate(0.0).into()), limit);
        let moves = refused(n.rate(1.0).into()).expect("n moves").to_string();
        let text = "`n` changes while time passes in `here` of `counter`: \
                    only a composition in which nothing does can be explored";
        assert_eq!(moves, text);
        let exact = refused(Flow::exact("n rests", |_, _| {})).expect("who knows").to_string();
        assert!(exact.starts_with("`counter` changes"), "{exact}");
    }

    #[test]
    fn zeros_of_both_signs_are_one_state() {
        let Count { n } = Count::coordinates();
        let turn = from(Here).on(Way::Go).to(Here).may(always()).then(n.becomes(-1.0 * &n));
        let built = Automaton::starting_in(Here).initially(Count { n: 0.0 }).transition(turn);
        let turning = built.build().expect("it is sound");
        let turning = Composition::builder().add("turning", &turning).build().expect("sound");
        assert_eq!(turning.explore(10).expect("there is no time").states().len(), 1);
    }
}
