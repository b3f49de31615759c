//! Points slightly outside the free space, and the way back in.
//!
//! A robot whose position or motion is not exact is at times a little outside 𝒲_f. It is then not
//! lost: within the *reach* of re-entry (see [`FreeSpace::with_reach`]) it counts as standing at
//! its nearest free point q, and every question about it is answered from there.
//!
//! # It never gets farther out
//!
//! Let the robot be at p, at the distance |p − q| from free space.
//!
//! - The segment from p to q stays in 𝒲: the reach is less than ρ + τ, and the disc of that radius
//!   around q, a point of the planning set, lies in 𝒲.
//! - If q sees a free point z, the robot may walk straight from p to z: the point at share t of
//!   that way is at the distance (1 − t)|p − q| from the point at share t of the way from q to z,
//!   which is free. So it comes steadily closer to free space, and its clearance from ∂W never
//!   falls below ρ − |p − q|.
//! - The same holds for every z in a convex free set that contains q, hence for the convex hull
//!   of such a set and p: that is the region of [`convex_region`](super::convex_region).

use super::{FreeSpace, FreeSpaceError, Geodesic};
use crate::Point;

impl FreeSpace {
    /// The same free space with another reach: the distance from the planning set up to which a
    /// point outside counts as about to re-enter. It must be less than ρ + τ; [`FreeSpace::new`]
    /// takes half of that.
    ///
    /// A robot whose position is known up to e_p and that follows its moves up to e_m strays by at
    /// most e_p + e_m.
    ///
    /// # Errors
    ///
    /// [`FreeSpaceError::InvalidReach`] if the reach is negative, not a number or too long: from
    /// farther out the way back could lead through a wall.
    ///
    /// ```
    /// use pleach_continuous::Point;
    /// use pleach_continuous::geometry::{FreeSpace, Workspace};
    ///
    /// let room = [(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)].map(|(x, y)| Point::new(x, y));
    /// let workspace = Workspace::new(room.to_vec(), vec![])?;
    /// let free_space = FreeSpace::new(&workspace, 0.1)?.with_reach(0.02)?;
    ///
    /// let (strayed, goal) = (Point::new(1.0, 0.09), Point::new(3.0, 1.0));
    /// assert!(!free_space.contains(strayed));
    /// let path = free_space.geodesic(strayed, goal).ok_or("too far out")?;
    /// assert_eq!(path.waypoints, [free_space.nearest(strayed), goal]);
    /// assert_eq!(free_space.geodesic(Point::new(1.0, 0.07), goal), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_reach(mut self, reach: f64) -> Result<FreeSpace, FreeSpaceError> {
        let limit = self.clearance() + self.tolerance();
        if reach >= 0.0 && reach < limit {
            self.reach = reach;
            Ok(self)
        } else {
            Err(FreeSpaceError::InvalidReach { reach, limit })
        }
    }

    /// The distance from free space up to which a point outside counts as about to re-enter.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The free point that a robot at `point` counts as standing at: the point itself if it is
    /// free, the nearest point of the planning set if that is within the reach, otherwise `None`.
    pub fn entry(&self, point: Point) -> Option<Point> {
        if self.contains(point) {
            return Some(point);
        }
        let nearest = self.nearest(point);
        ((nearest - point).norm() <= self.reach).then_some(nearest)
    }
}

/// The path through free space between two entries, extended to where the robot and its goal are.
pub(super) fn with_ends(
    path: Geodesic,
    (from, entry): (Point, Point),
    (exit, to): (Point, Point),
) -> Geodesic {
    if from == to {
        return Geodesic::new(from, vec![to]);
    }
    let mut path = path;
    if entry != from {
        path.length += (entry - from).norm();
        if path.waypoints.first() != Some(&entry) {
            path.waypoints.insert(0, entry);
        }
    }
    if exit != to {
        path.length += (to - exit).norm();
        path.waypoints.push(to);
    }
    path
}
