//! How margins change over time: crossings, and hysteresis against chatter.

use std::error::Error;
use std::fmt;

use crate::predicate::Verdict;

#[cfg(any(kani, test))]
mod proofs;

/// What a predicate does between two successive instants.
///
/// The two sides are half-open: an instant on the boundary belongs to one side and never to both.
/// So an event exactly on an instant is seen in the step that reaches it and not again in the step
/// that leaves it:
///
/// ```
/// use pleach_guards::Crossing;
///
/// assert_eq!(Crossing::between_margins(-1.0, 0.0), Crossing::Rising);
/// assert_eq!(Crossing::between_margins(0.0, 1.0), Crossing::None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// It did not hold, and now it does.
    Rising,
    /// It held, and now it does not.
    Falling,
    /// It stays as it was.
    None,
}

impl Crossing {
    /// The crossing between two verdicts of one predicate; strictness decides on the boundary.
    pub fn between(before: Verdict, after: Verdict) -> Crossing {
        Crossing::from_sides(before.holds, after.holds)
    }

    /// The crossing between two margins, where margin 0 belongs to the side that holds.
    ///
    /// A margin that is NaN counts as the side that does not hold.
    pub fn between_margins(before: f64, after: f64) -> Crossing {
        Crossing::from_sides(before >= 0.0, after >= 0.0)
    }

    fn from_sides(before: bool, after: bool) -> Crossing {
        match (before, after) {
            (false, true) => Crossing::Rising,
            (true, false) => Crossing::Falling,
            _ => Crossing::None,
        }
    }
}

/// A switch on a margin with two thresholds, so that noise around one of them does not chatter.
///
/// It turns on when the margin reaches `engage`, and off when the margin falls below `release`.
///
/// ```
/// use pleach_guards::Hysteresis;
///
/// let band = Hysteresis::new(-0.5, 0.5)?;
/// let margins = [0.0, 0.5, 0.0, -0.5, -0.6, 0.0];
/// let states = margins.iter().scan(false, |on, &margin| {
///     *on = band.update(*on, margin);
///     Some(*on)
/// });
/// assert!(states.eq([false, true, true, true, false, false]));
/// # Ok::<(), pleach_guards::InvertedBand>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hysteresis {
    release: f64,
    engage: f64,
}

impl Hysteresis {
    /// The switch with these thresholds, in the unit of the margin.
    ///
    /// # Errors
    ///
    /// [`InvertedBand`] unless `release` ≤ `engage`.
    pub fn new(release: f64, engage: f64) -> Result<Self, InvertedBand> {
        if release <= engage {
            Ok(Hysteresis { release, engage })
        } else {
            Err(InvertedBand { release, engage })
        }
    }

    /// Whether the switch is on at `margin`, after it was `on`.
    ///
    /// A margin that is NaN turns it off.
    pub fn update(&self, on: bool, margin: f64) -> bool {
        if on { margin >= self.release } else { margin >= self.engage }
    }
}

/// The thresholds of a [`Hysteresis`] stand in the wrong order, or one of them is NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InvertedBand {
    /// The threshold given for turning off.
    pub release: f64,
    /// The threshold given for turning on.
    pub engage: f64,
}

impl fmt::Display for InvertedBand {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let InvertedBand { release, engage } = self;
        write!(formatter, "hysteresis releases at {release} and engages at {engage}: ")?;
        write!(formatter, "the first must be at most the second")
    }
}

impl Error for InvertedBand {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_event_on_an_instant_fires_once() {
        let margins = [-1.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0, -1.0];
        let crossings = margins.windows(2).map(|pair| Crossing::between_margins(pair[0], pair[1]));
        use Crossing::{Falling, None, Rising};
        assert!(crossings.eq([Rising, None, None, None, Falling, Rising, Falling]));
    }

    #[test]
    fn strict_predicates_put_the_boundary_on_the_other_side() {
        let at = |margin, holds| Verdict { margin, holds };
        assert_eq!(Crossing::between(at(-1.0, false), at(0.0, false)), Crossing::None);
        assert_eq!(Crossing::between(at(0.0, false), at(1.0, true)), Crossing::Rising);
    }

    /// Off below −1, on from 2, and between them as it was; both ends belong to what is on.
    #[test]
    fn a_switch_turns_at_its_thresholds() {
        let switch = Hysteresis::new(-1.0, 2.0).expect("in order");
        let cases = [(-1.5, false, false), (-1.0, false, true), (1.5, false, true)];
        for (margin, from_off, from_on) in cases.into_iter().chain([(2.0, true, true)]) {
            let found = (switch.update(false, margin), switch.update(true, margin));
            assert_eq!(found, (from_off, from_on), "{margin}");
        }
    }

    #[test]
    fn inverted_bands_are_refused() {
        assert!(Hysteresis::new(1.0, 0.0).is_err());
        assert!(Hysteresis::new(f64::NAN, 0.0).is_err());
        assert!(Hysteresis::new(0.0, 0.0).is_ok());
        let error = Hysteresis::new(1.0, 0.5).expect_err("inverted");
        let text = "hysteresis releases at 1 and engages at 0.5: \
                    the first must be at most the second";
        assert_eq!(error.to_string(), text);
    }
}
