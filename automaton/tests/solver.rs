//! Flows as they are solved, of all kinds beside each other, with closed forms; up to where they cannot be
//! followed.

use std::f64::consts::PI;

use pleach_automaton::{
    Automaton, Composition, Coordinate, Failure, Flow, Name, Reason, Record, Settings, Trajectory,
    coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::{Expression, constant, variable};
use proptest::prelude::*;

use crate::common::body::Cue::{self, Go};
use crate::common::body::Place::{self, Here, There};
use crate::common::body::{Body, assert_near, body, coordinates};

vocabulary! {
    enum Only: Location { Flowing = "flowing" }
    enum Nothing: Event { Never = "never" }
}
coordinates! {
    struct Guide { angle = "φ", wave = "w" }
    struct Reader { heard = "h", sum = "y", grown = "g", way = "l" }
    struct Link { before = "b", here = "x" }
}
use Only::Flowing;

/// With few pieces.
fn run(start: [f64; 2], rates: [Expression; 2], horizon: f64) -> Trajectory {
    let settings = Settings { step_limit: 5000, ..Settings::default() };
    let machine = body(start, rates).build().expect("it is sound");
    machine.run_with(settings, horizon).expect("it can be run")
}

/// A wave that is solved by itself, and a component that adds it up, beside growth and a line.
fn readers(size: f64, frequency: f64) -> Composition {
    let guide = Automaton::<Only, Nothing, Guide>::starting_in(Flowing)
        .initially(Guide { angle: 0.0, wave: 0.0 })
        .flow(
            Flowing,
            Flow::exact("a wave", move |guide: &mut Guide, time| {
                guide.angle += frequency * time;
                guide.wave = size * guide.angle.sin();
            }),
        );
    let Reader { heard, sum, grown, way } = Reader::coordinates();
    let reader = Automaton::<Only, Nothing, Reader>::starting_in(Flowing)
        .initially(Reader { heard: 0.0, sum: size, grown: size, way: 3.0 * size })
        .flow(Flowing, [sum.rate(&heard), grown.rate(0.5 * &grown), way.rate(-2.0 * size)]);
    Composition::builder()
        .add("guide", &guide.build().expect("it is sound"))
        .add("reader", &reader.build().expect("it is sound"))
        .connect("guide.w", "reader.h")
        .build()
        .expect("the parts fit")
}

/// In few pieces, whatever the unit of the values.
#[test]
fn flows_of_all_kinds_in_one_group_are_as_in_closed_form() {
    for size in [1e-3, 1.0, 1e6] {
        for frequency in [0.5, 7.0] {
            let settings = Settings { step_limit: 3000, ..Settings::default() };
            let readers = readers(size, frequency);
            let trajectory = readers.run_with(settings, 8.0).expect("it can be run");
            assert_eq!(trajectory.ending().reason, Reason::Horizon);
            for look in 0..=400 {
                let t = 0.02 * f64::from(look);
                let near = |name: &str, exact: f64, tolerance: f64| {
                    let found = trajectory.value(name, t).expect("the run lasts");
                    assert_near(found, exact, tolerance);
                };
                near("guide.w", size * (frequency * t).sin(), 1e-11 * size);
                let sum = (1.0 - (frequency * t).cos()) / frequency;
                near("reader.y", size * (1.0 + sum), 1e-7 * size.max(0.01));
                near("reader.g", size * (0.5 * t).exp(), 1e-6 * size.max(0.01));
                near("reader.l", size * (3.0 - 2.0 * t), 1e-12 * size);
            }
        }
    }
}

/// Each link of a chain follows the one before it, ẋₙ = xₙ₋₁ − xₙ, so that xₙ = tⁿ e⁻ᵗ ÷ n!. Sixteen are solved
/// by an exponential, up to rounding, and more by an integrator.
#[test]
fn chains_of_decays_are_as_in_closed_form() {
    let Link { before, here } = Link::coordinates();
    let link = |start: f64| {
        let link = Automaton::<Only, Nothing, Link>::starting_in(Flowing);
        let link = link.initially(Link { before: 0.0, here: start });
        link.flow(Flowing, here.rate(&before - &here)).build().expect("it is sound")
    };
    let [first, other] = [link(1.0), link(0.0)];
    for (links, tolerance) in [(2, 1e-15), (16, 1e-14), (17, 1e-7)] {
        let chain = (1..links).fold(Composition::builder().add("0", &first), |chain, number| {
            let output = format!("{}.x", number - 1);
            chain.add(&number.to_string(), &other).connect(&output, &format!("{number}.b"))
        });
        let chain = chain.build().expect("the parts fit");
        let trajectory = chain.run(12.0).expect("it can be run");
        for t in [0.125_f64, 0.7, 1.0, 3.3, 8.0, 12.0] {
            let mut exact = (-t).exp();
            for number in 0..links {
                let found = trajectory.value(&format!("{number}.x"), t).expect("the run lasts");
                assert_near(found, exact, tolerance);
                exact *= t / f64::from(number + 1);
            }
        }
    }
}

/// ẋ = Σ nᵢ − x with 63 numbers that rest: solved by an exponential as well, up to rounding.
#[test]
fn many_constants_beside_a_decay_leave_it_exact() {
    let names: Vec<String> = (1..64).map(|number| format!("n{number}")).collect();
    let numbers = names.iter().map(|name| (name.as_str(), 0.5));
    let state = Record::new(numbers.chain([("x", 0.0)])).expect("the names differ");
    let x = Coordinate::<Record>::new("x");
    let sum = names.iter().fold(-Expression::from(&x), |sum, name| sum + variable(name));
    let only = Name::new("only");
    let decay = Automaton::<Name, Name, Record>::starting_in(only).initially(state);
    let decay = decay.flow(only, x.rate(sum)).build().expect("it is sound");
    let trajectory = decay.run(5.0).expect("it can be run");
    for t in [0.1_f64, 1.0, 5.0] {
        let found = trajectory.value("x", t).expect("the run lasts");
        assert_near(found, 31.5 * (1.0 - (-t).exp()), 1e-13);
    }
}

/// ẋ = y and ẏ = −x, also where they are listed in another order.
#[test]
fn rates_may_be_listed_in_any_order() {
    let [p, s, time] = coordinates();
    let bent = 0.0 * p.power(2.0);
    for first in 0..3 {
        let mut rates = vec![time.rate(1.0), s.rate(-Expression::from(&p)), p.rate(&s + &bent)];
        rates.rotate_left(first);
        let wave = Automaton::<Place, Cue, Body>::starting_in(Here)
            .initially(Body { place: 0.0, speed: 1.0, time: 0.0 })
            .flow(Here, rates);
        let trajectory = wave.build().expect("it is sound").run(3.0).expect("it can be run");
        for (name, exact) in [("p", 3f64.sin()), ("s", 3f64.cos()), ("t", 3.0)] {
            assert_near(trajectory.value(name, 3.0).expect("the run lasts"), exact, 1e-7);
        }
    }
}

/// Formulas that have poles where the state does not come: the whole run is followed, in few steps.
#[test]
fn rates_with_poles_elsewhere_are_followed() {
    let [p, ..] = coordinates();
    let place = || Expression::from(&p);
    type Exact = fn(f64) -> f64;
    let cases: [(f64, Expression, Exact); 7] = [
        (1e-3, 1.0 / place(), |t| (1e-6 + 2.0 * t).sqrt()),
        (1.0, 1.0 / (place() - 2.0), |t| 2.0 - (1.0 + 2.0 * t).sqrt()),
        (0.5, -place() * p.ln(), |t| 0.5f64.powf((-t).exp())),
        (1.5, -p.tan(), |t| (1.5f64.sin() * (-t).exp()).asin()),
        (1.0, p.power(-2.0), |t| (1.0 + 3.0 * t).cbrt()),
        (3.0, 1.0 / (1.0 + p.power(2.0)), |t| {
            // x + x³ ÷ 3 = 12 + t, by Cardano's formula.
            let half = 1.5 * (12.0 + t);
            let root = (half * half + 1.0).sqrt();
            (half + root).cbrt() + (half - root).cbrt()
        }),
        (2.0, -(place() - 1.0) / (place() + 1.0), |t| {
            // x + 2 ln(x − 1) = 2 − t, by Newton's method.
            let mut distance: f64 = 1.0;
            for _ in 0..60 {
                let off = distance + 2.0 * distance.ln() - 1.0 + t;
                distance = (distance - off / (1.0 + 2.0 / distance)).max(0.1 * distance);
            }
            1.0 + distance
        }),
    ];
    for (start, rate, exact) in cases {
        let trajectory = run([start, 0.0], [rate.clone(), 0.0.into()], 10.0);
        assert_eq!(trajectory.ending().reason, Reason::Horizon, "{rate}");
        for look in 1..=100 {
            let t = 0.1 * f64::from(look);
            let found = trajectory.value("p", t).expect("the run lasts");
            assert!((found - exact(t)).abs() < 1e-7, "{rate} at {t}: {found}, {}", exact(t));
        }
    }
}

/// ẋ = −1 ÷ x comes to its pole after x₀² ÷ 2, and ẋ = x² grows without bound after 1 ÷ x₀: the run ends there,
/// and says when, also where the flow begins late.
#[test]
fn flows_end_at_their_singularities_and_say_when() {
    let [p, _, time] = coordinates();
    for (rate, begin, last) in [(-1.0 / &p, 2.0, 2.0), (p.power(2.0), 0.25, 4.0)] {
        for wait in [0.0, 3.0, 1000.0] {
            let go = from(Here).on(Go).to(There).must(time.at_least(wait));
            let machine = body([begin, 0.0], [0.0.into(), 0.0.into()])
                .flow(There, [p.rate(rate.clone()), time.rate(1.0)])
                .transition(go)
                .build()
                .expect("it is sound");
            let trajectory = machine.run(wait + 10.0).expect("it can be run");
            let exact = wait + last;
            assert_near(trajectory.ending().at.t, exact, 1e-6);
            let Reason::Finished(Failure::Flow { locations, reason }) = &trajectory.ending().reason
            else {
                panic!("{:?}", trajectory.ending())
            };
            assert_eq!(locations, "`there` of `automaton`");
            let said = reason.strip_prefix("at ").and_then(|said| said.split_once(" s, "));
            let (time, why) = said.expect("it says when");
            assert_near(time.parse().expect("the time is a number"), exact, 1e-6);
            assert!(!why.is_empty(), "it says why: {reason}");
        }
    }
}

/// A power that is no number between two times, however near to each other these are.
#[test]
fn flows_end_where_a_root_has_no_value() {
    let [_, _, time] = coordinates();
    for (gap, exponent) in [(1e-4, 1.5), (1e-2, 0.5), (1e-7, 0.5)] {
        let rate = ((&time - 5.0).power(2.0) - gap * gap).power(exponent);
        let trajectory = run([0.0; 2], [rate, constant(0.0)], 10.0);
        assert_near(trajectory.ending().at.t, 5.0 - gap, 1e-9);
        assert!(matches!(trajectory.ending().reason, Reason::Finished(Failure::Flow { .. })));
    }
}

/// A level that falls by its root comes to zero, and the tank runs on.
#[test]
fn a_tank_runs_dry() {
    let [p, ..] = coordinates();
    let emptied = run([1.0, 0.0], [-1.0 * p.abs().power(0.5), constant(0.0)], 2.0 - 1e-3);
    assert_eq!(emptied.ending().reason, Reason::Horizon);
    let kept = run([4.0, 0.0], [1.0 - p.power(0.5), constant(0.0)], 40.0);
    assert_eq!(kept.ending().reason, Reason::Horizon);
}

/// What kinks keep from being as exact as smooth flows: nothing. |sin t| grows by 2 in each half turn.
#[test]
fn kinks_of_integrated_waves_add_no_errors() {
    let [p, s, _] = coordinates();
    let bent = 0.0 * s.power(2.0);
    let wave = || body([0.0, 1.0], [&s + &bent, -Expression::from(&p)]);
    let Body { time, .. } = Body::coordinates();
    for turns in [1.0, 10.0, 50.0] {
        let rates = [p.abs(), time.sin().abs()];
        for (number, rate) in rates.into_iter().enumerate() {
            // The wave in a component of its own, and one that adds up.
            let until = turns * PI;
            let found = if number == 0 {
                let Link { before, here } = Link::coordinates();
                let sum = Automaton::<Only, Nothing, Link>::starting_in(Flowing)
                    .initially(Link { before: 0.0, here: 0.0 })
                    .flow(Flowing, here.rate(before.abs()))
                    .build()
                    .expect("it is sound");
                let both = Composition::builder()
                    .add("wave", &wave().build().expect("it is sound"))
                    .add("sum", &sum)
                    .connect("wave.p", "sum.b")
                    .build()
                    .expect("the parts fit");
                both.run(until).expect("it can be run").value("sum.x", until)
            } else {
                run([0.0; 2], [rate, constant(0.0)], until).value("p", until)
            };
            assert_near(found.expect("the run lasts"), 2.0 * turns, 4e-9 * turns);
        }
    }
}

proptest! {
    #![proptest_config(cases::usually(24))]

    /// A spike of a rate, wherever it is and however narrow, adds its width √π, in few steps.
    #[test]
    fn a_spike_adds_its_integral(
        centre in 1.0..99.0_f64,
        power in -5.0..-0.7_f64,
        height in 0.1..10.0_f64,
        size in prop::sample::select(vec![1.0, 1e3]),
        background in prop::sample::select(vec![0.0, 0.1]),
    ) {
        let [_, _, time] = coordinates();
        let width = 10f64.powf(power);
        let spike = (-((&time - centre) / width).power(2.0)).exp();
        let rate = size * (height / width * spike + background);
        let trajectory = run([0.0; 2], [rate, constant(0.0)], 100.0);
        prop_assert_eq!(&trajectory.ending().reason, &Reason::Horizon);
        let found = trajectory.value("p", 100.0).expect("the run lasts");
        let exact = size * (height * PI.sqrt() + 100.0 * background);
        prop_assert!((found - exact).abs() < 1e-4 * exact, "{} is not {}", found, exact);
    }
}

/// Two narrow spikes add their two widths, however far apart they are: the wide range of exponents for which
/// an exponential is 0 is no reason to look at a span more closely.
#[test]
fn two_spikes_add_both_integrals() {
    for (width, centres) in [(3.6e-4, [1.0, 60.0]), (1e-3, [20.0, 21.0]), (2e-5, [33.3, 99.0])] {
        let [_, _, time] = coordinates();
        let spike = |centre: f64| (-((&time - centre) / width).power(2.0)).exp();
        let rate = centres.map(|centre| spike(centre) / width).into_iter().sum::<Expression>();
        let trajectory = run([0.0; 2], [rate, constant(0.0)], 100.0);
        assert_eq!(trajectory.ending().reason, Reason::Horizon, "{centres:?}");
        let found = trajectory.value("p", 100.0).expect("the run lasts");
        let exact = 2.0 * PI.sqrt();
        assert!((found - exact).abs() < 1e-4 * exact, "{centres:?}: {found} is not {exact}");
    }
}

/// A pulse whose ends are rounded by roots: its integral is the product of its height and its width.
#[test]
fn pulses_of_roots_are_seen() {
    let [_, _, time] = coordinates();
    let bend = |centre: f64| ((&time - centre).power(2.0) + 1e-12).power(0.5);
    let pulse = 1e4 * (bend(5.01) + bend(4.99) - 2.0 * bend(5.0));
    let found = run([0.0; 2], [pulse, constant(0.0)], 10.0).value("p", 10.0);
    assert_near(found.expect("the run lasts"), 2.0, 1e-4);
}

/// A spike costs few steps wherever it is, and none if it is too small to matter.
#[test]
fn spikes_cost_few_steps() {
    let [_, _, time] = coordinates();
    for width in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
        for centre in [1.0, 33.3, 60.0, 99.0] {
            let spike = (-((&time - centre) / width).power(2.0)).exp();
            for (height, step_limit) in [(1.0 / width, 60), (1e-10, 12), (1e-14, 12)] {
                let rates = [height * &spike + 0.1, constant(0.0)];
                let machine = body([0.0; 2], rates).build().expect("it is sound");
                let settings = Settings { step_limit, ..Settings::default() };
                let trajectory = machine.run_with(settings, 100.0).expect("it can be run");
                let reason = &trajectory.ending().reason;
                assert_eq!(reason, &Reason::Horizon, "{height} at {centre} for {width}");
            }
        }
    }
}

/// Flows are solved up to the horizon and not beyond it, also after a jump.
#[test]
fn a_jump_costs_hardly_any_steps() {
    let [p, _, time] = coordinates();
    let rates = || [p.rate(time.sin()), time.rate(1.0)];
    let still = || body([0.0; 2], [time.sin(), constant(0.0)]).flow(There, rates());
    let jumping = still().transition(from(Here).on(Go).to(There).must(time.at_least(50.0)));
    let is_enough = |machine: &Automaton<Place, Cue, Body>, step_limit: u64| {
        let settings = Settings { step_limit, ..Settings::default() };
        let trajectory = machine.run_with(settings, 100.0).expect("it can be run");
        trajectory.ending().reason == Reason::Horizon
    };
    let [still, jumping] = [still(), jumping].map(|parts| parts.build().expect("it is sound"));
    let needed = (0..1000).step_by(20).find(|&steps| is_enough(&still, steps));
    let needed = needed.expect("it comes to its horizon");
    assert!(needed > 100 && is_enough(&jumping, needed + 40), "{needed}");
}
