//! The semantics of runs, as `docs/semantics.md` states them, clause by clause.

use pleach_automaton::diagram::outcome;
use pleach_automaton::{
    Automaton, Composition, Failure, HybridTime, Policy, Reason, Reset, Settings, Trajectory,
    coordinates, from, observed,
};
use pleach_discrete::{TransitionTable, vocabulary};
use pleach_guards::{Predicate, always, proposition};

vocabulary! {
    enum Place: Location { Here = "here", There = "there", Beyond = "beyond" }
    enum Cue: Event { Go = "go", Stay = "stay", Return = "return" }
}
use Cue::{Go, Return, Stay};
use Place::{Beyond, Here, There};

coordinates! {
    struct Clock { time = "τ", count = "n" }
}

type Machine = Automaton<Place, Cue, Clock>;

const START: Clock = Clock { time: 0.0, count: 0.0 };

fn clock() -> pleach_automaton::Builder<Place, Cue, Clock> {
    let Clock { time, .. } = Clock::coordinates();
    Automaton::starting_in(Here).initially(START).flow(Here, time.rate(1.0))
}

fn after(seconds: f64) -> Predicate {
    Clock::coordinates().time.at_least(seconds)
}

fn run(machine: &Machine, horizon: f64) -> Trajectory {
    machine.run(horizon).expect("the machine can be run")
}

fn labels(trajectory: &Trajectory) -> Vec<(f64, u32, &str)> {
    trajectory.jumps().iter().map(|jump| (jump.at.t, jump.at.j, &*jump.label)).collect()
}

fn built(builder: pleach_automaton::Builder<Place, Cue, Clock>) -> Machine {
    builder.build().expect("the machine is sound")
}

#[test]
fn an_event_on_the_boundary_of_two_flows_happens_once() {
    let Clock { time, count } = Clock::coordinates();
    // Time goes on in `here` after the jump at 1, and the guard stays true on its boundary.
    let once = after(1.0) & count.less_than(1.0);
    let machine = built(
        clock().transition(
            from(Here)
                .on(Go)
                .to(Here)
                .must(once)
                .then([count.becomes(&count + 1.0), time.becomes(&time)]),
        ),
    );
    let trajectory = run(&machine, 2.0);
    assert_eq!(labels(&trajectory), [(1.0, 0, "go")]);
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    assert_eq!(trajectory.ending().at, HybridTime { t: 2.0, j: 1 });
}

/// A reset that is a function does what its formulas do, and nothing to what it reads of others.
#[test]
fn a_reset_may_be_a_function() {
    let Clock { time, count } = Clock::coordinates();
    let formulas = [time.becomes(0.5 * &count), count.becomes(&count + &time)];
    let function = Reset::new("the same", |clock: &mut Clock| {
        let Clock { time, count } = *clock;
        *clock = Clock { time: 0.5 * count, count: count + time };
    });
    let ends = [Reset::from(formulas.to_vec()), function].map(|reset| {
        let go = from(Here).on(Go).to(Here).must(after(1.0) & count.at_most(1.5));
        let machine = built(clock().transition(go.then(reset)));
        let trajectory = run(&machine, 3.0);
        (trajectory.values_at(3.0), trajectory.jumps().len())
    });
    assert_eq!(ends[0], (Some(vec![1.5, 2.0]), 2));
    assert_eq!(ends[0], ends[1]);
    let overwrite = Reset::new("all", |clock: &mut Clock| *clock = Clock { time: 0.0, count: 7.0 });
    let go = built(clock().transition(from(Here).on(Go).to(Here).must(after(1.0)).then(overwrite)));
    let parts = Composition::builder().add("one", &go).add("other", &built(clock()));
    let pair = parts.connect("other.n", "one.n").build().expect("the parts fit");
    let trajectory = pair.run(1.5).expect("it can be run");
    let values = ["one.τ", "other.n", "other.τ"].map(|name| trajectory.value(name, 1.5));
    assert_eq!(values, [Ok(0.5), Ok(0.0), Ok(1.5)]);
}

#[test]
fn the_flow_lands_on_the_crossed_side() {
    let Clock { time, .. } = Clock::coordinates();
    let third = 1.0 / 3.0;
    let closed = built(clock().transition(from(Here).on(Go).to(There).must(time.at_least(third))));
    let open = built(clock().transition(from(Here).on(Go).to(There).must(time.more_than(third))));
    let at = |machine| run(machine, 1.0).jumps()[0].at.t;
    assert!(at(&closed) >= third && at(&closed) - third < 1e-15);
    assert!(at(&open) > third && at(&open) - third < 1e-15);
}

