//! Where robots fit between the walls of a map of cells: points half a cell apart.
//!
//! A smoother outline takes floor away, and with it points of the lattice. Points are only taken such that the rest
//! hangs together as before: no part of it is torn into two or vanishes, and no way around something is cut or newly
//! made. They are taken one by one, and each must be *simple* for connectivity 8 of what stays (Yokoi, Toriwaki and
//! Fukumura, 1975: its connectivity number is 1).
//!
//! A place where a robot fits is at most [`SPACING`] from a point of the lattice, so the lattice has the points that are
//! nearer to walls by that, and an outline takes those that are farther from it by that. What robots get through
//! therefore is in the lattice, and is open still when the lattice says so.

use super::cells::{Cells, SIDE};

/// The distance between points of the lattice, in the unit of outlines.
const STEP: i64 = SIDE / 2;
/// The farthest that a place can be from the next point of the lattice, half its diagonal; in the unit of outlines.
const SPACING: f64 = 0.5 * std::f64::consts::SQRT_2 * STEP as f64;

/// Points at which a robot fits.
pub(super) struct Lattice {
    width: usize,
    height: usize,
    is_open: Vec<bool>,
    /// The distance from walls at which a robot surely fits, in the unit of outlines.
    reach: f64,
}

impl Lattice {
    /// The lattice for robots that keep `clearance` from walls, in the unit of outlines.
    pub(super) fn of(cells: &Cells, clearance: f64) -> Self {
        let [width, height] = [cells.width, cells.height].map(|side| 2 * side + 1);
        let distances = squared_distances(cells, width, height);
        let least = ((clearance - SPACING) / STEP as f64).max(0.0).powi(2);
        let is_open = distances.iter().map(|&squared| squared > 0 && squared as f64 >= least);
        Self { width, height, is_open: is_open.collect(), reach: clearance + SPACING }
    }

    /// Takes the points that are in a triangle or nearer to its first side than robots keep, if what stays hangs together
    /// as before; otherwise takes none. Whether it took them.
    pub(super) fn take(&mut self, triangle: [[i64; 2]; 3]) -> bool {
        let mut doomed = self.near(triangle);
        let all = doomed.clone();
        loop {
            let before = doomed.len();
            doomed.retain(|&point| {
                let stays = !self.is_simple(point);
                self.is_open[point] = stays;
                stays
            });
            doomed.reverse();
            if doomed.is_empty() {
                return true;
            }
            if doomed.len() == before {
                all.iter().for_each(|&point| self.is_open[point] = true);
                return false;
            }
        }
    }

    /// The open points that a triangle takes.
    fn near(&self, triangle: [[i64; 2]; 3]) -> Vec<usize> {
        let corners = triangle.map(|corner| corner.map(|value| value as f64));
        let rows = |pick: fn(f64, f64) -> f64| {
            corners[1..].iter().fold(corners[0][1], |y, c| pick(y, c[1]))
        };
        let step = STEP as f64;
        let first = ((rows(f64::min) - self.reach) / step).ceil().max(0.0) as usize;
        let last = ((rows(f64::max) + self.reach) / step).floor().min(self.height as f64 - 1.0);
        let mut points = Vec::new();
        for row in first..=last as usize {
            let y = row as f64 * step;
            let Some([left, right]) = span(corners, y - self.reach, y + self.reach) else {
                continue;
            };
            let from = ((left - self.reach) / step).ceil().max(0.0) as usize;
            let to = ((right + self.reach) / step).floor().min(self.width as f64 - 1.0) as usize;
            for column in from..=to {
                let point = row * self.width + column;
                if self.is_open[point] && self.is_taken([column as f64 * step, y], corners) {
                    points.push(point);
                }
            }
        }
        points
    }

    fn is_taken(&self, place: [f64; 2], [from, to, corner]: [[f64; 2]; 3]) -> bool {
        distance(place, [from, to]) < self.reach
            || [[from, to], [to, corner], [corner, from]]
                .map(|[a, b]| cross(a, b, place))
                .iter()
                .all(|turn| *turn <= 0.0)
    }

    /// Whether taking a point leaves everything as connected as it is.
    fn is_simple(&self, point: usize) -> bool {
        let (column, row) = (point % self.width, point / self.width);
        let is_shut = |[right, up]: [isize; 2]| {
            let (Some(column), Some(row)) =
                (column.checked_add_signed(right), row.checked_add_signed(up))
            else {
                return true;
            };
            column >= self.width || row >= self.height || !self.is_open[row * self.width + column]
        };
        let around = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
        let shut = around.map(is_shut);
        let number =
            [0, 2, 4, 6].into_iter().filter(|&k| shut[k] && !(shut[k + 1] && shut[(k + 2) % 8]));
        number.count() == 1
    }
}

/// The least and the greatest first coordinate of what of a triangle lies between two heights.
fn span(corners: [[f64; 2]; 3], low: f64, high: f64) -> Option<[f64; 2]> {
    let mut span: Option<[f64; 2]> = None;
    for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (corners[a], corners[b])) {
        let (a, b) = if a[1] <= b[1] { (a, b) } else { (b, a) };
        if b[1] < low || a[1] > high {
            continue;
        }
        let rise = b[1] - a[1];
        let at = |y: f64| {
            if rise > 0.0 {
                a[0] + (y.clamp(a[1], b[1]) - a[1]) / rise * (b[0] - a[0])
            } else {
                a[0]
            }
        };
        let ends = if rise > 0.0 { [at(low), at(high)] } else { [a[0], b[0]] };
        let [left, right] = span.unwrap_or([f64::INFINITY, f64::NEG_INFINITY]);
        span = Some([left.min(ends[0]).min(ends[1]), right.max(ends[0]).max(ends[1])]);
    }
    span
}

