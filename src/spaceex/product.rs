//! The product of the instances of a network, and the question over it.

mod question;

use std::collections::BTreeMap;

use crate::automaton::{Automaton, Builder, Coordinate, Name, Rate, Record, from};
use crate::guards::{Expression, Interval, Predicate, variable};
use crate::verify::reach::Uncertain;

use super::configuration::Options;
use super::document::{Component, Transition};
use super::formula::{Clause, Relation, Side};
use super::network::{Assigned, Bound, Instance, Network};
use super::{Initial, Problem, SpaceExError};
use question::settings;

/// How many locations a product may have.
const LOCATIONS: usize = 4096;

type Result<T> = std::result::Result<T, SpaceExError>;

/// The problem that components and configuration pose.
pub(super) fn problem(components: &[Component], options: &Options) -> Result<Problem> {
    let system = system(components, options)?;
    let network = Network::of(components, system)?;
    let product = Product::of(&network, system.line, options)?;
    product.problem(system.id.clone(), options)
}

/// The component that the configuration names, or else the last.
fn system<'a>(components: &'a [Component], options: &Options) -> Result<&'a Component> {
    let wrong = |line, problem: String| SpaceExError::Configuration { line, problem };
    match &options.system {
        Some((line, name)) => components.iter().find(|one| one.id == *name).ok_or_else(|| {
            let known: Vec<&str> = components.iter().map(|one| one.id.as_str()).collect();
            wrong(*line, format!("there is no component `{name}`: there are {}", known.join(", ")))
        }),
        None => components.last().ok_or_else(|| SpaceExError::Model {
            line: 1,
            problem: "there is no component".into(),
        }),
    }
}

/// Side by side.
struct Product<'a> {
    network: &'a Network<'a>,
    line: usize,
    /// The coordinates.
    variables: Vec<String>,
    inputs: Vec<(String, Interval)>,
    /// Constants with their values.
    constants: Vec<(String, Interval)>,
    /// The places of the instances in each location of the product.
    tuples: Vec<Vec<usize>>,
    names: Vec<Name>,
}

impl<'a> Product<'a> {
    fn of(network: &'a Network<'a>, line: usize, options: &Options) -> Result<Self> {
        let mut product = Product {
            network,
            line,
            variables: Vec::new(),
            inputs: Vec::new(),
            constants: Vec::new(),
            tuples: Vec::new(),
            names: Vec::new(),
        };
        product.classify(options)?;
        product.enumerate()?;
        Ok(product)
    }

    fn wrong<T>(&self, problem: String) -> Result<T> {
        Err(SpaceExError::Model { line: self.line, problem })
    }

    /// Says of each number whether it is a coordinate, an input or a constant.
    fn classify(&mut self, options: &Options) -> Result<()> {
        let mut flowing = Vec::new();
        for instance in &self.network.instances {
            for place in &instance.component.locations {
                let rates = instance.rates(place)?.unwrap_or_default();
                flowing.extend(rates.into_iter().map(|(name, _)| name));
            }
            for transition in &instance.component.transitions {
                flowing.extend(instance.assignments(transition)?.into_iter().map(|(name, _)| name));
            }
        }
        for (name, known) in &self.network.known {
            if known.is_label {
                continue;
            }
            if flowing.contains(name) {
                self.variables.push(name.clone());
            } else if known.is_constant {
                let Some(values) = fixed(&options.initially.1, name) else {
                    return self.wrong(format!(
                        "`{name}` is a constant without a value: bind it to a number, or give it one in `initially`"
                    ));
                };
                self.constants.push((name.clone(), values));
            } else {
                let values = self.input_bounds(name)?;
                self.inputs.push((name.clone(), values));
            }
        }
        Ok(())
    }

    /// Between which numbers invariants keep an input; over all locations, for there is one input.
    fn input_bounds(&self, name: &str) -> Result<Interval> {
        let mut bounds: Option<Interval> = None;
        for instance in &self.network.instances {
            if !instance.names.values().any(|bound| *bound == Bound::Name(name.to_owned())) {
                continue;
            }
            for place in &instance.component.locations {
                let clauses = instance.clauses(&place.invariant, place.line)?;
                let Some(within) = fixed(&[clauses], name) else { continue };
                bounds = Some(bounds.map_or(within, |known| known.hull(within)));
            }
        }
        match bounds {
            Some(bounds) if bounds.width().is_finite() => Ok(bounds),
            _ => self.wrong(format!(
                "`{name}` has neither a flow nor bounds: give it a flow, or keep it between two numbers in \
                 the invariants"
            )),
        }
    }

