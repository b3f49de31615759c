//! The robot's part in the mission: elections, the path Σ, its agreements, and the teams.
//!
//! The mission automaton decides *when* each of these steps is taken; its table and guards are in
//! [`crate::network::automata`]. The functions here are what its transitions do.

use std::sync::Arc;

use pleach_discrete::network::path::{Ties, subgroups};
use pleach_discrete::network::{
    Agreement, Anchor, Bid, Election, IdSet, NodeId, Phase, PostId, PostKind, Subgroup,
};

use super::super::beacon::{Beacon, Notice, TeamReport};
use super::super::duty::{Duty, Hop, Path, Place, Station};
use super::super::record::{MissionEvent, Outcome};
use super::super::shared::Shared;
use super::hearing::Neighbour;
use super::{Robot, TaskNotice};

/// Distances in bids are compared in units of this share of the full range l: finer differences
/// are ties, which go to the higher index.
const BID_RESOLUTION: f64 = 1e-6;
/// Residuals in bids are compared in units of this: routes aim at the same reserve everywhere,
/// and what is left of differences is the dual iteration's noise.
const RESIDUAL_RESOLUTION: f64 = 1e-3;
/// The leader stops at δ − 2.2ρ from its task, so that a robot 2ρ behind it is within δ as well.
const STAND_OFF: f64 = 2.2;
/// A replacer stands this many ρ beside the robot that it relieves.
const BESIDE: f64 = 2.1;
/// How near to a target that it cannot get closer to a leader goes, as a share of ρ.
const TOUCH: f64 = 0.1;
/// A member of the primary team this many ρ behind the next is bunched: more room would not help.
const BUNCHED: f64 = 2.6;
/// A link shorter than this share of d_build is slack.
const SLACK: f64 = 0.95;

impl Robot {
    /// Takes the maximum of what it knows of the mission and what its neighbours say.
    pub fn hear_word(&mut self) {
        let newest = self
            .neighbours
            .iter()
            .map(|neighbour| &neighbour.beacon.bulletin)
            .max_by_key(|bulletin| bulletin.sequence());
        if let Some(newest) = newest
            && newest.sequence() > self.bulletin.sequence()
        {
            self.bulletin = newest.clone();
        }
        for neighbour in &self.neighbours {
            if let (Some(own), Some(heard)) = (&mut self.election, &neighbour.beacon.election) {
                own.merge(heard);
            }
            if let (Some(own), Some(heard)) = (&mut self.agreement, &neighbour.beacon.agreement) {
                own.merge(heard);
            }
        }
        match self.phase {
            Phase::RecruitElection => self.answer_call(),
            Phase::Shift => self.walk_path(),
            _ => {}
        }
        self.review_team();
    }

    fn issue(&mut self, notice: Notice) {
        self.bulletin = Shared::new(self.bulletin.next(notice));
    }

    // ---- Leader election (Algorithm 1) -------------------------------------------------------

    /// A task is announced: place a bid for it (Remark 5.3).
    pub fn begin_leader_election(&mut self) {
        // A released leader may service its task at once: the others then hear of the next task
        // before they have heard that the team advances.
        self.resume();
        self.leave_team();
        self.awaits_release = false;
        self.path = None;
        self.agreement = None;
        self.route = None;
        let bulletin = self.bulletin.clone();
        let Notice::Task { task, position, roster, eligible } = bulletin.notice() else { return };
        let (task, position) = (*task, *position);
        self.roster = Arc::clone(roster);
        self.eligible = Arc::clone(eligible);
        let target = self.site.free_space.nearest(position);
        if self.tasks.last().is_none_or(|known| known.number != task) {
            self.tasks.push(TaskNotice { number: task, position, target });
        }
        let competes =
            self.lineage.as_ref().is_some_and(|lineage| self.eligible.contains(lineage.root()));
        let mut election = Election::new(self.bulletin.sequence());
        election.place(self.id, competes.then(|| self.leader_bid()).flatten());
        self.election = Some(election);
    }

