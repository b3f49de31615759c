//! What a user asks for, as it changes during a mission.

use std::sync::Arc;

use pleach_continuous::Point;
use serde::{Deserialize, Serialize};

use super::scenario::Task;
use super::wire;

/// A task that a user asks for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Errand {
    /// q_v.
    #[serde(with = "wire")]
    pub position: Point,
    /// For how many control periods it is to be serviced; none: for ever.
    pub lasts: Option<u32>,
    /// Tasks of a higher priority come first, where the order of the mission says so.
    pub priority: i32,
    /// Whether the user has taken it back.
    pub withdrawn: bool,
}

/// Everything that a user has asked for so far. What follows asks for the same tasks and others after
/// them, and takes back the same tasks and others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Order {
    /// The tasks, in order of announcement.
    #[serde(with = "wire")]
    pub tasks: Arc<[Errand]>,
    /// Whether the user will ask for others later.
    pub continues: bool,
}

impl Order {
    /// What a user has asked for by control period `period` that wants these tasks, in order of
    /// announcement.
    pub fn by(period: u32, tasks: &[Task]) -> Self {
        let count = tasks.iter().take_while(|task| task.asked_for() <= period).count();
        let errand = |task: &Task| Errand {
            position: task.position.into(),
            lasts: task.lasts,
            priority: task.priority.unwrap_or_default(),
            withdrawn: task.withdrawn.is_some_and(|withdrawn| withdrawn <= period),
        };
        Order { tasks: tasks[..count].iter().map(errand).collect(), continues: count < tasks.len() }
    }

    /// Whether it was surely given before `other`: a medium may deliver copies late, and a user that begins
    /// again begins with less.
    pub(super) fn is_older_than(&self, other: &Self) -> bool {
        let taken_back = |order: &Self| order.tasks.iter().filter(|task| task.withdrawn).count();
        self.tasks.len() < other.tasks.len() || taken_back(self) < taken_back(other)
    }

    /// The positions of the tasks up to `end`.
    pub(super) fn positions(&self, end: usize) -> Arc<[Point]> {
        self.tasks.iter().take(end).map(|task| task.position).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wanted() -> [Task; 3] {
        let at = |x| Task::at([x, 0.0]);
        [
            Task { withdrawn: Some(7), ..at(0.0) },
            Task { announced: Some(3), lasts: Some(20), ..at(1.0) },
            Task { announced: Some(5), ..at(2.0) },
        ]
    }

    #[test]
    fn a_user_asks_for_a_task_when_its_time_has_come() {
        let counts = |period| {
            let order = Order::by(period, &wanted());
            let withdrawn: Vec<bool> = order.tasks.iter().map(|task| task.withdrawn).collect();
            (withdrawn, order.continues)
        };
        assert_eq!(counts(2), (vec![false], true));
        assert_eq!(counts(3), (vec![false, false], true));
        assert_eq!(counts(6), (vec![false; 3], false));
        assert_eq!(counts(7), (vec![true, false, false], false));
        assert_eq!(Order::by(4, &wanted()).tasks[1].lasts, Some(20));
        assert_eq!(Order::by(0, &[]), Order { tasks: Arc::from([]), continues: false });
    }

    #[test]
    fn an_order_is_older_than_those_that_follow_and_than_no_other() {
        let orders = [0, 3, 5, 7].map(|period| Order::by(period, &wanted()));
        for (at, order) in orders.iter().enumerate() {
            for (other, later) in orders.iter().enumerate() {
                assert_eq!(order.is_older_than(later), at < other, "{at} {other}");
            }
        }
    }
}
