//! What a user asks for and when: whether tasks are announced, taken back and ended in their time.

use std::collections::{BTreeMap, BTreeSet};

use pleach_automaton::network::record::{End, MissionEvent, Outcome};
use pleach_automaton::network::scenario::{Scenario, Settings, Task, TaskOrder, Unreachable};

use super::Dispute;
use crate::network::property::Property;

/// Control periods after which an access point has received a task that the user asks for.
const NEWS_OF_TASKS: usize = 2;

/// The terms on which a user wants its tasks, and what has become of them.
#[derive(Clone, Debug)]
pub(super) struct Terms {
    tasks: Vec<Task>,
    order: TaskOrder,
    unreachable: Unreachable,
    announced: BTreeSet<usize>,
    /// The task that has been announced last, or again.
    last: Option<usize>,
    /// The tasks that are serviced, each with the step from which on it has been since it was announced last.
    serviced: BTreeMap<usize, usize>,
    closed: BTreeSet<usize>,
    /// Those of them that no robot could service.
    given_up: BTreeSet<usize>,
    /// The tasks that have ever been serviced.
    begun: BTreeSet<usize>,
    /// Whether the access point that announces tasks has been absent. One that begins again has forgotten what it
    /// announced and closed, and may not have told all of it; what it announces again may be void, since robots
    /// know later notices; and it may be one control period behind the others, so that it counts one too many.
    has_forgotten: bool,
}

impl Terms {
    pub(super) fn of(scenario: &Scenario) -> Self {
        let settings = Settings::resolve(scenario);
        Terms::with(scenario.task.clone(), settings.order, settings.unreachable)
    }

    fn with(tasks: Vec<Task>, order: TaskOrder, unreachable: Unreachable) -> Self {
        Terms {
            tasks,
            order,
            unreachable,
            announced: BTreeSet::new(),
            last: None,
            serviced: BTreeMap::new(),
            closed: BTreeSet::new(),
            given_up: BTreeSet::new(),
            begun: BTreeSet::new(),
            has_forgotten: false,
        }
    }

    /// The access point that announces tasks is absent.
    pub(super) fn miss_access_point(&mut self) {
        self.has_forgotten = true;
    }

    /// An event that is told of the period that ends with `step`.
    ///
    /// # Errors
    ///
    /// When it cannot be so on these terms.
    pub(super) fn enter(&mut self, event: &MissionEvent, step: usize) -> Result<(), Dispute> {
        match *event {
            MissionEvent::TaskAnnounced { task } => {
                if !self.announced.insert(task) && !self.has_forgotten {
                    return dispute(format!("task {task} is announced, and it has been before"));
                }
                self.last = Some(task);
                let due = self.tasks[task].asked_for();
                not_before(step, due, || format!("task {task} is announced"), "asked for")
            }
            MissionEvent::TaskReannounced { task, .. } => {
                self.last = Some(task);
                if !self.has_forgotten {
                    self.serviced.remove(&task);
                }
                self.is_announced(task, || format!("task {task} is announced again"))
            }
            MissionEvent::TaskServiced { task, robot } => {
                self.serviced.entry(task).or_insert(step);
                self.begun.insert(task);
                self.is_announced(task, || format!("robot {robot} services task {task}"))
            }
            MissionEvent::TaskWithdrawn { task } => {
                let Some(due) = self.tasks[task].withdrawn else {
                    return dispute(format!(
                        "task {task} is taken back, and the scenario states no `withdrawn` for it: the user \
                         never takes it back"
                    ));
                };
                not_before(step, due, || format!("task {task} is given up"), "taken back")?;
                self.close(task, "is taken back")
            }
            MissionEvent::TaskGivenUp { task, .. } => {
                if self.unreachable == Unreachable::End {
                    return dispute(format!(
                        "task {task} is given up and the mission goes on, and mission.unreachable is \"end\""
                    ));
                }
                self.given_up.insert(task);
                self.close(task, "is given up")?;
                self.is_announced(task, || format!("task {task} is given up"))
            }
            MissionEvent::TaskEnded { task } => {
                let Some(lasts) = self.tasks[task].lasts else {
                    return dispute(format!(
                        "task {task} ends, and the scenario states no `lasts` for it: it is serviced for ever, \
                         or until it is taken back"
                    ));
                };
                let Some(&since) = self.serviced.get(&task) else {
                    return dispute(format!(
                        "task {task} ends, and no robot services it: it ends {lasts} control periods after its \
                         service"
                    ));
                };
                let due = end_of(since, lasts).saturating_sub(u32::from(self.has_forgotten));
                not_before(step, due, || format!("task {task} ends"), "to end")?;
                self.close(task, "ends")
            }
            _ => Ok(()),
        }
    }

