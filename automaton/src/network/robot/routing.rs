//! Routing: the dual iteration (13)–(14) or ADAL, then a sweep that makes the routes feasible.
//!
//! In every control period the robot exchanges multipliers and flows with the neighbours that it
//! can send to, a few times. Then the sweep goes up the tree, deepest robots first: each sends
//! what is missing for c_i ≥ η over its tree link, so that the routes are feasible at every t_k
//! whatever the dual iterate is.

use pleach_continuous::network::acceptance::{Capsule, worst_load_within};
use pleach_continuous::network::reliability::LinkReliability;
use pleach_continuous::network::routing::adal::{
    AdalLink, AdalRobot, AdalSettings, NeighbourReport, Workspace,
};
use pleach_continuous::network::routing::dual::{DualState, LinkCurvature, dual_step, safe_step};
use pleach_continuous::network::routing::local::{
    LinkOffer, local_minimiser, positive_part, weight,
};
use pleach_continuous::network::routing::repair::{Share, meet_demand};
use pleach_discrete::network::NodeId;

use super::Robot;
use super::hearing::Neighbour;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;
use crate::network::record::MissionEvent;
use crate::network::scenario::RoutingMethod;

/// Links with less reliability than this carry nothing unless they belong to the tree: a step of
/// both ends must not be able to break a link in use.
const LEAST_USEFUL_RELIABILITY: f64 = 0.3;
/// Share of its time that a robot gives away before the sweep; the rest is kept for the sweep and
/// for motion.
const BUDGET: f64 = 0.9;
/// What is taken off every share that the routing method gives, so that one below it is not used: a soft threshold. A hard
/// one would let a share jump between nothing and this much, and the iteration would not come to rest.
const SOFT_THRESHOLD: f64 = 1e-6;
/// Residuals are sums of a few flows; this much of them is rounding.
pub(super) const RESIDUAL_ROUNDING: f64 = 1e-9;

/// What a robot carries from one iteration of its routing method to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum RoutingState {
    /// λ_i, with momentum where the iteration is accelerated.
    Dual(DualState),
    /// λ_i, the mismatch and the slack of ADAL.
    Adal(AdalRobot),
}

impl RoutingState {
    /// The state at the start of a mission.
    pub fn new(method: RoutingMethod) -> Self {
        match method {
            RoutingMethod::Dual | RoutingMethod::AcceleratedDual => {
                RoutingState::Dual(DualState::default())
            }
            RoutingMethod::Adal => RoutingState::Adal(AdalRobot::default()),
        }
    }
}

/// A link over which the robot may send.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RouteLink {
    /// The receiver.
    pub to: NodeId,
    /// R_ij.
    pub reliability: f64,
    /// T_ij.
    pub share: f64,
    /// T_ij as the routing method left it, before the sweep.
    iterate: f64,
    /// F_ij of the plan as the receiver has been told in this period.
    told: f64,
    /// Whether it is too unreliable to be planned with, and stays only until its flow has ended.
    pub(super) is_retiring: bool,
}

/// What the shares of a link are chosen by, beside its reliability. It stands apart from the link, as most rounds of a
/// control period have no use for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LinkTerms {
    /// The receiver.
    to: NodeId,
    /// w_ij.
    weight: f64,
    /// How the receiver last reported its equation to stand; none for an access point.
    report: Option<NeighbourReport>,
}

impl RouteLink {
    /// F_ij = T_ij R_ij.
    pub fn flow(&self) -> f64 {
        self.share * self.reliability
    }

    /// A control period begins: nothing is told, and shares are as the routing method left them.
    fn begin_period(&mut self) {
        // Most are so, and what is not written is not copied between memory and cache.
        if (self.share, self.told) != (self.iterate, 0.0) {
            (self.share, self.told) = (self.iterate, 0.0);
        }
    }

