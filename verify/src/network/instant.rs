//! What holds at the instant of a snapshot.
//!
//! Each function checks one [`Property`], or a few that belong together, with the pure
//! functions of the modules [`link`], [`mod@tree`] and [`team`], and names the offenders.

use pleach_automaton::network::record::Snapshot;
use pleach_continuous::Point;
use pleach_discrete::Location as _;

use super::extremes::Extreme;
use super::limits::{Limits, SLACK};
use super::link::{self, NodePositions};
use super::property::Property;
use super::violation::{Instant, Violation};
use super::{team, tree};

/// The nodes' places in a snapshot.
fn places<'a>(snapshot: &'a Snapshot, limits: &'a Limits) -> NodePositions<'a> {
    NodePositions { robots: &snapshot.positions, access_points: limits.access_points() }
}

/// [`Property::Record`]: everything else may rely on numbers being finite and identities
/// existing.
///
/// # Errors
///
/// The first entry that is not well formed.
pub fn record(snapshot: &Snapshot, limits: &Limits) -> Result<(), Violation> {
    let fault = count_fault(snapshot, limits)
        .or_else(|| number_fault(snapshot))
        .or_else(|| identity_fault(snapshot, limits))
        .or_else(|| team_fault(snapshot));
    match fault {
        None => Ok(()),
        Some(sentence) => Err(Instant::of(snapshot).violation(
            Property::Record,
            &[],
            (f64::NAN, f64::NAN),
            sentence,
        )),
    }
}

fn count_fault(snapshot: &Snapshot, limits: &Limits) -> Option<String> {
    let counts = [
        ("positions", snapshot.positions.len()),
        ("roles", snapshot.roles.len()),
        ("residuals", snapshot.residuals.len()),
        ("multipliers", snapshot.multipliers.len()),
    ];
    let (name, count) = counts.into_iter().find(|(_, count)| *count != limits.robots())?;
    Some(format!("there are {count} {name} for {} robots", limits.robots()))
}

fn number_fault(snapshot: &Snapshot) -> Option<String> {
    let is_finite = |place: &Point| place.iter().all(|coordinate| coordinate.is_finite());
    if !snapshot.time.is_finite() {
        return Some(format!("the time is {}", snapshot.time));
    }
    if let Some(robot) = snapshot.positions.iter().position(|place| !is_finite(place)) {
        return Some(format!("the position of robot {robot} is not finite"));
    }
    let of_robots = snapshot.residuals.iter().zip(&snapshot.multipliers);
    let mut pairs = of_robots.enumerate();
    if let Some((robot, _)) = pairs.find(|(_, (c, lambda))| !c.is_finite() || !lambda.is_finite()) {
        return Some(format!("the residual or multiplier of robot {robot} is not finite"));
    }
    let mut routes = snapshot.routes.iter();
    if let Some(route) = routes.find(|r| !r.share.is_finite() || !r.reliability.is_finite()) {
        return Some(format!("the route {} → {} has a number not finite", route.from, route.to));
    }
    let post = snapshot.posts.iter().position(|post| !is_finite(&post.reference))?;
    Some(format!("the reference of post {post} is not finite"))
}

fn identity_fault(snapshot: &Snapshot, limits: &Limits) -> Option<String> {
    let (robots, nodes, tasks) = (limits.robots(), limits.nodes(), limits.tasks().len());
    let lists = [
        ("active", &snapshot.active),
        ("the active team", &snapshot.active_team),
        ("the primary team", &snapshot.primary_team),
        ("the path Σ", &snapshot.path),
    ];
    for (name, list) in lists {
        if let Some(robot) = list.iter().find(|&&robot| robot >= robots) {
            return Some(format!("{name} lists robot {robot}, of {robots}"));
        }
    }
    let routes = snapshot.routes.iter().map(|route| ("route", (route.from, route.to)));
    let edges = snapshot.tree.iter().map(|edge| ("tree edge", *edge));
    for (name, (from, to)) in routes.chain(edges) {
        if from >= robots || to >= nodes || from == to {
            return Some(format!("the {name} {from} → {to} does not join two nodes of {nodes}"));
        }
    }
    if let Some(node) = snapshot.absent.iter().find(|&&node| node >= nodes) {
        return Some(format!("node {node} is absent, of {nodes}"));
    }
    if let Some(task) = snapshot.closed.iter().find(|&&task| task >= tasks) {
        return Some(format!("task {task} is over, of {tasks}"));
    }
    let serviced = snapshot.serviced.iter().map(|&(task, robot)| (Some(task), robot));
    let posts = snapshot.posts.iter().map(|post| (post.task, post.holder));
    for (task, robot) in serviced.chain(posts) {
        if robot >= robots || task.is_some_and(|task| task >= tasks) {
            return Some(match task {
                Some(task) => format!("robot {robot} has task {task}, of {robots} and {tasks}"),
                None => format!("robot {robot} has a post, of {robots}"),
            });
        }
    }
    None
}

