//! The access point, driven by an explorer.

use std::sync::Arc;

use super::attendance::Attendee;
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
        if self.round() > 1 {
            self.forget_heard();
        }
    }

    fn forget_heard(&mut self) {
        self.heard.clear();
        self.has_news = true;
    }

    /// Whether nothing would change, but for the count of rounds, if it processed what it has received.
    pub(super) fn overlooks_nothing(&self) -> bool {
        let attendees =
            |point: &Self| point.attendees.iter().map(Attendee::account).collect::<Vec<_>>();
        let rosters = |point: &Self| (Arc::clone(&point.roster), Arc::clone(&point.connected));
        let mut again = self.clone();
        again.deliberate().is_ok()
            && again.public_state() == self.public_state()
            && rosters(&again) == rosters(self)
            && again.known_tasks == self.known_tasks
            && attendees(&again) == attendees(self)
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
        self.attendees.iter_mut().for_each(Attendee::has_been_awaited);
    }

    /// From now on control periods count: this one has the number `now`.
    pub fn count_periods(&mut self, now: u32) {
        (self.period, self.roll.called) = (now, now);
    }

    /// Where control periods count, the next one begins; its number is that of the last one, and all
    /// before are numbered anew, unless `is_next`.
    ///
    /// # Errors
    /// When a guard cannot be evaluated.
    pub fn begin_counted_period(&mut self, is_next: bool) -> Result<(), TransitionError> {
        self.is_new = false;
        self.period += u32::from(is_next);
        let numbers = Numbers { now: self.period, passed: u32::from(!is_next) };
        self.roll.called = numbers.of(self.roll.called, self.site.roll_validity() + 1);
        self.call_roll()
    }

    /// What the access point tells beside its beacon: the control period, the roll, and its confirmation.
    pub fn tell_now(&self) -> (u32, Roll, Option<u32>) {
        (self.period, self.roll.clone(), Some(self.period))
    }

    /// The beacon that the access point sends where control periods count.
    pub fn beacon_in_time(&self) -> Beacon {
        self.public_state()
    }

    /// The [`account`](Self::account) of an access point where control periods count.
    pub fn account_in_time(&self) -> Vec<String> {
        let attendees: Vec<_> = self.attendees.iter().map(Attendee::account).collect();
        let patience = self.site.patience_with_tasks() + 1;
        let tasks: Vec<u32> =
            self.known_tasks.values().map(|task| task.silence.min(patience)).collect();
        let reports = (&self.strays, &self.serves, &self.forgetful, &self.joiners);
        let told = (self.period, &self.roll, reports, (self.is_new, self.is_behind));
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
            bulletin,
            announced,
            election,
            election_rounds,
            agreement,
            route,
            crossing,
            stretched,
            longest_wait,
            attached,
            roster,
            settled_rounds,
            connected: _, // by the beacons that it goes by
            service,
            closed,
            // Constant: the request comes before the first state, and does not change. No task of it ends.
            given_up: _,
            closed_in: _,
            announced_in: _,
            given_up_in: _,
            site: _,
            position: _,
            requested: _,
            // Between two stimuli an access point has nothing left to do.
            heard: _,
            heard_up_to: _,
            has_news: _,
            sightings: _,
            wrecks: _,
            newest: _,
            rounds: _,
            acts: _,
            is_new: _,
            is_behind: _,
            last_beacon: _,
            log: _,
            // The explorer stands for time; without it no robot is missed, and no task, and none restarts.
            forgetful: _,
            joiners: _,
            strays: _,
            serves: _,
            known_tasks: _,
            attendees: _,
            roll: _,
            clock: _,
            period: _,
        } = self;
        let settled = match self.notice() {
            Notice::Quiet => (*settled_rounds).min(self.rounds_until_gathered()),
            _ => 0,
        };
        let patience = (PATIENCE_WITH_ELECTIONS * longest_wait + 1).max(self.longest_search());
        let rounds = if self.is_electing() { (*election_rounds).min(patience) } else { 0 };
        vec![
            format!("{:?}", (number, bulletin, announced, &**service, election, rounds)),
            format!("{:?}", (agreement, route, crossing, stretched, longest_wait)),
            format!("{:?}", (attached, roster, settled, closed)),
        ]
    }
}
