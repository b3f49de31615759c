//! Robots that do not take part: where others keep off, and where one stays that may be taken for gone.

use super::*;
use crate::network::beacon::Branch;
use crate::network::roll::{Absent, Wreck};

/// Robot 1 is gone, and was heard last so far to the east.
fn beside_wreck(away: f64) -> Robot {
    let mut robot = robot();
    let gone = [1].into_iter().collect();
    robot.membership.lacks(Absent { gone, ..Absent::default() });
    robot.membership.finds(vec![Wreck::heard(1, east(away), NOW - 9)]);
    robot
}

/// A wreck may be a step from where it was heard last, and both keep ρ.
#[test]
fn a_robot_that_can_meet_a_wreck_in_a_step_keeps_to_its_side() {
    let kept = CLEARANCE * (1.0 + 1e-4);
    let radius = 2.0 * kept + STEP;
    let room = |away: f64| {
        let robot = beside_wreck(away);
        let sides: Vec<_> = robot.sides_of_wrecks().collect();
        assert!(sides.len() < 2);
        sides.first().map(|side| (side.margin(HERE), side.margin(east(0.01))))
    };
    let close = |room: Option<(f64, f64)>, expected: f64| {
        let (here, ahead) = room.expect("it is in reach");
        assert!((here - expected).abs() < 1e-9, "{here} is not {expected}");
        assert!((here - ahead - 0.01).abs() < 1e-9, "the wreck is to the east");
    };
    close(room(radius + STEP - LITTLE), STEP - LITTLE);
    close(room(radius + 0.3 * STEP), 0.3 * STEP);
    assert_eq!(room(radius + STEP + LITTLE), None, "it is farther than a step");
}

/// Nearer than that, it comes no nearer to any place where the wreck may be.
#[test]
fn a_robot_beside_a_wreck_goes_away_from_wherever_that_may_be() {
    let admits = |away: f64, place: Point| {
        let sides: Vec<_> = beside_wreck(away).sides_of_wrecks().collect();
        sides.iter().all(|side| side.margin(place) >= -1e-12)
    };
    let away = 2.0 * CLEARANCE + 0.5 * STEP;
    for (turn, far) in (0..360).flat_map(|turn| [0.2, 0.6, 1.0].map(|share| (turn, share * STEP))) {
        let angle = f64::from(turn).to_radians();
        let place = HERE + far * Vector::new(angle.cos(), angle.sin());
        if admits(away, place) {
            let (from, to) = (east(away), place);
            let may_stand = (0..360).map(|turn| {
                let angle = f64::from(turn).to_radians();
                from + STEP * Vector::new(angle.cos(), angle.sin())
            });
            for wreck in may_stand.filter(|wreck| (wreck - HERE).norm() >= 2.0 * CLEARANCE) {
                assert!(
                    (wreck - to).norm() >= (wreck - HERE).norm(),
                    "{place} is nearer to {wreck}"
                );
            }
        }
    }
    assert!(admits(away, HERE) && admits(away, west(STEP)));
    assert!(!admits(away, north(STEP)), "it may be to the north-east");
    assert!(admits(0.0, HERE) && !admits(0.0, west(LITTLE)), "it may be on any side");
}

/// It may be as far off as the move leads of which it told, and a step farther if that was forgotten; two
/// steps, if another robot has stopped that could have known more.
#[test]
fn how_far_a_wreck_may_be_from_where_it_was_heard() {
    let radius = |astray: f64, other: Option<f64>| {
        let mut robot = beside_wreck(0.6);
        let known = robot.membership.wrecks()[0];
        let other = other.map(|away| Wreck::heard(2, east(0.6 + away), NOW - 9));
        let wrecks = [Wreck { astray, ..known }].into_iter().chain(other);
        robot.membership.finds(wrecks.collect());
        robot.keep_out_discs(0.0).next().expect("it is in the way").radius
    };
    let close = |one: f64, other: f64| assert!((one - other).abs() < 1e-12, "{one} is not {other}");
    close(radius(0.0, None), STEP);
    close(radius(0.3 * STEP, None), 1.3 * STEP);
    close(radius(STEP, None), 2.0 * STEP);
    let earshot = 2.0 + 3.0 * STEP + CLEARANCE;
    close(radius(0.0, Some(earshot - LITTLE)), 2.0 * STEP);
    close(radius(0.0, Some(earshot + LITTLE)), STEP);
    let mut suspended = beside_wreck(0.6);
    let robots = [1].into_iter().collect();
    suspended.membership.lacks(Absent { suspended: robots, ..Absent::default() });
    let disc = suspended.keep_out_discs(0.0).next().expect("it is in the way");
    close(disc.radius, 2.0 * STEP);
}

/// The only robot that hears another one tells where that is, and is remembered to have told so.
#[test]
fn where_branches_are_is_known_two_links_away() {
    let mut bearer = robot();
    bearer.holds(fixed(20, 99));
    let child = Beacon { parent: Some(0), ..beacon(3, east(1.5), redundant(23, 20), &[]) };
    bearer.hears(child);
    bearer.hears(beacon(4, west(0.5), redundant(24, 99), &[]));
    bearer.locate_branches();
    assert_eq!(**bearer.tree.branches(), [Branch { robot: 3, place: east(1.5) }]);
    let told = Arc::clone(bearer.tree.branches());
    bearer.schedule.is_in(bearer.schedule.period() + 2);
    bearer.locate_branches();
    assert!(bearer.tree.branches().is_empty(), "it does not hear it any more");
    let mut robot = robot();
    let told = Beacon { branches: told, ..beacon(5, east(0.5), fixed(20, 99), &[]) };
    robot.hears(told);
    let gone = [3, 5].into_iter().collect();
    robot.membership.lacks(Absent { gone, ..Absent::default() });
    robot.neighbours = Neighbours::default();
    robot.locate_wrecks();
    let start = robot.site.start_of(5).expect("there is such a robot");
    let (branch, unheard) = (Wreck::heard(3, east(1.5), NOW - 2), Wreck::heard(5, start, 0));
    // Where branches are may be old news: perhaps from before their last move.
    assert_eq!(**robot.membership.wrecks(), [branch, unheard]);
}

#[test]
fn a_wreck_that_is_heard_is_a_robot_like_any_other() {
    let mut robot = beside_wreck(0.2);
    assert_eq!(robot.keep_out_discs(CLEARANCE).count(), 1);
    robot.hears(beacon(1, east(0.3), redundant(11, 12), &[]));
    assert_eq!(robot.keep_out_discs(CLEARANCE).count(), 0);
    robot.schedule.is_in(robot.schedule.period() + 1);
    assert_eq!(robot.keep_out_discs(CLEARANCE).count(), 1);
}

/// Others allow for two steps from each place where it has been since its roll was called.
#[test]
fn a_robot_that_an_error_has_led_too_far_stays() {
    let may_move = |gone: f64| {
        let mut robot = robot();
        robot.membership.is_called_in(NOW);
        robot.membership.set_off(NOW, HERE);
        robot.membership.set_off(NOW, west(gone));
        robot.may_leave_place()
    };
    assert!(may_move(2.0 * STEP) && !may_move(2.0 * STEP + LITTLE));
}

/// Numbers of posts that robots begin with are small.
#[test]
fn new_posts_are_none_that_a_robot_begins_with() {
    for bit in 0..32 {
        let mut robot = robot();
        robot.schedule.is_in(1 << bit);
        assert!(robot.new_post().id.0 >= 1 << 31, "in control period {}", robot.schedule.period());
    }
}
