//! Compiled expressions and predicates against the trees they come from.

use crate::common::{expressions, predicates};
use pleach_guards::{
    EvaluationError, Expression, Interval, Predicate, Substitution, Tape, Verdict, constant,
    variable,
};
use proptest::prelude::*;

const NAMES: [&str; 3] = ["δ", "x", "y"];

proptest! {
    #[test]
    fn programs_compute_bit_for_bit(expression in expressions(), values in values()) {
        let program = expression.compile(&NAMES).expect("these are all names that occur");
        let expected = expression.evaluate(&state(values)).unwrap_or(f64::NAN);
        prop_assert!(same(program.evaluate(&values), expected), "{expression} at {values:?}");
        let [delta, x, y] = values;
        let found = program.evaluate_at(&[y, 99.0, delta, x], &[2, 3, 0]);
        prop_assert!(same(found, expected), "{expression} at {values:?}");
    }

    #[test]
    fn tapes_compute_bit_for_bit(
        expressions in prop::collection::vec(expressions(), 1..4),
        values in values(),
    ) {
        // Whole expressions and their sums share their parts.
        let sums = expressions.windows(2).map(|pair| &pair[0] * &pair[1] - &pair[0]);
        let all: Vec<_> = expressions.iter().cloned().chain(sums).collect();
        let tape = Tape::compile(&all, &NAMES).expect("these are all names that occur");
        let (mut places, mut results) = (tape.places(), vec![0.0; all.len()]);
        for _ in 0..2 {
            tape.evaluate(&values, &mut places, &mut results);
            for (expression, found) in all.iter().zip(&results) {
                let expected = expression.evaluate(&state(values)).unwrap_or(f64::NAN);
                prop_assert!(same(*found, expected), "{expression} at {values:?}");
            }
        }
    }

    /// Equal parts under other names, whose instructions lie side by side.
    #[test]
    fn tapes_of_equal_parts_compute_bit_for_bit(
        expression in expressions(),
        states in prop::collection::vec(values(), 1..11),
    ) {
        let names = |part: usize| NAMES.map(|name| format!("{name}{part}"));
        let listed = (0..NAMES.len()).flat_map(|one| (0..states.len()).map(move |part| (one, part)));
        let listed: Vec<String> = listed.map(|(one, part)| names(part)[one].clone()).collect();
        let parts = (0..states.len()).map(|part| {
            let own = names(part);
            let pairs = NAMES.iter().zip(&own).map(|(&old, new)| (old, new.as_str()));
            2.0 * expression.substitute(&Substitution::renaming(pairs)) + 1.0
        });
        let parts: Vec<Expression> = parts.collect();
        let tape = Tape::compile(&parts, &listed).expect("these are all names that occur");
        let values: Vec<f64> =
            (0..NAMES.len()).flat_map(|one| states.iter().map(move |values| values[one])).collect();
        let mut results = vec![0.0; parts.len()];
        tape.evaluate(&values, &mut tape.places(), &mut results);
        for (values, found) in states.iter().zip(&results) {
            let whole = 2.0 * &expression + 1.0;
            let expected = whole.evaluate(&state(*values)).unwrap_or(f64::NAN);
            prop_assert!(same(*found, expected), "{expression} at {values:?}");
        }
    }

    /// What a tape computes from numbers lies in what it computes from intervals around them.
    #[test]
    fn ranges_of_tapes_contain_their_values(
        expressions in prop::collection::vec(expressions(), 1..4),
        one in prop::array::uniform3(-10.0..10.0),
        other in prop::array::uniform3(-10.0..10.0),
        shares in prop::array::uniform3(0.0..=1.0),
    ) {
        let tape = Tape::compile(&expressions, &NAMES).expect("these are all names that occur");
        let (one, other, shares): ([f64; 3], [f64; 3], [f64; 3]) = (one, other, shares);
        let bounds = |place: usize| -> Interval {
            let (low, high) = (one[place].min(other[place]), one[place].max(other[place]));
            Interval::new(low, high).expect("they are in order")
        };
        let boxed: [Interval; 3] = std::array::from_fn(bounds);
        let inside: [f64; 3] = std::array::from_fn(|place| {
            let (low, high) = (boxed[place].lower(), boxed[place].upper());
            (low + shares[place] * (high - low)).clamp(low, high)
        });
        let (mut places, mut ranges) = (Vec::new(), Vec::new());
        tape.ranges(&boxed, &mut places, &mut ranges);
        let mut results = vec![0.0; expressions.len()];
        tape.evaluate(&inside, &mut tape.places(), &mut results);
        for ((expression, range), result) in expressions.iter().zip(&ranges).zip(results) {
            let is_inside = result.is_nan() || range.contains(result);
            prop_assert!(is_inside, "{expression}: {result} at {inside:?}, {range}");
        }
    }

    #[test]
    fn compiled_predicates_give_the_same_verdicts_and_errors(
        predicate in predicates(),
        values in values(),
    ) {
        let compiled = predicate.compile(&NAMES).expect("these are all names that occur");
        prop_assert_eq!(compiled.to_string(), predicate.to_string());
        let expected = predicate.evaluate(&state(values));
        let [delta, x, y] = values;
        let compact = compiled.evaluate(&values);
        let scattered = compiled.evaluate_at(&[y, 99.0, delta, x], &[2, 3, 0]);
        for found in [compact, scattered] {
            prop_assert_eq!(&found, &expected);
            let bits = |verdict: &Verdict| verdict.margin.to_bits();
            prop_assert_eq!(found.as_ref().map(bits), expected.as_ref().map(bits));
        }
    }
}

