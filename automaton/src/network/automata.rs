//! The automata that a robot runs, over the state of [`Robot`](super::Robot): the tables of the
//! discrete layer with guards and resets.

use crate::BuildError;

use super::robot::{
    DealingAutomaton, DutyAutomaton, MissionAutomaton, dealing_automaton, duty_automaton,
    mission_automaton,
};

/// The automata of a robot; all robots run the same.
#[derive(Clone, Debug)]
pub struct Automata {
    /// What the robot does.
    pub duty: DutyAutomaton,
    /// The mission as the robot knows it.
    pub mission: MissionAutomaton,
    /// Where the robot stands in the exchange of duties.
    pub dealing: DealingAutomaton,
}

impl Automata {
    /// The automata of a robot.
    ///
    /// # Errors
    /// Never with the tables and guards of this crate; they are checked all the same.
    pub fn new() -> Result<Self, BuildError> {
        Ok(Automata {
            duty: duty_automaton()?,
            mission: mission_automaton()?,
            dealing: dealing_automaton()?,
        })
    }

    /// The same automata, which count how often their rows are taken by all robots together.
    #[must_use]
    pub fn counted(self) -> Self {
        let Automata { duty, mission, dealing } = self;
        Automata { duty: duty.counted(), mission: mission.counted(), dealing: dealing.counted() }
    }
}
