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
//! # A model
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
//! answer. The rest of this page runs the model that comes with the framework, the robot network of
//! *Global Planning for Multi-Robot Communication Networks in Complex Environments*: robots that
//! grow trees of relays from access points to tasks. Each robot is an automaton that decides from
//! its own state and from the messages that it hears.
//!
//! # A mission
//!
//! A [`Scenario`](automaton::network::scenario::Scenario) is plain data. A
//! [`ValidScenario`](automaton::network::scenario::ValidScenario) is one from which a mission can
//! start: read from a file by [`scenario_file::read`], or built as here. This is a room of 1.2 by 0.6
//! with an access point at the left and a task at the right, farther away than one link reaches.
//!
//! ```
//! use pleach::automaton::network::scenario::{
//!     AccessPoint, Agenda, Control, LinkRanges, RobotStart, Scenario, Task, ValidScenario,
//!     WorkspaceOutline,
//! };
//!
//! let robot = |x, y| RobotStart::at([x, y], 0.075);
//! let scenario = ValidScenario::new(Scenario {
//!     name: "room".into(),
//!     description: None,
//!     workspace: WorkspaceOutline {
//!         boundary: vec![[0.0, 0.0], [1.2, 0.0], [1.2, 0.6], [0.0, 0.6]],
//!         holes: vec![],
//!     },
//!     link: LinkRanges::new(0.4, 0.5),
//!     control: Control::default(),
//!     mission: Agenda::default(),
//!     access_point: vec![AccessPoint { position: [0.1, 0.3] }],
//!     robot: vec![robot(0.1, 0.1), robot(0.25, 0.2), robot(0.1, 0.5)],
//!     task: vec![Task::at([0.9, 0.3])],
//! })?;
//! assert!(scenario.remarks().is_empty()); // every task can be reached, and no link crosses a wall
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`mission::run`] runs the mission to its end. [`Watcher`](mission::Watcher)s see every control
//! period; the [`Summary`](summary::Summary) that the program prints is one of them.
//!
//! ```
//! # use pleach::automaton::network::scenario::{
//! #     AccessPoint, Control, LinkRanges, RobotStart, Scenario, Task, ValidScenario,
//! #     WorkspaceOutline,
//! # };
//! # let robot = |x, y| RobotStart::at([x, y], 0.075);
//! # let scenario = ValidScenario::new(Scenario {
//! #     name: "room".into(),
//! #     description: None,
//! #     workspace: WorkspaceOutline {
//! #         boundary: vec![[0.0, 0.0], [1.2, 0.0], [1.2, 0.6], [0.0, 0.6]],
//! #         holes: vec![],
//! #     },
//! #     link: LinkRanges::new(0.4, 0.5),
//! #     control: Control::default(),
//! #     mission: Agenda::default(),
//! #     access_point: vec![AccessPoint { position: [0.1, 0.3] }],
//! #     robot: vec![robot(0.1, 0.1), robot(0.25, 0.2), robot(0.1, 0.5)],
//! #     task: vec![Task::at([0.9, 0.3])],
//! # })?;
//! use pleach::automaton::network::record::Outcome;
//! use pleach::summary::Summary;
//!
//! let mut summary = Summary::new(&scenario);
//! let completed = pleach::mission::run(&scenario, &mut [&mut summary])?;
//!
//! assert_eq!(completed.end.outcome, Outcome::Serviced);
//! assert_eq!(summary.recruits(), 1); // one relay between the access point and the leader
//!
//! // The monitor has checked every instant of the mission against the properties in `verify`.
//! let closest = completed.extremes.pair_distance.ok_or("there are three robots")?;
//! assert!(closest.value >= 2.0 * 0.01); // 2ρ, where ρ is l/40 by default
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The README has a custom watcher of a few lines. A custom medium, for example one that delays
//! messages within a control period, goes into the network that [`mission::run_network`] runs; for
//! one that loses messages there is [`mission::run_network_with_faults`].
//!
//! # An automaton
//!
//! The discrete behaviour of a robot is a few automata over its state. They are values too: the
//! tables that are run can also be queried and drawn.
//!
//! ```
//! use pleach::automaton::{diagram, network::duty_automaton};
//! use pleach::discrete::network::{Activity, DutyEvent};
//!
//! let automaton = duty_automaton()?;
//! let duties = automaton.table();
//! assert_eq!(duties.next(Activity::Standby, DutyEvent::Elected), Ok(Activity::Leading));
//! // A leaf services a task: it leaves only when another robot has taken its place.
//! assert!(duties.next(Activity::Leaf, DutyEvent::Retired).is_err());
//! assert!(diagram::mermaid(&automaton).starts_with("stateDiagram-v2"));
//! # Ok::<(), pleach::automaton::BuildError>(())
//! ```
//!
//! # Where to read on
//!
//! | layer | holds |
//! | --- | --- |
//! | [`guards`] | predicates over states with a signed margin |
//! | [`discrete`] | locations, events, tables; [of the network](discrete::network): roles, elections, posts, agreements |
//! | [`continuous`] | [flows](continuous::flow), [geometry](continuous::geometry); [of the network](continuous::network): links, routing, motion, certified acceptance |
//! | [`automaton`] | automaton, composition, executor, trajectories, checks, diagrams; [the network](automaton::network): robots, medium, composition |
//! | [`verify`] | [temporal logic](verify::temporal) over trajectories; [the properties of the network](verify::network), each stated once, and their monitor; [reachability](verify::reach) of any automaton |
//! | this crate | [scenario files](scenario_file), [missions](mission), [traces](trace), [summaries](summary), [stories](story), [figures], [pages](page); models and questions of [SpaceEx](spaceex) |
//!
//! `docs/model.md` in the repository leads from each equation and algorithm of the paper to the item
//! that implements it.

#![cfg_attr(test, allow(clippy::unwrap_used))] // a test that panics has failed

// The command line speaks of this library by its name, as other programs do.
#[cfg(feature = "cli")]
extern crate self as pleach;

/// The command line, for this program and for that of the package for real processes, which adds
/// commands to it. It is no library to build on.
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
pub mod figures;
#[cfg(feature = "cli")]
pub mod import;
pub mod judge;
pub mod mission;
pub mod page;
#[cfg(feature = "pdf")]
pub mod pdf;
pub mod prelude;
#[cfg(feature = "mcap")]
pub mod recording;
pub mod scenario_file;
#[cfg(feature = "cli")]
pub mod spaceex;
pub mod starts;
pub mod story;
pub mod summary;
#[cfg(feature = "cli")]
pub mod task_list;
pub mod trace;

pub use pleach_automaton as automaton;
pub use pleach_continuous as continuous;
pub use pleach_discrete as discrete;
pub use pleach_guards as guards;
pub use pleach_verify as verify;

/// The example of the README compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The example of the page on reachability compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../docs/reachability.md")]
struct Reachability;

/// The examples of the how-tos compile and run.
#[cfg(doctest)]
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
