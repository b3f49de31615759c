//! Channels: messages between components.
//!
//! A message is sent in one jump and arrives in another. In between it is in a [`Channel`], which
//! is a component like any other: it has locations (how many messages it holds), a clock and a
//! content for each of them, and takes part in both jumps by labels. So the medium of a
//! composition is data like the rest, and whatever is asked of components is asked of it: checks,
//! diagrams, exploration, temporal logic.
//!
//! In the terms of Lynch, Segala and Vaandrager
//! ([doi:10.1016/S0890-5401(03)00067-1](https://doi.org/10.1016/S0890-5401(03)00067-1)) a send is
//! an output action of the sender and an input action of the channel, an arrival is an output
//! action of the channel and an input action of the receiver. A channel never keeps its sender from
//! sending; and where arrivals have a deadline, the receiver has to take a message in every
//! location.
//!
//! A sensor reports every second, and a logger hears of it a quarter of a second later:
//!
//! ```
//! use pleach_automaton::composition::Channel;
//! use pleach_automaton::{coordinates, from, Automaton, Composition};
//! use pleach_discrete::vocabulary;
//! use pleach_guards::always;
//!
//! vocabulary! {
//!     enum Sensor: Location { Measuring = "measuring" }
//!     enum Logger: Location { Listening = "listening" }
//!     enum Report: Event { Send = "report" }
//!     enum Hear: Event { Hear = "hear" }
//! }
//! coordinates! {
//!     struct Level { level = "x", clock = "τ" }
//!     struct Log { heard = "heard", last = "last" }
//! }
//! use {Logger::Listening, Sensor::Measuring};
//!
//! let Level { level, clock } = Level::coordinates();
//! let sensor = Automaton::starting_in(Measuring)
//!     .initially(Level { level: 0.0, clock: 0.0 })
//!     .flow(Measuring, [level.rate(3.0), clock.rate(1.0)])
//!     .transition(
//!         from(Measuring).on(Report::Send).to(Measuring)
//!             .must(clock.at_least(1.0))
//!             .then(clock.becomes(0.0)),
//!     )
//!     .build()?;
//!
//! let Log { heard, last } = Log::coordinates();
//! let logger = Automaton::starting_in(Listening)
//!     .initially(Log { heard: 0.0, last: 0.0 })
//!     .transition(
//!         from(Listening).on(Hear::Hear).to(Listening).may(always()).then(last.becomes(&heard)),
//!     )
//!     .build()?;
//!
//! let both = Composition::builder()
//!     .add("sensor", &sensor)
//!     .add("logger", &logger)
//!     .channel(
//!         Channel::new("sensor.report", "logger.hear")
//!             .carrying("sensor.x", "logger.heard")
//!             .taking(0.25, 0.25),
//!     )
//!     .build()?;
//! let trajectory = both.run(2.0)?;
//! let jumps: Vec<_> = trajectory.jumps().iter().map(|jump| (jump.at.t, &*jump.label)).collect();
//! assert_eq!(jumps, [(1.0, "sensor.report"), (1.25, "logger.hear"), (2.0, "sensor.report")]);
//! assert_eq!(trajectory.value("logger.last", 1.5), Ok(3.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use pleach_guards::always;

use super::builder::{CompositionBuilder, CompositionError};
use crate::automaton::Automaton;
use crate::coordinates::Coordinate;
use crate::edge::from;
use crate::named::{Name, Record};
use crate::reset::Assignment;

/// Carries the messages of one component to another, in the order in which they are sent; see the
/// [module](self).
#[derive(Clone, Debug, PartialEq)]
#[must_use = "give it to a composition"]
pub struct Channel {
    pub(super) output: String,
    pub(super) inputs: Vec<String>,
    pub(super) name: String,
    contents: Vec<Content>,
    /// The shortest and the longest time that a message takes, in seconds; none if any time.
    delay: Option<(f64, f64)>,
    capacity: usize,
    is_lossy: bool,
    is_lasting: bool,
}

/// A value that messages carry.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Content {
    /// A coordinate of the sender.
    output: String,
    /// An input of the receiver.
    pub(super) input: String,
    /// Where the value of the last arrival is held: what is read before the first.
    initial: Option<f64>,
}

