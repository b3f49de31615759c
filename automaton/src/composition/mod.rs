//! Parallel composition: automata side by side, joined by labels and connections.
//!
//! Each component keeps its location and its coordinates. Two things join components:
//!
//! * a **label** is an event that every component which knows an event of that name takes
//!   together with the others: one jump, and only where all their guards hold. It is forced as soon
//!   as it is for one of them. Events of other names are each component's own;
//! * a **connection** lets a component read a coordinate or a [signal](crate::Builder::signal) of
//!   another under a name of its own. What is read belongs to the other component; a flow or a reset
//!   cannot change it.
//!
//! A [`Channel`] between two components carries messages from the one to the other: a component by
//! itself, joined by labels to the sender and to the receiver.
//!
//! Coordinates of a composition are called `component.coordinate`; in a composition of a single
//! component they keep their names.
//!
//! A heater and its controller, which sees the temperature and switches the heater:
//!
//! ```
//! use pleach_automaton::{coordinates, from, Automaton, Composition};
//! use pleach_discrete::vocabulary;
//! use pleach_guards::always;
//!
//! vocabulary! {
//!     enum Heater: Location { Off = "off", On = "on" }
//!     enum Controller: Location { Watching = "watching" }
//!     enum Switch: Event { TurnOn = "turn on", TurnOff = "turn off" }
//! }
//! coordinates! {
//!     struct Room { temperature = "T" }
//!     struct Reading { seen = "T" }
//! }
//! use Heater::{Off, On};
//! use Switch::{TurnOff, TurnOn};
//!
//! let Room { temperature } = Room::coordinates();
//! let heater = Automaton::starting_in(Off)
//!     .initially(Room { temperature: 20.0 })
//!     .flow(Off, temperature.rate(-0.1 * &temperature))
//!     .flow(On, temperature.rate(5.0 - 0.1 * &temperature))
//!     .transition(from(Off).on(TurnOn).to(On).may(always()))
//!     .transition(from(On).on(TurnOff).to(Off).may(always()))
//!     .build()?;
//!
//! let Reading { seen } = Reading::coordinates();
//! let watching = Controller::Watching;
//! let controller = Automaton::starting_in(watching)
//!     .initially(Reading { seen: 20.0 })
//!     .transition(from(watching).on(TurnOn).to(watching).must(seen.at_most(18.0)))
//!     .transition(from(watching).on(TurnOff).to(watching).must(seen.at_least(22.0)))
//!     .build()?;
//!
//! let house = Composition::builder()
//!     .add("heater", &heater)
//!     .add("controller", &controller)
//!     .connect("heater.T", "controller.T")
//!     .label("turn on")
//!     .label("turn off")
//!     .build()?;
//!
//! let trajectory = house.run(10.0)?;
//! let first = &trajectory.jumps()[0];
//! assert_eq!(first.label, "turn on");
//! assert!((first.at.t - 10.0 * (20f64 / 18.0).ln()).abs() < 1e-9); // T = 20 e^(−t/10)
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod blueprint;
mod builder;
pub mod channel;
mod exploration;
mod field;
mod flight;
mod group;
mod halving;
mod hold;
mod jumps;
mod kinks;
mod linear;
mod models;
mod picture;
mod product;
mod record;
mod replay;
mod sampler;
mod settings;
mod simulation;
mod solver;
pub mod stream;
mod tension;

use std::sync::Arc;

use pleach_guards::Expression;

/// How flows are integrated; a part of the [`Settings`].
pub use pleach_continuous::flow::Method;

pub use builder::{CompositionBuilder, CompositionError};
pub use channel::Channel;
pub use exploration::{Exploration, ExplorationError, Reached};
pub use product::{ProductError, without_clocks};
pub use replay::ReplayError;
pub use settings::{Accumulation, Policy, Settings};
pub use simulation::{Failure, Halt, Move, Simulation, SimulationError, Taken};

use blueprint::Blueprint;
use group::Group;
pub(crate) use sampler::Sampling;

use crate::check::model::Model;
use crate::signals::Signal;

