//! Revisions: what a robot derives, it derives again when something that it is derived from has changed.

/// A count of the changes of a robot's own state and of what it has received. What is derived is stored with the revision
/// that it was derived at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Revision(u64);

/// The revision at which something was derived last; none before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Stamp(Option<Revision>);

impl Revision {
    /// That of a robot from which nothing has been derived.
    pub const FIRST: Revision = Revision(0);

    /// Something has changed.
    pub const fn advance(&mut self) {
        self.0 += 1;
    }
}

impl Stamp {
    /// Whether nothing has changed since.
    pub fn is_of(self, revision: Revision) -> bool {
        self.0 == Some(revision)
    }

    /// It is derived from what is there now; returns whether something had changed.
    pub fn renew(&mut self, revision: Revision) -> bool {
        self.0.replace(revision) != Some(revision)
    }

    /// It has to be derived again, whether or not anything changes.
    pub const fn expire(&mut self) {
        self.0 = None;
    }
}
