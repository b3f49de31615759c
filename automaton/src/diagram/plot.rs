//! Plots of a trajectory: variables and locations over time.

mod curve;
mod flowpipe;
mod portrait;
mod sheet;

use pleach_drawing::{Axis, named, power_of_ten};
use pleach_guards::constant;

use crate::executor::{Ending, Reason};
use crate::trajectory::{FlowInterval, Participant, Trajectory};
use curve::Quantity;
use sheet::{Sheet, WIDTH, area_colour, text_width};

pub use flowpipe::{FlowpipePicture, Patch};
pub use portrait::{UnknownVariable, phase_portrait};

/// Left of the panels, for the numbers of their axes, in pixels.
const LEFT: f64 = 96.0;
/// Right of the panels, in pixels.
const RIGHT: f64 = 24.0;
/// Above the first panel, for title and subtitle, in pixels.
const HEAD: f64 = 68.0;
/// The height of a panel, in pixels.
const PANEL: f64 = 132.0;
/// Above every panel, for the name of its variable, in pixels.
const CAPTION: f64 = 26.0;
/// The height of the strip of a component, in pixels.
const STRIP: f64 = 22.0;
/// From strip to strip, in pixels.
const STRIP_GAP: f64 = 8.0;
/// Below all panels, for the numbers of the time axis and its name, in pixels.
const FOOT: f64 = 52.0;
/// A line of the legend, in pixels.
const LEGEND: f64 = 22.0;
/// About how many numbers a vertical axis has, and how many the time axis.
const TICKS: [f64; 2] = [4.0, 9.0];
/// Jumps closer than this have no dots, which would hide the curve, in pixels.
const DOT_DISTANCE: f64 = 8.0;

/// The trajectory over time as an SVG document: a panel for each variable and below them a strip
/// for each component, coloured by its location. A jump is a dashed line from x⁻, an open dot, to
/// x⁺, a full one.
pub fn plot(trajectory: &Trajectory) -> String {
    let mut sheet = Sheet::default();
    let right = WIDTH - RIGHT;
    let end = trajectory.ending().at.t;
    let time = Axis::exact([0.0, end], LEFT, right);
    sheet.text(LEFT, 24.0, &title(trajectory), "title");
    sheet.text(LEFT, 46.0, &outcome(trajectory), "quiet");

    let mut top = HEAD;
    for (variable, name) in trajectory.variables().iter().enumerate() {
        top += CAPTION;
        draw_panel(&mut sheet, trajectory, variable, name, &time, top);
        top += PANEL;
    }
    top += STRIP_GAP + STRIP_GAP;
    let mut unnamed = Vec::new();
    for component in 0..trajectory.components().len() {
        unnamed.push(draw_strip(&mut sheet, trajectory, component, &time, top));
        top += STRIP + STRIP_GAP;
    }
    draw_time(&mut sheet, &time, top);
    top += FOOT;
    for (component, locations) in unnamed.iter().enumerate().filter(|(_, some)| !some.is_empty()) {
        draw_legend(&mut sheet, trajectory, component, locations, top);
        top += LEGEND;
    }
    sheet.finish(top)
}

/// What is plotted: the variables, or of a composition the components.
fn title(trajectory: &Trajectory) -> String {
    let names = match trajectory.components() {
        [_] => listed(trajectory.variables().iter().map(String::as_str)),
        components => listed(components.iter().map(|one| &*one.name)),
    };
    format!("{names} over time")
}

/// The first few names, and how many more there are.
fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    const MOST: usize = 5;
    let names: Vec<&str> = names.collect();
    match names.get(MOST..) {
        Some(more) if !more.is_empty() => {
            format!("{} and {} more", names[..MOST].join(", "), more.len())
        }
        _ => names.join(", "),
    }
}

