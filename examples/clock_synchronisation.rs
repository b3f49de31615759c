//! # A clock-synchronisation network of five nodes
//!
//! Every node has a clock that gains or loses up to ρ seconds a second. Whenever its own clock has
//! advanced by another period R, a node ticks, and all nodes take down, each by its own clock, when
//! they hear it. A wait W after its own tick, a node sets its clock so that the *fault-tolerant
//! midpoint* of the five ticks, the middle between the second and the fourth, was the end of the
//! period. So one clock may be far off and does not mislead the others. Nobody is in charge; each
//! node decides by what it hears.
//!
//! The algorithm is that of Lundelius Welch and Lynch, *A new fault-tolerant algorithm for clock
//! synchronization* (1988),
//! [doi:10.1016/0890-5401(88)90043-0](https://doi.org/10.1016/0890-5401%2888%2990043-0), here
//! without delays of messages. The drift of 1e-4 is that of a plain quartz; R = 10 s and W = 0.1 s.
//!
//! The answer is in closed form. Clocks are affine functions of time and midpoints commute with
//! those, so that after each round all clocks agree on one instant, the midpoint of the ticks: the
//! instants of round k are those of round 1, later by k − 1 times R (1/r₂ + 1/r₄)/2, where r₂ and
//! r₄ are the rates of the second and the fourth fastest. Until the fastest clock is set, the
//! fastest and the slowest move apart by 2 ρ (R + W)/(1 + ρ), and never by more.

mod exhibit;

use exhibit::{Exhibit, Shown, instants};
use pleach::prelude::*;
use std::error::Error;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    enum Node: Location { Running = "running", Listening = "listening" }
    enum Action: Event {
        Tick1 = "tick 1", Tick2 = "tick 2", Tick3 = "tick 3", Tick4 = "tick 4", Tick5 = "tick 5",
        Set = "set the clock",
    }
}

coordinates! {
    /// The clock, its reading at the next tick, and its readings when ticks were heard.
    struct Notes {
        clock = "C", due = "D",
        first = "a₁", second = "a₂", third = "a₃", fourth = "a₄", fifth = "a₅",
    }
}

const TICKS: [Action; 5] =
    [Action::Tick1, Action::Tick2, Action::Tick3, Action::Tick4, Action::Tick5];

/// By the clock of a node, in seconds.
const PERIOD: f64 = 10.0;
const WAIT: f64 = 0.1;

/// The middle between the second lowest and the second highest of five: of any two of them, the
/// higher one is at least the second lowest, and the lower one at most the second highest.
fn midpoint(readings: [&Expression; 5]) -> Expression {
    let pairs = || (1..5).flat_map(|one| (0..one).map(move |other| (one, other)));
    let higher = pairs().map(|(one, other)| readings[one].max(readings[other]));
    let lower = pairs().map(|(one, other)| readings[one].min(readings[other]));
    let second_lowest = higher.reduce(|least, next| least.min(next));
    let second_highest = lower.reduce(|greatest, next| greatest.max(next));
    0.5 * (second_lowest.unwrap_or(constant(0.0)) + second_highest.unwrap_or(constant(0.0)))
}

/// The node that gives `own_tick`, with a clock that advances by `rate` seconds a second.
fn node(own_tick: Action, rate: f64) -> Result<Automaton<Node, Action, Notes>, BuildError> {
    use Node::{Listening, Running};
    let Notes { clock, due, first, second, third, fourth, fifth } = Notes::coordinates();
    let heard = [&first, &second, &third, &fourth, &fifth];
    let correction = &due - midpoint(heard.map(|reading| &**reading));

    let mut node = Automaton::starting_in(Running)
        .initially(Notes { due: PERIOD, ..Notes::default() })
        .flow(Running, clock.rate(rate))
        .flow(Listening, clock.rate(rate))
        .transition(
            from(Listening)
                .on(Action::Set)
                .to(Running)
                .must(clock.at_least(&due + WAIT))
                .then([clock.becomes(&clock + correction), due.becomes(&due + PERIOD)]),
        );
    for (tick, reading) in TICKS.into_iter().zip(heard) {
        let note = reading.becomes(&clock);
        if tick == own_tick {
            let is_due = clock.at_least(&due);
            node = node.transition(from(Running).on(tick).to(Listening).must(is_due).then(note));
        } else {
            for place in [Running, Listening] {
                let hear = from(place).on(tick).to(place).may(always()).then(note.clone());
                node = node.transition(hear);
            }
        }
    }
    node.build()
}

