//! Random networks, and what may happen in them.

use pleach_exploration::network::{
    Action, Configuration, Faults, Graph, Medium, PlaceGraph, PlaceId,
};
use proptest::prelude::*;
use proptest::sample::{Index, select};
use proptest_state_machine::ReferenceStateMachine;

/// The largest network: its places are still farther apart than a robot sees of its task.
const MOST_ROBOTS: usize = 8;
const MOST_ACCESS_POINTS: usize = 2;
const MOST_TASKS: usize = 4;
/// How many steps a task may be away from the graph of the nodes.
const LONGEST_BRANCH: usize = 4;
/// How often a parked robot may be in a mover's way.
const MOST_CONTACTS: u32 = 3;

/// A network to send on its mission.
#[derive(Clone, Debug)]
pub struct Plan {
    robots: usize,
    access_points: usize,
    graph: Graph,
    branches: Vec<(PlaceId, usize)>,
    medium: Medium,
    contacts: u32,
}

impl Plan {
    /// The network as it is explored.
    pub fn configuration(&self) -> Configuration {
        let Plan { robots, access_points, graph, branches, medium, contacts } = self;
        let places = PlaceGraph::with_branches(*robots, *access_points, graph, branches);
        Configuration {
            places: places.expect("a plan is a connected graph"),
            medium: *medium,
            contacts: *contacts,
        }
    }

    /// How many tasks there are.
    pub fn tasks(&self) -> usize {
        self.branches.len()
    }

    /// More steps than a mission takes that goes on fairly.
    ///
    /// For each task a notice goes round at most three times for every robot that is recruited or
    /// released, and three times more. Before the next notice each robot passes every place at most
    /// once, and the network plays a few rounds for each node: for the news to come everywhere,
    /// for the two waits of an election, and for each subgroup to set out and to arrive.
    pub fn longest_mission(&self) -> usize {
        let nodes = self.robots + self.access_points;
        let places = nodes + self.branches.iter().map(|&(_, steps)| steps).sum::<usize>();
        let words = 1 + self.tasks() * 3 * (self.robots + 2);
        let rounds = nodes * (6 + 2 * self.robots);
        let steps_of_a_round = match self.medium {
            Medium::Rounds { .. } | Medium::Periods { .. } => 1,
            Medium::NodesInAnyOrder => nodes,
            Medium::MessagesInAnyOrder => nodes * nodes,
        };
        words * (self.robots * places + rounds * steps_of_a_round)
    }
}

/// How large a network is, and how its messages go.
#[derive(Clone, Copy, Debug)]
struct Kind {
    robots: usize,
    access_points: usize,
    medium: Medium,
    contacts: u32,
}

/// No message fails: any size, in rounds or one node at a time. A robot that hears nothing for any time in
/// the middle of an exchange of duties may be left behind: then no robot is in another's way.
fn faultless() -> impl Strategy<Value = Kind> {
    let rounds = |period| Medium::Rounds { faults: Faults::NONE, period };
    let medium = prop_oneof![
        3 => Just(rounds(None)),
        1 => (1_u32..=8).prop_map(move |period| rounds(Some(period))),
        1 => Just(Medium::NodesInAnyOrder),
    ];
    (2..=MOST_ROBOTS, 1..=MOST_ACCESS_POINTS, medium, 0..=MOST_CONTACTS).prop_map(
        |(robots, access_points, medium, contacts)| {
            let contacts = if medium == Medium::NodesInAnyOrder { 0 } else { contacts };
            Kind { robots, access_points, medium, contacts }
        },
    )
}

/// One message at a time: as many robots that none can attach to another that is attached to it.
fn message_by_message() -> impl Strategy<Value = Kind> {
    let medium = Medium::MessagesInAnyOrder;
    (2..=3_usize, 1..=MOST_ACCESS_POINTS, 0..=MOST_CONTACTS).prop_map(
        move |(robots, access_points, contacts)| Kind { robots, access_points, medium, contacts },
    )
}

/// The faults that are explored, see `docs/exploration.md`, for the most robots they are.
fn faulty() -> impl Strategy<Value = Kind> {
    let lost = |losses| Faults { losses, ..Faults::NONE };
    let late = |delays| Faults { delays, ..Faults::NONE };
    let copied = Faults { duplicates: 1, ..Faults::NONE };
    let explored = [
        (4, lost(1), None, 0),
        (4, late(1), None, 1),
        (3, copied, None, 1),
        (4, copied, None, 0),
        (4, lost(1), Some(4), 1),
        (3, lost(2), Some(4), 1),
        (4, lost(2), Some(4), 0),
        (3, late(2), Some(4), 0),
    ];
    select(explored.to_vec()).prop_map(|(robots, faults, period, contacts)| Kind {
        robots,
        access_points: 1,
        medium: Medium::Rounds { faults, period },
        contacts,
    })
}

