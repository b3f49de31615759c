//! Curves over control periods: axes, the lines of telling moments, and the curves themselves.

use pleach_drawing::svg::node::element::{Group, Polygon};
use pleach_drawing::{Axis, corners, layer, named, polyline};

use super::canvas::{Spot, headed, rectangle, stroke, text, text_width};
use super::lanes::Lanes;
use super::marks::draw_moment;
use super::palette;
use crate::story::Moment;

/// Upper left corner of the plot.
const CORNER: Spot = [74.0, 132.0];
/// Size of the plot.
const SIZE: [f64; 2] = [810.0, 300.0];
/// Height of the figure.
const HEIGHT: f64 = 520.0;
/// Rows of marks above the plot.
const MARK_ROWS: usize = 3;
/// From row to row of these marks.
const MARK_ROW: f64 = 15.0;
/// From the top of a lane to the foot of the names in it.
const LANE_NAME: f64 = 14.0;
/// Smallest distance of labels at the right end of curves.
const LABEL_STEP: f64 = 11.0;
/// Something that happened at a control period, for the lines across the curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sign {
    pub step: usize,
    pub moment: Moment,
    /// The robot or task concerned.
    pub number: usize,
}

/// A curve with its label.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    pub label: String,
    pub colour: &'static str,
    pub width: f64,
    pub points: Vec<[f64; 2]>,
}

/// The range of curves that are alike: control period, smallest value and largest.
#[derive(Clone, Debug)]
pub(super) struct Alike {
    pub label: String,
    pub ranges: Vec<[f64; 3]>,
}

/// A value that curves may not cross.
#[derive(Clone, Debug)]
pub(super) struct Limit {
    pub value: f64,
    pub label: String,
}

/// A chart before it is drawn.
#[derive(Clone, Debug)]
pub(super) struct Chart<'a> {
    pub title: &'a str,
    pub subtitle: String,
    pub axis: &'a str,
    pub period_axis: String,
    pub curves: Vec<Curve>,
    pub alike: Option<Alike>,
    pub limits: Vec<Limit>,
    pub signs: &'a [Sign],
    /// When each task is pursued.
    pub lanes: &'a Lanes,
    pub last_step: usize,
    /// Without title.
    pub is_plain: bool,
}

