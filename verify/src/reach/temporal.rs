//! Formulas of signal temporal logic, asked of all runs at once.
//!
//! An enclosure says for each instant in which sets runs are then, and so between which numbers the
//! margin of a predicate is. The robustness of a [`Formula`] grows with the margins of its predicates,
//! so bounds on these give bounds on it, for every run: above 0, all runs satisfy the formula.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use pleach_automaton::{Automaton, Coordinates};
use pleach_discrete::{Event, Location};
use pleach_guards::{Interval, Predicate};

use super::explore::{Completion, Enclosure, explore};
use super::model::{Model, Uncertain};
use super::polytope::Polytope;
use super::question::ReachError;
use super::region::{self, RegionError};
use super::search::{Effort, Nearness, Run, Search, Starts};
use super::set::StateSet;
use super::settings::Settings;
use super::signal::{Grid, Signal};
use crate::temporal::{Formula, Judgement, Robustness, Status};

/// How a formula is answered.
#[derive(Clone, Debug)]
pub enum TemporalAnswer {
    /// All runs satisfy it: a proof.
    Holds(RobustnessProof),
    /// A run violates it, and here it is.
    Violated(Box<Violation>),
    /// Neither was found.
    Undecided(RobustnessProof),
}

/// What an enclosure shows of a formula.
#[derive(Clone, Debug)]
pub struct RobustnessProof {
    /// The enclosures of the runs from each set of initial states.
    pub enclosures: Vec<Enclosure>,
    /// The robustness of every run that lasts to the horizon of the formula is between these.
    pub robustness: Robustness,
    /// When it is open whether some predicate of the formula holds, in seconds: times at which its
    /// margin may be on either side of 0.
    pub open: Vec<(Predicate, Interval)>,
}

/// A run that violates a formula.
#[derive(Clone, Debug)]
pub struct Violation {
    /// Where it begins.
    pub start: Vec<f64>,
    /// The values of inputs and parameters.
    pub parameters: Vec<(String, f64)>,
    /// How it violates the formula.
    pub judgement: Judgement,
    /// The run.
    pub trajectory: pleach_automaton::Trajectory,
}

/// Encloses all runs of a model and bounds how robustly they satisfy a formula.
///
/// The horizon is that of the formula, whatever the settings say. What is said is about runs that last
/// so long. Runs from one set are compared at the same instant: where they do the same at different
/// times, smaller [parts](StateSet::parts) of the set tell more.
///
/// # Errors
///
/// [`ReachError`] if the formula has no horizon or speaks of what is no variable, or a setting or a set
/// makes no sense.
pub fn prove_formula(
    model: &Model,
    starts: &[StateSet],
    formula: &Formula,
    settings: &Settings,
) -> Result<RobustnessProof, ReachError> {
    let horizon = formula.horizon();
    if !horizon.is_finite() {
        return Err(ReachError::Endless { formula: formula.to_string() });
    }
    super::question::check_starts(model, starts)?;
    let mut predicates = Vec::new();
    collect(formula, &mut predicates);
    let mut directions = Vec::new();
    for predicate in &predicates {
        let variables = model.variables();
        let known = |name: &&str| variables.iter().any(|variable| variable == name);
        if let Some(variable) = predicate.variables().into_iter().find(|name| !known(name)) {
            let (predicate, variable) = (predicate.to_string(), variable.to_owned());
            return Err(RegionError::Variable { predicate, variable }.into());
        }
        directions.extend(region::directions(predicate, variables));
    }
    // A little farther, so that the last window ends before the enclosure does.
    let settings = Settings { horizon: horizon * (1.0 + 1e-9) + 1e-9, ..settings.clone() };
    let mut robustness = Robustness { lower: f64::INFINITY, upper: f64::NEG_INFINITY };
    let (mut open, mut enclosures) = (Vec::new(), Vec::new());
    for start in starts {
        let go_on = &mut |_: &_, _: &_| ControlFlow::Continue(());
        let alone = std::slice::from_ref(start);
        let enclosure = explore(model, alone, &settings, &directions, go_on)?;
        let reading = Reading::of(model, &enclosure);
        let now = reading.signal(formula)[0];
        robustness.lower = robustness.lower.min(now.lower());
        robustness.upper = robustness.upper.max(now.upper());
        open.extend(predicates.iter().flat_map(|predicate| reading.open(predicate)));
        enclosures.push(enclosure);
    }
    Ok(RobustnessProof { robustness, open, enclosures })
}

