//! What a person needs in order to judge a mission that has ended.

use crate::automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use crate::automaton::network::scenario::{Scenario, Settings};
use crate::continuous::Point;
use crate::continuous::geometry::{Segment, Workspace, WorkspaceError};
use crate::mission::Observer;
use std::fmt;
use std::io;
use std::time::Duration;

/// An observer that collects the summary; shown with `{}` it is a short text.
#[derive(Clone, Debug)]
pub struct Summary {
    name: String,
    settings: Settings,
    workspace: Workspace,
    tasks: Vec<TaskSummary>,
    recruits: usize,
    stationary_points: usize,
    last: Option<Instant>,
    pair_distance: Option<Smallest<(usize, usize)>>,
    wall_clearance: Option<Smallest<usize>>,
    residual: Option<Smallest<usize>>,
    end: Option<End>,
    kernel_times: Vec<(&'static str, Duration)>,
    elapsed: Option<Duration>,
}

/// What became of a task.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaskSummary {
    /// q_v: where it is.
    pub position: [f64; 2],
    /// The control period in which it was serviced, and the robot that did.
    pub serviced: Option<(usize, usize)>,
}

/// The smallest value of something that was measured, and where it was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Smallest<W> {
    /// The value.
    pub value: f64,
    /// Who was concerned.
    pub who: W,
    /// The control period in which it was met.
    pub step: usize,
}

#[derive(Clone, Debug)]
struct Instant {
    step: usize,
    time: f64,
    positions: Vec<Point>,
}

impl Summary {
    /// The summary of a mission that has not begun.
    ///
    /// # Errors
    /// The polygons of the scenario do not bound a workspace.
    pub fn new(scenario: &Scenario) -> Result<Self, WorkspaceError> {
        Ok(Self {
            name: scenario.name.clone(),
            settings: Settings::resolve(scenario),
            workspace: scenario.workspace()?,
            tasks: (scenario.task.iter())
                .map(|task| TaskSummary { position: task.position, serviced: None })
                .collect(),
            recruits: 0,
            stationary_points: 0,
            last: None,
            pair_distance: None,
            wall_clearance: None,
            residual: None,
            end: None,
            kernel_times: Vec::new(),
            elapsed: None,
        })
    }

