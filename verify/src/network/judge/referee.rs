//! Which judge a mission has.

use pleach_automaton::network::certificate::Certificate;
use pleach_automaton::network::record::{End, Faults, MissionEvent, Snapshot};
use pleach_automaton::network::scenario::ValidScenario;
use pleach_discrete::network::Role;

use super::{Judge, Safety};
use crate::network::extremes::Extremes;
use crate::network::violation::Violation;

/// The judge of a mission: by all definitions where nothing fails, and otherwise by what no fault may
/// break.
#[derive(Clone, Debug)]
pub enum Referee<'a> {
    /// Of a mission without faults.
    Whole(Box<Judge<'a>>),
    /// Of a mission with faults.
    Safety(Box<Safety>),
}

impl<'a> Referee<'a> {
    /// The judge of a mission in which these faults occur, that has seen nothing yet; `role_table`
    /// tells whether a role may turn into another in one transition.
    pub fn new(
        scenario: &ValidScenario,
        faults: Faults,
        role_table: impl Fn(Role, Role) -> bool + 'a,
    ) -> Self {
        match faults.are_none() {
            true => Referee::Whole(Box::new(Judge::new(scenario, role_table))),
            false => Referee::Safety(Box::new(Safety::new(scenario, faults))),
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
        }
    }

    /// An observer's account of why a mission without faults ended: what its end should come with.
    pub fn account(&self, end: &End) -> Option<Certificate> {
        match self {
            Referee::Whole(judge) => judge.account(end),
            Referee::Safety(_) => None,
        }
    }

    /// How near the mission has come to its bounds so far.
    pub fn extremes(&self) -> &Extremes {
        match self {
            Referee::Whole(judge) => judge.extremes(),
            Referee::Safety(safety) => safety.extremes(),
        }
    }
}