    /// The tuples of locations, and their names.
    fn enumerate(&mut self) -> Result<()> {
        self.tuples = vec![Vec::new()];
        for instance in &self.network.instances {
            let count = instance.component.locations.len();
            if self.tuples.len() * count > LOCATIONS {
                return self.wrong(format!("the network has more than {LOCATIONS} locations"));
            }
            self.tuples = self
                .tuples
                .iter()
                .flat_map(|tuple| (0..count).map(move |place| [&tuple[..], &[place]].concat()))
                .collect();
        }
        let name = |tuple: &Vec<usize>| {
            let parts = tuple.iter().zip(&self.network.instances);
            let parts = parts.map(|(place, instance)| location_name(instance.component, *place));
            Name::new(&parts.collect::<Vec<_>>().join(", "))
        };
        self.names = self.tuples.iter().map(name).collect();
        Ok(())
    }

    fn problem(&self, system: String, options: &Options) -> Result<Problem> {
        if self.tuples.is_empty() || self.network.instances.is_empty() {
            return self.wrong(format!("component `{system}` has no locations"));
        }
        let initial = self.initial(options)?;
        let mut begins: Vec<&String> = initial.iter().flat_map(|one| &one.locations).collect();
        begins.sort();
        begins.dedup();
        let automata = begins.into_iter().map(|name| self.automaton(Name::new(name), &initial));
        let automata = automata.collect::<Result<Vec<_>>>()?;
        let varying = |values: &[(String, Interval)], varies| -> Vec<Uncertain> {
            let wide = values.iter().filter(|(_, values)| varies || values.width() > 0.0);
            wide.map(|(name, values)| Uncertain {
                parameter: name.clone(),
                values: *values,
                varies,
            })
            .collect()
        };
        let mut uncertain = varying(&self.constants, false);
        uncertain.extend(varying(&self.inputs, true));
        for input in self.drawn()? {
            uncertain.push(Uncertain { parameter: input.0, values: input.1, varies: true });
        }
        Ok(Problem {
            system,
            automata,
            uncertain,
            initial,
            forbidden: self.forbidden(options)?,
            settings: settings(options)?,
            shown: options.shown.clone(),
        })
    }

    /// The values that assignments leave open, each under a name of its own.
    fn drawn(&self) -> Result<Vec<(String, Interval)>> {
        let mut drawn = Vec::new();
        for instance in &self.network.instances {
            for (number, transition) in instance.component.transitions.iter().enumerate() {
                for (name, assigned) in instance.assignments(transition)? {
                    if let Assigned::Within(lower, upper) = assigned {
                        let values = Interval::new(lower, upper).unwrap_or(Interval::WHOLE);
                        drawn.push((drawn_name(instance, number, &name), values));
                    }
                }
            }
        }
        Ok(drawn)
    }

    fn automaton(&self, first: Name, initial: &[Initial]) -> Result<Automaton<Name, Name, Record>> {
        let middles = initial.first().map(|one| one.states.hull().iter().map(Interval::midpoint));
        let middles: Vec<f64> = middles.into_iter().flatten().collect();
        let state = Record::new(self.variables.iter().zip(middles));
        let state = state
            .map_err(|error| SpaceExError::Model { line: self.line, problem: error.to_string() })?;
        let coordinates: BTreeMap<String, Coordinate<Record>> =
            self.variables.iter().cloned().zip(state.coordinates()).collect();
        let mut builder = Automaton::<Name, Name, Record>::starting_in(first).initially(state);
        for (name, values) in self.constants.iter().chain(&self.inputs).chain(&self.drawn()?) {
            builder = builder.parameter(name, values.midpoint());
        }
        for (tuple, name) in self.tuples.iter().zip(&self.names) {
            builder = self.add_location(builder, tuple, *name, &coordinates)?;
        }
        for (tuple, name) in self.tuples.iter().zip(&self.names) {
            builder = self.add_transitions(builder, tuple, *name, &coordinates)?;
        }
        builder
            .build()
            .map_err(|error| SpaceExError::Model { line: self.line, problem: error.to_string() })
    }

