//! How long it takes to validate workspaces and to set up their free space, by their size:
//! `setup [LARGEST]`, with up to `LARGEST` vertices, 10,000 unless told otherwise.
//!
//! Prints one line for each family and size. The exponent is that of the growth from the size
//! before: 1 where twice the vertices take twice the time. Run it with `--release`.

use std::error::Error;
use std::f64::consts::TAU;
use std::time::Instant;

use pleach_continuous::Point;
use pleach_continuous::geometry::{FreeSpace, Workspace};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Each time is the best of this many.
const RUNS: usize = 3;

/// A family of workspaces: from about how many vertices they have to boundary and holes.
type Family = fn(usize) -> (Vec<Point>, Vec<Vec<Point>>);

const FAMILIES: [(&str, Family); 4] =
    [("pillars", pillars), ("rooms", rooms), ("comb", comb), ("lake", lake)];

fn main() -> Result<()> {
    let largest = std::env::args().nth(1).map_or(Ok(10_000), |text| text.parse::<usize>())?;
    println!(
        "{:<8} {:>8} {:>12} {:>14} {:>10} {:>10}",
        "family", "vertices", "validate ms", "free space ms", "goal us", "exponent"
    );
    for (name, family) in FAMILIES {
        let mut before: Option<(f64, f64)> = None;
        let sizes = std::iter::successors(Some(largest), |size| Some(size / 4));
        let mut sizes: Vec<usize> = sizes.take_while(|&size| size >= 100).collect();
        sizes.reverse();
        for size in sizes {
            let (boundary, holes) = family(size);
            let vertices = boundary.len() + holes.iter().map(Vec::len).sum::<usize>();
            let (validation, workspace) =
                timed(|| Ok(Workspace::new(boundary.clone(), holes.clone())?))?;
            let (construction, free_space) = timed(|| Ok(FreeSpace::new(&workspace, 0.05)?))?;
            let goal = free_space.nearest(boundary[0]);
            let (towards_goal, _) = timed(|| Ok(free_space.destination(goal)))?;
            let now = (vertices as f64, validation + construction);
            let exponent = before.map_or(String::new(), |before| {
                format!("{:.2}", (now.1 / before.1).ln() / (now.0 / before.0).ln())
            });
            println!(
                "{name:<8} {vertices:>8} {:>12.2} {:>14.2} {:>10.1} {exponent:>10}",
                validation * 1e3,
                construction * 1e3,
                towards_goal * 1e6,
            );
            before = Some(now);
        }
    }
    Ok(())
}

/// The shortest of a few runs, in seconds, and what came out.
fn timed<T>(run: impl Fn() -> Result<T>) -> Result<(f64, T)> {
    let mut best: Option<(f64, T)> = None;
    for _ in 0..RUNS {
        let start = Instant::now();
        let value = run()?;
        let seconds = start.elapsed().as_secs_f64();
        if best.as_ref().is_none_or(|(shortest, _)| seconds < *shortest) {
            best = Some((seconds, value));
        }
    }
    best.ok_or_else(|| "nothing was run".into())
}

fn rectangle(left: f64, below: f64, width: f64, height: f64) -> Vec<Point> {
    [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
        .map(|(x, y)| Point::new(left + x, below + y))
        .to_vec()
}

/// A hall with square pillars, turned differently.
fn pillars(vertices: usize) -> (Vec<Point>, Vec<Vec<Point>>) {
    let side = ((vertices / 4) as f64).sqrt().ceil() as usize;
    let pillar = |index: usize| {
        let center = Point::new((index % side) as f64 + 0.5, (index / side) as f64 + 0.5);
        let turn = (index * 7 % 31) as f64 / 31.0;
        (0..4)
            .map(|corner| {
                let angle = (f64::from(corner) + turn) * TAU / 4.0;
                center + nalgebra::vector![angle.cos(), angle.sin()] * 0.25
            })
            .collect()
    };
    let holes = (0..vertices / 4 - 1).map(pillar).collect();
    (rectangle(0.0, 0.0, side as f64, side as f64), holes)
}

/// Rooms in rows, divided by pieces of wall with doors between them.
fn rooms(vertices: usize) -> (Vec<Point>, Vec<Vec<Point>>) {
    let side = ((vertices / 8) as f64).sqrt().ceil() as usize;
    let mut holes = Vec::new();
    for row in 0..side {
        for column in 0..side {
            let (x, y) = (column as f64, row as f64);
            holes.push(rectangle(x + 0.2, y + 0.9, 0.6, 0.1));
            holes.push(rectangle(x + 0.9, y + 0.2, 0.1, 0.6));
        }
    }
    holes.truncate(vertices / 4 - 1);
    (rectangle(0.0, 0.0, side as f64 + 0.2, side as f64 + 0.2), holes)
}

/// One polygon: a corridor with bays on its upper side.
fn comb(vertices: usize) -> (Vec<Point>, Vec<Vec<Point>>) {
    let bays = vertices / 4;
    let mut boundary = vec![Point::new(0.0, 0.0), Point::new(bays as f64, 0.0)];
    for bay in (0..bays).rev() {
        let x = bay as f64;
        let depth = 2.0 + (bay * 5 % 7) as f64 / 7.0;
        boundary.extend(
            [(0.9, 1.0), (0.9, depth), (0.1, depth), (0.1, 1.0)]
                .map(|(along, y)| Point::new(x + along, y)),
        );
    }
    (boundary, Vec::new())
}

/// One polygon: a round lake with a shore of many small capes.
fn lake(vertices: usize) -> (Vec<Point>, Vec<Vec<Point>>) {
    let shore = (0..vertices)
        .map(|index| {
            let angle = index as f64 / vertices as f64 * TAU;
            let radius = vertices as f64 / 20.0 * (1.0 - 0.004 * (index * index % 11) as f64);
            Point::new(angle.cos(), angle.sin()) * radius
        })
        .collect();
    (shore, Vec::new())
}
