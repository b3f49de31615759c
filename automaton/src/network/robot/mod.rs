//! One robot: its own state, and how it processes the messages that it receives.
//!
//! Everything here is local. A robot has its own position and duty, what every robot has
//! from the beginning ([`Site`]), and the messages of the neighbours that it receives. It is a
//! [`Node`](crate::node::Node): `step` says what it does with each input, stage by stage of a
//! control period.
//!
//! A robot is made of components: each owns its state, in a module of its own, and sees of the others what it is given as
//! arguments, with a read-only `Context` of the step. The fields of [`Robot`] name them. The chapters are
//! about what robots do with several of them, in the order of a control period: a robot receives beacons (`hearing`) and
//! learns who does not take part (`absence`) and where robots of other fleets are (`bodies`), keeps its place
//! in the tree (`attachment`, `confirmation`, `links`), takes part in the mission (`leader`, `recruit`,
//! `path`, `team`), exchanges duties with a robot in its way (`partner`) or makes way
//! (`yielding`), and moves (`way`, `motion`, `judging`);
//! what its guards see of all this are `facts`. What its automata do stands in `duties`, `mission`, `exchange`,
//! `lineage` and `control`, and where it goes in `target`; `step` takes inputs, `rounds` counts rounds, `skipped_work`
//! is what need not be done again, and `view` what observers read.

mod absence;
#[cfg(feature = "abstraction")]
mod abstraction;
mod attachment;
mod bodies;
mod body;
mod confirmation;
mod context;
mod control;
mod duties;
mod duty_cell;
mod exchange;
mod exchanges;
mod facts;
mod hearing;
mod judging;
mod knowledge;
mod leader;
mod lineage;
mod links;
mod mission;
mod motion;
mod navigation;
mod negotiation;
mod neighbours;
mod partner;
mod path;
mod places;
mod primary_team;
mod recruit;
mod reservation;
mod revision;
mod rounds;
mod routing;
mod schedule;
mod skipped_work;
mod step;
mod target;
mod team;
#[cfg(test)]
mod tests;
mod tree_place;
mod view;
mod way;
mod yielding;

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{NodeId, NoticeId, Post, PostId, Role};

#[cfg(feature = "abstraction")]
pub(super) use abstraction::Numbers;
pub use control::{Act, Acts, ControlAutomaton};
pub use duties::{DutyAutomaton, DutyEffect};
pub use exchange::{Exchange, ExchangeAutomaton, ExchangeEffect};
pub use facts::Facts;
pub use lineage::{AttachmentAutomaton, PlaceInTree};
pub use links::TreeLink;
pub use mission::{MissionAutomaton, MissionEffect};
pub use reservation::{FlowGrant, FlowRequest, GrantedPart, Probe, RequestNumber};
pub use routing::RouteLink;
pub use step::{RobotError, RobotFault};
pub use target::Targets;
pub use team::SATURATED;
pub use view::RobotView;

pub(super) use {
    control::control_automaton, duties::duty_automaton, exchange::exchange_automaton,
    lineage::attachment_automaton, mission::mission_automaton, target::targets,
};

use crate::automaton::TransitionError;

use super::ballot::Ballot;
use super::beacon::{Announcement, Beacon, Notice};
use super::duty::{Duty, Held, Standby, Station};
use super::member::NodeOutputs;
use super::membership::Membership;
use super::message::Message;
use super::outbox::Outbox;
use super::record::MissionEvent;
use super::site::Site;
pub(super) use attachment::PATIENCE_WITH_UNUSED_POSTS;
use body::Body;
use context::context;
use duties::Label;
use duty_cell::DutyCell;
use exchanges::Exchanges;
use hearing::Neighbour;
pub(super) use hearing::ROUNDS_TO_BE_HEARD;
use knowledge::Knowledge;
use negotiation::Negotiation;
use neighbours::Neighbours;
use places::places;
use reservation::{Plan, Reservation, lease_of};
use revision::Changes;
use routing::{Receiver, Routing, Survey};
use schedule::Schedule;
use tree_place::TreePlace;

/// Posts that are made during a mission have numbers from here on: higher than those of notices.
const FIRST_NEW_POST: u32 = 1 << 31;
/// More than a robot makes in a control period: it may give one away in an exchange, and need another.
const POSTS_OF_A_PERIOD: u32 = 8;

