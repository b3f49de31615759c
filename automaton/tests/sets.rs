//! Resets to intervals: what a run takes of them, what is said of them, and what checks find.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use pleach_automaton::check::Kind;
use pleach_automaton::diagram::{latex, mermaid};
use pleach_automaton::{
    Automaton, Builder, Composition, ExplorationError, Failure, Policy, Reason, Settings,
    Trajectory, coordinates, from,
};
use pleach_discrete::vocabulary;
use pleach_guards::Expression;

vocabulary! {
    enum Motion: Location { Falling = "falling", Resting = "resting" }
    enum Contact: Event { Bounce = "bounce", Stop = "stop" }
}
coordinates! { struct Ball { height = "h", velocity = "v" } }
use Contact::{Bounce, Stop};
use Motion::{Falling, Resting};

/// A ball that keeps between `least` and `most` of its speed.
fn ball(
    least: impl Into<Expression>,
    most: impl Into<Expression>,
) -> Builder<Motion, Contact, Ball> {
    let Ball { height, velocity } = Ball::coordinates();
    let (least, most) = (least.into(), most.into());
    Automaton::starting_in(Falling)
        .initially(Ball { height: 5.0, velocity: 0.0 })
        .range(&height, 0.0..=5.0)
        .range(&velocity, -10.0..=10.0)
        .flow(Falling, [height.rate(&velocity), velocity.rate(-10.0)])
        .invariant(Falling, height.at_least(0.0))
        .transition(
            from(Falling)
                .on(Bounce)
                .to(Falling)
                .must(height.at_most(0.0) & velocity.less_than(0.0))
                .then(velocity.becomes_within(-least * &velocity, -most * &velocity)),
        )
}

fn run(policy: Policy) -> Trajectory {
    let settings = Settings { policy, ..Settings::default() };
    ball(0.5, 0.8).build().unwrap().run_with(settings, 2.7).unwrap()
}

/// The first two impacts: after 1 s with 10 m/s, and then as long as the part kept says.
fn kept(trajectory: &Trajectory) -> f64 {
    let [first, second] = [0, 1].map(|number| trajectory.jumps()[number].at.t);
    assert!((first - 1.0).abs() < 1e-12);
    0.5 * (second - first)
}

#[test]
fn early_takes_the_lower_end_and_late_the_upper() {
    assert!((kept(&run(Policy::Early)) - 0.5).abs() < 1e-12);
    assert!((kept(&run(Policy::Late)) - 0.8).abs() < 1e-12);
    let Ball { velocity, .. } = Ball::coordinates();
    let ball = ball(0.5, 0.8).build().unwrap();
    let (mut location, mut state) = (Falling, Ball { height: 0.0, velocity: -10.0 });
    ball.step(&mut location, &mut state).unwrap().unwrap();
    assert_eq!(state.velocity, 5.0, "{}", velocity.name());
}

/// What has to be taken leaves nothing to chance but the number, whenever it is.
#[test]
fn where_there_is_no_choice_nothing_is_drawn() {
    let Ball { height, velocity } = Ball::coordinates();
    let drawn = |wait: f64, seed: u64| {
        let due = height.at_least(wait) & velocity.at_most(0.0);
        let reset = velocity.becomes_within(1.0, 2.0);
        let parts = Automaton::starting_in(Falling)
            .initially(Ball { height: 0.0, velocity: 0.0 })
            .flow(Falling, height.rate(1.0))
            .transition(from(Falling).on(Bounce).to(Resting).must(due).then(reset));
        let settings = Settings { policy: Policy::Random { seed }, ..Settings::default() };
        let trajectory = parts.build().unwrap().run_with(settings, 5.0).unwrap();
        assert_eq!(trajectory.jumps()[0].at.t, wait);
        trajectory.value("v", 5.0).unwrap()
    };
    for seed in 0..20 {
        let [at_once, later] = [0.0, 3.0].map(|wait| drawn(wait, seed));
        assert!(at_once == later && (1.0..=2.0).contains(&later), "{at_once}, {later}");
    }
}

