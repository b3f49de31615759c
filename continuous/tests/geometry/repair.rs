//! Maps whose polygons touch.

use pleach_continuous::geometry::Polygon;
use pleach_continuous::geometry::{FreeSpace, Repair, Workspace, WorkspaceError};
use pleach_continuous::{Point, Vector};
use proptest::prelude::*;

use super::environments::{environment, place, ring};
use super::plain;

fn room() -> Vec<Point> {
    ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)])
}

fn square_at(x: f64, y: f64) -> Vec<Point> {
    ring(&[(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0)])
}

/// The distance to the edges of all polygons, as they were given.
fn distance_to(polygons: &[Vec<Point>], point: Point) -> f64 {
    plain::distance(&plain::edges(polygons), point)
}

/// Repairs a map; checks that its points keep their distance from its walls, and that there is a
/// free space.
fn repaired(boundary: Vec<Point>, holes: Vec<Vec<Point>>) -> (Workspace, Vec<Repair>) {
    let (workspace, repairs) = Workspace::repaired(boundary.clone(), holes.clone()).unwrap();
    let polygons: Vec<Vec<Point>> = std::iter::once(boundary).chain(holes).collect();
    let free_space = FreeSpace::new(&workspace, 0.05).unwrap();
    for step in 0..2000 {
        let share = |prime: usize| (step * prime % 1999) as f64 / 1999.0;
        let place = Point::new(4.0 * share(37), 3.0 * share(911));
        if workspace.contains(place) {
            let expected = distance_to(&polygons, place);
            assert!((workspace.clearance(place) - expected).abs() < 1e-9, "{place}");
        }
        assert!(!free_space.contains(place) || distance_to(&polygons, place) >= 0.05);
    }
    (workspace, repairs)
}

#[test]
fn a_hole_that_touches_the_boundary_is_joined() {
    let at_a_vertex = ring(&[(2.0, 3.0), (1.5, 2.0), (2.5, 2.0)]);
    let along_an_edge = ring(&[(0.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]);
    for hole in [at_a_vertex, along_an_edge] {
        assert!(Workspace::new(room(), vec![hole.clone()]).is_err());
        let (workspace, repairs) = repaired(room(), vec![hole]);
        assert!(matches!(repairs[..], [Repair::Contact { .. }, ..]), "{repairs:?}");
        assert!(repairs.iter().all(|repair| repair.to_string().contains("joined")));
        assert!(
            !workspace.contains(Point::new(2.0, 2.2)) || !workspace.contains(Point::new(0.5, 1.5))
        );
    }
}

#[test]
fn holes_that_touch_each_other_are_joined() {
    let left = ring(&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)]);
    let beside = ring(&[(2.0, 1.2), (3.0, 1.2), (3.0, 1.8), (2.0, 1.8)]);
    let at_a_corner = ring(&[(2.0, 2.0), (3.0, 2.0), (3.0, 2.5), (2.0, 2.5)]);
    for other in [beside, at_a_corner] {
        let (workspace, repairs) = repaired(room(), vec![left.clone(), other]);
        assert!(!repairs.is_empty());
        // Nothing passes between them.
        let free_space = FreeSpace::new(&workspace, 0.05).unwrap();
        let path = free_space.geodesic(Point::new(1.5, 0.5), Point::new(1.5, 2.5)).unwrap();
        assert!(path.length > 2.2, "{}", path.length);
    }
}

#[test]
fn repeated_vertices_and_spikes_out_of_the_workspace_are_left_out() {
    let mut boundary = room();
    boundary.push(boundary[0]);
    boundary.splice(2..2, ring(&[(4.0, 1.0), (5.0, 1.0), (4.0, 1.0)]));
    let (workspace, repairs) = Workspace::repaired(boundary, vec![]).unwrap();
    assert_eq!((workspace.boundary().len(), workspace.polygons().len()), (5, 1));
    let [
        Repair::RepeatedVertex { vertex: 7, .. },
        Repair::Spike { polygon: Polygon::Boundary, vertex: 3, .. },
    ] = repairs[..]
    else {
        panic!("{repairs:?}")
    };
}

/// A hole with a spike that ends within another hole, which it touches.
#[test]
fn spikes_into_other_holes_are_left_out() {
    let mut left = square_at(1.0, 1.0);
    left.splice(2..2, ring(&[(2.0, 1.5), (2.5, 1.5), (2.0, 1.5)]));
    let beside = ring(&[(2.0, 1.2), (3.0, 1.2), (3.0, 1.8), (2.0, 1.8)]);
    let (_, repairs) = repaired(room(), vec![left, beside]);
    let is_left_out =
        |repair: &Repair| matches!(repair, Repair::Spike { polygon: Polygon::Hole(0), .. });
    assert!(repairs.iter().any(is_left_out), "{repairs:?}");
}

