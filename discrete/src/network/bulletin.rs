//! The newest notice on the mission, flooded through the network.
//!
//! A mission goes through its steps one at a time, and at each step exactly one node may issue
//! the next notice: the access point that announces, the elected leader, p₁ that calls for help,
//! the recruit that found the path. Notices are therefore numbered, and the greater number wins:
//! a max-consensus that neither loss, nor repetition, nor delay can confuse.

#[cfg(any(kani, test))]
mod proofs;

/// A numbered notice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bulletin<N> {
    sequence: u32,
    notice: N,
}

impl<N: Clone> Bulletin<N> {
    /// The first bulletin of a mission.
    pub const fn first(notice: N) -> Self {
        Bulletin { sequence: 0, notice }
    }

    /// The number of this bulletin.
    pub const fn sequence(&self) -> u32 {
        self.sequence
    }

    /// What it says.
    pub const fn notice(&self) -> &N {
        &self.notice
    }

    /// The bulletin that follows this one.
    pub fn next(&self, notice: N) -> Self {
        Bulletin { sequence: self.sequence + 1, notice }
    }

    /// Whether it was issued after `other`.
    pub const fn is_newer_than(&self, other: &Self) -> bool {
        self.sequence > other.sequence
    }

    /// Takes over `heard` if it is newer; says whether it was.
    pub fn merge(&mut self, heard: &Self) -> bool {
        let newer = heard.is_newer_than(self);
        if newer {
            *self = heard.clone();
        }
        newer
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bulletins_count_from_zero() {
        let first = Bulletin::first("announced");
        let third = first.next("called").next("resumed");
        assert_eq!((first.sequence(), *first.notice()), (0, "announced"));
        assert_eq!((third.sequence(), *third.notice()), (2, "resumed"));
    }
}
