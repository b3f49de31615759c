//! Whether what observers conclude is what the events and the world give.

use pleach_automaton::network::record::{MissionEvent, PostView, Snapshot};
use pleach_discrete::network::{Phase, Role};

use super::lately::Lately;
use super::ledger::{Ledger, Stage};
use super::{Dispute, Scene};
use crate::network::property::Property;

/// A robot this share of ρ from the place of its post has come to rest.
const SETTLED: f64 = 0.02;
/// A robot makes way within this many ρ of one that moves with the active team: the way that is
/// asked for is 4 ρ long, and 2.2 ρ are kept from it.
const MAKING_WAY: f64 = 6.2;

/// What the judge has derived lately, and what it waits for.
#[derive(Clone, Debug)]
pub struct Conclusions {
    /// For how many control periods news may be on its way: it passes one link in a round of
    /// messages, and a period has at least one round.
    patience: usize,
    task: Lately<Option<usize>>,
    stage: Lately<Stage>,
    active_team: Lately<Vec<usize>>,
    path: Lately<Vec<usize>>,
    serviced: Lately<Vec<(usize, usize)>>,
    /// The last step with an event.
    last_event: Option<usize>,
    /// What was seen of Σ before it was announced: its robots, and a team that moves along it.
    early: Vec<(Vec<usize>, Vec<usize>)>,
    /// The step at which the robots first knew that the mission has ended.
    ended: Option<usize>,
}

impl Conclusions {
    /// Nothing has happened in a network with so many nodes.
    pub fn new(nodes: usize) -> Self {
        Conclusions {
            patience: nodes,
            task: Lately::new(None),
            stage: Lately::new(Stage::Idle),
            active_team: Lately::new(Vec::new()),
            path: Lately::new(Vec::new()),
            serviced: Lately::new(Vec::new()),
            last_event: None,
            early: Vec::new(),
            ended: None,
        }
    }

    /// An event at `step`, after which the ledger is this: a path that is announced is the one that
    /// was seen before.
    pub fn enter(
        &mut self,
        event: &MissionEvent,
        ledger: &Ledger,
        step: usize,
    ) -> Result<(), Dispute> {
        self.last_event = Some(step);
        self.update(ledger, step);
        let MissionEvent::RecruitElected { path, break_points, .. } = event else { return Ok(()) };
        let second = break_points.get(1).and_then(|point| path.iter().position(|it| it == point));
        let first_team = &path[..second.unwrap_or(0)];
        for (robots, team) in self.early.drain(..) {
            if !is_part(&robots, path) || !(team.is_empty() || team == first_team) {
                let sentence = format!(
                    "the path {path:?} is announced, and {robots:?} with the team {team:?} were \
                     seen on it before"
                );
                return Err(Dispute::of(Property::Subgroups, path, sentence));
            }
        }
        Ok(())
    }

    /// The ledger after an event.
    fn update(&mut self, ledger: &Ledger, step: usize) {
        let patience = self.patience;
        let remaining = ledger.walk.as_ref().map_or(&[][..], |walk| walk.remaining());
        self.task.update(ledger.task(), step, patience);
        self.stage.update(ledger.stage(), step, patience);
        self.active_team.update(ledger.active_team().to_vec(), step, patience);
        self.path.update(remaining.to_vec(), step, patience);
        let serviced = ledger.serviced.iter().map(|(&task, &robot)| (task, robot)).collect();
        self.serviced.update(serviced, step, patience);
    }

    /// Whether the mission should have ended: the robots have known that it has for long.
    pub fn overdue(&self, step: usize) -> bool {
        self.ended.is_some_and(|ended| ended + self.patience < step)
    }

    /// Whether everybody may have heard of the last event.
    fn is_settled(&self, step: usize) -> bool {
        self.last_event.is_none_or(|last| last + self.patience < step)
    }

    /// Compares every conclusion of observers.
    pub fn compare(&mut self, ledger: &Ledger, snapshot: &Snapshot) -> Result<(), Dispute> {
        self.update(ledger, snapshot.step);
        roles_are_those(ledger, snapshot)?;
        multipliers_are_prices(snapshot)?;
        holders_hold(snapshot)?;
        // Robots that have given up hold no team and no place of Σ any more.
        if snapshot.phase == Phase::Ended {
            self.ended.get_or_insert(snapshot.step);
            return Ok(());
        }
        if self.ended.is_some() {
            let sentence = format!("the phase is “{}” after the end", snapshot.phase.name());
            return Err(Dispute::of(Property::Stage, &[], sentence));
        }
        self.stage_is_that(snapshot)?;
        self.teams_are_those(ledger, snapshot)?;
        self.path_is_that(ledger, snapshot)?;
        self.duties_are_those(snapshot)?;
        posts_are_held(ledger, snapshot)?;
        if self.is_settled(snapshot.step) { posts_are_those(ledger, snapshot) } else { Ok(()) }
    }

