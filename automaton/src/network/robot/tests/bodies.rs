//! Robots of other fleets: which side a robot keeps to, and which way it goes.

use super::*;

/// Robot 0 on its way to a goal 2 to the east, which has seen these bodies for as many control periods.
fn mover(bodies: &[Point], periods: usize) -> Robot {
    let mut robot = robot();
    robot.holds(primary(30, None, 13));
    robot.advances_to(east(2.0));
    (0..periods).for_each(|_| robot.see_bodies(bodies));
    robot
}

fn waypoint(robot: &mut Robot) -> Point {
    robot.first_waypoint(east(2.0)).expect("a way leads there")
}

/// A robot and a body 2.5ρ apart: each may go up to ρ from the middle.
#[test]
fn a_robot_keeps_to_its_own_side_of_a_body() {
    let distance = 2.5 * CLEARANCE;
    let farthest = |bodies: &[Point]| {
        let problem = mover(bodies, 1).motion_problem(east(2.0));
        (0..=1_000)
            .map(|part| STEP * f64::from(part) / 1e3)
            .filter(|&way| problem.admits(&east(way)))
            .fold(0.0, f64::max)
    };
    let room = distance / 2.0 - CLEARANCE;
    let way = farthest(&[east(distance)]);
    assert!((way - room).abs() < 2e-4, "{way} of {room}");
    assert!((farthest(&[]) - STEP).abs() < 1e-9);
    assert!((farthest(&[east(-distance)]) - STEP).abs() < 1e-9, "it is behind");
}

/// A body closer than 2ρ: the robot may stay, and come no nearer.
#[test]
fn a_robot_beside_a_body_may_stay() {
    let problem = mover(&[east(1.9 * CLEARANCE)], 1).motion_problem(east(2.0));
    assert!(problem.admits(&HERE) && !problem.admits(&east(LITTLE * 100.0)));
}

#[test]
fn a_body_is_gone_round_when_it_rests() {
    let body = [east(1.0)];
    assert_eq!(waypoint(&mut mover(&body, 3)), east(2.0), "it may move on");
    let first = waypoint(&mut mover(&body, 4));
    let along = (first - HERE).normalize();
    let to_centre = east(1.0) - HERE;
    let aside = (to_centre - along * to_centre.dot(&along)).norm();
    let keep_out = 2.0 * CLEARANCE;
    assert!(aside >= keep_out * (1.0 - 1e-6) && aside < keep_out * 1.1, "{aside} of {keep_out}");
    let mut moving = mover(&body, 4);
    moving.see_bodies(&[east(1.0 + STEP)]);
    assert_eq!(waypoint(&mut moving), east(2.0));
}

/// No exchange of duties leads past a body: the way round a row of them is gone however long it is.
#[test]
fn bodies_are_gone_round_however_long_the_way_is() {
    let row: Vec<Point> = (-12..=12)
        .map(|at| east(1.0) + Vector::new(0.0, 3.0 * CLEARANCE * f64::from(at)))
        .collect();
    let first = waypoint(&mut mover(&row, 4));
    assert!((first.y - HERE.y).abs() > 36.0 * CLEARANCE, "{first}");
    let gap: Vec<Point> = [-2.2, 2.2].map(|at| east(1.0) + Vector::new(0.0, at * CLEARANCE)).into();
    assert_eq!(waypoint(&mut mover(&gap, 4)), east(2.0), "it can just pass between them");
}
