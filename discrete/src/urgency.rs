//! Whether a transition whose guard holds has to be taken.

use std::fmt;

/// How urgent a transition is. There is no default: every transition says it.
///
/// The kinds differ in what they allow time to do:
///
/// | urgency | may time pass while the guard holds? | who takes the transition |
/// | --- | --- | --- |
/// | [`May`](Urgency::May) | yes | someone who asks for it by its event |
/// | [`Must`](Urgency::Must) | no, time ends at the instant at which the guard becomes true | the executor, which looks for that instant along the flow |
/// | [`AtOnce`](Urgency::AtOnce) | no, not even on entering the location | the executor, right after the jump that made the guard true |
///
/// So *must* is for guards that a flow makes true (a clock runs out, a level is reached), and *at
/// once* for guards that a jump makes true (a message is there, a flag is set). A guard of *must*
/// that holds already on entry is taken at that instant too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Urgency {
    /// Enabled but not forced: time may pass, and the transition may be missed.
    May,
    /// Time cannot pass beyond the instant at which the guard becomes true.
    Must,
    /// No time passes in a state where the guard holds.
    AtOnce,
}

impl Urgency {
    /// The name in tables and diagrams.
    pub const fn name(self) -> &'static str {
        match self {
            Urgency::May => "may",
            Urgency::Must => "must",
            Urgency::AtOnce => "at once",
        }
    }

    /// Whether time has to wait for the transition.
    pub const fn is_forced(self) -> bool {
        !matches!(self, Urgency::May)
    }
}

impl fmt::Display for Urgency {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::Urgency::{AtOnce, May, Must};

    #[test]
    fn time_waits_for_all_but_may() {
        assert_eq!([May, Must, AtOnce].map(super::Urgency::is_forced), [false, true, true]);
    }

    #[test]
    fn urgencies_print_their_name() {
        let names = [May, Must, AtOnce].map(|urgency| urgency.to_string());
        assert_eq!(names, ["may", "must", "at once"]);
    }
}
