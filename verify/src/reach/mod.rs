//! Reachability: every state that an automaton can come to, enclosed.
//!
//! A simulator follows one run; here all runs are followed at once, from sets of initial states, with
//! inputs that are only known to lie in intervals, and with every rounding error. [`verify()`] asks
//! whether any of them comes to [forbidden states](Forbidden), and has one of three [answers](Answer):
//! it holds, which is a proof; a run violates it; or it is undecided.
//!
//! A [`Model`] is made from an automaton whose flows, guards and resets are formulas. [`explore()`]
//! encloses its runs: affine flows by [support functions](affine), others by [Taylor models](taylor),
//! and where guards may hold by [polytopes](Polytope) in template directions that are cut, mapped and put
//! together. [`falsify()`] searches for a run that comes to forbidden states, and [`verify_formula()`] asks
//! formulas over time of all runs. [`confirm()`] says whether what checks have found comes up. `docs/reachability.md`
//! says what is guaranteed, and where not.
//!
//! Some names, such as [`Settings`], [`Jump`] and [`Mode`], occur in other modules too: import the module,
//! `use pleach::verify::reach;`, rather than all of its names.

pub mod affine;
mod confirm;
mod containment;
#[cfg(test)]
mod exact;
mod explore;
mod exponential;
mod falsify;
mod flow;
mod model;
mod polytope;
mod question;
mod region;
pub mod rounding;
mod search;
mod series;
mod set;
mod settings;
mod signal;
pub mod sparse;
pub mod taylor;
mod taylor_model;
mod temporal;
mod vector;
mod zonotope;

pub use affine::AffineFlow;
pub use confirm::{Confirmed, Reachability, confirm};
pub use containment::Escape;
pub use explore::{Completion, Enclosure, Segment, Visit, explore};
pub use exponential::exponential;
pub use falsify::{Counterexample, falsify};
pub use model::{Assignments, Dynamics, Jump, Mode, Model, ModelError, Uncertain};
pub use polytope::{Bound, Polytope, Template};
pub use question::{Answer, Doubt, Forbidden, Proof, ReachError, prove, verify};
pub use region::{Conjunction, HalfSpace, Region, RegionError};
pub use rounding::sum_up;
pub use search::{Effort, Run, Starts, runs};
pub use set::StateSet;
pub use settings::{Directions, InvalidSetting, Settings};
pub use sparse::{Along, InvalidEntry, Span, SparseFlow};
pub use temporal::{RobustnessProof, TemporalAnswer, Violation, prove_formula, verify_formula};
pub use vector::{IntervalMatrix, dot, dot_numbers};
pub use zonotope::Zonotope;
