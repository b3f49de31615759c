//! What a robot does for the network: the locations of its duty, and the table between them.
//!
//! Each location has one of the paper's roles ([`Role`]) and one way of moving. Redundant robots
//! stand by; the tree consists of relays, junctions and leaves; the primary team follows its
//! leader; the robots of the path Σ wait until it is their turn and then shift to the next place.
//! An elected leader with past duties is bound until it is released (L_b = 1), or services its task from its post.

use super::Role;
use crate::{Row, Superstate, TransitionTable, from, from_any, transitions, vocabulary};

#[cfg(any(kani, test))]
mod proofs;

vocabulary! {
    /// What a robot does for the network.
    pub enum Activity: Location {
        /// It holds the post of a redundant robot and may be recruited.
        Standby = "standby",
        /// It holds a fixed post on one branch of the tree.
        Relay = "relay",
        /// It holds a fixed post where branches part.
        Junction = "junction",
        /// It holds a fixed post from which it services a task.
        Leaf = "leaf",
        /// It is elected leader, and holds a post until it is released from it (L_b = 1), or services its task from there.
        Bound = "bound leader",
        /// It holds its post on the path Σ until it is relieved or its turn comes.
        Waiting = "waiting on the path",
        /// It is the elected leader at the end of Σ and waits to be released (L_b = 1).
        AwaitingRelease = "awaiting release",
        /// It has left its place on Σ and is on its way to the next one, eq. (25).
        Shifting = "shifting along the path",
        /// It follows the next robot of the primary team, eq. (24).
        Following = "following the team",
        /// It heads the primary team towards the announced task, eq. (24).
        Leading = "leading the team",
    }

    /// What changes the duty of a robot (Algorithms 3 and 4, Remark 5.6).
    pub enum DutyEvent: Event {
        /// It wins the leader election and nothing depends on it.
        Elected = "elected",
        /// It wins the leader election and has past duties.
        Bound = "bound",
        /// A branch of the tree has come to depend on the post of the leader, which is bound to it.
        Burdened = "burdened",
        /// The path Σ passes its post.
        PathJoined = "path joined",
        /// Its turn has come, and its post is held by another robot if it matters.
        SetOut = "set out",
        /// It takes the post of a redundant robot at the next place.
        StandbyReached = "standby reached",
        /// It takes the post of a relay at the next place.
        RelayReached = "relay reached",
        /// It takes the post of a junction at the next place.
        JunctionReached = "junction reached",
        /// It takes the post of a leaf at the next place.
        LeafReached = "leaf reached",
        /// Σ is given up or done: it goes on as a redundant robot.
        StandbyKept = "standby kept",
        /// Σ is given up or done: it goes on as a relay.
        RelayKept = "relay kept",
        /// Σ is given up or done: it goes on as a leaf.
        LeafKept = "leaf kept",
        /// Σ is given up: it is bound as before.
        BoundKept = "bound kept",
        /// It is relieved, and joins the primary team behind p₁.
        TeamJoined = "team joined",
        /// It is relieved, or nothing depends on its post any more, and leads.
        Released = "released",
        /// It is within reach of the announced task, eq. (2), and services it: from where it is, or from the post to which
        /// it is bound.
        TaskReached = "task reached",
        /// The team is dissolved: its post becomes fixed where it is.
        Settled = "settled",
        /// Another task is announced before it was released: it goes on as a relay.
        RelayResumed = "relay resumed",
        /// Another task is announced before it was released: it goes on as a leaf.
        LeafResumed = "leaf resumed",
        /// The task that it services is over: its post becomes one of a relay.
        Discharged = "discharged",
        /// A second branch parts from its post.
        Branched = "branched",
        /// Only one branch is left at its post.
        Merged = "merged",
        /// A branch of the tree depends on it, Remark 5.6 (i).
        Promoted = "promoted",
        /// No branch depends on it any more, Remark 5.6 (ii).
        Retired = "retired",
        /// It attaches to another parent in the tree.
        Attached = "attached",
        /// It joins a mission under way, and its post is a new one.
        Joined = "joined",
        /// It exchanges duties with a robot that stands by.
        TakesStandby = "takes standby",
        /// It exchanges duties with a relay.
        TakesRelay = "takes relay",
        /// It exchanges duties with a junction.
        TakesJunction = "takes junction",
        /// It exchanges duties with a leaf.
        TakesLeaf = "takes leaf",
        /// It exchanges duties with a bound leader.
        TakesBound = "takes bound leader",
        /// It exchanges duties with a robot that waits on Σ.
        TakesWaiting = "takes waiting",
        /// It exchanges duties with a leader that waits to be released.
        TakesAwaitingRelease = "takes awaiting release",
        /// It exchanges duties with a robot that shifts along Σ.
        TakesShifting = "takes shifting",
        /// It exchanges duties with a member of the primary team.
        TakesFollowing = "takes following",
        /// It exchanges duties with the leader.
        TakesLeading = "takes leading",
    }
}

