//! Missions that are run to their end, and everything that their observers saw.

use crate::{Acts, shipped, shipped_names, valid};
use pleach::automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use pleach::automaton::network::scenario::{Scenario, Strategy, ValidScenario};
use pleach::automaton::network::{Message, Network, Site};
use pleach::automaton::node::Medium;
use pleach::automaton::{Executor, HybridTime, Observer, Reason};
use pleach::continuous::Point;
use pleach::mission::{self, Completed, Watcher};
use pleach::story;
use pleach::trace::TraceWriter;
use pleach::verify::network::Extremes;
use std::collections::BTreeMap;
use std::io;
use std::ops::ControlFlow;
use std::sync::{Arc, LazyLock, OnceLock};

/// What a control period showed.
#[derive(Clone, Debug, PartialEq)]
pub struct Period {
    /// Where robots are and what they hold.
    pub snapshot: Snapshot,
    /// What happened.
    pub events: Vec<MissionEvent>,
}

/// A mission that has ended.
#[derive(Clone, Debug)]
pub struct Mission {
    /// What it started from.
    pub scenario: Scenario,
    /// Its control periods.
    pub periods: Vec<Period>,
    /// How it ended.
    pub end: End,
    /// How close it came to the bounds.
    pub extremes: Extremes,
}

/// The mission of a shipped scenario and what acts in it, run once for all tests.
pub fn shipped_mission(name: &str) -> &'static (Mission, Acts) {
    static MISSIONS: LazyLock<BTreeMap<String, OnceLock<(Mission, Acts)>>> =
        LazyLock::new(|| shipped_names().into_iter().map(|name| (name, OnceLock::new())).collect());
    MISSIONS[name].get_or_init(|| {
        let mut recorder = Recorder::default();
        let scenario = valid(shipped(name));
        let in_mission =
            if scenario.fleets().is_empty() { Acts::in_mission } else { Acts::in_fleets };
        let (completed, acts) = in_mission(&scenario, &mut [&mut recorder]);
        (Mission::new(scenario.into_scenario(), recorder, completed), acts)
    })
}

/// The mission of a scenario, with the monitor watching.
pub fn run(scenario: Scenario) -> Mission {
    let mut recorder = Recorder::default();
    let scenario = valid(scenario);
    let completed =
        mission::run(&scenario, &mut [&mut recorder]).expect("a mission without errors");
    Mission::new(scenario.into_scenario(), recorder, completed)
}

/// The mission of a scenario by this strategy, with the monitor watching.
pub fn run_by(strategy: Strategy, mut scenario: Scenario) -> Mission {
    scenario.control.strategy = Some(strategy);
    run(scenario)
}

/// The trace of the mission of a scenario, and how that was completed.
pub fn traced(scenario: &ValidScenario) -> (Vec<u8>, Completed) {
    let mut writer = TraceWriter::new(Vec::new(), scenario).unwrap();
    let completed = mission::run(scenario, &mut [&mut writer]).unwrap();
    (writer.finish().unwrap(), completed)
}

/// The trace of control periods that end like this, as its file holds it.
pub fn trace_of(scenario: &Scenario, periods: &[Period], end: &End) -> Vec<u8> {
    let mut writer = TraceWriter::new(Vec::new(), scenario).unwrap();
    for period in periods {
        writer.observe(&period.snapshot, &period.events).unwrap();
    }
    writer.end(end).unwrap();
    writer.finish().unwrap()
}

/// The mission of a scenario over a medium of the test's own, and its network.
pub fn run_over<M: Medium<Message, Point>>(
    scenario: Scenario,
    medium: impl FnOnce(&Site) -> M,
) -> (Mission, Network<M>) {
    let mut network = network_over(&scenario, medium);
    let mut recorder = Recorder::default();
    let scenario = valid(scenario);
    let completed = mission::run_network(&scenario, &mut network, &mut [&mut recorder])
        .expect("a mission without errors");
    (Mission::new(scenario.into_scenario(), recorder, completed), network)
}

