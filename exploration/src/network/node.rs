//! Nodes as the explorer handles them: one robot or access point, and what it has heard.

use std::collections::BTreeMap;
use std::sync::Arc;

use pleach_automaton::network::beacon::{Beacon, Notice};
use pleach_automaton::network::robot::RobotError;
use pleach_automaton::network::roll::Roll;
use pleach_automaton::network::{AccessPoint, Message, Robot, RobotView, Sense};
use pleach_automaton::node::{Input, Node as _, Observed, Outputs};
use pleach_continuous::Point;

/// The number of a beacon among all those ever sent.
pub type BeaconId = u32;
/// The number of a state of a node among all those ever met.
pub type LocalId = u32;

/// Nodes are explored within one control period: the explorer stands for time.
const PERIOD: u32 = 1;

/// A robot or an access point.
#[derive(Clone, Debug)]
pub enum Node {
    /// A robot.
    Robot(Box<Robot>),
    /// An access point.
    AccessPoint(Box<AccessPoint>),
}

impl Node {
    /// One step. What the node sends is read off its state, and its reports are not needed.
    pub(super) fn step(&mut self, input: Input<'_, Message, Sense>) -> Result<(), RobotError> {
        let mut outputs = Outputs::of(0);
        match self {
            Node::Robot(robot) => robot.step(input, &mut outputs),
            Node::AccessPoint(access_point) => access_point.step(input, &mut outputs),
        }
    }

    /// The clock ticks. In every round that is explored all nodes send, as they do in the first
    /// rounds of a control period.
    fn tick(&mut self) -> Result<(), RobotError> {
        if let Node::Robot(robot) = self {
            robot.count_rounds_anew();
        }
        self.step(Input::Tick { passed: 0 })?;
        if let Node::AccessPoint(access_point) = self {
            access_point.forget_round();
        }
        Ok(())
    }

    /// The robot, unless it is an access point.
    pub fn robot(&self) -> Option<RobotView<'_>> {
        match self {
            Node::Robot(robot) => Some(robot.view()),
            Node::AccessPoint(_) => None,
        }
    }
}

/// The state of one node: itself, what it sends, and what it received last of each other node.
#[derive(Clone, Debug)]
pub struct Local {
    /// The node.
    pub node: Node,
    /// What it sends.
    pub beacon: BeaconId,
    /// The last beacon heard of each node in range, by ascending sender.
    pub heard: Vec<BeaconId>,
}

impl Local {
    /// The robot, unless it is an access point.
    pub fn robot(&self) -> Option<RobotView<'_>> {
        self.node.robot()
    }

    /// The newest notice on the mission that it knows.
    pub fn notice(&self) -> &Notice {
        match &self.node {
            Node::Robot(robot) => robot.view().notice(),
            Node::AccessPoint(access_point) => access_point.notice(),
        }
    }
}

/// Something that happens to one node.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stimulus {
    /// It receives these beacons, and processes them, before its clock ticks.
    Hear(Vec<BeaconId>),
    /// It hears these beacons, and its clock ticks: it counts a round. An access point then serves
    /// the user.
    Round(Vec<BeaconId>),
    /// It has moved to this place, given by number.
    Move(usize),
    /// It has made no progress for this many control periods, and another one begins.
    Period(u32),
    /// An access point serves the user.
    Announce,
}

/// Every beacon and every state of a node met so far, each once, and what came of what.
///
/// What happens to a node depends on nothing but its own state and what it hears. So the
/// transition code runs once for each state and stimulus, and the states of a network are short
/// lists of numbers.
#[derive(Debug)]
pub struct Nodes {
    positions: Vec<Point>,
    beacons: Vec<Arc<Beacon>>,
    beacon_ids: BTreeMap<String, BeaconId>,
    locals: Vec<Local>,
    local_ids: BTreeMap<(String, Vec<BeaconId>), LocalId>,
    outcomes: BTreeMap<(LocalId, Stimulus), LocalId>,
}

impl Nodes {
    /// No node yet; `positions` are those of the places.
    pub fn new(positions: Vec<Point>) -> Self {
        Nodes {
            positions,
            beacons: Vec::new(),
            beacon_ids: BTreeMap::new(),
            locals: Vec::new(),
            local_ids: BTreeMap::new(),
            outcomes: BTreeMap::new(),
        }
    }

