//! Formulas over time, asked of all runs.

use pleach_automaton::composition::Policy;
use pleach_automaton::{Automaton, Name, Record, from};
use pleach_guards::{Expression, constant, variable};
use pleach_verify::reach::{
    Effort, Model, ReachError, Settings, TemporalAnswer, prove_formula, verify_formula,
};
use pleach_verify::temporal::{Formula, Window, always, eventually, within};
use proptest::prelude::*;

use super::support::{Named, boxed, run};

/// A room that is heated from 18 on until 22.
fn thermostat() -> Named {
    let state = Record::new([("T", 20.0)]).unwrap();
    let coordinates = state.coordinates();
    let t = &coordinates[0];
    let [off, on] = ["off", "on"].map(Name::new);
    let [cold, warm] = ["cold", "warm"].map(Name::new);
    Automaton::starting_in(off)
        .initially(state.clone())
        .flow(off, t.rate(-0.1 * t))
        .flow(on, t.rate(5.0 - 0.1 * t))
        .transition(from(off).on(cold).to(on).must(t.at_most(18.0)))
        .transition(from(on).on(warm).to(off).must(t.at_least(22.0)))
        .build()
        .unwrap()
}

fn asked(formula: &Formula) -> TemporalAnswer {
    let settings = Settings { step: 0.02, ..Settings::default() };
    let start = boxed(&[(19.0, 21.0)]).parts(&[32]);
    verify_formula(&thermostat(), &[], &start, formula, &settings, &Effort::default()).unwrap()
}

#[test]
fn three_answers() {
    let window = |start, end| within(start, end).unwrap();
    let t = || variable("T");
    // Whenever it is colder than 18.5, it is warmer than 21.5 within 3 s.
    let cold = Formula::holds(t().at_most(18.5));
    let warms = cold.implies(eventually(window(0.0, 3.0), t().at_least(21.5)));
    let TemporalAnswer::Holds(proof) = asked(&always(window(0.0, 6.0), warms)) else {
        panic!("it warms")
    };
    assert!(proof.robustness.lower > 0.0);
    // From 19 to 22 it takes (ln 31 − ln 28) ÷ 0.1 s, about 1 s, and from 18 a little more.
    let soon = eventually(window(0.0, 1.0), t().at_least(21.5));
    let cold = Formula::holds(t().at_most(18.5)).implies(soon);
    let TemporalAnswer::Violated(run) = asked(&always(window(0.0, 3.0), cold)) else {
        panic!("it takes longer")
    };
    assert!(run.judgement.robustness.upper < 0.0);
    assert!((19.0..=21.0).contains(&run.start[0]));
    // Between: the least and the most robust runs are on both sides of what steps can tell.
    let falls = 10.0 * (21.0f64 / 18.0).ln();
    let barely = eventually(window(0.0, falls + 1e-4), t().at_most(18.0 + 1e-7));
    let TemporalAnswer::Undecided(proof) = asked(&barely) else { panic!("decided") };
    assert!(!proof.open.is_empty());
    assert!(proof.robustness.lower <= 0.0 && proof.robustness.upper >= 0.0);
}

#[test]
fn until_and_what_has_no_end() {
    let window = within(0.0, 3.0).unwrap();
    let below = Formula::holds(variable("T").at_most(21.1));
    let reached = below.until(window, variable("T").at_most(18.5));
    assert!(matches!(asked(&reached), TemporalAnswer::Holds(_)));
    let forever = always(Window::UNBOUNDED, variable("T").at_most(23.0));
    let start = [boxed(&[(19.0, 21.0)])];
    let ask = |formula: &Formula| {
        verify_formula(
            &thermostat(),
            &[],
            &start,
            formula,
            &Settings::default(),
            &Effort::default(),
        )
    };
    assert!(matches!(ask(&forever), Err(ReachError::Endless { .. })));
    let stranger = always(window, variable("U").at_most(23.0));
    let error = ask(&stranger).unwrap_err().to_string();
    assert_eq!(error, "`U ≤ 23` reads `U`, which is no variable of the model");
}

fn formula(choice: u8, bounds: &[f64], times: &[f64]) -> Formula {
    let window =
        |at: usize| within(times[at].min(times[at + 1]), times[at].max(times[at + 1])).unwrap();
    let [x, y] = ["x0", "x1"].map(variable);
    let right = Formula::holds(x.at_least(bounds[0]));
    let both = Formula::holds((&x + 0.5 * &y).at_most(bounds[1]) | y.at_least(bounds[0]));
    match choice % 6 {
        0 => always(window(0), eventually(window(1), right)),
        1 => eventually(window(0), always(window(1), both)),
        2 => right.until(window(1), both),
        3 => always(window(0), right.implies(eventually(window(2), both))),
        4 => !(both.until(window(0), eventually(window(1), right))),
        _ => eventually(window(0), right.and(always(window(2), both))),
    }
}

proptest! {
    #![proptest_config(cases::usually(100))]

    /// The robustness of simulated runs is within the bounds of all runs.
    #[test]
    fn runs_are_as_robust_as_all_runs_are_said_to_be(
        gains in proptest::collection::vec(-1.5..1.5f64, 6),
        choice: u8,
        bounds in proptest::collection::vec(-1.0..1.0f64, 2),
        times in proptest::collection::vec(0.0..1.2f64, 4),
        boundary in 0.1..0.6f64,
        shares in proptest::collection::vec(-1.0..1.0f64, 6),
    ) {
        let state = Record::new([("x0", 0.0), ("x1", 0.0)]).unwrap();
        let variables = state.coordinates();
        let [x, y] = &variables[..] else { unreachable!() };
        let rate = |g: &[f64]| -> Expression { g[0] * x + g[1] * y + constant(g[2]) };
        let [one, other] = ["one", "other"].map(Name::new);
        let over = Name::new("over");
        let automaton: Named = Automaton::starting_in(one)
            .initially(state.clone())
            .flow(one, [x.rate(rate(&gains[..3])), y.rate(rate(&gains[3..]))])
            .flow(other, [x.rate(-x), y.rate(rate(&gains[3..]))])
            .transition(from(one).on(over).to(other).must(x.at_least(boundary)).then(y.becomes(0.5 * y)))
            .build()
            .unwrap();
        let formula = formula(choice, &bounds, &times);
        let start = [boxed(&[(-0.2, 0.2), (-0.1, 0.1)])];
        let settings = Settings { step: 0.05, ..Settings::default() };
        let model = Model::of(&automaton).unwrap();
        let proof = prove_formula(&model, &start, &formula, &settings).unwrap();
        for shares in shares.chunks(2) {
            let state = [0.2 * shares[0], 0.1 * shares[1]];
            let trajectory = run(&automaton, &[], &state, Policy::Late, formula.horizon());
            let found = formula.judge(&trajectory).unwrap().robustness;
            prop_assert!(proof.robustness.lower <= found.upper + 1e-9, "{:?} {found:?}", proof.robustness);
            prop_assert!(found.lower - 1e-9 <= proof.robustness.upper, "{:?} {found:?}", proof.robustness);
        }
    }
}
