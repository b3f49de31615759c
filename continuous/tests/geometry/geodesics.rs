use pleach_continuous::geometry::{Disc, FreeSpace, Geodesic, Segment, Workspace};
use pleach_continuous::{Point, Vector};
use proptest::prelude::*;
use std::f64::consts::PI;

use super::environments::{CLEARANCE, environment, place, ring, space_round_hole};
use super::plain;

#[test]
fn diagonals_of_a_hole_are_blocked() {
    let free_space = space_round_hole();
    for (a, b) in [((0.25, 0.25), (2.75, 2.75)), ((0.25, 2.75), (2.75, 0.25))] {
        let (a, b) = (Point::new(a.0, a.1), Point::new(b.0, b.1));
        assert!(!free_space.sees(a, b) && !free_space.sees(b, a));
        let path = free_space.geodesic(a, b).unwrap();
        let expected = 2.0 * (1.875_f64 - 0.25 + 0.25).hypot(0.625);
        assert!((path.length - expected).abs() < 1e-5, "{} {expected}", path.length);
    }
}

#[test]
fn corners_and_edges_of_the_outline_see_what_they_should() {
    let free_space = space_round_hole();
    for ring in free_space.outline() {
        for (index, &from) in ring.iter().enumerate() {
            let to = ring[(index + 1) % ring.len()];
            assert!(free_space.sees(from, to) && free_space.sees(to, from));
            assert!(free_space.sees(nalgebra::center(&from, &to), to));
            assert!(free_space.sees(from, from));
        }
        let (one, opposite) = (ring[0], ring[2]);
        assert!(!free_space.sees(one, opposite), "across the hole");
    }
}

#[test]
fn robot_at_a_corner_is_sent_on() {
    let free_space = space_round_hole();
    let goal = Point::new(2.75, 2.75);
    let destination = free_space.destination(goal);
    let mut at = Point::new(0.25, 0.25);
    let mut left = free_space.distance(at, goal);
    for _ in 0..2 {
        let path = free_space.geodesic_to(at, &destination).unwrap();
        assert_eq!(Some(path.clone()), free_space.geodesic(at, goal));
        let next = path.waypoints[0];
        assert!((next - at).norm() > 0.5, "progress");
        left -= (next - at).norm();
        assert!((free_space.distance(next, goal) - left).abs() < 1e-9);
        at = next;
    }
    assert_eq!(at, goal);
    assert_eq!(free_space.geodesic(goal, goal).unwrap().length, 0.0);
}

/// Points on the way between places on both sides of a hole, each with how far along it is.
fn ways_round_hole() -> Vec<(Point, Geodesic, Vec<Point>)> {
    let free_space = space_round_hole();
    let places: Vec<Point> = (0..36)
        .map(|it| Point::new(0.25 + 0.5 * f64::from(it % 6), 0.25 + 0.5 * f64::from(it / 6)))
        .collect();
    let pairs = places.iter().flat_map(|&from| places.iter().map(move |&to| (from, to)));
    let ways = pairs.filter_map(|(from, to)| {
        let way = free_space.geodesic(from, to)?;
        let points = way
            .segments(from)
            .flat_map(|piece| (0..=200).map(move |step| piece.at(f64::from(step) / 200.0)));
        let points = points.collect();
        Some((from, way, points))
    });
    ways.collect()
}

