//! The tasks as an access point has received of them: what the user requests, what is serviced, and what was given up.

use std::collections::BTreeMap;

use pleach_continuous::Point;

use crate::located::Current;
use crate::network::beacon::{Bulletin, Notice};
use crate::network::order::{Errand, Order};
use crate::network::record::Outcome;
use crate::network::robot::PATIENCE_WITH_UNUSED_POSTS;
use crate::network::service::{Gathering, Serving};

/// The tasks, and where the access point is in their service.
#[derive(Clone, Debug)]
pub(super) struct Tasks {
    service: Current<Serving>,
    /// The newest bulletin that has been received and not taken up: rows of the service read it.
    newest: Option<Bulletin>,
    requested: Option<Order>,
    /// Each task that has been serviced, also those that are over by now.
    known: BTreeMap<usize, TaskRecord>,
    /// The tasks that no robot could service, in this order, and how each of them ended.
    given_up: Vec<(usize, Outcome)>,
    /// The control period in which a task was closed last that had been announced.
    closed_in: Option<u32>,
    /// The control period in which a task was announced last.
    announced_in: u32,
    /// The control period in which that task was reported as given up for lack of robots.
    failed_in: Option<u32>,
}

/// A task that has been serviced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct TaskRecord {
    /// Control periods since its service was reported last.
    pub silence: u32,
    /// Control periods since its service was announced last.
    pub age: u32,
}

impl TaskRecord {
    /// Another control period begins.
    fn pass_period(&mut self) {
        self.silence = self.silence.saturating_add(1);
        self.age = self.age.saturating_add(1);
    }

    /// Whether it has been serviced for at least this many control periods, and is reported now.
    pub(super) fn has_lasted(self, periods: u32) -> bool {
        self.age >= periods && self.silence == 0
    }
}

impl Default for Tasks {
    /// Those of an access point that has received nothing.
    fn default() -> Self {
        Tasks {
            service: Current::new(Serving::Gathering(Gathering)),
            newest: None,
            requested: None,
            known: BTreeMap::new(),
            given_up: Vec::new(),
            closed_in: None,
            announced_in: 0,
            failed_in: None,
        }
    }
}

impl Tasks {
    pub(super) const fn current(&self) -> &Current<Serving> {
        &self.service
    }

    pub(super) const fn current_mut(&mut self) -> &mut Current<Serving> {
        &mut self.service
    }

    /// Whether a leader or a recruit is being elected.
    pub(super) fn is_electing(&self) -> bool {
        matches!(*self.service, Serving::Electing(_))
    }

    /// Rows of the service read this bulletin from now on, or none.
    pub(super) fn offer(&mut self, newest: Option<Bulletin>) {
        self.newest = newest;
    }

    /// The bulletin that has been received and not taken up.
    pub(super) const fn newest(&self) -> Option<&Bulletin> {
        self.newest.as_ref()
    }

    /// The notice of that bulletin.
    pub(super) fn newest_notice(&self) -> Option<&Notice> {
        self.newest.as_ref().map(|bulletin| &**bulletin.notice())
    }

    /// The user requests these tasks; a late copy of an earlier request changes nothing.
    pub(super) fn request(&mut self, order: &Order) {
        if !self.requested.as_ref().is_some_and(|known| order.is_older_than(known)) {
            self.requested = Some(order.clone());
        }
    }

    /// What the user requests.
    pub(super) const fn requested(&self) -> Option<&Order> {
        self.requested.as_ref()
    }

    /// The tasks that the user requests, by number.
    pub(super) fn errands(&self) -> impl Iterator<Item = (usize, Errand)> {
        let tasks = self.requested.iter().flat_map(|order| order.tasks.iter().copied());
        tasks.enumerate()
    }

    /// Where a task is, if the user requests it.
    pub(super) fn position_of(&self, task: usize) -> Option<Point> {
        Some(self.requested.as_ref()?.tasks.get(task)?.position)
    }

    /// Whether the user has taken a task back.
    pub(super) fn is_withdrawn(&self, task: usize) -> bool {
        let errand = self.requested.as_ref().and_then(|order| order.tasks.get(task));
        errand.is_some_and(|errand| errand.withdrawn)
    }

    /// A task is serviced from now on.
    pub(super) fn begin_service(&mut self, task: usize) {
        self.known.insert(task, TaskRecord::default());
    }

    /// The tasks before this one have been serviced, or are over.
    pub(super) fn expect_before(&mut self, task: usize) {
        (0..task).for_each(|before| {
            self.known.entry(before).or_default();
        });
    }

    /// The service of a task is reported.
    pub(super) fn attend(&mut self, task: usize) {
        self.known.entry(task).or_default().silence = 0;
    }

    /// Another control period begins.
    pub(super) fn pass_period(&mut self) {
        self.known.values_mut().for_each(TaskRecord::pass_period);
    }

    /// The record of a task that has been serviced.
    pub(super) fn record(&self, task: usize) -> Option<TaskRecord> {
        self.known.get(&task).copied()
    }

    /// Each task that has been serviced, by number.
    pub(super) fn records(&self) -> impl Iterator<Item = (usize, TaskRecord)> {
        self.known.iter().map(|(&task, &known)| (task, known))
    }

