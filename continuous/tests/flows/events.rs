//! Event location against closed forms.

use std::cell::Cell;
use std::convert::Infallible;

use nalgebra::dmatrix;
use pleach_continuous::flow::{
    ConstantFlow, Curve, EventSearch, Integrator, LinearFlow, Onset, Tolerances, first_instant,
};
use pleach_guards::{EvaluationError, Verdict, variable};
use proptest::prelude::*;

use super::support::{reached, state};

/// The first instant at which the margin is not negative; checks what every answer promises.
fn onset(curve: &impl Curve, from: f64, to: f64, margin: impl Fn(&[f64]) -> f64) -> Option<Onset> {
    onset_of(curve, from, to, |state| reached(margin(state)))
}

fn onset_of(
    curve: &impl Curve,
    from: f64,
    to: f64,
    verdict: impl Fn(&[f64]) -> Verdict,
) -> Option<Onset> {
    let mut judge = |state: &[f64]| Ok::<_, Infallible>(verdict(state));
    let search = EventSearch::default();
    let Ok(found) = first_instant(curve, from, to, &search, &mut judge);
    if let Some(Onset { before, time }) = found {
        assert!(from <= before && before <= time && time <= to);
        assert!(verdict(&state(curve, time)).holds, "lands on the crossed side");
        assert!(time - before <= 2.0 * f64::EPSILON * to.abs().max(from.abs()));
        assert!(time == from || !verdict(&state(curve, before)).holds);
    }
    found
}

fn time_of(onset: Option<Onset>) -> f64 {
    onset.expect("an event").time
}

/// One component, the time itself.
fn clock(duration: f64) -> ConstantFlow {
    ConstantFlow::new(&[1.0], &[0.0], duration).unwrap()
}

/// Height and velocity of a ball.
fn ball(height: f64, velocity: f64) -> LinearFlow {
    let matrix = dmatrix![0.0, 1.0; 0.0, 0.0];
    LinearFlow::new(&matrix, &[0.0, -9.81], &[height, velocity], 10.0).unwrap()
}

#[test]
fn a_falling_ball_hits_the_ground_in_time() {
    let exact = (2.0 * 7.0 / 9.81_f64).sqrt();
    let time = time_of(onset(&ball(7.0, 0.0), 0.0, 10.0, |x| -x[0]));
    assert!((time / exact - 1.0).abs() < 1e-15, "{time} {exact}");
}

#[test]
fn an_integrated_ball_hits_the_ground_in_time() {
    let field = |_: f64, x: &[f64], rates: &mut [f64]| rates.copy_from_slice(&[x[1], -9.81]);
    let mut integrator = Integrator::new(&field, 0.0, &[7.0, 0.0], Tolerances::default());
    let exact = (2.0 * 7.0 / 9.81_f64).sqrt();
    loop {
        let step = integrator.step(10.0).unwrap();
        if let Some(impact) = onset(&step, step.start(), step.end(), |x| -x[0]) {
            assert!((impact.time / exact - 1.0).abs() < 1e-14, "{} {exact}", impact.time);
            break;
        }
    }
}

#[test]
fn events_on_an_integrated_flow_are_as_accurate_as_the_flow() {
    // The damped pendulum of small angle passes zero at multiples of π.
    let field = |_: f64, x: &[f64], rates: &mut [f64]| {
        rates[0] = x[1];
        rates[1] = -1.0625 * x[0] - 0.5 * x[1];
    };
    let mut integrator = Integrator::new(&field, 0.0, &[1.0, -0.25], Tolerances::default());
    let mut passages = Vec::new();
    while integrator.time() < 10.0 {
        let step = integrator.step(10.0).unwrap();
        passages.extend(onset(&step, step.start(), step.end(), |x| -x[0]).map(|onset| onset.time));
        passages.retain(|time| *time != step.start());
    }
    let first = passages[0];
    assert!((first - std::f64::consts::FRAC_PI_2).abs() < 1e-9, "{first}");
}

#[test]
fn the_boundary_belongs_to_the_side_that_the_predicate_says() {
    let curve = clock(2.0);
    let at_least = onset_of(&curve, 0.0, 2.0, |x| reached(x[0] - 1.0));
    assert_eq!(time_of(at_least), 1.0);
    let more_than =
        onset_of(&curve, 0.0, 2.0, |x| Verdict { margin: x[0] - 1.0, holds: x[0] > 1.0 });
    assert!((1.0..1.0 + 1e-15).contains(&time_of(more_than)) && time_of(more_than) > 1.0);
}

