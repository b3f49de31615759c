//! The access point as an explorer drives it.

use super::super::beacon::{Beacon, Notice};
use super::{AccessPoint, PATIENCE_WITH_ELECTIONS, ROUNDS_UNTIL_ROSTER_SETTLES};
use crate::automaton::TransitionError;

impl AccessPoint {
    /// What the access point would tell its neighbours now.
    pub fn beacon(&self) -> Beacon {
        self.public_state()
    }

    /// In place of a round of messages: thinks over what it has heard, without counting a round.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    pub fn think_over(&mut self) -> Result<(), TransitionError> {
        self.think()
    }

    /// In place of what it does for the user at the end of each round.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    pub fn attend_to_user(&mut self) -> Result<(), TransitionError> {
        self.serve()
    }

    /// Everything, apart from what it hears, that decides what the access point says from now on.
    /// Waits that are over are over, however long.
    pub fn account(&self) -> String {
        let settled = match self.bulletin.notice() {
            Notice::Quiet => self.settled_rounds.min(ROUNDS_UNTIL_ROSTER_SETTLES),
            _ => 0,
        };
        let patience = PATIENCE_WITH_ELECTIONS * self.longest_wait() + 1;
        let rounds = if self.is_electing() { self.election_rounds.min(patience) } else { 0 };
        format!(
            "{:?}",
            (
                (self.number, &self.bulletin, &*self.service, &self.election, rounds),
                (&self.agreement, &self.route, &self.crossing, &self.roster, settled),
            )
        )
    }
}
