//! Link reliability, residuals, and the load of a sender whose flows are held.
//!
//! # Why the ends of a period suffice
//!
//! During a period the robots hold the flows F_ij = T_ij R_ij and let the shares follow,
//! T_ij = F_ij / R_ij. Then no residual changes, and what remains to be shown is that the
//! shares fit: the load h_i = Σ_j F_ij / R_ij is at most 1 at every instant.
//!
//! Put s = (d − l) / (u − l). On l ≤ d < u eq. (27) reads R = 1 − 3s² + 2s³ = (1 − s)²(1 + 2s),
//! hence
//!
//! - R' = −6s(1 − s) ≤ 0, so 1/R does not decrease with the distance;
//! - (1/R)'' = (2R'² − R R'') / R³ = (6 + 48s²) / ((1 − s)⁴ (1 + 2s)³) > 0, so 1/R is convex there;
//! - for d ≤ l it is the constant 1, and R'(l) = 0 joins the two without a kink.
//!
//! The distance of two robots on straight segments is convex in time; a convex nondecreasing
//! function of it is convex, and so is a sum with weights F_ij ≥ 0. A convex function is
//! largest at an end: **a load of at most 1 at both ends is one of at most 1 throughout**, and
//! a link within range at both ends is within range throughout, R > 0 there.

use pleach_automaton::network::record::Route;
use pleach_continuous::Point;

/// R as eq. (27) has it: 1 up to `full_range` (l), 0 from `max_range` (u) on, and the cubic
/// 1 − 3s² + 2s³ with s = (d − l) / (u − l) between.
///
/// This is the statement that reported reliabilities are held against; it shares no code with
/// the radio of the robots.
///
/// ```
/// use pleach_verify::network::link::reliability;
///
/// assert_eq!(reliability(0.4, 0.4, 0.5), 1.0);
/// assert!((reliability(0.45, 0.4, 0.5) - 0.5).abs() < 1e-12);
/// assert_eq!(reliability(0.5, 0.4, 0.5), 0.0);
/// ```
pub fn reliability(distance: f64, full_range: f64, max_range: f64) -> f64 {
    if distance <= full_range {
        1.0
    } else if distance < max_range {
        let s = (distance - full_range) / (max_range - full_range);
        (1.0 - s) * (1.0 - s) * (1.0 + 2.0 * s)
    } else {
        0.0
    }
}

/// c_i of every robot, eq. (4): what it sends, less what it receives, less its own rate r_i.
///
/// A route with an end that is no robot counts for its other end only.
pub fn residuals(routes: &[Route], rates: &[f64]) -> Vec<f64> {
    let mut residuals: Vec<f64> = rates.iter().map(|rate| -rate).collect();
    for route in routes {
        let flow = route.share * route.reliability;
        if let Some(sender) = residuals.get_mut(route.from) {
            *sender += flow;
        }
        if let Some(receiver) = residuals.get_mut(route.to) {
            *receiver -= flow;
        }
    }
    residuals
}

/// A flow held by a sender, and the distance over which it goes now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldFlow {
    /// F_ij = T_ij R_ij when the period began.
    pub flow: f64,
    /// ‖x_i − x_j‖ now.
    pub distance: f64,
}

/// h = Σ F / R: the share of its time that a sender needs to hold its flows.
///
/// Infinite if a link in use is out of range. `reliability` is R of the distance.
pub fn load(flows: &[HeldFlow], reliability: impl Fn(f64) -> f64) -> f64 {
    let in_use = flows.iter().filter(|held| held.flow > 0.0);
    in_use.fold(0.0, |load, held| load + held.flow / reliability(held.distance))
}

/// The places of the nodes: robots first, then access points.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodePositions<'a> {
    /// x_1 … x_N.
    pub robots: &'a [Point],
    /// Where the access points stand.
    pub access_points: &'a [Point],
}

