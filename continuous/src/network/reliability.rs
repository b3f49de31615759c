//! Link reliability R(x_i, x_j): the share of packets that arrive, as a function of distance.
//!
//! The model is interchangeable: routing, motion and acceptance take any [`LinkReliability`], also
//! behind a pointer, as `Arc<dyn LinkReliability>`.
//!
//! | model | what it is |
//! | --- | --- |
//! | [`CubicReliability`] | the model of the paper, eq. (27) |
//! | [`LogisticReliability`] | a plateau, then log-odds that fall evenly: its steepness is a parameter |
//! | [`WithMargin`] | any model, read at distances that are longer by a margin |
//!
//! [`check`] looks for a distance at which a model breaks a requirement.
//!
//! ```
//! use pleach_continuous::network::{CubicReliability, LinkReliability};
//!
//! let link = CubicReliability::new(0.4, 0.5)?;
//! assert_eq!(link.reliability(0.4), 1.0);
//! assert_eq!(link.reliability(0.5), 0.0);
//! assert!((link.reliability(0.45) - 0.5).abs() < 1e-12);
//! # Ok::<(), pleach_continuous::network::reliability::ReliabilityError>(())
//! ```

use std::fmt::Debug;
use std::sync::Arc;

use thiserror::Error;

mod check;
mod logistic;
mod margin;
#[cfg(any(kani, test))]
mod proofs;

pub use check::{BrokenRequirement, check};
pub use logistic::LogisticReliability;
pub use margin::WithMargin;

/// How reliably a link carries packets over a distance.
///
/// # What a model must satisfy
///
/// 1. R maps distances ≥ 0 into [0, 1], does not increase, and is 0 from [`range`](Self::range) on.
/// 2. R is continuously differentiable, so that the linearisation (22) exists.
/// 3. **1/R is convex and nondecreasing in the distance, where R > 0.** The certified acceptance
///    of moves ([`super::acceptance`]) rests on this. It holds wherever 2R'² ≥ R·R''; for the
///    cubic model [`CubicReliability`] gives the proof.
///
/// [`check`] tries these requirements at many distances. A model of your own comes with a proof of
/// the third.
pub trait LinkReliability: Debug + Send + Sync {
    /// R(d), in [0, 1], at a distance d ≥ 0.
    fn reliability(&self, distance: f64) -> f64;

    /// dR/dd at a distance d ≥ 0, per unit of length; never positive.
    fn slope(&self, distance: f64) -> f64;

    /// u: the distance from which on the reliability is zero.
    fn range(&self) -> f64;

    /// l: the distance up to which the reliability is one; 0 if the model has no such plateau.
    fn full_range(&self) -> f64;

    /// The largest distance at which the reliability is still at least `reliability`.
    ///
    /// `reliability` is clamped to [0, 1]: the answer lies between [`full_range`](Self::full_range)
    /// and [`range`](Self::range).
    fn distance_at(&self, reliability: f64) -> f64;

    /// 1/R(d): the expected number of transmissions until a packet has arrived, which is also the
    /// time share that a unit of flow costs. Infinite where R = 0.
    fn expected_transmissions(&self, distance: f64) -> f64 {
        let reliability = self.reliability(distance);
        if reliability > 0.0 { reliability.recip() } else { f64::INFINITY }
    }
}

impl<L: LinkReliability + ?Sized> LinkReliability for Arc<L> {
    fn reliability(&self, distance: f64) -> f64 {
        (**self).reliability(distance)
    }

    fn slope(&self, distance: f64) -> f64 {
        (**self).slope(distance)
    }

    fn range(&self) -> f64 {
        (**self).range()
    }

    fn full_range(&self) -> f64 {
        (**self).full_range()
    }

    fn distance_at(&self, reliability: f64) -> f64 {
        (**self).distance_at(reliability)
    }

    fn expected_transmissions(&self, distance: f64) -> f64 {
        (**self).expected_transmissions(distance)
    }
}

