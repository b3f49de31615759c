//! Fleets: the networks of several access points in one workspace, each with a team, a user and tasks of its own.
//!
//! Each fleet is a [`Network`] by itself, and none hears the messages of another. What a robot learns of other fleets
//! is where those of their robots are that are in range of its radio: at the beginning of each control period it
//! senses these [bodies](Sense::Bodies). They stand for the beacons that it would hear of them, reduced to a position.
//! The networks jump at the same instants and flow together; one whose mission has ended goes on standing, and carries
//! what its robots generate, until all have ended.

use pleach_continuous::Point;
use pleach_continuous::geometry::Neighbours;
use pleach_continuous::network::LinkReliability;

use super::composition::{KernelTimes, Network, NetworkError, RobotNode};
use super::medium::Radio;
use super::member::{Member, Sense};
use super::merging::Part;
use super::message::Message;
use super::record::{End, FleetEnd, MissionEvent, Snapshot};
use super::scenario::{Fleet, ValidScenario};
use crate::executor::{Round, System};
use crate::node::{Medium, NodeJump};

/// The networks of the fleets of a scenario.
pub struct Fleets<M = Radio, N: RobotNode = Member> {
    fleets: Vec<FleetNetwork<M, N>>,
    /// How far the radio reaches.
    range: f64,
    /// Whether a control period begins.
    begins: bool,
}

/// A fleet with its network.
struct FleetNetwork<M, N: RobotNode> {
    fleet: Fleet,
    network: Network<M, N>,
    /// How its mission has ended, with the first control period after that.
    end: Option<(usize, End)>,
}

impl<M, N: RobotNode> FleetNetwork<M, N> {
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

    /// How its mission has ended, if it has, in the numbers of the whole.
    fn end(&self) -> Option<FleetEnd> {
        let (_, end) = self.end.as_ref()?;
        let end = end.renumbered(self.fleet.outward())?;
        Some(FleetEnd { access_point: self.fleet.access_point(), end })
    }

    /// How its mission has ended or, while it goes on, this end.
    fn end_or(&self, end: &End) -> FleetEnd {
        self.end().unwrap_or_else(|| FleetEnd {
            access_point: self.fleet.access_point(),
            end: End { task: None, ..end.clone() },
        })
    }
}

impl Fleets<Radio> {
    /// The networks of the fleets of a scenario at their start, each with the synchronous medium.
    ///
    /// # Errors
    /// When a user cannot take up its tasks.
    pub fn new(scenario: &ValidScenario) -> Result<Self, NetworkError> {
        Fleets::of_networks(scenario, |fleet| Network::new(fleet.scenario()))
    }
}

impl<M, N: RobotNode> Fleets<M, N> {
    /// The fleets of a scenario, where `network` makes the network of each.
    ///
    /// # Errors
    /// When a network cannot be made.
    pub fn of_networks<E>(
        scenario: &ValidScenario,
        mut network: impl FnMut(&Fleet) -> Result<Network<M, N>, E>,
    ) -> Result<Self, E> {
        let member = |fleet: &Fleet| {
            let network = network(fleet)?;
            Ok(FleetNetwork { fleet: fleet.clone(), network, end: None })
        };
        let fleets = scenario.fleets().iter().map(member).collect::<Result<_, E>>()?;
        Ok(Fleets { fleets, range: scenario.site().radio.range(), begins: true })
    }

    /// The network of each fleet, by access point.
    pub fn networks(&self) -> impl Iterator<Item = &Network<M, N>> {
        self.fleets.iter().map(|member| &member.network)
    }

    /// Time spent in each part so far, in all networks together.
    pub fn times(&self) -> KernelTimes {
        self.networks().map(Network::times).fold(KernelTimes::default(), KernelTimes::and)
    }

    /// The observers' view of this instant, just before the robots move; none if there is no fleet.
    pub fn snapshot(&self) -> Option<Snapshot> {
        let parts: Vec<Part> = self.fleets.iter().map(FleetNetwork::part).collect();
        Snapshot::merged(&parts)
    }

    /// What has happened in this control period, fleet by fleet.
    pub fn events(&self) -> Vec<MissionEvent> {
        self.fleets.iter().flat_map(FleetNetwork::events).collect()
    }

    /// How all have ended where the missions that are still under way end like this.
    pub fn end(&self, others: &End) -> End {
        End::of_fleets(self.fleets.iter().map(|member| member.end_or(others)).collect())
    }
}

impl<M: Medium<Message, Point>, N: RobotNode> Fleets<M, N> {
    /// Tells every robot where the robots of other fleets are that are in range.
    fn show_bodies(&mut self) -> Result<(), NetworkError> {
        let robots = |member: &FleetNetwork<M, N>| member.network.bodies().collect::<Vec<Point>>();
        let bodies: Vec<Vec<Point>> = self.fleets.iter().map(robots).collect();
        let fleets = bodies.iter().enumerate();
        let all: Vec<(usize, Point)> =
            fleets.flat_map(|(fleet, its)| its.iter().map(move |&body| (fleet, body))).collect();
        let places: Vec<Point> = all.iter().map(|&(_, place)| place).collect();
        let neighbours = Neighbours::new(&places, self.range);
        for (fleet, member) in self.fleets.iter_mut().enumerate() {
            for (robot, &place) in bodies[fleet].iter().enumerate() {
                let near = neighbours.within(place, self.range).into_iter();
                let others = near.filter(|&number| all[number].0 != fleet);
                let seen = others.map(|number| places[number]).collect();
                member.network.sense(robot, Sense::Bodies(seen))?;
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
        let ends: Option<Vec<FleetEnd>> = self.fleets.iter().map(FleetNetwork::end).collect();
        ends.map(End::of_fleets)
    }

    /// Each network takes a round of its own, in which its nodes have their own numbers.
    fn jump(&mut self, round: &mut Round<'_, NodeJump>) -> Result<(), NetworkError> {
        if std::mem::take(&mut self.begins) {
            self.show_bodies()?;
        }
        self.fleets.iter_mut().try_for_each(|member| member.network.jump(round))
    }

    fn time_to_jump(&self) -> Result<Option<f64>, NetworkError> {
        let times = self.networks().map(Network::time_to_jump);
        Ok(times.collect::<Result<Vec<_>, _>>()?.into_iter().flatten().reduce(f64::min))
    }

    fn flow(&mut self, duration: f64) -> Result<(), NetworkError> {
        for member in &mut self.fleets {
            let before = member.network.step();
            member.network.flow(duration)?;
            let period = member.network.step();
            self.begins |= period > before;
            let end = || member.network.finished().map(|end| (period, end));
            member.end = member.end.take().or_else(end);
        }
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
