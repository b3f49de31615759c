//! What runs guarantee, as `docs/guarantees.md` states it: no event is missed in silence, instants do
//! not drift, trajectories are the flows, and every run returns.

use std::f64::consts::TAU;

use pleach_automaton::{
    Accumulation, Automaton, Builder, Composition, Failure, Flow, Limit, Policy, Reason, Settings,
    Trajectory, Why, coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::{Predicate, variable};
use proptest::prelude::*;

vocabulary! {
    enum Place: Location { Here = "here", There = "there" }
    enum Cue: Event { Go = "go", Rest = "rest" }
}
use Cue::{Go, Rest};
use Place::{Here, There};

coordinates! {
    struct One { x }
    struct Body { h, v, clock = "τ" }
    struct Plane { px = "x", py = "y" }
}

type Machine<S> = Automaton<Place, Cue, S>;

fn x() -> pleach_automaton::Coordinate<One> {
    One::coordinates().x
}

/// x = t, with nothing else yet.
fn ramp() -> Builder<Place, Cue, One> {
    Automaton::starting_in(Here).initially(One { x: 0.0 }).flow(Here, x().rate(1.0))
}

fn built<S: pleach_automaton::Coordinates>(builder: Builder<Place, Cue, S>) -> Machine<S> {
    builder.build().expect("the model is sound")
}

fn go(guard: Predicate) -> Machine<One> {
    built(ramp().transition(from(Here).on(Go).to(There).must(guard)))
}

fn run<S: pleach_automaton::Coordinates>(machine: &Machine<S>, horizon: f64) -> Trajectory {
    machine.run(horizon).expect("the model can be run")
}

fn times(trajectory: &Trajectory) -> Vec<f64> {
    trajectory.jumps().iter().map(|jump| jump.at.t).collect()
}

// ---- Events ------------------------------------------------------------------------------------

/// sin 50t = 0.99 first at asin(0.99) ÷ 50 = 0.0285851370694093880097…, by mpmath at 40 digits.
const SINE: f64 = 0.028_585_137_069_409_388;

#[test]
fn a_fast_guard_on_a_slow_flow_is_met_whatever_the_horizon() {
    let machine = go((50.0 * &x()).sin().at_least(0.99));
    for horizon in [0.03, 1.0, 10.0, 100.0, 1e4, 1e6] {
        let trajectory = run(&machine, horizon);
        assert!((times(&trajectory)[0] - SINE).abs() < 1e-16, "{:?}", times(&trajectory));
        assert!(trajectory.doubts().is_empty());
    }
    assert!(times(&run(&machine, 0.028)).is_empty());
}

#[test]
fn a_fast_invariant_on_a_slow_flow_is_kept() {
    let machine = built(ramp().invariant(Here, (50.0 * &x()).sin().at_most(0.99)));
    for horizon in [1.0, 100.0] {
        let trajectory = run(&machine, horizon);
        assert_eq!(trajectory.ending().reason, Reason::Blocked);
        assert!((trajectory.ending().at.t - SINE).abs() < 1e-15);
    }
}

/// A ball above a table that moves by a sin ωt: on impact, its velocity relative to the table turns
/// and shrinks by e.
fn ball_and_table(omega: f64) -> Machine<Body> {
    let Body { h, v, clock } = Body::coordinates();
    let (a, e) = (0.05, 0.8);
    let table = || a * (omega * &clock).sin();
    let speed = || a * omega * (omega * &clock).cos();
    let bounce = [v.becomes(speed() - e * (&v - speed())), h.becomes(table())];
    built(
        Automaton::starting_in(Here)
            .initially(Body { h: 10.0, v: 0.0, clock: 0.0 })
            .flow(Here, [h.rate(&v), v.rate(-1.0), clock.rate(1.0)])
            .transition(
                from(Here)
                    .on(Go)
                    .to(Here)
                    .must(h.at_most(table()) & v.less_than(speed()))
                    .then(bounce),
            ),
    )
}

/// The first impacts with ω = 50, by a scan and mpmath's `findroot` at 40 digits. From impact to
/// impact errors grow some tenfold.
const IMPACTS: [f64; 8] = [
    4.481_730_273_889_152,
    4.532_485_268_821_463,
    10.765_445_938_106_596,
    10.790_836_133_228_32,
    16.540_702_594_580_74,
    16.557_284_515_121_993,
    16.570_648_960_963_916,
    16.588_746_578_060_719,
];

#[test]
fn a_ball_on_a_vibrating_table_meets_it_every_time() {
    let machine = ball_and_table(50.0);
    for horizon in [17.0, 20.0] {
        let found = times(&run(&machine, horizon));
        assert_eq!(found.len(), IMPACTS.len(), "{found:?}");
        for ((found, exact), grown) in found.iter().zip(IMPACTS).zip(1..) {
            assert!((found - exact).abs() < 1e-13 * 10f64.powi(grown), "{found} {exact}");
        }
    }
    assert_eq!(times(&run(&machine, 12.0)).len(), 4, "the horizon is no matter");
    // The ball is never below the table.
    let trajectory = run(&machine, 20.0);
    for step in 0..200_000 {
        let t = 1e-4 * f64::from(step);
        let h = trajectory.value("h", t).expect("the run lasts");
        assert!(h - 0.05 * (50.0 * t).sin() > -1e-9, "{h} at {t}");
    }
}

#[test]
fn what_only_touches_is_said() {
    let wave = || x().sin() + x().cos();
    let trajectory = run(&go(wave().at_least(2f64.sqrt() + 1e-15)), 10.0);
    assert!(trajectory.jumps().is_empty());
    let doubts = trajectory.doubts();
    let at = |t: f64| doubts.iter().any(|doubt| doubt.from <= t && t <= doubt.to);
    assert!(doubts.iter().all(|doubt| doubt.why == Why::Touch && doubt.to - doubt.from < 1e-6));
    assert!(doubts.len() == 2 && at(TAU / 8.0) && at(TAU / 8.0 + TAU), "{doubts:?}");
    assert!(run(&go(wave().at_least(1.4143)), 10.0).doubts().is_empty());
}

#[test]
fn what_is_a_function_is_said() {
    let late = Predicate::function("late", |state| Ok(variable("x").evaluate(state)? - 3.0));
    let trajectory = run(&go(late), 10.0);
    assert!((times(&trajectory)[0] - 3.0).abs() < 1e-14);
    assert!(trajectory.doubts().iter().all(|doubt| doubt.why == Why::Function));
    assert_eq!(trajectory.doubts().len(), 1);

    let advance = |state: &mut One, duration: f64| state.x += duration;
    let exact: Flow<One> = Flow::exact("ẋ = 1", advance);
    let machine = built(
        Automaton::starting_in(Here)
            .initially(One { x: 0.0 })
            .flow(Here, exact)
            .transition(from(Here).on(Go).to(There).must((50.0 * &x()).sin().at_least(0.99))),
    );
    let trajectory = run(&machine, 10.0);
    assert!((times(&trajectory)[0] - SINE).abs() < 1e-12);
    assert_eq!(trajectory.doubts().len(), 1);
    assert_eq!(trajectory.doubts()[0].why, Why::Solution);
}

proptest! {
    #![proptest_config(cases::usually(64))]

    /// sin(a x + b x²) ≥ c on a line, on a parabola by a linear flow and on an integrated flow: the
    /// first root is that of a quadratic equation.
    #[test]
    fn random_models_meet_their_first_root(
        a in 0.5..60.0_f64,
        b in 0.0..20.0_f64,
        c in 0.05..0.999_f64,
    ) {
        let angle = c.asin();
        let exact = 2.0 * angle / (a + (a * a + 4.0 * b * angle).sqrt());
        let Body { h, v, clock } = Body::coordinates();
        let start = Body { h: 0.0, v: a, clock: 0.0 };
        let bend = Automaton::starting_in(Here).initially(start);
        // h = a t + b t².
        let guard = h.sin().at_least(c);
        let linear = [h.rate(&v), v.rate(2.0 * b), clock.rate(1.0)];
        let general = [h.rate(a + 2.0 * b * &clock + 0.0 * h.power(2.0)), clock.rate(1.0)];
        let flows: [Flow<Body>; 2] = [linear.into(), general.into()];
        for (flow, tolerance) in flows.into_iter().zip([1e-13, 1e-8]) {
            let go = from(Here).on(Go).to(There).must(guard.clone());
            let trajectory = run(&built(bend.clone().flow(Here, flow).transition(go)), 50.0);
            let found = times(&trajectory);
            prop_assert!((found[0] - exact).abs() < tolerance * exact, "{} {exact}", found[0]);
        }
    }
}

// ---- Instants ----------------------------------------------------------------------------------

/// A clock that is set back to 0 when it reaches the period.
fn metronome(period: f64, rate: f64) -> Machine<One> {
    built(
        Automaton::starting_in(Here)
            .initially(One { x: 0.0 })
            .flow(Here, x().rate(rate))
            .transition(
                from(Here).on(Go).to(Here).must(x().at_least(period)).then(x().becomes(0.0)),
            ),
    )
}

#[test]
fn ticks_at_the_horizon_are_taken() {
    for (period, horizon, ticks) in [(1.0, 1000.0, 1000), (0.1, 1.0, 10), (0.1, 100.0, 1000)] {
        let trajectory = run(&metronome(period, 1.0), horizon);
        assert_eq!(trajectory.jumps().len(), ticks, "{period} {horizon}");
        assert_eq!(trajectory.ending().at.t, horizon);
    }
}

#[test]
fn a_million_ticks_happen_at_the_nearest_numbers() {
    for (period, rate) in [(0.1, 1.0), (0.7, 3.0)] {
        let trajectory = run(&metronome(period, rate), 1_000_000.5 * period / rate);
        let found = times(&trajectory);
        assert_eq!(found.len(), 1_000_000);
        for (tick, found) in (1..).zip(found) {
            let exact = nearest_multiple(tick, period, rate);
            assert!(exact.contains(&found), "{found} {exact:?}, {tick} · {period} ÷ {rate}");
        }
    }
}

/// The number nearest to k · p ÷ r, by whole numbers: p = m · 2⁻ˢ. Of two that are equally near, the
/// smaller and the larger.
fn nearest_multiple(tick: u32, period: f64, rate: f64) -> [f64; 2] {
    let shift = 58 - period.log2().floor() as i32;
    let mantissa = (period * 2f64.powi(shift)) as u128;
    let scaled = (u128::from(tick) * mantissa) << 20;
    let (quotient, rest) = (scaled / rate as u128, scaled % rate as u128);
    let spare = (128 - quotient.leading_zeros()).saturating_sub(53);
    let (kept, dropped) = (quotient >> spare, quotient & ((1 << spare) - 1));
    let half = 1u128 << (spare - 1);
    let number = |kept: u128| kept as f64 * 2f64.powi(spare as i32 - shift - 20);
    let is_half = dropped == half && rest == 0;
    let up = number(kept + u128::from(dropped >= half));
    [if is_half { number(kept) } else { up }, up]
}

/// A sampled controller: at every tick the force is set by what is measured, and the clock set back.
#[test]
fn sampled_controls_do_not_drift() {
    let Body { h, v, clock } = Body::coordinates();
    let machine = built(
        Automaton::starting_in(Here)
            .initially(Body { h: 1.0, v: 0.0, clock: 0.0 })
            .flow(Here, [h.rate(&v), v.rate(-1.0 * &v - &h), clock.rate(1.0)])
            .transition(
                from(Here)
                    .on(Go)
                    .to(Here)
                    .must(clock.at_least(0.01))
                    .then([v.becomes(&v - 0.1 * &h), clock.becomes(0.0)]),
            ),
    );
    let trajectory = run(&machine, 1000.0);
    let found = times(&trajectory);
    assert_eq!(found.len(), 100_000);
    for (tick, found) in (1..).zip(found) {
        assert!(nearest_multiple(tick, 0.01, 1.0).contains(&found), "tick {tick} at {found}");
    }
}

#[test]
fn early_events_are_as_exact_before_a_far_horizon() {
    let found = times(&run(&go(x().at_least(0.1)), 1e9));
    assert_eq!(found, [0.1]);
    let found = times(&run(&go(x().power(3.0).at_least(0.001)), 1e9));
    assert!((found[0] - 0.1).abs() < 1e-16, "{found:?}");
}

// ---- Trajectories ------------------------------------------------------------------------------

#[test]
fn an_oscillator_is_read_right_everywhere() {
    let Plane { px, py } = Plane::coordinates();
    let machine: Machine<Plane> = built(
        Automaton::starting_in(Here)
            .initially(Plane { px: 1.0, py: 0.0 })
            .flow(Here, [px.rate(&py), py.rate(-1.0 * &px)]),
    );
    let trajectory = run(&machine, 1e4);
    for step in 0..100_000 {
        let t = 0.099_999 * f64::from(step);
        let values = trajectory.values_at(t).expect("the run lasts");
        assert!((values[0] - t.cos()).abs() < 1e-11, "{} at {t}", values[0]);
        assert!((values[1] + t.sin()).abs() < 1e-11, "{} at {t}", values[1]);
    }
}

// ---- Every run returns -------------------------------------------------------------------------

#[test]
fn a_flow_ends_where_it_is_singular() {
    let Plane { px, py } = Plane::coordinates();
    let singular = |rate: pleach_guards::Expression| {
        let machine: Machine<Plane> = built(
            Automaton::starting_in(Here)
                .initially(Plane { px: 0.0, py: 0.0 })
                .flow(Here, [px.rate(1.0), py.rate(rate)]),
        );
        run(&machine, 1.1)
    };
    for power in [-1.0, -2.0, -3.0] {
        let trajectory = singular((&px - 1.0).power(power));
        let Reason::Finished(Failure::Flow { reason, .. }) = &trajectory.ending().reason else {
            panic!("{:?}", trajectory.ending())
        };
        assert!((trajectory.ending().at.t - 1.0).abs() < 1e-9, "{:?}", trajectory.ending());
        assert!(!reason.is_empty());
    }
    let quotient = singular(1.0 / (&px - 1.0));
    assert!((quotient.ending().at.t - 1.0).abs() < 1e-9, "{:?}", quotient.ending());
    // What has no pole goes on.
    assert_eq!(singular(1.0 / (&px + 1.0)).ending().reason, Reason::Horizon);
}

/// A table so fast that the ball comes to hop by one spacing of the numbers at a time.
#[test]
fn jumps_that_leave_no_time_end_the_run() {
    let trajectory = run(&ball_and_table(200.0), 100.0);
    let reason = &trajectory.ending().reason;
    let ends = matches!(reason, Reason::JumpLimit | Reason::Zeno(_) | Reason::Horizon);
    assert!(ends && trajectory.jumps().len() < 100_000, "{:?}", trajectory.ending());
}

#[test]
fn limits_end_a_run_with_instant_and_reason() {
    let few = Settings { jump_limit: 10, ..Settings::default() };
    let trajectory = metronome(0.5, 1.0).run_with(few, 100.0).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Limit(Limit::Jumps(10)));
    assert_eq!((trajectory.ending().at.t, trajectory.jumps().len()), (5.5, 10));

    let small = Settings { memory_limit: 100_000, ..Settings::default() };
    let trajectory = metronome(0.5, 1.0).run_with(small, 1e6).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Limit(Limit::Memory(100_000)));

    let short = Settings { step_limit: 100, ..Settings::default() };
    let touching = go((x().sin() + x().cos()).at_least(2f64.sqrt() + 1e-15));
    let trajectory = touching.run_with(short, 1e6).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Limit(Limit::Steps(100)));
    let at = trajectory.ending().at.t;
    assert!(at < 1e6 && trajectory.value("x", at).is_some_and(|x| (x - at).abs() < 1e-9));
}

