//! Floor plans made of rooms and walls, and the polygons that bound them.

use pleach::automaton::network::scenario::WorkspaceOutline;
use std::collections::BTreeMap;

/// A rectangle with its sides along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    pub left: f64,
    pub bottom: f64,
    pub right: f64,
    pub top: f64,
}

impl Rectangle {
    pub fn new(left: f64, bottom: f64, right: f64, top: f64) -> Self {
        Rectangle { left, bottom, right, top }
    }

    pub fn center(&self) -> [f64; 2] {
        [(self.left + self.right) / 2.0, (self.bottom + self.top) / 2.0]
    }

    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        self.left < x && x < self.right && self.bottom < y && y < self.top
    }
}

/// A floor: what rooms cover and walls do not, without pillars.
#[derive(Clone, Debug, Default)]
pub struct Floor {
    pub rooms: Vec<Rectangle>,
    pub walls: Vec<Rectangle>,
    /// Polygons inside the floor.
    pub pillars: Vec<Vec<[f64; 2]>>,
}

/// A corner of the grid that the sides of all rectangles span.
type Corner = (usize, usize);

impl Floor {
    /// A floor of these rooms.
    pub fn of(rooms: Vec<Rectangle>) -> Self {
        Floor { rooms, ..Floor::default() }
    }

    /// The box around the rooms.
    pub fn hull(&self) -> Rectangle {
        self.rooms[1..].iter().fold(self.rooms[0], |hull, room| Rectangle {
            left: hull.left.min(room.left),
            bottom: hull.bottom.min(room.bottom),
            right: hull.right.max(room.right),
            top: hull.top.max(room.top),
        })
    }

    /// The polygons of the floor; none where it falls into pieces or touches itself in a corner.
    pub fn outline(&self) -> Option<WorkspaceOutline> {
        let rectangles = || self.rooms.iter().chain(&self.walls);
        let columns = lines(rectangles().flat_map(|r| [r.left, r.right]));
        let rows = lines(rectangles().flat_map(|r| [r.bottom, r.top]));
        let is_floor = |column: usize, row: usize| {
            let middle = |at: &[f64], i: usize| Some((at.get(i)? + at.get(i + 1)?) / 2.0);
            let (Some(x), Some(y)) = (middle(&columns, column), middle(&rows, row)) else {
                return false;
            };
            self.rooms.iter().any(|room| room.contains([x, y]))
                && !self.walls.iter().any(|wall| wall.contains([x, y]))
        };
        let mut next: BTreeMap<Corner, Corner> = BTreeMap::new();
        for column in 0..columns.len() {
            for row in 0..rows.len() {
                if !is_floor(column, row) {
                    continue;
                }
                let (right, top) = (column + 1, row + 1);
                let sides = [
                    (row == 0 || !is_floor(column, row - 1), (column, row), (right, row)),
                    (!is_floor(right, row), (right, row), (right, top)),
                    (!is_floor(column, top), (right, top), (column, top)),
                    (column == 0 || !is_floor(column - 1, row), (column, top), (column, row)),
                ];
                for (_, from, to) in sides.into_iter().filter(|(is_edge, ..)| *is_edge) {
                    if next.insert(from, to).is_some() {
                        return None;
                    }
                }
            }
        }
        let mut boundary = Vec::new();
        let mut holes = self.pillars.clone();
        while let Some((&start, _)) = next.iter().next() {
            let mut ring = vec![start];
            while let Some(corner) = next.remove(&ring[ring.len() - 1]) {
                ring.push(corner);
            }
            ring.pop();
            let ring: Vec<[f64; 2]> =
                without_straight_corners(&ring).map(|(i, j)| [columns[i], rows[j]]).collect();
            match is_counter_clockwise(&ring) {
                false => holes.push(ring),
                true if boundary.is_empty() => boundary = ring,
                true => return None,
            }
        }
        Some(WorkspaceOutline { boundary, holes })
    }
}

/// Coordinates in ascending order, each once.
fn lines(coordinates: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut lines: Vec<f64> = coordinates.collect();
    lines.sort_by(f64::total_cmp);
    lines.dedup();
    lines
}

fn without_straight_corners(ring: &[Corner]) -> impl Iterator<Item = Corner> {
    let count = ring.len();
    (0..count)
        .filter(move |&at| {
            let (before, after) = (ring[(at + count - 1) % count], ring[(at + 1) % count]);
            before.0 != after.0 && before.1 != after.1
        })
        .map(|at| ring[at])
}

fn is_counter_clockwise(ring: &[[f64; 2]]) -> bool {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>() > 0.0
}
