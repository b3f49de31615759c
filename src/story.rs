//! The story of a mission: each event as a sentence, and the moments that figures mark.

use crate::automaton::network::phrase;
use crate::automaton::network::record::MissionEvent;

/// What makes a moment worth a picture, and a mark across curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Moment {
    /// A leader is elected.
    Elected,
    /// The primary team is at a stationary point.
    Stationary,
    /// A recruit joins the primary team.
    Joined,
    /// The leader is released from its past duties.
    Released,
    /// A task is serviced.
    Serviced,
}

/// A telling event in a few words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Caption {
    /// What kind of moment it is.
    pub moment: Moment,
    /// The robot concerned, or the task that is serviced.
    pub number: usize,
    /// What a title says.
    pub headline: String,
    /// What the name of a file says.
    pub slug: String,
}

impl Moment {
    /// Every kind of moment, in the order of legends.
    pub const ALL: [Moment; 5] =
        [Moment::Elected, Moment::Stationary, Moment::Joined, Moment::Released, Moment::Serviced];

    /// What legends say.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Moment::Elected => "leader elected",
            Moment::Stationary => "stationary point",
            Moment::Joined => "recruit joins",
            Moment::Released => "leader released",
            Moment::Serviced => "task serviced",
        }
    }
}

/// What is told of a team whose task is taken back, or whose leader stops, in the control period of the event: events
/// name teams as they are at its end.
const LEADERLESS: &str = "which has no leader at the end of the control period";

/// Tells an event as a sentence without its end; robots and tasks are numbered from 0.
#[must_use]
pub fn tell(event: &MissionEvent) -> String {
    telling(event).0
}

/// The few words for an event that makes a moment.
#[must_use]
pub fn caption(event: &MissionEvent) -> Option<Caption> {
    telling(event).1
}

/// Whether an event moves the story on. Changes of a single robot's role or place in the tree
/// are details.
#[must_use]
pub fn is_telling(event: &MissionEvent) -> bool {
    !matches!(event, MissionEvent::RoleChanged { .. } | MissionEvent::Reattached { .. })
}

/// The task that an event names, if it makes a moment.
pub(crate) fn task_of(event: &MissionEvent) -> Option<usize> {
    match event {
        MissionEvent::LeaderElected { task, .. } | MissionEvent::TaskServiced { task, .. } => {
            Some(*task)
        }
        _ => None,
    }
}

/// The table of events: the sentence, and for moments the caption.
fn telling(event: &MissionEvent) -> (String, Option<Caption>) {
    let moment = |moment, number: &usize, headline: String, slug: String| {
        Some(Caption { moment, number: *number, headline, slug })
    };
    match event {
        MissionEvent::TaskAnnounced { task } => (format!("task {task} is announced"), None),
        MissionEvent::LeaderElected { task, robot, conflict } => (
            match conflict {
                false => format!("robot {robot} is elected to lead to task {task}"),
                true => {
                    format!("robot {robot} is elected to lead to task {task} and has past duties")
                }
            },
            moment(
                Moment::Elected,
                robot,
                format!("robot {robot} is elected leader"),
                format!("leader-{robot}-elected"),
            ),
        ),
        MissionEvent::Stationary { robot, team } => (
            match team.as_slice() {
                [] => format!("the team of robot {robot} is at a stationary point, {LEADERLESS}"),
                team => format!("the primary team {} is at a stationary point", list(team)),
            },
            moment(
                Moment::Stationary,
                robot,
                "the primary team is at a stationary point".to_owned(),
                format!("stationary-at-{robot}"),
            ),
        ),
        MissionEvent::RecruitCalled { robot } => {
            (format!("robot {robot} calls for a recruit: the team is too short for the way"), None)
        }
        MissionEvent::CalledInVain { .. } => {
            ("no recruit can come: the primary team goes on as it is".to_owned(), None)
        }
        MissionEvent::LinksStretched { .. } => {
            ("no recruit can come: the primary team stretches its links".to_owned(), None)
        }
        MissionEvent::RecruitElected { robot, path, break_points } => (
            format!(
                "robot {robot} is recruited along path {}, split at {}",
                chain(path),
                phrase::listed(break_points)
            ),
            None,
        ),
        MissionEvent::SubgroupStarted { subgroup, robots } => {
            (format!("subgroup {subgroup}, {}, starts", list(robots)), None)
        }
        MissionEvent::SubgroupArrived { subgroup, robots } => {
            (format!("subgroup {subgroup}, {}, has arrived", list(robots)), None)
        }
        MissionEvent::JoinedPrimary { robot, team } => (
            match team.as_slice() {
                [] => format!("robot {robot} joins the primary team, {LEADERLESS}"),
                team => format!("robot {robot} joins the primary team, now {}", list(team)),
            },
            moment(
                Moment::Joined,
                robot,
                format!("robot {robot} joins the primary team"),
                format!("recruit-{robot}-joined"),
            ),
        ),
        MissionEvent::Released { robot } => (
            format!("robot {robot} is released from its duties"),
            moment(
                Moment::Released,
                robot,
                format!("robot {robot} is released"),
                format!("leader-{robot}-released"),
            ),
        ),
        MissionEvent::RoleChanged { robot, from, to } => {
            (format!("robot {robot} changes from {} to {}", from.name(), to.name()), None)
        }
        MissionEvent::TaskServiced { task, robot } => (
            format!("task {task} is serviced by robot {robot}"),
            moment(
                Moment::Serviced,
                task,
                format!("serviced by robot {robot}"),
                "serviced".to_owned(),
            ),
        ),
        MissionEvent::RouteInfeasible { robot } => {
            (format!("no routing carries the traffic of robot {robot}"), None)
        }
        MissionEvent::DutiesExchanged { mover, parked } => {
            (format!("robots {mover} and {parked} exchange their duties"), None)
        }
        MissionEvent::Reattached { robot, parent } => {
            (format!("robot {robot} attaches to node {parent}"), None)
        }
        MissionEvent::ElectionRepeated { task } => (
            format!(
                "no recruit can come for task {task}: the election is repeated among robots that may do \
                 without"
            ),
            None,
        ),
        MissionEvent::TaskReannounced { task, gone, joined } => {
            let gone = match gone[..] {
                [] => String::new(),
                _ => format!("{} not answer any more: ", phrase::robots(gone, ["does", "do"])),
            };
            let joined = match joined[..] {
                [] => String::new(),
                _ => {
                    format!(", and {} part from now on", phrase::robots(joined, ["takes", "take"]))
                }
            };
            (format!("{gone}task {task} is announced again{joined}"), None)
        }
        MissionEvent::TaskEnded { task } => {
            (format!("task {task} has ended: it was serviced for as long as it was to be"), None)
        }
        MissionEvent::TaskWithdrawn { task } => (format!("task {task} is taken back"), None),
        MissionEvent::TaskGivenUp { task, reason, .. } => {
            (format!("task {task} is given up: {reason}"), None)
        }
        other => (format!("{other:?}"), None),
    }
}

/// "[2 5 7]".
fn list(robots: &[usize]) -> String {
    format!("[{}]", joined(robots, " "))
}

/// "2→5→7".
fn chain(robots: &[usize]) -> String {
    joined(robots, "→")
}

fn joined(robots: &[usize], between: &str) -> String {
    robots.iter().map(usize::to_string).collect::<Vec<_>>().join(between)
}
