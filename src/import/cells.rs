//! Maps of cells, each free or not: specks, pieces, and the outline of what is free.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::Overlay;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

/// The side of a cell in the unit of outlines: corners are cut off where two free cells touch at one of them only.
pub(super) const SIDE: i64 = 8;

/// The corners of an outline, the floor to the left of each side; in eighths of a cell.
pub(super) type Corners = Vec<[i64; 2]>;

/// Cells in rows from the bottom, each free or not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Cells {
    /// Cells in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Whether each cell is free, row by row.
    pub free: Vec<bool>,
}

/// Groups of cells that were not free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Specks {
    /// How many groups.
    pub groups: usize,
    /// The cells of all.
    pub cells: usize,
}

impl Cells {
    /// The number of free cells.
    pub(super) fn count(&self) -> usize {
        self.free.iter().filter(|&&free| free).count()
    }

    /// Frees groups of at most `largest` cells with nothing but free cells around them.
    pub(super) fn drop_specks(&mut self, largest: usize) -> Specks {
        let mut dropped = Specks::default();
        let mut is_seen = vec![false; self.free.len()];
        for start in 0..self.free.len() {
            if self.free[start] || is_seen[start] {
                continue;
            }
            let (mut group, mut is_at_edge) = (vec![start], false);
            is_seen[start] = true;
            let mut next = 0;
            while let Some(&cell) = group.get(next) {
                next += 1;
                is_at_edge |= self.around(cell).count() < 8;
                for other in self.around(cell).filter(|&other| !self.free[other]) {
                    if !std::mem::replace(&mut is_seen[other], true) {
                        group.push(other);
                    }
                }
            }
            if group.len() <= largest && !is_at_edge {
                dropped.groups += 1;
                dropped.cells += group.len();
                group.iter().for_each(|&cell| self.free[cell] = true);
            }
        }
        dropped
    }

    /// Keeps the piece with the most cells, which are connected side by side; the number of cells
    /// that are taken out. Of equal pieces the lowest one stays.
    pub(super) fn keep_largest_piece(&mut self) -> usize {
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
        let column = cell % self.width;
        self.around(cell).filter(move |next| {
            next % self.width == column || next / self.width == cell / self.width
        })
    }

    /// The up to eight cells around a cell.
    fn around(&self, cell: usize) -> impl Iterator<Item = usize> {
        let (column, row) = (cell % self.width, cell / self.width);
        let rows = row.saturating_sub(1)..=(row + 1).min(self.height - 1);
        let columns = column.saturating_sub(1)..=(column + 1).min(self.width - 1);
        let cells = rows.flat_map(move |row| columns.clone().map(move |column| (row, column)));
        cells.map(|(row, column)| row * self.width + column).filter(move |&next| next != cell)
    }

    /// The outline of the free cells, which must be one piece: the boundary, then the holes. None where no cell is
    /// free. Where two free cells touch at a corner only, an eighth of the sides there is cut off, so that outlines do
    /// not touch.
    pub(super) fn outline(&self) -> Option<Vec<Corners>> {
        let mut union = Overlay::<i32>::from_subj_and_clip(&self.rows(), &self.pinches());
        let shapes = union.overlay(OverlayRule::Difference, FillRule::NonZero);
        let corners = |ring: Vec<IntPoint<i32>>| {
            ring.iter().map(|corner| [corner.x.into(), corner.y.into()]).collect()
        };
        shapes.into_iter().next().map(|shape| shape.into_iter().map(corners).collect())
    }

    /// The free cells as rectangles one cell high.
    fn rows(&self) -> Vec<Vec<IntPoint<i32>>> {
        let mut rectangles = Vec::new();
        for row in 0..self.height {
            let line = &self.free[row * self.width..(row + 1) * self.width];
            let mut column = 0;
            while column < self.width {
                let run = line[column..].iter().take_while(|&&free| free).count();
                if run > 0 {
                    let [left, right, low, high] =
                        [column, column + run, row, row + 1].map(|it| it as i32 * SIDE as i32);
                    let corners = [(left, low), (right, low), (right, high), (left, high)];
                    rectangles.push(corners.map(|(x, y)| IntPoint::new(x, y)).to_vec());
                }
                column += run.max(1);
            }
        }
        rectangles
    }

    /// A small square on its corner wherever two free cells touch at a corner only.
    fn pinches(&self) -> Vec<Vec<IntPoint<i32>>> {
        let mut squares = Vec::new();
        for row in 1..self.height {
            for column in 1..self.width {
                let (low, high) = ((row - 1) * self.width + column, row * self.width + column);
                let block = [low - 1, low, high - 1, high].map(|cell| self.free[cell]);
                if matches!(block, [true, false, false, true] | [false, true, true, false]) {
                    let [x, y] = [column, row].map(|it| it as i32 * SIDE as i32);
                    let corners = [(x - 1, y), (x, y - 1), (x + 1, y), (x, y + 1)];
                    squares.push(corners.map(|(x, y)| IntPoint::new(x, y)).to_vec());
                }
            }
        }
        squares
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A map drawn with `.` for free cells.
    pub(crate) fn cells(rows_from_top: &[&str]) -> Cells {
        let rows = rows_from_top.iter().rev();
        let free = rows.flat_map(|row| row.chars().map(|c| c == '.')).collect();
        Cells { width: rows_from_top[0].len(), height: rows_from_top.len(), free }
    }

    #[test]
    fn a_room_with_a_pillar_has_a_boundary_and_a_hole() {
        let room = cells(&["#####", "#...#", "#.#.#", "#...#", "#####"]);
        let rings = room.outline().unwrap();
        assert_eq!(rings.len(), 2);
        assert_eq!((rings[0].len(), rings[1].len()), (4, 4));
    }

    #[test]
    fn specks_are_groups_with_floor_all_around() {
        let mut room = cells(&["......", ".##.#.", "......", "..#...", ".#..##", "......"]);
        assert_eq!(room.clone().drop_specks(1), Specks { groups: 1, cells: 1 });
        assert_eq!(room.drop_specks(2), Specks { groups: 3, cells: 5 });
        assert_eq!(room.count(), 34, "what reaches the edge of the map is no speck");
    }

    #[test]
    fn cells_that_touch_at_a_corner_are_parted_there() {
        let floor = cells(&["..#.", ".#..", "...."]);
        let rings = floor.outline().unwrap();
        assert_eq!(rings.len(), 1, "the wall goes on from corner to corner");
        assert_eq!(rings[0].len(), 10 + 4, "two corners of cells are cut off: {rings:?}");
    }

    #[test]
    fn the_largest_piece_stays() {
        let mut floor = cells(&["..##", "..##", "##..", "##.."]);
        floor.free[0] = true;
        assert_eq!(floor.keep_largest_piece(), 5);
    }
}