// ---- Accumulation ------------------------------------------------------------------------------

/// A ball that is taken to rest once it is slow.
fn resting_ball() -> Machine<Body> {
    let Body { h, v, clock } = Body::coordinates();
    built(
        Automaton::starting_in(Here)
            .initially(Body { h: 1.0, v: 0.0, clock: 0.0 })
            .flow(Here, [h.rate(&v), v.rate(-1.0), clock.rate(1.0)])
            .transition(
                from(Here)
                    .on(Rest)
                    .to(There)
                    .must(h.at_most(0.0) & v.at_most(0.0) & v.at_least(-1e-6))
                    .then([h.becomes(0.0), v.becomes(0.0)]),
            )
            .transition(
                from(Here)
                    .on(Go)
                    .to(Here)
                    .must(h.at_most(0.0) & v.less_than(0.0))
                    .then([v.becomes(-0.5 * &v)])
                    .priority(1),
            ),
    )
}

#[test]
fn a_model_that_ends_its_bounces_itself_may_do_so() {
    let ended = run(&resting_ball(), 100.0);
    assert!(matches!(ended.ending().reason, Reason::Zeno(_)));
    let off = Settings { accumulation: Accumulation::Off, ..Settings::default() };
    let trajectory = resting_ball().run_with(off, 100.0).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    let last = trajectory.jumps().last().expect("it bounces");
    assert_eq!(last.label, "rest");
    // √2 for the fall and √2 · Σ 2 · ½ᵏ for the bounces: 3 √2.
    assert!((last.at.t - 3.0 * 2f64.sqrt()).abs() < 1e-5, "{}", last.at.t);
    assert_eq!(trajectory.value("h", 50.0), Some(0.0));
}

