//! What a robot leaves out: it processes messages, tells its state and evaluates its guards only where
//! something has changed.
//!
//! That is right if doing it would change nothing. Builds with debug assertions try it out wherever
//! something is left out, on a copy of the robot.

use super::Robot;
use crate::located::Place as _;

impl Robot {
    /// What would change if it processed what it has received.
    pub(super) fn overlooked(&self) -> Option<&'static str> {
        let mut again = self.clone();
        match again.process_messages() {
            Ok(()) => again.difference_to(self),
            Err(_) => Some("its automata"),
        }
    }

    /// In what two robots differ, of what decides on what they say and do.
    fn difference_to(&self, other: &Robot) -> Option<&'static str> {
        let (one, two) = (self.public_state(), other.public_state());
        let same = [
            (one.bulletin == two.bulletin, "its newest notice"),
            (one.election == two.election && self.bid == other.bid, "its election"),
            (one.agreement == two.agreement, "its agreement"),
            (one.route == two.route, "its way to the caller"),
            (one.team == two.team, "its report on the team"),
            (self.followed_post == other.followed_post, "the post that is followed"),
            (*self.mission == *other.mission, "the phase of its mission"),
            (one.lineage == two.lineage, "its lineage"),
            (one.parent == two.parent, "its parent"),
            (self.desired_parent == other.desired_parent, "the parent that it looks for"),
            (self.reattaches_to == other.reattaches_to, "the parent that it finds better"),
            (self.awaits_confirmation == other.awaits_confirmation, "whether it is confirmed"),
            (self.confirmation == other.confirmation, "its confirmation"),
            (one.can_detach == two.can_detach, "whether it can detach"),
            (one.below == two.below, "the robots below it"),
            (one.strays == two.strays, "the strays that it hears"),
            (one.serves == two.serves, "the tasks serviced below it"),
            (one.wrecks == two.wrecks, "the wrecks that it knows"),
            (*self.exchange == *other.exchange, "its exchange of duties"),
            (self.answered == other.answered, "the offers that it has answered"),
            (self.partner == other.partner, "its partner"),
            (one == two, "its beacon"),
        ];
        same.into_iter().find(|(is_same, _)| !is_same).map(|(_, part)| part)
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
