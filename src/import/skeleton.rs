//! From a floor plan to a scenario that runs.

use super::gaps;
use super::{MapPlaces, Plan, bounds, counted, extent};
use crate::automaton::network::Site;
use crate::automaton::network::scenario::{
    AccessPoint, Agenda, Control, InvalidScenario, LinkRanges, RobotStart, Scenario, Task,
    ValidScenario,
};
use crate::continuous::Point;
use crate::figures::quantity;
use crate::starts::{self, Dice};
use std::fmt::Write;
use thiserror::Error;

/// What a floor plan leaves open.
#[derive(Clone, Debug, PartialEq)]
pub struct Choices {
    /// The name of the scenario.
    pub name: String,
    /// l: by default a sixth of the extent.
    pub full_range: Option<f64>,
    /// u: by default 1.25 l.
    pub max_range: Option<f64>,
    /// ρ: by default l/40.
    pub clearance: Option<f64>,
    /// Where access points stand: by default where the map says, or else in the middle of the
    /// widest place.
    pub access_points: Vec<[f64; 2]>,
    /// How many robots start around the access points, where the map names none.
    pub robots: usize,
    /// Where tasks are; by default where the map says, or else far from the access points.
    pub tasks: Vec<[f64; 2]>,
    /// How many tasks are placed far from the access points and from each other, where none are
    /// named.
    pub far_tasks: usize,
}

impl Choices {
    /// Everything left to the defaults: eight robots and a task.
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            full_range: None,
            max_range: None,
            clearance: None,
            access_points: Vec::new(),
            robots: 8,
            tasks: Vec::new(),
            far_tasks: 1,
        }
    }
}

/// Why no scenario comes of a floor plan.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SkeletonError {
    /// No mission can start on it.
    #[error("no scenario can be made of this map: {0}")]
    Invalid(#[from] InvalidScenario),
    /// The outline cannot be used.
    #[error("no scenario can be made of this map: {0}")]
    Site(#[from] crate::automaton::network::SiteError),
    /// An access point stands outside the floor.
    #[error(
        "the access point at ({}, {}) lies outside the floor, which reaches from ({}, {}) to \
         ({}, {}): place it inside the outline and outside the walls",
        at[0], at[1], low[0], low[1], high[0], high[1]
    )]
    Outside {
        /// Where it stands.
        at: [f64; 2],
        /// The least coordinates of the floor.
        low: [f64; 2],
        /// The greatest coordinates of the floor.
        high: [f64; 2],
    },
    /// A length that was chosen is none.
    #[error("the {name} is {length}: it must be a finite length above 0")]
    NoLength {
        /// What it is the length of.
        name: &'static str,
        /// What was chosen.
        length: f64,
    },
    /// There is no room.
    #[error(
        "no place was found for {0}: the clearance may be too large for this floor, or the links \
         too short; give --clearance, --full-range and --max-range, or places"
    )]
    NoRoom(&'static str),
}

/// The share of the extent that links are long by default.
const RANGE: f64 = 1.0 / 6.0;
/// u / l by default.
const TRANSITION: f64 = 1.25;
/// The most passages that are named with their places.
const PASSAGES_NAMED: usize = 8;
/// Places along the longer side of the map that are looked at for access points and tasks.
const LATTICE: usize = 48;
/// Decimals of coordinates, relative to the extent: a millionth of it.
const DIGITS: i32 = 6;

