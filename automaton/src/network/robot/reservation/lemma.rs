//! The steps of reservation are those of the lemma `reservation.smt2`, whatever is lost, late or copied:
//! exhaustively, for a sender and a receiver that take up to six steps.

use std::collections::BTreeSet;

use super::tests::{Alone, NEXT, RATE, grants, requests};
use super::*;

/// The receiver is robot 5 for the sender, and the sender robot 5 for the receiver.
const OTHER: NodeId = NEXT;
/// The flow that the receiver sends back.
const BACK: f64 = 0.05;
/// How many steps are taken; one less from the link that is in use.
const DEPTH: usize = 6;
/// Flows that differ by less are the same.
const LITTLE: f64 = 1e-9;

/// Both ends of a link, and every request and grant that was ever sent.
#[derive(Clone)]
struct Link {
    sender: Alone,
    receiver: Alone,
    asks: Vec<FlowRequest>,
    grants: Vec<FlowGrant>,
}

/// The state that the lemma speaks of, for every control period from this one on.
#[derive(Clone, Copy, Debug, PartialEq)]
struct View {
    period: u32,
    held: f64,
    granted: Lease<f64>,
    asked: RequestNumber,
    kept: Lease<f64>,
    known: RequestNumber,
    /// What the receiver sends on beyond what it has granted and its rate, at the least in all these periods.
    spare: f64,
}

#[derive(Clone, Copy, Debug)]
enum Step {
    /// The sender plans this flow, and asks.
    Plan(f64),
    /// The receiver sends on this flow.
    SendOn(f64),
    /// The receiver sends a flow back, for this many control periods.
    SendBack(u32),
    /// A probe of the receiver returns from the sender, having gone round a circle in which this flows.
    FindCircle(f64),
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
        Link { sender: Alone::new(), receiver: Alone::new(), asks, grants }
    }

    /// The receiver has granted what it sends on, now sends something back, and hears what is asked next.
    fn in_use() -> Self {
        let mut link = Self::new();
        for step in [
            Step::SendOn(0.3),
            Step::Plan(0.3),
            Step::HearAsk(0),
            Step::ReceiverSettles,
            Step::HearGrant(0),
            Step::SenderSettles,
            Step::SendBack(3),
            Step::Plan(0.3),
            Step::HearAsk(1),
        ] {
            link.take(step);
        }
        link
    }

    fn view(&self) -> View {
        let (sender, receiver) = (&self.sender.reservation, &self.receiver.reservation);
        let (held, granted, asked) =
            sender.held.to(OTHER).map(|held| held.parts()).unwrap_or_default();
        let (kept, known) = receiver.kept.of(OTHER).unwrap_or_default();
        let promises = receiver.kept.promises(self.receiver.period);
        let spare = promises.map(|(end, promised)| receiver.held.lasting(end) - promised - RATE);
        let spare = spare.fold(f64::INFINITY, f64::min);
        View { period: self.sender.period, held, granted, asked, kept, known, spare }
    }

    fn steps(&self) -> Vec<Step> {
        let plans = [0.0, 0.1, 0.3].map(Step::Plan);
        let rest = [
            Step::SendOn(0.1),
            Step::SendOn(0.3),
            Step::SendBack(3),
            Step::FindCircle(0.1),
            Step::FindCircle(0.4),
            Step::SenderSettles,
            Step::ReceiverSettles,
        ];
        let times = [Step::Pass(1), Step::Pass(LEASE + 1)];
        let asks = (0..self.asks.len()).map(Step::HearAsk);
        let grants = (0..self.grants.len()).map(Step::HearGrant);
        plans.into_iter().chain(rest).chain(times).chain(asks).chain(grants).collect()
    }

    /// Takes a step, by the functions of the robots; returns how many requests and grants are sent.
    fn take(&mut self, step: Step) -> [usize; 2] {
        let (mut asked, mut granted) = (Vec::new(), Vec::new());
        let Link { sender, receiver, asks, grants: given } = self;
        match step {
            Step::Plan(flow) => {
                sender.plans[0].flow = flow;
                asked = sender.asks();
            }
            Step::SendOn(flow) => {
                receiver.plans[1].flow = flow;
                granted = receiver.asks();
            }
            Step::SendBack(periods) => {
                receiver.plans[0].flow = BACK;
                let lease = Lease::of(BACK, receiver.period + periods);
                receiver.reservation.held.set(OTHER, BACK, lease);
            }
            Step::FindCircle(flow) => {
                receiver.reservation.circles.add(OTHER, OTHER, flow);
                receiver.reservation.has_news = true;
            }
            Step::SenderSettles => asked = sender.settles(),
            Step::ReceiverSettles => granted = receiver.settles(),
            Step::HearAsk(at) => receiver.receives_request(OTHER, asks[at]),
            Step::HearGrant(at) => sender.receives_grant(OTHER, given[at]),
            Step::Pass(periods) => {
                for (alone, sent) in [(sender, &mut asked), (receiver, &mut granted)] {
                    alone.period += periods;
                    alone.receives_all();
                    *sent = alone.asks();
                }
            }
        }
        let (asked, granted) = (requests(asked), self::grants(granted));
        let counts = [asked.len(), granted.len()];
        self.asks.extend(asked.into_iter().map(|(_, request)| request));
        self.grants.extend(granted.into_iter().map(|(_, grant)| grant));
        counts
    }

    /// What tells it from others.
    fn key(&self) -> String {
        let state = |alone: &Alone| {
            let flows: Vec<f64> = alone.plans.iter().map(|plan| plan.flow).collect();
            format!("{:?} {flows:?} {}", alone.reservation, alone.period)
        };
        let (sender, receiver) = (state(&self.sender), state(&self.receiver));
        format!("{sender} {receiver} {:?} {:?}", self.asks, self.grants)
    }
}

