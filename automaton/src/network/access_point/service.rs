//! The automaton of the service: what an access point announces, and when it ends the mission.

use std::sync::Arc;

use pleach_continuous::Point;
use pleach_discrete::network::{IdSet, NodeId, SERVICE, Service, ServiceEvent};
use pleach_guards::Guard;

use crate::located::{Current, DataOf, Holds};
use crate::network::guards::service as guards;
use crate::{Automaton, BuildError, Transfer};

use super::attendance::Attendee;
use super::tasks::TaskRecord;
use super::{AccessPoint, PATIENCE_WITH_ELECTIONS};
use crate::network::beacon::{Announcement, Bulletin, Notice};
use crate::network::order::Errand;
use crate::network::phrase;
use crate::network::record::{MissionEvent, Outcome};
use crate::network::roll::why_absent;
use crate::network::scenario::{TaskOrder, Unreachable};
use crate::network::service::{Announced, Done, Electing, Gathering, Over, Serving, UnderWay};
use crate::network::shared::Shared;

/// A task is announced again at most this many times because robots that are heard of do not answer:
/// one that restarts does not know of the election under way, or knows no way to an access point yet.
const ATTEMPTS_TO_ELECT: f64 = 3.0;
/// Control periods, or times that news may be under way if that is less, after which a robot that looks for another
/// parent has found one, if there is one.
const PATIENCE_WITH_SEARCHES: usize = 16;

/// The automaton of the service.
pub type ServiceAutomaton = Automaton<Service, ServiceEvent, AccessPoint>;

