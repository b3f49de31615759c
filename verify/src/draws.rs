//! Draws that are the same in every run.

/// A sequence of draws, by SplitMix64 (G. L. Steele, D. Lea and C. H. Flood 2014,
/// doi:10.1145/2660193.2660195), from a seed.
pub(crate) struct Draws(pub u64);

impl Draws {
    /// An even draw from all numbers.
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// An even draw from [`low`, `high`).
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * ((self.next() >> 11) as f64 * (-53_f64).exp2())
    }

    /// An even draw from −1 to 1.
    pub(crate) fn share(&mut self) -> f64 {
        self.between(-1.0, 1.0)
    }

    /// A draw from the numbers below `count`; 0 if there are none.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}