    /// Adds the time that the whole run took and what each kernel had of it.
    #[must_use]
    pub fn with_times(
        mut self,
        elapsed: Duration,
        kernel_times: Vec<(&'static str, Duration)>,
    ) -> Self {
        self.elapsed = Some(elapsed);
        self.kernel_times = kernel_times;
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

    /// The number of local stationary points met.
    pub fn stationary_points(&self) -> usize {
        self.stationary_points
    }

    /// The smallest distance between two robots at any time, not only at the instants seen.
    pub fn pair_distance(&self) -> Option<Smallest<(usize, usize)>> {
        self.pair_distance
    }

    /// The smallest distance between a robot and a wall at any time.
    pub fn wall_clearance(&self) -> Option<Smallest<usize>> {
        self.wall_clearance
    }

    /// The smallest residual c_i at the instants seen.
    pub fn residual(&self) -> Option<Smallest<usize>> {
        self.residual
    }

    /// Measures what the robots went through since the last snapshot; only those that moved can
    /// have come closer to anything.
    fn measure_motion(&mut self, snapshot: &Snapshot) {
        let now = &snapshot.positions;
        let (step, before) = match &self.last {
            Some(last) => (last.step, &last.positions),
            None => (snapshot.step, now),
        };
        let first = self.last.is_none();
        for robot in 0..now.len().min(before.len()) {
            if !first && before[robot] == now[robot] {
                continue;
            }
            let value = self.workspace.segment_clearance(before[robot], now[robot]);
            keep_smaller(&mut self.wall_clearance, Smallest { value, who: robot, step });
            for other in (0..now.len().min(before.len())).filter(|&other| other != robot) {
                let value =
                    passing_distance([before[robot], now[robot]], [before[other], now[other]]);
                let who = (robot.min(other), robot.max(other));
                keep_smaller(&mut self.pair_distance, Smallest { value, who, step });
            }
        }
    }
}

impl Observer for Summary {
    fn event(&mut self, step: usize, event: &MissionEvent) -> io::Result<()> {
        match *event {
            MissionEvent::RecruitElected { .. } => self.recruits += 1,
            MissionEvent::Stationary { .. } => self.stationary_points += 1,
            MissionEvent::TaskServiced { task, robot } => {
                if let Some(task) = self.tasks.get_mut(task) {
                    task.serviced = Some((step, robot));
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Snapshot) -> io::Result<()> {
        self.measure_motion(snapshot);
        for (who, &value) in snapshot.residuals.iter().enumerate() {
            keep_smaller(&mut self.residual, Smallest { value, who, step: snapshot.step });
        }
        self.last = Some(Instant {
            step: snapshot.step,
            time: snapshot.time,
            positions: snapshot.positions.clone(),
        });
        Ok(())
    }

    fn end(&mut self, end: &End) -> io::Result<()> {
        self.end = Some(end.clone());
        Ok(())
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write_outcome(formatter)?;
        self.write_tasks(formatter)?;
        writeln!(formatter, "  recruits elected    {}", self.recruits)?;
        writeln!(formatter, "  stationary points   {}", self.stationary_points)?;
        self.write_extremes(formatter)?;
        self.write_times(formatter)
    }
}

impl Summary {
    fn write_outcome(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let serviced = self.tasks.iter().filter(|task| task.serviced.is_some()).count();
        let (periods, seconds) = self.last.as_ref().map_or((0, 0.0), |last| (last.step, last.time));
        writeln!(
            formatter,
            "{}: {serviced} of {} tasks serviced in {periods} control periods ({seconds} s)",
            self.name,
            self.tasks.len(),
        )?;
        match &self.end {
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
        for (number, TaskSummary { position: [x, y], serviced }) in self.tasks.iter().enumerate() {
            let place = format!("({x}, {y})");
            let label = format!("task {number}");
            match serviced {
                Some((step, robot)) => writeln!(
                    formatter,
                    "  {label:<19} {place:<14} serviced at k = {step} by robot {robot}"
                )?,
                None => writeln!(formatter, "  {label:<19} {place:<14} not serviced")?,
            }
        }
        Ok(())
    }

    fn write_extremes(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Settings { clearance, residual_tolerance, .. } = self.settings;
        if let Some(Smallest { value, who: (first, second), step }) = self.pair_distance {
            writeln!(
                formatter,
                "  smallest distance   {value:.6} between robots {first} and {second} \
                 at k = {step}; 2ρ = {}",
                2.0 * clearance
            )?;
        }
        if let Some(Smallest { value, who, step }) = self.wall_clearance {
            writeln!(
                formatter,
                "  smallest clearance  {value:.6} between robot {who} and a wall at k = {step}; \
                 ρ = {clearance}"
            )?;
        }
        if let Some(Smallest { value, who, step }) = self.residual {
            writeln!(
                formatter,
                "  smallest residual   {value:.6} of robot {who} at k = {step}; −c_min = {}",
                0.0 - residual_tolerance
            )?;
        }
        Ok(())
    }

    fn write_times(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(elapsed) = self.elapsed else { return Ok(()) };
        let periods = self.last.as_ref().map_or(0, |last| last.step).max(1);
        writeln!(
            formatter,
            "  time                {:.3} s, {:.3} ms a control period",
            elapsed.as_secs_f64(),
            1e3 * elapsed.as_secs_f64() / periods as f64
        )?;
        for (kernel, spent) in &self.kernel_times {
            let share = 100.0 * spent.as_secs_f64() / elapsed.as_secs_f64().max(f64::MIN_POSITIVE);
            writeln!(formatter, "    {kernel:<17} {:.3} s, {share:.1} %", spent.as_secs_f64())?;
        }
        Ok(())
    }
}

/// Keeps the smaller of what is known and what was just measured.
fn keep_smaller<W>(known: &mut Option<Smallest<W>>, measured: Smallest<W>) {
    if known.as_ref().is_none_or(|known| measured.value < known.value) {
        *known = Some(measured);
    }
}

/// The smallest distance between two robots that go straight at constant speed in the same
/// period, each from where it was to where it is: seen from one, the other goes straight too.
fn passing_distance(first: [Point; 2], second: [Point; 2]) -> f64 {
    let seen = |instant: usize| Point::from(second[instant] - first[instant]);
    Segment::new(seen(0), seen(1)).distance(Point::origin())
}
