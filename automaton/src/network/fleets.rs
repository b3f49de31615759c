//! Fleets: the networks of several access points in one workspace, each with a team, a user and tasks of its own.
//!
//! Each fleet is a [`Network`] by itself, and none hears the messages of another. What a robot learns of other fleets
//! is where those of their robots are that are in range of its radio: at the beginning of each control period it
//! senses these [bodies](Sense::Bodies). They stand for the beacons that it would hear of them, reduced to a position.
//! The networks jump at the same instants and flow together; one whose mission has ended goes on standing, and carries
//! what its robots generate, until all have ended.

use std::collections::BTreeMap;

use pleach_continuous::Point;
use pleach_continuous::network::LinkReliability;

use super::composition::{KernelTimes, Network, NetworkError, RobotNode};
use super::medium::Radio;
use super::member::{Member, Sense};
use super::merging::Part;
use super::message::Message;
use super::record::{End, FleetEnd, MissionEvent, Snapshot};
use super::scenario::buckets::Buckets;
use super::scenario::{Fleet, ValidScenario};
use crate::executor::{Round, System};
use crate::node::{Medium, NodeJump};

/// The networks of the fleets of a scenario.
pub struct Fleets<M = Radio, N: RobotNode = Member> {
    members: Vec<Company<M, N>>,
    /// How far the radio reaches.
    range: f64,
    /// Whether a control period begins.
    begins: bool,
}

/// A fleet with its network.
struct Company<M, N: RobotNode> {
    fleet: Fleet,
    network: Network<M, N>,
    /// How its mission has ended, with the first control period after that.
    end: Option<(usize, End)>,
}

impl<M, N: RobotNode> Company<M, N> {
    fn part(&self) -> Part<'_> {
        Part {
            fleet: &self.fleet,
            snapshot: self.network.snapshot(),
            ended: self.end.as_ref().map(|(period, _)| *period),
        }
    }

    /// What has happened in this control period, in the numbers of the whole.
    fn events(&self) -> Vec<MissionEvent> {
        let events = self.network.events().into_iter();
        events.filter_map(|event| event.renumbered(self.fleet.outward())).collect()
    }

    /// How its mission has ended, in the numbers of the whole; like `others` if it has not.
    fn end(&self, others: &End) -> FleetEnd {
        let own = self.end.as_ref().and_then(|(_, end)| end.renumbered(self.fleet.outward()));
        let end = own.unwrap_or_else(|| End { task: None, ..others.clone() });
        FleetEnd { access_point: self.fleet.access_point(), end }
    }
}

impl Fleets<Radio> {
    /// The networks of the fleets of a scenario at their start, each with the synchronous medium.
    ///
    /// # Errors
    /// When an automaton is not well formed.
    pub fn new(scenario: &ValidScenario) -> Result<Self, NetworkError> {
        Fleets::of_networks(scenario, Network::new)
    }
}

impl<M, N: RobotNode> Fleets<M, N> {
    /// The fleets of a scenario, where `network` makes the network of each from its own scenario.
    ///
    /// # Errors
    /// When a network cannot be made.
    pub fn of_networks<E>(
        scenario: &ValidScenario,
        mut network: impl FnMut(&ValidScenario) -> Result<Network<M, N>, E>,
    ) -> Result<Self, E> {
        let company = |fleet: &Fleet| {
            let network = network(fleet.scenario())?;
            Ok(Company { fleet: fleet.clone(), network, end: None })
        };
        let members = scenario.fleets().iter().map(company).collect::<Result<_, E>>()?;
        Ok(Fleets { members, range: scenario.site().radio.range(), begins: true })
    }

    /// The network of each fleet, by access point.
    pub fn networks(&self) -> impl Iterator<Item = &Network<M, N>> {
        self.members.iter().map(|company| &company.network)
    }

    /// Time spent in each part so far, in all networks together.
    pub fn times(&self) -> KernelTimes {
        self.networks().map(Network::times).fold(KernelTimes::default(), KernelTimes::and)
    }

    /// The observers' view of this instant, just before the robots move; none if there is no fleet.
    pub fn snapshot(&self) -> Option<Snapshot> {
        let parts: Vec<Part> = self.members.iter().map(Company::part).collect();
        Snapshot::merged(&parts)
    }

    /// What has happened in this control period, fleet by fleet.
    pub fn events(&self) -> Vec<MissionEvent> {
        self.members.iter().flat_map(Company::events).collect()
    }

    /// How all have ended where the missions that are still under way end like this.
    pub fn end(&self, others: &End) -> End {
        End::of_fleets(self.members.iter().map(|company| company.end(others)).collect())
    }
}

