//! Distances, sight and neighbours beside parry, on the same shapes in one run.
//!
//! Both sides answer the same question from structures that are built once; what is built with each
//! period, the search for neighbours, is measured with its construction.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::math::{Pose, Vector};
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy};
use parry2d_f64::query::{self, PointQuery};
use parry2d_f64::shape::{Polyline, Segment as Line};
use pleach::continuous::Point;
use pleach::continuous::geometry::{Neighbours, Workspace};

/// Queries in each measurement.
const QUERIES: usize = 1000;

/// Numbers between 0 and 1, spread evenly: multiples of an irrational number.
fn shares(start: f64) -> impl Iterator<Item = f64> {
    (1..).map(move |index| (start + f64::from(index) * 0.618_033_988_749_894_9).fract())
}

fn places(count: usize, width: f64) -> Vec<Point> {
    let columns = shares(0.0).step_by(7).zip(shares(0.3).step_by(11));
    columns.take(count).map(|(x, y)| Point::new(x * width, y * width)).collect()
}

/// A hall with `side`² square pillars.
fn hall(side: usize) -> Workspace {
    let square = |x: f64, y: f64, width: f64| {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(a, b)| Point::new(x + a * width, y + b * width))
            .to_vec()
    };
    let pillars = (0..side * side)
        .map(|index| square((index % side) as f64 + 0.3, (index / side) as f64 + 0.3, 0.4))
        .collect();
    Workspace::new(square(0.0, 0.0, side as f64), pillars).expect("a hall")
}

fn vector(point: Point) -> Vector {
    Vector::new(point.x, point.y)
}

fn polyline(workspace: &Workspace) -> Polyline {
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    for ring in workspace.polygons() {
        let (first, count) = (vertices.len() as u32, ring.len() as u32);
        vertices.extend(ring.iter().copied().map(vector));
        indices.extend((0..count).map(|at| [first + at, first + (at + 1) % count]));
    }
    Polyline::new(vertices, Some(indices))
}

/// Distances from points and from moves to the walls.
fn clearance(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("clearance");
    for side in [5, 50] {
        let workspace = hall(side);
        let walls = polyline(&workspace);
        let places = places(QUERIES, side as f64);
        let edges = 4 * side * side + 4;
        let far = Point::new(-1.0, -1.0);
        group.bench_function(BenchmarkId::new("point, pleach", edges), |bencher| {
            bencher.iter(|| {
                black_box(&places).iter().map(|&place| workspace.clearance(place)).sum::<f64>()
            })
        });
        group.bench_function(BenchmarkId::new("point, parry", edges), |bencher| {
            bencher.iter(|| {
                let distance = |&place: &Point| walls.distance_to_local_point(vector(place), true);
                black_box(&places).iter().map(distance).sum::<f64>()
            })
        });
        let moves: Vec<(Point, Point)> =
            places.iter().map(|&place| (place, place + (place - far).normalize() * 0.1)).collect();
        group.bench_function(BenchmarkId::new("move, pleach", edges), |bencher| {
            bencher.iter(|| {
                let clearance =
                    |&(from, to): &(Point, Point)| workspace.segment_clearance(from, to);
                black_box(&moves).iter().map(clearance).sum::<f64>()
            })
        });
        group.bench_function(BenchmarkId::new("move, parry", edges), |bencher| {
            let here = Pose::IDENTITY;
            bencher.iter(|| {
                let distance = |&(from, to): &(Point, Point)| {
                    let line = Line::new(vector(from), vector(to));
                    query::distance(&here, &line, &here, &walls).map_or(0.0, |it| it.distance)
                };
                black_box(&moves).iter().map(distance).sum::<f64>()
            })
        });
    }
    group.finish();
}

/// The robots within range of each of many, about a dozen others each; with construction.
fn neighbours(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("neighbours");
    for count in [13_usize, 100, 1000, 10_000] {
        let robots = places(count, (count as f64).sqrt() * 0.5);
        let range = 1.0;
        group.bench_function(BenchmarkId::new("pleach", count), |bencher| {
            bencher.iter(|| {
                let neighbours = Neighbours::new(black_box(&robots), range);
                let mut found = 0;
                for &robot in &robots {
                    neighbours.for_each_within(robot, range, |_, _| found += 1);
                }
                found
            })
        });
        group.bench_function(BenchmarkId::new("parry", count), |bencher| {
            bencher.iter(|| {
                let leaf = |&robot: &Point| Aabb::new(vector(robot), vector(robot));
                let boxes: Vec<Aabb> = black_box(&robots).iter().map(leaf).collect();
                let tree = Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes);
                let mut found = 0;
                for &robot in &robots {
                    let reach = Vector::new(range, range);
                    let around = Aabb::new(vector(robot) - reach, vector(robot) + reach);
                    let is_near = |index: &u32| (robots[*index as usize] - robot).norm() <= range;
                    found += tree.intersect_aabb(&around).filter(is_near).count();
                }
                found
            })
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(std::time::Duration::from_millis(200))
        .measurement_time(std::time::Duration::from_millis(600));
    targets = clearance, neighbours
}
criterion_main!(benches);
