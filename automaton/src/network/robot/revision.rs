//! Revisions: what a robot derives, it derives again when something that it is derived from has changed.

use super::facts::Facts;

/// A count of the changes of a robot's own state and of what it has received. What is derived is stored with the revision
/// that it was derived at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Revision(u64);

/// The revision at which something was derived last; none before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Stamp(Option<Revision>);

/// What a robot has changed and received, and what it has derived from that.
#[derive(Clone, Copy, Debug)]
pub(super) struct Changes {
    revision: Revision,
    /// When it last processed messages, compared its beacon and measured its facts.
    processed_at: Stamp,
    compared_at: Stamp,
    measured_at: Stamp,
    /// What guards saw when they were evaluated last.
    facts: Facts,
    /// Whether no transition can be taken before the facts change.
    is_quiet: bool,
}

impl Revision {
    /// That of a robot from which nothing has been derived.
    pub(super) const FIRST: Revision = Revision(0);

    /// The revision after this.
    const fn next(self) -> Self {
        Revision(self.0 + 1)
    }
}

impl Stamp {
    /// Whether nothing has changed since.
    pub(super) fn is_of(self, revision: Revision) -> bool {
        self.0 == Some(revision)
    }

    /// It is derived from what is there now; returns whether something had changed.
    pub(super) fn renew(&mut self, revision: Revision) -> bool {
        self.0.replace(revision) != Some(revision)
    }

    /// It has to be derived again, whether or not anything changes.
    pub(super) const fn expire(&mut self) {
        self.0 = None;
    }
}

impl Default for Changes {
    /// Those of a robot that has derived nothing.
    fn default() -> Self {
        Changes {
            revision: Revision::FIRST,
            processed_at: Stamp::default(),
            compared_at: Stamp::default(),
            measured_at: Stamp::default(),
            facts: Facts::default(),
            is_quiet: false,
        }
    }
}

impl Changes {
    pub(super) const fn revision(&self) -> Revision {
        self.revision
    }

    /// The robot's own state, or what it has received, has changed: it has to process messages, to compare its beacon, to
    /// measure its facts and to find its links.
    pub(super) const fn note(&mut self) {
        self.revision = self.revision.next();
    }

    /// A transition may be taken although no fact changes.
    pub(super) const fn allow_jump(&mut self) {
        self.is_quiet = false;
    }

    /// Whether something has changed since messages were processed.
    pub(super) fn are_news(&self) -> bool {
        !self.processed_at.is_of(self.revision)
    }

    /// Messages are processed: what that changes is news only from now on.
    pub(super) fn process(&mut self) {
        self.note();
        self.processed_at.renew(self.revision);
    }

    /// The beacon is compared; returns whether it may differ from the last.
    pub(super) fn compare(&mut self) -> bool {
        self.compared_at.renew(self.revision)
    }

    /// The facts are measured; returns whether they may differ from the last.
    pub(super) fn measure(&mut self) -> bool {
        self.measured_at.renew(self.revision)
    }

    /// Guards are evaluated with these facts; returns whether one may hold that did not hold before.
    pub(super) fn renew_facts(&mut self, facts: Facts) -> bool {
        let has_changed = std::mem::replace(&mut self.facts, facts) != facts;
        let was_quiet = std::mem::replace(&mut self.is_quiet, true);
        has_changed || !was_quiet
    }

    /// What guards saw when they were evaluated last.
    pub(super) const fn facts(&self) -> &Facts {
        &self.facts
    }

    /// Whether no transition can be taken before the facts change.
    pub(super) const fn is_quiet(&self) -> bool {
        self.is_quiet
    }
}

#[cfg(feature = "abstraction")]
impl Changes {
    /// Whether messages, beacon and facts are as they were derived.
    pub(super) fn are_derived(&self) -> [bool; 3] {
        [self.processed_at, self.compared_at, self.measured_at].map(|it| it.is_of(self.revision))
    }
}

#[cfg(test)]
impl Changes {
    /// Everything has been derived.
    pub(super) fn settle(&mut self) {
        self.process();
        self.compare();
        self.measure();
    }

    /// Guards see these facts.
    pub(super) const fn sees(&mut self, facts: Facts) {
        self.facts = facts;
    }

    /// No transition can be taken before the facts change.
    pub(super) const fn rest(&mut self) {
        self.is_quiet = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_derived_stands_until_something_changes() {
        let mut changes = Changes::default();
        assert!(changes.are_news() && changes.compare() && changes.measure());
        changes.settle();
        assert!(!changes.are_news() && !changes.compare() && !changes.measure());
        changes.note();
        assert!(changes.are_news() && changes.compare() && changes.measure());
        changes.process();
        assert!(!changes.are_news() && changes.compare() && changes.measure());
    }

    #[test]
    fn guards_are_evaluated_again_with_new_facts_or_where_a_jump_is_allowed() {
        let mut changes = Changes::default();
        let other = Facts { first: true, ..Facts::default() };
        let mut may_jump = |facts| changes.renew_facts(facts);
        assert!(may_jump(Facts::default()) && !may_jump(Facts::default()));
        assert!(may_jump(other) && !may_jump(other));
        changes.allow_jump();
        assert!(changes.renew_facts(other) && *changes.facts() == other);
    }

    #[test]
    fn what_expires_is_derived_again() {
        let mut stamp = Stamp::default();
        assert!(stamp.renew(Revision::FIRST) && !stamp.renew(Revision::FIRST));
        stamp.expire();
        assert!(!stamp.is_of(Revision::FIRST) && stamp.renew(Revision::FIRST));
    }
}
