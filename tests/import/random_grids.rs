//! Random maps of cells: what robots get through before the import, they get through after it, and nothing else.

use super::shapes::{Dice, area, distance, is_inside, label};
use pleach::automaton::network::scenario::WorkspaceOutline;
use pleach::continuous::geometry::Workspace;
use pleach::import::{self, Plan, Reading};
use std::path::Path;

/// Points of the oracle along a cell.
const FINE: usize = 6;
/// How far a place may be from the next of these points, with room for rounding; in cells.
const SLACK: f64 = 0.13;

struct Map {
    width: usize,
    height: usize,
    /// Rows from the bottom.
    free: Vec<bool>,
}

impl Map {
    fn drawn(dice: &mut Dice) -> Self {
        let (width, height) = (16 + dice.below(14), 14 + dice.below(10));
        let mut map = Self { width, height, free: vec![true; width * height] };
        match dice.below(4) {
            0 => map.draw_rooms(dice),
            1 => map.draw_cave(dice),
            2 => map.draw_maze(dice),
            _ => {}
        }
        for _ in 0..dice.below(12) {
            let at = dice.below(width * height);
            map.free[at] = false;
        }
        map
    }

    fn wall(&mut self, columns: std::ops::Range<usize>, rows: std::ops::Range<usize>) {
        for row in rows.start..rows.end.min(self.height) {
            for column in columns.start..columns.end.min(self.width) {
                self.free[row * self.width + column] = false;
            }
        }
    }

    fn draw_rooms(&mut self, dice: &mut Dice) {
        for _ in 0..3 {
            let (column, row) = (2 + dice.below(self.width - 4), 2 + dice.below(self.height - 4));
            self.wall(column..column + 1, 0..self.height);
            self.wall(0..self.width, row..row + 1);
            for _ in 0..3 {
                let (door, wide) = (dice.below(self.height), 1 + dice.below(2));
                (door..(door + wide).min(self.height))
                    .for_each(|row| self.free[row * self.width + column] = true);
                let (door, wide) = (dice.below(self.width), 1 + dice.below(2));
                (door..(door + wide).min(self.width))
                    .for_each(|column| self.free[row * self.width + column] = true);
            }
        }
    }

    fn draw_cave(&mut self, dice: &mut Dice) {
        for _ in 0..12 {
            let (column, row, size) =
                (dice.below(self.width), dice.below(self.height), 1 + dice.below(5));
            for step in 0..size {
                self.wall(column..column + size - step, row + step..row + step + 1);
            }
        }
    }

    fn draw_maze(&mut self, dice: &mut Dice) {
        let step = 2 + dice.below(3);
        for row in (step..self.height).step_by(step) {
            for column in (step..self.width).step_by(step) {
                match dice.below(3) {
                    0 => self.wall(column..column + step, row..row + 1),
                    1 => self.wall(column..column + 1, row..row + step),
                    _ => self.wall(column..column + 1, row..row + 1),
                }
            }
        }
    }

    /// The text of a MovingAI map.
    fn text(&self) -> String {
        let mark = |free: &bool| if *free { '.' } else { '@' };
        let rows =
            self.free.chunks(self.width).rev().map(|row| row.iter().map(mark).collect::<String>());
        let rows: Vec<String> = rows.collect();
        format!(
            "type octile\nheight {}\nwidth {}\nmap\n{}\n",
            self.height,
            self.width,
            rows.join("\n")
        )
    }

    fn is_free(&self, column: usize, row: usize) -> bool {
        self.free[row * self.width + column]
    }

    /// The distance of a point from the next wall or the edge of the map, as far as `reach`.
    fn distance([x, y]: [f64; 2], map: &Self, reach: f64) -> f64 {
        let edge = x.min(y).min(map.width as f64 - x).min(map.height as f64 - y);
        let range = |at: f64, most: usize| {
            let [low, high] = [at - reach - 1.0, at + reach + 1.0].map(|it| it.max(0.0) as usize);
            low.min(most)..high.min(most)
        };
        let mut least = edge;
        for row in range(y, map.height) {
            for column in range(x, map.width).filter(|&column| !map.is_free(column, row)) {
                let beyond =
                    |at: f64, from: usize| (from as f64 - at).max(at - from as f64 - 1.0).max(0.0);
                least = least.min(beyond(x, column).hypot(beyond(y, row)));
            }
        }
        least
    }
}

/// The floor as it is after the import, as points of the oracle: how far they are from walls; 0 outside.
fn distances_after(outline: &WorkspaceOutline, points: &[[f64; 2]]) -> Vec<f64> {
    let rings: Vec<_> = std::iter::once(&outline.boundary).chain(&outline.holes).collect();
    let sides: Vec<_> = rings
        .iter()
        .flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)))
        .map(|(a, b)| [*a, *b])
        .collect();
    let of = |point: &[f64; 2]| match is_inside(&rings, *point) {
        false => 0.0,
        true => sides.iter().map(|side| distance(*point, *side)).fold(f64::INFINITY, f64::min),
    };
    points.iter().map(of).collect()
}

/// What a map with all its pieces but the largest filled looks like, by the pieces of the oracle.
fn largest_piece(map: &Map) -> Map {
    let labels = label(&map.free, map.width, false);
    let mut sizes = vec![0; map.free.len()];
    labels.iter().flatten().for_each(|&piece: &usize| sizes[piece] += 1);
    let largest = (0..sizes.len()).rev().max_by_key(|&piece| sizes[piece]);
    let free = labels.iter().map(|piece| piece.is_some() && *piece == largest).collect();
    Map { free, ..*map }
}

