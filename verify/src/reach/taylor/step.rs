//! One step of a Taylor series in time: what encloses it, and what it is bounded by.

use pleach_guards::Interval;

use crate::reach::series::{Coefficient, SeriesProgram};
use crate::reach::taylor_model::{Limits, TaylorModel};
use crate::reach::vector::{around_zero, magnitude};

/// What encloses a step.
pub(super) struct Step {
    pub length: f64,
    /// xⱼ for each variable.
    pub coefficients: Vec<Vec<TaylorModel>>,
    /// f⁽ᵏ⁾(B) for each variable.
    pub last: Vec<Interval>,
}

/// f⁽ᵏ⁾(B) for a box B that solutions do not leave for `length` seconds; `None` if none is found.
pub(super) fn remainder(
    program: &SeriesProgram,
    coefficients: &[Vec<TaylorModel>],
    length: f64,
    order: usize,
) -> Option<Vec<Interval>> {
    /// How often a box is tried.
    const TRIALS: usize = 4;
    let within = Interval::new(0.0, length).ok()?;
    let known: Vec<Interval> =
        coefficients.iter().map(|series| polynomial(series, within)).collect();
    let power = power_of(within, order);
    let mut guess: Vec<Interval> = known.iter().map(|side| inflated(*side, 0.01)).collect();
    for _ in 0..TRIALS {
        let series = program.solve(&guess, order, ())?;
        let last: Vec<Interval> = series.iter().map(|of_one| of_one[order]).collect();
        let image: Vec<Interval> =
            known.iter().zip(&last).map(|(side, last)| *side + power * *last).collect();
        let is_inside = |(inner, outer): (&Interval, &Interval)| {
            outer.lower() <= inner.lower() && inner.upper() <= outer.upper()
        };
        if image.iter().zip(&guess).all(is_inside) {
            return Some(last);
        }
        if !image.iter().all(|side| side.lower().is_finite() && side.upper().is_finite()) {
            return None;
        }
        guess = image.iter().zip(&guess).map(|(new, old)| inflated(new.hull(*old), 0.1)).collect();
    }
    None
}

/// tᵏ for times t.
fn power_of(time: Interval, order: usize) -> Interval {
    (0..order).fold(Interval::point(1.0), |power, _| power * time)
}

/// A wider interval.
fn inflated(side: Interval, share: f64) -> Interval {
    side + around_zero(side.width() * share + magnitude(side) * 1e-9 + 1e-12)
}

/// Σ xⱼ tʲ for times t, as one interval.
fn polynomial(series: &[TaylorModel], time: Interval) -> Interval {
    series
        .iter()
        .rev()
        .fold(Interval::point(0.0), |sum, coefficient| sum * time + coefficient.range())
}

/// What a step adds to the remainders, as a share of the state.
pub(super) fn share_of_error(
    state: &[TaylorModel],
    last: &[Interval],
    length: f64,
    order: usize,
) -> f64 {
    let power = length.powi(order as i32);
    let share = |(component, last): (&TaylorModel, &Interval)| {
        magnitude(*last) * power / magnitude(component.range()).max(1.0)
    };
    state.iter().zip(last).map(share).fold(0.0, f64::max)
}

/// Of no components.
const NONE: Limits = Limits { degree: 1, first_error: 0, least: 0.0 };

/// d · x
pub(super) fn combined<'a>(
    direction: &[f64],
    components: impl Iterator<Item = &'a TaylorModel>,
) -> TaylorModel {
    let mut components = components.peekable();
    let limits = components.peek().map_or(NONE, |component| component.limits());
    let zero = TaylorModel::constant(Interval::point(0.0), limits);
    let terms = direction.iter().zip(components).filter(|(entry, _)| **entry != 0.0);
    terms.fold(zero, |sum, (entry, component)| match *entry {
        1.0 => sum.plus(component),
        -1.0 => sum.minus(component),
        entry => sum.plus(&component.scaled(Interval::point(entry))),
    })
}

