//! Polygons and lines from drawings and surveys, put together to one floor.

use super::account::Account;
use super::stroke::Stroke;
use crate::automaton::network::scenario::WorkspaceOutline;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::Overlay;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;

/// Coordinates farther from 0 are none of a floor plan.
const FARTHEST: f64 = 1e100;
/// Coordinates are rounded to this share of the extent, by powers of ten: a millionth to a ten-millionth of it.
pub(super) const DIGITS: i32 = 6;

/// The corners of a polygon, not closed twice.
pub(super) type Ring = Vec<[f64; 2]>;

/// A ring with all lengths multiplied.
pub(super) fn scaled(ring: Ring, scale: f64) -> Ring {
    ring.into_iter().map(|[x, y]| [scale * x, scale * y]).collect()
}

/// Twice the area, positive for counter-clockwise rings.
pub(super) fn double_area(ring: &[[f64; 2]]) -> f64 {
    let sides = ring.iter().zip(ring.iter().cycle().skip(1));
    sides.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum()
}

/// A polygon whose first ring bounds it and whose other rings are holes, each in the direction
/// that says so.
pub(super) fn oriented(polygon: Vec<Ring>) -> Vec<Ring> {
    let turn = |(index, mut ring): (usize, Ring)| {
        if (double_area(&ring) > 0.0) != (index == 0) {
            ring.reverse();
        }
        ring
    };
    polygon.into_iter().enumerate().map(turn).collect()
}

/// What a drawing or a survey says of a floor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sketch {
    /// Polygons that are floor, by `rule`. Without any, floor is what the walls enclose.
    pub floors: Vec<Ring>,
    pub rule: FillRule,
    pub walls: Vec<Ring>,
    pub lines: Vec<Stroke>,
    /// Where walls drawn as lines are open.
    pub doors: Vec<Ring>,
}

impl Default for Sketch {
    fn default() -> Self {
        let [floors, walls, doors] = [const { Vec::new() }; 3];
        Self { floors, rule: FillRule::NonZero, walls, lines: Vec::new(), doors }
    }
}

/// Polygons in whole numbers: each its boundary, then its holes.
type Shapes = Vec<Vec<Vec<IntPoint<i64>>>>;

impl Sketch {
    /// All lines as they are drawn.
    pub(super) fn drawn(&self) -> Vec<Ring> {
        let closed = |ring: &Ring| ring.iter().chain(ring.first()).copied().collect::<Ring>();
        let polygons = [&self.floors, &self.walls, &self.doors].into_iter().flatten().map(closed);
        let line = |line: &Stroke| {
            if line.is_closed { closed(&line.corners) } else { line.corners.clone() }
        };
        polygons.chain(self.lines.iter().map(line)).collect()
    }

    /// The largest piece of the floor without the walls, and what became of the rest.
    ///
    /// All is rounded before it is put together, and the result has no further rounding: what is found not to cross
    /// stays so.
    pub(super) fn floor(&self) -> Result<(WorkspaceOutline, Account), String> {
        let lines = self.lines.iter().flat_map(Stroke::outline).collect();
        let all = [&self.floors, &self.walls, &lines, &self.doors];
        let raster = Raster::of(all.into_iter().flatten())?;
        let [floors, mut walls, lines, doors] = all.map(|rings| raster.rings(rings));

        walls.extend(overlay(&lines, &doors, OverlayRule::Difference, FillRule::NonZero).concat());
        let pieces = match floors.is_empty() {
            true => enclosed(overlay(&walls, &[], OverlayRule::Subject, FillRule::NonZero)),
            false => {
                let floors = overlay(&floors, &[], OverlayRule::Subject, self.rule).concat();
                overlay(&floors, &walls, OverlayRule::Difference, FillRule::NonZero)
            }
        };
        let pieces = pieces.into_iter().map(|piece| raster.places(piece));
        let area =
            |piece: &Vec<Ring>| piece.iter().map(|ring| double_area(ring) / 2.0).sum::<f64>();
        let mut pieces: Vec<(f64, Vec<Ring>)> = pieces.map(|piece| (area(&piece), piece)).collect();
        pieces.sort_by(|one, other| other.0.total_cmp(&one.0));
        let mut pieces = pieces.into_iter();
        let (largest, rings) = pieces.next().ok_or(match floors.is_empty() {
            true => "no floor: the map has no polygon that is floor, and its walls enclose none",
            false => "no floor: the map has no polygon with an area that is not wall",
        })?;
        let in_pieces = pieces.map(|(area, _)| area).sum();
        let mut rings = rings.into_iter();
        let boundary = rings.next().unwrap_or_default();
        let account =
            Account { stated: largest + in_pieces, in_pieces, smoothed: 0.0, unit: "square units" };
        Ok((WorkspaceOutline { boundary, holes: rings.collect() }, account))
    }
}

