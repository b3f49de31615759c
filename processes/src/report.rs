//! What a process reports to observers, as JSON that any tool of Zenoh can show.
//!
//! No node reads reports. What observers receive was written by anyone, and is refused where it
//! names what is not in the scenario.

use crate::packet::Refusal;
use pleach::automaton::network::observer::RobotReport;
use pleach::automaton::network::record::{End, MissionEvent, Outcome};
use pleach::automaton::network::scenario::Scenario;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The most bytes of a report.
pub const LONGEST_REPORT: usize = 1 << 18;

/// What a node reports at the end of the rounds of a control period, before it moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// k.
    pub step: usize,
    /// The robot.
    pub robot: Option<RobotReport>,
    /// What has happened, each with the round and the exchange in which it has.
    pub events: Vec<(u32, u32, MissionEvent)>,
    /// How the mission has ended, as the user knows it.
    pub end: Option<AnnouncedEnd>,
    /// What its process has counted since it was started.
    pub tally: Tally,
}

/// How the mission has ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AnnouncedEnd {
    outcome: Outcome,
    reason: String,
    task: Option<usize>,
}

/// What a process has counted since it was started.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tally {
    /// Packets and messages refused.
    pub refused: u64,
    /// Packets that came after their round was over.
    pub late: u64,
    /// Messages lost on purpose.
    pub lost: u64,
    /// Beacons lost because only their digest came.
    pub unknown: u64,
    /// How often a node was given up.
    pub given_up: u64,
    /// Packets sent by all nodes of the process, one for each round.
    pub packets: u64,
    /// The messages in them.
    pub messages: u64,
    /// The bytes of these packets.
    pub bytes: u64,
}

impl From<End> for AnnouncedEnd {
    fn from(End { outcome, reason, task, .. }: End) -> Self {
        AnnouncedEnd { outcome, reason, task }
    }
}

impl From<AnnouncedEnd> for End {
    fn from(AnnouncedEnd { outcome, reason, task }: AnnouncedEnd) -> Self {
        End::new(outcome, reason, task)
    }
}

impl Report {
    /// Reads what has arrived.
    ///
    /// # Errors
    /// Why it is refused.
    pub fn decode(bytes: &[u8], scenario: &Scenario) -> Result<Self, Refusal> {
        if bytes.len() > LONGEST_REPORT {
            return Err(Refusal::TooLong);
        }
        let report: Report = serde_json::from_slice(bytes).map_err(|_| Refusal::Malformed)?;
        if report.fits(scenario) { Ok(report) } else { Err(Refusal::Malformed) }
    }

    /// Whether all nodes and tasks that it names are in the scenario.
    fn fits(&self, scenario: &Scenario) -> bool {
        let robots = scenario.robot.len();
        let nodes = robots + scenario.access_point.len();
        let is_task = |task: Option<usize>| task.is_none_or(|task| task < scenario.task.len());
        self.robot.as_ref().is_none_or(|robot| {
            let is_share = |&(to, share, reliability): &(usize, f64, f64)| {
                to < nodes && share.is_finite() && reliability.is_finite()
            };
            is_task(robot.task)
                && is_task(robot.duty.post().and_then(|post| post.task))
                && robot.routes.iter().all(is_share)
                && robot.tree_parent.is_none_or(|parent| parent < nodes)
        }) && self.events.iter().all(|(.., event)| names_what_is_there(event, scenario))
            && is_task(self.end.as_ref().and_then(|end| end.task))
    }
}

/// Whether the nodes and tasks of an event are in the scenario. Its numbers are nodes, but those of
/// tasks and subgroups.
fn names_what_is_there(event: &MissionEvent, scenario: &Scenario) -> bool {
    let nodes = scenario.robot.len() + scenario.access_point.len();
    let robots = scenario.robot.len();
    let is_below = |value: &Value, count: usize| match value {
        Value::Number(number) => number.as_u64().is_some_and(|number| number < count as u64),
        Value::Array(numbers) => {
            numbers.iter().all(|number| number.as_u64().is_some_and(|number| number < count as u64))
        }
        _ => true,
    };
    let Ok(Value::Object(fields)) = serde_json::to_value(event) else { return false };
    fields.iter().all(|(name, value)| match name.as_str() {
        "subgroup" => true,
        "task" => is_below(value, scenario.task.len()),
        "parent" => is_below(value, nodes),
        _ => is_below(value, robots),
    })
}
