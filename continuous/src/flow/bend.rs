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
    /// The highest of at least three samples, in order of time, with the two next to it; at either
    /// end of the samples, with the two that follow or precede it.
    pub(super) fn around_highest(path: &[Sample]) -> Bend {
        let mut highest = 0;
        for (index, sample) in path.iter().enumerate() {
            if sample.verdict.margin > path[highest].verdict.margin {
                highest = index;
            }
        }
        let middle = highest.clamp(1, path.len() - 2);
        Bend { samples: [path[middle - 1], path[middle], path[middle + 1]] }
    }

    /// Which of the three is the highest.
    pub(super) fn highest(&self) -> usize {
        let [a, b, c] = self.samples.map(|sample| sample.verdict.margin);
        if b >= a && b >= c { 1 } else { 2 * usize::from(c > a) }
    }

    /// Whether a margin that bends like this may reach zero in between.
    pub(super) fn may_reach_zero(&self) -> bool {
        let [a, b, c] = self.samples;
        let reach = -self.quadratic() * (b.time - a.time).max(c.time - b.time).powi(2);
        let highest = self.samples[self.highest()].verdict.margin;
        reach > 0.0 && reach.is_finite() && highest + GENEROSITY * reach >= 0.0
    }

    /// Where to look next: the middles of both halves and the top of the parabola.
    pub(super) fn next_looks(&self) -> [f64; 3] {
        let [a, b, c] = self.samples;
        let slope = slope(a, b) + self.quadratic() * (b.time - a.time);
        let top = b.time - slope / (2.0 * self.quadratic());
        let mut times =
            [0.5 * (a.time + b.time), 0.5 * (b.time + c.time), top.clamp(a.time, c.time)];
        times.sort_by(f64::total_cmp);
        times
    }

    /// The quadratic coefficient of the parabola, half its second derivative.
    fn quadratic(&self) -> f64 {
        let [a, b, c] = self.samples;
        (slope(b, c) - slope(a, b)) / (c.time - a.time)
    }
}

fn slope(from: Sample, to: Sample) -> f64 {
    (to.verdict.margin - from.verdict.margin) / (to.time - from.time)
}
