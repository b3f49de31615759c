//! Random environments: a rectangle with walls from below and above, and convex holes.

use std::f64::consts::TAU;
use std::fmt;

use pleach_continuous::Point;
use pleach_continuous::geometry::{FreeSpace, Workspace};
use proptest::collection::vec;
use proptest::prelude::*;

/// The clearance in all random environments.
pub const CLEARANCE: f64 = 0.03;

const WIDTH: f64 = 2.4;
const HEIGHT: f64 = 1.6;

/// A workspace with its free space.
#[derive(Clone)]
pub struct Environment {
    pub workspace: Workspace,
    pub free_space: FreeSpace,
}

impl fmt::Debug for Environment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for polygon in self.workspace.polygons() {
            let vertices: Vec<_> = polygon.iter().map(|p| (p.x, p.y)).collect();
            writeln!(f, "{vertices:?}")?;
        }
        Ok(())
    }
}

/// How the coordinates of an environment relate to each other.
#[derive(Debug, Clone, Copy)]
enum Alignment {
    /// Not at all.
    Free,
    /// Multiples of `GRID`: corners in line, passages of equal length.
    Grid,
    /// Almost multiples of `GRID`: corners in line up to a few tolerances.
    AlmostGrid,
}

const GRID: f64 = 0.1;

/// How far vertices in an [`Alignment::AlmostGrid`] are from the grid; the tolerance is 2.8e-6.
const MISALIGNMENT: f64 = 4e-6;

impl Alignment {
    fn align(self, point: Point) -> Point {
        point
            .coords
            .map(|coordinate| {
                let on_grid = (coordinate / GRID).round();
                match self {
                    Alignment::Free => coordinate,
                    Alignment::Grid => on_grid * GRID,
                    Alignment::AlmostGrid => {
                        on_grid * GRID + 2.0 * MISALIGNMENT * (coordinate / GRID - on_grid)
                    }
                }
            })
            .into()
    }
}

fn alignment() -> impl Strategy<Value = Alignment> {
    prop_oneof![Just(Alignment::Free), Just(Alignment::Grid), Just(Alignment::AlmostGrid)]
}

/// A place in the rectangle, half of the time on a grid.
pub fn place() -> impl Strategy<Value = Point> {
    (anywhere(), any::<bool>()).prop_map(
        |(place, free)| {
            if free { place } else { Alignment::Grid.align(place) }
        },
    )
}

fn anywhere() -> impl Strategy<Value = Point> {
    (0.0..1.0, 0.0..1.0).prop_map(|(x, y)| Point::new(x * WIDTH, y * HEIGHT))
}

pub fn environment() -> impl Strategy<Value = Environment> {
    let walls = vec((0.1..0.9, 0.03..0.15, 0.2..0.8, any::<bool>()), 0..4);
    let holes = vec((anywhere(), 0.05..0.25, vec(0.0..TAU, 3..7)), 0..5);
    (walls, holes, alignment()).prop_filter_map("no workspace", |(walls, holes, alignment)| {
        let aligned = |ring: Vec<Point>| ring.into_iter().map(|p| alignment.align(p)).collect();
        let boundary: Vec<Point> = aligned(boundary(&walls));
        // Keep every hole that fits.
        let mut kept: Vec<Vec<Point>> = Vec::new();
        let mut workspace = Workspace::new(boundary.clone(), vec![]).ok()?;
        for (center, radius, angles) in holes {
            let mut with_one_more = kept.clone();
            with_one_more.push(aligned(hole(center, radius, angles)));
            if let Ok(larger) = Workspace::new(boundary.clone(), with_one_more.clone()) {
                (workspace, kept) = (larger, with_one_more);
            }
        }
        let free_space = FreeSpace::new(&workspace, CLEARANCE)
            .unwrap_or_else(|error| panic!("{:?}: {error}", workspace.polygons()));
        Some(Environment { workspace, free_space })
    })
}

/// The rectangle with walls: (where, as a fraction; thickness; height, as a fraction; from above).
fn boundary(walls: &[(f64, f64, f64, bool)]) -> Vec<Point> {
    let mut walls = walls.to_vec();
    walls.sort_by(|one, other| one.0.total_cmp(&other.0));
    walls.dedup_by(|next, wall| next.0 * WIDTH < wall.0 * WIDTH + wall.1 + 0.01);
    let notch = |&(at, thickness, height, from_above): &(f64, f64, f64, bool)| {
        let (left, right) = (at * WIDTH, at * WIDTH + thickness);
        let tip = height * HEIGHT;
        if from_above {
            vec![(right, HEIGHT), (right, HEIGHT - tip), (left, HEIGHT - tip), (left, HEIGHT)]
        } else {
            vec![(left, 0.0), (left, tip), (right, tip), (right, 0.0)]
        }
    };
    let mut ring = vec![(0.0, 0.0)];
    ring.extend(walls.iter().filter(|wall| !wall.3).flat_map(notch));
    ring.extend([(WIDTH + 0.4, 0.0), (WIDTH + 0.4, HEIGHT)]);
    ring.extend(walls.iter().rev().filter(|wall| wall.3).flat_map(notch));
    ring.push((0.0, HEIGHT));
    ring.into_iter().map(|(x, y)| Point::new(x, y)).collect()
}

fn hole(center: Point, radius: f64, mut angles: Vec<f64>) -> Vec<Point> {
    angles.sort_by(f64::total_cmp);
    angles
        .into_iter()
        .map(|angle| Point::new(center.x + radius * angle.cos(), center.y + radius * angle.sin()))
        .collect()
}

/// A square room of side 3 with a square hole of side 1 in its middle.
pub fn room_with_hole() -> Workspace {
    let boundary = ring(&[(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0)]);
    let hole = ring(&[(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (1.0, 2.0)]);
    Workspace::new(boundary, vec![hole]).unwrap()
}

/// The free space of a body of radius 1/8 in that room.
pub fn space_round_hole() -> FreeSpace {
    FreeSpace::new(&room_with_hole(), 0.125).unwrap()
}

/// A polygon from coordinates.
pub fn ring(coordinates: &[(f64, f64)]) -> Vec<Point> {
    coordinates.iter().map(|&(x, y)| Point::new(x, y)).collect()
}
