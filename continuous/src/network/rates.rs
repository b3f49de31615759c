//! Rates of information: what a robot sends, receives and generates, eqs. (3)–(5).
//!
//! Rates are shares of the radio's rate R₀ = 1. Robot i sends a flow F_ij = T_ij R_ij to each
//! neighbour j, and its *residual*
//!
//! ```text
//! c_i = Σ_j T_ij R_ij − Σ_j T_ji R_ji − r_i
//! ```
//!
//! is outflow minus inflow minus its own rate. c_i ≥ 0 keeps its queue from growing, eq. (5).
//! The sums leave out j = i: a robot does not send to itself.

use super::reliability::LinkReliability;
use crate::{Point, Vector};

/// One end of a link as seen from a sender.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Receiver {
    /// The robot with this index.
    Robot(usize),
    /// The access point with this index.
    AccessPoint(usize),
}

/// ∇R(‖x − y‖) with respect to x = `own`, per unit of length; zero where both coincide.
fn reliability_gradient(
    own: Point,
    other: Point,
    link: &(impl LinkReliability + ?Sized),
) -> Vector {
    let difference = own - other;
    let distance = difference.norm();
    if distance > 0.0 { difference * (link.slope(distance) / distance) } else { Vector::zeros() }
}

/// The traffic between a robot and one neighbour, in both directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeighbourTraffic {
    /// x_j: where the neighbour is.
    pub neighbour: Point,
    /// T_ij: the share that the robot gives to the neighbour.
    pub sent: f64,
    /// T_ji: the share that the neighbour gives to the robot; 0 for an access point.
    pub received: f64,
}

/// ∇_{x_i} c_i of eq. (22) at fixed shares: Σ_j (T_ij − T_ji) ∇_{x_i} R_ij.
pub fn residual_gradient(
    own: Point,
    exchanges: impl IntoIterator<Item = NeighbourTraffic>,
    link: &(impl LinkReliability + ?Sized),
) -> Vector {
    exchanges.into_iter().fold(Vector::zeros(), |sum, exchange| {
        let gradient = reliability_gradient(own, exchange.neighbour, link);
        sum + gradient * (exchange.sent - exchange.received)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::CubicReliability;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point> {
        (0.0..1.0f64, 0.0..1.0f64).prop_map(|(x, y)| Point::new(x, y))
    }

    proptest! {
        /// The gradient agrees with differences of Σ_j (T_ij − T_ji) R_ij, that is, of c_i + r_i.
        #[test]
        fn the_gradient_agrees_with_finite_differences(
            own in point(),
            neighbours in prop::collection::vec((point(), 0.0..0.4f64, 0.0..0.4f64), 1..4),
        ) {
            let link = CubicReliability::new(0.2, 1.0).unwrap();
            let exchanges = neighbours.into_iter().map(|(neighbour, sent, received)| {
                NeighbourTraffic { neighbour, sent, received }
            });
            let outflow = |place: Point| -> f64 {
                let net = |exchange: NeighbourTraffic| {
                    let distance = (place - exchange.neighbour).norm();
                    (exchange.sent - exchange.received) * link.reliability(distance)
                };
                exchanges.clone().map(net).sum()
            };
            let gradient = residual_gradient(own, exchanges.clone(), &link);
            for axis in 0..2 {
                let step = 1e-6;
                let at = |offset: f64| {
                    let mut moved = own;
                    moved.coords[axis] += offset;
                    outflow(moved)
                };
                let slope = (at(step) - at(-step)) / (2.0 * step);
                prop_assert!((slope - gradient[axis]).abs() < 1e-4);
            }
        }
    }
}
