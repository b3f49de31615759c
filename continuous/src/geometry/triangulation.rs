//! A triangulation between walls, and which places are seen from a point, without a look at all the
//! others.
//!
//! Seen places are found by *triangular expansion*: from the triangle around the point, sight
//! passes over sides that are no walls, within a cone that the vertices on the way narrow
//! (B. Bungiu et al., *Efficient computation of visibility polygons*,
//! <https://arxiv.org/abs/1403.3905>). The time is in proportion to the triangles in sight, however
//! many there are elsewhere. Every decision is exact.

use std::collections::BTreeMap;

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

use super::Segment;
use super::edge_tree::Bounds;
use super::segment::side;
use crate::{Point, Vector};

/// Coordinates are scaled by a power of two so that the largest is about 1; smaller ones than this
/// are then taken for 0, since the library that triangulates refuses them.
const LEAST_COORDINATE: f64 = 1e-40;

/// Room for as many places and cones as there mostly are.
const MOSTLY: usize = 32;

/// A place that is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Seen {
    pub(super) place: usize,
    /// Whether the line of sight may touch a wall; otherwise it certainly keeps clear of all.
    pub(super) may_touch: bool,
}

/// What is seen from a point.
#[derive(Debug)]
pub(super) struct Sight {
    /// The places, in ascending order.
    pub(super) places: Vec<Seen>,
    /// A box around all that is seen, and perhaps more.
    pub(super) around: Option<Bounds>,
}

/// A constrained Delaunay triangulation of the plane around walls and places.
#[derive(Debug, Clone)]
pub(super) struct Triangulation {
    /// What coordinates are multiplied by, a power of two: all points in here are scaled.
    scale: f64,
    vertices: Vec<Vertex>,
    /// Three in a row, counter-clockwise, make a triangle.
    sides: Vec<Side>,
    sides_from: Groups,
    places_at: Groups,
    vertex_of_place: Vec<u32>,
    vertex_of_wall: Vec<u32>,
    /// Whether every wall is a side; walls that cross another one are not.
    has_all_walls: bool,
}

#[derive(Debug, Clone, Copy)]
struct Vertex {
    at: Point,
    is_on_wall: bool,
}

/// A side of a triangle, which lies to the left of it.
#[derive(Debug, Clone, Copy)]
struct Side {
    origin: u32,
    /// The same side of the triangle beyond; none at the rim of everything.
    twin: Option<u32>,
    is_wall: bool,
}

/// Sight that enters a triangle over one of its sides, between two limits.
#[derive(Debug, Clone, Copy)]
struct Cone {
    side: u32,
    left: Point,
    right: Point,
}

/// What sight begins with: vertices that are seen, and sides to look over.
#[derive(Debug, Default)]
struct Start {
    vertices: Vec<u32>,
    sides: Vec<u32>,
    touches_wall: bool,
}

impl Triangulation {
    /// The triangulation around `walls` and `places`; `None` without three vertices that are not
    /// in line.
    pub(super) fn new(walls: &[Segment], places: &[Point]) -> Option<Triangulation> {
        let ends = walls.iter().flat_map(|wall| [wall.from, wall.to]);
        let largest = ends.clone().chain(places.iter().copied()).map(|p| p.coords.amax());
        let scale = scale_for(largest.fold(0.0, f64::max));
        let mut positions = Positions::default();
        let mut vertices_of = |points: &mut dyn Iterator<Item = Point>| -> Vec<u32> {
            points.map(|point| positions.vertex_at(scaled(point, scale))).collect()
        };
        let wall_ends = vertices_of(&mut ends.into_iter());
        let vertex_of_place = vertices_of(&mut places.iter().copied());
        let edges: Vec<[usize; 2]> = wall_ends
            .chunks_exact(2)
            .map(|ends| [ends[0] as usize, ends[1] as usize])
            .filter(|[from, to]| from != to)
            .collect();
        let points = positions.points.iter().map(|p| Point2::new(p.x, p.y)).collect();
        let mut has_all_walls = true;
        let delaunay = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(
            points,
            edges,
            |_| has_all_walls = false,
        )
        .ok()?;
        let sides = sides_of(&delaunay);
        let mut vertices: Vec<Vertex> =
            positions.points.iter().map(|&at| Vertex { at, is_on_wall: false }).collect();
        for (index, side) in sides.iter().enumerate().filter(|(_, side)| side.is_wall) {
            vertices[side.origin as usize].is_on_wall = true;
            vertices[sides[following(index as u32) as usize].origin as usize].is_on_wall = true;
        }
        let sides_from = Groups::new(vertices.len(), sides.iter().map(|side| side.origin));
        let places_at = Groups::new(vertices.len(), vertex_of_place.iter().copied());
        let vertex_of_wall = wall_ends.into_iter().step_by(2).collect();
        (!sides.is_empty()).then_some(Triangulation {
            scale,
            vertices,
            sides,
            sides_from,
            places_at,
            vertex_of_place,
            vertex_of_wall,
            has_all_walls,
        })
    }

