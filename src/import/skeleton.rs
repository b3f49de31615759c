//! From a floor plan to a scenario that runs.

use super::account::percent;
use super::places::{Places, rounded};
use super::radio::{Radio, TRANSITION, default_clearance, default_full_range, trimmed};
use super::spots::{Chosen, Spot};
use super::{ACCEPTED_LOSS, Plan, bounds, counted, extent, gaps};
use crate::automaton::network::scenario::{
    AccessPoint, Agenda, Control, InvalidScenario, LinkRanges, RobotStart, Scenario, Settings,
    Task, ValidScenario, WorkspaceOutline,
};
use crate::automaton::network::{Site, SiteError};
use crate::continuous::Point;
use crate::continuous::geometry::{FreeSpace, Workspace};
use crate::figures::quantity;
use crate::starts::{self, Dice};
use thiserror::Error;

/// What a floor plan leaves open.
#[derive(Clone, Debug, PartialEq)]
pub struct Choices {
    /// The name of the scenario.
    pub name: String,
    /// The radio that gives l and u where these are not stated.
    pub radio: Option<Radio>,
    /// l: by default a sixth of the extent.
    pub full_range: Option<f64>,
    /// u: by default 1.25 l.
    pub max_range: Option<f64>,
    /// ρ, the radius of the robots: by default a fortieth of a sixth of the extent, where that leaves the floor whole.
    pub clearance: Option<f64>,
    /// Where access points stand: by default where the map says, or else in the middle of the
    /// widest place.
    pub access_points: Vec<Spot>,
    /// How many robots start around the access points, where the map names none.
    pub robots: usize,
    /// Where robots start instead: around this place.
    pub near: Option<Spot>,
    /// Where tasks are; by default where the map says, or else far from the access points.
    pub tasks: Vec<Spot>,
    /// Tasks from a list, instead of others.
    pub listed_tasks: Vec<Task>,
    /// How many tasks are placed far from the access points and from each other, where none are
    /// named.
    pub far_tasks: usize,
}

impl Choices {
    /// Everything left to the defaults: eight robots and a task.
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            radio: None,
            full_range: None,
            max_range: None,
            clearance: None,
            access_points: Vec::new(),
            robots: 8,
            near: None,
            tasks: Vec::new(),
            listed_tasks: Vec::new(),
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
        "the access point at ({}, {}) is in a wall or outside the floor, which reaches from ({}, {}) to \
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
    /// No point of the map has this name.
    #[error("no point of the map is named {name:?}: {known}")]
    NoSuchPoint {
        /// The name.
        name: String,
        /// The names that exist, in a clause.
        known: String,
    },
    /// The clearance that was not chosen is too large for the floor.
    #[error(
        "robots with the default radius {clearance} reach only {} of the floor, since passages are too narrow for \
         them: give --robot-radius{}, or {clearance} to leave the rest",
        percent(*.reached),
        fitting.map_or(String::new(), |fitting| format!(" {fitting}, with which they reach nearly all of it"))
    )]
    TooLarge {
        /// The default.
        clearance: f64,
        /// The share of the floor that robots reach with it, 0 to 1.
        reached: f64,
        /// A clearance with which they reach nearly all.
        fitting: Option<f64>,
    },
    /// The robots do not fit on the floor.
    #[error(
        "{robots} robots of radius {clearance} do not fit on the floor that they can reach: with the distance that they \
         keep, {fitting} do; give --robots {fitting} or fewer, or a smaller --robot-radius"
    )]
    TooMany {
        /// How many there are.
        robots: usize,
        /// ρ.
        clearance: f64,
        /// How many fit, in rows.
        fitting: usize,
    },
    /// There is no room.
    #[error(
        "no place was found for {0}: the clearance may be too large for this floor, or the links \
         too short; give --clearance, --full-range and --max-range, or places"
    )]
    NoRoom(&'static str),
}

/// The most passages that are named with their places.
const PASSAGES_NAMED: usize = 8;
/// How many times more robots must fit in rows than are placed at random.
const ROOM_FOR_RANDOM: usize = 2;
/// Drafts of starts that are tried.
const STARTS: u64 = 50;
/// What all robots together generate by default: one robot in range of an access point carries it.
const RATES: f64 = 0.6;
/// The share of the floor that robots may miss without a word.
const MISSED: f64 = 0.005;

