//! Campaigns: many configurations explored alike, with what is expected of them.

use std::collections::BTreeMap;
use std::fmt;

use pleach_automaton::network::beacon::Notice;

use super::graphs::{Graph, graphs, numbered_graphs, trees};
use super::medium::{Faults, Medium};
use super::places::{Place, Places, PlacesError};
use super::properties::{ALWAYS, has_ended};
use super::protocol::{Configuration, Protocol, ProtocolError, State};
use super::story::story;
use super::{Action, NodeError};
use crate::exploration::{Exploration, ExplorationError, Fairness, StateId, explore};

/// Which graphs of a number of robots and access points are explored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Graphs {
    /// Every connected one, once for all that are the same but for the robots' numbers.
    UpToSymmetry,
    /// Every connected one, with every numbering.
    Numbered,
    /// A line from the access point.
    Line,
    /// Every tree with the access point as its root, once for all that are the same but for the
    /// robots' numbers.
    Trees,
}

/// All configurations of one kind: on every graph, from every place a branch of every length to
/// every task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Campaign {
    /// What it is called.
    pub name: &'static str,
    /// How many robots there are.
    pub robots: usize,
    /// How many access points there are; lines and trees have one.
    pub access_points: usize,
    /// On which graphs.
    pub graphs: Graphs,
    /// How many tasks there are.
    pub tasks: usize,
    /// How many steps a task may be away from the graph.
    pub steps: &'static [usize],
    /// How messages go.
    pub medium: Medium,
    /// How often a parked robot is in a mover's way.
    pub contacts: u32,
    /// How many configurations there are.
    pub configurations: usize,
    /// How many states they have together.
    pub states: usize,
    /// How many transitions they have together.
    pub transitions: usize,
}

/// What a campaign has come to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// Configurations explored.
    pub configurations: usize,
    /// States of all of them.
    pub states: usize,
    /// Transitions of all of them.
    pub transitions: usize,
    /// The most states of one.
    pub largest: usize,
    /// In how many configurations a mission may end so.
    pub outcomes: BTreeMap<&'static str, usize>,
    /// What fails.
    pub failures: Vec<Failure>,
}

/// A property that fails in a configuration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// The graph and the branches.
    pub configuration: String,
    /// What fails.
    pub property: &'static str,
    /// A shortest way there.
    pub story: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "“{}” fails on {}\n{}", self.property, self.configuration, self.story)
    }
}

