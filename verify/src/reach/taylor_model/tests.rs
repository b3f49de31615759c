//! Against fractions of whole numbers.

use num_rational::BigRational;
use num_traits::{One, Zero};
use proptest::prelude::*;

use super::*;
use crate::reach::exact::{FAINT, fraction, holds};
use crate::reach::series::{Coefficient, Function};

const SYMBOLS: usize = 3;

fn limits(degree: usize, least: f64) -> Limits {
    Limits { degree, first_error: SYMBOLS, least }
}

/// The polynomial where the symbols have these values.
fn polynomial(model: &TaylorModel, at: &[f64]) -> BigRational {
    let value = |(monomial, coefficient): &(Monomial, f64)| {
        let factors = monomial.symbols().map(|symbol| fraction(at[usize::from(symbol)]));
        factors.fold(fraction(*coefficient), |product, factor| product * factor)
    };
    model.terms.iter().map(value).fold(BigRational::zero(), |sum, term| sum + term)
}

/// Whether the model has this value where the symbols have these.
fn has(model: &TaylorModel, at: &[f64], value: &BigRational) -> bool {
    holds(model.rest, &(value - polynomial(model, at))) && holds(model.range(), value)
}

/// Numbers of different sizes, none of which has few digits.
fn number() -> impl Strategy<Value = f64> {
    (any::<i32>(), -40i32..-20)
        .prop_map(|(digits, power)| f64::from(digits) * 2f64.powi(power) / 3.0)
}

/// A polynomial of degree 2 in three symbols, without a remainder.
fn model() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(number(), 7)
}

fn built(numbers: &[f64], limits: Limits) -> TaylorModel {
    let slopes = (0u8..).zip(&numbers[1..4]).map(|(symbol, slope)| (symbol, *slope));
    let mut model = TaylorModel::affine(numbers[0], slopes, limits);
    let squares = [(0, 0), (0, 1), (1, 2)]
        .map(|(one, other)| Monomial::symbol(one).times(Monomial::symbol(other)));
    model.terms.extend(squares.into_iter().zip(numbers[4..].iter().copied()));
    model.terms.retain(|(_, coefficient)| *coefficient != 0.0);
    model.terms.sort_by_key(|(monomial, _)| *monomial);
    model
}

/// Values of symbols: ends and points between them.
fn places() -> impl Strategy<Value = Vec<f64>> {
    let corner = prop_oneof![Just(-1.0), Just(1.0), Just(0.5), Just(0.0), Just(-0.75)];
    proptest::collection::vec(corner, SYMBOLS)
}

proptest! {
    #[test]
    fn operations_hold_the_exact_results(
        left in model(), right in model(), factor in number(), width in 0.0..1.0f64, at in places(),
    ) {
        let limits = limits(3, 0.0);
        let (one, other) = (built(&left, limits), built(&right, limits));
        let (p, q) = (polynomial(&one, &at), polynomial(&other, &at));
        prop_assert!(has(&one, &at, &p));
        prop_assert!(has(&one.plus(&other), &at, &(p.clone() + &q)));
        prop_assert!(has(&one.minus(&other), &at, &(p.clone() - &q)));
        prop_assert!(has(&one.times(&other), &at, &(p.clone() * &q)));
        let wide = Interval::new(factor, factor + width).unwrap();
        for end in [wide.lower(), wide.upper()] {
            prop_assert!(has(&one.scaled(wide), &at, &(p.clone() * fraction(end))));
            prop_assert!(has(&TaylorModel::constant(wide, limits), &at, &fraction(end)));
        }
    }

    /// Remainders of the operands, each at an end.
    #[test]
    fn operations_hold_the_remainders(
        left in model(), right in model(), ends in (number(), number()), at in places(), factor in number(),
    ) {
        let limits = limits(2, 1e-3);
        let (mut one, mut other) = (built(&left, limits), built(&right, limits));
        (one.rest, other.rest) = (around_zero(ends.0), around_zero(ends.1));
        let p = polynomial(&one, &at) + fraction(ends.0);
        let q = polynomial(&other, &at) + fraction(ends.1);
        prop_assert!(has(&one.plus(&other), &at, &(p.clone() + &q)));
        prop_assert!(has(&one.minus(&other), &at, &(p.clone() - &q)));
        prop_assert!(has(&one.times(&other), &at, &(p.clone() * &q)));
        let factor = Interval::point(factor);
        prop_assert!(has(&one.scaled(factor), &at, &(p * fraction(factor.lower()))));
    }

    /// 1 ÷ p, which is a fraction: for polynomials that stay away from 0.
    #[test]
    fn reciprocals_hold_the_exact_ones(slopes in model(), at in places()) {
        let limits = limits(2, 0.0);
        let share = 0.5 / slopes[1..].iter().map(|slope| slope.abs()).sum::<f64>().max(1e-9);
        let numbers: Vec<f64> = slopes.iter().map(|slope| slope * share).collect();
        let model = built(&[&[1.0], &numbers[1..]].concat(), limits);
        let exact = BigRational::one() / polynomial(&model, &at);
        let found = model.function(Function::Reciprocal).expect("it is not 0");
        prop_assert!(has(&found, &at, &exact));
    }

    /// A remainder that becomes a symbol is between −1 and 1 times its coefficient.
    #[test]
    fn named_remainders_are_covered(numbers in model(), lower in number(), width in 0.0..1.0f64, at in places()) {
        let mut named = built(&numbers, limits(2, 0.0));
        let exact = polynomial(&named, &at);
        named.rest = Interval::new(lower, lower + width).unwrap();
        let ends = [named.rest.lower(), named.rest.upper()].map(fraction);
        prop_assert!(named.name_rest(SYMBOLS as u8));
        let [low, high] = [-1.0, 1.0].map(|end| polynomial(&named, &[&at[..], &[end]].concat()));
        prop_assert!(low <= exact.clone() + &ends[0] && exact + &ends[1] <= high);
    }
}