/// A scenario on the floor of a plan, and what is to be said about it: passages that are too
/// narrow, and parts that robots cannot reach.
///
/// # Errors
/// When no access point, robots or tasks find a place, and when the default clearance is too large for the floor.
pub fn skeleton(
    plan: &Plan,
    choices: &Choices,
) -> Result<(ValidScenario, Vec<String>), SkeletonError> {
    lengths_are_positive(choices)?;
    let mut scenario = outline(plan, choices);
    let (workspace, _) = scenario.workspace().map_err(SiteError::Workspace)?;
    let floor = Places::on(&workspace);
    let mut chosen = Chosen::of(plan, choices, workspace.extent())?;
    if chosen.access_points.is_empty() {
        let widest = || floor.widest(&workspace).ok_or(SkeletonError::NoRoom("an access point"));
        chosen.access_points = vec![chosen.near.map_or_else(widest, Ok)?];
    }
    access_points_are_on(&workspace, &chosen.access_points)?;
    let from: Vec<Point> = chosen.access_points.iter().map(|&place| place.into()).collect();
    scenario.access_point =
        chosen.access_points.iter().map(|&position| AccessPoint { position }).collect();
    if choices.clearance.is_none() {
        leaves_the_floor_whole(&scenario, &workspace, &floor, &from)?;
    }

    let site = Site::new(&scenario)?;
    let mut notes: Vec<String> = site.repairs.iter().map(ToString::to_string).collect();
    notes.extend(narrow_passages(&site));
    notes.extend(range_of_the_radio(choices, &scenario));
    let starts = match chosen.robots.is_empty() {
        false => chosen.robots,
        true => starts(&site, chosen.near.map(Point::from), choices.robots, &mut notes)?,
    };
    let rate = rounded_rate(RATES / starts.len().max(1) as f64);
    notes.extend(rates(starts.len(), rate));
    scenario.robot = starts
        .into_iter()
        .map(|position| RobotStart::at(rounded(position, workspace.extent()), rate))
        .collect();
    if chosen.tasks.is_empty() && choices.listed_tasks.is_empty() {
        chosen.tasks = floor.within(&site.free_space).far_apart(&site, choices.far_tasks);
        notes.extend(too_few_places(chosen.tasks.len(), choices.far_tasks));
    }
    scenario.task = match choices.listed_tasks.is_empty() {
        true => chosen.tasks.into_iter().map(Task::at).collect(),
        false => choices.listed_tasks.clone(),
    };
    let missed = 1.0 - floor.reached(&site.free_space, &from);
    if missed > MISSED {
        notes.push(format!("robots cannot reach {} of the floor", percent(missed)));
    }
    Ok((ValidScenario::new(scenario)?, notes))
}

/// Where robots start: as near to a place as they fit, or else at random around the access points, if there is room
/// for that without walls between a robot and the node that it is near.
fn starts(
    site: &Site,
    near: Option<Point>,
    robots: usize,
    notes: &mut Vec<String>,
) -> Result<Vec<[f64; 2]>, SkeletonError> {
    let middle = near.unwrap_or_else(|| site.free_space.nearest(site.access_points[0]));
    // Robots at random places leave gaps that are too small for others.
    let mut rows = starts::around(site, middle, ROOM_FOR_RANDOM * robots);
    if rows.len() < robots {
        let clearance = site.settings.clearance;
        return Err(match rows.len() {
            0 => SkeletonError::NoRoom("the robots"),
            fitting => SkeletonError::TooMany { robots, clearance, fitting },
        });
    }
    if near.is_none() && rows.len() == ROOM_FOR_RANDOM * robots {
        let is_open = |from, to| site.workspace.segment_clearance(from, to) > 0.0;
        let drafts = || (0..STARTS).map(|draft| Dice::new(1, draft));
        if let Some(places) =
            drafts().find_map(|mut dice| starts::places(site, robots, &mut dice, is_open))
        {
            return Ok(places);
        }
    }
    rows.truncate(robots);
    if near.is_none() {
        notes.push(
            "robots start in rows around the first access point: at random places they do not fit"
                .to_owned(),
        );
    }
    Ok(rows)
}

