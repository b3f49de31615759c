//! How parts are joined: channels, connections, slots and labels.

use pleach_guards::{Expression, Substitution, always, variable};

use super::{CompositionBuilder, CompositionError, Part};
use crate::composition::blueprint::{Change, Leaving, Mode, ModeMotion};
use crate::composition::channel::Weakness;
use crate::composition::sampler::{Clock, Sample, Sampler};
use crate::composition::{Component, Composition, Label};
use crate::signals::{Signal, resolved};

impl CompositionBuilder {
    /// Turns clocks that sample into components: one for all events of a component at the same instants.
    pub(super) fn join_samplers(mut self) -> Result<Self, CompositionError> {
        let mut clocks: Vec<Clock> = Vec::new();
        let own: Vec<Sampler> = self.parts.iter().flat_map(Part::samplers).collect();
        let (alone, count) = (self.parts.len() == 1, own.len());
        let others = std::mem::take(&mut self.samplers);
        for (number, Sampler { event, sampling }) in own.into_iter().chain(others).enumerate() {
            let is_own = number < count;
            // Where there is one automaton, its clocks use its own names.
            let brief = event.strip_prefix(&*self.parts[0].name);
            let brief = brief.and_then(|it| it.strip_prefix('.')).filter(|_| alone && is_own);
            let (label, sampled) = self.end_of_channel(&event, brief)?;
            let mut samples = clocks.iter().flat_map(|clock| &clock.samples);
            let is_sampled = samples.any(|sample| sample.label == label);
            let twice = || is_sampled.then(|| "it is sampled twice: keep one".to_owned());
            if let Some(reason) = sampling.fault().or_else(twice) {
                return Err(CompositionError::Sampler { event, reason });
            }
            let may_pass = !self.parts.iter().all(|part| part.always_takes(&label));
            let sample = Sample { label, may_pass };
            let is_due = |clock: &&mut Clock| {
                (clock.sampling, clock.sampled, clock.is_own) == (sampling, sampled, is_own)
            };
            match clocks.iter_mut().find(is_due) {
                Some(clock) => clock.samples.push(sample),
                None => clocks.push(Clock { sampling, samples: vec![sample], is_own, sampled }),
            }
        }
        for clock in clocks {
            self = clock.join(self)?;
            if let Some(part) = self.parts.last_mut() {
                part.clock = Some(clock);
            }
        }
        Ok(self)
    }

    /// Turns channels into components.
    pub(super) fn join_channels(mut self) -> Result<Self, CompositionError> {
        let mut heard: Vec<String> = Vec::new();
        for channel in std::mem::take(&mut self.channels) {
            if self.parts.iter().any(|part| part.name == channel.name) {
                let reason =
                    "another component has its name: give one of them its own, with `called`";
                let (channel, reason) = (channel.name, reason.to_owned());
                return Err(CompositionError::Channel { channel, reason });
            }
            let (send, _) = self.end_of_channel(&channel.output, None)?;
            let shared = (channel.inputs.len() > 1).then(|| channel.name.clone());
            let mut arrive = format!("{} arrival", channel.name);
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
            for input in channel.carried() {
                self.check_arrivals(input, &arrive)?;
            }
            let is_forced = self.parts.iter().any(|part| part.forces(&arrive));
            let weakness = channel.weakness(self.period_of(&send));
            self = channel.join(self, &send, &arrive)?;
            if let Some(part) = self.parts.last_mut() {
                part.weakness = weakness.filter(|it| *it != Weakness::Untimed || !is_forced);
            }
        }
        match self.fault.take() {
            Some(fault) => Err(fault),
            None => Ok(self),
        }
    }

    /// The period in seconds at which a label is sampled.
    fn period_of(&self, label: &str) -> Option<f64> {
        let mut clocks = self.parts.iter().filter_map(|part| part.clock.as_ref());
        let clock = clocks.find(|clock| clock.samples.iter().any(|one| one.label == label))?;
        Some(clock.sampling.period)
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
        let events = |part: &Part| {
            let own = |event: &str| {
                let own = event.strip_prefix(&*part.name).and_then(|it| it.strip_prefix('.'));
                own.unwrap_or(event).to_owned()
            };
            part.event_names().map(own).collect()
        };
        let known = self.known(event, "event", events);
        Err(CompositionError::UnknownMessage { event: event.to_owned(), known })
    }