/// Two balls, of which one rests at the limit of its bounces by what the model says.
#[test]
fn a_component_goes_on_past_its_limit_point_where_the_model_says_how() {
    let clock = metronome(0.25, 1.0);
    let pair = || Composition::builder().add("clock", &clock).add("ball", &resting_ball());
    let pair = pair().past_accumulation("rest").build().expect("the parts fit");
    let trajectory = pair.run(10.0).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    let rest = trajectory.jumps().iter().find(|jump| jump.label == "rest").expect("it rests");
    assert!((rest.at.t - 3.0 * 2f64.sqrt()).abs() < 1e-8, "{rest}");
    assert_eq!(trajectory.value("ball.h", 9.0), Some(0.0));
    assert!(trajectory.value("ball.τ", 4.0).is_some_and(|clock| (clock - 4.0).abs() < 1e-12));
    assert!(trajectory.jumps().iter().filter(|jump| jump.label == "go").count() > 40);

    let one = Composition::builder().add("ball", &resting_ball());
    let one = one.at_accumulation(Accumulation::Off).build().expect("it fits");
    assert_eq!(one.run(10.0).expect("it can be run").ending().reason, Reason::Horizon);
    assert!(Composition::builder().add("ball", &clock).past_accumulation("fly").build().is_err());
}