impl Chart<'_> {
    /// Draws the chart as an SVG document.
    pub(super) fn render(&self) -> String {
        let frame = Frame::around(self);
        headed([palette::WIDTH, HEIGHT], self.title, &self.subtitle, self.is_plain)
            .add(self.bands(&frame))
            .add(frame.grid(self.axis, &self.period_axis))
            .add(self.sign_lines(&frame))
            .add(self.limit_lines(&frame))
            .add(self.range(&frame))
            .add(self.lines(&frame))
            .add(self.end_labels(&frame))
            .add(sign_legend())
            .to_string()
    }

    /// Lanes share the height of the plot. Tasks are named above it, or where there are several lanes each in its own.
    fn bands(&self, frame: &Frame) -> Group {
        let lanes = self.lanes.count();
        let height = SIZE[1] / lanes.max(1) as f64;
        self.lanes.bands(self.last_step).into_iter().fold(layer("tasks"), |group, band| {
            let [left, right] = [band.from, band.until].map(|step| frame.x(step as f64));
            let top = CORNER[1] + band.lane as f64 * height;
            let size = [right - left, height];
            let group = match (band.lane + band.rank).is_multiple_of(2) {
                true => group.add(rectangle([left, top], size, palette::BAND)),
                false => group,
            };
            let words = format!("task {}", band.task);
            if size[0] <= text_width(&words, palette::TEXT_SIZE) + 4.0 {
                return group;
            }
            let line = match lanes {
                1 => CORNER[1] - MARK_ROWS as f64 * MARK_ROW - 8.0,
                _ => top + LANE_NAME,
            };
            let label =
                text(words, [left + size[0] / 2.0, line], palette::TEXT_SIZE, palette::TASK);
            group.add(label.set("text-anchor", "middle").set("font-weight", "600"))
        })
    }

    /// Lines at telling moments, their marks in rows above the plot so that none covers another;
    /// where all rows are full, only the line is drawn.
    fn sign_lines(&self, frame: &Frame) -> Group {
        let mut occupied = [f64::NEG_INFINITY; MARK_ROWS];
        self.signs.iter().fold(layer("moments"), |group, sign| {
            let x = frame.x(sign.step as f64);
            let row = occupied.iter().position(|right| x - 7.0 > *right);
            let top = CORNER[1] - 7.0 - row.unwrap_or(0) as f64 * MARK_ROW;
            let line = stroke([x, top], [x, CORNER[1] + SIZE[1]], palette::QUIET, 0.6)
                .set("stroke-opacity", "0.45");
            let group = group.add(line);
            let Some(row) = row else { return group };
            let words = sign.number.to_string();
            occupied[row] = x + 8.0 + text_width(&words, 9.5);
            let tooltip = format!("k = {}: {} ({})", sign.step, sign.moment.name(), sign.number);
            group.add(draw_moment(sign.moment, [x, top], 3.6, &tooltip)).add(text(
                words,
                [x + 7.0, top + 3.5],
                9.5,
                palette::INK,
            ))
        })
    }

    fn limit_lines(&self, frame: &Frame) -> Group {
        self.limits.iter().fold(layer("limits"), |group, limit| {
            let y = frame.y(limit.value);
            let line = stroke([CORNER[0], y], [CORNER[0] + SIZE[0], y], palette::LIMIT, 1.3)
                .set("stroke-dasharray", "6 4")
                .set("stroke-linecap", "butt");
            group.add(line)
        })
    }

    fn range(&self, frame: &Frame) -> Group {
        let Some(Alike { ranges, .. }) = &self.alike else { return layer("alike") };
        let lows = ranges.iter().map(|[k, low, _]| [frame.x(*k), frame.y(*low)]);
        let highs = ranges.iter().rev().map(|[k, _, high]| [frame.x(*k), frame.y(*high)]);
        let area = Polygon::new()
            .set("points", corners(lows.chain(highs)))
            .set("fill", palette::QUIET)
            .set("fill-opacity", "0.3")
            .set("stroke", palette::QUIET)
            .set("stroke-width", "1.2")
            .set("stroke-linejoin", "round");
        layer("alike").add(area)
    }

    fn lines(&self, frame: &Frame) -> Group {
        self.curves.iter().fold(layer("curves"), |group, curve| {
            let spots = curve.points.iter().map(|[k, value]| [frame.x(*k), frame.y(*value)]);
            let line = polyline(spots)
                .set("stroke", curve.colour)
                .set("stroke-width", curve.width)
                .set("stroke-linejoin", "round");
            group.add(line)
        })
    }

    /// Names of curves and limits at their right end, pushed apart.
    fn end_labels(&self, frame: &Frame) -> Group {
        let limits = self
            .limits
            .iter()
            .map(|limit| (frame.y(limit.value), limit.label.as_str(), palette::LIMIT));
        let curves = self.curves.iter().filter_map(|curve| {
            let [_, value] = curve.points.last()?;
            Some((frame.y(*value), curve.label.as_str(), curve.colour))
        });
        let alike = self.alike.iter().filter_map(|alike| {
            let [_, low, high] = alike.ranges.last()?;
            Some((frame.y((low + high) / 2.0), alike.label.as_str(), palette::QUIET))
        });
        let mut labels: Vec<_> = limits.chain(curves).chain(alike).collect();
        labels.sort_by(|one, other| one.0.total_cmp(&other.0));
        let heights: Vec<f64> = labels.iter().map(|label| label.0).collect();
        let places = spread(&heights, LABEL_STEP, CORNER[1] + SIZE[1] + 4.0);
        let right = CORNER[0] + SIZE[0];
        labels.iter().zip(places).fold(layer("names"), |group, ((height, words, colour), y)| {
            group
                .add(stroke([right + 1.0, *height], [right + 9.0, y], colour, 0.7))
                .add(text(*words, [right + 12.0, y + 3.5], 10.0, colour).set("font-weight", "600"))
        })
    }
}

