//! Loops and devices of control engineering, each against a closed form or a dense scan of one.

use std::array::from_fn;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use pleach_automaton::{Automaton, Composition, Edge, Reason, from};
use pleach_guards::{Expression, Predicate, Table, constant, maximum, minimum};

use super::Cue::{Back, Go};
use super::Place::{Here, There};
use super::{Cue, Place, State, assert_near, flow, instants, moving, run, x};

/// Where a function first is at least 0, looked at in steps that are short beside its changes.
fn first_root(start: f64, step: f64, function: impl Fn(f64) -> f64) -> f64 {
    let mut high = start;
    while function(high) < 0.0 {
        high += step;
    }
    let mut low = high - step;
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if function(middle) < 0.0 { low = middle } else { high = middle }
    }
    high
}

/// The event of a guard that has to be taken.
fn first<const N: usize>(
    start: [f64; N],
    rates: [Expression; N],
    guard: Predicate,
    horizon: f64,
) -> f64 {
    let trajectory = run(moving(start, rates).transition(go(guard)), horizon);
    let first = trajectory.jumps().first();
    first.unwrap_or_else(|| panic!("no event: {:?}", trajectory.ending())).at.t
}

fn go<const N: usize>(guard: Predicate) -> Edge<Place, Cue, State<N>> {
    from(Here).on(Go).to(There).must(guard)
}

/// Natural sampling: a slow wave is compared with a triangle of 10 Hz, twice in each of its periods.
#[test]
fn a_modulator_switches_where_its_carrier_meets_the_signal() {
    let [t] = x::<1>();
    let carrier = 4.0 * (10.0 * &t - (10.0 * &t + 0.5).floor()).abs() - 1.0;
    let signal = 0.8 * (0.5 * &t).sin();
    let model = moving([0.0], [1.0.into()]).flow(There, flow([1.0.into()]));
    let (is_above, is_below) =
        ((&signal - &carrier).at_most(0.0), (signal - carrier).more_than(0.0));
    let back = from(There).on(Back).to(Here).must(is_below);
    let model = model.transition(go(is_above)).transition(back).build().expect("it is sound");
    let trajectory = model.run(20.0).expect("it can be run");
    // Where the floor jumps, on both sides of the peak, rounding hides which side it is.
    for doubt in trajectory.doubts() {
        let peak = 0.1 * (10.0 * doubt.from).floor() + 0.05;
        assert!(doubt.to - doubt.from < 1e-11 && (doubt.from - peak).abs() < 1e-11, "{doubt}");
    }
    let rises = trajectory.jumps().iter().filter(|jump| jump.label == "go");
    let found: Vec<f64> = rises.map(|jump| jump.at.t).collect();
    // The triangle rises from −1 to 1 in the first half of each period.
    let exact = |period: i32| {
        let begin = 0.1 * f64::from(period);
        let apart = move |t: f64| 40.0 * (t - begin) - 1.0 - 0.8 * (0.5 * t).sin();
        first_root(begin, 1e-3, apart)
    };
    assert_eq!(found.len(), 200);
    found.iter().zip(0..).for_each(|(found, period)| assert_near(*found, exact(period), 1e-12));
}

/// Two waves of nearly one frequency are at their peaks together, for a moment.
#[test]
fn peaks_that_coincide_are_met() {
    let [a, b, c, d] = x::<4>();
    let rates = [7.0 * &b, -7.0 * &a, 7.1 * &d, -7.1 * &c];
    let both = a.at_least(0.9999) & c.at_least(0.9999);
    let found = instants([0.0, 1.0, 0.0, 1.0], rates, both, 150.0);
    let angle = 0.9999f64.asin();
    let peaks = |speed: f64| {
        let peak = move |turn: i32| {
            let turns = TAU * f64::from(turn);
            ((turns + angle) / speed, (turns + PI - angle) / speed)
        };
        (0..200).map(peak)
    };
    let exact: Vec<f64> = peaks(7.0)
        .flat_map(|one| peaks(7.1).map(move |other| (one.0.max(other.0), one.1.min(other.1))))
        .filter(|(begin, end)| begin < end && *begin < 150.0)
        .map(|(begin, _)| begin)
        .collect();
    assert!(found.len() == exact.len() && found.len() > 2, "{found:?} {exact:?}");
    found.iter().zip(exact).for_each(|(found, exact)| assert_near(*found, exact, 1e-11));
}

/// P. L. Chebyshev's polynomial of degree 16 by its recursion: it is cos 16 θ at cos θ.
#[test]
fn a_polynomial_of_high_degree_passes_its_level_eight_times() {
    let [t] = x::<1>();
    let (mut before, mut last) = (constant(1.0), Expression::from(&t));
    for _ in 1..16 {
        let next = 2.0 * &t * last.clone() - before;
        (before, last) = (last, next);
    }
    let found = instants([-1.0], [1.0.into()], last.at_least(0.5), 2.0);
    let exact = (0..8).rev().map(|turn| 1.0 + ((TAU * f64::from(turn) + PI / 3.0) / 16.0).cos());
    // It is 1 at the start.
    assert_eq!(found.len(), 9, "{found:?}");
    assert_eq!(found[0], 0.0);
    found[1..].iter().zip(exact).for_each(|(found, exact)| assert_near(*found, exact, 1e-12));
}

