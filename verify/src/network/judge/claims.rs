//! Whether an event is true of the world at the instant for which it is recorded.

use pleach_automaton::network::record::{MissionEvent, PostView, Snapshot};
use pleach_automaton::network::scenario::{Settings, Strategy};
use pleach_continuous::Point;
use pleach_discrete::network::Role;

use super::ledger::{Ledger, Stage};
use super::walk::Walk;
use super::{Dispute, Scene};
use crate::network::limits::{Limits, SLACK};
use crate::network::property::Property;
use crate::network::tree;

/// Robots touch that are at most this many ρ apart (they keep 2ρ).
const CONTACT: f64 = 2.6;
/// Robots that exchange duties are at most this many ρ apart: no third one passes between them.
const BESIDE: f64 = 4.0;
/// Rounds of beacons that an exchange of duties takes: offer, reply, and the two duties taken.
const EXCHANGE_ROUNDS: usize = Settings::ROUNDS_OF_AN_EXCHANGE - 1;
/// A team is at a stationary point when every member is where it was before, within this share of ρ or σ,
/// the smaller one: in the last control period or, as it moves back and forth, in one of the recent ones.
const STILL: f64 = 0.3;

/// The robots and tasks of an event exist.
///
/// # Errors
///
/// The first that does not, as [`Property::Record`].
pub(super) fn names_exist(event: &MissionEvent, limits: &Limits) -> Result<(), Dispute> {
    let mut robots = Vec::new();
    let mut task = None;
    match event {
        MissionEvent::TaskAnnounced { task: it }
        | MissionEvent::TaskEnded { task: it }
        | MissionEvent::TaskWithdrawn { task: it }
        | MissionEvent::TaskGivenUp { task: it, .. }
        | MissionEvent::ElectionRepeated { task: it } => {
            task = Some(*it);
        }
        MissionEvent::TaskReannounced { task: it, gone, joined } => {
            task = Some(*it);
            robots.extend(gone.iter().chain(joined));
        }
        MissionEvent::LeaderElected { task: it, robot, .. }
        | MissionEvent::TaskServiced { task: it, robot } => {
            task = Some(*it);
            robots.push(*robot);
        }
        MissionEvent::Stationary { robot, team } | MissionEvent::JoinedPrimary { robot, team } => {
            robots.push(*robot);
            robots.extend(team);
        }
        MissionEvent::RecruitElected { robot, path, break_points } => {
            robots.push(*robot);
            robots.extend(path.iter().chain(break_points));
        }
        MissionEvent::SubgroupStarted { robots: members, .. }
        | MissionEvent::SubgroupArrived { robots: members, .. } => robots.extend(members),
        MissionEvent::Released { robot }
        | MissionEvent::RecruitCalled { robot }
        | MissionEvent::CalledInVain { robot }
        | MissionEvent::LinksStretched { robot }
        | MissionEvent::RoleChanged { robot, .. }
        | MissionEvent::RouteInfeasible { robot } => robots.push(*robot),
        MissionEvent::DutiesExchanged { mover, parked } => robots.extend([mover, parked]),
        MissionEvent::Reattached { robot, parent } => {
            robots.push(*robot);
            if *parent >= limits.nodes() {
                return record(format!("an event names node {parent}, of {}", limits.nodes()));
            }
        }
        other => return record(format!("no event is called {other:?}")),
    }
    if let Some(robot) = robots.into_iter().find(|&robot| robot >= limits.robots()) {
        return record(format!("an event names robot {robot}, of {}", limits.robots()));
    }
    match task.filter(|&task| task >= limits.tasks().len()) {
        Some(task) => record(format!("an event names task {task}, of {}", limits.tasks().len())),
        None => Ok(()),
    }
}

fn record(sentence: String) -> Result<(), Dispute> {
    Err(Dispute::of(Property::Record, &[], sentence))
}

/// What an event says of places, parents and motions is so. `ledger` is that before the event.
///
/// # Errors
///
/// What is not so, as [`Property::Events`] or [`Property::Subgroups`].
pub(super) fn is_true(event: &MissionEvent, ledger: &Ledger, scene: &Scene) -> Result<(), Dispute> {
    match event {
        MissionEvent::TaskServiced { task, robot } => {
            is_at_task(*task, *robot, scene.snapshot, scene.limits)?;
            has_post_at_task(*task, *robot, ledger, scene)
        }
        MissionEvent::Stationary { .. } => stands_still(&ledger.primary_team, scene),
        MissionEvent::RecruitElected { robot, path, break_points } => {
            is_free(*robot, path, scene)?;
            divides(path, break_points, ledger, scene)
        }
        MissionEvent::SubgroupArrived { subgroup, .. } => {
            ledger.walk.as_ref().map_or(Ok(()), |walk| has_come(walk, *subgroup, scene))
        }
        MissionEvent::DutiesExchanged { mover, parked } => {
            goes_on(*mover, ledger, scene)?;
            are_beside(*mover, *parked, scene)
        }
        MissionEvent::Reattached { robot, parent } => is_attached(*robot, *parent, ledger, scene),
        MissionEvent::RouteInfeasible { robot } => is_infeasible(*robot, scene),
        _ => Ok(()),
    }
}