/// A connected graph: each node is attached to one that comes before it in some order, and there are a
/// few more edges.
fn graph(kind: Kind) -> impl Strategy<Value = Graph> {
    let nodes = kind.robots + kind.access_points;
    let order = Just((0..nodes).collect::<Vec<_>>()).prop_shuffle();
    let before = prop::collection::vec(any::<Index>(), nodes - 1);
    let more = prop::collection::vec((0..nodes, 0..nodes), 0..=nodes / 2);
    (order, before, more).prop_map(|(order, before, more)| {
        let tree = before.iter().enumerate().map(|(at, before)| {
            let parent = before.index(at + 1);
            (order[at + 1], order[parent])
        });
        let more = more.into_iter().filter(|(a, b)| a != b);
        tree.chain(more).collect()
    })
}

fn plan(kind: Kind) -> impl Strategy<Value = Plan> {
    let Kind { robots, access_points, medium, contacts } = kind;
    let branch = (0..robots + access_points, 1..=LONGEST_BRANCH);
    let branches = prop::collection::vec(branch, 1..=MOST_TASKS);
    (graph(kind), branches).prop_map(move |(graph, branches)| Plan {
        robots,
        access_points,
        graph,
        branches,
        medium,
        contacts,
    })
}

/// A step that is taken if it is possible; the number chooses among those of its kind, which are
/// counted round and round.
#[derive(Clone, Copy, Debug)]
pub enum Step {
    /// Somebody hears something.
    Hear(usize),
    /// A robot comes to the next place on its way.
    Move(usize),
    /// A parked robot does not let a mover pass.
    Touch(usize),
    /// A message fails.
    Fail(usize),
    /// The user speaks, or a control period begins.
    Wait(usize),
    /// The network goes on by itself for this many steps.
    GoOn(usize),
}

impl Step {
    /// Whether this step may be that action.
    pub const fn is_meant_by(self, action: Action) -> bool {
        match action {
            Action::Round | Action::Listen(_) | Action::Hear { .. } | Action::Deliberate(_) => {
                matches!(self, Step::Hear(_))
            }
            Action::Move(_) => matches!(self, Step::Move(_)),
            Action::Touch(_) => matches!(self, Step::Touch(_)),
            Action::Period | Action::Announce => matches!(self, Step::Wait(_)),
            Action::Lose { .. }
            | Action::Delay { .. }
            | Action::Copy { .. }
            | Action::Echo { .. }
            | Action::Stop(_)
            | Action::Restart(_) => {
                matches!(self, Step::Fail(_))
            }
        }
    }

    /// Which of the actions that it may be.
    pub const fn choice(self) -> usize {
        match self {
            Step::Hear(choice)
            | Step::Move(choice)
            | Step::Touch(choice)
            | Step::Fail(choice)
            | Step::Wait(choice)
            | Step::GoOn(choice) => choice,
        }
    }
}

/// The longest stretch without a choice.
const LONGEST_STRETCH: usize = 60;

/// Chooses among more steps of a kind than are ever possible at once.
fn choice() -> impl Strategy<Value = usize> {
    0..1000_usize
}

/// Draws a plan and steps; the rest of the reference is the [`Mission`](super::mission::Mission).
pub struct Reference;

impl ReferenceStateMachine for Reference {
    type State = Plan;
    type Transition = Step;

    fn init_state() -> BoxedStrategy<Plan> {
        prop_oneof![
            4 => faultless().boxed(),
            1 => message_by_message().boxed(),
            2 => faulty().boxed(),
        ]
        .prop_flat_map(plan)
        .boxed()
    }

    fn transitions(_: &Plan) -> BoxedStrategy<Step> {
        prop_oneof![
            6 => choice().prop_map(Step::Hear),
            4 => choice().prop_map(Step::Move),
            1 => choice().prop_map(Step::Touch),
            1 => choice().prop_map(Step::Fail),
            2 => choice().prop_map(Step::Wait),
            2 => (1..=LONGEST_STRETCH).prop_map(Step::GoOn),
        ]
        .boxed()
    }

    fn apply(plan: Plan, _: &Step) -> Plan {
        plan
    }
}
