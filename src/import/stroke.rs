//! Walls drawn as lines.

use super::outline::{Ring, double_area};
use i_overlay::mesh::float::stroke::offset::StrokeOffset;
use i_overlay::mesh::float::style::{LineJoin, StrokeStyle};

/// The sharpest corner, in radians, that a wall has on both sides; a sharper one is cut off.
const SHARPEST: f64 = 0.2;

/// A wall drawn as a line.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stroke {
    pub corners: Ring,
    /// Whether it goes on from its last corner to its first.
    pub is_closed: bool,
    pub width: f64,
}

/// An opening in walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Door {
    pub at: [f64; 2],
    pub width: f64,
}

impl Stroke {
    /// A wall along a line, which is closed if it ends where it starts.
    pub(super) fn along(mut corners: Ring, width: f64) -> Self {
        let is_closed =
            corners.len() > 3 && corners.first() == corners.last() && double_area(&corners) != 0.0;
        if is_closed {
            corners.pop();
        }
        Self { corners, is_closed, width }
    }

    /// The polygons that the wall covers.
    pub(super) fn outline(&self) -> Vec<Ring> {
        let style = StrokeStyle::new(self.width).line_join(LineJoin::Miter(SHARPEST));
        self.corners.stroke_as::<i64>(style, self.is_closed).concat()
    }

    /// What stays of the wall beside its doors: those that stand on it.
    pub(super) fn beside(&self, doors: &[Door]) -> Vec<Stroke> {
        let mut pieces: Vec<Ring> = Vec::new();
        let mut is_cut = false;
        for (from, to) in self.sides() {
            let at = |along: f64| [0, 1].map(|axis| from[axis] + along * (to[axis] - from[axis]));
            let length = (to[0] - from[0]).hypot(to[1] - from[1]);
            let mut openings: Vec<[f64; 2]> =
                doors.iter().filter_map(|door| self.opening(*door, from, to)).collect();
            openings.sort_by(|one, other| one[0].total_cmp(&other[0]));
            is_cut |= !openings.is_empty();
            let mut start = 0.0_f64;
            for [open, close] in openings.into_iter().chain([[length, length]]) {
                if open > start {
                    let [start, end] =
                        [at(start / length), if open == length { to } else { at(open / length) }];
                    match pieces.last_mut().filter(|piece| piece.last() == Some(&start)) {
                        Some(piece) => piece.push(end),
                        None => pieces.push(vec![start, end]),
                    }
                }
                start = start.max(close);
            }
        }
        match is_cut {
            false => vec![self.clone()],
            true => pieces
                .into_iter()
                .map(|corners| Stroke { corners, is_closed: false, ..*self })
                .collect(),
        }
    }

    /// From where to where along a side a door opens it.
    fn opening(&self, door: Door, from: [f64; 2], to: [f64; 2]) -> Option<[f64; 2]> {
        let [across, up] = [to[0] - from[0], to[1] - from[1]];
        let length = across.hypot(up);
        let [x, y] = [door.at[0] - from[0], door.at[1] - from[1]];
        let along = (x * across + y * up) / length;
        let beside = (x * up - y * across).abs() / length;
        let [open, close] = [along - door.width / 2.0, along + door.width / 2.0];
        let is_on = beside <= self.width && (-self.width..=length + self.width).contains(&along);
        (is_on && close > 0.0 && open < length).then(|| [open.max(0.0), close.min(length)])
    }

    fn sides(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        let ends = self.corners.iter().cycle().skip(1);
        let count =
            if self.is_closed { self.corners.len() } else { self.corners.len().saturating_sub(1) };
        self.corners
            .iter()
            .zip(ends)
            .take(count)
            .map(|(from, to)| (*from, *to))
            .filter(|(from, to)| from != to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_door_opens_the_wall_that_it_stands_on() {
        let corners = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
        let room = Stroke { corners, is_closed: true, width: 0.1 };
        let door = |x: f64, y: f64| Door { at: [x, y], width: 1.0 };
        assert_eq!(room.beside(&[door(2.0, 1.0)]), std::slice::from_ref(&room));
        let open = room.beside(&[door(3.25, 0.0)]);
        let corners: Vec<&Ring> = open.iter().map(|piece| &piece.corners).collect();
        let [first, second] = corners[..] else { panic!("{open:?}") };
        assert_eq!(first, &[[0.0, 0.0], [2.75, 0.0]]);
        assert_eq!(second, &[[3.75, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [0.0, 0.0]]);
    }

    #[test]
    fn a_wall_is_as_wide_as_it_says() {
        let wall = Stroke::along(vec![[0.0, 0.0], [5.0, 0.0]], 0.2);
        let outline = wall.outline();
        assert!((double_area(&outline[0]).abs() / 2.0 - 1.0).abs() < 1e-6, "{outline:?}");
        let ring =
            Stroke::along(vec![[0.0, 0.0], [5.0, 0.0], [5.0, 5.0], [0.0, 5.0], [0.0, 0.0]], 0.2);
        let area: f64 = ring.outline().iter().map(|ring| double_area(ring) / 2.0).sum();
        assert!((area - (5.2 * 5.2 - 4.8 * 4.8)).abs() < 1e-6, "{area}");
    }
}
