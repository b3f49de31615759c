//! How messages go from node to node, and what may become of them on the way.

use pleach_automaton::network::RobotView;
use pleach_automaton::network::robot::RobotError;
use pleach_discrete::network::NodeId;

use super::node::{BeaconId, MessageId, Stimulus};
use super::protocol::{Action, Protocol, State};

/// How messages go from node to node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Medium {
    /// In rounds, as the network plays them: all nodes send, then all receive.
    Rounds {
        /// What may go wrong, one message in a round.
        faults: Faults,
        /// How many rounds a control period has: a robot may move, by one place at most, after
        /// the last of them. Without periods it may move between any two rounds, and any number
        /// of times.
        period: Option<u32>,
    },
    /// In rounds, too, and control periods count: nodes that are silent are missed, and given up at last.
    Periods {
        /// What may go wrong.
        faults: Faults,
        /// How many rounds a control period has. After the last of them each robot moves, by one place
        /// at most, or stays on its way, and the next control period begins.
        rounds: u32,
    },
    /// One node at a time, in any order: it receives what all nodes in range send now. Others may
    /// send and deliberate any number of times meanwhile.
    NodesInAnyOrder,
    /// One message at a time, in any order. What is on its way from one node to another is
    /// overtaken by what the sender sends next, and stays with the receiver until then: messages
    /// are late for any time, lost if a newer one comes, and heard again and again.
    MessagesInAnyOrder,
}

/// How many messages and robots may fail in a mission.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Faults {
    /// Messages that do not arrive.
    pub losses: u32,
    /// Messages that are late: what the receiver heard last of the sender reaches it once more
    /// instead.
    pub delays: u32,
    /// Messages of which a copy arrives too, in place of what the sender sends in one of the next
    /// [`LONGEST_ECHO`] rounds.
    pub duplicates: u32,
    /// Robots that stop, where control periods count: at any moment, each where it stands.
    pub stops: u32,
    /// How many of these begin again when another control period begins, having forgotten everything but
    /// their number and where they stand.
    pub restarts: u32,
}

impl Faults {
    /// Nothing goes wrong.
    pub const NONE: Faults = Faults { losses: 0, delays: 0, duplicates: 0, stops: 0, restarts: 0 };

    /// Whether nothing goes wrong any more within a control period.
    const fn are_over(self) -> bool {
        self.losses + self.delays + self.duplicates + self.stops == 0
    }
}

/// A copy of a message arrives at most this many rounds after the message.
pub const LONGEST_ECHO: u8 = 3;

/// A copy that is on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Copied {
    from: NodeId,
    to: NodeId,
    message: MessageId,
    /// Rounds in which it may still arrive.
    rounds_left: u8,
}

impl Medium {
    /// What may go wrong.
    pub const fn faults(self) -> Faults {
        match self {
            Medium::Rounds { faults, .. } | Medium::Periods { faults, .. } => faults,
            Medium::NodesInAnyOrder | Medium::MessagesInAnyOrder => Faults::NONE,
        }
    }

    pub(super) const fn period(self) -> Option<u32> {
        match self {
            Medium::Rounds { period, .. } => period,
            Medium::Periods { rounds, .. } => Some(rounds),
            Medium::NodesInAnyOrder | Medium::MessagesInAnyOrder => None,
        }
    }

    /// Whether control periods count.
    pub const fn periods_count(self) -> bool {
        matches!(self, Medium::Periods { .. })
    }
}

impl Protocol {
    /// Whether the last round of the control period has been played.
    pub(super) fn period_is_over(&self, state: &State) -> bool {
        self.configuration().medium.period() == Some(state.round)
    }

    /// What may be heard, if anything comes of it.
    pub(super) fn messages(&mut self, state: &State) -> Result<Vec<(Action, State)>, RobotError> {
        let nodes = state.locals.len();
        let mut found = Vec::new();
        match self.configuration().medium {
            Medium::Periods { .. } if self.period_is_over(state) => {}
            Medium::Rounds { .. } | Medium::Periods { .. } => {
                let heard = self.all_heard(state);
                found.push((Action::Round, self.round(state, &heard)?));
            }
            Medium::NodesInAnyOrder => {
                for node in 0..nodes {
                    let heard = self.all_heard_by(state, node);
                    let next = self.one(state, node, Stimulus::Hear(heard))?;
                    found.push((Action::Listen(node), next));
                }
            }
            Medium::MessagesInAnyOrder => {
                for to in 0..nodes {
                    for from in (0..nodes).filter(|&from| from != to) {
                        if let Some(heard) = self.heard_from(state, from, to) {
                            let next = self.one(state, to, Stimulus::Hear(heard))?;
                            found.push((Action::Hear { from, to }, next));
                        }
                    }
                    let heard = self.still_heard_by(state, to);
                    let next = self.one(state, to, Stimulus::Hear(heard))?;
                    found.push((Action::Deliberate(to), next));
                }
            }
        }
        found.retain(|(_, next)| next != state);
        Ok(found)
    }