impl View {
    /// The control periods in which two states are compared: from that of the later one on, what holds becomes less
    /// after these.
    fn periods(&self, before: &View) -> impl Iterator<Item = u32> {
        let leases = [self.granted, self.kept, before.granted, before.kept];
        let ends = leases.into_iter().flat_map(|lease| ends(&lease));
        let first = self.period;
        ends.flat_map(|end| [end, end + 1]).chain([first]).filter(move |&period| period >= first)
    }

    /// `before` and `after` of the lemma.
    fn is_invariant(&self, asks: &[FlowRequest], grants: &[FlowGrant]) -> bool {
        let asks = asks.iter().all(|ask| {
            ask.number <= self.asked
                && (ask.number <= self.known || self.granted.flow() <= ask.held + LITTLE)
        });
        let grants = grants.iter().all(|grant| {
            grant.number != self.asked
                || grant.number != self.known
                || is_kept(&grant.lease(), &self.kept, self.period)
        });
        let mut periods = self.periods(self);
        self.held <= self.granted.flow() + LITTLE
            && periods.all(|at| self.granted.lasting(at) <= self.kept.lasting(at) + LITTLE)
            && self.known <= self.asked
            && asks
            && grants
    }

    /// The sender uses no more than is granted, and what was granted before a request is void.
    fn sender_steps(&self, after: &View, asked: &[FlowRequest]) -> bool {
        let limit = asked.first().map_or(f64::INFINITY, |ask| ask.held);
        let left = |period| self.granted.lasting(period).min(limit);
        let is_left = after.periods(self).all(|at| after.granted.lasting(at) == left(at));
        let numbers = match asked {
            [] => after.asked == self.asked,
            [ask] => after.asked == ask.number && ask.number > self.asked && ask.held == after.held,
            _ => false,
        };
        is_left && numbers && after.held <= self.granted.lasting(after.period) + LITTLE
    }

    /// The receiver keeps as much or more, tells what it keeps, and has that to spare.
    fn receiver_steps(&self, after: &View, granted: &[FlowGrant]) -> bool {
        let tells = |grant: &FlowGrant| grant.number == after.known && grant.lease() == after.kept;
        let mut kept =
            after.periods(self).map(|at| (self.kept.lasting(at), after.kept.lasting(at)));
        let is_kept = match granted {
            [] => kept.all(|(before, after)| after == before),
            _ => kept.all(|(before, after)| after >= before),
        };
        let knows = after.known == self.known || after.kept == Lease::default();
        let has_spare = self.spare < 0.0 || after.spare >= -LITTLE;
        granted.iter().all(tells) && is_kept && knows && has_spare
    }

