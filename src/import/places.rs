//! Places on a floor: the widest, far ones, and how much of it robots reach.

use super::outline::DIGITS;
use crate::automaton::network::Site;
use crate::continuous::Point;
use crate::continuous::geometry::{FreeSpace, Workspace};

/// Places along the longer side of the map.
const LATTICE: usize = 48;
/// A place counts as reached if it is at most this many clearances from a position that a robot can take.
const NEAR: f64 = 2.0;

/// Places on a lattice on the floor.
pub(super) struct Places(Vec<Point>);

impl Places {
    /// Places on the whole floor.
    pub(super) fn on(workspace: &Workspace) -> Self {
        let corners = workspace.polygons().iter().flatten();
        let low = corners.copied().reduce(|low, corner| low.inf(&corner)).unwrap_or_default();
        let step = workspace.extent() / LATTICE as f64;
        let lattice = (0..LATTICE).flat_map(|row| (0..LATTICE).map(move |column| (column, row)));
        let place = |(column, row)| {
            low + nalgebra::Vector2::new(column as f64 + 0.5, row as f64 + 0.5) * step
        };
        Self(lattice.map(place).filter(|&place| workspace.contains(place)).collect())
    }

    /// Those where a robot can be.
    pub(super) fn within(&self, free_space: &FreeSpace) -> Self {
        Self(self.0.iter().copied().filter(|&place| free_space.contains(place)).collect())
    }

    /// The place farthest from walls.
    pub(super) fn widest(&self, workspace: &Workspace) -> Option<[f64; 2]> {
        let clearance = |place: &Point| workspace.clearance(*place);
        let widest = self.0.iter().max_by(|a, b| clearance(a).total_cmp(&clearance(b)))?;
        Some(rounded((*widest).into(), workspace.extent()))
    }

    /// Different places far from the access points and from each other, one after another; fewer than asked for if
    /// there are no more.
    pub(super) fn far_apart(&self, site: &Site, count: usize) -> Vec<[f64; 2]> {
        let mut chosen = site.access_points.clone();
        let nearest = |place: Point, chosen: &[Point]| {
            chosen.iter().map(|&other| site.distance(other, place)).fold(f64::INFINITY, f64::min)
        };
        let mut distances: Vec<f64> = self.0.iter().map(|&place| nearest(place, &chosen)).collect();
        let fixed = chosen.len();
        for _ in 0..count {
            let reached = (0..distances.len()).filter(|&place| distances[place].is_finite());
            let Some(farthest) = reached.max_by(|&a, &b| distances[a].total_cmp(&distances[b]))
            else {
                break;
            };
            chosen.push(self.0[farthest]);
            distances[farthest] = f64::NEG_INFINITY; // not again
            for (place, distance) in self.0.iter().zip(&mut distances) {
                *distance = distance.min(site.distance(chosen[chosen.len() - 1], *place));
            }
        }
        let extent = site.workspace.extent();
        chosen[fixed..].iter().map(|&place| rounded(place.into(), extent)).collect()
    }

    /// The share of the places that robots come near to from one of these, 0 to 1.
    pub(super) fn reached(&self, free_space: &FreeSpace, from: &[Point]) -> f64 {
        let region = |place: Point| free_space.region(free_space.nearest(place));
        let pieces: Vec<_> = from.iter().filter_map(|&place| region(place)).collect();
        let reached = self.0.iter().filter(|&&place| {
            let nearest = free_space.nearest(place);
            (nearest - place).norm() <= NEAR * free_space.clearance()
                && free_space.region(nearest).is_some_and(|piece| pieces.contains(&piece))
        });
        reached.count() as f64 / self.0.len().max(1) as f64
    }

    /// The largest clearance below `too_large`, to two digits, with which robots reach a share of the places.
    pub(super) fn clearance_that_fits(
        &self,
        workspace: &Workspace,
        from: &[Point],
        share: f64,
        too_large: f64,
    ) -> Option<f64> {
        let fits = |clearance: f64| {
            FreeSpace::new(workspace, clearance)
                .is_ok_and(|space| self.reached(&space, from) >= share)
        };
        let (mut low, mut high) = (0.0, too_large);
        for _ in 0..HALVINGS {
            let middle = (low + high) / 2.0;
            if fits(middle) { low = middle } else { high = middle }
        }
        let unit = 10f64.powf(low.log10().floor() - 1.0);
        let rounded = format!("{:.12e}", (low / unit).floor() * unit).parse().ok()?;
        fits(rounded).then_some(rounded).filter(|fitting| *fitting > 0.0)
    }
}

/// How often a range of clearances is halved: to a hundredth of it.
const HALVINGS: usize = 7;

/// A place to a millionth of the extent.
pub(super) fn rounded(place: [f64; 2], extent: f64) -> [f64; 2] {
    let decimals = (DIGITS - extent.log10().floor() as i32).clamp(0, 15) as usize;
    place.map(|value| format!("{value:.decimals$}").parse().unwrap_or(value))
}
