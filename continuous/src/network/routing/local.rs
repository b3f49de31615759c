//! The primal iteration (12)–(13): one robot's shares, given its neighbours' multipliers.

use crate::network::LinkReliability;

#[cfg(any(kani, test))]
mod proofs;

/// A link as its sender sees it when it computes its shares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkOffer {
    /// R_ij, in [0, 1].
    pub reliability: f64,
    /// w_ij > 0: the price of a share squared.
    pub weight: f64,
    /// λ_j ≥ 0 as the neighbour sent it; 0 for an access point.
    pub neighbour_multiplier: f64,
}

impl LinkOffer {
    /// b_ij = R_ij(λ_i − λ_j): what a unit of share is worth to a robot with this multiplier.
    fn value(&self, multiplier: f64) -> f64 {
        self.reliability * (multiplier - self.neighbour_multiplier)
    }
}

/// w_ij = 1 + κ(u − l)|R'(d)|: the weight of a link at a distance.
///
/// Any w_ij > 0 serves in (6). With equal weights traffic spreads over links whose reliability
/// falls steeply with distance, and these then forbid motion; `slope_aversion` (κ ≥ 0) keeps
/// traffic on links that do not change when their ends move.
pub fn weight(slope_aversion: f64, link: &(impl LinkReliability + ?Sized), distance: f64) -> f64 {
    let transition = link.range() - link.full_range();
    1.0 + slope_aversion * transition * link.slope(distance).abs()
}

/// The minimiser of the local Lagrangian (12)–(13) over {T ≥ 0, Σ_j T_ij ≤ `budget`}.
///
/// `shares[j]` becomes T_ij = [R_ij(λ_i − λ_j) − μ_i]₊ / (2 w_ij) for the j-th link, with the least
/// μ_i ≥ 0 that keeps the budget. `shares` is cleared and refilled, so that a reused buffer costs
/// no allocation. Returns μ_i.
///
/// μ_i is the root of Σ_j [b_j − μ]₊/(2w_j) = budget, whose left side is convex, decreasing and
/// piecewise linear: Newton's method from the left rises to the root in at most as many steps as
/// there are links and ends exactly on the right piece, without a sort.
///
/// ```
/// use pleach_continuous::network::routing::local::{LinkOffer, local_minimiser};
///
/// let links = [
///     LinkOffer { reliability: 1.0, weight: 1.0, neighbour_multiplier: 0.0 },
///     LinkOffer { reliability: 0.5, weight: 1.0, neighbour_multiplier: 0.2 },
/// ];
/// let mut shares = Vec::new();
/// let budget_price = local_minimiser(0.6, &links, 1.0, &mut shares);
/// assert_eq!(budget_price, 0.0);
/// assert!((shares[0] - 0.3).abs() < 1e-12 && (shares[1] - 0.1).abs() < 1e-12);
/// ```
pub fn local_minimiser(
    multiplier: f64,
    links: &[LinkOffer],
    budget: f64,
    shares: &mut Vec<f64>,
) -> f64 {
    let budget_price = budget_price(multiplier, links, budget);
    shares.clear();
    shares.extend(links.iter().map(|link| share(link, multiplier, budget_price)));
    budget_price
}

/// [b − μ]₊ / (2w); zero for an offer with numbers that make no sense.
pub(super) fn share(link: &LinkOffer, multiplier: f64, budget_price: f64) -> f64 {
    positive_part((link.value(multiplier) - budget_price) / (2.0 * link.weight))
}

/// \[a\]₊; zero for what is not a number.
pub fn positive_part(number: f64) -> f64 {
    if number > 0.0 { number } else { 0.0 }
}

/// μ: the least price ≥ 0 on time at which the shares fit into the budget.
pub(super) fn budget_price(multiplier: f64, links: &[LinkOffer], budget: f64) -> f64 {
    let mut price = 0.0;
    for _ in 0..=links.len() {
        let (mut demand, mut slope) = (0.0, 0.0);
        for link in links {
            let share = share(link, multiplier, price);
            if share > 0.0 {
                demand += share;
                slope += 0.5 / link.weight;
            }
        }
        if demand <= budget || slope == 0.0 {
            break;
        }
        price += (demand - budget) / slope;
    }
    price
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::CubicReliability;
    use proptest::prelude::*;

    fn links() -> impl Strategy<Value = Vec<LinkOffer>> {
        let link = (0.0..=1.0f64, 0.5..10.0f64, 0.0..2.0f64);
        prop::collection::vec(link, 1..8).prop_map(|links| {
            let offer = |(reliability, weight, neighbour_multiplier)| LinkOffer {
                reliability,
                weight,
                neighbour_multiplier,
            };
            links.into_iter().map(offer).collect()
        })
    }

    proptest! {
        /// The optimality conditions of a strictly convex program determine its only solution.
        #[test]
        fn meets_the_optimality_conditions(
            links in links(), multiplier in 0.0..20.0f64, budget in 0.1..1.0f64,
        ) {
            let mut shares = Vec::new();
            let price = local_minimiser(multiplier, &links, budget, &mut shares);
            let total: f64 = shares.iter().sum();
            prop_assert!(price >= 0.0 && total <= budget * (1.0 + 1e-12));
            prop_assert!(price == 0.0 || (total - budget).abs() < 1e-12);
            for (link, &share) in links.iter().zip(&shares) {
                let gradient = 2.0 * link.weight * share - link.value(multiplier) + price;
                prop_assert!(share >= 0.0 && gradient > -1e-12);
                prop_assert!(share == 0.0 || gradient.abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_robot_dearer_than_no_other_sends_nothing() {
        let link = LinkOffer { reliability: 1.0, weight: 1.0, neighbour_multiplier: 0.5 };
        let mut shares = vec![9.0; 4];
        local_minimiser(0.5, &[link], 1.0, &mut shares);
        assert_eq!(shares, [0.0]);
    }

    #[test]
    fn numbers_that_make_no_sense_get_no_share() {
        let offer = |weight, neighbour_multiplier| LinkOffer {
            reliability: 1.0,
            weight,
            neighbour_multiplier,
        };
        let mut shares = Vec::new();
        local_minimiser(1.0, &[offer(1.0, f64::NAN), offer(-1.0, 0.0)], 1.0, &mut shares);
        assert_eq!(shares, [0.0, 0.0]);
    }

    #[test]
    fn the_weight_is_largest_in_the_middle_of_the_transition() {
        let link = CubicReliability::new(0.4, 0.5).unwrap();
        assert_eq!(weight(10.0, &link, 0.2), 1.0);
        assert!((weight(10.0, &link, 0.45) - 16.0).abs() < 1e-9);
        assert_eq!(weight(0.0, &link, 0.45), 1.0);
    }
}
