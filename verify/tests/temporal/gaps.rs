//! What samples would miss: instants, spikes, pulses, conserved margins; and what cannot be known.

use std::time::Instant;

use pleach_automaton::{Automaton, Flow, Trajectory, coordinates};
use pleach_discrete::vocabulary;
use pleach_guards::{Expression, Predicate, Table, variable};
use pleach_verify::temporal::{
    Formula, Judgement, Robustness, Status, Window, always, eventually, within,
};

vocabulary! {
    enum Place: Location { Here = "here" }
    enum Cue: Event { None = "none" }
}
coordinates! { struct Pair { x, y } }

/// x and y from a start at these rates.
fn run(start: [f64; 2], rates: [Expression; 2], horizon: f64) -> Trajectory {
    let Pair { x, y } = Pair::coordinates();
    let [one, other] = rates;
    let flow: Flow<Pair> = [x.rate(one), y.rate(other)].into();
    let automaton: Automaton<Place, Cue, Pair> = Automaton::starting_in(Place::Here)
        .initially(Pair { x: start[0], y: start[1] })
        .flow(Place::Here, flow)
        .build()
        .unwrap();
    automaton.run(horizon).unwrap()
}

fn x() -> Expression {
    variable("x")
}

fn y() -> Expression {
    variable("y")
}

fn number(value: f64) -> Expression {
    value.into()
}

fn clock(horizon: f64) -> Trajectory {
    run([0.0, 0.0], [number(1.0), number(0.0)], horizon)
}

fn circle(horizon: f64) -> Trajectory {
    run([1.0, 0.0], [-y(), x()], horizon)
}

fn until(end: f64) -> Window {
    within(0.0, end).unwrap()
}

fn judge(formula: &Formula, trajectory: &Trajectory) -> Judgement {
    let begin = Instant::now();
    let judgement = formula.judge(trajectory).unwrap();
    println!("{formula}: {judgement} ({:?})", begin.elapsed());
    judgement
}

fn ever(predicate: Predicate, trajectory: &Trajectory) -> Judgement {
    judge(&eventually(until(trajectory.ending().at.t), predicate), trajectory)
}

fn ever_after(predicate: Predicate, trajectory: &Trajectory) -> Judgement {
    judge(&always(until(trajectory.ending().at.t), predicate), trajectory)
}

fn encloses(robustness: Robustness, value: f64, width: f64) {
    let Robustness { lower, upper } = robustness;
    let rounding = 1e-15 * value.abs();
    assert!(lower <= value + rounding && value - rounding <= upper, "{value} in {robustness}");
    assert!(upper - lower <= width, "{robustness} is wider than {width}");
}

/// At a kink: |x − 0.7| comes down to 0 and rises at once.
#[test]
fn instants_at_kinks_are_seen() {
    let clock = clock(2.0);
    for near in [1e-3, 1e-6, 1e-9, 1e-12] {
        let judgement = ever((x() - 0.7).abs().at_most(near), &clock);
        assert_eq!(judgement.status, Status::Satisfied, "{near}");
        encloses(judgement.robustness, near, 1e-14);
    }
    let away = ever((x() - 0.7).abs().at_most(-1e-9), &clock);
    assert_eq!(away.status, Status::Violated);
    encloses(away.robustness, -1e-9, 1e-14);
}

/// A table rises to 1 and falls within 10⁻⁹ seconds.
#[test]
fn spikes_of_tables_are_seen() {
    for width in [1e-3, 1e-6, 1e-9] {
        let points =
            [(0.0, 0.0), (0.7, 0.0), (0.7 + 0.5 * width, 1.0), (0.7 + width, 0.0), (9.0, 0.0)];
        let spike = Table::linear(points).unwrap().at(x());
        let judgement = ever_after(spike.at_most(0.5), &clock(2.0));
        assert_eq!(judgement.status, Status::Violated, "{width}");
        // The slope of its sides times the rounding of x.
        encloses(judgement.robustness, -0.5, 3e-14 / width);
    }
    let steps = Table::steps([(0.0, 0.0), (0.7, 1.0), (0.7 + 1e-9, 0.0)]).unwrap().at(x());
    let judgement = ever_after(steps.at_most(0.5), &clock(2.0));
    assert_eq!(judgement.status, Status::Violated);
    encloses(judgement.robustness, -0.5, 0.0);
}

