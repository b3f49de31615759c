//! Comparisons and expressions as surfaces need them: margins, parts, and sums without what is nothing.

use pleach_guards::{
    BinaryOperator, Comparison, Expression, Predicate, Relation, Substitution, UnaryOperator,
    constant,
};

/// Coefficients of two comparisons that differ by rounding are the same.
const ROUNDING: f64 = 1e-12;

/// What is positive where the comparison holds.
pub(super) fn margin(comparison: &Comparison) -> Expression {
    let Comparison { left, relation, right } = comparison;
    let is_lower = matches!(relation, Relation::AtMost | Relation::LessThan);
    let (more, less) = if is_lower { (right, left) } else { (left, right) };
    if *less == constant(0.0) {
        more.clone()
    } else if *more == constant(0.0) {
        negated(less)
    } else {
        more - less
    }
}

/// Whether the two compare the same numbers the other way round.
pub(super) fn are_opposite(one: &Comparison, other: &Comparison, numbers: &Substitution) -> bool {
    let is_lower = |one: &Comparison| matches!(one.relation, Relation::AtMost | Relation::LessThan);
    let is_turned = is_lower(one) != is_lower(other);
    if is_turned && one.left == other.left && one.right == other.right
        || !is_turned && one.left == other.right && one.right == other.left
    {
        return true;
    }
    let [first, second] = [one, other].map(margin);
    let forms = [first, second].map(|margin| margin.substitute(numbers).linear_form());
    let [Some(first), Some(second)] = forms else { return false };
    let Some((name, coefficient)) = first.coefficients().next() else { return false };
    let Some(ratio) = second.coefficient(name).map(|other| -other / coefficient) else {
        return false;
    };
    let agree = |one: f64, other: f64| (one * ratio + other).abs() <= ROUNDING * other.abs();
    let same =
        |name: &str, value: f64| second.coefficient(name).is_some_and(|it| agree(value, *it));
    ratio > 0.0
        && first.coefficients().count() == second.coefficients().count()
        && first.coefficients().all(|(name, value)| same(name, *value))
        && agree(*first.constant(), *second.constant())
}

pub(super) fn conjuncts(predicate: &Predicate) -> Vec<Predicate> {
    match predicate {
        Predicate::All(parts) => parts.iter().flat_map(conjuncts).collect(),
        other => vec![other.clone()],
    }
}

pub(super) fn without(mut parts: Vec<Predicate>, place: usize) -> Predicate {
    parts.remove(place);
    Predicate::all(parts)
}

pub(super) fn negated(expression: &Expression) -> Expression {
    match expression {
        Expression::Constant(value) => constant(-value),
        Expression::Binary(BinaryOperator::Difference, left, right) => &**right - &**left,
        Expression::Unary(UnaryOperator::Negation, operand) => (**operand).clone(),
        other => -other,
    }
}

pub(super) fn plus(left: Expression, right: Expression) -> Expression {
    if left == constant(0.0) {
        right
    } else if right == constant(0.0) {
        left
    } else {
        left + right
    }
}

pub(super) fn times(left: &Expression, right: &Expression) -> Expression {
    let (zero, one) = (constant(0.0), constant(1.0));
    if *left == zero || *right == zero {
        zero
    } else if *left == one {
        right.clone()
    } else if *right == one {
        left.clone()
    } else if *left == constant(-1.0) {
        negated(right)
    } else {
        left * right
    }
}
