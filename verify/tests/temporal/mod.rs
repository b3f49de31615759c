//! Signal temporal logic against its definition: random formulas on random trajectories, judged
//! by brute force.

mod by_definition;
mod examples;
mod gaps;
mod random;
mod trajectories;

use pleach_verify::temporal::{Formula, Status, always, eventually, not};
use proptest::prelude::*;

use by_definition::{Grid, Reading};
use random::{Trajectory, formulas, trajectories, windows};

/// All true values are multiples of ½, and brute force is less than ¼ away from them.
fn to_halves(value: f64) -> f64 {
    (2.0 * value).round() / 2.0
}

proptest! {
    #![proptest_config(cases::usually(300))]

    #[test]
    fn robustness_is_what_the_definition_says(
        formula in formulas(), trajectory in trajectories()
    ) {
        let judgement = formula.judge(&trajectory.samples()).unwrap();
        let grid = Grid::new(&trajectory, formula.horizon());
        let lower = grid.value(&formula, Reading::Margin, f64::NEG_INFINITY);
        let upper = grid.value(&formula, Reading::Margin, f64::INFINITY);
        prop_assert_eq!(judgement.robustness.lower, to_halves(lower), "lower, {}", formula);
        prop_assert_eq!(judgement.robustness.upper, to_halves(upper), "upper, {}", formula);

        let status = match (
            grid.value(&formula, Reading::Truth, f64::NEG_INFINITY),
            grid.value(&formula, Reading::Truth, f64::INFINITY),
        ) {
            (lower, _) if lower > 0.0 => Status::Satisfied,
            (_, upper) if upper < 0.0 => Status::Violated,
            _ => Status::Inconclusive,
        };
        prop_assert_eq!(judgement.status, status, "{}", formula);
    }

    #[test]
    fn the_sign_of_the_robustness_is_the_verdict(
        formula in formulas(), trajectory in trajectories()
    ) {
        let judgement = formula.judge(&trajectory.samples()).unwrap();
        prop_assert!(judgement.robustness.lower <= judgement.robustness.upper);
        match judgement.status {
            Status::Satisfied => prop_assert!(judgement.robustness.lower >= 0.0),
            Status::Violated => prop_assert!(judgement.robustness.upper <= 0.0),
            Status::Inconclusive => {
                prop_assert!(judgement.robustness.lower <= 0.0);
                prop_assert!(judgement.robustness.upper >= 0.0);
            }
            Status::Undecided => prop_assert!(false, "samples leave nothing open"),
        }
        if formula.horizon() <= trajectory.duration() {
            prop_assert!(judgement.status != Status::Inconclusive);
        }
    }

    #[test]
    fn witnesses_have_the_margin_that_decides(
        formula in formulas(), trajectory in trajectories()
    ) {
        let judgement = formula.judge(&trajectory.samples()).unwrap();
        if let Some(witness) = judgement.witness {
            let state = trajectory.state_at(witness.at);
            let margin = witness.predicate.evaluate(&state).unwrap().margin;
            prop_assert!((margin - witness.margin).abs() < 1e-9, "{witness}");
            let robustness = match judgement.status {
                Status::Satisfied => judgement.robustness.lower,
                _ => judgement.robustness.upper,
            };
            prop_assert!((margin.abs() - robustness.abs()).abs() < 1e-9, "{witness}");
        }
    }

    #[test]
    fn not_always_is_eventually_not(
        formula in formulas(), window in windows(), trajectory in trajectories()
    ) {
        let judge = |formula: Formula| formula.judge(&trajectory.samples()).unwrap();
        let not_always = judge(not(always(window, &formula)));
        let eventually_not = judge(eventually(window, not(&formula)));
        prop_assert_eq!(not_always.robustness, eventually_not.robustness);
        prop_assert_eq!(not_always.status, eventually_not.status);
    }

    #[test]
    fn eventually_is_until_from_truth(
        formula in formulas(), window in windows(), trajectory in trajectories()
    ) {
        let judge = |formula: Formula| formula.judge(&trajectory.samples()).unwrap();
        let until = judge(Formula::All([].into()).until(window, &formula));
        let eventually = judge(eventually(window, &formula));
        prop_assert_eq!(until.robustness, eventually.robustness);
        prop_assert_eq!(until.status, eventually.status);
    }

    /// What a longer trajectory shows lies in the interval that a shorter one leaves open.
    #[test]
    fn more_of_the_trajectory_narrows_the_robustness(
        formula in formulas(), trajectory in trajectories(), end in 0_i32..7
    ) {
        let samples = trajectory.samples.iter().copied().filter(|(t, _)| *t <= end).collect();
        let beginning = Trajectory { samples };
        let before = formula.judge(&beginning.samples()).unwrap();
        let after = formula.judge(&trajectory.samples()).unwrap();
        prop_assert!(before.robustness.lower <= after.robustness.lower);
        prop_assert!(after.robustness.upper <= before.robustness.upper);
    }
}
