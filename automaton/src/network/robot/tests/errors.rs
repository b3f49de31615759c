//! What a robot makes of errors of its position and its moves.

use pleach_continuous::network::reliability::LinkReliability as _;
use pleach_discrete::network::MissionStep;

use super::*;
use crate::network::beacon::Branch;
use crate::network::duty::{Hop, PathPlace};
use crate::network::robot::duties::Label;

const POSITION_ERROR: f64 = 0.01;
const MOTION_ERROR: f64 = 0.02;

fn unsure() -> Robot {
    let mut hall = hall();
    hall.control.position_error = Some(POSITION_ERROR);
    hall.control.motion_error = Some(MOTION_ERROR);
    robot_of(&hall)
}

/// It stays where it has measured itself before unless it has moved, is farther off than two errors of
/// position, or wants to go on and has not for some periods.
#[test]
fn a_robot_that_has_not_moved_stays_where_it_has_measured_itself() {
    let corrects = |off: f64, change: &dyn Fn(&mut Robot)| {
        let mut robot = unsure();
        change(&mut robot);
        robot.correct_position(east(off));
        robot.body.position() != HERE
    };
    let within = 2.0 * POSITION_ERROR;
    assert!(!corrects(within, &|_| {}) && corrects(within + LITTLE, &|_| {}));
    assert!(corrects(0.001, &|robot| robot.body.is_moving_by(Vector::new(0.1, 0.0))));
    for (still, tries) in [(0, false), (2, false), (3, true), (4, false), (7, true)] {
        let wants = |robot: &mut Robot| {
            robot.negotiation.navigation_mut().turn_to(east(1.0));
            robot.body.waits(still);
        };
        assert_eq!(corrects(0.001, &wants), tries, "{still}");
        let rests = |robot: &mut Robot| robot.body.waits(still);
        assert!(!corrects(0.001, &rests), "it wants to go nowhere");
    }
}

#[test]
fn a_position_that_is_measured_again_is_no_news() {
    let mut robot = robot();
    robot.changes.settle();
    robot.correct_position(HERE);
    assert!(!robot.changes.are_news());
    robot.correct_position(east(LITTLE));
    assert!(robot.changes.are_news());
}

#[test]
fn a_robot_has_strayed_where_errors_have_led_it_out_of_the_free_space() {
    let at = |mut robot: Robot, position: Point| {
        robot.body.is_at(position);
        (robot.has_strayed(), robot.free_place())
    };
    let kept = CLEARANCE + POSITION_ERROR + MOTION_ERROR;
    let outside = Point::new(5.0, kept - 0.01);
    let (has_strayed, place) = at(unsure(), outside);
    assert!(has_strayed && (place - Point::new(5.0, kept)).norm() < 1e-4, "{place}");
    assert!(!at(unsure(), Point::new(5.0, kept + 0.01)).0);
    assert!(!at(robot(), Point::new(5.0, CLEARANCE / 2.0)).0, "there are no errors");
}

/// One that finds itself outside of its constraints goes back into them if its way gets shorter.
#[test]
fn a_robot_outside_of_its_constraints_returns_towards_its_goal_or_stays() {
    let moved = |goal: Point| {
        let mut robot = unsure();
        robot.holds(Post { parent: None, ..primary(30, None, 13) });
        robot.advances_to(goal);
        robot.membership.is_called_in(NOW);
        robot.body.is_at(Point::new(5.0, CLEARANCE + POSITION_ERROR + MOTION_ERROR - 0.01));
        robot.measures();
        robot.propose().expect("its guards have values");
        robot.negotiation.proposal().map(|segment| segment.to - segment.from)
    };
    let back = moved(Point::new(5.0, 3.0)).expect("the way in is the way to its goal");
    assert!(back.y >= 0.01 - 1e-6, "{back}");
}

