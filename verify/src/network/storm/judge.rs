//! The judge of storms: what must hold whatever fails, on true positions.

use std::collections::BTreeSet;

use pleach_automaton::network::FaultyNode;
use pleach_automaton::network::record::{End, MissionEvent, Snapshot};
use pleach_automaton::network::scenario::ValidScenario;
use pleach_automaton::node::Observed;
use pleach_discrete::network::{Anchor, Post, PostId, Role};

use super::super::judge::{Clock, TaskClaims, relayed};
use super::super::limits::SLACK;
use super::super::period::{self, Period};
use super::super::property::Property;
use super::super::{Limits, Violation, instant};
use super::Storm;
use crate::network::violation::Instant;

/// Judges a mission, one control period after the other, and keeps the first violation of each
/// property. Nodes that do not run are bodies, and nothing else.
#[derive(Debug)]
pub struct Judge {
    limits: Limits,
    clock: Clock,
    claims: TaskClaims,
    previous: Option<Snapshot>,
    /// The nodes that had begun when this control period did, and have been clear of all others once since.
    begun: Vec<usize>,
    violations: Vec<Violation>,
    unheard: Option<Violation>,
    last_motion: usize,
}

impl Judge {
    /// A judge that has seen nothing yet.
    pub fn new(scenario: &ValidScenario, storm: &Storm) -> Self {
        Judge {
            limits: Limits::of(scenario),
            clock: Clock::of(scenario),
            claims: TaskClaims::new(scenario, storm.faults()),
            previous: None,
            begun: Vec::new(),
            violations: Vec::new(),
            unheard: None,
            last_motion: 0,
        }
    }

    /// The first violation of each property, in the order in which they were found; and the first time
    /// that a robot came too near to one that had not begun yet, which no message could prevent.
    pub fn into_violations(self) -> (Vec<Violation>, Option<Violation>) {
        (self.violations, self.unheard)
    }

    /// The last control period in which a robot moved.
    pub const fn last_motion(&self) -> usize {
        self.last_motion
    }

    /// Robots are about to move; these are the events of the control period that ends.
    pub fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent], nodes: &[FaultyNode]) {
        if let Err(malformed) = instant::record(snapshot, &self.limits) {
            return self.find(Err(malformed));
        }
        let claimed = self.claims.observe(snapshot, events, &self.limits);
        self.find(claimed.map_err(|dispute| dispute.at(Instant::of(snapshot))));
        self.look_at_instant(snapshot, nodes);
        if let Some(before) = self.previous.take() {
            match Period::part(&before, snapshot) {
                Ok(period) => self.look_at_period(&period, nodes.len()),
                Err(gap) => self.find(Err(gap)),
            }
            if before.positions != snapshot.positions {
                self.last_motion = before.step;
            }
        }
        self.count_begun(snapshot, nodes);
        self.previous = Some(snapshot.clone());
    }

    /// The mission has ended.
    pub fn conclude(&mut self, end: &End) {
        let now = self.previous.as_ref().map_or(Instant { step: 0, time: 0.0 }, Instant::of);
        let concluded = self.claims.conclude(end, &self.clock, &self.limits);
        self.find(concluded.map_err(|dispute| dispute.at(now)));
    }

    /// A node that begins next to another one, which did not know of it, counts when it is clear of it.
    fn count_begun(&mut self, seen: &Snapshot, nodes: &[FaultyNode]) {
        let (places, bound) = (&seen.positions, self.limits.separation() - SLACK);
        let is_clear = |node: usize| {
            places.get(node).is_none_or(|place| {
                let others = places.iter().enumerate().filter(|&(other, _)| other != node);
                others.map(|(_, at)| (at - place).norm()).all(|gap| gap >= bound)
            })
        };
        let counts = |&node: &usize| {
            nodes[node].has_begun() && (self.begun.contains(&node) || is_clear(node))
        };
        self.begun = (0..nodes.len()).filter(counts).collect();
    }

    fn find(&mut self, found: Result<(), Violation>) {
        if let Err(violation) = found
            && self.violations.iter().all(|known| known.property != violation.property)
        {
            self.violations.push(violation);
        }
    }

    fn look_at_period(&mut self, period: &Period, nodes: usize) {
        let limits = self.limits.clone();
        let found = period::separation_among(&self.begun, period, &limits).map(drop);
        self.find(found);
        if self.unheard.is_none() && self.begun.len() < nodes {
            let is_unheard = |robot: &usize| !self.begun.contains(robot);
            let found = period::separation(period, &limits).err();
            self.unheard = found.filter(|pair| pair.robots.iter().any(is_unheard));
        }
        self.find(period::clearance(period, &limits).map(drop));
        self.find(period::load(period, &limits).map(drop));
        self.find(period::tree_range(period, &limits));
        self.find(period::service(period, &limits));
    }

    fn look_at_instant(&mut self, seen: &Snapshot, nodes: &[FaultyNode]) {
        let limits = self.limits.clone();
        self.find(instant::shares(seen, &limits));
        // What flows to a node that does not run is lost.
        if self.claims.all_run() {
            self.find(relayed(seen, &limits));
        }
        self.find(rooted(seen, nodes));
        self.find(led(seen, nodes));
        self.find(held_once(seen, nodes));
    }
}

