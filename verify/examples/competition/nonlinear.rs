//! Flows that are not affine: van der Pol's oscillator, alone (VDP) and coupled (CVDP), enzyme
//! activities in a cell (LALO20), a stiff reaction (ROBE), a quadrotor (QUAD).
//!
//! Models and numbers as in the ARCH-COMP reports (NLN): L. Geretti et al., *ARCH-COMP category
//! report: continuous and hybrid systems with nonlinear dynamics*, 2020 to 2025.

use pleach_automaton::{Automaton, Coordinate, Name, Rate, Record};
use pleach_guards::{Interval, constant, variable};
use pleach_verify::reach::{Forbidden, Settings, StateSet};

use crate::{Instance, Measure, TestResult};

/// One location with the rates that `rates` makes of the coordinates, from a box.
fn single(
    sides: &[(&str, f64, f64)],
    rates: impl Fn(&[Coordinate<Record>]) -> Vec<Rate<Record>>,
    forbidden: Vec<Forbidden>,
    settings: Settings,
) -> TestResult<Instance> {
    let middle = sides.iter().map(|(name, lower, upper)| (*name, lower.midpoint(*upper)));
    let state = Record::new(middle)?;
    let coordinates = state.coordinates();
    let only = Name::new("flow");
    let automaton = Automaton::<Name, Name, Record>::starting_in(only)
        .initially(state)
        .flow(only, rates(&coordinates))
        .build()?;
    let sides = sides.iter().map(|(_, lower, upper)| Interval::new(*lower, *upper));
    Ok(Instance {
        automaton,
        starts: vec![StateSet::from_box(sides.collect::<Result<_, _>>()?)],
        uncertain: Vec::new(),
        forbidden,
        settings,
        measured: Vec::new(),
    })
}

/// One van der Pol oscillator, as up to 2020: y stays below 2.75.
pub fn oscillator(settings: Settings) -> TestResult<Instance> {
    let rates = |c: &[Coordinate<Record>]| {
        let [x, y] = c else { return Vec::new() };
        vec![x.rate(y), y.rate((1.0 - x.power(2.0)) * y - x)]
    };
    let fast = Forbidden::anywhere(variable("y").at_least(2.75));
    single(&[("x", 1.25, 1.55), ("y", 2.35, 2.45)], rates, vec![fast], settings)
}

/// Two van der Pol oscillators, coupled by a spring of uncertain stiffness (CVDP22: μ = 1,
/// b ∈ [60, 80], y₁ and y₂ stay below 3.7; CVDP23: b ∈ [1, 3], below 2.75).
pub fn van_der_pol(
    positions: [(f64, f64); 2],
    stiffness: (f64, f64),
    limit: f64,
    settings: Settings,
) -> TestResult<Instance> {
    let [first, second] = positions;
    let sides = [
        ("x1", first.0, first.1),
        ("y1", 2.35, 2.45),
        ("x2", second.0, second.1),
        ("y2", 2.35, 2.45),
        ("b", stiffness.0, stiffness.1),
    ];
    let rates = |c: &[Coordinate<Record>]| {
        let [x1, y1, x2, y2, b] = c else { return Vec::new() };
        vec![
            x1.rate(y1),
            y1.rate((1.0 - x1.power(2.0)) * y1 + b * (x2 - x1) - x1),
            x2.rate(y2),
            y2.rate((1.0 - x2.power(2.0)) * y2 - b * (x2 - x1) - x2),
            b.rate(0.0),
        ]
    };
    let fast = ["y1", "y2"].map(|name| Forbidden::anywhere(variable(name).at_least(limit)));
    single(&sides, rates, fast.to_vec(), settings)
}

/// Seven substances of a cell, each up to `width` from where they are known to be; x₄ stays below
/// `limit`.
pub fn laub_loomis(width: f64, limit: f64, settings: Settings) -> TestResult<Instance> {
    let centers = [1.2, 1.05, 1.5, 2.4, 1.0, 0.1, 0.45];
    let names = ["x1", "x2", "x3", "x4", "x5", "x6", "x7"];
    let sides: Vec<_> = names
        .into_iter()
        .zip(centers)
        .map(|(name, center)| (name, center - width, center + width))
        .collect();
    let rates = |c: &[Coordinate<Record>]| {
        let [x1, x2, x3, x4, x5, x6, x7] = c else { return Vec::new() };
        vec![
            x1.rate(1.4 * x3 - 0.9 * x1),
            x2.rate(2.5 * x5 - 1.5 * x2),
            x3.rate(0.6 * x7 - 0.8 * (x2 * x3)),
            x4.rate(2.0 - 1.3 * (x3 * x4)),
            x5.rate(0.7 * x1 - x4 * x5),
            x6.rate(0.3 * x1 - 3.1 * x6),
            x7.rate(1.8 * x6 - 1.6 * (x2 * x7)),
        ]
    };
    let high = Forbidden::anywhere(variable("x4").at_least(limit));
    let mut instance = single(&sides, rates, vec![high], settings)?;
    instance.measured = vec![Measure::Width("x4")];
    Ok(instance)
}

