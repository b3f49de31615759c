//! The semantics of channels, as `docs/semantics.md` states it, clause by clause.

use pleach_automaton::check::{Finding, Kind};
use pleach_automaton::composition::{Channel, CompositionBuilder, CompositionError};
use pleach_automaton::{
    Automaton, Composition, Policy, Reason, Settings, Trajectory, coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::{Valuation, always};

vocabulary! {
    enum Sender: Location { Sending = "sending" }
    enum Receiver: Location { Listening = "listening", Deaf = "deaf" }
    enum Say: Event { Tell = "tell" }
    enum Hear: Event { Hear = "hear", Leave = "leave" }
}
use Receiver::{Deaf, Listening};
use Sender::Sending;

coordinates! {
    struct Source { clock = "τ", value = "x" }
    struct Target { heard = "m", last = "last", count = "n" }
}

/// Tells its value every `period` seconds; the value counts what has been told.
fn sender(period: f64) -> Automaton<Sender, Say, Source> {
    let Source { clock, value } = Source::coordinates();
    Automaton::starting_in(Sending)
        .initially(Source { clock: 0.0, value: 0.0 })
        .flow(Sending, clock.rate(1.0))
        .transition(
            from(Sending)
                .on(Say::Tell)
                .to(Sending)
                .must(clock.at_least(period))
                .then([clock.becomes(0.0), value.becomes(&value + 1.0)]),
        )
        .build()
        .expect("the sender is sound")
}

/// Tells once, at any time.
fn herald() -> Automaton<Receiver, Say, Source> {
    let Source { value, .. } = Source::coordinates();
    let once = from(Listening).on(Say::Tell).to(Deaf).may(always());
    Automaton::starting_in(Listening)
        .initially(Source { clock: 0.0, value: 0.0 })
        .transition(once.then(value.becomes(1.0)))
        .build()
        .expect("the herald is sound")
}

/// Notes what it hears, and how often.
fn receiver() -> Automaton<Receiver, Hear, Target> {
    let Target { heard, last, count } = Target::coordinates();
    let note = [last.becomes(&heard), count.becomes(&count + 1.0)];
    Automaton::starting_in(Listening)
        .initially(Target { heard: 0.0, last: -1.0, count: 0.0 })
        .transition(from(Listening).on(Hear::Hear).to(Listening).may(always()).then(note))
        .build()
        .expect("the receiver is sound")
}

fn channel() -> Channel {
    Channel::new("a.tell", "b.hear").carrying("a.x", "b.m")
}

fn pair(period: f64, channel: Channel) -> Composition {
    let parts = Composition::builder().add("a", &sender(period)).add("b", &receiver());
    parts.channel(channel).build().expect("the parts fit")
}

fn run(composition: &Composition, policy: Policy, horizon: f64) -> Trajectory {
    let settings = Settings { policy, ..Settings::default() };
    composition.run_with(settings, horizon).expect("it can be run")
}

fn jumps(trajectory: &Trajectory) -> Vec<(f64, &str)> {
    trajectory.jumps().iter().map(|jump| (jump.at.t, &*jump.label)).collect()
}

const TELL: &str = "a.tell";
const HEAR: &str = "b.hear";

#[test]
fn a_message_is_sent_in_one_jump_and_arrives_in_another() {
    let trajectory = run(&pair(1.0, channel().taking(0.25, 0.25)), Policy::Late, 2.0);
    assert_eq!(jumps(&trajectory), [(1.0, TELL), (1.25, HEAR), (2.0, TELL)]);
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    let parts = |jump: usize| -> Vec<usize> {
        trajectory.jumps()[jump].moves.iter().map(|one| one.component).collect()
    };
    // The channel is the component after the sender and the receiver.
    assert_eq!([parts(0), parts(1)], [[0, 2], [1, 2]]);
}

#[test]
fn a_message_carries_what_the_sender_had_before_the_jump() {
    let trajectory = run(&pair(1.0, channel().taking(0.5, 0.5)), Policy::Late, 2.75);
    let last = |t| trajectory.value("b.last", t);
    assert_eq!([last(1.25), last(1.75), last(2.75)], [Ok(-1.0), Ok(0.0), Ok(1.0)]);
    assert_eq!(trajectory.value("a.x", 1.25), Ok(1.0), "the sender has counted on");
}

#[test]
fn a_message_without_delay_arrives_at_the_same_time_in_a_later_jump() {
    let trajectory = run(&pair(1.0, channel().taking(0.0, 0.0)), Policy::Late, 1.5);
    assert_eq!(jumps(&trajectory), [(1.0, TELL), (1.0, HEAR)]);
}

#[test]
fn a_message_takes_as_long_as_the_policy_says_between_the_bounds() {
    let composition = pair(1.0, channel().taking(0.25, 0.75));
    let arrival = |policy| {
        let trajectory = run(&composition, policy, 1.9);
        assert_eq!(trajectory.jumps()[1].label, HEAR);
        trajectory.jumps()[1].at.t
    };
    assert_eq!((arrival(Policy::Early), arrival(Policy::Late)), (1.25, 1.75));
    let drawn = arrival(Policy::Random { seed: 3 });
    assert!((1.25..=1.75).contains(&drawn), "{drawn}");
}

#[test]
fn messages_arrive_in_the_order_in_which_they_are_sent() {
    let composition = pair(1.0, channel().taking(0.25, 2.5).holding(3));
    for seed in 0..20 {
        let trajectory = run(&composition, Policy::Random { seed }, 12.0);
        let heard: Vec<f64> = trajectory
            .jumps()
            .iter()
            .filter(|jump| jump.label == HEAR)
            .map(|jump| trajectory.value("b.last", jump.at.t).expect("within the run"))
            .collect();
        assert!(heard.len() >= 9 && heard.windows(2).all(|pair| pair[0] < pair[1]), "{heard:?}");
    }
}

coordinates! {
    struct Notes { number = "m", time = "t", numbers = "sum of m", times = "sum of t", count = "n" }
}

/// Of each message it adds the number and the time that it carries to what came before.
fn clerk() -> Automaton<Receiver, Hear, Notes> {
    let Notes { number, time, numbers, times, count } = Notes::coordinates();
    let sums = [
        numbers.becomes(10.0 * &numbers + &number),
        times.becomes(10.0 * &times + &time),
        count.becomes(&count + 1.0),
    ];
    let state = Notes { number: 0.0, time: 0.0, numbers: 0.0, times: 0.0, count: 0.0 };
    Automaton::starting_in(Listening)
        .initially(state)
        .transition(from(Listening).on(Hear::Hear).to(Listening).may(always()).then(sums))
        .build()
        .expect("the clerk is sound")
}

/// A sender that tells at 1 s, 2 s, … the numbers 0, 1, …, and a clerk.
fn office(channel: Channel) -> Composition {
    let Source { clock, value } = Source::coordinates();
    let tell = from(Sending).on(Say::Tell).to(Sending).must(clock.at_least(&value + 1.0));
    let sender = Automaton::starting_in(Sending)
        .initially(Source { clock: 0.0, value: 0.0 })
        .flow(Sending, clock.rate(1.0))
        .transition(tell.then(value.becomes(&value + 1.0)))
        .build()
        .expect("the sender is sound");
    let parts = Composition::builder().add("a", &sender).add("b", &clerk());
    let channel = channel.carrying("a.x", "b.m").carrying("a.τ", "b.t");
    parts.channel(channel).build().expect("the parts fit")
}

/// Digit by digit: the numbers and the times of all messages that have been heard.
#[test]
fn each_content_of_a_message_comes_to_its_own_reader() {
    for held in 1..=4 {
        let delay = f64::from(held) - 0.5;
        let channel = Channel::new("a.tell", "b.hear").holding(held as usize);
        let office = office(channel.taking(delay, delay));
        let trajectory = run(&office, Policy::Late, 4.75 + delay);
        let read = ["b.n", "b.sum of m", "b.sum of t"].map(|it| trajectory.value(it, 4.75 + delay));
        assert_eq!(read, [Ok(4.0), Ok(123.0), Ok(1234.0)], "{held} at a time");
    }
}

#[test]
fn of_what_a_lossy_channel_carries_the_rest_arrives_in_order() {
    let mut lost = 0;
    for seed in 0..20 {
        let channel = Channel::new("a.tell", "b.hear").taking(0.25, 2.0).holding(3).losing();
        let trajectory = run(&office(channel), Policy::Random { seed }, 9.5);
        assert_eq!(trajectory.ending().reason, Reason::Horizon);
        let [count, numbers, times] = ["b.n", "b.sum of m", "b.sum of t"]
            .map(|it| trajectory.value(it, 9.5).expect("a value"));
        let digit = |all: f64, place: i32| (all / 10f64.powi(place)).floor() % 10.0;
        let notes: Vec<f64> = (0..count as i32).rev().map(|place| digit(numbers, place)).collect();
        let stamps = (0..count as i32).rev().map(|place| digit(times, place) - 1.0);
        assert!(stamps.eq(notes.iter().copied()), "both are of one message: {numbers}, {times}");
        assert!(notes.windows(2).all(|pair| pair[0] < pair[1]), "{notes:?}");
        lost += 9 - notes.len();
    }
    assert!(lost > 0, "none is lost");
}

/// Another name of the event of a channel, and of another event, which keeps it.
#[test]
fn a_channel_begins_and_ends_at_events_by_the_names_that_they_are_given() {
    let leaving = || {
        let Target { heard, last, count } = Target::coordinates();
        let leave = from(Listening).on(Hear::Leave).to(Listening).must(count.at_least(2.0));
        let leave = leave.then(count.becomes(0.0));
        Automaton::starting_in(Listening)
            .initially(Target { heard: 0.0, last: -1.0, count: 0.0 })
            .transition(
                from(Listening)
                    .on(Hear::Hear)
                    .to(Listening)
                    .may(always())
                    .then([last.becomes(&heard), count.becomes(&count + 1.0)]),
            )
            .transition(leave)
            .build()
            .expect("it is sound")
    };
    let named = |labels: &[&str], input: &str| {
        let parts = Composition::builder()
            .add("a", &sender(1.0))
            .rename("tell", "call")
            .add("b", &leaving())
            .rename("leave", "go")
            .rename("hear", "listen");
        let parts = labels.iter().fold(parts, |parts, label| parts.label(label));
        let channel = Channel::new("a.call", input).carrying("a.x", "b.m");
        parts.channel(channel.taking(0.25, 0.25).holding(2)).build()
    };
    let told = |labels: &[&str]| {
        let trajectory = run(&named(labels, "b.listen").expect("the parts fit"), Policy::Late, 2.5);
        let told = jumps(&trajectory).into_iter().map(|(t, label)| (t, label.to_owned()));
        told.collect::<Vec<_>>()
    };
    let expected = |call: &str, listen: &str| {
        [(1.0, call), (1.25, listen), (2.0, call), (2.25, listen), (2.25, "go")]
            .map(|(t, label)| (t, label.to_owned()))
    };
    assert_eq!(told(&[]), expected("a.call", "b.listen"));
    assert_eq!(told(&["call"]), expected("call", "b.listen"));
    assert_eq!(told(&["listen", "call"]), expected("call", "listen"));
    let unknown = named(&[], "b.hear").map(|_| ()).expect_err("it has another name");
    let message = "no component has the event `b.hear`: `b` has `listen`";
    assert!(unknown.to_string().starts_with(message), "{unknown}");
}

#[test]
fn what_is_sent_on_a_full_channel_is_lost_and_the_sender_goes_on() {
    let trajectory = run(&pair(1.0, channel().taking(2.5, 2.5).holding(2)), Policy::Late, 7.0);
    let sent = jumps(&trajectory).iter().filter(|(_, label)| *label == TELL).count();
    assert_eq!(sent, 7);
    // Sent at 1 and 2, lost at 3, sent at 4 and 5, lost at 6.
    let last = |t| trajectory.value("b.last", t);
    assert_eq!([last(3.75), last(4.75), last(6.75)], [Ok(0.0), Ok(1.0), Ok(3.0)]);
}

#[test]
fn one_send_goes_on_all_channels_that_begin_there() {
    let group = Composition::builder()
        .add("a", &sender(1.0))
        .add("b", &receiver())
        .add("c", &receiver())
        .channel(channel().taking(0.25, 0.25))
        .channel(Channel::new("a.tell", "c.hear").carrying("a.x", "c.m").taking(0.5, 0.5))
        .build()
        .expect("the parts fit");
    let trajectory = run(&group, Policy::Late, 1.75);
    assert_eq!(jumps(&trajectory), [(1.0, TELL), (1.25, HEAR), (1.5, "c.hear")]);
    assert_eq!(trajectory.jumps()[0].moves.len(), 3);
}

#[test]
fn a_channel_with_several_inputs_delivers_to_all_in_one_jump() {
    let group = Composition::builder()
        .add("a", &sender(1.0))
        .add("b", &receiver())
        .add("c", &receiver())
        .channel(channel().and_to("c.hear").carrying("a.x", "c.m").called("air").taking(0.25, 0.25))
        .build()
        .expect("the parts fit");
    let trajectory = run(&group, Policy::Late, 2.5);
    assert_eq!(jumps(&trajectory), [(1.0, TELL), (1.25, "air"), (2.0, TELL), (2.25, "air")]);
    let lasts = ["b.last", "c.last"].map(|name| trajectory.value(name, 2.5));
    assert_eq!(lasts, [Ok(1.0), Ok(1.0)]);
}

/// How often the message of a herald may have been heard, and whether it may be under way.
fn reached(channel: Channel, most: f64) -> Vec<(f64, &'static str)> {
    let Target { count, .. } = Target::coordinates();
    let listener = Automaton::starting_in(Listening)
        .initially(Target { heard: 0.0, last: 0.0, count: 0.0 })
        .transition(
            from(Listening)
                .on(Hear::Hear)
                .to(Listening)
                .may(count.less_than(most))
                .then(count.becomes(&count + 1.0)),
        )
        .build()
        .expect("the listener is sound");
    let parts = Composition::builder().add("a", &herald()).add("b", &listener);
    let composition = parts.channel(channel).build().expect("the parts fit");
    let exploration = composition.explore(100).expect("no time passes");
    let mut reached: Vec<(f64, &'static str)> = exploration
        .states()
        .map(|state| {
            let held = state.locations().last().expect("three components");
            (state.value("b.n").expect("a coordinate"), held)
        })
        .collect();
    reached.sort_by(|one, other| one.partial_cmp(other).expect("numbers"));
    reached
}

#[test]
fn a_message_arrives_once_at_any_time_unless_the_channel_says_otherwise() {
    assert_eq!(reached(channel(), 5.0), [(0.0, "0"), (0.0, "1"), (1.0, "0")]);
    // Sent and lost looks like sent and neither heard, but for the herald.
    let lossy = reached(channel().losing(), 5.0);
    assert_eq!(lossy, [(0.0, "0"), (0.0, "0"), (0.0, "1"), (1.0, "0")]);
    let lasting = reached(channel().lasting(), 2.0);
    assert_eq!(lasting, [(0.0, "0"), (0.0, "1"), (1.0, "1"), (2.0, "1")]);
}

/// The message of 2 s takes the place of that of 1 s, and is heard half a second later.
#[test]
fn a_message_that_stays_gives_way_to_the_next() {
    let Target { heard, last, count: clock } = Target::coordinates();
    let late = from(Listening).on(Hear::Hear).to(Deaf).must(clock.at_least(2.5));
    let receiver = Automaton::starting_in(Listening)
        .initially(Target { heard: 0.0, last: -1.0, count: 0.0 })
        .flow(Listening, clock.rate(1.0))
        .transition(late.then(last.becomes(&heard)))
        .build()
        .expect("the receiver is sound");
    let parts = Composition::builder().add("a", &sender(1.0)).add("b", &receiver);
    let both = parts.channel(channel().lasting()).build().expect("the parts fit");
    let trajectory = run(&both, Policy::Late, 2.75);
    assert_eq!(jumps(&trajectory), [(1.0, TELL), (2.0, TELL), (2.5, HEAR)]);
    assert_eq!(trajectory.value("b.last", 2.75), Ok(1.0));
}

#[test]
fn a_receiver_of_messages_with_a_deadline_takes_them_in_every_location() {
    let leaving = Automaton::starting_in(Listening)
        .initially(Target { heard: 0.0, last: 0.0, count: 0.0 })
        .transition(from(Listening).on(Hear::Hear).to(Listening).may(always()))
        .transition(from(Listening).on(Hear::Leave).to(Deaf).may(always()))
        .build()
        .expect("it is sound");
    let with = |channel| {
        let parts = Composition::builder().add("a", &sender(1.0)).add("b", &leaving);
        parts.channel(channel).build().map(|_| ())
    };
    assert_eq!(with(channel()), Ok(()), "a message that takes any time can wait");
    let refused = with(channel().taking(0.0, 1.0)).expect_err("`deaf` receives nothing");
    assert_eq!(
        refused.to_string(),
        "messages have to arrive at `b.hear` in time, but component `b` has no transition with \
         that event from location `deaf`: add one, if only to ignore them"
    );
}

#[test]
fn channels_that_cannot_be_are_refused() {
    let with = |change: fn(CompositionBuilder) -> CompositionBuilder| {
        let parts = Composition::builder().add("a", &sender(1.0)).add("b", &receiver());
        change(parts).build().map(|_| ()).expect_err("it cannot be")
    };
    let says = |fault: CompositionError, message: &str| {
        assert!(fault.to_string().starts_with(message), "{fault}");
    };
    let unknown = with(|it| it.channel(Channel::new("a.say", "b.hear")));
    says(unknown, "no component has the event `a.say`: `a` has `tell`");
    let unknown = with(|it| it.channel(Channel::new("a.tell", "c.hear")));
    let known = "write `component.event`, of a component among `a`, `b`";
    says(unknown, &format!("no component has the event `c.hear`: {known}"));
    let namesakes = with(|it| {
        let last = || Channel::holding_last("a.tell");
        it.channel(last()).channel(last())
    });
    says(namesakes, "channel `a.tell →`: another component has its name: give one of them its own");
    let twice = with(|it| it.channel(channel()).channel(channel().called("again")));
    assert_eq!(twice, CompositionError::HeardTwice { event: HEAR.to_owned() });
    let built = |change: fn(Channel) -> Channel| {
        let parts = Composition::builder().add("a", &sender(1.0)).add("b", &receiver());
        parts.channel(change(channel())).build().map(|_| ())
    };
    let broken: [fn(Channel) -> Channel; 8] = [
        |it| it.taking(1.0, 0.5),
        |it| it.taking(-1.0, 0.5),
        |it| it.taking(0.0, f64::INFINITY),
        |it| it.taking(f64::NAN, 1.0),
        |it| it.holding(0),
        |it| it.lasting().holding(2),
        |it| it.lasting().taking(0.0, 1.0),
        |it| it.lasting().taking(0.0, 1.0).holding(2),
    ];
    for change in broken {
        let refused = built(change);
        assert!(matches!(refused, Err(CompositionError::Channel { .. })), "{refused:?}");
    }
    let fault = |change: fn(Channel) -> Channel| built(change).expect_err("it cannot be");
    says(
        fault(|it| it.taking(0.03, 0.02)),
        &format!("channel `{TELL} → {HEAR}`: its messages take from 0.03 s to 0.02 s"),
    );
    says(
        fault(|it| it.holding(513)),
        &format!("channel `{TELL} → {HEAR}`: it holds 513 messages, and"),
    );
    let fault = fault(|_| Channel::new(TELL, HEAR).held("a.x", "b.m", f64::NAN));
    says(fault, &format!("channel `{TELL} → {HEAR}`: `b.m` is NaN before the first arrival"));
    let sound: [fn(Channel) -> Channel; 5] = [
        |it| it.taking(0.0, 0.0),
        |it| it.taking(1.0, 1.0),
        |it| it.holding(1),
        |it| it.lasting(),
        |it| it.lasting().holding(1),
    ];
    sound.into_iter().for_each(|change| assert_eq!(built(change), Ok(())));
}

/// By default a run takes an arrival only where an invariant ends.
#[test]
fn a_channel_without_bounds_is_reported() {
    let keeps = |channel: Channel| {
        let report = pair(1.0, channel).check();
        report.findings().iter().any(|finding| finding.kind == Kind::KeepsMessages)
    };
    let unbounded = run(&pair(1.0, channel()), Policy::Late, 3.5);
    assert!(jumps(&unbounded).iter().all(|(_, label)| *label != HEAR));
    let at_once = run(&pair(1.0, channel().taking(0.0, 0.0)), Policy::Late, 3.5);
    assert_eq!(jumps(&at_once)[..2], [(1.0, TELL), (1.0, HEAR)]);
    assert!(keeps(channel()) && keeps(channel().losing()));
    assert!(!keeps(channel().taking(0.0, 0.0)) && !keeps(channel().lasting()));
}

#[test]
fn a_run_with_messages_is_checked_and_replayed_like_any_other() {
    let composition = pair(1.0, channel().taking(0.25, 0.75).holding(2));
    // This receiver never becomes deaf.
    let is_explained = |finding: &Finding| finding.place.location == Some("deaf");
    assert!(composition.check().findings().iter().all(is_explained));
    let trajectory = run(&composition, Policy::Random { seed: 7 }, 20.0);
    composition.replay(&trajectory).expect("it happens again");
}