#[test]
fn errors_make_clearances_larger_and_settled_places_wider() {
    let robot = unsure();
    assert!((robot.clearance() - (CLEARANCE + POSITION_ERROR + MOTION_ERROR)).abs() < 1e-12);
    assert!((robot.stray() - (2.0 * POSITION_ERROR + MOTION_ERROR)).abs() < 1e-12);
    let settled = 0.02 * robot.clearance() + robot.stray();
    assert!(!robot.is_off(east(settled - LITTLE)) && robot.is_off(east(settled + LITTLE)));
}

/// A link that may be as long as it is, with errors, is kept: a parent may measure itself 2 (2e + m) farther.
#[test]
fn a_parent_is_kept_as_far_off_as_both_may_stray() {
    let keeps = |length: f64| {
        let mut robot = unsure();
        robot.holds(redundant(0, 11));
        robot.hears(beacon(1, east(length), fixed(11, 13), &[11, 13]));
        robot.keep_place().expect("it goes on");
        robot.tree.desired_parent() == Some(Some(Anchor::Post(PostId(11))))
    };
    let robot = unsure();
    let limit = robot.hard_length() + 2.0 * robot.stray();
    assert!(keeps(limit - LITTLE) && !keeps(limit + LITTLE));
}

/// The path of robots 0, 1 and 2, the second of which has arrived at its place.
fn shifting(gap: f64, arrived: bool) -> Robot {
    let mut robot = robot();
    let hop = |number: u32, at: Point| Hop {
        robot: number as usize,
        post: fixed(number, 13),
        place: PathPlace { reference: at, position: at },
        crossing: Vec::new(),
    };
    let hops = vec![hop(0, west(1.0)), hop(1, east(1.0)), hop(2, east(2.0)), hop(3, east(3.0))];
    let path = Arc::new(Path { hops, releases_leader: false });
    let subgroups = pleach_discrete::network::path::subgroups(&[0, 3]).collect();
    robot.mission.is(Mission::Shift(Shift { path, subgroups, arrived: 0 }));
    robot.duty.is(Duty::Shifting(Shifting { place: 0, left: None }));
    let mut agreement = pleach_discrete::network::Agreement::new(robot.notice_id());
    if arrived {
        agreement.arrive(1);
    }
    robot.ballot.agree(Some(agreement));
    let ahead = Duty::Shifting(Shifting { place: 1, left: None });
    robot.hears(Beacon { duty: Some(ahead), ..Beacon::silent(1, east(gap)) });
    robot
}

/// Another path for a robot that is on its way along one.
fn change_path(robot: &mut Robot, change: impl FnOnce(&mut Path)) {
    let Mission::Shift(shift) = &**robot.mission.current() else { panic!("it is on its way") };
    let mut shift = shift.clone();
    change(Arc::make_mut(&mut shift.path));
    robot.mission.is(Mission::Shift(shift));
}

/// Eq. (26): within δ of its place, or right behind the next of its subgroup that has arrived.
#[test]
fn a_robot_has_arrived_near_its_place_or_behind_one_that_has() {
    let queue = 2.2 * CLEARANCE;
    assert!(shifting(queue - LITTLE, true).has_arrived());
    assert!(!shifting(queue + LITTLE, true).has_arrived(), "it is not right behind");
    assert!(!shifting(queue - LITTLE, false).has_arrived(), "that one has not arrived");
    let near = |away: f64| {
        let mut robot = shifting(0.5, false);
        robot.body.is_at(east(1.0 - away));
        robot.hears(beacon(4, HERE, fixed(13, 14), &[13, 14]));
        robot.has_arrived()
    };
    assert!(near(SERVICE_RADIUS - LITTLE) && !near(SERVICE_RADIUS + LITTLE));
    assert_eq!(shifting(0.5, false).next_hop().map(|hop| hop.robot), Some(1));
    assert!(!robot().has_arrived(), "it is on no path");
    let mut last = shifting(queue - LITTLE, true);
    last.duty.is(Duty::Shifting(Shifting { place: 2, left: None }));
    assert!(!last.has_arrived(), "the break point at the end is of another subgroup");
}

