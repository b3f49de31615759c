//! Reservation: what may be granted of a flow, and until when a grant holds.
//!
//! A robot grants no more than it has to spare, so that what it sends on carries what it has granted; and a grant
//! says until when the receiver keeps it: it never ends later at the sender. The lemma
//! `reservation.smt2` says why that is safe whatever becomes of messages. Flows are numbers of any kind.

use std::ops::{Add, Sub};

#[cfg(any(kani, test))]
mod proofs;

/// What a robot has to spare of the flows that it sends on: it may be granted to others, one after the other.
///
/// ```
/// use pleach_discrete::network::reservation::Spare;
///
/// let mut spare = Spare::of(0.25);
/// let (kept, wanted) = (0.125, 0.5);
/// let flow = spare.most(kept, wanted);
/// assert_eq!(flow, 0.375);
/// spare.grant(kept, flow);
/// assert_eq!(spare.most(0.125, 0.5), 0.125, "nothing is left");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spare<N>(N);

impl<N> Spare<N>
where
    N: Copy + Default + PartialOrd + Add<Output = N> + Sub<Output = N>,
{
    /// So much, or nothing if that is negative.
    pub const fn of(amount: N) -> Self {
        Spare(amount)
    }

    /// The flow that may be granted where `kept` has been and `wanted` is asked for: no more than that, nor than
    /// what is kept and what there is to spare.
    pub fn most(&self, kept: N, wanted: N) -> N {
        let spare = if self.0 > N::default() { self.0 } else { N::default() };
        let most = kept + spare;
        if wanted < most { wanted } else { most }
    }

    /// `flow` is granted where `kept` has been before.
    pub fn grant(&mut self, kept: N, flow: N) {
        self.0 = self.0 - (flow - kept);
    }
}

/// What may be used of a flow, and until when: all of it for a while, and a part of it for longer.
///
/// The receiver of a flow keeps it, the sender uses it. The receiver enters a promise before it tells what it keeps, the
/// sender takes over what it hears: so in no control period may the sender use more than the receiver keeps.
///
/// ```
/// use pleach_discrete::network::reservation::Lease;
///
/// let mut lease = Lease::of(0.5, 12);
/// assert!(lease.promise(0.25, 15));
/// assert_eq!([12, 13, 15, 16].map(|period| lease.lasting(period)), [0.5, 0.25, 0.25, 0.0]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lease<N> {
    /// All of it.
    flow: N,
    /// The last control period for all of it.
    until: u32,
    /// The part that holds for longer; nothing if none does.
    part: N,
    /// The last control period for that part.
    part_until: u32,
}

impl<N> Lease<N>
where
    N: Copy + Default + PartialOrd,
{
    /// A flow that holds until this control period.
    pub fn of(flow: N, until: u32) -> Self {
        Lease { flow, until, ..Lease::default() }
    }

    /// All of it.
    pub const fn flow(&self) -> N {
        self.flow
    }

    /// The last control period in which all of it holds.
    pub const fn until(&self) -> u32 {
        self.until
    }

    /// The part that holds for longer than all of it, and the last control period in which that does.
    pub fn part(&self) -> Option<(N, u32)> {
        (self.part > N::default()).then_some((self.part, self.part_until))
    }

    /// The last control period in which any of it holds.
    pub fn end(&self) -> u32 {
        self.part().map_or(self.until, |(_, until)| until)
    }

    /// What holds in a control period.
    pub fn lasting(&self, period: u32) -> N {
        match self.part() {
            _ if period <= self.until => self.flow,
            Some((part, until)) if period <= until => part,
            _ => N::default(),
        }
    }

    /// So much holds until this control period, besides what holds already. Returns false, and changes nothing, where
    /// that would take more than one part.
    pub fn promise(&mut self, flow: N, until: u32) -> bool {
        let Lease { flow: all, until: end, part, part_until } = *self;
        *self = if flow >= all && until >= end {
            Lease { flow, until, part, part_until }
        } else if flow > all && self.part().is_none() {
            Lease { flow, until, part: all, part_until: end }
        } else if flow <= all && flow >= part && until >= self.end() {
            Lease { flow: all, until: end, part: flow, part_until: until }
        } else {
            return self.lasting(until) >= flow;
        };
        self.join_parts();
        true
    }

    /// The receiver tells the sender that it keeps this. What is told late is less than what the sender knows, and
    /// changes nothing. A receiver that has begun again keeps less, but maybe for longer: of that the sender takes over
    /// what fits beside what it knows.
    pub fn hear(&mut self, kept: Self) {
        let covers = |end: u32| kept.lasting(end) >= self.lasting(end);
        if covers(self.until) && covers(self.end()) {
            *self = kept;
        } else {
            self.promise(kept.flow, kept.until);
            self.promise(kept.part, kept.part_until);
        }
    }

    /// No more than this holds from now on.
    pub fn limit(&mut self, flow: N) {
        let least = |one: N| if flow < one { flow } else { one };
        (self.flow, self.part) = (least(self.flow), least(self.part));
        self.join_parts();
    }

    /// A part that is all of it is none, nor is one that does not hold for longer.
    fn join_parts(&mut self) {
        if self.part >= self.flow && self.part_until > self.until {
            self.until = self.part_until;
        }
        if self.part <= N::default() || self.part_until <= self.until {
            (self.part, self.part_until) = (N::default(), 0);
        }
    }

    /// It is this control period: what has ended does not hold any more.
    pub fn pass(&mut self, period: u32) {
        if period > self.until {
            let (flow, until) = self.part().unwrap_or((N::default(), self.until));
            *self = Lease::of(if period > until { N::default() } else { flow }, until);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The receiver has begun again, and keeps less than the sender knows of.
    #[test]
    fn what_is_kept_for_longer_is_heard_beside_what_is_known() {
        let mut known = Lease::of(5, 10);
        known.hear(Lease::of(2, 14));
        assert_eq!([10, 11, 14, 15].map(|period| known.lasting(period)), [5, 2, 2, 0]);
        known.hear(Lease::of(2, 12));
        assert_eq!(known.part(), Some((2, 14)), "that was told before");
    }
}
