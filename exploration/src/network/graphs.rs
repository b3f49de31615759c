//! All connected graphs of a few robots and access points.

use super::places::PlaceId;

/// A graph on robots 0 … N−1 and the access points from N on, by its edges.
pub type Graph = Vec<(PlaceId, PlaceId)>;

/// Every connected graph of this many robots and access points, once for all that are the same but
/// for the numbers of the robots. With one access point there are 1, 3, 11, 58 … of them.
///
/// The numbers of robots decide ties. Where that matters, use [`numbered_graphs`].
pub fn graphs(robots: usize, access_points: usize) -> Vec<Graph> {
    let nodes = robots + access_points;
    let pairs = pairs(nodes);
    let orders = orders(robots);
    masks(&pairs)
        .filter(|&mask| is_connected(mask, &pairs, nodes))
        .filter(|&mask| orders.iter().all(|order| renumbered(mask, &pairs, order) >= mask))
        .map(|mask| edges(mask, &pairs))
        .collect()
}

/// Every connected graph of `robots` numbered robots and one access point: 1, 4, 38, 728 …
pub fn numbered_graphs(robots: usize) -> Vec<Graph> {
    let pairs = pairs(robots + 1);
    masks(&pairs)
        .filter(|&mask| is_connected(mask, &pairs, robots + 1))
        .map(|mask| edges(mask, &pairs))
        .collect()
}

fn pairs(nodes: usize) -> Vec<(PlaceId, PlaceId)> {
    (0..nodes).flat_map(|a| (a + 1..nodes).map(move |b| (a, b))).collect()
}

/// Every choice of pairs, as bits.
fn masks(pairs: &[(PlaceId, PlaceId)]) -> impl Iterator<Item = u32> + use<> {
    0..1_u32 << pairs.len()
}

fn edges(mask: u32, pairs: &[(PlaceId, PlaceId)]) -> Graph {
    let chosen = |&(at, _): &(usize, &(PlaceId, PlaceId))| mask >> at & 1 == 1;
    pairs.iter().enumerate().filter(chosen).map(|(_, &pair)| pair).collect()
}

fn is_connected(mask: u32, pairs: &[(PlaceId, PlaceId)], nodes: usize) -> bool {
    let mut reached = 1_u32;
    for _ in 0..nodes {
        for (at, &(a, b)) in pairs.iter().enumerate() {
            if mask >> at & 1 == 1 && (reached >> a | reached >> b) & 1 == 1 {
                reached |= 1 << a | 1 << b;
            }
        }
    }
    reached == (1 << nodes) - 1
}

/// Every order of the robots.
fn orders(robots: usize) -> Vec<Vec<PlaceId>> {
    (0..robots).fold(vec![Vec::new()], |orders, robot| {
        orders
            .iter()
            .flat_map(|order| {
                (0..=robot).map(move |at| {
                    let mut longer = order.clone();
                    longer.insert(at, robot);
                    longer
                })
            })
            .collect()
    })
}

/// The same graph with robot `i` called `order[i]`.
fn renumbered(mask: u32, pairs: &[(PlaceId, PlaceId)], order: &[PlaceId]) -> u32 {
    let name = |node: PlaceId| order.get(node).copied().unwrap_or(node);
    let mut renumbered = 0;
    for (at, &(a, b)) in pairs.iter().enumerate() {
        if mask >> at & 1 == 1 {
            let pair = (name(a).min(name(b)), name(a).max(name(b)));
            let place = pairs.iter().position(|&other| other == pair).unwrap_or_default();
            renumbered |= 1 << place;
        }
    }
    renumbered
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Connected graphs on n numbered nodes: 1, 4, 38, 728 (OEIS A001187); with one node
    /// distinguished and the others alike: 1, 3, 11, 58 (OEIS A126100).
    #[test]
    fn there_are_as_many_graphs_as_there_should_be() {
        let numbered: Vec<usize> = (1..=4).map(|robots| numbered_graphs(robots).len()).collect();
        assert_eq!(numbered, [1, 4, 38, 728]);
        let alike: Vec<usize> = (1..=4).map(|robots| graphs(robots, 1).len()).collect();
        assert_eq!(alike, [1, 3, 11, 58]);
    }
}
