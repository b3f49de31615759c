//! Plain reimplementations that try everything: slow, obvious, and independent of the library.

use pleach_continuous::Point;

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

/// Length of a shortest path inside the rings by the visibility graph of all vertices.
pub fn shortest(rings: &[Vec<Point>], a: Point, b: Point, tolerance: f64) -> f64 {
    let edges = edges(rings);
    let mut nodes = vec![a, b];
    nodes.extend(rings.iter().flatten());
    let count = nodes.len();
    let mut best = vec![f64::INFINITY; count];
    let mut done = vec![false; count];
    best[0] = 0.0;
    while let Some(at) = (0..count)
        .filter(|&i| !done[i] && best[i].is_finite())
        .min_by(|&i, &j| best[i].total_cmp(&best[j]))
    {
        if at == 1 {
            break;
        }
        done[at] = true;
        for next in 0..count {
            let length = best[at] + (nodes[next] - nodes[at]).norm();
            if length < best[next] && stays_inside(&edges, nodes[at], nodes[next], tolerance) {
                best[next] = length;
            }
        }
    }
    best[1]
}
