//! The automata that a robot runs, over the state of [`Robot`]: the tables of the discrete layer
//! with guards and resets.

use pleach_discrete::network::{MISSION, MissionStep, Phase};
use pleach_guards::network::mission;

use crate::{Automaton, BuildError, Reset};

use super::robot::{DutyAutomaton, PROPOSITIONS, Robot, VARIABLES, duty_automaton};

/// The automaton of the mission as one robot sees it.
pub type MissionAutomaton = Automaton<Phase, MissionStep, Robot>;

/// The automata of a robot; all robots run the same.
#[derive(Clone, Debug)]
pub struct Automata {
    /// What the robot does.
    pub duty: DutyAutomaton,
    /// The mission as the robot knows it.
    pub mission: MissionAutomaton,
}

impl Automata {
    /// The automata of a robot.
    ///
    /// # Errors
    /// Never with the tables and guards of this crate; they are checked all the same.
    pub fn new() -> Result<Self, BuildError> {
        Ok(Automata { duty: duty_automaton()?, mission: mission_automaton()? })
    }
}

/// The mission automaton (Algorithms 1 to 5).
///
/// # Errors
/// Never with the tables and guards of this crate; they are checked all the same.
pub fn mission_automaton() -> Result<MissionAutomaton, BuildError> {
    use MissionStep as Step;
    Automaton::builder(MISSION, Phase::Idle)
        .observing(VARIABLES, PROPOSITIONS)
        .on(Step::Ended, mission::ended(), Reset::identity())
        .on(
            Step::Announced,
            mission::announced(),
            Reset::new("bid for the task", Robot::begin_leader_election),
        )
        .on(
            Step::Elected,
            mission::elected(),
            Reset::new("the winner leads", Robot::conclude_leader_election),
        )
        .on(
            Step::Bound,
            mission::bound(),
            Reset::new("call for a recruit", Robot::call_for_recruit),
        )
        .on(
            Step::Trapped,
            mission::trapped(),
            Reset::new("call for a recruit", Robot::call_for_recruit),
        )
        .on(Step::Blocked, mission::blocked(), Reset::new("say why", Robot::end_blocked))
        .on(
            Step::Called,
            mission::called(),
            Reset::new("answer the call", Robot::begin_recruit_election),
        )
        .on(Step::Recruited, mission::recruited(), Reset::new("announce Σ", Robot::announce_path))
        .on(
            Step::Unaided,
            mission::unaided(),
            Reset::new("ask other trees, or say why", Robot::end_unaided),
        )
        .on(
            Step::PathHeard,
            mission::path_heard(),
            Reset::new("vote on break points", Robot::begin_path),
        )
        .on(
            Step::PointsAgreed,
            mission::points_agreed(),
            Reset::new("form the subgroups", Robot::form_subgroups),
        )
        .on(
            Step::SubgroupArrived,
            mission::subgroup_arrived(),
            Reset::new("the next subgroup is active", Robot::next_subgroup),
        )
        .on(
            Step::Relieved,
            mission::relieved(),
            Reset::new("announce that the team advances", Robot::announce_advance),
        )
        .on(Step::Resumed, mission::resumed(), Reset::new("resume", Robot::resume))
        .on(
            Step::Reached,
            mission::reached(),
            Reset::new("announce the service", Robot::service_task),
        )
        .on(Step::Serviced, mission::serviced(), Reset::identity())
        .build()
}
