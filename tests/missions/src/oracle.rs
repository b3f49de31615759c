//! A second opinion on a trace: what the properties of a mission say, computed from scratch.
//!
//! Of the packages under test it uses the reader of traces and what that returns, and nothing else. Distances along
//! segments are exact; loads are sampled.

use pleach::automaton::network::record::{MissionEvent, Route, Snapshot};
use pleach::automaton::network::scenario::Scenario;
use pleach::trace::{TraceEntry, TraceReader};
use std::io::BufRead;

/// Instants of each control period at which loads are computed, both ends included.
const SAMPLES: usize = 20;
/// How far numbers may lie beyond their bounds.
const SLACK: f64 = 1e-6;
/// How far two computations of the same number may differ.
const ROUNDING: f64 = 1e-9;

type Place = [f64; 2];

/// The extremes that the oracle measures.
#[derive(Clone, Copy, Debug)]
pub struct Findings {
    /// The least distance of two robots.
    pub pair_distance: f64,
    /// The least distance of a robot from a wall.
    pub clearance: f64,
    /// The least residual.
    pub residual: f64,
    /// The largest load.
    pub load: f64,
}

/// Reads a trace and measures it.
///
/// # Errors
/// The first thing that is not as it should be, in a sentence.
pub fn audit<R: BufRead>(reader: TraceReader<R>) -> Result<Findings, String> {
    let plan = Plan::of(reader.scenario());
    let mut findings = Findings {
        pair_distance: f64::INFINITY,
        clearance: f64::INFINITY,
        residual: f64::INFINITY,
        load: 0.0,
    };
    let mut before: Option<Box<Snapshot>> = None;
    let mut over = Vec::new();
    for entry in reader {
        let now = match entry.map_err(|error| error.to_string())? {
            TraceEntry::Step(now) => now,
            TraceEntry::Event { event, .. } => {
                over.extend(closed_by(&event));
                continue;
            }
            _ => continue,
        };
        // Nobody has to stay with a task that is over.
        if let Some(last) = &mut before {
            last.serviced.retain(|(task, _)| !over.contains(task));
        }
        let fault = |what: String| format!("k = {}: {what}", now.step);
        let start = before.as_deref().unwrap_or(&now);
        plan.journey(start, &now, &mut findings).map_err(fault)?;
        plan.stand(&now, &mut findings).map_err(fault)?;
        before = Some(now);
    }
    Ok(findings)
}

/// The task that is over from an event on.
const fn closed_by(event: &MissionEvent) -> Option<usize> {
    match *event {
        MissionEvent::TaskEnded { task } | MissionEvent::TaskWithdrawn { task } => Some(task),
        _ => None,
    }
}

/// The scenario as the oracle sees it.
struct Plan {
    /// The sides of all polygons.
    walls: Vec<[Place; 2]>,
    access_points: Vec<Place>,
    tasks: Vec<Place>,
    rates: Vec<f64>,
    full_range: f64,
    max_range: f64,
    clearance: f64,
    step_radius: f64,
    service_radius: f64,
}

impl Plan {
    /// The trace's header has every default filled in.
    fn of(scenario: &Scenario) -> Self {
        let outline = &scenario.workspace;
        let polygons = outline.holes.iter().chain([&outline.boundary]);
        let sides = |polygon: &Vec<Place>| -> Vec<[Place; 2]> {
            let next = polygon.iter().cycle().skip(1);
            polygon.iter().zip(next).map(|(&from, &to)| [from, to]).collect()
        };
        let control = &scenario.control;
        Plan {
            walls: polygons.flat_map(sides).collect(),
            access_points: scenario.access_point.iter().map(|point| point.position).collect(),
            tasks: scenario.task.iter().map(|task| task.position).collect(),
            rates: scenario.robot.iter().map(|robot| robot.rate).collect(),
            full_range: scenario.link.full_range,
            max_range: scenario.link.max_range,
            clearance: control.clearance.expect("filled in"),
            step_radius: control.step_radius.expect("filled in"),
            service_radius: control.service_radius.expect("filled in"),
        }
    }

    fn robots(&self) -> usize {
        self.rates.len()
    }

    /// Eq. (27), in the form of the smooth step.
    fn reliability(&self, distance: f64) -> f64 {
        let s = (distance - self.full_range) / (self.max_range - self.full_range);
        if s <= 0.0 {
            1.0
        } else if s >= 1.0 {
            0.0
        } else {
            (1.0 - s) * (1.0 - s) * (1.0 + 2.0 * s)
        }
    }

