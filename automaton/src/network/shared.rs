//! Immutable values that many nodes share.

use std::ops::Deref;
use std::sync::Arc;

use pleach_discrete::network::{Election, IdSet};

/// A value shared between nodes: a node with a newer value shares another one.
///
/// Two of them are equal if their values are. Pointers are compared first, so comparing values that were passed on
/// within one process is cheap.
#[derive(Debug)]
pub struct Shared<T>(Arc<T>);

impl<T> Shared<T> {
    /// Shares `value`.
    pub(super) fn new(value: T) -> Self {
        Shared(Arc::new(value))
    }
}

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Shared(Arc::clone(&self.0))
    }
}

impl<T: PartialEq> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl<T: Eq> Eq for Shared<T> {}

impl<T> Deref for Shared<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

/// Replaces a set by one that differs. Equal sets keep sharing one allocation, so that receivers see no change.
pub(super) fn renew(known: &mut Arc<IdSet>, now: IdSet) {
    if **known != now {
        *known = Arc::new(now);
    }
}

/// Takes in the numbers that a neighbour tells. A set that holds them already stays shared.
#[inline]
pub(super) fn merge_set(own: &mut Arc<IdSet>, heard: &IdSet) {
    if !own.includes(heard) {
        Arc::make_mut(own).merge(heard);
    }
}

/// Takes in what a neighbour knows of an election. Nodes that know the same share one value.
pub(super) fn merge_election(own: &mut Arc<Election>, heard: &Arc<Election>) {
    if Arc::ptr_eq(own, heard) {
        return;
    }
    if !own.knows(heard) {
        Arc::make_mut(own).merge(heard);
    } else if own == heard {
        *own = Arc::clone(heard);
    }
}
