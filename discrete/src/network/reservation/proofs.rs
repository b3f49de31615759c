//! Grants are carried, and their leases end at the sender first.

use super::*;

/// Any whole number below a bound.
fn below(bound: u8) -> i16 {
    i16::from(kani::any_where(|number: &u8| *number < bound))
}

/// A robot that sends on less than 10 as a whole number, of which it needs 1 or nothing itself, and any flows of
/// two senders below 3 that it has granted and that are wanted: it grants each no more than that one wants, and
/// afterwards sends on what it has granted and needs, if it did before; otherwise it grants nothing more.
#[kani::proof]
#[kani::unwind(3)]
fn no_more_is_granted_than_there_is_to_spare() {
    let (out, rate) = (below(10), below(2));
    let (kept, wanted) = ([below(3), below(3)], [below(3), below(3)]);
    let before = out - kept[0] - kept[1] - rate;
    let (mut spare, mut granted) = (Spare::of(before), kept);
    for sender in 0..2 {
        let flow = spare.most(kept[sender], wanted[sender]);
        assert!(flow <= wanted[sender]);
        if flow > kept[sender] {
            spare.grant(kept[sender], flow);
            granted[sender] = flow;
        }
    }
    let after = out - granted[0] - granted[1] - rate;
    kani::cover!(before > 0 && after == 0 && granted[1] > kept[1] && granted[1] < wanted[1]);
    kani::cover!(before < 0 && wanted[0] > kept[0]);
    assert!(after >= 0 || before < 0);
    assert!(before >= 0 || granted == kept);
}

/// A receiver that has kept a flow until any period below 3, and renews that twice, for any period below 4 each;
/// the sender hears any three of the three grants, in any order, some of them again, others never: wherever its
/// grant holds that of the receiver does, too.
#[kani::proof]
#[kani::unwind(4)]
fn a_lease_ends_at_the_sender_first() {
    let any_period = |bound: u8| u32::from(kani::any_where(|period: &u8| *period < bound));
    let mut kept = any_period(3);
    let mut told = [kept; 3];
    for grant in &mut told[1..] {
        kept = renewed(kept, any_period(4));
        *grant = kept;
    }
    let mut used = 0;
    for _ in 0..3 {
        let heard = any_period(3);
        for grant in 0..3 {
            if grant == heard {
                used = renewed(used, told[grant as usize]);
            }
        }
    }
    let period = any_period(5);
    kani::cover!(holds(kept, period) && !holds(used, period) && used > 0);
    kani::cover!(holds(used, period) && told[0] < told[1]);
    assert!(!holds(used, period) || holds(kept, period));
}
