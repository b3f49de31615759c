//! How components are put side by side, and what can be wrong with it.

use std::sync::Arc;

use pleach_discrete::{Event, Location};
use pleach_guards::EvaluationError;
use thiserror::Error;

use super::blueprint::{Blueprint, Change, Place, PlaceMotion};
use super::{Accumulation, Channel, Component, Composition, Label};
use crate::automaton::Automaton;
use crate::check::model::Model;
use crate::coordinates::Coordinates;

/// A [`Composition`] under construction.
#[derive(Default)]
#[must_use = "a composition is complete after `build`"]
pub struct CompositionBuilder {
    parts: Vec<Part>,
    labels: Vec<String>,
    /// From an output to an input.
    connections: Vec<(String, String)>,
    /// Components that carry messages; they come after all others.
    channels: Vec<Channel>,
    /// Whether the part added last is the first of many that are alike.
    is_each: bool,
    /// The first thing that was wrong with a part.
    fault: Option<CompositionError>,
}

#[derive(Clone)]
struct Part {
    name: String,
    blueprint: Arc<Blueprint>,
    model: Arc<Model>,
    initial: Vec<f64>,
    renamed: Vec<(String, String)>,
    accumulation: Option<Accumulation>,
    continuation: Option<usize>,
}

/// Why the parts do not make a composition.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum CompositionError {
    /// Two components have one name.
    #[error("two components are called `{name}`: rename one")]
    NameTwice {
        /// The name.
        name: String,
    },
    /// Nothing says in which state a component starts.
    #[error(
        "component `{component}` has no initial state: give its automaton one with `initially`, \
         or add it with `add_in`"
    )]
    NoInitialState {
        /// The component.
        component: String,
    },
    /// A formula names a variable that the state does not have.
    #[error("component `{component}`: {source}")]
    Formula {
        /// The component.
        component: String,
        /// What is wrong with the formula.
        source: EvaluationError,
    },
    /// No component has an event of a name that is asked for.
    #[error("label `{label}` is an event of no component")]
    UnknownLabel {
        /// The label.
        label: String,
    },
    /// An event is spoken of before any component is added, or the component has no such event.
    #[error("the component added last has no event `{event}`")]
    UnknownEvent {
        /// The name before.
        event: String,
    },
    /// A connection begins or ends at a variable that does not exist.
    #[error("no component has the variable `{variable}`: write `component.coordinate`")]
    UnknownVariable {
        /// The variable.
        variable: String,
    },
    /// An input is connected twice, or reads something that is an input itself.
    #[error("input `{input}` cannot be connected to `{output}`: {reason}")]
    Connection {
        /// What was to be read.
        output: String,
        /// The reader.
        input: String,
        /// What stands against it.
        reason: &'static str,
    },
    /// A component changes what it only reads.
    #[error(
        "component `{component}` changes `{coordinate}` in location `{location}`, but reads it \
         from another component"
    )]
    InputChanged {
        /// The component.
        component: String,
        /// The coordinate.
        coordinate: &'static str,
        /// The location with the flow or the transition that does.
        location: &'static str,
    },
    /// A channel begins or ends at an event that does not exist.
    #[error("no component has the event `{event}`: write `component.event`")]
    UnknownMessage {
        /// The event.
        event: String,
    },
    /// Two channels end at one event.
    #[error("`{event}` is the end of two channels: give the receiver an event for each sender")]
    HeardTwice {
        /// The event.
        event: String,
    },
    /// A message that has to arrive in time would find its receiver unable to take it.
    #[error(
        "messages have to arrive at `{event}` in time, but component `{component}` has no \
         transition with that event from location `{location}`: add one, if only to ignore them"
    )]
    NotReceptive {
        /// The receiver.
        component: String,
        /// Its event.
        event: String,
        /// Where it cannot take a message.
        location: &'static str,
    },
    /// A channel cannot be.
    #[error("channel `{channel}`: {reason}")]
    Channel {
        /// Its name.
        channel: String,
        /// What stands against it.
        reason: &'static str,
    },
    /// A component slides along a surface that depends on what it only reads.
    #[error(
        "component `{component}` slides along a surface that depends on `{coordinate}`, but reads it \
         from another component: of its rate nothing is known there"
    )]
    SurfaceReads {
        /// The component.
        component: String,
        /// The coordinate.
        coordinate: &'static str,
    },
    /// There is no component at all.
    #[error("a composition needs at least one component")]
    Empty,
}