/// p̈ = ½ cos 2t − p, at rest at −1/6, is −⅙ cos 2t: a wall a little inside its amplitude is hit, one a
/// little outside is not.
#[test]
fn an_oscillator_that_barely_reaches_a_wall_hits_it() {
    let [p, v, c, s] = x::<4>();
    let wall = |gap: f64| {
        let rates = [Expression::from(&v), 0.5 * &c - &p, -2.0 * &s, 2.0 * &c];
        let hit = go(p.at_least(1.0 / 6.0 + gap) & v.at_least(-1.0));
        let start = [-1.0 / 6.0, 0.0, 1.0, 0.0];
        run(moving(start, rates).transition(hit), 2.0).jumps().first().map(|jump| jump.at.t)
    };
    for gap in [1e-3, 1e-6, 1e-9] {
        let found = wall(-gap).expect("it is inside");
        assert_near(found, FRAC_PI_2 - 0.5 * (1.0 - 6.0 * gap).acos(), 1e-10);
        assert_eq!(wall(gap), None);
    }
}

/// p̈ = sat (−4 p − 2 ṗ) from 10: full force up to a parabola's root, then a decaying swing.
#[test]
fn an_actuator_leaves_its_limit_where_it_should() {
    let [p, v] = x::<2>();
    let force = (-4.0 * &p - 2.0 * &v).min(1.0).max(-1.0);
    let trajectory = run(moving([10.0, 0.0], [Expression::from(&v), force]), 20.0);
    let at = |t: f64| trajectory.values_at(t).expect("the run lasts");
    let leaves = 0.5 * (79f64.sqrt() - 1.0);
    let (place, speed) = (10.0 - 0.5 * leaves * leaves, -leaves);
    assert_near(at(leaves)[0], place, 1e-8);
    assert_near(at(leaves)[1], speed, 1e-8);
    let omega = 3f64.sqrt();
    let swing = |t: f64| {
        let (sine, cosine) = (omega * t).sin_cos();
        let amplitude = (speed + place) / omega;
        let p = (-t).exp() * (place * cosine + amplitude * sine);
        let v = -p + (-t).exp() * omega * (amplitude * cosine - place * sine);
        [p, v]
    };
    let reaches = first_root(0.0, 1e-3, |t| -4.0 * swing(t)[0] - 2.0 * swing(t)[1] - 1.0);
    let [p, v] = swing(reaches);
    assert_near(at(leaves + reaches)[0], p, 1e-8);
    assert_near(at(leaves + reaches)[1], v, 1e-8);
}

/// ẋ = −(⌊x⌋ + ½) from 5.5: half a second for each cell and its number, up to 0, where both sides lead.
#[test]
fn a_quantised_feedback_ends_at_the_edge_of_its_cell() {
    let [p] = x::<1>();
    let trajectory = run(moving([5.5], [-(p.floor() + 0.5)]), 100.0);
    let cells: f64 = (0..5).map(|cell| 1.0 / (f64::from(cell) + 0.5)).sum();
    assert_near(trajectory.ending().at.t, 0.5 / 5.5 + cells, 1e-8);
    assert!(matches!(trajectory.ending().reason, Reason::Finished(_)));
}

/// A valve opens by steps of the level.
#[test]
fn a_tank_drains_by_the_steps_of_its_valve() {
    let [level] = x::<1>();
    let valve = Table::steps([(0.0, 0.5), (1.0, 1.0), (2.0, 3.0)]).expect("in order");
    let empty = first([3.0], [-valve.at(&level)], level.at_most(0.25), 10.0);
    assert_near(empty, 1.0 / 3.0 + 1.0 + 1.5, 1e-9);
}

/// Three that take a label together: one has to, and two may while their windows are open.
#[test]
fn a_label_waits_until_all_windows_are_open() {
    let [t] = x::<1>();
    let speeds = [1.0, 2.4495, 3.3166];
    let member = |(speed, has_to): (f64, bool)| {
        let (window, jump) = ((speed * &t).sin().at_least(0.97), from(Here));
        let jump = jump.on(Go).to(There);
        let jump = if has_to { jump.must(window) } else { jump.may(window) };
        moving([0.0], [1.0.into()]).transition(jump).build().expect("it is sound")
    };
    let [one, two, three] = [(speeds[0], true), (speeds[1], false), (speeds[2], false)].map(member);
    let all = Composition::builder().add("a", &one).add("b", &two).add("c", &three).label("go");
    let trajectory = all.build().expect("the parts fit").run(2000.0).expect("it can be run");
    let narrowest =
        |t: f64| speeds.iter().fold(f64::MAX, |least, speed| least.min((speed * t).sin()));
    let exact = first_root(0.0, 1e-3, |t| narrowest(t) - 0.97);
    assert_near(trajectory.jumps()[0].at.t, exact, 1e-11);
}

