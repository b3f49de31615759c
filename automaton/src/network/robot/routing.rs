//! Routing: the dual iteration (13)–(14) or ADAL, then a sweep that makes the routes feasible.
//!
//! In every control period the robot exchanges multipliers and flows with the neighbours that it
//! can send to, a few times. Then the sweep goes up the tree, deepest robots first: each sends
//! what is missing for c_i ≥ η over its tree link, so that the routes are feasible at every t_k
//! whatever the dual iterate is.

use pleach_continuous::network::acceptance::Segment;
use pleach_continuous::network::reliability::LinkReliability;
use pleach_continuous::network::routing::{self, LinkOffer, Share};
use pleach_discrete::network::NodeId;

use super::Robot;

/// Links with less reliability than this carry nothing unless they belong to the tree: a step of
/// both ends must not be able to break a link in use.
const LEAST_USEFUL_RELIABILITY: f64 = 0.3;
/// Share of its time that a robot gives away before the sweep; the rest is kept for the sweep and
/// for motion.
const BUDGET: f64 = 0.9;
/// Shares below this are not used.
const LEAST_SHARE: f64 = 1e-6;

/// λ_i and what an accelerated iteration remembers.
pub(super) type Multiplier = routing::DualState;

/// A link over which the robot may send.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RouteLink {
    /// To whom.
    pub to: NodeId,
    /// R_ij.
    pub reliability: f64,
    /// w_ij.
    pub weight: f64,
    /// λ_j as last heard; 0 for an access point.
    pub multiplier: f64,
    /// T_ij.
    pub share: f64,
}

impl RouteLink {
    /// F_ij = T_ij R_ij.
    pub fn flow(&self) -> f64 {
        self.share * self.reliability
    }
}

/// What a robot sends about its routes: its flows by receiver.
#[derive(Clone, Debug, Default)]
pub struct FlowReport {
    /// F_ij for the links in use.
    pub flows: Vec<(NodeId, f64)>,
}

impl Robot {
    /// Finds the links over which the robot may send from here, keeping what it knows of them.
    pub fn survey_links(&mut self) {
        let old = std::mem::take(&mut self.links);
        let tree = self.tree_links();
        let aversion = self.site.settings.slope_aversion;
        for neighbour in &self.neighbours {
            let to = neighbour.id();
            let reliability = neighbour.reliability;
            let in_tree = tree.iter().any(|link| link.to == to);
            if reliability < LEAST_USEFUL_RELIABILITY && !in_tree || reliability <= 0.0 {
                continue;
            }
            let known = old.iter().find(|link| link.to == to);
            self.links.push(RouteLink {
                to,
                reliability,
                weight: routing::weight(aversion, &self.site.link, neighbour.distance),
                multiplier: known.map_or(0.0, |link| link.multiplier),
                share: 0.0,
            });
        }
    }

    /// λ_i.
    pub fn multiplier(&self) -> f64 {
        self.multiplier.multiplier()
    }

    /// A neighbour tells its multiplier.
    pub fn hear_multiplier(&mut self, from: NodeId, multiplier: f64) {
        if let Ok(at) = self.links.binary_search_by_key(&from, |link| link.to) {
            self.links[at].multiplier = multiplier;
        }
    }

    /// The primal iteration (13): the shares that minimise the local Lagrangian.
    pub fn minimise_locally(&mut self) {
        let offers: Vec<LinkOffer> = self
            .links
            .iter()
            .map(|link| LinkOffer {
                reliability: link.reliability,
                weight: link.weight,
                neighbour_multiplier: link.multiplier,
            })
            .collect();
        let mut shares = Vec::with_capacity(offers.len());
        routing::local_minimiser(self.multiplier(), &offers, BUDGET, &mut shares);
        for (link, share) in self.links.iter_mut().zip(shares) {
            link.share = if share < LEAST_SHARE { 0.0 } else { share };
        }
    }

    /// What the robot sends to each neighbour now.
    pub fn flow_report(&self) -> FlowReport {
        let flows = self.routes().map(|link| (link.to, link.flow())).collect();
        FlowReport { flows }
    }

    /// The links in use.
    pub fn routes(&self) -> impl Iterator<Item = &RouteLink> {
        self.links.iter().filter(|link| link.share > 0.0)
    }

    /// Forgets what it heard of its inflow.
    pub fn clear_inflow(&mut self) {
        self.inflow = 0.0;
        self.inflows.clear();
    }

    /// A neighbour tells its flows.
    pub fn hear_flows(&mut self, from: NodeId, report: &FlowReport) {
        let own = self.id;
        if let Some(&(_, flow)) = report.flows.iter().find(|(to, _)| *to == own) {
            self.inflow += flow;
            self.inflows.push((from, flow));
        }
    }

    fn outflow(&self) -> f64 {
        self.links.iter().map(RouteLink::flow).sum()
    }

    /// The dual iteration (14).
    pub fn step_multiplier(&mut self) {
        let reserve = self.site.settings.routing_reserve;
        let residual = self.outflow() - self.inflow - self.rate;
        let degree: f64 = self.links.iter().map(|link| link.reliability.powi(2)).sum();
        let step = routing::safe_step(1.0, 2.0 * degree);
        self.multiplier.step(step, residual, reserve);
    }

    /// The sweep: sends over the tree link what is missing for c_i ≥ η. Returns the parent and
    /// the flow to it.
    pub fn meet_demand(&mut self) -> Option<(NodeId, f64)> {
        let parent = self.tree_parent()?;
        let tree_link = self.links.iter().position(|link| link.to == parent)?;
        let demand = self.inflow + self.rate + self.site.settings.routing_reserve;
        let mut shares: Vec<Share> = self
            .links
            .iter()
            .map(|link| Share { reliability: link.reliability, share: link.share })
            .collect();
        if self.outflow() < demand {
            routing::meet_demand(demand, &mut shares, tree_link);
            for (link, repaired) in self.links.iter_mut().zip(shares) {
                link.share = repaired.share;
            }
        }
        Some((parent, self.links[tree_link].flow()))
    }

    /// The flow to a neighbour.
    pub fn flow_to(&self, to: NodeId) -> f64 {
        self.links.iter().find(|link| link.to == to).map_or(0.0, RouteLink::flow)
    }

    /// A tree child has raised its flow by so much in the sweep.
    pub fn expect_more(&mut self, flow: f64) {
        self.inflow += flow;
    }

    /// All flows are known: eq. (5).
    pub fn settle_residual(&mut self) {
        self.residual = self.outflow() - self.inflow - self.rate;
    }

    /// The worst load h_i whichever of the proposed moves are carried out.
    pub(super) fn worst_load(&self, own: Segment, move_of: impl Fn(NodeId) -> Segment) -> f64 {
        let receivers: Vec<_> =
            self.routes().map(|link| (link.flow(), move_of(link.to))).collect();
        pleach_continuous::network::acceptance::worst_load(own, &receivers, &self.site.link)
    }

    /// dR/dd of the link to a neighbour at this distance.
    pub(super) fn slope_at(&self, distance: f64) -> f64 {
        self.site.link.slope(distance)
    }
}
