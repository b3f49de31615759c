//! Networks of components, made into one automaton.
//!
//! The instances of base components run side by side. A label that several of them know is taken by
//! all of these together.

mod outputs;

use std::collections::BTreeMap;

use crate::guards::{Expression, Substitution, constant};

use super::SpaceExError;
use super::document::{Component, Location, Parameter, Text, Transition};
use super::formula::{self, Clause, Relation, Side};

/// A base component with its names bound.
pub(super) struct Instance<'a> {
    /// Empty for a system that is a base component itself.
    pub name: String,
    pub component: &'a Component,
    /// What its parameters stand for.
    pub names: BTreeMap<String, Bound>,
}

/// What a parameter stands for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Bound {
    /// A parameter of the whole.
    Name(String),
    Number(f64),
    /// What an invariant in every location says that an output is.
    Formula(Expression),
}

/// A parameter of the whole.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Known {
    /// Where it is declared.
    pub line: usize,
    pub is_label: bool,
    pub is_constant: bool,
}

/// The instances in a system, and the parameters of the whole.
pub(super) struct Network<'a> {
    pub instances: Vec<Instance<'a>>,
    pub known: BTreeMap<String, Known>,
    /// What numbers of inner components stand for, as `component.number`.
    pub inner: BTreeMap<String, Bound>,
    /// The formulas of outputs.
    pub outputs: BTreeMap<String, Expression>,
}

/// How deep components may contain each other.
const DEPTH: usize = 32;

impl<'a> Network<'a> {
    /// The instances in `system`.
    pub(super) fn of(
        components: &'a [Component],
        system: &'a Component,
    ) -> Result<Self, SpaceExError> {
        let mut network = Network {
            instances: Vec::new(),
            known: BTreeMap::new(),
            inner: BTreeMap::new(),
            outputs: BTreeMap::new(),
        };
        network.add(components, system, "", BTreeMap::new(), 0)?;
        let Network { known, inner, .. } = &mut network;
        inner.retain(|name, _| !known.contains_key(name));
        network.name_briefly();
        outputs::resolve(&mut network)?;
        Ok(network)
    }

    /// What belongs to an inner component may be named without it, where that is clear.
    fn name_briefly(&mut self) {
        let mut brief: BTreeMap<String, Vec<&String>> = BTreeMap::new();
        for (name, known) in &self.known {
            if let (false, Some((_, own))) = (known.is_label, name.rsplit_once('.')) {
                brief.entry(own.to_owned()).or_default().push(name);
            }
        }
        brief.retain(|own, names| names.len() == 1 && !self.known.contains_key(own));
        let brief: Vec<_> =
            brief.into_iter().map(|(own, names)| (own, Bound::Name(names[0].clone()))).collect();
        self.inner.extend(brief);
    }

