//! Discs, capsules and half-planes.

use nalgebra::Unit;

use super::Segment;
use crate::{Point, Vector};

/// The points within `radius` of `center`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// The centre.
    pub center: Point,
    /// The radius, a length; a disc of negative radius is empty.
    pub radius: f64,
}

impl Disc {
    /// Whether `point` lies in the disc, its rim included.
    pub fn contains(&self, point: Point) -> bool {
        (point - self.center).norm() <= self.radius
    }

    /// Signed distance from `point` to the rim: positive inside, negative outside.
    pub fn margin(&self, point: Point) -> f64 {
        self.radius - (point - self.center).norm()
    }

    /// Distance from the rim to the nearest point of `segment`; negative where the segment enters
    /// the disc.
    pub(super) fn gap(&self, segment: &Segment) -> f64 {
        segment.distance(self.center) - self.radius
    }

    /// Where the rim crosses `segment`: at most two points; none if the segment is a single point.
    pub(super) fn crossings(&self, segment: &Segment) -> impl Iterator<Item = Point> + use<> {
        let (from, along) = (segment.from, segment.vector());
        let square = along.norm_squared();
        let foot = along.dot(&(self.center - from)) / square;
        let away = (from + along * foot - self.center).norm_squared();
        let half = ((self.radius * self.radius - away) / square).sqrt();
        // Where they do not meet, these are not numbers.
        [foot - half, foot + half]
            .into_iter()
            .filter(|share| (0.0..=1.0).contains(share))
            .map(move |share| from + along * share)
    }

    /// Where the rims of two discs cross: at most two points; none if the discs have the same centre.
    pub(super) fn crossings_with(&self, other: &Disc) -> impl Iterator<Item = Point> + use<> {
        let (center, apart) = (self.center, other.center - self.center);
        let distance = apart.norm();
        let square = |radius: f64| radius * radius;
        let along =
            (square(distance) + square(self.radius) - square(other.radius)) / (2.0 * distance);
        let aside = (square(self.radius) - square(along)).sqrt();
        let (ahead, left) = (apart / distance, Vector::new(-apart.y, apart.x) / distance);
        let sides = [aside, -aside].into_iter().filter(|aside| aside.is_finite());
        sides.map(move |aside| center + ahead * along + left * aside)
    }
}

/// The points within `radius` of a segment: where a robot may be that follows the segment up to
/// an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// The segment.
    pub axis: Segment,
    /// The radius, a length ≥ 0.
    pub radius: f64,
}

impl Capsule {
    /// Whether `point` lies in the capsule, its rim included.
    pub fn contains(&self, point: Point) -> bool {
        self.axis.distance(point) <= self.radius
    }

    /// Distance between two capsules; 0 or less if they meet.
    pub fn gap(&self, other: &Capsule) -> f64 {
        self.axis.distance_to(&other.axis) - self.radius - other.radius
    }
}

impl From<Segment> for Capsule {
    /// The segment alone.
    fn from(axis: Segment) -> Capsule {
        Capsule { axis, radius: 0.0 }
    }
}

/// The points `q` with `normal · q ≤ offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlane {
    /// Direction that leads out of the half-plane.
    pub normal: Unit<Vector>,
    /// Signed distance from the origin to the border, along the normal.
    pub offset: f64,
}

impl HalfPlane {
    /// The half-plane with `point` on its border, which `outward` leads out of; `None` if
    /// `outward` has no direction.
    pub fn through(point: Point, outward: Vector) -> Option<HalfPlane> {
        let normal = Unit::try_new(outward, 0.0)?;
        Some(HalfPlane { normal, offset: along(normal, point) })
    }

    /// The half-plane `normal · q ≤ offset`, for a normal of any length but zero.
    pub fn new(normal: Vector, offset: f64) -> HalfPlane {
        let (normal, length) = Unit::new_and_get(normal);
        HalfPlane { normal, offset: offset / length }
    }

    /// Signed distance from `point` to the border: positive inside, negative outside.
    pub fn margin(&self, point: Point) -> f64 {
        self.offset - along(self.normal, point)
    }

    /// Whether `point` lies in the half-plane, its border included.
    pub fn contains(&self, point: Point) -> bool {
        self.margin(point) >= 0.0
    }

    /// The smallest half-plane with the same border direction that contains this one and `point`.
    pub(super) fn widened_to(self, point: Point) -> HalfPlane {
        HalfPlane { offset: self.offset.max(along(self.normal, point)), ..self }
    }
}

/// normal · point, written out: a model checker takes long over a product that is made for
/// vectors of any length.
fn along(normal: Unit<Vector>, point: Point) -> f64 {
    normal.x * point.x + normal.y * point.y
}