/// Automata side by side; see the [module](self).
#[derive(Clone)]
pub struct Composition {
    pub(crate) components: Vec<Component>,
    labels: Vec<Label>,
    /// By slot.
    variables: Vec<String>,
    /// By slot: the values at the start.
    initial: Vec<f64>,
    /// Names of formulas of the variables, with these.
    signals: Vec<Signal>,
    /// Inputs, each after the variable or signal that it reads.
    inputs: Vec<(String, String)>,
    /// What moves and jumps by itself.
    groups: Vec<Group>,
}

#[derive(Clone)]
pub(crate) struct Component {
    pub(crate) name: String,
    pub(crate) blueprint: Arc<Blueprint>,
    /// What checks read.
    model: Arc<Model>,
    /// By event: what it is called here.
    pub(crate) events: Vec<String>,
    /// By coordinate: where its value is.
    pub(crate) slots: Vec<usize>,
    /// By coordinate: whether it belongs to the component, and is not just read by it.
    owned: Vec<bool>,
    /// By event: the label, if the event is one.
    labels: Vec<Option<usize>>,
    /// Of a clock: when it samples, and by location the label. Where that cannot be taken, it takes its own event.
    sampling: Option<(Sampling, Vec<usize>)>,
    /// Of a channel that does not carry all messages: why.
    pub(crate) weakness: Option<channel::Weakness>,
    /// The group that the component belongs to.
    group: usize,
    /// By coordinate: where its value is among those of the group.
    places: Vec<usize>,
    /// The first of these places, if they follow each other.
    window: Option<usize>,
    /// What happens where its jumps accumulate, if it says so itself.
    accumulation: Option<Accumulation>,
    /// The event that is taken beyond an accumulation of its jumps.
    continuation: Option<usize>,
}

#[derive(Clone)]
struct Label {
    name: String,
    /// The components that know the event, ascending, each with its number of the event.
    participants: Vec<(usize, usize)>,
}

impl Composition {
    /// Begins a composition.
    pub fn builder() -> CompositionBuilder {
        CompositionBuilder::default()
    }

    /// The names of the components in their order.
    pub fn components(&self) -> impl ExactSizeIterator<Item = &str> {
        self.components.iter().map(|component| &*component.name)
    }

    /// The names of the variables, in the order of the values in states.
    pub fn variables(&self) -> &[String] {
        &self.variables
    }

    /// The signals of the components, each with its formula of variables.
    pub fn signals(&self) -> impl ExactSizeIterator<Item = (&str, &Expression)> {
        self.signals.iter().map(|(name, formula)| (name.as_str(), formula))
    }

    /// The variable or signal that an input reads, if there is an input of that name.
    pub(crate) fn source_of(&self, input: &str) -> Option<&str> {
        let mut inputs = self.inputs.iter();
        inputs.find(|(_, known)| known == input).map(|(source, _)| source.as_str())
    }

    /// The names of the locations of a component, in the order of their type; none for a component
    /// that does not exist.
    pub fn locations(&self, component: usize) -> impl Iterator<Item = &'static str> {
        let component = self.components.get(component);
        component.into_iter().flat_map(|one| one.blueprint.modes.iter().map(|mode| mode.name))
    }

    /// The labels, each with the components that take it together.
    pub fn labels(&self) -> impl ExactSizeIterator<Item = (&str, Vec<usize>)> {
        self.labels.iter().map(|label| {
            let participants = label.participants.iter().map(|(component, _)| *component);
            (&*label.name, participants.collect())
        })
    }
}

impl Composition {
    /// The names of the components that move.
    fn names_of(&self, moves: &[Move]) -> impl Iterator<Item = &str> {
        moves.iter().map(|one| &*self.components[one.component].name)
    }

    /// What the event of a move is called.
    fn event_of(&self, one: &Move) -> String {
        let component = &self.components[one.component];
        let leaving = &component.mode(one.source).leaving[one.transition];
        component.events[leaving.event].clone()
    }
}

impl Component {
    fn mode(&self, location: usize) -> &blueprint::Mode {
        &self.blueprint.modes[location]
    }
}
