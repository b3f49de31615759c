//! Expressions and predicates compiled against a list of variables, for hot loops.
//!
//! [`Expression::evaluate`](crate::Expression::evaluate) asks its state for every variable by name.
//! A loop that evaluates the same guard millions of times compiles it once against the list of names
//! that says which place of a slice holds which variable, and from then on only reads that slice:
//!
//! ```
//! use pleach_guards::variable;
//!
//! let low = variable("height").at_most(2.0 * variable("radius"));
//! let compiled = low.compile(&["height", "velocity", "radius"])?;
//!
//! let verdict = compiled.evaluate(&[0.5, -3.0, 0.125])?;
//! assert_eq!((verdict.margin, verdict.holds), (-0.25, false));
//!
//! // Two balls in one state vector share the program; each says where its variables lie.
//! let state = [0.125, 0.5, 0.5, -1.0, -3.0];
//! assert!(!compiled.evaluate_at(&state, &[1, 3, 0])?.holds);
//! assert!(!compiled.evaluate_at(&state, &[2, 4, 0])?.holds);
//! # Ok::<(), pleach_guards::EvaluationError>(())
//! ```
//!
//! The compiled form does the same operations in the same order, so that its results are those of
//! the expression bit for bit. Operations on constants alone are done while compiling.

mod compiler;

use std::fmt;
use std::sync::Arc;

use crate::expression::{BinaryOperator, Choice, UnaryOperator};
use crate::function::NamedFunction;
use crate::operator::raise;
use crate::predicate::{Comparison, Predicate, Relation, Verdict};
use crate::table::Table;
use crate::valuation::{EvaluationError, Valuation};

/// How many intermediate values fit on the stack of the thread, in numbers. Expressions written by
/// hand rarely need more than five; what is deeper allocates its stack.
const SHALLOW: usize = 16;

/// An expression compiled by [`Expression::compile`](crate::Expression::compile).
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    start: Operand,
    instructions: Box<[Instruction]>,
    tables: Box<[Table]>,
    depth: usize,
}

/// A predicate compiled by [`Predicate::compile`].
#[derive(Clone, Debug, PartialEq)]
pub struct CompiledPredicate {
    test: Test,
    source: Predicate,
    names: Arc<[Arc<str>]>,
}

/// A step of a program, which works on one current value and a stack of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Instruction {
    /// Puts the current value on the stack and makes the operand current.
    Load(Operand),
    /// Replaces the current value.
    Unary(UnaryOperator),
    /// Combines the current value, on the left, with an operand.
    WithRight(BinaryOperator, Operand),
    /// Combines an operand, on the left, with the current value.
    WithLeft(BinaryOperator, Operand),
    /// Combines what it takes from the stack, on the left, with the current value.
    Binary(BinaryOperator),
    /// Raises the current value to a fixed exponent.
    Power(f64),
    /// Looks the current value up in the table with this number.
    Lookup(usize),
    /// Makes the current value, or what was put on the stack before it, the current one: what came
    /// before these two compares like this, or does not.
    Select(Relation),
}

/// What an instruction can use without a step of its own; sums of these are the affine
/// expressions.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Operand {
    Constant(f64),
    Variable(usize),
    Scaled(f64, usize),
}

#[derive(Clone, Debug, PartialEq)]
enum Test {
    Comparison { left: Program, relation: Relation, right: Program },
    Not(Box<Test>),
    All(Box<[Test]>),
    Any(Box<[Test]>),
    Function(NamedFunction),
}

impl Program {
    /// The value on a slice ordered as the variables were when compiling: what
    /// [`Expression::evaluate`](crate::Expression::evaluate) gives, and NaN where that is an error or
    /// `values` is too short.
    pub fn evaluate(&self, values: &[f64]) -> f64 {
        self.run(|variable| values.get(variable).copied())
    }

    /// As [`evaluate`](Self::evaluate), where variable *i* is `values[slots[i]]`.
    pub fn evaluate_at(&self, values: &[f64], slots: &[usize]) -> f64 {
        self.run(|variable| values.get(*slots.get(variable)?).copied())
    }

