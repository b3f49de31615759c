//! Changes of events: each kind is dropped, duplicated, delayed and renamed, and each is told
//! where it has not happened.

use super::change::{Change, Record, changes};
use pleach::automaton::network::record::MissionEvent as Event;
use pleach::discrete::network::Role;

type Kind = fn(&Event) -> bool;

fn drop_one(record: &mut Record, site: usize, kind: Kind) {
    if let Some(at) = record.events(site).iter().position(kind) {
        record.events(site).remove(at);
    }
}

fn duplicate(record: &mut Record, site: usize, kind: Kind) {
    if let Some(at) = record.events(site).iter().position(kind) {
        let event = record.events(site)[at].clone();
        record.events(site).insert(at, event);
    }
}

/// The event happens some control periods later.
fn delay(record: &mut Record, site: usize, kind: Kind) {
    const LATER: usize = 5;
    if let Some(at) = record.events(site).iter().position(kind)
        && site + LATER < record.periods.len()
    {
        let event = record.events(site).remove(at);
        record.events(site + LATER).push(event);
    }
}

/// Every number that an event of the kind holds is that of another robot, task or subgroup.
fn rename(record: &mut Record, site: usize, kind: Kind) {
    let robots = record.at(site).roles.len();
    let Some(event) = record.events(site).iter_mut().find(|event| kind(event)) else { return };
    let next = |robot: &mut usize| *robot = (*robot + 1) % robots;
    match event {
        Event::TaskAnnounced { task }
        | Event::TaskEnded { task }
        | Event::TaskWithdrawn { task }
        | Event::ElectionRepeated { task }
        | Event::TaskReannounced { task, .. } => {
            *task = usize::from(*task == 0);
        }
        Event::LeaderElected { robot, .. }
        | Event::Stationary { robot, .. }
        | Event::RecruitCalled { robot }
        | Event::CalledInVain { robot }
        | Event::LinksStretched { robot }
        | Event::RecruitElected { robot, .. }
        | Event::JoinedPrimary { robot, .. }
        | Event::Released { robot }
        | Event::RoleChanged { robot, .. }
        | Event::TaskServiced { robot, .. }
        | Event::RouteInfeasible { robot }
        | Event::Reattached { robot, .. } => next(robot),
        Event::DutiesExchanged { parked, .. } => next(parked),
        Event::SubgroupStarted { subgroup, .. } | Event::SubgroupArrived { subgroup, .. } => {
            *subgroup += 1;
        }
        other => panic!("no number of {other:?} is changed"),
    }
}

/// Changes the first event of a kind.
macro_rules! edit {
    ($record:ident, $site:ident, $pattern:pat => $make:expr) => {
        for event in $record.events($site) {
            if let $pattern = event {
                $make;
                break;
            }
        }
    };
}

macro_rules! of_kind {
    ($($name:literal: $pattern:pat,)+) => {
        &[$(
            Change {
                name: concat!($name, ": it is dropped"),
                make: |record, site| {
                    drop_one(record, site, |event| matches!(event, $pattern));
                },
            },
            Change {
                name: concat!($name, ": it is reported twice"),
                make: |record, site| duplicate(record, site, |event| matches!(event, $pattern)),
            },
            Change {
                name: concat!($name, ": it is reported five periods later"),
                make: |record, site| delay(record, site, |event| matches!(event, $pattern)),
            },
            Change {
                name: concat!($name, ": it is about another"),
                make: |record, site| rename(record, site, |event| matches!(event, $pattern)),
            },
        )+]
    };
}

pub const ALL: &[Change] = of_kind! {
    "task announced": Event::TaskAnnounced { .. },
    "leader elected": Event::LeaderElected { .. },
    "stationary": Event::Stationary { .. },
    "recruit elected": Event::RecruitElected { .. },
    "subgroup started": Event::SubgroupStarted { .. },
    "subgroup arrived": Event::SubgroupArrived { .. },
    "joined primary": Event::JoinedPrimary { .. },
    "released": Event::Released { .. },
    "role changed": Event::RoleChanged { .. },
    "task serviced": Event::TaskServiced { .. },
    "duties exchanged": Event::DutiesExchanged { .. },
    "reattached": Event::Reattached { .. },
};

