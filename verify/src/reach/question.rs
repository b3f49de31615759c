//! What is asked of all runs, and how it is answered.

use std::ops::ControlFlow;

use pleach_automaton::composition::without_clocks;
use pleach_automaton::{Automaton, Coordinates};
use pleach_discrete::{Event, Location};
use pleach_guards::{Comparison, Expression, Interval, Predicate, Relation, constant, not};
use thiserror::Error;

use super::explore::{Completion, Enclosure, Segment, explore};
use super::falsify::{Counterexample, falsify};
use super::model::{Model, ModelError, Uncertain};
use super::region::{Region, RegionError};
use super::search::Effort;
use super::set::StateSet;
use super::settings::{InvalidSetting, Settings};

/// States that no run may come to.
#[derive(Clone, Debug, PartialEq)]
pub struct Forbidden {
    /// The name of the location in which they are forbidden; without one, everywhere. In a product whose clocks sample
    /// several events, a name [without clocks](without_clocks) is every location that differs in the clocks alone.
    pub location: Option<String>,
    /// The states.
    pub states: Predicate,
}

/// How a question is answered.
#[derive(Clone, Debug)]
pub enum Answer {
    /// No run comes to a forbidden state: a proof.
    Holds(Proof),
    /// A run does, and here it is.
    Violated(Box<Counterexample>),
    /// Neither was found.
    Undecided(Proof),
}

/// What an enclosure shows of a question.
#[derive(Clone, Debug)]
pub struct Proof {
    /// The enclosure.
    pub enclosure: Enclosure,
    /// Where it meets forbidden states; none for a proof.
    pub doubts: Vec<Doubt>,
    /// For each of the forbidden sets: how far all states stay away from it at least, in the unit of
    /// what is compared. Negative where a single comparison does not tell.
    pub clearances: Vec<f64>,
}

/// A part of an enclosure that meets forbidden states.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// The number of the forbidden set.
    pub forbidden: usize,
    /// The number of the location.
    pub location: usize,
    /// When, in seconds.
    pub time: Interval,
    /// A box around the states.
    pub states: Vec<Interval>,
}

/// Why a question has no answer.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ReachError {
    /// The model cannot be enclosed.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A setting makes no sense.
    #[error(transparent)]
    Settings(#[from] InvalidSetting),
    /// A forbidden set cannot be used.
    #[error(transparent)]
    Region(#[from] RegionError),
    /// There is no such location.
    #[error("there is no location `{location}`: there are {known}")]
    Location {
        /// The name.
        location: String,
        /// The names that exist.
        known: String,
    },
    /// A formula has windows without an end.
    #[error(
        "`{formula}` has a time window without an end: give it one, or ask what is never reached"
    )]
    Endless {
        /// The formula.
        formula: String,
    },
    /// Runs begin nowhere, so that whatever is asked of all of them would hold.
    #[error("no initial states are given: give at least one set in which runs begin")]
    NoStarts,
    /// A set of initial states has another number of coordinates than the model.
    #[error("the initial set has {found} coordinates, and the model {expected}: {variables}")]
    Dimension {
        /// Of the set.
        found: usize,
        /// Of the model.
        expected: usize,
        /// The names of the model's.
        variables: String,
    },
}

impl Forbidden {
    /// These states, in any location.
    pub fn anywhere(states: Predicate) -> Self {
        Forbidden { location: None, states }
    }

    /// These states, in one [location](Forbidden::location).
    pub fn within(location: &str, states: Predicate) -> Self {
        Forbidden { location: Some(location.to_owned()), states }
    }

    /// Of locations with these names: in which ones the states are forbidden.
    pub(super) fn places<'n>(&self, names: impl Iterator<Item = &'n str> + Clone) -> Vec<bool> {
        let Some(asked) = &self.location else { return names.map(|_| true).collect() };
        let is_exact = names.clone().any(|name| name == asked);
        names.map(|name| asked == if is_exact { name } else { without_clocks(name) }).collect()
    }

    /// The states in which the margin of a predicate is below `margin`: none of them may be reached
    /// if it is to be at least that at all times.
    pub fn below(predicate: &Predicate, margin: f64) -> Self {
        Forbidden::anywhere(not(raised(&predicate.negation_normal_form(), margin)))
    }
}