/// Whatever is wrong with the import of a random map.
fn is_right(seed: u64) {
    let mut dice = Dice::new(seed);
    let map = Map::drawn(&mut dice);
    let clearance = [0.1, 0.3, 0.5, 0.9, 1.4][dice.below(5)];
    let tolerance = [None, Some(1.0), Some(2.0)][dice.below(3)];
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("random.map");
    std::fs::write(&path, map.text()).unwrap();
    let reading =
        Reading { tolerance, clearance: Some(clearance), accepted_loss: 1.0, ..Reading::default() };
    let what =
        format!("seed {seed}: clearance {clearance}, tolerance {tolerance:?}\n{}", map.text());
    let plan = import::read(&path, &reading).unwrap_or_else(|error| panic!("{what}{error}"));
    has_the_area_that_it_says(&plan, &map, &what);
    let map = largest_piece(&map);
    keeps_walls_closed(&plan, &map, &what);
    keeps_passages(&plan, &map, clearance, &what);
}

fn has_the_area_that_it_says(plan: &Plan, map: &Map, what: &str) {
    let ring = |ring: &Vec<[f64; 2]>| ring.iter().map(|&corner| corner.into()).collect();
    let holes: Vec<_> = plan.workspace.holes.iter().map(ring).collect();
    Workspace::new(ring(&plan.workspace.boundary), holes)
        .unwrap_or_else(|error| panic!("{what}{error}"));
    let account = &plan.account;
    assert_eq!(account.stated, map.free.iter().filter(|free| **free).count() as f64, "{what}");
    let floor = area(&plan.workspace.boundary) - plan.workspace.holes.iter().map(area).sum::<f64>();
    let kept = account.stated - account.in_pieces - account.smoothed;
    assert!((floor - kept).abs() < 1e-6, "{what}{floor} of {account:?}");
}

fn keeps_walls_closed(plan: &Plan, map: &Map, what: &str) {
    let rings: Vec<_> =
        std::iter::once(&plan.workspace.boundary).chain(&plan.workspace.holes).collect();
    for row in 0..map.height {
        for column in (0..map.width).filter(|&column| !map.is_free(column, row)) {
            for [x, y] in [[0.5, 0.5], [0.01, 0.01], [0.99, 0.01], [0.01, 0.99], [0.99, 0.99]] {
                let place = [column as f64 + x, row as f64 + y];
                assert!(!is_inside(&rings, place), "{what}{place:?} of a wall is floor");
            }
        }
    }
}

/// Components and holes of where robots fit are the same before and after, but for what the points of the oracle are too
/// coarse for.
fn keeps_passages(plan: &Plan, map: &Map, clearance: f64, what: &str) {
    // With points beyond the edge of the map, which is a wall, too.
    let (width, height) = (map.width * FINE + 2, map.height * FINE + 2);
    let at = |index: usize| (index as f64 - 0.5) / FINE as f64;
    let points: Vec<[f64; 2]> =
        (0..width * height).map(|point| [at(point % width), at(point / width)]).collect();
    let before: Vec<f64> =
        points.iter().map(|&point| Map::distance(point, map, clearance + 1.0)).collect();
    let after = distances_after(&plan.workspace, &points);
    let fits = |distances: &[f64], margin: f64| {
        distances.iter().map(|it| *it >= clearance + margin).collect::<Vec<_>>()
    };
    let pieces = |distances: &[f64], margin: f64| label(&fits(distances, margin), width, true);
    let walls = |distances: &[f64], margin: f64| {
        label(&fits(distances, margin).iter().map(|fits| !fits).collect::<Vec<_>>(), width, false)
    };
    let [surely_before, perhaps_before] = [SLACK, -SLACK].map(|margin| pieces(&before, margin));
    let perhaps_after = pieces(&after, -SLACK);
    // Robots get from place to place as before; but pockets at the end of a way may be lost.
    let mut piece_after = vec![None; points.len()];
    for (point, before) in surely_before.iter().enumerate() {
        let (Some(before), Some(after)) = (*before, perhaps_after[point]) else { continue };
        let known = piece_after[before].get_or_insert(after);
        assert_eq!(*known, after, "{what}{:?} is cut off", points[point]);
    }
    // No piece vanishes.
    let mut is_left = vec![false; points.len()];
    for (point, piece) in perhaps_before.iter().enumerate() {
        piece.iter().for_each(|&piece| is_left[piece] |= perhaps_after[point].is_some());
    }
    for point in (0..points.len()).filter(|&point| surely_before[point].is_some()) {
        let piece = perhaps_before[point].expect("it is within");
        assert!(is_left[piece], "{what}nothing is left of the piece at {:?}", points[point]);
    }
    // And around whatever they got around: walls that were apart do not join.
    let (apart_before, joined_after) = (walls(&before, SLACK), walls(&after, -SLACK));
    let mut wall_before = vec![None; points.len()];
    for point in (0..points.len()).filter(|&point| before[point] <= 0.0) {
        let (Some(before), Some(after)) = (apart_before[point], joined_after[point]) else {
            continue;
        };
        let known = wall_before[after].get_or_insert(before);
        assert_eq!(*known, before, "{what}the wall at {:?} is joined to another", points[point]);
    }
}

#[test]
fn random_maps_keep_what_robots_get_through() {
    (0..40).for_each(is_right);
}

#[test]
#[ignore = "takes minutes"]
fn a_thousand_random_maps_keep_what_robots_get_through() {
    (0..1000).for_each(is_right);
}
