//! What does not keep a mission from starting, but may surprise.

use std::fmt;

use pleach_continuous::Point;
use pleach_continuous::geometry::{Neighbours, Repair};
use pleach_continuous::network::LinkReliability;

use super::placement::key_of_repair;
use super::{Fleet, KeyPath, Settings, ValidScenario};
use crate::network::Site;
use crate::network::robot::ROUNDS_TO_BE_HEARD;

/// Something about a valid scenario that its author may not have meant.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Remark {
    /// No robot can service a task: the mission will end with the outcome `unreachable_task`.
    Task {
        /// Which task, counted from 0.
        task: usize,
        /// Why not.
        remark: TaskRemark,
    },
    /// A task lies beyond the boundary or in a hole, within δ of a place where robots may stand.
    InWall {
        /// Which task, counted from 0.
        task: usize,
        /// Where a robot stands that services it.
        place: [f64; 2],
        /// How far that is from the task.
        gap: f64,
    },
    /// Polygons of the workspace touch, or hold what encloses nothing: they are taken as they are meant.
    Outline(Repair),
    /// Robots start so far apart that links are from the beginning as long as they otherwise get only when
    /// no robot is left that can be recruited.
    LongLinks {
        /// Up to which length links would be made.
        usual: f64,
        /// Up to which length they are made.
        longest: f64,
    },
    /// Links whose ends do not see each other. The radio of the paper reaches through walls.
    ThroughWalls {
        /// Pairs of nodes with R > 0 at the start whose straight line leaves the workspace.
        crossing: usize,
        /// All pairs of nodes with R > 0 at the start, but for pairs of access points.
        links: usize,
    },
    /// The user would ask for a task, or take it back, when the mission has ended: it has at most `max_steps`
    /// control periods.
    TooLate {
        /// Which task, counted from 0.
        task: usize,
        /// What comes too late.
        what: Late,
        /// The control period in which it would come.
        period: u32,
        /// The number of control periods; the last has the number before it.
        max_steps: usize,
    },
    /// Nothing is to be done.
    NoTask,
    /// A move may miss its target by its whole length, so that robots may make no progress.
    ShortMoves {
        /// σ, which no move is longer than.
        step_radius: f64,
        /// By how much moves may be off.
        motion_error: f64,
    },
    /// A control period may end amid an exchange of duties, and the mission is judged as one with late messages.
    ShortPeriods {
        /// How many rounds it has.
        rounds: usize,
    },
    /// A control period has so few rounds that beacons are not repeated as often as they are otherwise.
    FewRounds {
        /// How many rounds it has.
        rounds: usize,
    },
}

/// Why no robot can service a task.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum TaskRemark {
    /// It is farther than δ from every place where a robot may stand.
    TooDeep {
        /// Whether it lies in the workspace: then it is too near to a wall, otherwise beyond the
        /// boundary or in a hole.
        is_inside: bool,
        /// How far it is from the nearest place where a robot may stand.
        gap: f64,
        /// δ.
        service_radius: f64,
    },
    /// The place nearest to it lies in a part of the free space in which no robot starts.
    Elsewhere,
}

/// What a user would do too late.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Late {
    /// It would ask for a task: the mission ends before all are serviced.
    Announced,
    /// It would take a task back.
    Withdrawn,
}

