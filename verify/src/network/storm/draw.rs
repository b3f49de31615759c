//! Storms by seed, kind by kind.

use std::ops::Range;

use pleach_automaton::network::scenario::{InvalidScenario, Settings, ValidScenario};
use pleach_automaton::network::{Crash, NodeFaults};
use pleach_automaton::node::{MessageFaults, Partition};
use pleach_continuous::geometry::Errors;

use super::Storm;
use crate::draws::Draws;

/// A kind of storm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Messages are lost with this probability, from the beginning or once the mission is under
    /// way.
    Loss {
        /// The probability.
        rate: f64,
        /// Whether none is lost at the beginning.
        later: bool,
    },
    /// One message of ten is late.
    Delay,
    /// One message of ten comes again later.
    Copies,
    /// Nothing gets over some links for a second at a time.
    Silence,
    /// Some robots are cut off for a while.
    Partition,
    /// A robot stops for good.
    Crash,
    /// A robot stops, and comes back having forgotten everything.
    Restart,
    /// A robot joins late.
    Late,
    /// Moves end somewhere else, by this share of a step.
    Motion(f64),
    /// Positions are measured with an error, this share of the radio's range.
    Position(f64),
    /// Positions and moves each have an error, this share of the clearance ρ.
    Errors(f64),
    /// The clock of each node is behind, by up to a control period.
    Clocks,
    /// All that can happen to messages, at once.
    Radio,
    /// An access point stops, and in every other mission comes back; in some, messages fail too.
    AccessPoint,
    /// Everything at once.
    Everything,
}

impl Kind {
    /// The kinds, from gentle to hostile.
    pub const ALL: &'static [Kind] = &[
        Kind::Loss { rate: 0.01, later: false },
        Kind::Loss { rate: 0.03, later: false },
        Kind::Loss { rate: 0.1, later: false },
        Kind::Loss { rate: 0.3, later: false },
        Kind::Loss { rate: 0.1, later: true },
        Kind::Loss { rate: 0.2, later: true },
        Kind::Loss { rate: 0.3, later: true },
        Kind::Loss { rate: 0.6, later: true },
        Kind::Delay,
        Kind::Copies,
        Kind::Silence,
        Kind::Partition,
        Kind::Radio,
        Kind::Crash,
        Kind::Restart,
        Kind::Late,
        Kind::Motion(0.003),
        Kind::Motion(0.3),
        Kind::Position(0.001),
        Kind::Position(0.003),
        Kind::Errors(0.25),
        Kind::Clocks,
        Kind::AccessPoint,
        Kind::Everything,
    ];

    /// What it is called.
    pub fn name(self) -> String {
        match self {
            Kind::Loss { rate, later: false } => format!("loss {}%", rate * 100.0),
            Kind::Loss { rate, later: true } => format!("loss {}% later", rate * 100.0),
            Kind::Motion(share) => format!("motion {}% of a step", share * 100.0),
            Kind::Position(share) => format!("position {}% of u", share * 100.0),
            Kind::Errors(share) => format!("position and motion {}% of ρ", share * 100.0),
            Kind::AccessPoint => "access point".to_owned(),
            other => format!("{other:?}").to_lowercase(),
        }
    }

    /// How far positions and moves are off in a storm of this kind.
    pub fn errors(self, scenario: &ValidScenario) -> Errors {
        let Settings { clearance, step_radius, link, .. } = *scenario.settings();
        match self {
            Kind::Motion(share) => Errors { position: 0.0, motion: share * step_radius },
            Kind::Position(share) => Errors { position: share * link.max_range, motion: 0.0 },
            Kind::Errors(share) => {
                Errors { position: share * clearance, motion: share * clearance }
            }
            _ => Errors::default(),
        }
    }
}

/// The same scenario where robots allow for the errors of this kind of storm; δ grows where it would be
/// too small for that.
///
/// # Errors
/// When the robots have no room for these errors where they start.
pub fn allowing_for(
    kind: Kind,
    scenario: &ValidScenario,
) -> Result<ValidScenario, InvalidScenario> {
    let errors = kind.errors(scenario);
    if errors.are_none() {
        return Ok(scenario.clone());
    }
    let mut stated = scenario.scenario().clone();
    stated.control.position_error = Some(errors.position);
    stated.control.motion_error = Some(errors.motion);
    let service_radius = stated.control.service_radius.take();
    let usual = Settings::resolve(&stated).service_radius;
    stated.control.service_radius = service_radius.map(|stated| stated.max(usual));
    ValidScenario::new(stated)
}

/// The faults of messages end after this many times the duration of the mission: then everything is done.
const CLEARS_AFTER: f64 = 1.5;
/// Seconds after which faults that come later begin.
const LATER: f64 = 20.0;

