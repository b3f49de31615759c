//! Whether robots and access points stand where a mission can start.

use super::validation::{ROUNDING, robot_key};
use super::{Fault, KeyPath, LinkRanges, Problem, Scenario, Settings};
use nalgebra::distance;
use pleach_continuous::Point;
use pleach_continuous::geometry::workspace::Polygon;
use pleach_continuous::geometry::{FreeSpace, Workspace, WorkspaceError};
use pleach_continuous::network::CubicReliability;
use pleach_continuous::network::routing::central::widest_reserve;
use pleach_continuous::network::routing::problem::RoutingProblem;

/// The rate that may be missing where rates just fit, well above the solver's 1e-8.
const RATE_TOLERANCE: f64 = 1e-6;

/// What is wrong with the workspace and with where robots and access points stand in it.
pub(super) fn faults(scenario: &Scenario) -> Vec<Fault> {
    let ground = match Ground::of(scenario) {
        Ok(ground) => ground,
        Err(fault) => return vec![fault],
    };
    let checks = [Ground::outside, Ground::too_close_to_walls, Ground::robots_too_close];
    let mut faults: Vec<_> = checks.iter().flat_map(|check| check(&ground)).collect();
    if faults.is_empty() {
        faults = ground.cut_off();
    }
    if faults.is_empty() {
        faults.extend(ground.overloaded());
    }
    faults
}

/// A workspace and who starts in it.
struct Ground {
    settings: Settings,
    workspace: Workspace,
    free_space: FreeSpace,
    access_points: Vec<Point>,
    robots: Vec<Point>,
    rates: Vec<f64>,
}

impl Ground {
    fn of(scenario: &Scenario) -> Result<Self, Fault> {
        let settings = Settings::resolve(scenario);
        let workspace = scenario
            .workspace()
            .map_err(|error| Problem::Outline(error.to_string()).at(key_of_outline(&error)))?;
        let free_space = FreeSpace::new(&workspace, settings.clearance).map_err(|error| {
            let key = KeyPath::root().key("control").key("clearance");
            Problem::Outline(error.to_string()).at(key)
        })?;
        Ok(Self {
            settings,
            workspace,
            free_space,
            access_points: (scenario.access_point.iter())
                .map(|access_point| access_point.position.into())
                .collect(),
            robots: scenario.robot.iter().map(|robot| robot.position.into()).collect(),
            rates: scenario.robot.iter().map(|robot| robot.rate).collect(),
        })
    }

    /// Robots and access points outside the boundary or in a hole.
    fn outside(&self) -> Vec<Fault> {
        let access_points = (self.access_points.iter().enumerate())
            .map(|(index, place)| (KeyPath::root().key("access_point").index(index), place));
        let robots = self.robots.iter().enumerate().map(|(index, place)| (robot_key(index), place));
        (access_points.chain(robots))
            .filter(|&(_, &place)| !self.workspace.contains(place))
            .map(|(key, place)| Problem::Outside { x: place.x, y: place.y }.at(key.key("position")))
            .collect()
    }

    /// Robots closer than ρ to a wall.
    fn too_close_to_walls(&self) -> Vec<Fault> {
        let clearance = self.settings.clearance;
        (self.robots.iter().enumerate())
            .filter(|&(_, &place)| self.workspace.contains(place))
            .map(|(index, &place)| (index, place, self.workspace.clearance(place)))
            .filter(|&(.., distance)| distance < clearance * (1.0 - ROUNDING))
            .map(|(index, Point { coords }, distance)| {
                Problem::TooCloseToWall { x: coords.x, y: coords.y, distance, clearance }
                    .at(robot_key(index).key("position"))
            })
            .collect()
    }

