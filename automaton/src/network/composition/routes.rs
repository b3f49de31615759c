//! The routes of a control period: the rounds of messages in which the robots compute them.

use pleach_discrete::network::NodeId;

use super::super::medium::Medium;
use super::super::record::MissionEvent;
use super::super::robot::Robot;
use super::super::scenario::RoutingMethod;
use super::Network;

/// Sweeps until the routes are feasible: with each, overloaded robots are relieved of what does
/// not come over the tree, and a tree that can carry the rates needs few.
const MAX_SWEEPS: usize = 6;

impl<M: Medium> Network<M> {
    /// Primal and dual iterations, then the sweep up the tree.
    pub(super) fn route(&mut self) {
        self.robots.iter_mut().for_each(Robot::survey_links);
        if self.site.settings.routing_method == RoutingMethod::Adal {
            self.exchange_flows();
            self.robots.iter_mut().for_each(Robot::begin_routing);
        }
        for _ in 0..self.site.settings.routing_iterations {
            self.exchange_routing_reports();
            self.robots.iter_mut().for_each(Robot::primal_step);
            self.exchange_flows();
            self.robots.iter_mut().for_each(Robot::dual_step);
        }
        for sweep in 0..MAX_SWEEPS {
            self.sweep(sweep == 0);
            self.exchange_flows();
            self.robots.iter_mut().for_each(Robot::settle_residual);
            if !self.relieve_overloaded() {
                break;
            }
        }
        for (id, robot) in self.robots.iter().enumerate() {
            if robot.is_infeasible() {
                self.events.push(MissionEvent::RouteInfeasible { robot: id });
            }
        }
    }

    /// Robots that cannot pass on what they are sent say so. Whoever does not hang on them sends
    /// them nothing more; whoever does lets go of its reserve and passes the word on. Says whether
    /// there is news: then the sweep is repeated.
    fn relieve_overloaded(&mut self) -> bool {
        let mut short: Vec<NodeId> =
            (0..self.robots.len()).filter(|&robot| self.robots[robot].admit_shortage()).collect();
        let has_news = !short.is_empty();
        while let Some(robot) = short.pop() {
            for receiver in self.audience_of(robot) {
                if self.robots[receiver].hear_shortage(robot) {
                    short.push(receiver);
                }
            }
        }
        if has_news {
            self.exchange_flows();
        }
        has_news
    }

    fn exchange_routing_reports(&mut self) {
        let reports: Vec<_> = self.robots.iter().map(Robot::routing_report).collect();
        self.broadcast(&reports, |robot, from, &report| robot.hear_routing_report(from, report));
    }

    fn exchange_flows(&mut self) {
        let reports: Vec<_> = self.robots.iter().map(Robot::flow_report).collect();
        for robot in &mut self.robots {
            robot.clear_inflow();
        }
        self.broadcast(&reports, Robot::hear_flows);
    }

    /// Every robot sends a message to all robots that hear it.
    fn broadcast<T>(&mut self, messages: &[T], mut hear: impl FnMut(&mut Robot, NodeId, &T)) {
        for (sender, message) in messages.iter().enumerate() {
            for at in 0..self.medium.audience(sender).len() {
                let receiver = self.medium.audience(sender)[at];
                if receiver < self.robots.len() && self.medium.delivers(sender, receiver) {
                    hear(&mut self.robots[receiver], sender, message);
                }
            }
        }
    }

    /// The repair of (13)–(14): every robot tells its parent that it hangs on it; then, deepest
    /// first, each sends what is missing to its parent once it has heard from all its children.
    /// A further sweep changes nothing where nothing is missing.
    fn sweep(&mut self, is_first: bool) {
        let mut awaited = vec![0_usize; self.robots.len()];
        for child in 0..self.robots.len() {
            let parent = self.robots[child].tree_parent().filter(|&node| node < awaited.len());
            if let Some(parent) = parent
                && self.medium.delivers(child, parent)
            {
                awaited[parent] += 1;
            }
        }
        let mut ready: Vec<NodeId> =
            (0..self.robots.len()).filter(|&robot| awaited[robot] == 0).collect();
        while let Some(robot) = ready.pop() {
            let Some(parent) = self.robots[robot].tree_parent() else { continue };
            let more = self.robots[robot].meet_demand(is_first);
            if parent < self.robots.len() && self.medium.delivers(robot, parent) {
                self.robots[parent].expect_more(more);
                awaited[parent] = awaited[parent].saturating_sub(1);
                if awaited[parent] == 0 {
                    ready.push(parent);
                }
            }
        }
    }
}
