//! Intervals of single numbers hold the exact results, which are no numbers.
//!
//! Every exact result lies between two neighbouring numbers. The lower of them stands here, from ball
//! arithmetic with 300 bits (python-flint 0.9): what is rounded outward holds both neighbours, and
//! what is not holds one of them at most.

use pleach_guards::Interval;

fn power(exponent: f64) -> impl Fn(Interval) -> Interval {
    move |base| base.power(exponent).expect("there is such a power")
}

/// What encloses the function of `place` holds `below` and its upper neighbour, and little else.
fn check(what: &str, place: f64, found: Interval, below: f64) {
    let above = below.next_up();
    assert!(found.lower() <= below && above <= found.upper(), "{what} of {place}: {found}");
    assert!(found.width() <= 12.0 * (above - below), "{what} of {place} is wide: {found}");
}

fn check_all(what: &str, function: impl Fn(Interval) -> Interval, places: &[(f64, f64)]) {
    for (place, below) in places {
        check(what, *place, function(Interval::point(*place)), *below);
    }
    // The same at the ends of a span in which the function is monotone.
    let ordered = |pair: &[(f64, f64)]| pair[0].0 < pair[1].0 && pair[0].0 * pair[1].0 > 0.0;
    for pair in places.windows(2).filter(|pair| ordered(pair) && pair[1].0 < 1.4) {
        let found = function(Interval::new(pair[0].0, pair[1].0).expect("in order"));
        let (least, most) = (pair[0].1.min(pair[1].1), pair[0].1.max(pair[1].1));
        assert!(found.lower() <= least && most.next_up() <= found.upper(), "{what}: {found}");
    }
}

#[test]
fn exponentials_and_logarithms() {
    let exponentials = [
        (0.7, 2.013752707470476),
        (-1.3, 0.27253179303401254),
        (3.1, 22.197951281441632),
        (10.0, 22026.465794806714),
        (-20.0, 2.0611536224385575e-09),
        (0.001, 1.0010005001667082),
        (1.9, 6.6858944422792685),
    ];
    check_all("exp", Interval::exp, &exponentials);
    let logarithms = [
        (0.7, -0.35667494393873245),
        (1.3, 0.26236426446749106),
        (3.1, 1.1314021114911004),
        (10.0, 2.3025850929940455),
        (1e-05, -11.512925464970229),
        (7.0, 1.9459101490553132),
    ];
    check_all("ln", |x| x.ln().expect("of what is positive"), &logarithms);
}

#[test]
fn functions_of_angles() {
    let sines = [
        (0.7, 0.644217687237691),
        (-1.3, -0.9635581854171931),
        (3.1, 0.041580662433290484),
        (10.0, -0.5440211108893699),
        (-20.0, -0.9129452507276277),
        (1e6, -0.349993502171293),
    ];
    check_all("sin", Interval::sin, &sines);
    let cosines = [
        (0.7, 0.7648421872844884),
        (-1.3, 0.26749882862458735),
        (3.1, -0.9991351502732795),
        (10.0, -0.8390715290764525),
        (1e6, 0.9367521275331447),
    ];
    check_all("cos", Interval::cos, &cosines);
    let tangents = [
        (0.7, 0.8422883804630793),
        (-1.3, -3.602102447967979),
        (3.1, -0.041616654585635904),
        (10.0, 0.6483608274590866),
        (0.3, 0.3093362496096232),
    ];
    check_all("tan", Interval::tan, &tangents);
    // At 0.7 the library of Linux is off by more than a unit in the last place.
    let hyperbolic = [
        (-1.3, -0.8617231593133065),
        (-0.2, -0.19737532022490403),
        (0.05, 0.04995837495787997),
        (0.7, 0.6043677771171634),
        (1.1, 0.8004990217606297),
        (3.1, 0.9959493592219002),
    ];
    check_all("tanh", Interval::tanh, &hyperbolic);
}

