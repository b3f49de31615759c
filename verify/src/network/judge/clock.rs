//! What every record begins with, how its time goes on, and when it may end.

use pleach_automaton::network::record::{End, Outcome, Snapshot};
use pleach_automaton::network::scenario::ValidScenario;

use super::Dispute;
use crate::network::limits::SLACK;
use crate::network::property::Property;

/// Where `fleets` have no place: each of several fleets is judged as a mission of its own.
const ONE_TEAM: &str = "in the mission of one team";

/// The time of a mission, and the places from which its robots start.
#[derive(Clone, Debug)]
pub(in crate::network) struct Clock {
    period: f64,
    max_steps: usize,
    starts: Vec<[f64; 2]>,
}

impl Clock {
    pub(in crate::network) fn of(scenario: &ValidScenario) -> Self {
        let settings = scenario.settings();
        Clock {
            period: settings.period,
            max_steps: settings.max_steps,
            starts: scenario.robot.iter().map(|robot| robot.position).collect(),
        }
    }

    /// The record begins with k = 0, when robots are where the scenario has them, t_k = k Δt, and there are at most
    /// as many periods as the scenario allows.
    pub(super) fn check(&self, snapshot: &Snapshot, opens: bool) -> Result<(), Dispute> {
        let record = |sentence| Dispute::of(Property::Record, &[], sentence);
        if opens && snapshot.step != 0 {
            let sentence = format!("the record begins with step {}, not with 0", snapshot.step);
            return Err(record(sentence));
        }
        if !snapshot.fleets.is_empty() {
            return Err(record(format!("the step shows fleets {ONE_TEAM}")));
        }
        let expected = snapshot.step as f64 * self.period;
        if (snapshot.time - expected).abs() > SLACK * self.period {
            let sentence = format!("the time is {} s, and k Δt is {expected} s", snapshot.time);
            return Err(record(sentence).measuring(snapshot.time, expected));
        }
        if snapshot.step >= self.max_steps {
            let sentence = format!(
                "the record goes on with step {}, and the last of max_steps = {} is {}",
                snapshot.step,
                self.max_steps,
                self.max_steps - 1
            );
            return Err(record(sentence));
        }
        let mut pairs = self.starts.iter().zip(&snapshot.positions).enumerate();
        match pairs.find(|(_, (start, place))| **start != [place.x, place.y]) {
            Some((robot, (start, _))) if opens => Err(Dispute::of(
                Property::Record,
                &[robot],
                format!("robot {robot} does not start at ({}, {})", start[0], start[1]),
            )),
            _ => Ok(()),
        }
    }

    /// What contradicts the end of a mission, in which `serviced` of `tasks` tasks are serviced or over, and
    /// `last` is the last step on record.
    pub(super) fn contradiction(
        &self,
        end: &End,
        last: Option<usize>,
        (serviced, tasks): (usize, usize),
    ) -> Option<String> {
        let Some(last) = last else { return Some("nothing is on record".to_owned()) };
        if !end.fleets.is_empty() {
            return Some(format!("the end lists fleets {ONE_TEAM}"));
        }
        match end.outcome {
            Outcome::Serviced if serviced < tasks => {
                Some(format!("the outcome is “serviced”, and {serviced} of {tasks} tasks are"))
            }
            Outcome::InvariantViolated => Some(format!("the run says: {}", end.reason)),
            // The record ends with the sample at which the last period began.
            Outcome::StepLimit if last + 1 < self.max_steps => Some(format!(
                "the outcome is “step_limit” after {} of {} control periods",
                last + 1,
                self.max_steps
            )),
            _ => None,
        }
    }
}
