//! A bouncing ball against its closed form.

use crate::common::classics::ball;
use pleach_automaton::Reason;

const GRAVITY: f64 = 9.81;
const RESTITUTION: f64 = 0.8;

#[test]
fn it_bounces_where_the_closed_form_says_and_is_zeno() {
    let trajectory = ball().run(20.0).expect("it can be run");
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
