//! Maps of cells, each free or not, and how they become outlines.

use super::outline::{Ring, scaled};
use super::{MapPlaces, Plan, Reading, cells, counted};
use crate::automaton::network::scenario::WorkspaceOutline;
use crate::figures::quantity;

/// The most cells of a map.
const MOST_CELLS: usize = 100_000_000;

/// Cells in rows from the top, and where they lie.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grid {
    width: usize,
    height: usize,
    free: Vec<bool>,
    /// The side of a cell.
    pub cell: f64,
    /// Where the lower left corner of the lowest left cell lies.
    pub origin: [f64; 2],
    /// By how much the map is turned about its origin, in radians.
    pub yaw: f64,
    /// What is to be said about the cells.
    pub notes: Vec<String>,
}

impl Grid {
    /// A grid of cells of side 1 at the origin; `free` has rows from the top.
    pub fn new(width: usize, height: usize, free: Vec<bool>) -> Result<Self, String> {
        match width.checked_mul(height) {
            Some(count) if count <= MOST_CELLS && count == free.len() && count > 0 => {
                let notes = vec![format!("{width} by {height} cells")];
                Ok(Self { width, height, free, cell: 1.0, origin: [0.0; 2], yaw: 0.0, notes })
            }
            _ => Err(format!(
                "a map of {width} by {height} cells with {} of them stated; at most {MOST_CELLS} \
                 are possible",
                free.len()
            )),
        }
    }

    /// Traces the outline of the largest piece of floor.
    pub fn trace(self, reading: &Reading) -> Result<Plan, String> {
        let cell = self.cell * reading.scale;
        let margin = match reading.tolerance {
            None => 1,
            Some(tolerance) if tolerance >= 0.0 => (tolerance / cell * (1.0 + 1e-9)) as usize,
            Some(tolerance) => return Err(format!("the tolerance is {tolerance}: at least 0")),
        };
        // Rows from the bottom, as coordinates go up.
        let rows = self.free.chunks(self.width).rev().flatten().copied().collect();
        let mut floor = cells::Cells { width: self.width, height: self.height, free: rows };
        let stated = floor.count();
        floor.narrow(margin);
        floor.part_diagonals();
        let dropped = floor.keep_largest_piece();
        let traced = floor.outline().ok_or_else(|| match stated {
            0 => "no cell of the map is free".to_owned(),
            _ => format!(
                "no floor is left of {}; choose a smaller tolerance",
                counted(stated, "free cell", "free cells")
            ),
        })?;
        let (rings, deviation) = cells::simplified(&traced, margin as f64);

        let corners = |rings: &[Ring]| rings.iter().map(Vec::len).sum::<usize>();
        let mut notes = self.notes;
        let free = counted(stated, "free cell", "free cells");
        notes.push(format!("{free} of side {}", quantity(cell)));
        notes.push(format!(
            "walls are {} thicker, and the outline deviates by at most {}: it stays in free \
             cells; {} corners became {}",
            quantity(margin as f64 * cell),
            quantity(deviation * cell),
            corners(&traced),
            corners(&rings)
        ));
        if dropped > 0 {
            let dropped = counted(dropped, "cell", "cells");
            notes.push(format!("left out: separate pieces of floor, {dropped} together"));
        }
        let (sin, cos) = self.yaw.sin_cos();
        let placed = |[x, y]: [f64; 2]| {
            let ([x, y], [left, low]) = ([x * self.cell, y * self.cell], self.origin);
            [left + cos * x - sin * y, low + sin * x + cos * y]
        };
        let mut rings = rings
            .into_iter()
            .map(|ring| scaled(ring.into_iter().map(placed).collect(), reading.scale));
        let boundary = rings.next().unwrap_or_default();
        let workspace = WorkspaceOutline { boundary, holes: rings.collect() };
        Ok(Plan { workspace, places: MapPlaces::default(), notes })
    }
}
