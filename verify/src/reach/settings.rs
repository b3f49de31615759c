//! How an enclosure is computed.

use pleach_guards::Interval;
use thiserror::Error;

use super::rounding::plus_up;

/// The directions in which sets are bounded, beside those of guards, invariants and questions.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Directions {
    /// ±eᵢ.
    #[default]
    Boxes,
    /// ±eᵢ and ±eᵢ ± eⱼ.
    Octagons,
    /// ±eᵢ and these, with their opposites.
    Listed(Vec<Vec<f64>>),
}

/// How far and how finely an enclosure goes.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// For how long, in seconds; ∞ for all times, which ends where nothing new is reached.
    pub horizon: f64,
    /// The length of steps of affine flows, in seconds. Steps of other flows choose their length, up
    /// to this.
    pub step: f64,
    /// The directions in which sets are bounded.
    pub directions: Directions,
    /// Whether a jump is possible only into the invariant of its target, as SpaceEx has it. Otherwise a
    /// jump can also lead outside, where no time passes, as `docs/semantics.md` has it.
    pub enters_invariants: bool,
    /// How many sets are made of the states of one flow in which a guard may hold.
    pub clusters: usize,
    /// How many jumps may follow each other.
    pub jump_limit: usize,
    /// How many segments of all flows together are computed.
    pub segment_limit: usize,
    /// How many generators a zonotope keeps for each variable.
    pub generators: usize,
    /// Flows that are not affine: the order of Taylor series in time.
    pub order: usize,
    /// Flows that are not affine: the degree of polynomials in the initial state.
    pub degree: usize,
    /// Flows that are not affine: the error that each step may add, as a share of the state.
    pub tolerance: f64,
}

/// How many segments another attempt may take, however short the first was.
const ATTEMPT: usize = 20_000;

/// A setting makes no sense.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("`{setting}` is {value}, and has to be {expected}")]
pub struct InvalidSetting {
    /// Which.
    pub setting: &'static str,
    /// What it is.
    pub value: String,
    /// What would be right.
    pub expected: &'static str,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            horizon: 10.0,
            step: 0.01,
            directions: Directions::Boxes,
            enters_invariants: false,
            clusters: 1,
            jump_limit: 100,
            segment_limit: 1_000_000,
            generators: 20,
            order: 8,
            degree: 2,
            tolerance: 1e-9,
        }
    }
}

impl Settings {
    /// How long runs can go on that have lasted for `elapsed`, at least.
    pub(super) fn time_left(&self, elapsed: Interval) -> f64 {
        plus_up(self.horizon, -elapsed.lower())
    }

    /// How long runs have lasted that are not beyond the horizon; none if all are.
    pub(super) fn in_time(&self, elapsed: Interval) -> Option<Interval> {
        Interval::new(elapsed.lower(), elapsed.upper().min(self.horizon)).ok()
    }

    /// More sets at guards, for another attempt after one that took this many segments, which takes a few
    /// times as long at most.
    pub(super) fn finer(&self, factor: usize, segments: usize) -> Self {
        let segment_limit = self.segment_limit.min((4 * segments).max(ATTEMPT));
        Settings { clusters: factor * self.clusters, segment_limit, ..self.clone() }
    }

    /// Says which setting makes no sense, if one does.
    pub(super) fn check(&self, dimension: usize) -> Result<(), InvalidSetting> {
        let wrong =
            |setting, value: String, expected| Err(InvalidSetting { setting, value, expected });
        if self.horizon.is_nan() || self.horizon < 0.0 {
            return wrong("horizon", self.horizon.to_string(), "a duration, or ∞");
        }
        if !(self.step > 0.0 && self.step.is_finite()) {
            return wrong("step", self.step.to_string(), "a duration above 0");
        }
        if self.clusters == 0 {
            return wrong("clusters", "0".into(), "at least 1");
        }
        if !(1..=30).contains(&self.order) {
            return wrong("order", self.order.to_string(), "from 1 to 30");
        }
        if !(1..=6).contains(&self.degree) {
            return wrong("degree", self.degree.to_string(), "from 1 to 6");
        }
        if !(self.tolerance > 0.0 && self.tolerance.is_finite()) {
            return wrong("tolerance", self.tolerance.to_string(), "above 0");
        }
        if let Directions::Listed(listed) = &self.directions
            && let Some(bad) = listed.iter().find(|direction| direction.len() != dimension)
        {
            return wrong(
                "directions",
                format!("{bad:?}"),
                "vectors with an entry for each variable",
            );
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach::exact::fraction;

    #[test]
    fn the_time_left_is_rounded_up() {
        for tenths in 1..40 {
            let (horizon, elapsed) = (f64::from(tenths) * 0.3, f64::from(tenths) * 0.1);
            let settings = Settings { horizon, ..Settings::default() };
            let left = settings.time_left(Interval::point(elapsed));
            assert!(fraction(left) >= fraction(horizon) - fraction(elapsed), "{tenths}");
        }
        let endless = Settings { horizon: f64::INFINITY, ..Settings::default() };
        assert_eq!(endless.time_left(Interval::point(3.0)), f64::INFINITY);
    }
}
