//! Whether a mission can start from a scenario.

use super::{Control, Fault, KeyPath, LinkRanges, Problem, Scenario, Settings, placement};

/// Two robots 2ρ apart must both be able to service while they hand over a task; they approach
/// 2ρ without ever reaching it, so δ is at least this many clearances (2 in Remark 5.5).
const LEAST_SERVICE_RADIUS_IN_CLEARANCES: f64 = 2.3;

/// Relative slack of comparisons between decimal numbers as people write them: 0.023 passes for
/// 2.3 · 0.01.
pub(super) const ROUNDING: f64 = 1e-9;

impl Scenario {
    /// Everything that keeps a mission from starting.
    ///
    /// A task in a wall or out of reach is no fault: it ends the mission with an outcome of its
    /// own.
    ///
    /// # Errors
    /// The faults, in the order of the keys. Later checks presuppose earlier ones (numbers are
    /// finite, then settings fit each other, then polygons are simple, then robots stand well,
    /// then they are connected), so only the first kind of check that fails is reported.
    pub fn validate(&self) -> Result<(), Vec<Fault>> {
        let checks: [fn(&Scenario) -> Vec<Fault>; 4] =
            [numbers_are_finite, values_are_in_range, settings_fit_each_other, placement::faults];
        match checks.iter().map(|check| check(self)).find(|faults| !faults.is_empty()) {
            Some(faults) => Err(faults),
            None => Ok(()),
        }
    }

    /// Every number that the scenario states, with its key.
    fn numbers(&self) -> Vec<(KeyPath, f64)> {
        let outlines = self.outlines().into_iter().flat_map(|(key, polygon)| {
            let corners = polygon.iter().enumerate();
            corners.flat_map(move |(corner, point)| coordinates(key.clone().index(corner), point))
        });
        let places = self.places().into_iter().flat_map(|(key, point)| coordinates(key, point));
        let link = [("full_range", self.link.full_range), ("max_range", self.link.max_range)]
            .map(|(name, value)| (KeyPath::root().key("link").key(name), value));
        let control =
            self.control.numbers().into_iter().filter_map(|(name, value)| {
                Some((KeyPath::root().key("control").key(name), value?))
            });
        let rates = (self.robot.iter().enumerate())
            .map(|(index, robot)| (robot_key(index).key("rate"), robot.rate));
        outlines.chain(link).chain(control).chain(places).chain(rates).collect()
    }

    /// The polygons of the workspace with their keys: the boundary, then the holes.
    fn outlines(&self) -> Vec<(KeyPath, &[[f64; 2]])> {
        let key = |name| KeyPath::root().key("workspace").key(name);
        let holes = (self.workspace.holes.iter().enumerate())
            .map(|(hole, polygon)| (key("holes").index(hole), polygon.as_slice()));
        [(key("boundary"), self.workspace.boundary.as_slice())].into_iter().chain(holes).collect()
    }

    /// The positions of access points, robots and tasks with their keys.
    fn places(&self) -> Vec<(KeyPath, &[f64; 2])> {
        fn keyed<'a>(
            table: &'static str,
            positions: impl Iterator<Item = &'a [f64; 2]>,
        ) -> impl Iterator<Item = (KeyPath, &'a [f64; 2])> {
            positions.enumerate().map(move |(index, position)| {
                (KeyPath::root().key(table).index(index).key("position"), position)
            })
        }
        keyed("access_point", self.access_point.iter().map(|point| &point.position))
            .chain(keyed("robot", self.robot.iter().map(|robot| &robot.position)))
            .chain(keyed("task", self.task.iter().map(|task| &task.position)))
            .collect()
    }
}

