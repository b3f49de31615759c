//! Products of symbols.

use pleach_guards::Interval;

use super::Limits;

/// A product of symbols: a byte for each factor, the symbol's number and 1, in descending order from
/// the lowest byte. The empty product is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::reach) struct Monomial(u64);

impl Monomial {
    pub(super) const ONE: Monomial = Monomial(0);

    pub(super) fn symbol(number: u8) -> Self {
        Monomial(u64::from(number) + 1)
    }

    pub(super) fn degree(self) -> usize {
        8 - self.0.leading_zeros() as usize / 8
    }

    /// Its degree, as the limits count it.
    pub(super) fn counted(self, limits: Limits) -> usize {
        // The lowest byte is the symbol with the largest number.
        let has_error = (self.0 & 0xFF) as usize > limits.first_error;
        let more = if has_error { limits.degree.saturating_sub(2) } else { 0 };
        self.degree() + more
    }

    /// The numbers of its symbols, each as often as it is a factor.
    pub(crate) fn symbols(self) -> impl Iterator<Item = u8> {
        self.0.to_le_bytes().into_iter().take_while(|byte| *byte > 0).map(|byte| byte - 1)
    }

    /// Of degrees that add up to 8 at most.
    pub(super) fn times(self, other: Monomial) -> Monomial {
        if self.0 == 0 || other.0 == 0 {
            return Monomial(self.0 | other.0);
        }
        let (mut left, mut right, mut product, mut shift) = (self.0, other.0, 0, 0);
        while left | right != 0 {
            let from = if left & 0xFF >= right & 0xFF { &mut left } else { &mut right };
            product |= (*from & 0xFF) << shift;
            *from >>= 8;
            shift += 8;
        }
        Monomial(product)
    }

    /// Whether every symbol occurs an even number of times, so that it is never negative.
    pub(super) fn is_square(self) -> bool {
        let mut rest = self.0;
        while rest != 0 {
            if rest & 0xFF != (rest >> 8) & 0xFF {
                return false;
            }
            rest >>= 16;
        }
        true
    }

    /// Its values.
    pub(super) fn range(self) -> Interval {
        if self == Monomial::ONE {
            return Interval::point(1.0);
        }
        let lower = if self.is_square() { 0.0 } else { -1.0 };
        Interval::new(lower, 1.0).unwrap_or(Interval::WHOLE)
    }
}
