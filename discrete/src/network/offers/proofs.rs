//! Exchanges conserve duties, also while they are under way and whatever comes late.

use super::*;

/// The two robots.
const MOVER: NodeId = 0;
const PARKED: NodeId = 1;

/// What a robot does, and what it sends of its offers: now, and before its last step.
struct Robot {
    duty: u8,
    now: Offers<u8>,
    before: Offers<u8>,
}

impl Robot {
    fn new(duty: u8) -> Self {
        Robot { duty, now: Offers::new(), before: Offers::new() }
    }

    /// What is heard of it: its last beacon, or the one before.
    fn heard(&self) -> Offers<u8> {
        if kani::any() { self.now.clone() } else { self.before.clone() }
    }

    /// Takes over a duty, if there is one to take.
    fn take(&mut self, duty: Option<u8>) {
        self.duty = duty.unwrap_or(self.duty);
    }
}

/// The duty in effect of the parked robot: the one that it gets, once the mover has its own.
fn in_effect(parked: &Robot, mover: &Robot) -> u8 {
    let handed_over = |reply: &Reply<u8>| reply.is_heard(mover.now.offer());
    match parked.now.taking() {
        Some(&taking) if parked.now.reply().is_some_and(handed_over) => taking,
        _ => parked.duty,
    }
}

/// A mover and a parked robot, six steps in any order: the mover makes an offer or hears of the
/// parked robot, which hears of the mover and answers as it likes. What is heard may be what was
/// said before the last step. After every step each of the two duties is in effect once; and when
/// no exchange is under way, the robots do what is in effect.
#[kani::proof]
#[kani::unwind(8)]
fn an_exchange_conserves_duties_at_every_step() {
    let (mut mover, mut parked) = (Robot::new(3), Robot::new(5));
    let mut answered = None;
    for _ in 0..6 {
        let step: u8 = kani::any_where(|step| *step < 3);
        if step == 0 {
            kani::cover!();
            mover.before = mover.now.clone();
            if !mover.now.are_under_way() {
                kani::cover!();
                mover.now.make_offer(PARKED, mover.duty);
            }
        } else if step == 1 {
            kani::cover!();
            let heard = parked.heard();
            mover.before = mover.now.clone();
            let duty = heard.reply().and_then(|reply| mover.now.hear(MOVER, reply));
            mover.take(duty);
        } else {
            kani::cover!();
            let heard = mover.heard();
            parked.before = parked.now.clone();
            let duty = parked.now.conclude(heard.offer(), heard.offers_made());
            parked.take(duty);
            if let Some(offer) = heard.offer()
                && parked.now.reply().is_none()
                && offer.asks(PARKED, answered)
            {
                kani::cover!();
                let given = if kani::any() { Some(parked.duty) } else { None };
                parked.now.answer(MOVER, offer, given);
                answered = Some(offer.number);
            }
        }
        let effect = in_effect(&parked, &mover);
        kani::cover!(mover.duty == 5 && parked.duty == 5);
        kani::cover!(mover.duty == 5 && parked.duty == 3 && mover.now.offer().is_some());
        assert!((mover.duty, effect) == (3, 5) || (mover.duty, effect) == (5, 3));
        let at_rest = !mover.now.are_under_way() && !parked.now.are_under_way();
        assert!(!at_rest || parked.duty == effect);
    }
}
