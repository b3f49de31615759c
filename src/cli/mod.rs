//! The command line: what it understands, and what it does.

#![warn(clippy::print_stdout, clippy::print_stderr)] // they panic when the stream is closed: see `output`

mod arguments;
mod batch;
mod check;
mod diagram;
#[cfg(feature = "mcap")]
mod export;
pub mod faults;
mod import;
pub mod interrupt;
pub mod job;
mod judge;
mod manual;
pub mod output;
mod page;
pub mod plan;
pub mod progress;
mod reach;
mod record;
mod remarks;
pub mod run;
mod source;
pub mod status;
mod sweep;
mod table;
mod terminal;

pub use arguments::{Arguments, Command};

use status::{Failure, Status};
use std::process::ExitCode;

/// Carries out a command. Errors are printed to the error output.
pub fn carry_out(command: Command) -> ExitCode {
    let result = match command {
        Command::Run(run) => run::run(&run),
        Command::Check(check) => check::check(&check),
        Command::Import(import) => import::import(&import),
        #[cfg(feature = "mcap")]
        Command::Export { trace, recording } => export::export(&trace, &recording),
        #[cfg(not(feature = "mcap"))]
        Command::Export { .. } => Err(Failure::Without { what: "export", feature: "mcap" }),
        Command::Judge(judge) => judge::run(&judge),
        Command::Diagram(diagram) => diagram::print(&diagram),
        Command::Completions { shell } => manual::print_completions(shell),
        Command::Man { folder } => manual::write_manual(folder.as_deref()),
        Command::Page(page) => page::write(&page),
        Command::Reach(reach) => reach::reach(&reach),
    };
    exit(result)
}

/// The exit status of a command whose errors are printed here.
pub fn exit(result: Result<Status, Failure>) -> ExitCode {
    let status = result.unwrap_or_else(|failure| {
        output::tell(format_args!("error: {failure}"));
        failure.status()
    });
    status.into()
}
