//! `pleach watch`: the mission as it can be seen from what its nodes report.
//!
//! The reports of a control period make a snapshot, the same as in a simulation, and it goes to the
//! same watchers and the same judge. A robot that is not heard any more stands where it was.

use crate::arguments::{MEETING_POINT, OutputArguments, WatchArguments};
use crate::packet::{Refusal, Refusals};
use crate::process::{digest_of, name_of, scenario_in};
use crate::report::{Report, Tally};
use crate::strangers::Strangers;
use crate::transport::{Arrival, Endpoints, Interest, Transport};
use pleach::automaton::network::Robot;
use pleach::automaton::network::observer::{RobotReport, complete_events};
use pleach::automaton::network::record::{End, Faults, MissionEvent, Outcome, Snapshot};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::node::{Node, NodeId, Observed, Traffic};
use pleach::cli::interrupt::Interrupt;
use pleach::cli::job::{self, Outputs};
use pleach::cli::output::{self, tell};
use pleach::cli::plan::Planned;
use pleach::cli::progress::Progress;
use pleach::cli::run::{told, warn_of};
use pleach::cli::status::{Failure, Status};
use pleach::continuous::Point;
use pleach::mission::{Completed, Gallery};
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often an observer looks whether it is to end.
const GLANCE: Duration = Duration::from_millis(50);
/// The reports of a later period that close one: processes are at most one period apart unless one of
/// them is gone.
const PERIODS_APART: usize = 2;
/// Control periods ahead of the one that is shown for which reports are kept.
const MOST_AHEAD: usize = 1 << 10;

/// Watches a mission.
///
/// # Errors
/// What keeps it from being watched.
pub fn run(arguments: &WatchArguments) -> Result<Status, Failure> {
    let faults = Faults { messages: arguments.faults, nodes: arguments.faults };
    let planned = Planned { faults, ..planned(&arguments.scenario)? };
    let digest = digest_of(&planned.scenario)?;
    let defaults = Endpoints { listen: "tcp/127.0.0.1:0", connect: Some(MEETING_POINT) };
    let transport = Transport::open(&arguments.network, defaults, &digest, Interest::Reports)?;
    let (outputs, wait) = (&arguments.outputs, arguments.network.wait.0);
    show(&planned, Viewing { outputs, wait }, &transport, &mut |_| Ok(Vec::new()))
}

/// How a mission is watched.
#[derive(Clone, Copy, Debug)]
pub struct Viewing<'a> {
    /// What is written.
    pub outputs: &'a OutputArguments,
    /// How long nobody may report.
    pub wait: Duration,
}

/// What is called again and again while a mission is watched, with the control period that comes next.
/// It gives the bodies whose place is known although they do not report.
pub type Meanwhile<'a> = dyn FnMut(usize) -> Result<Vec<(NodeId, Point)>, Failure> + 'a;

/// The mission of a scenario file.
///
/// # Errors
/// No mission can start from it.
pub fn planned(path: &Path) -> Result<Planned, Failure> {
    let scenario = scenario_in(path)?;
    let source = path.display().to_string();
    Ok(Planned::once(source, scenario))
}

/// Shows a mission to its end, and says how it has ended.
///
/// # Errors
/// Something cannot be written, or nobody reports for so long.
pub fn show(
    planned: &Planned,
    viewing: Viewing<'_>,
    transport: &Transport,
    meanwhile: &mut Meanwhile<'_>,
) -> Result<Status, Failure> {
    let Viewing { outputs: arguments, wait } = viewing;
    let default_folder = || Path::new("figures").join(&planned.scenario.name);
    let outputs = Outputs {
        trace: arguments.trace.clone(),
        figures: (!arguments.no_figures)
            .then(|| arguments.figures.clone().unwrap_or_else(default_folder)),
        ..Outputs::default()
    };
    if !arguments.quiet {
        warn_of(planned);
    }
    let interrupt = Interrupt::listen()?;
    let mut progress = Progress::new(&planned.scenario, arguments.quiet);
    let digest = digest_of(&planned.scenario)?;
    let mut observatory = Observatory::new(&planned.scenario, &digest, wait);
    let finished = job::watch(planned, &outputs, &mut progress, &interrupt, |watchers| {
        let gallery = Gallery::with_faults(&planned.scenario, planned.faults, watchers);
        observatory.watch(transport, gallery, &interrupt, meanwhile)
    })?;
    let text = told(&finished, arguments.trace.as_deref());
    output::say(&(text + &observatory.counts()))?;
    Ok(finished.record.status)
}

