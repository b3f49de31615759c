//! The steps of reservation are those of the lemma `reservation.smt2`, whatever is lost, late or copied:
//! exhaustively, for a sender and a receiver that take up to six steps.

use std::collections::BTreeSet;

use super::super::tests::flows::{grants, requests, router};
use super::*;

/// The receiver is robot 5 for the sender, and the sender robot 5 for the receiver.
const OTHER: NodeId = 5;
/// How many steps are taken.
const DEPTH: usize = 6;
/// Flows that differ by less are the same.
const LITTLE: f64 = 1e-9;

/// Both ends of a link, and every request and grant that was ever sent.
#[derive(Clone)]
struct Link {
    sender: Robot,
    receiver: Robot,
    asks: Vec<FlowRequest>,
    grants: Vec<FlowGrant>,
}

/// The state that the lemma speaks of.
#[derive(Clone, Copy, Debug, PartialEq)]
struct View {
    held: f64,
    granted: f64,
    asked: RequestNumber,
    kept: f64,
    known: RequestNumber,
    used_until: u32,
    kept_until: u32,
    /// What the receiver sends on beyond what it has granted and its rate.
    spare: f64,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    /// The sender plans this flow, and asks.
    Plan(f64),
    /// The receiver sends on this flow.
    SendOn(f64),
    SenderSettles,
    ReceiverSettles,
    HearAsk(usize),
    HearGrant(usize),
    /// This many control periods go by.
    Pass(u32),
}

impl Link {
    fn new() -> Self {
        let (asks, grants) = (Vec::new(), Vec::new());
        Link { sender: router(), receiver: router(), asks, grants }
    }

    fn view(&self) -> View {
        let held = &self.sender.links[0].held;
        let kept = self.receiver.reservations.iter().find(|kept| kept.from == OTHER);
        let robot = &self.receiver;
        View {
            held: held.flow,
            granted: held.granted,
            asked: held.asked,
            kept: kept.map_or(0.0, |kept| kept.flow),
            known: kept.map_or(RequestNumber::default(), |kept| kept.asked),
            used_until: held.until,
            kept_until: kept.map_or(0, |kept| kept.until),
            spare: robot.held_outflow() - robot.granted_to_others() - robot.rate,
        }
    }

    fn steps(&self) -> Vec<Step> {
        let plans = [0.0, 0.1, 0.3].map(Step::Plan);
        let rest =
            [Step::SendOn(0.1), Step::SendOn(0.3), Step::SenderSettles, Step::ReceiverSettles];
        let times = [Step::Pass(1), Step::Pass(self.sender.lease() + 1)];
        let asks = (0..self.asks.len()).map(Step::HearAsk);
        let grants = (0..self.grants.len()).map(Step::HearGrant);
        plans.into_iter().chain(rest).chain(times).chain(asks).chain(grants).collect()
    }

    /// Takes a step, by the functions of the robots; returns how many requests and grants are sent.
    fn take(&mut self, step: Step) -> [usize; 2] {
        let (mut asked, mut granted) = (Out::of(0), Out::of(0));
        let Link { sender, receiver, asks, grants: given } = self;
        match step {
            Step::Plan(flow) => {
                sender.links[0].share = flow / sender.links[0].reliability;
                sender.ask_for_flows(&mut asked);
            }
            Step::SendOn(flow) => {
                receiver.links[1].share = flow / receiver.links[1].reliability;
                receiver.ask_for_flows(&mut granted);
            }
            Step::SenderSettles => sender.take_in_requests(&mut asked),
            Step::ReceiverSettles => receiver.take_in_requests(&mut granted),
            Step::HearAsk(at) => receiver.hear_request(OTHER, asks[at]),
            Step::HearGrant(at) => sender.hear_grant(OTHER, given[at]),
            Step::Pass(periods) => {
                for (robot, outputs) in [(sender, &mut asked), (receiver, &mut granted)] {
                    robot.period += periods;
                    // Access points are heard all the time.
                    robot.links.iter_mut().for_each(|link| link.held.is_due = false);
                    robot.neighbours.iter_mut().for_each(|it| it.heard_in = robot.period);
                    robot.ask_for_flows(outputs);
                }
            }
        }
        let (asked, granted) = (requests(&mut asked), self::grants(&mut granted));
        let counts = [asked.len(), granted.len()];
        self.asks.extend(asked.into_iter().map(|(_, request)| request));
        self.grants.extend(granted.into_iter().map(|(_, grant)| grant));
        counts
    }

    /// What tells it from others.
    fn key(&self) -> String {
        let flows = |robot: &Robot| {
            let links = robot.links.iter().map(|link| (link.held, link.share));
            format!("{:?}", links.collect::<Vec<_>>())
        };
        let (sender, receiver) = (&self.sender, &self.receiver);
        let state = (sender.period, sender.last_request, sender.has_flow_news);
        let other = (&receiver.reservations, receiver.has_flow_news, &self.asks, &self.grants);
        format!("{state:?} {other:?} {} {}", flows(sender), flows(receiver))
    }
}

