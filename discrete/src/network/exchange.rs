//! The exchange of duties between a mover and the robot that stands in its way.
//!
//! Robots are alike: where a mover would have to pass a parked robot, the two exchange duties
//! instead, which is Algorithm 4's "adopts the role" without the walk. The mover offers its duty;
//! the parked robot answers with its own and goes on doing it; the mover takes that and gives its
//! offer up; then the parked robot takes what was offered. Each step is seen in the beacon of the
//! one who took it, so that messages may be repeated or come late.

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
