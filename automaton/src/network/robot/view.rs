//! A robot as observers see it.

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{
    ExchangeStage, IdSet, NodeId, NoticeId, Phase, Role, Stage, Subgroup,
};

use super::links::TreeLink;
use super::routing::RouteLink;
use super::{Facts, Robot};
use crate::located::Place as _;
use crate::network::beacon::{Beacon, Notice};
use crate::network::duty::Duty;
use crate::network::mission::Mission;
use crate::node::Observed;

/// A read-only view of a robot, for observers; no node can ask for one.
#[derive(Clone, Copy, Debug)]
pub struct RobotView<'a>(&'a Robot);

impl Observed for Robot {
    type View<'a> = RobotView<'a>;

    fn view(&self) -> RobotView<'_> {
        RobotView(self)
    }
}

impl<'a> RobotView<'a> {
    /// Its number.
    pub const fn id(self) -> NodeId {
        self.0.id
    }

    /// x_i.
    pub const fn position(self) -> Point {
        self.0.body.position()
    }

    /// The role that its duty gives it.
    pub fn role(self) -> Role {
        self.0.role()
    }

    /// Its location in the automaton of duties, with the data.
    pub fn duty(self) -> &'a Duty {
        &self.0.duty
    }

    /// The duty that it takes over once the mover that offered it has taken its own.
    pub fn taking(self) -> Option<&'a Duty> {
        self.0.offers().taking()
    }

    /// Its location in the automaton of the exchange of duties.
    pub fn exchange(self) -> ExchangeStage {
        self.0.exchanges.current().location()
    }

    /// Its location in the automaton of the mission, with the data.
    pub fn mission(self) -> &'a Mission {
        &self.0.mission
    }

    /// The phase of the mission as the robot knows it.
    pub fn phase(self) -> Phase {
        self.0.phase()
    }

    /// Its stage in the control period.
    pub fn stage(self) -> Stage {
        self.0.stage()
    }

    /// What its guards saw when they were evaluated last.
    pub const fn facts(self) -> &'a Facts {
        self.0.changes.facts()
    }

    /// The newest notice on the mission that it knows.
    pub fn notice(self) -> &'a Notice {
        self.0.notice()
    }

    /// The identity of that notice.
    pub fn notice_id(self) -> NoticeId {
        self.0.notice_id()
    }

    /// How often a task had been announced again before the announcement that it goes by.
    pub const fn epoch(self) -> u32 {
        self.0.mission.epoch()
    }

    /// The task announced last, as far as it knows.
    pub fn current_task(self) -> Option<usize> {
        self.0.current_task()
    }

    /// The tasks that are over, as far as it knows.
    pub const fn closed(self) -> &'a Arc<IdSet> {
        self.0.mission.notices().closed()
    }

    /// Whether it is the elected leader, released or not.
    pub fn leads(self) -> bool {
        self.0.leads()
    }

    /// How many subgroups of the path Σ have arrived, as far as it knows.
    pub fn subgroups_done(self) -> usize {
        self.0.subgroups_done()
    }

    /// The subgroup that is the active team, while one is.
    pub fn active_subgroup(self) -> Option<Subgroup> {
        self.0.active_subgroup()
    }

    /// Its parent in the tree: the node that its duty names or, while that is not heard, the last
    /// one.
    pub fn tree_parent(self) -> Option<NodeId> {
        self.0.tree_parent()
    }

    /// The links of the tree at this robot: to its parent first, then to its children.
    pub fn tree_links(self) -> Vec<TreeLink> {
        self.0.tree_links()
    }

    /// The nodes that it hears, ascending, each with the number of rounds that it has been silent.
    pub fn audible(self) -> impl Iterator<Item = (NodeId, u8)> + 'a {
        self.0.audible()
    }

    /// The beacon last heard of each of its neighbours, ascending by sender.
    pub fn beacons(self) -> impl Iterator<Item = &'a Arc<Beacon>> {
        self.0.held_beacons()
    }

    /// The links that it sends over, T_ij > 0.
    pub fn routes(self) -> impl Iterator<Item = &'a RouteLink> {
        self.0.routing.routes()
    }

    /// λ_i.
    pub fn multiplier(self) -> f64 {
        self.0.routing.multiplier()
    }

    /// c_i at the last sample.
    pub const fn residual(self) -> f64 {
        self.0.routing.residual()
    }

    /// Where it goes, if it goes anywhere.
    pub fn goal(self) -> Option<Point> {
        self.0.goal()
    }

    /// Whether it may move in this control period.
    pub fn is_active(self) -> bool {
        self.0.is_active()
    }

    /// Whether it may move in this control period and takes part by a roll that is valid.
    pub fn may_move(self) -> bool {
        self.is_active() && self.is_called()
    }

    /// Whether it takes part by a roll that is valid: otherwise it does not move.
    pub fn is_called(self) -> bool {
        self.0.is_called()
    }

    /// Whether its place in the tree may change without a move: it looks for another parent for its fixed post, or
    /// no branch depends on that any more.
    pub fn is_settling(self) -> bool {
        self.0.is_settling()
    }

    /// Whether it stands still unless it is asked for; robots that settle on their post count as
    /// parked.
    pub fn is_parked(self) -> bool {
        self.0.is_parked()
    }

    /// Whether it is of the primary team, and stands still like all others from the leader back to it.
    pub fn stands_in_team(self) -> bool {
        self.0.mission.team().report().is_some_and(|report| report.stands_still())
    }
}

#[cfg(feature = "abstraction")]
impl<'a> RobotView<'a> {
    pub(super) const fn robot(self) -> &'a Robot {
        self.0
    }
}
