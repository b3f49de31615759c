//! Flows with one event or none.

use std::f64::consts::TAU;

use pleach_automaton::{Settings, Why, from};
use pleach_guards::Expression;

use super::Cue::Go;
use super::Place::{Here, There};
use super::{assert_near, instants, moving, run, x};

/// E. Torricelli 1644: ḣ = −k √h empties a tank in 2 √h₀ ÷ k. The rate has no slope where it is empty:
/// at a level of 10⁻⁶ the tolerance of h, 10⁻⁹, is 2·10⁻⁶ s, and a level below the tolerance is met in doubt.
#[test]
fn torricellis_tank_runs_dry() {
    let [h] = x();
    let dry = |level: f64| {
        let tank = moving([4.0], [-0.5 * h.square_root()]);
        let machine = tank.transition(from(Here).on(Go).to(There).must(h.at_most(level)));
        machine.build().expect("it is sound").run(100.0).expect("it can be run")
    };
    let trajectory = dry(1e-6);
    assert!(trajectory.doubts().is_empty(), "{:?}", trajectory.doubts());
    assert_near(trajectory.jumps()[0].at.t, 8.0 - 4e-3, 2e-6);
    let trajectory = dry(1e-12);
    assert!(trajectory.doubts().iter().any(|doubt| doubt.why == Why::Touch));
    assert_near(trajectory.jumps()[0].at.t, 8.0 - 4e-6, 2e-6);
}

/// A quarter of a pendulum's swing from 1 rad: K(sin² ½), the complete elliptic integral, by mpmath.
#[test]
fn a_pendulum_swings_through_after_an_elliptic_integral() {
    let [angle, speed] = x();
    let rates = [Expression::from(&speed), -angle.sin()];
    let found = instants([1.0, 0.0], rates, angle.at_most(0.0), 20.0);
    let quarter = 1.674_993_916_092_631_4;
    assert_eq!(found.len(), 3);
    for (found, quarters) in found.iter().zip([1.0, 5.0, 9.0]) {
        assert_near(*found, quarters * quarter, 1e-8);
    }
}

/// J. Kepler 1609: the body is back at its periapsis after 2π a^{3/2}, here with a = 1, e = 0.5.
#[test]
fn keplers_planet_returns_to_its_periapsis() {
    let [px, py, vx, vy] = x();
    let cubed = (px.power(2.0) + py.power(2.0)).power(1.5);
    let rates = [Expression::from(&vx), Expression::from(&vy), -&px / &cubed, -&py / &cubed];
    // The distance begins to grow.
    let grows = (&px * &vx + &py * &vy).more_than(0.0);
    let found = instants([0.5, 0.0, 0.0, 3f64.sqrt()], rates, grows, 20.0);
    for (found, turns) in found.iter().skip(usize::from(found[0] < 1.0)).zip([1.0, 2.0, 3.0]) {
        assert_near(*found, turns * TAU, 1e-7);
    }
}

/// P. F. Verhulst 1838: x = 1 ÷ (1 + 9 e⁻ᵗ) reaches 0.9 after ln 81.
#[test]
fn a_logistic_population_reaches_its_bound() {
    let [n] = x();
    let found = instants([0.1], [&n * (1.0 - &n)], n.at_least(0.9), 10.0);
    assert_near(found[0], 81f64.ln(), 1e-8);
}

/// A fall of 100 m with drag g (1 − k v²) has ended after arcosh(e^{g k h}) ÷ (g √k).
#[test]
fn a_fall_with_drag_ends() {
    let [h, v] = x();
    let (g, k) = (9.81, 0.004);
    let rates = [-&v, g * (1.0 - k * v.power(2.0))];
    let found = instants([100.0, 0.0], rates, h.at_most(0.0), 20.0);
    let exact = f64::exp(g * k * 100.0).acosh() / (g * f64::sqrt(k));
    assert_near(found[0], exact, 1e-8);
}

/// W. O. Kermack and A. G. McKendrick 1927 (doi:10.1098/rspa.1927.0118): the infected are most where
/// S = γ ÷ β, and there I = I₀ + S₀ − (γ ÷ β) (1 + ln (β S₀ ÷ γ)).
#[test]
fn an_epidemic_has_its_known_peak() {
    let [s, i] = x();
    let (beta, gamma) = (0.5, 0.2);
    let epidemic = moving([0.99, 0.01], [-beta * &s * &i, beta * &s * &i - gamma * &i]);
    let peak = from(Here).on(Go).to(There).must(s.at_most(gamma / beta));
    let trajectory = run(epidemic.transition(peak), 100.0);
    let infected = trajectory.value("x₂", trajectory.jumps()[0].at.t).expect("the run lasts");
    let ratio: f64 = gamma / beta;
    assert_near(infected, 1.0 - ratio * (1.0 + (0.99 / ratio).ln()), 1e-9);
}