fn team_fault(snapshot: &Snapshot) -> Option<String> {
    if !snapshot.active.is_sorted_by(|one, next| one < next) {
        return Some("the active robots are not listed in ascending order, each once".to_owned());
    }
    if !snapshot.absent.is_sorted_by(|one, next| one < next) {
        return Some("the absent nodes are not listed in ascending order, each once".to_owned());
    }
    if !snapshot.closed.is_sorted_by(|one, next| one < next) {
        return Some(
            "the tasks that are over are not listed in ascending order, each once".to_owned(),
        );
    }
    let teams = [
        ("the active team", &snapshot.active_team),
        ("the primary team", &snapshot.primary_team),
        ("the path Σ", &snapshot.path),
    ];
    let (name, _) = teams.into_iter().find(|(_, team)| !team::has_no_repetition(team))?;
    Some(format!("{name} names a robot twice"))
}

/// Part of [`Property::Record`]: each robot is at a location of the duty automaton that has its role.
///
/// # Errors
///
/// The first robot that is not.
pub fn locations(snapshot: &Snapshot) -> Result<(), Violation> {
    let mut robots = snapshot.robots.iter().zip(&snapshot.roles).enumerate();
    match robots.find(|(_, (shown, role))| !shown.activity.can_be(**role)) {
        None => Ok(()),
        Some((robot, (shown, role))) => {
            let sentence = format!(
                "robot {robot} is shown as {}, and no robot at “{}” is one",
                role.name(),
                shown.activity.name()
            );
            let now = Instant::of(snapshot);
            Err(now.violation(Property::Record, &[robot], (0.0, 1.0), sentence))
        }
    }
}

/// [`Property::Reliability`].
///
/// # Errors
///
/// The first route whose reliability is not that of its length.
pub fn reliability(snapshot: &Snapshot, limits: &Limits) -> Result<(), Violation> {
    let places = places(snapshot, limits);
    for route in &snapshot.routes {
        let distance = places.distance(route.from, route.to);
        let stated = limits.reckoned_reliability(distance);
        if (route.reliability - stated).abs() > SLACK {
            return Err(Instant::of(snapshot).violation(
                Property::Reliability,
                &[route.from, route.to],
                (route.reliability, stated),
                format!(
                    "the link {} → {} of length {distance:.6} reports R = {:.6}, the model of links \
                     gives {stated:.6}",
                    route.from, route.to, route.reliability
                ),
            ));
        }
    }
    Ok(())
}

/// [`Property::Shares`].
///
/// # Errors
///
/// The first share out of [0, 1], or the first robot whose shares exceed its time.
pub fn shares(snapshot: &Snapshot, limits: &Limits) -> Result<(), Violation> {
    let instant = Instant::of(snapshot);
    let mut sums = vec![0.0; limits.robots()];
    for route in &snapshot.routes {
        if !(0.0..=1.0 + SLACK).contains(&route.share) {
            return Err(instant.violation(
                Property::Shares,
                &[route.from, route.to],
                (route.share, 1.0),
                format!("robot {} gives {} the share {:.6}", route.from, route.to, route.share),
            ));
        }
        sums[route.from] += route.share;
    }
    match sums.iter().position(|&sum| sum > 1.0 + SLACK) {
        None => Ok(()),
        Some(robot) => Err(instant.violation(
            Property::Shares,
            &[robot],
            (sums[robot], 1.0),
            format!("the shares of robot {robot} sum to {:.6}", sums[robot]),
        )),
    }
}

