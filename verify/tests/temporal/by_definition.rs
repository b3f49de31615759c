//! The semantics as it is defined, in quadratic time on a fine grid of instants.

use pleach_guards::{Predicate, Verdict};
use pleach_verify::temporal::{Formula, Window};

use super::random::{State, Trajectory};

/// Instants of the grid in a second. Limits are off by at most one step for each temporal
/// operator around another, which for the depth of 3 is less than ¼.
const STEPS: i32 = 16;

#[derive(Clone, Copy)]
pub enum Reading {
    Margin,
    Truth,
}

/// Instants in the order of hybrid time: the time in steps, and the state, if it is known.
pub struct Grid {
    instants: Vec<(i32, Option<State>)>,
}

impl Grid {
    pub fn new(trajectory: &Trajectory, horizon: f64) -> Grid {
        // Infinite windows see enough of what is not known within 12 s: starts add up to less.
        let beyond = if horizon.is_finite() { horizon } else { 12.0 };
        let end = (trajectory.duration() + beyond + 1.0) as i32 * STEPS;
        let mut instants = Vec::new();
        for step in 0..=end {
            let states = trajectory.states_at(f64::from(step) / f64::from(STEPS));
            if states.is_empty() {
                instants.push((step, None));
            }
            instants.extend(states.into_iter().map(|state| (step, Some(state))));
        }
        Grid { instants }
    }

    pub fn value(&self, formula: &Formula, reading: Reading, beyond: f64) -> f64 {
        self.values(formula, reading, beyond)[0]
    }

    fn values(&self, formula: &Formula, reading: Reading, beyond: f64) -> Vec<f64> {
        let values = |formula: &Formula| self.values(formula, reading, beyond);
        match formula {
            Formula::Holds(predicate) => {
                let values = self.instants.iter().map(|(_, state)| match state {
                    Some(state) => margin(predicate, state, reading),
                    None => beyond,
                });
                values.collect()
            }
            Formula::Not(inner) => negated(self.values(inner, reading, -beyond)),
            Formula::All(parts) => {
                parts.iter().map(values).reduce(|a, b| zip(a, b, f64::min)).unwrap()
            }
            Formula::Any(parts) => {
                parts.iter().map(values).reduce(|a, b| zip(a, b, f64::max)).unwrap()
            }
            Formula::Implies(a, b) => {
                zip(negated(self.values(a, reading, -beyond)), values(b), f64::max)
            }
            Formula::Always(window, inner) => {
                let values = values(inner);
                self.over(*window, beyond, |_, instants| {
                    instants.iter().map(|&at| values[at]).fold(f64::INFINITY, f64::min)
                })
            }
            Formula::Eventually(window, inner) => {
                let values = values(inner);
                self.over(*window, beyond, |_, instants| {
                    instants.iter().map(|&at| values[at]).fold(f64::NEG_INFINITY, f64::max)
                })
            }
            Formula::Until(window, safe, goal) => {
                let (safe, goal) = (values(safe), values(goal));
                self.over(*window, beyond, |now, instants| {
                    let mut best = f64::NEG_INFINITY;
                    let (mut passed, mut held) = (now, f64::INFINITY);
                    for &at in instants {
                        while passed < at {
                            held = held.min(safe[passed]);
                            passed += 1;
                        }
                        // In a flow, φ just before an instant is φ at that instant.
                        let flows = at > now && self.instants[at].0 % STEPS != 0;
                        let just_before = if flows { safe[at] } else { f64::INFINITY };
                        best = best.max(goal[at].min(held).min(just_before));
                    }
                    best
                })
            }
            other => panic!("no such formula is generated: {other}"),
        }
    }

    /// At every instant, the value of those in the window from it; `beyond` where the window lies
    /// beyond the end of the grid.
    fn over(
        &self,
        window: Window,
        beyond: f64,
        value: impl Fn(usize, &[usize]) -> f64,
    ) -> Vec<f64> {
        let at = |now: usize| {
            let from = self.instants[now].0 + window.start() as i32 * STEPS;
            let to = f64::from(self.instants[now].0) + window.end() * f64::from(STEPS);
            let inside = |at: &usize| {
                let step = self.instants[*at].0;
                from <= step && f64::from(step) <= to
            };
            let instants: Vec<usize> = (now..self.instants.len()).filter(inside).collect();
            if instants.is_empty() { beyond } else { value(now, &instants) }
        };
        (0..self.instants.len()).map(at).collect()
    }
}

fn margin(predicate: &Predicate, state: &State, reading: Reading) -> f64 {
    let Verdict { margin, holds } = predicate.evaluate(state).unwrap();
    match reading {
        Reading::Margin => margin,
        Reading::Truth if holds => 1.0,
        Reading::Truth => -1.0,
    }
}

fn negated(values: Vec<f64>) -> Vec<f64> {
    values.into_iter().map(|value| -value).collect()
}

fn zip(one: Vec<f64>, other: Vec<f64>, choose: fn(f64, f64) -> f64) -> Vec<f64> {
    one.into_iter().zip(other).map(|(a, b)| choose(a, b)).collect()
}
