//! Graphs of places: where robots may stand, and from where to where a message goes.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use pleach_automaton::network::Measure;
use pleach_automaton::network::scenario::{
    AccessPoint, Agenda, Control, LinkRanges, RobotStart, Scenario, Settings, Strategy, Task,
    Unreachable, WorkspaceOutline,
};
use pleach_continuous::Point;

use super::protocol::RATE;

/// The number of a place: first those where the robots start, then those of the access points,
/// then others.
pub type PlaceId = usize;

/// Ways are this share of the longest link that may be made, for each step from place to place:
/// two steps are then too long for a link, and a link of one step is not slack.
const STEP: f64 = 0.97;

/// l and u of the radio; nothing depends on them.
const RANGES: LinkRanges = LinkRanges::new(1.0, 1.2);

/// A connected graph of places with robots, access points and tasks on it.
///
/// Robots hear each other, and a link of the tree may be made, where two places are one or
/// neighbours. The length of a way is its number of steps.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaceGraph {
    robots: usize,
    access_points: usize,
    tasks: Vec<PlaceId>,
    steps: Vec<Vec<usize>>,
    positions: Vec<Point>,
    /// The length of a step.
    step: f64,
    strategy: Strategy,
}

/// Why no exploration starts from a graph.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlaceGraphError {
    /// An edge or a task names a place that there is not.
    #[error("there is no place {place}: the places are 0 to {}", .places - 1)]
    NoSuchPlace {
        /// The place named.
        place: PlaceId,
        /// How many there are.
        places: usize,
    },
    /// A place cannot be reached from the first.
    #[error("no way leads from place 0 to place {place}")]
    Disconnected {
        /// Such a place.
        place: PlaceId,
    },
    /// There is no robot or no access point.
    #[error("there must be a robot and an access point")]
    Empty,
}

impl PlaceGraph {
    /// PlaceGraph 0 … with these neighbours: a robot on each of the first `robots`, an access point
    /// on each of the next `access_points`, and the tasks where `tasks` says.
    ///
    /// # Errors
    /// When a number is out of range or the graph is not connected.
    pub fn new(
        robots: usize,
        access_points: usize,
        places: usize,
        edges: &[(PlaceId, PlaceId)],
        tasks: &[PlaceId],
    ) -> Result<Self, PlaceGraphError> {
        if robots == 0 || access_points == 0 || places < robots + access_points {
            return Err(PlaceGraphError::Empty);
        }
        let named = edges.iter().flat_map(|&(a, b)| [a, b]).chain(tasks.iter().copied());
        if let Some(place) = named.into_iter().find(|&place| place >= places) {
            return Err(PlaceGraphError::NoSuchPlace { place, places });
        }
        let steps: Vec<Vec<usize>> =
            (0..places).map(|from| steps_from(from, places, edges)).collect();
        if let Some(place) = steps[0].iter().position(|&steps| steps == usize::MAX) {
            return Err(PlaceGraphError::Disconnected { place });
        }
        let positions = (0..places).map(|place| on_circle(place, places)).collect();
        let tasks = tasks.to_vec();
        // Counts of states are recorded for the order of the paper.
        let strategy = Strategy::Paper;
        let mut places =
            PlaceGraph { robots, access_points, tasks, steps, positions, step: 0.0, strategy };
        places.step = STEP * Settings::resolve(&places.scenario()).usual_links().build;
        Ok(places)
    }

    /// Robots and access points on a graph of their places, with a branch of places for each
    /// task: from the place named, the given number of steps to the task.
    ///
    /// # Errors
    /// When a number is out of range or the graph is not connected.
    pub fn with_branches(
        robots: usize,
        access_points: usize,
        graph: &[(PlaceId, PlaceId)],
        branches: &[(PlaceId, usize)],
    ) -> Result<Self, PlaceGraphError> {
        let (mut edges, mut tasks, mut places) =
            (graph.to_vec(), Vec::new(), robots + access_points);
        for &(from, steps) in branches {
            let mut last = from;
            for place in places..places + steps {
                edges.push((last, place));
                last = place;
            }
            places += steps;
            tasks.push(last);
        }
        PlaceGraph::new(robots, access_points, places, &edges, &tasks)
    }

    /// The same graph, where recruits are called for by this strategy.
    #[must_use]
    pub fn following(self, strategy: Strategy) -> Self {
        PlaceGraph { strategy, ..self }
    }

    /// When recruits are called for.
    pub const fn strategy(&self) -> Strategy {
        self.strategy
    }