/// The predicate in negation normal form with its margin lowered by `by`.
fn raised(predicate: &Predicate, by: f64) -> Predicate {
    match predicate {
        Predicate::Comparison(Comparison { left, relation, right }) => {
            let (right, shift): (&Expression, f64) = match relation {
                Relation::AtMost | Relation::LessThan => (right, -by),
                Relation::AtLeast | Relation::MoreThan => (right, by),
            };
            let right = right + constant(shift);
            Predicate::Comparison(Comparison { left: left.clone(), relation: *relation, right })
        }
        Predicate::All(parts) => Predicate::all(parts.iter().map(|part| raised(part, by))),
        Predicate::Any(parts) => Predicate::any(parts.iter().map(|part| raised(part, by))),
        other => other.clone(),
    }
}

impl Proof {
    /// Whether it shows that no forbidden state is reached.
    pub fn holds(&self) -> bool {
        self.doubts.is_empty()
            && matches!(self.enclosure.ending, Completion::Horizon | Completion::Everything)
    }

    /// This proof if it holds, else a finer one that does, if one is found before `prove` is stopped. The states in which a guard may hold, which
    /// jumps carry on as one set for each of the [clusters](Settings::clusters), are covered by twice
    /// and then ten times as many when `prove` is called again.
    ///
    /// # Errors
    ///
    /// Those of `prove`.
    pub fn refined(
        self,
        settings: &Settings,
        mut prove: impl FnMut(&Settings) -> Result<Proof, ReachError>,
    ) -> Result<Proof, ReachError> {
        let Enclosure { visits, ending } = &self.enclosure;
        let jumps = visits.iter().any(|visit| visit.depth > 0);
        if self.holds() || !jumps || *ending == Completion::Stopped {
            return Ok(self);
        }
        let segments = visits.iter().map(|visit| visit.segments.len()).sum();
        for factor in FINER {
            let finer = prove(&settings.finer(factor, segments))?;
            if finer.holds() {
                return Ok(finer);
            }
            if finer.enclosure.ending == Completion::Stopped {
                break;
            }
        }
        Ok(self)
    }
}

/// How many times as many sets cover the states at guards in further attempts. More sets are finer, and
/// lead to more of them at each jump.
const FINER: [usize; 2] = [2, 10];

/// Encloses all runs of a model and looks where they meet forbidden states.
///
/// `progress` is told of each segment, with the elapsed time of runs in it; it may end the search.
///
/// # Errors
///
/// [`ReachError`] if a forbidden set, a set of initial states or a setting makes no sense, or there are no initial states.
pub fn prove(
    model: &Model,
    starts: &[StateSet],
    forbidden: &[Forbidden],
    settings: &Settings,
    progress: &mut dyn FnMut(Interval) -> ControlFlow<()>,
) -> Result<Proof, ReachError> {
    let variables = model.variables();
    check_starts(model, starts)?;
    let names = model.locations().iter().map(|place| &*place.name);
    let region = |one: &Forbidden| -> Result<(Vec<bool>, Region), ReachError> {
        let places = one.places(names.clone());
        if let Some(location) = one.location.clone().filter(|_| !places.contains(&true)) {
            let known = names.clone().map(|name| format!("`{name}`")).collect::<Vec<_>>();
            return Err(ReachError::Location { location, known: known.join(", ") });
        }
        Ok((places, Region::exactly(&one.states, variables)?))
    };
    let regions = forbidden.iter().map(region).collect::<Result<Vec<_>, _>>()?;
    let conjunctions = regions.iter().flat_map(|(_, region)| &region.alternatives);
    let half_spaces = conjunctions.flat_map(|conjunction| &conjunction.half_spaces);
    let extra: Vec<Vec<f64>> = half_spaces.map(|half_space| half_space.direction.clone()).collect();
    let mut clearances = vec![f64::INFINITY; forbidden.len()];
    let mut doubts = Vec::new();
    let mut watch = |visit: &super::explore::Visit, segment: &Segment| {
        for (number, (places, region)) in regions.iter().enumerate() {
            if !places[visit.location] {
                continue;
            }
            for conjunction in &region.alternatives {
                let clearance = conjunction.clearance(&segment.set, variables);
                clearances[number] = clearances[number].min(clearance);
                if clearance > 0.0 {
                    continue;
                }
                if let Some(met) = conjunction.cut(&segment.set, variables) {
                    doubts.push(Doubt {
                        forbidden: number,
                        location: visit.location,
                        time: segment.time,
                        states: met.hull().unwrap_or_default(),
                    });
                }
            }
        }
        progress(segment.time)
    };
    let enclosure = explore(model, starts, settings, &extra, &mut watch)?;
    Ok(Proof { enclosure, doubts, clearances })
}