/// The robot that is relieved of a task may stand before the place from which that is serviced.
#[test]
fn a_robot_near_its_place_goes_on_to_the_task_that_is_serviced_there() {
    let goal = |from: Point| {
        let mut robot = shifting(0.5, false);
        change_path(&mut robot, |path| path.hops[1].post.task = Some(0));
        robot.knows_task(task());
        robot.body.is_at(from);
        robot.measures();
        (robot.goal(), robot.has_arrived())
    };
    fn task() -> Point {
        east(1.0) - Vector::new(0.0, 0.9 * SERVICE_RADIUS)
    }
    let beside = |away: f64| east(1.0) + Vector::new(0.0, away);
    assert_eq!(goal(beside(SERVICE_RADIUS + LITTLE)), (Some(east(1.0)), false), "it is far off");
    assert_eq!(goal(beside(0.5 * SERVICE_RADIUS)), (Some(task()), false));
    assert_eq!(goal(beside(-0.5 * SERVICE_RADIUS)).0, Some(east(1.0)), "the task is near");
}

/// A robot that comes from the far side takes the post over where its links hold, or at the post itself.
#[test]
fn a_robot_has_arrived_where_the_links_of_the_post_hold() {
    let hard = robot().hard_length();
    let away = SERVICE_RADIUS / 2.0;
    let arrived = |parent: Option<f64>, child: f64, away: f64| {
        let mut robot = shifting(0.5, false);
        let place = east(1.0);
        robot.body.is_at(place + Vector::new(away, 0.0));
        let parent = parent.map(|length| robot.body.position() - Vector::new(length, 0.0));
        let child = robot.body.position() - Vector::new(0.0, child);
        let known = parent.map(|at| beacon(4, at, fixed(13, 14), &[13, 14]));
        known.into_iter().for_each(|beacon| robot.hears(beacon));
        robot.hears(beacon(5, child, fixed(20, 1), &[20, 1, 13, 14]));
        robot.has_arrived()
    };
    assert!(arrived(Some(hard - LITTLE), 1.0, away));
    assert!(!arrived(Some(hard + LITTLE), 1.0, away), "its parent is too far away");
    assert!(!arrived(None, 1.0, away), "its parent is not heard");
    assert!(arrived(Some(1.0), hard - LITTLE, away) && !arrived(Some(1.0), hard + LITTLE, away));
    assert!(arrived(Some(hard + LITTLE), 1.0, 0.0), "it gets no nearer");
    // The holder of the post tells of a child that the robot does not hear.
    let unheard = |length: f64| {
        let mut robot = shifting(0.5, false);
        robot.body.is_at(east(1.0 + away));
        robot.hears(beacon(4, east(0.0), fixed(13, 14), &[13, 14]));
        let branch = Branch { robot: 5, place: robot.body.position() - Vector::new(0.0, length) };
        let branches = Arc::new(vec![branch]);
        robot.hears(Beacon { branches, ..beacon(2, east(1.5), fixed(1, 13), &[1, 13, 14]) });
        robot.has_arrived()
    };
    assert!(unheard(hard - LITTLE) && !unheard(hard + LITTLE));
    // The next robot of its subgroup is on its way to the post that bears the own one.
    let behind = |away: f64| {
        let mut robot = shifting(0.0, false);
        change_path(&mut robot, |path| path.hops[1].post = fixed(1, 2));
        robot.body.is_at(east(1.0 + SERVICE_RADIUS / 2.0));
        let ahead = Duty::Shifting(Shifting { place: 1, left: None });
        let at = robot.body.position() + Vector::new(away, 0.0);
        robot.hears(Beacon { duty: Some(ahead), ..Beacon::silent(1, at) });
        robot.has_arrived()
    };
    assert!(behind(hard - LITTLE) && !behind(hard + LITTLE));
}