#[test]
fn jumps_at_the_horizon_are_taken_and_later_ones_are_not() {
    let machine = built(clock().transition(from(Here).on(Go).to(There).must(after(1.0))));
    assert_eq!(labels(&run(&machine, 1.0)), [(1.0, 0, "go")]);
    assert_eq!(labels(&run(&machine, 0.999_999)), []);
}

#[test]
fn flows_of_every_kind_reach_the_horizon() {
    let Clock { time, count } = Clock::coordinates();
    let rates = [count.rate(1.0), count.rate(1.0 - &count), count.rate(1.0 - count.power(2.0))];
    let at_one = [1.0, 1.0 - (-1f64).exp(), 1f64.tanh()];
    for (rate, value) in rates.into_iter().zip(at_one) {
        let flow = [time.rate(1.0), rate];
        let machine = built(Automaton::starting_in(Here).initially(START).flow(Here, flow));
        let trajectory = run(&machine, 1.0);
        assert_eq!(trajectory.ending().reason, Reason::Horizon);
        let error = (trajectory.value("n", 1.0).expect("the run lasts") - value).abs();
        assert!(error < 1e-8, "{error:e}");
        assert_eq!(run(&machine, 0.0).ending().reason, Reason::Horizon);
    }
}

#[test]
fn guards_already_true_on_entry_are_seen_at_that_instant() {
    let machine = built(
        clock()
            .transition(from(Here).on(Go).to(There).must(after(1.0)))
            .transition(from(There).on(Stay).to(Beyond).at_once(after(0.5))),
    );
    assert_eq!(labels(&run(&machine, 2.0)), [(1.0, 0, "go"), (1.0, 1, "stay")]);
}

#[test]
fn every_assignment_reads_the_state_before_the_jump() {
    let Clock { time, count } = Clock::coordinates();
    let swap = [time.becomes(&count), count.becomes(&time)];
    let machine =
        built(clock().transition(from(Here).on(Go).to(There).must(after(2.0)).then(swap)));
    let trajectory = run(&machine, 3.0);
    let phases: Vec<_> = trajectory.intervals().collect();
    let [first, second] = &phases[..] else { panic!("there is one jump") };
    assert_eq!(first.samples.last().map(|x| x.values.clone()), Some(vec![2.0, 0.0]), "x⁻");
    assert_eq!(second.samples[0].values, [0.0, 2.0], "x⁺");
}

#[test]
fn simultaneous_transitions_go_by_priority_and_then_by_declaration() {
    let order = |first: u8, second: u8| {
        let machine = built(
            clock()
                .transition(from(Here).on(Go).to(There).must(after(1.0)).priority(first))
                .transition(from(Here).on(Stay).to(Beyond).must(after(1.0)).priority(second)),
        );
        run(&machine, 2.0).jumps()[0].label.clone()
    };
    assert_eq!([order(0, 1), order(1, 0), order(0, 0)], ["go", "stay", "go"]);
}

/// Of two transitions with one event the one is taken whose guard holds first; of both, that which comes first.
#[test]
fn one_event_may_lead_from_one_location_to_several() {
    let reached = |[there, beyond]: [f64; 2], [first, second]: [u8; 2]| {
        let machine = built(
            clock()
                .transition(from(Here).on(Go).to(There).must(after(there)).priority(first))
                .transition(from(Here).on(Go).to(Beyond).must(after(beyond)).priority(second)),
        );
        let trajectory = run(&machine, 5.0);
        assert_eq!(trajectory.jumps().len(), 1);
        let place = trajectory.jumps()[0].moves[0].target;
        (trajectory.jumps()[0].at.t, trajectory.components()[0].locations[place].to_string())
    };
    assert_eq!(reached([1.0, 2.0], [1, 0]), (1.0, "there".to_owned()));
    assert_eq!(reached([2.0, 1.0], [0, 1]), (1.0, "beyond".to_owned()));
    assert_eq!(reached([1.0, 1.0], [1, 0]), (1.0, "beyond".to_owned()));
    assert_eq!(reached([1.0, 1.0], [0, 0]), (1.0, "there".to_owned()));
}

#[test]
fn what_may_happen_happens_as_late_or_as_early_as_it_can() {
    let machine = built(
        clock()
            .invariant(Here, Clock::coordinates().time.at_most(3.0))
            .transition(from(Here).on(Go).to(There).may(after(1.0))),
    );
    let composition = Composition::builder().add("machine", &machine).build().expect("sound");
    let at = |policy| {
        let settings = Settings { policy, ..Settings::default() };
        composition.run_with(settings, 5.0).expect("it can be run").jumps()[0].at.t
    };
    assert_eq!(at(Policy::Early), 1.0);
    assert!((at(Policy::Late) - 3.0).abs() < 1e-14);
}