    /// What a node hears again that hears nothing new: nothing of a node that has left unheard.
    pub(super) fn still_heard_by(&mut self, state: &State, receiver: NodeId) -> Vec<MessageId> {
        let local = self.nodes().local(state.locals[receiver]);
        let is_silent = |sender: NodeId| {
            let mut known = local.robot().into_iter().flat_map(RobotView::audible);
            known.any(|(node, silent_rounds)| node == sender && silent_rounds > 0)
        };
        let stays = |&beacon: &BeaconId| {
            let sender = self.nodes().beacon(beacon).sender;
            self.is_in_range(state, sender, receiver) || !is_silent(sender)
        };
        let heard: Vec<_> = local.heard.iter().copied().filter(stays).collect();
        heard.into_iter().map(|beacon| self.nodes_mut().message_with(beacon)).collect()
    }

    /// Rounds in which one message is lost, late or copied, or a copy arrives.
    ///
    /// # Errors
    /// When a node cannot go on.
    pub fn faulty_rounds(&mut self, state: &State) -> Result<Vec<(Action, State)>, RobotError> {
        let mut found = Vec::new();
        let waits = self.configuration().medium.periods_count() && self.period_is_over(state);
        if state.faults.are_over() && state.copies.is_empty() || waits {
            return Ok(found);
        }
        let heard = self.all_heard(state);
        for to in 0..heard.len() {
            for at in 0..heard[to].len() {
                let said = heard[to][at];
                let from = self.nodes().said(said).sender;
                if state.faults.losses > 0 {
                    let mut without = heard.clone();
                    without[to].remove(at);
                    let mut next = self.round(state, &without)?;
                    next.faults.losses -= 1;
                    found.push((Action::Lose { from, to }, next));
                }
                let known = self.last_heard(state, from, to).filter(|&known| known != said);
                if let Some(known) = known.filter(|_| state.faults.delays > 0) {
                    let mut late = heard.clone();
                    late[to][at] = known;
                    let mut next = self.round(state, &late)?;
                    next.faults.delays -= 1;
                    found.push((Action::Delay { from, to }, next));
                }
                if state.faults.duplicates > 0 {
                    let mut next = self.round(state, &heard)?;
                    next.faults.duplicates -= 1;
                    let copy = Copied { from, to, message: said, rounds_left: LONGEST_ECHO };
                    next.copies.push(copy);
                    next.copies.sort_unstable();
                    found.push((Action::Copy { from, to }, next));
                }
                let arrives = |copy: &Copied| (copy.from, copy.to) == (from, to);
                for copy in state.copies.iter().copied().filter(arrives) {
                    if copy.message != said {
                        let mut echoed = heard.clone();
                        echoed[to][at] = copy.message;
                        let mut next = self.round(state, &echoed)?;
                        next.copies.retain(|other| (other.from, other.to) != (from, to));
                        found.push((Action::Echo { from, to }, next));
                    }
                }
            }
        }
        Ok(found)
    }

    /// What `to` heard last of `from`.
    fn last_heard(&mut self, state: &State, from: NodeId, to: NodeId) -> Option<MessageId> {
        let mut known = self.nodes().local(state.locals[to]).heard.iter();
        let beacon = known.find(|&&id| self.nodes().beacon(id).sender == from).copied()?;
        Some(self.nodes_mut().message_with(beacon))
    }

    /// A round in which every node hears this.
    fn round(&mut self, state: &State, heard: &[Vec<MessageId>]) -> Result<State, RobotError> {
        let mut next = state.clone();
        next.locals = self.each(state, |node| Stimulus::Round(heard[node].clone()))?;
        next.copies.retain_mut(|copy| {
            copy.rounds_left -= 1;
            copy.rounds_left > 0
        });
        if let Some(rounds) = self.configuration().medium.period() {
            let is_quiet = next.locals == state.locals;
            let nothing_fails = state.faults.are_over() && state.copies.is_empty();
            if self.configuration().medium.periods_count() {
                next.round = if is_quiet && nothing_fails { rounds } else { state.round + 1 };
                return Ok(next);
            }
            if is_quiet && (nothing_fails || state.round == rounds) {
                // Nothing happens until robots move again.
                next.round = rounds;
            } else {
                next.round = state.round % rounds + 1;
            }
            if state.round == rounds {
                next.moved = 0;
            }
        }
        Ok(next)
    }
}