    /// What is seen from a place, without the directions that `skips`
    /// rules out: it is told two limits, right and left, and whether nothing between them matters.
    pub(super) fn seen_from_place(
        &self,
        place: usize,
        skips: impl Fn(Vector, Vector) -> bool,
    ) -> Sight {
        let vertex = self.vertex_of_place[place];
        self.seen(self.vertices[vertex as usize].at, &self.around_vertex(vertex), skips)
    }

    /// The places seen from a point, in ascending order, found by walking there from a wall. `None`
    /// beyond the rim.
    pub(super) fn seen_from(&self, point: Point, wall: usize) -> Option<Vec<Seen>> {
        let point = scaled(point, self.scale);
        let start = self.around(point, self.vertex_of_wall[wall])?;
        Some(self.seen(point, &start, |_, _| false).places)
    }

    fn seen(&self, from: Point, start: &Start, skips: impl Fn(Vector, Vector) -> bool) -> Sight {
        let mut tips: Vec<Point> = Vec::with_capacity(MOSTLY);
        let mut seen = Vec::with_capacity(MOSTLY);
        let must_be_tested = start.touches_wall || !self.has_all_walls;
        let mut see = |vertex: u32, is_inside: bool| {
            let may_touch =
                must_be_tested || !is_inside || self.vertices[vertex as usize].is_on_wall;
            let places = self.places_at.of(vertex).iter();
            seen.extend(places.map(|&place| Seen { place: place as usize, may_touch }));
        };
        start.vertices.iter().for_each(|&vertex| see(vertex, true));
        let look_over = |side: u32, left: Point, right: Point| {
            let Side { twin, is_wall, .. } = self.sides[side as usize];
            let beyond = twin.filter(|_| !is_wall && !skips(right - from, left - from))?;
            Some(Cone { side: beyond, left, right })
        };
        let mut cones: Vec<Cone> = Vec::with_capacity(MOSTLY);
        let sides = start.sides.iter();
        cones.extend(sides.filter_map(|&at| look_over(at, self.end(at), self.origin(at))));
        while let Some(Cone { side: entered, left, right }) = cones.pop() {
            // Seen from where sight comes from, the side that it enters over runs from the left to
            // the right, and the tip of the triangle lies behind.
            let (right_side, left_side) = (following(entered), preceding(entered));
            let tip = self.origin(left_side);
            tips.push(tip);
            let (of_left, of_right) = (side(from, left, tip), side(from, right, tip));
            if of_left <= 0.0 && of_right >= 0.0 {
                see(self.sides[left_side as usize].origin, of_left < 0.0 && of_right > 0.0);
            }
            if of_left < 0.0 {
                let limit = if of_right > 0.0 { tip } else { right };
                cones.extend(look_over(left_side, left, limit));
            }
            if of_right > 0.0 {
                let limit = if of_left < 0.0 { tip } else { left };
                cones.extend(look_over(right_side, limit, right));
            }
        }
        // A place at the limit of two cones is seen twice.
        seen.sort_unstable();
        seen.dedup_by_key(|seen| seen.place);
        let around = start.vertices.iter().map(|&vertex| self.vertices[vertex as usize].at);
        let around = Bounds::around(around.chain(tips).map(|at| at / self.scale));
        Sight { places: seen, around }
    }

    fn around_vertex(&self, vertex: u32) -> Start {
        let outgoing = self.sides_from.of(vertex);
        let neighbours = outgoing.iter().flat_map(|&side| {
            [following(side), preceding(side)].map(|side| self.sides[side as usize].origin)
        });
        Start {
            vertices: neighbours.chain([vertex]).collect(),
            sides: outgoing.iter().map(|&side| following(side)).collect(),
            touches_wall: self.vertices[vertex as usize].is_on_wall,
        }
    }

