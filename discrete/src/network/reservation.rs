//! Reservation: what may be granted of a flow, and until when a grant holds.
//!
//! A robot grants no more than it has to spare, so that what it sends on carries what it has granted; and a grant
//! says until when the receiver keeps it, which never becomes less: so it ends at the sender first. The lemma
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

/// The last control period in which a grant holds that held until `until` and is told to hold until `told`.
pub const fn renewed(until: u32, told: u32) -> u32 {
    if told > until { told } else { until }
}

/// Whether a grant that holds until control period `until` holds in this one.
pub const fn holds(until: u32, period: u32) -> bool {
    period <= until
}
