//! Signal temporal logic: formulas over whole trajectories, with verdict, margin and witness.
//!
//! A predicate says whether a state is good. A [`Formula`] says whether a trajectory is: *always*
//! within 5 s, *eventually* between 2 s and 3 s, one thing *until* another (Maler and Nickovic
//! 2004, [doi:10.1007/978-3-540-30206-3_12](https://doi.org/10.1007/978-3-540-30206-3_12)).
//! [`Formula::judge`] tells how robustly it does, and which instant decides.
//!
//! ```
//! use pleach_guards::variable;
//! use pleach_verify::temporal::{Status, eventually, within};
//!
//! // A ball falls, and at 1 s it bounces.
//! let flight = [
//!     (0.0, [("height", 4.0), ("velocity", -1.0)]),
//!     (1.0, [("height", 0.0), ("velocity", -8.0)]),
//!     (1.0, [("height", 0.0), ("velocity", 6.0)]),
//!     (2.0, [("height", 3.0), ("velocity", 1.0)]),
//! ];
//! let bounces = eventually(within(0.0, 2.0)?, variable("velocity").at_least(5.0));
//!
//! let judgement = bounces.judge(&flight)?;
//! assert_eq!(judgement.status, Status::Satisfied);
//! assert_eq!(
//!     judgement.to_string(),
//!     "satisfied, robustness 1: at (1 s, 1) the margin of `velocity ≥ 5` is 1",
//! );
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Semantics
//!
//! A trajectory x has a state at every instant τ = (t, j) of its domain in hybrid time. With the
//! margin of a comparison as in [`pleach_guards`], the robustness ρ of a formula at τ is
//!
//! | formula | robustness at τ = (t, j) |
//! |---|---|
//! | a comparison | its margin in the state at τ |
//! | ¬φ | −ρ(φ) |
//! | φ ∧ ψ, φ ∨ ψ | the smaller, the larger of ρ(φ) and ρ(ψ) |
//! | φ → ψ | that of ¬φ ∨ ψ |
//! | □\[a, b\] φ | the infimum of ρ(φ) over the window |
//! | ◇\[a, b\] φ | the supremum of ρ(φ) over the window |
//! | φ 𝒰\[a, b\] ψ | the supremum over the window of ρ(ψ), with ρ(φ) until then |
//!
//! where the window holds the instants τ′ = (t′, j′) ≥ τ with t + a ≤ t′ ≤ t + b, and *until*
//! takes, for each of them, the smaller of ρ(ψ) there and the infimum of ρ(φ) from τ until just
//! before it (Donzé and Maler 2010,
//! [doi:10.1007/978-3-642-15297-9_9](https://doi.org/10.1007/978-3-642-15297-9_9)). What is before
//! a jump and what is after it both count, and windows hold their ends: `always` sees the state
//! before a jump at the very end of the window, and also the one after it.
//!
//! Positive robustness means satisfied and negative robustness violated. Robustness 0 alone does
//! not tell; then the formula is evaluated once more on the truth of the comparisons, where
//! strictness decides. Times that differ by no more than the rounding of sums of bounds count as
//! the same time.
//!
//! # The end of the trajectory
//!
//! A trajectory is a beginning of something: after the time of its last sample every comparison
//! may have any margin from −∞ to ∞. (At that time itself, no more jumps are expected.)
//! Robustness is therefore an interval, with one end for the worst and one for the best that can
//! follow (Deshmukh and others 2017,
//! [doi:10.1007/s10703-017-0286-7](https://doi.org/10.1007/s10703-017-0286-7)). If all of it is
//! on one side, the formula is settled; otherwise it is [`Status::Inconclusive`]. So □ without
//! bounds can be violated but never satisfied, and of a trajectory that is too short nothing is
//! claimed. [`Formula::horizon`] tells how long is long enough.
//!
//! On a trajectory of a model it may also be beyond rounding whether a comparison holds: it is then
//! taken for true and for false, and where these differ, the judgement is [`Status::Undecided`].
//!
//! # Cost
//!
//! Every operator takes time linear in the number of pieces of its operands, and returns a few
//! times as many (Donzé, Ferrère and Maler 2013,
//! [doi:10.1007/978-3-642-39799-8_19](https://doi.org/10.1007/978-3-642-39799-8_19)).

mod formula;
mod judgement;
mod pointwise;
mod print;
mod samples;
mod signal;
mod sliding;
mod until;

pub use formula::{Formula, InvalidWindow, Window, always, eventually, not, within};
pub use judgement::{Doubt, Judgement, Robustness, Status, Witness};
pub use samples::{Samples, TemporalError};