#[test]
fn angles_of_points() {
    let angles = [
        (0.7, 1.3, 0.4939413689195811),
        (1.3, -0.7, 2.0647376957144776),
        (-2.1, -0.4, -1.7590178320996674),
        (-0.3, 5.1, -0.058755822715722696),
        (2.0, 3.0, 0.5880026035475675),
        (1.0, 7.0, 0.1418970546041639),
    ];
    for (y, x, below) in angles {
        check("the angle", y, Interval::point(y).atan2(Interval::point(x)), below);
    }
    // π is between the number called so and the next one.
    let everywhere = Interval::WHOLE.atan2(Interval::WHOLE);
    assert!(everywhere.lower() < -std::f64::consts::PI);
    assert!(everywhere.upper() > std::f64::consts::PI);
}

#[test]
fn powers() {
    let halves = [
        (0.7, 0.5856620185738528),
        (1.3, 1.4822280526288794),
        (3.1, 5.458113227114293),
        (20.0, 89.44271909999158),
        (2.0, 2.82842712474619),
    ];
    check_all("the power 1.5", power(1.5), &halves);
    let falling = [
        (0.7, 1.1129370181006415),
        (1.3, 0.9243086009945788),
        (3.1, 0.7121828181622818),
        (0.4, 1.3163822043342372),
    ];
    check_all("the power −0.3", power(-0.3), &falling);
    let cubes = [
        (0.7, 0.3429999999999999),
        (1.3, 2.197),
        (3.1, 29.791),
        (-20.3, -8365.427000000001),
        (-10.1, -1030.301),
        (-0.3, -0.027),
    ];
    check_all("the power 3", power(3.0), &cubes);
    let inverse_cubes = [
        (0.7, 2.915451895043732),
        (1.3, 0.45516613563950836),
        (-20.3, -0.0001195396242176281),
        (-10.1, -0.0009705901479276447),
    ];
    check_all("the power −3", power(-3.0), &inverse_cubes);
    let even = [
        (0.7, 0.24009999999999992),
        (1.3, 2.8561),
        (3.1, 92.35210000000001),
        (-10.1, 10406.040099999998),
    ];
    check_all("the power 4", power(4.0), &even);
    check_all(
        "the square",
        power(2.0),
        &[
            (0.1, 0.01),
            (0.3, 0.08999999999999998),
            (0.7, 0.48999999999999994),
            (-1.1, 1.2100000000000002),
            (1.3, 1.69),
        ],
    );
    let inverse_even =
        [(0.7, 4.164931278633903), (1.3, 0.35012779664577565), (-20.3, 5.888651439292024e-06)];
    check_all("the power −4", power(-4.0), &inverse_even);
}

/// Where numbers are so far apart that a peak of the cosine lies between two neighbours, it counts.
#[test]
fn peaks_between_neighbours_are_met() {
    let (mut angle, mut peaks) = (1e15f64, 0);
    for _ in 0..2000 {
        let next = angle.next_up();
        let between = Interval::new(angle, next).expect("in order");
        // The cosine falls where the sine is positive: it has risen and falls again.
        if angle.sin() < 0.0 && next.sin() > 0.0 && angle.cos() > 0.0 {
            assert_eq!(between.cos().upper(), 1.0, "between {angle} and {next}");
            peaks += 1;
        }
        if angle.cos() > 0.0 && next.cos() < 0.0 {
            assert_eq!(between.sin().upper(), 1.0, "between {angle} and {next}");
        }
        angle = next;
    }
    assert!(peaks > 20, "there are {peaks}");
}

/// A sum beyond all numbers is beyond the largest one, and not infinite for sure.
#[test]
fn sums_that_overflow_hold_what_is_large() {
    let largest = Interval::point(f64::MAX);
    let sum = largest + largest;
    assert_eq!((sum.lower(), sum.upper()), (f64::MAX, f64::INFINITY));
    let sum = -largest - largest;
    assert_eq!((sum.lower(), sum.upper()), (f64::NEG_INFINITY, f64::MIN));
}
