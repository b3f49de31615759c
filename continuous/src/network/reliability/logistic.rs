//! A model with a steepness: the odds of arrival are a power law.

use super::{LinkReliability, ReliabilityError, check_ranges, remaining};

/// Reliability 1 up to l and 0 from u on; between them the odds R/(1 − R) = (q/s)^p, where
/// s = (d − l)/(u − l) is the share of the transition that is behind and q = 1 − s what is left.
///
/// The log-odds p·ln(q/s) are those of a logistic curve in ln(q/s), hence the name. The steepness
/// p says how suddenly links break: with 2 the model is close to the cubic one, with 8 nearly all
/// of the loss lies in the middle third of the transition.
///
/// 1/R = 1 + (s/q)^p is convex and nondecreasing, since s/q = s/(1 − s) is convex, nondecreasing
/// and not negative, and so is x ↦ xᵖ for p ≥ 1. From p = 2 on R' is 0 at both ends.
///
/// ```
/// use pleach_continuous::network::{LinkReliability, LogisticReliability};
///
/// let link = LogisticReliability::new(0.4, 0.5, 4.0)?;
/// assert_eq!((link.reliability(0.4), link.reliability(0.5)), (1.0, 0.0));
/// assert!((link.reliability(0.45) - 0.5).abs() < 1e-12);
/// assert!(link.reliability(0.43) > 0.96);
/// # Ok::<(), pleach_continuous::network::reliability::ReliabilityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogisticReliability {
    full_range: f64,
    max_range: f64,
    steepness: f64,
}

impl LogisticReliability {
    /// The model with reliability 1 up to `full_range` (l), 0 from `max_range` (u) on, and the
    /// `steepness` p between them.
    ///
    /// # Errors
    ///
    /// [`ReliabilityError`] unless 0 ≤ l < u and p ≥ 2, all finite.
    pub fn new(full_range: f64, max_range: f64, steepness: f64) -> Result<Self, ReliabilityError> {
        check_ranges(full_range, max_range)?;
        if !(steepness.is_finite() && steepness >= 2.0) {
            return Err(ReliabilityError::TooFlat { steepness });
        }
        Ok(Self { full_range, max_range, steepness })
    }

    /// q, and (s/q)^p: the odds against arrival.
    fn odds_against(&self, distance: f64) -> (f64, f64) {
        let left = remaining(distance, self.full_range, self.max_range);
        (left, ((1.0 - left) / left).powf(self.steepness))
    }
}

impl LinkReliability for LogisticReliability {
    fn reliability(&self, distance: f64) -> f64 {
        let (_, odds) = self.odds_against(distance);
        1.0 / (1.0 + odds)
    }

    /// With o = (s/q)^p, dR/ds = −o'/(1 + o)² and o' = p·o/(s·q).
    fn slope(&self, distance: f64) -> f64 {
        let (left, odds) = self.odds_against(distance);
        let reliability = 1.0 / (1.0 + odds);
        let behind = 1.0 - left;
        if reliability == 0.0 || behind == 0.0 {
            return 0.0;
        }
        let by_share = self.steepness * reliability * (1.0 - reliability) / (behind * left);
        -by_share / (self.max_range - self.full_range)
    }

    fn range(&self) -> f64 {
        self.max_range
    }

    fn full_range(&self) -> f64 {
        self.full_range
    }

    /// Closed form: s/q is the p-th root of (1 − R)/R.
    fn distance_at(&self, reliability: f64) -> f64 {
        let reliability = reliability.clamp(0.0, 1.0);
        let ratio = ((1.0 - reliability) / reliability).powf(self.steepness.recip());
        let left = 1.0 / (1.0 + ratio);
        let distance = self.max_range - left * (self.max_range - self.full_range);
        distance.clamp(self.full_range, self.max_range)
    }
}
