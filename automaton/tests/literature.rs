//! Models of the literature, each with an answer that is known from elsewhere: a closed form, or
//! digits that are published.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use pleach_automaton::{
    Automaton, Builder, Coordinate, Coordinates, Flow, Reason, Settings, Trajectory, Vector, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::{Expression, Predicate, constant};

vocabulary! {
    enum Place: Location { Here = "here", There = "there" }
    enum Cue: Event { Go = "go", Back = "back" }
}
use Cue::{Back, Go};
use Place::{Here, There};

type State<const N: usize> = Vector<N>;

fn x<const N: usize>() -> [Coordinate<State<N>>; N] {
    State::<N>::coordinates()
}

/// A flow from a state on, with the rates of all coordinates in order.
fn moving<const N: usize>(
    start: [f64; N],
    rates: [Expression; N],
) -> Builder<Place, Cue, State<N>> {
    Automaton::starting_in(Here).initially(State::from(start)).flow(Here, flow(rates))
}

fn flow<const N: usize>(rates: [Expression; N]) -> Flow<State<N>> {
    let rates = x::<N>().into_iter().zip(rates).map(|(x, rate)| x.rate(rate));
    rates.collect::<Vec<_>>().into()
}

fn run<S: Coordinates>(model: Builder<Place, Cue, S>, horizon: f64) -> Trajectory {
    let automaton = model.build().expect("the model is sound");
    let trajectory = automaton.run(horizon).expect("it can be run");
    assert!(trajectory.doubts().is_empty(), "{:?}", trajectory.doubts());
    trajectory
}

/// The instants at which a condition comes to hold, while the flow goes on.
fn instants<const N: usize>(
    start: [f64; N],
    rates: [Expression; N],
    condition: Predicate,
    horizon: f64,
) -> Vec<f64> {
    let there = from(Here).on(Go).to(There).must(condition.clone());
    let back = from(There).on(Back).to(Here).must(!condition);
    let model = moving(start, rates.clone()).flow(There, flow(rates));
    let trajectory = run(model.transition(there).transition(back), horizon);
    let comes = trajectory.jumps().iter().filter(|jump| jump.label == "go");
    comes.map(|jump| jump.at.t).collect()
}

fn assert_near(found: f64, exact: f64, tolerance: f64) {
    assert!((found - exact).abs() < tolerance, "{found} is not {exact}");
}

/// E. Torricelli 1644: ḣ = −k √h empties a tank in 2 √h₀ ÷ k. The rate has no slope where it is empty.
#[test]
fn torricellis_tank_runs_dry() {
    let [h] = x();
    let tank = moving([4.0], [-0.5 * h.square_root()]);
    let dry = tank.transition(from(Here).on(Go).to(There).must(h.at_most(1e-12)));
    let found = run(dry, 100.0).jumps()[0].at.t;
    assert_near(found, 8.0 - 4e-6, 1e-7);
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
    let exact = [0.715_827_068_719_394_1, 9.185_534_764_557_338e-6, 0.284_163_745_745_841_3];
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
    assert_near(values[0], 1.706_167_732_170_483, 1e-6);
    assert_near(values[1], -8.928_097_010_247_975e-4, 1e-9);
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
