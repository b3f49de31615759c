//! The mission as a picture that moves: SVG with animations, for pages that show no scripts.

use pleach_automaton::network::record::Snapshot;
use pleach_drawing::svg::node::element::{Animate, AnimateTransform, Group, Line};
use pleach_drawing::{disc, layer, number};

use super::canvas::{Spot, View, rectangle, sheet, text};
use super::marks::{Mark, TaskState, cross_out};
use super::palette;
use super::plan::Plan;

/// Instants that an animation keeps; between them everything moves on straight lines.
const MOST_FRAMES: usize = 240;
/// How long the mission takes, in seconds.
const SECONDS: f64 = 24.0;
/// The share of that in which the end stands still before all begins anew.
const REST: f64 = 0.08;
/// How far a robot may be from its place, in units of the picture.
const SLACK: f64 = 0.35;
/// Width of the picture.
const WIDTH: f64 = 720.0;
/// Around the plan, and below it for the bar that tells the time.
const MARGIN: f64 = 14.0;

/// Instants of a mission, evenly spread.
#[derive(Clone, Debug, Default)]
pub(super) struct Film {
    stride: usize,
    seen: usize,
    frames: Vec<Snapshot>,
}

impl Film {
    /// Takes the next instant.
    pub(super) fn push(&mut self, snapshot: &Snapshot) {
        self.stride = self.stride.max(1);
        if self.seen.is_multiple_of(self.stride) {
            self.frames.push(snapshot.clone());
        }
        self.seen += 1;
        if self.frames.len() > MOST_FRAMES {
            self.frames = std::mem::take(&mut self.frames).into_iter().step_by(2).collect();
            self.stride *= 2;
        }
    }

    /// The animation of what was taken, and of the `last` instant.
    pub(super) fn render(&self, plan: &Plan, last: Option<&Snapshot>) -> String {
        let mut frames: Vec<&Snapshot> = self.frames.iter().collect();
        frames.extend(last.filter(|last| frames.last().is_none_or(|f| f.step < last.step)));
        let room = [WIDTH - 2.0 * MARGIN, WIDTH];
        let view = View::fit(&plan.scenario.workspace.boundary, [MARGIN, MARGIN], room);
        let (_, [width, height]) = view.frame();
        let reel = Reel { plan, view, frames };
        let size = [width + 2.0 * MARGIN, height + 3.0 * MARGIN];
        sheet(size, &format!("{} as it plays", plan.scenario.name))
            .add(plan.draw(&view))
            .add(reel.tree())
            .add(reel.tasks())
            .add(reel.access_points())
            .add(reel.robots())
            .add(reel.bar(size))
            .to_string()
    }
}

/// A film on its way to the picture.
struct Reel<'a> {
    plan: &'a Plan,
    view: View,
    frames: Vec<&'a Snapshot>,
}

