//! One instant of a mission as a picture, in the visual language of Figs. 8 to 10 and 14.

use pleach_automaton::network::record::{Pursuit, Snapshot};
use pleach_discrete::Location as _;
use pleach_drawing::svg::Document;
use pleach_drawing::svg::node::element::{Circle, Group, Polyline, Text};
use pleach_drawing::{disc, layer, number, polyline};

use super::canvas::{Spot, View, headed, stroke, text};
use super::labels::LabelPlaces;
use super::legend;
use super::marks::{Mark, TaskState, active_ring, cross_out};
use super::palette;
use super::plan::{PaperWalls, Plan};

/// Room for the drawing.
const ROOM: [f64; 2] = [692.0, 660.0];
/// Upper left corner of that room.
const CORNER: Spot = [30.0, 84.0];
/// A plan that is lower than this in that room is drawn over the whole width of the sheet, with the legend below.
const LEAST_HEIGHT: f64 = 370.0;
/// Where narrow plans end at least, so that titles have room.
const LEAST_WIDTH: f64 = 480.0;
/// Between the drawing and the legend.
const GUTTER: f64 = 30.0;
/// From the upper edge of the drawing to the base line of the first row of a legend beside it.
const LEGEND_TOP: f64 = 8.0;
/// Space below the drawing.
const FOOT: f64 = 26.0;
/// Width of a link that is used all the time, T·R = 1, on the paper.
pub(super) const FULL_WIDTH: f64 = 11.0;
/// Width of the faintest link.
pub(super) const FAINT_WIDTH: f64 = 0.9;
/// Width of a tree edge relative to the link below it, which stays visible on both sides.
pub(super) const TREE_SHARE: f64 = 0.45;
/// Discs of radius ρ are drawn from this radius on.
const LEAST_DISC: f64 = 5.5;
/// Robots up to which each mark carries its number; in larger crowds redundant robots do not.
const FULLY_LABELLED: usize = 120;

/// One instant, with what is told about it.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    /// The robots, links and tasks.
    pub snapshot: &'a Snapshot,
    /// What happens, in one line.
    pub title: &'a str,
    /// Where each robot has been since the picture before; may be empty.
    pub trails: &'a [Vec<[f64; 2]>],
}

impl Plan {
    /// Renders one instant as an SVG document, as wide as plan and legend ask for.
    ///
    /// Links lie below, tree edges above them, marks on top; the legend stands beside the
    /// drawing, or below one that is wide and low. Equal input gives equal bytes.
    #[must_use]
    pub fn render(&self, scene: &Scene<'_>) -> String {
        let any_stopped = !scene.snapshot.absent.is_empty();
        let boundary = &self.scenario.workspace.boundary;
        let beside = View::fit(boundary, CORNER, ROOM);
        let (_, [width, height]) = beside.frame();
        let (view, legend, sheet_size) = if height < LEAST_HEIGHT {
            let width = palette::WIDTH - 2.0 * CORNER[0];
            let view = View::fit(boundary, CORNER, [width, ROOM[1]]);
            let (_, [_, height]) = view.frame();
            let corner = [CORNER[0], CORNER[1] + height + GUTTER + LEGEND_TOP];
            let (legend, foot) = legend::below(self, &view, any_stopped, corner, width);
            (view, legend, [palette::WIDTH, foot + FOOT])
        } else {
            let left = (CORNER[0] + width).max(LEAST_WIDTH) + GUTTER;
            let corner = [left, CORNER[1] + LEGEND_TOP];
            let (legend, foot) = legend::beside(self, &beside, any_stopped, corner);
            (beside, legend, [left + legend::WIDTH, (CORNER[1] + height).max(foot) + FOOT])
        };
        let picture = Picture { plan: self, scene, view, radius: self.mark_radius(&view, scene) };
        let document: Document =
            headed(sheet_size, scene.title, &subtitle(scene.snapshot), self.is_plain);
        document
            .add(self.draw(&view))
            .add(picture.trails())
            .add(picture.path())
            .add(picture.links())
            .add(picture.tree())
            .add(picture.tasks())
            .add(picture.ways_to_posts())
            .add(picture.marks())
            .add(picture.labels())
            .add(legend)
            .to_string()
    }

