//! The guards of the role automaton, on every combination of the facts that they speak of.

use pleach_automaton::network::role_automaton;
use pleach_discrete::Event;
use pleach_discrete::network::tables::keeps_places_held;
use pleach_discrete::network::{ROLES, Role, RoleEvent};
use pleach_guards::{Guard, Valuation};

/// What a robot may hold: a fixed post, that of a redundant robot, a place in the primary team, or
/// nothing while it is on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Holding {
    Fixed { serves: bool },
    Free,
    Primary,
    Nothing,
}

/// The facts that role guards speak of.
#[derive(Clone, Copy, Debug)]
struct Facts {
    holding: Holding,
    leads: bool,
    recruited: bool,
    replaced: bool,
    branches: u8,
}

impl Valuation for Facts {
    fn value(&self, variable: &str) -> Option<f64> {
        let yes = |holds| Some(if holds { 1.0 } else { 0.0 });
        match variable {
            "leads" => yes(self.leads),
            "recruited" => yes(self.recruited),
            "replaced" => yes(self.replaced),
            "branches" => Some(f64::from(self.branches)),
            "fixed" => yes(matches!(self.holding, Holding::Fixed { .. })),
            "serves" => yes(self.holding == Holding::Fixed { serves: true }),
            "free" => yes(self.holding == Holding::Free),
            "underway" => yes(matches!(self.holding, Holding::Primary | Holding::Nothing)),
            _ => None,
        }
    }
}

/// Every combination of facts that can be.
fn every_facts() -> impl Iterator<Item = Facts> {
    let holdings = [
        Holding::Fixed { serves: true },
        Holding::Fixed { serves: false },
        Holding::Free,
        Holding::Primary,
        Holding::Nothing,
    ];
    holdings.into_iter().flat_map(|holding| {
        (0..32).map(move |bits| Facts {
            holding,
            leads: bits & 1 != 0,
            recruited: bits & 2 != 0,
            replaced: bits & 4 != 0,
            branches: bits >> 3,
        })
    })
}

/// The guard of each event, as it stands in the automaton that robots run.
fn guards() -> Vec<(RoleEvent, Guard)> {
    let automaton = role_automaton().unwrap();
    let mut guards: Vec<(RoleEvent, Guard)> = Vec::new();
    for transition in automaton.graph().edge_weights() {
        if guards.iter().all(|(event, _)| *event != transition.event) {
            guards.push((transition.event, transition.guard.clone()));
        }
    }
    assert_eq!(guards.len(), RoleEvent::ALL.len());
    guards
}

#[test]
fn at_most_one_role_event_is_possible_at_a_time() {
    let guards = guards();
    for facts in every_facts() {
        let possible: Vec<_> = guards
            .iter()
            .filter(|(_, guard)| guard.holds(&facts).unwrap())
            .map(|(event, _)| event)
            .collect();
        assert!(possible.len() <= 1, "{facts:?}: {possible:?}");
    }
}

/// Table and guards together: whoever goes away from the place of a leaf or junction has been
/// replaced; a junction that stays put is one until its post says otherwise.
#[test]
fn nobody_leaves_the_place_of_a_leaf_or_junction_unreplaced() {
    let (guards, mut departures) = (guards(), 0);
    for facts in every_facts() {
        for &(event, ref guard) in &guards {
            if !guard.holds(&facts).unwrap() {
                continue;
            }
            assert!(facts.replaced || !event.needs_replacement(), "{event:?} {facts:?}");
            for role in [Role::Leaf, Role::Junction] {
                let Ok(target) = ROLES.next(role, event) else { continue };
                assert!(keeps_places_held(role, event, target), "{role:?} {event:?}");
                departures += usize::from(event.needs_replacement());
                let holds_no_post = matches!(facts.holding, Holding::Primary | Holding::Nothing);
                assert!(facts.replaced || facts.leads || !holds_no_post, "{role:?} {facts:?}");
            }
        }
    }
    assert!(departures > 0);
}
