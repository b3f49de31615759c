//! Shortest ways beside `polyanya`, without clearance: in a map that comes with it, in halls of pillars and
//! in a maze.
//!
//! `polyanya` searches a mesh of polygons anew for each way, in single precision. `pleach` finds which corners
//! see each other when a way first asks for it, and keeps that; so the first ways in a map and those after them
//! are measured apart. Lengths are held against those of a search over all pairs of corners.

use std::collections::BTreeSet;
use std::hint::black_box;
use std::time::Duration;

use glam::Vec2;
use pleach_continuous::Point;
use pleach_continuous::geometry::{FreeSpace, Workspace};
use polyanya::{Mesh, PolyanyaFile, Triangulation};

use crate::measure::{ratio, timed};
use crate::report::Report;

/// Ways in each measurement.
const WAYS: usize = 1000;
/// How many of them are compared with the search over all pairs.
const CHECKED: usize = 100;
/// The tolerance of the free space, as a share of its extent: geodesics are exact to about ten times it.
const TOLERANCE: f64 = 1e-12;
/// How often everything is measured; the shortest time counts.
const ROUNDS: usize = 5;
/// The arena of the Polyanya paper by Cui, Harabor and Grastien (2017): a mesh of convex polygons.
const ARENA: &[u8] = include_bytes!("../maps/arena.mesh");

/// A map with the ends of ways in it.
struct Map {
    name: String,
    workspace: Workspace,
    make_mesh: Box<dyn Fn() -> Mesh>,
    ends: Vec<(Point, Point)>,
}

/// Adds the rows of all maps.
pub fn all(report: &mut Report) {
    report.table(&[
        "shortest ways",
        "vertices",
        "set up",
        "first 1000",
        "another 1000",
        "error",
        "error of `polyanya`",
    ]);
    for map in [arena(), hall(5), hall(10), hall(20), maze(10)] {
        compare(&map, report);
    }
}

/// The outline of a mesh: the edges of its polygons that no other polygon shares, one after the other.
fn arena() -> Map {
    let file = PolyanyaFile::from_bytes(ARENA);
    let edges_of = |polygon: &polyanya::Polygon| -> Vec<(u32, u32)> {
        let next = polygon.vertices.iter().cycle().skip(1);
        polygon.vertices.iter().copied().zip(next.copied()).collect()
    };
    let edges: BTreeSet<(u32, u32)> = file.polygons.iter().flat_map(edges_of).collect();
    let mut outer: BTreeSet<(u32, u32)> =
        edges.iter().copied().filter(|&(from, to)| !edges.contains(&(to, from))).collect();
    let place = |vertex: u32| {
        let Vec2 { x, y } = file.vertices[vertex as usize].coords;
        Point::new(f64::from(x), f64::from(y))
    };
    let mut rings: Vec<Vec<Point>> = Vec::new();
    while let Some((first, mut at)) = outer.pop_first() {
        let mut ring = vec![place(first)];
        while at != first {
            ring.push(place(at));
            let next = outer.range((at, 0)..).next().copied().expect("outlines are closed");
            outer.remove(&next);
            at = next.1;
        }
        rings.push(ring);
    }
    // The boundary is the ring that reaches farthest.
    let left = |ring: &Vec<Point>| ring.iter().map(|place| place.x).fold(f64::INFINITY, f64::min);
    rings.sort_by(|one, other| left(one).total_cmp(&left(other)));
    let boundary = rings.remove(0);
    let (workspace, _) = Workspace::repaired(boundary, rings).expect("a workspace");
    let mesh = || PolyanyaFile::from_bytes(ARENA).try_into().expect("a mesh");
    Map::new("arena".to_owned(), workspace, Box::new(mesh))
}

/// A map with these polygons, of which `polyanya` makes a mesh by triangulation.
fn drawn(name: String, boundary: Vec<Point>, holes: Vec<Vec<Point>>) -> Map {
    let workspace = Workspace::new(boundary.clone(), holes.clone()).expect("a workspace");
    let mesh = move || {
        let ring = |ring: &Vec<Point>| ring.iter().copied().map(vector).collect::<Vec<_>>();
        let mut triangulation = Triangulation::from_outer_edges(&ring(&boundary));
        triangulation.add_obstacles(holes.iter().map(ring));
        triangulation.as_navmesh()
    };
    Map::new(name, workspace, Box::new(mesh))
}