    fn stage_is_that(&self, snapshot: &Snapshot) -> Result<(), Dispute> {
        if !self.task.values().any(|task| *task == snapshot.task) {
            let sentence = format!(
                "the task is reported as {:?}, and the events make it {:?}",
                snapshot.task,
                self.task.current()
            );
            return Err(Dispute::of(Property::Stage, &[], sentence));
        }
        if !self.stage.values().any(|&stage| is_phase_of(stage, snapshot.phase)) {
            let sentence = format!(
                "the phase is reported as “{}”, and the mission is {:?}",
                snapshot.phase.name(),
                self.stage.current()
            );
            return Err(Dispute::of(Property::Stage, &[], sentence));
        }
        Ok(())
    }

    fn teams_are_those(&self, ledger: &Ledger, snapshot: &Snapshot) -> Result<(), Dispute> {
        if snapshot.primary_team != ledger.primary_team {
            let sentence = format!(
                "the primary team is reported as {:?}, and the events make it {:?}",
                snapshot.primary_team, ledger.primary_team
            );
            return Err(Dispute::of(Property::Teams, &snapshot.primary_team, sentence));
        }
        let leads = |robot: &usize| snapshot.roles[*robot] == Role::Leader;
        if let Some(leader) = ledger.leader.filter(|leader| !leads(leader)) {
            let sentence = format!("robot {leader} is elected, and its role is not leader");
            return Err(Dispute::of(Property::Teams, &[leader], sentence));
        }
        let may_be_none = match &ledger.walk {
            Some(walk) => !walk.is_under_way,
            None => ledger.stage() != Stage::Advancing,
        };
        let team = &snapshot.active_team;
        let is_early = ledger.walk.is_none() && ledger.stage() == Stage::Calling;
        let is_known = self.active_team.values().any(|known| known == team);
        if is_known || is_early || team.is_empty() && may_be_none {
            return Ok(());
        }
        let sentence = format!(
            "the active team is reported as {team:?}, and the events make it {:?}",
            self.active_team.current()
        );
        Err(Dispute::of(Property::ActiveTeam, team, sentence))
    }

    fn path_is_that(&mut self, ledger: &Ledger, snapshot: &Snapshot) -> Result<(), Dispute> {
        let path = &snapshot.path;
        // Members of a subgroup that has arrived leave Σ one by one, as they hear of it.
        let has_all = self.path.current().iter().all(|robot| path.contains(robot));
        if has_all && self.path.values().any(|known| is_part(path, known)) {
            return Ok(());
        }
        if ledger.walk.is_none() && ledger.stage() == Stage::Calling {
            let seen = (path.clone(), snapshot.active_team.clone());
            if !self.early.contains(&seen) {
                self.early.push(seen);
            }
            return Ok(());
        }
        let sentence = format!(
            "the robots on the path are reported as {path:?}, and the events make them {:?}",
            self.path.current()
        );
        Err(Dispute::of(Property::Teams, path, sentence))
    }

    fn duties_are_those(&self, snapshot: &Snapshot) -> Result<(), Dispute> {
        if self.serviced.values().any(|known| *known == snapshot.serviced) {
            return Ok(());
        }
        let sentence = format!(
            "tasks and their holders are reported as {:?}, and the events make them {:?}",
            snapshot.serviced,
            self.serviced.current()
        );
        Err(Dispute::of(Property::Duties, &[], sentence))
    }

    /// Part of [`Property::ActiveTeam`]: a robot that may move and is not of the active team is on
    /// its way to the place of its post, or makes way.
    pub(super) fn moves_have_a_cause(&self, scene: &Scene) -> Result<(), Dispute> {
        let Scene { snapshot, limits, places, .. } = scene;
        let teams = || self.active_team.values().chain([&snapshot.active_team]).flatten();
        for &robot in &snapshot.active {
            let position = snapshot.positions[robot];
            let Some(place) = places.of(robot).filter(|_| !teams().any(|it| *it == robot)) else {
                continue;
            };
            let settled = (position - place).norm() <= SETTLED * limits.clearance() * (1.0 - 1e-6);
            let is_near = |mover: &usize| {
                let distance = (snapshot.positions[*mover] - position).norm();
                distance <= MAKING_WAY * limits.clearance()
            };
            if settled && !teams().any(is_near) {
                let sentence = format!(
                    "robot {robot} may move, and it is at its post, not of the active team, and in \
                     nobody's way"
                );
                return Err(Dispute::of(Property::ActiveTeam, &[robot], sentence));
            }
        }
        Ok(())
    }
}

/// Whether the robots stand in `whole` in this order.
fn is_part(robots: &[usize], whole: &[usize]) -> bool {
    let mut rest = whole.iter();
    robots.iter().all(|robot| rest.any(|it| it == robot))
}

const fn is_phase_of(stage: Stage, phase: Phase) -> bool {
    match stage {
        Stage::Idle => matches!(phase, Phase::Idle),
        Stage::Electing => matches!(phase, Phase::LeaderElection),
        Stage::Advancing => matches!(phase, Phase::Advance),
        // Robots agree on break points, and set out, before the recruit tells observers.
        Stage::Calling => {
            matches!(phase, Phase::RecruitElection | Phase::PathAgreement | Phase::Shift)
        }
        Stage::Shifting => matches!(phase, Phase::Shift),
    }
}