crate::observed! {
    impl Observed for AccessPoint as point;
    quantities {
        /// τ: seconds since the last sample.
        clock: point.schedule.clock(),
        /// Δt: seconds from sample to sample.
        period: point.site.settings.period,
        /// The number of this round of beacons.
        round: point.schedule.round() as f64,
        /// The number of rounds in this control period.
        rounds: point.site.settings.rounds_per_period as f64,
        /// The number of robots that take part, as far as it has heard.
        robots: point.roster.present().len() as f64,
        /// Rounds for which the roster, and the set of its robots that know a way to an access point, have not changed.
        settled: point.roster.settled_rounds() as f64,
        /// Rounds after which robots count as gathered: more if some know no way to an access point.
        settling: point.rounds_until_gathered() as f64,
        /// Rounds since the election began.
        waited: point.ballot.rounds_passed() as f64,
        /// Rounds after which an election should be over.
        longest_wait: (PATIENCE_WITH_ELECTIONS * point.notices.longest_wait()) as f64,
        /// Rounds after which a robot that takes part in the elections for its task, and has known no way to an
        /// access point since that was announced, is cut off; 0 if there is none.
        longest_search: point.longest_search() as f64,
        /// Elections for its task that were in vain: not answered by all, or not by those without a way.
        unanswered: point.announced().map_or(0.0, |announced| f64::from(announced.unanswered)),
        /// Elections that may be in vain before the mission ends.
        attempts: ATTEMPTS_TO_ELECT,
    }
    propositions {
        /// Another node has begun the next control period.
        behind: point.schedule.is_behind(),
        /// A robot that has taken part in the service of its task is gone, or has forgotten what became of it.
        misses_robot: point.misses_robot(),
        /// A robot that takes part in the elections for its task has not been heard of.
        expects_elector: point.electors().any(|elector| !elector.is_heard_of()),
        /// A robot of which it has never heard may not have begun yet.
        awaits_robots: point.roster.awaits_robots(),
        /// A robot takes part that does not in the elections for its task: it has joined, or come back, since.
        has_newcomers: point.newcomers().next().is_some(),
        /// A robot that takes part in the elections for its task knew no way to an access point when it was
        /// announced, and knows one now.
        has_found_way: point.finders().next().is_some(),
        /// A robot that does not take part is not gone yet, or is coming back.
        may_return: point.roster.robots_that(Attendee::may_return).next().is_some(),
        /// The newest notice received announces a task, or calls for a recruit.
        hears_election: matches!(point.tasks.newest_notice(), Some(Notice::Task(_) | Notice::Call { .. })),
        /// The newest notice received announces a path Σ, or that the team advances.
        hears_progress: matches!(point.tasks.newest_notice(), Some(Notice::Path(_) | Notice::Advance { .. })),
        /// The newest notice received says that the task is serviced, or has been taken back.
        hears_service: matches!(
            point.tasks.newest_notice(),
            Some(Notice::Serviced { .. } | Notice::Withdrawn { .. })
        ),
        /// The newest notice received says that the mission has ended.
        hears_end: matches!(point.tasks.newest_notice(), Some(Notice::Ended { .. })),
        /// The newest notice received says that the mission has ended, and that a task is given up.
        hears_failure: point.hears_failure(),
        /// The newest notice received says that the mission has ended for lack of robots.
        hears_want: point.hears_want(),
        /// A notice that the mission has ended for lack of robots has been received since the task was announced.
        wants_robots: point.tasks.lacks_robots(),
        /// A task that no robot can service is given up, and the mission goes on.
        skips_tasks: point.site.settings.unreachable == Unreachable::Skip,
        /// The user has asked it for tasks.
        asked: point.tasks.requested().is_some(),
        /// A task is to be announced: one that is no longer serviced, or the next one asked for.
        task_left: point.abandoned().is_some() || point.new_tasks().next().is_some(),
        /// A task that is serviced is to end: its robots are free then.
        awaits_end: point.awaits_end(),
        /// A task has ended since it announced its task, or so shortly before that robots could not be recruited yet.
        has_freed: point.has_freed(),
        /// Robots of a task that has ended, or of a team that has given up, may have yet to become redundant.
        awaits_retirements: point.awaits_retirements(),
        /// A task is still to come, or to end: the user will ask for it, or it is serviced for a time.
        task_to_come: point.expects_task(),
        /// A task that is serviced has not been heard of in this control period.
        awaits_services: point.awaits_services(),
        /// A task that is not pursued is over, and not closed yet.
        task_over: point.next_closing().is_some(),
        /// The task that is pursued has been taken back.
        pursues_withdrawn: point.pursues_withdrawn(),
        /// The newest notice that it has taken up announces a path Σ.
        path_announced: matches!(point.notice(), Notice::Path(_)),
        /// It knows the roster of the election.
        knows_electors: point.announced().is_some(),
        /// The token of every robot that takes part is known.
        election_over: point.is_election_over(),
        /// A leader is being elected, and the robots do not end the mission themselves where none of them bids.
        leader_wanted: matches!(point.notice(), Notice::Task(task) if task.last_resort.is_none()),
        /// A robot has bid in the election.
        has_bid: point.ballot.best().is_some(),
    }
}

/// What a transition does beside changing the location.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum ServiceEffect {
    /// It takes up this bulletin.
    TakeUp(Bulletin),
    /// It issues the next notice.
    Issue(Notice),
    /// It issues a notice that supersedes those that others issue meanwhile.
    Supersede(Notice),
    /// This task is over: its robots hear so.
    Close(usize),
    /// No robot can service this task.
    GiveUp(usize, Outcome),
    /// It reports to observers.
    Report(MissionEvent),
}

type Effects = Vec<ServiceEffect>;

impl Holds<Serving> for AccessPoint {
    type Effects = Effects;

    fn current(&self) -> &Current<Serving> {
        self.tasks.current()
    }

    fn current_mut(&mut self) -> &mut Current<Serving> {
        self.tasks.current_mut()
    }

    fn carry_out(&mut self, effects: Effects) {
        self.has_news = true;
        for effect in effects {
            match effect {
                ServiceEffect::TakeUp(bulletin) => self.take_up(bulletin),
                ServiceEffect::Issue(notice) => {
                    let bulletin = self.notices.bulletin().next(self.id(), Shared::new(notice));
                    self.take_up(bulletin);
                }
                ServiceEffect::Supersede(notice) => {
                    let bulletin =
                        self.notices.bulletin().superseding(self.id(), Shared::new(notice));
                    self.take_up(bulletin);
                }
                ServiceEffect::Close(task) => self.close(task),
                ServiceEffect::GiveUp(task, outcome) => self.tasks.give_up(task, outcome),
                ServiceEffect::Report(event) => self.outbox.report(event),
            }
        }
    }
}

