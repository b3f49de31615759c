use pleach_continuous::Point;
use pleach_continuous::geometry::{FreeSpace, FreeSpaceError, Workspace};
use proptest::prelude::*;

use super::environments::{CLEARANCE, environment, place, ring};
use super::plain;

/// How far a cap with a single corner reaches, in clearances: 1 / cos 50°.
const MITRE_REACH: f64 = 1.556;

/// A room of 4 by 2 with a thin wall that leaves a door of width 0.5 at the top.
fn room_with_door() -> Workspace {
    Workspace::new(
        ring(&[
            (0.0, 0.0),
            (1.9, 0.0),
            (1.9, 1.5),
            (2.1, 1.5),
            (2.1, 0.0),
            (4.0, 0.0),
            (4.0, 2.0),
            (0.0, 2.0),
        ]),
        vec![],
    )
    .unwrap()
}

#[test]
fn rectangle_shrinks_to_a_rectangle() {
    let workspace =
        Workspace::new(ring(&[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)]), vec![]).unwrap();
    let free_space = FreeSpace::new(&workspace, 0.25).unwrap();
    let [outline] = free_space.outline() else { panic!("one ring") };
    assert_eq!(outline.len(), 4);
    let slack = free_space.tolerance();
    for vertex in outline {
        assert!((vertex.x - 1.0).abs() - (0.75 - slack) < 1e-12);
        assert!((vertex.y - 0.5).abs() - (0.25 - slack) < 1e-12);
    }
}

#[test]
fn square_corners_keep_one_corner() {
    let free_space = FreeSpace::new(&room_with_door(), 0.1).unwrap();
    assert_eq!(free_space.outline()[0].len(), 8);
}

#[test]
fn narrow_door_separates_regions() {
    let free_space = FreeSpace::new(&room_with_door(), 0.26).unwrap();
    let (left, right) = (Point::new(1.0, 1.0), Point::new(3.0, 1.0));
    assert_eq!(free_space.outline().len(), 2);
    assert!(free_space.region(left).is_some() && free_space.region(right).is_some());
    assert_ne!(free_space.region(left), free_space.region(right));
    assert_eq!(free_space.region(Point::new(2.0, 1.75)), None);
    assert_eq!(free_space.distance(left, right), f64::INFINITY);
    assert_eq!(free_space.geodesic(left, right), None);
    let destination = free_space.destination(right);
    assert_eq!(free_space.geodesic_to(left, &destination), None);
}

#[test]
fn no_room_is_an_error() {
    let workspace = room_with_door();
    let error = FreeSpace::new(&workspace, 1.0).unwrap_err();
    assert_eq!(error, FreeSpaceError::Empty { clearance: 1.0, extent: 4.0 });
    assert!(matches!(
        FreeSpace::new(&workspace, -1.0),
        Err(FreeSpaceError::InvalidClearance { .. })
    ));
    assert!(matches!(
        FreeSpace::new(&workspace, f64::NAN),
        Err(FreeSpaceError::InvalidClearance { .. })
    ));
}

#[test]
fn rounding_beyond_the_tolerance_is_an_error() {
    let far = 1e10;
    let square = ring(&[(far, far), (far + 1.0, far), (far + 1.0, far + 1.0), (far, far + 1.0)]);
    let workspace = Workspace::new(square, vec![]).unwrap();
    assert!(matches!(FreeSpace::new(&workspace, 0.1), Err(FreeSpaceError::Uncertified { .. })));
}

#[test]
fn needles_get_caps() {
    // Flat but for rounding: whether its tips turn right or left is decided exactly.
    let needle = ring(&[(2.1, 0.4), (2.2, 0.30000000000000004), (2.3000000000000003, 0.2)]);
    let boundary = ring(&[(0.0, 0.0), (2.8, 0.0), (2.8, 1.6), (0.0, 1.6)]);
    let workspace = Workspace::new(boundary, vec![needle]).unwrap();
    for clearance in [0.0, 0.01, 0.03] {
        let free_space = FreeSpace::new(&workspace, clearance).unwrap();
        let beyond_the_tip = Point::new(2.1 - 0.7 * clearance, 0.4 + 0.7 * clearance);
        assert!(!free_space.contains(beyond_the_tip));
    }
}

#[test]
fn scale_does_not_matter() {
    for scale in [1e-90, 1e-9, 1e9, 1e90] {
        let l = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
        let corners = l.map(|(x, y)| (x * scale, y * scale));
        let workspace = Workspace::new(ring(&corners), vec![]).unwrap();
        let free_space = FreeSpace::new(&workspace, 0.25 * scale).unwrap();
        let (a, b) = (Point::new(1.5, 0.5) * scale, Point::new(0.5, 1.5) * scale);
        assert!((free_space.distance(a, b) / scale - 2.0 * 0.75_f64.hypot(0.25)).abs() < 1e-5);
    }
}

#[test]
fn zero_clearance_is_almost_the_workspace() {
    let workspace = room_with_door();
    let free_space = FreeSpace::new(&workspace, 0.0).unwrap();
    for &vertex in workspace.boundary() {
        assert!((free_space.nearest(vertex) - vertex).norm() < 2.0 * free_space.tolerance());
    }
}

proptest! {
    #[test]
    fn free_space_is_where_the_clearance_is_kept(
        environment in environment(),
        places in prop::collection::vec(place(), 200),
    ) {
        let free_space = &environment.free_space;
        let edges = plain::edges(environment.workspace.polygons());
        let corners: Vec<Point> = environment.workspace.polygons().concat();
        for place in places {
            let clearance = plain::distance(&edges, place);
            let inside = plain::winds_around(&edges, place) && clearance >= CLEARANCE;
            if free_space.contains(place) {
                prop_assert!(inside, "{place} has clearance {clearance}");
            }
            // Away from corners, nothing is lost but the tolerance.
            let kept = CLEARANCE + free_space.tolerance();
            let from_corners = corners.iter().map(|corner| (corner - place).norm()).fold(f64::INFINITY, f64::min);
            if inside && clearance > kept && from_corners > MITRE_REACH * kept {
                prop_assert!(free_space.contains(place), "{place} has clearance {clearance}");
            }
        }
    }

    #[test]
    fn nearest_is_inside_and_nearest(environment in environment(), place in place()) {
        let free_space = &environment.free_space;
        let nearest = free_space.nearest(place);
        prop_assert!(free_space.contains(nearest));
        let outline = plain::edges(free_space.outline());
        if plain::winds_around(&outline, place) {
            prop_assert_eq!(nearest, place);
        } else {
            prop_assert!(((nearest - place).norm() - plain::distance(&outline, place)).abs() < 1e-12);
        }
    }
}
