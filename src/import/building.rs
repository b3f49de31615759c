//! Buildings as the traffic editor of Open-RMF writes them: walls between vertices of a drawing.

use super::features::{Feature, Shape};
use super::{Plan, Reading, survey};
use crate::figures::quantity;
use serde::Deserialize;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// A level: places in pixels of its drawing, whose second axis points down.
#[derive(Deserialize)]
struct Level {
    vertices: Vec<Vertex>,
    #[serde(default)]
    walls: Vec<Edge>,
    #[serde(default)]
    doors: Vec<Edge>,
    #[serde(default)]
    floors: Vec<Floor>,
    #[serde(default)]
    measurements: Vec<Edge>,
}

/// x, y, height, and perhaps a name and more.
#[derive(Deserialize)]
#[serde(from = "Vec<Value>")]
struct Vertex {
    place: Option<[f64; 2]>,
    name: String,
}

impl From<Vec<Value>> for Vertex {
    fn from(list: Vec<Value>) -> Self {
        let number = |index: usize| list.get(index)?.as_f64();
        let place = number(0).zip(number(1)).map(|(x, y)| [x, -y]);
        Self { place, name: list.get(3).and_then(Value::as_str).unwrap_or_default().into() }
    }
}

/// From vertex to vertex, with parameters.
#[derive(Deserialize)]
struct Edge(usize, usize, #[serde(default)] Map<String, Value>);

#[derive(Deserialize)]
struct Floor {
    vertices: Vec<usize>,
}

/// Whether a YAML file describes a building.
pub(super) fn is_one(keys: &Value) -> bool {
    keys["levels"].is_object()
}

/// Reads the walls, doors, floors and named vertices of a level, in metres by its measurements.
pub(super) fn read(keys: &Value, reading: &Reading) -> Result<Plan, String> {
    if keys["coordinate_system"].as_str().is_some_and(|system| system != "reference_image") {
        return Err(
            "coordinate_system: only buildings in pixels of a reference image are read".into()
        );
    }
    let levels = keys["levels"].as_object().ok_or("levels is no map of levels")?;
    let names: Vec<&str> = levels.keys().map(String::as_str).collect();
    let name = match (reading.level.as_deref(), names.as_slice()) {
        (Some(level), _) if names.contains(&level) => level,
        (None, [only]) => only,
        (None, _) => {
            return Err(format!(
                "the building has the levels {}: choose one with --level",
                names.join(", ")
            ));
        }
        (Some(level), _) => {
            return Err(format!("the building has no level {level}: it has {}", names.join(", ")));
        }
    };
    let wrong = |error: serde_json::Error| format!("levels.{name}: {error}");
    let level: Level = serde_json::from_value(levels[name].clone()).map_err(wrong)?;
    let (pixel, note) = level.pixel()?;
    let features = level
        .features(pixel * reading.scale)
        .map_err(|problem| format!("levels.{name}: {problem}"))?;
    let reading = Reading { level: None, ..reading.clone() };
    let mut plan = survey::plan(features, &reading)?;
    plan.notes.push(note);
    Ok(plan)
}

impl Level {
    /// The side of a pixel in metres, the mean of all measurements.
    fn pixel(&self) -> Result<(f64, String), String> {
        let sides = self.measurements.iter().map(|Edge(from, to, parameters)| {
            let [a, b] = [self.place(*from)?, self.place(*to)?];
            let stated = parameters.get("distance").map(parameter).and_then(Value::as_f64);
            let distance = stated.ok_or("a measurement states no distance")?;
            Ok(distance / (b[0] - a[0]).hypot(b[1] - a[1]))
        });
        let sides = sides.collect::<Result<Vec<f64>, String>>()?;
        if sides.is_empty() {
            return Ok((
                1.0,
                "the level has no measurement: lengths are pixels; --scale gives the side of one"
                    .into(),
            ));
        }
        let mean = sides.iter().sum::<f64>() / sides.len() as f64;
        match mean.is_finite() && mean > 0.0 {
            true => Ok((mean, format!("by its measurements a pixel is {} wide", quantity(mean)))),
            false => Err("the measurements give no length of a pixel: their vertices are apart and distances positive".into()),
        }
    }

    fn place(&self, vertex: usize) -> Result<[f64; 2], String> {
        let count = self.vertices.len();
        let vertex = self
            .vertices
            .get(vertex)
            .ok_or_else(|| format!("vertex {vertex} is named, of {count}"))?;
        vertex.place.ok_or_else(|| "a vertex states no two numbers".into())
    }

    fn features(&self, scale: f64) -> Result<Vec<Feature>, String> {
        let place = |vertex: usize| Ok(self.place(vertex)?.map(|value| value * scale));
        let feature = |kind: &str, shape| Feature {
            properties: BTreeMap::from([("kind".to_owned(), kind.to_owned())]),
            shape,
        };
        let mut features = Vec::new();
        for (kind, edges) in [("wall", &self.walls), ("door", &self.doors)] {
            for Edge(from, to, _) in edges {
                features.push(feature(kind, Shape::Line(vec![place(*from)?, place(*to)?])));
            }
        }
        for floor in &self.floors {
            let ring = floor
                .vertices
                .iter()
                .map(|&vertex| place(vertex))
                .collect::<Result<_, String>>()?;
            features.push(feature("floor", Shape::Polygon(vec![ring])));
        }
        for (index, vertex) in
            self.vertices.iter().enumerate().filter(|(_, vertex)| !vertex.name.is_empty())
        {
            let properties = BTreeMap::from([("name".to_owned(), vertex.name.clone())]);
            features.push(Feature { properties, shape: Shape::Point(place(index)?) });
        }
        Ok(features)
    }
}

/// The value of a parameter, which is written with the number of its type: `[3, 12.0]`.
fn parameter(stated: &Value) -> &Value {
    stated.get(1).unwrap_or(stated)
}
