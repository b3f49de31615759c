//! How a margin bends over three instants.

use super::root::Sample;

/// Three successive samples and the parabola through their margins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    pub(super) samples: [Sample; 3],
}

/// How much higher than a parabola the peak may be. A parabola rises above the highest of its
/// samples by at most a quarter of q w², with q the quadratic coefficient and w the distance of two
/// samples; a peak between two straight slopes by at most q w².
const GENEROSITY: f64 = 2.0;

impl Bend {
    /// The highest of at least three samples, in order of time, with the two next to it.
    pub(super) fn around_highest(path: &[Sample]) -> Bend {
        let mut highest = 1;
        for index in 2..path.len() - 1 {
            if path[index].verdict.margin > path[highest].verdict.margin {
                highest = index;
            }
        }
        Bend { samples: [path[highest - 1], path[highest], path[highest + 1]] }
    }

    /// When the parabola peaks, if it does so between the samples and the margin may reach zero.
    pub(super) fn reachable_top(&self) -> Option<f64> {
        let [a, b, c] = self.samples;
        let (left, right) = (b.time - a.time, c.time - b.time);
        let rise = (b.verdict.margin - a.verdict.margin) / left;
        let fall = (c.verdict.margin - b.verdict.margin) / right;
        let quadratic = (fall - rise) / (left + right);
        let slope = rise + quadratic * left;
        let top = b.time - slope / (2.0 * quadratic);

        let highest = self.samples.map(|sample| sample.verdict.margin);
        let highest = highest.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let reach = -GENEROSITY * quadratic * left.max(right).powi(2);
        (quadratic < 0.0 && a.time < top && top < c.time && highest + reach >= 0.0).then_some(top)
    }

    pub(super) fn left_middle(&self) -> f64 {
        0.5 * (self.samples[0].time + self.samples[1].time)
    }

    pub(super) fn right_middle(&self) -> f64 {
        0.5 * (self.samples[1].time + self.samples[2].time)
    }
}
