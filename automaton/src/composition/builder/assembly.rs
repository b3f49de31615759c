//! How parts are joined: channels, connections, slots and labels.

use super::{CompositionBuilder, CompositionError, Part};
use crate::composition::blueprint::{Change, Mode, ModeMotion};
use crate::composition::{Component, Composition, Label};

impl CompositionBuilder {
    /// Turns clocks that sample into components.
    pub(super) fn join_samplers(mut self) -> Result<Self, CompositionError> {
        for sampler in std::mem::take(&mut self.samplers) {
            let (label, sampled) = self.end_of_channel(&sampler.event, None)?;
            self.parts[sampled].check_receptive(&label)?;
            self = sampler.join(self, &label)?;
        }
        Ok(self)
    }

    /// Turns channels into components.
    pub(super) fn join_channels(mut self) -> Result<Self, CompositionError> {
        let mut heard: Vec<String> = Vec::new();
        for channel in std::mem::take(&mut self.channels) {
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

    /// A coordinate that a channel carries is read in the jump of an arrival alone.
    fn check_arrivals(&self, input: &str, arrive: &str) -> Result<(), CompositionError> {
        for part in &self.parts {
            let own = input.strip_prefix(&*part.name).and_then(|it| it.strip_prefix('.'));
            let Some(coordinate) = own else { continue };
            if let Some(reader) = part.model.reader_of(coordinate, part.event(arrive)) {
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
        match repeated(self.full_names()) {
            Some(variable) => Err(CompositionError::VariableTwice { variable }),
            None => Ok(()),
        }
    }

    /// For every coordinate of every component in turn: the coordinate that it reads, if it is an
    /// input.
    pub(super) fn sources(&self) -> Result<Vec<Option<usize>>, CompositionError> {
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
    pub(super) fn lay_out(
        &self,
        sources: &[Option<usize>],
        composition: &mut Composition,
    ) -> Layout {
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
    /// The number of the event that goes by `name` in this component.
    pub(super) fn event(&self, name: &str) -> Option<usize> {
        self.event_names().position(|event| event == name)
    }

    /// In every location that is ever entered there is a transition with this event.
    fn check_receptive(&self, event: &str) -> Result<(), CompositionError> {
        let (number, modes) = (self.event(event), &self.blueprint.modes);
        let is_entered = |location: usize| {
            let mut leaving = modes.iter().flat_map(|mode| &mode.leaving);
            location == self.blueprint.initial || leaving.any(|leaving| leaving.target == location)
        };
        let is_deaf = |mode: &Mode| !mode.leaving.iter().any(|it| Some(it.event) == number);
        let mut numbered = modes.iter().enumerate();
        match numbered.find(|(number, mode)| is_deaf(mode) && is_entered(*number)) {
            Some((_, mode)) => Err(CompositionError::NotReceptive {
                component: self.name.clone(),
                event: event.to_owned(),
                location: mode.name,
            }),
            None => Ok(()),
        }
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
