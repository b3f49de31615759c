//! The automata that a robot runs, over the state of [`Robot`](super::Robot): the tables of the
//! discrete layer with guards and resets.

use crate::BuildError;

use super::robot::{
    ControlAutomaton, DealingAutomaton, DutyAutomaton, MissionAutomaton, Targets,
    control_automaton, dealing_automaton, duty_automaton, mission_automaton, targets,
};

/// The automata of a robot; all robots run the same.
#[derive(Clone, Debug)]
pub struct Automata {
    /// What the robot does.
    pub duty: DutyAutomaton,
    /// Where the robot goes.
    pub targets: Targets,
    /// The mission as the robot knows it.
    pub mission: MissionAutomaton,
    /// Where the robot stands in the exchange of duties.
    pub dealing: DealingAutomaton,
    /// Where the robot stands in its control period.
    pub control: ControlAutomaton,
}

impl Automata {
    /// The automata of a robot.
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
        })
    }
}
