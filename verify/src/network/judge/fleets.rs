//! The judge of several fleets: the mission of each by itself, and the distances between them.

use std::sync::Arc;

use pleach_automaton::network::certificate::Certificate;
use pleach_automaton::network::merging::Part;
use pleach_automaton::network::record::{End, Faults, FleetEnd, MissionEvent, Outcome, Snapshot};
use pleach_automaton::network::scenario::{Fleet, ValidScenario};
use pleach_continuous::Point;
use pleach_discrete::network::Role;

use super::{Dispute, Referee};
use crate::network::extremes::{Extreme, Extremes, keep_larger, keep_smaller};
use crate::network::instant;
use crate::network::limits::Limits;
use crate::network::period::{self, Period};
use crate::network::property::Property;
use crate::network::violation::{Instant, Violation};

/// Judges the missions of several fleets, period by period, and stops at the first violation.
///
/// The record is divided into that of each fleet, which is judged as a mission of its own, and nothing may be left
/// over. Robots of different fleets keep their distance like any others.
#[derive(Clone, Debug)]
pub struct JudgeOfFleets<'a> {
    limits: Limits,
    judges: Vec<FleetJudge<'a>>,
    previous: Option<Snapshot>,
    extremes: Extremes,
}

/// A fleet with the judge of its mission.
#[derive(Clone, Debug)]
struct FleetJudge<'a> {
    fleet: Fleet,
    referee: Referee<'a>,
    /// The control period from whose beginning on its mission is over, and the judge as it was then.
    over: Option<(usize, Referee<'a>)>,
}

impl<'a> JudgeOfFleets<'a> {
    /// The judge of the fleets of a scenario, in which these faults occur, that has seen nothing yet; `role_table`
    /// tells whether a role may turn into another in one transition.
    pub fn new(
        scenario: &ValidScenario,
        faults: Faults,
        role_table: impl Fn(Role, Role) -> bool + 'a,
    ) -> Self {
        let role_table = Arc::new(role_table);
        let judge = |fleet: &Fleet| {
            let role_table = Arc::clone(&role_table);
            let may_follow = move |from, to| role_table(from, to);
            let referee = Referee::of_one(fleet.scenario(), faults, may_follow);
            FleetJudge { fleet: fleet.clone(), referee, over: None }
        };
        JudgeOfFleets {
            limits: Limits::of(scenario),
            judges: scenario.fleets().iter().map(judge).collect(),
            previous: None,
            extremes: Extremes::default(),
        }
    }

    /// Judges the control period that ends with this snapshot, its events, and the snapshot.
    ///
    /// # Errors
    ///
    /// The first violation; what is observed after it has no meaning.
    pub fn observe(
        &mut self,
        snapshot: &Snapshot,
        events: &[MissionEvent],
    ) -> Result<(), Violation> {
        instant::record(snapshot, &self.limits)?;
        self.keep_apart(snapshot)?;
        let at_once = |dispute: Dispute| dispute.at(Instant::of(snapshot));
        let parts = self.divide(snapshot).map_err(at_once)?;
        let events = self.distribute(events).map_err(at_once)?;
        for ((judge, (part, ended)), events) in self.judges.iter_mut().zip(parts).zip(events) {
            judge.note_end(ended, snapshot.step).map_err(at_once)?;
            judge.observe(&part, &events, &snapshot.positions)?;
        }
        self.previous = Some(snapshot.clone());
        self.keep_extremes();
        Ok(())
    }

    /// Robots keep 2ρ apart, whichever fleet they belong to.
    fn keep_apart(&mut self, snapshot: &Snapshot) -> Result<(), Violation> {
        let period = Period::ending(self.previous.as_ref(), snapshot)?;
        let nearest = period::separation(&period, &self.limits)?;
        keep_smaller(&mut self.extremes.pair_distance, nearest);
        Ok(())
    }

