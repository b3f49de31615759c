//! Where a quantity is during a span of time, and how fast it changes.
//!
//! An [`Enclosure`] bounds a function of time over a span: its value in the middle of the span, its
//! values anywhere in it, and its rate. Enclosures are computed with like numbers; every operation
//! bounds the result and, by the chain rule, its rate. Because
//!
//! ```text
//! f(t) ∈ f(m) + f′([a, b]) · (t − m)        for a ≤ t ≤ b, with m in the middle,
//! ```
//!
//! the mean-value form, a bound on the rate sharpens the bound on the values: the excess shrinks
//! with the square of the length of the span, however often a variable occurs in a formula (Moore,
//! Kearfott and Cloud 2009, section 6, [doi:10.1137/1.9780898717716](https://doi.org/10.1137/1.9780898717716)).

use crate::expression::{BinaryOperator, UnaryOperator};
use crate::interval::Interval;
use crate::table::Table;

/// Bounds on a quantity during a span of time.
///
/// ```
/// use pleach_guards::{Enclosure, Interval};
///
/// // t during [1, 3] seconds.
/// let clock = Enclosure {
///     middle: Interval::point(2.0),
///     range: Interval::new(1.0, 3.0)?,
///     rate: Interval::point(1.0),
/// };
/// let square = clock.times(&clock);
/// assert_eq!(square.range, Interval::new(1.0, 9.0)?);
/// assert_eq!(square.rate, Interval::new(2.0, 6.0)?);
/// # Ok::<(), pleach_guards::EmptyInterval>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosure {
    /// The value in the middle of the span.
    pub middle: Interval,
    /// The values anywhere in the span.
    pub range: Interval,
    /// The rates anywhere in the span, per second. Where there is a kink, those of both sides.
    pub rate: Interval,
}

/// Whether a quantity has a value everywhere in a span.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Definedness {
    /// It has.
    Everywhere,
    /// It has, but a pole lies so near that rounding hides its place: a shorter span tells no more
    /// of the values.
    Steep,
    /// It may have none somewhere, and rounding alone says so: a shorter span tells no more.
    Blurred,
    /// It may have none somewhere; a shorter span may tell.
    Open,
}

impl Definedness {
    /// That of a result, from those of two operands.
    pub(crate) fn and(self, other: Definedness) -> Definedness {
        match (self, other) {
            (Definedness::Open, _) | (_, Definedness::Open) => Definedness::Open,
            (Definedness::Blurred, _) | (_, Definedness::Blurred) => Definedness::Blurred,
            (Definedness::Steep, _) | (_, Definedness::Steep) => Definedness::Steep,
            _ => Definedness::Everywhere,
        }
    }
}

/// A span is at the limit of what rounding lets through if values vary over it by no more than
/// these times what is unknown about the value in its middle.
const BLUR: f64 = 4.0;

impl Enclosure {
    /// A number that does not change.
    pub fn constant(value: f64) -> Self {
        let value = Interval::point(value);
        Enclosure { middle: value, range: value, rate: Interval::point(0.0) }
    }

    /// A quantity of which nothing is known.
    pub const UNKNOWN: Enclosure =
        Enclosure { middle: Interval::WHOLE, range: Interval::WHOLE, rate: Interval::WHOLE };

    /// Whether a shorter span would tell no more about the quantity.
    pub fn is_blurred(&self) -> bool {
        let unknown = self.middle.width();
        unknown.is_finite() && self.range.width() <= BLUR * unknown
    }

    /// The same, with the values bounded by the rate as well; the span is twice `half_width`
    /// seconds long.
    #[must_use]
    pub fn sharpened(self, half_width: f64) -> Self {
        let reach = span(-half_width, half_width);
        let by_rate = self.middle + self.rate * reach;
        Enclosure { range: self.range.intersection(by_rate).unwrap_or(self.range), ..self }
    }

    /// What both say of the same quantity during the same span.
    #[must_use]
    pub fn intersection(&self, other: &Enclosure) -> Self {
        let both = |one: Interval, another: Interval| one.intersection(another).unwrap_or(one);
        Enclosure {
            middle: both(self.middle, other.middle),
            range: both(self.range, other.range),
            rate: both(self.rate, other.rate),
        }
    }

    /// self + other
    #[must_use]
    pub fn plus(&self, other: &Enclosure) -> Self {
        Enclosure {
            middle: self.middle + other.middle,
            range: self.range + other.range,
            rate: self.rate + other.rate,
        }
    }

    /// self − other
    #[must_use]
    pub fn minus(&self, other: &Enclosure) -> Self {
        Enclosure {
            middle: self.middle - other.middle,
            range: self.range - other.range,
            rate: self.rate - other.rate,
        }
    }

