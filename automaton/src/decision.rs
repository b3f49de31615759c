//! Whether a predicate can hold anywhere in a box of states: the engine of the static checks.
//!
//! That two guards overlap, that a location blocks, that a reset leaves an invariant: each of these
//! says that some predicate holds in some state. [`decide`] either gives such a state, or a proof
//! that there is none, or says honestly that it does not know:
//!
//! ```
//! use std::collections::BTreeMap;
//!
//! use pleach_automaton::decision::{Decision, Effort, decide};
//! use pleach_guards::{Interval, variable};
//!
//! let temperature = variable("temperature");
//! let region = BTreeMap::from([("temperature".to_string(), Interval::new(-40.0, 60.0)?)]);
//! let effort = Effort::default();
//!
//! let (cold, warm) = (temperature.at_most(19.0), temperature.at_least(18.0));
//! let both = decide(&(cold & warm), &region, &effort)?;
//! assert_eq!(both, Decision::Witness(BTreeMap::from([("temperature".to_string(), 18.5)])));
//!
//! let (cold, warm) = (temperature.less_than(18.0), temperature.at_least(18.0));
//! assert!(matches!(decide(&(cold & warm), &region, &effort)?, Decision::Impossible(_)));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # How it is decided
//!
//! Negations are resolved, absolute values, minima and maxima are replaced by their cases, and what
//! results is written as alternatives, each a conjunction of comparisons.
//!
//! * The linear comparisons of an alternative are a system of inequalities, which the simplex
//!   method in exact fractions either solves or refutes. A refutation is verified: multiplied and
//!   added, the inequalities contradict themselves.
//! * An alternative that is not linear is searched by branch and prune: boxes are halved until a
//!   sample is a witness or interval arithmetic excludes all of them (Moore, Kearfott and Cloud
//!   2009, [doi:10.1137/1.9780898717716](https://doi.org/10.1137/1.9780898717716)).
//!
//! A witness, however found, is one only if the predicate as given holds there when it is evaluated
//! in floating point. An impossibility is one of exact arithmetic: where operands touch, rounding
//! can still make a comparison hold that exactly does not.
//!
//! A [named function](pleach_guards::NamedFunction) can be evaluated at a witness, but nothing can
//! be proven about it: the rest of the predicate may be impossible, else the answer is undecided.

mod polyhedron;
mod search;
mod simplex;

use std::collections::BTreeMap;
use std::fmt;

use pleach_guards::{
    Comparison, CompiledPredicate, EvaluationError, Interval, Predicate, Truth, always,
};

use polyhedron::{Content, Polyhedron};
use search::{Found, relative_width, search};

/// A range for each variable, possibly unbounded.
pub type Region = BTreeMap<String, Interval>;

/// A value for each variable of a [`Region`].
pub type State = BTreeMap<String, f64>;

/// Whether a predicate can hold in a region.
#[derive(Clone, Debug, PartialEq)]
pub enum Decision {
    /// It holds in this state.
    Witness(State),
    /// It holds nowhere.
    Impossible(Proof),
    /// Neither a witness nor a proof was found.
    Undecided(Doubt),
}

/// Why a predicate holds nowhere in a region.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Proof {
    /// In each alternative, linear comparisons contradict each other in exact arithmetic.
    Linear,
    /// Interval arithmetic excludes it in each of this number of boxes, which cover the region.
    Intervals {
        /// The number of boxes that were looked at.
        boxes: usize,
    },
}

/// Why nothing is known about a predicate in a region.
#[derive(Clone, Debug, PartialEq)]
pub enum Doubt {
    /// It rests on named functions, which no analysis can see into.
    Functions(Vec<String>),
    /// What could not be excluded, at the end of the effort.
    Remainder {
        /// A box in which it may hold.
        region: Region,
        /// The longest side of that box, relative to the region or, where that is unbounded, to the
        /// magnitude of the variable.
        resolution: f64,
    },
    /// It holds near this state in exact arithmetic, but not in floating point.
    Rounding(State),
}

/// How much work a decision may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    alternatives: usize,
    boxes: usize,
    resolution: f64,
}

impl Effort {
    /// At most this number of `alternatives` of a predicate, and `boxes` in the search of each; a box is
    /// not halved any more when its sides are at most `resolution` of those of the region.
    ///
    /// # Errors
    ///
    /// [`InvalidEffort`] unless there is at least one box and `resolution` lies between 0 and 1.
    pub fn new(alternatives: usize, boxes: usize, resolution: f64) -> Result<Self, InvalidEffort> {
        if boxes > 0 && (0.0..=1.0).contains(&resolution) {
            Ok(Effort { alternatives, boxes, resolution })
        } else {
            Err(InvalidEffort { boxes, resolution })
        }
    }
}