    #[inline]
    fn run(&self, value: impl Fn(usize) -> Option<f64>) -> f64 {
        match self.depth {
            0 => self.run_on(&mut [], value),
            1..=SHALLOW => self.run_on(&mut [0.0; SHALLOW], value),
            depth => self.run_on(&mut vec![0.0; depth], value),
        }
    }

    #[inline]
    fn run_on(&self, stack: &mut [f64], value: impl Fn(usize) -> Option<f64>) -> f64 {
        let value = |variable| value(variable).unwrap_or(f64::NAN);
        let read = |operand| match operand {
            Operand::Constant(constant) => constant,
            Operand::Variable(variable) => value(variable),
            Operand::Scaled(factor, variable) => factor * value(variable),
        };
        let mut current = read(self.start);
        let mut height = 0;
        for instruction in &self.instructions {
            current = match *instruction {
                Instruction::Load(operand) => {
                    stack[height] = current;
                    height += 1;
                    read(operand)
                }
                Instruction::Unary(operator) => operator.apply(current),
                Instruction::WithRight(operator, operand) => operator.apply(current, read(operand)),
                Instruction::WithLeft(operator, operand) => operator.apply(read(operand), current),
                Instruction::Binary(operator) => {
                    height -= 1;
                    operator.apply(stack[height], current)
                }
                Instruction::Power(exponent) => raise(current, exponent),
                Instruction::Lookup(table) => self.tables[table].value(current),
                Instruction::Select(relation) => {
                    height -= 3;
                    let sides = (stack[height], stack[height + 1]);
                    Choice::select(relation, sides, (stack[height + 2], current))
                }
            };
        }
        current
    }
}

impl Predicate {
    /// The predicate as a program on slices in which place *i* holds the value of `variables[i]`;
    /// of a name that is listed twice, the first place counts. A named function in it is called as
    /// it is, with the slice under the listed names as its state.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownVariable`] if a variable of the predicate is not listed, and
    /// [`EvaluationError::UnknownProposition`] if there is a proposition: a slice holds numbers.
    pub fn compile(
        &self,
        variables: &[impl AsRef<str>],
    ) -> Result<CompiledPredicate, EvaluationError> {
        let test = Test::of(self, variables)?;
        let names = variables.iter().map(|name| name.as_ref().into()).collect();
        Ok(CompiledPredicate { test, source: self.clone(), names })
    }
}

impl CompiledPredicate {
    /// Verdict and margin on a slice ordered as the variables were when compiling.
    ///
    /// # Errors
    ///
    /// Those of [`Predicate::evaluate`]; a variable for which `values` is too short is unknown.
    pub fn evaluate(&self, values: &[f64]) -> Result<Verdict, EvaluationError> {
        self.judge(|variable| values.get(variable).copied())
    }

    /// As [`evaluate`](Self::evaluate), where variable *i* is `values[slots[i]]`.
    ///
    /// # Errors
    ///
    /// As for [`evaluate`](Self::evaluate); a variable without a slot is unknown, too.
    pub fn evaluate_at(&self, values: &[f64], slots: &[usize]) -> Result<Verdict, EvaluationError> {
        self.judge(|variable| values.get(*slots.get(variable)?).copied())
    }

    /// The predicate that was compiled.
    pub fn predicate(&self) -> &Predicate {
        &self.source
    }

    /// The variables in the order of the slices.
    pub fn variables(&self) -> impl ExactSizeIterator<Item = &str> {
        self.names.iter().map(|name| &**name)
    }

    /// Where the program finds what is not a number, the predicate itself says what it was.
    #[inline]
    fn judge(
        &self,
        value: impl Fn(usize) -> Option<f64> + Copy,
    ) -> Result<Verdict, EvaluationError> {
        let state = Listed { names: &self.names, value };
        match self.test.judge(&state) {
            Some(verdict) => Ok(verdict),
            None => self.source.evaluate(&state),
        }
    }
}

impl fmt::Display for CompiledPredicate {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.source.fmt(formatter)
    }
}

/// Values by place, under the names of the places.
struct Listed<'a, F> {
    names: &'a [Arc<str>],
    value: F,
}

