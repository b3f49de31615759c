//! The primary team: its order, its targets, and what it knows when it gets no farther (Sec. V-A).

use pleach_discrete::network::{Activity, Phase};

use super::*;
use crate::located::Place as _;
use crate::network::beacon::TeamReport;
use crate::network::duty::Bound;
use crate::network::record::Outcome;
use crate::network::robot::Label;
use crate::network::robot::team::SATURATED;
use crate::network::roll::{Absent, Wreck};
use crate::network::scenario::Strategy;

fn leader() -> Robot {
    let mut robot = robot();
    robot.holds(primary(30, None, 13));
    robot.advances_to(east(3.0));
    robot
}

/// Nobody else services a task by standing beside it.
#[test]
fn only_who_leads_is_near_to_the_task() {
    assert_eq!(robot().facts_now().distance, f64::INFINITY, "no task is known");
    let mut robot = leader();
    assert_eq!(robot.facts_now().distance, 3.0);
    robot.holds(primary(30, Some(29), 13));
    assert_eq!(robot.facts_now().distance, f64::INFINITY, "it follows");
}

#[test]
fn the_first_of_the_team_is_followed_by_nobody() {
    let mut robot = leader();
    assert!(robot.is_first() && robot.leads());
    robot.hears(beacon(1, west(0.3), primary(31, Some(29), 13), &[31, 13]));
    assert!(robot.is_first(), "that one follows another post");
    robot.hears(beacon(2, west(0.5), primary(32, Some(30), 13), &[32, 13]));
    assert!(!robot.is_first());
    robot.note_follower();
    robot.neighbours = Neighbours::default();
    robot.note_follower();
    assert!(!robot.is_first(), "one that falls silent follows all the same");
    robot.holds(primary(33, None, 13));
    robot.note_follower();
    assert!(robot.is_first(), "it was another post that was followed");
    robot.holds(fixed(30, 13));
    assert!(!robot.is_first(), "it is not of the team");
    let mut anew = leader();
    let announced =
        anew.mission.notices().announced().cloned().map(|(id, task)| (id.next(6), task));
    let of_before =
        Beacon { announced, ..beacon(2, west(0.5), primary(32, Some(30), 13), &[32, 13]) };
    anew.hears(of_before);
    assert!(anew.is_first(), "that team has been dissolved");
    let mut joined = leader();
    joined.is_told(Notice::Advance { joined: Some((PostId(40), PostId(30))) });
    assert!(!joined.is_first(), "a robot has joined to follow it");
    assert_eq!(joined.awaited_parent(), Some(PostId(40)));
    joined.holds(primary(30, None, 40));
    assert_eq!(joined.awaited_parent(), None, "it is attached to the newcomer");
    joined.is_told(Notice::Advance { joined: Some((PostId(40), PostId(29))) });
    assert_eq!(joined.awaited_parent(), None, "that one follows another post");
}

#[test]
fn members_go_to_the_robot_ahead_and_the_leader_to_the_task() {
    let mut robot = leader();
    assert_eq!(robot.team_goal(), Some(east(3.0)));
    robot.measures();
    assert_eq!(robot.goal(), Some(east(3.0)));
    robot.holds(primary(30, Some(31), 13));
    assert_eq!(robot.team_goal(), None, "the robot ahead is not heard");
    robot.hears(beacon(1, north(0.7), primary(31, None, 30), &[31, 30]));
    assert_eq!(robot.team_goal(), Some(north(0.7)));
    robot.holds(fixed(30, 13));
    assert_eq!(robot.team_goal(), None);
}

/// δ − 2.2ρ, so that a robot 2ρ behind is within δ; farther where the target is off the task.
#[test]
fn the_leader_stops_where_a_robot_behind_it_is_within_reach_as_well() {
    let mut robot = leader();
    assert!((robot.reach() - (SERVICE_RADIUS - 2.2 * CLEARANCE)).abs() < 1e-12);
    robot.knows_task(east(3.0) + Vector::new(0.15, 0.0));
    assert!((robot.reach() - (0.15 + 0.1 * CLEARANCE)).abs() < 1e-9, "{}", robot.reach());
    robot.knows_task(east(3.0) + Vector::new(SERVICE_RADIUS, 0.0));
    assert!((robot.reach() - SERVICE_RADIUS).abs() < 1e-12, "never farther than δ");
}

