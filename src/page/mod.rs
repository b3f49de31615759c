//! Pages on which a run plays.
//!
//! A page is one HTML file that needs no other and no network: the run as data, and scripts that
//! show it. [`MissionPage`] makes the page of a mission while it runs,
//! [`of_trace`] from its trace, and [`TrajectoryPage`] that of a run of any automaton or composition.
//!
//! | file | what it does |
//! | --- | --- |
//! | `assets/page.html`, `assets/style.css` | the frame, light and dark, narrow and on paper |
//! | `assets/tables.js` | reads the numbers |
//! | `assets/player.js`, `assets/transport.js` | where the run stands; play, pause, speed, the time line, keys |
//! | `assets/canvas.js` | drawing surfaces, axes, colours |
//! | `assets/plan.js`, `assets/marks.js` | the plan of a mission, its layers, marks and labels |
//! | `assets/curves.js`, `assets/strips.js` | numbers and locations over time |
//! | `assets/mission.js` | what is told of a mission, its robots and links |
//! | `assets/run.js` | what is told of a trajectory, and the drawings of its automata |

mod choices;
mod document;
mod mission;
mod steps;
mod table;
mod trace;
mod trajectory;

pub use mission::MissionPage;
pub use trace::{PageError, of_trace};
pub use trajectory::{Drawing, TrajectoryPage};
