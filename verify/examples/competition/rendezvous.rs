//! A spacecraft approaches another one, and may abort (SRNA01, SRA01 to SRA04).
//!
//! Model and numbers: N. Chan and S. Mitra, *Verifying safety of an autonomous spacecraft rendezvous
//! mission*, ARCH 2017, in the linear form of the ARCH-COMP reports (AFF). Lengths in metres, times
//! in minutes.

use pleach_automaton::{Automaton, Coordinate, Name, Rate, Record, from};
use pleach_guards::{Expression, Interval, Predicate, variable};
use pleach_verify::reach::{Forbidden, Settings, StateSet};

use crate::{Instance, TestResult};

/// (vx, vy) ̇ as rows over (x, y, vx, vy).
type Gains = [[f64; 4]; 2];

const APPROACHING: Gains = [
    [-0.057599765881773, 0.000200959896519766, -2.89995083970656, 0.00877200894463775],
    [-0.000174031357370456, -0.0665123984901026, -0.00875351105536225, -2.90300269286856],
];

const ATTEMPT: Gains = [
    [-0.575999943070835, 0.000262486079431672, -19.2299795908647, 0.00876275931760007],
    [-0.000262486080737868, -0.575999940191886, -0.00876276068239993, -19.2299765959399],
];

const ABORTING: Gains = [[0.0000575894721132, 0.0, 0.0, 0.00876276], [0.0, 0.0, -0.00876276, 0.0]];

/// The mission, which is aborted at some time in `abort`, if it is.
pub fn mission(abort: Option<(f64, f64)>, settings: Settings) -> TestResult<Instance> {
    let state = Record::new([("x", -900.0), ("y", -400.0), ("vx", 0.0), ("vy", 0.0), ("t", 0.0)])?;
    let coordinates = state.coordinates();
    let [x, y, _, _, t] = &coordinates[..] else { return Err("five coordinates".into()) };
    let [approaching, attempt, aborting] = ["approaching", "attempt", "aborting"].map(Name::new);
    let [come_near, give_up] = ["come near", "give up"].map(Name::new);
    let near = octagon(x, y, 100.0, 141.1);
    let mut builder = Automaton::<Name, Name, Record>::starting_in(approaching)
        .initially(state.clone())
        .flow(approaching, rates(&coordinates, &APPROACHING))
        .flow(attempt, rates(&coordinates, &ATTEMPT))
        .transition(from(approaching).on(come_near).to(attempt).may(near.clone()));
    let (mut far, mut close) = (x.at_most(-100.0), near);
    if let Some((first, last)) = abort {
        (far, close) = (far & t.at_most(last), close & t.at_most(last));
        builder = builder
            .flow(aborting, rates(&coordinates, &ABORTING))
            .transition(from(approaching).on(give_up).to(aborting).may(t.at_least(first)))
            .transition(from(attempt).on(give_up).to(aborting).may(t.at_least(first)));
    }
    let automaton = builder.invariant(approaching, far).invariant(attempt, close).build()?;
    let sides = [(-925.0, -875.0), (-425.0, -375.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)];
    let sides = sides.map(|(lower, upper)| Interval::new(lower, upper));
    Ok(Instance {
        automaton,
        starts: vec![StateSet::from_box(sides.into_iter().collect::<Result<_, _>>()?)],
        uncertain: Vec::new(),
        forbidden: specification(abort.is_some()),
        settings,
        measured: Vec::new(),
    })
}

fn rates(coordinates: &[Coordinate<Record>], gains: &Gains) -> Vec<Rate<Record>> {
    let row = |gains: &[f64; 4]| -> Expression {
        gains.iter().zip(coordinates).map(|(gain, coordinate)| *gain * coordinate).sum()
    };
    vec![
        coordinates[0].rate(&coordinates[2]),
        coordinates[1].rate(&coordinates[3]),
        coordinates[2].rate(row(&gains[0])),
        coordinates[3].rate(row(&gains[1])),
        coordinates[4].rate(1.0),
    ]
}

/// |x| ≤ a, |y| ≤ a, |x + y| ≤ b, |x − y| ≤ b.
fn octagon(x: &Expression, y: &Expression, a: f64, b: f64) -> Predicate {
    let within = |value: Expression, bound: f64| value.at_most(bound) & value.at_least(-bound);
    within(x.clone(), a) & within(y.clone(), a) & within(x + y, b) & within(y - x, b)
}

/// In the attempt: in the line of sight, and not too fast. Aborting: out of the target.
fn specification(aborts: bool) -> Vec<Forbidden> {
    let [x, y, vx, vy] = ["x", "y", "vx", "vy"].map(variable);
    let slope = (std::f64::consts::PI / 6.0).tan();
    let speed = 0.055 * 60.0;
    let corner = std::f64::consts::PI / 8.0;
    let (cx, cy) = (speed * corner.cos(), speed * corner.sin());
    let fast = !octagon(&vx, &vy, cx, cx + cy);
    let out_of_sight = x.less_than(-100.0) | y.less_than(slope * &x) | (-&y).less_than(slope * &x);
    let mut forbidden =
        vec![Forbidden::within("attempt", out_of_sight), Forbidden::within("attempt", fast)];
    if aborts {
        let target = x.at_least(-0.2) & x.at_most(0.2) & y.at_least(-0.2) & y.at_most(0.2);
        forbidden.push(Forbidden::within("aborting", target));
    }
    forbidden
}
