//! Tangents, angles, jumps, choices and tables: values, enclosures, derivatives and text.

use std::f64::consts::FRAC_PI_2;

use pleach_guards::{
    Course, Enclosure, Expression, Interval, InvalidTable, Predicate, Table, constant, maximum,
    minimum, piecewise, variable,
};

fn at(expression: &Expression, x: f64) -> f64 {
    expression.evaluate(&[("x", x)]).expect("a value")
}

/// Formulas of x that are smooth but at some places.
fn formulas() -> Vec<Expression> {
    let x = variable("x");
    let table = Table::linear([(-1.0, 2.0), (0.5, -1.0), (2.0, 0.25)]).expect("ascending");
    let steps = Table::steps([(-1.0, 2.0), (0.5, -1.0), (2.0, 0.25)]).expect("ascending");
    let choice = piecewise([(x.at_least(0.3) & x.less_than(1.0), x.power(3.0))], x.sin());
    vec![
        x.tan(),
        (2.0 * &x).tanh(),
        x.sign() * x.power(2.0),
        x.floor() * &x,
        x.atan2(&x - 0.7),
        (&x - 0.2).atan2(2.0),
        table.at(&x * 1.5),
        steps.at(&x) * &x,
        choice.expect("comparisons only"),
        minimum([x.sin(), x.cos(), constant(0.25)]),
        maximum([x.sin(), x.cos(), constant(0.25)]),
    ]
}

#[test]
fn derivatives_are_limits_of_differences() {
    for formula in formulas() {
        let derivative = formula.derivative("x");
        for step in -37..37 {
            let (x, reach) = (0.061 * f64::from(step) + 0.003, 1e-6);
            let found = derivative.evaluate(&[("x", x)]).expect("no kink is met");
            let expected = (at(&formula, x + reach) - at(&formula, x - reach)) / (2.0 * reach);
            let size = expected.abs().max(1.0);
            assert!(
                (found - expected).abs() < 1e-5 * size,
                "{formula} at {x}: {found}, {expected}"
            );
        }
    }
}

/// A jump is no number in the derivative at the jump, and anything in an interval around it.
#[test]
fn derivatives_hide_no_jump() {
    let x = variable("x");
    let steps = Table::steps([(0.0, 1.0), (1.0, 5.0)]).expect("ascending");
    let choice = piecewise([(x.at_least(0.0), constant(5.0))], 1.0).expect("a comparison");
    for jumping in [x.sign(), x.floor(), steps.at(&x), choice] {
        let derivative = jumping.derivative("x");
        assert!(derivative.evaluate(&[("x", 0.0)]).is_err(), "{derivative}");
        assert_eq!(derivative.evaluate(&[("x", 0.25)]), Ok(0.0), "{derivative}");
        let around = Interval::new(-0.5, 0.5).expect("in order");
        assert_eq!(derivative.range(&[("x", around)]), Ok(Interval::WHOLE), "{derivative}");
    }
}

/// What jumps from one end of the numbers to the other at a pole does not rise or fall there.
#[test]
fn poles_hide_behind_no_slope() {
    let x = variable("x");
    let around = Enclosure {
        middle: Interval::point(0.25),
        range: Interval::new(-0.75, 1.25).expect("in order"),
        rate: Interval::point(1.0),
    };
    let poles = [x.power(-1.0), x.power(-3.0), -x.power(-5.0), 1.0 / &x, (&x + FRAC_PI_2).tan()];
    for pole in poles {
        for guard in [pole.at_least(10.0), pole.at_most(-10.0)] {
            let tracker = guard.track(&["x"]).expect("x is the only variable");
            let course = tracker.course(&[around], &[0], 1.0, 0.0, &|_| None);
            assert_eq!(course, Course::Open, "{guard}");
        }
    }
}

#[test]
fn ranges_enclose_values_and_shrink_to_them() {
    for formula in formulas() {
        for step in -50..50 {
            let lower = 0.043 * f64::from(step) + 0.0007;
            for width in [0.5, 1e-3, 0.0] {
                let box_of_x = Interval::new(lower, lower + width).expect("in order");
                let range = formula.range(&[("x", box_of_x)]).expect("it has values");
                for part in 0..=8 {
                    let x = lower + width * f64::from(part) / 8.0;
                    assert!(range.contains(at(&formula, x)), "{formula} at {x}: {range}");
                }
                assert!(width > 0.0 || range.width() < 1e-12, "{formula} at {lower}: {range}");
            }
        }
    }
}

