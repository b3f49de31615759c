//! Maps of cells, each free or not, and how they become outlines.

use super::account::{Account, CELLS};
use super::cells::{Cells, Corners, SIDE, Specks};
use super::lattice::Lattice;
use super::outline::{Ring, scaled};
use super::smooth::{Limits, double_area, smooth};
use super::{MapPlaces, Picture, Plan, Reading, counted, default_clearance};
use crate::automaton::network::scenario::WorkspaceOutline;
use crate::figures::quantity;

/// The most cells of a map.
const MOST_CELLS: usize = 100_000_000;
/// The largest share of the floor that goes to smoother walls where no tolerance is asked for.
const SMOOTHED: f64 = 0.01;
/// The share of the corners that smoother walls must do without, or walls stay as they are.
const NOISE: f64 = 0.25;

/// Cells in rows from the top, and where they lie.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grid {
    width: usize,
    height: usize,
    free: Vec<bool>,
    /// How the cells look, from black to white.
    pub shades: Vec<u8>,
    /// The side of a cell.
    pub cell: f64,
    /// Where the lower left corner of the lowest left cell lies.
    pub origin: [f64; 2],
    /// By how much the map is turned about its origin, in radians.
    pub yaw: f64,
    /// The size of groups of walls that are dropped where none is asked for: 0, or more where cells are measured.
    pub specks: usize,
}

impl Grid {
    /// A grid of cells of side 1 at the origin; `free` has rows from the top.
    pub(super) fn new(width: usize, height: usize, free: Vec<bool>) -> Result<Self, String> {
        match width.checked_mul(height) {
            Some(count) if count <= MOST_CELLS && count == free.len() && count > 0 => {
                let shades = free.iter().map(|&free| if free { u8::MAX } else { 0 }).collect();
                let (cell, origin, yaw) = (1.0, [0.0; 2], 0.0);
                Ok(Self { width, height, free, shades, cell, origin, yaw, specks: 0 })
            }
            _ => Err(format!(
                "a map of {width} by {height} cells with {} of them stated; at most {MOST_CELLS} \
                 are possible",
                free.len()
            )),
        }
    }

    /// Traces the outline of the largest piece of floor.
    pub(super) fn trace(self, reading: &Reading) -> Result<Plan, String> {
        let cell = self.cell * reading.scale;
        let tolerance = match reading.tolerance {
            None => cell,
            Some(tolerance) if tolerance >= 0.0 => tolerance,
            Some(tolerance) => return Err(format!("the tolerance is {tolerance}: at least 0")),
        };
        let mut floor = self.floor();
        let stated = floor.count();
        let largest_speck = reading.specks.unwrap_or(self.specks);
        let specks = floor.drop_specks(largest_speck);
        let in_pieces = floor.keep_largest_piece();
        let traced = floor.outline().ok_or("no cell of the map is free")?;

        let clearance =
            reading.clearance.unwrap_or_else(|| default_clearance(extent(&traced) * cell));
        let mut lattice = Lattice::of(&floor, clearance / cell * SIDE as f64);
        let area = double_area(&traced) as f64 / 2.0;
        let limits = Limits {
            tolerance: tolerance / cell * SIDE as f64 * (1.0 + 1e-9),
            area: if reading.tolerance.is_none() { SMOOTHED * area } else { f64::INFINITY },
        };
        let corners = |outline: &[Corners]| outline.iter().map(Vec::len).sum::<usize>();
        let smoother = smooth(&traced, limits, &mut lattice);
        let is_worth_it = reading.tolerance.is_some()
            || (corners(&smoother) as f64) < (1.0 - NOISE) * corners(&traced) as f64;
        let outline = if is_worth_it { &smoother } else { &traced };
        let side = SIDE as f64;
        let smoothed = floor.count() as f64 - double_area(outline) as f64 / 2.0 / (side * side);
        let account =
            Account { stated: stated as f64, in_pieces: in_pieces as f64, smoothed, unit: CELLS };
        let account = match reading.tolerance {
            None => account.accepted(reading.accepted_loss)?,
            // The loss to smoother walls was asked for.
            Some(_) => account.accepted(reading.accepted_loss + smoothed / stated as f64)?,
        };

        let mut notes = vec![
            account.to_string(),
            format!("{} by {} cells of side {}", self.width, self.height, quantity(cell)),
            match is_worth_it {
                true => format!(
                    "walls are at most {} thicker and nowhere thinner; {} corners became {}",
                    quantity(tolerance),
                    corners(&traced),
                    corners(outline)
                ),
                false => {
                    format!("walls are where the cells are, with {} corners", corners(outline))
                }
            },
        ];
        notes.extend(told(specks, largest_speck));
        let mut rings = outline.iter().map(|ring| self.placed(ring, reading.scale));
        let boundary = rings.next().unwrap_or_default();
        let workspace = WorkspaceOutline { boundary, holes: rings.collect() };
        let picture = Some(self.picture(reading.scale));
        Ok(Plan {
            workspace,
            places: MapPlaces::default(),
            account,
            picture,
            lines: Vec::new(),
            notes,
        })
    }

    fn picture(self, scale: f64) -> Picture {
        let (sin, cos) = self.yaw.sin_cos();
        let side = self.cell * scale;
        let [left, low] = self.origin.map(|value| value * scale);
        let up = self.height as f64 * side;
        let placement =
            [cos * side, sin * side, sin * side, -cos * side, left - sin * up, low + cos * up];
        Picture {
            width: self.width as u32,
            height: self.height as u32,
            shades: self.shades,
            placement,
        }
    }

    /// Rows from the bottom, as coordinates go up.
    fn floor(&self) -> Cells {
        let free = self.free.chunks(self.width).rev().flatten().copied().collect();
        Cells { width: self.width, height: self.height, free }
    }

    /// A ring where it lies in the world.
    fn placed(&self, ring: &Corners, scale: f64) -> Ring {
        let (sin, cos) = self.yaw.sin_cos();
        let placed = |&corner: &[i64; 2]| {
            let [x, y] = corner.map(|value| value as f64 * self.cell / SIDE as f64);
            let [left, low] = self.origin;
            [left + cos * x - sin * y, low + sin * x + cos * y]
        };
        scaled(ring.iter().map(placed).collect(), scale)
    }
}

/// The larger side of the box around an outline, in cells.
fn extent(outline: &[Corners]) -> f64 {
    let sides = [0, 1].map(|axis| {
        let values = outline.iter().flatten().map(|corner| corner[axis]);
        values.clone().max().unwrap_or_default() - values.min().unwrap_or_default()
    });
    sides[0].max(sides[1]) as f64 / SIDE as f64
}

/// What is to be said about specks.
fn told(Specks { groups, cells }: Specks, largest: usize) -> Option<String> {
    (groups > 0).then(|| {
        format!(
            "{} of at most {} that are not free, with floor all around, became floor ({cells} in all): --specks 0 \
             keeps them",
            counted(groups, "group", "groups"),
            counted(largest, "cell", "cells")
        )
    })
}
