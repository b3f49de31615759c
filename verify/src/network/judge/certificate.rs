//! Whether a [`Certificate`] is true of the record that it comes with.
//!
//! Each claim is held against places, tree, roles, ranges and walls. What a certificate has to contain is
//! checked as well: every robot that did not come is accounted for, and every call that failed.

use std::collections::BTreeSet;

use pleach_automaton::network::certificate::{
    Attempt, Because, Bound, Certificate, Hindrance, Other, Standing, Then, Unreachable,
};
use pleach_automaton::network::record::{End, Outcome, Route, Snapshot};
use pleach_continuous::Point;
use pleach_discrete::network::Role;

use super::Judge;
use super::account::load_of;
use super::ground::Ground;
use super::ledger::Stage;
use super::terms::all_stay;
use super::verdicts::{Trial, tree_of};
use crate::network::bound::Spans;
use crate::network::limits::SLACK;

/// Between robots this many ρ apart, or nearer, no third one passes.
pub(super) const PASSAGE: f64 = 4.0;
/// A robot this many ρ from a wall, or nearer, is at it.
pub(super) const TOUCHED: f64 = 1.2;
/// A link is at its limit from this share of it on.
pub(super) const AT_LIMIT: f64 = 0.95;
/// A robot that sends for this share of its time sends nearly all the time.
pub(super) const SATURATED: f64 = 0.95;
/// A residual below this share of the reserve is next to nothing.
pub(super) const SPENT: f64 = 0.1;

/// What is wrong with a claim, as a clause.
type Complaint = Result<(), String>;

/// How a task or a mission is said to have ended, with the certificate of that.
pub(super) struct Claim<'a> {
    /// How.
    pub outcome: Outcome,
    /// The task concerned.
    pub task: Option<usize>,
    /// The certificate, if it comes with one.
    pub certificate: Option<&'a Certificate>,
}

impl<'a> Claim<'a> {
    /// The claim of the end of a mission.
    pub(super) fn of(end: &'a End) -> Self {
        Claim { outcome: end.outcome, task: end.task, certificate: end.certificate.as_ref() }
    }
}

/// Whether the certificate of a claim shows that it has to be so.
///
/// # Errors
///
/// What it does not show.
pub(super) fn check(judge: &Judge, end: &Claim) -> Complaint {
    let Some(certificate) = end.certificate else {
        return Err(format!("the outcome “{}” comes without a certificate", end.outcome.name()));
    };
    let Some(last) = &judge.previous else { return Ok(()) };
    let calls = judge.ledger.stage() == Stage::Calling;
    match (end.outcome, certificate) {
        (Outcome::UnreachableTask, Certificate::Unreachable(claim)) => {
            is_out_of_reach(judge, claim, end.task)
        }
        (Outcome::InsufficientRobots, Certificate::Bound(claim)) => takes_more(judge, claim),
        (Outcome::InsufficientRobots | Outcome::Blocked, Certificate::Tried { attempts, team })
            if calls || judge.nobody_leads() =>
        {
            are_all_ways(judge, attempts, last)?;
            stand(judge, team, last).map(|_| ())
        }
        (Outcome::Blocked, Certificate::Blocked { team }) if !calls => {
            match stand(judge, team, last)? {
                0 => Err("nothing is in the way of any robot of the team".to_owned()),
                _ => Ok(()),
            }
        }
        _ => {
            let (kind, outcome) = (certificate.name(), end.outcome.name());
            Err(format!(
                "a certificate of the kind “{kind}” does not show that the outcome is “{outcome}”"
            ))
        }
    }
}

// ---- Out of reach ------------------------------------------------------------------------------

