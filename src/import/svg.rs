//! Floor plans drawn as SVG: closed paths, rectangles, polygons and circles.

use super::outline::{Ring, floor, scaled};
use super::{MapPlaces, Plan, Reading, counted};
use crate::figures::quantity;
use i_overlay::core::fill_rule::FillRule;
use kurbo::{Affine, BezPath, Circle, Ellipse, PathEl, Point, Rect, Shape};
use quick_xml::Reader;
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;

/// Chords of curves deviate by this share of the extent where no tolerance is asked for.
const RELATIVE_TOLERANCE: f64 = 1e-3;
/// The least share of the extent that can be asked for: coordinates are rounded to as much.
const LEAST_TOLERANCE: f64 = 1e-6;
/// Elements that draw nothing where they stand.
const NOT_DRAWN: [&str; 6] = ["clipPath", "defs", "marker", "mask", "pattern", "symbol"];

const NO_FLOOR: &str = "no floor: the drawing has no closed shape with an area";

/// Reads all shapes, filled by the even-odd rule: what lies within an odd number of outlines is
/// floor. The vertical axis is turned, so that it points up.
pub(super) fn read(text: &str, reading: &Reading) -> Result<Plan, String> {
    let paths = paths(text)?;
    let bounds = paths.iter().map(Shape::bounding_box).reduce(|one, other| one.union(other));
    let bounds = bounds.ok_or(NO_FLOOR)?;
    let extent = bounds.width().max(bounds.height());
    if extent == 0.0 {
        return Err(NO_FLOOR.into());
    }
    let tolerance =
        reading.tolerance.map_or(RELATIVE_TOLERANCE * extent, |length| length / reading.scale);
    if tolerance.is_nan() || tolerance < LEAST_TOLERANCE * extent {
        let [given, least] = [tolerance, LEAST_TOLERANCE * extent].map(|t| t * reading.scale);
        return Err(format!("the tolerance of curves is {given}: at least {}", quantity(least)));
    }
    let has_curves = paths
        .iter()
        .flat_map(BezPath::iter)
        .any(|element| matches!(element, PathEl::QuadTo(..) | PathEl::CurveTo(..)));
    let upright =
        |ring: Ring| ring.into_iter().map(|[x, y]| [x - bounds.x0, bounds.y1 - y]).collect();
    let (closed, open): (Vec<Line>, Vec<Line>) =
        paths.iter().flat_map(|path| lines(path, tolerance)).partition(|line| line.is_closed);
    let rings = closed.into_iter().map(|line| scaled(upright(line.corners), reading.scale));
    let rings: Vec<Ring> = rings.filter(|ring: &Ring| ring.len() > 2).collect();
    let (workspace, left_out) = floor(&rings, &[], FillRule::EvenOdd)?;
    let mut notes = Vec::new();
    if has_curves {
        notes.push(format!(
            "chords of curves are at most {} away from them: choose a clearance larger by that",
            quantity(tolerance * reading.scale)
        ));
    }
    if !open.is_empty() {
        let lines = counted(open.len(), "line that is", "lines that are");
        notes.push(format!("left out: {lines} not closed, and bound no floor"));
    }
    notes.extend(left_out);
    Ok(Plan { workspace, places: MapPlaces::default(), notes })
}

/// A line of a path, curves as chords.
struct Line {
    corners: Ring,
    /// Whether it ends where it starts.
    is_closed: bool,
}

/// The lines of a path: each ends where it starts, or is open.
fn lines(path: &BezPath, tolerance: f64) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    kurbo::flatten(path.iter(), tolerance, |element| match (element, lines.last_mut()) {
        (PathEl::MoveTo(start), _) => {
            lines.push(Line { corners: vec![[start.x, start.y]], is_closed: false });
        }
        (PathEl::LineTo(corner), Some(line)) => line.corners.push([corner.x, corner.y]),
        (PathEl::ClosePath, Some(line)) => line.is_closed = true,
        _ => {}
    });
    for Line { corners, is_closed } in &mut lines {
        corners.dedup();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
            *is_closed = true;
        }
    }
    lines.retain(|line| line.corners.len() > 1);
    lines
}

