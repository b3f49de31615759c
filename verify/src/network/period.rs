//! What holds at every instant between two snapshots.
//!
//! Distances between uniform motions are convex in time, so "never nearer than" is a closest
//! approach in closed form ([`motion`](super::motion)) and "never farther than" is a check of
//! the two ends; the same goes for loads (see [`link`]).

use std::collections::BTreeSet;

use pleach_automaton::network::record::{Route, Snapshot};
use pleach_continuous::geometry::Segment;

use super::duty::{self, RoleRelation};
use super::extremes::Extreme;
use super::limits::{Limits, SLACK};
use super::link::{self, HeldFlow, NodePositions};
use super::motion::{farthest_distance, first_gap, interval_within};
use super::property::Property;
use super::separation::closest_pair;
use super::violation::{Instant, Violation};

/// A control period: two well-formed snapshots ([`instant::record`](super::instant::record))
/// and the motions between them.
#[derive(Debug)]
pub struct Period<'a> {
    before: &'a Snapshot,
    after: &'a Snapshot,
    motions: Vec<Segment>,
}

impl<'a> Period<'a> {
    /// The period between consecutive snapshots.
    ///
    /// # Errors
    ///
    /// [`Property::Record`] if their steps do not follow each other, time does not grow, or the
    /// numbers of robots differ.
    pub fn between(before: &'a Snapshot, after: &'a Snapshot) -> Result<Self, Violation> {
        let follows = after.step == before.step + 1
            && after.time > before.time
            && after.positions.len() == before.positions.len();
        if follows { Ok(Period::of(before, after)) } else { Err(Period::gap(before, after)) }
    }

    /// The period that ends with a snapshot: after the previous one, or the opening if there is none.
    ///
    /// # Errors
    ///
    /// As for [`between`](Self::between).
    pub(super) fn ending(
        previous: Option<&'a Snapshot>,
        snapshot: &'a Snapshot,
    ) -> Result<Self, Violation> {
        match previous {
            Some(previous) => Period::between(previous, snapshot),
            None => Ok(Period::opening(snapshot)),
        }
    }

    /// What lies between two snapshots where nodes begin their control periods at different times: a whole period or a
    /// part of one.
    ///
    /// # Errors
    ///
    /// [`Property::Record`] if a period is left out, time goes back, or the numbers of robots differ.
    pub(super) fn part(before: &'a Snapshot, after: &'a Snapshot) -> Result<Self, Violation> {
        let follows = (before.step..=before.step + 1).contains(&after.step)
            && after.time >= before.time
            && after.positions.len() == before.positions.len();
        if follows { Ok(Period::of(before, after)) } else { Err(Period::gap(before, after)) }
    }

    fn of(before: &'a Snapshot, after: &'a Snapshot) -> Self {
        let ends = before.positions.iter().zip(&after.positions);
        let motions = ends.map(|(&from, &to)| Segment { from, to }).collect();
        Period { before, after, motions }
    }

    fn gap(before: &Snapshot, after: &Snapshot) -> Violation {
        Instant::of(after).violation(
            Property::Record,
            &[],
            (after.time, before.time),
            format!("it does not follow step {} at t = {} s", before.step, before.time),
        )
    }

    /// The opening of a mission: a period without duration in which every robot rests.
    pub(super) fn opening(snapshot: &'a Snapshot) -> Self {
        let motions = snapshot.positions.iter().copied().map(Segment::still).collect();
        Period { before: snapshot, after: snapshot, motions }
    }

    /// The motions of which something is new: every one when the mission opens, then those of the
    /// robots that move. Where a robot rests, it stands at the end of an earlier motion.
    fn news(&self) -> impl Iterator<Item = (usize, &Segment)> {
        let opens = std::ptr::eq(self.before, self.after);
        self.motions.iter().enumerate().filter(move |(_, motion)| opens || motion.from != motion.to)
    }

    fn start(&self) -> Instant {
        Instant::of(self.before)
    }

    fn end(&self) -> Instant {
        Instant::between(self.before, self.after, 1.0)
    }

    fn at(&self, fraction: f64) -> Instant {
        Instant::between(self.before, self.after, fraction)
    }
}

/// [`Property::Separation`]; the smallest distance of a pair, for the summary.
///
/// # Errors
///
/// The closest pair, if it comes nearer than 2ρ.
pub fn separation(period: &Period, limits: &Limits) -> Result<Option<Extreme>, Violation> {
    let robots: Vec<usize> = (0..period.motions.len()).collect();
    separation_among(&robots, period, limits)
}

