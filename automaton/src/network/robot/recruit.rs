//! The election of a recruit (Remark 5.4) and its way over the tree to the robot that calls.

use std::sync::Arc;

use pleach_discrete::network::{Activity, Bid, Election, IdSet, NoticeId, Phase};

use crate::located::Place as _;

use super::Robot;
use super::hearing::Neighbour;
use super::mission::{Effects, MissionEffect};
use crate::network::beacon::{Announcement, Beacon, CallRoute, Notice, TeamReport};
use crate::network::duty::{Hop, Path, PathPlace};
use crate::network::mission::{Advance, PathAgreement, RecruitElection, Standstill};
use crate::network::record::{MissionEvent, Outcome};
use crate::network::shared::Shared;

/// The ranks of bids, the lowest first.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Rank {
    /// A redundant robot that no tree connects to the caller bids only to show where it could help.
    Disconnected,
    /// A redundant robot that cannot reach the caller: robots that have stopped block the way.
    Obstructed,
    /// The robot on whose post nothing but the caller depends joins the team where it stands, if no other robot can
    /// come.
    ParentOfCaller,
    /// A redundant robot.
    Redundant,
}

/// Residuals in bids are compared in units of this: routes aim at the same reserve everywhere,
/// and remaining differences are the dual iteration's noise.
const RESIDUAL_RESOLUTION: f64 = 1e-3;

/// p₁ is stuck, or the leader has past duties: it calls for a recruit.
pub(super) fn call(advance: &Advance, robot: &Robot, effects: &mut Effects) -> RecruitElection {
    let releases_leader = robot.duty.is_bound();
    if !releases_leader {
        let event = MissionEvent::Stationary { robot: robot.id, team: Vec::new() };
        effects.push(MissionEffect::Report(event));
    }
    effects.push(MissionEffect::Stay);
    robot.issue_call(releases_leader, effects);
    let standstill = robot.standstill();
    robot.recruit_election(advance.path.clone(), standstill, false)
}

/// The team of p₁ is too short: it calls for a recruit before it is stuck.
pub(super) fn call_ahead(
    advance: &Advance,
    robot: &Robot,
    effects: &mut Effects,
) -> RecruitElection {
    effects.push(MissionEffect::Report(MissionEvent::RecruitCalled { robot: robot.id }));
    robot.issue_call(false, effects);
    robot.recruit_election(advance.path.clone(), None, true)
}

/// A recruit is called for.
pub(super) fn answer<A>(_: &A, robot: &Robot, effects: &mut Effects) -> RecruitElection {
    let id = robot.notice_id();
    effects.extend(robot.learns_who_leads());
    let is_caller = matches!(*robot.notice(),
        Notice::Call { caller, .. } if caller == robot.id);
    let route = is_caller.then(|| robot.own_route(id)).flatten();
    effects.push(MissionEffect::Elect(Election::new(id), route));
    robot.recruit_election(robot.mission.path().cloned(), None, false)
}

/// The recruit announces the path Σ that it has found.
pub(super) fn announce_path(
    _: &RecruitElection,
    robot: &Robot,
    effects: &mut Effects,
) -> Option<PathAgreement> {
    let Notice::Call { releases_leader, .. } = *robot.notice() else { return None };
    let (_, hops) = robot.ballot.route()?;
    let path = Arc::new(Path { hops: hops.to_vec(), releases_leader });
    let id = robot.next_notice_id();
    effects.extend([
        MissionEffect::Issue(Notice::Path(Arc::clone(&path))),
        MissionEffect::Agree(Some(robot.vote_on(&path, id))),
        MissionEffect::ForgetRoute,
    ]);
    Some(PathAgreement { path })
}