/// A watch reads a fast wave of another component.
#[test]
fn a_watch_sees_the_peaks_of_another_component() {
    let [c, s] = x::<2>();
    let wave = moving([1.0, 0.0], [-300.0 * &s, 300.0 * &c]).build().expect("it is sound");
    let [t, seen] = x::<2>();
    let watch = Automaton::starting_in(Here)
        .initially(State::from([0.0; 2]))
        .flow(Here, [t.rate(1.0)])
        .transition(go((&seen + 0.01 * &t).at_least(1.02)))
        .build()
        .expect("it is sound");
    let (output, input) = (format!("wave.{}", s.name()), format!("watch.{}", seen.name()));
    let both = Composition::builder().add("wave", &wave).add("watch", &watch);
    let both = both.connect(&output, &input).build().expect("the parts fit");
    let found = both.run(10.0).expect("it can be run").jumps()[0].at.t;
    let exact = first_root(1.9, 1e-5, |t| (300.0 * t).sin() + 0.01 * t - 1.02);
    assert_near(found, exact, 1e-9);
}

/// Six decays, of which the first or the last counts, written in two ways.
#[test]
fn the_least_and_the_most_of_many_decays_are_met() {
    let all = x::<6>();
    let speed = |number: usize| 0.3 * (number as f64 + 1.0);
    let start: [f64; 6] = from_fn(|number| 2f64.powi(number as i32));
    let instant = |number: usize| (start[number] / 0.1).ln() / speed(number);
    let exact = (0..6).map(instant);
    let (earliest, latest) = (exact.clone().fold(f64::MAX, f64::min), exact.fold(0.0, f64::max));
    let meets =
        |guard: Predicate| first(start, from_fn(|one| -speed(one) * &all[one]), guard, 50.0);
    let (parts, low) = (all.iter().map(Expression::from), all.iter().map(|x| x.at_most(0.1)));
    assert_near(meets(minimum(parts.clone()).at_most(0.1)), earliest, 1e-12);
    assert_near(meets(Predicate::any(low.clone())), earliest, 1e-12);
    assert_near(meets(maximum(parts).at_most(0.1)), latest, 1e-12);
    assert_near(meets(Predicate::all(low)), latest, 1e-12);
}

/// Heat in a rod of ten cells with 10⁶ per second between them: its slowest shape decays by itself.
#[test]
fn the_slowest_shape_of_heat_decays_at_its_rate() {
    let all = x::<10>();
    let cell = |number: usize| all.get(number).map_or(constant(0.0), Expression::from);
    let rates: [Expression; 10] =
        from_fn(|i| 1e6 * (cell(i.wrapping_sub(1)) + cell(i + 1) - 2.0 * cell(i)));
    let shape: [f64; 10] = from_fn(|i| (PI * (i as f64 + 1.0) / 11.0).sin());
    let decay = 4e6 * (PI / 22.0).sin().powi(2);
    let found = first(shape, rates, all[4].at_most(0.01), 1.0);
    assert_near(found, (shape[4] / 0.01).ln() / decay, 1e-16);
}

/// A thermostat without hysteresis slides along its temperature.
#[test]
fn a_thermostat_without_hysteresis_slides() {
    let [p] = x::<1>();
    let warms = moving([15.0], [0.1 * (30.0 - &p)]).flow(There, flow([-0.1 * &p]));
    let cools = from(There).on(Back).to(Here).must(p.at_most(20.0));
    let trajectory = run(warms.transition(go(p.at_least(20.0))).transition(cools), 100.0);
    assert!(matches!(trajectory.ending().reason, Reason::Sliding(_)));
    assert_near(trajectory.ending().at.t, 10.0 * 1.5f64.ln(), 1e-9);
}

/// A plant that is sampled every tenth of a second, and kicked every quarter: against the recursion.
#[test]
fn a_plant_with_two_clocks_follows_its_recursion() {
    let [p, u, a, b] = x::<4>();
    let again = || from(Here).on(Go).to(Here);
    let sample = [u.becomes(-0.5 * &p), a.becomes(0.0)];
    let kick = [p.becomes(&p + 0.1), b.becomes(0.0)];
    let plant = moving([1.0, 0.0, 0.0, 0.0], [-&p + &u, 0.0.into(), 1.0.into(), 1.0.into()])
        .transition(again().must(a.at_least(0.1)).then(sample))
        .transition(again().must(b.at_least(0.25)).then(kick));
    let trajectory = run(plant, 10.0);
    assert_eq!(trajectory.jumps().len(), 100 + 40);
    let (mut state, mut input, mut last) = (1.0, 0.0, 0);
    for hundredth in (0..=1000).filter(|one| one % 10 == 0 || one % 25 == 0).skip(1) {
        let decay = (-0.01 * f64::from(hundredth - last)).exp();
        (state, last) = (input + (state - input) * decay, hundredth);
        // A tenth is no number: of ticks that seem to be at once the quarter's comes first.
        state += if hundredth % 25 == 0 { 0.1 } else { 0.0 };
        input = if hundredth % 10 == 0 { -0.5 * state } else { input };
    }
    assert_near(trajectory.values_at(10.0).expect("the run lasts")[0], state, 1e-12);
}
