//! Workspaces from maps as they are: polygons that touch, spikes, vertices listed twice.
//!
//! Drawn and recorded maps are often *weakly* simple: a hole touches the boundary at a vertex or
//! shares a wall with its neighbour, a line runs out and back, the first vertex is listed again as
//! the last. As sets of points they say clearly what is free: where a robot keeps its clearance from every
//! line that is drawn. So holes that touch are one obstacle, a line that runs out into the workspace and
//! back is a wall without thickness, and a piece that walls cut off stays a place where robots may be. Only a cut
//! that the boundary follows in both directions, to reach the outline of a hole, is no wall. What is left ambiguous (edges
//! that cross, holes that overlap) stays an error.

use std::fmt;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::segment::side;
use super::workspace::{NamedEdge, Polygon, contacts, crossings, edges_of};
use super::{Segment, Workspace, WorkspaceError};
use crate::Point;

/// By how much the area of the result may differ from that of the boundary less those of the holes,
/// as a fraction of the square of the extent: polygons that overlap by no more than this touch.
const AREA_TOLERANCE: f64 = 1e-9;

/// Something that [`Workspace::repaired`] has changed.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Repair {
    /// A vertex that is also the one before it is left out.
    RepeatedVertex {
        /// The polygon.
        polygon: Polygon,
        /// Index of the vertex in it, as it was given.
        vertex: usize,
        /// Where the vertex is.
        at: Point,
    },
    /// A spike that runs into a wall, or out of the workspace, and back is left out.
    Spike {
        /// The polygon.
        polygon: Polygon,
        /// Index of the vertex at its tip, as it was given.
        vertex: usize,
        /// The tip.
        tip: Point,
    },
    /// A spike that runs into the workspace and back, a line through it that joins two parts of a hole, or a
    /// hole without an area, is a wall without thickness.
    Wall {
        /// The polygon.
        polygon: Polygon,
        /// Index of the vertex at its tip, or where it ends, as it was given.
        vertex: usize,
        /// The wall.
        wall: Segment,
    },
    /// A polygon passes through a vertex more than once.
    Pinch {
        /// The polygon.
        polygon: Polygon,
        /// Index of the vertex in it, as it was given: the later one of two.
        vertex: usize,
        /// The vertex.
        at: Point,
    },
    /// Two edges touch: what lies on both sides of the contact is joined.
    Contact {
        /// One edge.
        first: NamedEdge,
        /// The other edge.
        second: NamedEdge,
    },
    /// The workspace falls into pieces between which no robot can move.
    PieceCutOff {
        /// A vertex of a piece that is not the largest.
        at: Point,
        /// Its area.
        area: f64,
    },
}

impl Repair {
    /// The polygon and the vertex of it, as they were given, where something was changed; of two, the later.
    pub fn place(&self) -> Option<(Polygon, usize)> {
        match *self {
            Repair::RepeatedVertex { polygon, vertex, .. }
            | Repair::Spike { polygon, vertex, .. }
            | Repair::Wall { polygon, vertex, .. }
            | Repair::Pinch { polygon, vertex, .. } => Some((polygon, vertex)),
            Repair::Contact { second, .. } => Some((second.polygon, second.index)),
            Repair::PieceCutOff { .. } => None,
        }
    }
}

impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Repair::RepeatedVertex { polygon, at, .. } => {
                write!(f, "a second vertex of {polygon} at ({}, {}) is left out", at.x, at.y)
            }
            Repair::Spike { polygon, tip, .. } => write!(
                f,
                "a spike of {polygon}, with its tip at ({}, {}), lies outside the workspace and is left out",
                tip.x, tip.y
            ),
            Repair::Wall { polygon, wall: Segment { from, to }, .. } => write!(
                f,
                "a line of {polygon} that runs there and back, ({}, {}) to ({}, {}), is a wall without \
                 thickness",
                from.x, from.y, to.x, to.y
            ),
            Repair::Pinch { polygon, at, .. } => {
                write!(f, "{polygon} touches itself at its vertex ({}, {})", at.x, at.y)
            }
            Repair::Contact { first, second } => {
                write!(f, "{first}, touches {second}: the two are joined")
            }
            Repair::PieceCutOff { at, .. } => write!(
                f,
                "a piece of the workspace, with a vertex at ({}, {}), is cut off from the largest piece: no \
                 robot can move between the two",
                at.x, at.y
            ),
        }
    }
}

