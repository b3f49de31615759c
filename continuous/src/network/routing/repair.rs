//! Repair to feasibility: after any number of iterations every robot meets its reserve.
//!
//! A finite number of iterations leaves residuals that miss the reserve. Robots therefore sweep
//! over the tree network, deepest first, each with [`meet_demand`]: its demand is r_i + η plus what
//! flows into it, and what is missing it sends over the link to its tree parent. One message from
//! child to parent tells the new flow, so a sweep takes as many rounds as the tree is deep.
//!
//! When a robot has been repaired, its inflow can only fall: robots deeper than it are done, and
//! every other robot only takes shares away from links that are not its tree link. So all residuals
//! are at least η after the sweep unless a robot reports a shortfall, which means that the tree
//! cannot carry the rates with the reliabilities that its links have now.

use super::TIME_BUDGET;

/// Shortfalls up to this rate are rounding of sums of shares of order one.
const ROUNDING: f64 = 1e-12;

/// A link of the sender with the share it has now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// R_ij, in [0, 1].
    pub reliability: f64,
    /// T_ij, in [0, 1].
    pub share: f64,
}

/// Raises the share of the link to the tree parent until the outflow Σ T_ij R_ij meets `demand`,
/// within the budget Σ T_ij ≤ [`TIME_BUDGET`]. Returns what is still missing, at least 0.
///
/// Unused time is taken first; then time moves over from links that carry worse than the tree
/// link, the worst first, and no more than needed. The outflow never falls. `tree_link` is the
/// index of the tree link in `links`; if there is none at that index, nothing changes.
///
/// ```
/// use pleach_continuous::network::routing::repair::{Share, meet_demand};
///
/// let mut links =
///     [Share { reliability: 1.0, share: 0.1 }, Share { reliability: 0.2, share: 0.1 }];
/// assert_eq!(meet_demand(0.3, &mut links, 0), 0.0);
/// assert!((links[0].share - 0.28).abs() < 1e-12);
/// ```
pub fn meet_demand(demand: f64, links: &mut [Share], tree_link: usize) -> f64 {
    let Some(&Share { reliability, .. }) = links.get(tree_link) else {
        return missing(demand, links);
    };
    spend_unused_time(demand, links, tree_link, reliability);
    while missing(demand, links) > 0.0 {
        let Some(worst) = worst_link_below(reliability, links, tree_link) else { break };
        let gain = reliability - links[worst].reliability;
        let moved = (missing(demand, links) / gain).min(links[worst].share);
        // A share that is used up becomes exactly zero: the loop meets each link at most once.
        links[worst].share =
            if moved < links[worst].share { links[worst].share - moved } else { 0.0 };
        links[tree_link].share += moved;
    }
    missing(demand, links)
}

fn spend_unused_time(demand: f64, links: &mut [Share], tree_link: usize, reliability: f64) {
    let used: f64 = links.iter().map(|link| link.share).sum();
    let unused = TIME_BUDGET - used;
    if reliability > 0.0 && unused > 0.0 {
        links[tree_link].share += (missing(demand, links) / reliability).min(unused);
    }
}

/// The link with a share whose reliability is the lowest, if that is below the given one.
fn worst_link_below(reliability: f64, links: &[Share], tree_link: usize) -> Option<usize> {
    (0..links.len())
        .filter(|&index| index != tree_link && links[index].share > 0.0)
        .filter(|&index| links[index].reliability < reliability)
        .min_by(|&a, &b| links[a].reliability.total_cmp(&links[b].reliability))
}