/// What is known from reports.
struct Observatory<'a> {
    scenario: &'a ValidScenario,
    wait: Duration,
    /// The control period that is shown next.
    step: usize,
    /// The last report of each robot.
    robots: Vec<RobotReport>,
    /// The reports of control periods that have not been shown.
    reports: BTreeMap<usize, BTreeMap<NodeId, Report>>,
    /// The nodes that report.
    present: BTreeSet<NodeId>,
    /// Where bodies stand whose robots may not report any more.
    bodies: BTreeMap<NodeId, Point>,
    /// The processes that Zenoh sees.
    alive: BTreeSet<NodeId>,
    strangers: Strangers<'a>,
    /// What each process has counted, with the control period of its newest report.
    tallies: BTreeMap<NodeId, (usize, Tally)>,
    refusals: Refusals,
    missed: u64,
    /// Whether the user has reported that the mission is over: then processes end.
    has_ended: bool,
}

impl<'a> Observatory<'a> {
    fn new(scenario: &'a ValidScenario, digest: &str, wait: Duration) -> Self {
        let site = scenario.site();
        let fresh = |(id, start): (usize, &pleach::automaton::network::scenario::RobotStart)| {
            let robot = Robot::new(id, start.position.into(), start.rate, Arc::clone(site));
            RobotReport::of(robot.view(), robot.body(), Traffic::default())
        };
        Observatory {
            scenario,
            wait,
            step: 0,
            robots: scenario.robot.iter().enumerate().map(fresh).collect(),
            reports: BTreeMap::new(),
            present: (0..scenario.robot.len() + scenario.access_point.len() + 1).collect(),
            bodies: BTreeMap::new(),
            alive: BTreeSet::new(),
            strangers: Strangers::to(scenario, digest),
            tallies: BTreeMap::new(),
            refusals: Refusals::default(),
            missed: 0,
            has_ended: false,
        }
    }

    fn watch(
        &mut self,
        transport: &Transport,
        mut gallery: Gallery<'_, '_>,
        interrupt: &Interrupt,
        meanwhile: &mut Meanwhile<'_>,
    ) -> Result<Completed, Failure> {
        let mut last_news = Instant::now();
        let end = loop {
            if let Some(arrival) = transport.next_within(GLANCE)
                && self.take(arrival)?
            {
                last_news = Instant::now();
            }
            self.bodies.extend(meanwhile(self.step)?);
            if let Some(end) = self.show_what_is_complete(&mut gallery) {
                break end;
            }
            if let Some(signal) = interrupt.signal() {
                break self.broken_off(format!("watching was ended by {signal}"));
            }
            if last_news.elapsed() > self.wait {
                if self.step == 0 {
                    return Err(Failure::Usage(self.nobody_reports()));
                }
                break self.broken_off(self.silence());
            }
        };
        transport.count_overflow(&mut self.refusals);
        Ok(gallery.conclude(end)?)
    }

    fn nobody_reports(&self) -> String {
        let seconds = self.wait.as_secs_f64();
        match (self.strangers.count(), &self.scenario.name) {
            (0, _) => format!(
                "nobody reports for {seconds} s: are the processes started, with the same scenario and \
                 --session, and does --connect name an endpoint at which one listens?"
            ),
            (others, name) => format!(
                "nobody with the scenario {name:?} reports for {seconds} s; nodes of this session with \
                 another one: {others}"
            ),
        }
    }

    /// What has kept the next control period from being shown for so long.
    fn silence(&self) -> String {
        let (seconds, step) = (self.wait.as_secs_f64(), self.step);
        if self.is_passed_over() {
            format!(
                "no report on k = {step} has come within {seconds} s, and reports on later control \
                 periods have: this observer was cut off for a while, and watching ends"
            )
        } else {
            format!("nobody has reported for {seconds} s")
        }
    }

    fn broken_off(&self, what: String) -> End {
        let reason = format!("{what} at k = {}", self.step.saturating_sub(1));
        End::new(Outcome::Interrupted, reason, None)
    }

    // ---- What arrives ------------------------------------------------------------------------

