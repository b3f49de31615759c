//! What the guards of a robot see: a few named quantities, measured from its own state.
//!
//! Numbers end here. The guards turn facts into events, and the tables of the role and mission
//! automata know events only. Yes-or-no facts are 0 or 1.

use pleach_discrete::network::Phase;
use pleach_guards::Valuation;

use super::super::beacon::Notice;
use super::super::duty::Duty;
use super::Robot;

macro_rules! facts {
    ($($(#[doc = $text:literal])+ $name:ident,)+) => {
        /// The quantities that a robot's guards may speak of.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct Facts {
            $($(#[doc = $text])+ pub $name: f64,)+
        }

        /// The names of the facts, in the order of their declaration.
        pub const VARIABLES: &[&str] = &[$(stringify!($name)),+];

        impl Valuation for Robot {
            fn value(&self, variable: &str) -> Option<f64> {
                match variable {
                    $(stringify!($name) => Some(self.facts.$name),)+
                    _ => None,
                }
            }
        }
    };
}

facts! {
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
    /// Every place of Σ has said whether it is a break point.
    points_agreed,
    /// Every member of the active subgroup has arrived.
    subgroup_arrived,
    /// This robot is the last that Σ relieves, and its post is held by another.
    relieved,
    /// The primary team is said to be the active team.
    resumed,
    /// The task is said to be serviced.
    service_announced,
    /// The mission is said to have ended.
    end_announced,
    /// The elected leader has past duties.
    bound,
    /// It is exchanging duties with another robot.
    engaged,
    /// This robot leads.
    leads,
    /// This robot is p₁.
    first,
    /// Control periods for which the primary team has stood still.
    still,
    /// Control periods after which a team that stands still is at a stationary point.
    window,
    /// Control periods for which this robot has been kept from going on, other than by its links.
    stalled,
    /// Control periods after which a robot that is kept from going on gives up.
    patience,
    /// A member of the team has room to move.
    slack,
    /// p₁ is still on its way to the robot that it joined.
    pending,
    /// Euclidean distance to the announced task.
    distance,
    /// The distance at which the leader stops.
    reach,
    /// δ: the distance that counts as servicing it.
    radius,
    /// This robot is the recruit on its way.
    recruited,
    /// It holds the post of a redundant robot.
    free,
    /// It holds a fixed post.
    fixed,
    /// It holds a post from which a task is serviced.
    serves,
    /// The number of branches that hang on its post.
    branches,
    /// It moves with a team, without a fixed post.
    underway,
    /// The post that it held last is held by another robot.
    replaced,
}

impl Robot {
    /// Measures the facts; says whether a guard may hold that did not hold before.
    pub fn measure(&mut self) -> bool {
        if !std::mem::take(&mut self.is_unmeasured) {
            return false;
        }
        let facts = self.facts_now();
        let may_jump = facts != self.facts || !self.is_quiet;
        self.facts = facts;
        self.is_quiet = true;
        may_jump
    }

    fn facts_now(&self) -> Facts {
        let yes = |holds: bool| if holds { 1.0 } else { 0.0 };
        let mut facts = Facts {
            window: f64::from(STATIONARY_WINDOW),
            patience: self.patience(),
            reach: self.reach(),
            radius: self.site.settings.service_radius,
            distance: f64::INFINITY,
            ..Facts::default()
        };
        self.measure_word(&mut facts);
        let best = self.election.as_ref().and_then(|election| election.best());
        let won = best.is_some_and(|(bid, robot)| robot == self.id && bid.rank > 0);
        let over =
            self.election.as_ref().is_some_and(|election| election.is_complete(&self.roster));
        facts.election_over = yes(over);
        match self.phase {
            Phase::RecruitElection => {
                facts.won = yes(over && won);
                let aided = best.is_some_and(|(bid, _)| bid.rank > 0);
                facts.unaided = yes(over && !aided && self.is_caller());
            }
            Phase::PathAgreement => facts.points_agreed = yes(self.break_points().is_some()),
            Phase::Shift => self.measure_shift(&mut facts),
            Phase::Advance => self.measure_team(&mut facts),
            _ => {}
        }
        facts.bound = yes(self.awaits_release);
        facts.engaged = yes(self.is_engaged());
        facts.leads = yes(self.leads());
        facts.recruited =
            yes(matches!(self.duty, Duty::Wait { place: 0, .. } | Duty::Shift { place: 0 }));
        facts.free = yes(self.duty.is_redundant());
        facts.fixed = yes(self.duty.is_fixed());
        facts.serves = yes(self.duty.post().is_some_and(|post| post.task.is_some()));
        facts.branches = self.branches() as f64;
        facts.underway = yes(self.duty.post().is_none() || self.duty.is_primary());
        facts.replaced = yes(self.left_post.is_none_or(|post| self.is_relieved_of(post)));
        facts
    }

    /// What the newest notice asks of this robot.
    fn measure_word(&self, facts: &mut Facts) {
        let number = self.bulletin.sequence();
        let election = self.election.as_ref().map(|election| election.number());
        let path = self.agreement.as_ref().map(|agreement| agreement.number());
        match self.bulletin.notice() {
            Notice::Task { .. } if election != Some(number) => facts.announced = 1.0,
            Notice::Call { .. } if election != Some(number) => facts.called = 1.0,
            Notice::Path(_) if path != Some(number) => facts.path_announced = 1.0,
            Notice::Advance { .. } => facts.resumed = 1.0,
            Notice::Serviced { .. } => facts.service_announced = 1.0,
            Notice::Ended { .. } => facts.end_announced = 1.0,
            _ => {}
        }
    }

    fn is_caller(&self) -> bool {
        matches!(*self.bulletin.notice(), Notice::Call { caller, .. } if caller == self.id)
    }

    fn measure_shift(&self, facts: &mut Facts) {
        match (self.subgroups.get(self.subgroup), self.duty, &self.path) {
            (Some(active), duty, _) => {
                if matches!(duty, Duty::Shift { .. }) && !self.has_arrived() {
                    facts.stalled = f64::from(self.still_periods);
                }
                let arrived = self
                    .agreement
                    .as_ref()
                    .is_some_and(|agreement| agreement.have_arrived(active.places()));
                facts.subgroup_arrived = if arrived { 1.0 } else { 0.0 };
            }
            (None, Duty::Wait { station, place }, Some(path))
                if place == path.last_break_point()
                    && (self.subgroups.is_empty() || self.is_relieved_of(station.post.id)) =>
            {
                facts.relieved = 1.0;
            }
            _ => {}
        }
    }

    fn measure_team(&self, facts: &mut Facts) {
        if let Some(team) = self.team {
            facts.still = f64::from(team.still);
            facts.slack = if team.slack.is_some() { 1.0 } else { 0.0 };
        }
        facts.first = if self.is_first() { 1.0 } else { 0.0 };
        facts.pending = if self.is_pending() { 1.0 } else { 0.0 };
        if facts.first > 0.0 && facts.slack + facts.pending > 0.0 {
            // Who has joined from afar hears nothing of the team until it is there; if it never
            // comes there, nobody else notices.
            facts.stalled = match self.team {
                Some(_) => facts.still,
                None => f64::from(self.still_periods),
            };
        }
        if self.duty.post().is_some_and(|post| post.is_leading())
            && let Some(task) = self.tasks.last()
        {
            facts.distance = (task.position - self.position).norm();
        }
    }

    /// Whether this robot has joined the team but the robot that it follows cannot hang on it
    /// yet.
    fn is_pending(&self) -> bool {
        let Some(own) = self.duty.post() else { return false };
        match *self.bulletin.notice() {
            Notice::Advance { joined: Some((newcomer, followed)) } if newcomer == own.id => self
                .holder(followed)
                .and_then(|neighbour| neighbour.post())
                .is_none_or(|post| !post.hangs_on(newcomer)),
            _ => false,
        }
    }
}

impl Robot {
    /// A robot on Σ may have to wait until the others of its subgroup have gone their way.
    pub(super) fn patience(&self) -> f64 {
        let walk = self.site.hard_length / self.site.settings.step_radius;
        PATIENCE * f64::from(STATIONARY_WINDOW).max(walk)
    }
}

/// How many times the longest regular wait a robot is patient.
const PATIENCE: f64 = 4.0;

/// Control periods without motion that make a stationary point.
pub(super) const STATIONARY_WINDOW: u32 = 8;