impl Channel {
    /// From the event `output` of a component to the event `input` of a component, both written
    /// `component.event`. It holds one message at a time, which takes [any time](Self::taking): in a run as long as
    /// the policy says, by default until an invariant ends.
    ///
    /// Several channels may have one output, which is then sent on all of them. An input belongs to
    /// one channel.
    pub fn new(output: &str, input: &str) -> Self {
        let inputs = vec![input.to_owned()];
        Channel { inputs, name: format!("{output} → {input}"), ..Channel::holding_last(output) }
    }

    /// From the event `output` of a component, written `component.event`, to [held](Self::held)
    /// values: messages arrive without an event of a receiver, after [any time](Self::taking). The channel is called
    /// after its output.
    ///
    /// A controller samples every 10 ms, and its output, the signal `u`, takes effect a tenth of a second later:
    ///
    /// ```
    /// use pleach_automaton::composition::Channel;
    ///
    /// let delay = Channel::holding_last("controller.sample")
    ///     .held("controller.u", "plant.u", 0.0)
    ///     .taking(0.1, 0.1)
    ///     .holding(11);
    /// ```
    ///
    /// Let `u` be a [signal](crate::Builder::signal) of what the controller measures: values are sent as they are before
    /// the jump, so a coordinate that the sample assigns is sent by the next sample.
    pub fn holding_last(output: &str) -> Self {
        Channel {
            output: output.to_owned(),
            inputs: Vec::new(),
            name: format!("{output} →"),
            contents: Vec::new(),
            delay: None,
            capacity: 1,
            is_lossy: false,
            is_lasting: false,
        }
    }

    /// The messages arrive at the event `input` of a component, too, in the same jump. Then the
    /// arrival has the name of the channel.
    pub fn and_to(mut self, input: &str) -> Self {
        self.inputs.push(input.to_owned());
        self
    }

    /// The channel as a component is called `name`, instead of `output → input` with
    /// its first input.
    pub fn called(mut self, name: &str) -> Self {
        name.clone_into(&mut self.name);
        self
    }

    /// A message carries the value that the sender's coordinate `output` has when it is sent, x⁻;
    /// the receiver reads it as its coordinate `input` in the jump in which the message arrives, and
    /// nowhere else: a message under way cannot be read. Both are written `component.coordinate`.
    pub fn carrying(self, output: &str, input: &str) -> Self {
        self.with_content(output, input, None)
    }

    /// A message carries the value that the sender's coordinate `output` has when it is sent, x⁻, and
    /// the channel holds the value that arrived last, `initial` before the first arrival. The receiver
    /// reads it at any time as its coordinate `input`; in the jump of an arrival it reads the value
    /// before, as of all that a jump changes.
    pub fn held(self, output: &str, input: &str, initial: f64) -> Self {
        self.with_content(output, input, Some(initial))
    }

    fn with_content(mut self, output: &str, input: &str, initial: Option<f64>) -> Self {
        let (output, input) = (output.to_owned(), input.to_owned());
        self.contents.push(Content { output, input, initial });
        self
    }

    /// A message takes at least `shortest` ≥ 0 and at most `longest` seconds, which is finite: with `taking(0.0, 0.0)` it
    /// arrives at the instant at which it is sent. Without bounds it may arrive at any time, or never;
    /// [`check`](crate::Composition::check) reports such a channel.
    pub fn taking(mut self, shortest: f64, longest: f64) -> Self {
        self.delay = Some((shortest, longest));
        self
    }

    /// The channel holds `capacity` messages, from 1 to 512; what is sent when it is full is lost. Of messages that are sent
    /// every T seconds, up to ⌊longest / T⌋ + 1 are under way: [`check`](crate::Composition::check) reports a channel
    /// that holds fewer.
    pub fn holding(mut self, capacity: usize) -> Self {
        self.capacity = capacity;
        self
    }

    /// The oldest message may be lost at any time.
    pub fn losing(mut self) -> Self {
        self.is_lossy = true;
        self
    }

    /// A message stays and may arrive any number of times, until another one takes its place. Such
    /// a channel holds one message, which takes any time.
    pub fn lasting(mut self) -> Self {
        self.is_lasting = true;
        self
    }

    /// The inputs that carry values in the jump of an arrival alone.
    pub(super) fn carried(&self) -> impl Iterator<Item = &str> {
        let carried = self.contents.iter().filter(|content| content.initial.is_none());
        carried.map(|content| &*content.input)
    }

    /// Whether its messages have to arrive in time.
    pub(super) const fn has_deadline(&self) -> bool {
        self.delay.is_some() && !self.is_lasting
    }

