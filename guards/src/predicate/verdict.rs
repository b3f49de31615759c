//! What a predicate says about a state, and how far the state is from the other verdict.

use super::Relation;
use crate::valuation::{EvaluationError, Valuation};

/// What a predicate says about one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// How far the state is from the other verdict, in the unit of what is compared: positive
    /// where the predicate holds, negative where it does not, 0 on the boundary. Never NaN.
    pub margin: f64,
    /// Whether the predicate holds; on the boundary, its strictness decides.
    pub holds: bool,
}

impl Relation {
    /// Equal sides have margin 0 also at infinity, where a difference would not be a number.
    pub(crate) fn judge(self, left: f64, right: f64) -> Verdict {
        let slack = if left == right { 0.0 } else { right - left };
        match self {
            Relation::AtMost => Verdict { margin: slack, holds: left <= right },
            Relation::LessThan => Verdict { margin: slack, holds: left < right },
            Relation::AtLeast => Verdict { margin: -slack, holds: left >= right },
            Relation::MoreThan => Verdict { margin: -slack, holds: left > right },
        }
    }
}

impl Verdict {
    /// What [`always()`](crate::always) says.
    pub const ALWAYS: Verdict = Verdict { margin: f64::INFINITY, holds: true };
    /// What [`never()`](crate::never) says.
    pub const NEVER: Verdict = Verdict { margin: f64::NEG_INFINITY, holds: false };

    /// The verdict on a proposition in `state`.
    pub(crate) fn of(
        proposition: &str,
        state: &(impl Valuation + ?Sized),
    ) -> Result<Verdict, EvaluationError> {
        match state.truth(proposition) {
            Some(true) => Ok(Verdict::ALWAYS),
            Some(false) => Ok(Verdict::NEVER),
            None => {
                Err(EvaluationError::UnknownProposition { proposition: proposition.to_owned() })
            }
        }
    }

    /// Whether margin and verdict tell the same: a positive margin says that the predicate holds,
    /// a negative one that it does not, and NaN says nothing.
    pub fn is_consistent(self) -> bool {
        if self.holds { self.margin >= 0.0 } else { self.margin <= 0.0 }
    }

    /// The verdict on a conjunction of which this and `other` are the parts.
    #[must_use]
    pub fn and(self, other: Verdict) -> Verdict {
        Verdict { margin: self.margin.min(other.margin), holds: self.holds && other.holds }
    }

    /// The verdict on a disjunction of which this and `other` are the parts.
    #[must_use]
    pub fn or(self, other: Verdict) -> Verdict {
        Verdict { margin: self.margin.max(other.margin), holds: self.holds || other.holds }
    }

    /// The verdict on the opposite.
    #[must_use]
    pub fn opposite(self) -> Verdict {
        Verdict { margin: -self.margin, holds: !self.holds }
    }
}