/// Why a campaign came to no end.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// A graph is not one to start from.
    #[error(transparent)]
    Places(#[from] PlacesError),
    /// A network cannot be made.
    #[error(transparent)]
    Protocol(#[from] ProtocolError),
    /// An exploration came to no end.
    #[error("{configuration}: {source}")]
    Exploration {
        /// The graph and the branches.
        configuration: String,
        /// Why.
        source: ExplorationError<NodeError>,
    },
}

/// The name under which a mission is reported that neither ends nor says why.
pub const ENDS: &str = "every task is serviced, or the robots say why not";

/// More states of one configuration than this are not visited.
const MOST_STATES: usize = 5_000_000;

impl Campaign {
    /// Explores every configuration.
    ///
    /// # Errors
    /// When one of them has no end.
    pub fn run(&self) -> Result<Findings, CampaignError> {
        let mut findings = Findings::default();
        for graph in self.all_graphs() {
            for branches in self.branches() {
                let places =
                    Places::with_branches(self.robots, self.access_points, &graph, &branches)?;
                let name = format!("graph {graph:?} with branches {branches:?}");
                self.visit(&name, places, &mut findings)?;
            }
        }
        Ok(findings)
    }

    fn all_graphs(&self) -> Vec<Graph> {
        match self.graphs {
            Graphs::UpToSymmetry => graphs(self.robots, self.access_points),
            Graphs::Numbered => numbered_graphs(self.robots),
            Graphs::Trees => trees(self.robots),
            Graphs::Line => vec![(0..self.robots).map(|robot| (robot, robot + 1)).collect()],
        }
    }

    /// Every choice of a branch for each task.
    fn branches(&self) -> Vec<Vec<(Place, usize)>> {
        let one: Vec<(Place, usize)> = (0..self.robots + self.access_points)
            .flat_map(|place| self.steps.iter().map(move |&steps| (place, steps)))
            .collect();
        (0..self.tasks).fold(vec![Vec::new()], |chosen, _| {
            let longer = |chosen: &Vec<_>, &branch| [chosen.as_slice(), &[branch]].concat();
            chosen
                .iter()
                .flat_map(|chosen| one.iter().map(move |branch| longer(chosen, branch)))
                .collect()
        })
    }

    fn visit(
        &self,
        name: &str,
        places: Places,
        findings: &mut Findings,
    ) -> Result<(), CampaignError> {
        let (medium, contacts) = (self.medium, self.contacts);
        let mut protocol = Protocol::new(Configuration { places, medium, contacts })?;
        let exploration = explore(&mut protocol, ALWAYS, MOST_STATES).map_err(|source| {
            CampaignError::Exploration { configuration: name.to_owned(), source }
        })?;
        findings.add(name, &protocol, &exploration);
        Ok(())
    }

    /// Whether there are as many configurations, states and transitions as expected, and nothing
    /// fails.
    pub fn is_met_by(&self, findings: &Findings) -> bool {
        let counts = (findings.configurations, findings.states, findings.transitions);
        counts == (self.configurations, self.states, self.transitions)
            && findings.failures.is_empty()
    }
}

impl Findings {
    fn add(&mut self, name: &str, protocol: &Protocol, exploration: &Exploration<State, Action>) {
        self.configurations += 1;
        self.states += exploration.states().len();
        self.transitions += exploration.transition_count();
        self.largest = self.largest.max(exploration.states().len());
        let mut fail = |property: &'static str, state: StateId| {
            let story = story(protocol, exploration, state);
            self.failures.push(Failure { configuration: name.to_owned(), property, story });
        };
        for violation in exploration.violations() {
            fail(violation.property, violation.state);
        }
        let traps = exploration.traps(|state| has_ended(protocol, state), Fairness::Weak);
        if let Some(&trap) = traps.first() {
            fail(ENDS, trap);
        }
        let ended = |state: &&State| has_ended(protocol, state);
        let mut outcomes: Vec<&'static str> = exploration
            .states()
            .iter()
            .filter(ended)
            .filter_map(|state| match protocol.locals(state).next()?.notice() {
                Notice::Ended { outcome, .. } => Some(outcome.name()),
                _ => None,
            })
            .collect();
        outcomes.sort_unstable();
        outcomes.dedup();
        for outcome in outcomes {
            *self.outcomes.entry(outcome).or_default() += 1;
        }
    }
}

/// Rounds in which all messages arrive, and robots move between any two of them.
const ROUNDS: Medium = rounds(Faults::NONE);
/// One message of a whole mission is lost.
const ONE_LOST: Medium = rounds(Faults { losses: 1, ..Faults::NONE });
/// One message of a whole mission is late.
const ONE_LATE: Medium = rounds(Faults { delays: 1, ..Faults::NONE });
/// A copy of one message of a whole mission arrives later.
const ONE_COPIED: Medium = rounds(Faults { duplicates: 1, ..Faults::NONE });

const fn rounds(faults: Faults) -> Medium {
    Medium::Rounds { faults, period: None }
}

/// The same in control periods: robots move after every so many rounds.
const fn periods(faults: Faults) -> Medium {
    Medium::Rounds { faults, period: Some(ROUNDS_OF_A_PERIOD) }
}

/// How many rounds the control periods have in which two faults are explored.
const ROUNDS_OF_A_PERIOD: u32 = 4;

