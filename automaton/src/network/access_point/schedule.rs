//! The schedule of an access point: its control period, and the round of that.

use super::rounds::RoundActs;
use crate::located::Current;
use crate::network::robot::ROUNDS_TO_BE_HEARD;
use crate::network::service::{Listening, Resting, Rounds};

/// Where an access point is in its control period.
#[derive(Clone, Debug)]
pub(super) struct Schedule {
    rounds: Current<Rounds>,
    /// The work of the row that was taken last.
    acts: RoundActs,
    /// Seconds since the last sample.
    clock: f64,
    /// How many control periods have begun.
    period: u32,
    /// Whether the first control period has not ended: until then the access point joins the period of others.
    is_new: bool,
    /// Whether another node has begun the next control period.
    is_behind: bool,
}

impl Schedule {
    /// The first sample is due.
    pub(super) fn due(clock: f64) -> Self {
        Schedule {
            rounds: Current::new(Rounds::Resting(Resting)),
            acts: &[],
            clock,
            period: 0,
            is_new: true,
            is_behind: false,
        }
    }

    pub(super) const fn current(&self) -> &Current<Rounds> {
        &self.rounds
    }

    pub(super) const fn current_mut(&mut self) -> &mut Current<Rounds> {
        &mut self.rounds
    }

    /// A row has been taken, with this work.
    pub(super) const fn carry_out(&mut self, acts: RoundActs) {
        self.acts = acts;
    }

    /// The work of the row that has been taken.
    pub(super) fn take_acts(&mut self) -> RoundActs {
        std::mem::take(&mut self.acts)
    }

    /// The number of this round of beacons; 0 between samples.
    pub(super) fn round(&self) -> usize {
        match *self.rounds {
            Rounds::Listening(Listening { round }) => round,
            Rounds::Resting(_) => 0,
        }
    }

    /// Whether all nodes have sent in this control period: each sends in the first rounds.
    pub(super) fn have_all_sent(&self) -> bool {
        // The round that has begun is one more than those that are over; after the last, none has.
        !(1..=ROUNDS_TO_BE_HEARD).contains(&self.round())
    }

    /// The number of the control period.
    pub(super) const fn period(&self) -> u32 {
        self.period
    }

    /// Whether the first control period has not ended.
    pub(super) const fn is_new(&self) -> bool {
        self.is_new
    }

    /// Whether another node has begun the next control period.
    pub(super) const fn is_behind(&self) -> bool {
        self.is_behind
    }

    /// Seconds since the last sample.
    pub(super) const fn clock(&self) -> f64 {
        self.clock
    }

    /// Seconds until the access point has something to do, where samples are `interval` seconds apart.
    pub(super) fn time_to_tick(&self, interval: f64) -> f64 {
        match self.round() == 0 && !self.is_behind {
            true => (interval - self.clock).max(0.0),
            false => 0.0,
        }
    }

    /// Another node is in a later control period: an access point that has just started joins it, and any other begins
    /// it as soon as its own is over.
    pub(super) const fn receive_later_period(&mut self, period: u32) {
        self.is_behind = !self.is_new;
        self.period = period - self.is_behind as u32;
    }

    /// Time passes.
    pub(super) const fn pass(&mut self, duration: f64) {
        self.clock += duration;
    }

    /// The next control period begins.
    pub(super) const fn begin_period(&mut self) {
        (self.clock, self.is_behind) = (0.0, false);
        self.period = self.period.saturating_add(1);
    }

    /// The work of a row is done.
    pub(super) fn end_round(&mut self) {
        self.is_new &= self.round() > 0;
    }
}

#[cfg(any(test, feature = "abstraction"))]
impl Schedule {
    /// This control period is under way, and is the first or not.
    pub(super) const fn join(&mut self, period: u32, is_new: bool) {
        (self.period, self.is_new) = (period, is_new);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_access_point_that_has_just_started_joins_the_period_of_others() {
        let mut schedule = Schedule::due(0.5);
        schedule.receive_later_period(7);
        assert_eq!((schedule.period(), schedule.is_behind()), (7, false));
        schedule.join(7, false);
        schedule.receive_later_period(8);
        assert_eq!((schedule.period(), schedule.is_behind()), (7, true), "it ends its own first");
        assert_eq!(schedule.time_to_tick(0.5), 0.0);
        schedule.begin_period();
        assert_eq!((schedule.period(), schedule.is_behind()), (8, false));
        assert_eq!(schedule.time_to_tick(0.5), 0.5);
    }
}
