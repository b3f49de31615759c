//! Floor plans drawn as SVG: closed paths, rectangles, polygons and circles.

use super::outline::{Ring, floor, scaled};
use super::{MapPlaces, Plan, Reading};
use i_overlay::core::fill_rule::FillRule;
use kurbo::{Affine, BezPath, Circle, Ellipse, PathEl, Point, Rect, Shape};
use quick_xml::Reader;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;

/// Chords of curves deviate by this share of the extent where no tolerance is asked for.
const RELATIVE_TOLERANCE: f64 = 1e-3;

/// Reads all shapes, filled by the even-odd rule: what lies within an odd number of outlines is
/// floor. The vertical axis is turned, so that it points up.
pub(super) fn read(text: &str, reading: &Reading) -> Result<Plan, String> {
    let paths = paths(text)?;
    let bounds = paths.iter().map(Shape::bounding_box).reduce(|one, other| one.union(other));
    let bounds = bounds.ok_or("no floor: the drawing has no closed shape")?;
    let extent = bounds.width().max(bounds.height());
    let tolerance =
        reading.tolerance.map_or(RELATIVE_TOLERANCE * extent, |length| length / reading.scale);
    if tolerance <= 0.0 {
        return Err("curves need a tolerance above 0".into());
    }
    let has_curves = paths
        .iter()
        .flat_map(BezPath::iter)
        .any(|element| matches!(element, PathEl::QuadTo(..) | PathEl::CurveTo(..)));
    let upright =
        |ring: Ring| ring.into_iter().map(|[x, y]| [x - bounds.x0, bounds.y1 - y]).collect();
    let rings: Vec<Ring> = (paths.iter().flat_map(|path| rings(path, tolerance)))
        .map(|ring| scaled(upright(ring), reading.scale))
        .collect();
    let (workspace, mut notes) = floor(&rings, &[], FillRule::EvenOdd)?;
    if has_curves {
        notes.insert(
            0,
            format!(
                "chords of curves are at most {} away from them: choose a clearance larger by that",
                tolerance * reading.scale
            ),
        );
    }
    Ok(Plan { workspace, places: MapPlaces::default(), notes })
}

/// The closed rings of a path, curves as chords.
fn rings(path: &BezPath, tolerance: f64) -> Vec<Ring> {
    let mut rings: Vec<Ring> = Vec::new();
    kurbo::flatten(path.iter(), tolerance, |element| match element {
        PathEl::MoveTo(start) => rings.push(vec![[start.x, start.y]]),
        PathEl::LineTo(corner) => {
            if let Some(ring) = rings.last_mut() {
                ring.push([corner.x, corner.y]);
            }
        }
        _ => {}
    });
    for ring in &mut rings {
        ring.dedup();
        if ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
    }
    rings.retain(|ring| ring.len() > 2);
    rings
}

/// Every shape of the drawing, in its coordinates.
fn paths(text: &str) -> Result<Vec<BezPath>, String> {
    let mut reader = Reader::from_str(text);
    let mut transforms = vec![Affine::IDENTITY];
    let mut paths = Vec::new();
    loop {
        let at = reader.buffer_position();
        let wrong = |problem: String| format!("byte {at}: {problem}");
        match reader.read_event().map_err(|error| wrong(error.to_string()))? {
            Event::Eof => return Ok(paths),
            Event::Start(element) => {
                let outer = transforms.last().copied().unwrap_or_default();
                let element = Element::of(&element).map_err(wrong)?;
                let transform = outer * element.transform().map_err(wrong)?;
                paths.extend(element.path().map_err(wrong)?.map(|path| transform * path));
                transforms.push(transform);
            }
            Event::Empty(element) => {
                let outer = transforms.last().copied().unwrap_or_default();
                let element = Element::of(&element).map_err(wrong)?;
                let transform = outer * element.transform().map_err(wrong)?;
                paths.extend(element.path().map_err(wrong)?.map(|path| transform * path));
            }
            Event::End(_) => {
                transforms.pop();
            }
            _ => {}
        }
    }
}

/// An element with its attributes.
struct Element {
    name: String,
    attributes: BTreeMap<String, String>,
}

impl Element {
    fn of(start: &BytesStart<'_>) -> Result<Self, String> {
        let mut attributes = BTreeMap::new();
        for attribute in start.attributes() {
            let attribute = attribute.map_err(|error| error.to_string())?;
            let value = attribute.normalized_value(XmlVersion::Implicit1_0);
            let value = value.map_err(|error| error.to_string())?;
            attributes.insert(attribute.key.as_ref().to_owned(), value.into_owned());
        }
        Ok(Self { name: start.local_name().as_ref().to_owned(), attributes })
    }

    fn transform(&self) -> Result<Affine, String> {
        let Some(text) = self.attributes.get("transform") else { return Ok(Affine::IDENTITY) };
        let transform: svgtypes::Transform =
            text.parse().map_err(|error| format!("transform {text:?}: {error}"))?;
        let svgtypes::Transform { a, b, c, d, e, f } = transform;
        Ok(Affine::new([a, b, c, d, e, f]))
    }

    /// The outline of a shape; none for other elements.
    fn path(&self) -> Result<Option<BezPath>, String> {
        // Circles become curves; those are as exact as can be before chords replace them.
        const EXACT: f64 = 1e-6;
        let path = match self.name.as_str() {
            "path" => {
                let data = self.attributes.get("d").map_or("", String::as_str);
                BezPath::from_svg(data).map_err(|error| format!("path: {error}"))?
            }
            "rect" => {
                let [x, y] = [self.number("x", Some(0.0))?, self.number("y", Some(0.0))?];
                let [width, height] = [self.number("width", None)?, self.number("height", None)?];
                Rect::new(x, y, x + width, y + height).to_path(EXACT)
            }
            "circle" => {
                let radius = self.number("r", None)?;
                Circle::new(self.centre()?, radius).to_path(EXACT * radius.abs())
            }
            "ellipse" => {
                let [rx, ry] = [self.number("rx", None)?, self.number("ry", None)?];
                Ellipse::new(self.centre()?, (rx, ry), 0.0).to_path(EXACT * rx.abs().max(ry.abs()))
            }
            "polygon" => self.polygon()?,
            _ => return Ok(None),
        };
        Ok(Some(path))
    }

    fn centre(&self) -> Result<Point, String> {
        Ok(Point::new(self.number("cx", Some(0.0))?, self.number("cy", Some(0.0))?))
    }

    fn polygon(&self) -> Result<BezPath, String> {
        let text = self.attributes.get("points").map_or("", String::as_str);
        let words = text.split([' ', ',', '\t', '\n', '\r']).filter(|word| !word.is_empty());
        let numbers: Result<Vec<f64>, _> = words.map(str::parse).collect();
        let numbers = numbers.map_err(|_| format!("points {text:?} are no numbers"))?;
        let mut path = BezPath::new();
        for (index, corner) in numbers.chunks_exact(2).enumerate() {
            let corner = (corner[0], corner[1]);
            if index == 0 { path.move_to(corner) } else { path.line_to(corner) }
        }
        path.close_path();
        Ok(path)
    }

    /// A length without a unit, or in user units (`px`).
    fn number(&self, name: &str, default: Option<f64>) -> Result<f64, String> {
        match (self.attributes.get(name), default) {
            (Some(text), _) => (text.trim_end_matches("px").trim().parse())
                .map_err(|_| format!("{name} of {} is {text:?}: give a number", self.name)),
            (None, Some(default)) => Ok(default),
            (None, None) => Err(format!("{} has no {name}", self.name)),
        }
    }
}
