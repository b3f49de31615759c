//! Judging a trajectory by a formula.

use std::fmt;

use pleach_automaton::HybridTime;
use pleach_guards::Predicate;

use super::formula::{Formula, Window};
use super::samples::{Reading, Recording, Samples, TemporalError};
use super::signal::{Signal, Time, Value};
use super::sliding::{Reach, infimum};
use super::until::{supremum, until};

/// What a formula says of a trajectory, seen from its first instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// Whether the formula is satisfied.
    pub status: Status,
    /// By how much.
    pub robustness: Robustness,
    /// The instant that decides; `None` if the judgement is inconclusive, or if the formula is
    /// true or false whatever the states are.
    pub witness: Option<Witness>,
}

/// Whether a trajectory satisfies a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It does, however the trajectory goes on.
    Satisfied,
    /// It does not, however the trajectory goes on.
    Violated,
    /// The trajectory is too short: whether it does depends on how it goes on.
    Inconclusive,
}

/// The robustness of a formula: how far the trajectory is from the other verdict, in the unit of
/// what is compared. Positive robustness means satisfied and negative violated; at 0 strictness
/// decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Robustness {
    /// The least that it can be, however the trajectory goes on.
    pub lower: f64,
    /// The most that it can be. Equal to `lower` where the trajectory is long enough.
    pub upper: f64,
}

/// The instant at which a predicate has the margin that is the robustness of the formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Witness {
    /// When; the jumps are counted from the first sample.
    pub at: HybridTime,
    /// What decides there, a predicate without connectives.
    pub predicate: Predicate,
    /// The margin of the predicate at that instant, which under a negation is the opposite of
    /// the robustness.
    pub margin: f64,
}

impl Formula {
    /// Judges a trajectory from its first instant.
    ///
    /// The margin of each comparison is taken to be linear between samples, so they must be as
    /// close as that is true. The judgement is then exact, but for rounding: it takes account of all
    /// instants and not only of the samples.
    ///
    /// Of a [`Trajectory`](pleach_automaton::Trajectory) the samples are chosen such that between
    /// two of them no comparison of the formula turns or changes
    /// ([`samples_for`](pleach_automaton::Trajectory::samples_for)). The status rests on these
    /// changes and is exact; the robustness is where an extremum decides, and elsewhere differs by as
    /// much as the margins bend between two samples.
    ///
    /// ```
    /// use pleach_guards::variable;
    /// use pleach_verify::temporal::{Status, always, within};
    ///
    /// let descent = [(0.0, [("h", 3.0)]), (2.0, [("h", 1.0)]), (4.0, [("h", 2.0)])];
    /// let above = always(within(0.0, 4.0)?, variable("h").at_least(0.5));
    ///
    /// let judgement = above.judge(&descent)?;
    /// assert_eq!(judgement.status, Status::Satisfied);
    /// assert_eq!(judgement.robustness.lower, 0.5);
    /// assert_eq!(judgement.witness.map(|witness| witness.at.t), Some(2.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`TemporalError`] if there is no sample, if time goes back, if a predicate cannot be
    /// evaluated, or if its margin becomes infinite without a jump.
    pub fn judge(&self, samples: &(impl Samples + ?Sized)) -> Result<Judgement, TemporalError> {
        let mut literals = Vec::new();
        let plan = Plan::of(self, &mut literals);
        let recording = Recording::new(&literals, samples)?;
        let bounds = |reading| {
            let lower = plan.value(&recording, reading, f64::NEG_INFINITY);
            let long_enough = self.horizon() <= recording.duration();
            let upper =
                if long_enough { lower } else { plan.value(&recording, reading, f64::INFINITY) };
            (lower, upper)
        };
        let margins = bounds(Reading::Margin);
        let robustness = Robustness::between(margins.0.margin, margins.1.margin);
        // The truth of the comparisons decides: on the boundary the margins do not tell.
        let (status, value) = match bounds(Reading::Truth) {
            (lower, _) if lower.margin > 0.0 => (Status::Satisfied, Some(margins.0)),
            (_, upper) if upper.margin < 0.0 => (Status::Violated, Some(margins.1)),
            _ => (Status::Inconclusive, None),
        };
        let witness = value.and_then(|value| Witness::of(value, &recording));
        Ok(Judgement { status, robustness, witness })
    }
}

impl Robustness {
    /// Adding 0 turns −0 into 0.
    fn between(lower: f64, upper: f64) -> Robustness {
        Robustness { lower: lower + 0.0, upper: upper + 0.0 }
    }
}