/// A robot of the network.
#[derive(Clone, Debug)]
#[repr(C, align(64))] // in this order, from the beginning of a cache line: first what each message touches
pub struct Robot {
    /// Where it is.
    body: Body,
    /// The nodes that it receives, and the robots of other fleets near it.
    neighbours: Neighbours,
    /// Who takes part.
    membership: Membership,
    /// What it has from the beginning.
    site: Arc<Site>,
    /// Where it is in its control period.
    schedule: Schedule,
    /// What has changed since it last derived something, and what its guards saw last.
    changes: Changes,
    id: NodeId,
    /// What it sends of itself.
    outbox: Outbox,
    /// Which flows it plans.
    routing: Routing,
    /// Which flows are in use.
    reservation: Reservation,
    /// What it does.
    duty: DutyCell,
    /// What it knows of the mission and of the primary team.
    mission: Knowledge,
    /// The exchange of duties that it is engaged in.
    exchanges: Exchanges,
    /// Its place in the tree.
    tree: TreePlace,
    /// The election and the agreement that it takes part in.
    ballot: Ballot,
    /// Where it goes, which moves are proposed, and who consents.
    negotiation: Negotiation,
}

impl Robot {
    /// A robot at the start of a mission: redundant, alone, at rest.
    pub fn new(id: NodeId, position: Point, rate: f64, site: Arc<Site>) -> Self {
        let post = Post::redundant(PostId(id as u32));
        let station = Station { post, reference: position };
        Robot {
            body: Body::at(position, site.settings.period),
            neighbours: Neighbours::default(),
            membership: Membership::default(),
            schedule: Schedule::default(),
            changes: Changes::default(),
            id,
            outbox: Outbox::default(),
            routing: Routing::new(site.settings.routing_method, rate),
            reservation: Reservation::default(),
            duty: DutyCell::new(Duty::Standby(Standby(Held { station, left: None }))),
            mission: Knowledge::default(),
            exchanges: Exchanges::default(),
            tree: TreePlace::alone(id),
            ballot: Ballot::default(),
            negotiation: Negotiation::default(),
            site,
        }
    }

    /// Another node has begun a control period that this robot has not.
    fn hear_of_later_period(&mut self, period: u32) {
        if let Some(period) = self.schedule.receive_later_period(period) {
            self.begin_late(period);
        }
    }

    /// It begins later than others. If it has begun before, it has made at most an offer in each period.
    fn begin_late(&mut self, period: u32) {
        self.exchanges.forget_offers(if period > 1 { period } else { 0 });
        self.join_in(period);
    }

    /// Resets the robot as if it had just restarted. It keeps its number, its place in the control period and the
    /// roll.
    pub(super) fn begin_again(&mut self) -> Result<(), TransitionError> {
        let role = self.role();
        let (site, place) = (Arc::clone(&self.site), self.body.position());
        let fresh = Robot::new(self.id, place, self.routing.rate(), site);
        let known = std::mem::replace(self, fresh);
        self.exchanges.forget_offers(known.offers().offers_made());
        let period = known.schedule.period();
        self.schedule = known.schedule.begun_again();
        self.body = Body::at(known.body.position(), known.body.clock());
        self.duty.make_posts(known.duty.posts_made());
        self.membership = known.membership.begun_again();
        self.outbox = known.outbox.begun_again();
        self.join_in(period);
        self.report_role_after(role);
        self.jump_duty(Label::Alone).map(drop)
    }

    fn join_in(&mut self, period: u32) {
        self.schedule.join(period);
        if period > 1 {
            self.duty.join_late();
            self.membership.join_in(period);
            self.changes.allow_jump();
            self.note_change();
        }
    }

    /// The post of a redundant robot that no robot has ever had.
    pub(super) fn new_post(&self) -> Post {
        let made = self
            .schedule
            .period()
            .wrapping_mul(POSTS_OF_A_PERIOD)
            .wrapping_add(self.duty.posts_made());
        let number = made.wrapping_mul(self.site.robots as u32).wrapping_add(self.id as u32);
        Post::redundant(PostId(FIRST_NEW_POST | number))
    }

