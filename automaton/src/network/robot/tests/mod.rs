//! The rules of robots, one at a time: a robot, the beacons of its neighbours, and what it makes of them.

mod attachment;
mod bodies;
mod eager;
mod elections;
mod errands;
mod errors;
mod exchanges;
mod flows;
mod hearing;
mod lemmas;
mod moves;
mod partner;
mod seen;
mod shortening;
mod team;
mod ways;
mod wrecks;
mod yielding;

use std::sync::Arc;

use pleach_continuous::{Point, Vector};
use pleach_discrete::network::{Anchor, Lineage, NodeId, Phase, Post, PostId, PostKind};
use serde_json::json;

use super::Robot;
use super::neighbours::Neighbours;
use crate::network::beacon::{Announcement, Beacon, Notice};
use crate::network::duty::{
    Duty, Following, Held, Leading, Path, Relay, Shifting, Standby, Station,
};
use crate::network::member::NodeOutputs;
use crate::network::message::Message;
use crate::network::mission::{Advance, Ended, Mission, RecruitElection, Shift};
use crate::network::roll::Roll;
use crate::network::scenario::{AccessPoint, Scenario};
use crate::network::shared::Shared;
use crate::network::site::Site;
use crate::node::Destination;

/// ρ.
const CLEARANCE: f64 = 0.04;
/// δ.
const SERVICE_RADIUS: f64 = 0.2;
/// σ.
const STEP: f64 = 0.1;
/// The robots of the hall; the only access point is node `ROBOTS`.
pub(super) const ROBOTS: usize = 6;
/// Where robot 0 stands.
pub(super) const HERE: Point = Point::new(5.0, 5.0);
/// The control period.
pub(super) const NOW: u32 = 50;
/// Anything that is surely on one side of a bound.
const LITTLE: f64 = 1e-6;

/// A hall of 10 × 10 with a pillar in the north-east, far from robot 0.
pub(super) fn hall() -> Scenario {
    let robots: Vec<_> =
        (0..ROBOTS).map(|at| json!({"position": [1.0 + at as f64, 1.0], "rate": 0.1})).collect();
    serde_json::from_value(json!({
        "name": "hall",
        "workspace": {
            "boundary": [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]],
            "holes": [[[7.0, 7.0], [8.0, 7.0], [8.0, 8.0], [7.0, 8.0]]],
        },
        "link": {"full_range": 1.0, "max_range": 2.0},
        "control": {
            "clearance": CLEARANCE, "service_radius": SERVICE_RADIUS, "step_radius": STEP,
            "tree_reliability": 0.1, "period": 0.5,
        },
        "access_point": [{"position": [1.0, 2.0]}],
        "robot": robots,
        "task": [{"position": [9.0, 9.0]}],
    }))
    .expect("it is a scenario")
}

fn robot_of(scenario: &Scenario) -> Robot {
    let site = Arc::new(Site::new(scenario).expect("its numbers make sense"));
    let mut robot = Robot::new(0, HERE, 0.1, site);
    robot.schedule.is_in(NOW);
    robot
}

/// Robot 0 in the hall: redundant, attached to nothing.
fn robot() -> Robot {
    robot_of(&hall())
}

fn post(id: u32, kind: PostKind, parent: Option<u32>) -> Post {
    let parent = parent.map(|parent| Anchor::Post(PostId(parent)));
    Post { kind, parent, ..Post::redundant(PostId(id)) }
}

/// The phase of the mission after a step, if one is taken.
fn next_phase(robot: &mut Robot) -> Phase {
    robot.measures();
    robot.jump_mission().expect("its guards have values");
    robot.phase()
}

/// The post of a redundant robot, attached to post `parent`.
fn redundant(id: u32, parent: u32) -> Post {
    post(id, PostKind::Redundant, Some(parent))
}

/// A fixed post, attached to post `parent`.
pub(super) fn fixed(id: u32, parent: u32) -> Post {
    post(id, PostKind::Fixed, Some(parent))
}

/// A post of the primary team.
fn primary(id: u32, follows: Option<u32>, parent: u32) -> Post {
    post(id, PostKind::Primary { follows: follows.map(PostId) }, Some(parent))
}

