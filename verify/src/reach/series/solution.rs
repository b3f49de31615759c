//! The coefficients of solutions, one order after the other.

use pleach_guards::Interval;

use super::program::{Operation, SeriesProgram};
use super::{Coefficient, Function};

impl SeriesProgram {
    /// The coefficients x₀, …, xₙ of each variable, for n = `order`; `None` where a formula has no
    /// value.
    pub(crate) fn solve<C: Coefficient>(
        &self,
        start: &[C],
        order: usize,
        context: C::Context,
    ) -> Option<Vec<Vec<C>>> {
        let mut solution: Vec<Vec<C>> = start.iter().map(|first| vec![first.clone()]).collect();
        let mut series = Series::new(&self.operations, context);
        for next in 1..=order {
            series.extend(&solution)?;
            let inverse = Interval::point(1.0) / Interval::point(next as f64);
            for (variable, result) in solution.iter_mut().zip(&self.results) {
                variable.push(series.coefficients[*result][next - 1].scaled(inverse));
            }
        }
        Some(solution)
    }
}

/// The series of all operations, so far.
struct Series<'a, C: Coefficient> {
    operations: &'a [Operation],
    coefficients: Vec<Vec<C>>,
    /// The reciprocals of first coefficients that are divided by.
    inverses: Vec<Option<C>>,
    context: C::Context,
}

impl<'a, C: Coefficient> Series<'a, C> {
    fn new(operations: &'a [Operation], context: C::Context) -> Self {
        let coefficients = operations.iter().map(|_| Vec::new()).collect();
        Series { operations, coefficients, inverses: vec![None; operations.len()], context }
    }

    /// Computes the next coefficient of every operation.
    fn extend(&mut self, solution: &[Vec<C>]) -> Option<()> {
        for number in 0..self.operations.len() {
            let order = self.coefficients[number].len();
            let next = self.next(number, order, solution)?;
            self.coefficients[number].push(next);
        }
        Some(())
    }

    fn at(&self, series: usize, order: usize) -> &C {
        &self.coefficients[series][order]
    }

    /// Σ w(j) a_j b_{k−j} over `orders` j, where k is `order`.
    fn convolution(
        &self,
        (left, right): (usize, usize),
        order: usize,
        orders: std::ops::RangeInclusive<usize>,
        weight: impl Fn(usize) -> Interval,
    ) -> C {
        let mut sum = C::number(Interval::point(0.0), self.context);
        for place in orders {
            let product = self.at(left, place).times(self.at(right, order - place));
            let weight = weight(place);
            sum = if weight == Interval::point(1.0) {
                sum.plus(&product)
            } else {
                sum.plus(&product.scaled(weight))
            };
        }
        sum
    }

    /// The reciprocal of the first coefficient of a series.
    fn inverse(&mut self, number: usize, divisor: usize) -> Option<C> {
        if self.inverses[number].is_none() {
            self.inverses[number] = Some(self.at(divisor, 0).function(Function::Reciprocal)?);
        }
        self.inverses[number].clone()
    }

    fn next(&mut self, number: usize, order: usize, solution: &[Vec<C>]) -> Option<C> {
        let share = || Interval::point(1.0) / Interval::point(order as f64);
        let whole = |place: usize| Interval::point(place as f64);
        let one = |_| Interval::point(1.0);
        Some(match self.operations[number] {
            Operation::Constant(value) => {
                let value = if order == 0 { value } else { 0.0 };
                C::number(Interval::point(value), self.context)
            }
            Operation::Variable(place) => solution[place][order].clone(),
            Operation::Sum(left, right) => self.at(left, order).plus(self.at(right, order)),
            Operation::Difference(left, right) => self.at(left, order).minus(self.at(right, order)),
            Operation::Product(left, right) => {
                self.convolution((left, right), order, 0..=order, one)
            }
            Operation::Quotient(left, right) => {
                let mut rest = self.at(left, order).clone();
                for place in 1..=order {
                    rest = rest.minus(&self.at(right, place).times(self.at(number, order - place)));
                }
                rest.times(&self.inverse(number, right)?)
            }
            Operation::Sine(inner) if order == 0 => self.at(inner, 0).function(Function::Sine)?,
            Operation::Sine(inner) => {
                self.convolution((inner, number + 1), order, 1..=order, whole).scaled(share())
            }
            Operation::Cosine(inner) if order == 0 => {
                self.at(inner, 0).function(Function::Cosine)?
            }
            Operation::Cosine(inner) => {
                self.convolution((inner, number - 1), order, 1..=order, whole).scaled(-share())
            }
            Operation::Exponential(inner) if order == 0 => {
                self.at(inner, 0).function(Function::Exponential)?
            }
            Operation::Exponential(inner) => {
                self.convolution((inner, number), order, 1..=order, whole).scaled(share())
            }
            Operation::Logarithm(inner) if order == 0 => {
                self.at(inner, 0).function(Function::Logarithm)?
            }
            Operation::Logarithm(inner) => {
                let sum = self.convolution((number, inner), order, 1..=order - 1, whole);
                let rest = self.at(inner, order).minus(&sum.scaled(share()));
                rest.times(&self.inverse(number, inner)?)
            }
            Operation::Power(inner, exponent) if order == 0 => {
                self.at(inner, 0).function(Function::Power(exponent))?
            }
            Operation::Power(inner, exponent) => {
                let weight =
                    |place: usize| Interval::point(exponent) * whole(place) - whole(order - place);
                let sum = self.convolution((inner, number), order, 1..=order, weight);
                sum.times(&self.inverse(number, inner)?).scaled(share())
            }
            Operation::HyperbolicTangent(inner) if order == 0 => {
                self.at(inner, 0).function(Function::HyperbolicTangent)?
            }
            Operation::HyperbolicTangent(inner) => {
                self.convolution((inner, number + 1), order, 1..=order, whole).scaled(share())
            }
            Operation::OneLessSquare => {
                let value = if order == 0 { 1.0 } else { 0.0 };
                let first = C::number(Interval::point(value), self.context);
                first.minus(&self.convolution((number - 1, number - 1), order, 0..=order, one))
            }
        })
    }
}