impl Default for Effort {
    /// 256 alternatives, and 20,000 boxes down to a millionth of the region: up to some tens of
    /// milliseconds for each alternative that is not linear.
    fn default() -> Self {
        Effort { alternatives: 256, boxes: 20_000, resolution: 1e-6 }
    }
}

/// Whether `predicate` holds in some state of `region`.
///
/// # Errors
///
/// [`EvaluationError::UnknownVariable`] if a variable of the predicate has no range.
pub fn decide(
    predicate: &Predicate,
    region: &Region,
    effort: &Effort,
) -> Result<Decision, EvaluationError> {
    let question = Question::new(predicate, region, *effort)?;
    let known = without_functions(&predicate.negation_normal_form());
    let alternatives = known
        .by_cases(effort.alternatives)
        .and_then(|cases| cases.disjunctive_form(effort.alternatives));
    let decision = match alternatives {
        Ok(alternatives) => question.any_of(&alternatives),
        Err(_) => question.searched(&known),
    };
    Ok(match decision {
        Decision::Undecided(_) if !predicate.is_data() => {
            let names = predicate.functions().into_iter().map(String::from);
            Decision::Undecided(Doubt::Functions(names.collect()))
        }
        decided => decided,
    })
}

/// A predicate and where it is to be decided.
struct Question<'a> {
    predicate: CompiledPredicate,
    region: &'a Region,
    variables: Vec<&'a str>,
    ranges: Vec<Interval>,
    effort: Effort,
}

impl<'a> Question<'a> {
    /// Variables that do not occur are left out, unless a function might read them.
    fn new(
        predicate: &Predicate,
        region: &'a Region,
        effort: Effort,
    ) -> Result<Self, EvaluationError> {
        let occurring = predicate.variables();
        let relevant = region
            .iter()
            .filter(|(name, _)| !predicate.is_data() || occurring.contains(name.as_str()));
        let (variables, ranges): (Vec<_>, Vec<_>) =
            relevant.map(|(name, range)| (name.as_str(), *range)).unzip();
        let predicate = predicate.compile(&variables)?;
        Ok(Question { predicate, region, variables, ranges, effort })
    }

    fn any_of(&self, alternatives: &[Vec<Comparison>]) -> Decision {
        let (mut proof, mut doubt) = (Proof::Linear, None);
        for alternative in alternatives {
            match self.all_of(alternative) {
                witness @ Decision::Witness(_) => return witness,
                Decision::Impossible(another) => proof = proof.and(another),
                Decision::Undecided(another) => doubt = doubt.or(Some(another)),
            }
        }
        doubt.map_or(Decision::Impossible(proof), Decision::Undecided)
    }

    /// Linear comparisons are decided first, also where they are not all.
    fn all_of(&self, comparisons: &[Comparison]) -> Decision {
        let mut open = Vec::new();
        for comparison in comparisons {
            match comparison.truth(&self.region) {
                Ok(Truth::Always) => {}
                Ok(Truth::Undecided) => open.push(comparison.clone()),
                Ok(Truth::Never) | Err(_) => {
                    return Decision::Impossible(Proof::Intervals { boxes: 1 });
                }
            }
        }
        let polyhedron = Polyhedron::new(&open, &self.variables, &self.ranges);
        match polyhedron.content() {
            Some(Content::Nothing) => return Decision::Impossible(Proof::Linear),
            Some(Content::Point(point)) => {
                if let Some(witness) = neighbours(&point).find(|point| self.holds_at(point)) {
                    return Decision::Witness(self.state(&witness));
                }
                let linear = comparisons.iter().all(|comparison| {
                    comparison.left.linear_form().and(comparison.right.linear_form()).is_some()
                });
                if linear && !self.has_functions() {
                    return Decision::Undecided(Doubt::Rounding(self.state(&point)));
                }
            }
            None => {}
        }
        let comparisons = comparisons.iter().cloned().map(Predicate::Comparison);
        self.searched(&Predicate::all(comparisons))
    }