    /// What is used of a share that the routing method gives it.
    fn usable(&self, share: f64) -> f64 {
        if self.is_retiring { 0.0 } else { positive_part(share - SOFT_THRESHOLD) }
    }
}

/// Where the link to `node` is among links, which are in the order of their receivers.
pub(super) fn link_at(links: &[RouteLink], node: NodeId) -> Option<usize> {
    links.binary_search_by_key(&node, |link| link.to).ok()
}

impl Robot {
    /// A control period's routes begin: with the links over which the robot may send from here, and with what the routing
    /// method made of them in the period before. Links that have been found stand until something changes.
    pub(super) fn survey_links(&mut self) {
        if self.links_stand && self.caches() {
            debug_assert!(self.may_skip(Self::are_links_found), "robot {}: old links", self.id);
            self.links.iter_mut().for_each(RouteLink::begin_period);
        } else {
            (self.links, self.link_terms) = self.find_links();
            self.upstream = self.tree_parent();
            self.drop_flows_without_link();
            self.dual_step_size = self.safe_dual_step();
            // One that is retiring goes with its flow.
            self.links_stand = !self.links.iter().any(|link| link.is_retiring);
        }
        (self.has_no_reserve, self.has_shortage_news) = (false, false);
        (self.has_untold_flows, self.is_unsettled) = (true, true);
        (self.told_report, self.has_come_to_rest) = (None, false);
        self.expected_link = 0;
        self.inflow = 0.0;
        self.inflows.clear();
        self.demands.clear();
    }

    /// The links over which the robot may send from here, with what it knows of them.
    fn find_links(&self) -> (Vec<RouteLink>, Vec<LinkTerms>) {
        let tree = self.tree_links();
        let aversion = self.site.settings.slope_aversion;
        let link_to = |neighbour: &Neighbour| {
            let (to, reliability) = (neighbour.id(), neighbour.reliability);
            let in_tree = tree.iter().any(|link| link.to == to);
            let at_worst = self.site.link.reliability(neighbour.distance + 2.0 * self.stray());
            let is_retiring = at_worst < LEAST_USEFUL_RELIABILITY && !in_tree;
            if is_retiring && !self.sends_to(to) || reliability <= 0.0 {
                return None;
            }
            let known = link_at(&self.links, to);
            let kept = known.filter(|_| !is_retiring);
            let iterate = kept.map_or(0.0, |at| self.links[at].iterate);
            let (share, told) = (iterate, 0.0);
            let weight = weight(aversion, &self.site.link, neighbour.distance);
            let report = known.and_then(|at| self.link_terms[at].report);
            let link = RouteLink { to, reliability, share, iterate, told, is_retiring };
            Some((link, LinkTerms { to, weight, report }))
        };
        self.neighbours.iter().filter_map(link_to).collect()
    }

    /// Whether it would find the links that it has, and the parent to which it sends its demand.
    fn are_links_found(&self) -> bool {
        let mut links = self.links.clone();
        links.iter_mut().for_each(RouteLink::begin_period);
        let found = self.find_links();
        (links, &self.link_terms) == (found.0, &found.1) && self.upstream == self.tree_parent()
    }

    /// λ_i.
    pub(super) fn multiplier(&self) -> f64 {
        match &self.routing {
            RoutingState::Dual(state) => state.multiplier(),
            RoutingState::Adal(state) => state.multiplier(),
        }
    }

    /// The flows of the period before are known over the links as they are now.
    pub(super) fn begin_routing(&mut self) {
        self.add_up_inflow();
        let (residual, reserve) = (self.balance(), self.site.settings.routing_reserve);
        let robots = self.site.robots;
        if let RoutingState::Adal(state) = &mut self.routing {
            let between_robots =
                self.links.iter().filter(|link| link.to < robots).map(|link| link.reliability);
            state.measure(residual, reserve, between_robots);
        }
    }

