//! Scenes in the shape of `foxglove.SceneUpdate`.

use crate::automaton::network::record::Snapshot;
use crate::automaton::network::scenario::{Scenario, Settings};
use crate::figures::Mark;
use serde::Serialize;

/// The frame of all coordinates.
const FRAME: &str = "workspace";

/// The kinds of lines.
const LINE_LOOP: u8 = 1;
const LINE_LIST: u8 = 2;

/// An instant of the mission.
#[derive(Clone, Copy, Serialize)]
pub(super) struct Stamp {
    sec: u32,
    nsec: u32,
}

impl Stamp {
    pub(super) fn of(time: f64) -> Self {
        let time = time.max(0.0);
        Self { sec: time as u32, nsec: (time.fract() * 1e9) as u32 }
    }

    pub(super) fn nanoseconds(self) -> u64 {
        u64::from(self.sec) * 1_000_000_000 + u64::from(self.nsec)
    }
}

#[derive(Serialize)]
pub(super) struct Scene {
    deletions: [(); 0],
    entities: Vec<Entity>,
}

#[derive(Serialize)]
struct Entity {
    timestamp: Stamp,
    frame_id: &'static str,
    id: &'static str,
    lifetime: Stamp,
    frame_locked: bool,
    metadata: [(); 0],
    arrows: [(); 0],
    cubes: [(); 0],
    spheres: [(); 0],
    cylinders: Vec<Cylinder>,
    lines: Vec<Line>,
    triangles: [(); 0],
    texts: Vec<Text>,
    models: [(); 0],
}

#[derive(Serialize)]
struct Cylinder {
    pose: Pose,
    size: Vector,
    bottom_scale: f64,
    top_scale: f64,
    color: Colour,
}

#[derive(Serialize)]
struct Line {
    #[serde(rename = "type")]
    kind: u8,
    pose: Pose,
    thickness: f64,
    scale_invariant: bool,
    points: Vec<Vector>,
    color: Colour,
    colors: [Colour; 0],
    indices: [u32; 0],
}

#[derive(Serialize)]
struct Text {
    pose: Pose,
    billboard: bool,
    font_size: f64,
    scale_invariant: bool,
    color: Colour,
    text: String,
}

#[derive(Clone, Copy, Serialize)]
struct Vector {
    x: f64,
    y: f64,
    z: f64,
}

#[derive(Serialize)]
struct Pose {
    position: Vector,
    orientation: Quaternion,
}

#[derive(Serialize)]
struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Clone, Copy, Serialize)]
struct Colour {
    r: f64,
    g: f64,
    b: f64,
    a: f64,
}

const WALL: Colour = Colour { r: 0.35, g: 0.36, b: 0.4, a: 1.0 };
const TREE: Colour = Colour { r: 0.8, g: 0.2, b: 0.2, a: 1.0 };
const LINK: Colour = Colour { r: 0.2, g: 0.6, b: 0.3, a: 0.6 };
const TASK: Colour = Colour { r: 0.1, g: 0.35, b: 0.8, a: 1.0 };
const LABEL: Colour = Colour { r: 0.0, g: 0.0, b: 0.0, a: 1.0 };

/// The colour of a mark in figures, `#rrggbb`.
fn colour_of(mark: Mark) -> Colour {
    let part = |at: usize| {
        let digits = mark.colour().get(at..at + 2).and_then(|hex| u8::from_str_radix(hex, 16).ok());
        f64::from(digits.unwrap_or_default()) / 255.0
    };
    Colour { r: part(1), g: part(3), b: part(5), a: 1.0 }
}

fn at([x, y]: [f64; 2], z: f64) -> Pose {
    Pose {
        position: Vector { x, y, z },
        orientation: Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 },
    }
}

fn on_floor([x, y]: [f64; 2]) -> Vector {
    Vector { x, y, z: 0.0 }
}

fn line(kind: u8, thickness: f64, points: Vec<Vector>, color: Colour) -> Line {
    let pose = at([0.0, 0.0], 0.0);
    let (colors, indices) = ([], []);
    Line { kind, pose, thickness, scale_invariant: false, points, color, colors, indices }
}

