//! Expressions as deep as memory allows.

use pleach_guards::{Expression, Interval, Substitution, constant, variable};

/// Deep enough to exhaust the stack of a test's thread many times over.
const DEPTH: usize = 100_000;

/// x + 1 + 1 + …, grouped to the left.
fn leftward() -> Expression {
    (0..DEPTH).fold(variable("x"), |sum, _| sum + 1.0)
}

/// 1 + (1 + (… + x)).
fn rightward() -> Expression {
    (0..DEPTH).fold(variable("x"), |sum, _| 1.0 + sum)
}

/// −(−(… x)).
fn opposites() -> Expression {
    (0..DEPTH).fold(variable("x"), |inner, _| -inner)
}

#[test]
fn deep_expressions_are_evaluated_and_compiled() {
    let state = [("x", 0.5)];
    for (deep, expected) in
        [(leftward(), DEPTH as f64 + 0.5), (rightward(), DEPTH as f64 + 0.5), (opposites(), 0.5)]
    {
        assert_eq!(deep.evaluate(&state), Ok(expected));
        let program = deep.compile(&["x"]).expect("x is the only variable");
        assert_eq!(program.evaluate(&[0.5]), expected);
        assert!(deep.evaluate(&()).is_err());
        assert!(deep.evaluate(&[("x", f64::NAN)]).is_err());
    }
}

#[test]
fn deep_expressions_are_printed_and_compared() {
    let text = leftward().to_string();
    assert!(text.starts_with("x + 1 + 1") && text.len() == 1 + 4 * DEPTH);
    assert!(rightward().to_latex().contains(r"1 + x\right)\right)"));
    assert_eq!(format!("{:?}", opposites()).chars().filter(|letter| *letter == '−').count(), DEPTH);
    assert_eq!(leftward(), leftward());
    assert_ne!(leftward(), rightward());
    assert!(leftward().at_most(1.0).to_string().ends_with("+ 1 ≤ 1"));
}

#[test]
fn deep_expressions_are_analysed() {
    let unit = Interval::new(0.0, 1.0).expect("in order");
    for deep in [leftward(), rightward()] {
        assert!(deep.variables().into_iter().eq(["x"]));
        let range = deep.range(&[("x", unit)]).expect("sums have values");
        assert!(range.contains(DEPTH as f64) && range.width() < 1.1);
        assert_eq!(deep.derivative("x"), constant(1.0));
        let form = deep.linear_form().expect("sums are affine");
        assert_eq!((form.coefficient("x"), *form.constant()), (Some(&1.0), DEPTH as f64));
        let moved = deep.substitute(&Substitution::new([("x", constant(1.0))]));
        assert_eq!(moved.evaluate(&()), Ok(DEPTH as f64 + 1.0));
        let cases = (deep.abs()).at_most(2.0).by_cases(2).expect("two cases");
        assert_eq!(cases.holds(&[("x", 0.0)]), Ok(false));
    }
}
