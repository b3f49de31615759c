//! What the shell and `man` know of the program, made from its arguments.

use super::arguments::Arguments;
use super::output;
use super::status::{Failure, Status};
use clap::CommandFactory;
use clap_complete::Shell;
use std::path::Path;

/// Prints the completions for a shell.
pub(super) fn print_completions(shell: Shell) -> Result<Status, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "pleach", &mut script);
    output::say(&String::from_utf8_lossy(&script))?;
    Ok(Status::Done)
}

/// Prints the manual page of the program, or writes those of all commands into a folder.
pub(super) fn write_manual(folder: Option<&Path>) -> Result<Status, Failure> {
    match folder {
        None => {
            let mut page = Vec::new();
            clap_mangen::Man::new(Arguments::command()).render(&mut page)?;
            output::say(&String::from_utf8_lossy(&page))?;
        }
        Some(folder) => {
            output::create_folder(folder)?;
            let failed = |source| Failure::Creation { path: folder.to_owned(), source };
            clap_mangen::generate_to(Arguments::command(), folder).map_err(failed)?;
        }
    }
    Ok(Status::Done)
}