impl NodePositions<'_> {
    /// Where a node is, if there is one of that number.
    pub(super) fn of(&self, node: usize) -> Option<Point> {
        let fixed = || self.access_points.get(node - self.robots.len());
        self.robots.get(node).or_else(fixed).copied()
    }

    /// The distance of two nodes; infinite if one does not exist.
    pub(super) fn distance(&self, one: usize, other: usize) -> f64 {
        match (self.of(one), self.of(other)) {
            (Some(one), Some(other)) => (one - other).norm(),
            _ => f64::INFINITY,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::point;
    use pleach_continuous::geometry::Segment;
    use pleach_continuous::network::acceptance::worst_load;
    use pleach_continuous::network::{CubicReliability, LinkReliability};
    use proptest::prelude::*;

    #[test]
    fn reliability_is_that_of_the_printed_cubic() {
        let (l, u): (f64, f64) = (0.4, 0.5);
        for step in 1..100 {
            let d = l + (u - l) * f64::from(step) / 100.0;
            let cube = (u - l).powi(3);
            let printed = 2.0 * d.powi(3) / cube - 3.0 * (l + u) * d * d / cube
                + 6.0 * l * u * d / cube
                + (u.powi(3) - 3.0 * l * u * u) / cube;
            assert!((reliability(d, l, u) - printed).abs() < 1e-9, "{d}");
        }
    }

    #[test]
    fn a_relay_passes_on_what_it_receives() {
        let route = |from, to, share| Route { from, to, share, reliability: 0.5 };
        let routes = [route(0, 1, 0.5), route(1, 2, 1.0)];
        assert_eq!(residuals(&routes, &[0.25, 0.125]), [0.0, 0.125]);
    }

    fn place() -> impl Strategy<Value = Point> {
        (-0.3..0.3, -0.3..0.3).prop_map(|(x, y)| point![x, y])
    }

    fn motion() -> impl Strategy<Value = Segment> {
        (place(), place()).prop_map(|(from, to)| Segment { from, to })
    }

    proptest! {
        /// The lemma of this module, against dense sampling.
        #[test]
        fn the_load_is_largest_at_an_end(
            sender in motion(),
            receivers in prop::collection::vec((motion(), 0.0..0.3), 1..5),
        ) {
            let (l, u) = (0.3, 0.9);
            let load_at = |s: f64| {
                let held: Vec<_> = receivers
                    .iter()
                    .map(|(receiver, flow)| HeldFlow {
                        flow: *flow,
                        distance: (sender.at(s) - receiver.at(s)).norm(),
                    })
                    .collect();
                load(&held, |distance| reliability(distance, l, u))
            };
            let ends = load_at(0.0).max(load_at(1.0));
            for sample in 1..200 {
                prop_assert!(load_at(f64::from(sample) / 200.0) <= ends + 1e-12);
            }
        }
    }

    proptest! {
        /// The radio of the robots, and their acceptance of moves, against the statements here.
        #[test]
        fn the_robots_reckon_alike(
            sender in motion(),
            receivers in prop::collection::vec((motion(), 0.0..0.3), 1..5),
        ) {
            let (l, u) = (0.3, 0.9);
            let radio = CubicReliability::new(l, u).unwrap();
            let (mut accepted, mut held) = (Vec::new(), [Vec::new(), Vec::new()]);
            for (receiver, flow) in receivers {
                accepted.push((flow, receiver));
                for (end, share) in [0.0, 1.0].into_iter().enumerate() {
                    let distance = (sender.at(share) - receiver.at(share)).norm();
                    let stated = reliability(distance, l, u);
                    prop_assert!((stated - radio.reliability(distance)).abs() < 1e-12);
                    held[end].push(HeldFlow { flow, distance });
                }
            }
            let worst = held.iter().map(|held| load(held, |distance| reliability(distance, l, u))).fold(0.0, f64::max);
            prop_assert!(worst <= worst_load(sender, &accepted, &radio) + 1e-12);
        }
    }

    #[test]
    fn a_flow_out_of_range_needs_endless_time() {
        let study = |distance| reliability(distance, 0.4, 0.5);
        let held = [HeldFlow { flow: 0.1, distance: 0.5 }];
        assert_eq!(load(&held, study), f64::INFINITY);
        let idle = [HeldFlow { flow: 0.0, distance: 0.5 }];
        assert_eq!(load(&idle, study), 0.0);
    }
}