    /// self · other
    #[must_use]
    pub fn times(&self, other: &Enclosure) -> Self {
        Enclosure {
            middle: self.middle * other.middle,
            range: self.range * other.range,
            rate: scaled(self.rate, other.range) + scaled(other.rate, self.range),
        }
    }

    fn over(&self, other: &Enclosure) -> Self {
        let range = self.range / other.range;
        Enclosure {
            middle: self.middle / other.middle,
            range,
            rate: (self.rate - scaled(other.rate, range)) / other.range,
        }
    }

    fn opposite(&self) -> Self {
        Enclosure { middle: -self.middle, range: -self.range, rate: -self.rate }
    }

    fn smaller(&self, other: &Enclosure) -> Self {
        if self.range.upper() < other.range.lower() {
            return *self;
        }
        if other.range.upper() < self.range.lower() {
            return *other;
        }
        Enclosure {
            middle: self.middle.min(other.middle),
            range: self.range.min(other.range),
            rate: self.rate.hull(other.rate),
        }
    }

    /// The function whose values over intervals and whose slopes are given.
    fn mapped(
        &self,
        value: impl Fn(Interval) -> Option<Interval>,
        slope: impl Fn(Interval) -> Option<Interval>,
    ) -> Self {
        let or_unknown = |found: Option<Interval>| found.unwrap_or(Interval::WHOLE);
        let slope = or_unknown(slope(self.range));
        Enclosure {
            middle: or_unknown(value(self.middle)),
            range: or_unknown(value(self.range)),
            rate: scaled(self.rate, slope),
        }
    }

    /// One of the two, from instant to instant, with this value in the middle.
    pub(crate) fn or(&self, other: &Enclosure, middle: Interval) -> Self {
        Enclosure { middle, range: self.range.hull(other.range), rate: Interval::WHOLE }
    }

    /// The value of the table at this place, given the table of its slopes.
    pub(crate) fn looked_up(&self, table: &Table, slopes: &Table) -> Self {
        // Slopes are rounded: a few units in the last place of their factors.
        let nearly_one = span(1.0 - 4.0 * f64::EPSILON, 1.0 + 4.0 * f64::EPSILON);
        let slope = |places| Some(slopes.range(places) * nearly_one);
        self.mapped(|places| Some(table.range(places)), slope)
    }

    /// The angle of the point (x, self).
    fn angle(&self, x: &Enclosure) -> Self {
        let range = self.range.atan2(x.range);
        let squares = x.range.power(2.0).zip(self.range.power(2.0));
        let distance = squares.map_or(Interval::WHOLE, |(one, other)| one + other);
        // On the left the angle jumps from π to −π.
        let jumps = self.range.contains(0.0) && x.range.lower() <= 0.0;
        let turn = scaled(self.rate, x.range) - scaled(x.rate, self.range);
        Enclosure {
            middle: self.middle.atan2(x.middle),
            range,
            rate: if jumps { Interval::WHOLE } else { turn / distance },
        }
    }

    /// Where `self` is an operand that must not be negative.
    fn not_negative(&self) -> Definedness {
        self.defined(self.range.lower() >= 0.0, self.middle.lower() >= 0.0)
    }

    fn defined(&self, everywhere: bool, in_the_middle: bool) -> Definedness {
        match (everywhere, in_the_middle) {
            (true, _) => Definedness::Everywhere,
            (false, false) if self.is_blurred() => Definedness::Blurred,
            _ => Definedness::Open,
        }
    }

    /// Where `self` is an operand with which a function may have a pole.
    fn beside_a_pole(&self, is_met: impl Fn(Interval) -> bool) -> Definedness {
        if is_met(self.middle) && self.is_blurred() {
            Definedness::Steep
        } else {
            Definedness::Everywhere
        }
    }

    pub(crate) fn raised(&self, exponent: f64) -> (Self, Definedness) {
        let slope = |base: Interval| {
            // The slopes on both sides of a pole have one sign, and the values jump.
            let has_pole = exponent < 0.0 && base.contains(0.0);
            (!has_pole).then_some(Interval::point(exponent) * base.power(exponent - 1.0)?)
        };
        let power = match exponent {
            0.0 => Enclosure::constant(1.0),
            1.0 => *self,
            _ => self.mapped(|base| base.power(exponent), slope),
        };
        let steep = self.beside_a_pole(|base| exponent < 0.0 && base.contains(0.0));
        let is_whole = exponent % 1.0 == 0.0;
        (power, if is_whole { steep } else { self.not_negative().and(steep) })
    }
}