impl AccessPoint {
    /// The task announced last and the electors of its leader, if they matter and are known.
    pub(super) fn announced(&self) -> Option<&Announced> {
        match &**self.tasks.current() {
            Serving::Electing(Electing { announced })
            | Serving::UnderWay(UnderWay { announced }) => announced.as_ref(),
            _ => None,
        }
    }

    /// How and why the robots have given up a task, as it hears.
    fn heard_failure(&self) -> Option<(Outcome, &str)> {
        match self.tasks.newest_notice()? {
            Notice::Ended { outcome, reason, .. } if outcome.is_given_up() => {
                Some((*outcome, reason))
            }
            _ => None,
        }
    }

    /// Whether it hears that the mission has ended with a task that is given up.
    fn hears_failure(&self) -> bool {
        self.heard_failure().is_some()
    }

    /// Whether it hears that the mission has ended for lack of robots.
    pub(super) fn hears_want(&self) -> bool {
        self.heard_failure().is_some_and(|(outcome, _)| outcome == Outcome::InsufficientRobots)
    }

    /// The robots that take part in the elections for its task.
    fn electors(&self) -> impl Iterator<Item = &Attendee> {
        let roster = self.announced().into_iter().flat_map(|announced| announced.roster.iter());
        roster.filter_map(|robot| self.roster.attendee(robot))
    }

    /// The robots that have taken part in the service of its task, and are gone.
    fn missed(&self) -> impl Iterator<Item = NodeId> {
        let pursued = self.announced();
        let has_taken_part = move |robot: &NodeId| {
            pursued.is_some_and(|it| {
                it.roster.contains(*robot) || self.roster.joiners().contains(*robot)
            })
        };
        self.roster.gone().into_iter().filter(has_taken_part)
    }

    fn misses_robot(&self) -> bool {
        self.missed().next().is_some() || self.forgetful().next().is_some()
    }

    /// The robots that take part, and not in the elections for its task.
    fn newcomers(&self) -> impl Iterator<Item = NodeId> {
        let pursued = self.announced();
        let is_new = move |robot| pursued.is_some_and(|it| !it.roster.contains(robot));
        self.roster.robots_that(Attendee::takes_part).filter(move |&robot| is_new(robot))
    }

    /// The robots that take part in the elections for its task and knew no way to an access point when it was
    /// announced.
    fn wayless(&self) -> impl Iterator<Item = NodeId> {
        self.announced().into_iter().flat_map(|announced| announced.wayless.iter())
    }

    /// Those of them that still know none.
    fn searchers(&self) -> impl Iterator<Item = NodeId> {
        self.wayless().filter(|&robot| !self.roster.connected().contains(robot))
    }

    /// Those of them that know one now, and could not bid in the election.
    fn finders(&self) -> impl Iterator<Item = NodeId> {
        self.wayless().filter(|&robot| self.roster.connected().contains(robot))
    }

    /// For how many rounds it waits for a robot that knows no way to an access point, if there is one.
    pub(super) fn longest_search(&self) -> usize {
        let is_awaited = self.searchers().next().is_some();
        usize::from(is_awaited) * self.patience_with_searches()
    }

    /// Rounds after which a robot that looks for another parent has found one, if there is one.
    pub(super) fn patience_with_searches(&self) -> usize {
        PATIENCE_WITH_SEARCHES
            * self.site.settings.rounds_per_period.min(self.notices.longest_wait())
    }

    /// A task that it announces now, with those who elect its leader.
    pub(super) fn announced_now(&self, announcement: &Announcement) -> Announced {
        let is_wayless = |&robot: &NodeId| !self.roster.connected().contains(robot);
        let wayless = Arc::new(announcement.roster.iter().filter(is_wayless).collect());
        Announced { wayless, ..electors_of(announcement) }
    }

