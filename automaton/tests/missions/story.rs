//! What robots decide in a mission, one line a decision.

use pleach_automaton::network::record::MissionEvent;

/// The decisions in their order.
pub fn story<'e>(events: impl IntoIterator<Item = &'e MissionEvent>) -> String {
    events.into_iter().filter_map(tell).collect::<Vec<_>>().join("\n")
}

fn list(robots: &[usize]) -> String {
    robots.iter().map(usize::to_string).collect::<Vec<_>>().join("-")
}

fn tell(event: &MissionEvent) -> Option<String> {
    use MissionEvent as On;
    Some(match event {
        On::LeaderElected { task, robot, conflict } => {
            let past = if *conflict { ", to be released" } else { "" };
            format!("{robot} leads to task {task}{past}")
        }
        On::Stationary { team, .. } => format!("{} stand still", list(team)),
        On::RecruitCalled { robot } => format!("{robot} calls"),
        On::CalledInVain { robot } => format!("{robot} calls in vain"),
        On::LinksStretched { robot } => format!("{robot} stretches links"),
        On::RecruitElected { path, break_points, .. } => {
            format!("{} shift, breaking at {}", list(path), list(break_points))
        }
        On::SubgroupArrived { subgroup, robots } => {
            format!("subgroup {subgroup} arrives: {}", list(robots))
        }
        On::JoinedPrimary { team, .. } => format!("{} go on", list(team)),
        On::Released { robot } => format!("{robot} is released"),
        On::TaskServiced { task, robot } => format!("{robot} services task {task}"),
        On::DutiesExchanged { mover, parked } => format!("{mover} and {parked} exchange"),
        On::Reattached { robot, parent } => format!("{robot} attaches to {parent}"),
        On::ElectionRepeated { task } => format!("others may lead to task {task}"),
        On::TaskReannounced { task, gone, joined } => {
            let change = |word: &str, robots: &[usize]| match robots {
                [] => String::new(),
                robots => format!(" {word} {}", list(robots)),
            };
            format!("task {task} anew{}{}", change("without", gone), change("with", joined))
        }
        On::RouteInfeasible { robot } => format!("{robot} is overloaded"),
        On::RoleChanged { robot, from, to } => format!("{robot}: {} to {}", from.name(), to.name()),
        MissionEvent::TaskGivenUp { task, outcome, .. } => {
            format!("task {task} is given up: {}", outcome.name())
        }
        _ => return None,
    })
}
