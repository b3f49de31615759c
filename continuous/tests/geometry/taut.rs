use pleach_continuous::Point;
use pleach_continuous::geometry::{FreeSpace, Workspace};
use proptest::prelude::*;

use super::environments::{CLEARANCE, environment, place, ring, space_round_hole};

/// The way from `a` over `c` to `b`, without its start.
fn over(space: &FreeSpace, a: Point, c: Point, b: Point) -> Option<(Vec<Point>, f64)> {
    let (first, second) = (space.geodesic(a, c)?, space.geodesic(c, b)?);
    let waypoints = [first.waypoints, second.waypoints].concat();
    Some((waypoints, first.length + second.length))
}

/// Round a square of side 1.25 in the middle of a room, on the side that is asked for.
#[test]
fn a_path_stays_on_its_side_of_a_hole() {
    let space = space_round_hole();
    let (from, to) = (Point::new(0.5, 1.2), Point::new(2.5, 1.2));
    let [below, above] = [0.2, 2.8].map(|y| {
        let corners = [(0.2, y), (2.8, y)].map(|(x, y)| Point::new(x, y));
        space.taut(from, &[&corners[..], &[to]].concat()).length
    });
    let round = |y: f64| 1.25 + 2.0 * (0.875_f64 - 0.5).hypot(y - 1.2);
    assert!((below - round(0.875)).abs() < 1e-4, "{below}");
    assert!((above - round(2.125)).abs() < 1e-4, "{above}");
    assert!((below - space.distance(from, to)).abs() < 1e-9);
}

/// However large coordinates are.
#[test]
fn a_path_stays_on_its_side_of_a_large_hole() {
    let scale = 60.0_f64.exp2();
    let square = |low: f64, high: f64| -> Vec<Point> {
        let corners = [(low, low), (high, low), (high, high), (low, high)];
        corners.map(|(x, y)| Point::new(x, y) * scale).to_vec()
    };
    let workspace = Workspace::new(square(0.0, 3.0), vec![square(1.0, 2.0)]).unwrap();
    let space = FreeSpace::new(&workspace, 0.125 * scale).unwrap();
    let [from, corner, other, to] =
        [(0.5, 1.2), (0.2, 0.2), (2.8, 0.2), (2.5, 1.2)].map(|(x, y)| Point::new(x, y) * scale);
    let taut = space.taut(from, &[corner, other, to]).length;
    assert!((taut / space.distance(from, to) - 1.0).abs() < 1e-9, "{}", taut / scale);
}

/// There and back on the same side is no way at all.
#[test]
fn a_way_there_and_back_comes_to_nothing() {
    let space = space_round_hole();
    let (from, to) = (Point::new(0.5, 0.5), Point::new(2.6, 2.4));
    let (waypoints, _) = over(&space, from, to, from).unwrap();
    assert!(space.taut(from, &waypoints).length < 1e-9);
}

#[test]
fn a_place_that_comes_twice_is_told_once() {
    let space = space_round_hole();
    let (from, to) = (Point::new(0.5, 0.5), Point::new(0.5, 1.5));
    assert_eq!(space.taut(from, &[from, to, to, to]).waypoints, [to]);
}

/// There and back from the corner of one hole straight towards that of the other.
#[test]
fn a_way_there_and_back_in_line_with_corners_comes_to_nothing() {
    let boundary = ring(&[(0.0, 0.0), (3.0, 0.0), (3.0, 4.0), (0.0, 4.0)]);
    let square = |y| ring(&[(1.0, y), (2.0, y), (2.0, y + 1.0), (1.0, y + 1.0)]);
    let workspace = Workspace::new(boundary, vec![square(0.5), square(2.5)]).unwrap();
    let space = FreeSpace::new(&workspace, 0.125).unwrap();
    let (from, to) = (Point::new(0.5, 0.25), Point::new(0.5, 2.0));
    let corner = Point::new(0.875, 1.625);
    let beyond = corner + (Point::new(0.875, 2.375) - corner) * 0.25;
    let taut = space.taut(from, &[corner, beyond, corner, to]);
    assert!((taut.length - (to - from).norm()).abs() < 1e-9, "{taut:?}");
}

/// Along the edges of two holes in line, and back to beyond where it began.
#[test]
fn a_way_back_along_an_edge_comes_to_nothing() {
    let boundary = ring(&[(0.0, 0.0), (1.9, 0.0), (1.9, 1.3), (0.0, 1.3)]);
    let hole = |left: f64, right: f64| {
        ring(&[(left, 0.74506), (right, 0.74506), (right, 0.77506), (left, 0.77506)])
    };
    let holes = vec![hole(0.93061, 1.25443), hole(1.37785, 1.48869)];
    let space = FreeSpace::new(&Workspace::new(boundary, holes).unwrap(), 0.01).unwrap();
    let (end, to) = (Point::new(1.52, 0.84), Point::new(1.147_341_98, 0.735_058_1));
    for x in [1.267_848_1, 1.277_848_1] {
        let from = Point::new(x, 0.735_058_1);
        let corners = [space.geodesic(from, end), space.geodesic(end, to)];
        let corners = corners.map(|way| way.unwrap().waypoints);
        for way in [corners.concat(), vec![Point::new(1.498_691_9, 0.735_058_1), to]] {
            let taut = space.taut(from, &way);
            assert!((taut.length - space.distance(from, to)).abs() < 1e-6, "{taut:?}");
        }
    }
}

proptest! {
    /// Without holes there is one way only, and a path over any place is the shortest once it is taut.
    #[test]
    fn without_holes_a_taut_path_is_the_shortest(
        environment in environment(), a in place(), b in place(), c in place(),
    ) {
        let boundary = environment.workspace.boundary().to_vec();
        let space = FreeSpace::new(&Workspace::new(boundary, vec![]).unwrap(), CLEARANCE).unwrap();
        prop_assume!([a, b, c].iter().all(|&place| space.contains(place)));
        let Some((waypoints, _)) = over(&space, a, c, b) else { return Ok(()) };
        let (taut, shortest) = (space.taut(a, &waypoints).length, space.distance(a, b));
        prop_assert!((taut - shortest).abs() < 1e-4, "{taut} {shortest}");
    }

    /// With holes it is at least as long as the shortest and at most as long as the path that is pulled,
    /// and its pieces lie in the free space.
    #[test]
    fn a_taut_path_is_free(
        environment in environment(), a in place(), b in place(), c in place(),
    ) {
        let space = &environment.free_space;
        prop_assume!([a, b, c].iter().all(|&place| space.contains(place)));
        let Some((waypoints, length)) = over(space, a, c, b) else { return Ok(()) };
        let taut = space.taut(a, &waypoints);
        prop_assert!(taut.length >= space.distance(a, b) - 1e-6 && taut.length <= length + 1e-9);
        for piece in taut.segments(a) {
            prop_assert!(space.sees(piece.from, piece.to), "{piece:?}");
        }
    }
}
