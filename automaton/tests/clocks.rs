//! Clocks of components that others interrupt: their values and events, against fractions.

use num_rational::BigRational;
use pleach_automaton::{Automaton, Composition, coordinates, from};
use pleach_discrete::vocabulary;
use pleach_guards::{Expression, always};

vocabulary! {
    enum Stage: Location { Before = "before", After = "after" }
    enum Turn: Event { Go = "go" }
    enum Place: Location { Running = "running" }
    enum Cue: Event { Sample = "sample" }
}
coordinates! {
    struct Plant { level = "x", time = "t", pace = "s" }
    struct Counter { input = "y", count = "n" }
}
use {Cue::Sample, Place::Running, Stage::After, Stage::Before, Turn::Go};

const PERIOD: f64 = 0.01;

/// A plant that goes on when its clock t comes to `gate`, and a counter that reads it at its samples. The rate of s is
/// −0.3 before, and 0.7 afterwards.
fn gated(gate: f64, rate: impl Fn(&Expression) -> Expression) -> Composition {
    let Plant { level, time, pace } = Plant::coordinates();
    let flow = |slope: f64| [level.rate(rate(&(1.0 * &level))), time.rate(1), pace.rate(slope)];
    let plant = Automaton::starting_in(Before)
        .initially(Plant { level: 1.0, time: 0.0, pace: 0.0 })
        .flow(Before, flow(-0.3))
        .flow(After, flow(0.7))
        .transition(from(Before).on(Go).to(After).must(time.at_least(gate)))
        .build()
        .expect("it is sound");
    let Counter { input, count } = Counter::coordinates();
    let counts = from(Running).on(Sample).to(Running).may(always());
    let counter = Automaton::starting_in(Running)
        .initially(Counter { input: 0.0, count: 0.0 })
        .transition(counts.then(count.becomes(&count + 1.0 + 0.0 * &input)))
        .build()
        .expect("it is sound");
    Composition::builder()
        .add("plant", &plant)
        .add("counter", &counter)
        .connect("plant.x", "counter.y")
        .every("counter.sample", PERIOD)
        .build()
        .expect("they fit together")
}

fn fraction(number: f64) -> BigRational {
    BigRational::from_float(number).expect("it is finite")
}

fn is_nearest(number: f64, exact: &BigRational) -> bool {
    let distance = |other: f64| {
        let apart = fraction(other) - exact;
        if apart < fraction(0.0) { -apart } else { apart }
    };
    [number.next_up(), number.next_down()]
        .into_iter()
        .all(|other| distance(number) <= distance(other))
}

/// All samples and the event in their exact order, each at the number nearest to its instant, and the clocks there.
fn check(gate: f64, rate: impl Fn(&Expression) -> Expression) {
    let run = gated(gate, rate).run(gate + 0.125).expect("it runs");
    let (period, gate) = (fraction(PERIOD), fraction(gate));
    let (mut sample, mut has_gone) = (fraction(0.0), false);
    let next = run.jumps().iter().skip(1).map(|jump| jump.at.t).chain([f64::INFINITY]);
    for (jump, next) in run.jumps().iter().zip(next) {
        let goes = !has_gone && gate < sample;
        has_gone |= goes;
        assert_eq!(jump.label == "go", goes, "{} at {}", jump.label, jump.at.t);
        let at = if goes { &gate } else { &sample };
        let past = if has_gone { at - &gate } else { fraction(0.0) };
        let pace = &past - (at - &past) * fraction(0.3) - &past * (fraction(1.0) - fraction(0.7));
        assert!(is_nearest(jump.at.t, at), "{} at {}", jump.label, jump.at.t);
        // Of several jumps at one number the run gives the values at the last.
        if next > jump.at.t {
            for (variable, exact) in [("plant.t", at), ("plant.s", &pace)] {
                let value = run.value(variable, jump.at.t).expect("it is there");
                assert!(is_nearest(value, exact), "{variable} = {value} at {}", jump.at.t);
            }
        }
        if !goes {
            sample += &period;
        }
    }
    assert!(has_gone && sample > gate);
}

/// Whether the flow beside them is a line, linear or integrated.
#[test]
fn clocks_that_others_interrupt_do_not_drift() {
    for gate in [1.0, 10.0, 100.0] {
        check(gate, |_| 0.0.into());
        check(gate, |x| -1.0 * x);
    }
    check(1000.0, |_| 0.0.into());
    check(10.0, |x| -1.0 * x.power(3.0));
}