impl<M: Medium<Message, Point>, N: RobotNode> Fleets<M, N> {
    /// Tells every robot where the robots of other fleets are that it hears.
    fn show_bodies(&mut self) -> Result<(), NetworkError> {
        let robots = |company: &Company<M, N>| company.network.bodies().collect::<Vec<Point>>();
        let bodies: Vec<Vec<Point>> = self.members.iter().map(robots).collect();
        let fleets = bodies.iter().enumerate();
        let all: Vec<(usize, Point)> =
            fleets.flat_map(|(fleet, its)| its.iter().map(move |&body| (fleet, body))).collect();
        let places: Vec<Point> = all.iter().map(|&(_, place)| place).collect();
        let buckets = Buckets::of(&places, self.range);
        for (fleet, company) in self.members.iter_mut().enumerate() {
            for (robot, &place) in bodies[fleet].iter().enumerate() {
                let others = buckets.near(place).filter(|&(number, _)| all[number].0 != fleet);
                let near: BTreeMap<usize, Point> = others.collect();
                company.network.sense(robot, Sense::Bodies(near.into_values().collect()))?;
            }
        }
        Ok(())
    }
}

impl<M: Medium<Message, Point>, N: RobotNode> System for Fleets<M, N> {
    type Jump = NodeJump;
    type Finish = End;
    type Error = NetworkError;

    fn finished(&self) -> Option<End> {
        let ends = self.members.iter().map(|company| company.end.as_ref());
        let last = ends.collect::<Option<Vec<_>>>()?.last().map(|(_, end)| end.clone())?;
        Some(self.end(&last))
    }

    /// Each network takes a round of its own, in which its nodes have their own numbers.
    fn jump(&mut self, round: &mut Round<'_, NodeJump>) -> Result<(), NetworkError> {
        if std::mem::take(&mut self.begins) {
            self.show_bodies()?;
        }
        self.members.iter_mut().try_for_each(|company| company.network.jump(round))
    }

    fn time_to_jump(&self) -> Result<Option<f64>, NetworkError> {
        let times = self.networks().map(Network::time_to_jump);
        Ok(times.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().reduce(f64::min))
    }

    fn flow(&mut self, duration: f64) -> Result<(), NetworkError> {
        for company in &mut self.members {
            company.network.flow(duration)?;
            let period = company.network.step();
            let end = || company.network.finished().map(|end| (period, end));
            company.end = company.end.take().or_else(end);
        }
        self.begins = true;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use serde_json::json;

    use super::super::record::Outcome;
    use super::super::scenario::Scenario;
    use super::*;
    use crate::{Executor, HybridTime, Observer, Reason};

    /// A hall with an access point and four robots in either corner of a long side; each has a task opposite the other.
    fn crossing() -> ValidScenario {
        let places = [(0.5, 0.6), (0.7, 0.4), (0.8, 0.7), (0.4, 0.3)];
        let east = places.map(|(x, y)| json!({"position": [4.0 - x, y], "rate": 0.05}));
        let west = places.map(|(x, y)| json!({"position": [x, y], "rate": 0.05}));
        let robots = [west, east].concat();
        let scenario: Scenario = serde_json::from_value(json!({
            "name": "crossing",
            "workspace": {"boundary": [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]},
            "link": {"full_range": 1.0, "max_range": 1.4},
            "control": {"teams": "per_access_point"},
            "access_point": [{"position": [0.6, 0.5]}, {"position": [3.4, 0.5]}],
            "robot": robots,
            "task": [
                {"position": [3.0, 2.4], "access_point": 0},
                {"position": [1.0, 2.4], "access_point": 1},
            ],
        }))
        .expect("it is a scenario");
        ValidScenario::new(scenario).unwrap_or_else(|error| panic!("{error}"))
    }

    /// The smallest distance of robots of different fleets, at the samples and half way between.
    struct Distances {
        before: Vec<Vec<Point>>,
        smallest: f64,
    }

    impl Observer<Fleets> for Distances {
        fn flows(&mut self, fleets: &Fleets, _: HybridTime, _: f64) -> ControlFlow<End> {
            let now: Vec<Vec<Point>> = fleets.networks().map(|it| it.bodies().collect()).collect();
            let middle = |fleet: usize, robot: usize| match self.before.get(fleet) {
                Some(before) => nalgebra::center(&before[robot], &now[fleet][robot]),
                None => now[fleet][robot],
            };
            for (one, at) in now[0].iter().enumerate() {
                for (other, there) in now[1].iter().enumerate() {
                    let half_way = (middle(0, one) - middle(1, other)).norm();
                    self.smallest = self.smallest.min((at - there).norm()).min(half_way);
                }
            }
            self.before = now;
            ControlFlow::Continue(())
        }
    }

    #[test]
    fn fleets_that_cross_each_other_keep_their_distance_and_service_their_tasks() {
        let scenario = crossing();
        let mut distances = Distances { before: Vec::new(), smallest: f64::INFINITY };
        let mut fleets = Fleets::new(&scenario).expect("its automata are well formed");
        let executor = Executor::new(20_000.0, 1_000_000).expect("valid limits");
        let ending = executor.run(&mut fleets, &mut distances).expect("it goes on");
        let Reason::Finished(end) = ending.reason else { panic!("{:?}", ending.reason) };
        assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
        let kept = 2.0 * scenario.settings().clearance;
        assert!(distances.smallest >= kept - 1e-9, "{} of {kept}", distances.smallest);
        assert!(distances.smallest < 4.0 * kept, "{}: they do not meet", distances.smallest);
    }
}