/// What is to be said where one range is stated and the other one is the radio's.
fn range_of_the_radio(choices: &Choices, scenario: &Scenario) -> Option<String> {
    let [full, max] = choices.radio?.ranges();
    let LinkRanges { full_range, max_range, .. } = scenario.link;
    match (choices.full_range, choices.max_range) {
        (Some(_), None) if max_range == max => Some(format!(
            "max_range = {max} is the radio's, and full_range = {full_range} is not: --max-range changes it"
        )),
        (Some(_), None) => Some(format!(
            "max_range = {max_range} follows from full_range = {full_range}, since the radio's {max} is not larger: \
             --max-range changes it"
        )),
        (None, Some(_)) => Some(format!(
            "full_range = {full} is the radio's, and max_range = {max_range} is not: --full-range changes it"
        )),
        _ => None,
    }
}

/// What is to be said about the rates, which no map states.
fn rates(robots: usize, rate: f64) -> Option<String> {
    (robots > 0).then(|| {
        format!(
            "rate = {rate} for each robot, together at most {RATES} of what one robot can carry: the map states no \
             rates, so set what yours send"
        )
    })
}

/// An error if robots with the default clearance miss more of the floor than may be lost.
fn leaves_the_floor_whole(
    scenario: &Scenario,
    workspace: &Workspace,
    floor: &Places,
    from: &[Point],
) -> Result<(), SkeletonError> {
    let clearance = Settings::resolve(scenario).clearance;
    let share = 1.0 - ACCEPTED_LOSS;
    let space = FreeSpace::new(workspace, clearance);
    let reached = space.map_or(0.0, |space| floor.reached(&space, from));
    if reached >= share {
        return Ok(());
    }
    let fitting = floor.clearance_that_fits(workspace, from, share, clearance);
    Err(SkeletonError::TooLarge { clearance, reached, fitting })
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

fn access_points_are_on(floor: &Workspace, places: &[[f64; 2]]) -> Result<(), SkeletonError> {
    let outside = places.iter().find(|&&place| !floor.contains(place.into()));
    outside.map_or(Ok(()), |&at| {
        let [low, high] =
            bounds(&floor.boundary().iter().map(|&corner| corner.into()).collect::<Vec<_>>());
        Err(SkeletonError::Outside { at, low, high })
    })
}

/// The scenario without access points, robots and tasks.
fn outline(plan: &Plan, choices: &Choices) -> Scenario {
    let extent = extent(&plan.workspace.boundary);
    let of_radio = choices.radio.map(Radio::ranges);
    let full_range = choices.full_range.or(of_radio.map(|[full, _]| full));
    let full_range = full_range.unwrap_or_else(|| default_full_range(extent));
    let max_range =
        choices.max_range.or(of_radio.map(|[_, max]| max).filter(|max| *max > full_range));
    let max_range = max_range.unwrap_or_else(|| trimmed(TRANSITION * full_range));
    let clearance = choices.clearance.unwrap_or_else(|| default_clearance(extent));
    let round = |ring: &Vec<[f64; 2]>| {
        let mut ring: Vec<_> = ring.iter().map(|&corner| rounded(corner, extent)).collect();
        ring.dedup();
        ring
    };
    Scenario {
        name: choices.name.clone(),
        description: None,
        workspace: WorkspaceOutline {
            boundary: round(&plan.workspace.boundary),
            holes: plan.workspace.holes.iter().map(round).collect(),
        },
        link: LinkRanges::new(full_range, max_range),
        control: Control { clearance: Some(clearance), ..Control::default() },
        mission: Agenda::default(),
        access_point: Vec::new(),
        robot: Vec::new(),
        task: Vec::new(),
    }
}

/// The passages that are too narrow, the widest by their places: a robot that is a little smaller
/// gets through those, and clutter makes many that are narrower.
fn narrow_passages(site: &Site) -> Vec<String> {
    let width = 2.0 * site.settings.clearance;
    let gaps = gaps::narrower_than(&site.workspace, width);
    let mut notes: Vec<String> = (gaps.iter().rev().take(PASSAGES_NAMED))
        .map(|gap| {
            let [x, y] = rounded(gap.at, site.workspace.extent());
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

/// A rate to four decimals, or to two digits where four decimals hold fewer; rounded down, so that the sum of all is at
/// most [`RATES`].
fn rounded_rate(rate: f64) -> f64 {
    let decimals = (1.0 - rate.log10().floor()).max(4.0);
    let scale = 10f64.powf(decimals);
    // What is a whole number but for rounding stays one.
    (rate * scale + 1e-6).floor() / scale
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
