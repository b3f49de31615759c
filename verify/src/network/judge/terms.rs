//! What a user asks for and when: whether tasks are announced, taken back and ended in their time.

use std::collections::{BTreeMap, BTreeSet};

use pleach_automaton::network::record::{MissionEvent, Outcome};
use pleach_automaton::network::scenario::{Scenario, Task};

use super::Dispute;
use crate::network::property::Property;

/// The terms on which a user wants its tasks, and what has become of them.
#[derive(Clone, Debug)]
pub(super) struct Terms {
    tasks: Vec<Task>,
    announced: BTreeSet<usize>,
    /// The tasks that have been serviced, each with the step at which it was first.
    serviced: BTreeMap<usize, usize>,
    closed: BTreeSet<usize>,
    /// How many control periods fewer than those of the record may have passed by the clock of an access point.
    slack: u32,
}

impl Terms {
    pub(super) fn of(scenario: &Scenario) -> Self {
        Terms {
            tasks: scenario.task.clone(),
            announced: BTreeSet::new(),
            serviced: BTreeMap::new(),
            closed: BTreeSet::new(),
            slack: 0,
        }
    }

    /// The same where clocks may be shifted against each other by any part of a period.
    pub(super) fn under_faults(scenario: &Scenario) -> Self {
        Terms { slack: 1, ..Terms::of(scenario) }
    }

    /// An event that is told of the period that ends with `step`.
    ///
    /// # Errors
    ///
    /// When it cannot be so on these terms.
    pub(super) fn enter(&mut self, event: &MissionEvent, step: usize) -> Result<(), Dispute> {
        match *event {
            MissionEvent::TaskAnnounced { task } => {
                self.announced.insert(task);
                let asked = Some(self.tasks[task].asked_for());
                not_before(step, asked, || format!("task {task} is announced"), "asked for")
            }
            MissionEvent::TaskServiced { task, .. } => {
                self.serviced.entry(task).or_insert(step);
                Ok(())
            }
            MissionEvent::TaskWithdrawn { task } => {
                self.closed.insert(task);
                let taken_back = self.tasks[task].withdrawn;
                not_before(step, taken_back, || format!("task {task} is given up"), "taken back")
            }
            MissionEvent::TaskEnded { task } => {
                self.closed.insert(task);
                let end = self.end_of(task).map(|end| end.saturating_sub(self.slack));
                not_before(step, end, || format!("task {task} ends"), "to end")
            }
            _ => Ok(()),
        }
    }

    /// A task that was announced before this one, and is neither serviced nor over. Tasks are announced in
    /// their order.
    pub(super) fn unfinished_before(&self, task: usize) -> Option<usize> {
        let is_open =
            |other: &&usize| !self.serviced.contains_key(other) && !self.closed.contains(other);
        self.announced.range(..task).find(is_open).copied()
    }

    /// The step at which a task is to end, if it is serviced until then.
    fn end_of(&self, task: usize) -> Option<u32> {
        let serviced = u32::try_from(*self.serviced.get(&task)?).ok()?;
        serviced.checked_add(self.tasks[task].lasts?)
    }

    /// A task that should have been closed more than `patience` steps ago, in a sentence: one that was
    /// announced and is taken back, after a secondary team has come to its end, or one that has lasted as long as
    /// it should. `busy` is the last step at which there was one.
    pub(super) fn overdue(&self, step: usize, busy: usize, patience: usize) -> Option<String> {
        let mut open = self.announced.iter().filter(|task| !self.closed.contains(task));
        open.find_map(|&task| {
            let is_past = |due: usize| due + patience < step;
            let taken_back =
                self.tasks[task].withdrawn.filter(|&it| is_past(busy.max(it as usize)));
            let end = self.end_of(task).filter(|&due| is_past(due as usize));
            let since =
                |due, what| format!("task {task} is {what} at k = {due}, and its robots go on");
            taken_back
                .map(|due| since(due, "taken back"))
                .or_else(|| end.map(|due| since(due, "to end")))
        })
    }

    /// The tasks that have been serviced.
    pub(super) fn serviced(&self) -> impl Iterator<Item = usize> {
        self.serviced.keys().copied()
    }

    /// How many tasks are done: closed, or serviced and neither to end nor closed.
    pub(super) fn done(&self, serviced: impl Iterator<Item = usize>) -> usize {
        let lasting = serviced.filter(|task| !self.closed.contains(task));
        self.closed.len() + lasting.count()
    }

    /// What is missing where a mission ends with this outcome, in a clause.
    pub(super) fn contradiction(&self, outcome: Outcome) -> Option<String> {
        let open = |task: &usize| self.tasks[*task].lasts.is_some() && !self.closed.contains(task);
        let task = (0..self.tasks.len()).find(open).filter(|_| outcome == Outcome::Serviced)?;
        Some(format!("the outcome is “serviced”, and task {task} is to end and has not ended"))
    }
}

/// Whether the first `count` tasks stay once they are serviced: then all of them are serviced at the same time.
pub fn all_stay(scenario: &Scenario, count: usize) -> bool {
    let stays = |task: &Task| task.lasts.is_none() && task.withdrawn.is_none();
    scenario.task.iter().take(count).all(stays)
}

fn not_before(
    step: usize,
    due: Option<u32>,
    clause: impl Fn() -> String,
    what: &str,
) -> Result<(), Dispute> {
    let sentence = match due {
        Some(due) if due as usize <= step => return Ok(()),
        Some(due) => format!("{}, and it is {what} at k = {due}", clause()),
        None => format!("{}, and it is never {what}", clause()),
    };
    Err(Dispute::of(Property::Events, &[], sentence))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a robot stands at a task already, several are announced in one control period.
    #[test]
    fn a_task_that_is_announced_later_need_not_be_serviced_before() {
        let task = Task::at([3.0, 3.0]);
        let mut terms = Terms {
            tasks: vec![task; 3],
            announced: BTreeSet::new(),
            serviced: BTreeMap::new(),
            closed: BTreeSet::new(),
            slack: 0,
        };
        let mut enter = |event| terms.enter(&event, 7).expect("it is in time");
        enter(MissionEvent::TaskAnnounced { task: 0 });
        enter(MissionEvent::TaskServiced { task: 0, robot: 0 });
        enter(MissionEvent::TaskAnnounced { task: 1 });
        enter(MissionEvent::TaskAnnounced { task: 2 });
        assert_eq!([0, 1, 2].map(|task| terms.unfinished_before(task)), [None, None, Some(1)]);
    }
}