    /// Robots closer than 2ρ to each other; each robot is compared with those before it.
    fn robots_too_close(&self) -> Vec<Fault> {
        let least = 2.0 * self.settings.clearance;
        let nearest_before = |index: usize| {
            (self.robots[..index].iter().enumerate())
                .map(|(other, place)| (other, distance(place, &self.robots[index])))
                .min_by(|left, right| left.1.total_cmp(&right.1))
        };
        (0..self.robots.len())
            .filter_map(|index| Some((index, nearest_before(index)?)))
            .filter(|&(_, (_, distance))| distance < least * (1.0 - ROUNDING))
            .map(|(index, (other, distance))| {
                Problem::RobotsTooClose { other, distance, least }
                    .at(robot_key(index).key("position"))
            })
            .collect()
    }

    /// Robots that no chain of new tree links connects to an access point, found by walking
    /// outwards from the access points.
    fn cut_off(&self) -> Vec<Fault> {
        let longest = self.settings.longest_new_link();
        let mut reached = self.access_points.clone();
        let mut missing: Vec<usize> = (0..self.robots.len()).collect();
        while let Some(place) = reached.pop() {
            let (linked, apart): (Vec<_>, Vec<_>) =
                missing.into_iter().partition(|&robot| self.link(place, self.robots[robot]));
            missing = apart;
            reached.extend(linked.into_iter().map(|robot| self.robots[robot]));
        }
        (missing.into_iter())
            .map(|robot| Problem::CutOff { longest }.at(robot_key(robot).key("position")))
            .collect()
    }

    /// Rates that no routing carries from where the robots start: with the best one, some robot
    /// receives and generates more than it sends. A solver without an answer proves nothing.
    fn overloaded(&self) -> Option<Fault> {
        let missing = -self.widest_reserve()?;
        (missing > RATE_TOLERANCE)
            .then(|| Problem::RatesTooHigh { missing }.at(KeyPath::root().key("robot")))
    }

    /// The largest residual that some routing gives to every robot at once.
    fn widest_reserve(&self) -> Option<f64> {
        let Self { settings, robots, access_points, rates, .. } = self;
        let LinkRanges { full_range, max_range } = settings.link;
        let link = CubicReliability::new(full_range, max_range).ok()?;
        let aversion = settings.slope_aversion;
        let routing =
            RoutingProblem::of_places(robots, access_points, rates, &link, aversion, 0.0).ok()?;
        widest_reserve(&routing).ok()
    }

    /// Whether a link of the tree may be built between two places. A link through a wall cannot
    /// be walked, so its length is that of the geodesic.
    fn link(&self, from: Point, to: Point) -> bool {
        let longest = self.settings.longest_new_link() * (1.0 + ROUNDING);
        distance(&from, &to) <= longest && self.free_space.distance(from, to) <= longest
    }
}

impl Scenario {
    /// The workspace 𝒲.
    ///
    /// # Errors
    /// The polygons do not bound a workspace.
    pub fn workspace(&self) -> Result<Workspace, WorkspaceError> {
        let polygon = |corners: &Vec<[f64; 2]>| corners.iter().copied().map(Point::from).collect();
        let holes = self.workspace.holes.iter().map(polygon).collect();
        Workspace::new(polygon(&self.workspace.boundary), holes)
    }
}

/// Where in the scenario the polygon stands that the error speaks of; of two, the later one.
fn key_of_outline(error: &WorkspaceError) -> KeyPath {
    let workspace = KeyPath::root().key("workspace");
    let of = |polygon: &Polygon| match *polygon {
        Polygon::Boundary => workspace.clone().key("boundary"),
        Polygon::Hole(hole) => workspace.clone().key("holes").index(hole),
    };
    match error {
        WorkspaceError::TooFewVertices { polygon, .. } | WorkspaceError::Flat { polygon } => {
            of(polygon)
        }
        WorkspaceError::NotFinite { polygon, vertex, .. } => of(polygon).index(*vertex),
        WorkspaceError::RepeatedVertex { polygon, second, .. } => of(polygon).index(*second),
        WorkspaceError::SelfIntersecting { second, .. }
        | WorkspaceError::PolygonsMeet { second, .. } => of(&second.polygon).index(second.index),
        WorkspaceError::HoleOutside { hole, .. } => of(&Polygon::Hole(*hole)),
        WorkspaceError::NestedHoles { inner, .. } => of(&Polygon::Hole(*inner)),
    }
}
