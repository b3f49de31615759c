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
//!
//! Since they do not, nodes may take their steps at once, on several threads, and a node may hear all of its messages
//! one after another, while its state is in the cache: what nodes answer is put into the order of what they answer. And
//! where none answers, so that ticks follow, each node that is due ticks right after it has heard its mail. Both are
//! still jumps of their own, and nothing but the time that they take tells the difference.

use std::convert::Infallible;

use super::chunks::{Chunks, Slot, Steps};
use super::{Medium, Node, NodeId, Observed};
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
    chunks: Chunks<N>,
    medium: M,
    bodies: Vec<N::Body>,
    has_moved: bool,
    /// The round of ticks at this instant that comes next, or is under way, from 1.
    round: usize,
    /// How many deliveries there have been.
    deliveries: usize,
}

impl<N: Node, M: Medium<N::Message, N::Body>> Ensemble<N, M> {
    /// These nodes, numbered from 0, over this medium.
    pub fn new(nodes: Vec<N>, medium: M) -> Self {
        let chunks = Chunks::new(nodes);
        Ensemble { chunks, medium, bodies: Vec::new(), has_moved: true, round: 1, deliveries: 0 }
    }

    /// The number of nodes.
    pub fn len(&self) -> usize {
        self.chunks.nodes.len()
    }

    /// Whether there is no node.
    pub fn is_empty(&self) -> bool {
        self.chunks.nodes.is_empty()
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
        self.chunks.sense(node, sensed)?;
        self.chunks.send(&mut self.medium);
        Ok(())
    }

    /// What the nodes have told observers since the last call, in its order.
    pub fn drain_reports(&mut self) -> std::vec::Drain<'_, (NodeId, N::Report)> {
        self.chunks.drain_reports()
    }

    /// Tells the medium where the nodes are, if time has passed.
    fn update_medium(&mut self) {
        if std::mem::take(&mut self.has_moved) {
            self.bodies.clear();
            self.bodies.extend(self.chunks.nodes.iter().map(Node::body));
            self.medium.update(&self.bodies);
        }
    }

    /// Delivers what arrives now, and says whether anything was heard. Where messages are not answered, nodes that
    /// are due in the round of ticks that follows take it as well.
    fn deliver(&mut self) -> Result<bool, N::Error> {
        if !self.medium.time_to_arrival().is_some_and(|wait| wait <= 0.0) {
            return Ok(false);
        }
        self.deliveries += 1;
        let Ensemble { chunks, medium, round, deliveries, .. } = self;
        if let Some(mail) = medium.mail() {
            let round = (!mail.may_be_answered()).then_some(*round);
            chunks.take(&Steps { mail: Some((mail, *deliveries)), round })?;
        } else {
            medium.deliver(|delivery| chunks.hear(delivery, *deliveries))?;
        }
        chunks.send(medium);
        Ok(chunks.slots.iter().any(|slot| slot.heard == *deliveries))
    }

    /// Says whether any clock was due.
    fn tick(&mut self) -> Result<bool, N::Error> {
        let Some(next) = self.chunks.slots.iter().filter_map(|slot| slot.ticks).min() else {
            return Ok(false);
        };
        // What a node has heard may make it tick earlier than it has said, and not in the past.
        self.round = next.max(self.round);
        self.chunks.take(&Steps { mail: None, round: Some(self.round) })?;
        self.chunks.send(&mut self.medium);
        Ok(true)
    }

    /// Whether nodes have ticked in this round.
    fn has_ticked(&self) -> bool {
        self.chunks.slots.iter().any(|slot| slot.ticked == self.round)
    }

    /// Records a jump of the nodes in whose slots this holds.
    fn record(
        &self,
        round: &mut Round<'_, NodeJump>,
        jump: NodeJump,
        takes_part: impl Fn(&Slot) -> bool,
    ) {
        round.jumped_by(jump, || {
            let slots = self.chunks.slots.iter().enumerate();
            let by: Box<[NodeId]> =
                slots.filter(|(_, slot)| takes_part(slot)).map(|(id, _)| id).collect();
            if by.len() == self.len() { Participants::All } else { Participants::Some(by) }
        });
    }
}

