//! A trajectory is the flow.

use pleach_automaton::Automaton;

use super::Place::Here;
use super::{Machine, Plane, built, run};

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
