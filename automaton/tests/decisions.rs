//! Decisions about predicates, against what is known of them and against brute-force sampling.

use std::collections::BTreeMap;

use pleach_automaton::decision::{Decision, Doubt, Effort, Proof, Region, State, decide};
use pleach_guards::{
    Expression, Interval, Predicate, always, constant, never, norm, not, variable,
};
use proptest::prelude::*;

#[test]
fn guards_that_touch_meet_in_a_point_or_nowhere() {
    let x = variable("x");
    for (predicate, expected) in [
        (x.at_most(1.0) & x.at_least(1.0), Some(1.0)),
        (x.less_than(1.0) & x.at_least(1.0), None),
        (x.at_most(1.0) & x.more_than(1.0), None),
        (not(x.at_most(1.0)) & not(x.more_than(1.0)), None),
        (x.equals_within(3.0, 0.0), Some(3.0)),
        ((3.0 * &x).at_most(1.0) & (3.0 * &x).at_least(1.0), Some(1.0 / 3.0)),
        (x.at_most(-100.0), Some(-100.0)),
        (x.less_than(-100.0), None),
        (x.abs().max(2.0).at_most(2.0) & x.at_least(2.0), Some(2.0)),
    ] {
        let decision = decided(&predicate, &[("x", -100.0, 100.0)]);
        match (expected, &decision) {
            (Some(x), Decision::Witness(witness)) => assert_eq!(witness["x"], x, "{predicate}"),
            (None, Decision::Impossible(_)) => {}
            _ => panic!("{predicate}: {decision}"),
        }
    }
}

#[test]
fn linear_predicates_are_decided_without_bounds() {
    let everywhere = |name| (name, f64::NEG_INFINITY, f64::INFINITY);
    let region = [everywhere("x"), everywhere("y"), ("z", 0.0, f64::INFINITY)];
    let [x, y, z] = ["x", "y", "z"].map(variable);
    let witnessed = [
        (&x + &y).at_least(1e6) & (&x - &y).at_most(-3.0) & z.more_than(&x),
        (&x - &y).abs().at_least(4.0) & x.min(&y).at_least(2.0),
        always(),
    ];
    for predicate in witnessed {
        let decision = decided(&predicate, &region);
        assert!(matches!(decision, Decision::Witness(_)), "{predicate}: {decision}");
    }
    let impossible = [
        (&x - &y).less_than(0.0) & (&y - &z).less_than(0.0) & (&z - &x).less_than(0.0),
        (0.1 * &x + 0.2 * &y).at_most(1.0) & (0.3 * &x + 0.6 * &y).more_than(3.0 + 1e-9),
        (&x + &z).less_than(&x),
        (&x - &y).abs().less_than(&z) & (&x - &y).more_than(2.0) & z.at_most(2.0),
    ];
    for predicate in impossible {
        let decision = decided(&predicate, &region);
        assert_eq!(decision, Decision::Impossible(Proof::Linear), "{predicate}");
    }
}

#[test]
fn curves_are_decided_by_search() {
    let [x, y] = ["x", "y"].map(variable);
    let disk = norm([x.clone(), y.clone()]).at_most(1.0);
    let round = (x.power(2.0) + y.power(2.0)).at_most(1.0);
    for (predicate, holds) in [
        (disk.clone() & (&x + &y).at_least(1.4), true),
        (disk & (&x + &y).at_least(1.5), false),
        (round.clone() & (&x + &y).at_least(1.5), false),
        (round & (&x * &y).more_than(0.51), false),
        (x.sin().at_least(0.999) & x.at_least(2.0), true),
        (x.sin().at_least(0.5) & x.at_least(3.0) & x.at_most(6.0), false),
        (x.exp().at_most(&x + 0.9), false),
        (x.exp().at_most(&x + 1.1), true),
        (x.ln().at_least(0.01) & x.less_than(1.0), false),
        (x.square_root().at_least(2.0) & (&x * &y).at_least(30.0) & y.at_most(4.0), true),
        ((1.0 / &x).more_than(0.0) & x.less_than(-0.1), false),
    ] {
        let decision = decided(&predicate, &[("x", -10.0, 10.0), ("y", -10.0, 10.0)]);
        let found = match decision {
            Decision::Witness(_) => Some(true),
            Decision::Impossible(_) => Some(false),
            Decision::Undecided(_) => None,
        };
        assert_eq!(found, Some(holds), "{predicate}: {decision}");
    }
}

