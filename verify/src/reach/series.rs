//! Taylor coefficients of solutions, order by order, from the formulas of their rates.
//!
//! With x(t) = Σ xₖ tᵏ, each operation gives the coefficients of its result from those of its
//! operands, and xₖ₊₁ is the k-th coefficient of the rate, divided by k + 1 (Moore, Kearfott and
//! Cloud 2009, *Introduction to Interval Analysis*, chapter 9). The coefficients are intervals, which
//! encloses those of all solutions through a box, or [Taylor models](super::taylor_model), which keep
//! how they depend on the initial state.

use std::collections::BTreeMap;

use pleach_guards::Interval;
use pleach_guards::expression::{BinaryOperator, Expression, UnaryOperator};

use super::taylor_model::{Limits, TaylorModel};

/// What coefficients are made of.
pub(super) trait Coefficient: Clone {
    /// What a number needs beside its value.
    type Context: Copy;
    fn number(value: Interval, context: Self::Context) -> Self;
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
    fn scaled(&self, factor: Interval) -> Self;
    /// `None` where there is no value.
    fn function(&self, function: Function) -> Option<Self>;
}

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Function {
    Reciprocal,
    Sine,
    Cosine,
    Exponential,
    Logarithm,
    Power(f64),
    HyperbolicTangent,
}

impl Coefficient for Interval {
    type Context = ();

    fn number(value: Interval, _: ()) -> Self {
        value
    }

    fn plus(&self, other: &Self) -> Self {
        *self + *other
    }

    fn minus(&self, other: &Self) -> Self {
        *self - *other
    }

    fn times(&self, other: &Self) -> Self {
        *self * *other
    }

    fn scaled(&self, factor: Interval) -> Self {
        *self * factor
    }

    fn function(&self, function: Function) -> Option<Self> {
        match function {
            Function::Reciprocal => (!self.contains(0.0)).then(|| Interval::point(1.0) / *self),
            Function::Sine => Some(self.sin()),
            Function::Cosine => Some(self.cos()),
            Function::Exponential => Some(self.exp()),
            Function::Logarithm => (self.lower() > 0.0).then(|| self.ln()).flatten(),
            Function::Power(exponent) => {
                (self.lower() > 0.0).then(|| self.power(exponent)).flatten()
            }
            Function::HyperbolicTangent => Some(self.tanh()),
        }
    }
}

impl Coefficient for TaylorModel {
    type Context = Limits;

    fn number(value: Interval, limits: Limits) -> Self {
        TaylorModel::constant(value, limits)
    }

    fn plus(&self, other: &Self) -> Self {
        self.plus(other)
    }

    fn minus(&self, other: &Self) -> Self {
        self.minus(other)
    }

    fn times(&self, other: &Self) -> Self {
        self.times(other)
    }

    fn scaled(&self, factor: Interval) -> Self {
        self.scaled(factor)
    }

    fn function(&self, function: Function) -> Option<Self> {
        if function == Function::HyperbolicTangent {
            // tanh u = 1 − 2 ÷ (e²ᵘ + 1)
            let one = TaylorModel::constant(Interval::point(1.0), self.limits());
            let power = self.scaled(Interval::point(2.0)).function(Function::Exponential)?;
            let quotient = power.plus(&one).function(Function::Reciprocal)?;
            return Some(one.minus(&quotient.scaled(Interval::point(2.0))));
        }
        self.composed(|order, at| function.coefficient(order, at))
    }
}

impl Function {
    /// The derivative of this order, divided by the factorial of the order.
    fn coefficient(self, order: usize, at: Interval) -> Option<Interval> {
        let sign = |is_negative: bool| Interval::point(if is_negative { -1.0 } else { 1.0 });
        let factorial = (1..=order)
            .fold(Interval::point(1.0), |product, factor| product * Interval::point(factor as f64));
        Some(match self {
            Function::Reciprocal => {
                let inverse = at.function(Function::Reciprocal)?;
                let power = (0..=order).fold(Interval::point(1.0), |power, _| power * inverse);
                power * sign(order % 2 == 1)
            }
            Function::Exponential => at.exp() / factorial,
            Function::Sine => {
                let value = if order.is_multiple_of(2) { at.sin() } else { at.cos() };
                value * sign(order % 4 >= 2) / factorial
            }
            Function::Cosine => {
                let value = if order.is_multiple_of(2) { at.cos() } else { at.sin() };
                value * sign(matches!(order % 4, 1 | 2)) / factorial
            }
            Function::Logarithm if order == 0 => at.function(Function::Logarithm)?,
            Function::Logarithm => {
                let inverse = at.function(Function::Reciprocal)?;
                let power = (0..order).fold(Interval::point(1.0), |power, _| power * inverse);
                power * sign(order.is_multiple_of(2)) / Interval::point(order as f64)
            }
            Function::Power(exponent) => {
                let falling = (0..order).fold(Interval::point(1.0), |product, place| {
                    product * (Interval::point(exponent) - Interval::point(place as f64))
                });
                let lowered = exponent - order as f64;
                let power = if lowered == 0.0 {
                    Interval::point(1.0)
                } else {
                    at.function(Function::Power(lowered))?
                };
                falling * power / factorial
            }
            Function::HyperbolicTangent => return None,
        })
    }
}

