//! The steps of exchanges are those of the lemma `exchange.smt2`, whatever is lost, late or copied:
//! exhaustively, for three robots and as many offers.

use std::collections::{BTreeMap, BTreeSet};

use super::*;
use crate::network::{EXCHANGE, ExchangeEvent, ExchangeStage};

const ROBOTS: usize = 3;
/// All robots together make no more offers than this.
const MOST_OFFERS: usize = 3;

type Duty = u8;
/// An offer, by who made it and its number.
type Name = (NodeId, u32);

/// A robot: where it is in the table, its offers and replies, what it does, and the numbers of the offers
/// that it has answered last.
#[derive(Clone)]
struct Robot {
    stage: ExchangeStage,
    offers: Offers<Duty>,
    duty: Duty,
    answered: [Option<u32>; ROBOTS],
}

/// What a beacon tells of exchanges.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Beacon {
    sender: NodeId,
    made: u32,
    /// To whom the offer that stands is made, and what is offered.
    offer: Option<(NodeId, Duty)>,
    /// Whom the reply that stands is for, to which offer, and what it gives.
    reply: Option<(NodeId, u32, Option<Duty>)>,
}

/// The robots, every beacon that was ever told, and what became of every offer.
#[derive(Clone)]
struct Network {
    robots: Vec<Robot>,
    told: BTreeSet<Beacon>,
    made: BTreeMap<Name, (NodeId, Duty)>,
    answers: BTreeMap<Name, Option<Duty>>,
}

/// The state that the lemma speaks of.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct View {
    duty: Vec<Duty>,
    last: Vec<u32>,
    offers: Vec<bool>,
    /// For which offer a robot gives its duty.
    gives: Vec<Option<Name>>,
    /// What was offered to whom, and what was answered.
    what: BTreeMap<Name, (NodeId, Duty)>,
    answered: BTreeMap<Name, Option<Duty>>,
    told: BTreeSet<(Name, bool)>,
}

impl View {
    fn stands(&self, (by, number): Name) -> bool {
        self.offers[by] && self.last[by] == number
    }

    fn in_effect(&self, robot: NodeId) -> Duty {
        match self.gives[robot] {
            Some(offer) if !self.stands(offer) => self.what[&offer].1,
            _ => self.duty[robot],
        }
    }

    fn all_in_effect(&self) -> Vec<Duty> {
        (0..ROBOTS).map(|robot| self.in_effect(robot)).collect()
    }

    /// `before` and `after` of the lemma.
    fn is_invariant(&self) -> bool {
        let effects: BTreeSet<Duty> = self.all_in_effect().into_iter().collect();
        let robots = (0..ROBOTS).all(|robot| {
            let own = (robot, self.last[robot]);
            (!self.offers[robot]
                || self.what[&own].1 == self.duty[robot] && self.gives[robot].is_none())
                && self.gives[robot].is_none_or(|offer| {
                    self.answered.get(&offer) == Some(&Some(self.duty[robot]))
                        && self.what[&offer].0 == robot
                })
        });
        let answers = self.answered.iter().all(|(&offer, given)| {
            let giver = self.what[&offer].0;
            offer.1 <= self.last[offer.0]
                && (!self.stands(offer) || given.is_none() || self.gives[giver] == Some(offer))
        });
        let beacons = self.told.iter().all(|&(offer, stood)| {
            let is_answered = self.answered.contains_key(&offer);
            offer.1 <= self.last[offer.0]
                && if stood { is_answered || self.stands(offer) } else { !self.stands(offer) }
        });
        effects.len() == ROBOTS && robots && answers && beacons
    }