/// The same among these robots, by their numbers; those that the record does not know do not count.
///
/// # Errors
///
/// The closest pair, if it comes nearer than 2ρ.
pub(super) fn separation_among(
    robots: &[usize],
    period: &Period,
    limits: &Limits,
) -> Result<Option<Extreme>, Violation> {
    let bound = limits.separation();
    let (robots, motions): (Vec<usize>, Vec<Segment>) =
        robots.iter().filter_map(|&it| Some((it, *period.motions.get(it)?))).unzip();
    let Some(pair) = closest_pair(&motions, bound) else { return Ok(None) };
    let (value, instant) = (pair.approach.distance, period.at(pair.approach.fraction));
    let robots = vec![robots[pair.first], robots[pair.second]];
    if value < bound - SLACK {
        let sentence = format!(
            "robots {} and {} come within {value:.6} of each other, less than {bound:.6}",
            robots[0], robots[1]
        );
        return Err(instant.violation(Property::Separation, &robots, (value, bound), sentence));
    }
    Ok(Some(Extreme { value, instant, robots }))
}

/// [`Property::Clearance`]; the smallest clearance of a robot that moves, for the summary.
///
/// Exact for the whole segment; outside the workspace it is not positive. The instant reported
/// is the start of the period.
///
/// # Errors
///
/// The robot with the smallest clearance, if that is less than ρ.
pub fn clearance(period: &Period, limits: &Limits) -> Result<Option<Extreme>, Violation> {
    let bound = limits.clearance();
    let of_motion = |motion: &Segment| limits.workspace().segment_clearance(motion.from, motion.to);
    let clearances = period.news().map(|(robot, motion)| (robot, of_motion(motion)));
    let smallest = clearances.min_by(|one, other| one.1.total_cmp(&other.1));
    let Some((robot, value)) = smallest else { return Ok(None) };
    let instant = period.start();
    if value.is_nan() || value < bound - SLACK {
        let (from, to) = (period.motions[robot].from, period.motions[robot].to);
        let sentence = format!(
            "robot {robot} comes within {value:.6} of a wall between ({:.6}, {:.6}) and ({:.6}, \
             {:.6}), less than {bound:.6}",
            from.x, from.y, to.x, to.y
        );
        return Err(instant.violation(Property::Clearance, &[robot], (value, bound), sentence));
    }
    Ok(Some(Extreme { value, instant, robots: vec![robot] }))
}

/// [`Property::StepLength`].
///
/// # Errors
///
/// The first robot that travels too far.
pub fn step_length(period: &Period, limits: &Limits) -> Result<(), Violation> {
    let bound = limits.step_radius();
    let mut lengths = period.motions.iter().map(Segment::length).enumerate();
    match lengths.find(|(_, length)| *length > bound + SLACK) {
        None => Ok(()),
        Some((robot, length)) => Err(period.end().violation(
            Property::StepLength,
            &[robot],
            (length, bound),
            format!("robot {robot} travels {length:.6} in one period, more than {bound:.6}"),
        )),
    }
}

/// [`Property::Standstill`]: exactly, without slack, as nothing is computed for such a robot.
///
/// # Errors
///
/// The first robot that moves without being active.
pub fn standstill(period: &Period) -> Result<(), Violation> {
    let active = &period.before.active;
    stay(period, |robot| active.binary_search(&robot).is_err(), "not active")
}

/// Part of [`Property::Standstill`]: robots that do not run, or are not heard, are where they were.
///
/// # Errors
///
/// The first that is not.
pub(super) fn absent_stay(period: &Period) -> Result<(), Violation> {
    let absent = [period.before, period.after].map(|it| &it.absent);
    stay(period, |robot| absent.iter().all(|nodes| nodes.contains(&robot)), "absent")
}

/// Robots that are to stay, since they are `being`, do not move.
fn stay(period: &Period, is_to_stay: impl Fn(usize) -> bool, being: &str) -> Result<(), Violation> {
    let moves =
        |(robot, motion): &(usize, &Segment)| motion.from != motion.to && is_to_stay(*robot);
    match period.motions.iter().enumerate().find(moves) {
        None => Ok(()),
        Some((robot, motion)) => {
            let length = motion.length();
            Err(period.start().violation(
                Property::Standstill,
                &[robot],
                (length, 0.0),
                format!("robot {robot} moves by {length:e} and is {being}"),
            ))
        }
    }
}

