//! What a run cannot say.

use std::fmt;

use pleach_continuous::flow::Uncertainty;
use serde::{Deserialize, Serialize};

/// A span of time in which a transition may have become due, or an invariant ended, or rates jumped, without
/// being seen. Everywhere else it is proven, up to the error of the flow's solution, that none has.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Doubt {
    /// The components of the group that it concerns, by their numbers.
    pub components: Vec<usize>,
    /// Where it begins, in seconds.
    pub from: f64,
    /// Where it ends, in seconds.
    pub to: f64,
    /// Why.
    pub why: Why,
}

/// Why something is in doubt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Why {
    /// The margin of a guard or an invariant touches zero, as closely as rounding or the error of
    /// the solution lets one see, and does not pass it.
    Touch,
    /// The solution of a flow comes to a jump of its rates and turns, as closely as its error lets one
    /// see: whether it passes the jump, and so which rates it has behind, is undecided.
    Graze,
    /// A guard or an invariant is given as a function, which was looked at only here and there.
    Function,
    /// A flow is given as a function that solves it, which was taken at a few instants only.
    Solution,
    /// The rates of a flow are given as a function: an integrator could step across a singularity.
    Field,
}

impl Doubt {
    /// Adds it to others, or to the one before it if that is of the same kind. Functions are in
    /// doubt as long as they are looked at; where touches happen is worth knowing.
    pub(crate) fn note(self, doubts: &mut Vec<Doubt>) {
        let same = |one: &&mut Doubt| one.why == self.why && one.components == self.components;
        match doubts.iter_mut().rev().take(NEAR).find(same) {
            Some(last) if !self.why.is_brief() || last.to >= self.from => last.to = self.to,
            _ => doubts.push(self),
        }
    }
}

/// How many doubts back one of the same kind is looked for.
const NEAR: usize = 16;

impl Why {
    /// Whether it concerns an instant, and not a flow as a whole.
    fn is_brief(self) -> bool {
        matches!(self, Why::Touch | Why::Graze)
    }
}

impl From<Uncertainty> for Why {
    fn from(uncertainty: Uncertainty) -> Why {
        match uncertainty {
            Uncertainty::Touch => Why::Touch,
            Uncertainty::Function => Why::Function,
        }
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Doubt { from, to, .. } = self;
        let why = match self.why {
            Why::Touch => "a margin touches zero and does not visibly pass it",
            Why::Graze => "the solution touches a jump of its rates and does not visibly pass it",
            Why::Function => "a condition is a function and was looked at only here and there",
            Why::Field => "rates are a function and were taken only here and there",
            Why::Solution => "a flow is a function and was taken only here and there",
        };
        write!(formatter, "from {from} s to {to} s {why}")
    }
}
