//! Neighbours, against a search of all.

use pleach_continuous::Point;
use pleach_continuous::geometry::Neighbours;
use proptest::prelude::*;

fn tried(points: &[Point], center: Point, radius: f64) -> Vec<usize> {
    (0..points.len()).filter(|&index| (points[index] - center).norm() <= radius).collect()
}

/// A coordinate: usual, on a grid of the distances that are asked for, or absurd.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        8 => -3.0..3.0_f64,
        4 => (-6..6_i32).prop_map(|step| f64::from(step) * 0.1),
        1 => prop::sample::select(vec![
            1e19, -1e19, 1e100, -1e300, f64::MAX, f64::MIN, f64::MIN_POSITIVE, f64::INFINITY,
            f64::NEG_INFINITY, f64::NAN, 0.0, -0.0,
        ]),
    ]
}

fn points() -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec((coordinate(), coordinate()).prop_map(|(x, y)| Point::new(x, y)), 0..60)
}

proptest! {
    #[test]
    fn the_near_ones_are_found(
        points in points(),
        planned in prop_oneof![0.01..2.0_f64, Just(0.0), Just(-1.0), Just(f64::NAN), Just(1e300)],
        radius in prop_oneof![0.0..2.0_f64, Just(0.1), Just(0.3), Just(0.0), Just(-1.0), Just(1e300)],
        center in (coordinate(), coordinate()),
    ) {
        let neighbours = Neighbours::new(&points, planned);
        let own = points.iter().copied().chain([Point::new(center.0, center.1)]);
        for center in own {
            prop_assert_eq!(neighbours.within(center, radius), tried(&points, center, radius));
        }
    }
}

#[test]
fn many_points_need_few_cells() {
    // One robot a light year away must not cost a light year of cells.
    let mut points: Vec<Point> = (0..1000).map(|i| Point::new(f64::from(i) * 0.1, 0.0)).collect();
    points.push(Point::new(9.5e15, 9.5e15));
    let neighbours = Neighbours::new(&points, 0.25);
    assert_eq!(neighbours.within(points[10], 0.25), [8, 9, 10, 11, 12]);
    assert_eq!(neighbours.within(points[1000], 0.25), [1000]);
    assert!(Neighbours::new(&[], 0.25).within(Point::origin(), 9.0).is_empty());
}
