//! Ranges of radios, and the clearance of robots whose radius is not known.

use std::str::FromStr;

/// The share of the extent that links are long where no radio is named.
const SHARE: f64 = 1.0 / 6.0;
/// u / l where only one of them is stated.
pub(super) const TRANSITION: f64 = 1.25;
/// l / ρ where no radius is stated, as in scenarios.
const CLEARANCES: f64 = 40.0;

/// A kind of radio, with ranges in metres that it usually has in buildings. They are round numbers to begin with: measure
/// your own, and let the full range hold through the walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Radio {
    /// Bluetooth Low Energy of class 2: 8 m, 10 m.
    Bluetooth,
    /// IEEE 802.15.4 at 2.4 GHz, such as Zigbee: 15 m, 20 m.
    Zigbee,
    /// IEEE 802.11 at 2.4 GHz between robots: 25 m, 35 m.
    Wifi,
}

impl Radio {
    /// l and u in metres: links are fully reliable up to l, and end at u.
    pub const fn ranges(self) -> [f64; 2] {
        match self {
            Self::Bluetooth => [8.0, 10.0],
            Self::Zigbee => [15.0, 20.0],
            Self::Wifi => [25.0, 35.0],
        }
    }
}

impl FromStr for Radio {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "bluetooth" => Ok(Self::Bluetooth),
            "zigbee" => Ok(Self::Zigbee),
            "wifi" => Ok(Self::Wifi),
            _ => Err(format!("{text:?} is no kind of radio: bluetooth, zigbee and wifi are")),
        }
    }
}

/// l by default, about a sixth of the extent, to two digits.
pub(super) fn default_full_range(extent: f64) -> f64 {
    let step = 10f64.powf((extent * SHARE).log10().floor() - 1.0);
    trimmed((extent * SHARE / step).round() * step)
}

/// ρ by default.
pub(super) fn default_clearance(extent: f64) -> f64 {
    trimmed(default_full_range(extent) / CLEARANCES)
}

/// A number without the rounding of its last digits.
pub(super) fn trimmed(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}
