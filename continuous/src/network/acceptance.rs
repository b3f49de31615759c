//! The certified acceptance of moves: constraint (5) holds at every instant of the motion.
//!
//! The linearised problem (21)–(22) proposes a move with all others fixed, but all robots move
//! at once. What is accepted is decided here, exactly.
//!
//! # Held flows
//!
//! During (t_k, t_{k+1}) every sender holds its flows F_ij = T_ij(t_k) R_ij(t_k) and lets its time
//! shares follow the positions, T_ij = F_ij / R_ij(x). Residuals are sums of flows and rates, so
//! no c_i changes at all. What remains of (6) is one condition per sender, that its *load*
//!
//! ```text
//! h_i(x) = Σ_j F_ij / R_ij(x) ≤ 1.
//! ```
//!
//! # What is certified
//!
//! Let every robot n travel on its proposed segment from x_n to y_n at any pace, independently of
//! the others; in particular any subset of the robots may carry out its move while the rest
//! stays. Then h_i never exceeds [`worst_load`].
//!
//! *Proof.* Place robot n at x_n + α_n (y_n − x_n), α_n ∈ \[0, 1\]. The difference of two positions
//! is affine in (α_i, α_j), its norm convex, and 1/R is convex and nondecreasing in the distance
//! ([`LinkReliability`], requirement 3); so each term of h_i, and h_i itself, is convex in α (with
//! the value ∞ where R = 0). A convex function on a cube is largest at a corner, α ∈ {0, 1}^n.
//! For a fixed α_i the term of j depends on α_j alone, so the largest value over the corners is
//! the maximum over α_i of the sum of the maxima over α_j: four distances per receiver. ∎
//!
//! # Halving needs no agreement
//!
//! Shrinking a move towards its start replaces \[0, 1\] by \[0, γ\]: a smaller cube, hence a smaller
//! or equal maximum. So a robot that halves its own move never raises anyone's worst load, and a robot
//! whose load passes once passes for the rest of the round, whatever its neighbours do. A round of
//! "who exceeds asks its receivers and itself to halve" ends: when all who are involved stay, the
//! load is what it is now, at most 1 with feasible routes.
//!
//! The same argument bounds the euclidean length of a link by [`worst_separation`].
//!
//! # Errors of position and motion
//!
//! Let a robot know its place up to a distance e_p (*position error*: what it believes and what is
//! true differ by at most that) and follow a segment up to a distance e_m (*motion error*: where
//! it believes to be and the point of the segment that it should be at differ by at most that).
//! Then it is at every instant within r = e_p + e_m of a point of the segment that it has
//! announced: in the [`Capsule`] with that axis and radius. [`worst_load_within`] takes capsules.
//!
//! *Proof.* Let the axes be traversed as above, α_n ∈ \[0, 1\]. By the triangle inequality the true
//! distance of i and j is at most δ_ij(α_i, α_j) + r_i + r_j, where δ_ij is the distance of the
//! points on the axes. 1/R is nondecreasing, so
//!
//! ```text
//! h_i ≤ Σ_j F_ij / R(δ_ij(α_i, α_j) + r_i + r_j).
//! ```
//!
//! A constant added to a convex function leaves it convex, so the right side is convex in α, and
//! the argument with the corners applies to it. For collinear moves that end farthest apart the
//! bound is attained. ∎
//!
//! Halving an axis replaces \[0, 1\] by \[0, γ\] as before and leaves the radii; the worst load does
//! not rise. When all who are involved stay, it is the load at distances longer by r_i + r_j. That
//! is at most 1 if routes are feasible for such distances:
//! [`WithMargin`](super::reliability::WithMargin) is the link model for routing then.

use std::ops::Add;

use super::reliability::LinkReliability;
use crate::Point;
pub use crate::geometry::{Capsule, Segment};

#[cfg(any(kani, test))]
mod proofs;

/// How much of a load a sender may be given, just below its whole time.
pub const FULL_LOAD: f64 = 1.0 - 1e-9;

/// Whether a sender accepts moves that could give it a load of `worst`, if it may have `present` where nobody
/// moves: the moves overload it not at all, or no more than it is. What is not a number is not accepted.
///
/// ```
/// use pleach_continuous::network::acceptance::is_acceptable;
///
/// assert!(is_acceptable(0.9, 0.2) && !is_acceptable(1.0, 0.2));
/// assert!(is_acceptable(1.1, 1.1) && !is_acceptable(1.2, 1.1));
/// ```
pub fn is_acceptable(worst: f64, present: f64) -> bool {
    worst <= FULL_LOAD.max(present)
}

