//! Capsules.

use pleach_continuous::Point;
use pleach_continuous::geometry::{Capsule, Segment};
use proptest::prelude::*;

use super::environments::place;

proptest! {
    /// A point is in a capsule if it, as a capsule without extent, does not lie apart from it.
    #[test]
    fn a_capsule_contains_what_is_not_apart_from_it(
        from in place(),
        to in place(),
        radius in 0.0..0.5_f64,
        point in place(),
    ) {
        let capsule = Capsule { axis: Segment { from, to }, radius };
        let gap = capsule.gap(&Capsule::from(Segment::still(point)));
        prop_assume!(gap.abs() > 1e-12);
        prop_assert_eq!(capsule.contains(point), gap < 0.0);
    }
}

#[test]
fn the_rim_belongs_to_a_capsule() {
    let axis = Segment { from: Point::origin(), to: Point::new(1.0, 0.0) };
    let capsule = Capsule { axis, radius: 0.5 };
    for (x, y) in [(0.25, 0.5), (-0.5, 0.0), (1.5, 0.0)] {
        assert!(capsule.contains(Point::new(x, y)), "({x}, {y})");
    }
    assert!(!capsule.contains(Point::new(1.5_f64.next_up(), 0.0)));
}
