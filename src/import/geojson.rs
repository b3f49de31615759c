//! Floor plans in GeoJSON (RFC 7946).

use super::outline::{Ring, floor, oriented, scaled};
use super::{MapPlaces, Plan, Reading, counted};
use crate::figures::quantity;
use geojson::{Feature, FeatureCollection, GeoJson, Geometry, GeometryValue, Position};
use i_overlay::core::fill_rule::FillRule;
use std::collections::BTreeSet;

/// The radius of the Earth in metres (mean radius of WGS 84).
const EARTH: f64 = 6_371_008.8;

/// Polygons, and points with a kind.
#[derive(Default)]
struct Found {
    floors: Vec<Ring>,
    walls: Vec<Ring>,
    places: MapPlaces,
    ignored: usize,
    /// The kinds of polygons that are neither floor nor wall.
    other_kinds: BTreeSet<String>,
}

/// Reads polygons as floor or walls, and points of the kinds `access_point`, `robot` and `task`.
pub(super) fn read(text: &str, reading: &Reading) -> Result<Plan, String> {
    let map: GeoJson = text.parse().map_err(|error| format!("{error}"))?;
    let mut found = Found::default();
    match map {
        GeoJson::Geometry(geometry) => found.add(&geometry, ""),
        GeoJson::Feature(feature) => found.add_feature(&feature),
        GeoJson::FeatureCollection(FeatureCollection { features, .. }) => {
            features.iter().for_each(|feature| found.add_feature(feature));
        }
    }
    if found.floors.iter().all(Vec::is_empty) {
        return Err("no floor: the map has no polygon but walls".into());
    }
    let mut notes = Vec::new();
    let projection = match reading.planar {
        true => None,
        false => Some(Projection::around(&found)?),
    };
    let place = |points: Ring| match &projection {
        None => scaled(points, reading.scale),
        Some(projection) => {
            scaled(points.into_iter().map(|point| projection.of(point)).collect(), reading.scale)
        }
    };
    if let Some(Projection { longitude, latitude, .. }) = &projection {
        notes.push(format!(
            "degrees became metres around longitude {}, latitude {}",
            quantity(*longitude),
            quantity(*latitude)
        ));
    }
    if found.ignored > 0 {
        let ignored = counted(found.ignored, "geometry that is", "geometries that are");
        notes.push(format!("left out: {ignored} no polygon and no point of a known kind"));
    }
    for kind in &found.other_kinds {
        notes.push(format!(
            "polygons of the kind {kind:?} are taken as floor; walls have the kind \"wall\" or \"obstacle\""
        ));
    }
    let Found { floors, walls, places, .. } = found;
    let [floors, walls] =
        [floors, walls].map(|rings| rings.into_iter().map(place).collect::<Vec<_>>());
    let (workspace, left_out) = floor(&floors, &walls, FillRule::NonZero)?;
    notes.extend(left_out);
    let places = MapPlaces {
        access_points: place(places.access_points),
        robots: place(places.robots),
        tasks: place(places.tasks),
    };
    Ok(Plan { workspace, places, notes })
}

impl Found {
    fn add_feature(&mut self, feature: &Feature) {
        let kind = feature.property("kind").and_then(|kind| kind.as_str()).unwrap_or_default();
        if let Some(geometry) = &feature.geometry {
            self.add(geometry, kind);
        }
    }

    fn add(&mut self, geometry: &Geometry, kind: &str) {
        match &geometry.value {
            GeometryValue::Polygon { coordinates } => self.add_polygon(coordinates, kind),
            GeometryValue::MultiPolygon { coordinates } => {
                coordinates.iter().for_each(|polygon| self.add_polygon(polygon, kind));
            }
            GeometryValue::Point { coordinates } => {
                let places = match kind {
                    "access_point" => &mut self.places.access_points,
                    "robot" => &mut self.places.robots,
                    "task" => &mut self.places.tasks,
                    _ => {
                        self.ignored += 1;
                        return;
                    }
                };
                places.extend(point(coordinates));
            }
            GeometryValue::GeometryCollection { geometries } => {
                geometries.iter().for_each(|geometry| self.add(geometry, kind));
            }
            _ => self.ignored += 1,
        }
    }

    fn add_polygon(&mut self, polygon: &[Vec<Position>], kind: &str) {
        // GeoJSON closes its rings; of one that is left open no corner may be lost.
        let ring = |positions: &Vec<Position>| {
            let mut ring: Ring = positions.iter().filter_map(point).collect();
            if ring.len() > 1 && ring.first() == ring.last() {
                ring.pop();
            }
            ring
        };
        let rings = oriented(polygon.iter().map(ring).collect());
        match kind {
            "wall" | "obstacle" => self.walls.extend(rings),
            "" | "floor" => self.floors.extend(rings),
            other => {
                self.other_kinds.insert(other.to_owned());
                self.floors.extend(rings);
            }
        }
    }
}

fn point(position: &Position) -> Option<[f64; 2]> {
    match *position.as_slice() {
        [x, y, ..] => Some([x, y]),
        _ => None,
    }
}

/// Degrees as metres on the plane that touches the Earth in the middle of the map.
struct Projection {
    longitude: f64,
    latitude: f64,
    shrinking: f64,
}

impl Projection {
    fn around(found: &Found) -> Result<Self, String> {
        let corners = found.floors.iter().flatten();
        let (low, high) =
            corners.fold(([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]), |(low, high), corner| {
                (
                    [0, 1].map(|axis| low[axis].min(corner[axis])),
                    [0, 1].map(|axis| high[axis].max(corner[axis])),
                )
            });
        if low[0] < -180.0 || high[0] > 180.0 || low[1] < -90.0 || high[1] > 90.0 {
            return Err(
                "the coordinates are no degrees of longitude and latitude: give --planar if they \
                 are lengths"
                    .into(),
            );
        }
        let [longitude, latitude] = [0, 1].map(|axis| (low[axis] + high[axis]) / 2.0);
        Ok(Self { longitude, latitude, shrinking: latitude.to_radians().cos() })
    }

    fn of(&self, [longitude, latitude]: [f64; 2]) -> [f64; 2] {
        let east = (longitude - self.longitude).to_radians() * self.shrinking * EARTH;
        [east, (latitude - self.latitude).to_radians() * EARTH]
    }
}
