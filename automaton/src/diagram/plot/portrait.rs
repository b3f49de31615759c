//! Phase portraits: one variable over another.

use pleach_drawing::{Axis, named};
use thiserror::Error;

use super::curve::{self, Quantity};
use super::sheet::{Sheet, WIDTH, line_colour, text_width};
use super::{LEFT, RIGHT, draw_dots, outcome};
use crate::trajectory::{FlowInterval, Sample, Trajectory};

/// The height of the panel, in pixels.
const PANEL: f64 = 560.0;
/// Above the panel, for title and subtitle, in pixels.
const TOP: f64 = 96.0;
/// Below the panel, for the numbers, the name of the variable and the legend, in pixels.
const FOOT: f64 = 84.0;
/// About how many numbers the axes have.
const TICKS: f64 = 6.0;

/// A plot names a variable that the trajectory does not have.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("the trajectory has no variable `{variable}`; it has {known}")]
pub struct UnknownVariable {
    /// The name asked for.
    pub variable: String,
    /// The names that there are, separated by commas.
    pub known: String,
}

/// The trajectory in the plane of two variables as an SVG document, `across` from left to right and
/// `up` upwards. The run begins at the black dot; the colour of the curve is the location of the
/// first component that changes it; a jump is a dashed line from x⁻, an open dot, to x⁺, a full one.
///
/// # Errors
///
/// [`UnknownVariable`] if the trajectory lacks one of them.
pub fn phase_portrait(
    trajectory: &Trajectory,
    across: &str,
    up: &str,
) -> Result<String, UnknownVariable> {
    let (horizontal, vertical) = (variable(trajectory, across)?, variable(trajectory, up)?);
    let right = WIDTH - RIGHT;
    let portrait = Portrait {
        trajectory,
        horizontal: (horizontal, axis(trajectory, horizontal, [LEFT, right])),
        vertical: (vertical, axis(trajectory, vertical, [TOP + PANEL, TOP])),
        component: telling_component(trajectory),
    };
    let mut sheet = Sheet::default();
    sheet.text(LEFT, 24.0, &format!("{up} over {across}"), "title");
    sheet.text(LEFT, 46.0, &outcome(trajectory), "quiet");
    portrait.draw_frame(&mut sheet, across, up);
    portrait.draw_curves(&mut sheet);
    portrait.draw_legend(&mut sheet);
    Ok(sheet.finish(TOP + PANEL + FOOT))
}

fn variable(trajectory: &Trajectory, name: &str) -> Result<Quantity, UnknownVariable> {
    let place = trajectory.variables().iter().position(|variable| variable == name);
    let unknown =
        || UnknownVariable { variable: name.to_owned(), known: trajectory.variables().join(", ") };
    place.map(Quantity::Variable).ok_or_else(unknown)
}

fn axis(trajectory: &Trajectory, quantity: Quantity, [from, to]: [f64; 2]) -> Axis {
    let phases = trajectory.intervals();
    Axis::roomy(phases.flat_map(|phase| quantity.values(&phase.samples)), from, to)
}

/// The first component that is not always in one location, or else the first.
fn telling_component(trajectory: &Trajectory) -> usize {
    let moves = |component: &usize| {
        let mut jumps = trajectory.jumps().iter().flat_map(|jump| &jump.moves);
        jumps.any(|one| one.component == *component && one.source != one.target)
    };
    (0..trajectory.components().len()).find(moves).unwrap_or(0)
}

struct Portrait<'a> {
    trajectory: &'a Trajectory,
    horizontal: (Quantity, Axis),
    vertical: (Quantity, Axis),
    /// Whose locations are the colours.
    component: usize,
}

impl Portrait<'_> {
    fn draw_frame(&self, sheet: &mut Sheet, across: &str, up: &str) {
        let right = WIDTH - RIGHT;
        let bottom = TOP + PANEL;
        sheet.panel([LEFT, TOP], [right - LEFT, PANEL]);
        let (ticks, power) = self.vertical.1.ticks(TICKS);
        for tick in ticks {
            sheet.line([LEFT, tick.place], [right, tick.place], "grid");
            sheet.text(LEFT - 8.0, tick.place, &tick.text, "quiet end");
        }
        sheet.text(LEFT, TOP - 14.0, &named(up, power), "name");
        let (ticks, power) = self.horizontal.1.ticks(TICKS);
        for tick in ticks {
            sheet.line([tick.place, TOP], [tick.place, bottom], "grid");
            sheet.text(tick.place, bottom + 15.0, &tick.text, "quiet middle");
        }
        sheet.text((LEFT + right) / 2.0, bottom + 36.0, &named(across, power), "name middle");
    }

    fn draw_curves(&self, sheet: &mut Sheet) {
        let phases: Vec<FlowInterval> = self.trajectory.intervals().collect();
        let mut jumps = Vec::new();
        for pair in phases.windows(2) {
            if let (Some(before), Some(after)) = (pair[0].samples.last(), pair[1].samples.first()) {
                let (from, to) = (self.place(before), self.place(after));
                if from != to {
                    sheet.line(from, to, "jump");
                    jumps.push([from, to]);
                }
            }
        }
        // Neighbouring phases of one colour share a path: a file of many jumps stays small.
        for group in phases.chunk_by(|one, other| self.location(one) == self.location(other)) {
            let [(across, horizontal), (up, vertical)] = [&self.horizontal, &self.vertical];
            let paths = group
                .iter()
                .map(|phase| curve::path(&phase.samples, (*across, horizontal), (*up, vertical)));
            let path = paths.collect::<Vec<_>>().join(" ");
            sheet.curve(&path, group.first().map(|phase| line_colour(self.location(phase))));
        }
        draw_dots(sheet, &jumps);
        if let Some(first) = phases.first().and_then(|phase| phase.samples.first()) {
            sheet.dot(self.place(first), "start");
        }
    }

    /// The locations that occur, with their colours.
    fn draw_legend(&self, sheet: &mut Sheet) {
        let Some(participant) = self.trajectory.components().get(self.component) else { return };
        let mut present: Vec<usize> =
            self.trajectory.intervals().map(|phase| self.location(&phase)).collect();
        present.sort_unstable();
        present.dedup();
        let (mut x, y) = (LEFT, TOP + PANEL + FOOT - 22.0);
        for location in present {
            let name = &participant.locations[location];
            sheet.area([x, y - 2.0], [20.0, 4.0], line_colour(location), name);
            sheet.text(x + 26.0, y, name, "quiet");
            x += 26.0 + text_width(name) + 20.0;
        }
    }

    fn location(&self, phase: &FlowInterval) -> usize {
        phase.locations.get(self.component).copied().unwrap_or(0)
    }

    fn place(&self, sample: &Sample) -> [f64; 2] {
        let [(across, horizontal), (up, vertical)] = [&self.horizontal, &self.vertical];
        [horizontal.place(across.value(sample)), vertical.place(up.value(sample))]
    }
}
