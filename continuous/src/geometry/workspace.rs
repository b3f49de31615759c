//! The workspace W: a polygon with polygonal holes (Sec. II).

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::fmt;

use thiserror::Error;

use super::Segment;
use super::edge_tree::EdgeTree;
use super::segment::side;
use crate::Point;

/// Largest magnitude of a coordinate: beyond it the square of a length leaves the range of numbers.
pub(super) const COORDINATE_LIMIT: f64 = 1e100;

/// What is nearer to ∂W than this fraction of the extent, and than coordinates are rounded, lies on it.
const NEGLIGIBLE_CLEARANCE: f64 = 1e-13;

/// The bounded region W in which the robots live: a simple polygon without the interiors of its
/// holes. Its boundary ∂W has W on the left: the outer boundary runs counter-clockwise, holes run
/// clockwise, however they were given.
///
/// A [repaired](Workspace::repaired) map may have walls without thickness as well, and pieces that
/// walls cut off from each other.
#[derive(Debug, Clone)]
pub struct Workspace {
    /// The outer boundary, then its holes, then those of pieces that are cut off, then walls without
    /// thickness, there and back.
    polygons: Vec<Vec<Point>>,
    /// How many of them are holes.
    holes: usize,
    tree: EdgeTree,
    extent: f64,
}

/// One of the polygons that bound a workspace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Polygon {
    /// The outer boundary.
    Boundary,
    /// A hole, by its index in the list of holes, from 0.
    Hole(usize),
}

impl Polygon {
    /// The polygons of a workspace, in the order that they are listed in.
    pub(super) fn all() -> impl Iterator<Item = Polygon> {
        (0..).map(name_of)
    }
}

impl fmt::Display for Polygon {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Polygon::Boundary => write!(f, "the boundary"),
            Polygon::Hole(index) => write!(f, "hole {index}"),
        }
    }
}

/// An edge of a workspace as errors name it: edge `index` runs from vertex `index` of its polygon,
/// counted as it was given from 0, to the vertex after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedEdge {
    /// The polygon it belongs to.
    pub polygon: Polygon,
    /// Index of the edge, and of the vertex it starts at.
    pub index: usize,
    /// Where it runs.
    pub segment: Segment,
}

impl NamedEdge {
    /// The same edge, where `name` has the name of each vertex of each polygon.
    pub(super) fn renamed(self, name: impl Fn(Polygon, usize) -> (Polygon, usize)) -> NamedEdge {
        let (polygon, index) = name(self.polygon, self.index);
        NamedEdge { polygon, index, ..self }
    }
}

impl fmt::Display for NamedEdge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Segment { from, to } = self.segment;
        let NamedEdge { polygon, index, .. } = self;
        write!(f, "edge {index} of {polygon}, ({}, {}) to ({}, {})", from.x, from.y, to.x, to.y)
    }
}

