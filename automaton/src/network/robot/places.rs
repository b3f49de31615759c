//! Which nodes are where the robot has received them last.

use pleach_discrete::network::NodeId;

use super::context::Context;
use super::negotiation::Negotiation;
use super::neighbours::Neighbours;

/// What a robot knows of the places of others in one step.
#[derive(Clone, Copy)]
pub(super) struct Places<'a> {
    pub context: Context<'a>,
    pub neighbours: &'a Neighbours,
    pub negotiation: &'a Negotiation,
    /// Whether all neighbours have been received in this control period, and no node has begun the next one.
    pub has_heard_all: bool,
}

impl Places<'_> {
    /// Whether a node on which the robot relies is where it was received last: it is an access point, it has been
    /// received in this control period, or it could not move since, because the robot sends to it and has not
    /// consented.
    pub(super) fn are_known_of(&self, node: NodeId, sends_to: bool) -> bool {
        let Context { id, period, .. } = self.context;
        if !self.context.is_robot(node) {
            return true;
        }
        let Ok(at) = self.neighbours.place_of(node) else { return false };
        let heard_in = self.neighbours[at].heard_in;
        if self.has_heard_all {
            debug_assert_eq!(heard_in, period, "robot {id} has not received all");
            return true;
        }
        heard_in == period || sends_to && !self.negotiation.has_consented_since(node, heard_in)
    }

    /// The last control period in which this node has been received; 0 if it has not.
    pub(super) fn last_heard(&self, node: NodeId) -> u32 {
        self.neighbours.place_of(node).map_or(0, |at| self.neighbours[at].heard_in)
    }
}

/// The [`Places`] of a robot, borrowed field by field.
macro_rules! places {
    ($robot:expr) => {
        $crate::network::robot::places::Places {
            context: $crate::network::robot::context!($robot),
            neighbours: &$robot.neighbours,
            negotiation: &$robot.negotiation,
            has_heard_all: $robot.neighbours.have_all_been_heard_in($robot.schedule.period())
                && !$robot.schedule.is_behind(),
        }
    };
}

pub(super) use places;
