use pleach_continuous::Point;
use pleach_continuous::geometry::NamedEdge;
use pleach_continuous::geometry::{FreeSpace, Polygon, Workspace, WorkspaceError};
use proptest::prelude::*;

use super::environments::{environment, place, ring};
use super::plain;

fn square(low: f64, high: f64) -> Vec<Point> {
    ring(&[(low, low), (high, low), (high, high), (low, high)])
}

fn reversed(mut ring: Vec<Point>) -> Vec<Point> {
    ring.reverse();
    ring
}

#[test]
fn interior_lies_on_the_left_of_every_edge() {
    for boundary in [square(0.0, 10.0), reversed(square(0.0, 10.0))] {
        for hole in [square(4.0, 5.0), reversed(square(4.0, 5.0))] {
            let workspace = Workspace::new(boundary.clone(), vec![hole]).unwrap();
            for edge in workspace.edges() {
                let middle = nalgebra::center(&edge.from, &edge.to);
                assert!(workspace.contains(middle + edge.left_normal() * 0.1), "{edge:?}");
                assert!(!workspace.contains(middle - edge.left_normal() * 0.1), "{edge:?}");
            }
        }
    }
}

/// A vertex that lies on the lowest edge, at a zero with a sign; and two vertices that differ by the sign alone.
#[test]
fn the_sign_of_zero_changes_nothing() {
    let middle = ring(&[(0.0, 0.0), (2.0, -0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]);
    for boundary in [middle.clone(), reversed(middle)] {
        let workspace = Workspace::new(boundary, vec![]).unwrap();
        for edge in workspace.edges() {
            let middle = nalgebra::center(&edge.from, &edge.to);
            assert!(workspace.contains(middle + edge.left_normal() * 0.1), "{edge:?}");
        }
        assert!(FreeSpace::new(&workspace, 0.1).is_ok());
    }
    let twice = [(-4.0, 0.0), (-0.0, -2.0), (4.0, 0.0), (-0.0, 2.0), (0.0, 1.0), (-0.0, 1.0)];
    let refused = Workspace::new(ring(&twice), vec![]);
    let Err(WorkspaceError::RepeatedVertex { first: 4, second: 5, .. }) = refused else {
        panic!("{refused:?}")
    };
}

#[test]
fn clearance_of_segments() {
    let workspace = Workspace::new(square(0.0, 10.0), vec![square(4.0, 6.0)]).unwrap();
    let clearance = |a: (f64, f64), b: (f64, f64)| {
        workspace.segment_clearance(Point::new(a.0, a.1), Point::new(b.0, b.1))
    };
    assert_eq!(clearance((3.0, 1.0), (3.0, 9.0)), 1.0);
    // A slanted path past the corner (4, 6) of the hole.
    let past_the_corner = 3.5 / 0.5_f64.hypot(5.0);
    assert!((clearance((3.0, 3.0), (3.5, 8.0)) - past_the_corner).abs() < 1e-12);
    assert!(clearance((1.0, 1.0), (9.0, 9.0)) <= 0.0, "along the diagonal of the hole");
    assert!(clearance((1.0, 5.0), (5.0, 5.0)) <= 0.0, "into the hole");
    assert!(clearance((5.0, 4.5), (5.0, 5.5)) <= 0.0, "within the hole");
    assert!(clearance((1.0, 5.0), (12.0, 5.0)) <= 0.0, "out of the boundary");
}

#[test]
fn collinear_vertices_are_welcome() {
    let boundary = ring(&[(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    assert!(Workspace::new(boundary, vec![]).is_ok());
}

#[track_caller]
fn check_refused(boundary: Vec<Point>, holes: Vec<Vec<Point>>, message: &str) -> WorkspaceError {
    let error = Workspace::new(boundary, holes).expect_err("not a workspace");
    let text = error.to_string();
    assert!(text.contains(message), "{text}");
    error
}

#[test]
fn errors_name_what_is_wrong() {
    let whole = || square(0.0, 10.0);
    check_refused(ring(&[(0.0, 0.0), (1.0, 0.0)]), vec![], "the boundary has 2 vertices");
    check_refused(
        whole(),
        vec![ring(&[(1.0, 1.0), (f64::NAN, 2.0), (2.0, 1.0)])],
        "vertex 1 of hole 0",
    );
    check_refused(
        ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0)]),
        vec![],
        "vertices 0 and 3 of the boundary are both (0, 0)",
    );
    check_refused(ring(&[(0.0, 0.0), (1.0, 1.0), (3.0, 3.0)]), vec![], "on one line");
    let error = check_refused(
        ring(&[(0.0, 0.0), (2.0, 0.0), (0.0, 2.0), (2.0, 2.0)]),
        vec![],
        "edge 1 of the boundary, (2, 0) to (0, 2), meets edge 3 of the boundary, (2, 2) to (0, 0)",
    );
    assert!(matches!(
        error,
        WorkspaceError::SelfIntersecting {
            second: NamedEdge { polygon: Polygon::Boundary, index: 3, .. },
            ..
        }
    ));
    check_refused(
        ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (4.0, 1.0)]),
        vec![],
        "edge 1 of the boundary, (4, 0) to (4, 4), meets edge 2",
    );
    check_refused(
        whole(),
        vec![square(8.0, 11.0)],
        "of the boundary, (10, 0) to (10, 10), meets edge",
    );
    check_refused(whole(), vec![square(8.0, 10.0)], "holes lie strictly inside the boundary");
    check_refused(whole(), vec![square(1.0, 3.0), square(3.0, 5.0)], "meets edge");
    check_refused(
        whole(),
        vec![square(11.0, 12.0)],
        "hole 0, with a vertex at (11, 11), lies outside",
    );
    check_refused(whole(), vec![square(3.0, 4.0), square(2.0, 5.0)], "hole 0 lies inside hole 1");
}

proptest! {
    #[test]
    fn clearance_agrees_with_trying_every_edge(
        environment in environment(),
        places in prop::collection::vec(place(), 50),
    ) {
        let workspace = &environment.workspace;
        let edges = plain::edges(workspace.polygons());
        for place in places {
            let distance = plain::distance(&edges, place);
            let expected = if plain::winds_around(&edges, place) { distance } else { -distance };
            prop_assert!((workspace.clearance(place) - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn clearance_of_segments_agrees_with_trying_every_edge(
        environment in environment(),
        ends in prop::collection::vec((place(), place()), 50),
    ) {
        let workspace = &environment.workspace;
        let edges = plain::edges(workspace.polygons());
        for (a, b) in ends {
            let found = workspace.segment_clearance(a, b);
            let expected = plain::segment_distance(&edges, a, b);
            if plain::stays_inside(&edges, a, b, 0.0) {
                prop_assert!((found - expected).abs() < 1e-12, "{a} to {b}: {found} {expected}");
            } else {
                prop_assert!(found < 1e-12, "{a} to {b}: {found}");
            }
        }
    }
}
