//! The distributed methods against clarabel.

use super::adal::AdalSettings;
use super::central::{CentralError, feasible, solve_central, widest_reserve};
use super::problem::{DirectedLink, ProblemError, RoutingProblem};
use super::rounds::{Method, Rounds};
use crate::Point;
use crate::network::CubicReliability;
use crate::network::rates::Receiver;
use proptest::prelude::*;

const ADAL: Method = Method::Adal(AdalSettings { penalty: 1.0, relaxation: 0.3 });

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

#[test]
fn iterations_on_a_chain_of_thirteen() {
    for rate in [0.03, 0.07] {
        let problem = chain(rate);
        for tolerance in [1e-2, 1e-3] {
            let count = |method| Rounds::new(&problem, method).run(tolerance, 20_000);
            println!(
                "rate {rate} tol {tolerance}: dual {:?} accelerated {:?}",
                count(Method::Dual),
                count(Method::AcceleratedDual)
            );
            for penalty in [0.3, 1.0, 2.0, 4.0, 8.0] {
                for relaxation in [0.33, 0.5, 0.7, 0.9] {
                    print!(
                        " p{penalty} t{relaxation} {:?};",
                        count(Method::Adal(AdalSettings { penalty, relaxation }))
                    );
                }
                println!();
            }
        }
    }
}
