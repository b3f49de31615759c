//! Whose consent is missing is not moved against, and consents that are lost give no right.

use super::*;

/// Any robot of four.
fn any_robot() -> NodeId {
    usize::from(kani::any_where(|robot: &u8| *robot < 4))
}

/// Two robots of four that rely on a mover, any three consents, and one of these that is lost: the mover has the
/// consent of all exactly if each of the two has consented, and not by the loss.
#[kani::proof]
#[kani::unwind(5)]
fn a_robot_moves_against_nobody_that_relies_on_it() {
    let (reliant, consents) = ([any_robot(), any_robot()], [any_robot(), any_robot(), any_robot()]);
    let has_consented =
        |robot: NodeId| robot == consents[0] || robot == consents[1] || robot == consents[2];
    let may_move = all_consent(reliant, &consents);
    kani::cover!(may_move && reliant[0] != reliant[1] && !all_consent(reliant, &consents[..2]));
    kani::cover!(!may_move && has_consented(reliant[0]));
    assert!(may_move == (has_consented(reliant[0]) && has_consented(reliant[1])));
    assert!(may_move || !all_consent(reliant, &consents[..2]));
}