    /// Tells its public state. One that stays the same is told in as many rounds of a period as it
    /// takes to be heard if some are lost, and then no more.
    fn tell_beacon(&mut self, outputs: &mut NodeOutputs) {
        let beacon = self.next_beacon();
        if self.outbox.takes_beacon() {
            let (period, roll) = (self.schedule.period(), self.membership.roll().clone());
            let confirmed = self.pass_on_confirmation();
            outputs.broadcast(Message::Beacon { period, roll, confirmed, beacon });
        }
    }

    /// The beacon that the robot sends now: the very same as before unless something
    /// in it has changed.
    fn next_beacon(&mut self) -> Arc<Beacon> {
        if !self.changes.compare()
            && self.caches()
            && let Some(beacon) = self.outbox.beacon()
        {
            let is_right = |robot: &Self| *beacon == robot.public_state();
            debug_assert!(self.may_skip(is_right), "robot {} tells old news", self.id);
            return beacon;
        }
        let (beacon, is_new) = self.outbox.renew_beacon(self.public_state());
        if is_new {
            self.note_change();
        }
        beacon
    }

    fn public_state(&self) -> Beacon {
        let [below, strays, serves] = self.tree.reports();
        Beacon {
            sender: self.id,
            position: self.body.position(),
            bulletin: self.mission.notices().bulletin().clone(),
            announced: self.mission.notices().announced().cloned(),
            forgetful: Arc::clone(self.mission.notices().forgetful()),
            election: self.ballot.election().cloned(),
            agreement: self.ballot.agreement().cloned(),
            route: self.ballot.route().cloned(),
            crossing: Vec::new(),
            lineage: self.lineage().cloned(),
            parent: self.tree.parent(),
            below: Arc::clone(below),
            strays: Arc::clone(strays),
            serves: Arc::clone(serves),
            closed: Arc::clone(self.mission.notices().closed()),
            duty: Some(*self.duty),
            parked: self.is_parked(),
            way: self.way_asked_for(),
            can_detach: self.tree.can_detach(),
            offer: self.offers().offer().cloned(),
            offers_made: self.offers().offers_made(),
            reply: self.offers().reply().cloned(),
            team: self.mission.team().report(),
            stretched: self.mission.notices().is_stretched(),
            longest_wait: self.longest_wait(),
            wrecks: Arc::clone(self.membership.wrecks()),
            branches: Arc::clone(self.tree.branches()),
        }
    }

    /// The role that its duty gives it.
    pub(super) fn role(&self) -> Role {
        self.duty.role()
    }

    /// The newest notice on the mission that it knows.
    pub(super) fn notice(&self) -> &Notice {
        self.mission.notices().bulletin().notice()
    }

    /// The identity of the newest notice on the mission that it knows.
    pub(super) fn notice_id(&self) -> NoticeId {
        self.mission.notices().bulletin().id()
    }

    /// The announcement that it goes by.
    pub(super) fn announcement(&self) -> Option<&Announcement> {
        self.mission.notices().announcement()
    }

    /// The task announced last, as far as it knows.
    pub(super) fn current_task(&self) -> Option<usize> {
        self.announcement().map(|announcement| announcement.task)
    }

    /// A control period begins: what is looked at once a period.
    fn begin_period(&mut self) -> Result<(), TransitionError> {
        self.outbox.send_beacon_again();
        let counted = |robot: &Self| {
            (robot.tree.unused_periods(), robot.tree.orphaned_periods(), robot.exchanges.partner())
        };
        let before = counted(self);
        self.count_unused_periods();
        self.count_orphaned_periods();
        self.consider_exchange();
        if counted(self) == before && self.is_undisturbed() {
            // Nobody is gone, so that no partner in an exchange is.
            return Ok(());
        }
        self.note_change();
        self.advance_exchange()
    }

    /// After each round of messages: the robot processes what it has received.
    ///
    /// The result depends only on what the robot receives and on its own state. Where
    /// neither has changed, and no wait is over, there is nothing to do.
    fn deliberate(&mut self) -> Result<(), TransitionError> {
        let is_due = self.count_round();
        self.process_news(is_due)
    }

    /// Processes what it has received if that contains news, or if it is due anyway.
    fn process_news(&mut self, is_due: bool) -> Result<(), TransitionError> {
        if !self.changes.are_news() && !is_due && self.caches() {
            #[cfg(feature = "abstraction")]
            debug_assert_eq!(
                context!(self).verifies().then(|| self.overlooked()).flatten(),
                None,
                "robot {} overlooks something",
                self.id
            );
            return Ok(());
        }
        self.process_messages()
    }