/// What computes a series from earlier ones, which are given by number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Constant(f64),
    Variable(usize),
    Sum(usize, usize),
    Difference(usize, usize),
    Product(usize, usize),
    Quotient(usize, usize),
    /// The next series is its cosine.
    Sine(usize),
    /// The series before is its sine.
    Cosine(usize),
    Exponential(usize),
    Logarithm(usize),
    Power(usize, f64),
    /// The next series is 1 less its square.
    HyperbolicTangent(usize),
    /// Of the series before.
    OneLessSquare,
}

/// Formulas compiled for series.
#[derive(Clone, Debug)]
pub(super) struct SeriesProgram {
    operations: Vec<Operation>,
    /// The series of each rate.
    results: Vec<usize>,
}

/// A formula has a kink or a jump, so that solutions have no Taylor series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NotSmooth(pub String);

impl SeriesProgram {
    /// The rates of all variables, over these variables.
    pub fn compile(rates: &[Expression], variables: &[String]) -> Result<Self, NotSmooth> {
        let mut writer = Writer { variables, operations: Vec::new(), known: BTreeMap::new() };
        let results = rates.iter().map(|rate| writer.series(rate)).collect::<Result<_, _>>()?;
        Ok(SeriesProgram { operations: writer.operations, results })
    }

    /// The coefficients x₀, …, xₙ of each variable, for n = `order`; `None` where a formula has no
    /// value.
    pub fn solve<C: Coefficient>(
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
        weight: impl Fn(usize) -> f64,
    ) -> C {
        let mut sum = C::number(Interval::point(0.0), self.context);
        for place in orders {
            let product = self.at(left, place).times(self.at(right, order - place));
            let weight = weight(place);
            sum = if weight == 1.0 {
                sum.plus(&product)
            } else {
                sum.plus(&product.scaled(Interval::point(weight)))
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
        let count = |place: usize| place as f64;
        Some(match self.operations[number] {
            Operation::Constant(value) => {
                let value = if order == 0 { value } else { 0.0 };
                C::number(Interval::point(value), self.context)
            }
            Operation::Variable(place) => solution[place][order].clone(),
            Operation::Sum(left, right) => self.at(left, order).plus(self.at(right, order)),
            Operation::Difference(left, right) => self.at(left, order).minus(self.at(right, order)),
            Operation::Product(left, right) => {
                self.convolution((left, right), order, 0..=order, |_| 1.0)
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
                self.convolution((inner, number + 1), order, 1..=order, count).scaled(share())
            }
            Operation::Cosine(inner) if order == 0 => {
                self.at(inner, 0).function(Function::Cosine)?
            }
            Operation::Cosine(inner) => {
                self.convolution((inner, number - 1), order, 1..=order, count).scaled(-share())
            }
            Operation::Exponential(inner) if order == 0 => {
                self.at(inner, 0).function(Function::Exponential)?
            }
            Operation::Exponential(inner) => {
                self.convolution((inner, number), order, 1..=order, count).scaled(share())
            }
            Operation::Logarithm(inner) if order == 0 => {
                self.at(inner, 0).function(Function::Logarithm)?
            }
            Operation::Logarithm(inner) => {
                let sum = self.convolution((number, inner), order, 1..=order - 1, count);
                let rest = self.at(inner, order).minus(&sum.scaled(share()));
                rest.times(&self.inverse(number, inner)?)
            }
            Operation::Power(inner, exponent) if order == 0 => {
                self.at(inner, 0).function(Function::Power(exponent))?
            }
            Operation::Power(inner, exponent) => {
                let weight = |place: usize| exponent * place as f64 - (order - place) as f64;
                let sum = self.convolution((inner, number), order, 1..=order, weight);
                sum.times(&self.inverse(number, inner)?).scaled(share())
            }
            Operation::HyperbolicTangent(inner) if order == 0 => {
                self.at(inner, 0).function(Function::HyperbolicTangent)?
            }
            Operation::HyperbolicTangent(inner) => {
                self.convolution((inner, number + 1), order, 1..=order, count).scaled(share())
            }
            Operation::OneLessSquare => {
                let one =
                    C::number(Interval::point(if order == 0 { 1.0 } else { 0.0 }), self.context);
                one.minus(&self.convolution((number - 1, number - 1), order, 0..=order, |_| 1.0))
            }
        })
    }
}

/// Writes operations, equal ones once.
struct Writer<'a> {
    variables: &'a [String],
    operations: Vec<Operation>,
    known: BTreeMap<String, usize>,
}

impl Writer<'_> {
    /// The number of the series of a formula.
    fn series(&mut self, formula: &Expression) -> Result<usize, NotSmooth> {
        let refuse = || Err(NotSmooth(formula.to_string()));
        if let Some(value) = constant_value(formula) {
            return Ok(self.add(Operation::Constant(value)));
        }
        Ok(match formula {
            Expression::Constant(value) => self.add(Operation::Constant(*value)),
            Expression::Variable(name) => {
                let place = self.variables.iter().position(|known| **known == **name);
                match place {
                    Some(place) => self.add(Operation::Variable(place)),
                    None => return refuse(),
                }
            }
            Expression::Unary(operator, inner) => {
                let inner = self.series(inner)?;
                match operator {
                    UnaryOperator::Negation => {
                        let zero = self.add(Operation::Constant(0.0));
                        self.add(Operation::Difference(zero, inner))
                    }
                    UnaryOperator::Sine => self.add_pair(Operation::Sine(inner)),
                    UnaryOperator::Cosine => self.add_pair(Operation::Sine(inner)) + 1,
                    UnaryOperator::Tangent => {
                        let sine = self.add_pair(Operation::Sine(inner));
                        self.add(Operation::Quotient(sine, sine + 1))
                    }
                    UnaryOperator::HyperbolicTangent => {
                        self.add_pair(Operation::HyperbolicTangent(inner))
                    }
                    UnaryOperator::Exponential => self.add(Operation::Exponential(inner)),
                    UnaryOperator::Logarithm => self.add(Operation::Logarithm(inner)),
                    _ => return refuse(),
                }
            }
            Expression::Binary(operator, left, right) => {
                let (left, right) = (self.series(left)?, self.series(right)?);
                match operator {
                    BinaryOperator::Sum => self.add(Operation::Sum(left, right)),
                    BinaryOperator::Difference => self.add(Operation::Difference(left, right)),
                    BinaryOperator::Product => self.add(Operation::Product(left, right)),
                    BinaryOperator::Quotient => self.add(Operation::Quotient(left, right)),
                    _ => return refuse(),
                }
            }
            Expression::Power(base, exponent) => {
                let inner = self.series(base)?;
                self.power(inner, *exponent)
            }
            _ => return refuse(),
        })
    }

