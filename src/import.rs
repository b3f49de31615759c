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

use crate::automaton::network::scenario::WorkspaceOutline;
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
    plan.map_err(malformed)
}