    /// What there is in place of a name `component.own` that there is not: names of the component, or the components.
    fn known(&self, name: &str, what: &str, own: impl Fn(&Part) -> Vec<String>) -> String {
        let quoted = |names: Vec<String>| {
            let names = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>();
            if names.is_empty() { format!("no {what}s") } else { names.join(", ") }
        };
        let is_of =
            |part: &&Part| name.strip_prefix(&*part.name).is_some_and(|own| own.starts_with('.'));
        match self.parts.iter().find(is_of) {
            Some(part) => format!("`{}` has {}", part.name, quoted(own(part))),
            None => {
                let parts = self.parts.iter().map(|part| part.name.clone()).collect();
                format!("write `component.{what}`, of a component among {}", quoted(parts))
            }
        }
    }

    fn unknown_variable(&self, variable: &str) -> CompositionError {
        let known = self.known(variable, "coordinate", |part| {
            let coordinates = part.blueprint.coordinates.iter().map(|own| (*own).to_owned());
            coordinates.chain(part.signals.iter().map(|(own, _)| own.clone())).collect()
        });
        CompositionError::UnknownVariable { variable: variable.to_owned(), known }
    }

    /// Why nothing is connected to an input that is no coordinate.
    fn no_input(&self, output: &str, input: &str) -> CompositionError {
        if self.full_signals().iter().any(|(signal, _)| signal == input) {
            let (output, input) = (output.to_owned(), input.to_owned());
            let reason = "it is a signal, and only coordinates can be inputs";
            return CompositionError::Connection { output, input, reason };
        }
        self.unknown_variable(input)
    }

    /// A coordinate that a channel carries is read in the jump of an arrival alone.
    fn check_arrivals(&self, input: &str, arrive: &str) -> Result<(), CompositionError> {
        for part in &self.parts {
            let own = input.strip_prefix(&*part.name).and_then(|it| it.strip_prefix('.'));
            let Some(coordinate) = own else { continue };
            let reads = |formula: &Expression| formula.variables().contains(coordinate);
            let signal = || part.signals.iter().find(|(_, formula)| reads(formula));
            let reader = part.model.reader_of(coordinate, part.event(arrive));
            let reader = reader.or_else(|| Some(format!("the signal `{}`", signal()?.0)));
            if let Some(reader) = reader {
                let (component, coordinate) = (part.name.clone(), coordinate.to_owned());
                return Err(CompositionError::InTransit { component, coordinate, reader });
            }
        }
        Ok(())
    }

    pub(super) fn check_names(&self) -> Result<(), CompositionError> {
        if self.parts.is_empty() {
            return Err(CompositionError::Empty);
        }
        if let Some(name) = repeated(self.parts.iter().map(|part| part.name.clone()).collect()) {
            return Err(CompositionError::NameTwice { name });
        }
        // `q.x` of a component `p` is called like `x` of a component `p.q`.
        let signals = self.full_signals().into_iter().map(|(name, _)| name);
        match repeated(self.full_names().into_iter().chain(signals).collect()) {
            Some(variable) => Err(CompositionError::VariableTwice { variable }),
            None => Ok(()),
        }
    }