/// A scenario on the floor of a plan, and what is to be said about it: passages that are too
/// narrow, and parts that robots cannot reach.
///
/// # Errors
/// When no access point, robots or tasks find a place.
pub fn skeleton(
    plan: &Plan,
    choices: &Choices,
) -> Result<(ValidScenario, Vec<String>), SkeletonError> {
    lengths_are_positive(choices)?;
    let mut scenario = outline(plan, choices);
    let site = Site::new(&scenario)?;
    let mut notes: Vec<String> = site.repairs.iter().map(ToString::to_string).collect();
    notes.extend(narrow_passages(&scenario, &site));

    let named = places_named(plan, &scenario);
    let places = Lattice::of(&site);
    let access_points = first_of([&choices.access_points, &named.access_points]);
    scenario.access_point = match access_points.is_empty() {
        false => access_points,
        true => vec![places.widest(&site).ok_or(SkeletonError::NoRoom("an access point"))?],
    }
    .into_iter()
    .map(|position| AccessPoint { position })
    .collect();
    let site = Site::new(&scenario)?;
    access_points_are_on_the_floor(&scenario, &site)?;
    let starts = match named.robots.is_empty() {
        false => named.robots,
        true => (0..STARTS)
            .find_map(|draft| starts::places(&site, choices.robots, &mut Dice::new(1, draft)))
            .ok_or(SkeletonError::NoRoom("the robots"))?,
    };
    let rate = RATES / starts.len().max(1) as f64;
    scenario.robot = starts
        .into_iter()
        .map(|position| RobotStart::at(rounded(position, &scenario), rounded_rate(rate)))
        .collect();
    let tasks = first_of([&choices.tasks, &named.tasks]);
    let tasks = match tasks.is_empty() {
        false => tasks,
        true => {
            let far = places.far_apart(&site, choices.far_tasks);
            notes.extend(too_few_places(far.len(), choices.far_tasks));
            far
        }
    };
    scenario.task = tasks.into_iter().map(Task::at).collect();
    let unreached = places.unreached(&site);
    if unreached > 0.005 {
        notes.push(format!("robots cannot reach {:.1} % of the floor", 100.0 * unreached));
    }
    Ok((ValidScenario::new(scenario)?, notes))
}

/// What is to be said where the floor has fewer places for tasks than are asked for.
fn too_few_places(found: usize, asked_for: usize) -> Option<String> {
    let tasks = counted(found, "task is", "tasks are");
    (found < asked_for).then(|| {
        format!("{tasks} placed and not {asked_for}: there are no more places that robots reach")
    })
}

fn lengths_are_positive(choices: &Choices) -> Result<(), SkeletonError> {
    let Choices { full_range, max_range, clearance, .. } = *choices;
    let lengths =
        [("full range", full_range), ("maximal range", max_range), ("clearance", clearance)];
    let chosen = lengths.into_iter().filter_map(|(name, length)| Some((name, length?)));
    let mut wrong = chosen.filter(|(_, length)| !(length.is_finite() && *length > 0.0));
    wrong.next().map_or(Ok(()), |(name, length)| Err(SkeletonError::NoLength { name, length }))
}

fn access_points_are_on_the_floor(scenario: &Scenario, site: &Site) -> Result<(), SkeletonError> {
    let places = scenario.access_point.iter().map(|access_point| access_point.position);
    let outside = places.into_iter().find(|&place| !site.workspace.contains(place.into()));
    outside.map_or(Ok(()), |at| {
        let [low, high] = bounds(&scenario.workspace.boundary);
        Err(SkeletonError::Outside { at, low, high })
    })
}

/// Drafts of starts that are tried.
const STARTS: u64 = 50;

/// What all robots together generate by default: one robot in range of an access point carries it.
const RATES: f64 = 0.6;

/// The scenario without access points, robots and tasks.
fn outline(plan: &Plan, choices: &Choices) -> Scenario {
    let extent = extent(&plan.workspace.boundary);
    let step = 10f64.powf((extent * RANGE).log10().floor() - 1.0);
    let full_range = choices.full_range.unwrap_or((extent * RANGE / step).round() * step);
    let max_range = choices.max_range.unwrap_or(TRANSITION * full_range);
    let mut scenario = Scenario {
        name: choices.name.clone(),
        description: None,
        workspace: plan.workspace.clone(),
        link: LinkRanges::new(trimmed(full_range), trimmed(max_range)),
        control: Control { clearance: choices.clearance, ..Control::default() },
        mission: Agenda::default(),
        access_point: Vec::new(),
        robot: Vec::new(),
        task: Vec::new(),
    };
    let round = |ring: &[[f64; 2]]| {
        let mut ring: Vec<_> = ring.iter().map(|&corner| rounded_to(corner, extent)).collect();
        ring.dedup();
        ring
    };
    scenario.workspace.boundary = round(&plan.workspace.boundary);
    scenario.workspace.holes = plan.workspace.holes.iter().map(|hole| round(hole)).collect();
    scenario
}