/// Three substances that react at very different speeds; their sum is 1 at all times.
pub fn robertson(beta: f64, gamma: f64, settings: Settings) -> TestResult<Instance> {
    let sides = [("x", 1.0, 1.0), ("y", 0.0, 0.0), ("z", 0.0, 0.0)];
    let rates = |c: &[Coordinate<Record>]| {
        let [x, y, z] = c else { return Vec::new() };
        vec![
            x.rate(beta * (y * z) - 0.4 * x),
            y.rate(0.4 * x - beta * (y * z) - gamma * y.power(2.0)),
            z.rate(gamma * y.power(2.0)),
        ]
    };
    let mut instance = single(&sides, rates, Vec::new(), settings)?;
    instance.measured = vec![Measure::Sum];
    Ok(instance)
}

/// A quadrotor that climbs to a height of 1 m, from any state with position and velocity within
/// `width`: it stays below 1.4 m, is above 0.9 m after 1 s, and between 0.98 m and 1.02 m at 5 s.
pub fn quadrotor(width: f64, settings: Settings) -> TestResult<Instance> {
    let names = ["x1", "x2", "x3", "x4", "x5", "x6", "x7", "x8", "x9", "x10", "x11", "x12", "t"];
    let spread = |number: usize| if number < 6 { width } else { 0.0 };
    let sides: Vec<_> = names
        .into_iter()
        .enumerate()
        .map(|(number, name)| (name, -spread(number), spread(number)))
        .collect();
    let (gravity, radius, length, rotor, center) = (9.81, 0.1, 0.5, 0.1, 1.0);
    let mass = center + 4.0 * rotor;
    let jx = 2.0 * center * radius * radius / 5.0 + 2.0 * length * length * rotor;
    let jz = 2.0 * center * radius * radius / 5.0 + 4.0 * length * length * rotor;
    let rates = move |c: &[Coordinate<Record>]| {
        let [x1, x2, x3, x4, x5, x6, x7, x8, x9, x10, x11, x12, t] = c else { return Vec::new() };
        let thrust = mass * gravity - 10.0 * (x3 - 1.0) + 3.0 * x6;
        let [s7, c7, s8, c8, s9, c9] = [x7.sin(), x7.cos(), x8.sin(), x8.cos(), x9.sin(), x9.cos()];
        vec![
            x1.rate(
                &c8 * &c9 * x4
                    + (&s7 * &s8 * &c9 - &c7 * &s9) * x5
                    + (&c7 * &s8 * &c9 + &s7 * &s9) * x6,
            ),
            x2.rate(
                &c8 * &s9 * x4
                    + (&s7 * &s8 * &s9 + &c7 * &c9) * x5
                    + (&c7 * &s8 * &s9 - &s7 * &c9) * x6,
            ),
            x3.rate(&s8 * x4 - &s7 * &c8 * x5 - &c7 * &c8 * x6),
            x4.rate(x12 * x5 - x11 * x6 - gravity * &s8),
            x5.rate(x10 * x6 - x12 * x4 + gravity * &c8 * &s7),
            x6.rate(x11 * x4 - x10 * x5 + gravity * &c8 * &c7 - thrust / mass),
            x7.rate(x10 + &s7 * (&s8 / &c8) * x11 + &c7 * (&s8 / &c8) * x12),
            x8.rate(&c7 * x11 - &s7 * x12),
            x9.rate(&s7 / &c8 * x11 + &c7 / &c8 * x12),
            x10.rate(((jx - jz) / jx) * (x11 * x12) + (-x7 - x10) / constant(jx)),
            x11.rate(((jz - jx) / jx) * (x10 * x12) + (-x8 - x11) / constant(jx)),
            x12.rate(0.0),
            t.rate(1.0),
        ]
    };
    let [height, time] = ["x3", "t"].map(variable);
    let forbidden = [
        height.at_least(1.4),
        time.at_least(1.0) & height.at_most(0.9),
        time.at_least(5.0) & (height.at_most(0.98) | height.at_least(1.02)),
    ];
    single(&sides, rates, forbidden.map(Forbidden::anywhere).to_vec(), settings)
}