/// A robot has stopped at the task, east of it: the leader goes to the west of it.
#[test]
fn a_task_is_serviced_beside_a_robot_that_has_stopped_there() {
    let goal = |away: f64| {
        let mut robot = leader();
        robot.knows_task(east(3.0));
        let gone = [1].into_iter().collect();
        robot.membership.lacks(Absent { gone, ..Absent::default() });
        robot.membership.finds(vec![Wreck::heard(1, east(3.0 + away), NOW - 9)]);
        robot.team_goal().expect("it leads")
    };
    let kept = 2.1 * CLEARANCE + STEP;
    assert_eq!(goal(kept + LITTLE), east(3.0));
    let beside = goal(kept - LITTLE);
    assert!((beside - east(3.0 - 0.95 * SERVICE_RADIUS)).norm() < 1e-9, "{beside}");
}

/// A robot that had lost its parent has attached to it before it heard that this one is elected.
#[test]
fn a_leader_on_whose_post_a_branch_depends_is_bound_to_it() {
    let activity = |attached: Option<Post>, follower: Option<Post>| {
        let mut robot = leader();
        if let Some(post) = attached {
            robot.hears(beacon(1, east(0.5), post, &[]));
        }
        if let Some(post) = follower {
            robot.hears(beacon(2, west(0.5), post, &[]));
        }
        robot.measures();
        robot.jump_duty(Label::Alone).expect("its guards have values");
        robot.duty.location()
    };
    assert_eq!(activity(Some(fixed(21, 30)), None), Activity::Bound);
    assert_eq!(activity(Some(fixed(21, 13)), None), Activity::Leading);
    assert_eq!(activity(Some(redundant(21, 30)), None), Activity::Leading);
    let follower = Some(primary(31, Some(30), 13));
    assert_eq!(
        activity(Some(fixed(21, 30)), follower),
        Activity::Leading,
        "it does not lead alone"
    );
}

/// A leader with past duties whose post is within δ of its task keeps it, and services the task from there; in the
/// paper's order it is released first.
#[test]
fn a_bound_leader_services_a_task_within_reach_of_its_post() {
    let bound = |strategy: Strategy, task: Point, reference: Point, post: Post| {
        let mut scenario = hall();
        scenario.control.strategy = Some(strategy);
        let mut robot = robot_of(&scenario);
        robot.advances_to(task);
        let held = Held { station: Station { post, reference }, left: None };
        robot.duty.is(Duty::Bound(Bound(held)));
        robot
    };
    let jumped = |mut robot: Robot| {
        robot.jump().expect("its guards have values");
        let after = robot.duty.station().map(|station| (station.post.task, station.reference));
        (robot.phase(), robot.duty.location(), after)
    };
    let post = fixed(20, 13);
    let eager = |task: Point, reference: Point| bound(Strategy::Eager, task, reference, post);
    let serves = |reference: Point| (Phase::Idle, Activity::Leaf, Some((Some(0), reference)));
    let calls = |task: Option<usize>, reference: Point| {
        (Phase::RecruitElection, Activity::Bound, Some((task, reference)))
    };
    assert_eq!(jumped(eager(east(0.05), north(0.03))), serves(north(0.03)));
    assert_eq!(jumped(bound(Strategy::Paper, east(0.05), HERE, post)), calls(None, HERE));
    let of_task = |task: usize| Post { task: Some(task), ..post };
    assert_eq!(jumped(bound(Strategy::Eager, east(0.05), HERE, of_task(0))), serves(HERE));
    assert_eq!(jumped(bound(Strategy::Eager, east(0.05), HERE, of_task(1))), calls(Some(1), HERE));
    let near = east(SERVICE_RADIUS - LITTLE);
    assert_eq!(jumped(eager(near, HERE)), serves(HERE));
    assert_eq!(
        jumped(eager(near, west(0.01))),
        calls(None, west(0.01)),
        "its post is too far away"
    );
    assert_eq!(jumped(eager(east(SERVICE_RADIUS + LITTLE), HERE)), calls(None, HERE));
    let beside = east(SERVICE_RADIUS + LITTLE);
    assert_eq!(jumped(eager(east(0.1), beside)), calls(None, beside), "it is not at its post");
}

pub(super) fn report(still: u32, slack: Option<NodeId>, saturated: Option<NodeId>) -> TeamReport {
    TeamReport { still, slack, saturated, remaining: 1.5, members: 2, near_other_tree: false }
}

