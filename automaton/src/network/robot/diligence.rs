//! What a robot leaves out: it processes messages, tells its state and evaluates its guards only where
//! something has changed.
//!
//! That is right if doing it would change nothing. Builds with debug assertions try it out wherever
//! something is left out, on a copy of the robot.

use super::Robot;
use crate::located::Place as _;

impl Robot {
    /// Whether processing what it has received would change nothing.
    pub(super) fn has_nothing_to_process(&self) -> bool {
        let mut again = self.clone();
        again.process_messages().is_ok() && again.is_as_informed_as(self)
    }

    /// Whether both know the same, as far as it decides what they do.
    fn is_as_informed_as(&self, other: &Robot) -> bool {
        let inward = |robot: &Robot| {
            (
                robot.desired_parent,
                robot.reattaches_to,
                robot.awaits_confirmation,
                robot.followed_post,
                robot.partner,
                robot.last_partner,
                robot.is_displaced,
                robot.bid,
            )
        };
        self.public_state() == other.public_state()
            && inward(self) == inward(other)
            && *self.mission == *other.mission
            && *self.exchange == *other.exchange
            && self.answered == other.answered
            && self.confirmation == other.confirmation
    }

    /// Whether its facts are as it has measured them, and no guard holds.
    pub(super) fn facts_stand(&self) -> bool {
        self.facts_now() == self.facts && self.is_at_rest()
    }

    /// Whether no transition of the mission or of its duty can be taken.
    pub(super) fn is_at_rest(&self) -> bool {
        let automata = &self.site.automata;
        let step = automata.mission.enabled(self.phase(), self);
        let jump = automata.duty.enabled(self.duty.location(), self);
        matches!((step, jump), (Ok(None), Ok(None)))
    }
}
