//! Recognising runs whose jumps accumulate.
//!
//! A run is *Zeno* if infinitely many jumps happen within a finite time (Zhang, Johansson, Lygeros
//! and Sastry 2001, [doi:10.1002/rnc.592](https://doi.org/10.1002/rnc.592)): a bouncing ball whose
//! flights shorten by a factor each time. No finite run can show that; what can be seen is that the
//! time between jumps shrinks geometrically, and where the geometric series adds up.

use serde::{Deserialize, Serialize};

/// The evidence that a run is Zeno.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Zeno {
    /// The estimated instant at which the jumps accumulate, in seconds.
    pub accumulation: f64,
    /// The factor by which a cycle of flows is shorter than the one before it, below 1.
    pub ratio: f64,
    /// How many flows make a cycle: 1 where each is shorter than the one before it.
    pub cycle: usize,
    /// How many flows have been seen to shrink by the same factor.
    pub flows: usize,
    /// How long the last flow took, in seconds.
    pub last: f64,
}

/// How many successive ratios have to agree.
const AGREEING: usize = 12;
/// How much the ratios may differ, relative to the latest.
const RATIO_TOLERANCE: f64 = 1e-3;
/// The longest cycle looked for, in flows.
const LONGEST_CYCLE: usize = 4;
/// A run is given up when what is left of the series is this small a part of the time passed. What
/// is measured of shorter flows is mostly rounding.
const REMAINDER: f64 = 1e-6;

/// Watches how long the flows between jumps take.
#[derive(Clone, Debug)]
pub(crate) struct ZenoDetector {
    horizon: f64,
    /// The latest durations, the newest last.
    durations: Vec<f64>,
    shrinking: usize,
}

impl ZenoDetector {
    const MEMORY: usize = AGREEING + 2 * LONGEST_CYCLE;

    pub(crate) fn new(horizon: f64) -> Self {
        ZenoDetector { horizon, durations: Vec::with_capacity(Self::MEMORY + 1), shrinking: 0 }
    }

    /// Takes note of a flow of `duration` seconds that ends at `now`.
    pub(crate) fn after_flow(&mut self, now: f64, duration: f64) -> Option<Zeno> {
        self.durations.push(duration);
        if self.durations.len() > Self::MEMORY {
            self.durations.remove(0);
        }
        let (cycle, ratio) =
            (1..=LONGEST_CYCLE).find_map(|cycle| Some((cycle, self.ratio(cycle)?)))?;
        self.shrinking += 1;
        let cycle_time: f64 = self.durations.iter().rev().take(cycle).sum();
        let remainder = cycle_time * ratio / (1.0 - ratio);
        let accumulation = now + remainder;
        let is_close = remainder <= REMAINDER * now && accumulation < self.horizon;
        is_close.then(|| {
            let flows = AGREEING + cycle + self.shrinking - 1;
            Zeno { accumulation, ratio, cycle, flows, last: duration }
        })
    }

    /// The factor by which flows shrink from cycle to cycle, if it is below 1 and the same for as
    /// long as has to be.
    fn ratio(&self, cycle: usize) -> Option<f64> {
        let newest_first = || self.durations.iter().rev();
        let mut ratios = newest_first().zip(newest_first().skip(cycle)).map(|(new, old)| new / old);
        let latest = ratios.next().filter(|ratio| *ratio < 1.0 - RATIO_TOLERANCE)?;
        let agreeing = ratios
            .take_while(|ratio| (ratio - latest).abs() <= RATIO_TOLERANCE * latest)
            .take(AGREEING - 1)
            .count();
        (agreeing == AGREEING - 1).then_some(latest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(durations: impl Iterator<Item = f64>) -> Option<Zeno> {
        let mut detector = ZenoDetector::new(100.0);
        let mut now = 0.0;
        durations.take(10_000).find_map(|duration| {
            now += duration;
            detector.after_flow(now, duration)
        })
    }

    fn geometric(first: f64, ratio: f64) -> impl Iterator<Item = f64> {
        std::iter::successors(Some(first), move |duration| Some(duration * ratio))
    }

    #[test]
    fn a_geometric_series_adds_up() {
        for ratio in [0.1, 0.5, 0.9, 0.98] {
            let zeno = run(geometric(1.0, ratio)).expect("the series converges");
            let limit = 1.0 / (1.0 - ratio);
            assert!((zeno.accumulation - limit).abs() < 1e-6 * limit, "{zeno:?}");
            assert!((zeno.ratio - ratio).abs() < 1e-9 && zeno.cycle == 1);
        }
    }

    #[test]
    fn cycles_of_several_flows_are_seen() {
        let durations = geometric(1.0, 0.5).flat_map(|duration| [duration, 3.0 * duration]);
        let zeno = run(durations).expect("the series converges");
        assert!((zeno.accumulation - 8.0).abs() < 1e-5 && zeno.cycle == 2, "{zeno:?}");
    }

    #[test]
    fn steady_growing_and_slowly_shrinking_flows_are_not_zeno() {
        assert_eq!(run(std::iter::repeat(0.01)), None);
        assert_eq!(run(geometric(0.001, 1.001)), None);
        // The harmonic series has no limit.
        assert_eq!(run((1..).map(|count| f64::from(count).recip())), None);
    }

    #[test]
    fn what_accumulates_beyond_the_horizon_is_no_matter() {
        assert_eq!(run(geometric(10.0, 0.95)), None);
    }
}