    /// A number above those of all tasks that have been serviced.
    pub(super) fn end(&self) -> usize {
        self.known.last_key_value().map_or(0, |(task, _)| task + 1)
    }

    /// No robot can service a task.
    pub(super) fn give_up(&mut self, task: usize, outcome: Outcome) {
        self.given_up.push((task, outcome));
    }

    /// The tasks that no robot could service, in this order, and how each of them ended.
    pub(super) fn given_up(&self) -> &[(usize, Outcome)] {
        &self.given_up
    }

    /// A task is announced in this control period.
    pub(super) const fn announce_in(&mut self, period: u32) {
        (self.announced_in, self.failed_in) = (period, None);
    }

    /// A task that had been announced is over in this control period.
    pub(super) const fn close_in(&mut self, period: u32) {
        self.closed_in = Some(period);
    }

    /// The task that was announced last is reported as given up for lack of robots.
    pub(super) fn report_failure_in(&mut self, period: u32) {
        self.failed_in.get_or_insert(period);
    }

    /// Whether that task has been reported as given up for lack of robots.
    pub(super) const fn lacks_robots(&self) -> bool {
        self.failed_in.is_some()
    }

    /// Whether a task has ended so late that its robots were not redundant yet when the last task was announced.
    pub(super) fn has_freed(&self, longest_wait: usize) -> bool {
        self.closed_in.is_some_and(|end| self.announced_in < retired_by(end, longest_wait))
    }

    /// Whether such robots, or robots of a team that has given up, may still become redundant.
    pub(super) fn awaits_retirements(&self, longest_wait: usize, period: u32) -> bool {
        let ends = self.closed_in.into_iter().chain(self.failed_in);
        let is_awaited = |end| period < retired_by(end, longest_wait);
        self.has_freed(longest_wait) && ends.max().is_some_and(is_awaited)
    }
}

/// The control period in which robots are redundant whose task has ended in this one: the robot at the end of a branch
/// is first, then the one before it, as each receives that of the next.
fn retired_by(end: u32, longest_wait: usize) -> u32 {
    let depth = (longest_wait / 2 + 1) as u32;
    end.saturating_add(depth.saturating_mul(PATIENCE_WITH_UNUSED_POSTS + 2))
}

#[cfg(test)]
impl Tasks {
    /// The service is there.
    pub(super) fn is_at(&mut self, service: Serving) {
        *self = Tasks { service: Current::new(service), ..self.clone() };
    }

    /// The record of a task is this.
    pub(super) fn has_record(&mut self, task: usize, record: TaskRecord) {
        self.known.insert(task, record);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::scenario::Task;

    const THERE: [f64; 2] = [9.0, 9.0];

    #[test]
    fn a_late_copy_of_a_request_takes_nothing_back() {
        let tasks = [Task { withdrawn: Some(9), ..Task::at(THERE) }, Task::at(THERE)];
        let later = [tasks[0], Task { announced: Some(5), ..tasks[1] }];
        let mut known = Tasks::default();
        let mut requested_by = |period| {
            known.request(&Order::by(period, &later));
            (known.errands().count(), known.is_withdrawn(0))
        };
        assert_eq!(requested_by(4), (1, false));
        assert_eq!((requested_by(5), requested_by(4)), ((2, false), (2, false)));
        assert_eq!((requested_by(9), requested_by(8)), ((2, true), (2, true)));
    }

    #[test]
    fn a_task_has_lasted_while_it_is_reported() {
        let mut tasks = Tasks::default();
        tasks.begin_service(3);
        (0..5).for_each(|_| tasks.pass_period());
        let has_lasted =
            |tasks: &Tasks, periods| tasks.record(3).is_some_and(|it| it.has_lasted(periods));
        assert!(!has_lasted(&tasks, 5), "its robot may have stopped");
        tasks.attend(3);
        assert!(has_lasted(&tasks, 5) && !has_lasted(&tasks, 6));
        assert_eq!((tasks.end(), tasks.record(0)), (4, None));
        tasks.expect_before(3);
        assert_eq!(tasks.records().count(), 4);
    }

    /// Two robots in a row: the second is redundant by then, and a task that is announced later has them from the start.
    #[test]
    fn robots_of_a_task_that_has_ended_are_awaited() {
        let mut tasks = Tasks::default();
        tasks.announce_in(10);
        assert!(!tasks.has_freed(2) && !tasks.awaits_retirements(2, 10));
        tasks.close_in(20);
        let free = retired_by(20, 2);
        assert!(tasks.has_freed(2) && tasks.awaits_retirements(2, free - 1));
        assert!(!tasks.awaits_retirements(2, free));
        tasks.report_failure_in(40);
        tasks.report_failure_in(50);
        assert!(tasks.lacks_robots() && tasks.awaits_retirements(2, retired_by(40, 2) - 1));
        assert!(!tasks.awaits_retirements(2, retired_by(40, 2)), "the first report counts");
        tasks.announce_in(free);
        assert!(!tasks.lacks_robots() && !tasks.has_freed(2));
    }
}
