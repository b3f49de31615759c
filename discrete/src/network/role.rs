//! What a robot is for the network, and where the mission stands for it.

use crate::vocabulary;

/// The role of a robot (Sec. II and V-D of the paper).
///
/// Being a junction and being a leaf are facts about the post that a robot holds; where both
/// hold at once, the role is the more binding one, `Leaf`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Role {
    /// Without a duty: may be recruited.
    Redundant,
    /// Elected to help the primary team; on its way along the path Σ.
    Recruit,
    /// Relays on a branch of the tree, or moves with the primary team.
    Node,
    /// Holds the place where branches part.
    Junction,
    /// Services a task.
    Leaf,
    /// Heads the primary team towards the announced task.
    Leader,
}

impl Role {
    /// Every role, in the order of their declaration.
    pub const ALL: [Role; 6] =
        [Role::Redundant, Role::Recruit, Role::Node, Role::Junction, Role::Leaf, Role::Leader];

    /// The name used in traces and diagrams.
    pub const fn name(self) -> &'static str {
        match self {
            Role::Redundant => "redundant",
            Role::Recruit => "recruit",
            Role::Node => "node",
            Role::Junction => "junction",
            Role::Leaf => "leaf",
            Role::Leader => "leader",
        }
    }
}

vocabulary! {
    /// The phase of the mission, as one robot knows it (Algorithms 1 to 5).
    #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
    #[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
    pub enum Phase: Location {
        /// No task is announced.
        Idle = "idle",
        /// The leader of the announced task is being elected (Algorithm 1).
        LeaderElection = "leader election",
        /// The primary team is the active team (Sec. V-A3).
        Advance = "advance",
        /// A recruit is being elected (Remark 5.4).
        RecruitElection = "recruit election",
        /// The path Σ is announced and its break points are agreed (Sec. V-C2).
        PathAgreement = "path agreement",
        /// A subgroup of the secondary team is the active team (Algorithm 3).
        Shift = "shift",
        /// The mission has ended.
        Ended = "ended",
    }
}