/// The storm of this kind and seed for a mission that lasts about `duration` seconds.
pub fn draw(kind: Kind, seed: u64, scenario: &ValidScenario, duration: f64) -> Storm {
    let mut draws = Draws(seed.wrapping_mul(0xD1B5_4A32_D192_ED03) ^ duration.to_bits());
    let robots = scenario.robot.len();
    let mut storm = Storm { seed, ..Storm::default() };
    let messages = &mut storm.messages;
    match kind {
        Kind::Loss { rate, later } => {
            messages.loss = rate;
            messages.begin = if later { LATER } else { 0.0 };
        }
        Kind::Delay => (messages.lateness, messages.longest_delay) = (0.1, 6),
        Kind::Copies => (messages.copies, messages.longest_delay) = (0.1, 60),
        Kind::Silence => messages.silence = 0.1,
        Kind::Partition => messages.partitions = partitions(&mut draws, robots, duration),
        Kind::Radio => *messages = any_faults(&mut draws, robots, duration),
        Kind::Crash | Kind::Restart => {
            storm.nodes = vec![crash(&mut draws, 0..robots, duration, kind == Kind::Restart)];
        }
        Kind::Late => {
            let joins = Some(draws.between(5.0, duration / 2.0));
            storm.nodes =
                vec![(draws.below(robots), NodeFaults { joins, ..NodeFaults::default() })];
        }
        Kind::Motion(_) | Kind::Position(_) | Kind::Errors(_) => {
            let Errors { position, motion } = kind.errors(scenario);
            let faults = NodeFaults {
                position_error: position,
                motion_error: motion,
                ..NodeFaults::default()
            };
            storm.nodes = (0..robots).map(|robot| (robot, faults.clone())).collect();
        }
        Kind::Clocks => shift_clocks(&mut storm, &mut draws, scenario),
        Kind::AccessPoint => {
            if draws.below(2) == 0 {
                *messages = any_faults(&mut draws, robots, duration);
            }
            let access_points = robots..robots + scenario.access_point.len();
            let comes_back = seed.is_multiple_of(2);
            storm.nodes = vec![crash(&mut draws, access_points, duration, comes_back)];
        }
        Kind::Everything => {
            *messages = any_faults(&mut draws, robots, duration);
            for _ in 0..1 + draws.below(3) {
                let comes_back = draws.below(2) == 0;
                let faults = crash(&mut draws, 0..robots, duration, comes_back);
                if storm.nodes.iter().all(|(node, _)| *node != faults.0) {
                    storm.nodes.push(faults);
                }
            }
            if draws.below(2) == 0 {
                shift_clocks(&mut storm, &mut draws, scenario);
            }
        }
    }
    storm
}

/// The clock of each node is behind, by up to a control period.
fn shift_clocks(storm: &mut Storm, draws: &mut Draws, scenario: &ValidScenario) {
    for node in 0..scenario.robot.len() + scenario.access_point.len() {
        let shift = draws.between(0.0, scenario.settings().period);
        match storm.nodes.iter_mut().find(|(faulty, _)| *faulty == node) {
            Some((_, faults)) => faults.shift = shift,
            None => storm.nodes.push((node, NodeFaults { shift, ..NodeFaults::default() })),
        }
    }
}

fn any_faults(draws: &mut Draws, robots: usize, duration: f64) -> MessageFaults {
    MessageFaults {
        loss: draws.between(0.0, 0.5),
        silence: draws.between(0.0, 0.1),
        lateness: draws.between(0.0, 0.2),
        copies: draws.between(0.0, 0.2),
        longest_delay: 1 + draws.below(100) as u64,
        partitions: partitions(draws, robots, duration),
        begin: 0.0,
        end: Some(CLEARS_AFTER * duration),
        wired_from: None,
    }
}

fn partitions(draws: &mut Draws, robots: usize, duration: f64) -> Vec<Partition> {
    (0..1 + draws.below(3))
        .map(|_| {
            let begin = draws.between(0.0, duration);
            let end = begin + draws.between(1.0, 40.0);
            let side = (0..robots).filter(|_| draws.below(3) == 0).collect();
            Partition { begin, end, side }
        })
        .collect()
}

/// One of these nodes stops.
fn crash(
    draws: &mut Draws,
    nodes: Range<usize>,
    duration: f64,
    comes_back: bool,
) -> (usize, NodeFaults) {
    let time = draws.between(1.0, duration);
    let back = comes_back.then(|| time + draws.between(1.0, 60.0));
    let crash = Crash { time, inputs: draws.below(400) as u32, back };
    (
        nodes.start + draws.below(nodes.len()),
        NodeFaults { crash: Some(crash), ..NodeFaults::default() },
    )
}
