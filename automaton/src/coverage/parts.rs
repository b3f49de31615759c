//! What there is to cover in a component: locations, transitions, and the boundaries of guards.

use pleach_guards::{CompiledPredicate, EvaluationError, Predicate};

use crate::composition::blueprint::Blueprint;

/// How often a location was entered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LocationCoverage {
    pub(super) name: &'static str,
    pub(super) entered: usize,
}

/// How often a transition was taken, and what was seen of its guard.
#[derive(Clone, Debug)]
pub struct TransitionCoverage {
    pub(super) event: String,
    pub(super) source: usize,
    pub(super) target: usize,
    pub(super) rank: usize,
    pub(super) taken: usize,
    pub(super) boundaries: Vec<BoundaryCoverage>,
}

/// In how many samples a part of a guard was true, and in how many false.
#[derive(Clone, Debug)]
pub struct BoundaryCoverage {
    pub(super) condition: CompiledPredicate,
    pub(super) held: usize,
    pub(super) failed: usize,
}

impl LocationCoverage {
    /// The name of the location.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// How often runs began in it or entered it.
    pub fn entered(&self) -> usize {
        self.entered
    }
}

impl TransitionCoverage {
    /// What the event is called in the component.
    pub fn event(&self) -> &str {
        &self.event
    }

    /// The number of the location that it leaves.
    pub fn source(&self) -> usize {
        self.source
    }

    /// The number of the location that it enters.
    pub fn target(&self) -> usize {
        self.target
    }

    /// How often it was taken.
    pub fn taken(&self) -> usize {
        self.taken
    }

    /// The comparisons of the guard, from left to right.
    pub fn boundaries(&self) -> &[BoundaryCoverage] {
        &self.boundaries
    }
}

impl BoundaryCoverage {
    /// The comparison, or the function under its name.
    pub fn condition(&self) -> &Predicate {
        self.condition.predicate()
    }

    /// In how many samples it was true.
    pub fn held(&self) -> usize {
        self.held
    }

    /// In how many samples it was false.
    pub fn failed(&self) -> usize {
        self.failed
    }
}

/// What there is to cover in a component, before any run.
pub(super) struct Parts {
    pub(super) locations: Vec<LocationCoverage>,
    pub(super) transitions: Vec<TransitionCoverage>,
}

impl Parts {
    pub(super) fn of(blueprint: &Blueprint, events: &[String]) -> Result<Parts, EvaluationError> {
        let locations = blueprint.modes.iter();
        let locations =
            locations.map(|mode| LocationCoverage { name: mode.name, entered: 0 }).collect();
        let mut transitions = Vec::new();
        for (source, mode) in blueprint.modes.iter().enumerate() {
            for (rank, leaving) in mode.leaving.iter().enumerate() {
                let mut conditions = Vec::new();
                conditions_of(leaving.guard.predicate(), &mut conditions);
                let boundaries = conditions.into_iter().map(|condition| {
                    let condition = condition.compile(&blueprint.coordinates)?;
                    Ok(BoundaryCoverage { condition, held: 0, failed: 0 })
                });
                transitions.push(TransitionCoverage {
                    event: events[leaving.event].clone(),
                    source,
                    target: leaving.target,
                    rank,
                    taken: 0,
                    boundaries: boundaries.collect::<Result<_, EvaluationError>>()?,
                });
            }
        }
        Ok(Parts { locations, transitions })
    }
}

/// The comparisons, propositions and functions that a predicate is made of, each once.
fn conditions_of(predicate: &Predicate, found: &mut Vec<Predicate>) {
    match predicate {
        _ if found.contains(predicate) => {}
        Predicate::Comparison(_) | Predicate::Proposition(_) | Predicate::Function(_) => {
            found.push(predicate.clone());
        }
        Predicate::Not(inner) => conditions_of(inner, found),
        Predicate::All(parts) | Predicate::Any(parts) => {
            parts.iter().for_each(|part| conditions_of(part, found));
        }
        _ => {}
    }
}