    /// Takes in what has arrived, and says whether it is news of the mission: a report, unless it only
    /// comes after a period that nobody reports; or that a process waits for the mission to begin.
    fn take(&mut self, arrival: Arrival) -> Result<bool, Failure> {
        let count = self.scenario.robot.len() + self.scenario.access_point.len() + 1;
        let taken = match arrival {
            Arrival::Report(from, _) | Arrival::Alive(from, _) | Arrival::Hello(from, _)
                if from >= count =>
            {
                Err(Refusal::NoSuchNode)
            }
            Arrival::Report(from, bytes) => Report::decode(&bytes, self.scenario)
                .and_then(|report| self.enter(from, report))
                .map(|()| !self.is_passed_over()),
            Arrival::Alive(node, is_there) => {
                self.note_life(node, is_there);
                Ok(false)
            }
            Arrival::Hello(from, hello) => {
                let is_stranger = self.strangers.recognise(from, &hello);
                Ok(!is_stranger && !hello.is_running && self.step == 0)
            }
            Arrival::Refused(refusal) => Err(refusal),
            Arrival::Packet(..) => Ok(false),
        };
        if self.step == 0 && self.is_late(&taken) {
            return Err(Failure::Usage(
                "the mission goes on already: start `pleach watch` before its last process".into(),
            ));
        }
        Ok(taken.unwrap_or_else(|refusal| {
            self.refusals.count(refusal);
            false
        }))
    }

    fn enter(&mut self, from: NodeId, report: Report) -> Result<(), Refusal> {
        if (from < self.robots.len()) != report.robot.is_some() {
            return Err(Refusal::Malformed);
        }
        let (step, tally, ends) = (report.step, report.tally, report.end.is_some());
        match step.checked_sub(self.step) {
            None => self.missed += 1,
            Some(ahead) if ahead > MOST_AHEAD => return Err(Refusal::TooFarAhead),
            Some(_) => match self.reports.entry(step).or_default().entry(from) {
                Entry::Occupied(_) => return Err(Refusal::Repeated),
                Entry::Vacant(place) => {
                    place.insert(report);
                }
            },
        }
        self.note_tally(from, step, tally);
        self.has_ended |= ends;
        Ok(())
    }

    /// A process has counted what its newest report says.
    fn note_tally(&mut self, from: NodeId, step: usize, tally: Tally) {
        let newest = self.tallies.entry(from).or_insert((step, tally));
        if newest.0 < step {
            *newest = (step, tally);
        }
    }

    /// A process that goes while the mission goes on is told.
    fn note_life(&mut self, node: NodeId, is_there: bool) {
        let has_changed = if is_there { self.alive.insert(node) } else { self.alive.remove(&node) };
        if has_changed && self.step > 0 && !self.has_ended {
            let (step, name) = (self.step, name_of(self.scenario, node));
            let what = if is_there { "is there again" } else { "is gone" };
            tell(format_args!("k = {step:<6} the process of {name} {what}"));
        }
    }

    // ---- What is shown -----------------------------------------------------------------------

    /// Whether this observer has missed the beginning, as it sees from what it has taken in last and
    /// before.
    fn is_late(&self, taken: &Result<bool, Refusal>) -> bool {
        let is_far_on = *taken == Err(Refusal::TooFarAhead);
        !self.reports.contains_key(&0) && (is_far_on || self.has_later_reports())
    }

    /// Whether a report has come from so late a period that of the one shown next no more is expected.
    fn has_later_reports(&self) -> bool {
        self.reports.range(self.step + PERIODS_APART..).next().is_some()
    }

    /// Whether the reports of the next control period should be there, and not one is. No snapshot is made
    /// of nothing: it would say that all robots stood still, and they have moved.
    fn is_passed_over(&self) -> bool {
        !self.reports.contains_key(&self.step) && self.has_later_reports()
    }

    /// Whether all reports of a control period have come that will.
    fn is_complete(&self, reports: &BTreeMap<NodeId, Report>) -> bool {
        self.present.iter().all(|node| reports.contains_key(node)) || self.has_later_reports()
    }

    /// Shows what is complete, and says how the mission ends if it does.
    fn show_what_is_complete(&mut self, gallery: &mut Gallery<'_, '_>) -> Option<End> {
        while self.reports.get(&self.step).is_some_and(|reports| self.is_complete(reports)) {
            let reports = self.reports.remove(&self.step).unwrap_or_default();
            let (mut events, announced) = self.digest(reports);
            let period = self.scenario.site().settings.period;
            let snapshot = Snapshot::of_reports(self.step, period, &self.robots, self.absent());
            complete_events(&mut events, &snapshot.primary_team);
            self.step += 1;
            let end = gallery.observe(&snapshot, &events);
            let end = end.or_else(|| self.end(announced));
            if end.is_some() {
                return end;
            }
        }
        None
    }

