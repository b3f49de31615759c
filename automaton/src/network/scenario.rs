//! What a mission starts from: workspace, radio, control settings, robots and tasks.
//!
//! A [`Scenario`] is plain data, as its file states it. [`Settings`] fills in what it leaves to
//! the defaults. A [`ValidScenario`] is one that a mission can start from, with the site that the
//! robots know; making one says everything that is wrong. What does not keep a mission from
//! starting but may surprise, its [`Remark`]s tell.

mod agenda;
mod control;
mod fault;
mod fleet;
mod key_path;
mod placement;
mod radio;
mod remark;
mod settings;
mod valid;
mod validation;

pub use agenda::{AGENDA, Agenda, TaskOrder, Unreachable};
pub use control::{
    CONTROL, Control, ControlKey, LARGEST_COORDINATE, MOST_PERIODS, MotionSolver, RoutingMethod,
    Strategy, Teams, Values,
};
pub use fault::{Fault, InvalidScenario, Problem};
pub use fleet::Fleet;
pub use key_path::{KeyPath, KeyStep};
pub use radio::{LinkModel, LinkRanges, STEEPEST, STEEPNESS};
pub use remark::{Late, LinkCount, Remark, TaskRemark};
pub use settings::{LinkLengths, Settings};
pub use valid::ValidScenario;
pub use validation::LONGEST_NAME;

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
    /// The radio.
    pub link: LinkRanges,
    /// Settings of the control scheme.
    #[serde(default)]
    pub control: Control,
    /// Which tasks are pursued, and in which order.
    #[serde(default, skip_serializing_if = "Agenda::is_default")]
    pub mission: Agenda,
    /// The fixed access points.
    #[serde(default)]
    pub access_point: Vec<AccessPoint>,
    /// The robots where they start.
    #[serde(default)]
    pub robot: Vec<RobotStart>,
    /// The tasks, in order of announcement.
    #[serde(default)]
    pub task: Vec<Task>,
}

/// The workspace 𝒲: a polygon with holes. Polygons may touch themselves and each other; none may cross.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorkspaceOutline {
    /// A polygon, either orientation.
    pub boundary: Vec<[f64; 2]>,
    /// Polygons inside the boundary, without a common part.
    #[serde(default)]
    pub holes: Vec<Vec<[f64; 2]>>,
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
    /// The number of the access point that it belongs to, where each has a team of its own; not stated: the nearest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub access_point: Option<usize>,
}

impl RobotStart {
    /// A robot that starts here and generates information at this rate.
    pub const fn at(position: [f64; 2], rate: f64) -> Self {
        RobotStart { position, rate, access_point: None }
    }

    /// The same robot, not stated to belong to an access point.
    const fn of_nearest(self) -> Self {
        RobotStart { access_point: None, ..self }
    }
}

fn default_rate() -> f64 {
    0.075
}

/// A task: a place that a robot must stay close to, for ever unless it says otherwise. Its times count control
/// periods, like the k of traces.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Task {
    /// q_v: where it is.
    pub position: [f64; 2],
    /// The control period from which on the user asks for it; not stated: from the beginning.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub announced: Option<u32>,
    /// The control period in which the user takes it back; not stated: never.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub withdrawn: Option<u32>,
    /// For how many control periods, from its service on, it has to be serviced; not stated: for ever.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lasts: Option<u32>,
    /// With `order = "priority"`, tasks of a higher priority come first; not stated: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub priority: Option<i32>,
    /// The number of the access point that it belongs to, where each has a team of its own; not stated: the nearest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub access_point: Option<usize>,
}

impl Task {
    /// A task that is asked for from the beginning, and for ever.
    pub const fn at(position: [f64; 2]) -> Self {
        Task {
            position,
            announced: None,
            withdrawn: None,
            lasts: None,
            priority: None,
            access_point: None,
        }
    }

    /// The same task, not stated to belong to an access point.
    const fn of_nearest(self) -> Self {
        Task { access_point: None, ..self }
    }

    /// The control period from which on the user asks for it.
    pub fn asked_for(&self) -> u32 {
        self.announced.unwrap_or_default()
    }
}
