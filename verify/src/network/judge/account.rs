//! An observer's account of why a mission ended: the [`Certificate`] that goes with its end.
//!
//! What the robots have not told, it looks for in the last instants of the record. Whether it is true,
//! [`certificate`](super::certificate) says, which shares with it the record, the geometry and what counts as near.

use pleach_automaton::network::certificate::{
    Attempt, Because, Bound, Certificate, Hindrance, Other, Standing, Unreachable,
};
use pleach_automaton::network::record::{Outcome, Snapshot};
use pleach_discrete::network::Role;

use super::Judge;
use super::certificate::{AT_LIMIT, PASSAGE, SATURATED, SPENT, TOUCHED};
use super::ground::Ground;
use super::ledger::Stage;
use super::verdicts::{Trial, missing, parent_of, tree_of};
use crate::network::bound::Spans;

/// The certificate of a task that is given up, or of a mission.
pub(super) fn of(judge: &Judge, outcome: Outcome, task: Option<usize>) -> Option<Certificate> {
    let last = judge.previous.as_ref()?;
    match outcome {
        Outcome::UnreachableTask => unreachable(judge, task?).map(Certificate::Unreachable),
        Outcome::InsufficientRobots => {
            bound(judge).map(Certificate::Bound).or_else(|| Some(tried(judge, last)))
        }
        Outcome::Blocked if judge.ledger.stage() == Stage::Calling => Some(tried(judge, last)),
        Outcome::Blocked => Some(Certificate::Blocked { team: team(judge, last) }),
        _ => None,
    }
}

fn unreachable(judge: &Judge, task: usize) -> Option<Unreachable> {
    let limits = judge.monitor.limits();
    let ground = Ground::of(&judge.scenario, limits)?;
    let place = limits.tasks()[task];
    let nearest = ground.nearest_reached(place)?;
    let reach = limits.settings().leash_radius();
    let other = ground.nearest(place);
    let is_elsewhere = (other - place).norm() <= reach && !ground.is_reached(other);
    Some(Unreachable {
        nearest: nearest.into(),
        distance: (nearest - place).norm(),
        reach,
        elsewhere: is_elsewhere.then(|| other.into()),
    })
}

fn bound(judge: &Judge) -> Option<Bound> {
    let tasks = judge.tasks_together();
    let least = missing(&judge.scenario, &tasks)?;
    let spans = Spans::as_the_crow_flies(&judge.scenario);
    Some(Bound {
        length: spans.least_length(&tasks),
        longest_link: spans.longest_link(),
        least,
        robots: judge.scenario.robot.len(),
    })
}

fn tried(judge: &Judge, last: &Snapshot) -> Certificate {
    let trials = judge.tried.trials().iter().cloned();
    let attempts = trials.chain(judge.last_trial()).map(|trial| attempt(&trial)).collect();
    Certificate::Tried { attempts, team: team(judge, last) }
}

fn attempt(trial: &Trial) -> Attempt {
    let robots = 0..trial.snapshot.roles.len();
    let others = robots.filter(|robot| !trial.team.contains(robot));
    Attempt {
        k: trial.snapshot.step,
        caller: trial.caller,
        root: root_of(trial.caller, &trial.snapshot),
        stretched: trial.stretched,
        then: trial.then,
        others: others
            .map(|robot| Other { robot, because: because(robot, &trial.snapshot) })
            .collect(),
    }
}

/// The access point, as a node, at the root of the tree that a robot is in.
fn root_of(robot: usize, snapshot: &Snapshot) -> Option<usize> {
    tree_of(robot, snapshot).map(|access_point| snapshot.roles.len() + access_point)
}

fn because(robot: usize, snapshot: &Snapshot) -> Because {
    if snapshot.roles[robot] == Role::Redundant {
        return Because::Apart { root: root_of(robot, snapshot) };
    }
    if let Some(&(task, _)) = snapshot.serviced.iter().find(|(_, holder)| *holder == robot) {
        return Because::Services { task };
    }
    let children = snapshot.tree.iter().filter(|(_, parent)| *parent == robot);
    let mut children: Vec<usize> = children.map(|(child, _)| *child).collect();
    children.sort_unstable();
    if children.is_empty() { Because::Holds } else { Because::Bears { children } }
}

/// The robots that were on the move, or should have been.
fn team(judge: &Judge, last: &Snapshot) -> Vec<Standing> {
    let ledger = &judge.ledger;
    let team = match ledger.active_team() {
        [] => &ledger.primary_team,
        active => active,
    };
    let ground = Ground::of(&judge.scenario, judge.monitor.limits());
    (team.iter())
        .map(|&robot| Standing {
            robot,
            position: last.positions[robot].into(),
            target: judge.headings[robot].map(Into::into),
            hindrances: hindrances(judge, ground.as_ref(), robot, last),
        })
        .collect()
}

fn hindrances(
    judge: &Judge,
    ground: Option<&Ground>,
    robot: usize,
    last: &Snapshot,
) -> Vec<Hindrance> {
    let limits = judge.monitor.limits();
    let clearance = limits.settings().planning_clearance();
    let here = last.positions[robot];
    let others = (0..last.positions.len()).filter(|&other| other != robot);
    let mut found: Vec<Hindrance> = others
        .map(|other| (other, (last.positions[other] - here).norm()))
        .filter(|(_, distance)| *distance <= PASSAGE * clearance)
        .map(|(other, distance)| Hindrance::Robot {
            robot: other,
            distance,
            stopped: last.absent.contains(&other),
        })
        .collect();
    let bodies = judge.bodies.iter().map(|body| (body, (body - here).norm()));
    let near = bodies.filter(|(_, distance)| *distance <= PASSAGE * clearance);
    found.extend(near.map(|(&body, distance)| Hindrance::Body { position: body.into(), distance }));
    let wall = limits.workspace().clearance(here);
    found.extend((wall <= TOUCHED * clearance).then_some(Hindrance::Wall { distance: wall }));
    let limit = judge.link_limit();
    let ends = parent_of(robot, last)
        .into_iter()
        .chain(last.tree.iter().filter(|(_, parent)| *parent == robot).map(|(child, _)| *child));
    found.extend(ground.into_iter().flat_map(|ground| {
        let length = |to: usize| (to, ground.length(robot, to, last));
        let at_limit = |(to, length): (usize, f64)| {
            (length >= AT_LIMIT * limit).then_some(Hindrance::Link { to, length, limit })
        };
        ends.clone().map(length).filter_map(at_limit)
    }));
    let load = load_of(robot, last);
    let residual = last.residuals[robot];
    let spent = residual < SPENT * limits.settings().routing_reserve;
    if load >= SATURATED || load > 0.0 && spent {
        found.push(Hindrance::Load { load, residual });
    }
    let senders = last.routes.iter().filter(|it| it.to == robot && it.share > 0.0);
    let loads = senders.map(|it| (it.from, load_of(it.from, last)));
    let busy = loads.filter(|&(_, load)| load >= SATURATED);
    found.extend(busy.map(|(robot, load)| Hindrance::Sender { robot, load }));
    found
}

/// Σ_j T_ij: for which share of the time a robot sends.
pub(super) fn load_of(robot: usize, last: &Snapshot) -> f64 {
    last.routes.iter().filter(|it| it.from == robot).map(|it| it.share).sum()
}