/// Why polygons do not bound a workspace.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum WorkspaceError {
    /// Not enough vertices to enclose anything.
    #[error("{polygon} has {count} vertices; a polygon needs at least 3")]
    TooFewVertices {
        /// The polygon.
        polygon: Polygon,
        /// How many vertices it has.
        count: usize,
    },
    /// A coordinate that is not a number, or too large to compute with.
    #[error(
        "vertex {vertex} of {polygon} is ({}, {}); coordinates are finite numbers of magnitude at \
         most {COORDINATE_LIMIT:e}", at.x, at.y
    )]
    NotFinite {
        /// The polygon.
        polygon: Polygon,
        /// Index of the vertex in it.
        vertex: usize,
        /// The vertex.
        at: Point,
    },
    /// Two vertices of a polygon at the same place.
    #[error(
        "vertices {first} and {second} of {polygon} are both ({}, {}); list every vertex once, \
         without repeating the first one at the end", at.x, at.y
    )]
    RepeatedVertex {
        /// The polygon.
        polygon: Polygon,
        /// The earlier vertex.
        first: usize,
        /// The later vertex.
        second: usize,
        /// Where both are.
        at: Point,
    },
    /// All vertices on one line.
    #[error("the vertices of {polygon} lie on one line; a polygon encloses an area")]
    Flat {
        /// The polygon.
        polygon: Polygon,
    },
    /// Two edges of one polygon that cross, touch or overlap.
    #[error(
        "{first}, meets {second}; the edges of a polygon meet only where one follows the other"
    )]
    SelfIntersecting {
        /// The earlier edge.
        first: NamedEdge,
        /// The later edge.
        second: NamedEdge,
    },
    /// Edges of two polygons that cross, touch or overlap.
    #[error(
        "{first}, meets {second}; holes lie strictly inside the boundary and apart from each \
         other: join holes that touch, and draw a hole that touches the boundary as part of it"
    )]
    PolygonsMeet {
        /// The edge of one polygon.
        first: NamedEdge,
        /// The edge of the other.
        second: NamedEdge,
    },
    /// Polygons that do more than touch: their edges cross.
    #[error(
        "{first}, crosses {second}; polygons may touch themselves and each other, and none may cross: \
         move a vertex, or draw holes that overlap as one"
    )]
    Crossing {
        /// The earlier edge.
        first: NamedEdge,
        /// The later edge.
        second: NamedEdge,
    },
    /// Polygons that do more than touch: areas overlap, though no edges cross.
    #[error(
        "{first}, touches {second}, and beyond it the two overlap; polygons may touch, but no part of \
         a hole may lie in another hole or outside the boundary: draw holes that overlap as one"
    )]
    Overlap {
        /// The earlier edge.
        first: NamedEdge,
        /// The later edge.
        second: NamedEdge,
    },
    /// A hole outside the boundary.
    #[error("hole {hole}, with a vertex at ({}, {}), lies outside the boundary; remove it", at.x, at.y)]
    HoleOutside {
        /// Index of the hole.
        hole: usize,
        /// Its first vertex.
        at: Point,
    },
    /// A hole inside another one.
    #[error("hole {inner} lies inside hole {outer}; remove it")]
    NestedHoles {
        /// Index of the hole inside.
        inner: usize,
        /// Index of the hole around it.
        outer: usize,
    },
}

impl WorkspaceError {
    /// Whether coordinates are none to compute with.
    pub(super) fn is_about_numbers(&self) -> bool {
        matches!(self, WorkspaceError::NotFinite { .. })
    }

    /// The same of polygons and vertices that are called otherwise: `name` has the name of each vertex of
    /// each polygon.
    pub(super) fn renamed(
        self,
        name: impl Fn(Polygon, usize) -> (Polygon, usize),
    ) -> WorkspaceError {
        let edge = |edge: NamedEdge| edge.renamed(&name);
        let hole = |hole: usize| match name(Polygon::Hole(hole), 0).0 {
            Polygon::Hole(hole) => hole,
            Polygon::Boundary => hole,
        };
        match self {
            WorkspaceError::Crossing { first, second } => {
                WorkspaceError::Crossing { first: edge(first), second: edge(second) }
            }
            WorkspaceError::Overlap { first, second } => {
                WorkspaceError::Overlap { first: edge(first), second: edge(second) }
            }
            WorkspaceError::HoleOutside { hole: outside, at } => {
                WorkspaceError::HoleOutside { hole: hole(outside), at }
            }
            WorkspaceError::NestedHoles { inner, outer } => {
                WorkspaceError::NestedHoles { inner: hole(inner), outer: hole(outer) }
            }
            other => other,
        }
    }

    /// Whether polygons meet themselves or each other where simple ones do not.
    pub(super) fn is_about_contact(&self) -> bool {
        use WorkspaceError::{PolygonsMeet, RepeatedVertex, SelfIntersecting};
        matches!(self, RepeatedVertex { .. } | SelfIntersecting { .. } | PolygonsMeet { .. })
    }
}

