//! Communication and motion of the robot network, as local pure functions.
//!
//! What one robot computes, it computes here from its own data and from what its neighbours sent:
//! no function of a robot takes the whole network. The chapters follow a control period:
//!
//! 1. [`reliability`]: how well a link carries over a distance, eq. (27);
//! 2. [`rates`]: what flows over the links, and the residual c_i, eqs. (3)–(5);
//! 3. [`routing`]: the shares T_ij of problem (6), by exchanging multipliers with neighbours;
//! 4. [`motion`]: the next position, problem (21)–(22);
//! 5. [`acceptance`]: the proof that the move keeps (5) at every instant.
//!
//! Views of the whole network exist for observers and as oracles of tests and say so:
//! [`routing::central`] and [`routing::rounds`].

pub mod acceptance;
pub mod motion;
pub mod rates;
pub mod reliability;
pub mod routing;

pub use reliability::{CubicReliability, LinkReliability, LogisticReliability, WithMargin};