    /// Says how its equation c_i ≥ η stands: in the first iteration of a period, and whenever that has changed.
    pub(super) fn tell_multiplier(&mut self, outputs: &mut NodeOutputs) {
        let report = match &self.routing {
            RoutingState::Adal(state) => state.report(),
            RoutingState::Dual(state) => {
                NeighbourReport { multiplier: state.multiplier(), mismatch: 0.0, crowding: 1.0 }
            }
        };
        if self.told_report.replace(report) != Some(report) {
            outputs.broadcast(Message::Multiplier { report, parent: self.upstream });
        }
    }

    /// A neighbour reports how its equation stands, and where its demand will go.
    pub(super) fn hear_multiplier(
        &mut self,
        from: NodeId,
        report: NeighbourReport,
        parent: Option<NodeId>,
    ) {
        if let Some(terms) = self.terms_of(from)
            && terms.report != Some(report)
        {
            terms.report = Some(report);
            self.has_new_multipliers = true;
        }
        if parent == Some(self.id)
            && let Err(at) = self.demands.binary_search_by_key(&from, |&(child, _)| child)
        {
            self.demands.insert(at, (from, None));
        }
    }

    /// The terms of the link over which the robot may send to `node`. Multipliers of an iteration mostly come in the
    /// order of their senders.
    fn terms_of(&mut self, node: NodeId) -> Option<&mut LinkTerms> {
        let (table, at) = (&mut self.link_terms, self.expected_link);
        let follows = at.checked_sub(1).and_then(|last| table.get(last));
        let comes_next = follows.is_none_or(|last| last.to < node)
            && table.get(at).is_none_or(|next| node <= next.to);
        if !comes_next {
            self.expected_link = table.partition_point(|it| it.to < node);
        }
        let terms = table.get_mut(self.expected_link).filter(|it| it.to == node)?;
        self.expected_link += 1;
        Some(terms)
    }

    /// The primal iteration (13), or that of ADAL. Shares that minimise the local Lagrangian do so until a multiplier
    /// changes.
    pub(super) fn primal_step(&mut self) {
        let has_new_multipliers = std::mem::take(&mut self.has_new_multipliers);
        match self.routing {
            RoutingState::Dual(_)
                if !has_new_multipliers && !self.has_untold_flows && self.caches() =>
            {
                debug_assert!(self.may_skip(Self::shares_stand), "robot {}: old shares", self.id);
                return;
            }
            RoutingState::Dual(_) => self.minimise_locally(),
            RoutingState::Adal(state) => self.approach_minimiser(state),
        }
        for link in &mut self.links {
            link.share = link.usable(link.share);
            link.iterate = link.share;
        }
        self.has_untold_flows = true;
    }

    fn links_with_terms(&self) -> impl Iterator<Item = (&RouteLink, &LinkTerms)> {
        self.links.iter().zip(&self.link_terms)
    }

    fn minimise_locally(&mut self) {
        let shares = self.minimiser();
        for (link, share) in self.links.iter_mut().zip(shares) {
            link.share = share;
        }
    }

    /// The shares that minimise the local Lagrangian, eq. (13).
    fn minimiser(&self) -> Vec<f64> {
        let offers: Vec<LinkOffer> = self
            .links_with_terms()
            .map(|(link, terms)| LinkOffer {
                reliability: link.reliability,
                weight: terms.weight,
                neighbour_multiplier: terms.report.map_or(0.0, |report| report.multiplier),
            })
            .collect();
        let mut shares = Vec::with_capacity(offers.len());
        local_minimiser(self.multiplier(), &offers, BUDGET, &mut shares);
        shares
    }

    /// Whether its shares are those that it would choose now.
    fn shares_stand(&self) -> bool {
        let mut chosen = self.links.iter().zip(self.minimiser());
        chosen.all(|(link, share)| link.usable(share).to_bits() == link.share.to_bits())
    }