/// The caller finds that no robot can be recruited: the team goes on alone if it has not come to a standstill;
/// otherwise other trees may try, links may be longer from now on, or the mission ends.
pub(super) fn end_unaided(
    phase: &RecruitElection,
    robot: &Robot,
    effects: &mut Effects,
) -> RecruitElection {
    if phase.ahead {
        effects.extend([
            MissionEffect::Report(MissionEvent::CalledInVain { robot: robot.id }),
            MissionEffect::Issue(Notice::Advance { joined: None }),
        ]);
    } else if let Some(announcement) = robot.announcement_to_others(phase.standstill) {
        effects.extend([
            MissionEffect::Report(MissionEvent::ElectionRepeated { task: announcement.task }),
            MissionEffect::Issue(Notice::Task(Shared::new(announcement))),
        ]);
    } else if robot.could_stretch() {
        effects.extend([
            MissionEffect::Stretch,
            MissionEffect::Report(MissionEvent::LinksStretched { robot: robot.id }),
            MissionEffect::Issue(Notice::Advance { joined: None }),
        ]);
    } else if let Some(task) = robot.current_task() {
        let (outcome, reason) = robot.why_unaided(task, phase.standstill);
        let end = robot.gives_up(Some(task), outcome, reason);
        match robot.last_resort(&end) {
            Some(announcement) => effects.extend([
                MissionEffect::Report(MissionEvent::ElectionRepeated { task }),
                MissionEffect::Issue(Notice::Task(Shared::new(announcement))),
            ]),
            None => effects.push(MissionEffect::Issue(end)),
        }
    }
    phase.clone()
}

impl Robot {
    /// The call for a recruit, which the caller is the first to know the way of.
    fn issue_call(&self, releases_leader: bool, effects: &mut Effects) {
        let id = self.next_notice_id();
        effects.extend([
            MissionEffect::Issue(Notice::Call { caller: self.id, releases_leader }),
            MissionEffect::Elect(Election::new(id), self.own_route(id)),
        ]);
    }

    /// The way of a call to the caller itself.
    fn own_route(&self, call: NoticeId) -> Option<CallRoute> {
        self.own_hop(Vec::new()).map(|hop| (call, Shared::new(vec![hop])))
    }

    fn recruit_election(
        &self,
        before: Option<Arc<Path>>,
        standstill: Option<Standstill>,
        ahead: bool,
    ) -> RecruitElection {
        RecruitElection {
            before,
            standstill,
            ahead,
            stretched: self.mission.notices().is_stretched(),
        }
    }

    /// Whether a recruit has been called for ahead of a standstill, and it learns now that the team goes on as it
    /// is, with links as long as before. Not only the caller learns that: another robot may take over its duty.
    pub(super) fn learns_that_call_is_vain(&self) -> bool {
        let went_on_alone = matches!(*self.notice(), Notice::Advance { joined: None });
        let election = self.mission.recruit_election();
        went_on_alone
            && election
                .is_some_and(|election| election.stretched == self.mission.notices().is_stretched())
    }

    /// Its task as it is announced again where no robot of its tree can come:
    ///
    /// - to the robots of the trees that have not been asked, if one of them is redundant;
    /// - once more to all, if its team can be attached to another tree, and again once links are stretched: a leader
    ///   from that tree can recruit most of its robots then;
    /// - once more to all, if one is redundant, and they have been asked before links were stretched.
    pub(super) fn announcement_to_others(
        &self,
        standstill: Option<Standstill>,
    ) -> Option<Announcement> {
        let known = self.announcement().filter(|known| known.last_resort.is_none())?;
        let own_root = self.lineage().map(|lineage| lineage.root());
        // Its team may be in another tree by now.
        let have_been_asked = [own_root, self.mission.led_from()];
        let others: IdSet =
            known.eligible.iter().filter(|&root| !have_been_asked.contains(&Some(root))).collect();
        let is_any_disconnected = self.ballot.best().is_some();
        if is_any_disconnected && others.len() < known.eligible.len() && !others.is_empty() {
            return Some(Announcement { eligible: Arc::new(others), ..known.clone() });
        }
        let since_stretched = self.mission.notices().is_stretched() && !known.stretched;
        let is_near_other_tree = standstill.is_some_and(|team| team.near_other_tree);
        let aids_other_tree = is_near_other_tree && (!known.again || since_stretched);
        (aids_other_tree || is_any_disconnected && since_stretched).then(|| Announcement {
            eligible: self.site.all_access_points(),
            again: known.again || aids_other_tree,
            stretched: known.stretched || self.mission.notices().is_stretched(),
            ..known.clone()
        })
    }

