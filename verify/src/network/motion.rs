//! Straight motions of one control period, and how near they come to each other.
//!
//! Between two snapshots the command is constant (eq. (23)), so a robot moves on a segment at
//! constant speed: when the fraction s ∈ [0, 1] of the period has passed, it is at the share s of
//! its [`Segment`]. What holds at every instant follows in closed form; nothing is sampled.

use pleach_continuous::Point;
use pleach_continuous::geometry::Segment;

/// The smallest distance between two motions, and when it occurs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Approach {
    /// The distance then.
    pub distance: f64,
    /// s ∈ [0, 1]: the fraction of the period that has passed.
    pub fraction: f64,
}

/// The closest approach of two simultaneous motions.
///
/// Their offset is d + s·v with d the offset at the start and v the difference of the
/// displacements; |d + s·v|² is a parabola with its vertex at s = −d·v / |v|², so its minimum
/// over [0, 1] lies at the vertex clamped to that interval.
///
/// ```
/// use pleach_continuous::geometry::Segment;
/// use pleach_verify::network::motion::closest_approach;
/// use nalgebra::point;
///
/// let eastward = Segment { from: point![0.0, 0.0], to: point![2.0, 0.0] };
/// let westward = Segment { from: point![2.0, 0.5], to: point![0.0, 0.5] };
/// let approach = closest_approach(&eastward, &westward);
/// assert_eq!((approach.distance, approach.fraction), (0.5, 0.5));
/// ```
pub fn closest_approach(first: &Segment, second: &Segment) -> Approach {
    let offset = second.from - first.from;
    let relative = second.vector() - first.vector();
    let squared = relative.norm_squared();
    let fraction =
        if squared > 0.0 { (-offset.dot(&relative) / squared).clamp(0.0, 1.0) } else { 0.0 };
    Approach { distance: (offset + relative * fraction).norm(), fraction }
}

/// The largest distance of two simultaneous motions.
///
/// The norm of an affine function of s is convex, so the maximum lies at one of the two ends.
pub(super) fn farthest_distance(first: &Segment, second: &Segment) -> f64 {
    (second.from - first.from).norm().max((second.to - first.to).norm())
}

/// The fractions of the period during which a motion is within `radius` of a place: an interval
/// [s₀, s₁] within [0, 1], or nothing.
pub(super) fn interval_within(motion: &Segment, place: Point, radius: f64) -> Option<(f64, f64)> {
    let (start_inside, end_inside) =
        ((motion.from - place).norm() <= radius, (motion.to - place).norm() <= radius);
    if start_inside && end_inside {
        return Some((0.0, 1.0));
    }
    // The disc is convex: what is left is one chord, whose ends solve |d + s·v|² = radius².
    let nearest = closest_approach(motion, &Segment::still(place));
    if nearest.distance > radius {
        return None;
    }
    let direction = motion.vector();
    let vertex = (place - motion.from).dot(&direction) / direction.norm_squared();
    let foot = (motion.at(vertex) - place).norm();
    let half_chord = ((radius - foot) * (radius + foot)).max(0.0).sqrt() / direction.norm();
    let start = if start_inside { 0.0 } else { (vertex - half_chord).clamp(0.0, 1.0) };
    let end = if end_inside { 1.0 } else { (vertex + half_chord).clamp(0.0, 1.0) };
    Some((start, end))
}

/// The first fraction of the period that none of the intervals covers, if there is one.
pub(super) fn first_gap(intervals: &mut [(f64, f64)]) -> Option<f64> {
    intervals.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut covered = 0.0;
    for &(start, end) in intervals.iter() {
        if start > covered {
            return Some(covered);
        }
        covered = f64::max(covered, end);
    }
    // An empty list covers nothing, not even s = 0.
    (intervals.is_empty() || covered < 1.0).then_some(covered)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::point;
    use proptest::prelude::*;

    const SAMPLES: u32 = 1000;

    fn fractions() -> impl Iterator<Item = f64> {
        (0..=SAMPLES).map(|sample| f64::from(sample) / f64::from(SAMPLES))
    }

    fn place() -> impl Strategy<Value = Point> {
        (-1.0..1.0, -1.0..1.0).prop_map(|(x, y)| point![x, y])
    }

    fn motion() -> impl Strategy<Value = Segment> {
        (place(), place()).prop_map(|(from, to)| Segment { from, to })
    }

    proptest! {
        #[test]
        fn the_closest_approach_is_what_dense_sampling_tends_to(
            first in motion(),
            second in motion(),
        ) {
            let approach = closest_approach(&first, &second);
            let distance_at = |s: f64| (first.at(s) - second.at(s)).norm();
            let sampled = fractions().map(distance_at).fold(f64::INFINITY, f64::min);
            // The relative speed is at most 2·√8 < 6, and a sample lies within half a step.
            prop_assert!(approach.distance <= sampled + 1e-12);
            prop_assert!(sampled - approach.distance <= 3.0 / f64::from(SAMPLES));
            prop_assert!((distance_at(approach.fraction) - approach.distance).abs() < 1e-12);
        }

        #[test]
        fn the_farthest_distance_is_never_exceeded(first in motion(), second in motion()) {
            let farthest = farthest_distance(&first, &second);
            for s in fractions() {
                prop_assert!((first.at(s) - second.at(s)).norm() <= farthest + 1e-12);
            }
        }

        #[test]
        fn a_robot_is_near_exactly_within_its_interval(
            motion in motion(),
            place in place(),
            radius in 0.01..1.0,
        ) {
            let interval = interval_within(&motion, place, radius);
            for s in fractions() {
                let depth = radius - (motion.at(s) - place).norm();
                let is_inside = interval.is_some_and(|(start, end)| start <= s && s <= end);
                prop_assert!(depth.abs() < 1e-9 || is_inside == (depth > 0.0), "{s} {depth}");
            }
        }
    }

    #[test]
    fn parallel_motions_keep_their_distance() {
        let first = Segment { from: point![0.0, 0.0], to: point![1.0, 0.0] };
        let second = Segment { from: point![0.0, 0.3], to: point![1.0, 0.3] };
        assert_eq!(closest_approach(&first, &second), Approach { distance: 0.3, fraction: 0.0 });
    }

    #[test]
    fn a_gap_is_found_where_cover_ends() {
        assert_eq!(first_gap(&mut [(0.4, 1.0), (0.0, 0.5)]), None);
        assert_eq!(first_gap(&mut [(0.6, 1.0), (0.0, 0.5)]), Some(0.5));
        assert_eq!(first_gap(&mut [(0.1, 1.0)]), Some(0.0));
        assert_eq!(first_gap(&mut [(0.0, 0.7), (0.0, 0.2)]), Some(0.7));
        assert_eq!(first_gap(&mut []), Some(0.0));
    }
}