/// Eq. (2): the robot is within δ of the task.
pub(super) fn is_at_task(
    task: usize,
    robot: usize,
    snapshot: &Snapshot,
    limits: &Limits,
) -> Result<(), Dispute> {
    let distance = (snapshot.positions[robot] - limits.tasks()[task]).norm();
    let bound = limits.service_radius();
    let sentence =
        || format!("robot {robot} services task {task} from {distance:.6}, more than {bound:.6}");
    at_most(distance, bound, &[robot], sentence)
}

/// Sec. V-A2: a leader that has yet to be released services its task only from the post that it keeps, within δ of it,
/// and not in the paper's order.
fn has_post_at_task(
    task: usize,
    robot: usize,
    ledger: &Ledger,
    scene: &Scene,
) -> Result<(), Dispute> {
    let place = scene.limits.tasks()[task];
    let is_right = |post: &PostView| serves_from(post, robot, place, scene.limits.settings());
    if !ledger.awaits_release || scene.snapshot.posts.iter().any(is_right) {
        return Ok(());
    }
    let sentence = format!("robot {robot} services task {task}, and has yet to be released");
    Err(Dispute::of(Property::Events, &[robot], sentence))
}

/// Whether a robot that has yet to be released may service the task at `place` from this post.
fn serves_from(post: &PostView, robot: usize, place: Point, settings: &Settings) -> bool {
    let is_within = (post.reference - place).norm() <= settings.service_radius;
    settings.strategy == Strategy::Eager && post.holder == robot && is_within
}

/// No member has got anywhere, as far as the first one, which reports it, can know. News passes one member a round, and
/// the report may be made in the first round of a period: what is known of a member may be some periods old.
fn stands_still(team: &[usize], scene: &Scene) -> Result<(), Dispute> {
    if scene.recent.is_empty() {
        return Ok(());
    }
    let settings = scene.limits.settings();
    let bound = (STILL * settings.planning_clearance().min(settings.step_radius))
        .max(settings.errors.stray());
    let now = &scene.snapshot.positions[..];
    let places: Vec<&[Point]> = scene.recent.iter().map(Vec::as_slice).chain([now]).collect();
    for (hops, &robot) in team.iter().enumerate() {
        let oldest = hops.div_ceil(settings.rounds_per_period);
        let moves = (0..=oldest).filter_map(|periods| {
            let (now, before) = places[..places.len().saturating_sub(periods)].split_last()?;
            before.iter().map(|place| (now[robot] - place[robot]).norm()).reduce(f64::min)
        });
        let moved = moves.fold(f64::INFINITY, f64::min);
        at_most(moved, bound, &[robot], || {
            format!("the team {team:?} is reported stationary, and robot {robot} moves {moved:.6}")
        })?;
    }
    Ok(())
}

/// A recruit is redundant until it is elected, or a node that bears nothing but the robot that calls. It may have
/// become that in the period in which it is elected.
fn is_free(robot: usize, path: &[usize], scene: &Scene) -> Result<(), Dispute> {
    let Some(previous) = scene.previous else { return Ok(()) };
    // p₁ may have attached to it, and called, in the period in which it is elected.
    let bears_caller_alone = || {
        [previous, scene.snapshot].into_iter().any(|snapshot| {
            let children = snapshot.tree.iter().filter(|(_, parent)| *parent == robot);
            children.map(|(child, _)| child).eq(path.last())
        })
    };
    let is_free = |role: Role| match role {
        Role::Redundant => true,
        Role::Node => path.len() == 2 && bears_caller_alone(),
        _ => false,
    };
    let before = previous.roles[robot];
    let mut meanwhile = scene.events.iter().filter_map(|event| match *event {
        MissionEvent::RoleChanged { robot: it, to, .. } if it == robot => Some(to),
        _ => None,
    });
    if before == Role::Recruit || is_free(before) || meanwhile.any(is_free) {
        return Ok(());
    }
    let sentence = format!("robot {robot}, a {}, is elected recruit", before.name());
    Err(Dispute::of(Property::Events, &[robot], sentence))
}

