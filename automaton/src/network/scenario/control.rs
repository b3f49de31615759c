//! `[control]`: the settings of the control scheme, and what may stand at each of their keys.

use serde::{Deserialize, Serialize};

/// How the routing variables are computed in every control period.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RoutingMethod {
    /// The dual iteration (13)–(14).
    Dual,
    /// The dual iteration with momentum.
    #[default]
    AcceleratedDual,
    /// The accelerated distributed augmented Lagrangian method of Remark 3.1.
    Adal,
}

impl RoutingMethod {
    /// The least η, as a share of the radio's rate. A robot grants only what its own flows carry, and routes change by
    /// what is left over: where that is nothing, teams stand still that have room. The routes of ADAL go round in
    /// circles before they have settled, and flows in a circle end with their leases, so that more has to be left.
    pub const fn least_reserve(self) -> f64 {
        match self {
            RoutingMethod::Dual | RoutingMethod::AcceleratedDual => 0.0005,
            RoutingMethod::Adal => 0.005,
        }
    }
}

/// How the motion problem (21)–(22) is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum MotionSolver {
    /// Exact enumeration of the active constraints in the plane.
    #[default]
    Exact,
    /// The second-order cone program, by clarabel.
    Conic,
}

/// When a recruit is called for, and what the primary team does meanwhile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Strategy {
    /// As in the paper (Sec. V): when the primary team stands still; and it stands until the recruit has joined.
    Paper,
    /// As soon as the way that is left to the task is longer than the links of the team; and it goes on
    /// meanwhile as far as its links let it.
    #[default]
    Eager,
}

/// Which robots pursue tasks together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Teams {
    /// All of them: they pursue one task after another.
    #[default]
    One,
    /// Those of each access point: they pursue its tasks, at the same time as those of the others.
    PerAccessPoint,
}

impl Teams {
    /// Whether there is one team.
    pub(super) const fn is_one(self) -> bool {
        matches!(self, Teams::One)
    }
}

/// Settings of the control scheme; a key left out takes the default that its text states.
/// [`CONTROL`] has the range of each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Control {
    /// ρ: distance kept from walls; robots keep 2ρ from each other. Default l/40.
    pub clearance: Option<f64>,
    /// δ: how close a robot must be to service a task, eq. (2). Default 3ρ.
    pub service_radius: Option<f64>,
    /// σ: radius of the trust region, eq. (21). Default (u − l)/10.
    pub step_radius: Option<f64>,
    /// e: a robot is within this distance of where it believes to be; at most ρ/2. Default 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub position_error: Option<f64>,
    /// m: a move ends within this distance of its end, and strays in the midst of it by at most the same
    /// share of that; at most ρ/2. Default 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub motion_error: Option<f64>,
    /// c_min: residuals stay ≥ −c_min. Default 0.
    pub residual_tolerance: Option<f64>,
    /// Control periods after which the mission is given up. Default 20000.
    pub max_steps: Option<usize>,
    /// Δt: length of a control period in seconds. Default 1.
    pub period: Option<f64>,
    /// Rounds of coordination messages in a control period. Default 8; with fewer than 5 a mission is judged only by
    /// what must hold under any fault.
    pub rounds_per_period: Option<usize>,
    /// How routes are computed. Default `accelerated_dual`.
    pub routing_method: Option<RoutingMethod>,
    /// Iterations of the routing method in a control period. Default 5.
    pub routing_iterations: Option<usize>,
    /// η: the residual that routes aim at. Default 0.02.
    pub routing_reserve: Option<f64>,
    /// κ: how strongly traffic avoids links whose reliability changes with distance. Default 10.
    pub slope_aversion: Option<f64>,
    /// Reliability of links of the tree when they are made. Default: what all rates of a team together ask of
    /// one link, from `tree_reliability` to 0.8.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub build_reliability: Option<f64>,
    /// Reliability that a link of the tree never falls below. Default 0.1.
    pub tree_reliability: Option<f64>,
    /// How the motion problem is solved. Default `exact`.
    pub motion_solver: Option<MotionSolver>,
    /// When a recruit is called for. Default `eager`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strategy: Option<Strategy>,
    /// Which robots pursue tasks together. Default `one`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub teams: Option<Teams>,
}