    /// What the snapshot shows of each fleet, and since when its mission is over. Together that is all of it.
    fn divide(&self, snapshot: &Snapshot) -> Result<Vec<(Snapshot, Option<usize>)>, Dispute> {
        let parts = self.judges.iter().map(|judge| Part::of(&judge.fleet, snapshot));
        let parts: Option<Vec<Part>> = parts.collect();
        let is_whole = |parts: &Vec<Part>| Snapshot::merged(parts).as_ref() == Some(snapshot);
        match parts.filter(is_whole) {
            Some(parts) => Ok(parts.into_iter().map(|part| (part.snapshot, part.ended)).collect()),
            None => {
                let sentence = "the step is not what its fleets show side by side: something is shown of no fleet, \
                    of two, or not at all";
                Err(Dispute::of(Property::Record, &[], sentence.to_owned()))
            }
        }
    }

    /// The events of each fleet.
    fn distribute(&self, events: &[MissionEvent]) -> Result<Vec<Vec<MissionEvent>>, Dispute> {
        let mut of_fleets = vec![Vec::new(); self.judges.len()];
        for event in events {
            let numbered = self.judges.iter().enumerate();
            let own = numbered
                .filter_map(|(at, judge)| Some((at, event.renumbered(judge.fleet.inward())?)));
            match own.collect::<Vec<_>>().as_slice() {
                [(at, event)] => of_fleets[*at].push(event.clone()),
                _ => {
                    let (nodes, tasks) = event.identities();
                    let sentence = format!(
                        "an event that names nodes {nodes:?} and tasks {tasks:?} is not of one fleet"
                    );
                    return Err(Dispute::of(Property::Record, &[], sentence));
                }
            }
        }
        Ok(of_fleets)
    }

    fn keep_extremes(&mut self) {
        for judge in &self.judges {
            let Extremes { clearance, residual, load, .. } = judge.extremes();
            keep_smaller(&mut self.extremes.clearance, clearance);
            keep_smaller(&mut self.extremes.residual, residual);
            keep_larger(&mut self.extremes.load, load);
        }
    }

    /// Judges how the missions ended.
    ///
    /// # Errors
    ///
    /// [`Property::Outcome`] if the record does not show what the outcome of one of them says, or they do not give that
    /// of the whole.
    pub fn conclude(&self, end: &End) -> Result<(), Violation> {
        let now = self.previous.as_ref().map_or(Instant { step: 0, time: 0.0 }, Instant::of);
        let told = |sentence: String| Dispute::of(Property::Outcome, &[], sentence).at(now);
        if end.outcome == Outcome::InvariantViolated {
            return Err(told(format!("the run says: {}", end.reason)));
        }
        for judge in &self.judges {
            judge.conclude(judge.end(end).map_err(told)?)?;
        }
        let whole = End::of_fleets(end.fleets.clone());
        let of = |end: &End| (end.outcome, end.task, end.certificate.clone());
        match of(&whole) == of(end) && end.fleets.len() == self.judges.len() {
            true => Ok(()),
            false => Err(told(format!(
                "the outcome of the whole is “{}”, and those of its fleets make it “{}”",
                end.outcome.name(),
                whole.outcome.name()
            ))),
        }
    }

    /// An observer's account of why the mission of the fleet of this access point ended.
    pub fn account(&self, access_point: usize, end: &End) -> Option<Certificate> {
        let judge = self.judges.iter().find(|judge| judge.access_point() == access_point)?;
        let end = end.renumbered(judge.fleet.inward())?;
        judge.at_its_end().account(&end)?.renumbered(judge.fleet.outward())
    }

    /// An event, which comes with an account of why if it tells that a task is given up.
    pub(super) fn explain(
        &self,
        event: &MissionEvent,
        snapshot: &Snapshot,
        events: &[MissionEvent],
    ) -> MissionEvent {
        let explained = || {
            let MissionEvent::TaskGivenUp { task, .. } = *event else { return None };
            let judge = self.judges.iter().find(|it| it.fleet.inward().task(task).is_some())?;
            let own = event.renumbered(judge.fleet.inward())?;
            let events = self.distribute(events).ok()?;
            let (parts, at) = (self.divide(snapshot).ok()?, self.place_of(judge));
            let (part, events) = (&parts.get(at)?.0, events.get(at)?);
            let place = events.iter().position(|it| *it == own)?;
            let explained = judge.referee.explain(part, events);
            explained.get(place)?.renumbered(judge.fleet.outward())
        };
        explained().unwrap_or_else(|| event.clone())
    }

