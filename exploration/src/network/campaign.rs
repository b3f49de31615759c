//! Campaigns: many configurations explored alike, with what is expected of them.

use std::collections::BTreeMap;
use std::fmt;

use pleach_automaton::network::NamedRow;
use pleach_automaton::network::beacon::Notice;
use pleach_automaton::network::robot::RobotError;
use pleach_automaton::network::scenario::Strategy;
use rayon::prelude::*;

use super::Action;
use super::graphs::{Graph, graphs, numbered_graphs};
use super::medium::Medium;
use super::places::{PlaceGraph, PlaceGraphError, PlaceId};
use super::properties::{ALWAYS, has_ended};
use super::protocol::{Configuration, Protocol, ProtocolError, State};
use super::story::story;
use crate::{ExplorationError, StateGraph, StateId, explore};

/// Which graphs of a number of robots and access points are explored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Graphs {
    /// Every connected one, once for all that are the same but for the robots' numbers.
    UpToSymmetry,
    /// Every connected one, with every numbering.
    Numbered,
    /// A line from the access point.
    Line,
}

/// All configurations of one kind: on every graph, from every place a branch of every length to
/// every task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Campaign {
    /// What it is called.
    pub name: &'static str,
    /// How many robots there are.
    pub robots: usize,
    /// How many access points there are; lines have one.
    pub access_points: usize,
    /// On which graphs.
    pub graphs: Graphs,
    /// How many tasks there are.
    pub tasks: usize,
    /// How many steps a task may be away from where its branch begins.
    pub steps: &'static [usize],
    /// Whether each branch begins at the task before it, and only the first one at a node.
    pub in_a_row: bool,
    /// How messages go.
    pub medium: Medium,
    /// How often a parked robot, or a member of the primary team that stands still, is in a mover's way.
    pub contacts: u32,
    /// When recruits are called for.
    pub strategy: Strategy,
    /// What there is to visit.
    pub expected: Counts,
}

/// How much there is to visit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Configurations.
    pub configurations: usize,
    /// States of all of them.
    pub states: usize,
    /// Transitions of all of them.
    pub transitions: usize,
}

/// What a campaign has come to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Findings {
    /// What was visited.
    pub counts: Counts,
    /// The most states of one.
    pub largest: usize,
    /// In how many configurations a mission may end so.
    pub outcomes: BTreeMap<&'static str, usize>,
    /// In how many configurations some node takes each row of its tables.
    pub rows: BTreeMap<NamedRow, usize>,
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
    PlaceGraph(#[from] PlaceGraphError),
    /// A network cannot be made.
    #[error(transparent)]
    Protocol(#[from] ProtocolError),
    /// An exploration came to no end.
    #[error("{configuration}: {source}")]
    Exploration {
        /// The graph and the branches.
        configuration: String,
        /// Why.
        source: ExplorationError<RobotError>,
    },
}

/// The name under which a mission is reported that neither ends nor reports why.
pub const ENDS: &str = "every task is serviced, or the mission ends with a reason";

/// How many states one configuration may have beyond those expected of the whole campaign before its exploration
/// is abandoned.
const LEEWAY: usize = 100_000;

impl Campaign {
    /// Explores every configuration, on as many threads as there are processors.
    ///
    /// # Errors
    /// When one of them has no end.
    pub fn run(&self) -> Result<Findings, CampaignError> {
        let configurations: Vec<_> = self.configurations().collect::<Result<_, _>>()?;
        let most_states = self.expected.states + LEEWAY;
        let found: Vec<Findings> = configurations
            .into_par_iter()
            .map(|(name, configuration)| Findings::of(&name, configuration, most_states))
            .collect::<Result<_, _>>()?;
        Ok(found.into_iter().fold(Findings::default(), Findings::and))
    }

    /// The configurations, each with a name: every graph with every choice of branches.
    pub fn configurations(
        &self,
    ) -> impl Iterator<Item = Result<(String, Configuration), PlaceGraphError>> + '_ {
        let branches = self.branches();
        self.all_graphs().into_iter().flat_map(move |graph| {
            let branches = branches.clone();
            branches.into_iter().map(move |branches| self.configuration(&graph, &branches))
        })
    }

    fn all_graphs(&self) -> Vec<Graph> {
        match self.graphs {
            Graphs::UpToSymmetry => graphs(self.robots, self.access_points),
            Graphs::Numbered => numbered_graphs(self.robots),
            Graphs::Line => vec![(0..self.robots).map(|robot| (robot, robot + 1)).collect()],
        }
    }

    /// Every choice of a branch for each task.
    fn branches(&self) -> Vec<Vec<(PlaceId, usize)>> {
        let longer = |chosen: Vec<(PlaceId, usize)>| {
            let ends =
                self.starts(&chosen).flat_map(|from| self.steps.iter().map(move |&n| (from, n)));
            ends.map(|branch| [chosen.as_slice(), &[branch]].concat()).collect::<Vec<_>>()
        };
        (0..self.tasks).fold(vec![Vec::new()], |all, _| all.into_iter().flat_map(longer).collect())
    }

    /// Where another branch may begin.
    fn starts(&self, chosen: &[(PlaceId, usize)]) -> std::ops::Range<PlaceId> {
        let nodes = self.robots + self.access_points;
        // The places of branches are numbered in turn, each branch ending with its task.
        let places = nodes + chosen.iter().map(|&(_, steps)| steps).sum::<usize>();
        if self.in_a_row && !chosen.is_empty() { places - 1..places } else { 0..nodes }
    }

    fn configuration(
        &self,
        graph: &Graph,
        branches: &[(PlaceId, usize)],
    ) -> Result<(String, Configuration), PlaceGraphError> {
        let name = format!("graph {graph:?} with branches {branches:?}");
        let places = PlaceGraph::with_branches(self.robots, self.access_points, graph, branches)?;
        let places = places.following(self.strategy);
        let (medium, contacts) = (self.medium, self.contacts);
        Ok((name, Configuration { places, medium, contacts }))
    }

    /// Whether there are as many configurations, states and transitions as expected, and nothing
    /// fails.
    pub fn is_met_by(&self, findings: &Findings) -> bool {
        findings.counts == self.expected && findings.failures.is_empty()
    }
}

