//! How few robots any arrangement takes that services one or two tasks: an exact search over a grid of places.
//!
//! An arrangement is a tree of links from the access points to robots, one of them within δ of each task. Two grids
//! enclose where robots can stand. Of the *wide* one, every place to which a robot can come has a point nearby, and
//! links and δ are as much longer: no arrangement takes fewer robots than one on it. Every point of the *narrow* one is
//! a place to which robots can come: an arrangement on it exists. Nothing here uses the free space of the robots,
//! their routes or their rules; of walls it takes only the distance to them.

use pleach::automaton::network::scenario::{Scenario, Settings};
use pleach::continuous::Point;
use pleach::continuous::geometry::Workspace;
use std::collections::VecDeque;
use std::f64::consts::FRAC_1_SQRT_2;

/// What lengths may be off by rounding.
const ROUNDING: f64 = 1e-9;
/// Arrangements that are tried before those in which robots are too close to each other are given up.
const TRIED: usize = 400;
/// How far apart robots stand at least, in ρ.
const APART: f64 = 2.05;

/// The places of a scenario where robots can stand.
pub struct Arrangements {
    settings: Settings,
    workspace: Workspace,
    access_points: Vec<Point>,
    tasks: Vec<Point>,
    /// Points between which robots are followed on the floor.
    fine: Lattice,
    /// Points at which robots of an arrangement stand: every few of the fine ones.
    coarse: Lattice,
    /// Fine points beside every place to which a robot can come.
    wide: Vec<bool>,
    /// Fine points to which a team of robots can come.
    narrow: Vec<bool>,
    /// How many robots that team has: most of those that start.
    team: usize,
    /// How many fine points make a coarse one, along an axis.
    ratio: usize,
}

impl Arrangements {
    /// Follows the robots of a scenario to wherever they can come.
    pub fn of(scenario: &Scenario) -> Self {
        let settings = Settings::resolve(scenario);
        let (workspace, _) = scenario.workspace().expect("a workspace");
        let spacing = ((settings.link.max_range - settings.link.full_range) / 2.0)
            .min(settings.service_radius / 2.0);
        let least = (2.0 * spacing / settings.clearance).ceil() as usize;
        let ratio = least + 1 - least % 2;
        let (low, high) = extent(&workspace);
        let coarse = Lattice::over(low, high, spacing);
        let fine = Lattice {
            step: spacing / ratio as f64,
            columns: (coarse.columns - 1) * ratio + 1,
            rows: (coarse.rows - 1) * ratio + 1,
            ..coarse
        };
        let clearances: Vec<f64> =
            (0..fine.count()).map(|index| workspace.clearance(fine.place(index))).collect();
        let starts: Vec<Point> = scenario.robot.iter().map(|it| it.position.into()).collect();
        let mut arrangements = Arrangements {
            access_points: scenario.access_point.iter().map(|it| it.position.into()).collect(),
            tasks: scenario.task.iter().map(|it| it.position.into()).collect(),
            settings,
            workspace,
            fine,
            coarse,
            wide: Vec::new(),
            narrow: Vec::new(),
            team: 0,
            ratio,
        };
        arrangements.wide = arrangements.widely_reached(&starts, &clearances);
        (arrangements.narrow, arrangements.team) =
            arrangements.narrowly_reached(&starts, &clearances);
        arrangements
    }

    /// A way of a robot runs from the cell of one fine point to that of a neighbour, also across a corner, and the
    /// points are no farther from it than half a diagonal.
    fn widely_reached(&self, starts: &[Point], clearances: &[f64]) -> Vec<bool> {
        let least = self.settings.clearance - FRAC_1_SQRT_2 * self.fine.step - ROUNDING;
        let seeds = starts.iter().map(|&start| self.fine.nearest(start));
        self.fine.flooded(seeds.collect(), true, |_, to| clearances[to] >= least)
    }

    /// From point to point along the axes, never closer to walls than ρ.
    fn narrowly_reached(&self, starts: &[Point], clearances: &[f64]) -> (Vec<bool>, usize) {
        let (fine, rho) = (&self.fine, self.settings.clearance);
        let is_open = |from: Point, to: Point| self.workspace.segment_clearance(from, to) >= rho;
        let step = |from: usize, to: usize| {
            let least = clearances[from].min(clearances[to]);
            least >= rho + fine.step / 2.0
                || least >= rho && is_open(fine.place(from), fine.place(to))
        };
        let seeds = |start: Point| {
            let around = fine.around(start);
            let is_seed =
                |&point: &usize| clearances[point] >= rho && is_open(start, fine.place(point));
            around.into_iter().filter(is_seed).collect::<Vec<usize>>()
        };
        let floods = starts.iter().map(|&start| fine.flooded(seeds(start).into(), false, step));
        let team = |flood: &Vec<bool>| {
            let is_there = |start: &&Point| seeds(**start).iter().any(|&point| flood[point]);
            starts.iter().filter(is_there).count()
        };
        floods
            .map(|flood| (team(&flood), flood))
            .max_by_key(|(team, _)| *team)
            .map(|(team, flood)| (flood, team))
            .expect("a robot")
    }