    /// Processes what it has received, whether or not it contains news.
    fn process_messages(&mut self) -> Result<(), TransitionError> {
        self.changes.process();
        self.advance_exchange()?;
        self.locate_wrecks();
        self.locate_branches();
        self.note_follower();
        self.keep_place()?;
        self.hear_notices();
        self.remember_parent();
        Ok(())
    }

    /// Takes at most one transition of the mission automaton, together with the duty automaton if
    /// that has a transition for it, or else one of the duty automaton alone; returns whether it did.
    /// One that joins a mission under way takes a new post before anything else.
    fn jump_once(&mut self) -> Result<bool, TransitionError> {
        let role = self.role();
        let jumped = self.duty.is_late() && self.jump_duty(Label::Alone)?.is_some()
            || self.jump_mission()?
            || self.jump_duty(Label::Alone)?.is_some();
        if jumped {
            self.changes.allow_jump();
            self.note_change();
        }
        self.report_role_after(role);
        Ok(jumped)
    }

    /// The robot's own state, or what it has received, has changed: it has to deliberate, to compare its beacon, to measure
    /// its facts and to find its links.
    fn note_change(&mut self) {
        self.changes.note();
    }

    /// A control period's routes begin: with the links over which the robot may send from here, and with what the routing
    /// method made of them in the period before. Links that have been found stand until something changes.
    fn survey_links(&mut self) {
        if self.caches() && self.routing.has_links_of(self.changes.revision()) {
            let is_right =
                |robot: &Self| robot.routing.would_find(context!(robot), &robot.survey());
            debug_assert!(self.may_skip(is_right), "robot {}: old links", self.id);
        } else {
            let survey = self.survey();
            self.routing.find_links(context!(self), &survey, self.changes.revision());
            let Robot { routing, reservation, .. } = self;
            reservation.drop_flows_without_link(|node| routing.has_link_to(node));
        }
        self.routing.begin_period();
    }

    /// The neighbours to which there may be links, and the parent, as they are now.
    fn survey(&self) -> Survey {
        let tree = self.tree_links();
        let receiver = |neighbour: &Neighbour| Receiver {
            node: neighbour.id(),
            distance: neighbour.distance,
            reliability: neighbour.reliability,
            in_tree: tree.iter().any(|link| link.to == neighbour.id()),
            has_flow: self.reservation.sends_to(neighbour.id()),
        };
        let receivers = self.neighbours.iter().map(receiver).collect();
        Survey { parent: self.tree_parent(), receivers }
    }

    /// The plan of the period stands: the robot asks for its flows.
    fn ask_for_flows(&mut self, outputs: &mut NodeOutputs) {
        let (lease, places) = (lease_of(self.longest_wait()), places!(self));
        let plans = self.routing.links().iter().map(|link| Plan {
            to: link.to,
            reliability: link.reliability,
            flow: link.flow(),
        });
        self.reservation.ask_for_flows(context!(self), plans, &places, lease, outputs);
    }

    /// Takes in the requests and grants of the round.
    fn take_in_requests(&mut self, outputs: &mut NodeOutputs) {
        let lease = lease_of(self.longest_wait());
        self.reservation.take_in_requests(context!(self), lease, outputs);
    }

    /// The routes of the period stand. That they do not carry the rates is reported when it begins.
    fn end_routes(&mut self) {
        let (flows, context) = (&self.reservation, context!(self));
        if self.routing.adopt(context, flows.loads(), flows.outflow(), flows.granted()) {
            self.report(MissionEvent::RouteInfeasible { robot: self.id });
        }
    }

    /// A control period begins or ends: its state has changed with that, unless nothing depends on it.
    fn note_period_boundary(&mut self) {
        if !self.is_undisturbed() {
            self.note_change();
        }
    }

    fn report(&mut self, event: MissionEvent) {
        self.outbox.report(event);
    }

    /// ρ + e + m: the clearance that the robot keeps by what it knows.
    fn clearance(&self) -> f64 {
        self.site.settings.planning_clearance()
    }

    /// 2e + m: how far from the end of a move the robot may measure itself.
    fn stray(&self) -> f64 {
        self.site.settings.errors.stray()
    }
}