/// Twice the area of the triangle of three points, positive if they turn left.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The distance of a place from a segment.
pub(super) fn distance([x, y]: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let [across, up] = [b[0] - a[0], b[1] - a[1]];
    let length = across * across + up * up;
    let along = if length > 0.0 { ((x - a[0]) * across + (y - a[1]) * up) / length } else { 0.0 };
    let along = along.clamp(0.0, 1.0);
    (x - a[0] - along * across).hypot(y - a[1] - along * up)
}

/// The squared distance of each point of the lattice from the nearest cell that is not free, or from the edge of the
/// map, in steps: exact, since the nearest point of a cell is a point of the lattice, too. In two passes (Felzenszwalb
/// and Huttenlocher, 2012).
fn squared_distances(cells: &Cells, width: usize, height: usize) -> Vec<u32> {
    let mut squared = vec![u32::MAX; width * height];
    for (cell, _) in cells.free.iter().enumerate().filter(|(_, free)| !**free) {
        let (column, row) = (2 * (cell % cells.width), 2 * (cell / cells.width));
        for row in row..row + 3 {
            squared[row * width + column..][..3].fill(0);
        }
    }
    for row in 0..height {
        let is_edge = row == 0 || row + 1 == height;
        squared[row * width..][..if is_edge { width } else { 1 }].fill(0);
        squared[row * width + width - 1] = 0;
    }
    // Up and down each column: how many steps to the next wall.
    for rows in [
        (1..height).map(|row| (row, row - 1)).collect::<Vec<_>>(),
        (0..height - 1).rev().map(|row| (row, row + 1)).collect(),
    ] {
        for (row, before) in rows {
            for column in 0..width {
                let way = squared[before * width + column].saturating_add(1);
                let here = &mut squared[row * width + column];
                *here = (*here).min(way);
            }
        }
    }
    for row in squared.chunks_mut(width) {
        let up: Vec<u64> = row.iter().map(|&steps| u64::from(steps).pow(2)).collect();
        lower_envelope(&up, row);
    }
    squared
}

/// For each place the least of (distance to another place)² + height there (Meijster, Roerdink and Hesselink, 2000).
fn lower_envelope(heights: &[u64], least: &mut [u32]) {
    let value = |place: usize, at: usize| heights[place] + (place.abs_diff(at) as u64).pow(2);
    let origin = |place: usize| (heights[place] + (place as u64).pow(2)) as i64;
    // The places whose parabolas are lowest somewhere, and from where on each one is.
    let mut lowest: Vec<(usize, usize)> = Vec::new();
    for place in 0..heights.len() {
        while lowest.pop_if(|(other, from)| value(*other, *from) > value(place, *from)).is_some() {}
        let from = lowest.last().map_or(0, |&(other, _)| {
            let meeting = (origin(place) - origin(other)).div_euclid(2 * (place - other) as i64);
            usize::try_from(meeting + 1).unwrap_or(0)
        });
        if from < heights.len() {
            lowest.push((place, from));
        }
    }
    let mut current = 0;
    for (at, least) in least.iter_mut().enumerate() {
        while lowest.get(current + 1).is_some_and(|&(_, from)| from <= at) {
            current += 1;
        }
        *least = u32::try_from(value(lowest[current].0, at)).unwrap_or(u32::MAX);
    }
}

#[cfg(test)]
mod tests {
    use super::super::cells::tests::cells;
    use super::*;

    #[test]
    fn distances_are_those_of_every_cell_tried() {
        let mut dice = crate::starts::Dice::new(5, 0);
        let free = (0..13 * 9).map(|_| dice.below(12) > 0).collect();
        let cave = Cells { width: 13, height: 9, free };
        let (width, height) = (27, 19);
        for (point, squared) in squared_distances(&cave, width, height).into_iter().enumerate() {
            let (x, y) = (point % width, point / width);
            let apart = |at: usize, from: usize, to: usize| {
                from.saturating_sub(at).max(at.saturating_sub(to)).pow(2)
            };
            let walls = (0..cave.free.len()).filter(|&cell| !cave.free[cell]);
            let to_walls = walls.map(|cell| {
                let (column, row) = (2 * (cell % 13), 2 * (cell / 13));
                apart(x, column, column + 2) + apart(y, row, row + 2)
            });
            let to_edge = [x, y, width - 1 - x, height - 1 - y].map(|steps| steps.pow(2));
            assert_eq!(Some(squared as usize), to_walls.chain(to_edge).min(), "({x}, {y})");
        }
    }

    /// Two rooms with a door two cells wide.
    #[test]
    fn a_door_may_get_narrower_but_not_close() {
        let rooms =
            cells(&["....#....", "....#....", ".........", ".........", "....#....", "....#...."]);
        let half = SIDE;
        let block = |top: i64| [[4 * SIDE, top], [5 * SIDE, top], [4 * SIDE, 2 * SIDE]];
        let mut lattice = Lattice::of(&rooms, 0.1 * SIDE as f64);
        assert!(lattice.take(block(2 * SIDE + half / 4)));
        assert!(!lattice.take(block(4 * SIDE)));
        assert!(lattice.take([[0, SIDE], [SIDE, 0], [0, 0]]), "a corner of a room");
    }
}
