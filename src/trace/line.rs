//! The lines of a trace as JSON shows them.

use crate::automaton::network::certificate::Certificate;
use crate::automaton::network::record::{
    End, Faults, FleetEnd, FleetView, MissionEvent, Outcome, PostView, RobotSnapshot, Route,
    Snapshot,
};
use crate::automaton::network::scenario::Scenario;
use crate::discrete::Location;
use crate::discrete::network::{Activity, ExchangeStage, Phase, Role};
use nalgebra::Point2;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A line to be written.
#[derive(Serialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(super) enum LineOut<'a> {
    Header {
        format: &'a str,
        version: u32,
        scenario: &'a Scenario,
        #[serde(skip_serializing_if = "Faults::are_none")]
        faults: Faults,
    },
    Event {
        k: usize,
        #[serde(flatten)]
        event: &'a MissionEvent,
    },
    Step(Box<StepLine>),
    End(EndLine),
}

/// A line that was read.
#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub(super) enum Line {
    Header {
        format: String,
        version: u32,
        scenario: Box<Scenario>,
        #[serde(default)]
        faults: Faults,
    },
    Event {
        k: usize,
        #[serde(flatten)]
        event: MissionEvent,
    },
    Step(Box<StepLine>),
    End(EndLine),
}

/// How a step begins as it is written.
const STEP: &[u8] = br#"{"type":"step","#;

impl Line {
    /// Reads a line. Nearly all are steps; read as such where they begin so, they need no copy of each value, which
    /// it takes to look for the type first.
    pub(super) fn read(text: &[u8]) -> serde_json::Result<Self> {
        match text.starts_with(STEP) {
            true => serde_json::from_slice(text).map(Line::Step),
            false => serde_json::from_slice(text),
        }
    }
}

/// A [`Snapshot`] in the order and with the names of the format.
#[derive(Serialize, Deserialize)]
pub(super) struct StepLine {
    /// Read here only so that a second one is refused; the lines that are written have their type from [`LineOut`].
    #[serde(rename = "type", default, skip_serializing)]
    _kind: StepKind,
    k: usize,
    t: f64,
    position: Vec<[f64; 2]>,
    role: Vec<Cow<'static, str>>,
    active: Vec<usize>,
    residual: Vec<f64>,
    multiplier: Vec<f64>,
    route: Vec<(usize, usize, f64, f64)>,
    tree: Vec<(usize, usize)>,
    task: Option<usize>,
    phase: Cow<'static, str>,
    active_team: Vec<usize>,
    primary_team: Vec<usize>,
    path: Vec<usize>,
    serviced: Vec<(usize, usize)>,
    post: Vec<PostLine>,
    /// Of this and the next five there is an element for each robot, as in [`RobotSnapshot`]; traces may lack
    /// all of them.
    #[serde(default)]
    location: Vec<Cow<'static, str>>,
    #[serde(default)]
    exchange: Vec<Cow<'static, str>>,
    #[serde(default)]
    known_phase: Vec<Cow<'static, str>>,
    #[serde(default)]
    target: Vec<Option<[f64; 2]>>,
    #[serde(default)]
    sent: Vec<u64>,
    #[serde(default)]
    heard: Vec<u64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    closed: Vec<usize>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    absent: Vec<usize>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    fleets: Vec<FleetLine>,
}

#[derive(Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum StepKind {
    #[default]
    Step,
}

/// A [`FleetView`] with the names of the format.
#[derive(Serialize, Deserialize)]
struct FleetLine {
    access_point: usize,
    phase: Cow<'static, str>,
    task: Option<usize>,
    active_team: Vec<usize>,
    primary_team: Vec<usize>,
    path: Vec<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    ended: Option<usize>,
}

/// A [`PostView`] with the names of the format.
#[derive(Serialize, Deserialize)]
struct PostLine {
    reference: [f64; 2],
    holder: usize,
    task: Option<usize>,
    junction: bool,
}

