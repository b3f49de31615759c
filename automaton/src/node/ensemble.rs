//! Nodes and the medium between them, composed to a system.
//!
//! # Rounds
//!
//! A round of jumps is the delivery of all messages that arrive now; if none does, because none is
//! on its way or the medium has lost them, it is the tick
//! of every node whose clock is due, in ascending order. A node may let rounds of ticks pass
//! ([`rounds_to_pass`](Node::rounds_to_pass)); one in which no node ticks does not take place, and
//! is counted all the same. Messages that are sent in a round are
//! given to the medium at its end. So a message that takes no time is heard, and all that is said
//! in answer, before any clock ticks again. Steps of different nodes in one round do not see each
//! other: the ticks of a round are one joint jump, and so are its deliveries.

use std::convert::Infallible;

use super::{Input, Medium, Node, NodeId, Observed, Outputs};
use crate::Participants;
use crate::executor::{Round, System};

/// A joint jump of an ensemble; who takes part stands in the trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum NodeJump {
    /// Clocks tick.
    Ticked,
    /// Messages arrive.
    Heard,
}

/// How many messages a node has sent and heard.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    /// Messages sent; a broadcast counts once.
    pub sent: u64,
    /// Messages heard.
    pub heard: u64,
}

/// Nodes of one type, with the medium that carries their messages.
///
/// It knows of its nodes nothing but that they are nodes, so that nothing goes from one to
/// another past the medium.
#[derive(Debug)]
pub struct Ensemble<N: Node, M> {
    nodes: Vec<N>,
    medium: M,
    outputs: Outputs<N::Message, N::Report>,
    bodies: Vec<N::Body>,
    has_moved: bool,
    seats: Vec<Seat>,
    /// The round at this instant in which each node ticks next, if it hears nothing until then.
    ticks: Vec<Option<usize>>,
    /// The nodes that take part in the current jump.
    participants: Vec<NodeId>,
    /// The round of ticks at this instant that comes next, from 1.
    round: usize,
}

/// What the ensemble keeps of each node.
#[derive(Clone, Copy, Debug, Default)]
struct Seat {
    traffic: Traffic,
    /// Whether the node takes part in the current jump.
    takes_part: bool,
    /// The round at this instant in which it has ticked last; 0 if in none.
    ticked: usize,
}

impl<N: Node, M: Medium<N::Message, N::Body>> Ensemble<N, M> {
    /// These nodes, numbered from 0, over this medium.
    pub fn new(nodes: Vec<N>, medium: M) -> Self {
        let mut ensemble = Ensemble {
            bodies: Vec::with_capacity(nodes.len()),
            seats: vec![Seat::default(); nodes.len()],
            ticks: vec![None; nodes.len()],
            participants: Vec::new(),
            outputs: Outputs::of(0),
            has_moved: true,
            round: 1,
            nodes,
            medium,
        };
        ensemble.begin_instant();
        ensemble
    }

    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is no node.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The medium.
    pub const fn medium(&self) -> &M {
        &self.medium
    }

    /// A node senses something, or a person asks it for something; nothing if there is no such
    /// node.
    ///
    /// # Errors
    ///
    /// The error of the node.
    pub fn sense(&mut self, node: NodeId, sensed: N::Sense) -> Result<(), N::Error> {
        self.update_medium();
        if let Some(known) = self.nodes.get_mut(node) {
            known.step(Input::Sensed(sensed), self.outputs.now_of(node))?;
            self.ask(node);
            self.send();
        }
        Ok(())
    }

