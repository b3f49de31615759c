//! Grants are carried, and their leases end at the sender first.

use super::*;

/// Any whole number below a bound.
fn below(bound: u8) -> i16 {
    i16::from(kani::any_where(|number: &u8| *number < bound))
}

/// Any control period before this one.
fn before(end: u8) -> u32 {
    u32::from(kani::any_where(|period: &u8| *period < end))
}

/// A robot that sends on less than 10 as a whole number, of which it needs 1 or nothing itself, and any flows of
/// two senders below 3 that it has granted and that are wanted: it grants each no more than that one wants, and
/// afterwards sends on what it has granted and needs, if it did before; otherwise it grants nothing more.
#[kani::proof]
#[kani::unwind(5)]
fn no_more_is_granted_than_there_is_to_spare() {
    let (out, rate) = (below(10), below(2));
    let (kept, wanted) = ([below(3), below(3)], [below(3), below(3)]);
    let before = out - kept[0] - kept[1] - rate;
    let (mut spare, mut granted) = (Spare::of(before), kept);
    for sender in 0..2 {
        let flow = spare.most(kept[sender], wanted[sender]);
        assert!(flow <= wanted[sender]);
        if flow > kept[sender] {
            kani::cover!();
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

/// A receiver that keeps any flow below 4 until any period below 3, and promises two more, each until any period below
/// 4: it keeps what it did and what it promises, or nothing changes. When it keeps less than any limit from then on, and
/// when time has passed, what is left is what was to last.
#[kani::proof]
#[kani::unwind(3)]
fn a_promise_is_kept_beside_the_others_or_refused() {
    let period = before(5);
    let mut kept = Lease::of(below(4), before(3));
    for _ in 0..2 {
        let (flow, until) = (below(4), before(4));
        let known = kept;
        if kept.promise(flow, until) {
            kani::cover!(kept.part().is_some());
            let more = if period <= until { flow } else { 0 };
            assert!(kept.lasting(period) == known.lasting(period).max(more));
        } else {
            kani::cover!();
            assert!(kept == known);
        }
    }
    let (lasted, limit) = (kept.lasting(period), below(4));
    kept.limit(limit);
    kani::cover!(lasted > limit && kept.part().is_some());
    assert!(kept.lasting(period) == lasted.min(limit));
    kept.pass(period);
    assert!(kept.flow() == lasted.min(limit));
}

/// A receiver that keeps any flow below 3 until any period below 3, and promises two more below 4, each until any period
/// below 4. Each time it tells what it keeps. The sender hears three of these tellings, in any order, some of them again,
/// the last one in any period: from then on it may use no more than the receiver keeps, and as much if it has heard the
/// last telling of all.
#[kani::proof]
#[kani::unwind(4)]
fn a_lease_ends_at_the_sender_first() {
    let period = before(5);
    let now = u32::from(kani::any_where(|now: &u8| u32::from(*now) <= period));
    let mut kept = Lease::of(below(3), before(3));
    let mut told = [kept; 3];
    for telling in &mut told[1..] {
        kept.promise(below(4), before(4));
        *telling = kept;
    }
    let mut used = Lease::of(0, 0);
    let mut knows_all = false;
    for passed in &[0, 0, now] {
        used.pass(*passed);
        let heard = before(3);
        for (at, telling) in (0..3).zip(&mut told) {
            telling.pass(*passed);
            if at == heard {
                kani::cover!();
                used.hear(*telling);
            }
        }
        knows_all |= heard == 2;
    }
    kani::cover!(knows_all && used.lasting(period) > 0);
    kani::cover!(used.lasting(period) > 0 && used.lasting(period) < kept.lasting(period));
    kani::cover!(used.part().is_some() && used.lasting(period) == kept.lasting(period));
    assert!(!knows_all || used.lasting(period) == kept.lasting(period));
    assert!(used.lasting(period) <= kept.lasting(period));
}