    /// Part of the way to the shares that minimise the local augmented Lagrangian.
    fn approach_minimiser(&mut self, mut state: AdalRobot) {
        let mut links: Vec<AdalLink> = self
            .links_with_terms()
            .map(|(link, terms)| AdalLink {
                reliability: link.reliability,
                weight: terms.weight,
                share: link.share,
                report: terms.report,
            })
            .collect();
        state.primal_step(&mut links, &AdalSettings::default(), &mut Workspace::default());
        for (link, moved) in self.links.iter_mut().zip(links) {
            link.share = moved.share;
        }
        self.routing = RoutingState::Adal(state);
    }

    /// The links in use.
    pub(super) fn routes(&self) -> impl Iterator<Item = &RouteLink> {
        self.links.iter().filter(|link| link.share > 0.0)
    }

    /// h_i = Σ_j T_ij: the share of its time for which it sends.
    pub(super) fn load(&self) -> f64 {
        self.routes().map(|link| link.share).sum()
    }

    /// Tells its flows to their receivers, where they have changed.
    pub(super) fn tell_flows(&mut self, outputs: &mut NodeOutputs) {
        if !std::mem::take(&mut self.has_untold_flows) {
            return;
        }
        self.is_unsettled = true;
        let robots = self.site.robots;
        for link in self.links.iter_mut().filter(|link| link.to < robots) {
            let flow = link.flow();
            if flow != link.told {
                link.told = flow;
                outputs.send(link.to, Message::Flow(flow));
            }
        }
        self.told_outflow = self.outflow();
    }

    /// A neighbour tells the flow that it sends to this robot.
    pub(super) fn hear_flow(&mut self, from: NodeId, flow: f64) {
        (self.is_unsettled, self.has_come_to_rest) = (true, false);
        match self.inflows.binary_search_by_key(&from, |&(sender, _)| sender) {
            Ok(at) if flow > 0.0 => self.inflows[at].1 = flow,
            Ok(at) => {
                self.inflows.remove(at);
            }
            Err(at) if flow > 0.0 => self.inflows.insert(at, (from, flow)),
            Err(_) => {}
        }
    }

    /// What flows in, as far as the senders have told.
    fn add_up_inflow(&mut self) {
        self.inflow = self.inflows.iter().map(|(_, flow)| flow).sum();
    }

    pub(super) fn outflow(&self) -> f64 {
        self.links.iter().map(RouteLink::flow).sum()
    }

    /// What flows out. Where its flows are those that it has told, it need not look at its links.
    fn known_outflow(&self) -> f64 {
        if self.has_untold_flows || !self.caches() {
            return self.outflow();
        }
        debug_assert!(self.may_skip(Self::outflow_stands), "robot {} overlooks its flows", self.id);
        self.told_outflow
    }

    /// out − in − r with the flows known now.
    fn balance(&self) -> f64 {
        self.known_outflow() - self.inflow - self.rate
    }

    /// The dual iteration (14), or that of ADAL.
    pub(super) fn dual_step(&mut self) {
        self.add_up_inflow();
        let residual = self.balance();
        let (step, reserve) = (self.dual_step_size, self.site.settings.routing_reserve);
        let (before, multiplier) = (self.routing, self.multiplier());
        match &mut self.routing {
            RoutingState::Adal(state) => {
                state.dual_step(residual, reserve, &AdalSettings::default())
            }
            RoutingState::Dual(state) => {
                *state = match self.site.settings.routing_method {
                    RoutingMethod::Dual => {
                        DualState::new(dual_step(state.multiplier(), step, residual, reserve))
                    }
                    RoutingMethod::AcceleratedDual | RoutingMethod::Adal => {
                        state.step(step, residual, reserve)
                    }
                };
            }
        }
        self.has_new_multipliers |= self.multiplier() != multiplier;
        self.has_come_to_rest = self.routing == before && matches!(before, RoutingState::Dual(_));
    }

