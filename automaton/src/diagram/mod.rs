//! Pictures and tables of an automaton, written from the automaton itself.
//!
//! | function | gives | for |
//! | --- | --- | --- |
//! | [`mermaid`] | a Mermaid state diagram | Markdown pages |
//! | [`dot`] | a graph in the DOT language | Graphviz |
//! | [`svg`] | a picture, one column a location and one row an event | everything else |
//! | [`table`] | the location × event table, with the guards and resets of the events | Markdown pages |
//!
//! A transition shows `event [guard] / reset`, then its urgency and priority; a location shows its
//! name, its flow, and its invariant after the word "while".

mod dot;
mod label;
mod mermaid;
mod svg;
mod table;

pub use dot::dot;
pub use mermaid::mermaid;
pub use svg::svg;
pub use table::table;
