//! Random formulas and trajectories on which brute force is exact.
//!
//! The trajectories have slopes −1, 0 and 1, and jump and bend only at whole seconds, between
//! whole values; bounds of formulas are whole too. Then every robustness bends only at multiples
//! of ½ s and is a multiple of ½ there, however deep the formula.

use pleach_automaton::HybridTime;
use pleach_guards::{Predicate, variable};
use pleach_verify::temporal::{Formula, Window, always, eventually, not, within};
use proptest::prelude::*;

pub type State = [(&'static str, f64); 2];

#[derive(Clone, Debug)]
pub struct Trajectory {
    pub samples: Vec<(i32, [i32; 2])>,
}

impl Trajectory {
    pub fn samples(&self) -> Vec<(f64, State)> {
        self.samples
            .iter()
            .map(|(t, values)| (f64::from(*t), state(values.map(f64::from))))
            .collect()
    }

    pub fn duration(&self) -> f64 {
        f64::from(self.samples.last().unwrap().0)
    }

    /// The states at time `t`: all of a jump, or the one in a flow; none beyond the end.
    pub fn states_at(&self, t: f64) -> Vec<State> {
        let here = self.samples().into_iter().filter(|(time, _)| *time == t);
        let here: Vec<State> = here.map(|(_, state)| state).collect();
        if !here.is_empty() {
            return here;
        }
        let pairs = self.samples.windows(2).map(|pair| (&pair[0], &pair[1]));
        let around = |from: i32, to: i32| f64::from(from) < t && t < f64::from(to);
        let Some((from, to)) = pairs.into_iter().find(|(from, to)| around(from.0, to.0)) else {
            return vec![];
        };
        let part = (t - f64::from(from.0)) / f64::from(to.0 - from.0);
        let value =
            |name: usize| f64::from(from.1[name]) + part * f64::from(to.1[name] - from.1[name]);
        vec![state([value(0), value(1)])]
    }

    pub fn state_at(&self, at: HybridTime) -> State {
        let before = self
            .samples
            .windows(2)
            .filter(|pair| pair[0].0 == pair[1].0 && f64::from(pair[0].0) < at.t);
        let states = self.states_at(at.t.min(self.duration()));
        states[at.j as usize - before.count()]
    }
}

fn state([x, y]: [f64; 2]) -> State {
    [("x", x), ("y", y)]
}

pub fn trajectories() -> impl Strategy<Value = Trajectory> {
    let values = || prop::array::uniform2(-3..=3);
    let jumps = prop_oneof![3 => Just(0_usize), 2 => Just(1), 1 => Just(2)];
    let step = (jumps, prop::array::uniform2(-1..=1), values(), values());
    (values(), prop::collection::vec(step, 7)).prop_map(|(first, steps)| {
        let mut samples = vec![(0, first)];
        for (t, (jumps, slopes, one, other)) in steps.into_iter().enumerate() {
            let t = t as i32;
            samples.extend([one, other].into_iter().take(jumps).map(|values| (t, values)));
            let last = samples.last().unwrap().1;
            samples.push((t + 1, [last[0] + slopes[0], last[1] + slopes[1]]));
        }
        Trajectory { samples }
    })
}

pub fn windows() -> impl Strategy<Value = Window> {
    let length = prop_oneof![4 => (0..=3).prop_map(f64::from), 1 => Just(f64::INFINITY)];
    (0..=2, length)
        .prop_map(|(start, length)| within(f64::from(start), f64::from(start) + length).unwrap())
}

fn predicates() -> impl Strategy<Value = Predicate> {
    let comparison =
        (prop::sample::select(vec!["x", "y"]), -2..=2, 0..4).prop_map(|(name, bound, relation)| {
            let (variable, bound) = (variable(name), f64::from(bound));
            match relation {
                0 => variable.at_most(bound),
                1 => variable.less_than(bound),
                2 => variable.at_least(bound),
                _ => variable.more_than(bound),
            }
        });
    comparison.prop_recursive(1, 3, 2, |inner| {
        prop_oneof![
            inner.clone().prop_map(pleach_guards::not),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| a.and(b)),
            (inner.clone(), inner).prop_map(|(a, b)| a.or(b)),
        ]
    })
}

pub fn formulas() -> impl Strategy<Value = Formula> {
    predicates().prop_map(Formula::holds).prop_recursive(3, 8, 2, |inner| {
        let pair = || (inner.clone(), inner.clone());
        prop_oneof![
            1 => inner.clone().prop_map(not),
            1 => pair().prop_map(|(a, b)| a.and(b)),
            1 => pair().prop_map(|(a, b)| a.or(b)),
            1 => pair().prop_map(|(a, b)| a.implies(b)),
            3 => (windows(), inner.clone()).prop_map(|(window, a)| always(window, a)),
            3 => (windows(), inner.clone()).prop_map(|(window, a)| eventually(window, a)),
            4 => (windows(), pair()).prop_map(|(window, (a, b))| a.until(window, b)),
        ]
    })
}
