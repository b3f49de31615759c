//! Whether the values of a scenario are in their ranges and fit each other.

use super::control::{
    CONTROL, FARTHEST, LARGEST_COORDINATE, MOST_PERIODS, SHORTEST, SMALLEST_CLEARANCE, Values,
};
use super::radio::STEEPEST;
use super::{
    Fault, KeyPath, LinkLengths, LinkModel, LinkRanges, Problem, RoutingMethod, Scenario, Settings,
    Teams,
};

/// Two robots 2ρ apart must both be able to service while they hand over a task; they approach
/// 2ρ without ever reaching it, so δ is at least this many clearances (2 in Remark 5.5).
const LEAST_SERVICE_RADIUS_IN_CLEARANCES: f64 = 2.3;

/// The least distance over which reliability falls from 1 to 0, in ranges of the links: over a shorter one loads change
/// so fast that robots object to every move.
const NARROWEST: f64 = 0.01;

/// The largest error of a position or a move, in clearances.
const MOST_ERROR_IN_CLEARANCES: f64 = 0.5;

/// Relative slack of comparisons between decimal numbers as people write them: 0.023 passes for
/// 2.3 · 0.01.
pub(super) const ROUNDING: f64 = 1e-9;

/// The largest range of links: beyond it squares of lengths come near the largest numbers.
const LARGEST_RANGE: f64 = 1e30;

/// The most rows of one table, and corners of one polygon.
const MOST_ROWS: usize = 1_000_000;

/// The most bytes of a name: with an ending it must be the name of a file.
pub const LONGEST_NAME: usize = 100;

impl Scenario {
    /// Everything that is wrong with the values, without a look at the geometry.
    pub(super) fn check_values(&self) -> Result<(), Vec<Fault>> {
        let checks: [fn(&Scenario) -> Vec<Fault>; 4] =
            [numbers_are_finite, values_are_in_range, places_are_near, settings_fit_each_other];
        match checks.iter().map(|check| check(self)).find(|faults| !faults.is_empty()) {
            Some(faults) => Err(faults),
            None => Ok(()),
        }
    }

    /// The two distances of the radio, by their keys.
    fn ranges(&self) -> [(&'static str, f64); 2] {
        [("full_range", self.link.full_range), ("max_range", self.link.max_range)]
    }

    /// A fault for each coordinate in which `problem` sees one.
    fn coordinate_faults(&self, problem: impl Fn(f64) -> Option<Problem>) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut look = |key: &dyn Fn() -> KeyPath, point: &[f64; 2]| {
            for (axis, &value) in point.iter().enumerate() {
                faults.extend(problem(value).map(|problem| problem.at(key().index(axis))));
            }
        };
        let workspace = || KeyPath::root().key("workspace");
        for (corner, point) in self.workspace.boundary.iter().enumerate() {
            look(&|| workspace().key("boundary").index(corner), point);
        }
        for (hole, polygon) in self.workspace.holes.iter().enumerate() {
            for (corner, point) in polygon.iter().enumerate() {
                look(&|| workspace().key("holes").index(hole).index(corner), point);
            }
        }
        let position = |table: &str, row| KeyPath::root().key(table).index(row).key("position");
        for (row, access_point) in self.access_point.iter().enumerate() {
            look(&|| position("access_point", row), &access_point.position);
        }
        for (row, robot) in self.robot.iter().enumerate() {
            look(&|| position("robot", row), &robot.position);
        }
        for (row, task) in self.task.iter().enumerate() {
            look(&|| position("task", row), &task.position);
        }
        faults
    }
}

/// The key of a robot.
pub(super) fn robot_key(index: usize) -> KeyPath {
    KeyPath::root().key("robot").index(index)
}

fn link_key(name: &str) -> KeyPath {
    KeyPath::root().key("link").key(name)
}

fn control_key(name: &str) -> KeyPath {
    KeyPath::root().key("control").key(name)
}

fn numbers_are_finite(scenario: &Scenario) -> Vec<Fault> {
    let not_finite = |value: f64| (!value.is_finite()).then_some(Problem::NotFinite { value });
    let stated =
        scenario.ranges().into_iter().chain(scenario.link.steepness.map(|p| ("steepness", p)));
    let link = stated.filter_map(|(name, value)| Some(not_finite(value)?.at(link_key(name))));
    let control = CONTROL.iter().filter_map(|key| {
        let value = key.values.number(&scenario.control)?;
        Some(not_finite(value)?.at(control_key(key.name)))
    });
    let rates = (scenario.robot.iter().enumerate())
        .filter_map(|(row, robot)| Some(not_finite(robot.rate)?.at(robot_key(row).key("rate"))));
    let coordinates = scenario.coordinate_faults(not_finite);
    coordinates.into_iter().chain(link).chain(control).chain(rates).collect()
}