    /// The robots that take part in the elections for its task, or are on Σ, and have restarted since it was
    /// announced.
    fn forgetful(&self) -> impl Iterator<Item = NodeId> {
        let is_pursued = self.announced().is_some();
        self.notices.forgetful().iter().filter(move |_| is_pursued)
    }

    /// The first task that has been serviced, is not over, and has not been serviced for as long as it takes
    /// to give a robot up.
    pub(super) fn abandoned_task(&self) -> Option<usize> {
        let patience = self.site.patience_with_tasks();
        let mut services = self.services();
        services.find(|(_, known)| known.silence > patience).map(|(task, _)| task)
    }

    /// Whether a task that has been serviced, and is not over, has not been reported in this control period.
    fn awaits_services(&self) -> bool {
        self.services().any(|(_, known)| known.silence > 0)
    }

    /// The tasks that have been serviced and are not over.
    fn services(&self) -> impl Iterator<Item = (usize, TaskRecord)> {
        self.tasks.records().filter(|&(task, _)| self.is_open(task))
    }

    fn is_open(&self, task: usize) -> bool {
        !self.notices.closed().contains(task)
    }

    /// The task to announce next: the first that has been serviced and is not any more, or the next one of the others
    /// by the order of the mission; none that is over.
    pub(super) fn next_task(&self) -> Option<usize> {
        self.abandoned().or_else(|| self.next_new_task())
    }

    /// The first task asked for that has been serviced and is not any more.
    fn abandoned(&self) -> Option<usize> {
        let asked_for = self.tasks.errands().count();
        self.abandoned_task().filter(|&task| task < asked_for)
    }

    /// The tasks asked for that have not been serviced and are not over.
    fn new_tasks(&self) -> impl Iterator<Item = (usize, Errand)> {
        let is_new = |task| self.tasks.record(task).is_none() && self.is_open(task);
        self.tasks.errands().filter(move |&(task, _)| is_new(task))
    }

