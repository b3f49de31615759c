//! What nodes send to their neighbours.
//!
//! A beacon is a copy of its sender's public state. Every agreement of the network works by
//! repeating such copies and taking maxima: a message that is copied or late does no harm,
//! and the message after a lost one contains the same or newer information. A beacon that stays the
//! same is repeated a few times and then no more, until the next control period begins.

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{
    Agreement, Anchor, Election, IdSet, Lineage, NodeId, NoticeId, Offer, PostId, Reply, bulletin,
};
use serde::{Deserialize, Serialize};

use super::duty::{Duty, Hop, Path};
use super::record::Outcome;
use super::robot::ROUNDS_TO_BE_HEARD;
use super::roll::Wreck;
use super::shared::{Shared, merge_set};
use super::wire;

/// A notice on the mission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Notice {
    /// Nothing is announced.
    Quiet,
    /// A task is announced.
    Task(Shared<Announcement>),
    /// The primary team calls for a recruit (Remark 5.4).
    Call {
        /// The caller: p₁, or the leader when it has to be released.
        caller: NodeId,
        /// L_b.
        releases_leader: bool,
    },
    /// The recruit has found the path Σ.
    Path(#[serde(with = "wire")] Arc<Path>),
    /// The primary team is the active team (again).
    Advance {
        /// The post that has joined the team and the post that it follows.
        joined: Option<(PostId, PostId)>,
    },
    /// The task is serviced.
    Serviced {
        /// Its number.
        task: usize,
    },
    /// The user has taken back the task that was pursued: the team is dissolved.
    Withdrawn {
        /// Its number.
        task: usize,
    },
    /// The mission has ended.
    Ended {
        /// How.
        outcome: Outcome,
        /// Why, in a sentence.
        #[serde(with = "wire")]
        reason: Arc<String>,
        /// The task concerned.
        task: Option<usize>,
    },
}

/// A task with those who elect its leader.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Announcement {
    /// Its number.
    pub task: usize,
    /// q_v.
    #[serde(with = "wire")]
    pub position: Point,
    /// The positions of the tasks that have been serviced before, from the first on.
    #[serde(with = "wire")]
    pub before: Arc<[Point]>,
    /// The robots that take part.
    #[serde(with = "wire")]
    pub roster: Arc<IdSet>,
    /// The access points whose robots compete to lead.
    #[serde(with = "wire")]
    pub eligible: Arc<IdSet>,
    /// Whether the election is repeated among the robots of all access points, since a team that found no recruit can be
    /// attached to another tree.
    pub again: bool,
    /// Whether links had been stretched when the election was repeated among the robots of all access points.
    pub stretched: bool,
    /// Set in the last announcement, when no recruit is left: robots bid whose posts can move with them. If none bids, the
    /// task is given up for this reason.
    #[serde(with = "wire")]
    pub last_resort: Option<Arc<String>>,
}

impl Announcement {
    /// The position of this task, or of one that has been serviced before.
    pub(super) fn position_of(&self, task: usize) -> Option<Point> {
        if task == self.task { Some(self.position) } else { self.before.get(task).copied() }
    }
}

/// An announcement with the identity of the notice that made it.
pub(super) type Announced = (NoticeId, Shared<Announcement>);

/// A call for a recruit with a way over the tree to the caller.
pub(super) type CallRoute = (NoticeId, Shared<Vec<Hop>>);

/// A notice on the mission with its identity.
pub(super) type Bulletin = bulletin::Bulletin<Shared<Notice>>;

/// What the primary team knows of itself, passed from the leader back to p₁.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TeamReport {
    /// Control periods since any member moved, as far forward as the leader.
    pub still: u32,
    /// A member whose link is slack although it cannot move, or the leader if it is near enough to its task where it
    /// is.
    pub slack: Option<NodeId>,
    /// A member whose links carry no more.
    pub saturated: Option<NodeId>,
    /// Geodesic distance from the leader to its task; infinite if no way leads there.
    #[serde(with = "wire::distance")]
    pub remaining: f64,
    /// How many members there are from the leader back to the sender.
    pub members: u32,
    /// Whether a member could be attached to another tree: over a shorter way or, once links are as long as they ever
    /// are, over any.
    pub near_other_tree: bool,
}

