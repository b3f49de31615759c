//! Floor plans in GeoJSON (RFC 7946).

use super::features::{Feature, Shape};
use super::outline::Ring;
use super::projection::Projection;
use super::{Plan, Reading, survey};
use geojson::{FeatureCollection, GeoJson, Geometry, GeometryValue, JsonObject, Position};
use std::collections::BTreeMap;

/// Reads features by their properties.
pub(super) fn read(text: &str, reading: &Reading) -> Result<Plan, String> {
    let map: GeoJson = text.parse().map_err(|error| format!("{error}"))?;
    let mut found = Vec::new();
    match map {
        GeoJson::Geometry(geometry) => add(&mut found, &geometry, &BTreeMap::new()),
        GeoJson::Feature(feature) => add_feature(&mut found, &feature),
        GeoJson::FeatureCollection(FeatureCollection { features, .. }) => {
            features.iter().for_each(|feature| add_feature(&mut found, feature));
        }
    }
    let (found, note) = Projection::of(&found, reading).apply(found, reading);
    let mut plan = survey::plan(found, reading)?;
    plan.notes.extend(note);
    Ok(plan)
}

fn add_feature(found: &mut Vec<Feature>, feature: &geojson::Feature) {
    let mut properties = BTreeMap::new();
    if let Some(stated) = &feature.properties {
        flatten(&mut properties, stated);
    }
    if let Some(geometry) = &feature.geometry {
        add(found, geometry, &properties);
    }
}

/// Properties as texts. Some programs state the tags of OpenStreetMap in an object of their own.
fn flatten(properties: &mut BTreeMap<String, String>, stated: &JsonObject) {
    for (key, value) in stated {
        match value {
            serde_json::Value::Object(tags) => flatten(properties, tags),
            serde_json::Value::String(text) => {
                properties.insert(key.clone(), text.clone());
            }
            serde_json::Value::Null => {}
            other => {
                properties.insert(key.clone(), other.to_string());
            }
        }
    }
}

fn add(found: &mut Vec<Feature>, geometry: &Geometry, properties: &BTreeMap<String, String>) {
    let mut push = |shape| found.push(Feature { properties: properties.clone(), shape });
    match &geometry.value {
        GeometryValue::Polygon { coordinates } => push(polygon(coordinates)),
        GeometryValue::MultiPolygon { coordinates } => {
            coordinates.iter().map(|it| polygon(it)).for_each(push)
        }
        GeometryValue::LineString { coordinates } => push(line(coordinates)),
        GeometryValue::MultiLineString { coordinates } => {
            coordinates.iter().map(|it| line(it)).for_each(push)
        }
        GeometryValue::Point { coordinates } => {
            point(coordinates).map(Shape::Point).into_iter().for_each(push)
        }
        GeometryValue::MultiPoint { coordinates } => {
            coordinates.iter().filter_map(point).map(Shape::Point).for_each(push);
        }
        GeometryValue::GeometryCollection { geometries } => {
            geometries.iter().for_each(|geometry| add(found, geometry, properties));
        }
    }
}

fn polygon(rings: &[Vec<Position>]) -> Shape {
    // GeoJSON closes its rings; of one that is left open no corner may be lost.
    let ring = |positions: &Vec<Position>| {
        let mut ring: Ring = positions.iter().filter_map(point).collect();
        if ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        ring
    };
    Shape::Polygon(rings.iter().map(ring).collect())
}

fn line(positions: &[Position]) -> Shape {
    Shape::Line(positions.iter().filter_map(point).collect())
}

fn point(position: &Position) -> Option<[f64; 2]> {
    match *position.as_slice() {
        [x, y, ..] => Some([x, y]),
        _ => None,
    }
}
