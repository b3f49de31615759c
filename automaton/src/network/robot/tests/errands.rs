//! What a robot does when the task is over that it services or pursues.

use pleach_discrete::network::{Activity, IdSet, Phase};

use super::*;
use crate::located::Place as _;
use crate::network::duty::{Bound, Leaf};
use crate::network::record::Outcome;
use crate::network::robot::duties::Label;

/// A post from which task 2 is serviced.
fn held() -> Held {
    let post = Post { parent: Some(Anchor::Access(0)), task: Some(2), ..fixed(0, 0) };
    Held { station: Station { post, reference: HERE }, left: None }
}

/// Robot 0 with this duty, which hears that these tasks are over.
fn told(duty: Duty, closed: &[usize]) -> Robot {
    let mut robot = robot();
    robot.duty.is(duty);
    let closed: Arc<IdSet> = Arc::new(closed.iter().copied().collect());
    robot.hears(Beacon { closed, ..beacon(1, east(0.5), fixed(1, 0), &[1]) });
    robot.hear_notices();
    robot.measures();
    robot.jump_duty(Label::Alone).expect("guards have values");
    robot
}

#[test]
fn a_leaf_whose_task_is_over_holds_a_plain_post() {
    let task = |robot: &Robot| robot.duty.post().and_then(|post| post.task);
    let other = told(Duty::Leaf(Leaf(held())), &[0, 1]);
    assert_eq!((other.duty.location(), task(&other)), (Activity::Leaf, Some(2)));
    let robot = told(Duty::Leaf(Leaf(held())), &[0, 2]);
    assert_eq!((robot.duty.location(), task(&robot)), (Activity::Relay, None));
    assert_eq!(robot.duty.post().map(|post| post.parent), Some(held().station.post.parent));
    assert!(robot.public_state().closed.contains(2), "it passes on what it has heard");
}

/// A leader that is bound answers for its post until it is released.
#[test]
fn a_bound_leader_keeps_its_post() {
    let robot = told(Duty::Bound(Bound(held())), &[2]);
    assert_eq!(robot.duty.location(), Activity::Bound);
}

/// The notice supersedes what others issue meanwhile: whatever a robot is at, it goes on without the task.
#[test]
fn a_team_whose_task_is_taken_back_is_dissolved() {
    let mut robot = robot();
    robot.holds(primary(0, None, 1));
    robot.advances_to(east(3.0));
    let notice = Notice::Withdrawn { task: 0 };
    robot.mission.notices_mut().supersede(ROBOTS, notice);
    robot.measures();
    assert!(robot.jump_mission().expect("guards have values"));
    assert_eq!((robot.phase(), robot.duty.location()), (Phase::Idle, Activity::Relay));
    assert!(!robot.jump_mission().expect("guards have values"), "it has nothing else to give up");
}

// ---- After an end ----------------------------------------------------------------------------

/// Robot 0 has given the mission up, and receives this notice.
fn after_the_end(notice: Notice) -> Phase {
    let mut robot = robot();
    robot.holds(redundant(0, 0));
    let end = Notice::Ended { outcome: Outcome::Blocked, reason: Arc::default(), task: Some(0) };
    robot.mission.notices_mut().issue(1, end);
    robot.measures();
    assert!(robot.jump_mission().expect("guards have values"));
    assert_eq!(robot.phase(), Phase::Ended);
    robot.mission.notices_mut().supersede(ROBOTS, notice);
    robot.measures();
    robot.jump_mission().expect("guards have values");
    robot.phase()
}

/// Others have joined, and the task is announced again. Who has missed that takes part like any other.
#[test]
fn a_robot_takes_up_a_mission_that_goes_on() {
    let announcement = Announcement {
        task: 0,
        position: HERE,
        before: Arc::from([]),
        roster: Arc::new([0, 1].into_iter().collect()),
        eligible: Arc::new([0].into_iter().collect()),
        again: false,
        stretched: false,
        last_resort: None,
    };
    let announced = after_the_end(Notice::Task(Shared::new(announcement)));
    assert_eq!(announced, Phase::LeaderElection);
    let called = after_the_end(Notice::Call { caller: 1, releases_leader: false });
    assert_eq!(called, Phase::Idle);
}