impl View {
    /// `before` and `after` of the lemma.
    fn is_invariant(&self, asks: &[FlowRequest], grants: &[FlowGrant]) -> bool {
        let asks = asks.iter().all(|ask| {
            ask.number <= self.asked
                && (ask.number <= self.known || self.granted <= ask.held + LITTLE)
        });
        let grants = grants.iter().all(|grant| {
            grant.number != self.asked
                || grant.number != self.known
                || grant.flow <= self.kept + LITTLE && grant.until <= self.kept_until
        });
        self.held <= self.granted + LITTLE
            && self.granted <= self.kept + LITTLE
            && self.known <= self.asked
            && (self.granted == 0.0 || self.used_until <= self.kept_until)
            && asks
            && grants
    }

    /// The sender uses no more than is granted, and what was granted before a request is void.
    fn sender_steps(&self, after: &View, asked: &[FlowRequest], has_ended: bool) -> bool {
        let granted = if has_ended { 0.0 } else { self.granted };
        let rest = after.held <= granted + LITTLE && after.used_until == self.used_until;
        rest && match asked {
            [] => (after.granted, after.asked) == (granted, self.asked),
            [ask] => {
                (after.granted, after.asked) == (after.held, ask.number)
                    && ask.number > self.asked
                    && ask.held == after.held
            }
            _ => false,
        }
    }

    /// The receiver keeps as much or more, tells what it keeps, and has that to spare.
    fn receiver_steps(&self, after: &View, granted: &[FlowGrant], has_ended: bool) -> bool {
        let (kept, until) = if has_ended { (0.0, 0) } else { (self.kept, self.kept_until) };
        let tells = |grant: &FlowGrant| {
            (grant.number, grant.flow, grant.until) == (after.known, after.kept, after.kept_until)
        };
        let is_silent = granted.is_empty();
        let is_kept = if is_silent { after.kept == kept } else { after.kept >= kept };
        let lasts = if is_silent { after.kept_until == until } else { after.kept_until >= until };
        let knows = after.known == self.known || has_ended;
        let has_spare = self.spare < 0.0 || after.spare >= -LITTLE;
        granted.iter().all(tells) && is_kept && lasts && knows && has_spare
    }

    fn has_same_sender(&self, other: &View) -> bool {
        let sender = |view: &View| (view.held, view.granted, view.asked, view.used_until);
        sender(self) == sender(other)
    }

    fn has_same_receiver(&self, other: &View) -> bool {
        let receiver = |view: &View| (view.kept, view.known, view.kept_until);
        receiver(self) == receiver(other)
    }
}

/// Whether a step is one of the lemma.
fn is_step(link: &Link, step: Step, next: &Link) -> bool {
    let (before, after) = (link.view(), next.view());
    let (asked, granted) = (&next.asks[link.asks.len()..], &next.grants[link.grants.len()..]);
    let (period, robot) = (next.sender.period, &link.receiver);
    let has_ended = before.used_until < period;
    let is_dropped = before.kept_until < period;
    match step {
        Step::Plan(_) => {
            before.sender_steps(&after, asked, has_ended) && before.has_same_receiver(&after)
        }
        Step::SenderSettles => {
            before.sender_steps(&after, asked, false) && before.has_same_receiver(&after)
        }
        Step::SendOn(_) => {
            before.receiver_steps(&after, granted, is_dropped) && before.has_same_sender(&after)
        }
        Step::ReceiverSettles => {
            before.receiver_steps(&after, granted, false) && before.has_same_sender(&after)
        }
        Step::HearAsk(at) => {
            let ask = link.asks[at];
            let is_known = robot.reservations.iter().any(|kept| kept.from == OTHER);
            let expected = if is_known && ask.number <= before.known {
                before
            } else {
                let kept_until = if is_known { before.kept_until } else { robot.period };
                View { kept: before.kept.min(ask.held), known: ask.number, kept_until, ..before }
            };
            expected.has_same_receiver(&after) && before.has_same_sender(&after)
        }
        Step::HearGrant(at) => {
            let grant = link.grants[at];
            let expected = if grant.number == before.asked {
                let used_until = before.used_until.max(grant.until);
                View { granted: before.granted.max(grant.flow), used_until, ..before }
            } else {
                before
            };
            expected.has_same_sender(&after) && before.has_same_receiver(&after)
        }
        Step::Pass(_) => {
            before.sender_steps(&after, asked, has_ended)
                && before.receiver_steps(&after, granted, is_dropped)
        }
    }
}

#[test]
fn every_step_of_a_reservation_is_one_of_the_lemma() {
    let first = Link::new();
    let mut known = BTreeSet::from([first.key()]);
    let (mut layer, mut used, mut ended) = (vec![first], 0, 0);
    for _ in 0..DEPTH {
        let mut next_layer = Vec::new();
        for link in &layer {
            for step in link.steps() {
                let mut next = link.clone();
                next.take(step);
                let (before, after) = (link.view(), next.view());
                assert!(is_step(link, step, &next), "{step:?}: {before:?} {after:?}");
                assert!(after.is_invariant(&next.asks, &next.grants), "{step:?}: {after:?}");
                used += usize::from(after.held > before.held);
                ended += usize::from(after.held < before.held);
                if known.insert(next.key()) {
                    next_layer.push(next);
                }
            }
        }
        layer = next_layer;
    }
    assert!(known.len() > 1_000 && used > 10 && ended > 0, "{} {used} {ended}", known.len());
}
