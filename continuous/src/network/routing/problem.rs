//! Problem (6) for a whole network, as observers, tests and benchmarks see it.

use super::local::weight;
use crate::Point;
use crate::network::LinkReliability;
use crate::network::rates::Receiver;
use thiserror::Error;

/// A link with R_ij > 0 from a robot to a receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectedLink {
    /// i: index of the sending robot.
    pub sender: usize,
    /// j: the receiver.
    pub receiver: Receiver,
    /// R_ij, in (0, 1].
    pub reliability: f64,
    /// w_ij > 0.
    pub weight: f64,
}

/// The routing problem (6) with V = w T² and a reserve: links, rates r_i and η.
#[derive(Clone, Debug, PartialEq)]
pub struct RoutingProblem {
    links: Vec<DirectedLink>,
    rates: Vec<f64>,
    reserve: f64,
}

/// Why numbers do not make a routing problem.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// A rate is negative or not a number.
    #[error("robot {robot} has the rate {rate}: it must be finite and at least 0")]
    Rate {
        /// Which robot.
        robot: usize,
        /// Its rate.
        rate: f64,
    },
    /// The reserve is not a number.
    #[error("the reserve is {reserve}: it must be finite")]
    Reserve {
        /// What was given as η.
        reserve: f64,
    },
    /// A link names a robot that does not exist, or leads from a robot to itself.
    #[error("link {link} leads from robot {sender} to {receiver:?}: both must exist and differ")]
    Ends {
        /// Index of the link.
        link: usize,
        /// Its sender.
        sender: usize,
        /// Its receiver.
        receiver: Receiver,
    },
    /// A link has numbers out of range.
    #[error(
        "link {link} has reliability {reliability} and weight {weight}: the first must lie in \
         (0, 1], the second must be positive and finite"
    )]
    Link {
        /// Index of the link.
        link: usize,
        /// Its reliability.
        reliability: f64,
        /// Its weight.
        weight: f64,
    },
    /// Lists about the robots have different lengths.
    #[error("{robots} robots, but {rates} rates: one each is due")]
    Lengths {
        /// Number of robots.
        robots: usize,
        /// Number of rates.
        rates: usize,
    },
}

impl RoutingProblem {
    /// The problem with these links; `rates[i]` is r_i and `reserve` is η.
    ///
    /// # Errors
    ///
    /// [`ProblemError`] for numbers out of range and links without two ends.
    pub fn new(
        links: Vec<DirectedLink>,
        rates: Vec<f64>,
        reserve: f64,
    ) -> Result<Self, ProblemError> {
        if !reserve.is_finite() {
            return Err(ProblemError::Reserve { reserve });
        }
        for (robot, &rate) in rates.iter().enumerate() {
            if !(rate.is_finite() && rate >= 0.0) {
                return Err(ProblemError::Rate { robot, rate });
            }
        }
        for (index, &DirectedLink { sender, receiver, reliability, weight }) in
            links.iter().enumerate()
        {
            let robots = rates.len();
            let receives = match receiver {
                Receiver::Robot(robot) => robot < robots && robot != sender,
                Receiver::AccessPoint(_) => true,
            };
            if sender >= robots || !receives {
                return Err(ProblemError::Ends { link: index, sender, receiver });
            }
            let carries = reliability > 0.0 && reliability <= 1.0;
            if !(carries && weight > 0.0 && weight.is_finite()) {
                return Err(ProblemError::Link { link: index, reliability, weight });
            }
        }
        Ok(Self { links, rates, reserve })
    }

    /// The problem of robots at these places: every link with R > 0, weighted with the slope
    /// aversion κ. All pairs are looked at.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new), and if there is not one rate per robot.
    pub fn of_places(
        robots: &[Point],
        access_points: &[Point],
        rates: &[f64],
        link: &(impl LinkReliability + ?Sized),
        slope_aversion: f64,
        reserve: f64,
    ) -> Result<Self, ProblemError> {
        if rates.len() != robots.len() {
            return Err(ProblemError::Lengths { robots: robots.len(), rates: rates.len() });
        }
        let mut links = Vec::new();
        for (sender, place) in robots.iter().enumerate() {
            let others = robots.iter().enumerate().map(|(j, p)| (Receiver::Robot(j), p));
            let sinks =
                access_points.iter().enumerate().map(|(j, p)| (Receiver::AccessPoint(j), p));
            for (receiver, other) in others.chain(sinks) {
                let distance = (place - other).norm();
                let reliability = link.reliability(distance);
                if receiver != Receiver::Robot(sender) && reliability > 0.0 {
                    let weight = weight(slope_aversion, link, distance);
                    links.push(DirectedLink { sender, receiver, reliability, weight });
                }
            }
        }
        Self::new(links, rates.to_vec(), reserve)
    }

    /// The links, in the order in which shares are listed.
    pub fn links(&self) -> &[DirectedLink] {
        &self.links
    }

    /// r_i of every robot.
    pub fn rates(&self) -> &[f64] {
        &self.rates
    }

    /// η.
    pub fn reserve(&self) -> f64 {
        self.reserve
    }

    /// Number of robots.
    pub fn robots(&self) -> usize {
        self.rates.len()
    }

    /// Σ w T² of shares listed in the order of the links.
    pub fn objective(&self, shares: &[f64]) -> f64 {
        self.links.iter().zip(shares).map(|(link, share)| link.weight * share * share).sum()
    }

    /// Every residual c_i of shares listed in the order of the links.
    pub fn residuals(&self, shares: &[f64]) -> Vec<f64> {
        let mut residuals: Vec<f64> = self.rates.iter().map(|rate| -rate).collect();
        for (link, share) in self.links.iter().zip(shares) {
            residuals[link.sender] += link.reliability * share;
            if let Receiver::Robot(receiver) = link.receiver {
                residuals[receiver] -= link.reliability * share;
            }
        }
        residuals
    }

    /// Σ_j T_ij of every robot, for shares listed in the order of the links.
    pub fn used_time(&self, shares: &[f64]) -> Vec<f64> {
        let mut used = vec![0.0; self.robots()];
        for (link, share) in self.links.iter().zip(shares) {
            used[link.sender] += share;
        }
        used
    }
}
