//! Cases with an answer to compare.

use std::time::Instant;

use pleach_automaton::{Automaton, HybridTime, coordinates, from};
use pleach_discrete::vocabulary;
use pleach_guards::variable;
use pleach_verify::temporal::{
    Formula, Robustness, Status, TemporalError, Window, always, eventually, within,
};

fn x_over_time(points: &[(f64, f64)]) -> Vec<(f64, [(&'static str, f64); 1])> {
    points.iter().map(|(t, x)| (*t, [("x", *x)])).collect()
}

fn at_least(bound: f64) -> Formula {
    Formula::holds(variable("x").at_least(bound))
}

vocabulary! {
    enum Motion: Location { Falling = "falling" }
    enum Contact: Event { Bounce = "bounce" }
}
coordinates! { struct Ball { height, velocity } }

/// Dropped from 5 m at g = 10 m/s², a ball hits the ground at 1 s with 10 m/s.
#[test]
fn runs_of_automata_are_judged() {
    let Ball { height, velocity } = Ball::coordinates();
    let ball = Automaton::starting_in(Motion::Falling)
        .initially(Ball { height: 5.0, velocity: 0.0 })
        .flow(Motion::Falling, [height.rate(&velocity), velocity.rate(-10.0)])
        .transition(
            from(Motion::Falling)
                .on(Contact::Bounce)
                .to(Motion::Falling)
                .must(height.at_most(0.0) & velocity.less_than(0.0))
                .then([velocity.becomes(-0.8 * &velocity)]),
        )
        .build()
        .unwrap();
    let run = ball.run(2.0).unwrap();

    let hits = eventually(within(0.0, 2.0).unwrap(), velocity.at_most(-9.0));
    let judgement = hits.judge(&run).unwrap();
    assert!((judgement.robustness.lower - 1.0).abs() < 1e-6, "{judgement}");
    let at = judgement.witness.unwrap().at;
    assert!((at.t - 1.0).abs() < 1e-6 && at.j == 0, "{at}");

    let rises = eventually(within(0.0, 2.0).unwrap(), velocity.at_least(7.0));
    let judgement = rises.judge(&run).unwrap();
    assert!((judgement.robustness.lower - 1.0).abs() < 1e-6, "{judgement}");
    assert_eq!(judgement.witness.unwrap().at.j, 1);
}

#[test]
fn the_minimum_may_lie_where_two_margins_cross() {
    let samples = x_over_time(&[(0.0, 0.0), (4.0, 4.0)]);
    let apart = variable("x").at_most(1.0).or(variable("x").at_least(2.0));
    let judgement = always(within(0.0, 4.0).unwrap(), apart).judge(&samples).unwrap();
    assert_eq!(judgement.status, Status::Violated);
    assert_eq!(judgement.robustness, Robustness { lower: -0.5, upper: -0.5 });
    assert_eq!(judgement.witness.unwrap().at.t, 1.5);
}

#[test]
fn touching_the_boundary_satisfies_what_is_not_strict() {
    let samples = x_over_time(&[(0.0, 2.0), (1.0, 0.0), (1.0, 0.0), (2.0, 1.0)]);
    let window = within(0.0, 2.0).unwrap();
    let judgement = always(window, at_least(0.0)).judge(&samples).unwrap();
    assert_eq!((judgement.status, judgement.robustness.lower), (Status::Satisfied, 0.0));
    let strict = always(window, variable("x").more_than(0.0)).judge(&samples).unwrap();
    assert_eq!((strict.status, strict.robustness.upper), (Status::Violated, 0.0));
}

#[test]
fn both_sides_of_a_jump_count_and_the_witness_tells_which() {
    let samples = x_over_time(&[(0.0, 5.0), (1.0, 5.0), (1.0, -3.0), (1.0, 5.0), (2.0, 5.0)]);
    let judgement = always(within(0.0, 2.0).unwrap(), at_least(0.0)).judge(&samples).unwrap();
    assert_eq!(judgement.status, Status::Violated);
    let witness = judgement.witness.unwrap();
    assert_eq!((witness.at, witness.margin), (HybridTime { t: 1.0, j: 1 }, -3.0));
}

/// x rises at 1 s, and a rounding later y falls: at no instant are both high.
#[test]
fn jumps_that_are_a_rounding_apart_do_not_meet() {
    let soon = 1f64.next_up();
    let samples = [(0.0, -1.0, -1.0), (1.0, -1.0, 1.0), (soon, 1.0, -1.0), (3.0, 1.0, -1.0)]
        .map(|(t, x, y)| (t, [("x", x), ("y", y)]));
    let high = |name: &str| Formula::holds(variable(name).at_least(0.5));
    for x in [high("x"), always(within(0.0, 0.0).unwrap(), high("x"))] {
        let both = eventually(within(0.0, 2.0).unwrap(), x & high("y"));
        let judgement = both.judge(&samples).unwrap();
        assert_eq!(judgement.status, Status::Violated, "{judgement}");
        assert!(judgement.robustness.upper <= -0.5, "{judgement}");
    }
}

/// 0.9 − 0.3 + 0.3 > 0.9 in binary: the witness is before the jump all the same.
#[test]
fn witnesses_are_on_their_side_of_a_jump() {
    let samples = x_over_time(&[(0.0, 0.0), (0.9, 5.0), (0.9, 0.0), (3.0, 0.0)]);
    let then = always(within(0.3, 0.3).unwrap(), at_least(3.0));
    let judgement = eventually(within(0.0, 2.0).unwrap(), then).judge(&samples).unwrap();
    assert_eq!(judgement.robustness, Robustness { lower: 2.0, upper: 2.0 });
    let witness = judgement.witness.unwrap();
    assert_eq!((witness.at, witness.margin), (HybridTime { t: 0.9, j: 0 }, 2.0));
}

#[test]
fn a_trajectory_that_is_too_short_leaves_an_interval() {
    let samples = x_over_time(&[(0.0, 5.0), (1.0, 2.0)]);
    let judgement = always(within(0.0, 3.0).unwrap(), at_least(0.0)).judge(&samples).unwrap();
    assert_eq!(judgement.status, Status::Inconclusive);
    assert_eq!(judgement.robustness, Robustness { lower: f64::NEG_INFINITY, upper: 2.0 });
    assert_eq!(judgement.witness, None);
    let reached = eventually(Window::UNBOUNDED, at_least(4.0)).judge(&samples).unwrap();
    assert_eq!(reached.status, Status::Satisfied);
    assert_eq!(reached.robustness, Robustness { lower: 1.0, upper: f64::INFINITY });
}

/// Just after 1 s the first turns false and the second true: no instant has the first before it
/// and the second at it.
#[test]
fn until_does_not_step_over_a_gap_without_length() {
    let points = [(0.0, 1.0), (2.0, 1.0), (2.0, -1.0), (4.0, -1.0)];
    let one_second_later = within(1.0, 1.0).unwrap();
    let open = eventually(one_second_later, at_least(0.0));
    let closed = always(one_second_later, variable("x").at_most(0.0));
    let until = open.until(within(0.0, 3.0).unwrap(), closed);
    let judgement = until.judge(&x_over_time(&points)).unwrap();
    assert_eq!(judgement.status, Status::Violated);
    assert_eq!(judgement.robustness, Robustness { lower: -1.0, upper: -1.0 });
}

/// 0.1 + 0.2 > 0.3 in binary.
#[test]
fn rounding_does_not_make_a_trajectory_too_short() {
    let samples = x_over_time(&[(0.0, 1.0), (0.3, 2.0)]);
    let inner = always(within(0.0, 0.2).unwrap(), at_least(0.0));
    let judgement = always(within(0.0, 0.1).unwrap(), inner).judge(&samples).unwrap();
    assert_eq!((judgement.status, judgement.robustness.lower), (Status::Satisfied, 1.0));
}

#[test]
fn bad_trajectories_are_refused() {
    let formula = at_least(0.0);
    let judge = |points: &[(f64, f64)]| formula.judge(&x_over_time(points)).unwrap_err();
    assert_eq!(judge(&[]), TemporalError::NoSamples);
    let error = TemporalError::TimeOutOfOrder { sample: 1, time: 0.5 };
    assert_eq!(judge(&[(1.0, 0.0), (0.5, 0.0)]), error);
    assert!(matches!(judge(&[(f64::NAN, 0.0)]), TemporalError::TimeOutOfOrder { sample: 0, .. }));
    assert!(matches!(judge(&[(0.0, f64::NAN)]), TemporalError::Evaluation { time: 0.0, .. }));
    let error = judge(&[(0.0, 0.0), (1.0, f64::INFINITY)]);
    assert!(matches!(error, TemporalError::UnboundedFlow { from: 0.0, to: 1.0, .. }), "{error}");
    assert!(formula.judge(&x_over_time(&[(0.0, 0.0), (0.0, f64::INFINITY)])).is_ok());
}

/// Ten times the samples take about ten times as long, whatever the window; brute force would
/// take a hundred times as long. The bound leaves room for a busy machine, and the better
/// of two runs counts.
#[test]
fn time_is_linear_in_the_number_of_samples() {
    let wave = |count: usize| -> Vec<_> {
        let value = |step: usize| (step as f64 * 0.7).sin() + (step as f64 * 0.003).sin();
        (0..count).map(|step| (step as f64, [("x", value(step))])).collect()
    };
    let seconds = |count: usize| {
        let samples = wave(count);
        let third = count as f64 / 3.0;
        let window = || within(1.0, third).unwrap();
        let settles = at_least(-0.5).until(window(), always(window(), at_least(-1.9)));
        let once = |_| {
            let begin = Instant::now();
            settles.judge(&samples).unwrap();
            begin.elapsed().as_secs_f64()
        };
        (0..2).map(once).fold(f64::INFINITY, f64::min)
    };
    let (small, large) = (seconds(10_000), seconds(100_000));
    println!("10,000 samples: {small:.3} s; 100,000 samples: {large:.3} s");
    assert!(large < 40.0 * small, "{small} s, then {large} s");
}
