//! The Accelerated Distributed Augmented Lagrangian method (ADAL) of Remark 3.1.
//!
//! Chatzipanagiotis, Dentcheva and Zavlanos, "An augmented Lagrangian method for distributed
//! optimization", DOI 10.1007/s10107-014-0808-7. With slacks s_i ≥ 0 the reserve is an equation,
//! one per robot, whose *mismatch* every robot measures from its own flows:
//!
//! ```text
//! e_i = c_i(T) − η − s_i = 0.
//! ```
//!
//! In every iteration each robot
//!
//! 1. sends its [`report`](AdalRobot::report) to its neighbours: λ_i, e_i and q_i;
//! 2. minimises its local augmented Lagrangian over its own T_ij ≥ 0, Σ_j T_ij ≤ 1 and s_i ≥ 0, with
//!    the variables of all others as they are,
//!
//!    ```text
//!    Σ_j [w_ij T_ij² − (λ_i − λ_j) R_ij T_ij] + λ_i s_i + ρ/2 (ê_i² + Σ_j ê_j²),
//!    ```
//!
//!    where ê are the mismatches that its own change alone would bring about, and goes a part τ of
//!    the way there ([`primal_step`](AdalRobot::primal_step));
//! 3. learns the new flows into it and steps λ_i ← λ_i − ρτ e_i with the new mismatch
//!    ([`dual_step`](AdalRobot::dual_step)).
//!
//! The paper proves convergence for one τ below 1/q, where q is the largest number of robots whose
//! variables meet in one equation. That number would have to be known to all in advance, so robots
//! choose for themselves: q_i = 1 + Σ_j R_ij over neighbouring robots, and τ from the largest q among
//! a robot and its neighbours. With the [default settings](AdalSettings::default) this converged on
//! every network tried, dense and sparse, where a common τ large enough to be useful did not.

use serde::{Deserialize, Serialize};

use super::TIME_BUDGET;
use super::dual::MULTIPLIER_CAP;
use super::local::{LinkOffer, budget_price, share};

/// The two numbers of the method, common to all robots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdalSettings {
    /// ρ > 0: the price of a mismatch squared.
    pub penalty: f64,
    /// τ·q: robots go the share τ = `relaxation`/q of the way to their minimisers, at most 0.7.
    pub relaxation: f64,
}

impl Default for AdalSettings {
    /// ρ = 8 and τ = 1.25/q. On 4,800 random networks of up to 8 robots and chains of 13, a larger ρ
    /// up to 8 always needed fewer iterations; τ = 1.5/q still converged on all, 2/q failed on 2 %.
    fn default() -> Self {
        Self { penalty: 8.0, relaxation: 1.25 }
    }
}

/// Largest τ. Two robots that hear each other faintly have q near 1, yet both answer to the same
/// two equations: τ near 1 lets them overshoot in turns for ever, which was seen.
const LONGEST_PART: f64 = 0.7;

impl AdalSettings {
    /// τ of a variable that enters equations with this largest q.
    fn part_of_the_way(&self, crowding: f64) -> f64 {
        (self.relaxation / crowding).min(LONGEST_PART)
    }
}

/// What a robot sends to its neighbours in every iteration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NeighbourReport {
    /// λ_j.
    pub multiplier: f64,
    /// e_j.
    pub mismatch: f64,
    /// q_j.
    pub crowding: f64,
}

/// A link as its sender sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdalLink {
    /// R_ij, in [0, 1].
    pub reliability: f64,
    /// w_ij > 0.
    pub weight: f64,
    /// T_ij.
    pub share: f64,
    /// What the neighbour sent; `None` for an access point, which has no equation.
    pub report: Option<NeighbourReport>,
}

/// A robot's own variables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdalRobot {
    /// λ_i.
    multiplier: f64,
    /// e_i = c_i − η − s_i.
    mismatch: f64,
    /// s_i ≥ 0.
    slack: f64,
    /// q_i ≥ 1.
    crowding: f64,
}

/// Buffers that robots reuse from iteration to iteration.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    offers: Vec<LinkOffer>,
    minimiser: Vec<f64>,
}

impl Default for AdalRobot {
    /// A robot that has neither heard nor sent anything.
    fn default() -> Self {
        Self { multiplier: 0.0, mismatch: 0.0, slack: 0.0, crowding: 1.0 }
    }
}

impl AdalRobot {
    /// λ_i.
    pub fn multiplier(&self) -> f64 {
        self.multiplier
    }

    /// What the robot sends.
    pub fn report(&self) -> NeighbourReport {
        let &Self { multiplier, mismatch, crowding, .. } = self;
        NeighbourReport { multiplier, mismatch, crowding }
    }

