//! Events found by enclosures, against closed forms and Sturm's sequences.

use nalgebra::dmatrix;
use pleach_continuous::flow::{
    ConstantFlow, Curve, Doubt, EventSearch, Finding, Integrator, LinearFlow, Lost, Piece,
    Tolerances, Uncertainty, Watch, isolate,
};
use pleach_guards::{
    CompiledPredicate, Course, Enclosure, EvaluationError, Interval, Predicate, Tracker, Verdict,
    variable,
};
use proptest::prelude::*;

use super::support::state;

/// A predicate over states whose components go by these names.
struct Formula {
    predicate: CompiledPredicate,
    tracker: Tracker,
    slots: Vec<usize>,
}

impl Formula {
    fn new(predicate: &Predicate, names: &[&str]) -> Self {
        Formula {
            predicate: predicate.compile(names).expect("the names are those"),
            tracker: predicate.track(names).expect("the names are those"),
            slots: (0..names.len()).collect(),
        }
    }
}

impl Watch for Formula {
    type Error = EvaluationError;

    fn verdict(&mut self, state: &[f64]) -> Result<Verdict, EvaluationError> {
        self.predicate.evaluate(state)
    }

    fn course(&mut self, states: &[Enclosure], half_width: f64) -> Course {
        self.tracker.course(states, &self.slots, half_width, 0.0, &|_| None)
    }
}

const BUDGET: u64 = 1_000_000;

/// What is found from start to end of the curve, piece by piece.
fn search(curve: &impl Curve, predicate: &Predicate, names: &[&str]) -> Finding<EvaluationError> {
    let mut formula = Formula::new(predicate, names);
    let (mut from, mut budget, mut doubts) = (curve.start(), BUDGET, Vec::new());
    loop {
        let piece = curve.piece(from).expect("the curve is known");
        let search = EventSearch::default();
        let found = isolate(&piece, from, piece.end(), &search, &mut formula, &mut budget);
        doubts.extend(found.doubts);
        if let Ok(Some(onset)) = found.onset {
            let landing = formula.verdict(&state(&piece, onset.time));
            assert!(landing.is_ok_and(|verdict| verdict.holds), "lands where it holds");
            let narrow = (2.0 * f64::EPSILON * onset.time.abs()).max(f64::MIN_POSITIVE);
            assert!(onset.time - onset.before <= narrow);
        }
        if found.onset != Ok(None) || piece.end() >= curve.end() {
            return Finding { onset: found.onset, doubts };
        }
        from = piece.end();
    }
}

fn first(curve: &impl Curve, predicate: &Predicate, names: &[&str]) -> f64 {
    let found = search(curve, predicate, names).onset.expect("there are verdicts");
    found.expect("an event").time
}

fn clock(duration: f64) -> ConstantFlow {
    ConstantFlow::new(&[1.0], &[0.0], duration).unwrap()
}

/// sin(50 t) reaches 0.99 at asin(0.99) ÷ 50, and for short visits 25 times per turn of the clock:
/// no number of looks that depends on the horizon finds the first.
#[test]
fn a_fast_formula_of_a_slow_flow_is_followed() {
    let guard = (50.0 * variable("x")).sin().at_least(0.99);
    let exact = 0.99_f64.asin() / 50.0;
    for duration in [0.03, 1.0, 10.0, 100.0, 1e6] {
        let time = first(&clock(duration), &guard, &["x"]);
        assert!((time - exact).abs() < 1e-16, "{time} for {duration}");
    }
}

/// What holds from the start on, but not at the start itself, begins at one of the smallest numbers.
#[test]
fn what_holds_right_after_the_start_begins_there() {
    for guard in [variable("x").more_than(0.0), variable("x").sin().more_than(0.0)] {
        let time = first(&clock(10.0), &guard, &["x"]);
        assert!(time > 0.0 && time < 1e-300, "{time}");
    }
}

