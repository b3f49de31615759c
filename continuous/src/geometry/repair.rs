//! Workspaces from maps as they are: polygons that touch, spikes, vertices listed twice.
//!
//! Drawn and recorded maps are often *weakly* simple: a hole touches the boundary at a vertex or
//! shares a wall with its neighbour, a line runs out and back, the first vertex is listed again as
//! the last. As sets of points they say clearly what is free. What is left ambiguous (edges that
//! cross, holes that overlap) stays an error.

use std::fmt;

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::segment::side;
use super::workspace::{NamedEdge, Polygon, contacts};
use super::{Workspace, WorkspaceError};
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
        /// Where the vertex is.
        at: Point,
    },
    /// A spike, which runs out to a point and back, is left out.
    Spike {
        /// The polygon.
        polygon: Polygon,
        /// The tip.
        tip: Point,
    },
    /// A polygon passes through a vertex more than once.
    Pinch {
        /// The polygon.
        polygon: Polygon,
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
    /// The workspace falls into pieces between which no robot can move; only the largest is kept.
    PieceLeftOut {
        /// A vertex of the piece that is left out.
        at: Point,
        /// Its area.
        area: f64,
    },
}

impl fmt::Display for Repair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Repair::RepeatedVertex { polygon, at } => {
                write!(f, "a second vertex of {polygon} at ({}, {}) is left out", at.x, at.y)
            }
            Repair::Spike { polygon, tip } => {
                write!(
                    f,
                    "a spike of {polygon}, with its tip at ({}, {}), is left out",
                    tip.x, tip.y
                )
            }
            Repair::Pinch { polygon, at } => {
                write!(f, "{polygon} touches itself at its vertex ({}, {})", at.x, at.y)
            }
            Repair::Contact { first, second } => {
                write!(f, "{first}, touches {second}: the two are joined")
            }
            Repair::PieceLeftOut { at, area } => write!(
                f,
                "a piece of the workspace with an area of {area}, at ({}, {}), is cut off from the \
                 largest piece and left out",
                at.x, at.y
            ),
        }
    }
}

impl Workspace {
    /// As [`Workspace::new`], but weakly simple polygons are repaired; also tells what was changed,
    /// nothing if the polygons are what `new` takes.
    ///
    /// Where polygons touch, all vertices are rounded to about 1e-15 of the extent. Edges are
    /// counted after repeated vertices and spikes are left out.
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
        let error = match Workspace::new(boundary.clone(), holes.clone()) {
            Ok(workspace) => return Ok((workspace, Vec::new())),
            Err(error) if error.is_about_numbers() => return Err(error),
            Err(error) => error,
        };
        let mut repairs = Vec::new();
        let mut polygons: Vec<Vec<Point>> = std::iter::once(boundary)
            .chain(holes)
            .zip(Polygon::all())
            .map(|(vertices, polygon)| without_spikes(vertices, polygon, &mut repairs))
            .collect();
        // A hole that was nothing but a spike is gone; a boundary is none then.
        let boundary = polygons.remove(0);
        polygons.retain(|hole| hole.len() >= 3);
        match Workspace::new(boundary.clone(), polygons.clone()) {
            Ok(workspace) => Ok((workspace, repairs)),
            Err(error) if !error.is_about_contact() => Err(error),
            Err(pinch) => {
                let (workspace, contacts) = joined(boundary, polygons).ok_or(error)?;
                if let WorkspaceError::RepeatedVertex { polygon, at, .. } = pinch {
                    repairs.push(Repair::Pinch { polygon, at });
                }
                repairs.extend(contacts);
                Ok((workspace, repairs))
            }
        }
    }
}

/// The ring without vertices that repeat the one before, and without spikes.
fn without_spikes(mut ring: Vec<Point>, polygon: Polygon, repairs: &mut Vec<Repair>) -> Vec<Point> {
    let mut at = 0;
    while ring.len() >= 3 && at < ring.len() {
        let here = ring[at];
        let before = ring[(at + ring.len() - 1) % ring.len()];
        let after = ring[(at + 1) % ring.len()];
        let folds = side(before, here, after) == 0.0 && (before - here).dot(&(after - here)) > 0.0;
        if here == after {
            repairs.push(Repair::RepeatedVertex { polygon, at: here });
        } else if folds {
            repairs.push(Repair::Spike { polygon, tip: here });
        } else {
            at += 1;
            continue;
        }
        ring.remove(at);
        // What was before it may now be the tip of a shorter spike.
        at = at.saturating_sub(1);
    }
    ring
}

/// The boundary without the holes, as sets of points, with what was joined; `None` if they do more
/// than touch.
fn joined(boundary: Vec<Point>, holes: Vec<Vec<Point>>) -> Option<(Workspace, Vec<Repair>)> {
    let expected = signed_area(&boundary).abs()
        - holes.iter().map(|hole| signed_area(hole).abs()).sum::<f64>();
    let coordinates = |ring: &Vec<Point>| ring.iter().map(|p| [p.x, p.y]).collect::<Vec<_>>();
    let whole = vec![coordinates(&boundary)];
    let removed: Vec<_> = holes.iter().map(coordinates).collect();
    let rest = whole.overlay_as::<i64>(&removed, OverlayRule::Difference, FillRule::NonZero);
    let points = |ring: &Vec<[f64; 2]>| ring.iter().map(|&[x, y]| Point::new(x, y)).collect();
    let mut pieces: Vec<(f64, Vec<Vec<Point>>)> = rest
        .iter()
        .map(|piece| piece.iter().map(points).collect::<Vec<Vec<Point>>>())
        .map(|rings| (rings.iter().map(|ring| signed_area(ring)).sum(), rings))
        .collect();
    let found: f64 = pieces.iter().map(|(area, _)| area).sum();
    pieces.sort_by(|one, other| other.0.total_cmp(&one.0));
    let mut pieces = pieces.into_iter();
    let workspace = Workspace::of_rings(pieces.next()?.1);
    if (found - expected).abs() > AREA_TOLERANCE * workspace.extent().powi(2) {
        return None;
    }
    let polygons: Vec<Vec<Point>> = std::iter::once(boundary).chain(holes).collect();
    let contacts = contacts(&polygons).map(|(first, second)| Repair::Contact { first, second });
    let left_out = pieces.map(|(area, rings)| Repair::PieceLeftOut { at: rings[0][0], area });
    let repairs = contacts.chain(left_out).collect();
    Some((workspace, repairs))
}

/// The area of a ring, positive if it runs counter-clockwise.
fn signed_area(ring: &[Point]) -> f64 {
    let Some(&origin) = ring.first() else { return 0.0 };
    let triangles = ring.windows(2).map(|pair| (pair[0] - origin).perp(&(pair[1] - origin)));
    triangles.sum::<f64>() / 2.0
}
