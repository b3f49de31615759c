//! Elections alone: every graph, every vector of bids, every order of messages.

use std::convert::Infallible;

use pleach_discrete::network::{Bid, Election, IdSet, NodeId, NoticeId};

use super::graphs::Graph;
use crate::{Model, Property};

/// An election among robots and the access point of a graph; messages come in any order, late,
/// and again and again.
#[derive(Clone, Debug)]
pub struct Ballot {
    graph: Graph,
    bids: Vec<Option<Bid>>,
    roster: IdSet,
}

/// What every node knows: the robots first, then the access point, which places no token.
pub type Views = Vec<Election>;

impl Ballot {
    /// Robots with these bids, none for one that does not compete, on a graph.
    pub fn new(graph: Graph, bids: Vec<Option<Bid>>) -> Self {
        let roster = (0..bids.len()).collect();
        Ballot { graph, bids, roster }
    }

    /// One round in which every node hears all neighbours.
    pub fn round(&self, views: &Views) -> Views {
        let mut next = views.clone();
        for &(a, b) in &self.graph {
            next[a].merge(&views[b]);
            next[b].merge(&views[a]);
        }
        next
    }

    /// Every robot has placed its own token and heard nothing.
    pub fn begin(&self) -> Views {
        let mut views = vec![Election::new(NoticeId::new(1, self.bids.len())); self.bids.len() + 1];
        for (robot, (view, &bid)) in views.iter_mut().zip(&self.bids).enumerate() {
            view.place(robot, bid);
        }
        views
    }

    /// The best bid there is, ties going to the higher index.
    pub fn rightful(&self) -> Option<(Bid, NodeId)> {
        let placed = self.bids.iter().enumerate();
        placed.filter_map(|(robot, &bid)| Some((bid?, robot))).max()
    }

    /// Whether every node knows that the election is over.
    pub fn is_over_everywhere(&self, views: &Views) -> bool {
        views.iter().all(|view| view.is_complete(&self.roster))
    }
}

impl Model for Ballot {
    type State = Views;
    type Action = (NodeId, NodeId);
    type Error = Infallible;

    fn initial(&mut self) -> Result<Vec<Views>, Infallible> {
        Ok(vec![self.begin()])
    }

    fn successors(&mut self, views: &Views) -> Result<Vec<((NodeId, NodeId), Views)>, Infallible> {
        let ways = self.graph.iter().flat_map(|&(a, b)| [(a, b), (b, a)]);
        let heard = |(from, to): (NodeId, NodeId)| {
            let mut next = views.clone();
            next[to].merge(&views[from]);
            ((from, to), next)
        };
        Ok(ways.map(heard).filter(|(_, next)| next != views).collect())
    }
}

/// Agreement and validity: a node that knows the election to be over knows the rightful winner, and a
/// winner has placed a bid.
pub const WINNER: Property<Ballot> = Property {
    name: "the winner placed the best bid, and all agree on it",
    holds: |ballot, views| {
        let is_over = |view: &&Election| view.is_complete(&ballot.roster);
        views.iter().filter(is_over).all(|view| view.best() == ballot.rightful())
    },
};

#[cfg(test)]
mod tests {
    use super::super::graphs::numbered_graphs;
    use super::*;
    use crate::{Fairness, explore};

    /// Every vector of bids of this many robots: none, 0 or 1, so that there are ties.
    fn every_bids(robots: usize) -> Vec<Vec<Option<Bid>>> {
        let bid = |merit: usize| {
            merit.checked_sub(1).map(|merit| Bid { rank: 1, merit: merit as i64, economy: 0 })
        };
        (0..3_usize.pow(robots as u32))
            .map(|code| {
                (0..robots).map(|robot| bid(code / 3_usize.pow(robot as u32) % 3)).collect()
            })
            .collect()
    }

    fn diameter(graph: &Graph, nodes: usize) -> usize {
        let mut steps = vec![vec![nodes; nodes]; nodes];
        (0..nodes).for_each(|node| steps[node][node] = 0);
        graph.iter().for_each(|&(a, b)| (steps[a][b], steps[b][a]) = (1, 1));
        for middle in 0..nodes {
            for from in 0..nodes {
                for to in 0..nodes {
                    steps[from][to] = steps[from][to].min(steps[from][middle] + steps[middle][to]);
                }
            }
        }
        steps.into_iter().flatten().max().unwrap()
    }

    /// Every graph of up to three robots, numbered, with every vector of bids.
    #[test]
    fn in_any_order_of_messages_all_agree_on_the_rightful_winner() {
        let mut states = 0;
        for robots in 1..=3 {
            for graph in numbered_graphs(robots) {
                for bids in every_bids(robots) {
                    let mut ballot = Ballot::new(graph.clone(), bids);
                    let exploration = explore(&mut ballot, &[WINNER], 10_000).unwrap();
                    assert_eq!(exploration.violations(), []);
                    let done = |views: &Views| ballot.is_over_everywhere(views);
                    assert!(exploration.traps(done, |_| false, Fairness::Weak).is_empty());
                    states += exploration.states().len();
                }
            }
        }
        assert_eq!(states, 175_776);
    }

    #[test]
    fn in_rounds_an_election_ends_within_the_diameter() {
        for robots in 1..=4 {
            for graph in numbered_graphs(robots) {
                let ballot = Ballot::new(graph.clone(), vec![None; robots]);
                let mut views = ballot.begin();
                for _ in 0..diameter(&graph, robots + 1) {
                    views = ballot.round(&views);
                }
                assert!(ballot.is_over_everywhere(&views), "{graph:?}");
            }
        }
    }
}
