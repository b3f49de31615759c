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
use std::ops::Range;

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
    /// Instructions that follow each other and do the same, in their order.
    runs: Vec<Run>,
    tables: Vec<Table>,
    /// The places of the results.
    results: Vec<u32>,
}

/// What an instruction does to the places that it is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Action {
    Sum,
    Difference,
    Product,
    Quotient,
    /// a · b + c, rounded twice.
    ProductSum,
    /// a · b − c, rounded twice.
    ProductLess,
    /// c − a · b, rounded twice.
    LessProduct,
    Unary(UnaryOperator),
    Binary(BinaryOperator),
    /// A power, whose exponent has a place, too.
    Power,
    /// In the table with this number.
    Lookup(u32),
    /// Left and right of the condition, then what it chooses from.
    Choice(Relation),
}

/// An action on what earlier places hold; those that it does not need are the first.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Instruction {
    action: Action,
    places: [u32; 4],
}

/// Instructions of one action, up to this number; they begin where the run before ends.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Run {
    action: Action,
    end: u32,
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
        let mut begin = 0;
        for run in &self.runs {
            self.execute(run.action, begin..run.end as usize, places);
            begin = run.end as usize;
        }
        for (result, &place) in results.iter_mut().zip(&self.results) {
            *result = places[place as usize];
        }
    }
}

impl Tape {
    /// What to do is decided once for a run of instructions and not for each.
    #[inline]
    fn execute(&self, action: Action, run: Range<usize>, places: &mut [f64]) {
        match action {
            Action::Sum => self.each(run, places, |[a, b, ..]| a + b),
            Action::Difference => self.each(run, places, |[a, b, ..]| a - b),
            Action::Product => self.each(run, places, |[a, b, ..]| a * b),
            Action::Quotient => self.each(run, places, |[a, b, ..]| a / b),
            Action::ProductSum => self.each(run, places, |[a, b, c, _]| a * b + c),
            Action::ProductLess => self.each(run, places, |[a, b, c, _]| a * b - c),
            Action::LessProduct => self.each(run, places, |[a, b, c, _]| c - a * b),
            Action::Unary(operator) => self.each(run, places, |[a, ..]| operator.apply(a)),
            Action::Binary(operator) => self.each(run, places, |[a, b, ..]| operator.apply(a, b)),
            Action::Power => self.each(run, places, |[a, exponent, ..]| raise(a, exponent)),
            Action::Lookup(table) => {
                let table = &self.tables[table as usize];
                self.each(run, places, |[a, ..]| table.value(a));
            }
            Action::Choice(relation) => self.each(run, places, |[a, b, then, otherwise]| {
                Choice::select(relation, (a, b), (then, otherwise))
            }),
        }
    }

    #[inline]
    fn each(&self, run: Range<usize>, places: &mut [f64], result: impl Fn([f64; 4]) -> f64) {
        let first = self.variables + self.constants.len() + run.start;
        for (place, instruction) in (first..).zip(&self.instructions[run]) {
            let operands = instruction.places.map(|operand| places[operand as usize]);
            places[place] = result(operands);
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
        let order = self.scheduled(&merged);
        let mut places = Places {
            variables,
            constants: self.constants.len(),
            of: vec![0; self.operations.len()],
        };
        for (place, &number) in (0..).zip(&order) {
            places.of[number] = place;
        }
        let instruction = |&number: &usize| self.instruction(number, &merged, &places);
        let instructions: Vec<Instruction> = order.iter().map(instruction).collect();
        let mut runs: Vec<Run> = Vec::new();
        for (number, instruction) in (0..).zip(&instructions) {
            match runs.last_mut() {
                Some(run) if run.action == instruction.action => run.end = number + 1,
                _ => runs.push(Run { action: instruction.action, end: number + 1 }),
            }
        }
        let results = results.iter().map(|result| places.place(*result)).collect();
        let Writer { constants, tables, .. } = self;
        Tape { variables, constants, instructions, runs, tables, results }
    }

    /// All operations but merged products, each after those whose results it needs, and such that
    /// many of one action follow each other: of those that can be next, all of the commonest action.
    fn scheduled(&self, merged: &[bool]) -> Vec<usize> {
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
        let mut order = Vec::new();
        while let Some((&action, _)) = ready.iter().max_by_key(|(_, numbers)| numbers.len()) {
            for number in ready.remove(&action).into_iter().flatten() {
                order.push(number);
                for &next in &needed_by[number] {
                    missing[next] -= 1;
                    if missing[next] == 0 {
                        ready.entry(self.action(next, merged, &nowhere)).or_default().push(next);
                    }
                }
            }
        }
        order
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
        self.instruction(number, merged, nowhere).action
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
        Instruction { action, places }
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
