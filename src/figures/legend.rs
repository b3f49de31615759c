//! What the marks and strokes mean: a column beside the drawing.

use pleach_drawing::svg::node::element::Group;
use pleach_drawing::{layer, number, round_below};

use super::canvas::{Spot, View, quantity, rectangle, stroke, text};
use super::marks::{Mark, TaskState, active_ring};
use super::palette;
use super::plan::{Plan, bar};
use super::scene::{link_width, path_band, to_scale, tree_width, way_to_post};

/// Width of the column, with the white at its right.
pub(super) const WIDTH: f64 = 208.0;
/// From the left edge to where the words begin.
const WORDS: f64 = 42.0;
/// Base line of the first row.
const TOP: f64 = 92.0;
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

/// Draws the column from its left edge; also says where it ends.
pub(super) fn draw(plan: &Plan, view: &View, left: f64) -> (Group, f64) {
    let mut column = Column { group: layer("legend"), left, y: TOP };
    for mark in Mark::ALL {
        column.row(mark.name(), |spot| mark.draw(spot, RADIUS, mark.name()));
    }
    column.row("ring: active team", |spot| {
        layer("sample").add(Mark::Member.draw(spot, 4.6, "")).add(active_ring(spot, 4.6))
    });
    if let Some(disc) = plan.disc_radius(view) {
        column.row("disc of radius ρ, to scale", |spot| {
            layer("sample").add(to_scale(spot, disc.min(10.0)))
        });
    }
    column.gap();
    for state in TaskState::of_mission(&plan.scenario) {
        column.row(state.name(), |spot| state.draw(spot, 5.6, state.name()));
    }
    column.gap();
    column.row("link, thickness ∝ T·R", |[x, y]| {
        layer("sample")
            .add(stroke([x - 16.0, y], [x - 5.0, y], palette::LINK, link_width(0.05)))
            .add(stroke([x + 5.0, y], [x + 14.0, y], palette::LINK, link_width(0.6)))
    });
    column.row("links reach through walls", |[x, y]| {
        layer("sample").add(rectangle([x - 4.0, y - 7.0], [8.0, 14.0], palette::WALL)).add(stroke(
            [x - 16.0, y],
            [x + 16.0, y],
            palette::LINK,
            link_width(0.3),
        ))
    });
    column.row("edge of the tree", |[x, y]| {
        layer("sample")
            .add(stroke([x - 16.0, y], [x + 16.0, y], palette::LINK, link_width(0.6)))
            .add(stroke([x - 16.0, y], [x + 16.0, y], palette::TREE, tree_width(0.6)))
    });
    column.row("path Σ of the recruit", |[x, y]| {
        layer("sample").add(path_band(vec![[x - 9.0, y], [x + 9.0, y]]).set("stroke-width", "15"))
    });
    column.row("way since last picture", |[x, y]| {
        layer("sample").add(
            stroke([x - 16.0, y], [x + 16.0, y], palette::TRAIL, 1.8)
                .set("stroke-dasharray", "1 4"),
        )
    });
    column.row("on the way to its post", |[x, y]| {
        layer("sample").add(way_to_post([x - 14.0, y], [x + 12.0, y]))
    });
    column.gap();
    column.scale(plan, view);
    (column.group, column.y + SCALE)
}

struct Column {
    group: Group,
    left: f64,
    y: f64,
}

impl Column {
    fn row(&mut self, words: &str, sample: impl FnOnce(Spot) -> Group) {
        let sample = sample([self.left + 18.0, self.y - 4.0]);
        let words = text(words, [self.left + WORDS, self.y], palette::TEXT_SIZE, palette::INK);
        self.group = std::mem::take(&mut self.group).add(sample).add(words);
        self.y += ROW;
    }

    fn gap(&mut self) {
        let y = self.y - ROW / 2.0 - 1.0;
        let line = stroke([self.left, y], [self.left + WIDTH - 20.0, y], palette::GRID, 1.0);
        self.group = std::mem::take(&mut self.group).add(line);
        self.y += GAP;
    }

    /// A bar as long as the range of fully reliable links, or a round length where that is too long.
    fn scale(&mut self, plan: &Plan, view: &View) {
        let range = plan.scenario.link.full_range;
        let longest = LONGEST_BAR / view.length(1.0).max(f64::MIN_POSITIVE);
        let (length, words) = match range <= longest {
            true => (range, format!("l = {}: links fully reliable", quantity(range))),
            false => {
                let length = round_below(longest);
                (length, format!("{} (l = {})", quantity(length), quantity(range)))
            }
        };
        let (clearance, left) = (plan.clearance(), self.left);
        let swatch = rectangle([left, self.y - 10.0], [14.0, 12.0], palette::WALL);
        let outline =
            stroke([left + 18.0, self.y - 4.0], [left + 36.0, self.y - 4.0], palette::LIMIT, 0.9)
                .set("stroke-dasharray", "4 3");
        let note = match plan.free_space.is_empty() {
            true => format!("walls; robots keep ρ = {}", quantity(clearance)),
            false => format!("wall; W_f: ρ = {} off", quantity(clearance)),
        };
        let size = palette::TEXT_SIZE;
        let mut group = std::mem::take(&mut self.group).add(swatch);
        if !plan.free_space.is_empty() {
            group = group.add(outline);
        }
        self.group = group
            .add(text(note, [left + WORDS, self.y], size, palette::INK))
            .add(bar([left + 2.0, self.y + 22.0], view.length(length)))
            .add(text(words, [left, self.y + 42.0], size, palette::INK))
            .set("data-scale", number(view.length(1.0)));
    }
}
