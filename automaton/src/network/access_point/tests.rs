//! What an access point makes of the beacons that it hears.

use std::sync::Arc;

use pleach_continuous::network::acceptance::Segment;
use pleach_continuous::{Point, Vector};
use pleach_discrete::network::{NodeId, Post, PostId};
use serde_json::json;

use super::super::beacon::Beacon;
use super::super::duty::{Duty, Held, Standby, Station};
use super::super::message::Message;
use super::super::roll::{Absent, Roll, Wreck};
use super::super::scenario::Scenario;
use super::super::site::Site;
use super::AccessPoint;
use crate::node::{Input, Node as _, Outputs};

/// The first access point of a hall, which hears robots 0 and 1.
fn access_point() -> AccessPoint {
    let hall: Scenario = serde_json::from_value(json!({
        "name": "hall",
        "workspace": {"boundary": [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]},
        "link": {"full_range": 1.0, "max_range": 2.0},
        "control": {
            "clearance": 0.04, "service_radius": 0.2, "step_radius": 0.1,
            "tree_reliability": 0.1, "period": 0.5,
        },
        "access_point": [{"position": [5.0, 5.0]}],
        "robot": [{"position": [4.0, 5.0], "rate": 0.1}, {"position": [6.0, 5.0], "rate": 0.1}],
        "task": [{"position": [9.0, 9.0]}],
    }))
    .expect("it is a scenario");
    AccessPoint::new(0, Arc::new(Site::new(&hall).expect("its numbers make sense")))
}

/// What a redundant robot says at `position`.
fn beacon(robot: NodeId, position: Point) -> Beacon {
    let station = Station { post: Post::redundant(PostId(robot as u32)), reference: position };
    let duty = Duty::Standby(Standby(Held { station, left: None }));
    Beacon { duty: Some(duty), ..Beacon::silent(robot, position) }
}

/// A roll by which these robots are suspended.
fn roll(called: u32, suspended: &[NodeId]) -> Roll {
    let suspended = suspended.iter().copied().collect();
    Roll { called, absent: Arc::new(Absent { suspended, ..Absent::default() }) }
}

/// Nobody relies on the robot, and the access point is asked to know of its move.
#[test]
fn it_knows_of_the_move_of_a_robot_that_asks_it_to() {
    let asked = |from: Point, witness: usize, period: u32| {
        let mut point = access_point();
        let west = Point::new(4.0, 5.0);
        point.period = 7;
        point.hear(7, &roll(7, &[]), &Arc::new(beacon(0, west)));
        let segment = Segment { from, to: from + Vector::new(0.06, 0.0) };
        let message = Message::Proposal { period, segment, witness: Some(witness) };
        let mut outputs = Outputs::of(2);
        let heard = Input::Heard { from: 0, message: &message };
        point.step(heard, &mut outputs).expect("guards have values");
        let answers = outputs.drain_sent().count();
        point.roll.absent = roll(7, &[0]).absent;
        point.locate_wrecks();
        (answers, point.wrecks[0].astray)
    };
    let here = Point::new(4.0, 5.0);
    let (answers, astray) = asked(here, 2, 7);
    assert!(answers == 1 && (astray - 0.06).abs() < 1e-12);
    let (answers, astray) = asked(here, 1, 7);
    assert!(answers == 0 && (astray - 0.06).abs() < 1e-12, "another node is asked");
    assert_eq!(asked(here, 2, 6), (0, 0.0), "the proposal is late");
    let (answers, astray) = asked(Point::new(4.1, 5.0), 2, 7);
    assert!(answers == 1 && (astray - 0.06).abs() < 1e-12, "the beacon from there is lost");
}

/// Robots that have not heard them themselves keep away from these places.
#[test]
fn it_tells_where_robots_that_do_not_take_part_were_heard_last() {
    let mut point = access_point();
    let mut told = |period: u32, roll: &Roll, beacons: Vec<Beacon>| {
        beacons.into_iter().for_each(|beacon| point.hear(period, roll, &Arc::new(beacon)));
        point.deliberate().expect("guards have values");
        point.next_beacon().wrecks.to_vec()
    };
    let wreck = Wreck::heard;
    let (west, east) = (Point::new(4.0, 5.0), Point::new(6.0, 5.0));
    let farther = Point::new(7.0, 5.0);
    let all = roll(1, &[]);
    assert_eq!(told(1, &all, vec![beacon(0, west), beacon(1, east)]), [], "all take part");
    let without_one = roll(2, &[1]);
    assert_eq!(told(2, &without_one, vec![beacon(0, west)]), [wreck(1, east, 1)]);
    // Robot 0 has heard of a later place of robot 1, and tells it.
    let wrecks = Arc::new(vec![wreck(1, farther, 2)]);
    let heard = Beacon { wrecks, ..beacon(0, west) };
    assert_eq!(told(3, &without_one, vec![heard]), [wreck(1, farther, 2)]);
    assert_eq!(told(4, &roll(4, &[]), vec![beacon(0, west)]), [], "it takes part again");
}
