//! What a person needs in order to judge a mission that has ended.

use crate::automaton::network::phrase;
use crate::automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use crate::automaton::network::scenario::{LinkCount, Settings, ValidScenario};
use crate::automaton::network::{KernelTimes, Site};
use crate::figures::quantity;
use crate::mission::{Completed, Watcher};
use crate::verify::network::{Extreme, Extremes, TreeLinks};
use std::fmt;
use std::io;
use std::sync::Arc;
use std::time::Duration;

/// A watcher that collects the summary; shown with `{}` it is a short text.
#[derive(Clone, Debug)]
pub struct Summary {
    name: String,
    settings: Settings,
    tasks: Vec<TaskSummary>,
    recruits: usize,
    stationary_points: usize,
    periods: usize,
    seconds: f64,
    site: Arc<Site>,
    links: TreeLinks,
    completed: Option<(Completed, Duration)>,
}

/// What became of a task.
#[derive(Clone, Debug, PartialEq)]
pub struct TaskSummary {
    /// q_v: where it is.
    pub position: [f64; 2],
    /// The control period in which it was serviced, and the robot that did.
    pub serviced: Option<(usize, usize)>,
    /// The robot that stays close to it now; duties are exchanged, so it may be another one. None if that has
    /// stopped, or is not heard.
    pub holder: Option<usize>,
    /// The control period since which it is over, and how that came.
    pub closed: Option<(usize, Closing)>,
}

/// How a task came to be over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Closing {
    /// It was serviced for as long as it was to be.
    Ended,
    /// The user took it back.
    Withdrawn,
    /// No robot could service it, for this reason.
    GivenUp(String),
}

impl TaskSummary {
    /// By which robot it was serviced, and since when it is over, or which holds it now if that is another
    /// one, or none.
    pub(crate) fn robots(&self) -> Option<String> {
        let (_, robot) = self.serviced?;
        let held = match self.holder {
            _ if self.closed.is_some() => {
                self.closing().map_or(String::new(), |it| format!(", {it}"))
            }
            Some(holder) if holder == robot => String::new(),
            Some(holder) => format!(", held by robot {holder} at the end"),
            None => ", held by none at the end".to_owned(),
        };
        Some(format!("by robot {robot}{held}"))
    }

    /// Since when it is over, and how that came.
    pub(crate) fn closing(&self) -> Option<String> {
        self.closed.as_ref().map(|(step, closing)| match closing {
            Closing::Ended => format!("ended at k = {step}"),
            Closing::Withdrawn => format!("taken back at k = {step}"),
            Closing::GivenUp(_) => format!("given up at k = {step}"),
        })
    }

    /// Its state if it was not serviced; why it was given up, unless the end of the mission says so.
    pub(crate) fn unserviced(&self, end: Option<&End>) -> String {
        let closing = self.closing().unwrap_or_else(|| "not serviced".to_owned());
        let is_told = |reason: &&str| end.is_some_and(|end| end.reason.contains(*reason));
        match self.given_up().filter(|reason| !is_told(reason)) {
            Some(reason) => format!("{closing}: {reason}"),
            None => closing,
        }
    }

    /// Why it was given up, if it was.
    pub fn given_up(&self) -> Option<&str> {
        match &self.closed {
            Some((_, Closing::GivenUp(reason))) => Some(reason),
            _ => None,
        }
    }

    /// Whether it has been serviced, and is over or a robot still stays close to it.
    fn is_serviced(&self) -> bool {
        let is_held_or_over = self.holder.is_some() || self.closed.is_some();
        self.serviced.is_some() && is_held_or_over && self.given_up().is_none()
    }
}

/// How near a mission came to a bound.
pub(crate) struct Measured {
    pub name: &'static str,
    /// The value, rounded for people.
    pub value: String,
    /// The control period.
    pub step: usize,
    /// The robots concerned.
    pub robots: String,
    /// The bound with its symbol.
    pub bound: String,
}