/// Visits of 2·10⁻⁶ s among 10⁶ s, with a margin that is flat elsewhere.
#[test]
fn a_needle_is_found() {
    let guard = (-((variable("x") - 123_456.0) * 1e6).power(2.0)).exp().at_least(0.5);
    let time = first(&clock(1e6), &guard, &["x"]);
    let exact = 123_456.0 - 2f64.ln().sqrt() * 1e-6;
    assert!((time - exact).abs() < 1e-10, "{time} {exact}");
}

/// The first of two visits between any two looks.
#[test]
fn the_earlier_of_two_close_visits_is_the_first() {
    let x = || variable("x");
    let hump = |at: f64| 1e-3 - (x() - at).abs();
    let guard = hump(6.4).max(hump(6.41)).at_least(0.0);
    let time = first(&clock(10.0), &guard, &["x"]);
    assert!((time - 6.399).abs() < 1e-14, "{time}");
}

/// sin x + cos x comes to within rounding of √2 + 10⁻¹⁵, twice in ten seconds; √(1 − x) ends at 1.
#[test]
fn touches_are_doubted_and_missing_values_are_errors() {
    let wave = variable("x").sin() + variable("x").cos();
    let below = wave.at_least(2f64.sqrt() + 1e-15);
    let found = search(&clock(10.0), &below, &["x"]);
    let at: Vec<f64> = found.doubts.iter().map(|doubt| 0.5 * (doubt.from + doubt.to)).collect();
    assert!(found.onset == Ok(None) && at.len() == 2, "{found:?}");
    assert!((at[0] - 0.25 * std::f64::consts::PI).abs() < 1e-6, "{at:?}");
    assert!(found.doubts.iter().all(|doubt| doubt.why == Uncertainty::Touch));
    assert!(found.doubts.iter().all(|doubt| doubt.to - doubt.from < 1e-6));

    let clear = wave.at_least(2f64.sqrt() + 1e-9);
    let found = search(&clock(10.0), &clear, &["x"]);
    assert_eq!(found, Finding { onset: Ok(None), doubts: Vec::new() }, "a proof");

    let root = (1.0 - variable("x")).square_root().at_least(2.0);
    // What was in doubt before is not forgotten.
    for (guard, doubts) in [(root.clone(), 0), (below | root, 1)] {
        let found = search(&clock(5.0), &guard, &["x"]);
        let Err(Lost::Undefined { after, at, .. }) = found.onset else { panic!("{found:?}") };
        assert!(after <= 1.0 && 1.0 < at && at - after < 1e-12, "{after} {at}");
        assert_eq!(found.doubts.len(), doubts, "{:?}", found.doubts);
    }
}

#[test]
fn functions_are_looked_at_and_that_is_said() {
    let guard = Predicate::function("late", |state| Ok(variable("x").evaluate(state)? - 3.0));
    let found = search(&clock(10.0), &guard, &["x"]);
    let onset = found.onset.clone().expect("it has a value");
    assert!(onset.is_some_and(|onset| (onset.time - 3.0).abs() < 1e-14));
    let [doubt] = found.doubts[..] else { panic!("{found:?}") };
    assert_eq!((doubt.from, doubt.why), (0.0, Uncertainty::Function));
    // Where a formula decides, nothing is in doubt.
    let never = guard & variable("x").at_most(-1.0);
    let found = search(&clock(10.0), &never, &["x"]);
    assert_eq!(found, Finding { onset: Ok(None), doubts: Vec::new() });
}

#[test]
fn a_budget_ends_the_search() {
    let wave = variable("x").sin() + variable("x").cos();
    let guard = wave.at_least(2f64.sqrt() + 1e-15);
    let mut formula = Formula::new(&guard, &["x"]);
    let piece = clock(1e9).piece(0.0).expect("a line");
    let mut budget = 1000;
    let lost = isolate(&piece, 0.0, 1e9, &EventSearch::default(), &mut formula, &mut budget);
    let Err(Lost::Endless { at }) = lost.onset else { panic!("{lost:?}") };
    assert!(0.0 < at && at < 1e9);
}