/// Every change of a role is an event.
fn roles_are_those(ledger: &Ledger, snapshot: &Snapshot) -> Result<(), Dispute> {
    let mut pairs = ledger.roles.iter().zip(&snapshot.roles).enumerate();
    match pairs.find(|(_, (known, role))| known != role) {
        None => Ok(()),
        Some((robot, (known, role))) => {
            let sentence = format!(
                "robot {robot} is reported as {}, and the events make it {}",
                role.name(),
                known.name()
            );
            Err(Dispute::of(Property::RoleTransition, &[robot], sentence))
        }
    }
}

/// [`Property::Multipliers`].
fn multipliers_are_prices(snapshot: &Snapshot) -> Result<(), Dispute> {
    match snapshot.multipliers.iter().position(|&multiplier| multiplier < 0.0) {
        None => Ok(()),
        Some(robot) => {
            let multiplier = snapshot.multipliers[robot];
            let sentence = format!("the multiplier of robot {robot} is {multiplier}");
            let dispute = Dispute::of(Property::Multipliers, &[robot], sentence);
            Err(dispute.measuring(multiplier, 0.0))
        }
    }
}

/// Who answers for a task is in the tree, and a leaf, or the leader that is not yet released.
fn holders_hold(snapshot: &Snapshot) -> Result<(), Dispute> {
    for &(task, robot) in &snapshot.serviced {
        let role = snapshot.roles[robot];
        let is_in_tree = snapshot.tree.iter().any(|&(child, _)| child == robot);
        if !is_in_tree || !matches!(role, Role::Leaf | Role::Leader) {
            let sentence = format!(
                "robot {robot} answers for task {task}, and it is a {} {} the tree",
                role.name(),
                if is_in_tree { "in" } else { "outside of" }
            );
            return Err(Dispute::of(Property::Duties, &[robot], sentence));
        }
    }
    Ok(())
}

fn post_of(robot: usize, snapshot: &Snapshot) -> Option<&PostView> {
    snapshot.posts.iter().find(|post| post.holder == robot)
}

/// Part of [`Property::Posts`]: who is a node, junction or leaf and neither moves with the primary
/// team nor walks holds one post, and redundant robots hold none.
fn posts_are_held(ledger: &Ledger, snapshot: &Snapshot) -> Result<(), Dispute> {
    for (robot, role) in snapshot.roles.iter().enumerate() {
        let posts = snapshot.posts.iter().filter(|post| post.holder == robot).count();
        let moves = ledger.primary_team.contains(&robot) || snapshot.path.contains(&robot);
        let (least, most) = match role {
            Role::Redundant => (0, 0),
            Role::Recruit | Role::Leader => (0, 1),
            Role::Node | Role::Junction | Role::Leaf if moves => (0, 1),
            Role::Node | Role::Junction | Role::Leaf => (1, 1),
        };
        if posts < least || posts > most {
            let sentence = format!("robot {robot}, a {}, holds {posts} posts", role.name());
            return Err(Dispute::of(Property::Posts, &[robot], sentence));
        }
        if *role == Role::Recruit && !snapshot.path.contains(&robot) {
            let sentence = format!("robot {robot} is a recruit, and not on the path");
            return Err(Dispute::of(Property::Teams, &[robot], sentence));
        }
    }
    Ok(())
}

/// Part of [`Property::Posts`]: the task of a post is the one that its holder answers for, a leaf
/// has one, and a post is a junction if more than one branch parts there.
fn posts_are_those(ledger: &Ledger, snapshot: &Snapshot) -> Result<(), Dispute> {
    let answers_for =
        |robot: usize| snapshot.serviced.iter().find(|(_, it)| *it == robot).map(|(task, _)| *task);
    let holds =
        |robot: usize| post_of(robot, snapshot).is_some() || ledger.primary_team.contains(&robot);
    for post in &snapshot.posts {
        let (robot, task) = (post.holder, answers_for(post.holder));
        if post.task != task {
            let sentence = format!(
                "the post of robot {robot} is for task {:?}, and the robot answers for {task:?}",
                post.task
            );
            return Err(Dispute::of(Property::Posts, &[robot], sentence));
        }
        let branches = snapshot.tree.iter().filter(|&&(child, it)| it == robot && holds(child));
        let branches = branches.count();
        let role = snapshot.roles[robot];
        let is_junction = branches > 1;
        let fits = match role {
            Role::Junction => is_junction,
            Role::Node => !is_junction,
            _ => true,
        };
        if post.junction != is_junction || !fits {
            let sentence = format!(
                "{branches} branches part at robot {robot}, a {}, whose post is {}a junction",
                role.name(),
                if post.junction { "" } else { "not " }
            );
            return Err(Dispute::of(Property::Posts, &[robot], sentence));
        }
    }
    match snapshot
        .roles
        .iter()
        .enumerate()
        .find(|&(robot, role)| *role == Role::Leaf && answers_for(robot).is_none())
    {
        None => Ok(()),
        Some((robot, _)) => {
            let sentence = format!("robot {robot} is a leaf, and answers for no task");
            Err(Dispute::of(Property::Posts, &[robot], sentence))
        }
    }
}
