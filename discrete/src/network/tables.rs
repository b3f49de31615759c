//! The transition tables of the two automata of a robot: its role and its view of the mission.
//!
//! These tables are the single source of the discrete behaviour. The guards that turn facts into
//! events, and the resets, are attached to the events where numbers are known.

use super::{Phase, Role};
use crate::{Event, Location, Row, TransitionTable, Urgency};

#[cfg(any(kani, test))]
mod proofs;

impl Location for Role {
    const ALL: &'static [Self] = &Role::ALL;

    fn name(self) -> &'static str {
        Role::name(self)
    }
}

impl Location for Phase {
    const ALL: &'static [Self] = &Phase::ALL;

    fn name(self) -> &'static str {
        Phase::name(self)
    }
}

/// What changes the role of a robot (Algorithm 4 and Remark 5.6).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum RoleEvent {
    /// It wins a leader election, or takes over the leader's duty.
    Elected,
    /// It wins a recruit election, or takes over the recruit's duty.
    Recruited,
    /// It services a task, from now on or in the place of another.
    Entrusted,
    /// It holds a fixed post from which several branches part.
    Parted,
    /// It holds a fixed post on one branch.
    Posted,
    /// It moves with a team, and what it held before is held by another.
    Relieved,
    /// Nothing depends on it.
    Retired,
}

impl Event for RoleEvent {
    const ALL: &'static [Self] = &[
        RoleEvent::Elected,
        RoleEvent::Recruited,
        RoleEvent::Entrusted,
        RoleEvent::Parted,
        RoleEvent::Posted,
        RoleEvent::Relieved,
        RoleEvent::Retired,
    ];

    fn name(self) -> &'static str {
        match self {
            RoleEvent::Elected => "elected",
            RoleEvent::Recruited => "recruited",
            RoleEvent::Entrusted => "entrusted",
            RoleEvent::Parted => "parted",
            RoleEvent::Posted => "posted",
            RoleEvent::Relieved => "relieved",
            RoleEvent::Retired => "retired",
        }
    }
}

impl RoleEvent {
    /// Whether the robot goes away from the place that it held, which another must hold by then:
    /// the guards of these events ask for it.
    pub const fn needs_replacement(self) -> bool {
        matches!(self, RoleEvent::Recruited | RoleEvent::Relieved)
    }
}

/// Whether a transition leaves no place that matters without a robot (Algorithm 4).
///
/// A leaf goes when another robot is at its place, or leads: as a leader it stays where it is
/// until it is released (L_b = 1). So does a junction; and it is none any more when its place
/// services a task, when one branch is left, and when none is.
pub const fn keeps_places_held(source: Role, event: RoleEvent, target: Role) -> bool {
    let goes_on = event.needs_replacement() || matches!(target, Role::Leader);
    match source {
        Role::Leaf => goes_on,
        Role::Junction => {
            goes_on
                || matches!(event, RoleEvent::Entrusted | RoleEvent::Posted | RoleEvent::Retired)
        }
        _ => true,
    }
}

const fn role(source: Role, event: RoleEvent, target: Role) -> Row<Role, RoleEvent> {
    Row { source, event, target, urgency: Urgency::AtOnce, priority: 0 }
}