    /// The last announcement of its task before it is given up for lack of robots with this notice. Only robots whose
    /// posts can move with them bid.
    fn last_resort(&self, end: &Notice) -> Option<Announcement> {
        let known = self.announcement().filter(|known| known.last_resort.is_none())?;
        let Notice::Ended { outcome: Outcome::InsufficientRobots, reason, .. } = end else {
            return None;
        };
        Some(Announcement {
            eligible: self.site.all_access_points(),
            last_resort: Some(Arc::clone(reason)),
            ..known.clone()
        })
    }

    fn standstill(&self) -> Option<Standstill> {
        self.mission.team().report().map(
            |TeamReport { remaining, saturated, near_other_tree, .. }| Standstill {
                remaining,
                saturated,
                near_other_tree,
            },
        )
    }

    /// How the mission ends without a recruit.
    fn why_unaided(&self, task: usize, standstill: Option<Standstill>) -> (Outcome, String) {
        let task = self.site.name_of_task(task);
        match standstill.and_then(|team| team.saturated) {
            Some(robot) => {
                let robot = self.site.name_of(robot);
                let reason = format!(
                    "the rates cannot be carried to task {task}: the primary team stands still because the \
                     links of robot {robot} carry no more, and no robot is left that can come"
                );
                (Outcome::Blocked, reason)
            }
            None => {
                let remaining = standstill.map_or_else(|| self.remaining(), |team| team.remaining);
                let wanted = (remaining / self.hard_length()).ceil().max(1.0);
                let reason = format!(
                    "task {task} needs another recruit, and no robot is left that can come; from where \
                     the team stands more robots are needed, about {wanted}"
                );
                (Outcome::InsufficientRobots, reason)
            }
        }
    }

    /// Whether the team that calls may go on where it knows that no robot is left that can come: with longer links, or
    /// as its leader is near enough to the task where it is.
    fn could_stretch(&self) -> bool {
        let calls_for_length =
            matches!(*self.notice(), Notice::Call { releases_leader: false, .. });
        calls_for_length && !self.mission.notices().is_stretched()
    }

    fn own_hop(&self, crossing: Vec<usize>) -> Option<Hop> {
        let station = self.duty.station()?;
        let place = PathPlace { reference: station.reference, position: self.body.position() };
        Some(Hop { robot: self.id, post: station.post, place, crossing })
    }

    /// Whether it counts the rounds of an election: of a recruit, or of a leader as long as it has not
    /// answered.
    pub(super) fn counts_rounds(&self) -> bool {
        match self.phase() {
            Phase::LeaderElection => !self.ballot.has_token(self.id),
            phase => phase == Phase::RecruitElection,
        }
    }

    /// Counts one more round of an election; returns whether a wait is over, so that the
    /// robot may do what it might not do before.
    pub(super) fn count_round(&mut self) -> bool {
        if !self.counts_rounds() {
            return false;
        }
        let longest_wait = self.longest_wait();
        self.ballot.count_round(longest_wait)
    }

    /// Finds the way over the tree to the caller (footnote 10) and places a token: robots that may be
    /// recruited with a bid, once they know the way.
    pub(super) fn answer_call(&mut self) {
        let id = self.notice_id();
        // One that has restarted may have answered already: the task is announced again.
        if !self.ballot.is_of(id) || self.mission.notices().forgetful().contains(self.id) {
            return;
        }
        if !self.knows_route() {
            let route = self.find_route(id).map(|route| (id, Shared::new(route)));
            self.ballot.set_route(route);
        }
        if self.ballot.has_token(self.id) {
            return;
        }
        let bid = match (self.ballot.route(), self.recruit_rank()) {
            (_, None) => None,
            (Some((_, route)), Some(Rank::Redundant)) if !self.is_open(route) => {
                Some(self.recruit_bid(Rank::Obstructed, route.len()))
            }
            (Some((_, route)), Some(rank)) => Some(self.recruit_bid(rank, route.len())),
            (None, _) if !self.ballot.has_waited_for(2 * self.longest_wait()) => return,
            (None, _) => self.disconnected_bid(),
        };
        self.ballot.place(self.id, bid);
    }

