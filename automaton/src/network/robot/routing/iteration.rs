//! The iteration of the routing method: the dual iteration (13)–(14), or ADAL.

use pleach_continuous::network::routing::adal::{
    AdalRobot, AdalSettings, NeighbourReport, Workspace,
};
use pleach_continuous::network::routing::dual::{DualState, dual_step};
use pleach_continuous::network::routing::local::local_minimiser;
use pleach_discrete::network::NodeId;

use super::super::context::Context;
use super::links::Links;
use crate::network::member::NodeOutputs;
use crate::network::message::Message;
use crate::network::scenario::RoutingMethod;

/// Share of its time that a robot gives away before the sweep; the rest is kept for the sweep and
/// for motion.
const BUDGET: f64 = 0.9;

/// What a robot carries from one iteration to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Iterate {
    /// λ_i, with momentum where the iteration is accelerated.
    Dual(DualState),
    /// λ_i, the mismatch and the slack of ADAL.
    Adal(AdalRobot),
}

/// The iteration of one robot.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Iteration {
    iterate: Iterate,
    /// ε of (14) over the links of this period.
    step_size: f64,
    /// How its equation stands, as it was sent last in this period.
    sent: Option<NeighbourReport>,
    /// A multiplier has changed, its own or a neighbour's, since shares were chosen.
    has_new_multipliers: bool,
    /// The last dual step has changed nothing. ADAL does not come to rest.
    has_settled: bool,
}

impl Iteration {
    /// The iteration at the start of a mission.
    pub(super) fn new(method: RoutingMethod) -> Self {
        let iterate = match method {
            RoutingMethod::Dual | RoutingMethod::AcceleratedDual => {
                Iterate::Dual(DualState::default())
            }
            RoutingMethod::Adal => Iterate::Adal(AdalRobot::default()),
        };
        Iteration {
            iterate,
            step_size: 0.0,
            sent: None,
            has_new_multipliers: false,
            has_settled: false,
        }
    }

    /// λ_i.
    pub(super) fn multiplier(&self) -> f64 {
        match &self.iterate {
            Iterate::Dual(state) => state.multiplier(),
            Iterate::Adal(state) => state.multiplier(),
        }
    }

    /// ε of (14) for links that have been found anew.
    pub(super) const fn set_step_size(&mut self, step_size: f64) {
        self.step_size = step_size;
    }

    /// A control period begins.
    pub(super) const fn begin_period(&mut self) {
        (self.sent, self.has_settled) = (None, false);
    }

    /// The residual that the routes of the period before leave over the links as they are now.
    pub(super) fn begin(&mut self, residual: f64, links: &Links, context: Context<'_>) {
        if let Iterate::Adal(state) = &mut self.iterate {
            let reserve = context.site.settings.routing_reserve;
            state.measure(residual, reserve, links.between_robots(context));
        }
    }

    /// Sends how the equation c_i ≥ η stands: in the first iteration of a period, and when that has changed.
    pub(super) fn send_report(&mut self, parent: Option<NodeId>, outputs: &mut NodeOutputs) {
        let report = match &self.iterate {
            Iterate::Adal(state) => state.report(),
            Iterate::Dual(state) => {
                NeighbourReport { multiplier: state.multiplier(), mismatch: 0.0, crowding: 1.0 }
            }
        };
        if self.sent.replace(report) != Some(report) {
            outputs.broadcast(Message::Multiplier { report, parent });
        }
    }

    /// A neighbour has reported a new multiplier.
    pub(super) const fn note_new_multiplier(&mut self) {
        self.has_new_multipliers = true;
    }

    /// A flow to this robot has changed.
    pub(super) const fn note_new_flow(&mut self) {
        self.has_settled = false;
    }

    /// The primal iteration (13), or that of ADAL. Shares that minimise the local Lagrangian do so until a multiplier
    /// changes.
    pub(super) fn primal_step(&mut self, links: &mut Links, context: Context<'_>) {
        let has_new_multipliers = std::mem::take(&mut self.has_new_multipliers);
        let multiplier = self.multiplier();
        match &mut self.iterate {
            Iterate::Dual(_) if !has_new_multipliers && !links.has_unsent() && context.caches() => {
                let have_shares = || links.have_shares(minimiser(multiplier, links));
                debug_assert!(context.may_skip(have_shares), "robot {}: old shares", context.id);
            }
            Iterate::Dual(_) => links.set_shares(minimiser(multiplier, links)),
            Iterate::Adal(state) => {
                let mut moved = links.adal_links();
                state.primal_step(&mut moved, &AdalSettings::default(), &mut Workspace::default());
                links.set_shares(moved.iter().map(|link| link.share));
            }
        }
    }

    /// The dual iteration (14), or that of ADAL.
    pub(super) fn dual_step(&mut self, residual: f64, links: &Links, context: Context<'_>) {
        let is_known = || self.step_size.to_bits() == links.safe_dual_step(context).to_bits();
        debug_assert!(context.may_skip(is_known), "robot {}: an old step size", context.id);
        let settings = &context.site.settings;
        let (step, reserve) = (self.step_size, settings.routing_reserve);
        let (before, multiplier) = (self.iterate, self.multiplier());
        match &mut self.iterate {
            Iterate::Adal(state) => state.dual_step(residual, reserve, &AdalSettings::default()),
            Iterate::Dual(state) => {
                *state = match settings.routing_method {
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
        self.has_settled = self.iterate == before && matches!(before, Iterate::Dual(_));
    }

    /// Whether further iterations change nothing, as long as nothing new is received and all flows are sent.
    pub(super) const fn is_at_rest(&self) -> bool {
        self.has_settled && !self.has_new_multipliers
    }
}

/// The shares that minimise the local Lagrangian, eq. (13).
fn minimiser(multiplier: f64, links: &Links) -> Vec<f64> {
    let offers = links.offers();
    let mut shares = Vec::with_capacity(offers.len());
    local_minimiser(multiplier, &offers, BUDGET, &mut shares);
    shares
}