    /// Whole powers by multiplication, which needs no sign of the base.
    fn power(&mut self, base: usize, exponent: f64) -> usize {
        const LARGEST: f64 = 64.0;
        if exponent.fract() != 0.0 || exponent.abs() > LARGEST {
            return self.add(Operation::Power(base, exponent));
        }
        let mut power = None;
        let (mut square, mut left) = (base, exponent.abs() as u32);
        while left > 0 {
            if left % 2 == 1 {
                power = Some(match power {
                    Some(power) => self.add(Operation::Product(power, square)),
                    None => square,
                });
            }
            left /= 2;
            if left > 0 {
                square = self.add(Operation::Product(square, square));
            }
        }
        let one = self.add(Operation::Constant(1.0));
        match power {
            None => one,
            Some(power) if exponent < 0.0 => self.add(Operation::Quotient(one, power)),
            Some(power) => power,
        }
    }

    fn add(&mut self, operation: Operation) -> usize {
        let key = format!("{operation:?}");
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        self.operations.push(operation);
        self.known.insert(key, self.operations.len() - 1);
        self.operations.len() - 1
    }

    /// An operation and its companion, which follows it.
    fn add_pair(&mut self, operation: Operation) -> usize {
        let (before, number) = (self.operations.len(), self.add(operation));
        if number == before {
            self.operations.push(match operation {
                Operation::Sine(inner) => Operation::Cosine(inner),
                _ => Operation::OneLessSquare,
            });
        }
        number
    }
}

/// The value of a formula without variables, if rounding does not matter.
fn constant_value(formula: &Expression) -> Option<f64> {
    match formula {
        Expression::Constant(value) => Some(*value),
        _ => None,
    }
}