    /// How many robots can come to every point of the narrow grid: not more than arrangements there may take.
    pub fn team(&self) -> usize {
        self.team
    }

    /// Whether no robot can come within δ of a task.
    pub fn is_out_of_reach(&self, task: usize) -> bool {
        let reach = self.settings.service_radius + FRAC_1_SQRT_2 * self.fine.step + ROUNDING;
        !self.is_near(task, reach, &self.wide)
    }

    /// Whether a robot can come within δ of a task.
    pub fn is_in_reach(&self, task: usize) -> bool {
        self.is_near(task, self.settings.service_radius - ROUNDING, &self.narrow)
    }

    fn is_near(&self, task: usize, reach: f64, points: &[bool]) -> bool {
        let place = self.tasks[task];
        let near = |index: usize| (self.fine.place(index) - place).norm() <= reach;
        (0..points.len()).any(|index| points[index] && near(index))
    }

    /// How many robots any arrangement takes that services these tasks at the same time, at least: none if no robot
    /// comes near one of them.
    pub fn least(&self, tasks: &[usize]) -> Option<usize> {
        let slack = FRAC_1_SQRT_2 * self.coarse.step + ROUNDING;
        let mut points = vec![false; self.coarse.count()];
        let half = self.ratio / 2;
        for index in (0..self.wide.len()).filter(|&index| self.wide[index]) {
            let (column, row) = self.fine.at(index);
            let [column, row] = [column, row].map(|it| (it + half) / self.ratio);
            points[self.coarse.index(column, row)] = true;
        }
        let range = self.settings.link.max_range;
        let search = Search {
            lattice: &self.coarse,
            points,
            to_access: range + slack,
            link: range + 2.0 * slack,
        };
        let (from_access, to_tasks) =
            self.hops(&search, tasks, self.settings.service_radius + slack);
        totals(&from_access, &to_tasks).map(|(total, _)| total).min()
    }

    /// An arrangement of up to `most` robots with links up to `reach` long that services these tasks at the same time,
    /// if one is found: where the robots stand.
    pub fn found(&self, tasks: &[usize], reach: f64, most: usize) -> Option<Vec<Point>> {
        let points = (0..self.coarse.count()).map(|index| {
            let (column, row) = self.coarse.at(index);
            self.narrow[self.fine.index(column * self.ratio, row * self.ratio)]
        });
        let reach = reach - ROUNDING;
        let search = Search {
            lattice: &self.coarse,
            points: points.collect(),
            to_access: reach,
            link: reach,
        };
        let delta = self.settings.service_radius - ROUNDING;
        let (from_access, to_tasks) = self.hops(&search, tasks, delta);
        let mut candidates: Vec<_> =
            totals(&from_access, &to_tasks).filter(|(total, _)| *total <= most).collect();
        candidates.sort_by_key(|(total, _)| *total);
        let every = candidates.len().div_ceil(TRIED).max(1);
        candidates.iter().step_by(every).find_map(|&(_, branch)| {
            let places = match branch {
                Some(point) => self.spread(&search, point, &from_access, &to_tasks),
                None => self.spread_from_access(&search, &from_access, &to_tasks),
            };
            self.is_arrangement(&places, tasks, reach).then_some(places)
        })
    }

    /// Robots from the access points to each point, that at the point included; and for each task robots from each
    /// point to the task, that at the point excluded.
    fn hops(&self, search: &Search, tasks: &[usize], delta: f64) -> (Vec<Hops>, Vec<Vec<Hops>>) {
        let near = |centers: &[Point], reach: f64| search.near(centers, reach);
        let mut from_access = search.hops(near(&self.access_points, search.to_access));
        from_access.iter_mut().flatten().for_each(|hops| *hops += 1);
        let to_task = |&task: &usize| search.hops(near(&[self.tasks[task]], delta));
        (from_access, tasks.iter().map(to_task).collect())
    }