/// A ball that falls on a table x = a sin ωt meets it at the first root of h₀ − t²/2 − a sin ωt; with
/// h₀ = 10, a = 0.05 and ω = 50 that is, by a scan and mpmath's `findroot` at 40 digits,
/// 4.48173027388915099778….
#[test]
fn a_ball_meets_a_vibrating_table() {
    let fall = LinearFlow::new(
        &dmatrix![0.0, 1.0, 0.0; 0.0, 0.0, 0.0; 0.0, 0.0, 0.0],
        &[0.0, -1.0, 1.0],
        &[10.0, 0.0, 0.0],
        100.0,
    )
    .unwrap();
    let [h, t] = ["h", "t"].map(variable);
    let meets = (h - 0.05 * (50.0 * t).sin()).at_most(0.0);
    let time = first(&fall, &meets, &["h", "v", "t"]);
    let at = |time: f64| 10.0 - 0.5 * time * time - 0.05 * (50.0 * time).sin();
    assert!((time - 4.481_730_273_889_151).abs() < 1e-14, "{time}");
    let earlier = (0..1_000_000).map(|step| time * f64::from(step) * 1e-6);
    assert!(earlier.into_iter().all(|time| at(time) > 0.0));
}

/// x″ = −x reaches −0.9999 within every turn, also after a thousand.
#[test]
fn exponentials_come_in_pieces_that_agree_with_them() {
    let wave =
        LinearFlow::new(&dmatrix![0.0, 1.0; -1.0, 0.0], &[0.0; 2], &[1.0, 0.0], 1e4).unwrap();
    let mut from = 0.0;
    while from < 1e4 {
        let piece = wave.piece(from).expect("pieces");
        for tenth in 0..=10 {
            let time = from + 0.1 * f64::from(tenth) * (piece.end() - from);
            let error = (piece.value(0, time) - time.cos()).abs();
            assert!(error < 1e-11, "{error:e} at {time}");
            assert!((piece.rate(0, time) + time.sin()).abs() < 1e-11, "at {time}");
        }
        assert!(piece.end() > from);
        from = piece.end();
    }
    let time = first(&wave, &variable("x").at_most(-0.9999), &["x", "v"]);
    assert!((time - (-0.9999_f64).acos()).abs() < 1e-13, "{time}");
}

/// A mode of 10⁶ per second beside one of 1: the fast one fades, and few pieces remain.
#[test]
fn stiff_exponentials_come_in_few_pieces() {
    let matrix = dmatrix![-1e6, 0.0; 1.0, -1.0];
    let flow = LinearFlow::new(&matrix, &[0.0; 2], &[1.0, 1.0], 10.0).unwrap();
    let slow = |t: f64| {
        let share = 1.0 / (1.0 - 1e6);
        share * (-1e6 * t).exp() + (1.0 - share) * (-t).exp()
    };
    let (mut from, mut pieces) = (0.0, 0);
    while from < 10.0 {
        let piece = flow.piece(from).expect("pieces");
        for tenth in 0..=10 {
            let time = from + 0.1 * f64::from(tenth) * (piece.end() - from);
            let error = (piece.value(1, time) - slow(time)).abs();
            assert!(error <= piece.error(1) + 1e-9, "{error:e} at {time}, {}", piece.error(1));
        }
        (from, pieces) = (piece.end(), pieces + 1);
    }
    // Two e-foldings each, until nothing is left of the fast one, which decays alone.
    assert!(pieces < 800, "{pieces}");
}

/// What decays is as exact beside what it is as at the start, also where it is driven by less.
#[test]
fn decay_is_exact_beside_the_present_state() {
    for horizon in [100.0, 700.0, 1e4] {
        let flow = LinearFlow::new(&dmatrix![-1.0], &[0.0], &[1.0], horizon).unwrap();
        let mut time = 0.0;
        while time < 700.0_f64.min(horizon) {
            let piece = flow.piece(time).expect("pieces");
            time = piece.end().min(700.0);
            let (found, exact) = (piece.value(0, time), (-time).exp());
            assert!((found - exact).abs() <= 1e-12 * exact, "{found:e} {exact:e} at {time} s");
        }
    }
    // x follows y, which begins far below it: e⁻¹⁰⁰⁰ᵗ is what x is for long.
    let matrix = dmatrix![-1000.0, 1000.0; 0.0, -1.0];
    let flow = LinearFlow::new(&matrix, &[0.0; 2], &[1.0, 1e-30], 10.0).unwrap();
    let mut time = 0.0;
    while time < 10.0 {
        let piece = flow.piece(time).expect("pieces");
        time = piece.end();
        let share = 1000.0 / 999.0 * 1e-30;
        let exact = share * (-time).exp() + (1.0 - share) * (-1000.0 * time).exp();
        let found = piece.value(0, time);
        assert!((found - exact).abs() <= 1e-10 * exact, "{found:e} {exact:e} at {time} s");
    }
}