/// L. Lapicque 1907: τ V̇ = −V + R I fires every τ ln (R I ÷ (R I − V_th)).
#[test]
fn a_leaky_neuron_fires_regularly() {
    let [v] = x();
    let neuron = moving([0.0], [(1.5 - &v) / 10.0])
        .transition(from(Here).on(Go).to(Here).must(v.at_least(1.0)).then(v.becomes(0.0)));
    let trajectory = run(neuron, 1000.0);
    let period = 10.0 * 3f64.ln();
    assert_eq!(trajectory.jumps().len(), (1000.0 / period) as usize);
    for (spike, count) in trajectory.jumps().iter().zip(1..) {
        assert_near(spike.at.t, f64::from(count) * period, 1e-11);
    }
}

/// B. Ermentrout 1996 (doi:10.1162/neco.1996.8.5.979): ẋ = x² + I goes from −R to R in
/// 2 arctan (R ÷ √I) ÷ √I.
#[test]
fn a_quadratic_neuron_fires_regularly() {
    let [v] = x();
    let neuron = moving([-20.0], [v.power(2.0) + 0.25])
        .transition(from(Here).on(Go).to(Here).must(v.at_least(20.0)).then(v.becomes(-20.0)));
    let trajectory = run(neuron, 100.0);
    let period = 4.0 * 40f64.atan();
    for (spike, count) in trajectory.jumps().iter().zip(1..) {
        assert_near(spike.at.t, f64::from(count) * period, 1e-7);
    }
    assert_eq!(trajectory.jumps().len(), (100.0 / period) as usize);
}

/// B. van der Pol 1926: with μ = 1 the period is 6.663 286 859 323 130 (A. A. Andersen and J. F. Geer
/// 1982, doi:10.1137/0142047, and many since). From the limit cycle's largest x on, 2.008 619 860 874.
#[test]
fn van_der_pols_oscillator_keeps_its_period() {
    let [p, v] = x();
    let rates = [Expression::from(&v), (1.0 - p.power(2.0)) * &v - &p];
    let found = instants([2.008_619_860_874_843, 0.0], rates, p.at_most(0.0), 60.0);
    for pair in found.windows(2) {
        assert_near(pair[1] - pair[0], 6.663_286_859_323_13, 1e-7);
    }
    assert_eq!(found.len(), 9);
}

/// R. F. Arenstorf's orbit of a satellite about the earth and the moon, which closes after 17.065 s
/// (E. Hairer, S. P. Nørsett and G. Wanner, *Solving Ordinary Differential Equations I*, II.0).
#[test]
fn arenstorfs_orbit_closes() {
    let [px, py, vx, vy] = x();
    let moon = 0.012_277_471;
    let earth = 1.0 - moon;
    let cubed = |shift: f64| ((&px + shift).power(2.0) + py.power(2.0)).power(1.5);
    let (near, far) = (cubed(moon), cubed(-earth));
    let rates = [
        Expression::from(&vx),
        Expression::from(&vy),
        &px + 2.0 * &vy - earth * (&px + moon) / &near - moon * (&px - earth) / &far,
        &py - 2.0 * &vx - earth * &py / &near - moon * &py / &far,
    ];
    let start = [0.994, 0.0, 0.0, -2.001_585_106_379_082_4];
    let automaton = moving(start, rates).build().expect("the model is sound");
    let settings =
        Settings { relative_tolerance: 1e-13, absolute_tolerance: 1e-13, ..Settings::default() };
    let period = 17.065_216_560_157_96;
    let trajectory = automaton.run_with(settings, period).expect("it can be run");
    let end = trajectory.values_at(period).expect("the run lasts");
    for (found, exact) in end.iter().zip(start).take(2) {
        assert_near(*found, exact, 1e-5);
    }
}

/// Three bodies of one weight that follow each other along a figure of eight (A. Chenciner and
/// R. Montgomery 2000, doi:10.2307/2661357), with C. Simó's digits: back after 6.325 913 98.
#[test]
fn three_bodies_dance_a_figure_of_eight() {
    let all: [_; 12] = x();
    let (places, speeds) = all.split_at(6);
    let pull = |one: usize, axis: usize| {
        let mut sum = pleach_guards::constant(0.0);
        for other in (0..3).filter(|other| *other != one) {
            let apart = |axis: usize| &places[2 * other + axis] - &places[2 * one + axis];
            let squared = apart(0).power(2.0) + apart(1).power(2.0);
            sum = sum + apart(axis) / squared.power(1.5);
        }
        sum
    };
    let rates = std::array::from_fn(|number| match number.checked_sub(6) {
        None => Expression::from(&speeds[number]),
        Some(number) => pull(number / 2, number % 2),
    });
    let (px, py, vx, vy) = (0.970_004_36, -0.243_087_53, -0.932_407_37, -0.864_731_46);
    let start = [px, py, -px, -py, 0.0, 0.0, -vx / 2.0, -vy / 2.0, -vx / 2.0, -vy / 2.0, vx, vy];
    let end = run(moving(start, rates), 6.325_913_98).values_at(6.325_913_98).expect("it lasts");
    for (found, exact) in end.iter().zip(start) {
        assert_near(*found, exact, 1e-5);
    }
}
