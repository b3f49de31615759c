//! What the analyses of expressions and predicates say, against values at sampled states.

use std::collections::BTreeMap;

use crate::common::{expressions, predicates};
use pleach_guards::{
    Expression, Interval, LinearForm, NoDisjunctiveForm, Predicate, Relation, Substitution, Truth,
    constant, never, not, variable,
};
use proptest::prelude::*;

const NAMES: [&str; 3] = ["x", "y", "δ"];

type State = [(&'static str, f64); 3];

proptest! {
    #![proptest_config(cases::usually(1024))]

    #[test]
    fn ranges_enclose_values(expression in expressions(), samples in samples()) {
        let (region, states) = samples;
        let range = expression.range(&region);
        for state in states {
            if let Ok(value) = expression.evaluate(&state) {
                let inside = range.as_ref().is_ok_and(|range| range.contains(value));
                prop_assert!(inside, "{expression} is {value} in {state:?}, not in {range:?}");
            }
        }
    }

    #[test]
    fn truth_agrees_with_verdicts(predicate in predicates(), samples in samples()) {
        let (region, states) = samples;
        let truth = predicate.truth(&region);
        for state in states {
            match (&truth, predicate.holds(&state)) {
                (Err(_), Ok(_)) | (Ok(Truth::Always), Ok(false)) | (Ok(Truth::Never), Ok(true)) => {
                    prop_assert!(false, "{predicate} is not {truth:?}: see {state:?}");
                }
                _ => {}
            }
        }
    }

    #[test]
    fn linear_forms_have_the_value_of_the_expression(
        expression in affine_expressions(),
        state in states(-8.0..8.0),
    ) {
        let form = expression.linear_form().expect("built affine");
        let (value, expected) = (form.evaluate(&state)?, expression.evaluate(&state)?);
        let scale = size(&form, &state);
        prop_assert!((value - expected).abs() <= 1e-9 * scale, "{expression}: {form:?}");
    }

    #[test]
    fn derivatives_are_limits_of_difference_quotients(
        expression in expressions(),
        state in states(-3.0..3.0),
        name in prop::sample::select(NAMES.to_vec()),
    ) {
        let along = |step: f64| {
            let moved = state.map(|(other, value)| {
                (other, if other == name { value + step } else { value })
            });
            expression.evaluate(&moved).ok().filter(|value| value.abs() < 1e6)
        };
        let quotient = |step: f64| Some((along(step)? - along(-step)?) / (2.0 * step));
        // A kink, a pole or a steep slope shows in quotients that have not settled.
        if let (Some(coarse), Some(fine)) = (quotient(2e-5), quotient(1e-5))
            && (coarse - fine).abs() <= 1e-7 * (1.0 + fine.abs())
            && let Ok(exact) = expression.derivative(name).evaluate(&state)
        {
            let tolerance = 1e-5 * (1.0 + fine.abs());
            prop_assert!((exact - fine).abs() <= tolerance, "{expression}: {exact} and {fine}");
        }
    }

    #[test]
    fn minima_and_maxima_change_as_the_operand_that_they_are(
        (one, other) in (expressions(), expressions()),
        state in states(-3.0..3.0),
    ) {
        let slope = |expression: &Expression| expression.derivative("x").evaluate(&state);
        if let (Ok(value), Ok(beside)) = (one.evaluate(&state), other.evaluate(&state))
            && let (Ok(least), Ok(most)) = (slope(&one.min(&other)), slope(&one.max(&other)))
            && let (Ok(first), Ok(second)) = (slope(&one), slope(&other))
        {
            let (lower, upper) = if value < beside { (first, second) } else { (second, first) };
            let near = |found: f64, slope: f64| {
                (found - slope).abs() <= 1e-12 * (first.abs() + second.abs())
            };
            prop_assert!(near(least, lower), "min({one}, {other}): {least}, not {lower}");
            prop_assert!(near(most, upper), "max({one}, {other}): {most}, not {upper}");
        }
    }

    #[test]
    fn substitution_is_evaluation_in_the_changed_state(
        predicate in predicates(),
        (first, last) in (expressions(), expressions()),
        state in states(-3.0..3.0),
    ) {
        let reset = Substitution::new([("x", first.clone()), ("y", last.clone())]);
        if let (Ok(x), Ok(y)) = (first.evaluate(&state), last.evaluate(&state)) {
            let after = [("x", x), ("y", y), state[2]];
            let found = predicate.substitute(&reset).evaluate(&state);
            prop_assert_eq!(found.ok(), predicate.evaluate(&after).ok());
        }
    }

    #[test]
    fn negations_resolve_without_a_change(predicate in predicates(), state in grid()) {
        let resolved = predicate.negation_normal_form();
        prop_assert!(!resolved.to_string().contains('¬'), "{resolved}");
        prop_assert_eq!(resolved.evaluate(&state).ok(), predicate.evaluate(&state).ok());
    }

    #[test]
    fn disjunctive_forms_hold_where_the_predicate_does(predicate in predicates(), state in grid()) {
        let form = predicate.disjunctive_form(1000).expect("these predicates are small");
        if let Ok(holds) = predicate.holds(&state) {
            let in_form = form.iter().any(|conjunction| {
                conjunction.iter().all(|part| part.evaluate(&state).is_ok_and(|part| part.holds))
            });
            prop_assert_eq!(in_form, holds);
        }
    }

    #[test]
    fn cases_hold_where_the_predicate_does(predicate in predicates(), state in grid()) {
        if let (Ok(cases), Ok(holds)) = (predicate.by_cases(64), predicate.holds(&state)) {
            for piece in ["|", "min", "max"] {
                prop_assert!(!cases.to_string().contains(piece), "{cases}");
            }
            // Division by a piece that is 0 depends on the sign of the zero.
            let divides = ['÷', '⁻', '^'].iter().any(|sign| cases.to_string().contains(*sign));
            if let (Ok(found), false) = (cases.holds(&state), divides) {
                prop_assert_eq!(found, holds, "{}", cases);
            }
        }
    }
}

#[test]
fn arithmetic_on_whole_numbers_is_exact() {
    let over = |lower, upper| Interval::new(lower, upper).expect("these ends are in order");
    let region = [("x", over(-1.0, 2.0)), ("y", over(1.0, 4.0)), ("δ", Interval::WHOLE)];
    let [x, y, delta] = NAMES.map(variable);
    let cases = [
        (&x + &y, over(0.0, 6.0)),
        (2.0 * &x - &y / 2.0, over(-4.0, 3.5)),
        (x.power(2.0), over(0.0, 4.0)),
        (&x * &x, over(0.0, 4.0)),
        (y.power(2.0), over(1.0, 16.0)),
        (&y * &y, over(1.0, 16.0)),
        (&x * &y, over(-4.0, 8.0)),
        (y.square_root(), over(1.0, 2.0)),
        (x.square_root(), over(0.0, 2f64.sqrt())),
        (x.abs().max(&y), over(1.0, 4.0)),
        (x.min(&y), over(-1.0, 2.0)),
        (&y / &x, Interval::WHOLE),
        (delta.power(2.0), over(0.0, f64::INFINITY)),
        (1.0 / (delta.abs() + 1.0), over(0.0, 1.0)),
        (delta.sin(), over(-1.0, 1.0)),
        (delta.exp(), over(0.0, f64::INFINITY)),
    ];
    for (expression, expected) in cases {
        assert_eq!(expression.range(&region), Ok(expected), "{expression}");
    }
}

#[test]
fn boxes_are_seen_through_names() {
    let over = |lower, upper| Interval::new(lower, upper).expect("these ends are in order");
    let (first, other) = (over(0.0, 1.0), over(2.0, 3.0));
    let pairs = [("x", first), ("y", other), ("x", other)];
    let named = BTreeMap::from([("x".to_owned(), first), ("y".to_owned(), other)]);
    for (name, expected) in [("x", Some(first)), ("y", Some(other)), ("z", None)] {
        assert_eq!(variable(name).range(&pairs).ok(), expected);
        assert_eq!(variable(name).range(&&pairs).ok(), expected);
        assert_eq!(variable(name).range(pairs.as_slice()).ok(), expected);
        assert_eq!(variable(name).range(&named).ok(), expected);
    }
}

/// In the unit box, x ≤ 1 always holds, x > 1 and x ≤ −1 never, x ≤ 0 in a corner and x ≤ y in a
/// half.
#[test]
fn the_truth_of_parts_decides_where_it_can() {
    let unit = Interval::new(0.0, 1.0).expect("these ends are in order");
    let region = [("x", unit), ("y", unit)];
    let parts = [
        (variable("x").at_most(1.0), Truth::Always),
        (variable("x").more_than(1.0), Truth::Never),
        (variable("x").at_most(-1.0), Truth::Never),
        (variable("x").at_most(0.0), Truth::Undecided),
        (variable("x").at_most(variable("y")), Truth::Undecided),
    ];
    for (one, first) in &parts {
        assert_eq!(one.truth(&region), Ok(*first));
        for (other, second) in &parts {
            let both = [first, second];
            let expected = |settling: Truth, otherwise: Truth| {
                if both.contains(&&settling) {
                    settling
                } else if both.contains(&&Truth::Undecided) {
                    Truth::Undecided
                } else {
                    otherwise
                }
            };
            let conjunction = expected(Truth::Never, Truth::Always);
            assert_eq!(one.clone().and(other.clone()).truth(&region), Ok(conjunction));
            let disjunction = expected(Truth::Always, Truth::Never);
            assert_eq!(one.clone().or(other.clone()).truth(&region), Ok(disjunction));
        }
    }
}

#[test]
fn waves_know_their_crests() {
    let over = |lower, upper| Interval::new(lower, upper).expect("these ends are in order");
    assert_eq!(over(1.0, 2.0).sin().upper(), 1.0);
    assert!(over(2.0, 4.0).sin().upper() < 0.91);
    assert_eq!(over(4.0, 5.0).sin().lower(), -1.0);
    assert_eq!(over(-0.5, 0.5).cos().upper(), 1.0);
    assert_eq!(over(99.0, 101.0).cos().upper(), 1.0);
    assert!(over(101.0, 102.0).cos().upper() < 0.9);
    let infinity = f64::INFINITY;
    let long = [over(0.0, 6.5), over(1.0, infinity), over(-infinity, 1.0), over(1e300, 1e300)];
    for angles in [long.as_slice(), &[Interval::WHOLE, Interval::point(infinity)]].concat() {
        assert_eq!([angles.sin(), angles.cos()], [over(-1.0, 1.0); 2], "{angles}");
    }
    assert!((over(1.0, 2.0).sin().lower() - 1f64.sin()).abs() < 1e-12);
    assert!((over(1.0, 2.0).cos().lower() - 2f64.cos()).abs() < 1e-12);
    assert!((over(1.0, 2.0).cos().upper() - 1f64.cos()).abs() < 1e-12);
}

#[test]
fn what_has_no_value_anywhere_is_an_error() {
    let negative = [("x", Interval::new(-2.0, -1.0).expect("these ends are in order"))];
    assert!(variable("x").ln().range(&negative).is_err());
    assert!(variable("x").square_root().at_most(1.0).truth(&negative).is_err());
    assert!(variable("y").range(&negative).is_err());
    assert!(constant(f64::NAN).range(&negative).is_err());
}

#[test]
fn functions_are_undecided_and_have_no_normal_form() {
    let near = Predicate::function("near", |state| variable("x").evaluate(state));
    let region = [("x", Interval::WHOLE)];
    assert_eq!(near.truth(&region), Ok(Truth::Undecided));
    let error = NoDisjunctiveForm::Function { name: "near".into() };
    assert_eq!(not(near.clone()).disjunctive_form(9), Err(error));

    let halved = near.substitute(&Substitution::new([("x", variable("y") / 2.0 - 1.0)]));
    assert_eq!(halved.margin(&[("y", 4.0)]), Ok(1.0));
    assert!(halved.margin(&[("x", 4.0)]).is_err());
}

#[test]
fn names_are_exchanged_at_once() {
    let [x, y, delta] = NAMES.map(variable);
    let exchange = Substitution::renaming([("x", "y"), ("y", "x")]);
    assert_eq!((&x - &y * &delta).substitute(&exchange), &y - &x * &delta);
    assert_eq!([exchange.replacement("x"), exchange.replacement("δ")], [Some(&y), None]);
}

#[test]
fn negations_of_functions_stay() {
    let near = Predicate::function("near", |state| variable("x").evaluate(state));
    let apart = not(near.clone().and(variable("x").at_most(1.0)));
    assert_eq!(apart.negation_normal_form().to_string(), "¬near(…) ∨ x > 1");
    assert_eq!(not(not(near.clone())).negation_normal_form(), near);
}

#[test]
fn forms_are_as_large_as_allowed_and_no_larger() {
    let [x, y, _] = NAMES.map(variable);
    let outside = |a: &Expression| a.at_most(0.0).or(a.at_least(1.0));
    let corners = outside(&x).and(outside(&y));
    assert_eq!(corners.disjunctive_form(4).map(|form| form.len()), Ok(4));
    let error = NoDisjunctiveForm::TooLarge { limit: 3 };
    assert_eq!(corners.disjunctive_form(3), Err(error.clone()));
    assert_eq!(outside(&x).or(corners.clone()).disjunctive_form(5).ok(), None);
    // What grows on the way counts, too.
    assert_eq!(corners.and(never()).disjunctive_form(3), Err(error.clone()));
    assert_eq!(error.to_string(), "the normal form has more than the 3 parts allowed");
    let error = NoDisjunctiveForm::Function { name: "near".into() };
    assert_eq!(error.to_string(), "the function `near` is not made of comparisons");

    let close = x.abs().max(&y).at_most(1.0);
    assert!(close.by_cases(4).is_ok() && close.by_cases(3).is_err());
}

#[test]
fn strict_relations_exclude_equal_numbers() {
    use Relation::{AtLeast, AtMost, LessThan, MoreThan};
    let relations = [AtMost, LessThan, AtLeast, MoreThan];
    assert_eq!(relations.map(Relation::is_strict), [false, true, false, true]);
    assert_eq!(relations.map(Relation::opposite), [MoreThan, AtLeast, LessThan, AtMost]);
}

/// Terms that are 0 and factors that are 1 are left out.
#[test]
fn derivatives_are_short() {
    let [x, y, _] = NAMES.map(variable);
    let cases = [
        (constant(3.0), "0"),
        (&x + &y, "1"),
        (&y + &x, "1"),
        (&y - &x, "−1"),
        (-&y, "0"),
        (-&x * &y, "−1 · y"),
        (&x * 2.0, "2"),
        (2.0 * &x, "2"),
        (&y * &x, "y"),
        (&x * &x, "x + x"),
        (&x / 2.0, "1 ÷ 2"),
        (&y / 2.0, "0"),
        (&x * &y / 1.0, "y"),
        (&y / &x, "(−y) ÷ x²"),
        (x.power(0.0), "0"),
        (y.power(3.0), "0"),
        (x.power(1.0), "1"),
        (x.power(2.0), "2 · x"),
        (x.power(3.0), "3 · x²"),
        (x.sin() * y.cos(), "cos(x) · cos(y)"),
        (-x.cos(), "−(−sin(x))"),
        (x.ln() + x.exp(), "1 ÷ x + exp(x)"),
        (x.abs(), "x ÷ |x|"),
        ((&x + 1.0).min(&x), "1"),
        (y.max(1.0), "0"),
    ];
    for (expression, expected) in cases {
        assert_eq!(expression.derivative("x").to_string(), expected, "{expression}");
    }
}

#[test]
fn what_is_not_affine_has_no_linear_form() {
    let [x, y, _] = NAMES.map(variable);
    for expression in
        [&x * &y, 1.0 / &x, x.abs(), x.min(1.0), x.power(2.0), &x / 0.0, &x * 1e308 * 10.0]
    {
        assert_eq!(expression.linear_form(), None, "{expression}");
    }
    let form = (constant(4.0).square_root() * &x - &x * 2.0).linear_form().expect("it is affine");
    assert_eq!((form.coefficients().count(), form.constant()), (0, &0.0));
    let form = (x.power(1.0) * 3.0 - &y - &y).linear_form().expect("it is affine");
    let found = ["x", "y", "z"].map(|name| form.coefficient(name).copied());
    assert_eq!(found, [Some(3.0), Some(-2.0), None]);
    assert!(form.coefficients().eq([("x", &3.0), ("y", &-2.0)]));
}

/// A box and some states in it, its corners among them.
fn samples() -> impl Strategy<Value = ([(&'static str, Interval); 3], Vec<State>)> {
    let end = || {
        prop_oneof![
            3 => (-8i8..=8).prop_map(|halves| f64::from(halves) / 2.0),
            3 => -10.0..10.0,
            1 => prop::sample::select(vec![f64::NEG_INFINITY, f64::INFINITY, 1e200, -1e-200]),
        ]
    };
    let range = || {
        (end(), end())
            .prop_map(|(a, b)| Interval::new(a.min(b), a.max(b)).expect("these ends are in order"))
    };
    let share = prop_oneof![2 => Just(0.0), 2 => Just(1.0), 6 => 0.0..=1.0];
    let shares = prop::collection::vec([share.clone(), share.clone(), share], 8);
    ([range(), range(), range()], shares).prop_map(|(ranges, shares)| {
        let place = |range: &Interval, share: f64| {
            let (lower, upper) = (range.lower().max(-1e300), range.upper().min(1e300));
            let inside = lower + share * (upper - lower);
            if share == 0.0 { range.lower() } else { inside.clamp(range.lower(), range.upper()) }
        };
        let states = shares
            .iter()
            .map(|shares| [0, 1, 2].map(|axis| (NAMES[axis], place(&ranges[axis], shares[axis]))));
        ([0, 1, 2].map(|axis| (NAMES[axis], ranges[axis])), states.collect())
    })
}

fn states(numbers: std::ops::Range<f64>) -> impl Strategy<Value = State> {
    [numbers.clone(), numbers.clone(), numbers]
        .prop_map(|[x, y, delta]| [("x", x), ("y", y), ("δ", delta)])
}

/// States on a coarse grid, so that boundaries are hit.
fn grid() -> impl Strategy<Value = State> {
    let numbers = || (-8i8..=8).prop_map(|quarters| f64::from(quarters) / 4.0);
    [numbers(), numbers(), numbers()].prop_map(|[x, y, delta]| [("x", x), ("y", y), ("δ", delta)])
}

fn affine_expressions() -> impl Strategy<Value = Expression> {
    let numbers = || prop_oneof![Just(1.0), Just(-0.5), 0.1..9.0];
    let leaf = prop_oneof![
        prop::sample::select(NAMES.to_vec()).prop_map(variable),
        numbers().prop_map(constant),
    ];
    leaf.prop_recursive(4, 16, 2, move |inner| {
        let factors = (inner.clone(), numbers());
        prop_oneof![
            inner.clone().prop_map(|a| -a),
            factors.clone().prop_map(|(a, factor)| a * factor),
            factors.clone().prop_map(|(a, factor)| factor * a),
            factors.prop_map(|(a, divisor)| a / constant(divisor).abs().square_root()),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| a + b),
            (inner.clone(), inner).prop_map(|(a, b)| a - b),
        ]
    })
}

/// The sum of the magnitudes of the terms, and 1.
fn size(form: &LinearForm, state: &State) -> f64 {
    let terms = state.iter().filter_map(|(name, value)| Some(form.coefficient(name)? * value));
    1.0 + form.constant().abs() + terms.map(f64::abs).sum::<f64>()
}
