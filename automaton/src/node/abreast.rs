//! Steps of one round, taken abreast: nodes of one round do not see each other's steps, so that it does
//! not matter which threads take them. What they leave is put together in the order of a single thread.

use std::fmt;

use super::{Node, NodeId, Outputs};

/// With fewer nodes one thread is as fast as several.
#[cfg(feature = "parallel")]
const FEWEST_FOR_THREADS: usize = 512;
/// As many nodes fetch their memory in a row.
const FETCHED_AT_ONCE: usize = 8;
/// With fewer nodes in a row all that they need is in the cache anyway.
const FEWEST_TO_FETCH: usize = 256;
/// Shares of the nodes for each thread, so that none waits long for another.
#[cfg(feature = "parallel")]
const SHARES_PER_THREAD: usize = 8;

/// What the steps of some nodes leave.
pub(super) struct Leavings<N: Node> {
    pub outputs: Outputs<N::Message, N::Report>,
    /// Of steps that do not come in order: the place of each message and of each report.
    pub places: [Vec<u32>; 2],
    /// What went wrong, with the place of the step.
    pub error: Option<(u32, N::Error)>,
}

impl<N: Node> Leavings<N> {
    const fn nothing() -> Self {
        Leavings { outputs: Outputs::of(0), places: [Vec::new(), Vec::new()], error: None }
    }

    /// A step went wrong; the one whose place comes first counts.
    pub fn note_error(&mut self, place: u32, error: N::Error) {
        if self.error.as_ref().is_none_or(|&(earlier, _)| place < earlier) {
            self.error = Some((place, error));
        }
    }

    /// All that has been left by now and has no place yet is of the step at this place.
    #[inline]
    pub fn put_at(&mut self, place: u32) {
        for (places, count) in self.places.iter_mut().zip(self.outputs.counts()) {
            if places.len() < count {
                places.resize(count, place);
            }
        }
    }
}

impl<N: Node> fmt::Debug for Leavings<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Leavings").finish_non_exhaustive()
    }
}

/// Takes the steps of the nodes in a row, from the node with the number `first` on, that are due: a few
/// [fetch](Node::fetch) their memory, `fetch` being the second part of that, then these take their steps,
/// then the next few.
pub(super) fn in_turn<N: Node, S>(
    first: NodeId,
    nodes: &mut [N],
    seats: &mut [S],
    is_due: impl Fn(NodeId, &S) -> bool,
    fetch: fn(&N),
    mut step: impl FnMut(NodeId, &mut N, &mut S),
) {
    let is_long = nodes.len() >= FEWEST_TO_FETCH;
    let groups = nodes.chunks_mut(FETCHED_AT_ONCE).zip(seats.chunks_mut(FETCHED_AT_ONCE));
    for (begin, (nodes, seats)) in (first..).step_by(FETCHED_AT_ONCE).zip(groups) {
        if is_long {
            let due = || {
                (begin..).zip(nodes.iter().zip(&*seats)).filter(|(id, (_, seat))| is_due(*id, seat))
            };
            due().for_each(|(_, (node, _))| node.fetch());
            due().for_each(|(_, (node, _))| fetch(node));
        }
        for (id, (node, seat)) in (begin..).zip(nodes.iter_mut().zip(seats)) {
            if is_due(id, seat) {
                step(id, node, seat);
            }
        }
    }
}

/// Lets `work` take the steps of all nodes: it is given nodes in a row and their seats, from the node
/// whose number is its first argument on. Returns what the nodes of each row leave, row by row.
pub(super) fn abreast<'a, N: Node, S: Send>(
    nodes: &mut [N],
    seats: &mut [S],
    leavings: &'a mut Vec<Leavings<N>>,
    work: impl Fn(NodeId, &mut [N], &mut [S], &mut Leavings<N>) + Sync,
) -> &'a mut [Leavings<N>] {
    let share = share_of(nodes.len());
    let rows = nodes.len().div_ceil(share);
    if leavings.len() < rows {
        leavings.resize_with(rows, Leavings::nothing);
    }
    let left = &mut leavings[..rows];
    #[cfg(feature = "parallel")]
    if rows > 1 {
        use rayon::prelude::*;
        let rows = nodes.par_chunks_mut(share).zip(seats.par_chunks_mut(share));
        rows.zip(left.par_iter_mut())
            .enumerate()
            .for_each(|(row, ((nodes, seats), left))| work(row * share, nodes, seats, left));
        return left;
    }
    let rows = nodes.chunks_mut(share).zip(seats.chunks_mut(share));
    for (row, ((nodes, seats), left)) in rows.zip(left.iter_mut()).enumerate() {
        work(row * share, nodes, seats, left);
    }
    left
}

/// How many nodes are given to a thread at once; all of them if there is one thread.
#[cfg(feature = "parallel")]
fn share_of(nodes: usize) -> usize {
    let threads = rayon::current_num_threads();
    match nodes < FEWEST_FOR_THREADS || threads == 1 {
        true => nodes.max(1),
        false => nodes.div_ceil(threads * SHARES_PER_THREAD),
    }
}

#[cfg(not(feature = "parallel"))]
fn share_of(nodes: usize) -> usize {
    nodes.max(1)
}
