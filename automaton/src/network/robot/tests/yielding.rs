//! When a robot asks for way, and where a parked one steps aside.

use super::*;
use crate::network::beacon::TeamReport;

/// A mover west of robot 0 that wants to go past it to the east.
fn asking(away: f64) -> Beacon {
    let mover = beacon(1, west(away), primary(30, None, 13), &[30, 13]);
    Beacon { way: Some(east(3.0)), ..mover }
}

fn posted() -> Robot {
    let mut robot = robot();
    robot.holds(fixed(20, 13));
    robot
}

#[test]
fn a_mover_asks_for_way_when_it_has_been_stuck_for_long() {
    let mut mover = robot();
    mover.holds(primary(30, None, 13));
    mover.advances_to(east(3.0));
    mover.negotiation.navigation_mut().turn_to(east(3.0));
    for (periods, asks) in [(0, false), (15, false), (16, true), (17, true)] {
        mover.body.waits(periods);
        assert_eq!(mover.way_asked_for().is_some(), asks, "{periods}");
    }
    mover.negotiation.navigation_mut().stop();
    assert_eq!(mover.way_asked_for(), None, "it wants to go nowhere");
    let mut parked = posted();
    parked.negotiation.navigation_mut().turn_to(east(0.1));
    parked.body.waits(20);
    assert_eq!(parked.way_asked_for(), None, "it stands where it should");
    parked.hears(asking(0.1));
    assert_eq!(parked.way_asked_for(), Some(east(0.1)), "it steps aside and cannot");
}

#[test]
fn a_robot_clears_the_stretch_ahead_of_a_mover() {
    let passing = 2.2 * CLEARANCE;
    for (aside, clears) in [(0.0, true), (passing - LITTLE, true), (passing + LITTLE, false)] {
        let mut robot = posted();
        let mover = Beacon {
            way: Some(east(3.0) + Vector::new(0.0, aside)),
            position: west(0.1) + Vector::new(0.0, aside),
            ..asking(0.1)
        };
        robot.hears(mover);
        assert_eq!(robot.way_to_clear().is_some(), clears, "{aside}");
    }
    // Four clearances ahead, and those beside the end of that.
    let reach = 4.0 * CLEARANCE + passing;
    for (away, clears) in [(reach - LITTLE, true), (reach + LITTLE, false)] {
        let mut robot = posted();
        robot.hears(asking(away));
        assert_eq!(robot.way_to_clear().is_some(), clears, "{away}");
    }
    // A target nearer than that is where the way ends.
    for (ahead, clears) in [(passing - LITTLE, true), (passing + LITTLE, false)] {
        let mut robot = posted();
        robot.hears(Beacon { way: Some(west(ahead)), ..asking(ahead + 0.02) });
        assert_eq!(robot.way_to_clear().is_some(), clears, "{ahead}");
    }
    let mut robot = posted();
    robot.hears(Beacon { way: None, ..asking(0.1) });
    assert_eq!(robot.way_to_clear(), None, "it does not ask");
}

/// It stands in a bend, say, in which the leader has to turn round.
#[test]
fn a_member_of_the_team_makes_way_for_those_ahead_of_it() {
    let steps_aside = |own: u32, other: u32, way: Point| {
        let mut robot = robot();
        robot.holds(primary(31, Some(30), 13));
        let report = |members: u32| Some(TeamReport { members, ..team::report(20, None, None) });
        robot.mission.team_mut().review(report(own));
        robot.hears(Beacon { way: Some(way), team: report(other), ..asking(2.05 * CLEARANCE) });
        robot.place_aside().is_some_and(|place| (place - HERE).norm() <= 3.0 * CLEARANCE)
    };
    assert!(steps_aside(2, 1, east(3.0)));
    assert!(!steps_aside(2, 1, west(3.0)), "it goes away from here");
    assert!(!steps_aside(1, 2, east(3.0)), "it is behind");
}

#[test]
fn it_steps_aside_as_far_as_it_takes_and_no_farther_than_its_leash() {
    let mut robot = posted();
    robot.hears(asking(0.1));
    let place = robot.place_aside().expect("there is room beside the way");
    let aside = (place - HERE).y.abs();
    assert!(aside > 2.0 * CLEARANCE, "{place}: two paces straight aside are not far enough");
    let paces = (place - HERE).norm() / CLEARANCE;
    assert!((paces - 2.5).abs() < 1e-9, "{paces}");
    assert!((place - HERE).norm() <= robot.site.settings.leash_radius());
    // Where the leash ends two clearances to the north and south it goes as far as that.
    let mut short = posted();
    short.body.is_at(north(SERVICE_RADIUS - 2.0 * CLEARANCE));
    short.hears(Beacon {
        way: Some(short.body.position() + Vector::new(3.0, 0.0)),
        position: short.body.position() - Vector::new(0.1, 0.0),
        ..asking(0.1)
    });
    let place = short.place_aside().expect("it may go south");
    assert!((place - HERE).norm() <= SERVICE_RADIUS + LITTLE, "{place}");
    assert!(place.y < short.body.position().y, "{place}");
}

