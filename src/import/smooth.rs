//! An outline of cells with fewer corners, which never leaves the free cells.
//!
//! Corners are taken out one by one, always the one by which the least floor is lost (after Visvalingam and Whyatt,
//! 1993), and only such a corner that
//!
//! - lies on the side of the wall, so that floor is lost and none is won: **no wall ever lies within the outline**;
//! - leaves all corners taken out within the tolerance of the new side;
//! - has no other corner in or near the triangle that is lost, so that the outline stays simple;
//! - keeps open what robots get through, and makes no piece of it ([`Lattice`]).

use super::cells::Corners;
use super::lattice::{Lattice, distance};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// No corner comes nearer to a new side, so that coordinates can be rounded; in eighths of a cell.
const APART: f64 = 0.25;

/// What may be lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Limits {
    /// How far the outline may deviate, in eighths of a cell.
    pub tolerance: f64,
    /// How much area may be lost, in squares of eighths of a cell.
    pub area: f64,
}

/// An outline, the boundary before the holes, with as few corners as the limits allow.
pub(super) fn smooth(outline: &[Corners], limits: Limits, lattice: &mut Lattice) -> Vec<Corners> {
    let mut drawing = Drawing::of(outline);
    let mut waiting: BinaryHeap<Reverse<Candidate>> = (0..drawing.corners.len())
        .filter_map(|corner| drawing.candidate(corner))
        .map(Reverse)
        .collect();
    let mut left = 2.0 * limits.area;
    while let Some(Reverse(candidate)) = waiting.pop() {
        let Candidate { lost, before, corner, after } = candidate;
        if lost as f64 > left {
            break;
        }
        let is_current = drawing.links[corner] == [before, after] && drawing.stays[corner];
        if !is_current || !drawing.may_lose(candidate, limits.tolerance, lattice) {
            continue;
        }
        left -= lost as f64;
        drawing.take_out(candidate);
        waiting.extend(
            [before, after].into_iter().filter_map(|it| drawing.candidate(it)).map(Reverse),
        );
    }
    drawing.outline()
}

/// A corner on the side of the wall between two others, with twice the area that is lost without it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Candidate {
    lost: i64,
    corner: usize,
    before: usize,
    after: usize,
}

/// All corners of an outline, ring after ring.
struct Drawing {
    corners: Corners,
    /// The corners before and after each one that stays.
    links: Vec<[usize; 2]>,
    stays: Vec<bool>,
    ring: Vec<usize>,
    /// Where each ring begins, and how many of its corners stay.
    rings: Vec<(usize, usize)>,
    /// The corners by height, and from west to east.
    in_rows: Vec<usize>,
}

impl Drawing {
    fn of(outline: &[Corners]) -> Self {
        let corners = outline.concat();
        let (mut links, mut ring, mut rings) = (Vec::new(), Vec::new(), Vec::new());
        for (index, corners) in outline.iter().enumerate() {
            let (start, count) = (links.len(), corners.len());
            links.extend(
                (0..count).map(|it| [start + (it + count - 1) % count, start + (it + 1) % count]),
            );
            ring.resize(start + count, index);
            rings.push((start, count));
        }
        let mut in_rows: Vec<usize> = (0..corners.len()).collect();
        in_rows.sort_by_key(|&corner| (corners[corner][1], corners[corner][0]));
        Self { stays: vec![true; corners.len()], corners, links, ring, rings, in_rows }
    }

    fn candidate(&self, corner: usize) -> Option<Candidate> {
        let [before, after] = self.links[corner];
        let lost = cross([before, corner, after].map(|it| self.corners[it]));
        (lost >= 0).then_some(Candidate { lost, corner, before, after })
    }

    fn may_lose(&self, candidate: Candidate, tolerance: f64, lattice: &mut Lattice) -> bool {
        let Candidate { lost, corner, before, after } = candidate;
        self.rings[self.ring[corner]].1 > 3
            && self.is_within(candidate, tolerance)
            && (lost == 0
                || self.is_empty(candidate)
                    && lattice.take([before, after, corner].map(|it| self.corners[it])))
    }

    /// Whether all corners that the new side replaces are near it.
    fn is_within(&self, Candidate { before, after, .. }: Candidate, tolerance: f64) -> bool {
        let side = [before, after].map(|it| self.place(it));
        let (start, ring) = (self.rings[self.ring[before]].0, self.ring[before]);
        let end = self.rings.get(ring + 1).map_or(self.corners.len(), |next| next.0);
        let following = |it: usize| if it + 1 == end { start } else { it + 1 };
        let replaced = std::iter::successors(Some(following(before)), |&it| Some(following(it)));
        let mut replaced = replaced.take_while(|&it| it != after);
        replaced.all(|it| distance(self.place(it), side) <= tolerance)
    }

