//! What must happen on every fair path, decided on the strongly connected components.

use std::collections::BTreeSet;

use petgraph::algo::kosaraju_scc;
use petgraph::graph::DiGraph;

use super::{StateGraph, StateId};

/// Which paths count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fairness {
    /// An action that stays possible from some moment on is taken at last.
    Weak,
    /// An action that is possible time and again, in the same state, is taken there at last:
    /// every way out that is passed forever is used.
    Strong,
}

impl<S, A: Copy + Ord> StateGraph<S, A> {
    /// Where a fair path may stay forever without coming to a goal: each such set of states by
    /// one of its members that is first in the order of the visit.
    ///
    /// Optional actions, such as faults, may happen a finite number of times and need not happen at all: fairness is
    /// that of the others.
    ///
    /// An infinite path ends in one strongly connected component (with at least one transition),
    /// a finite one in a state where nothing can happen. Under weak fairness a path may stay in a
    /// component if each action is either impossible in one of its states or taken by one of its
    /// transitions: if the whole component does not satisfy this, no part of it does. Under strong
    /// fairness it may stay if no transition leads out. (Baier and Katoen, *Principles of Model
    /// Checking*, MIT Press 2008, Sec. 6.5.)
    pub fn traps(
        &self,
        is_goal: impl Fn(&S) -> bool,
        is_optional: impl Fn(&A) -> bool,
        fairness: Fairness,
    ) -> Vec<StateId> {
        let goals: Vec<bool> = self.states().iter().map(is_goal).collect();
        let after = |state: StateId| {
            let happening = self.after(state).iter().copied();
            happening.filter(|(action, _)| !is_optional(action))
        };
        // Paths that come to a goal need not be followed any further.
        let mut graph: DiGraph<(), (), u32> =
            DiGraph::with_capacity(goals.len(), self.transition_count());
        for _ in &goals {
            graph.add_node(());
        }
        for state in (0..goals.len()).filter(|&state| !goals[state]) {
            for (_, next) in after(state as StateId) {
                graph.add_edge((state as u32).into(), next.into(), ());
            }
        }
        let mut traps: Vec<StateId> = kosaraju_scc(&graph)
            .into_iter()
            .map(|component| component.into_iter().map(|node| node.index() as StateId).collect())
            .filter(|component: &BTreeSet<StateId>| {
                component.iter().all(|&state| !goals[state as usize])
                    && may_be_stayed_in(component, after, fairness)
            })
            .filter_map(|component| component.first().copied())
            .collect();
        traps.sort_unstable();
        traps
    }
}

/// Whether a fair path may stay in a component forever; `after` gives what must happen in a state, and where it leads.
fn may_be_stayed_in<A: Copy + Ord, After: Iterator<Item = (A, StateId)>>(
    component: &BTreeSet<StateId>,
    after: impl Fn(StateId) -> After,
    fairness: Fairness,
) -> bool {
    let stays = |next: &StateId| component.contains(next);
    let mut actions: Vec<(A, StateId)> = component.iter().flat_map(|&state| after(state)).collect();
    if actions.is_empty() {
        return true;
    }
    if fairness == Fairness::Strong {
        return actions.iter().all(|(_, next)| stays(next));
    }
    let taken: BTreeSet<A> =
        actions.iter().filter(|(_, next)| stays(next)).map(|&(action, _)| action).collect();
    actions.retain(|(action, _)| !taken.contains(action));
    let is_rested =
        |action: &A| component.iter().any(|&state| after(state).all(|(other, _)| other != *action));
    !taken.is_empty() && actions.iter().all(|(action, _)| is_rested(action))
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use super::Fairness;
    use crate::{Model, explore};

    /// It goes to and fro between two states, and may be stopped once, from which the goal comes.
    struct Stoppable;

    impl Model for Stoppable {
        type State = u8;
        type Action = &'static str;
        type Error = Infallible;

        fn initial(&mut self) -> Result<Vec<u8>, Infallible> {
            Ok(vec![0])
        }

        fn successors(&mut self, state: &u8) -> Result<Vec<(&'static str, u8)>, Infallible> {
            Ok(match *state {
                goal @ 2.. => vec![("goal", goal)],
                other => vec![("round", 1 - other), ("stop", 2)],
            })
        }
    }

    #[test]
    fn faults_need_not_happen() {
        let exploration = explore::<Stoppable>(&mut Stoppable, &[], 10).unwrap();
        for fairness in [Fairness::Weak, Fairness::Strong] {
            let traps = |optional: &'static str| {
                exploration.traps(|state| *state == 2, |action| *action == optional, fairness)
            };
            assert_eq!(traps("stop"), [0], "{fairness:?}");
            assert!(traps("none").is_empty(), "{fairness:?}");
        }
    }
}
