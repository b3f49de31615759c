//! Consent: a robot moves only if all consent that could be harmed by its move.
//!
//! A message that is lost takes away the right to move, and never gives one.

use super::NodeId;

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

#[cfg(test)]
mod tests {
    use super::*;

    /// Three of four robots have consented, some of them maybe twice; then one of the consents is lost.
    #[test]
    fn a_consent_that_is_lost_gives_no_right_to_move() {
        for drawn in 0..64 {
            let consents = [drawn % 4, drawn / 4 % 4, drawn / 16];
            for (one, other) in (0..4).flat_map(|one| (0..4).map(move |other| (one, other))) {
                let may_move = all_consent([one, other], &consents);
                assert_eq!(may_move, consents.contains(&one) && consents.contains(&other));
                assert!(may_move || !all_consent([one, other], &consents[..2]));
            }
        }
    }
}