#[test]
fn what_holds_at_the_start_begins_there() {
    let found = onset(&clock(2.0), 0.5, 2.0, |x| x[0] - 0.25);
    assert_eq!(found, Some(Onset { before: 0.5, time: 0.5 }));
    // Holds at every time after the start, but not there.
    let after = onset_of(&clock(2.0), 0.0, 2.0, |x| Verdict { margin: x[0], holds: x[0] > 0.0 });
    assert!((0.0..2e-15).contains(&time_of(after)));
}

#[test]
fn what_never_holds_has_no_onset() {
    assert_eq!(onset(&clock(2.0), 0.0, 2.0, |x| x[0] - 3.0), None);
    assert_eq!(onset(&clock(2.0), 0.0, 2.0, |_| f64::NEG_INFINITY), None);
    assert_eq!(onset(&clock(2.0), 1.0, 1.0, |_| -1.0), None);
}

#[test]
fn the_first_of_many_crossings_is_found() {
    // As an oscillation of the guard, over three periods of it.
    let time = time_of(onset(&clock(1.0), 0.0, 1.0, |x| (20.0 * x[0] - 0.5).sin()));
    assert!((time - 0.025).abs() < 1e-15, "{time}");
    // As an oscillation of the state.
    let matrix = dmatrix![0.0, 20.0; -20.0, 0.0];
    let flow = LinearFlow::new(&matrix, &[0.0; 2], &[-0.5_f64.sin(), 0.5_f64.cos()], 1e3).unwrap();
    let time = time_of(onset(&flow, 0.0, 1e3, |x| x[0]));
    assert!((time - 0.025).abs() < 1e-15, "{time}");
}

#[test]
fn a_visit_within_one_step_is_found() {
    // The ball is above the line for 2 ms out of 10 s.
    let rise = 9.81 * 0.4;
    let peak = 0.5 * 9.81 * 0.4 * 0.4;
    let depth = 0.5 * 9.81 * 1e-3 * 1e-3;
    let time = time_of(onset(&ball(0.0, rise), 0.0, 10.0, |x| x[0] - (peak - depth)));
    assert!((time - 0.399).abs() < 1e-12, "{time}");
    // And one that the first part of the search contains.
    let early = time_of(onset(&ball(0.0, 0.981), 0.0, 10.0, |x| x[0] - 0.049));
    assert!((0.0..0.1).contains(&early));
}

#[test]
fn a_peak_that_just_misses_is_no_event() {
    let peak = 0.5 * 9.81 * 0.4 * 0.4;
    assert_eq!(onset(&ball(0.0, 9.81 * 0.4), 0.0, 10.0, |x| x[0] - peak - 1e-13), None);
    let time = time_of(onset(&ball(0.0, 9.81 * 0.4), 0.0, 10.0, |x| x[0] - peak + 1e-13));
    assert!((time - 0.4).abs() < 1e-6, "{time}");
}

#[test]
fn a_touch_at_a_representable_instant_is_an_event() {
    let touch = |at: f64| onset(&clock(10.0), 0.0, 10.0, move |x| -(x[0] - at).powi(2));
    for at in [0.1, 1.0, 3.0, std::f64::consts::PI, 9.9] {
        let time = time_of(touch(at));
        assert!((time - at).abs() < 1e-7, "{time} for {at}");
    }
}

#[test]
fn a_disc_beside_a_long_way_is_entered() {
    // 10 km of straight way through a disc of radius 1 m: two hundred times between looks.
    let way = ConstantFlow::new(&[1.0, 0.0], &[0.0, 0.3], 1e4).unwrap();
    for centre in [12.0, 777.7, 1250.0, 5000.0, 9998.0] {
        let entry = onset(&way, 0.0, 1e4, |x| 1.0 - (x[0] - centre).hypot(x[1]));
        let exact = centre - (1.0_f64 - 0.09).sqrt();
        assert!((time_of(entry) - exact).abs() < 1e-11, "{entry:?} for {centre}");
    }
}

#[test]
fn corners_of_the_margin_are_found() {
    let time = time_of(onset(&clock(10.0), 0.0, 10.0, |x| 1e-6 - (x[0] - 4.321).abs()));
    assert!((time - (4.321 - 1e-6)).abs() < 1e-13, "{time}");
    let both = |x: &[f64]| (x[0] - 3.0).min(2.0 * x[0] - 7.0).max(-100.0);
    assert!((time_of(onset(&clock(10.0), 0.0, 10.0, both)) - 3.5).abs() < 1e-14);
}

