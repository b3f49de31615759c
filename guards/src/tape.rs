//! Many expressions compiled together, for the right-hand sides of differential equations.
//!
//! A [`Tape`] computes a list of expressions in one pass over numbered places. Parts that occur
//! more than once, also in different expressions, are computed once, and a product that is added to
//! something is one instruction. The operations and their order are those of the expressions, so
//! that the results agree with [`Expression::evaluate`] bit for bit.
//!
//! ```
//! use pleach_guards::{Tape, variable};
//!
//! let (x, y) = (variable("x"), variable("y"));
//! let distance = (x.power(2.0) + y.power(2.0)).square_root();
//! let tape = Tape::compile([&(&x / &distance), &(&y / &distance)], &["x", "y"])?;
//!
//! let mut places = tape.places();
//! let mut results = [0.0; 2];
//! tape.evaluate(&[3.0, 4.0], &mut places, &mut results);
//! assert_eq!(results, [0.6, 0.8]);
//! # Ok::<(), pleach_guards::EvaluationError>(())
//! ```

use std::collections::BTreeMap;

use crate::expression::{Choice, Expression};
use crate::fold::Operands;
use crate::operator::{BinaryOperator, UnaryOperator, raise};
use crate::predicate::Relation;
use crate::table::Table;
use crate::valuation::EvaluationError;

/// Expressions compiled together by [`Tape::compile`].
#[derive(Clone, Debug, PartialEq)]
pub struct Tape {
    /// How many of the first places hold variables.
    variables: usize,
    /// What the places after the variables hold.
    constants: Vec<f64>,
    /// Each writes the next place after the constants.
    instructions: Vec<Instruction>,
    tables: Vec<Table>,
    /// The places of the results.
    results: Vec<u32>,
}

/// An operation on what earlier places hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Instruction {
    Sum(u32, u32),
    Difference(u32, u32),
    Product(u32, u32),
    Quotient(u32, u32),
    /// a · b + c, rounded twice.
    ProductSum(u32, u32, u32),
    /// a · b − c, rounded twice.
    ProductLess(u32, u32, u32),
    /// c − a · b, rounded twice.
    LessProduct(u32, u32, u32),
    Unary(UnaryOperator, u32),
    Binary(BinaryOperator, u32, u32),
    /// A power, whose exponent has a place, too.
    Power(u32, u32),
    Lookup(u32, u32),
    /// Left and right of the condition, then what it chooses from.
    Choice(Relation, [u32; 4]),
}

impl Tape {
    /// The tape of these expressions, on slices in which place *i* holds the value of
    /// `variables[i]`; of a name that is listed twice, the first place counts.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownVariable`] if a variable of an expression is not listed.
    pub fn compile<'e>(
        expressions: impl IntoIterator<Item = &'e Expression>,
        variables: &[impl AsRef<str>],
    ) -> Result<Tape, EvaluationError> {
        let mut names = BTreeMap::new();
        for (place, name) in (0..).zip(variables) {
            names.entry(name.as_ref()).or_insert(place);
        }
        let mut writer = Writer { names, ..Writer::default() };
        let results = expressions
            .into_iter()
            .map(|expression| expression.fold(&mut |part, operands| writer.part(part, operands)));
        let results = results.collect::<Result<Vec<Value>, _>>()?;
        Ok(writer.tape(variables.len(), &results))
    }

    /// Room for [`evaluate`](Self::evaluate), to be used again and again.
    pub fn places(&self) -> Vec<f64> {
        let mut places = vec![0.0; self.variables];
        places.extend(&self.constants);
        places.resize(places.len() + self.instructions.len(), 0.0);
        places
    }

    /// Writes the values of the expressions to `results`, in their order: what
    /// [`Expression::evaluate`] gives, and NaN where that is an error.
    ///
    /// `values` are those of the variables, `places` what [`places`](Self::places) made. Where a
    /// slice is too short, what is missing is NaN or left out.
    #[inline]
    pub fn evaluate(&self, values: &[f64], places: &mut [f64], results: &mut [f64]) {
        let given = self.variables.min(values.len());
        places[..given].copy_from_slice(&values[..given]);
        places[given..self.variables].fill(f64::NAN);
        let first = self.variables + self.constants.len();
        for (place, instruction) in (first..).zip(&self.instructions) {
            places[place] = instruction.apply(places, &self.tables);
        }
        for (result, &place) in results.iter_mut().zip(&self.results) {
            *result = places[place as usize];
        }
    }
}

