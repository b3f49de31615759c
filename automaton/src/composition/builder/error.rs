//! What can be wrong with parts that are put side by side.

use pleach_guards::EvaluationError;
use thiserror::Error;

use crate::signals::listed;

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
    /// A component has a name that cannot be read back where it is joined to others.
    #[error(
        "`{name}` cannot name a component: names stand before a dot and between commas, so they cannot be \
         empty, nor have a dot, a comma, a quotation mark or a line break"
    )]
    Name {
        /// The name.
        name: String,
    },
    /// Two variables have one name, since names of components or coordinates contain dots.
    #[error("two variables are called `{variable}`: rename a component or a coordinate")]
    VariableTwice {
        /// The name, `component.coordinate`.
        variable: String,
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
    /// A coordinate of the state in which a component starts is NaN.
    #[error(
        "`{variable}` of component `{component}` is NaN in the initial state: it must be a number"
    )]
    InitialNotANumber {
        /// The component.
        component: String,
        /// The coordinate.
        variable: &'static str,
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
    /// What happens at an accumulation is stated before any component is added.
    #[error("no component has been added yet: call `at_accumulation` after `add`")]
    NoComponent,
    /// A connection begins or ends at a variable that does not exist.
    #[error("no component has the variable `{variable}`: {known}")]
    UnknownVariable {
        /// The variable.
        variable: String,
        /// What there is.
        known: String,
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
    /// Signals of components depend on each other in a cycle.
    #[error("no signal can depend on itself: {}", listed(signals))]
    SignalCycle {
        /// The names along the cycle, of signals and of inputs that read them, the first of them again at
        /// its end.
        signals: Vec<String>,
    },
    /// An event cannot be taken at even intervals.
    #[error("`{event}` cannot be sampled: {reason}")]
    Sampler {
        /// The event.
        event: String,
        /// What is wrong, and what would be right.
        reason: String,
    },
    /// What a channel carries is read elsewhere than in the jump in which it arrives.
    #[error(
        "component `{component}` reads `{coordinate}` in {reader}, where the message may be under way: \
         read it in the jump of its arrival, or let the channel hold it, with `Channel::held`"
    )]
    InTransit {
        /// The component.
        component: String,
        /// The coordinate.
        coordinate: String,
        /// What reads it.
        reader: String,
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
    #[error("no component has the event `{event}`: {known}")]
    UnknownMessage {
        /// The event.
        event: String,
        /// What there is.
        known: String,
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
        /// What stands against it, and what would be right.
        reason: String,
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
