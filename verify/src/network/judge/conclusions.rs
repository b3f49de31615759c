//! Whether what observers conclude is what the events and the world give.

use pleach_automaton::network::LONGEST_SETTLING;
use pleach_automaton::network::record::{MissionEvent, RobotSnapshot, Snapshot};
use pleach_automaton::network::scenario::Strategy;
use pleach_discrete::Location as _;
use pleach_discrete::network::{Phase, Role};

use super::claims::is_part;
use super::lately::Lately;
use super::ledger::{Ledger, Stage};
use super::walk::Walk;
use super::{Dispute, Scene, claims, posts, states, task_or_none};
use crate::network::property::Property;

/// Control periods for which a leader that awaits its release waits until nodes have had time to become redundant, while
/// its post is not attached elsewhere.
const RETIREMENT: usize = 3;

/// Control periods after which the user has heard what all robots know: one until an access point has heard it of
/// them, and one until that has answered the user.
const NEWS_TO_USER: usize = 2;
/// A robot this share of ρ from the place of its post has come to rest.
const SETTLED: f64 = 0.02;
/// A robot makes way within this many ρ of one that moves with the active team: the way that is
/// asked for is 4 ρ long, and 2.2 ρ are kept from it.
const MAKING_WAY: f64 = 6.2;

/// What the judge has derived lately, and what it waits for.
#[derive(Clone, Debug)]
pub(super) struct Conclusions {
    /// For how many control periods news may be on its way: it passes one link in a round of
    /// messages, and a period has at least one round.
    patience: usize,
    task: Lately<Option<usize>>,
    stage: Lately<Stage>,
    active_team: Lately<Vec<usize>>,
    primary_team: Lately<Vec<usize>>,
    path: Lately<Vec<usize>>,
    serviced: Lately<Vec<(usize, usize)>>,
    /// The last step with an event.
    last_event: Option<usize>,
    /// What was seen of Σ before it was announced: its robots, and a team that moves along it.
    early: Vec<(Vec<usize>, Vec<usize>)>,
    /// Robots that set out along Σ before it was announced.
    early_movers: Vec<usize>,
    /// Since when the phase has been ahead of the events.
    ahead: Option<usize>,
    /// Since when an arrival has been untold.
    untold: Option<usize>,
    /// Robots that have changed their role, each with the step at which it did.
    changed: Vec<(usize, usize)>,
    /// Robots that have exchanged duties, each with the step at which that was told.
    exchanging: Vec<(usize, usize)>,
    /// The step at which the robots first knew that the mission has ended.
    ended: Option<usize>,
    /// The last step at which a mission that had been given up went on: robots hear so one after the other.
    resumed: Option<usize>,
    /// The step since which all robots have known that, and none of them may move.
    at_rest: Option<usize>,
}

impl Conclusions {
    /// The conclusions before the first period, in a network of `nodes` nodes.
    pub(super) fn new(nodes: usize) -> Self {
        Conclusions {
            patience: nodes,
            task: Lately::new(None),
            stage: Lately::new(Stage::Idle),
            active_team: Lately::new(Vec::new()),
            primary_team: Lately::new(Vec::new()),
            path: Lately::new(Vec::new()),
            serviced: Lately::new(Vec::new()),
            last_event: None,
            early: Vec::new(),
            early_movers: Vec::new(),
            ahead: None,
            untold: None,
            changed: Vec::new(),
            exchanging: Vec::new(),
            ended: None,
            resumed: None,
            at_rest: None,
        }
    }

    /// An event at `step`, after which the ledger is this: a path that is announced is the one that
    /// was seen before.
    pub(super) fn enter(
        &mut self,
        event: &MissionEvent,
        ledger: &Ledger,
        step: usize,
    ) -> Result<(), Dispute> {
        self.last_event = Some(step);
        self.update(ledger, step);
        match *event {
            MissionEvent::RoleChanged { robot, .. } => self.changed.push((robot, step)),
            MissionEvent::DutiesExchanged { mover, parked } => {
                self.exchanging.extend([(mover, step), (parked, step)]);
            }
            // A path that was seen before may be given up untold.
            MissionEvent::ElectionRepeated { .. } => self.forget_early(),
            MissionEvent::TaskWithdrawn { .. } | MissionEvent::TaskGivenUp { .. } => {
                self.forget_early();
                self.resume(step);
            }
            // So may the mission be, until robots are free.
            MissionEvent::TaskAnnounced { .. } | MissionEvent::TaskReannounced { .. } => {
                self.forget_early();
                (self.ended, self.at_rest, self.ahead) = (None, None, None);
            }
            _ => {}
        }
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
        match self.early_movers.drain(..).find(|robot| !first_team.contains(robot)) {
            None => Ok(()),
            Some(robot) => {
                let sentence = format!(
                    "robot {robot} was on its way before the path {path:?} was announced, and it \
                     is not of the first subgroup {first_team:?}"
                );
                Err(Dispute::of(Property::ActiveTeam, &[robot], sentence))
            }
        }
    }