/// What every test run explores.
pub const QUICK: &[Campaign] = &[
    Campaign {
        name: "two robots, every numbering",
        robots: 2,
        access_points: 1,
        graphs: Graphs::Numbered,
        tasks: 2,
        steps: &[1, 2],
        medium: ROUNDS,
        contacts: 1,
        configurations: 144,
        states: 32_397,
        transitions: 42_527,
    },
    Campaign {
        name: "two robots, nodes in any order",
        robots: 2,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1],
        medium: Medium::NodesInAnyOrder,
        contacts: 1,
        configurations: 9,
        states: 446_584,
        transitions: 1_188_672,
    },
    Campaign {
        name: "three robots",
        robots: 3,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1, 2],
        medium: ROUNDS,
        contacts: 1,
        configurations: 88,
        states: 75_907,
        transitions: 101_244,
    },
    Campaign {
        name: "three robots, a message lost",
        robots: 3,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1],
        medium: ONE_LOST,
        contacts: 0,
        configurations: 44,
        states: 85_327,
        transitions: 166_169,
    },
    Campaign {
        name: "three robots, a message late",
        robots: 3,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1],
        medium: ONE_LATE,
        contacts: 1,
        configurations: 44,
        states: 89_073,
        transitions: 156_021,
    },
    Campaign {
        name: "two robots, a message copied",
        robots: 2,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1, 2],
        medium: ONE_COPIED,
        contacts: 1,
        configurations: 18,
        states: 94_165,
        transitions: 176_664,
    },
    Campaign {
        name: "two robots, two access points",
        robots: 2,
        access_points: 2,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1],
        medium: ROUNDS,
        contacts: 1,
        configurations: 92,
        states: 12_398,
        transitions: 16_448,
    },
];

/// What takes minutes.
pub const THOROUGH: &[Campaign] = &[
    Campaign {
        name: "three robots, every numbering, two tasks",
        robots: 3,
        access_points: 1,
        graphs: Graphs::Numbered,
        tasks: 2,
        steps: &[1, 2],
        medium: ROUNDS,
        contacts: 1,
        configurations: 2432,
        states: 2_360_851,
        transitions: 3_133_011,
    },
    Campaign {
        name: "three robots, a message lost, tasks far and near",
        robots: 3,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1, 2],
        medium: ONE_LOST,
        contacts: 0,
        configurations: 88,
        states: 409_690,
        transitions: 796_021,
    },
    Campaign {
        name: "four robots",
        robots: 4,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1, 2],
        medium: ROUNDS,
        contacts: 1,
        configurations: 580,
        states: 903_335,
        transitions: 1_199_087,
    },
    Campaign {
        name: "four robots, two tasks",
        robots: 4,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 2,
        steps: &[1],
        medium: ROUNDS,
        contacts: 0,
        configurations: 1450,
        states: 390_520,
        transitions: 506_225,
    },
    Campaign {
        name: "five robots",
        robots: 5,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1],
        medium: ROUNDS,
        contacts: 0,
        configurations: 2442,
        states: 435_652,
        transitions: 562_652,
    },
    Campaign {
        name: "six robots in a line",
        robots: 6,
        access_points: 1,
        graphs: Graphs::Line,
        tasks: 1,
        steps: &[1, 2],
        medium: ROUNDS,
        contacts: 1,
        configurations: 14,
        states: 44_043,
        transitions: 64_217,
    },
    Campaign {
        name: "three robots, two access points",
        robots: 3,
        access_points: 2,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1],
        medium: ROUNDS,
        contacts: 0,
        configurations: 810,
        states: 137_200,
        transitions: 182_302,
    },
    Campaign {
        name: "six robots on every tree",
        robots: 6,
        access_points: 1,
        graphs: Graphs::Trees,
        tasks: 1,
        steps: &[1],
        medium: ROUNDS,
        contacts: 0,
        configurations: 336,
        states: 72_006,
        transitions: 93_920,
    },
    Campaign {
        name: "three robots, two messages lost, moves once a period",
        robots: 3,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1],
        medium: periods(Faults { losses: 2, ..Faults::NONE }),
        contacts: 0,
        configurations: 44,
        states: 257_822,
        transitions: 836_024,
    },
    Campaign {
        name: "three robots, two messages late, moves once a period",
        robots: 3,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1],
        medium: periods(Faults { delays: 2, ..Faults::NONE }),
        contacts: 0,
        configurations: 44,
        states: 103_328,
        transitions: 216_713,
    },
    Campaign {
        name: "three robots in contact, a message lost, moves once a period",
        robots: 3,
        access_points: 1,
        graphs: Graphs::UpToSymmetry,
        tasks: 1,
        steps: &[1, 2],
        medium: periods(Faults { losses: 1, ..Faults::NONE }),
        contacts: 1,
        configurations: 88,
        states: 433_543,
        transitions: 787_238,
    },
];
