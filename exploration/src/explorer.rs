//! The breadth-first visit of all states.

use std::fmt::Debug;
use std::hash::Hash;

use indexmap::IndexSet;
use rustc_hash::FxBuildHasher;

/// A discrete system: where it starts, and what may happen in each of its states.
///
/// The receiver is `&mut self` so that a model may remember what it has computed; what it answers
/// must not depend on that.
pub trait Model {
    /// A state; equal states have equal futures.
    type State: Clone + Eq + Hash;
    /// What happens, by name.
    type Action: Copy + Ord + Debug;
    /// Why the model cannot say what happens.
    type Error: std::error::Error;

    /// The states in which it may start.
    ///
    /// # Errors
    /// When the model is not well formed.
    fn initial(&mut self) -> Result<Vec<Self::State>, Self::Error>;

    /// Everything that may happen in `state`, and the state that follows.
    ///
    /// # Errors
    /// When the model cannot say.
    fn successors(&mut self, state: &Self::State) -> Result<Successors<Self>, Self::Error>;

    /// The state that stands for all those that are the same as `state` but for a symmetry.
    fn representative(&self, state: Self::State) -> Self::State {
        state
    }
}

/// What may happen in a state of a model, and the states that follow.
pub type Successors<M> = Vec<(<M as Model>::Action, <M as Model>::State)>;

/// An exploration of a model, or why it came to no end.
pub type Explored<M> = Result<
    StateGraph<<M as Model>::State, <M as Model>::Action>,
    ExplorationError<<M as Model>::Error>,
>;

/// What is to hold in every state.
#[derive(Debug)]
pub struct Property<M: Model + ?Sized> {
    /// Its name.
    pub name: &'static str,
    /// Whether it holds.
    pub holds: fn(&M, &M::State) -> bool,
}

/// The number of a state, in the order of the visit.
pub type StateId = u32;

/// A state in which a property does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Violation {
    /// The property's name.
    pub property: &'static str,
    /// The first such state, one of those nearest to the beginning.
    pub state: StateId,
}

/// Why an exploration came to no end.
#[derive(Debug, thiserror::Error)]
pub enum ExplorationError<E: std::error::Error> {
    /// There are more states than allowed.
    #[error("there are more than the {limit} states allowed")]
    TooManyStates {
        /// How many were allowed.
        limit: usize,
    },
    /// The model cannot say what happens.
    #[error(transparent)]
    Model(E),
}

/// All states that a model can reach, and everything that may happen between them.
#[derive(Debug)]
pub struct StateGraph<S, A> {
    states: Vec<S>,
    origins: Vec<Option<(StateId, A)>>,
    /// The transitions of state `i` are those from `begins[i]` to `begins[i + 1]`.
    pub(super) begins: Vec<usize>,
    pub(super) transitions: Vec<(A, StateId)>,
    violations: Vec<Violation>,
    is_complete: bool,
}

/// How many states are visited after one in which a property fails.
const BEYOND_A_VIOLATION: usize = 50_000;

/// Visits every state of `model`, at most `limit` of them, and checks each with `properties`.
///
/// A property that fails is reported once, in the first state where it does; the visit goes on for some states:
/// what follows from it may have no end.
///
/// # Errors
/// When there are more states than `limit`, or the model cannot say what happens.
pub fn explore<M: Model>(model: &mut M, properties: &[Property<M>], limit: usize) -> Explored<M> {
    let mut visit = Visit { states: IndexSet::default(), origins: Vec::new() };
    for state in model.initial().map_err(ExplorationError::Model)? {
        visit.meet(model.representative(state), None);
    }
    let (mut begins, mut transitions, mut violations) = (vec![0], Vec::new(), Vec::new());
    while let Some(state) = visit.states.get_index(begins.len() - 1).cloned() {
        let id = (begins.len() - 1) as StateId;
        for property in properties {
            let known = violations.iter().any(|v: &Violation| v.property == property.name);
            if !known && !(property.holds)(model, &state) {
                violations.push(Violation { property: property.name, state: id });
            }
        }
        let found = violations.first().map(|first| first.state as usize);
        if found.is_some_and(|found| begins.len() > found + BEYOND_A_VIOLATION) {
            break;
        }
        for (action, next) in model.successors(&state).map_err(ExplorationError::Model)? {
            let next = visit.meet(model.representative(next), Some((id, action)));
            transitions.push((action, next));
        }
        if visit.states.len() > limit {
            return Err(ExplorationError::TooManyStates { limit });
        }
        begins.push(transitions.len());
    }
    let Visit { states, origins, .. } = visit;
    let is_complete = begins.len() > states.len();
    begins.resize(states.len() + 1, transitions.len());
    let states = states.into_iter().collect();
    Ok(StateGraph { states, origins, begins, transitions, violations, is_complete })
}

struct Visit<S, A> {
    /// In the order in which they are met.
    states: IndexSet<S, FxBuildHasher>,
    origins: Vec<Option<(StateId, A)>>,
}

impl<S: Eq + Hash, A> Visit<S, A> {
    fn meet(&mut self, state: S, origin: Option<(StateId, A)>) -> StateId {
        let (id, is_new) = self.states.insert_full(state);
        if is_new {
            self.origins.push(origin);
        }
        id as StateId
    }
}

impl<S, A: Copy> StateGraph<S, A> {
    /// The states, in the order of the visit.
    pub fn states(&self) -> &[S] {
        &self.states
    }

    /// How many transitions there are.
    pub fn transition_count(&self) -> usize {
        self.transitions.len()
    }

    /// Whether all states have been visited: they have if no property fails.
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// The properties that fail, each with the first state in which it does.
    pub fn violations(&self) -> &[Violation] {
        &self.violations
    }

    /// What may happen in a state, and the state that follows.
    pub fn after(&self, state: StateId) -> &[(A, StateId)] {
        let at = state as usize;
        &self.transitions[self.begins[at]..self.begins[at + 1]]
    }

    /// A shortest way to a state: what happens, and the state that follows; with the state where
    /// it starts.
    pub fn way_to(&self, state: StateId) -> (StateId, Vec<(A, StateId)>) {
        let (mut at, mut way) = (state, Vec::new());
        while let Some((before, action)) = self.origins[at as usize] {
            way.push((action, at));
            at = before;
        }
        way.reverse();
        (at, way)
    }

    /// The number of steps to the state that is farthest from the beginning.
    pub fn depth(&self) -> usize {
        let mut depths: Vec<usize> = Vec::with_capacity(self.origins.len());
        for origin in &self.origins {
            depths.push(origin.map_or(0, |(before, _)| depths[before as usize] + 1));
        }
        depths.into_iter().max().unwrap_or(0)
    }
}
