//! The robots of a network as processes of their own, over [Zenoh](https://zenoh.io).
//!
//! A process does input and output only: what its nodes do is
//! [`Node::step`](pleach::automaton::node::Node::step), as in a simulation. The chapters follow a
//! packet on its way: [`packet`] says how it is written and what is refused, [`transport`] carries
//! it, [`lockstep`] says when all packets of a round have come, [`receiver`] which of its messages
//! reach a node, and [`local_nodes`] hands them to the nodes of a process. [`process`] is the loop around
//! them; [`strangers`] are those that it cannot meet. What observers read are [`report`]s; [`watch`]
//! makes snapshots of them, and [`launch`] starts all processes of a scenario on this machine.

#![cfg_attr(test, allow(clippy::unwrap_used))] // a test that panics has failed

pub mod arguments;
pub mod launch;
pub mod local_nodes;
pub mod lockstep;
pub mod memory;
pub mod packet;
pub mod process;
pub mod receiver;
pub mod repeats;
pub mod report;
pub mod strangers;
pub mod transport;
pub mod watch;

use arguments::ProcessCommand;
use pleach::cli::status::{Failure, Status};

/// Carries out a command.
///
/// # Errors
/// What keeps it from being carried out.
pub fn carry_out(command: ProcessCommand) -> Result<Status, Failure> {
    match command {
        ProcessCommand::Robot(robot) => process::run_robot(&robot),
        ProcessCommand::AccessPoint(access_point) => process::run_access_point(&access_point),
        ProcessCommand::Watch(watch) => watch::run(&watch),
        ProcessCommand::Launch(launch) => launch::run(&launch),
    }
}