#[test]
fn given_up_terms_are_in_the_remainder() {
    let mut model = built(&[1.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6], limits(2, 0.0));
    let places = [[1.0, -1.0, 1.0], [-1.0, 1.0, 1.0], [0.0, 0.0, 0.0], [1.0, 1.0, 1.0]];
    let exact = places.map(|at| polynomial(&model, &at));
    model.give_up(|monomial, _| monomial.degree() == 2);
    assert_eq!(model.terms.len(), 4);
    for (at, exact) in places.iter().zip(exact) {
        assert!(has(&model, at, &exact));
    }
}

/// A coefficient that is too small for its digits.
#[test]
fn underflow_counts() {
    let limits = limits(2, 0.0);
    let small = TaylorModel::affine(0.0, [(0, 5e-324)], limits);
    let half = small.scaled(Interval::point(0.5));
    let exact = fraction(5e-324) * fraction(0.5);
    assert!(has(&half, &[1.0, 0.0, 0.0], &exact));
    let square = small.times(&small);
    assert!(has(&square, &[1.0, 0.0, 0.0], &(fraction(5e-324) * fraction(5e-324))));
    // Three products that are each rounded up, to the smallest number.
    let factor = 0.8 * 2f64.powi(-537);
    let sum = TaylorModel::affine(0.0, [0, 1, 2].map(|symbol| (symbol, factor)), limits);
    let product = sum.times(&TaylorModel::affine(factor, [], limits));
    let exact = fraction(factor) * fraction(factor) * fraction(3.0);
    assert!(has(&product, &[1.0, 1.0, 1.0], &exact));
}

/// Four products that add up to 1 may be off by 4 units of roundoff, and so may each coefficient.
#[test]
fn what_is_left_over_counts_rounding() {
    let left_over = left_over(Interval::point(1.0), 1.0, 4);
    assert!((8.0 * UNIT_ROUNDOFF..20.0 * UNIT_ROUNDOFF).contains(&left_over), "{left_over}");
}

/// The sum of 1 and 2⁻⁶⁰ is no number, and the remainder has what is missing.
#[test]
fn sums_of_coefficients_are_rounded_outward() {
    let limits = limits(2, 0.0);
    let [one, faint] = [1.0, FAINT].map(|slope| TaylorModel::affine(0.0, [(0, slope)], limits));
    let sum = one.plus(&faint);
    assert!(has(&sum, &[1.0, 0.0, 0.0], &(fraction(1.0) + fraction(FAINT))));
    assert!(has(&sum, &[-1.0, 0.0, 0.0], &-(fraction(1.0) + fraction(FAINT))));
}