// ---- Choice ------------------------------------------------------------------------------------

/// Leaves between 1 and 3, by one of two edges with one event.
fn wanderer() -> Machine<One> {
    let within = || x().at_least(1.0) & x().at_most(3.0);
    built(
        ramp()
            .invariant(Here, x().at_most(3.0))
            .transition(from(Here).on(Go).to(There).may(within()).then(x().becomes(10.0)))
            .transition(from(Here).on(Go).to(There).may(within()).then(x().becomes(20.0))),
    )
}

#[test]
fn chance_takes_every_instant_and_edge_and_equal_seeds_agree() {
    let runs = |seed: u64| {
        let policy = Policy::Random { seed };
        let settings = Settings { policy, ..Settings::default() };
        wanderer().run_with(settings, 5.0).expect("it can be run")
    };
    let (mut low, mut high, mut first, mut earliest, mut latest) = (0, 0, 0, 3.0_f64, 1.0_f64);
    for seed in 0..400 {
        let trajectory = runs(seed);
        let t = trajectory.jumps().first().map(|jump| jump.at.t);
        let t = t.unwrap_or_else(|| panic!("{seed}: {:?}", trajectory.ending()));
        assert!((1.0..=3.0).contains(&t), "{t}");
        (earliest, latest) = (earliest.min(t), latest.max(t));
        (low, high) = if t < 2.0 { (low + 1, high) } else { (low, high + 1) };
        first += usize::from(trajectory.value("x", t) == Some(10.0));
    }
    assert!(low > 150 && high > 150, "{low} {high}");
    assert!((150..250).contains(&first), "{first}");
    assert!(earliest < 1.05 && latest > 2.95, "{earliest} {latest}");
    assert_eq!(runs(7), runs(7));
    let late = run(&wanderer(), 5.0);
    assert!((times(&late)[0] - 3.0).abs() < 1e-14);
    assert_eq!(late.value("x", 4.0), Some(10.0), "the edge declared first");
}