/// What a robot does that holds this post at `reference`.
fn holding(post: Post, reference: Point) -> Duty {
    let held = Held { station: Station { post, reference }, left: None };
    match post.kind {
        PostKind::Redundant => Duty::Standby(Standby(held)),
        PostKind::Fixed => Duty::Relay(Relay(held)),
        PostKind::Primary { follows: None } => Duty::Leading(Leading(held)),
        PostKind::Primary { follows: Some(_) } => Duty::Following(Following(held)),
    }
}

/// The way over these posts, the first one's own, to the access point.
fn way(posts: &[u32]) -> Option<Arc<Lineage>> {
    let root = Lineage::of_access_point(0);
    let extended = |way: Lineage, post: &u32| way.extended_by(PostId(*post)).expect("they differ");
    Some(Arc::new(posts.iter().rev().fold(root, extended)))
}

pub(super) fn east(distance: f64) -> Point {
    HERE + Vector::new(distance, 0.0)
}

pub(super) fn west(distance: f64) -> Point {
    east(-distance)
}

fn north(distance: f64) -> Point {
    HERE + Vector::new(0.0, distance)
}

fn south(distance: f64) -> Point {
    north(-distance)
}

/// The beacon of a robot that holds a post where it stands; its way leads over these posts.
pub(super) fn beacon(id: NodeId, position: Point, post: Post, posts: &[u32]) -> Beacon {
    Beacon {
        duty: Some(holding(post, position)),
        parked: !post.is_primary(),
        lineage: if posts.is_empty() { None } else { way(posts) },
        ..Beacon::silent(id, position)
    }
}

/// The beacon of the access point, if that stood here.
pub(super) fn access_point(position: Point) -> Beacon {
    Beacon { lineage: way(&[]), ..Beacon::silent(ROBOTS, position) }
}

/// What has been sent since the outputs were read last.
pub(super) fn sent(outputs: &mut NodeOutputs) -> Vec<(Destination, Message)> {
    outputs.drain_sent().map(|envelope| (envelope.to, envelope.message)).collect()
}

impl Robot {
    /// It hears a beacon in this control period.
    fn hears(&mut self, beacon: Beacon) {
        self.hear_beacon(self.schedule.period(), None, &Arc::new(beacon));
    }

    /// So much flows to this node, over a lease that lasts.
    fn sends(&mut self, to: NodeId, flow: f64) {
        self.reservation.sends(to, flow);
    }

    /// It holds this post where it stands.
    fn holds(&mut self, post: Post) {
        self.duty.is(holding(post, self.body.position()));
    }

    /// The primary team is the active team, and goes to the task at `place`.
    fn advances_to(&mut self, place: Point) {
        self.mission.is(Mission::Advance(Advance { path: None, in_vain: false }));
        self.knows_task(place);
        self.mission.leads_to(place);
    }

    /// A recruit is sought, and this robot has called for it ahead of a standstill or not at all; links had been
    /// stretched before, or not.
    fn seeks_recruit(&mut self, ahead: bool, stretched: bool) {
        let election = RecruitElection { before: None, standstill: None, ahead, stretched };
        self.mission.is(Mission::RecruitElection(election));
    }

    /// The task announced is at `place`, and all take part.
    fn knows_task(&mut self, place: Point) {
        let announcement = Announcement {
            task: 0,
            position: place,
            before: Arc::default(),
            roster: Arc::new((0..ROBOTS).collect()),
            eligible: Arc::new([0].into_iter().collect()),
            again: false,
            stretched: false,
            last_resort: None,
        };
        let announcement = Shared::new(announcement);
        let id = self.notice_id();
        self.mission.notices_mut().follow(Some((id, announcement)));
    }

    /// The task has been announced as a last resort.
    fn knows_last_resort(&mut self) {
        let (id, known) = self.mission.notices().announced().cloned().expect("it knows the task");
        let last_resort = Some(Arc::new("too few".to_owned()));
        self.mission
            .notices_mut()
            .follow(Some((id, Shared::new(Announcement { last_resort, ..(*known).clone() }))));
    }

    /// What it is told by the newest notice.
    fn is_told(&mut self, notice: Notice) {
        self.mission.notices_mut().issue(1, notice);
    }

    /// It measures what its guards ask of it.
    fn measures(&mut self) {
        self.note_change();
        self.measure();
    }
}