/// [`Property::Load`]; the largest load, for the summary.
///
/// The flows are those of the routes when the period begins. The load at both ends bounds the
/// load between them by the lemma of [`link`].
///
/// # Errors
///
/// The first sender that cannot hold its flows.
pub fn load(period: &Period, limits: &Limits) -> Result<Option<Extreme>, Violation> {
    let mut routes: Vec<&Route> = period.before.routes.iter().collect();
    routes.sort_by_key(|route| route.from);
    let ends = [(period.before, period.start()), (period.after, period.end())];
    let mut largest: Option<Extreme> = None;
    for of_sender in routes.chunk_by(|one, other| one.from == other.from) {
        for (snapshot, instant) in ends {
            let value = load_in(snapshot, of_sender, limits);
            let robots = vec![of_sender[0].from];
            if value.is_nan() || value > 1.0 + SLACK {
                let sentence = load_sentence(of_sender, value);
                return Err(instant.violation(Property::Load, &robots, (value, 1.0), sentence));
            }
            if largest.as_ref().is_none_or(|largest| value > largest.value) {
                largest = Some(Extreme { value, instant, robots });
            }
        }
    }
    Ok(largest)
}

/// The load of the sender of these routes with the positions of a snapshot.
fn load_in(snapshot: &Snapshot, routes: &[&Route], limits: &Limits) -> f64 {
    let places =
        NodePositions { robots: &snapshot.positions, access_points: limits.access_points() };
    let held: Vec<_> = routes
        .iter()
        .map(|route| HeldFlow {
            flow: route.share * route.reliability,
            distance: places.distance(route.from, route.to),
        })
        .collect();
    link::load(&held, |distance| limits.reliability(distance))
}

fn load_sentence(routes: &[&Route], load: f64) -> String {
    let receivers: Vec<_> = routes.iter().map(|route| route.to).collect();
    let sender = routes[0].from;
    if load.is_infinite() {
        format!("robot {sender} holds a flow to one of {receivers:?} that is out of range")
    } else {
        format!("robot {sender} needs {load:.6} of its time to hold its flows to {receivers:?}")
    }
}

/// [`Property::TreeRange`]: the edges of the tree at the start of the period stay in range
/// until its end, and those at its end are in range then.
///
/// # Errors
///
/// The first edge that is not.
pub fn tree_range(period: &Period, limits: &Limits) -> Result<(), Violation> {
    let Period { before, after, motions } = period;
    let bound = limits.max_range();
    let motion_of = |node: usize| {
        let fixed = || Segment::still(limits.access_points()[node - motions.len()]);
        motions.get(node).copied().unwrap_or_else(fixed)
    };
    let check = |&(child, parent): &(usize, usize), distance: f64| {
        if distance < bound {
            return Ok(());
        }
        Err(period.end().violation(
            Property::TreeRange,
            &[child, parent],
            (distance, bound),
            format!("the tree edge {child} → {parent} has the length {distance:.6}; R = 0"),
        ))
    };
    for edge in &before.tree {
        check(edge, farthest_distance(&motion_of(edge.0), &motion_of(edge.1)))?;
    }
    for edge in &after.tree {
        check(edge, (motion_of(edge.0).to - motion_of(edge.1).to).norm())?;
    }
    Ok(())
}

/// [`Property::RoleTransition`], by the closure of the table, as several jumps may lie between
/// two snapshots.
///
/// # Errors
///
/// The first robot whose role cannot have come about.
pub fn role_transitions(period: &Period, relation: &RoleRelation) -> Result<(), Violation> {
    let roles = period.before.roles.iter().zip(&period.after.roles);
    for (robot, (&from, &to)) in roles.enumerate() {
        if !duty::is_reachable(relation, from, to) {
            return Err(period.end().violation(
                Property::RoleTransition,
                &[robot],
                (0.0, 1.0),
                format!("robot {robot} turns from {} to {}", from.name(), to.name()),
            ));
        }
    }
    Ok(())
}

/// [`Property::Duties`]: of the tasks serviced before that are not `closed`, each is serviced after, once.
///
/// # Errors
///
/// The tasks before and after, if they differ.
pub fn duties(period: &Period, closed: &BTreeSet<usize>) -> Result<(), Violation> {
    let tasks = |snapshot: &Snapshot| -> Vec<usize> {
        let tasks = snapshot.serviced.iter().map(|&(task, _)| task);
        tasks.filter(|task| !closed.contains(task)).collect()
    };
    let before = tasks(period.before);
    let after = tasks(period.after);
    let kept: Vec<_> = after.iter().copied().filter(|task| before.contains(task)).collect();
    if duty::are_conserved(&before, &kept) && super::team::has_no_repetition(&after) {
        return Ok(());
    }
    let sentence = format!("the serviced tasks were {before:?} and are {after:?}");
    Err(period.end().violation(Property::Duties, &[], (0.0, 1.0), sentence))
}

