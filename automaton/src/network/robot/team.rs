//! The primary team (Sec. V-A): its leader, its order, and when it is stuck.

use std::f64::consts::TAU;

use pleach_continuous::geometry::Disc;
use pleach_continuous::{Point, Vector};
use pleach_discrete::network::{Anchor, NodeId, Phase, Post, PostId, PostKind};

use super::Robot;
use super::hearing::Neighbour;
use super::mission::{Effects, MissionEffect, end};
use super::motion::PERSISTENCE;
use super::way::KEEP_OUT;
use crate::network::beacon::{Notice, TeamReport};
use crate::network::duty::Hop;
use crate::network::mission::{Advance, Ended, Idle};
use crate::network::record::{MissionEvent, Outcome};
use crate::network::roll::why_absent;
use crate::network::scenario::Strategy;

/// The leader stops at δ − 2.2ρ from its task, so that a robot 2ρ behind it is within δ as well.
const STAND_OFF: f64 = 2.2;
/// Where a robot has stopped at the task, the leader goes to another place: at this share of δ from the
/// task, in one of this many directions.
const WITHIN: f64 = 0.95;
const DIRECTIONS: u8 = 32;
/// How near to a target that it cannot get closer to a leader goes, as a share of ρ.
const TOUCH: f64 = 0.1;
/// A member of the primary team this many ρ behind the next is bunched: more room would not help.
const BUNCHED: f64 = 2.6;
/// A link shorter than this share of d_build is slack.
const SLACK: f64 = 0.95;
/// A robot that sends for this share of its time is at the limit of what its links carry.
pub const SATURATED: f64 = 0.95;

/// The leader is within reach of its task, and services it.
pub(super) fn announce_service(_: &Advance, robot: &Robot, effects: &mut Effects) -> Option<Idle> {
    let task = robot.current_task()?;
    let event = MissionEvent::TaskServiced { task, robot: robot.id };
    let notice = Notice::Serviced { task };
    effects.extend([
        MissionEffect::Report(event),
        MissionEffect::Issue(notice),
        MissionEffect::Accomplish,
    ]);
    Some(Idle)
}

