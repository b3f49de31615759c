//! The outline of free cells, simplified without ever leaving them.
//!
//! # Why no robot gets through a wall
//!
//! The floor is first narrowed by a margin of m cells: cells with a wall within m cells (in either
//! direction, diagonals included) are taken out. Every point of the outline is then at least m
//! sides of a cell away from every wall. Simplification (Douglas and Peucker, 1973) replaces a
//! chain of the outline by a chord such that no point of the chain is farther than m from it.
//! Suppose a point w of a wall lay strictly between chain and chord, d > 0 away from the chord. The
//! line from the chord through w meets the chain beyond w, at most m − d from w: nearer than m,
//! which cannot be. So no wall is passed over, and none lies on the other side than before.

use super::outline::Ring;
use crate::continuous::Point;
use crate::continuous::geometry::Workspace;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::Overlay;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

/// Cells in rows from the bottom, each free or not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cells {
    /// Cells in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Whether each cell is free, row by row.
    pub free: Vec<bool>,
}

impl Cells {
    /// The number of free cells.
    pub fn count(&self) -> usize {
        self.free.iter().filter(|&&free| free).count()
    }

    /// Takes out all cells with a wall, or the edge of the map, within `margin` cells.
    pub fn narrow(&mut self, margin: usize) {
        let (width, height) = (self.width, self.height);
        self.narrow_lines(margin, height, width, |row, column| row * width + column);
        self.narrow_lines(margin, width, height, |column, row| row * width + column);
    }

    /// Takes out the cells within `margin` of a cell that is not free on each line by itself.
    fn narrow_lines(
        &mut self,
        margin: usize,
        lines: usize,
        length: usize,
        index: impl Fn(usize, usize) -> usize,
    ) {
        for line in 0..lines {
            // How many free cells in a row end here, from either side.
            let mut runs = vec![0; length];
            let mut run = 0;
            for (at, count) in runs.iter_mut().enumerate() {
                run = if self.free[index(line, at)] { run + 1 } else { 0 };
                *count = run;
            }
            run = 0;
            for at in (0..length).rev() {
                run = if self.free[index(line, at)] { run + 1 } else { 0 };
                self.free[index(line, at)] = runs[at].min(run) > margin;
            }
        }
    }

    /// Takes out free cells that touch another one at a corner only: outlines would touch there.
    pub fn part_diagonals(&mut self) {
        let width = self.width;
        let mut changed = true;
        while changed {
            changed = false;
            for row in 1..self.height {
                for column in 1..width {
                    let (low, high) = ((row - 1) * width + column, row * width + column);
                    let block = [low - 1, low, high - 1, high].map(|cell| self.free[cell]);
                    match block {
                        [true, false, false, true] => self.free[high] = false,
                        [false, true, true, false] => self.free[high - 1] = false,
                        _ => continue,
                    }
                    changed = true;
                }
            }
        }
    }

    /// Keeps the piece with the most cells, which are connected side by side; the number of cells
    /// that are taken out. Of equal pieces the lowest one stays.
    pub fn keep_largest_piece(&mut self) -> usize {
        let mut piece_of = vec![usize::MAX; self.free.len()];
        let mut sizes = Vec::new();
        for start in 0..self.free.len() {
            if !self.free[start] || piece_of[start] != usize::MAX {
                continue;
            }
            let piece = sizes.len();
            let (mut waiting, mut size) = (vec![start], 0);
            piece_of[start] = piece;
            while let Some(cell) = waiting.pop() {
                size += 1;
                for next in self.beside(cell) {
                    if self.free[next] && piece_of[next] == usize::MAX {
                        piece_of[next] = piece;
                        waiting.push(next);
                    }
                }
            }
            sizes.push(size);
        }
        let largest = (0..sizes.len()).rev().max_by_key(|&piece| sizes[piece]);
        for (free, piece) in self.free.iter_mut().zip(piece_of) {
            *free &= Some(piece) == largest;
        }
        sizes.iter().sum::<usize>() - largest.map_or(0, |piece| sizes[piece])
    }

    fn beside(&self, cell: usize) -> impl Iterator<Item = usize> {
        let (column, row) = (cell % self.width, cell / self.width);
        let (width, height) = (self.width, self.height);
        [
            (column > 0).then(|| cell - 1),
            (column + 1 < width).then(|| cell + 1),
            (row > 0).then(|| cell - width),
            (row + 1 < height).then(|| cell + width),
        ]
        .into_iter()
        .flatten()
    }

    /// The outline of the free cells, which must be one piece: the boundary, then the holes, in
    /// sides of a cell. None where no cell is free.
    pub fn outline(&self) -> Option<Vec<Ring>> {
        let mut rectangles = Vec::new();
        for row in 0..self.height {
            let line = &self.free[row * self.width..(row + 1) * self.width];
            let mut column = 0;
            while column < self.width {
                let run = line[column..].iter().take_while(|&&free| free).count();
                if run > 0 {
                    let (left, right, low) = (column as i32, (column + run) as i32, row as i32);
                    rectangles.push(vec![
                        IntPoint::new(left, low),
                        IntPoint::new(right, low),
                        IntPoint::new(right, low + 1),
                        IntPoint::new(left, low + 1),
                    ]);
                }
                column += run.max(1);
            }
        }
        let mut union = Overlay::<i32>::from_subj(&rectangles);
        let shapes = union.overlay(OverlayRule::Subject, FillRule::NonZero);
        let corners = |ring: Vec<IntPoint<i32>>| {
            ring.iter().map(|corner| [f64::from(corner.x), f64::from(corner.y)]).collect()
        };
        shapes.into_iter().next().map(|shape| shape.into_iter().map(corners).collect())
    }
}

