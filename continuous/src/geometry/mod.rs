//! Free space, geodesics and cells: where robots may be, which way they go, and how far each may
//! go without meeting another (Sec. IV-A and IV-B, Appendix A).
//!
//! | chapter | what it holds |
//! | --- | --- |
//! | [`Workspace`] | the polygon with holes W that bounds the robots' world, validated |
//! | [`repair`] | workspaces from maps whose polygons touch |
//! | [`free_space`] | W_f, the points that keep a clearance ρ from ∂W (Algorithm 6, repaired) |
//! | [`Geodesic`] | shortest paths in W_f (Definition 4.1), and the way to a fixed destination |
//! | [`taut`] | paths pulled taut, each on its own side of the obstacles |
//! | [`reentry`] | robots slightly outside W_f, and how they come back |
//! | [`detour`] | shortest paths that also keep out of discs |
//! | [`cell`] | convex collision-free cells (Definition 4.2, (17) and (18)) |
//! | [`errors`] | cells of robots whose places and moves have errors |
//! | [`Neighbours`] | which points are within a distance of a place |
//! | [`Disc`], [`Capsule`], [`HalfPlane`] | shapes |
//!
//! ```
//! use pleach_continuous::Point;
//! use pleach_continuous::geometry::{FreeSpace, Workspace};
//!
//! // A room of 4 by 2 with a wall that leaves a door of width 0.5 at the top.
//! let room = [(0.0, 0.0), (1.9, 0.0), (1.9, 1.5), (2.1, 1.5), (2.1, 0.0), (4.0, 0.0), (4.0, 2.0), (0.0, 2.0)];
//! let workspace = Workspace::new(room.map(|(x, y)| Point::new(x, y)).to_vec(), vec![])?;
//! let free_space = FreeSpace::new(&workspace, 0.1)?;
//!
//! let (left, right) = (Point::new(1.0, 0.5), Point::new(3.0, 0.5));
//! assert!(!free_space.sees(left, right));
//! let path = free_space.geodesic(left, right).ok_or("no way through the door")?;
//! assert_eq!(path.waypoints.len(), 3); // two corners of the wall, then the goal
//! assert!((path.length - 3.120).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Two nested sets
//!
//! Free space is kept twice. Robots are sent to points of the *planning* set, which keeps ρ + τ
//! from ∂W; whether a straight move is allowed is asked of the *sight* set, which keeps ρ + τ/2.
//! The tolerance τ is a millionth of the extent of the workspace. A planning corner, around which
//! shortest paths bend, therefore lies strictly inside the sight set: rounding never decides
//! whether a robot that stands at a corner can leave it, and a robot that is 1e-12 outside the
//! planning set is not lost.

pub mod cell;
pub mod detour;
mod edge_tree;
mod erosion;
pub mod errors;
pub mod free_space;
mod geodesic;
mod neighbours;
mod ranked;
pub mod reentry;
pub mod repair;
mod search;
mod segment;
mod shape;
pub mod taut;
mod triangulation;
mod visibility;
mod workspace;

pub use cell::{convex_region, voronoi_half_planes};
pub use errors::Errors;
pub use free_space::{FreeSpace, FreeSpaceError};
pub use geodesic::{Destination, Geodesic};
pub use neighbours::Neighbours;
pub use repair::Repair;
pub use segment::Segment;
pub use shape::{Capsule, Disc, HalfPlane};
pub use workspace::{NamedEdge, Polygon, Workspace, WorkspaceError};
