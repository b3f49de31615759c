//! # A clock-synchronisation network of five nodes
//!
//! Every node has a clock that gains or loses up to ρ seconds a second. Whenever its own clock has
//! advanced by another period R, a node ticks: it sends a message to all nodes, itself included,
//! that takes between δ − ε and δ + ε. Each node records, by its own clock, when each tick arrives.
//! A wait W after its own tick, a node sets its clock so that the *fault-tolerant midpoint* of the
//! five readings, the middle between the second and the fourth, was δ after the end of the period.
//! So one clock may be far off without misleading the others, and no node is in charge.
//!
//! The algorithm is from Lundelius Welch and Lynch, *A new fault-tolerant algorithm for clock
//! synchronization* (1988),
//! [doi:10.1016/0890-5401(88)90043-0](https://doi.org/10.1016/0890-5401%2888%2990043-0). The drift
//! of 1e-4 is typical of a plain quartz; R = 10 s, W = 0.2 s and δ = 0.02 s.
//!
//! With ε = 0 the answer has a closed form. Midpoints commute with affine functions, and clocks are
//! affine functions of time, so in each round all clocks agree on one instant, δ after the midpoint
//! of the ticks. The next period ends R − δ later by each clock, and the instants of round k + 1
//! follow those of round k by δ + (R − δ)(1/r₂ + 1/r₄)/2, where r₂ and r₄ are the rates of the
//! second and the fourth fastest. Until the fastest clock is set, the fastest and the slowest drift
//! apart by 2 ρ (R + W)/(1 + ρ) in the first round and by 2 ρ (R − δ + W)/(1 + ρ) in the others.
//!
//! With ε > 0 each reading is off by at most (1 + ρ) ε. Midpoints do not enlarge errors, so the
//! instants on which two nodes agree differ by at most 2 ε. A node that has just set its clock may
//! be another ε away from one that has not, so clocks are at most 3 (1 + ρ) ε farther apart than
//! with ε = 0.

mod exhibit;

use exhibit::{Exhibit, Shown};
use pleach::automaton::composition::Channel;
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
    /// The clock, its reading at the next tick, and its readings when ticks were heard.
    struct Notes {
        clock = "C", due = "D",
        first = "a₁", second = "a₂", third = "a₃", fourth = "a₄", fifth = "a₅",
    }
}

/// The arrival of a tick, by its sender.
const HEARD: [Action; 5] =
    [Action::Hear1, Action::Hear2, Action::Hear3, Action::Hear4, Action::Hear5];

/// By the clock of a node, in seconds.
const PERIOD: f64 = 10.0;
const WAIT: f64 = 0.2;
/// The time that messages take on the average, in seconds.
const DELAY: f64 = 0.02;

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

/// A node with a clock that advances by `rate` seconds a second.
fn node(rate: f64) -> Result<Automaton<Node, Action, Notes>, BuildError> {
    use Node::{Listening, Running};
    let Notes { clock, due, first, second, third, fourth, fifth } = Notes::coordinates();
    let readings = [&first, &second, &third, &fourth, &fifth];
    let correction = &due + DELAY - midpoint(readings.map(|reading| &**reading));

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
    for (hear, reading) in HEARD.into_iter().zip(readings) {
        for place in [Running, Listening] {
            let note = reading.becomes(&clock);
            node = node.transition(from(place).on(hear).to(place).may(always()).then(note));
        }
    }
    node.build()
}

/// Five nodes with clocks of these rates, and a channel from each to each, whose messages take at
/// most `error` seconds more or less than on the average.
fn network(rates: [f64; 5], error: f64) -> Result<Composition, Box<dyn Error>> {
    let mut network = Composition::builder();
    for (number, rate) in rates.into_iter().enumerate() {
        network = network.add(&format!("node {}", number + 1), &node(rate)?);
    }
    for (sender, hear) in HEARD.into_iter().enumerate() {
        for receiver in 1..=5 {
            let (tick, arrival) =
                (format!("node {}.tick", sender + 1), format!("node {receiver}.{}", hear.name()));
            let channel = Channel::new(&tick, &arrival).taking(DELAY - error, DELAY + error);
            network = network.channel(channel);
        }
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
    let midpoint = 0.5 * (1.0 / RATES[1] + 1.0 / RATES[3]);
    // Where all clocks agree, and how far the end of the next period is then by each of them.
    let first = (0.0, PERIOD);
    let rounds = std::iter::successors(Some(first), move |(agreed, left)| {
        Some((agreed + left * midpoint + DELAY, PERIOD - DELAY))
    });
    rounds.take(ROUNDS as usize).flat_map(|(agreed, left)| {
        let ticks = RATES.map(|rate| agreed + left / rate);
        ticks.into_iter().chain(RATES.map(|rate| agreed + (left + WAIT) / rate))
    })
}

/// The instants at which the nodes of a run tick and set their clocks, in seconds.
fn instants(trajectory: &Trajectory) -> impl Iterator<Item = f64> + '_ {
    let own = |label: &str| label.ends_with("tick") || label.ends_with("set the clock");
    trajectory.jumps().iter().filter(move |jump| own(&jump.label)).map(|jump| jump.at.t)
}

/// The largest difference of two clocks of the best and the worst rate, in seconds: in the first
/// round, which has no agreement to begin with but the start.
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
    let network = network(RATES, 0.0)?;
    let trajectory = network.run(HORIZON)?;
    let jumps = trajectory.jumps().len();
    Ok(Exhibit::new("clock_synchronisation", include_str!("clock_synchronisation.rs"))
        .component("node 1", &node(RATES[0])?)
        .checked(&network.check())
        .compare("jumps", jumps as f64, f64::from(35 * ROUNDS), 0.0)
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
        let trajectory = network(RATES, 0.0).expect("sound").run(HORIZON).expect("the clocks run");
        assert_eq!(instants(&trajectory).count(), 10 * ROUNDS as usize);
        for (found, instant) in instants(&trajectory).zip(closed_form()) {
            assert!((found - instant).abs() < 1e-10, "{found} instead of {instant} s");
        }
    }

    /// How much farther apart clocks may be where messages take up to `error` more or less.
    const fn skew_by(error: f64) -> f64 {
        3.0 * (1.0 + DRIFT) * error
    }

    #[test]
    fn clocks_stay_within_the_bound_whatever_the_delays() {
        let error = 0.005;
        let network = network(RATES, error).expect("sound");
        for seed in 0..10 {
            let settings = Settings { policy: Policy::Random { seed }, ..Settings::default() };
            let trajectory = network.run_with(settings, HORIZON).expect("the clocks run");
            assert_eq!(trajectory.ending().reason, Reason::Horizon);
            let worst = skew(&trajectory, 5);
            assert!(worst > WORST_SKEW, "delays of {error} s change nothing: {worst}");
            assert!(worst <= WORST_SKEW + skew_by(error), "{worst} with seed {seed}");
        }
    }

    #[test]
    fn a_broken_clock_does_not_mislead_the_other_four() {
        for broken in [0.992, 1.008] {
            let rates = [RATES[0], RATES[1], RATES[3], RATES[4], broken];
            let trajectory = network(rates, 0.0).expect("sound").run(HORIZON).expect("clocks run");
            assert_eq!(trajectory.ending().reason, Reason::Horizon);
            let worst = skew(&trajectory, 4);
            assert!((worst - WORST_SKEW).abs() < 1e-10, "{worst} beside a clock of {broken}");
            assert!(skew(&trajectory, 5) > 10.0 * WORST_SKEW);
        }
    }
}
