//! Free spaces and shortest paths on published maps: `geodesics FOLDER`.
//!
//! Reads every map below FOLDER and prints one line for each:
//!
//! - `visilibity/NAME.environment`, the polygons of a VisiLibity environment; if `NAME.guards` and
//!   `NAME.result` are there too, the shortest path between the two guards is compared with the
//!   vertices in the result;
//! - `ironharvest/NAME.txt`, a game map with sections `[BORDER]` and `[OBSTACLE]`.
//!
//! On every map, paths between places spread over it are checked: both ways of asking agree, each
//! path keeps the clearance, and no way is shorter than the straight line. The program fails if a
//! check does. Run it with `--release`: the times are part of what it tells.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use std::{env, fs};

use pleach_continuous::Point;
use pleach_continuous::geometry::{FreeSpace, Geodesic, Workspace};

/// Clearance on game maps, as a fraction of their extent.
const MAP_CLEARANCE: f64 = 1e-3;

/// Places on each map between which paths are asked for.
const PLACES: usize = 40;

/// The tolerance of the free space with which expected lengths are compared, as a fraction of the
/// extent, and how far lengths may be off, as a fraction of it, too.
const FINE_TOLERANCE: f64 = 1e-12;
const ALLOWED_DEVIATION: f64 = 1e-9;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let folder = env::args_os().nth(1).map(PathBuf::from).ok_or("usage: geodesics FOLDER")?;
    println!(
        "{:<34} {:>8} {:>7} {:>10} {:>10} {:>10} {:>10}  expected path",
        "map", "vertices", "outline", "build ms", "goal us", "to goal us", "pair us"
    );
    let mut maps = 0;
    for path in files(&folder.join("visilibity"), "environment")? {
        let map = Map::new(&path, read_polygons(&path)?, 0.0)?;
        map.report(&map.check_expected(&path)?)?;
        maps += 1;
    }
    for path in files(&folder.join("ironharvest"), "txt")? {
        let polygons = read_polygons(&path)?;
        let clearance = MAP_CLEARANCE * Workspace::new(polygons[0].clone(), vec![])?.extent();
        Map::new(&path, polygons, clearance)?.report("")?;
        maps += 1;
    }
    if maps == 0 {
        return Err(format!("no maps in {}", folder.display()).into());
    }
    Ok(())
}

struct Map {
    name: String,
    workspace: Workspace,
    free_space: FreeSpace,
    construction: Duration,
}

impl Map {
    fn new(path: &Path, polygons: Vec<Vec<Point>>, clearance: f64) -> Result<Map> {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let workspace = workspace(&name, polygons)?;
        let start = Instant::now();
        let free_space = FreeSpace::new(&workspace, clearance)?;
        Ok(Map { name, workspace, free_space, construction: start.elapsed() })
    }

    /// Compares the path between two guards with an expected one, if there is one; tells how.
    fn check_expected(&self, environment: &Path) -> Result<String> {
        let (guards, result) =
            (environment.with_extension("guards"), environment.with_extension("result"));
        if !guards.exists() || !result.exists() {
            return Ok(String::new());
        }
        let guards = read_polygons(&guards)?.concat();
        let expected = read_polygons(&result)?.concat();
        let [from, to] = guards[..] else { return Err("expected two guards".into()) };
        let free_space = FreeSpace::with_tolerance(&self.workspace, 0.0, FINE_TOLERANCE)?;
        let (from, to) = (free_space.nearest(from), free_space.nearest(to));
        let length: f64 = expected.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        let found = free_space.geodesic(from, to).ok_or("no path between the guards")?;
        let allowed = ALLOWED_DEVIATION * self.workspace.extent();
        if (found.length - length).abs() > allowed {
            return Err(
                format!("{}: length {} instead of {length}", self.name, found.length).into()
            );
        }
        Ok(format!("{length:.10}, found {:.10}", found.length))
    }

