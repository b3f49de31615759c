//! Transitions as one writes them: from where, on which event, to where, how urgently, when.

use pleach_discrete::superstate;
use pleach_discrete::{Row, Rule, Superstate, Urgency};
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
    Departure(superstate::from(location))
}

/// Begins the transition that leaves each location of a superstate: in all of them it has the same guard and does the
/// same.
///
/// ```
/// use pleach_automaton::{Automaton, Edge, coordinates, from, from_any};
/// use pleach_discrete::{Superstate, vocabulary};
///
/// vocabulary! {
///     enum Pump: Location { Off = "off", Filling = "filling", Draining = "draining" }
///     enum Command: Event { Full = "full", Stopped = "stopped" }
/// }
/// coordinates! { struct Tank { level = "l" } }
/// use {Command::{Full, Stopped}, Pump::{Draining, Filling, Off}};
///
/// const RUNNING: Superstate<Pump> = Superstate::new("running", &[Filling, Draining]);
/// let Tank { level } = Tank::coordinates();
/// let pump = Automaton::starting_in(Filling)
///     .initially(Tank { level: 0.0 })
///     .flow(Filling, level.rate(1.0))
///     .flow(Draining, level.rate(-2.0))
///     .transition(from(Filling).on(Full).to(Draining).must(level.at_least(1.0)))
///     .transition(from_any(RUNNING).on(Stopped).to(Off).must(level.at_most(0.5)).priority(1))
///     .build()?;
///
/// assert_eq!(pump.table().rows().len(), 3);
/// assert!(pump.superstates().eq([("running", vec![Filling, Draining])]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn from_any<L>(superstate: Superstate<L>) -> Departure<L> {
    Departure(superstate::from_any(superstate))
}

/// A transition that says where it begins; see [`from`].
#[must_use = "say on which event"]
#[derive(Clone, Copy, Debug)]
pub struct Departure<L: 'static>(superstate::Departure<L>);

/// A transition that says where it begins and on which event; see [`from`].
#[must_use = "say where it leads"]
#[derive(Clone, Copy, Debug)]
pub struct Trigger<L: 'static, E>(superstate::Trigger<L, E>);

/// A transition that lacks its urgency and guard; see [`from`].
#[must_use = "say how urgent it is: may, must or at once"]
#[derive(Clone, Copy, Debug)]
pub struct Arrow<L: 'static, E>(Rule<L, E>);

/// A transition with everything that it needs; see [`from`].
#[must_use = "give it to a builder"]
#[derive(Clone, Debug)]
pub struct Edge<L: 'static, E, S> {
    pub(crate) rule: Rule<L, E>,
    pub(crate) guard: Guard,
    pub(crate) reset: Reset<S>,
}

impl<L: Copy> Departure<L> {
    /// On this event.
    pub fn on<E: Copy>(self, event: E) -> Trigger<L, E> {
        Trigger(self.0.on(event))
    }
}

impl<L: Copy, E: Copy> Trigger<L, E> {
    /// To this location.
    pub fn to(self, location: L) -> Arrow<L, E> {
        Arrow(self.0.to(location))
    }

    /// To the location in which it is taken.
    pub fn stay(self) -> Arrow<L, E> {
        Arrow(self.0.stay())
    }
}

impl<L: Copy, E: Copy> Arrow<L, E> {
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
        Edge { rule: self.0.urgency(urgency), guard, reset: Reset::identity() }
    }
}

impl<L: Copy, E: Copy, S> Edge<L, E, S> {
    /// The transition of this row.
    pub(crate) fn of_row(row: Row<L, E>, guard: Guard, reset: Reset<S>) -> Self {
        Edge { rule: Rule::of(row), guard, reset }
    }

    /// What it does to the state; without this, nothing.
    pub fn then(self, reset: impl Into<Reset<S>>) -> Self {
        Edge { reset: reset.into(), ..self }
    }

    /// Which goes first where several could be taken: 0, which is the default, before 1, and so
    /// on. Of transitions of one priority the one given first goes first; a check reports them.
    pub fn priority(self, priority: u8) -> Self {
        Edge { rule: self.rule.priority(priority), ..self }
    }
}
