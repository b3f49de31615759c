//! What is enclosed: locations with their flows, invariants and jumps, over numbered variables.

mod forms;

use pleach_automaton::{Automaton, Coordinates, NewValue};
use pleach_discrete::{Event, Location};
use pleach_guards::{Expression, Interval, Predicate, Substitution, constant};
use thiserror::Error;

use super::affine::AffineFlow;
use super::region::{Named, Region, RegionError};
use super::vector::{IntervalMatrix, dot};

/// A hybrid automaton for sets: the data of an [`Automaton`], with inputs that are only known to
/// lie in intervals.
#[derive(Clone, Debug)]
pub struct Model {
    variables: Vec<String>,
    locations: Vec<Mode>,
    /// Where a run begins, by number of the location.
    initial: Vec<usize>,
}

/// A location.
#[derive(Clone, Debug)]
pub struct Mode {
    /// Its name.
    pub name: String,
    /// What holds while time passes.
    pub invariant: Region,
    /// How the state changes.
    pub flow: Dynamics,
    /// What leaves it.
    pub jumps: Vec<Jump>,
}

/// How the state changes in a location.
#[derive(Clone, Debug)]
pub enum Dynamics {
    /// ẋ = A x + v, v ∈ V.
    Affine(AffineFlow),
    /// The rate of each variable.
    Formulas(Vec<Expression>),
}

/// A transition.
#[derive(Clone, Debug)]
pub struct Jump {
    /// The name of its event.
    pub event: String,
    /// The number of the location it leads to.
    pub target: usize,
    /// When it may be taken.
    pub guard: Region,
    /// Whether time has to wait for it.
    pub is_forced: bool,
    /// What it does to the state.
    pub reset: Assignments,
}

/// x⁺ from x⁻.
#[derive(Clone, Debug)]
pub enum Assignments {
    /// x⁺ = M x⁻ + w with w in a box.
    Affine(IntervalMatrix, Vec<Interval>),
    /// The new value of each variable, over x⁻.
    Formulas(Vec<NewValue>),
}

/// What is only known to lie in an interval.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertain {
    /// The name of a parameter of the automaton.
    pub parameter: String,
    /// Its values.
    pub values: Interval,
    /// Whether it may change at every instant; otherwise it has one value throughout.
    pub varies: bool,
}

/// Why there is no enclosure of a model.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ModelError {
    /// A flow is a function.
    #[error("the flow of location `{location}` is a function: write its rates as formulas")]
    Flow {
        /// The location.
        location: String,
    },
    /// A reset is a function.
    #[error(
        "the reset of event `{event}` in location `{location}` is a function: write assignments"
    )]
    Reset {
        /// The location.
        location: String,
        /// The event.
        event: String,
    },
    /// A guard or an invariant cannot be used.
    #[error("location `{location}`: {source}")]
    Region {
        /// The location.
        location: String,
        /// Why.
        source: RegionError,
    },
    /// An input multiplies the state, or stands in a formula that is not affine.
    #[error(
        "input `{input}` enters the flow of location `{location}` other than added with a \
             factor: make it a constant parameter, or the flow affine"
    )]
    Input {
        /// The input.
        input: String,
        /// The location.
        location: String,
    },
    /// There is no such parameter.
    #[error("`{parameter}` is not a parameter of the automaton")]
    Parameter {
        /// The name.
        parameter: String,
    },
    /// An event is taken at samples, by a clock that is no coordinate.
    #[error(
        "event `{event}` is sampled, by a clock that is no coordinate of the automaton: enclose \
         `automaton.alone()?.product()?`, which has the clock"
    )]
    Sampled {
        /// The event.
        event: String,
    },
    /// There is nothing to begin with.
    #[error("the automaton has no initial state: say it with `initially`")]
    Initial,
    /// There is no such location.
    #[error("there is no location `{location}`")]
    Location {
        /// The name.
        location: String,
    },
    /// A formula reads what is no variable.
    #[error("location `{location}` reads `{variable}`, which is no variable of the model")]
    Variable {
        /// The location.
        location: String,
        /// The name.
        variable: String,
    },
}

impl Dynamics {
    /// Bounds on the rates of the variables, which have these names, in a box.
    pub(super) fn rates(&self, variables: &[String], sides: &[Interval]) -> Vec<Interval> {
        match self {
            Dynamics::Affine(flow) => {
                let inputs = flow.inputs().hull().into_iter().enumerate();
                inputs.map(|(row, input)| dot(flow.matrix().row(row), sides) + input).collect()
            }
            Dynamics::Formulas(rates) => {
                let named = Named { names: variables, sides };
                let range = |rate: &Expression| rate.range(&named).unwrap_or(Interval::WHOLE);
                rates.iter().map(range).collect()
            }
        }
    }
}

impl Model {
    /// The model of these parts.
    pub fn new(variables: Vec<String>, locations: Vec<Mode>, initial: Vec<usize>) -> Self {
        Model { variables, locations, initial }
    }

    /// The model of an automaton.
    ///
    /// # Errors
    ///
    /// [`ModelError`] if a part of it is a function, it has no initial state, or it samples events.
    pub fn of<L: Location, E: Event, S: Coordinates>(
        automaton: &Automaton<L, E, S>,
    ) -> Result<Self, ModelError> {
        Model::with_uncertain(automaton, &[])
    }

