//! The elements of a drawing, in the order of the file.

use crate::import::finite;
use kurbo::{Affine, Point};
use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};
use std::collections::BTreeMap;

/// An element with its attributes.
#[derive(Clone)]
pub(super) struct Element {
    pub name: String,
    attributes: BTreeMap<String, String>,
    /// Where it stands in the file.
    byte: u64,
    /// The index after that of the last element within it.
    pub end: usize,
}

/// All elements of a drawing; the first holds the others.
pub(super) fn elements(text: &str) -> Result<Vec<Element>, String> {
    let mut reader = Reader::from_str(text);
    let mut elements: Vec<Element> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    loop {
        let byte = reader.buffer_position();
        let wrong = |problem: String| format!("byte {byte}: {problem}");
        let event = reader.read_event().map_err(|error| wrong(error.to_string()))?;
        match &event {
            Event::Eof if !open.is_empty() => {
                return Err("the file ends within the drawing: it is cut off".into());
            }
            Event::Eof => return Ok(elements),
            Event::Start(start) | Event::Empty(start) => {
                let index = elements.len();
                if index > 0 && open.is_empty() {
                    return Err(wrong("the file goes on after its drawing has ended".into()));
                }
                let (name, attributes) = name_and_attributes(start).map_err(wrong)?;
                elements.push(Element { name, attributes, byte, end: index + 1 });
                if matches!(event, Event::Start(_)) {
                    open.push(index);
                }
            }
            Event::End(_) => {
                if let Some(index) = open.pop() {
                    elements[index].end = elements.len();
                }
            }
            _ => {}
        }
    }
}

fn name_and_attributes(
    start: &BytesStart<'_>,
) -> Result<(String, BTreeMap<String, String>), String> {
    let mut attributes = BTreeMap::new();
    for attribute in start.attributes() {
        let attribute = attribute.map_err(|error| error.to_string())?;
        let value = attribute.normalized_value(XmlVersion::Implicit1_0);
        let value = value.map_err(|error| error.to_string())?;
        attributes.insert(attribute.key.as_ref().to_owned(), value.into_owned());
    }
    Ok((start.local_name().as_ref().to_owned(), attributes))
}

impl Element {
    /// A problem with the place of the element.
    pub(super) fn wrong(&self, problem: &str) -> String {
        format!("byte {}: {problem}", self.byte)
    }

    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.get(name).map(String::as_str)
    }

    /// What its style, or else an attribute, says about a property.
    pub(super) fn property(&self, name: &str) -> Option<&str> {
        let rules = self.attribute("style").unwrap_or_default().split(';');
        let mut rules = rules.filter_map(|rule| rule.split_once(':'));
        let styled = rules.find(|(property, _)| property.trim() == name).map(|(_, value)| value);
        styled.or(self.attribute(name)).map(str::trim)
    }

    pub(super) fn transform(&self) -> Result<Affine, String> {
        let Some(text) = self.property("transform") else { return Ok(Affine::IDENTITY) };
        let transform: svgtypes::Transform =
            text.parse().map_err(|error| format!("transform {text:?}: {error}"))?;
        let svgtypes::Transform { a, b, c, d, e, f } = transform;
        Ok(Affine::new([a, b, c, d, e, f]))
    }

    /// A point, 0 by default.
    pub(super) fn point(&self, [x, y]: [&str; 2]) -> Result<Point, String> {
        let [x, y] = [self.stated_number(x)?, self.stated_number(y)?];
        Ok(Point::new(x.unwrap_or_default(), y.unwrap_or_default()))
    }

    /// A length that must be stated.
    pub(super) fn length(&self, name: &str) -> Result<f64, String> {
        self.stated_length(name)?.ok_or_else(|| format!("{} has no {name}", self.name))
    }

    /// A length, if it is stated and is not `auto`.
    pub(super) fn stated_length(&self, name: &str) -> Result<Option<f64>, String> {
        if self.attribute(name) == Some("auto") {
            return Ok(None);
        }
        match self.stated_number(name)? {
            Some(length) if length < 0.0 => {
                Err(format!("{name} of {} is {length}: at least 0 is possible", self.name))
            }
            length => Ok(length),
        }
    }

    /// The width of lines, if it is stated.
    pub(super) fn stroke_width(&self) -> Result<Option<f64>, String> {
        let name = "stroke-width";
        self.property(name).map(|text| self.number(name, text)).transpose()
    }

    fn stated_number(&self, name: &str) -> Result<Option<f64>, String> {
        self.attribute(name).map(|text| self.number(name, text)).transpose()
    }

    /// A number without a unit, or in user units (`px`).
    fn number(&self, name: &str, text: &str) -> Result<f64, String> {
        let wrong = || format!("{name} of {} is {text:?}: give a number", self.name);
        finite(text.trim_end_matches("px").trim()).ok_or_else(wrong)
    }

    /// The element as one that only groups what it holds.
    pub(super) fn as_group(&self) -> Self {
        Self { name: "g".into(), ..self.clone() }
    }

    /// The element as it is drawn by a `use`: a symbol becomes a drawing in the drawing, which has the size that the
    /// `use` states, if it does.
    pub(super) fn used_by(&self, user: &Self) -> Self {
        let mut element = self.clone();
        if element.name == "symbol" {
            element.name = "svg".into();
        }
        if element.name == "svg" {
            for side in ["width", "height"] {
                let stated = user.attribute(side).map(|size| (side.to_owned(), size.to_owned()));
                element.attributes.extend(stated);
            }
        }
        element
    }
}
