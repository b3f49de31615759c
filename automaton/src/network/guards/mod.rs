//! The guards of the robot network, over quantities and propositions that a robot measures of
//! itself.
//!
//! Real quantities have margins in their unit; propositions are true or false. The guards of one
//! activity or phase exclude one another or are ordered by its table.

pub(super) mod attachment;
pub(super) mod attendance;
pub(super) mod control;
pub(super) mod duty;
pub(super) mod exchange;
pub(super) mod mission;
pub(super) mod service;
pub(super) mod target;