    /// What the nodes have told observers since the last call, in its order.
    pub fn drain_reports(&mut self) -> std::vec::Drain<'_, (NodeId, N::Report)> {
        self.outputs.drain_reports()
    }

    /// Tells the medium where the nodes are, if time has passed.
    fn update_medium(&mut self) {
        if std::mem::take(&mut self.has_moved) {
            self.bodies.clear();
            self.bodies.extend(self.nodes.iter().map(Node::body));
            self.medium.update(&self.bodies);
        }
    }

    /// A node has changed: asks it when it ticks next.
    fn ask(&mut self, id: NodeId) {
        let node = &self.nodes[id];
        let is_due = node.time_to_tick().is_some_and(|wait| wait <= 0.0);
        self.ticks[id] = is_due.then(|| self.seats[id].ticked + 1 + node.rounds_to_pass());
    }

    fn send(&mut self) {
        for envelope in self.outputs.drain_sent() {
            self.seats[envelope.from].traffic.sent += 1;
            self.medium.send(envelope);
        }
    }

    /// Says whether anything was heard.
    fn deliver(&mut self) -> Result<bool, N::Error> {
        let Ensemble { nodes, medium, outputs, seats, participants, .. } = self;
        medium.deliver_to_each(|delivery| {
            let known = nodes.get_mut(delivery.to).zip(seats.get_mut(delivery.to));
            let Some((node, seat)) = known else { return Ok(()) };
            if !std::mem::replace(&mut seat.takes_part, true) {
                participants.push(delivery.to);
            }
            seat.traffic.heard += 1;
            let input = Input::Heard { from: delivery.from, message: delivery.message };
            node.step(input, outputs.now_of(delivery.to))
        })?;
        (0..self.participants.len()).for_each(|at| self.ask(self.participants[at]));
        Ok(!self.participants.is_empty())
    }

    /// Says whether any clock was due.
    fn tick(&mut self) -> Result<bool, N::Error> {
        let Some(next) = self.ticks.iter().flatten().copied().min() else { return Ok(false) };
        // What a node has heard may make it tick earlier than it has said, and not in the past.
        let round = next.max(self.round);
        for id in 0..self.nodes.len() {
            if self.ticks[id].is_some_and(|ticks| ticks <= round) {
                let seat = &mut self.seats[id];
                let passed = round - seat.ticked - 1;
                (seat.takes_part, seat.ticked) = (true, round);
                self.participants.push(id);
                self.nodes[id].step(Input::Tick { passed }, self.outputs.now_of(id))?;
                self.ask(id);
            }
        }
        self.round = round + 1;
        Ok(true)
    }

    /// Time has passed, or begins.
    fn begin_instant(&mut self) {
        self.round = 1;
        for id in 0..self.nodes.len() {
            self.seats[id].ticked = 0;
            self.ask(id);
        }
    }

    fn record(&mut self, round: &mut Round<'_, NodeJump>, jump: NodeJump) {
        let Ensemble { seats, participants, .. } = self;
        round.jumped_by(jump, || {
            participants.sort_unstable();
            match participants.len() == seats.len() {
                true => Participants::All,
                false => Participants::Some(participants.as_slice().into()),
            }
        });
        participants.drain(..).for_each(|id| seats[id].takes_part = false);
    }
}

impl<N: Node, M> Ensemble<N, M> {
    /// How much a node has sent and heard since the messages were last counted anew; observers
    /// ask for it, and nothing if there is no such node.
    pub fn traffic(&self, node: NodeId) -> Traffic {
        self.seats.get(node).map_or_else(Traffic::default, |seat| seat.traffic)
    }

    /// Counts messages anew.
    pub fn forget_traffic(&mut self) {
        self.seats.iter_mut().for_each(|seat| seat.traffic = Traffic::default());
    }
}

impl<N: Node, M> Ensemble<N, M> {
    /// The nodes, by number, for the program that has set them up.
    pub fn nodes(&self) -> &[N] {
        &self.nodes
    }
}

impl<N: Node + Observed, M> Ensemble<N, M> {
    /// What observers see of each node, by number.
    pub fn views(&self) -> impl ExactSizeIterator<Item = N::View<'_>> {
        self.nodes.iter().map(Observed::view)
    }

    /// What observers see of one node, if there is one with this number.
    pub fn view(&self, node: NodeId) -> Option<N::View<'_>> {
        self.nodes.get(node).map(Observed::view)
    }
}

impl<N: Node, M: Medium<N::Message, N::Body>> System for Ensemble<N, M> {
    type Jump = NodeJump;
    type Finish = Infallible;
    type Error = N::Error;

    fn finished(&self) -> Option<Infallible> {
        None
    }

    fn jump(&mut self, round: &mut Round<'_, NodeJump>) -> Result<(), N::Error> {
        self.update_medium();
        let arrives = self.medium.time_to_arrival().is_some_and(|wait| wait <= 0.0);
        if arrives && self.deliver()? {
            self.send();
            self.record(round, NodeJump::Heard);
        } else if self.tick()? {
            self.send();
            self.record(round, NodeJump::Ticked);
        }
        Ok(())
    }