    fn add_location(
        &self,
        mut builder: Builder<Name, Name, Record>,
        tuple: &[usize],
        name: Name,
        coordinates: &BTreeMap<String, Coordinate<Record>>,
    ) -> Result<Builder<Name, Name, Record>> {
        let (mut rates, mut invariant): (Option<BTreeMap<String, Expression>>, Vec<Predicate>) =
            (Some(BTreeMap::new()), Vec::new());
        let mut line = self.line;
        for (instance, place) in self.network.instances.iter().zip(tuple) {
            let place = &instance.component.locations[*place];
            line = place.line;
            match (instance.rates(place)?, &mut rates) {
                (Some(listed), Some(rates)) => {
                    for (variable, rate) in listed {
                        if let Some(known) = rates.insert(variable.clone(), rate.clone())
                            && known != rate
                        {
                            let problem =
                                format!("two components give different rates of `{variable}`");
                            return Err(SpaceExError::Model { line, problem });
                        }
                    }
                }
                _ => rates = None,
            }
            for clause in instance.clauses(&place.invariant, place.line)? {
                // Bounds on inputs say what inputs are.
                if !self.is_input_bound(&clause) {
                    invariant.extend(predicate(&clause, place.line)?);
                }
            }
        }
        let mut listed: Vec<Rate<Record>> = Vec::new();
        for (variable, coordinate) in coordinates {
            match &rates {
                None => {}
                Some(rates) => match rates.get(variable) {
                    Some(rate) => listed.push(coordinate.rate(rate.clone())),
                    None => {
                        return Err(SpaceExError::Model {
                            line,
                            problem: format!(
                                "location `{name}` says nothing of `{variable}'`: write `{variable}' == 0` if it rests"
                            ),
                        });
                    }
                },
            }
        }
        builder = builder.flow(name, listed);
        if !invariant.is_empty() {
            builder = builder.invariant(name, Predicate::all(invariant));
        }
        Ok(builder)
    }

    /// A bound on an input alone.
    fn is_input_bound(&self, clause: &Clause) -> bool {
        let Clause::Compare { left, right, .. } = clause else { return false };
        let is_input = |side: &Side| {
            side.name().is_some_and(|name| self.inputs.iter().any(|(input, _)| input == name))
        };
        let is_number =
            |side: &Side| matches!(side, Side::Formula(formula) if formula.evaluate(&()).is_ok());
        is_input(left) && is_number(right) || is_input(right) && is_number(left)
    }

    /// The transitions from one tuple: one by one, and together by labels.
    fn add_transitions(
        &self,
        mut builder: Builder<Name, Name, Record>,
        tuple: &[usize],
        source: Name,
        coordinates: &BTreeMap<String, Coordinate<Record>>,
    ) -> Result<Builder<Name, Name, Record>> {
        for (at, instance) in self.network.instances.iter().enumerate() {
            for transition in leaving(instance, tuple[at]) {
                let label = self.label(instance, transition);
                let partners: Vec<usize> = match &label {
                    Some(label) => self.knowing(label),
                    None => vec![at],
                };
                // Of those who take a label together, the first speaks for all.
                if partners.first() != Some(&at) {
                    continue;
                }
                let mut together = vec![vec![(at, transition)]];
                for &partner in &partners[1..] {
                    let other = &self.network.instances[partner];
                    let joining: Vec<&Transition> = leaving(other, tuple[partner])
                        .filter(|one| self.label(other, one) == label)
                        .collect();
                    together = together
                        .iter()
                        .flat_map(|group| {
                            joining.iter().map(move |one| [&group[..], &[(partner, *one)]].concat())
                        })
                        .collect();
                }
                for group in together {
                    builder = self.add_joint(
                        builder,
                        tuple,
                        source,
                        &group,
                        label.as_deref(),
                        coordinates,
                    )?;
                }
            }
        }
        Ok(builder)
    }

    fn label(&self, instance: &Instance<'_>, transition: &Transition) -> Option<String> {
        let label = transition.label.trim();
        instance.global(label).map(str::to_owned)
    }

    /// The instances that know a label.
    fn knowing(&self, label: &str) -> Vec<usize> {
        let knows = |instance: &Instance<'_>| {
            instance.names.values().any(|bound| *bound == Bound::Name(label.to_owned()))
        };
        let instances = self.network.instances.iter().enumerate();
        instances.filter(|(_, instance)| knows(instance)).map(|(at, _)| at).collect()
    }

    fn add_joint(
        &self,
        builder: Builder<Name, Name, Record>,
        tuple: &[usize],
        source: Name,
        group: &[(usize, &Transition)],
        label: Option<&str>,
        coordinates: &BTreeMap<String, Coordinate<Record>>,
    ) -> Result<Builder<Name, Name, Record>> {
        let mut target = tuple.to_vec();
        let (mut guard, mut assignments, mut is_urgent) = (Vec::new(), Vec::new(), false);
        for (at, transition) in group {
            let instance = &self.network.instances[*at];
            let wrong = |problem: String| SpaceExError::Model { line: transition.line, problem };
            let places = &instance.component.locations;
            let place = places.iter().position(|place| place.id == transition.target);
            target[*at] = place.ok_or_else(|| {
                wrong(format!("there is no location with id {}", transition.target))
            })?;
            is_urgent |= transition.is_urgent;
            for clause in instance.clauses(&transition.guard, transition.line)? {
                guard.extend(predicate(&clause, transition.line)?);
            }
            let number = instance
                .component
                .transitions
                .iter()
                .position(|one| std::ptr::eq(one, *transition));
            for (name, assigned) in instance.assignments(transition)? {
                let value = match assigned {
                    Assigned::Value(value) => value,
                    Assigned::Within(..) => {
                        variable(&drawn_name(instance, number.unwrap_or(0), &name))
                    }
                };
                let coordinate = coordinates
                    .get(&name)
                    .ok_or_else(|| wrong(format!("`{name}` cannot be assigned")))?;
                assignments.push(coordinate.becomes(value));
            }
        }
        let target = self.tuples.iter().position(|other| *other == target).map(|at| self.names[at]);
        let target = target.unwrap_or(source);
        let event = Name::new(label.unwrap_or("jump"));
        let arrow = from(source).on(event).to(target);
        let guard = Predicate::all(guard);
        let edge = if is_urgent { arrow.must(guard) } else { arrow.may(guard) };
        Ok(builder.transition(edge.then(assignments)))
    }
}

