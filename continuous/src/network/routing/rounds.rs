//! The distributed methods run for a whole network in step, one message round per iteration.
//!
//! For tests, benchmarks and experiments: each robot is given exactly what its neighbours would
//! have sent. A network of robot automata runs the same local functions over its medium instead.

use super::TIME_BUDGET;
use super::adal::{AdalLink, AdalRobot, AdalSettings, Workspace};
use super::dual::{DualState, LinkCurvature, dual_step, safe_step};
use super::local::{LinkOffer, local_minimiser};
use super::problem::{DirectedLink, RoutingProblem};
use crate::network::rates::Receiver;

/// Which distributed method to run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The dual iteration (14).
    Dual,
    /// The dual iteration with momentum, [`DualState`].
    AcceleratedDual,
    /// ADAL of Remark 3.1.
    Adal(AdalSettings),
}

/// A network in the middle of a distributed method.
#[derive(Clone, Debug)]
pub struct Rounds<'a> {
    problem: &'a RoutingProblem,
    method: Method,
    /// Link indices by sender.
    links_of: Vec<Vec<usize>>,
    steps: Vec<f64>,
    duals: Vec<DualState>,
    robots: Vec<AdalRobot>,
    shares: Vec<f64>,
    iterations: usize,
}

impl<'a> Rounds<'a> {
    /// At rest: all multipliers and shares are zero.
    pub fn new(problem: &'a RoutingProblem, method: Method) -> Self {
        let robots = problem.robots();
        let mut links_of = vec![Vec::new(); robots];
        for (index, link) in problem.links().iter().enumerate() {
            links_of[link.sender].push(index);
        }
        let curvature = |link: &DirectedLink| LinkCurvature {
            reliability: link.reliability,
            weight: link.weight,
            to_access_point: matches!(link.receiver, Receiver::AccessPoint(_)),
        };
        let steps = links_of
            .iter()
            .map(|links| safe_step(links.iter().map(|&link| curvature(&problem.links()[link]))))
            .collect();
        let mut adal_robots = vec![AdalRobot::default(); robots];
        let residuals = problem.residuals(&vec![0.0; problem.links().len()]);
        for ((robot, residual), links) in adal_robots.iter_mut().zip(residuals).zip(&links_of) {
            let between_robots = links
                .iter()
                .map(|&link| &problem.links()[link])
                .filter(|link| matches!(link.receiver, Receiver::Robot(_)))
                .map(|link| link.reliability);
            robot.measure(residual, problem.reserve(), between_robots);
        }
        Self {
            problem,
            method,
            links_of,
            steps,
            duals: vec![DualState::default(); robots],
            robots: adal_robots,
            shares: vec![0.0; problem.links().len()],
            iterations: 0,
        }
    }

    /// One iteration of every robot.
    pub fn iterate(&mut self) {
        match self.method {
            Method::Dual => self.iterate_dual(|state, step, residual, reserve| {
                DualState::new(dual_step(state.multiplier(), step, residual, reserve))
            }),
            Method::AcceleratedDual => self.iterate_dual(DualState::step),
            Method::Adal(settings) => self.iterate_adal(&settings),
        }
        self.iterations += 1;
    }

    /// Iterates until [`miss`](Self::miss) is at most `tolerance`; the number of iterations, or
    /// `None` if `limit` of them do not suffice.
    pub fn run(&mut self, tolerance: f64, limit: usize) -> Option<usize> {
        while self.iterations == 0 || self.miss() > tolerance {
            if self.iterations == limit {
                return None;
            }
            self.iterate();
        }
        Some(self.iterations)
    }

    /// T of every link, in the order of the problem's links.
    pub fn shares(&self) -> &[f64] {
        &self.shares
    }

    /// λ_i.
    pub fn multiplier(&self, robot: usize) -> f64 {
        match self.method {
            Method::Dual | Method::AcceleratedDual => self.duals[robot].multiplier(),
            Method::Adal(_) => self.robots[robot].multiplier(),
        }
    }

    /// How far the shares are from the optimality conditions: the largest |c_i − η|, where a robot
    /// with λ_i = 0 may have more than the reserve.
    pub fn miss(&self) -> f64 {
        let free = 1e-9;
        let residuals = self.problem.residuals(&self.shares);
        let miss = |(robot, residual): (usize, &f64)| {
            let surplus = residual - self.problem.reserve();
            if surplus > 0.0 && self.multiplier(robot) <= free { 0.0 } else { surplus.abs() }
        };
        residuals.iter().enumerate().map(miss).fold(0.0, f64::max)
    }

    /// The primal iteration with the multipliers as sent, then each robot's dual step.
    fn iterate_dual(&mut self, step: impl Fn(DualState, f64, f64, f64) -> DualState) {
        let mut own_shares = Vec::new();
        for (robot, links) in self.links_of.iter().enumerate() {
            let offer = |&link: &usize| {
                let DirectedLink { receiver, reliability, weight, .. } = self.problem.links()[link];
                let neighbour_multiplier = match receiver {
                    Receiver::Robot(other) => self.duals[other].multiplier(),
                    Receiver::AccessPoint(_) => 0.0,
                };
                LinkOffer { reliability, weight, neighbour_multiplier }
            };
            let offers: Vec<LinkOffer> = links.iter().map(offer).collect();
            let multiplier = self.duals[robot].multiplier();
            local_minimiser(multiplier, &offers, TIME_BUDGET, &mut own_shares);
            for (&link, &share) in links.iter().zip(&own_shares) {
                self.shares[link] = share;
            }
        }
        let residuals = self.problem.residuals(&self.shares);
        for (robot, residual) in residuals.into_iter().enumerate() {
            let state = self.duals[robot];
            self.duals[robot] = step(state, self.steps[robot], residual, self.problem.reserve());
        }
    }

    /// The primal steps with the reports as sent, then each robot's dual step.
    fn iterate_adal(&mut self, settings: &AdalSettings) {
        let reports: Vec<_> = self.robots.iter().map(AdalRobot::report).collect();
        let mut workspace = Workspace::default();
        for (robot, links) in self.robots.iter_mut().zip(&self.links_of) {
            let seen = |&link: &usize| {
                let DirectedLink { receiver, reliability, weight, .. } = self.problem.links()[link];
                let report = match receiver {
                    Receiver::Robot(other) => Some(reports[other]),
                    Receiver::AccessPoint(_) => None,
                };
                AdalLink { reliability, weight, share: self.shares[link], report }
            };
            let mut seen: Vec<AdalLink> = links.iter().map(seen).collect();
            robot.primal_step(&mut seen, settings, &mut workspace);
            for (&link, seen) in links.iter().zip(&seen) {
                self.shares[link] = seen.share;
            }
        }
        let residuals = self.problem.residuals(&self.shares);
        for (robot, residual) in self.robots.iter_mut().zip(residuals) {
            robot.dual_step(residual, self.problem.reserve(), settings);
        }
    }
}