    fn next_new_task(&self) -> Option<usize> {
        let mut tasks = self.new_tasks();
        let next = match self.site.settings.order {
            TaskOrder::File => tasks.next(),
            TaskOrder::Priority => {
                tasks.min_by_key(|(_, errand)| std::cmp::Reverse(errand.priority))
            }
            TaskOrder::Nearest => {
                let roots = self.roots();
                let ways = tasks.map(|it| (self.site.way_from(&roots, it.1.position), it));
                ways.min_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, it)| it)
            }
        };
        next.map(|(task, _)| task)
    }

    /// The places from which the tree grows: the access points, and the tasks that are serviced.
    fn roots(&self) -> Vec<Point> {
        let tasks = self.services().filter_map(|(task, _)| self.tasks.position_of(task));
        self.site.access_points.iter().copied().chain(tasks).collect()
    }

    /// Whether the user will ask for another task, or one is serviced that is to end.
    fn expects_task(&self) -> bool {
        self.tasks.requested().is_some_and(|order| order.continues)
            || self.tasks_to_end().next().is_some()
    }

    /// Whether a task that is serviced is to end.
    fn awaits_end(&self) -> bool {
        let pursued = self.pursued_task();
        let is_serviced = |task| self.tasks.record(task).is_some() && pursued != Some(task);
        self.tasks_to_end().any(is_serviced)
    }

    /// The tasks asked for that last for a time, and are not over.
    fn tasks_to_end(&self) -> impl Iterator<Item = usize> {
        let lasting = self.tasks.errands().filter(|(_, errand)| errand.lasts.is_some());
        lasting.map(|(task, _)| task).filter(|&task| self.is_open(task))
    }

    /// The task that it pursues, if it knows who takes part.
    fn pursued_task(&self) -> Option<usize> {
        self.announced().map(|announced| announced.task)
    }

    /// Whether the task that is pursued has been taken back.
    fn pursues_withdrawn(&self) -> bool {
        let is_over = |task| !self.is_open(task) || self.tasks.is_withdrawn(task);
        self.pursued_task().is_some_and(is_over)
    }

    /// The first task that is not pursued and is over, with what has become of it.
    fn next_closing(&self) -> Option<(usize, MissionEvent)> {
        let pursued = self.pursued_task();
        let mut open =
            self.tasks.errands().filter(|&(task, _)| self.is_open(task) && pursued != Some(task));
        open.find_map(|(task, errand)| {
            let serviced = self.tasks.record(task);
            let has_ended = |periods| serviced.is_some_and(|known| known.has_lasted(periods));
            match errand.lasts {
                _ if errand.withdrawn => Some((task, MissionEvent::TaskWithdrawn { task })),
                Some(periods) if has_ended(periods) => {
                    Some((task, MissionEvent::TaskEnded { task }))
                }
                _ => None,
            }
        })
    }

    /// The access points whose robots have been asked in the election under way, if those of others had been before.
    fn access_points_left(&self) -> Option<Vec<usize>> {
        let Notice::Task(announcement) = self.notice() else { return None };
        let left: Vec<usize> = announcement.eligible.iter().collect();
        (left.len() < self.site.access_points.len()).then_some(left)
    }

    /// The robots that have not answered in the election under way.
    fn unanswering(&self, roster: &IdSet) -> Vec<NodeId> {
        roster.iter().filter(|&robot| !self.ballot.has_token(robot)).collect()
    }

    /// The announcement of a task to the robots that take part now.
    pub(super) fn announcement_of(&self, task: usize) -> Option<Announcement> {
        let requested = self.tasks.requested()?;
        Some(Announcement {
            task,
            position: self.tasks.position_of(task)?,
            before: requested.positions(self.tasks.end().max(task)),
            roster: self.roster.present_now(),
            eligible: self.site.all_access_points(),
            again: false,
            stretched: false,
            last_resort: None,
        })
    }

    /// How it issues a notice. Robots that it misses may know later ones, or go by an earlier announcement
    /// when they come back.
    fn issue(&self, notice: Notice) -> ServiceEffect {
        match self.roster.absent_robots().next().is_some()
            || self.notices.bulletin().id().is_late_in_its_epoch()
        {
            true => ServiceEffect::Supersede(notice),
            false => ServiceEffect::Issue(notice),
        }
    }

    /// The task that is pursued with its electors, as robots tell it: an access point that restarts
    /// learns of it so.
    fn known_electors(&self) -> Option<Announced> {
        if let Some(announced) = self.announced() {
            return Some(announced.clone());
        }
        let epoch = self.tasks.newest().map(|newest| newest.id().epoch());
        let current = self.notices.announced().filter(|(id, _)| Some(id.epoch()) == epoch);
        current.map(|(_, announcement)| electors_of(announcement))
    }

    /// Why no robot bids for a task.
    fn why_no_bid(&self, task: usize) -> (Outcome, String) {
        let name = self.site.name_of_task(task);
        let absent: Vec<NodeId> = self.roster.absent_robots().collect();
        let cut_off: Vec<NodeId> = self.searchers().collect();
        let no_robot = format!("no robot is left that can go to task {name}");
        if !absent.is_empty() {
            let why = why_absent(&self.site.names_of(&absent));
            return (Outcome::InsufficientRobots, format!("{no_robot}: {why}"));
        }
        if !cut_off.is_empty() {
            let cut_off = phrase::robots(&self.site.names_of(&cut_off), ["knows", "know"]);
            let why = format!("{cut_off} no way to an access point any more");
            return (Outcome::InsufficientRobots, format!("{no_robot}: {why}"));
        }
        if let Some(left) = self.access_points_left() {
            let reason = format!(
                "no robot of {} can lead a team to task {name}, and those of the others find no recruit",
                phrase::named("access point", &left)
            );
            return (Outcome::InsufficientRobots, reason);
        }
        let reason = format!(
            "no robot can come within the service radius of task {name}: it lies in a wall, too near \
             to one, or in a part of the workspace that no robot can enter"
        );
        (Outcome::UnreachableTask, reason)
    }

    /// Why the election for a task cannot end.
    fn why_unanswered(&self, announced: &Announced) -> String {
        let missing = self.site.names_of(&self.unanswering(&announced.roster));
        let name = self.site.name_of_task(announced.task);
        let missing = phrase::robots(&missing, ["does", "do"]);
        format!("the election for task {name} cannot end: {missing} not answer any more")
    }

    fn is_election_over(&self) -> bool {
        self.announced().is_some_and(|announced| {
            self.ballot.election().is_some_and(|known| known.is_complete(&announced.roster))
        })
    }
}