/// A line that runs into the room and back, and a hole that is nothing but a line: robots keep off both.
#[test]
fn lines_there_and_back_are_walls() {
    let mut boundary = room();
    boundary.splice(2..2, ring(&[(4.0, 1.0), (3.5, 1.0), (3.0, 1.0), (4.0, 1.0)]));
    let line = ring(&[(1.0, 1.0), (2.0, 1.0), (1.5, 1.0)]);
    let (workspace, repairs) = repaired(boundary.clone(), vec![line]);
    let ends = |repair: &Repair| match repair {
        Repair::Wall { wall, .. } => (wall.from.x, wall.to.x),
        _ => panic!("{repair}"),
    };
    assert_eq!(repairs.iter().map(ends).collect::<Vec<_>>(), [(4.0, 3.0), (2.0, 1.0)]);
    assert!((workspace.clearance(Point::new(3.0, 1.1)) - 0.1).abs() < 1e-12);
    let (below, above) = (Point::new(3.5, 0.5), Point::new(3.5, 1.5));
    assert!(workspace.segment_clearance(below, above) <= 0.0);
    let free_space = FreeSpace::new(&workspace, 0.05).unwrap();
    let path = free_space.geodesic(below, above).unwrap();
    // Round a disc about the end it would be 1.4963; free space keeps off a polygon about the disc.
    assert!(path.length > 1.496 && path.length < 1.51, "round the end: {}", path.length);

    let beside = ring(&[(1.0, 9.0), (2.0, 9.0), (1.5, 9.0)]);
    let refused = Workspace::repaired(room(), vec![beside]);
    assert!(matches!(refused, Err(WorkspaceError::HoleOutside { hole: 0, .. })), "{refused:?}");
    let flat = ring(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.0)]);
    let refused = Workspace::repaired(flat, vec![]);
    assert!(matches!(refused, Err(WorkspaceError::Flat { .. })), "{refused:?}");
}

/// The same line, drawn in other steps, and whichever vertex of the room is listed first.
#[test]
fn a_wall_is_the_same_from_whichever_vertex_its_polygon_is_listed() {
    for steps in [&[4.0, 2.0, 3.0, 4.0][..], &[4.0, 3.0, 2.0, 4.0], &[4.0, 2.0, 3.0, 2.0, 4.0]] {
        let mut boundary = room();
        boundary.splice(2..2, steps.iter().map(|&x| Point::new(x, 1.0)));
        for first in 0..boundary.len() {
            boundary.rotate_left(1);
            let (workspace, _) = repaired(boundary.clone(), vec![]);
            assert_eq!(workspace.boundary().len(), 5, "{steps:?} from {first}");
            for x in [2.25, 2.75, 3.25, 3.75] {
                let (below, above) = (Point::new(x, 0.5), Point::new(x, 1.5));
                let clearance = workspace.segment_clearance(below, above);
                assert!(clearance <= 0.0, "{steps:?} from {first} at {x}");
            }
        }
    }
}

/// A line runs across a corner of a hole into it, and most of it lies there.
#[test]
fn what_leads_a_wall_into_a_hole_is_a_wall() {
    let mut boundary = room();
    boundary.push(Point::new(0.0, 1.5));
    boundary.extend(ring(&[(3.0, 1.5), (0.0, 1.5)]));
    let hole = ring(&[(1.0, 1.5), (2.5, 0.5), (3.5, 1.5), (2.5, 2.5)]);
    let (workspace, repairs) = repaired(boundary.clone(), vec![hole.clone()]);
    assert!(matches!(repairs[..], [Repair::Wall { .. }]), "{repairs:?}");
    let (below, above) = (Point::new(0.5, 1.0), Point::new(0.5, 2.0));
    assert!(workspace.segment_clearance(below, above) <= 0.0);
    // Along the wall of a hole, it adds nothing.
    let mut square = square_at(1.0, 1.0);
    square.splice(2..2, ring(&[(2.0, 1.5), (3.0, 1.5), (2.0, 1.5)]));
    let beside = ring(&[(2.0, 1.5), (3.0, 1.5), (3.0, 2.0), (2.0, 2.0)]);
    let (_, repairs) = repaired(room(), vec![square, beside]);
    assert!(repairs.iter().any(|repair| matches!(repair, Repair::Spike { .. })), "{repairs:?}");
}

