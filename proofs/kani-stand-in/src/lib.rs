//! A stand-in for the `kani` library: the same harness, run on concrete values.
//!
//! Kani proves a harness for all values that it draws. Its toolchain is not at hand everywhere;
//! with this library the body of a harness is an ordinary test on the stable toolchain:
//!
//! - where the draws are few, **every** combination of them is run, by backtracking: the last
//!   draw takes its next value until it has no more, then the one before it;
//! - otherwise, or once [`MOST_CASES`] combinations have been run, [`RANDOM_CASES`] cases are drawn
//!   by a seeded generator that prefers small and extreme numbers;
//! - [`assume`] drops a case, and a failed assertion names the harness and the drawn values;
//! - a harness fails if a [`cover!`] of its body is never satisfied: it would hold vacuously;
//! - it fails if `proofs/harnesses.toml` has other numbers of its cases and values.
//!
//! Under the real tool this library is not built: packages depend on it for their tests only, and
//! `proofs/check types` hands it to the compiler to type-check harnesses as the tool sees them.
//!
//! ```
//! kani::run("small numbers have small squares", 1, || {
//!     let number: u8 = kani::any_where(|number| *number < 10);
//!     kani::cover!(number == 9);
//!     assert!(number * number <= 81);
//! });
//! ```

mod case;
mod dice;
mod draw;
mod run;

pub use draw::{Arbitrary, any, any_where};
pub use kani_stand_in_macros::{proof, solver, unwind};
pub use run::{MOST_CASES, RANDOM_CASES, run};

/// Drops the present case unless the condition holds.
pub fn assume(condition: bool) {
    if !condition {
        case::reject();
    }
}

/// States that some case satisfies a condition, so that a harness says something.
#[macro_export]
macro_rules! cover {
    () => {
        $crate::cover!(true)
    };
    ($condition:expr $(, $message:literal)? $(,)?) => {
        $crate::note_cover($condition, (file!(), line!(), column!()))
    };
}

/// What [`cover!`] expands to.
#[doc(hidden)]
pub fn note_cover(condition: bool, place: (&'static str, u32, u32)) {
    if condition {
        case::with(|case| case.covered.insert(place));
    }
}