/// How near a mission came to each of its bounds.
pub(crate) fn measured(extremes: &Extremes, settings: &Settings) -> Vec<Measured> {
    let Settings { clearance, residual_tolerance, .. } = *settings;
    let rows = [
        ("smallest distance", &extremes.pair_distance, "2ρ", 2.0 * clearance),
        ("smallest clearance", &extremes.clearance, "ρ", clearance),
        ("smallest residual", &extremes.residual, "−c_min", 0.0 - residual_tolerance),
        ("largest load", &extremes.load, "at most", 1.0),
    ];
    let measured = rows.into_iter().filter_map(|(name, extreme, symbol, bound)| {
        let Extreme { value, instant, robots } = extreme.as_ref()?;
        // What rounds to zero has no sign.
        let value = (value * 1e6).round() / 1e6 + 0.0;
        Some(Measured {
            name,
            value: format!("{value:.6}"),
            step: instant.step,
            robots: phrase::named("robot", robots),
            bound: format!("{symbol} {}", quantity(bound)),
        })
    });
    measured.collect()
}

/// How many links of the tree cross walls, as a clause.
pub(crate) fn links_told(links: &TreeLinks) -> String {
    let of = |LinkCount { links, through_walls }: LinkCount| format!("{through_walls} of {links}");
    let at_most = match links.most() {
        Some((most, instant)) => format!("at most {}, at k = {}", of(most), instant.step),
        None => "none before".to_owned(),
    };
    format!("{} links of the tree at the end; {at_most}", of(links.last()))
}

/// What links through walls may mean for the user.
pub(crate) const LINKS_WARNING: &str = "more than a tenth of the links of the tree cross walls, which the model of \
                                        the radio does not see; ranges should be those that hold through walls";

impl Summary {
    /// The summary of a mission that has not begun.
    pub fn new(scenario: &ValidScenario) -> Self {
        Self {
            name: scenario.name.clone(),
            settings: *scenario.settings(),
            tasks: (scenario.task.iter())
                .map(|task| TaskSummary {
                    position: task.position,
                    serviced: None,
                    holder: None,
                    closed: None,
                })
                .collect(),
            recruits: 0,
            stationary_points: 0,
            periods: 0,
            seconds: 0.0,
            site: Arc::clone(scenario.site()),
            links: TreeLinks::default(),
            completed: None,
        }
    }

    /// Adds how the mission ended and the time that the whole run took.
    #[must_use]
    pub fn completed(mut self, completed: Completed, elapsed: Duration) -> Self {
        self.completed = Some((completed, elapsed));
        self
    }

    /// The tasks in order of announcement.
    pub fn tasks(&self) -> &[TaskSummary] {
        &self.tasks
    }

    /// The number of recruits elected.
    pub fn recruits(&self) -> usize {
        self.recruits
    }

    fn close(&mut self, task: usize, step: usize, closing: Closing) {
        if let Some(task) = self.tasks.get_mut(task) {
            task.closed = Some((step, closing));
        }
    }

    /// The number of tasks serviced; one that was left again, since its robot has stopped, does not count.
    pub fn serviced(&self) -> usize {
        self.tasks.iter().filter(|task| task.is_serviced()).count()
    }

    /// The number of control periods.
    pub fn periods(&self) -> usize {
        self.periods
    }

    /// The time that the mission took, in seconds.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// The links of the tree, and how many of them crossed walls.
    pub fn links(&self) -> &TreeLinks {
        &self.links
    }

    /// The number of local stationary points met.
    pub fn stationary_points(&self) -> usize {
        self.stationary_points
    }
}

