//! The distributed methods against clarabel.

use super::adal::AdalSettings;
use super::central::{CentralError, feasible, solve_central, widest_reserve};
use super::problem::{DirectedLink, ProblemError, RoutingProblem};
use super::repair::{Share, meet_demand};
use super::rounds::{Method, Rounds};
use crate::Point;
use crate::network::CubicReliability;
use crate::network::rates::Receiver;
use proptest::prelude::*;

fn methods() -> [Method; 3] {
    [Method::Dual, Method::AcceleratedDual, Method::Adal(AdalSettings::default())]
}

/// Thirteen robots in a row in front of an access point; only neighbours hear each other.
fn chain(rate: f64) -> RoutingProblem {
    let link = CubicReliability::new(0.4, 0.5).unwrap();
    let robots: Vec<Point> = (1..=13).map(|n| Point::new(0.4 * f64::from(n), 0.0)).collect();
    RoutingProblem::of_places(&robots, &[Point::origin()], &[rate; 13], &link, 10.0, 0.0).unwrap()
}

/// Up to eight robots around one or two access points, some out of reach.
fn networks() -> impl Strategy<Value = RoutingProblem> {
    let place = || (0.0..1.6f64, 0.0..1.0f64).prop_map(|(x, y)| Point::new(x, y));
    let robots = prop::collection::vec(place(), 1..8);
    let sinks = prop::collection::vec(place(), 1..3);
    (robots, sinks, 0.01..0.12f64, 0.0..0.05f64).prop_map(|(robots, sinks, rate, reserve)| {
        let link = CubicReliability::new(0.4, 0.9).unwrap();
        let rates = vec![rate; robots.len()];
        let problem = RoutingProblem::of_places(&robots, &sinks, &rates, &link, 1.0, reserve);
        problem.unwrap()
    })
}

/// The counts that the documentation of the methods names.
#[test]
fn accelerated_methods_need_far_fewer_iterations_on_a_chain_of_thirteen() {
    for (rate, tolerance) in [(0.03, 1e-2), (0.03, 1e-3), (0.07, 1e-2), (0.07, 1e-3)] {
        let problem = chain(rate);
        let count = |method| Rounds::new(&problem, method).run(tolerance, 2000).unwrap();
        let [plain, accelerated, adal] = methods().map(count);
        println!("rate {rate}, {tolerance}: {plain}, accelerated {accelerated}, ADAL {adal}");
        assert!(7 * accelerated < plain && 5 * adal < plain);
    }
}

/// Where the optimality conditions are missed by ε, the objective is off by at most ε·Σλ, and since
/// Σ w T² with w ≥ 1 is strongly convex, no share is off by more than the root of that.
fn agrees_with_clarabel(problem: &RoutingProblem, method: Method) -> Result<(), TestCaseError> {
    const MISS: f64 = 1e-4;
    let oracle = match solve_central(problem) {
        Ok(oracle) => oracle,
        Err(CentralError::NoRouting { .. }) => return Ok(()),
        Err(error) => return Err(TestCaseError::fail(error.to_string())),
    };
    // Close to the limit of what can be carried multipliers are large and every method is slow.
    prop_assume!(oracle.multipliers.iter().all(|multiplier| *multiplier < 20.0));
    let mut rounds = Rounds::new(problem, method);
    // ADAL's shares are on the way to a minimiser, not one: it meets the residuals a little earlier.
    let tolerance = if matches!(method, Method::Adal(_)) { 0.1 * MISS } else { MISS };
    let ended = rounds.run(tolerance, 200_000);
    prop_assert!(ended.is_some(), "{method:?} still misses by {}", rounds.miss());

    let allowed = 2.0 * MISS * (1.0 + oracle.multipliers.iter().sum::<f64>());
    let objective = problem.objective(rounds.shares());
    let excess = objective - oracle.objective;
    prop_assert!(
        excess.abs() < allowed,
        "{method:?}: objective off by {excess}, more than {allowed}"
    );
    for (share, expected) in rounds.shares().iter().zip(&oracle.shares) {
        prop_assert!((share - expected).abs() < allowed.sqrt(), "{share}, not {expected}");
    }
    for used in problem.used_time(rounds.shares()) {
        prop_assert!(used <= 1.0);
    }
    Ok(())
}

