//! Formulas of signal temporal logic as data.

use std::fmt;
use std::ops;
use std::sync::Arc;

use pleach_guards::Predicate;

/// A statement about a trajectory, seen from one of its instants.
///
/// A [`Predicate`] speaks of a single state. A formula adds time: [`always`], [`eventually`] and
/// [`until`](Formula::until), each over a [`Window`] of seconds from now. Formulas combine by
/// [`and`](Formula::and), [`or`](Formula::or), [`implies`](Formula::implies) and [`not`], or with
/// `&`, `|` and `!`. Wherever a formula is asked for, a predicate may stand.
///
/// ```
/// use pleach_guards::variable;
/// use pleach_verify::temporal::{Formula, always, eventually, within};
///
/// let alarm = Formula::holds(variable("temperature").more_than(90.0));
/// let cooled = variable("temperature").at_most(60.0);
/// let cools_in_time = alarm.implies(eventually(within(0.0, 5.0)?, cooled));
///
/// assert_eq!(
///     always(within(0.0, 100.0)?, cools_in_time).to_string(),
///     "□[0, 100] (temperature > 90 → ◇[0, 5] (temperature ≤ 60))",
/// );
/// # Ok::<(), pleach_verify::temporal::InvalidWindow>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Formula {
    /// The state satisfies a predicate.
    Holds(Predicate),
    /// The opposite of a formula.
    Not(Arc<Formula>),
    /// All of them; with none, this is true.
    All(Arc<[Formula]>),
    /// At least one of them; with none, this is false.
    Any(Arc<[Formula]>),
    /// The second, where the first is true.
    Implies(Arc<Formula>, Arc<Formula>),
    /// □: at all instants of the window.
    Always(Window, Arc<Formula>),
    /// ◇: at some instant of the window.
    Eventually(Window, Arc<Formula>),
    /// 𝒰: the second at some instant of the window, and the first from now until just before it.
    Until(Window, Arc<Formula>, Arc<Formula>),
}

/// `formula` is true at every instant of `window`.
pub fn always(window: Window, formula: impl Into<Formula>) -> Formula {
    Formula::Always(window, Arc::new(formula.into()))
}

/// `formula` is true at some instant of `window`.
pub fn eventually(window: Window, formula: impl Into<Formula>) -> Formula {
    Formula::Eventually(window, Arc::new(formula.into()))
}

/// The formula that is true where `formula` is not.
pub fn not(formula: impl Into<Formula>) -> Formula {
    Formula::Not(Arc::new(formula.into()))
}

impl Formula {
    /// The present state satisfies `predicate`.
    pub fn holds(predicate: Predicate) -> Formula {
        Formula::Holds(predicate)
    }

    /// `goal` becomes true at some instant of `window`, and `self` is true from now until then;
    /// at that instant itself, `self` may be false.
    pub fn until(self, window: Window, goal: impl Into<Formula>) -> Formula {
        Formula::Until(window, Arc::new(self), Arc::new(goal.into()))
    }

    /// Both are true.
    pub fn and(self, other: impl Into<Formula>) -> Formula {
        Formula::All([self, other.into()].into())
    }

    /// At least one of the two is true.
    pub fn or(self, other: impl Into<Formula>) -> Formula {
        Formula::Any([self, other.into()].into())
    }

    /// `consequence` is true if `self` is.
    pub fn implies(self, consequence: impl Into<Formula>) -> Formula {
        Formula::Implies(Arc::new(self), Arc::new(consequence.into()))
    }

    /// How many seconds of trajectory settle the formula whatever comes later; ∞ if there may be
    /// no such number.
    ///
    /// ```
    /// use pleach_guards::variable;
    /// use pleach_verify::temporal::{always, eventually, within};
    ///
    /// let visited = eventually(within(1.0, 3.0)?, variable("x").at_least(2.0));
    /// assert_eq!(always(within(0.0, 10.0)?, visited).horizon(), 13.0);
    /// # Ok::<(), pleach_verify::temporal::InvalidWindow>(())
    /// ```
    pub fn horizon(&self) -> f64 {
        match self {
            Formula::Holds(_) => 0.0,
            Formula::Not(inner) => inner.horizon(),
            Formula::All(parts) | Formula::Any(parts) => {
                parts.iter().map(Formula::horizon).fold(0.0, f64::max)
            }
            Formula::Implies(first, second) => first.horizon().max(second.horizon()),
            Formula::Always(window, inner) | Formula::Eventually(window, inner) => {
                window.end + inner.horizon()
            }
            Formula::Until(window, first, second) => {
                window.end + first.horizon().max(second.horizon())
            }
        }
    }
}

impl From<Predicate> for Formula {
    fn from(predicate: Predicate) -> Formula {
        Formula::Holds(predicate)
    }
}

impl From<&Formula> for Formula {
    fn from(formula: &Formula) -> Formula {
        formula.clone()
    }
}

impl ops::Not for Formula {
    type Output = Formula;

    fn not(self) -> Formula {
        not(self)
    }
}

impl<F: Into<Formula>> ops::BitAnd<F> for Formula {
    type Output = Formula;

    fn bitand(self, other: F) -> Formula {
        self.and(other)
    }
}

impl<F: Into<Formula>> ops::BitOr<F> for Formula {
    type Output = Formula;

    fn bitor(self, other: F) -> Formula {
        self.or(other)
    }
}

/// The instants from `start` to `end` seconds from now, both included; `end` may be ∞.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    start: f64,
    end: f64,
}

/// The window from `start` to `end` seconds from now; `end` may be ∞.
///
/// # Errors
///
/// [`InvalidWindow`] unless 0 ≤ `start` ≤ `end` and `start` is finite.
pub fn within(start: f64, end: f64) -> Result<Window, InvalidWindow> {
    if 0.0 <= start && start <= end && start.is_finite() {
        // Adding 0 turns −0 into 0.
        Ok(Window { start: start + 0.0, end: end + 0.0 })
    } else {
        Err(InvalidWindow { start, end })
    }
}

impl Window {
    /// All instants from now on.
    pub const UNBOUNDED: Window = Window { start: 0.0, end: f64::INFINITY };

    /// Seconds from now at which the window begins, finite and ≥ 0.
    pub fn start(self) -> f64 {
        self.start
    }

    /// Seconds from now at which the window ends, at least [`start`](Self::start), possibly ∞.
    pub fn end(self) -> f64 {
        self.end
    }
}

/// The bounds of a [`Window`] do not bound one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InvalidWindow {
    /// The start that was given, in seconds.
    pub start: f64,
    /// The end that was given, in seconds.
    pub end: f64,
}

impl fmt::Display for InvalidWindow {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let InvalidWindow { start, end } = self;
        write!(formatter, "no window of time goes from {start} s to {end} s: ")?;
        write!(formatter, "it must start at 0 or later, be finite there, and not end before")
    }
}

impl std::error::Error for InvalidWindow {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_point_forward() {
        assert!(within(0.0, 0.0).is_ok());
        assert!(within(1.0, f64::INFINITY).is_ok());
        for (start, end) in [(-1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::NAN)] {
            assert!(within(start, end).is_err(), "[{start}, {end}]");
        }
        assert!(within(f64::INFINITY, f64::INFINITY).is_err());
    }
}