    /// Whether no corner that stays lies in the triangle or near the new side.
    fn is_empty(&self, Candidate { before, corner, after, .. }: Candidate) -> bool {
        let triangle = [before, corner, after].map(|it| self.corners[it]);
        let heights = triangle.map(|[_, y]| y);
        let (low, high) = (heights.iter().min(), heights.iter().max());
        let at = |it: &usize| self.corners[*it];
        let mut row = self.in_rows.partition_point(|it| Some(&at(it)[1]) < low);
        while let Some(y) = self.in_rows.get(row).map(|it| at(it)[1]).filter(|y| Some(y) <= high) {
            let rest = &self.in_rows[row..];
            let rest = &rest[..rest.partition_point(|it| at(it)[1] == y)];
            row += rest.len();
            let [west, east] = width_at(triangle, y);
            let from = rest.partition_point(|it| (at(it)[0] as f64) < west - 1.0);
            let near = rest[from..].iter().take_while(|it| at(it)[0] as f64 <= east + 1.0);
            let mut others =
                near.filter(|&&it| self.stays[it] && ![before, corner, after].contains(&it));
            let side = [before, after].map(|it| self.place(it));
            let is_inside = |place: [i64; 2]| {
                let [a, b, c] = triangle;
                [[a, b, place], [b, c, place], [c, a, place]]
                    .into_iter()
                    .all(|turn| cross(turn) >= 0)
            };
            if others
                .any(|&it| is_inside(self.corners[it]) || distance(self.place(it), side) < APART)
            {
                return false;
            }
        }
        true
    }

    fn take_out(&mut self, Candidate { corner, before, after, .. }: Candidate) {
        self.stays[corner] = false;
        self.links[before][1] = after;
        self.links[after][0] = before;
        self.rings[self.ring[corner]].1 -= 1;
    }

    fn place(&self, corner: usize) -> [f64; 2] {
        self.corners[corner].map(|value| value as f64)
    }

    fn outline(&self) -> Vec<Corners> {
        let mut outline = vec![Corners::new(); self.rings.len()];
        for corner in (0..self.corners.len()).filter(|&corner| self.stays[corner]) {
            outline[self.ring[corner]].push(self.corners[corner]);
        }
        outline
    }
}

/// Twice the area of a triangle, positive if its corners turn left.
fn cross([a, b, c]: [[i64; 2]; 3]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Twice the area of an outline.
pub(super) fn double_area(outline: &[Corners]) -> i64 {
    let sides = outline.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    sides.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum()
}

/// From where to where a triangle reaches at a height that it has.
fn width_at(triangle: [[i64; 2]; 3], y: i64) -> [f64; 2] {
    let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
    for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (triangle[a], triangle[b])) {
        if (a[1].min(b[1])..=a[1].max(b[1])).contains(&y) {
            let rise = (b[1] - a[1]) as f64;
            let share = if rise == 0.0 { 1.0 } else { (y - a[1]) as f64 / rise };
            let x = a[0] as f64 + share * (b[0] - a[0]) as f64;
            let level = if rise == 0.0 { a[0] as f64 } else { x };
            ends = [ends[0].min(x).min(level), ends[1].max(x).max(level)];
        }
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::super::cells::tests::cells;
    use super::super::cells::{Cells, SIDE};
    use super::*;

    fn smoothed(map: &Cells, clearance: f64) -> Vec<Corners> {
        let limits = Limits { tolerance: SIDE as f64, area: f64::INFINITY };
        smooth(&map.outline().unwrap(), limits, &mut Lattice::of(map, clearance * SIDE as f64))
    }

    #[test]
    fn a_staircase_becomes_an_oblique_wall() {
        let rows: Vec<String> =
            (0..20).map(|row| format!("{}{}", ".".repeat(4 + row), "#".repeat(20 - row))).collect();
        let stairs = cells(&rows.iter().map(String::as_str).collect::<Vec<_>>());
        assert_eq!(stairs.outline().unwrap()[0].len(), 42);
        let smooth = smoothed(&stairs, 0.5);
        assert!(smooth[0].len() <= 6, "{smooth:?}");
        let lost = (double_area(&stairs.outline().unwrap()) - double_area(&smooth)) as f64 / 128.0;
        assert!((9.0..13.0).contains(&lost), "half a cell each step: {lost}");
    }

    /// From a room to another along a bend one cell wide: without its outer corner it would be a third as wide.
    #[test]
    fn a_bend_stays_as_wide_as_robots_need() {
        let bend = cells(&[
            ".....######",
            ".....######",
            ".....######",
            "####.......",
            "#######....",
            "#######....",
        ]);
        let corner = [4 * SIDE, 2 * SIDE];
        assert!(bend.outline().unwrap()[0].contains(&corner));
        assert!(smoothed(&bend, 0.4)[0].contains(&corner));
    }
}
