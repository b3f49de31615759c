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
use thiserror::Error;

/// One end of a link as seen from a sender.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Receiver {
    /// The robot with this index.
    Robot(usize),
    /// The access point with this index.
    AccessPoint(usize),
}

/// A routing variable T_ij > 0 of one sender.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Route {
    /// j: the receiver.
    pub receiver: Receiver,
    /// T_ij: the share of the sender's time, in [0, 1].
    pub share: f64,
}

/// F = T·R: what arrives of a time share over a link.
pub fn flow(share: f64, reliability: f64) -> f64 {
    share * reliability
}

/// c_i of eq. (5), from the flows out of a robot, the flows into it and its own rate r_i.
pub fn residual(
    outflows: impl IntoIterator<Item = f64>,
    inflows: impl IntoIterator<Item = f64>,
    rate: f64,
) -> f64 {
    let outflow: f64 = outflows.into_iter().sum();
    let inflow: f64 = inflows.into_iter().sum();
    outflow - inflow - rate
}

/// ∇R(‖x − y‖) with respect to x = `own`, per unit of length; zero where both coincide.
pub fn reliability_gradient(
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

/// ∇_{x_i} c_j at fixed shares: how the residual of neighbour j changes when robot i moves.
pub fn neighbour_residual_gradient(
    own: Point,
    exchange: &NeighbourTraffic,
    link: &(impl LinkReliability + ?Sized),
) -> Vector {
    reliability_gradient(own, exchange.neighbour, link) * (exchange.received - exchange.sent)
}

/// Why routes and positions do not fit together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RatesError {
    /// Lists about the robots have different lengths.
    #[error("{robots} robots, but {routes} lists of routes and {rates} rates: one of each is due")]
    Lengths {
        /// Number of robot positions.
        robots: usize,
        /// Number of route lists.
        routes: usize,
        /// Number of rates.
        rates: usize,
    },
    /// A route leads to somebody who does not exist.
    #[error("robot {sender} has a route to {receiver:?}, which does not exist")]
    UnknownReceiver {
        /// The sender.
        sender: usize,
        /// The receiver.
        receiver: Receiver,
    },
}

/// Every residual c_i, eq. (5), for observers and tests: no robot has this view.
///
/// `routes[i]`, `robots[i]` and `rates[i]` belong to robot i.
///
/// # Errors
///
/// [`RatesError`] if the lists differ in length or a route leads to no node.
pub fn residuals(
    routes: &[Vec<Route>],
    robots: &[Point],
    access_points: &[Point],
    rates: &[f64],
    link: &(impl LinkReliability + ?Sized),
) -> Result<Vec<f64>, RatesError> {
    if routes.len() != robots.len() || rates.len() != robots.len() {
        return Err(RatesError::Lengths {
            robots: robots.len(),
            routes: routes.len(),
            rates: rates.len(),
        });
    }
    let mut residuals: Vec<f64> = rates.iter().map(|rate| -rate).collect();
    for (sender, own_routes) in routes.iter().enumerate() {
        for route in own_routes {
            let place = match route.receiver {
                Receiver::Robot(index) => robots.get(index),
                Receiver::AccessPoint(index) => access_points.get(index),
            };
            let place =
                place.ok_or(RatesError::UnknownReceiver { sender, receiver: route.receiver })?;
            let reliability = link.reliability((robots[sender] - place).norm());
            let carried = flow(route.share, reliability);
            residuals[sender] += carried;
            if let Receiver::Robot(index) = route.receiver {
                residuals[index] -= carried;
            }
        }
    }
    Ok(residuals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::CubicReliability;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point> {
        (0.0..1.0f64, 0.0..1.0f64).prop_map(|(x, y)| Point::new(x, y))
    }

    /// Three robots and one access point with all routes; T from an array of nine shares.
    fn routes(shares: &[f64]) -> Vec<Vec<Route>> {
        let receivers = |own: usize| {
            (0..3)
                .filter(move |other| *other != own)
                .map(Receiver::Robot)
                .chain([Receiver::AccessPoint(0)])
        };
        (0..3)
            .map(|own| {
                let own_shares = shares[3 * own..].iter();
                receivers(own)
                    .zip(own_shares)
                    .map(|(receiver, &share)| Route { receiver, share })
                    .collect()
            })
            .collect()
    }

    proptest! {
        /// Both gradients agree with differences of the central residuals.
        #[test]
        fn gradients_agree_with_finite_differences(
            robots in prop::array::uniform3(point()),
            access_point in point(),
            shares in prop::collection::vec(0.0..0.4f64, 9),
        ) {
            let link = CubicReliability::new(0.2, 1.0).unwrap();
            let routes = routes(&shares);
            let share = |from: usize, to: Receiver| {
                routes[from].iter().find(|route| route.receiver == to).map_or(0.0, |r| r.share)
            };
            let to_robot = |other: usize| NeighbourTraffic {
                neighbour: robots[other],
                sent: share(0, Receiver::Robot(other)),
                received: share(other, Receiver::Robot(0)),
            };
            let to_access_point = NeighbourTraffic {
                neighbour: access_point,
                sent: share(0, Receiver::AccessPoint(0)),
                received: 0.0,
            };
            let exchanges = [to_robot(1), to_robot(2), to_access_point];
            let own = residual_gradient(robots[0], exchanges, &link);
            let of_neighbour = neighbour_residual_gradient(robots[0], &exchanges[0], &link);
            for axis in 0..2 {
                let step = 1e-6;
                let at = |offset: f64| {
                    let mut moved = robots;
                    moved[0].coords[axis] += offset;
                    residuals(&routes, &moved, &[access_point], &[0.075; 3], &link).unwrap()
                };
                let (after, before) = (at(step), at(-step));
                let slope = |index: usize| (after[index] - before[index]) / (2.0 * step);
                prop_assert!((slope(0) - own[axis]).abs() < 1e-4);
                prop_assert!((slope(1) - of_neighbour[axis]).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn residual_is_outflow_minus_inflow_minus_rate() {
        let value = residual([flow(0.5, 0.8), 0.1], [0.2], 0.075);
        assert!((value - 0.225).abs() < 1e-15);
    }

    #[test]
    fn a_route_to_no_node_is_an_error() {
        let link = CubicReliability::new(0.4, 0.5).unwrap();
        let routes = vec![vec![Route { receiver: Receiver::AccessPoint(1), share: 0.5 }]];
        let result = residuals(&routes, &[Point::origin()], &[Point::origin()], &[0.1], &link);
        let receiver = Receiver::AccessPoint(1);
        assert_eq!(result, Err(RatesError::UnknownReceiver { sender: 0, receiver }));
    }
}