    fn add(
        &mut self,
        components: &'a [Component],
        component: &'a Component,
        name: &str,
        mut names: BTreeMap<String, Bound>,
        depth: usize,
    ) -> Result<(), SpaceExError> {
        let wrong = |line: usize, problem: String| Err(SpaceExError::Model { line, problem });
        if depth > DEPTH {
            return wrong(component.line, format!("component `{}` contains itself", component.id));
        }
        let prefix = if name.is_empty() { String::new() } else { format!("{name}.") };
        for parameter in &component.parameters {
            let bound = names.entry(parameter.name.clone());
            // What is not bound, as what is local, is the instance's own.
            let bound = bound.or_insert_with(|| Bound::Name(format!("{prefix}{}", parameter.name)));
            if !parameter.is_label && !name.is_empty() {
                self.inner.insert(format!("{prefix}{}", parameter.name), bound.clone());
            }
            if let Bound::Name(global) = bound {
                let Parameter { line, is_label, is_constant, .. } = *parameter;
                let known = Known { line, is_label, is_constant };
                let known_before =
                    self.known.entry(global.clone()).or_insert_with(|| known.clone());
                if known_before.is_label != known.is_label {
                    return wrong(
                        parameter.line,
                        format!("`{global}` is a label in one component and a number in another"),
                    );
                }
                known_before.is_constant &= known.is_constant;
            }
        }
        if component.binds.is_empty() {
            let instance = Instance { name: name.to_owned(), component, names };
            self.instances.push(instance);
            return Ok(());
        }
        if !component.locations.is_empty() {
            return wrong(
                component.line,
                format!("component `{}` has both locations and binds", component.id),
            );
        }
        for bind in &component.binds {
            let Some(inner) = components.iter().find(|other| other.id == bind.component) else {
                return wrong(bind.line, format!("there is no component `{}`", bind.component));
            };
            let mut inner_names = BTreeMap::new();
            for (key, text) in &bind.maps {
                let (line, value) = (text.line, text.content.trim());
                if !inner.parameters.iter().any(|parameter| parameter.name == *key) {
                    return wrong(
                        line,
                        format!("component `{}` has no parameter `{key}`", inner.id),
                    );
                }
                let value = match (value.parse::<Expression>(), names.get(value)) {
                    (_, Some(bound)) => bound.clone(),
                    (Ok(formula), None) => match formula.evaluate(&()) {
                        Ok(number) => Bound::Number(number),
                        Err(_) => {
                            return wrong(
                                line,
                                format!(
                                    "`{key}` is bound to `{value}`, which is neither a number nor a parameter of `{}`",
                                    component.id
                                ),
                            );
                        }
                    },
                    (Err(error), None) => return wrong(line, format!("`{value}`: {error}")),
                };
                let is_label = inner.parameters.iter().any(|one| one.name == *key && one.is_label);
                if let (true, Bound::Number(number)) = (is_label, &value) {
                    return wrong(
                        line,
                        format!("the label `{key}` is bound to {number}: bind it to a label"),
                    );
                }
                inner_names.insert(key.clone(), value);
            }
            let inner_name = format!("{prefix}{}", bind.name);
            self.add(components, inner, &inner_name, inner_names, depth + 1)?;
        }
        Ok(())
    }
}

impl Network<'_> {
    /// Names of the whole in the place of those of inner components.
    pub(super) fn in_names_of_the_whole(&self, formula: &Expression) -> Expression {
        formula.substitute(&substitution(&self.inner))
    }
}

