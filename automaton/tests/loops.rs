//! Sampled and delayed loops: clocks that sample, channels that hold what arrived last, and load
//! profiles, against solutions that are worked out step by step.

use pleach_automaton::check::Kind;
use pleach_automaton::composition::{Channel, Policy, Settings};
use pleach_automaton::{
    Automaton, BuildError, Builder, Composition, CompositionError, Reason, coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::{Table, always};

vocabulary! {
    enum Place: Location { Running = "running" }
    enum Cue: Event { Sample = "sample" }
    enum Arrival: Event { Hear = "hear" }
    enum Heater: Location { Off = "off", On = "on" }
    enum Look: Event { Cold = "cold", Warm = "warm" }
}
coordinates! {
    struct Plant { temperature = "T", voltage = "u", time = "t" }
    struct Controller { measured = "T", integral = "I", output = "u" }
    struct Counter { count = "n" }
    struct Room { heat = "T" }
    struct Sum { total = "x", rate = "r" }
}
use {Arrival::Hear, Cue::Sample, Place::Running};
use {
    Heater::{Off, On},
    Look::{Cold, Warm},
};

const PERIOD: f64 = 0.01;
const DELAY: f64 = 0.025;
const LAG: f64 = 0.5;
const GAINS: [f64; 3] = [4.0, 6.0, 2.0];
const TARGET: f64 = 3.0;
const LOADS: [(f64, f64); 4] = [(0.0, 0.0), (1.0, -2.0), (1.5, 40.0), (2.003, 0.5)];

/// A heater with a lag and a load, and a PI controller that is sampled, saturates, and unwinds its
/// integral by what saturation cuts off. Its output is the signal `v`, which a sample keeps as the coordinate `u`;
/// one of them is sent.
fn heated_room(sent: &str) -> Composition {
    let Plant { temperature, voltage, time } = Plant::coordinates();
    let load = Table::steps(LOADS).expect("in order").at(&time);
    let plant = Automaton::<_, Cue, _>::starting_in(Running)
        .initially(Plant { temperature: 0.0, voltage: 0.0, time: 0.0 })
        .flow(Running, [temperature.rate((&voltage + load - &temperature) / LAG), time.rate(1)])
        .build()
        .expect("the plant is sound");
    let Controller { measured, integral, output } = Controller::coordinates();
    let [proportional, integrating, unwinding] = GAINS;
    let error = TARGET - &measured;
    let wanted = proportional * &error + &integral;
    let possible = wanted.max(0.0).min(10.0);
    let cut = unwinding * (&possible - &wanted);
    let controller = Automaton::starting_in(Running)
        .initially(Controller { measured: 0.0, integral: 0.0, output: 0.0 })
        .signal("v", possible.clone())
        .transition(from(Running).on(Sample).to(Running).may(always()).then([
            output.becomes(possible),
            integral.becomes(&integral + PERIOD * (integrating * error + cut)),
        ]))
        .build()
        .expect("the controller is sound");
    Composition::builder()
        .add("plant", &plant)
        .add("pi", &controller)
        .connect("plant.T", "pi.T")
        .every("pi.sample", PERIOD)
        .channel(
            Channel::holding_last("pi.sample")
                .held(sent, "plant.u", 0.0)
                .taking(DELAY, DELAY)
                .holding(3),
        )
        .build()
        .expect("they fit together")
}

/// The temperature at the samples, from the exact solution between any two changes of its rate, where a sample
/// sends its own output or the one before.
fn exact(samples: usize, sends_its_own: bool) -> Vec<f64> {
    let ([proportional, integrating, unwinding], mut integral, mut output) = (GAINS, 0.0, 0.0);
    let (mut x, mut now, mut found) = (0.0, 0.0, Vec::new());
    // What is sent, and when it arrives.
    let mut sent: Vec<(f64, f64)> = vec![(0.0, 0.0)];
    for number in 0..samples {
        let sample = number as f64 * PERIOD;
        let mut changes: Vec<f64> = sent.iter().map(|one| one.0).collect();
        changes.extend(LOADS.iter().map(|one| one.0));
        changes.retain(|time| now < *time && *time < sample);
        changes.sort_by(f64::total_cmp);
        changes.push(sample);
        for end in changes {
            let latest = |steps: &[(f64, f64)]| {
                let begun = steps.iter().rev().find(|step| step.0 <= now + 1e-12);
                begun.map_or(0.0, |step| step.1)
            };
            let rest = latest(&sent) + latest(&LOADS);
            x = rest + (x - rest) * (-(end - now) / LAG).exp();
            now = end;
        }
        found.push(x);
        let error = TARGET - x;
        let wanted: f64 = proportional * error + integral;
        let before = std::mem::replace(&mut output, wanted.clamp(0.0, 10.0));
        sent.push((sample + DELAY, if sends_its_own { output } else { before }));
        integral += PERIOD * (integrating * error + unwinding * (output - wanted));
    }
    found
}

#[test]
fn a_sampled_loop_with_delay_saturation_and_load_is_exact() {
    for (sent, sends_its_own) in [("pi.v", true), ("pi.u", false)] {
        let room = heated_room(sent);
        assert!(room.check().findings().is_empty(), "{}", room.check());
        let trajectory = room.run(4.0).expect("it runs");
        assert_eq!(trajectory.ending().reason, Reason::Horizon);
        let exact = exact(400, sends_its_own);
        let peak = exact.iter().copied().fold(0.0, f64::max);
        assert!(peak > 10.0, "the load saturates the controller: {peak}");
        for (number, exact) in exact.into_iter().enumerate() {
            let found = trajectory.value("plant.T", number as f64 * PERIOD).expect("it lasts");
            assert!((found - exact).abs() < 1e-8, "{found} is not {exact} at sample {number}");
        }
    }
}

/// A counter that is sampled.
fn counter() -> Automaton<Place, Cue, Counter> {
    let Counter { count } = Counter::coordinates();
    let counts = from(Running).on(Sample).to(Running).may(always());
    Automaton::starting_in(Running)
        .initially(Counter { count: 0.0 })
        .transition(counts.then(count.becomes(&count + 1)))
        .build()
        .expect("it is sound")
}

/// A counter that is sampled, and one that adds up what it hears of it a quarter of a second later.
fn counted(channel: Channel) -> Result<Composition, CompositionError> {
    counted_every(1.0, channel.taking(0.25, 0.25))
}

fn counted_every(period: f64, channel: Channel) -> Result<Composition, CompositionError> {
    let Sum { total, rate } = Sum::coordinates();
    let sum = Automaton::starting_in(Running)
        .initially(Sum { total: 0.0, rate: 0.0 })
        .flow(Running, total.rate(&rate))
        .transition(from(Running).on(Hear).to(Running).may(always()))
        .build()
        .expect("it is sound");
    Composition::builder()
        .add("counter", &counter())
        .add("sum", &sum)
        .every("counter.sample", period)
        .channel(channel)
        .build()
}

/// 7 up to the first arrival, then 0, 1, 2, …, each for a second from a quarter on.
#[test]
fn a_channel_holds_what_arrived_last() {
    let alone = Channel::holding_last("counter.sample");
    let heard = Channel::new("counter.sample", "sum.hear");
    for channel in [alone, heard] {
        let both = counted(channel.held("counter.n", "sum.r", 7.0)).expect("they fit together");
        let trajectory = both.run(3.0).expect("it runs");
        let total = |t: f64| trajectory.value("sum.x", t).expect("it lasts");
        assert!((total(0.25) - 1.75).abs() < 1e-12);
        assert!((total(1.25) - 1.75).abs() < 1e-12);
        assert!((total(3.0) - 4.25).abs() < 1e-12, "{}", total(3.0));
    }
}

#[test]
fn what_is_under_way_cannot_be_read() {
    let heard = Channel::new("counter.sample", "sum.hear").carrying("counter.n", "sum.r");
    let fault = counted(heard).err().expect("it is read in a flow");
    assert!(matches!(fault, CompositionError::InTransit { .. }), "{fault}");
    let text = fault.to_string();
    for part in ["`sum`", "`r`", "the flow of location `running`", "Channel::held"] {
        assert!(text.contains(part), "{text}");
    }
    let unheard = Channel::holding_last("counter.sample").carrying("counter.n", "sum.r");
    assert!(counted(unheard).is_err());
}

/// The first sample is at the phase, and no error adds up.
#[test]
fn samples_are_taken_at_even_intervals_from_the_phase_on() {
    let sampled = |period: f64, phase: f64| {
        let builder = Composition::builder().add("counter", &counter());
        builder.every_from("counter.sample", period, phase).build()
    };
    for phase in [0.0, 0.003, 0.1, 0.25] {
        let trajectory = sampled(0.1, phase).expect("it fits").run(100.0).expect("it runs");
        for (number, jump) in trajectory.jumps().iter().enumerate() {
            let exact = phase + 0.1 * number as f64;
            assert!((jump.at.t - exact).abs() < 1e-13, "{} is not {exact}", jump.at.t);
        }
        assert!(trajectory.jumps().len() >= 998, "{}", trajectory.jumps().len());
    }
    for [period, phase] in [[0.0, 0.0], [-1.0, 0.0], [f64::NAN, 0.0], [1.0, -0.5], [1.0, f64::NAN]]
    {
        assert!(matches!(sampled(period, phase), Err(CompositionError::Sampler { .. })));
    }
}

/// A thermostat that looks at guards at samples alone; it falls and rises by 0.75 a second.
fn thermostat() -> Builder<Heater, Look, Room> {
    let Room { heat } = Room::coordinates();
    Automaton::starting_in(Off)
        .initially(Room { heat: 20.0 })
        .flow(Off, heat.rate(-0.75))
        .flow(On, heat.rate(0.75))
        .transition(from(Off).on(Cold).to(On).may(heat.at_most(18.0)))
        .transition(from(On).on(Warm).to(Off).may(heat.at_least(22.0)))
}

/// When an event is taken, of all jumps of a run.
fn times(trajectory: &pleach_automaton::Trajectory, label: &str) -> Vec<f64> {
    let jumps = trajectory.jumps().iter().filter(|jump| jump.label == label);
    jumps.map(|jump| jump.at.t).collect()
}

/// At 18 degrees after 2.67 s it looks at 3 s; then from 17.75 to 22.25 in 6 s, and down to 17.75 in 6 s.
#[test]
fn guards_are_looked_at_when_they_are_sampled() {
    let sampled = thermostat().every(Cold, 1.0).every(Warm, 1.0).build().expect("it is sound");
    let trajectory = sampled.run(20.5).expect("it runs");
    assert_eq!(times(&trajectory, "cold"), [3.0, 15.0]);
    assert_eq!(times(&trajectory, "warm"), [9.0]);
    assert_eq!(trajectory.value("T", 9.0), Ok(22.25));
    // At all other samples, in either location, nothing is taken.
    assert_eq!(times(&trajectory, "missed").len(), 2 * 21 - 3);
    // In a composition with others, too, and from a phase on.
    let late = thermostat().every_from(Cold, 1.0, 0.5).every(Warm, 1.0).build();
    let both = Composition::builder().add("counter", &counter()).add("room", &late.expect("sound"));
    let both = both.every("counter.sample", 4.0).build().expect("they fit together");
    let trajectory = both.run(3.9).expect("it runs");
    assert_eq!(times(&trajectory, "room.cold"), [3.5]);
    assert_eq!(trajectory.value("room.T", 3.5), Ok(20.0 - 0.75 * 3.5));
}

#[test]
fn events_that_are_sampled_in_vain_or_twice_are_refused() {
    let unused = Automaton::<Heater, Look, Room>::starting_in(Off).every(Cold, 1.0).build();
    assert!(matches!(unused, Err(BuildError::SampledWithoutRow { event: "cold" })));
    let twice = thermostat().every(Cold, 1.0).every(Cold, 2.0).build();
    assert!(matches!(twice, Err(BuildError::GivenTwice { place: "cold", part: "samples" })));
    let refused = [
        (thermostat().every(Cold, 0.0), "its period is 0 s: it has to be finite and above 0"),
        (thermostat().every(Cold, -1.0), "its period is -1 s: it has to be finite and above 0"),
        (
            thermostat().every(Cold, f64::NAN),
            "its period is NaN s: it has to be finite and above 0",
        ),
        (
            thermostat().every_from(Cold, 1.0, -0.5),
            "its phase is -0.5 s: it has to be finite and at least 0",
        ),
    ];
    for (builder, reason) in refused {
        let fault = builder.build().expect_err("it cannot be sampled").to_string();
        assert_eq!(fault, format!("event `cold` cannot be sampled: {reason}"));
    }
    let missed = Composition::builder().add("counter", &counter()).rename("sample", "missed");
    let missed = missed.label("missed").every("counter.missed", 1.0).build();
    assert!(matches!(missed, Err(CompositionError::Sampler { event, .. }) if event == "missed"));
    let nothing = Composition::builder().every("counter.sample", 1.0).build();
    assert!(matches!(nothing, Err(CompositionError::Empty)));
}

/// Time has to advance from one sample to the next, up to the horizon.
#[test]
fn samples_that_numbers_do_not_resolve_are_refused() {
    let sampled = |period: f64| {
        Composition::builder()
            .add("counter", &counter())
            .every("counter.sample", period)
            .build()
            .expect("it fits")
    };
    let refused = sampled(1e-300).run(15.0).expect_err("time does not advance").to_string();
    for part in ["clock of counter.sample", "1e-300 s", "15 s", "longer period"] {
        assert!(refused.contains(part), "{refused}");
    }
    assert!(sampled(1e-300).run(3e-300).is_ok());
    assert!(sampled(f64::EPSILON).run(4.0 * f64::EPSILON).is_ok());
}

/// A channel loses messages where the check says so.
#[test]
fn channels_that_lose_messages_are_reported() {
    let delayed = |period: f64, delay: f64, places: usize| {
        let Sum { total, rate } = Sum::coordinates();
        let sum = Automaton::<_, Cue, _>::starting_in(Running)
            .initially(Sum { total: 0.0, rate: 0.0 })
            .flow(Running, total.rate(&rate))
            .build()
            .expect("it is sound");
        let channel = Channel::holding_last("counter.sample").held("counter.n", "sum.r", 0.0);
        Composition::builder()
            .add("counter", &counter())
            .add("sum", &sum)
            .every("counter.sample", period)
            .channel(channel.taking(delay, delay).holding(places))
            .build()
            .expect("they fit together")
    };
    for (period, delay, needed) in [
        (0.01, 0.025, 3),
        (0.01, 0.1, 11),
        (0.1, 0.3, 4),
        (0.1, 1.0, 11),
        (0.125, 1.0, 9),
        (1.0, 0.0, 1),
        (1.0, 0.5, 1),
    ] {
        for places in 1..=needed {
            let both = delayed(period, delay, places);
            let report = both.check();
            let is_reported = report.findings().iter().any(|one| one.kind == Kind::LosesMessages);
            let run = both.run(40.0 * period + delay).expect("it runs");
            let sent = times(&run, "counter.sample").into_iter().filter(|t| *t < 39.5 * period);
            let is_lossy = times(&run, "counter.sample → arrival").len() < sent.count();
            let case = format!("every {period} s, {delay} s, {places} places");
            assert_eq!(is_reported, places < needed, "{case}\n{report}");
            // Where the instants of an arrival and a sample differ by rounding, one place less may do.
            let is_tied = period == 0.1 && places + 1 == needed;
            assert!(is_lossy == is_reported || is_tied, "{case}");
        }
    }
    let report = delayed(0.01, 0.1, 10).check().to_string();
    let message = "warning: loses messages: component `counter.sample →`: messages are sent every 0.01 s and take up to \
                   0.1 s, so 11 can be under way, and it holds 10: let it hold 11, with `holding`, or messages are lost";
    assert!(report.starts_with(message), "{report}");
}

/// 512 messages of 10 ms are under way for less than 5.12 s.
#[test]
fn a_check_advises_no_more_places_than_a_channel_can_have() {
    let channel = Channel::holding_last("counter.sample").held("counter.n", "sum.r", 0.0);
    let both = counted_every(0.01, channel.taking(1e9, 1e9)).expect("they fit together");
    let report = both.check().to_string();
    let advice = "no channel holds more than 512, so let the period be above 1.953125e6 s, or the longest time below 5.12e0 s";
    assert!(report.contains(advice), "{report}");
}

/// Wherever a run goes by chance, it samples what it can.
#[test]
fn a_sample_passes_only_where_its_event_cannot_be_taken() {
    let sampled = thermostat().every(Cold, 1.0).every(Warm, 1.0).build().expect("it is sound");
    let alone = Composition::builder().add("room", &sampled).build().expect("it is one part");
    assert!(alone.check().findings().is_empty(), "{}", alone.check());
    let product = alone.product().expect("all is formulas");
    let locations: Vec<&str> = product.locations().iter().map(|one| one.as_str()).collect();
    assert_eq!(
        locations,
        ["off (ticking)", "off (sampling warm)", "on (sampling warm)", "on (ticking)"]
    );
    let same = Composition::builder().add("room", &product).build().expect("it is one part");
    let chances = (0..20).map(|seed| Policy::Random { seed });
    for policy in chances.chain([Policy::Early, Policy::Late]) {
        for room in [&alone, &same] {
            let settings = Settings { policy, ..Settings::default() };
            let run = room.run_with(settings, 20.5).expect("it runs");
            assert_eq!(times(&run, "cold"), [3.0, 15.0], "{policy:?}");
            assert_eq!(times(&run, "warm"), [9.0], "{policy:?}");
            assert_eq!(times(&run, "missed").len(), 2 * 21 - 3, "{policy:?}");
        }
    }
}

/// Events of a component are due together, by one clock or by two: none passes since another is taken.
#[test]
fn samples_at_one_instant_wait_for_each_other() {
    let Counter { count } = Counter::coordinates();
    let counted = |event, step: f64| {
        let counts = from(On).on(event).to(On).may(count.at_least(0.0));
        counts.then(count.becomes(&count + step))
    };
    for (period, expected) in [(2.0, 305.0), (1.0, 505.0)] {
        let counter = Automaton::starting_in(On)
            .initially(Counter { count: 0.0 })
            .transition(counted(Cold, 1.0))
            .transition(counted(Warm, 100.0))
            .every(Cold, 1.0)
            .every(Warm, period)
            .build()
            .expect("it is sound");
        let run = counter.run(4.0).expect("it runs");
        assert_eq!(run.value("n", 4.0), Ok(expected));
        assert!(times(&run, "missed").is_empty());
    }
}
