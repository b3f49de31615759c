//! What the events of a mission amount to, by Algorithms 1, 3 and 4: identities only.
//!
//! The ledger is kept from the events alone. An event that cannot follow those before it is
//! disputed; whether it is true of the world is for [`claims`](super::claims) to say.

use std::collections::{BTreeMap, BTreeSet};

use pleach_automaton::network::record::MissionEvent;
use pleach_discrete::network::Role;

use super::walk::Walk;
use super::{Dispute, task_or_none};
use crate::network::property::Property;
use crate::network::team;

/// Roles, teams and tasks after the events so far.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ledger {
    /// The role of every robot.
    pub roles: Vec<Role>,
    /// The tasks that have been announced.
    pub announced: BTreeSet<usize>,
    /// The tasks serviced, each with the robot that holds it.
    pub serviced: BTreeMap<usize, usize>,
    /// The tasks that are over: they have ended, or been taken back.
    pub closed: BTreeSet<usize>,
    /// The tasks that were serviced when that was told, each with the robot that held it: it may not know yet.
    pub discharging: BTreeMap<usize, usize>,
    /// What robots go by that have not heard yet that the task is taken back that they pursue.
    pub outdated: Option<Box<Ledger>>,
    /// The leader, from its election until its task is serviced.
    pub leader: Option<usize>,
    /// L_b: whether the leader has past duties from which it is not released yet.
    pub awaits_release: bool,
    /// The primary team 𝒫, from p₁ to the leader.
    pub primary_team: Vec<usize>,
    /// The primary team whose task has just been serviced: what its members have agreed on before they
    /// know, they still do.
    pub dismissed: Vec<usize>,
    /// Whether a recruit is called for.
    pub calls: bool,
    /// Whether that is so although the primary team does not stand still.
    pub calls_ahead: bool,
    /// Whether a team has found no robot that can be recruited, so that links may be longer.
    pub stretched: bool,
    /// The exchanges of duties since a recruit was called for: a path that is announced may name robots by the places
    /// that they had before.
    pub exchanged: Vec<[usize; 2]>,
    /// The way of a secondary team along Σ.
    pub walk: Option<Walk>,
    /// Subgroups whose arrival follows from later events and is still to be told, with their robots
    /// as events name them.
    pub untold: Vec<(usize, Vec<usize>)>,
}

/// What the mission is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// No task is pursued.
    Idle,
    /// A leader is being elected.
    Electing,
    /// The primary team advances.
    Advancing,
    /// A recruit is called for, and break points are agreed upon.
    Calling,
    /// The subgroups of Σ move, one after the other.
    Shifting,
}

impl Stage {
    /// What the mission is at, as a clause.
    pub(super) const fn clause(self) -> &'static str {
        match self {
            Stage::Idle => "no task is pursued",
            Stage::Electing => "a leader is being elected",
            Stage::Advancing => "the primary team advances",
            Stage::Calling => "a recruit is called for",
            Stage::Shifting => "subgroups move along the path",
        }
    }
}

impl Ledger {
    /// The ledger of a mission that begins: every robot is redundant.
    pub(super) fn new(robots: usize) -> Self {
        Ledger {
            roles: vec![Role::Redundant; robots],
            announced: BTreeSet::new(),
            serviced: BTreeMap::new(),
            closed: BTreeSet::new(),
            discharging: BTreeMap::new(),
            outdated: None,
            leader: None,
            awaits_release: false,
            primary_team: Vec::new(),
            dismissed: Vec::new(),
            calls: false,
            calls_ahead: false,
            stretched: false,
            exchanged: Vec::new(),
            walk: None,
            untold: Vec::new(),
        }
    }

    /// The task that is pursued: the one announced that is neither serviced nor over.
    pub(super) fn task(&self) -> Option<usize> {
        let is_done = |task: &usize| self.serviced.contains_key(task) || self.closed.contains(task);
        self.announced.iter().copied().find(|task| !is_done(task))
    }

    /// What the mission is at.
    pub(super) fn stage(&self) -> Stage {
        match (self.task(), self.leader) {
            (None, _) => Stage::Idle,
            (Some(_), None) => Stage::Electing,
            _ if self.walk.is_some() => Stage::Shifting,
            _ if self.calls || self.awaits_release => Stage::Calling,
            _ => Stage::Advancing,
        }
    }

