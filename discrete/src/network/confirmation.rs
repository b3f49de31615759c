//! How recently an access point has confirmed a post's way to it.
//!
//! Access points confirm their ways once a control period: every beacon message carries the newest
//! period whose confirmation has come down the tree to its sender. A post is attached only to one
//! with a newer confirmation than any that the post itself has passed on. Whatever is attached to
//! the post, directly or not, has its confirmations from there, and none that is newer: so no cycle
//! closes, whichever messages are lost, late or copied (the lemma `confirmation.smt2`). Periods are sequence numbers
//! for loop freedom, as in the routing protocols DSDV and AODV.

/// What a robot keeps of the confirmations of the way from its post.
///
/// ```
/// use pleach_discrete::network::Confirmation;
///
/// let mut own = Confirmation::default();
/// assert!(own.admits(Some(3)));
/// own.pass_on(Some(3)); // that of its parent
/// assert!(!own.admits(Some(3)), "this may be that of a post that is attached to its own");
/// assert!(own.admits(Some(4)));
/// own.take_over(7);
/// assert_eq!(own.newest(), None);
/// assert!(!own.admits(Some(7)), "the robot before may have passed this on");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Confirmation {
    newest: Option<u32>,
    /// No newer one has been passed on from the post, by this robot or by others that held it.
    bound: Option<u32>,
}

impl Confirmation {
    /// The newest control period whose confirmation it passes on; none if none has come.
    pub const fn newest(&self) -> Option<u32> {
        self.newest
    }

    /// Whether the post may be attached to one with this confirmation.
    pub fn admits(&self, of_parent: Option<u32>) -> bool {
        self.bound.is_none() || of_parent > self.bound
    }

    /// Passes on the confirmation that its parent has passed on.
    pub fn pass_on(&mut self, of_parent: Option<u32>) {
        self.newest = self.newest.max(of_parent);
        self.bound = self.bound.max(self.newest);
    }

    /// The same where the control periods have other numbers.
    #[must_use]
    pub fn renumbered(self, number: impl Fn(u32) -> u32) -> Self {
        Confirmation { newest: self.newest.map(&number), bound: self.bound.map(&number) }
    }

    /// The robot holds another post from this control period on: robots that held it before have
    /// passed on nothing newer.
    pub fn take_over(&mut self, period: u32) {
        *self = Confirmation { newest: None, bound: Some(period) };
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::iter::successors;

    use super::*;

    #[test]
    fn a_post_is_attached_only_where_the_way_is_newer() {
        let mut own = Confirmation::default();
        assert!(own.admits(None) && own.admits(Some(0)));
        own.pass_on(Some(5));
        let admitted = (0..9).filter(|&period| own.admits(Some(period)));
        assert!(admitted.eq(6..9) && !own.admits(None));
    }

    #[test]
    fn what_is_passed_on_never_becomes_older() {
        let mut own = Confirmation::default();
        for (heard, newest) in
            [(None, None), (Some(4), Some(4)), (Some(2), Some(4)), (None, Some(4))]
        {
            own.pass_on(heard);
            assert_eq!(own.newest(), newest);
        }
    }

    /// Access point, then posts.
    const NODES: usize = 4;
    const PERIODS: u32 = 2;

    /// Posts with their parents, and every confirmation that was ever passed on: each may be heard
    /// now, late, again or never.
    #[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
    struct Network {
        period: u32,
        parents: [Option<usize>; NODES],
        newest: [Option<u32>; NODES],
        bounds: [Option<u32>; NODES],
        told: BTreeSet<(usize, u32)>,
    }

    impl Network {
        fn own(&self, post: usize) -> Confirmation {
            Confirmation { newest: self.newest[post], bound: self.bounds[post] }
        }

        fn with(&self, post: usize, own: Confirmation) -> Self {
            let mut next = self.clone();
            (next.newest[post], next.bounds[post]) = (own.newest, own.bound);
            next.told.extend(own.newest.map(|period| (post, period)));
            next
        }

        /// What may happen next: a period begins, a post has another holder, is attached to another
        /// one, or passes on what its parent has told.
        fn successors(&self) -> Vec<Self> {
            let mut all = Vec::new();
            if self.period < PERIODS {
                let mut next = Network { period: self.period + 1, ..self.clone() };
                next.told.insert((0, next.period));
                all.push(next);
            }
            for post in 1..NODES {
                let mut own = self.own(post);
                own.take_over(self.period);
                all.push(self.with(post, own));
                for &(node, period) in self.told.iter().filter(|told| told.0 != post) {
                    let mut own = self.own(post);
                    if self.parents[post] == Some(node) {
                        own.pass_on(Some(period));
                        all.push(self.with(post, own));
                    } else if own.admits(Some(period)) {
                        let mut next = self.clone();
                        next.parents[post] = Some(node);
                        all.push(next);
                    }
                }
            }
            all
        }

        fn above(&self, post: usize) -> impl Iterator<Item = usize> {
            let up = |node: &usize| self.parents[*node];
            successors(up(&post), up).take(NODES)
        }

        fn has_cycle(&self) -> bool {
            (1..NODES).any(|post| self.above(post).any(|node| node == post))
        }

        /// The newest confirmation that was ever passed on from a node, by any of its holders.
        fn newest_ever(&self, node: usize) -> Option<u32> {
            self.told.iter().filter(|told| told.0 == node).map(|told| told.1).max()
        }

        /// The invariant of the lemma: nothing newer has been passed on from a post than from what is above
        /// it, and nothing newer than its holder knows.
        fn is_invariant(&self) -> bool {
            (1..NODES).all(|post| {
                let newest = self.newest_ever(post);
                let bound = self.bounds[post];
                self.above(post).all(|node| newest <= self.newest_ever(node)) && (newest <= bound)
            })
        }
    }

    /// A robot attaches its post, and passes a confirmation on, as the lemma says: whatever was passed on
    /// from its post before, by itself or by others. That nothing was passed on is older than anything.
    #[test]
    fn a_confirmation_takes_the_steps_of_the_lemma() {
        let heard = || [None].into_iter().chain((0..4).map(Some));
        for (newest, before, of_parent) in heard()
            .flat_map(|newest| heard().map(move |before| (newest, before)))
            .flat_map(|(newest, before)| heard().map(move |of_parent| (newest, before, of_parent)))
        {
            let mut own = Confirmation::default();
            if let Some(period) = before {
                own.take_over(period);
            }
            own.pass_on(newest);
            let bound = newest.max(before);
            assert_eq!(own.admits(of_parent), of_parent > bound || bound.is_none());
            own.pass_on(of_parent);
            assert_eq!(own.newest(), newest.max(of_parent));
            assert_eq!(own.bound, bound.max(of_parent));
        }
    }

    /// Exhaustively, for three posts and three periods.
    #[test]
    fn whichever_messages_are_lost_late_or_copied_no_cycle_closes() {
        let mut known = BTreeSet::from([Network::default()]);
        let mut waiting: Vec<Network> = known.iter().cloned().collect();
        while let Some(network) = waiting.pop() {
            assert!(!network.has_cycle() && network.is_invariant(), "{network:?}");
            waiting
                .extend(network.successors().into_iter().filter(|next| known.insert(next.clone())));
        }
        assert!(known.len() > 10_000, "only {} states", known.len());
    }
}