    fn close(&mut self, task: usize, what: &str) -> Result<(), Dispute> {
        match self.closed.insert(task) || self.has_forgotten {
            true => Ok(()),
            false => dispute(format!("task {task} {what}, and it is over already")),
        }
    }

    fn is_announced(&self, task: usize, clause: impl Fn() -> String) -> Result<(), Dispute> {
        match self.announced.contains(&task) || self.has_forgotten {
            true => Ok(()),
            false => dispute(format!("{}, and it has not been announced", clause())),
        }
    }

    /// Whether a robot has serviced a task, or may have since the announcing access point forgot what it knew.
    pub(super) fn has_been_serviced(&self, task: usize) -> bool {
        self.has_forgotten || self.begun.contains(&task)
    }

    /// Whether a task is over.
    pub(super) fn is_closed(&self, task: usize) -> bool {
        self.closed.contains(&task)
    }

    /// Whether a task is neither serviced nor over.
    fn is_open(&self, task: usize) -> bool {
        !self.serviced.contains_key(&task) && !self.closed.contains(&task)
    }

    /// The task that has been announced last, until it is serviced or over.
    pub(super) fn pursued(&self) -> Option<usize> {
        self.last.filter(|&task| self.is_open(task))
    }

    /// A task that is neither serviced nor over and comes before this one by its number or priority. An access point that
    /// has forgotten what it announced need not announce all of them.
    pub(super) fn unfinished_before(&self, task: usize, step: usize) -> Option<usize> {
        let rank = |task: usize| match self.order {
            TaskOrder::File => Some((0, task)),
            TaskOrder::Priority => Some((-self.tasks[task].priority.unwrap_or_default(), task)),
            TaskOrder::Nearest => None,
        };
        let own = rank(task)?;
        let counts = |other: &usize| {
            let is_remembered = !self.has_forgotten || self.announced.contains(other);
            let is_before = rank(*other).is_some_and(|rank| rank < own);
            is_before && is_remembered && (*other < task || self.is_known_at(*other, step))
        };
        (0..self.tasks.len()).filter(counts).find(|&other| self.is_open(other))
    }

    /// Whether the access point has received a task by this step.
    fn is_known_at(&self, task: usize, step: usize) -> bool {
        self.tasks[task].asked_for() as usize + NEWS_OF_TASKS <= step
    }

    /// With `order = "nearest"`, the tasks that may be announced instead of this one: they have been asked for and are
    /// neither serviced nor over.
    pub(super) fn rivals_of(&self, task: usize, step: usize) -> Vec<usize> {
        let is_rival =
            |&other: &usize| other != task && self.is_open(other) && self.is_known_at(other, step);
        match self.order {
            TaskOrder::Nearest => (0..self.tasks.len()).filter(is_rival).collect(),
            TaskOrder::File | TaskOrder::Priority => Vec::new(),
        }
    }

    /// The tasks that are serviced.
    pub(super) fn serviced(&self) -> impl Iterator<Item = usize> {
        self.serviced.keys().copied().filter(|&task| !self.is_closed(task))
    }

    /// The tasks that no robot could service, ascending.
    pub(super) fn given_up(&self) -> Vec<usize> {
        self.given_up.iter().copied().collect()
    }

