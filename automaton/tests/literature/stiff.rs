//! Stiff flows.

use pleach_automaton::{Reason, Settings};
use pleach_guards::{Expression, constant};

use super::{assert_near, moving, run, x};

/// H. H. Robertson 1966: the concentrations at t = 40 as E. Hairer and G. Wanner's *Solving Ordinary
/// Differential Equations II* and its test set give them.
#[test]
fn robertsons_reaction_is_where_it_should_be() {
    let [a, b, c] = x();
    let fast = 1e4 * &b * &c;
    let slow = 3e7 * b.power(2.0);
    let rates = [-0.04 * &a + &fast, 0.04 * &a - &fast - &slow, slow.clone()];
    let automaton = moving([1.0, 0.0, 0.0], rates).build().expect("the model is sound");
    let settings = Settings { absolute_tolerance: 1e-14, ..Settings::default() };
    let trajectory = automaton.run_with(settings, 40.0).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    let values = trajectory.values_at(40.0).expect("the run lasts");
    let exact = [0.715_827_068_719_394, 9.185_534_764_557_338e-6, 0.284_163_745_745_841_3];
    for (found, exact) in values.iter().zip(exact) {
        assert_near(*found, exact, 1e-7 * exact);
    }
}

/// B. van der Pol's oscillator with μ = 1000, where it is stiff, as the test set of F. Mazzia and
/// C. Magherini (release 2.4) gives it at t = 2000.
#[test]
fn a_stiff_oscillator_is_where_it_should_be() {
    let [p, v] = x();
    let rates = [Expression::from(&v), 1000.0 * (1.0 - p.power(2.0)) * &v - &p];
    let trajectory = run(moving([2.0, 0.0], rates), 2000.0);
    let values = trajectory.values_at(2000.0).expect("the run lasts");
    assert_near(values[0], 1.706_167_732_170_483, 1e-5);
    assert_near(values[1], -8.928_097_010_247_975e-4, 1e-8);
    let samples: usize = trajectory.intervals().map(|one| one.samples.len()).sum();
    assert!(samples < 3000, "{samples}");
}

/// Mild stiffness: ẋ = −1000 (x − cos t) + …, so that x = cos t. Where explicit steps are as long as
/// stability allows, there are hundreds per second; accuracy allows much longer ones.
#[test]
fn mild_stiffness_is_noticed() {
    let [follower, time] = x();
    let rate = -1000.0 * (&follower - time.cos()) - time.sin();
    let trajectory = run(moving([1.0, 0.0], [rate, constant(1.0)]), 100.0);
    let samples: usize = trajectory.intervals().map(|one| one.samples.len()).sum();
    assert!(samples < 10_000, "{samples}");
    for step in 0..1000 {
        let t = 0.1 * f64::from(step);
        assert_near(trajectory.value("x₁", t).expect("the run lasts"), t.cos(), 1e-7);
    }
}

/// The reaction HIRES (E. Schäfer 1975) at t = 321.8122, by the test set of F. Mazzia and C. Magherini.
#[test]
fn light_and_growth_of_a_plant() {
    let [a, b, c, d, e, f, g, h] = x();
    let meeting = 280.0 * &f * &h;
    let rates = [
        -1.71 * &a + 0.43 * &b + 8.32 * &c + 0.0007,
        1.71 * &a - 8.75 * &b,
        -10.03 * &c + 0.43 * &d + 0.035 * &e,
        8.32 * &b + 1.71 * &c - 1.12 * &d,
        -1.745 * &e + 0.43 * &f + 0.43 * &g,
        -&meeting + 0.69 * &d + 1.71 * &e - 0.43 * &f + 0.69 * &g,
        &meeting - 1.81 * &g,
        -&meeting + 1.81 * &g,
    ];
    let start = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057];
    let end = run(moving(start, rates), 321.8122).values_at(321.8122).expect("the run lasts");
    let exact = [
        0.737_131_257_332_566_8e-3,
        0.144_248_572_631_618_5e-3,
        0.588_872_974_096_757_5e-4,
        0.117_565_134_328_314_9e-2,
        0.238_635_619_883_133_1e-2,
        0.623_896_825_274_279_6e-2,
        0.284_999_839_518_576_9e-2,
        0.285_000_160_481_423_1e-2,
    ];
    for (found, exact) in end.iter().zip(exact) {
        assert_near(*found, exact, 1e-6 * exact);
    }
}

/// The Oregonator (R. J. Field and R. M. Noyes 1974, doi:10.1063/1.1681288) at t = 360, by the same test
/// set.
#[test]
fn an_oscillating_reaction() {
    let [a, b, c] = x();
    let rates = [
        77.27 * (&b + &a * (1.0 - 8.375e-6 * &a - &b)),
        (&c - (1.0 + &a) * &b) / 77.27,
        0.161 * (&a - &c),
    ];
    let end = run(moving([1.0, 2.0, 3.0], rates), 360.0).values_at(360.0).expect("the run lasts");
    let exact = [1.000_814_870_318_523, 1_228.178_521_549_917, 132.055_494_284_670_6];
    for (found, exact) in end.iter().zip(exact) {
        assert_near(*found, exact, 1e-6 * exact);
    }
}
