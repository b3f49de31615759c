//! Enclosures of all runs.

mod answers;
mod exact;
mod oracle;
mod runs;
mod support;