/// Two squares that a line joins.
#[test]
fn a_line_that_joins_two_parts_of_a_hole_is_a_wall() {
    let lower = [(1.0, 1.0), (0.5, 1.0), (0.5, 0.5), (1.5, 0.5), (1.5, 1.0), (1.0, 1.0)];
    let upper = [(1.0, 2.0), (1.5, 2.0), (1.5, 2.5), (0.5, 2.5), (0.5, 2.0), (1.0, 2.0)];
    let mut hole = ring(&[lower, upper].concat());
    for first in 0..hole.len() {
        hole.rotate_left(1);
        let (workspace, repairs) = repaired(room(), vec![hole.clone()]);
        let (left, right) = (Point::new(0.75, 1.5), Point::new(1.25, 1.5));
        assert!(workspace.segment_clearance(left, right) <= 0.0, "from {first}");
        let mut walls = repairs.iter().filter(|repair| matches!(repair, Repair::Wall { .. }));
        let Some(&Repair::Wall { polygon, vertex, wall }) = walls.next() else {
            panic!("{repairs:?}")
        };
        assert_eq!((polygon, hole[vertex]), (Polygon::Hole(0), wall.to));
        assert!(walls.next().is_none(), "{repairs:?}");
    }
}

/// The boundary follows a cut to a hole, round it, and back.
#[test]
fn a_cut_that_leads_to_a_hole_is_no_wall() {
    let mut boundary = room();
    boundary.extend(ring(&[(0.0, 1.5), (1.0, 1.5), (1.0, 2.0), (2.0, 2.0), (2.0, 1.0)]));
    boundary.extend(ring(&[(1.0, 1.0), (1.0, 1.5), (0.0, 1.5)]));
    let (workspace, repairs) = Workspace::repaired(boundary, vec![]).unwrap();
    assert!(!repairs.iter().any(|repair| matches!(repair, Repair::Wall { .. })), "{repairs:?}");
    assert_eq!(workspace.segment_clearance(Point::new(0.5, 1.0), Point::new(0.5, 2.0)), 0.5);
    assert!(!workspace.contains(Point::new(1.5, 1.25)));
}

#[test]
fn pieces_that_a_wall_cuts_off_are_kept_apart() {
    let wall = ring(&[(1.0, 0.0), (1.2, 0.0), (1.2, 3.0), (1.0, 3.0)]);
    let (workspace, repairs) = repaired(room(), vec![wall]);
    let (left, right) = (Point::new(0.5, 1.0), Point::new(2.0, 1.0));
    assert!(workspace.contains(left) && workspace.contains(right));
    assert!(!workspace.contains(Point::new(1.1, 1.0)));
    let Some(Repair::PieceCutOff { area, .. }) = repairs.last() else { panic!("{repairs:?}") };
    assert!((area - 3.0).abs() < 1e-9);
    let free_space = FreeSpace::new(&workspace, 0.05).unwrap();
    assert_ne!(free_space.region(left), free_space.region(right));
    assert!(free_space.geodesic(left, right).is_none());
}

#[test]
fn a_polygon_that_touches_itself_is_taken() {
    // Two rooms that meet at a point, and a hole in the form of an hour-glass.
    let pinched = ring(&[
        (0.0, 0.0),
        (4.0, 0.0),
        (4.0, 3.0),
        (2.0, 1.5),
        (0.0, 3.0),
        (0.0, 2.0),
        (2.0, 1.5),
        (0.0, 1.0),
    ]);
    let (_, repairs) = Workspace::repaired(pinched, vec![]).unwrap();
    assert!(repairs.iter().any(|repair| matches!(repair, Repair::Pinch { .. })), "{repairs:?}");
}

#[test]
fn what_crosses_or_overlaps_stays_an_error() {
    let bow_tie = ring(&[(0.0, 0.0), (4.0, 3.0), (4.0, 0.0), (0.0, 3.0)]);
    assert!(matches!(Workspace::repaired(bow_tie, vec![]), Err(WorkspaceError::Crossing { .. })));
    let overlapping = vec![square_at(1.0, 1.0), square_at(1.5, 1.5)];
    assert!(matches!(
        Workspace::repaired(room(), overlapping),
        Err(WorkspaceError::Crossing { .. })
    ));
    assert!(Workspace::repaired(room(), vec![square_at(3.5, 1.0)]).is_err(), "half outside");
    let outside = Workspace::repaired(room(), vec![square_at(4.0, 1.0)]);
    assert!(matches!(outside, Err(WorkspaceError::Overlap { .. })), "touching: {outside:?}");
    let twice = Workspace::repaired(room(), vec![square_at(1.0, 1.0), square_at(1.0, 1.0)]);
    assert!(matches!(twice, Err(WorkspaceError::Overlap { .. })), "{twice:?}");
    assert!(Workspace::repaired(room(), vec![square_at(9.0, 9.0)]).is_err(), "outside");
    let mut infinite = room();
    infinite[0].x = f64::INFINITY;
    assert!(matches!(Workspace::repaired(infinite, vec![]), Err(WorkspaceError::NotFinite { .. })));
}

