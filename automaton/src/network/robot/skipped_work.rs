//! Work that a robot skips where nothing has changed: processing messages, telling its state, evaluating guards,
//! looking at its neighbours, finding and going through its links, choosing shares, and all of these where a control
//! period is like the one before.
//!
//! Skipping is right if the work would change nothing.
//! [`without_caching`](super::super::scenario::ValidScenario::without_caching) switches it off, and missions are the same
//! to the byte. Builds with debug assertions verify that for guards, facts, beacons, links and shares, in one control
//! period in [`PERIODS_PER_CHECK`](super::context::PERIODS_PER_CHECK); with the feature `abstraction` also for messages,
//! which are processed again on a copy. Explorers verify it in every state of a robot, but for shares and for
//! periods that are like the one before: to them every period is new.

use super::Robot;
use super::context::context;
use crate::located::Place as _;
use crate::network::duty::Duty;

impl Robot {
    /// Whether it keeps what it has derived.
    pub(super) fn caches(&self) -> bool {
        context!(self).caches()
    }

    /// Whether work that is left out would change nothing, where that is verified.
    pub(super) fn may_skip(&self, changes_nothing: impl FnOnce(&Self) -> bool) -> bool {
        context!(self).may_skip(|| changes_nothing(self))
    }

    /// Whether a control period that begins or ends is like any other to the robot, so that what it has worked out
    /// stands. It stays at a post that is neither of the team nor on Σ, and wants to go nowhere; it has heard each
    /// neighbour in the last round in which all send, and takes none to be absent: nothing depends on how long
    /// something has lasted. That it has heard each neighbour in the period is relied upon by those that it
    /// [tells](crate::network::beacon::Beacon::sightings) where they are.
    pub(super) fn is_undisturbed(&self) -> bool {
        use Duty::{Junction, Leaf, Relay, Standby};
        self.caches()
            && matches!(*self.duty, Standby(_) | Relay(_) | Junction(_) | Leaf(_))
            && self.changes.is_quiet()
            && !self.duty.is_late()
            && !self.tree.awaits_confirmation()
            && self.negotiation.navigation().waypoint().is_none()
            && !self.body.is_moving()
            && self.tree.orphaned_periods() == 0
            && self.membership.is_complete()
            && self.neighbours.have_all_been_heard_lately(self.schedule.period())
    }

    /// Whether its facts are as it has measured them, and no guard holds.
    pub(super) fn facts_stand(&self) -> bool {
        self.facts_now() == *self.changes.facts() && self.is_at_rest()
    }

    /// Whether no transition of the mission or of its duty can be taken.
    pub(super) fn is_at_rest(&self) -> bool {
        let automata = &self.site.automata;
        let step = automata.mission.enabled(self.phase(), self);
        let jump = automata.duty.enabled(self.duty.location(), self);
        matches!((step, jump), (Ok(None), Ok(None)))
    }
}

#[cfg(feature = "abstraction")]
macro_rules! first_difference {
    ($($part:literal: $now:expr, $before:expr;)+) => {{
        $(if $now != $before {
            return Some(format!("its {} is {:?} and was {:?}", $part, $now, $before));
        })+
        None
    }};
}

#[cfg(feature = "abstraction")]
impl Robot {
    /// What would change if it processed what it has received.
    pub(super) fn overlooked(&self) -> Option<String> {
        let mut again = self.clone();
        match again.process_messages() {
            Ok(()) => again.difference_to(self),
            Err(error) => Some(error.to_string()),
        }
    }

    /// In what this robot differs from how it was before, of what decides on what it says and does.
    fn difference_to(&self, before: &Robot) -> Option<String> {
        let (now, then) = (self.public_state(), before.public_state());
        first_difference! {
            "newest notice": now.bulletin, then.bulletin;
            "election": now.election, then.election;
            "ballot": self.ballot, before.ballot;
            "agreement": now.agreement, then.agreement;
            "way to the caller": now.route, then.route;
            "report on the team": now.team, then.team;
            "links of the tree": now.stretched, then.stretched;
            "longest wait": now.longest_wait, then.longest_wait;
            "team": self.mission.team(), before.mission.team();
            "mission": self.mission.current(), before.mission.current();
            "lineage": now.lineage, then.lineage;
            "parent": now.parent, then.parent;
            "parent that it looks for": self.tree.search(), before.tree.search();
            "robots below": now.below, then.below;
            "strays": now.strays, then.strays;
            "robots that have forgotten": now.forgetful, then.forgetful;
            "tasks serviced below": now.serves, then.serves;
            "tasks that are over": now.closed, then.closed;
            "wrecks": now.wrecks, then.wrecks;
            "branches": now.branches, then.branches;
            "exchanges of duties": self.exchanges, before.exchanges;
            "beacon": now, then;
        }
    }
}
