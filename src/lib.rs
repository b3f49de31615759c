//! Hybrid automata as typed Rust values, and a distributed robot network written with them.
//!
//! A hybrid automaton jumps between locations and flows within them. Here its parts are values:
//! locations and events are enums, the jumps are rows of a
//! [`TransitionTable`](discrete::TransitionTable), guards are [predicates](guards::Predicate) that
//! can be evaluated, printed and searched, resets and flows are named functions. An
//! [`Automaton`](automaton::Automaton) puts them together and refuses parts that do not fit; one
//! [`Executor`](automaton::Executor) runs compositions of them through hybrid time;
//! [`diagram`](automaton::diagram) draws them.
//!
//! The model that comes with the framework is the robot network of *Global Planning for Multi-Robot
//! Communication Networks in Complex Environments*: robots that grow trees of relays from access
//! points to tasks, each of them an automaton that decides from its own state and from what it
//! hears. This page runs a mission of it.
//!
//! # A mission
//!
//! A [`Scenario`](automaton::network::scenario::Scenario) is plain data: read from a file by
//! [`scenario_file::read`], or built. Here is a room of 1.2 by 0.6 with an access point at the left
//! and a task at the right, farther away than one link carries.
//!
//! ```
//! use pleach::automaton::network::scenario::{
//!     AccessPoint, Control, LinkRanges, RobotStart, Scenario, Task, WorkspaceOutline,
//! };
//!
//! let robot = |x, y| RobotStart { position: [x, y], rate: 0.075 };
//! let scenario = Scenario {
//!     name: "room".into(),
//!     description: None,
//!     workspace: WorkspaceOutline {
//!         boundary: vec![[0.0, 0.0], [1.2, 0.0], [1.2, 0.6], [0.0, 0.6]],
//!         holes: vec![],
//!     },
//!     link: LinkRanges { full_range: 0.4, max_range: 0.5 },
//!     control: Control::default(),
//!     access_point: vec![AccessPoint { position: [0.1, 0.3] }],
//!     robot: vec![robot(0.1, 0.1), robot(0.25, 0.2), robot(0.1, 0.5)],
//!     task: vec![Task { position: [0.9, 0.3] }],
//! };
//! assert_eq!(scenario.validate(), Ok(()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`mission::run`] runs it to its end. Whoever wants to see more than the end hands over
//! [`Watcher`](mission::Watcher)s; the [`Summary`](summary::Summary) that the program prints is one.
//!
//! ```
//! # use pleach::automaton::network::scenario::{
//! #     AccessPoint, Control, LinkRanges, RobotStart, Scenario, Task, WorkspaceOutline,
//! # };
//! # let robot = |x, y| RobotStart { position: [x, y], rate: 0.075 };
//! # let scenario = Scenario {
//! #     name: "room".into(),
//! #     description: None,
//! #     workspace: WorkspaceOutline {
//! #         boundary: vec![[0.0, 0.0], [1.2, 0.0], [1.2, 0.6], [0.0, 0.6]],
//! #         holes: vec![],
//! #     },
//! #     link: LinkRanges { full_range: 0.4, max_range: 0.5 },
//! #     control: Control::default(),
//! #     access_point: vec![AccessPoint { position: [0.1, 0.3] }],
//! #     robot: vec![robot(0.1, 0.1), robot(0.25, 0.2), robot(0.1, 0.5)],
//! #     task: vec![Task { position: [0.9, 0.3] }],
//! # };
//! use pleach::automaton::network::record::Outcome;
//! use pleach::summary::Summary;
//!
//! let mut summary = Summary::new(&scenario);
//! let completed = pleach::mission::run(&scenario, &mut [&mut summary])?;
//!
//! assert_eq!(completed.end.outcome, Outcome::Serviced);
//! assert_eq!(summary.recruits(), 1); // one relay between the access point and the leader
//!
//! // The monitor has held every instant of the mission against the properties in `verify`.
//! let closest = completed.extremes.pair_distance.ok_or("there are three robots")?;
//! assert!(closest.value >= 2.0 * 0.01); // 2ρ, where ρ is l/40 by default
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A watcher of one's own is a few lines: see the README. A medium of one's own, that loses
//! messages for example, goes into [`mission::run_network`].
//!
//! # An automaton
//!
//! The discrete behaviour of a robot is two automata over its state. They are values too: the same
//! tables that run can be asked and drawn.
//!
//! ```
//! use pleach::automaton::{diagram, network::role_automaton};
//! use pleach::discrete::network::{Role, RoleEvent};
//!
//! let automaton = role_automaton()?;
//! assert_eq!(automaton.table().next(Role::Node, RoleEvent::Elected), Ok(Role::Leader));
//! // A leaf services a task: it goes only where another robot has come in its place, or to lead.
//! assert!(automaton.table().next(Role::Leaf, RoleEvent::Retired).is_err());
//! assert!(diagram::mermaid(&automaton).starts_with("stateDiagram-v2"));
//! # Ok::<(), pleach::automaton::BuildError>(())
//! ```
//!
//! How to build one is shown with [`Automaton`](automaton::Automaton), how to run one with the
//! [executor](automaton::executor).
//!
//! # Where to read on
//!
//! | layer | holds |
//! | --- | --- |
//! | [`guards`] | predicates over states with a signed margin |
//! | [`discrete`] | locations, events, tables; [of the network](discrete::network): roles, elections, posts, agreements |
//! | [`continuous`] | [geometry](continuous::geometry); [of the network](continuous::network): links, routing, motion, certified acceptance |
//! | [`automaton`] | automaton, executor, diagrams; [the network](automaton::network): robots, medium, composition |
//! | [`verify`] | [the properties of the network](verify::network), each stated once, and their monitor |
//! | this crate | [scenario files](scenario_file), [missions](mission), [traces](trace), [summaries](summary), [stories](story), [figures] |
//!
//! `docs/model.md` of the repository leads from each equation and algorithm of the paper to the item
//! that holds it.

pub mod figures;
pub mod mission;
pub mod prelude;
pub mod scenario_file;
pub mod story;
pub mod summary;
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