#[test]
fn boundless_regions_are_searched_too() {
    let [x, y] = ["x", "y"].map(variable);
    let everywhere = [("x", f64::NEG_INFINITY, f64::INFINITY), ("y", 0.0, f64::INFINITY)];
    let round = (x.power(2.0) + y.power(2.0)).at_most(1.0);
    let decision = decided(&(round & (&x + &y).at_least(1.5)), &everywhere);
    assert!(matches!(decision, Decision::Impossible(Proof::Intervals { .. })), "{decision}");
    let far = (&x * &y).at_least(1e6) & x.at_most(200.0);
    assert!(matches!(decided(&far, &everywhere), Decision::Witness(_)));
}

#[test]
fn what_cannot_be_decided_says_so() {
    let x = variable("x");
    // x² = 2 has no solution in floating point, and intervals cannot see that.
    let root = x.power(2.0).at_most(2.0) & x.power(2.0).at_least(2.0);
    match decided(&root, &[("x", 0.0, 2.0)]) {
        Decision::Undecided(Doubt::Remainder { region, resolution }) => {
            assert!(region["x"].contains(2f64.sqrt()), "{}", region["x"]);
            assert!(resolution <= 1e-6, "{resolution}");
        }
        other => panic!("{other}"),
    }
    // The logarithm of what is just below 1 is known only up to rounding.
    let touching = x.ln().at_least(0.0) & x.less_than(1.0);
    let decision = decided(&touching, &[("x", 0.0, 2.0)]);
    assert!(matches!(decision, Decision::Undecided(Doubt::Remainder { .. })), "{decision}");
}

#[test]
fn functions_are_evaluated_but_not_believed() {
    let x = variable("x");
    let odd = |limit: f64| {
        Predicate::function("odd", move |state| Ok(variable("x").evaluate(state)?.abs() - limit))
    };
    let region = [("x", -4.0, 4.0)];
    let impossible = odd(1.0) & x.less_than(1.0) & x.more_than(1.0);
    assert!(matches!(decided(&impossible, &region), Decision::Impossible(_)));
    assert!(matches!(decided(&(odd(1.0) & x.at_least(2.0)), &region), Decision::Witness(_)));
    assert!(matches!(decided(&!odd(1.0), &region), Decision::Witness(_)));
    let decision = decided(&(odd(5.0) & x.at_least(2.0)), &region);
    assert_eq!(decision, Decision::Undecided(Doubt::Functions(vec!["odd".into()])));
}

#[test]
fn variables_need_a_range_and_only_they_matter() {
    let error = decide(&variable("w").at_most(1.0), &Region::new(), &Effort::default());
    assert!(error.is_err());
    let region = [("x", 2.0, 5.0), ("y", -1.0, f64::INFINITY)];
    let expected = State::from([("x".into(), 2.0), ("y".into(), 0.0)]);
    assert_eq!(decided(&always(), &region), Decision::Witness(expected));
    assert!(matches!(decided(&never(), &region), Decision::Impossible(_)));
    assert!(Effort::new(1, 0, 0.1).is_err() && Effort::new(1, 1, f64::NAN).is_err());
}

#[test]
fn decisions_say_what_they_are() {
    let x = variable("x");
    let text = |predicate| decided(&predicate, &[("x", 0.0, 4.0)]).to_string();
    assert_eq!(text(x.at_least(4.0)), "it holds at x = 4");
    let contradiction = x.less_than(1.0) & x.more_than(1.0);
    let expected = "it holds nowhere, for linear comparisons contradict each other";
    assert_eq!(text(contradiction), expected);
}