    /// Takes in the reports of a control period: the events in their order, and the end that the user
    /// knows.
    fn digest(&mut self, reports: BTreeMap<NodeId, Report>) -> (Vec<MissionEvent>, Option<End>) {
        self.present = reports.keys().copied().collect();
        let (mut events, mut announced) = (Vec::new(), None);
        for (node, report) in reports {
            events.extend(report.events);
            announced = announced.or(report.end.map(End::from));
            if let Some((known, robot)) = self.robots.get_mut(node).zip(report.robot) {
                *known = robot;
            }
        }
        for (&id, &body) in self.bodies.iter().filter(|(id, _)| !self.present.contains(id)) {
            self.robots[id].position = body;
        }
        // Stable: nodes are in their order in each exchange.
        events.sort_by_key(|(round, answer, _)| (*round, *answer));
        (events.into_iter().map(|(.., event)| event).collect(), announced)
    }

    /// The robots and access points that do not report.
    fn absent(&self) -> Vec<NodeId> {
        let nodes = 0..self.scenario.robot.len() + self.scenario.access_point.len();
        nodes.filter(|node| !self.present.contains(node)).collect()
    }

    /// How the mission ends after this control period, if it does.
    fn end(&self, announced: Option<End>) -> Option<End> {
        let is_present = |id: &usize| self.present.contains(id);
        let mut robots = (0..self.robots.len()).filter(is_present);
        let is_at_rest = !robots.any(|id| self.robots[id].is_active);
        let limit = self.scenario.site().settings.max_steps;
        let at_limit = (self.step >= limit).then(|| End::at_step_limit(limit));
        announced.filter(|_| is_at_rest).or(at_limit)
    }

    /// What the processes have counted, as lines of the summary.
    fn counts(&self) -> String {
        let sum =
            |count: fn(&Tally) -> u64| self.tallies.values().map(|(_, it)| count(it)).sum::<u64>();
        let (refused, late) = (sum(|it| it.refused), sum(|it| it.late));
        let (lost, given_up) = (sum(|it| it.lost), sum(|it| it.given_up));
        let observer = if self.refusals.total() > 0 || self.missed > 0 {
            format!("; observer: {}, {} reports late", self.refusals, self.missed)
        } else {
            String::new()
        };
        format!(
            "  packets             {refused} refused, {late} late; {lost} messages lost on purpose; \
             nodes given up {given_up} times{observer}\n{}",
            self.weight()
        )
    }

