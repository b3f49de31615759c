//! Duties: what a robot does for the network at present, with the data that it needs for it.

use pleach_continuous::Point;
use pleach_discrete::network::{Activity, Post, PostId, Role, path};
use serde::{Deserialize, Serialize};

use super::wire;

/// A post with its reference position.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Station {
    /// The post.
    pub post: Post,
    /// Where it is; for posts of redundant robots and of the primary team, where its holder
    /// stood when it took the post.
    #[serde(with = "wire")]
    pub reference: Point,
}

/// A station that a robot holds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Held {
    /// The station.
    pub station: Station,
    /// The post that the robot held before, if it handed that over to another robot: robots that
    /// were attached to it may not know yet.
    pub left: Option<PostId>,
}

crate::places_of! {
    /// What a robot does for the network: an [`Activity`] with the data that it owns.
    #[derive(Copy, Serialize, Deserialize)]
    #[serde(rename_all = "snake_case")]
    pub enum Duty: Activity {
        /// It holds the post of a redundant robot and may be recruited.
        Standby(Standby),
        /// It holds a fixed post on one branch of the tree.
        Relay(Relay),
        /// It holds a fixed post where branches part.
        Junction(Junction),
        /// It holds a fixed post from which it services a task.
        Leaf(Leaf),
        /// It is elected leader, and holds a post until it is released from it (L_b = 1).
        Bound(Bound),
        /// It holds its post on the path Σ until it is relieved or its turn comes.
        Waiting(Waiting),
        /// It is the elected leader at the end of Σ and waits to be released (L_b = 1).
        AwaitingRelease(AwaitingRelease),
        /// It has left its place on Σ and is on its way to the next one, eq. (25).
        Shifting(Shifting),
        /// It follows the next robot of the primary team, eq. (24).
        Following(Following),
        /// It heads the primary team towards the announced task, eq. (24).
        Leading(Leading),
    }
}

macro_rules! duties_with_a_post {
    ($($(#[$note:meta])* $name:ident),+ $(,)?) => {
        $($(#[$note])*
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        pub struct $name(pub Held);

        impl Holder for $name {
            fn held(&self) -> &Held {
                &self.0
            }
        }

        impl From<Held> for $name {
            fn from(held: Held) -> Self {
                $name(held)
            }
        })+
    };
}

/// The data of an activity in which a robot holds a post.
pub(super) trait Holder {
    /// What is held.
    fn held(&self) -> &Held;
}

duties_with_a_post! {
    /// The data of [`Activity::Standby`].
    Standby,
    /// The data of [`Activity::Relay`].
    Relay,
    /// The data of [`Activity::Junction`].
    Junction,
    /// The data of [`Activity::Leaf`].
    Leaf,
    /// The data of [`Activity::Bound`].
    Bound,
    /// The data of [`Activity::Following`].
    Following,
    /// The data of [`Activity::Leading`].
    Leading,
}

/// The data of [`Activity::Waiting`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waiting {
    /// What it holds.
    pub held: Held,
    /// Its place on Σ.
    pub place: usize,
    /// The role that its post gives it.
    pub role: Role,
}

/// The data of [`Activity::AwaitingRelease`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AwaitingRelease {
    /// What it holds.
    pub held: Held,
    /// Its place on Σ, the last one.
    pub place: usize,
}

/// The data of [`Activity::Shifting`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shifting {
    /// The place of Σ that it left.
    pub place: usize,
    /// The post that it held there; none for the recruit, whose post is given up.
    pub left: Option<PostId>,
}

/// Where a duty leads its robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Course {
    /// Nowhere: the robot holds a post ([`Activity::AT_REST`]).
    AtPost,
    /// To the next place of Σ.
    AlongPath(Shifting),
    /// Where the primary team goes ([`Activity::IN_TEAM`]).
    WithTeam,
}

impl Duty {
    /// What the robot holds, if it holds a post.
    pub(super) const fn held(&self) -> Option<&Held> {
        match self {
            Duty::Standby(Standby(held))
            | Duty::Relay(Relay(held))
            | Duty::Junction(Junction(held))
            | Duty::Leaf(Leaf(held))
            | Duty::Bound(Bound(held))
            | Duty::Following(Following(held))
            | Duty::Leading(Leading(held))
            | Duty::Waiting(Waiting { held, .. })
            | Duty::AwaitingRelease(AwaitingRelease { held, .. }) => Some(held),
            Duty::Shifting(_) => None,
        }
    }

