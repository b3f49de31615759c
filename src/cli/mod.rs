//! The command line: what it understands, and what it does.

mod arguments;
mod diagram;
mod judge;
mod page;
mod progress;
mod run;
mod status;

pub use arguments::Arguments;

use arguments::Command;
use std::process::ExitCode;

/// Does what the arguments ask for. What went wrong stands on the error output.
pub fn carry_out(arguments: Arguments) -> ExitCode {
    let result = match arguments.command {
        Command::Run(run) => run::run(&run),
        Command::Judge(judge) => judge::run(&judge),
        Command::Diagram(diagram) => diagram::print(&diagram),
        Command::Page(page) => page::write(&page),
    };
    let status = result.unwrap_or_else(|failure| {
        eprintln!("error: {failure}");
        failure.status()
    });
    status.into()
}
