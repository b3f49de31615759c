//! The schedule of a robot: its control period, the stage of that, and the round of the stage.

use pleach_discrete::network::Stage;

use super::control::Acts;
use super::rounds::Rounds;
use crate::located::{Current, Place as _};
use crate::network::control::{Control, Moving};

/// Where a robot is in its control period.
#[derive(Clone, Debug)]
pub(super) struct Schedule {
    control: Current<Control>,
    /// The work of the row that was taken last.
    acts: Acts,
    rounds: Rounds,
    /// How many control periods have begun.
    period: u32,
    /// Whether no other node has been received yet.
    is_new: bool,
    /// Whether another node has begun the next control period.
    is_behind: bool,
}

impl Default for Schedule {
    /// That of a robot that has just started: it moves, that is rests, until its first sample.
    fn default() -> Self {
        Schedule {
            control: Current::new(Control::Moving(Moving)),
            acts: &[],
            rounds: Rounds::default(),
            period: 0,
            is_new: true,
            is_behind: false,
        }
    }
}

impl Schedule {
    /// That of a robot that begins again at this place in its control period.
    pub(super) const fn begun_again(self) -> Self {
        Schedule { is_new: false, is_behind: false, ..self }
    }

    /// The number of the control period.
    pub(super) const fn period(&self) -> u32 {
        self.period
    }

    /// The round of the stage.
    pub(super) const fn rounds(&self) -> Rounds {
        self.rounds
    }

    pub(super) fn stage(&self) -> Stage {
        self.control.location()
    }

    pub(super) const fn control(&self) -> &Current<Control> {
        &self.control
    }

    pub(super) const fn control_mut(&mut self) -> &mut Current<Control> {
        &mut self.control
    }

    /// A row of the control automaton has been taken, with this work.
    pub(super) const fn carry_out(&mut self, acts: Acts) {
        self.acts = acts;
    }

    /// The work of the row that has been taken.
    pub(super) fn take_acts(&mut self) -> Acts {
        std::mem::take(&mut self.acts)
    }

    /// Further rounds pass.
    pub(super) const fn pass_rounds(&mut self, rounds: usize) {
        self.rounds.pass(rounds);
    }

    /// The next round is the first of a stage.
    pub(super) const fn count_rounds_anew(&mut self) {
        self.rounds.restart();
    }

    /// The next control period begins.
    pub(super) const fn begin_period(&mut self) {
        self.period = self.period.saturating_add(1);
        self.is_behind = false;
    }

    /// This control period is under way.
    pub(super) const fn join(&mut self, period: u32) {
        self.period = period;
    }

    /// Whether another node has begun the next control period.
    pub(super) const fn is_behind(&self) -> bool {
        self.is_behind
    }

    /// The number of the newest control period that any node is known to have begun.
    pub(super) const fn newest_period(&self) -> u32 {
        self.period.saturating_add(self.is_behind as u32)
    }

    /// Whether the robot has just started, asked once.
    pub(super) const fn take_new(&mut self) -> bool {
        std::mem::replace(&mut self.is_new, false)
    }

    /// Another node has begun a later control period. Control periods begin together: a robot
    /// that has just started, or has received nobody since, learns which one this is, and any other begins it as soon
    /// as its own is over but for the move. Returns the control period that the robot has to join.
    pub(super) const fn receive_later_period(&mut self, period: u32) -> Option<u32> {
        if self.is_new {
            return Some(period);
        }
        self.is_behind = true;
        if period > self.period + 1 { Some(period - 1) } else { None }
    }
}

#[cfg(feature = "abstraction")]
impl Schedule {
    /// What a robot waits for that an explorer tells apart.
    pub(super) const fn waits(&self) -> [bool; 2] {
        [self.is_new, self.is_behind]
    }
}

#[cfg(test)]
impl Schedule {
    /// The robot has received others before, and this control period is under way.
    pub(super) const fn is_in(&mut self, period: u32) {
        (self.period, self.is_new) = (period, false);
    }

    /// The robot has received no other.
    pub(super) const fn starts(&mut self) {
        self.is_new = true;
    }

    /// It is in this stage.
    pub(super) fn is_at(&mut self, control: Control) {
        *self = Schedule { control: Current::new(control), ..self.clone() };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_that_has_just_started_joins_the_period_of_others() {
        let mut schedule = Schedule::default();
        assert_eq!(schedule.receive_later_period(7), Some(7));
        assert!(!schedule.is_behind() && schedule.take_new() && !schedule.take_new());
    }

    #[test]
    fn a_robot_that_is_behind_begins_the_next_period_and_skips_those_that_it_has_missed() {
        let mut schedule = Schedule::default();
        schedule.is_in(7);
        assert_eq!(schedule.receive_later_period(8), None);
        assert!(schedule.is_behind() && schedule.newest_period() == 8);
        schedule.begin_period();
        assert_eq!((schedule.period(), schedule.is_behind()), (8, false));
        assert_eq!(schedule.receive_later_period(12), Some(11));
    }
}