#[test]
fn predicates_without_a_useful_margin_are_located_by_halving() {
    let margins: [fn(f64) -> f64; 4] = [
        |x| if x >= 2.3 { 1.0 } else { -1.0 },
        |_| 0.0,
        |x| 2.3 - x,
        |x| if x >= 2.3 { 1e300 } else { -1e-300 },
    ];
    for margin in margins {
        let looks = Cell::new(0);
        let found = onset_of(&clock(10.0), 0.0, 10.0, |x| {
            looks.set(looks.get() + 1);
            Verdict { margin: margin(x[0]), holds: x[0] >= 2.3 }
        });
        assert!((time_of(found) - 2.3).abs() < 4e-15);
        assert!(looks.get() < 75, "{} looks", looks.get());
    }
}

#[test]
fn smooth_margins_take_few_looks() {
    let looks = Cell::new(0);
    let fall = ball(7.0, 0.0);
    onset_of(&fall, 0.0, 10.0, |x| {
        looks.set(looks.get() + 1);
        reached(-x[0])
    });
    assert!(looks.get() <= 18, "{} looks", looks.get());
}

#[test]
fn errors_of_the_guard_come_through() {
    let guard = variable("speed").at_least(1.0);
    let mut judge = |state: &[f64]| guard.evaluate(&[("height", state[0])]);
    let found: Result<_, EvaluationError> =
        first_instant(&clock(1.0), 0.0, 1.0, &EventSearch::default(), &mut judge);
    assert!(found.is_err());
}

#[test]
fn searches_are_checked() {
    assert!(EventSearch::new(-1.0, 8).is_err());
    assert!(EventSearch::new(f64::NAN, 8).is_err());
    assert!(EventSearch::new(0.0, 1).is_err());
    let coarse = EventSearch::new(1e-3, 8).unwrap();
    let mut judge = |state: &[f64]| Ok::<_, Infallible>(reached(state[0].powi(3) - 0.5));
    let Ok(found) = first_instant(&clock(1.0), 0.0, 1.0, &coarse, &mut judge);
    let found = found.unwrap();
    let exact = 0.5_f64.cbrt();
    assert!(found.before < exact && exact <= found.time && found.time - found.before <= 1e-3);
}

proptest! {
    /// A parabola above zero for a share of the time, against its closed form.
    #[test]
    fn parabolas_are_located(top in 0.01..9.99_f64, half_width in 1e-4..5.0_f64, scale in 1e-3..1e3) {
        let margin = |x: &[f64]| scale * (half_width * half_width - (x[0] - top).powi(2));
        let found = onset(&clock(10.0), 0.0, 10.0, margin);
        let exact = (top - half_width).max(0.0);
        // Rounding of the margin moves its zero by less than this.
        let noise = 1e-15 * (1.0 + 10.0 / half_width);
        prop_assert!((time_of(found) - exact).abs() < noise * 10.0, "{found:?} {exact}");
    }

    /// Against a fine scan of a sum of two oscillations.
    #[test]
    fn the_first_onset_is_the_first(level in 0.0..1.9_f64, phase in 0.0..6.0_f64, ratio in 0.2..4.0_f64) {
        let margin = |t: f64| (t + phase).sin() + (ratio * t).cos() - level;
        let matrix = dmatrix![
            0.0, 1.0, 0.0, 0.0;
            -1.0, 0.0, 0.0, 0.0;
            0.0, 0.0, 0.0, ratio;
            0.0, 0.0, -ratio, 0.0
        ];
        let start = [phase.sin(), phase.cos(), 0.0, 1.0];
        let flow = LinearFlow::new(&matrix, &[0.0; 4], &start, 50.0).unwrap();
        let found = onset(&flow, 0.0, 50.0, |x| x[0] + x[3] - level);
        let scanned = (0..50_000).map(|i| 1e-3 * f64::from(i)).find(|t| margin(*t) >= 0.0);
        match scanned {
            // The search may see a graze that the scan steps over, but never later.
            Some(scanned) => prop_assert!(time_of(found) <= scanned + 1e-9),
            None => prop_assert!(found.is_none_or(|onset| margin(onset.time).abs() < 1e-6)),
        }
    }
}
