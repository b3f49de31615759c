//! The protocol of the network as a model: robots on a graph of places, and a medium.

use std::fmt;
use std::sync::Arc;

use pleach_automaton::network::beacon::Notice;
use pleach_automaton::network::order::Order;
use pleach_automaton::network::robot::RobotError;
use pleach_automaton::network::{
    AccessPoint, Automata, Message, Robot, RobotView, Site, SiteError,
};
use pleach_automaton::node::Input;
use pleach_discrete::network::NodeId;

use super::medium::{Copied, Faults, Medium};
use super::node::{Local, LocalId, MessageId, Node, Nodes, Stimulus};
use super::places::{PlaceGraph, PlaceId};
use super::properties::has_ended;
use crate::{Fairness, Model};

/// What is explored: the places of robots, the medium, and how often a robot is in another's way.
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// The graph.
    pub places: PlaceGraph,
    /// The medium.
    pub medium: Medium,
    /// How many times a parked robot is in the way of a mover at the same place.
    pub contacts: u32,
}

/// Something that happens in the network.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Action {
    /// All nodes send, then all receive.
    Round,
    /// The same, but `to` does not hear `from`.
    Lose {
        /// The sender.
        from: NodeId,
        /// The receiver.
        to: NodeId,
    },
    /// The same, but `to` hears of `from` what it heard last.
    Delay {
        /// The sender.
        from: NodeId,
        /// The receiver.
        to: NodeId,
    },
    /// The same, and a copy of what `to` hears of `from` will arrive later.
    Copy {
        /// The sender.
        from: NodeId,
        /// The receiver.
        to: NodeId,
    },
    /// The same, but the copy arrives in place of what `from` sends.
    Echo {
        /// The sender.
        from: NodeId,
        /// The receiver.
        to: NodeId,
    },
    /// A node hears all nodes in range.
    Listen(NodeId),
    /// `to` receives what `from` sends now or, if it is out of range, nothing of it any more.
    Hear {
        /// The sender.
        from: NodeId,
        /// The receiver.
        to: NodeId,
    },
    /// A node processes what it knows.
    Deliberate(NodeId),
    /// A robot comes to the next place on its way.
    Move(NodeId),
    /// A parked robot at the same place does not let a mover pass.
    Touch(NodeId),
    /// A robot stops, where it stands.
    Stop(NodeId),
    /// A robot that has stopped begins again, and has forgotten everything.
    Restart(NodeId),
    /// A control period begins: where these do not count, when no node has news.
    Period,
    /// The access points serve the user: a task is announced, or none is left.
    Announce,
}

impl Action {
    /// Whether this may stay away for ever: faults, and robots that are in each other's way.
    pub const fn is_optional(&self) -> bool {
        use Action::{Copy, Delay, Echo, Lose, Restart, Stop, Touch};
        matches!(
            self,
            Lose { .. }
                | Delay { .. }
                | Copy { .. }
                | Echo { .. }
                | Touch(_)
                | Stop(_)
                | Restart(_)
        )
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Action::Round => write!(f, "all nodes hear all nodes in range"),
            Action::Lose { from, to } => write!(f, "in a round {to} does not hear {from}"),
            Action::Delay { from, to } => {
                write!(f, "in a round {to} hears of {from} what it heard before")
            }
            Action::Copy { from, to } => {
                write!(f, "in a round what {to} hears of {from} is copied on the way")
            }
            Action::Echo { from, to } => {
                write!(f, "in a round {to} hears the copy of what {from} sent")
            }
            Action::Listen(node) => write!(f, "{node} hears all nodes in range"),
            Action::Hear { from, to } => write!(f, "{to} hears {from}"),
            Action::Deliberate(node) => write!(f, "{node} deliberates"),
            Action::Move(robot) => write!(f, "{robot} moves on"),
            Action::Touch(robot) => write!(f, "{robot} cannot pass a robot at its place"),
            Action::Stop(robot) => write!(f, "{robot} stops"),
            Action::Restart(robot) => write!(f, "{robot} begins again"),
            Action::Period => write!(f, "a control period begins"),
            Action::Announce => write!(f, "the access points serve the user"),
        }
    }
}

