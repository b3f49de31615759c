//! Runs that are observed as they happen.

use pleach_automaton::composition::Channel;
use pleach_automaton::composition::stream::{CsvLog, Flowing, Jumping, RunObserver, Samples};
use pleach_automaton::{Automaton, Composition, Limit, Reason, Settings, coordinates, from};
use pleach_discrete::vocabulary;
use pleach_guards::always;

vocabulary! {
    enum Place: Location { Here = "here" }
    enum Cue: Event { Sample = "sample" }
}
coordinates! {
    struct Wave { place = "p", speed = "s" }
    struct Counter { count = "n", seen = "p" }
    struct Lag { follower = "y", input = "n" }
}
use {Cue::Sample, Place::Here};

fn counter() -> Automaton<Place, Cue, Counter> {
    let Counter { count, .. } = Counter::coordinates();
    let counts = from(Here).on(Sample).to(Here).may(always()).then(count.becomes(&count + 1));
    Automaton::starting_in(Here)
        .initially(Counter { count: 0.0, seen: 0.0 })
        .transition(counts)
        .build()
        .expect("it is sound")
}

/// An oscillator, a counter that is sampled, and what follows the counter later: groups of their own.
fn model(period: f64) -> Composition {
    let Wave { place, speed } = Wave::coordinates();
    let wave = Automaton::<_, Cue, _>::starting_in(Here)
        .initially(Wave { place: 1.0, speed: 0.0 })
        .flow(Here, [place.rate(&speed), speed.rate(-&place)])
        .build()
        .expect("it is sound");
    let Lag { follower, input } = Lag::coordinates();
    let lag = Automaton::<_, Cue, _>::starting_in(Here)
        .initially(Lag { follower: 0.0, input: 0.0 })
        .flow(Here, follower.rate(&input - &follower))
        .build()
        .expect("it is sound");
    Composition::builder()
        .add("wave", &wave)
        .add("counter", &counter())
        .add("lag", &lag)
        .every("counter.sample", period)
        .channel(
            Channel::holding_last("counter.sample")
                .held("counter.n", "lag.n", 0.0)
                .taking(0.1 * period, 0.1 * period),
        )
        .build()
        .expect("they fit together")
}

#[test]
fn what_is_streamed_is_what_is_recorded() {
    let model = model(0.3);
    let recorded = model.run(5.0).expect("it runs");
    let mut samples = Samples::every(0.2501);
    let finish = model.stream(Settings::default(), 5.0, &mut samples).expect("it runs");
    assert_eq!(finish.ending, *recorded.ending());
    assert_eq!(Some(finish.values), recorded.values_at(5.0));
    assert_eq!(samples.rows().len(), 20);
    for (t, values) in samples.rows() {
        let exact = recorded.values_at(*t).expect("it lasts");
        let is_near = |(one, other): (&f64, &f64)| (one - other).abs() < 1e-12;
        assert!(values.iter().zip(&exact).all(is_near), "{values:?} are not {exact:?} at {t}");
    }
}

/// Every jump with the state on both sides, and the component that takes it.
#[test]
fn a_log_has_both_sides_of_every_jump() {
    #[derive(Default)]
    struct Sides(Vec<(f64, String, [Vec<f64>; 2])>);
    impl RunObserver for Sides {
        fn jumps(&mut self, jump: &Jumping<'_>) {
            let name = jump.components().next().unwrap_or_default().to_owned();
            self.0.push((jump.at.t, name, [jump.before.to_vec(), jump.after.to_vec()]));
        }
    }
    let model = model(0.3);
    let recorded = model.run(2.0).expect("it runs");
    let (mut sides, mut log) = (Sides::default(), CsvLog::every(1.0, Vec::new()));
    model.stream(Settings::default(), 2.0, &mut (&mut sides, &mut log)).expect("it runs");
    let intervals: Vec<_> = recorded.intervals().collect();
    assert_eq!(sides.0.len(), recorded.jumps().len());
    for (number, (t, _, [before, after])) in sides.0.iter().enumerate() {
        assert_eq!(*t, recorded.jumps()[number].at.t);
        let last = intervals[number].samples.last().expect("there is one");
        let first = &intervals[number + 1].samples[0];
        let is_near = |(one, other): (&f64, &f64)| (one - other).abs() < 1e-12;
        assert!(before.iter().zip(&last.values).all(is_near), "{before:?}: {:?}", last.values);
        assert!(after.iter().zip(&first.values).all(is_near), "{after:?}: {:?}", first.values);
    }
    let names: Vec<&str> = sides.0.iter().map(|(_, name, _)| &**name).take(2).collect();
    assert_eq!(names[0], "counter");
    let text = String::from_utf8(log.finish().expect("it is written")).expect("it is text");
    let mut lines = text.lines();
    assert!(lines.next().expect("a header").starts_with("t,j,component,event,wave.p,wave.s,"));
    // 0, 1 and 2 seconds, and two rows for each jump.
    assert_eq!(lines.count(), 3 + 2 * recorded.jumps().len());
}