/// h_i: the time share that a sender at `own` needs to carry its flows, given as pairs of a flow
/// F_ij and the place of the receiver. Infinite if a receiver of a flow cannot be reached.
pub fn load(
    own: Point,
    receivers: &[(f64, Point)],
    reliability: &(impl LinkReliability + ?Sized),
) -> f64 {
    receivers.iter().map(|&(flow, place)| term(flow, (own - place).norm(), reliability)).sum()
}

/// The largest load of a sender while it and its receivers carry out their moves, each at any
/// pace or not at all. Infinite if a flow could be cut off. See the module for the proof.
///
/// `receivers` pairs the held flow F_ij ≥ 0 with the proposed move of j.
///
/// ```
/// use pleach_continuous::Point;
/// use pleach_continuous::network::acceptance::{Segment, worst_load};
/// use pleach_continuous::network::CubicReliability;
///
/// let link = CubicReliability::new(0.4, 0.5)?;
/// let away = Segment { from: Point::new(0.4, 0.0), to: Point::new(0.45, 0.0) };
/// let access_point = Segment::still(Point::origin());
/// // At the end R = 1/2: the flow of 0.3 then takes 0.6 of the sender's time.
/// assert!((worst_load(away, &[(0.3, access_point)], &link) - 0.6).abs() < 1e-12);
/// # Ok::<(), pleach_continuous::network::reliability::ReliabilityError>(())
/// ```
pub fn worst_load(
    own: Segment,
    receivers: &[(f64, Segment)],
    reliability: &(impl LinkReliability + ?Sized),
) -> f64 {
    largest_load(
        own.into(),
        receivers.iter().map(|&(flow, move_of)| (flow, move_of.into())),
        reliability,
    )
}

/// The largest load of a sender while it and its receivers carry out their moves, each at any
/// pace or not at all, and each anywhere in its capsule. Infinite if a flow could be cut off. See
/// the module for what the capsules are and for the proof.
///
/// ```
/// use pleach_continuous::Point;
/// use pleach_continuous::network::acceptance::{Capsule, Segment, worst_load_within};
/// use pleach_continuous::network::CubicReliability;
///
/// let link = CubicReliability::new(0.4, 0.5)?;
/// let away = Segment { from: Point::new(0.4, 0.0), to: Point::new(0.44, 0.0) };
/// let robot = Capsule { axis: away, radius: 0.01 };
/// let access_point = Capsule::from(Segment::still(Point::origin()));
/// // At the end R may be as low as 1/2: the flow of 0.3 then takes 0.6 of the sender's time.
/// assert!((worst_load_within(robot, &[(0.3, access_point)], &link) - 0.6).abs() < 1e-12);
/// # Ok::<(), pleach_continuous::network::reliability::ReliabilityError>(())
/// ```
pub fn worst_load_within(
    own: Capsule,
    receivers: &[(f64, Capsule)],
    reliability: &(impl LinkReliability + ?Sized),
) -> f64 {
    largest_load(own, receivers.iter().copied(), reliability)
}

fn largest_load(
    own: Capsule,
    receivers: impl Iterator<Item = (f64, Capsule)> + Clone,
    reliability: &(impl LinkReliability + ?Sized),
) -> f64 {
    let terms_from = |place: Point| {
        receivers.clone().map(move |(flow, receiver)| {
            let spread = own.radius + receiver.radius;
            ends(&receiver.axis).map(|end| term(flow, (place - end).norm() + spread, reliability))
        })
    };
    worst_corner(ends(&own.axis).map(terms_from))
}

/// The largest sum over the corners of the moves: `terms` has one list for each end of the
/// sender's move, with the terms of every receiver for both ends of its own.
///
/// Any number will do that can be added and compared: the load is a sum of `f64`, and a model
/// checker takes whole numbers.
pub(super) fn worst_corner<N, Terms>(terms: [Terms; 2]) -> N
where
    N: Copy + PartialOrd + Add<Output = N> + Default,
    Terms: IntoIterator<Item = [N; 2]>,
{
    let worst_from = |terms: Terms| {
        terms.into_iter().fold(N::default(), |sum, [start, end]| sum + larger(start, end))
    };
    let [start, end] = terms;
    larger(worst_from(start), worst_from(end))
}

fn larger<N: PartialOrd>(one: N, other: N) -> N {
    if other > one { other } else { one }
}

/// A convex function of a move is largest at one of its ends.
fn ends(segment: &Segment) -> [Point; 2] {
    [segment.from, segment.to]
}

/// F/R: what one flow adds to the load. A flow of zero adds nothing, however far the receiver.
fn term(flow: f64, distance: f64, reliability: &(impl LinkReliability + ?Sized)) -> f64 {
    if flow == 0.0 { 0.0 } else { flow * reliability.expected_transmissions(distance) }
}