/// How long a run was, how many jumps it had, and why it ended, in a line.
pub fn outcome(trajectory: &Trajectory) -> String {
    let Ending { at, reason } = trajectory.ending();
    let place = |component: usize, location: usize| {
        let Participant { name, locations } = &trajectory.components()[component];
        match trajectory.components().len() {
            1 => format!("`{}`", locations[location]),
            _ => format!("`{}` of `{name}`", locations[location]),
        }
    };
    let ending = match reason {
        Reason::Horizon => "up to the horizon".to_owned(),
        Reason::Zeno(zeno) => {
            format!("Zeno: jumps accumulate at {} s", rounded(zeno.accumulation))
        }
        Reason::Finished(failure) => format!("failed: {failure}"),
        Reason::Blocked => "blocked: neither time nor a transition goes on".to_owned(),
        Reason::JumpLimit(last) => {
            let last = last
                .map(|last| format!(", the last into {}", place(last.component, last.location)));
            format!("ended: more jumps at one instant than allowed{}", last.unwrap_or_default())
        }
        Reason::Sliding(sliding) => {
            let [one, other] = sliding.locations.map(|location| place(sliding.component, location));
            format!("ended: the flows of {one} and {other} lead to the boundary between them")
        }
        Reason::Limit(limit) => format!("ended: {limit}"),
        Reason::Interrupted(_) => "ended: interrupted".to_owned(),
    };
    let jumps = trajectory.jumps().len();
    let noun = if jumps == 1 { "jump" } else { "jumps" };
    format!("{} s, {jumps} {noun}; {ending}", rounded(at.t))
}

/// To six digits, for reading.
fn rounded(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    constant(rounded).to_string()
}

fn draw_panel(
    sheet: &mut Sheet,
    trajectory: &Trajectory,
    variable: usize,
    name: &str,
    time: &Axis,
    top: f64,
) {
    let quantity = Quantity::Variable(variable);
    let phases: Vec<FlowInterval> = trajectory.intervals().collect();
    let values = phases.iter().flat_map(|phase| quantity.values(&phase.samples));
    let vertical = Axis::roomy(values, top + PANEL, top);
    let right = WIDTH - RIGHT;
    sheet.panel([LEFT, top], [right - LEFT, PANEL]);
    let (ticks, power) = vertical.ticks(TICKS[0]);
    sheet.text(LEFT, top - CAPTION / 3.0, &named(name, power), "name");
    for tick in ticks {
        sheet.line([LEFT, tick.place], [right, tick.place], "grid");
        sheet.text(LEFT - 8.0, tick.place, &tick.text, "quiet end");
    }
    for tick in time.ticks(TICKS[1]).0 {
        sheet.line([tick.place, top], [tick.place, top + PANEL], "grid");
    }

    let place = |t: f64, value: f64| [time.place(t), vertical.place(value)];
    let mut path = String::new();
    for phase in &phases {
        path.push_str(&curve::path(&phase.samples, (Quantity::Time, time), (quantity, &vertical)));
        path.push(' ');
    }
    let mut jumps: Vec<[[f64; 2]; 2]> = Vec::new();
    for (pair, jump) in phases.windows(2).zip(trajectory.jumps()) {
        if let (Some(before), Some(after)) = (pair[0].samples.last(), pair[1].samples.first()) {
            let (before, after) = (quantity.value(before), quantity.value(after));
            if before != after {
                jumps.push([place(jump.at.t, before), place(jump.at.t, after)]);
            }
        }
    }
    jumps.iter().for_each(|[from, to]| sheet.line(*from, *to, "jump"));
    sheet.curve(path.trim_end(), None);
    draw_dots(sheet, &jumps);
}

/// Dots at both ends of jumps, but for jumps that lie too close together at both.
fn draw_dots(sheet: &mut Sheet, jumps: &[[[f64; 2]; 2]]) {
    let distance = |one: usize, other: usize| match (jumps.get(one), jumps.get(other)) {
        (Some([from, to]), Some([other_from, other_to])) => {
            let apart = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
            apart(from, other_from).max(apart(to, other_to))
        }
        _ => f64::INFINITY,
    };
    for (number, [from, to]) in jumps.iter().enumerate() {
        let before = distance(number, number.wrapping_sub(1));
        if before.min(distance(number, number + 1)) >= DOT_DISTANCE {
            sheet.dot(*from, "before");
            sheet.dot(*to, "after");
        }
    }
}