    /// Whether `a` takes this step, by the relation of the lemma, and gets to `after`.
    fn steps(&self, a: NodeId, step: &Step, after: &View) -> bool {
        let mut expected = self.clone();
        let is_at_rest = !self.offers[a] && self.gives[a].is_none();
        let is_possible = match *step {
            Step::Make { to } => {
                (expected.last[a], expected.offers[a]) = (after.last[a], true);
                let own = (a, after.last[a]);
                expected.what.insert(own, (to, self.duty[a]));
                is_at_rest && after.last[a] > self.last[a]
            }
            Step::Answer { offer, gives } => {
                expected.answered.insert(offer, gives.then_some(self.duty[a]));
                if gives {
                    expected.gives[a] = Some(offer);
                }
                self.told.contains(&(offer, true))
                    && self.what[&offer].0 == a
                    && !self.answered.contains_key(&offer)
                    && self.gives[a].is_none()
                    && (!gives || is_at_rest)
            }
            Step::Hear { offer } => {
                expected.offers[a] = false;
                expected.duty[a] = self.answered[&offer].unwrap_or(self.duty[a]);
                self.offers[a] && offer == (a, self.last[a])
            }
            Step::Conclude { heard: (offer, stood) } => {
                let given = self.gives[a];
                expected.gives[a] = None;
                expected.duty[a] = given.map_or(self.duty[a], |given| self.what[&given].1);
                self.told.contains(&(offer, stood))
                    && given.is_none_or(|given| {
                        offer.0 == given.0 && offer >= given && !(stood && offer == given)
                    })
            }
        };
        let told = ((a, after.last[a]), after.offers[a]);
        expected.told.insert(told);
        is_possible && expected == *after
    }

    /// Whether duties in effect are as before, or, where a robot hears that it is given one, exchanged
    /// between the two.
    fn exchanges(&self, a: NodeId, step: &Step, after: &View) -> bool {
        let mut expected = self.all_in_effect();
        if let Step::Hear { offer } = step
            && self.answered[offer].is_some()
        {
            expected.swap(a, self.what[offer].0);
        }
        expected == after.all_in_effect()
    }
}

/// The steps of the lemma.
#[derive(Debug)]
enum Step {
    Make { to: NodeId },
    Answer { offer: Name, gives: bool },
    Hear { offer: Name },
    Conclude { heard: (Name, bool) },
}

impl Network {
    fn new() -> Self {
        let robot = |duty| Robot {
            stage: ExchangeStage::Free,
            offers: Offers::new(),
            duty,
            answered: [None; ROBOTS],
        };
        let robots = (0..ROBOTS as u8).map(robot).collect();
        let (told, made, answers) = (BTreeSet::new(), BTreeMap::new(), BTreeMap::new());
        let mut network = Network { robots, told, made, answers };
        (0..ROBOTS).for_each(|robot| network.tell(robot));
        network
    }

    fn beacon(&self, sender: NodeId) -> Beacon {
        let offers = &self.robots[sender].offers;
        Beacon {
            sender,
            made: offers.offers_made(),
            offer: offers.offer().map(|offer| (offer.to, offer.duty)),
            reply: offers.reply().map(|reply| (reply.to, reply.number, reply.accepted)),
        }
    }

    fn tell(&mut self, robot: NodeId) {
        self.told.insert(self.beacon(robot));
    }

    fn view(&self) -> View {
        let given = |robot: &Robot| {
            let reply = robot.offers.reply().filter(|reply| reply.accepted.is_some())?;
            Some((reply.to, reply.number))
        };
        View {
            duty: self.robots.iter().map(|robot| robot.duty).collect(),
            last: self.robots.iter().map(|robot| robot.offers.offers_made()).collect(),
            offers: self.robots.iter().map(|robot| robot.offers.offer().is_some()).collect(),
            gives: self.robots.iter().map(given).collect(),
            what: self.made.clone(),
            answered: self.answers.clone(),
            told: self.told.iter().map(|it| ((it.sender, it.made), it.offer.is_some())).collect(),
        }
    }

    /// The place that the table leads robot `a` to.
    fn led_by(&self, a: NodeId, event: ExchangeEvent) -> Option<ExchangeStage> {
        let stage = self.robots[a].stage;
        EXCHANGE
            .rows()
            .iter()
            .find(|row| (row.source, row.event) == (stage, event))
            .map(|it| it.target)
    }

    /// The network in which robot `a` has taken a transition, if the table has one.
    fn after(
        &self,
        a: NodeId,
        event: ExchangeEvent,
        act: impl FnOnce(&mut Robot),
    ) -> Option<Network> {
        let target = self.led_by(a, event)?;
        let mut next = self.clone();
        act(&mut next.robots[a]);
        next.robots[a].stage = target;
        next.tell(a);
        Some(next)
    }

    /// Everything that robot `a` may do next, as the robots do it.
    fn successors(&self, a: NodeId) -> Vec<(Step, Network)> {
        let mut all = Vec::new();
        if self.made.len() < MOST_OFFERS {
            for to in (0..ROBOTS).filter(|&to| to != a) {
                let act = |robot: &mut Robot| robot.offers.make_offer(to, robot.duty);
                if let Some(mut next) = self.after(a, ExchangeEvent::Offers, act) {
                    let number = next.robots[a].offers.offers_made();
                    next.made.insert((a, number), (to, self.robots[a].duty));
                    all.push((Step::Make { to }, next));
                }
            }
        }
        for heard in self.told.iter().filter(|heard| heard.sender != a) {
            all.extend(self.answers_to(a, heard));
            all.extend(self.hears(a, heard));
            all.extend(self.concludes(a, heard));
        }
        all
    }