/// [`Property::Accounting`].
///
/// # Errors
///
/// The first robot whose reported residual is not that of the routes.
pub fn accounting(snapshot: &Snapshot, limits: &Limits) -> Result<(), Violation> {
    let residuals = link::residuals(&snapshot.routes, limits.rates());
    for (robot, (&reported, &stated)) in snapshot.residuals.iter().zip(&residuals).enumerate() {
        if (reported - stated).abs() > SLACK {
            return Err(Instant::of(snapshot).violation(
                Property::Accounting,
                &[robot],
                (reported, stated),
                format!(
                    "robot {robot} reports the residual {reported:.6}, its routes give {stated:.6}"
                ),
            ));
        }
    }
    Ok(())
}

/// Whether a task has been announced. Until then routes are being set up link by link, which takes several control
/// periods where the way to an access point has more links than a period has rounds.
fn has_begun(snapshot: &Snapshot) -> bool {
    snapshot.task.is_some() || !snapshot.serviced.is_empty() || !snapshot.closed.is_empty()
}

/// [`Property::Residual`], from the routes, once the first task has been announced; the smallest residual, for the
/// summary.
///
/// # Errors
///
/// The robot with the smallest residual, if that is below −c_min.
pub fn residual(snapshot: &Snapshot, limits: &Limits) -> Result<Option<Extreme>, Violation> {
    if !has_begun(snapshot) {
        return Ok(None);
    }
    let residuals = link::residuals(&snapshot.routes, limits.rates());
    let smallest = residuals.iter().enumerate().min_by(|one, other| one.1.total_cmp(other.1));
    let Some((robot, &value)) = smallest else { return Ok(None) };
    let (instant, bound) = (Instant::of(snapshot), limits.least_residual());
    if value < bound - SLACK {
        let bound = bound + 0.0; // no negative zero in what people read
        let sentence = format!("the residual of robot {robot} is {value:.6}, less than {bound:.6}");
        return Err(instant.violation(Property::Residual, &[robot], (value, bound), sentence));
    }
    Ok(Some(Extreme { value, instant, robots: vec![robot] }))
}

/// [`Property::Connectivity`].
///
/// # Errors
///
/// The first robot from which no path leads to an access point, although it has packets to send: of its own, or of
/// others. Before the first task is announced only robots of the tree count.
pub fn connectivity(snapshot: &Snapshot, limits: &Limits) -> Result<(), Violation> {
    let carries = snapshot.routes.iter().filter(|route| route.share * route.reliability > 0.0);
    let links: Vec<_> = carries.map(|route| (route.from, route.to)).collect();
    let mut connected = vec![false; limits.robots()];
    tree::mark_connected(&links, &mut connected);
    let sends_nothing = |robot: usize| {
        limits.rates()[robot] == 0.0 && links.iter().all(|&(_, receiver)| receiver != robot)
    };
    let mut knows_way = vec![has_begun(snapshot); limits.robots()];
    for &(robot, _) in &snapshot.tree {
        knows_way[robot] = true;
    }
    let unconnected =
        |&robot: &usize| !connected[robot] && !sends_nothing(robot) && knows_way[robot];
    match (0..connected.len()).find(unconnected) {
        None => Ok(()),
        Some(robot) => Err(Instant::of(snapshot).violation(
            Property::Connectivity,
            &[robot],
            (0.0, 1.0),
            format!("no path of links with T·R > 0 leads from robot {robot} to an access point"),
        )),
    }
}

