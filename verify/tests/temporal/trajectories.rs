//! Formulas on trajectories of models, against closed forms.

use pleach_automaton::{Automaton, Flow, Trajectory, coordinates, from};
use pleach_discrete::vocabulary;
use pleach_guards::variable;
use pleach_verify::temporal::{Formula, Status, always, eventually, not, within};
use proptest::prelude::*;

vocabulary! {
    enum Place: Location { Swinging = "swinging" }
    enum Cue: Event { Kick = "kick" }
}
coordinates! { struct Pendulum { x, v, clock = "τ" } }

/// x = cos ωt, by its closed form or by an integrator.
fn oscillator(omega: f64, is_integrated: bool, horizon: f64) -> Trajectory {
    let Pendulum { x, v, clock } = Pendulum::coordinates();
    let zero = if is_integrated { 0.0 * v.power(2.0) } else { 0.0 * &v };
    let flow: Flow<Pendulum> =
        [x.rate(&v), v.rate(-(omega * omega) * &x + zero), clock.rate(1.0)].into();
    let automaton: Automaton<Place, Cue, Pendulum> = Automaton::starting_in(Place::Swinging)
        .initially(Pendulum { x: 1.0, v: 0.0, clock: 0.0 })
        .flow(Place::Swinging, flow)
        .build()
        .expect("it is sound");
    automaton.run(horizon).expect("it can be run")
}

fn status(formula: &Formula, trajectory: &Trajectory) -> Status {
    formula.judge(trajectory).expect("there are samples").status
}

/// Visits of 0.028 s in each turn of 6.3 s, seen from 4,000 s of it.
#[test]
fn short_visits_in_a_long_run_are_seen() {
    let trajectory = oscillator(1.0, false, 4e3);
    let low = variable("x").at_most(-0.9999);
    let window = within(0.0, 4e3).expect("in order");
    assert_eq!(status(&eventually(window, low.clone()), &trajectory), Status::Satisfied);
    let returns = always(
        within(0.0, 3_990.0).expect("in order"),
        eventually(within(0.0, 6.4).expect("in order"), low),
    );
    assert_eq!(status(&returns, &trajectory), Status::Satisfied);
    let never = eventually(window, variable("x").at_most(-1.000_001));
    let judgement = never.judge(&trajectory).expect("there are samples");
    assert_eq!(judgement.status, Status::Violated);
    assert!((judgement.robustness.lower + 1e-6).abs() < 1e-10, "{judgement}");
}

/// The clock rises while the wave turns: what changes where is known to the last digits.
#[test]
fn changes_within_a_flow_are_placed_exactly() {
    let trajectory = oscillator(1.0, false, 10.0);
    let first = 0.99_f64.acos();
    let above = variable("x").at_least(0.99);
    for (until, expected) in [(first - 1e-12, Status::Satisfied), (first + 1e-12, Status::Violated)]
    {
        let formula = always(within(0.0, until).expect("in order"), above.clone());
        assert_eq!(status(&formula, &trajectory), expected, "until {until}");
        let formula = not(formula);
        assert_ne!(status(&formula, &trajectory), expected, "not until {until}");
    }
}

/// Jumps count as before.
#[test]
fn jumps_are_seen_from_both_sides() {
    let Pendulum { x, v, clock } = Pendulum::coordinates();
    let kick = from(Place::Swinging)
        .on(Cue::Kick)
        .to(Place::Swinging)
        .must(clock.at_least(1.0))
        .then([x.becomes(5.0), clock.becomes(0.0)]);
    let automaton = Automaton::starting_in(Place::Swinging)
        .initially(Pendulum { x: 0.0, v: 1.0, clock: 0.0 })
        .flow(Place::Swinging, [x.rate(&v), clock.rate(1.0)])
        .transition(kick)
        .build()
        .expect("it is sound");
    let trajectory = automaton.run(1.5).expect("it can be run");
    let window = within(1.0, 1.0).expect("in order");
    for (bound, expected) in [(5.0, Status::Satisfied), (5.1, Status::Violated)] {
        let formula = eventually(window, variable("x").at_least(bound));
        assert_eq!(status(&formula, &trajectory), expected, "{bound}");
    }
    let before = eventually(window, variable("x").at_most(1.0));
    assert_eq!(status(&before, &trajectory), Status::Satisfied);
}

proptest! {
    #![proptest_config(cases::usually(40))]

    /// Where cos ωt comes down to a level first: at acos(level) ÷ ω.
    #[test]
    fn first_passages_decide(
        omega in 0.2..30.0_f64,
        level in -0.9999..0.99_f64,
        is_integrated in prop::bool::ANY,
    ) {
        let trajectory = oscillator(omega, is_integrated, 10.0);
        let first = level.acos() / omega;
        prop_assume!(first < 9.0);
        let blur = if is_integrated { 1e-6 } else { 1e-11 };
        for (until, expected) in
            [(first * (1.0 - blur), Status::Violated), (first * (1.0 + blur), Status::Satisfied)]
        {
            let window = within(0.0, until).expect("in order");
            let formula = eventually(window, variable("x").at_most(level));
            prop_assert_eq!(status(&formula, &trajectory), expected, "{} {}", until, first);
        }
    }
}
