//! How few robots any tree to some tasks takes, by lengths alone.
//!
//! A tree that services tasks joins the access points, which are wired to each other, with a place within δ of each
//! task. Every robot of it has one link to its parent, and no link is longer than the range u of the radio. So a tree of
//! n robots is at most n u long as the crow flies, wherever its robots stand and whatever they have done before; and it
//! is at least as long as a shortest network that joins these places, for which a spanning tree gives a bound. That
//! follows from the radio alone: walls, rates and the rules of the robots only make more robots necessary.
//!
//! Lengths along shortest ways around walls are a measure of how much a mission asks for, and no bound.

use pleach_automaton::network::scenario::ValidScenario;
use pleach_continuous::Point;
use pleach_continuous::geometry::{FreeSpace, FreeSpaceError};

use super::limits::Limits;

/// Rounding must not make a bound of n robots one of n + 1.
const ROUNDING: f64 = 1e-6;

/// The lengths between the access points and the tasks of a mission, from which bounds follow.
///
/// A corridor 2 long with an access point at its left end, and links up to 0.5 long: the task at the
/// right end takes four robots, wherever they are.
///
/// ```
/// use pleach_automaton::network::scenario::{
///     AccessPoint, Agenda, Control, LinkRanges, RobotStart, Scenario, Task, ValidScenario, WorkspaceOutline,
/// };
/// use pleach_verify::network::Spans;
///
/// let scenario = ValidScenario::new(Scenario {
///     name: "corridor".to_owned(),
///     description: None,
///     workspace: WorkspaceOutline {
///         boundary: vec![[0.0, 0.0], [2.2, 0.0], [2.2, 0.2], [0.0, 0.2]],
///         holes: Vec::new(),
///     },
///     link: LinkRanges::new(0.4, 0.5),
///     control: Control::default(),
///     mission: Agenda::default(),
///     access_point: vec![AccessPoint { position: [0.1, 0.1] }],
///     robot: vec![RobotStart::at([0.3, 0.1], 0.01)],
///     task: vec![Task::at([2.1, 0.1])],
/// })?;
/// assert_eq!(Spans::as_the_crow_flies(&scenario).least_robots(&[0]), Some(4));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Spans {
    /// No link is longer.
    longest_link: f64,
    /// From the nearest access point to within δ of each task.
    from_access: Vec<f64>,
    /// From within δ of a task to within δ of each one before it.
    between: Vec<Vec<f64>>,
}

impl Spans {
    /// Straight lengths, from which a bound follows that holds in every workspace.
    pub fn as_the_crow_flies(scenario: &ValidScenario) -> Self {
        let limits = Limits::of(scenario);
        let (tasks, radius) = (limits.tasks(), limits.service_radius());
        let to_access = |task: &Point| {
            let ways = limits.access_points().iter().map(|access| (access - task).norm() - radius);
            ways.fold(f64::INFINITY, f64::min).max(0.0)
        };
        let gap = |one: Point, other: Point| ((one - other).norm() - 2.0 * radius).max(0.0);
        Spans {
            longest_link: limits.max_range(),
            from_access: tasks.iter().map(to_access).collect(),
            between: (tasks.iter().enumerate())
                .map(|(at, &task)| tasks[..at].iter().map(|&it| gap(task, it)).collect())
                .collect(),
        }
    }

    /// Lengths along shortest ways around walls, to compare what missions take.
    ///
    /// # Errors
    /// When no robot has a place to stand.
    pub fn along_ways(scenario: &ValidScenario) -> Result<Self, FreeSpaceError> {
        let limits = Limits::of(scenario);
        let floor = Floor::of(&limits)?;
        let tasks: Vec<Vicinity> =
            limits.tasks().iter().map(|&task| floor.vicinity(task)).collect();
        let from_access = |task: &Vicinity| {
            let access_points = limits.access_points().iter();
            access_points.map(|&access| floor.way(access, task)).fold(f64::INFINITY, f64::min)
        };
        let before = |at: usize| &tasks[..at];
        Ok(Spans {
            longest_link: limits.max_range(),
            from_access: tasks.iter().map(from_access).collect(),
            between: (tasks.iter().enumerate())
                .map(|(at, task)| before(at).iter().map(|it| floor.gap(task, it)).collect())
                .collect(),
        })
    }

    /// No link is longer than this: the range u of the radio.
    pub(super) const fn longest_link(&self) -> f64 {
        self.longest_link
    }

    /// From the nearest access point to within δ of a task; infinite if no way leads there.
    pub fn way_to(&self, task: usize) -> f64 {
        self.from_access[task]
    }

    fn between(&self, one: usize, other: usize) -> f64 {
        self.between[one.max(other)][one.min(other)]
    }

    /// The length of a shortest spanning tree of the access points, as one, and these tasks; infinite if no way leads to
    /// one of them.
    pub fn spanning_tree(&self, tasks: &[usize]) -> f64 {
        self.spanning_edges(tasks).iter().sum()
    }

    /// The robots of such a tree, where each of its edges is a chain of links that are no longer than `link`, and
    /// ends with a robot of its own. Infinite if no way leads to a task.
    pub fn robots_of_spanning_tree(&self, tasks: &[usize], link: f64) -> f64 {
        let robots = |length: &f64| (length / link - ROUNDING).ceil().max(1.0);
        self.spanning_edges(tasks).iter().map(robots).sum()
    }