    /// Where a node is, a share of the period after `before`.
    fn place(&self, before: &Snapshot, now: &Snapshot, node: usize, share: f64) -> Place {
        if node >= self.robots() {
            return self.access_points[node - self.robots()];
        }
        let [from, to] = [before, now].map(|snapshot| <Place>::from(snapshot.positions[node]));
        [0, 1].map(|axis| (1.0 - share) * from[axis] + share * to[axis])
    }

    // ---- At one instant ------------------------------------------------------------------------

    fn stand(&self, now: &Snapshot, findings: &mut Findings) -> Result<(), String> {
        self.routes_are_what_they_span(now)?;
        self.residuals(now, findings)?;
        self.all_are_connected(now)?;
        self.the_tree_is_a_tree(now)?;
        for (robot, &place) in now.positions.iter().enumerate() {
            if !self.is_inside(place.into()) {
                return Err(format!("robot {robot} is outside the workspace"));
            }
        }
        Ok(())
    }

    fn routes_are_what_they_span(&self, now: &Snapshot) -> Result<(), String> {
        for &Route { from, to, share, reliability } in &now.routes {
            let at = |node| self.place(now, now, node, 0.0);
            let expected = self.reliability(length(difference(at(from), at(to))));
            if (reliability - expected).abs() > ROUNDING || !(0.0..=1.0 + SLACK).contains(&share) {
                return Err(format!("route {from} to {to}: {share}, {reliability} for {expected}"));
            }
        }
        Ok(())
    }

    /// Eq. (4): what is sent, less what is received and generated.
    fn residuals(&self, now: &Snapshot, findings: &mut Findings) -> Result<(), String> {
        for (robot, rate) in self.rates.iter().enumerate() {
            let sum = |end: fn(&Route) -> usize| -> f64 {
                let of = now.routes.iter().filter(|route| end(route) == robot);
                of.map(|route| route.share * route.reliability).sum()
            };
            let residual = sum(|route| route.from) - sum(|route| route.to) - rate;
            findings.residual = findings.residual.min(residual);
            if residual < -SLACK || (residual - now.residuals[robot]).abs() > ROUNDING {
                let reported = now.residuals[robot];
                return Err(format!("robot {robot}: residual {residual}, reported {reported}"));
            }
        }
        Ok(())
    }

    /// Information spreads backwards from the access points, until it spreads no more.
    fn all_are_connected(&self, now: &Snapshot) -> Result<(), String> {
        let nodes = self.robots() + self.access_points.len();
        let mut reached: Vec<bool> = (0..nodes).map(|node| node >= self.robots()).collect();
        loop {
            let news: Vec<usize> = (now.routes.iter())
                .filter(|route| route.share * route.reliability > 0.0)
                .filter(|route| reached[route.to] && !reached[route.from])
                .map(|route| route.from)
                .collect();
            if news.is_empty() {
                break;
            }
            news.into_iter().for_each(|robot| reached[robot] = true);
        }
        match reached.iter().position(|reached| !reached) {
            Some(robot) => Err(format!("robot {robot} reaches no access point")),
            None => Ok(()),
        }
    }

    /// Leaves are cut off until nothing is left: a cycle would stay.
    fn the_tree_is_a_tree(&self, now: &Snapshot) -> Result<(), String> {
        let mut edges = now.tree.clone();
        for (at, (child, _)) in edges.iter().enumerate() {
            if edges[..at].iter().any(|(other, _)| other == child) {
                return Err(format!("robot {child} has two parents"));
            }
        }
        if let Some((child, parent)) = edges.iter().find(|&&(_, parent)| {
            parent < self.robots() && !edges.iter().any(|&(child, _)| child == parent)
        }) {
            return Err(format!("robot {child} is attached to {parent}, which has no parent"));
        }
        while !edges.is_empty() {
            let kept: Vec<_> = (edges.iter().copied())
                .filter(|&(child, _)| edges.iter().any(|&(_, parent)| parent == child))
                .collect();
            if kept.len() == edges.len() {
                return Err(format!("the tree has a cycle among {kept:?}"));
            }
            edges = kept;
        }
        Ok(())
    }

