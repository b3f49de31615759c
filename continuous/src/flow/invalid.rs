//! What no flow can be made of.

use thiserror::Error;

/// Why a constant or linear flow cannot be made.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum InvalidFlow {
    /// Something has not the dimension of the state.
    #[error("{what}: length {found}, but the state has dimension {dimension}")]
    Length {
        /// What it is.
        what: &'static str,
        /// How long it is.
        found: usize,
        /// The dimension of the state.
        dimension: usize,
    },
    /// An entry is infinite or NaN.
    #[error("entry {index} of the {what} is {value}: it must be finite")]
    NotFinite {
        /// Where the entry is.
        what: &'static str,
        /// Its index, counted from 0; in a matrix column by column.
        index: usize,
        /// What was given.
        value: f64,
    },
    /// The duration is negative, NaN, or infinite where it must not be.
    #[error("a flow cannot last {duration} s")]
    Duration {
        /// What was given, in seconds.
        duration: f64,
    },
}

impl InvalidFlow {
    pub(super) fn check_length(
        what: &'static str,
        found: usize,
        dimension: usize,
    ) -> Result<(), InvalidFlow> {
        if found == dimension {
            Ok(())
        } else {
            Err(InvalidFlow::Length { what, found, dimension })
        }
    }

    pub(super) fn check_finite(what: &'static str, entries: &[f64]) -> Result<(), InvalidFlow> {
        match entries.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            Some((index, &value)) => Err(InvalidFlow::NotFinite { what, index, value }),
            None => Ok(()),
        }
    }
}
