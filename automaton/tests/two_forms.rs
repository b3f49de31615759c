//! One model as a composition of automata with channels and as an ensemble of nodes with a medium:
//! both give one trace.
//!
//! Nodes in a ring have clocks of unlike rates. Every period a node sends its reading to its
//! successor; a node that receives a greater reading adopts it, so that all follow the fastest clock.
//! Messages that take no time are passed on until they have gone round the ring.
//!
//! All numbers are multiples of powers of two, so that instants and readings are exact, and nodes
//! often jump at the same instant. Such jumps have no order in either form; so the trace of each node
//! is compared. Messages with a delay never arrive when a clock is due: an ensemble then delivers
//! first, and in a composition the order of the components decides.

use std::collections::VecDeque;
use std::convert::Infallible;

use pleach_automaton::composition::Channel;
use pleach_automaton::node::{
    Delivery, Destination, Ensemble, Envelope, Input, Medium, Node, NodeId, Observed, Outputs,
};
use pleach_automaton::{Automaton, Composition, Executor, Reason, coordinates, from};
use pleach_discrete::vocabulary;
use pleach_guards::always;
use proptest::prelude::*;

/// A node of the ring, with its channel to the next.
#[derive(Clone, Copy, Debug)]
struct Station {
    /// Of its clock, in seconds per second.
    rate: f64,
    /// Between its messages, in seconds.
    period: f64,
    /// Of its messages, in seconds.
    delay: f64,
}

/// How often a message is passed on.
fn hops(ring: &[Station]) -> usize {
    if ring.iter().all(|station| station.delay == 0.0) { ring.len() - 1 } else { 0 }
}

/// When a node does what, and what its clock reads after it.
type Step = (f64, Kind, f64);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Tells,
    Hears,
}

const HORIZON: f64 = 12.0;
/// Far more messages than a channel ever holds.
const CAPACITY: usize = 16;

// ---- Automata and channels ---------------------------------------------------------------------

vocabulary! {
    enum Duty: Location { Resting = "resting", Passing = "passing" }
    enum Action: Event { Tell = "tell", Hear = "hear" }
}

coordinates! {
    struct State { clock = "C", timer = "τ", hops = "h", reading = "C′", left = "h′" }
}

fn automaton(station: Station, most: usize) -> Automaton<Duty, Action, State> {
    use Duty::{Passing, Resting};
    let most = most as f64;
    let State { clock, timer, hops, reading, left } = State::coordinates();
    let mut automaton = Automaton::starting_in(Resting)
        .initially(State { hops: most, ..State::default() })
        .flow(Resting, [clock.rate(station.rate), timer.rate(1.0)])
        .flow(Passing, [clock.rate(station.rate), timer.rate(1.0)]);
    for place in [Resting, Passing] {
        let take_over = || clock.becomes(clock.max(&reading));
        let hear = |target| from(place).on(Action::Hear).to(target);
        let pass_on = [take_over(), hops.becomes(&left - 1.0)];
        automaton = automaton
            .transition(hear(Passing).may(left.at_least(1.0)).then(pass_on))
            .transition(hear(place).may(always()).then(take_over()));
    }
    automaton
        .transition(
            from(Passing).on(Action::Tell).to(Resting).must(always()).then(hops.becomes(most)),
        )
        .transition(
            from(Resting)
                .on(Action::Tell)
                .to(Resting)
                .must(timer.at_least(station.period))
                .then(timer.becomes(0.0)),
        )
        .build()
        .expect("the automaton is sound")
}

fn composition(ring: &[Station]) -> Composition {
    let mut parts = Composition::builder();
    for (id, &station) in ring.iter().enumerate() {
        parts = parts.add(&id.to_string(), &automaton(station, hops(ring)));
    }
    for (id, station) in ring.iter().enumerate() {
        let next = (id + 1) % ring.len();
        let channel = Channel::new(&format!("{id}.tell"), &format!("{next}.hear"))
            .carrying(&format!("{id}.C"), &format!("{next}.C′"))
            .carrying(&format!("{id}.h"), &format!("{next}.h′"))
            .taking(station.delay, station.delay)
            .holding(CAPACITY);
        parts = parts.channel(channel);
    }
    parts.build().expect("the parts fit")
}

/// What each node does in a run of the composition.
fn steps_of_automata(ring: &[Station]) -> Vec<Vec<Step>> {
    let trajectory = composition(ring).run(HORIZON).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    let clock = |id: usize| {
        let name = format!("{id}.C");
        trajectory.variables().iter().position(|variable| *variable == name).expect("its clock")
    };
    let clocks: Vec<usize> = (0..ring.len()).map(clock).collect();
    let mut steps = vec![Vec::new(); ring.len()];
    for (jump, after) in trajectory.jumps().iter().zip(trajectory.intervals().skip(1)) {
        let (node, step) = jump.label.split_once('.').expect("node and event");
        let id: usize = node.parse().expect("a number");
        let kind = if step == "tell" { Kind::Tells } else { Kind::Hears };
        steps[id].push((jump.at.t, kind, after.samples[0].values[clocks[id]]));
    }
    steps
}

// ---- Nodes and a medium ------------------------------------------------------------------------

/// A reading, and how often it is to be passed on.
#[derive(Clone, Copy, Debug)]
struct Reading {
    clock: f64,
    hops: usize,
}

struct ClockNode {
    station: Station,
    next: NodeId,
    most: usize,
    clock: f64,
    timer: f64,
    /// What is left of the way of a message that is to be passed on.
    passing: Option<usize>,
    now: f64,
    steps: Vec<Step>,
}

impl Node for ClockNode {
    type Message = Reading;
    type Sense = Infallible;
    type Report = Infallible;
    type Body = ();
    type Error = Infallible;