    /// The lengths of the edges of a shortest spanning tree of the access points, as one, and these tasks (Prim).
    fn spanning_edges(&self, tasks: &[usize]) -> Vec<f64> {
        let mut ways = self.from_access.clone();
        let mut outside = tasks.to_vec();
        let mut edges = Vec::with_capacity(tasks.len());
        while let Some(at) =
            (0..outside.len()).min_by(|&a, &b| ways[outside[a]].total_cmp(&ways[outside[b]]))
        {
            let joined = outside.swap_remove(at);
            edges.push(ways[joined]);
            for &task in &outside {
                ways[task] = ways[task].min(self.between(task, joined));
            }
        }
        edges
    }

    /// A bound from below on the length of any network that joins the access points with these tasks: it is no shorter
    /// than the way to the farthest of them and, of a spanning tree of k places, no shorter than the share k / (2k − 2),
    /// in every metric.
    pub(super) fn least_length(&self, tasks: &[usize]) -> f64 {
        let farthest = tasks.iter().map(|&task| self.from_access[task]).fold(0.0, f64::max);
        let share = (tasks.len() + 1) as f64 / (2 * tasks.len()).max(1) as f64;
        farthest.max(share * self.spanning_tree(tasks))
    }

    /// How many robots any tree has that services these tasks at the same time; none if no way leads to one of them.
    pub fn least_robots(&self, tasks: &[usize]) -> Option<usize> {
        let length = self.least_length(tasks);
        let by_length = (length / self.longest_link - ROUNDING).ceil().max(0.0);
        length.is_finite().then(|| (by_length as usize).max(self.least_leaves(tasks)))
    }

    /// Tasks so far from each other that each takes a robot of its own.
    fn least_leaves(&self, tasks: &[usize]) -> usize {
        let mut apart: Vec<usize> = Vec::new();
        for &task in tasks {
            if apart.iter().all(|&other| self.between(task, other) > 0.0) {
                apart.push(task);
            }
        }
        apart.len()
    }
}

/// Where robots may stand, computed here once more: they keep ρ from walls, whatever they believe.
struct Floor {
    space: FreeSpace,
    /// δ.
    radius: f64,
}

/// A task, and the places from which it is serviced where shortest ways to it may end.
struct Vicinity {
    task: Point,
    ends: Vec<Point>,
}

impl Floor {
    fn of(limits: &Limits) -> Result<Self, FreeSpaceError> {
        let space = FreeSpace::new(limits.workspace(), limits.clearance())?;
        Ok(Floor { space, radius: limits.service_radius() })
    }

    /// The point at distance δ from `task` in the direction of `from`.
    fn foot(&self, task: Point, from: Point) -> Point {
        task + (from - task).normalize() * self.radius
    }

    /// A shortest way to the disc around a task leads straight towards its centre from a corner of the
    /// free space, or ends where a wall enters the disc.
    fn vicinity(&self, task: Point) -> Vicinity {
        let corners = self.space.outline().iter().flatten().copied();
        let outside = corners.filter(|corner| (corner - task).norm() > self.radius);
        let feet = outside.filter_map(|corner| {
            let foot = self.foot(task, corner);
            (self.space.contains(foot) && self.space.sees(corner, foot)).then_some(foot)
        });
        let at_walls = self.space.outline().iter().flat_map(|ring| {
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).flat_map(|(&from, &to)| crossings(from, to, task, self.radius))
        });
        Vicinity { task, ends: feet.chain(at_walls).collect() }
    }

    /// The length of a shortest way from a place to within δ of a task.
    fn way(&self, from: Point, vicinity: &Vicinity) -> f64 {
        if (from - vicinity.task).norm() <= self.radius {
            return 0.0;
        }
        let foot = self.foot(vicinity.task, from);
        let straight = self.space.sees(from, foot).then(|| (foot - from).norm());
        let ways = vicinity.ends.iter().map(|&end| self.space.distance(from, end));
        ways.chain(straight).fold(f64::INFINITY, f64::min)
    }

    /// The length of a shortest way from within δ of one task to within δ of another.
    fn gap(&self, one: &Vicinity, other: &Vicinity) -> f64 {
        if (one.task - other.task).norm() <= 2.0 * self.radius {
            return 0.0;
        }
        let facing = self.foot(one.task, other.task);
        let facing = self.space.contains(facing).then_some(facing);
        let starts = one.ends.iter().copied().chain(facing);
        starts.map(|start| self.way(start, other)).fold(f64::INFINITY, f64::min)
    }
}

/// Where the segment from one point to the other crosses a circle.
fn crossings(from: Point, to: Point, center: Point, radius: f64) -> impl Iterator<Item = Point> {
    let (along, offset) = (to - from, from - center);
    let (square, half) = (along.norm_squared(), along.dot(&offset));
    let root = (half * half - square * (offset.norm_squared() - radius * radius)).sqrt();
    [-root, root]
        .map(|root| (root - half) / square)
        .into_iter()
        .filter(|share| (0.0..=1.0).contains(share))
        .map(move |share| from + along * share)
}