/// A report goes from the leader back to p₁: the member that moved last, and the first that has room.
#[test]
fn the_team_knows_how_long_it_has_stood_still_and_who_has_room() {
    let mut robot = leader();
    robot.body.waits(4);
    robot.review_team();
    let own = robot.mission.team().report().expect("it leads");
    assert_eq!((own.still, own.slack, own.saturated), (4, None, None), "its parent is not heard");
    assert!((own.remaining - 3.0).abs() < 1e-9);
    robot.hears(beacon(5, west(0.5), fixed(13, 14), &[13, 14]));
    robot.review_team();
    assert_eq!(
        robot.mission.team().report().and_then(|team| team.slack),
        Some(0),
        "its link is short"
    );

    let follows = |front: TeamReport, still: u32| {
        let mut robot = leader();
        robot.holds(primary(30, Some(31), 13));
        robot.body.waits(still);
        let ahead = beacon(1, east(1.0), primary(31, None, 30), &[31, 30]);
        robot.hears(Beacon { team: Some(front), ..ahead });
        robot.review_team();
        robot.mission.team().report().expect("the robot ahead has told")
    };
    let behind = |report: TeamReport| TeamReport { members: 3, ..report };
    assert_eq!(follows(report(7, None, None), 9), behind(report(7, None, None)));
    assert_eq!(follows(report(7, Some(3), Some(2)), 5), behind(report(5, Some(3), Some(2))));

    robot.mission.is(Mission::Idle(super::super::super::mission::Idle));
    robot.review_team();
    assert_eq!(robot.mission.team().report(), None, "the team does not move");
    let mut posted = leader();
    posted.holds(fixed(20, 13));
    posted.review_team();
    assert_eq!(posted.mission.team().report(), None, "it is not of the team");
}

/// A member whose link is shorter than 0.95 d_build has room to move.
#[test]
fn a_link_is_slack_below_its_length_by_a_twentieth() {
    let slack = |length: f64| {
        let mut robot = leader();
        robot.hears(beacon(5, west(length), fixed(13, 14), &[13, 14]));
        robot.review_team();
        robot.mission.team().report().expect("it leads").slack
    };
    let bound = 0.95 * leader().build_length();
    assert_eq!((slack(bound - LITTLE), slack(bound + LITTLE)), (Some(0), None));
}

/// Where messages are lost, the flows in use may leave no reserve for some periods.
#[test]
fn links_carry_no_more_where_a_robot_sends_nearly_all_the_time_whatever_is_left_of_its_reserve() {
    let told = |load: f64| {
        let mut robot = leader();
        robot.hears(beacon(5, west(0.5), fixed(13, 14), &[13, 14]));
        robot.survey_links();
        robot.routing.plans(&[load]);
        robot.routing.leaves(0.0);
        robot.review_team();
        let team = robot.mission.team().report().expect("it leads");
        (team.slack, team.saturated)
    };
    assert_eq!(told(SATURATED - LITTLE), (Some(0), None));
    assert_eq!(told(SATURATED), (None, Some(0)));
}

/// More room would not help a follower that is bunched behind the robot ahead.
#[test]
fn a_follower_right_behind_the_next_has_no_use_for_room() {
    let slack = |gap: f64| {
        let mut robot = leader();
        robot.holds(primary(30, Some(31), 13));
        robot.hears(beacon(5, west(0.5), fixed(13, 14), &[13, 14]));
        let ahead = beacon(1, east(gap), primary(31, None, 30), &[31, 30]);
        robot.hears(Beacon { team: Some(report(3, None, None)), ..ahead });
        robot.review_team();
        robot.mission.team().report().expect("the robot ahead has told").slack
    };
    let bunched = 2.6 * CLEARANCE;
    assert_eq!((slack(bunched - LITTLE), slack(bunched + LITTLE)), (None, Some(0)));
}

#[test]
fn a_link_of_the_tree_is_limited_by_what_hangs_on_it() {
    let mut robot = leader();
    robot.hears(beacon(5, west(0.5), fixed(13, 14), &[13, 14]));
    let child = |id, at, post| Beacon { parent: Some(0), ..beacon(id, at, post, &[]) };
    robot.hears(child(1, north(0.5), primary(31, Some(30), 30)));
    robot.hears(child(2, south(0.5), redundant(32, 30)));
    let (build, hard) = (robot.build_length(), robot.hard_length());
    assert!(build < hard);
    let limits: Vec<(NodeId, f64)> =
        robot.tree_links().into_iter().map(|link| (link.to, link.limit)).collect();
    assert_eq!(limits, [(5, build), (1, build), (2, hard)]);
    robot.holds(fixed(30, 13));
    assert_eq!(robot.parent_link().map(|link| link.limit), Some(hard));
    robot.mission.notices_mut().set_stretched(true);
    assert!(robot.hard_length() > hard && robot.build_length() > build);
}

