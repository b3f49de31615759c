//! Derivatives of expressions, as expressions.

use std::convert::Infallible;
use std::sync::Arc;

use crate::expression::{BinaryOperator, Choice, Expression, UnaryOperator, constant};
use crate::fold::Operands;
use crate::predicate::Comparison;

impl Expression {
    /// The partial derivative with respect to `variable`.
    ///
    /// Where an absolute value, minimum or maximum has a kink, and where a sign, a floor, a choice
    /// or a table of steps may jump, the derivative divides 0 by 0 and so is not a number; elsewhere
    /// it is that of the side the state is on. At a point of a table of lines it is the slope of the
    /// line that follows. Terms that are 0 and factors that are 1 are left out, nothing else is
    /// simplified.
    ///
    /// ```
    /// use pleach_guards::variable;
    ///
    /// let (x, y) = (variable("x"), variable("y"));
    /// assert_eq!((x.power(3.0) - &x * &y).derivative("x").to_string(), "3 · x² − y");
    ///
    /// let slope = x.abs().derivative("x");
    /// assert_eq!(slope.to_string(), "x ÷ |x|");
    /// assert_eq!(slope.evaluate(&[("x", -2.5)])?, -1.0);
    /// assert!(slope.evaluate(&[("x", 0.0)]).is_err());
    /// # Ok::<(), pleach_guards::EvaluationError>(())
    /// ```
    pub fn derivative(&self, variable: &str) -> Expression {
        let Ok(derivative) = self.fold(&mut |part, inner| {
            Ok::<_, Infallible>(part.derivative_by_operands(inner, variable))
        });
        derivative
    }

    /// The derivative, given those of the operands.
    fn derivative_by_operands(&self, inner: Operands<Expression>, variable: &str) -> Expression {
        match (self, inner) {
            (Expression::Variable(name), _) if **name == *variable => constant(1.0),
            (Expression::Unary(operator, operand), Operands::One(inner)) => {
                operator.derivative(operand, inner)
            }
            (Expression::Binary(operator, left, right), Operands::Two(one, another)) => {
                operator.derivative((left, one), (right, another))
            }
            (Expression::Power(base, exponent), Operands::One(inner)) => {
                let lowered = match exponent - 1.0 {
                    0.0 => constant(1.0),
                    1.0 => (**base).clone(),
                    lowered => base.power(lowered),
                };
                product(product(constant(*exponent), lowered), inner)
            }
            (Expression::Lookup(table, place), Operands::One(inner)) => {
                product(table.derivative().at(&**place), inner)
            }
            (Expression::Choice(choice), Operands::Four([left, right, then, otherwise])) => {
                choice.derivative([left, right], then, otherwise)
            }
            _ => constant(0.0),
        }
    }
}

impl Choice {
    /// The derivative of what is chosen, and no number where the choice changes: there it may jump.
    fn derivative(
        &self,
        [left, right]: [Expression; 2],
        then: Expression,
        otherwise: Expression,
    ) -> Expression {
        let Comparison { left: one, right: another, .. } = &self.condition;
        let is_fixed = is(&left, 0.0) && is(&right, 0.0);
        let chosen = if then == otherwise {
            then
        } else {
            let parts = [one.clone(), another.clone(), then, otherwise];
            Expression::Choice(Arc::new(self.with(parts)))
        };
        if is_fixed { chosen } else { sum(chosen, at_jumps(one - another)) }
    }
}

/// 0, and no number where `distance` is 0.
fn at_jumps(distance: Expression) -> Expression {
    constant(0.0) / distance
}

impl UnaryOperator {
    /// The derivative of the operator on an operand, given with its own derivative.
    fn derivative(self, operand: &Expression, inner: Expression) -> Expression {
        let slope = match self {
            UnaryOperator::Negation => return opposite(inner),
            UnaryOperator::AbsoluteValue => operand / operand.abs(),
            UnaryOperator::Sine => operand.cos(),
            UnaryOperator::Cosine => -operand.sin(),
            UnaryOperator::Tangent => 1.0 + operand.tan().power(2.0),
            UnaryOperator::HyperbolicTangent => 1.0 - operand.tanh().power(2.0),
            UnaryOperator::Sign => at_jumps(operand.clone()),
            UnaryOperator::Floor => at_jumps(operand - operand.floor()),
            UnaryOperator::Exponential => operand.exp(),
            UnaryOperator::Logarithm => 1.0 / operand,
        };
        product(slope, inner)
    }
}

impl BinaryOperator {
    /// The derivative of the operator on two operands, each given with its own derivative.
    fn derivative(
        self,
        (left, inner_left): (&Expression, Expression),
        (right, inner_right): (&Expression, Expression),
    ) -> Expression {
        match self {
            BinaryOperator::Sum => sum(inner_left, inner_right),
            BinaryOperator::Difference => difference(inner_left, inner_right),
            BinaryOperator::Product => {
                sum(product(inner_left, right.clone()), product(left.clone(), inner_right))
            }
            BinaryOperator::Quotient if is(&inner_right, 0.0) => {
                quotient(inner_left, right.clone())
            }
            BinaryOperator::Quotient => quotient(
                difference(product(inner_left, right.clone()), product(left.clone(), inner_right)),
                right.power(2.0),
            ),
            BinaryOperator::Angle => quotient(
                difference(product(right.clone(), inner_left), product(left.clone(), inner_right)),
                left.power(2.0) + right.power(2.0),
            ),
            // Halfway between the operands, less or more half their distance.
            BinaryOperator::Minimum | BinaryOperator::Maximum if inner_left == inner_right => {
                inner_left
            }
            BinaryOperator::Minimum | BinaryOperator::Maximum => {
                let side = (left - right) / (left - right).abs();
                let apart = product(side, difference(inner_left.clone(), inner_right.clone()));
                let twice = sum(inner_left, inner_right);
                let turned = match self {
                    BinaryOperator::Minimum => difference(twice, apart),
                    _ => sum(twice, apart),
                };
                quotient(turned, constant(2.0))
            }
        }
    }
}

fn is(expression: &Expression, number: f64) -> bool {
    matches!(expression, Expression::Constant(value) if *value == number)
}

fn opposite(operand: Expression) -> Expression {
    if is(&operand, 0.0) { operand } else { -operand }
}

fn sum(left: Expression, right: Expression) -> Expression {
    if is(&left, 0.0) {
        right
    } else if is(&right, 0.0) {
        left
    } else {
        left + right
    }
}

fn difference(left: Expression, right: Expression) -> Expression {
    if is(&right, 0.0) {
        left
    } else if is(&left, 0.0) {
        -right
    } else {
        left - right
    }
}

fn product(left: Expression, right: Expression) -> Expression {
    if is(&left, 0.0) || is(&right, 1.0) {
        left
    } else if is(&right, 0.0) || is(&left, 1.0) {
        right
    } else {
        left * right
    }
}

fn quotient(left: Expression, right: Expression) -> Expression {
    if is(&left, 0.0) || is(&right, 1.0) { left } else { left / right }
}