#[test]
fn text_reads_back() {
    for formula in formulas() {
        let text = formula.to_string();
        assert_eq!(text.parse::<Expression>().as_ref(), Ok(&formula), "{text}");
        let derivative = formula.derivative("x");
        assert_eq!(derivative.to_string().parse::<Expression>(), Ok(derivative), "{text}");
    }
    let guard: Predicate = "(if(x < 0, min(1, 2, 3), 2) + 1) <= 4 and (x > 1 or x < 0)"
        .parse()
        .expect("a conjunction");
    assert_eq!(guard.to_string(), "if(x < 0, min(1, 2, 3), 2) + 1 ≤ 4 ∧ (x > 1 ∨ x < 0)");
    assert_eq!(
        variable("x").floor().atan2(variable("x").sign()).to_latex(),
        r"\operatorname{atan2}\left(\left\lfloor x\right\rfloor , \operatorname{sign}\left(x\right)\right)"
    );
    let choice = piecewise([(variable("x").less_than(0.0), constant(1.0))], variable("x"));
    let latex = r"\begin{cases}1 & \text{if } x < 0 \\ x & \text{otherwise}\end{cases}";
    assert_eq!(choice.map(|choice| choice.to_latex()).as_deref(), Some(latex));
    for wrong in ["linear(x)", "steps((1, 2), (1, 3), x)", "if(x, 1, 2)", "atan2(x)", "sec(x)"] {
        assert!(wrong.parse::<Expression>().is_err(), "{wrong}");
    }
}

#[test]
fn what_is_not_chosen_needs_no_value() {
    let x = variable("x");
    let safe = piecewise([(x.more_than(0.0), x.ln())], -1.0).expect("a comparison");
    let program = safe.compile(&["x"]).expect("x is the only variable");
    for (place, expected) in [(1.0, 0.0), (-1.0, -1.0)] {
        assert_eq!(safe.evaluate(&[("x", place)]), Ok(expected));
        assert_eq!(program.evaluate(&[place]), expected);
    }
    let negative = Interval::new(-2.0, -1.0).expect("in order");
    assert_eq!(safe.range(&[("x", negative)]), Ok(Interval::point(-1.0)));
    let opaque = Predicate::function("opaque", |_| Ok(1.0));
    assert_eq!(piecewise([(opaque, constant(1.0))], 2.0), None);
}

#[test]
fn tables_say_what_is_wrong_with_their_points() {
    assert_eq!(Table::linear([]), Err(InvalidTable::Empty));
    let twice = Table::linear([(0.0, 1.0), (0.0, 2.0)]).expect_err("one place twice");
    assert!(twice.to_string().contains("point 1 of a table is at 0, which is not after 0"));
    assert!(Table::steps([(f64::NAN, 1.0)]).is_err());
    for apart in [[(-1.7e308, 0.0), (1.7e308, 1.0)], [(0.0, -1.7e308), (1.0, 1.7e308)]] {
        assert_eq!(Table::linear(apart), Err(InvalidTable::TooFarApart { index: 1 }));
    }
    let table = Table::linear([(0.0, 1.0), (2.0, 3.0)]).expect("ascending").at(variable("x"));
    for (place, value) in [(-1.0, 1.0), (0.0, 1.0), (1.0, 2.0), (2.0, 3.0), (9.0, 3.0)] {
        assert_eq!(at(&table, place), value);
    }
}

#[test]
fn piecewise_formulas_are_resolved_by_cases() {
    for formula in formulas() {
        let predicate = formula.at_most(0.375);
        let Ok(cases) = predicate.by_cases(64) else { continue };
        for step in -50..50 {
            let state = [("x", 0.043 * f64::from(step) + 0.001)];
            assert_eq!(cases.holds(&state), predicate.holds(&state), "{predicate} at {state:?}");
        }
    }
}
