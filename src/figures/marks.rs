//! The marks of nodes and tasks: one shape and one colour for every role.

use pleach_automaton::network::record::Snapshot;
use pleach_automaton::network::scenario::{Scenario, Task};
use pleach_discrete::network::Role;
use pleach_drawing::svg::node::element::{Circle, Group, Polygon, Title};
use pleach_drawing::{corners, disc, layer, number, polyline};
use serde::Serialize;

use super::canvas::{Spot, stroke};
use super::palette;
use crate::story::Moment;

/// What a node is drawn as, after the captions of Figs. 8 to 10 and 14.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Mark {
    /// A fixed sink of information: a blue rhombus.
    AccessPoint,
    /// The head of the primary team: a red star.
    Leader,
    /// Another member of the primary team: an orange dot.
    Member,
    /// A robot on its way to help: a purple triangle.
    Recruit,
    /// Where branches part: a yellow square.
    Junction,
    /// A robot that services a task: a green rhombus.
    Leaf,
    /// A relay of a finished branch: a grey dot with a pale heart.
    Node,
    /// A robot without duty: a black dot.
    Redundant,
}

impl Mark {
    /// Every mark, in the order of the legend.
    pub(crate) const ALL: [Mark; 8] = [
        Mark::AccessPoint,
        Mark::Leader,
        Mark::Member,
        Mark::Recruit,
        Mark::Junction,
        Mark::Leaf,
        Mark::Node,
        Mark::Redundant,
    ];

    /// The mark of a robot: its role decides, and a plain node shows whether it belongs to the
    /// primary team.
    #[must_use]
    pub(crate) fn of(snapshot: &Snapshot, robot: usize) -> Mark {
        match snapshot.roles.get(robot) {
            Some(Role::Leader) => Mark::Leader,
            Some(Role::Recruit) => Mark::Recruit,
            Some(Role::Junction) => Mark::Junction,
            Some(Role::Leaf) => Mark::Leaf,
            Some(Role::Node) if snapshot.primary_team.contains(&robot) => Mark::Member,
            Some(Role::Node) => Mark::Node,
            Some(Role::Redundant) | None => Mark::Redundant,
        }
    }

    /// What the legend says.
    #[must_use]
    pub(super) const fn name(self) -> &'static str {
        match self {
            Mark::AccessPoint => "access point",
            Mark::Leader => "leader",
            Mark::Member => "primary team",
            Mark::Recruit => "recruit on its way",
            Mark::Junction => "junction of branches",
            Mark::Leaf => "leaf: services a task",
            Mark::Node => "node: relays",
            Mark::Redundant => "redundant robot",
        }
    }

    /// The colour of its inside.
    #[must_use]
    pub(crate) const fn colour(self) -> &'static str {
        match self {
            Mark::AccessPoint => palette::ACCESS_POINT,
            Mark::Leader => palette::LEADER,
            Mark::Member => palette::MEMBER,
            Mark::Recruit => palette::RECRUIT,
            Mark::Junction => palette::JUNCTION,
            Mark::Leaf => palette::LEAF,
            Mark::Node => palette::NODE,
            Mark::Redundant => palette::REDUNDANT,
        }
    }

    /// Its name in style sheets and in data.
    #[must_use]
    pub(crate) const fn key(self) -> &'static str {
        match self {
            Mark::AccessPoint => "access-point",
            Mark::Leader => "leader",
            Mark::Member => "primary-team",
            Mark::Recruit => "recruit",
            Mark::Junction => "junction",
            Mark::Leaf => "leaf",
            Mark::Node => "node",
            Mark::Redundant => "redundant",
        }
    }

    /// Its outline for a mark as large as a dot of radius 1; y grows downwards.
    pub(crate) fn shape(self) -> Shape {
        match self {
            Mark::AccessPoint => ring_of_corners(4, &[1.75], 0.0),
            Mark::Leaf => ring_of_corners(4, &[1.45], 0.0),
            Mark::Leader => ring_of_corners(10, &[1.75, 0.78], 0.0),
            Mark::Recruit => ring_of_corners(3, &[1.5], 0.0),
            Mark::Junction => ring_of_corners(4, &[1.35], 0.5),
            Mark::Member => Shape::Disc { radius: 1.05, heart: 0.0 },
            Mark::Redundant => Shape::Disc { radius: 0.8, heart: 0.0 },
            Mark::Node => Shape::Disc { radius: 0.95, heart: 0.38 },
        }
    }

    /// Draws the mark so that it looks as large as a dot of this radius, with a pale rim that parts marks that lie on
    /// each other.
    pub(super) fn draw(self, [x, y]: Spot, radius: f64, tooltip: &str) -> Group {
        let width = (radius * 0.14).clamp(0.6, 1.1);
        let rim = |shape: Group| {
            shape.set("stroke", palette::FLOOR).set("stroke-width", number(width + RIM))
        };
        let group = layer("mark")
            .set("fill", self.colour())
            .set("stroke", palette::INK)
            .set("stroke-width", number(width))
            .set("stroke-linejoin", "round")
            .add(Title::new(tooltip));
        match self.shape() {
            Shape::Polygon(spots) => {
                let spots = spots.into_iter().map(|[dx, dy]| [x + radius * dx, y + radius * dy]);
                let shape = Polygon::new().set("points", corners(spots));
                group.add(rim(Group::new().add(shape.clone()))).add(shape)
            }
            Shape::Disc { radius: share, heart } => {
                let shape = disc([x, y], radius * share);
                let group = group.add(rim(Group::new().add(shape.clone()))).add(shape);
                if heart == 0.0 {
                    return group;
                }
                let heart = disc([x, y], radius * heart);
                group.add(heart.set("fill", palette::FLOOR).set("stroke", "none"))
            }
        }
    }
}

