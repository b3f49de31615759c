//! The routing problem (6): which share of its time a robot gives to each link.
//!
//! ```text
//! minimise    Σ_ij w_ij T_ij²
//! subject to  c_i(T) ≥ η             for every robot i,
//!             Σ_j T_ij ≤ 1, T ≥ 0.
//! ```
//!
//! The paper has η = 0; then every residual is 0 at the optimum, since each robot's rate is
//! positive, and no robot may move without breaking (5). The reserve η > 0 is the room to move.
//!
//! # Signs
//!
//! The printed (7), (11) and (14) mix a minimum and a maximum; with them every multiplier stays
//! 0 and nothing is ever sent. The Lagrangian used here is L = Σ w T² − Σ_i λ_i (c_i − η) with
//! λ ≥ 0. Its local minimiser is T_ij = [R_ij(λ_i − λ_j) − μ_i]₊ / (2 w_ij), where λ = 0 at access
//! points and μ_i ≥ 0 is the multiplier of Σ_j T_ij ≤ 1, and its dual ascent is
//! λ_i ← [λ_i − ε(c_i − η)]₊. A multiplier is a price: traffic runs from dear to cheap robots, and
//! access points take it for nothing.
//!
//! # Chapters
//!
//! - [`local`]: the primal iteration (12)–(13), closed form;
//! - [`dual`]: the dual iteration (14), plain and accelerated;
//! - [`adal`]: the Accelerated Distributed Augmented Lagrangian method of Remark 3.1;
//! - [`repair`]: what makes routes feasible at every t_k, whatever the iteration has reached;
//! - [`problem`], [`central`], [`rounds`]: the whole problem, its central solution and the local
//!   functions run for a whole network, for observers, tests and benchmarks.

pub mod adal;
pub mod central;
pub mod dual;
pub mod local;
pub mod problem;
pub mod repair;
pub mod rounds;

/// The time that a robot shares out in routing, Σ_j T_ij ≤ `TIME_BUDGET`, as a share of a period.
///
/// It is 1 less a margin that is far above rounding (1e-15) and far below any share that matters:
/// time shares that are recomputed as F/R must not exceed 1 by rounding, or the certified
/// acceptance would refuse even that all robots stay.
pub const TIME_BUDGET: f64 = 1.0 - 1e-9;

#[cfg(test)]
mod tests;