/// Between two walls that end north of it, where a mover comes from the south: the places behind the walls are within
/// the leash, and the ways to them are not.
#[test]
fn the_whole_way_aside_is_on_the_leash() {
    let place_aside = |north_of_post: f64| {
        let mut scenario = hall();
        let end = HERE.y + north_of_post + CLEARANCE;
        let wall = |from: f64, to: f64| {
            let [from, to] = [from, to].map(|aside| HERE.x + aside * CLEARANCE);
            vec![[from, 4.0], [to, 4.0], [to, end], [from, end]]
        };
        scenario.workspace.holes = vec![wall(-1.3, -1.2), wall(1.2, 1.3)];
        let mut robot = robot_of(&scenario);
        robot.holds(fixed(20, 13));
        robot.body.is_at(north(north_of_post));
        let [position, way] = [-2.1, 4.0].map(|ahead| north(north_of_post + ahead * CLEARANCE));
        robot.hears(Beacon { position, way: Some(way), ..asking(0.1) });
        robot.place_aside()
    };
    let behind_a_wall = |place: Point| (place - HERE).x.abs() > 1.3 * CLEARANCE;
    assert!(place_aside(0.0).is_some_and(behind_a_wall));
    assert!(!place_aside(SERVICE_RADIUS - 0.5 * CLEARANCE).is_some_and(behind_a_wall));
}

/// Along a wall, and as far south as its leash allows, a robot steps aside to the north alone: not past a mover
/// that comes from there.
#[test]
fn it_does_not_pass_the_mover() {
    let steps_aside = |from_north: f64| {
        let mut robot = posted();
        robot.body.is_at(Point::new(CLEARANCE + 1e-3, 5.0));
        robot.holds(fixed(20, 13));
        let south = Vector::new(0.0, 0.1 * CLEARANCE - SERVICE_RADIUS);
        robot.body.is_at(robot.body.position() + south);
        let mover = robot.body.position() + Vector::new(2.0, from_north) * CLEARANCE;
        let way = Some(mover - Vector::new(0.0, from_north.signum()) * CLEARANCE);
        robot.hears(Beacon { position: mover, way, ..asking(0.1) });
        robot.place_aside().is_some()
    };
    assert!(steps_aside(-0.8) && !steps_aside(0.8));
}

#[test]
fn a_robot_at_a_wall_steps_to_the_free_side() {
    let mut robot = posted();
    robot.body.is_at(Point::new(5.0, 0.05));
    robot.holds(fixed(20, 13));
    let at = robot.body.position();
    robot.hears(Beacon {
        position: at - Vector::new(0.1, 0.0),
        way: Some(at + Vector::new(3.0, 0.0)),
        ..asking(0.1)
    });
    let place = robot.place_aside().expect("there is room to the north");
    assert!(place.y > at.y + 2.0 * CLEARANCE, "{place}");
}

#[test]
fn a_robot_beside_the_way_stays_where_no_place_is_better() {
    let mut robot = posted();
    let aside = 2.2 * CLEARANCE - 0.05 * CLEARANCE;
    let position = west(0.1) + Vector::new(0.0, aside);
    robot.hears(Beacon { way: Some(east(3.0) + Vector::new(0.0, aside)), position, ..asking(0.1) });
    assert!(robot.way_to_clear().is_some());
    assert_eq!(robot.place_aside(), None, "less than a tenth of ρ would be won");
}

#[test]
fn nobody_settles_beside_a_mover_that_gets_on() {
    let courtesy = 4.0 * CLEARANCE;
    let moving = |away: f64| Beacon { way: None, ..asking(away) };
    let near = |beacon: Beacon| {
        let mut robot = posted();
        robot.hears(beacon);
        robot.is_near_mover()
    };
    assert!(near(moving(courtesy - LITTLE)) && !near(moving(courtesy + LITTLE)));
    assert!(!near(asking(0.1)), "it may be waiting for just that");
    assert!(!near(Beacon { parked: true, ..moving(0.1) }));
    assert!(!near(access_point(east(0.1))));
}

/// A robot that has asked for the way aside tells that it does not want it any more, though it has not moved.
#[test]
fn who_gives_up_stepping_aside_asks_for_no_way() {
    let mut robot = robot();
    robot.holds(redundant(20, 13));
    robot.hears(beacon(2, Point::new(5.0, 4.4), fixed(13, 12), &[13, 12]));
    robot.hears(asking(0.1));
    robot.negotiation.navigation_mut().turn_to(east(0.1));
    robot.body.waits(20);
    // The way of the mover now leads by at such a distance that no place beside is better.
    let shift = Vector::new(0.0, 2.15 * CLEARANCE);
    let way = Some(east(3.0) + shift);
    robot.hears(Beacon { way, position: west(0.1) + shift, ..asking(0.1) });
    robot.process_messages().expect("guards have values");
    robot.jump().expect("guards have values");
    robot.neighbours.iter_mut().for_each(|known| known.heard_in = NOW);
    robot.neighbours.note_round(Some(NOW));
    assert!(robot.next_beacon().way.is_some());
    robot.changes.settle();
    robot.propose().expect("guards have values");
    robot.set_off();
    robot.restart_clock();
    robot.begin_period().expect("guards have values");
    assert_eq!(robot.next_beacon().way, None);
}
