//! Arithmetic against exact fractions, and enclosures against closed forms.

use num_rational::BigRational;
use num_traits::Zero;
use pleach_automaton::{Automaton, Name, Record};
use pleach_guards::Interval;
use pleach_verify::reach::IntervalMatrix;
use pleach_verify::reach::{
    Bound, Completion, Polytope, Settings, Template, Zonotope, dot, dot_numbers, exponential,
    sum_up,
};
use proptest::prelude::*;

use super::support::{Named, boxed, enclosed, over};

fn fraction(value: f64) -> BigRational {
    BigRational::from_float(value).unwrap()
}

fn holds(found: Interval, exact: &BigRational) -> bool {
    fraction(found.lower()) <= *exact && *exact <= fraction(found.upper())
}

/// Numbers of very different sizes, so that sums lose digits.
fn number() -> impl Strategy<Value = f64> {
    (any::<i32>(), -60i32..60)
        .prop_map(|(digits, exponent)| f64::from(digits) * 2f64.powi(exponent) / 3.0)
}

fn pairs() -> impl Strategy<Value = Vec<(f64, f64)>> {
    proptest::collection::vec((number(), number()), 1..8)
}

proptest! {
    /// Sums of products enclose the exact one, which without rounding outward they would miss: the
    /// exact sum is hardly ever a number.
    #[test]
    fn sums_of_products_hold_the_exact_one(pairs in pairs()) {
        let exact = pairs.iter().fold(BigRational::zero(), |sum, (a, b)| sum + fraction(*a) * fraction(*b));
        let left: Vec<Interval> = pairs.iter().map(|(a, _)| Interval::point(*a)).collect();
        let right: Vec<Interval> = pairs.iter().map(|(_, b)| Interval::point(*b)).collect();
        let numbers: Vec<f64> = pairs.iter().map(|(_, b)| *b).collect();
        prop_assert!(holds(dot(&left, &right), &exact));
        prop_assert!(holds(dot_numbers(&left, &numbers), &exact));
    }

    #[test]
    fn sums_are_not_below_the_exact_one(terms in proptest::collection::vec(number(), 1..20)) {
        let exact = terms.iter().fold(BigRational::zero(), |sum, term| sum + fraction(term.abs()));
        prop_assert!(fraction(sum_up(terms.iter().map(|term| term.abs()))) >= exact);
    }

    /// The image of each corner is in the direction's bound, exactly.
    #[test]
    fn zonotopes_reach_as_far_as_their_points(
        center in proptest::collection::vec(number(), 3),
        generators in proptest::collection::vec(proptest::collection::vec(number(), 3), 1..5),
        direction in proptest::collection::vec(number(), 3),
    ) {
        let points = |entries: &[f64]| entries.iter().map(|e| Interval::point(*e)).collect::<Vec<_>>();
        let intervals: Vec<Vec<Interval>> = generators.iter().map(|g| points(g)).collect();
        let zonotope = Zonotope::from_intervals(&points(&center), &intervals);
        let along = |entries: &[f64]| entries.iter().zip(&direction)
            .fold(BigRational::zero(), |sum, (a, b)| sum + fraction(*a) * fraction(*b));
        let spread = generators.iter().map(|g| along(g)).map(|s| if s < BigRational::zero() { -s } else { s });
        let exact = spread.fold(along(&center), |sum, term| sum + term);
        prop_assert!(fraction(zonotope.support(&points(&direction))) >= exact);
        let smaller = zonotope.clone().reduced(1).support(&points(&direction));
        prop_assert!(fraction(smaller) >= exact);
    }

    /// A linear program never promises less than a point of the polytope has.
    #[test]
    fn polytopes_reach_as_far_as_their_points(
        normals in proptest::collection::vec(proptest::collection::vec(-1.0..1.0, 3), 1..8),
        point in proptest::collection::vec(-1.0..1.0, 3),
        rooms in proptest::collection::vec(0.0..0.5, 20),
        direction in proptest::collection::vec(-1.0..1.0, 3),
    ) {
        let mut template = Template::boxes(3);
        normals.iter().for_each(|normal| template.add_both(normal));
        let inner = |d: &[f64]| d.iter().zip(&point).fold(BigRational::zero(), |s, (a, b)| s + fraction(*a) * fraction(*b));
        // The point is in it: bounds are rounded up.
        let bounds = template.directions().iter().zip(rooms.iter().cycle()).map(|(d, room)| {
            let points: Vec<Interval> = d.iter().map(|e| Interval::point(*e)).collect();
            dot_numbers(&points, &point).upper() + room
        });
        let bounds: Vec<f64> = bounds.collect();
        let polytope = Polytope::new(template.into(), bounds);
        let points: Vec<Interval> = direction.iter().map(|e| Interval::point(*e)).collect();
        match polytope.support(&points) {
            Bound::AtMost(bound) => prop_assert!(fraction(bound) >= inner(&direction)),
            Bound::Empty => prop_assert!(false, "it has a point"),
        }
        let tightened = polytope.tightened().expect("it has a point");
        for (d, bound) in tightened.template().directions().iter().zip(tightened.bounds()) {
            prop_assert!(fraction(*bound) >= inner(d));
        }
    }

    /// e^A is diag(e^{a}, …) in coordinates that are sheared: the entries are known.
    #[test]
    fn exponentials_of_triangles(a in -3.0..3.0f64, b in -3.0..3.0f64) {
        let mut matrix = IntervalMatrix::zero(2, 2);
        matrix[(0, 0)] = Interval::point(a);
        matrix[(1, 1)] = Interval::point(a);
        matrix[(0, 1)] = Interval::point(b);
        let power = exponential(&matrix);
        prop_assert!(power[(0, 0)].contains(a.exp()) && power[(0, 1)].contains(b * a.exp()));
        prop_assert!(power[(0, 0)].width() <= 1e-12 * a.exp());
    }
}