impl CompositionBuilder {
    /// Adds `automaton` as a component; it starts in the initial state of the automaton.
    pub fn add<L: Location, E: Event, S: Coordinates>(
        mut self,
        name: &str,
        automaton: &Automaton<L, E, S>,
    ) -> Self {
        match automaton.initial_state() {
            Some(state) => {
                let state = state.clone();
                self.add_in(name, automaton, state)
            }
            None => {
                self.fault(CompositionError::NoInitialState { component: name.to_owned() });
                self
            }
        }
    }

    /// Adds `automaton` as a component that starts in `state`.
    pub fn add_in<L: Location, E: Event, S: Coordinates>(
        mut self,
        name: &str,
        automaton: &Automaton<L, E, S>,
        state: S,
    ) -> Self {
        let initial = |blueprint: Blueprint| -> Result<(Blueprint, Vec<f64>), EvaluationError> {
            let value = |name: &&'static str| {
                let unknown = || EvaluationError::UnknownVariable { variable: (*name).to_owned() };
                state.value(name).ok_or_else(unknown)
            };
            let values = blueprint.coordinates.iter().map(value).collect::<Result<_, _>>()?;
            Ok((blueprint, values))
        };
        match Blueprint::of(automaton).and_then(initial) {
            Ok((blueprint, initial)) => self.parts.push(Part {
                name: name.to_owned(),
                blueprint: Arc::new(blueprint),
                model: Arc::new(Model::of(automaton)),
                initial,
                renamed: Vec::new(),
                accumulation: None,
                continuation: None,
            }),
            Err(source) => {
                self.fault(CompositionError::Formula { component: name.to_owned(), source });
            }
        }
        self
    }

    /// Adds a component of `automaton` for each name, in its initial state: with many of them, in
    /// much less time and memory than one by one.
    pub fn add_each<L: Location, E: Event, S: Coordinates>(
        mut self,
        names: impl IntoIterator<Item = impl Into<String>>,
        automaton: &Automaton<L, E, S>,
    ) -> Self {
        for name in names {
            let name = name.into();
            let Some(like) = self.parts.last().filter(|_| self.is_each).cloned() else {
                self = self.add(&name, automaton);
                self.is_each = true;
                continue;
            };
            self.parts.push(Part { name, ..like });
        }
        self.is_each = false;
        self
    }

    /// What happens where jumps of the component added last accumulate.
    pub fn at_accumulation(mut self, accumulation: Accumulation) -> Self {
        if let Some(part) = self.parts.last_mut() {
            part.accumulation = Some(accumulation);
        }
        self
    }

    /// Where jumps of the component added last accumulate, time goes on to the limit point and the
    /// component takes `event` there, whatever the guard of the transition says: the model knows
    /// what comes after infinitely many jumps.
    pub fn past_accumulation(mut self, event: &str) -> Self {
        let part = self.parts.last_mut();
        match part.and_then(|part| Some((part.event(event)?, part))) {
            Some((number, part)) => part.continuation = Some(number),
            None => self.fault(CompositionError::UnknownEvent { event: event.to_owned() }),
        }
        self
    }

    /// In the component added last, `event` is called `name`: so that it can share a label with
    /// some components and not with others of its kind.
    pub fn rename(mut self, event: &str, name: &str) -> Self {
        match self.parts.last_mut().filter(|part| part.blueprint.events.contains(&event)) {
            Some(part) => part.renamed.push((event.to_owned(), name.to_owned())),
            None => self.fault(CompositionError::UnknownEvent { event: event.to_owned() }),
        }
        self
    }

    /// All components that have an event called `name` take it together.
    pub fn label(mut self, name: &str) -> Self {
        self.labels.push(name.to_owned());
        self
    }

    /// The coordinate `input` of a component is the coordinate `output` of another; both are
    /// written `component.coordinate`.
    pub fn connect(mut self, output: &str, input: &str) -> Self {
        self.connections.push((output.to_owned(), input.to_owned()));
        self
    }

    /// Messages go from one component to another, or back to the same. The channel becomes a
    /// component after all others, and the events of both ends are then called `component.event`,
    /// unless they are labels with a name already.
    pub fn channel(mut self, channel: Channel) -> Self {
        self.channels.push(channel);
        self
    }

    /// The composition.
    ///
    /// # Errors
    ///
    /// The first [`CompositionError`] found: in the components, the connections, the labels.
    pub fn build(mut self) -> Result<Composition, CompositionError> {
        if let Some(fault) = self.fault.take() {
            return Err(fault);
        }
        self = self.join_channels()?;
        self.check_names()?;
        let sources = self.sources()?;
        let mut composition = Composition {
            components: Vec::with_capacity(self.parts.len()),
            labels: Vec::new(),
            variables: Vec::new(),
            initial: Vec::new(),
            groups: Vec::new(),
        };
        let slots = self.lay_out(&sources, &mut composition);
        let labels = self.labels()?;
        for (index, part) in self.parts.into_iter().enumerate() {
            let first = slots.offsets[index];
            let places = first..first + part.blueprint.coordinates.len();
            let own_label = |event| {
                labels.iter().position(|label| label.participants.contains(&(index, event)))
            };
            let component = Component {
                events: part.event_names().map(str::to_owned).collect(),
                name: part.name,
                slots: slots.slots[places.clone()].to_vec(),
                owned: sources[places].iter().map(Option::is_none).collect(),
                labels: (0..part.blueprint.events.len()).map(own_label).collect(),
                blueprint: part.blueprint,
                model: part.model,
                group: 0,
                places: Vec::new(),
                accumulation: part.accumulation,
                continuation: part.continuation,
            };
            component.check_inputs()?;
            composition.components.push(component);
        }
        composition.labels = labels;
        composition.form_groups();
        Ok(composition)
    }

    fn fault(&mut self, fault: CompositionError) {
        self.fault.get_or_insert(fault);
    }

    /// Turns channels into components.
    fn join_channels(mut self) -> Result<Self, CompositionError> {
        let mut heard: Vec<String> = Vec::new();
        for channel in std::mem::take(&mut self.channels) {
            let (send, _) = self.end_of_channel(&channel.output, None)?;
            let shared = (channel.inputs.len() > 1).then(|| channel.name.clone());
            let mut arrive = String::new();
            for input in &channel.inputs {
                if heard.contains(input) {
                    return Err(CompositionError::HeardTwice { event: input.clone() });
                }
                let receiver;
                (arrive, receiver) = self.end_of_channel(input, shared.as_deref())?;
                if channel.has_deadline() {
                    self.parts[receiver].check_receptive(&arrive)?;
                }
                heard.push(input.clone());
            }
            self = channel.join(self, &send, &arrive)?;
        }
        match self.fault.take() {
            Some(fault) => Err(fault),
            None => Ok(self),
        }
    }

    /// The label of an event at which a channel begins or ends, written `component.event`, and the
    /// number of the component. The label is `label`, or else what is written.
    fn end_of_channel(
        &mut self,
        event: &str,
        label: Option<&str>,
    ) -> Result<(String, usize), CompositionError> {
        let label = label.unwrap_or(event);
        for (number, part) in self.parts.iter_mut().enumerate() {
            let own = event.strip_prefix(&*part.name).and_then(|it| it.strip_prefix('.'));
            let Some(own) = own else { continue };
            if part.event(label).is_some() {
                return Ok((label.to_owned(), number));
            }
            let Some(place) = part.event(own) else { continue };
            if label == event && self.labels.iter().any(|label| label == own) {
                return Ok((own.to_owned(), number));
            }
            let before = part.blueprint.events[place];
            part.renamed.retain(|(renamed, _)| renamed != before);
            part.renamed.push((before.to_owned(), label.to_owned()));
            return Ok((label.to_owned(), number));
        }
        Err(CompositionError::UnknownMessage { event: event.to_owned() })
    }

    fn check_names(&self) -> Result<(), CompositionError> {
        if self.parts.is_empty() {
            return Err(CompositionError::Empty);
        }
        let mut names: Vec<&String> = self.parts.iter().map(|part| &part.name).collect();
        names.sort_unstable();
        match names.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(CompositionError::NameTwice { name: pair[0].clone() }),
            None => Ok(()),
        }
    }

    /// For every coordinate of every component in turn: the coordinate that it reads, if it is an
    /// input.
    fn sources(&self) -> Result<Vec<Option<usize>>, CompositionError> {
        let names = self.full_names();
        let find = |variable: &String| {
            let unknown = || CompositionError::UnknownVariable { variable: variable.clone() };
            names.iter().position(|name| name == variable).ok_or_else(unknown)
        };
        let mut sources = vec![None; names.len()];
        let mut read = vec![false; names.len()];
        for (output, input) in &self.connections {
            let (from, to) = (find(output)?, find(input)?);
            let reason = if from == to {
                Some("a coordinate cannot read itself")
            } else if sources[to].is_some() {
                Some("it is connected already")
            } else if sources[from].is_some() || read[to] {
                Some("an input cannot be read in turn: connect both to the coordinate itself")
            } else {
                None
            };
            if let Some(reason) = reason {
                let (output, input) = (output.clone(), input.clone());
                return Err(CompositionError::Connection { output, input, reason });
            }
            sources[to] = Some(from);
            read[from] = true;
        }
        Ok(sources)
    }

    fn full_names(&self) -> Vec<String> {
        let of_part = |part: &Part| {
            let named = |coordinate: &&'static str| format!("{}.{coordinate}", part.name);
            part.blueprint.coordinates.iter().map(named).collect::<Vec<_>>()
        };
        self.parts.iter().flat_map(of_part).collect()
    }

    /// Gives every coordinate that is no input a slot, and every input the slot of what it reads.
    fn lay_out(&self, sources: &[Option<usize>], composition: &mut Composition) -> Layout {
        let alone = self.parts.len() == 1;
        let mut layout = Layout { offsets: Vec::new(), slots: vec![0; sources.len()] };
        let mut number = 0;
        for part in &self.parts {
            layout.offsets.push(number);
            for (coordinate, value) in part.blueprint.coordinates.iter().zip(&part.initial) {
                if sources[number].is_none() {
                    layout.slots[number] = composition.variables.len();
                    let name = if alone {
                        (*coordinate).to_owned()
                    } else {
                        format!("{}.{coordinate}", part.name)
                    };
                    composition.variables.push(name);
                    composition.initial.push(*value);
                }
                number += 1;
            }
        }
        for (number, source) in sources.iter().enumerate() {
            if let Some(source) = source {
                layout.slots[number] = layout.slots[*source];
            }
        }
        layout
    }

    fn labels(&self) -> Result<Vec<Label>, CompositionError> {
        let mut labels: Vec<Label> = Vec::new();
        for name in &self.labels {
            if labels.iter().any(|label| label.name == *name) {
                continue;
            }
            let participants: Vec<_> = self
                .parts
                .iter()
                .enumerate()
                .filter_map(|(index, part)| Some((index, part.event(name)?)))
                .collect();
            if participants.is_empty() {
                return Err(CompositionError::UnknownLabel { label: name.clone() });
            }
            labels.push(Label { name: name.clone(), participants });
        }
        Ok(labels)
    }
}