/// The outline of a mark.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Shape {
    /// Its corners.
    Polygon(Vec<Spot>),
    /// A disc, and in it a pale one unless its radius is 0.
    Disc { radius: f64, heart: f64 },
}

/// How much wider than its outline the pale rim of a mark is.
const RIM: f64 = 2.4;
/// Radius of the ring that is left of a task that is over, in arms of its cross.
const OVER_RING: f64 = 1.2;

/// How far a task has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TaskState {
    Unannounced,
    Pursued,
    Serviced,
    Over,
}

impl TaskState {
    pub(crate) const ALL: [TaskState; 4] =
        [TaskState::Pursued, TaskState::Serviced, TaskState::Unannounced, TaskState::Over];

    /// The states that tasks of a mission may come to, in the order of the legend.
    pub(crate) fn of_mission(scenario: &Scenario) -> impl Iterator<Item = TaskState> {
        let may_end = |task: &Task| task.lasts.is_some() || task.withdrawn.is_some();
        let any_may_end = scenario.task.iter().any(may_end);
        TaskState::ALL.into_iter().filter(move |&state| any_may_end || state != TaskState::Over)
    }

    /// How far `task` has come at an instant.
    pub(crate) fn of(snapshot: &Snapshot, task: usize) -> TaskState {
        let is_pursued = || snapshot.pursuits().iter().any(|it| it.task == Some(task));
        let is_serviced = || snapshot.serviced.iter().any(|(done, _)| *done == task);
        match snapshot.closed.contains(&task) {
            true => TaskState::Over,
            false if is_serviced() => TaskState::Serviced,
            false if is_pursued() => TaskState::Pursued,
            false => TaskState::Unannounced,
        }
    }

