//! Guards as data: predicates over named variables, each with a signed margin.
//!
//! A *guard* says when a transition of a hybrid automaton may be taken. Here it is a value and
//! not a closure, so that one and the same guard can be evaluated, printed in a diagram, searched
//! for the variables it reads, and analysed before anything runs.
//!
//! An [`Expression`] is arithmetic over variables, built with ordinary operators. Comparing two
//! expressions gives a [`Predicate`], and predicates combine by *and*, *or* and *not*:
//!
//! ```
//! use pleach_guards::{variable, Guard, Verdict};
//!
//! let close = variable("distance").at_most(variable("δ"));
//! let settled = variable("still").at_least(8.0);
//! let arrived = Guard::new("arrived", close.and(settled));
//!
//! assert_eq!(arrived.predicate().to_string(), "distance ≤ δ ∧ still ≥ 8");
//!
//! let state = [("distance", 0.25), ("δ", 0.75), ("still", 10.0)];
//! let verdict = arrived.evaluate(&state)?;
//! assert_eq!(verdict, Verdict { margin: 0.5, holds: true });
//! # Ok::<(), pleach_guards::EvaluationError>(())
//! ```
//!
//! # Margins
//!
//! Besides its truth value a predicate has a *margin*: how far the state is from changing the verdict,
//! in the unit of what is compared. The margin of a ≤ b is b − a; *and* takes the smallest margin,
//! *or* takes the largest, *not* reverses the sign. A positive margin means that the predicate holds, a
//! negative one that it does not; at margin 0 strictness decides. This is the robustness of
//! signal temporal logic for a single instant (Donzé and Maler 2010,
//! [doi:10.1007/978-3-642-15297-9_9](https://doi.org/10.1007/978-3-642-15297-9_9)); an executor
//! finds the instant of an event as a zero of the margin.
//!
//! # Text
//!
//! What is printed with mathematical or ASCII operators can be parsed again, and nothing is lost in
//! between. Named Rust functions are the exception: their text is no more than their name.
//!
//! ```
//! use pleach_guards::{Predicate, norm, variable};
//!
//! let inside: Predicate = "sqrt((x - 1)^2 + y^2) <= 2".parse()?;
//! assert_eq!(inside.to_string(), "√((x − 1)² + y²) ≤ 2");
//! assert_eq!(inside, norm([variable("x") - 1.0, variable("y")]).at_most(2.0));
//! assert_eq!(inside.to_latex(), r"\sqrt{\left(x - 1\right)^{2} + y^{2}} \le 2");
//! # Ok::<(), pleach_guards::ParseError>(())
//! ```
//!
//! With the feature `serde`, which is off by default, expressions, predicates and guards are
//! stored in files as this text.
//!
//! # Where data ends
//!
//! What no expression can say goes into a named function: [`Predicate::function`]. It is evaluated and combined like any other predicate, but what it
//! reads is unknown; [`Predicate::functions`] tells which of them an analysis cannot see into.
//!
//! # Analysis
//!
//! Guards as data can be asked for more than their value in one state: where in a box of states a predicate can
//! hold ([`Predicate::truth`]), which comparisons make it up ([`Predicate::disjunctive_form`]),
//! whether an expression is affine ([`Expression::linear_form`]), how it changes
//! ([`Expression::derivative`]), and what becomes of it when variables are replaced
//! ([`Expression::substitute`]).
//!
//! # Where things are
//!
//! [`Expression`], with its [tables](Table), and [`Predicate`] are the data, [`NamedFunction`] holds what is not data,
//! [`Valuation`] is what they are evaluated on, [`Guard`] gives a predicate its name, and [`Crossing`] follows
//! margins over time. [`mod@print`] writes all of it as Unicode text and LaTeX, [`parse`] reads
//! the text, and `serialization` (feature `serde`) takes it into files.
//!
//! Because guards are data, they can be analysed. [`range`] bounds expressions and decides
//! predicates over whole boxes of states by [`interval`] arithmetic; a [`LinearForm`] holds the
//! coefficients of an affine expression, [`Expression::derivative`] differentiates, a [`Substitution`] renames
//! variables and applies resets, and [`Predicate::disjunctive_form`] resolves negations and lists alternatives.
//! [`program`] compiles all of it for hot loops, and [`tape`] compiles lists of expressions together;
//! [`sides`] makes smooth expressions of those with kinks;
//! [`course`] follows predicates over time, with [`enclosure`]s of moving quantities.

#![warn(unreachable_pub)]

pub mod course;
mod crossing;
mod derivative;
pub mod enclosure;
mod expression;
mod fold;
mod function;
mod guard;
pub mod interval;
mod linear;
mod name;
mod normal_form;
mod operator;
pub mod parse;
mod predicate;
pub mod print;
pub mod program;
pub mod range;
mod ring;
#[cfg(feature = "serde")]
pub mod serialization;
pub mod sides;
mod substitution;
mod table;
pub mod tape;
mod valuation;

pub use course::{Affine, Course, Tracked, Tracker};
pub use crossing::{Crossing, Hysteresis, InvertedBand};
pub use enclosure::Enclosure;
pub use expression::{Choice, Expression, constant, maximum, minimum, norm, piecewise, variable};
pub use function::NamedFunction;
pub use guard::Guard;
pub use interval::{EmptyInterval, Interval};
pub use linear::{Coefficient, LinearForm};
pub use normal_form::NoDisjunctiveForm;
pub use operator::{BinaryOperator, UnaryOperator};
pub use parse::ParseError;
pub use predicate::{Comparison, Predicate, Relation, Verdict, always, never, not, proposition};
pub use program::{CompiledPredicate, Program};
pub use range::{Ranges, Truth};
pub use ring::Ring;
pub use sides::Sides;
pub use substitution::Substitution;
pub use table::{Interpolation, InvalidTable, Table};
pub use tape::Tape;
pub use valuation::{EvaluationError, Valuation};
