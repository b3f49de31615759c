//! What a robot senses, and what observers see of it.

use super::*;
use crate::network::member::Sense;
use crate::node::{Input, Node, Observed, Outputs};

#[test]
fn a_robot_that_finds_itself_elsewhere_measures_its_links_anew() {
    let mut robot = robot();
    robot.body.waits(7);
    robot.hears(beacon(1, east(0.5), redundant(11, 13), &[]));
    let sensed = Input::Sensed(Sense::Position(west(0.25)));
    robot.step(sensed, &mut Outputs::of(0)).expect("it goes on");
    assert_eq!(
        (robot.body(), robot.body.is_moving(), robot.body.still_periods()),
        (west(0.25), false, 0)
    );
    let distance = robot.neighbour(1).expect("it is heard").distance;
    assert!((distance - 0.75).abs() < 1e-12);
}

#[test]
fn a_fix_is_taken_as_it_is_measured() {
    let mut robot = robot();
    robot.body.is_moving_by(Vector::new(0.1, 0.0));
    robot.step(Input::Sensed(Sense::Fix(east(0.01))), &mut Outputs::of(0)).expect("it goes on");
    assert_eq!(robot.body(), east(0.01));
}

#[test]
fn observers_see_a_robot_as_it_is() {
    let mut robot = robot();
    let view = robot.view();
    assert_eq!((view.id(), view.position(), view.residual()), (0, HERE, 0.0));
    assert_eq!((view.epoch(), view.current_task()), (0, None));
    assert!(view.is_parked() && !view.is_active() && !view.leads());
    assert_eq!((view.goal(), view.tree_parent(), view.subgroups_done()), (None, None, 0));
    assert!(view.tree_links().is_empty() && view.active_subgroup().is_none());
    robot.hears(beacon(5, west(0.5), fixed(13, 14), &[13, 14]));
    robot.holds(primary(30, None, 13));
    robot.advances_to(east(3.0));
    robot.mission.is_of_epoch(2);
    robot.routing.leaves(0.5);
    robot.measures();
    let view = robot.view();
    assert_eq!((view.epoch(), view.current_task()), (2, Some(0)));
    assert!(!view.is_parked() && view.is_active() && view.leads());
    assert_eq!((view.goal(), view.tree_parent()), (Some(east(3.0)), Some(5)));
    assert_eq!((view.tree_links().len(), view.residual()), (1, 0.5));
    assert_eq!(view.audible().collect::<Vec<_>>(), [(5, 0)]);
    assert_eq!(view.beacons().map(|it| it.sender).collect::<Vec<_>>(), [5]);
    assert!(view.facts().first && view.facts().distance == 3.0);
    let path = Arc::new(Path { hops: Vec::new(), releases_leader: false });
    let shift = Shift { path, subgroups: Arc::default(), arrived: 2 };
    robot.mission.is(Mission::Shift(shift));
    assert_eq!(robot.view().subgroups_done(), 2);
}
