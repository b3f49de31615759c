//! The moves of a control period: the rounds of messages in which they are certified.

use std::time::Instant;

use pleach_discrete::network::NodeId;

use super::super::medium::Medium;
use super::super::robot::{Objection, Proposal};
use super::Network;

/// Rounds in which proposals are checked and halved; whoever still meets an objection in the last
/// one gives its move up.
const NEGOTIATION_ROUNDS: usize = 8;

impl<M: Medium> Network<M> {
    /// Proposals, objections, halving; what is left is carried out. A round without an objection
    /// is followed by rounds that change nothing, so that they need not be played.
    pub(super) fn negotiate(&mut self) {
        let begin = Instant::now();
        for robot in &mut self.robots {
            robot.propose();
        }
        self.times.motion += begin.elapsed();
        let begin = Instant::now();
        for round in 0..=NEGOTIATION_ROUNDS {
            if !self.negotiation_round(round == NEGOTIATION_ROUNDS) {
                break;
            }
        }
        for robot in &mut self.robots {
            robot.set_off();
        }
        self.times.acceptance += begin.elapsed();
    }

    /// Whether anybody objected.
    fn negotiation_round(&mut self, last: bool) -> bool {
        let proposals: Vec<(NodeId, Proposal)> = self
            .robots
            .iter()
            .enumerate()
            .filter_map(|(id, robot)| Some((id, *robot.proposal()?)))
            .collect();
        for robot in &mut self.robots {
            robot.clear_proposals();
        }
        for (mover, proposal) in &proposals {
            for receiver in self.audience_of(*mover) {
                self.robots[receiver].hear_proposal(*mover, proposal);
            }
        }
        let objections: Vec<(NodeId, Objection)> = self
            .robots
            .iter()
            .enumerate()
            .filter_map(|(id, robot)| Some((id, robot.objection()?)))
            .collect();
        for (objector, objection) in &objections {
            self.robots[*objector].yield_to(objection, last);
            for receiver in self.audience_of(*objector) {
                self.robots[receiver].yield_to(objection, last);
            }
        }
        !objections.is_empty()
    }
}