impl Workspace {
    /// The workspace within `boundary` and outside every one of `holes`. Vertices are listed in
    /// order, clockwise or counter-clockwise; vertices on a straight line with their neighbours
    /// are welcome.
    ///
    /// # Errors
    ///
    /// Unless every polygon is simple and encloses an area, and the holes lie strictly inside the
    /// boundary and apart from each other. Decided exactly, without tolerances.
    /// [`Workspace::repaired`] also takes polygons that touch.
    pub fn new(boundary: Vec<Point>, holes: Vec<Vec<Point>>) -> Result<Workspace, WorkspaceError> {
        let mut polygons = vec![boundary];
        polygons.extend(holes);
        for (index, vertices) in polygons.iter().enumerate() {
            check_vertices(name_of(index), vertices)?;
        }
        check_edges(&polygons)?;
        check_nesting(&polygons)?;
        for (index, vertices) in polygons.iter_mut().enumerate() {
            if is_counter_clockwise(vertices) != (index == 0) {
                vertices.reverse();
            }
        }
        let holes = polygons.len() - 1;
        Ok(Workspace::of_rings(polygons, holes))
    }

    /// The workspace that rings bound with W on their left: the outer one, then the given number of holes, then what else
    /// belongs to ∂W.
    pub(super) fn of_rings(polygons: Vec<Vec<Point>>, holes: usize) -> Workspace {
        let tree = EdgeTree::new(polygons.iter().flat_map(|vertices| edges_of(vertices)));
        let extent = extent_of(&polygons);
        Workspace { polygons, holes, tree, extent }
    }

    /// The same with walls without thickness.
    pub(super) fn with_walls(mut self, walls: impl Iterator<Item = Segment>) -> Workspace {
        self.polygons.extend(walls.map(|wall| vec![wall.from, wall.to]));
        Workspace::of_rings(self.polygons, self.holes)
    }

    /// Vertices of the outer boundary, counter-clockwise; of several pieces, that of the largest.
    pub fn boundary(&self) -> &[Point] {
        &self.polygons[0]
    }

    /// Vertices of the holes, each clockwise.
    pub fn holes(&self) -> &[Vec<Point>] {
        &self.polygons[1..=self.holes]
    }

    /// The outer boundary, the holes, and what else there is in a repaired map: all of ∂W, with W on the
    /// left. A wall without thickness has two vertices.
    pub fn polygons(&self) -> &[Vec<Point>] {
        &self.polygons
    }

    /// The edges of ∂W, with W on the left.
    pub fn edges(&self) -> impl Iterator<Item = Segment> {
        self.polygons.iter().flat_map(|vertices| edges_of(vertices))
    }

    /// Whether `point` lies in W. Exact; for points on ∂W either answer may come.
    pub fn contains(&self, point: Point) -> bool {
        self.tree.encloses(point)
    }

    /// Distance from `point` to ∂W, negative outside W.
    pub fn clearance(&self, point: Point) -> f64 {
        let distance = self.tree.distance(point);
        if self.contains(point) { distance } else { -distance }
    }

    /// Distance from the segment between two points to ∂W; 0 or less if it leaves W.
    pub fn segment_clearance(&self, from: Point, to: Point) -> f64 {
        let path = Segment::new(from, to);
        if self.contains(from) && !self.tree.is_crossed_by(&path) {
            self.tree.distance_to_segment(&path)
        } else {
            self.clearance(from).min(self.clearance(to)).min(0.0)
        }
    }