impl Workspace {
    /// As [`Workspace::new`], but weakly simple polygons are repaired; also tells what was changed,
    /// nothing if the polygons are what `new` takes.
    ///
    /// Where polygons touch, all vertices are rounded to about 1e-15 of the extent. Vertices and edges are
    /// counted as they were given.
    ///
    /// # Errors
    ///
    /// As [`Workspace::new`], for polygons that cross or overlap, by more than a billionth of the
    /// square of the extent.
    ///
    /// ```
    /// use pleach_continuous::Point;
    /// use pleach_continuous::geometry::Workspace;
    ///
    /// let ring = |points: &[(f64, f64)]| points.iter().map(|&(x, y)| Point::new(x, y)).collect();
    /// let room = ring(&[(0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)]);
    /// let cupboard = ring(&[(1.0, 1.5), (2.0, 1.5), (2.0, 2.0), (1.0, 2.0)]);
    /// let (workspace, repairs) = Workspace::repaired(room, vec![cupboard])?;
    /// assert_eq!(workspace.boundary().len(), 8); // the cupboard is a part of the wall now
    /// assert_eq!(
    ///     repairs[0].to_string(),
    ///     "edge 2 of the boundary, (4, 2) to (0, 2), touches edge 1 of hole 0, (2, 1.5) to (2, 2): \
    ///      the two are joined"
    /// );
    /// # Ok::<(), pleach_continuous::geometry::WorkspaceError>(())
    /// ```
    pub fn repaired(
        boundary: Vec<Point>,
        holes: Vec<Vec<Point>>,
    ) -> Result<(Workspace, Vec<Repair>), WorkspaceError> {
        match Workspace::new(boundary.clone(), holes.clone()) {
            Ok(workspace) => return Ok((workspace, Vec::new())),
            Err(error) if error.is_about_numbers() => return Err(error),
            Err(_) => {}
        }
        let given: Vec<Vec<Point>> = std::iter::once(boundary).chain(holes).collect();
        let named = || given.iter().zip(Polygon::all());
        if let Some((vertices, polygon)) = named().find(|(vertices, _)| vertices.len() < 3) {
            return Err(WorkspaceError::TooFewVertices { polygon, count: vertices.len() });
        }
        let mut repairs = Vec::new();
        let mut spikes = Vec::new();
        let mut rings: Vec<Ring> = named()
            .map(|(vertices, polygon)| {
                Ring::without_spikes(polygon, vertices, &mut repairs, &mut spikes)
            })
            .collect();
        if rings[0].points.len() < 3 {
            return Err(WorkspaceError::Flat { polygon: Polygon::Boundary });
        }
        // A hole that was nothing but a line is a wall.
        rings.retain(|ring| ring.points.len() >= 3);
        let workspace = joined(&rings, &mut repairs)?;
        let encloses = |polygon| rings.iter().any(|ring| ring.polygon == polygon);
        let walls = within(&workspace, &spikes, encloses, &mut repairs)?;
        Ok((workspace.with_walls(walls.into_iter()), repairs))
    }
}

/// A polygon, and which of the vertices that were given are left of it.
struct Ring {
    polygon: Polygon,
    vertices: Vec<usize>,
    points: Vec<Point>,
}

/// A line that a polygon runs there and back.
struct Spike {
    polygon: Polygon,
    /// The vertex at its tip.
    vertex: usize,
    /// From the polygon to the tip.
    line: Segment,
}

