//! The search for a run that comes to a forbidden state: random, then local.
//!
//! The margin of the forbidden states, at its largest along a run, says how near the run comes to
//! them. Runs are drawn over initial states, constant values of inputs and parameters, and policies
//! for transitions that may be taken; then the nearest ones are varied less and less.

use pleach_automaton::composition::Policy;
use pleach_automaton::{Automaton, Composition, Coordinates, HybridTime, Trajectory, sweep};
use pleach_discrete::{Event, Location};
use pleach_guards::Interval;

use super::model::Uncertain;
use super::question::Forbidden;
use super::set::StateSet;

/// How much is searched.
#[derive(Clone, Debug, PartialEq)]
pub struct Effort {
    /// How many runs are drawn at random.
    pub random: usize,
    /// How often the nearest runs are varied.
    pub rounds: usize,
    /// How many runs are tried each time.
    pub variations: usize,
    /// Where the sequence of draws begins.
    pub seed: u64,
    /// How long runs last where the question has no horizon, in seconds.
    pub longest: f64,
}

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

impl Default for Effort {
    fn default() -> Self {
        Effort { random: 64, rounds: 8, variations: 16, seed: 1, longest: 100.0 }
    }
}

/// What a run is made from: the numbers from −1 to 1 that stand for all choices.
#[derive(Clone, Debug)]
struct Choices {
    start: usize,
    shares: Vec<f64>,
    policy: Policy,
}

/// Numbers that look random, the same for the same seed (Steele, Lea and Flood 2014, *Fast splittable
/// pseudorandom number generators*).
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// From −1 to 1.
    fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

/// Searches for a run that comes to forbidden states, and returns the nearest found; `None` if no run
/// could be made.
///
/// Inputs have one value throughout a run, though they may vary.
pub fn falsify<L: Location + Sync, E: Event + Sync, S: Coordinates>(
    automaton: &Automaton<L, E, S>,
    uncertain: &[Uncertain],
    starts: &[StateSet],
    forbidden: &[Forbidden],
    horizon: f64,
    effort: &Effort,
) -> Option<Counterexample> {
    let horizon = horizon.min(effort.longest.max(if horizon.is_finite() { horizon } else { 0.0 }));
    let search = Search { automaton, uncertain, starts, forbidden, horizon };
    let mut draws = Draws(effort.seed);
    let length = search.choices();
    let drawn = |draws: &mut Draws| {
        let shares = (0..length).map(|_| match draws.below(2) {
            0 => draws.share().signum(),
            _ => draws.share(),
        });
        let shares = shares.collect();
        let policy = match draws.below(3) {
            0 => Policy::Late,
            1 => Policy::Early,
            _ => Policy::Random { seed: draws.next() },
        };
        Choices { start: draws.below(starts.len()), shares, policy }
    };
    let mut cases: Vec<Choices> = (0..effort.random).map(|_| drawn(&mut draws)).collect();
    let mut best: Option<(Counterexample, Choices)> = None;
    let mut reach = 0.5;
    for _ in 0..=effort.rounds {
        let found = sweep(&cases, |_, _| (), |case| search.run(case));
        for (found, case) in found.into_iter().zip(cases) {
            let Some(found) = found else { continue };
            if best.as_ref().is_none_or(|(known, _)| found.margin > known.margin) {
                best = Some((found, case));
            }
        }
        let Some((nearest, choices)) = &best else { return None };
        if nearest.is_violation {
            break;
        }
        cases = (0..effort.variations)
            .map(|_| {
                let vary = |share: &f64| (share + reach * draws.share()).clamp(-1.0, 1.0);
                Choices { shares: choices.shares.iter().map(vary).collect(), ..choices.clone() }
            })
            .collect();
        reach *= 0.6;
    }
    best.map(|(found, _)| found)
}

struct Search<'a, L, E, S> {
    automaton: &'a Automaton<L, E, S>,
    uncertain: &'a [Uncertain],
    starts: &'a [StateSet],
    forbidden: &'a [Forbidden],
    horizon: f64,
}