    /// The nearer to the task along the geodesic, the better; none if the task is out of reach.
    fn leader_bid(&self) -> Option<Bid> {
        let task = self.tasks.last()?;
        let gap = (task.target - task.position).norm();
        let distance = self.site.free_space.distance(self.position, task.target);
        let unit = BID_RESOLUTION * self.site.build_length;
        let within_reach = gap <= self.site.settings.service_radius && distance.is_finite();
        within_reach.then(|| Bid {
            rank: if self.could_be_relieved() { 1 } else { 0 },
            merit: -(distance / unit).round() as i64,
            economy: 0,
        })
    }

    /// Whether another robot beside this one could service its task as well, so that it can be
    /// relieved of it: not where the task lies so deep in a wall that only one comes near enough.
    fn could_be_relieved(&self) -> bool {
        let task = self.duty.post().and_then(|post| post.task);
        task.and_then(|task| self.task_position(task)).is_none_or(|place| {
            let away = (self.position - place).norm();
            away.hypot(BESIDE * self.clearance()) <= self.site.settings.service_radius
        })
    }

    /// Every token is known: the winner leads, at once or after it has been released.
    pub fn conclude_leader_election(&mut self) {
        if self.winner() != Some(self.id) {
            return;
        }
        let conflict =
            !self.duty.is_redundant() || self.children().any(|child| !child.beacon.can_detach);
        if let Some(station) = self.duty.station_mut() {
            match (conflict, station.post.kind) {
                (false, _) => station.post.kind = PostKind::Primary { follows: None },
                (true, PostKind::Redundant) => station.post.kind = PostKind::Fixed,
                (true, _) => {}
            }
        }
        if let Some(task) = self.tasks.last().map(|task| task.number) {
            self.report(MissionEvent::LeaderElected { task, robot: self.id, conflict });
        }
        self.awaits_release = conflict;
        self.still_periods = 0;
        if !conflict {
            self.issue(Notice::Advance { joined: None });
        }
    }

    /// Who won the election that this robot takes part in, as far as it knows.
    pub(super) fn winner(&self) -> Option<NodeId> {
        self.election.as_ref()?.best().map(|(_, robot)| robot)
    }

    // ---- Recruit election (Remark 5.4) -------------------------------------------------------

    /// p₁ is stuck, or the leader has past duties: call for a recruit.
    pub fn call_for_recruit(&mut self) {
        if !self.awaits_release {
            self.report(MissionEvent::Stationary { robot: self.id, team: Vec::new() });
        }
        self.issue(Notice::Call { caller: self.id, releases_leader: self.awaits_release });
        self.begin_recruit_election();
    }

    /// A recruit is called for.
    pub fn begin_recruit_election(&mut self) {
        let number = self.bulletin.sequence();
        self.election = Some(Election::new(number));
        self.waited_rounds = 1;
        self.route = None;
        if matches!(*self.bulletin.notice(), Notice::Call { caller, .. } if caller == self.id) {
            self.route = self.own_hop(Vec::new()).map(|hop| (number, Shared::new(vec![hop])));
        }
        self.answer_call();
    }

    fn own_hop(&self, crossing: Vec<usize>) -> Option<Hop> {
        let station = self.duty.station()?;
        let place = Place { reference: station.reference, position: self.position };
        Some(Hop { robot: self.id, post: station.post, place, crossing })
    }

    /// Counts one more round of an election of a recruit; says whether a wait is over, so that the
    /// robot may do what it might not do before.
    pub(super) fn count_round(&mut self) -> bool {
        if self.phase != Phase::RecruitElection {
            return false;
        }
        self.waited_rounds += 1;
        self.waited_rounds == self.longest_wait() + 1
            || self.waited_rounds == 2 * self.longest_wait()
    }

