//! Shortest paths around robots that will not move.
//!
//! A robot that stands in a corridor narrower than 4ρ is a wall for the others, which the geodesics
//! of Definition 4.1 do not see. Here such robots are obstacles too.

use super::reentry::with_ends;
use super::search::{avoids, shortest_path};
use super::{Disc, FreeSpace, Geodesic};
use crate::Point;

/// By how much, relatively, a disc around the start shrinks below the distance to it, so that the
/// start is outside.
const DISC_SHRINKAGE: f64 = 1e-9;

impl FreeSpace {
    /// A shortest path from `from` to `to` that keeps out of `obstacles`, `None` if there is none.
    ///
    /// Paths around a disc follow a regular octagon about it, one side of which faces `from`; where a wall or another
    /// disc leaves less room than that, they still lead through any gap. A disc that
    /// contains `to` is no obstacle (the robot comes to replace its occupant), and one that contains `from` is
    /// taken just small enough not to. Ends outside the free space are treated as by
    /// [`geodesic`](Self::geodesic); the way between them and the free space minds no obstacle.
    ///
    /// ```
    /// use pleach_continuous::Point;
    /// use pleach_continuous::geometry::{Disc, FreeSpace, Workspace};
    ///
    /// let corridor = [(0.0, 0.0), (9.0, 0.0), (9.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
    /// let free_space = FreeSpace::new(&Workspace::new(corridor.to_vec(), vec![])?, 0.1)?;
    /// let (from, to) = (Point::new(1.0, 0.5), Point::new(8.0, 0.5));
    /// let parked = |radius| [Disc { center: Point::new(4.0, 0.4), radius }];
    /// assert!(free_space.detour(from, to, &parked(0.3)).is_some());
    /// assert!(free_space.detour(from, to, &parked(0.5)).is_none()); // no room to pass
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn detour(&self, from: Point, to: Point, obstacles: &[Disc]) -> Option<Geodesic> {
        let (entry, exit) = (self.entry(from)?, self.entry(to)?);
        let path = self.detour_inside(entry, exit, obstacles)?;
        Some(with_ends(path, (from, entry), (exit, to)))
    }

    fn detour_inside(&self, from: Point, to: Point, obstacles: &[Disc]) -> Option<Geodesic> {
        let mut path = self.geodesic(from, to)?;
        let mut waiting: Vec<Disc> = obstacles
            .iter()
            .filter(|disc| !disc.contains(to))
            .map(|disc| outside_of(disc, from))
            .filter(|disc| disc.radius > 0.0)
            .collect();
        // Shortest among the paths around some of the discs: when it keeps out of all of them, it is
        // shortest among the paths around all. So only discs in the way cost anything.
        let mut considered: Vec<Disc> = Vec::new();
        loop {
            let in_the_way =
                |disc: &mut Disc| path.segments(from).any(|segment| !avoids(&segment, &[*disc]));
            let found: Vec<Disc> = waiting.extract_if(.., in_the_way).collect();
            if found.is_empty() {
                return Some(path);
            }
            considered.extend(found);
            path = shortest_path(self, from, to, &considered)?;
        }
    }
}

/// The disc, or what can be had of it without `point`.
fn outside_of(disc: &Disc, point: Point) -> Disc {
    let distance = (point - disc.center).norm() * (1.0 - DISC_SHRINKAGE);
    Disc { radius: disc.radius.min(distance), ..*disc }
}