fn electors_of(announcement: &Announcement) -> Announced {
    let Announcement { task, ref roster, .. } = *announcement;
    Announced { task, roster: Arc::clone(roster), wayless: Arc::default(), unanswered: 0 }
}

// ---- The resets ------------------------------------------------------------------------------

/// It takes up the notice that it has heard.
fn take_up(point: &AccessPoint, effects: &mut Effects) -> Option<Notice> {
    let newest = point.tasks.newest()?.clone();
    let notice = Notice::clone(newest.notice());
    effects.push(ServiceEffect::TakeUp(newest));
    Some(notice)
}

fn hear_election(_: &Serving, point: &AccessPoint, effects: &mut Effects) -> Option<Electing> {
    let announced = match take_up(point, effects)? {
        Notice::Task(announcement) => Some(electors_of(&announcement)),
        _ => point.known_electors(),
    };
    Some(Electing { announced })
}

fn hear_progress(_: &Serving, point: &AccessPoint, effects: &mut Effects) -> Option<UnderWay> {
    take_up(point, effects)?;
    Some(UnderWay { announced: point.known_electors() })
}

fn hear_service(_: &Serving, point: &AccessPoint, effects: &mut Effects) -> Option<Done> {
    match take_up(point, effects)? {
        Notice::Serviced { task } | Notice::Withdrawn { task } => Some(Done { task }),
        _ => None,
    }
}

fn hear_end(_: &Serving, point: &AccessPoint, effects: &mut Effects) -> Option<Over> {
    take_up(point, effects).map(|_| Over)
}

fn announce<A>(_: &A, point: &AccessPoint, effects: &mut Effects) -> Option<Electing> {
    let task = point.next_task()?;
    let announcement = point.announcement_of(task)?;
    let announced = Some(point.announced_now(&announcement));
    let is_new = point.tasks.record(task).is_none();
    effects.push(ServiceEffect::Report(match is_new {
        true => MissionEvent::TaskAnnounced { task },
        false => {
            MissionEvent::TaskReannounced { task, gone: point.roster.gone(), joined: Vec::new() }
        }
    }));
    effects.push(point.issue(Notice::Task(Shared::new(announcement))));
    Some(Electing { announced })
}

/// The user has taken back the task that is pursued: those who pursue it stop, and its team is dissolved.
fn withdraw(_: &Serving, point: &AccessPoint, effects: &mut Effects) -> Option<Done> {
    let task = point.announced()?.task;
    if point.is_open(task) {
        effects.push(ServiceEffect::Report(MissionEvent::TaskWithdrawn { task }));
    }
    effects.push(ServiceEffect::Supersede(Notice::Withdrawn { task }));
    Some(Done { task })
}

/// No robot can service the task that is pursued: those who pursue it stop, and its team is dissolved.
fn give_up<A>(_: &A, point: &AccessPoint, effects: &mut Effects) -> Option<Done> {
    let announced = point.announced()?;
    let task = announced.task;
    let (outcome, reason) = match point.heard_failure() {
        Some((outcome, reason)) => (outcome, reason.to_string()),
        None if point.is_election_over() => point.why_no_bid(task),
        None => (Outcome::Blocked, point.why_unanswered(announced)),
    };
    effects.extend([
        ServiceEffect::GiveUp(task, outcome),
        ServiceEffect::Report(MissionEvent::TaskGivenUp {
            task,
            outcome,
            reason,
            certificate: None,
        }),
        ServiceEffect::Supersede(Notice::Withdrawn { task }),
    ]);
    Some(Done { task })
}