/// A tree of shortest hop counts over the most reliable links: the tree link of every robot that
/// reaches an access point, with its depth.
fn tree(problem: &RoutingProblem) -> Vec<Option<(usize, usize)>> {
    let mut tree: Vec<Option<(usize, usize)>> = vec![None; problem.robots()];
    for depth in 1..=problem.robots() {
        let known = tree.clone();
        for (index, link) in problem.links().iter().enumerate() {
            let upwards = match link.receiver {
                Receiver::AccessPoint(_) => depth == 1,
                Receiver::Robot(robot) => known[robot].is_some_and(|(_, d)| d + 1 == depth),
            };
            let better = match tree[link.sender] {
                None => true,
                Some((other, d)) => {
                    d == depth && problem.links()[other].reliability < link.reliability
                }
            };
            if upwards && better {
                tree[link.sender] = Some((index, depth));
            }
        }
    }
    tree
}

/// The sweep of [`super::repair`], deepest robots first; the largest shortfall.
fn sweep(problem: &RoutingProblem, shares: &mut [f64]) -> f64 {
    let tree = tree(problem);
    let mut order: Vec<usize> = (0..problem.robots()).filter(|&r| tree[r].is_some()).collect();
    order.sort_by_key(|&robot| tree[robot].map(|(_, depth)| std::cmp::Reverse(depth)));
    let mut largest = 0.0f64;
    for robot in order {
        let own: Vec<usize> =
            (0..shares.len()).filter(|&link| problem.links()[link].sender == robot).collect();
        let share_of = |&link: &usize| Share {
            reliability: problem.links()[link].reliability,
            share: shares[link],
        };
        let mut links: Vec<Share> = own.iter().map(share_of).collect();
        let outflow: f64 = links.iter().map(|link| link.share * link.reliability).sum();
        let demand = outflow - problem.residuals(shares)[robot] + problem.reserve();
        let (tree_link, _) = tree[robot].unwrap();
        let position = own.iter().position(|&link| link == tree_link).unwrap();
        largest = largest.max(meet_demand(demand, &mut links, position));
        for (&link, repaired) in own.iter().zip(&links) {
            shares[link] = repaired.share;
        }
    }
    largest
}

proptest! {
    #![proptest_config(cases::usually(200))]

    #[test]
    fn every_method_finds_the_routes_that_clarabel_finds(problem in networks()) {
        for method in methods() {
            agrees_with_clarabel(&problem, method)?;
        }
    }

    /// Whatever the iteration has reached, the sweep meets every reserve or reports a shortfall.
    #[test]
    fn after_the_sweep_every_reserve_is_met(
        problem in networks(), method in prop::sample::select(methods().to_vec()), iterations in 1usize..30,
    ) {
        let mut rounds = Rounds::new(&problem, method);
        for _ in 0..iterations {
            rounds.iterate();
        }
        let mut shares = rounds.shares().to_vec();
        let shortfall = sweep(&problem, &mut shares);
        let tree = tree(&problem);
        for (robot, residual) in problem.residuals(&shares).into_iter().enumerate() {
            let met = residual >= problem.reserve() - 1e-11;
            prop_assert!(met || shortfall > 0.0 || tree[robot].is_none(), "robot {robot}: {residual}");
        }
        for used in problem.used_time(&shares) {
            prop_assert!(used <= 1.0);
        }
    }

    #[test]
    fn a_problem_is_infeasible_exactly_if_its_widest_reserve_is_too_small(problem in networks()) {
        let widest = widest_reserve(&problem).unwrap();
        prop_assume!((widest - problem.reserve()).abs() > 1e-6);
        let carried = widest > problem.reserve();
        prop_assert_eq!(feasible(&problem, 1e-7).unwrap(), carried);
        match solve_central(&problem) {
            Ok(_) => prop_assert!(carried, "solved, but the widest reserve is {widest}"),
            Err(CentralError::NoRouting { .. }) => prop_assert!(!carried, "{widest} is possible"),
            // The solver admits that it cannot tell: no contradiction.
            Err(CentralError::Undecided { .. }) => {}
        }
    }
}