    /// A mission that has been given up goes on.
    fn resume(&mut self, step: usize) {
        (self.ended, self.at_rest, self.ahead, self.resumed) = (None, None, None, Some(step));
    }

    fn forget_early(&mut self) {
        self.early.clear();
        self.early_movers.clear();
    }

    /// The ledger after an event.
    fn update(&mut self, ledger: &Ledger, step: usize) {
        if let Some(outdated) = &ledger.outdated {
            self.update(outdated, step);
        }
        let patience = self.patience;
        let remaining = ledger.walk.as_ref().map_or(&[][..], |walk| walk.remaining());
        self.task.update(ledger.task(), step, patience);
        self.stage.update(ledger.stage(), step, patience);
        self.active_team.update(ledger.active_team().to_vec(), step, patience);
        self.primary_team.update(ledger.primary_team.clone(), step, patience);
        self.path.update(remaining.to_vec(), step, patience);
        let serviced = ledger.serviced.iter().map(|(&task, &robot)| (task, robot)).collect();
        self.serviced.update(serviced, step, patience);
    }

    /// Part of [`Property::Subgroups`]: an arrival that follows from later events is told before news
    /// of it can be everywhere.
    fn arrivals_are_told(&mut self, ledger: &Ledger, step: usize) -> Result<(), Dispute> {
        let Some((subgroup, robots)) = ledger.untold.first() else {
            self.untold = None;
            return Ok(());
        };
        if step - *self.untold.get_or_insert(step) <= self.patience {
            return Ok(());
        }
        let sentence = format!("the arrival of subgroup {subgroup}, {robots:?}, is not reported");
        Err(Dispute::of(Property::Subgroups, robots, sentence))
    }

    /// Whether the mission should have ended before this step: the robots have known that it has for long, and have
    /// had the time to settle, if they do.
    pub(super) fn overdue(&self, step: usize, settles: bool) -> bool {
        let is_past =
            |since: Option<usize>, wait: usize| since.is_some_and(|since| since + wait < step);
        let settling = if settles { LONGEST_SETTLING } else { 0 };
        is_past(self.ended, self.patience + LONGEST_SETTLING)
            || is_past(self.at_rest, NEWS_TO_USER + settling)
    }

    /// Takes note of who knows in this step that the mission has ended.
    fn note_rest(&mut self, snapshot: &Snapshot) {
        let knows = |robot: &RobotSnapshot| robot.phase == Phase::Ended;
        let all_know = !snapshot.robots.is_empty() && snapshot.robots.iter().all(knows);
        match all_know && snapshot.active.is_empty() {
            true => self.at_rest = self.at_rest.or(Some(snapshot.step)),
            false => self.at_rest = None,
        }
    }

    /// Whether everybody may have heard of the last event.
    fn is_settled(&self, step: usize) -> bool {
        self.last_event.is_none_or(|last| last + self.patience < step)
    }