/// The transitions that leave a place.
fn leaving<'a>(instance: &Instance<'a>, place: usize) -> impl Iterator<Item = &'a Transition> {
    let id = &instance.component.locations[place].id;
    instance.component.transitions.iter().filter(move |transition| transition.source == *id)
}

/// The name of a location; with its id where several have it.
fn location_name(component: &Component, place: usize) -> String {
    let own = &component.locations[place];
    let is_repeated = component.locations.iter().filter(|other| other.name == own.name).count() > 1;
    if is_repeated { format!("{}#{}", own.name, own.id) } else { own.name.clone() }
}

/// The name of what an assignment leaves open.
fn drawn_name(instance: &Instance<'_>, transition: usize, variable: &str) -> String {
    let prefix =
        if instance.name.is_empty() { String::new() } else { format!("{}_", instance.name) };
    format!("{prefix}{variable}_after_{}", transition + 1)
}

/// A clause as a predicate; nothing for one about locations.
fn predicate(clause: &Clause, line: usize) -> Result<Option<Predicate>> {
    Ok(match clause {
        Clause::Always | Clause::Location { .. } => None,
        Clause::Never => Some(crate::guards::never()),
        Clause::Compare { left: Side::Formula(left), relation, right: Side::Formula(right) } => {
            Some(relation.predicate(left, right))
        }
        Clause::Compare { left, right, .. } => {
            let primed = [left, right].into_iter().find_map(|side| match side {
                Side::Primed(name) => Some(name.as_str()),
                Side::Formula(_) => None,
            });
            return Err(SpaceExError::Model {
                line,
                problem: format!("`{}'` cannot stand in a condition", primed.unwrap_or_default()),
            });
        }
    })
}

/// Between which numbers clauses keep a variable, over all alternatives.
fn fixed(alternatives: &[Vec<Clause>], name: &str) -> Option<Interval> {
    let within = |clauses: &Vec<Clause>| -> Option<Interval> {
        let (mut lower, mut upper) = (f64::NEG_INFINITY, f64::INFINITY);
        for clause in clauses {
            let Clause::Compare {
                left: Side::Formula(left),
                relation,
                right: Side::Formula(right),
            } = clause
            else {
                continue;
            };
            let is_name =
                |side: &Expression| matches!(side, Expression::Variable(own) if **own == *name);
            let (value, relation) = match (left.evaluate(&()), right.evaluate(&())) {
                (_, Ok(value)) if is_name(left) => (value, *relation),
                (Ok(value), _) if is_name(right) => (
                    value,
                    match relation {
                        Relation::AtMost | Relation::LessThan => Relation::AtLeast,
                        Relation::AtLeast | Relation::MoreThan => Relation::AtMost,
                        equal => *equal,
                    },
                ),
                _ => continue,
            };
            match relation {
                Relation::AtMost | Relation::LessThan => upper = upper.min(value),
                Relation::AtLeast | Relation::MoreThan => lower = lower.max(value),
                Relation::Equal | Relation::Assigned => {
                    (lower, upper) = (lower.max(value), upper.min(value));
                }
            }
        }
        let is_known = lower.is_finite() || upper.is_finite();
        is_known.then(|| Interval::new(lower, upper).ok()).flatten()
    };
    let mut hull: Option<Interval> = None;
    for clauses in alternatives {
        let within = within(clauses)?;
        hull = Some(hull.map_or(within, |known| known.hull(within)));
    }
    hull
}
