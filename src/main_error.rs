//! The error of a `main` that uses `?`.

use std::error::Error;
use std::fmt;

/// Any error, for `fn main() -> Result<(), MainError>`: the message of the error and of its causes is
/// printed, instead of its debug form.
///
/// It is not itself an [`Error`], since `?` could then not convert every error to it. A function that others call
/// returns an error of its own, or `Box<dyn Error + Send + Sync>`.
///
/// ```
/// use pleach::prelude::*;
///
/// fn read() -> Result<f64, MainError> {
///     Ok("3,5".parse::<f64>()?)
/// }
/// assert_eq!(format!("{:?}", read().unwrap_err()), "invalid float literal");
/// ```
pub struct MainError(Box<dyn Error + Send + Sync>);

impl<E: Into<Box<dyn Error + Send + Sync>>> From<E> for MainError {
    fn from(error: E) -> Self {
        MainError(error.into())
    }
}

impl fmt::Display for MainError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut message = self.0.to_string();
        formatter.write_str(&message)?;
        let mut cause = self.0.source();
        while let Some(error) = cause {
            let next = error.to_string();
            // Many errors end with the message of their cause.
            if !message.ends_with(&next) {
                write!(formatter, "\n  because {next}")?;
            }
            (message, cause) = (next, error.source());
        }
        Ok(())
    }
}

impl fmt::Debug for MainError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, formatter)
    }
}
