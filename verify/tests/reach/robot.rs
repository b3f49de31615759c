//! A robot's motion in its cell: what flows enclose agrees with what the certificates say.

use std::ops::ControlFlow;

use pleach_continuous::Point;
use pleach_continuous::geometry::{
    FreeSpace, HalfPlane, Segment, Workspace, convex_region, voronoi_half_planes,
};
use pleach_continuous::network::acceptance::worst_separation;
use pleach_verify::network::cell::{CellMotion, CellMotionError};
use pleach_verify::reach::{Answer, Completion, Effort, Model, Settings, Visit, prove, verify};

const PERIOD: f64 = 0.5;
const STEP_RADIUS: f64 = 0.25;
const CLEARANCE: f64 = 0.1;

fn settings() -> Settings {
    Settings { horizon: 1.0, step: 0.05, ..Settings::default() }
}

/// A robot near the lower wall of a room, on its way past another one.
fn cell(error: f64) -> (Point, Point, Vec<HalfPlane>) {
    let room = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)].map(|(x, y)| Point::new(x, y));
    let workspace = Workspace::new(room.to_vec(), vec![]).unwrap();
    let kept = CLEARANCE + error;
    let space = FreeSpace::new(&workspace, kept).unwrap();
    let (robot, other) = (Point::new(1.0, 0.2), Point::new(1.3, 0.3));
    let mut cell = voronoi_half_planes(robot, &[other], kept);
    cell.extend(convex_region(&space, robot, Point::new(3.0, 0.2), STEP_RADIUS));
    (robot, other, cell)
}

/// The half-planes, each moved outwards by a distance.
fn widened(cell: &[HalfPlane], by: f64) -> Vec<HalfPlane> {
    cell.iter().map(|plane| HalfPlane { offset: plane.offset + by, ..*plane }).collect()
}

/// Whatever it proposes, the robot itself stays within its cell widened by its error; and that is all
/// there is to say, for it comes as near to the boundary as one likes.
#[test]
fn every_proposal_stays_in_the_cell_up_to_the_error() {
    for error in [0.0, 0.01, 0.03] {
        let (robot, _, cell) = cell(error);
        assert_eq!(cell.len(), 2);
        let motion = CellMotion::new(robot, &cell, PERIOD, STEP_RADIUS, error).unwrap();
        // The polygons around discs have their sides' middles on the circle, and their corners 2 %
        // beyond it.
        let corner = error / (std::f64::consts::PI / 16.0).cos() + 1e-9;
        let ask = |slack: f64, settings: &Settings| {
            let beyond = CellMotion::beyond(&cell, slack);
            let starts = [motion.start.clone()];
            verify(&motion.automaton, &[], &starts, &beyond, settings, &Effort::default()).unwrap()
        };
        let Answer::Holds(proof) = ask(corner, &settings()) else { panic!("it leaves its cell") };
        assert_eq!(proof.enclosure.ending, Completion::Horizon);
        assert!(proof.clearances.iter().all(|room| (0.0..0.03 * error + 1e-6).contains(room)));
        assert!(matches!(ask(0.5 * error - 1e-3, &settings()), Answer::Violated(_)));
    }
}

/// Two robots in cells made for their errors are 2ρ apart, whatever both propose.
#[test]
fn two_robots_keep_apart_as_their_certificate_says() {
    let error = 0.02;
    let (robot, other, cell) = cell(error);
    let mine = &cell[..1];
    let theirs = voronoi_half_planes(other, &[robot], CLEARANCE + error);
    let apart = theirs[0].normal;
    // The farthest that either comes towards the other.
    let farthest = |place: Point, cell: &[HalfPlane]| {
        let motion = CellMotion::new(place, cell, PERIOD, STEP_RADIUS, error).unwrap();
        let model = Model::of(&motion.automaton).unwrap();
        let border = CellMotion::beyond(&widened(cell, 0.0), 0.0);
        let go_on = &mut |_| ControlFlow::Continue(());
        let proof = prove(&model, &[motion.start], &border, &settings(), go_on).unwrap();
        cell[0].offset - proof.clearances[0]
    };
    let distance = -farthest(robot, mine) - farthest(other, &theirs);
    assert!(mine[0].normal.dot(&apart) < -1.0 + 1e-12);
    let corner = error * (1.0 / (std::f64::consts::PI / 16.0).cos() - 1.0);
    assert!(distance >= 2.0 * CLEARANCE - 2.0 * corner - 1e-9, "{distance}");
    assert!(distance <= 2.0 * CLEARANCE + 1e-9, "{distance}");
}

/// The distance to a node that stands: the enclosure reaches as far as the certificate of links says.
#[test]
fn links_are_as_long_as_their_certificate_says() {
    let (robot, station) = (Point::new(1.0, 0.2), Point::new(1.0, 1.2));
    let (end, error) = (Point::new(0.9, 0.05), 0.02);
    // One proposal: the half-planes around the point that is proposed.
    let plane =
        |x: f64, y: f64| HalfPlane::through(end, pleach_continuous::Vector::new(x, y)).unwrap();
    let only = [plane(1.0, 0.0), plane(-1.0, 0.0), plane(0.0, 1.0), plane(0.0, -1.0)];
    let motion = CellMotion::new(robot, &only, PERIOD, STEP_RADIUS, error).unwrap();
    let away = plane(end.x - station.x, end.y - station.y);
    let model = Model::of(&motion.automaton).unwrap();
    let beyond = CellMotion::beyond(&[away], 0.0);
    let go_on = &mut |_| ControlFlow::Continue(());
    let proof = prove(&model, &[motion.start], &beyond, &settings(), go_on).unwrap();
    let reached = (end - station).norm() - proof.clearances[0];
    let certified = worst_separation(Segment { from: robot, to: end }, Segment::still(station));
    let certified = certified + error;
    assert!(
        reached >= certified - 1e-9 && reached <= certified + 0.03 * error,
        "{reached} {certified}"
    );
    let moving: Vec<&Visit> =
        proof.enclosure.visits.iter().filter(|visit| visit.location == 0).collect();
    assert_eq!(moving.len(), 1);
}

#[test]
fn what_makes_no_sense_is_told() {
    let (robot, _, cell) = cell(0.0);
    let error = CellMotion::new(robot, &cell, 0.0, 0.1, 0.0).unwrap_err();
    assert_eq!(error.to_string(), "the period is 0, and has to be a duration above 0");
    let error = CellMotion::new(robot, &widened(&cell, -9.0), 1.0, 0.1, 0.0).unwrap_err();
    assert_eq!(error, CellMotionError::Empty);
}
