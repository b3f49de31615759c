//! `pleach page`.

use super::arguments::PageArguments;
use super::status::{Failure, Status};
use pleach::page::{self, PageError};
use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

/// Makes the page of a trace.
pub fn write(arguments: &PageArguments) -> Result<Status, Failure> {
    let path = &arguments.trace;
    let unreadable =
        |error: PageError| Failure::Trace { path: path.clone(), error: Box::new(error) };
    let file = File::open(path).map_err(|error| unreadable(PageError::Unreadable(error)))?;
    let page = page::of_trace(BufReader::new(file)).map_err(unreadable)?;
    let output = arguments.output.clone().unwrap_or_else(|| path.with_extension("html"));
    fs::write(&output, page)
        .map_err(|source| Failure::Creation { path: output.clone(), source })?;
    println!("{}", shown(&output));
    Ok(Status::Done)
}

fn shown(path: &Path) -> String {
    format!("page: open {}", path.display())
}
