//! Import of floor plans: maps of other programs as scenarios.
//!
//! | file | read as |
//! | --- | --- |
//! | `*.yaml` with its image | a map of the ROS map server: cells that are free |
//! | `*.png`, `*.pgm`, `*.bmp`, `*.jpg`, `*.tif` | an image alone, with the side of a pixel as the resolution |
//! | `*.map` | a MovingAI benchmark map: cells that can be passed |
//! | `*.geojson`, `*.json` | polygons, lines and points by their properties: floor, rooms, walls, doors, places |
//! | `*.osm` | nodes and ways of OpenStreetMap by their tags, as features of GeoJSON |
//! | `*.building.yaml` | a building of the traffic editor of Open-RMF: what its walls enclose, or its floors |
//! | `*.dxf` | a drawing: what the lines in the layers of walls enclose; with the feature `dxf` |
//! | `*.svg` | closed shapes, filled by the even-odd rule, without the lines that are not closed |
//!
//! **Nothing is lost without a word.** The [`Account`] says how much floor the map has, and how much of it the plan; a
//! loss above what is accepted is an error. Of floors that fall into pieces the largest one is taken. [`Plan::notes`]
//! say what was recognised and what was left out, and [`skeleton`] where passages are too narrow for robots.
//!
//! A map of cells is traced along their sides, and corners are taken out within a tolerance, such that the outline stays
//! in free cells, and what robots get through stays open. Other plans keep their corners; curves become chords within
//! the tolerance.

mod account;
mod building;
mod cells;
#[cfg(feature = "dxf")]
mod dxf;
mod features;
mod gaps;
mod geojson;
mod grid;
mod image;
mod lattice;
mod levels;
mod look;
mod moving_ai;
mod osm;
mod outline;
mod places;
mod projection;
mod radio;
mod ros;
mod skeleton;
mod smooth;
mod spots;
mod stroke;
mod survey;
mod svg;
mod text;

pub use account::Account;
pub use look::page;
pub use radio::Radio;
pub use skeleton::{Choices, SkeletonError, skeleton};
pub use spots::Spot;
pub use text::text;

use radio::default_clearance;

use crate::automaton::network::scenario::{LARGEST_COORDINATE, WorkspaceOutline};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// How a map is read. Lengths are in the unit of the result.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// How far the outline may deviate; by default one cell of a grid, as long as that takes at most a hundredth of the
    /// floor, and a thousandth of the extent for curves.
    pub tolerance: Option<f64>,
    /// The length that a unit of the map has in the result; for GeoJSON in degrees, a metre.
    pub scale: f64,
    /// Whether coordinates of GeoJSON are lengths in any case, and not degrees of longitude and latitude.
    pub planar: bool,
    /// The side of a pixel, for images alone.
    pub resolution: Option<f64>,
    /// The distance that robots keep from walls: what they get through stays open.
    pub clearance: Option<f64>,
    /// The largest share of the floor that may be lost, 0 to 1.
    pub accepted_loss: f64,
    /// The size, in cells, up to which a group of cells that are not free becomes floor if floor is all around it; by
    /// default 2 in images, and 0 in other maps.
    pub specks: Option<usize>,
    /// How wide walls drawn as lines are; by default 0.1, and as drawn in SVG.
    pub wall_width: Option<f64>,
    /// Which level of a building is read.
    pub level: Option<String>,
    /// Properties with values that make features walls.
    pub walls: Vec<(String, String)>,
    /// Properties with values that make features floor.
    pub floors: Vec<(String, String)>,
}

impl Default for Reading {
    fn default() -> Self {
        Self {
            tolerance: None,
            scale: 1.0,
            planar: false,
            resolution: None,
            clearance: None,
            accepted_loss: ACCEPTED_LOSS,
            specks: None,
            wall_width: None,
            level: None,
            walls: Vec::new(),
            floors: Vec::new(),
        }
    }
}

/// The share of the floor that may be lost unasked.
pub const ACCEPTED_LOSS: f64 = 0.02;