#[test]
fn steps_of_an_integration_are_pieces() {
    let pendulum = |_: f64, x: &[f64], rates: &mut [f64]| {
        rates[0] = x[1];
        rates[1] = -x[0].sin();
    };
    let mut integrator = Integrator::new(&pendulum, 0.0, &[0.0, 1.5], Tolerances::default());
    while integrator.time() < 20.0 {
        let step = integrator.step(20.0).unwrap();
        let piece = step.piece(step.start()).expect("a step is a polynomial");
        for tenth in 0..=10 {
            let time = step.start() + 0.1 * f64::from(tenth) * (step.end() - step.start());
            let (own, other) = (state(&step, time), state(&piece, time));
            assert!(own.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-14), "at {time}");
        }
        assert!(piece.error(0) > 0.0);
    }
}

/// Pieces before, around and after the time that their powers count from.
#[test]
fn ranges_contain_what_pieces_are() {
    for (start, end) in [(-3.0, -1.0), (-1.0, 2.0), (0.0, 1.0), (0.5, 4.0)] {
        let mut piece = Piece::new(start, end, 0.0, 1.5);
        piece.push([1.0, -2.0, 0.5, 3.0, -0.25], 1e-3);
        piece.push([4.0], 0.0);
        let ranges = [piece.range(0), piece.range(1)];
        for step in 0..=1000 {
            let time = start + 0.001 * f64::from(step) * (end - start);
            for (component, range) in ranges.iter().enumerate() {
                let (value, error) = (piece.value(component, time), piece.error(component));
                assert!(range.contains(value - error) && range.contains(value + error), "{time}");
            }
        }
        assert!(ranges[1].width() < 1e-13, "{}", ranges[1]);
    }
}

/// A sum without negative terms is not negative, but for its error; of what is no number, nothing is known.
#[test]
fn ranges_keep_signs_and_know_nothing_of_what_is_no_number() {
    let mut piece = Piece::new(0.0, 1.0, 0.0, 1.0);
    piece.push([0.0, 0.1, 0.2], 0.0);
    piece.push([0.0, -0.1, -0.2], 0.5);
    piece.push([1.0, f64::INFINITY], 0.0);
    let [rises, falls, unknown] = [0, 1, 2].map(|component| piece.range(component));
    assert!(rises.lower() == 0.0 && rises.upper() >= 0.3, "{rises}");
    assert!(falls.upper() == 0.5 && falls.lower() <= -0.8, "{falls}");
    assert_eq!(unknown, Interval::WHOLE);
}

/// How many different roots of the polynomial lie in (from, to], by Sturm's theorem.
fn roots(polynomial: &[f64], from: f64, to: f64) -> i64 {
    let value = |p: &[f64], x: f64| p.iter().rev().fold(0.0, |sum, c| sum * x + c);
    let mut chain: Vec<Vec<f64>> = vec![polynomial.to_vec()];
    let terms = polynomial.iter().zip(0..).skip(1);
    chain.push(terms.map(|(c, k)| c * f64::from(k)).collect());
    while let [.., before, last] = &chain[..] {
        if last.len() < 2 {
            break;
        }
        let mut rest = before.clone();
        while rest.len() >= last.len() {
            let factor = rest[rest.len() - 1] / last[last.len() - 1];
            let shift = rest.len() - last.len();
            for (place, c) in last.iter().enumerate() {
                rest[shift + place] -= factor * c;
            }
            rest.pop();
        }
        let next: Vec<f64> = rest.into_iter().map(|c| -c).collect();
        chain.push(next);
    }
    let changes = |x: f64| {
        let signs = chain.iter().map(|p| value(p, x)).filter(|value| *value != 0.0);
        let signs: Vec<bool> = signs.map(|value| value > 0.0).collect();
        signs.windows(2).filter(|pair| pair[0] != pair[1]).count() as i64
    };
    changes(from) - changes(to)
}

