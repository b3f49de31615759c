//! Locations, events and transition tables: the discrete layer, pure and small.
//!
//! A hybrid automaton jumps between *locations*; an *event* is the name of a jump. All that the
//! discrete layer knows of a model is one [`TransitionTable`]: which event leads from which location
//! to which, how urgently, and in which order if several transitions could be taken. Running,
//! drawing, checking and proving read the same table.
//!
//! What leaves several locations alike is declared once, from a [`Superstate`].
//!
//! No continuous value gets here, a table is read without allocation, and every order is total; that
//! keeps the layer within reach of exhaustive checks and proofs.
//!
//! ```
//! use pleach_discrete::{vocabulary, Row, TransitionTable, Urgency};
//!
//! vocabulary! {
//!     enum Heater: Location { Off = "off", On = "on" }
//!     enum Sensed: Event { TooCold = "too cold", TooWarm = "too warm" }
//! }
//!
//! const THERMOSTAT: TransitionTable<Heater, Sensed> = TransitionTable::new(&[
//!     Row { source: Heater::Off, event: Sensed::TooCold, target: Heater::On, urgency: Urgency::Must, priority: 0 },
//!     Row { source: Heater::On, event: Sensed::TooWarm, target: Heater::Off, urgency: Urgency::Must, priority: 0 },
//! ]);
//!
//! assert_eq!(THERMOSTAT.next(Heater::Off, Sensed::TooCold), Ok(Heater::On));
//! let refusal = THERMOSTAT.next(Heater::Off, Sensed::TooWarm).unwrap_err();
//! assert_eq!(refusal.to_string(), "no transition leaves location `off` on event `too warm`");
//! ```

#![warn(unreachable_pub)]

mod location;
pub mod network;
pub mod superstate;
mod table;
mod urgency;
pub mod vocabulary;

pub use location::{Event, Location};
pub use superstate::{Rule, Source, Superstate, from, from_any};
pub use table::{InvalidTransition, Row, TransitionTable, first_mentions};
pub use urgency::Urgency;
