//! What the guards of a robot see: named quantities and propositions, measured from its own state.
//!
//! Numbers end here. The guards turn what is measured into events, and the tables of the duty and
//! mission automata know events only.

use pleach_continuous::network::motion::FEASIBILITY_TOLERANCE;
use pleach_discrete::network::{Activity, MissionStep, NoticeId, Phase, Post};

use super::Robot;
use super::attachment::PATIENCE_WITH_UNUSED_POSTS;
use super::lineage::HeardWay;
use super::rounds::SweepRound;
use crate::network::beacon::Notice;
use crate::network::duty::{AwaitingRelease, Duty, Waiting};
use crate::network::scenario::RoutingMethod;

/// A robot gives up when it has made no progress for this many times the longest regular wait.
const PATIENCE: f64 = 4.0;

/// Control periods without motion that make a stationary point.
pub(super) const STATIONARY_WINDOW: u32 = 8;

macro_rules! facts {
    (
        quantities { $($(#[doc = $measure:literal])+ $quantity:ident,)+ }
        propositions { $($(#[doc = $text:literal])+ $name:ident,)+ }
        of the robot $robot:ident {
            quantities { $($(#[doc = $live_measure:literal])+ $live_quantity:ident: $number:expr,)+ }
            propositions { $($(#[doc = $live_text:literal])+ $live:ident: $holds:expr,)+ }
        }
    ) => {
        /// What a robot measures of itself once a round.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct Facts {
            $($(#[doc = $measure])+ pub $quantity: f64,)+
            $($(#[doc = $text])+ pub $name: bool,)+
        }

        crate::observed! {
            impl Observed for Robot as $robot;
            quantities {
                $($(#[doc = $measure])+ $quantity: $robot.changes.facts().$quantity,)+
                $($(#[doc = $live_measure])+ $live_quantity: $number,)+
            }
            propositions {
                $($(#[doc = $text])+ $name: $robot.changes.facts().$name,)+
                $($(#[doc = $live_text])+ $live: $holds,)+
            }
        }
    };
}

facts! {
    quantities {
        /// Control periods for which the primary team has stood still.
        still,
        /// Control periods after which a team that stands still is at a stationary point.
        window,
        /// Control periods without progress of this robot for another reason than its links.
        stalled,
        /// Control periods without progress after which a robot gives up.
        patience,
        /// Euclidean distance to the announced task.
        distance,
        /// The distance at which the leader stops.
        reach,
        /// δ: the distance that counts as servicing it.
        radius,
        /// The number of branches attached to its post.
        branches,
        /// How many links lead from the parent of p₁ to where its task is serviced from.
        links_left,
        /// How many links the primary team has, one for each member.
        members,
    }
    propositions {
        /// A task is announced whose election this robot has not begun.
        announced,
        /// The token of every robot of the roster is known.
        election_over,
        /// This robot won the recruit election.
        won,
        /// This robot called for a recruit, and none can come.
        unaided,
        /// A recruit is called for in an election that this robot has not begun.
        called,
        /// A path Σ is announced that this robot has not taken up.
        path_announced,
        /// Every place of Σ has voted whether it is a break point.
        points_agreed,
        /// Every member of the active subgroup has arrived, and the robot that it relieves gives its post
        /// up.
        subgroup_arrived,
        /// This robot is the last that Σ relieves, and its post is held by another.
        relieved,
        /// The newest notice says that the primary team is the active team.
        resumed,
        /// The newest notice says that the task is serviced.
        service_announced,
        /// The newest notice is of those who go on with the task that this robot has reached.
        service_unheard,
        /// The newest notice says that the mission has ended.
        end_announced,
        /// The newest notice follows from an announcement that it has not received, of another epoch.
        overtaken,
        /// Robots that it hears go by an announcement that it has not received.
        announcement_heard,
        /// This robot is p₁.
        first,
        /// A member of the team has room to move, or the leader is near enough where it is.
        slack,
        /// p₁ is still on its way to the robot that it joined.
        pending,
        /// p₁ hears a node that is nearer to its target than its parent, and that it may come to attach to.
        hears_nearer_parent,
        /// Redundant robots are attached to p₁ that have yet to leave it.
        bears_leavers,
        /// Its turn on Σ has come.
        may_set_out,
        /// Another parent in the tree is better than its own.
        finds_better_parent,
        /// It leads alone, and a fixed post has been attached to its own.
        burdened,
        /// It is the elected leader with past duties, and nothing depends on its post any more, or the post moves with it.
        may_leave_post,
        /// The task that is serviced from its post is over.
        task_closed,
        /// Tasks are over: a mission that has been given up may go on with the robots that they had.
        tasks_over,
    }
    of the robot robot {
        quantities {
            /// The number of branches attached to the post that it takes on Σ.
            branches_ahead: robot.coming_post().map_or(0, |post| robot.branches_of(post.id)) as f64,
            /// Control periods for which no branch has depended on its post.
            unused: f64::from(robot.tree.unused_periods()),
            /// Control periods after which a post without a branch is given up.
            unused_patience: f64::from(PATIENCE_WITH_UNUSED_POSTS),
            /// τ: seconds since the last sample.
            clock: robot.body.clock(),
            /// Δt: seconds from sample to sample.
            period: robot.site.settings.period,
            /// By how much it is outside of the region that it was given at the last sample.
            outside: robot.outside(),
            /// By how much rounding may take it outside.
            rounding: FEASIBILITY_TOLERANCE,
            /// The number of this round of beacons.
            round: robot.schedule.rounds().count() as f64,
            /// The number of rounds in this control period.
            rounds: robot.site.settings.rounds_per_period as f64,
        }
        propositions {
            /// Another node has begun the next control period.
            behind: robot.schedule.is_behind(),
            /// Its post has a parent, and it hears that or is not gone.
            names_parent: robot.tree.heard_way() != HeardWay::NoParent,
            /// Its parent tells a way to an access point that leads through its own post.
            hears_cycle: robot.tree.heard_way() == HeardWay::Cycle,
            /// Its parent tells a way, not through its own post, that is not the one it tells itself.
            hears_other_way: robot.tree.heard_way() == HeardWay::Other,
            /// It has been given the post of another robot in this jump.
            displaced: robot.tree.is_displaced(),
            /// It is exchanging duties with another robot.
            engaged: robot.is_engaged(),
            /// It is the elected leader.
            leads: robot.duty.leads(),
            /// It is the elected leader and has yet to be released from past duties.
            bound: robot.duty.is_bound(),
            /// It is the elected leader with past duties, and can service its task from its post.
            posted_near: robot.can_serve_from_post(),
            /// It holds the post of a redundant robot.
            free: robot.duty.is_redundant(),
            /// A task is serviced from its post.
            serves: robot.duty.post().is_some_and(|post| post.task.is_some()),
            /// It joins a mission under way, and has no post of its own yet.
            joins_late: robot.joins_late(),
            /// It has given its post up to the subgroup that relieves it.
            superfluous: robot.is_superfluous(),
            /// It holds a fixed post, or robots attached to it find no other parent.
            has_past_duties: robot.has_past_duties(),
            /// It may have made more offers to exchange duties, before it began, than it counts.
            has_forgotten_offers: robot.exchanges.forgotten_offers() > robot.offers().offers_made(),
            /// The leader election is over now, and it has won it.
            wins: robot.wins_now(),
            /// It learns in this jump that Σ passes its post.
            on_coming_path: robot.is_on_coming_path(),
            /// It learns in this jump that Σ is given up or done.
            called_off: robot.is_called_off(),
            /// It learns in this jump that another task is announced; or the mission is given up, and tasks have ended.
            superseded: robot.is_unbound(),
            /// It learns in this jump that the primary team is dissolved.
            dissolved: robot.is_dissolved(),
            /// It is relieved now of the last post of Σ, or bound to its post no more.
            is_relieved: robot.takes_step(MissionStep::Relieved) || robot.takes_step(MissionStep::Unbound),
            /// It takes the post ahead now.
            takes_post_ahead: robot.takes_post_ahead(),
            /// The post that it takes on Σ is that of a redundant robot.
            ahead_is_free: robot.coming_post().as_ref().is_some_and(Post::is_redundant),
            /// A task is serviced from the post that it takes on Σ.
            ahead_serves: robot.coming_post().is_some_and(|post| post.task.is_some()),
            /// A robot in its way is a partner for an exchange of duties.
            finds_partner: robot.exchanges.partner().is_some(),
            /// The partner has answered its offer.
            offer_answered: robot.answer_to_offer().is_some(),
            /// The partner has accepted its offer.
            offer_accepted: robot.answer_to_offer().is_some_and(|reply| reply.accepted.is_some()),
            /// Another robot has made it an offer that it has not answered.
            asked: robot.offer_to_answer().is_some(),
            /// It may leave its post to a mover.
            may_give: robot.may_be_relieved(),
            /// The mover has heard its reply.
            reply_heard: robot.is_reply_heard(),
            /// The mover that it has refused is gone.
            refused_gone: robot.refuses_gone_mover(),
            /// A control period begins, and the robot with which it exchanges duties is gone.
            partner_gone: robot.has_lost_partner(),
            /// The mission has ended, as far as it knows.
            mission_over: robot.phase() == Phase::Ended,
            /// A robot is still attached to the post that it has left, and to the robot itself.
            held_back: robot.is_held_by_old_news(),
            /// It stands in the way of a mover that cannot pass and asks for room.
            asked_for_way: robot.way_to_clear().is_some(),
            /// It is off the reference of its post.
            off_post: robot.is_off_post(),
            /// A mover is near.
            near_mover: robot.is_near_mover(),
            /// A subgroup of Σ is the active team.
            in_active_subgroup: robot.active_subgroup().is_some(),
            /// It is off the place ahead on Σ.
            off_place_ahead: robot.is_off_place_ahead(),
            /// It has yet to change over to another access point on its way, along Σ or to the team that it has joined.
            before_changeover: robot.is_before_changeover(),
            /// The primary team is the active team.
            advances: robot.phase() == Phase::Advance,
            /// Recruits are called for ahead of a standstill.
            eager: robot.is_eager(),
            /// A recruit is sought, or on its way.
            recruiting: robot.tree_is_frozen(),
            /// A recruit has been called for ahead of a standstill since one joined last, and none could come.
            in_vain: robot.mission.has_called_in_vain(),
            /// It leads with past duties, and nodes may yet become redundant.
            tree_settles: robot.awaits_retirements(),
            /// A redundant robot is attached to its post.
            bears_redundant: robot.bears_redundant(),
            /// This round of the iterations is for multipliers.
            hears_multipliers: robot.schedule.rounds().is_for_multipliers(),
            /// This iteration is the last of the control period.
            last_iteration: robot.schedule.rounds().is_last_of(robot.site.settings.routing_iterations),
            /// This round of a sweep is for demands.
            hears_demands: robot.schedule.rounds().of_sweep() == SweepRound::Demands,
            /// This round of a sweep is for flows.
            hears_flows: robot.schedule.rounds().of_sweep() == SweepRound::Flows,
            /// This round of a sweep is for shortages.
            hears_shortages: robot.schedule.rounds().of_sweep() == SweepRound::Shortages,
            /// This sweep is the last of the control period.
            last_sweep: robot.schedule.rounds().is_last_sweep(),
            /// The last requests for flows of the control period have been answered.
            last_answers: robot.schedule.rounds().is_last_of_reservation(),
            /// This round of the negotiation is for proposals.
            hears_proposals: robot.schedule.rounds().is_for_proposals(),
            /// Moves have been judged for the last time in this control period.
            last_attempt: robot.schedule.rounds().is_last_attempt(),
            /// Routes are found by ADAL.
            adal: robot.site.settings.routing_method == RoutingMethod::Adal,
            /// It exchanges duties now, and takes over that of a robot on standby.
            takes_standby: robot.takes_over(Activity::Standby),
            /// It exchanges duties now, and takes over that of a relay.
            takes_relay: robot.takes_over(Activity::Relay),
            /// It exchanges duties now, and takes over that of a junction.
            takes_junction: robot.takes_over(Activity::Junction),
            /// It exchanges duties now, and takes over that of a leaf.
            takes_leaf: robot.takes_over(Activity::Leaf),
            /// It exchanges duties now, and takes over that of a bound leader.
            takes_bound_leader: robot.takes_over(Activity::Bound),
            /// It exchanges duties now, and takes over that of a robot that waits on Σ.
            takes_waiting_on_the_path: robot.takes_over(Activity::Waiting),
            /// It exchanges duties now, and takes over that of a leader that awaits its release.
            takes_awaiting_release: robot.takes_over(Activity::AwaitingRelease),
            /// It exchanges duties now, and takes over that of a robot that shifts along Σ.
            takes_shifting_along_the_path: robot.takes_over(Activity::Shifting),
            /// It exchanges duties now, and takes over that of a member of the primary team.
            takes_following_the_team: robot.takes_over(Activity::Following),
            /// It exchanges duties now, and takes over that of the leader.
            takes_leading_the_team: robot.takes_over(Activity::Leading),
            /// It finds now that it has reached its task.
            reaches_task: robot.takes_step(MissionStep::Reached),
        }
    }
}

impl Robot {
    /// Measures the facts; returns whether a guard may hold that did not hold before.
    pub(super) fn measure(&mut self) -> bool {
        if !self.changes.measure() && self.caches() {
            debug_assert!(self.may_skip(Self::facts_stand), "robot {} goes by old facts", self.id);
            return false;
        }
        let facts = self.facts_now();
        let may_jump = self.changes.renew_facts(facts);
        let is_right = |robot: &Self| may_jump || robot.is_at_rest();
        debug_assert!(self.may_skip(is_right), "robot {} misses a transition", self.id);
        may_jump
    }

    pub(super) fn facts_now(&self) -> Facts {
        let mut facts = Facts {
            window: f64::from(STATIONARY_WINDOW),
            patience: self.patience(),
            reach: self.reach(),
            radius: self.site.settings.arrival_radius(),
            distance: f64::INFINITY,
            ..Facts::default()
        };
        self.measure_notice(&mut facts);
        let best = self.ballot.best();
        let won = best.is_some_and(|(bid, robot)| robot == self.id && Robot::can_come(bid))
            && self.knows_route();
        let over = self.election_is_over();
        facts.election_over = over;
        match self.phase() {
            Phase::RecruitElection => {
                facts.won = over && won;
                let aided = best.is_some_and(|(bid, _)| Robot::can_come(bid));
                facts.unaided = over && !aided && self.is_caller();
            }
            Phase::PathAgreement => facts.points_agreed = self.break_points().is_some(),
            Phase::Shift => self.measure_shift(&mut facts),
            Phase::Advance => self.measure_team(&mut facts),
            _ => {}
        }
        if self.phase() == Phase::Advance || self.goes_on_while_recruiting() {
            self.measure_distance(&mut facts);
        }
        facts.branches = self.branches() as f64;
        facts.may_set_out = self.may_set_out();
        facts.finds_better_parent = self.finds_better_parent();
        facts.burdened = self.is_burdened();
        facts.may_leave_post =
            self.is_bound_to_unused_post() || self.duty.is_bound() && self.takes_post_along();
        facts.tasks_over = !self.mission.notices().closed().is_empty();
        facts.task_closed = self.services_closed_task();
        facts
    }

    /// What the newest notice asks of this robot.
    fn measure_notice(&self, facts: &mut Facts) {
        let id = self.notice_id();
        let election = self.ballot.election().map(|election| election.id());
        let path = self.ballot.agreement().map(|agreement| agreement.id());
        // One that pursues no task has none to give up.
        let is_overtaken = id.epoch() > self.mission.epoch() && self.phase() != Phase::Idle;
        match self.notice() {
            Notice::Ended { .. } => facts.end_announced = true,
            Notice::Task(_) if election != Some(id) => facts.announced = true,
            _ if is_overtaken => facts.overtaken = true,
            Notice::Call { .. } | Notice::Path(_) | Notice::Advance { .. }
                if self.has_reached_pursued_task() =>
            {
                facts.service_unheard = true;
            }
            _ if self.newer_announcement().is_some() => facts.announcement_heard = true,
            Notice::Call { .. } if election != Some(id) => facts.called = true,
            Notice::Path(_) if path != Some(id) => facts.path_announced = true,
            Notice::Advance { .. } => facts.resumed = true,
            Notice::Serviced { .. } => facts.service_announced = true,
            _ => {}
        }
    }

    /// Whether it has reached its task by the announcement that it goes by.
    pub(super) fn has_reached_task(&self) -> bool {
        let pursued = self.mission.notices().announcement_id();
        pursued.is_some() && self.mission.accomplished() == pursued
    }

    /// Whether it has reached the task that others pursue, and has said so.
    fn has_reached_pursued_task(&self) -> bool {
        let is_latest = |id: NoticeId| id.epoch() == self.notice_id().epoch();
        self.phase() == Phase::Idle
            && self.has_reached_task()
            && self.mission.accomplished().is_some_and(is_latest)
    }

    /// Whether the token of every robot of the roster is known. A robot that has joined since the task
    /// was announced cannot tell before it knows the roster; and the roster of a task that is announced again
    /// is not that of the elections before.
    pub(super) fn election_is_over(&self) -> bool {
        let (Some(election), Some((id, announcement))) =
            (self.ballot.election(), self.mission.notices().announced())
        else {
            return false;
        };
        let roster = &announcement.roster;
        let is_theirs = election.id().epoch() == id.epoch() && !roster.is_empty();
        is_theirs && election.is_complete(roster)
    }

    pub(super) fn is_caller(&self) -> bool {
        matches!(*self.notice(), Notice::Call { caller, .. } if caller == self.id)
    }

    fn measure_shift(&self, facts: &mut Facts) {
        let Some(shift) = self.mission.shift() else { return };
        match (shift.active(), &*self.duty) {
            (Some(active), duty) => {
                if matches!(duty, Duty::Shifting(_)) && !self.has_arrived() {
                    facts.stalled = f64::from(self.body.still_periods());
                }
                facts.subgroup_arrived =
                    self.knows_arrived(active) && self.has_given_up(active.end);
            }
            (
                None,
                Duty::Waiting(Waiting { held, place, .. })
                | Duty::AwaitingRelease(AwaitingRelease { held, place }),
            ) => {
                let is_alone = shift.subgroups.is_empty() && !self.is_being_given_duty();
                facts.relieved = *place == shift.path.last_break_point()
                    && (is_alone || self.is_relieved_of(held.station.post.id));
            }
            _ => {}
        }
    }

    fn measure_team(&self, facts: &mut Facts) {
        if let Some(team) = self.mission.team().report() {
            facts.still = f64::from(team.still);
            facts.slack = team.slack.is_some();
        }
        facts.first = self.is_first();
        facts.pending = self.is_pending();
        if facts.first {
            // A robot that has joined from afar hears nothing of the team until it is there; if it
            // never arrives, no other robot notices. Nor does one where the leader has been cut off, and is
            // attached elsewhere by now.
            facts.stalled = match self.mission.team().report() {
                Some(_) if facts.slack || facts.pending => facts.still,
                Some(_) => 0.0,
                None => f64::from(self.body.still_periods()),
            };
        }
        if facts.first
            && self.is_eager()
            && let Some((links, members)) = self.links_left()
        {
            (facts.links_left, facts.members) = (links, members);
            facts.hears_nearer_parent = self.hears_nearer_parent();
            facts.bears_leavers = self.bears_redundant();
        }
    }

    fn measure_distance(&self, facts: &mut Facts) {
        if self.duty.post().is_some_and(|post| post.is_leading())
            && let Some(distance) = self.distance_to_task()
        {
            facts.distance = distance;
        }
    }

    /// Control periods without progress after which the robot gives up. The longest regular wait is the window of a
    /// stationary point or the way along one link: a robot on Σ may wait until the others of its subgroup have gone
    /// theirs.
    pub(super) fn patience(&self) -> f64 {
        let walk = self.hard_length() / self.site.settings.step_radius;
        PATIENCE * f64::from(STATIONARY_WINDOW).max(walk)
    }

    /// Whether this robot has joined the team but the robot that it follows cannot attach to it
    /// yet.
    pub(super) fn is_pending(&self) -> bool {
        let Some(own) = self.duty.post() else { return false };
        match *self.notice() {
            Notice::Advance { joined: Some((newcomer, followed)) } if newcomer == own.id => self
                .holder(followed)
                .and_then(|neighbour| neighbour.post())
                .is_none_or(|post| !post.is_child_of(newcomer)),
            _ => false,
        }
    }
}