/// The state of the network: the state of every node, and what the medium and the bodies may
/// still do. Its nodes are those of the [`Protocol`] that made it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct State {
    /// Robots first, then access points.
    pub locals: Arc<[LocalId]>,
    /// Contacts left.
    contacts: u32,
    /// Faults of the medium left.
    pub(super) faults: Faults,
    /// Copies of messages that are on their way.
    pub(super) copies: Vec<Copied>,
    /// How many rounds of its period have passed, where there are periods.
    pub(super) round: u32,
    /// The robots that have moved in this period, as bits, where there are periods.
    pub(super) moved: u32,
    /// The robots that have stopped, as bits.
    stopped: u32,
    /// The robots that have begun again, as bits.
    restarted: u32,
}

impl State {
    /// Whether a node runs.
    pub const fn is_running(&self, node: NodeId) -> bool {
        self.stopped >> node & 1 == 0
    }

    /// Whether a robot has stopped, whether or not it has begun again.
    pub const fn has_failed(&self, robot: NodeId) -> bool {
        (self.stopped | self.restarted) >> robot & 1 != 0
    }

    /// Whether any robot has.
    pub const fn has_failures(&self) -> bool {
        self.stopped | self.restarted != 0
    }

    /// Whether a robot has moved in this period.
    const fn has_moved(&self, robot: NodeId) -> bool {
        self.moved >> robot & 1 != 0
    }
}

