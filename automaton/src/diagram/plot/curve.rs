//! Curves through the samples of a phase.
//!
//! Between two samples with their rates, a trajectory is the cubic that has both; a cubic is a
//! Bézier curve, whose inner control points lie a third of the way along the rates. So a plot shows
//! the trajectory itself, with few numbers. Only where samples are closer than pixels are most left
//! out: of those in one pixel the first, the smallest, the largest and the last are kept.

use std::fmt::Write as _;

use pleach_drawing::{Axis, number};

use crate::trajectory::{Sample, between};

/// Samples closer than this are thinned, in pixels.
const GRAIN: f64 = 0.5;
/// Where the extremes of a cubic are looked for, as shares of its duration.
const LOOKS: [f64; 7] = [0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875];

/// What a curve shows along an axis: time or a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quantity {
    Time,
    /// By its number.
    Variable(usize),
}

impl Quantity {
    pub(super) fn value(self, sample: &Sample) -> f64 {
        match self {
            Quantity::Time => sample.t,
            Quantity::Variable(number) => sample.values[number],
        }
    }

    /// The change over a third of `duration` at the rate of the sample.
    fn third(self, sample: &Sample, duration: f64) -> f64 {
        duration / 3.0
            * match self {
                Quantity::Time => 1.0,
                Quantity::Variable(number) => sample.rates[number],
            }
    }

    /// Values between which the curve through the samples stays, but for less than a line's width.
    pub(super) fn values(self, samples: &[Sample]) -> Vec<f64> {
        let mut values: Vec<f64> = samples.iter().map(|sample| self.value(sample)).collect();
        if let Quantity::Variable(number) = self {
            for pair in samples.windows(2) {
                let [before, after] = [&pair[0], &pair[1]];
                let inner = LOOKS.iter().map(|share| {
                    let t = before.t + share * (after.t - before.t);
                    between(before, after, t)[number]
                });
                values.extend(inner.filter(|value| value.is_finite()));
            }
        }
        values
    }
}

/// The path of a phase: `across` along the horizontal axis, `up` along the vertical one.
pub(super) fn path(
    samples: &[Sample],
    (across, horizontal): (Quantity, &Axis),
    (up, vertical): (Quantity, &Axis),
) -> String {
    let place =
        |x: f64, y: f64| format!("{} {}", number(horizontal.place(x)), number(vertical.place(y)));
    let at = |sample: &Sample| place(across.value(sample), up.value(sample));
    let kept = match across {
        Quantity::Time => thinned(samples, up, horizontal),
        Quantity::Variable(_) => samples.iter().collect(),
    };
    let is_whole = kept.len() == samples.len();
    let mut path = kept.first().map_or_else(String::new, |first| format!("M {}", at(first)));
    for pair in kept.windows(2) {
        let [before, after] = [pair[0], pair[1]];
        let duration = after.t - before.t;
        // Writing into a string cannot fail.
        let _ = if is_whole && duration > 0.0 {
            let leaving = place(
                across.value(before) + across.third(before, duration),
                up.value(before) + up.third(before, duration),
            );
            let arriving = place(
                across.value(after) - across.third(after, duration),
                up.value(after) - up.third(after, duration),
            );
            write!(path, " C {leaving} {arriving} {}", at(after))
        } else {
            write!(path, " L {}", at(after))
        };
    }
    path
}

/// All samples, or where they are too many those that can be distinguished.
fn thinned<'a>(samples: &'a [Sample], up: Quantity, horizontal: &Axis) -> Vec<&'a Sample> {
    let (Some(first), Some(last)) = (samples.first(), samples.last()) else { return Vec::new() };
    let grains = horizontal.distance(last.t - first.t) / GRAIN;
    if samples.len() as f64 <= 4.0 * grains + 4.0 {
        return samples.iter().collect();
    }
    let grain = |sample: &Sample| (horizontal.distance(sample.t - first.t) / GRAIN).floor();
    let mut kept: Vec<&Sample> = Vec::new();
    for group in samples.chunk_by(|one, other| grain(one) == grain(other)) {
        let order = |one: &&usize, other: &&usize| {
            up.value(&group[**one]).total_cmp(&up.value(&group[**other]))
        };
        let numbers: Vec<usize> = (0..group.len()).collect();
        let extremes = [numbers.iter().min_by(order), numbers.iter().max_by(order)];
        let mut telling: Vec<usize> = extremes.into_iter().flatten().copied().collect();
        telling.extend([0, group.len() - 1]);
        telling.sort_unstable();
        telling.dedup();
        kept.extend(telling.into_iter().map(|number| &group[number]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(t: f64, value: f64, rate: f64) -> Sample {
        Sample { t, values: vec![value], rates: vec![rate] }
    }

    #[test]
    fn a_parabola_is_one_curve_and_its_vertex_is_seen() {
        let samples = [sample(0.0, 0.0, 4.0), sample(1.0, 0.0, -4.0)];
        let height = Quantity::Variable(0);
        let values = height.values(&samples);
        assert_eq!(values.iter().copied().fold(0.0, f64::max), 1.0);
        let (time, up) = (Axis::exact([0.0, 1.0], 0.0, 90.0), Axis::exact([0.0, 1.0], 60.0, 0.0));
        let path = path(&samples, (Quantity::Time, &time), (height, &up));
        let controls = "30 -20 60 -20"; // 4/3 at thirds of the way
        assert_eq!(path, format!("M 0 60 C {controls} 90 60"));
    }

    #[test]
    fn thinning_keeps_what_sticks_out() {
        let mut samples: Vec<Sample> =
            (0..20_000).map(|number| sample(f64::from(number) * 1e-4, 0.0, 0.0)).collect();
        samples[12_345].values[0] = 7.0;
        let axis = Axis::exact([0.0, 2.0], 0.0, 100.0);
        let kept = thinned(&samples, Quantity::Variable(0), &axis);
        assert!(kept.len() < 1000);
        assert_eq!(kept.iter().filter(|sample| sample.values[0] == 7.0).count(), 1);
        assert!(kept.is_sorted_by(|one, next| one.t < next.t));
    }
}