impl Instance<'_> {
    /// The name of a parameter in the whole.
    pub(super) fn global(&self, name: &str) -> Option<&str> {
        match self.names.get(name)? {
            Bound::Name(global) => Some(global),
            Bound::Number(_) | Bound::Formula(_) => None,
        }
    }

    /// Names and numbers of the whole in the place of parameters.
    fn substitution(&self) -> Substitution {
        substitution(&self.names)
    }

    /// A conjunction of the component, in names of the whole.
    pub(super) fn clauses(&self, text: &Text) -> Result<Vec<Clause>, SpaceExError> {
        let wrong = |problem: String| SpaceExError::Model { line: text.line, problem };
        let substitution = self.substitution();
        let side = |side: Side| -> Result<Side, SpaceExError> {
            match side {
                Side::Formula(formula) => {
                    let stranger = formula
                        .variables()
                        .into_iter()
                        .find(|name| !self.names.contains_key(*name));
                    let is_label = |name: &&str| {
                        let mut known = self.component.parameters.iter();
                        known.any(|one| one.is_label && one.name == **name)
                    };
                    if let Some(label) = formula.variables().into_iter().find(is_label) {
                        return Err(wrong(format!("`{label}` is a label, not a number")));
                    }
                    if let Some(stranger) = stranger {
                        return Err(wrong(format!(
                            "`{stranger}` is not a parameter of component `{}`",
                            self.component.id
                        )));
                    }
                    Ok(Side::Formula(formula.substitute(&substitution)))
                }
                Side::Primed(name) => match self.global(&name) {
                    Some(global) => Ok(Side::Primed(global.to_owned())),
                    None => Err(wrong(format!(
                        "`{name}'`: `{name}` is no variable of component `{}`",
                        self.component.id
                    ))),
                },
            }
        };
        let clauses = formula::conjunction(&text.content).map_err(wrong)?;
        clauses
            .into_iter()
            .map(|clause| match clause {
                Clause::Compare { left, relation, right } => {
                    Ok(Clause::Compare { left: side(left)?, relation, right: side(right)? })
                }
                Clause::Location { .. } => {
                    Err(wrong("`loc` can stand in the configuration only".into()))
                }
                other => Ok(other),
            })
            .collect()
    }

    /// The rates that a location gives: `None` where no time passes.
    pub(super) fn rates(
        &self,
        place: &Location,
    ) -> Result<Option<Vec<(String, Expression)>>, SpaceExError> {
        let wrong = |problem: String| SpaceExError::Model { line: place.flow.line, problem };
        let mut rates = Vec::new();
        for clause in self.clauses(&place.flow)? {
            match clause {
                Clause::Always => {}
                Clause::Never => return Ok(None),
                Clause::Compare {
                    left: Side::Primed(name),
                    relation: Relation::Equal | Relation::Assigned,
                    right: Side::Formula(rate),
                } => {
                    if rates.iter().any(|(known, _)| *known == name) {
                        return Err(wrong(format!(
                            "the flow of `{}` says twice what `{name}'` is",
                            place.name
                        )));
                    }
                    rates.push((name, rate));
                }
                _ => {
                    return Err(wrong(format!(
                        "the flow of `{}` is to say x' == … for each variable; inclusions of rates are not \
                     supported: add an input within bounds",
                        place.name
                    )));
                }
            }
        }
        Ok(Some(rates))
    }

    /// What a transition assigns: a formula, or bounds on what the value may be.
    pub(super) fn assignments(
        &self,
        transition: &Transition,
    ) -> Result<Vec<(String, Assigned)>, SpaceExError> {
        let wrong =
            |problem: String| SpaceExError::Model { line: transition.assignment.line, problem };
        let mut assigned: Vec<(String, Assigned)> = Vec::new();
        for clause in self.clauses(&transition.assignment)? {
            let (left, relation, right) = match clause {
                Clause::Always => continue,
                Clause::Compare { left, relation, right } => (left, relation, right),
                _ => return Err(wrong("an assignment is written as x := … or x' == …".into())),
            };
            let (name, relation, value) = match (&left, &right) {
                (Side::Primed(name), Side::Formula(value)) => {
                    (name.clone(), relation, value.clone())
                }
                (Side::Formula(value), Side::Primed(name)) => {
                    (name.clone(), relation.turned(), value.clone())
                }
                (Side::Formula(Expression::Variable(name)), Side::Formula(value))
                    if matches!(relation, Relation::Assigned | Relation::Equal) =>
                {
                    (name.to_string(), relation, value.clone())
                }
                _ => return Err(wrong("an assignment is written as x := … or x' == …".into())),
            };
            let place = assigned.iter().position(|(known, _)| *known == name);
            match relation {
                Relation::Assigned | Relation::Equal if place.is_none() => {
                    assigned.push((name, Assigned::Value(value)));
                }
                Relation::Assigned | Relation::Equal => {
                    return Err(wrong(format!("`{name}` is assigned twice")));
                }
                bound => {
                    let place = place.unwrap_or_else(|| {
                        assigned.push((name.clone(), Assigned::Within(None, None)));
                        assigned.len() - 1
                    });
                    let is_lower = matches!(bound, Relation::AtLeast | Relation::MoreThan);
                    let bound = match &mut assigned[place].1 {
                        Assigned::Within(lower, _) if is_lower => lower,
                        Assigned::Within(_, upper) => upper,
                        Assigned::Value(_) => {
                            return Err(wrong(format!("`{name}` is assigned twice")));
                        }
                    };
                    if bound.replace(value).is_some() {
                        return Err(wrong(format!("`{name}'` is bounded twice from one side")));
                    }
                }
            }
        }
        let is_open =
            |one: &Assigned| matches!(one, Assigned::Within(None, _) | Assigned::Within(_, None));
        match assigned.iter().find(|(_, one)| is_open(one)) {
            Some((name, _)) => {
                Err(wrong(format!("what `{name}'` may be is not bounded from both sides")))
            }
            None => Ok(assigned),
        }
    }
}

/// What parameters stand for in their place.
fn substitution(names: &BTreeMap<String, Bound>) -> Substitution {
    Substitution::new(names.iter().map(|(name, bound)| {
        let value = match bound {
            Bound::Name(global) => crate::guards::variable(global),
            Bound::Number(value) => constant(*value),
            Bound::Formula(formula) => formula.clone(),
        };
        (name, value)
    }))
}

/// What a variable becomes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Assigned {
    Value(Expression),
    /// Between two values.
    Within(Option<Expression>, Option<Expression>),
}
