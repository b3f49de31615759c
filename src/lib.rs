//! Hybrid automata as typed Rust values, and a distributed robot network written with them.
//!
//! A hybrid automaton jumps between locations and flows within them. Here its parts are values:
//! locations and events are enums; guards and invariants are [predicates](guards::Predicate) that
//! can be evaluated, printed and analysed; flows and resets are formulas too, or named functions.
//! An [`Automaton`](automaton::Automaton) puts them together and refuses parts that do not
//! fit; a [`Composition`](automaton::composition) joins automata by labels; one
//! [`Executor`](automaton::Executor) runs them through hybrid time; [`diagram`](automaton::diagram)
//! draws them, and [temporal formulas](verify::temporal) judge their trajectories.
//!
//! # A control loop
//!
//! A room with a load that follows a table, heated by a PI controller that is sampled every 10 ms,
//! saturates and unwinds its integral. Its output takes effect 25 ms after each sample:
//!
//! ```
//! use pleach::prelude::*;
//!
//! vocabulary! {
//!     enum Place: Location { Running = "running" }
//!     enum Clock: Event { Sample = "sample" }
//! }
//! coordinates! {
//!     struct Room { temperature = "T", heating = "u", time = "t" }
//!     struct Controller { measured = "T", integral = "I" }
//! }
//! use {Clock::Sample, Place::Running};
//!
//! let Room { temperature, heating, time } = Room::coordinates();
//! let load = Table::steps([(0.0, 0.0), (5.0, -2.0), (10.0, 0.0)])?.at(&time);
//! let room = Automaton::<_, Clock, _>::starting_in(Running)
//!     .initially(Room { temperature: 0.0, heating: 0.0, time: 0.0 })
//!     .flow(Running, [temperature.rate((&heating + load - &temperature) / 0.5), time.rate(1)])
//!     .build()?;
//!
//! let Controller { measured, integral } = Controller::coordinates();
//! let (error, output) = (variable("e"), variable("u"));
//! let wanted = 4.0 * &error + &integral;
//! let unwound = 0.01 * (6.0 * error + 2.0 * (output - &wanted));
//! let controller = Automaton::starting_in(Running)
//!     .initially(Controller { measured: 0.0, integral: 0.0 })
//!     .signal("e", 3.0 - &measured)
//!     .signal("u", wanted.max(0.0).min(10.0))
//!     .transition(
//!         from(Running).on(Sample).to(Running).may(always())
//!             .then(integral.becomes(&integral + unwound)),
//!     )
//!     .build()?;
//!
//! let delayed = Channel::holding_last("pi.sample").held("pi.u", "room.u", 0.0);
//! let heated = Composition::builder()
//!     .add("room", &room)
//!     .add("pi", &controller)
//!     .connect("room.T", "pi.T")
//!     .every("pi.sample", 0.01)
//!     .channel(delayed.taking(0.025, 0.025).holding(3))
//!     .build()?;
//! let run = heated.run(15.0)?;
//! assert!((run.value("room.T", 15.0)? - 3.0).abs() < 0.05);
//! assert!(run.value("pi.e", 15.0)?.abs() < 0.05);
//! # Ok::<(), MainError>(())
//! ```
//!
//! Where the load jumps, steps of the integration end exactly. `heated.stream(…)` shows a run to
//! [observers](automaton::composition::stream) as it happens, such as one that writes CSV, in
//! memory that does not grow.
//!
//! # Locations
//!
//! A thermostat that keeps a room between 18 and 22 degrees:
//!
//! ```
//! use pleach::prelude::*;
//!
//! vocabulary! {
//!     enum Heater: Location { Off = "off", On = "on" }
//!     enum Sensed: Event { Cold = "cold", Warm = "warm" }
//! }
//! coordinates! { struct Room { temperature = "T" } }
//! use {Heater::{Off, On}, Sensed::{Cold, Warm}};
//!
//! let Room { temperature } = Room::coordinates();
//! let thermostat = Automaton::starting_in(Off)
//!     .initially(Room { temperature: 20.0 })
//!     .flow(Off, temperature.rate(-0.1 * &temperature))
//!     .flow(On, temperature.rate(5.0 - 0.1 * &temperature))
//!     .transition(from(Off).on(Cold).to(On).must(temperature.at_most(18.0)))
//!     .transition(from(On).on(Warm).to(Off).must(temperature.at_least(22.0)))
//!     .build()?;
//!
//! let trajectory = thermostat.run(60.0)?;
//! let first = &trajectory.jumps()[0];
//! assert_eq!(first.label, "cold");
//! assert!((first.at.t - 10.0 * (20.0f64 / 18.0).ln()).abs() < 1e-12);
//! assert_eq!(trajectory.location(0, first.at.t), Some("on"));
//!
//! // From 2 s to 58 s the room is within its band.
//! use pleach::verify::temporal::{Status, always, within};
//! let band = temperature.at_least(17.9) & temperature.at_most(22.1);
//! let judgement = always(within(2.0, 58.0)?, band).judge(&trajectory)?;
//! assert_eq!(judgement.status, Status::Satisfied);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The examples of the repository are the classics of the field: bouncing ball, thermostat, two
//! tanks, a clock network, a platoon and others, each tested against a closed form or a published
//! answer.
//!
//! # The robot network
//!
//! With the feature `network`, which the default feature `cli` brings along, the crate has the model
//! that was written with it: the robot network of *Global Planning for Multi-Robot Communication
//! Networks in Complex Environments*, robots that grow trees of relays from access points to tasks.
//! Each robot is an automaton that decides from its own state and from the messages that it
//! receives. The module `mission` runs it.
//!
//! # Where to read on
//!
//! | layer | holds |
//! | --- | --- |
//! | [`guards`] | predicates over states with a signed margin |
//! | [`discrete`] | locations, events, tables |
//! | [`continuous`] | [flows](continuous::flow) |
//! | [`automaton`] | automaton, composition, executor, trajectories, checks, diagrams |
//! | [`verify`] | [temporal logic](verify::temporal) over trajectories, [reachability](verify::reach) of any automaton |
//! | this crate | the [prelude], [pages](page) on which a run plays; with the feature `spaceex` models and questions of SpaceEx |
//!
//! Without its default features the crate is this framework: it needs neither geometry nor a solver.

