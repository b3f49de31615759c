//! From the text of a file to its components.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::{Bind, Component, Location, Parameter, Text, Transition};
use crate::spaceex::SpaceExError;

/// The elements that can stand in an element; in all others there is text.
const CHILDREN: [(&str, &[&str]); 6] = [
    ("", &["sspaceex"]),
    ("sspaceex", &["component", "note"]),
    ("component", &["param", "location", "transition", "bind", "note"]),
    ("location", &["invariant", "flow", "note"]),
    ("transition", &["label", "guard", "assignment", "note"]),
    ("bind", &["map", "note"]),
];

/// How an arrow is drawn, or what editors note, which says nothing of the model.
const DRAWN: [&str; 6] =
    ["labelposition", "middlepoint", "waypoints", "beforemiddle", "aftermiddle", "link"];

/// What a location or a transition has one of.
const SINGLE: [&str; 5] = ["invariant", "flow", "label", "guard", "assignment"];

/// The components of a file, in their order.
pub(in crate::spaceex) fn read(text: &str) -> Result<Vec<Component>, SpaceExError> {
    let mut reader = Reader::from_str(text);
    let mut document = Document { line: 1, ..Document::default() };
    let mut counted = 0;
    loop {
        let at = usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX);
        let passed = &text.as_bytes()[counted..at.clamp(counted, text.len())];
        document.line += passed.iter().filter(|byte| **byte == b'\n').count();
        counted += passed.len();
        match reader.read_event().map_err(|error| document.wrong(error.to_string()))? {
            Event::Eof => return document.end(),
            Event::Start(element) => document.open(&element)?,
            Event::Empty(element) => {
                document.open(&element)?;
                document.close()?;
            }
            Event::End(_) => document.close()?,
            Event::Text(text) => document.content.push_str(&text),
            Event::CData(text) => document.content.push_str(&text),
            Event::GeneralRef(reference) => {
                let character = match &*reference {
                    "lt" => "<",
                    "gt" => ">",
                    "amp" => "&",
                    "apos" => "'",
                    "quot" => "\"",
                    other => {
                        let problem = format!("`&{other};` is no character known here");
                        return Err(document.wrong(problem));
                    }
                };
                document.content.push_str(character);
            }
            _ => {}
        }
    }
}

/// A file while it is read.
#[derive(Default)]
struct Document {
    components: Vec<Component>,
    /// The elements that are open, the innermost last.
    open: Vec<Element>,
    /// The text of the innermost of them.
    content: String,
    /// The parameter that a map is for.
    key: Option<String>,
    /// Where the reader is.
    line: usize,
}

/// An element that is open.
struct Element {
    name: String,
    line: usize,
    /// What it has had one of.
    had: Vec<String>,
    /// The text before it in the element around it.
    before: String,
}

/// The attributes of an element.
struct Attributes<'a>(&'a BytesStart<'a>);

impl Attributes<'_> {
    fn get(&self, name: &str) -> Result<Option<String>, String> {
        let found = self.0.try_get_attribute(name).map_err(|error| error.to_string())?;
        let value = found.map(|it| it.value.into_owned());
        Ok(value.map(|value: String| plain(&value)))
    }

    fn needed(&self, name: &str) -> Result<String, String> {
        self.get(name)?.ok_or_else(|| format!("the element lacks the attribute `{name}`"))
    }

    fn flag(&self, name: &str, default: bool) -> Result<bool, String> {
        match self.get(name)?.as_deref() {
            None => Ok(default),
            Some("true") => Ok(true),
            Some("false") => Ok(false),
            Some(other) => Err(format!("`{name}` is `{other}`: known are true and false")),
        }
    }
}

impl Document {
    fn wrong(&self, problem: String) -> SpaceExError {
        SpaceExError::Model { line: self.line, problem }
    }

    /// The components, when the file has come to its end.
    fn end(self) -> Result<Vec<Component>, SpaceExError> {
        if let Some(element) = self.open.last() {
            let Element { name, line, .. } = element;
            return Err(self.wrong(format!("the file ends within the <{name}> of line {line}")));
        }
        if self.components.is_empty() {
            let problem = "there is no <component>: this is no model of SpaceEx";
            return Err(self.wrong(problem.into()));
        }
        Ok(self.components)
    }

    fn open(&mut self, element: &BytesStart<'_>) -> Result<(), SpaceExError> {
        let name = element.name().as_ref().to_owned();
        let opened = self.enter(&name).and_then(|()| self.add(&name, &Attributes(element)));
        opened.map_err(|problem| self.wrong(problem))
    }