#[test]
fn a_log_has_the_columns_of_choice() {
    let log = |columns: &[&str]| {
        let mut log = CsvLog::every(1.0, Vec::new()).columns(columns.iter().copied());
        let begun = model(0.3).stream(Settings::default(), 0.0, &mut log);
        let text = begun.map(|_| log.finish().expect("it is written"));
        text.map(|text| String::from_utf8(text).expect("it is text"))
    };
    let text = log(&["wave.s", "wave.p"]).expect("it is written");
    assert_eq!(text.lines().next(), Some("t,j,component,event,wave.s,wave.p"));
    let all = model(0.3);
    let start: Vec<f64> = ["wave.s", "wave.p"]
        .iter()
        .map(|name| all.run(0.0).expect("it runs").value(name, 0.0).expect("it is there"))
        .collect();
    assert_eq!(text.lines().nth(1), Some(&*format!("0,0,,,{},{}", start[0], start[1])));
    let fault = log(&["wave.p", "wave.q"]).expect_err("there is no such column").to_string();
    let known = "there is no column `wave.q`: there are `wave.p`, `wave.s`, ";
    assert_eq!(
        fault.strip_prefix("the run cannot be observed: ").map(|it| it.starts_with(known)),
        Some(true),
        "{fault}"
    );
    let fault = log(&["lag.n"]).expect_err("it is an input").to_string();
    let source = "`lag.n` is an input: its values are in the column `counter.sample →.held 1`";
    assert!(fault.ends_with(source), "{fault}");
}

/// A writer that fails is reported, once the run is over.
#[test]
fn a_log_that_cannot_be_written_says_so() {
    struct Full;
    impl std::io::Write for Full {
        fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
            Err(std::io::Error::other("the disk is full"))
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let mut log = CsvLog::every(1.0, Full);
    model(0.3).stream(Settings::default(), 2.0, &mut log).expect("it runs");
    let fault = log.finish().err().expect("it fails");
    assert_eq!(fault.to_string(), "the disk is full");
}

/// A record of this run meets the limit of memory early; what is streamed takes none.
#[test]
fn the_memory_of_a_stream_does_not_grow() {
    #[derive(Default)]
    struct Counts([u64; 2]);
    impl RunObserver for Counts {
        fn flows(&mut self, _: &Flowing<'_>) {
            self.0[0] += 1;
        }
        fn jumps(&mut self, _: &Jumping<'_>) {
            self.0[1] += 1;
        }
    }
    let model = model(1.0 / 1024.0);
    let settings = Settings { memory_limit: 1 << 20, ..Settings::default() };
    let recorded = model.run_with(settings, 10.0).expect("it runs");
    assert_eq!(recorded.ending().reason, Reason::Limit(Limit::Memory(1 << 20)));
    let mut counts = Counts::default();
    let finish = model.stream(settings, 10.0, &mut counts).expect("it runs");
    assert_eq!(finish.ending.reason, Reason::Horizon);
    assert_eq!(counts.0[1], 2 * 10_241 - 1);
    assert!(counts.0[0] >= 20_480, "{}", counts.0[0]);
}

/// More ticks than a day of control at 100 Hz has: what the process holds is what it held after a thousandth
/// of them.
#[test]
#[ignore = "it takes a minute"]
fn ten_million_ticks_take_no_memory() {
    let period = 1.0 / 1024.0;
    let sampled = Composition::builder().add("counter", &counter());
    let sampled = sampled.every("counter.sample", period).build().expect("they fit together");
    let settings = Settings { jump_limit: u64::MAX, step_limit: u64::MAX, ..Settings::default() };
    let held_after = |ticks: f64| {
        let finish = sampled.stream(settings, ticks * period, &mut ()).expect("it runs");
        assert_eq!((finish.ending.reason, finish.values[0]), (Reason::Horizon, ticks + 1.0));
        let status = std::fs::read_to_string("/proc/self/status").expect("Linux says what is held");
        let held = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
        let held = held.and_then(|held| held.trim().strip_suffix(" kB")?.parse::<u64>().ok());
        held.expect("it is a number")
    };
    let [few, many] = [1e4, 1e7].map(held_after);
    assert!(many < few + 1024, "{few} kB, and then {many}");
}

/// A log or samples that could not be written as they are asked for stop the run before it begins.
#[test]
fn a_grid_of_times_that_makes_no_sense_is_refused() {
    let refusal = |observer: &mut dyn RunObserver| {
        let mut observer = observer;
        model(0.3)
            .stream(Settings::default(), 4.0, &mut observer)
            .map(|_| ())
            .map_err(|it| it.to_string())
    };
    for period in [0.0, -1.0, f64::NAN] {
        let fault = format!(
            "the run cannot be observed: the period of samples is {period} s: it has to be above 0, or ∞"
        );
        assert_eq!(refusal(&mut Samples::every(period)), Err(fault.clone()));
        assert_eq!(refusal(&mut CsvLog::every(period, Vec::new())), Err(fault));
    }
    let fine = refusal(&mut Samples::every(1e-300)).expect_err("it would never end");
    assert!(fine.contains("the period of samples is 1e-300 s, which numbers near"), "{fine}");
    assert_eq!(refusal(&mut Samples::every(f64::INFINITY)), Ok(()));
}
