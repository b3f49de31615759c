//! Enclosures of all runs.

mod answers;
mod composed;
mod confirmed;
mod exact;
mod oracle;
mod robot;
mod rounding;
mod runs;
mod support;
mod temporal;
