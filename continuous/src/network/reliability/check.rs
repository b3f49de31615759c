//! A search for distances at which a model of links breaks what is required of it.

use thiserror::Error;

use super::LinkReliability;

/// Distances that are tried, evenly spread from 0 to a little beyond the range.
const SAMPLES: usize = 1200;
/// How far beyond the range distances are tried, as a share of it.
const BEYOND: f64 = 1.2;
/// Relative rounding in the values of a model.
const ROUNDING: f64 = 1e-9;
/// Half the width of a difference quotient, as a share of the range: halves its rounding and its
/// curvature error about evenly.
const DIFFERENCE: f64 = 1e-6;
/// How far a slope may differ from the difference quotient, per range.
const SLOPE_TOLERANCE: f64 = 1e-2;

/// A requirement of [`LinkReliability`] that a model breaks, and where.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BrokenRequirement {
    /// The two ranges are not 0 ≤ l ≤ u, with a finite u > 0.
    #[error("the ranges are {full_range} and {range}: they must be 0 ≤ l ≤ u, u positive, finite")]
    Ranges {
        /// l.
        full_range: f64,
        /// u.
        range: f64,
    },
    /// R is not in [0, 1], not 1 within l, or not 0 from u on.
    #[error(
        "the reliability at {distance} is {reliability}: it must be in [0, 1], 1 up to l and 0 \
         from u on"
    )]
    Value {
        /// The distance.
        distance: f64,
        /// R there.
        reliability: f64,
    },
    /// R increases somewhere before this distance.
    #[error("the reliability increases shortly before {distance}: it must not")]
    Increases {
        /// The distance.
        distance: f64,
    },
    /// The slope is positive, or not the derivative of R.
    #[error(
        "the slope at {distance} is {slope}, where the difference quotient is {quotient}: it must \
         be the derivative, and not positive"
    )]
    Slope {
        /// The distance.
        distance: f64,
        /// What the model says.
        slope: f64,
        /// What its values say.
        quotient: f64,
    },
    /// 1/R is not convex around this distance.
    #[error("1/R is not convex near {distance}: certified acceptance rests on its convexity")]
    NotConvex {
        /// The distance.
        distance: f64,
    },
    /// The inverse does not lead to the largest distance of a reliability.
    #[error(
        "the distance for a reliability of {reliability} is given as {distance}, where the \
         reliability is different"
    )]
    Inverse {
        /// The reliability.
        reliability: f64,
        /// The distance that the model gives.
        distance: f64,
    },
}

/// Tries the requirements of [`LinkReliability`] at 1,200 distances up to beyond the range.
///
/// That finds mistakes; a proof it is not. The midpoint inequality is tried on neighbouring
/// distances, so that each stretch of non-convexity longer than a five-hundredth of the range
/// shows, unless it is as shallow as rounding.
///
/// # Errors
///
/// The first requirement that is broken, with the distance.
///
/// ```
/// use pleach_continuous::network::CubicReliability;
/// use pleach_continuous::network::reliability::check;
///
/// check(&CubicReliability::new(0.4, 0.5)?)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check(model: &(impl LinkReliability + ?Sized)) -> Result<(), BrokenRequirement> {
    let (full_range, range) = (model.full_range(), model.range());
    if !(range.is_finite() && range > 0.0 && (0.0..=range).contains(&full_range)) {
        return Err(BrokenRequirement::Ranges { full_range, range });
    }
    let step = BEYOND * range / SAMPLES as f64;
    let distances = || (0..=SAMPLES).map(|sample| sample as f64 * step);
    distances().try_for_each(|distance| check_value(model, distance))?;
    distances().skip(1).try_for_each(|distance| check_course(model, distance, step))?;
    (1..SAMPLES).try_for_each(|sample| check_inverse(model, sample as f64 / SAMPLES as f64))
}

fn check_value(
    model: &(impl LinkReliability + ?Sized),
    distance: f64,
) -> Result<(), BrokenRequirement> {
    let reliability = model.reliability(distance);
    let is_right = if distance < model.full_range() {
        (reliability - 1.0).abs() <= ROUNDING
    } else if distance >= model.range() {
        reliability == 0.0
    } else {
        (0.0..=1.0).contains(&reliability)
    };
    if is_right { Ok(()) } else { Err(BrokenRequirement::Value { distance, reliability }) }
}

/// Monotonicity, slope and convexity around a distance.
fn check_course(
    model: &(impl LinkReliability + ?Sized),
    distance: f64,
    step: f64,
) -> Result<(), BrokenRequirement> {
    if model.reliability(distance) > model.reliability(distance - step) {
        return Err(BrokenRequirement::Increases { distance });
    }
    let half = DIFFERENCE * model.range();
    let rise = model.reliability(distance + half) - model.reliability(distance - half);
    let (slope, quotient) = (model.slope(distance), rise / (2.0 * half));
    let deviation = (slope - quotient).abs() * model.range();
    if !(slope <= 0.0 && deviation <= SLOPE_TOLERANCE * (1.0 + quotient.abs() * model.range())) {
        return Err(BrokenRequirement::Slope { distance, slope, quotient });
    }
    let cost = |distance: f64| model.expected_transmissions(distance);
    let chord = (cost(distance - step) + cost(distance + step)) / 2.0;
    if cost(distance) <= chord * (1.0 + ROUNDING) {
        Ok(())
    } else {
        Err(BrokenRequirement::NotConvex { distance })
    }
}