proptest! {
    /// The first root of a random polynomial of the time, with the number of roots before it and
    /// up to it by Sturm's theorem: none, and one.
    #[test]
    fn no_root_lies_before_the_first(
        zeros in prop::collection::vec(0.02..9.98_f64, 1..6),
        pair in prop::option::of((0.0..10.0_f64, 0.01..1.0_f64)),
        below in prop::bool::ANY,
    ) {
        let mut zeros = zeros;
        zeros.sort_by(f64::total_cmp);
        zeros.dedup_by(|a, b| (*a - *b).abs() < 0.02);
        let times = |p: &[f64], q: &[f64]| {
            let mut product = vec![0.0; p.len() + q.len() - 1];
            for (i, a) in p.iter().enumerate() {
                for (j, b) in q.iter().enumerate() {
                    product[i + j] += a * b;
                }
            }
            product
        };
        let mut polynomial = vec![1.0];
        for zero in &zeros {
            polynomial = times(&polynomial, &[-zero / 10.0, 0.1]);
        }
        if let Some((centre, distance)) = pair {
            let square = [centre * centre + distance * distance, -2.0 * centre, 1.0];
            polynomial = times(&polynomial, &square);
        }
        let sign = if (polynomial[0] > 0.0) == below { -1.0 } else { 1.0 };
        let rising: Vec<f64> = polynomial.iter().map(|c| sign * c).collect();
        let mut piece = Piece::new(0.0, 10.0, 0.0, 1.0);
        piece.push(rising.iter().copied(), 0.0);
        // The polynomial begins below 0, so that the guard first holds at its first root.
        let expected = if rising[0] < 0.0 { zeros[0] } else { 0.0 };
        let time = first(&piece, &variable("p").at_least(0.0), &["p"]);
        prop_assert!((time - expected).abs() < 1e-9, "{time} {expected}");
        if rising[0] < 0.0 {
            prop_assert_eq!(roots(&rising, 0.0, time - 1e-6), 0);
            prop_assert_eq!(roots(&rising, 0.0, time + 1e-6), 1);
        }
    }

    /// Chirps: sin(a t + b t²) − c, whose first root is that of a quadratic equation.
    #[test]
    fn chirps_are_met_at_their_first_root(a in 0.1..80.0_f64, b in 0.0..30.0_f64, c in 0.05..0.999_f64) {
        let x = variable("x");
        let guard = (a * &x + b * x.power(2.0)).sin().at_least(c);
        let angle = c.asin();
        let exact = 2.0 * angle / (a + (a * a + 4.0 * b * angle).sqrt());
        let time = first(&clock(1e3), &guard, &["x"]);
        prop_assert!((time / exact - 1.0).abs() < 1e-13, "{time} {exact}");
    }

    /// A visit of any length to a disc beside a straight way.
    #[test]
    fn discs_beside_the_way_are_entered(centre in 1.0..9999.0_f64, half in 1e-3..1.0_f64) {
        let way = ConstantFlow::new(&[1.0, 0.0], &[0.0, 3.0], 1e4).unwrap();
        let [x, y] = ["x", "y"].map(variable);
        let radius = (9.0 + half * half).sqrt();
        let distance = pleach_guards::norm([x - centre, y]);
        let time = first(&way, &distance.at_most(radius), &["x", "y"]);
        let blur = 1e-14 * centre + 1e-14 / half;
        prop_assert!((time - (centre - half)).abs() < 100.0 * blur, "{time} {}", centre - half);
    }
}