    /// Whether a part of a segment lies in W, and not on ∂W alone.
    pub(super) fn holds_part_of(&self, path: &Segment) -> bool {
        let mut shares = vec![0.0, 1.0];
        let overlapping = self.tree.overlapping(path);
        shares.extend(overlapping.into_iter().flat_map(|(_, edge)| edge.shares_on(path)));
        shares.sort_by(f64::total_cmp);
        // Between two places where the segment meets ∂W, all of it lies in W, outside, or on ∂W.
        let mut middles = shares.windows(2).map(|part| path.at((part[0] + part[1]) / 2.0));
        let magnitude = path.from.coords.amax().max(path.to.coords.amax());
        let least = NEGLIGIBLE_CLEARANCE * self.extent + 16.0 * f64::EPSILON * magnitude;
        middles.any(|middle| self.clearance(middle) > least)
    }

    /// Whether a segment meets ∂W or comes closer to it than `distance`.
    pub(super) fn is_near(&self, path: &Segment, distance: f64) -> bool {
        self.tree.is_near(path, distance)
    }

    /// Visits the edges of ∂W with a point within `radius` of `center`, each with its number in
    /// [`edges`](Self::edges), ascending.
    pub fn for_each_edge_near(
        &self,
        center: Point,
        radius: f64,
        mut visit: impl FnMut(usize, &Segment),
    ) {
        self.tree.near(center, radius).into_iter().for_each(|(index, edge)| visit(index, edge));
    }

    /// The larger side of the box around W.
    pub fn extent(&self) -> f64 {
        self.extent
    }
}

/// The edges of a ring of vertices, the last one back to the first vertex.
pub(super) fn edges_of(vertices: &[Point]) -> impl Iterator<Item = Segment> {
    let following = vertices.iter().cycle().skip(1);
    vertices.iter().zip(following).map(|(from, to)| Segment::new(*from, *to))
}

fn name_of(index: usize) -> Polygon {
    index.checked_sub(1).map_or(Polygon::Boundary, Polygon::Hole)
}

fn check_vertices(polygon: Polygon, vertices: &[Point]) -> Result<(), WorkspaceError> {
    if vertices.len() < 3 {
        return Err(WorkspaceError::TooFewVertices { polygon, count: vertices.len() });
    }
    let too_large = |p: &Point| !p.iter().all(|coordinate| coordinate.abs() <= COORDINATE_LIMIT);
    if let Some(vertex) = vertices.iter().position(too_large) {
        return Err(WorkspaceError::NotFinite { polygon, vertex, at: vertices[vertex] });
    }
    let mut sorted: Vec<usize> = (0..vertices.len()).collect();
    sorted.sort_by(|&i, &j| {
        let (p, q) = (vertices[i], vertices[j]);
        in_order(p.x, q.x).then(in_order(p.y, q.y)).then(i.cmp(&j))
    });
    if let Some(pair) = sorted.windows(2).find(|pair| vertices[pair[0]] == vertices[pair[1]]) {
        let (first, second) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
        return Err(WorkspaceError::RepeatedVertex { polygon, first, second, at: vertices[first] });
    }
    if vertices.iter().all(|&vertex| side(vertices[0], vertices[1], vertex) == 0.0) {
        return Err(WorkspaceError::Flat { polygon });
    }
    Ok(())
}

fn check_edges(polygons: &[Vec<Point>]) -> Result<(), WorkspaceError> {
    match contacts(polygons).next() {
        None => Ok(()),
        Some((first, second)) if first.polygon == second.polygon => {
            Err(WorkspaceError::SelfIntersecting { first, second })
        }
        Some((first, second)) => Err(WorkspaceError::PolygonsMeet { first, second }),
    }
}

/// The edges that meet others where they must not, each with the first one after it that it meets.
pub(super) fn contacts(polygons: &[Vec<Point>]) -> impl Iterator<Item = (NamedEdge, NamedEdge)> {
    pairs(polygons, wrongly_meets)
}

/// The edges that cross others, each with the first one after it that it crosses.
pub(super) fn crossings(polygons: &[Vec<Point>]) -> impl Iterator<Item = (NamedEdge, NamedEdge)> {
    pairs(polygons, |first, second| first.crossing_point(second).is_some())
}