#[test]
fn a_state_that_neither_time_nor_a_jump_can_leave_is_blocked() {
    let machine = built(clock().invariant(Here, Clock::coordinates().time.at_most(1.5)));
    let trajectory = run(&machine, 5.0);
    assert_eq!(trajectory.ending().reason, Reason::Blocked);
    assert!((trajectory.ending().at.t - 1.5).abs() < 1e-14);
    let first = trajectory.intervals().next().expect("there is one phase");
    let last = first.samples.last().map(|sample| sample.values[0]);
    assert!(last <= Some(1.5), "time stops while the invariant holds");
}

#[test]
fn a_reset_into_a_broken_invariant_blocks() {
    let Clock { time, .. } = Clock::coordinates();
    let machine = built(
        clock()
            .invariant(There, time.at_most(0.5))
            .transition(from(Here).on(Go).to(There).must(after(1.0))),
    );
    let trajectory = run(&machine, 5.0);
    assert_eq!(trajectory.ending().reason, Reason::Blocked);
    assert_eq!(trajectory.ending().at, HybridTime { t: 1.0, j: 1 });
}

#[test]
fn jumps_without_end_at_one_instant_reach_the_limit() {
    let machine = built(
        clock()
            .transition(from(Here).on(Go).to(There).must(after(1.0)))
            .transition(from(There).on(Return).to(Here).at_once(always())),
    );
    let trajectory = run(&machine, 5.0);
    let Reason::JumpLimit(Some(last)) = trajectory.ending().reason else {
        panic!("{:?}", trajectory.ending())
    };
    assert_eq!(last.component, 0);
    let text = outcome(&trajectory);
    let name = &trajectory.components()[0].locations[last.location];
    assert!(text.contains(&format!("the last into `{name}`")), "{text}");
    assert_eq!(trajectory.ending().at.t, 1.0);
}

#[test]
fn what_has_no_value_ends_the_run_and_is_named() {
    let Clock { time, count } = Clock::coordinates();
    let undefined = (1.0 - &time).square_root().at_least(2.0);
    let machine = built(clock().transition(from(Here).on(Go).to(There).must(undefined)));
    let trajectory = run(&machine, 5.0);
    assert!((trajectory.ending().at.t - 1.0).abs() < 1e-12, "it runs as far as it can");
    let Reason::Finished(Failure::Formula { location, part, reason, .. }) =
        trajectory.ending().reason.clone()
    else {
        panic!("the guard has no value beyond 1: {:?}", trajectory.ending())
    };
    assert_eq!(location, "here");
    assert_eq!(part, "the guard `√(1 − τ) ≥ 2`");
    assert_eq!(reason, "`√(1 − τ)` is not a number in this state");

    let explodes = built(
        Automaton::starting_in(Here)
            .initially(Clock { time: 1.0, count: 0.0 })
            .flow(Here, [time.rate(time.power(2.0)), count.rate(1.0)]),
    );
    let trajectory = run(&explodes, 5.0);
    assert!(matches!(trajectory.ending().reason, Reason::Finished(Failure::Flow { .. })));
    assert!((trajectory.ending().at.t - 1.0).abs() < 1e-6, "ẋ = x² explodes at 1");
}

/// Whichever transition on its event a participant has first.
#[test]
fn a_label_is_taken_when_any_transition_on_it_has_to_be() {
    let Clock { time, .. } = Clock::coordinates();
    let go = || from(Here).on(Go).to(There);
    let forced = || go().must(time.at_least(1.0));
    let free = || go().may(time.at_least(1.0));
    let other = built(clock().transition(go().may(always())));
    for transitions in [[free(), forced()], [forced(), free()]] {
        let both = built(transitions.into_iter().fold(clock(), |parts, one| parts.transition(one)));
        let pair = Composition::builder().add("one", &both).add("other", &other).label("go");
        let trajectory = pair.build().expect("the parts fit").run(1.0).expect("it can be run");
        let times: Vec<f64> = trajectory.jumps().iter().map(|jump| jump.at.t).collect();
        assert_eq!(times, [1.0]);
    }
}

#[test]
fn a_run_is_repeated_to_the_bit() {
    let machine = built(clock().transition(from(Here).on(Go).to(There).must(after(1.0 / 3.0))));
    assert_eq!(run(&machine, 2.0), run(&machine, 2.0));
}

