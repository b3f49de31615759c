//! The transition table of the mission as one robot knows it.
//!
//! Tables are the single source of the discrete behaviour. The guards that turn what is measured
//! into events, and the resets, are attached to the rows where numbers are known.

use super::Phase;
use crate::{Row, TransitionTable, Urgency, vocabulary};

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

const fn step(
    priority: u8,
    source: Phase,
    event: MissionStep,
    target: Phase,
) -> Row<Phase, MissionStep> {
    Row { source, event, target, urgency: Urgency::AtOnce, priority }
}

/// The table of the mission automaton.
///
/// Priority 0: what the newest notice says. Priorities from 1: what the robot itself finds; a team
/// that has reached its task calls for no recruit, and one that can call for one does not give up.
pub const MISSION: TransitionTable<Phase, MissionStep> = TransitionTable::new(&[
    step(0, Phase::Idle, MissionStep::Ended, Phase::Ended),
    step(0, Phase::Idle, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::Idle, MissionStep::Informed, Phase::Idle),
    step(0, Phase::Idle, MissionStep::Repeated, Phase::Idle),
    step(0, Phase::Idle, MissionStep::Called, Phase::RecruitElection),
    step(0, Phase::Idle, MissionStep::PathHeard, Phase::PathAgreement),
    step(0, Phase::Idle, MissionStep::Resumed, Phase::Advance),
    step(0, Phase::LeaderElection, MissionStep::Ended, Phase::Ended),
    step(0, Phase::LeaderElection, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::LeaderElection, MissionStep::Informed, Phase::LeaderElection),
    step(0, Phase::LeaderElection, MissionStep::Overtaken, Phase::Idle),
    step(0, Phase::LeaderElection, MissionStep::Serviced, Phase::Idle),
    step(0, Phase::LeaderElection, MissionStep::Called, Phase::RecruitElection),
    step(0, Phase::LeaderElection, MissionStep::PathHeard, Phase::PathAgreement),
    step(0, Phase::LeaderElection, MissionStep::Resumed, Phase::Advance),
    step(1, Phase::LeaderElection, MissionStep::Elected, Phase::Advance),
    step(0, Phase::Advance, MissionStep::Ended, Phase::Ended),
    step(0, Phase::Advance, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::Advance, MissionStep::Informed, Phase::Advance),
    step(0, Phase::Advance, MissionStep::Overtaken, Phase::Idle),
    step(0, Phase::Advance, MissionStep::Serviced, Phase::Idle),
    step(0, Phase::Advance, MissionStep::Called, Phase::RecruitElection),
    step(0, Phase::Advance, MissionStep::PathHeard, Phase::PathAgreement),
    step(1, Phase::Advance, MissionStep::Bound, Phase::RecruitElection),
    step(1, Phase::Advance, MissionStep::Unbound, Phase::Advance),
    step(1, Phase::Advance, MissionStep::Reached, Phase::Idle),
    step(2, Phase::Advance, MissionStep::Trapped, Phase::RecruitElection),
    step(3, Phase::Advance, MissionStep::Foreseen, Phase::RecruitElection),
    step(4, Phase::Advance, MissionStep::Blocked, Phase::Ended),
    step(0, Phase::RecruitElection, MissionStep::Ended, Phase::Ended),
    step(0, Phase::RecruitElection, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::RecruitElection, MissionStep::Informed, Phase::RecruitElection),
    step(0, Phase::RecruitElection, MissionStep::Overtaken, Phase::Idle),
    step(0, Phase::RecruitElection, MissionStep::Serviced, Phase::Idle),
    step(0, Phase::RecruitElection, MissionStep::Called, Phase::RecruitElection),
    step(0, Phase::RecruitElection, MissionStep::PathHeard, Phase::PathAgreement),
    step(0, Phase::RecruitElection, MissionStep::Resumed, Phase::Advance),
    step(1, Phase::RecruitElection, MissionStep::Recruited, Phase::PathAgreement),
    step(1, Phase::RecruitElection, MissionStep::Unaided, Phase::RecruitElection),
    step(0, Phase::PathAgreement, MissionStep::Ended, Phase::Ended),
    step(0, Phase::PathAgreement, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::PathAgreement, MissionStep::Informed, Phase::PathAgreement),
    step(0, Phase::PathAgreement, MissionStep::Overtaken, Phase::Idle),
    step(0, Phase::PathAgreement, MissionStep::Serviced, Phase::Idle),
    step(0, Phase::PathAgreement, MissionStep::Called, Phase::RecruitElection),
    step(0, Phase::PathAgreement, MissionStep::Resumed, Phase::Advance),
    step(1, Phase::PathAgreement, MissionStep::PointsAgreed, Phase::Shift),
    step(0, Phase::Shift, MissionStep::Ended, Phase::Ended),
    step(0, Phase::Shift, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::Shift, MissionStep::Informed, Phase::Shift),
    step(0, Phase::Shift, MissionStep::Overtaken, Phase::Idle),
    step(0, Phase::Shift, MissionStep::Serviced, Phase::Idle),
    step(0, Phase::Shift, MissionStep::Called, Phase::RecruitElection),
    step(0, Phase::Shift, MissionStep::Resumed, Phase::Advance),
    step(1, Phase::Shift, MissionStep::SubgroupArrived, Phase::Shift),
    step(1, Phase::Shift, MissionStep::Relieved, Phase::Advance),
    step(3, Phase::Shift, MissionStep::Blocked, Phase::Ended),
    step(0, Phase::Ended, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::Ended, MissionStep::Overtaken, Phase::Idle),
]);

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
