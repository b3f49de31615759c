//! Flowpipes: boxes around sets of states in the plane of two quantities, with runs drawn inside.

use pleach_drawing::{Axis, named};

use super::curve::{self, Quantity};
use super::sheet::{Sheet, WIDTH, area_colour, text_width};
use super::{LEFT, RIGHT};
use crate::trajectory::Sample;

/// The height of the panel, in pixels.
const PANEL: f64 = 480.0;
/// Above the panel, for title and subtitle, in pixels.
const TOP: f64 = 96.0;
/// Below the panel, for the numbers, the name of the quantity and the legend, in pixels.
const FOOT: f64 = 84.0;
/// About how many numbers the axes have.
const TICKS: f64 = 6.0;

/// A picture of sets of states.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FlowpipePicture {
    /// In the first line.
    pub title: String,
    /// Below it.
    pub subtitle: String,
    /// The names of the quantities from left to right and upwards.
    pub names: [String; 2],
    /// The names of the locations.
    pub locations: Vec<String>,
    /// The sets, in the order in which they are drawn.
    pub patches: Vec<Patch>,
    /// Runs inside them, phase by phase: samples whose values and rates are those of the two quantities.
    pub runs: Vec<Vec<Sample>>,
}

/// A box around states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// The number of the location.
    pub location: usize,
    /// From where to where, from left to right.
    pub across: [f64; 2],
    /// From where to where, upwards.
    pub up: [f64; 2],
}

impl FlowpipePicture {
    /// The picture as an SVG document. Boxes have the colour of their location, and runs are dark.
    pub fn to_svg(&self) -> String {
        let right = WIDTH - RIGHT;
        let quantities = [Quantity::Variable(0), Quantity::Variable(1)];
        let along = |quantity: Quantity| self.runs.iter().flat_map(move |run| quantity.values(run));
        let across = self.patches.iter().flat_map(|patch| patch.across);
        let across = Axis::roomy(across.chain(along(quantities[0])), LEFT, right);
        let up = self.patches.iter().flat_map(|patch| patch.up);
        let up = Axis::roomy(up.chain(along(quantities[1])), TOP + PANEL, TOP);
        let mut sheet = Sheet::default();
        sheet.text(LEFT, 24.0, &self.title, "title");
        sheet.text(LEFT, 46.0, &self.subtitle, "quiet");
        self.draw_frame(&mut sheet, &across, &up);
        self.draw_patches(&mut sheet, &across, &up);
        for phase in self.runs.iter().filter(|phase| phase.len() > 1) {
            let path = curve::path(phase, (quantities[0], &across), (quantities[1], &up));
            sheet.curve(&path, Some("#1b1f24; stroke-width: 0.8"));
        }
        self.draw_legend(&mut sheet);
        sheet.finish(TOP + PANEL + FOOT)
    }

    fn draw_frame(&self, sheet: &mut Sheet, across: &Axis, up: &Axis) {
        let (right, bottom) = (WIDTH - RIGHT, TOP + PANEL);
        sheet.panel([LEFT, TOP], [right - LEFT, PANEL]);
        let (ticks, power) = up.ticks(TICKS);
        for tick in ticks {
            sheet.line([LEFT, tick.place], [right, tick.place], "grid");
            sheet.text(LEFT - 8.0, tick.place, &tick.text, "quiet end");
        }
        sheet.text(LEFT, TOP - 14.0, &named(&self.names[1], power), "name");
        let (ticks, power) = across.ticks(TICKS);
        for tick in ticks {
            sheet.line([tick.place, TOP], [tick.place, bottom], "grid");
            sheet.text(tick.place, bottom + 15.0, &tick.text, "quiet middle");
        }
        let name = named(&self.names[0], power);
        sheet.text((LEFT + right) / 2.0, bottom + 36.0, &name, "name middle");
    }

    /// Successive boxes of one location that would cover the same pixels are drawn as one.
    fn draw_patches(&self, sheet: &mut Sheet, across: &Axis, up: &Axis) {
        /// Boxes are drawn at least as large, in pixels.
        const SMALLEST: f64 = 0.6;
        /// In pixels.
        const SEAM: f64 = 0.5;
        let mut last = None;
        for patch in &self.patches {
            let [left, right] = patch.across.map(|value| across.place(value));
            let [bottom, top] = patch.up.map(|value| up.place(value));
            let (width, height) = ((right - left).max(SMALLEST), (bottom - top).max(SMALLEST));
            let drawn = [left, top, width, height].map(|value| (value * 2.0).round() / 2.0);
            if last == Some((patch.location, drawn)) {
                continue;
            }
            last = Some((patch.location, drawn));
            let name = self.locations.get(patch.location).map_or("", String::as_str);
            // Neighbours overlap a little, so that no seam shows.
            sheet.area([left, top], [width + SEAM, height], area_colour(patch.location), name);
        }
    }

    /// The locations that occur, with their colours.
    fn draw_legend(&self, sheet: &mut Sheet) {
        let mut present: Vec<usize> = self.patches.iter().map(|patch| patch.location).collect();
        present.sort_unstable();
        present.dedup();
        let (mut x, y) = (LEFT, TOP + PANEL + FOOT - 22.0);
        for location in present {
            let name = self.locations.get(location).map_or("", String::as_str);
            sheet.area([x, y - 6.0], [20.0, 12.0], area_colour(location), name);
            sheet.text(x + 26.0, y, name, "quiet");
            x += 26.0 + text_width(name) + 20.0;
        }
    }
}