impl UnaryOperator {
    /// The operator on a quantity, and where it has a value.
    pub(crate) fn enclose(self, operand: &Enclosure) -> (Enclosure, Definedness) {
        let everywhere = |enclosure| (enclosure, Definedness::Everywhere);
        match self {
            UnaryOperator::Negation => everywhere(operand.opposite()),
            UnaryOperator::AbsoluteValue if operand.range.lower() >= 0.0 => everywhere(*operand),
            UnaryOperator::AbsoluteValue if operand.range.upper() <= 0.0 => {
                everywhere(operand.opposite())
            }
            UnaryOperator::AbsoluteValue => {
                everywhere(operand.mapped(|x| Some(x.abs()), |_| Some(span(-1.0, 1.0))))
            }
            UnaryOperator::Sine => everywhere(operand.mapped(|x| Some(x.sin()), |x| Some(x.cos()))),
            UnaryOperator::Cosine => {
                everywhere(operand.mapped(|x| Some(x.cos()), |x| Some(-x.sin())))
            }
            UnaryOperator::Tangent => {
                // The slopes on both sides of a pole have one sign, and the values jump.
                let tangent = |x: Interval| Some(x.tan()).filter(|tan| *tan != Interval::WHOLE);
                let slope = |x: Interval| Some(Interval::point(1.0) + tangent(x)?.power(2.0)?);
                let steep = operand.beside_a_pole(|x| tangent(x).is_none());
                (operand.mapped(tangent, slope), steep)
            }
            UnaryOperator::HyperbolicTangent => {
                let slope = |x: Interval| Some(Interval::point(1.0) - x.tanh().power(2.0)?);
                everywhere(operand.mapped(|x| Some(x.tanh()), slope))
            }
            UnaryOperator::Sign => {
                everywhere(operand.mapped(|x| Some(x.sign()), |x| steps(x.sign())))
            }
            UnaryOperator::Floor => {
                everywhere(operand.mapped(|x| Some(x.floor()), |x| steps(x.floor())))
            }
            UnaryOperator::Exponential => {
                everywhere(operand.mapped(|x| Some(x.exp()), |x| Some(x.exp())))
            }
            UnaryOperator::Logarithm => {
                let slope = |x: Interval| Some(Interval::point(1.0) / x);
                (operand.mapped(Interval::ln, slope), operand.not_negative())
            }
        }
    }
}

impl BinaryOperator {
    /// The operator on two quantities, and where it has a value.
    pub(crate) fn enclose(self, left: &Enclosure, right: &Enclosure) -> (Enclosure, Definedness) {
        let everywhere = |enclosure| (enclosure, Definedness::Everywhere);
        match self {
            BinaryOperator::Sum => everywhere(left.plus(right)),
            BinaryOperator::Difference => everywhere(left.minus(right)),
            BinaryOperator::Product => everywhere(left.times(right)),
            BinaryOperator::Minimum => everywhere(left.smaller(right)),
            BinaryOperator::Maximum => {
                everywhere(left.opposite().smaller(&right.opposite()).opposite())
            }
            BinaryOperator::Angle => everywhere(left.angle(right)),
            BinaryOperator::Quotient => {
                // 0 ÷ 0 has no value.
                let met = |one: Interval, other: Interval| one.contains(0.0) && other.contains(0.0);
                let everywhere = !met(left.range, right.range);
                let in_the_middle = !met(left.middle, right.middle);
                let steep = right.beside_a_pole(|right| right.contains(0.0));
                (left.over(right), right.defined(everywhere, in_the_middle).and(steep))
            }
        }
    }
}

/// A rate times a factor. What rests does so however large the factor.
fn scaled(rate: Interval, factor: Interval) -> Interval {
    if rate.lower() == 0.0 && rate.upper() == 0.0 { rate } else { rate * factor }
}

/// The slope of a function of steps, given the steps met.
fn steps(met: Interval) -> Option<Interval> {
    (met.width() == 0.0).then(|| Interval::point(0.0))
}

fn span(lower: f64, upper: f64) -> Interval {
    Interval::new(lower, upper).unwrap_or(Interval::WHOLE)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// From 0 at 0 to 1 at 3 the slope is a third, which lies between two neighbouring numbers.
    #[test]
    fn slopes_of_tables_are_rounded_outward() {
        let table = Table::linear([(0.0, 0.0), (3.0, 1.0)]).expect("in order");
        let clock = Enclosure {
            middle: Interval::point(1.5),
            range: span(1.0, 2.0),
            rate: Interval::point(1.0),
        };
        let Enclosure { rate, .. } = clock.looked_up(&table, &table.derivative());
        let below = 1.0 / 3.0;
        assert!(rate.lower() <= below && below.next_up() <= rate.upper(), "{rate}");
        assert!(rate.width() < 1e-14, "{rate}");
    }
}
