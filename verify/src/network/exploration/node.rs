//! Nodes as the explorer handles them: one robot or access point, and what it has heard.

use std::collections::BTreeMap;
use std::sync::Arc;

use pleach_automaton::BuildError;
use pleach_automaton::TransitionError;
use pleach_automaton::network::Robot;
use pleach_automaton::network::access_point::AccessPoint;
use pleach_automaton::network::beacon::{Beacon, Notice};
use pleach_continuous::Point;

/// The number of a beacon among all those ever said.
pub type BeaconId = u32;
/// The number of a state of a node among all those ever met.
pub type LocalId = u32;

/// A robot or an access point.
#[derive(Clone, Debug)]
pub enum Node {
    /// A robot.
    Robot(Box<Robot>),
    /// An access point.
    AccessPoint(Box<AccessPoint>),
}

/// The state of one node: itself, what it says, and what it heard last from whom.
#[derive(Clone, Debug)]
pub struct Local {
    /// The node.
    pub node: Node,
    /// What it says.
    pub beacon: BeaconId,
    /// The last beacon heard of each node in range, by ascending sender.
    pub heard: Vec<BeaconId>,
}

impl Local {
    /// The robot, unless it is an access point.
    pub fn robot(&self) -> Option<&Robot> {
        match &self.node {
            Node::Robot(robot) => Some(robot),
            Node::AccessPoint(_) => None,
        }
    }

    /// The newest word on the mission that it knows.
    pub fn notice(&self) -> &Notice {
        match &self.node {
            Node::Robot(robot) => robot.notice(),
            Node::AccessPoint(access_point) => access_point.notice(),
        }
    }
}

/// Something that happens to one node.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stimulus {
    /// It hears these beacons, and thinks.
    Hear(Vec<BeaconId>),
    /// The same, as one of the rounds that it counts; an access point then speaks for the user.
    Round(Vec<BeaconId>),
    /// It has moved to this place, given by number.
    Move(usize),
    /// It has not got on for so many control periods, and another one begins.
    Period(u32),
    /// An access point speaks for the user.
    Announce,
}

/// Why a node cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum NodeError {
    /// An automaton is not well formed.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// A guard speaks of something that robots do not measure.
    #[error(transparent)]
    Guard(#[from] TransitionError),
    /// A robot jumps and jumps, and no time passes.
    #[error("robot {robot} takes more than {MOST_JUMPS} transitions at one instant")]
    Zeno {
        /// Which.
        robot: usize,
    },
}

/// More transitions than this at one instant are taken for endless; a mission has about ten
/// steps, and a robot takes a few of them at a time.
const MOST_JUMPS: usize = 32;

/// Every beacon and every state of a node met so far, each once, and what came of what.
///
/// What happens to a node depends on nothing but its own state and what it hears. So the
/// transition code runs once for each state and stimulus, and the states of a network are short
/// lists of numbers.
#[derive(Debug)]
pub struct Nodes {
    tasks: Vec<Point>,
    positions: Vec<Point>,
    beacons: Vec<Arc<Beacon>>,
    beacon_ids: BTreeMap<String, BeaconId>,
    locals: Vec<Local>,
    local_ids: BTreeMap<(String, Vec<BeaconId>), LocalId>,
    outcomes: BTreeMap<(LocalId, Stimulus), LocalId>,
}

impl Nodes {
    /// No node yet; `positions` are those of the places, `tasks` those of the tasks.
    ///
    /// # Errors
    /// When an automaton is not well formed.
    pub fn new(positions: Vec<Point>, tasks: Vec<Point>) -> Result<Self, NodeError> {
        Ok(Nodes {
            tasks,
            positions,
            beacons: Vec::new(),
            beacon_ids: BTreeMap::new(),
            locals: Vec::new(),
            local_ids: BTreeMap::new(),
            outcomes: BTreeMap::new(),
        })
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
        let account = match &node {
            Node::Robot(robot) => robot.account(),
            Node::AccessPoint(access_point) => access_point.account(),
        };
        let key = (account, heard);
        if let Some(&id) = self.local_ids.get(&key) {
            return id;
        }
        let beacon = match &node {
            Node::Robot(robot) => robot.beacon(),
            Node::AccessPoint(access_point) => access_point.beacon(),
        };
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
    pub fn after(&mut self, local: LocalId, stimulus: Stimulus) -> Result<LocalId, NodeError> {
        let key = (local, stimulus);
        if let Some(&known) = self.outcomes.get(&key) {
            return Ok(known);
        }
        let Local { node, heard, .. } = self.local(local).clone();
        let (node, heard) = match node {
            Node::Robot(robot) => self.stir_robot(robot, heard, &key.1)?,
            Node::AccessPoint(it) => self.stir_access_point(it, heard, &key.1),
        };
        let outcome = self.take_up(node, heard);
        self.outcomes.insert(key, outcome);
        Ok(outcome)
    }

    fn stir_robot(
        &self,
        mut robot: Box<Robot>,
        mut heard: Vec<BeaconId>,
        stimulus: &Stimulus,
    ) -> Result<(Node, Vec<BeaconId>), NodeError> {
        match stimulus {
            Stimulus::Hear(beacons) => {
                heard = self.listen(&mut robot, &heard, beacons);
                robot.think()?;
            }
            Stimulus::Round(beacons) => {
                heard = self.listen(&mut robot, &heard, beacons);
                let (position, still) = (robot.position(), robot.still_periods());
                robot.stand_at(position, still);
                robot.deliberate()?;
            }
            Stimulus::Move(place) => {
                robot.stand_at(self.positions[*place], 0);
                robot.look_round();
            }
            Stimulus::Period(still) => {
                let position = robot.position();
                robot.stand_at(position, *still);
                robot.begin_period()?;
                robot.deliberate()?;
            }
            Stimulus::Announce => {}
        }
        self.jump(&mut robot)?;
        robot.drain_log();
        Ok((Node::Robot(robot), heard))
    }

    /// The robot hears these beacons; what it then knows of its neighbours.
    fn listen(&self, robot: &mut Robot, known: &[BeaconId], heard: &[BeaconId]) -> Vec<BeaconId> {
        robot.hear(heard.iter().map(|&beacon| &self.beacons[beacon as usize]));
        let last = |node| {
            let from = |&&id: &&BeaconId| self.beacon(id).sender == node;
            heard.iter().find(from).or_else(|| known.iter().find(from)).copied()
        };
        robot.audible().filter_map(|(node, _)| last(node)).collect()
    }

    /// The robot's own transitions, which are taken at once.
    fn jump(&self, robot: &mut Robot) -> Result<(), NodeError> {
        for _ in 0..MOST_JUMPS {
            robot.measure();
            if robot.jump()?.is_none() {
                return Ok(());
            }
        }
        Err(NodeError::Zeno { robot: robot.beacon().sender })
    }

    fn stir_access_point(
        &self,
        mut access_point: Box<AccessPoint>,
        mut heard: Vec<BeaconId>,
        stimulus: &Stimulus,
    ) -> (Node, Vec<BeaconId>) {
        if let Stimulus::Hear(beacons) | Stimulus::Round(beacons) = stimulus {
            heard.clone_from(beacons);
            access_point.hear(heard.iter().map(|&beacon| &self.beacons[beacon as usize]));
        }
        if !matches!(stimulus, Stimulus::Hear(_)) && access_point.number() == 0 {
            access_point.speak_for_user(&self.tasks);
        }
        access_point.drain_log();
        (Node::AccessPoint(access_point), heard)
    }
}
