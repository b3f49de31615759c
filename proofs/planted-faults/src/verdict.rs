//! What has become of a fault.

use std::fmt;

/// The exit status of `timeout` when it has ended the command.
const TIMED_OUT: i32 = 124;

/// What has become of a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Caught,
    Survived,
    OtherReason,
    DoesNotBuild,
    TimedOut,
}

impl Verdict {
    /// By the exit status of its command, what that said, and what it should say.
    pub fn of(status: Option<i32>, said: &str, should_say: &str) -> Self {
        match status {
            Some(0) => Verdict::Survived,
            Some(TIMED_OUT) => Verdict::TimedOut,
            _ if said.contains("error: could not compile") => Verdict::DoesNotBuild,
            _ if said.contains(should_say) => Verdict::Caught,
            _ => Verdict::OtherReason,
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::Caught => "caught",
            Verdict::Survived => "SURVIVED",
            Verdict::OtherReason => "FAILS FOR ANOTHER REASON",
            Verdict::DoesNotBuild => "DOES NOT BUILD",
            Verdict::TimedOut => "TIMED OUT",
        })
    }
}
