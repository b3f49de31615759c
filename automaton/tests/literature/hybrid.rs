//! Flows and jumps.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_8, PI};

use pleach_automaton::{Automaton, Reason, Vector, from};
use pleach_guards::{Expression, constant};

use super::Cue::{Back, Go};
use super::Place::{Here, There};
use super::{assert_near, flow, moving, run, x};

/// The classical thermostat (R. Alur et al. 1995, doi:10.1016/0304-3975(94)00202-T): heated towards 30
/// and cooled towards 0 at rate K it takes ln (11 ÷ 7) ÷ K up and ln (23 ÷ 19) ÷ K down.
#[test]
fn a_thermostat_has_its_period() {
    let [t] = x();
    let rate = 0.1;
    let room = moving([19.0], [rate * (30.0 - &t)])
        .flow(There, flow([-rate * &t]))
        .transition(from(Here).on(Go).to(There).must(t.at_least(23.0)))
        .transition(from(There).on(Back).to(Here).must(t.at_most(19.0)));
    let trajectory = run(room, 200.0);
    let (up, down) = ((11.0 / 7.0_f64).ln() / rate, (23.0 / 19.0_f64).ln() / rate);
    for (jump, number) in trajectory.jumps().iter().zip(1..) {
        let (ups, downs) = ((number + 1) / 2, number / 2);
        assert_near(jump.at.t, f64::from(ups) * up + f64::from(downs) * down, 1e-11);
    }
}

/// A mass on a spring, x = −cos t, whose speed a wall at ½ turns: the first impact is at 2π ÷ 3, and the
/// others come every 4π ÷ 3.
#[test]
fn a_spring_hits_its_wall() {
    let [p, v] = x();
    let mass = moving([-1.0, 0.0], [Expression::from(&v), -&p]).transition(
        from(Here)
            .on(Go)
            .to(Here)
            .must(p.at_least(0.5) & v.more_than(0.0))
            .then(v.becomes(-1.0 * &v)),
    );
    let trajectory = run(mass, 50.0);
    let first = FRAC_PI_2 + PI / 6.0;
    for (impact, number) in trajectory.jumps().iter().zip(0..) {
        assert_near(impact.at.t, first + f64::from(number) * 2.0 * first, 1e-11);
    }
}

/// G. Galperin 2003 (doi:10.1070/RD2003v008n04ABEH000252): a ball that is 100ⁿ times as heavy as another
/// one drives it against a wall. Their collisions and those with the wall spell digits of π.
#[test]
fn colliding_balls_count_the_digits_of_pi() {
    for (digits, collisions) in [(0, 3), (1, 31), (2, 314), (3, 3141), (4, 31415)] {
        let heavy = 100f64.powi(digits);
        let [light, speed, other, other_speed] = x();
        let total = 1.0 + heavy;
        let balls = moving(
            [1.0, 0.0, 2.0, -1.0],
            [
                Expression::from(&speed),
                constant(0.0),
                Expression::from(&other_speed),
                constant(0.0),
            ],
        )
        .transition(
            from(Here)
                .on(Go)
                .to(Here)
                .must(light.at_least(&other) & speed.more_than(&other_speed))
                .then([
                    speed.becomes(((1.0 - heavy) * &speed + 2.0 * heavy * &other_speed) / total),
                    other_speed.becomes((2.0 * &speed + (heavy - 1.0) * &other_speed) / total),
                ]),
        )
        .transition(
            from(Here)
                .on(Back)
                .to(Here)
                .must(light.at_most(0.0) & speed.less_than(0.0))
                .then(speed.becomes(-1.0 * &speed)),
        );
        let trajectory = run(balls, 1e3);
        assert_eq!(trajectory.ending().reason, Reason::Horizon);
        assert_eq!(trajectory.jumps().len(), collisions);
    }
}

/// T. McGeer 1990 (doi:10.1177/027836499000900206): a wheel of spokes that rolls down a slope loses speed
/// at every impact and comes to one gait. Its speed after an impact is 2 √(sin γ sin α) cot 2α; the time of
/// a step is an elliptic integral, by mpmath.
#[test]
fn a_rimless_wheel_finds_its_gait() {
    let (half, slope) = (FRAC_PI_8, 0.08);
    let [angle, speed] = x();
    let wheel = moving([slope - half, 0.5], [Expression::from(&speed), angle.sin()]).transition(
        from(Here)
            .on(Go)
            .to(Here)
            .must(angle.at_least(slope + half))
            .then([angle.becomes(slope - half), speed.becomes(f64::cos(2.0 * half) * &speed)]),
    );
    let trajectory = run(wheel, 150.0);
    let impacts = trajectory.jumps();
    let last = impacts.len() - 1;
    assert_near(impacts[last].at.t - impacts[last - 1].at.t, 3.240_305_138_998_394, 1e-7);
    let speed = trajectory.value("x₂", impacts[last].at.t).expect("the run lasts");
    assert_near(speed, 0.349_754_367_432_509_5, 1e-8);
}