impl<F: Fn(usize) -> Option<f64>> Valuation for Listed<'_, F> {
    fn value(&self, variable: &str) -> Option<f64> {
        let place = self.names.iter().position(|name| **name == *variable)?;
        (self.value)(place)
    }
}

impl Test {
    fn of(predicate: &Predicate, names: &[impl AsRef<str>]) -> Result<Test, EvaluationError> {
        let all = |parts: &[Predicate]| -> Result<Box<[Test]>, EvaluationError> {
            parts.iter().map(|part| Test::of(part, names)).collect()
        };
        Ok(match predicate {
            Predicate::Comparison(Comparison { left, relation, right }) => Test::Comparison {
                left: left.compile(names)?,
                relation: *relation,
                right: right.compile(names)?,
            },
            Predicate::Not(inner) => Test::Not(Box::new(Test::of(inner, names)?)),
            Predicate::All(parts) => Test::All(all(parts)?),
            Predicate::Any(parts) => Test::Any(all(parts)?),
            Predicate::Proposition(name) => {
                return Err(EvaluationError::UnknownProposition { proposition: name.to_string() });
            }
            Predicate::Function(function) => Test::Function(function.clone()),
        })
    }

    /// The verdict, or `None` where a part is not a number or a function has an error.
    fn judge<F: Fn(usize) -> Option<f64> + Copy>(&self, state: &Listed<'_, F>) -> Option<Verdict> {
        match self {
            Test::Comparison { left, relation, right } => {
                let (left, right) = (left.run(state.value), right.run(state.value));
                (!left.is_nan() && !right.is_nan()).then(|| relation.judge(left, right))
            }
            Test::Not(inner) => inner.judge(state).map(Verdict::opposite),
            Test::All(parts) => parts
                .iter()
                .try_fold(Verdict::ALWAYS, |verdict, part| Some(verdict.and(part.judge(state)?))),
            Test::Any(parts) => parts
                .iter()
                .try_fold(Verdict::NEVER, |verdict, part| Some(verdict.or(part.judge(state)?))),
            Test::Function(function) => {
                let margin = function.margin(state).ok()?;
                Some(Verdict { margin, holds: margin >= 0.0 })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::{Expression, constant, variable};

    const NAMES: [&str; 3] = ["x", "y", "z"];

    #[test]
    fn affine_expressions_take_one_step_for_each_further_term() {
        let [x, y, z] = NAMES.map(variable);
        let sum = 2.0 * &x + &y * (1.0 - 3.0 * constant(2.0)) - &z + 1.0;
        let program = sum.compile(&NAMES).expect("these are the names");
        assert_eq!((program.instructions.len(), program.depth), (3, 0));
        assert_eq!(program.evaluate(&[4.0, 0.5, 3.0]), 8.0 - 2.5 - 3.0 + 1.0);
    }

    /// What is taken from the stack leaves room: the terms of a long sum use the same two places.
    #[test]
    fn a_stack_is_as_deep_as_its_expression() {
        let [x, y, z] = NAMES.map(variable);
        let term = || (&x - &y) * (&y + &z);
        let sum: Expression = (0..100).map(|_| term()).sum();
        let program = sum.compile(&NAMES).expect("these are the names");
        assert_eq!(program.depth, 2);
        assert_eq!(program.evaluate(&[3.0, 1.0, 2.0]), 600.0);
    }

    /// The predicate itself is asked for no more than which part has no value.
    #[test]
    fn what_has_values_is_judged_without_the_predicate() {
        let [x, y, z] = NAMES.map(variable);
        let order = x.ln().at_most(&y) & !y.less_than(z.ln());
        let guard = order.compile(&NAMES).expect("these are the names");
        let judge = |values: [f64; 3]| {
            let value = |place: usize| values.get(place).copied();
            guard.test.judge(&Listed { names: &guard.names, value })
        };
        let verdict = |margin, holds| Some(Verdict { margin, holds });
        assert_eq!(judge([1.0, 2.5, 1.0]), verdict(2.5, true));
        assert_eq!(judge([1.0, -2.5, 0.0]), verdict(-2.5, false));
        assert_eq!([judge([-1.0, 2.5, 1.0]), judge([1.0, 2.5, -1.0])], [None, None]);
    }
}
