//! States that are vectors.

use std::ops::Deref;

use pleach_guards::Valuation;

use super::{Coordinate, Coordinates};

/// A state that is a vector of nalgebra; its coordinates are called x₁ to xₙ.
///
/// ```
/// use pleach_automaton::{Coordinates, Vector};
/// use pleach_guards::Valuation;
///
/// let state = Vector::<2>::from([3.0, 4.0]);
/// assert_eq!(Vector::<2>::NAMES, ["x₁", "x₂"]);
/// assert_eq!((state.value("x₂"), state.norm()), (Some(4.0), 5.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector<const N: usize>(pub nalgebra::SVector<f64, N>);

impl<const N: usize> Vector<N> {
    /// The coordinates as variables for formulas.
    #[must_use]
    pub fn coordinates() -> [Coordinate<Self>; N] {
        std::array::from_fn(|index| Coordinate::new(Self::NAMES[index]))
    }
}

impl<const N: usize> From<[f64; N]> for Vector<N> {
    fn from(values: [f64; N]) -> Self {
        Vector(values.into())
    }
}

impl<const N: usize> Deref for Vector<N> {
    type Target = nalgebra::SVector<f64, N>;

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<const N: usize> Valuation for Vector<N> {
    fn value(&self, variable: &str) -> Option<f64> {
        let index = Self::NAMES.iter().position(|name| *name == variable)?;
        self.0.get(index).copied()
    }
}

impl<const N: usize> Coordinates for Vector<N> {
    /// At most a hundred; a longer vector does not compile.
    const NAMES: &'static [&'static str] = {
        assert!(N <= SUBSCRIPTED.len(), "a vector has at most 100 coordinates; a record has any");
        SUBSCRIPTED.split_at(N).0
    };

    fn from_values(values: &[f64]) -> Self {
        Vector(nalgebra::SVector::from_fn(|row, _| values.get(row).copied().unwrap_or(f64::NAN)))
    }

    fn write(&self, values: &mut [f64]) {
        for (place, value) in values.iter_mut().zip(&self.0) {
            *place = *value;
        }
    }
}

const SUBSCRIPTED: &[&str] = &[
    "x₁",
    "x₂",
    "x₃",
    "x₄",
    "x₅",
    "x₆",
    "x₇",
    "x₈",
    "x₉",
    "x₁₀",
    "x₁₁",
    "x₁₂",
    "x₁₃",
    "x₁₄",
    "x₁₅",
    "x₁₆",
    "x₁₇",
    "x₁₈",
    "x₁₉",
    "x₂₀",
    "x₂₁",
    "x₂₂",
    "x₂₃",
    "x₂₄",
    "x₂₅",
    "x₂₆",
    "x₂₇",
    "x₂₈",
    "x₂₉",
    "x₃₀",
    "x₃₁",
    "x₃₂",
    "x₃₃",
    "x₃₄",
    "x₃₅",
    "x₃₆",
    "x₃₇",
    "x₃₈",
    "x₃₉",
    "x₄₀",
    "x₄₁",
    "x₄₂",
    "x₄₃",
    "x₄₄",
    "x₄₅",
    "x₄₆",
    "x₄₇",
    "x₄₈",
    "x₄₉",
    "x₅₀",
    "x₅₁",
    "x₅₂",
    "x₅₃",
    "x₅₄",
    "x₅₅",
    "x₅₆",
    "x₅₇",
    "x₅₈",
    "x₅₉",
    "x₆₀",
    "x₆₁",
    "x₆₂",
    "x₆₃",
    "x₆₄",
    "x₆₅",
    "x₆₆",
    "x₆₇",
    "x₆₈",
    "x₆₉",
    "x₇₀",
    "x₇₁",
    "x₇₂",
    "x₇₃",
    "x₇₄",
    "x₇₅",
    "x₇₆",
    "x₇₇",
    "x₇₈",
    "x₇₉",
    "x₈₀",
    "x₈₁",
    "x₈₂",
    "x₈₃",
    "x₈₄",
    "x₈₅",
    "x₈₆",
    "x₈₇",
    "x₈₈",
    "x₈₉",
    "x₉₀",
    "x₉₁",
    "x₉₂",
    "x₉₃",
    "x₉₄",
    "x₉₅",
    "x₉₆",
    "x₉₇",
    "x₉₈",
    "x₉₉",
    "x₁₀₀",
];