    /// Even-odd rule over the sides of all polygons.
    fn is_inside(&self, [x, y]: Place) -> bool {
        let crossings = self.walls.iter().filter(|[a, b]| {
            (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        });
        crossings.count() % 2 == 1
    }

    // ---- Between two instants ------------------------------------------------------------------

    fn journey(
        &self,
        before: &Snapshot,
        now: &Snapshot,
        findings: &mut Findings,
    ) -> Result<(), String> {
        let paths: Vec<[Place; 2]> = (before.positions.iter().zip(&now.positions))
            .map(|(&from, &to)| [from.into(), to.into()])
            .collect();
        self.steps_are_short(before, &paths)?;
        self.robots_keep_apart(&paths, findings)?;
        self.robots_keep_from_walls(&paths, findings)?;
        self.loads(before, now, findings)?;
        self.tasks_stay_serviced(before, now)
    }

    fn steps_are_short(&self, before: &Snapshot, paths: &[[Place; 2]]) -> Result<(), String> {
        for (robot, [from, to]) in paths.iter().enumerate() {
            let step = length(difference(*from, *to));
            if step > self.step_radius + SLACK || (step > 0.0 && !before.active.contains(&robot)) {
                return Err(format!("robot {robot} steps {step}"));
            }
        }
        Ok(())
    }

    /// Seen from one of two robots, the other moves on a segment.
    fn robots_keep_apart(
        &self,
        paths: &[[Place; 2]],
        findings: &mut Findings,
    ) -> Result<(), String> {
        for (second, &[from, to]) in paths.iter().enumerate() {
            for (first, &[other_from, other_to]) in paths[..second].iter().enumerate() {
                let relative = [difference(other_from, from), difference(other_to, to)];
                let distance = distance_to_segment([0.0, 0.0], relative);
                findings.pair_distance = findings.pair_distance.min(distance);
                if distance < 2.0 * self.clearance - SLACK {
                    return Err(format!("robots {first} and {second} are {distance} apart"));
                }
            }
        }
        Ok(())
    }

    fn robots_keep_from_walls(
        &self,
        paths: &[[Place; 2]],
        findings: &mut Findings,
    ) -> Result<(), String> {
        for (robot, &path) in paths.iter().enumerate() {
            for &wall in &self.walls {
                let distance = distance_of_segments(path, wall);
                findings.clearance = findings.clearance.min(distance);
                if distance < self.clearance - SLACK {
                    return Err(format!("robot {robot} comes within {distance} of {wall:?}"));
                }
            }
        }
        Ok(())
    }

    /// The flows of the period's beginning are held, so that shares follow the reliabilities.
    fn loads(
        &self,
        before: &Snapshot,
        now: &Snapshot,
        findings: &mut Findings,
    ) -> Result<(), String> {
        for sample in 0..SAMPLES {
            let share = sample as f64 / (SAMPLES - 1) as f64;
            let mut load = vec![0.0; self.robots()];
            for route in &before.routes {
                let at = |node| self.place(before, now, node, share);
                let span = length(difference(at(route.from), at(route.to)));
                load[route.from] += route.share * route.reliability / self.reliability(span);
            }
            let (robot, largest) =
                load.into_iter().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default();
            findings.load = findings.load.max(largest);
            if largest.is_nan() || largest > 1.0 + SLACK {
                return Err(format!("robot {robot} has load {largest}"));
            }
        }
        Ok(())
    }

    /// The robot that holds a task is within δ of it all the way, for discs are convex, and at the end
    /// of it somebody does.
    fn tasks_stay_serviced(&self, before: &Snapshot, now: &Snapshot) -> Result<(), String> {
        for &(task, robot) in &before.serviced {
            let near = [before, now].iter().all(|snapshot| {
                let offset = difference(snapshot.positions[robot].into(), self.tasks[task]);
                length(offset) <= self.service_radius + SLACK
            });
            if !near || !now.serviced.iter().any(|&(other, _)| other == task) {
                return Err(format!("task {task} is left"));
            }
        }
        Ok(())
    }
}

fn difference(from: Place, to: Place) -> Place {
    [to[0] - from[0], to[1] - from[1]]
}

fn length([x, y]: Place) -> f64 {
    x.hypot(y)
}

fn distance_to_segment(place: Place, [from, to]: [Place; 2]) -> f64 {
    let (along, offset) = (difference(from, to), difference(from, place));
    let square = along[0] * along[0] + along[1] * along[1];
    let product = along[0] * offset[0] + along[1] * offset[1];
    let share = if square > 0.0 { (product / square).clamp(0.0, 1.0) } else { 0.0 };
    length([offset[0] - share * along[0], offset[1] - share * along[1]])
}

/// Two segments that do not cross are nearest at an end of one of them.
fn distance_of_segments(one: [Place; 2], other: [Place; 2]) -> f64 {
    let side = |[from, to]: [Place; 2], place| {
        let (along, offset) = (difference(from, to), difference(from, place));
        along[0] * offset[1] - along[1] * offset[0]
    };
    let parts = |line, [from, to]: [Place; 2]| side(line, from) * side(line, to) < 0.0;
    if parts(one, other) && parts(other, one) {
        return 0.0;
    }
    let ends = one.map(|end| distance_to_segment(end, other));
    let other_ends = other.map(|end| distance_to_segment(end, one));
    ends.into_iter().chain(other_ends).fold(f64::INFINITY, f64::min)
}
