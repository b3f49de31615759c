//! A mission in words: which events are telling, and how a sentence tells them.

use pleach_automaton::network::record::MissionEvent;

use super::marks::Mark;

/// What makes a moment worth a picture or a line across the curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moment {
    Elected,
    Stationary,
    Released,
    Joined,
    Serviced,
}

impl Moment {
    pub(super) const ALL: [Moment; 5] =
        [Moment::Elected, Moment::Stationary, Moment::Joined, Moment::Released, Moment::Serviced];

    /// What the legend of the curves says.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Moment::Elected => "leader elected",
            Moment::Stationary => "team is stuck",
            Moment::Joined => "recruit joins",
            Moment::Released => "leader released",
            Moment::Serviced => "task serviced",
        }
    }

    /// The mark above its line.
    pub(super) const fn mark(self) -> Mark {
        match self {
            Moment::Elected => Mark::Leader,
            Moment::Stationary => Mark::Node,
            Moment::Joined => Mark::Recruit,
            Moment::Released => Mark::Junction,
            Moment::Serviced => Mark::Leaf,
        }
    }
}

/// The kind of a telling event with the number that stands beside its mark (a task if it is
/// serviced, else a robot), or nothing for the others.
pub(super) fn moment(event: &MissionEvent) -> Option<(Moment, usize)> {
    match event {
        MissionEvent::LeaderElected { robot, .. } => Some((Moment::Elected, *robot)),
        MissionEvent::Stationary { robot, .. } => Some((Moment::Stationary, *robot)),
        MissionEvent::JoinedPrimary { robot, .. } => Some((Moment::Joined, *robot)),
        MissionEvent::Released { robot } => Some((Moment::Released, *robot)),
        MissionEvent::TaskServiced { task, .. } => Some((Moment::Serviced, *task)),
        _ => None,
    }
}

/// A telling event in a few words.
pub(super) fn headline(event: &MissionEvent) -> Option<String> {
    let words = match event {
        MissionEvent::LeaderElected { robot, .. } => format!("robot {robot} is elected leader"),
        MissionEvent::Stationary { .. } => "the primary team is stuck".to_owned(),
        MissionEvent::JoinedPrimary { robot, .. } => format!("robot {robot} joins the team"),
        MissionEvent::Released { robot } => format!("robot {robot} is released"),
        MissionEvent::TaskServiced { robot, .. } => format!("serviced by robot {robot}"),
        _ => return None,
    };
    Some(words)
}

/// A telling event as a part of a file name.
pub(super) fn slug(event: &MissionEvent) -> Option<String> {
    let words = match event {
        MissionEvent::LeaderElected { robot, .. } => format!("leader-{robot}-elected"),
        MissionEvent::Stationary { robot, .. } => format!("stationary-at-{robot}"),
        MissionEvent::JoinedPrimary { robot, .. } => format!("recruit-{robot}-joined"),
        MissionEvent::Released { robot } => format!("leader-{robot}-released"),
        MissionEvent::TaskServiced { .. } => "serviced".to_owned(),
        _ => return None,
    };
    Some(words)
}

/// The task that an event names.
pub(super) fn task_of(event: &MissionEvent) -> Option<usize> {
    match event {
        MissionEvent::LeaderElected { task, .. } | MissionEvent::TaskServiced { task, .. } => {
            Some(*task)
        }
        _ => None,
    }
}

/// An event as a sentence; changes of role are left out, the pictures show them.
pub(super) fn sentence(event: &MissionEvent) -> Option<String> {
    let sentence = match event {
        MissionEvent::TaskAnnounced { task } => format!("Task {task} is announced."),
        MissionEvent::LeaderElected { task, robot, conflict: false } => {
            format!("Robot {robot} is elected leader for task {task}.")
        }
        MissionEvent::LeaderElected { task, robot, conflict: true } => format!(
            "Robot {robot} is elected leader for task {task}; it still has a duty in the tree \
             and must be released first."
        ),
        MissionEvent::Stationary { robot, team } => format!(
            "The primary team ({}) can go no further without losing a link; robot {robot} is at \
             its end towards the tree.",
            list(team)
        ),
        MissionEvent::RecruitElected { robot, path, break_points } => format!(
            "Robot {robot} is recruited; help comes along {}, with break points {}.",
            chain(path),
            list(break_points)
        ),
        MissionEvent::SubgroupStarted { subgroup, robots } => {
            format!("Subgroup {subgroup} ({}) starts to move.", list(robots))
        }
        MissionEvent::SubgroupArrived { subgroup, robots } => {
            format!("Subgroup {subgroup} ({}) has arrived.", list(robots))
        }
        MissionEvent::JoinedPrimary { robot, team } => {
            format!("Robot {robot} joins the primary team: {}.", chain(team))
        }
        MissionEvent::Released { robot } => {
            format!("Leader {robot} is released from its past duties.")
        }
        MissionEvent::RoleChanged { .. } => return None,
        MissionEvent::TaskServiced { task, robot } => {
            format!("Robot {robot} services task {task}.")
        }
        MissionEvent::RouteInfeasible { robot } => {
            format!("No routes carry the rates: the residual of robot {robot} falls too low.")
        }
        MissionEvent::DutiesExchanged { mover, parked } => {
            format!("Robot {parked} stands in the way of robot {mover}: they exchange duties.")
        }
        MissionEvent::Reattached { robot, parent } => {
            format!("Robot {robot} hangs itself on node {parent}.")
        }
        MissionEvent::ElectionRepeated { task } => {
            format!(
                "The leader's tree has no recruit left: the election for task {task} is repeated."
            )
        }
    };
    Some(sentence)
}

/// "2, 5 and 7".
fn list(robots: &[usize]) -> String {
    let words: Vec<String> = robots.iter().map(usize::to_string).collect();
    match words.as_slice() {
        [] => "none".to_owned(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// "2 → 5 → 7".
fn chain(robots: &[usize]) -> String {
    let words: Vec<String> = robots.iter().map(usize::to_string).collect();
    words.join(" → ")
}