/// The public state of a node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beacon {
    /// The sender.
    pub sender: NodeId,
    /// Where it is.
    #[serde(with = "wire")]
    pub position: Point,
    /// The newest notice on the mission that it knows.
    pub bulletin: Bulletin,
    /// The announcement that it goes by.
    pub announced: Option<Announced>,
    /// The robots that have elected by this announcement and restarted since: they have forgotten what became
    /// of it.
    #[serde(with = "wire")]
    pub forgetful: Arc<IdSet>,
    /// Its view of the current election.
    #[serde(with = "wire")]
    pub election: Option<Arc<Election>>,
    /// Its view of the agreement about the current path.
    pub agreement: Option<Agreement>,
    /// Its way over the tree to the robot that calls for a recruit, and the call.
    pub route: Option<CallRoute>,
    /// The access points that the way crosses first, when the sender is an access point.
    pub crossing: Vec<usize>,
    /// Its way to an access point.
    #[serde(with = "wire")]
    pub lineage: Option<Arc<Lineage>>,
    /// The node that it is attached to.
    pub parent: Option<NodeId>,
    /// The robots that are attached to it, itself included.
    #[serde(with = "wire")]
    pub below: Arc<IdSet>,
    /// Robots that these hear and that know no way to an access point.
    #[serde(with = "wire")]
    pub strays: Arc<IdSet>,
    /// The tasks that all of them service.
    #[serde(with = "wire")]
    pub serves: Arc<IdSet>,
    /// The tasks that are over, as far as it knows: they have lasted as long as they should, or the user has
    /// taken them back.
    #[serde(with = "wire")]
    pub closed: Arc<IdSet>,
    /// What it does; none for an access point.
    pub duty: Option<Duty>,
    /// Whether it stands still unless it is asked for.
    pub parked: bool,
    /// Where it wants to go next, if it has been stuck for a while.
    #[serde(with = "wire")]
    pub way: Option<Point>,
    /// For a redundant robot: whether it could attach to another node than its parent.
    pub can_detach: bool,
    /// A standing offer to exchange duties.
    pub offer: Option<Offer<Duty>>,
    /// How many offers it has made so far.
    pub offers_made: u32,
    /// The answer to an offer.
    pub reply: Option<Reply<Duty>>,
    /// What the primary team knows of itself, for the next member towards p₁.
    pub team: Option<TeamReport>,
    /// Whether a team has found no robot that can be recruited, so that links of the tree may be as long as
    /// they ever are.
    pub stretched: bool,
    /// For how many rounds news may be under way, by the deepest place in a tree that the sender has heard of.
    pub longest_wait: usize,
    /// Where robots that do not take part were heard last.
    #[serde(with = "wire")]
    pub wrecks: Arc<Vec<Wreck>>,
    /// Where the robots that are attached to it are, by number; an access point does not tell.
    #[serde(with = "wire")]
    pub branches: Arc<Vec<Branch>>,
}

/// A robot that is attached to the sender of a beacon.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Branch {
    /// The robot.
    pub robot: NodeId,
    /// Where the sender has heard it, in this control period or in one of the two before.
    #[serde(with = "wire")]
    pub place: Point,
}

impl Beacon {
    /// A beacon that reports nothing but who and where its sender is.
    pub(super) fn silent(sender: NodeId, position: Point) -> Self {
        Self {
            sender,
            position,
            bulletin: Bulletin::first(Shared::new(Notice::Quiet)),
            announced: None,
            forgetful: Arc::default(),
            election: None,
            agreement: None,
            route: None,
            crossing: Vec::new(),
            lineage: None,
            parent: None,
            below: Arc::default(),
            strays: Arc::default(),
            serves: Arc::default(),
            closed: Arc::default(),
            duty: None,
            parked: false,
            way: None,
            can_detach: false,
            offer: None,
            offers_made: 0,
            reply: None,
            team: None,
            stretched: false,
            longest_wait: 0,
            wrecks: Arc::default(),
            branches: Arc::default(),
        }
    }

    /// Where the sender, heard in this control period, says that robots are which are attached to it. It has heard
    /// them two periods ago or since: it works them out anew in each period, unless it hears all its neighbours in
    /// each ([`is_undisturbed`](super::robot::Robot::is_undisturbed)).
    pub(super) fn sightings(&self, period: u32) -> impl Iterator<Item = Wreck> {
        let heard_in = period.saturating_sub(2);
        let sighting = move |it: &Branch| Wreck::heard(it.robot, it.place, heard_in);
        self.branches.iter().map(sighting)
    }