/// Values that are wrong by themselves, or against the range of the links. What the file leaves
/// to the defaults is right if the rest is.
fn values_are_in_range(scenario: &Scenario) -> Vec<Fault> {
    let name = name_problem(&scenario.name).map(|problem| problem.at(KeyPath::root().key("name")));
    let range = scenario.link.max_range;
    let link = scenario.ranges().into_iter().filter_map(|(name, value)| {
        Some(length_problem(value, LARGEST_RANGE.recip(), LARGEST_RANGE)?.at(link_key(name)))
    });
    let steepness = steepness_problem(&scenario.link).map(|p| p.at(link_key("steepness")));
    // Lengths are held against a range that is right.
    let has_range = length_problem(range, LARGEST_RANGE.recip(), LARGEST_RANGE).is_none();
    let is_judged = |values: &Values| has_range || !values.is_against_range();
    let control = CONTROL.iter().filter(|key| is_judged(&key.values)).filter_map(|key| {
        Some(control_problem(key.values, scenario, range)?.at(control_key(key.name)))
    });
    let rates = (scenario.robot.iter().enumerate()).filter_map(|(row, robot)| {
        Some((share_problem(robot.rate)?).at(robot_key(row).key("rate")))
    });
    let mut faults: Vec<Fault> =
        name.into_iter().chain(link).chain(steepness).chain(control).chain(rates).collect();
    faults.extend(table_faults(scenario));
    faults.extend(errand_faults(scenario));
    faults.extend(owner_faults(scenario));
    faults
}

/// Access points that robots and tasks are stated to belong to, and cannot.
fn owner_faults(scenario: &Scenario) -> Vec<Fault> {
    let robots = scenario.robot.iter().map(|robot| robot.access_point).enumerate();
    let tasks = scenario.task.iter().map(|task| task.access_point).enumerate();
    let stated = robots.map(|it| ("robot", it)).chain(tasks.map(|it| ("task", it)));
    let (count, teams) = (scenario.access_point.len(), scenario.control.teams.unwrap_or_default());
    let problem = |access_point: usize| match teams {
        Teams::One => Some(Problem::AccessPointWithoutUse),
        Teams::PerAccessPoint if access_point < count => None,
        Teams::PerAccessPoint => Some(Problem::NoSuchAccessPoint { access_point, count }),
    };
    let fault = |(table, (row, stated)): (&str, (usize, Option<usize>))| {
        let key = KeyPath::root().key(table).index(row).key("access_point");
        Some(problem(stated?)?.at(key))
    };
    stated.filter_map(fault).collect()
}

/// Times of tasks that no user can mean.
fn errand_faults(scenario: &Scenario) -> Vec<Fault> {
    let key = |row, name| KeyPath::root().key("task").index(row).key(name);
    let tasks = || scenario.task.iter().enumerate();
    let out_of_order = tasks().zip(tasks().skip(1)).filter_map(|((other, before), (row, task))| {
        let (announced, earliest) = (task.asked_for(), before.asked_for());
        let problem = Problem::AnnouncedOutOfOrder { announced, other, earliest };
        (announced < earliest).then(|| problem.at(key(row, "announced")))
    });
    let taken_back = tasks().filter_map(|(row, task)| {
        let (withdrawn, announced) = (task.withdrawn?, task.asked_for());
        let problem = Problem::WithdrawnTooEarly { withdrawn, announced };
        (withdrawn <= announced).then(|| problem.at(key(row, "withdrawn")))
    });
    let without_time = tasks().filter(|(_, task)| task.lasts == Some(0));
    let too_late = tasks().flat_map(|(row, task)| {
        let times =
            [("announced", task.announced), ("withdrawn", task.withdrawn), ("lasts", task.lasts)];
        times.into_iter().filter_map(move |(name, periods)| {
            let (count, most) = (periods? as usize, MOST_PERIODS as usize);
            (count > most).then(|| Problem::TooMany { count, most }.at(key(row, name)))
        })
    });
    out_of_order
        .chain(taken_back)
        .chain(without_time.map(|(row, _)| Problem::Zero.at(key(row, "lasts"))))
        .chain(too_late)
        .collect()
}

