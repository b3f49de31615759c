//! The exchange of duties as an automaton: where a robot stands in it, and the table.
//!
//! What each transition does to the offers and replies themselves is
//! [`Offers`](super::Offers).

use crate::{Superstate, TransitionTable, from, from_any, transitions, vocabulary};

vocabulary! {
    /// The state of a robot in the exchange of duties.
    #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
    #[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
    pub enum ExchangeStage: Location {
        /// It exchanges nothing.
        Free = "free",
        /// As a mover, it has offered its duty to the robot in its way.
        Offering = "offering",
        /// It has refused an offer, and repeats that until the mover has heard it.
        Refusing = "refusing",
        /// It has made an offer, and refused one.
        OfferingAndRefusing = "offering and refusing",
        /// It gives its duty for the one offered, and holds it until the mover has taken it.
        Giving = "giving",
    }

    /// What happens in an exchange of duties.
    pub enum ExchangeEvent: Event {
        /// It finds a robot in its way with which to exchange duties.
        Offers = "offers",
        /// Its offer is refused.
        OfferRefused = "offer refused",
        /// Its offer is accepted: it takes the partner's duty.
        DutyTaken = "duty taken",
        /// It accepts an offer.
        Gives = "gives",
        /// It refuses an offer.
        Refuses = "refuses",
        /// The mover has heard the refusal.
        RefusalHeard = "refusal heard",
        /// The mover is gone, and cannot hear the refusal.
        RefusalInVain = "refusal in vain",
        /// The mover has taken the duty given: it takes the one offered.
        DutyGiven = "duty given",
        /// It has begun while others were under way, and may have forgotten offers that it has made.
        OffersForgotten = "offers forgotten",
        /// The other robot is gone, and what it has made of the exchange is not known: it begins again.
        PartnerLost = "partner lost",
    }
}

impl ExchangeStage {
    /// The robot is engaged in an exchange with a partner.
    pub const ENGAGED: Superstate<ExchangeStage> = Superstate::new(
        "engaged",
        &[ExchangeStage::Offering, ExchangeStage::OfferingAndRefusing, ExchangeStage::Giving],
    );
}

/// The table of the exchange of duties.
///
/// Priority 0: what becomes of own offers. Priority 1: what becomes of a reply. Priority 2:
/// offers of others. Priority 3: an offer of its own. Priority 4: nothing can become of either.
pub const EXCHANGE: TransitionTable<ExchangeStage, ExchangeEvent> = {
    use ExchangeEvent as On;
    use ExchangeStage::{Free, Giving, Offering, OfferingAndRefusing, Refusing};
    transitions![ExchangeStage, ExchangeEvent;
        from(Free).on(On::OffersForgotten).to(Free),
        from(Free).on(On::Offers).to(Offering).priority(3),
        from(Free).on(On::Gives).to(Giving).priority(2),
        from(Free).on(On::Refuses).to(Refusing).priority(2),
        from(Offering).on(On::DutyTaken).to(Free),
        from(Offering).on(On::OfferRefused).to(Free),
        from(Offering).on(On::Refuses).to(OfferingAndRefusing).priority(2),
        from(OfferingAndRefusing).on(On::DutyTaken).to(Refusing),
        from(OfferingAndRefusing).on(On::OfferRefused).to(Refusing),
        from(OfferingAndRefusing).on(On::RefusalHeard).to(Offering).priority(1),
        from(OfferingAndRefusing).on(On::RefusalInVain).to(Offering).priority(1),
        from(Refusing).on(On::RefusalHeard).to(Free).priority(1),
        from(Refusing).on(On::RefusalInVain).to(Free).priority(1),
        from(Giving).on(On::DutyGiven).to(Free).priority(1),
        from_any(ExchangeStage::ENGAGED).on(On::PartnerLost).to(Free).priority(4),
    ]
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Location;

    #[test]
    fn the_table_is_deterministic_and_every_location_is_reached_and_left() {
        assert!(EXCHANGE.is_deterministic());
        assert_eq!(EXCHANGE.unreachable_from(ExchangeStage::Free), vec![]);
        for &exchange in ExchangeStage::ALL {
            let mut reached = [false; ExchangeStage::ALL.len()];
            EXCHANGE.mark_reachable(exchange, &mut reached);
            assert!(reached[ExchangeStage::Free as usize], "{exchange:?} never ends");
        }
    }
}
