//! The automata that nodes run, each over the state of its node: the tables of the discrete layer
//! with guards and resets, flows, invariants and laws.

use crate::BuildError;

use super::access_point::{RoundAutomaton, ServiceAutomaton, round_automaton, service_automaton};
use super::robot::{
    ControlAutomaton, DealingAutomaton, DutyAutomaton, MissionAutomaton, Targets,
    control_automaton, dealing_automaton, duty_automaton, mission_automaton, targets,
};
use super::user::{RequestAutomaton, request_automaton};

/// The automata of all nodes; nodes of one kind run the same.
#[derive(Clone, Debug)]
pub struct Automata {
    /// What the robot does.
    pub duty: DutyAutomaton,
    /// Where the robot goes.
    pub targets: Targets,
    /// The mission as the robot knows it.
    pub mission: MissionAutomaton,
    /// The state of the robot in the exchange of duties.
    pub dealing: DealingAutomaton,
    /// The stage of the robot in its control period.
    pub control: ControlAutomaton,
    /// The service of the tasks, for an access point.
    pub service: ServiceAutomaton,
    /// The stage of an access point in its control period.
    pub rounds: RoundAutomaton,
    /// What the user does.
    pub request: RequestAutomaton,
}

impl Automata {
    /// The automata.
    ///
    /// # Errors
    /// Never with the tables and guards of this crate; they are checked all the same.
    pub fn new() -> Result<Self, BuildError> {
        Ok(Automata {
            duty: duty_automaton()?,
            targets: targets(),
            mission: mission_automaton()?,
            dealing: dealing_automaton()?,
            control: control_automaton()?,
            service: service_automaton()?,
            rounds: round_automaton()?,
            request: request_automaton()?,
        })
    }

    /// The same automata, which count how often their rows are taken by all nodes together.
    #[must_use]
    pub fn counted(self) -> Self {
        Automata {
            duty: self.duty.counted(),
            targets: self.targets,
            mission: self.mission.counted(),
            dealing: self.dealing.counted(),
            control: self.control.counted(),
            service: self.service.counted(),
            rounds: self.rounds.counted(),
            request: self.request.counted(),
        }
    }
}