#![warn(unreachable_pub)]
#![cfg_attr(test, allow(clippy::unwrap_used))] // a test that panics has failed

// The command line speaks of this library by its name, as other programs do.
#[cfg(feature = "cli")]
extern crate self as pleach;

/// The command line, for this program and for that of the package for real processes, which adds
/// commands to it. It is no library to build on.
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
mod colours;
#[cfg(feature = "network")]
pub mod figures;
#[cfg(feature = "cli")]
pub mod import;
#[cfg(feature = "network")]
pub mod judge;
mod main_error;
#[cfg(feature = "network")]
pub mod mission;
pub mod page;
#[cfg(feature = "pdf")]
pub mod pdf;
pub mod prelude;
#[cfg(feature = "mcap")]
pub mod recording;
#[cfg(feature = "network")]
pub mod scenario_file;
#[cfg(feature = "spaceex")]
pub mod spaceex;
#[cfg(feature = "network")]
pub mod starts;
#[cfg(feature = "network")]
pub mod story;
#[cfg(feature = "network")]
pub mod summary;
#[cfg(feature = "cli")]
pub mod task_list;
#[cfg(feature = "network")]
pub mod trace;

pub use main_error::MainError;
pub use pleach_automaton as automaton;
pub use pleach_continuous as continuous;
pub use pleach_discrete as discrete;
pub use pleach_guards as guards;
pub use pleach_verify as verify;

/// The examples of the README compile and run.
#[cfg(all(doctest, feature = "network"))]
#[doc = include_str!("../README.md")]
struct Readme;

/// The example of the page on reachability compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../docs/reachability.md")]
struct Reachability;

/// The examples of the how-tos compile and run.
#[cfg(all(doctest, feature = "network"))]
mod how_to {
    #[doc = include_str!("../docs/how-to/controller.md")]
    struct Controller;
    #[doc = include_str!("../docs/how-to/link-model.md")]
    struct LinkModel;
    #[cfg(feature = "cli")]
    #[doc = include_str!("../docs/how-to/map.md")]
    struct Map;
    #[doc = include_str!("../docs/how-to/medium.md")]
    struct Medium;
    #[doc = include_str!("../docs/how-to/model.md")]
    struct Model;
    #[doc = include_str!("../docs/how-to/monitor.md")]
    struct Monitor;
    #[doc = include_str!("../docs/how-to/real-robots.md")]
    struct RealRobots;
}