impl Control {
    /// The real-valued settings by their keys.
    fn numbers(&self) -> [(&'static str, Option<f64>); 8] {
        [
            ("clearance", self.clearance),
            ("service_radius", self.service_radius),
            ("step_radius", self.step_radius),
            ("residual_tolerance", self.residual_tolerance),
            ("period", self.period),
            ("routing_reserve", self.routing_reserve),
            ("slope_aversion", self.slope_aversion),
            ("tree_reliability", self.tree_reliability),
        ]
    }
}

/// The key of a robot.
pub(super) fn robot_key(index: usize) -> KeyPath {
    KeyPath::root().key("robot").index(index)
}

/// The two coordinates of the point at `key`, each with its own key.
fn coordinates(key: KeyPath, point: &[f64; 2]) -> impl Iterator<Item = (KeyPath, f64)> {
    let [x, y] = *point;
    [(key.clone().index(0), x), (key.index(1), y)].into_iter()
}

fn numbers_are_finite(scenario: &Scenario) -> Vec<Fault> {
    (scenario.numbers().into_iter().filter(|(_, value)| !value.is_finite()))
        .map(|(key, value)| Problem::NotFinite { value }.at(key))
        .collect()
}

/// Values that are wrong by themselves. What the file leaves to the defaults is right if the rest
/// is.
fn values_are_in_range(scenario: &Scenario) -> Vec<Fault> {
    let Scenario { control: stated, link: ranges, .. } = scenario;
    let link = |name| KeyPath::root().key("link").key(name);
    let control = |name| KeyPath::root().key("control").key(name);

    let name = (!is_file_name(&scenario.name)).then(|| {
        Problem::NotAFileName { name: scenario.name.clone() }.at(KeyPath::root().key("name"))
    });
    let not_positive = offences(
        [
            (link("full_range"), Some(ranges.full_range)),
            (link("max_range"), Some(ranges.max_range)),
            (control("clearance"), stated.clearance),
            (control("service_radius"), stated.service_radius),
            (control("step_radius"), stated.step_radius),
            (control("period"), stated.period),
        ],
        |&value| value <= 0.0,
        |value| Problem::NotPositive { value },
    );
    let negative = offences(
        [
            (control("residual_tolerance"), stated.residual_tolerance),
            (control("slope_aversion"), stated.slope_aversion),
        ],
        |&value| value < 0.0,
        |value| Problem::Negative { value },
    );
    let zero = offences(
        [
            (control("max_steps"), stated.max_steps),
            (control("rounds_per_period"), stated.rounds_per_period),
            (control("routing_iterations"), stated.routing_iterations),
        ],
        |&count| count == 0,
        |_| Problem::Zero,
    );
    let rates = (scenario.robot.iter().enumerate())
        .map(|(index, robot)| (robot_key(index).key("rate"), Some(robot.rate)));
    let no_share = offences(
        rates.chain([(control("routing_reserve"), stated.routing_reserve)]),
        |value| !(0.0..=1.0).contains(value),
        |value| Problem::NotAShare { value },
    );
    let no_reliability = offences(
        [(control("tree_reliability"), stated.tree_reliability)],
        |&value| value <= 0.0 || value >= 1.0,
        |value| Problem::NotAReliability { value },
    );
    let nobody = [
        (scenario.access_point.is_empty(), "access_point", Problem::NoAccessPoint),
        (scenario.robot.is_empty(), "robot", Problem::NoRobot),
    ]
    .into_iter()
    .filter(|(missing, ..)| *missing)
    .map(|(_, table, problem)| problem.at(KeyPath::root().key(table)));

    (name.into_iter().chain(not_positive).chain(negative).chain(zero))
        .chain(no_share)
        .chain(no_reliability)
        .chain(nobody)
        .collect()
}

/// A fault for each value that is stated and wrong.
fn offences<V: Copy>(
    stated: impl IntoIterator<Item = (KeyPath, Option<V>)>,
    wrong: impl Fn(&V) -> bool,
    problem: impl Fn(V) -> Problem,
) -> impl Iterator<Item = Fault> {
    (stated.into_iter())
        .filter_map(|(key, value)| Some((key, value?)))
        .filter(move |(_, value)| wrong(value))
        .map(move |(key, value)| problem(value).at(key))
}

fn settings_fit_each_other(scenario: &Scenario) -> Vec<Fault> {
    let settings = Settings::resolve(scenario);
    let LinkRanges { full_range, max_range } = settings.link;
    let control = |name| KeyPath::root().key("control").key(name);

    if full_range >= max_range {
        let key = KeyPath::root().key("link").key("full_range");
        return vec![Problem::RangesReversed { full_range, max_range }.at(key)];
    }
    let Settings { clearance, service_radius, step_radius, tree_reliability, .. } = settings;
    let least = LEAST_SERVICE_RADIUS_IN_CLEARANCES * clearance;
    let service = (service_radius < least * (1.0 - ROUNDING)).then(|| {
        Problem::ServiceRadiusTooSmall { service_radius, clearance, least }
            .at(control("service_radius"))
    });
    let most = (max_range - 2.0 * clearance) / 2.0;
    let step = (step_radius > most * (1.0 + ROUNDING))
        .then(|| Problem::StepTooLong { step_radius, most }.at(control("step_radius")));
    let longest = settings.longest_tree_link();
    let links = (settings.longest_new_link() <= 0.0).then(|| {
        Problem::TreeLinksTooShort { tree_reliability, longest, service_radius }
            .at(control("tree_reliability"))
    });
    [service, step, links].into_iter().flatten().collect()
}

/// Whether `name` can name a file wherever the program runs.
fn is_file_name(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_')
}
