//! How components are put side by side.

mod assembly;
mod error;

use std::sync::Arc;

use pleach_discrete::{Event, Location};
use pleach_guards::{EvaluationError, Valuation};

pub use error::CompositionError;

use super::blueprint::{Blueprint, Wiring};
use super::channel::Weakness;
use super::sampler::{Clock, Sample, Sampler, Sampling};
use super::{Accumulation, Channel, Component, Composition};
use crate::automaton::Automaton;
use crate::check::model::Model;
use crate::coordinates::Coordinates;
use crate::named::{Name, Record};
use crate::signals::Signal;

/// A [`Composition`] under construction.
#[derive(Default)]
#[must_use = "a composition is complete after `build`"]
pub struct CompositionBuilder {
    parts: Vec<Part>,
    labels: Vec<String>,
    /// From an output to an input.
    connections: Vec<(String, String)>,
    /// Components that sample others; they come after these.
    samplers: Vec<Sampler>,
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
    /// Names of formulas of the coordinates, with these.
    signals: Vec<Signal>,
    /// The events that are taken at samples.
    samplings: Vec<(&'static str, Sampling)>,
    /// What it samples, if it is a clock.
    clock: Option<Clock>,
    /// Why it does not carry all messages, if it is a channel that does not.
    weakness: Option<Weakness>,
    /// Compiles it anew, with formulas in the place of coordinates.
    compile: Arc<Compile>,
    renamed: Vec<(String, String)>,
    accumulation: Option<Accumulation>,
    continuation: Option<usize>,
}

/// An automaton as runs and as checks read it.
type Compiled = (Arc<Blueprint>, Arc<Model>);
type Compile = dyn Fn(&Wiring) -> Result<Compiled, EvaluationError>;

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
                self.claim(name);
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
        self.claim(name);
        self.add_named(name, automaton, state)
    }

    /// Adds a component that joins others, such as a channel, whose name has those of events.
    pub(super) fn add_joint(mut self, name: &str, joint: &Automaton<Name, Name, Record>) -> Self {
        match joint.initial_state() {
            Some(state) => self.add_named(name, joint, state.clone()),
            None => {
                self.fault(CompositionError::NoInitialState { component: name.to_owned() });
                self
            }
        }
    }

    fn add_named<L: Location, E: Event, S: Coordinates>(
        self,
        name: &str,
        automaton: &Automaton<L, E, S>,
        state: S,
    ) -> Self {
        let numbers = automaton.numbers();
        let signals = automaton.signals();
        let signals = signals.map(|(name, it)| (name.to_owned(), it.substitute(&numbers)));
        let signals = signals.collect();
        let samplings = automaton.samplings().collect();
        let automaton = automaton.clone();
        let compile = Arc::new(move |wiring: &Wiring| {
            let blueprint = automaton.blueprint(wiring)?;
            let model = Model::of(&automaton.outline(), wiring);
            Ok((Arc::new(blueprint), Arc::new(model)))
        });
        self.add_part(name, compile, signals, samplings, &state)
    }

    fn add_part(
        mut self,
        name: &str,
        compile: Arc<Compile>,
        signals: Vec<Signal>,
        samplings: Vec<(&'static str, Sampling)>,
        state: &dyn Valuation,
    ) -> Self {
        let initial = |compiled: Compiled| -> Result<(Compiled, Vec<f64>), EvaluationError> {
            let value = |name: &&'static str| {
                let unknown = || EvaluationError::UnknownVariable { variable: (*name).to_owned() };
                state.value(name).ok_or_else(unknown)
            };
            let values = compiled.0.coordinates.iter().map(value).collect::<Result<_, _>>()?;
            Ok((compiled, values))
        };
        match compile(&[]).and_then(initial) {
            Ok(((blueprint, _), initial)) if initial.iter().any(|value| value.is_nan()) => {
                let named = blueprint.coordinates.iter().zip(&initial);
                for (variable, _) in named.filter(|(_, value)| value.is_nan()) {
                    let component = name.to_owned();
                    self.fault(CompositionError::InitialNotANumber { component, variable });
                }
            }
            Ok(((blueprint, model), initial)) => self.parts.push(Part {
                name: name.to_owned(),
                blueprint,
                model,
                initial,
                signals,
                samplings,
                clock: None,
                weakness: None,
                compile,
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
            self.check_name(&name);
            self.parts.push(Part { name, ..like });
        }
        self.is_each = false;
        self
    }

    /// What happens where jumps of the component added last accumulate.
    pub fn at_accumulation(mut self, accumulation: Accumulation) -> Self {
        match self.parts.last_mut() {
            Some(part) => part.accumulation = Some(accumulation),
            None => self.fault(CompositionError::NoComponent),
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

    /// The coordinate `input` of a component is the coordinate or the
    /// [signal](crate::Builder::signal) `output` of another; both are written `component.coordinate`.
    pub fn connect(mut self, output: &str, input: &str) -> Self {
        self.connections.push((output.to_owned(), input.to_owned()));
        self
    }

    /// The event of a component, written `component.event`, is taken at 0, `period`, 2 `period`, …: a
    /// sampled controller needs no clock of its own. Its transitions with the event say what is done
    /// then and not when, as `may(always())`. Where none of them can be taken, the sample passes. The
    /// clock becomes a component after all others. An automaton can say the same of
    /// [its events](crate::Builder::every).
    pub fn every(self, event: &str, period: f64) -> Self {
        self.every_from(event, period, 0.0)
    }

    /// As [`every`](Self::every), at `phase` ≥ 0, `phase` + `period`, … seconds.
    pub fn every_from(mut self, event: &str, period: f64, phase: f64) -> Self {
        let sampling = Sampling { period, phase };
        self.samplers.push(Sampler { event: event.to_owned(), sampling });
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
        self.check_names()?;
        self = self.join_samplers()?.join_channels()?;
        self.check_names()?;
        let inputs = self.connections.clone();
        self.wire_signals()?;
        let sources = self.sources()?;
        let mut composition = Composition {
            components: Vec::with_capacity(self.parts.len()),
            labels: Vec::new(),
            variables: Vec::new(),
            initial: Vec::new(),
            signals: Vec::new(),
            inputs,
            groups: Vec::new(),
        };
        let slots = self.lay_out(&sources, &mut composition);
        composition.signals = self.signals(&composition.variables, &slots);
        let labels = self.labels()?;
        for (index, part) in self.parts.into_iter().enumerate() {
            let first = slots.offsets[index];
            let places = first..first + part.blueprint.coordinates.len();
            let own_label = |event| {
                labels.iter().position(|label| label.participants.contains(&(index, event)))
            };
            let place_of = |name: &str| labels.iter().position(|label| label.name == name);
            let sampling = part.clock.as_ref().map(|clock| {
                let samples = clock.samples.iter();
                let place = |sample: &Sample| {
                    let label = sample.label.clone();
                    place_of(&label).ok_or(CompositionError::UnknownLabel { label })
                };
                let samples = samples.map(place).collect::<Result<_, _>>();
                samples.map(|samples| (clock.sampling, samples))
            });
            let component = Component {
                events: part.event_names().map(str::to_owned).collect(),
                name: part.name,
                slots: slots.slots[places.clone()].to_vec(),
                owned: sources[places].iter().map(Option::is_none).collect(),
                labels: (0..part.blueprint.events.len()).map(own_label).collect(),
                sampling: sampling.transpose()?,
                weakness: part.weakness,
                blueprint: part.blueprint,
                model: part.model,
                group: 0,
                places: Vec::new(),
                window: None,
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

    /// What is wrong with a name counts before what is wrong with the component.
    fn claim(&mut self, name: &str) {
        self.check_name(name);
        if self.parts.iter().any(|part| part.name == name) {
            self.fault(CompositionError::NameTwice { name: name.to_owned() });
        }
    }

    fn check_name(&mut self, name: &str) {
        if name.is_empty() || name.contains(['.', ',', '"', '\n', '\r']) {
            self.fault(CompositionError::Name { name: name.to_owned() });
        }
    }

    fn fault(&mut self, fault: CompositionError) {
        self.fault.get_or_insert(fault);
    }
}
