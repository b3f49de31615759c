//! Longitudes and latitudes as metres.

use super::Reading;
use super::features::{Feature, Shape};
use crate::figures::quantity;

/// The radius of the Earth in metres (mean radius of WGS 84).
const EARTH: f64 = 6_371_008.8;
/// In degrees no floor is larger: 55 km.
const LARGEST: f64 = 0.5;

/// How coordinates become lengths.
pub(super) enum Projection {
    /// They are lengths.
    None { is_told: bool },
    /// They are degrees, and become metres on the plane that touches the Earth in the middle of the map.
    Around { longitude: f64, latitude: f64 },
}

impl Projection {
    /// Coordinates are degrees unless it is said that they are lengths, or they cannot be degrees of a floor.
    pub(super) fn of(features: &[Feature], reading: &Reading) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for place in features.iter().flat_map(places) {
            low = [0, 1].map(|axis| low[axis].min(place[axis]));
            high = [0, 1].map(|axis| high[axis].max(place[axis]));
        }
        let is_on_earth =
            low[0] >= -180.0 && high[0] <= 180.0 && low[1] >= -90.0 && high[1] <= 90.0;
        let extent = (high[0] - low[0]).max(high[1] - low[1]);
        if reading.planar || !is_on_earth || extent > LARGEST {
            return Self::None { is_told: !reading.planar };
        }
        let [longitude, latitude] = [0, 1].map(|axis| (low[axis] + high[axis]) / 2.0);
        Self::Around { longitude, latitude }
    }

    /// The features with their places as lengths of the result, and what is to be said about it.
    pub(super) fn apply(
        &self,
        features: Vec<Feature>,
        reading: &Reading,
    ) -> (Vec<Feature>, Option<String>) {
        let note = match *self {
            Self::None { is_told } => is_told.then(|| {
                "coordinates are taken as lengths: in degrees they would span more than 50 km"
                    .to_owned()
            }),
            Self::Around { longitude, latitude } => Some(format!(
                "degrees became metres around longitude {}, latitude {}: --planar takes them as lengths",
                quantity(longitude),
                quantity(latitude)
            )),
        };
        let moved = |place: &[f64; 2]| self.length(*place).map(|length| reading.scale * length);
        let moved_ring = |ring: &Vec<[f64; 2]>| ring.iter().map(moved).collect();
        let features = features.into_iter().map(|Feature { properties, shape }| {
            let shape = match shape {
                Shape::Polygon(rings) => Shape::Polygon(rings.iter().map(moved_ring).collect()),
                Shape::Line(corners) => Shape::Line(moved_ring(&corners)),
                Shape::Point(place) => Shape::Point(moved(&place)),
            };
            Feature { properties, shape }
        });
        (features.collect(), note)
    }

    fn length(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        match *self {
            Self::None { .. } => [x, y],
            Self::Around { longitude, latitude } => {
                let shrinking = latitude.to_radians().cos();
                let east = (x - longitude).to_radians() * shrinking * EARTH;
                [east, (y - latitude).to_radians() * EARTH]
            }
        }
    }
}

fn places(feature: &Feature) -> Vec<[f64; 2]> {
    match &feature.shape {
        Shape::Polygon(rings) => rings.concat(),
        Shape::Line(corners) => corners.clone(),
        Shape::Point(place) => vec![*place],
    }
}