    /// Marks are smaller in crowds; where the disc of radius ρ is large enough to be seen, marks
    /// leave its rim free.
    fn mark_radius(&self, view: &View, scene: &Scene<'_>) -> f64 {
        let crowd: f64 = if scene.snapshot.positions.len() > 30 { 4.8 } else { 6.2 };
        match self.disc_radius(view) {
            Some(disc) => crowd.min((0.62 * disc).max(4.0)),
            None => crowd,
        }
    }

    /// ρ on the paper, if a disc of this radius can be seen around a mark.
    pub(super) fn disc_radius(&self, view: &View) -> Option<f64> {
        let disc = view.length(self.clearance());
        (disc >= LEAST_DISC).then_some(disc)
    }
}

/// A scene on its way to the paper.
struct Picture<'a> {
    plan: &'a Plan,
    scene: &'a Scene<'a>,
    view: View,
    radius: f64,
}

impl Picture<'_> {
    /// Where a node lies on the paper: robots first, then access points.
    fn node(&self, node: usize) -> Option<Spot> {
        let positions = &self.scene.snapshot.positions;
        let place = match positions.get(node) {
            Some(point) => [point.x, point.y],
            None => self.plan.access_point(node, positions.len())?,
        };
        Some(self.view.spot(place))
    }

    fn trails(&self) -> Group {
        let moved = self.scene.trails.iter().filter(|trail| trail.len() > 1);
        moved.fold(layer("trails"), |group, trail| {
            group.add(
                polyline(trail.iter().map(|point| self.view.spot(*point)))
                    .set("stroke", palette::TRAIL)
                    .set("stroke-width", "1.6")
                    .set("stroke-opacity", "0.7")
                    .set("stroke-dasharray", "1 4")
                    .set("stroke-linecap", "round")
                    .set("stroke-linejoin", "round"),
            )
        })
    }

    fn path(&self) -> Group {
        let spots: Vec<Spot> =
            self.scene.snapshot.path.iter().filter_map(|node| self.node(*node)).collect();
        if spots.len() < 2 { layer("path") } else { layer("path").add(path_band(spots)) }
    }

    fn links(&self) -> Group {
        self.scene.snapshot.routes.iter().fold(layer("links"), |group, route| {
            match (self.node(route.from), self.node(route.to)) {
                (Some(from), Some(to)) => {
                    let width = link_width(route.share * route.reliability);
                    group.add(stroke(from, to, palette::LINK, width).set("class", "link"))
                }
                _ => group,
            }
        })
    }

    fn tree(&self) -> Group {
        let snapshot = self.scene.snapshot;
        snapshot.tree.iter().fold(layer("tree"), |group, &(child, parent)| {
            let route = snapshot.routes.iter().find(|r| r.from == child && r.to == parent);
            let traffic = route.map_or(0.0, |route| route.share * route.reliability);
            match (self.node(child), self.node(parent)) {
                (Some(from), Some(to)) => {
                    let width = tree_width(traffic);
                    group.add(stroke(from, to, palette::TREE, width).set("class", "edge"))
                }
                _ => group,
            }
        })
    }

    fn task_states(&self) -> impl Iterator<Item = (usize, TaskState, Spot)> {
        let snapshot = self.scene.snapshot;
        self.plan.scenario.task.iter().enumerate().map(move |(task, place)| {
            (task, TaskState::of(snapshot, task), self.view.spot(place.position))
        })
    }

    fn tasks(&self) -> Group {
        self.task_states().fold(layer("tasks"), |group, (task, state, spot)| {
            let tooltip = format!("task {task}: {}", state.name());
            group.add(state.draw(spot, self.radius * 1.35, &tooltip))
        })
    }

    /// Joins a robot that has not reached the reference of its post yet with that place.
    fn ways_to_posts(&self) -> Group {
        self.scene.snapshot.posts.iter().fold(layer("posts"), |group, post| {
            let reference = self.view.spot([post.reference.x, post.reference.y]);
            let Some(holder) = self.node(post.holder) else { return group };
            let apart = (holder[0] - reference[0]).hypot(holder[1] - reference[1]);
            if apart < self.radius { group } else { group.add(way_to_post(holder, reference)) }
        })
    }

    fn marks(&self) -> Group {
        let snapshot = self.scene.snapshot;
        let robots = snapshot.positions.len();
        let mut drawn: Vec<(Mark, usize)> =
            (0..robots).map(|robot| (Mark::of(snapshot, robot), robot)).collect();
        drawn.extend(
            (0..self.plan.scenario.access_point.len()).map(|k| (Mark::AccessPoint, robots + k)),
        );
        // What is more telling lies above what is less: the order of the legend, backwards.
        drawn.sort_by(|one, other| other.cmp(one));
        drawn.into_iter().fold(layer("marks"), |group, (mark, node)| {
            let Some(spot) = self.node(node) else { return group };
            let tooltip = match mark {
                Mark::AccessPoint => format!("access point {}", node - robots),
                _ => format!("robot {node}: {}", mark.name()),
            };
            let disc = self.plan.disc_radius(&self.view).filter(|_| node < robots);
            let group = disc.into_iter().fold(group, |group, disc| group.add(to_scale(spot, disc)));
            let group = group.add(mark.draw(spot, self.radius, &tooltip));
            let group = match snapshot.absent.contains(&node) {
                true => group.add(cross_out(spot, self.radius)),
                false => group,
            };
            if snapshot.active_team.contains(&node) {
                group.add(active_ring(spot, self.radius))
            } else {
                group
            }
        })
    }

    fn labels(&self) -> Group {
        let snapshot = self.scene.snapshot;
        let nodes = snapshot.positions.len() + self.plan.scenario.access_point.len();
        let spots: Vec<Spot> = (0..nodes).filter_map(|node| self.node(node)).collect();
        let reach = |node: usize| match node {
            _ if snapshot.active_team.contains(&node) => self.radius * 2.15,
            _ if node >= snapshot.positions.len() => self.radius * 1.8,
            _ if Mark::of(snapshot, node) == Mark::Leader => self.radius * 1.6,
            _ => self.radius * 1.25,
        };
        let mut taken: Vec<(Spot, f64)> =
            spots.iter().enumerate().map(|(node, spot)| (*spot, reach(node))).collect();
        let tasks: Vec<_> = self.task_states().collect();
        taken.extend(tasks.iter().map(|(_, _, spot)| (*spot, self.radius * 1.6)));
        let strokes = self.strokes();
        let walls = PaperWalls::new(self.plan, &self.view);
        let mut places = LabelPlaces::new(self.view.frame(), &taken, &strokes, &walls);

        let mut group = layer("labels").set("text-anchor", "middle").set("font-weight", "600");
        let size = if nodes > 30 { palette::LABEL_SIZE - 1.5 } else { palette::LABEL_SIZE };
        for (task, state, spot) in tasks {
            let words = format!("task {task}");
            let place = places.place(&words, size, spot, self.radius * 1.9);
            let label = halo_text(words, place, size, palette::TASK);
            group = group.add(match state {
                TaskState::Unannounced | TaskState::Over => label.set("opacity", "0.6"),
                _ => label,
            });
        }
        let robots = snapshot.positions.len();
        for (node, spot) in spots.into_iter().enumerate() {
            let plain = node < robots && Mark::of(snapshot, node) == Mark::Redundant;
            if plain && nodes > FULLY_LABELLED {
                continue;
            }
            let words = label_of(node, robots);
            let colour = if node < robots { palette::INK } else { palette::ACCESS_POINT };
            let place = places.place(&words, size, spot, reach(node));
            group = group.add(halo_text(words, place, size, colour));
        }
        group
    }

    /// Links and edges that labels avoid.
    fn strokes(&self) -> Vec<(Spot, Spot)> {
        let snapshot = self.scene.snapshot;
        let busy = snapshot.routes.iter().filter(|route| route.share * route.reliability > 0.02);
        let links = busy.map(|route| (route.from, route.to));
        links
            .chain(snapshot.tree.iter().copied())
            .filter_map(|(from, to)| Some((self.node(from)?, self.node(to)?)))
            .collect()
    }
}