fn is_out_of_reach(judge: &Judge, claim: &Unreachable, task: Option<usize>) -> Complaint {
    let limits = judge.monitor.limits();
    let Some(&place) = task.and_then(|task| limits.tasks().get(task)) else {
        return Err("no task is out of reach".to_owned());
    };
    let Some(ground) = Ground::of(&judge.scenario, limits) else { return Ok(()) };
    let reach = limits.settings().leash_radius();
    equal("the reach of robots", claim.reach, reach, SLACK)?;
    let nearest = Point::from(claim.nearest);
    let truly = ground.nearest_reached(place).map_or(f64::INFINITY, |it| (it - place).norm());
    equal("the distance to the task", claim.distance, (nearest - place).norm(), SLACK)?;
    equal("the least distance to the task", claim.distance, truly, ground.tolerance())?;
    if claim.distance <= reach {
        let distance = claim.distance;
        return Err(format!(
            "robots come within {distance:.6} of the task, and {reach:.6} is enough"
        ));
    }
    let Some(other) = claim.elsewhere.map(Point::from) else { return Ok(()) };
    let truly = ground.nearest(place);
    let is_so = (other - truly).norm() <= ground.tolerance()
        && (truly - place).norm() <= reach
        && !ground.is_reached(truly);
    match is_so {
        true => Ok(()),
        false => Err(format!(
            "({}, {}) is not the place beside the task to which no way leads",
            other.x, other.y
        )),
    }
}

// ---- Bounds ------------------------------------------------------------------------------------

fn takes_more(judge: &Judge, claim: &Bound) -> Complaint {
    let tasks = &judge.tasks_together()[..];
    if !all_stay(&judge.scenario, tasks) {
        return Err("tasks are over that any tree is claimed to service".to_owned());
    }
    let robots = judge.scenario.robot.len();
    let spans = Spans::as_the_crow_flies(&judge.scenario);
    equal("the longest link", claim.longest_link, spans.longest_link(), SLACK)?;
    let length = spans.least_length(tasks);
    equal("the least length of a tree", claim.length, length, SLACK * length.max(1.0))?;
    let least = spans.least_robots(tasks);
    if claim.robots != robots || least != Some(claim.least) || claim.least <= robots {
        return Err(format!(
            "any tree is claimed to take {} robots of {}; it takes {least:?} of {robots}",
            claim.least, claim.robots
        ));
    }
    Ok(())
}

// ---- Ways tried --------------------------------------------------------------------------------

/// The attempts are those of the record, and in none of them a robot could have come. Where the election was repeated
/// and no robot leads a team, none is redundant in a tree that was not tried.
fn are_all_ways(judge: &Judge, attempts: &[Attempt], now: &Snapshot) -> Complaint {
    let last = judge.last_trial();
    let trials: Vec<&Trial> = judge.tried.trials().iter().chain(&last).collect();
    if trials.is_empty() {
        return Err("no robot has called for another".to_owned());
    }
    if trials.len() != attempts.len() {
        let (stated, made) = (attempts.len(), trials.len());
        return Err(format!("{stated} calls are stated, and {made} were made"));
    }
    let mut tried = BTreeSet::new();
    for (attempt, trial) in attempts.iter().zip(trials) {
        is_call(attempt, trial)?;
        tried.extend(trial.led_from);
        for other in &attempt.others {
            could_not_come(other, trial, &tried).map_err(|clause| {
                format!("robot {}, at k = {}: {clause}", other.robot, attempt.k)
            })?;
        }
        tried.extend(tree_of(trial.caller, &trial.snapshot));
    }
    let free = (0..now.roles.len()).filter(|&robot| now.roles[robot] == Role::Redundant);
    let mut untried =
        free.filter(|&robot| tree_of(robot, now).is_none_or(|it| !tried.contains(&it)));
    match untried.next().filter(|_| last.is_none()) {
        Some(robot) => Err(format!("robot {robot} is redundant, and its tree was not tried")),
        None => Ok(()),
    }
}