impl Instruction {
    #[inline]
    fn apply(self, places: &[f64], tables: &[Table]) -> f64 {
        let at = |place: u32| places[place as usize];
        match self {
            Instruction::Sum(a, b) => at(a) + at(b),
            Instruction::Difference(a, b) => at(a) - at(b),
            Instruction::Product(a, b) => at(a) * at(b),
            Instruction::Quotient(a, b) => at(a) / at(b),
            Instruction::ProductSum(a, b, c) => at(a) * at(b) + at(c),
            Instruction::ProductLess(a, b, c) => at(a) * at(b) - at(c),
            Instruction::LessProduct(a, b, c) => at(c) - at(a) * at(b),
            Instruction::Unary(operator, a) => operator.apply(at(a)),
            Instruction::Binary(operator, a, b) => operator.apply(at(a), at(b)),
            Instruction::Power(a, exponent) => raise(at(a), at(exponent)),
            Instruction::Lookup(table, a) => tables[table as usize].value(at(a)),
            Instruction::Choice(relation, [a, b, then, otherwise]) => {
                Choice::select(relation, (at(a), at(b)), (at(then), at(otherwise)))
            }
        }
    }
}

/// What is known of a part while a tape is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Value {
    Variable(u32),
    /// The index among the constants.
    Constant(u32),
    /// The index of the instruction that computes it.
    Computed(u32),
}

/// An operation on values; two that are equal compute the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Operation {
    Unary(UnaryOperator, Value),
    Binary(BinaryOperator, Value, Value),
    Power(Value, Value),
    Lookup(u32, Value),
    Choice(Relation, [Value; 4]),
}

/// A tape in the making.
#[derive(Default)]
struct Writer<'a> {
    names: BTreeMap<&'a str, u32>,
    constants: Vec<f64>,
    /// The constants by their bits.
    known_constants: BTreeMap<u64, u32>,
    operations: Vec<Operation>,
    known_operations: BTreeMap<Operation, u32>,
    tables: Vec<Table>,
}

