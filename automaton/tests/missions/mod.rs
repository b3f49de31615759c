//! Missions of a few robots, each with something for particular rules to decide, and judged by the
//! definitions: `pleach_verify` derives from what a mission shows whether all that must hold did.
//!
//! What robots decided, event by event, is in `tests/snapshots`: who leads, who is recruited along which
//! path, who exchanges duties with whom.

mod best_routes;
mod composed;
mod decisions;
mod faults;
mod routes;
mod story;

use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;

use pleach_automaton::network::Network;
use pleach_automaton::network::record::{End, Faults, MissionEvent, Outcome};
use pleach_automaton::network::scenario::{Scenario, ValidScenario};
use pleach_automaton::{Executor, HybridTime, Observer, Reason};
use pleach_discrete::network::activity::may_follow;
use pleach_verify::network::{Extremes, Referee, Violation};

/// Only a cycle of jumps that takes no time reaches it.
const JUMPS_PER_PERIOD: u32 = 1_000_000;

/// A mission that has ended, with all that was seen of it.
struct Mission {
    /// The control periods that it took.
    periods: usize,
    events: Vec<MissionEvent>,
    end: End,
    extremes: Extremes,
}

/// The scenario of a file, by its path from the root of the workspace.
fn scenario(path: &str) -> Scenario {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path).with_extension("toml");
    let text = std::fs::read_to_string(&path).expect("it can be read");
    toml::from_str(&text).expect("it is a scenario")
}

/// The scenario, from which a mission can start.
fn valid(scenario: Scenario) -> ValidScenario {
    ValidScenario::new(scenario).unwrap_or_else(|invalid| panic!("{invalid}"))
}

/// The mission of a scenario, in which no property may be broken.
#[track_caller]
fn run(scenario: Scenario) -> Mission {
    let scenario = valid(scenario);
    let mut network = Network::new(&scenario).expect("its automata are well formed");
    let settings = network.site().settings;
    let horizon = settings.period * (settings.max_steps as f64 + 1.0);
    let referee = Referee::new(&scenario, Faults::default(), may_follow);
    let mut jury = Jury { referee, periods: 0, events: Vec::new(), violation: None };
    let executor = Executor::new(horizon, JUMPS_PER_PERIOD).expect("there is time");
    let ending = executor.run(&mut network, &mut jury).expect("robots go on");
    let (Reason::Finished(end) | Reason::Interrupted(end)) = ending.reason else {
        panic!("{}: the executor stops: {:?}", scenario.name, ending.reason);
    };
    let Jury { referee, periods, events, violation } = jury;
    let given_up = events.iter().filter_map(|event| match *event {
        MissionEvent::TaskGivenUp { task, .. } => Some(task),
        _ => None,
    });
    let tasks: BTreeSet<usize> = given_up.collect();
    let end = End { certificate: referee.account(&end), tasks: tasks.into_iter().collect(), ..end };
    if let Some(violation) = violation.or_else(|| referee.conclude(&end).err()) {
        panic!("{}: {violation}", scenario.name);
    }
    Mission { periods, events, end, extremes: referee.extremes().clone() }
}

/// Looks on, and stops a mission that breaks a property.
struct Jury<'a> {
    referee: Referee<'a>,
    periods: usize,
    events: Vec<MissionEvent>,
    violation: Option<Violation>,
}

impl Observer<Network> for Jury<'_> {
    const SEES_JUMPS: bool = false;

    fn flows(&mut self, network: &Network, _: HybridTime, _: f64) -> ControlFlow<End> {
        let snapshot = network.snapshot();
        let events = self.referee.explain(&snapshot, &network.events());
        self.violation = self.referee.observe(&snapshot, &events).err();
        self.periods = snapshot.step + 1;
        self.events.extend(events);
        match self.violation {
            None => ControlFlow::Continue(()),
            Some(_) => ControlFlow::Break(End::at_step_limit(snapshot.step)),
        }
    }
}

impl Mission {
    /// Every task is serviced, in at most this many control periods.
    #[track_caller]
    fn services_all_within(&self, periods: usize) {
        assert_eq!(self.end.outcome, Outcome::Serviced, "{}", self.end.reason);
        let taken = self.periods;
        assert!(taken <= periods, "it takes {taken} control periods, and {periods} are enough");
    }
}