/// Eq. (27): reliability 1 up to l, 0 from u on, and the cubic between that makes it C¹.
///
/// With the remaining share of the transition q = (u − d)/(u − l), R = q²(3 − 2q). In
/// s = 1 − q = (d − l)/(u − l) this is 1 − 3s² + 2s³; the form in q keeps full relative accuracy
/// where R is small, which is where 1/R matters. The four coefficients a_p of the paper cancel
/// badly and are not used.
///
/// 1/R is convex in d: it suffices that 2R'² ≥ R·R''. With derivatives by s, R' = −6q(1 − q) and
/// R'' = 6(1 − 2q), and dividing by q² > 0,
///
/// ```text
/// (2R'² − R·R'')/q² = 72(1 − q)² − 6(3 − 2q)(1 − 2q) = 48q² − 96q + 54 = 48(1 − q)² + 6 > 0.
/// ```
///
/// At d = l the slope of 1/R is continuous (zero), so the plateau in front keeps it convex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CubicReliability {
    full_range: f64,
    max_range: f64,
}

/// Why two ranges do not make a link model.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ReliabilityError {
    /// A range is not a finite number.
    #[error("the {name} of the links is {value}: it must be a finite length")]
    NotFinite {
        /// Which of the two ranges.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// The full range is negative.
    #[error("the full range of the links (l) is {full_range}: it must be at least 0")]
    Negative {
        /// What was given as l.
        full_range: f64,
    },
    /// The two ranges are not in order.
    #[error(
        "the full range of the links (l = {full_range}) must be smaller than their maximal range \
         (u = {max_range})"
    )]
    NotInOrder {
        /// What was given as l.
        full_range: f64,
        /// What was given as u.
        max_range: f64,
    },
    /// A model with this steepness is not continuously differentiable where R becomes 0.
    #[error("the steepness of the links is {steepness}: it must be a finite number of at least 2")]
    TooFlat {
        /// What was given as p.
        steepness: f64,
    },
    /// A margin that is no length, or that leaves no range.
    #[error(
        "the margin of the links is {margin}: it must be at least 0 and smaller than their \
         maximal range (u = {max_range})"
    )]
    Margin {
        /// What was given.
        margin: f64,
        /// The maximal range of the model.
        max_range: f64,
    },
}

impl CubicReliability {
    /// The model with reliability 1 up to `full_range` (l) and 0 from `max_range` (u) on.
    ///
    /// # Errors
    ///
    /// [`ReliabilityError`] unless 0 ≤ l < u and both are finite.
    pub fn new(full_range: f64, max_range: f64) -> Result<Self, ReliabilityError> {
        check_ranges(full_range, max_range)?;
        Ok(Self { full_range, max_range })
    }

    fn remaining(&self, distance: f64) -> f64 {
        remaining(distance, self.full_range, self.max_range)
    }
}

/// Whether 0 ≤ l < u, both finite.
fn check_ranges(full_range: f64, max_range: f64) -> Result<(), ReliabilityError> {
    for (name, value) in [("full range (l)", full_range), ("maximal range (u)", max_range)] {
        if !value.is_finite() {
            return Err(ReliabilityError::NotFinite { name, value });
        }
    }
    if full_range < 0.0 {
        return Err(ReliabilityError::Negative { full_range });
    }
    if full_range >= max_range {
        return Err(ReliabilityError::NotInOrder { full_range, max_range });
    }
    Ok(())
}

/// q: how much of the transition from u down to l is left, in [0, 1]; exact at both ends.
fn remaining(distance: f64, full_range: f64, max_range: f64) -> f64 {
    if distance <= full_range {
        1.0
    } else if distance >= max_range {
        0.0
    } else {
        (max_range - distance) / (max_range - full_range)
    }
}

impl LinkReliability for CubicReliability {
    fn reliability(&self, distance: f64) -> f64 {
        let remaining = self.remaining(distance);
        remaining * remaining * (3.0 - 2.0 * remaining)
    }

    fn slope(&self, distance: f64) -> f64 {
        let remaining = self.remaining(distance);
        -6.0 * remaining * (1.0 - remaining) / (self.max_range - self.full_range)
    }

    fn range(&self) -> f64 {
        self.max_range
    }

    fn full_range(&self) -> f64 {
        self.full_range
    }

    /// Closed form: the middle root of q²(3 − 2q) = R is q = ½ − sin(asin(1 − 2R)/3).
    fn distance_at(&self, reliability: f64) -> f64 {
        let reliability = reliability.clamp(0.0, 1.0);
        let remaining = 0.5 - ((1.0 - 2.0 * reliability).asin() / 3.0).sin();
        let distance = self.max_range - remaining * (self.max_range - self.full_range);
        distance.clamp(self.full_range, self.max_range)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix4, Vector4};
    use proptest::prelude::*;

    fn ranges() -> impl Strategy<Value = (f64, f64)> {
        (0.1..5.0f64, 0.05..2.0f64).prop_map(|(full, width)| (full, full + width))
    }