    /// How much each robot has sent in a control period, as a line of the summary.
    fn weight(&self) -> String {
        let robots = || self.tallies.range(..self.robots.len()).map(|(_, (_, tally))| tally);
        let shares = (robots().count() * self.step).max(1) as f64;
        let each = |count: fn(&Tally) -> u64| robots().map(count).sum::<u64>() as f64 / shares;
        let unknown: u64 = self.tallies.values().map(|(_, tally)| tally.unknown).sum();
        format!(
            "  each robot sends    {:.1} messages in {:.1} packets of {:.0} bytes a control period; {unknown} \
             digests unknown\n",
            each(|tally| tally.messages),
            each(|tally| tally.packets),
            each(|tally| tally.bytes) / each(|tally| tally.packets).max(1.0),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::Hello;
    use pleach::mission::Watcher;
    use pleach::scenario_file;
    use std::sync::mpsc::sync_channel;
    use std::thread;

    fn scenario() -> ValidScenario {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/too-few.toml");
        scenario_file::read(&path).unwrap()
    }

    fn observatory(scenario: &ValidScenario) -> Observatory<'_> {
        Observatory::new(scenario, "abc", Duration::from_millis(200))
    }

    /// The first report of node `from`, as if it were of control period `step`.
    fn report(observatory: &Observatory<'_>, from: NodeId, step: usize) -> Report {
        let robot = observatory.robots.get(from).cloned();
        Report { step, robot, events: Vec::new(), end: None, tally: Tally::default() }
    }

    #[test]
    fn of_two_reports_on_one_control_period_the_first_holds() {
        let scenario = scenario();
        let mut observatory = observatory(&scenario);
        let first = report(&observatory, 2, 0);
        let end = Some(End::new(Outcome::Serviced, "it says so".into(), None).into());
        let tally = Tally { late: 9, ..Tally::default() };
        let second = Report { end, tally, ..first.clone() };
        assert_eq!(observatory.enter(2, first.clone()), Ok(()));
        assert_eq!(observatory.enter(2, second.clone()), Err(Refusal::Repeated));
        assert_eq!(observatory.reports[&0][&2], first);
        assert_eq!(observatory.tallies[&2], (0, first.tally));
        assert!(!observatory.has_ended);
        let too_far = Report { step: MOST_AHEAD + 1, ..second };
        assert_eq!(observatory.enter(2, too_far), Err(Refusal::TooFarAhead));
        assert_eq!(observatory.tallies[&2], (0, first.tally));
        assert!(!observatory.has_ended);
    }

    #[test]
    fn what_a_process_has_counted_is_in_its_newest_report() {
        let scenario = scenario();
        let mut observatory = observatory(&scenario);
        let late = |late| Tally { late, ..Tally::default() };
        for (step, count) in [(1, 5), (0, 3), (2, 7)] {
            let report = Report { tally: late(count), ..report(&observatory, 2, step) };
            assert_eq!(observatory.enter(2, report), Ok(()));
            assert_eq!(observatory.tallies[&2].1, late(count.max(5)));
        }
    }

    #[test]
    fn only_processes_of_the_same_scenario_are_news_until_the_mission_begins() {
        let scenario = scenario();
        let mut observatory = observatory(&scenario);
        let waiting = Hello::of("robot 2", "too-few", "abc");
        let running = Hello { is_running: true, ..waiting.clone() };
        let stranger = Hello::of("robot 2", "study-1", "abd");
        let mut is_news =
            |node, hello: &Hello| observatory.take(Arrival::Hello(node, hello.clone())).unwrap();
        assert!(is_news(2, &waiting));
        assert!(!is_news(2, &running), "who runs reports, or is not heard of");
        assert!(!is_news(99, &waiting), "there is no such node");
        assert!(!is_news(2, &stranger));
        assert_eq!(observatory.strangers.count(), 1);
        let said = observatory.nobody_reports();
        assert!(said.contains("nobody with the scenario \"too-few\" reports"), "{said}");
        observatory.step = 1;
        assert!(!observatory.take(Arrival::Hello(2, waiting)).unwrap(), "it waits to join");
    }

    #[test]
    fn who_comes_late_is_told_so_however_late() {
        let scenario = scenario();
        for (step, is_late) in [(1, false), (2, true), (MOST_AHEAD + 7, true)] {
            let mut observatory = observatory(&scenario);
            let report = serde_json::to_vec(&report(&observatory, 2, step)).unwrap();
            let taken = observatory.take(Arrival::Report(2, report));
            assert_eq!(taken.is_err(), is_late, "k = {step}: {taken:?}");
        }
    }

    #[test]
    fn watching_ends_where_all_reports_on_a_control_period_are_lost() {
        let scenario = scenario();
        let mut observatory = observatory(&scenario);
        let nodes = scenario.robot.len() + scenario.access_point.len() + 1;
        let of = |step| (0..nodes).map(move |node| (node, step));
        let reports: Vec<Arrival> = of(0)
            .chain((2..100).flat_map(of))
            .map(|(node, step)| {
                let report = report(&observatory, node, step);
                Arrival::Report(node, serde_json::to_vec(&report).unwrap())
            })
            .collect();
        // They come for five seconds, much longer than the observer waits.
        let (sender, arrivals) = sync_channel(nodes);
        let mission = thread::spawn(move || {
            reports.into_iter().try_for_each(|report| {
                thread::sleep(Duration::from_millis(8));
                sender.send(report)
            })
        });
        let transport = Transport::of(arrivals);
        let mut watchers: [&mut dyn Watcher; 0] = [];
        let faults = Faults { messages: true, nodes: true };
        let gallery = Gallery::with_faults(&scenario, faults, &mut watchers);
        let interrupt = Interrupt::listen().unwrap();
        let mut nowhere = |_| Ok(Vec::new());
        let completed = observatory.watch(&transport, gallery, &interrupt, &mut nowhere).unwrap();
        assert!(!mission.is_finished(), "it waits for no other report");
        let End { outcome, reason, .. } = completed.end;
        assert_eq!(outcome, Outcome::Interrupted, "{reason}");
        assert!(reason.contains("no report on k = 1") && reason.ends_with("k = 0"), "{reason}");
    }
}
