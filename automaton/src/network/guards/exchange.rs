//! The guards of the exchange of duties.

use pleach_guards::{Guard, proposition};

/// It may have made offers before it began, and have forgotten them.
pub(crate) fn offers_forgotten() -> Guard {
    Guard::new("offers forgotten", proposition("has_forgotten_offers"))
}

/// The robot with which it exchanges duties is gone.
pub(crate) fn partner_lost() -> Guard {
    Guard::new("partner lost", proposition("partner_gone"))
}

/// A robot in its way could go on with its duty, and it with that robot's.
pub(crate) fn offers() -> Guard {
    Guard::new("offers", proposition("finds_partner"))
}

/// The partner has refused its offer.
pub(crate) fn offer_refused() -> Guard {
    Guard::new("offer refused", proposition("offer_answered").and(!proposition("offer_accepted")))
}

/// The partner has accepted its offer.
pub(crate) fn duty_taken() -> Guard {
    Guard::new("duty taken", proposition("offer_answered").and(proposition("offer_accepted")))
}

/// Another robot offers its duty, and this one may leave its post to it.
pub(crate) fn gives() -> Guard {
    Guard::new("gives", proposition("asked").and(proposition("may_give")))
}

/// Another robot offers its duty, and this one may not leave its post to it.
pub(crate) fn refuses() -> Guard {
    Guard::new("refuses", proposition("asked").and(!proposition("may_give")))
}

/// The mover has given up the offer that this robot has refused.
pub(crate) fn refusal_heard() -> Guard {
    Guard::new("refusal heard", proposition("reply_heard"))
}

/// The mover that this robot has refused is gone.
pub(crate) fn refusal_in_vain() -> Guard {
    Guard::new("refusal in vain", proposition("refused_gone").and(!proposition("reply_heard")))
}

/// The mover has given up the offer that this robot has accepted: it has taken the duty.
pub(crate) fn duty_given() -> Guard {
    Guard::new("duty given", proposition("reply_heard"))
}
