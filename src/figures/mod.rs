//! Figures of a mission, as SVG in the visual language of Figs. 8 to 15 of the paper.
//!
//! An [`Album`] watches a mission. Every control period it takes a snapshot; the telling ones
//! (the start, each election, stationary point, release, arrival of a recruit, serviced task, and
//! the end) become pictures, and the others extend the curves of Figs. 11 to 13: smallest
//! distances, residuals, multipliers. At the end it writes one file per figure, an animation and the
//! [page](crate::page) on which the mission plays. A single instant is drawn by [`Plan::render`].
//!
//! | what | looks like |
//! | --- | --- |
//! | communication link | green, thickness ∝ T·R |
//! | edge of the tree | red on its link, thickness ∝ T·R |
//! | node | the mark of its role, with its number |
//! | member of the active team | a ring around the mark |
//! | task | blue cross; in a ring when serviced, faint until announced |
//! | disc of radius ρ | to scale around the mark, where it is large enough to be seen |
//!
//! Equal missions give equal bytes.

mod album;
mod animation;
mod canvas;
mod curves;
mod labels;
mod lanes;
mod legend;
mod marks;
pub(crate) mod palette;
mod plan;
mod scene;
mod screen;
mod series;
mod spacing;
#[cfg(test)]
mod tests;

pub(crate) use marks::{Mark, TaskState};
pub(crate) use screen::{link_data, mark_data, moment_data};
pub(crate) use spacing::Walls;

pub use album::{ANIMATION, Album};
pub use canvas::quantity;
pub use plan::Plan;
pub use scene::Scene;