impl Reel<'_> {
    fn node(&self, frame: &Snapshot, node: usize) -> Spot {
        let robots = frame.positions.len();
        let place = frame.positions.get(node).map(|point| [point.x, point.y]);
        let place = place.or_else(|| self.plan.access_point(node, robots)).unwrap_or_default();
        self.view.spot(place)
    }

    fn robot_count(&self) -> usize {
        self.frames.first().map_or(0, |frame| frame.positions.len())
    }

    /// A line from every robot to its parent.
    fn tree(&self) -> Group {
        (0..self.robot_count()).fold(layer("tree"), |group, robot| {
            let ends: Vec<[f64; 4]> = (self.frames.iter())
                .map(|frame| {
                    let parent = frame.tree.iter().find(|(child, _)| *child == robot);
                    let [x, y] = self.node(frame, robot);
                    let [px, py] = self.node(frame, parent.map_or(robot, |(_, parent)| *parent));
                    [x, y, px, py]
                })
                .collect();
            let line = Line::new()
                .set("stroke", palette::TREE)
                .set("stroke-width", "1.6")
                .set("stroke-opacity", "0.8")
                .set("stroke-linecap", "round");
            let names = ["x1", "y1", "x2", "y2"];
            group.add(names.into_iter().enumerate().fold(line, |line, (at, name)| {
                let values: Vec<[f64; 1]> = ends.iter().map(|end| [end[at]]).collect();
                let (values, times) = keyframes(&values);
                let line = line.set(name, number(ends[0][at]));
                if times.len() < 2 { line } else { line.add(animated(name, &values, &times)) }
            }))
        })
    }

    fn tasks(&self) -> Group {
        let tasks = self.plan.scenario.task.iter().enumerate();
        tasks.fold(layer("tasks"), |group, (task, place)| {
            let spot = self.view.spot(place.position);
            let states: Vec<TaskState> =
                self.frames.iter().map(|frame| TaskState::of(frame, task)).collect();
            let group = TaskState::ALL.into_iter().fold(group, |group, state| {
                self.shown(group, &states, state, || state.draw(spot, 8.0, state.name()))
            });
            let words = format!("task {task}");
            // Above the number of the robot that services the task.
            let place = [spot[0] + 13.0, spot[1] - 14.0];
            group.add(text(words, place, 12.0, palette::TASK).set("font-weight", "600"))
        })
    }

    fn access_points(&self) -> Group {
        let points = self.plan.scenario.access_point.iter();
        points.fold(layer("access-points"), |group, point| {
            let spot = self.view.spot(point.position);
            group.add(Mark::AccessPoint.draw(spot, self.radius(), Mark::AccessPoint.name()))
        })
    }

    fn radius(&self) -> f64 {
        if self.robot_count() > 30 { 4.0 } else { 6.0 }
    }

    fn robots(&self) -> Group {
        (0..self.robot_count()).fold(layer("robots"), |group, robot| {
            let spots: Vec<Spot> =
                self.frames.iter().map(|frame| self.node(frame, robot)).collect();
            let marks: Vec<Mark> = self.frames.iter().map(|frame| Mark::of(frame, robot)).collect();
            let shape = Mark::ALL.into_iter().fold(Group::new(), |group, mark| {
                let drawn = || mark.draw([0.0, 0.0], self.radius(), mark.name());
                self.shown(group, &marks, mark, drawn)
            });
            let absent: Vec<bool> =
                self.frames.iter().map(|frame| frame.absent.contains(&robot)).collect();
            let shape = self.shown(shape, &absent, true, || cross_out([0.0, 0.0], self.radius()));
            let number_of =
                text(robot.to_string(), [self.radius() + 2.0, -4.0], 10.0, palette::INK)
                    .set("stroke", palette::FLOOR)
                    .set("stroke-width", "2.5")
                    .set("paint-order", "stroke");
            let [x, y] = spots[0];
            let at = format!("translate({} {})", number(x), number(y));
            let moving = shape.add(number_of).set("transform", at);
            let (values, times) = keyframes(&spots);
            if times.len() < 2 {
                return group.add(moving);
            }
            let travel = AnimateTransform::new()
                .set("attributeName", "transform")
                .set("type", "translate")
                .set("values", values.join(";"))
                .set("keyTimes", times.join(";"))
                .set("dur", format!("{SECONDS}s"))
                .set("repeatCount", "indefinite");
            group.add(moving.add(travel))
        })
    }

    /// Adds what `drawn` gives, visible while the list is at `wanted`.
    fn shown<T: PartialEq + Copy>(
        &self,
        group: Group,
        list: &[T],
        wanted: T,
        drawn: impl Fn() -> Group,
    ) -> Group {
        if !list.contains(&wanted) {
            return group;
        }
        let visible = |one: T| if one == wanted { "visible" } else { "hidden" };
        let mut changes = vec![(0, visible(list[0]))];
        for (at, &one) in list.iter().enumerate() {
            if changes.last().is_some_and(|(_, last)| *last != visible(one)) {
                changes.push((at, visible(one)));
            }
        }
        let part = Group::new().set("visibility", changes[0].1).add(drawn());
        if changes.len() == 1 {
            return group.add(part);
        }
        let values: Vec<&str> = changes.iter().map(|(_, value)| *value).collect();
        let times: Vec<String> = changes.iter().map(|(at, _)| time(*at, list.len())).collect();
        let blink = Animate::new()
            .set("attributeName", "visibility")
            .set("calcMode", "discrete")
            .set("values", values.join(";"))
            .set("keyTimes", times.join(";"))
            .set("dur", format!("{SECONDS}s"))
            .set("repeatCount", "indefinite");
        group.add(part.add(blink))
    }

    /// How far the mission is.
    fn bar(&self, [width, height]: [f64; 2]) -> Group {
        let (left, top) = (MARGIN, height - 1.4 * MARGIN);
        let whole = width - 2.0 * MARGIN;
        let growing = rectangle([left, top], [0.0, 4.0], palette::TASK);
        let values = [number(0.0), number(whole), number(whole)];
        let times = ["0".to_owned(), number_of_time(1.0 - REST), "1".to_owned()];
        layer("bar")
            .add(rectangle([left, top], [whole, 4.0], palette::GRID))
            .add(growing.add(animated("width", &values, &times)))
            .add(disc([left, top + 2.0], 2.0).set("fill", palette::TASK))
    }
}

