//! Transitions as one writes them: from where, on which event, to where, how urgently, when.

use pleach_discrete::{Row, Urgency};
use pleach_guards::Guard;

use crate::reset::Reset;

/// Begins the transition that leaves `location`.
///
/// It reads as a sentence, and only a whole sentence is an [`Edge`]: without an urgency it does
/// not compile.
///
/// ```
/// use pleach_automaton::{coordinates, from, Edge};
/// use pleach_discrete::vocabulary;
///
/// vocabulary! {
///     enum Motion: Location { Falling = "falling" }
///     enum Contact: Event { Bounce = "bounce" }
/// }
/// coordinates! { struct Ball { height = "h", velocity = "v" } }
/// let Ball { height, velocity } = Ball::coordinates();
///
/// let bounce = from(Motion::Falling)
///     .on(Contact::Bounce)
///     .to(Motion::Falling)
///     .must(height.at_most(0.0) & velocity.less_than(0.0))
///     .then([velocity.becomes(-0.8 * &velocity)]);
/// # let _: Edge<Motion, Contact, Ball> = bounce;
/// ```
pub fn from<L>(location: L) -> Departure<L> {
    Departure { source: location }
}

/// A transition that says where it begins; see [`from`].
#[must_use = "say on which event"]
#[derive(Clone, Copy, Debug)]
pub struct Departure<L> {
    source: L,
}

/// A transition that says where it begins and on which event; see [`from`].
#[must_use = "say where it leads"]
#[derive(Clone, Copy, Debug)]
pub struct Trigger<L, E> {
    source: L,
    event: E,
}

/// A transition that lacks its urgency and guard; see [`from`].
#[must_use = "say how urgent it is: may, must or at once"]
#[derive(Clone, Copy, Debug)]
pub struct Arrow<L, E> {
    source: L,
    event: E,
    target: L,
}

/// A transition with everything that it needs; see [`from`].
#[must_use = "give it to a builder"]
#[derive(Clone, Debug)]
pub struct Edge<L, E, S> {
    pub(crate) row: Row<L, E>,
    pub(crate) guard: Guard,
    pub(crate) reset: Reset<S>,
}

impl<L> Departure<L> {
    /// On this event.
    pub fn on<E>(self, event: E) -> Trigger<L, E> {
        Trigger { source: self.source, event }
    }
}

impl<L, E> Trigger<L, E> {
    /// To this location.
    pub fn to(self, location: L) -> Arrow<L, E> {
        Arrow { source: self.source, event: self.event, target: location }
    }
}

impl<L, E> Arrow<L, E> {
    /// It may be taken where `guard` holds; time may pass instead. [`Urgency::May`]
    pub fn may<S>(self, guard: impl Into<Guard>) -> Edge<L, E, S> {
        self.when(Urgency::May, guard.into())
    }

    /// It must be taken at the instant at which `guard` becomes true. [`Urgency::Must`]
    pub fn must<S>(self, guard: impl Into<Guard>) -> Edge<L, E, S> {
        self.when(Urgency::Must, guard.into())
    }

    /// No time passes where `guard` holds. [`Urgency::AtOnce`]
    pub fn at_once<S>(self, guard: impl Into<Guard>) -> Edge<L, E, S> {
        self.when(Urgency::AtOnce, guard.into())
    }

    fn when<S>(self, urgency: Urgency, guard: Guard) -> Edge<L, E, S> {
        let Arrow { source, event, target } = self;
        let row = Row { source, event, target, urgency, priority: 0 };
        Edge { row, guard, reset: Reset::identity() }
    }
}

impl<L, E, S> Edge<L, E, S> {
    /// What it does to the state; without this, nothing.
    pub fn then(self, reset: impl Into<Reset<S>>) -> Self {
        Edge { reset: reset.into(), ..self }
    }

    /// Which goes first where several could be taken: 0, which is the default, before 1, and so
    /// on. Of transitions of one priority the one given first goes first; a check reports them.
    pub fn priority(mut self, priority: u8) -> Self {
        self.row.priority = priority;
        self
    }
}
