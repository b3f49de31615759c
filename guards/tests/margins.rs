//! Laws of verdicts and margins.

use crate::common::predicates;
use pleach_guards::not;
use proptest::prelude::*;

proptest! {
    #[test]
    fn the_sign_of_the_margin_is_the_verdict(predicate in predicates(), state in states()) {
        if let Ok(verdict) = predicate.evaluate(&state) {
            prop_assert!(verdict.margin <= 0.0 || verdict.holds, "{predicate}: {verdict:?}");
            prop_assert!(verdict.margin >= 0.0 || !verdict.holds, "{predicate}: {verdict:?}");
        }
    }

    #[test]
    fn de_morgan(a in predicates(), b in predicates(), state in states()) {
        let (either, both) = (a.clone().or(b.clone()), a.clone().and(b.clone()));
        prop_assert_eq!(
            not(both).evaluate(&state).ok(),
            not(a.clone()).or(not(b.clone())).evaluate(&state).ok()
        );
        prop_assert_eq!(not(either).evaluate(&state).ok(), not(a).and(not(b)).evaluate(&state).ok());
    }

    #[test]
    fn negation_turns_verdict_and_margin(predicate in predicates(), state in states()) {
        let opposite = not(predicate.clone());
        match (predicate.evaluate(&state), opposite.evaluate(&state)) {
            (Ok(verdict), Ok(turned)) => {
                prop_assert_eq!(turned.margin, -verdict.margin, "{}", predicate);
                prop_assert_eq!(turned.holds, !verdict.holds, "{}", predicate);
            }
            (verdict, turned) => prop_assert_eq!(verdict, turned),
        }
    }

    #[test]
    fn double_negation(predicate in predicates(), state in states()) {
        let twice = not(not(predicate.clone()));
        prop_assert_eq!(twice.evaluate(&state), predicate.evaluate(&state));
    }

    #[test]
    fn a_state_with_the_variables_named_is_enough(predicate in predicates(), state in states()) {
        let named = predicate.variables();
        let reduced: Vec<_> =
            state.into_iter().filter(|(name, _)| named.contains(name)).collect();
        prop_assert_eq!(predicate.evaluate(reduced.as_slice()), predicate.evaluate(&state));
    }
}

/// States on a coarse grid, so that boundaries are hit.
fn states() -> impl Strategy<Value = [(&'static str, f64); 3]> {
    let numbers = || (-8i8..=8).prop_map(|quarters| f64::from(quarters) / 4.0);
    (numbers(), numbers(), numbers()).prop_map(|(x, y, delta)| [("x", x), ("y", y), ("δ", delta)])
}
