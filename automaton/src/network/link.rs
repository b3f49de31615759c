//! The link model that the nodes of a network share.

use std::sync::Arc;

use pleach_continuous::network::LinkReliability;

/// A link model of any kind, used by robots through [`LinkReliability`] only.
///
/// ```
/// use pleach_automaton::network::Link;
/// use pleach_continuous::network::{CubicReliability, LinkReliability};
///
/// let link = Link::new(CubicReliability::new(0.4, 0.5)?);
/// assert_eq!(link.range(), 0.5);
/// # Ok::<(), pleach_continuous::network::reliability::ReliabilityError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Link(Arc<dyn LinkReliability>);

impl Link {
    /// Links that behave as `model` says, which must satisfy what [`LinkReliability`] asks for.
    pub fn new(model: impl LinkReliability + 'static) -> Self {
        Link(Arc::new(model))
    }
}

impl LinkReliability for Link {
    fn reliability(&self, distance: f64) -> f64 {
        self.0.reliability(distance)
    }

    fn slope(&self, distance: f64) -> f64 {
        self.0.slope(distance)
    }

    fn range(&self) -> f64 {
        self.0.range()
    }

    fn full_range(&self) -> f64 {
        self.0.full_range()
    }

    fn distance_at(&self, reliability: f64) -> f64 {
        self.0.distance_at(reliability)
    }

    fn expected_transmissions(&self, distance: f64) -> f64 {
        self.0.expected_transmissions(distance)
    }
}
