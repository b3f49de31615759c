//! The lines of a trace as JSON shows them.

use crate::automaton::network::record::{End, MissionEvent, Outcome, PostView, Route, Snapshot};
use crate::automaton::network::scenario::Scenario;
use crate::discrete::Location as _;
use crate::discrete::network::{Phase, Role};
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
    },
    Event {
        k: usize,
        #[serde(flatten)]
        event: MissionEvent,
    },
    Step(Box<StepLine>),
    End(EndLine),
}

/// A [`Snapshot`] in the order and with the names of the format.
#[derive(Serialize, Deserialize)]
pub(super) struct StepLine {
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
}

impl From<&Snapshot> for StepLine {
    fn from(snapshot: &Snapshot) -> Self {
        Self {
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
            if length != robots {
                return Err(format!(
                    "{name} has {length} elements where position has {robots}: one for each robot"
                ));
            }
        }
        Ok(Self {
            step: line.k,
            time: line.t,
            positions: line.position.into_iter().map(Point2::from).collect(),
            roles: line.role.iter().map(|name| role_called(name)).collect::<Result<_, _>>()?,
            phase: phase_called(&line.phase)?,
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
        })
    }
}

fn role_called(name: &str) -> Result<Role, String> {
    (Role::ALL.into_iter().find(|role| role.name() == name))
        .ok_or_else(|| format!("no role is called {name:?}"))
}

fn phase_called(name: &str) -> Result<Phase, String> {
    (Phase::ALL.iter().copied().find(|phase| phase.name() == name))
        .ok_or_else(|| format!("no phase is called {name:?}"))
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
        }
    }
}

impl From<EndLine> for End {
    fn from(line: EndLine) -> Self {
        let EndLine { outcome, reason, task } = line;
        Self { outcome, reason: reason.unwrap_or_default(), task }
    }
}