    /// Opens an element, where it can stand.
    fn enter(&mut self, name: &str) -> Result<(), String> {
        let outer = self.open.last().map_or("", |outer| outer.name.as_str());
        let inner = CHILDREN.iter().find(|(known, _)| *known == outer);
        let inner = inner.map_or(&[][..], |(_, inner)| *inner);
        if !inner.contains(&name) && !DRAWN.contains(&name) {
            return Err(match inner {
                [] => format!("<{name}> stands in <{outer}>, which holds text"),
                [only] => format!("<{name}> is no model of SpaceEx: that is a <{only}>"),
                _ => {
                    format!("<{name}> stands in <{outer}>, where there can be {}", inner.join(", "))
                }
            });
        }
        if let Some(outer) = self.open.last_mut() {
            if SINGLE.contains(&name) && outer.had.iter().any(|had| had == name) {
                return Err(format!("the <{}> has a <{name}> already: join them", outer.name));
            }
            outer.had.push(name.to_owned());
        }
        let before = std::mem::take(&mut self.content);
        self.open.push(Element { name: name.to_owned(), line: self.line, had: Vec::new(), before });
        Ok(())
    }

    /// Adds what an element says by its attributes.
    fn add(&mut self, name: &str, attributes: &Attributes<'_>) -> Result<(), String> {
        let line = self.line;
        if name == "component" {
            let id = attributes.needed("id")?;
            if self.components.iter().any(|other| other.id == id) {
                return Err(format!("there are two components `{id}`: rename one"));
            }
            self.components.push(Component { id, line, ..Component::default() });
        }
        let Some(component) = self.components.last_mut() else { return Ok(()) };
        match name {
            "param" => component.add_parameter(attributes, line)?,
            "location" => {
                let id = attributes.needed("id")?;
                let name = attributes.get("name")?.unwrap_or_else(|| format!("location {id}"));
                if component.locations.iter().any(|other| other.id == id) {
                    return Err(format!("two locations have the id {id}: change one"));
                }
                component.locations.push(Location { id, name, line, ..Location::default() });
            }
            "transition" => component.transitions.push(Transition {
                source: attributes.needed("source")?,
                target: attributes.needed("target")?,
                line,
                is_urgent: attributes.flag("asap", false)?,
                ..Transition::default()
            }),
            "bind" => component.binds.push(Bind {
                component: attributes.needed("component")?,
                name: attributes.needed("as")?,
                line,
                maps: Vec::new(),
            }),
            "map" => self.key = Some(attributes.needed("key")?),
            _ => {}
        }
        Ok(())
    }

    /// Closes the innermost element, and keeps its text.
    fn close(&mut self) -> Result<(), SpaceExError> {
        let content = std::mem::take(&mut self.content);
        let Some(element) = self.open.pop() else { return Ok(()) };
        self.content.clone_from(&element.before);
        let Some(component) = self.components.last_mut() else { return Ok(()) };
        let location = component.locations.last_mut();
        let transition = component.transitions.last_mut();
        let text = Text { line: element.line, content };
        match (element.name.as_str(), location, transition) {
            ("invariant", Some(location), _) => location.invariant = text,
            ("flow", Some(location), _) => location.flow = text,
            ("label", _, Some(transition)) => transition.label = text,
            ("guard", _, Some(transition)) => transition.guard = text,
            ("assignment", _, Some(transition)) => transition.assignment = text,
            ("map", ..) => {
                if let (Some(key), Some(bind)) = (self.key.take(), component.binds.last_mut()) {
                    if bind.maps.iter().any(|(known, _)| *known == key) {
                        let problem = format!("`{}` binds `{key}` twice: leave one out", bind.name);
                        return Err(self.wrong(problem));
                    }
                    bind.maps.push((key, text));
                }
            }
            ("component", ..) => component.check()?,
            _ => {}
        }
        Ok(())
    }
}

impl Component {
    fn add_parameter(&mut self, attributes: &Attributes<'_>, line: usize) -> Result<(), String> {
        let name = attributes.needed("name")?;
        if self.parameters.iter().any(|other| other.name == name) {
            return Err(format!("component `{}` has two parameters `{name}`: rename one", self.id));
        }
        for dimension in ["d1", "d2"] {
            if attributes.get(dimension)?.is_some_and(|value| value != "1") {
                return Err(format!(
                    "`{name}` is not a number ({dimension} is not 1): use one parameter for each entry"
                ));
            }
        }
        let kind = attributes.get("type")?.unwrap_or_else(|| "real".into());
        if !["real", "label", "int"].contains(&kind.as_str()) {
            return Err(format!("`{name}` is of type `{kind}`: known are real, int and label"));
        }
        let dynamics = attributes.get("dynamics")?.unwrap_or_else(|| "any".into());
        if !["any", "const"].contains(&dynamics.as_str()) {
            return Err(format!("`{name}` has the dynamics `{dynamics}`: known are any and const"));
        }
        self.parameters.push(Parameter {
            is_label: kind == "label",
            is_constant: dynamics == "const",
            is_local: attributes.flag("local", false)?,
            is_controlled: attributes.flag("controlled", true)?,
            name,
            line,
        });
        Ok(())
    }
}

/// Attributes hold entities, too.
fn plain(text: &str) -> String {
    text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}