proptest! {
    #[test]
    fn linear_predicates_are_decided_as_sampling_says(predicate in linear_predicates()) {
        let decision = decided(&predicate, &GRID);
        prop_assert!(!matches!(decision, Decision::Undecided(_)), "{predicate}: {decision}");
        agrees_with_samples(&predicate, &decision)?;
    }

    #[test]
    fn curved_predicates_are_never_decided_wrongly(predicate in curved_predicates()) {
        agrees_with_samples(&predicate, &decided(&predicate, &GRID))?;
    }
}

const GRID: [(&str, f64, f64); 2] = [("x", -3.0, 3.0), ("y", -3.0, 3.0)];

/// No sample may contradict the decision, and a witness must hold and lie in the region.
fn agrees_with_samples(predicate: &Predicate, decision: &Decision) -> Result<(), TestCaseError> {
    if let Decision::Witness(witness) = decision {
        let inside = GRID.iter().all(|(name, low, high)| (*low..=*high).contains(&witness[*name]));
        prop_assert!(inside && predicate.holds(witness) == Ok(true), "{predicate}: {decision}");
    }
    if let Decision::Impossible(_) = decision {
        for (i, j) in (-12..=12).flat_map(|i| (-12..=12).map(move |j| (i, j))) {
            let sample = [("x", f64::from(i) / 4.0), ("y", f64::from(j) / 4.0)];
            prop_assert_ne!(predicate.holds(&sample), Ok(true), "{} at {:?}", predicate, sample);
        }
    }
    Ok(())
}

fn decided(predicate: &Predicate, ranges: &[(&str, f64, f64)]) -> Decision {
    let region: Region = ranges
        .iter()
        .map(|(name, lower, upper)| {
            let range = Interval::new(*lower, *upper).expect("these ends are in order");
            (name.to_string(), range)
        })
        .collect::<BTreeMap<_, _>>();
    decide(predicate, &region, &Effort::default()).expect("all variables have a range")
}

/// Small whole coefficients, so that evaluation is exact and many systems touch.
fn linear_predicates() -> impl Strategy<Value = Predicate> {
    let factor = || (-2i8..=2).prop_map(f64::from);
    let term = (factor(), factor(), factor(), 0..4).prop_map(|(a, b, c, kind)| {
        let (x, y) = (variable("x"), variable("y"));
        let plane = a * &x + b * &y - c;
        match kind {
            0 => plane.abs() - 1.0,
            1 => plane.max(&x) - 1.0,
            _ => plane,
        }
    });
    predicates_of(term)
}

fn curved_predicates() -> impl Strategy<Value = Predicate> {
    let leaf = prop_oneof![
        2 => prop::sample::select(vec!["x", "y"]).prop_map(variable),
        1 => (-4i8..=4).prop_map(|number| constant(f64::from(number))),
    ];
    let term = leaf.prop_recursive(3, 8, 2, |inner| {
        let pairs = || (inner.clone(), inner.clone());
        let exponents = prop::sample::select(vec![2.0, 3.0, -1.0, 0.5]);
        prop_oneof![
            pairs().prop_map(|(a, b)| a + b),
            pairs().prop_map(|(a, b)| a * b),
            pairs().prop_map(|(a, b)| a / b),
            pairs().prop_map(|(a, b)| a.min(b)),
            (inner.clone(), exponents).prop_map(|(a, exponent)| a.power(exponent)),
            inner.clone().prop_map(|a: Expression| a.sin()),
            inner.prop_map(|a| a.ln()),
        ]
    });
    predicates_of(term)
}

fn predicates_of(terms: impl Strategy<Value = Expression> + 'static) -> BoxedStrategy<Predicate> {
    let comparison = (terms, 0..4).prop_map(|(term, kind)| match kind {
        0 => term.at_most(0.0),
        1 => term.less_than(0.0),
        2 => term.at_least(0.0),
        _ => term.more_than(0.0),
    });
    let combined = comparison.prop_recursive(3, 8, 3, |inner| {
        let parts = || prop::collection::vec(inner.clone(), 2..4);
        prop_oneof![
            3 => parts().prop_map(Predicate::all),
            1 => parts().prop_map(Predicate::any),
            1 => inner.prop_map(not),
        ]
    });
    combined.boxed()
}
