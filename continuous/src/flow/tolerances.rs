//! How accurate an integration is to be.

use thiserror::Error;

/// The error allowed in a step: of component x, at most `absolute` + `relative` · |x|.
///
/// It bounds the estimated error that one step adds, in every component by itself, so that what
/// is asked of a component does not depend on how many others are integrated along with it. The
/// error of a whole solution grows with its length and with the flow's own sensitivity; for
/// ordinary flows it stays within some ten to a hundred times the tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    relative: f64,
    absolute: f64,
    largest_step: f64,
}

/// The smallest relative tolerance that rounding leaves attainable: some 50 ulps, of which a step
/// loses a few.
const SMALLEST_RELATIVE: f64 = 1e-14;

impl Default for Tolerances {
    /// A relative tolerance of 10⁻⁹ and an absolute one of 10⁻¹², with steps of any length: an
    /// event is then located to about nine digits, and a step of order 5 is still long enough
    /// (about a tenth of a radian of an oscillation) to be cheap.
    fn default() -> Self {
        Tolerances { relative: 1e-9, absolute: 1e-12, largest_step: f64::INFINITY }
    }
}

impl Tolerances {
    /// Tolerances with steps of any length.
    ///
    /// `relative` has no unit; `absolute` has that of the state and says below which size a
    /// component no longer matters.
    ///
    /// # Errors
    ///
    /// [`InvalidTolerances`] unless 10⁻¹⁴ ≤ `relative` < 1 and 0 < `absolute` < ∞. Below the lower
    /// bound rounding decides; with no absolute tolerance no step is short enough for a component
    /// that passes zero.
    pub fn new(relative: f64, absolute: f64) -> Result<Self, InvalidTolerances> {
        if !(SMALLEST_RELATIVE..1.0).contains(&relative) {
            return Err(InvalidTolerances::Relative { relative });
        }
        if !(absolute > 0.0 && absolute.is_finite()) {
            return Err(InvalidTolerances::Absolute { absolute });
        }
        Ok(Tolerances { relative, absolute, largest_step: f64::INFINITY })
    }

    /// The same tolerances, with no step longer than `largest_step` seconds.
    ///
    /// An integrator measures its steps by what the field does at a few instants. A field that
    /// rests for long and then acts briefly can be stepped over; this bound prevents that.
    ///
    /// # Errors
    ///
    /// [`InvalidTolerances`] unless `largest_step` > 0; infinity is allowed.
    pub fn with_largest_step(self, largest_step: f64) -> Result<Self, InvalidTolerances> {
        if largest_step > 0.0 {
            Ok(Tolerances { largest_step, ..self })
        } else {
            Err(InvalidTolerances::LargestStep { largest_step })
        }
    }

    /// The relative tolerance.
    pub fn relative(&self) -> f64 {
        self.relative
    }

    /// The absolute tolerance, in the unit of the state.
    pub fn absolute(&self) -> f64 {
        self.absolute
    }

    /// The longest step allowed, in seconds.
    pub fn largest_step(&self) -> f64 {
        self.largest_step
    }

    /// The error allowed in a component of this size.
    pub(super) fn allowed(&self, size: f64) -> f64 {
        self.absolute + self.relative * size
    }
}

/// Why tolerances cannot be used.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum InvalidTolerances {
    /// The relative tolerance is out of range or NaN.
    #[error("the relative tolerance {relative} is not in [{SMALLEST_RELATIVE:e}, 1)")]
    Relative {
        /// What was given.
        relative: f64,
    },
    /// The absolute tolerance is not a positive finite number.
    #[error("the absolute tolerance {absolute} is not a positive finite number")]
    Absolute {
        /// What was given.
        absolute: f64,
    },
    /// The longest step is not positive.
    #[error("the longest step allowed, {largest_step} s, is not positive")]
    LargestStep {
        /// What was given, in seconds.
        largest_step: f64,
    },
}
