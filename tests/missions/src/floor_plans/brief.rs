//! What a family asks for, in units of the full range l, and the scenario that comes of it.

use super::dice::Dice;
use super::outline::Floor;
use super::places::Places;
use pleach::automaton::network::scenario::{
    AccessPoint, Agenda, Control, LinkRanges, RobotStart, Scenario, Task, WorkspaceOutline,
};

/// How the robots stand when the mission starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crowd {
    /// Around the access points.
    Around,
    /// In chains: most robots reach an access point over several hops.
    Chains,
}

/// Where tasks lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Anywhere on the floor.
    Anywhere,
    /// As close to a wall as a robot can service them.
    AtWalls,
    /// In the corners of the floor.
    InCorners,
    /// At these places, as far as they can be reached.
    At([f64; 2]),
}

/// What the rates of the robots are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rates {
    /// What one gateway can carry, divided by the robots.
    Shared,
    /// Left to the default.
    Default,
    /// Each robot its own share.
    Mixed,
}

/// A mission to be drafted. Lengths are in units of l.
#[derive(Clone, Debug)]
pub struct Brief {
    pub floor: Floor,
    /// u.
    pub max_range: f64,
    pub control: Control,
    pub access_points: Vec<[f64; 2]>,
    pub crowd: Crowd,
    /// Where redundant robots stand besides, where they are connected there.
    pub parked: Vec<[f64; 2]>,
    pub targets: Vec<Target>,
    /// Robots beyond those that the tasks need.
    pub spare: usize,
    /// Robots at least.
    pub least_robots: usize,
    pub rates: Rates,
    /// The floor is turned by this angle in the end.
    pub turn: f64,
    /// Length of l in the scenario's unit.
    pub unit: f64,
}

impl Brief {
    /// A mission with settings as the studies have them.
    pub fn new(floor: Floor, access_point: [f64; 2]) -> Self {
        Brief {
            floor,
            max_range: 1.25,
            control: Control::default(),
            access_points: vec![access_point],
            crowd: Crowd::Around,
            parked: Vec::new(),
            targets: vec![Target::Anywhere; 3],
            spare: 3,
            least_robots: 4,
            rates: Rates::Shared,
            turn: 0.0,
            unit: 0.4,
        }
    }

    /// The scenario, if all robots find a place.
    pub fn scenario(self, name: String, dice: &mut Dice) -> Option<Scenario> {
        let outline = self.floor.outline()?;
        let mut scenario = Scenario {
            name,
            description: None,
            workspace: outline,
            link: LinkRanges::new(1.0, self.max_range),
            control: self.control,
            mission: Agenda::default(),
            access_point: (self.access_points.iter())
                .map(|&position| AccessPoint { position })
                .collect(),
            robot: Vec::new(),
            task: Vec::new(),
        };
        let mut places = Places::new(&scenario)?;
        for target in &self.targets {
            let position = places.task(*target, dice)?;
            scenario.task.push(Task::at(position));
        }
        let robots = (places.robots_needed() + self.spare).max(self.least_robots);
        places.park(&self.parked);
        places.gather(self.crowd, robots, dice)?;
        let rates = self.rates_of(places.robots().len(), dice);
        scenario.robot = (places.robots().iter().zip(&rates))
            .map(|(place, &rate)| RobotStart::at([place.x, place.y], rate))
            .collect();
        Some(self.carried_over(scenario, robots))
    }

    /// The rates of this many robots.
    fn rates_of(&self, robots: usize, dice: &mut Dice) -> Vec<f64> {
        const WHAT_A_GATEWAY_CARRIES: f64 = 0.7;
        let share = WHAT_A_GATEWAY_CARRIES / robots as f64;
        (0..robots)
            .map(|_| match self.rates {
                Rates::Shared => share - share.min(0.04) / 2.0,
                Rates::Default => 0.075,
                Rates::Mixed => (share - share.min(0.04) / 2.0) * dice.between(0.0, 1.0),
            })
            .map(rounded)
            .collect()
    }

    /// The scenario turned, and in its own unit of length.
    fn carried_over(&self, scenario: Scenario, robots: usize) -> Scenario {
        let (sine, cosine) = self.turn.sin_cos();
        let place = |[x, y]: [f64; 2]| {
            [cosine * x - sine * y, sine * x + cosine * y].map(|c| significant(self.unit * c))
        };
        let polygon = |corners: Vec<[f64; 2]>| corners.into_iter().map(place).collect();
        let length = |length: Option<f64>| length.map(|length| significant(self.unit * length));
        let reserve = (0.02_f64).min(0.2 / robots as f64);
        Scenario {
            workspace: WorkspaceOutline {
                boundary: polygon(scenario.workspace.boundary),
                holes: scenario.workspace.holes.into_iter().map(polygon).collect(),
            },
            link: LinkRanges::new(
                significant(self.unit),
                significant(self.unit * scenario.link.max_range),
            ),
            control: Control {
                clearance: length(scenario.control.clearance),
                service_radius: length(scenario.control.service_radius),
                step_radius: length(scenario.control.step_radius),
                routing_reserve: scenario.control.routing_reserve.or(match self.rates {
                    Rates::Default => None,
                    _ => Some(rounded(reserve)),
                }),
                ..scenario.control
            },
            access_point: (scenario.access_point.into_iter())
                .map(|it| AccessPoint { position: place(it.position) })
                .collect(),
            robot: (scenario.robot.into_iter())
                .map(|it| RobotStart { position: place(it.position), ..it })
                .collect(),
            task: (scenario.task.into_iter())
                .map(|it| Task { position: place(it.position), ..it })
                .collect(),
            ..scenario
        }
    }
}

/// Five decimals, as a person would write it.
fn rounded(number: f64) -> f64 {
    (number * 1e5).round() / 1e5
}

/// Seven significant digits: what is shorter by less than a millionth still fits.
fn significant(number: f64) -> f64 {
    if number == 0.0 {
        return 0.0;
    }
    let digits = 10_f64.powf(7.0 - number.abs().log10().floor());
    (number * digits).round() / digits
}
