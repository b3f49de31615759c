//! Smooth forms of expressions with kinks.

use pleach_guards::{Expression, Sides, Table, piecewise, variable};
use proptest::prelude::*;

use super::common::expressions;

const NAMES: [&str; 3] = ["x", "y", "δ"];

fn sides_of(expression: &Expression) -> Option<Sides> {
    Sides::compile([expression], &NAMES).expect("these are all")
}

/// The value on the sides that are chosen.
fn smooth(sides: &Sides, values: &[f64]) -> f64 {
    let mut result = [0.0];
    sides.smooth().evaluate(values, &mut sides.smooth().places(), &mut result);
    result[0]
}

fn is_same(one: f64, other: f64) -> bool {
    one == other || (one - other).abs() <= 1e-14 * one.abs().max(other.abs()).max(1.0)
}

proptest! {
    #![proptest_config(cases::usually(512))]

    /// On the sides of a state the smooth form has the value of the expression, and nothing is passed;
    /// where nothing is passed in another state, it has the value there, too.
    #[test]
    fn sides_have_the_values_of_the_expression(
        expression in expressions(),
        state in prop::array::uniform3(-4.0..4.0_f64),
        moved in prop::array::uniform3(-4.0..4.0_f64),
    ) {
        let Some(sides) = sides_of(&expression) else { return Ok(()) };
        let value = |state: [f64; 3]| expression.compile(&NAMES).map(|one| one.evaluate(&state));
        let mut values = state.to_vec();
        values.resize(3 + sides.count(), 0.0);
        sides.choose(&mut values);
        if smooth(&sides, &values).is_nan() {
            return Ok(());
        }
        let exact = value(state).expect("these are all");
        if exact.is_finite() {
            prop_assert!(is_same(smooth(&sides, &values), exact), "{expression} {state:?}");
            if let Ok(passed) = sides.passed().evaluate(&values) {
                prop_assert!(!passed.holds, "{expression} {state:?}");
            }
        }
        prop_assert_eq!(sides.choose(&mut values), None);
        values[..3].copy_from_slice(&moved);
        let exact = value(moved).expect("these are all");
        let is_passed = sides.passed().evaluate(&values).map_or(true, |verdict| verdict.holds);
        if !is_passed && exact.is_finite() {
            prop_assert!(is_same(smooth(&sides, &values), exact), "{expression} {moved:?}");
        }
        if is_passed && sides.passed().evaluate(&values).is_ok() {
            prop_assert!(sides.choose(&mut values).is_some(), "{expression} {moved:?}");
        }
    }
}

/// From −1 to 1, where each of these passes one kink of its own.
#[test]
fn every_kink_is_passed() {
    let x = variable("x");
    let table = Table::linear([(-2.0, 3.0), (0.0, 1.0), (2.0, 5.0)]).expect("in order");
    let steps = Table::steps([(-2.0, 3.0), (0.0, 1.0)]).expect("in order");
    let case = piecewise([(x.less_than(0.0), 2.0 * &x)], x.power(2.0)).expect("a comparison");
    let inner = (&x + 5.0).abs().min((&x - 5.0).abs());
    let kinks = [
        x.abs(),
        x.sign(),
        x.floor(),
        x.min(0.0),
        x.max(0.0),
        case,
        table.at(&x),
        steps.at(&x),
        inner,
    ];
    for kink in kinks {
        let sides = sides_of(&kink).expect("it has a kink");
        let mut values = vec![0.0; 3 + sides.count()];
        values[0] = -1.0;
        sides.choose(&mut values);
        values[0] = -1e-9;
        assert!(!sides.passed().evaluate(&values).expect("a number").holds, "{kink}");
        values[0] = 1e-9;
        assert!(sides.passed().evaluate(&values).expect("a number").holds, "{kink}");
        assert!(
            sides
                .choose(&mut values)
                .is_some_and(|passed| kink == *passed || kink.to_string().contains("5"))
        );
    }
    assert!(sides_of(&(x.sin() * x.exp())).is_none());
}

/// What a choice leaves out has no kinks, and need not have a value.
#[test]
fn kinks_of_what_is_left_out_do_not_count() {
    let x = variable("x");
    let root = piecewise([(x.at_least(0.0), x.square_root().abs())], -1.0).expect("a comparison");
    let sides = sides_of(&root).expect("it has kinks");
    let mut values = vec![0.0; 3 + sides.count()];
    values[0] = -4.0;
    sides.choose(&mut values);
    assert!(!sides.passed().evaluate(&values).expect("a number").holds);
    assert_eq!(smooth(&sides, &values), -1.0);
    values[0] = 4.0;
    assert!(sides.passed().evaluate(&values).expect("a number").holds);
    assert_eq!(sides.choose(&mut values), Some(&root));
    assert_eq!(smooth(&sides, &values), 2.0);
}