/// [`Property::Service`] during the period: the robots' intervals within δ of a task cover it.
///
/// The robot that is answerable usually covers it alone; the others are asked only if not.
///
/// # Errors
///
/// The first instant at which no robot is near a serviced task.
pub fn service(period: &Period, limits: &Limits) -> Result<(), Violation> {
    let bound = limits.service_radius();
    for &(task, robot) in &period.before.serviced {
        let place = limits.tasks()[task];
        let within = |motion: &Segment| interval_within(motion, place, bound + SLACK);
        if within(&period.motions[robot]) == Some((0.0, 1.0)) {
            continue;
        }
        let mut intervals: Vec<_> = period.motions.iter().filter_map(within).collect();
        if let Some(fraction) = first_gap(&mut intervals) {
            let nearest = |motion: &Segment| (motion.at(fraction) - place).norm();
            let distance = period.motions.iter().map(nearest).fold(f64::INFINITY, f64::min);
            return Err(period.at(fraction).violation(
                Property::Service,
                &[robot],
                (distance, bound),
                format!(
                    "robot {robot} leaves task {task}, and no robot is within {bound:.6} of it"
                ),
            ));
        }
    }
    Ok(())
}

/// [`Property::Occupancy`] during the period: the robot that holds a junction or a task when it begins
/// is within δ of the post until it ends, so that at a hand-over both are.
///
/// # Errors
///
/// The first holder that leaves.
pub fn occupancy(period: &Period, limits: &Limits) -> Result<(), Violation> {
    let bound = limits.service_radius();
    for post in period.before.posts.iter().filter(|post| post.junction || post.task.is_some()) {
        let rest = Segment::still(post.reference);
        let distance = farthest_distance(&period.motions[post.holder], &rest);
        if distance > bound + SLACK {
            return Err(period.end().violation(
                Property::Occupancy,
                &[post.holder],
                (distance, bound),
                format!(
                    "robot {} leaves the post ({:.6}, {:.6}) that it holds: it is {distance:.6} \
                     away, more than {bound:.6}",
                    post.holder, post.reference.x, post.reference.y
                ),
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::sample;
    use nalgebra::{Point2, point};
    use proptest::prelude::*;

    const SAMPLES: u32 = 400;

    /// The distance of a place to a wall, by projection.
    fn distance_to_wall(place: Point2<f64>, from: Point2<f64>, to: Point2<f64>) -> f64 {
        let wall = to - from;
        let share = ((place - from).dot(&wall) / wall.norm_squared()).clamp(0.0, 1.0);
        (from + wall * share - place).norm()
    }

    fn place() -> impl Strategy<Value = Point2<f64>> {
        (-0.9..1.9, -0.9..0.9).prop_map(|(x, y)| point![x, y])
    }

    proptest! {
        #[test]
        fn clearance_is_what_dense_sampling_tends_to(from in place(), to in place()) {
            let hole = [[0.4, -0.3], [0.9, -0.1], [0.6, 0.4]];
            let mut scenario = sample::stated();
            scenario.workspace.holes = vec![hole.to_vec()];
            scenario.control.clearance = Some(1e-4); // the smallest that there may be
            scenario.robot.truncate(1);
            let limits = Limits::of(&sample::valid(scenario.clone()));
            let polygons = [&scenario.workspace.boundary[..], &hole];
            let walls: Vec<_> = polygons
                .iter()
                .flat_map(|polygon| {
                    let next = polygon.iter().cycle().skip(1);
                    polygon.iter().zip(next).map(|(&one, &other)| (one.into(), other.into()))
                })
                .collect();
            let motion = Segment { from, to };
            let sampled = (0..=SAMPLES)
                .map(|sample| motion.at(f64::from(sample) / f64::from(SAMPLES)))
                .flat_map(|place| walls.iter().map(move |w| distance_to_wall(place, w.0, w.1)))
                .fold(f64::INFINITY, f64::min);

            let mut snapshot = sample::snapshot(0);
            snapshot.positions = vec![from];
            let period = Period { before: &snapshot, after: &snapshot, motions: vec![motion] };
            // A sample lies within half a step of the nearest instant.
            let spacing = motion.length() / f64::from(SAMPLES) / 2.0;
            let smallest = match clearance(&period, &limits) {
                Ok(smallest) => smallest.unwrap().value,
                Err(violation) => violation.measured,
            };
            if smallest > 0.0 {
                prop_assert!(smallest <= sampled + 1e-12);
                prop_assert!(sampled - smallest <= spacing + 1e-12);
            } else {
                // It starts inside the hole, ends there or passes through: the walls are met,
                // or both ends lie inside.
                let inside = |place| !limits.workspace().contains(place);
                prop_assert!(sampled <= spacing + 1e-12 || inside(from) && inside(to));
            }
        }
    }
}