/// Where Σ leads over two access points the shortest way may be out of reach of both.
#[test]
fn a_recruit_goes_by_way_of_the_access_points_that_its_path_passes() {
    let (mut hall, build) = (hall(), robot().build_length());
    let place = |east: f64, north: f64| HERE + Vector::new(east, north) * build;
    let access_point = |links| AccessPoint { position: place(links, 0.0).into() };
    hall.access_point = [0.0, 1.2, 1.7].map(access_point).to_vec();
    let recruit = |crossing: &[usize], parent: NodeId, from: Point, ahead: Point| {
        let mut robot = Robot { site: robot_of(&hall).site, ..shifting(0.5, false) };
        change_path(&mut robot, |path| {
            path.hops[0].crossing = crossing.to_vec();
            path.hops[0].place = PathPlace { reference: from, position: from };
            path.hops[1].place = PathPlace { reference: ahead, position: ahead };
        });
        robot.body.is_at(from);
        robot.tree.attach_to(Some(parent));
        robot.measures();
        (robot.goal(), robot.named_parent())
    };
    let (first, second) = (ROBOTS, ROBOTS + 2);
    // Both stand at the end of their links, and the way between them is out of reach of both access points.
    let (from, ahead) = (place(0.0, 0.95), place(1.7, 0.95));
    let by_way = (Some(place(1.7, 0.0)), Some(first));
    assert_eq!(recruit(&[0, 2], first, from, ahead), by_way);
    assert_eq!(recruit(&[0], first, from, ahead).0, Some(ahead), "both are attached there");
    assert_eq!(recruit(&[0, 1, 2], first, from, ahead).0, Some(place(1.2, 0.0)));
    // The straight way is within reach.
    assert_eq!(recruit(&[0, 2], first, place(0.0, 0.1), place(1.7, 0.1)).0, Some(place(1.7, 0.1)));
    // It is attached to the last within reach, and does not go back.
    let near = recruit(&[0, 2], first, place(0.9, 0.0), ahead);
    assert_eq!(near, (Some(ahead), Some(second)));
    assert_eq!(recruit(&[0, 2], second, place(0.6, 0.0), ahead).1, Some(second));
    // It has taken the duty over beyond the second one.
    assert_eq!(recruit(&[0, 2], 3, place(2.75, 0.0), ahead).1, Some(second));
}

/// One that queues behind the next holds the post where it stands.
#[test]
fn a_post_is_held_at_its_place_by_a_robot_that_has_come_there() {
    let reference = |away: f64| {
        let mut robot = shifting(0.5, true);
        robot.body.is_at(east(1.0 - away));
        robot.measures();
        let jump = robot.jump_duty(Label::Mission(MissionStep::SubgroupArrived));
        assert!(jump.expect("its guards have values").is_some());
        robot.duty.station().expect("it holds a post").reference
    };
    let (near, far) = (SERVICE_RADIUS - LITTLE, SERVICE_RADIUS + LITTLE);
    assert_eq!((reference(near), reference(far)), (east(1.0), east(1.0 - far)));
}

/// A robot whose task is announced again goes back to the post that it left, unless the robot behind takes
/// that; one that has reported its arrival takes the post ahead if the robot there has done so, too.
#[test]
fn a_path_that_is_given_up_leaves_each_robot_a_post_of_its_own() {
    let coming = |place: usize, left: Option<u32>, reported: &[usize], arrived: usize| {
        let mut robot = shifting(0.5, false);
        robot.duty.is(Duty::Shifting(Shifting { place, left: left.map(PostId) }));
        let agreement = &mut robot.ballot;
        reported.iter().for_each(|&place| agreement.arrive(place));
        if let Mission::Shift(shift) = &**robot.mission.current() {
            robot.mission.is(Mission::Shift(Shift { arrived, ..shift.clone() }));
        }
        assert_eq!(robot.coming_post().map(|post| post.id), Some(PostId(place as u32 + 1)));
        robot.duty.jump_with(Label::Mission(MissionStep::Announced));
        let Station { post, reference } = robot.coming_station().expect("it is on its way");
        let is_back = post.id == PostId(place as u32) && post.is_fixed();
        let back = robot.mission.path().expect("it is on a path").hops[place].place.reference;
        assert!(!is_back || reference == back, "{reference} is not where its post is");
        (post.id != robot.new_post().id).then_some(post.id.0)
    };
    assert_eq!(coming(0, None, &[], 0), Some(0), "it is the recruit: nobody is behind it");
    assert_eq!(coming(0, Some(0), &[], 0), None, "the robot behind comes from another subgroup");
    assert_eq!(coming(1, Some(1), &[], 0), Some(1), "the robot behind waits for its report");
    assert_eq!(coming(1, Some(1), &[], 1), None, "its subgroup has arrived");
    assert_eq!(coming(0, None, &[0, 1], 0), Some(1));
    assert_eq!(coming(0, None, &[0], 0), None, "the robot ahead may come back");
    assert_eq!(coming(2, Some(2), &[2], 0), None, "the robot at the end has not given its post up");
    assert_eq!(coming(2, Some(2), &[2, 3], 0), Some(3), "it has left it");
}

