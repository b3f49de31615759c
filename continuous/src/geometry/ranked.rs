//! Items in a priority queue that gives out the cheapest first.

use std::cmp::Ordering;

/// An item with a cost. In a [`std::collections::BinaryHeap`] the cheapest comes first, and among
/// equals the smallest item, so that results never depend on the order of insertion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ranked<T> {
    pub(super) cost: f64,
    pub(super) item: T,
}

impl<T: Ord> Ord for Ranked<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.total_cmp(&self.cost).then_with(|| other.item.cmp(&self.item))
    }
}

impl<T: Ord> PartialOrd for Ranked<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T: Ord> PartialEq for Ranked<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<T: Ord> Eq for Ranked<T> {}