impl Remark {
    /// The key of the scenario that it concerns.
    pub fn key(&self) -> KeyPath {
        match self {
            Remark::Task { task, .. } | Remark::InWall { task, .. } => {
                KeyPath::root().key("task").index(*task).key("position")
            }
            Remark::Outline(repair) => key_of_repair(repair),
            Remark::LongLinks { .. } | Remark::ThroughWalls { .. } => KeyPath::root().key("link"),
            Remark::TooLate { task, what, .. } => {
                KeyPath::root().key("task").index(*task).key(match what {
                    Late::Announced => "announced",
                    Late::Withdrawn => "withdrawn",
                })
            }
            Remark::NoTask => KeyPath::root().key("task"),
            Remark::ShortMoves { .. } => KeyPath::root().key("control").key("step_radius"),
            Remark::ShortPeriods { .. } | Remark::FewRounds { .. } => {
                KeyPath::root().key("control").key("rounds_per_period")
            }
        }
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Remark::Task {
                remark: TaskRemark::TooDeep { is_inside, gap, service_radius }, ..
            } => {
                let place = match is_inside {
                    true => "too close to a wall",
                    false => "beyond the boundary or in a hole",
                };
                write!(
                    formatter,
                    "no robot can service it: it lies {place}, {gap:.6} away from the nearest \
                     place where a robot may stand, and service_radius is {service_radius}"
                )
            }
            Remark::Task { remark: TaskRemark::Elsewhere, .. } => write!(
                formatter,
                "no robot can service it: no way leads to it from where the robots start; \
                 passages narrower than 2 clearances are closed to them, where position_error and \
                 motion_error add to the clearance"
            ),
            Remark::InWall { place: [x, y], gap, .. } => write!(
                formatter,
                "it lies beyond the boundary or in a hole: robots service it from ({x:.6}, {y:.6}), {gap:.6} away, \
                 through the wall"
            ),
            Remark::Outline(repair) => write!(formatter, "{repair}"),
            Remark::LongLinks { usual, longest } => write!(
                formatter,
                "robots start farther apart than links are made for these rates, {usual:.6}: from the \
                 beginning they are made up to {longest:.6} instead, the limit that tree_reliability sets"
            ),
            Remark::ThroughWalls { crossing, links } => write!(
                formatter,
                "{crossing} of the {links} links at the start cross walls, which the model of \
                 the radio does not see; ranges should be those that hold through walls"
            ),
            Remark::TooLate { what, period, max_steps, .. } => {
                let what = match what {
                    Late::Announced => "asks for it",
                    Late::Withdrawn => "takes it back",
                };
                write!(
                    formatter,
                    "the user never {what}: the mission ends before control period {period}, since max_steps is \
                     {max_steps}"
                )
            }
            Remark::NoTask => {
                formatter.write_str("there is none: the mission ends at once; add [[task]]")
            }
            Remark::ShortMoves { step_radius, motion_error } => write!(
                formatter,
                "{step_radius} does not exceed motion_error, {motion_error}: a move may miss its target by its whole \
                 length, and robots may block each other permanently; use a step_radius of at least {}",
                2.0 * motion_error
            ),
            Remark::ShortPeriods { rounds } => write!(
                formatter,
                "{rounds}, and an exchange of duties takes up to {}: a control period may end during one, and the \
                 mission is judged only by what must hold under any fault; with more rounds it is judged in full",
                Settings::ROUNDS_OF_AN_EXCHANGE
            ),
            Remark::FewRounds { rounds } => write!(
                formatter,
                "{rounds} where {ROUNDS_TO_BE_HEARD} repeat each beacon as often as is useful: with fewer, \
                 robots seldom move when messages are lost, and may wait for their first task without end"
            ),
        }
    }
}

impl Fleet {
    /// The remarks on its tasks, by their numbers in the whole.
    fn task_remarks(&self) -> Vec<Remark> {
        let in_whole = |remark| match remark {
            Remark::Task { task, remark } => {
                Some(Remark::Task { task: self.outward().task(task)?, remark })
            }
            Remark::InWall { task, place, gap } => {
                Some(Remark::InWall { task: self.outward().task(task)?, place, gap })
            }
            other => Some(other),
        };
        self.scenario().task_remarks().into_iter().filter_map(in_whole).collect()
    }
}

impl Site {
    /// Links that are from the beginning as long as they may be.
    fn long_links(&self) -> Option<Remark> {
        self.begins_stretched().then(|| Remark::LongLinks {
            usual: self.settings.usual_links().build,
            longest: self.usual.build,
        })
    }
}

/// How many links there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LinkCount {
    /// All of them.
    pub links: usize,
    /// Those that cross walls.
    pub through_walls: usize,
}