    /// Robots at a point, and in chains from there to the access points and the tasks, far from each other.
    fn spread(
        &self,
        search: &Search,
        branch: usize,
        from_access: &[Hops],
        to_tasks: &[Vec<Hops>],
    ) -> Vec<Point> {
        let mut places = vec![self.coarse.place(branch)];
        for hops in std::iter::once(from_access).chain(to_tasks.iter().map(Vec::as_slice)) {
            search.follow(branch, hops, &mut places);
        }
        places
    }

    /// A chain of robots for each task.
    fn spread_from_access(
        &self,
        search: &Search,
        from_access: &[Hops],
        to_tasks: &[Vec<Hops>],
    ) -> Vec<Point> {
        let mut places = Vec::new();
        for hops in to_tasks {
            let total = |&point: &usize| Some(from_access[point]? + hops[point]?);
            let first = (0..hops.len()).filter(|point| from_access[*point] == Some(1));
            let Some(first) = first.filter(|point| total(point).is_some()).min_by_key(total) else {
                continue;
            };
            places.push(self.coarse.place(first));
            search.follow(first, hops, &mut places);
        }
        places
    }

    /// Whether robots at these places are apart from each other, linked with an access point, and near all tasks.
    fn is_arrangement(&self, places: &[Point], tasks: &[usize], reach: f64) -> bool {
        let apart = APART * self.settings.clearance;
        let are_apart = (places.iter().enumerate())
            .all(|(at, one)| places[..at].iter().all(|other| (one - other).norm() >= apart));
        let near = |task: &usize| {
            let distance = |place: &Point| (place - self.tasks[*task]).norm();
            places.iter().any(|place| distance(place) <= self.settings.service_radius)
        };
        let mut linked = self.access_points.clone();
        let mut waiting = places.to_vec();
        while let Some(at) = (waiting.iter())
            .position(|place| linked.iter().any(|other| (place - other).norm() <= reach))
        {
            linked.push(waiting.swap_remove(at));
        }
        are_apart && waiting.is_empty() && tasks.iter().all(near)
    }
}

/// How many robots arrangements take that divide at each point, or at the access points.
fn totals<'a>(
    from_access: &'a [Hops],
    to_tasks: &'a [Vec<Hops>],
) -> impl Iterator<Item = (usize, Option<usize>)> + 'a {
    let at_point = |point: usize| {
        let ways = to_tasks.iter().map(|hops| hops[point]).sum::<Option<usize>>();
        Some((from_access[point]? + ways?, Some(point)))
    };
    let alone = |hops: &Vec<Hops>| {
        let ways = from_access.iter().zip(hops);
        ways.filter_map(|(&before, &behind)| Some(before? + behind?)).min()
    };
    let at_access = to_tasks.iter().map(alone).sum::<Option<usize>>();
    (0..from_access.len()).filter_map(at_point).chain(at_access.map(|total| (total, None)))
}

/// A number of robots, if they can stand so.
type Hops = Option<usize>;

/// Points where robots may stand, with how far they reach.
struct Search<'a> {
    lattice: &'a Lattice,
    points: Vec<bool>,
    to_access: f64,
    link: f64,
}

impl Search<'_> {
    /// The points within `reach` of one of these places.
    fn near(&self, centers: &[Point], reach: f64) -> Vec<usize> {
        let is_near = |index: usize| {
            let place = self.lattice.place(index);
            centers.iter().any(|center| (place - center).norm() <= reach)
        };
        (0..self.points.len()).filter(|&index| self.points[index] && is_near(index)).collect()
    }

    /// How many links each point is away from the nearest of these.
    fn hops(&self, seeds: Vec<usize>) -> Vec<Hops> {
        let mut hops: Vec<Hops> = vec![None; self.points.len()];
        let mut front = seeds;
        for count in 0.. {
            front.iter().for_each(|&point| hops[point] = Some(count));
            let covered = self.lattice.dilated(&front, self.link);
            let is_next =
                |&index: &usize| self.points[index] && covered[index] && hops[index].is_none();
            front = (0..hops.len()).filter(is_next).collect();
            if front.is_empty() {
                break;
            }
        }
        hops
    }

    /// Adds the robots on the way from a point to where `hops` are counted from, each as far from those before it as
    /// may be.
    fn follow(&self, from: usize, hops: &[Hops], places: &mut Vec<Point>) {
        let least = hops.iter().flatten().min().copied().unwrap_or(0);
        let mut at = from;
        while let Some(count) = hops[at].filter(|&count| count > least) {
            let here = self.lattice.place(at);
            let room = |index: &usize| {
                let place = self.lattice.place(*index);
                places.iter().map(|other| (other - place).norm()).fold(f64::INFINITY, f64::min)
            };
            let is_next = |&index: &usize| {
                hops[index] == Some(count - 1)
                    && (self.lattice.place(index) - here).norm() <= self.link
            };
            let next = (0..hops.len()).filter(is_next).max_by(|a, b| room(a).total_cmp(&room(b)));
            let Some(next) = next else { return };
            places.push(self.lattice.place(next));
            at = next;
        }
    }
}