impl Step {
    /// The state at the end.
    pub(super) fn end(&self) -> Vec<TaylorModel> {
        let time = Interval::point(self.length);
        let power = power_of(time, self.coefficients.first().map_or(0, Vec::len));
        let end = |(series, last): (&Vec<TaylorModel>, &Interval)| {
            let limits = series[0].limits();
            let nothing = TaylorModel::constant(Interval::point(0.0), limits);
            let sum = series
                .iter()
                .rev()
                .fold(nothing, |sum, coefficient| sum.scaled(time).plus(coefficient));
            sum.plus(&TaylorModel::number(power * *last, limits))
        };
        self.coefficients.iter().zip(&self.last).map(end).collect()
    }

    /// At least d · x during the step.
    ///
    /// Σ aⱼ tʲ over times t from 0 to 1 lies between its smallest and its largest Bernstein coefficient
    /// (Farouki 2012, *The Bernstein polynomial basis: a centennial retrospective*,
    /// [doi:10.1016/j.cagd.2012.03.001](https://doi.org/10.1016/j.cagd.2012.03.001)).
    pub(super) fn bound_along(&self, direction: &[f64]) -> f64 {
        let order = self.coefficients.first().map_or(0, Vec::len);
        let length = Interval::point(self.length);
        let within = Interval::new(0.0, self.length).unwrap_or(Interval::WHOLE);
        let last = direction.iter().zip(&self.last).filter(|(entry, _)| **entry != 0.0);
        let last = last.map(|(entry, last)| Interval::point(*entry) * *last);
        let last = last.fold(Interval::point(0.0), |sum, term| sum + term);
        let rest = power_of(within, order) * last;

        let along = |at: usize| {
            let column = self.coefficients.iter().map(|series| &series[at]);
            combined(direction, column).scaled(power_of(length, at))
        };
        let powers: Vec<TaylorModel> = (0..order).map(along).collect();
        let bernstein = |number: usize| {
            let terms = powers[..=number].iter().enumerate();
            let terms = terms.map(|(at, power)| power.scaled(share(number, at, order - 1)));
            terms.reduce(|sum, term| sum.plus(&term)).map(|sum| sum.range().upper())
        };
        let most = (0..order).filter_map(bernstein).fold(f64::NEG_INFINITY, f64::max);
        (Interval::point(most) + rest).upper()
    }
}

/// How much of the coefficient of tʲ is in the i-th Bernstein coefficient of degree n: (i over j) of
/// (n over j).
fn share(i: usize, j: usize, n: usize) -> Interval {
    // Whole numbers that are exact: orders are at most 30.
    let over = |n: usize| (0..j).fold(1.0, |product, k| product * (n - k) as f64 / (k + 1) as f64);
    Interval::point(over(i)) / Interval::point(over(n))
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use num_traits::One;

    use super::*;
    use crate::reach::exact::{fraction, holds};

    #[test]
    fn shares_hold_quotients_of_binomials() {
        let over = |n: usize, j: usize| {
            let factor = |k: usize| fraction((n - k) as f64) / fraction((k + 1) as f64);
            (0..j).map(factor).fold(BigRational::one(), |product, factor| product * factor)
        };
        for n in 0..30 {
            for i in 0..=n {
                for j in 0..=i {
                    assert!(holds(share(i, j, n), &(over(i, j) / over(n, j))), "{i} {j} {n}");
                }
            }
        }
    }

    /// t − t² is 1/4 at most, though its coefficients add up to 1.
    #[test]
    fn steps_are_bounded_by_bernstein_coefficients() {
        let limits = Limits { degree: 1, first_error: 1, least: 0.0 };
        let number = |value: f64| TaylorModel::constant(Interval::point(value), limits);
        let step = Step {
            length: 1.0,
            coefficients: vec![[0.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0].map(number).to_vec()],
            last: vec![Interval::point(0.0)],
        };
        let most = step.bound_along(&[1.0]);
        assert!((0.25..0.31).contains(&most), "{most}");
        let least = step.bound_along(&[-1.0]);
        assert!((0.0..1e-12).contains(&least), "{least}");
    }
}