    /// Compares every conclusion of observers.
    pub(super) fn compare(&mut self, ledger: &Ledger, scene: &Scene) -> Result<(), Dispute> {
        let snapshot = scene.snapshot;
        self.update(ledger, snapshot.step);
        let patience = self.patience;
        self.changed.retain(|(_, step)| step + patience >= snapshot.step);
        self.exchanging.retain(|(_, step)| step + patience >= snapshot.step);
        self.arrivals_are_told(ledger, snapshot.step)?;
        states::roles_are_those(ledger, snapshot)?;
        states::multipliers_are_prices(scene)?;
        posts::holders_hold(snapshot)?;
        posts::tasks_agree(snapshot)?;
        posts::closings_are_told(ledger, scene)?;
        // Robots that have given up hold no team and no place of Σ any more.
        let has_resumed = self.resumed.is_some_and(|step| step + self.patience >= snapshot.step);
        if snapshot.phase == Phase::Ended && has_resumed {
            return Ok(());
        }
        if snapshot.phase == Phase::Ended {
            self.ended.get_or_insert(snapshot.step);
            self.note_rest(snapshot);
            return Ok(());
        }
        if self.ended.is_some() {
            let sentence = format!("the phase is “{}” after the end", snapshot.phase.name());
            return Err(Dispute::of(Property::Stage, &[], sentence));
        }
        self.stage_is_that(ledger, scene)?;
        // Robots may act on the arrival of a subgroup before the one that tells of it knows.
        let under_way = ledger.walk.as_ref().filter(|walk| {
            walk.is_under_way && claims::has_come(walk, walk.arrived, scene).is_ok()
        });
        let next = under_way.map(|_| ledger.after_arrival());
        self.teams_are_those(ledger, next.as_ref(), snapshot)?;
        self.path_is_that(ledger, next.as_ref(), snapshot)?;
        self.duties_are_those(ledger, next.as_ref(), snapshot)?;
        let moves = |robot| self.primary_team.values().any(|team| team.contains(&robot));
        posts::are_held(moves, snapshot)?;
        // A subgroup under way has left its posts: which branches part is seen when it is there.
        match self.is_settled(snapshot.step) && ledger.walk.is_none() {
            true => {
                posts::serve_what_is_open(ledger, snapshot)?;
                posts::are_those(ledger, snapshot)
            }
            false => Ok(()),
        }
    }

    /// These robots, but for those that are exchanging duties: for some rounds both have one duty.
    fn apart(&self, robots: &[usize]) -> Vec<usize> {
        robots.iter().copied().filter(|&robot| !self.is_exchanging(robot)).collect()
    }

    fn is_exchanging(&self, robot: usize) -> bool {
        self.exchanging.iter().any(|(it, _)| *it == robot)
    }

    /// Whether no team is seen because the leader hands its duty over: nobody may be seen to lead then.
    fn is_unseen(&self, team: &[usize], ledger: &Ledger) -> bool {
        team.is_empty() && ledger.leader.is_some_and(|leader| self.is_exchanging(leader))
    }

    fn stage_is_that(&mut self, ledger: &Ledger, scene: &Scene) -> Result<(), Dispute> {
        let Scene { snapshot, limits, .. } = scene;
        if !self.task.values().any(|task| *task == snapshot.task) {
            let sentence = format!(
                "{} is reported to be pursued, and {} is by the events",
                task_or_none(snapshot.task),
                task_or_none(*self.task.current())
            );
            return Err(Dispute::of(Property::Stage, &[], sentence));
        }
        let is_known = self.stage.values().any(|&stage| is_phase_of(stage, snapshot.phase));
        // A robot may know that an election is over before its winner tells observers.
        // With the eager strategy a leader that awaits its release calls when nodes have had time to become redundant.
        let is_eager = limits.settings().strategy == Strategy::Eager;
        let awaits_retirements =
            is_eager && ledger.awaits_release && snapshot.phase == Phase::Advance;
        let longest = match awaits_retirements {
            true => self.patience + RETIREMENT,
            false => self.patience,
        };
        let is_ahead = (awaits_retirements || foreshadows(*self.stage.current(), snapshot.phase))
            && snapshot.step - *self.ahead.get_or_insert(snapshot.step) <= longest;
        if is_known {
            self.ahead = None;
        }
        if !is_known && !is_ahead {
            let sentence = format!(
                "the phase is reported as “{}”, and by the events {}",
                snapshot.phase.name(),
                self.stage.current().clause()
            );
            return Err(Dispute::of(Property::Stage, &[], sentence));
        }
        Ok(())
    }