/// Whether there are sets of initial states, and all are sets of states of a model.
pub(super) fn check_starts(model: &Model, starts: &[StateSet]) -> Result<(), ReachError> {
    if starts.is_empty() {
        return Err(ReachError::NoStarts);
    }
    let variables = model.variables();
    match starts.iter().find(|start| start.hull().len() != variables.len()) {
        Some(start) => Err(ReachError::Dimension {
            found: start.hull().len(),
            expected: variables.len(),
            variables: variables.join(", "),
        }),
        None => Ok(()),
    }
}

/// Whether a run of `automaton` that begins in one of `starts` comes to a forbidden state.
///
/// First all runs are enclosed; where that does not decide, single runs are searched for one that
/// does, and then all are enclosed in [finer](Proof::refined) sets.
///
/// # Errors
///
/// [`ReachError`] if a part of the question makes no sense.
///
/// ```
/// use pleach_automaton::{Automaton, coordinates};
/// use pleach_discrete::vocabulary;
/// use pleach_guards::Interval;
/// use pleach_verify::reach::{Answer, Effort, Forbidden, Settings, StateSet, verify};
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
///
/// let start = StateSet::from_box(vec![Interval::new(0.9, 1.1)?, Interval::new(-0.1, 0.1)?]);
/// let far = [Forbidden::anywhere(x.at_least(1.2))];
/// let answer = verify(&turning, &[], &[start.clone()], &far, &Settings::default(), &Effort::default())?;
/// assert!(matches!(answer, Answer::Holds(_)));
/// let near = [Forbidden::anywhere(y.at_least(1.05))];
/// let answer = verify(&turning, &[], &[start], &near, &Settings::default(), &Effort::default())?;
/// let Answer::Violated(run) = answer else { panic!("some points come there") };
/// assert!(run.margin >= 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn verify<L: Location + Sync, E: Event + Sync, S: Coordinates>(
    automaton: &Automaton<L, E, S>,
    uncertain: &[Uncertain],
    starts: &[StateSet],
    forbidden: &[Forbidden],
    settings: &Settings,
    effort: &Effort,
) -> Result<Answer, ReachError> {
    let model = Model::with_uncertain(automaton, uncertain)?;
    let progress = &mut |_| ControlFlow::Continue(());
    let proof = prove(&model, starts, forbidden, settings, progress)?;
    if proof.holds() {
        return Ok(Answer::Holds(proof));
    }
    let found = falsify(automaton, uncertain, starts, forbidden, settings, effort);
    if let Some(found) = found.filter(|found| found.is_violation) {
        return Ok(Answer::Violated(Box::new(found)));
    }
    let proof =
        proof.refined(settings, |finer| prove(&model, starts, forbidden, finer, progress))?;
    Ok(if proof.holds() { Answer::Holds(proof) } else { Answer::Undecided(proof) })
}
