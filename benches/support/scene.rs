//! A moment of Study I: the primary team is on its way, and every kernel has something to do.

use std::sync::Arc;

use pleach::automaton::network::record::{MissionEvent, Route, Snapshot};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::network::{Message, Robot, Site};
use pleach::automaton::node::{Input, Node, Observed, Outputs};
use pleach::continuous::Point;
use pleach::continuous::geometry::{Disc, Segment, convex_region, voronoi_half_planes};
use pleach::continuous::network::LinkReliability;
use pleach::continuous::network::motion::MotionProblem;
use pleach::continuous::network::rates::{NeighbourTraffic, residual_gradient};
use pleach::continuous::network::routing::problem::RoutingProblem;

use crate::course::Course;

/// Members of the primary team at the moment.
const TEAM: usize = 2;

/// What the network looks like at the moment, from outside.
pub struct Scene {
    /// Study I.
    pub scenario: ValidScenario,
    /// What its robots know from the beginning.
    pub site: Arc<Site>,
    /// The view of the observers.
    pub snapshot: Snapshot,
}

impl Scene {
    /// Lets Study I run up to the moment.
    pub fn of_study_1() -> Self {
        let scenario = crate::study_1();
        let mut course = Course::new(&scenario);
        course.reach_advance(TEAM);
        let site = Arc::clone(scenario.site());
        Scene { snapshot: course.snapshot(), scenario, site }
    }

    /// The leader, which is on its way to the task.
    pub fn leader(&self) -> usize {
        *self.snapshot.primary_team.last().expect("a team with a leader")
    }

    /// The robot that hears the most others.
    pub fn busiest(&self) -> usize {
        let audiences = self.audiences();
        (0..audiences.len()).max_by_key(|&robot| audiences[robot].len()).expect("a robot")
    }

    /// Where a robot is.
    pub fn position(&self, robot: usize) -> Point {
        self.snapshot.positions[robot]
    }

    /// The task that the leader goes to.
    pub fn goal(&self) -> Point {
        self.scenario.task[self.snapshot.task.expect("a task")].position.into()
    }

    /// Where a node is.
    pub fn place(&self, node: usize) -> Point {
        let robots = self.site.robots;
        self.snapshot
            .positions
            .get(node)
            .copied()
            .unwrap_or_else(|| self.site.access_points[node - robots])
    }

    /// Where the other robots are.
    pub fn others(&self, robot: usize) -> Vec<Point> {
        let positions = self.snapshot.positions.iter().enumerate();
        positions.filter(|(other, _)| *other != robot).map(|(_, place)| *place).collect()
    }

    /// The routes that leave a robot.
    pub fn routes_of(&self, robot: usize) -> impl Iterator<Item = &Route> {
        self.snapshot.routes.iter().filter(move |route| route.from == robot)
    }

    /// Problem (6) of all robots.
    pub fn routing_problem(&self) -> RoutingProblem {
        let rates: Vec<f64> = self.scenario.robot.iter().map(|robot| robot.rate).collect();
        RoutingProblem::of_places(
            &self.snapshot.positions,
            &self.site.access_points,
            &rates,
            &self.site.link,
            self.site.settings.slope_aversion,
            self.site.settings.routing_reserve,
        )
        .expect("a valid problem")
    }

    /// Problem (21) of the leader.
    pub fn motion_problem(&self) -> MotionProblem {
        let (leader, settings) = (self.leader(), &self.site.settings);
        let position = self.position(leader);
        let path = self.site.free_space.geodesic(position, self.goal()).expect("a way");
        let waypoint = path.waypoints[0];
        let mut half_planes =
            voronoi_half_planes(position, &self.others(leader), settings.clearance);
        let wide = settings.step_radius;
        half_planes.extend(convex_region(&self.site.free_space, position, waypoint, wide));
        let parents = self
            .routes_of(leader)
            .map(|route| Disc { center: self.place(route.to), radius: self.site.usual.hard });
        let mut discs = vec![Disc { center: position, radius: settings.step_radius }];
        discs.extend(parents);
        let mut problem = MotionProblem { position, waypoint, half_planes, discs };
        let exchanges = self.routes_of(leader).map(|route| NeighbourTraffic {
            neighbour: self.place(route.to),
            sent: route.share,
            received: 0.0,
        });
        let gradient = residual_gradient(position, exchanges, &self.site.link);
        let (residual, floor) = (self.snapshot.residuals[leader], -settings.residual_tolerance);
        problem.keep_residual(residual, gradient, floor);
        problem
    }

    /// The loads that the leader's neighbours certify while all robots take a full step.
    pub fn held_flows(&self) -> Vec<(Segment, Vec<(f64, Segment)>)> {
        let step = self.site.settings.step_radius;
        let step_of = |node: usize| {
            let from = self.place(node);
            Segment { from, to: from + pleach::continuous::Vector::new(step, 0.0) }
        };
        (0..self.site.robots)
            .map(|robot| {
                let routes = self.routes_of(robot);
                let flows =
                    routes.map(|route| (route.share * route.reliability, step_of(route.to)));
                (step_of(robot), flows.collect())
            })
            .collect()
    }

    /// Which nodes hear each robot.
    pub fn audiences(&self) -> Vec<Vec<usize>> {
        let hears = |robot: usize, other: usize| {
            let distance = (self.position(robot) - self.position(other)).norm();
            robot != other && distance < self.site.link.range()
        };
        let robots = 0..self.site.robots;
        robots
            .clone()
            .map(|robot| robots.clone().filter(|&other| hears(robot, other)).collect())
            .collect()
    }
}

/// Robots that stand where those of a scene do, and no others, in a control period without end.
pub struct Crowd {
    robots: Vec<Robot>,
    outputs: Vec<Outputs<Message, MissionEvent>>,
    audiences: Vec<Vec<usize>>,
}

impl Crowd {
    /// Robots that know nothing of each other yet.
    pub fn new(scene: &Scene) -> Self {
        let mut scenario = scene.scenario.clone().into_scenario();
        scenario.control.rounds_per_period = Some(usize::MAX);
        let site = Arc::new(Site::new(&scenario).expect("a site"));
        let starts = scenario.robot.iter().enumerate();
        let robots: Vec<Robot> = starts
            .map(|(id, start)| Robot::new(id, scene.position(id), start.rate, Arc::clone(&site)))
            .collect();
        let outputs = (0..robots.len()).map(Outputs::of).collect();
        Crowd { robots, outputs, audiences: scene.audiences() }
    }

    /// A control period begins.
    pub fn begin_period(&mut self) {
        for robot in &mut self.robots {
            let still = robot.view().still_periods();
            robot.pass_period(still).expect("guards that can be evaluated");
        }
    }

    /// One round of beacons: every robot sends, receives and deliberates.
    pub fn exchange_beacons(&mut self) {
        let Crowd { robots, outputs, audiences } = self;
        for (robot, outputs) in robots.iter_mut().zip(outputs.iter_mut()) {
            robot.step(Input::Tick { passed: 0 }, outputs).expect("guards that can be evaluated");
        }
        let sent: Vec<_> = outputs.iter_mut().flat_map(Outputs::drain_sent).collect();
        for envelope in &sent {
            for &to in &audiences[envelope.from] {
                let input = Input::Heard { from: envelope.from, message: &envelope.message };
                robots[to].step(input, &mut outputs[to]).expect("guards that can be evaluated");
            }
        }
    }
}
