//! Import of floor plans: maps of other programs as scenarios.
//!
//! | file | read as |
//! | --- | --- |
//! | `*.yaml` with its image | a map of the ROS map server: cells that are free |
//! | `*.map` | a MovingAI benchmark map: cells that can be passed |
//! | `*.geojson`, `*.json` | polygons are floor; those with the property `"kind": "wall"` are taken out of it |
//! | `*.svg` | closed shapes, filled by the even-odd rule: the outermost bounds the floor |
//!
//! A map of cells is traced and simplified within a tolerance of whole cells. **No robot gets
//! through a wall by it**: first the floor is narrowed by the tolerance, then its outline may
//! deviate by as much, so that it lies in what was free from the beginning ([`cells`]). Other
//! plans keep their corners; curves become chords within the tolerance.
//!
//! Of floors that fall into pieces the largest one is taken. [`Plan::notes`] say what was left
//! out, and [`gaps`] where passages are too narrow for robots.

pub mod cells;
pub mod gaps;
mod geojson;
mod grid;
mod moving_ai;
mod outline;
mod ros;
mod skeleton;
mod svg;

pub use skeleton::{Choices, SkeletonError, skeleton, text};

use crate::automaton::network::scenario::{LARGEST_COORDINATE, WorkspaceOutline};
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// How a map is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// How far the outline may deviate, in the unit of the result; by default one cell of a grid,
    /// and a thousandth of the extent for curves.
    pub tolerance: Option<f64>,
    /// The length that a unit of the map has in the result; for GeoJSON in degrees, a metre.
    pub scale: f64,
    /// Whether coordinates of GeoJSON are lengths, and not degrees of longitude and latitude.
    pub planar: bool,
}

impl Default for Reading {
    fn default() -> Self {
        Self { tolerance: None, scale: 1.0, planar: false }
    }
}

/// A floor plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Boundary and holes.
    pub workspace: WorkspaceOutline,
    /// Places that the map names, if any: access points, robots, tasks.
    pub places: MapPlaces,
    /// What was simplified or left out, as sentences.
    pub notes: Vec<String>,
}

/// How many times its extent a floor may be away from the origin: farther out its corners are too coarse to be moved.
const FARTHEST_FLOOR: f64 = 1e9;

impl Plan {
    /// The plan as it is or, where its coordinates are larger than those of scenarios, such as the eastings and
    /// northings of a survey, moved to the origin by a whole number of units.
    fn near_the_origin(mut self) -> Self {
        let boundary = &self.workspace.boundary;
        let ([low, high], extent) = (bounds(boundary), extent(boundary));
        let farthest = low.into_iter().chain(high).map(f64::abs).fold(0.0, f64::max);
        let is_far = farthest > LARGEST_COORDINATE && farthest < FARTHEST_FLOOR * extent;
        if !is_far || extent >= LARGEST_COORDINATE {
            return self;
        }
        let origin = low.map(f64::floor);
        for [x, y] in self.points() {
            (*x, *y) = (*x - origin[0], *y - origin[1]);
        }
        let [x, y] = origin;
        self.notes.push(format!(
            "({x}, {y}) of the map is the origin of the scenario, whose coordinates are at most \
             {LARGEST_COORDINATE}"
        ));
        self
    }

    /// All its corners and places.
    fn points(&mut self) -> impl Iterator<Item = &mut [f64; 2]> {
        let WorkspaceOutline { boundary, holes } = &mut self.workspace;
        let MapPlaces { access_points, robots, tasks } = &mut self.places;
        let lists = [boundary, access_points, robots, tasks];
        lists.into_iter().chain(holes).flatten()
    }
}

/// Places that a map names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapPlaces {
    /// Where access points stand.
    pub access_points: Vec<[f64; 2]>,
    /// Where robots start.
    pub robots: Vec<[f64; 2]>,
    /// Where tasks are.
    pub tasks: Vec<[f64; 2]>,
}

/// Why a map cannot be read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ImportError {
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A kind of map that is not known.
    #[error(
        "{}: the ending says no kind of map; known are .yaml (ROS), .map (MovingAI), .geojson, \
         .json and .svg", .0.display()
    )]
    UnknownKind(PathBuf),
    /// The file is not what its ending says.
    #[error("{}: {problem}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the place.
        problem: String,
    },
}

/// The least and the greatest coordinates of a ring; 0 where it has no corner.
fn bounds(ring: &[[f64; 2]]) -> [[f64; 2]; 2] {
    [f64::min, f64::max].map(|better| {
        let corners = ring.iter().copied();
        corners.reduce(|a, b| [0, 1].map(|axis| better(a[axis], b[axis]))).unwrap_or_default()
    })
}

/// The larger side of the box around a ring.
fn extent(ring: &[[f64; 2]]) -> f64 {
    let [low, high] = bounds(ring);
    (high[0] - low[0]).max(high[1] - low[1])
}

/// A number of things in words.
fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// The ending of the name of a map, which says of which kind it is.
fn ending_of(path: &Path) -> String {
    path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase()
}

fn text_of(path: &Path) -> Result<String, ImportError> {
    fs::read_to_string(path).map_err(|source| ImportError::Unreadable { path: path.into(), source })
}

/// The files that a map consists of: itself and, where it names one, its image.
///
/// # Errors
/// When a map that may name an image cannot be read or names none.
pub fn files(path: &Path) -> Result<Vec<PathBuf>, ImportError> {
    let mut files = vec![path.to_owned()];
    if matches!(ending_of(path).as_str(), "yaml" | "yml") {
        files.push(ros::image_of(path, &text_of(path)?)?);
    }
    Ok(files)
}

/// Reads a map; the ending of its name says of which kind it is.
///
/// # Errors
/// When the file cannot be read, is of an unknown kind or malformed, or has no floor.
pub fn read(path: &Path, reading: &Reading) -> Result<Plan, ImportError> {
    let malformed = |problem| ImportError::Malformed { path: path.into(), problem };
    let text = || text_of(path);
    if !(reading.scale.is_finite() && reading.scale > 0.0) {
        return Err(malformed(format!("the scale is {}: it must be positive", reading.scale)));
    }
    let plan = match ending_of(path).as_str() {
        "yaml" | "yml" => ros::read(path, &text()?)?.trace(reading),
        "map" => moving_ai::read(&text()?).map_err(malformed)?.trace(reading),
        "geojson" | "json" => geojson::read(&text()?, reading),
        "svg" => svg::read(&text()?, reading),
        _ => return Err(ImportError::UnknownKind(path.into())),
    };
    Ok(plan.map_err(malformed)?.near_the_origin())
}

/// A finite number: infinite ones and those that are none can be written, too.
fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}