    fn has_same_sender(&self, other: &View) -> bool {
        let sender = |view: &View| (view.held, view.granted, view.asked);
        sender(self) == sender(other)
    }

    fn has_same_receiver(&self, other: &View) -> bool {
        let receiver = |view: &View| (view.kept, view.known);
        receiver(self) == receiver(other)
    }
}

/// Whether a lease holds no more than another one, from this control period on.
fn is_kept(lease: &Lease<f64>, kept: &Lease<f64>, first: u32) -> bool {
    let ahead = ends(lease).into_iter().filter(|&end| end >= first);
    ahead.into_iter().all(|end| lease.lasting(end) <= kept.lasting(end) + LITTLE)
}

/// Whether a step is one of the lemma.
fn is_step(link: &Link, step: Step, next: &Link) -> bool {
    let (before, after) = (link.view(), next.view());
    let (asked, granted) = (&next.asks[link.asks.len()..], &next.grants[link.grants.len()..]);
    let rests = (before.has_same_sender(&after), before.has_same_receiver(&after));
    match step {
        Step::Plan(_) | Step::SenderSettles => before.sender_steps(&after, asked) && rests.1,
        Step::SendOn(_) | Step::ReceiverSettles => {
            before.receiver_steps(&after, granted) && rests.0
        }
        Step::SendBack(_) | Step::FindCircle(_) => rests == (true, true),
        Step::HearAsk(at) => {
            let ask = link.asks[at];
            let is_known = link.receiver.reservation.kept.of(OTHER).is_some();
            let is_new = !is_known || ask.number > before.known;
            let limit = if is_new { ask.held } else { f64::INFINITY };
            let left = |period| before.kept.lasting(period).min(limit);
            let known = if is_new { ask.number } else { before.known };
            let is_left = after.periods(&before).all(|at| after.kept.lasting(at) == left(at));
            is_left && after.known == known && rests.0
        }
        Step::HearGrant(at) => {
            let grant = link.grants[at];
            let counts = grant.number == before.asked;
            let heard = |period| if counts { grant.lease().lasting(period) } else { 0.0 };
            let is_heard = after.periods(&before).all(|at| {
                let granted = before.granted.lasting(at);
                (granted..=granted.max(heard(at))).contains(&after.granted.lasting(at))
            });
            // What tells all that is kept for longer is taken over.
            let told = grant.lease();
            let ahead = ends(&told).into_iter().filter(|&end| end >= after.period);
            let periods = || after.periods(&before).chain(ahead.clone());
            let covers =
                counts && periods().all(|at| told.lasting(at) >= before.granted.lasting(at));
            let is_taken =
                !covers || periods().all(|at| after.granted.lasting(at) == told.lasting(at));
            is_heard
                && is_taken
                && (after.held, after.asked) == (before.held, before.asked)
                && rests.1
        }
        Step::Pass(_) => {
            before.sender_steps(&after, asked) && before.receiver_steps(&after, granted)
        }
    }
}

/// Checks every step within this many from a state. Returns the number of states reached, and of the steps in which a
/// flow rises, in which one falls, and in which one falls of which a part was granted for longer.
fn explore(first: Link, steps: usize) -> [usize; 4] {
    let mut known = BTreeSet::from([first.key()]);
    let (mut layer, mut used, mut ended, mut parts) = (vec![first], 0, 0, 0);
    for _ in 0..steps {
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
                parts += usize::from(after.held < before.held && before.granted.part().is_some());
                if known.insert(next.key()) {
                    next_layer.push(next);
                }
            }
        }
        layer = next_layer;
    }
    [known.len(), used, ended, parts]
}

#[test]
fn every_step_of_a_reservation_is_one_of_the_lemma() {
    let [known, used, ended, _] = explore(Link::new(), DEPTH);
    assert!(known > 1_000 && used > 10 && ended > 0, "{known} states, {used}, {ended}");
    let [known, .., parts] = explore(Link::in_use(), DEPTH - 1);
    assert!(known > 1_000 && parts > 0, "{known} states, {parts}");
}