    /// The active team 𝒜 (Algorithm 3).
    pub(super) fn active_team(&self) -> &[usize] {
        match (self.stage(), &self.walk) {
            (Stage::Advancing, _) => &self.primary_team,
            (Stage::Shifting, Some(walk)) => walk.next_team(),
            _ => &[],
        }
    }

    /// Whether the robot is of the primary team, or was until the task was serviced and may not know yet.
    pub(super) fn is_or_was_primary(&self, robot: usize) -> bool {
        self.primary_team.contains(&robot) || self.dismissed.contains(&robot)
    }

    /// Whether the robot is of a primary team that calls for a recruit, or whose recruit comes: with the eager strategy
    /// it goes on meanwhile, and what it has begun before the call it ends.
    pub(super) fn is_of_calling_team(&self, robot: usize) -> bool {
        matches!(self.stage(), Stage::Calling | Stage::Shifting)
            && self.primary_team.contains(&robot)
    }

    /// Whether a recruit has been called for, and no path for it has been told.
    pub(super) fn awaits_path(&self) -> bool {
        self.walk.is_none() && self.stage() == Stage::Calling
    }

    /// Enters an event.
    ///
    /// # Errors
    ///
    /// Why it cannot follow those before it.
    pub(super) fn enter(&mut self, event: &MissionEvent) -> Result<(), Dispute> {
        let entered = self.enter_now(event);
        if let (Err(_), Some(mut outdated)) = (&entered, self.outdated.clone())
            && !is_told_by_access_point(event)
            && outdated.enter(event).is_ok()
        {
            self.take_over_holders(&outdated);
            self.outdated = Some(outdated);
            return Ok(());
        }
        entered
    }

    /// Robots that have not heard yet that their task is taken back have gone on: who holds which task is as
    /// they have it.
    fn take_over_holders(&mut self, outdated: &Ledger) {
        let known = outdated.serviced.iter().map(|(&task, &robot)| (task, robot));
        let (mut closed, open): (BTreeMap<_, _>, _) =
            known.partition(|(task, _)| self.closed.contains(task));
        self.serviced = open;
        self.discharging.append(&mut closed);
    }

    /// Everybody has heard by now that the task is taken back.
    pub(super) fn forget_outdated(&mut self) {
        self.outdated = None;
    }

    fn enter_now(&mut self, event: &MissionEvent) -> Result<(), Dispute> {
        match event {
            MissionEvent::TaskAnnounced { task } => self.announce(*task),
            MissionEvent::LeaderElected { task, robot, conflict } => {
                self.elect(*task, *robot, *conflict)
            }
            MissionEvent::ElectionRepeated { task } => self.repeat_election(*task),
            MissionEvent::TaskReannounced { task, gone, joined } => {
                self.reannounce(*task, gone, joined)
            }
            MissionEvent::Stationary { robot, .. } => self.call(*robot, "is stationary"),
            MissionEvent::RecruitCalled { robot } => {
                self.call(*robot, "is too short")?;
                self.calls_ahead = true;
                Ok(())
            }
            MissionEvent::CalledInVain { robot } => self.go_on_alone(*robot),
            MissionEvent::LinksStretched { robot } => self.stretch(*robot),
            MissionEvent::RecruitElected { robot, path, break_points } => {
                self.recruit(*robot, path, break_points)
            }
            MissionEvent::SubgroupStarted { subgroup, robots } => self.start(*subgroup, robots),
            MissionEvent::SubgroupArrived { subgroup, robots } => self.arrive(*subgroup, robots),
            MissionEvent::JoinedPrimary { robot, .. } => self.join(*robot),
            MissionEvent::Released { robot } => self.release(*robot),
            MissionEvent::RoleChanged { robot, from, to } => self.change_role(*robot, *from, *to),
            MissionEvent::TaskServiced { task, robot } => self.service(*task, *robot),
            MissionEvent::TaskEnded { task } => self.end(*task),
            MissionEvent::TaskWithdrawn { task } => self.withdraw(*task),
            MissionEvent::TaskGivenUp { task, .. } => self.give_up(*task),
            MissionEvent::DutiesExchanged { mover, parked } => self.exchange(*mover, *parked),
            MissionEvent::Reattached { .. } | MissionEvent::RouteInfeasible { .. } => Ok(()),
            other => dispute(&[], format!("no event is called {other:?}")),
        }
    }