    /// Whether further iterations change nothing, as long as it hears nothing new.
    pub(super) fn shares_rest(&self) -> bool {
        self.has_come_to_rest && !self.has_new_multipliers && !self.has_untold_flows
    }

    /// ε of (14), from the links that meet in this robot's equation.
    pub(super) fn safe_dual_step(&self) -> f64 {
        let robots = self.site.robots;
        safe_step(self.links_with_terms().map(|(link, terms)| LinkCurvature {
            reliability: link.reliability,
            weight: terms.weight,
            to_access_point: link.to >= robots,
        }))
    }

    /// The sweep begins at the robots that no other sends its demand to.
    pub(super) fn begin_sweep(&mut self, outputs: &mut NodeOutputs) {
        (self.has_swept, self.demands_passed_on) = (false, 0);
        if self.demands.is_empty() {
            self.pass_demand_on(true, outputs);
        }
    }

    /// A tree child tells by how much its flow changes. In the first sweep of a period the robot
    /// waits for all of them, so that one message goes over each link; later ones begin where there
    /// is news, and every message is passed on.
    pub(super) fn hear_demand(&mut self, from: NodeId, more: f64, outputs: &mut NodeOutputs) {
        if self.has_swept {
            self.inflow += more;
            self.pass_demand_on(false, outputs);
            return;
        }
        match self.demands.binary_search_by_key(&from, |&(child, _)| child) {
            Ok(at) => self.demands[at].1 = Some(more),
            Err(at) => self.demands.insert(at, (from, Some(more))),
        }
        if self.demands.iter().all(|(_, heard)| heard.is_some()) {
            self.take_demands();
            self.pass_demand_on(true, outputs);
        }
    }

    fn take_demands(&mut self) {
        self.demands.iter().filter_map(|&(_, more)| more).for_each(|more| self.inflow += more);
    }

    /// Passes on what it does not carry itself. In a tree that takes no more messages than there are
    /// robots; where robots on Σ stand in for others, each as it last heard, their demands can go round
    /// in a cycle, and end there.
    fn pass_demand_on(&mut self, is_first: bool, outputs: &mut NodeOutputs) {
        self.has_swept = true;
        let more = self.meet_demand(is_first);
        if let Some(parent) = self.upstream
            && parent < self.site.robots
            && (is_first || more != 0.0)
            && self.demands_passed_on < self.site.robots
        {
            self.demands_passed_on += 1;
            outputs.send(parent, Message::Demand(more));
        }
    }

    /// The sweep is over: a robot that is still waiting meets the demand that it has heard.
    pub(super) fn end_sweep(&mut self) {
        if !std::mem::replace(&mut self.has_swept, true) {
            self.take_demands();
            self.meet_demand(true);
        }
    }

    /// A further sweep begins where shortages have changed something.
    pub(super) fn sweep_again(&mut self, outputs: &mut NodeOutputs) {
        self.demands_passed_on = 0;
        if !self.has_shortage_news && !self.is_unsettled {
            return;
        }
        let before = self.inflow;
        self.add_up_inflow();
        if std::mem::take(&mut self.has_shortage_news) || self.inflow != before {
            self.pass_demand_on(false, outputs);
        }
    }

    /// Sends what c_i = η takes. What is missing goes over the tree link; in the first sweep, what
    /// is too much, because the iteration has not converged, is taken off all links alike, so that
    /// no robot is asked to pass on what is not there. Returns by how much the flow to the parent
    /// has changed.
    fn meet_demand(&mut self, is_first: bool) -> f64 {
        let Some(parent) = self.upstream else { return 0.0 };
        let Some(tree_link) = self.links.iter().position(|link| link.to == parent) else {
            return 0.0;
        };
        let before = self.links[tree_link].flow();
        // Less than nothing seems to flow in where a sender has less to send than before, and what it sent is not known.
        let demand = (self.inflow + self.rate + self.reserve()).max(0.0);
        let outflow = self.outflow();
        if outflow > demand && (is_first || self.has_no_reserve) {
            self.links.iter_mut().for_each(|link| link.share *= demand / outflow);
        } else if demand - outflow > RESIDUAL_ROUNDING {
            self.raise_outflow(demand, tree_link);
        } else {
            return 0.0;
        }
        self.has_untold_flows = true;
        self.links[tree_link].flow() - before
    }

