//! The targets ψ_i as laws of the duty (Algorithm 2): where a robot goes at a sample.

use pleach_continuous::Point;
use pleach_discrete::network::{Activity, Anchor};

use crate::automaton::TransitionError;
use crate::law::Laws;
use crate::located::Place as _;
use crate::network::guards::target as guards;

use super::Robot;
use crate::network::duty::{Duty, Hop};

/// Where robots go, by what they do.
pub type Targets = Laws<Activity, Robot, Point>;

/// The target laws: Algorithm 2, and for robots that hold a post what brings them back to it.
pub(in crate::network) fn targets() -> Targets {
    use Activity::{
        AwaitingRelease, Bound, Following, Junction, Leading, Leaf, Relay, Shifting, Standby,
        Waiting,
    };
    let laws = Laws::of("ψ")
        .case(Shifting, guards::changes_over(), "next access point on Σ", Robot::next_of_crossing)
        .case(Shifting, guards::shifts(), "place ahead on Σ", Robot::place_ahead)
        .case(Following, guards::gives_way(), "place aside for the team", Robot::place_aside)
        .case(Following, guards::joins_over(), "next access point on Σ", Robot::next_of_crossing)
        .case(Following, guards::follows(), "robot ahead", Robot::team_goal)
        .case(Leading, guards::leads(), "task", Robot::team_goal);
    let posted = [Standby, Relay, Junction, Leaf, Bound, Waiting, AwaitingRelease];
    posted.into_iter().fold(laws, |laws, activity| {
        laws.case(activity, guards::gives_way(), "place aside for a mover", Robot::place_aside)
            .case(activity, guards::returns(), "own post", Robot::own_reference)
    })
}

impl Robot {
    /// ψ_i: where the robot goes now, if it goes anywhere; nowhere if a guard has no value.
    pub(super) fn goal(&self) -> Option<Point> {
        self.target().ok().flatten()
    }

    /// As [`goal`](Self::goal).
    ///
    /// # Errors
    /// When a guard has no value.
    pub(super) fn target(&self) -> Result<Option<Point>, TransitionError> {
        self.site.automata.targets.value(self.duty.location(), self)
    }

    fn own_reference(&self) -> Option<Point> {
        self.duty.station().map(|station| station.reference)
    }

    fn reference_ahead(&self) -> Option<Point> {
        self.next_hop().map(|hop| hop.place.reference)
    }

    /// Where it goes along Σ: to the reference of the post ahead. Once it is within δ of the reference, but not of the
    /// task of that post, it goes on to the task: the robot that it relieves may stand in front of the reference. On the
    /// way it stays within δ of the reference, as the task is.
    fn place_ahead(&self) -> Option<Point> {
        let hop = self.next_hop()?;
        let reference = hop.place.reference;
        let is_near = |place: Point| {
            (self.body.position() - place).norm() <= self.site.settings.arrival_radius()
        };
        match self.task_at(&hop.post).filter(|&task| is_near(reference) && !is_near(task)) {
            Some(task) => Some(self.site.place_to_service(task, self.body.position())),
            None => Some(reference),
        }
    }

    /// The place on Σ that it has left, and where it goes: to the place ahead, or to the team that it has joined.
    pub(super) fn leg(&self) -> Option<(&Hop, Point)> {
        match self.hop_left() {
            Some(hop) => Some((hop, self.reference_ahead()?)),
            None => Some((self.hop_of_newcomer()?, self.team_goal()?)),
        }
    }

    /// The place on Σ from which it has joined the team, if the robot that it follows is not attached to it yet.
    fn hop_of_newcomer(&self) -> Option<&Hop> {
        let joins = matches!(*self.duty, Duty::Following(_)) && self.is_pending();
        let path = self.mission.path().filter(|_| joins)?;
        path.hops.get(path.last_break_point())
    }

    /// The access points that it passes on its way, if any.
    pub(super) fn crossing(&self) -> Option<&[usize]> {
        self.leg().map(|(hop, _)| &hop.crossing[..]).filter(|passed| !passed.is_empty())
    }

    /// The next access point that it passes; a newcomer has to be attached to one before it goes on to the next.
    fn next_of_crossing(&self) -> Option<Point> {
        let crossing = self.crossing()?;
        let index = self.index_in_crossing(crossing);
        let reached = crossing.get(index).map(|&access| Anchor::Access(access));
        let is_attached = !self.duty.is_primary() || self.anchor() == reached;
        let next = crossing.get(index + usize::from(is_attached))?;
        Some(self.site.access_points[*next])
    }

    /// Whether it has yet to change over to another access point, and the shortest way from the place that it has left
    /// is out of reach of both.
    pub(super) fn is_before_changeover(&self) -> bool {
        let (Some(_), Some((hop, goal))) = (self.next_of_crossing(), self.leg()) else {
            return false;
        };
        !self.keeps_link_on_the_way(&hop.crossing, hop.place.position, goal)
    }

    pub(super) fn is_off_post(&self) -> bool {
        self.own_reference().is_some_and(|reference| self.is_off(reference))
    }

    pub(super) fn is_off_place_ahead(&self) -> bool {
        self.reference_ahead().is_some_and(|reference| self.is_off(reference))
    }
}
