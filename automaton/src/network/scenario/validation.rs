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
            [numbers_are_finite, settings_are_in_range, settings_fit_each_other, placement::faults];
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

fn settings_are_in_range(scenario: &Scenario) -> Vec<Fault> {
    let settings = Settings::resolve(scenario);
    let link = |name| KeyPath::root().key("link").key(name);
    let control = |name| KeyPath::root().key("control").key(name);

    let name = (!is_file_name(&scenario.name)).then(|| {
        Problem::NotAFileName { name: scenario.name.clone() }.at(KeyPath::root().key("name"))
    });
    let positive = [
        (link("full_range"), settings.link.full_range),
        (link("max_range"), settings.link.max_range),
        (control("clearance"), settings.clearance),
        (control("service_radius"), settings.service_radius),
        (control("period"), settings.period),
    ]
    .into_iter()
    .filter(|&(_, value)| value <= 0.0)
    .map(|(key, value)| Problem::NotPositive { value }.at(key));
    let not_negative = [
        (control("residual_tolerance"), settings.residual_tolerance),
        (control("slope_aversion"), settings.slope_aversion),
    ]
    .into_iter()
    .filter(|&(_, value)| value < 0.0)
    .map(|(key, value)| Problem::Negative { value }.at(key));
    let counts = [
        (control("max_steps"), settings.max_steps),
        (control("rounds_per_period"), settings.rounds_per_period),
        (control("routing_iterations"), settings.routing_iterations),
    ]
    .into_iter()
    .filter(|&(_, count)| count == 0)
    .map(|(key, _)| Problem::Zero.at(key));
    let rates = (scenario.robot.iter().enumerate())
        .map(|(index, robot)| (robot_key(index).key("rate"), robot.rate));
    let shares = rates
        .chain([(control("routing_reserve"), settings.routing_reserve)])
        .filter(|&(_, value)| !(0.0..=1.0).contains(&value))
        .map(|(key, value)| Problem::NotAShare { value }.at(key));
    let reliability = Some(settings.tree_reliability)
        .filter(|&value| value <= 0.0 || value >= 1.0)
        .map(|value| Problem::NotAReliability { value }.at(control("tree_reliability")));
    let nobody = [
        (scenario.access_point.is_empty(), "access_point", Problem::NoAccessPoint),
        (scenario.robot.is_empty(), "robot", Problem::NoRobot),
    ]
    .into_iter()
    .filter(|(missing, ..)| *missing)
    .map(|(_, table, problem)| problem.at(KeyPath::root().key(table)));

    (name.into_iter().chain(positive).chain(not_negative).chain(counts))
        .chain(shares)
        .chain(reliability)
        .chain(nobody)
        .collect()
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
    let step = if step_radius <= 0.0 {
        Some(Problem::NotPositive { value: step_radius }.at(control("step_radius")))
    } else {
        (step_radius > most * (1.0 + ROUNDING))
            .then(|| Problem::StepTooLong { step_radius, most }.at(control("step_radius")))
    };
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
