//! The mission as one robot knows it: the phases, with the data that each of them needs.

use std::sync::Arc;

use pleach_discrete::network::{NodeId, Phase, Subgroup};

use super::duty::Path;

crate::places_of! {
    /// Where the mission stands for one robot: a [`Phase`] with the data that it owns.
    pub enum Mission: Phase {
        /// No task is announced.
        Idle(Idle),
        /// The leader of the announced task is being elected (Algorithm 1).
        LeaderElection(LeaderElection),
        /// The primary team is the active team (Sec. V-A3).
        Advance(Advance),
        /// A recruit is being elected (Remark 5.4).
        RecruitElection(RecruitElection),
        /// The path Σ is announced and its break points are agreed (Sec. V-C2).
        PathAgreement(PathAgreement),
        /// A subgroup of the secondary team is the active team (Algorithm 3).
        Shift(Shift),
        /// The mission has ended.
        Ended(Ended),
    }
}

/// The data of [`Phase::Idle`]: none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Idle;

/// The data of [`Phase::LeaderElection`]: none beside the election that the robot repeats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LeaderElection;

/// The data of [`Phase::Advance`].
#[derive(Clone, Debug, PartialEq)]
pub struct Advance {
    /// The path Σ along which the robot that joined last has come, if any has.
    pub path: Option<Arc<Path>>,
    /// Whether a recruit has been called for ahead of a standstill since then, and none could come.
    pub in_vain: bool,
}

/// The data of [`Phase::RecruitElection`].
#[derive(Clone, Debug, PartialEq)]
pub struct RecruitElection {
    /// The path Σ of the recruitment before, if there was one.
    pub before: Option<Arc<Path>>,
    /// Where this robot calls for one: why.
    pub standstill: Option<Standstill>,
    /// Whether this robot calls for one ahead of a standstill.
    pub ahead: bool,
    /// Whether links had been stretched before.
    pub stretched: bool,
}

/// What the primary team knows when it gets no farther.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Standstill {
    /// Geodesic distance from the leader to its task.
    pub remaining: f64,
    /// A member whose links carry no more.
    pub saturated: Option<NodeId>,
    /// Whether a member could be attached to another tree: over a shorter way or, once links are as long
    /// as they ever are, over any.
    pub near_other_tree: bool,
}

/// The data of [`Phase::PathAgreement`].
#[derive(Clone, Debug, PartialEq)]
pub struct PathAgreement {
    /// The path Σ.
    pub path: Arc<Path>,
}

/// The data of [`Phase::Shift`].
#[derive(Clone, Debug, PartialEq)]
pub struct Shift {
    /// The path Σ.
    pub path: Arc<Path>,
    /// Its subgroups S_β; none if the recruit joins the primary team at once.
    pub subgroups: Arc<[Subgroup]>,
    /// β: how many subgroups have arrived.
    pub arrived: usize,
}

/// The data of [`Phase::Ended`].
#[derive(Clone, Debug, PartialEq)]
pub struct Ended {
    /// What the robot was walking along when the mission ended, if it was: if the mission goes on, it gives that up.
    pub walk: Option<Walk>,
}

/// A path Σ that robots walk along.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk {
    /// The path.
    pub path: Arc<Path>,
    /// The subgroup that is the active team, while one is.
    pub active: Option<Subgroup>,
}

impl Shift {
    /// The subgroup that is the active team; none when all have arrived.
    pub(super) fn active(&self) -> Option<Subgroup> {
        self.subgroups.get(self.arrived).copied()
    }

    /// The subgroup that relieves the robot at `place`.
    pub(super) fn subgroup_up_to(&self, place: usize) -> Option<Subgroup> {
        self.subgroups.iter().copied().find(|subgroup| subgroup.end == place)
    }
}

impl Mission {
    /// The path Σ that matters in this phase.
    pub(super) const fn path(&self) -> Option<&Arc<Path>> {
        match self {
            Mission::PathAgreement(PathAgreement { path }) | Mission::Shift(Shift { path, .. }) => {
                Some(path)
            }
            Mission::Advance(Advance { path, .. })
            | Mission::RecruitElection(RecruitElection { before: path, .. }) => path.as_ref(),
            Mission::Idle(_) | Mission::LeaderElection(_) | Mission::Ended(_) => None,
        }
    }

    /// The path Σ that matters in this phase, or did when the mission ended, to a robot on its way along it.
    pub(super) fn walk(&self) -> Option<Walk> {
        match self {
            Mission::Ended(Ended { walk }) => walk.clone(),
            _ => self.path().map(|path| Walk {
                path: Arc::clone(path),
                active: self.shift().and_then(Shift::active),
            }),
        }
    }

    /// The election of a recruit, while one is under way.
    pub(super) const fn recruit_election(&self) -> Option<&RecruitElection> {
        match self {
            Mission::RecruitElection(election) => Some(election),
            _ => None,
        }
    }

    /// Whether a recruit has been called for ahead of a standstill since one joined last, in vain.
    pub(super) const fn has_called_in_vain(&self) -> bool {
        matches!(self, Mission::Advance(Advance { in_vain: true, .. }))
    }

    /// The subgroups of the secondary team and which of them is active, while one is.
    pub(super) const fn shift(&self) -> Option<&Shift> {
        match self {
            Mission::Shift(shift) => Some(shift),
            _ => None,
        }
    }
}
