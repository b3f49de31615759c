//! The story of a mission: each event as a sentence.

use crate::automaton::network::record::MissionEvent;

/// Tells an event as a sentence without its end, robots and tasks counted from 0.
pub fn tell(event: &MissionEvent) -> String {
    match event {
        MissionEvent::TaskAnnounced { task } => format!("task {task} is announced"),
        MissionEvent::LeaderElected { task, robot, conflict: false } => {
            format!("robot {robot} is elected to lead to task {task}")
        }
        MissionEvent::LeaderElected { task, robot, conflict: true } => format!(
            "robot {robot} is elected to lead to task {task} and must first be released from its duties"
        ),
        MissionEvent::Stationary { robot, team } => {
            format!("the primary team {} is at a stationary point, robot {robot} last", list(team))
        }
        MissionEvent::RecruitElected { robot, path, break_points } => format!(
            "robot {robot} is recruited along {}, breaking at {}",
            list(path),
            list(break_points)
        ),
        MissionEvent::SubgroupStarted { subgroup, robots } => {
            format!("subgroup {subgroup}, {}, starts", list(robots))
        }
        MissionEvent::SubgroupArrived { subgroup, robots } => {
            format!("subgroup {subgroup}, {}, has arrived", list(robots))
        }
        MissionEvent::JoinedPrimary { robot, team } => {
            format!("robot {robot} joins the primary team, now {}", list(team))
        }
        MissionEvent::Released { robot } => format!("robot {robot} is released from its duties"),
        MissionEvent::RoleChanged { robot, from, to } => {
            format!("robot {robot} turns from {} to {}", from.name(), to.name())
        }
        MissionEvent::TaskServiced { task, robot } => {
            format!("task {task} is serviced by robot {robot}")
        }
        MissionEvent::RouteInfeasible { robot } => {
            format!("no routing carries what robot {robot} has to send")
        }
        MissionEvent::DutiesExchanged { mover, parked } => {
            format!("robots {mover} and {parked} exchange their duties")
        }
        MissionEvent::Reattached { robot, parent } => {
            format!("robot {robot} hangs itself on node {parent}")
        }
        MissionEvent::ElectionRepeated { task } => {
            format!("no recruit is left for task {task}: the election is repeated among the others")
        }
    }
}

/// Whether an event moves the story on. Changes of a single robot's role or place in the tree
/// are details.
pub fn is_telling(event: &MissionEvent) -> bool {
    !matches!(
        event,
        MissionEvent::RoleChanged { .. }
            | MissionEvent::Reattached { .. }
            | MissionEvent::DutiesExchanged { .. }
    )
}

fn list(robots: &[usize]) -> String {
    let numbers: Vec<_> = robots.iter().map(usize::to_string).collect();
    format!("[{}]", numbers.join(" "))
}
