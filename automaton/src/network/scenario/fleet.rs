//! Fleets: a scenario in which each access point has a team of its own, as one scenario for each.

use pleach_continuous::Point;

use super::fault::{Fault, Problem};
use super::key_path::{KeyPath, KeyStep};
use super::{Control, Scenario, ValidScenario};
use crate::network::Site;
use crate::network::renumbering::Renumbering;

/// The robots of one access point with the tasks that they pursue: a scenario of its own, in which all are numbered
/// from 0 in the order of the whole.
#[derive(Clone, Debug)]
pub struct Fleet {
    access_point: usize,
    robots: Vec<usize>,
    scenario: ValidScenario,
    inward: Renumbering,
    outward: Renumbering,
}

impl Fleet {
    /// The number of its access point.
    pub const fn access_point(&self) -> usize {
        self.access_point
    }

    /// The numbers of its robots, ascending.
    pub fn robots(&self) -> &[usize] {
        &self.robots
    }

    /// Its scenario.
    pub const fn scenario(&self) -> &ValidScenario {
        &self.scenario
    }

    /// From the numbers of the whole scenario to its own.
    pub const fn inward(&self) -> &Renumbering {
        &self.inward
    }

    /// From its own numbers to those of the whole scenario.
    pub const fn outward(&self) -> &Renumbering {
        &self.outward
    }
}

/// The fleets of a scenario, by access point; those without a robot are left out.
///
/// # Errors
/// Tasks of access points that have no robots, or why no mission can start from the scenario of a fleet.
pub(super) fn fleets(scenario: &Scenario, site: &Site) -> Result<Vec<Fleet>, Vec<Fault>> {
    let owners = Owners::of(scenario, site);
    let orphans = owners.orphans();
    if !orphans.is_empty() {
        return Err(orphans);
    }
    let (mut fleets, mut faults) = (Vec::new(), Vec::new());
    for access_point in 0..scenario.access_point.len() {
        let part = owners.part(access_point);
        if !part.robots.is_empty() {
            match part.fleet(scenario, site) {
                Ok(fleet) => fleets.push(fleet),
                Err(found) => faults.extend(found),
            }
        }
    }
    if faults.is_empty() { Ok(fleets) } else { Err(faults) }
}

/// The access point that each robot and each task belongs to.
struct Owners {
    robots: Vec<usize>,
    tasks: Vec<usize>,
}

/// What belongs to an access point.
struct Part {
    access_point: usize,
    robots: Vec<usize>,
    tasks: Vec<usize>,
}

impl Owners {
    fn of(scenario: &Scenario, site: &Site) -> Self {
        let owner = |stated: Option<usize>, position: [f64; 2]| {
            stated.unwrap_or_else(|| nearest(position.into(), site))
        };
        Owners {
            robots: scenario.robot.iter().map(|it| owner(it.access_point, it.position)).collect(),
            tasks: scenario.task.iter().map(|it| owner(it.access_point, it.position)).collect(),
        }
    }

    /// Tasks of access points that have no robots.
    fn orphans(&self) -> Vec<Fault> {
        let tasks = self.tasks.iter().enumerate();
        tasks
            .filter(|(_, owner)| !self.robots.contains(owner))
            .map(|(task, &access_point)| {
                Problem::NoRobotOf { access_point }.at(KeyPath::root().key("task").index(task))
            })
            .collect()
    }

    fn part(&self, access_point: usize) -> Part {
        let owned = |owners: &[usize]| {
            let numbered = owners.iter().enumerate();
            numbered.filter(|(_, owner)| **owner == access_point).map(|(it, _)| it).collect()
        };
        Part { access_point, robots: owned(&self.robots), tasks: owned(&self.tasks) }
    }
}

/// The access point to which the way from this place, or from the free place nearest to it, is shortest.
fn nearest(position: Point, site: &Site) -> usize {
    let place = site.free_space.nearest(position);
    let ways = site.access_points.iter().map(|&access_point| site.distance(access_point, place));
    let shortest = ways.enumerate().min_by(|one, other| one.1.total_cmp(&other.1));
    shortest.map_or(0, |(access_point, _)| access_point)
}

impl Part {
    fn fleet(self, whole: &Scenario, site: &Site) -> Result<Fleet, Vec<Fault>> {
        let scenario = self.scenario(whole);
        let (robots, count) = (whole.robot.len(), whole.robot.len() + whole.access_point.len());
        let nodes: Vec<usize> =
            self.robots.iter().copied().chain([robots + self.access_point]).collect();
        let outward = Renumbering::out_of_part(&nodes, &self.tasks);
        let inward = Renumbering::into_part(&nodes, count, &self.tasks, whole.task.len());
        let site = site.of_fleet(&scenario, &outward);
        let (access_point, robots) = (self.access_point, self.robots);
        match ValidScenario::on(scenario, site) {
            Ok(scenario) => Ok(Fleet { access_point, robots, scenario, inward, outward }),
            Err(invalid) => {
                let faults = invalid.faults.into_iter();
                Err(faults.map(|fault| in_whole(fault, access_point, &robots)).collect())
            }
        }
    }

    fn scenario(&self, whole: &Scenario) -> Scenario {
        let (robot, task) = (&whole.robot, &whole.task);
        Scenario {
            name: whole.name.clone(),
            description: whole.description.clone(),
            workspace: whole.workspace.clone(),
            link: whole.link,
            control: Control { teams: None, ..whole.control },
            access_point: vec![whole.access_point[self.access_point]],
            robot: self.robots.iter().map(|&it| robot[it].of_nearest()).collect(),
            task: self.tasks.iter().map(|&it| task[it].of_nearest()).collect(),
        }
    }
}

/// A fault of a fleet where its value stands in the whole scenario.
fn in_whole(fault: Fault, access_point: usize, robots: &[usize]) -> Fault {
    let mut key = KeyPath::root();
    for step in fault.key.steps() {
        key = match step {
            KeyStep::Key(name) => key.key(name),
            KeyStep::Index(robot) => key.index(robots.get(*robot).copied().unwrap_or(*robot)),
        };
    }
    Problem::OfFleet { access_point, problem: Box::new(fault.problem) }.at(key)
}