fn check_inverse(
    model: &(impl LinkReliability + ?Sized),
    reliability: f64,
) -> Result<(), BrokenRequirement> {
    let distance = model.distance_at(reliability);
    let clamped = distance <= model.full_range() || distance >= model.range();
    let found = model.reliability(distance);
    if clamped || (found - reliability).abs() <= ROUNDING {
        Ok(())
    } else {
        Err(BrokenRequirement::Inverse { reliability, distance })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::network::{CubicReliability, LogisticReliability, WithMargin};

    #[test]
    fn the_models_keep_the_requirements() {
        let cubic = CubicReliability::new(0.4, 0.5).unwrap();
        let without_plateau = WithMargin::new(cubic, 0.45).unwrap();
        let models: [Arc<dyn LinkReliability>; 7] = [
            Arc::new(cubic),
            Arc::new(CubicReliability::new(0.0, 3.0).unwrap()),
            Arc::new(LogisticReliability::new(0.4, 0.5, 2.0).unwrap()),
            Arc::new(LogisticReliability::new(1.0, 9.0, 8.0).unwrap()),
            Arc::new(WithMargin::new(cubic, 0.0).unwrap()),
            Arc::new(WithMargin::new(cubic, 0.03).unwrap()),
            Arc::new(without_plateau),
        ];
        for model in models {
            assert_eq!(check(&model), Ok(()), "{model:?}");
        }
    }

    /// The cubic model with one thing spoilt.
    #[derive(Debug, Clone, Copy)]
    enum Spoilt {
        Range,
        Plateau,
        Bump,
        Slope,
        /// Falls to ½, stays there for a moment, and falls to 0: 1/R is not convex at the step.
        Stairs,
        Inverse,
    }

    fn cubic() -> CubicReliability {
        CubicReliability::new(0.4, 0.8).unwrap()
    }

    /// The two flights of the stairs.
    fn flights() -> [CubicReliability; 2] {
        [(0.4, 0.6), (0.6, 0.8)].map(|(l, u)| CubicReliability::new(l, u).unwrap())
    }

    impl LinkReliability for Spoilt {
        fn reliability(&self, distance: f64) -> f64 {
            match self {
                Spoilt::Plateau if distance < 0.1 => 0.9,
                Spoilt::Bump if (0.5..0.55).contains(&distance) => 0.1,
                Spoilt::Stairs => {
                    flights().iter().map(|flight| flight.reliability(distance) / 2.0).sum()
                }
                _ => cubic().reliability(distance),
            }
        }

        fn slope(&self, distance: f64) -> f64 {
            match self {
                Spoilt::Slope => cubic().slope(distance) * 0.9,
                Spoilt::Stairs => flights().iter().map(|flight| flight.slope(distance) / 2.0).sum(),
                _ => cubic().slope(distance),
            }
        }

        fn range(&self) -> f64 {
            if matches!(self, Spoilt::Range) { f64::INFINITY } else { 0.8 }
        }

        fn full_range(&self) -> f64 {
            0.4
        }

        fn distance_at(&self, reliability: f64) -> f64 {
            let error = if matches!(self, Spoilt::Inverse) { 0.01 } else { 0.0 };
            cubic().distance_at(reliability) - error
        }
    }

    #[test]
    fn broken_requirements_are_found() {
        use BrokenRequirement as Broken;
        let broken = |model: Spoilt| check(&model).unwrap_err();
        assert!(matches!(broken(Spoilt::Range), Broken::Ranges { .. }));
        assert!(matches!(broken(Spoilt::Plateau), Broken::Value { distance: 0.0, .. }));
        assert!(matches!(broken(Spoilt::Bump), Broken::Slope { .. } | Broken::Increases { .. }));
        assert!(matches!(broken(Spoilt::Slope), Broken::Slope { .. }));
        assert!(matches!(broken(Spoilt::Inverse), Broken::Inverse { .. }));
        let Broken::NotConvex { distance } = broken(Spoilt::Stairs) else { panic!("convex") };
        assert!((0.4..0.6).contains(&distance), "{distance}");
    }

    #[test]
    fn what_is_broken_is_told_on_one_line() {
        for model in [Spoilt::Plateau, Spoilt::Slope, Spoilt::Inverse] {
            let told = check(&model).unwrap_err().to_string();
            assert!(!told.contains(['\n', '\\']), "{told}");
        }
    }

    /// The range less the margin is rounded; from there on nothing arrives.
    #[test]
    fn a_margin_takes_nothing_but_its_length_from_the_range() {
        for (range, margin) in [(3.65, 0.353), (0.86, 0.18), (3.47, 0.611)] {
            let link = CubicReliability::new(0.4, range).unwrap();
            let link = WithMargin::new(link, margin).unwrap();
            assert_eq!(link.reliability(link.range()), 0.0);
            assert_eq!(link.slope(link.range()), 0.0);
            assert_eq!(link.expected_transmissions(link.range()), f64::INFINITY);
            assert_eq!(check(&link), Ok(()), "{link:?}");
        }
    }

    #[test]
    fn models_that_cannot_be_are_refused() {
        assert!(LogisticReliability::new(0.4, 0.5, 1.9).is_err());
        assert!(LogisticReliability::new(0.4, 0.5, f64::NAN).is_err());
        assert!(LogisticReliability::new(0.5, 0.4, 2.0).is_err());
        for margin in [-0.1, 0.8, f64::NAN] {
            assert!(WithMargin::new(cubic(), margin).is_err());
        }
    }
}
