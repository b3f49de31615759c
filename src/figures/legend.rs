//! What the marks and strokes mean: a column beside the drawing.

use svg::node::element::Group;

use super::canvas::{Spot, View, layer, number, quantity, rectangle, stroke, text};
use super::marks::{Mark, TaskState, active_ring};
use super::palette;
use super::plan::{Plan, bar, round_length};
use super::scene::{link_width, path_band, tree_width, way_to_post};

/// Left edge of the column.
const LEFT: f64 = 752.0;
/// Right edge of the samples, where the words begin.
const WORDS: f64 = LEFT + 42.0;
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
/// Where the column ends, scale included.
pub(super) const FOOT: f64 = TOP + 17.0 * ROW + 3.0 * GAP + 74.0;

/// Draws the column.
pub(super) fn draw(plan: &Plan, view: &View) -> Group {
    let mut column = Column { group: layer("legend"), y: TOP };
    for mark in Mark::ALL {
        column.row(mark.name(), |spot| mark.draw(spot, RADIUS, mark.name()));
    }
    column.row("ring: active team", |spot| {
        layer("sample").add(Mark::Member.draw(spot, 4.6, "")).add(active_ring(spot, 4.6))
    });
    column.gap();
    for state in TaskState::ALL {
        column.row(state.name(), |spot| state.draw(spot, 5.6, state.name()));
    }
    column.gap();
    column.row("link, thickness ∝ T·R", |[x, y]| {
        layer("sample")
            .add(stroke([x - 16.0, y], [x - 5.0, y], palette::LINK, link_width(0.05)))
            .add(stroke([x + 5.0, y], [x + 14.0, y], palette::LINK, link_width(0.6)))
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
    column.group
}

struct Column {
    group: Group,
    y: f64,
}

impl Column {
    fn row(&mut self, words: &str, sample: impl FnOnce(Spot) -> Group) {
        let sample = sample([LEFT + 18.0, self.y - 4.0]);
        let words = text(words, [WORDS, self.y], palette::TEXT_SIZE, palette::INK);
        self.group = std::mem::take(&mut self.group).add(sample).add(words);
        self.y += ROW;
    }

    fn gap(&mut self) {
        let y = self.y - ROW / 2.0 - 1.0;
        let line = stroke([LEFT, y], [palette::WIDTH - 20.0, y], palette::GRID, 1.0);
        self.group = std::mem::take(&mut self.group).add(line);
        self.y += GAP;
    }

    /// A bar as long as the range of a sure link, or a round length where that is too long.
    fn scale(&mut self, plan: &Plan, view: &View) {
        let range = plan.scenario.link.full_range;
        let longest = LONGEST_BAR / view.length(1.0).max(f64::MIN_POSITIVE);
        let (length, words) = match range <= longest {
            true => (range, format!("l = {}: link is sure up to here", quantity(range))),
            false => {
                let length = round_length(longest);
                (length, format!("{} (l = {})", quantity(length), quantity(range)))
            }
        };
        let clearance = plan.clearance();
        let swatch = rectangle([LEFT, self.y - 10.0], [14.0, 12.0], palette::WALL);
        let outline =
            stroke([LEFT + 18.0, self.y - 4.0], [LEFT + 36.0, self.y - 4.0], palette::LIMIT, 0.9)
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
            .add(text(note, [WORDS, self.y], size, palette::INK))
            .add(bar([LEFT + 2.0, self.y + 22.0], view.length(length)))
            .add(text(words, [LEFT, self.y + 42.0], size, palette::INK))
            .set("data-scale", number(view.length(1.0)));
    }
}