#[test]
fn inputs_that_read_one_coordinate_add_up() {
    let source = built(clock());
    coordinates! {
        struct Sum { total = "s", left = "a", right = "b" }
    }
    let Sum { total, left, right } = Sum::coordinates();
    let reader: Automaton<Place, Cue, Sum> = Automaton::starting_in(Here)
        .initially(Sum { total: 0.0, left: 0.0, right: 0.0 })
        .flow(Here, total.rate(&left + &right))
        .build()
        .expect("the reader is sound");
    let composition = Composition::builder()
        .add("source", &source)
        .add("reader", &reader)
        .connect("source.τ", "reader.a")
        .connect("source.τ", "reader.b")
        .build()
        .expect("the parts fit");
    let trajectory = composition.run(2.0).expect("it can be run");
    // ṡ = 2t, so s = t².
    let total = trajectory.value("reader.s", 2.0).expect("it lasts");
    assert!((total - 4.0).abs() < 1e-12, "{total}");
}

/// What is read comes first among the coordinates of the reader; whichever of the two is added first.
#[test]
fn a_component_may_begin_with_its_inputs() {
    let source = built(clock());
    coordinates! {
        struct Reader { read = "a", again = "b", total = "s" }
    }
    let Reader { read, again, total } = Reader::coordinates();
    let reader: Automaton<Place, Cue, Reader> = Automaton::starting_in(Here)
        .initially(Reader { read: 0.0, again: 0.0, total: 0.0 })
        .flow(Here, total.rate(&read + &again))
        .transition(from(Here).on(Go).to(There).must((&read * &again).at_least(2.25)))
        .build()
        .expect("the reader is sound");
    for is_first in [true, false] {
        let parts = Composition::builder();
        let parts = if is_first { parts.add("reader", &reader) } else { parts };
        let parts = parts.add("source", &source);
        let parts = if is_first { parts } else { parts.add("reader", &reader) };
        let parts = parts.connect("source.τ", "reader.a").connect("source.τ", "reader.b");
        let trajectory = parts.build().expect("the parts fit").run(2.0).expect("it can be run");
        let jumps: Vec<f64> = trajectory.jumps().iter().map(|jump| jump.at.t).collect();
        assert_eq!(jumps, [1.5]);
        // ṡ = 2t until then, and s rests behind it.
        let total = trajectory.value("reader.s", 2.0).expect("it lasts");
        assert!((total - 2.25).abs() < 1e-12, "{total}");
    }
}

/// What only may be taken waits for the end of an invariant, not for what has to be taken.
#[test]
fn what_has_to_be_taken_right_after_an_instant_goes_before_what_may_be_taken_at_it() {
    let Clock { time, .. } = Clock::coordinates();
    let machine = built(
        clock()
            .transition(from(Here).on(Go).to(There).may(time.at_most(1.0)))
            .transition(from(Here).on(Stay).to(Beyond).must(time.more_than(1.0))),
    );
    let settings = Settings { policy: Policy::Late, ..Settings::default() };
    let trajectory = machine.run_with(settings, 2.0).expect("the machine can be run");
    assert_eq!(labels(&trajectory), [(1f64.next_up(), 0, "stay")]);
}

struct Lamp {
    hours: f64,
    colours: [bool; 2],
}

observed! {
    impl Observed for Lamp as lamp;
    const GLOSSARY;
    quantities {
        /// Hours since the lamp was made.
        age: lamp.hours,
    }
    propositions {
        /// It shows red.
        red: lamp.colours[0],
        /// It shows green.
        green: lamp.colours[1],
    }
}

/// Takes a step of a lamp that shows one colour at a time, as its model says.
fn step_of_lamp(colours: [bool; 2]) -> Place {
    let lamp = Automaton::builder(TransitionTable::new(&[]), Here)
        .transition(from(Here).on(Go).to(There).must(proposition("red")))
        .observing()
        .at_most_one(&[GLOSSARY[1].0, GLOSSARY[2].0])
        .build()
        .expect("the model is complete");
    let mut location = lamp.initial();
    lamp.step(&mut location, &mut Lamp { hours: 0.0, colours }).expect("the guard has a verdict");
    location
}

#[test]
fn a_lamp_shows_no_colour_or_one() {
    assert_eq!([[true, false], [false, true], [false; 2]].map(step_of_lamp), [There, Here, Here]);
}

#[test]
#[cfg(debug_assertions)]
#[should_panic(expected = "these exclude each other")]
fn propositions_that_exclude_each_other_are_not_true_at_once() {
    step_of_lamp([true; 2]);
}