#[test]
fn chance_takes_every_part_of_an_interval_and_equal_seeds_agree() {
    let mut counts = [0; 3];
    for seed in 0..600 {
        let trajectory = run(Policy::Random { seed });
        let kept = kept(&trajectory);
        assert!((0.5 - 1e-12..0.8 + 1e-12).contains(&kept), "{kept}");
        counts[(((kept - 0.5) / 0.1) as usize).min(2)] += 1;
    }
    assert!(counts.iter().all(|count| (150..250).contains(count)), "{counts:?}");
    assert_eq!(run(Policy::Random { seed: 4 }), run(Policy::Random { seed: 4 }));
    assert_ne!(run(Policy::Random { seed: 4 }), run(Policy::Random { seed: 5 }));
}

#[test]
fn what_was_drawn_is_recorded_and_replayed() {
    let trajectory = run(Policy::Random { seed: 11 });
    let mut file = Vec::new();
    trajectory.write(&mut file).unwrap();
    let read = Trajectory::read(&file[..]).unwrap();
    assert_eq!(read, trajectory);
    let ball = ball(0.5, 0.8).build().unwrap();
    let composition = Composition::builder().add("automaton", &ball).build().unwrap();
    assert_eq!(composition.replay(&read), Ok(()));
}

#[test]
fn texts_show_the_interval() {
    let ball = ball(0.5, 0.8).build().unwrap();
    assert!(mermaid(&ball).contains("∈ [−0.5 · v, −0.8 · v]"), "{}", mermaid(&ball));
    assert!(latex(&ball).contains(r"\left["), "{}", latex(&ball));
}

#[test]
fn an_empty_interval_ends_the_run_and_checks_warn_of_it() {
    let ball = ball(0.8, 0.5).build().unwrap();
    let trajectory = ball.run(2.0).unwrap();
    let Reason::Finished(Failure::Formula { reason, .. }) = &trajectory.ending().reason else {
        panic!("{:?}", trajectory.ending())
    };
    assert!(reason.contains("the new v"), "{reason}");
    assert!((trajectory.ending().at.t - 1.0).abs() < 1e-12);
    let report = ball.check();
    let finding = report.findings().iter().find(|one| one.kind == Kind::Undefined).unwrap();
    assert!(finding.message.contains("is empty"), "{finding}");
}

/// Only some numbers of the interval lie outside the invariant; the witness tells one.
#[test]
fn checks_look_at_every_number_of_an_interval() {
    let report = ball(0.5, 0.8).build().unwrap().check();
    let kinds = [Kind::LandsOutside, Kind::Undefined, Kind::LeavesRange, Kind::Blocked];
    assert!(!report.findings().iter().any(|one| kinds.contains(&one.kind)), "{report}");
    let Ball { height, .. } = Ball::coordinates();
    let stopping = |least: f64| {
        ball(0.5, 0.8)
            .invariant(Resting, height.at_least(0.0))
            .transition(
                from(Falling)
                    .on(Stop)
                    .to(Resting)
                    .may(height.at_least(1.0))
                    .then(height.becomes_within(&height - least, &height)),
            )
            .build()
            .unwrap()
            .check()
    };
    let lands_outside = |least: f64| {
        let report = stopping(least);
        report.findings().iter().any(|one| one.kind == Kind::LandsOutside)
    };
    assert!(!lands_outside(1.0) && lands_outside(1.5), "{}", stopping(1.5));
    assert!(stopping(1.5).to_string().contains("share of the interval of h"), "{}", stopping(1.5));
}

#[test]
fn intervals_cannot_be_explored() {
    let Ball { height, .. } = Ball::coordinates();
    let lottery = Automaton::starting_in(Falling)
        .initially(Ball { height: 0.0, velocity: 0.0 })
        .transition(
            from(Falling)
                .on(Stop)
                .to(Resting)
                .may(height.at_least(0.0))
                .then(height.becomes_within(0.0, 1.0)),
        )
        .build()
        .unwrap();
    let composition = Composition::builder().add("lottery", &lottery).build().unwrap();
    let error = composition.explore(10).err().unwrap();
    let expected = ExplorationError::Interval { variable: "h".into(), event: "stop".into() };
    assert_eq!(error, expected);
}
