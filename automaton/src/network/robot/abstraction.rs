//! The robot without its continuous side, for exhaustive exploration.
//!
//! Between two jumps of the discrete protocol the flow carries a robot somewhere, and time
//! passes. An explorer does not follow the flow. It chooses what may come of it: where the robot
//! stands, and for how long it has made no progress. Everything else is the robot itself.
//! [`Robot::account`] says which robots an explorer need not tell apart.

use std::collections::BTreeSet;
use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{Bid, IdSet, NodeId, NoticeId, PostId, Subgroup};

use super::facts::STATIONARY_WINDOW;
use super::hearing::PATIENCE_WITH_CHILDREN;
use super::{FIRST_NEW_POST, POSTS_OF_A_PERIOD, Robot, RobotError, RobotView};
use crate::network::beacon::Beacon;
use crate::network::duty::Path;
use crate::network::roll::{Roll, Wreck};

/// Where control periods count, confirmations that are older than this many count as this old: robots
/// that have had none for so long are cut off, and look in vain.
const OLDEST_CONFIRMATION: u32 = 30;

/// The numbers of control periods when another one has begun.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Numbers {
    /// The number of the one that has begun.
    pub now: u32,
    /// By how much those before it are smaller than they were.
    pub passed: u32,
}

impl Numbers {
    /// The number of a control period; one that is `oldest` or more periods old is just as old.
    pub(crate) fn of(self, period: u32, oldest: u32) -> u32 {
        period.saturating_sub(self.passed).max(self.now.saturating_sub(oldest))
    }
}

/// What an explorer reads from a robot in addition to what observers see.
impl<'a> RobotView<'a> {
    /// The beacon that the robot would send now, without what matters only when time passes or for motion.
    pub fn beacon(self) -> Beacon {
        Beacon {
            strays: Arc::default(),
            serves: Arc::default(),
            branches: Arc::default(),
            ..self.robot().public_state()
        }
    }

    /// The beacon that the robot sends where control periods count. Where bodies are is left out: it matters
    /// for motion alone.
    pub fn beacon_in_time(self) -> Beacon {
        let beacon = self.robot().public_state();
        let named = |wreck: &Wreck| Wreck::heard(wreck.robot, Point::origin(), 0);
        let wrecks = Arc::new(beacon.wrecks.iter().map(named).collect());
        Beacon { wrecks, branches: Arc::default(), ..beacon }
    }

    /// Whether it may leave its place in this control period.
    pub fn may_leave_place(self) -> bool {
        self.robot().may_leave_place()
    }

    /// Whether it holds, or has just left, a post that was made in this control period.
    pub fn has_made_post(self) -> bool {
        let robot = self.robot();
        let held = robot.duty.post().map(|post| post.id).into_iter().chain(robot.duty.left());
        let made_in = |post: PostId| {
            let number = post.0.checked_sub(FIRST_NEW_POST)?;
            Some(number / (POSTS_OF_A_PERIOD * robot.site.robots as u32))
        };
        held.into_iter().any(|post| made_in(post) == Some(robot.schedule.period()))
    }

    /// The robots that are gone, as far as it knows.
    pub fn gone(self) -> &'a IdSet {
        &self.robot().membership.roll().absent.gone
    }

    /// The path Σ that was announced last.
    pub fn path(self) -> Option<&'a Path> {
        self.robot().mission.path().map(|path| &**path)
    }

    /// The subgroups that it has computed from the break points.
    pub fn subgroups(self) -> &'a [Subgroup] {
        self.robot().mission.shift().map_or(&[], |shift| &shift.subgroups)
    }

    /// The election that it knows to be over, and the winner with its bid.
    pub fn concluded_election(self) -> Option<(NoticeId, Option<(Bid, NodeId)>)> {
        let election = self.robot().ballot.election()?;
        self.robot().election_is_over().then(|| (election.id(), election.best()))
    }

    /// The election that it takes part in, or took part in last.
    pub fn election(self) -> Option<NoticeId> {
        self.robot().ballot.election().map(|election| election.id())
    }

    /// What it has bid itself in this election, if it has taken part in it and in none since.
    pub fn own_bid(self, election: NoticeId) -> Option<Bid> {
        self.robot().ballot.bid().filter(|_| self.election() == Some(election))
    }

    /// The number of control periods without progress.
    pub fn still_periods(self) -> u32 {
        self.robot().body.still_periods()
    }

    /// The numbers of control periods without progress at which its guards change, ascending.
    pub fn still_thresholds(self) -> [u32; 3] {
        [STATIONARY_WINDOW, super::partner::WEDGED_AFTER, self.robot().patience().ceil() as u32]
    }
}

impl Robot {
    /// In place of a round of messages: processes what it has received, without counting a round.
    ///
    /// # Errors
    /// When a guard cannot be evaluated, or transitions do not come to an end.
    pub fn deliberate_now(&mut self) -> Result<(), RobotError> {
        self.end_round();
        self.process_news(false)?;
        self.jump()
    }

    /// Whether what the robot would leave out if nothing new came would change nothing. What it leaves
    /// out is not told by its [`account`](Self::account).
    pub fn leaves_out_nothing(&self) -> bool {
        let (beacon, sent) = (self.public_state(), self.outbox.beacon());
        let [is_processed, is_compared, is_measured] = self.changes.are_derived();
        (!is_processed || self.overlooked().is_none())
            && (!is_compared || sent.is_none_or(|sent| *sent == beacon))
            && (!is_measured || self.facts_stand())
    }

    /// The next round counts as the first one of a control period, in which all robots send.
    pub fn count_rounds_anew(&mut self) {
        self.schedule.count_rounds_anew();
    }