/// An [`End`]; a serviced mission needs no reason.
#[derive(Serialize, Deserialize)]
pub(super) struct EndLine {
    outcome: Outcome,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    reason: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    task: Option<usize>,
    /// The tasks that were given up while the mission went on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    tasks: Vec<usize>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    certificate: Option<Certificate>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    fleets: Vec<FleetEndLine>,
}

/// A [`FleetEnd`]: the access point, and what an [`EndLine`] holds.
#[derive(Serialize, Deserialize)]
struct FleetEndLine {
    access_point: usize,
    #[serde(flatten)]
    end: EndLine,
}

impl From<&Snapshot> for StepLine {
    fn from(snapshot: &Snapshot) -> Self {
        let robots = &snapshot.robots;
        Self {
            _kind: StepKind::Step,
            k: snapshot.step,
            t: snapshot.time,
            position: snapshot.positions.iter().map(|point| [point.x, point.y]).collect(),
            role: snapshot.roles.iter().map(|role| role.name().into()).collect(),
            active: snapshot.active.clone(),
            residual: snapshot.residuals.clone(),
            multiplier: snapshot.multipliers.clone(),
            route: (snapshot.routes.iter())
                .map(|route| (route.from, route.to, route.share, route.reliability))
                .collect(),
            tree: snapshot.tree.clone(),
            task: snapshot.task,
            phase: snapshot.phase.name().into(),
            active_team: snapshot.active_team.clone(),
            primary_team: snapshot.primary_team.clone(),
            path: snapshot.path.clone(),
            serviced: snapshot.serviced.clone(),
            post: snapshot.posts.iter().map(PostLine::from).collect(),
            location: robots.iter().map(|robot| robot.activity.name().into()).collect(),
            exchange: robots.iter().map(|robot| robot.exchange.name().into()).collect(),
            known_phase: robots.iter().map(|robot| robot.phase.name().into()).collect(),
            target: robots.iter().map(|robot| robot.target.map(|target| target.into())).collect(),
            sent: robots.iter().map(|robot| robot.sent).collect(),
            heard: robots.iter().map(|robot| robot.heard).collect(),
            closed: snapshot.closed.clone(),
            absent: snapshot.absent.clone(),
            fleets: snapshot.fleets.iter().map(FleetLine::from).collect(),
        }
    }
}

impl TryFrom<StepLine> for Snapshot {
    type Error = String;

    fn try_from(line: StepLine) -> Result<Self, String> {
        let robots = line.position.len();
        for (name, length) in [
            ("role", line.role.len()),
            ("residual", line.residual.len()),
            ("multiplier", line.multiplier.len()),
        ] {
            fitting(name, length, robots)?;
        }
        let views = line.views(robots)?;
        Ok(Self {
            step: line.k,
            time: line.t,
            positions: line.position.into_iter().map(Point2::from).collect(),
            roles: line
                .role
                .iter()
                .map(|name| called("role", &Role::ALL, Role::name, name))
                .collect::<Result<_, _>>()?,
            phase: called("phase", Phase::ALL, Phase::name, &line.phase)?,
            active: line.active,
            active_team: line.active_team,
            primary_team: line.primary_team,
            path: line.path,
            residuals: line.residual,
            multipliers: line.multiplier,
            routes: (line.route.into_iter())
                .map(|(from, to, share, reliability)| Route { from, to, share, reliability })
                .collect(),
            tree: line.tree,
            task: line.task,
            serviced: line.serviced,
            posts: line.post.into_iter().map(PostView::from).collect(),
            robots: views,
            closed: line.closed,
            absent: line.absent,
            fleets: line.fleets.into_iter().map(FleetView::try_from).collect::<Result<_, _>>()?,
        })
    }
}