/// A pulse of a millisecond in a million seconds.
#[test]
fn pulses_in_long_runs_are_seen() {
    let clock = clock(1e6);
    let pulse = (1.0 - (1e3 * (x() - 123_456.7)).power(2.0)).max(0.0);
    assert_eq!(ever(pulse.at_least(0.5), &clock).status, Status::Satisfied);
    assert_eq!(ever(pulse.at_least(1.5), &clock).status, Status::Violated);
    let steps = Table::steps([(0.0, 0.0), (654_321.0, 1.0), (654_321.001, 0.0)]).unwrap().at(x());
    assert_eq!(ever_after(steps.at_most(0.5), &clock).status, Status::Violated);
}

/// Conserved quantities: sums, squares, and what is no polynomial.
#[test]
fn conserved_margins_are_judged() {
    let decay = run([1.0, 0.0], [-x(), x()], 10.0);
    let judgement = ever_after((x() + y()).at_most(1.5), &decay);
    assert_eq!(judgement.status, Status::Satisfied);
    encloses(judgement.robustness, 0.5, 1e-14);

    let circle = circle(1000.0);
    let energy = x().power(2.0) + y().power(2.0);
    let judgement = ever_after(energy.at_most(1.0 + 1e-9), &circle);
    assert_eq!(judgement.status, Status::Satisfied);
    let Robustness { lower, upper } = judgement.robustness;
    assert!((lower - 1e-9).abs() < 1e-11 && (upper - 1e-9).abs() < 1e-11, "{judgement}");
    assert_eq!(ever(energy.at_least(1.0 + 1e-9), &circle).status, Status::Violated);

    let pendulum = run([1.0, 0.0], [y(), -x().sin()], 20.0);
    let energy = 0.5 * y().power(2.0) - x().cos();
    let judgement = ever_after(energy.at_most(0.0), &pendulum);
    assert_eq!(judgement.status, Status::Satisfied);
    let Robustness { lower, upper } = judgement.robustness;
    assert!((lower - 1f64.cos()).abs() < 1e-6 && (upper - 1f64.cos()).abs() < 1e-6, "{judgement}");
    let undecided = ever_after(energy.at_most(-1f64.cos()), &pendulum);
    assert_eq!(undecided.status, Status::Undecided, "{undecided}");
    assert!(!undecided.doubts.is_empty());
}

/// cos t comes to 1 after each turn: whether it passes 1 is beyond rounding.
#[test]
fn touches_are_told() {
    let judgement = ever_after(x().at_most(1.0), &circle(10.0));
    assert_eq!(judgement.status, Status::Undecided, "{judgement}");
    let [doubt] = &judgement.doubts[..] else { panic!("{:?}", judgement.doubts) };
    let turn = std::f64::consts::TAU;
    assert!(doubt.gap.from <= turn && turn <= doubt.gap.to && doubt.gap.to - doubt.gap.from < 1e-6);
    encloses(judgement.robustness, 0.0, 1e-13);
    assert_eq!(ever_after(x().at_most(1.0 + 1e-12), &circle(10.0)).status, Status::Satisfied);
    assert_eq!(ever_after(x().at_most(1.0 - 1e-12), &circle(10.0)).status, Status::Violated);
}

/// 1 − e⁻ᵗ never reaches 1, but the nearest number to it does.
#[test]
fn what_is_only_approached_is_not_reached() {
    let rising = run([0.0, 0.0], [1.0 - x(), number(0.0)], 60.0);
    assert_eq!(ever(x().at_least(1.0), &rising).status, Status::Undecided);
    assert_eq!(ever(x().at_least(1.0 - 1e-12), &rising).status, Status::Satisfied);
}

/// Where windows inside windows cut a margin, its robustness is between two numbers.
#[test]
fn robustness_is_enclosed() {
    let circle = circle(30.0);
    // The largest fall of cos t within a second of its being above 0.
    let inner = eventually(until(1.0), x().at_least(0.5));
    let formula = always(until(3.0), inner);
    let judgement = judge(&formula, &circle);
    assert_eq!(judgement.status, Status::Violated);
    // Least at 2.64 s: cos 2.64 = cos 3.64.
    let middle = std::f64::consts::PI - 0.5;
    encloses(judgement.robustness, middle.cos() - 0.5, 1e-2);
}

/// Ten thousand spikes, some million turns: the work is bounded.
#[test]
fn judging_returns() {
    let clock = clock(1e6);
    let wave = (50.0 * x()).sin();
    let judgement = ever_after(wave.at_most(0.99), &clock);
    assert_eq!(judgement.status, Status::Violated);
    let judgement = ever_after(wave.at_most(1.0), &clock);
    assert_eq!(judgement.status, Status::Satisfied);
}
