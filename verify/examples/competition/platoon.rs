//! A platoon of three vehicles that follow a leader and lose their communication (PLAD01).
//!
//! Model and numbers: I. Ben Makhlouf and S. Kowalewski, *Networked cooperative platoon of vehicles for
//! testing methods and verification tools*, ARCH 2014, in the form of the ARCH-COMP reports (AFF).

use nalgebra::DMatrix;
use pleach_automaton::{Automaton, Coordinate, Flow, Name, Record, from};
use pleach_guards::{Interval, variable};
use pleach_verify::reach::{Forbidden, Settings, StateSet, Uncertain};

use crate::{Instance, TestResult};

const CONNECTED: [[f64; 9]; 9] = [
    [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [1.6050, 4.8680, -3.5754, -0.8198, 0.4270, -0.0450, -0.1942, 0.3626, -0.0946],
    [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0],
    [0.8718, 3.8140, -0.0754, 1.1936, 3.6258, -3.2396, -0.5950, 0.1294, -0.0796],
    [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0],
    [0.7132, 3.5730, -0.0964, 0.8472, 3.2568, -0.0876, 1.2726, 3.0720, -3.1356],
];

const DISCONNECTED: [[f64; 9]; 9] = [
    CONNECTED[0],
    CONNECTED[1],
    [1.6050, 4.8680, -3.5754, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    CONNECTED[3],
    CONNECTED[4],
    [0.0, 0.0, 0.0, 1.1936, 3.6258, -3.2396, 0.0, 0.0, 0.0],
    CONNECTED[6],
    CONNECTED[7],
    CONNECTED[8],
];

/// How long each phase of communication and of its loss lasts, in seconds.
const PHASE: f64 = 5.0;

/// PLAD01: the vehicles come no closer than `distance` metres to their places.
pub fn deterministic(distance: f64, settings: Settings) -> TestResult<Instance> {
    let names = (1..=9).map(|number| format!("x{number}")).chain(["t".to_owned()]);
    let state = Record::new(names.map(|name| (name, 0.0)))?;
    let coordinates = state.coordinates();
    let t = &coordinates[9];
    let [linked, lost] = ["linked", "lost"].map(Name::new);
    let [lose, regain] = ["lose", "regain"].map(Name::new);
    let automaton = Automaton::<Name, Name, Record>::starting_in(linked)
        .initially(state.clone())
        .parameter("u", 0.0)
        .flow(linked, flow(&coordinates, &CONNECTED)?)
        .flow(lost, flow(&coordinates, &DISCONNECTED)?)
        .transition(from(linked).on(lose).to(lost).must(t.at_least(PHASE)).then(t.becomes(0.0)))
        .transition(from(lost).on(regain).to(linked).must(t.at_least(PHASE)).then(t.becomes(0.0)))
        .build()?;
    let close = ["x1", "x4", "x7"].map(|name| variable(name).at_most(-distance));
    Ok(Instance {
        automaton,
        starts: vec![StateSet::from_box(vec![Interval::point(0.0); 10])],
        uncertain: vec![Uncertain {
            parameter: "u".to_owned(),
            values: Interval::new(-9.0, 1.0)?,
            varies: true,
        }],
        forbidden: close.map(Forbidden::anywhere).to_vec(),
        settings,
        measured: Vec::new(),
    })
}

/// ẋ = A x + (0, u, 0, …), ṫ = 1.
fn flow(coordinates: &[Coordinate<Record>], matrix: &[[f64; 9]; 9]) -> TestResult<Flow<Record>> {
    let matrix = DMatrix::from_fn(9, 9, |row, column| matrix[row][column]);
    let linear = Flow::linear(&coordinates[..9], &matrix, &[0.0; 9])?;
    let rates = linear.rates().unwrap_or_default().iter().zip(coordinates).enumerate();
    let mut rates: Vec<_> = rates
        .map(|(row, (rate, coordinate))| match row {
            1 => coordinate.rate(rate.rate() + variable("u")),
            _ => coordinate.rate(rate.rate().clone()),
        })
        .collect();
    rates.push(coordinates[9].rate(1.0));
    Ok(rates.into())
}
