//! Models are rounded outward before anything flows, and where they jump.

use num_rational::BigRational;
use pleach_automaton::{Automaton, Name, Record, from};
use pleach_guards::{Expression, Interval};
use pleach_verify::reach::{Dynamics, Settings};

use super::support::{Named, boxed, enclosed, over};

fn fraction(value: f64) -> BigRational {
    BigRational::from_float(value).unwrap()
}

fn holds(found: Interval, exact: &BigRational) -> bool {
    fraction(found.lower()) <= *exact && *exact <= fraction(found.upper())
}

/// From where to where inputs reach in a flow, exactly.
fn inputs(rate: &str, inputs: &[(&str, Interval)]) -> [BigRational; 2] {
    let rate: Expression = rate.parse().unwrap();
    let flow = Dynamics::of("flow", vec![rate], &["x".to_owned()], inputs).unwrap();
    let Dynamics::Affine(flow) = flow else { panic!("it is affine") };
    let inputs = flow.inputs();
    let spread = inputs.generators().iter().map(|generator| fraction(generator[0].abs()));
    let half = spread.fold(fraction(inputs.slack()[0]), |sum, term| sum + term);
    let center = fraction(inputs.center()[0]);
    [center.clone() - &half, center + half]
}

#[test]
fn inputs_times_their_gains_are_covered() {
    let [least, most] = inputs("0.7 * u + 0.1", &[("u", over(-0.9, 0.3))]);
    let exact = |end: f64| fraction(0.7) * fraction(end) + fraction(0.1);
    assert!(least <= exact(-0.9) && exact(0.3) <= most);
    // Half the width of this interval is no number, and its middle neither.
    let faint = f64::EPSILON / 256.0;
    // Beyond 2⁵³ numbers are two apart.
    let large = 2f64.powi(53);
    for (lower, upper) in [(-faint, 1.0), (-1.0, faint), (large, large + 2.0)] {
        let [least, most] = inputs("u", &[("u", over(lower, upper))]);
        assert!(least <= fraction(lower) && fraction(upper) <= most, "from {lower} to {upper}");
    }
}

/// Coefficients that come of several numbers are as exact as intervals are.
#[test]
fn gains_are_covered() {
    let rate: Expression = "0.1 * (3 * x) + x / 3".parse().unwrap();
    let flow = Dynamics::of("flow", vec![rate], &["x".to_owned()], &[]).unwrap();
    let Dynamics::Affine(flow) = flow else { panic!("it is affine") };
    let exact = fraction(0.1) * fraction(3.0) + fraction(3.0).recip();
    assert!(holds(flow.matrix()[(0, 0)], &exact));
}

/// One location that is left at once, with this reset.
fn jumping(reset: &str, start: f64) -> Interval {
    let state = Record::new([("x", start)]).unwrap();
    let coordinates = state.coordinates();
    let x = &coordinates[0];
    let [before, after] = ["before", "after"].map(Name::new);
    let automaton: Named = Automaton::starting_in(before)
        .initially(state.clone())
        .transition(
            from(before)
                .on(Name::new("jump"))
                .to(after)
                .must(x.at_least(start))
                .then(x.becomes(reset.parse::<Expression>().unwrap())),
        )
        .build()
        .unwrap();
    let settings = Settings { horizon: 0.1, step: 0.1, ..Settings::default() };
    let (_, enclosure) = enclosed(&automaton, &[], &boxed(&[(start, start)]), &settings);
    enclosure.visits[1].start.hull()[0]
}

#[test]
fn resets_hold_the_exact_values() {
    let faint = f64::EPSILON / 256.0;
    let found = jumping(&format!("x + {faint}"), 1.0);
    assert!(holds(found, &(fraction(1.0) + fraction(faint))), "{found}");
    let found = jumping(&format!("x - {faint}"), 1.0);
    assert!(holds(found, &(fraction(1.0) - fraction(faint))), "{found}");
    let found = jumping("0.1 * x + 0.7", 1.1);
    assert!(holds(found, &(fraction(0.1) * fraction(1.1) + fraction(0.7))), "{found}");
    // Not affine.
    let found = jumping("x * x + 0.7", 1.1);
    assert!(holds(found, &(fraction(1.1) * fraction(1.1) + fraction(0.7))), "{found}");
}
