//! Expressions, predicates and guards as their text, for files of any format (feature `serde`).
//!
//! An [`Expression`] and a [`Predicate`] are stored as the string that they print and read again
//! by [`mod@crate::parse`]; a [`Guard`] is stored as its name and its predicate:
//!
//! ```
//! use pleach_guards::{Guard, variable};
//!
//! let close = Guard::new("close", variable("distance").at_most(0.5));
//! let text = serde_json::to_string(&close)?;
//! assert_eq!(text, r#"{"name":"close","predicate":"distance ≤ 0.5"}"#);
//! assert_eq!(serde_json::from_str::<Guard>(&text)?, close);
//! # Ok::<(), serde_json::Error>(())
//! ```
//!
//! A predicate with a [function](Predicate::function) cannot be stored, and the error names it.

use std::fmt;
use std::marker::PhantomData;
use std::str::FromStr;

use serde::de::{self, Deserialize, Deserializer, Visitor};
use serde::ser::{Error, Serialize, Serializer};

use crate::expression::Expression;
use crate::guard::Guard;
use crate::parse::ParseError;
use crate::predicate::Predicate;

impl Serialize for Expression {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl Serialize for Predicate {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.functions().first() {
            None => serializer.collect_str(self),
            Some(name) => Err(S::Error::custom(format_args!(
                "the predicate `{self}` cannot be stored: `{name}` is a function and not data"
            ))),
        }
    }
}

impl<'de> Deserialize<'de> for Expression {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_str(Text { what: "an expression", result: PhantomData })
    }
}

impl<'de> Deserialize<'de> for Predicate {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_str(Text { what: "a predicate", result: PhantomData })
    }
}

/// A visitor that reads a string as `what` it says.
struct Text<T> {
    what: &'static str,
    result: PhantomData<T>,
}

impl<T: FromStr<Err = ParseError>> Visitor<'_> for Text<T> {
    type Value = T;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} as text", self.what)
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<T, E> {
        text.parse()
            .map_err(|error| E::custom(format_args!("`{text}` is not {}: {error}", self.what)))
    }
}

/// A guard on its way into a file.
#[derive(serde::Serialize)]
#[serde(rename = "Guard")]
struct Stored<'a> {
    name: &'a str,
    predicate: &'a Predicate,
}

/// A guard on its way out of a file.
#[derive(serde::Deserialize)]
#[serde(rename = "Guard", deny_unknown_fields)]
struct Restored {
    name: String,
    predicate: Predicate,
}

impl Serialize for Guard {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Stored { name: self.name(), predicate: self.predicate() }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Guard {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let Restored { name, predicate } = Restored::deserialize(deserializer)?;
        Ok(Guard::new(&name, predicate))
    }
}