#[test]
fn a_robot_under_way_is_attached_to_the_next_of_the_chain() {
    let mut robot = shifting(0.5, true);
    assert_eq!(robot.tree_parent(), Some(1));
    assert_eq!(robot.active_subgroup().map(|active| active.places()), Some(0..3));
    assert_eq!(robot.robots_at(robot.active_subgroup().expect("it is active")), [0, 1, 2]);
    assert!(robot.has_reported(1) && !robot.has_reported(0) && !robot.has_reported(2));
    robot.report_arrival();
    assert!(!robot.has_reported(0), "it is far from its place");
    robot.body.is_at(east(1.0));
    robot.report_arrival();
    assert!(robot.has_reported(0));
}

/// At the post itself it arrives where its links are as long as two settled robots make them; the primary team is attached
/// to the robot that it relieves.
#[test]
fn a_robot_that_has_settled_arrives_unless_a_link_is_too_long() {
    let settled = robot().settled_length();
    let arrives = |length: f64, other: Post| {
        let mut robot = shifting(0.5, true);
        robot.body.is_at(east(1.0));
        robot.hears(beacon(4, east(1.0 + length), other, &[other.id.0, 15]));
        robot.has_arrived()
    };
    assert!(arrives(settled - LITTLE, fixed(13, 14)) && !arrives(settled + LITTLE, fixed(13, 14)));
    assert!(arrives(settled - LITTLE, fixed(20, 1)) && !arrives(settled + LITTLE, fixed(20, 1)));
    assert!(arrives(settled + LITTLE, primary(20, None, 1)));
}

/// The robot at the end of the subgroup holds the post that the one before it comes to take.
#[test]
fn a_subgroup_has_arrived_when_the_robot_at_its_end_has_given_its_post_up() {
    let arrived = |places: &[usize], is_given_up: bool| {
        let mut robot = shifting(0.5, false);
        let agreement = &mut robot.ballot;
        places.iter().for_each(|&place| agreement.arrive(place));
        if is_given_up {
            agreement.give_up(3);
        }
        robot.measures();
        robot.changes.facts().subgroup_arrived
    };
    assert!(arrived(&[0, 1, 2], true));
    assert!(!arrived(&[0, 1, 2], false), "two would hold the post");
    assert!(!arrived(&[0, 2], true), "one is on its way");
}