/// Sec. V-B2: the break points are those of the tree at the beginning or at the end of the period;
/// the first subgroups may have arrived in the period in which Σ is announced.
fn divides(
    path: &[usize],
    break_points: &[usize],
    ledger: &Ledger,
    scene: &Scene,
) -> Result<(), Dispute> {
    let servicing: Vec<usize> = ledger.serviced.values().copied().collect();
    // Robots whose task is over may vote before they know.
    let with_discharging = ledger.serviced.values().chain(ledger.discharging.values());
    let with_discharging: Vec<usize> = with_discharging.copied().collect();
    let derived = |snapshot: &Snapshot, servicing: &[usize]| {
        break_points_by_tree(path, servicing, ledger.awaits_release, snapshot)
    };
    let now = derived(scene.snapshot, &servicing);
    let is_derived = |snapshot: &Snapshot| {
        [&servicing, &with_discharging].into_iter().any(|it| derived(snapshot, it) == break_points)
    };
    if is_derived(scene.snapshot) || scene.previous.is_some_and(is_derived) {
        return Ok(());
    }
    let sentence = format!(
        "the break points of the path {path:?} are {now:?} by the tree, and {break_points:?} are \
         reported"
    );
    Err(Dispute::of(Property::Subgroups, path, sentence))
}

/// The recruit, the last robot that is relieved, and between them each robot that services a task,
/// has a neighbour in the tree off Σ, or stands where Σ leaves the tree.
fn break_points_by_tree(
    path: &[usize],
    servicing: &[usize],
    releases_leader: bool,
    snapshot: &Snapshot,
) -> Vec<usize> {
    let robots = snapshot.positions.len();
    let mut parents = vec![None; robots];
    // A robot with two parents is told by another property.
    let _ = tree::parents_of(&snapshot.tree, &mut parents);
    let joins =
        |one: usize, other: usize| parents[one] == Some(other) || parents[other] == Some(one);
    let is_on = |node: usize| path.contains(&node);
    let bears_others = |robot: usize| {
        parents[robot].is_some_and(|parent| !is_on(parent))
            || (0..robots).any(|child| parents[child] == Some(robot) && !is_on(child))
    };
    let Some(last) = path.len().checked_sub(if releases_leader { 1 } else { 2 }) else {
        return Vec::new();
    };
    let is_break_point = |place: usize| {
        let robot = path[place];
        place == 0
            || place == last
            || servicing.contains(&robot)
            || bears_others(robot)
            || !joins(path[place - 1], robot)
            || !joins(robot, path[place + 1])
    };
    (0..=last).filter(|&place| is_break_point(place)).map(|place| path[place]).collect()
}

/// Eq. (26): each member is within δ of the place of the robot ahead, or stands right behind that.
pub(super) fn has_come(walk: &Walk, subgroup: usize, scene: &Scene) -> Result<(), Dispute> {
    let contact = CONTACT * scene.limits.settings().planning_clearance();
    let radius = scene.limits.service_radius();
    for place in walk.subgroup(subgroup).unwrap_or_default() {
        let (robot, ahead) = (walk.path[place], walk.path[place + 1]);
        let position = scene.snapshot.positions[robot];
        let Some((target, is_fixed)) = scene.places.on_path(place + 1) else { continue };
        let radius = if is_fixed { radius } else { radius + contact };
        let distance = (position - target).norm();
        let queues = (position - scene.snapshot.positions[ahead]).norm() <= contact + SLACK;
        if !queues {
            at_most(distance, radius, &[robot, ahead], || {
                format!(
                    "subgroup {subgroup} is reported to have arrived, and robot {robot} is \
                     {distance:.6} from its place, more than {radius:.6}"
                )
            })?;
        }
    }
    Ok(())
}

/// With the strategy of the paper the primary team stands still while Σ is walked.
fn goes_on(mover: usize, ledger: &Ledger, scene: &Scene) -> Result<(), Dispute> {
    let strategy = scene.limits.settings().strategy;
    let waits = ledger.stage() == Stage::Shifting && ledger.primary_team.contains(&mover);
    if strategy == Strategy::Eager || !waits {
        return Ok(());
    }
    let team = &ledger.primary_team;
    let sentence = format!(
        "robot {mover} gives its duty away while the primary team {team:?} waits for a recruit"
    );
    Err(Dispute::of(Property::Events, &[mover], sentence))
}

fn are_beside(mover: usize, parked: usize, scene: &Scene) -> Result<(), Dispute> {
    let positions = &scene.snapshot.positions;
    let distance = (positions[mover] - positions[parked]).norm();
    let settings = scene.limits.settings();
    // From the offer to the end the mover may go on, if that takes more than one period.
    let periods = EXCHANGE_ROUNDS.div_ceil(settings.rounds_per_period.max(1));
    let way = periods.saturating_sub(1) as f64 * settings.step_radius;
    let bound = BESIDE * settings.planning_clearance() + way;
    at_most(distance, bound, &[mover, parked], || {
        format!(
            "robots {mover} and {parked} exchange duties at a distance of {distance:.6}, more than \
             {bound:.6}"
        )
    })
}

