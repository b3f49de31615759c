//! Formulas compiled for series.

use std::collections::BTreeMap;

use pleach_guards::{BinaryOperator, Expression, UnaryOperator};

/// What computes a series from earlier ones, which are given by number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Operation {
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
pub(in crate::reach) struct SeriesProgram {
    pub(super) operations: Vec<Operation>,
    /// The series of each rate.
    pub(super) results: Vec<usize>,
}

/// A formula has a kink or a jump, so that solutions have no Taylor series.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::reach) struct NotSmooth(pub String);

impl SeriesProgram {
    /// The rates of all variables, over these variables.
    pub(crate) fn compile(rates: &[Expression], variables: &[String]) -> Result<Self, NotSmooth> {
        let mut writer = Writer { variables, operations: Vec::new(), known: BTreeMap::new() };
        let results = rates.iter().map(|rate| writer.series(rate)).collect::<Result<_, _>>()?;
        Ok(SeriesProgram { operations: writer.operations, results })
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
