//! The two automata of a robot, its role and its view of the mission, both over the state of
//! [`Robot`]: the tables of the discrete layer with guards and resets on their events.

use pleach_discrete::network::{MISSION, MissionStep, Phase, ROLES, Role, RoleEvent};
use pleach_guards::network::{mission, role};

use crate::{Automaton, BuildError, Reset};

use super::robot::Robot;

/// The automaton of a robot's role.
pub type RoleAutomaton = Automaton<Role, RoleEvent, Robot>;
/// The automaton of the mission as one robot sees it.
pub type MissionAutomaton = Automaton<Phase, MissionStep, Robot>;

/// The automata of a robot.
#[derive(Debug)]
pub struct Automata {
    /// Of its role.
    pub role: RoleAutomaton,
    /// Of the mission as it knows it.
    pub mission: MissionAutomaton,
}

impl Automata {
    /// All of them.
    ///
    /// # Errors
    /// Never with the tables and guards of this crate; they are checked all the same.
    pub fn new() -> Result<Self, BuildError> {
        Ok(Automata { role: role_automaton()?, mission: mission_automaton()? })
    }
}

/// The role automaton. A role is read off the robot's duty, so that its transitions reset
/// nothing.
///
/// # Errors
/// Never with the tables and guards of this crate; they are checked all the same.
pub fn role_automaton() -> Result<RoleAutomaton, BuildError> {
    Automaton::builder(ROLES, Role::Redundant)
        .on(RoleEvent::Elected, role::elected(), Reset::identity())
        .on(RoleEvent::Recruited, role::recruited(), Reset::identity())
        .on(RoleEvent::Entrusted, role::entrusted(), Reset::identity())
        .on(RoleEvent::Parted, role::parted(), Reset::identity())
        .on(RoleEvent::Posted, role::posted(), Reset::identity())
        .on(RoleEvent::Relieved, role::relieved(), Reset::identity())
        .on(RoleEvent::Retired, role::retired(), Reset::identity())
        .build()
}

/// The mission automaton (Algorithms 1 to 5).
///
/// # Errors
/// Never with the tables and guards of this crate; they are checked all the same.
pub fn mission_automaton() -> Result<MissionAutomaton, BuildError> {
    use MissionStep as Step;
    Automaton::builder(MISSION, Phase::Idle)
        .on(Step::Ended, mission::ended(), Reset::new("stop", Robot::leave_team))
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
            Reset::new("take the posts ahead", Robot::take_posts),
        )
        .on(
            Step::Relieved,
            mission::relieved(),
            Reset::new("join the primary team", Robot::join_team),
        )
        .on(Step::Resumed, mission::resumed(), Reset::new("resume", Robot::resume))
        .on(Step::Reached, mission::reached(), Reset::new("service the task", Robot::service_task))
        .on(Step::Serviced, mission::serviced(), Reset::new("leave the team", Robot::leave_team))
        .build()
}