/// Whether every run of `automaton` that begins in one of `starts` satisfies a formula.
///
/// First all runs are enclosed; where that does not decide, single runs are searched for one of which
/// the robustness is least.
///
/// # Errors
///
/// As for [`prove_formula`].
///
/// ```
/// use pleach_automaton::{Automaton, coordinates};
/// use pleach_discrete::vocabulary;
/// use pleach_guards::Interval;
/// use pleach_verify::reach::{Effort, Settings, StateSet, TemporalAnswer, verify_formula};
/// use pleach_verify::temporal::{Formula, always, eventually, within};
///
/// vocabulary! {
///     enum Motion: Location { Turning = "turning" }
///     enum Nothing: Event { Never = "never" }
/// }
/// coordinates! { struct Point { x, y } }
/// let Point { x, y } = Point::coordinates();
/// let turning = Automaton::<Motion, Nothing, Point>::starting_in(Motion::Turning)
///     .initially(Point { x: 1.0, y: 0.0 })
///     .flow(Motion::Turning, [x.rate(-&y), y.rate(&x)])
///     .build()?;
/// let start = [StateSet::from_box(vec![Interval::new(0.9, 1.1)?, Interval::new(-0.1, 0.1)?])];
/// let ask = |formula: &Formula| {
///     verify_formula(&turning, &[], &start, formula, &Settings::default(), &Effort::default())
/// };
///
/// // In each of two seconds, y is at least 0.7 within half a turn from then.
/// let rises = always(within(0.0, 2.0)?, eventually(within(0.0, 6.3)?, y.at_least(0.7)));
/// assert!(matches!(ask(&rises)?, TemporalAnswer::Holds(_)));
/// // Not all points are so far up at once.
/// let high = eventually(within(0.0, 2.0)?, y.at_least(1.05));
/// let TemporalAnswer::Violated(run) = ask(&high)? else { panic!("some stay below") };
/// assert!(run.judgement.robustness.upper < 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn verify_formula<L: Location + Sync, E: Event + Sync, S: Coordinates>(
    automaton: &Automaton<L, E, S>,
    uncertain: &[Uncertain],
    starts: &[StateSet],
    formula: &Formula,
    settings: &Settings,
    effort: &Effort,
) -> Result<TemporalAnswer, ReachError> {
    let model = Model::with_uncertain(automaton, uncertain)?;
    let proof = prove_formula(&model, starts, formula, settings)?;
    if proof.robustness.lower > 0.0 {
        return Ok(TemporalAnswer::Holds(proof));
    }
    let enters_invariants = settings.enters_invariants;
    let (starts, horizon) = (Starts::from(starts), formula.horizon());
    let search = Search { automaton, uncertain, starts, horizon, enters_invariants };
    let is_lawful = |run: &Run| run.lawful == run.trajectory.intervals().len();
    let judged = |run: &Run| is_lawful(run).then(|| formula.judge(&run.trajectory).ok()).flatten();
    Ok(match search.nearest(effort, judged) {
        Some((run, judgement)) if judgement.is_there() => {
            let Run { start, parameters, trajectory, .. } = run;
            let violation = Violation { start, parameters, judgement, trajectory };
            TemporalAnswer::Violated(Box::new(violation))
        }
        _ => TemporalAnswer::Undecided(proof),
    })
}

impl Nearness for Judgement {
    fn margin(&self) -> f64 {
        -self.robustness.upper
    }

    fn is_there(&self) -> bool {
        self.status == Status::Violated
    }
}

/// The predicates of a formula.
fn collect(formula: &Formula, predicates: &mut Vec<Predicate>) {
    match formula {
        Formula::Holds(predicate) => {
            if !predicates.contains(predicate) {
                predicates.push(predicate.clone());
            }
        }
        Formula::Not(inner) | Formula::Always(_, inner) | Formula::Eventually(_, inner) => {
            collect(inner, predicates);
        }
        Formula::All(parts) | Formula::Any(parts) => {
            parts.iter().for_each(|part| collect(part, predicates));
        }
        Formula::Implies(first, second) | Formula::Until(_, first, second) => {
            collect(first, predicates);
            collect(second, predicates);
        }
    }
}