impl<L: Location, E: Event, S: Coordinates> Search<'_, L, E, S> {
    /// How many numbers choose a run.
    fn choices(&self) -> usize {
        let generators = self.starts.iter().map(|start| start.to_zonotope().generators().len());
        generators.max().unwrap_or(0) + self.uncertain.len()
    }

    /// The run that is chosen, and where it comes nearest to forbidden states.
    fn run(&self, choices: &Choices) -> Option<Counterexample> {
        let mut shares = choices.shares.iter().copied();
        let varying = self.uncertain.iter().filter(|one| one.varies);
        let mut parameters: Vec<(String, f64)> = varying
            .map(|one| (one.parameter.clone(), at(one.values, shares.next().unwrap_or(0.0))))
            .collect();
        let rest: Vec<f64> = shares.collect();
        let mut position = 0;
        let mut draw = || {
            position += 1;
            rest.get((position - 1) % rest.len().max(1)).copied().unwrap_or(0.0)
        };
        let start = self.starts.get(choices.start)?.point(&mut draw);
        let example = self.automaton.initial_state()?;
        let (coordinates, constants) = start.split_at_checked(example.names().len())?;
        let resting = self.uncertain.iter().filter(|one| !one.varies);
        parameters
            .extend(resting.zip(constants).map(|(one, value)| (one.parameter.clone(), *value)));
        let mut automaton = self.automaton.clone();
        for (parameter, value) in &parameters {
            automaton = automaton.with(parameter, *value).ok()?;
        }
        let state = example.like(coordinates);
        let composition =
            Composition::builder().add_in("automaton", &automaton, state).build().ok()?;
        let settings = pleach_automaton::Settings { policy: choices.policy, ..Default::default() };
        let trajectory = composition.run_with(settings, self.horizon).ok()?;
        let (forbidden, at, state, margin, is_violation) =
            self.nearest(&trajectory, &parameters)?;
        Some(Counterexample {
            start,
            parameters,
            forbidden,
            at,
            state,
            margin,
            is_violation,
            trajectory,
        })
    }

    /// Where a run comes nearest to forbidden states.
    fn nearest(
        &self,
        trajectory: &Trajectory,
        parameters: &[(String, f64)],
    ) -> Option<(usize, HybridTime, Vec<f64>, f64, bool)> {
        let names = &trajectory.components().first()?.locations;
        let mut nearest: Option<(usize, HybridTime, Vec<f64>, f64, bool)> = None;
        for (j, (location, states)) in (0..).zip(followed(trajectory)) {
            let location = names.get(location)?;
            let here = |one: &Forbidden| one.location.as_ref().is_none_or(|name| name == location);
            for (number, one) in self.forbidden.iter().enumerate().filter(|(_, one)| here(one)) {
                for (t, values) in &states {
                    let own = trajectory.variables().iter().zip(values);
                    let own = own.map(|(name, value)| (name.as_str(), *value));
                    let fixed = parameters.iter().map(|(name, value)| (name.as_str(), *value));
                    let state: Vec<(&str, f64)> = own.chain(fixed).collect();
                    let Ok(verdict) = one.states.evaluate(&state[..]) else { continue };
                    if nearest.as_ref().is_none_or(|(.., margin, _)| verdict.margin > *margin) {
                        let at = HybridTime { t: *t, j };
                        nearest = Some((number, at, values.clone(), verdict.margin, verdict.holds));
                    }
                }
            }
        }
        nearest
    }
}

/// A time in seconds, and the values of the variables then.
pub type TimedState = (f64, Vec<f64>);

/// What lies between the jumps of a run: the number of the location of its first component, and times
/// with states, also between the samples.
pub fn followed(trajectory: &Trajectory) -> Vec<(usize, Vec<TimedState>)> {
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

/// The number at a share from −1 to 1 of the way.
fn at(values: Interval, share: f64) -> f64 {
    let middle = values.midpoint();
    (middle + share * 0.5 * values.width()).clamp(values.lower(), values.upper())
}