/// The rings with fewer corners, where none of the corners left out is farther than `tolerance`
/// from the new outline, and the tolerance that was kept: smaller if rings would otherwise meet.
pub fn simplified(rings: &[Ring], tolerance: f64) -> (Vec<Ring>, f64) {
    let mut tolerance = tolerance;
    while tolerance > 0.1 {
        let simple: Vec<Ring> = rings.iter().map(|ring| simplified_ring(ring, tolerance)).collect();
        if bound_a_workspace(&simple) {
            return (simple, tolerance);
        }
        tolerance /= 2.0;
    }
    (rings.to_vec(), 0.0)
}

fn bound_a_workspace(rings: &[Ring]) -> bool {
    let points = |ring: &Ring| ring.iter().copied().map(Point::from).collect::<Vec<_>>();
    let mut polygons = rings.iter().map(points);
    let Some(boundary) = polygons.next() else { return false };
    Workspace::new(boundary, polygons.collect()).is_ok()
}

/// Douglas and Peucker's simplification of the two chains between the first corner and the one
/// farthest from it; the ring itself where fewer than three corners would be left.
fn simplified_ring(ring: &Ring, tolerance: f64) -> Ring {
    let count = ring.len();
    let at = |index: usize| Point::from(ring[index % count]);
    let Some(farthest) =
        (0..count).max_by(|&i, &j| (at(i) - at(0)).norm().total_cmp(&(at(j) - at(0)).norm()))
    else {
        return ring.clone();
    };
    let mut keeps = vec![false; count];
    (keeps[0], keeps[farthest]) = (true, true);
    let mut chains = vec![(0, farthest), (farthest, count)];
    while let Some((from, to)) = chains.pop() {
        let chord = crate::continuous::geometry::Segment::new(at(from), at(to));
        let distances = (from + 1..to).map(|index| (index, chord.distance(at(index))));
        let widest = distances.max_by(|one, other| one.1.total_cmp(&other.1));
        if let Some((index, distance)) = widest
            && distance > tolerance
        {
            keeps[index] = true;
            chains.extend([(from, index), (index, to)]);
        }
    }
    let simple: Ring =
        (ring.iter().zip(keeps)).filter(|(_, keeps)| *keeps).map(|(p, _)| *p).collect();
    if simple.len() < 3 { ring.clone() } else { simple }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(rows_from_top: &[&str]) -> Cells {
        Cells {
            width: rows_from_top[0].len(),
            height: rows_from_top.len(),
            free: rows_from_top
                .iter()
                .rev()
                .flat_map(|row| row.chars().map(|c| c == '.'))
                .collect(),
        }
    }

    #[test]
    fn a_room_with_a_pillar_has_a_boundary_and_a_hole() {
        let room = cells(&["#####", "#...#", "#.#.#", "#...#", "#####"]);
        let rings = room.outline().unwrap();
        assert_eq!(rings.len(), 2);
        assert_eq!((rings[0].len(), rings[1].len()), (4, 4));
    }

    #[test]
    fn narrowing_takes_out_what_is_near_a_wall() {
        let mut room = cells(&["......", "......", "..#...", "......", "......", "......"]);
        room.narrow(1);
        let left = cells(&["######", "####.#", "####.#", "####.#", "#....#", "######"]);
        // The edge of the map is a wall, too.
        assert_eq!(room, left);
    }

    #[test]
    fn cells_that_touch_at_a_corner_are_parted() {
        let mut floor = cells(&["..##", "..##", "##..", "##.."]);
        floor.part_diagonals();
        assert_eq!(floor.count(), 7);
        assert_eq!(floor.keep_largest_piece(), 3);
    }

    /// Random caves: no wall is inside the simplified outline, by a point-in-polygon test of its
    /// own at every corner and centre of a cell of the walls.
    #[test]
    fn no_wall_is_inside_the_simplified_outline() {
        let mut dice = crate::starts::Dice::new(3, 0);
        for margin in [1, 2] {
            for _ in 0..20 {
                let cave = cave(&mut dice);
                let mut floor = cave.clone();
                floor.narrow(margin);
                floor.part_diagonals();
                floor.keep_largest_piece();
                let Some(rings) = floor.outline() else { continue };
                let (simple, kept) = simplified(&rings, margin as f64);
                assert!(kept > 0.0 && bound_a_workspace(&simple));
                for (cell, _) in cave.free.iter().enumerate().filter(|(_, free)| !**free) {
                    let corner = [(cell % cave.width) as f64, (cell / cave.width) as f64];
                    for [x, y] in
                        [[0.5, 0.5], [0.01, 0.01], [0.99, 0.01], [0.01, 0.99], [0.99, 0.99]]
                    {
                        let place = [corner[0] + x, corner[1] + y];
                        assert!(!is_inside(&simple, place), "{place:?} of a wall is in the floor");
                    }
                }
            }
        }
    }

    /// Blobs of walls of one to five cells in a room of 48 by 40.
    fn cave(dice: &mut crate::starts::Dice) -> Cells {
        let (width, height) = (48, 40);
        let mut cave = Cells { width, height, free: vec![true; width * height] };
        for _ in 0..40 {
            let (x, y, size) = (dice.below(width), dice.below(height), 1 + dice.below(5));
            for row in y..(y + size).min(height) {
                for column in x..(x + size - (row - y)).min(width) {
                    cave.free[row * width + column] = false;
                }
            }
        }
        cave
    }

    fn is_inside(rings: &[Ring], [x, y]: [f64; 2]) -> bool {
        let sides = rings.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
        let crossings = sides.filter(|(a, b)| {
            (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        });
        crossings.count() % 2 == 1
    }
}
