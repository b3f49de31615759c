//! The exchange of duties that a robot is engaged in, and what has become of those before.

use std::collections::BTreeMap;

use pleach_discrete::network::{NodeId, NoticeId, Offer, Offers};

use super::exchange::{Exchange, ExchangeEffect, Free};
use crate::located::Current;
use crate::network::duty::Duty;

/// How far the mission has come: the newest notice, and how many subgroups of Σ have arrived.
pub(super) type Progress = (NoticeId, usize);

/// The exchanges of duties of a robot.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Exchanges {
    exchange: Current<Exchange>,
    /// How many offers the robot may have made before it began: at most one in each control period.
    forgotten_offers: u32,
    /// The robot in its way with which it could exchange duties.
    partner: Option<NodeId>,
    /// The duty that it takes over in this jump, and from which robot.
    taking_over: Option<(Duty, NodeId)>,
    past: Option<PastOffers>,
    /// The offer answered last, by the robot that made it.
    answered: BTreeMap<NodeId, Answered>,
}

/// An offer that has been answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Answered {
    /// The number of the offer.
    number: u32,
    /// It was a refusal, and the mover was gone before it received that.
    in_vain: bool,
}

/// What has become of the offers of a robot since the mission last made progress.
#[derive(Clone, Debug, PartialEq, Eq)]
struct PastOffers {
    since: Progress,
    /// The robots with which it has exchanged duties, one after the other.
    exchanged: Vec<NodeId>,
    /// The robots that have refused.
    refused: Vec<NodeId>,
}

impl Default for Exchanges {
    /// Those of a robot that has made no offer.
    fn default() -> Self {
        Exchanges {
            exchange: Current::new(Exchange::Free(Free(Offers::new()))),
            forgotten_offers: 0,
            partner: None,
            taking_over: None,
            past: None,
            answered: BTreeMap::new(),
        }
    }
}

impl Exchanges {
    /// The robot may have made this many offers before it began.
    pub(super) const fn forget_offers(&mut self, forgotten_offers: u32) {
        self.forgotten_offers = forgotten_offers;
    }

    /// How many offers the robot may have made before it began.
    pub(super) const fn forgotten_offers(&self) -> u32 {
        self.forgotten_offers
    }

    pub(super) const fn current(&self) -> &Current<Exchange> {
        &self.exchange
    }

    pub(super) const fn current_mut(&mut self) -> &mut Current<Exchange> {
        &mut self.exchange
    }

    /// The robot's offer and reply.
    pub(super) fn offers(&self) -> &Offers<Duty> {
        self.exchange.offers()
    }

    /// The robot in the way with which the robot could exchange duties.
    pub(super) const fn partner(&self) -> Option<NodeId> {
        self.partner
    }

    /// The robot could exchange duties with this one.
    pub(super) const fn choose_partner(&mut self, partner: Option<NodeId>) {
        self.partner = partner;
    }

    /// Carries out an effect of a transition, when the mission has come this far.
    pub(super) fn carry_out(&mut self, effect: ExchangeEffect, progress: Progress) {
        match effect {
            ExchangeEffect::Answered(mover, number) => {
                self.answered.insert(mover, Answered { number, in_vain: false });
            }
            ExchangeEffect::RefusedInVain(mover) => {
                if let Some(answered) = self.answered.get_mut(&mover) {
                    answered.in_vain = true;
                }
            }
            ExchangeEffect::Refused(partner) => self.past(progress).refused.push(partner),
            ExchangeEffect::PartnerAsked => self.partner = None,
            ExchangeEffect::Takes(duty, partner) => {
                // The partner that it had chosen could replace it in the duty that it gives away.
                self.partner = None;
                self.taking_over = Some((duty, partner));
            }
        }
    }

    /// The duty that the robot takes over in this jump, and from which robot.
    pub(super) const fn take_duty(&mut self) -> Option<(Duty, NodeId)> {
        self.taking_over.take()
    }

    /// The robot has exchanged duties with this one, when the mission has come this far.
    pub(super) fn conclude(&mut self, partner: NodeId, progress: Progress) {
        self.past(progress).exchanged.push(partner);
    }

    fn past(&mut self, since: Progress) -> &mut PastOffers {
        self.past.take_if(|past| past.since != since);
        let none = || PastOffers { since, exchanged: Vec::new(), refused: Vec::new() };
        self.past.get_or_insert_with(none)
    }

    /// The robots with which the robot has exchanged duties since the mission has come this far, and those that have
    /// refused.
    pub(super) fn past_offers(&self, progress: Progress) -> (&[NodeId], &[NodeId]) {
        let past = self.past.as_ref().filter(|past| past.since == progress);
        past.map_or((&[], &[]), |past| (&past.exchanged, &past.refused))
    }

    /// The number of the offer of this mover that has been answered last.
    pub(super) fn answered(&self, mover: NodeId) -> Option<u32> {
        self.answered.get(&mover).map(|answered| answered.number)
    }

    /// Whether this offer has been refused, and the mover was gone before it received that.
    pub(super) fn is_refused_in_vain(&self, mover: NodeId, offer: &Offer<Duty>) -> bool {
        let answered = self.answered.get(&mover);
        answered.is_some_and(|it| it.in_vain && it.number == offer.number)
    }
}

#[cfg(feature = "abstraction")]
impl Exchanges {
    /// What decides on the exchanges ahead, beside those that are past.
    pub(super) fn account(&self) -> String {
        format!("{:?} {:?}", &*self.exchange, self.answered)
    }
}

#[cfg(test)]
impl Exchanges {
    /// The robot is in this state.
    pub(super) fn is_at(&mut self, exchange: Exchange) {
        *self = Exchanges { exchange: Current::new(exchange), ..self.clone() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const THEN: Progress = (NoticeId::new(3, 1), 0);
    const NOW: Progress = (NoticeId::new(3, 1), 1);

    #[test]
    fn past_offers_count_until_the_mission_makes_progress() {
        let mut exchanges = Exchanges::default();
        exchanges.conclude(4, THEN);
        exchanges.carry_out(ExchangeEffect::Refused(5), THEN);
        assert_eq!(exchanges.past_offers(THEN), (&[4][..], &[5][..]));
        assert_eq!(exchanges.past_offers(NOW), (&[][..], &[][..]));
        exchanges.carry_out(ExchangeEffect::Refused(6), NOW);
        assert_eq!(exchanges.past_offers(NOW), (&[][..], &[6][..]));
    }

    #[test]
    fn a_partner_is_looked_for_until_it_is_asked() {
        let mut exchanges = Exchanges::default();
        exchanges.forget_offers(2);
        exchanges.choose_partner(Some(4));
        exchanges.carry_out(ExchangeEffect::Answered(5, 7), THEN);
        assert_eq!((exchanges.partner(), exchanges.answered(5)), (Some(4), Some(7)));
        exchanges.carry_out(ExchangeEffect::PartnerAsked, THEN);
        assert_eq!((exchanges.partner(), exchanges.forgotten_offers()), (None, 2));
    }
}