impl Ring {
    /// The ring without vertices that repeat the one before, and without spikes.
    fn without_spikes(
        polygon: Polygon,
        points: &[Point],
        repairs: &mut Vec<Repair>,
        spikes: &mut Vec<Spike>,
    ) -> Ring {
        let mut ring =
            Ring { polygon, vertices: (0..points.len()).collect(), points: points.to_vec() };
        // How many vertices in a row need no repair: all of them at the end.
        let (mut at, mut settled) = (0, 0);
        while settled < ring.points.len() && ring.points.len() >= 2 {
            let count = ring.points.len();
            let (before, here, after) = (
                ring.points[(at + count - 1) % count],
                ring.points[at],
                ring.points[(at + 1) % count],
            );
            let folds =
                side(before, here, after) == 0.0 && (before - here).dot(&(after - here)) > 0.0;
            let vertex = ring.vertices[at];
            if here == after {
                repairs.push(Repair::RepeatedVertex { polygon, vertex, at: here });
            } else if folds {
                let nearer = (after - here).norm() < (before - here).norm();
                let foot = if nearer { after } else { before };
                Spike { polygon, vertex, line: Segment::new(foot, here) }.join(spikes);
            } else {
                at = (at + 1) % count;
                settled += 1;
                continue;
            }
            settled = 0;
            ring.remove(at);
            if folds && before == after {
                // The way there and back ends at the vertex where it began.
                ring.remove(at % ring.points.len());
            }
            // What was before it may now be the tip of a shorter spike.
            at = at.saturating_sub(2);
        }
        ring
    }

    fn remove(&mut self, at: usize) {
        self.vertices.remove(at);
        self.points.remove(at);
    }
}

impl Spike {
    /// Adds it to those found, or to the last one if the two are one line.
    fn join(self, spikes: &mut Vec<Spike>) {
        let Segment { from, to } = self.line;
        match spikes.last_mut().filter(|last| last.polygon == self.polygon) {
            Some(Spike { line, .. })
                if line.from == to
                    && side(from, to, line.to) == 0.0
                    && (line.to - to).dot(&(to - from)) > 0.0 =>
            {
                line.from = from;
            }
            Some(Spike { line, .. })
                if line.from == from
                    && side(line.to, from, to) == 0.0
                    && (line.to - from).dot(&(to - from)) < 0.0 =>
            {
                line.from = to;
            }
            _ => spikes.push(self),
        }
    }
}

/// The workspace of polygons that may touch.
fn joined(rings: &[Ring], repairs: &mut Vec<Repair>) -> Result<Workspace, WorkspaceError> {
    let polygons: Vec<Vec<Point>> = rings.iter().map(|ring| ring.points.clone()).collect();
    let name = |polygon: Polygon, vertex: usize| {
        let ring = &rings[match polygon {
            Polygon::Boundary => 0,
            Polygon::Hole(hole) => hole + 1,
        }];
        (ring.polygon, ring.vertices[vertex])
    };
    let pinch = match Workspace::new(polygons[0].clone(), polygons[1..].to_vec()) {
        Ok(workspace) => return Ok(workspace),
        Err(error) if !error.is_about_contact() => return Err(error.renamed(name)),
        Err(error) => error,
    };
    let Some((workspace, cut_off)) = without_holes(&polygons) else {
        let crossing = crossings(&polygons).next();
        let crossing = crossing.map(|(first, second)| WorkspaceError::Crossing { first, second });
        let overlap = || {
            let (first, second) = contacts(&polygons).next()?;
            Some(WorkspaceError::Overlap { first, second })
        };
        return Err(crossing.or_else(overlap).unwrap_or(pinch).renamed(name));
    };
    if let WorkspaceError::RepeatedVertex { polygon, second, at, .. } = pinch {
        let (polygon, vertex) = name(polygon, second);
        repairs.push(Repair::Pinch { polygon, vertex, at });
    }
    repairs.extend(contacts(&polygons).map(|(first, second)| Repair::Contact {
        first: first.renamed(name),
        second: second.renamed(name),
    }));
    repairs.extend(cut_off);
    let bridges = bridges(&workspace, rings, repairs);
    Ok(workspace.with_walls(bridges.into_iter()))
}

