//! No simulated run leaves the enclosure of all runs: random systems.

use pleach_automaton::composition::Policy;
use pleach_automaton::{Automaton, Name, Record, from};
use pleach_guards::{Expression, constant};
use pleach_verify::reach::{Completion, Directions, Settings, Uncertain};
use proptest::prelude::*;

use super::support::{Named, boxed, enclosed, escape, over, run};

/// How far the simulator may be from the exact solution: flows solved in closed form are off by
/// rounding, others by what their tolerances of 1e-9 add up to.
const CLOSED_FORM: f64 = 1e-11;
const INTEGRATED: f64 = 1e-6;

fn coordinates(dimension: usize) -> Record {
    Record::new((0..dimension).map(|number| (format!("x{number}"), 0.0))).unwrap()
}

/// ẋ = A x + b + (u, 0, …)
fn affine(matrix: &[Vec<f64>], offset: &[f64]) -> Named {
    let state = coordinates(offset.len());
    let variables = state.coordinates();
    let only = Name::new("flow");
    let rates = variables.iter().zip(matrix.iter().zip(offset)).enumerate().map(
        |(row, (x, (gains, offset)))| {
            let sum: Expression = gains.iter().zip(&variables).map(|(gain, x)| *gain * x).sum();
            let input = if row == 0 { pleach_guards::variable("u") } else { constant(0.0) };
            x.rate(sum + *offset + input)
        },
    );
    let rates: Vec<_> = rates.collect();
    Automaton::starting_in(only)
        .initially(state)
        .parameter("u", 0.0)
        .flow(only, rates)
        .build()
        .unwrap()
}

fn numbers(count: usize, size: f64) -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(-size..size, count)
}

type Rows = Vec<Vec<f64>>;

/// A matrix, an offset, the center of a set, and points in it.
fn squares(dimension: usize) -> impl Strategy<Value = (Rows, Vec<f64>, Vec<f64>, Rows)> {
    (
        proptest::collection::vec(numbers(dimension, 3.0), dimension),
        numbers(dimension, 1.0),
        numbers(dimension, 2.0),
        proptest::collection::vec(numbers(dimension, 1.0), 6),
    )
}