/// Every shape of the drawing, in its coordinates.
fn paths(text: &str) -> Result<Vec<BezPath>, String> {
    let mut reader = Reader::from_str(text);
    let mut groups = vec![Group { transform: Affine::IDENTITY, is_drawn: true }];
    let mut paths = Vec::new();
    loop {
        let at = reader.buffer_position();
        let wrong = |problem: String| format!("byte {at}: {problem}");
        let event = reader.read_event().map_err(|error| wrong(error.to_string()))?;
        match &event {
            Event::Eof if groups.len() > 1 => {
                return Err("the file ends within the drawing: it is cut off".into());
            }
            Event::Eof => return Ok(paths),
            Event::Start(element) | Event::Empty(element) => {
                let element = Element::of(element).map_err(wrong)?;
                let outer = groups.last().copied().unwrap_or_default();
                let group = outer.with(&element).map_err(wrong)?;
                if group.is_drawn {
                    let path = element.path().map_err(wrong)?;
                    paths.extend(path.map(|path| group.transform * path));
                }
                if matches!(event, Event::Start(_)) {
                    groups.push(group);
                }
            }
            Event::End(_) => {
                groups.pop();
            }
            _ => {}
        }
    }
}

/// How what an element holds is drawn.
#[derive(Clone, Copy, Default)]
struct Group {
    transform: Affine,
    is_drawn: bool,
}

impl Group {
    fn with(self, element: &Element) -> Result<Self, String> {
        Ok(Self {
            transform: self.transform * element.transform()?,
            is_drawn: self.is_drawn && element.is_drawn(),
        })
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

    /// Whether it is seen, apart from the elements around it.
    fn is_drawn(&self) -> bool {
        let is_none = |text: &str| text.trim() == "none";
        let style = self.attributes.get("style").map_or("", String::as_str);
        let mut rules = style.split(';').filter_map(|rule| rule.split_once(':'));
        !NOT_DRAWN.contains(&self.name.as_str())
            && !self.attributes.get("display").is_some_and(|text| is_none(text))
            && !rules.any(|(name, value)| name.trim() == "display" && is_none(value))
    }

    /// The outline of a shape, or a line; none for other elements.
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
                Circle::new(self.point(["cx", "cy"])?, radius).to_path(EXACT * radius.abs())
            }
            "ellipse" => {
                let [rx, ry] = [self.number("rx", None)?, self.number("ry", None)?];
                Ellipse::new(self.point(["cx", "cy"])?, (rx, ry), 0.0)
                    .to_path(EXACT * rx.abs().max(ry.abs()))
            }
            "polygon" => self.polyline(true)?,
            "polyline" => self.polyline(false)?,
            "line" => {
                let [from, to] = [self.point(["x1", "y1"])?, self.point(["x2", "y2"])?];
                kurbo::Line::new(from, to).to_path(EXACT)
            }
            _ => return Ok(None),
        };
        Ok(Some(path))
    }

    fn point(&self, [x, y]: [&str; 2]) -> Result<Point, String> {
        Ok(Point::new(self.number(x, Some(0.0))?, self.number(y, Some(0.0))?))
    }

    fn polyline(&self, is_closed: bool) -> Result<BezPath, String> {
        let text = self.attributes.get("points").map_or("", String::as_str);
        let words = text.split([' ', ',', '\t', '\n', '\r']).filter(|word| !word.is_empty());
        let numbers: Result<Vec<f64>, _> = words.map(str::parse).collect();
        let numbers = numbers.map_err(|_| format!("points {text:?} are not numbers"))?;
        let mut path = BezPath::new();
        for (index, corner) in numbers.chunks_exact(2).enumerate() {
            let corner = (corner[0], corner[1]);
            if index == 0 { path.move_to(corner) } else { path.line_to(corner) }
        }
        if is_closed {
            path.close_path();
        }
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
