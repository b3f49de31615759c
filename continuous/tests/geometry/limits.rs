//! Absurd numbers: errors and answers, no overflow and no panic.

use pleach_continuous::Point;
use pleach_continuous::geometry::{
    Disc, FreeSpace, Segment, Workspace, convex_region, voronoi_half_planes,
};
use proptest::prelude::*;

use super::environments::{environment, place, ring};

fn absurd() -> impl Strategy<Value = f64> {
    prop_oneof![
        prop::sample::select(vec![
            1e19,
            -1e19,
            9e18,
            1e100,
            -1e100,
            1e154,
            1e200,
            -1e300,
            f64::MAX,
            f64::MIN,
            5e-324,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            -0.0,
        ]),
        -2.0..3.0_f64,
    ]
}

fn absurd_point() -> impl Strategy<Value = Point> {
    (absurd(), absurd()).prop_map(|(x, y)| Point::new(x, y))
}

proptest! {
    #[test]
    fn workspaces_of_absurd_numbers_are_refused_or_work(
        boundary in prop::collection::vec(absurd_point(), 3..6),
        hole in prop::collection::vec(absurd_point(), 3..5),
        clearance in absurd(),
        at in absurd_point(),
    ) {
        for holes in [vec![], vec![hole]] {
            let Ok((workspace, _)) = Workspace::repaired(boundary.clone(), holes) else { continue };
            let Ok(free_space) = FreeSpace::new(&workspace, clearance) else { continue };
            let nearest = free_space.nearest(at);
            let _ = free_space.geodesic(nearest, boundary[0]);
            let _ = convex_region(&free_space, nearest, at, clearance);
        }
    }

    #[test]
    fn absurd_places_are_in_no_free_space(
        environment in environment(), at in absurd_point(), other in place(), radius in absurd(),
    ) {
        let space = &environment.free_space;
        let other = space.nearest(other);
        let disc = Disc { center: at, radius };
        let _ = space.detour(other, environment.free_space.nearest(at), &[disc]);
        let _ = convex_region(space, at, other, radius);
        let _ = convex_region(space, other, at, radius);
        let _ = voronoi_half_planes(at, &[other, at], radius);
        let _ = environment.workspace.clearance(at) + environment.workspace.segment_clearance(other, at);
        let _ = Segment::new(at, other).distance_to(&Segment::still(at));
        if space.entry(at).is_none() {
            prop_assert_eq!(space.geodesic(at, other), None);
            prop_assert_eq!(space.distance_to(other, &space.destination(at)), f64::INFINITY);
            prop_assert!(!space.sees(at, other) && !space.sees(other, at));
        }
        if at.iter().all(|coordinate| !coordinate.is_nan()) {
            prop_assert!(space.contains(space.nearest(at)));
        }
    }
}

#[test]
fn tolerances_and_clearances_have_ranges() {
    let square = ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    let workspace = Workspace::new(square, vec![]).unwrap();
    for fraction in [0.0, 1e-13, 0.01, -1.0, f64::NAN] {
        assert!(FreeSpace::with_tolerance(&workspace, 0.1, fraction).is_err());
    }
    assert!(FreeSpace::with_tolerance(&workspace, 0.1, 1e-12).is_ok());
    assert!(FreeSpace::new(&workspace, f64::INFINITY).is_err());
    assert!(FreeSpace::new(&workspace, 1e300).is_err());
}

#[test]
fn what_is_no_place_has_no_nearest_one() {
    let square = ring(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    let workspace = Workspace::new(square, vec![]).unwrap();
    let space = FreeSpace::new(&workspace, 0.1).unwrap();
    let (nowhere, inside) = (Point::new(f64::NAN, 0.5), Point::new(0.5, 0.5));
    assert!(space.nearest(nowhere).x.is_nan());
    assert_eq!(space.nearest_reached(inside, nowhere), None);
    assert_eq!(workspace.clearance(nowhere), f64::NEG_INFINITY);
}
