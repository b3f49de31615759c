//! What shows that a mission had to end before its tasks are serviced.
//!
//! Robots decide by what they know themselves, and say why in a sentence. A certificate is an *observer's
//! account* of the same: claims about the record, each of which can be checked from the record alone by a
//! program that knows nothing of the robots' rules, only of places, the tree, roles, ranges and walls.
//! Nodes are numbered as in the record: robots from 0, then access points. Lengths are in the scenario's unit.

use serde::{Deserialize, Serialize};

/// Why a mission ended, in claims that can be checked.
///
/// Written out, it is a table whose `kind` is the name of the variant in snake case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Certificate {
    /// No robot can come near enough to the task.
    Unreachable(Unreachable),
    /// Any tree to the tasks takes more robots than there are, wherever they stand.
    Bound(Bound),
    /// No robot could come whenever one was called for. That robots are too few is not proved by that: it
    /// is the list of the ways tried.
    Tried {
        /// Each call for a recruit that none could answer since the task was announced; the last one ended
        /// the mission.
        attempts: Vec<Attempt>,
        /// The robots that could not go on.
        team: Vec<Standing>,
    },
    /// The active team stands still, and a recruit would not help.
    Blocked {
        /// The robots that could not go on.
        team: Vec<Standing>,
    },
}

/// How near robots can come to a task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unreachable {
    /// The place nearest to the task of all to which a way leads from where a robot started.
    pub nearest: [f64; 2],
    /// From there to the task.
    pub distance: f64,
    /// The distance from which a robot could service the task; less than `distance`.
    pub reach: f64,
    /// A place that is near enough, and to which no way leads, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elsewhere: Option<[f64; 2]>,
}

/// How many robots any tree takes, by lengths alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bound {
    /// No tree that joins the access points with the tasks announced is shorter.
    pub length: f64,
    /// No link of a tree is longer.
    pub longest_link: f64,
    /// The least number of robots of any tree; more than `robots`.
    pub least: usize,
    /// How many there are.
    pub robots: usize,
}

/// A call for a recruit that no robot could answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Attempt {
    /// The last instant before it was given up.
    pub k: usize,
    /// The robot that called.
    pub caller: usize,
    /// The access point in whose tree it was, if any.
    pub root: Option<usize>,
    /// Whether links were stretched already when it called.
    pub stretched: bool,
    /// What came of it.
    pub then: Then,
    /// Every robot that is not of the team that called, in order, and why it could not come.
    pub others: Vec<Other>,
}

/// What came of a call that no robot could answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Then {
    /// The election was repeated among robots of other trees, or whose posts can move.
    ElectionRepeated,
    /// The team went on with longer links.
    LinksStretched,
    /// The mission ended.
    Ended,
}

/// A robot that could not come.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Other {
    /// The robot.
    pub robot: usize,
    /// Why it could not.
    #[serde(flatten)]
    pub because: Because,
}

/// Why a robot could not come.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "because", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Because {
    /// It services a task.
    Services {
        /// The task.
        task: usize,
    },
    /// Others depend on its post: their links lead through it.
    Bears {
        /// They, ascending.
        children: Vec<usize>,
    },
    /// It holds a post that bears nothing.
    Holds,
    /// It is redundant, but no tree connects it to the caller.
    Apart {
        /// The access point in whose tree it is, if any.
        root: Option<usize>,
    },
}

/// A robot that could not go on, with what was in its way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Standing {
    /// The robot.
    pub robot: usize,
    /// Where it stands.
    pub position: [f64; 2],
    /// Where it went last, if the record says so.
    pub target: Option<[f64; 2]>,
    /// What was found in its way; nothing for a robot that waits for others.
    pub hindrances: Vec<Hindrance>,
}

/// Something that may keep a robot where it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "by", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Hindrance {
    /// A robot at most 4ρ away, so that nothing passes between the two.
    Robot {
        /// The other robot.
        robot: usize,
        /// How far away it is.
        distance: f64,
        /// Whether it does not run or is not heard.
        stopped: bool,
    },
    /// A robot of another access point at most 4ρ away.
    Body {
        /// Where it is.
        position: [f64; 2],
        /// How far away it is.
        distance: f64,
    },
    /// A wall at most 1.2ρ away.
    Wall {
        /// How far away it is.
        distance: f64,
    },
    /// A link of the tree that is at its limit, along the shortest way around walls.
    Link {
        /// The other end.
        to: usize,
        /// How long it is: at least 0.95 `limit`.
        length: f64,
        /// Up to which length links are made.
        limit: f64,
    },
    /// It sends nearly all the time, or has next to nothing left as its residual.
    Load {
        /// For which share of the time it sends.
        load: f64,
        /// What is left of what it could send on.
        residual: f64,
    },
    /// A robot that sends to it, and nearly all the time: it objects to moves after which that takes longer.
    Sender {
        /// The other robot.
        robot: usize,
        /// For which share of the time it sends, to this robot and to others.
        load: f64,
    },
}

impl Certificate {
    /// The name of its kind in traces.
    pub const fn name(&self) -> &'static str {
        match self {
            Certificate::Unreachable(_) => "unreachable",
            Certificate::Bound(_) => "bound",
            Certificate::Tried { .. } => "tried",
            Certificate::Blocked { .. } => "blocked",
        }
    }
}
