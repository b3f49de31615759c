//! Hybrid time.

use std::cmp::Ordering;
use std::fmt;

use serde::{Deserialize, Serialize};

/// Hybrid time (t, j): t seconds have passed and j jumps have been taken.
///
/// Hybrid times are ordered by t and then by j (Goebel, Sanfelice and Teel 2009,
/// [doi:10.1109/MCS.2008.931718](https://doi.org/10.1109/MCS.2008.931718)): a jump does not take
/// time, and what is before it and after it stand at the same t, at j and j + 1.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct HybridTime {
    /// Seconds since the start, finite and ≥ 0.
    pub t: f64,
    /// Jumps since the start.
    pub j: u32,
}

impl HybridTime {
    /// The start of every run, (0, 0).
    pub const START: HybridTime = HybridTime { t: 0.0, j: 0 };

    /// The time after `duration` seconds of flow.
    pub fn after_flow(self, duration: f64) -> HybridTime {
        HybridTime { t: self.t + duration, ..self }
    }

    /// The time after one jump.
    pub fn after_jump(self) -> HybridTime {
        HybridTime { j: self.j + 1, ..self }
    }
}

impl Ord for HybridTime {
    fn cmp(&self, other: &Self) -> Ordering {
        self.t.total_cmp(&other.t).then(self.j.cmp(&other.j))
    }
}

impl PartialOrd for HybridTime {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for HybridTime {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for HybridTime {}

impl fmt::Display for HybridTime {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "({} s, {})", self.t, self.j)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_passes_before_jumps_count() {
        let start = HybridTime::START;
        let jumped = start.after_jump().after_jump();
        let flowed = start.after_flow(0.5);
        assert!(start < jumped && jumped < flowed && flowed < flowed.after_jump());
        assert_eq!(flowed, HybridTime { t: 0.5, j: 0 });
    }
}
