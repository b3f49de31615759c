//! Spoiled records of Study I, each wrong in one respect, with the properties that may fail.

use super::change::Record;
use nalgebra::Point2;
use pleach::automaton::network::record::MissionEvent as Event;
use pleach::discrete::network::{Activity, Phase, Role};
use pleach::verify::network::Property;

pub type Spoil = (&'static str, fn(&mut Record), &'static [Property]);

/// A control period in which two tasks are serviced and a third is pursued by the primary team.
const LATE: usize = 600;

/// The first control period with an event of a kind.
fn first(record: &Record, kind: fn(&Event) -> bool) -> usize {
    record.periods.iter().position(|period| period.events.iter().any(kind)).unwrap()
}

pub const ALL: [Spoil; 27] = [
    (
        "no task is ever held",
        |record| record.from(0).for_each(|now| now.serviced.clear()),
        &[Property::Duties, Property::Posts],
    ),
    (
        "no robot records the tasks that it services",
        |record| {
            for now in record.from(0) {
                now.serviced.clear();
                now.posts.iter_mut().for_each(|post| post.task = None);
            }
        },
        &[Property::Duties],
    ),
    (
        "every robot may move",
        |record| record.from(0).for_each(|now| now.active = (0..13).collect()),
        &[Property::ActiveTeam],
    ),
    (
        "the active team is empty",
        |record| record.from(0).for_each(|now| now.active_team.clear()),
        &[Property::ActiveTeam],
    ),
    (
        "two teams are active at once",
        |record| {
            for now in record.from(0).filter(|now| now.active_team != now.primary_team) {
                now.active_team.extend(&now.primary_team);
                now.active.extend(&now.primary_team);
                now.active.sort_unstable();
                now.active.dedup();
            }
        },
        &[Property::ActiveTeam],
    ),
    (
        "there are no posts",
        |record| record.from(0).for_each(|now| now.posts.clear()),
        &[Property::Posts],
    ),
    (
        "no post is a junction",
        |record| {
            for now in record.from(0) {
                now.posts.iter_mut().for_each(|post| post.junction = false);
            }
        },
        &[Property::Posts],
    ),
    (
        "the posts of junctions are dropped",
        |record| record.from(0).for_each(|now| now.posts.retain(|post| !post.junction)),
        &[Property::Posts],
    ),
    (
        "the tree is empty and every robot redundant",
        |record| {
            for now in record.from(0) {
                now.tree.clear();
                now.roles.fill(Role::Redundant);
                now.robots.iter_mut().for_each(|robot| robot.activity = Activity::Standby);
            }
            for period in &mut record.periods {
                period.events.retain(|event| !matches!(event, Event::RoleChanged { .. }));
            }
        },
        &[Property::LeaderLast, Property::Teams],
    ),
    (
        "the robot that answers for a task is redundant and has no parent",
        |record| {
            for now in record.from(LATE) {
                let robot = now.serviced[0].1;
                now.roles[robot] = Role::Redundant;
                now.robots[robot].activity = Activity::Standby;
                now.tree.retain(|&(child, _)| child != robot);
            }
        },
        &[Property::RoleTransition, Property::Duties],
    ),
    (
        "multipliers are negative",
        |record| record.from(0).for_each(|now| now.multipliers.fill(-1.0)),
        &[Property::Multipliers],
    ),
    (
        "the task is another",
        |record| record.from(0).for_each(|now| now.task = now.task.map(|task| (task + 1) % 3)),
        &[Property::Stage],
    ),
    (
        "no task is pursued",
        |record| record.from(0).for_each(|now| now.task = None),
        &[Property::Stage],
    ),
    (
        "the phase is “idle”",
        |record| record.from(0).for_each(|now| now.phase = Phase::Idle),
        &[Property::Stage],
    ),
    (
        "the phase is “advance”",
        |record| record.from(0).for_each(|now| now.phase = Phase::Advance),
        &[Property::Stage],
    ),
    (
        "time is scaled by 10⁻⁹",
        |record| record.from(0).for_each(|now| now.time *= 1e-9),
        &[Property::Record],
    ),
    (
        "a task is said to be serviced when it is not",
        |record| {
            let task = record.at(LATE).task.unwrap();
            let robot = *record.at(LATE).primary_team.last().unwrap();
            record.events(LATE).push(Event::TaskServiced { task, robot });
        },
        &[Property::Events],
    ),
    (
        "another robot is said to be elected leader",
        |record| {
            let site = first(record, |event| matches!(event, Event::LeaderElected { .. }));
            for event in record.events(site) {
                if let Event::LeaderElected { robot, .. } = event {
                    *robot = 0;
                }
            }
        },
        &[Property::Events, Property::Teams],
    ),
    (
        "a leader is elected while one leads",
        |record| {
            let task = record.at(LATE).task.unwrap();
            record.events(LATE).push(Event::LeaderElected { task, robot: 0, conflict: false });
        },
        &[Property::Events],
    ),
    (
        "a task is announced twice",
        |record| {
            let site = first(record, |event| matches!(event, Event::TaskAnnounced { .. }));
            record.events(site).push(Event::TaskAnnounced { task: 0 });
        },
        &[Property::Events],
    ),
    (
        "robots far apart exchange duties",
        |record| {
            let mover = record.at(LATE).active_team[0];
            let parked =
                record.at(LATE).roles.iter().position(|it| *it == Role::Redundant).unwrap();
            record.events(LATE).push(Event::DutiesExchanged { mover, parked });
        },
        &[Property::Events],
    ),
    (
        "break points are one short",
        |record| {
            for period in &mut record.periods {
                for event in &mut period.events {
                    if let Event::RecruitElected { break_points, .. } = event {
                        break_points.pop();
                    }
                }
            }
        },
        &[Property::Subgroups],
    ),
    ("a robot leaps", |record| record.at(LATE).positions[0].x += 0.02, &[Property::StepLength]),
    (
        "two robots are in one place",
        |record| {
            let place: Point2<f64> = record.at(LATE).positions[1];
            record.from(LATE).for_each(|now| now.positions[0] = place);
        },
        &[Property::Separation],
    ),
    (
        "a link is more reliable than it can be",
        |record| record.at(LATE).routes[0].reliability += 0.01,
        &[Property::Reliability],
    ),
    (
        "a residual is not that of the routes",
        |record| record.at(LATE).residuals[0] += 1e-3,
        &[Property::Accounting],
    ),
    (
        "a robot has two parents",
        |record| {
            let (child, parent) = record.at(LATE).tree[0];
            record.at(LATE).tree.push((child, usize::from(parent == 0)));
        },
        &[Property::SingleParent, Property::Record],
    ),
];