/// An enclosure, read over time.
struct Reading<'a> {
    grid: Grid,
    variables: &'a [String],
    /// The sets, with the first and last cell of their times.
    sets: Vec<(usize, usize, &'a Polytope)>,
    is_complete: bool,
}

impl<'a> Reading<'a> {
    fn of(model: &'a Model, enclosure: &'a Enclosure) -> Self {
        let segments = || enclosure.visits.iter().flat_map(|visit| &visit.segments);
        let ends = segments().flat_map(|segment| [segment.time.lower(), segment.time.upper()]);
        let grid = Grid::new(ends.collect());
        let placed = segments().map(|segment| {
            let first = grid.at(segment.time.lower().max(0.0));
            (first, grid.at(segment.time.upper()), &segment.set)
        });
        let sets = placed.collect();
        let is_complete = matches!(enclosure.ending, Completion::Horizon | Completion::Everything);
        Reading { grid, variables: model.variables(), sets, is_complete }
    }

    /// Bounds on the margin of a predicate; of a cell without states, or if states are missing, none.
    fn margins(&self, predicate: &Predicate) -> Signal {
        let form = predicate.negation_normal_form();
        let mut cells: BTreeMap<usize, Interval> = BTreeMap::new();
        if self.is_complete {
            for (first, last, set) in &self.sets {
                let range = region::margin_over(&form, set, self.variables);
                for cell in *first..=*last {
                    let known = cells.entry(cell).or_insert(range);
                    *known = known.hull(range);
                }
            }
        }
        let bounds = |cell| cells.get(&cell).copied().unwrap_or(Interval::WHOLE);
        (0..self.grid.len()).map(bounds).collect()
    }

    /// Bounds on the robustness of a formula at each time.
    fn signal(&self, formula: &Formula) -> Signal {
        let opposite = |signal: Signal| signal.into_iter().map(|bounds| -bounds).collect();
        match formula {
            Formula::Holds(predicate) => self.margins(predicate),
            Formula::Not(inner) => opposite(self.signal(inner)),
            Formula::All(parts) => self.together(parts, f64::INFINITY, f64::min),
            Formula::Any(parts) => self.together(parts, f64::NEG_INFINITY, f64::max),
            Formula::Implies(first, second) => {
                let parts = [opposite(self.signal(first)), self.signal(second)];
                joined(&parts, self.grid.len(), f64::NEG_INFINITY, f64::max)
            }
            Formula::Always(window, inner) => self.grid.always(*window, &self.signal(inner)),
            Formula::Eventually(window, inner) => {
                opposite(self.grid.always(*window, &opposite(self.signal(inner))))
            }
            Formula::Until(window, first, second) => {
                self.grid.until(*window, &self.signal(first), &self.signal(second))
            }
        }
    }

    fn together(&self, parts: &[Formula], none: f64, take: fn(f64, f64) -> f64) -> Signal {
        let parts: Vec<Signal> = parts.iter().map(|part| self.signal(part)).collect();
        joined(&parts, self.grid.len(), none, take)
    }

    /// The times at which the margin of a predicate may be on either side of 0, neighbours as one.
    fn open(&self, predicate: &Predicate) -> Vec<(Predicate, Interval)> {
        let mut open: Vec<(usize, usize)> = Vec::new();
        for (cell, bounds) in self.margins(predicate).iter().enumerate() {
            let is_open = bounds.lower() <= 0.0 && bounds.upper() >= 0.0;
            match open.last_mut() {
                _ if !is_open => {}
                Some((_, last)) if *last + 1 == cell => *last = cell,
                _ => open.push((cell, cell)),
            }
        }
        let times = open.into_iter().filter_map(|(first, last)| {
            Interval::new(self.grid.ends(first).0, self.grid.ends(last).1).ok()
        });
        times.map(|time| (predicate.clone(), time)).collect()
    }
}

/// The smallest or largest of several signals, end by end.
fn joined(parts: &[Signal], cells: usize, none: f64, take: fn(f64, f64) -> f64) -> Signal {
    let bounds = |cell: usize| {
        let lower = parts.iter().map(|part| part[cell].lower()).fold(none, take);
        let upper = parts.iter().map(|part| part[cell].upper()).fold(none, take);
        Interval::new(lower, upper).unwrap_or(Interval::WHOLE)
    };
    (0..cells).map(bounds).collect()
}
