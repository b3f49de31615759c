//! Plain reimplementations that try everything: slow, obvious, and independent of the library.

use std::f64::consts::PI;

use pleach_continuous::geometry::Disc;
use pleach_continuous::{Point, Vector};

/// The edges of closed rings.
pub fn edges(rings: &[Vec<Point>]) -> Vec<(Point, Point)> {
    rings
        .iter()
        .flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])))
        .collect()
}

/// Distance from a point to the nearest of some edges.
pub fn distance(edges: &[(Point, Point)], point: Point) -> f64 {
    edges
        .iter()
        .map(|&(from, to)| {
            let along = to - from;
            let t = ((point - from).dot(&along) / along.dot(&along)).clamp(0.0, 1.0);
            (from + t * along - point).norm()
        })
        .fold(f64::INFINITY, f64::min)
}

/// Distance from a segment to the nearest of some edges: 0 where they intersect, otherwise they
/// are closest at an end of one of them.
pub fn segment_distance(edges: &[(Point, Point)], a: Point, b: Point) -> f64 {
    let along = b - a;
    let of_edge = |&(from, to): &(Point, Point)| {
        let edge = to - from;
        let determinant = along.perp(&edge);
        let t = (from - a).perp(&edge) / determinant;
        let s = (from - a).perp(&along) / determinant;
        if (0.0..=1.0).contains(&t) && (0.0..=1.0).contains(&s) {
            return 0.0;
        }
        let ends = distance(&[(from, to)], a).min(distance(&[(from, to)], b));
        ends.min(distance(&[(a, b)], from)).min(distance(&[(a, b)], to))
    };
    edges.iter().map(of_edge).fold(f64::INFINITY, f64::min)
}

/// Whether the rings wind around a point (the sum of the angles under which edges are seen).
pub fn winds_around(edges: &[(Point, Point)], point: Point) -> bool {
    let total: f64 = edges
        .iter()
        .map(|&(from, to)| {
            let (u, v) = (from - point, to - point);
            u.perp(&v).atan2(u.dot(&v))
        })
        .sum();
    total.abs() > 1.0
}

/// Whether a point is inside the rings, or within `tolerance` of them.
pub fn almost_inside(edges: &[(Point, Point)], point: Point, tolerance: f64) -> bool {
    distance(edges, point) <= tolerance || winds_around(edges, point)
}

/// Whether a segment stays inside the rings, up to `tolerance`: checks the middle of every piece
/// between its intersections with the edges.
pub fn stays_inside(edges: &[(Point, Point)], a: Point, b: Point, tolerance: f64) -> bool {
    let along = b - a;
    let mut cuts = vec![0.0, 1.0];
    for &(from, to) in edges {
        let edge = to - from;
        let determinant = along.perp(&edge);
        let t = (from - a).perp(&edge) / determinant;
        let s = (from - a).perp(&along) / determinant;
        if determinant != 0.0 && (0.0..=1.0).contains(&t) && (-1e-9..=1.0 + 1e-9).contains(&s) {
            cuts.push(t);
        }
    }
    cuts.sort_by(f64::total_cmp);
    cuts.windows(2)
        .all(|pair| almost_inside(edges, a + along * ((pair[0] + pair[1]) / 2.0), tolerance))
}

/// Whether a segment keeps out of every disc, up to a millionth of the radius.
pub fn avoids(discs: &[Disc], a: Point, b: Point) -> bool {
    discs.iter().all(|disc| distance(&[(a, b)], disc.center) >= disc.radius * (1.0 - 1e-6))
}

/// Corners of the octagon about a disc, one side of which faces `from`.
pub fn octagon(disc: &Disc, from: Point) -> Vec<Point> {
    let ahead = from - disc.center;
    let outer = Disc { radius: disc.radius / (PI / 8.0).cos(), ..*disc };
    polygon(&outer, 8, ahead.y.atan2(ahead.x) + PI / 8.0)
}

/// Corners on the rim of a disc, evenly spaced.
pub fn polygon(disc: &Disc, sides: u32, first: f64) -> Vec<Point> {
    let angles = (0..sides).map(|k| first + 2.0 * PI * f64::from(k) / f64::from(sides));
    angles.map(|angle| disc.center + disc.radius * Vector::new(angle.cos(), angle.sin())).collect()
}

/// Whether a segment keeps out of the octagons about all discs, as seen from `from`, up to a millionth.
pub fn avoids_octagons(discs: &[Disc], from: Point, a: Point, b: Point) -> bool {
    discs.iter().all(|disc| {
        // The part of the segment within all eight sides of a slightly smaller octagon.
        let (mut first, mut last) = (0.0_f64, 1.0_f64);
        for (corner, next) in edges(&[octagon(disc, from)]) {
            let inwards = Vector::new(corner.y - next.y, next.x - corner.x).normalize();
            let depth = |point: Point| inwards.dot(&(point - corner)) - 1e-6 * disc.radius;
            let (from, to) = (depth(a), depth(b));
            let cut = from / (from - to);
            match (from > 0.0, to > 0.0) {
                (true, true) => {}
                (true, false) => last = last.min(cut),
                (false, true) => first = first.max(cut),
                (false, false) => last = -1.0,
            }
        }
        first >= last
    })
}

/// Length of a shortest path inside the rings, with steps that are `allowed`, over the vertices
/// of the rings and further `corners`.
pub fn shortest(
    rings: &[Vec<Point>],
    corners: &[Point],
    allowed: impl Fn(Point, Point) -> bool,
    a: Point,
    b: Point,
    tolerance: f64,
) -> f64 {
    let edges = edges(rings);
    let mut nodes = vec![a, b];
    nodes.extend(rings.iter().flatten().chain(corners));
    let mut best = vec![f64::INFINITY; nodes.len()];
    let mut open: Vec<usize> = (0..nodes.len()).collect();
    best[0] = 0.0;
    while let Some(place) = (0..open.len()).min_by(|&i, &j| best[open[i]].total_cmp(&best[open[j]]))
    {
        let at = open.swap_remove(place);
        if at == 1 || best[at].is_infinite() {
            break;
        }
        for &next in &open {
            let length = best[at] + (nodes[next] - nodes[at]).norm();
            if length < best[next]
                && allowed(nodes[at], nodes[next])
                && stays_inside(&edges, nodes[at], nodes[next], tolerance)
            {
                best[next] = length;
            }
        }
    }
    best[1]
}