    /// Finds the way over the tree to the caller (footnote 10) and places a token: redundant
    /// robots on which nobody hangs with a bid, once they know the way.
    fn answer_call(&mut self) {
        let number = self.bulletin.sequence();
        let Some(election) = &self.election else { return };
        if election.number() != number {
            return;
        }
        if self.route.as_ref().is_none_or(|&(known, _)| known != number) {
            self.route = self.find_route(number).map(|route| (number, Shared::new(route)));
        }
        let bid = match &self.route {
            _ if !self.duty.is_redundant() || self.children().next().is_some() => None,
            Some((_, route)) => Some(self.recruit_bid(route.len())),
            None if self.waited_rounds < 2 * self.longest_wait() => return,
            None => self.stranded_bid(),
        };
        if let Some(election) = &mut self.election {
            election.place(self.id, bid);
        }
    }

    /// The larger the residual, the better; ties go to the shorter path.
    fn recruit_bid(&self, hops: usize) -> Bid {
        let merit = (self.residual / RESIDUAL_RESOLUTION).round() as i64;
        Bid { rank: 1, merit, economy: -(hops as i64) }
    }

    /// A redundant robot that no tree connects to the caller only says where it could help.
    fn stranded_bid(&self) -> Option<Bid> {
        let root = self.lineage.as_ref()?.root();
        Some(Bid { rank: 0, merit: -(root as i64), economy: 0 })
    }

    /// No message is longer under way than there are robots to pass it on.
    fn longest_wait(&self) -> usize {
        self.site.robots + self.site.access_points.len()
    }

