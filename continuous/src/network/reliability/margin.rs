//! A model read with a margin, for ends whose places are known up to an error.

use super::{LinkReliability, ReliabilityError};

/// The reliability that a link keeps when it may be longer than it seems by `margin`: R(d + m).
///
/// With two ends that are each known to within e, the distance is uncertain by 2e, and R(d + 2e)
/// bounds the reliability from below. The requirements carry over: a shift in the argument changes
/// neither the monotonicity of R nor the convexity of 1/R. So routing, motion and acceptance with
/// this model are right for the true places, wherever within their errors these are.
///
/// ```
/// use pleach_continuous::network::{CubicReliability, LinkReliability, WithMargin};
///
/// let link = WithMargin::new(CubicReliability::new(0.4, 0.5)?, 0.02)?;
/// assert_eq!(link.range(), 0.48);
/// assert!((link.reliability(0.43) - 0.5).abs() < 1e-12);
/// # Ok::<(), pleach_continuous::network::reliability::ReliabilityError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WithMargin<L> {
    link: L,
    margin: f64,
}

impl<L: LinkReliability> WithMargin<L> {
    /// `link`, at distances that are longer by `margin`.
    ///
    /// # Errors
    ///
    /// [`ReliabilityError::Margin`] unless the margin is at least 0 and smaller than the range.
    pub fn new(link: L, margin: f64) -> Result<Self, ReliabilityError> {
        if margin >= 0.0 && margin < link.range() {
            Ok(Self { link, margin })
        } else {
            Err(ReliabilityError::Margin { margin, max_range: link.range() })
        }
    }

    /// The distance at which the model is read. From the range on, whatever rounding does to that, it is
    /// at least the range of the model.
    fn read_at(&self, distance: f64) -> f64 {
        let longer = distance + self.margin;
        if distance >= self.range() { longer.max(self.link.range()) } else { longer }
    }
}

impl<L: LinkReliability> LinkReliability for WithMargin<L> {
    fn reliability(&self, distance: f64) -> f64 {
        self.link.reliability(self.read_at(distance))
    }

    fn slope(&self, distance: f64) -> f64 {
        self.link.slope(self.read_at(distance))
    }

    fn range(&self) -> f64 {
        self.link.range() - self.margin
    }

    fn full_range(&self) -> f64 {
        (self.link.full_range() - self.margin).max(0.0)
    }

    fn distance_at(&self, reliability: f64) -> f64 {
        let distance = self.link.distance_at(reliability) - self.margin;
        distance.clamp(self.full_range(), self.range())
    }

    fn expected_transmissions(&self, distance: f64) -> f64 {
        self.link.expected_transmissions(self.read_at(distance))
    }
}