#[test]
fn a_link_reaches_every_point_of_its_way_from_both_ends() {
    for (from, way, points) in ways_round_hole() {
        let to = *way.waypoints.last().unwrap();
        let farthest = |of: &dyn Fn(f64, f64) -> f64| {
            let at = points.iter().map(|at| of((at - from).norm(), (at - to).norm()));
            at.fold(0.0, f64::max)
        };
        let (reach, gap) = (farthest(&f64::max), farthest(&f64::min));
        assert!((way.reach(from) - reach).abs() < 1e-9, "{} {reach}", way.reach(from));
        let spacing = way.length / 200.0;
        assert!((0.0..=spacing).contains(&(way.gap(from) - gap)), "{} {gap}", way.gap(from));
        assert!((from - to).norm() <= reach + 1e-9 && reach <= way.length + 1e-9 && gap <= reach);
    }
    // Between two rooms that are joined at the top, 1.5 above these places.
    let room = [
        (0.0, 0.0),
        (1.9, 0.0),
        (1.9, 2.0),
        (2.1, 2.0),
        (2.1, 0.0),
        (4.0, 0.0),
        (4.0, 3.0),
        (0.0, 3.0),
    ];
    let room = room.map(|(x, y)| Point::new(x, y)).to_vec();
    let rooms = FreeSpace::new(&Workspace::new(room, vec![]).unwrap(), 0.1).unwrap();
    let (left, right) = (Point::new(1.5, 0.5), Point::new(2.5, 0.5));
    let reach = rooms.link_reach(left, right);
    assert!((1.5..2.0).contains(&reach), "{reach} is the distance to the corners");
}

/// Each link ends where the way leaves the disc around its beginning, or within the rest of the end.
#[test]
fn links_along_a_way_are_as_long_as_they_may_be() {
    let way = |corners: &[(f64, f64)]| {
        let free = FreeSpace::new(
            &Workspace::new(
                [(0.0, 0.0), (9.0, 0.0), (9.0, 9.0), (0.0, 9.0)]
                    .map(|(x, y)| Point::new(x, y))
                    .to_vec(),
                vec![],
            )
            .unwrap(),
            0.1,
        )
        .unwrap();
        let [from, to] = [corners[0], corners[1]].map(|(x, y)| Point::new(x, y));
        (from, free.geodesic(from, to).unwrap())
    };
    let (from, straight) = way(&[(1.0, 1.0), (5.0, 1.0)]);
    let links = |longest: f64, rest: f64| straight.links(from, longest, rest);
    assert_eq!([links(4.0, 0.0), links(3.9, 0.0), links(3.9, 0.2), links(1.0, 0.0)], [1, 2, 1, 4]);
    assert_eq!((links(1.0, 4.0), links(1.0, 5.0)), (0, 0), "the rest covers it");
    for (from, way, points) in ways_round_hole() {
        let to = *way.waypoints.last().unwrap();
        // Oracle: the last of the sampled points before the first one outside of the disc.
        let (mut at, mut count) = (0, 0);
        while at + 1 < points.len() && (points[at] - to).norm() > 0.0 && count < 100 {
            let start = points[at];
            let outside = (at..points.len()).find(|&it| (points[it] - start).norm() > 0.8);
            at = outside.map_or(points.len() - 1, |it| it - 1);
            count += 1;
        }
        let links = way.links(from, 0.8, 0.0);
        assert!(links <= count && count <= links + 1, "{links} {count}");
    }
}

#[test]
fn outside_there_is_no_path() {
    let free_space = space_round_hole();
    let (inside, hole) = (Point::new(0.5, 0.5), Point::new(1.5, 1.5));
    assert!(!free_space.sees(inside, hole) && !free_space.sees(hole, hole));
    assert_eq!(free_space.geodesic(inside, hole), None);
    assert_eq!(free_space.geodesic(hole, inside), None);
    assert_eq!(free_space.distance_to(inside, &free_space.destination(hole)), f64::INFINITY);
}

fn turned(angle: f64) -> Vector {
    Vector::new(angle.cos(), angle.sin())
}

