//! Enclosures against those of independent validated programs, which `oracle/record.py` has recorded.
//!
//! Both enclose the same number, so they have to meet; and one that is thin has to be inside what
//! encloses all runs from a set around its start, up to its own width.

use pleach_automaton::{Automaton, Name, Record};
use pleach_guards::{Expression, Interval};
use pleach_verify::reach::{Enclosure, IntervalMatrix, Settings, exponential};

use super::support::{Named, boxed, enclosed, over};

const RECORDED: &str = include_str!("oracle/recorded.txt");

/// The lines of one kind, their fields.
fn lines(kind: &str) -> Vec<Vec<&'static str>> {
    let fields = RECORDED.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let mut lines: Vec<Vec<&str>> = fields.filter(|fields| fields.first() == Some(&kind)).collect();
    for fields in &mut lines {
        fields.remove(0);
    }
    assert!(!lines.is_empty(), "nothing is recorded of {kind}");
    lines
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

#[test]
fn matrix_exponentials_meet_those_of_ball_arithmetic() {
    for fields in lines("exponential") {
        let dimension: usize = fields[0].parse().unwrap();
        let (entries, ends) = fields[1..].split_at(dimension * dimension);
        let mut matrix = IntervalMatrix::zero(dimension, dimension);
        for (place, entry) in entries.iter().enumerate() {
            matrix[(place / dimension, place % dimension)] = Interval::point(number(entry));
        }
        let power = exponential(&matrix);
        let largest = power.norm();
        for (found, ends) in power.entries().iter().zip(ends.chunks(2)) {
            let exact = over(number(ends[0]), number(ends[1]));
            assert!(found.intersection(exact).is_some(), "{found} misses {exact}");
            // The true value is known to the last digit: ours holds it and is hardly wider.
            assert!(found.lower() <= exact.upper() && exact.lower() <= found.upper());
            assert!(found.width() <= 1e-12 * largest, "{found} {exact}");
        }
    }
}

fn plane(rates: [&str; 2]) -> Named {
    let state = Record::new([("x", 0.0), ("y", 0.0)]).unwrap();
    let only = Name::new("flow");
    let listed = state.coordinates();
    let listed = listed.iter().zip(rates);
    let listed: Vec<_> =
        listed.map(|(x, rate)| x.rate(rate.parse::<Expression>().unwrap())).collect();
    Automaton::starting_in(only).initially(state).flow(only, listed).build().unwrap()
}

#[test]
fn flows_hold_the_solutions_of_another_integrator() {
    let settings = Settings { horizon: 2.0, step: 0.25, tolerance: 1e-9, ..Settings::default() };
    let systems = [
        ("van-der-pol", ["y", "(1 - x * x) * y - x"], [(1.25, 1.55), (2.35, 2.45)]),
        ("lotka-volterra", ["3 * x - 3 * (x * y)", "x * y - y"], [(1.288, 1.312), (1.0, 1.0)]),
    ];
    let mut seen = 0;
    for (name, rates, start) in systems {
        let (_, whole) = enclosed(&plane(rates), &[], &boxed(&start), &settings);
        for fields in lines("flow").into_iter().filter(|fields| fields[0] == name) {
            let numbers: Vec<f64> = fields[1..].iter().map(|text| number(text)).collect();
            let [t, x, y, ..] = numbers[..] else { panic!("{fields:?}") };
            let other = [over(numbers[3], numbers[4]), over(numbers[5], numbers[6])];
            let (_, single) = enclosed(&plane(rates), &[], &boxed(&[(x, x), (y, y)]), &settings);
            for (enclosure, what) in [(&whole, "the set"), (&single, "the point")] {
                assert!(meets(enclosure, t, &other), "{name} at {t} s from ({x}, {y}): {what}");
            }
            seen += 1;
        }
    }
    assert_eq!(seen, lines("flow").len());
}

/// Whether an enclosure has states at a time in a box.
fn meets(enclosure: &Enclosure, t: f64, sides: &[Interval]) -> bool {
    let segments = enclosure.visits.iter().flat_map(|visit| &visit.segments);
    segments.filter(|segment| segment.time.contains(t)).any(|segment| {
        let hull = segment.set.hull().unwrap();
        hull.iter().zip(sides).all(|(one, other)| one.intersection(*other).is_some())
    })
}
