//! Storms: missions in which the radio, the nodes and the bodies fail.
//!
//! The nodes are those that run everywhere. [`Unreliable`] loses, delays and copies their messages,
//! [`FaultyNode`] stops them, brings them back and disturbs their bodies; both by the draws of a seed. The
//! [`Judge`] looks at true positions, and at what must hold whatever fails. A [`Storm`] that breaks
//! it [shrinks](shrink) to fewer faults that still do.

mod draw;
mod judge;
mod shrink;

use std::ops::ControlFlow;
use std::sync::Arc;

use pleach_automaton::network::record::{End, Faults, MissionEvent, Snapshot};
use pleach_automaton::network::scenario::{Fleet, ValidScenario};
use pleach_automaton::network::{
    AccessPoint, FaultyNode, Member, Message, Network, NetworkError, NodeFaults, Radio, Robot,
    Site, User,
};
use pleach_automaton::node::{Medium, MessageFaults, Partition, Unreliable};
use pleach_automaton::{Executor, HybridTime, InvalidLimit, Observer, Reason};
use pleach_continuous::Point;

use super::Violation;
pub use draw::{Kind, allowing_for, draw};
pub use judge::Judge;
pub use shrink::shrink;

/// What fails in a mission.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Storm {
    /// Decides which messages fail, and on errors.
    pub seed: u64,
    /// What becomes of messages.
    pub messages: MessageFaults,
    /// The faults of nodes, by number; the others have none.
    pub nodes: Vec<(usize, NodeFaults)>,
}

impl Storm {
    /// What fails, as far as that decides on what must hold. A node that is cut off is given up like
    /// one that stops.
    pub fn faults(&self) -> Faults {
        let MessageFaults { loss, silence, lateness, copies, partitions, .. } = &self.messages;
        let nodes = || self.nodes.iter().map(|(_, faults)| faults);
        let stops = |faults: &NodeFaults| faults.crash.is_some() || faults.joins.is_some();
        Faults {
            messages: [loss, silence, lateness, copies].into_iter().any(|chance| *chance > 0.0)
                || !partitions.is_empty()
                || self.shifts_clocks(),
            nodes: !partitions.is_empty() || nodes().any(stops),
        }
    }

    /// Whether clocks are behind others.
    pub fn shifts_clocks(&self) -> bool {
        self.nodes.iter().any(|(_, faults)| faults.shift > 0.0)
    }

    /// What of it fails in this fleet, in the fleet's own numbers.
    #[must_use]
    pub fn of_fleet(&self, fleet: &Fleet) -> Self {
        let own = |&node: &usize| fleet.inward().node(node);
        let part = |partition: &Partition| Partition {
            side: partition.side.iter().filter_map(own).collect(),
            ..*partition
        };
        let nodes = self.nodes.iter();
        Storm {
            seed: self.seed,
            messages: MessageFaults {
                partitions: self.messages.partitions.iter().map(part).collect(),
                ..self.messages.clone()
            },
            nodes: nodes.filter_map(|(node, faults)| Some((own(node)?, faults.clone()))).collect(),
        }
    }
}

/// Why a mission cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum StormError {
    /// A node cannot go on.
    #[error(transparent)]
    Network(#[from] NetworkError),
    /// The mission has no time.
    #[error(transparent)]
    Limit(#[from] InvalidLimit),
    /// Nodes jump for ever at one instant.
    #[error("the executor stops at t = {0} s: {1}")]
    Stopped(f64, String),
}

/// What became of a mission.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// How it ended; none if it was still under way when time was up.
    pub end: Option<End>,
    /// Control periods that it took.
    pub periods: usize,
    /// The first violation of each property.
    pub violations: Vec<Violation>,
    /// The first time that a robot came too near to one that had not begun, and that it could not
    /// hear.
    pub unheard: Option<Violation>,
    /// The last control period in which a robot moved.
    pub last_motion: usize,
    /// What happened, each with its control period.
    pub events: Vec<(usize, MissionEvent)>,
}

/// The network of a scenario in a storm.
pub type StormyNetwork = Network<Unreliable<Message, Radio>, FaultyNode>;

/// Sets a network up in a storm.
///
/// # Errors
/// When the network cannot be set up.
pub fn network(scenario: &ValidScenario, storm: &Storm) -> Result<StormyNetwork, NetworkError> {
    network_on(Arc::clone(scenario.site()), scenario, storm)
}

