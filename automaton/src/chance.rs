//! Draws that are the same in every run.

/// A sequence of draws, by SplitMix64 (G. L. Steele, D. Lea and C. H. Flood 2014,
/// doi:10.1145/2660193.2660195).
#[derive(Clone, Debug)]
pub(crate) struct Chance {
    state: u64,
}

/// The golden ratio as a fraction of 2⁶⁴, made odd.
const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// A number that looks drawn at random, and is the same for the same `number`: the output function of SplitMix64.
pub(crate) const fn mixed(number: u64) -> u64 {
    let mixed = (number ^ (number >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    mixed ^ (mixed >> 31)
}

impl Chance {
    /// The sequence with this number among those of a seed.
    pub(crate) fn new(seed: u64, number: usize) -> Self {
        let mut chance = Chance { state: seed };
        let offset = chance.next().wrapping_add(STEP.wrapping_mul(number as u64));
        Chance { state: offset }
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(STEP);
        mixed(self.state)
    }

    /// An even draw from [0, 1).
    pub(crate) fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 * (-53f64).exp2()
    }

    /// An even draw from the numbers below `count` > 0.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        // The bias is at most count ÷ 2⁵³.
        ((self.share() * count as f64) as usize).min(count.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_are_even_and_repeatable() {
        let draws = |seed, number| {
            let mut chance = Chance::new(seed, number);
            (0..30_000).map(|_| chance.below(3)).collect::<Vec<_>>()
        };
        let first = draws(1, 0);
        assert_eq!(first, draws(1, 0));
        assert_ne!(first, draws(1, 1));
        assert_ne!(first, draws(2, 0));
        for value in 0..3 {
            let count = first.iter().filter(|draw| **draw == value).count();
            assert!((9_600..10_400).contains(&count), "{count} times {value}");
        }
    }
}