#[test]
fn detour_follows_an_octagon() {
    let boundary = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)]);
    let free_space = FreeSpace::new(&Workspace::new(boundary, vec![]).unwrap(), 0.1).unwrap();
    let (from, to) = (Point::new(1.0, 1.0), Point::new(3.0, 1.0));
    let disc = |x: f64, y: f64, radius: f64| Disc { center: Point::new(x, y), radius };

    let around = free_space.detour(from, to, &[disc(2.0, 1.0, 0.4)]).unwrap();
    let corner = (0.4 * (std::f64::consts::PI / 8.0).tan(), 0.4);
    let expected = 2.0 * (1.0 - corner.0).hypot(corner.1) + 2.0 * corner.0;
    assert!((around.length - expected).abs() < 1e-9, "{} {expected}", around.length);

    let straight = free_space.geodesic(from, to);
    let harmless = [disc(2.0, 1.5, 0.4), disc(3.2, 1.0, 0.3)];
    assert_eq!(
        free_space.detour(from, to, &harmless),
        straight,
        "beside the path, around the goal"
    );
    assert!(free_space.detour(from, to, &[disc(0.9, 1.0, 0.4)]).is_some(), "around the start");
    assert!(free_space.detour(from, to, &[disc(1.0, 1.0, 0.4)]).is_some(), "at the start");

    // From the rim of a disc a way begins on the side on which the goal lies, wherever on the rim that is.
    let round = disc(2.0, 1.0, 0.4);
    for number in 0..64 {
        let angle = std::f64::consts::TAU * f64::from(number) / 64.0;
        let from = round.center + round.radius * turned(angle);
        for goal in [1.2, -1.2].map(|turn| round.center + 0.45 * turned(angle + turn)) {
            let way = free_space.detour(from, goal, &[round]).unwrap();
            let step = way.waypoints[0] - from;
            assert!(step.dot(&(goal - from)) > 0.0, "from {from} to {goal} by {:?}", way.waypoints);
        }
    }

    let wall = [disc(2.0, 0.4, 0.4), disc(2.0, 1.0, 0.4), disc(2.0, 1.6, 0.4)];
    assert_eq!(free_space.detour(from, to, &wall), None, "nothing leads through");
}

/// Sides of polygons that are hardly larger than a disc.
const FINE: u32 = 24;
/// An octagon about a disc is longer than its rim by less than this factor.
const OVER_OCTAGONS: f64 = 1.06;

/// The discs, larger by a factor.
fn larger(discs: &[Disc], factor: f64) -> Vec<Disc> {
    discs.iter().map(|disc| Disc { radius: factor * disc.radius, ..*disc }).collect()
}

/// Outside the bend of a corridor, where the circle about the octagon meets two walls.
#[test]
fn detours_lead_through_narrow_gaps_in_bends() {
    let turn = 0.1_f64;
    let outer = |x: f64| 1.0 - (x - 4.0).abs() * turn;
    let boundary =
        ring(&[(0.0, 0.0), (8.0, 0.0), (8.0, outer(8.0)), (4.0, 1.0), (0.0, outer(0.0))]);
    let bend = FreeSpace::new(&Workspace::new(boundary, vec![]).unwrap(), 0.1).unwrap();
    // The free space ends at y = 0.9 at its corner, nearly.
    let disc = |radius: f64| Disc { center: Point::new(4.0, 0.4), radius };
    let (from, to) = (Point::new(2.5, 0.4), Point::new(5.5, 0.4));
    for gap in [0.02, 0.01, 0.004] {
        let nearest = 0.6 / turn.hypot(1.0) - 0.1;
        let way = bend.detour(from, to, &[disc(nearest - gap)]);
        assert!(way.is_some_and(|way| way.length < 4.0), "{gap}");
    }
    assert_eq!(bend.detour(from, to, &[disc(0.51)]), None);
}

