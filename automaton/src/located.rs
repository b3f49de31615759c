//! Locations that own data: states of an automaton as typed values.
//!
//! An enum that [`places!`](crate::places!) declares has one variant for each location, and each
//! variant holds the data that this location needs and no other. A transition from one location to
//! another is then a function from the source's data to the target's ([`Transfer`]): one that
//! forgets data, or needs data that its source does not have, does not compile. Tables, checks and
//! drawings see the locations alone, as they do of any other automaton.
//!
//! ```
//! use pleach_automaton::located::{Current, Holds, Transfer};
//! use pleach_automaton::{Automaton, places};
//! use pleach_discrete::{Row, TransitionTable, Urgency, vocabulary};
//! use pleach_guards::{Valuation, variable};
//!
//! places! {
//!     /// What a lift does.
//!     pub enum Lift: LiftLocation {
//!         /// It stands at a floor.
//!         Standing(Standing) = "standing",
//!         /// It is on its way between two floors.
//!         Moving(Moving) = "moving",
//!     }
//! }
//! #[derive(Clone, Debug, PartialEq)]
//! pub struct Standing { floor: u8 }
//! #[derive(Clone, Debug, PartialEq)]
//! pub struct Moving { from: u8, to: u8 }
//!
//! vocabulary! { enum Press: Event { Called = "called", Arrived = "arrived" } }
//!
//! struct Cabin { lift: Current<Lift>, call: u8, remaining: f64 }
//! # impl Valuation for Cabin {
//! #     fn value(&self, variable: &str) -> Option<f64> {
//! #         match variable { "remaining" => Some(self.remaining), "call" => Some(self.call.into()), _ => None }
//! #     }
//! # }
//! impl Holds<Lift> for Cabin {
//!     type Effects = ();
//!     fn current(&self) -> &Current<Lift> { &self.lift }
//!     fn current_mut(&mut self) -> &mut Current<Lift> { &mut self.lift }
//!     fn carry_out(&mut self, (): ()) {}
//! }
//!
//! fn set_out(standing: &Standing, cabin: &Cabin, _: &mut ()) -> Moving {
//!     Moving { from: standing.floor, to: cabin.call }
//! }
//! fn stop(moving: &Moving, _: &Cabin, _: &mut ()) -> Standing {
//!     Standing { floor: moving.to }
//! }
//!
//! const fn row(source: LiftLocation, event: Press, target: LiftLocation) -> Row<LiftLocation, Press> {
//!     Row { source, event, target, urgency: Urgency::AtOnce, priority: 0 }
//! }
//! const TABLE: TransitionTable<LiftLocation, Press> = TransitionTable::new(&[
//!     row(LiftLocation::Standing, Press::Called, LiftLocation::Moving),
//!     row(LiftLocation::Moving, Press::Arrived, LiftLocation::Standing),
//! ]);
//!
//! let automaton = Automaton::builder(TABLE, LiftLocation::Standing)
//!     .carried_out(Transfer::new(Press::Called, variable("call").more_than(0.0), "set out", set_out))
//!     .carried_out(Transfer::new(Press::Arrived, variable("remaining").at_most(0.0), "stop", stop))
//!     .build()?;
//!
//! let start = Lift::Standing(Standing { floor: 0 });
//! let mut cabin = Cabin { lift: Current::new(start), call: 3, remaining: 9.0 };
//! automaton.step_in_place(&mut cabin)?;
//! assert_eq!(*cabin.lift, Lift::Moving(Moving { from: 0, to: 3 }));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use std::ops::Deref;

use pleach_discrete::superstate;
use pleach_discrete::{Event, Location, Rule, Superstate};
use pleach_guards::{EvaluationError, Guard, Valuation};

use crate::reset::Reset;

/// A value of one of several types, one for each location; declared by
/// [`places!`](crate::places!).
pub trait Place: Sized + 'static {
    /// The locations.
    type Location: Location;

    /// The location that owns this value.
    fn location(&self) -> Self::Location;
}

/// The data that one location of `P` owns.
pub trait DataOf<P: Place>: Sized + 'static {
    /// The location.
    const LOCATION: P::Location;

    /// The data, if `place` is this location.
    fn of(place: &P) -> Option<&Self>;

    /// The place with this data.
    fn into_place(self) -> P;
}

/// Where an automaton stands. Only its own transitions change it: apart from [`new`](Self::new),
/// nothing makes one or assigns to it.
#[derive(Clone, Debug, PartialEq)]
pub struct Current<P>(P);