struct Layout {
    /// By component: the number of its first coordinate.
    offsets: Vec<usize>,
    /// By the number of a coordinate.
    slots: Vec<usize>,
}

impl Part {
    /// The number of the event that goes by `name` in this component.
    fn event(&self, name: &str) -> Option<usize> {
        self.event_names().position(|event| event == name)
    }

    /// In every location that is ever entered there is a transition with this event.
    fn check_receptive(&self, event: &str) -> Result<(), CompositionError> {
        let (number, places) = (self.event(event), &self.blueprint.places);
        let is_entered = |place: usize| {
            let mut leaving = places.iter().flat_map(|place| &place.leaving);
            place == self.blueprint.initial || leaving.any(|leaving| leaving.target == place)
        };
        let is_deaf = |place: &Place| !place.leaving.iter().any(|it| Some(it.event) == number);
        let mut numbered = places.iter().enumerate();
        match numbered.find(|(number, place)| is_deaf(place) && is_entered(*number)) {
            Some((_, place)) => Err(CompositionError::NotReceptive {
                component: self.name.clone(),
                event: event.to_owned(),
                location: place.name,
            }),
            None => Ok(()),
        }
    }

    /// What the events are called in this component.
    fn event_names(&self) -> impl Iterator<Item = &str> {
        self.blueprint.events.iter().map(|event| {
            let renamed = self.renamed.iter().find(|(before, _)| before == event);
            renamed.map_or(*event, |(_, after)| after)
        })
    }
}

