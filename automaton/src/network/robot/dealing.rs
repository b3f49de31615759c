//! The automaton of the exchange of duties: what each transition of [`DEALINGS`] does to the offers
//! and replies ([`Dealings`]), and when.
//!
//! Where an exchange gives the robot another duty, the duty automaton jumps together with this one.

use std::sync::Arc;

use pleach_discrete::network::{DEALINGS, Dealing, DealingEvent, Dealings, NodeId};
use pleach_guards::network::dealing as guards;

use crate::located::{Current, DataOf, Holds};
use crate::{Automaton, BuildError, Transfer, TransitionError};

use super::super::duty::Duty;
use super::super::record::MissionEvent;
use super::Robot;

/// The automaton of the exchange of duties.
pub type DealingAutomaton = Automaton<Dealing, DealingEvent, Robot>;

macro_rules! deals {
    ($($(#[$note:meta])* $name:ident),+ $(,)?) => {
        crate::places_of! {
            /// The state of a robot in the exchange of duties, with its offers and replies.
            pub enum Deal: Dealing { $($(#[$note])* $name($name)),+ }
        }

        $($(#[$note])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name(pub Dealings<Duty>);

        impl From<Dealings<Duty>> for $name {
            fn from(dealings: Dealings<Duty>) -> Self {
                $name(dealings)
            }
        }

        impl Dealer for $name {
            fn dealings(&self) -> &Dealings<Duty> {
                &self.0
            }
        })+

        impl Deal {
            /// Its offers and replies.
            pub const fn dealings(&self) -> &Dealings<Duty> {
                match self {
                    $(Deal::$name($name(dealings)) => dealings),+
                }
            }
        }
    };
}

trait Dealer {
    fn dealings(&self) -> &Dealings<Duty>;
}

deals! {
    /// The data of [`Dealing::Free`].
    Free,
    /// The data of [`Dealing::Offering`].
    Offering,
    /// The data of [`Dealing::Refusing`].
    Refusing,
    /// The data of [`Dealing::OfferingAndRefusing`].
    OfferingAndRefusing,
    /// The data of [`Dealing::Giving`].
    Giving,
}

/// The effects of a transition other than changing the location.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DealingEffect {
    /// It has answered the offer with this number of this mover.
    Answered(NodeId, u32),
    /// It no longer looks for a partner.
    PartnerAsked,
    /// It takes this duty over from this robot.
    Takes(Duty, NodeId),
}

type Effects = Vec<DealingEffect>;

impl Holds<Deal> for Robot {
    type Effects = Effects;

    fn current(&self) -> &Current<Deal> {
        &self.deal
    }

    fn current_mut(&mut self) -> &mut Current<Deal> {
        &mut self.deal
    }

    fn carry_out(&mut self, effects: Effects) {
        for effect in effects {
            match effect {
                DealingEffect::Answered(mover, number) => {
                    self.answered.insert(mover, number);
                }
                DealingEffect::PartnerAsked => self.partner = None,
                DealingEffect::Takes(duty, partner) => self.taking_over = Some((duty, partner)),
            }
        }
    }
}

impl Robot {
    /// Its offers and replies.
    pub(super) fn dealings(&self) -> &Dealings<Duty> {
        self.deal.dealings()
    }

    /// Takes all transitions of the exchange of duties that can be taken, together with the duty
    /// automaton where the robot gets another duty.
    pub(super) fn deal(&mut self) -> Result<(), TransitionError> {
        let site = Arc::clone(&self.site);
        while let Some(jump) = site.automata.dealing.step_in_place::<Deal>(self)? {
            self.stir();
            if let Some((duty, partner)) = self.taking_over.take() {
                self.exchange_duty(duty, partner)?;
                if jump.event == DealingEvent::DutyTaken {
                    let event = MissionEvent::DutiesExchanged { mover: self.id, parked: partner };
                    self.report(event);
                }
            }
        }
        Ok(())
    }
}

// ---- The resets ------------------------------------------------------------------------------

fn offer(free: &Free, robot: &Robot, effects: &mut Effects) -> Option<Offering> {
    let mut dealings = free.0.clone();
    dealings.make_offer(robot.partner?, *robot.duty);
    effects.push(DealingEffect::PartnerAsked);
    Some(Offering(dealings))
}

fn answer<A: Dealer, B: From<Dealings<Duty>>>(
    deal: &A,
    robot: &Robot,
    effects: &mut Effects,
    given: Option<Duty>,
) -> Option<B> {
    let (mover, offer) = robot.offer_to_answer()?;
    let mut dealings = deal.dealings().clone();
    dealings.answer(mover, offer, given);
    effects.push(DealingEffect::Answered(mover, offer.number));
    Some(B::from(dealings))
}

fn give(free: &Free, robot: &Robot, effects: &mut Effects) -> Option<Giving> {
    answer(free, robot, effects, Some(*robot.duty))
}

fn refuse<A: Dealer, B: From<Dealings<Duty>>>(
    deal: &A,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<B> {
    answer(deal, robot, effects, None)
}

/// The offer is answered: it is given up and, if it was accepted, the partner's duty taken.
fn hear_answer<A: Dealer, B: From<Dealings<Duty>>>(
    deal: &A,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<B> {
    let reply = robot.answer_to_offer()?;
    let partner = deal.dealings().offer()?.to;
    let mut dealings = deal.dealings().clone();
    if let Some(duty) = dealings.hear(robot.id, reply) {
        effects.push(DealingEffect::Takes(duty, partner));
    }
    Some(B::from(dealings))
}

/// The mover has heard the reply: it is given up and, if it was an acceptance, the duty offered
/// taken.
fn conclude<A: Dealer, B: From<Dealings<Duty>>>(
    deal: &A,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<B> {
    let to = deal.dealings().reply()?.to;
    let mover = robot.neighbour(to)?;
    let mut dealings = deal.dealings().clone();
    let (offer, offers_made) = (mover.beacon.offer.as_ref(), mover.beacon.offers_made);
    if let Some(duty) = dealings.conclude(offer, offers_made) {
        effects.push(DealingEffect::Takes(duty, to));
    }
    Some(B::from(dealings))
}

type Row = Transfer<Dealing, DealingEvent, Robot>;

fn taken<A, B>() -> Row
where
    A: DataOf<Deal> + Dealer,
    B: DataOf<Deal> + From<Dealings<Duty>>,
{
    let name = "take the partner's duty";
    Transfer::where_known(DealingEvent::DutyTaken, guards::duty_taken(), name, hear_answer::<A, B>)
}

fn refused<A, B>() -> Row
where
    A: DataOf<Deal> + Dealer,
    B: DataOf<Deal> + From<Dealings<Duty>>,
{
    let name = "give the offer up";
    let guard = guards::offer_refused();
    Transfer::where_known(DealingEvent::OfferRefused, guard, name, hear_answer::<A, B>)
}

fn refuses<A, B>() -> Row
where
    A: DataOf<Deal> + Dealer,
    B: DataOf<Deal> + From<Dealings<Duty>>,
{
    Transfer::where_known(DealingEvent::Refuses, guards::refuses(), "say no", refuse::<A, B>)
}

fn refusal_heard<A, B>() -> Row
where
    A: DataOf<Deal> + Dealer,
    B: DataOf<Deal> + From<Dealings<Duty>>,
{
    let (guard, name) = (guards::refusal_heard(), "say it no more");
    Transfer::where_known(DealingEvent::RefusalHeard, guard, name, conclude::<A, B>)
}

/// The automaton of the exchange of duties.
///
/// # Errors
/// Never with the table and guards of this crate; they are checked all the same.
pub fn dealing_automaton() -> Result<DealingAutomaton, BuildError> {
    use DealingEvent as On;
    Automaton::builder(DEALINGS, Dealing::Free)
        .observing()
        .carried_out(Transfer::where_known(On::Offers, guards::offers(), "offer the duty", offer))
        .carried_out(Transfer::where_known(On::Gives, guards::gives(), "give the duty", give))
        .carried_out(refuses::<Free, Refusing>())
        .carried_out(refuses::<Offering, OfferingAndRefusing>())
        .carried_out(taken::<Offering, Free>())
        .carried_out(taken::<OfferingAndRefusing, Refusing>())
        .carried_out(refused::<Offering, Free>())
        .carried_out(refused::<OfferingAndRefusing, Refusing>())
        .carried_out(refusal_heard::<OfferingAndRefusing, Offering>())
        .carried_out(refusal_heard::<Refusing, Free>())
        .carried_out(Transfer::where_known(
            On::DutyGiven,
            guards::duty_given(),
            "take the duty offered",
            conclude::<Giving, Free>,
        ))
        .build()
}