impl Activity {
    /// Whether the robot holds a fixed post of the tree, which must not be left unheld.
    pub const fn holds_fixed_post(self) -> bool {
        match self {
            Activity::Relay
            | Activity::Junction
            | Activity::Leaf
            | Activity::Bound
            | Activity::Waiting
            | Activity::AwaitingRelease => true,
            Activity::Standby | Activity::Shifting | Activity::Following | Activity::Leading => {
                false
            }
        }
    }

    /// Whether the robot is on its way and holds no fixed post.
    pub const fn is_under_way(self) -> bool {
        !matches!(self, Activity::Standby) && !self.holds_fixed_post()
    }

    /// Whether a robot with this activity can have this role (Sec. II and V-D). One on the path Σ
    /// keeps the role of the post that it holds; the first of Σ is the recruit.
    pub const fn can_be(self, role: Role) -> bool {
        match self {
            Activity::Standby => matches!(role, Role::Redundant),
            Activity::Relay | Activity::Following => matches!(role, Role::Node),
            Activity::Junction => matches!(role, Role::Junction),
            Activity::Leaf => matches!(role, Role::Leaf),
            Activity::Bound | Activity::AwaitingRelease | Activity::Leading => {
                matches!(role, Role::Leader)
            }
            Activity::Waiting => !matches!(role, Role::Leader),
            Activity::Shifting => matches!(role, Role::Recruit | Role::Node),
        }
    }

    /// The event on which another robot takes over a duty of this kind.
    pub const fn taken_over(self) -> DutyEvent {
        match self {
            Activity::Standby => DutyEvent::TakesStandby,
            Activity::Relay => DutyEvent::TakesRelay,
            Activity::Junction => DutyEvent::TakesJunction,
            Activity::Leaf => DutyEvent::TakesLeaf,
            Activity::Bound => DutyEvent::TakesBound,
            Activity::Waiting => DutyEvent::TakesWaiting,
            Activity::AwaitingRelease => DutyEvent::TakesAwaitingRelease,
            Activity::Shifting => DutyEvent::TakesShifting,
            Activity::Following => DutyEvent::TakesFollowing,
            Activity::Leading => DutyEvent::TakesLeading,
        }
    }
}

impl DutyEvent {
    /// Whether the robot goes away from the post that it holds, which another robot must hold by then, or on which
    /// nothing may depend: the guards of these events ask for it.
    pub const fn needs_replacement(self) -> bool {
        matches!(
            self,
            DutyEvent::SetOut
                | DutyEvent::TeamJoined
                | DutyEvent::Released
                | DutyEvent::TakesShifting
                | DutyEvent::TakesFollowing
                | DutyEvent::TakesLeading
        )
    }
}

/// Whether a transition leaves no fixed post without a robot (Algorithm 4): a robot that leaves one
/// has been replaced.
pub const fn keeps_posts_held(source: Activity, event: DutyEvent, target: Activity) -> bool {
    !(source.holds_fixed_post() && target.is_under_way()) || event.needs_replacement()
}

/// Whether a robot may change from one role to another in one transition of [`DUTIES`].
///
/// A robot that begins to wait on Σ keeps its role or becomes the recruit; what it does after it
/// has waited, it does in the role that it had or as the recruit.
pub const fn may_follow(from: Role, to: Role) -> bool {
    FOLLOWERS[from as usize] & 1 << to as usize != 0
}

/// The rows of [`DUTIES`] on which a robot may change from one role to another.
pub fn rows_between(
    from: Role,
    to: Role,
) -> impl Iterator<Item = &'static Row<Activity, DutyEvent>> {
    DUTIES.rows().iter().filter(move |row| leads_on(row, from, to))
}

/// The roles that may follow each role, as bits: the compiler reads the table.
const FOLLOWERS: [u8; Role::ALL.len()] = {
    let mut followers = [0; Role::ALL.len()];
    let (rows, mut from) = (DUTIES.rows(), 0);
    while from < followers.len() {
        let mut to = 0;
        while to < followers.len() {
            let (mut follows, mut at) = (from == to, 0);
            while at < rows.len() {
                follows |= leads_on(&rows[at], Role::ALL[from], Role::ALL[to]);
                at += 1;
            }
            followers[from] |= (follows as u8) << to;
            to += 1;
        }
        from += 1;
    }
    followers
};

