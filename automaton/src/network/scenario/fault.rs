//! What can be wrong with a scenario.

use super::KeyPath;
use std::fmt;
use thiserror::Error;

/// Everything that keeps a mission from starting; at least one fault.
#[derive(Clone, Debug, PartialEq, Error)]
pub struct InvalidScenario {
    /// The faults, in the order of the keys.
    pub faults: Vec<Fault>,
}

impl fmt::Display for InvalidScenario {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("no mission can start from the scenario: ")?;
        for (index, fault) in self.faults.iter().enumerate() {
            let separator = if index == 0 { "" } else { "; " };
            write!(formatter, "{separator}{fault}")?;
        }
        Ok(())
    }
}

/// A value of a scenario that no mission can start from.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{key}: {problem}")]
pub struct Fault {
    /// Where the value stands.
    pub key: KeyPath,
    /// What is wrong with it, and what would be right.
    pub problem: Problem,
}

/// What is wrong with a value, and what would be right.
///
/// Lengths are in the scenario's unit. Robots and access points are counted from 0.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // the fields are the numbers that the sentences show
#[non_exhaustive]
pub enum Problem {
    /// A name that cannot be a file name.
    #[error(
        "{name:?} cannot name a file: use letters, digits, `-` and `_` only, and at least \
         one of them"
    )]
    NotAFileName { name: String },
    /// A name that is too long for a file name.
    #[error("the name takes {length} bytes: it names files, so at most {most}")]
    LongName { length: usize, most: usize },
    /// NaN or infinite.
    #[error("{value} is not a finite number: write one, such as 0.5")]
    NotFinite { value: f64 },
    /// A length or time that must be above 0.
    #[error("{} is not positive: it must be above 0", short(*value))]
    NotPositive { value: f64 },
    /// A setting that may be 0 but not below.
    #[error("{} is negative: it must be 0 or above", short(*value))]
    Negative { value: f64 },
    /// A number of times that must be at least one.
    #[error("0 leaves nothing to do: it must be at least 1")]
    Zero,
    /// A number that is too small or too large to be meant.
    #[error(
        "{} is out of range: it must lie from {} to {}", short(*value), bound(*least), bound(*most)
    )]
    OutOfRange { value: f64, least: f64, most: f64 },
    /// A length that is too small or too large to be meant.
    #[error(
        "{} is out of range: it must lie from {} to max_range = {}",
        short(*value), bound(*least), short(*max_range)
    )]
    LengthOutOfRange { value: f64, least: f64, max_range: f64 },
    /// More of something than can be meant.
    #[error("{count} is too many: it must be at most {most}")]
    TooMany { count: usize, most: usize },
    /// A coordinate that is too large for distances to be exact.
    #[error(
        "{} is too far away: coordinates are at most 1000000 times max_range = {}; move the \
         workspace to the origin, or choose another unit", short(*value), short(*most)
    )]
    TooFarAway { value: f64, most: f64 },
    /// A coordinate that is too large in this unit.
    #[error(
        "{} is too large: coordinates are at most {}, so that rounding stays negligible; choose a larger unit, such as \
         metres in place of millimetres", short(*value), short(*most)
    )]
    LargeCoordinate { value: f64, most: f64 },
    /// A clearance that is too small in this unit.
    #[error(
        "{} is too small: properties are held up to 0.000001, so at least {}; choose a smaller unit, or raise the clearance",
        short(*clearance), short(*least)
    )]
    SmallClearance { clearance: f64, least: f64 },
    /// A rate or reserve outside [0, 1].
    #[error("{} is not a share of the radio's rate: it must lie from 0 to 1", short(*value))]
    NotAShare { value: f64 },
    /// η too small.
    #[error(
        "{} leaves too little over for routes of this routing_method to change while robots move: at least {least}",
        short(*value)
    )]
    ReserveTooSmall { value: f64, least: f64 },
    /// A reliability that makes no sense as a limit for links of the tree.
    #[error(
        "{} does not lie between 0 and 1: a link of the tree needs a reliability above 0 and, to \
         have a longest one, below 1", short(*value)
    )]
    NotAReliability { value: f64 },
    /// l ≥ u in eq. (27).
    #[error(
        "{} is not below max_range = {}: reliability falls from 1 at full_range to 0 at max_range, \
         so full_range < max_range", short(*full_range), short(*max_range)
    )]
    RangesReversed { full_range: f64, max_range: f64 },
    /// A link model that is none.
    #[error("the model of the links cannot be used: {0}")]
    LinkModel(String),
    /// A steepness for a model that has none.
    #[error("only the model \"logistic\" has a steepness: leave it out, or set the model")]
    SteepnessWithoutUse,
    /// l too close to u for the slope of the reliability to make sense.
    #[error(
        "{full_range} is too close to max_range = {max_range}: reliability needs a distance of \
         at least {} to fall from 1 to 0", bound(*least)
    )]
    RangesTooClose { full_range: f64, max_range: f64, least: f64 },
    /// e or m too large against ρ.
    #[error(
        "{error} is too large for clearance = {clearance}: at most half of it, {}; raise the \
         clearance", rounded(*most)
    )]
    ErrorTooLarge { error: f64, clearance: f64, most: f64 },
    /// δ too small against ρ + e + m (Remark 5.5).
    #[error(
        "{service_radius} is too small for clearance = {}{}: two robots that hand \
         over a task stay 2 clearances apart and must both be able to service it, so at \
         least {}", rounded(*clearance), told_margin(*margin), rounded(*least)
    )]
    ServiceRadiusTooSmall { service_radius: f64, clearance: f64, margin: f64, least: f64 },
    /// ρ so large that robots out of range of each other could touch.
    #[error(
        "{clearance} is too large for max_range = {max_range}{}: robots out of range of each other \
         must stay more than 2 clearances apart; lower it, or raise max_range", told_errors(*errors)
    )]
    ClearanceTooLarge { clearance: f64, max_range: f64, errors: f64 },
    /// σ > (u − 2ρ)/4: see [`Settings::longest_step_radius`](super::Settings::longest_step_radius).
    #[error(
        "{step_radius} is too long a step: a robot that goes out of range in one control period could not be told \
         from one that is silent and near enough to collide with in the next, so 2 clearance + 2 step_radius must \
         not exceed max_range − 2 step_radius; step_radius is at most (max_range − 2 clearance)/4 = {}",
        rounded(*most)
    )]
    StepTooLong { step_radius: f64, most: f64 },
    /// No length is left for new links of the tree.
    #[error(
        "no link can be added to the tree: a reliability of {} is reached at \
         distance {longest:.6}, and robots may stand service_radius = {} away from their posts{}, or \
         raise full_range", rounded(*build_reliability), rounded(*service_radius), lower(*clearance)
    )]
    TreeLinksTooShort {
        build_reliability: f64,
        longest: f64,
        service_radius: f64,
        /// ρ, where δ follows from it.
        clearance: Option<f64>,
    },
    /// Links would be too weak as soon as they are made.
    #[error(
        "links of the tree would be made at a reliability of {build_reliability}, below \
         tree_reliability = {tree_reliability}, which they never fall below: raise it, or lower \
         tree_reliability"
    )]
    BuiltTooWeak { build_reliability: f64, tree_reliability: f64 },
    /// Nowhere to send information to.
    #[error("missing: add at least one [[access_point]], to which the data of the robots goes")]
    NoAccessPoint,
    /// There is no robot.
    #[error("missing: add at least one [[robot]]")]
    NoRobot,
    /// A task that is asked for before one that stands before it.
    #[error(
        "{announced} is before task[{other}] is announced, at {earliest}: list tasks in order of \
         announcement"
    )]
    AnnouncedOutOfOrder { announced: u32, other: usize, earliest: u32 },
    /// A task that is taken back before it is asked for.
    #[error(
        "{withdrawn} is not after the task is announced, at {announced}: it must be a later control \
         period, or be left out where the task is never taken back"
    )]
    WithdrawnTooEarly { withdrawn: u32, announced: u32 },
    /// Places for another number of robots than there are.
    #[error("there are {stated} robots and places for {given}: give one place for each")]
    OtherNumber { stated: usize, given: usize },
    /// A polygon of the workspace is not what it should be.
    #[error("{0}")]
    Outline(String),
    /// A robot or access point that is not in the workspace.
    #[error(
        "({x}, {y}) lies outside the workspace: place it inside the boundary and outside \
         the holes"
    )]
    Outside { x: f64, y: f64 },
    /// A robot that touches a wall.
    #[error(
        "({x}, {y}) is only {distance:.6} away from a wall: robots keep a clearance of \
         {}{}", rounded(*clearance), told_margin(*margin)
    )]
    TooCloseToWall { x: f64, y: f64, distance: f64, clearance: f64, margin: f64 },
    /// Robots that touch each other.
    #[error(
        "it is only {distance:.6} away from robot[{other}]: robots keep 2 clearances = \
         {} from each other{}", rounded(*least), told_margin(2.0 * margin)
    )]
    RobotsTooClose { other: usize, distance: f64, least: f64, margin: f64 },
    /// A robot that no chain of links connects to an access point.
    #[error(
        "it is cut off: no chain of robots leads from it to an access point with links of \
         at most {longest:.6} each that robots can walk, on a way that leads no farther from either end; place it \
         nearer to an access point or to another robot"
    )]
    CutOff { longest: f64 },
    /// Rates that the access points cannot receive.
    #[error(
        "no routing carries the rates from where the robots start: together the robots generate \
         {total:.6}, and those in range of an access point can pass on at most {most:.6}; lower \
         the rates, or place more robots or access points in each other's range"
    )]
    RatesAboveAccess { total: f64, most: f64 },
    /// A robot or task that is stated to belong to an access point where all belong together.
    #[error(
        "all robots are one team, which pursues all tasks: leave it out, or set control.teams to \
         \"per_access_point\""
    )]
    AccessPointWithoutUse,
    /// An access point that is not there.
    #[error(
        "there is no access_point[{access_point}]: they are counted from 0, and there are {count}"
    )]
    NoSuchAccessPoint { access_point: usize, count: usize },
    /// A task that no robot may pursue.
    #[error(
        "it belongs to access point {access_point}, and no robot does: place robots near that, or state \
         another access_point for the task"
    )]
    NoRobotOf { access_point: usize },
    /// What keeps the mission of the robots of one access point from starting.
    #[error("among what belongs to access point {access_point}: {problem}")]
    OfFleet { access_point: usize, problem: Box<Problem> },
    /// Rates that the links cannot carry.
    #[error(
        "no routing carries the rates from where the robots start: with the best one some robot \
         cannot send {missing:.6} of what it receives and generates; lower the rates or place \
         the robots closer together"
    )]
    RatesTooHigh { missing: f64 },
}

