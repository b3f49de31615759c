//! The access point, driven by an explorer.

use std::sync::Arc;

use super::{AccessPoint, PATIENCE_WITH_ELECTIONS};
use crate::automaton::TransitionError;
use crate::network::beacon::{Beacon, Notice};
use crate::network::robot::Numbers;
use crate::network::roll::Roll;

impl AccessPoint {
    /// The beacon that the access point would send now, without what matters only when time passes.
    pub fn beacon(&self) -> Beacon {
        Beacon { strays: Arc::default(), serves: Arc::default(), ..self.public_state() }
    }

    /// In place of a round of messages: processes what it has received, without counting a round.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    pub fn deliberate_now(&mut self) -> Result<(), TransitionError> {
        self.deliberate()?;
        self.forget_heard();
        Ok(())
    }

    /// In the next round all nodes send again: beacons that are processed are not needed any more.
    pub fn forget_round(&mut self) {
        if self.schedule.round() > 1 {
            self.forget_heard();
        }
    }

    fn forget_heard(&mut self) {
        self.neighbours.clear();
        self.has_news = true;
    }

    /// Whether nothing would change, but for the count of rounds, if it processed what it has received.
    pub(super) fn overlooks_nothing(&self) -> bool {
        let mut again = self.clone();
        again.deliberate().is_ok()
            && again.public_state() == self.public_state()
            && again.roster.account() == self.roster.account()
            && again.tasks.records().eq(self.tasks.records())
    }

    /// In place of serving the user at the end of each round.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    pub fn attend_to_user(&mut self) -> Result<(), TransitionError> {
        self.serve()
    }

    /// No time passes: no robot is waited for that has not begun.
    pub fn await_nobody(&mut self) {
        self.roster.have_been_awaited();
    }

    /// From now on control periods count: this one has the number `now`.
    pub fn count_periods(&mut self, now: u32) {
        self.schedule.join(now, self.schedule.is_new());
        self.membership.renumber(|_| now);
    }

    /// Where control periods count, the next one begins; its number is that of the last one, and all
    /// before are numbered anew, unless `is_next`.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    pub fn begin_counted_period(&mut self, is_next: bool) -> Result<(), TransitionError> {
        let now = self.schedule.period() + u32::from(is_next);
        self.schedule.join(now, false);
        let numbers = Numbers { now, passed: u32::from(!is_next) };
        let oldest = self.site.roll_validity() + 1;
        self.membership.renumber(|called| numbers.of(called, oldest));
        self.call_roll()
    }

    /// What the access point tells beside its beacon: the control period, the roll, and its confirmation.
    pub fn tell_now(&self) -> (u32, Roll, Option<u32>) {
        let period = self.schedule.period();
        (period, self.membership.roll().clone(), Some(period))
    }

    /// The beacon that the access point sends where control periods count.
    pub fn beacon_in_time(&self) -> Beacon {
        self.public_state()
    }

    /// The [`account`](Self::account) of an access point where control periods count.
    pub fn account_in_time(&self) -> Vec<String> {
        let patience = self.site.patience_with_tasks() + 1;
        let tasks: Vec<u32> =
            self.tasks.records().map(|(_, task)| task.silence.min(patience)).collect();
        let [_, strays, serves] = self.roster.reports();
        let reports = (strays, serves, self.notices.forgetful(), self.roster.joiners());
        let waits = (self.schedule.is_new(), self.schedule.is_behind());
        let told = (self.schedule.period(), self.membership.roll(), reports, waits);
        let attendees = self.roster.account().0;
        let mut account = self.account();
        account.extend([format!("{told:?}"), format!("{attendees:?}{tasks:?}")]);
        account
    }

    /// Everything, apart from what it receives, that decides what the access point sends from now on,
    /// in paragraphs that seldom change together.
    ///
    /// Left out is what the explorer stands for and what follows from the rest; how long a wait has
    /// been over does not matter. A field that is neither told nor left out does not compile.
    pub fn account(&self) -> Vec<String> {
        let AccessPoint {
            // Told.
            number,
            notices,
            roster,
            ballot,
            crossing,
            tasks,
            // Constant.
            site: _,
            // Between two stimuli an access point has nothing left to do.
            schedule: _,
            neighbours: _,
            has_news: _,
            outbox: _,
            // The explorer stands for time; without it no robot is missed, and no task, and none restarts.
            membership: _,
        } = self;
        let settled = match self.notice() {
            Notice::Quiet => roster.settled_rounds().min(self.rounds_until_gathered()),
            _ => 0,
        };
        let longest_wait = notices.longest_wait();
        let patience = (PATIENCE_WITH_ELECTIONS * longest_wait + 1).max(self.longest_search());
        let rounds = if tasks.is_electing() { ballot.rounds_passed().min(patience) } else { 0 };
        let [attached, ..] = roster.reports();
        vec![
            format!(
                "{:?}",
                (
                    number,
                    notices.bulletin(),
                    notices.announced(),
                    &**tasks.current(),
                    ballot.election(),
                    rounds
                )
            ),
            format!(
                "{:?}",
                (
                    ballot.agreement(),
                    ballot.route(),
                    crossing,
                    notices.is_stretched(),
                    longest_wait
                )
            ),
            format!("{:?}", (attached, roster.present(), settled, notices.closed())),
        ]
    }
}
