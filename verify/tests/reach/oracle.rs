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

/// A system that others have solved, and a set of initial states that holds theirs.
struct Solved {
    name: &'static str,
    /// Of x1, x2 and so on.
    rates: &'static [&'static str],
    start: &'static [(f64, f64)],
    settings: Settings,
}

impl Solved {
    fn automaton(&self) -> Named {
        let names = (1..=self.rates.len()).map(|number| (format!("x{number}"), 0.0));
        let state = Record::new(names).unwrap();
        let only = Name::new("flow");
        let coordinates = state.coordinates();
        let rates = coordinates.iter().zip(self.rates);
        let rates: Vec<_> =
            rates.map(|(x, rate)| x.rate(rate.parse::<Expression>().unwrap())).collect();
        Automaton::starting_in(only).initially(state).flow(only, rates).build().unwrap()
    }
}

fn solved() -> Vec<Solved> {
    let curved = || Settings { horizon: 2.0, step: 0.25, tolerance: 1e-9, ..Settings::default() };
    vec![
        Solved {
            name: "van-der-pol",
            rates: &["x2", "(1 - x1 * x1) * x2 - x1"],
            start: &[(1.25, 1.55), (2.35, 2.45)],
            settings: curved(),
        },
        Solved {
            name: "lotka-volterra",
            rates: &["3 * x1 - 3 * (x1 * x2)", "x1 * x2 - x2"],
            start: &[(1.288, 1.312), (1.0, 1.0)],
            settings: curved(),
        },
        Solved {
            name: "coupled-van-der-pol",
            rates: &[
                "x2",
                "(1 - x1 * x1) * x2 + x5 * (x3 - x1) - x1",
                "x4",
                "(1 - x3 * x3) * x4 - x5 * (x3 - x1) - x3",
                "0",
            ],
            start: &[(1.475, 1.55), (2.35, 2.45), (1.25, 1.325), (2.35, 2.45), (1.0, 1.5)],
            settings: curved(),
        },
        Solved {
            name: "laub-loomis",
            rates: &[
                "1.4 * x3 - 0.9 * x1",
                "2.5 * x5 - 1.5 * x2",
                "0.6 * x7 - 0.8 * (x2 * x3)",
                "2 - 1.3 * (x3 * x4)",
                "0.7 * x1 - x4 * x5",
                "0.3 * x1 - 3.1 * x6",
                "1.8 * x6 - 1.6 * (x2 * x7)",
            ],
            start: &[
                (1.1899, 1.2101),
                (1.0399, 1.0601),
                (1.4899, 1.5101),
                (2.3899, 2.4101),
                (0.9899, 1.0101),
                (0.0899, 0.1101),
                (0.4399, 0.4601),
            ],
            settings: Settings { tolerance: 1e-7, ..curved() },
        },
        Solved {
            name: "spacecraft",
            rates: &[
                "x3",
                "x4",
                "-0.057599765881773 * x1 + 0.000200959896519766 * x2 - 2.89995083970656 * x3 \
                 + 0.00877200894463775 * x4",
                "-0.000174031357370456 * x1 - 0.0665123984901026 * x2 - 0.00875351105536225 * x3 \
                 - 2.90300269286856 * x4",
            ],
            start: &[(-925.0, -875.0), (-425.0, -375.0), (0.0, 0.0), (0.0, 0.0)],
            settings: Settings { horizon: 100.0, step: 0.04, ..Settings::default() },
        },
    ]
}

/// A state that another program has found: when, from where, and between which numbers.
struct Found {
    t: f64,
    start: Vec<f64>,
    state: Vec<Interval>,
}

impl Solved {
    fn found(&self) -> Vec<Found> {
        let own = lines("flow").into_iter().filter(|fields| fields[0] == self.name);
        let found = own.map(|fields| {
            let numbers: Vec<f64> = fields[1..].iter().map(|text| number(text)).collect();
            let (start, ends) = numbers[1..].split_at(self.rates.len());
            let state = ends.chunks(2).map(|ends| over(ends[0], ends[1])).collect();
            Found { t: numbers[0], start: start.to_vec(), state }
        });
        found.collect()
    }

    fn enclosed(&self, start: &[(f64, f64)]) -> Enclosure {
        enclosed(&self.automaton(), &[], &boxed(start), &self.settings).1
    }
}

#[test]
fn flows_hold_the_solutions_of_other_programs() {
    let mut seen = 0;
    for system in solved() {
        let whole = system.enclosed(system.start);
        for one in system.found().chunk_by(|one, next| one.start == next.start) {
            let start = &one[0].start;
            let point: Vec<(f64, f64)> = start.iter().map(|value| (*value, *value)).collect();
            let single = system.enclosed(&point);
            for Found { t, state, .. } in one {
                for (enclosure, what) in [(&whole, "the set"), (&single, "the point")] {
                    let name = system.name;
                    assert!(meets(enclosure, *t, state), "{name} at {t} s from {start:?}: {what}");
                }
                seen += 1;
            }
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
