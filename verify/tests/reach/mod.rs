//! Enclosures of all runs.

mod answers;
mod confirmed;
mod exact;
mod oracle;
mod robot;
mod runs;
mod support;
mod temporal;
