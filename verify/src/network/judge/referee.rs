//! Which judge a mission has.

use pleach_automaton::network::certificate::Certificate;
use pleach_automaton::network::record::{End, Faults, MissionEvent, Snapshot};
use pleach_automaton::network::scenario::{Settings, ValidScenario};
use pleach_continuous::Point;
use pleach_discrete::network::Role;

use super::{Judge, JudgeOfFleets, Safety};
use crate::network::extremes::Extremes;
use crate::network::violation::Violation;

/// The faults by which a mission is judged in which these occur: where control periods are too short for an exchange
/// of duties, messages count as late.
pub fn judged_faults(settings: &Settings, faults: Faults) -> Faults {
    let is_short = !settings.has_rounds_for_exchanges();
    Faults { messages: faults.messages || is_short, ..faults }
}

/// The judge of a mission: by all definitions where nothing fails, and otherwise by what no fault may
/// break.
#[derive(Clone, Debug)]
pub enum Referee<'a> {
    /// Of a mission that is judged by all definitions.
    Whole(Box<Judge<'a>>),
    /// Of a mission with faults, or with periods too short for an exchange of duties.
    Safety(Box<Safety>),
    /// Of the missions of several fleets.
    Fleets(Box<JudgeOfFleets<'a>>),
}

impl<'a> Referee<'a> {
    /// The judge of a mission in which these faults occur, that has seen nothing yet; `role_table`
    /// tells whether a role may turn into another in one transition.
    pub fn new(
        scenario: &ValidScenario,
        faults: Faults,
        role_table: impl Fn(Role, Role) -> bool + 'a,
    ) -> Self {
        match scenario.fleets().is_empty() {
            true => Referee::of_one(scenario, faults, role_table),
            false => Referee::Fleets(Box::new(JudgeOfFleets::new(scenario, faults, role_table))),
        }
    }

    /// The judge of the mission of one fleet.
    pub(super) fn of_one(
        scenario: &ValidScenario,
        faults: Faults,
        role_table: impl Fn(Role, Role) -> bool + 'a,
    ) -> Self {
        let faults = judged_faults(&scenario.site().settings, faults);
        match faults.are_none() {
            true => Referee::Whole(Box::new(Judge::new(scenario, role_table))),
            false => Referee::Safety(Box::new(Safety::new(scenario, faults))),
        }
    }

    /// Where the robots of other fleets are at the next snapshot.
    pub(super) fn show_bodies(&mut self, bodies: Vec<Point>) {
        if let Referee::Whole(judge) = self {
            judge.show_bodies(bodies);
        }
    }

    /// Judges the control period that ends with this snapshot, its events, and the snapshot.
    ///
    /// # Errors
    ///
    /// The first violation; what is observed after it has no meaning.
    pub fn observe(
        &mut self,
        snapshot: &Snapshot,
        events: &[MissionEvent],
    ) -> Result<(), Violation> {
        match self {
            Referee::Whole(judge) => judge.observe(snapshot, events),
            Referee::Safety(safety) => safety.observe(snapshot, events),
            Referee::Fleets(fleets) => fleets.observe(snapshot, events),
        }
    }

    /// Judges how the mission ended.
    ///
    /// # Errors
    ///
    /// [`Property::Outcome`](crate::network::Property::Outcome) if the record does not show what the
    /// outcome says.
    pub fn conclude(&self, end: &End) -> Result<(), Violation> {
        match self {
            Referee::Whole(judge) => judge.conclude(end),
            Referee::Safety(safety) => safety.conclude(end),
            Referee::Fleets(fleets) => fleets.conclude(end),
        }
    }

    /// An observer's account of why a mission that is judged by all definitions ended: what its end should come with.
    pub fn account(&self, end: &End) -> Option<Certificate> {
        match self {
            Referee::Whole(judge) => judge.account(end),
            Referee::Safety(_) | Referee::Fleets(_) => None,
        }
    }

    /// The same for the mission of the fleet of this access point, where there are several.
    pub fn account_of_fleet(&self, access_point: usize, end: &End) -> Option<Certificate> {
        match self {
            Referee::Fleets(fleets) => fleets.account(access_point, end),
            Referee::Whole(_) | Referee::Safety(_) => None,
        }
    }

    /// The same events, where each task that is given up comes with an account of why, if the mission is judged by all
    /// definitions.
    pub fn explain(&self, snapshot: &Snapshot, events: &[MissionEvent]) -> Vec<MissionEvent> {
        let explain = |event: &MissionEvent| match (event, self) {
            (MissionEvent::TaskGivenUp { task, outcome, reason, .. }, Referee::Whole(judge)) => {
                let certificate = judge.account_of_task(*task, *outcome, snapshot, events);
                MissionEvent::TaskGivenUp {
                    task: *task,
                    outcome: *outcome,
                    reason: reason.clone(),
                    certificate: certificate.map(Box::new),
                }
            }
            (_, Referee::Fleets(fleets)) => fleets.explain(event, snapshot, events),
            _ => event.clone(),
        };
        events.iter().map(explain).collect()
    }

    /// How near the mission has come to its bounds so far.
    pub fn extremes(&self) -> &Extremes {
        match self {
            Referee::Whole(judge) => judge.extremes(),
            Referee::Safety(safety) => safety.extremes(),
            Referee::Fleets(fleets) => fleets.extremes(),
        }
    }
}
