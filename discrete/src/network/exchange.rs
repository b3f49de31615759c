//! The exchange of duties between a mover and the robot that stands in its way.
//!
//! Robots are alike: where a mover would have to pass a parked robot, the two exchange duties
//! instead, which is Algorithm 4's "adopts the role" without the walk. The protocol never leaves
//! a duty without a robot: the parked robot takes the mover's duty and goes on answering for its
//! post until it hears that the mover holds it.

use super::NodeId;

/// A mover's standing offer to a parked robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Exchange<D> {
    /// To whom.
    pub to: NodeId,
    /// The offers of one robot are numbered.
    pub number: u32,
    /// The duty that the mover hands over.
    pub duty: D,
}

/// The parked robot's answer, repeated until the mover has heard it.
#[derive(Clone, Debug, PartialEq)]
pub struct Reply<D> {
    /// To whom.
    pub to: NodeId,
    /// The number of the offer.
    pub number: u32,
    /// The duty that the parked robot handed over in return; none if it refused.
    pub accepted: Option<D>,
}