    /// Tasks are announced one after the other, each when the one before is serviced or over.
    fn announce(&mut self, task: usize) -> Result<(), Dispute> {
        if let Some(pursued) = self.task() {
            let sentence =
                format!("task {task} is announced while task {pursued} is being pursued");
            return dispute(&[], sentence);
        }
        if self.closed.contains(&task) || !self.announced.insert(task) {
            let sentence = format!("task {task} is announced, and it has been before or is over");
            return dispute(&[], sentence);
        }
        Ok(())
    }

    /// No robot can service the task that is pursued: the team is dissolved.
    fn give_up(&mut self, task: usize) -> Result<(), Dispute> {
        self.expect_pursued(task, "robots give up")?;
        self.withdraw(task)
    }

    /// A task has been serviced for as long as it was to be.
    fn end(&mut self, task: usize) -> Result<(), Dispute> {
        let Some(robot) = self.serviced.remove(&task) else {
            return dispute(&[], format!("task {task} ends, and no robot services it"));
        };
        self.closed.insert(task);
        self.discharging.insert(task, robot);
        Ok(())
    }

    /// The user takes a task back: one that is serviced, one that is still to be announced, or the one that is
    /// pursued. Then the team is dissolved.
    fn withdraw(&mut self, task: usize) -> Result<(), Dispute> {
        if self.closed.contains(&task) {
            return dispute(&[], format!("task {task} is taken back, and it is over"));
        }
        if self.serviced.contains_key(&task) {
            return self.end(task);
        }
        let outdated = (self.task() == Some(task)).then(|| Box::new(self.clone()));
        self.closed.insert(task);
        if let Some(outdated) = outdated {
            let dismissed = std::mem::take(&mut self.primary_team);
            self.begin_anew();
            (self.dismissed, self.outdated) = (dismissed, Some(outdated));
        }
        Ok(())
    }

    /// No task is pursued any more, or one from the beginning.
    fn begin_anew(&mut self) {
        let Ledger { roles, announced, serviced, closed, discharging, stretched, .. } =
            std::mem::replace(self, Ledger::new(0));
        *self =
            Ledger { roles, announced, serviced, closed, discharging, stretched, ..Ledger::new(0) };
    }

    /// Algorithm 1: one leader for the task that is pursued.
    fn elect(&mut self, task: usize, robot: usize, conflict: bool) -> Result<(), Dispute> {
        self.expect_pursued(task, "a leader is elected for")?;
        if let Some(leader) = self.leader {
            let sentence = format!("robot {robot} is elected while robot {leader} leads");
            return dispute(&[robot, leader], sentence);
        }
        (self.leader, self.awaits_release) = (Some(robot), conflict);
        self.primary_team = vec![robot];
        self.dismissed.clear();
        self.exchanged.clear();
        Ok(())
    }

    /// Robots are gone, or others can be asked: the task that is pursued begins anew, or one that was serviced is
    /// pursued again.
    fn reannounce(&mut self, task: usize, gone: &[usize], joined: &[usize]) -> Result<(), Dispute> {
        let is_pursued = self.task().is_none_or(|pursued| pursued == task);
        let is_over = !self.announced.contains(&task) || self.closed.contains(&task);
        // Robots of a task that is over may be free now.
        let has_cause = !gone.is_empty() || !joined.is_empty() || !self.closed.is_empty();
        if is_over || !is_pursued || !has_cause || gone.iter().any(|robot| joined.contains(robot)) {
            let sentence = format!(
                "task {task} is announced again without robots {gone:?} and to robots {joined:?}, while {} is \
                 pursued and {} tasks have been announced",
                task_or_none(self.task()),
                self.announced.len()
            );
            return dispute(gone, sentence);
        }
        self.serviced.remove(&task);
        self.begin_anew();
        Ok(())
    }

    /// The robot that calls finds that no robot in its tree can come: others may lead.
    fn repeat_election(&mut self, task: usize) -> Result<(), Dispute> {
        self.expect_pursued(task, "the election is repeated for")?;
        if self.stage() != Stage::Calling || self.calls_ahead {
            let sentence = format!(
                "the election for task {task} is repeated, and no robot has called for a recruit"
            );
            return dispute(&[], sentence);
        }
        (self.leader, self.awaits_release, self.calls) = (None, false, false);
        self.primary_team.clear();
        Ok(())
    }

