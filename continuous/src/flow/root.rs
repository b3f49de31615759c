//! Narrowing the time at which a verdict changes.

use pleach_guards::Verdict;

/// What a predicate says at one instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) time: f64,
    pub(super) verdict: Verdict,
}

/// How strongly the interpolated point is pulled to the middle: the authors' κ₁ for a bracket of
/// width 1, with κ₂ = 2.
const PULL: f64 = 0.2;
/// How many evaluations more than bisection it may take: the authors' n₀.
const EXTRA_EVALUATIONS: f64 = 1.0;

/// Narrows the bracket from `before`, where the predicate does not hold, to `after`, where it does,
/// until it is no wider than `tolerance` seconds.
///
/// Whether the predicate holds decides which end moves; the margin only guides where to look. That
/// is the interpolate–truncate–project method of I. F. D. Oliveira and R. H. C. Takahashi (2020),
/// doi:10.1145/3423597: fast where the margin is smooth, and never slower than bisection by more
/// than one evaluation or so, whatever the margin says.
pub(super) fn narrow<E>(
    mut before: Sample,
    mut after: Sample,
    tolerance: f64,
    mut look: impl FnMut(f64) -> Result<Sample, E>,
) -> Result<(Sample, Sample), E> {
    let first_width = after.time - before.time;
    let halvings = (first_width / tolerance).log2().ceil().max(0.0) + EXTRA_EVALUATIONS;
    // Half the width that the bracket may have by now if it is to be narrow enough in the end.
    // The bound is for powers that overflow.
    let mut budget = (0.5 * tolerance * halvings.exp2()).min(2.0 * first_width);
    loop {
        let half = 0.5 * (after.time - before.time);
        if half <= 0.5 * tolerance {
            return Ok((before, after));
        }
        let middle = before.time + half;
        let wanted = match false_position(before, after) {
            Some(guess) => {
                let pull = PULL * (2.0 * half).powi(2) / first_width;
                guess + (middle - guess).clamp(-pull, pull)
            }
            None => middle,
        };
        let radius = (budget - half).clamp(0.0, half - 0.5 * tolerance);
        let sample = look(wanted.clamp(middle - radius, middle + radius))?;
        if sample.verdict.holds {
            after = sample;
        } else {
            before = sample;
        }
        budget *= 0.5;
    }
}

/// Where the chord through both margins is zero, if they lie on the two sides of it.
fn false_position(before: Sample, after: Sample) -> Option<f64> {
    let (below, above) = (before.verdict.margin, after.verdict.margin);
    let guess = before.time + (after.time - before.time) * (below / (below - above));
    (below <= 0.0 && above >= 0.0 && guess.is_finite()).then_some(guess)
}
