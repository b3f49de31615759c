//! Judging a trajectory by a formula.

use std::fmt;

use pleach_automaton::HybridTime;
use pleach_automaton::trajectory::Gap;
use pleach_guards::Predicate;

use super::formula::{Formula, Window};
use super::samples::{Reading, Recording, Samples, Side, TemporalError};
use super::signal::{ROUNDING, Signal, Time, Value};
use super::sliding::{Reach, infimum};
use super::until::{supremum, until};

/// What a formula says of a trajectory, seen from its first instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// Whether the formula is satisfied.
    pub status: Status,
    /// By how much.
    pub robustness: Robustness,
    /// The instant that decides; `None` if nothing is decided, or if the formula is true or false
    /// whatever the states are.
    pub witness: Option<Witness>,
    /// What is not known of the predicates: always where one is a function, and otherwise where the
    /// judgement is not decided.
    pub doubts: Vec<Doubt>,
}

/// A span of time in which it is not known whether a predicate holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// The predicate, one without connectives.
    pub predicate: Predicate,
    /// When and why.
    pub gap: Gap,
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
    /// It is long enough, and still this cannot be said: a margin that decides is zero within rounding
    /// or the error of the solution, as that of x ≤ 1 where x = cos t comes to 1.
    Undecided,
}

/// The robustness of a formula: how far the trajectory is from the other verdict, in the unit of
/// what is compared. Positive robustness means satisfied and negative violated; at 0 strictness
/// decides.
///
/// It is between two numbers, which are far apart where the trajectory is too short. Where it is long
/// enough they differ by what is not known of the margins: where extrema decide by rounding and the
/// error of the solution, and where a window that begins or ends at no instant known beforehand cuts a
/// margin, by as much as this bends between two looks. Of samples both are the same number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Robustness {
    /// The least that it can be, however the trajectory goes on.
    pub lower: f64,
    /// The most that it can be.
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
    /// Of samples the margin of each comparison is taken to be linear between them, so they must be as
    /// close as that is true. The judgement is then exact, but for rounding: it takes account of all
    /// instants and not only of the samples.
    ///
    /// On a [`Trajectory`](pleach_automaton::Trajectory) margins are enclosed at all instants
    /// ([`account`](pleach_automaton::Trajectory::account)), with the same means as guards: where a
    /// comparison changes, and how far its margin goes. What cannot be decided in this way is
    /// [`Status::Undecided`], and [`Judgement::doubts`] says where. The work is bounded.
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
        let mut instants = Vec::new();
        plan.collect_ends(&[0.0], &mut instants);
        let recording = Recording::new(&literals, samples, &instants)?;
        let value = |reading, side| plan.signal(&recording, reading, side).knots()[0].value;
        let (worst, best) =
            (value(Reading::Margin, Side::Worst), value(Reading::Margin, Side::Best));
        let robustness = Robustness::between(worst.margin, best.margin);
        // The truth of the comparisons decides: on the boundary the margins do not tell.
        let (status, witness) = if value(Reading::Truth, Side::Worst).margin > 0.0 {
            (Status::Satisfied, Witness::of(worst, &recording))
        } else if value(Reading::Truth, Side::Best).margin < 0.0 {
            (Status::Violated, Witness::of(best, &recording))
        } else if self.horizon() * (1.0 - ROUNDING) <= recording.duration() {
            (Status::Undecided, None)
        } else {
            (Status::Inconclusive, None)
        };
        let is_open = matches!(status, Status::Undecided | Status::Inconclusive);
        let doubts = recording.accounts().flat_map(|(predicate, account)| {
            let told = account.gaps.iter().filter(|gap| is_open || gap.is_function);
            told.map(|gap| Doubt { predicate: predicate.clone(), gap: *gap })
        });
        let doubts = doubts.collect();
        Ok(Judgement { status, robustness, witness, doubts })
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
        let predicate = recording.predicate(origin.literal).clone();
        let (at, margin) = recording.margin(origin.literal, origin.jumps, t);
        // Adding 0 turns −0 into 0.
        Some(Witness { at, predicate, margin: margin + 0.0 })
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

    /// Adds to `instants` those at which windows begin and end, seen from each of some instants.
    fn collect_ends(&self, seen_from: &[f64], instants: &mut Vec<f64>) {
        instants.extend(seen_from);
        let (window, parts): (&Window, Vec<&Plan>) = match self {
            Plan::Literal(_) => return,
            Plan::Not(inner) => return inner.collect_ends(seen_from, instants),
            Plan::All(parts) | Plan::Any(parts) => {
                return parts.iter().for_each(|part| part.collect_ends(seen_from, instants));
            }
            Plan::Always(window, inner) | Plan::Eventually(window, inner) => (window, vec![inner]),
            Plan::Until(window, first, second) => (window, vec![first, second]),
        };
        let ends = [0.0, window.start(), window.end()].into_iter().filter(|end| end.is_finite());
        let mut ends: Vec<f64> =
            ends.flat_map(|end| seen_from.iter().map(move |from| from + end)).collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup();
        ends.truncate(MOST_ENDS);
        parts.into_iter().for_each(|part| part.collect_ends(&ends, instants));
    }

    fn signal(&self, recording: &Recording, reading: Reading, side: Side) -> Signal {
        let signal = |plan: &Plan| plan.signal(recording, reading, side);
        match self {
            Plan::Literal(literal) => recording.signal(*literal, reading, side),
            Plan::Not(inner) => inner.signal(recording, reading, side.opposite()).opposite(),
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

/// More instants at which windows begin or end are not looked at beforehand.
const MOST_ENDS: usize = 256;

impl fmt::Display for Judgement {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}, robustness {}", self.status, self.robustness)?;
        if let Some(witness) = &self.witness {
            write!(formatter, ": {witness}")?;
        }
        self.doubts.first().map_or(Ok(()), |first| write!(formatter, "; {first}"))
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Doubt { predicate, gap: Gap { from, to, is_function } } = self;
        write!(formatter, "from {from} s to {to} s ")?;
        if *is_function {
            write!(formatter, "`{predicate}` is a function and was looked at only here and there")
        } else {
            write!(formatter, "it is not known whether `{predicate}` holds")
        }
    }
}

impl fmt::Display for Status {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Status::Satisfied => "satisfied",
            Status::Violated => "violated",
            Status::Inconclusive => "inconclusive",
            Status::Undecided => "undecided",
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