    /// Sec. V-B: p₁ calls for a recruit when the primary team is at a stationary point, or before.
    fn call(&mut self, robot: usize, why: &str) -> Result<(), Dispute> {
        let first = self.primary_team.first();
        if first != Some(&robot) || self.stage() != Stage::Advancing {
            let sentence = format!(
                "robot {robot} reports that the primary team {:?} {why}: it is not the \
                 first of a team that advances",
                self.primary_team
            );
            return dispute(&[robot], sentence);
        }
        (self.calls, self.calls_ahead) = (true, false);
        self.exchanged.clear();
        Ok(())
    }

    /// No recruit can come: the primary team, which does not stand still, goes on as it is.
    fn go_on_alone(&mut self, robot: usize) -> Result<(), Dispute> {
        let may = self.stage() == Stage::Calling && self.calls_ahead;
        if !may || self.primary_team.first() != Some(&robot) {
            let sentence = format!(
                "robot {robot} reports that it has called in vain: it is not the first of a team {:?} that has \
                 called before it stood still",
                self.primary_team
            );
            return dispute(&[robot], sentence);
        }
        (self.calls, self.calls_ahead) = (false, false);
        Ok(())
    }

    /// No recruit can come: the primary team goes on with longer links. That happens once in a mission.
    fn stretch(&mut self, robot: usize) -> Result<(), Dispute> {
        let may = self.stage() == Stage::Calling
            && !self.awaits_release
            && !self.calls_ahead
            && !self.stretched;
        if !may || self.primary_team.first() != Some(&robot) {
            let sentence = format!(
                "robot {robot} reports that the primary team {:?} stretches its links: it is not the first of \
                 a team that calls and has not done so yet",
                self.primary_team
            );
            return dispute(&[robot], sentence);
        }
        (self.calls, self.stretched) = (false, true);
        Ok(())
    }

    /// Remark 5.4: the path Σ leads from the recruit to p₁, or to the leader that is released.
    fn recruit(
        &mut self,
        robot: usize,
        path: &[usize],
        break_points: &[usize],
    ) -> Result<(), Dispute> {
        if let Some((subgroup, robots)) = self.untold.first() {
            let sentence = format!(
                "robot {robot} is recruited, and the arrival of subgroup {subgroup}, {robots:?}, \
                 was never reported"
            );
            return Err(Dispute::of(Property::Subgroups, robots, sentence));
        }
        if self.stage() != Stage::Calling {
            let sentence = format!("robot {robot} is recruited, and none is called for");
            return dispute(&[robot], sentence);
        }
        let current = (0..=self.exchanged.len())
            .map(|known| self.after_exchanges(path, known))
            .find(|path| path.last() == self.primary_team.first());
        let Some(current) = current.filter(|_| path.first() == Some(&robot)) else {
            let sentence = format!(
                "the path {path:?} does not lead from recruit {robot} to the primary team {:?}",
                self.primary_team
            );
            return dispute(path, sentence);
        };
        let places: Option<Vec<usize>> =
            break_points.iter().map(|point| path.iter().position(|it| it == point)).collect();
        let last = path.len().checked_sub(if self.awaits_release { 1 } else { 2 });
        let Some(places) = places.filter(|places| {
            team::has_no_repetition(path)
                && places.first() == Some(&0)
                && places.last().copied() == last
                && places.is_sorted_by(|one, next| one < next)
        }) else {
            let sentence =
                format!("the break points {break_points:?} do not divide the path {path:?}");
            return Err(Dispute::of(Property::Subgroups, path, sentence));
        };
        self.walk = Some(Walk {
            announced: path.to_vec(),
            path: current,
            break_points: places,
            arrived: 0,
            is_under_way: false,
        });
        Ok(())
    }

    /// The path with the robots that are in its places now, if the first `known` exchanges since the call had been made
    /// when it was found.
    fn after_exchanges(&self, path: &[usize], known: usize) -> Vec<usize> {
        let mut path = path.to_vec();
        for pair in &self.exchanged[known..] {
            path.iter_mut().for_each(|robot| swap(robot, *pair));
        }
        path
    }

    /// Algorithm 3: the subgroups move one after the other.
    fn start(&mut self, subgroup: usize, robots: &[usize]) -> Result<(), Dispute> {
        if self.walk.as_ref().is_some_and(|walk| walk.arrived + 1 == subgroup) {
            self.imply_arrival();
        }
        let walk = self.expect_subgroup(subgroup, robots, "starts", false)?;
        walk.is_under_way = true;
        Ok(())
    }

