//! Axes: which numbers stand at them, and where a value is on the paper.

use pleach_guards::constant;

/// The most digits before and behind the point that a number at an axis may have; else all numbers
/// of the axis share a power of ten.
const DIGITS: i32 = 4;
/// White beyond the smallest and the largest value, as a share of their distance.
const ROOM: f64 = 0.06;

/// A linear scale from values to places on the paper.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    low: f64,
    high: f64,
    /// Where `low` and `high` are, in pixels.
    from: f64,
    to: f64,
}

/// A number at an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// In pixels.
    pub place: f64,
    pub text: String,
}

impl Axis {
    /// The axis from the smallest to the largest of `values` exactly.
    pub fn exact(values: impl IntoIterator<Item = f64>, from: f64, to: f64) -> Axis {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.into_iter().filter(|value| value.is_finite()) {
            low = low.min(value);
            high = high.max(value);
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        // Half of each first: the difference of two finite numbers may not be one.
        let least = 1e-12 * low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
        if high / 2.0 - low / 2.0 <= least {
            let half = if low == 0.0 { 1.0 } else { 0.5 * low.abs() };
            (low, high) = (low - half, high + half);
        }
        Axis { low, high, from, to }
    }

    /// The axis with some white beyond the smallest and the largest of `values`.
    pub fn roomy(values: impl IntoIterator<Item = f64>, from: f64, to: f64) -> Axis {
        let Axis { low, high, .. } = Axis::exact(values, from, to);
        let room = (high - low) * ROOM;
        Axis { low: low - room, high: high + room, from, to }
    }

    /// Where `value` is, in pixels.
    pub fn place(&self, value: f64) -> f64 {
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// How far apart two values are that differ by `difference`, in pixels.
    pub fn distance(&self, difference: f64) -> f64 {
        (difference / (self.high - self.low) * (self.to - self.from)).abs()
    }

    /// About `count` round numbers, and the power of ten that they share, if there is one.
    pub fn ticks(&self, count: f64) -> (Vec<Tick>, Option<i32>) {
        let step = round_step((self.high - self.low) / count);
        let largest = self.low.abs().max(self.high.abs());
        let (magnitude, fineness) = (exponent(largest), exponent(step));
        let power = (magnitude > DIGITS || fineness < -DIGITS).then_some(magnitude);
        let shift = power.unwrap_or(0);
        let decimals = usize::try_from(shift - fineness).unwrap_or(0);
        let (first, last) = ((self.low / step).ceil(), (self.high / step).floor());
        let mut ticks = Vec::new();
        let mut number = first;
        // A step that is lost in rounding would not lead on.
        while number <= last && number + 1.0 > number {
            let value = number * step;
            let text = written(value / 10f64.powi(shift), decimals);
            ticks.push(Tick { place: self.place(value), text });
            number += 1.0;
        }
        (ticks, power)
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is at most twice `wanted`, so that there are
/// at least half as many steps as wanted.
fn round_step(wanted: f64) -> f64 {
    let limit = 2.0 * wanted;
    if !(limit.is_finite() && limit > 0.0) {
        return 1.0;
    }
    let power = 10f64.powi(exponent(limit));
    let factor = [5.0, 2.0].into_iter().find(|factor| factor * power <= limit).unwrap_or(1.0);
    factor * power
}

/// The power of ten that is at most `value` > 0.
fn exponent(value: f64) -> i32 {
    // A little more, so that 1000 is not 999.999…
    if value > 0.0 { (value.log10() + 1e-9).floor() as i32 } else { 0 }
}

/// With a real minus sign, and zero without any.
fn written(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let is_zero = text.chars().all(|digit| matches!(digit, '0' | '.'));
    if value < 0.0 && !is_zero { format!("−{text}") } else { text }
}

/// 10 to the power, as text: `10⁻⁶`.
pub(super) fn power_of_ten(power: i32) -> String {
    constant(10.0).power(f64::from(power)).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn texts(low: f64, high: f64) -> (Vec<String>, Option<i32>) {
        let (ticks, power) = Axis::exact([low, high], 0.0, 100.0).ticks(5.0);
        (ticks.into_iter().map(|tick| tick.text).collect(), power)
    }

    #[test]
    fn numbers_are_round_and_readable() {
        let few = |texts: &[&str]| texts.iter().map(ToString::to_string).collect::<Vec<_>>();
        assert_eq!(texts(0.0, 10.0), (few(&["0", "2", "4", "6", "8", "10"]), None));
        assert_eq!(texts(-0.5, 0.5), (few(&["−0.4", "−0.2", "0.0", "0.2", "0.4"]), None));
        assert_eq!(texts(0.0, 3e-7), (few(&["0", "1", "2", "3"]), Some(-7)));
        assert_eq!(texts(2e6, 3e6), (few(&["2.0", "2.2", "2.4", "2.6", "2.8", "3.0"]), Some(6)));
        assert_eq!(power_of_ten(-12), "10⁻¹²");
    }

    proptest! {
        #[test]
        fn ticks_are_a_few_and_on_the_axis(low in -1e9..1e9f64, width in 1e-3..1e9f64) {
            let axis = Axis::exact([low, low + width], 0.0, 100.0);
            let (ticks, _) = axis.ticks(5.0);
            prop_assert!((2..=11).contains(&ticks.len()), "{ticks:?}");
            prop_assert!(ticks.iter().all(|tick| (-1e-6..=100.000_001).contains(&tick.place)));
            let differ = ticks.windows(2).all(|pair| pair[0].text != pair[1].text);
            prop_assert!(differ, "{ticks:?}");
        }
    }
}