/// N robots in a chain with perfect links: the one at the access point carries (r + η)·N ≤ 1.
#[test]
fn the_widest_reserve_of_a_chain_is_known() {
    let widest = widest_reserve(&chain(0.075)).unwrap();
    assert!((widest - (1.0 / 13.0 - 0.075)).abs() < 1e-7);
    assert!(solve_central(&chain(0.075)).is_ok());
    assert_eq!(solve_central(&chain(0.08)), Err(CentralError::NoRouting { reserve: 0.0 }));
}

#[test]
fn numbers_that_make_no_problem_are_refused() {
    let link =
        |receiver, reliability| DirectedLink { sender: 0, receiver, reliability, weight: 1.0 };
    let sink = Receiver::AccessPoint(0);
    let ends = RoutingProblem::new(vec![link(Receiver::Robot(0), 1.0)], vec![0.1], 0.0);
    assert!(matches!(ends, Err(ProblemError::Ends { .. })));
    let reliability = RoutingProblem::new(vec![link(sink, 0.0)], vec![0.1], 0.0);
    assert!(matches!(reliability, Err(ProblemError::Link { .. })));
    let rate = RoutingProblem::new(vec![link(sink, 1.0)], vec![f64::NAN], 0.0);
    assert!(matches!(rate, Err(ProblemError::Rate { .. })));
    let reserve = RoutingProblem::new(vec![link(sink, 1.0)], vec![0.1], f64::INFINITY);
    assert!(matches!(reserve, Err(ProblemError::Reserve { .. })));
}

/// Two robots that send to an access point, one of them to the other as well.
fn pair(reserve: f64) -> RoutingProblem {
    let link = |sender, receiver, reliability, weight| DirectedLink {
        sender,
        receiver,
        reliability,
        weight,
    };
    let links = vec![
        link(0, Receiver::Robot(1), 0.5, 2.0),
        link(0, Receiver::AccessPoint(0), 0.25, 4.0),
        link(1, Receiver::AccessPoint(0), 1.0, 1.0),
    ];
    RoutingProblem::new(links, vec![0.125, 0.25], reserve).unwrap()
}

#[test]
fn cost_residuals_and_time_are_sums_over_links() {
    let (problem, shares) = (pair(0.0), [0.5, 0.25, 0.75]);
    assert_eq!(problem.objective(&shares), 2.0 * 0.25 + 4.0 * 0.0625 + 0.5625);
    assert_eq!(problem.residuals(&shares), [0.25 + 0.0625 - 0.125, 0.75 - 0.25 - 0.25]);
    assert_eq!(problem.used_time(&shares), [0.75, 0.75]);
}

/// If robot 0 sends to robot 1 for a share T of its time, and to the access point for the rest, then
/// c₀ = 1/2 T + 1/4 (1 − T) − 1/8 and c₁ = 1 − 1/2 T − 1/4: both are 1/3 with T = 5/6.
#[test]
fn the_widest_reserve_is_where_the_two_have_as_much() {
    let widest = widest_reserve(&pair(0.0)).unwrap();
    assert!(feasible(&pair(widest), 1e-6).unwrap());
    assert!(feasible(&pair(widest + 5e-7), 1e-6).unwrap());
    assert!(!feasible(&pair(widest + 5e-6), 1e-6).unwrap());
    assert!((widest - 1.0 / 3.0).abs() < 1e-6, "{widest}");
}