    fn place_of(&self, judge: &FleetJudge) -> usize {
        let is_it = |it: &FleetJudge| it.access_point() == judge.access_point();
        self.judges.iter().position(is_it).unwrap_or_default()
    }

    /// How near the missions have come to their bounds so far.
    pub const fn extremes(&self) -> &Extremes {
        &self.extremes
    }
}

impl<'a> FleetJudge<'a> {
    const fn access_point(&self) -> usize {
        self.fleet.access_point()
    }

    /// The judge of its mission, as it was at the end of that.
    fn at_its_end(&self) -> &Referee<'a> {
        self.over.as_ref().map_or(&self.referee, |(_, referee)| referee)
    }

    /// Takes note of whether its mission is over at the beginning of this control period, and since when.
    fn note_end(&mut self, ended: Option<usize>, step: usize) -> Result<(), Dispute> {
        match (&self.over, ended) {
            (None, None) => Ok(()),
            (None, Some(period)) if period == step => {
                self.over = Some((period, self.referee.clone()));
                Ok(())
            }
            (Some((before, _)), Some(period)) if period == *before => Ok(()),
            _ => {
                let since = |period: Option<usize>| match period {
                    Some(period) => format!("over since k = {period}"),
                    None => "under way".to_owned(),
                };
                let before = self.over.as_ref().map(|(period, _)| *period);
                let sentence = format!(
                    "the mission of access point {} is said to be {}, and was {} in the step before",
                    self.access_point(),
                    since(ended),
                    since(before)
                );
                Err(Dispute::of(Property::Record, &[], sentence))
            }
        }
    }

    /// Judges what is shown and told of its fleet, where the robots of the whole stand here.
    fn observe(
        &mut self,
        part: &Snapshot,
        events: &[MissionEvent],
        places: &[Point],
    ) -> Result<(), Violation> {
        let robots = self.fleet.robots();
        let others =
            places.iter().enumerate().filter(|(robot, _)| robots.binary_search(robot).is_err());
        self.referee.show_bodies(others.map(|(_, &place)| place).collect());
        let observed = self.referee.observe(part, events);
        observed.map_err(|violation| self.in_whole(violation))
    }

    /// Its end as the end of the whole tells it, in its own numbers.
    fn end(&self, whole: &End) -> Result<End, String> {
        let access_point = self.access_point();
        let told = whole.fleets.iter().find(|it| it.access_point == access_point);
        let Some(FleetEnd { end, .. }) = told else {
            return Err(format!(
                "it is not reported how the mission of access point {access_point} ended"
            ));
        };
        end.renumbered(self.fleet.inward()).ok_or_else(|| {
            format!(
                "the end of the mission of access point {access_point} names what is of another"
            )
        })
    }

    fn conclude(&self, end: End) -> Result<(), Violation> {
        self.at_its_end().conclude(&end).map_err(|violation| self.in_whole(violation))
    }

    fn extremes(&self) -> Extremes {
        let Extremes { clearance, residual, load, .. } = self.referee.extremes().clone();
        let in_whole = |mut extreme: Extreme| {
            extreme.robots = self.numbers(&extreme.robots);
            extreme
        };
        Extremes {
            pair_distance: None,
            clearance: clearance.map(in_whole),
            residual: residual.map(in_whole),
            load: load.map(in_whole),
        }
    }

    fn numbers(&self, nodes: &[usize]) -> Vec<usize> {
        nodes.iter().filter_map(|&node| self.fleet.outward().node(node)).collect()
    }

    /// A violation of its mission as one of the whole. The sentence counts robots and tasks as the judge of the fleet
    /// does, and says which they are in the scenario.
    fn in_whole(&self, violation: Violation) -> Violation {
        let tasks = 0..self.fleet.scenario().task.len();
        let tasks: Vec<usize> = tasks.filter_map(|task| self.fleet.outward().task(task)).collect();
        let sentence = format!(
            "in the mission of access point {}, whose robots {:?} and tasks {tasks:?} are here numbered from 0 in \
             this order: {}",
            self.access_point(),
            self.fleet.robots(),
            violation.sentence
        );
        Violation { robots: self.numbers(&violation.robots), sentence, ..violation }
    }
}