    fn answers_to(&self, a: NodeId, heard: &Beacon) -> Vec<(Step, Network)> {
        let Some((to, duty)) = heard.offer else { return Vec::new() };
        let offer = Offer { to, number: heard.made, duty };
        if !offer.asks(a, self.robots[a].answered[heard.sender]) {
            return Vec::new();
        }
        let name = (heard.sender, offer.number);
        let answer = |event, gives: bool| {
            let given = gives.then_some(self.robots[a].duty);
            let mut next = self.after(a, event, |robot| {
                robot.offers.answer(heard.sender, &offer, given);
                robot.answered[heard.sender] = Some(offer.number);
            })?;
            next.answers.insert(name, given);
            Some((Step::Answer { offer: name, gives }, next))
        };
        let gives = answer(ExchangeEvent::Gives, true);
        gives.into_iter().chain(answer(ExchangeEvent::Refuses, false)).collect()
    }

    fn hears(&self, a: NodeId, heard: &Beacon) -> Option<(Step, Network)> {
        let (to, number, accepted) = heard.reply?;
        let reply = Reply { to, number, accepted };
        let mut offers = self.robots[a].offers.clone();
        let asked = offers.offer()?.to;
        let duty = offers.hear(a, &reply);
        if asked != heard.sender || offers.offer().is_some() {
            return None;
        }
        let event = match duty {
            Some(_) => ExchangeEvent::DutyTaken,
            None => ExchangeEvent::OfferRefused,
        };
        let next = self.after(a, event, |robot| {
            robot.offers = offers;
            robot.duty = duty.unwrap_or(robot.duty);
        })?;
        Some((Step::Hear { offer: (a, number) }, next))
    }

    fn concludes(&self, a: NodeId, heard: &Beacon) -> Option<(Step, Network)> {
        let offer = heard.offer.map(|(to, duty)| Offer { to, number: heard.made, duty });
        let mut offers = self.robots[a].offers.clone();
        let reply = offers.reply()?.clone();
        if reply.to != heard.sender || !offers.has_heard_reply(offer.as_ref(), heard.made) {
            return None;
        }
        let duty = offers.conclude(offer.as_ref(), heard.made);
        let event = match reply.accepted {
            Some(_) => ExchangeEvent::DutyGiven,
            None => ExchangeEvent::RefusalHeard,
        };
        let next = self.after(a, event, |robot| {
            robot.offers = offers;
            robot.duty = duty.unwrap_or(robot.duty);
        })?;
        Some((Step::Conclude { heard: ((heard.sender, heard.made), offer.is_some()) }, next))
    }

    /// What tells it from others.
    fn key(&self) -> (View, BTreeSet<Beacon>, Vec<Beacon>) {
        let beacons = (0..ROBOTS).map(|robot| self.beacon(robot)).collect();
        (self.view(), self.told.clone(), beacons)
    }
}

/// Every step that three robots can take, with up to three offers, is a step of the lemma: it is allowed
/// where the lemma allows it, and leads where that says. Duties in effect are never lost, nor done by two.
#[test]
fn every_step_of_an_exchange_is_one_of_the_lemma() {
    let first = Network::new();
    let mut known = BTreeSet::from([first.key()]);
    let (mut waiting, mut exchanged) = (vec![first], 0);
    while let Some(network) = waiting.pop() {
        let before = network.view();
        assert!(before.is_invariant(), "{before:?}");
        for a in 0..ROBOTS {
            for (step, next) in network.successors(a) {
                let after = next.view();
                assert!(before.steps(a, &step, &after), "{a} {step:?}: {before:?} {after:?}");
                assert!(before.exchanges(a, &step, &after), "{a} {step:?}: {before:?} {after:?}");
                exchanged += usize::from(before.all_in_effect() != after.all_in_effect());
                if known.insert(next.key()) {
                    waiting.push(next);
                }
            }
        }
    }
    assert!(known.len() > 10_000 && exchanged > 1_000, "{} states, {exchanged}", known.len());
}
