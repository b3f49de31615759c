//! Pictures and tables of an automaton, written from the automaton itself, and plots of what it
//! went through.
//!
//! | function | gives | for |
//! | --- | --- | --- |
//! | [`mermaid`] | a Mermaid state diagram | Markdown pages |
//! | [`dot`] | a graph in the DOT language | Graphviz |
//! | [`svg`] | a picture: boxes and arcs, or for larger models and superstates columns and rows | everything else |
//! | [`table`] | the location × event table, with the guards, resets, flows and invariants | Markdown pages |
//! | [`latex`] | the formal definition H = (Q, X, Init, f, Inv, E, G, R) | papers |
//! | [`composition_mermaid`], [`composition_svg`] | the components side by side and what joins them | compositions |
//! | [`overview_svg`] | boxes that stand for several locations, and how many transitions lead between them | large models |
//! | [`coverage_svg`] | the picture, with what runs have left out in red | [coverage](crate::coverage) |
//! | [`plot`] | variables and locations over time | [trajectories](crate::trajectory) |
//! | [`phase_portrait`] | one variable over another | trajectories |
//! | [`FlowpipePicture`] | sets of states in the plane of two quantities | what is reached |
//! | [`outcome`] | how a run went, in a line | trajectories |
//!
//! A transition shows `event [guard] / reset`, then its urgency and priority; a location shows its
//! name, its flow, and its invariant after the word "while".
//!
//! ```
//! use pleach_automaton::{coordinates, diagram, from, Automaton};
//! use pleach_discrete::vocabulary;
//!
//! vocabulary! {
//!     enum Motion: Location { Falling = "falling" }
//!     enum Contact: Event { Bounce = "bounce" }
//! }
//! coordinates! { struct Ball { height = "h", velocity = "v" } }
//! let Ball { height, velocity } = Ball::coordinates();
//! let ball = Automaton::starting_in(Motion::Falling)
//!     .initially(Ball { height: 10.0, velocity: 0.0 })
//!     .flow(Motion::Falling, [height.rate(&velocity), velocity.rate(-9.81)])
//!     .invariant(Motion::Falling, height.at_least(0.0))
//!     .transition(
//!         from(Motion::Falling)
//!             .on(Contact::Bounce)
//!             .to(Motion::Falling)
//!             .must(height.at_most(0.0) & velocity.less_than(0.0))
//!             .then([velocity.becomes(-0.8 * &velocity)]),
//!     )
//!     .build()?;
//!
//! assert_eq!(
//!     diagram::mermaid(&ball),
//!     "\
//! stateDiagram-v2
//!     l0 : falling
//!     l0 : ḣ = v
//!     l0 : v̇ = −9.81
//!     l0 : while h ≥ 0
//!     [*] --> l0
//!     l0 --> l0 : bounce [h ≤ 0 ∧ v #60; 0] / v #58;= −0.8 · v (must, 0)
//! "
//! );
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod dot;
mod latex;
mod mermaid;
mod plot;
pub(crate) mod sketch;
mod svg;
mod table;

pub use dot::dot;
pub use latex::latex;
pub use mermaid::{composition_mermaid, mermaid};
pub use plot::{FlowpipePicture, Patch, UnknownVariable, outcome, phase_portrait, plot};
pub use svg::{composition_svg, coverage_svg, overview_svg, svg};
pub use table::table;
