//! What flows in and out of a robot, and its residual.

use pleach_discrete::network::NodeId;

use super::super::context::Context;
use super::links::Links;

/// Residuals are sums of a few flows; this much of them is rounding.
pub(super) const RESIDUAL_ROUNDING: f64 = 1e-9;

/// The flows to a robot, and the residual that they leave.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Balance {
    /// Σ_j F_ji.
    inflow: f64,
    /// F_ji of each sender, ascending; those that send nothing are left out.
    inflows: Vec<(NodeId, f64)>,
    /// c_i.
    residual: f64,
    /// Whether a flow may have changed since the residual was settled.
    is_unsettled: bool,
}

impl Balance {
    /// A control period begins: no flow is known.
    pub(super) fn begin_period(&mut self) {
        self.inflow = 0.0;
        self.inflows.clear();
        self.is_unsettled = true;
    }

    /// c_i.
    pub(super) const fn residual(&self) -> f64 {
        self.residual
    }

    /// Σ_j F_ji, as far as it is known.
    pub(super) const fn inflow(&self) -> f64 {
        self.inflow
    }

    /// A neighbour reports the flow that it sends to this robot.
    pub(super) fn receive_flow(&mut self, from: NodeId, flow: f64) {
        self.is_unsettled = true;
        match self.inflows.binary_search_by_key(&from, |&(sender, _)| sender) {
            Ok(at) if flow > 0.0 => self.inflows[at].1 = flow,
            Ok(at) => {
                self.inflows.remove(at);
            }
            Err(at) if flow > 0.0 => self.inflows.insert(at, (from, flow)),
            Err(_) => {}
        }
    }

    /// This much more flows in than the senders have reported.
    pub(super) fn receive_more(&mut self, more: f64) {
        self.inflow += more;
    }

    /// Flows to others have changed.
    pub(super) const fn note_new_outflow(&mut self) {
        self.is_unsettled = true;
    }

    /// Σ_j F_ji of the flows that the senders have reported.
    pub(super) fn add_up_inflow(&mut self) {
        self.inflow = self.inflows.iter().map(|(_, flow)| flow).sum();
    }

    /// c_i of the flows that are known now, which are added up.
    pub(super) fn residual_now(&mut self, links: &Links, context: Context<'_>) -> f64 {
        self.add_up_inflow();
        links.known_outflow(context) - self.inflow - context.rate
    }

    /// All flows are known: eq. (5).
    pub(super) fn settle(&mut self, links: &Links, context: Context<'_>) {
        if std::mem::take(&mut self.is_unsettled) || !context.caches() {
            self.residual = self.residual_now(links, context);
        }
    }

    /// Whether a flow may have changed since the residual was settled.
    pub(super) const fn is_unsettled(&self) -> bool {
        self.is_unsettled
    }

    /// The flows of the period are those in use and what others may send: c_i of eq. (5) is what these leave.
    pub(super) fn adopt(
        &mut self,
        context: Context<'_>,
        outflow: f64,
        granted: impl Iterator<Item = (NodeId, f64)>,
    ) {
        self.inflows.clear();
        self.inflows.extend(granted);
        self.add_up_inflow();
        self.inflows.retain(|&(_, flow)| flow > 0.0);
        let residual = outflow - self.inflow - context.rate;
        self.residual = if residual.abs() < RESIDUAL_ROUNDING { 0.0 } else { residual };
    }

    /// Whether the routes cannot carry the rates: c_i < −c_min.
    pub(super) fn is_infeasible(&self, context: Context<'_>) -> bool {
        self.residual < -context.site.settings.residual_tolerance - RESIDUAL_ROUNDING
    }
}

#[cfg(test)]
impl Balance {
    pub(super) fn leave(&mut self, residual: f64) {
        self.residual = residual;
    }
}