/// A robot that is redundant and stands still.
fn idle(record: &mut Record, site: usize) -> Option<usize> {
    let now = record.at(site);
    (0..now.roles.len())
        .find(|robot| now.roles[*robot] == Role::Redundant && !now.active.contains(robot))
}

fn tell(record: &mut Record, site: usize, event: Event) {
    record.events(site).push(event);
}

pub const FALSE: &[Change] = changes! {
    "leader elected: the conflict is another" => |record, site| {
        edit!(record, site, Event::LeaderElected { conflict, .. } => *conflict = !*conflict);
    };
    "stationary: the team is emptied" => |record, site| {
        edit!(record, site, Event::Stationary { team, .. } => team.clear());
    };
    "recruit elected: a robot of the path is dropped" => |record, site| {
        edit!(record, site, Event::RecruitElected { path, .. } => path.remove(0));
    };
    "recruit elected: the path is in another order" => |record, site| {
        edit!(record, site, Event::RecruitElected { path, .. } => path.reverse());
    };
    "recruit elected: break points are one short" => |record, site| {
        edit!(record, site, Event::RecruitElected { break_points, .. } => break_points.pop());
    };
    "recruit elected: a break point between is dropped" => |record, site| {
        edit!(record, site, Event::RecruitElected { break_points, .. } => {
            if break_points.len() > 2 {
                break_points.remove(1);
            }
        });
    };
    "recruit elected: there is a break point more" => |record, site| {
        edit!(record, site, Event::RecruitElected { path, break_points, .. } => {
            let end = path.len() - 1;
            let more = path[..end].iter().position(|robot| !break_points.contains(robot));
            if let Some(place) = more {
                break_points.insert(place, path[place]);
            }
        });
    };
    "subgroup started: a robot is dropped" => |record, site| {
        edit!(record, site, Event::SubgroupStarted { robots, .. } => robots.pop());
    };
    "subgroup arrived: a robot is dropped" => |record, site| {
        edit!(record, site, Event::SubgroupArrived { robots, .. } => robots.pop());
    };
    "joined primary: the team is emptied" => |record, site| {
        edit!(record, site, Event::JoinedPrimary { team, .. } => team.clear());
    };
    "role changed: the role before is another" => |record, site| {
        edit!(record, site, Event::RoleChanged { from, .. } => {
            *from = if *from == Role::Node { Role::Leaf } else { Role::Node };
        });
    };
    "role changed: the role after is another" => |record, site| {
        edit!(record, site, Event::RoleChanged { to, .. } => {
            *to = if *to == Role::Node { Role::Junction } else { Role::Node };
        });
    };
    "reattached: the parent is another" => |record, site| {
        edit!(record, site, Event::Reattached { parent, .. } => *parent = usize::from(*parent == 0));
    };
    "false: the next task is announced" => |record, site| {
        if let Some(task) = record.at(site).task {
            tell(record, site, Event::TaskAnnounced { task: task + 1 });
        }
    };
    "false: a task is announced again" => |record, site| {
        if let Some(task) = record.at(site).task {
            tell(record, site, Event::TaskAnnounced { task });
        }
    };
    "false: a redundant robot is elected leader" => |record, site| {
        if let (Some(task), Some(robot)) = (record.at(site).task, idle(record, site)) {
            tell(record, site, Event::LeaderElected { task, robot, conflict: false });
        }
    };
    "false: the leader is elected again" => |record, site| {
        let now = record.at(site);
        if let (Some(task), Some(&robot)) = (now.task, now.primary_team.last()) {
            tell(record, site, Event::LeaderElected { task, robot, conflict: false });
        }
    };
    "false: the primary team is stationary" => |record, site| {
        let team = record.at(site).primary_team.clone();
        if let Some(&robot) = team.first() {
            tell(record, site, Event::Stationary { robot, team });
        }
    };
    "false: a redundant robot is recruited" => |record, site| {
        if let (Some(robot), Some(&first)) =
            (idle(record, site), record.at(site).primary_team.first())
        {
            let (path, break_points) = (vec![robot, first], vec![robot]);
            tell(record, site, Event::RecruitElected { robot, path, break_points });
        }
    };
    "false: a subgroup starts" => |record, site| {
        if let Some(robot) = idle(record, site) {
            tell(record, site, Event::SubgroupStarted { subgroup: 0, robots: vec![robot] });
        }
    };
    "false: a subgroup arrives" => |record, site| {
        if let Some(robot) = idle(record, site) {
            tell(record, site, Event::SubgroupArrived { subgroup: 0, robots: vec![robot] });
        }
    };
    "false: a robot joins the primary team" => |record, site| {
        if let Some(robot) = idle(record, site) {
            let mut team = record.at(site).primary_team.clone();
            team.insert(0, robot);
            tell(record, site, Event::JoinedPrimary { robot, team });
        }
    };
    "false: the leader is released" => |record, site| {
        if let Some(&robot) = record.at(site).primary_team.last() {
            tell(record, site, Event::Released { robot });
        }
    };
    "false: a redundant robot turns into a node" => |record, site| {
        if let Some(robot) = idle(record, site) {
            tell(record, site, Event::RoleChanged { robot, from: Role::Redundant, to: Role::Node });
        }
    };
    "false: a task is serviced" => |record, site| {
        let now = record.at(site);
        if let (Some(task), Some(&robot)) = (now.task, now.primary_team.last()) {
            tell(record, site, Event::TaskServiced { task, robot });
        }
    };
    "false: a serviced task is serviced again" => |record, site| {
        if let Some(&(task, robot)) = record.at(site).serviced.first() {
            tell(record, site, Event::TaskServiced { task, robot });
        }
    };
    "false: no route is feasible" => |record, site| {
        tell(record, site, Event::RouteInfeasible { robot: 0 });
    };
    "false: robots far apart exchange duties" => |record, site| {
        let mover = record.at(site).active_team.first().copied();
        if let (Some(mover), Some(parked)) = (mover, idle(record, site)) {
            tell(record, site, Event::DutiesExchanged { mover, parked });
        }
    };
    "false: p₁ attaches to the node that it is attached to" => |record, site| {
        let now = record.at(site);
        let first = now.primary_team.first().copied();
        if let Some(&(robot, parent)) = now.tree.iter().find(|(child, _)| Some(*child) == first) {
            tell(record, site, Event::Reattached { robot, parent });
        }
    };
    "false: the team stretches its links" => |record, site| {
        if let Some(&robot) = record.at(site).primary_team.first() {
            tell(record, site, Event::LinksStretched { robot });
        }
    };
    "false: a recruit is called for before the team stands still" => |record, site| {
        if let Some(&robot) = record.at(site).primary_team.first() {
            tell(record, site, Event::RecruitCalled { robot });
        }
    };
    "false: a call for a recruit was in vain" => |record, site| {
        if let Some(&robot) = record.at(site).primary_team.first() {
            tell(record, site, Event::CalledInVain { robot });
        }
    };
    "false: the election is repeated" => |record, site| {
        if let Some(task) = record.at(site).task {
            tell(record, site, Event::ElectionRepeated { task });
        }
    };
    "false: a task is announced again to those that are left" => |record, site| {
        if let Some(task) = record.at(site).task {
            tell(record, site, Event::TaskReannounced { task, gone: vec![0], joined: vec![] });
        }
    };
};