impl Writer<'_> {
    /// The value of a part, given those of its operands. Operations on constants are done.
    fn part(
        &mut self,
        part: &Expression,
        operands: Operands<Value>,
    ) -> Result<Value, EvaluationError> {
        if let Some(value) = self.folded(part, &operands) {
            return Ok(self.constant(value));
        }
        let operation = match (part, operands) {
            (Expression::Variable(name), _) => {
                let unknown = || EvaluationError::UnknownVariable { variable: name.to_string() };
                return self.names.get(&**name).copied().map(Value::Variable).ok_or_else(unknown);
            }
            (Expression::Unary(operator, _), Operands::One(operand)) => {
                Operation::Unary(*operator, operand)
            }
            (Expression::Power(_, exponent), Operands::One(base)) => {
                Operation::Power(base, self.constant(*exponent))
            }
            (Expression::Lookup(table, _), Operands::One(place)) => {
                let known = self.tables.iter().position(|other| other == table);
                let number = known.unwrap_or_else(|| {
                    self.tables.push(table.clone());
                    self.tables.len() - 1
                });
                Operation::Lookup(number as u32, place)
            }
            (Expression::Binary(operator, ..), Operands::Two(left, right)) => {
                Operation::Binary(*operator, left, right)
            }
            (Expression::Choice(choice), Operands::Four(parts)) => {
                Operation::Choice(choice.condition.relation, parts)
            }
            // No part has other operands than its own.
            _ => return Ok(self.constant(f64::NAN)),
        };
        let next = self.operations.len() as u32;
        let number = *self.known_operations.entry(operation).or_insert(next);
        if number == next {
            self.operations.push(operation);
        }
        Ok(Value::Computed(number))
    }

    fn folded(&self, part: &Expression, operands: &Operands<Value>) -> Option<f64> {
        let constant = |value: &Value| match value {
            Value::Constant(index) => Some(self.constants[*index as usize]),
            Value::Variable(_) | Value::Computed(_) => None,
        };
        let all = operands.listed().into_iter().flatten().all(|value| constant(value).is_some());
        let values = all.then(|| operands.map_ref(|value| constant(value).unwrap_or(f64::NAN)))?;
        part.computed(values)
    }

    fn constant(&mut self, value: f64) -> Value {
        let next = self.constants.len() as u32;
        let index = *self.known_constants.entry(value.to_bits()).or_insert(next);
        if index == next {
            self.constants.push(value);
        }
        Value::Constant(index)
    }

    /// The tape of all that was written, with these results.
    fn tape(self, variables: usize, results: &[Value]) -> Tape {
        let merged = self.merged_products(results);
        let mut places = Places { variables, constants: self.constants.len(), of: Vec::new() };
        let mut instructions = Vec::new();
        for (number, operation) in self.operations.iter().enumerate() {
            places.of.push(instructions.len() as u32);
            if !merged[number] {
                instructions.push(self.instruction(*operation, &merged, &places));
            }
        }
        let results = results.iter().map(|result| places.place(*result)).collect();
        let Writer { constants, tables, .. } = self;
        Tape { variables, constants, instructions, tables, results }
    }

    /// Which products are used once, and there as a term: they need no place.
    fn merged_products(&self, results: &[Value]) -> Vec<bool> {
        let mut uses = vec![0_u32; self.operations.len()];
        let mut is_merged = vec![false; self.operations.len()];
        let mut count = |value: Value| {
            if let Value::Computed(number) = value {
                uses[number as usize] += 1;
            }
        };
        results.iter().copied().for_each(&mut count);
        for operation in &self.operations {
            operation.values().for_each(&mut count);
        }
        let product = |value: Value| {
            let Value::Computed(number) = value else { return None };
            let number = number as usize;
            let is_product = self.operations[number].is(BinaryOperator::Product);
            (is_product && uses[number] == 1).then_some(number)
        };
        for operation in &self.operations {
            let is_sum = operation.is(BinaryOperator::Sum);
            if let Operation::Binary(_, a, b) = *operation
                && (is_sum || operation.is(BinaryOperator::Difference))
                // One term of a sum only: the other needs a place.
                && let Some(term) = product(b).or_else(|| product(a))
            {
                is_merged[term] = true;
            }
        }
        is_merged
    }

    fn instruction(&self, operation: Operation, merged: &[bool], places: &Places) -> Instruction {
        let at = |value| places.place(value);
        let product = |value| match value {
            Value::Computed(number) if merged[number as usize] => {
                match self.operations[number as usize] {
                    Operation::Binary(_, a, b) => Some((at(a), at(b))),
                    _ => None,
                }
            }
            _ => None,
        };
        match operation {
            Operation::Binary(BinaryOperator::Sum, a, b) => match (product(a), product(b)) {
                (_, Some((left, right))) => Instruction::ProductSum(left, right, at(a)),
                (Some((left, right)), None) => Instruction::ProductSum(left, right, at(b)),
                (None, None) => Instruction::Sum(at(a), at(b)),
            },
            Operation::Binary(BinaryOperator::Difference, a, b) => match (product(a), product(b)) {
                (_, Some((left, right))) => Instruction::LessProduct(left, right, at(a)),
                (Some((left, right)), None) => Instruction::ProductLess(left, right, at(b)),
                (None, None) => Instruction::Difference(at(a), at(b)),
            },
            Operation::Binary(BinaryOperator::Product, a, b) => Instruction::Product(at(a), at(b)),
            Operation::Binary(BinaryOperator::Quotient, a, b) => {
                Instruction::Quotient(at(a), at(b))
            }
            Operation::Binary(operator, a, b) => Instruction::Binary(operator, at(a), at(b)),
            Operation::Unary(operator, a) => Instruction::Unary(operator, at(a)),
            Operation::Power(a, exponent) => {
                let Value::Constant(index) = exponent else {
                    return Instruction::Power(at(a), at(exponent));
                };
                if self.constants[index as usize] == 2.0 {
                    return Instruction::Product(at(a), at(a));
                }
                Instruction::Power(at(a), at(exponent))
            }
            Operation::Lookup(table, a) => Instruction::Lookup(table, at(a)),
            Operation::Choice(relation, parts) => Instruction::Choice(relation, parts.map(at)),
        }
    }
}

impl Operation {
    fn is(&self, operator: BinaryOperator) -> bool {
        matches!(self, Operation::Binary(found, ..) if *found == operator)
    }

    fn values(&self) -> impl Iterator<Item = Value> {
        let (few, four) = match *self {
            Operation::Unary(_, a) | Operation::Lookup(_, a) => ([Some(a), None], [None; 4]),
            Operation::Binary(_, a, b) | Operation::Power(a, b) => ([Some(a), Some(b)], [None; 4]),
            Operation::Choice(_, parts) => ([None, None], parts.map(Some)),
        };
        few.into_iter().chain(four).flatten()
    }
}

/// Where values lie: variables first, then constants, then what is computed.
struct Places {
    variables: usize,
    constants: usize,
    /// By operation: its instruction.
    of: Vec<u32>,
}

impl Places {
    fn place(&self, value: Value) -> u32 {
        match value {
            Value::Variable(index) => index,
            Value::Constant(index) => self.variables as u32 + index,
            Value::Computed(number) => {
                (self.variables + self.constants) as u32 + self.of[number as usize]
            }
        }
    }
}