/// Whether a robot in the role `from` may be in the role `to` once it has taken this transition.
const fn leads_on(row: &Row<Activity, DutyEvent>, from: Role, to: Role) -> bool {
    let waits = matches!(row.target, Activity::Waiting);
    let keeps_role = from as u8 == to as u8 || matches!(to, Role::Recruit);
    let has_waited = matches!(row.source, Activity::Waiting);
    row.source.can_be(from)
        && row.target.can_be(to)
        && (!waits || keeps_role || row.source.is_under_way())
        && (!has_waited || waits_as(from, row.target))
}

/// Whether a robot that waits on Σ in `role` may go on to `target`.
const fn waits_as(role: Role, target: Activity) -> bool {
    match target {
        Activity::Standby => matches!(role, Role::Redundant | Role::Recruit),
        Activity::Leaf => matches!(role, Role::Leaf),
        Activity::Relay => matches!(role, Role::Node | Role::Junction | Role::Recruit),
        _ => true,
    }
}

impl Activity {
    /// The robot holds a post, and takes no part in the pursuit of the task.
    pub const UNINVOLVED: Superstate<Activity> = Superstate::new(
        "uninvolved",
        &[Activity::Standby, Activity::Relay, Activity::Junction, Activity::Leaf],
    );

    /// The robot holds a post.
    pub const AT_REST: Superstate<Activity> = Superstate::new(
        "at rest",
        &[
            Activity::Standby,
            Activity::Relay,
            Activity::Junction,
            Activity::Leaf,
            Activity::Bound,
            Activity::Waiting,
            Activity::AwaitingRelease,
        ],
    );

    /// The robot is of the primary team.
    pub const IN_TEAM: Superstate<Activity> =
        Superstate::new("in the team", &[Activity::Following, Activity::Leading]);

    /// The robot is on its way, and holds no fixed post.
    pub const UNDER_WAY: Superstate<Activity> =
        Superstate::new("under way", &[Activity::Shifting, Activity::Following, Activity::Leading]);
}