#[test]
fn what_is_wrong_besides_contact_is_told_of_the_map_as_it_was_given() {
    let mut twice = room();
    twice.insert(1, twice[0]);
    let outside = vec![ring(&[(9.0, 9.0), (10.0, 9.0), (10.0, 10.0), (9.0, 10.0)])];
    let refused = Workspace::repaired(twice.clone(), outside);
    assert!(matches!(refused, Err(WorkspaceError::HoleOutside { hole: 0, .. })), "{refused:?}");
    // A harmless contact comes before the edges that cross; vertices count as they were given.
    let crossing = vec![square_at(0.0, 1.0), square_at(2.0, 1.0), square_at(2.5, 1.5)];
    let refused = Workspace::repaired(twice.clone(), crossing);
    let Err(WorkspaceError::Crossing { first, second }) = refused else { panic!("{refused:?}") };
    assert_eq!((first.polygon, second.polygon), (Polygon::Hole(1), Polygon::Hole(2)));
    // What is left out before, a hole that is a line and a vertex, changes no name.
    let line = ring(&[(1.0, 0.3), (2.0, 0.3), (1.5, 0.3)]);
    let mut square = square_at(2.0, 1.0);
    square.insert(1, square[0]);
    let holes = vec![line, square, square_at(2.5, 1.5)];
    let refused = Workspace::repaired(room(), holes.clone());
    let Err(WorkspaceError::Crossing { first, second }) = refused else { panic!("{refused:?}") };
    for (edge, hole) in [(first, 1), (second, 2)] {
        assert_eq!(edge.polygon, Polygon::Hole(hole));
        assert_eq!(holes[hole][edge.index], edge.segment.from, "{edge}");
    }
    twice[4].y = f64::INFINITY;
    let refused = Workspace::repaired(twice, vec![]);
    assert!(matches!(refused, Err(WorkspaceError::NotFinite { vertex: 4, .. })), "{refused:?}");
}

/// Far from the origin a middle of an edge is rounded away from it, by more than the extent makes negligible.
#[test]
fn edges_of_holes_are_no_walls_far_from_the_origin() {
    let origin = Vector::new(5e6, 4e6);
    let placed = |places: &[(f64, f64)]| -> Vec<Point> {
        ring(places).into_iter().map(|place| place + origin).collect()
    };
    let outline = placed(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]);
    for turn in 0..50 {
        let lean = 0.02 * f64::from(turn);
        let hole = placed(&[(2.0, 2.0), (4.1, 2.3 + lean), (3.9, 4.7), (2.2 - lean, 3.1)]);
        let touching = placed(&[(4.1, 2.3 + lean), (6.3, 1.9), (6.1 + lean, 3.7)]);
        let (_, repairs) = Workspace::repaired(outline.clone(), vec![hole, touching]).unwrap();
        let is_wall = |repair: &Repair| matches!(repair, Repair::Wall { .. });
        assert!(!repairs.iter().any(is_wall), "{lean}: {repairs:?}");
    }
}

proptest! {
    /// What is right is left as it is; with a hole shifted onto the wall, points keep their distance.
    #[test]
    fn maps_without_contact_are_left_alone(environment in environment()) {
        let workspace = &environment.workspace;
        let (same, repairs) =
            Workspace::repaired(workspace.boundary().to_vec(), workspace.holes().to_vec()).unwrap();
        prop_assert_eq!(same.polygons(), workspace.polygons());
        prop_assert!(repairs.is_empty());
    }

    #[test]
    fn holes_in_pieces_are_the_same_workspace(environment in environment(), places in prop::collection::vec(place(), 50)) {
        // Every hole is cut in two along a diagonal: its halves share an edge.
        let workspace = &environment.workspace;
        let halves = |hole: &Vec<Point>| {
            let middle = nalgebra::center(&hole[0], &hole[1]);
            let opposite = hole.len() / 2 + 1;
            let mut one = vec![middle];
            one.extend(&hole[1..=opposite.min(hole.len() - 1)]);
            let mut other = hole[opposite.min(hole.len() - 1)..].to_vec();
            other.extend([hole[0], middle]);
            [one, other]
        };
        let holes: Vec<Vec<Point>> = workspace.holes().iter().flat_map(halves).collect();
        prop_assume!(holes.iter().all(|hole| hole.len() >= 3));
        let Ok((joined, repairs)) = Workspace::repaired(workspace.boundary().to_vec(), holes) else {
            // Halves of a hole that is not convex may cross.
            return Ok(());
        };
        prop_assert_eq!(repairs.is_empty(), workspace.holes().is_empty());
        for place in places {
            let (ours, before) = (joined.clearance(place), workspace.clearance(place));
            prop_assert!((ours - before).abs() < 1e-9, "{place}: {ours} {before}");
        }
    }
}