    /// What the legend says.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            TaskState::Unannounced => "task to come",
            TaskState::Pursued => "task pursued",
            TaskState::Serviced => "task serviced",
            TaskState::Over => "task over",
        }
    }

    /// Draws a cross; a serviced task stands in a full ring, one to come is faint, and of one that is over an empty
    /// ring is left.
    pub(super) fn draw(self, [x, y]: Spot, arm: f64, tooltip: &str) -> Group {
        let width = arm * 0.27;
        let mut group = layer("task").add(Title::new(tooltip));
        let tint = disc([x, y], arm * 1.5).set("fill", palette::TASK);
        match self {
            TaskState::Unannounced => group = group.set("opacity", "0.35"),
            TaskState::Pursued => group = group.add(tint.set("fill-opacity", "0.12")),
            TaskState::Over => {
                let ring = disc([x, y], arm * OVER_RING).set("fill", "none");
                let ring = ring.set("stroke", palette::TASK);
                return group.add(
                    ring.set("stroke-opacity", "0.5").set("stroke-width", number(arm * 0.16)),
                );
            }
            TaskState::Serviced => {
                group = group.add(
                    tint.set("fill-opacity", "0.16")
                        .set("stroke", palette::TASK)
                        .set("stroke-width", number(arm * 0.16)),
                );
            }
        }
        group.add(stroke([x - arm, y - arm], [x + arm, y + arm], palette::TASK, width)).add(stroke(
            [x - arm, y + arm],
            [x + arm, y - arm],
            palette::TASK,
            width,
        ))
    }
}

/// The ring around members of the active team.
pub(super) fn active_ring(centre: Spot, radius: f64) -> Circle {
    disc(centre, radius * 2.1)
        .set("class", "active")
        .set("fill", "none")
        .set("stroke", palette::INK)
        .set("stroke-width", "1.3")
}

/// What crosses out a node that does not run, whose mark looks as large as a dot of this radius.
pub(super) fn cross_out([x, y]: Spot, radius: f64) -> Group {
    let arm = 1.7 * radius;
    let stroke = |from, to| stroke(from, to, palette::INK, radius * 0.36);
    layer("stopped")
        .add(Title::new("stopped"))
        .add(stroke([x - arm, y - arm], [x + arm, y + arm]))
        .add(stroke([x - arm, y + arm], [x + arm, y - arm]))
}

/// A regular figure whose corners take turns among `radii`; `turn` counts in corners, from the
/// top.
fn ring_of_corners(count: usize, radii: &[f64], turn: f64) -> Shape {
    let spots = (0..count).map(|corner| {
        let angle = (corner as f64 + turn) / count as f64 * std::f64::consts::TAU;
        let radius = radii[corner % radii.len()];
        [radius * angle.sin(), -radius * angle.cos()]
    });
    Shape::Polygon(spots.collect())
}

/// The strokes of the mark above the line of a moment, in a box from −1 to 1, y downwards. Moments
/// have marks of their own: a mark of a role would say what a robot is.
pub(crate) fn moment_strokes(moment: Moment) -> &'static [&'static [Spot]] {
    match moment {
        // A flag.
        Moment::Elected => &[&[[-0.55, 1.0], [-0.55, -1.0], [0.8, -0.5], [-0.55, 0.05]]],
        // Two bars, as on the button for a pause.
        Moment::Stationary => &[&[[-0.45, -0.9], [-0.45, 0.9]], &[[0.45, -0.9], [0.45, 0.9]]],
        // A plus.
        Moment::Joined => &[&[[-0.9, 0.0], [0.9, 0.0]], &[[0.0, -0.9], [0.0, 0.9]]],
        // Two chevrons.
        Moment::Released => {
            &[&[[-0.8, -0.8], [-0.05, 0.0], [-0.8, 0.8]], &[[0.1, -0.8], [0.85, 0.0], [0.1, 0.8]]]
        }
        // A tick.
        Moment::Serviced => &[&[[-0.85, 0.1], [-0.25, 0.75], [0.9, -0.75]]],
    }
}

/// Draws the mark of a moment in a box of half width `arm`.
pub(super) fn draw_moment(moment: Moment, [x, y]: Spot, arm: f64, tooltip: &str) -> Group {
    let group = layer("moment")
        .set("stroke", palette::INK)
        .set("stroke-width", number(arm * 0.36))
        .set("stroke-linecap", "round")
        .set("stroke-linejoin", "round")
        .add(Title::new(tooltip));
    moment_strokes(moment).iter().fold(group, |group, stroke| {
        let spots = stroke.iter().map(|[dx, dy]| [x + arm * dx, y + arm * dy]);
        group.add(polyline(spots))
    })
}