/// A floor plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Boundary and holes.
    pub workspace: WorkspaceOutline,
    /// Places that the map names, if any: access points, robots, tasks.
    pub places: MapPlaces,
    /// How much of the floor of the map this is.
    pub account: Account,
    /// The map as it is, if it consists of cells.
    pub picture: Option<Picture>,
    /// The map as it is, if it consists of lines; those around polygons end where they start.
    pub lines: Vec<Vec<[f64; 2]>>,
    /// The account, what was recognised, and what was simplified or left out, as sentences.
    pub notes: Vec<String>,
}

/// Cells as the map has them.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Cells in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// From 0 for black to 255 for white, in rows from the top.
    pub shades: Vec<u8>,
    /// Where the cells lie: (x, y), counted in cells from the top left, is at (a x + c y + e, b x + d y + f), with these
    /// six numbers in the order of the alphabet.
    pub placement: [f64; 6],
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
        if let Some(Picture { placement: [.., e, f], .. }) = &mut self.picture {
            (*e, *f) = (*e - x, *f - y);
        }
        self.notes.push(format!(
            "({x}, {y}) of the map is the origin of the scenario, whose coordinates are at most \
             {LARGEST_COORDINATE}"
        ));
        self
    }

    /// All its corners and places.
    fn points(&mut self) -> impl Iterator<Item = &mut [f64; 2]> {
        let WorkspaceOutline { boundary, holes } = &mut self.workspace;
        let MapPlaces { access_points, robots, tasks, named } = &mut self.places;
        let lists = [boundary, access_points, robots, tasks];
        let places = lists.into_iter().chain(holes).chain(&mut self.lines).flatten();
        places.chain(named.iter_mut().map(|(_, place)| place))
    }

    /// Where a spot is; none if the map has no point of its name.
    pub fn place(&self, spot: &Spot) -> Option<[f64; 2]> {
        match spot {
            Spot::At(place) => Some(*place),
            Spot::Named(name) => {
                self.places.named.iter().find(|(known, _)| known == name).map(|(_, place)| *place)
            }
        }
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
    /// Points with a name.
    pub named: Vec<(String, [f64; 2])>,
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
        "{}: the ending says no kind of map; known are .yaml (ROS map server, Open-RMF), .map (MovingAI), .geojson, \
         .json, .osm, .dxf, .svg, and the images .png, .pgm, .bmp, .jpg and .tif", .0.display()
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
pub(crate) fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// The ending of the name of a map, which says of which kind it is.
fn ending_of(path: &Path) -> String {
    path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_ascii_lowercase()
}

fn text_of(path: &Path) -> Result<String, ImportError> {
    fs::read_to_string(path).map_err(|source| ImportError::Unreadable { path: path.into(), source })
}

/// The values of a YAML text by their keys.
fn yaml(text: &str) -> Result<Value, String> {
    serde_saphyr::from_str(text).map_err(|error| error.to_string())
}

fn yaml_of(path: &Path) -> Result<Value, ImportError> {
    yaml(&text_of(path)?).map_err(|problem| ImportError::Malformed { path: path.into(), problem })
}

/// The files that a map consists of: itself and, where it names one, its image.
///
/// # Errors
/// When a map that may name an image cannot be read or names none.
pub fn files(path: &Path) -> Result<Vec<PathBuf>, ImportError> {
    let mut files = vec![path.to_owned()];
    if matches!(ending_of(path).as_str(), "yaml" | "yml") {
        let keys = yaml_of(path)?;
        if !building::is_one(&keys) {
            files.push(ros::image_of(path, &keys)?);
        }
    }
    Ok(files)
}

/// Reads a map; the ending of its name says of which kind it is.
///
/// # Errors
/// When the file cannot be read, is of an unknown kind or malformed, has no floor, or loses more of it than is accepted.
pub fn read(path: &Path, reading: &Reading) -> Result<Plan, ImportError> {
    let malformed = |problem| ImportError::Malformed { path: path.into(), problem };
    let text = || text_of(path);
    for (name, length) in [("scale", Some(reading.scale)), ("wall width", reading.wall_width)] {
        if let Some(length) = length.filter(|length| !(length.is_finite() && *length > 0.0)) {
            return Err(malformed(format!("the {name} is {length}: it must be positive")));
        }
    }
    let ending = ending_of(path);
    let keys = if matches!(&*ending, "yaml" | "yml") { yaml_of(path)? } else { Value::Null };
    let kind = Kind::of(&ending, &keys).ok_or_else(|| ImportError::UnknownKind(path.into()))?;
    kind.check(reading).map_err(malformed)?;
    let plan = match kind {
        Kind::Building => building::read(&keys, reading),
        Kind::Ros => ros::read(path, &keys)?.trace(reading),
        Kind::MovingAi => moving_ai::read(&text()?).map_err(malformed)?.trace(reading),
        Kind::GeoJson => geojson::read(&text()?, reading),
        Kind::OpenStreetMap => osm::read(&text()?, reading),
        Kind::Svg => svg::read(&text()?, reading),
        Kind::Dxf => dxf(path, reading),
        Kind::Image => image::read(path, reading)?.trace(reading),
    };
    Ok(plan.map_err(malformed)?.near_the_origin())
}

#[cfg(feature = "dxf")]
use self::dxf::read as dxf;

#[cfg(not(feature = "dxf"))]
fn dxf(_: &Path, _: &Reading) -> Result<Plan, String> {
    Err("this program is built without DXF; build one with cargo build --release --features dxf"
        .into())
}

/// Kinds of map.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Building,
    Ros,
    MovingAi,
    GeoJson,
    OpenStreetMap,
    Svg,
    Dxf,
    Image,
}