/// Who called when, and that every robot outside of its team is listed.
fn is_call(attempt: &Attempt, trial: &Trial) -> Complaint {
    let robots = trial.snapshot.roles.len();
    let root = tree_of(trial.caller, &trial.snapshot).map(|access_point| robots + access_point);
    let is_so = (attempt.k, attempt.caller, attempt.root)
        == (trial.snapshot.step, trial.caller, root)
        && (attempt.stretched, attempt.then) == (trial.stretched, trial.then);
    if !is_so {
        return Err(format!(
            "robot {} is said to have called in the tree of {:?} until k = {}, and robot {} did in that of \
             {root:?} until k = {}",
            attempt.caller, attempt.root, attempt.k, trial.caller, trial.snapshot.step
        ));
    }
    let others = (0..robots).filter(|robot| !trial.team.contains(robot));
    match attempt.others.iter().map(|other| other.robot).eq(others) {
        true => Ok(()),
        false => {
            Err(format!("at k = {} not every robot outside of the team is listed once", attempt.k))
        }
    }
}

fn could_not_come(other: &Other, trial: &Trial, tried: &BTreeSet<usize>) -> Complaint {
    let Other { robot, because } = other;
    let now = &trial.snapshot;
    let is_redundant = now.roles[*robot] == Role::Redundant;
    match because {
        Because::Services { task } => match now.serviced.contains(&(*task, *robot)) {
            true => Ok(()),
            false => Err(format!("it does not service task {task}")),
        },
        Because::Bears { .. } | Because::Holds if is_redundant => {
            Err("it is redundant, and holds no post that others need".to_owned())
        }
        Because::Bears { children } => {
            let mut truly: Vec<usize> = now
                .tree
                .iter()
                .filter(|(_, parent)| parent == robot)
                .map(|(child, _)| *child)
                .collect();
            truly.sort_unstable();
            if *children != truly || truly.is_empty() {
                return Err(format!("it bears {truly:?}, not {children:?}"));
            }
            let may_join = now.roles[*robot] == Role::Node && !trial.releases_leader;
            match may_join && *children == [trial.caller] {
                true => {
                    Err(format!("it bears robot {} alone, and could have joined it", trial.caller))
                }
                false => Ok(()),
            }
        }
        Because::Holds => match now.tree.iter().find(|(_, parent)| parent == robot) {
            None => Ok(()),
            Some((child, _)) => Err(format!("it bears robot {child}")),
        },
        Because::Apart { root } => {
            is_apart(*root, is_redundant, tree_of(*robot, now), trial, tried)
        }
        other => Err(format!("no reason is called {other:?}")),
    }
}

/// A redundant robot in another tree than the caller, which has been tried or is to be tried next.
fn is_apart(
    stated: Option<usize>,
    is_redundant: bool,
    tree: Option<usize>,
    trial: &Trial,
    tried: &BTreeSet<usize>,
) -> Complaint {
    let robots = trial.snapshot.roles.len();
    if !is_redundant || stated != tree.map(|access_point| robots + access_point) {
        return Err(format!("it is not redundant in the tree of {stated:?}"));
    }
    match tree {
        Some(tree) if Some(tree) == tree_of(trial.caller, &trial.snapshot) => {
            Err("it is redundant, and in the tree of the robot that calls".to_owned())
        }
        Some(tree) if trial.then != Then::ElectionRepeated && !tried.contains(&tree) => {
            Err(format!("it is redundant, and the tree of access point {tree} was not tried"))
        }
        _ => Ok(()),
    }
}

// ---- What stands -------------------------------------------------------------------------------

/// Whether the team is stated as it stands; returns how many hindrances there are.
fn stand(judge: &Judge, team: &[Standing], last: &Snapshot) -> Result<usize, String> {
    let ledger = &judge.ledger;
    let moving = ledger.active_team();
    let expected = if moving.is_empty() { &ledger.primary_team } else { moving };
    if !team.iter().map(|standing| standing.robot).eq(expected.iter().copied()) {
        return Err(format!("the robots that stand are {expected:?}"));
    }
    let ground = Ground::of(&judge.scenario, judge.monitor.limits());
    for standing in team {
        let Standing { robot, position, target, hindrances } = standing;
        let is_so = last.positions[*robot] == Point::from(*position)
            && judge.headings[*robot] == target.map(Point::from);
        if !is_so {
            return Err(format!(
                "robot {robot} does not stand, or did not go, where it is said to"
            ));
        }
        for hindrance in hindrances {
            is_in_the_way(judge, ground.as_ref(), *robot, hindrance, last)
                .map_err(|clause| format!("robot {robot}: {clause}"))?;
        }
    }
    Ok(team.iter().map(|standing| standing.hindrances.len()).sum())
}