fn control_problem(values: Values, scenario: &Scenario, range: f64) -> Option<Problem> {
    let control = &scenario.control;
    match values {
        Values::Length(stated) => {
            let problem = length_problem(stated(control)?, SHORTEST * range, range)?;
            Some(against_range(problem, range))
        }
        Values::Error(stated) => {
            Some(against_range(zero_or_more_problem(stated(control)?, range)?, range))
        }
        Values::Time(least, most, stated) => length_problem(stated(control)?, least, most),
        Values::UpTo(most, stated) => zero_or_more_problem(stated(control)?, most),
        Values::Reserve(stated) => {
            reserve_problem(stated(control)?, control.routing_method.unwrap_or_default())
        }
        Values::Reliability(stated) => {
            let value = stated(control)?;
            (value <= 0.0 || value >= 1.0).then_some(Problem::NotAReliability { value })
        }
        Values::Count(most, stated) => match stated(control)? {
            0 => Some(Problem::Zero),
            count if count > most => Some(Problem::TooMany { count, most }),
            _ => None,
        },
        Values::OneOf(_) => None,
    }
}

/// What is wrong with a length or time that must be above 0 and within bounds.
fn length_problem(value: f64, least: f64, most: f64) -> Option<Problem> {
    if value <= 0.0 {
        Some(Problem::NotPositive { value })
    } else if value < least || value > most {
        Some(Problem::OutOfRange { value, least, most })
    } else {
        None
    }
}

/// A length out of range is so because of the range of the links.
fn against_range(problem: Problem, max_range: f64) -> Problem {
    match problem {
        Problem::OutOfRange { value, least, .. } => {
            Problem::LengthOutOfRange { value, least, max_range }
        }
        problem => problem,
    }
}

/// What is wrong with a number that must be 0 or more and not above `most`.
fn zero_or_more_problem(value: f64, most: f64) -> Option<Problem> {
    match value {
        value if value < 0.0 => Some(Problem::Negative { value }),
        value if value > most => Some(Problem::OutOfRange { value, least: 0.0, most }),
        _ => None,
    }
}

fn steepness_problem(link: &LinkRanges) -> Option<Problem> {
    match (link.model, link.steepness?) {
        (LinkModel::Logistic, value) if (2.0..=STEEPEST).contains(&value) => None,
        (LinkModel::Logistic, value) => {
            Some(Problem::OutOfRange { value, least: 2.0, most: STEEPEST })
        }
        (LinkModel::Cubic, _) => Some(Problem::SteepnessWithoutUse),
    }
}

fn share_problem(value: f64) -> Option<Problem> {
    (!(0.0..=1.0).contains(&value)).then_some(Problem::NotAShare { value })
}

fn reserve_problem(value: f64, method: RoutingMethod) -> Option<Problem> {
    let least = method.least_reserve();
    match (0.0..least).contains(&value) {
        true => Some(Problem::ReserveTooSmall { value, least }),
        false => share_problem(value),
    }
}

/// Tables without a row, and tables and polygons with too many.
fn table_faults(scenario: &Scenario) -> Vec<Fault> {
    let Scenario { access_point, robot, task, workspace, .. } = scenario;
    let root = |table: &str| KeyPath::root().key(table);
    let empty = [
        (access_point.is_empty(), "access_point", Problem::NoAccessPoint),
        (robot.is_empty(), "robot", Problem::NoRobot),
    ];
    let boundary = root("workspace").key("boundary");
    let holes = root("workspace").key("holes");
    let corners = workspace.holes.iter().map(Vec::len).sum();
    let counts = [
        (access_point.len(), root("access_point")),
        (robot.len(), root("robot")),
        (task.len(), root("task")),
        (workspace.boundary.len(), boundary),
        (corners, holes),
    ];
    let empty = empty.into_iter().filter(|(is_empty, ..)| *is_empty);
    let large = counts.into_iter().filter(|&(count, _)| count > MOST_ROWS);
    (empty.map(|(_, table, problem)| problem.at(root(table))))
        .chain(large.map(|(count, key)| Problem::TooMany { count, most: MOST_ROWS }.at(key)))
        .collect()
}

