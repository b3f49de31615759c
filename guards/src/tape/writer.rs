//! Writing a tape: equal parts are found, products merged, and instructions of one action put one
//! after another.

use std::collections::BTreeMap;

use super::{Action, Run, Tape};
use crate::expression::Expression;
use crate::fold::Operands;
use crate::operator::{BinaryOperator, UnaryOperator};
use crate::predicate::Relation;
use crate::table::Table;
use crate::valuation::EvaluationError;

/// What is known of a part while a tape is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Value {
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
pub(super) struct Writer<'a> {
    names: BTreeMap<&'a str, u32>,
    constants: Vec<f64>,
    /// The constants by their bits.
    known_constants: BTreeMap<u64, u32>,
    operations: Vec<Operation>,
    known_operations: BTreeMap<Operation, u32>,
    tables: Vec<Table>,
}

/// An action, and the places of its operands.
type Instruction = (Action, [u32; 4]);

impl<'a> Writer<'a> {
    /// An empty tape on these variables.
    pub(super) fn new(variables: &'a [impl AsRef<str>]) -> Self {
        let mut names = BTreeMap::new();
        for (place, name) in (0..).zip(variables) {
            names.entry(name.as_ref()).or_insert(place);
        }
        Writer { names, ..Writer::default() }
    }

    /// The value of a part, given those of its operands. Operations on constants are done.
    pub(super) fn part(
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
    pub(super) fn tape(self, variables: usize, results: &[Value]) -> Tape {
        let merged = self.merged_products(results);
        let batches = self.scheduled(&merged);
        let mut places = Places {
            variables,
            constants: self.constants.len(),
            of: vec![0; self.operations.len()],
        };
        for (place, &number) in (0..).zip(batches.iter().flatten()) {
            places.of[number] = place;
        }
        let (mut operands, mut runs) = (Vec::new(), Vec::new());
        for batch in &batches {
            let Some(&first) = batch.first() else { continue };
            let action = self.action(first, &merged, &places);
            runs.push(Run { action, length: batch.len() as u32 });
            operands
                .extend(batch.iter().map(|&number| self.instruction(number, &merged, &places).1));
        }
        let results = results.iter().map(|result| places.place(*result)).collect();
        let Writer { constants, tables, .. } = self;
        Tape { variables, constants, operands, runs, tables, results }
    }

    /// All operations but merged products in batches of one action, each after those whose results
    /// it needs: of the operations that can be next, all of the commonest action.
    fn scheduled(&self, merged: &[bool]) -> Vec<Vec<usize>> {
        let mut missing = vec![0; self.operations.len()];
        let mut needed_by = vec![Vec::new(); self.operations.len()];
        // Where places are does not matter for what is done.
        let nowhere = Places { variables: 0, constants: 0, of: vec![0; self.operations.len()] };
        let mut ready: BTreeMap<Action, Vec<usize>> = BTreeMap::new();
        for number in (0..self.operations.len()).filter(|&number| !merged[number]) {
            for needed in self.needs(number, merged) {
                needed_by[needed].push(number);
                missing[number] += 1;
            }
            if missing[number] == 0 {
                ready.entry(self.action(number, merged, &nowhere)).or_default().push(number);
            }
        }
        let mut batches = Vec::new();
        while let Some((&action, _)) = ready.iter().max_by_key(|(_, numbers)| numbers.len()) {
            let batch = ready.remove(&action).unwrap_or_default();
            for &number in &batch {
                for &next in &needed_by[number] {
                    missing[next] -= 1;
                    if missing[next] == 0 {
                        ready.entry(self.action(next, merged, &nowhere)).or_default().push(next);
                    }
                }
            }
            batches.push(batch);
        }
        batches
    }

    /// The operations whose results one needs, through merged products, each as often as it is used.
    fn needs(&self, number: usize, merged: &[bool]) -> Vec<usize> {
        let mut needed = Vec::new();
        for value in self.operations[number].values() {
            match value {
                Value::Computed(operand) if merged[operand as usize] => {
                    needed.extend(self.needs(operand as usize, merged));
                }
                Value::Computed(operand) => needed.push(operand as usize),
                Value::Variable(_) | Value::Constant(_) => {}
            }
        }
        needed
    }

    fn action(&self, number: usize, merged: &[bool], nowhere: &Places) -> Action {
        self.instruction(number, merged, nowhere).0
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

    fn instruction(&self, number: usize, merged: &[bool], places: &Places) -> Instruction {
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
        let (action, places) = match self.operations[number] {
            Operation::Binary(BinaryOperator::Sum, a, b) => match (product(a), product(b)) {
                (_, Some((left, right))) => (Action::ProductSum, [left, right, at(a), 0]),
                (Some((left, right)), None) => (Action::ProductSum, [left, right, at(b), 0]),
                (None, None) => (Action::Sum, [at(a), at(b), 0, 0]),
            },
            Operation::Binary(BinaryOperator::Difference, a, b) => match (product(a), product(b)) {
                (_, Some((left, right))) => (Action::LessProduct, [left, right, at(a), 0]),
                (Some((left, right)), None) => (Action::ProductLess, [left, right, at(b), 0]),
                (None, None) => (Action::Difference, [at(a), at(b), 0, 0]),
            },
            Operation::Binary(operator, a, b) => {
                let action = match operator {
                    BinaryOperator::Product => Action::Product,
                    BinaryOperator::Quotient => Action::Quotient,
                    operator => Action::Binary(operator),
                };
                (action, [at(a), at(b), 0, 0])
            }
            Operation::Unary(operator, a) => (Action::Unary(operator), [at(a), 0, 0, 0]),
            Operation::Power(a, exponent) if self.is_two(exponent) => {
                (Action::Product, [at(a), at(a), 0, 0])
            }
            Operation::Power(a, exponent) => (Action::Power, [at(a), at(exponent), 0, 0]),
            Operation::Lookup(table, a) => (Action::Lookup(table), [at(a), 0, 0, 0]),
            Operation::Choice(relation, parts) => (Action::Choice(relation), parts.map(at)),
        };
        (action, places)
    }

    fn is_two(&self, value: Value) -> bool {
        matches!(value, Value::Constant(index) if self.constants[index as usize] == 2.0)
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
