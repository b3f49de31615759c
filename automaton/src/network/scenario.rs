//! What a mission starts from: workspace, radio, control settings, robots and tasks.
//!
//! A [`Scenario`] is plain data, as its file states it. [`Scenario::validate`] says everything
//! that is wrong with it, [`Settings`] fills in what it leaves to the defaults.

mod fault;
mod key_path;
mod placement;
mod settings;
mod validation;

pub use fault::{Fault, Problem};
pub use key_path::{KeyPath, KeyStep};
pub use settings::Settings;

use serde::{Deserialize, Serialize};

/// A scenario as its file states it; lengths in its own unit, times in seconds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// A short name, used for file names.
    pub name: String,
    /// One or more sentences about it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// Where the robots are.
    pub workspace: WorkspaceOutline,
    /// The radio, eq. (27).
    pub link: LinkRanges,
    /// Settings of the control scheme.
    #[serde(default)]
    pub control: Control,
    /// The fixed access points.
    pub access_point: Vec<AccessPoint>,
    /// The robots where they start.
    pub robot: Vec<RobotStart>,
    /// The tasks, in order of announcement.
    #[serde(default)]
    pub task: Vec<Task>,
}

/// The workspace 𝒲: a simple polygon with holes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorkspaceOutline {
    /// A simple polygon, either orientation, not closed twice.
    pub boundary: Vec<[f64; 2]>,
    /// Simple polygons inside the boundary, disjoint.
    #[serde(default)]
    pub holes: Vec<Vec<[f64; 2]>>,
}

/// The two distances of eq. (27).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkRanges {
    /// l: reliability 1 up to here.
    pub full_range: f64,
    /// u: reliability 0 from here on.
    pub max_range: f64,
}

/// An access point: a fixed sink of information.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AccessPoint {
    /// Where it stands.
    pub position: [f64; 2],
}

/// A robot at the start of the mission.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotStart {
    /// Where it starts.
    pub position: [f64; 2],
    /// r_i: the rate at which it generates information, a share of the radio's rate.
    #[serde(default = "default_rate")]
    pub rate: f64,
}

fn default_rate() -> f64 {
    0.075
}

/// A task: a place that a robot must stay close to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// q_v: where it is.
    pub position: [f64; 2],
}

/// How the routing variables are computed in every control period.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RoutingMethod {
    /// The dual iteration (13)–(14).
    Dual,
    /// The dual iteration with momentum.
    #[default]
    AcceleratedDual,
    /// The accelerated distributed augmented Lagrangian method of Remark 3.1.
    Adal,
}

/// How the motion problem (21)–(22) is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MotionSolver {
    /// Exact enumeration of the active constraints in the plane.
    #[default]
    Exact,
    /// The second-order cone program, by clarabel.
    Conic,
}

/// Settings of the control scheme; a key left out takes the default that its text states.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Control {
    /// ρ: distance kept from walls; robots keep 2ρ from each other. Default l/40.
    pub clearance: Option<f64>,
    /// δ: how close a robot must be to service a task, eq. (2). Default 3ρ.
    pub service_radius: Option<f64>,
    /// σ: radius of the trust region, eq. (21). Default (u − l)/10.
    pub step_radius: Option<f64>,
    /// c_min: residuals stay ≥ −c_min. Default 0.
    pub residual_tolerance: Option<f64>,
    /// Control periods after which the mission is given up. Default 20000.
    pub max_steps: Option<usize>,
    /// Δt: length of a control period in seconds. Default 1.
    pub period: Option<f64>,
    /// Rounds of coordination messages in a control period. Default 8.
    pub rounds_per_period: Option<usize>,
    /// How routes are computed. Default `accelerated_dual`.
    pub routing_method: Option<RoutingMethod>,
    /// Iterations of the routing method in a control period. Default 5.
    pub routing_iterations: Option<usize>,
    /// η: the residual that routes aim at. Default 0.02.
    pub routing_reserve: Option<f64>,
    /// κ: how strongly traffic avoids links whose reliability changes with distance. Default 10.
    pub slope_aversion: Option<f64>,
    /// Reliability that a link of the tree never falls below. Default 0.8.
    pub tree_reliability: Option<f64>,
    /// How the motion problem is solved. Default `exact`.
    pub motion_solver: Option<MotionSolver>,
}