/// [`Property::SingleParent`], [`Property::RootedTree`] and [`Property::TreeMembership`].
///
/// # Errors
///
/// The first robot that has two parents, comes to no access point, or is left out.
pub fn tree(snapshot: &Snapshot, limits: &Limits) -> Result<(), Violation> {
    let mut parents = vec![None; limits.robots()];
    let fault = |property, robot: usize, clause| {
        let sentence = format!("robot {robot} {clause}");
        Err(Instant::of(snapshot).violation(property, &[robot], (0.0, 1.0), sentence))
    };
    if let Err(robot) = tree::parents_of(&snapshot.tree, &mut parents) {
        return fault(Property::SingleParent, robot, "has two parents in the tree");
    }
    let mut members = (0..parents.len()).filter(|&robot| parents[robot].is_some());
    if let Some(robot) = members.find(|&robot| !tree::leads_to_access_point(&parents, robot)) {
        return fault(Property::RootedTree, robot, "comes to no access point along the tree");
    }
    for (robot, (&role, &parent)) in snapshot.roles.iter().zip(&parents).enumerate() {
        if !tree::is_member_unless_redundant(role, parent) {
            return fault(Property::TreeMembership, robot, "has a duty and no parent in the tree");
        }
    }
    Ok(())
}

/// [`Property::SingleLeader`], [`Property::LeaderLast`], [`Property::ActiveTeam`] and
/// [`Property::DisjointTeams`].
///
/// # Errors
///
/// The first of these that fails, with the teams.
pub fn teams(snapshot: &Snapshot) -> Result<(), Violation> {
    let Snapshot { roles, active, active_team, primary_team, path, .. } = snapshot;
    let fault = |property, robots: &[usize], sentence| {
        Err(Instant::of(snapshot).violation(property, robots, (0.0, 1.0), sentence))
    };
    if !team::has_at_most_one_leader(roles) {
        return fault(Property::SingleLeader, &[], "more than one robot leads".to_owned());
    }
    let primary_is_active = !active_team.is_empty() && active_team == primary_team;
    if !team::leader_comes_last(roles, primary_team, primary_is_active) {
        let sentence = format!("the leader is not the last of the primary team {primary_team:?}");
        return fault(Property::LeaderLast, primary_team, sentence);
    }
    if !team::is_one_team(active_team, primary_team, path) {
        let sentence = format!(
            "the active team {active_team:?} is neither the primary team {primary_team:?} nor a \
             subgroup of the path {path:?}"
        );
        return fault(Property::ActiveTeam, active_team, sentence);
    }
    if let Some(robot) = active_team.iter().find(|robot| active.binary_search(robot).is_err()) {
        let sentence = format!("robot {robot} is in the active team and may not move");
        return fault(Property::ActiveTeam, &[*robot], sentence);
    }
    if !team::teams_are_disjoint(path, primary_team) {
        let sentence = format!(
            "the path {path:?} meets the primary team {primary_team:?} before its last robot"
        );
        return fault(Property::DisjointTeams, path, sentence);
    }
    Ok(())
}

/// [`Property::Service`] at the instant: the robot that is answerable for a task is within δ.
///
/// # Errors
///
/// The first robot that is too far from its task.
pub fn service(snapshot: &Snapshot, limits: &Limits) -> Result<(), Violation> {
    let bound = limits.service_radius();
    for &(task, robot) in &snapshot.serviced {
        let distance = (snapshot.positions[robot] - limits.tasks()[task]).norm();
        if distance > bound + SLACK {
            return Err(Instant::of(snapshot).violation(
                Property::Service,
                &[robot],
                (distance, bound),
                format!(
                    "robot {robot} services task {task} from {distance:.6}, more than {bound:.6}"
                ),
            ));
        }
    }
    Ok(())
}

/// [`Property::Occupancy`] at the instant.
///
/// # Errors
///
/// The first holder of a junction or task that is too far from its post.
pub fn occupancy(snapshot: &Snapshot, limits: &Limits) -> Result<(), Violation> {
    let bound = limits.service_radius();
    for post in snapshot.posts.iter().filter(|post| post.junction || post.task.is_some()) {
        let distance = (snapshot.positions[post.holder] - post.reference).norm();
        if distance > bound + SLACK {
            return Err(Instant::of(snapshot).violation(
                Property::Occupancy,
                &[post.holder],
                (distance, bound),
                format!(
                    "robot {} is {distance:.6} away from the post ({:.6}, {:.6}) that it holds, \
                     more than {bound:.6}",
                    post.holder, post.reference.x, post.reference.y
                ),
            ));
        }
    }
    Ok(())
}