/// Moves ascending heights apart by at least `step`, staying above `floor` where possible.
fn spread(heights: &[f64], step: f64, floor: f64) -> Vec<f64> {
    let mut places = heights.to_vec();
    for index in 1..places.len() {
        places[index] = places[index].max(places[index - 1] + step);
    }
    let mut lowest = floor;
    for place in places.iter_mut().rev() {
        *place = place.min(lowest);
        lowest = *place - step;
    }
    places
}

/// What the marks above the plot mean, below it.
fn sign_legend() -> Group {
    let y = HEIGHT - 22.0;
    let mut x = CORNER[0] + 6.0;
    let mut group = layer("legend");
    for moment in Moment::ALL {
        group = group.add(draw_moment(moment, [x, y - 4.0], 4.2, moment.name())).add(text(
            moment.name(),
            [x + 11.0, y],
            palette::TEXT_SIZE,
            palette::INK,
        ));
        x += text_width(moment.name(), palette::TEXT_SIZE) + 36.0;
    }
    let note = "beside a mark: its robot (or task)";
    group.add(text(note, [x, y], palette::TEXT_SIZE, palette::QUIET))
}

/// The axes.
struct Frame {
    last_step: f64,
    steps: Axis,
    values: Axis,
}

impl Frame {
    fn around(chart: &Chart<'_>) -> Frame {
        let curves = chart.curves.iter().flat_map(|curve| curve.points.iter().map(|p| p[1]));
        let alike = chart
            .alike
            .iter()
            .flat_map(|it| it.ranges.iter().flat_map(|range| [range[1], range[2]]));
        let limits = chart.limits.iter().map(|limit| limit.value);
        let [left, top] = CORNER;
        let [right, foot] = [left + SIZE[0], top + SIZE[1]];
        let last_step = chart.last_step.max(1) as f64;
        Frame {
            last_step,
            steps: Axis::exact([0.0, last_step], left, right),
            values: Axis::from_zero(curves.chain(alike).chain(limits), foot, top),
        }
    }

    fn x(&self, step: f64) -> f64 {
        self.steps.place(step.min(self.last_step))
    }

    fn y(&self, value: f64) -> f64 {
        self.values.place(value)
    }

    fn grid(&self, axis: &str, period_axis: &str) -> Group {
        let foot = CORNER[1] + SIZE[1];
        let right = CORNER[0] + SIZE[0];
        let words =
            |words: String, spot: Spot| text(words, spot, palette::TEXT_SIZE, palette::QUIET);
        let mut group = layer("axes");
        let (ticks, power) = self.values.ticks(6.0);
        for tick in ticks {
            let number = words(tick.text, [CORNER[0] - 8.0, tick.place + 4.0]);
            group = group
                .add(stroke([CORNER[0], tick.place], [right, tick.place], palette::GRID, 0.8))
                .add(number.set("text-anchor", "end"));
        }
        for tick in self.steps.ticks(10.0).0 {
            let number = words(tick.text, [tick.place, foot + 18.0]);
            group = group
                .add(stroke([tick.place, foot], [tick.place, foot + 4.0], palette::QUIET, 1.0))
                .add(number.set("text-anchor", "middle"));
        }
        let middle = CORNER[1] + SIZE[1] / 2.0;
        let axis_name = text(named(axis, power), [0.0, 0.0], palette::SUBTITLE_SIZE, palette::INK)
            .set("text-anchor", "middle")
            .set("transform", format!("translate(22,{middle}) rotate(-90)"));
        let period_name = text(
            period_axis,
            [CORNER[0] + SIZE[0] / 2.0, foot + 38.0],
            palette::SUBTITLE_SIZE,
            palette::INK,
        )
        .set("text-anchor", "middle");
        group
            .add(stroke([CORNER[0], foot], [right, foot], palette::QUIET, 1.0))
            .add(stroke([CORNER[0], CORNER[1]], [CORNER[0], foot], palette::QUIET, 1.0))
            .add(axis_name)
            .add(period_name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_pushed_apart_and_stay_above_the_floor() {
        let places = spread(&[10.0, 10.0, 11.0, 98.0, 99.0], 10.0, 100.0);
        assert!(places.windows(2).all(|pair| pair[1] - pair[0] >= 10.0 - 1e-9), "{places:?}");
        assert!(places.iter().all(|place| *place <= 100.0));
    }
}