/// Between a disc and a wall, and between two discs, where octagons about them close the gap.
#[test]
fn detours_lead_through_narrow_gaps() {
    let boundary = ring(&[(0.0, 0.0), (9.0, 0.0), (9.0, 1.0), (0.0, 1.0)]);
    let corridor = FreeSpace::new(&Workspace::new(boundary, vec![]).unwrap(), 0.1).unwrap();
    let disc = |y: f64, radius: f64| Disc { center: Point::new(4.0, y), radius };
    let to = Point::new(8.0, 0.5);
    for from in [Point::new(1.0, 0.5), Point::new(3.4, 0.2), Point::new(3.6, 0.8)] {
        let length = |discs: &[Disc]| corridor.detour(from, to, discs).map(|way| way.length);
        let straight = (to - from).norm();
        for gap in [[disc(0.4, 0.49)].as_slice(), &[disc(0.2, 0.29), disc(0.8, 0.29)]] {
            assert!(length(gap).is_some_and(|length| length < straight + 0.6), "{from} {gap:?}");
        }
        for wall in [[disc(0.4, 0.51)].as_slice(), &[disc(0.2, 0.31), disc(0.8, 0.31)]] {
            assert_eq!(length(wall), None, "{from} {wall:?}");
        }
    }
}

/// The smaller disc reaches into where the circles about both octagons meet.
#[test]
fn detours_lead_through_narrow_gaps_between_discs_of_two_sizes() {
    let boundary = ring(&[(0.0, -1.6), (40.0, -1.6), (40.0, 1.6), (0.0, 1.6)]);
    let corridor = FreeSpace::new(&Workspace::new(boundary, vec![]).unwrap(), 0.1).unwrap();
    let (from, to) = (Point::new(3.0, 0.1), Point::new(37.0, 0.2));
    for gap in [0.02, 0.01, 0.005, -0.001] {
        let below = Disc { center: Point::new(20.0, -0.95), radius: 1.1 };
        let center = below.center + Vector::new(0.3_f64.sin(), 0.3_f64.cos()) * (2.0 + gap);
        let discs = [Disc { center, radius: 0.9 }, below];
        assert_eq!(corridor.detour(from, to, &discs).is_some(), gap > 0.0, "{gap}");
    }
}