proptest! {
    #![proptest_config(cases::usually(200))]

    #[test]
    fn affine_flows_with_inputs(
        (matrix, offset, center, shares) in (1usize..5).prop_flat_map(squares),
        width in 0.0..0.5,
        input in (-1.0..0.0, 0.0..1.0),
        step in 0.02..0.2,
        octagons: bool,
    ) {
        let automaton = affine(&matrix, &offset);
        let values = over(input.0, input.1);
        let uncertain = [Uncertain { parameter: "u".into(), values, varies: true }];
        let start = boxed(&center.iter().map(|c| (c - width, c + width)).collect::<Vec<_>>());
        let directions = if octagons { Directions::Octagons } else { Directions::Boxes };
        let settings = Settings { horizon: 1.5, step, directions, ..Settings::default() };
        let (model, enclosure) = enclosed(&automaton, &uncertain, &start, &settings);
        prop_assert_eq!(enclosure.ending, Completion::Horizon);
        for (number, shares) in shares.iter().enumerate() {
            // Corners of the set of initial states and of inputs as well as points inside.
            let corner = |share: f64| if number % 2 == 0 { share.signum() } else { share };
            let state = center.iter().zip(shares).map(|(c, share)| c + width * corner(*share));
            let state: Vec<f64> = state.collect();
            let u = if shares[0] > 0.0 { input.1 } else { input.0 };
            let trajectory = run(&automaton, &[("u", u)], &state, Policy::Late, 1.5);
            prop_assert_eq!(escape(&model, &enclosure, &trajectory, CLOSED_FORM), None);
        }
    }

    #[test]
    fn flows_of_polynomials(
        gains in numbers(12, 1.0),
        center in numbers(2, 1.0),
        shares in proptest::collection::vec(numbers(2, 1.0), 4),
        width in 0.0..0.2,
        degree in 1usize..4,
    ) {
        let state = coordinates(2);
        let variables = state.coordinates();
        let [x, y] = &variables[..] else { unreachable!() };
        let rate = |g: &[f64]| {
            g[0] + g[1] * x + g[2] * y + g[3] * (x * y) + g[4] * x.sin() - g[5].abs() * x.power(3.0)
        };
        let (first, second) = (rate(&gains[..6]), rate(&gains[6..]) - y.power(3.0));
        let only = Name::new("flow");
        let automaton: Named = Automaton::starting_in(only)
            .initially(state)
            .flow(only, [x.rate(first), y.rate(second)])
            .build()
            .unwrap();
        let start = boxed(&center.iter().map(|c| (c - width, c + width)).collect::<Vec<_>>());
        let settings = Settings { horizon: 1.0, step: 0.2, tolerance: 1e-6, order: 6, degree, segment_limit: 100, generators: 3, ..Settings::default() };
        let (model, enclosure) = enclosed(&automaton, &[], &start, &settings);
        // A flow may grow beyond all bounds; up to there it is enclosed.
        let end = enclosure.visits[0].segments.last().map_or(0.0, |segment| segment.time.lower());
        for shares in &shares {
            let state = center.iter().zip(shares).map(|(c, share)| c + width * share.signum());
            let state: Vec<f64> = state.collect();
            let trajectory = run(&automaton, &[], &state, Policy::Late, end);
            prop_assert_eq!(escape(&model, &enclosure, &trajectory, INTEGRATED), None);
        }
    }

    #[test]
    fn jumps_at_boundaries_and_within_guards(
        matrices in proptest::collection::vec(proptest::collection::vec(numbers(2, 1.5), 2), 2),
        drifts in proptest::collection::vec(numbers(2, 2.0), 2),
        boundary in 0.2..1.0,
        reset in numbers(3, 0.8),
        shares in proptest::collection::vec(numbers(2, 1.0), 4),
        must: bool,
        seed: u64,
    ) {
        let state = coordinates(2);
        let variables = state.coordinates();
        let [x, y] = &variables[..] else { unreachable!() };
        let [one, other] = ["one", "other"].map(Name::new);
        let [there, back] = ["there", "back"].map(Name::new);
        let flow = |number: usize| {
            let rate = |row: usize| {
                let gains = &matrices[number][row];
                gains[0] * x + gains[1] * y + drifts[number][row]
            };
            [x.rate(rate(0)), y.rate(rate(1))]
        };
        let far = (x + 0.5 * y).at_least(boundary);
        let leave = from(one).on(there).to(other);
        let leave = if must { leave.must(far) } else { leave.may(far) };
        let automaton: Named = Automaton::starting_in(one)
            .initially(state.clone())
            .flow(one, flow(0))
            .flow(other, flow(1))
            .invariant(one, (x + 0.5 * y).at_most(boundary + 0.4))
            .transition(leave.then([
                x.becomes(reset[0] * x + reset[1]),
                y.becomes(y + reset[2] * x),
            ]))
            .transition(from(other).on(back).to(one).must(y.at_most(-1.0)).then(y.becomes(0.5)))
            .build()
            .unwrap();
        let start = boxed(&[(-0.3, 0.0), (-0.2, 0.2)]);
        let settings = Settings { horizon: 2.0, step: 0.05, jump_limit: 12, clusters: 2, ..Settings::default() };
        let (model, enclosure) = enclosed(&automaton, &[], &start, &settings);
        if enclosure.ending != Completion::Horizon && enclosure.ending != Completion::Everything {
            return Ok(());
        }
        for (number, shares) in shares.iter().enumerate() {
            let state = [-0.15 + 0.15 * shares[0], 0.2 * shares[1]];
            let policy = match number {
                0 => Policy::Late,
                1 => Policy::Early,
                _ => Policy::Random { seed: seed.wrapping_add(number as u64) },
            };
            let trajectory = run(&automaton, &[], &state, policy, 2.0);
            prop_assert_eq!(escape(&model, &enclosure, &trajectory, CLOSED_FORM), None);
        }
    }
}