fn is_in_the_way(
    judge: &Judge,
    ground: Option<&Ground>,
    robot: usize,
    hindrance: &Hindrance,
    last: &Snapshot,
) -> Complaint {
    let limits = judge.monitor.limits();
    let clearance = limits.settings().planning_clearance();
    let here = last.positions[robot];
    match *hindrance {
        Hindrance::Robot { robot: other, distance, stopped } => {
            let Some(there) = last.positions.get(other).filter(|_| other != robot) else {
                return Err(format!("there is no other robot {other}"));
            };
            equal("the distance of a robot", distance, (there - here).norm(), SLACK)?;
            at_most("the distance of a robot", distance, PASSAGE * clearance)?;
            match last.absent.contains(&other) == stopped {
                true => Ok(()),
                false => Err(format!("whether robot {other} has stopped is stated wrongly")),
            }
        }
        Hindrance::Body { position, distance } => {
            let there = Point::from(position);
            if !judge.bodies.contains(&there) {
                let [x, y] = position;
                return Err(format!("no robot of another access point is at ({x}, {y})"));
            }
            equal("the distance of a robot", distance, (there - here).norm(), SLACK)?;
            at_most("the distance of a robot", distance, PASSAGE * clearance)
        }
        Hindrance::Wall { distance } => {
            let truly = limits.workspace().clearance(here);
            equal("the distance of a wall", distance, truly, SLACK)?;
            at_most("the distance of a wall", distance, TOUCHED * clearance)
        }
        Hindrance::Link { to, length, limit } => {
            let Some(ground) = ground else { return Ok(()) };
            if !last.tree.contains(&(robot, to)) && !last.tree.contains(&(to, robot)) {
                return Err(format!("no link of the tree leads to {to}"));
            }
            equal("the limit of a link", limit, judge.link_limit(), SLACK)?;
            let truly = ground.length(robot, to, last);
            equal("the length of a link", length, truly, ground.tolerance())?;
            at_most("a share of the limit", AT_LIMIT * limit, length)
        }
        Hindrance::Load { load, residual } => {
            equal("the load", load, load_of(robot, last), SLACK)?;
            equal("the residual", residual, last.residuals[robot], SLACK)?;
            let reserve = limits.settings().routing_reserve;
            match load >= SATURATED || load > 0.0 && residual < SPENT * reserve {
                true => Ok(()),
                false => Err(format!("a load of {load:.6} leaves a residual of {residual:.6}")),
            }
        }
        Hindrance::Sender { robot: sender, load } => {
            let sends =
                |route: &Route| (route.from, route.to) == (sender, robot) && route.share > 0.0;
            if !last.routes.iter().any(sends) {
                return Err(format!("robot {sender} sends nothing to robot {robot}"));
            }
            equal("the load of a sender", load, load_of(sender, last), SLACK)?;
            match load >= SATURATED {
                true => Ok(()),
                false => Err(format!("a load of {load:.6} leaves robot {sender} time to send")),
            }
        }
        ref other => Err(format!("no hindrance is called {other:?}")),
    }
}

fn equal(what: &str, stated: f64, truly: f64, tolerance: f64) -> Complaint {
    match (stated - truly).abs() <= tolerance {
        true => Ok(()),
        false => Err(format!("{what} is said to be {stated:.6}, and it is {truly:.6}")),
    }
}

fn at_most(what: &str, value: f64, bound: f64) -> Complaint {
    match value <= bound + SLACK {
        true => Ok(()),
        false => Err(format!("{what}, {value:.6}, is more than {bound:.6}")),
    }
}