    fn teams_are_those(
        &self,
        ledger: &Ledger,
        next: Option<&Ledger>,
        snapshot: &Snapshot,
    ) -> Result<(), Dispute> {
        let seen = self.apart(&snapshot.primary_team);
        // The members of a team that is dissolved leave it one by one, as they hear of it.
        let is_dissolving = ledger.primary_team.is_empty()
            && self.primary_team.values().any(|known| is_part(&seen, known));
        let is_handed_over = self.is_unseen(&snapshot.primary_team, ledger);
        if seen != self.apart(&ledger.primary_team) && !is_dissolving && !is_handed_over {
            let sentence = format!(
                "the primary team is reported as {:?}, and the events make it {:?}",
                snapshot.primary_team, ledger.primary_team
            );
            return Err(Dispute::of(Property::Teams, &snapshot.primary_team, sentence));
        }
        let leads = |robot: &usize| snapshot.roles[*robot] == Role::Leader;
        let is_alone = |robot: &usize| !self.is_exchanging(*robot);
        if let Some(leader) = ledger.leader.filter(|leader| !leads(leader) && is_alone(leader)) {
            let sentence = format!("robot {leader} is elected, and its role is not leader");
            return Err(Dispute::of(Property::Teams, &[leader], sentence));
        }
        let may_be_none = match &ledger.walk {
            Some(walk) => !walk.is_under_way,
            None => ledger.stage() != Stage::Advancing,
        };
        let team = self.apart(&snapshot.active_team);
        let is_early = ledger.walk.is_none() && ledger.stage() == Stage::Calling;
        let is_known = self.active_team.values().any(|known| self.apart(known) == team)
            || next.is_some_and(|next| self.apart(next.active_team()) == team);
        if is_known || is_early || team.is_empty() && (may_be_none || is_handed_over) {
            return Ok(());
        }
        let sentence = format!(
            "the active team is reported as {:?}, and the events make it {:?}",
            snapshot.active_team,
            self.active_team.current()
        );
        Err(Dispute::of(Property::ActiveTeam, &snapshot.active_team, sentence))
    }

    /// The teams that events name are those at the end of the period, when observers complete them.
    ///
    /// # Errors
    ///
    /// The first that is not, as [`Property::Events`].
    pub(super) fn named_teams_are_those(
        &self,
        events: &[MissionEvent],
        ledger: &Ledger,
        snapshot: &Snapshot,
    ) -> Result<(), Dispute> {
        for event in events {
            let (MissionEvent::Stationary { team, .. } | MissionEvent::JoinedPrimary { team, .. }) =
                event
            else {
                continue;
            };
            // With the mission the team ends, and its members leave it one by one; so they do when their task is
            // taken back.
            let outdated = ledger.outdated.as_ref().map(|outdated| &outdated.primary_team);
            let is_dissolving = snapshot.phase == Phase::Ended
                && is_part(team, &ledger.primary_team)
                || outdated.is_some_and(|known| is_part(team, known));
            // A call may be answered, and the election repeated, in the period in which it is made.
            let is_repeated =
                |event: &MissionEvent| matches!(event, MissionEvent::ElectionRepeated { .. });
            let is_dissolved = ledger.primary_team.is_empty()
                && events.iter().any(is_repeated)
                && self.primary_team.values().any(|known| is_part(team, known));
            let is_that = self.apart(team) == self.apart(&ledger.primary_team);
            let is_lawful = is_that || is_dissolving || is_dissolved;
            if !is_lawful && !self.is_unseen(team, ledger) {
                let sentence = format!(
                    "an event names the primary team {team:?}, which is {:?}",
                    ledger.primary_team
                );
                return Err(Dispute::of(Property::Events, team, sentence));
            }
        }
        Ok(())
    }

    fn path_is_that(
        &mut self,
        ledger: &Ledger,
        next: Option<&Ledger>,
        snapshot: &Snapshot,
    ) -> Result<(), Dispute> {
        let path = &snapshot.path;
        let remaining = next.unwrap_or(ledger).walk.as_ref().map_or(&[][..], Walk::remaining);
        // Members of a subgroup that has arrived leave Σ one by one, as they hear of it.
        let has_all = self.apart(remaining).iter().all(|robot| path.contains(robot));
        let seen = self.apart(path);
        if has_all && self.path.values().any(|known| is_part(&seen, known)) {
            return Ok(());
        }
        if ledger.awaits_path() {
            let seen = (path.clone(), snapshot.active_team.clone());
            if !self.early.contains(&seen) {
                self.early.push(seen);
            }
            return Ok(());
        }
        if ledger.outdated.as_ref().is_some_and(|outdated| outdated.awaits_path()) {
            return Ok(());
        }
        let sentence = format!(
            "the robots on the path are reported as {path:?}, and the events make them {:?}",
            self.path.current()
        );
        Err(Dispute::of(Property::Teams, path, sentence))
    }

