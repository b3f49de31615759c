//! Tangents, angles, and functions with jumps, on intervals.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Interval;
use super::rounding::loose;

impl Interval {
    /// The tangent of angles in radians; the whole line if there may be a pole among them.
    pub fn tan(self) -> Interval {
        let is_turned = self.width() >= PI;
        if is_turned || self.may_meet(FRAC_PI_2) || self.may_meet(-FRAC_PI_2) {
            return Interval::WHOLE;
        }
        loose(self.lower.tan(), self.upper.tan())
    }

    /// The hyperbolic tangent.
    pub fn tanh(self) -> Interval {
        let Interval { lower, upper } = loose(self.lower.tanh(), self.upper.tanh());
        Interval { lower: lower.max(-1.0), upper: upper.min(1.0) }
    }

    /// −1, 0 or 1, as numbers are negative, 0 or positive.
    pub fn sign(self) -> Interval {
        let sign = |value: f64| if value == 0.0 { 0.0 } else { value.signum() };
        Interval { lower: sign(self.lower), upper: sign(self.upper) }
    }

    /// The largest whole numbers that are at most the numbers of `self`.
    pub fn floor(self) -> Interval {
        Interval { lower: self.lower.floor(), upper: self.upper.floor() }
    }

    /// The angles of the points with x in `x` and y in `self`, in radians.
    ///
    /// On a rectangle that does not touch the cut, where y = 0 and x ≤ 0, the angle is largest and
    /// smallest at corners.
    pub fn atan2(self, x: Interval) -> Interval {
        let half_turn = loose(-PI, PI);
        if self.contains(0.0) && x.lower <= 0.0 {
            return half_turn;
        }
        let corner = |y: f64, x: f64| loose(y.atan2(x), y.atan2(x));
        let corners = corner(self.lower, x.lower)
            .hull(corner(self.lower, x.upper))
            .hull(corner(self.upper, x.lower))
            .hull(corner(self.upper, x.upper));
        corners.intersection(half_turn).unwrap_or(half_turn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn over(lower: f64, upper: f64) -> Interval {
        Interval { lower, upper }
    }

    fn is_near(found: Interval, lower: f64, upper: f64) -> bool {
        (found.lower - lower).abs() < 1e-12 && (found.upper - upper).abs() < 1e-12
    }

    #[test]
    fn tangents_know_their_poles() {
        assert!(is_near(over(-1.0, 1.5).tan(), -1f64.tan(), 1.5f64.tan()));
        assert!(is_near(over(2.0, 4.0).tan(), 2f64.tan(), 4f64.tan()));
        for poles in [over(1.5, 1.6), over(-1.6, -1.5), over(0.0, 4.0), over(4.7, 4.72)] {
            assert_eq!(poles.tan(), Interval::WHOLE, "{poles}");
        }
        assert_eq!(Interval::WHOLE.tan(), Interval::WHOLE);
        assert_eq!(Interval::WHOLE.tanh(), over(-1.0, 1.0));
    }

    #[test]
    fn jumps_are_inside() {
        assert_eq!(over(-2.0, 0.0).sign(), over(-1.0, 0.0));
        assert_eq!(over(-0.0, 3.0).sign(), over(0.0, 1.0));
        assert_eq!(over(-0.5, 2.75).floor(), over(-1.0, 2.0));
    }

    #[test]
    fn angles_turn_around_the_origin() {
        assert!(is_near(over(1.0, 2.0).atan2(over(1.0, 2.0)), 0.5f64.atan(), 2f64.atan()));
        assert!(is_near(over(1.0, 2.0).atan2(over(-1.0, 1.0)), 1f64.atan2(1.0), 1f64.atan2(-1.0)));
        assert!(is_near(over(-1.0, 1.0).atan2(over(1.0, 2.0)), -1f64.atan(), 1f64.atan()));
        for cut in [over(-1.0, 1.0), over(0.0, 1.0), over(-1.0, 0.0)] {
            assert!(is_near(cut.atan2(over(-2.0, -1.0)), -PI, PI), "{cut}");
        }
    }
}