proptest! {
    #[test]
    fn geodesics_are_shortest(environment in environment(), a in place(), b in place()) {
        let free_space = &environment.free_space;
        let (a, b) = (free_space.nearest(a), free_space.nearest(b));
        let tolerance = free_space.tolerance();
        let expected = plain::shortest(free_space.outline(), &[], |_, _| true, a, b, tolerance / 4.0);
        let found = free_space.distance(a, b);
        prop_assert!(found == expected || (found - expected).abs() < 40.0 * tolerance, "{found} {expected}");
        let back = free_space.distance(b, a);
        prop_assert!(found == back || (found - back).abs() < 1e-9, "{found} {back}");
        let told = free_space.distance_to(a, &free_space.destination(b));
        prop_assert!(found == told || (found - told).abs() < 4.0 * tolerance, "{found} {told}");
    }

    /// Without a clearance, among the vertices of the workspace itself.
    #[test]
    fn geodesics_are_exact_to_a_billionth(environment in environment(), a in place(), b in place()) {
        let workspace = &environment.workspace;
        let space = FreeSpace::with_tolerance(workspace, 0.0, 1e-12).unwrap();
        let (a, b) = (space.nearest(a), space.nearest(b));
        let expected = plain::shortest(workspace.polygons(), &[], |_, _| true, a, b, 1e-11);
        let found = space.distance(a, b);
        prop_assert!(found == expected || (found - expected).abs() < 1e-9, "{found} {expected}");
        let told = space.distance_to(a, &space.destination(b));
        prop_assert!(told == expected || (told - expected).abs() < 1e-9, "{told} {expected}");
    }

    #[test]
    fn geodesics_keep_the_clearance(environment in environment(), a in place(), b in place()) {
        let free_space = &environment.free_space;
        let (a, b) = (free_space.nearest(a), free_space.nearest(b));
        let edges = plain::edges(environment.workspace.polygons());
        let Some(path) = free_space.geodesic(a, b) else { return Ok(()) };
        prop_assert_eq!(path.waypoints.last(), Some(&b));
        let mut total = 0.0;
        for Segment { from, to } in path.segments(a) {
            total += (to - from).norm();
            for step in 0..=100 {
                let point = from + (to - from) * (f64::from(step) / 100.0);
                prop_assert!(plain::winds_around(&edges, point));
                prop_assert!(plain::distance(&edges, point) >= CLEARANCE);
            }
        }
        prop_assert!((total - path.length).abs() < 1e-12);
    }

    #[test]
    fn detours_are_shortest_around_discs(
        environment in environment(),
        a in place(),
        b in place(),
        centers in prop::collection::vec(place(), 0..8),
        radius in 1.0..6.0,
    ) {
        let free_space = &environment.free_space;
        let tolerance = free_space.tolerance();
        let (a, b) = (free_space.nearest(a), free_space.nearest(b));
        let discs: Vec<Disc> = centers
            .into_iter()
            .map(|center| Disc { center: free_space.nearest(center), radius: radius * CLEARANCE })
            .filter(|disc| !disc.contains(a) && !disc.contains(b))
            .collect();
        let shortest = |corners: &[Point], allowed: &dyn Fn(Point, Point) -> bool| {
            plain::shortest(free_space.outline(), corners, allowed, a, b, tolerance / 4.0)
        };
        // No shorter than a way that bends at many places of slightly smaller discs.
        let smaller = larger(&discs, (PI / f64::from(FINE)).cos());
        let bends: Vec<Point> =
            discs.iter().flat_map(|disc| plain::polygon(disc, FINE, 0.0)).collect();
        let lower = shortest(&bends, &|from, to| plain::avoids(&smaller, from, to));
        // No longer than one around the octagons, and there is one wherever slightly larger discs leave a gap.
        let octagons: Vec<Point> = discs.iter().flat_map(|disc| plain::octagon(disc, a)).collect();
        let upper = shortest(&octagons, &|from, to| plain::avoids_octagons(&discs, a, from, to));
        let obstacles = larger(&discs, 1.01);
        let rims = larger(&obstacles, 1.0 / (PI / f64::from(FINE)).cos());
        let bends: Vec<Point> =
            rims.iter().flat_map(|disc| plain::polygon(disc, FINE, 0.0)).collect();
        let through_gaps = shortest(&bends, &|from, to| plain::avoids(&obstacles, from, to));
        let length = free_space.detour(a, b, &discs).map_or(f64::INFINITY, |path| path.length);
        let rounding = 40.0 * tolerance;
        prop_assert!(0.995 * lower - rounding <= length, "{length} {lower}");
        prop_assert!(length <= upper + rounding, "{length} {upper}");
        // Ends beside a disc lie within its octagon, and ways begin and end at a corner of it.
        let ends = 0.5 * radius * CLEARANCE;
        prop_assert!(length <= OVER_OCTAGONS * through_gaps + ends, "{length} {through_gaps}");
    }

    #[test]
    fn detours_keep_out_of_discs(
        environment in environment(),
        a in place(),
        b in place(),
        centers in prop::collection::vec(place(), 0..12),
    ) {
        let free_space = &environment.free_space;
        let (a, b) = (free_space.nearest(a), free_space.nearest(b));
        let radius = 2.1 * CLEARANCE;
        let discs: Vec<Disc> = centers.into_iter().chain([a]).map(|center| Disc { center, radius }).collect();
        let Some(path) = free_space.detour(a, b, &discs) else { return Ok(()) };
        let edges = plain::edges(environment.workspace.polygons());
        for Segment { from, to } in path.segments(a) {
            for step in 0..=50 {
                let point = from + (to - from) * (f64::from(step) / 50.0);
                prop_assert!(plain::distance(&edges, point) >= CLEARANCE);
            }
            for disc in discs.iter().filter(|disc| !disc.contains(b)) {
                let radius = disc.radius.min((a - disc.center).norm() * (1.0 - 1e-9));
                let outside = plain::avoids(&[Disc { radius, ..*disc }], from, to);
                prop_assert!(outside, "{from} to {to} enters {disc:?}");
            }
        }
    }
}