    /// How it fails to carry messages that are sent every `period` seconds, if they are sent at even intervals.
    pub(super) fn weakness(&self, period: Option<f64>) -> Option<Weakness> {
        match self.delay {
            _ if self.is_lasting => None,
            None => Some(Weakness::Untimed),
            Some((_, longest)) => {
                let (places, period) = (self.capacity, period?);
                let needed = under_way(longest, period);
                (places < needed).then_some(Weakness::Crowded { places, needed, period, longest })
            }
        }
    }

    /// The channel as a component, with its labels and connections.
    pub(super) fn join(
        &self,
        builder: CompositionBuilder,
        send: &str,
        arrive: &str,
    ) -> Result<CompositionBuilder, CompositionError> {
        let refuse = |reason: &str| {
            let (channel, reason) = (self.name.clone(), reason.to_owned());
            CompositionError::Channel { channel, reason }
        };
        if let Some((shortest, longest)) = self.delay
            && !(0.0 <= shortest && shortest <= longest && longest.is_finite())
        {
            return Err(refuse(&format!(
                "its messages take from {shortest} s to {longest} s: the shortest time has to be at least 0, and \
                 the longest finite and no less"
            )));
        }
        if !(1..=PLACES).contains(&self.capacity) {
            return Err(refuse(&format!(
                "it holds {} messages, and has to hold from 1 to {PLACES}: with a longer period or a shorter \
                 delay, fewer are under way",
                self.capacity
            )));
        }
        let is_nan = |content: &&Content| content.initial.is_some_and(f64::is_nan);
        if let Some(Content { input, .. }) = self.contents.iter().find(is_nan) {
            return Err(refuse(&format!(
                "`{input}` is NaN before the first arrival: it has to be a number"
            )));
        }
        if self.inputs.is_empty() && self.carried().next().is_some() {
            return Err(refuse("without an event of the receiver, what is carried has to be held"));
        }
        if self.is_lasting && (self.delay.is_some() || self.capacity > 1) {
            return Err(refuse("one message that stays takes any time"));
        }
        let automaton = Machine::of(self, send, arrive)
            .build()
            .map_err(|source| refuse(&source.to_string()))?;
        let mut builder = builder.add_joint(&self.name, &automaton).label(send);
        if !self.inputs.is_empty() {
            builder = builder.label(arrive);
        }
        for (number, Content { output, input, initial }) in self.contents.iter().enumerate() {
            let read = if initial.is_some() { held(number) } else { content(number, 0) };
            builder = builder
                .connect(output, &format!("{}.{}", self.name, sent(number)))
                .connect(&format!("{}.{read}", self.name), input);
        }
        Ok(builder)
    }
}

/// How many messages a channel may hold: each has its own clock, and each number of them a location.
pub(crate) const PLACES: usize = 512;

/// Why a channel does not carry all messages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Weakness {
    /// It has fewer places than messages can be under way.
    Crowded {
        places: usize,
        needed: usize,
        /// Of the sender, in seconds.
        period: f64,
        /// The longest time that a message takes, in seconds.
        longest: f64,
    },
    /// Nothing says when they arrive.
    Untimed,
}

/// ⌊`longest` / `period`⌋ + 1. A message that is sent while another arrives may come first, also where rounding alone
/// puts it later.
fn under_way(longest: f64, period: f64) -> usize {
    const ROUNDING: f64 = 4.0 * f64::EPSILON;
    let sent = longest / period * (1.0 + ROUNDING);
    (sent as usize).saturating_add(1)
}

/// The input by which a channel reads what is sent.
fn sent(number: usize) -> String {
    format!("sent {}", number + 1)
}

/// The content of a message, the oldest at place 0.
fn content(number: usize, place: usize) -> String {
    format!("content {} of {}", number + 1, place + 1)
}

/// The content of the message that arrived last.
fn held(number: usize) -> String {
    format!("held {}", number + 1)
}

/// The time for which a message has been under way.
fn age(place: usize) -> String {
    format!("age of {}", place + 1)
}

/// The automaton of a channel: in the location `n` it holds n messages, the oldest first.
struct Machine<'a> {
    channel: &'a Channel,
    send: Name,
    arrive: Name,
    state: Vec<(String, f64)>,
}