    /// The same duty of a robot that handed over the post `left` for it.
    #[must_use]
    pub(super) fn taken_over(mut self, left: Option<PostId>) -> Self {
        match &mut self {
            Duty::Standby(Standby(held))
            | Duty::Relay(Relay(held))
            | Duty::Junction(Junction(held))
            | Duty::Leaf(Leaf(held))
            | Duty::Bound(Bound(held))
            | Duty::Following(Following(held))
            | Duty::Leading(Leading(held))
            | Duty::Waiting(Waiting { held, .. })
            | Duty::AwaitingRelease(AwaitingRelease { held, .. }) => held.left = left,
            Duty::Shifting(shifting) => shifting.left = left,
        }
        self
    }

    /// The station held, if any.
    pub const fn station(&self) -> Option<&Station> {
        match self.held() {
            Some(held) => Some(&held.station),
            None => None,
        }
    }

    /// The post held, if any.
    pub const fn post(&self) -> Option<&Post> {
        match self.held() {
            Some(held) => Some(&held.station.post),
            None => None,
        }
    }

    /// The post that the robot held before this duty and handed over to another robot.
    pub(super) const fn left(&self) -> Option<PostId> {
        match (self, self.held()) {
            (Duty::Shifting(shifting), _) => shifting.left,
            (_, Some(held)) => held.left,
            (_, None) => None,
        }
    }

    /// The place on Σ, of a robot that waits or is on its way along it.
    pub const fn place(&self) -> Option<usize> {
        match *self {
            Duty::Waiting(Waiting { place, .. })
            | Duty::AwaitingRelease(AwaitingRelease { place, .. })
            | Duty::Shifting(Shifting { place, .. }) => Some(place),
            Duty::Standby(_)
            | Duty::Relay(_)
            | Duty::Junction(_)
            | Duty::Leaf(_)
            | Duty::Bound(_)
            | Duty::Following(_)
            | Duty::Leading(_) => None,
        }
    }

    /// Where the duty leads its robot.
    pub(super) const fn course(&self) -> Course {
        match *self {
            Duty::Standby(_)
            | Duty::Relay(_)
            | Duty::Junction(_)
            | Duty::Leaf(_)
            | Duty::Bound(_)
            | Duty::Waiting(_)
            | Duty::AwaitingRelease(_) => Course::AtPost,
            Duty::Shifting(shifting) => Course::AlongPath(shifting),
            Duty::Following(_) | Duty::Leading(_) => Course::WithTeam,
        }
    }

    /// Whether the duty is to move with the primary team.
    pub fn is_primary(&self) -> bool {
        matches!(self.course(), Course::WithTeam)
    }

    /// Whether the robot holds the post of a redundant robot.
    pub fn is_redundant(&self) -> bool {
        self.post().is_some_and(Post::is_redundant)
    }

    /// Whether the robot is the elected leader and has yet to be released (L_b = 1).
    pub(super) const fn is_bound(&self) -> bool {
        matches!(self, Duty::Bound(_) | Duty::AwaitingRelease(_))
    }

    /// Whether the robot is the elected leader, released or not.
    pub(super) const fn leads(&self) -> bool {
        matches!(self, Duty::Leading(_)) || self.is_bound()
    }

    /// The role that the duty is in the paper's terms.
    pub(super) const fn role(&self) -> Role {
        match self {
            Duty::Standby(_) => Role::Redundant,
            Duty::Relay(_) | Duty::Following(_) => Role::Node,
            Duty::Junction(_) => Role::Junction,
            Duty::Leaf(_) => Role::Leaf,
            Duty::Bound(_) | Duty::AwaitingRelease(_) | Duty::Leading(_) => Role::Leader,
            Duty::Waiting(Waiting { place: 0, .. }) | Duty::Shifting(Shifting { place: 0, .. }) => {
                Role::Recruit
            }
            Duty::Waiting(Waiting { role, .. }) => *role,
            Duty::Shifting(_) => Role::Node,
        }
    }
}

/// A place of the path Σ with its reference position and where its robot stood at t_h.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathPlace {
    /// The reference position of the post there.
    #[serde(with = "wire")]
    pub reference: Point,
    /// x(t_h) of the robot there.
    #[serde(with = "wire")]
    pub position: Point,
}

/// The path Σ with its geometry.
pub(super) type Path = path::Path<PathPlace>;
/// One place of the path Σ with its geometry.
pub(super) type Hop = path::Hop<PathPlace>;