/// What closed walls have within them, each piece by itself.
fn enclosed(walls: Shapes) -> Shapes {
    let within = walls.iter().flat_map(|shape| &shape[1..]);
    let reversed = |ring: &Vec<IntPoint<i64>>| ring.iter().rev().copied().collect::<Vec<_>>();
    let within: Vec<_> = within.map(reversed).collect();
    // What stands within is wall again.
    overlay(&within, &walls.concat(), OverlayRule::Difference, FillRule::NonZero)
}

fn overlay(
    rings: &[Vec<IntPoint<i64>>],
    others: &[Vec<IntPoint<i64>>],
    operation: OverlayRule,
    rule: FillRule,
) -> Shapes {
    Overlay::<i64>::from_subj_and_clip(rings, others).overlay(operation, rule)
}

/// Places as whole numbers.
struct Raster {
    /// Places are whole multiples of a power of ten, 10^−digits.
    digits: i32,
    /// The place of (0, 0), in this unit.
    origin: [f64; 2],
}

impl Raster {
    fn of<'a>(rings: impl Iterator<Item = &'a Ring>) -> Result<Self, String> {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in rings.flatten() {
            for (axis, &value) in corner.iter().enumerate() {
                if value.is_nan() || value.abs() > FARTHEST {
                    return Err(format!(
                        "a coordinate is {value:e}: they are numbers up to {FARTHEST:e}"
                    ));
                }
                (low[axis], high[axis]) = (low[axis].min(value), high[axis].max(value));
            }
        }
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(f64::MIN_POSITIVE);
        let digits = digits(extent);
        Ok(Self { digits, origin: low.map(|value| (value * 10f64.powi(digits)).round()) })
    }

    fn rings(&self, rings: &[Ring]) -> Vec<Vec<IntPoint<i64>>> {
        let point = |&[x, y]: &[f64; 2]| {
            let [left, low] = self.origin;
            let unit = 10f64.powi(self.digits);
            IntPoint::new(((x * unit).round() - left) as i64, ((y * unit).round() - low) as i64)
        };
        rings.iter().map(|ring| ring.iter().map(point).collect()).collect()
    }

    fn places(&self, shape: Vec<Vec<IntPoint<i64>>>) -> Vec<Ring> {
        let place = |point: &IntPoint<i64>| {
            let [x, y] = [self.origin[0] + point.x as f64, self.origin[1] + point.y as f64];
            [x, y].map(|value| match self.digits {
                digits @ 0.. => value / 10f64.powi(digits),
                digits => value * 10f64.powi(-digits),
            })
        };
        shape.iter().map(|ring| ring.iter().map(place).collect()).collect()
    }
}

/// How many decimals places have on a floor of this extent; fewer than none where it is huge.
fn digits(extent: f64) -> i32 {
    (DIGITS - extent.log10().floor() as i32).clamp(-100, 300)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Ring {
        vec![[low, low], [high, low], [high, high], [low, high]]
    }

    fn line(from: [f64; 2], to: [f64; 2]) -> Stroke {
        Stroke { corners: vec![from, to], is_closed: false, width: 0.2 }
    }

    #[test]
    fn walls_drawn_as_lines_enclose_the_floor() {
        let sides = [
            ([0.0, 0.0], [6.0, 0.0]),
            ([6.0, 0.0], [6.0, 4.0]),
            ([6.0, 4.0], [0.0, 4.0]),
            ([0.0, 4.0], [0.0, 0.0]),
        ];
        let mut lines: Vec<Stroke> = sides.into_iter().map(|(from, to)| line(from, to)).collect();
        lines.extend([line([3.0, 0.0], [3.0, 1.5]), line([3.0, 2.5], [3.0, 4.0])]);
        let sketch = Sketch { lines, ..Sketch::default() };
        let (workspace, account) = sketch.floor().unwrap();
        assert!(workspace.holes.is_empty());
        let area = 5.8 * 3.8 - 2.0 * 0.2 * 1.4;
        assert!((account.stated - area).abs() < 1e-4, "{account:?}");
        assert_eq!(account.lost(), 0.0);
    }

    #[test]
    fn doors_open_walls_drawn_as_lines_and_no_others() {
        let lines = vec![line([4.0, 0.0], [4.0, 8.0])];
        let sketch = Sketch { floors: vec![square(0.0, 8.0)], lines, ..Sketch::default() };
        let (_, account) = sketch.floor().unwrap();
        assert!((account.lost() - 0.5).abs() < 1e-6);
        let door = vec![[3.5, 3.0], [4.5, 3.0], [4.5, 4.0], [3.5, 4.0]];
        let sketch = Sketch { doors: vec![door], ..sketch };
        let (_, account) = sketch.floor().unwrap();
        assert!((account.stated - (64.0 - 7.0 * 0.2)).abs() < 1e-6, "{account:?}");
        assert_eq!(account.in_pieces, 0.0);
        let walls = vec![vec![[3.9, 0.0], [4.1, 0.0], [4.1, 8.0], [3.9, 8.0]]];
        let sketch = Sketch { walls, ..sketch };
        assert!((sketch.floor().unwrap().1.lost() - 0.5).abs() < 1e-6);
    }
}