/// The edges that stand in a relation to others, each with the first one after it that it does so with.
fn pairs(
    polygons: &[Vec<Point>],
    are_related: impl Fn(&Segment, &Segment) -> bool,
) -> impl Iterator<Item = (NamedEdge, NamedEdge)> {
    let named: Vec<NamedEdge> = polygons
        .iter()
        .zip(Polygon::all())
        .flat_map(|(vertices, polygon)| {
            let edges = edges_of(vertices).enumerate();
            edges.map(move |(index, segment)| NamedEdge { polygon, index, segment })
        })
        .collect();
    let tree = EdgeTree::new(named.iter().map(|edge| edge.segment));
    (0..named.len()).filter_map(move |index| {
        let first = named[index];
        let is_met =
            |&(other, edge): &(usize, &Segment)| other > index && are_related(&first.segment, edge);
        let (met, _) = tree.overlapping(&first.segment).into_iter().find(is_met)?;
        Some((first, named[met]))
    })
}

/// Whether two edges have a point in common other than a vertex that joins one to the next.
/// Vertices of one polygon being distinct, edges that share an end follow each other; they then
/// overlap if the second folds back onto the first.
fn wrongly_meets(first: &Segment, second: &Segment) -> bool {
    let folds_back = |tip: Point, one: Point, other: Point| {
        side(one, tip, other) == 0.0 && (one - tip).dot(&(other - tip)) > 0.0
    };
    if first.to == second.from {
        folds_back(first.to, first.from, second.to)
    } else if second.to == first.from {
        folds_back(first.from, first.to, second.from)
    } else {
        first.meets(second)
    }
}

/// Where the holes lie, told by their first vertices: polygons that do not meet are apart or one
/// inside the other. A vertex lies inside those that a ray from it crosses an odd number of times.
fn check_nesting(polygons: &[Vec<Point>]) -> Result<(), WorkspaceError> {
    let edges = || polygons.iter().flat_map(|vertices| edges_of(vertices));
    let tree = EdgeTree::new(edges());
    let polygon_of_edge: Vec<usize> = (polygons.iter().enumerate())
        .flat_map(|(polygon, vertices)| std::iter::repeat_n(polygon, vertices.len()))
        .collect();
    for (hole, vertices) in polygons[1..].iter().enumerate() {
        let mut around = BTreeSet::new();
        tree.for_each_right_of(vertices[0], |edge| {
            let polygon = polygon_of_edge[edge];
            if !around.remove(&polygon) {
                around.insert(polygon);
            }
        });
        if !around.contains(&0) {
            return Err(WorkspaceError::HoleOutside { hole, at: vertices[0] });
        }
        if let Some(outer) = around.into_iter().find(|&polygon| polygon != 0 && polygon != hole + 1)
        {
            return Err(WorkspaceError::NestedHoles { inner: hole, outer: outer - 1 });
        }
    }
    Ok(())
}

/// Orientation of a simple polygon: the turn at its lowest, leftmost vertices tells. Exact.
fn is_counter_clockwise(vertices: &[Point]) -> bool {
    let count = vertices.len();
    let lowest = (0..count)
        .min_by(|&i, &j| {
            let (p, q) = (vertices[i], vertices[j]);
            in_order(p.y, q.y).then(in_order(p.x, q.x))
        })
        .unwrap_or(0);
    let before = vertices[(lowest + count - 1) % count];
    let after = vertices[(lowest + 1) % count];
    side(before, vertices[lowest], after) > 0.0
}

/// The order of two coordinates. Zero is the same number with either sign.
fn in_order(one: f64, other: f64) -> Ordering {
    (one + 0.0).total_cmp(&(other + 0.0))
}

fn extent_of(polygons: &[Vec<Point>]) -> f64 {
    let vertices = || polygons.iter().flatten();
    let low = vertices().fold(polygons[0][0], |low, vertex| low.inf(vertex));
    let high = vertices().fold(polygons[0][0], |high, vertex| high.sup(vertex));
    (high - low).max()
}
