//! Arbitrary expressions, predicates and states for the property tests.

#![allow(dead_code)] // each test takes what it needs

use std::sync::Arc;

use pleach_guards::{
    Choice, Comparison, Expression, Interpolation, Predicate, Relation, Table, UnaryOperator,
    always, constant, never, not, variable,
};
use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
use proptest::prelude::*;

/// Expressions over x, y and δ with a few round numbers.
pub fn expressions() -> impl Strategy<Value = Expression> {
    let names = prop::sample::select(vec!["x", "y", "δ"]);
    let numbers = prop::sample::select(vec![-2.0, -0.5, 0.0, 1.0, 3.25, 10.0]);
    let exponents = prop::sample::select(vec![2.0, 12.0, -1.0, 0.5, 1.5, -0.25]);
    expressions_of(names.prop_map(variable), numbers, exponents)
}

/// Expressions over any names and numbers.
pub fn odd_expressions() -> impl Strategy<Value = Expression> {
    let plain = "[a-zα-ω_][a-z0-9_.₀₁'′]{0,6}";
    let word = "min|sin|sqrt|e|and|or|not|always|never|infinity|NaN|inf";
    let any = "\\PC{0,4}|[`´² x]{0,4}|.{0,3}";
    let names = prop_oneof![4 => plain, 1 => word, 1 => any];
    expressions_of(names.prop_map(|name| variable(&name)), numbers(), numbers())
}

/// Any number but NaN, which does not equal itself.
fn numbers() -> impl Strategy<Value = f64> {
    let whole = (-1000..1000).prop_map(f64::from);
    let any = POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO;
    let infinite = prop::sample::select(vec![f64::INFINITY, f64::NEG_INFINITY]);
    prop_oneof![4 => whole, 4 => any, 1 => infinite]
}

fn expressions_of(
    variables: impl Strategy<Value = Expression> + 'static,
    numbers: impl Strategy<Value = f64> + 'static,
    exponents: impl Strategy<Value = f64> + 'static,
) -> impl Strategy<Value = Expression> {
    let exponents = exponents.boxed();
    let leaf = prop_oneof![variables, numbers.prop_map(constant)];
    leaf.prop_recursive(5, 24, 2, move |inner| {
        let inner = inner.boxed();
        let pairs = || (inner.clone(), inner.clone());
        prop_oneof![
            inner.clone().prop_map(|a| -a),
            inner.clone().prop_map(|a| Expression::Unary(UnaryOperator::Negation, Arc::new(a))),
            inner.clone().prop_map(|a| a.abs()),
            inner.clone().prop_map(|a| a.sin()),
            inner.clone().prop_map(|a| a.cos()),
            inner.clone().prop_map(|a| a.exp()),
            inner.clone().prop_map(|a| a.tan()),
            inner.clone().prop_map(|a| a.tanh()),
            inner.clone().prop_map(|a| a.sign()),
            inner.clone().prop_map(|a| a.floor()),
            pairs().prop_map(|(a, b)| a.atan2(b)),
            (tables(), inner.clone()).prop_map(|(table, a)| table.at(a)),
            (pairs(), pairs(), relations()).prop_map(|((a, b), (then, otherwise), relation)| {
                let condition = Comparison { left: a, relation, right: b };
                Expression::Choice(Arc::new(Choice { condition, then, otherwise }))
            }),
            inner.clone().prop_map(|a| a.ln()),
            (inner.clone(), exponents.clone()).prop_map(|(a, exponent)| a.power(exponent)),
            inner.clone().prop_map(|a| a.square_root()),
            pairs().prop_map(|(a, b)| a + b),
            pairs().prop_map(|(a, b)| a - b),
            pairs().prop_map(|(a, b)| a * b),
            pairs().prop_map(|(a, b)| a / b),
            pairs().prop_map(|(a, b)| a.min(b)),
            pairs().prop_map(|(a, b)| a.max(b)),
        ]
    })
}

fn relations() -> impl Strategy<Value = Relation> {
    let [most, least] = [Relation::AtMost, Relation::AtLeast];
    prop::sample::select(vec![most, least, Relation::LessThan, Relation::MoreThan])
}

/// Tables of up to four points.
fn tables() -> impl Strategy<Value = Table> {
    let kinds = vec![Interpolation::Linear, Interpolation::Steps, Interpolation::Flat];
    let points = prop::collection::btree_map(-3..4, -8..9, 1..5);
    (prop::sample::select(kinds), points).prop_map(|(kind, points)| {
        let points = points.into_iter().map(|(x, y)| (f64::from(x), 0.5 * f64::from(y)));
        Table::new(kind, points.collect::<Vec<_>>()).expect("places ascend")
    })
}

/// Predicates over x, y and δ with a few round numbers.
pub fn predicates() -> impl Strategy<Value = Predicate> {
    predicates_of(expressions()).boxed()
}

/// Predicates over any names and numbers, also such as no constructor builds.
pub fn odd_predicates() -> impl Strategy<Value = Predicate> {
    let parts = |inner: &BoxedStrategy<Predicate>| {
        prop::collection::vec(inner.clone(), 0..4).prop_filter("one part", |parts| parts.len() != 1)
    };
    let leaf = predicates_of(odd_expressions()).boxed();
    leaf.prop_recursive(2, 8, 3, move |inner| {
        let inner = inner.boxed();
        prop_oneof![
            parts(&inner).prop_map(|parts| Predicate::All(parts.into())),
            parts(&inner).prop_map(|parts| Predicate::Any(parts.into())),
        ]
    })
}

fn predicates_of(
    expressions: impl Strategy<Value = Expression> + 'static,
) -> impl Strategy<Value = Predicate> {
    let expressions = expressions.boxed();
    let comparison = (expressions.clone(), expressions, 0..5).prop_map(|(a, b, kind)| match kind {
        0 => a.at_most(b),
        1 => a.less_than(b),
        2 => a.at_least(b),
        3 => a.more_than(b),
        _ => a.equals_within(b, 0.5),
    });
    let leaf = prop_oneof![8 => comparison, 1 => Just(always()), 1 => Just(never())];
    leaf.prop_recursive(3, 8, 2, |inner| {
        prop_oneof![
            inner.clone().prop_map(not),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| a.and(b)),
            (inner.clone(), inner).prop_map(|(a, b)| a.or(b)),
        ]
    })
}
