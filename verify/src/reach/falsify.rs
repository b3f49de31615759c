//! The search for a run that comes to a forbidden state.
//!
//! The margin of the forbidden states, at its largest along a run, says how near the run comes to them.

use pleach_automaton::{Automaton, Coordinates, HybridTime, Trajectory};
use pleach_discrete::{Event, Location};
use pleach_guards::{Predicate, Substitution, constant};

use super::model::Uncertain;
use super::question::Forbidden;
use super::search::{Effort, Nearness, Run, Search, Starts};
use super::settings::Settings;
use crate::temporal::{Formula, Status, eventually, within};

/// The run that comes nearest to forbidden states.
#[derive(Clone, Debug)]
pub struct Counterexample {
    /// Where it begins.
    pub start: Vec<f64>,
    /// The values of inputs and parameters.
    pub parameters: Vec<(String, f64)>,
    /// The number of the forbidden set that it comes nearest to.
    pub forbidden: usize,
    /// When.
    pub at: HybridTime,
    /// The state then.
    pub state: Vec<f64>,
    /// The margin of the forbidden states there.
    pub margin: f64,
    /// Whether it comes to them.
    pub is_violation: bool,
    /// The run.
    pub trajectory: Trajectory,
}

/// The instant at which a run is nearest.
struct Nearest {
    forbidden: usize,
    at: HybridTime,
    state: Vec<f64>,
    margin: f64,
    holds: bool,
}

impl Nearness for Nearest {
    fn margin(&self) -> f64 {
        self.margin
    }

    fn is_there(&self) -> bool {
        self.holds
    }
}

/// Searches for a run that comes to forbidden states, and returns the nearest found; `None` if no run
/// could be made.
///
/// Inputs have one value throughout a run, though they may vary. A run that is at a forbidden state only within the error
/// of its solution is no violation.
pub fn falsify<'a, L: Location + Sync, E: Event + Sync, S: Coordinates>(
    automaton: &Automaton<L, E, S>,
    uncertain: &[Uncertain],
    starts: impl Into<Starts<'a>>,
    forbidden: &[Forbidden],
    settings: &Settings,
    effort: &Effort,
) -> Option<Counterexample> {
    let search = Search::new(automaton, uncertain, starts.into(), settings, effort.longest);
    let (run, nearest) = search.nearest(effort, |run| nearest(run, forbidden))?;
    let Run { start, parameters, trajectory, .. } = run;
    let Nearest { forbidden, at, state, margin, holds } = nearest;
    Some(Counterexample {
        start,
        parameters,
        forbidden,
        at,
        state,
        margin,
        is_violation: holds,
        trajectory,
    })
}

/// Where a run comes nearest to forbidden states.
fn nearest(run: &Run, forbidden: &[Forbidden]) -> Option<Nearest> {
    let Run { trajectory, parameters, lawful, .. } = run;
    let names = trajectory.components().first()?.locations.iter().map(String::as_str);
    let places: Vec<Vec<bool>> = forbidden.iter().map(|one| one.places(names.clone())).collect();
    let mut nearest: Option<Nearest> = None;
    for (j, (location, states)) in (0..).zip(followed(trajectory)).take(*lawful) {
        let here = |number: usize| places[number].get(location) == Some(&true);
        for (number, one) in forbidden.iter().enumerate().filter(|(number, _)| here(*number)) {
            for (t, values) in &states {
                let own = trajectory.variables().iter().zip(values);
                let own = own.map(|(name, value)| (name.as_str(), *value));
                let fixed = parameters.iter().map(|(name, value)| (name.as_str(), *value));
                let state: Vec<(&str, f64)> = own.chain(fixed).collect();
                let Ok(verdict) = one.states.evaluate(&state[..]) else { continue };
                if nearest.as_ref().is_none_or(|known| verdict.margin > known.margin) {
                    nearest = Some(Nearest {
                        forbidden: number,
                        at: HybridTime { t: *t, j },
                        state: values.clone(),
                        margin: verdict.margin,
                        holds: verdict.holds,
                    });
                }
            }
        }
    }
    if let Some(found) = &mut nearest
        && found.holds
    {
        let fixed = parameters.iter().map(|(name, value)| (name.clone(), constant(*value)));
        let states = forbidden[found.forbidden].states.substitute(&Substitution::new(fixed));
        found.holds = certainly_holds(states, trajectory, found.at.t);
    }
    nearest
}

/// Whether a predicate holds at a time of a run, however large the error of the solution is within its bounds.
fn certainly_holds(states: Predicate, trajectory: &Trajectory, t: f64) -> bool {
    let Ok(then) = within(t, t) else { return false };
    let judged = eventually(then, Formula::holds(states)).judge(trajectory);
    judged.is_ok_and(|judgement| judgement.status == Status::Satisfied)
}

/// A time in seconds, and the values of the variables then.
type TimedState = (f64, Vec<f64>);

/// What lies between the jumps of a run: the number of the location of its first component, and times
/// with states, also between the samples.
fn followed(trajectory: &Trajectory) -> Vec<(usize, Vec<TimedState>)> {
    /// How many states there are from one sample to the next.
    const PARTS: u32 = 8;
    let between = |phase: pleach_automaton::trajectory::FlowInterval| {
        let mut states: Vec<TimedState> = Vec::new();
        for pair in phase.samples.windows(2) {
            states.push((pair[0].t, pair[0].values.clone()));
            for part in 1..PARTS {
                let share = f64::from(part) / f64::from(PARTS);
                let t = pair[0].t + share * (pair[1].t - pair[0].t);
                if pair[0].t < t && t < pair[1].t {
                    states.extend(trajectory.values_at(t).map(|values| (t, values)));
                }
            }
        }
        states.extend(phase.samples.last().map(|last| (last.t, last.values.clone())));
        (phase.locations.first().copied().unwrap_or(0), states)
    };
    trajectory.intervals().map(between).collect()
}
