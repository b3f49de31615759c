//! Whether robots and access points stand where a mission can start.

use std::collections::VecDeque;

use pleach_continuous::Point;
use pleach_continuous::geometry::Polygon;
use pleach_continuous::geometry::{Neighbours, Repair, Workspace, WorkspaceError};
use pleach_continuous::network::LinkReliability;
use pleach_continuous::network::rates::Receiver;
use pleach_continuous::network::routing::central::widest_reserve;
use pleach_continuous::network::routing::problem::{DirectedLink, RoutingProblem};

use super::validation::{ROUNDING, robot_key};
use super::{Fault, KeyPath, Problem, Scenario};
use crate::network::{Site, SiteError};

/// The rate that may be missing where rates just fit, well above the solver's 1e-8.
const RATE_TOLERANCE: f64 = 1e-6;

/// The site of a scenario whose values are in range.
pub(super) fn site(scenario: &Scenario) -> Result<Site, Fault> {
    Site::new(scenario).map_err(|error| {
        let key = match &error {
            SiteError::Workspace(error) => key_of_outline(error),
            SiteError::FreeSpace(_) => KeyPath::root().key("control").key("clearance"),
            SiteError::Range(_) => KeyPath::root().key("link"),
            SiteError::Build(_) => KeyPath::root(),
        };
        Problem::Outline(error.to_string()).at(key)
    })
}

/// The site in which the robots of `scenario` start: links are as long as they may be from the beginning if
/// the usual ones do not connect the robots.
pub(super) fn start(scenario: &Scenario, site: Site) -> Result<Site, Vec<Fault>> {
    let found = faults(scenario, &site);
    if found.is_empty() {
        return Ok(site);
    }
    let are_apart = |fault: &Fault| matches!(fault.problem, Problem::CutOff { .. });
    if !site.could_stretch() || !found.iter().all(are_apart) {
        return Err(found);
    }
    let site = site.stretched_from_the_start();
    let found = faults(scenario, &site);
    if found.is_empty() { Ok(site) } else { Err(found) }
}

/// What is wrong with where robots and access points of `scenario` stand in `site`.
pub(super) fn faults(scenario: &Scenario, site: &Site) -> Vec<Fault> {
    let ground = Ground::of(scenario, site);
    let faults = ground.misplaced();
    if !faults.is_empty() {
        return faults;
    }
    match ground.tree() {
        Ok(tree) => ground.overloaded(&tree).into_iter().collect(),
        Err(cut_off) => cut_off,
    }
}

/// Whether robots and access points stand in the workspace, off walls and off each other, however they are connected.
pub(super) fn stand(scenario: &Scenario, site: &Site) -> Result<(), Vec<Fault>> {
    let faults = Ground::of(scenario, site).misplaced();
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

/// A site and the starts in it.
struct Ground<'a> {
    site: &'a Site,
    robots: Vec<Point>,
    rates: Vec<f64>,
}

/// A robot as a tree of shortest hops reaches it.
struct Attached {
    robot: usize,
    parent: Receiver,
    /// R of the link to the parent.
    reliability: f64,
}

impl<'a> Ground<'a> {
    fn of(scenario: &Scenario, site: &'a Site) -> Self {
        Ground {
            site,
            robots: scenario.robot.iter().map(|robot| robot.position.into()).collect(),
            rates: scenario.robot.iter().map(|robot| robot.rate).collect(),
        }
    }

    /// Robots and access points in the wrong places, each seen by itself or beside its neighbours.
    fn misplaced(&self) -> Vec<Fault> {
        let checks = [Ground::outside, Ground::too_close_to_walls, Ground::robots_too_close];
        checks.iter().flat_map(|check| check(self)).collect()
    }

    /// Robots and access points outside the boundary or in a hole.
    fn outside(&self) -> Vec<Fault> {
        let access_points = (self.site.access_points.iter().enumerate())
            .map(|(index, place)| (KeyPath::root().key("access_point").index(index), place));
        let robots = self.robots.iter().enumerate().map(|(index, place)| (robot_key(index), place));
        (access_points.chain(robots))
            .filter(|&(_, &place)| !self.site.workspace.contains(place))
            .map(|(key, place)| Problem::Outside { x: place.x, y: place.y }.at(key.key("position")))
            .collect()
    }

