//! What robots route, against clarabel, which solves the same problem (6) for all of them at once: feasible in
//! every control period, and optimal once the routes have converged.
//!
//! *Tolerances.* A robot leaves out shares below 10⁻⁶, and regards residuals as met up to 10⁻⁹. What it
//! leaves out goes over other links, whose price is the same at the optimum, so that Σ w T² changes in
//! second order only. Σ w T² is strongly convex with modulus 2 w ≥ 2: where it exceeds its least value
//! by ε, no share is off by more than √ε.

use pleach_automaton::network::Site;
use pleach_automaton::network::record::{Route, Snapshot};
use pleach_automaton::network::scenario::Scenario;
use pleach_continuous::Point;
use pleach_continuous::network::rates::Receiver;
use pleach_continuous::network::routing::central::{CentralRouting, solve_central};
use pleach_continuous::network::routing::problem::{DirectedLink, RoutingProblem};

/// By how much Σ w T² may exceed what clarabel finds.
const EXCESS: f64 = 1e-6;
/// What robots count as rounding.
const ROUNDING: f64 = 1e-9;
/// Links with less reliability carry nothing, unless they belong to the tree.
const LEAST_USEFUL_RELIABILITY: f64 = 0.3;

/// Problem (6) over the links that robots use while they stand where they start, and its solution.
pub struct BestRoutes {
    name: String,
    problem: RoutingProblem,
    best: CentralRouting,
}

impl BestRoutes {
    pub fn of(scenario: &Scenario, site: &Site) -> BestRoutes {
        let robots: Vec<Point> = scenario.robot.iter().map(|robot| robot.position.into()).collect();
        let rates: Vec<f64> = scenario.robot.iter().map(|robot| robot.rate).collect();
        let (aversion, reserve) = (site.settings.slope_aversion, site.settings.routing_reserve);
        let access = &site.access_points;
        let all = RoutingProblem::of_places(&robots, access, &rates, &site.link, aversion, reserve);
        let useful = |link: &&DirectedLink| link.reliability >= LEAST_USEFUL_RELIABILITY;
        let links =
            all.expect("rates are numbers").links().iter().filter(useful).copied().collect();
        let problem = RoutingProblem::new(links, rates, reserve).expect("links are between nodes");
        let best = solve_central(&problem).expect("links carry the rates");
        let name = format!("{}, {:?}", scenario.name, scenario.control.routing_method);
        BestRoutes { name, problem, best }
    }

    /// T of each link of the problem.
    fn shares(&self, snapshot: &Snapshot) -> Vec<f64> {
        let node = |receiver| match receiver {
            Receiver::Robot(robot) => robot,
            Receiver::AccessPoint(number) => self.problem.robots() + number,
        };
        let share_of = |link: &DirectedLink| {
            let ends = (link.sender, node(link.receiver));
            let is_it = |route: &&Route| (route.from, route.to) == ends;
            snapshot.routes.iter().find(is_it).map_or(0.0, |route| route.share)
        };
        let shares: Vec<f64> = self.problem.links().iter().map(share_of).collect();
        let used = shares.iter().filter(|share| **share > 0.0).count();
        assert_eq!(used, snapshot.routes.len(), "robots use links that they should not");
        shares
    }

    /// Whether rates are carried, residuals are told as they are, and nobody sends for more than all of its
    /// time.
    #[track_caller]
    pub fn assert_feasible(&self, snapshot: &Snapshot) {
        let (shares, when) =
            (self.shares(snapshot), format!("{}, k = {}", self.name, snapshot.step));
        let residuals = self.problem.residuals(&shares);
        for (robot, (residual, told)) in residuals.iter().zip(&snapshot.residuals).enumerate() {
            assert!(*residual >= -ROUNDING, "{when}: robot {robot} has a residual of {residual}");
            assert!((residual - told).abs() < ROUNDING, "{when}: robot {robot} tells {told}");
        }
        for (robot, used) in self.problem.used_time(&shares).into_iter().enumerate() {
            assert!(used <= 1.0, "{when}: robot {robot} sends for {used} of its time");
        }
        assert!(shares.iter().all(|share| *share >= 0.0), "{when}");
    }

    #[track_caller]
    pub fn assert_optimal(&self, snapshot: &Snapshot) {
        let (shares, name) = (self.shares(snapshot), &self.name);
        let excess = self.problem.objective(&shares) - self.best.objective;
        assert!(excess.abs() <= EXCESS, "{name}: Σ w T² exceeds its least value by {excess:e}");
        for ((share, expected), link) in
            shares.iter().zip(&self.best.shares).zip(self.problem.links())
        {
            assert!(
                (share - expected).abs() <= EXCESS.sqrt(),
                "{name}: {link:?}: {share}, not {expected}"
            );
        }
    }

    /// Whether multipliers are as clarabel has them, to a hundredth.
    #[track_caller]
    pub fn assert_multipliers(&self, snapshot: &Snapshot) {
        let name = &self.name;
        for (robot, (found, expected)) in
            snapshot.multipliers.iter().zip(&self.best.multipliers).enumerate()
        {
            let tolerance = 1e-2 * expected.abs().max(1.0);
            let difference = (found - expected).abs();
            assert!(
                difference < tolerance,
                "{name}: λ of robot {robot} is {found}, not {expected}"
            );
        }
    }
}