impl ValidScenario {
    /// Everything worth a remark, places and times of tasks first, then the outline.
    pub fn remarks(&self) -> Vec<Remark> {
        let none = self.task.is_empty().then_some(Remark::NoTask);
        let tasks = none.into_iter().chain(self.task_remarks());
        let site = self.site();
        let outline = site.repairs.iter().cloned().map(Remark::Outline);
        let mut sites = [self].into_iter().chain(self.fleets().iter().map(Fleet::scenario));
        let long = sites.find_map(|scenario| scenario.site().long_links());
        let LinkCount { links, through_walls } = self.count_links();
        let walls =
            (through_walls > 0).then_some(Remark::ThroughWalls { crossing: through_walls, links });
        let rounds = site.settings.rounds_per_period;
        let short =
            (!site.settings.has_rounds_for_exchanges()).then_some(Remark::ShortPeriods { rounds });
        let short_moves = site.settings.moves_may_miss().then_some(Remark::ShortMoves {
            step_radius: site.settings.step_radius,
            motion_error: site.settings.errors.motion,
        });
        let few = (rounds < ROUNDS_TO_BE_HEARD).then_some(Remark::FewRounds { rounds });
        tasks
            .chain(self.late_remarks())
            .chain(outline)
            .chain(long)
            .chain(walls)
            .chain(short_moves)
            .chain(short)
            .chain(few)
            .collect()
    }

    /// Tasks that no robot can service, or none of the team that is to, and those in walls.
    fn task_remarks(&self) -> Vec<Remark> {
        if !self.fleets().is_empty() {
            return self.fleets().iter().flat_map(Fleet::task_remarks).collect();
        }
        let tasks = self.task.iter().enumerate();
        tasks.filter_map(|(task, stated)| self.task_remark(task, stated.position.into())).collect()
    }

    /// What the user would ask for, or take back, when the mission has ended.
    fn late_remarks(&self) -> impl Iterator<Item = Remark> {
        let max_steps = self.settings().max_steps;
        self.task.iter().enumerate().flat_map(move |(task, stated)| {
            let announced = stated.announced.map(|period| (Late::Announced, period));
            let withdrawn = stated.withdrawn.map(|period| (Late::Withdrawn, period));
            let times = announced.into_iter().chain(withdrawn);
            times
                .filter(move |&(_, period)| period as usize >= max_steps)
                .map(move |(what, period)| Remark::TooLate { task, what, period, max_steps })
        })
    }

    /// Why no robot can service a task at this place, if none can, or from where one does, if the task lies in a wall;
    /// robots decide alike.
    fn task_remark(&self, task: usize, at: Point) -> Option<Remark> {
        let site = self.site();
        let (service_radius, leash) = (site.settings.service_radius, site.settings.leash_radius());
        let (is_inside, gap_at) = (site.workspace.contains(at), |place: Point| (place - at).norm());
        let gap = gap_at(site.free_space.nearest(at));
        if gap > leash {
            let remark = TaskRemark::TooDeep { is_inside, gap, service_radius };
            return Some(Remark::Task { task, remark });
        }
        let mut reached = self
            .robot
            .iter()
            .filter_map(|robot| site.free_space.nearest_reached(at, robot.position.into()));
        match reached.find(|&place| gap_at(place) <= leash) {
            None => Some(Remark::Task { task, remark: TaskRemark::Elsewhere }),
            Some(_) if is_inside => None,
            Some(place) => Some(Remark::InWall { task, place: place.into(), gap: gap_at(place) }),
        }
    }

    /// The links with R > 0 at the start but for those between access points.
    pub fn count_links(&self) -> LinkCount {
        let (site, range) = (self.site(), self.site().radio.range());
        let robots: Vec<Point> = self.robot.iter().map(|robot| robot.position.into()).collect();
        let nodes: Vec<Point> = robots.iter().chain(&site.access_points).copied().collect();
        let neighbours = Neighbours::new(&nodes, range);
        let mut count = LinkCount { links: 0, through_walls: 0 };
        for (robot, &place) in robots.iter().enumerate() {
            neighbours.for_each_within(place, range, |other, distance| {
                if other > robot && distance < range {
                    let clearance = site.workspace.segment_clearance(place, nodes[other]);
                    count.links += 1;
                    count.through_walls += usize::from(clearance <= 0.0);
                }
            });
        }
        count
    }
}