impl Watcher for Summary {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        for event in events {
            match *event {
                MissionEvent::RecruitElected { .. } => self.recruits += 1,
                MissionEvent::Stationary { .. } => self.stationary_points += 1,
                MissionEvent::TaskServiced { task, robot } => {
                    if let Some(task) = self.tasks.get_mut(task) {
                        task.serviced = Some((snapshot.step, robot));
                    }
                }
                MissionEvent::TaskEnded { task } => {
                    self.close(task, snapshot.step, Closing::Ended);
                }
                MissionEvent::TaskWithdrawn { task } => {
                    self.close(task, snapshot.step, Closing::Withdrawn);
                }
                MissionEvent::TaskGivenUp { task, ref reason, .. } => {
                    self.close(task, snapshot.step, Closing::GivenUp(reason.clone()));
                }
                _ => {}
            }
        }
        for task in &mut self.tasks {
            task.holder = None;
        }
        for &(task, robot) in &snapshot.serviced {
            if let Some(task) = self.tasks.get_mut(task) {
                task.holder = Some(robot);
            }
        }
        self.links.observe(snapshot, &self.site);
        self.periods = snapshot.step.saturating_add(1);
        self.seconds = snapshot.time + self.settings.period;
        Ok(())
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write_outcome(formatter)?;
        self.write_tasks(formatter)?;
        writeln!(formatter, "  recruits elected    {}", self.recruits)?;
        writeln!(formatter, "  stationary points   {}", self.stationary_points)?;
        writeln!(formatter, "  links through walls {}", links_told(&self.links))?;
        if self.links.are_worth_a_warning() {
            writeln!(formatter, "  warning             {LINKS_WARNING}")?;
        }
        let Some((completed, elapsed)) = &self.completed else { return Ok(()) };
        self.write_extremes(&completed.extremes, formatter)?;
        self.write_times(&completed.times, *elapsed, formatter)
    }
}

impl Summary {
    fn write_outcome(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let serviced = self.serviced();
        writeln!(
            formatter,
            "{}: {serviced} of {} tasks serviced in {} control periods ({} s)",
            self.name,
            self.tasks.len(),
            self.periods,
            quantity(self.seconds),
        )?;
        match self.completed.as_ref().map(|(completed, _)| &completed.end) {
            Some(end) if end.outcome == Outcome::Serviced => {
                writeln!(formatter, "  outcome             serviced")
            }
            Some(end) => {
                let outcome = end.outcome.name().replace('_', " ");
                writeln!(formatter, "  outcome             {outcome}: {}", end.reason)
            }
            None => writeln!(formatter, "  outcome             none: the mission goes on"),
        }
    }

    fn write_tasks(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let end = self.completed.as_ref().map(|(completed, _)| &completed.end);
        for (number, task) in self.tasks.iter().enumerate() {
            let [x, y] = task.position;
            let place = format!("({x}, {y})");
            let label = format!("task {number}");
            write!(formatter, "  {label:<19} {place:<14} ")?;
            let serviced = task.serviced.filter(|_| task.given_up().is_none());
            match serviced.zip(task.robots()) {
                Some(((step, _), robots)) => {
                    writeln!(formatter, "serviced at k = {step} {robots}")?;
                }
                None => writeln!(formatter, "{}", task.unserviced(end))?,
            }
        }
        Ok(())
    }

    fn write_extremes(
        &self,
        extremes: &Extremes,
        formatter: &mut fmt::Formatter<'_>,
    ) -> fmt::Result {
        for Measured { name, value, step, robots, bound } in measured(extremes, &self.settings) {
            writeln!(formatter, "  {name:<19} {value} at k = {step} ({robots}); {bound}")?;
        }
        Ok(())
    }

    fn write_times(
        &self,
        times: &KernelTimes,
        elapsed: Duration,
        formatter: &mut fmt::Formatter<'_>,
    ) -> fmt::Result {
        writeln!(
            formatter,
            "  time                {:.3} s, {:.3} ms a control period",
            elapsed.as_secs_f64(),
            1e3 * elapsed.as_secs_f64() / self.periods.max(1) as f64
        )?;
        if *times == KernelTimes::default() {
            return Ok(()); // what was watched was computed elsewhere
        }
        let kernels = [
            ("coordination", times.coordination),
            ("routing", times.routing),
            ("motion", times.motion),
            ("acceptance", times.acceptance),
        ];
        for (kernel, spent) in kernels {
            let share = 100.0 * spent.as_secs_f64() / elapsed.as_secs_f64().max(f64::MIN_POSITIVE);
            writeln!(formatter, "    {kernel:<17} {:.3} s, {share:.1} %", spent.as_secs_f64())?;
        }
        Ok(())
    }
}