/// [`Property::RootedTree`]: no post is attached to itself, directly or over others.
fn rooted(seen: &Snapshot, nodes: &[FaultyNode]) -> Result<(), Violation> {
    let held = |node: &FaultyNode| {
        node.member().view().robot().and_then(|robot| robot.duty().post().copied())
    };
    let attached = |post: Post| match post.parent {
        Some(Anchor::Post(parent)) => Some((post.id, parent)),
        _ => None,
    };
    let running = nodes.iter().filter(|node| node.is_running());
    let mut links: Vec<(PostId, PostId)> = running.filter_map(held).filter_map(attached).collect();
    // What is attached to a post that is not attached itself lies on no cycle.
    loop {
        let children: BTreeSet<PostId> = links.iter().map(|&(child, _)| child).collect();
        let known = links.len();
        links.retain(|(_, parent)| children.contains(parent));
        match links.first() {
            None => return Ok(()),
            Some(&(post, _)) if links.len() == known => {
                let sentence = format!("the path of post {} up the tree is a cycle", post.0);
                let found = Instant::of(seen);
                return Err(found.violation(Property::RootedTree, &[], (0.0, 1.0), sentence));
            }
            Some(_) => {}
        }
    }
}

/// [`Property::SingleLeader`]: no two robots lead by the same announcement. One that has given the
/// leader's duty in an exchange does not count.
fn led(seen: &Snapshot, nodes: &[FaultyNode]) -> Result<(), Violation> {
    let mut announcements = Vec::new();
    for (robot, node) in nodes.iter().enumerate().take(seen.roles.len()) {
        if let Some(known) = node.member().view().robot().filter(|_| node.is_running()) {
            let leads = seen.roles[robot] == Role::Leader && known.taking().is_none();
            let announcement = (known.epoch(), known.current_task());
            announcements.extend(leads.then_some((announcement, robot)));
        }
    }
    announcements.sort_unstable();
    let Some(pair) = announcements.windows(2).find(|pair| pair[0].0 == pair[1].0) else {
        return Ok(());
    };
    let leaders = [pair[0].1, pair[1].1];
    let sentence = format!("robots {leaders:?} lead");
    Err(Instant::of(seen).violation(Property::SingleLeader, &leaders, (0.0, 1.0), sentence))
}

/// [`Property::Duties`]: no two robots count as holders of one fixed post. Of two that exchange
/// their duties the one that has given its own does not; nor does a robot on Σ whose post has been
/// taken by the robot behind: it stays in its place until it knows.
fn held_once(seen: &Snapshot, nodes: &[FaultyNode]) -> Result<(), Violation> {
    let mut held = Vec::new();
    for (number, node) in nodes.iter().enumerate().filter(|(_, node)| node.is_running()) {
        let Some(robot) = node.member().view().robot() else { continue };
        let Some(post) = robot.duty().post().filter(|post| post.is_fixed()) else { continue };
        let is_relieved = robot.duty().place().is_some();
        if robot.taking().is_none() && !is_relieved {
            held.push((post.id, number));
        }
    }
    held.sort_unstable();
    match held.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        None => Ok(()),
        Some(pair) => {
            let robots = [pair[0].1, pair[1].1];
            let sentence = format!("robots {robots:?} both hold post {}", pair[0].0.0);
            Err(Instant::of(seen).violation(Property::Duties, &robots, (0.0, 1.0), sentence))
        }
    }
}