/// Draws where the component was; returns the locations whose names found no room.
fn draw_strip(
    sheet: &mut Sheet,
    trajectory: &Trajectory,
    component: usize,
    time: &Axis,
    top: f64,
) -> Vec<usize> {
    let participant = &trajectory.components()[component];
    sheet.text(LEFT - 8.0, top + STRIP / 2.0, &strip_name(trajectory, component), "name end");
    let (mut named, mut unnamed) = (Vec::new(), Vec::new());
    for Stay { location, from, to } in stays(trajectory, component) {
        let name = &participant.locations[location];
        let (left, right) = (time.place(from), time.place(to));
        let tooltip = format!("{name}: {from} s to {to} s");
        // A hair at least: a location without any duration was there, too.
        let width = (right - left).max(0.6);
        sheet.area([left, top], [width, STRIP], area_colour(location), &tooltip);
        if width > text_width(name) + 6.0 {
            let x = (left + right) / 2.0;
            sheet.text(x, top + STRIP / 2.0, name, "middle");
            named.push(location);
        } else {
            unnamed.push(location);
        }
    }
    unnamed.retain(|location| !named.contains(location));
    unnamed.sort_unstable();
    unnamed.dedup();
    unnamed
}

/// A component in one location.
struct Stay {
    location: usize,
    from: f64,
    to: f64,
}

/// Where the component was, phases of one location taken together.
fn stays(trajectory: &Trajectory, component: usize) -> Vec<Stay> {
    let mut stays: Vec<Stay> = Vec::new();
    for phase in trajectory.intervals() {
        let location = phase.locations[component];
        let (Some(first), Some(last)) = (phase.samples.first(), phase.samples.last()) else {
            continue;
        };
        match stays.last_mut() {
            Some(stay) if stay.location == location => stay.to = last.t,
            _ => stays.push(Stay { location, from: first.t, to: last.t }),
        }
    }
    stays
}

fn draw_time(sheet: &mut Sheet, time: &Axis, top: f64) {
    let right = WIDTH - RIGHT;
    sheet.line([LEFT, top], [right, top], "panel");
    let (ticks, power) = time.ticks(TICKS[1]);
    for tick in ticks {
        sheet.line([tick.place, top], [tick.place, top + 5.0], "panel");
        sheet.text(tick.place, top + 15.0, &tick.text, "quiet middle");
    }
    let name = match power {
        Some(power) => format!("t / {} s", power_of_ten(power)),
        None => "t / s".to_owned(),
    };
    sheet.text((LEFT + right) / 2.0, top + 36.0, &name, "name middle");
}

fn draw_legend(
    sheet: &mut Sheet,
    trajectory: &Trajectory,
    component: usize,
    locations: &[usize],
    top: f64,
) {
    let participant = &trajectory.components()[component];
    sheet.text(LEFT - 8.0, top, &strip_name(trajectory, component), "quiet end");
    let mut x = LEFT;
    for &location in locations {
        let name = &participant.locations[location];
        sheet.area([x, top - 6.0], [12.0, 12.0], area_colour(location), name);
        sheet.text(x + 18.0, top, name, "quiet");
        x += 18.0 + text_width(name) + 18.0;
    }
}

/// The name of the component, as far as there is room; a single one needs none.
fn strip_name(trajectory: &Trajectory, component: usize) -> String {
    const MOST: usize = 11;
    let name = match trajectory.components() {
        [_] => "location",
        components => &components[component].name,
    };
    match name.chars().count() {
        count if count <= MOST => name.to_owned(),
        _ => name.chars().take(MOST - 1).chain(['…']).collect(),
    }
}
