//! The search for a run that is as near as can be to something: random, then local, in parallel.
//!
//! Runs are drawn over initial states, constant values of inputs and parameters, and policies for
//! transitions that may be taken; then the nearest one is varied less and less.

use pleach_automaton::composition::Policy;
use pleach_automaton::trajectory::{FlowInterval, Sample};
use pleach_automaton::{Automaton, Composition, Coordinates, Trajectory, sweep};
use pleach_discrete::{Event, Location};
use pleach_guards::{Interval, Predicate, Substitution, constant};

use super::model::Uncertain;
use super::set::StateSet;
use super::settings::Settings;
use crate::draws::Draws;

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

/// A run that was drawn.
#[derive(Clone, Debug)]
pub struct Run {
    /// Where it begins: the coordinates, then the parameters that rest.
    pub start: Vec<f64>,
    /// The values of inputs and parameters.
    pub parameters: Vec<(String, f64)>,
    /// The run.
    pub trajectory: Trajectory,
    /// How many of its phases count: those before one that begins outside the invariant of its location, where
    /// runs may not come.
    pub lawful: usize,
}

/// Where runs that are searched for begin.
#[derive(Clone, Copy, Debug)]
pub struct Starts<'a> {
    /// In these sets.
    pub sets: &'a [StateSet],
    /// And only where this holds of the coordinates and parameters. It excludes states that the sets include, such as
    /// the boundary of a strict comparison.
    pub condition: Option<&'a Predicate>,
}

impl<'a> From<&'a [StateSet]> for Starts<'a> {
    fn from(sets: &'a [StateSet]) -> Self {
        Starts { sets, condition: None }
    }
}

/// Runs that are drawn at random, `count` of them or less where runs cannot be made: from points of
/// `starts`, as often corners as others, with constant values of inputs and parameters and any policy.
/// They are the same for the same seed.
pub fn runs<'a, L: Location + Sync, E: Event + Sync, S: Coordinates>(
    automaton: &Automaton<L, E, S>,
    uncertain: &[Uncertain],
    starts: impl Into<Starts<'a>>,
    settings: &Settings,
    count: usize,
    seed: u64,
) -> Vec<Run> {
    let longest = Effort::default().longest;
    let search = Search::new(automaton, uncertain, starts.into(), settings, longest);
    let mut draws = Draws(seed);
    let cases: Vec<Choices> = (0..count).map(|_| search.drawn(&mut draws)).collect();
    sweep(&cases, |_, _| (), |case| search.run(case)).into_iter().flatten().collect()
}

/// How near a run has come.
pub(super) trait Nearness: Send {
    /// The larger, the nearer.
    fn margin(&self) -> f64;
    /// Whether the search is over.
    fn is_there(&self) -> bool;
}

impl Default for Effort {
    fn default() -> Self {
        Effort { random: 64, rounds: 8, variations: 16, seed: 1, longest: 100.0 }
    }
}

/// How many jumps a run has at most; it counts up to there.
const JUMPS: u64 = 10_000;
/// How many bytes a run takes at most; it counts up to there.
const MEMORY: u64 = 1 << 26;

/// What a run is made from: the numbers from −1 to 1 that stand for all choices.
#[derive(Clone, Debug)]
struct Choices {
    start: usize,
    shares: Vec<f64>,
    policy: Policy,
}

/// What runs are drawn from.
pub(super) struct Search<'a, L, E, S> {
    pub automaton: &'a Automaton<L, E, S>,
    pub uncertain: &'a [Uncertain],
    pub starts: Starts<'a>,
    pub horizon: f64,
    /// Whether runs come only to states in the invariants of their locations.
    pub enters_invariants: bool,
}

impl<'a, L: Location + Sync, E: Event + Sync, S: Coordinates> Search<'a, L, E, S> {
    /// Among runs up to the horizon of the settings or, where there is none, for `longest` seconds.
    pub(super) fn new(
        automaton: &'a Automaton<L, E, S>,
        uncertain: &'a [Uncertain],
        starts: Starts<'a>,
        settings: &Settings,
        longest: f64,
    ) -> Self {
        let Settings { horizon, enters_invariants, .. } = *settings;
        let horizon = if horizon.is_finite() { horizon } else { longest };
        Search { automaton, uncertain, starts, horizon, enters_invariants }
    }

    /// The nearest run that is found, as `measure` has it; `None` if no run could be made.
    pub(super) fn nearest<N: Nearness>(
        &self,
        effort: &Effort,
        measure: impl Fn(&Run) -> Option<N> + Sync,
    ) -> Option<(Run, N)> {
        let mut draws = Draws(effort.seed);
        let mut cases: Vec<Choices> = (0..effort.random).map(|_| self.drawn(&mut draws)).collect();
        let mut best: Option<(N, Choices)> = None;
        let mut reach = 0.5;
        for _ in 0..=effort.rounds {
            let tried = |case: &Choices| measure(&self.run(case)?);
            let found = sweep(&cases, |_, _| (), tried);
            for (found, case) in found.into_iter().zip(cases) {
                let Some(nearness) = found else { continue };
                if best.as_ref().is_none_or(|(known, _)| nearness.margin() > known.margin()) {
                    best = Some((nearness, case));
                }
            }
            let Some((nearness, choices)) = &best else { return None };
            if nearness.is_there() {
                break;
            }
            cases = (0..effort.variations).map(|_| choices.varied(reach, &mut draws)).collect();
            reach *= 0.6;
        }
        // Runs are long: the nearest is made again rather than all are kept.
        best.and_then(|(nearness, choices)| Some((self.run(&choices)?, nearness)))
    }