    fn time_to_jump(&self) -> Result<Option<f64>, N::Error> {
        let ticks = self.nodes.iter().filter_map(Node::time_to_tick);
        Ok(ticks.chain(self.medium.time_to_arrival()).reduce(f64::min))
    }

    fn flow(&mut self, duration: f64) -> Result<(), N::Error> {
        self.nodes.iter_mut().for_each(|node| node.flow(duration));
        self.medium.flow(duration);
        self.has_moved = true;
        self.begin_instant();
        self.nodes.iter().try_for_each(Node::check_invariant)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that panics has failed
mod tests {
    use super::*;
    use crate::node::FullMesh;
    use crate::{Executor, Reason, Trace};

    /// Passes a number on to the next node, one more each time, and rests at a limit; the first
    /// node begins once a second.
    struct Counter {
        next: NodeId,
        begins: bool,
        clock: f64,
        heard: Vec<(NodeId, u32)>,
    }

    impl Node for Counter {
        type Message = u32;
        type Sense = u32;
        type Report = u32;
        type Body = ();
        type Error = Infallible;

        fn step(
            &mut self,
            input: Input<'_, u32, u32>,
            outputs: &mut Outputs<u32, u32>,
        ) -> Result<(), Infallible> {
            match input {
                Input::Heard { from, message } => {
                    self.heard.push((from, *message));
                    outputs.report(*message);
                    if *message < 4 {
                        outputs.send(self.next, message + 1);
                    }
                }
                Input::Sensed(number) => outputs.broadcast(number),
                Input::Tick { .. } => {
                    self.clock = 0.0;
                    outputs.send(self.next, 1);
                }
            }
            Ok(())
        }

        fn time_to_tick(&self) -> Option<f64> {
            self.begins.then_some((1.0 - self.clock).max(0.0))
        }

        fn flow(&mut self, duration: f64) {
            self.clock += duration;
        }

        fn body(&self) {}
    }

    impl Observed for Counter {
        type View<'a> = &'a [(NodeId, u32)];

        fn view(&self) -> &[(NodeId, u32)] {
            &self.heard
        }
    }

    fn three() -> Ensemble<Counter, FullMesh<u32>> {
        let counter = |id: NodeId| Counter {
            next: (id + 1) % 3,
            begins: id == 0,
            clock: 0.0,
            heard: Vec::new(),
        };
        Ensemble::new((0..3).map(counter).collect(), FullMesh::new())
    }

    /// A tick, and all that is said in answer, at each of the instants 1 and 2.
    #[test]
    fn messages_are_heard_before_time_passes() {
        let (mut ensemble, mut trace) = (three(), Trace::new());
        let ending = Executor::new(2.0, 10).unwrap().run(&mut ensemble, &mut trace).unwrap();
        assert_eq!(ending.reason, Reason::Horizon);
        let jumps: Vec<_> = trace.entries().iter().map(|entry| (entry.at.t, entry.jump)).collect();
        let at = |t: f64| {
            let heard = std::iter::repeat_n((t, NodeJump::Heard), 4);
            std::iter::once((t, NodeJump::Ticked)).chain(heard)
        };
        assert_eq!(jumps, at(1.0).chain(at(2.0)).collect::<Vec<_>>());
        let seen: Vec<_> = ensemble.views().map(<[_]>::to_vec).collect();
        assert_eq!(seen[0], [(2, 3), (2, 3)]);
        assert_eq!(seen[1], [(0, 1), (0, 4), (0, 1), (0, 4)]);
        assert_eq!(seen[2], [(1, 2), (1, 2)]);
        let traffic = |sent, heard| Traffic { sent, heard };
        let counted = [0, 1, 2, 3].map(|node| ensemble.traffic(node));
        assert_eq!(counted, [traffic(4, 2), traffic(2, 4), traffic(2, 2), traffic(0, 0)]);
        ensemble.forget_traffic();
        assert_eq!(ensemble.traffic(1), Traffic::default());
    }

    /// Ticks once a round for a few rounds of one instant. A patient one lets rounds pass, and has to
    /// be told of how many; news make it tick at once.
    struct Clerk {
        is_patient: bool,
        rounds: usize,
        has_news: bool,
        ticks: Vec<usize>,
    }

    const ROUNDS: usize = 6;

    impl Node for Clerk {
        type Message = ();
        type Sense = ();
        type Report = ();
        type Body = ();
        type Error = Infallible;

        fn step(
            &mut self,
            input: Input<'_, (), ()>,
            outputs: &mut Outputs<(), ()>,
        ) -> Result<(), Infallible> {
            match input {
                Input::Tick { passed } => {
                    self.rounds += passed + 1;
                    self.has_news = false;
                    self.ticks.push(self.rounds);
                    if !self.is_patient && self.rounds == 3 {
                        outputs.broadcast(());
                    }
                }
                _ => self.has_news = true,
            }
            Ok(())
        }

        fn time_to_tick(&self) -> Option<f64> {
            (self.rounds < ROUNDS).then_some(0.0)
        }

        fn rounds_to_pass(&self) -> usize {
            if self.is_patient && !self.has_news { ROUNDS - 1 - self.rounds } else { 0 }
        }

        fn flow(&mut self, _: f64) {}

        fn body(&self) {}
    }

    #[test]
    fn a_node_lets_rounds_pass_until_it_hears_something() {
        let clerk =
            |is_patient| Clerk { is_patient, rounds: 0, has_news: false, ticks: Vec::new() };
        let mut ensemble = Ensemble::new(vec![clerk(true), clerk(false)], FullMesh::new());
        Executor::new(1.0, 100).unwrap().run(&mut ensemble, &mut ()).unwrap();
        let ticks: Vec<_> = ensemble.nodes.iter().map(|clerk| clerk.ticks.clone()).collect();
        assert_eq!(ticks, [vec![4, 6], vec![1, 2, 3, 4, 5, 6]]);
    }

    #[test]
    fn a_round_in_which_no_node_ticks_does_not_take_place() {
        let patient = Clerk { is_patient: true, rounds: 0, has_news: false, ticks: Vec::new() };
        let (mut ensemble, mut trace) =
            (Ensemble::new(vec![patient], FullMesh::new()), Trace::new());
        Executor::new(1.0, 100).unwrap().run(&mut ensemble, &mut trace).unwrap();
        assert_eq!((trace.entries().len(), &ensemble.nodes[0].ticks[..]), (1, &[6][..]));
    }

    /// What a person asks of a node is told to every other, and observers hear of it in order.
    #[test]
    fn what_is_sensed_is_broadcast() {
        let mut ensemble = three();
        ensemble.sense(1, 4).unwrap();
        ensemble.sense(7, 4).unwrap();
        Executor::new(0.5, 10).unwrap().run(&mut ensemble, &mut ()).unwrap();
        assert_eq!(ensemble.drain_reports().collect::<Vec<_>>(), [(0, 4), (2, 4)]);
        assert_eq!(ensemble.view(1), Some(&[][..]));
        assert_eq!(ensemble.view(3), None);
    }

    /// Burns for one second, its invariant, and is never put out.
    struct Fuse(f64);

    impl Node for Fuse {
        type Message = ();
        type Sense = ();
        type Report = ();
        type Body = ();
        type Error = f64;

        fn step(&mut self, _: Input<'_, (), ()>, _: &mut Outputs<(), ()>) -> Result<(), f64> {
            Ok(())
        }

        fn time_to_tick(&self) -> Option<f64> {
            None
        }

        fn flow(&mut self, duration: f64) {
            self.0 += duration;
        }

        fn check_invariant(&self) -> Result<(), f64> {
            if self.0 <= 1.0 { Ok(()) } else { Err(self.0) }
        }

        fn body(&self) {}
    }

    #[test]
    fn a_flow_that_leaves_an_invariant_ends_the_run() {
        let run = |horizon| {
            let mut ensemble = Ensemble::new(vec![Fuse(0.0), Fuse(-1.0)], FullMesh::new());
            Executor::new(horizon, 10).unwrap().run(&mut ensemble, &mut ())
        };
        assert!(run(1.0).is_ok());
        assert_eq!(run(1.5).unwrap_err(), 1.5);
    }
}