    /// Robots closer to a wall than the clearance that they keep.
    fn too_close_to_walls(&self) -> Vec<Fault> {
        let clearance = self.site.settings.planning_clearance();
        let margin = clearance - self.site.settings.clearance;
        let workspace = &self.site.workspace;
        (self.robots.iter().enumerate())
            .filter(|&(_, &place)| workspace.contains(place))
            .map(|(index, &place)| (index, place, workspace.clearance(place)))
            .filter(|&(.., distance)| distance < clearance * (1.0 - ROUNDING))
            .map(|(index, Point { coords }, distance)| {
                Problem::TooCloseToWall { x: coords.x, y: coords.y, distance, clearance, margin }
                    .at(robot_key(index).key("position"))
            })
            .collect()
    }

    /// Robots closer than two clearances to one before them that keeps its distance itself.
    fn robots_too_close(&self) -> Vec<Fault> {
        let least = 2.0 * self.site.settings.planning_clearance();
        let margin = least / 2.0 - self.site.settings.clearance;
        let neighbours = Neighbours::new(&self.robots, least);
        let mut keeps_distance = vec![true; self.robots.len()];
        let mut faults = Vec::new();
        for (index, &place) in self.robots.iter().enumerate() {
            let before = neighbours.within(place, least).into_iter();
            let nearest = before
                .filter(|&other| other < index && keeps_distance[other])
                .map(|other| (other, (self.robots[other] - place).norm()))
                .min_by(|left, right| left.1.total_cmp(&right.1));
            if let Some((other, distance)) = nearest
                && distance < least * (1.0 - ROUNDING)
            {
                keeps_distance[index] = false;
                let problem = Problem::RobotsTooClose { other, distance, least, margin };
                faults.push(problem.at(robot_key(index).key("position")));
            }
        }
        faults
    }

    /// A tree of new links from the access points to all robots, parents before children; the
    /// robots that no chain of such links reaches are faults.
    fn tree(&self) -> Result<Vec<Attached>, Vec<Fault>> {
        let longest = self.site.usual.build * (1.0 + ROUNDING);
        let neighbours = Neighbours::new(&self.robots, longest);
        let mut is_missing = vec![true; self.robots.len()];
        let mut tree = Vec::with_capacity(self.robots.len());
        let mut reached: VecDeque<(Receiver, Point)> = (self.site.access_points.iter().enumerate())
            .map(|(number, &place)| (Receiver::AccessPoint(number), place))
            .collect();
        while let Some((parent, from)) = reached.pop_front() {
            for robot in neighbours.within(from, longest) {
                let place = self.robots[robot];
                if is_missing[robot] && self.site.link_length(from, place) <= longest {
                    is_missing[robot] = false;
                    let reliability = self.site.link.reliability((place - from).norm());
                    tree.push(Attached { robot, parent, reliability });
                    reached.push_back((Receiver::Robot(robot), place));
                }
            }
        }
        if tree.len() == self.robots.len() {
            return Ok(tree);
        }
        let longest = self.site.usual.build;
        Err((0..self.robots.len())
            .filter(|&robot| is_missing[robot])
            .map(|robot| Problem::CutOff { longest }.at(robot_key(robot).key("position")))
            .collect())
    }

    /// Rates that no routing carries from where the robots start. Three questions, the cheap ones
    /// first: whether `tree` alone carries them, whether the robots that hear an access point can
    /// pass on what all generate, and what the best routing gives.
    fn overloaded(&self, tree: &[Attached]) -> Option<Fault> {
        if self.is_carried_by(tree) {
            return None;
        }
        let robots = KeyPath::root().key("robot");
        let links = self.links();
        let total: f64 = self.rates.iter().sum();
        let most = self.most_to_access_points(&links);
        if total > most + RATE_TOLERANCE {
            return Some(Problem::RatesAboveAccess { total, most }.at(robots));
        }
        // A solver without an answer proves nothing.
        let routing = RoutingProblem::new(links, self.rates.clone(), 0.0).ok()?;
        let missing = -widest_reserve(&routing).ok()?;
        (missing > RATE_TOLERANCE).then(|| Problem::RatesTooHigh { missing }.at(robots))
    }