/// The table of a robot's duty.
///
/// Priority 0: what a step of the mission or an exchange asks for. Priority 1: what the robot
/// itself finds about its post. Priority 2: what it finds once it is attached to the parent it wants.
pub const DUTIES: TransitionTable<Activity, DutyEvent> = {
    use Activity::*;
    use DutyEvent as On;
    transitions![Activity, DutyEvent;
        from(Standby).on(On::Joined).to(Standby),
        from(Standby).on(On::Elected).to(Leading),
        from_any(Activity::UNINVOLVED).on(On::Bound).to(Bound),
        from(Leading).on(On::Burdened).to(Bound).priority(2),
        from(Bound).on(On::RelayResumed).to(Relay),
        from(Bound).on(On::LeafResumed).to(Leaf),
        from(Bound).on(On::TaskReached).to(Leaf),
        from(Bound).on(On::Released).to(Leading),
        from_any(Activity::UNINVOLVED).on(On::PathJoined).to(Waiting),
        from(Bound).on(On::PathJoined).to(AwaitingRelease),
        from(Waiting).on(On::StandbyKept).to(Standby),
        from(Waiting).on(On::RelayKept).to(Relay),
        from(Waiting).on(On::LeafKept).to(Leaf),
        from(AwaitingRelease).on(On::BoundKept).to(Bound),
        from(AwaitingRelease).on(On::RelayResumed).to(Relay),
        from(AwaitingRelease).on(On::LeafResumed).to(Leaf),
        from(AwaitingRelease).on(On::StandbyKept).to(Standby),
        from(Waiting).on(On::TeamJoined).to(Following),
        from(AwaitingRelease).on(On::Released).to(Leading),
        from(Shifting).on(On::StandbyReached).to(Standby),
        from(Shifting).on(On::RelayReached).to(Relay),
        from(Shifting).on(On::JunctionReached).to(Junction),
        from(Shifting).on(On::LeafReached).to(Leaf),
        from(Leading).on(On::TaskReached).to(Leaf),
        from_any(Activity::IN_TEAM).on(On::Settled).to(Relay),
        from(Waiting).on(On::SetOut).to(Shifting).priority(1),
        from(Standby).on(On::Attached).to(Standby).priority(1),
        from(Relay).on(On::Attached).to(Relay).priority(2),
        from(Junction).on(On::Attached).to(Junction).priority(2),
        from(Leaf).on(On::Attached).to(Leaf).priority(1),
        from(Bound).on(On::Attached).to(Bound).priority(1),
        from(Leaf).on(On::Discharged).to(Relay).priority(2),
        from_any(Activity::IN_TEAM).on(On::Attached).stay().priority(1),
        from(Standby).on(On::Promoted).to(Relay).priority(2),
        from(Relay).on(On::Branched).to(Junction).priority(1),
        from(Relay).on(On::Retired).to(Standby).priority(1),
        from(Junction).on(On::Merged).to(Relay).priority(1),
        from_any(Activity::UNDER_WAY).on(On::TakesStandby).to(Standby),
        from_any(Activity::UNDER_WAY).on(On::TakesRelay).to(Relay),
        from_any(Activity::UNDER_WAY).on(On::TakesJunction).to(Junction),
        from_any(Activity::UNDER_WAY).on(On::TakesLeaf).to(Leaf),
        from_any(Activity::UNDER_WAY).on(On::TakesBound).to(Bound),
        from_any(Activity::UNDER_WAY).on(On::TakesWaiting).to(Waiting),
        from_any(Activity::UNDER_WAY).on(On::TakesAwaitingRelease).to(AwaitingRelease),
        from_any(Activity::AT_REST).on(On::TakesShifting).to(Shifting),
        from_any(Activity::AT_REST).on(On::TakesFollowing).to(Following),
        from_any(Activity::AT_REST).on(On::TakesLeading).to(Leading),
        from_any(Activity::IN_TEAM).on(On::TakesShifting).to(Shifting),
        from_any(Activity::UNDER_WAY).on(On::TakesFollowing).to(Following),
        from(Shifting).on(On::TakesLeading).to(Leading),
        from(Following).on(On::TakesLeading).to(Leading),
    ]
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Event;

    #[test]
    fn the_table_is_deterministic_and_every_location_is_reached() {
        assert!(DUTIES.is_deterministic());
        assert_eq!(DUTIES.unreachable_from(Activity::Standby), vec![]);
        let named = |event: &&DutyEvent| DUTIES.rows().iter().any(|row| row.event == **event);
        assert!(DutyEvent::ALL.iter().all(|event| named(&event)));
    }

    /// What a step of the mission asks for comes before what the robot finds itself; and a robot that
    /// finds a better parent attaches to it before its post becomes fixed.
    #[test]
    fn rows_that_may_be_enabled_together_are_in_order() {
        use Activity::{Bound, Following, Junction, Leading, Relay, Standby, Waiting};
        use DutyEvent as On;
        let priority = |source, event| {
            let mut rows = DUTIES.enabled(source);
            rows.find(|row| row.event == event).map(|row| row.priority).expect("there is a row")
        };
        for (source, first, then) in [
            (Standby, On::Elected, On::Attached),
            (Standby, On::Attached, On::Promoted),
            (Waiting, On::TeamJoined, On::SetOut),
            (Relay, On::PathJoined, On::Retired),
            (Junction, On::PathJoined, On::Merged),
            (Leading, On::TaskReached, On::Attached),
            (Bound, On::PathJoined, On::Attached),
            (Following, On::Settled, On::Attached),
        ] {
            assert!(
                priority(source, first) < priority(source, then),
                "{source:?}: {first:?}, {then:?}"
            );
        }
    }

    #[test]
    fn no_transition_leaves_a_fixed_post_unheld() {
        for row in DUTIES.rows() {
            assert!(keeps_posts_held(row.source, row.event, row.target), "{row:?}");
        }
        assert!(!keeps_posts_held(Activity::Leaf, DutyEvent::Settled, Activity::Following));
    }

    /// The roles that may follow each role, against the algorithms of the paper.
    #[test]
    fn roles_change_as_the_algorithms_allow() {
        use Role::{Junction, Leader, Leaf, Node, Recruit, Redundant};
        let after = |from: Role| -> Vec<Role> {
            Role::ALL.into_iter().filter(|&to| to != from && may_follow(from, to)).collect()
        };
        assert_eq!(after(Redundant), [Recruit, Node, Leader]);
        assert_eq!(after(Recruit), [Redundant, Node, Junction, Leaf, Leader]);
        assert_eq!(after(Leaf), [Recruit, Node, Leader]);
        assert_eq!(after(Junction), [Recruit, Node, Leader]);
    }
}
