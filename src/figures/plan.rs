//! The floor plan behind the robots: walls, free space and the lengths that matter in it.

use pleach_automaton::network::scenario::{Scenario, ValidScenario};
use pleach_drawing::svg::node::element::{Group, Path};
use pleach_drawing::{corners, layer, number};

use super::canvas::{Spot, View, rectangle};
use super::labels::WallTest;
use super::palette;

/// Reach of the wall that is drawn around the boundary, on the paper.
const WALL_MARGIN: f64 = 9.0;

/// What does not change during a mission: the workspace, its free space and the settings that a
/// figure shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    pub(super) scenario: Scenario,
    pub(super) free_space: Vec<Vec<[f64; 2]>>,
    pub(super) is_plain: bool,
}

impl Plan {
    /// Of a scenario, with the outline of W_f.
    #[must_use]
    pub fn of(scenario: &ValidScenario) -> Plan {
        let corners = |ring: &Vec<_>| ring.iter().map(|&corner| <[f64; 2]>::from(corner)).collect();
        let outline = scenario.site().free_space.outline();
        Plan::new(scenario, outline.iter().map(corners).collect())
    }

    /// The same with these loops for the outline of W_f, which may be none.
    #[must_use]
    pub(super) fn new(scenario: &Scenario, free_space_outline: Vec<Vec<[f64; 2]>>) -> Plan {
        Plan { scenario: scenario.clone(), free_space: free_space_outline, is_plain: false }
    }

    /// The same plan for figures without title, for papers with captions of their own.
    #[must_use]
    pub fn plain(self) -> Plan {
        Plan { is_plain: true, ..self }
    }

    /// ρ, with the default that the scenario's documentation states.
    pub(super) fn clearance(&self) -> f64 {
        self.scenario.control.clearance.unwrap_or(self.scenario.link.full_range / 40.0)
    }

    /// Boundary and holes.
    pub(super) fn loops(&self) -> impl Iterator<Item = &Vec<[f64; 2]>> {
        let workspace = &self.scenario.workspace;
        std::iter::once(&workspace.boundary).chain(&workspace.holes)
    }

    /// The place of a node: robots first, then access points.
    pub(super) fn access_point(&self, node: usize, robots: usize) -> Option<[f64; 2]> {
        let index = node.checked_sub(robots)?;
        self.scenario.access_point.get(index).map(|point| point.position)
    }

    /// Draws walls, floor and the outline of W_f.
    pub(super) fn draw(&self, view: &View) -> Group {
        let ([x, y], [width, height]) = view.frame();
        let wall = rectangle(
            [x - WALL_MARGIN, y - WALL_MARGIN],
            [width + 2.0 * WALL_MARGIN, height + 2.0 * WALL_MARGIN],
            palette::WALL,
        );
        let floor = Path::new()
            .set("d", outline(self.loops(), view))
            .set("fill", palette::FLOOR)
            .set("fill-rule", "evenodd");
        let free_space = Path::new()
            .set("class", "free-space")
            .set("d", outline(self.free_space.iter(), view))
            .set("fill", "none")
            .set("stroke", palette::LIMIT)
            .set("stroke-width", "0.8")
            .set("stroke-opacity", "0.75")
            .set("stroke-dasharray", "4 3");
        let plan = layer("plan").add(wall.set("rx", "5")).add(floor);
        if self.free_space.is_empty() { plan } else { plan.add(free_space) }
    }
}

fn outline<'a>(loops: impl Iterator<Item = &'a Vec<[f64; 2]>>, view: &View) -> String {
    let pieces: Vec<String> = loops
        .filter(|corners| corners.len() > 2)
        .map(|points| format!("M{}Z", corners(points.iter().map(|point| view.spot(*point)))))
        .collect();
    pieces.join(" ")
}

/// Answers for the paper whether a spot is wall.
#[derive(Debug)]
pub(super) struct PaperWalls {
    loops: Vec<Vec<Spot>>,
}

impl PaperWalls {
    pub(super) fn new(plan: &Plan, view: &View) -> PaperWalls {
        let on_paper = |points: &Vec<[f64; 2]>| points.iter().map(|p| view.spot(*p)).collect();
        PaperWalls { loops: plan.loops().map(on_paper).collect() }
    }
}

impl WallTest for PaperWalls {
    fn is_wall(&self, [x, y]: Spot) -> bool {
        let crossings = self.loops.iter().flat_map(|points| sides(points)).filter(|(a, b)| {
            (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        });
        crossings.count() % 2 == 0
    }
}

/// The sides of a closed loop.
pub(super) fn sides(points: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
    points.iter().copied().zip(points.iter().copied().cycle().skip(1))
}

/// Draws a length as a bar with ends.
pub(super) fn bar([x, y]: Spot, length: f64) -> Path {
    let (left, right) = (number(x), number(x + length));
    let (top, middle, foot) = (number(y - 4.0), number(y), number(y + 4.0));
    Path::new()
        .set("d", format!("M{left},{top}V{foot}M{left},{middle}H{right}M{right},{top}V{foot}"))
        .set("fill", "none")
        .set("stroke", palette::INK)
        .set("stroke-width", "1.2")
}