/// Remark 5.6: a robot of the primary team is attached to this node.
fn is_attached(robot: usize, parent: usize, ledger: &Ledger, scene: &Scene) -> Result<(), Dispute> {
    // Who exchanges duties in the same period is found in the place of the other.
    let partner_of = |node: usize| {
        scene.events.iter().find_map(|event| match *event {
            MissionEvent::DutiesExchanged { mover, parked } if mover == node => Some(parked),
            MissionEvent::DutiesExchanged { mover, parked } if parked == node => Some(mover),
            _ => None,
        })
    };
    // Whose post a secondary team takes over in the same period: the robot behind on Σ has it.
    let announced = scene.events.iter().filter_map(|event| match event {
        MissionEvent::RecruitElected { path, .. } => Some(path),
        _ => None,
    });
    let paths: Vec<_> = ledger.walk.iter().map(|walk| &walk.announced).chain(announced).collect();
    let has_arrived = |robot: usize| {
        scene.events.iter().any(|event| {
            matches!(event, MissionEvent::SubgroupArrived { robots, .. } if robots.contains(&robot))
        })
    };
    let heir_of = |node: usize| {
        paths.iter().find_map(|path| {
            let place = path.iter().position(|&it| it == node)?.checked_sub(1)?;
            Some(path[place]).filter(|&behind| has_arrived(behind))
        })
    };
    let is_edge = |parent: usize| {
        let children = [Some(robot), partner_of(robot)];
        let parents = [Some(parent), partner_of(parent), heir_of(parent)];
        children.into_iter().flatten().any(|child| {
            let mut parents = parents.into_iter().flatten();
            parents.any(|parent| scene.snapshot.tree.contains(&(child, parent)))
        })
    };
    // It may have attached to several nodes in one period, one after the other.
    let goes_on = scene.events.iter().any(|event| {
        matches!(*event, MissionEvent::Reattached { robot: it, parent } if it == robot && is_edge(parent))
    });
    // One whose team is dissolved may look for a nearer parent at once, as others do, and that is not told.
    let is_dismissed = ledger.dismissed.contains(&robot);
    let clause = match is_edge(parent) || goes_on || is_dismissed {
        false => "which is not its parent",
        true if !ledger.is_or_was_primary(robot) => "and is not of the primary team",
        true => return Ok(()),
    };
    let sentence = format!("robot {robot} attaches to {parent}, {clause}");
    Err(Dispute::of(Property::Events, &[robot, parent], sentence))
}

/// The residual of the robot is below −c_min.
fn is_infeasible(robot: usize, scene: &Scene) -> Result<(), Dispute> {
    let (residual, bound) = (scene.snapshot.residuals[robot], scene.limits.least_residual());
    if residual < bound {
        return Ok(());
    }
    let sentence = format!(
        "the routes of robot {robot} are reported infeasible, and its residual is {residual:.6}, \
         not less than {bound:.6}"
    );
    Err(Dispute::of(Property::Events, &[robot], sentence).measuring(residual, bound))
}

/// Whether the robots stand in `whole` in this order.
pub(super) fn is_part(robots: &[usize], whole: &[usize]) -> bool {
    let mut rest = whole.iter();
    robots.iter().all(|robot| rest.any(|it| it == robot))
}

fn at_most(
    value: f64,
    bound: f64,
    robots: &[usize],
    sentence: impl FnOnce() -> String,
) -> Result<(), Dispute> {
    if value <= bound + SLACK {
        return Ok(());
    }
    Err(Dispute::of(Property::Events, robots, sentence()).measuring(value, bound))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::sample::scenario;

    #[test]
    fn who_has_yet_to_be_released_services_a_task_within_reach_of_its_own_post_in_no_other_order() {
        let serves = |strategy: Strategy, holder: usize, away: f64| {
            let settings = Settings { strategy, ..scenario().site().settings };
            let reference = Point::new(1.0 - away * settings.service_radius, 0.0);
            let post = PostView { reference, holder, task: None, junction: false };
            serves_from(&post, 1, Point::new(1.0, 0.0), &settings)
        };
        assert!(serves(Strategy::Eager, 1, 0.99));
        assert!(!serves(Strategy::Eager, 1, 1.01), "it is too far away");
        assert!(!serves(Strategy::Eager, 2, 0.99), "it is another robot's");
        assert!(!serves(Strategy::Paper, 1, 0.99));
    }
}