/// Five nodes with clocks of these rates, which hear each other's ticks.
fn network(rates: [f64; 5]) -> Result<Composition, Box<dyn Error>> {
    let mut network = Composition::builder();
    for (tick, rate) in TICKS.into_iter().zip(rates) {
        network = network
            .add(&tick.name().replace("tick", "node"), &node(tick, rate)?)
            .label(tick.name());
    }
    Ok(network.build()?)
}

// ---- The answer --------------------------------------------------------------------------------

/// In seconds a second.
const DRIFT: f64 = 1e-4;
/// The fastest first.
const RATES: [f64; 5] =
    [1.0 + DRIFT, 1.0 + 0.5 * DRIFT, 1.0 + 0.1 * DRIFT, 1.0 - 0.7 * DRIFT, 1.0 - DRIFT];
const ROUNDS: u32 = 20;
/// Half a period beyond the last round, in seconds.
const HORIZON: f64 = PERIOD * (ROUNDS as f64 + 0.5);

/// The instants at which the nodes tick and set their clocks, in seconds.
fn closed_form() -> impl Iterator<Item = f64> {
    let round = 0.5 * PERIOD * (1.0 / RATES[1] + 1.0 / RATES[3]);
    (0..ROUNDS).flat_map(move |number| {
        let start = f64::from(number) * round;
        let ticks = RATES.map(|rate| start + PERIOD / rate);
        ticks.into_iter().chain(RATES.map(|rate| start + (PERIOD + WAIT) / rate))
    })
}

/// The largest difference of two clocks of the best and the worst rate, in seconds.
const WORST_SKEW: f64 = 2.0 * DRIFT * (PERIOD + WAIT) / (1.0 + DRIFT);

/// The largest difference of the clocks of nodes 1 to `nodes` in a run, in seconds.
fn skew(trajectory: &Trajectory, nodes: usize) -> f64 {
    let names = trajectory.variables().iter().enumerate();
    let clocks: Vec<usize> =
        names.filter(|(_, name)| name.ends_with(".C")).map(|(place, _)| place).collect();
    let skews = trajectory.samples().map(|(_, sample)| {
        let readings = || clocks[..nodes].iter().map(|&place| sample.values[place]);
        readings().fold(f64::MIN, f64::max) - readings().fold(f64::MAX, f64::min)
    });
    skews.fold(0.0, f64::max)
}

/// Twenty rounds of five nodes.
pub fn exhibit() -> Shown {
    let network = network(RATES)?;
    let trajectory = network.run(HORIZON)?;
    let jumps = trajectory.jumps().len();
    Ok(Exhibit::new("clock_synchronisation", include_str!("clock_synchronisation.rs"))
        .component("node 1", &node(Action::Tick1, RATES[0])?)
        .checked(&network.check())
        .compare("jumps", jumps as f64, f64::from(10 * ROUNDS), 0.0)
        .compare_all(
            "first round, in s",
            instants(&trajectory).take(10),
            closed_form().take(10),
            1e-12,
        )
        .compare("worst skew, in s", skew(&trajectory, 5), WORST_SKEW, 1e-12)
        .run("Twenty rounds", trajectory))
}

fn main() -> Result<(), Box<dyn Error>> {
    exhibit()?.show()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jumps_and_skew_are_those_of_the_closed_form() {
        let exhibit = exhibit().expect("the clocks run");
        assert_eq!(exhibit.disagreements(), [""; 0]);
    }

    #[test]
    fn every_instant_of_every_round_is_that_of_the_closed_form() {
        let trajectory = network(RATES).expect("sound").run(HORIZON).expect("the clocks run");
        for (jump, instant) in trajectory.jumps().iter().zip(closed_form()) {
            assert!((jump.at.t - instant).abs() < 1e-10, "{jump} instead of {instant} s");
        }
    }

    #[test]
    fn a_broken_clock_does_not_mislead_the_other_four() {
        for broken in [0.992, 1.008] {
            let rates = [RATES[0], RATES[1], RATES[3], RATES[4], broken];
            let trajectory = network(rates).expect("sound").run(HORIZON).expect("clocks run");
            assert_eq!(trajectory.ending().reason, Reason::Horizon);
            let worst = skew(&trajectory, 4);
            assert!((worst - WORST_SKEW).abs() < 1e-10, "{worst} beside a clock of {broken}");
            assert!(skew(&trajectory, 5) > 10.0 * WORST_SKEW);
        }
    }
}