/// A hall with `side`² square pillars, each turned differently.
fn hall(side: usize) -> Map {
    let extent = side as f64;
    let square = |center: Point, turn: f64| -> Vec<Point> {
        let corner = |at: i32| (f64::from(at) + turn) * std::f64::consts::FRAC_PI_2;
        (0..4)
            .map(corner)
            .map(|a| center + 0.35 * pleach_continuous::Vector::new(a.cos(), a.sin()))
            .collect()
    };
    let middle =
        |index: usize| Point::new((index % side) as f64 + 0.5, (index / side) as f64 + 0.5);
    let holes = (0..side * side).map(|index| square(middle(index), 0.37 * index as f64)).collect();
    let boundary = [(0.0, 0.0), (extent, 0.0), (extent, extent), (0.0, extent)];
    let boundary = boundary.map(|(x, y)| Point::new(x, y)).to_vec();
    drawn(format!("hall of {} pillars", side * side), boundary, holes)
}

/// A corridor that runs to and fro `lanes` times.
fn maze(lanes: usize) -> Map {
    let (wide, top) = (10.0, lanes as f64);
    let mut boundary = vec![Point::new(0.0, 0.0), Point::new(wide, 0.0)];
    // Up along the right, with a slit into the hall after every second lane; back along the left likewise.
    for lane in (1..lanes).step_by(2) {
        let y = lane as f64;
        boundary
            .extend([(wide, y), (1.0, y + 0.03), (wide, y + 0.1)].map(|(x, y)| Point::new(x, y)));
    }
    boundary.extend([Point::new(wide, top), Point::new(0.0, top)]);
    for lane in (2..lanes).step_by(2).collect::<Vec<_>>().into_iter().rev() {
        let y = lane as f64;
        boundary.extend(
            [(0.0, y + 0.1), (wide - 1.0, y + 0.07), (0.0, y)].map(|(x, y)| Point::new(x, y)),
        );
    }
    drawn(format!("maze of {lanes} lanes"), boundary, Vec::new())
}

impl Map {
    fn new(name: String, workspace: Workspace, make_mesh: Box<dyn Fn() -> Mesh>) -> Map {
        let extent = workspace.extent();
        let share = |index: usize, step: f64| (0.5 + index as f64 * step).fract() * extent;
        let mut places = (1..)
            .map(|index| Point::new(share(index, 0.618_033_988_7), share(index, 0.754_877_666_2)))
            .filter(|&place| workspace.clearance(place) > 1e-3);
        let ends = (0..WAYS).filter_map(|_| Some((places.next()?, places.next()?))).collect();
        Map { name, workspace, make_mesh, ends }
    }

    fn free_space(&self) -> FreeSpace {
        FreeSpace::with_tolerance(&self.workspace, 0.0, TOLERANCE).expect("free space")
    }
}

fn vector(point: Point) -> Vec2 {
    Vec2::new(point.x as f32, point.y as f32)
}