    /// Any choices, corners as often as points between them.
    fn drawn(&self, draws: &mut Draws) -> Choices {
        let generators =
            self.starts.sets.iter().map(|start| start.to_zonotope().generators().len());
        let length = generators.max().unwrap_or(0) + self.uncertain.len();
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
        Choices { start: draws.below(self.starts.sets.len()), shares, policy }
    }

    /// The run that is chosen.
    fn run(&self, choices: &Choices) -> Option<Run> {
        let mut shares = choices.shares.iter().copied();
        let varying = self.uncertain.iter().filter(|one| one.varies);
        let mut parameters: Vec<(String, f64)> = varying
            .map(|one| (one.parameter.clone(), at(one.values, shares.next().unwrap_or(0.0))))
            .collect();
        // Where the shares are used up, further ones follow from them.
        let rest: Vec<f64> = shares.collect();
        let seed = rest.iter().fold(0u64, |seed, share| seed.rotate_left(7) ^ share.to_bits());
        let (mut further, mut rest) = (Draws(seed), rest.into_iter());
        let mut draw = || rest.next().unwrap_or_else(|| further.share());
        let start = self.starts.sets.get(choices.start)?.point(&mut draw)?;
        let example = self.automaton.initial_state()?;
        let (coordinates, constants) = start.split_at_checked(example.names().len())?;
        let resting = self.uncertain.iter().filter(|one| !one.varies);
        parameters
            .extend(resting.zip(constants).map(|(one, value)| (one.parameter.clone(), *value)));
        let resting = parameters.iter().map(|(name, value)| (name.as_str(), *value));
        let named: Vec<(&str, f64)> = example
            .names()
            .iter()
            .copied()
            .zip(coordinates.iter().copied())
            .chain(resting)
            .collect();
        let may_begin = |it: &Predicate| it.evaluate(&named[..]).is_ok_and(|verdict| verdict.holds);
        if !self.starts.condition.is_none_or(may_begin) {
            return None;
        }
        let mut automaton = self.automaton.clone();
        for (parameter, value) in &parameters {
            automaton = automaton.with(parameter, *value).ok()?;
        }
        let state = example.like(coordinates);
        let composition =
            Composition::builder().add_in("automaton", &automaton, state).build().ok()?;
        let settings = pleach_automaton::Settings {
            policy: choices.policy,
            jump_limit: JUMPS,
            memory_limit: MEMORY,
            ..Default::default()
        };
        let trajectory = composition.run_with(settings, self.horizon).ok()?;
        let lawful = match self.enters_invariants {
            true => phases_inside_invariants(&automaton, &trajectory),
            false => trajectory.intervals().len(),
        };
        (lawful > 0).then_some(Run { start, parameters, trajectory, lawful })
    }
}

impl Choices {
    /// Others nearby.
    fn varied(&self, reach: f64, draws: &mut Draws) -> Self {
        let vary = |share: &f64| (share + reach * draws.share()).clamp(-1.0, 1.0);
        Choices { shares: self.shares.iter().map(vary).collect(), ..self.clone() }
    }
}

/// How many phases a run has before one that is outside the invariant of its location. No time passes in such a phase:
/// where some does, rounding alone puts its beginning outside.
fn phases_inside_invariants<L: Location, E: Event, S: Coordinates>(
    automaton: &Automaton<L, E, S>,
    trajectory: &Trajectory,
) -> usize {
    let Some(participant) = trajectory.components().first() else { return 0 };
    let invariant = |location: usize| {
        let name = participant.locations.get(location)?;
        let location = automaton.locations().iter().find(|location| location.name() == name)?;
        automaton.mode(*location)?.invariant.as_ref()
    };
    let numbers = automaton.parameters().map(|(name, value)| (name, constant(value)));
    let numbers = Substitution::new(numbers);
    let is_inside = |phase: &FlowInterval| {
        let [first, last] = [phase.samples.first(), phase.samples.last()];
        let passes_time = first.zip(last).is_some_and(|(first, last)| first.t < last.t);
        let invariant = phase.locations.first().and_then(|location| invariant(*location));
        let holds = |(invariant, state): (&Predicate, &Sample)| {
            let verdict = invariant.substitute(&numbers).evaluate(&trajectory.state(state));
            verdict.is_ok_and(|verdict| verdict.holds)
        };
        passes_time || invariant.zip(first).is_none_or(holds)
    };
    trajectory.intervals().take_while(is_inside).count()
}

/// The number at a share from −1 to 1 of the way.
fn at(values: Interval, share: f64) -> f64 {
    let middle = values.midpoint();
    (middle + share * 0.5 * values.width()).clamp(values.lower(), values.upper())
}
