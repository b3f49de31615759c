//! Jumps that accumulate.

use pleach_automaton::check::Kind;
use pleach_automaton::composition::ProductError;
use pleach_automaton::{Accumulation, Automaton, Composition, Reason, Settings, from};
use pleach_guards::never;

use super::Cue::{Go, Rest};
use super::Place::{Here, There};
use super::{Body, Machine, built, metronome, run};

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
    assert_eq!(trajectory.value("h", 50.0), Ok(0.0));
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
    assert_eq!(trajectory.value("ball.h", 9.0), Ok(0.0));
    assert!(trajectory.value("ball.τ", 4.0).is_ok_and(|clock| (clock - 4.0).abs() < 1e-12));
    assert!(trajectory.jumps().iter().filter(|jump| jump.label == "go").count() > 40);

    // What follows an accumulation is no state of a product, and a check knows that it may follow.
    assert!(
        matches!(pair.product(), Err(ProductError::Accumulation { component }) if component == "ball")
    );

    let one = Composition::builder().add("ball", &resting_ball());
    let one = one.at_accumulation(Accumulation::Off).build().expect("it fits");
    assert_eq!(one.run(10.0).expect("it can be run").ending().reason, Reason::Horizon);
    assert!(Composition::builder().add("ball", &clock).past_accumulation("fly").build().is_err());
}

/// The transition beyond an accumulation is taken whatever its guard says, and so may be what follows it.
#[test]
fn checks_know_what_may_follow_an_accumulation() {
    let Body { h, v, clock } = Body::coordinates();
    let ball = built(
        Automaton::starting_in(Here)
            .initially(Body { h: 1.0, v: 0.0, clock: 0.0 })
            .flow(Here, [h.rate(&v), v.rate(-1.0), clock.rate(1.0)])
            .flow(There, clock.rate(1.0))
            .transition(
                from(Here)
                    .on(Go)
                    .to(Here)
                    .must(h.at_most(0.0) & v.less_than(0.0))
                    .then([v.becomes(-0.5 * &v)]),
            )
            .transition(from(Here).on(Rest).to(There).may(never()).then(v.becomes(0.0)))
            .transition(from(There).on(Rest).to(Here).must(clock.at_least(9.0))),
    );
    let kinds = |one: &Composition| -> Vec<Kind> {
        let report = one.check();
        report.findings().iter().map(|finding| finding.kind).collect()
    };
    let alone = Composition::builder().add("ball", &ball).build().expect("it fits");
    assert!(
        kinds(&alone).contains(&Kind::NeverFires) && kinds(&alone).contains(&Kind::Unreachable)
    );
    let going_on = Composition::builder().add("ball", &ball).past_accumulation("rest").build();
    let going_on = going_on.expect("it fits");
    let trajectory = going_on.run(10.0).expect("it can be run");
    assert_eq!(trajectory.jumps().iter().filter(|jump| jump.label == "rest").count(), 2);
    let found = kinds(&going_on);
    assert!(!found.contains(&Kind::NeverFires) && !found.contains(&Kind::Unreachable), "{found:?}");
}