    /// Whether it knows its way to the robot that calls. One that has restarted since it bid may not.
    pub(super) fn knows_route(&self) -> bool {
        self.ballot.route_of(self.notice_id()).is_some()
    }

    fn takes_part_in_elections(&self) -> bool {
        self.announcement().is_some_and(|announcement| announcement.roster.contains(self.id))
    }

    /// With which rank this robot may be recruited, if it may: where nothing depends on it but the caller.
    fn recruit_rank(&self) -> Option<Rank> {
        if !self.takes_part_in_elections() {
            return None;
        }
        match self.duty.is_redundant() {
            true => self.children().next().is_none().then_some(Rank::Redundant),
            false => self.bears_only_caller().then_some(Rank::ParentOfCaller),
        }
    }

    /// Whether this robot holds a plain post of the tree that bears nothing but the primary team, which
    /// calls for a recruit: the team can have its robot, and the post with it.
    fn bears_only_caller(&self) -> bool {
        let Notice::Call { caller, releases_leader: false } = *self.notice() else { return false };
        // One that is not heard may have attached to another robot since.
        let is_heard = self.neighbour(caller).is_some_and(|caller| !caller.is_silent());
        let bears = || self.children().map(Neighbour::id).eq([caller]);
        self.duty.location() == Activity::Relay && is_heard && bears()
    }

    /// Whether every robot on this way can go to the place ahead, whatever robots have stopped.
    fn is_open(&self, route: &[Hop]) -> bool {
        let goal = |hop: &Hop| match hop.post.is_primary() {
            true => hop.place.position,
            false => hop.place.reference,
        };
        let mut legs = route.windows(2).map(|pair| (pair[0].place.position, goal(&pair[1])));
        legs.all(|(from, to)| self.open_way(from, to).is_some())
    }

    /// The larger the residual, the better; ties go to the shorter path.
    fn recruit_bid(&self, rank: Rank, hops: usize) -> Bid {
        let merit = (self.routing.residual() / RESIDUAL_RESOLUTION).round() as i64;
        Bid { rank: rank as u8, merit, economy: -(hops as i64) }
    }

    /// The bid of a redundant robot that no tree connects to the caller.
    fn disconnected_bid(&self) -> Option<Bid> {
        let root = self.lineage()?.root();
        Some(Bid { rank: Rank::Disconnected as u8, merit: -(root as i64), economy: 0 })
    }

    /// Whether a bid is that of a robot that can come.
    pub(super) const fn can_come(bid: Bid) -> bool {
        bid.rank > Rank::Disconnected as u8
    }

    /// For how many rounds news may be under way, by the deepest place in a tree that it has heard of.
    pub(super) fn longest_wait(&self) -> usize {
        let depth = self.lineage().map_or(0, |way| way.hops());
        self.mission.notices().longest_wait().max(self.site.rounds_across(depth))
    }

    /// The way to the caller, through a tree neighbour that knows one; where the trees of two
    /// access points are not connected, through any link that may be built.
    fn find_route(&self, id: NoticeId) -> Option<Vec<Hop>> {
        let own = *self.duty.post()?;
        let known = |beacon: &Beacon| beacon.route.as_ref().is_some_and(|&(call, _)| call == id);
        let may_cross = self.ballot.has_waited_for(self.longest_wait() + 1);
        let joins = |neighbour: &Neighbour| match neighbour.post() {
            None => self.anchor_of(neighbour).is_some_and(|anchor| own.parent == Some(anchor)),
            Some(post) => {
                post.is_child_of(own.id)
                    || own.is_child_of(post.id)
                    || may_cross && !post.is_primary() && self.may_build(self.walk_to(neighbour))
            }
        };
        let via = self.neighbours.iter().find(|n| known(&n.beacon) && joins(n))?;
        let (_, onward) = via.beacon.route.as_ref()?;
        let mut route = Vec::with_capacity(onward.len() + 1);
        route.push(self.own_hop(via.beacon.crossing.clone())?);
        route.extend(onward.iter().cloned());
        Some(route)
    }
}