impl Kind {
    /// The kind of a file with this ending and, if it is YAML, these keys.
    fn of(ending: &str, keys: &Value) -> Option<Self> {
        Some(match ending {
            "yaml" | "yml" if building::is_one(keys) => Kind::Building,
            "yaml" | "yml" => Kind::Ros,
            "map" => Kind::MovingAi,
            "geojson" | "json" => Kind::GeoJson,
            "osm" => Kind::OpenStreetMap,
            "svg" => Kind::Svg,
            "dxf" => Kind::Dxf,
            "png" | "pgm" | "pnm" | "ppm" | "pbm" | "bmp" | "jpg" | "jpeg" | "tif" | "tiff" => {
                Kind::Image
            }
            _ => return None,
        })
    }

    /// Refuses what is stated and would have no effect.
    fn check(self, reading: &Reading) -> Result<(), String> {
        use Kind::{Building, Dxf, GeoJson, Image, MovingAi, OpenStreetMap, Ros, Svg};
        let is_of_cells = matches!(self, Ros | MovingAi | Image);
        let is_on_earth = matches!(self, GeoJson | OpenStreetMap);
        let has_features = is_on_earth || matches!(self, Building | Dxf);
        let is_drawn = has_features || self == Svg;
        let stated = [
            ("--resolution", reading.resolution.is_some(), self == Image, "an image alone"),
            ("--specks", reading.specks.is_some(), is_of_cells, "maps of cells"),
            ("--planar", reading.planar, is_on_earth, "GeoJSON and OpenStreetMap"),
            ("--level", reading.level.is_some(), has_features, "maps of features"),
            ("--wall", !reading.walls.is_empty(), has_features, "maps of features"),
            ("--floor", !reading.floors.is_empty(), has_features, "maps of features"),
            ("--wall-width", reading.wall_width.is_some(), is_drawn, "maps that are drawn"),
        ];
        let useless = stated.iter().find(|(_, is_stated, has_use, _)| *is_stated && !has_use);
        match useless {
            Some((option, _, _, what)) => {
                Err(format!("{option} is for {what}: leave it out for this map"))
            }
            None => Ok(()),
        }
    }
}

/// A finite number: infinite ones and those that are none can be written, too.
fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}
