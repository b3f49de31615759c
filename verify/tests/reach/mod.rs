//! Enclosures of all runs.

mod answers;
mod exact;
mod oracle;
mod robot;
mod runs;
mod support;
mod temporal;