    /// Measures e_i from the residual c_i and the reserve η, and q_i from the reliabilities of the
    /// links with other robots. Due before the first report of a period, since robots have moved.
    pub fn measure(
        &mut self,
        residual: f64,
        reserve: f64,
        reliabilities: impl IntoIterator<Item = f64>,
    ) {
        self.mismatch = residual - reserve - self.slack;
        self.crowding = 1.0 + reliabilities.into_iter().sum::<f64>();
    }

    /// Moves the shares of the robot's links and its slack towards the local minimiser.
    pub fn primal_step(
        &mut self,
        links: &mut [AdalLink],
        settings: &AdalSettings,
        workspace: &mut Workspace,
    ) {
        let slack = self.minimise(links, settings.penalty, workspace);
        let reports = links.iter().filter_map(|link| link.report);
        let crowding = reports.fold(self.crowding, |most, report| most.max(report.crowding));
        // One part for all shares of a robot: a mean of two points within the budget is within it.
        let part = settings.part_of_the_way(crowding);
        for (link, minimiser) in links.iter_mut().zip(&workspace.minimiser) {
            link.share += part * (minimiser - link.share);
        }
        self.slack += part * (slack - self.slack);
    }

    /// λ_i ← λ_i − ρτ e_i after the neighbours' primal steps, with the new residual c_i and the
    /// reserve η. λ_i is kept within ±[`MULTIPLIER_CAP`].
    pub fn dual_step(&mut self, residual: f64, reserve: f64, settings: &AdalSettings) {
        self.mismatch = residual - reserve - self.slack;
        let step = settings.penalty * settings.part_of_the_way(self.crowding);
        let stepped = self.multiplier - step * self.mismatch;
        self.multiplier = stepped.clamp(-MULTIPLIER_CAP, MULTIPLIER_CAP);
    }

    /// The minimiser of the local augmented Lagrangian: leaves T̂_ij in the workspace, returns ŝ_i.
    ///
    /// With the price p = λ_i − ρ ê_i the optimality conditions are those of the primal iteration
    /// (12)–(13), with p for λ_i, w_ij + ρR_ij²/2 for the weights and λ_j − ρ(e_j + R_ij T_ij) for
    /// the neighbours' multipliers (access points: w_ij and 0), together with p ≥ 0, s ≥ 0, p·s = 0.
    /// So only p is sought, the root of p + ρ·outflow(p) = λ_i − ρ·(ê_i without outflow and slack),
    /// whose left side increases at a slope of at least 1 and is piecewise linear: Newton's method,
    /// kept within a bracket, ends exactly on the right piece.
    fn minimise(&self, links: &[AdalLink], penalty: f64, workspace: &mut Workspace) -> f64 {
        let Workspace { offers, minimiser } = workspace;
        offers.clear();
        offers.extend(links.iter().map(|link| augmented_offer(link, penalty)));
        let outflow_now: f64 = links.iter().map(|link| link.share * link.reliability).sum();
        // ê_i = base + outflow − slack.
        let base = self.mismatch - outflow_now + self.slack;
        let balance = Balance { offers, penalty };
        let price = balance.price(self.multiplier - penalty * base);
        let time_price = budget_price(price, offers, TIME_BUDGET);
        minimiser.clear();
        minimiser.extend(offers.iter().map(|offer| share(offer, price, time_price)));
        if price > 0.0 {
            return 0.0;
        }
        let shares = links.iter().zip(minimiser.iter());
        let outflow: f64 = shares.map(|(link, share)| link.reliability * share).sum();
        (base + outflow - self.multiplier / penalty).max(0.0)
    }
}

/// What a link is worth with the penalty on the neighbour's mismatch completed to a square.
fn augmented_offer(link: &AdalLink, penalty: f64) -> LinkOffer {
    let &AdalLink { reliability, weight, share, report } = link;
    match report {
        None => LinkOffer { reliability, weight, neighbour_multiplier: 0.0 },
        Some(NeighbourReport { multiplier, mismatch, .. }) => LinkOffer {
            reliability,
            weight: weight + 0.5 * penalty * reliability * reliability,
            neighbour_multiplier: multiplier - penalty * (mismatch + reliability * share),
        },
    }
}

/// The equation p + ρ·outflow(p) = target of one robot.
struct Balance<'a> {
    offers: &'a [LinkOffer],
    penalty: f64,
}

