//! Algorithm 6 of the paper, repaired: W without everything near its boundary.
//!
//! What is repaired, and why: see [`super::free_space`].

use std::f64::consts::PI;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::segment::side;
use super::workspace::edges_of;
use super::{Segment, Workspace};
use crate::{Point, Vector};

/// Turns up to this angle get a cap with a single corner, so that a rectangular wall keeps
/// rectangular surroundings; the corner is then at most 1.56 times the clearance away.
const SINGLE_CORNER_TURN: f64 = PI * 100.0 / 180.0;

/// Sharper turns are divided into equal turns of at most this angle, whose corners are at most
/// 1.2 times the clearance away.
const CAP_STEP: f64 = PI * 67.0 / 180.0;

/// A connected piece of the plane: its outer ring counter-clockwise, then its holes clockwise.
pub(super) type Region = Vec<Vec<Point>>;

/// The part of `workspace` that keeps `distance` from its boundary, without the outer tips of the
/// mitred caps. Vertices are exact to rounding: the overlay works on a grid of 64-bit integers.
///
/// `negligible` is the length below which a deviation from a straight line, or a distance between
/// vertices, is removed.
pub(super) fn erode(workspace: &Workspace, distance: f64, negligible: f64) -> Vec<Region> {
    let coordinates = |ring: &[Point]| ring.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
    let areas = workspace.polygons().iter().filter(|ring| ring.len() >= 3);
    let whole: Vec<_> = areas.map(|ring| coordinates(ring)).collect();
    let removed: Vec<_> =
        strips_and_caps(workspace, distance).iter().map(|ring| coordinates(ring)).collect();
    let rest = whole.overlay_as::<i64>(&removed, OverlayRule::Difference, FillRule::NonZero);
    let points = |ring: &Vec<[f64; 2]>| {
        without_negligible(ring.iter().map(|&[x, y]| Point::new(x, y)).collect(), negligible)
    };
    rest.iter()
        .map(|region| region.iter().map(points).collect::<Region>())
        .filter(|region| region.first().is_some_and(|outer| !outer.is_empty()))
        .map(|region| region.into_iter().filter(|ring| !ring.is_empty()).collect())
        .collect()
}

fn strips_and_caps(workspace: &Workspace, distance: f64) -> Vec<Vec<Point>> {
    let mut removed = Vec::new();
    for ring in workspace.polygons() {
        let edges: Vec<Segment> = edges_of(ring).collect();
        for (edge, next) in edges.iter().zip(edges.iter().cycle().skip(1)) {
            removed.push(strip(edge, distance));
            removed.extend(cap(edge, next, distance));
        }
    }
    removed
}

/// The rectangle on the inner side of an edge.
fn strip(edge: &Segment, width: f64) -> Vec<Point> {
    let inwards = edge.left_normal() * width;
    vec![edge.from, edge.to, edge.to + inwards, edge.from + inwards]
}

/// The polygon about the disc of `radius` around the vertex between two edges, from the end of one
/// strip to the beginning of the next; none where the boundary does not turn right. At the end of a wall
/// without thickness it turns back.
fn cap(edge: &Segment, next: &Segment, radius: f64) -> Option<Vec<Point>> {
    // Decided exactly: at the tip of a needle, rounding could take a right turn for a left one.
    let aside = side(edge.from, edge.to, next.to);
    let turns_back = || aside == 0.0 && edge.vector().dot(&next.vector()) < 0.0;
    if aside >= 0.0 && !turns_back() {
        return None;
    }
    let (first, last) = (edge.left_normal(), next.left_normal());
    let turn = first.angle(&last);
    let corners = if turn <= SINGLE_CORNER_TURN { 1.0 } else { (turn / CAP_STEP).ceil() };
    let step = turn / corners;
    let reach = radius / (step / 2.0).cos();
    let vertex = edge.to;
    let mut ring = vec![vertex, vertex + last * radius];
    ring.extend(
        (0..corners as usize)
            .rev()
            .map(|corner| vertex + rotated(first, -(corner as f64 + 0.5) * step) * reach),
    );
    ring.push(vertex + first * radius);
    Some(ring)
}

fn rotated(vector: Vector, angle: f64) -> Vector {
    nalgebra::Rotation2::new(angle) * vector
}

/// The ring without vertices that a straight line between their neighbours misses by no more than
/// `negligible`; empty if no polygon is left.
fn without_negligible(mut ring: Vec<Point>, negligible: f64) -> Vec<Point> {
    let mut at = 0;
    while ring.len() >= 3 && at < ring.len() {
        let before = ring[(at + ring.len() - 1) % ring.len()];
        let after = ring[(at + 1) % ring.len()];
        if Segment::new(before, after).distance(ring[at]) <= negligible {
            ring.remove(at);
            at = at.saturating_sub(1);
        } else {
            at += 1;
        }
    }
    if ring.len() < 3 { Vec::new() } else { ring }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_that_hardly_bend_a_ring_are_left_out() {
        let ring = |points: &[(f64, f64)]| -> Vec<Point> {
            points.iter().map(|&(x, y)| Point::new(x, y)).collect()
        };
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let bent = |by: f64| ring(&[&square[..1], &[(1.0, -by)], &square[1..]].concat());
        assert_eq!(without_negligible(bent(0.01), 0.02), ring(&square));
        assert_eq!(without_negligible(bent(0.03), 0.02), bent(0.03));
        let flat = ring(&[(0.0, 0.0), (1.0, 0.01), (2.0, 0.0)]);
        assert!(without_negligible(flat, 0.02).is_empty(), "nothing is left of it");
    }
}
