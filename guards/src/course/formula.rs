//! The enclosure of an expression, operation by operation.

use crate::enclosure::{Definedness, Enclosure};
use crate::expression::{BinaryOperator, Expression, UnaryOperator};
use crate::fold::Operands;
use crate::predicate::Relation;
use crate::range::Truth;
use crate::ring::Ring;
use crate::table::Table;
use crate::valuation::EvaluationError;

/// An expression as a list of operations, each on results of earlier ones; the last is the value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Formula(Box<[Operation]>);

#[derive(Clone, Debug, PartialEq)]
enum Operation {
    Constant(f64),
    Variable(usize),
    Unary(UnaryOperator, usize),
    Binary(BinaryOperator, usize, usize),
    Power(usize, f64),
    /// With the table of the slopes.
    Lookup(Table, Table, usize),
    /// Both sides of the condition, then what is chosen from.
    Choice(Relation, [usize; 4]),
}

/// What operations are computed in.
pub(super) struct Context<'a> {
    pub(super) states: &'a [Enclosure],
    pub(super) slots: &'a [usize],
    pub(super) half_width: f64,
    pub(super) slack: f64,
}

/// The highest power that counts as repeated multiplication.
const HIGHEST_POWER: f64 = 16.0;

/// Results that fit on the stack of the thread; longer expressions allocate.
const SHORT: usize = 16;

/// What is known about a part, and whether it has a value.
pub(super) type Known = (Enclosure, Definedness);

const UNKNOWN: Known = (Enclosure::UNKNOWN, Definedness::Everywhere);

impl Formula {
    pub(super) fn of(
        expression: &Expression,
        variables: &[impl AsRef<str>],
    ) -> Result<Formula, EvaluationError> {
        let mut operations: Vec<Operation> = Vec::new();
        expression.fold(&mut |part, operands| {
            operations.push(Operation::of(part, operands, variables)?);
            Ok(operations.len() - 1)
        })?;
        Ok(Formula(operations.into()))
    }

    pub(super) fn run(&self, context: &Context<'_>) -> Known {
        if self.0.len() <= SHORT {
            self.run_on(context, &mut [UNKNOWN; SHORT])
        } else {
            self.run_on(context, &mut vec![UNKNOWN; self.0.len()])
        }
    }

    pub(super) fn in_ring<R: Ring>(
        &self,
        variable: &mut impl FnMut(usize) -> Option<R>,
    ) -> Option<R> {
        let mut results: Vec<R> = Vec::with_capacity(self.0.len());
        for operation in &self.0 {
            let result = operation.in_ring(&results, variable)?;
            results.push(result);
        }
        results.pop()
    }

    fn run_on(&self, context: &Context<'_>, results: &mut [Known]) -> Known {
        for (place, operation) in self.0.iter().enumerate() {
            results[place] = operation.run(context, results);
        }
        let last = self.0.len().saturating_sub(1);
        results.get(last).copied().unwrap_or(UNKNOWN)
    }
}

impl Operation {
    fn of(
        part: &Expression,
        operands: Operands<usize>,
        variables: &[impl AsRef<str>],
    ) -> Result<Operation, EvaluationError> {
        Ok(match (part, operands) {
            (Expression::Constant(value), _) => Operation::Constant(*value),
            (Expression::Variable(name), _) => {
                let place = variables.iter().position(|listed| *listed.as_ref() == **name);
                let unknown = || EvaluationError::UnknownVariable { variable: name.to_string() };
                Operation::Variable(place.ok_or_else(unknown)?)
            }
            (Expression::Unary(operator, _), Operands::One(operand)) => {
                Operation::Unary(*operator, operand)
            }
            (Expression::Binary(BinaryOperator::Product, left, right), Operands::Two(one, _))
                if left == right =>
            {
                Operation::Power(one, 2.0)
            }
            (Expression::Binary(operator, ..), Operands::Two(left, right)) => {
                Operation::Binary(*operator, left, right)
            }
            (Expression::Power(_, exponent), Operands::One(base)) => {
                Operation::Power(base, *exponent)
            }
            (Expression::Lookup(table, _), Operands::One(place)) => {
                Operation::Lookup(table.clone(), table.derivative(), place)
            }
            (Expression::Choice(choice), Operands::Four(parts)) => {
                Operation::Choice(choice.condition.relation, parts)
            }
            _ => Operation::Constant(f64::NAN),
        })
    }

    fn in_ring<R: Ring>(
        &self,
        results: &[R],
        variable: &mut impl FnMut(usize) -> Option<R>,
    ) -> Option<R> {
        match *self {
            Operation::Constant(value) => Some(R::number(value)),
            Operation::Variable(place) => variable(place),
            Operation::Unary(UnaryOperator::Negation, one) => results[one].times(&R::number(-1.0)),
            Operation::Power(base, exponent)
                if exponent % 1.0 == 0.0 && (0.0..=HIGHEST_POWER).contains(&exponent) =>
            {
                results[base].power(exponent as u32)
            }
            Operation::Binary(operator, one, other) => match operator {
                BinaryOperator::Sum => results[one].plus(&results[other]),
                BinaryOperator::Difference => results[one].minus(&results[other]),
                BinaryOperator::Product => results[one].times(&results[other]),
                _ => None,
            },
            _ => None,
        }
    }

    fn run(&self, context: &Context<'_>, results: &[Known]) -> Known {
        let defined = |places: &[usize]| {
            let parts = places.iter().map(|&place| results[place].1);
            parts.fold(Definedness::Everywhere, Definedness::and)
        };
        let ((result, own), inner) = match self {
            Operation::Constant(value) => return (Enclosure::constant(*value), defined(&[])),
            Operation::Variable(variable) => {
                let slot = context.slots.get(*variable);
                let state = slot.and_then(|&slot| context.states.get(slot));
                return (state.copied().unwrap_or(Enclosure::UNKNOWN), defined(&[]));
            }
            Operation::Unary(operator, operand) => {
                (operator.enclose(&results[*operand].0), defined(&[*operand]))
            }
            Operation::Binary(operator, left, right) => {
                let result = operator.enclose(&results[*left].0, &results[*right].0);
                (result, defined(&[*left, *right]))
            }
            Operation::Power(base, exponent) => {
                (results[*base].0.raised(*exponent), defined(&[*base]))
            }
            Operation::Lookup(table, slopes, place) => {
                let found = results[*place].0.looked_up(table, slopes);
                ((found, Definedness::Everywhere), defined(&[*place]))
            }
            Operation::Choice(relation, [left, right, then, otherwise]) => {
                let sides = [results[*left].0, results[*right].0];
                let [one, other] = [results[*then], results[*otherwise]];
                let truth = relation.truth(sides[0].range, sides[1].range);
                let chosen = match truth {
                    Truth::Always => one,
                    Truth::Never => other,
                    Truth::Undecided => {
                        let middle = match relation.truth(sides[0].middle, sides[1].middle) {
                            Truth::Always => one.0.middle,
                            Truth::Never => other.0.middle,
                            Truth::Undecided => one.0.middle.hull(other.0.middle),
                        };
                        (one.0.or(&other.0, middle), one.1.and(other.1))
                    }
                };
                (chosen, defined(&[*left, *right]))
            }
        };
        (result.sharpened(context.half_width), own.and(inner))
    }
}