impl<P> Current<P> {
    /// The place where a run starts.
    pub const fn new(initial: P) -> Self {
        Current(initial)
    }
}

impl<P> Deref for Current<P> {
    type Target = P;

    fn deref(&self) -> &P {
        &self.0
    }
}

/// A state of which one part is the place of an automaton over `P`.
pub trait Holds<P: Place> {
    /// What a transition does beside entering its target, such as sending messages; nothing by
    /// default.
    type Effects: Default;

    /// Where the automaton stands.
    fn current(&self) -> &Current<P>;

    /// Where the automaton stands, for its transitions.
    fn current_mut(&mut self) -> &mut Current<P>;

    /// Carries out what a transition has done beside entering its target.
    fn carry_out(&mut self, effects: Self::Effects);
}

/// What the transitions on one event from one location do, and when: a function of the source's
/// data and the state before the jump, x⁻, to the target's data.
///
/// The locations are those of the function's types. The function changes nothing: what it returns
/// and the effects that it notes are carried out afterwards.
#[derive(Clone, Debug)]
pub struct Transfer<L: 'static, E, S> {
    pub(crate) rule: Rule<L, E>,
    pub(crate) guard: Guard,
    pub(crate) reset: Reset<S>,
}

impl<L: Location, E: Event, S: 'static> Transfer<L, E, S> {
    /// On `event`, where `guard` holds: `carry_over` under the name that drawings show.
    pub fn new<P, A, B>(
        event: E,
        guard: impl Into<Guard>,
        name: &str,
        carry_over: impl Fn(&A, &S, &mut S::Effects) -> B + Send + Sync + 'static,
    ) -> Self
    where
        P: Place<Location = L>,
        A: DataOf<P>,
        B: DataOf<P>,
        S: Holds<P> + Valuation,
    {
        let total = move |data: &A, state: &S, effects: &mut S::Effects| {
            Some(carry_over(data, state, effects))
        };
        Transfer::where_known(event, guard, name, total)
    }

    /// As [`new`](Self::new), where the state may lack the data that the target needs although the
    /// guard holds: to take the transition then is an error, and the state is as before.
    pub fn where_known<P, A, B>(
        event: E,
        guard: impl Into<Guard>,
        name: &str,
        carry_over: impl Fn(&A, &S, &mut S::Effects) -> Option<B> + Send + Sync + 'static,
    ) -> Self
    where
        P: Place<Location = L>,
        A: DataOf<P>,
        B: DataOf<P>,
        S: Holds<P> + Valuation,
    {
        let place_after = move |state: &S, effects: &mut S::Effects| {
            let data = A::of(state.current()).ok_or(A::LOCATION)?;
            carry_over(data, state, effects).map(B::into_place).ok_or(B::LOCATION)
        };
        let rule = superstate::from(A::LOCATION).on(event).to(B::LOCATION);
        Transfer { rule, guard: guard.into(), reset: entering(name, Box::new(place_after)) }
    }

    /// As [`new`](Self::new), from each location of a superstate, whose data are read as the enum of places.
    pub fn from_any<P, B>(
        superstate: Superstate<L>,
        event: E,
        guard: impl Into<Guard>,
        name: &str,
        carry_over: impl Fn(&P, &S, &mut S::Effects) -> B + Send + Sync + 'static,
    ) -> Self
    where
        P: Place<Location = L>,
        B: DataOf<P>,
        S: Holds<P> + Valuation,
    {
        let total = move |place: &P, state: &S, effects: &mut S::Effects| {
            Some(carry_over(place, state, effects))
        };
        Transfer::from_any_where_known(superstate, event, guard, name, total)
    }

    /// As [`where_known`](Self::where_known), from each location of a superstate.
    pub fn from_any_where_known<P, B>(
        superstate: Superstate<L>,
        event: E,
        guard: impl Into<Guard>,
        name: &str,
        carry_over: impl Fn(&P, &S, &mut S::Effects) -> Option<B> + Send + Sync + 'static,
    ) -> Self
    where
        P: Place<Location = L>,
        B: DataOf<P>,
        S: Holds<P> + Valuation,
    {
        let place_after = move |state: &S, effects: &mut S::Effects| {
            carry_over(state.current(), state, effects).map(B::into_place).ok_or(B::LOCATION)
        };
        let rule = superstate::from_any(superstate).on(event).to(B::LOCATION);
        Transfer { rule, guard: guard.into(), reset: entering(name, Box::new(place_after)) }
    }

    /// From each location of a superstate to itself, with the same data: only effects follow. None is an error, as in
    /// [`where_known`](Self::where_known).
    pub fn staying_in<P>(
        superstate: Superstate<L>,
        event: E,
        guard: impl Into<Guard>,
        name: &str,
        act: impl Fn(&P, &S, &mut S::Effects) -> Option<()> + Send + Sync + 'static,
    ) -> Self
    where
        P: Place<Location = L> + Clone,
        S: Holds<P> + Valuation,
    {
        let place_after = move |state: &S, effects: &mut S::Effects| {
            let place: &P = state.current();
            act(place, state, effects).map(|()| place.clone()).ok_or(place.location())
        };
        let rule = superstate::from_any(superstate).on(event).stay();
        Transfer { rule, guard: guard.into(), reset: entering(name, Box::new(place_after)) }
    }
}