impl StepLine {
    /// The views of this many robots, or none where the trace has none.
    fn views(&self, robots: usize) -> Result<Vec<RobotSnapshot>, String> {
        let lengths = [
            ("location", self.location.len()),
            ("exchange", self.exchange.len()),
            ("known_phase", self.known_phase.len()),
            ("target", self.target.len()),
            ("sent", self.sent.len()),
            ("heard", self.heard.len()),
        ];
        if lengths.iter().all(|&(_, length)| length == 0) {
            return Ok(Vec::new());
        }
        lengths.into_iter().try_for_each(|(name, length)| fitting(name, length, robots))?;
        let view = |robot: usize| {
            Ok(RobotSnapshot {
                activity: called("location", Activity::ALL, Activity::name, &self.location[robot])?,
                exchange: called(
                    "location of an exchange",
                    ExchangeStage::ALL,
                    ExchangeStage::name,
                    &self.exchange[robot],
                )?,
                phase: called("phase", Phase::ALL, Phase::name, &self.known_phase[robot])?,
                target: self.target[robot].map(Point2::from),
                sent: self.sent[robot],
                heard: self.heard[robot],
            })
        };
        (0..robots).map(view).collect()
    }
}

fn fitting(name: &str, length: usize, robots: usize) -> Result<(), String> {
    if length == robots {
        return Ok(());
    }
    Err(format!("{name} has {length} elements where position has {robots}: one for each robot"))
}

/// What is called `name`, of `all` that there is.
fn called<T: Copy>(
    kind: &str,
    all: &[T],
    name_of: fn(T) -> &'static str,
    name: &str,
) -> Result<T, String> {
    (all.iter().copied().find(|one| name_of(*one) == name))
        .ok_or_else(|| format!("no {kind} is called {name:?}"))
}

impl From<&PostView> for PostLine {
    fn from(post: &PostView) -> Self {
        let PostView { reference, holder, task, junction } = *post;
        Self { reference: [reference.x, reference.y], holder, task, junction }
    }
}

impl From<PostLine> for PostView {
    fn from(post: PostLine) -> Self {
        let PostLine { reference, holder, task, junction } = post;
        Self { reference: reference.into(), holder, task, junction }
    }
}

impl From<&End> for EndLine {
    fn from(end: &End) -> Self {
        let serviced = end.outcome == Outcome::Serviced;
        Self {
            outcome: end.outcome,
            reason: (!serviced).then(|| end.reason.clone()),
            task: end.task.filter(|_| !serviced),
            tasks: end.tasks.clone(),
            certificate: end.certificate.clone(),
            fleets: end.fleets.iter().map(FleetEndLine::from).collect(),
        }
    }
}

impl From<EndLine> for End {
    fn from(line: EndLine) -> Self {
        let EndLine { outcome, reason, task, tasks, certificate, fleets } = line;
        let fleets = fleets.into_iter().map(FleetEnd::from).collect();
        let reason = reason.unwrap_or_default();
        Self { outcome, reason, task, tasks, certificate, fleets }
    }
}

impl From<&FleetEnd> for FleetEndLine {
    fn from(fleet: &FleetEnd) -> Self {
        Self { access_point: fleet.access_point, end: EndLine::from(&fleet.end) }
    }
}

impl From<FleetEndLine> for FleetEnd {
    fn from(line: FleetEndLine) -> Self {
        Self { access_point: line.access_point, end: line.end.into() }
    }
}

impl From<&FleetView> for FleetLine {
    fn from(fleet: &FleetView) -> Self {
        let FleetView { access_point, phase, task, ended, .. } = *fleet;
        Self {
            access_point,
            phase: phase.name().into(),
            task,
            active_team: fleet.active_team.clone(),
            primary_team: fleet.primary_team.clone(),
            path: fleet.path.clone(),
            ended,
        }
    }
}

impl TryFrom<FleetLine> for FleetView {
    type Error = String;

    fn try_from(line: FleetLine) -> Result<Self, String> {
        let FleetLine { access_point, phase, task, active_team, primary_team, path, ended } = line;
        let phase = called("phase", Phase::ALL, Phase::name, &phase)?;
        Ok(Self { access_point, phase, task, active_team, primary_team, path, ended })
    }
}
