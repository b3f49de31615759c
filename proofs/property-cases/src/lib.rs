//! How many cases a property test draws: few in every run, many on request.
//!
//! A test without a configuration draws 256 cases or, where the environment says so,
//! `PROPTEST_CASES`. One whose cases take longer or shorter than most says how many it
//! [`usually`] draws, and draws its share of more.

use proptest::test_runner::Config;

/// The number of cases that a test usually draws which says nothing of it; proptest's own.
pub const USUAL: u32 = 256;

/// The configuration of a test that usually draws `cases` cases: in proportion more if
/// `PROPTEST_CASES` asks for more than [`USUAL`], and never fewer.
///
/// ```
/// let config = cases::usually(64);
/// assert!(config.cases >= 64);
/// ```
pub fn usually(cases: u32) -> Config {
    let config = Config::default();
    let asked = std::env::var_os("PROPTEST_CASES").map_or(USUAL, |_| config.cases);
    Config { cases: share(cases, asked), ..config }
}

fn share(cases: u32, asked: u32) -> u32 {
    let share = u64::from(cases) * u64::from(asked) / u64::from(USUAL);
    cases.max(u32::try_from(share).unwrap_or(u32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_cases_are_shared_and_fewer_are_not() {
        assert_eq!(share(64, USUAL), 64);
        assert_eq!(share(64, 4 * USUAL), 256);
        assert_eq!(share(1000, 2 * USUAL), 2000);
        assert_eq!(share(1000, 1), 1000);
        assert_eq!(share(u32::MAX, u32::MAX), u32::MAX);
    }
}
