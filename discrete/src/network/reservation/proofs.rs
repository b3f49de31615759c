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

/// A receiver that keeps any flow below 3 until any period below 3, and promises two more, each until any period below
/// 4: it keeps what it did and what it promises, or nothing changes. Each time it tells what it keeps. The sender hears
/// three of these tellings, in any order, some of them again, the last one in any period: from then on it may use no
/// more than the receiver keeps, and as much if it has heard the last telling of all.
#[kani::proof]
#[kani::unwind(4)]
fn a_lease_ends_at_the_sender_first() {
    let any_period = |bound: u8| u32::from(kani::any_where(|period: &u8| *period < bound));
    let period = any_period(5);
    let now = u32::from(kani::any_where(|now: &u8| u32::from(*now) <= period));
    let mut kept = Lease::of(below(3), any_period(3));
    let mut told = [kept; 3];
    for telling in &mut told[1..] {
        let (flow, until) = (below(3), any_period(4));
        let before = kept;
        if kept.promise(flow, until) {
            let more = if period <= until { flow } else { 0 };
            assert!(kept.lasting(period) == before.lasting(period).max(more));
        } else {
            assert!(kept == before);
        }
        *telling = kept;
    }
    let mut used = Lease::of(0, 0);
    let mut knows_all = false;
    for hearing in 0..3 {
        let heard = any_period(3);
        for (at, telling) in (0..3).zip(&mut told) {
            if hearing == 2 {
                used.pass(now);
                telling.pass(now);
            }
            if at == heard {
                used.hear(*telling);
            }
        }
        knows_all |= heard == 2;
    }
    assert!(!knows_all || used.lasting(period) == kept.lasting(period));
    kani::cover!(used.lasting(period) > 0 && used.lasting(period) < kept.lasting(period));
    kani::cover!(used.part().is_some() && used.lasting(period) == kept.lasting(period));
    assert!(used.lasting(period) <= kept.lasting(period));
    // When time has passed, what is left is what was to last, and no more than either uses of it.
    let limit = below(3);
    for lease in [&mut kept, &mut used] {
        let lasted = lease.lasting(period);
        lease.limit(limit);
        assert!(lease.lasting(period) == lasted.min(limit));
        lease.pass(period);
        assert!(lease.flow() == lasted.min(limit));
    }
}