    fn step(
        &mut self,
        input: Input<'_, Reading, Infallible>,
        outputs: &mut Outputs<Reading, Infallible>,
    ) -> Result<(), Infallible> {
        let kind = match input {
            Input::Heard { message, .. } => {
                self.clock = self.clock.max(message.clock);
                self.passing = message.hops.checked_sub(1).or(self.passing);
                Kind::Hears
            }
            Input::Tick { .. } => {
                let hops = self.passing.take().unwrap_or_else(|| {
                    self.timer = 0.0;
                    self.most
                });
                outputs.send(self.next, Reading { clock: self.clock, hops });
                Kind::Tells
            }
        };
        self.steps.push((self.now, kind, self.clock));
        Ok(())
    }

    fn time_to_tick(&self) -> Option<f64> {
        let left = (self.station.period - self.timer).max(0.0);
        Some(if self.passing.is_some() { 0.0 } else { left })
    }

    fn flow(&mut self, duration: f64) {
        self.clock += self.station.rate * duration;
        self.timer += duration;
        self.now += duration;
    }

    fn body(&self) {}
}

impl Observed for ClockNode {
    type View<'a> = &'a [Step];

    fn view(&self) -> &[Step] {
        &self.steps
    }
}

/// Messages take a time that depends on their sender.
struct Delays {
    delays: Vec<f64>,
    /// With the time that is left.
    in_flight: VecDeque<(f64, Envelope<Reading>)>,
}

impl Medium<Reading, ()> for Delays {
    fn update(&mut self, _: &[()]) {}

    fn send(&mut self, envelope: Envelope<Reading>) {
        self.in_flight.push_back((self.delays[envelope.from], envelope));
    }

    fn time_to_arrival(&self) -> Option<f64> {
        self.in_flight.iter().map(|(left, _)| *left).reduce(f64::min)
    }

    fn flow(&mut self, duration: f64) {
        self.in_flight.iter_mut().for_each(|(left, _)| *left -= duration);
    }

    fn deliver<E>(
        &mut self,
        mut hand_over: impl FnMut(Delivery<'_, Reading>) -> Result<(), E>,
    ) -> Result<(), E> {
        let (due, later) = self.in_flight.drain(..).partition(|(left, _)| *left <= 0.0);
        self.in_flight = later;
        VecDeque::into_iter(due).try_for_each(|(_, Envelope { from, to, message })| match to {
            Destination::One(to) => hand_over(Delivery { from, to, message: &message }),
            Destination::Everyone => unreachable!("nodes tell their successors"),
        })
    }
}

/// What each node does in a run of the ensemble.
fn steps_of_nodes(ring: &[Station]) -> Vec<Vec<Step>> {
    let clocks = ring.iter().enumerate().map(|(id, &station)| ClockNode {
        station,
        next: (id + 1) % ring.len(),
        most: hops(ring),
        clock: 0.0,
        timer: 0.0,
        passing: None,
        now: 0.0,
        steps: Vec::new(),
    });
    let delays = ring.iter().map(|station| station.delay).collect();
    let medium = Delays { delays, in_flight: VecDeque::new() };
    let mut ensemble = Ensemble::new(clocks.collect(), medium);
    let executor = Executor::new(HORIZON, 1000).expect("a horizon");
    let ending = executor.run(&mut ensemble, &mut ()).expect("nothing can fail");
    assert_eq!(ending.reason, Reason::Horizon);
    ensemble.views().map(<[Step]>::to_vec).collect()
}

// ---- The comparison ----------------------------------------------------------------------------

/// The run is worth comparing: messages are sent, and heard.
fn shows_something(steps: &[Vec<Step>]) -> bool {
    let kinds = |kind| steps.iter().flatten().filter(move |step| step.1 == kind).count();
    kinds(Kind::Tells) > 0 && kinds(Kind::Hears) > 0
}

fn stations(delay: impl Strategy<Value = f64>) -> impl Strategy<Value = Vec<Station>> {
    let eighths = |from: u32, to: u32| (from..=to).prop_map(|eighths| f64::from(eighths) / 8.0);
    let station = (eighths(4, 12), eighths(4, 20), delay)
        .prop_map(|(rate, period, delay)| Station { rate, period, delay });
    prop::collection::vec(station, 2..=5)
}

proptest! {
    #![proptest_config(cases::usually(64))]

    #[test]
    fn messages_with_delays(ring in stations((0..=16_u32).prop_map(|n| f64::from(2 * n + 1) / 16.0))) {
        let steps = steps_of_automata(&ring);
        prop_assert!(shows_something(&steps));
        prop_assert_eq!(steps, steps_of_nodes(&ring));
    }

    #[test]
    fn messages_that_take_no_time(ring in stations(Just(0.0))) {
        let steps = steps_of_automata(&ring);
        prop_assert!(shows_something(&steps));
        prop_assert_eq!(steps, steps_of_nodes(&ring));
    }
}

/// Whatever the order of the nodes, a node whose clock is due sends what it has just received.
#[test]
fn an_ensemble_delivers_before_clocks_tick() {
    let [slow, fast] = [0.5, 1.5].map(|rate| Station { rate, period: 1.0, delay: 1.0 });
    for (ring, slow) in [([slow, fast], 0), ([fast, slow], 1)] {
        let steps = &steps_of_nodes(&ring)[slow];
        let expected = [
            (1.0, Kind::Tells, 0.5),
            (2.0, Kind::Hears, 1.5),
            (2.0, Kind::Tells, 1.5),
            (3.0, Kind::Hears, 3.0),
            (3.0, Kind::Tells, 3.0),
        ];
        assert_eq!(steps[..expected.len()], expected);
    }
}
