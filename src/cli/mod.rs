//! The command line: what it understands, and what it does.

mod arguments;
mod batch;
mod check;
mod diagram;
#[cfg(feature = "mcap")]
mod export;
mod import;
mod interrupt;
mod job;
mod judge;
mod manual;
mod output;
mod page;
mod plan;
mod progress;
mod reach;
mod record;
mod run;
mod source;
mod status;
mod sweep;
mod table;
mod terminal;

pub use arguments::Arguments;

use arguments::Command;
use std::process::ExitCode;

/// Does what the arguments ask for. What went wrong stands on the error output.
pub fn carry_out(arguments: Arguments) -> ExitCode {
    let result = match arguments.command {
        Command::Run(run) => run::run(&run),
        Command::Check(check) => check::check(&check),
        Command::Import(import) => import::import(&import),
        #[cfg(feature = "mcap")]
        Command::Export { trace, recording } => export::export(&trace, &recording),
        Command::Judge(judge) => judge::run(&judge),
        Command::Diagram(diagram) => diagram::print(&diagram),
        Command::Completions { shell } => manual::print_completions(shell),
        Command::Man { folder } => manual::write_manual(folder.as_deref()),
        Command::Page(page) => page::write(&page),
        Command::Reach(reach) => reach::reach(&reach),
    };
    let status = result.unwrap_or_else(|failure| {
        output::tell(format_args!("error: {failure}"));
        failure.status()
    });
    status.into()
}