    /// Checks paths between places spread over the map, and prints the line of the map.
    fn report(&self, expected: &str) -> Result<()> {
        let places = self.places();
        let (mut goals, mut told, mut asked) = (Duration::ZERO, Duration::ZERO, Duration::ZERO);
        for &to in &places {
            let start = Instant::now();
            let destination = self.free_space.destination(to);
            goals += start.elapsed();
            for &from in &places {
                let start = Instant::now();
                let path = self.free_space.geodesic_to(from, &destination);
                told += start.elapsed();
                let start = Instant::now();
                let same = self.free_space.geodesic(from, to);
                asked += start.elapsed();
                self.check(from, to, path, same)?;
            }
        }
        let each = |total: Duration, count: usize| total.as_secs_f64() * 1e6 / count as f64;
        println!(
            "{:<34} {:>8} {:>7} {:>10.2} {:>10.2} {:>10.2} {:>10.2}  {expected}",
            self.name,
            self.workspace.edges().count(),
            self.free_space.outline().iter().map(Vec::len).sum::<usize>(),
            self.construction.as_secs_f64() * 1e3,
            each(goals, places.len()),
            each(told, places.len().pow(2)),
            each(asked, places.len().pow(2)),
        );
        Ok(())
    }

    fn check(
        &self,
        a: Point,
        b: Point,
        told: Option<Geodesic>,
        asked: Option<Geodesic>,
    ) -> Result<()> {
        let failed = |what: &str| Err(format!("{}: {a} to {b}: {what}", self.name).into());
        let tolerance = self.free_space.tolerance();
        let (told, asked) = match (told, asked) {
            (Some(told), Some(asked)) => (told, asked),
            (None, None) => return Ok(()),
            _ => return failed("the two ways of asking disagree whether there is a path"),
        };
        if (told.length - asked.length).abs() > tolerance {
            return failed("the two ways of asking disagree on the length");
        }
        if told.length < (b - a).norm() - tolerance {
            return failed("shorter than the straight line");
        }
        let clearance = |path: &Geodesic| {
            path.segments(a)
                .map(|part| self.workspace.segment_clearance(part.from, part.to))
                .fold(f64::INFINITY, f64::min)
        };
        if clearance(&told).min(clearance(&asked)) < self.free_space.clearance() {
            return failed("too near to the boundary");
        }
        Ok(())
    }

    /// Free places spread evenly over the map: a Halton sequence,
    /// <https://doi.org/10.1145/355588.365104>.
    fn places(&self) -> Vec<Point> {
        let boundary = self.workspace.boundary();
        let low = boundary.iter().fold(boundary[0], |low, vertex| low.inf(vertex));
        let high = boundary.iter().fold(boundary[0], |high, vertex| high.sup(vertex));
        (1..)
            .map(|index| {
                let fractions =
                    nalgebra::vector![radical_inverse(index, 2), radical_inverse(index, 3)];
                low + (high - low).component_mul(&fractions)
            })
            .filter(|place| self.free_space.contains(*place))
            .take(PLACES)
            .collect()
    }
}

fn radical_inverse(mut index: u32, base: u32) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0);
    while index > 0 {
        digit /= f64::from(base);
        value += digit * f64::from(index % base);
        index /= base;
    }
    value
}

/// The workspace of the polygons. Published maps have holes that touch; says what was joined.
fn workspace(name: &str, polygons: Vec<Vec<Point>>) -> Result<Workspace> {
    let mut polygons = polygons.into_iter();
    let boundary = polygons.next().unwrap_or_default();
    let (workspace, repairs) = Workspace::repaired(boundary, polygons.collect())?;
    for repair in repairs {
        println!("{name}: {repair}");
    }
    Ok(workspace)
}

/// Files of a folder with an extension, in the order of their names.
fn files(folder: &Path, extension: &str) -> Result<Vec<PathBuf>> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let entries: std::io::Result<Vec<_>> = fs::read_dir(folder)?.collect();
    let mut paths: Vec<PathBuf> = entries?.iter().map(fs::DirEntry::path).collect();
    paths.retain(|path| path.extension().is_some_and(|found| found == extension));
    paths.sort();
    Ok(paths)
}

/// Polygons of a map, the outer boundary first: one `x y` a line, all other lines separate them.
fn read_polygons(path: &Path) -> Result<Vec<Vec<Point>>> {
    let mut polygons = vec![Vec::new()];
    for line in fs::read_to_string(path)?.lines() {
        let numbers: Vec<f64> =
            line.split_whitespace().map_while(|word| word.parse().ok()).collect();
        match (&numbers[..], polygons.last_mut()) {
            (&[x, y], Some(ring)) => ring.push(Point::new(x, y)),
            _ => polygons.push(Vec::new()),
        }
    }
    polygons.retain(|ring| !ring.is_empty());
    if polygons.is_empty() {
        return Err(format!("{} holds no polygon", path.display()).into());
    }
    Ok(polygons)
}