    /// a_0 … a_3 of eq. (27), from R(l) = 1, R(u) = 0, R'(l) = R'(u) = 0.
    fn coefficients(l: f64, u: f64) -> Vector4<f64> {
        #[rustfmt::skip]
        let conditions = Matrix4::new(
            1.0, l, l * l, l * l * l,
            1.0, u, u * u, u * u * u,
            0.0, 1.0, 2.0 * l, 3.0 * l * l,
            0.0, 1.0, 2.0 * u, 3.0 * u * u,
        );
        conditions.full_piv_lu().solve(&Vector4::new(1.0, 0.0, 0.0, 0.0)).unwrap()
    }

    proptest! {
        #[test]
        fn equals_the_polynomial_with_four_coefficients((l, u) in ranges(), s in 0.0..1.0f64) {
            let link = CubicReliability::new(l, u).unwrap();
            let a = coefficients(l, u);
            let d = l + s * (u - l);
            let polynomial = a[0] + d * (a[1] + d * (a[2] + d * a[3]));
            let cancellation = (a[3] * d * d * d).abs() * 1e-12;
            prop_assert!((link.reliability(d) - polynomial).abs() < 1e-9 + cancellation);
        }

        #[test]
        fn does_not_increase((l, u) in ranges(), a in 0.0..8.0f64, b in 0.0..8.0f64) {
            let link = CubicReliability::new(l, u).unwrap();
            prop_assert!(link.reliability(a.min(b)) >= link.reliability(a.max(b)));
            prop_assert!(link.slope(a) <= 0.0);
        }

        #[test]
        fn slope_is_the_derivative((l, u) in ranges(), s in -0.2..1.2f64) {
            let link = CubicReliability::new(l, u).unwrap();
            let (d, h) = (l + s * (u - l), 1e-6 * (u - l));
            let difference = (link.reliability(d + h) - link.reliability(d - h)) / (2.0 * h);
            prop_assert!((difference - link.slope(d)).abs() * (u - l) < 1e-5);
        }

        #[test]
        fn distance_at_inverts((l, u) in ranges(), reliability in 0.001..0.999f64) {
            let link = CubicReliability::new(l, u).unwrap();
            let distance = link.distance_at(reliability);
            prop_assert!((link.reliability(distance) - reliability).abs() < 1e-12);
        }

        /// Requirement 3, by the midpoint inequality on the whole range.
        #[test]
        fn expected_transmissions_are_convex_and_nondecreasing(
            (l, u) in ranges(), a in 0.0..0.99f64, b in 0.0..0.99f64, mix in 0.0..1.0f64,
        ) {
            let link = CubicReliability::new(l, u).unwrap();
            let cost = |share: f64| link.expected_transmissions(share * u);
            let between = cost(mix * a + (1.0 - mix) * b);
            prop_assert!(between <= (mix * cost(a) + (1.0 - mix) * cost(b)) * (1.0 + 1e-12));
            prop_assert!(cost(a.min(b)) <= cost(a.max(b)));
        }
    }

    #[test]
    fn is_continuously_differentiable_at_both_ends() {
        let link = CubicReliability::new(0.4, 0.5).unwrap();
        assert_eq!((link.reliability(0.4), link.slope(0.4)), (1.0, 0.0));
        assert_eq!((link.reliability(0.5), link.slope(0.5)), (0.0, 0.0));
        assert_eq!((link.reliability(0.0), link.reliability(9.0)), (1.0, 0.0));
        assert!(link.slope(0.4 + 1e-9).abs() < 1e-5 && link.slope(0.5 - 1e-9).abs() < 1e-5);
    }

    #[test]
    fn the_inverse_ends_at_the_two_ranges() {
        let link = CubicReliability::new(0.4, 0.5).unwrap();
        assert!((link.distance_at(1.0) - 0.4).abs() < 1e-12);
        assert!((link.distance_at(0.0) - 0.5).abs() < 1e-12);
        assert!((link.distance_at(0.8) - 0.4287).abs() < 1e-4);
    }

    #[test]
    fn ranges_that_make_no_link_are_refused() {
        assert!(CubicReliability::new(0.5, 0.5).is_err());
        assert!(CubicReliability::new(-0.1, 0.5).is_err());
        assert!(CubicReliability::new(f64::NAN, 0.5).is_err());
        assert!(CubicReliability::new(0.4, f64::INFINITY).is_err());
    }
}