#[test]
fn deep_expressions_allocate_their_stack() {
    let deep = (0..100).fold(variable("x"), |inner, step| {
        (variable("x") - variable("y")) - (variable("y") - inner) * f64::from(step)
    });
    let values = [0.0, 0.25, 0.125];
    let expected = deep.evaluate(&state(values)).expect("these are numbers");
    let program = deep.compile(&NAMES).expect("these are the names");
    assert!(same(program.evaluate(&values), expected));
}

#[test]
fn no_minimum_and_no_power_hides_what_is_not_a_number() {
    let undefined = variable("x") / variable("x");
    for hidden in [undefined.min(1.0), undefined.max(1.0), undefined.power(0.0)] {
        let program = hidden.compile(&["x"]).expect("x is the only variable");
        assert!(program.evaluate(&[0.0]).is_nan(), "{hidden}");
    }
    let folded = (constant(0.0) / 0.0).max(2.0) + variable("x");
    assert!(folded.compile(&["x"]).expect("x is the only variable").evaluate(&[1.0]).is_nan());
}

#[test]
fn of_two_zeros_the_left_one_is_taken() {
    let [x, y] = [variable("x"), variable("y")];
    for extremum in [x.min(&y), x.max(&y)] {
        let program = extremum.compile(&["x", "y"]).expect("both are listed");
        assert!(program.evaluate(&[0.0, -0.0]).is_sign_positive(), "{extremum}");
        assert!(program.evaluate(&[-0.0, 0.0]).is_sign_negative(), "{extremum}");
    }
}

#[test]
fn variables_that_are_missing_are_named() {
    let unknown = |variable: &str| EvaluationError::UnknownVariable { variable: variable.into() };
    let guard = (variable("x") + variable("w")).at_most(1.0);
    assert_eq!(guard.compile(&["x", "y"]), Err(unknown("w")));
    let guard = guard.compile(&["x", "w"]).expect("both are listed");
    assert_eq!(guard.evaluate(&[1.0]), Err(unknown("w")));
    assert_eq!(guard.evaluate_at(&[1.0], &[0, 7]), Err(unknown("w")));
}

#[test]
fn of_a_name_that_is_listed_twice_the_first_place_counts() {
    let program = variable("x").compile(&["x", "x"]).expect("x is listed");
    assert_eq!(program.evaluate(&[1.0, 2.0]), 1.0);
    let guard: Predicate = (variable("x") / variable("x")).at_most(1.0);
    let guard = guard.compile(&["x", "x"]).expect("x is listed");
    assert!(guard.evaluate(&[0.0, 2.0]).is_err());
}

#[test]
fn functions_see_the_slice_under_the_listed_names() {
    let near = Predicate::function("near", |state| {
        Ok(2.0 - (variable("x") - variable("y")).evaluate(state)?)
    });
    let guard = near.and(variable("x").at_least(0.0)).compile(&["y", "x"]).expect("x is listed");
    assert!(guard.variables().eq(["y", "x"]));
    let verdict = |margin, holds| Ok(Verdict { margin, holds });
    assert_eq!(guard.evaluate(&[1.0, 2.5]), verdict(0.5, true));
    assert_eq!(guard.evaluate_at(&[1.0, 2.0, 4.0], &[0, 2]), verdict(-1.0, false));
    let error = EvaluationError::UnknownVariable { variable: "y".into() };
    let blind = guard.predicate().compile(&["x"]).expect("what a function reads is not known");
    assert_eq!(blind.evaluate(&[1.0]), Err(error));
}

/// Equal with the signs of zeros, or both not a number.
fn same(left: f64, right: f64) -> bool {
    left.to_bits() == right.to_bits() || (left.is_nan() && right.is_nan())
}

/// Values on a coarse grid, so that boundaries and undefined parts are hit, and off it.
fn values() -> impl Strategy<Value = [f64; 3]> {
    let numbers = || {
        prop_oneof![
            4 => (-8i8..=8).prop_map(|quarters| f64::from(quarters) / 4.0),
            4 => -10.0..10.0,
            1 => prop::sample::select(vec![-0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]),
        ]
    };
    [numbers(), numbers(), numbers()]
}

fn state(values: [f64; 3]) -> [(&'static str, f64); 3] {
    let [delta, x, y] = values;
    [("δ", delta), ("x", x), ("y", y)]
}