/// A key of `[control]`.
#[derive(Clone, Copy, Debug)]
pub struct ControlKey {
    /// The key.
    pub name: &'static str,
    /// What may stand there.
    pub values: Values,
}

/// What may stand at a key, with access to what does.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum Values {
    /// A length, at least `SHORTEST` and at most 1 time the range of the links.
    Length(fn(&Control) -> Option<f64>),
    /// A length from 0 to 1 time the range of the links.
    Error(fn(&Control) -> Option<f64>),
    /// A time in seconds, from the first number to the second.
    Time(f64, f64, fn(&Control) -> Option<f64>),
    /// A number from 0 to this one.
    UpTo(f64, fn(&Control) -> Option<f64>),
    /// A share of the radio's rate, at least [what the routing method needs](RoutingMethod::least_reserve) and at most 1.
    Reserve(fn(&Control) -> Option<f64>),
    /// A reliability above 0 and below 1.
    Reliability(fn(&Control) -> Option<f64>),
    /// A whole number from 1 to this one.
    Count(usize, fn(&Control) -> Option<usize>),
    /// One of these words.
    OneOf(&'static [&'static str]),
}

/// The shortest length that a setting may have, in ranges of the links: what a robot could not
/// cover within the longest mission, or what coordinates of [`FARTHEST`] cannot resolve, is a
/// mistake.
pub(super) const SHORTEST: f64 = 1e-6;

/// The largest magnitude of a coordinate, in ranges of the links.
pub(super) const FARTHEST: f64 = 1e6;

/// The largest magnitude of a coordinate in any unit: rounding stays below the tolerances of motion problems, which are
/// 1e-12.
pub const LARGEST_COORDINATE: f64 = 1e4;

/// The smallest clearance in any unit: properties are held up to 1e-6.
pub(super) const SMALLEST_CLEARANCE: f64 = 1e-4;

/// The most control periods that a scenario may state, of a mission and of the times of its tasks.
pub const MOST_PERIODS: u32 = 1_000_000_000;

/// The keys of `[control]`, in the order of the documentation.
pub const CONTROL: &[ControlKey] = &[
    key("clearance", Values::Length(|control| control.clearance)),
    key("service_radius", Values::Length(|control| control.service_radius)),
    key("step_radius", Values::Length(|control| control.step_radius)),
    key("position_error", Values::Error(|control| control.position_error)),
    key("motion_error", Values::Error(|control| control.motion_error)),
    key("residual_tolerance", Values::UpTo(1.0, |control| control.residual_tolerance)),
    key("max_steps", Values::Count(MOST_PERIODS as usize, |control| control.max_steps)),
    key("period", Values::Time(1e-6, 1e6, |control| control.period)),
    key("rounds_per_period", Values::Count(10_000, |control| control.rounds_per_period)),
    key("routing_method", Values::OneOf(&["dual", "accelerated_dual", "adal"])),
    key("routing_iterations", Values::Count(10_000, |control| control.routing_iterations)),
    key("routing_reserve", Values::Reserve(|control| control.routing_reserve)),
    key("slope_aversion", Values::UpTo(1e6, |control| control.slope_aversion)),
    key("build_reliability", Values::Reliability(|control| control.build_reliability)),
    key("tree_reliability", Values::Reliability(|control| control.tree_reliability)),
    key("motion_solver", Values::OneOf(&["exact", "conic"])),
    key("strategy", Values::OneOf(&["paper", "eager"])),
    key("teams", Values::OneOf(&["one", "per_access_point"])),
];

const fn key(name: &'static str, values: Values) -> ControlKey {
    ControlKey { name, values }
}

impl Values {
    /// Whether it is held against the range of the links.
    pub(super) const fn is_against_range(&self) -> bool {
        matches!(self, Values::Length(_) | Values::Error(_))
    }

    /// The number that `control` states at this key, unless it is a count or a word.
    pub(super) fn number(&self, control: &Control) -> Option<f64> {
        match self {
            Values::Length(stated)
            | Values::Error(stated)
            | Values::Time(_, _, stated)
            | Values::UpTo(_, stated)
            | Values::Reserve(stated)
            | Values::Reliability(stated) => stated(control),
            Values::Count(..) | Values::OneOf(_) => None,
        }
    }
}
