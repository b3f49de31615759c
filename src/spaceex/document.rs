//! The XML of a model: components with parameters, locations, transitions and binds.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::SpaceExError;

/// A component: a base component has locations, a network component binds.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Component {
    pub id: String,
    pub line: usize,
    pub parameters: Vec<Parameter>,
    pub locations: Vec<Location>,
    pub transitions: Vec<Transition>,
    pub binds: Vec<Bind>,
}

/// A variable, a constant or a label.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Parameter {
    pub name: String,
    pub line: usize,
    pub is_label: bool,
    pub is_constant: bool,
    pub is_local: bool,
    pub is_controlled: bool,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Location {
    pub id: String,
    pub name: String,
    pub line: usize,
    pub invariant: String,
    pub flow: String,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Transition {
    pub source: String,
    pub target: String,
    pub line: usize,
    pub label: String,
    pub guard: String,
    pub assignment: String,
    pub is_urgent: bool,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Bind {
    pub component: String,
    pub name: String,
    pub line: usize,
    /// Parameters of the component, each with what it is bound to.
    pub maps: Vec<(String, String)>,
}

/// The components of a file, in their order.
pub(super) fn read(text: &str) -> Result<Vec<Component>, SpaceExError> {
    let mut reader = Reader::from_str(text);
    let mut document = Document { components: Vec::new(), content: String::new(), key: None };
    loop {
        let at = usize::try_from(reader.buffer_position()).unwrap_or(usize::MAX);
        let line = 1 + text.bytes().take(at).filter(|byte| *byte == b'\n').count();
        let wrong = |problem: String| SpaceExError::Model { line, problem };
        match reader.read_event().map_err(|error| wrong(error.to_string()))? {
            Event::Eof if document.components.is_empty() => {
                return Err(wrong("there is no <component>: this is no model of SpaceEx".into()));
            }
            Event::Eof => return Ok(document.components),
            Event::Start(element) => document.open(&element, line).map_err(wrong)?,
            Event::Empty(element) => {
                document.open(&element, line).map_err(wrong)?;
                let name = element.name().as_ref().to_owned();
                document.close(&name).map_err(wrong)?;
            }
            Event::End(element) => document.close(element.name().as_ref()).map_err(wrong)?,
            Event::Text(text) => {
                document.content.push_str(&text);
            }
            Event::GeneralRef(reference) => {
                document.content.push_str(match &*reference {
                    "lt" => "<",
                    "gt" => ">",
                    "amp" => "&",
                    "apos" => "'",
                    "quot" => "\"",
                    other => return Err(wrong(format!("`&{other};` is no character known here"))),
                });
            }
            _ => {}
        }
    }
}

/// A file while it is read.
struct Document {
    components: Vec<Component>,
    /// The text of the element that is open.
    content: String,
    /// The parameter that a map is for.
    key: Option<String>,
}

impl Document {
    fn open(&mut self, element: &BytesStart<'_>, line: usize) -> Result<(), String> {
        self.content.clear();
        let attribute = |name: &str| -> Result<Option<String>, String> {
            let found = element.try_get_attribute(name).map_err(|error| error.to_string())?;
            let value = found.map(|it| it.value.into_owned());
            Ok(value.map(|value: String| plain(&value)))
        };
        let needed = |name: &str| -> Result<String, String> {
            attribute(name)?.ok_or_else(|| format!("the element lacks the attribute `{name}`"))
        };
        let name = element.name();
        if name.as_ref() == "component" {
            let id = needed("id")?;
            if self.components.iter().any(|other| other.id == id) {
                return Err(format!("there are two components `{id}`: rename one"));
            }
            self.components.push(Component { id, line, ..Component::default() });
            return Ok(());
        }
        let Some(component) = self.components.last_mut() else { return Ok(()) };
        match name.as_ref() {
            "param" => {
                let name = needed("name")?;
                if component.parameters.iter().any(|other| other.name == name) {
                    return Err(format!(
                        "component `{}` has two parameters `{name}`: rename one",
                        component.id
                    ));
                }
                for (dimension, value) in [("d1", attribute("d1")?), ("d2", attribute("d2")?)] {
                    if value.is_some_and(|value| value != "1") {
                        return Err(format!(
                            "`{name}` is no number ({dimension} is not 1): use one parameter for each entry"
                        ));
                    }
                }
                let kind = attribute("type")?.unwrap_or_else(|| "real".into());
                if !["real", "label", "int"].contains(&kind.as_str()) {
                    return Err(format!(
                        "`{name}` is of type `{kind}`: known are real, int and label"
                    ));
                }
                let dynamics = attribute("dynamics")?.unwrap_or_else(|| "any".into());
                if !["any", "const"].contains(&dynamics.as_str()) {
                    return Err(format!(
                        "`{name}` has the dynamics `{dynamics}`: known are any and const"
                    ));
                }
                component.parameters.push(Parameter {
                    is_label: kind == "label",
                    is_constant: dynamics == "const",
                    is_local: attribute("local")?.is_some_and(|it| it == "true"),
                    is_controlled: attribute("controlled")?.is_none_or(|it| it != "false"),
                    name,
                    line,
                });
            }
            "location" => {
                let id = needed("id")?;
                let name = attribute("name")?.unwrap_or_else(|| format!("location {id}"));
                if component.locations.iter().any(|other| other.id == id) {
                    return Err(format!("two locations have the id {id}: change one"));
                }
                component.locations.push(Location { id, name, line, ..Location::default() });
            }
            "transition" => {
                let asap = attribute("asap")?.is_some_and(|it| it == "true");
                component.transitions.push(Transition {
                    source: needed("source")?,
                    target: needed("target")?,
                    line,
                    is_urgent: asap,
                    ..Transition::default()
                });
            }
            "bind" => component.binds.push(Bind {
                component: needed("component")?,
                name: needed("as")?,
                line,
                maps: Vec::new(),
            }),
            "map" => self.key = Some(needed("key")?),
            _ => {}
        }
        Ok(())
    }

    fn close(&mut self, name: &str) -> Result<(), String> {
        let content = std::mem::take(&mut self.content);
        let Some(component) = self.components.last_mut() else { return Ok(()) };
        let transition = component.transitions.last_mut();
        match name {
            "invariant" | "flow" => {
                let Some(place) = component.locations.last_mut() else { return Ok(()) };
                *(if name == "flow" { &mut place.flow } else { &mut place.invariant }) = content;
            }
            "label" | "guard" | "assignment" => {
                let Some(transition) = transition else { return Ok(()) };
                *(match name {
                    "label" => &mut transition.label,
                    "guard" => &mut transition.guard,
                    _ => &mut transition.assignment,
                }) = content;
            }
            "map" => {
                let (Some(key), Some(bind)) = (self.key.take(), component.binds.last_mut()) else {
                    return Ok(());
                };
                if bind.maps.iter().any(|(known, _)| *known == key) {
                    return Err(format!("`{}` binds `{key}` twice: leave one out", bind.name));
                }
                bind.maps.push((key, content.trim().to_owned()));
            }
            _ => {}
        }
        Ok(())
    }
}

/// Attributes hold entities, too.
fn plain(text: &str) -> String {
    text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}
