//! Pages on which a run plays.
//!
//! A page is one HTML file that needs no other and no network: the run as data, and scripts that
//! show it. [`TrajectoryPage`] makes the page of a run of any automaton or composition. With the
//! feature `network`, [`MissionPage`] makes that of a mission while it runs, and [`of_trace`] from
//! its trace.
//!
//! | file | what it does |
//! | --- | --- |
//! | `assets/frame.html` | what all pages begin and end with |
//! | `assets/page.html`, `assets/style.css` | the body, light and dark, narrow and on paper |
//! | `assets/tables.js` | reads the numbers |
//! | `assets/player.js`, `assets/transport.js` | where the run stands; play, pause, speed, the time line, keys |
//! | `assets/canvas.js` | drawing surfaces, axes, colours |
//! | `assets/plan.js`, `assets/marks.js` | the plan of a mission, its layers, marks and labels |
//! | `assets/curves.js`, `assets/strips.js` | numbers and locations over time |
//! | `assets/mission.js` | what is told of a mission, its robots and links |
//! | `assets/run.js` | what is told of a trajectory, and the drawings of its automata |

#[cfg(feature = "network")]
mod choices;
pub(crate) mod document;
#[cfg(feature = "network")]
mod mission;
#[cfg(feature = "network")]
mod steps;
#[cfg(feature = "network")]
mod table;
#[cfg(feature = "network")]
mod trace;
mod trajectory;

#[cfg(feature = "network")]
pub use mission::MissionPage;
#[cfg(feature = "network")]
pub use trace::{PageError, of_trace};
pub use trajectory::{Drawing, TrajectoryPage};