fn disc(place: [f64; 2], radius: f64, color: Colour) -> Cylinder {
    let size = Vector { x: 2.0 * radius, y: 2.0 * radius, z: radius };
    Cylinder { pose: at(place, radius / 2.0), size, bottom_scale: 1.0, top_scale: 1.0, color }
}

fn label(place: [f64; 2], size: f64, text: String) -> Text {
    let pose = at(place, 1.5 * size);
    Text { pose, billboard: true, font_size: size, scale_invariant: false, color: LABEL, text }
}

fn entity(id: &'static str, time: f64) -> Entity {
    Entity {
        timestamp: Stamp::of(time),
        frame_id: FRAME,
        id,
        lifetime: Stamp { sec: 0, nsec: 0 },
        frame_locked: false,
        metadata: [],
        arrows: [],
        cubes: [],
        spheres: [],
        cylinders: Vec::new(),
        lines: Vec::new(),
        triangles: [],
        texts: Vec::new(),
        models: [],
    }
}

/// Walls, access points and tasks.
pub(super) fn plan(scenario: &Scenario) -> Scene {
    let clearance = Settings::resolve(scenario).clearance;
    let mut plan = entity("plan", 0.0);
    let rings = std::iter::once(&scenario.workspace.boundary).chain(&scenario.workspace.holes);
    plan.lines = rings
        .map(|ring| {
            let corners = ring.iter().map(|&corner| on_floor(corner)).collect();
            line(LINE_LOOP, clearance / 2.0, corners, WALL)
        })
        .collect();
    for access_point in &scenario.access_point {
        let colour = colour_of(Mark::AccessPoint);
        plan.cylinders.push(disc(access_point.position, clearance, colour));
    }
    for (number, task) in scenario.task.iter().enumerate() {
        plan.cylinders.push(disc(task.position, clearance / 2.0, TASK));
        plan.texts.push(label(task.position, 2.0 * clearance, format!("task {number}")));
    }
    Scene { deletions: [], entities: vec![plan] }
}

/// A snapshot with its scenario.
pub(super) struct Frame<'a> {
    scenario: &'a Scenario,
    snapshot: &'a Snapshot,
    clearance: f64,
}

impl<'a> Frame<'a> {
    pub(super) fn of(scenario: &'a Scenario, snapshot: &'a Snapshot) -> Self {
        Self { scenario, snapshot, clearance: Settings::resolve(scenario).clearance }
    }

    /// Robots, tree and links.
    pub(super) fn scene(&self) -> Scene {
        let mut network = entity("network", self.snapshot.time);
        for (robot, place) in self.snapshot.positions.iter().enumerate() {
            let place = [place.x, place.y];
            let colour = colour_of(Mark::of(self.snapshot, robot));
            network.cylinders.push(disc(place, self.clearance, colour));
            network.texts.push(label(place, 2.0 * self.clearance, robot.to_string()));
        }
        let ends =
            |from: usize, to: usize| [from, to].into_iter().filter_map(|node| self.place(node));
        let tree = self.snapshot.tree.iter();
        let edges = tree.flat_map(|&(child, parent)| ends(child, parent)).collect();
        for route in &self.snapshot.routes {
            let thickness = self.clearance * route.share * route.reliability;
            let points = ends(route.from, route.to).collect();
            network.lines.push(line(LINE_LIST, thickness, points, LINK));
        }
        network.lines.push(line(LINE_LIST, self.clearance / 5.0, edges, TREE));
        Scene { deletions: [], entities: vec![network] }
    }

    fn place(&self, node: usize) -> Option<Vector> {
        let robots = self.snapshot.positions.len();
        let robot = self.snapshot.positions.get(node).map(|place| [place.x, place.y]);
        let fixed = || Some(self.scenario.access_point.get(node.checked_sub(robots)?)?.position);
        robot.or_else(fixed).map(on_floor)
    }
}