    /// Algorithm 4: each member of the subgroup takes the duties of the robot ahead.
    fn arrive(&mut self, subgroup: usize, robots: &[usize]) -> Result<(), Dispute> {
        if let Some(at) = self.untold.iter().position(|it| it.0 == subgroup && it.1 == robots) {
            self.untold.remove(at);
            return Ok(());
        }
        self.expect_subgroup(subgroup, robots, "arrives", true)?;
        self.take_places();
        Ok(())
    }

    fn take_places(&mut self) {
        let Some(walk) = &mut self.walk else { return };
        let places = walk.subgroup(walk.arrived).unwrap_or_default();
        let takeovers: BTreeMap<usize, usize> =
            places.map(|place| (walk.path[place + 1], walk.path[place])).collect();
        (walk.is_under_way, walk.arrived) = (false, walk.arrived + 1);
        for holder in self.serviced.values_mut().chain(self.discharging.values_mut()) {
            *holder = takeovers.get(holder).copied().unwrap_or(*holder);
        }
    }

    /// A robot may act on an arrival before the robot that tells of it knows: the subgroup under way
    /// has arrived, and that is still to be told.
    fn imply_arrival(&mut self) {
        if let Some(walk) = self.walk.as_ref().filter(|walk| walk.is_under_way) {
            let robots = walk.subgroup(walk.arrived).map(|places| walk.announced[places].to_vec());
            self.untold.push((walk.arrived, robots.unwrap_or_default()));
            self.take_places();
        }
    }

    /// The ledger as it will be when the subgroup under way has arrived.
    pub(super) fn after_arrival(&self) -> Self {
        let mut after = self.clone();
        after.take_places();
        after
    }

    fn expect_subgroup(
        &mut self,
        subgroup: usize,
        robots: &[usize],
        does: &str,
        is_under_way: bool,
    ) -> Result<&mut Walk, Dispute> {
        let is_expected = |walk: &Walk| {
            let members = walk.subgroup(subgroup).map(|places| &walk.announced[places]);
            walk.arrived == subgroup && walk.is_under_way == is_under_way && members == Some(robots)
        };
        match &mut self.walk {
            Some(walk) if is_expected(walk) => Ok(walk),
            _ => {
                let sentence = format!(
                    "subgroup {subgroup}, {robots:?}, {does}, and it is not that one's turn"
                );
                Err(Dispute::of(Property::Subgroups, robots, sentence))
            }
        }
    }

    /// L_b = 0: the last robot that Σ relieves joins the primary team behind p₁.
    fn join(&mut self, robot: usize) -> Result<(), Dispute> {
        self.imply_arrival();
        let walk = self.walk.take().filter(Walk::has_arrived);
        let relieved = walk.and_then(|walk| Some(walk.path[*walk.break_points.last()?]));
        if self.awaits_release || relieved != Some(robot) {
            let sentence =
                format!("robot {robot} joins the primary team, and no subgroup has relieved it");
            return dispute(&[robot], sentence);
        }
        self.primary_team.insert(0, robot);
        (self.calls, self.calls_ahead) = (false, false);
        Ok(())
    }

    /// L_b = 1: the leader is released when the last subgroup has arrived at its place.
    fn release(&mut self, robot: usize) -> Result<(), Dispute> {
        self.imply_arrival();
        let is_relieved = self.walk.as_ref().is_none_or(Walk::has_arrived);
        if !self.awaits_release || self.leader != Some(robot) || !is_relieved {
            return dispute(&[robot], format!("robot {robot} is released, and nothing binds it"));
        }
        (self.awaits_release, self.calls, self.walk) = (false, false, None);
        Ok(())
    }

    fn change_role(&mut self, robot: usize, from: Role, to: Role) -> Result<(), Dispute> {
        let role = self.roles[robot];
        if role != from {
            let sentence = format!(
                "robot {robot} turns from {} to {}, and it was {}",
                from.name(),
                to.name(),
                role.name()
            );
            return Err(Dispute::of(Property::RoleTransition, &[robot], sentence));
        }
        self.roles[robot] = to;
        // Along Σ a leaf leaves its task to the robot behind.
        if (from, to) == (Role::Leaf, Role::Node) && self.walk.is_none() {
            self.discharging.retain(|_, holder| *holder != robot);
        }
        Ok(())
    }