/// The place that a transition enters, or the location that lacks its data.
type PlaceAfter<P, S> =
    dyn Fn(&S, &mut <S as Holds<P>>::Effects) -> Result<P, <P as Place>::Location> + Send + Sync;

/// The reset that enters a place and carries out the effects; it is compiled once for all transitions of an automaton.
fn entering<P: Place, S: Holds<P> + 'static>(
    name: &str,
    place_after: Box<PlaceAfter<P, S>>,
) -> Reset<S> {
    Reset::fallible(name, move |state: &mut S| {
        let mut effects = S::Effects::default();
        let place = place_after(state, &mut effects);
        let missing =
            |location: P::Location| EvaluationError::MissingData { location: location.name() };
        *state.current_mut() = Current(place.map_err(missing)?);
        state.carry_out(effects);
        Ok(())
    })
}

/// Declares an enum of [places](Place) and, after the colon, the enum of their locations.
///
/// Each variant holds the data of its location, which is a type of its own, and is called as it is
/// written or by the name after an equals sign.
#[macro_export]
macro_rules! places {
    (
        $(#[$attribute:meta])*
        $visibility:vis enum $place:ident : $location:ident {
            $($(#[$note:meta])* $variant:ident($data:ty) $(= $word:literal)?),+ $(,)?
        }
    ) => {
        $crate::discrete::vocabulary! {
            $(#[$attribute])*
            $visibility enum $location: Location {
                $($(#[$note])* $variant $(= $word)?),+
            }
        }
        $crate::places_of! {
            $(#[$attribute])*
            $visibility enum $place: $location { $($(#[$note])* $variant($data)),+ }
        }
    };
}

/// Declares an enum of [places](Place) whose locations are declared already: each variant is called
/// like its location.
#[macro_export]
macro_rules! places_of {
    (
        $(#[$attribute:meta])*
        $visibility:vis enum $place:ident : $location:ident {
            $($(#[$note:meta])* $variant:ident($data:ty)),+ $(,)?
        }
    ) => {
        $(#[$attribute])*
        #[derive(Clone, Debug, PartialEq)]
        $visibility enum $place {
            $($(#[$note])* $variant($data)),+
        }

        impl $crate::located::Place for $place {
            type Location = $location;

            fn location(&self) -> $location {
                match self {
                    $($place::$variant(_) => $location::$variant),+
                }
            }
        }

        $(impl $crate::located::DataOf<$place> for $data {
            const LOCATION: $location = $location::$variant;

            fn of(place: &$place) -> Option<&Self> {
                match place {
                    $place::$variant(data) => Some(data),
                    #[allow(unreachable_patterns)]
                    _ => None,
                }
            }

            fn into_place(self) -> $place {
                $place::$variant(self)
            }
        })+
    };
}

#[cfg(test)]
mod tests {
    use pleach_discrete::{Superstate, TransitionTable, from, from_any, transitions, vocabulary};
    use pleach_guards::always;

    use super::*;
    use crate::{Automaton, BuildError};

    places! {
        /// What a lamp does.
        enum Lamp: Lit {
            Dark(Dark),
            Dim(Dim),
            Bright(Bright),
        }
    }
    #[derive(Clone, Debug, PartialEq)]
    struct Dark;
    #[derive(Clone, Debug, PartialEq)]
    struct Dim(u8);
    #[derive(Clone, Debug, PartialEq)]
    struct Bright(u8);

    vocabulary! { enum Press: Event { On, More, Off, Count } }

    const SHINING: Superstate<Lit> = Superstate::new("shining", &[Lit::Dim, Lit::Bright]);

    struct Room {
        lamp: Current<Lamp>,
        counted: u8,
    }

    impl Valuation for Room {
        fn value(&self, variable: &str) -> Option<f64> {
            (variable == "counted").then_some(self.counted.into())
        }
    }

    impl Holds<Lamp> for Room {
        type Effects = u8;

        fn current(&self) -> &Current<Lamp> {
            &self.lamp
        }

        fn current_mut(&mut self) -> &mut Current<Lamp> {
            &mut self.lamp
        }

        fn carry_out(&mut self, count: u8) {
            self.counted += count;
        }
    }

    type Row = Transfer<Lit, Press, Room>;

    fn on() -> Row {
        Transfer::new(Press::On, always(), "switch on", |_: &Dark, _: &Room, _: &mut u8| Dim(1))
    }

    fn brighten() -> Row {
        let brighten = |dim: &Dim, _: &Room, _: &mut u8| Bright(dim.0 + 1);
        Transfer::new(Press::More, always(), "brighten", brighten)
    }

    fn off() -> Row {
        let off = |_: &Lamp, _: &Room, _: &mut u8| Dark;
        Transfer::from_any(SHINING, Press::Off, always(), "switch off", off)
    }

    const TABLE: TransitionTable<Lit, Press> = transitions![Lit, Press;
        from(Lit::Dark).on(Press::On).to(Lit::Dim),
        from(Lit::Dim).on(Press::More).to(Lit::Bright),
        from_any(SHINING).on(Press::Off).to(Lit::Dark).priority(1),
    ];

    #[test]
    fn transfers_of_a_superstate_leave_each_of_its_places() {
        const COUNTED: TransitionTable<Lit, Press> = transitions![Lit, Press;
            from(Lit::Dark).on(Press::On).to(Lit::Bright),
            from_any(SHINING).on(Press::Count).stay(),
            from_any(SHINING).on(Press::Off).to(Lit::Dark).priority(1),
            from(Lit::Bright).on(Press::More).to(Lit::Dim).priority(2),
        ];
        let few = || pleach_guards::variable("counted").less_than(3.0);
        let count = |_: &Lamp, _: &Room, effects: &mut u8| {
            *effects += 1;
            Some(())
        };
        let automaton = Automaton::builder(COUNTED, Lit::Dark)
            .carried_out(Transfer::new(
                Press::On,
                few(),
                "switch on",
                |_: &Dark, _: &Room, _: &mut u8| Bright(7),
            ))
            .carried_out(Transfer::staying_in(SHINING, Press::Count, few(), "count", count))
            .carried_out(off())
            .carried_out(Transfer::new(
                Press::More,
                always(),
                "dim",
                |bright: &Bright, _: &Room, _: &mut u8| Dim(bright.0 - 1),
            ))
            .build()
            .expect("the parts fit");
        let mut room = Room { lamp: Current::new(Lamp::Dark(Dark)), counted: 0 };
        let mut step = || {
            automaton.step_in_place::<Lamp>(&mut room).expect("its guards have values");
            (Lamp::clone(&room.lamp), room.counted)
        };
        let bright = |counted| (Lamp::Bright(Bright(7)), counted);
        assert_eq!([step(), step(), step(), step()], [0, 1, 2, 3].map(bright));
        assert_eq!(step(), (Lamp::Dark(Dark), 3));
        assert_eq!(step(), (Lamp::Dark(Dark), 3), "it has been counted often enough");
    }

    #[test]
    fn a_row_or_a_location_that_nothing_is_said_of_is_refused() {
        let build = |table: TransitionTable<'_, Lit, Press>, rows: Vec<Row>| {
            let builder = Automaton::builder(table, Lit::Dark);
            let built = rows.into_iter().fold(builder, |builder, row| builder.carried_out(row));
            built.build().map(drop)
        };
        assert_eq!(build(TABLE, vec![on(), brighten(), off()]), Ok(()));
        let row = BuildError::RowWithoutTransfer { location: "Dim", event: "Off" };
        assert_eq!(build(TABLE, vec![on(), brighten()]), Err(row));
        const TWO: TransitionTable<Lit, Press> = transitions![Lit, Press;
            from(Lit::Dark).on(Press::On).to(Lit::Dim),
        ];
        let location = BuildError::LocationWithoutRow { location: "Bright" };
        assert_eq!(build(TWO, vec![on()]), Err(location));
        let transfer = BuildError::TransferWithoutRow {
            source_location: "Dim",
            event: "More",
            target: "Bright",
        };
        assert_eq!(build(TWO, vec![on(), brighten()]), Err(transfer));
    }
}