impl Findings {
    /// What the exploration of one configuration comes to, which is called `name`.
    ///
    /// # Errors
    /// When the network cannot be made, a robot cannot go on, or there are more than `most_states`.
    pub fn of(
        name: &str,
        configuration: Configuration,
        most_states: usize,
    ) -> Result<Self, CampaignError> {
        let mut protocol = Protocol::new(configuration)?;
        match explore(&mut protocol, ALWAYS, most_states) {
            Ok(exploration) => Ok(Findings::told(name, &protocol, &exploration)),
            Err(source) => {
                Err(CampaignError::Exploration { configuration: name.to_owned(), source })
            }
        }
    }

    fn told(name: &str, protocol: &Protocol, exploration: &StateGraph<State, Action>) -> Self {
        let fail = |property: &'static str, state: StateId| {
            let story = story(protocol, exploration, state);
            Failure { configuration: name.to_owned(), property, story }
        };
        let ended = |state: &State| has_ended(protocol, state);
        let violations = exploration.violations().iter();
        let traps = || exploration.traps(ended, Action::is_optional, protocol.fairness());
        let trap = exploration.is_complete().then(traps).and_then(|traps| traps.first().copied());
        let (states, transitions) = (exploration.states().len(), exploration.transition_count());
        Findings {
            counts: Counts { configurations: 1, states, transitions },
            largest: states,
            outcomes: outcomes(protocol, exploration).map(|outcome| (outcome, 1)).collect(),
            rows: protocol
                .automata()
                .taken()
                .into_iter()
                .map(|(row, times)| (row, usize::from(times > 0)))
                .collect(),
            failures: violations
                .map(|violation| fail(violation.property, violation.state))
                .chain(trap.map(|state| fail(ENDS, state)))
                .collect(),
        }
    }

    /// Both together.
    pub fn and(mut self, other: Findings) -> Self {
        self.counts.configurations += other.counts.configurations;
        self.counts.states += other.counts.states;
        self.counts.transitions += other.counts.transitions;
        self.largest = self.largest.max(other.largest);
        for (outcome, configurations) in other.outcomes {
            *self.outcomes.entry(outcome).or_default() += configurations;
        }
        for (row, configurations) in other.rows {
            *self.rows.entry(row).or_default() += configurations;
        }
        self.failures.extend(other.failures);
        self
    }
}

/// How the missions of a configuration may end.
fn outcomes(
    protocol: &Protocol,
    exploration: &StateGraph<State, Action>,
) -> impl Iterator<Item = &'static str> {
    exploration.states().iter().filter(|state| has_ended(protocol, state)).filter_map(|state| {
        match protocol.locals(state).last()?.notice() {
            Notice::Ended { outcome, .. } => Some(outcome.name()),
            _ => None,
        }
    })
}
