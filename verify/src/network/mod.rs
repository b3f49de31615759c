//! The properties of the robot network, each stated once, and the monitor that runs them.
//!
//! A mission is a sequence of snapshots, one a control period; between two of them every robot
//! moves on a straight segment at constant speed. A [`Property`] speaks of every instant of
//! that motion: what is measured is the minimum or maximum over the segment in closed form,
//! never a sample.
//!
//! Three layers, each using the one before:
//!
//! 1. pure functions that state the properties: over identities only, in [`tree`], [`team`],
//!    [`election`] and [`duty`] (small slices, bounded loops, no allocation, so that a model
//!    checker runs the same code); over places and flows, in [`motion`] and [`link`];
//! 2. checks that apply them to what observers record and name the offenders: [`instant`] for
//!    one snapshot, [`period`] for two;
//! 3. the [`Monitor`] that runs every check over a mission, and the [`Judge`], which holds events
//!    and what observers conclude against the definitions as well: over a run, and over a trace.
//!
//! [`cell`] asks the same of all proposals and errors at once, by reachability.
//!
//! The [`Limits`] come from the scenario; the only numerical slack is [`SLACK`].
//!
//! A robot that stands alone in a square and sends to an access point, and then leaps:
//!
//! ```
//! use nalgebra::point;
//! use pleach_automaton::network::record::{Route, Snapshot};
//! use pleach_automaton::network::scenario::{
//!     AccessPoint, Agenda, Control, LinkRanges, RobotStart, Scenario, ValidScenario, WorkspaceOutline,
//! };
//! use pleach_discrete::network::{Phase, Role};
//! use pleach_verify::network::{Monitor, Property};
//!
//! let scenario = ValidScenario::new(Scenario {
//!     name: "alone".to_owned(),
//!     description: None,
//!     workspace: WorkspaceOutline {
//!         boundary: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
//!         holes: Vec::new(),
//!     },
//!     link: LinkRanges::new(0.4, 0.5),
//!     control: Control::default(),
//!     mission: Agenda::default(),
//!     access_point: vec![AccessPoint { position: [0.5, 0.2] }],
//!     robot: vec![RobotStart::at([0.5, 0.5], 0.075)],
//!     task: Vec::new(),
//! })?;
//! let mut snapshot = Snapshot {
//!     step: 0,
//!     time: 0.0,
//!     positions: vec![point![0.5, 0.5]],
//!     roles: vec![Role::Redundant],
//!     phase: Phase::Idle,
//!     active: vec![0],
//!     active_team: Vec::new(),
//!     primary_team: Vec::new(),
//!     path: Vec::new(),
//!     residuals: vec![0.025],
//!     multipliers: vec![0.0],
//!     routes: vec![Route { from: 0, to: 1, share: 0.1, reliability: 1.0 }],
//!     tree: vec![(0, 1)],
//!     task: None,
//!     serviced: Vec::new(),
//!     closed: Vec::new(),
//!     posts: Vec::new(),
//!     robots: Vec::new(),
//!     absent: Vec::new(),
//!     fleets: Vec::new(),
//! };
//! let any_role_change = |_, _| true;
//! let mut monitor = Monitor::new(&scenario, any_role_change);
//! monitor.observe(&snapshot)?;
//! assert_eq!(monitor.extremes().clearance.as_ref().map(|extreme| extreme.value), Some(0.5));
//!
//! (snapshot.step, snapshot.time) = (1, 1.0);
//! snapshot.positions[0].x = 0.52; // the trust region is a tenth of u − l: 0.01
//! let violation = monitor.observe(&snapshot).unwrap_err();
//! assert_eq!(violation.property, Property::StepLength);
//! println!("{violation}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod cell;
pub mod duty;
pub mod election;
pub mod instant;
pub mod judge;
pub mod link;
pub mod motion;
pub mod period;
mod separation;
pub mod storm;
pub mod team;
pub mod tree;

mod bound;
mod extremes;
mod limits;
mod monitor;
#[cfg(any(kani, test))]
mod proofs;
mod property;
#[cfg(test)]
mod sample;
#[cfg(test)]
mod tests;
mod violation;

pub use bound::Spans;
pub use extremes::{Extreme, Extremes, TreeLinks};
pub use judge::{Judge, JudgeOfFleets, Referee, Safety, judged_faults};
pub use limits::{Limits, SLACK};
pub use monitor::{Monitor, RoleTable, audit};
pub use property::Property;
pub use violation::{Instant, Violation};
