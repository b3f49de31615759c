//! Which way a robot goes: round parked robots, and constant where two ways are alike.

use pleach_continuous::geometry::Geodesic;

use super::*;

/// Robot 0 on its way to a goal 2 to the east, with these robots parked.
fn mover(parked: &[Point]) -> Robot {
    let mut robot = robot();
    robot.holds(primary(30, None, 13));
    robot.advances_to(east(2.0));
    for (at, &place) in parked.iter().enumerate() {
        robot.hears(beacon(at + 1, place, redundant(11 + at as u32, 99), &[]));
    }
    robot
}

fn waypoint(robot: &mut Robot) -> Point {
    robot.first_waypoint(east(2.0)).expect("a way leads there")
}

#[test]
fn without_obstacles_it_goes_straight_on() {
    assert_eq!(waypoint(&mut mover(&[])), east(2.0));
    assert_eq!(waypoint(&mut mover(&[east(1.0) + Vector::new(0.0, 0.1)])), east(2.0));
}

/// Round a parked robot the way is tangent to the disc of 2.1ρ about it.
#[test]
fn a_parked_robot_is_gone_round_at_its_distance() {
    let mut robot = mover(&[east(1.0)]);
    let first = waypoint(&mut robot);
    assert_ne!(first, east(2.0));
    let along = (first - HERE).normalize();
    let to_centre = east(1.0) - HERE;
    let aside = (to_centre - along * to_centre.dot(&along)).norm();
    let keep_out = 2.1 * CLEARANCE;
    assert!(aside >= keep_out * (1.0 - 1e-6) && aside < keep_out * 1.1, "{aside} of {keep_out}");
    let beside = |aside: f64| mover(&[east(1.0) + Vector::new(0.0, aside)]);
    assert_eq!(waypoint(&mut beside(keep_out + LITTLE)), east(2.0));
    assert_ne!(waypoint(&mut beside(keep_out - 1e-3)), east(2.0));
}

#[test]
fn robots_that_move_are_not_gone_round() {
    let mut robot = mover(&[]);
    let moving = beacon(1, east(1.0), primary(31, Some(30), 30), &[]);
    robot.hears(Beacon { parked: false, ..moving });
    robot.hears(access_point(east(0.5)));
    assert_eq!(waypoint(&mut robot), east(2.0));
}

/// A row of parked robots across its way: round its end is shorter or longer than what a detour may cost.
#[test]
fn a_long_way_round_is_not_gone() {
    let row = |half: usize| -> Vec<Point> {
        let gap = 3.0 * CLEARANCE;
        (0..=2 * half)
            .map(|at| east(1.0) + Vector::new(0.0, (at as f64 - half as f64) * gap))
            .collect()
    };
    assert_ne!(waypoint(&mut mover(&row(1))), east(2.0));
    // The way round costs √(1 + y²) · 2 − 2, where y is where the row ends.
    let costs = |half: usize| {
        let y = half as f64 * 3.0 * CLEARANCE + 2.1 * CLEARANCE;
        2.0 * y.hypot(1.0) - 2.0
    };
    let allowance = 8.0 * CLEARANCE;
    let last =
        (1..30).take_while(|&half| costs(half) < 0.95 * allowance).last().expect("one is short");
    let first = (1..30).find(|&half| costs(half) > 1.05 * allowance).expect("one is long");
    assert_ne!(waypoint(&mut mover(&row(last))), east(2.0), "{} of {allowance}", costs(last));
    assert_eq!(waypoint(&mut mover(&row(first))), east(2.0), "{} of {allowance}", costs(first));
}

/// A waypoint of the period before is kept unless it is worse by ρ, reached, or has been of no use.
#[test]
fn a_waypoint_that_is_about_as_good_is_kept() {
    let keeps = |aside: f64, still: u32| {
        let mut robot = mover(&[]);
        let kept = east(1.0) + Vector::new(0.0, aside);
        robot.negotiation.navigation_mut().turn_to(kept);
        robot.body.waits(still);
        waypoint(&mut robot) == kept
    };
    // 2 √(1 + a²) = 2 + ρ
    let worst = ((1.0 + CLEARANCE / 2.0).powi(2) - 1.0).sqrt();
    assert!(keeps(worst - 1e-4, 0) && !keeps(worst + 1e-4, 0));
    assert!(keeps(0.01, 2) && !keeps(0.01, 3), "three periods without progress are enough");
    let near = |away: f64| {
        let mut robot = mover(&[]);
        let kept = HERE + Vector::new(0.0, away);
        robot.negotiation.navigation_mut().turn_to(kept);
        waypoint(&mut robot) == kept
    };
    assert!(near(0.1 * CLEARANCE + LITTLE) && !near(0.1 * CLEARANCE - LITTLE));
    let mut hidden = mover(&[]);
    hidden.body.is_at(Point::new(6.5, 7.5));
    let behind = Point::new(8.5, 7.5);
    hidden.negotiation.navigation_mut().turn_to(behind);
    let goal = Point::new(8.5, 7.4);
    assert_ne!(hidden.first_waypoint(goal), Some(behind), "it is behind the pillar");
}

/// The shorter way leads round the south of the pillar. Where its parent rests in the north, its link is too short for
/// that, and long enough for the way round the north.
#[test]
fn a_robot_whose_link_leads_farther_on_the_other_side_goes_there() {
    let goes_north = |parent: Point, parked: bool| {
        let mut robot = robot();
        robot.body.is_at(Point::new(6.9, 7.45));
        robot.holds(fixed(20, 13));
        robot.hears(Beacon { parked, ..beacon(1, parent, fixed(13, 14), &[13, 14]) });
        robot.remember_parent();
        let first = robot.first_waypoint(Point::new(8.1, 7.45));
        first.expect("a way leads there").y > 7.5
    };
    let (north, south) = (Point::new(7.5, 8.5), Point::new(7.5, 6.5));
    assert!(goes_north(north, true) && !goes_north(south, true));
    assert!(!goes_north(north, false), "its parent does not rest there");
}

/// Half-way round the other side of an obstacle the link to the robot that it follows is as long as by either side.
#[test]
fn a_robot_that_follows_another_goes_only_where_their_link_lasts() {
    let mut robot = robot();
    robot.holds(primary(30, Some(31), 13));
    let ahead = primary(31, None, 30);
    robot.hears(Beacon { parent: Some(0), ..beacon(1, east(1.0), ahead, &[31, 30, 13]) });
    let limit = robot.build_length();
    let way = |length: f64| Geodesic { length, waypoints: vec![east(1.0)] };
    let holds = |robot: &Robot, by: f64| robot.is_held_by_link_ahead(&way(1.0), &way(by));
    assert!(
        holds(&robot, 2.0 * limit - 1.0 + LITTLE) && !holds(&robot, 2.0 * limit - 1.0 - LITTLE)
    );
    robot.holds(primary(31, None, 13));
    assert!(!holds(&robot, 10.0 * limit), "it follows none");
}

#[test]
fn a_corner_that_is_reached_is_passed() {
    let mut robot = robot();
    robot.body.is_at(Point::new(6.95, 6.95));
    let path =
        robot.site.free_space.geodesic(robot.body.position(), Point::new(8.05, 7.5)).expect("free");
    let corner = robot.next_corner(&path).expect("it leads round the pillar");
    robot.body.is_at(corner);
    let path = robot.site.free_space.geodesic(corner, Point::new(8.05, 7.5)).expect("free");
    let next = robot.next_corner(&path).expect("it leads on");
    assert!((next - corner).norm() > LITTLE, "{next} after {corner}");
}