/// Points in rows and columns.
#[derive(Clone, Copy)]
struct Lattice {
    origin: Point,
    step: f64,
    columns: usize,
    rows: usize,
}

impl Lattice {
    /// Points over a box and a step beyond it.
    fn over(low: Point, high: Point, step: f64) -> Self {
        let count = |length: f64| (length / step).ceil() as usize + 3;
        Lattice {
            origin: low - pleach::continuous::Vector::new(step, step),
            step,
            columns: count(high.x - low.x),
            rows: count(high.y - low.y),
        }
    }

    fn count(&self) -> usize {
        self.columns * self.rows
    }

    fn index(&self, column: usize, row: usize) -> usize {
        row * self.columns + column
    }

    fn at(&self, index: usize) -> (usize, usize) {
        (index % self.columns, index / self.columns)
    }

    fn place(&self, index: usize) -> Point {
        let (column, row) = self.at(index);
        Point::new(
            self.origin.x + column as f64 * self.step,
            self.origin.y + row as f64 * self.step,
        )
    }

    /// The point nearest to a place.
    fn nearest(&self, place: Point) -> usize {
        let [column, row] =
            self.cell(place + pleach::continuous::Vector::new(0.5, 0.5) * self.step);
        self.index(column, row)
    }

    /// The column and the row below and left of a place.
    fn cell(&self, place: Point) -> [usize; 2] {
        let offset = (place - self.origin) / self.step;
        [offset.x as usize, offset.y as usize]
    }

    /// The corners of the cell that holds a place.
    fn around(&self, place: Point) -> [usize; 4] {
        let [column, row] = self.cell(place);
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| self.index(column + dx, row + dy))
    }

    /// The neighbours of a point, also across corners.
    fn neighbours(&self, index: usize, corners: bool) -> impl Iterator<Item = usize> {
        let (column, row) = self.at(index);
        let (columns, rows) =
            (column.saturating_sub(1)..=column + 1, row.saturating_sub(1)..=row + 1);
        let lattice = *self;
        rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
            .filter(move |&(x, y)| {
                let steps = x.abs_diff(column) + y.abs_diff(row);
                x < lattice.columns && y < lattice.rows && (steps == 1 || corners && steps == 2)
            })
            .map(move |(x, y)| lattice.index(x, y))
    }

    /// All points to which allowed steps lead from these.
    fn flooded(
        &self,
        seeds: VecDeque<usize>,
        corners: bool,
        allows: impl Fn(usize, usize) -> bool,
    ) -> Vec<bool> {
        let mut reached = vec![false; self.count()];
        seeds.iter().for_each(|&seed| reached[seed] = true);
        let mut waiting = seeds;
        while let Some(from) = waiting.pop_front() {
            for to in self.neighbours(from, corners) {
                if !reached[to] && allows(from, to) {
                    reached[to] = true;
                    waiting.push_back(to);
                }
            }
        }
        reached
    }

    /// All points within `reach` of one of these: row by row, where each of them covers an interval.
    fn dilated(&self, points: &[usize], reach: f64) -> Vec<bool> {
        let steps = reach / self.step;
        let far = steps as usize;
        let halves: Vec<usize> = (0..=far)
            .map(|dy| (steps * steps - (dy * dy) as f64).max(0.0).sqrt() as usize)
            .collect();
        let width = self.columns + 1;
        let mut changes = vec![0_i32; width * self.rows];
        for &point in points {
            let (column, row) = self.at(point);
            for y in row.saturating_sub(far)..=(row + far).min(self.rows - 1) {
                let half = halves[y.abs_diff(row)];
                changes[y * width + column.saturating_sub(half)] += 1;
                changes[y * width + (column + half + 1).min(self.columns)] -= 1;
            }
        }
        let covered = changes.chunks(width).flat_map(|row| {
            let depths = row.iter().scan(0, |depth, change| {
                *depth += change;
                Some(*depth > 0)
            });
            depths.take(width - 1)
        });
        covered.collect()
    }
}

fn extent(workspace: &Workspace) -> (Point, Point) {
    let corners = workspace.boundary();
    (corners.iter())
        .fold((corners[0], corners[0]), |(low, high), corner| (low.inf(corner), high.sup(corner)))
}
