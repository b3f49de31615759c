//! A sleeve that meshes with a gear, after bouncing between its teeth (GRBX01, GRBX02).
//!
//! Model and numbers: H. Chen, S. Mitra and G. Tian, *Motor-transmission drive system: a benchmark
//! example for safety verification*, ARCH 2014, in the form of the ARCH-COMP reports (AFF). Lengths in
//! metres, times in seconds.

use pleach_automaton::{Automaton, Name, Record, from};
use pleach_guards::{Expression, Interval};
use pleach_verify::reach::{Forbidden, Settings, StateSet};

use crate::{Instance, TestResult};

const RESTITUTION: f64 = 0.9;
const SLEEVE_MASS: f64 = 3.2;
const GEAR_MASS: f64 = 18.1;
const GEAR_INERTIA: f64 = 0.7;
const SLEEVE_RADIUS: f64 = 0.08;
/// Half the angle of a tooth, in radians.
const ANGLE: f64 = 0.628318530717959;
const SHIFTING_FORCE: f64 = 70.0;
const RESISTING_MOMENT: f64 = 1.0;
/// Where the sleeve meshes.
const MESHED_AT: f64 = -0.003;

/// The sleeve begins in px ± `spread.0` and py ± `spread.1` around (−0.0167, 0.003).
pub fn shift(spread: (f64, f64), mut settings: Settings) -> TestResult<Instance> {
    let names = ["vx", "vy", "px", "py", "I"];
    let state = Record::new(names.map(|name| (name, 0.0)))?;
    let coordinates = state.coordinates();
    let [vx, vy, px, py, impulse] = &coordinates[..] else { return Err("five coordinates".into()) };
    let [free, meshed] = ["free", "meshed"].map(Name::new);
    let [upper_tooth, lower_tooth, mesh] = ["upper tooth", "lower tooth", "mesh"].map(Name::new);
    let (sine, cosine, slope) = (ANGLE.sin(), ANGLE.cos(), ANGLE.tan());
    let total = SLEEVE_MASS * cosine.powi(2) + GEAR_MASS * sine.powi(2);
    let keep_x = (SLEEVE_MASS * cosine.powi(2) - GEAR_MASS * RESTITUTION * sine.powi(2)) / total;
    let cross_x = -(RESTITUTION + 1.0) * GEAR_MASS * sine * cosine / total;
    let cross_y = -(RESTITUTION + 1.0) * SLEEVE_MASS * sine * cosine / total;
    let keep_y = (GEAR_MASS * sine.powi(2) - SLEEVE_MASS * RESTITUTION * cosine.powi(2)) / total;
    let push = (RESTITUTION + 1.0) * SLEEVE_MASS * GEAR_MASS / total;
    // `side` is 1 at the upper tooth and −1 at the lower one.
    let bounce = |side: f64| {
        let closing: Expression = sine * vx + (side * cosine) * vy;
        [
            vx.becomes(keep_x * vx + (side * cross_x) * vy),
            vy.becomes((side * cross_y) * vx + keep_y * vy),
            impulse.becomes(impulse + push * closing),
        ]
    };
    let closing = |side: f64| (sine * vx + (side * cosine) * vy).more_than(0.0);
    let automaton = Automaton::<Name, Name, Record>::starting_in(free)
        .initially(Record::new([
            ("vx", 0.0),
            ("vy", 0.0),
            ("px", -0.0167),
            ("py", 0.003),
            ("I", 0.0),
        ])?)
        .flow(
            free,
            [
                vx.rate(SHIFTING_FORCE / SLEEVE_MASS),
                vy.rate(-SLEEVE_RADIUS * RESISTING_MOMENT / GEAR_INERTIA),
                px.rate(vx),
                py.rate(vy),
            ],
        )
        .invariant(
            free,
            px.at_most(MESHED_AT) & (py + slope * px).at_most(0.0) & (slope * px - py).at_most(0.0),
        )
        .transition(
            from(free)
                .on(upper_tooth)
                .to(free)
                .may((py + slope * px).at_least(0.0) & closing(1.0))
                .then(bounce(1.0)),
        )
        .transition(
            from(free)
                .on(lower_tooth)
                .to(free)
                .may((slope * px - py).at_least(0.0) & closing(-1.0))
                .then(bounce(-1.0)),
        )
        .transition(from(free).on(mesh).to(meshed).may(px.at_least(MESHED_AT)).then([
            impulse.becomes(impulse + SLEEVE_MASS * vx + SLEEVE_MASS * vy),
            vx.becomes(0.0),
            vy.becomes(0.0),
        ]))
        .build()?;
    settings.directions = pleach_verify::reach::Directions::Listed(vec![
        vec![sine, cosine, 0.0, 0.0, 0.0],
        vec![sine, -cosine, 0.0, 0.0, 0.0],
        vec![cosine, -sine, 0.0, 0.0, 0.0],
        vec![cosine, sine, 0.0, 0.0, 0.0],
        vec![0.0, 0.0, 1.0, -slope, 0.0],
        vec![0.0, 0.0, 1.0, slope, 0.0],
    ]);
    let around = |middle: f64, spread: f64| Interval::new(middle - spread, middle + spread);
    let nothing = Interval::point(0.0);
    Ok(Instance {
        automaton,
        starts: vec![StateSet::from_box(vec![
            nothing,
            nothing,
            around(-0.0167, spread.0)?,
            around(0.003, spread.1)?,
            nothing,
        ])],
        uncertain: Vec::new(),
        forbidden: vec![Forbidden::anywhere(impulse.at_least(20.0))],
        settings,
        measured: Vec::new(),
    })
}