    /// The model of an automaton, some of whose parameters are only known to lie in intervals. Those
    /// that do not vary become variables that rest.
    ///
    /// # Errors
    ///
    /// [`ModelError`] if a part of the automaton is a function, it has no initial state or no such
    /// parameter, it samples events, or an input enters a flow in another way than added with a factor.
    pub fn with_uncertain<L: Location, E: Event, S: Coordinates>(
        automaton: &Automaton<L, E, S>,
        uncertain: &[Uncertain],
    ) -> Result<Self, ModelError> {
        let unknown = uncertain
            .iter()
            .find(|one| !automaton.parameters().any(|(name, _)| name == one.parameter));
        if let Some(Uncertain { parameter, .. }) = unknown {
            return Err(ModelError::Parameter { parameter: parameter.clone() });
        }
        if let Some(event) = automaton.sampled_events().next() {
            return Err(ModelError::Sampled { event: event.name().to_owned() });
        }
        let example = automaton.initial_state().ok_or(ModelError::Initial)?;
        let mut variables: Vec<String> = example.names().iter().map(ToString::to_string).collect();
        let constants = uncertain.iter().filter(|one| !one.varies);
        variables.extend(constants.map(|one| one.parameter.clone()));
        let inputs: Vec<&Uncertain> = uncertain.iter().filter(|one| one.varies).collect();
        let is_certain = |name: &str| !uncertain.iter().any(|one| one.parameter == name);
        let numbers = automaton.parameters().filter(|(name, _)| is_certain(name));
        let numbers = Substitution::new(numbers.map(|(name, value)| (name, constant(value))));
        let reader = Reader { automaton, variables: &variables, inputs, numbers };
        let locations = automaton.locations().iter().map(|location| reader.mode(*location));
        let locations = locations.collect::<Result<Vec<_>, _>>()?;
        let initial = automaton.locations().iter().position(|it| *it == automaton.initial());
        Ok(Model { locations, initial: initial.into_iter().collect(), variables })
    }

    /// The same model with runs that begin in other locations.
    ///
    /// # Errors
    ///
    /// [`ModelError::Location`] if there is no location of such a name.
    pub fn beginning_in(mut self, locations: &[String]) -> Result<Self, ModelError> {
        let place = |name: &String| {
            let found = self.locations.iter().position(|place| place.name == *name);
            found.ok_or_else(|| ModelError::Location { location: name.clone() })
        };
        self.initial = locations.iter().map(place).collect::<Result<_, _>>()?;
        Ok(self)
    }

    /// The names of the variables.
    pub fn variables(&self) -> &[String] {
        &self.variables
    }

    /// The locations.
    pub fn locations(&self) -> &[Mode] {
        &self.locations
    }

    /// The numbers of the locations in which runs begin.
    pub fn initial(&self) -> &[usize] {
        &self.initial
    }
}

/// Reads an automaton.
struct Reader<'a, L, E, S> {
    automaton: &'a Automaton<L, E, S>,
    variables: &'a [String],
    inputs: Vec<&'a Uncertain>,
    numbers: Substitution,
}

impl<L: Location, E: Event, S: Coordinates> Reader<'_, L, E, S> {
    fn mode(&self, location: L) -> Result<Mode, ModelError> {
        let name = location.name().to_owned();
        let own = self.automaton.mode(location);
        let invariant = own.and_then(|own| own.invariant.as_ref());
        let invariant = match invariant {
            Some(invariant) => self.region(&name, invariant)?,
            None => Region { alternatives: vec![Default::default()] },
        };
        let mut rates = vec![constant(0.0); self.variables.len()];
        if let Some(flow) = own.and_then(|own| own.flow.as_ref()) {
            let listed = flow.rates().ok_or_else(|| ModelError::Flow { location: name.clone() })?;
            for rate in listed {
                if let Some(place) = self.place_of(rate.coordinate()) {
                    rates[place] = rate.rate().substitute(&self.numbers);
                }
            }
        }
        let inputs: Vec<(&str, Interval)> =
            self.inputs.iter().map(|input| (input.parameter.as_str(), input.values)).collect();
        let flow = Dynamics::of(&name, rates, self.variables, &inputs)?;
        let jumps = self.jumps(location, &name)?;
        Ok(Mode { name, invariant, flow, jumps })
    }

    fn region(&self, location: &str, predicate: &Predicate) -> Result<Region, ModelError> {
        let predicate = predicate.substitute(&self.numbers);
        Region::of(&predicate, self.variables)
            .map_err(|source| ModelError::Region { location: location.to_owned(), source })
    }

    fn place_of(&self, variable: &str) -> Option<usize> {
        self.variables.iter().position(|name| name == variable)
    }

    fn jumps(&self, location: L, name: &str) -> Result<Vec<Jump>, ModelError> {
        let graph = self.automaton.graph();
        let mut jumps = Vec::new();
        for edge in graph.edge_indices() {
            let Some((source, target)) = graph.edge_endpoints(edge) else { continue };
            if graph[source] != location {
                continue;
            }
            let transition = &graph[edge];
            let event = transition.event.name().to_owned();
            let assignments = transition.reset.assignments().ok_or_else(|| ModelError::Reset {
                location: name.to_owned(),
                event: event.clone(),
            })?;
            let unchanged = |name: &String| NewValue::Exactly(pleach_guards::variable(name));
            let mut values: Vec<NewValue> = self.variables.iter().map(unchanged).collect();
            for assignment in assignments {
                if let Some(place) = self.place_of(assignment.coordinate()) {
                    values[place] = assignment.value().substitute(&self.numbers);
                }
            }
            let inputs: Vec<(&str, Interval)> =
                self.inputs.iter().map(|input| (input.parameter.as_str(), input.values)).collect();
            jumps.push(Jump {
                event,
                target: target.index(),
                guard: self.region(name, transition.guard.predicate())?,
                is_forced: transition.urgency.is_forced(),
                reset: Assignments::of(name, values, self.variables, &inputs)?,
            });
        }
        Ok(jumps)
    }
}
