//! The extremes of a mission, for its summary.

use pleach_automaton::network::Site;
use pleach_automaton::network::record::Snapshot;
use pleach_automaton::network::scenario::LinkCount;
use pleach_continuous::Point;

use super::violation::Instant;

/// An extreme value, when it occurred and which robots it concerns.
#[derive(Clone, Debug, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// When.
    pub instant: Instant,
    /// The robots concerned.
    pub robots: Vec<usize>,
}

/// How near a mission came to its bounds; `None` where nothing was there to be measured.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extremes {
    /// The smallest distance of two robots, to be compared with 2ρ.
    pub pair_distance: Option<Extreme>,
    /// The smallest distance of a robot to the walls, to be compared with ρ.
    pub clearance: Option<Extreme>,
    /// The smallest residual, to be compared with −c_min.
    pub residual: Option<Extreme>,
    /// The largest load, to be compared with 1.
    pub load: Option<Extreme>,
}

/// Keeps the smaller of two extremes, the earlier one when they are equal.
pub(super) fn keep_smaller(kept: &mut Option<Extreme>, candidate: Option<Extreme>) {
    keep(kept, candidate, |candidate, kept| candidate < kept);
}

/// Keeps the larger of two extremes, the earlier one when they are equal.
pub(super) fn keep_larger(kept: &mut Option<Extreme>, candidate: Option<Extreme>) {
    keep(kept, candidate, |candidate, kept| candidate > kept);
}

fn keep(
    kept: &mut Option<Extreme>,
    candidate: Option<Extreme>,
    is_better: impl Fn(f64, f64) -> bool,
) {
    if let Some(candidate) = candidate
        && kept.as_ref().is_none_or(|kept| is_better(candidate.value, kept.value))
    {
        *kept = Some(candidate);
    }
}

/// How many links of the tree crossed walls: the straight line between their ends leaves the workspace. The model of
/// the radio does not see walls, and a real radio may.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeLinks {
    last: LinkCount,
    most: Option<(LinkCount, Instant)>,
}

impl Default for TreeLinks {
    fn default() -> Self {
        TreeLinks { last: LinkCount { links: 0, through_walls: 0 }, most: None }
    }
}

impl TreeLinks {
    /// Where more than this share of the links cross walls, that is worth a warning.
    const WORTH_A_WARNING: f64 = 0.1;

    /// Counts the links of the next snapshot.
    pub fn observe(&mut self, snapshot: &Snapshot, site: &Site) {
        self.last = count(snapshot, site);
        let most = self.most.map_or(0, |(most, _)| most.through_walls);
        if self.last.through_walls > most {
            self.most = Some((self.last, Instant::of(snapshot)));
        }
    }

    /// Those of the last snapshot.
    pub const fn last(&self) -> LinkCount {
        self.last
    }

    /// Those of the first snapshot in which most of them crossed walls; none if none ever did.
    pub const fn most(&self) -> Option<(LinkCount, Instant)> {
        self.most
    }

    /// Whether more than a tenth of them cross walls now, or did when most of them crossed some.
    pub fn are_worth_a_warning(&self) -> bool {
        let is_large = |count: LinkCount| {
            count.through_walls as f64 > Self::WORTH_A_WARNING * count.links as f64
        };
        is_large(self.last) || self.most.is_some_and(|(most, _)| is_large(most))
    }
}

/// The links of the tree in a snapshot, in which each leads from a robot to its parent.
fn count(snapshot: &Snapshot, site: &Site) -> LinkCount {
    let nodes: Vec<Point> = snapshot.positions.iter().chain(&site.access_points).copied().collect();
    let ends = |&(child, parent): &(usize, usize)| Some((*nodes.get(child)?, *nodes.get(parent)?));
    let links: Vec<(Point, Point)> = snapshot.tree.iter().filter_map(ends).collect();
    let crosses = |(child, parent): &&(Point, Point)| {
        site.workspace.segment_clearance(*child, *parent) <= 0.0
    };
    LinkCount { links: links.len(), through_walls: links.iter().filter(crosses).count() }
}