impl Witness {
    fn of(value: Value, recording: &Recording) -> Option<Witness> {
        let origin = value.origin?;
        let (Time::Fixed(t) | Time::Moving(t)) = origin.time;
        let at = HybridTime { t, j: origin.jumps };
        let predicate = recording.predicate(origin.literal).clone();
        Some(Witness { at, predicate, margin: recording.margin(origin.literal, at) })
    }
}

/// A formula whose predicates are resolved into those without connectives, the literals, each
/// known by its place in a list.
enum Plan {
    Literal(usize),
    Not(Box<Plan>),
    All(Vec<Plan>),
    Any(Vec<Plan>),
    Always(Window, Box<Plan>),
    Eventually(Window, Box<Plan>),
    Until(Window, Box<Plan>, Box<Plan>),
}

impl Plan {
    fn of(formula: &Formula, literals: &mut Vec<Predicate>) -> Plan {
        let mut plan = |formula: &Formula| Plan::of(formula, literals);
        match formula {
            Formula::Holds(predicate) => Plan::of_predicate(predicate, literals),
            Formula::Not(inner) => Plan::Not(Box::new(plan(inner))),
            Formula::All(parts) => Plan::All(parts.iter().map(plan).collect()),
            Formula::Any(parts) => Plan::Any(parts.iter().map(plan).collect()),
            Formula::Implies(first, second) => {
                Plan::Any(vec![Plan::Not(Box::new(plan(first))), plan(second)])
            }
            Formula::Always(window, inner) => Plan::Always(*window, Box::new(plan(inner))),
            Formula::Eventually(window, inner) => Plan::Eventually(*window, Box::new(plan(inner))),
            Formula::Until(window, first, second) => {
                Plan::Until(*window, Box::new(plan(first)), Box::new(plan(second)))
            }
        }
    }

    fn of_predicate(predicate: &Predicate, literals: &mut Vec<Predicate>) -> Plan {
        let mut plan = |predicate: &Predicate| Plan::of_predicate(predicate, literals);
        match predicate {
            Predicate::Not(inner) => Plan::Not(Box::new(plan(inner))),
            Predicate::All(parts) => Plan::All(parts.iter().map(plan).collect()),
            Predicate::Any(parts) => Plan::Any(parts.iter().map(plan).collect()),
            other => {
                let known = literals.iter().position(|literal| literal == other);
                Plan::Literal(known.unwrap_or_else(|| {
                    literals.push(other.clone());
                    literals.len() - 1
                }))
            }
        }
    }

    /// The value at the first instant, if all that lies beyond the end makes the formula as bad
    /// (`beyond` = −∞) or as good (`beyond` = ∞) as it can.
    fn value(&self, recording: &Recording, reading: Reading, beyond: f64) -> Value {
        self.signal(recording, reading, beyond).knots()[0].value
    }

    fn signal(&self, recording: &Recording, reading: Reading, beyond: f64) -> Signal {
        let signal = |plan: &Plan| plan.signal(recording, reading, beyond);
        match self {
            Plan::Literal(literal) => recording.signal(*literal, reading, beyond),
            Plan::Not(inner) => inner.signal(recording, reading, -beyond).opposite(),
            Plan::All(parts) => {
                let combined = parts.iter().map(signal).reduce(|one, other| one.minimum(&other));
                combined.unwrap_or_else(|| recording.constant(f64::INFINITY))
            }
            Plan::Any(parts) => {
                let combined = parts.iter().map(signal).reduce(Signal::maximum);
                combined.unwrap_or_else(|| recording.constant(f64::NEG_INFINITY))
            }
            Plan::Always(window, inner) => {
                let reach = Reach { start: window.start(), end: window.end(), end_included: true };
                infimum(&signal(inner), reach)
            }
            Plan::Eventually(window, inner) => supremum(signal(inner), *window),
            Plan::Until(window, first, second) => until(*window, &signal(first), &signal(second)),
        }
    }
}

impl fmt::Display for Judgement {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}, robustness {}", self.status, self.robustness)?;
        match &self.witness {
            Some(witness) => write!(formatter, ": {witness}"),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Status::Satisfied => "satisfied",
            Status::Violated => "violated",
            Status::Inconclusive => "inconclusive",
        })
    }
}

impl fmt::Display for Robustness {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Robustness { lower, upper } = self;
        if lower == upper {
            write!(formatter, "{lower}")
        } else {
            write!(formatter, "between {lower} and {upper}")
        }
    }
}

impl fmt::Display for Witness {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Witness { at, predicate, margin } = self;
        write!(formatter, "at {at} the margin of `{predicate}` is {margin}")
    }
}
