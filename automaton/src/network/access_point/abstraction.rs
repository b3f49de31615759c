//! The access point, driven by an explorer.

use std::sync::Arc;

use super::super::beacon::{Beacon, Notice};
use super::{AccessPoint, PATIENCE_WITH_ELECTIONS, ROUNDS_UNTIL_ROSTER_SETTLES};
use crate::automaton::TransitionError;

impl AccessPoint {
    /// The beacon that the access point would send now, without what matters only when time passes.
    pub fn beacon(&self) -> Beacon {
        Beacon { strays: Arc::default(), serves: Arc::default(), ..self.public_state() }
    }

    /// In place of a round of messages: processes what it has received, without counting a round.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    pub fn deliberate_now(&mut self) -> Result<(), TransitionError> {
        self.deliberate()?;
        self.heard.clear();
        Ok(())
    }

    /// In the next round all nodes send again: beacons that are processed are not needed any more.
    pub fn forget_round(&mut self) {
        if self.round() > 1 {
            self.heard.clear();
        }
    }

    /// In place of serving the user at the end of each round.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    pub fn attend_to_user(&mut self) -> Result<(), TransitionError> {
        self.serve()
    }

    /// Everything, apart from what it receives, that decides what the access point sends from now on.
    ///
    /// Left out is what the explorer stands for and what follows from the rest; how long a wait has
    /// been over does not matter. A field that is neither told nor left out does not compile.
    pub fn account(&self) -> String {
        let AccessPoint {
            // Told.
            number,
            bulletin,
            announced,
            election,
            election_rounds,
            agreement,
            route,
            crossing,
            stretched,
            attached,
            roster,
            settled_rounds,
            service,
            // Constant: the request comes before the first state, and does not change.
            site: _,
            position: _,
            requested: _,
            // Between two stimuli an access point has nothing left to do.
            heard: _,
            sightings: _,
            wrecks: _,
            silent: _,
            newest: _,
            rounds: _,
            acts: _,
            is_new: _,
            last_beacon: _,
            log: _,
            // The explorer stands for time; without it no robot is missed, and no task.
            strays: _,
            serves: _,
            tasks_serviced: _,
            attendees: _,
            roll: _,
            clock: _,
            period: _,
        } = self;
        let settled = match self.notice() {
            Notice::Quiet => (*settled_rounds).min(ROUNDS_UNTIL_ROSTER_SETTLES),
            _ => 0,
        };
        let patience = PATIENCE_WITH_ELECTIONS * self.longest_wait() + 1;
        let rounds = if self.is_electing() { (*election_rounds).min(patience) } else { 0 };
        format!(
            "{:?}",
            (
                (number, bulletin, announced, &**service, election, rounds),
                (agreement, route, crossing, stretched, (attached, roster), settled),
            )
        )
    }
}