/// What linear programs are for: a corner that the box does not show.
#[test]
fn linear_programs_find_corners() {
    let mut template = Template::boxes(2);
    let place = template.add(vec![1.0, 1.0]).unwrap();
    let mut triangle = Polytope::around(template, &[over(0.0, 1.0), over(0.0, 1.0)]);
    triangle.cut(place, 1.0);
    let along = |x: f64, y: f64| triangle.support(&[Interval::point(x), Interval::point(y)]);
    let Bound::AtMost(bound) = along(2.0, 1.0) else { panic!("it has points") };
    assert!((2.0..2.0 + 1e-12).contains(&bound), "{bound}");
    let mut nothing = triangle.clone();
    nothing.cut(place, -0.5);
    assert_eq!(nothing.tightened(), None);
}

fn single(rates: &[(&str, &str)]) -> Named {
    let state = Record::new(rates.iter().map(|(name, _)| (*name, 0.0))).unwrap();
    let only = Name::new("flow");
    let listed = state.coordinates();
    let listed = listed.iter().zip(rates);
    let listed: Vec<_> = listed
        .map(|(x, (_, rate))| x.rate(rate.parse::<pleach_guards::Expression>().unwrap()))
        .collect();
    Automaton::starting_in(only).initially(state).flow(only, listed).build().unwrap()
}

/// The widths of the last segment are those of the exact sets, up to the length of a step.
#[test]
fn enclosures_of_known_flows_are_tight() {
    let settings = Settings { horizon: 10.0, step: 0.01, ..Settings::default() };
    // A rotation: the box turns, and with octagons nothing wraps.
    let turning = single(&[("x", "-y"), ("y", "x")]);
    let (_, enclosure) = enclosed(&turning, &[], &boxed(&[(0.9, 1.1), (-0.1, 0.1)]), &settings);
    let last = enclosure.visits[0].segments.last().unwrap();
    let sides = last.set.hull().unwrap();
    let widest = 0.2 * 2f64.sqrt() + 0.02;
    assert!(sides.iter().all(|side| side.width() < widest), "{sides:?}");
    assert!(sides[0].contains(10f64.cos()) && sides[1].contains(10f64.sin()));

    // ẋ = −x² has x(t) = x₀ ÷ (1 + x₀ t).
    let braking = single(&[("x", "-(x^2)")]);
    let settings = Settings { step: 0.5, tolerance: 1e-10, ..settings };
    let (_, enclosure) = enclosed(&braking, &[], &boxed(&[(1.0, 2.0)]), &settings);
    let last = enclosure.visits[0].segments.last().unwrap();
    let side = last.set.hull().unwrap()[0];
    assert!(side.contains(1.0 / 11.0) && side.contains(2.0 / 21.0), "{side}");
    assert_eq!(enclosure.ending, Completion::Horizon);
}