    /// The number of robots.
    pub const fn robots(&self) -> usize {
        self.robots
    }

    /// The number of places.
    pub fn count(&self) -> usize {
        self.steps.len()
    }

    /// The number of robots and access points.
    pub const fn nodes(&self) -> usize {
        self.robots + self.access_points
    }

    /// The number of steps of the shortest way.
    pub fn steps(&self, from: PlaceId, to: PlaceId) -> usize {
        self.steps[from][to]
    }

    /// Whether a link may lead from one place to the other.
    pub fn are_linked(&self, from: PlaceId, to: PlaceId) -> bool {
        self.steps(from, to) <= 1
    }

    /// The places one step nearer to `to`, ascending.
    pub fn next_steps(&self, from: PlaceId, to: PlaceId) -> impl Iterator<Item = PlaceId> + '_ {
        let nearer = move |&place: &PlaceId| {
            self.steps(from, place) == 1 && self.steps(place, to) + 1 == self.steps(from, to)
        };
        (0..self.steps.len()).filter(nearer)
    }

    /// Where a place lies. The places are so close together that all robots would be in range of
    /// each other: what counts is the graph.
    pub fn position(&self, place: PlaceId) -> Point {
        self.positions[place]
    }

    /// The place nearest to a position.
    pub fn place_at(&self, position: Point) -> PlaceId {
        let distance = |&place: &PlaceId| (self.positions[place] - position).norm_squared();
        (0..self.positions.len())
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .unwrap_or_default()
    }

    /// Where the tasks are.
    pub fn task_positions(&self) -> Vec<Point> {
        self.tasks.iter().map(|&place| self.position(place)).collect()
    }

    /// Whether all robots start next to an access point, all tasks are next to one, too, and without any one of
    /// the robots there is one more than there are tasks.
    pub fn can_lose_any_robot(&self) -> bool {
        let access_points = self.robots..self.nodes();
        let is_near = |place: PlaceId| {
            access_points.clone().any(|access_point| self.are_linked(place, access_point))
        };
        self.robots > self.tasks.len() + 1
            && (0..self.robots).chain(self.tasks.iter().copied()).all(is_near)
    }

    /// The mission with robots, access points and tasks at their places, in an empty room.
    pub fn scenario(&self) -> Scenario {
        let at = |place: PlaceId| self.position(place).into();
        let side = 2.0;
        Scenario {
            name: "places".into(),
            description: None,
            workspace: WorkspaceOutline {
                boundary: vec![[-side, -side], [side, -side], [side, side], [-side, side]],
                holes: Vec::new(),
            },
            link: RANGES,
            // The explorer decides when a control period is over.
            control: Control {
                rounds_per_period: Some(usize::MAX),
                strategy: Some(self.strategy),
                ..Control::default()
            },
            // Properties speak of one mission, which ends with a task that is given up.
            mission: Agenda { unreachable: Some(Unreachable::End), ..Agenda::default() },
            access_point: (self.robots..self.nodes())
                .map(|place| AccessPoint { position: at(place) })
                .collect(),
            robot: (0..self.robots).map(|place| RobotStart::at(at(place), RATE)).collect(),
            task: self.tasks.iter().map(|&place| Task::at(at(place))).collect(),
        }
    }
}

impl Measure for PlaceGraph {
    fn distance(&self, from: Point, to: Point) -> f64 {
        self.step * self.steps(self.place_at(from), self.place_at(to)) as f64
    }
}

/// A point of a circle, one of as many as there are places, to three decimals.
fn on_circle(place: PlaceId, places: usize) -> Point {
    let angle = TAU * place as f64 / places as f64;
    let round = |coordinate: f64| (coordinate * 1e3).round() / 1e3;
    Point::new(round(0.45 * angle.cos()), round(0.45 * angle.sin()))
}

/// The numbers of steps from `from` to every place; `usize::MAX` where no way leads.
fn steps_from(from: PlaceId, places: usize, edges: &[(PlaceId, PlaceId)]) -> Vec<usize> {
    let mut steps = vec![usize::MAX; places];
    steps[from] = 0;
    let mut ahead = VecDeque::from([from]);
    while let Some(place) = ahead.pop_front() {
        for &(a, b) in edges {
            for (here, there) in [(a, b), (b, a)] {
                if here == place && steps[there] == usize::MAX {
                    steps[there] = steps[place] + 1;
                    ahead.push_back(there);
                }
            }
        }
    }
    steps
}
