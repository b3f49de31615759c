//! Arbitrary expressions, predicates and states for the property tests.

use pleach_guards::{Expression, Predicate, always, constant, never, not, variable};
use proptest::prelude::*;

pub fn expressions() -> impl Strategy<Value = Expression> {
    let numbers = prop::sample::select(vec![-2.0, -0.5, 0.0, 1.0, 3.25, 10.0]);
    let leaf = prop_oneof![
        prop::sample::select(vec!["x", "y", "δ"]).prop_map(variable),
        numbers.prop_map(constant),
    ];
    leaf.prop_recursive(4, 16, 2, |inner| {
        let exponents = prop::sample::select(vec![2.0, 12.0, -1.0, 0.5, 1.5, -0.25]);
        prop_oneof![
            inner.clone().prop_map(|a| -a),
            inner.clone().prop_map(|a| a.abs()),
            (inner.clone(), exponents).prop_map(|(a, exponent)| a.power(exponent)),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| a + b),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| a - b),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| a * b),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| a / b),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| a.min(b)),
            (inner.clone(), inner).prop_map(|(a, b)| a.max(b)),
        ]
    })
}

pub fn predicates() -> impl Strategy<Value = Predicate> {
    let comparison = (expressions(), expressions(), 0..5).prop_map(|(a, b, kind)| match kind {
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