fn first_of(lists: [&Vec<[f64; 2]>; 2]) -> Vec<[f64; 2]> {
    lists.into_iter().find(|list| !list.is_empty()).cloned().unwrap_or_default()
}

/// The places that the map names, with as many digits as the outline has.
fn places_named(plan: &Plan, scenario: &Scenario) -> MapPlaces {
    let MapPlaces { access_points, robots, tasks } = &plan.places;
    let [access_points, robots, tasks] = [access_points, robots, tasks]
        .map(|places| places.iter().map(|&place| rounded(place, scenario)).collect());
    MapPlaces { access_points, robots, tasks }
}

/// The passages that are too narrow, the widest by their places: a robot that is a little smaller
/// gets through those, and clutter makes many that are narrower.
fn narrow_passages(scenario: &Scenario, site: &Site) -> Vec<String> {
    let width = 2.0 * site.settings.clearance;
    let gaps = gaps::narrower_than(&site.workspace, width);
    let mut notes: Vec<String> = (gaps.iter().rev().take(PASSAGES_NAMED))
        .map(|gap| {
            let [x, y] = rounded(gap.at, scenario);
            format!(
                "the passage at ({x}, {y}) is {} wide: robots need 2 clearances = {}",
                quantity(gap.width),
                quantity(width)
            )
        })
        .collect();
    match gaps.len().saturating_sub(PASSAGES_NAMED) {
        0 => {}
        1 => notes.push("one more passage is narrower than these".into()),
        more => notes.push(format!("{more} more passages are narrower than these")),
    }
    notes
}

/// Places on a lattice in the free space, with their distance from walls.
struct Lattice {
    places: Vec<Point>,
}

impl Lattice {
    fn of(site: &Site) -> Self {
        let corners = site.workspace.polygons().iter().flatten();
        let low = corners.copied().reduce(|low, corner| low.inf(&corner)).unwrap_or_default();
        let step = site.workspace.extent() / LATTICE as f64;
        let lattice = (0..LATTICE).flat_map(|row| (0..LATTICE).map(move |column| (column, row)));
        let places = lattice
            .map(|(column, row)| {
                low + nalgebra::Vector2::new(column as f64 + 0.5, row as f64 + 0.5) * step
            })
            .filter(|&place| site.free_space.contains(place))
            .collect();
        Self { places }
    }

    /// The place farthest from walls.
    fn widest(&self, site: &Site) -> Option<[f64; 2]> {
        let clearance = |place: &Point| site.workspace.clearance(*place);
        let widest = self.places.iter().max_by(|a, b| clearance(a).total_cmp(&clearance(b)))?;
        Some(rounded_to((*widest).into(), site.workspace.extent()))
    }

    /// Different places far from the access points and from each other, one after another; fewer than asked for if
    /// there are no more.
    fn far_apart(&self, site: &Site, count: usize) -> Vec<[f64; 2]> {
        let mut chosen = site.access_points.clone();
        let nearest = |place: Point, chosen: &[Point]| {
            chosen.iter().map(|&other| site.distance(other, place)).fold(f64::INFINITY, f64::min)
        };
        let mut distances: Vec<f64> =
            self.places.iter().map(|&place| nearest(place, &chosen)).collect();
        let fixed = chosen.len();
        for _ in 0..count {
            let reached = (0..distances.len()).filter(|&place| distances[place].is_finite());
            let Some(farthest) = reached.max_by(|&a, &b| distances[a].total_cmp(&distances[b]))
            else {
                break;
            };
            chosen.push(self.places[farthest]);
            distances[farthest] = f64::NEG_INFINITY; // not again
            for (place, distance) in self.places.iter().zip(&mut distances) {
                *distance = distance.min(site.distance(chosen[chosen.len() - 1], *place));
            }
        }
        let extent = site.workspace.extent();
        chosen[fixed..].iter().map(|&place| rounded_to(place.into(), extent)).collect()
    }