/// The lines that join two parts of a hole, with the workspace on both sides: each is drawn in both directions, has no
/// area, and is a wall. Where the boundary follows such a line to reach the outline of a hole, it is none.
fn bridges(workspace: &Workspace, rings: &[Ring], repairs: &mut Vec<Repair>) -> Vec<Segment> {
    let mut walls: Vec<Segment> = Vec::new();
    for ring in rings.iter().filter(|ring| ring.polygon != Polygon::Boundary) {
        for (at, wall) in edges_of(&ring.points).enumerate() {
            let is_known = |known: &Segment| (known.from, known.to) == (wall.to, wall.from);
            if workspace.holds_part_of(&wall) && !walls.iter().any(is_known) {
                let vertex = ring.vertices[(at + 1) % ring.vertices.len()];
                repairs.push(Repair::Wall { polygon: ring.polygon, vertex, wall });
                walls.push(wall);
            }
        }
    }
    walls
}

/// The boundary, which comes first, without the holes, as sets of points, and what of it is cut off; `None`
/// if polygons do more than touch.
fn without_holes(polygons: &[Vec<Point>]) -> Option<(Workspace, Vec<Repair>)> {
    let mut areas = polygons.iter().map(|ring| signed_area(ring).abs());
    let expected = areas.next()? - areas.sum::<f64>();
    let coordinates = |ring: &Vec<Point>| ring.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
    let whole = vec![coordinates(&polygons[0])];
    let removed: Vec<_> = polygons[1..].iter().map(coordinates).collect();
    let rest = whole.overlay_as::<i64>(&removed, OverlayRule::Difference, FillRule::NonZero);
    let points = |ring: &Vec<[f64; 2]>| ring.iter().map(|&[x, y]| Point::new(x, y)).collect();
    let mut pieces: Vec<(f64, Vec<Vec<Point>>)> = rest
        .iter()
        .map(|piece| piece.iter().map(points).collect::<Vec<Vec<Point>>>())
        .map(|rings| (rings.iter().map(|ring| signed_area(ring)).sum(), rings))
        .collect();
    let found: f64 = pieces.iter().map(|(area, _)| area).sum();
    pieces.sort_by(|one, other| other.0.total_cmp(&one.0));
    let holes = pieces.first()?.1.len() - 1;
    let cut_off = (pieces[1..].iter())
        .map(|(area, rings)| Repair::PieceCutOff { at: rings[0][0], area: *area })
        .collect();
    let rings = pieces.into_iter().flat_map(|(_, rings)| rings).collect();
    let workspace = Workspace::of_rings(rings, holes);
    let is_exact = (found - expected).abs() <= AREA_TOLERANCE * workspace.extent().powi(2);
    is_exact.then_some((workspace, cut_off))
}

/// The spikes that are walls: those that run into the workspace. A hole that encloses nothing, since it is but
/// a line, must be one.
fn within(
    workspace: &Workspace,
    spikes: &[Spike],
    encloses: impl Fn(Polygon) -> bool,
    repairs: &mut Vec<Repair>,
) -> Result<Vec<Segment>, WorkspaceError> {
    let mut walls = Vec::new();
    for &Spike { polygon, vertex, line } in spikes {
        match polygon {
            _ if workspace.holds_part_of(&line) => {
                repairs.push(Repair::Wall { polygon, vertex, wall: line });
                walls.push(line);
            }
            Polygon::Hole(hole) if !encloses(polygon) && !workspace.is_near(&line, 0.0) => {
                return Err(WorkspaceError::HoleOutside { hole, at: line.to });
            }
            _ => repairs.push(Repair::Spike { polygon, vertex, tip: line.to }),
        }
    }
    Ok(walls)
}

/// The area of a ring, positive if it runs counter-clockwise.
fn signed_area(ring: &[Point]) -> f64 {
    let Some(&origin) = ring.first() else { return 0.0 };
    let triangles = ring.windows(2).map(|pair| (pair[0] - origin).perp(&(pair[1] - origin)));
    triangles.sum::<f64>() / 2.0
}
