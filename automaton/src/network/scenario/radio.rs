//! `[link]`: how far the radio carries, and how its reliability falls with the distance.

use pleach_continuous::network::reliability::ReliabilityError;
use pleach_continuous::network::{CubicReliability, LinkReliability, LogisticReliability};
use serde::{Deserialize, Serialize};

use crate::network::Link;

/// The radio: a model and its two distances.
///
/// The reliability of a link depends on its length alone: links reach through walls, as in the
/// paper. In a building the two distances should be those that hold through its walls.
/// [`ValidScenario::count_links`](super::ValidScenario::count_links) counts how many links of the
/// start cross walls.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinkRanges {
    /// How the reliability falls between the two distances. Default `cubic`.
    #[serde(default)]
    pub model: LinkModel,
    /// l: reliability 1 up to here.
    pub full_range: f64,
    /// u: reliability 0 from here on.
    pub max_range: f64,
    /// p of the logistic model, from 2 to [`STEEPEST`]. Default [`STEEPNESS`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steepness: Option<f64>,
}

/// The steepness of the logistic model where none is stated.
pub const STEEPNESS: f64 = 4.0;

/// The largest steepness: the reliability then falls within a fiftieth of the transition.
pub const STEEPEST: f64 = 100.0;

/// The link models that a scenario can name.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LinkModel {
    /// [`CubicReliability`], eq. (27) of the paper.
    #[default]
    Cubic,
    /// [`LogisticReliability`], whose steepness is chosen.
    Logistic,
}

impl LinkModel {
    /// The names that scenario files use.
    pub const NAMES: &'static [&'static str] = &["cubic", "logistic"];
}

impl LinkRanges {
    /// The cubic model of eq. (27) with these distances.
    pub const fn new(full_range: f64, max_range: f64) -> Self {
        Self { model: LinkModel::Cubic, full_range, max_range, steepness: None }
    }

    /// The link model.
    ///
    /// # Errors
    /// Unless 0 ≤ `full_range` < `max_range` and both are finite, and the steepness is at least 2.
    pub(crate) fn link(&self) -> Result<Link, ReliabilityError> {
        let Self { model, full_range, max_range, steepness } = *self;
        Ok(match model {
            LinkModel::Cubic => Link::new(CubicReliability::new(full_range, max_range)?),
            LinkModel::Logistic => Link::new(LogisticReliability::new(
                full_range,
                max_range,
                steepness.unwrap_or(STEEPNESS),
            )?),
        })
    }

    /// The same with the default written out that its model has.
    #[must_use]
    pub(super) fn with_defaults(self) -> Self {
        let steepness = match self.model {
            LinkModel::Cubic => None,
            LinkModel::Logistic => Some(self.steepness.unwrap_or(STEEPNESS)),
        };
        Self { steepness, ..self }
    }

    /// The distance at which the reliability is `reliability`, a number between 0 and 1; for
    /// ranges that make no link model, l.
    pub fn distance_of(&self, reliability: f64) -> f64 {
        self.link().map_or(self.full_range, |link| link.distance_at(reliability))
    }
}
