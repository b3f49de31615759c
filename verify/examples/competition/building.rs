//! A building that shakes (BLDF01, where the force may change at every instant, and BLDC01, where it is
//! constant): how fast its first coordinate moves (BDS01).
//!
//! The matrix and its source: `building.csv`. Sets as in the ARCH-COMP reports (AFF).

use pleach_automaton::{Automaton, Name, Record};
use pleach_guards::{Expression, Interval, variable};
use pleach_verify::reach::{Forbidden, Settings, StateSet, Uncertain};

use crate::{Instance, TestResult};

const DATA: &str = include_str!("building.csv");
/// What the force adds to the first acceleration.
const GAIN: f64 = 0.013696753869332967;
/// Velocities are in this unit, so that the entries of the matrix are of one size: a power of two, by
/// which no number is rounded.
const UNIT: f64 = 64.0;
/// What the first velocity may come to.
const LIMIT: f64 = 0.0051;

/// The building under a force from 0.8 to 1, which varies or is one constant.
pub fn shaken(varies: bool, settings: Settings) -> TestResult<Instance> {
    let accelerations = rows()?;
    let count = accelerations.len();
    let names = |letter: &str| -> Vec<String> {
        (1..=count).map(|number| format!("{letter}{number}")).collect()
    };
    let names = [names("x"), names("v")].concat();
    let state = Record::new(names.iter().map(|name| (name, 0.0)))?;
    let coordinates = state.coordinates();
    let (places, velocities) = coordinates.split_at(count);
    let moving = places.iter().zip(velocities).map(|(x, v)| x.rate(UNIT * v));
    let accelerated =
        velocities.iter().zip(&accelerations).enumerate().map(|(number, (v, row))| {
            let units = [1.0 / UNIT, 1.0];
            let terms = row.iter().zip(&coordinates).enumerate();
            let terms =
                terms.map(|(at, (gain, coordinate))| (gain * units[at / count]) * coordinate);
            let force = if number == 0 { GAIN / UNIT } else { 0.0 };
            v.rate(terms.sum::<Expression>() + force * variable("u"))
        });
    let rates: Vec<_> = moving.chain(accelerated).collect();
    let only = Name::new("shaking");
    let automaton = Automaton::<Name, Name, Record>::starting_in(only)
        .initially(state.clone())
        .parameter("u", 0.9)
        .flow(only, rates)
        .build()?;
    let force = Interval::new(0.8, 1.0)?;
    let mut sides = vec![Interval::point(0.0); 2 * count];
    sides[..10].fill(Interval::new(0.0002, 0.00025)?);
    sides[count] = Interval::new(-0.0001 / UNIT, 0.0001 / UNIT)?;
    if !varies {
        sides.push(force);
    }
    Ok(Instance {
        automaton,
        starts: vec![StateSet::from_box(sides)],
        uncertain: vec![Uncertain { parameter: "u".into(), values: force, varies }],
        forbidden: vec![Forbidden::anywhere((UNIT * variable("v1")).more_than(LIMIT))],
        settings,
        measured: Vec::new(),
    })
}

/// The rows of the data.
fn rows() -> TestResult<Vec<Vec<f64>>> {
    let lines = DATA.lines().filter(|line| !line.starts_with('#'));
    let row = |line: &str| line.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>();
    Ok(lines.map(row).collect::<Result<_, _>>()?)
}