    fn raise_outflow(&mut self, demand: f64, tree_link: usize) {
        let mut shares: Vec<Share> = self
            .links
            .iter()
            .map(|link| Share { reliability: link.reliability, share: link.share })
            .collect();
        meet_demand(demand, &mut shares, tree_link);
        for (link, repaired) in self.links.iter_mut().zip(shares) {
            link.share = repaired.share;
        }
    }

    /// This robot may find that it cannot pass on what it is sent: it does without its reserve,
    /// and reports that once in a period.
    pub(super) fn admit_shortage(&mut self, outputs: &mut NodeOutputs) {
        if self.is_infeasible() {
            self.give_up_reserve(outputs);
        }
    }

    /// A neighbour cannot pass on what it is sent. A robot whose parent it is does without its
    /// reserve from now on, and so must those behind; every other sends it nothing more.
    pub(super) fn hear_shortage(&mut self, overloaded: NodeId, outputs: &mut NodeOutputs) {
        if self.upstream == Some(overloaded) {
            self.give_up_reserve(outputs);
        } else if let Some(at) = link_at(&self.links, overloaded) {
            let had_share = self.links[at].share > 0.0;
            self.has_shortage_news |= had_share;
            self.has_untold_flows |= had_share;
            self.links[at].share = 0.0;
        }
    }

    fn give_up_reserve(&mut self, outputs: &mut NodeOutputs) {
        if !std::mem::replace(&mut self.has_no_reserve, true) {
            self.has_shortage_news = true;
            outputs.broadcast(Message::Shortage);
        }
    }

    /// η, or nothing when the tree can carry no more than the rates.
    fn reserve(&self) -> f64 {
        if self.has_no_reserve { 0.0 } else { self.site.settings.routing_reserve }
    }

    /// Whether the routes cannot carry the rates: c_i < −c_min.
    pub(super) fn is_infeasible(&self) -> bool {
        self.residual < -self.site.settings.residual_tolerance - RESIDUAL_ROUNDING
    }

    /// All flows are known: eq. (5).
    pub(super) fn settle_residual(&mut self) {
        if std::mem::take(&mut self.is_unsettled) || !self.caches() {
            self.add_up_inflow();
            self.residual = self.balance();
        }
    }

    /// Whether the robot has taken part in the first sweep, and has heard nothing since that changes
    /// its flows.
    pub(super) fn routes_stand(&self) -> bool {
        let has_news = self.has_shortage_news || self.has_untold_flows || self.is_unsettled;
        self.has_swept && !has_news && (self.has_no_reserve || !self.is_infeasible())
    }

    /// The routes of the period stand. That they do not carry the rates is told when it begins.
    pub(super) fn end_routes(&mut self) {
        self.adopt_flows();
        let falls_short = self.is_infeasible();
        if falls_short && !self.routes_fall_short {
            self.report(MissionEvent::RouteInfeasible { robot: self.id });
        }
        self.routes_fall_short = falls_short;
    }

    /// The worst load h_i whichever of the proposed moves are carried out, and wherever robots measure
    /// themselves then.
    pub(super) fn worst_load(&self, own: Capsule, move_of: impl Fn(NodeId) -> Capsule) -> f64 {
        let receivers: Vec<_> = self.routes().map(|link| (link.flow(), move_of(link.to))).collect();
        worst_load_within(own, &receivers, &self.site.link)
    }

    /// dR/dd of the link to a neighbour at this distance.
    pub(super) fn slope_at(&self, distance: f64) -> f64 {
        self.site.link.slope(distance)
    }
}