fn missing(demand: f64, links: &[Share]) -> f64 {
    let outflow: f64 = links.iter().map(|link| link.share * link.reliability).sum();
    let missing = demand - outflow;
    if missing > ROUNDING { missing } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn outflow(links: &[Share]) -> f64 {
        links.iter().map(|link| link.share * link.reliability).sum()
    }

    fn used(links: &[Share]) -> f64 {
        links.iter().map(|link| link.share).sum()
    }

    /// Links whose shares fit into the budget.
    fn links() -> impl Strategy<Value = Vec<Share>> {
        let link = (prop_oneof![Just(0.0), Just(1.0), 0.0..1.0f64], 0.0..1.0f64);
        (prop::collection::vec(link, 1..7), 0.0..1.0f64).prop_map(|(links, usage)| {
            let total: f64 = links.iter().map(|(_, share)| share).sum();
            let scale = if total > 0.0 { usage * TIME_BUDGET / total } else { 0.0 };
            let scaled = |(reliability, share)| Share { reliability, share: share * scale };
            links.into_iter().map(scaled).collect()
        })
    }

    proptest! {
        #[test]
        fn meets_the_demand_or_says_by_how_much_it_fails(
            before in links(), demand in 0.0..1.2f64, tree_link in 0usize..6,
        ) {
            let tree_link = tree_link % before.len();
            let mut after = before.clone();
            let shortfall = meet_demand(demand, &mut after, tree_link);

            prop_assert!(shortfall >= 0.0);
            prop_assert!(outflow(&after) + shortfall >= demand - ROUNDING);
            prop_assert!(used(&after) <= TIME_BUDGET + ROUNDING);
            prop_assert!(outflow(&after) >= outflow(&before) - ROUNDING);
            for (index, (old, new)) in before.iter().zip(&after).enumerate() {
                prop_assert!(new.share >= 0.0);
                prop_assert!(index == tree_link || new.share <= old.share);
            }
            // No more than needed is sent.
            prop_assert!(outflow(&after) <= outflow(&before).max(demand) + ROUNDING);
            // A shortfall means that no time is left that the tree link could use better.
            if shortfall > 0.0 {
                let best = before[tree_link].reliability;
                let wasted = after
                    .iter()
                    .enumerate()
                    .any(|(index, link)| {
                        index != tree_link && link.share > 0.0 && link.reliability < best
                    });
                prop_assert!(!wasted);
                prop_assert!(best == 0.0 || used(&after) >= TIME_BUDGET - ROUNDING);
            }
        }
    }

    #[test]
    fn time_moves_over_from_the_worst_link_first() {
        let link = |reliability, share| Share { reliability, share };
        let mut links = [link(0.9, 0.2), link(0.5, 0.4), link(0.1, TIME_BUDGET - 0.6)];
        // Moving 0.1 from the link with 0.1 gains 0.1·(0.9 − 0.1).
        let demand = outflow(&links) + 0.08;
        assert_eq!(meet_demand(demand, &mut links, 0), 0.0);
        assert_eq!(links[1].share, 0.4);
        assert!((links[0].share - 0.3).abs() < 1e-12);
    }

    #[test]
    fn a_link_that_carries_nothing_gets_no_time() {
        let link = |reliability, share| Share { reliability, share };
        let mut links = [link(0.0, 0.0), link(0.5, 0.25)];
        assert_eq!(meet_demand(0.5, &mut links, 0), 0.375);
        assert_eq!(links.map(|link| link.share), [0.0, 0.25]);
    }

    #[test]
    fn unused_time_is_taken_first_and_no_more_than_needed() {
        let link = |reliability, share| Share { reliability, share };
        let mut links = [link(0.5, 0.25), link(0.25, 0.25)];
        assert_eq!(meet_demand(0.3125, &mut links, 0), 0.0);
        assert_eq!(links.map(|link| link.share), [0.5, 0.25]);
    }

    #[test]
    fn a_demand_that_is_met_changes_nothing() {
        let mut links = [Share { reliability: 0.9, share: 0.5 }];
        assert_eq!(meet_demand(0.4, &mut links, 0), 0.0);
        assert_eq!(links[0].share, 0.5);
    }

    #[test]
    fn without_a_tree_link_the_shortfall_is_reported() {
        assert_eq!(meet_demand(0.4, &mut [], 0), 0.4);
    }
}