/// ẋ = −sgn x, once with guards that hold on the boundary and once with guards that do not.
#[test]
fn sliding_is_recognised() {
    let side = |down: Predicate, up: Predicate| {
        built(
            Automaton::starting_in(Here)
                .initially(One { x: 1.0 })
                .flow(Here, x().rate(-1.0))
                .flow(There, x().rate(3.0))
                .transition(from(Here).on(Go).to(There).must(down))
                .transition(from(There).on(Rest).to(Here).must(up)),
        )
    };
    let closed = side(x().at_most(0.0), x().at_least(0.0));
    let open = side(x().less_than(0.0), x().more_than(0.0));
    for machine in [closed, open] {
        let trajectory = run(&machine, 5.0);
        let Reason::Sliding(sliding) = trajectory.ending().reason else {
            panic!("{:?}", trajectory.ending())
        };
        assert!((trajectory.ending().at.t - 1.0).abs() < 1e-9);
        let mut locations = sliding.locations;
        locations.sort_unstable();
        assert_eq!((sliding.component, locations), (0, [0, 1]));
        // ¾ of the first flow and ¼ of the second stay where they are.
        let share = if sliding.locations[1] == 1 { 0.25 } else { 0.75 };
        assert!((sliding.share - share).abs() < 1e-12, "{sliding:?}");
    }
}

