//! A bouncing ball against its closed form.

use pleach_automaton::{Automaton, Reason, coordinates, from};
use pleach_discrete::vocabulary;

vocabulary! {
    enum Motion: Location { Falling = "falling" }
    enum Contact: Event { Bounce = "bounce" }
}

coordinates! {
    struct Ball { height = "h", velocity = "v" }
}

const GRAVITY: f64 = 9.81;
const RESTITUTION: f64 = 0.8;

fn ball() -> Automaton<Motion, Contact, Ball> {
    let Ball { height, velocity } = Ball::coordinates();
    Automaton::starting_in(Motion::Falling)
        .initially(Ball { height: 10.0, velocity: 0.0 })
        .flow(Motion::Falling, [height.rate(&velocity), velocity.rate(-GRAVITY)])
        .invariant(Motion::Falling, height.at_least(0.0))
        .transition(
            from(Motion::Falling)
                .on(Contact::Bounce)
                .to(Motion::Falling)
                .must(height.at_most(0.0) & velocity.less_than(0.0))
                .then([velocity.becomes(-RESTITUTION * &velocity)]),
        )
        .build()
        .expect("the model is sound")
}

#[test]
fn it_bounces_where_the_closed_form_says_and_is_zeno() {
    let trajectory = ball().run(20.0).expect("it can be run");
    println!("{:?} {}", trajectory.ending(), trajectory.jumps().len());
    let first = (2.0 * 10.0 / GRAVITY).sqrt();
    let mut expected = first;
    let mut flight = 2.0 * first * RESTITUTION;
    for jump in trajectory.jumps() {
        assert!((jump.at.t - expected).abs() < 1e-10, "{jump} {expected}");
        expected += flight;
        flight *= RESTITUTION;
    }
    let limit = first * (1.0 + RESTITUTION) / (1.0 - RESTITUTION);
    let Reason::Zeno(zeno) = trajectory.ending().reason else {
        panic!("{:?}", trajectory.ending())
    };
    assert!((zeno.accumulation - limit).abs() < 1e-9 * limit, "{zeno:?} {limit}");
}
