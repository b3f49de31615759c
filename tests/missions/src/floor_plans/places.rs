//! Places on a floor for tasks and robots.

use super::brief::{Crowd, Target};
use super::dice::Dice;
use pleach::automaton::network::scenario::{Scenario, Settings};
use pleach::continuous::Point;
use pleach::continuous::geometry::{FreeSpace, Workspace};

/// Places tried for a robot or task before a draft is given up.
const TRIES: usize = 4000;
/// Rounding of coordinates must not break a rule that a place just keeps.
const CAUTION: f64 = 0.999;
/// A tree of robots is this much longer than one of shortest paths.
const WASTE: f64 = 1.25;

/// A floor on which tasks and robots find their places.
pub struct Places {
    settings: Settings,
    workspace: Workspace,
    free_space: FreeSpace,
    access_points: Vec<Point>,
    robots: Vec<Point>,
    tasks: Vec<Point>,
    /// Nodes of a tree of shortest paths to the tasks.
    tree: Vec<Point>,
    needed: f64,
}

impl Places {
    /// The floor of a scenario that has no robots and tasks yet; none if it is no workspace.
    pub fn new(scenario: &Scenario) -> Option<Self> {
        let settings = Settings::resolve(scenario);
        // Rates are not known yet. Links of this reliability carry those of any robots.
        let build_reliability =
            scenario.control.build_reliability.unwrap_or(Settings::GOOD_RELIABILITY);
        let settings = Settings { build_reliability, ..settings };
        let (workspace, _) = scenario.workspace().ok()?;
        let free_space = FreeSpace::new(&workspace, settings.clearance).ok()?;
        let access_points: Vec<Point> =
            scenario.access_point.iter().map(|it| it.position.into()).collect();
        let all_in_free_space = access_points.iter().all(|&place| free_space.contains(place));
        all_in_free_space.then(|| Places {
            settings,
            workspace,
            free_space,
            tree: access_points.clone(),
            access_points,
            robots: Vec::new(),
            tasks: Vec::new(),
            needed: 0.0,
        })
    }

    pub fn robots(&self) -> &[Point] {
        &self.robots
    }

    /// How many robots a tree to all tasks takes.
    pub fn robots_needed(&self) -> usize {
        self.needed.ceil() as usize
    }

    /// A place for a task, and the way to it.
    pub fn task(&mut self, target: Target, dice: &mut Dice) -> Option<[f64; 2]> {
        let reach = CAUTION * self.settings.service_radius;
        for _ in 0..TRIES {
            let place = self.candidate(target, dice);
            let stand = self.free_space.nearest(place);
            if !self.workspace.contains(place)
                || (stand - place).norm() > reach
                || self.tasks.iter().any(|other| (other - place).norm() < 2.0 * reach)
            {
                continue;
            }
            if let Some(()) = self.grow_tree(stand) {
                self.tasks.push(place);
                return Some([place.x, place.y]);
            }
        }
        None
    }

    fn candidate(&self, target: Target, dice: &mut Dice) -> Point {
        let radius = self.settings.service_radius;
        let around = |place: Point, dice: &mut Dice| {
            let (angle, distance) = (dice.between(0.0, 6.3), dice.between(0.0, 2.0 * radius));
            Point::new(place.x + distance * angle.cos(), place.y + distance * angle.sin())
        };
        match target {
            Target::Anywhere => self.anywhere(dice),
            Target::InCorners => {
                let corners: Vec<Point> =
                    self.workspace.polygons().iter().flatten().copied().collect();
                around(dice.pick(&corners), dice)
            }
            Target::AtWalls => {
                let edges: Vec<_> = self.workspace.edges().collect();
                let edge = dice.pick(&edges);
                around(edge.at(dice.between(0.0, 1.0)), dice)
            }
            Target::At(place) => Point::from(place),
        }
    }

    fn anywhere(&self, dice: &mut Dice) -> Point {
        let (mut low, mut high) = (self.workspace.boundary()[0], self.workspace.boundary()[0]);
        for corner in self.workspace.boundary() {
            (low, high) = (low.inf(corner), high.sup(corner));
        }
        Point::new(dice.between(low.x, high.x), dice.between(low.y, high.y))
    }

    /// Adds the shortest path from the tree to `stand`, a node every d_build.
    fn grow_tree(&mut self, stand: Point) -> Option<()> {
        let step = self.settings.usual_links().build / WASTE;
        let (from, length) = (self.tree.iter())
            .map(|&node| (node, self.free_space.distance(node, stand)))
            .min_by(|a, b| a.1.total_cmp(&b.1))?;
        let path = self.free_space.geodesic(from, stand)?;
        let mut walked = 0.0;
        for segment in path.segments(from) {
            let mut next = step - walked % step;
            while next < segment.length() {
                self.tree.push(segment.at(next / segment.length()));
                next += step;
            }
            walked += segment.length();
        }
        self.tree.push(stand);
        self.needed += (length / step).ceil().max(1.0);
        Some(())
    }

    /// Robots at places of their own, where they are connected there.
    pub fn park(&mut self, places: &[[f64; 2]]) {
        let mut waiting: Vec<Point> = places.iter().map(|&place| Point::from(place)).collect();
        while let Some(at) = waiting.iter().position(|&place| self.is_place(place, 2.1)) {
            self.robots.push(waiting.remove(at));
        }
    }

    /// Robots around the access points, until there are this many.
    pub fn gather(&mut self, crowd: Crowd, robots: usize, dice: &mut Dice) -> Option<()> {
        let spacing = dice.between(2.1, 6.0);
        let mut radius = 0.5;
        let mut tries = 0;
        while self.robots.len() < robots {
            tries += 1;
            if tries % 200 == 0 {
                radius *= 1.2;
            }
            if tries > 4 * TRIES {
                return None;
            }
            let place = match crowd {
                Crowd::Around => {
                    let center = self.access_points[self.robots.len() % self.access_points.len()];
                    scattered(center, radius, dice)
                }
                Crowd::Chains => {
                    let known = self.access_points.len() + self.robots.len();
                    let last = dice.count(known.saturating_sub(3), known - 1);
                    let center = *(self.access_points.iter().chain(&self.robots).nth(last))?;
                    scattered(center, self.settings.usual_links().build, dice)
                }
            };
            let far_enough = match crowd {
                Crowd::Around => true,
                Crowd::Chains => {
                    let near = self.linked_to(place).count();
                    near <= 2 || tries % 40 == 0
                }
            };
            if far_enough && self.is_place(place, spacing.min(6.0 * 1.2 / radius).max(2.1)) {
                self.robots.push(place);
            }
        }
        Some(())
    }

    /// Whether a robot may start at `place`, this many clearances from others, connected to them.
    fn is_place(&self, place: Point, spacing: f64) -> bool {
        let room = spacing * self.settings.clearance;
        self.free_space.contains(place)
            && self.robots.iter().all(|other| (other - place).norm() >= room)
            && self.linked_to(place).next().is_some()
    }

    fn linked_to(&self, place: Point) -> impl Iterator<Item = Point> {
        let longest = CAUTION * self.settings.usual_links().build;
        (self.access_points.iter().chain(&self.robots).copied()).filter(move |&other| {
            (other - place).norm() <= longest && self.free_space.distance(other, place) <= longest
        })
    }
}

fn scattered(center: Point, radius: f64, dice: &mut Dice) -> Point {
    let (angle, share) = (dice.between(0.0, std::f64::consts::TAU), dice.between(0.0, 1.0));
    let distance = radius * share.sqrt();
    Point::new(center.x + distance * angle.cos(), center.y + distance * angle.sin())
}