/// Why a configuration cannot be explored.
#[derive(Debug, thiserror::Error)]
pub enum ProtocolError {
    /// The scenario of the places is not valid.
    #[error(transparent)]
    Site(#[from] SiteError),
    /// A node cannot go on.
    #[error(transparent)]
    Node(#[from] RobotError),
}

/// The composed protocol as a model to explore.
#[derive(Debug)]
pub struct Protocol {
    configuration: Configuration,
    nodes: Nodes,
    initial: State,
    site: Arc<Site>,
}

impl Protocol {
    /// The network of a configuration when the tree stands and the first task is about to be
    /// announced.
    ///
    /// # Errors
    /// When the network cannot be made, or a robot cannot go on.
    pub fn new(configuration: Configuration) -> Result<Self, ProtocolError> {
        let places = configuration.places.clone();
        let scenario = places.scenario();
        let mut site = Site::new(&scenario)?.measured_by(places.clone());
        site.automata = site.automata.counted();
        let site = Arc::new(site);
        let positions = (0..places.count()).map(|place| places.position(place)).collect();
        let mut nodes = Nodes::new(positions, configuration.medium.periods_count());
        let robots = scenario.robot.iter().enumerate().map(|(id, start)| {
            let robot = Robot::new(id, start.position.into(), start.rate, Arc::clone(&site));
            Node::Robot(Box::new(robot))
        });
        let access_points = (0..scenario.access_point.len())
            .map(|number| AccessPoint::new(number, Arc::clone(&site)))
            .map(|access_point| Node::AccessPoint(Box::new(access_point)));
        let user = scenario.robot.len() + scenario.access_point.len();
        let request = Message::Request(Order::by(0, &scenario.task));
        let mut locals = Vec::with_capacity(user);
        for mut node in robots.chain(access_points) {
            // The first control period begins, and does not end until the explorer ends it.
            node.step(Input::Tick { passed: 0 })?;
            if locals.len() == scenario.robot.len() {
                node.step(Input::Heard { from: user, message: &request })?;
            }
            nodes.date(&mut node);
            locals.push(nodes.take_up(node, Vec::new()));
        }
        let locals = locals.into();
        let Configuration { medium, contacts, .. } = configuration;
        let round = if medium.periods_count() { 0 } else { medium.period().unwrap_or(0) };
        let faults = medium.faults();
        let initial = State {
            locals,
            contacts,
            faults,
            copies: Vec::new(),
            round,
            moved: 0,
            stopped: 0,
            restarted: 0,
        };
        let mut protocol = Protocol { configuration, nodes, initial, site };
        protocol.settle()?;
        Ok(protocol)
    }

    /// Rounds until no node has news.
    fn settle(&mut self) -> Result<(), RobotError> {
        loop {
            let mut next = self.initial.clone();
            let heard = self.all_heard(&next);
            next.locals = self.each(&next, |node| Stimulus::Hear(heard[node].clone()))?;
            if next == self.initial {
                return Ok(());
            }
            self.initial = next;
        }
    }

    /// Which paths count: where moves wait for the end of a control period, those that use every way out
    /// that they pass forever.
    pub const fn fairness(&self) -> Fairness {
        match self.configuration.medium.periods_count() {
            true => Fairness::Strong,
            false => Fairness::Weak,
        }
    }

    /// The automata that the nodes run, which count the rows that are taken.
    pub fn automata(&self) -> &Automata {
        &self.site.automata
    }

    /// The robots of a state that run.
    pub fn running<'a>(&'a self, state: &'a State) -> impl Iterator<Item = RobotView<'a>> {
        self.robots(state).filter(|robot| state.is_running(robot.id()))
    }

    /// Whether others heed what a node says: it knows which control period this is.
    pub fn is_heeded(&self, state: &State, node: NodeId) -> bool {
        let period = |node: NodeId| self.nodes.period(self.nodes.local(state.locals[node]).message);
        period(node) == period(self.configuration.places.robots())
    }

    /// What is explored.
    pub const fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// The nodes of a state, robots first.
    pub fn locals<'a>(&'a self, state: &'a State) -> impl Iterator<Item = &'a Local> {
        state.locals.iter().map(|&id| self.nodes.local(id))
    }

    /// The robots of a state.
    pub fn robots<'a>(&'a self, state: &'a State) -> impl Iterator<Item = RobotView<'a>> {
        self.locals(state).filter_map(Local::robot)
    }

    /// All states of single nodes.
    pub const fn nodes(&self) -> &Nodes {
        &self.nodes
    }

    pub(super) const fn nodes_mut(&mut self) -> &mut Nodes {
        &mut self.nodes
    }

    /// Where a node is.
    pub fn place_of(&self, state: &State, node: NodeId) -> PlaceId {
        match self.nodes.local(state.locals[node]).robot() {
            Some(robot) => self.configuration.places.place_at(robot.position()),
            None => node,
        }
    }

    // ---- Messages ----------------------------------------------------------------------------

    pub(super) fn is_in_range(&self, state: &State, one: NodeId, other: NodeId) -> bool {
        let (places, robots) = (&self.configuration.places, self.configuration.places.robots());
        let is_wire = one >= robots && other >= robots;
        let linked = || places.are_linked(self.place_of(state, one), self.place_of(state, other));
        one != other && (is_wire || linked())
    }

    /// What a node hears if it hears all nodes in range.
    pub(super) fn all_heard_by(&self, state: &State, receiver: NodeId) -> Vec<MessageId> {
        (0..state.locals.len())
            .filter(|&sender| state.is_running(sender))
            .filter(|&sender| self.is_in_range(state, sender, receiver))
            .map(|sender| self.nodes.local(state.locals[sender]).message)
            .collect()
    }

    /// What each node hears; those that have stopped hear nothing.
    pub(super) fn all_heard(&self, state: &State) -> Vec<Vec<MessageId>> {
        let heard_by = |receiver| match state.is_running(receiver) {
            true => self.all_heard_by(state, receiver),
            false => Vec::new(),
        };
        (0..state.locals.len()).map(heard_by).collect()
    }

    /// What `to` knows if it now hears `from`; none if there is nothing new.
    pub(super) fn heard_from(
        &mut self,
        state: &State,
        from: NodeId,
        to: NodeId,
    ) -> Option<Vec<MessageId>> {
        let mut heard = self.still_heard_by(state, to);
        let sender_of = |&id: &MessageId| self.nodes.said(id).sender;
        let said = self.nodes.local(state.locals[from]).message;
        let known = heard.binary_search_by_key(&from, sender_of);
        match (known, self.is_in_range(state, from, to)) {
            (Ok(at), true) if heard[at] != said => heard[at] = said,
            (Err(at), true) => heard.insert(at, said),
            (Ok(at), false) => {
                heard.remove(at);
            }
            _ => return None,
        }
        Some(heard)
    }

    /// Which nodes run and are connected to an access point by others that run.
    pub fn connected(&self, state: &State) -> Vec<bool> {
        let robots = self.configuration.places.robots();
        let mut reached: Vec<bool> = (0..state.locals.len()).map(|node| node >= robots).collect();
        loop {
            let joins = |node: NodeId| {
                let mut others = (0..state.locals.len()).filter(|&other| reached[other]);
                others.any(|other| self.is_in_range(state, node, other))
            };
            let next =
                (0..robots).find(|&node| !reached[node] && state.is_running(node) && joins(node));
            match next {
                Some(node) => reached[node] = true,
                None => return reached,
            }
        }
    }

    // ---- Steps of nodes ----------------------------------------------------------------------

    pub(super) fn each(
        &mut self,
        state: &State,
        stimulus: impl Fn(NodeId) -> Stimulus,
    ) -> Result<Arc<[LocalId]>, RobotError> {
        state
            .locals
            .iter()
            .enumerate()
            .map(|(node, &local)| match state.is_running(node) {
                true => self.nodes.after(local, stimulus(node)),
                false => Ok(local),
            })
            .collect()
    }

    pub(super) fn one(
        &mut self,
        state: &State,
        node: NodeId,
        stimulus: Stimulus,
    ) -> Result<State, RobotError> {
        let mut next = state.clone();
        let local = self.nodes.after(state.locals[node], stimulus)?;
        if local != state.locals[node] {
            next.locals = with(&state.locals, node, local);
        }
        Ok(next)
    }

    // ---- Bodies ------------------------------------------------------------------------------

    /// The next place on the way of a robot that no link of the tree keeps from going there.
    pub fn next_place(&self, state: &State, robot: NodeId) -> Option<PlaceId> {
        let places = &self.configuration.places;
        let body = self.nodes.local(state.locals[robot]).robot()?;
        if self.configuration.medium.periods_count()
            && !(state.is_running(robot) && body.may_leave_place())
        {
            return None;
        }
        let (here, goal) = (self.place_of(state, robot), places.place_at(body.goal()?));
        let mut held: Vec<NodeId> = body.tree_links().iter().map(|link| link.to).collect();
        held.extend((0..places.robots()).filter(|&other| {
            let other = self.nodes.local(state.locals[other]).robot();
            other.is_some_and(|other| {
                state.is_running(other.id()) && other.tree_parent() == Some(robot)
            })
        }));
        let holds = |place: &PlaceId| {
            held.iter().all(|&other| places.are_linked(*place, self.place_of(state, other)))
        };
        places.next_steps(here, goal).find(holds)
    }

    /// Whether a robot that is on its way shares its place with one that could take its duty over: a parked one, or a
    /// member of the primary team that stands still.
    fn is_in_contact(&self, state: &State, robot: NodeId) -> bool {
        let body = |node: NodeId| self.nodes.local(state.locals[node]).robot();
        let here = self.place_of(state, robot);
        state.is_running(robot)
            && body(robot).is_some_and(|mover| !mover.is_parked() && mover.goal().is_some())
            && (0..self.configuration.places.robots()).any(|other| {
                other != robot
                    && state.is_running(other)
                    && self.place_of(state, other) == here
                    && body(other).is_some_and(|it| it.is_parked() || it.stands_in_team())
            })
    }

    /// For how long a robot has made no progress when another period is over.
    fn stillness(&self, state: &State, robot: NodeId) -> u32 {
        let Some(body) = self.nodes.local(state.locals[robot]).robot() else { return 0 };
        let still = body.still_periods();
        if body.is_parked() || self.next_place(state, robot).is_some() {
            return 0;
        }
        let thresholds = body.still_thresholds();
        if self.configuration.medium.periods_count() {
            // The end of patience comes when all other waits are over.
            return (still + 1).min(thresholds[1]).max(still);
        }
        thresholds.into_iter().find(|&next| next > still).unwrap_or(still)
    }

    // ---- What may happen ---------------------------------------------------------------------

    fn bodies(&mut self, state: &State) -> Result<Vec<(Action, State)>, RobotError> {
        let mut found = Vec::new();
        let period = self.configuration.medium.period();
        if period.is_some() && !self.period_is_over(state) {
            return Ok(found);
        }
        for robot in 0..self.configuration.places.robots() {
            let may_move = !state.has_moved(robot);
            if let Some(place) = self.next_place(state, robot).filter(|_| may_move) {
                let mut next = self.one(state, robot, Stimulus::Move(place))?;
                if period.is_some() {
                    next.moved |= 1 << robot;
                }
                found.push((Action::Move(robot), next));
            }
            if state.contacts > 0 && self.is_in_contact(state, robot) {
                let body = self.nodes.local(state.locals[robot]).robot();
                let still = body.map_or(0, |body| body.still_thresholds()[1]);
                let mut next = self.one(state, robot, Stimulus::Period(still))?;
                next.contacts -= 1;
                found.push((Action::Touch(robot), next));
            }
        }
        Ok(found)
    }

    /// A control period: long enough for all news to be heard.
    fn period(&mut self, state: &State) -> Result<State, RobotError> {
        let robots = self.configuration.places.robots();
        let still: Vec<u32> = (0..robots).map(|robot| self.stillness(state, robot)).collect();
        let mut next = state.clone();
        next.locals = self.each(state, |node| match still.get(node) {
            Some(&still) => Stimulus::Period(still),
            None => Stimulus::Announce,
        })?;
        Ok(next)
    }

    /// Where control periods count, another one.
    fn counted_period(&mut self, state: &State) -> Result<State, RobotError> {
        let robots = self.configuration.places.robots();
        let still: Vec<u32> = (0..robots).map(|robot| self.stillness(state, robot)).collect();
        let mut next = self.next_period(state, &still)?;
        let moves = (0..robots).any(|robot| self.next_place(state, robot).is_some());
        if !moves && self.end_of_period(&next)? == state.locals {
            // Nothing happens any more but that patience ends.
            let last = |robot: NodeId| {
                let body = self.nodes.local(state.locals[robot]).robot();
                body.map_or(0, |body| body.still_thresholds()[2])
            };
            let still: Vec<u32> =
                (0..robots).map(|it| if still[it] > 0 { last(it) } else { 0 }).collect();
            next = self.next_period(state, &still)?;
        }
        Ok(next)
    }

    /// What comes of a control period that has begun, if nothing fails.
    fn end_of_period(&mut self, begun: &State) -> Result<Arc<[LocalId]>, RobotError> {
        let mut now = begun.clone();
        for _ in 0..self.configuration.medium.period().unwrap_or(0) {
            let heard = self.all_heard(&now);
            now.locals = self.each(&now, |node| Stimulus::Round(heard[node].clone()))?;
        }
        Ok(now.locals)
    }

    /// A control period begins. Its number is that of the one before, and earlier ones are numbered anew,
    /// unless a robot has made a post in that one: the numbers of posts do not change.
    fn next_period(&mut self, state: &State, still: &[u32]) -> Result<State, RobotError> {
        let is_next = self.robots(state).any(RobotView::has_made_post);
        let mut next = state.clone();
        (next.round, next.moved) = (0, 0);
        next.locals = self.each(state, |node| {
            let still = still.get(node).copied().unwrap_or_default();
            Stimulus::CountedPeriod { still, is_next }
        })?;
        Ok(next)
    }

    /// A robot may stop at any moment between two rounds, and begin again with a control period.
    fn failures(&mut self, state: &State) -> Result<Vec<(Action, State)>, RobotError> {
        let mut found = Vec::new();
        for robot in 0..self.configuration.places.robots() {
            let is_running = state.is_running(robot);
            if is_running && state.faults.stops > 0 {
                let mut next = state.clone();
                next.faults.stops -= 1;
                next.stopped |= 1 << robot;
                let body = self.robot_anew(state, robot);
                let local = self.nodes.take_up(body, Vec::new());
                next.locals = with(&state.locals, robot, local);
                found.push((Action::Stop(robot), next));
            }
            if !is_running && state.faults.restarts > 0 && state.round == 0 {
                let mut next = state.clone();
                next.faults.restarts -= 1;
                next.stopped &= !(1 << robot);
                next.restarted |= 1 << robot;
                let mut body = self.robot_anew(state, robot);
                body.step(Input::Tick { passed: 0 })?;
                let local = self.nodes.take_up(body, Vec::new());
                next.locals = with(&state.locals, robot, local);
                found.push((Action::Restart(robot), next));
            }
        }
        Ok(found)
    }

    /// A robot that knows nothing, where this one stands.
    fn robot_anew(&self, state: &State, robot: NodeId) -> Node {
        let position = self.configuration.places.position(self.place_of(state, robot));
        Node::Robot(Box::new(Robot::new(robot, position, RATE, Arc::clone(&self.site))))
    }

    /// The user asks when nothing is under way.
    fn announcement(&mut self, state: &State) -> Result<Option<State>, RobotError> {
        let first = self.configuration.places.robots();
        let is_due = matches!(
            self.nodes.local(state.locals[first]).notice(),
            Notice::Quiet | Notice::Serviced { .. } | Notice::Withdrawn { .. }
        );
        match is_due {
            true => self.one(state, first, Stimulus::Announce).map(Some),
            false => Ok(None),
        }
    }

    /// Everything that may happen while no message fails.
    ///
    /// # Errors
    /// When a node cannot go on.
    pub fn faultless_steps(&mut self, state: &State) -> Result<Vec<(Action, State)>, RobotError> {
        if self.configuration.medium.periods_count() {
            return self.steps_in_periods(state);
        }
        let mut found = self.messages(state)?;
        let everything_is_known = found.is_empty();
        found.extend(self.bodies(state)?);
        if let Some(next) = self.announcement(state)?.filter(|next| next != state) {
            found.push((Action::Announce, next));
        }
        if everything_is_known {
            let next = self.period(state)?;
            if next != *state {
                found.push((Action::Period, next));
            }
        }
        Ok(found)
    }

    /// The same where control periods count: rounds, then moves, then the next one, until the mission has
    /// ended.
    fn steps_in_periods(&mut self, state: &State) -> Result<Vec<(Action, State)>, RobotError> {
        if has_ended(self, state) {
            return Ok(Vec::new());
        }
        let mut found = self.messages(state)?;
        found.extend(self.bodies(state)?);
        if self.period_is_over(state) {
            let next = self.counted_period(state)?;
            found.push((Action::Period, next));
        }
        Ok(found)
    }
}

/// Every robot has nothing to send: routes are left out.
pub(super) const RATE: f64 = 0.0;

fn with(locals: &[LocalId], node: NodeId, local: LocalId) -> Arc<[LocalId]> {
    let mut locals = locals.to_vec();
    locals[node] = local;
    locals.into()
}

impl Model for Protocol {
    type State = State;
    type Action = Action;
    type Error = RobotError;

    fn initial(&mut self) -> Result<Vec<State>, RobotError> {
        Ok(vec![self.initial.clone()])
    }

    fn successors(&mut self, state: &State) -> Result<Vec<(Action, State)>, RobotError> {
        let mut found = self.faultless_steps(state)?;
        if !(self.configuration.medium.periods_count() && has_ended(self, state)) {
            found.extend(self.faulty_rounds(state)?);
            found.extend(self.failures(state)?);
        }
        Ok(found)
    }
}
