//! Nodes as the explorer handles them: one robot or access point, and what it has heard.

use std::fmt;
use std::ops::Index;
use std::sync::Arc;

use pleach_automaton::network::beacon::{Beacon, Notice};
use pleach_automaton::network::robot::RobotError;
use pleach_automaton::network::roll::Roll;
use pleach_automaton::network::{AccessPoint, Message, Robot, RobotView, Sense};
use pleach_automaton::node::{Input, Node as _, Observed, Outputs};
use pleach_continuous::Point;
use rustc_hash::FxHashMap;

/// The number of a beacon among all those ever sent.
pub type BeaconId = u32;
/// The number of a message among all those ever sent.
pub type MessageId = u32;
/// The number of a state of a node among all those ever met.
pub type LocalId = u32;

/// Where control periods do not count, nodes are explored within the first one.
const FIRST_PERIOD: u32 = 1;
/// Where they do, the present one has this number at first, and those before have smaller ones.
const PRESENT_PERIOD: u32 = 1000;

/// A beacon, and what is told with it.
#[derive(Clone, Debug, PartialEq)]
struct Said {
    beacon: BeaconId,
    period: u32,
    roll: Roll,
    confirmed: Option<u32>,
}

/// What any node tells beside its beacon where control periods do not count.
fn told_without_periods() -> (u32, Roll, Option<u32>) {
    (FIRST_PERIOD, Roll::default(), Some(FIRST_PERIOD + 1))
}

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
    /// rounds of a control period; where these do not count, every way to an access point is confirmed
    /// anew.
    fn tick(&mut self, periods_count: bool) -> Result<(), RobotError> {
        if let Node::Robot(robot) = self {
            robot.count_rounds_anew();
            if !periods_count {
                robot.confirm_way_anew();
            }
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

    /// All that decides on what the node does, beside what it has heard last.
    fn account(&self, periods_count: bool) -> Vec<String> {
        match (self, periods_count) {
            (Node::Robot(robot), false) => robot.account(),
            (Node::Robot(robot), true) => robot.account_in_time(),
            (Node::AccessPoint(point), false) => point.account(),
            (Node::AccessPoint(point), true) => point.account_in_time(),
        }
    }

    fn beacon(&self, periods_count: bool) -> Beacon {
        match (self, periods_count) {
            (Node::Robot(robot), false) => robot.view().beacon(),
            (Node::Robot(robot), true) => robot.view().beacon_in_time(),
            (Node::AccessPoint(point), false) => point.beacon(),
            (Node::AccessPoint(point), true) => point.beacon_in_time(),
        }
    }

    /// What it tells beside its beacon: the control period, the roll, and the confirmation of its way.
    fn tell_now(&mut self, periods_count: bool) -> (u32, Roll, Option<u32>) {
        match self {
            _ if !periods_count => told_without_periods(),
            Node::Robot(robot) => robot.tell_now(),
            Node::AccessPoint(access_point) => access_point.tell_now(),
        }
    }
}

/// The number of a text among those met, in the order in which they were.
fn number_in(numbers: &mut FxHashMap<String, u32>, text: String) -> u32 {
    let next = numbers.len() as u32;
    *numbers.entry(text).or_insert(next)
}

/// Different things in the order in which they were met, each with its number.
#[derive(Debug)]
struct Numbered<T> {
    things: Vec<T>,
    numbers: FxHashMap<String, u32>,
}

impl<T: fmt::Debug> Numbered<T> {
    fn new() -> Self {
        Numbered { things: Vec::new(), numbers: FxHashMap::default() }
    }

    /// The number of a thing.
    fn number_of(&mut self, thing: T) -> u32 {
        let number = number_in(&mut self.numbers, format!("{thing:?}"));
        if number as usize == self.things.len() {
            self.things.push(thing);
        }
        number
    }
}

impl<T> Index<u32> for Numbered<T> {
    type Output = T;

    fn index(&self, number: u32) -> &T {
        &self.things[number as usize]
    }
}

/// The state of one node: itself, what it sends, and what it received last of each other node.
#[derive(Clone, Debug)]
pub struct Local {
    /// The node.
    pub node: Node,
    /// The beacon that it sends.
    pub beacon: BeaconId,
    /// What it sends.
    pub message: MessageId,
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
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Stimulus {
    /// It receives these messages, and processes them, before its clock ticks.
    Hear(Vec<MessageId>),
    /// It hears these messages, and its clock ticks: it counts a round. An access point then serves
    /// the user.
    Round(Vec<MessageId>),
    /// It has moved to this place, given by number.
    Move(usize),
    /// It has made no progress for this many control periods, and another one begins.
    Period(u32),
    /// The same where control periods count: the new one has the number of the last one, or the next.
    CountedPeriod {
        /// For how many control periods it has made no progress.
        still: u32,
        /// Whether the number is the next.
        is_next: bool,
    },
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
    /// Whether control periods count.
    periods_count: bool,
    beacons: Numbered<Arc<Beacon>>,
    messages: Numbered<Said>,
    locals: Vec<Local>,
    /// By the paragraphs of its account and the beacons heard: few texts, in many combinations.
    local_ids: FxHashMap<Box<[u32]>, LocalId>,
    paragraphs: FxHashMap<String, u32>,
    outcomes: FxHashMap<(LocalId, Stimulus), LocalId>,
}

impl Nodes {
    /// No node yet; `positions` are those of the places, and control periods may count.
    pub fn new(positions: Vec<Point>, periods_count: bool) -> Self {
        Nodes {
            positions,
            periods_count,
            beacons: Numbered::new(),
            messages: Numbered::new(),
            locals: Vec::new(),
            local_ids: FxHashMap::default(),
            paragraphs: FxHashMap::default(),
            outcomes: FxHashMap::default(),
        }
    }

    /// The state with this number.
    pub fn local(&self, id: LocalId) -> &Local {
        &self.locals[id as usize]
    }

    /// The beacon with this number.
    pub fn beacon(&self, id: BeaconId) -> &Beacon {
        &self.beacons[id]
    }

    /// The beacon of a message.
    pub fn said(&self, id: MessageId) -> &Beacon {
        self.beacon(self.messages[id].beacon)
    }

    /// The control period of a message.
    pub fn period(&self, id: MessageId) -> u32 {
        self.messages[id].period
    }

    /// The message with this beacon where control periods do not count.
    pub fn message_with(&mut self, beacon: BeaconId) -> MessageId {
        let (period, roll, confirmed) = told_without_periods();
        self.messages.number_of(Said { beacon, period, roll, confirmed })
    }

    /// How many states of single nodes have been met.
    pub fn len(&self) -> usize {
        self.locals.len()
    }

    /// Whether none has.
    pub fn is_empty(&self) -> bool {
        self.locals.is_empty()
    }

    /// The mission begins with this node: where control periods count, in the present one, and otherwise
    /// with all robots that there are.
    pub(super) fn date(&self, node: &mut Node) {
        match node {
            Node::Robot(robot) if self.periods_count => robot.count_periods(PRESENT_PERIOD),
            Node::AccessPoint(point) if self.periods_count => point.count_periods(PRESENT_PERIOD),
            Node::AccessPoint(point) => point.await_nobody(),
            _ => {}
        }
    }

    /// Takes up a node that has heard the beacons given.
    pub fn take_up(&mut self, mut node: Node, heard: Vec<BeaconId>) -> LocalId {
        let (period, roll, confirmed) = node.tell_now(self.periods_count);
        if let Node::Robot(robot) = &node {
            debug_assert!(robot.leaves_out_nothing(), "{:?}", robot.account());
        }
        let account = node.account(self.periods_count).into_iter();
        let told = account.map(|paragraph| number_in(&mut self.paragraphs, paragraph));
        let key: Box<[u32]> = told.chain(heard.iter().copied()).collect();
        if let Some(&id) = self.local_ids.get(&key) {
            return id;
        }
        let beacon = self.beacons.number_of(Arc::new(node.beacon(self.periods_count)));
        let message = self.messages.number_of(Said { beacon, period, roll, confirmed });
        let id = self.locals.len() as LocalId;
        self.locals.push(Local { node, beacon, message, heard });
        self.local_ids.insert(key, id);
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
        if let Stimulus::Hear(messages) | Stimulus::Round(messages) = &key.1 {
            self.hear(&mut node, messages)?;
            self.apply(&mut node, &key.1)?;
            heard = self.last_heard(&node, &heard, messages);
        } else {
            self.apply(&mut node, &key.1)?;
        }
        let outcome = self.take_up(node, heard);
        self.outcomes.insert(key, outcome);
        Ok(outcome)
    }

    fn hear(&self, node: &mut Node, messages: &[MessageId]) -> Result<(), RobotError> {
        messages.iter().try_for_each(|&id| {
            let Said { beacon, period, roll, confirmed } = &self.messages[id];
            let beacon = &self.beacons[*beacon];
            let message = Message::Beacon {
                period: *period,
                roll: roll.clone(),
                confirmed: *confirmed,
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
            (Node::Robot(robot), &Stimulus::CountedPeriod { still, is_next }) => {
                robot.begin_counted_period(still, is_next)
            }
            (Node::AccessPoint(access_point), &Stimulus::CountedPeriod { is_next, .. }) => {
                Ok(access_point.begin_counted_period(is_next)?)
            }
            (node, Stimulus::Round(_)) => node.tick(self.periods_count),
            _ => Ok(()),
        }
    }

    /// The beacon that a node goes by of each of those that it knows now; it may have refused a late
    /// one.
    fn last_heard(&self, node: &Node, known: &[BeaconId], heard: &[MessageId]) -> Vec<BeaconId> {
        let heard = heard.iter().map(|&id| self.messages[id].beacon);
        let Some(robot) = node.robot() else { return heard.collect() };
        let number = |held: &Arc<Beacon>| {
            let is_held = |id: &BeaconId| Arc::ptr_eq(&self.beacons[*id], held);
            heard.clone().chain(known.iter().copied()).find(is_held)
        };
        robot.beacons().filter_map(number).collect()
    }
}