/// What is written beside a node: robots and access points are each numbered from 0, in the order of the scenario.
fn label_of(node: usize, robots: usize) -> String {
    match node.checked_sub(robots) {
        None => node.to_string(),
        Some(access_point) => access_point_label(access_point),
    }
}

fn access_point_label(number: usize) -> String {
    format!("AP {number}")
}

/// Width of a link that carries T·R, on the paper.
pub(super) fn link_width(traffic: f64) -> f64 {
    FAINT_WIDTH + FULL_WIDTH * traffic.clamp(0.0, 1.0)
}

/// Width of a tree edge whose link carries T·R.
pub(super) fn tree_width(traffic: f64) -> f64 {
    (link_width(traffic) * TREE_SHARE).max(1.2)
}

/// The band below the path Σ.
pub(super) fn path_band(spots: Vec<Spot>) -> Polyline {
    polyline(spots)
        .set("stroke", palette::RECRUIT)
        .set("stroke-opacity", "0.2")
        .set("stroke-width", "19")
        .set("stroke-linecap", "round")
        .set("stroke-linejoin", "round")
}

/// The disc of radius ρ that a robot keeps for itself, to scale.
pub(super) fn to_scale(centre: Spot, radius: f64) -> Circle {
    disc(centre, radius)
        .set("class", "disc")
        .set("fill", palette::INK)
        .set("fill-opacity", "0.1")
        .set("stroke", palette::INK)
        .set("stroke-opacity", "0.5")
        .set("stroke-width", "0.8")
}