/// The table of the role automaton.
pub const ROLES: TransitionTable<Role, RoleEvent> = TransitionTable::new(&[
    role(Role::Redundant, RoleEvent::Elected, Role::Leader),
    role(Role::Redundant, RoleEvent::Recruited, Role::Recruit),
    role(Role::Redundant, RoleEvent::Entrusted, Role::Leaf),
    role(Role::Redundant, RoleEvent::Parted, Role::Junction),
    role(Role::Redundant, RoleEvent::Posted, Role::Node),
    role(Role::Redundant, RoleEvent::Relieved, Role::Node),
    role(Role::Recruit, RoleEvent::Elected, Role::Leader),
    role(Role::Recruit, RoleEvent::Entrusted, Role::Leaf),
    role(Role::Recruit, RoleEvent::Parted, Role::Junction),
    role(Role::Recruit, RoleEvent::Posted, Role::Node),
    role(Role::Recruit, RoleEvent::Relieved, Role::Node),
    role(Role::Recruit, RoleEvent::Retired, Role::Redundant),
    role(Role::Node, RoleEvent::Elected, Role::Leader),
    role(Role::Node, RoleEvent::Recruited, Role::Recruit),
    role(Role::Node, RoleEvent::Entrusted, Role::Leaf),
    role(Role::Node, RoleEvent::Parted, Role::Junction),
    role(Role::Node, RoleEvent::Retired, Role::Redundant),
    role(Role::Junction, RoleEvent::Elected, Role::Leader),
    role(Role::Junction, RoleEvent::Recruited, Role::Recruit),
    role(Role::Junction, RoleEvent::Entrusted, Role::Leaf),
    role(Role::Junction, RoleEvent::Posted, Role::Node),
    role(Role::Junction, RoleEvent::Relieved, Role::Node),
    role(Role::Junction, RoleEvent::Retired, Role::Redundant),
    role(Role::Leaf, RoleEvent::Elected, Role::Leader),
    role(Role::Leaf, RoleEvent::Recruited, Role::Recruit),
    role(Role::Leaf, RoleEvent::Relieved, Role::Node),
    role(Role::Leader, RoleEvent::Recruited, Role::Recruit),
    role(Role::Leader, RoleEvent::Entrusted, Role::Leaf),
    role(Role::Leader, RoleEvent::Parted, Role::Junction),
    role(Role::Leader, RoleEvent::Posted, Role::Node),
    role(Role::Leader, RoleEvent::Relieved, Role::Node),
    role(Role::Leader, RoleEvent::Retired, Role::Redundant),
]);

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
    use super::*;

    #[test]
    fn the_tables_are_deterministic_and_every_location_is_reached() {
        assert!(ROLES.is_deterministic());
        assert_eq!(ROLES.unreachable_from(Role::Redundant), vec![]);
        assert!(MISSION.is_deterministic());
        assert_eq!(MISSION.unreachable_from(Phase::Idle), vec![]);
    }

    #[test]
    fn a_leaf_leaves_its_role_only_when_it_is_relieved_or_leads() {
        for row in ROLES.rows() {
            assert!(keeps_places_held(row.source, row.event, row.target), "{row:?}");
        }
    }

    /// Held places against a table: of a leaf and of a junction, the events on which it may go.
    #[test]
    fn places_are_left_only_as_the_algorithm_allows() {
        use RoleEvent::{Entrusted, Posted, Recruited, Relieved, Retired};
        let replaced = RoleEvent::ALL.iter().filter(|event| event.needs_replacement());
        assert!(replaced.eq(&[Recruited, Relieved]));
        for source in Role::ALL {
            let ways_out: &[RoleEvent] = match source {
                Role::Leaf => &[Recruited, Relieved],
                Role::Junction => &[Recruited, Relieved, Entrusted, Posted, Retired],
                _ => RoleEvent::ALL,
            };
            for &event in RoleEvent::ALL {
                for target in Role::ALL {
                    let allowed = ways_out.contains(&event) || target == Role::Leader;
                    let found = keeps_places_held(source, event, target);
                    assert_eq!(found, allowed, "{source:?} {event:?} {target:?}");
                }
            }
        }
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
        names(Role::ALL.iter().map(|&role| Location::name(role)).collect());
        names(Phase::ALL.iter().map(|&phase| Location::name(phase)).collect());
        names(RoleEvent::ALL.iter().map(|event| event.name()).collect());
        names(MissionStep::ALL.iter().map(|step| step.name()).collect());
    }

    #[test]
    fn the_end_is_final() {
        assert_eq!(MISSION.enabled(Phase::Ended).count(), 0);
    }
}
