//! How the parts of messages are written and read where serde's derive alone does not do.
//!
//! Shared values are written as the value that they share. Numbers that are not finite are refused:
//! no node sends one, and a position that is not a number would spread.

use std::fmt::Display;
use std::sync::Arc;

use pleach_continuous::Point;
use pleach_continuous::network::acceptance::Segment;
use pleach_continuous::network::routing::adal::NeighbourReport;
use serde::de::{Deserialize, DeserializeOwned, Deserializer, Error};
use serde::ser::{Serialize, Serializer};

use super::order::Errand;
use super::robot::{FlowGrant, FlowRequest, Probe};
use super::shared::Shared;

/// A part of a message.
pub(super) trait Part: Sized {
    /// Writes it.
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error>;

    /// Reads one.
    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error>;
}

/// Writes a part of a message, for `#[serde(with = "wire")]`.
pub(super) fn serialize<T: Part, S: Serializer>(
    part: &T,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    part.write(serializer)
}

/// Reads a part of a message, for `#[serde(with = "wire")]`.
pub(super) fn deserialize<'de, T: Part, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<T, D::Error> {
    T::read(deserializer)
}

// ---- Numbers ---------------------------------------------------------------------------------

/// The first number of a part that is not finite.
trait Numbers {
    fn not_finite(&self) -> Option<f64>;
}

impl Numbers for f64 {
    fn not_finite(&self) -> Option<f64> {
        (!self.is_finite()).then_some(*self)
    }
}

impl Numbers for Point {
    fn not_finite(&self) -> Option<f64> {
        self.iter().find_map(Numbers::not_finite)
    }
}

impl Numbers for Option<Point> {
    fn not_finite(&self) -> Option<f64> {
        self.as_ref().and_then(Numbers::not_finite)
    }
}

impl Numbers for Segment {
    fn not_finite(&self) -> Option<f64> {
        self.from.not_finite().or(self.to.not_finite())
    }
}

impl Numbers for FlowRequest {
    fn not_finite(&self) -> Option<f64> {
        self.held.not_finite().or(self.wanted.not_finite())
    }
}

impl Numbers for FlowGrant {
    fn not_finite(&self) -> Option<f64> {
        self.flow.not_finite().or(self.part.and_then(|part| part.flow.not_finite()))
    }
}

impl Numbers for Probe {
    fn not_finite(&self) -> Option<f64> {
        self.flow.not_finite()
    }
}

impl Numbers for NeighbourReport {
    fn not_finite(&self) -> Option<f64> {
        let NeighbourReport { multiplier, mismatch, crowding } = self;
        [multiplier, mismatch, crowding].into_iter().find_map(Numbers::not_finite)
    }
}

/// Reads a part whose numbers must be finite.
fn read_finite<'de, T, D>(deserializer: D) -> Result<T, D::Error>
where
    T: Deserialize<'de> + Numbers,
    D: Deserializer<'de>,
{
    let part = T::deserialize(deserializer)?;
    match part.not_finite() {
        None => Ok(part),
        Some(number) => Err(refusal(number)),
    }
}

fn refusal<E: Error>(number: impl Display) -> E {
    E::custom(format_args!("the number {number} in a message is not finite"))
}

macro_rules! finite_parts {
    ($($part:ty),+ $(,)?) => {
        $(impl Part for $part {
            fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                self.serialize(serializer)
            }

            fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                read_finite(deserializer)
            }
        })+
    };
}

finite_parts!(f64, Point, Option<Point>, Segment, FlowRequest, FlowGrant, Probe, NeighbourReport);

/// Distances, which are infinite where no way leads: written as none, since not every format has
/// infinite numbers.
pub(super) mod distance {
    use super::{Deserialize, Deserializer, Numbers, Serialize, Serializer, refusal};

    pub(in super::super) fn serialize<S: Serializer>(
        distance: &f64,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        (*distance < f64::INFINITY).then_some(*distance).serialize(serializer)
    }

    pub(in super::super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<f64, D::Error> {
        let distance = Option::<f64>::deserialize(deserializer)?;
        match distance.and_then(|distance| distance.not_finite()) {
            None => Ok(distance.unwrap_or(f64::INFINITY)),
            Some(number) => Err(refusal(number)),
        }
    }
}

// ---- Shared values ---------------------------------------------------------------------------

impl<T: Serialize + DeserializeOwned> Part for Arc<T> {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        T::serialize(self, serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(Arc::new)
    }
}

impl<T: Serialize + DeserializeOwned> Part for Option<Arc<T>> {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.as_deref().serialize(serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(Option::deserialize(deserializer)?.map(Arc::new))
    }
}

impl Part for Arc<[Errand]> {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        <[Errand]>::serialize(self, serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::<Errand>::deserialize(deserializer).map(Arc::from)
    }
}

impl Part for Arc<[Point]> {
    fn write<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        <[Point]>::serialize(self, serializer)
    }

    fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let points = Vec::<Point>::deserialize(deserializer)?;
        match points.iter().find_map(Numbers::not_finite) {
            None => Ok(Arc::from(points)),
            Some(number) => Err(refusal(number)),
        }
    }
}

impl<T: Serialize> Serialize for Shared<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        T::serialize(self, serializer)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Shared<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(Shared::new)
    }
}