/// A robot's way to the reference of its post.
pub(super) fn way_to_post(holder: Spot, reference: Spot) -> Group {
    let place = disc(reference, 3.2)
        .set("fill", palette::FLOOR)
        .set("stroke", palette::QUIET)
        .set("stroke-width", "1.2");
    let way = stroke(holder, reference, palette::QUIET, 1.2).set("stroke-dasharray", "0.1 3");
    layer("post").add(way).add(place)
}

/// A text that stays readable on strokes.
fn halo_text(content: String, place: Spot, size: f64, colour: &str) -> Text {
    text(content, place, size, colour)
        .set("stroke", palette::FLOOR)
        .set("stroke-width", number(3.0))
        .set("stroke-linejoin", "round")
        .set("paint-order", "stroke")
}

/// The second line: time, phase, team and what is done.
fn subtitle(snapshot: &Snapshot) -> String {
    let mut parts = vec![format!("t = {:.0} s", snapshot.time)];
    for Pursuit { access_point, phase, task, primary_team } in snapshot.pursuits() {
        let of = access_point.map_or(String::new(), |it| format!("{}: ", access_point_label(it)));
        parts.push(format!("{of}phase: {}", phase.name()));
        if let Some(task) = task {
            parts.push(format!("pursued: task {task}"));
        }
        if !primary_team.is_empty() {
            let members: Vec<String> = primary_team.iter().map(usize::to_string).collect();
            parts.push(format!("primary team: {}", members.join(" – ")));
        }
    }
    let held: Vec<String> = snapshot
        .serviced
        .iter()
        .map(|(task, robot)| format!("task {task} by robot {robot}"))
        .collect();
    if !held.is_empty() {
        parts.push(format!("held: {}", held.join(", ")));
    }
    if !snapshot.absent.is_empty() {
        let label = |&node: &usize| label_of(node, snapshot.positions.len());
        let stopped: Vec<String> = snapshot.absent.iter().map(label).collect();
        parts.push(format!("stopped: {}", stopped.join(", ")));
    }
    parts.join("  ·  ")
}