fn compare(map: &Map, report: &mut Report) {
    let [mut own, mut peer] = [[Duration::MAX; 3]; 2];
    let mut lengths = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        let (space, set_up) = timed(|| map.free_space());
        let ways = || map.ends.iter().map(|&(from, to)| space.distance(from, to)).collect();
        let (found, first) = timed(ways);
        let (_, later) = timed(|| black_box::<Vec<f64>>(ways()));
        own = shorter(own, [set_up, first, later]);
        lengths[0] = found;
        let (mesh, set_up) = timed(|| (map.make_mesh)());
        let way = |&(from, to): &(Point, Point)| {
            mesh.path(vector(from), vector(to)).map_or(f64::INFINITY, |path| f64::from(path.length))
        };
        let (found, ways) = timed(|| map.ends.iter().map(way).collect());
        peer = shorter(peer, [set_up, ways, ways]);
        lengths[1] = found;
    }
    eprintln!("{}: {own:.1?}; {peer:.1?}", map.name);
    let exact = AllPairs::of(map);
    let exact: Vec<f64> = map.ends.iter().take(CHECKED).map(|&ends| exact.length(ends)).collect();
    let error = |lengths: &[f64]| {
        let errors = exact.iter().zip(lengths).map(|(exact, length)| (exact - length).abs());
        // Where `polyanya` finds no way there is no error to tell.
        format!("{:.0e}", errors.filter(|error| error.is_finite()).fold(0.0, f64::max))
    };
    let ratios = own.into_iter().zip(peer).map(|(own, peer)| format!("{:.1}", ratio(own, peer)));
    report.row(
        [map.name.clone(), map.workspace.edges().count().to_string()]
            .into_iter()
            .chain(ratios)
            .chain([error(&lengths[0]), error(&lengths[1])]),
    );
}

fn shorter(one: [Duration; 3], other: [Duration; 3]) -> [Duration; 3] {
    std::array::from_fn(|at| one[at].min(other[at]))
}

/// Which vertices of a map see each other, by trying every pair against every edge.
struct AllPairs {
    vertices: Vec<Point>,
    edges: Vec<(Point, Point)>,
    workspace: Workspace,
    seen: Vec<Vec<(usize, f64)>>,
}

impl AllPairs {
    fn of(map: &Map) -> AllPairs {
        let workspace = map.workspace.clone();
        let edges: Vec<(Point, Point)> =
            workspace.edges().map(|edge| (edge.from, edge.to)).collect();
        let vertices: Vec<Point> = edges.iter().map(|edge| edge.0).collect();
        let mut all = AllPairs { vertices, edges, workspace, seen: Vec::new() };
        all.seen = all.vertices.iter().map(|&from| all.seen_from(from)).collect();
        all
    }

    fn seen_from(&self, from: Point) -> Vec<(usize, f64)> {
        let seen = self.vertices.iter().enumerate().filter(|(_, to)| self.sees(from, **to));
        seen.map(|(index, to)| (index, (to - from).norm())).collect()
    }

    /// Whether no edge lies across the way between two places, nor the inside of what edges enclose.
    fn sees(&self, from: Point, to: Point) -> bool {
        let turn = |a: Point, b: Point, c: Point| (b - a).perp(&(c - a));
        let is_across = |&(a, b): &(Point, Point)| {
            let ends = [a, b].iter().any(|end| *end == from || *end == to);
            !ends
                && (turn(a, b, from) > 0.0) != (turn(a, b, to) > 0.0)
                && (turn(from, to, a) > 0.0) != (turn(from, to, b) > 0.0)
        };
        let is_edge = |&(a, b): &(Point, Point)| (a, b) == (from, to) || (b, a) == (from, to);
        if from == to || self.edges.iter().any(is_edge) {
            return from != to;
        }
        !self.edges.iter().any(is_across) && self.workspace.contains(nalgebra::center(&from, &to))
    }

    fn length(&self, (from, to): (Point, Point)) -> f64 {
        if self.sees(from, to) {
            return (to - from).norm();
        }
        let mut left = vec![f64::INFINITY; self.vertices.len()];
        self.seen_from(to).into_iter().for_each(|(vertex, length)| left[vertex] = length);
        let mut lengths = vec![f64::INFINITY; self.vertices.len()];
        self.seen_from(from).into_iter().for_each(|(vertex, length)| lengths[vertex] = length);
        let mut is_done = vec![false; self.vertices.len()];
        while let Some(next) = (0..lengths.len())
            .filter(|&at| !is_done[at] && lengths[at].is_finite())
            .min_by(|&a, &b| lengths[a].total_cmp(&lengths[b]))
        {
            is_done[next] = true;
            for &(vertex, length) in &self.seen[next] {
                lengths[vertex] = lengths[vertex].min(lengths[next] + length);
            }
        }
        lengths.iter().zip(&left).map(|(one, other)| one + other).fold(f64::INFINITY, f64::min)
    }
}