/// The network of a scenario over a medium of the test's own.
pub fn network_over<M: Medium<Message, Point>>(
    scenario: &Scenario,
    medium: impl FnOnce(&Site) -> M,
) -> Network<M> {
    let site = Arc::new(Site::new(scenario).expect("a valid site"));
    let medium = medium(&site);
    Network::with_medium(scenario, site, medium).expect("a network")
}

/// Runs a network for at most `periods` control periods with a recorder as the only observer,
/// so that it may start where the monitor refuses and go on where the monitor stops.
pub fn run_unmonitored<M: Medium<Message, Point>>(
    network: &mut Network<M>,
    periods: usize,
) -> (Vec<Period>, Option<End>) {
    let mut recorder = Recorder::default();
    let horizon = network.site().settings.period * periods as f64;
    let executor = Executor::new(horizon, 1_000_000).expect("valid limits");
    let ending = executor.run(network, &mut recorder).expect("a run without errors");
    let end = match ending.reason {
        Reason::Finished(end) => Some(end),
        Reason::Horizon => None,
        other => panic!("the executor stops: {other:?}"),
    };
    (recorder.periods, end)
}

/// A watcher, and an observer, that keeps everything.
#[derive(Debug, Default)]
struct Recorder {
    periods: Vec<Period>,
}

impl Watcher for Recorder {
    fn observe(&mut self, snapshot: &Snapshot, events: &[MissionEvent]) -> io::Result<()> {
        self.periods.push(Period { snapshot: snapshot.clone(), events: events.to_vec() });
        Ok(())
    }
}

impl<M: Medium<Message, Point>> Observer<Network<M>> for Recorder {
    fn flows(&mut self, network: &Network<M>, _: HybridTime, _: f64) -> ControlFlow<End> {
        self.periods.push(Period { snapshot: network.snapshot(), events: network.events() });
        ControlFlow::Continue(())
    }
}

impl Mission {
    fn new(scenario: Scenario, recorder: Recorder, completed: Completed) -> Self {
        let Completed { end, extremes, .. } = completed;
        Mission { scenario, periods: recorder.periods, end, extremes }
    }

    /// The mission as far as control period `last`.
    pub fn up_to(&self, last: usize) -> Self {
        Mission { periods: self.periods[..=last].to_vec(), ..self.clone() }
    }

    /// Its trace, as the file holds it.
    pub fn trace(&self) -> Vec<u8> {
        trace_of(&self.scenario, &self.periods, &self.end)
    }

    /// The number of tasks serviced.
    pub fn serviced(&self) -> usize {
        let serviced = |(_, event): &(usize, &MissionEvent)| {
            matches!(event, MissionEvent::TaskServiced { .. })
        };
        self.events().filter(serviced).count()
    }

    /// Every event with its k, in order.
    pub fn events(&self) -> impl Iterator<Item = (usize, &MissionEvent)> {
        self.periods
            .iter()
            .flat_map(|period| period.events.iter().map(|event| (period.snapshot.step, event)))
    }

    /// The last thing that the observers saw.
    pub fn last(&self) -> &Snapshot {
        &self.periods.last().expect("at least one period").snapshot
    }

    /// The mission as a story: one line an event, and its outcome.
    pub fn story(&self) -> String {
        let mut lines: Vec<_> =
            (self.events()).map(|(k, event)| format!("{k:>4}  {}", story::tell(event))).collect();
        lines.push(format!("      {}", self.end.outcome.name()));
        lines.join("\n")
    }

    /// Says why a mission that should have serviced every task has not.
    pub fn assert_serviced(&self) {
        assert_eq!(
            self.end.outcome,
            Outcome::Serviced,
            "{}: {}",
            self.scenario.name,
            self.end.reason
        );
        assert_eq!(self.serviced(), self.scenario.task.len(), "{}", self.scenario.name);
    }
}
