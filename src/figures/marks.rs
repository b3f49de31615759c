//! The marks of nodes and tasks: one shape and one colour for every role.

use pleach_automaton::network::record::Snapshot;
use pleach_discrete::network::Role;
use svg::node::element::{Circle, Group, Polygon, Title};

use super::canvas::{Spot, corners, number, stroke};
use super::palette;

/// What a node is drawn as, after the captions of Figs. 8 to 10 and 14.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mark {
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
    pub const ALL: [Mark; 8] = [
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
    pub fn of(snapshot: &Snapshot, robot: usize) -> Mark {
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
    pub const fn name(self) -> &'static str {
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
    pub const fn colour(self) -> &'static str {
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

    /// Draws the mark so that it looks as large as a dot of this radius.
    pub(super) fn draw(self, centre: Spot, radius: f64, tooltip: &str) -> Group {
        let group = Group::new()
            .set("class", "mark")
            .set("fill", self.colour())
            .set("stroke", palette::INK)
            .set("stroke-width", number((radius * 0.14).clamp(0.6, 1.1)))
            .set("stroke-linejoin", "round")
            .add(Title::new(tooltip));
        match self {
            Mark::AccessPoint => group.add(ring_of_corners(centre, 4, &[radius * 1.75], 0.0)),
            Mark::Leaf => group.add(ring_of_corners(centre, 4, &[radius * 1.45], 0.0)),
            Mark::Leader => {
                group.add(ring_of_corners(centre, 10, &[radius * 1.75, radius * 0.78], 0.0))
            }
            Mark::Recruit => group.add(ring_of_corners(centre, 3, &[radius * 1.5], 0.0)),
            Mark::Junction => group.add(ring_of_corners(centre, 4, &[radius * 1.35], 0.5)),
            Mark::Member => group.add(disc(centre, radius * 1.05)),
            Mark::Redundant => group.add(disc(centre, radius * 0.8)),
            Mark::Node => group
                .add(disc(centre, radius * 0.95))
                .add(disc(centre, radius * 0.38).set("fill", palette::FLOOR).set("stroke", "none")),
        }
    }
}

/// How far a task has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TaskState {
    Unannounced,
    Pursued,
    Serviced,
}

impl TaskState {
    pub(super) const ALL: [TaskState; 3] =
        [TaskState::Pursued, TaskState::Serviced, TaskState::Unannounced];

    /// What the legend says.
    pub(super) const fn name(self) -> &'static str {
        match self {
            TaskState::Unannounced => "task to come",
            TaskState::Pursued => "task pursued",
            TaskState::Serviced => "task serviced",
        }
    }

    /// Draws a cross; a serviced task stands in a full ring, one to come is faint.
    pub(super) fn draw(self, [x, y]: Spot, arm: f64, tooltip: &str) -> Group {
        let width = arm * 0.27;
        let mut group = Group::new().set("class", "task").add(Title::new(tooltip));
        let tint = disc([x, y], arm * 1.5).set("fill", palette::TASK);
        match self {
            TaskState::Unannounced => group = group.set("opacity", "0.35"),
            TaskState::Pursued => group = group.add(tint.set("fill-opacity", "0.12")),
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

/// A filled circle.
pub(super) fn disc([x, y]: Spot, radius: f64) -> Circle {
    Circle::new().set("cx", number(x)).set("cy", number(y)).set("r", number(radius))
}

/// A regular figure whose corners take turns among `radii`; `turn` counts in corners, from the
/// top.
fn ring_of_corners([x, y]: Spot, count: usize, radii: &[f64], turn: f64) -> Polygon {
    let spots = (0..count).map(|corner| {
        let angle = (corner as f64 + turn) / count as f64 * std::f64::consts::TAU;
        let radius = radii[corner % radii.len()];
        [x + radius * angle.sin(), y - radius * angle.cos()]
    });
    Polygon::new().set("points", corners(spots))
}
