//! The exchange of duties between a mover and the robot that stands in its way.
//!
//! Robots are alike: where a mover would have to pass a parked robot, the two exchange duties
//! instead, which is Algorithm 4's "adopts the role" without the walk. The mover offers its duty;
//! the parked robot answers with its own and goes on doing it; the mover takes that and gives its
//! offer up; then the parked robot takes what was offered. Each step is visible in the beacon of the
//! robot that took it, so that messages may be repeated or come late.
//!
//! ```
//! use pleach_discrete::network::Offers;
//!
//! let (mut mover, mut parked) = (Offers::new(), Offers::new());
//! mover.make_offer(1, "relay");
//! let offer = mover.offer().expect("it has just been made");
//! parked.answer(0, offer, Some("leaf"));
//! assert_eq!(parked.conclude(mover.offer(), mover.offers_made()), None); // not before the mover
//!
//! let reply = parked.reply().expect("it has just answered");
//! assert_eq!(mover.hear(0, reply), Some("leaf"));
//! assert_eq!(parked.conclude(mover.offer(), mover.offers_made()), Some("relay"));
//! assert!(!mover.are_under_way() && !parked.are_under_way());
//! ```

use super::NodeId;

#[cfg(test)]
mod lemma;
#[cfg(any(kani, test))]
mod proofs;

/// A mover's standing offer to a parked robot.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Offer<D> {
    /// The receiver.
    pub to: NodeId,
    /// The offers of one robot are numbered.
    pub number: u32,
    /// The duty that the mover hands over.
    pub duty: D,
}

/// The parked robot's answer, repeated until the mover has heard it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Reply<D> {
    /// The receiver.
    pub to: NodeId,
    /// The number of the offer.
    pub number: u32,
    /// The duty that the parked robot handed over in return; none if it refused.
    pub accepted: Option<D>,
}

impl<D> Offer<D> {
    /// Whether `robot` is to answer, which has answered the offers of this mover up to the one
    /// with the number `answered`.
    pub fn asks(&self, robot: NodeId, answered: Option<u32>) -> bool {
        self.to == robot && answered.is_none_or(|last| last < self.number)
    }
}

impl<D> Reply<D> {
    /// Whether the mover has heard this reply, to judge by its `offer`: it has given that one up.
    pub fn is_heard(&self, offer: Option<&Offer<D>>) -> bool {
        offer.is_none_or(|offer| offer.number != self.number)
    }
}

/// The exchanges of a robot: with an offer as a mover, with a reply as the parked one.
#[derive(Clone, Debug, PartialEq)]
pub struct Offers<D> {
    offer: Option<Offer<D>>,
    offers_made: u32,
    reply: Option<Reply<D>>,
    /// What it gets for the duty that the reply hands over.
    taking: Option<D>,
}

impl<D> Default for Offers<D> {
    fn default() -> Self {
        Offers::new()
    }
}

impl<D> Offers<D> {
    /// Those of a robot that has never exchanged its duty.
    pub const fn new() -> Self {
        Offers::numbered_after(0)
    }

    /// Those of a robot that may have made this number of offers and has forgotten them: its next one is newer.
    pub const fn numbered_after(offers_made: u32) -> Self {
        Offers { offer: None, offers_made, reply: None, taking: None }
    }

    /// The standing offer.
    pub const fn offer(&self) -> Option<&Offer<D>> {
        self.offer.as_ref()
    }

    /// How many offers the robot has made so far.
    pub const fn offers_made(&self) -> u32 {
        self.offers_made
    }

    /// The answer that the mover has not heard yet.
    pub const fn reply(&self) -> Option<&Reply<D>> {
        self.reply.as_ref()
    }

    /// The duty that the robot takes over once the mover that offered it has taken its own.
    pub const fn taking(&self) -> Option<&D> {
        self.taking.as_ref()
    }

    /// Whether an exchange is under way.
    pub const fn are_under_way(&self) -> bool {
        self.offer.is_some() || self.reply.is_some()
    }
}

impl<D> Offers<D> {
    /// Whether the mover, which has this offer and has made this number of offers, has heard the reply.
    pub fn has_heard_reply(&self, offer: Option<&Offer<D>>, offers_made: u32) -> bool {
        // What the mover sent before it made the offer may be received again.
        self.reply
            .as_ref()
            .is_some_and(|reply| reply.is_heard(offer) && offers_made >= reply.number)
    }
}

impl<D: Copy> Offers<D> {
    /// The mover offers its `duty`.
    pub fn make_offer(&mut self, to: NodeId, duty: D) {
        self.offers_made += 1;
        self.offer = Some(Offer { to, number: self.offers_made, duty });
    }

    /// The parked robot answers the `offer` of `mover`: with the duty that it gives in return,
    /// or none if it refuses.
    pub fn answer(&mut self, mover: NodeId, offer: &Offer<D>, given: Option<D>) {
        self.taking = given.map(|_| offer.duty);
        self.reply = Some(Reply { to: mover, number: offer.number, accepted: given });
    }

    /// The mover, which is robot `own`, hears what the robot says to which it made its offer: the
    /// duty that it has now, if that one accepts.
    pub fn hear(&mut self, own: NodeId, reply: &Reply<D>) -> Option<D> {
        let offer = self.offer.as_ref()?;
        if reply.to != own || reply.number != offer.number {
            return None;
        }
        self.offer = None;
        reply.accepted
    }

    /// The robot that was asked no longer repeats its reply if that is a refusal.
    pub fn withdraw_refusal(&mut self) {
        self.reply.take_if(|reply| reply.accepted.is_none());
    }

    /// The parked robot hears of the mover, which has this offer and has made this number of offers: the duty
    /// that it has now, if it has given its own and the mover has taken that.
    pub fn conclude(&mut self, offer: Option<&Offer<D>>, offers_made: u32) -> Option<D> {
        if !self.has_heard_reply(offer, offers_made) {
            return None;
        }
        self.reply = None;
        self.taking.take()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_meant_for_others_changes_nothing() {
        let mut mover = Offers::new();
        mover.make_offer(4, 'a');
        let offer = mover.offer().cloned().expect("it has been made");
        assert!(offer.asks(4, None) && offer.asks(4, Some(0)));
        assert!(!offer.asks(3, None) && !offer.asks(4, Some(1)));
        for (to, number) in [(9, 1), (2, 8)] {
            let before = mover.clone();
            assert_eq!(mover.hear(2, &Reply { to, number, accepted: Some('b') }), None);
            assert_eq!(mover, before);
        }
        assert_eq!(mover.hear(2, &Reply { to: 2, number: 1, accepted: Some('b') }), Some('b'));
        assert!(!mover.are_under_way() && mover.offers_made() == 1);
    }

    #[test]
    fn who_refuses_takes_nothing() {
        let (mut mover, mut parked) = (Offers::default(), Offers::default());
        mover.make_offer(1, 'a');
        parked.answer(0, mover.offer().expect("it has been made"), None);
        assert!(parked.are_under_way() && parked.taking().is_none());
        assert_eq!(mover.hear(0, parked.reply().expect("it has answered")), None);
        assert!(!mover.are_under_way());
        assert_eq!(parked.conclude(mover.offer(), mover.offers_made()), None);
        assert!(!parked.are_under_way());
    }
}