    /// Eq. (2): the leader services its task; one with past duties from its post, before anybody comes to release it.
    fn service(&mut self, task: usize, robot: usize) -> Result<(), Dispute> {
        self.expect_pursued(task, "a robot services")?;
        if self.leader != Some(robot) {
            let sentence = format!("robot {robot} services task {task}, and does not lead to it");
            return dispute(&[robot], sentence);
        }
        if self.awaits_release && self.walk.is_some() {
            let sentence = format!("robot {robot} services task {task}, and is being released");
            return dispute(&[robot], sentence);
        }
        self.serviced.insert(task, robot);
        (self.leader, self.awaits_release, self.calls, self.walk) = (None, false, false, None);
        self.dismissed = std::mem::take(&mut self.primary_team);
        Ok(())
    }

    /// Two robots take each other's place in everything.
    fn exchange(&mut self, mover: usize, parked: usize) -> Result<(), Dispute> {
        let may_give = self.active_team().contains(&mover)
            || self.dismissed.contains(&mover)
            || self.is_of_calling_team(mover);
        if mover == parked || !may_give {
            let sentence = format!(
                "robot {mover} gives its duty to robot {parked} and is not of the active team {:?}",
                self.active_team()
            );
            return dispute(&[mover, parked], sentence);
        }
        let pair = [mover, parked];
        let holders = self.serviced.values_mut().chain(self.discharging.values_mut());
        let team = self.primary_team.iter_mut().chain(&mut self.leader);
        let walk = self.walk.iter_mut().flat_map(|walk| &mut walk.path);
        team.chain(holders).chain(walk).for_each(|robot| swap(robot, pair));
        self.exchanged.push(pair);
        Ok(())
    }

    fn expect_pursued(&self, task: usize, what: &str) -> Result<(), Dispute> {
        if self.task() == Some(task) {
            return Ok(());
        }
        let sentence = match self.task() {
            Some(pursued) => format!("{what} task {task}, and task {pursued} is pursued"),
            None => format!("{what} task {task}, and none is pursued"),
        };
        dispute(&[], sentence)
    }
}

/// Names the other of two robots where it names one.
fn swap(robot: &mut usize, [one, other]: [usize; 2]) {
    match *robot {
        it if it == one => *robot = other,
        it if it == other => *robot = one,
        _ => {}
    }
}

/// Whether an event is told by the access point that takes tasks back: it knows of that first.
const fn is_told_by_access_point(event: &MissionEvent) -> bool {
    matches!(
        event,
        MissionEvent::TaskAnnounced { .. }
            | MissionEvent::TaskReannounced { .. }
            | MissionEvent::TaskEnded { .. }
            | MissionEvent::TaskWithdrawn { .. }
            | MissionEvent::TaskGivenUp { .. }
    )
}

fn dispute<T>(robots: &[usize], sentence: String) -> Result<T, Dispute> {
    Err(Dispute::of(Property::Events, robots, sentence))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Robots go on as if the task were not taken back until they hear so; the access point knows.
    #[test]
    fn what_the_access_point_tells_is_not_held_against_what_robots_have_yet_to_hear() {
        let mut ledger = Ledger::new(3);
        let withdrawn = MissionEvent::TaskWithdrawn { task: 0 };
        let elected = MissionEvent::LeaderElected { task: 0, robot: 1, conflict: false };
        let serviced = MissionEvent::TaskServiced { task: 0, robot: 1 };
        for event in [MissionEvent::TaskAnnounced { task: 0 }, elected, withdrawn.clone()] {
            assert_eq!(ledger.enter(&event), Ok(()));
        }
        assert_eq!(ledger.clone().enter(&serviced), Ok(()));
        let found = ledger.enter(&withdrawn).expect_err("it is over");
        assert_eq!(found.sentence, "task 0 is taken back, and it is over");
    }

    /// From its post, as long as nobody is on the way to it.
    #[test]
    fn a_leader_that_awaits_its_release_may_service_its_task_until_a_recruit_comes() {
        let mut ledger = Ledger::new(3);
        let elected = MissionEvent::LeaderElected { task: 0, robot: 1, conflict: true };
        for event in [MissionEvent::TaskAnnounced { task: 0 }, elected] {
            assert_eq!(ledger.enter(&event), Ok(()));
        }
        let serviced = MissionEvent::TaskServiced { task: 0, robot: 1 };
        let mut from_post = ledger.clone();
        assert_eq!(from_post.enter(&serviced), Ok(()));
        assert!(!from_post.awaits_release);
        let recruited =
            MissionEvent::RecruitElected { robot: 2, path: vec![2, 1], break_points: vec![2, 1] };
        assert_eq!(ledger.enter(&recruited), Ok(()));
        assert!(ledger.enter(&serviced).is_err());
    }
}
