//! What the primary team knows of itself, as its reports say.

use pleach_discrete::network::PostId;

use crate::network::beacon::TeamReport;

/// What the primary team knows of itself, as far as it is known to a robot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Team {
    /// From the leader back to the robot, where the team is the active team and the robot one of it.
    report: Option<TeamReport>,
    /// The post of the robot, if another one of the primary team follows it.
    followed_post: Option<PostId>,
}

impl Team {
    /// What the team knows of itself, from the leader back to the robot.
    pub(super) const fn report(&self) -> Option<TeamReport> {
        self.report
    }

    /// The post of the robot, if another one follows it.
    pub(super) const fn followed_post(&self) -> Option<PostId> {
        self.followed_post
    }

    /// This is known now, if the robot is of the active team.
    pub(super) const fn review(&mut self, report: Option<TeamReport>) {
        self.report = report;
    }

    /// Another robot follows the robot that holds this post, or none does.
    pub(super) const fn follow(&mut self, post: Option<PostId>) {
        self.followed_post = post;
    }
}