    fn searched(&self, necessary: &Predicate) -> Decision {
        match search(self, necessary) {
            Found::Witness(point) => Decision::Witness(self.state(&point)),
            Found::Nothing(proof) => Decision::Impossible(proof),
            Found::Left(sides) => {
                let widths = sides.iter().zip(&self.ranges);
                let resolution = widths.map(|(side, whole)| relative_width(side, whole));
                let resolution = resolution.fold(0.0, f64::max);
                let names = self.variables.iter().map(|name| name.to_string());
                let region = names.zip(sides).collect();
                Decision::Undecided(Doubt::Remainder { region, resolution })
            }
        }
    }

    /// Whether a point of the region is a witness.
    fn holds_at(&self, point: &[f64]) -> bool {
        let inside = self.ranges.iter().zip(point).all(|(range, value)| range.contains(*value));
        inside && self.predicate.evaluate(point).is_ok_and(|verdict| verdict.holds)
    }

    fn has_functions(&self) -> bool {
        !self.predicate.predicate().is_data()
    }

    /// The state at a point; variables that do not matter are 0, or as near to it as they can be.
    fn state(&self, point: &[f64]) -> State {
        let chosen = |name: &str| self.variables.iter().position(|other| *other == name);
        let value = |(name, range): (&String, &Interval)| {
            let default = 0f64.clamp(range.lower(), range.upper());
            (name.clone(), chosen(name).map_or(default, |axis| point[axis]))
        };
        self.region.iter().map(value).collect()
    }
}

impl Proof {
    fn and(self, other: Proof) -> Proof {
        let boxes = |proof| match proof {
            Proof::Linear => 0,
            Proof::Intervals { boxes } => boxes,
        };
        match boxes(self) + boxes(other) {
            0 => Proof::Linear,
            boxes => Proof::Intervals { boxes },
        }
    }
}

/// What a predicate in negation normal form says beside its propositions and functions,
/// about which nothing is known: it holds wherever the predicate does.
fn without_functions(predicate: &Predicate) -> Predicate {
    match predicate {
        Predicate::All(parts) => Predicate::all(parts.iter().map(without_functions)),
        Predicate::Any(parts) => Predicate::any(parts.iter().map(without_functions)),
        Predicate::Not(_) | Predicate::Proposition(_) | Predicate::Function(_) => always(),
        known => known.clone(),
    }
}

/// A point, and the floating-point numbers around it if there are few: a point was rounded, and
/// what holds in it exactly may hold beside it in floating point.
fn neighbours(point: &[f64]) -> impl Iterator<Item = Vec<f64>> {
    /// Three to this power are the points tried.
    const AXES: u32 = 4;

    let count = u32::try_from(point.len()).ok().filter(|axes| *axes <= AXES);
    (0..3usize.pow(count.unwrap_or(0))).map(move |choice| {
        let moved = |(axis, value): (u32, &f64)| match choice / 3usize.pow(axis.min(AXES)) % 3 {
            0 => *value,
            1 => value.next_up(),
            _ => value.next_down(),
        };
        (0..).zip(point).map(moved).collect()
    })
}

/// The work allowed is not valid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "a search takes at least 1 box, not {boxes}, and a resolution from 0 to 1, not {resolution}"
)]
pub struct InvalidEffort {
    /// The number of boxes given.
    pub boxes: usize,
    /// The resolution given.
    pub resolution: f64,
}

impl fmt::Display for Decision {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Witness(state) => write!(formatter, "it holds at {}", listed(state, "=")),
            Self::Impossible(Proof::Linear) => formatter
                .write_str("it holds nowhere, for linear comparisons contradict each other"),
            Self::Impossible(Proof::Intervals { boxes }) => {
                write!(formatter, "it holds nowhere, by interval arithmetic in {boxes} boxes")
            }
            Self::Undecided(Doubt::Functions(names)) => {
                write!(
                    formatter,
                    "it rests on functions that are not checked: {}",
                    names.join(", ")
                )
            }
            Self::Undecided(Doubt::Remainder { region, resolution }) => {
                write!(formatter, "it may hold in {}", listed(region, "∈"))?;
                write!(formatter, ", undecided at a resolution of {resolution:.1e}")
            }
            Self::Undecided(Doubt::Rounding(state)) => {
                write!(formatter, "rounding decides whether it holds near {}", listed(state, "="))
            }
        }
    }
}

fn listed<V: fmt::Display>(values: &BTreeMap<String, V>, sign: &str) -> String {
    let pairs = values.iter().map(|(name, value)| format!("{name} {sign} {value}"));
    pairs.collect::<Vec<_>>().join(", ")
}