    /// The state with this number.
    pub fn local(&self, id: LocalId) -> &Local {
        &self.locals[id as usize]
    }

    /// The beacon with this number.
    pub fn beacon(&self, id: BeaconId) -> &Beacon {
        &self.beacons[id as usize]
    }

    /// How many states of single nodes have been met.
    pub fn len(&self) -> usize {
        self.locals.len()
    }

    /// Whether none has.
    pub fn is_empty(&self) -> bool {
        self.locals.is_empty()
    }

    /// Takes up a node that has heard the beacons given.
    pub fn take_up(&mut self, node: Node, heard: Vec<BeaconId>) -> LocalId {
        let (account, beacon) = match &node {
            Node::Robot(robot) => {
                debug_assert!(robot.leaves_out_nothing(), "{}", robot.account());
                (robot.account(), robot.view().beacon())
            }
            Node::AccessPoint(access_point) => (access_point.account(), access_point.beacon()),
        };
        let key = (account, heard);
        if let Some(&id) = self.local_ids.get(&key) {
            return id;
        }
        let beacon = self.take_down(beacon);
        let id = self.locals.len() as LocalId;
        self.locals.push(Local { node, beacon, heard: key.1.clone() });
        self.local_ids.insert(key, id);
        id
    }

    fn take_down(&mut self, beacon: Beacon) -> BeaconId {
        let next = self.beacons.len() as BeaconId;
        let id = *self.beacon_ids.entry(format!("{beacon:?}")).or_insert(next);
        if id == next {
            self.beacons.push(Arc::new(beacon));
        }
        id
    }

    /// What becomes of a node.
    ///
    /// # Errors
    /// When a guard cannot be evaluated, or transitions do not come to an end.
    pub fn after(&mut self, local: LocalId, stimulus: Stimulus) -> Result<LocalId, RobotError> {
        let key = (local, stimulus);
        if let Some(&known) = self.outcomes.get(&key) {
            return Ok(known);
        }
        let Local { mut node, mut heard, .. } = self.local(local).clone();
        if let Stimulus::Hear(beacons) | Stimulus::Round(beacons) = &key.1 {
            self.hear(&mut node, beacons)?;
            self.apply(&mut node, &key.1)?;
            heard = self.last_heard(&node, &heard, beacons);
        } else {
            self.apply(&mut node, &key.1)?;
        }
        let outcome = self.take_up(node, heard);
        self.outcomes.insert(key, outcome);
        Ok(outcome)
    }

    fn hear(&self, node: &mut Node, beacons: &[BeaconId]) -> Result<(), RobotError> {
        beacons.iter().try_for_each(|&id| {
            let beacon = &self.beacons[id as usize];
            let message = Message::Beacon {
                period: PERIOD,
                roll: Roll::default(),
                confirmed: Some(PERIOD + 1),
                beacon: Arc::clone(beacon),
            };
            node.step(Input::Heard { from: beacon.sender, message: &message })
        })
    }

    fn apply(&self, node: &mut Node, stimulus: &Stimulus) -> Result<(), RobotError> {
        match (node, stimulus) {
            (Node::Robot(robot), Stimulus::Hear(_)) => robot.deliberate_now(),
            (Node::AccessPoint(access_point), Stimulus::Hear(_)) => {
                Ok(access_point.deliberate_now()?)
            }
            (node @ Node::Robot(_), &Stimulus::Move(place)) => {
                node.step(Input::Sensed(Sense::Position(self.positions[place])))
            }
            (Node::Robot(robot), &Stimulus::Period(still)) => robot.pass_period(still),
            (Node::AccessPoint(access_point), Stimulus::Period(_) | Stimulus::Announce) => {
                Ok(access_point.attend_to_user()?)
            }
            (node, Stimulus::Round(_)) => node.tick(),
            _ => Ok(()),
        }
    }

    /// The beacon that a node goes by of each of those that it knows now; it may have refused a late
    /// one.
    fn last_heard(&self, node: &Node, known: &[BeaconId], heard: &[BeaconId]) -> Vec<BeaconId> {
        let Some(robot) = node.robot() else { return heard.to_vec() };
        let number = |held: &Arc<Beacon>| {
            let is_held = |id: &&BeaconId| Arc::ptr_eq(&self.beacons[**id as usize], held);
            heard.iter().chain(known).find(is_held).copied()
        };
        robot.beacons().filter_map(number).collect()
    }
}
