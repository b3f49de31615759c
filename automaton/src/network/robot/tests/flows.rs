//! How a robot's routing and reservation are given what the rest of it knows.

use pleach_continuous::network::LinkReliability as _;

use super::*;
use crate::network::member::NodeOutputs;

/// Robot 0 with links to the access point, 1.2 away, and to robot 5, 1.0 away.
pub(super) fn router() -> Robot {
    let mut robot = robot();
    robot.holds(Post { parent: Some(Anchor::Access(0)), ..fixed(20, 0) });
    robot.hears(beacon(5, west(1.0), fixed(13, 14), &[13, 14]));
    robot.hears(access_point(east(1.2)));
    robot.remember_parent();
    robot.survey_links();
    assert_eq!(receivers(&robot), [5, ROBOTS]);
    robot
}

fn receivers(robot: &Robot) -> Vec<NodeId> {
    robot.routing.links().iter().map(|link| link.to).collect()
}

/// As long as nothing changes, a control period begins with the links of the one before.
#[test]
fn links_are_found_anew_when_something_has_changed() {
    let mut robot = router();
    let stand = |robot: &Robot| robot.routing.has_links_of(robot.changes.revision());
    assert!(stand(&robot));
    robot.hears(beacon(4, east(1.0), fixed(14, 13), &[13, 14]));
    assert!(!stand(&robot));
    robot.survey_links();
    assert_eq!((receivers(&robot), stand(&robot)), (vec![4, 5, ROBOTS], true));
    robot.holds(Post { parent: Some(Anchor::Post(PostId(13))), ..fixed(20, 0) });
    robot.note_change();
    let survey = robot.survey();
    assert_eq!((survey.parent, stand(&robot)), (Some(5), false));
}

/// A link that is too unreliable stays for the flow that it carries, and what is held of it goes with it.
#[test]
fn a_link_in_use_stays_until_its_flow_has_ended() {
    let mut robot = router();
    robot.sends(5, 0.1);
    let away = |robot: &mut Robot, reliability: f64| {
        let place = west(robot.site.link.distance_at(reliability));
        robot.hears(beacon(5, place, fixed(13, 14), &[13, 14]));
        robot.survey_links();
        (receivers(robot).contains(&5), robot.reservation.sends_to(5))
    };
    assert_eq!(away(&mut robot, 0.2), (true, true));
    assert_eq!(away(&mut robot, 0.0), (false, false));
}

/// The flows of a control period are those of the reservation.
#[test]
fn routes_are_the_flows_in_use() {
    let mut robot = router();
    robot.routing.plans(&[0.0, 0.3]);
    robot.ask_for_flows(&mut NodeOutputs::of(0));
    robot.end_routes();
    let loads: Vec<_> = robot.routing.routes().map(|link| (link.to, link.share)).collect();
    assert_eq!(loads, [(ROBOTS, 0.3)]);
    let reliability = robot.routing.links()[1].reliability;
    assert!((robot.routing.residual() - (0.3 * reliability - 0.1)).abs() < 1e-12);
}