/// Another notice was issued at the same time as that of the service, and has superseded it.
pub(super) fn announce_service_again(
    idle: &Idle,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<Idle> {
    let task = robot.current_task()?;
    effects.push(MissionEffect::Issue(Notice::Serviced { task }));
    Some(*idle)
}

/// The task is serviced: the robot waits for the next one.
pub(super) fn wait<A>(_: &A, _: &Robot, effects: &mut Effects) -> Idle {
    effects.push(MissionEffect::ForgetRoute);
    Idle
}

/// The active team cannot go on, and a recruit would not help.
pub(super) fn give_up<A>(phase: &A, robot: &Robot, effects: &mut Effects) -> Ended {
    let (name, slack) =
        (robot.site.name_of(robot.id), robot.mission.team().report().and_then(|team| team.slack));
    let reason = match (robot.duty.place(), slack.map(|slack| robot.site.name_of(slack))) {
        (Some(_), _) => format!(
            "robot {name} cannot get to the place of Σ that it should take: its link does not reach there, or \
             something stands in its way"
        ),
        (None, Some(slack)) => format!(
            "the primary team stands still although robot {slack} has room on its link: something \
             stands in its way, and a recruit would not help"
        ),
        (None, None) if robot.is_pending() => format!(
            "robot {name} has joined the primary team but cannot reach the robot that it follows"
        ),
        (None, None) => format!(
            "the primary team stands still: robot {name}, its last one, does not hear of the leader any more"
        ),
    };
    let notice = robot.gives_up(robot.current_task(), Outcome::Blocked, reason);
    effects.extend([MissionEffect::Stay, MissionEffect::Issue(notice)]);
    end(phase, robot, effects)
}

impl TeamReport {
    /// Whether all members from the leader back to the sender stand still.
    pub(super) const fn stands_still(&self) -> bool {
        self.still >= PERSISTENCE
    }
}

impl Robot {
    /// The notice by which this robot gives up the mission; the reason is followed by the robots that are missed.
    pub(super) fn gives_up(
        &self,
        task: Option<usize>,
        outcome: Outcome,
        mut reason: String,
    ) -> Notice {
        let stopped: Vec<NodeId> =
            self.membership.wrecks().iter().map(|wreck| wreck.robot).collect();
        if !stopped.is_empty() {
            reason.push_str(&format!("; {}", why_absent(&self.site.names_of(&stopped))));
        }
        Notice::Ended { outcome, reason: reason.into(), task }
    }

    /// Whether this robot is the elected leader, released or not.
    pub(super) fn leads(&self) -> bool {
        self.duty.leads()
    }

    /// Whether this robot is p₁: no robot of the team follows it.
    ///
    /// In an exchange of duties there is an instant in which the mover has taken its new duty and
    /// the parked robot still holds its own: the duty of the mover has no holder. The robot ahead
    /// remembers its follower.
    pub(super) fn is_first(&self) -> bool {
        self.primary_post()
            .is_some_and(|own| !self.hears_follower(own) && !self.expects_follower(own))
    }

    /// Its post, if that is one of the primary team.
    fn primary_post(&self) -> Option<PostId> {
        self.duty.post().filter(|post| post.is_primary()).map(|post| post.id)
    }

    /// Whether a neighbour holds the post that follows `own`. One that goes by another announcement is of a team that
    /// has been dissolved since.
    fn hears_follower(&self, own: PostId) -> bool {
        let follows = |post: &Post| post.kind == PostKind::Primary { follows: Some(own) };
        let own_team = self.mission.notices().announcement_id();
        let is_of_another = |neighbour: &Neighbour| {
            neighbour.beacon.announced.as_ref().is_some_and(|(id, _)| Some(*id) != own_team)
        };
        let mut team = self.neighbours.iter().filter(|neighbour| !is_of_another(neighbour));
        team.any(|neighbour| neighbour.post().is_some_and(follows))
    }

    /// Whether a robot has followed it on this post, or has joined the team to do so.
    fn expects_follower(&self, own: PostId) -> bool {
        let has_joined = matches!(*self.notice(),
            Notice::Advance { joined: Some((_, followed)) } if followed == own);
        has_joined || self.mission.team().followed_post() == Some(own)
    }

    /// Remembers that a robot follows it: one that falls silent follows all the same.
    pub(super) fn note_follower(&mut self) {
        let follows = |own: &PostId| {
            self.hears_follower(*own) || self.mission.team().followed_post() == Some(*own)
        };
        let followed = self.primary_post().filter(follows);
        self.mission.team_mut().follow(followed);
    }

    /// The post of a newcomer that this robot should attach to but does not yet reach.
    pub(super) fn awaited_parent(&self) -> Option<PostId> {
        let post = self.duty.post()?;
        match *self.notice() {
            Notice::Advance { joined: Some((newcomer, followed)) }
                if followed == post.id && !post.is_child_of(newcomer) =>
            {
                Some(newcomer)
            }
            _ => None,
        }
    }

    /// ψ of a member of the primary team, eq. (24).
    pub(super) fn team_goal(&self) -> Option<Point> {
        match self.duty.post()?.kind {
            PostKind::Primary { follows: None } => self.leader_goal(),
            PostKind::Primary { follows: Some(ahead) } => match self.holder(ahead) {
                Some(neighbour) => Some(neighbour.position()),
                None => self.mission.path()?.hops.last().map(|caller| self.whereabouts_of(caller)),
            },
            _ => None,
        }
    }

    /// Where p₁ is found that called from here and is not heard yet: where it stood then or, if it has gone on,
    /// near the access point that it was attached to.
    fn whereabouts_of(&self, caller: &Hop) -> Point {
        match caller.post.parent {
            Some(Anchor::Access(access)) if self.is_eager() => {
                self.site.free_space.nearest(self.site.access_points[access])
            }
            _ => caller.place.position,
        }
    }

    /// ψ of the leader: its target or, where a robot has stopped there or one of another fleet rests, the place within δ
    /// of the task that is farthest from such robots.
    fn leader_goal(&self) -> Option<Point> {
        let (target, task) = (self.mission.target()?, self.announcement()?.position);
        let radius = KEEP_OUT * self.clearance();
        let wrecks = self.keep_out_discs(radius);
        let keep_out: Vec<Disc> = wrecks.chain(self.discs_of_bodies(radius)).collect();
        if !keep_out.iter().any(|disc| disc.contains(target)) {
            return Some(target);
        }
        let radius = WITHIN * self.site.settings.arrival_radius();
        let room = |place: &Point| {
            let to = |disc: &Disc| (disc.center - place).norm() - disc.radius;
            keep_out.iter().map(to).fold(f64::INFINITY, f64::min)
        };
        let around = (0..DIRECTIONS).map(|number| {
            let angle = TAU * f64::from(number) / f64::from(DIRECTIONS);
            task + Vector::new(angle.cos(), angle.sin()) * radius
        });
        let free = around.filter(|&place| self.site.free_space.contains(place));
        free.max_by(|one, other| room(one).total_cmp(&room(other))).or(Some(target))
    }

    /// The distance from the announced task at which the leader stops.
    pub(super) fn reach(&self) -> f64 {
        let settings = &self.site.settings;
        let task = self.announcement().map(|announcement| announcement.position);
        let gap =
            self.mission.target().zip(task).map_or(0.0, |(target, task)| (target - task).norm());
        let stand_off = settings.leash_radius() - STAND_OFF * self.clearance();
        let touch = TOUCH * self.clearance() + self.stray();
        stand_off.max(gap + touch).min(settings.arrival_radius())
    }

    /// What the team knows of itself, from the leader back to this robot.
    pub(super) fn review_team(&mut self) {
        self.mission.team_mut().review(None);
        if self.phase() != Phase::Advance || !self.duty.is_primary() {
            return;
        }
        let own_slack = (self.is_slack() || self.is_near_enough()).then_some(self.id);
        let own_saturated = (self.is_saturated() && !self.is_at_limit()).then_some(self.id);
        let still = self.body.still_periods();
        let near_other_tree = self.is_eager() && self.is_near_other_tree();
        let report = match self.duty.post().map(|post| post.kind) {
            Some(PostKind::Primary { follows: Some(ahead) }) => {
                self.holder(ahead).and_then(|n| n.beacon.team).map(|front| TeamReport {
                    still: front.still.min(still),
                    slack: front.slack.or(own_slack),
                    saturated: front.saturated.or(own_saturated),
                    members: front.members.saturating_add(1),
                    near_other_tree: front.near_other_tree || near_other_tree,
                    ..front
                })
            }
            _ => Some(TeamReport {
                still,
                slack: own_slack,
                saturated: own_saturated,
                remaining: self.remaining(),
                members: 1,
                near_other_tree,
            }),
        };
        self.mission.team_mut().review(report);
    }

    /// Whether recruits are called for ahead of a standstill, and the primary team goes on meanwhile.
    pub(super) fn is_eager(&self) -> bool {
        self.site.settings.strategy == Strategy::Eager
    }

    /// Whether it is of a primary team that goes on although it is not the active team.
    pub(super) fn goes_on_while_recruiting(&self) -> bool {
        self.is_eager() && self.duty.is_primary() && self.tree_is_frozen()
    }

    /// How many links lead from the parent of p₁ to where the leader [stops](Self::reach), each as long as it may ever be,
    /// and how many the team has: one for each member.
    pub(super) fn links_left(&self) -> Option<(f64, f64)> {
        let parent = self.neighbour_at(self.anchor()?)?;
        let (target, members) =
            (self.mission.target()?, f64::from(self.mission.team().report()?.members));
        let (from, longest) = (parent.position(), self.longest_length());
        Some((self.site.links_between(from, target, longest, self.reach()), members))
    }

    /// The distance to the task announced.
    pub(super) fn distance_to_task(&self) -> Option<f64> {
        self.announcement()
            .map(|announcement| (announcement.position - self.body.position()).norm())
    }

    /// Geodesic distance to the place from which the announced task is serviced.
    pub(super) fn remaining(&self) -> f64 {
        self.mission.target().map_or(0.0, |target| self.site.distance(self.body.position(), target))
    }

    /// Whether the robot has room to move: its link is neither at its limit nor is it bunched.
    fn is_slack(&self) -> bool {
        let bunched = || {
            self.team_goal().is_none_or(|goal| {
                (goal - self.body.position()).norm() <= BUNCHED * self.clearance()
            })
        };
        !self.is_at_limit() && !self.is_saturated() && (self.leads() || !bunched())
    }

    /// Whether its link to its parent is as long as it may be.
    fn is_at_limit(&self) -> bool {
        let parent = self.anchor().and_then(|anchor| self.neighbour_at(anchor));
        parent.is_none_or(|parent| self.length_ahead(parent) >= SLACK * self.build_length())
    }

    /// The length of its link to this node, or what that would be a step ahead: it may be longer at once where the
    /// shortest way changes over to the other side of an obstacle.
    fn length_ahead(&self, node: &Neighbour) -> f64 {
        let now = self.walk_to(node);
        let ahead = self.negotiation.navigation().waypoint().map(|waypoint| {
            let way = waypoint - self.body.position();
            let step = self.site.settings.step_radius.min(way.norm());
            let place = self.body.position() + way.try_normalize(0.0).unwrap_or_default() * step;
            self.site.walk(place, node.position())
        });
        ahead.map_or(now, |ahead| now.max(ahead))
    }

    /// Whether it leads and can service its task from where it is, although another robot beside it could not: where
    /// none is left that could come, nobody has to.
    fn is_near_enough(&self) -> bool {
        let within = |distance: f64| distance <= self.site.settings.arrival_radius();
        self.leads()
            && self.mission.notices().is_stretched()
            && self.distance_to_task().is_some_and(within)
    }

    /// Whether it is bound to a post from which it can service the task that it leads to. In the paper's order it is
    /// released from its post all the same (Sec. V-A2).
    pub(super) fn can_serve_from_post(&self) -> bool {
        let bound = self.duty.station().filter(|_| self.is_eager() && self.duty.is_bound());
        let (Some(station), Some(task)) = (bound, self.announcement()) else { return false };
        let within = self.site.settings.arrival_radius();
        let are_near = |one: Point, other: Point| (one - other).norm() <= within;
        station.post.task.is_none_or(|serviced| serviced == task.task)
            && are_near(station.reference, task.position)
            && are_near(self.body.position(), task.position)
            && are_near(self.body.position(), station.reference)
    }

    /// Whether the links of the robot carry no more, so that it stops where h_i ≤ 1 would break: a recruit makes them
    /// shorter. What is left of its reserve does not tell that. Moves leave flows as they are, and with them c_i; and
    /// where messages are lost, flows in use lag behind the plan for some periods, and leave no reserve.
    fn is_saturated(&self) -> bool {
        self.routing.load() >= SATURATED
    }
}
