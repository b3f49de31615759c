//! Axes: which numbers stand at them, and where a value is on the sheet.

/// The most digits before and behind the point that a number at an axis may have; else all numbers
/// of the axis share a power of ten.
const DIGITS: i32 = 4;
/// White beyond the smallest and the largest value, as a share of their distance.
const ROOM: f64 = 0.06;

/// A linear scale from values to places on the sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    low: f64,
    high: f64,
    /// Where `low` and `high` are, in pixels.
    from: f64,
    to: f64,
}

/// A number at an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Where it stands, in pixels.
    pub place: f64,
    /// The number as people read it.
    pub text: String,
}

impl Axis {
    /// The axis from the smallest to the largest of `values` exactly, between the places `from` and
    /// `to`. Values that are not finite do not count; where all are equal, the axis reaches beyond
    /// them at both ends.
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

    /// The axis from zero to the values, with some white beyond the smallest and the largest, but
    /// none beyond zero.
    pub fn from_zero(values: impl IntoIterator<Item = f64>, from: f64, to: f64) -> Axis {
        let whole = Axis::exact(values.into_iter().chain([0.0]), from, to);
        let room = (whole.high - whole.low) * ROOM;
        let beyond = |end: f64, room: f64| if end == 0.0 { end } else { end + room };
        Axis { low: beyond(whole.low, -room), high: beyond(whole.high, room), from, to }
    }

    /// Where `value` is, in pixels.
    #[must_use]
    pub fn place(&self, value: f64) -> f64 {
        self.from + (value - self.low) / (self.high - self.low) * (self.to - self.from)
    }

    /// How far apart two values are that differ by `difference`, in pixels.
    #[must_use]
    pub fn distance(&self, difference: f64) -> f64 {
        (difference / (self.high - self.low) * (self.to - self.from)).abs()
    }

    /// About `count` round numbers, and the power of ten that they share, if there is one.
    #[must_use]
    pub fn ticks(&self, count: f64) -> (Vec<Tick>, Option<i32>) {
        // Twice as long at most: there are at least half as many steps as wanted.
        let step = round_below(2.0 * ((self.high - self.low) / count));
        let largest = self.low.abs().max(self.high.abs());
        let (magnitude, fineness) = (exponent(largest), exponent(step));
        let power = (magnitude > DIGITS || fineness < -DIGITS).then_some(magnitude);
        let shift = power.unwrap_or(0);
        let decimals = usize::try_from(shift - fineness).unwrap_or(0);
        // Ends that are multiples but for rounding have their number.
        let (first, last) = ((self.low / step - 1e-9).ceil(), (self.high / step + 1e-9).floor());
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

/// The longest round length, 1, 2 or 5 times a power of ten, that is at most `limit`; 1 where there
/// is none.
#[must_use]
pub fn round_below(limit: f64) -> f64 {
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

/// What an axis is called if its numbers share a power of ten: `λ  / 10⁻⁶`.
#[must_use]
pub fn named(name: &str, power: Option<i32>) -> String {
    match power {
        Some(power) => format!("{name}  / {}", power_of_ten(power)),
        None => name.to_owned(),
    }
}

/// 10 to the power, as text: `10⁻⁶`.
#[must_use]
pub fn power_of_ten(power: i32) -> String {
    let raised = |sign: char| match sign {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => {
            digit.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)).unwrap_or(digit)
        }
    };
    format!("10{}", power.to_string().chars().map(raised).collect::<String>())
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
        assert_eq!(texts(0.0, 0.6), (few(&["0.0", "0.2", "0.4", "0.6"]), None));
        assert_eq!(texts(-0.5, 0.5), (few(&["−0.4", "−0.2", "0.0", "0.2", "0.4"]), None));
        assert_eq!(texts(0.0, 3e-7), (few(&["0", "1", "2", "3"]), Some(-7)));
        assert_eq!(texts(2e6, 3e6), (few(&["2.0", "2.2", "2.4", "2.6", "2.8", "3.0"]), Some(6)));
        assert_eq!([-12, 7, 30].map(power_of_ten), ["10⁻¹²", "10⁷", "10³⁰"]);
    }

    #[test]
    fn an_axis_from_zero_has_no_white_there() {
        let ends = |values: [f64; 2]| {
            let Axis { low, high, .. } = Axis::from_zero(values, 0.0, 100.0);
            [low, high]
        };
        assert_eq!(ends([1.0, 2.0]), [0.0, 2.12]);
        assert_eq!(ends([-1.0, -2.0]), [-2.12, 0.0]);
        assert_eq!(ends([-1.0, 1.0]), [-1.12, 1.12]);
    }

    #[test]
    fn round_lengths_are_not_longer_than_asked_for() {
        assert_eq!([0.7, 0.02, 999.0, 1000.0].map(round_below), [0.5, 0.02, 500.0, 1000.0]);
        assert_eq!([0.0, f64::INFINITY, f64::NAN].map(round_below), [1.0; 3]);
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
