//! The duty of a robot, and what goes with a jump to another one.

use std::ops::Deref;

use super::duties::Label;
use crate::located::Current;
use crate::network::duty::Duty;

/// The duty of a robot.
#[derive(Clone, Debug)]
pub(super) struct DutyCell {
    duty: Current<Duty>,
    /// What the duty automaton jumps together with in this jump.
    label: Label,
    /// How many posts the robot has made in this control period.
    posts_made: u32,
    /// The robot has joined a mission under way, and not taken a new post yet.
    is_late: bool,
}

impl Deref for DutyCell {
    type Target = Duty;

    fn deref(&self) -> &Duty {
        &self.duty
    }
}

impl DutyCell {
    /// A robot that begins with this duty.
    pub(super) fn new(duty: Duty) -> Self {
        DutyCell { duty: Current::new(duty), label: Label::Alone, posts_made: 0, is_late: false }
    }

    pub(super) const fn current(&self) -> &Current<Duty> {
        &self.duty
    }

    pub(super) const fn current_mut(&mut self) -> &mut Current<Duty> {
        &mut self.duty
    }

    /// A control period begins.
    pub(super) const fn begin_period(&mut self) {
        self.posts_made = 0;
    }

    /// The robot joins a mission under way: its next jump gives it a new post.
    pub(super) const fn join_late(&mut self) {
        self.is_late = true;
    }

    /// A jump is taken together with what `label` stands for, or has been.
    pub(super) const fn jump_with(&mut self, label: Label) {
        self.label = label;
    }

    /// The duty is another one, by a jump.
    pub(super) const fn has_jumped(&mut self) {
        self.is_late = false;
    }

    /// What the duty automaton jumps together with in this jump.
    pub(super) const fn label(&self) -> Label {
        self.label
    }

    /// Whether the robot has joined a mission under way, and not taken a new post yet.
    pub(super) const fn is_late(&self) -> bool {
        self.is_late
    }

    /// How many posts the robot has made in this control period.
    pub(super) const fn posts_made(&self) -> u32 {
        self.posts_made
    }

    /// The robot has made further posts in this control period.
    pub(super) const fn make_posts(&mut self, posts: u32) {
        self.posts_made += posts;
    }
}

#[cfg(test)]
impl DutyCell {
    /// The robot has this duty.
    pub(super) fn is(&mut self, duty: Duty) {
        *self = DutyCell { duty: Current::new(duty), ..self.clone() };
    }
}