/// Coordinates that are too large against the range of the links, or in this unit, for distances to be exact.
fn places_are_near(scenario: &Scenario) -> Vec<Fault> {
    let most = FARTHEST * scenario.link.max_range;
    let far = scenario.coordinate_faults(|value| {
        (value.abs() > most).then_some(Problem::TooFarAway { value, most })
    });
    if !far.is_empty() {
        return far;
    }
    let most = LARGEST_COORDINATE;
    let large = scenario.coordinate_faults(|value| {
        (value.abs() > most).then_some(Problem::LargeCoordinate { value, most })
    });
    // The first stands for all: another unit changes them together.
    large.into_iter().take(1).collect()
}

fn settings_fit_each_other(scenario: &Scenario) -> Vec<Fault> {
    let settings = Settings::resolve(scenario);
    let LinkRanges { full_range, max_range, .. } = settings.link;

    if full_range >= max_range {
        let problem = Problem::RangesReversed { full_range, max_range };
        return vec![problem.at(link_key("full_range"))];
    }
    if max_range - full_range < NARROWEST * max_range * (1.0 - ROUNDING) {
        let least = NARROWEST * max_range;
        let problem = Problem::RangesTooClose { full_range, max_range, least };
        return vec![problem.at(link_key("full_range"))];
    }
    if settings.clearance < SMALLEST_CLEARANCE {
        let (clearance, least) = (settings.clearance, SMALLEST_CLEARANCE);
        return vec![Problem::SmallClearance { clearance, least }.at(control_key("clearance"))];
    }
    let errors = errors_are_small(&settings);
    if !errors.is_empty() {
        return errors;
    }
    let Settings {
        service_radius, step_radius, build_reliability, tree_reliability, errors, ..
    } = settings;
    let clearance = settings.planning_clearance();
    let most = settings.longest_step_radius();
    if most <= 0.0 {
        let (clearance, errors) = (settings.clearance, settings.link_margin());
        let problem = Problem::ClearanceTooLarge { clearance, max_range, errors };
        return vec![problem.at(control_key("clearance"))];
    }
    let margin = clearance - settings.clearance;
    let least =
        LEAST_SERVICE_RADIUS_IN_CLEARANCES * clearance + errors.stray() + 2.0 * errors.motion;
    let service = (service_radius < least * (1.0 - ROUNDING)).then(|| {
        Problem::ServiceRadiusTooSmall { service_radius, clearance, margin, least }
            .at(control_key("service_radius"))
    });
    let step = (step_radius > most * (1.0 + ROUNDING))
        .then(|| Problem::StepTooLong { step_radius, most }.at(control_key("step_radius")));
    let weak = (build_reliability < tree_reliability).then(|| {
        Problem::BuiltTooWeak { build_reliability, tree_reliability }
            .at(control_key("build_reliability"))
    });
    let LinkLengths { build, hard: longest } = settings.usual_links();
    let links = (build <= 0.0).then(|| {
        let control = &scenario.control;
        let stated = [
            ("build_reliability", control.build_reliability),
            ("tree_reliability", control.tree_reliability),
            ("service_radius", control.service_radius),
        ];
        let stated = stated.into_iter().find(|(_, value)| value.is_some());
        let key = stated.map_or("clearance", |(key, _)| key);
        let clearance = control.service_radius.is_none().then_some(settings.clearance);
        Problem::TreeLinksTooShort { build_reliability, longest, service_radius, clearance }
            .at(control_key(key))
    });
    [service, step, weak, links].into_iter().flatten().collect()
}

/// Errors larger than a share of ρ: a robot would not know on which side of it another one is.
fn errors_are_small(settings: &Settings) -> Vec<Fault> {
    let clearance = settings.clearance;
    let most = MOST_ERROR_IN_CLEARANCES * clearance;
    let stated =
        [("position_error", settings.errors.position), ("motion_error", settings.errors.motion)];
    let is_large = |&(_, error): &(&str, f64)| error > most * (1.0 + ROUNDING);
    (stated.into_iter().filter(is_large))
        .map(|(key, error)| Problem::ErrorTooLarge { error, clearance, most }.at(control_key(key)))
        .collect()
}

/// What keeps `name` from being the name of a file wherever the program runs.
fn name_problem(name: &str) -> Option<Problem> {
    let is_file_name =
        !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_');
    if !is_file_name {
        Some(Problem::NotAFileName { name: name.into() })
    } else if name.len() > LONGEST_NAME {
        Some(Problem::LongName { length: name.len(), most: LONGEST_NAME })
    } else {
        None
    }
}
