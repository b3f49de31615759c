//! Consent: a robot moves only if all consent that could be harmed by its move.
//!
//! A message that is lost takes away the right to move, and never gives one.

use super::NodeId;

#[cfg(any(kani, test))]
mod proofs;

/// Whether each of the robots that rely on a mover has consented to its move. Others may have, too.
///
/// ```
/// use pleach_discrete::network::consent::all_consent;
///
/// assert!(all_consent([2, 3], &[3, 5, 2]));
/// assert!(!all_consent([2, 3], &[3]));
/// assert!(all_consent([], &[]));
/// ```
pub fn all_consent(reliant: impl IntoIterator<Item = NodeId>, consents: &[NodeId]) -> bool {
    reliant.into_iter().all(|robot| consents.contains(&robot))
}
