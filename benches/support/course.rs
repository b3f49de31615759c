//! A mission that is run one control period at a time.

use std::time::{Duration, Instant};

use pleach::automaton::network::record::{End, Snapshot};
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::network::{Network, NetworkError};
use pleach::automaton::node::NodeJump;
use pleach::automaton::{Executor, Round, System};
use pleach::discrete::network::Phase;

/// Far more rounds of jumps than a control period takes.
const ROUND_LIMIT: u32 = 1_000_000;
/// Control periods after which a moment that does not come is given up.
const PATIENCE: usize = 10_000;

/// A mission under way.
pub struct Course {
    scenario: ValidScenario,
    network: Endless,
    period: Executor,
}

/// A network that goes on when its mission has ended: the robots then rest.
struct Endless(Network);

impl System for Endless {
    type Jump = NodeJump;
    type Finish = End;
    type Error = NetworkError;

    fn finished(&self) -> Option<End> {
        None
    }

    fn jump(&mut self, round: &mut Round<'_, NodeJump>) -> Result<(), NetworkError> {
        self.0.jump(round)
    }

    fn time_to_jump(&self) -> Result<Option<f64>, NetworkError> {
        self.0.time_to_jump()
    }

    fn flow(&mut self, duration: f64) -> Result<(), NetworkError> {
        self.0.flow(duration)
    }
}

impl Course {
    /// A mission whose robots are about to make their first move.
    pub fn new(scenario: &ValidScenario) -> Self {
        let network = Network::new(scenario).expect("a network");
        let period = Executor::new(network.site().settings.period, ROUND_LIMIT).expect("a limit");
        let mut course = Course { scenario: scenario.clone(), network: Endless(network), period };
        course.pass_period();
        course
    }

    /// Lets one control period pass: the robots carry out their moves and decide on the next.
    pub fn pass_period(&mut self) {
        self.period.run(&mut self.network, &mut ()).expect("guards that can be evaluated");
    }

    /// Lets control periods pass until a team advances with `members` robots at least; a mission
    /// that has ended begins again.
    pub fn reach_advance(&mut self, members: usize) {
        for _ in 0..PATIENCE {
            if self.advances(members) {
                return;
            }
            if self.rests() {
                *self = Course::new(&self.scenario);
            }
            self.pass_period();
        }
        panic!("no team of {members} robots advances within {PATIENCE} control periods");
    }

    /// Lets control periods pass until the mission has ended and no robot moves.
    pub fn reach_rest(&mut self) {
        for _ in 0..PATIENCE {
            if self.rests() {
                return;
            }
            self.pass_period();
        }
        panic!("the robots do not rest within {PATIENCE} control periods");
    }

    fn rests(&self) -> bool {
        let mut robots = self.network().robots().into_iter();
        robots.all(|robot| robot.phase() == Phase::Ended && !robot.is_active())
    }

    /// The time that a control period takes in which a team advances; those before do not count.
    pub fn time_advance(&mut self, members: usize) -> Duration {
        self.reach_advance(members);
        let begin = Instant::now();
        self.pass_period();
        begin.elapsed()
    }

    fn advances(&self, members: usize) -> bool {
        let network = self.network();
        let moving = network.robots().into_iter().any(|robot| robot.is_active());
        let newest = network.robots().into_iter().max_by_key(|robot| robot.notice_id());
        moving
            && newest.is_some_and(|robot| robot.phase() == Phase::Advance)
            && network.primary_team().len() >= members
    }

    /// The network.
    pub fn network(&self) -> &Network {
        &self.network.0
    }

    /// What observers see now.
    pub fn snapshot(&self) -> Snapshot {
        self.network().snapshot()
    }
}
