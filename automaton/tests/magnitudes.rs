//! What becomes far smaller than it was, and what acts for a moment only.

use std::f64::consts::PI;

use pleach_automaton::{
    Automaton, Builder, Coordinate, Reason, Settings, Trajectory, Why, coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::{Expression, Predicate, constant};

vocabulary! {
    enum Place: Location { Here = "here", There = "there" }
    enum Cue: Event { Go = "go" }
}
coordinates! { struct Body { x, y, clock = "t" } }

fn coordinates() -> [Coordinate<Body>; 3] {
    let Body { x, y, clock } = Body::coordinates();
    [x, y, clock]
}

fn body(start: [f64; 2], rates: [Expression; 2]) -> Builder<Place, Cue, Body> {
    let [x, y, clock] = coordinates();
    let [one, other] = rates;
    Automaton::starting_in(Place::Here)
        .initially(Body { x: start[0], y: start[1], clock: 0.0 })
        .flow(Place::Here, [x.rate(one), y.rate(other), clock.rate(1.0)])
}

fn run(parts: Builder<Place, Cue, Body>, horizon: f64) -> Trajectory {
    parts.build().expect("it is sound").run(horizon).expect("it can be run")
}

fn go(parts: Builder<Place, Cue, Body>, guard: Predicate, horizon: f64) -> Trajectory {
    run(parts.transition(from(Place::Here).on(Cue::Go).to(Place::There).must(guard)), horizon)
}

fn first(trajectory: &Trajectory) -> f64 {
    trajectory.jumps().first().unwrap_or_else(|| panic!("{:?}", trajectory.ending())).at.t
}

/// ẋ = −k x comes to a level after ln(x₀ ÷ level) ÷ k, whatever the horizon, and however far below its start.
#[test]
fn decay_comes_to_levels_far_below_its_start() {
    let [x, ..] = coordinates();
    for (start, rate, level) in [
        (1.0_f64, 1.0, 1e-20),
        (1.0, 1.0, 1e-18),
        (1e6, 0.1, 1e-12),
        (1.0, 1.0, 1e-300),
        (1e-3, 5.0, 1e-9),
    ] {
        let exact = (start / level).ln() / rate;
        for horizon in [100.0, 2000.0, 1e4, 1e6] {
            if horizon < exact {
                continue;
            }
            let decay = body([start, 0.0], [-rate * &x, constant(0.0)]);
            let trajectory = go(decay, x.at_most(level), horizon);
            let found = first(&trajectory);
            assert!((found - exact).abs() < 1e-12 * exact, "{found} {exact} before {horizon}");
            assert!(trajectory.doubts().is_empty(), "{:?}", trajectory.doubts());
        }
    }
}

/// Beside what lasts, in the same flow and without a connection to it.
#[test]
fn decay_beside_what_lasts_comes_to_its_level() {
    let [x, y, _] = coordinates();
    for slow in [0.0, 1e-3, -1e-2] {
        let both = body([1.0, 1.0], [-100.0 * &x, slow * &y]);
        let found = first(&go(both, x.at_most(1e-40), 100.0));
        let exact = 1e40_f64.ln() / 100.0;
        assert!((found - exact).abs() < 1e-12 * exact, "{found} {exact}");
    }
    // e⁻ᵗ cos 2t, as one block, first comes below −10⁻²⁰ and above it after that.
    let spiral = body([1.0, 0.0], [-&x - 2.0 * &y, 2.0 * &x - &y]);
    let trajectory = run(spiral, 200.0);
    for step in 1..2000 {
        let t = 0.1 * f64::from(step);
        let [found, exact] =
            [trajectory.value("x", t).expect("it lasts"), (-t).exp() * (2.0 * t).cos()];
        assert!((found - exact).abs() < 1e-12 * (-t).exp(), "{found:e} {exact:e} at {t}");
    }
}

#[test]
fn decay_never_passes_zero() {
    let [x, ..] = coordinates();
    let trajectory = go(body([1.0, 0.0], [-&x, constant(0.0)]), x.less_than(0.0), 700.0);
    assert!(trajectory.jumps().is_empty() && trajectory.ending().reason == Reason::Horizon);
    for step in 0..7000 {
        assert!(trajectory.value("x", 0.1 * f64::from(step)).is_ok_and(|x| x > 0.0), "{step}");
    }
}

/// What is approached and, rounded, reached: 1 − e⁻ᵗ is the number 1 after 37 s.
#[test]
fn a_level_that_is_only_approached_is_said() {
    let [x, ..] = coordinates();
    let trajectory = go(body([0.0, 0.0], [1.0 - &x, constant(0.0)]), x.at_least(1.0), 100.0);
    assert!(trajectory.doubts().iter().any(|doubt| doubt.why == Why::Touch), "{trajectory:?}");
    // By an integrator, within its tolerances.
    let bent = 1.0 - &x + 0.0 * x.power(3.0);
    let trajectory = go(body([0.0, 0.0], [bent, constant(0.0)]), x.at_least(1.0), 100.0);
    assert!(trajectory.doubts().iter().any(|doubt| doubt.why == Why::Touch), "{trajectory:?}");
    // Decay below the absolute tolerance.
    let bent = -&x + 0.0 * x.power(3.0);
    let trajectory = go(body([1.0, 0.0], [bent, constant(0.0)]), x.at_most(1e-20), 100.0);
    assert!(trajectory.doubts().iter().any(|doubt| doubt.why == Why::Touch), "{trajectory:?}");
}

/// ẋ = x ln x has the solution exp(−eᵗ ln 2), which never is 0; but soon the error hides whether it is, and
/// ln 0 has no value.
#[test]
fn a_rate_without_a_value_within_the_error_ends_the_run() {
    let [x, ..] = coordinates();
    let trajectory = run(body([0.5, 0.0], [&x * x.ln(), constant(0.0)]), 100.0);
    let Reason::Finished(failure) = &trajectory.ending().reason else {
        panic!("{:?}", trajectory.ending())
    };
    let message = failure.to_string();
    let reason = "the rate of `x` may grow without bound or have no value";
    assert!(message.contains(reason), "{message}");
    let end = trajectory.ending().at.t;
    assert!(trajectory.value("x", end).is_ok_and(|x| x < 1e-6), "{end}");
    let [early, exact] = [1.0, (-1f64.exp() * 2f64.ln()).exp()];
    assert!(trajectory.value("x", early).is_ok_and(|x| (x - exact).abs() < 1e-8));
}

/// A rate that acts for a thousandth of a second at 50 s: its integral is the width times √π.
#[test]
fn spikes_of_rates_are_not_stepped_over() {
    let [x, _, clock] = coordinates();
    for (width, centre) in [(1e-3, 50.0), (1e-6, 70.0), (1e-2, 12.345)] {
        let spike = (-((&clock - centre) / width).power(2.0)).exp();
        for background in [0.0, 1.0] {
            let rates = [&spike / width + background, constant(0.0)];
            let trajectory = run(body([0.0, 0.0], rates), 100.0);
            let found = trajectory.value("x", 100.0).expect("it lasts");
            let exact = PI.sqrt() + background * 100.0;
            assert!((found - exact).abs() < 1e-7 * exact, "{found} {exact} {width}");
        }
    }
    // What is brief for a small variable is as much of it as for a large one.
    let spike = (-((&clock - 50.0) / 1e-3).power(2.0)).exp();
    let trajectory = run(body([1e-4, 0.0], [1e-3 * spike, constant(0.0)]), 100.0);
    let found = trajectory.value("x", 100.0).expect("it lasts");
    assert!((found - 1e-4 - 1e-6 * PI.sqrt()).abs() < 1e-8, "{found}");
    // A Lorentzian: its integral from far away is π.
    let lorentz = 1e4 / (1.0 + (1e4 * (&clock - 50.0)).power(2.0));
    let trajectory = run(body([0.0, 0.0], [lorentz, constant(0.0)]), 100.0);
    let found = trajectory.value("x", 100.0).expect("it lasts");
    assert!((found - 2.0 * (50e4_f64).atan()).abs() < 1e-7, "{found}");
    // A step of tanh, and a spike of a state that moves by itself.
    let step = 0.5 * (1.0 + (1e6 * (&clock - 50.0)).tanh());
    let trajectory = run(body([0.0, 0.0], [step, constant(0.0)]), 100.0);
    assert!((trajectory.value("x", 100.0).expect("it lasts") - 50.0).abs() < 1e-6);
    let [_, y, _] = coordinates();
    let spike = 1e3 * (-(1e3 * (&y - 2.0)).power(2.0)).exp();
    let trajectory = run(body([0.0, 0.0], [spike + 0.0 * x.power(2.0), constant(0.05)]), 100.0);
    let found = trajectory.value("x", 100.0).expect("it lasts");
    assert!((found - 20.0 * PI.sqrt()).abs() < 1e-5, "{found}");
}

/// On a circle x² + y² stays 1: a guard on it is decided, or within rounding in doubt, by few spans.
#[test]
fn guards_on_what_is_conserved_cost_little() {
    let [x, y, _] = coordinates();
    for beyond in [1e-9, 1e-12, 1e-13, 1e-14, 1e-15] {
        let energy = x.power(2.0) + y.power(2.0);
        let parts = body([1.0, 0.0], [1.0 * &y, -1.0 * &x]).transition(
            from(Place::Here).on(Cue::Go).to(Place::There).must(energy.more_than(1.0 + beyond)),
        );
        let settings = Settings { step_limit: 10_000, ..Settings::default() };
        let trajectory =
            parts.build().expect("it is sound").run_with(settings, 100.0).expect("it can be run");
        let (jumps, doubts) = (trajectory.jumps(), trajectory.doubts());
        if beyond >= 1e-12 {
            assert!(jumps.is_empty() && doubts.is_empty(), "{beyond}: {doubts:?}");
        } else {
            assert!(doubts.iter().all(|doubt| doubt.why == Why::Touch), "{beyond}: {doubts:?}");
            assert!(jumps.is_empty() || !doubts.is_empty(), "{beyond}: {jumps:?}");
        }
        assert!(
            !jumps.is_empty() || trajectory.ending().reason == Reason::Horizon,
            "{beyond}: {:?}",
            trajectory.ending()
        );
    }
}
