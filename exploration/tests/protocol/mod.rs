//! The protocol as a state machine, on networks larger than those that are explored.
//!
//! The system under test is the composed [`Protocol`]: the robots and access points themselves, on
//! a random connected graph of places. The reference is the abstract [`Mission`]. Steps are drawn
//! at random, and those that are impossible are skipped; then the network goes on fairly until the
//! mission ends. In every state [`ALWAYS`] holds, and the mission follows.
//!
//! A counterexample is shrunk, and told as a story. For more cases:
//! `PROPTEST_CASES=10000 cargo test --release -p pleach-exploration --test it protocol -- --nocapture`.

mod mission;
mod plan;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Mutex;

use mission::Mission;
use plan::{Plan, Reference, Step};
use pleach_automaton::network::robot::RobotError;
use pleach_exploration::Model;
use pleach_exploration::network::{ALWAYS, Action, ENDS, Protocol, State, has_ended, tell};
use proptest::test_runner::{Config, TestRunner};
use proptest_state_machine::{ReferenceStateMachine, StateMachineTest};

/// A network on its mission.
struct Network {
    protocol: Protocol,
    mission: Mission,
    begin: State,
    way: Vec<(Action, State)>,
    /// How long the way was when each action was taken last.
    taken: BTreeMap<Action, usize>,
}

/// What may happen, and the state that follows.
type Steps = Vec<(Action, State)>;

impl Network {
    fn state(&self) -> &State {
        self.way.last().map_or(&self.begin, |(_, state)| state)
    }

    /// What `find` says may happen now.
    fn steps(&mut self, find: fn(&mut Protocol, &State) -> Result<Steps, RobotError>) -> Steps {
        let state = self.state().clone();
        find(&mut self.protocol, &state).unwrap_or_else(|error| self.fail(&error.to_string()))
    }

    fn take(&mut self, (action, state): (Action, State)) {
        self.way.push((action, state));
        self.taken.insert(action, self.way.len());
        self.check();
    }

    /// Takes the step that has waited for the longest time, so that whatever stays possible is
    /// done at last; returns whether there was one. Contacts need not happen.
    fn go_on(&mut self) -> bool {
        let steps = self.steps(Protocol::faultless_steps).into_iter();
        let owed = steps.filter(|(action, _)| !matches!(action, Action::Touch(_)));
        let next = owed.min_by_key(|(action, _)| self.taken.get(action).copied());
        next.map(|step| self.take(step)).is_some()
    }

    fn check(&mut self) {
        let state = self.state().clone();
        if let Some(broken) = ALWAYS.iter().find(|it| !(it.holds)(&self.protocol, &state)) {
            self.fail(&format!("“{}” fails", broken.name));
        }
        if let Err(broken) = self.mission.follow(&self.protocol, &state) {
            self.fail(&broken);
        }
    }

    fn fail(&self, what: &str) -> ! {
        let way = self.way.iter().map(|(action, state)| (*action, state));
        panic!("{what}\n{}", tell(&self.protocol, &self.begin, way));
    }
}

impl StateMachineTest for Network {
    type SystemUnderTest = Network;
    type Reference = Reference;

    fn init_test(plan: &Plan) -> Network {
        let mut protocol = Protocol::new(plan.configuration()).expect("a plan can be explored");
        let begin = protocol.initial().expect("the network settles").remove(0);
        let mission = Mission::new(plan.tasks());
        let (way, taken) = (Vec::new(), BTreeMap::new());
        let mut network = Network { protocol, mission, begin, way, taken };
        network.check();
        network
    }

    fn apply(mut network: Network, _: &Plan, step: Step) -> Network {
        if let Step::GoOn(steps) = step {
            let _ = (0..steps).all(|_| network.go_on());
            return network;
        }
        let mut found = match step {
            Step::Fail(_) => network.steps(Protocol::faulty_rounds),
            _ => network.steps(Protocol::faultless_steps),
        };
        found.retain(|&(action, _)| step.is_meant_by(action));
        if !found.is_empty() {
            let at = step.choice() % found.len();
            network.take(found.swap_remove(at));
        }
        network
    }

    fn teardown(mut network: Network, plan: Plan) {
        let drawn = network.way.len();
        while !has_ended(&network.protocol, network.state()) {
            if network.way.len() - drawn > plan.longest_mission() || !network.go_on() {
                network.fail(&format!("“{ENDS}” fails"));
            }
        }
        if let Err(broken) = network.mission.conclude(&network.protocol, network.state()) {
            network.fail(&broken);
        }
        TALLY.lock().expect("no thread panics while counting").add(&network);
    }
}

/// What the cases have come to.
struct Tally {
    cases: usize,
    steps: usize,
    longest: usize,
    outcomes: BTreeMap<&'static str, usize>,
}

static TALLY: Mutex<Tally> =
    Mutex::new(Tally { cases: 0, steps: 0, longest: 0, outcomes: BTreeMap::new() });

impl Tally {
    fn add(&mut self, network: &Network) {
        let outcome = network.mission.outcome().map_or("none", |outcome| outcome.name());
        self.cases += 1;
        self.steps += network.way.len();
        self.longest = self.longest.max(network.way.len());
        *self.outcomes.entry(outcome).or_default() += 1;
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Tally { cases, steps, longest, outcomes } = self;
        write!(f, "{cases} missions of {steps} steps, at most {longest}: {outcomes:?}")
    }
}

#[test]
fn the_network_keeps_its_promises() {
    let config = Config {
        failure_persistence: None,
        max_shrink_iters: 10_000,
        max_shrink_time: 60_000,
        ..Config::default()
    };
    let missions = Reference::sequential_strategy(1..=200);
    let found = TestRunner::new(config.clone()).run(&missions, |(plan, steps, seen)| {
        Network::test_sequential(config.clone(), plan, steps, seen);
        Ok(())
    });
    println!("{}", TALLY.lock().expect("no thread panics while counting"));
    if let Err(counterexample) = found {
        panic!("{counterexample}");
    }
}