    /// For every coordinate of every component in turn: the coordinate that it reads, if it is an
    /// input.
    pub(super) fn sources(&self) -> Result<Vec<Option<usize>>, CompositionError> {
        let names = self.full_names();
        let find = |variable: &String| names.iter().position(|name| name == variable);
        let mut sources = vec![None; names.len()];
        let mut read = vec![false; names.len()];
        for (output, input) in &self.connections {
            let from = find(output).ok_or_else(|| self.unknown_variable(output))?;
            let to = find(input).ok_or_else(|| self.no_input(output, input))?;
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
        self.parts.iter().flat_map(Part::full_names).collect()
    }

    /// The signals of all components, as formulas of coordinates of the whole.
    fn full_signals(&self) -> Vec<Signal> {
        let of_part = |part: &Part| {
            let full_names: Vec<String> = part.full_names().collect();
            let own = part.blueprint.coordinates.iter().copied();
            part.signals_in(own.zip(full_names.iter().map(String::as_str)))
        };
        self.parts.iter().filter(|part| !part.signals.is_empty()).flat_map(of_part).collect()
    }

    /// Gives components the formulas of the signals to which their inputs are connected, and connects
    /// what these read.
    pub(super) fn wire_signals(&mut self) -> Result<(), CompositionError> {
        let signals = self.full_signals();
        let is_signal = |name: &str| signals.iter().any(|(signal, _)| signal == name);
        let connections = std::mem::take(&mut self.connections);
        let (wires, plain): (Vec<_>, Vec<_>) =
            connections.into_iter().partition(|(output, _)| is_signal(output));
        self.connections = plain;
        if wires.is_empty() {
            return Ok(());
        }
        self.sources()?;
        self.check_wires(&wires)?;
        let inputs = wires.iter().chain(&self.connections);
        let inputs = inputs.map(|(output, input)| (input.clone(), variable(output)));
        let formulas = resolved(&signals.into_iter().chain(inputs).collect::<Vec<_>>())
            .map_err(|signals| CompositionError::SignalCycle { signals })?;
        let is_wired = |name: &str| wires.iter().any(|(_, input)| input == name);
        let formulas: Vec<Signal> =
            formulas.into_iter().filter(|(name, _)| is_wired(name)).collect();
        for part in &mut self.parts {
            self.connections.extend(part.wire(&formulas)?);
        }
        self.check_names()
    }

    /// An input of formulas has one source, is not read by another input and not changed.
    fn check_wires(&self, wires: &[(String, String)]) -> Result<(), CompositionError> {
        for (output, input) in wires {
            let owner = self.parts.iter().find_map(|part| Some((part, part.own_name(input)?)));
            let Some((part, own)) = owner else {
                return Err(self.no_input(output, input));
            };
            let ends = || wires.iter().chain(&self.connections);
            let reason = if ends().filter(|(_, other)| other == input).count() > 1 {
                "it is connected already"
            } else if ends().any(|(other, _)| other == input) {
                "an input cannot be read in turn: connect both to the signal itself"
            } else if !part.model.is_data() {
                "formulas can read a signal, and its component has a flow or a reset that is a function"
            } else if let Some(location) = part.model.changes(own) {
                let component = part.name.clone();
                return Err(CompositionError::InputChanged {
                    component,
                    coordinate: own,
                    location,
                });
            } else {
                continue;
            };
            let (output, input) = (output.clone(), input.clone());
            return Err(CompositionError::Connection { output, input, reason });
        }
        Ok(())
    }

    /// The signals as formulas of variables of the composition.
    pub(super) fn signals(&self, variables: &[String], layout: &Layout) -> Vec<Signal> {
        let of_part = |(part, first): (&Part, &usize)| {
            let slots = &layout.slots[*first..];
            let own = part.blueprint.coordinates.iter().zip(slots);
            let named = part.signals_in(own.map(|(own, slot)| (*own, &*variables[*slot])));
            let is_alone = self.is_alone();
            let brief = part.signals.iter().zip(named).map(move |((own, _), (name, formula))| {
                (if is_alone { own.clone() } else { name }, formula)
            });
            brief.collect::<Vec<_>>()
        };
        self.parts.iter().zip(&layout.offsets).flat_map(of_part).collect()
    }

    /// Whether there is one automaton, perhaps with clocks of its events.
    fn is_alone(&self) -> bool {
        self.parts.iter().filter(|part| !part.is_own_clock()).count() == 1
    }

    /// Gives every coordinate that is no input a slot, and every input the slot of what it reads.
    pub(super) fn lay_out(
        &self,
        sources: &[Option<usize>],
        composition: &mut Composition,
    ) -> Layout {
        let alone = self.is_alone();
        let mut layout = Layout { offsets: Vec::new(), slots: vec![0; sources.len()] };
        let mut number = 0;
        for part in &self.parts {
            layout.offsets.push(number);
            for (coordinate, value) in part.blueprint.coordinates.iter().zip(&part.initial) {
                if sources[number].is_none() {
                    layout.slots[number] = composition.variables.len();
                    let name = if alone && !part.is_own_clock() {
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

    pub(super) fn labels(&self) -> Result<Vec<Label>, CompositionError> {
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

/// Where coordinates have their place.
pub(super) struct Layout {
    /// By component: the number of its first coordinate.
    pub(super) offsets: Vec<usize>,
    /// By the number of a coordinate.
    pub(super) slots: Vec<usize>,
}

impl Part {
    /// The coordinates as `component.coordinate`.
    fn full_names(&self) -> impl Iterator<Item = String> {
        self.blueprint.coordinates.iter().map(|own| format!("{}.{own}", self.name))
    }

    /// What a coordinate of the whole is called here, if it is one of this component.
    fn own_name(&self, name: &str) -> Option<&'static str> {
        let place = self.full_names().position(|full| full == name)?;
        Some(self.blueprint.coordinates[place])
    }

    /// The signals as `component.signal`, with other names for the coordinates in their formulas.
    fn signals_in<'a>(&self, names: impl Iterator<Item = (&'a str, &'a str)>) -> Vec<Signal> {
        let renaming = Substitution::renaming(names);
        let signals = self.signals.iter();
        let named = signals
            .map(|(own, formula)| (format!("{}.{own}", self.name), formula.substitute(&renaming)));
        named.collect()
    }

    /// Reads formulas, of coordinates of the whole, in the place of those inputs that are among them; and
    /// says what is to be connected for that.
    fn wire(&mut self, formulas: &[Signal]) -> Result<Vec<(String, String)>, CompositionError> {
        let full_names: Vec<String> = self.full_names().collect();
        let own_names =
            full_names.iter().map(String::as_str).zip(self.blueprint.coordinates.iter().copied());
        let renaming = Substitution::renaming(own_names);
        let wiring = formulas.iter().filter_map(|(input, formula)| {
            Some((self.own_name(input)?.to_owned(), formula.substitute(&renaming)))
        });
        let wiring: Vec<Signal> = wiring.collect();
        if wiring.is_empty() {
            return Ok(Vec::new());
        }
        let fault = |source| CompositionError::Formula { component: self.name.clone(), source };
        let (blueprint, model) = (self.compile)(&wiring).map_err(fault)?;
        let before = self.blueprint.coordinates.iter().zip(&self.initial);
        let value =
            |name: &&str| before.clone().find(|(known, _)| *known == name).map(|(_, value)| *value);
        let values: Vec<Option<f64>> = blueprint.coordinates.iter().map(value).collect();
        let named = blueprint.coordinates.iter().zip(&values);
        let read = named
            .filter(|(_, value)| value.is_none())
            .map(|(name, _)| ((*name).to_owned(), format!("{}.{name}", self.name)));
        let read = read.collect();
        self.initial = values.into_iter().map(Option::unwrap_or_default).collect();
        let formulas = Substitution::new(wiring);
        for (_, formula) in &mut self.signals {
            *formula = formula.substitute(&formulas);
        }
        (self.blueprint, self.model) = (blueprint, model);
        Ok(read)
    }

    /// The number of the event that goes by `name` in this component.
    pub(super) fn event(&self, name: &str) -> Option<usize> {
        self.event_names().position(|event| event == name)
    }

    /// The clocks of its events.
    fn samplers(&self) -> impl Iterator<Item = Sampler> {
        self.samplings.iter().filter_map(|(event, sampling)| {
            let place = self.blueprint.events.iter().position(|known| known == event)?;
            let event = format!("{}.{}", self.name, self.event_names().nth(place)?);
            Some(Sampler { event, sampling: *sampling })
        })
    }

    /// Whether it is a clock of events of one automaton.
    fn is_own_clock(&self) -> bool {
        self.clock.as_ref().is_some_and(|clock| clock.is_own)
    }

    /// In every location that is ever entered there is a transition with this event.
    fn check_receptive(&self, event: &str) -> Result<(), CompositionError> {
        match self.location_without(event, |_| true) {
            Some(location) => Err(CompositionError::NotReceptive {
                component: self.name.clone(),
                event: event.to_owned(),
                location,
            }),
            None => Ok(()),
        }
    }

    /// Whether an event of this name, if it has one, can be taken at any time.
    fn always_takes(&self, event: &str) -> bool {
        let is_free = |leaving: &Leaving| *leaving.guard.predicate() == always();
        self.event(event).is_none() || self.location_without(event, is_free).is_none()
    }

    /// Whether a transition with an event of this name can be due.
    fn forces(&self, event: &str) -> bool {
        let number = self.event(event);
        let mut leaving = self.blueprint.modes.iter().flat_map(|mode| &mode.leaving);
        leaving.any(|leaving| Some(leaving.event) == number && leaving.urgency.is_forced())
    }

    /// A location that is ever entered and has no such transition with an event.
    fn location_without(
        &self,
        event: &str,
        is_such: impl Fn(&Leaving) -> bool,
    ) -> Option<&'static str> {
        let (number, modes) = (self.event(event), &self.blueprint.modes);
        let is_entered = |location: usize| {
            let mut leaving = modes.iter().flat_map(|mode| &mode.leaving);
            location == self.blueprint.initial || leaving.any(|leaving| leaving.target == location)
        };
        let has_none =
            |mode: &Mode| !mode.leaving.iter().any(|it| Some(it.event) == number && is_such(it));
        let mut numbered = modes.iter().enumerate();
        let found = numbered.find(|(number, mode)| has_none(mode) && is_entered(*number));
        found.map(|(_, mode)| mode.name)
    }

    /// What the events are called in this component.
    pub(super) fn event_names(&self) -> impl Iterator<Item = &str> {
        self.blueprint.events.iter().map(|event| {
            let renamed = self.renamed.iter().find(|(before, _)| before == event);
            renamed.map_or(*event, |(_, after)| after)
        })
    }
}

impl Component {
    /// Nothing that is given as data changes an input. What functions write to inputs is dropped.
    pub(super) fn check_inputs(&self) -> Result<(), CompositionError> {
        let names = self.blueprint.coordinates.iter().zip(&self.owned);
        let mut inputs = names.filter(|(_, owned)| !**owned).map(|(name, _)| *name);
        if let Some(coordinate) = inputs.find(|name| self.blueprint.own.contains(name)) {
            let component = self.name.clone();
            return Err(CompositionError::SurfaceReads { component, coordinate });
        }
        for mode in &self.blueprint.modes {
            let moved: Vec<usize> = match &mode.motion {
                ModeMotion::Rates(rates) => rates.iter().map(|rate| rate.coordinate).collect(),
                ModeMotion::Field(_) | ModeMotion::Exact(_) => Vec::new(),
            };
            let set = mode.leaving.iter().flat_map(|leaving| match &leaving.change {
                Change::Assignments(assignments) => {
                    assignments.iter().map(|(coordinate, _)| *coordinate).collect()
                }
                Change::Function(_) => Vec::new(),
            });
            if let Some(input) = moved.into_iter().chain(set).find(|&one| !self.owned[one]) {
                return Err(CompositionError::InputChanged {
                    component: self.name.clone(),
                    coordinate: self.blueprint.coordinates[input],
                    location: mode.name,
                });
            }
        }
        Ok(())
    }
}

/// A name that occurs twice, the first in their order.
fn repeated(mut names: Vec<String>) -> Option<String> {
    names.sort_unstable();
    names.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0].clone())
}