/// A number as people write it: with an exponent where it would be long.
fn short(value: f64) -> String {
    let is_long = value.is_finite() && value != 0.0 && !(1e-6..1e15).contains(&value.abs());
    if is_long { format!("{value:e}") } else { value.to_string() }
}

/// A number that has been worked out, without the rounding of its last digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.12e}").parse().unwrap_or(value)
}

/// A bound that has been worked out, as a person writes it.
fn bound(value: f64) -> String {
    short(rounded(value))
}

/// Which lengths to lower, where ρ is given if the service radius follows from it.
fn lower(clearance: Option<f64>) -> String {
    match clearance {
        Some(clearance) => {
            format!(", as clearance = {clearance} has it; lower this reliability or clearance")
        }
        None => "; lower this reliability or service_radius".to_owned(),
    }
}

/// What else keeps robots apart.
fn told_errors(errors: f64) -> &'static str {
    if errors > 0.0 { " and the errors of position and motion" } else { "" }
}

/// What a length allows for `position_error` and `motion_error`.
fn told_margin(margin: f64) -> String {
    // Sums of what people write are not what they would write.
    match (margin * 1e9).round() / 1e9 {
        0.0 => String::new(),
        margin => format!(", {margin} of it for position_error and motion_error"),
    }
}

impl Problem {
    /// This problem at `key`.
    pub(super) fn at(self, key: KeyPath) -> Fault {
        Fault { key, problem: self }
    }
}

impl From<Vec<Fault>> for InvalidScenario {
    fn from(faults: Vec<Fault>) -> Self {
        Self { faults }
    }
}