/// Doubts of one kind that follow one another are one.
#[test]
fn neighbouring_doubts_are_joined() {
    let still = ConstantFlow::new(&[1.0], &[0.0], 1.0).unwrap();
    let function = Predicate::function("never", |_| Ok(-1.0));
    let found = search(&still, &function, &["x"]);
    assert_eq!(found.doubts, [Doubt { from: 0.0, to: 1.0, why: Uncertainty::Function }]);
}

/// A margin that is positive for a moment, of which enclosures say nothing.
struct Peak {
    at: f64,
}

impl Watch for Peak {
    type Error = EvaluationError;

    fn verdict(&mut self, state: &[f64]) -> Result<Verdict, EvaluationError> {
        let margin = 1e-8 - (state[0] - self.at).powi(2);
        Ok(Verdict { margin, holds: margin >= 0.0 })
    }

    fn course(&mut self, _states: &[Enclosure], _half_width: f64) -> Course {
        Course::Blurred
    }
}

/// Where halving tells nothing the margin is climbed, and what is not met is in doubt.
#[test]
fn peaks_that_enclosures_do_not_show_are_climbed() {
    let mut piece = Piece::new(0.0, 1.0, 0.0, 1.0);
    piece.push([0.0, 1.0], 0.0);
    for at in [0.1, 0.377, 0.62, 0.9] {
        let mut budget = BUDGET;
        let search = EventSearch::default();
        let found = isolate(&piece, 0.0, 1.0, &search, &mut Peak { at }, &mut budget);
        let onset = found.onset.expect("it has a verdict").expect("it is climbed");
        assert!((onset.time - (at - 1e-4)).abs() < 2e-4, "{onset:?}");
    }
    let mut away = Peak { at: 3.0 };
    let found = isolate(&piece, 0.0, 1.0, &EventSearch::default(), &mut away, &mut { BUDGET });
    let Finding { onset, doubts } = found;
    assert_eq!((onset, doubts.len()), (Ok(None), 1));
    assert_eq!(doubts[0], Doubt { from: 0.0, to: 1.0, why: Uncertainty::Touch });
}

#[test]
fn enclosures_hold_the_error_of_a_piece() {
    let mut piece = Piece::new(0.0, 1.0, 0.0, 1.0);
    for coefficients in [&[2.0][..], &[1.0, 2.0], &[1.0, 2.0, 3.0]] {
        piece.push(coefficients.iter().copied(), 0.25);
    }
    let mut states = Vec::new();
    piece.enclose(0.25, 0.75, &mut states);
    for (component, enclosure) in states.iter().enumerate() {
        for time in [0.25, 0.5, 0.75] {
            let value = piece.value(component, time);
            assert!(
                enclosure.range.lower() <= value - 0.25 && value + 0.25 <= enclosure.range.upper()
            );
        }
        let value = piece.value(component, 0.5);
        assert!(
            enclosure.middle.lower() <= value - 0.25 && value + 0.25 <= enclosure.middle.upper()
        );
    }
}

/// x = 1 + 10⁻³ (t − ½) comes to 1 at ½. Unless its error is smaller than the way that it goes, it may as
/// well do so at any other instant, or never.
#[test]
fn what_begins_within_the_error_of_the_whole_piece_is_doubted() {
    let mut formula = Formula::new(&variable("x").at_least(1.0), &["x"]);
    let mut found = |error: f64| {
        let mut piece = Piece::new(0.0, 1.0, 0.0, 1.0);
        piece.push([1.0 - 0.5e-3, 1e-3], error);
        let found =
            isolate(&piece, 0.0, 1.0, &EventSearch::default(), &mut formula, &mut { BUDGET });
        let Finding { onset, doubts } = found;
        let time = onset.expect("a line has a value").expect("it is met").time;
        assert!((time - 0.5).abs() < 1e-9, "{time}");
        (time, doubts)
    };
    assert_eq!(found(1e-6).1, []);
    assert_eq!(found(4e-4).1, []);
    let (time, doubts) = found(6e-4);
    assert_eq!(doubts, [Doubt { from: 0.0, to: time, why: Uncertainty::Touch }]);
}