impl Component {
    /// Nothing that is given as data changes an input. What functions write to inputs is dropped.
    fn check_inputs(&self) -> Result<(), CompositionError> {
        let names = self.blueprint.coordinates.iter().zip(&self.owned);
        let mut inputs = names.filter(|(_, owned)| !**owned).map(|(name, _)| *name);
        if let Some(coordinate) = inputs.find(|name| self.blueprint.own.contains(name)) {
            let component = self.name.clone();
            return Err(CompositionError::SurfaceReads { component, coordinate });
        }
        for place in &self.blueprint.places {
            let moved: Vec<usize> = match &place.motion {
                PlaceMotion::Rates(rates) => rates.iter().map(|rate| rate.coordinate).collect(),
                PlaceMotion::Field(_) | PlaceMotion::Exact(_) => Vec::new(),
            };
            let set = place.leaving.iter().flat_map(|leaving| match &leaving.change {
                Change::Assignments(assignments) => {
                    assignments.iter().map(|(coordinate, _)| *coordinate).collect()
                }
                Change::Function(_) => Vec::new(),
            });
            if let Some(input) = moved.into_iter().chain(set).find(|&one| !self.owned[one]) {
                return Err(CompositionError::InputChanged {
                    component: self.name.clone(),
                    coordinate: self.blueprint.coordinates[input],
                    location: place.name,
                });
            }
        }
        Ok(())
    }
}