/// A relay with hysteresis 0.1 around 1 ÷ (s + 1)³ swings with a half period that solves an equation in
/// exponentials (K. J. Åström 1995, doi:10.1007/978-1-4757-2516-6_1), by mpmath.
#[test]
fn a_relay_swings_with_its_period() {
    let [first, second, third] = x();
    let rates = |input: f64| [&second - &first, &third - &second, input - &third];
    let relay = moving([0.0, 0.0, 0.3], rates(1.0))
        .flow(There, flow(rates(-1.0)))
        .transition(from(Here).on(Go).to(There).must(first.at_least(0.1)))
        .transition(from(There).on(Back).to(Here).must(first.at_most(-0.1)));
    let trajectory = run(relay, 200.0);
    let last = trajectory.jumps().len() - 1;
    let (one, other) = (trajectory.jumps()[last - 1].at.t, trajectory.jumps()[last].at.t);
    assert_near(other - one, 2.393_835_971_022_703, 1e-12);
    let state = trajectory.values_at(other).expect("the run lasts");
    for (found, exact) in state.iter().zip([0.1, 0.465_748_383_336_248_3, 0.832_712_112_363_676_4])
    {
        assert_near(found.abs(), exact, 1e-12);
    }
}

/// A boost converter at a fixed duty: its periodic current and voltage are the solution of a linear
/// equation of matrix exponentials, by mpmath.
#[test]
fn a_boost_converter_comes_to_its_ripple() {
    let (inductance, capacity, load, source) = (1e-3, 1e-4, 20.0, 10.0);
    let [current, voltage, clock] = x();
    let fades = || -1.0 * &voltage / (load * capacity);
    let on = [constant(source / inductance), fades(), constant(1.0)];
    let off = [(source - &voltage) / inductance, &current / capacity + fades(), constant(1.0)];
    let converter = moving([0.0, 0.0, 0.0], on)
        .flow(There, flow(off))
        .transition(from(Here).on(Go).to(There).must(clock.at_least(0.4e-4)))
        .transition(
            from(There).on(Back).to(Here).must(clock.at_least(1e-4)).then(clock.becomes(0.0)),
        );
    let trajectory = run(converter, 0.1);
    let ends: Vec<_> = trajectory.jumps().iter().filter(|jump| jump.label == "back").collect();
    assert_eq!(ends.len(), 1000);
    let state = trajectory.values_at(ends[998].at.t).expect("the run lasts");
    assert_near(state[0], 1.186_510_662_048_789, 1e-9);
    assert_near(state[1], 16.812_274_374_997_517, 1e-9);
    let peak = trajectory.value("x₁", ends[998].at.t + 0.4e-4).expect("the run lasts");
    assert_near(peak, 1.586_510_662_048_789, 1e-9);
}

/// E. Fermi's accelerator (S. Ulam 1961): a ball between a wall and one that moves by 0.1 sin t; its
/// impacts are roots of transcendental equations, by mpmath.
#[test]
fn a_ball_between_a_wall_and_a_moving_one() {
    const IMPACTS: [f64; 12] = [
        0.552_479_986_906_570_4,
        1.820_902_774_769_030_6,
        3.038_482_549_971_658,
        4.020_595_872_118_873,
        4.897_147_227_496_969,
        5.806_165_974_489_787,
        6.870_110_115_768_935,
        8.148_705_992_142_371,
        9.367_182_350_849_424,
        10.348_322_226_086_613,
        11.228_938_438_751_563,
        12.151_163_946_384_312,
    ];
    let [place, speed, time] = x();
    let wall = 1.0 + 0.1 * time.sin();
    let drift = 0.1 * time.cos();
    let accelerator =
        moving([0.5, 1.0, 0.0], [Expression::from(&speed), constant(0.0), constant(1.0)])
            .transition(
                from(Here)
                    .on(Go)
                    .to(Here)
                    .must(place.at_least(wall) & speed.more_than(drift.clone()))
                    .then(speed.becomes(2.0 * drift - &speed)),
            )
            .transition(
                from(Here)
                    .on(Back)
                    .to(Here)
                    .must(place.at_most(0.0) & speed.less_than(0.0))
                    .then(speed.becomes(-1.0 * &speed)),
            );
    let trajectory = run(accelerator, 12.5);
    assert_eq!(trajectory.jumps().len(), IMPACTS.len());
    for (impact, exact) in trajectory.jumps().iter().zip(IMPACTS) {
        assert_near(impact.at.t, exact, 1e-12);
    }
}

/// The fastest way of a double integrator to rest: full thrust one way, and the other way from the curve
/// p = −v |v| ÷ 2 on (A. A. Feldbaum 1953). From (p, v) above it takes v + 2 √(p + v² ÷ 2).
#[test]
fn the_fastest_way_to_rest_switches_on_its_curve() {
    let [place, speed] = x();
    let brakes = || speed.at_most(0.0) & place.at_most(0.5 * speed.power(2.0));
    for (p, v) in [(1.0, 0.0), (2.0, 1.0), (0.3, -0.2)] {
        let pushed = |thrust: f64| [Expression::from(&speed), constant(thrust)];
        let craft: pleach_automaton::Builder<_, _, Vector<2>> = Automaton::starting_in(Here)
            .initially(Vector::from([p, v]))
            .flow(Here, flow(pushed(-1.0)));
        let craft = craft
            .flow(There, flow(pushed(1.0)))
            .invariant(There, speed.at_most(0.0))
            .transition(from(Here).on(Go).to(There).must(brakes()));
        let trajectory = run(craft, 20.0);
        assert_eq!(trajectory.ending().reason, Reason::Blocked);
        let rest = trajectory.ending().at.t;
        assert_near(rest, v + 2.0 * (p + 0.5 * v * v).sqrt(), 1e-12);
        assert_near(trajectory.value("x₁", rest).expect("the run lasts"), 0.0, 1e-12);
    }
}
