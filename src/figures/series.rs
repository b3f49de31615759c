//! Curves of a long mission, thinned so that no extreme is lost.

/// Values of several curves over the control periods.
///
/// Neighbouring periods are merged into one bucket as soon as there are too many buckets; a
/// bucket keeps the smallest and the largest value of each curve, so that a dip of one period
/// stays visible however long the mission is.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Series {
    capacity: usize,
    stride: usize,
    filled: usize,
    starts: Vec<usize>,
    /// Smallest and largest value, by bucket, then by curve.
    extremes: Vec<Vec<(f64, f64)>>,
}

/// Values that one figure may hold, so that its file stays small.
const POINT_BUDGET: usize = 16_000;
/// Buckets that a figure of 960 pixels can show.
const MOST_BUCKETS: usize = 800;
/// Buckets that still give a curve.
const FEWEST_BUCKETS: usize = 60;

impl Series {
    /// An empty set of `curves` curves.
    pub(super) fn new(curves: usize) -> Series {
        let capacity = (POINT_BUDGET / curves.max(1)).clamp(FEWEST_BUCKETS, MOST_BUCKETS);
        Series { capacity, stride: 1, filled: 0, starts: Vec::new(), extremes: Vec::new() }
    }

    /// Adds the values of one period; values that are not finite leave the curve as it is.
    pub(super) fn push(&mut self, step: usize, values: impl Iterator<Item = f64>) {
        let fresh = self.filled == 0;
        if fresh {
            self.starts.push(step);
            self.extremes.push(values.map(|value| (value, value)).collect());
        } else if let Some(bucket) = self.extremes.last_mut() {
            for ((low, high), value) in bucket.iter_mut().zip(values) {
                *low = low.min(value);
                *high = high.max(value);
            }
        }
        self.filled = (self.filled + 1) % self.stride;
        if self.starts.len() > self.capacity && self.filled == 0 {
            self.merge_pairs();
        }
    }

    fn merge_pairs(&mut self) {
        self.starts = self.starts.iter().copied().step_by(2).collect();
        self.extremes = self
            .extremes
            .chunks(2)
            .map(|pair| {
                let [first, rest @ ..] = pair else { return Vec::new() };
                rest.iter().fold(first.clone(), |merged, other| {
                    let both = merged.iter().zip(other);
                    both.map(|(one, two)| (one.0.min(two.0), one.1.max(two.1))).collect()
                })
            })
            .collect();
        // An odd bucket at the end holds half of what it will hold.
        self.filled = if self.capacity.is_multiple_of(2) { self.stride } else { 0 };
        self.stride *= 2;
    }

    /// How many curves there are.
    pub(super) fn curves(&self) -> usize {
        self.extremes.first().map_or(0, Vec::len)
    }

    /// By curve: how far it is from the median of all curves, at most.
    pub(super) fn departures(&self) -> Vec<f64> {
        let mut departures = vec![0.0; self.curves()];
        for bucket in &self.extremes {
            let lows = median(bucket.iter().map(|(low, _)| *low));
            let highs = median(bucket.iter().map(|(_, high)| *high));
            for (departure, (low, high)) in departures.iter_mut().zip(bucket) {
                *departure = f64::max(*departure, (low - lows).abs().max((high - highs).abs()));
            }
        }
        departures
    }

    /// The range of some curves: from where on, the smallest value and the largest.
    pub(super) fn range(&self, curves: &[usize]) -> Vec<[f64; 3]> {
        let range = |(start, bucket): (&usize, &Vec<(f64, f64)>)| {
            let values = || curves.iter().filter_map(|&curve| bucket.get(curve));
            let low = values().map(|(low, _)| *low).fold(f64::INFINITY, f64::min);
            let high = values().map(|(_, high)| *high).fold(f64::NEG_INFINITY, f64::max);
            (low.is_finite() && high.is_finite()).then_some([*start as f64, low, high])
        };
        self.starts.iter().zip(&self.extremes).filter_map(range).collect()
    }

    /// The points of one curve: one a bucket, or two where the bucket spans several values.
    pub(super) fn points(&self, curve: usize) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        for (start, bucket) in self.starts.iter().zip(&self.extremes) {
            let Some(&(low, high)) = bucket.get(curve) else { continue };
            if low.is_finite() && high.is_finite() {
                points.push([*start as f64, low]);
                if high > low {
                    points.push([*start as f64 + self.stride as f64 / 2.0, high]);
                }
            }
        }
        points
    }
}

/// The value in the middle, or the larger one of two.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_curve_departs_as_far_as_its_farthest_value_is_from_the_median() {
        let mut series = Series::new(3);
        for (step, values) in [[1.0, 2.0, 1.0], [1.0, 1.5, 9.0], [1.0, 0.5, 1.0]].iter().enumerate()
        {
            series.push(step, values.iter().copied());
        }
        assert_eq!(series.departures(), [0.5, 1.0, 7.5]);
        assert_eq!(series.range(&[0, 1]), [[0.0, 1.0, 2.0], [1.0, 1.0, 1.5], [2.0, 0.5, 1.0]]);
    }

    proptest! {
        #![proptest_config(cases::usually(32))]
        #[test]
        fn thinning_keeps_both_extremes(
            values in prop::collection::vec(-1.0..1.0_f64, 1..4000),
            curves in 1_usize..300,
        ) {
            let mut series = Series::new(curves);
            for (step, value) in values.iter().enumerate() {
                series.push(step, std::iter::once(*value));
            }
            let points = series.points(0);
            let low = points.iter().map(|p| p[1]).fold(f64::INFINITY, f64::min);
            let high = points.iter().map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max);
            prop_assert_eq!(low, values.iter().copied().fold(f64::INFINITY, f64::min));
            prop_assert_eq!(high, values.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            prop_assert!(series.starts.len() <= series.capacity + 1);
            prop_assert!(series.starts.is_sorted());
        }
    }
}
