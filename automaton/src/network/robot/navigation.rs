//! Where a robot goes: its goal, and the corner on the way there that comes next.

use pleach_continuous::Point;
use pleach_continuous::geometry::{Destination, FreeSpace};

/// The goal of a robot, and how it goes there.
#[derive(Clone, Debug, Default)]
pub(super) struct Navigation {
    destination: Option<Destination>,
    waypoint: Option<Point>,
    /// Whether it follows a way that its link requires.
    goes_by_link: bool,
}

impl Navigation {
    /// The robot goes to `goal` from now on.
    pub(super) fn head_for(&mut self, goal: Point, free_space: &FreeSpace) {
        if self.destination.as_ref().is_none_or(|known| known.goal() != goal) {
            self.destination = Some(free_space.destination(goal));
            self.goes_by_link = false;
        }
    }

    /// The robot follows a way that its link requires, or does not.
    pub(super) const fn follow_link(&mut self, goes_by_link: bool) {
        self.goes_by_link = goes_by_link;
    }

    /// The robot goes to this corner next.
    pub(super) const fn turn_to(&mut self, waypoint: Point) {
        self.waypoint = Some(waypoint);
    }

    /// The robot goes nowhere; returns whether it went somewhere before.
    pub(super) fn stop(&mut self) -> bool {
        self.waypoint.take().is_some()
    }

    /// The goal, with the ways that lead there.
    pub(super) const fn destination(&self) -> Option<&Destination> {
        self.destination.as_ref()
    }

    /// The corner that comes next, where the robot goes somewhere.
    pub(super) const fn waypoint(&self) -> Option<Point> {
        self.waypoint
    }

    /// Whether the robot follows a way that its link requires.
    pub(super) const fn goes_by_link(&self) -> bool {
        self.goes_by_link
    }
}