    /// Every way to an access point counts as confirmed anew.
    pub fn confirm_way_anew(&mut self) {
        self.tree.confirm_anew();
    }

    /// In place of the last stages of a control period and the beginning of the next: the robot
    /// has made no progress for `still_periods` control periods.
    ///
    /// # Errors
    /// When a guard cannot be evaluated, or transitions do not come to an end.
    pub fn pass_period(&mut self, still_periods: u32) -> Result<(), RobotError> {
        self.stand_at(self.body.position(), still_periods);
        self.begin_period()?;
        self.tree.find_parent();
        self.deliberate()?;
        self.jump()
    }

    /// From now on control periods count: this one has the number `now`.
    pub fn count_periods(&mut self, now: u32) {
        self.schedule.join(now);
    }

    /// Where control periods count, the next one begins; the robot has made no progress for
    /// `still_periods` of them. The new one gets the number of the last one, and all before are numbered
    /// anew, unless `is_next`: then its number is the next.
    ///
    /// # Errors
    /// When a guard cannot be evaluated, or transitions do not come to an end.
    pub fn begin_counted_period(
        &mut self,
        still_periods: u32,
        is_next: bool,
    ) -> Result<(), RobotError> {
        self.schedule.take_new();
        self.schedule.join(self.schedule.period() + u32::from(is_next));
        self.duty.begin_period();
        let numbers = Numbers { now: self.schedule.period(), passed: u32::from(!is_next) };
        let validity = self.site.roll_validity();
        self.membership.renumber(|called| numbers.of(called, validity + 1));
        self.tree.renumber(|it| numbers.of(it, OLDEST_CONFIRMATION));
        for known in self.neighbours.iter_mut() {
            known.heard_in = numbers.of(known.heard_in, PATIENCE_WITH_CHILDREN + 1);
            known.confirmed = known.confirmed.map(|it| numbers.of(it, OLDEST_CONFIRMATION));
        }
        self.stand_at(self.body.position(), still_periods);
        self.jump()?;
        self.begin_period()?;
        Ok(())
    }

    /// What the robot tells beside its beacon: the control period, the roll, and the confirmation that it
    /// passes on.
    pub fn tell_now(&mut self) -> (u32, Roll, Option<u32>) {
        (self.schedule.period(), self.membership.roll().clone(), self.pass_on_confirmation())
    }

    /// The [`account`](Self::account) of a robot where control periods count. Where bodies lie that do
    /// not take part is left out: it matters for motion alone.
    pub fn account_in_time(&self) -> Vec<String> {
        let seen: BTreeSet<NodeId> = self.membership.seen().collect();
        let heard: Vec<_> = self.neighbours.iter().map(|it| (it.heard_in, it.confirmed)).collect();
        let [_, strays, serves] = self.tree.reports();
        let reports = (strays, serves, self.mission.notices().forgetful());
        let told =
            (self.schedule.period(), self.membership.roll(), self.tree.confirmation(), reports);
        let waits = (self.tree.orphaned_periods(), self.duty.is_late(), self.schedule.waits());
        let mut account = self.account();
        account.extend([format!("{told:?}"), format!("{waits:?}{seen:?}{heard:?}")]);
        account
    }

    /// Everything, apart from the beacons that it goes by, that decides what the robot sends and does
    /// from now on: robots with equal accounts that go by the same beacons have the same future, as
    /// long as they are moved alike. It is told in paragraphs that seldom change together.
    ///
    /// Left out is what the explorer stands for, routes and motion, and what follows from the rest;
    /// how long a wait has been over does not matter. A field that is neither told nor left out does
    /// not compile.
    pub fn account(&self) -> Vec<String> {
        let Robot {
            // Told.
            id,
            body,
            duty,
            mission,
            exchanges,
            tree,
            ballot,
            neighbours: _, // by their beacons and their silence
            // Constant.
            site: _,
            // Between two stimuli a robot is at rest and has nothing left to do.
            schedule: _,
            changes: _,
            outbox: _,
            membership: _,
            // No robot is missed, and no task, where no time passes; and none restarts.
            // Routes and motion.
            routing: _,
            reservation: _,
            negotiation: _,
        } = self;
        let [below, ..] = tree.reports();
        let has_reached = self.has_reached_task();
        let waited = match self.counts_rounds() {
            true => ballot.waited_rounds().min(2 * self.longest_wait() + 1),
            false => 0,
        };
        let silences: Vec<u8> = self.audible().map(|(_, silent)| silent).collect();
        let wait = self.longest_wait();
        vec![
            format!(
                "{:?}",
                (
                    id,
                    body.position(),
                    body.still_periods(),
                    tree.parent(),
                    &**tree.current(),
                    tree.can_detach(),
                    silences
                )
            ),
            format!(
                "{:?}",
                (
                    &**duty,
                    duty.posts_made(),
                    tree.unused_periods(),
                    mission.team().followed_post(),
                    below,
                    mission.notices().closed()
                )
            ),
            format!(
                "{:?}",
                (
                    &**mission,
                    ballot.election(),
                    ballot.bid(),
                    waited,
                    ballot.agreement(),
                    mission.team().report(),
                    mission.notices().is_stretched(),
                    wait
                )
            ),
            format!("{:?}", mission.led_from()),
            format!("{} {:?}", exchanges.account(), self.past_offers()),
            format!(
                "{:?}",
                (
                    mission.notices().bulletin(),
                    mission.epoch(),
                    mission.notices().announced(),
                    has_reached,
                    ballot.route()
                )
            ),
        ]
    }
}