/// The largest euclidean distance between two robots while each carries out its move at any pace
/// or not at all: the largest of the four distances between the ends.
pub fn worst_separation(one: Segment, other: Segment) -> f64 {
    let squared = |a: &Point, b: &Point| (a - b).norm_squared();
    let [start, end] = ends(&other);
    ends(&one)
        .iter()
        .map(|place| squared(place, &start).max(squared(place, &end)))
        .fold(0.0, f64::max)
        .sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::{CubicReliability, WithMargin};
    use proptest::prelude::*;

    /// Rounding of a sum of a few terms of order one.
    const ROUNDING: f64 = 1e-12;

    fn link() -> CubicReliability {
        CubicReliability::new(0.4, 0.8).unwrap()
    }

    fn segment() -> impl Strategy<Value = Segment> {
        let place = || (0.0..0.6f64, 0.0..0.6f64).prop_map(|(x, y)| Point::new(x, y));
        (place(), place()).prop_map(|(from, to)| Segment { from, to })
    }

    fn receivers() -> impl Strategy<Value = Vec<(f64, Segment)>> {
        prop::collection::vec((0.0..0.3f64, segment()), 1..5)
    }

    /// Loads and what is none.
    const LOADS: [f64; 9] = [0.0, 0.5, 0.6, FULL_LOAD, 1.0, 1.1, 1.2, f64::INFINITY, f64::NAN];

    /// Moves are judged one after the other: a sender is given no load but those that it has accepted.
    #[test]
    fn a_sender_that_accepts_is_never_given_too_much() {
        for (first, second) in LOADS.into_iter().flat_map(|it| LOADS.map(|other| (it, other))) {
            for mut load in LOADS.into_iter().filter(|load| *load <= FULL_LOAD) {
                for worst in [first, second] {
                    if is_acceptable(worst, load) {
                        load = worst;
                    }
                }
                assert!(load <= FULL_LOAD);
            }
        }
    }

    /// So consent to a move is consent to what is left of it when movers halve theirs; and a sender that has too much
    /// already accepts what does not give it more.
    #[test]
    fn consent_to_a_move_is_consent_to_less_of_it() {
        for (worst, present) in LOADS.into_iter().flat_map(|it| LOADS.map(|other| (it, other))) {
            for less in LOADS.into_iter().filter(|less| *less <= worst) {
                assert!(!is_acceptable(worst, present) || is_acceptable(less, present));
            }
            assert!(is_acceptable(present, present) || present.is_nan());
        }
    }

    proptest! {
        #[test]
        fn no_pace_exceeds_the_worst_load(
            own in segment(),
            receivers in receivers(),
            paces in prop::collection::vec(prop::collection::vec(0.0..=1.0f64, 5), 20),
        ) {
            let worst = worst_load(own, &receivers, &link());
            for pace in paces {
                let now: Vec<_> =
                    receivers.iter().zip(&pace[1..]).map(|((f, s), p)| (*f, s.at(*p))).collect();
                let load = load(own.at(pace[0]), &now, &link());
                prop_assert!(load <= worst * (1.0 + ROUNDING), "{load} exceeds {worst}");
            }
        }

        /// The bound is attained: some corner has exactly this load.
        #[test]
        fn the_worst_load_is_attained_at_a_corner(own in segment(), receivers in receivers()) {
            let worst = worst_load(own, &receivers, &link());
            let corners = 0u32..(2 << receivers.len());
            let largest = corners
                .map(|corner| {
                    let end = |bit: usize| f64::from((corner >> bit) & 1);
                    let now: Vec<_> = receivers
                        .iter()
                        .enumerate()
                        .map(|(index, (f, s))| (*f, s.at(end(index + 1))))
                        .collect();
                    load(own.at(end(0)), &now, &link())
                })
                .fold(0.0, f64::max);
            prop_assert!(largest == worst || (largest - worst).abs() <= ROUNDING * worst);
        }

        #[test]
        fn halving_any_move_never_raises_the_worst_load(
            own in segment(),
            receivers in receivers(),
            halves in prop::collection::vec(any::<bool>(), 5),
        ) {
            let shrunk = |segment: &Segment, half: bool| {
                if half { segment.halved() } else { *segment }
            };
            let after: Vec<_> =
                receivers.iter().zip(&halves[1..]).map(|((f, s), h)| (*f, shrunk(s, *h))).collect();
            let before = worst_load(own, &receivers, &link());
            let now = worst_load(shrunk(&own, halves[0]), &after, &link());
            prop_assert!(now <= before * (1.0 + ROUNDING));
        }

        /// Wherever in their capsules the sender and the receivers are.
        #[test]
        fn no_error_exceeds_the_worst_load_within(
            own in segment(),
            receivers in receivers(),
            radii in prop::collection::vec(0.0..0.05f64, 5),
            tries in prop::collection::vec(
                prop::collection::vec((0.0..=1.0f64, 0.0..=1.0f64, 0.0..6.3f64), 5), 20,
            ),
        ) {
            let capsules: Vec<_> = receivers
                .iter()
                .zip(&radii[1..])
                .map(|(&(flow, axis), &radius)| (flow, Capsule { axis, radius }))
                .collect();
            let own = Capsule { axis: own, radius: radii[0] };
            let worst = worst_load_within(own, &capsules, &link());
            for errors in tries {
                let place = |capsule: &Capsule, (pace, share, angle): (f64, f64, f64)| {
                    let error = crate::Vector::new(angle.cos(), angle.sin()) * share;
                    capsule.axis.at(pace) + error * capsule.radius
                };
                let now: Vec<_> = capsules
                    .iter()
                    .zip(&errors[1..])
                    .map(|((flow, capsule), error)| (*flow, place(capsule, *error)))
                    .collect();
                let load = load(place(&own, errors[0]), &now, &link());
                prop_assert!(load <= worst * (1.0 + ROUNDING), "{load} exceeds {worst}");
            }
        }

        /// Errors in opposite directions at the ends that are farthest apart attain it.
        #[test]
        fn the_worst_load_within_is_attained_by_collinear_moves(
            gap in 0.1..0.4f64, away in 0.0..0.2f64, radii in (0.0..0.05f64, 0.0..0.05f64),
        ) {
            let to_the_right = |from: f64, to: f64, radius: f64| {
                let axis = Segment::new(Point::new(from, 0.0), Point::new(to, 0.0));
                Capsule { axis, radius }
            };
            let own = to_the_right(0.0, 0.0, radii.0);
            let receiver = to_the_right(gap, gap + away, radii.1);
            let worst = worst_load_within(own, &[(0.1, receiver)], &link());
            let farthest = [(0.1, Point::new(gap + away + radii.1, 0.0))];
            let load = load(Point::new(-radii.0, 0.0), &farthest, &link());
            prop_assert!((load - worst).abs() <= ROUNDING * worst, "{load} {worst}");
        }

        #[test]
        fn a_margin_of_the_link_model_is_a_radius(
            own in segment(), receivers in receivers(), error in 0.0..0.1f64,
        ) {
            let around = |axis: Segment| Capsule { axis, radius: error };
            let capsules: Vec<_> =
                receivers.iter().map(|&(flow, axis)| (flow, around(axis))).collect();
            let within = worst_load_within(around(own), &capsules, &link());
            let with_margin = WithMargin::new(link(), 2.0 * error).unwrap();
            let worst = worst_load(own, &receivers, &with_margin);
            prop_assert!(within == worst || (within - worst).abs() <= ROUNDING * worst);
        }

        #[test]
        fn no_pace_exceeds_the_worst_separation(
            one in segment(), other in segment(), a in 0.0..=1.0f64, b in 0.0..=1.0f64,
        ) {
            let distance = (one.at(a) - other.at(b)).norm();
            prop_assert!(distance <= worst_separation(one, other) + ROUNDING);
        }
    }

    /// Links are perfect up to 0.4 and half as good at 0.6.
    #[test]
    fn a_load_is_the_sum_of_flows_by_reliabilities() {
        let at = |x: f64, y: f64| Point::new(x, y);
        let receivers = [(0.3, at(0.1, 0.2)), (0.2, at(0.7, 0.2)), (0.0, at(9.0, 9.0))];
        assert!((load(at(0.1, 0.2), &receivers, &link()) - (0.3 + 0.2 * 2.0)).abs() <= ROUNDING);
        let still = receivers.map(|(flow, place)| (flow, Segment::still(place)));
        let own = Segment { from: at(0.1, 0.2), to: at(0.7, 0.2) };
        let worst = worst_load(own, &still, &link());
        assert!((worst - (0.3 * 2.0 + 0.2)).abs() <= ROUNDING, "{worst}");
    }

    /// A right triangle with sides of 3, 4 and 5, from each end of either move.
    #[test]
    fn the_worst_separation_is_attained_between_two_ends() {
        let (near, far) = (Point::new(1.0, 1.0), Point::new(4.0, 1.0));
        let [other_near, other_far] = [Point::new(4.0, 1.0), Point::new(4.0, 5.0)];
        for (from, to) in [(near, far), (far, near)] {
            for (start, end) in [(other_near, other_far), (other_far, other_near)] {
                let other = Segment { from: start, to: end };
                assert_eq!(worst_separation(Segment { from, to }, other), 5.0);
            }
        }
    }

    #[test]
    fn a_receiver_that_leaves_the_range_makes_the_load_infinite() {
        let away = Segment { from: Point::new(0.5, 0.0), to: Point::new(0.9, 0.0) };
        let still = Segment::still(Point::origin());
        assert_eq!(worst_load(still, &[(0.1, away)], &link()), f64::INFINITY);
        assert_eq!(worst_load(still, &[(0.0, away)], &link()), 0.0);
    }
}
