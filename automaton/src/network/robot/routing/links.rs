//! The links over which a robot may send, and the shares of its time that it gives them.

use pleach_continuous::network::reliability::LinkReliability;
use pleach_continuous::network::routing::adal::{AdalLink, NeighbourReport};
use pleach_continuous::network::routing::dual::{LinkCurvature, safe_step};
use pleach_continuous::network::routing::local::{LinkOffer, positive_part, weight};
use pleach_continuous::network::routing::repair::{Share, meet_demand};
use pleach_discrete::network::NodeId;

use super::super::context::Context;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;

/// Links with less reliability than this carry nothing unless they belong to the tree: a step of
/// both ends must not be able to break a link in use.
const LEAST_USEFUL_RELIABILITY: f64 = 0.3;
/// What is taken off every share that the routing method gives, so that one below it is not used: a soft threshold. A hard
/// one would let a share jump between nothing and this much, and the iteration would not come to rest.
const SOFT_THRESHOLD: f64 = 1e-6;

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
    /// F_ij of the plan as it was sent to the receiver in this period.
    sent: f64,
    /// Whether it is too unreliable to be planned with, and stays only until its flow has ended.
    is_retiring: bool,
}

/// What the shares of a link are chosen by, beside its reliability. It is stored apart from the link, as most rounds of a
/// control period have no use for it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LinkTerms {
    /// The receiver.
    to: NodeId,
    /// w_ij.
    weight: f64,
    /// How the receiver last reported its equation; none for an access point.
    report: Option<NeighbourReport>,
}

/// A neighbour to which the robot may have a link.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Receiver {
    pub node: NodeId,
    pub distance: f64,
    /// R_ij.
    pub reliability: f64,
    /// Whether a link of the tree leads to it.
    pub in_tree: bool,
    /// Whether packets flow to it.
    pub has_flow: bool,
}

/// The links of a robot, in the order of their receivers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Links {
    table: Vec<RouteLink>,
    terms: Vec<LinkTerms>,
    /// The link from whose receiver the next report is expected.
    expected: usize,
    /// Whether shares have changed since their flows were sent.
    has_unsent: bool,
    /// Σ_j F_ij as it was sent last.
    sent_outflow: f64,
}

impl RouteLink {
    /// F_ij = T_ij R_ij.
    pub fn flow(&self) -> f64 {
        self.share * self.reliability
    }

    /// A control period begins: nothing has been sent, and shares are as the routing method left them.
    fn begin_period(&mut self) {
        // Most are so, and what is not written is not copied between memory and cache.
        if (self.share, self.sent) != (self.iterate, 0.0) {
            (self.share, self.sent) = (self.iterate, 0.0);
        }
    }

    /// What is used of a share that the routing method gives it.
    fn usable(&self, share: f64) -> f64 {
        if self.is_retiring { 0.0 } else { positive_part(share - SOFT_THRESHOLD) }
    }
}

impl Links {
    /// The links to these receivers, which are ascending, with what is known of them from before.
    pub(super) fn to(&self, receivers: &[Receiver], context: Context<'_>) -> Links {
        let settings = &context.site.settings;
        let (aversion, link_model) = (settings.slope_aversion, &context.site.link);
        let mut found = Links::default();
        for &Receiver { node: to, distance, reliability, in_tree, has_flow } in receivers {
            let at_worst = link_model.reliability(distance + 2.0 * settings.errors.stray());
            let is_retiring = at_worst < LEAST_USEFUL_RELIABILITY && !in_tree;
            if is_retiring && !has_flow || reliability <= 0.0 {
                continue;
            }
            let known = self.place_of(to);
            let kept = known.filter(|_| !is_retiring);
            let share = kept.map_or(0.0, |at| self.table[at].iterate);
            let link = RouteLink { to, reliability, share, iterate: share, sent: 0.0, is_retiring };
            let weight = weight(aversion, link_model, distance);
            let report = known.and_then(|at| self.terms[at].report);
            found.table.push(link);
            found.terms.push(LinkTerms { to, weight, report });
        }
        found
    }

    /// Whether these are the same links, and known as well, apart from what a control period plans.
    pub(super) fn are_those_of(&self, found: &Links) -> bool {
        let mut table = self.table.clone();
        table.iter_mut().for_each(RouteLink::begin_period);
        (&table, &self.terms) == (&found.table, &found.terms)
    }

    /// A control period begins: shares are as the routing method left them, and no flow has been sent.
    pub(super) fn begin_period(&mut self) {
        self.table.iter_mut().for_each(RouteLink::begin_period);
        self.expected = 0;
        self.has_unsent = true;
    }

    pub(super) fn all(&self) -> &[RouteLink] {
        &self.table
    }

    /// Where the link to this node is.
    pub(super) fn place_of(&self, node: NodeId) -> Option<usize> {
        self.table.binary_search_by_key(&node, |link| link.to).ok()
    }

    /// Whether one of them stays only until its flow has ended.
    pub(super) fn has_retiring(&self) -> bool {
        self.table.iter().any(|link| link.is_retiring)
    }

    /// Stores the report of a node; returns whether there is a link to it and the report differs from its last.
    pub(super) fn receive_report(&mut self, from: NodeId, report: NeighbourReport) -> bool {
        self.terms_of(from).is_some_and(|terms| terms.report.replace(report) != Some(report))
    }

