//! The linear flows of a group: what depends on its locations alone is computed once for each.

use std::collections::BTreeMap;
use std::sync::Arc;

use pleach_continuous::flow::{InvalidFlow, LinearField};

use super::field::Field;

/// ẋ = A x + b of some variables.
#[derive(Clone)]
pub(super) struct LinearPart {
    /// The variables, by their place in the group.
    pub(super) variables: Arc<[usize]>,
    /// With the exponentials of A as far as they are known.
    pub(super) field: Arc<LinearField>,
}

/// The linear flows of a group in the locations that it has visited.
#[derive(Default)]
pub(super) struct LinearFlows {
    /// By the locations of the components of the group; nothing where the flow is not linear.
    known: BTreeMap<Box<[usize]>, Option<LinearPart>>,
}

/// More are not kept at a time: the locations of many components have many combinations.
const MOST_KNOWN: usize = 256;

impl LinearFlows {
    /// The linear part of the field of the group in these locations of its components.
    ///
    /// # Errors
    ///
    /// If a coefficient is not finite.
    pub(super) fn of(
        &mut self,
        locations: Box<[usize]>,
        field: &Field<'_>,
    ) -> Result<Option<LinearPart>, InvalidFlow> {
        if let Some(part) = self.known.get(&locations) {
            return Ok(part.clone());
        }
        let part = field.linear()?;
        if self.known.len() >= MOST_KNOWN {
            self.known.clear();
        }
        self.known.insert(locations, part.clone());
        Ok(part)
    }
}