    /// The way to the caller, through a tree neighbour that knows one; where the trees of two
    /// access points are not connected, through any link that may be built.
    fn find_route(&self, number: u32) -> Option<Vec<Hop>> {
        let own = *self.duty.post()?;
        let known = |beacon: &Beacon| beacon.route.as_ref().is_some_and(|&(at, _)| at == number);
        let may_cross = self.waited_rounds > self.longest_wait();
        let joins = |neighbour: &Neighbour| match neighbour.post() {
            None => own.parent == Some(Anchor::Access(neighbour.id() - self.site.robots)),
            Some(post) => {
                post.hangs_on(own.id)
                    || own.hangs_on(post.id)
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

    /// The recruit announces the path Σ that it has found.
    pub fn announce_path(&mut self) {
        let Notice::Call { releases_leader, .. } = *self.bulletin.notice() else { return };
        let Some((_, hops)) = self.route.take() else { return };
        let path = Path { hops: hops.to_vec(), releases_leader };
        self.issue(Notice::Path(Arc::new(path)));
        self.begin_path();
    }

    /// The caller finds that nobody can be recruited: other trees may try, or the mission ends.
    pub fn end_unaided(&mut self) {
        let stranded = self.election.as_ref().and_then(Election::best).is_some();
        let Some(task) = self.tasks.last().copied() else { return };
        let own_root = self.lineage.as_ref().map(|lineage| lineage.root());
        let others: IdSet = self.eligible.iter().filter(|&root| Some(root) != own_root).collect();
        if stranded && !others.is_empty() {
            let roster = Arc::clone(&self.roster);
            self.report(MissionEvent::ElectionRepeated { task: task.number });
            self.issue(Notice::Task {
                task: task.number,
                position: task.position,
                roster,
                eligible: Arc::new(others),
            });
            return;
        }
        let wanted = (self.remaining() / self.site.build_length).ceil().max(1.0);
        let reason = format!(
            "task {} needs another recruit, and no redundant robot is left that can come; about \
             {wanted} more robots are needed",
            task.number
        );
        self.issue(Notice::Ended {
            outcome: Outcome::InsufficientRobots,
            reason: reason.into(),
            task: Some(task.number),
        });
    }

    // ---- The path Σ and its subgroups (Sec. V-B, V-C) ----------------------------------------

    /// The path Σ is known: its members say whether they are break points.
    pub fn begin_path(&mut self) {
        let Notice::Path(path) = self.bulletin.notice() else { return };
        let path = Arc::clone(path);
        let mut agreement = Agreement::new(self.bulletin.sequence());
        self.subgroups.clear();
        self.subgroup = 0;
        if let Some(&station) = self.duty.station()
            && let Some(place) = path.place_of(station.post.id)
        {
            let ties = Ties {
                services_task: station.post.task.is_some(),
                bears_others: self.has_ties_off(&path),
            };
            agreement.vote(place, path.is_break_point(place, ties));
            if place <= path.last_break_point() {
                self.duty = Duty::Wait { station, place };
            }
        }
        self.agreement = Some(agreement);
        self.path = Some(path);
    }

    /// Whether this robot has a neighbour in the tree that is not on the path.
    fn has_ties_off(&self, path: &Path) -> bool {
        let parent_off = self.anchor().is_some_and(|anchor| !path.passes(anchor));
        let child_off = self
            .children()
            .filter_map(Neighbour::post)
            .any(|post| path.place_of(post.id).is_none());
        parent_off || child_off
    }

    pub(super) fn break_points(&self) -> Option<Vec<usize>> {
        self.agreement.as_ref()?.break_points(self.path.as_ref()?.len())
    }

    /// The break points are agreed: every robot computes the same subgroups.
    pub fn form_subgroups(&mut self) {
        let Some(points) = self.break_points() else { return };
        self.subgroups = subgroups(&points).collect();
        self.subgroup = 0;
        if let (Duty::Wait { place: 0, .. }, Some(path)) = (&self.duty, &self.path) {
            let robots: Vec<_> = path.hops.iter().map(|hop| hop.robot).collect();
            let break_points = points.iter().map(|&place| robots[place]).collect();
            self.report(MissionEvent::RecruitElected {
                robot: self.id,
                path: robots,
                break_points,
            });
        }
        self.walk_path();
    }

    /// The subgroup that is the active team, while one is.
    pub(super) fn active_subgroup(&self) -> Option<Subgroup> {
        (self.phase == Phase::Shift).then(|| self.subgroups.get(self.subgroup).copied())?
    }

    /// Sets out when it is this robot's turn, and says so when it has arrived.
    fn walk_path(&mut self) {
        let Some(active) = self.subgroups.get(self.subgroup).copied() else { return };
        if let Duty::Wait { station, place } = self.duty
            && active.places().contains(&place)
            && (place == 0 || place > active.first || self.is_relieved_of(station.post.id))
        {
            if place == active.first {
                let robots = self.robots_at(active);
                self.report(MissionEvent::SubgroupStarted { subgroup: self.subgroup, robots });
            }
            // The recruit's own place is given up; every other is taken over by the robot behind.
            self.left_post = (place > 0).then_some(station.post.id);
            self.duty = Duty::Shift { place };
            self.still_periods = 0;
        }
        if let Duty::Shift { place } = self.duty
            && self.has_arrived()
            && let Some(agreement) = &mut self.agreement
        {
            agreement.arrive(place);
        }
    }

    /// The robots that stood at the places of a subgroup when Σ was announced.
    fn robots_at(&self, subgroup: Subgroup) -> Vec<NodeId> {
        let hops = self.path.as_ref().and_then(|path| path.hops.get(subgroup.places()));
        hops.into_iter().flatten().map(|hop| hop.robot).collect()
    }

    /// Whether another robot holds `post`.
    pub(super) fn is_relieved_of(&self, post: PostId) -> bool {
        self.holder(post).is_some()
    }

    /// The place that this robot goes to along Σ.
    pub(super) fn next_hop(&self) -> Option<&Hop> {
        match self.duty {
            Duty::Shift { place } => self.path.as_ref()?.hops.get(place + 1),
            _ => None,
        }
    }

    /// Every member of the active subgroup has arrived: each takes the post it has come to.
    pub fn take_posts(&mut self) {
        let Some(active) = self.subgroups.get(self.subgroup).copied() else { return };
        if let Duty::Shift { place } = self.duty
            && active.places().contains(&place)
        {
            if place == active.first {
                let robots = self.robots_at(active);
                self.report(MissionEvent::SubgroupArrived { subgroup: self.subgroup, robots });
            }
            self.take_post_ahead();
        }
        self.subgroup += 1;
        self.walk_path();
    }

    fn take_post_ahead(&mut self) {
        if let Some(hop) = self.next_hop() {
            // A plain node that queues behind the next member makes its place where it stands.
            let place = hop.place.reference;
            let radius = self.site.settings.service_radius;
            let queues = (self.position - place).norm() > radius;
            let reference = if queues { self.position } else { place };
            let station = Station { post: hop.post, reference };
            self.duty = Duty::Hold(station);
            self.left_post = None;
        }
    }

    /// The last robot that Σ relieves joins the primary team, or leads it.
    pub fn join_team(&mut self) {
        let (Some(path), Some(&station)) = (self.path.clone(), self.duty.station()) else { return };
        let follows = match path.hops.last() {
            Some(last) if !path.releases_leader => Some(last.post.id),
            _ => None,
        };
        let parent = match self.subgroups.is_empty() {
            true => station.post.parent,
            false => Some(Anchor::Post(station.post.id)),
        };
        let id = PostId((self.site.robots as u32) + self.bulletin.sequence());
        let mut post = pleach_discrete::network::Post::redundant(id);
        post.kind = PostKind::Primary { follows };
        post.parent = parent;
        self.left_post = (!self.subgroups.is_empty()).then_some(station.post.id);
        self.duty = Duty::Hold(Station { post, reference: self.position });
        self.still_periods = 0;
        self.awaits_release = false;
        self.report(match follows {
            Some(_) => MissionEvent::JoinedPrimary { robot: self.id, team: Vec::new() },
            None => MissionEvent::Released { robot: self.id },
        });
        self.issue(Notice::Advance { joined: follows.map(|follows| (id, follows)) });
        self.resume();
    }

    /// The primary team is the active team again.
    pub fn resume(&mut self) {
        match self.duty {
            Duty::Shift { .. } => self.take_post_ahead(),
            Duty::Wait { station, .. } => self.duty = Duty::Hold(station),
            Duty::Hold(_) => {}
        }
        self.subgroups.clear();
        self.still_periods = 0;
    }

    // ---- The primary team (Sec. V-A) ---------------------------------------------------------

    /// Whether this robot heads the network's effort, released or not.
    pub fn leads(&self) -> bool {
        self.awaits_release || self.duty.post().is_some_and(|post| post.is_leading())
    }

    /// Whether this robot is p₁: nobody of the team follows it.
    pub(super) fn is_first(&self) -> bool {
        let Some(post) = self.duty.post().filter(|post| post.is_primary()) else { return false };
        let follower = PostKind::Primary { follows: Some(post.id) };
        let told = matches!(*self.bulletin.notice(),
            Notice::Advance { joined: Some((_, followed)) } if followed == post.id);
        !told && !self.neighbours.iter().any(|n| n.post().is_some_and(|p| p.kind == follower))
    }

    /// The post of a newcomer that this robot should hang on but does not yet reach.
    pub(super) fn awaited_parent(&self) -> Option<PostId> {
        let post = self.duty.post()?;
        match *self.bulletin.notice() {
            Notice::Advance { joined: Some((newcomer, followed)) }
                if followed == post.id && !post.hangs_on(newcomer) =>
            {
                Some(newcomer)
            }
            _ => None,
        }
    }

    /// ψ of a member of the primary team, eq. (24).
    pub(super) fn team_goal(&self) -> Option<pleach_continuous::Point> {
        match self.duty.post()?.kind {
            PostKind::Primary { follows: None } => self.tasks.last().map(|task| task.target),
            PostKind::Primary { follows: Some(ahead) } => match self.holder(ahead) {
                Some(neighbour) => Some(neighbour.position()),
                // Not heard yet: where it stood when it called.
                None => self.path.as_ref()?.hops.last().map(|hop| hop.place.position),
            },
            _ => None,
        }
    }

    /// The distance from the announced task at which the leader stops.
    pub(super) fn reach(&self) -> f64 {
        let settings = &self.site.settings;
        let gap = self.tasks.last().map_or(0.0, |task| (task.target - task.position).norm());
        let stand_off = settings.service_radius - STAND_OFF * settings.clearance;
        stand_off.max(gap + TOUCH * settings.clearance).min(settings.service_radius)
    }

    /// What the team knows of itself, from the leader back to this robot.
    fn review_team(&mut self) {
        self.team = None;
        if self.phase != Phase::Advance || !self.duty.is_primary() {
            return;
        }
        let own_slack = self.is_slack().then_some(self.id);
        let still = self.still_periods;
        self.team = match self.duty.post().map(|post| post.kind) {
            Some(PostKind::Primary { follows: Some(ahead) }) => {
                self.holder(ahead).and_then(|n| n.beacon.team).map(|front| TeamReport {
                    still: front.still.min(still),
                    slack: front.slack.or(own_slack),
                    ..front
                })
            }
            _ => Some(TeamReport { still, slack: own_slack, remaining: self.remaining() }),
        };
    }

    /// Geodesic distance to the announced task.
    pub(super) fn remaining(&self) -> f64 {
        self.tasks
            .last()
            .map_or(0.0, |task| self.site.free_space.distance(self.position, task.target))
    }

    /// Whether the robot has room to move: its link is neither at its limit nor is it bunched.
    fn is_slack(&self) -> bool {
        let bound = self
            .anchor()
            .and_then(|anchor| self.bearer(anchor))
            .is_none_or(|parent| self.walk_to(parent) >= SLACK * self.site.build_length);
        let bunched = || {
            self.team_goal()
                .is_none_or(|goal| (goal - self.position).norm() <= BUNCHED * self.clearance())
        };
        !bound && (self.leads() || !bunched())
    }

    /// The leader is within reach of its task.
    pub fn service_task(&mut self) {
        let Some(task) = self.tasks.last().map(|task| task.number) else { return };
        self.leave_team();
        if let Some(station) = self.duty.station_mut() {
            station.post.task = Some(task);
        }
        self.report(MissionEvent::TaskServiced { task, robot: self.id });
        self.issue(Notice::Serviced { task });
    }

    /// The team is dissolved: its posts become fixed where they are.
    pub fn leave_team(&mut self) {
        let position = self.position;
        if let Some(station) = self.duty.station_mut()
            && station.post.is_primary()
        {
            station.post.kind = PostKind::Fixed;
            station.reference = position;
        }
        if let Duty::Wait { station, .. } = self.duty {
            self.duty = Duty::Hold(station);
        }
    }

    /// The active team cannot go on, and a recruit would not help.
    pub fn end_blocked(&mut self) {
        let task = self.tasks.last().map(|task| task.number);
        let reason = match (self.duty.place(), self.team.and_then(|team| team.slack)) {
            (Some(_), _) => format!(
                "robot {} cannot get to the place of Σ that it should take: something stands in \
                 its way",
                self.id
            ),
            (None, Some(slack)) => format!(
                "the primary team stands still although robot {slack} has room on its link: \
                 something stands in its way, and a recruit would not help"
            ),
            (None, None) => format!(
                "robot {} has joined the primary team but cannot reach the robot that it follows",
                self.id
            ),
        };
        self.issue(Notice::Ended { outcome: Outcome::Blocked, reason: reason.into(), task });
    }
}