// ---- Many components ---------------------------------------------------------------------------

#[test]
fn what_happens_elsewhere_changes_nothing() {
    let alone = run(&ball_and_table(50.0), 17.0);
    let clocks = (1..=50).map(|number| metronome(0.01 * f64::from(number), 1.0));
    let mut crowd = Composition::builder().add("ball", &ball_and_table(50.0));
    for (number, clock) in clocks.enumerate() {
        crowd = crowd.add(&format!("clock {number}"), &clock);
    }
    let crowd = crowd.build().expect("the parts fit").run(17.0).expect("it can be run");
    let of_ball = crowd.jumps().iter().filter(|jump| jump.moves[0].component == 0);
    let of_ball: Vec<f64> = of_ball.map(|jump| jump.at.t).collect();
    assert_eq!(of_ball, times(&alone));
    assert!(crowd.jumps().is_sorted_by(|one, next| one.at.t <= next.at.t));
    for step in 0..1700 {
        let t = 0.01 * f64::from(step);
        assert_eq!(crowd.value("ball.h", t), alone.value("h", t));
    }
}

#[test]
fn a_hundred_thousand_components_run() {
    let names = (0..100_000).map(|number| format!("clock {number}"));
    let crowd = Composition::builder().add_each(names, &metronome(1.0, 1.0)).build();
    let trajectory = crowd.expect("the parts fit").run(3.5).expect("it can be run");
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    assert_eq!(trajectory.jumps().len(), 300_000);
    assert_eq!(trajectory.value("clock 99999.x", 3.5), Some(0.5));
}

#[test]
fn policies_and_limits_concern_each_group_alone() {
    // One component is stuck at 1 and leaves as late as it can; the other one may go all the time.
    let late = built(
        ramp()
            .invariant(Here, x().at_most(1.0))
            .transition(from(Here).on(Go).to(There).may(x().at_least(0.0))),
    );
    let free = built(ramp().transition(from(Here).on(Rest).to(There).may(x().at_least(0.0))));
    let pair = Composition::builder().add("late", &late).add("free", &free).build();
    let pair = pair.expect("the parts fit");
    let trajectory = pair.run(2.0).expect("it can be run");
    let labels: Vec<&str> = trajectory.jumps().iter().map(|jump| &*jump.label).collect();
    assert_eq!(labels, ["go"]);
    let early = Settings { policy: Policy::Early, ..Settings::default() };
    let trajectory = pair.run_with(early, 2.0).expect("it can be run");
    assert_eq!(trajectory.jumps().len(), 2);
}
