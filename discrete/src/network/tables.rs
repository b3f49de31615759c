//! The transition table of the mission as one robot knows it.
//!
//! Tables are the single source of the discrete behaviour. The guards that turn what is measured
//! into events, and the resets, are attached to the rows where numbers are known.

use super::Phase;
use crate::{Event, Location, Row, TransitionTable, Urgency};

#[cfg(any(kani, test))]
mod proofs;

impl Location for Phase {
    const ALL: &'static [Self] = &Phase::ALL;

    fn name(self) -> &'static str {
        Phase::name(self)
    }
}

/// What moves the mission on, in the eyes of one robot (Algorithms 1, 3 and 5).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MissionStep {
    /// The mission has ended.
    Ended,
    /// A task is announced.
    Announced,
    /// The leader election is over (Algorithm 1).
    Elected,
    /// The elected leader has past duties: it calls for a recruit (L_b = 1).
    Bound,
    /// The primary team is at a local stationary point: p₁ calls for a recruit (L_b = 0).
    Trapped,
    /// The primary team cannot move although it has room.
    Blocked,
    /// A recruit is called for (Remark 5.4).
    Called,
    /// This robot won the recruit election: it announces the path Σ.
    Recruited,
    /// The recruit election is over without a recruit.
    Unaided,
    /// The path Σ is announced.
    PathHeard,
    /// The break points 𝓑 are agreed.
    PointsAgreed,
    /// Every member of the active subgroup has arrived, eq. (26).
    SubgroupArrived,
    /// The last robot of Σ is relieved: it joins the primary team, or leads it.
    Relieved,
    /// The primary team is the active team again.
    Resumed,
    /// The leader has reached its task, eq. (2).
    Reached,
    /// The task is serviced.
    Serviced,
}

impl Event for MissionStep {
    const ALL: &'static [Self] = &[
        MissionStep::Ended,
        MissionStep::Announced,
        MissionStep::Elected,
        MissionStep::Bound,
        MissionStep::Trapped,
        MissionStep::Blocked,
        MissionStep::Called,
        MissionStep::Recruited,
        MissionStep::Unaided,
        MissionStep::PathHeard,
        MissionStep::PointsAgreed,
        MissionStep::SubgroupArrived,
        MissionStep::Relieved,
        MissionStep::Resumed,
        MissionStep::Reached,
        MissionStep::Serviced,
    ];

    fn name(self) -> &'static str {
        match self {
            MissionStep::Ended => "ended",
            MissionStep::Announced => "announced",
            MissionStep::Elected => "elected",
            MissionStep::Bound => "bound",
            MissionStep::Trapped => "trapped",
            MissionStep::Blocked => "blocked",
            MissionStep::Called => "called",
            MissionStep::Recruited => "recruited",
            MissionStep::Unaided => "unaided",
            MissionStep::PathHeard => "path heard",
            MissionStep::PointsAgreed => "points agreed",
            MissionStep::SubgroupArrived => "subgroup arrived",
            MissionStep::Relieved => "relieved",
            MissionStep::Resumed => "resumed",
            MissionStep::Reached => "reached",
            MissionStep::Serviced => "serviced",
        }
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
/// Priority 0: what the newest notice says. Priority 1: what the robot itself finds.
pub const MISSION: TransitionTable<Phase, MissionStep> = TransitionTable::new(&[
    step(0, Phase::Idle, MissionStep::Ended, Phase::Ended),
    step(0, Phase::Idle, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::Idle, MissionStep::Called, Phase::RecruitElection),
    step(0, Phase::Idle, MissionStep::Resumed, Phase::Advance),
    step(0, Phase::LeaderElection, MissionStep::Ended, Phase::Ended),
    step(0, Phase::LeaderElection, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::LeaderElection, MissionStep::Called, Phase::RecruitElection),
    step(0, Phase::LeaderElection, MissionStep::Resumed, Phase::Advance),
    step(1, Phase::LeaderElection, MissionStep::Elected, Phase::Advance),
    step(0, Phase::Advance, MissionStep::Ended, Phase::Ended),
    step(0, Phase::Advance, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::Advance, MissionStep::Serviced, Phase::Idle),
    step(0, Phase::Advance, MissionStep::Called, Phase::RecruitElection),
    step(1, Phase::Advance, MissionStep::Bound, Phase::RecruitElection),
    step(1, Phase::Advance, MissionStep::Reached, Phase::Idle),
    step(1, Phase::Advance, MissionStep::Trapped, Phase::RecruitElection),
    step(1, Phase::Advance, MissionStep::Blocked, Phase::Ended),
    step(0, Phase::RecruitElection, MissionStep::Ended, Phase::Ended),
    step(0, Phase::RecruitElection, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::RecruitElection, MissionStep::PathHeard, Phase::PathAgreement),
    step(0, Phase::RecruitElection, MissionStep::Resumed, Phase::Advance),
    step(1, Phase::RecruitElection, MissionStep::Recruited, Phase::PathAgreement),
    step(1, Phase::RecruitElection, MissionStep::Unaided, Phase::RecruitElection),
    step(0, Phase::PathAgreement, MissionStep::Ended, Phase::Ended),
    step(0, Phase::PathAgreement, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::PathAgreement, MissionStep::Resumed, Phase::Advance),
    step(1, Phase::PathAgreement, MissionStep::PointsAgreed, Phase::Shift),
    step(0, Phase::Shift, MissionStep::Ended, Phase::Ended),
    step(0, Phase::Shift, MissionStep::Announced, Phase::LeaderElection),
    step(0, Phase::Shift, MissionStep::Resumed, Phase::Advance),
    step(1, Phase::Shift, MissionStep::SubgroupArrived, Phase::Shift),
    step(1, Phase::Shift, MissionStep::Relieved, Phase::Advance),
    step(1, Phase::Shift, MissionStep::Blocked, Phase::Ended),
]);

#[cfg(test)]
mod tests {
    use super::super::{Activity, DutyEvent};
    use super::*;

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
        names(Phase::ALL.iter().map(|&phase| Location::name(phase)).collect());
        names(MissionStep::ALL.iter().map(|step| step.name()).collect());
    }

    #[test]
    fn the_end_is_final() {
        assert_eq!(MISSION.enabled(Phase::Ended).count(), 0);
    }
}
