//! Paths pulled taut: the shortest ones that pass obstacles on the same sides.
//!
//! With holes in the workspace there are many ways between two places, and the shortest of all may be
//! of no use, for a robot whose link leads round a hole on the other side. Pulling a path taut tells what
//! its own side is worth.

use super::segment::{Segment, side};
use super::{FreeSpace, Geodesic};
use crate::Point;

/// A pull shortens a path by more than this share of the tolerance, or is none.
const WORTH_PULLING: f64 = 1e-3;

impl FreeSpace {
    /// The shortest of all paths that pass the obstacles on the same sides as the one from `start`
    /// through `waypoints`, whose straight pieces are to lie in the free space.
    ///
    /// Where a path does not bend round an obstacle it can be shortened: its corner gives way to the hull
    /// of the obstacles' corners between the places before and after it.
    pub fn taut(&self, start: Point, waypoints: &[Point]) -> Geodesic {
        let mut path: Vec<Point> = [&[start], waypoints].concat();
        self.drop_repetitions(&mut path);
        while let Some((at, hull)) = (1..path.len().saturating_sub(1)).find_map(|at| {
            let hull = self.hull(path[at - 1], path[at], path[at + 1]);
            let shorter = length(&path[at - 1..=at + 1])
                - length(&[&path[at - 1..at], &hull, &path[at + 1..at + 2]].concat());
            (shorter > WORTH_PULLING * self.tolerance()).then_some((at, hull))
        }) {
            path.splice(at..=at, hull);
            self.drop_repetitions(&mut path);
        }
        Geodesic::new(start, if path.len() > 1 { path.split_off(1) } else { path })
    }

    /// Of places that are the same but for rounding one stays, the last one where the path ends.
    fn drop_repetitions(&self, path: &mut Vec<Point>) {
        let Some(end) = path.pop() else { return };
        path.dedup_by(|next, last| (*next - *last).norm() <= self.tolerance());
        while path.len() > 1 && (path[path.len() - 1] - end).norm() <= self.tolerance() {
            path.pop();
        }
        path.push(end);
    }

    /// The corners round which a path bends that leads from one place to another as one over `corner`
    /// does: the part of the hull of the obstacles in the triangle that faces `corner`.
    fn hull(&self, from: Point, corner: Point, to: Point) -> Vec<Point> {
        let apart = |one: Point, other: Point| (one - other).norm() > self.tolerance();
        // Between a way and the same way back there is nothing: which side of the line an obstacle is on does not matter.
        let is_on_way = |place: Point, end: Point| {
            Segment::new(corner, end).distance(place) <= self.tolerance()
        };
        if is_on_way(from, to) || is_on_way(to, from) {
            return Vec::new();
        }
        let mut obstacles = self.corners().iter().filter(|known| !apart(known.at, corner));
        if obstacles.any(|obstacle| obstacle.lies_between(from, to)) {
            return vec![corner];
        }
        let turn = side(from, corner, to).signum();
        let lies_left = |from: Point, to: Point, point: Point| turn * side(from, to, point);
        let lies_in = |from: Point, to: Point, point: Point| {
            lies_left(from, to, point) >= -self.tolerance() * (to - from).norm()
        };
        // Where the triangle is a line, all that lies in line with it is to the left of all its sides. No
        // way over a point of the triangle is longer than the one over `corner`.
        let longest = length(&[from, corner, to]) + self.tolerance();
        let mut within: Vec<Point> = (self.corners().iter().map(|corner| corner.at))
            .filter(|&at| {
                lies_in(from, corner, at)
                    && lies_in(corner, to, at)
                    && lies_in(to, from, at)
                    && length(&[from, at, to]) <= longest
                    && apart(at, from)
                    && apart(at, to)
                    && apart(at, corner)
            })
            .collect();
        let mut hull = Vec::new();
        let mut last = from;
        // The next corner of the hull is the one with all others to the left of the way to it.
        while let Some(next) = (within.iter().copied().chain([to]))
            .reduce(|best, at| if lies_left(last, best, at) < 0.0 { at } else { best })
            .filter(|&next| next != to)
        {
            within.retain(|&at| at != next);
            hull.push(next);
            last = next;
        }
        hull
    }
}

fn length(path: &[Point]) -> f64 {
    path.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}