#[test]
fn a_parent_that_is_not_heard_is_the_one_before() {
    let mut robot = robot();
    robot.holds(redundant(0, 11));
    robot.hears(beacon(1, east(0.5), fixed(11, 13), &[11, 13]));
    robot.remember_parent();
    assert_eq!(robot.tree_parent(), Some(1));
    let leaves = Duty::Shifting(Shifting { place: 1, left: Some(PostId(11)) });
    robot.hears(Beacon { duty: Some(leaves), ..beacon(1, east(0.5), fixed(11, 13), &[]) });
    assert_eq!(robot.tree_parent(), Some(1), "nobody holds post 11, and it is under way");
    robot.hears(beacon(1, east(0.5), redundant(31, 13), &[]));
    assert_eq!(robot.tree_parent(), Some(1), "another robot may have taken post 11 in an exchange");
    (0..4).for_each(|_| robot.tree.count_orphaned_period(true, 9));
    assert_eq!(robot.tree_parent(), None, "it has begun again");
    robot.neighbours = Neighbours::default();
    assert_eq!(robot.tree_parent(), None, "it is not heard");
    robot.holds(Post { parent: Some(Anchor::Access(0)), ..redundant(0, 0) });
    assert_eq!(robot.tree_parent(), Some(ROBOTS));
}

/// What the team waits for in vain counts for p₁ alone, and only where it could move or waits for p₁.
#[test]
fn the_first_of_the_team_counts_for_how_long_it_stands_still_without_need() {
    let stalled = |length: f64, has_follower: bool| {
        let mut robot = leader();
        robot.body.waits(4);
        robot.hears(beacon(5, west(length), fixed(13, 14), &[13, 14]));
        if has_follower {
            robot.hears(beacon(2, west(0.5), primary(32, Some(30), 13), &[32, 13]));
        }
        robot.review_team();
        robot.measures();
        robot.changes.facts().stalled
    };
    let bound = 0.96 * leader().build_length();
    assert_eq!((stalled(0.5, false), stalled(0.5, true)), (4.0, 0.0));
    assert_eq!((stalled(bound, false), stalled(bound, true)), (0.0, 0.0));
}

/// The leader has been cut off, and is attached elsewhere: no report of it comes to the robots that follow.
#[test]
fn a_team_that_does_not_hear_of_its_leader_does_not_wait_for_ever() {
    let mut robot = leader();
    robot.holds(primary(30, Some(31), 13));
    robot.hears(beacon(1, east(0.5), primary(31, Some(32), 30), &[31, 30, 13]));
    robot.hears(beacon(5, west(0.5), fixed(13, 14), &[13, 14]));
    robot.body.waits(robot.patience().ceil() as u32);
    robot.review_team();
    robot.measures();
    assert_eq!((robot.mission.team().report(), robot.changes.facts().pending), (None, false));
    robot.jump_mission().expect("its guards have values");
    let Notice::Ended { outcome, reason, .. } = robot.notice() else { panic!("it waits") };
    assert_eq!(*outcome, Outcome::Blocked);
    assert!(reason.contains("does not hear of the leader any more"), "{reason}");
}

#[test]
fn only_the_newcomer_is_on_its_way_to_the_robot_that_it_joined() {
    let is_pending = |newcomer: u32, held: Option<Post>| {
        let mut robot = leader();
        robot.is_told(Notice::Advance { joined: Some((PostId(newcomer), PostId(29))) });
        if let Some(post) = held {
            robot.hears(beacon(1, west(0.5), post, &[29, 13]));
        }
        robot.measures();
        robot.changes.facts().pending
    };
    assert!(is_pending(30, None), "the robot that it joined is not heard");
    assert!(is_pending(30, Some(primary(29, None, 13))), "that one is not attached to it");
    assert!(!is_pending(30, Some(primary(29, None, 30))));
    assert!(!is_pending(40, None), "another robot is on its way");
}

/// p₁ called for a recruit when the leader reached its task, and its notice is the newer one.
#[test]
fn a_service_that_has_been_superseded_is_announced_again() {
    let told = |has_reached: bool, notice: Notice| {
        let mut robot = robot();
        robot.knows_task(east(3.0));
        robot.mission.has_accomplished(has_reached.then_some(robot.notice_id()));
        robot.is_told(notice);
        robot.measures();
        let jumps = robot.jump_mission().expect("its guards have values");
        (jumps, robot.phase(), matches!(*robot.notice(), Notice::Serviced { task: 0 }))
    };
    let call = || Notice::Call { caller: 1, releases_leader: false };
    assert_eq!(told(true, call()), (true, Phase::Idle, true));
    assert_eq!(told(true, Notice::Advance { joined: None }), (true, Phase::Idle, true));
    assert_eq!(told(false, call()), (true, Phase::RecruitElection, false));
    assert_eq!(told(true, Notice::Serviced { task: 0 }), (false, Phase::Idle, true));
    let mut robot = robot();
    robot.knows_task(east(3.0));
    robot.mission.has_accomplished(Some(robot.notice_id()));
    robot.mission.notices_mut().supersede(ROBOTS, Notice::Quiet);
    robot.is_told(call());
    assert!(!robot.facts_now().service_unheard, "the task has been announced again since");
}
