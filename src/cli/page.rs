//! `pleach page`.

use super::arguments::PageArguments;
use super::output;
use super::source::{self, STANDARD};
use super::status::{Failure, Status};
use pleach::page::{self, PageError};
use std::path::{Path, PathBuf};

/// Makes the page of a trace.
pub(super) fn write(arguments: &PageArguments) -> Result<Status, Failure> {
    let path = &arguments.trace;
    let place = arguments.output.clone().unwrap_or_else(|| beside(path));
    output::check_places([path], [&place])?;
    let page = source::open(path).map_err(PageError::Unreadable).and_then(page::of_trace);
    let page =
        page.map_err(|error| Failure::Trace { path: path.clone(), error: Box::new(error) })?;
    output::write(&place, &page)?;
    if !source::is_standard(&place) {
        output::say(&format!("page: open {}\n", place.display()))?;
    }
    Ok(Status::Done)
}

/// Where the page of a trace goes by itself: that of the standard input to the standard output.
fn beside(trace: &Path) -> PathBuf {
    match source::is_standard(trace) {
        true => STANDARD.into(),
        false => trace.with_extension("html"),
    }
}
