//! # A clock-synchronisation network of five nodes
//!
//! Every node has a clock that gains or loses up to ρ seconds per second. Whenever its own clock has
//! advanced by another period R, a node sends a tick to all nodes, itself included. A tick arrives δ
//! later, and every node notes the reading of its own clock then. A wait W after its own tick, a node
//! sets its clock so that it read one period and δ at the *fault-tolerant midpoint* of the five
//! arrivals, the middle between the second and the fourth. So one clock may be far off without
//! misleading the others. There is no coordinator; each node decides by the messages that it receives.
//!
//! The algorithm is that of Lundelius Welch and Lynch, *A new fault-tolerant algorithm for clock
//! synchronization* (1988),
//! [doi:10.1016/0890-5401(88)90043-0](https://doi.org/10.1016/0890-5401%2888%2990043-0), here with
//! messages that all take the same time. The drift of 1e-4 is that of a plain quartz; R = 10 s,
//! W = 0.1 s, and δ = 0.01 s.
//!
//! The answer is in closed form. Clocks are affine functions of time and midpoints commute with
//! those, so that after each round all clocks agree on one instant, the midpoint of the arrivals: they
//! read k R + δ then. The first of these instants is R a + δ, where a = (1/r₂ + 1/r₄)/2 and r₂ and r₄
//! are the rates of the second and the fourth fastest clock; each of the others comes (R − δ) a + δ
//! after the one before. Until the fastest clock is set for the first time, the fastest and the slowest
//! move apart by 2 ρ (R + W)/(1 + ρ); in later rounds it is less, since they agree δ later.

mod exhibit;

use exhibit::{Exhibit, Shown, instants};
use pleach::prelude::*;
use std::error::Error;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    enum Node: Location { Running = "running", Listening = "listening" }
    enum Action: Event {
        Tick = "tick", Set = "set the clock",
        Hear1 = "hear 1", Hear2 = "hear 2", Hear3 = "hear 3", Hear4 = "hear 4", Hear5 = "hear 5",
    }
}

coordinates! {
    /// The clock, its reading at the next tick, and its readings when ticks arrived.
    struct Notes {
        clock = "C", due = "D",
        first = "a₁", second = "a₂", third = "a₃", fourth = "a₄", fifth = "a₅",
    }
}

const ARRIVALS: [Action; 5] =
    [Action::Hear1, Action::Hear2, Action::Hear3, Action::Hear4, Action::Hear5];

/// By the clock of a node, in seconds.
const PERIOD: f64 = 10.0;
const WAIT: f64 = 0.1;
/// How long a tick is under way, in seconds.
const DELAY: f64 = 0.01;

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

/// A node with a clock that advances by `rate` seconds per second.
fn node(rate: f64) -> Result<Automaton<Node, Action, Notes>, BuildError> {
    use Node::{Listening, Running};
    let Notes { clock, due, first, second, third, fourth, fifth } = Notes::coordinates();
    let heard = [&first, &second, &third, &fourth, &fifth];
    let correction = &due + DELAY - midpoint(heard.map(|reading| &**reading));

    let mut node = Automaton::starting_in(Running)
        .initially(Notes { due: PERIOD, ..Notes::default() })
        .flow(Running, clock.rate(rate))
        .flow(Listening, clock.rate(rate))
        .transition(from(Running).on(Action::Tick).to(Listening).must(clock.at_least(&due)))
        .transition(
            from(Listening)
                .on(Action::Set)
                .to(Running)
                .must(clock.at_least(&due + WAIT))
                .then([clock.becomes(&clock + correction), due.becomes(&due + PERIOD)]),
        );
    for (arrival, reading) in ARRIVALS.into_iter().zip(heard) {
        for place in [Running, Listening] {
            let note = from(place).on(arrival).to(place).may(always());
            node = node.transition(note.then(reading.becomes(&clock)));
        }
    }
    node.build()
}

/// Five nodes with clocks of these rates; a channel from each carries its ticks to all.
fn network(rates: [f64; 5]) -> Result<Composition, Box<dyn Error>> {
    let mut network = Composition::builder();
    let names = [1, 2, 3, 4, 5].map(|number| format!("node {number}"));
    for (name, rate) in names.iter().zip(rates) {
        network = network.add(name, &node(rate)?);
    }
    for (sender, arrival) in names.iter().zip(ARRIVALS) {
        let inputs = names.each_ref().map(|name| format!("{name}.{}", arrival.name()));
        let first = Channel::new(&format!("{sender}.tick"), &inputs[0]);
        let channel = inputs[1..].iter().fold(first, |channel, input| channel.and_to(input));
        network =
            network.channel(channel.called(&format!("tick of {sender}")).taking(DELAY, DELAY));
    }
    Ok(network.build()?)
}

// ---- The answer --------------------------------------------------------------------------------

/// In seconds per second.
const DRIFT: f64 = 1e-4;
/// The fastest first.
const RATES: [f64; 5] =
    [1.0 + DRIFT, 1.0 + 0.5 * DRIFT, 1.0 + 0.1 * DRIFT, 1.0 - 0.7 * DRIFT, 1.0 - DRIFT];
const ROUNDS: u32 = 20;
/// Half a period beyond the last round, in seconds.
const HORIZON: f64 = PERIOD * (ROUNDS as f64 + 0.5);

/// The instants at which the nodes tick, hear the ticks and set their clocks, in seconds.
fn closed_form() -> impl Iterator<Item = f64> {
    let pace = 0.5 * (1.0 / RATES[1] + 1.0 / RATES[3]);
    (0..ROUNDS).flat_map(move |round| {
        // All clocks agree at `since`, and read `reading` more than a whole number of periods.
        let (since, reading) = match round {
            0 => (0.0, 0.0),
            _ => {
                let later = f64::from(round - 1) * ((PERIOD - DELAY) * pace + DELAY);
                (PERIOD * pace + DELAY + later, DELAY)
            }
        };
        let ticks = RATES.map(|rate| since + (PERIOD - reading) / rate);
        let sets = RATES.map(|rate| since + (PERIOD + WAIT - reading) / rate);
        ticks.into_iter().chain(ticks.map(|tick| tick + DELAY)).chain(sets)
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
        .component("node 1", &node(RATES[0])?)
        .checked(&network.check())
        .compare("jumps", jumps as f64, f64::from(15 * ROUNDS), 0.0)
        .compare_all(
            "first round, in s",
            instants(&trajectory).take(15),
            closed_form().take(15),
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