    /// A task that should have been closed more than `patience` steps ago, in a sentence: one that was
    /// announced and is taken back, after a secondary team has come to its end, or one that has lasted as long as
    /// it should. `busy` is the last step at which there was one.
    pub(super) fn overdue(&self, step: usize, busy: usize, patience: usize) -> Option<String> {
        let mut open = self.announced.iter().filter(|task| !self.closed.contains(task));
        open.find_map(|&task| {
            let is_past = |due: usize| due + patience < step;
            let Task { withdrawn, lasts, .. } = self.tasks[task];
            let taken_back = withdrawn.filter(|&it| is_past(busy.max(it as usize)));
            let end =
                self.serviced.get(&task).zip(lasts).map(|(&since, lasts)| end_of(since, lasts));
            let end = end.filter(|&due| is_past(due as usize));
            let since =
                |due, what| format!("task {task} is {what} at k = {due}, and its robots go on");
            taken_back
                .map(|due| since(due, "taken back"))
                .or_else(|| end.map(|due| since(due, "to end")))
        })
    }

    /// How many tasks are done: closed, or serviced.
    pub(super) fn done(&self) -> usize {
        (0..self.tasks.len()).filter(|&task| !self.is_open(task)).count()
    }

    /// Whether no task is to end that has not ended.
    pub(super) fn awaits_no_end(&self) -> bool {
        self.task_to_end().is_none()
    }

    fn task_to_end(&self) -> Option<usize> {
        let is_to_end =
            |task: &usize| self.tasks[*task].lasts.is_some() && !self.closed.contains(task);
        (0..self.tasks.len()).find(is_to_end)
    }

    /// What contradicts the end of a mission, in a clause.
    pub(super) fn contradiction(&self, end: &End) -> Option<String> {
        let outcome = end.outcome;
        if !end.tasks.is_empty() && end.tasks != self.given_up() && !self.has_forgotten {
            return Some(format!(
                "the end names tasks {:?} as given up, and tasks {:?} were",
                end.tasks,
                self.given_up()
            ));
        }
        if let (Outcome::Serviced, Some(task)) = (outcome, self.given_up.first()) {
            return Some(format!("the outcome is “serviced”, and task {task} was given up"));
        }
        let task = self.task_to_end().filter(|_| outcome == Outcome::Serviced)?;
        Some(format!("the outcome is “serviced”, and task {task} is to end and has not ended"))
    }
}

/// The step at which a task is to end that lasts so long, and is serviced from `since` on.
fn end_of(since: usize, lasts: u32) -> u32 {
    u32::try_from(since).unwrap_or(u32::MAX).saturating_add(lasts)
}

/// Whether these tasks stay once they are serviced: then all of them are serviced at the same time.
pub(super) fn all_stay(scenario: &Scenario, tasks: &[usize]) -> bool {
    let stays = |task: &Task| task.lasts.is_none() && task.withdrawn.is_none();
    tasks.iter().all(|&task| stays(&scenario.task[task]))
}

fn not_before(
    step: usize,
    due: u32,
    clause: impl Fn() -> String,
    what: &str,
) -> Result<(), Dispute> {
    match due as usize <= step {
        true => Ok(()),
        false => dispute(format!("{}, and it is {what} at k = {due}", clause())),
    }
}

