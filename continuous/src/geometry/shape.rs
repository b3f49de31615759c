//! The two convex shapes that bound a robot's next position: half-planes and discs.
//!
//! Each measures a point by its signed *margin*: the distance to the shape's boundary, positive
//! inside and negative outside.

use crate::{Point, Vector};

/// A closed half-plane {q : normal·q ≤ offset}.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPlane {
    /// Outward normal of unit length.
    pub normal: Vector,
    /// Signed distance of the boundary line from the origin along the normal.
    pub offset: f64,
}

impl HalfPlane {
    /// The half-plane normal·q ≤ offset, scaled such that its normal has length 1.
    ///
    /// A normal of length zero has no direction and is kept as it is: the set is then the whole
    /// plane if `offset` ≥ 0, and empty otherwise.
    pub fn new(normal: Vector, offset: f64) -> Self {
        let length = normal.norm();
        if length > 0.0 {
            Self { normal: normal / length, offset: offset / length }
        } else {
            Self { normal, offset }
        }
    }

    /// Signed distance from `point` to the boundary line, positive inside.
    pub fn margin(&self, point: &Point) -> f64 {
        self.offset - self.normal.dot(&point.coords)
    }

    /// Whether `point` lies inside or on the boundary.
    pub fn contains(&self, point: &Point) -> bool {
        self.margin(point) >= 0.0
    }
}

/// A closed disc {q : ‖q − center‖ ≤ radius}.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its center.
    pub center: Point,
    /// Its radius.
    pub radius: f64,
}

impl Disc {
    /// Signed distance from `point` to the circle, positive inside.
    pub fn margin(&self, point: &Point) -> f64 {
        self.radius - (point - self.center).norm()
    }

    /// Whether `point` lies inside or on the circle.
    pub fn contains(&self, point: &Point) -> bool {
        self.margin(point) >= 0.0
    }
}
