//! What a component reads of its robot in one step, beside its arguments.

use pleach_discrete::network::NodeId;

use super::rounds::Rounds;
use crate::network::site::Site;

/// What is left out in missions is verified in one control period in this many: that costs as much as doing it.
pub(super) const PERIODS_PER_CHECK: u32 = 4;

/// What a component reads of its robot in one step, beside its arguments.
#[derive(Clone, Copy, Debug)]
pub(super) struct Context<'a> {
    /// The robot.
    pub id: NodeId,
    /// What every robot has from the beginning.
    pub site: &'a Site,
    /// r_i.
    pub rate: f64,
    /// The control period.
    pub period: u32,
    /// The round of its stage.
    pub rounds: Rounds,
}

impl Context<'_> {
    /// Whether what has been derived is kept until something that it is derived from changes.
    pub(super) fn caches(self) -> bool {
        self.site.settings.caching
    }

    /// Whether what is left out is verified in this period.
    pub(super) const fn verifies(self) -> bool {
        self.period.is_multiple_of(PERIODS_PER_CHECK)
    }

    /// Whether work that is left out would change nothing, where that is verified.
    pub(super) fn may_skip(self, changes_nothing: impl FnOnce() -> bool) -> bool {
        !self.verifies() || changes_nothing()
    }

    /// Whether a node is a robot, and no access point.
    pub(super) fn is_robot(self, node: NodeId) -> bool {
        node < self.site.robots
    }
}

/// The [`Context`] of a robot, borrowed field by field: a component of the robot can change meanwhile.
macro_rules! context {
    ($robot:expr) => {
        $crate::network::robot::context::Context {
            id: $robot.id,
            site: &$robot.site,
            rate: $robot.routing.rate(),
            period: $robot.schedule.period(),
            rounds: $robot.schedule.rounds(),
        }
    };
}

pub(super) use context;
