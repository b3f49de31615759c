//! What is known of the harnesses: `proofs/harnesses.toml`.

use serde::Deserialize;

use crate::generated::read;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Catalogue {
    /// The tool that has run on them.
    pub tool: String,
    pub harness: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    pub name: String,
    pub group: String,
    /// An item of the product, and its file.
    pub about: (String, String),
    pub draws: String,
    /// How many values a case draws, at the most.
    pub values: usize,
    /// None where there are too many to run them all.
    pub cases: Option<u64>,
    pub kani: Option<Run>,
}

/// What the tool has said.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    pub date: String,
    /// Processor time until it was verified.
    pub seconds: Option<f64>,
    /// Why it was not.
    pub failure: Option<String>,
    /// The digest of the harness then.
    pub digest: String,
}

pub fn catalogue() -> Catalogue {
    toml::from_str(&read("proofs/harnesses.toml")).unwrap()
}

impl Run {
    /// Whether it has a date, and either a time or a reason.
    pub fn is_whole(&self) -> bool {
        !self.date.is_empty() && self.seconds.is_some() != self.failure.is_some()
    }
}
