//! The operators of expressions, and what they compute.

/// An operator with one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum UnaryOperator {
    /// −a
    Negation,
    /// |a|
    AbsoluteValue,
    /// sin a, of an angle in radians
    Sine,
    /// cos a, of an angle in radians
    Cosine,
    /// tan a, of an angle in radians
    Tangent,
    /// tanh a
    HyperbolicTangent,
    /// eᵃ
    Exponential,
    /// ln a, to the base e
    Logarithm,
    /// −1, 0 or 1, as a is negative, 0 or positive
    Sign,
    /// The largest whole number that is at most a
    Floor,
}

/// An operator with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum BinaryOperator {
    /// a + b
    Sum,
    /// a − b
    Difference,
    /// a · b
    Product,
    /// a ÷ b
    Quotient,
    /// min(a, b)
    Minimum,
    /// max(a, b)
    Maximum,
    /// The angle of the point (b, a), from −π to π radians
    Angle,
}

impl UnaryOperator {
    pub(crate) fn apply(self, operand: f64) -> f64 {
        match self {
            UnaryOperator::Negation => -operand,
            UnaryOperator::AbsoluteValue => operand.abs(),
            UnaryOperator::Sine => operand.sin(),
            UnaryOperator::Cosine => operand.cos(),
            UnaryOperator::Tangent => operand.tan(),
            UnaryOperator::HyperbolicTangent => operand.tanh(),
            UnaryOperator::Exponential => operand.exp(),
            UnaryOperator::Logarithm => operand.ln(),
            UnaryOperator::Sign if operand == 0.0 => 0.0,
            UnaryOperator::Sign => operand.signum(),
            UnaryOperator::Floor => operand.floor(),
        }
    }
}

impl BinaryOperator {
    /// The result, which is NaN where an operand is: no minimum and no maximum hides it.
    #[inline]
    pub(crate) fn apply(self, left: f64, right: f64) -> f64 {
        match self {
            BinaryOperator::Sum => left + right,
            BinaryOperator::Difference => left - right,
            BinaryOperator::Product => left * right,
            BinaryOperator::Quotient => left / right,
            BinaryOperator::Minimum | BinaryOperator::Maximum
                if left.is_nan() || right.is_nan() =>
            {
                f64::NAN
            }
            // Of equal ones the left one: zeros have signs.
            BinaryOperator::Minimum => {
                if right < left {
                    right
                } else {
                    left
                }
            }
            BinaryOperator::Maximum => {
                if right > left {
                    right
                } else {
                    left
                }
            }
            BinaryOperator::Angle => left.atan2(right),
        }
    }
}

/// A power, which is NaN where the base is: the power 0 does not hide it.
///
/// Squares and roots go through operations that IEEE 754 rounds exactly, so that they are the same
/// on every machine.
#[inline]
pub(crate) fn raise(base: f64, exponent: f64) -> f64 {
    if exponent == 2.0 {
        base * base
    } else if exponent == 0.5 {
        base.sqrt()
    } else if base.is_nan() {
        base
    } else {
        base.powf(exponent)
    }
}
