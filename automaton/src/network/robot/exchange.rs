//! The automaton of the exchange of duties: what each transition of [`EXCHANGE`] does to the offers
//! and replies ([`Offers`]), and when.
//!
//! Where an exchange gives the robot another duty, the duty automaton jumps together with this one.

use std::sync::Arc;

use pleach_discrete::network::{EXCHANGE, ExchangeEvent, ExchangeStage, NodeId, Offers};

use crate::located::{Current, DataOf, Holds};
use crate::network::guards::exchange as guards;
use crate::{Automaton, BuildError, Transfer, TransitionError};

use super::Robot;
use crate::network::duty::Duty;
use crate::network::record::MissionEvent;

/// The automaton of the exchange of duties.
pub type ExchangeAutomaton = Automaton<ExchangeStage, ExchangeEvent, Robot>;

macro_rules! modes {
    ($($(#[$note:meta])* $name:ident),+ $(,)?) => {
        crate::places_of! {
            /// The state of a robot in the exchange of duties, with its offers and replies.
            pub enum Exchange: ExchangeStage { $($(#[$note])* $name($name)),+ }
        }

        $($(#[$note])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $name(pub Offers<Duty>);

        impl From<Offers<Duty>> for $name {
            fn from(offers: Offers<Duty>) -> Self {
                $name(offers)
            }
        }

        impl HasOffers for $name {
            fn offers(&self) -> &Offers<Duty> {
                &self.0
            }
        })+

        impl Exchange {
            /// Its offers and replies.
            pub const fn offers(&self) -> &Offers<Duty> {
                match self {
                    $(Exchange::$name($name(offers)) => offers),+
                }
            }
        }
    };
}

trait HasOffers {
    fn offers(&self) -> &Offers<Duty>;
}

modes! {
    /// The data of [`ExchangeStage::Free`].
    Free,
    /// The data of [`ExchangeStage::Offering`].
    Offering,
    /// The data of [`ExchangeStage::Refusing`].
    Refusing,
    /// The data of [`ExchangeStage::OfferingAndRefusing`].
    OfferingAndRefusing,
    /// The data of [`ExchangeStage::Giving`].
    Giving,
}

/// The effects of a transition other than changing the location.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ExchangeEffect {
    /// It has answered the offer with this number of this mover.
    Answered(NodeId, u32),
    /// It no longer repeats the refusal of this mover's offer, which that robot has not heard.
    RefusedInVain(NodeId),
    /// This robot has refused its offer.
    Refused(NodeId),
    /// It no longer looks for a partner.
    PartnerAsked,
    /// It takes this duty over from this robot.
    Takes(Duty, NodeId),
}

type Effects = Vec<ExchangeEffect>;

impl Holds<Exchange> for Robot {
    type Effects = Effects;

    fn current(&self) -> &Current<Exchange> {
        self.exchanges.current()
    }

    fn current_mut(&mut self) -> &mut Current<Exchange> {
        self.exchanges.current_mut()
    }

    fn carry_out(&mut self, effects: Effects) {
        let progress = self.progress();
        effects.into_iter().for_each(|effect| self.exchanges.carry_out(effect, progress));
    }
}

impl Robot {
    /// Its offers and replies.
    pub(super) fn offers(&self) -> &Offers<Duty> {
        self.exchanges.offers()
    }

    /// Takes all transitions of the exchange of duties that can be taken, together with the duty
    /// automaton where the robot gets another duty.
    pub(super) fn advance_exchange(&mut self) -> Result<(), TransitionError> {
        let site = Arc::clone(&self.site);
        while let Some(jump) = site.automata.exchange.step_in_place::<Exchange>(self)? {
            self.note_change();
            self.changes.allow_jump();
            if jump.event == ExchangeEvent::PartnerLost {
                self.begin_again()?;
            }
            if let Some((duty, partner)) = self.exchanges.take_duty() {
                self.exchange_duty(duty, partner)?;
                if jump.event == ExchangeEvent::DutyTaken {
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
    let mut offers = free.0.clone();
    offers.make_offer(robot.exchanges.partner()?, *robot.duty);
    effects.push(ExchangeEffect::PartnerAsked);
    Some(Offering(offers))
}

fn answer<A: HasOffers, B: From<Offers<Duty>>>(
    exchange: &A,
    robot: &Robot,
    effects: &mut Effects,
    given: Option<Duty>,
) -> Option<B> {
    let (mover, offer) = robot.offer_to_answer()?;
    let mut offers = exchange.offers().clone();
    offers.answer(mover, offer, given);
    effects.push(ExchangeEffect::Answered(mover, offer.number));
    Some(B::from(offers))
}

/// Its next offer is newer than any that it may have made before.
fn count_on(_: &Free, robot: &Robot, _: &mut Effects) -> Free {
    Free(Offers::numbered_after(robot.exchanges.forgotten_offers()))
}

fn give(free: &Free, robot: &Robot, effects: &mut Effects) -> Option<Giving> {
    answer(free, robot, effects, Some(*robot.duty))
}

fn refuse<A: HasOffers, B: From<Offers<Duty>>>(
    exchange: &A,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<B> {
    answer(exchange, robot, effects, None)
}

/// The offer is answered: it is given up and, if it was accepted, the partner's duty taken.
fn hear_answer<A: HasOffers, B: From<Offers<Duty>>>(
    exchange: &A,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<B> {
    let reply = robot.answer_to_offer()?;
    let partner = exchange.offers().offer()?.to;
    let mut offers = exchange.offers().clone();
    effects.push(match offers.hear(robot.id, reply) {
        Some(duty) => ExchangeEffect::Takes(duty, partner),
        None => ExchangeEffect::Refused(partner),
    });
    Some(B::from(offers))
}

/// The mover has heard the reply: it is given up and, if it was an acceptance, the duty offered
/// taken.
fn conclude<A: HasOffers, B: From<Offers<Duty>>>(
    exchange: &A,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<B> {
    let to = exchange.offers().reply()?.to;
    let mover = robot.neighbour(to)?;
    let mut offers = exchange.offers().clone();
    let (offer, offers_made) = (mover.beacon.offer.as_ref(), mover.beacon.offers_made);
    if let Some(duty) = offers.conclude(offer, offers_made) {
        effects.push(ExchangeEffect::Takes(duty, to));
    }
    Some(B::from(offers))
}

fn withdraw_refusal<A: HasOffers, B: From<Offers<Duty>>>(
    exchange: &A,
    _: &Robot,
    effects: &mut Effects,
) -> Option<B> {
    let mut offers = exchange.offers().clone();
    effects.push(ExchangeEffect::RefusedInVain(offers.reply()?.to));
    offers.withdraw_refusal();
    Some(B::from(offers))
}

fn lose_partner(_: &Exchange, robot: &Robot, _: &mut Effects) -> Free {
    Free(Offers::numbered_after(robot.offers().offers_made()))
}

type Row = Transfer<ExchangeStage, ExchangeEvent, Robot>;

fn taken<A, B>() -> Row
where
    A: DataOf<Exchange> + HasOffers,
    B: DataOf<Exchange> + From<Offers<Duty>>,
{
    let name = "take the partner's duty";
    Transfer::where_known(ExchangeEvent::DutyTaken, guards::duty_taken(), name, hear_answer::<A, B>)
}

fn refused<A, B>() -> Row
where
    A: DataOf<Exchange> + HasOffers,
    B: DataOf<Exchange> + From<Offers<Duty>>,
{
    let name = "withdraw the offer";
    let guard = guards::offer_refused();
    Transfer::where_known(ExchangeEvent::OfferRefused, guard, name, hear_answer::<A, B>)
}

fn refuses<A, B>() -> Row
where
    A: DataOf<Exchange> + HasOffers,
    B: DataOf<Exchange> + From<Offers<Duty>>,
{
    Transfer::where_known(ExchangeEvent::Refuses, guards::refuses(), "refuse", refuse::<A, B>)
}

fn refusal_heard<A, B>() -> Row
where
    A: DataOf<Exchange> + HasOffers,
    B: DataOf<Exchange> + From<Offers<Duty>>,
{
    let (guard, name) = (guards::refusal_heard(), "withdraw the reply");
    Transfer::where_known(ExchangeEvent::RefusalHeard, guard, name, conclude::<A, B>)
}

fn refusal_in_vain<A, B>() -> Row
where
    A: DataOf<Exchange> + HasOffers,
    B: DataOf<Exchange> + From<Offers<Duty>>,
{
    let (guard, name) = (guards::refusal_in_vain(), "withdraw the reply");
    let reset = withdraw_refusal::<A, B>;
    Transfer::where_known(ExchangeEvent::RefusalInVain, guard, name, reset)
}

/// The automaton of the exchange of duties.
///
/// # Errors
/// Never with the table and guards of this crate; they are still checked.
pub(in crate::network) fn exchange_automaton() -> Result<ExchangeAutomaton, BuildError> {
    use ExchangeEvent as On;
    Automaton::builder(EXCHANGE, ExchangeStage::Free)
        .observing()
        .carried_out(Transfer::new(
            On::OffersForgotten,
            guards::offers_forgotten(),
            "count on from there",
            count_on,
        ))
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
        .carried_out(refusal_in_vain::<OfferingAndRefusing, Offering>())
        .carried_out(refusal_in_vain::<Refusing, Free>())
        .carried_out(Transfer::where_known(
            On::DutyGiven,
            guards::duty_given(),
            "take the duty offered",
            conclude::<Giving, Free>,
        ))
        .carried_out(Transfer::from_any(
            ExchangeStage::ENGAGED,
            On::PartnerLost,
            guards::partner_lost(),
            "begin again",
            lose_partner,
        ))
        .build()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use pleach_continuous::Point;
    use pleach_discrete::network::{IdSet, Offer, Phase, Post, PostId};
    use serde_json::json;
    use std::collections::BTreeSet;

    use super::super::super::beacon::{Announcement, Beacon, Notice};
    use super::super::super::duty::{Held, Standby, Station};
    use super::super::super::message::Message;
    use super::super::super::roll::{Absent, Roll};
    use super::super::super::scenario::Scenario;
    use super::super::super::shared::Shared;
    use super::super::super::site::Site;
    use super::*;
    use crate::located::Place as _;
    use crate::node::{Input, Node, Outputs};

    /// A robot beside another one, in its first control period.
    fn robot() -> Robot {
        let scenario: Scenario = serde_json::from_value(json!({
            "name": "two robots",
            "workspace": {"boundary": [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]},
            "link": {"full_range": 1.0, "max_range": 2.0},
            "access_point": [{"position": [1.0, 1.0]}],
            "robot": [{"position": [2.0, 2.0]}, {"position": [2.2, 2.0]}],
            "task": [{"position": [3.0, 3.0]}],
        }))
        .expect("it is a scenario");
        let site = Arc::new(Site::new(&scenario).expect("its numbers make sense"));
        let mut robot = Robot::new(0, Point::new(2.0, 2.0), 0.1, site);
        tick(&mut robot);
        robot
    }

    fn tick(robot: &mut Robot) {
        let mut outputs = Outputs::of(0);
        robot.step(Input::Tick { passed: 0 }, &mut outputs).expect("it goes on");
    }

    fn hear(robot: &mut Robot, beacon: &Beacon) {
        let beacon = Arc::new(beacon.clone());
        let period = robot.schedule.period();
        let message = Message::Beacon { period, roll: Roll::default(), confirmed: None, beacon };
        let mut outputs = Outputs::of(0);
        robot.step(Input::Heard { from: 1, message: &message }, &mut outputs).expect("it goes on");
        tick(robot);
    }

    /// The beacon of the other robot.
    fn other() -> Beacon {
        let reference = Point::new(2.2, 2.0);
        let station = Station { post: Post::redundant(PostId(1)), reference };
        Beacon {
            duty: Some(Duty::Standby(Standby(Held { station, left: None }))),
            parked: true,
            ..Beacon::silent(1, reference)
        }
    }

    /// It offers its duty to robot 0.
    fn offer_duty(mover: &mut Beacon) {
        mover.offers_made = 1;
        mover.offer = mover.duty.map(|duty| Offer { to: 0, number: 1, duty });
    }

    fn task() -> Shared<Announcement> {
        Shared::new(Announcement {
            task: 0,
            position: Point::new(3.0, 3.0),
            before: Arc::default(),
            roster: Arc::new([0, 1].into_iter().collect()),
            eligible: Arc::new([0].into_iter().collect()),
            again: false,
            stretched: false,
            last_resort: None,
        })
    }

    /// A robot may need another post in the period in which it has made one, and given it away.
    #[test]
    fn posts_of_one_period_differ() {
        let mut robot = robot();
        let mut posts = BTreeSet::new();
        for made in 1..=3 {
            robot.duty.join_late();
            robot.changes.allow_jump();
            robot.note_change();
            robot.jump().expect("guards have values");
            posts.insert(robot.duty.post().expect("it stands by").id);
            assert_eq!(posts.len(), made);
        }
    }

    /// A robot that knows no task refuses an offer. A task that is announced meanwhile it takes up as soon
    /// as its refusal is heard, although it has learnt nothing else by then.
    #[test]
    fn a_robot_that_has_refused_an_offer_goes_on() {
        let mut robot = robot();
        let mut mover = other();
        offer_duty(&mut mover);
        hear(&mut robot, &mover);
        assert_eq!(robot.exchanges.current().location(), ExchangeStage::Refusing);
        assert_eq!(robot.offers().reply().map(|reply| reply.accepted), Some(None));

        mover.bulletin = mover.bulletin.next(2, Shared::new(Notice::Task(task())));
        hear(&mut robot, &mover);
        assert_eq!(
            (robot.exchanges.current().location(), robot.phase()),
            (ExchangeStage::Refusing, Phase::Idle)
        );

        mover.offer = None;
        hear(&mut robot, &mover);
        assert_eq!(robot.exchanges.current().location(), ExchangeStage::Free);
        assert_eq!(robot.phase(), Phase::LeaderElection);
    }

    /// The robot is in its seventh period, and robot 1 is gone if that is said.
    fn begins_a_period(robot: &mut Robot, is_gone: bool) {
        robot.schedule.is_in(7);
        let gone = if is_gone { [1].into_iter().collect() } else { IdSet::default() };
        robot
            .membership
            .is_told(Roll { called: 7, absent: Arc::new(Absent { gone, ..Absent::default() }) });
        robot.schedule.count_rounds_anew();
        robot.begin_period().expect("guards have values");
    }

    /// It cannot tell whether the other one has its duty, or still the other one's own.
    #[test]
    fn a_robot_whose_partner_is_gone_begins_again() {
        for is_gone in [false, true] {
            let mut robot = robot();
            let mut offers = Offers::new();
            offers.make_offer(1, *robot.duty);
            robot.exchanges.is_at(Exchange::Offering(Offering(offers)));
            let before = robot.duty.post().expect("it stands by").id;
            begins_a_period(&mut robot, is_gone);
            assert_eq!(robot.is_engaged(), !is_gone);
            assert_eq!(robot.duty.post().map(|post| post.id) != Some(before), is_gone);
            if is_gone {
                assert!(
                    !robot.membership.knows_who_is_absent(),
                    "it waits like one that joins late"
                );
                robot.advance_exchange().expect("guards have values");
                assert_eq!(robot.offers().offers_made(), 1, "its next offer is a new one");
            }
        }
    }

    /// The partner that it had found for its duty before may not be able to bear the new one.
    #[test]
    fn a_robot_that_takes_a_duty_over_has_no_partner_for_it_yet() {
        let mut robot = robot();
        robot.exchanges.choose_partner(Some(1));
        let duty = *robot.duty;
        Holds::<Exchange>::carry_out(&mut robot, vec![ExchangeEffect::Takes(duty, 1)]);
        assert_eq!(robot.exchanges.partner(), None);
        assert_eq!(robot.exchanges.take_duty(), Some((duty, 1)));
    }

    /// A refusal that nobody can hear is withdrawn, so that the robot can take part in other exchanges. The mover
    /// may come back with its offer: it is refused again although the robot could accept by now, as it may have heard
    /// the first refusal.
    #[test]
    fn a_refusal_that_nobody_can_hear_holds_nobody_up() {
        for has_refused in [true, false] {
            let mut robot = robot();
            let mut mover = Beacon { position: Point::new(2.02, 2.0), ..other() };
            if has_refused {
                offer_duty(&mut mover);
                hear(&mut robot, &mover);
                begins_a_period(&mut robot, false);
                assert_eq!(robot.exchanges.current().location(), ExchangeStage::Refusing);
                begins_a_period(&mut robot, true);
                assert_eq!(robot.exchanges.current().location(), ExchangeStage::Free);
                assert!(robot.offers().reply().is_none() && !robot.is_engaged());
            }
            robot.membership.is_told(Roll::default());
            robot.mission.notices_mut().issue(2, Notice::Task(task()));
            let id = robot.notice_id();
            robot.mission.notices_mut().follow(Some((id, task())));
            offer_duty(&mut mover);
            mover.announced = robot.mission.notices().announced().cloned();
            hear(&mut robot, &mover);
            let reply = robot.offers().reply().expect("it answers");
            assert_eq!(reply.accepted.is_none(), has_refused);
        }
    }

    /// Its own offer stands meanwhile.
    #[test]
    fn a_mover_that_has_refused_one_that_is_gone_still_offers_its_duty() {
        let mut robot = robot();
        let mut offers = Offers::new();
        offers.make_offer(2, *robot.duty);
        let refused = Offer { to: 0, number: 1, duty: *robot.duty };
        offers.answer(1, &refused, None);
        robot.exchanges.is_at(Exchange::OfferingAndRefusing(OfferingAndRefusing(offers)));
        begins_a_period(&mut robot, true);
        assert_eq!(robot.exchanges.current().location(), ExchangeStage::Offering);
        assert!(robot.offers().offer().is_some() && robot.offers().reply().is_none());
    }
}