/// An animation of one attribute.
fn animated(name: &str, values: &[String], times: &[String]) -> Animate {
    Animate::new()
        .set("attributeName", name)
        .set("values", values.join(";"))
        .set("keyTimes", times.join(";"))
        .set("dur", format!("{SECONDS}s"))
        .set("repeatCount", "indefinite")
}

/// The share of the animation that has passed at frame `at` of `count`.
fn time(at: usize, count: usize) -> String {
    number_of_time((1.0 - REST) * at as f64 / (count.max(2) - 1) as f64)
}

fn number_of_time(share: f64) -> String {
    let text = format!("{share:.4}");
    let short = text.trim_end_matches('0').trim_end_matches('.');
    if short.is_empty() { "0".to_owned() } else { short.to_owned() }
}

/// The frames that are needed to come as near as [`SLACK`] to all of them on straight lines, with
/// their times; a single one where nothing moves. The last is held to the end.
fn keyframes<const N: usize>(values: &[[f64; N]]) -> (Vec<String>, Vec<String>) {
    let mut kept = vec![0];
    let mut from = 0;
    while from + 1 < values.len() {
        let mut to = from + 1;
        while to + 1 < values.len() && is_straight(&values[from..=to + 1]) {
            to += 1;
        }
        kept.push(to);
        from = to;
    }
    if kept.iter().all(|&at| values[at] == values[0]) {
        kept.truncate(1);
    }
    let shown = |at: &usize| values[*at].map(number).join(" ");
    let mut shown: Vec<String> = kept.iter().map(shown).collect();
    let mut times: Vec<String> = kept.iter().map(|&at| time(at, values.len())).collect();
    if kept.len() > 1 {
        shown.extend(shown.last().cloned());
        times.push("1".to_owned());
    }
    (shown, times)
}

/// Whether all values lie near the straight line between the first and the last, at their times.
fn is_straight<const N: usize>(values: &[[f64; N]]) -> bool {
    let (first, last) = (values[0], values[values.len() - 1]);
    let count = (values.len() - 1) as f64;
    values.iter().enumerate().all(|(at, value)| {
        let share = at as f64 / count;
        (0..N).all(|axis| {
            let line = first[axis] + share * (last[axis] - first[axis]);
            (value[axis] - line).abs() <= SLACK
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_bends_need_frames() {
        let ramp: Vec<[f64; 1]> = (0..101).map(|at| [f64::from(at.min(50))]).collect();
        let (values, times) = keyframes(&ramp);
        assert_eq!(values, ["0", "50", "50", "50"]);
        assert_eq!(times.first().map(String::as_str), Some("0"));
        assert_eq!(times.last().map(String::as_str), Some("1"));
        assert_eq!(keyframes(&[[3.0]; 40]).0, ["3"]);
    }
}
