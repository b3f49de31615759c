//! Indoor maps as OpenStreetMap stores them: nodes, and ways along nodes, with tags.

use super::features::{Feature, Shape};
use super::outline::Ring;
use super::projection::Projection;
use super::{Plan, Reading, counted, finite, survey};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::collections::BTreeMap;

/// What the element that is being read is, and the tags and nodes that it has so far.
#[derive(Default)]
struct Open {
    tags: BTreeMap<String, String>,
    /// Its place, if it is a node.
    place: Option<[f64; 2]>,
    /// Its corners, if it is a way.
    corners: Ring,
}

/// Reads nodes and ways by their tags; a way that ends where it starts is an area where its tags say floor or room, or
/// `area=yes`.
pub(super) fn read(text: &str, reading: &Reading) -> Result<Plan, String> {
    let (features, relations) = features(text)?;
    let (features, note) = Projection::of(&features, reading).apply(features, reading);
    let mut plan = survey::plan(features, reading)?;
    plan.notes.extend(note);
    if relations > 0 {
        plan.notes.push(format!("left out: {}", counted(relations, "relation", "relations")));
    }
    Ok(plan)
}

fn features(text: &str) -> Result<(Vec<Feature>, usize), String> {
    let mut reader = Reader::from_str(text);
    let mut places: BTreeMap<String, [f64; 2]> = BTreeMap::new();
    let (mut found, mut relations, mut open) = (Vec::new(), 0, Open::default());
    loop {
        let byte = reader.buffer_position();
        let wrong = |problem: String| format!("byte {byte}: {problem}");
        let event = reader.read_event().map_err(|error| wrong(error.to_string()))?;
        let (start, is_whole) = match &event {
            Event::Start(start) => (start, false),
            Event::Empty(start) => (start, true),
            Event::End(end) => {
                close(end.local_name().as_ref(), &mut open, &mut found);
                continue;
            }
            Event::Eof => return Ok((found, relations)),
            _ => continue,
        };
        let attributes = attributes(start).map_err(wrong)?;
        let attribute = |name: &str| attributes.get(name).map(String::as_str).unwrap_or_default();
        match start.local_name().as_ref() {
            "node" => {
                let place =
                    finite(attribute("lon")).zip(finite(attribute("lat"))).map(|(x, y)| [x, y]);
                places.extend(place.map(|place| (attribute("id").to_owned(), place)));
                open = Open { place, ..Open::default() };
            }
            "way" => open = Open::default(),
            "relation" => {
                relations += 1;
                open = Open::default();
            }
            "nd" => {
                let node = places.get(attribute("ref"));
                let node = node.ok_or_else(|| {
                    wrong(format!("node {} is not in the file", attribute("ref")))
                })?;
                open.corners.push(*node);
            }
            "tag" => {
                open.tags.insert(attribute("k").to_owned(), attribute("v").to_owned());
            }
            _ => {}
        }
        if is_whole {
            close(start.local_name().as_ref(), &mut open, &mut found);
        }
    }
}

/// Takes a node or a way that has ended and has tags.
fn close(element: &str, open: &mut Open, found: &mut Vec<Feature>) {
    if !matches!(element, "node" | "way" | "relation") {
        return;
    }
    let Open { tags, place, mut corners } = std::mem::take(open);
    let is_area =
        tags.get("area").is_some_and(|area| area == "yes") && corners.first() == corners.last();
    let shape = match (place, corners.len()) {
        (Some(place), _) => Shape::Point(place),
        (None, 0 | 1) => return,
        (None, _) if is_area => {
            corners.pop();
            Shape::Polygon(vec![corners])
        }
        (None, _) => Shape::Line(corners),
    };
    if !tags.is_empty() {
        found.push(Feature { properties: tags, shape });
    }
}

fn attributes(start: &BytesStart<'_>) -> Result<BTreeMap<String, String>, String> {
    let attributes = start.attributes().map(|attribute| {
        let attribute = attribute.map_err(|error| error.to_string())?;
        let value = attribute.normalized_value(XmlVersion::Implicit1_0);
        let value = value.map_err(|error| error.to_string())?;
        Ok((attribute.key.as_ref().to_owned(), value.into_owned()))
    });
    attributes.collect()
}