    /// Whether every robot can send to its parent all that its subtree generates.
    fn is_carried_by(&self, tree: &[Attached]) -> bool {
        let mut flows = self.rates.clone();
        tree.iter().rev().all(|&Attached { robot, parent, reliability }| {
            let flow = flows[robot];
            if let Receiver::Robot(parent) = parent {
                flows[parent] += flow;
            }
            flow <= reliability
        })
    }

    /// What the access points can receive at most: each robot sends for at most all of its time.
    fn most_to_access_points(&self, links: &[DirectedLink]) -> f64 {
        let mut best = vec![0.0_f64; self.robots.len()];
        for link in links.iter().filter(|link| matches!(link.receiver, Receiver::AccessPoint(_))) {
            best[link.sender] = best[link.sender].max(link.reliability);
        }
        best.iter().sum()
    }

    /// Every link with R > 0 from a robot. Weights play no part in what can be carried.
    fn links(&self) -> Vec<DirectedLink> {
        let nodes: Vec<Point> =
            self.robots.iter().chain(&self.site.access_points).copied().collect();
        let range = self.site.link.range();
        let neighbours = Neighbours::new(&nodes, range);
        let count = self.robots.len();
        let mut links = Vec::new();
        for (sender, &place) in self.robots.iter().enumerate() {
            let heard = neighbours.within(place, range).into_iter().filter(|&node| node != sender);
            links.extend(heard.filter_map(|node| {
                let reliability = self.site.link.reliability((nodes[node] - place).norm());
                let receiver = match node.checked_sub(count) {
                    Some(number) => Receiver::AccessPoint(number),
                    None => Receiver::Robot(node),
                };
                let link = DirectedLink { sender, receiver, reliability, weight: 1.0 };
                (reliability > 0.0).then_some(link)
            }));
        }
        links
    }
}

impl Scenario {
    /// The workspace 𝒲, and what of its polygons had to be [repaired](Workspace::repaired).
    ///
    /// # Errors
    /// The polygons do not bound a workspace.
    pub fn workspace(&self) -> Result<(Workspace, Vec<Repair>), WorkspaceError> {
        let polygon = |corners: &Vec<[f64; 2]>| corners.iter().copied().map(Point::from).collect();
        let holes = self.workspace.holes.iter().map(polygon).collect();
        Workspace::repaired(polygon(&self.workspace.boundary), holes)
    }
}

/// Where in the scenario the polygon stands that the error is about; of two, the later one.
fn key_of_outline(error: &WorkspaceError) -> KeyPath {
    let of = |polygon: &Polygon| key_of_polygon(*polygon);
    match error {
        WorkspaceError::TooFewVertices { polygon, .. } | WorkspaceError::Flat { polygon } => {
            of(polygon)
        }
        WorkspaceError::NotFinite { polygon, vertex, .. } => of(polygon).index(*vertex),
        WorkspaceError::RepeatedVertex { polygon, second, .. } => of(polygon).index(*second),
        WorkspaceError::SelfIntersecting { second, .. }
        | WorkspaceError::PolygonsMeet { second, .. }
        | WorkspaceError::Crossing { second, .. }
        | WorkspaceError::Overlap { second, .. } => of(&second.polygon).index(second.index),
        WorkspaceError::HoleOutside { hole, .. } => of(&Polygon::Hole(*hole)),
        WorkspaceError::NestedHoles { inner, .. } => of(&Polygon::Hole(*inner)),
    }
}

/// Where in the scenario a polygon stands.
fn key_of_polygon(polygon: Polygon) -> KeyPath {
    let workspace = KeyPath::root().key("workspace");
    match polygon {
        Polygon::Boundary => workspace.key("boundary"),
        Polygon::Hole(hole) => workspace.key("holes").index(hole),
    }
}

/// Where in the scenario something of the outline was repaired.
pub(super) fn key_of_repair(repair: &Repair) -> KeyPath {
    match repair.place() {
        Some((polygon, vertex)) => key_of_polygon(polygon).index(vertex),
        None => KeyPath::root().key("workspace"),
    }
}
