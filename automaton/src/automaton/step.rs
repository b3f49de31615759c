//! Transitions one at a time, by hand.

use pleach_discrete::{Event, Location};
use pleach_guards::{EvaluationError, Valuation};

use super::{Automaton, Jump, Transition, TransitionError};
use crate::coverage::tally::Tally;
use crate::located::{Holds, Place};
use crate::observed;

/// A transition that can be taken now: its guard holds in the state it was found for.
#[derive(Debug)]
pub struct Step<'a, L, E, S> {
    source: L,
    target: L,
    transition: &'a Transition<E, S>,
    row: usize,
    tally: Option<&'a Tally>,
}

impl<L: Location, E: Event, S: Valuation> Automaton<L, E, S> {
    /// The first transition in total order that leaves `location`, has to be taken (*must* or *at
    /// once*), and whose guard holds in `state`.
    ///
    /// # Errors
    ///
    /// [`TransitionError`] for the first guard before it that cannot be evaluated.
    pub fn enabled(
        &self,
        location: L,
        state: &S,
    ) -> Result<Option<Step<'_, L, E, S>>, TransitionError> {
        self.first(location, state, |transition| transition.urgency.is_forced())
    }

    /// The first transition in total order that leaves `location` on `event` and whose guard
    /// holds in `state`, whatever its urgency: for those that *may* be taken, and for events that
    /// several components take together.
    ///
    /// # Errors
    ///
    /// [`TransitionError`] if the guard cannot be evaluated.
    pub fn enabled_on(
        &self,
        event: E,
        location: L,
        state: &S,
    ) -> Result<Option<Step<'_, L, E, S>>, TransitionError> {
        self.first(location, state, |transition| transition.event == event)
    }

    /// Takes the transition that [`enabled`](Self::enabled) finds, if there is one.
    ///
    /// # Errors
    ///
    /// As for [`enabled`](Self::enabled); location and state are then as before.
    pub fn step(
        &self,
        location: &mut L,
        state: &mut S,
    ) -> Result<Option<Jump<L, E>>, TransitionError> {
        self.enabled(*location, state)?.map(|step| step.fire(location, state)).transpose()
    }

    /// Takes the transition that [`enabled`](Self::enabled) finds from the place where `state`
    /// stands, if there is one.
    ///
    /// # Errors
    ///
    /// As for [`enabled`](Self::enabled); the state is then as before.
    pub fn step_in_place<P>(&self, state: &mut S) -> Result<Option<Jump<L, E>>, TransitionError>
    where
        P: Place<Location = L>,
        S: Holds<P>,
    {
        let mut location = state.current().location();
        self.step(&mut location, state)
    }

    fn first(
        &self,
        location: L,
        state: &S,
        eligible: impl Fn(&Transition<E, S>) -> bool,
    ) -> Result<Option<Step<'_, L, E, S>>, TransitionError> {
        debug_assert_eq!(self.exclusion.violation(state), None, "these exclude each other");
        let leaving = self.node(location).and_then(|node| self.leaving.get(node.index()));
        for &edge in leaving.map_or(&[][..], Vec::as_slice) {
            let transition = &self.graph[edge];
            if eligible(transition) && transition.allows(location, state)? {
                let (row, tally) = (edge.index(), self.tally.as_ref());
                let target = self.rows[row].target;
                return Ok(Some(Step { source: location, target, transition, row, tally }));
            }
        }
        Ok(None)
    }
}

impl<E: Event, S: Valuation> Transition<E, S> {
    fn allows<L: Location>(&self, location: L, state: &S) -> Result<bool, TransitionError> {
        let part = || format!("guard `{}`", self.guard.name());
        observed::holds(self.guard.predicate(), self.watch.as_ref(), state)
            .map_err(|source| self.error(location, part(), source))
    }

    fn error<L: Location>(
        &self,
        location: L,
        part: String,
        source: EvaluationError,
    ) -> TransitionError {
        TransitionError { location: location.name(), event: self.event.name(), part, source }
    }
}

impl<'a, L: Location, E: Event, S> Step<'a, L, E, S> {
    /// The transition.
    pub fn transition(&self) -> &'a Transition<E, S> {
        self.transition
    }

    /// The jump that [`fire`](Self::fire) makes.
    pub fn jump(&self) -> Jump<L, E> {
        Jump { source: self.source, event: self.transition.event, target: self.target }
    }

    /// Takes the transition: resets the state and enters the target.
    ///
    /// # Errors
    ///
    /// [`TransitionError`] if the reset cannot be evaluated; location and state are then as before.
    pub fn fire(self, location: &mut L, state: &mut S) -> Result<Jump<L, E>, TransitionError>
    where
        S: Valuation,
    {
        let Transition { reset, .. } = self.transition;
        let failed = |source| self.transition.error(self.source, "reset".into(), source);
        reset.apply(state).map_err(failed)?;
        *location = self.target;
        if let Some(tally) = self.tally {
            tally.count(self.row);
        }
        Ok(self.jump())
    }
}