    /// The share of the places that no way leads to from an access point.
    fn unreached(&self, site: &Site) -> f64 {
        let reached = |place: &&Point| {
            site.access_points.iter().any(|&from| site.distance(from, **place).is_finite())
        };
        1.0 - self.places.iter().filter(reached).count() as f64 / self.places.len().max(1) as f64
    }
}

fn rounded(place: [f64; 2], scenario: &Scenario) -> [f64; 2] {
    rounded_to(place, extent(&scenario.workspace.boundary))
}

/// A place to a millionth of the extent.
fn rounded_to(place: [f64; 2], extent: f64) -> [f64; 2] {
    let decimals = (DIGITS - extent.log10().floor() as i32).clamp(0, 15) as usize;
    place.map(|value| format!("{value:.decimals$}").parse().unwrap_or(value))
}

/// A rate to four decimals, or to two digits where four decimals hold fewer; rounded down, so that the sum of all is at
/// most [`RATES`].
fn rounded_rate(rate: f64) -> f64 {
    let decimals = (1.0 - rate.log10().floor()).max(4.0);
    let scale = 10f64.powf(decimals);
    // What is a whole number but for rounding stays one.
    (rate * scale + 1e-6).floor() / scale
}

/// A number without the rounding of its last digits.
fn trimmed(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

/// The scenario as a file for people: places in rows, with comments.
pub fn text(scenario: &Scenario, origin: &str, notes: &[String]) -> String {
    let mut text = format!("# Imported from {}.\n", in_a_line(origin));
    for note in notes {
        // Writing into a text does not fail.
        let _ = writeln!(text, "# - {}", in_a_line(note));
    }
    let _ = write!(text, "\nname = {:?}\n\n[workspace]\n", scenario.name);
    let _ = writeln!(text, "boundary = {}", polygon(&scenario.workspace.boundary, ""));
    if !scenario.workspace.holes.is_empty() {
        text += "holes = [\n";
        for hole in &scenario.workspace.holes {
            let _ = writeln!(text, "    {},", polygon(hole, "    "));
        }
        text += "]\n";
    }
    let LinkRanges { full_range, max_range, .. } = scenario.link;
    let _ = write!(
        text,
        "\n[link] # links reach through walls: choose ranges that hold through them\n\
         full_range = {full_range}\nmax_range = {max_range}\n"
    );
    if let Some(clearance) = scenario.control.clearance {
        let _ = write!(text, "\n[control]\nclearance = {clearance}\n");
    }
    for AccessPoint { position } in &scenario.access_point {
        let _ = write!(text, "\n[[access_point]]\nposition = {position:?}\n");
    }
    for RobotStart { position, rate, .. } in &scenario.robot {
        let _ = write!(text, "\n[[robot]]\nposition = {position:?}\nrate = {rate}\n");
    }
    for Task { position, .. } in &scenario.task {
        let _ = write!(text, "\n[[task]]\nposition = {position:?}\n");
    }
    text
}

/// A text as a comment can hold it: line breaks and other control characters are escaped.
fn in_a_line(text: &str) -> String {
    let escaped = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.into() };
    text.chars().map(escaped).collect()
}

/// A polygon with a few corners in each line.
fn polygon(ring: &[[f64; 2]], indent: &str) -> String {
    const IN_A_LINE: usize = 6;
    let line = |corners: &[[f64; 2]]| {
        let corners: Vec<String> = corners.iter().map(|corner| format!("{corner:?}")).collect();
        format!("{indent}    {},\n", corners.join(", "))
    };
    format!("[\n{}{indent}]", ring.chunks(IN_A_LINE).map(line).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Robots without a rate would say nothing.
    #[test]
    fn rates_of_many_robots_are_above_zero() {
        let rates =
            [1, 3, 7, 8, 600, 6001, 65_535].map(|robots| rounded_rate(RATES / f64::from(robots)));
        assert_eq!(rates, [0.6, 0.2, 0.0857, 0.075, 0.001, 0.000_099, 0.000_009_1]);
    }
}