impl Balance<'_> {
    /// Steps of the root search: far more than a handful of links has linear pieces; the bracket
    /// halves at worst, so that 60 steps leave 1e-18 of it.
    const STEPS: usize = 60;

    /// An imbalance of this size, in units of the multiplier, is rounding.
    const ROUNDING: f64 = 1e-13;

    /// The root, or 0 if the left side exceeds the target already there.
    fn price(&self, target: f64) -> f64 {
        let (excess, _) = self.excess_and_slope(0.0, target);
        if excess >= 0.0 {
            return 0.0;
        }
        // The slope is at least 1: the root lies within [0, −excess].
        let (mut low, mut high) = (0.0, -excess);
        let mut price = high;
        for _ in 0..Self::STEPS {
            let (excess, slope) = self.excess_and_slope(price, target);
            if excess.abs() <= Self::ROUNDING * (1.0 + target.abs()) {
                break;
            }
            if excess > 0.0 {
                high = price;
            } else {
                low = price;
            }
            let newton = price - excess / slope;
            price = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        }
        price
    }

    /// p + ρ·outflow(p) − target and its slope in p.
    fn excess_and_slope(&self, price: f64, target: f64) -> (f64, f64) {
        let time_price = budget_price(price, self.offers, TIME_BUDGET);
        // Over the links in use: Σ R T, Σ R²/2w, Σ R/2w and Σ 1/2w.
        let (mut outflow, mut own, mut mixed, mut time) = (0.0, 0.0, 0.0, 0.0);
        for offer in self.offers {
            let share = share(offer, price, time_price);
            if share > 0.0 {
                let response = 0.5 / offer.weight;
                outflow += offer.reliability * share;
                own += offer.reliability * offer.reliability * response;
                mixed += offer.reliability * response;
                time += response;
            }
        }
        // On a full budget a dearer robot only shifts time towards its better links.
        let shifted = if time_price > 0.0 && time > 0.0 { mixed * mixed / time } else { 0.0 };
        let slope = 1.0 + self.penalty * (own - shifted).max(0.0);
        (price + self.penalty * outflow - target, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn links() -> impl Strategy<Value = Vec<AdalLink>> {
        let report = prop::option::of((0.0..3.0f64, -0.5..0.5f64));
        let link = (0.05..=1.0f64, 0.5..10.0f64, 0.0..0.3f64, report);
        prop::collection::vec(link, 1..6).prop_map(|links| {
            let build = |(reliability, weight, share, report): (_, _, _, Option<_>)| AdalLink {
                reliability,
                weight,
                share,
                report: report.map(|(multiplier, mismatch)| NeighbourReport {
                    multiplier,
                    mismatch,
                    crowding: 1.0,
                }),
            };
            links.into_iter().map(build).collect()
        })
    }

    /// e_i = c_i − η − s_i and q_i = 1 + Σ R_ij.
    #[test]
    fn a_robot_reports_what_it_measures() {
        let mut robot = AdalRobot { slack: 0.125, ..AdalRobot::default() };
        robot.measure(0.5, 0.25, [0.5, 0.25]);
        let NeighbourReport { multiplier, mismatch, crowding } = robot.report();
        assert_eq!((multiplier, mismatch, crowding), (robot.multiplier(), 0.125, 1.75));
    }

    /// The local augmented Lagrangian, by its definition.
    fn lagrangian(
        robot: &AdalRobot,
        links: &[AdalLink],
        penalty: f64,
        shares: &[f64],
        slack: f64,
    ) -> f64 {
        let mut own = robot.mismatch - (slack - robot.slack);
        let mut value = robot.multiplier * slack;
        for (link, &share) in links.iter().zip(shares) {
            let change = link.reliability * (share - link.share);
            own += change;
            value += link.weight * share * share - robot.multiplier * link.reliability * share;
            if let Some(report) = link.report {
                value += report.multiplier * link.reliability * share;
                value += 0.5 * penalty * (report.mismatch - change).powi(2);
            }
        }
        value + 0.5 * penalty * own * own
    }

    proptest! {
        /// A convex function is minimal where no feasible direction between variables descends.
        #[test]
        fn no_feasible_change_lowers_the_augmented_lagrangian(
            links in links(),
            multiplier in -1.0..6.0f64,
            mismatch in -1.0..1.0f64,
            slack in 0.0..0.5f64,
            penalty in 0.1..10.0f64,
            others in prop::collection::vec((prop::collection::vec(0.0..1.0f64, 6), 0.0..1.0f64), 30),
        ) {
            let robot = AdalRobot { multiplier, mismatch, slack, crowding: 1.0 };
            let mut workspace = Workspace::default();
            let best = robot.minimise(&links, penalty, &mut workspace);
            let shares = &workspace.minimiser;
            prop_assert!(best >= 0.0 && shares.iter().all(|share| *share >= 0.0));
            prop_assert!(shares.iter().sum::<f64>() <= 1.0 + 1e-12);
            let least = lagrangian(&robot, &links, penalty, shares, best);
            for (other, other_slack) in others {
                let total: f64 = other[..links.len()].iter().sum::<f64>().max(1.0);
                for step in [1.0, 1e-2, 1e-4] {
                    let moved: Vec<f64> = shares
                        .iter()
                        .zip(&other)
                        .map(|(share, other)| share + step * (other / total - share))
                        .collect();
                    let moved_slack = best + step * (other_slack - best);
                    let value = lagrangian(&robot, &links, penalty, &moved, moved_slack);
                    prop_assert!(value >= least - 1e-11, "{value} < {least}");
                }
            }
        }
    }
}