    /// Whether the post of the sender is attached to this anchor.
    pub(super) fn is_attached_to(&self, anchor: Anchor) -> bool {
        let post = self.duty.as_ref().and_then(Duty::post);
        post.is_some_and(|post| post.parent == Some(anchor))
    }

    /// The task that is serviced from the post of the sender.
    pub(super) fn task(&self) -> Option<usize> {
        self.duty.as_ref()?.post()?.task
    }

    /// Adds the robots that have forgotten what became of an announcement, if the sender goes by the same one.
    #[inline]
    pub(super) fn tell_forgetful(&self, own: Option<&Announced>, known: &mut Arc<IdSet>) {
        let goes_by = |announced: Option<&Announced>| announced.map(|(id, _)| *id);
        if !self.forgetful.is_empty() && goes_by(self.announced.as_ref()) == goes_by(own) {
            merge_set(known, &self.forgetful);
        }
    }

    /// Adds the tasks that are over by the sender. None of them is ever taken up again.
    pub(super) fn tell_closed(&self, known: &mut Arc<IdSet>) {
        merge_set(known, &self.closed);
    }

    /// Whether the same sender surely sent this before `other`: it had received, or offered, less.
    /// A medium may deliver copies late.
    pub(super) fn is_older_than(&self, other: &Beacon) -> bool {
        other.bulletin.id().is_newer_than(self.bulletin.id())
            || self.offers_made < other.offers_made
    }
}

/// What a node tells those nearer to an access point of the robots beyond it, collected from their
/// beacons.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Reports {
    /// The robots of its branch of the tree.
    pub below: IdSet,
    /// Robots that are heard there and know no way to an access point.
    pub strays: IdSet,
    /// The tasks that all of them service.
    pub serves: IdSet,
}

impl Reports {
    /// Takes in the beacon of a robot that node `own` hears, and whose post is attached to that node's or
    /// is not. Robots that know no way count if others hear of this node: if it `is_linked` to one of the tree.
    pub(super) fn take_in(
        &mut self,
        beacon: &Beacon,
        is_child: bool,
        own: NodeId,
        is_linked: bool,
    ) {
        if is_child {
            self.take_in_branch(beacon);
        } else if beacon.parent == Some(own) {
            // Its post is attached to one that has no holder at present.
            self.strays.merge(&beacon.below);
            self.strays.merge(&beacon.strays);
            self.serves.merge(&beacon.serves);
        } else if beacon.lineage.is_none() && is_linked {
            self.strays.insert(beacon.sender);
            self.serves.extend(beacon.task());
        }
    }

    /// Takes in all that the sender reports.
    pub(super) fn take_in_branch(&mut self, beacon: &Beacon) {
        self.below.merge(&beacon.below);
        self.strays.merge(&beacon.strays);
        self.serves.merge(&beacon.serves);
    }
}

/// The beacon that a node sent last. As long as its public state does not change, a node sends the
/// very same beacon again, and receivers need not read it.
#[derive(Clone, Debug, Default)]
pub(super) struct LastBeacon {
    last: Option<Arc<Beacon>>,
    /// In how many rounds of this period it has been told, with what goes beside it, as it is now.
    told: usize,
}

impl LastBeacon {
    /// The beacon sent last, if any.
    pub(super) fn get(&self) -> Option<Arc<Beacon>> {
        self.last.clone()
    }

    /// The beacon to send now, and whether it differs from the last one: then it is told anew.
    pub(super) fn replace_by(&mut self, now: Beacon) -> (Arc<Beacon>, bool) {
        match &self.last {
            Some(last) if **last == now => (Arc::clone(last), false),
            _ => {
                let beacon = Arc::new(now);
                *self = LastBeacon { last: Some(Arc::clone(&beacon)), told: 0 };
                (beacon, true)
            }
        }
    }

    /// A control period begins, or what goes beside the beacon has changed: it is told anew.
    pub(super) const fn tell_anew(&mut self) {
        self.told = 0;
    }

    /// Whether it has been told in as many rounds as it takes to be heard if some are lost.
    pub(super) const fn is_told(&self) -> bool {
        self.told == ROUNDS_TO_BE_HEARD
    }

    /// Whether it is told in this round, which then counts.
    pub(super) fn tell(&mut self) -> bool {
        let is_due = !self.is_told();
        self.told += usize::from(is_due);
        is_due
    }
}