/// From where a link is longer than errors explain, each end that moves makes it shorter by as much as its
/// move may be off.
#[test]
fn a_link_that_is_far_too_long_truly_gets_no_longer() {
    use pleach_continuous::network::acceptance::Segment;
    let far = unsure().hard_length() + 2.0 * unsure().stray();
    let accepts = |length: f64, own: f64, other: f64| {
        let mut robot = unsure();
        robot.holds(fixed(20, 13));
        robot.hears(beacon(5, west(length), fixed(13, 14), &[13, 14]));
        robot.tree.attach_to(Some(5));
        robot.negotiation.begin();
        if other > 0.0 {
            robot.hear_proposal(5, Segment { from: west(length), to: west(length - other) }, None);
        }
        let proposal = (own > 0.0).then(|| Segment { from: HERE, to: west(own) });
        robot.negotiation.intends(proposal);
        robot.judge_moves(&mut crate::node::Outputs::of(0));
        robot.negotiation.proposal() == proposal && !robot.negotiation.must_judge()
    };
    let (near, long) = (far - LITTLE, far + LITTLE);
    let (enough, short) = (MOTION_ERROR + LITTLE, MOTION_ERROR - LITTLE);
    assert!(accepts(long, enough, 0.0) && !accepts(long, short, 0.0));
    assert!(accepts(near, short, 0.0), "errors explain its length");
    assert!(accepts(long, 0.0, enough) && !accepts(long, 0.0, short));
    assert!(accepts(long, enough, enough) && !accepts(long, enough, short));
}

/// A link at its limit is not too long, whichever way its length is rounded: the robot goes on towards the other end.
#[test]
fn a_link_is_at_its_limit_in_spite_of_rounding() {
    let goes_on = |longer: f64| {
        let mut robot = unsure();
        robot.holds(primary(30, None, 13));
        let length = robot.build_length() * (1.0 + longer);
        robot.hears(beacon(5, east(length), fixed(13, 14), &[13, 14]));
        robot.remember_parent();
        let problem = robot.motion_problem(east(length));
        problem.admits(&robot.body.position())
    };
    assert!(goes_on(0.0) && goes_on(1e-15) && !goes_on(1e-6));
}

/// Where a robot may be within a disc, a sender reckons with the farthest place.
#[test]
fn a_sender_reckons_with_where_its_receiver_may_measure_itself() {
    use pleach_continuous::network::LinkReliability as _;
    use pleach_continuous::network::acceptance::Segment;
    let objects = |share: f64, move_to: f64, parked: bool| {
        let mut robot = unsure();
        robot.holds(fixed(20, 99));
        robot.hears(Beacon { parked, ..beacon(5, west(1.2), fixed(13, 14), &[13, 14]) });
        robot.survey_links();
        robot.routing.plans(&[share]);
        robot.sends(5, share * robot.routing.links()[0].reliability);
        robot.negotiation.begin();
        robot.hear_proposal(5, Segment { from: west(1.2), to: west(move_to) }, None);
        let mut outputs = crate::node::Outputs::of(0);
        robot.judge_moves(&mut outputs);
        outputs.drain_sent().count() > 0
    };
    let link = |away: f64| unsure().site.link.reliability(away);
    // The share at which the load is 1 at this distance.
    let full = |away: f64| link(away) / link(1.2);
    let stray = 2.0 * POSITION_ERROR + MOTION_ERROR;
    let farthest = 1.25 + stray;
    assert!(!objects(full(farthest) - 1e-4, 1.25, true));
    assert!(objects(full(farthest) + 1e-4, 1.25, true));
    // One that rests is where it is known to be; one that is not parked may measure itself anew.
    assert!(!objects(full(1.2) - 1e-4, 1.2, true));
    let anew = full(1.2 + 2.0 * POSITION_ERROR);
    assert!(!objects(anew - 1e-4, 1.2, false) && objects(anew + 1e-4, 1.2, false));
}

/// A link of which errors could leave too little after moves of both its ends carries nothing.
#[test]
fn links_are_as_reliable_as_errors_leave_them() {
    let is_used = |away: f64| {
        let mut robot = unsure();
        robot.hears(beacon(5, west(away), fixed(13, 14), &[13, 14]));
        robot.survey_links();
        !robot.routing.links().is_empty()
    };
    let site = Arc::clone(&unsure().site);
    let limit = site.link.distance_at(0.3) - 2.0 * (2.0 * POSITION_ERROR + MOTION_ERROR);
    assert!(is_used(limit - 1e-3) && !is_used(limit + 1e-3), "{limit}");
}