/// A task is over that is not pursued.
fn close(_: &Serving, point: &AccessPoint, effects: &mut Effects) -> Option<()> {
    let (task, event) = point.next_closing()?;
    effects.extend([ServiceEffect::Close(task), ServiceEffect::Report(event)]);
    Some(())
}

/// The task is announced again, to the robots that are left.
fn announce_again<A>(_: &A, point: &AccessPoint, effects: &mut Effects) -> Option<Electing> {
    let Announced { task, roster, unanswered, .. } = point.announced()?.clone();
    let announcement = point.announcement_of(task)?;
    let is_in_vain = !point.misses_robot() && !point.hears_failure();
    let is_unanswered = is_in_vain && !point.is_election_over();
    let is_unbid = is_in_vain && point.is_election_over();
    let finders: Vec<NodeId> = point.finders().filter(|_| is_unbid).collect();
    let counts = is_unanswered || !finders.is_empty();
    let gone = match is_unanswered {
        true => point.unanswering(&roster),
        false => point.missed().chain(point.forgetful()).collect(),
    };
    let joined = point.newcomers().chain(finders).collect();
    effects.push(ServiceEffect::Report(MissionEvent::TaskReannounced { task, gone, joined }));
    let unanswered = unanswered + u32::from(counts);
    let announced = Some(Announced { unanswered, ..point.announced_now(&announcement) });
    effects.push(ServiceEffect::Supersede(Notice::Task(Shared::new(announcement))));
    Some(Electing { announced })
}

/// The mission ends. Robots that are missed may know later notices than the access point.
fn end(
    point: &AccessPoint,
    effects: &mut Effects,
    outcome: Outcome,
    task: Option<usize>,
    reason: String,
) -> Over {
    effects.push(point.issue(Notice::Ended { outcome, reason: reason.into(), task }));
    Over
}

fn end_without_robots<A>(_: &A, point: &AccessPoint, effects: &mut Effects) -> Over {
    let mut reason = "no robot is connected to an access point".to_owned();
    let gone = point.roster.gone();
    if !gone.is_empty() {
        reason.push_str(&format!(" any more: {}", why_absent(&point.site.names_of(&gone))));
    }
    end(point, effects, Outcome::InsufficientRobots, point.next_task(), reason)
}

/// No task is left. Where some have been given up, the outcome is that of the first of them.
fn finish<A>(_: &A, point: &AccessPoint, effects: &mut Effects) -> Over {
    let (count, closed, given_up) =
        (point.tasks.errands().count(), point.notices.closed().len(), point.tasks.given_up().len());
    let over = closed.saturating_sub(given_up);
    let serviced = count.saturating_sub(closed);
    let mut reason = match closed {
        0 => format!("all {count} tasks are serviced"),
        _ => format!("of {count} tasks {serviced} are serviced"),
    };
    if over > 0 {
        reason.push_str(&format!(", and {over} have ended or been taken back"));
    }
    if given_up > 0 {
        let tasks: Vec<usize> = point.tasks.given_up().iter().map(|&(task, _)| task).collect();
        let names: Vec<usize> = tasks.iter().map(|&task| point.site.name_of_task(task)).collect();
        reason.push_str(&format!("; no robot could service {}", phrase::named("task", &names)));
    }
    let outcome = point.tasks.given_up().first().map_or(Outcome::Serviced, |&(_, outcome)| outcome);
    end(point, effects, outcome, None, reason)
}

fn end_without_bid(place: &Electing, point: &AccessPoint, effects: &mut Effects) -> Option<Over> {
    let task = place.announced.as_ref()?.task;
    let (outcome, reason) = point.why_no_bid(task);
    Some(end(point, effects, outcome, Some(task), reason))
}

fn end_unanswered(place: &Electing, point: &AccessPoint, effects: &mut Effects) -> Option<Over> {
    let announced = place.announced.as_ref()?;
    let reason = point.why_unanswered(announced);
    Some(end(point, effects, Outcome::Blocked, Some(announced.task), reason))
}

