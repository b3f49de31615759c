//! The product of the instances of a network, and the question over it.

mod clause;
mod jump;
mod place;
mod question;

use std::collections::BTreeMap;

use crate::automaton::{Automaton, Coordinate, Name, Record};
use crate::guards::{Expression, Interval, Substitution, constant, variable};
use crate::verify::reach::Uncertain;

use super::configuration::Options;
use super::document::{Component, Transition};
use super::formula::Relation;
use super::network::Network;
use super::{Initial, Problem, SpaceExError};
use clause::{bound, fixed};

/// How many locations a product may have.
const LOCATIONS: usize = 4096;

type Result<T> = std::result::Result<T, SpaceExError>;

/// The problem that components and configuration pose.
pub(super) fn problem(components: &[Component], options: Options) -> Result<Problem> {
    let system = system(components, &options)?;
    let network = Network::of(components, system)?;
    let options = options.in_names_of(&network);
    let product = Product::of(&network, system.line, &options)?;
    product.problem(system.id.clone(), &options)
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
    /// Inputs with other bounds in other locations, each with its bounds by tuple: of these the share of
    /// the way from the middle of the bounds is an input, between −1 and 1.
    shares: BTreeMap<String, Vec<Interval>>,
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
            shares: BTreeMap::new(),
            constants: Vec::new(),
            tuples: Vec::new(),
            names: Vec::new(),
        };
        product.enumerate()?;
        product.classify(options)?;
        Ok(product)
    }

    /// Whether a name is that of a coordinate, an input or a constant.
    fn is_number(&self, name: &str) -> bool {
        let others = self.constants.iter().chain(&self.inputs).map(|(name, _)| name);
        self.variables.iter().chain(others).any(|known| known == name)
    }

    fn is_input(&self, name: &str) -> bool {
        self.shares.contains_key(name) || self.inputs.iter().any(|(input, _)| input == name)
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
            let wrong = |problem| Err(SpaceExError::Model { line: known.line, problem });
            if flowing.contains(name) && known.is_constant {
                return wrong(format!(
                    "`{name}` is a constant, and has a flow or is assigned: make its dynamics any"
                ));
            } else if flowing.contains(name) {
                self.variables.push(name.clone());
            } else if known.is_constant {
                let Some(values) = fixed(&options.initially.1, name) else {
                    return wrong(format!(
                        "`{name}` is a constant without a value: bind it to a number, or give it one in `initially`"
                    ));
                };
                self.constants.push((name.clone(), values));
            } else {
                let bounds = self.input_bounds(name)?;
                let bounds =
                    bounds.map_err(|problem| SpaceExError::Model { line: known.line, problem })?;
                let (first, others) = (bounds[0], &bounds[1..]);
                if others.iter().all(|other| *other == first) {
                    self.inputs.push((name.clone(), first));
                } else {
                    let share = Interval::point(-1.0).hull(Interval::point(1.0));
                    self.inputs.push((self.share_of(name), share));
                    self.shares.insert(name.clone(), bounds);
                }
            }
        }
        Ok(())
    }

    /// Between which numbers the invariants keep an input, by location; or else what is wrong.
    fn input_bounds(&self, name: &str) -> Result<std::result::Result<Vec<Interval>, String>> {
        let mut known: Vec<Interval> = Vec::new();
        let mut has_strict = false;
        for (tuple, location) in self.tuples.iter().zip(&self.names) {
            let mut clauses = Vec::new();
            for (instance, place) in self.network.instances.iter().zip(tuple) {
                clauses.extend(instance.clauses(&instance.component.locations[*place].invariant)?);
            }
            let bounds = fixed(std::slice::from_ref(&clauses), name)
                .filter(|bounds| bounds.width().is_finite());
            let Some(bounds) = bounds else {
                return Ok(Err(format!(
                    "`{name}` has neither a flow nor bounds in location `{location}`: give it a flow, or keep it \
                     between two numbers in the invariants of every location"
                )));
            };
            let of_input = clauses.iter().filter_map(bound).filter(|(own, ..)| *own == name);
            let mut relations = of_input.map(|(_, relation, _)| relation);
            has_strict |= relations.any(|it| matches!(it, Relation::LessThan | Relation::MoreThan));
            known.push(bounds);
        }
        let Some(first) = known.first() else {
            return Ok(Err(format!("`{name}` is in no location")));
        };
        let other = self.names.iter().zip(&known).find(|(_, bounds)| *bounds != first);
        Ok(match other.filter(|_| has_strict) {
            Some((location, bounds)) => Err(format!(
                "`{name}` is kept in {first} in location `{}`, and in {bounds} in `{location}`, and some of its \
                 bounds are strict: give this input the same bounds in every location",
                self.names[0]
            )),
            None => Ok(known),
        })
    }

    /// The input that says where another one is within its bounds. No number of the model has its name.
    fn share_of(&self, input: &str) -> String {
        let Network { known, outputs, .. } = self.network;
        let mut name = format!("{input}_share");
        while known.contains_key(&name) || outputs.contains_key(&name) {
            name.push('_');
        }
        name
    }

    /// What stands in a location for inputs whose bounds are not the same in all of them.
    fn of_shares(&self, location: usize) -> Substitution {
        Substitution::new(self.shares.iter().map(|(name, bounds)| {
            let (middle, bounds) = (bounds[location].midpoint(), bounds[location]);
            let radius = (bounds.upper() - middle).max(middle - bounds.lower()).next_up();
            (name, constant(middle) + constant(radius) * variable(&self.share_of(name)))
        }))
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
        // Names of components may come to the same one, side by side: their ids do not.
        let mut sorted = self.names.clone();
        sorted.sort_unstable();
        let is_repeated = |name: &Name| {
            let first = sorted.partition_point(|other| other < name);
            sorted.get(first + 1) == Some(name)
        };
        for (name, tuple) in self.names.iter_mut().zip(&self.tuples) {
            if is_repeated(name) {
                let places = tuple.iter().zip(&self.network.instances);
                let ids = places.map(|(place, it)| it.component.locations[*place].id.as_str());
                *name = Name::new(&format!("{name} ({})", ids.collect::<Vec<_>>().join(", ")));
            }
        }
        Ok(())
    }

    fn problem(&self, system: String, options: &Options) -> Result<Problem> {
        if self.tuples.is_empty() || self.network.instances.is_empty() {
            return self.wrong(format!("component `{system}` has no locations"));
        }
        let initial = self.initial(options)?;
        let mut begins: Vec<&String> = initial.iter().flat_map(|one| &one.locations).collect();
        // The first one is enclosed, and has to have all transitions if any can be taken.
        begins.sort_by_key(|name| (self.is_isolated(name), *name));
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
        Ok(Problem {
            system,
            automata,
            uncertain,
            initial,
            forbidden: self.forbidden(options)?,
            settings: self.settings(options)?,
            shown: self.shown(options)?,
        })
    }

    /// Whether no transition of any component leaves this location or leads there.
    fn is_isolated(&self, name: &str) -> bool {
        let tuple = self.names.iter().position(|known| known.as_str() == name);
        let Some(tuple) = tuple.map(|at| &self.tuples[at]) else { return false };
        self.network.instances.iter().zip(tuple).all(|(instance, place)| {
            let id = &instance.component.locations[*place].id;
            let touches = |one: &Transition| one.source == *id || one.target == *id;
            !instance.component.transitions.iter().any(touches)
        })
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
        for (name, values) in self.constants.iter().chain(&self.inputs) {
            builder = builder.parameter(name, values.midpoint());
        }
        // An output of an input with other bounds in other locations has no formula for all of them.
        let is_one =
            |formula: &Expression| formula.variables().into_iter().all(|name| self.is_number(name));
        for (name, formula) in self.network.outputs.iter().filter(|(_, it)| is_one(it)) {
            builder = builder.signal(name, formula);
        }
        for location in 0..self.tuples.len() {
            builder = self.add_location(builder, location, &coordinates)?;
        }
        // Transitions that lead neither from the first location nor to it are no part of such an automaton.
        if !self.is_isolated(first.as_str()) {
            for source in 0..self.tuples.len() {
                builder = self.add_transitions(builder, source, &coordinates)?;
            }
        }
        builder
            .build()
            .map_err(|error| SpaceExError::Model { line: self.line, problem: error.to_string() })
    }
}

/// The name of a location; with its id where several have it.
fn location_name(component: &Component, place: usize) -> String {
    let own = &component.locations[place];
    let is_repeated = component.locations.iter().filter(|other| other.name == own.name).count() > 1;
    if is_repeated { format!("{}#{}", own.name, own.id) } else { own.name.clone() }
}
