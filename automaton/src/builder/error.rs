//! What can be wrong with the parts of an automaton.

use thiserror::Error;

use crate::signals::listed;

/// Why the parts do not make an automaton.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum BuildError {
    /// `Location::ALL` lacks a location.
    #[error("location {location} is missing in `Location::ALL` of its type")]
    UnlistedLocation {
        /// The location, as its `Debug` prints it.
        location: String,
    },
    /// `Event::ALL` lacks an event.
    #[error("event {event} is missing in `Event::ALL` of its type")]
    UnlistedEvent {
        /// The event, as its `Debug` prints it.
        event: String,
    },
    /// The table has transitions, but none of them enters or leaves the initial location.
    #[error("the initial location `{location}` occurs in no row of the table")]
    InitialNotInTable {
        /// The location.
        location: &'static str,
    },
    /// A location whose data transfers carry over occurs in no row of the table.
    #[error("location `{location}` occurs in no row of the table: say what leads to it")]
    LocationWithoutRow {
        /// The location.
        location: &'static str,
    },
    /// Two rows share source and event, and do not both have a guard of their own.
    #[error("two rows of the table leave location `{location}` on event `{event}`: keep one")]
    Nondeterministic {
        /// The source of the rows.
        location: &'static str,
        /// The event of the rows.
        event: &'static str,
    },
    /// A superstate is called like a location, or like another superstate with other members.
    #[error(
        "superstate `{superstate}` is called like a location, or like one with other members: rename one"
    )]
    SuperstateNameTaken {
        /// The name.
        superstate: &'static str,
    },
    /// A superstate has no location.
    #[error("superstate `{superstate}` has no location: name those that it stands for")]
    EmptySuperstate {
        /// The name.
        superstate: &'static str,
    },
    /// A superstate names a location twice.
    #[error("superstate `{superstate}` names location `{location}` twice: keep one")]
    RepeatedMember {
        /// The name of the superstate.
        superstate: &'static str,
        /// The location.
        location: &'static str,
    },
    /// Two superstates share locations, and neither contains the other.
    #[error(
        "superstates `{}` and `{}` share locations, and each has others: divide one of them", superstates[0], superstates[1]
    )]
    SuperstatesOverlap {
        /// The names.
        superstates: [&'static str; 2],
    },
    /// An event of the table has no guard.
    #[error("event `{event}` has no guard: say when it happens with `on`")]
    EventWithoutGuard {
        /// The event.
        event: &'static str,
    },
    /// A guard is given for an event that is in no row.
    #[error("guard `{guard}` is given for event `{event}`, which is in no row of the table")]
    GuardWithoutRow {
        /// The name of the guard.
        guard: String,
        /// The event.
        event: &'static str,
    },
    /// An event is to be taken at samples, and is in no row.
    #[error("event `{event}` is sampled, and is in no row of the table")]
    SampledWithoutRow {
        /// The event.
        event: &'static str,
    },
    /// An event cannot be taken at even intervals.
    #[error("event `{event}` cannot be sampled: {reason}")]
    Sampling {
        /// The event.
        event: &'static str,
        /// What is wrong with the period or the phase, and what would be right.
        reason: String,
    },
    /// An event has two guards, two transfers from one location, or is sampled twice; or a location has two flows or
    /// invariants.
    #[error("`{place}` is given its {part} twice: keep one")]
    GivenTwice {
        /// The event or the location.
        place: &'static str,
        /// What is given twice: guard, samples, flow or invariant.
        part: &'static str,
    },
    /// A row of the table is not carried out, although others are.
    #[error("nothing says what the row of `{location}` on event `{event}` carries over")]
    RowWithoutTransfer {
        /// The source of the row.
        location: &'static str,
        /// The event of the row.
        event: &'static str,
    },
    /// What is carried out is in no row of the table.
    #[error("no row of the table leads from `{source_location}` on event `{event}` to `{target}`")]
    TransferWithoutRow {
        /// The source.
        source_location: &'static str,
        /// The event.
        event: &'static str,
        /// The target.
        target: &'static str,
    },
    /// A guard or an invariant names a proposition that the state does not have.
    #[error("`{place}` names proposition `{proposition}`, which the state does not have")]
    UnknownProposition {
        /// The event or the location.
        place: &'static str,
        /// The name of the proposition.
        proposition: String,
    },
    /// A formula names a variable that the state does not have.
    #[error("the {part} of `{place}` names variable `{variable}`, which the state does not have")]
    UnknownVariable {
        /// The event or the location.
        place: &'static str,
        /// What names it: guard, reset, flow or invariant.
        part: &'static str,
        /// The name of the variable.
        variable: String,
    },
    /// A flow or a reset says twice what one coordinate does.
    #[error("the {part} of `{place}` gives `{coordinate}` two values: keep one")]
    CoordinateTwice {
        /// The event or the location.
        place: &'static str,
        /// Flow or reset.
        part: &'static str,
        /// The coordinate.
        coordinate: &'static str,
    },
    /// A parameter is called like a coordinate or another parameter.
    #[error("parameter `{parameter}` is called like a coordinate or another parameter: rename one")]
    ParameterNameTaken {
        /// The name.
        parameter: String,
    },
    /// A signal is called like a coordinate, a parameter or another signal.
    #[error(
        "signal `{signal}` is called like a coordinate, a parameter or another signal: rename one"
    )]
    SignalNameTaken {
        /// The name.
        signal: String,
    },
    /// Signals depend on each other in a cycle.
    #[error("no signal can depend on itself: {}", listed(signals))]
    SignalCycle {
        /// The names along the cycle, the first of them again at its end.
        signals: Vec<String>,
    },
    /// A parameter is infinite or NaN.
    #[error("parameter `{parameter}` is {value}: it must be a finite number")]
    ParameterNotFinite {
        /// The name.
        parameter: String,
        /// Its value.
        value: f64,
    },
    /// Rates are given for all locations, but the flow of one is a function.
    #[error("the flow of `{location}` is a function, to which no rates can be added")]
    NoRates {
        /// The location.
        location: &'static str,
    },
    /// A range is declared for a variable that the state does not have.
    #[error("a range is declared for variable `{variable}`, which the state does not have")]
    RangeOfUnknownVariable {
        /// The name of the variable.
        variable: String,
    },
    /// A range is empty, or one of its ends is NaN.
    #[error(
        "the range of `{variable}` runs from {lower} to {upper}: the first must be at most the \
         second"
    )]
    EmptyRange {
        /// The name of the variable.
        variable: String,
        /// The lower end given.
        lower: f64,
        /// The upper end given.
        upper: f64,
    },
    /// A reset gives a coordinate any number of an interval that holds none, or that does not end.
    #[error(
        "the reset of `{event}` gives `{coordinate}` a number between {lower} and {upper}: both must be \
         finite, and the first at most the second"
    )]
    EmptyInterval {
        /// The event.
        event: &'static str,
        /// The coordinate.
        coordinate: &'static str,
        /// The lower end given.
        lower: f64,
        /// The upper end given.
        upper: f64,
    },
    /// A coordinate of the initial state is NaN or infinite.
    #[error("`{variable}` is {value} in the initial state: it must be a finite number")]
    InitialNotFinite {
        /// The name of the coordinate.
        variable: &'static str,
        /// Its value.
        value: f64,
    },
}