fn dispute(sentence: String) -> Result<(), Dispute> {
    Err(Dispute::of(Property::Events, &[], sentence))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn terms(tasks: &[Task]) -> Terms {
        Terms::with(tasks.to_vec(), TaskOrder::File, Unreachable::Skip)
    }

    fn complaint(terms: &mut Terms, event: MissionEvent, step: usize) -> String {
        terms.enter(&event, step).expect_err("it cannot be so").sentence
    }

    /// The first of three tasks is serviced.
    fn serviced_first() -> Terms {
        let mut terms = terms(&[Task::at([3.0, 3.0]); 3]);
        let mut enter = |event| terms.enter(&event, 7).expect("it is in time");
        enter(MissionEvent::TaskAnnounced { task: 0 });
        enter(MissionEvent::TaskServiced { task: 0, robot: 0 });
        terms
    }

    /// Where a robot stands at a task already, several are announced in one control period.
    #[test]
    fn a_task_that_is_announced_later_need_not_be_serviced_before() {
        let mut terms = terms(&[Task::at([3.0, 3.0]); 3]);
        let mut enter = |event| terms.enter(&event, 7).expect("it is in time");
        enter(MissionEvent::TaskAnnounced { task: 0 });
        enter(MissionEvent::TaskServiced { task: 0, robot: 0 });
        enter(MissionEvent::TaskAnnounced { task: 1 });
        enter(MissionEvent::TaskAnnounced { task: 2 });
        assert_eq!([0, 1, 2].map(|task| terms.unfinished_before(task, 7)), [None, None, Some(1)]);
        assert_eq!((terms.pursued(), terms.done()), (Some(2), 1));
        let left_out = serviced_first().unfinished_before(2, 7);
        let mut forgetful = serviced_first();
        forgetful.miss_access_point();
        assert_eq!((left_out, forgetful.unfinished_before(2, 7)), (Some(1), None));
    }

    /// A robot stops, and another one services its task from then on.
    fn serviced_again() -> Terms {
        let mut terms = terms(&[Task { lasts: Some(10), ..Task::at([3.0, 3.0]) }]);
        let mut enter = |step, event| terms.enter(&event, step).expect("it is in time");
        enter(2, MissionEvent::TaskAnnounced { task: 0 });
        enter(5, MissionEvent::TaskServiced { task: 0, robot: 0 });
        enter(9, MissionEvent::TaskReannounced { task: 0, gone: vec![0], joined: vec![] });
        terms
    }

    #[test]
    fn the_time_of_a_task_counts_from_its_newest_service() {
        let ends = MissionEvent::TaskEnded { task: 0 };
        let mut terms = serviced_again();
        assert_eq!((terms.pursued(), terms.done()), (Some(0), 0));
        let found = complaint(&mut terms.clone(), ends.clone(), 15);
        assert!(found.contains("task 0 ends, and no robot services it"), "{found}");
        terms
            .enter(&MissionEvent::TaskServiced { task: 0, robot: 1 }, 12)
            .expect("it is announced");
        assert_eq!((terms.pursued(), terms.done()), (None, 1));
        let found = complaint(&mut terms.clone(), ends.clone(), 21);
        assert!(found.contains("task 0 ends, and it is to end at k = 22"), "{found}");
        assert_eq!(terms.enter(&ends, 22), Ok(()));
    }

    /// What an access point announces that has forgotten everything, robots may know to be void.
    #[test]
    fn an_access_point_that_has_begun_again_may_count_from_before_and_one_period_too_many() {
        let ends = MissionEvent::TaskEnded { task: 0 };
        let mut terms = terms(&[Task { lasts: Some(10), ..Task::at([3.0, 3.0]) }]);
        terms.miss_access_point();
        let mut enter = |step, event| terms.enter(&event, step).expect("it may be so");
        enter(5, MissionEvent::TaskServiced { task: 0, robot: 0 });
        enter(9, MissionEvent::TaskReannounced { task: 0, gone: vec![0], joined: vec![] });
        enter(14, ends.clone());
        enter(15, ends);
    }

    #[test]
    fn a_task_is_announced_once_and_before_it_is_serviced_and_closed_once() {
        let mut terms = terms(&[Task { lasts: Some(10), ..Task::at([3.0, 3.0]) }; 2]);
        let announced = MissionEvent::TaskAnnounced { task: 0 };
        let twice = complaint(&mut serviced_again(), announced.clone(), 10);
        assert_eq!(twice, "task 0 is announced, and it has been before");
        let mut forgetful = serviced_again();
        forgetful.miss_access_point();
        assert_eq!(forgetful.enter(&announced, 10), Ok(()), "it has begun again");
        let services = MissionEvent::TaskServiced { task: 1, robot: 4 };
        let found = complaint(&mut terms, services, 3);
        assert_eq!(found, "robot 4 services task 1, and it has not been announced");
        let mut terms = serviced_again();
        terms
            .enter(&MissionEvent::TaskServiced { task: 0, robot: 1 }, 12)
            .expect("it is announced");
        terms.enter(&MissionEvent::TaskEnded { task: 0 }, 22).expect("it is in time");
        let found = complaint(&mut terms, MissionEvent::TaskEnded { task: 0 }, 23);
        assert_eq!(found, "task 0 ends, and it is over already");
    }
}