    /// The terms of the link to `node`. Reports of an iteration mostly arrive in the order of their senders.
    fn terms_of(&mut self, node: NodeId) -> Option<&mut LinkTerms> {
        let (table, at) = (&mut self.terms, self.expected);
        let follows = at.checked_sub(1).and_then(|last| table.get(last));
        let comes_next = follows.is_none_or(|last| last.to < node)
            && table.get(at).is_none_or(|next| node <= next.to);
        if !comes_next {
            self.expected = table.partition_point(|it| it.to < node);
        }
        let terms = table.get_mut(self.expected).filter(|it| it.to == node)?;
        self.expected += 1;
        Some(terms)
    }

    fn with_terms(&self) -> impl Iterator<Item = (&RouteLink, &LinkTerms)> {
        self.table.iter().zip(&self.terms)
    }

    /// The links as (13) sees them.
    pub(super) fn offers(&self) -> Vec<LinkOffer> {
        let offer = |(link, terms): (&RouteLink, &LinkTerms)| LinkOffer {
            reliability: link.reliability,
            weight: terms.weight,
            neighbour_multiplier: terms.report.map_or(0.0, |report| report.multiplier),
        };
        self.with_terms().map(offer).collect()
    }

    /// The links as ADAL sees them.
    pub(super) fn adal_links(&self) -> Vec<AdalLink> {
        let link = |(link, terms): (&RouteLink, &LinkTerms)| AdalLink {
            reliability: link.reliability,
            weight: terms.weight,
            share: link.share,
            report: terms.report,
        };
        self.with_terms().map(link).collect()
    }

    /// ε of (14), from the links that meet in the equation of the robot.
    pub(super) fn safe_dual_step(&self, context: Context<'_>) -> f64 {
        safe_step(self.with_terms().map(|(link, terms)| LinkCurvature {
            reliability: link.reliability,
            weight: terms.weight,
            to_access_point: !context.is_robot(link.to),
        }))
    }

    /// The reliabilities of the links to robots.
    pub(super) fn between_robots(&self, context: Context<'_>) -> impl Iterator<Item = f64> {
        let to_robots = self.table.iter().filter(move |link| context.is_robot(link.to));
        to_robots.map(|link| link.reliability)
    }

    /// Takes over the shares that the routing method gives.
    pub(super) fn set_shares(&mut self, shares: impl IntoIterator<Item = f64>) {
        for (link, share) in self.table.iter_mut().zip(shares) {
            link.share = link.usable(share);
            link.iterate = link.share;
        }
        self.has_unsent = true;
    }

    /// Whether its shares are those that the routing method gives, to the bit.
    pub(super) fn have_shares(&self, shares: impl IntoIterator<Item = f64>) -> bool {
        let mut given = self.table.iter().zip(shares);
        given.all(|(link, share)| link.usable(share).to_bits() == link.share.to_bits())
    }

    /// The shares are those of the flows in use: (receiver, T_ij), ascending.
    pub(super) fn adopt(&mut self, in_use: impl Iterator<Item = (NodeId, f64)>) {
        let mut in_use = in_use.peekable();
        for link in &mut self.table {
            let share = in_use.next_if(|&(to, _)| to == link.to).map_or(0.0, |(_, share)| share);
            if link.share != share {
                link.share = share;
            }
        }
    }

    /// Sends nothing more to this node; returns whether that is less than before.
    pub(super) fn relieve(&mut self, node: NodeId) -> bool {
        let Some(at) = self.place_of(node) else { return false };
        let had_share = std::mem::take(&mut self.table[at].share) > 0.0;
        self.has_unsent |= had_share;
        had_share
    }

    /// Sends less over all links, in proportion.
    pub(super) fn scale(&mut self, factor: f64) {
        self.table.iter_mut().for_each(|link| link.share *= factor);
        self.has_unsent = true;
    }

    /// Sends this much in all, and what is missing over one link as far as there is time.
    pub(super) fn raise_outflow(&mut self, demand: f64, over: usize) {
        let share = |link: &RouteLink| Share { reliability: link.reliability, share: link.share };
        let mut shares: Vec<Share> = self.table.iter().map(share).collect();
        meet_demand(demand, &mut shares, over);
        for (link, repaired) in self.table.iter_mut().zip(shares) {
            link.share = repaired.share;
        }
        self.has_unsent = true;
    }

    /// Σ_j F_ij.
    pub(super) fn outflow(&self) -> f64 {
        self.table.iter().map(RouteLink::flow).sum()
    }

    /// Σ_j F_ij, without a look at the links where their flows are those that were sent.
    pub(super) fn known_outflow(&self, context: Context<'_>) -> f64 {
        if self.has_unsent || !context.caches() {
            return self.outflow();
        }
        let is_known = || self.sent_outflow.to_bits() == self.outflow().to_bits();
        debug_assert!(context.may_skip(is_known), "robot {}: an old outflow", context.id);
        self.sent_outflow
    }

    /// Whether shares have changed since their flows were sent.
    pub(super) const fn has_unsent(&self) -> bool {
        self.has_unsent
    }

    /// Sends flows to their receivers, where they have changed; returns whether that was looked at.
    pub(super) fn send_flows(&mut self, context: Context<'_>, outputs: &mut NodeOutputs) -> bool {
        if !std::mem::take(&mut self.has_unsent) {
            return false;
        }
        for link in self.table.iter_mut().filter(|link| context.is_robot(link.to)) {
            let flow = link.flow();
            if flow != link.sent {
                link.sent = flow;
                outputs.send(link.to, Message::Flow(flow));
            }
        }
        self.sent_outflow = self.outflow();
        true
    }
}