// ---- The automaton ---------------------------------------------------------------------------

type Row = Transfer<Service, ServiceEvent, AccessPoint>;

fn announces<A: DataOf<Serving>>(guard: Guard) -> Row {
    Transfer::where_known(ServiceEvent::Announces, guard, "announce the next task", announce::<A>)
}

fn announces_again<A: DataOf<Serving>>(guard: Guard) -> Row {
    let name = "announce the task again";
    Transfer::where_known(ServiceEvent::AnnouncesAgain, guard, name, announce_again::<A>)
}

fn no_robot<A: DataOf<Serving>>(guard: Guard) -> Row {
    let name = "end the mission: insufficient robots";
    Transfer::new(ServiceEvent::NoRobot, guard, name, end_without_robots::<A>)
}

fn all_serviced<A: DataOf<Serving>>(guard: Guard) -> Row {
    let name = "end the mission: no task is left";
    Transfer::new(ServiceEvent::AllServiced, guard, name, finish::<A>)
}

fn gives_up<A: DataOf<Serving>>(guard: Guard) -> Row {
    let name = "announce that the task is given up";
    Transfer::where_known(ServiceEvent::GivesUp, guard, name, give_up::<A>)
}

/// The automaton of the service of the user's tasks.
///
/// # Errors
/// Never with the table and guards of this crate; they are still checked.
pub(in crate::network) fn service_automaton() -> Result<ServiceAutomaton, BuildError> {
    let notices = ["hears_election", "hears_progress", "hears_service", "hears_end"];
    Automaton::builder(SERVICE, Service::Gathering)
        .observing()
        .at_most_one(&notices)
        .carried_out(Transfer::from_any_where_known(
            Service::ANY,
            ServiceEvent::ElectionHeard,
            guards::election_heard(),
            "take up the election",
            hear_election,
        ))
        .carried_out(Transfer::from_any_where_known(
            Service::ANY,
            ServiceEvent::ProgressHeard,
            guards::progress_heard(),
            "take up the notice",
            hear_progress,
        ))
        .carried_out(Transfer::from_any_where_known(
            Service::ANY,
            ServiceEvent::ServiceHeard,
            guards::service_heard(),
            "take up the notice",
            hear_service,
        ))
        .carried_out(Transfer::from_any_where_known(
            Service::OPEN,
            ServiceEvent::EndHeard,
            guards::end_heard(),
            "take up the notice",
            hear_end,
        ))
        .carried_out(Transfer::from_any_where_known(
            Service::PURSUING,
            ServiceEvent::Withdraws,
            guards::withdraws(),
            "announce that the task is taken back",
            withdraw,
        ))
        .carried_out(Transfer::staying_in(
            Service::OPEN,
            ServiceEvent::Closes,
            guards::closes(),
            "close the task",
            close,
        ))
        .carried_out(gives_up::<Electing>(guards::gives_up_election()))
        .carried_out(gives_up::<UnderWay>(guards::gives_up()))
        .carried_out(announces::<Gathering>(guards::announces_first()))
        .carried_out(announces::<Done>(guards::announces_next()))
        .carried_out(announces_again::<Electing>(guards::elects_again()))
        .carried_out(announces_again::<UnderWay>(guards::announces_again()))
        .carried_out(no_robot::<Gathering>(guards::no_robot_first()))
        .carried_out(no_robot::<Electing>(guards::no_robot_left()))
        .carried_out(no_robot::<UnderWay>(guards::no_robot_left()))
        .carried_out(no_robot::<Done>(guards::no_robot_next()))
        .carried_out(all_serviced::<Gathering>(guards::nothing_to_service()))
        .carried_out(all_serviced::<Done>(guards::all_serviced()))
        .carried_out(Transfer::where_known(
            ServiceEvent::NoBid,
            guards::no_bid(),
            "end the mission: unreachable task",
            end_without_bid,
        ))
        .carried_out(Transfer::where_known(
            ServiceEvent::NoAnswer,
            guards::no_answer(),
            "end the mission: blocked",
            end_unanswered,
        ))
        .build()
}
