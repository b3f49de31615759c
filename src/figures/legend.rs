//! What the marks and strokes mean: a column beside the drawing, or columns below a wide one.

use pleach_drawing::svg::node::element::Group;
use pleach_drawing::{layer, number, round_below};

use super::canvas::{Spot, View, quantity, rectangle, stroke, text};
use super::marks::{Mark, TaskState, active_ring, cross_out};
use super::palette;
use super::plan::{Plan, bar};
use super::scene::{link_width, path_band, to_scale, tree_width, way_to_post};

/// Width of a column, with the white at its right.
pub(super) const WIDTH: f64 = 208.0;
/// From the left edge to where the words begin.
const WORDS: f64 = 42.0;
/// From row to row.
const ROW: f64 = 21.0;
/// Space between groups.
const GAP: f64 = 8.0;
/// Size of sample marks.
const RADIUS: f64 = 6.0;
/// The longest bar that fits.
const LONGEST_BAR: f64 = 170.0;
/// Height of the scale and its words, at the end of the column.
const SCALE: f64 = 53.0;
/// Columns of rows below a wide drawing; the scale has one of its own.
const COLUMNS: usize = 3;

/// Draws the legend as one column from its left edge and the base line of its first row; also says where it ends.
pub(super) fn beside(
    plan: &Plan,
    view: &View,
    any_stopped: bool,
    [left, top]: Spot,
) -> (Group, f64) {
    let (mut group, mut y) = (layer("legend"), top);
    for rows in groups(plan, view, any_stopped) {
        for row in rows {
            group = row.draw(group, [left, y]);
            y += ROW;
        }
        let line = y - ROW / 2.0 - 1.0;
        group = group.add(stroke([left, line], [left + WIDTH - 20.0, line], palette::GRID, 1.0));
        y += GAP;
    }
    (scale(group, plan, view, [left, y]), y + SCALE)
}

/// Draws the legend as columns that share a width; also says where it ends.
pub(super) fn below(
    plan: &Plan,
    view: &View,
    any_stopped: bool,
    [left, top]: Spot,
    width: f64,
) -> (Group, f64) {
    let rows: Vec<Row> = groups(plan, view, any_stopped).into_iter().flatten().collect();
    let (most, step) = (rows.len().div_ceil(COLUMNS), width / (COLUMNS + 1) as f64);
    let column = |column: usize| left + column as f64 * step;
    let group = rows.into_iter().enumerate().fold(layer("legend"), |group, (number, row)| {
        row.draw(group, [column(number / most), top + (number % most) as f64 * ROW])
    });
    let foot = top + (most as f64 * ROW).max(SCALE);
    (scale(group, plan, view, [column(COLUMNS), top]), foot)
}

/// A sample and its meaning.
struct Row {
    words: String,
    sample: Box<dyn Fn(Spot) -> Group>,
}

impl Row {
    fn new(words: impl Into<String>, sample: impl Fn(Spot) -> Group + 'static) -> Row {
        Row { words: words.into(), sample: Box::new(sample) }
    }

    fn draw(self, group: Group, [left, y]: Spot) -> Group {
        let words = text(self.words, [left + WORDS, y], palette::TEXT_SIZE, palette::INK);
        group.add((self.sample)([left + 18.0, y - 4.0])).add(words)
    }
}

/// The rows: of nodes, of tasks, and of strokes.
fn groups(plan: &Plan, view: &View, any_stopped: bool) -> [Vec<Row>; 3] {
    let marks = Mark::ALL
        .into_iter()
        .map(|mark| Row::new(mark.name(), move |spot| mark.draw(spot, RADIUS, mark.name())));
    let ring = Row::new("ring: active team", |spot| {
        layer("sample").add(Mark::Member.draw(spot, 4.6, "")).add(active_ring(spot, 4.6))
    });
    let stopped = any_stopped.then(|| {
        Row::new("cross: stopped", |spot| {
            layer("sample").add(Mark::Redundant.draw(spot, 4.6, "")).add(cross_out(spot, 4.6))
        })
    });
    let disc = plan.disc_radius(view).map(|disc| {
        Row::new("disc of radius ρ, to scale", move |spot| {
            layer("sample").add(to_scale(spot, disc.min(10.0)))
        })
    });
    let tasks = TaskState::of_mission(&plan.scenario)
        .map(|state| Row::new(state.name(), move |spot| state.draw(spot, 5.6, state.name())));
    [marks.chain([ring]).chain(stopped).chain(disc).collect(), tasks.collect(), strokes()]
}

fn strokes() -> Vec<Row> {
    vec![
        Row::new("link, thickness ∝ T·R", |[x, y]| {
            layer("sample")
                .add(stroke([x - 16.0, y], [x - 5.0, y], palette::LINK, link_width(0.05)))
                .add(stroke([x + 5.0, y], [x + 14.0, y], palette::LINK, link_width(0.6)))
        }),
        Row::new("links reach through walls", |[x, y]| {
            let wall = rectangle([x - 4.0, y - 7.0], [8.0, 14.0], palette::WALL);
            let link = stroke([x - 16.0, y], [x + 16.0, y], palette::LINK, link_width(0.3));
            layer("sample").add(wall).add(link)
        }),
        Row::new("edge of the tree", |[x, y]| {
            layer("sample")
                .add(stroke([x - 16.0, y], [x + 16.0, y], palette::LINK, link_width(0.6)))
                .add(stroke([x - 16.0, y], [x + 16.0, y], palette::TREE, tree_width(0.6)))
        }),
        Row::new("path Σ of the recruit", |[x, y]| {
            let band = path_band(vec![[x - 9.0, y], [x + 9.0, y]]);
            layer("sample").add(band.set("stroke-width", "15"))
        }),
        Row::new("way since last picture", |[x, y]| {
            let way = stroke([x - 16.0, y], [x + 16.0, y], palette::TRAIL, 1.8);
            layer("sample").add(way.set("stroke-dasharray", "1 4"))
        }),
        Row::new("on the way to its post", |[x, y]| {
            layer("sample").add(way_to_post([x - 14.0, y], [x + 12.0, y]))
        }),
    ]
}

/// What walls are, and a bar as long as the range of fully reliable links, or a round length where that is too long.
fn scale(group: Group, plan: &Plan, view: &View, [left, y]: Spot) -> Group {
    let range = plan.scenario.link.full_range;
    let longest = LONGEST_BAR / view.length(1.0).max(f64::MIN_POSITIVE);
    let (length, words) = match range <= longest {
        true => (range, format!("l = {}: links fully reliable", quantity(range))),
        false => {
            let length = round_below(longest);
            (length, format!("{} (l = {})", quantity(length), quantity(range)))
        }
    };
    let clearance = plan.clearance();
    let swatch = rectangle([left, y - 10.0], [14.0, 12.0], palette::WALL);
    let outline = stroke([left + 18.0, y - 4.0], [left + 36.0, y - 4.0], palette::LIMIT, 0.9)
        .set("stroke-dasharray", "4 3");
    let note = match plan.free_space.is_empty() {
        true => format!("walls; robots keep ρ = {}", quantity(clearance)),
        false => format!("wall; W_f: ρ = {} off", quantity(clearance)),
    };
    let size = palette::TEXT_SIZE;
    let group = group.add(swatch);
    let group = if plan.free_space.is_empty() { group } else { group.add(outline) };
    group
        .add(text(note, [left + WORDS, y], size, palette::INK))
        .add(bar([left + 2.0, y + 22.0], view.length(length)))
        .add(text(words, [left, y + 42.0], size, palette::INK))
        .set("data-scale", number(view.length(1.0)))
}
