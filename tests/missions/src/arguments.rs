//! The arguments of the example `storm`.

/// How many missions are asked for.
///
/// # Errors
/// What may be asked for.
pub fn missions(text: &str) -> Result<u64, String> {
    count(text).map_err(|error| {
        format!("{error}: how many missions are to be run; or it is one of seed, one and table")
    })
}

/// A number of missions or storms.
///
/// # Errors
/// Which numbers are possible.
pub fn count(text: &str) -> Result<u64, String> {
    text.parse()
        .ok()
        .filter(|&count| count > 0)
        .ok_or_else(|| format!("a whole number from 1 to {} is expected", u64::MAX))
}

/// A seed.
///
/// # Errors
/// Which numbers are possible.
pub fn seed(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| format!("a whole number from 0 to {} is expected", u64::MAX))
}
