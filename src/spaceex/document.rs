//! The XML of a model: components with parameters, locations, transitions and binds.

mod parser;

use super::SpaceExError;

pub(super) use parser::read;

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

/// What stands in an element; nothing where there is none.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Text {
    pub line: usize,
    pub content: String,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Location {
    pub id: String,
    pub name: String,
    pub line: usize,
    pub invariant: Text,
    pub flow: Text,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Transition {
    pub source: String,
    pub target: String,
    pub line: usize,
    pub label: Text,
    pub guard: Text,
    pub assignment: Text,
    pub is_urgent: bool,
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Bind {
    pub component: String,
    pub name: String,
    pub line: usize,
    /// Parameters of the component, each with what it is bound to.
    pub maps: Vec<(String, Text)>,
}

impl Component {
    /// Whether its transitions lead from location to location and take labels, and its binds have names of
    /// their own.
    fn check(&self) -> Result<(), SpaceExError> {
        let wrong = |line: usize, problem: String| Err(SpaceExError::Model { line, problem });
        for transition in &self.transitions {
            for id in [&transition.source, &transition.target] {
                if !self.locations.iter().any(|location| location.id == *id) {
                    return wrong(transition.line, format!("there is no location with id {id}"));
                }
            }
            let label = transition.label.content.trim();
            let is_known = |one: &Parameter| one.is_label && one.name == label;
            if !label.is_empty() && !self.parameters.iter().any(is_known) {
                let problem = format!(
                    "`{label}` is no label of component `{}`: declare a param of type label",
                    self.id
                );
                return wrong(transition.label.line, problem);
            }
        }
        for (at, bind) in self.binds.iter().enumerate() {
            if self.binds[..at].iter().any(|other| other.name == bind.name) {
                let problem = format!("two components are bound as `{}`: rename one", bind.name);
                return wrong(bind.line, problem);
            }
        }
        Ok(())
    }
}
