//! The transition table of the mission as one robot knows it.
//!
//! Tables are the single source of the discrete behaviour. The guards that turn what is measured
//! into events, and the resets, are attached to the rows where numbers are known.

use super::Phase;
use crate::{Superstate, TransitionTable, from, from_any, transitions, vocabulary};

#[cfg(any(kani, test))]
mod proofs;

vocabulary! {
    /// What moves the mission on, as known to one robot (Algorithms 1, 3 and 5).
    pub enum MissionStep: Event {
        /// The mission has ended.
        Ended = "ended",
        /// A task is announced.
        Announced = "announced",
        /// The leader election is over (Algorithm 1).
        Elected = "elected",
        /// The elected leader has past duties, and cannot service its task from its post: it calls for a recruit (L_b = 1).
        Bound = "bound",
        /// Nothing depends on the post of the elected leader any more: it leads on without a recruit.
        Unbound = "unbound",
        /// The primary team is at a local stationary point: p₁ calls for a recruit (L_b = 0).
        Trapped = "trapped",
        /// The way to the task is longer than the primary team: p₁ calls for a recruit before it stands still.
        Foreseen = "foreseen",
        /// The primary team cannot move although it has room.
        Blocked = "blocked",
        /// A recruit is called for (Remark 5.4).
        Called = "called",
        /// This robot won the recruit election: it announces the path Σ.
        Recruited = "recruited",
        /// The recruit election is over without a recruit.
        Unaided = "unaided",
        /// The path Σ is announced.
        PathHeard = "path heard",
        /// The break points 𝓑 are agreed.
        PointsAgreed = "points agreed",
        /// Every member of the active subgroup has arrived, eq. (26).
        SubgroupArrived = "subgroup arrived",
        /// The last robot of Σ is relieved: it joins the primary team, or leads it.
        Relieved = "relieved",
        /// The primary team is the active team again.
        Resumed = "resumed",
        /// The leader has reached its task, eq. (2).
        Reached = "reached",
        /// The task is serviced.
        Serviced = "serviced",
        /// Others go on with the task that this robot has reached: it says again that the task is serviced.
        Repeated = "repeated",
        /// It learns that its task has been announced again, and goes on without it.
        Overtaken = "overtaken",
        /// It learns of the announcement by which the others go.
        Informed = "informed",
    }
}

impl Phase {
    /// A task is pursued: its leader is elected, or leads, or its team grows by a recruit.
    pub const PURSUING: Superstate<Phase> = Superstate::new(
        "pursuing",
        &[
            Phase::LeaderElection,
            Phase::Advance,
            Phase::RecruitElection,
            Phase::PathAgreement,
            Phase::Shift,
        ],
    );

    /// The mission has not ended.
    pub const OPEN: Superstate<Phase> = Superstate::new(
        "open",
        &[
            Phase::Idle,
            Phase::LeaderElection,
            Phase::Advance,
            Phase::RecruitElection,
            Phase::PathAgreement,
            Phase::Shift,
        ],
    );
}

/// The table of the mission automaton.
///
/// Priority 0: what the newest notice says. Priorities from 1: what the robot itself finds; a team
/// that has reached its task calls for no recruit, and one that can call for one does not give up.
pub const MISSION: TransitionTable<Phase, MissionStep> = {
    use MissionStep as On;
    use Phase::*;
    transitions![Phase, MissionStep;
        from_any(Phase::OPEN).on(On::Ended).to(Ended),
        from_any(Phase::OPEN).on(On::Announced).to(LeaderElection),
        from(Ended).on(On::Announced).to(LeaderElection),
        from_any(Phase::OPEN).on(On::Informed).stay(),
        from_any(Phase::PURSUING).on(On::Overtaken).to(Idle),
        from(Ended).on(On::Overtaken).to(Idle),
        from_any(Phase::PURSUING).on(On::Serviced).to(Idle),
        from(Idle).on(On::Repeated).to(Idle),
        from_any(Phase::OPEN).on(On::Called).to(RecruitElection),
        from(Idle).on(On::PathHeard).to(PathAgreement),
        from(LeaderElection).on(On::PathHeard).to(PathAgreement),
        from(Advance).on(On::PathHeard).to(PathAgreement),
        from(RecruitElection).on(On::PathHeard).to(PathAgreement),
        from(Idle).on(On::Resumed).to(Advance),
        from(LeaderElection).on(On::Resumed).to(Advance),
        from(RecruitElection).on(On::Resumed).to(Advance),
        from(PathAgreement).on(On::Resumed).to(Advance),
        from(Shift).on(On::Resumed).to(Advance),
        from(LeaderElection).on(On::Elected).to(Advance).priority(1),
        from(Advance).on(On::Bound).to(RecruitElection).priority(1),
        from(Advance).on(On::Unbound).to(Advance).priority(1),
        from(Advance).on(On::Reached).to(Idle).priority(1),
        from(Advance).on(On::Trapped).to(RecruitElection).priority(2),
        from(Advance).on(On::Foreseen).to(RecruitElection).priority(3),
        from(Advance).on(On::Blocked).to(Ended).priority(4),
        from(RecruitElection).on(On::Recruited).to(PathAgreement).priority(1),
        from(RecruitElection).on(On::Unaided).to(RecruitElection).priority(1),
        from(PathAgreement).on(On::PointsAgreed).to(Shift).priority(1),
        from(Shift).on(On::SubgroupArrived).to(Shift).priority(1),
        from(Shift).on(On::Relieved).to(Advance).priority(1),
        from(Shift).on(On::Blocked).to(Ended).priority(3),
    ]
};

#[cfg(test)]
mod tests {
    use super::super::{Activity, DutyEvent};
    use super::*;
    use crate::{Event, Location};

    #[test]
    fn the_table_is_deterministic_and_every_location_is_reached() {
        assert!(MISSION.is_deterministic());
        assert_eq!(MISSION.unreachable_from(Phase::Idle), vec![]);
    }

    #[test]
    fn names_are_lower_case_words_that_differ() {
        let names = |names: Vec<&'static str>| {
            assert!(crate::vocabulary::all_differ(&names), "{names:?}");
            let is_word = |word: &str| {
                !word.is_empty() && word.chars().all(|letter| letter.is_ascii_lowercase())
            };
            assert!(names.iter().all(|name| name.split(' ').all(is_word)), "{names:?}");
        };
        names(Activity::ALL.iter().map(|activity| activity.name()).collect());
        names(DutyEvent::ALL.iter().map(|event| event.name()).collect());
        names(Phase::ALL.iter().map(|phase| phase.name()).collect());
        names(MissionStep::ALL.iter().map(|step| step.name()).collect());
    }

    #[test]
    fn only_another_announcement_takes_up_a_mission_that_has_ended() {
        let steps: Vec<MissionStep> = MISSION.enabled(Phase::Ended).map(|row| row.event).collect();
        assert_eq!(steps, [MissionStep::Announced, MissionStep::Overtaken]);
    }
}