/// The same, where the nodes know this site: that of the scenario with automata that
/// [count](pleach_automaton::network::Automata::counted), say.
///
/// # Errors
/// When the network cannot be set up.
pub fn network_on(
    site: Arc<Site>,
    scenario: &ValidScenario,
    storm: &Storm,
) -> Result<StormyNetwork, NetworkError> {
    let (robots, access_points) = (scenario.robot.len(), site.access_points.len());
    let of = |id: usize, place: Point, make: fn(usize, Point, f64, &Arc<Site>) -> Member| {
        let known = storm.nodes.iter().find(|(node, _)| *node == id);
        let faults = known.map(|(_, faults)| faults.clone()).unwrap_or_default();
        let rate = scenario.robot.get(id).map_or(0.0, |robot| robot.rate);
        let (maker_site, period) = (Arc::clone(&site), site.settings.period);
        let maker = Arc::new(move |place: Point| make(id, place, rate, &maker_site));
        FaultyNode::new(maker, place, period, faults, storm.seed ^ (id as u64 + 1))
    };
    let nodes = (0..robots)
        .map(|id| {
            of(id, scenario.robot[id].position.into(), |id, place, rate, site| {
                Member::Robot(Box::new(Robot::new(id, place, rate, Arc::clone(site))))
            })
        })
        .chain((0..access_points).map(|number| {
            of(robots + number, site.access_points[number], |id, _, _, site| {
                let number = id - site.robots;
                Member::AccessPoint(Box::new(AccessPoint::new(number, Arc::clone(site))))
            })
        }))
        .chain([of(robots + access_points, site.access_points[0], |_, _, _, site| {
            Member::User(Box::new(User::new(Arc::clone(site))))
        })]);
    let messages = MessageFaults { wired_from: Some(robots), ..storm.messages.clone() };
    let medium = Unreliable::new(Radio::new(&site), messages, storm.seed);
    let nodes = nodes.collect();
    Network::of_nodes(scenario, Arc::clone(&site), medium, nodes)
}

/// Runs a mission in a storm and judges it, for at most this many control periods.
///
/// # Errors
/// When a node cannot go on.
pub fn judged_run(
    scenario: &ValidScenario,
    storm: &Storm,
    periods: usize,
) -> Result<Verdict, StormError> {
    judged_run_watched(scenario, storm, periods, |_| {})
}

/// The same, where `watch` is given every snapshot.
///
/// # Errors
/// When a node cannot go on.
pub fn judged_run_watched(
    scenario: &ValidScenario,
    storm: &Storm,
    periods: usize,
    watch: impl FnMut(&Snapshot),
) -> Result<Verdict, StormError> {
    let mut network = network(scenario, storm)?;
    let mut log = Log { judge: Judge::new(scenario, storm), events: Vec::new(), watch };
    let horizon = scenario.settings().period * (periods as f64 - 0.5);
    let ending = Executor::new(horizon, JUMPS_PER_PERIOD)?.run(&mut network, &mut log)?;
    let end = match ending.reason {
        Reason::Finished(end) | Reason::Interrupted(end) => Some(end),
        Reason::Horizon => None,
        other => return Err(StormError::Stopped(ending.at.t, format!("{other:?}"))),
    };
    let Log { mut judge, events, .. } = log;
    if let Some(end) = &end {
        judge.conclude(end);
    }
    let last_motion = judge.last_motion();
    let (violations, unheard) = judge.into_violations();
    Ok(Verdict { end, periods: network.step(), violations, unheard, last_motion, events })
}

/// Only a cycle of jumps that takes no time reaches it.
const JUMPS_PER_PERIOD: u32 = 1_000_000;

struct Log<F> {
    judge: Judge,
    events: Vec<(usize, MissionEvent)>,
    watch: F,
}

impl<M: Medium<Message, Point>, F: FnMut(&Snapshot)> Observer<Network<M, FaultyNode>> for Log<F> {
    fn flows(
        &mut self,
        network: &Network<M, FaultyNode>,
        _: HybridTime,
        _: f64,
    ) -> ControlFlow<End> {
        let step = network.step();
        let snapshot = network.snapshot();
        (self.watch)(&snapshot);
        let events = network.events();
        self.judge.observe(&snapshot, &events, network.nodes());
        self.events.extend(events.into_iter().map(|event| (step, event)));
        ControlFlow::Continue(())
    }
}
