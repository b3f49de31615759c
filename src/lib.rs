//! Hybrid automata as typed Rust values, and a distributed robot network written with them.

pub mod mission;
pub mod scenario_file;
pub mod story;
pub mod summary;
pub mod trace;

pub use pleach_automaton as automaton;
pub use pleach_continuous as continuous;
pub use pleach_discrete as discrete;
pub use pleach_guards as guards;
pub use pleach_verify as verify;

pub mod figures;