    fn duties_are_those(
        &self,
        ledger: &Ledger,
        next: Option<&Ledger>,
        snapshot: &Snapshot,
    ) -> Result<(), Dispute> {
        let next: Option<Vec<_>> =
            next.map(|next| next.serviced.iter().map(|(&task, &robot)| (task, robot)).collect());
        // Who has held a task that is over hears so sooner or later.
        let is_open = |(task, _): &&(usize, usize)| !ledger.closed.contains(task);
        let agrees = |known: &Vec<(usize, usize)>| {
            let known: Vec<_> = known.iter().filter(is_open).collect();
            let seen: Vec<_> = snapshot.serviced.iter().filter(is_open).collect();
            known.len() == seen.len()
                && known.iter().zip(&seen).all(|(known, seen)| {
                    known.0 == seen.0
                        && (known.1 == seen.1
                            || self.is_exchanging(known.1) && self.is_exchanging(seen.1))
                })
        };
        if self.serviced.values().chain(&next).any(agrees) {
            return Ok(());
        }
        let sentence = format!(
            "tasks and their holders are reported as {:?}, and the events make them {:?}",
            snapshot.serviced,
            self.serviced.current()
        );
        Err(Dispute::of(Property::Duties, &[], sentence))
    }

    /// Part of [`Property::Posts`]: posts stay as they are but for those of robots that move with a
    /// team, or have changed their duty.
    pub(super) fn posts_stay(&self, scene: &Scene) -> Result<(), Dispute> {
        let Scene { snapshot, previous, .. } = scene;
        let Some(previous) = previous.filter(|_| snapshot.phase != Phase::Ended) else {
            return Ok(());
        };
        let teams = || self.active_team.values().chain(self.primary_team.values()).flatten();
        let is_early = |robot: usize| {
            let active = [previous, *snapshot].into_iter().flat_map(|it| &it.active);
            snapshot.path.contains(&robot) && active.into_iter().any(|it| *it == robot)
        };
        posts::stay(previous, snapshot, |robot| {
            teams().any(|it| *it == robot)
                || self.changed.iter().chain(&self.exchanging).any(|(it, _)| *it == robot)
                || is_early(robot)
        })
    }

    /// Part of [`Property::ActiveTeam`]: a robot that may move and is not of the active team is on
    /// its way to the place of its post, or makes way.
    pub(super) fn moves_have_a_cause(
        &mut self,
        ledger: &Ledger,
        scene: &Scene,
    ) -> Result<(), Dispute> {
        let Scene { snapshot, limits, places, .. } = scene;
        // The primary team may go on while a recruit is sought and comes.
        let is_eager = limits.settings().strategy == Strategy::Eager;
        let primary = || self.primary_team.values().filter(|_| is_eager);
        let active = || self.active_team.values().chain([&snapshot.active_team]);
        let teams = || active().chain(primary()).flatten();
        let settings = limits.settings();
        let clearance = settings.planning_clearance();
        let near_enough = SETTLED * clearance * (1.0 - 1e-6) + settings.errors.stray();
        let is_settled = |robot: usize| {
            let position = snapshot.positions[robot];
            places.of(robot).map(|place| (position - place).norm() <= near_enough)
        };
        // A robot on its way back to its post, or out of another's way, may ask for room as well.
        let others = || snapshot.active.iter().filter(|&&robot| is_settled(robot) == Some(false));
        for &robot in &snapshot.active {
            let position = snapshot.positions[robot];
            let Some(settled) = is_settled(robot).filter(|_| !teams().any(|it| *it == robot))
            else {
                continue;
            };
            let is_near = |mover: &usize| {
                let distance = (snapshot.positions[*mover] - position).norm();
                distance <= MAKING_WAY * clearance
            };
            let is_early = ledger.awaits_path() && snapshot.path.contains(&robot);
            if settled && is_early {
                self.early_movers.push(robot);
            } else if settled && !teams().chain(others()).any(is_near) {
                let sentence = format!(
                    "robot {robot} may move, and it is at its post, not of the active team, and in \
                     no other robot's way"
                );
                return Err(Dispute::of(Property::ActiveTeam, &[robot], sentence));
            }
        }
        Ok(())
    }
}

const fn is_phase_of(stage: Stage, phase: Phase) -> bool {
    match stage {
        Stage::Idle => matches!(phase, Phase::Idle),
        Stage::Electing => matches!(phase, Phase::LeaderElection),
        Stage::Advancing => matches!(phase, Phase::Advance),
        Stage::Calling => matches!(phase, Phase::RecruitElection | Phase::PathAgreement),
        Stage::Shifting => matches!(phase, Phase::Shift),
    }
}

/// Whether robots may be in this phase before an event ends the stage.
const fn foreshadows(stage: Stage, phase: Phase) -> bool {
    match stage {
        Stage::Electing => matches!(phase, Phase::Advance),
        Stage::Calling => matches!(phase, Phase::Shift),
        _ => false,
    }
}
