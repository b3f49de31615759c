//! The properties of the robot network, each stated once, and the monitor that runs them.
//!
//! A mission is a sequence of snapshots, one a control period; between two of them every robot
//! moves on a straight segment at constant speed. A [`Property`] speaks of every instant of
//! that motion: what is measured is the minimum or maximum over the segment in closed form,
//! never a sample.
//!
//! Three layers, each using the one before:
//!
//! 1. pure functions that state the properties: over identities only, in [`tree`], [`team`]
//!    and [`duty`] (small slices, bounded loops, no allocation, so that a model checker runs
//!    the same code); over places and flows, in [`motion`], [`separation`] and [`link`];
//! 2. checks that apply them to what observers record and name the offenders: [`instant`] for
//!    one snapshot, [`period`] for two;
//! 3. the [`Monitor`] that runs every check over a mission, and [`audit`] over a recorded one.
//!
//! The [`Limits`] come from the scenario; the only numerical slack is [`SLACK`].

pub mod duty;
pub mod instant;
pub mod link;
pub mod motion;
pub mod period;
pub mod separation;
pub mod team;
pub mod tree;

mod extremes;
mod limits;
mod monitor;
mod property;
#[cfg(test)]
mod sample;
#[cfg(test)]
mod tests;
mod violation;

pub use extremes::{Extreme, Extremes};
pub use limits::{LimitError, Limits, SLACK};
pub use monitor::{Monitor, RoleTable, SegmentClearance, audit};
pub use property::Property;
pub use violation::{Instant, Violation};