impl<'a> Machine<'a> {
    fn of(channel: &'a Channel, send: &str, arrive: &str) -> Self {
        let contents = 0..channel.contents.len();
        let mut state: Vec<String> = contents.clone().map(sent).collect();
        for place in 0..channel.capacity {
            state.extend(contents.clone().map(|number| content(number, place)));
            state.extend(channel.delay.map(|_| age(place)));
        }
        let mut state: Vec<_> = state.into_iter().map(|name| (name, 0.0)).collect();
        let initial = |(number, content): (usize, &Content)| Some((held(number), content.initial?));
        state.extend(channel.contents.iter().enumerate().filter_map(initial));
        Machine { channel, send: Name::new(send), arrive: Name::new(arrive), state }
    }

    fn build(&self) -> Result<Automaton<Name, Name, Record>, Box<dyn std::error::Error>> {
        let Machine { channel, send, arrive, .. } = *self;
        let holding = |messages: usize| Name::new(&messages.to_string());
        let mut automaton = Automaton::<Name, Name, Record>::starting_in(holding(0))
            .initially(Record::new(self.state.iter().map(|(name, value)| (name, *value)))?);
        for held in 0..=channel.capacity {
            let here = holding(held);
            if channel.delay.is_some() {
                let ages = (0..held).map(|place| self.variable(&age(place)).rate(1.0));
                automaton = automaton.flow(here, ages.collect::<Vec<_>>());
            }
            let sending = match held < channel.capacity {
                true => {
                    from(here).on(send).to(holding(held + 1)).may(always()).then(self.put(held))
                }
                false if channel.is_lasting => {
                    from(here).on(send).to(here).may(always()).then(self.put(0))
                }
                false => from(here).on(send).to(here).may(always()),
            };
            automaton = automaton.transition(sending);
            if held == 0 {
                continue;
            }
            let arrival = from(here).on(arrive);
            automaton = match channel.delay {
                None if channel.is_lasting => {
                    automaton.transition(arrival.to(here).may(always()).then(self.hold()))
                }
                None => {
                    let arrival = arrival.to(holding(held - 1)).may(always());
                    automaton.transition(arrival.then(self.arrive(held)))
                }
                Some((shortest, longest)) => {
                    let (age, arrival) = (self.variable(&age(0)), arrival.to(holding(held - 1)));
                    let late = arrival.must(age.at_least(longest)).then(self.arrive(held));
                    let early = age.at_least(shortest) & age.less_than(longest);
                    let early = arrival.may(early).then(self.arrive(held)).priority(1);
                    let automaton = automaton.transition(late);
                    if shortest < longest { automaton.transition(early) } else { automaton }
                }
            };
            if channel.is_lossy {
                let lost = from(here).on(Name::new("lose")).to(holding(held - 1)).may(always());
                automaton = automaton.transition(lost.then(self.take(held)));
            }
        }
        Ok(automaton.build()?)
    }

    fn variable(&self, name: &str) -> Coordinate<Record> {
        Coordinate::new(crate::named::kept(name))
    }

    /// A message is put at `place`.
    fn put(&self, place: usize) -> Vec<Assignment<Record>> {
        let contents = 0..self.channel.contents.len();
        contents
            .map(|number| {
                self.variable(&content(number, place)).becomes(self.variable(&sent(number)))
            })
            .chain(self.channel.delay.map(|_| self.variable(&age(place)).becomes(0.0)))
            .collect()
    }

    /// The oldest of `held` messages arrives.
    fn arrive(&self, held: usize) -> Vec<Assignment<Record>> {
        self.hold().into_iter().chain(self.take(held)).collect()
    }

    /// What is held becomes what the oldest message says.
    fn hold(&self) -> Vec<Assignment<Record>> {
        let contents = self.channel.contents.iter().enumerate();
        let held_ones = contents.filter(|(_, content)| content.initial.is_some());
        held_ones
            .map(|(number, _)| {
                self.variable(&held(number)).becomes(self.variable(&content(number, 0)))
            })
            .collect()
    }

    /// The oldest of `held` messages is taken away, and the others move up.
    fn take(&self, held: usize) -> Vec<Assignment<Record>> {
        let contents = self.channel.contents.len();
        let names = |place: usize| {
            let ages = self.channel.delay.map(|_| age(place));
            (0..contents).map(move |number| content(number, place)).chain(ages)
        };
        let moved = (1..held).flat_map(|place| {
            let pairs = names(place - 1).zip(names(place));
            pairs.map(|(to, from)| self.variable(&to).becomes(self.variable(&from)))
        });
        let emptied = names(held - 1).map(|name| self.variable(&name).becomes(0.0));
        moved.chain(emptied).collect()
    }
}