    /// What sight from a point begins with; `None` beyond the rim.
    fn around(&self, point: Point, near: u32) -> Option<Start> {
        let triangle = self.triangle_around(point, near)?;
        let sides = [triangle, following(triangle), preceding(triangle)];
        if let Some(&corner) = sides.iter().find(|&&side| self.origin(side) == point) {
            return Some(self.around_vertex(self.sides[corner as usize].origin));
        }
        let is_on = |&&at: &&u32| side(self.origin(at), self.end(at), point) == 0.0;
        let Some(&on) = sides.iter().find(is_on) else {
            let vertices = sides.map(|side| self.sides[side as usize].origin).to_vec();
            return Some(Start { vertices, sides: sides.to_vec(), touches_wall: false });
        };
        // On a side: the triangles on both sides of it are around the point.
        let around = [Some(on), self.sides[on as usize].twin];
        let sides: Vec<u32> =
            around.into_iter().flatten().flat_map(|at| [following(at), preceding(at)]).collect();
        Some(Start {
            vertices: sides.iter().map(|&side| self.sides[side as usize].origin).collect(),
            sides,
            touches_wall: self.sides[on as usize].is_wall,
        })
    }

    /// A side of a triangle that the point lies in, found by walking straight there from a vertex.
    fn triangle_around(&self, point: Point, near: u32) -> Option<u32> {
        let start = self.vertices[near as usize].at;
        let lies_beyond = |at: u32| side(self.origin(at), self.end(at), point) < 0.0;
        // The triangle at the vertex that the way begins in.
        let towards = |&&out: &&u32| !lies_beyond(out) && !lies_beyond(preceding(out));
        let out = *self.sides_from.of(near).iter().find(towards)?;
        let mut ahead = following(out);
        // A straight way enters each triangle once.
        for _ in 0..self.sides.len() {
            if !lies_beyond(ahead) {
                return Some(ahead);
            }
            let entered = self.sides[ahead as usize].twin?;
            let (right_side, left_side) = (following(entered), preceding(entered));
            // Past a tip on the way itself, it goes on over either side that the point is beyond.
            let of_tip = side(start, point, self.origin(left_side));
            let turns_right = of_tip > 0.0 || of_tip == 0.0 && lies_beyond(right_side);
            ahead = if turns_right { right_side } else { left_side };
        }
        None
    }

    fn origin(&self, side: u32) -> Point {
        self.vertices[self.sides[side as usize].origin as usize].at
    }

    fn end(&self, side: u32) -> Point {
        self.origin(following(side))
    }
}

/// The side of the same triangle that follows a side.
fn following(side: u32) -> u32 {
    if side % 3 == 2 { side - 2 } else { side + 1 }
}

/// The side of the same triangle before a side.
fn preceding(side: u32) -> u32 {
    if side.is_multiple_of(3) { side + 2 } else { side - 1 }
}

fn sides_of(delaunay: &ConstrainedDelaunayTriangulation<Point2<f64>>) -> Vec<Side> {
    let mut sides = Vec::with_capacity(3 * delaunay.num_inner_faces());
    // Where each directed edge of the library is found among the sides.
    let mut side_of_edge = vec![None; delaunay.num_directed_edges()];
    for face in delaunay.inner_faces() {
        let first = face.adjacent_edge();
        for edge in [first, first.next(), first.prev()] {
            side_of_edge[edge.fix().index()] = Some(sides.len() as u32);
            let origin = edge.from().fix().index() as u32;
            sides.push((edge.rev().fix().index(), origin, edge.is_constraint_edge()));
        }
    }
    let side = |(reverse, origin, is_wall)| Side { origin, twin: side_of_edge[reverse], is_wall };
    sides.into_iter().map(side).collect()
}

/// The power of two that takes the largest coordinate to about 1.
fn scale_for(largest: f64) -> f64 {
    if largest > 0.0 { (-largest.log2().round()).clamp(-1000.0, 1000.0).exp2() } else { 1.0 }
}

fn scaled(point: Point, scale: f64) -> Point {
    let tidy = |coordinate: f64| {
        let scaled = coordinate * scale;
        if scaled.abs() < LEAST_COORDINATE { 0.0 } else { scaled }
    };
    point.map(tidy)
}

/// Distinct positions, each of which is a vertex.
#[derive(Default)]
struct Positions {
    points: Vec<Point>,
    known: BTreeMap<[u64; 2], u32>,
}

impl Positions {
    fn vertex_at(&mut self, point: Point) -> u32 {
        // Without a sign on zero, equal numbers have equal bits.
        let key = [point.x + 0.0, point.y + 0.0].map(f64::to_bits);
        *self.known.entry(key).or_insert_with(|| {
            self.points.push(point);
            self.points.len() as u32 - 1
        })
    }
}

/// Items in groups: those of each group in ascending order.
#[derive(Debug, Clone)]
struct Groups {
    begins: Vec<u32>,
    items: Vec<u32>,
}