impl<N: Node, M> Ensemble<N, M> {
    /// How much a node has sent and heard since the messages were last counted anew; observers
    /// ask for it, and nothing if there is no such node.
    pub fn traffic(&self, node: NodeId) -> Traffic {
        self.chunks.slots.get(node).map_or_else(Traffic::default, |slot| slot.traffic)
    }

    /// Counts messages anew.
    pub fn forget_traffic(&mut self) {
        self.chunks.slots.iter_mut().for_each(|slot| slot.traffic = Traffic::default());
    }
}

impl<N: Node, M> Ensemble<N, M> {
    /// The nodes, by number, for the program that has set them up.
    pub fn nodes(&self) -> &[N] {
        &self.chunks.nodes
    }
}

impl<N: Node + Observed, M> Ensemble<N, M> {
    /// What observers see of each node, by number.
    pub fn views(&self) -> impl ExactSizeIterator<Item = N::View<'_>> {
        self.chunks.nodes.iter().map(Observed::view)
    }

    /// What observers see of one node, if there is one with this number.
    pub fn view(&self, node: NodeId) -> Option<N::View<'_>> {
        self.chunks.nodes.get(node).map(Observed::view)
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
        if !self.has_ticked() && self.deliver()? {
            self.record(round, NodeJump::Heard, |slot| slot.heard == self.deliveries);
        } else if self.has_ticked() || self.tick()? {
            self.record(round, NodeJump::Ticked, |slot| slot.ticked == self.round);
            self.round += 1;
        }
        Ok(())
    }

    fn time_to_jump(&self) -> Result<Option<f64>, N::Error> {
        let ticks = self.chunks.nodes.iter().filter_map(Node::time_to_tick);
        Ok(ticks.chain(self.medium.time_to_arrival()).reduce(f64::min))
    }

    fn flow(&mut self, duration: f64) -> Result<(), N::Error> {
        (self.has_moved, self.round) = (true, 1);
        self.medium.flow(duration);
        self.chunks.flow(duration)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // a test that panics has failed
mod tests {
    use super::*;
    use crate::node::{Delivery, Destination, Envelope, FullMesh, Input, Mail, Outputs};
    use crate::{Executor, Reason, Trace, TraceEntry};

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
        let ticks: Vec<_> = ensemble.chunks.nodes.iter().map(|clerk| clerk.ticks.clone()).collect();
        assert_eq!(ticks, [vec![4, 6], vec![1, 2, 3, 4, 5, 6]]);
    }

    #[test]
    fn a_round_in_which_no_node_ticks_does_not_take_place() {
        let patient = Clerk { is_patient: true, rounds: 0, has_news: false, ticks: Vec::new() };
        let (mut ensemble, mut trace) =
            (Ensemble::new(vec![patient], FullMesh::new()), Trace::new());
        Executor::new(1.0, 100).unwrap().run(&mut ensemble, &mut trace).unwrap();
        assert_eq!((trace.entries().len(), &ensemble.chunks.nodes[0].ticks[..]), (1, &[6][..]));
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

    /// No node has this number.
    const NOBODY: NodeId = 1_000;

    /// Adds up what it hears, weighted by when, and tells its sum in each of some rounds of one instant.
    #[derive(Clone, Debug, PartialEq)]
    struct Adder {
        sum: u64,
        rounds: u64,
        is_lonely: bool,
        answers: bool,
    }

    /// What a node answers; nothing is answered to it.
    const ANSWER: u64 = 1;

    impl Node for Adder {
        type Message = u64;
        type Sense = ();
        type Report = u64;
        type Body = ();
        type Error = Infallible;

        fn step(
            &mut self,
            input: Input<'_, u64, ()>,
            outputs: &mut Outputs<u64, u64>,
        ) -> Result<(), Infallible> {
            match input {
                Input::Heard { from, message } => {
                    self.sum = self.sum.wrapping_mul(31).wrapping_add(*message % 97 + self.rounds);
                    if self.answers && message.is_multiple_of(3) {
                        outputs.report(self.sum);
                        outputs.send(from, ANSWER);
                    }
                }
                Input::Sensed(()) => {}
                Input::Tick { passed } => {
                    self.rounds += passed as u64 + 1;
                    outputs.report(self.sum);
                    match self.is_lonely {
                        true => outputs.send(NOBODY, self.sum),
                        false => outputs.broadcast(self.sum),
                    }
                }
            }
            Ok(())
        }

        fn time_to_tick(&self) -> Option<f64> {
            (self.rounds < 4).then_some(0.0)
        }

        /// Every third of those that have heard nothing lets rounds pass.
        fn rounds_to_pass(&self) -> usize {
            if self.sum.is_multiple_of(3) && self.rounds < 2 { 1 } else { 0 }
        }

        fn flow(&mut self, _: f64) {}

        fn body(&self) {}
    }

    /// A full mesh that offers its messages as mail.
    struct Sorted {
        mesh: FullMesh<u64>,
        nodes: Vec<NodeId>,
        mail: Mail<u64>,
        answers: bool,
    }

    impl Medium<u64, ()> for Sorted {
        fn update(&mut self, bodies: &[()]) {
            self.nodes = (0..bodies.len()).collect();
            self.mesh.update(bodies);
        }

        fn send(&mut self, envelope: Envelope<u64>) {
            Medium::<u64, ()>::send(&mut self.mesh, envelope);
        }

        fn time_to_arrival(&self) -> Option<f64> {
            Medium::<u64, ()>::time_to_arrival(&self.mesh)
        }

        fn flow(&mut self, _: f64) {}

        fn deliver<E>(
            &mut self,
            hand_over: impl FnMut(Delivery<'_, u64>) -> Result<(), E>,
        ) -> Result<(), E> {
            Medium::<u64, ()>::deliver(&mut self.mesh, hand_over)
        }

        fn mail(&mut self) -> Option<&Mail<u64>> {
            let mut sent = Vec::new();
            let Ok(()) = self.deliver(|Delivery { from, to, message }| {
                sent.push(Envelope { from, to: Destination::One(to), message: *message });
                Ok::<(), Infallible>(())
            });
            let Sorted { nodes, mail, answers, .. } = self;
            let receivers_of = |envelope: &Envelope<u64>| match envelope.to {
                Destination::One(to) => nodes.get(to..=to).unwrap_or_default(),
                Destination::Everyone => &nodes[..],
            };
            mail.sort(&mut sent, nodes.len(), receivers_of, *answers);
            Some(mail)
        }
    }

    /// Where nodes hear their mail and tick in one go, on one thread or on several, nothing differs from jumps that
    /// are taken one after another.
    #[test]
    fn mail_is_heard_as_messages_are_that_are_delivered_one_after_another() {
        type Outcome = (Vec<Adder>, Vec<TraceEntry<NodeJump>>, Vec<(NodeId, u64)>, Vec<Traffic>);

        fn outcome(nodes: &[Adder], medium: impl Medium<u64, ()>, threads: usize) -> Outcome {
            let mut ensemble = Ensemble::new(nodes.to_vec(), medium);
            ensemble.chunks.threads = threads;
            let mut trace = Trace::new();
            Executor::new(1.0, 100).unwrap().run(&mut ensemble, &mut trace).unwrap();
            let reports = ensemble.drain_reports().collect();
            let traffic = (0..nodes.len()).map(|node| ensemble.traffic(node)).collect();
            (ensemble.nodes().to_vec(), trace.entries().to_vec(), reports, traffic)
        }

        for (is_lonely, answers, fewest_jumps) in
            [(false, false, 8), (true, false, 4), (false, true, 9)]
        {
            let sorted =
                || Sorted { mesh: FullMesh::new(), nodes: Vec::new(), mail: Mail::new(), answers };
            let adder = |id: u64| Adder { sum: id, rounds: 0, is_lonely, answers };
            let nodes: Vec<Adder> = (0..60).map(adder).collect();
            let in_turn = outcome(&nodes, FullMesh::new(), 1);
            assert!(in_turn.1.len() >= fewest_jumps);
            assert_eq!(outcome(&nodes, sorted(), 1), in_turn);
            assert_eq!(outcome(&nodes, sorted(), 3), in_turn);
        }
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
