//! What a robot knows of the mission: its phase, and the notices and the announcement that it follows.

use std::ops::Deref;

use pleach_continuous::Point;
use pleach_discrete::network::NoticeId;

use super::primary_team::Team;
use crate::located::Current;
use crate::network::beacon::Announced;
use crate::network::mission::{Idle, Mission};
use crate::network::notices::Notices;

/// The mission as one robot knows it.
#[derive(Clone, Debug)]
pub(super) struct Knowledge {
    phase: Current<Mission>,
    notices: Notices,
    /// The epoch of the notices that the robot follows.
    epoch: u32,
    /// The announcement by which the robot has reached its task.
    accomplished: Option<NoticeId>,
    /// Where the leader goes: the point of 𝒲_f nearest to the task announced of those to which a way leads from where
    /// the robot has received it.
    target: Option<Point>,
    /// The access point in whose tree the leader of the team was elected, if there are several.
    led_from: Option<usize>,
    /// What the primary team knows of itself.
    team: Team,
}

impl Deref for Knowledge {
    type Target = Mission;

    fn deref(&self) -> &Mission {
        &self.phase
    }
}

impl Default for Knowledge {
    /// That of a robot which has received nothing.
    fn default() -> Self {
        Knowledge {
            phase: Current::new(Mission::Idle(Idle)),
            notices: Notices::default(),
            epoch: 0,
            accomplished: None,
            target: None,
            led_from: None,
            team: Team::default(),
        }
    }
}

impl Knowledge {
    pub(super) const fn current(&self) -> &Current<Mission> {
        &self.phase
    }

    pub(super) const fn current_mut(&mut self) -> &mut Current<Mission> {
        &mut self.phase
    }

    /// What the robot has received of the mission.
    pub(super) const fn notices(&self) -> &Notices {
        &self.notices
    }

    /// The robot receives or issues a notice.
    pub(super) const fn notices_mut(&mut self) -> &mut Notices {
        &mut self.notices
    }

    /// The epoch of the notices that the robot follows.
    pub(super) const fn epoch(&self) -> u32 {
        self.epoch
    }

    /// The robot follows the announcement that the newest notice results from.
    pub(super) fn keep_up(&mut self) {
        self.epoch = self.notices.bulletin().id().epoch();
    }

    /// The robot follows this announcement from now on; its leader would go to `target`.
    pub(super) fn learn(&mut self, announced: Announced, target: Point) {
        self.epoch = announced.0.epoch();
        self.target = Some(target);
        self.notices.learn(announced);
    }

    /// Where the leader goes.
    pub(super) const fn target(&self) -> Option<Point> {
        self.target
    }

    /// The robot has reached the task of the announcement that it follows.
    pub(super) fn accomplish(&mut self) {
        self.accomplished = self.notices.announcement_id();
    }

    /// The announcement by which the robot has reached its task.
    pub(super) const fn accomplished(&self) -> Option<NoticeId> {
        self.accomplished
    }

    /// The access point in whose tree the leader of the team was elected, if there are several.
    pub(super) const fn led_from(&self) -> Option<usize> {
        self.led_from
    }

    /// The leader is of the tree of this access point when it is elected.
    pub(super) const fn is_led_from(&mut self, root: Option<usize>) {
        self.led_from = root;
    }

    /// What the primary team knows of itself.
    pub(super) const fn team(&self) -> &Team {
        &self.team
    }

    /// The primary team is reviewed.
    pub(super) const fn team_mut(&mut self) -> &mut Team {
        &mut self.team
    }
}

#[cfg(test)]
impl Knowledge {
    /// The mission is in this phase.
    pub(super) fn is(&mut self, mission: Mission) {
        *self = Knowledge { phase: Current::new(mission), ..self.clone() };
    }

    /// The leader goes there.
    pub(super) const fn leads_to(&mut self, target: Point) {
        self.target = Some(target);
    }

    /// The robot has reached its task by this announcement.
    pub(super) const fn has_accomplished(&mut self, announcement: Option<NoticeId>) {
        self.accomplished = announcement;
    }

    /// The robot follows notices of this epoch.
    pub(super) const fn is_of_epoch(&mut self, epoch: u32) {
        self.epoch = epoch;
    }
}