impl Groups {
    /// The items 0, 1, …, whose groups are listed.
    fn new(groups: usize, group_of: impl Iterator<Item = u32> + Clone) -> Groups {
        let mut begins = vec![0; groups + 1];
        group_of.clone().for_each(|group| begins[group as usize + 1] += 1);
        (0..groups).for_each(|group| begins[group + 1] += begins[group]);
        let mut next = begins.clone();
        let mut items = vec![0; begins[groups] as usize];
        for (item, group) in group_of.enumerate() {
            items[next[group as usize] as usize] = item as u32;
            next[group as usize] += 1;
        }
        Groups { begins, items }
    }

    fn of(&self, group: u32) -> &[u32] {
        let [from, to] = [group, group + 1].map(|at| self.begins[at as usize] as usize);
        &self.items[from..to]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Coordinates on a coarse grid, so that much lies in line, or anywhere.
    fn point() -> impl Strategy<Value = Point> {
        prop_oneof![
            3 => (0..12_i32, 0..12_i32).prop_map(|(x, y)| Point::new(f64::from(x), f64::from(y))),
            1 => (0.0..11.0_f64, 0.0..11.0_f64).prop_map(|(x, y)| Point::new(x, y)),
        ]
    }

    /// Walls that meet at most at common ends, and one all around.
    fn walls() -> impl Strategy<Value = Vec<Segment>> {
        prop::collection::vec((point(), -3..=3_i32, -3..=3_i32), 0..40).prop_map(|pieces| {
            let corners = [(-4.0, -4.0), (15.0, -4.0), (15.0, 15.0), (-4.0, 15.0)];
            let corners = corners.map(|(x, y)| Point::new(x, y));
            let mut walls: Vec<Segment> =
                (0..4).map(|at| Segment::new(corners[at], corners[(at + 1) % 4])).collect();
            for (from, x, y) in pieces {
                let wall = Segment::new(from, from + Vector::new(f64::from(x), f64::from(y)));
                if wall.length() > 0.0 && !walls.iter().any(|other| other.meets(&wall)) {
                    walls.push(wall);
                }
            }
            walls
        })
    }

    fn check(walls: &[Segment], places: &[Point], from: Point, seen: &[Seen]) {
        for (index, &place) in places.iter().enumerate() {
            let path = Segment::new(from, place);
            let is_free = !walls.iter().any(|wall| wall.meets(&path));
            let found = seen.iter().find(|seen| seen.place == index);
            assert!(found.is_some() || !is_free, "{place} is seen from {from}");
            assert!(
                found.is_none_or(|seen| seen.may_touch || is_free),
                "{place} is not, from {from}"
            );
        }
    }

    proptest! {
        #[test]
        fn what_nothing_hides_is_seen(
            walls in walls(), places in prop::collection::vec(point(), 1..30), from in point(),
            wall in 0..40_usize, exponent in prop::sample::select(vec![-90, -9, 0, 9, 90]),
        ) {
            // A power of two keeps what lies in line.
            let scale = f64::from(exponent).exp2();
            let walls: Vec<Segment> =
                walls.iter().map(|w| Segment::new(w.from * scale, w.to * scale)).collect();
            let places: Vec<Point> = places.iter().map(|place| place * scale).collect();
            let triangulation = Triangulation::new(&walls, &places).unwrap();
            for from in [from * scale, places[0]] {
                let seen = triangulation.seen_from(from, wall % walls.len()).unwrap();
                check(&walls, &places, from, &seen);
            }
            for (index, &from) in places.iter().enumerate() {
                let sight = triangulation.seen_from_place(index, |_, _| false);
                check(&walls, &places, from, &sight.places);
                let is_around = |at: Point| sight.around.is_some_and(|around| around.holds(at));
                for seen in sight.places {
                    prop_assert!(is_around(places[seen.place]));
                }
            }
        }
    }

    #[test]
    fn walls_that_cross_leave_everything_in_doubt() {
        let square = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        let [a, b, c, d] = square.map(|(x, y)| Point::new(x, y));
        let walls = [(a, b), (b, c), (c, d), (d, a), (a, c), (b, d)];
        let walls = walls.map(|(from, to)| Segment::new(from, to));
        let places = [Point::new(0.5, 1.0), Point::new(1.5, 1.0)];
        let triangulation = Triangulation::new(&walls, &places).unwrap();
        let seen = triangulation.seen_from_place(0, |_, _| false);
        assert!(seen.places.iter().all(|seen| seen.may_touch));
    }
}
