//! The instants of a trajectory that tell about predicates: where margins turn, and where they pass
//! zero.

use pleach_continuous::flow::Piece;
use pleach_guards::{Enclosure, EvaluationError, Predicate, Tracked, Tracker};

use super::{HybridTime, Sample, Strand, Trajectory};

/// A margin that turns is followed down to this part of a piece, where it is flat within rounding.
const FLAT: f64 = 1.5e-8;
/// Instants in a span between two samples, so that a line through the margins comes close to them.
const SPANS: u32 = 4;

impl Trajectory {
    /// The samples at which a piecewise-linear account of the margins of these predicates has all
    /// that matters: every phase at its ends, where a margin turns, just before and just after it
    /// passes zero, and often enough in between.
    ///
    /// The margins are followed through the whole of every piece of the flow by enclosures; none is
    /// skipped. So between two of these samples no comparison of the predicates becomes true or
    /// false, but for two changes that are closer than rounding lets one see.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownVariable`] if a predicate names a variable that does not exist.
    pub fn samples_for(
        &self,
        predicates: &[Predicate],
    ) -> Result<Vec<(HybridTime, Sample)>, EvaluationError> {
        let trackers: Vec<Tracker> =
            predicates.iter().map(|one| one.track(&self.variables)).collect::<Result<_, _>>()?;
        let comparisons = || trackers.iter().flat_map(Tracker::comparisons);
        let strands: Vec<&Strand> = self
            .strands
            .iter()
            .filter(|strand| {
                let names = strand.slots.iter().map(|&slot| &*self.variables[slot]);
                names.into_iter().any(|name| {
                    predicates.iter().any(|predicate| predicate.variables().contains(name))
                })
            })
            .collect();
        let mut samples = Vec::new();
        for phase in 0..=self.jumps.len() {
            let [from, to] = self.ends_of(phase);
            let mut instants = self.instants_of(phase);
            let spans: Vec<[f64; 2]> = instants.windows(2).map(|pair| [pair[0], pair[1]]).collect();
            for [first, last] in spans {
                let part =
                    |number: u32| first + (last - first) * f64::from(number) / f64::from(SPANS);
                instants.extend((1..SPANS).map(part));
                let course = Course::new(&strands, [from, to], [first, last], self.variables.len());
                comparisons().for_each(|one| course.follow(one, &mut instants));
            }
            instants.sort_by(f64::total_cmp);
            instants.dedup();
            let inside = instants.into_iter().filter(|t| from.t <= *t && *t <= to.t);
            let at = |t: f64| HybridTime { t, ..from };
            samples.extend(inside.map(|t| (at(t), self.sample(at(t)))));
        }
        Ok(samples)
    }
}

/// The pieces that some variables follow during a span in which none of them ends.
struct Course<'a> {
    span: [f64; 2],
    pieces: Vec<(&'a Strand, &'a Piece, f64)>,
    slots: Vec<usize>,
}

impl<'a> Course<'a> {
    fn new(
        strands: &[&'a Strand],
        [from, to]: [HybridTime; 2],
        span: [f64; 2],
        variables: usize,
    ) -> Self {
        let middle = span[0] + 0.5 * (span[1] - span[0]);
        let pieces = strands.iter().filter_map(|strand| {
            let stretch = strand.stretch(HybridTime { t: middle, ..from }.min(to));
            // Times of a piece count from the start of its stretch.
            stretch.piece(middle).map(|piece| (*strand, piece, middle - stretch.local(middle)))
        });
        Course { span, pieces: pieces.collect(), slots: (0..variables).collect() }
    }

    fn margin(&self, comparison: &Tracked, [from, to]: [f64; 2]) -> Enclosure {
        let mut states = vec![Enclosure::UNKNOWN; self.slots.len()];
        let mut own = Vec::new();
        for (strand, piece, since) in &self.pieces {
            piece.enclose(from - since, to - since, &mut own);
            strand.slots.iter().zip(&own).for_each(|(&slot, state)| states[slot] = *state);
        }
        let half = 0.5 * (to - from) * (1.0 + 4.0 * f64::EPSILON);
        comparison.margin(&states, &self.slots, half)
    }

    /// Adds where the margin turns and where it passes zero.
    fn follow(&self, comparison: &Tracked, instants: &mut Vec<f64>) {
        let finest = FLAT * (self.span[1] - self.span[0]);
        let mut spans = vec![self.span];
        while let Some([from, to]) = spans.pop() {
            let margin = self.margin(comparison, [from, to]);
            let (low, high) = (margin.rate.lower(), margin.rate.upper());
            let middle = from + 0.5 * (to - from);
            if low >= 0.0 || high <= 0.0 {
                if margin.range.contains(0.0) {
                    self.pass_zero(comparison, [from, to], instants);
                }
            } else if to - from <= finest || middle <= from || middle >= to {
                instants.extend([from, middle, to]);
            } else {
                spans.extend([[middle, to], [from, middle]]);
            }
        }
    }

    /// Adds the neighbours of the zero of a margin that rises or falls throughout.
    fn pass_zero(&self, comparison: &Tracked, [from, to]: [f64; 2], instants: &mut Vec<f64>) {
        let value = |t: f64| self.margin(comparison, [t, t]).middle.midpoint();
        let is_above = value(from) >= 0.0;
        if is_above == (value(to) >= 0.0) {
            return;
        }
        let (mut before, mut after) = (from, to);
        loop {
            let middle = before + 0.5 * (after - before);
            if middle <= before || middle >= after {
                return instants.extend([before, after]);
            }
            if (value(middle) >= 0.0) == is_above { before = middle } else { after = middle }
        }
    }
}
