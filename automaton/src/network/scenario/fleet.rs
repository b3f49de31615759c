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

    /// The same fleet, whose robots derive everything anew.
    pub(super) fn without_caching(&self) -> Self {
        Fleet { scenario: self.scenario.without_caching(), ..self.clone() }
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
            mission: whole.mission,
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

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::super::InvalidScenario;
    use super::*;
    use crate::network::record::MissionEvent;

    /// A room with a wall across it, open at the top, an access point on either side, and two robots beside each.
    fn room(change: impl FnOnce(&mut Value)) -> Result<ValidScenario, InvalidScenario> {
        let mut room = json!({
            "name": "room",
            "workspace": {
                "boundary": [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]],
                "holes": [[[0.9, 0.1], [1.1, 0.1], [1.1, 1.5], [0.9, 1.5]]],
            },
            "link": {"full_range": 0.4, "max_range": 0.5},
            "control": {"teams": "per_access_point"},
            "access_point": [{"position": [0.4, 0.4]}, {"position": [1.3, 0.4]}],
            "robot": [
                {"position": [0.3, 0.5]},
                {"position": [1.4, 0.5]},
                {"position": [0.5, 0.5]},
                {"position": [1.2, 0.5]},
            ],
            "task": [{"position": [1.5, 1.5]}, {"position": [0.87, 0.6]}, {"position": [1.2, 1.0]}],
        });
        change(&mut room);
        ValidScenario::new(serde_json::from_value(room).expect("it is a scenario"))
    }

    fn owned(scenario: &ValidScenario) -> Vec<(usize, Vec<usize>, Vec<usize>)> {
        let of = |fleet: &Fleet| {
            let tasks = 0..fleet.scenario().task.len();
            let tasks = tasks.filter_map(|task| fleet.outward().task(task));
            (fleet.access_point(), fleet.robots().to_vec(), tasks.collect())
        };
        scenario.fleets().iter().map(of).collect()
    }

    /// Task 1 is nearer to access point 1 as the crow flies, and lies on the other side of the wall.
    #[test]
    fn robots_and_tasks_belong_to_the_access_point_to_which_their_way_is_shortest() {
        let room = room(|_| {}).expect("it is valid");
        assert_eq!(owned(&room), [(0, vec![0, 2], vec![1]), (1, vec![1, 3], vec![0, 2])]);
        let fleet = &room.fleets()[1];
        let places: Vec<[f64; 2]> = fleet.scenario().robot.iter().map(|it| it.position).collect();
        assert_eq!(places, [[1.4, 0.5], [1.2, 0.5]]);
        assert_eq!(fleet.scenario().access_point[0].position, [1.3, 0.4]);
        assert!(fleet.scenario().fleets().is_empty());
        let built = |scenario: &ValidScenario| scenario.settings().build_reliability;
        assert!(
            built(fleet.scenario()) < built(&room),
            "links carry the rates of two robots, not of four"
        );
    }

    #[test]
    fn robots_and_tasks_belong_to_the_access_point_that_is_stated() {
        let stated = room(|room| {
            room["task"][1]["access_point"] = json!(1);
            room["task"][2]["access_point"] = json!(0);
        });
        let stated = stated.expect("it is valid");
        assert_eq!(owned(&stated), [(0, vec![0, 2], vec![2]), (1, vec![1, 3], vec![0, 1])]);
        assert!(stated.fleets().iter().all(|it| it.scenario().task[0].access_point.is_none()));
    }

    #[test]
    fn an_access_point_without_robots_has_no_fleet_and_no_tasks() {
        let all = |room: &mut Value, key: &str| {
            let rows = room[key].as_array_mut().expect("a list");
            rows.iter_mut().for_each(|row| row["access_point"] = json!(0));
        };
        let alone = room(|room| {
            room["robot"] = json!([{"position": [0.3, 0.5]}, {"position": [0.5, 0.5]}]);
            all(room, "task");
        });
        assert_eq!(owned(&alone.expect("it is valid")), [(0, vec![0, 1], vec![0, 1, 2])]);
        let lacking = room(|room| room["robot"] = json!([{"position": [0.3, 0.5]}]));
        let faults = lacking.expect_err("no robot belongs to access point 1").faults;
        let keys: Vec<String> = faults.iter().map(|fault| fault.key.to_string()).collect();
        assert_eq!(keys, ["task[0]", "task[2]"]);
        assert!(faults.iter().all(|it| it.problem == Problem::NoRobotOf { access_point: 1 }));
    }

    #[test]
    fn a_fault_of_a_fleet_is_told_by_the_numbers_of_the_whole() {
        let far = room(|room| room["robot"][3]["position"] = json!([1.9, 1.9]));
        let faults = far.expect_err("robot 3 is cut off").faults;
        assert_eq!(faults.len(), 1);
        assert_eq!(faults[0].key.to_string(), "robot[3].position");
        let told = faults[0].problem.to_string();
        assert!(told.starts_with("among what belongs to access point 1: it is cut off:"), "{told}");
    }

    /// Node 4 is access point 0 of the room, and 5 is access point 1; both are node 2 of their fleets.
    #[test]
    fn what_is_renumbered_outward_and_inward_is_as_it_was() {
        let room = room(|_| {}).expect("it is valid");
        let fleet = &room.fleets()[1];
        let own = [
            MissionEvent::LeaderElected { task: 1, robot: 0, conflict: false },
            MissionEvent::RecruitElected { robot: 1, path: vec![1, 0], break_points: vec![1] },
            MissionEvent::Reattached { robot: 1, parent: 2 },
        ];
        let whole = [
            MissionEvent::LeaderElected { task: 2, robot: 1, conflict: false },
            MissionEvent::RecruitElected { robot: 3, path: vec![3, 1], break_points: vec![3] },
            MissionEvent::Reattached { robot: 3, parent: 5 },
        ];
        for (own, whole) in own.iter().zip(&whole) {
            assert_eq!(own.renumbered(fleet.outward()).as_ref(), Some(whole));
            assert_eq!(whole.renumbered(fleet.inward()).as_ref(), Some(own));
            assert_eq!(whole.renumbered(room.fleets()[0].inward()), None);
        }
        let across = MissionEvent::DutiesExchanged { mover: 1, parked: 2 };
        assert!(room.fleets().iter().all(|it| across.renumbered(it.inward()).is_none()));
    }
}
