//! Writing a tape: equal parts are found, products merged, and instructions of one action put one
//! after another.

use std::collections::BTreeMap;
use std::iter::from_fn;

use super::{Action, Instruction, Places, Tape, WIDTHS};
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

/// An action and its operands, from the first on as many as it needs.
type Deed = (Action, [Value; 4]);

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
        let mut order = vec![0; self.operations.len()];
        for (place, &number) in (0..).zip(batches.iter().flatten()) {
            order[number] = place;
        }
        let stretches: Vec<&[usize]> =
            batches.iter().flat_map(|batch| self.stretches(batch, &merged, &order)).collect();
        let layout = self.layout(variables, order, &stretches, &merged);
        let computed: usize = stretches.iter().map(|numbers| numbers.len()).sum();

        let mut gathered = Gathered::new(layout.computed + computed as u32);
        let mut instructions = Vec::new();
        let mut target = layout.computed;
        for numbers in stretches {
            let (action, width) = (self.deed(numbers[0], &merged).0, numbers.len() as u32);
            let mut operands = [0; 4];
            for (place, values) in operands.iter_mut().zip(self.operands(numbers, &merged)) {
                *place = if follow_each_other(&values, &layout.order) {
                    layout.place(values[0])
                } else {
                    let sources = values.into_iter().map(|value| layout.place(value)).collect();
                    gathered.place(sources, &mut instructions)
                };
            }
            instructions.push(Instruction { action, width, target, operands });
            target += width;
        }

        let widths = self.constants.iter().zip(&layout.widths);
        let constants = widths.flat_map(|(&value, &width)| (0..width).map(move |_| value));
        let mut result_places: Vec<Places> = Vec::new();
        for result in results {
            let place = layout.place(*result);
            match result_places.last_mut() {
                Some(last) if last.first + last.count == place => last.count += 1,
                _ => result_places.push(Places { first: place, count: 1 }),
            }
        }
        let runs = instructions.chunk_by(|one: &Instruction, next| one.width == next.width);
        let runs = runs.map(|run| run.len() as u32).collect();
        Tape {
            variables,
            runs,
            constants: constants.collect(),
            computed: computed + gathered.sources.len(),
            instructions,
            gathered: gathered.sources,
            tables: self.tables,
            results: result_places,
        }
    }

    /// The batch as stretches of one of [`WIDTHS`] and single operations: such that each result takes
    /// as few instructions as can be, with those that gather operands which do not lie side by side.
    fn stretches<'b>(
        &self,
        batch: &'b [usize],
        merged: &[bool],
        order: &[u32],
    ) -> impl Iterator<Item = &'b [usize]> {
        let gathers = |numbers: &[usize]| {
            let operands = self.operands(numbers, merged);
            operands.iter().filter(|values| !follow_each_other(values, order)).count()
        };
        let [widest, ..] = WIDTHS;
        let mut rest = batch;
        from_fn(move || {
            let first = *rest.first()?;
            let is_arithmetic = self.deed(first, merged).0.is_arithmetic();
            let widths = if is_arithmetic { &WIDTHS[..] } else { &[] };
            let fitting = widths.iter().copied().filter(|&width| width <= rest.len());
            let for_as_many = |width: &usize| (1 + gathers(&rest[..*width])) * widest / width;
            let width = fitting.chain([1]).min_by_key(for_as_many)?;
            let (stretch, later) = rest.split_at(width);
            rest = later;
            Some(stretch)
        })
    }

    /// The operands of operations of one action: the first of each, then the second of each.
    fn operands(&self, numbers: &[usize], merged: &[bool]) -> Vec<Vec<Value>> {
        let deeds: Vec<Deed> = numbers.iter().map(|&number| self.deed(number, merged)).collect();
        let count = deeds.first().map_or(0, |(action, _)| action.operands());
        (0..count).map(|place| deeds.iter().map(|(_, values)| values[place]).collect()).collect()
    }

    /// A constant that is read in lanes has as many places as results are computed from it.
    fn layout(
        &self,
        variables: usize,
        order: Vec<u32>,
        stretches: &[&[usize]],
        merged: &[bool],
    ) -> Layout {
        let mut widths = vec![1; self.constants.len()];
        for numbers in stretches {
            let (action, values) = self.deed(numbers[0], merged);
            for value in &values[..action.operands()] {
                if let Value::Constant(index) = *value {
                    let width = &mut widths[index as usize];
                    *width = (*width).max(numbers.len());
                }
            }
        }
        let mut next = variables as u32;
        let starts = widths.iter().map(|&width| {
            let start = next;
            next += width as u32;
            start
        });
        let constants = starts.collect();
        Layout { constants, widths, computed: next, order }
    }

    /// All operations but merged products in batches of one action, each after those whose results
    /// it needs: of the operations that can be next, all of the commonest action.
    fn scheduled(&self, merged: &[bool]) -> Vec<Vec<usize>> {
        let mut missing = vec![0; self.operations.len()];
        let mut needed_by = vec![Vec::new(); self.operations.len()];
        let mut ready: BTreeMap<Action, Vec<usize>> = BTreeMap::new();
        let action = |number: usize| self.deed(number, merged).0;
        for number in (0..self.operations.len()).filter(|&number| !merged[number]) {
            for needed in self.needs(number, merged) {
                needed_by[needed].push(number);
                missing[number] += 1;
            }
            if missing[number] == 0 {
                ready.entry(action(number)).or_default().push(number);
            }
        }
        let mut batches = Vec::new();
        while let Some((&commonest, _)) = ready.iter().max_by_key(|(_, numbers)| numbers.len()) {
            let mut batch = ready.remove(&commonest).unwrap_or_default();
            // In the order in which they were written, equal parts of a model lie side by side.
            batch.sort_unstable();
            for &number in &batch {
                for &next in &needed_by[number] {
                    missing[next] -= 1;
                    if missing[next] == 0 {
                        ready.entry(action(next)).or_default().push(next);
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

    fn deed(&self, number: usize, merged: &[bool]) -> Deed {
        let product = |value| match value {
            Value::Computed(number) if merged[number as usize] => {
                match self.operations[number as usize] {
                    Operation::Binary(_, a, b) => Some((a, b)),
                    _ => None,
                }
            }
            _ => None,
        };
        let one = |action, a| (action, [a; 4]);
        let two = |action, a, b| (action, [a, b, b, b]);
        let three = |action, (a, b), c| (action, [a, b, c, c]);
        match self.operations[number] {
            Operation::Binary(BinaryOperator::Sum, a, b) => match (product(a), product(b)) {
                (_, Some(product)) => three(Action::ProductSum, product, a),
                (Some(product), None) => three(Action::ProductSum, product, b),
                (None, None) => two(Action::Sum, a, b),
            },
            Operation::Binary(BinaryOperator::Difference, a, b) => match (product(a), product(b)) {
                (_, Some(product)) => three(Action::LessProduct, product, a),
                (Some(product), None) => three(Action::ProductLess, product, b),
                (None, None) => two(Action::Difference, a, b),
            },
            Operation::Binary(BinaryOperator::Product, a, b) => two(Action::Product, a, b),
            Operation::Binary(BinaryOperator::Quotient, a, b) => two(Action::Quotient, a, b),
            Operation::Binary(operator, a, b) => two(Action::Binary(operator), a, b),
            Operation::Unary(UnaryOperator::Negation, a) => one(Action::Opposite, a),
            Operation::Unary(operator, a) => one(Action::Unary(operator), a),
            Operation::Power(a, exponent) if self.is(exponent, 2.0) => two(Action::Product, a, a),
            Operation::Power(a, exponent) if self.is(exponent, 0.5) => one(Action::Root, a),
            Operation::Power(a, exponent) => two(Action::Power, a, exponent),
            Operation::Lookup(table, a) => one(Action::Lookup(table), a),
            Operation::Choice(relation, parts) => (Action::Choice(relation), parts),
        }
    }

    fn is(&self, value: Value, number: f64) -> bool {
        matches!(value, Value::Constant(index) if self.constants[index as usize] == number)
    }
}

/// Whether operands are in places one after another, as those of operations in lanes are.
fn follow_each_other(values: &[Value], order: &[u32]) -> bool {
    values.windows(2).all(|pair| match (pair[0], pair[1]) {
        (Value::Variable(one), Value::Variable(next)) => next == one + 1,
        (Value::Computed(one), Value::Computed(next)) => {
            order[next as usize] == order[one as usize] + 1
        }
        (Value::Constant(one), Value::Constant(next)) => one == next,
        _ => false,
    })
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
struct Layout {
    /// By constant: the first place, and how many there are.
    constants: Vec<u32>,
    widths: Vec<usize>,
    /// The first place of what is computed.
    computed: u32,
    /// By operation: when it is computed.
    order: Vec<u32>,
}

impl Layout {
    fn place(&self, value: Value) -> u32 {
        match value {
            Value::Variable(index) => index,
            Value::Constant(index) => self.constants[index as usize],
            Value::Computed(number) => self.computed + self.order[number as usize],
        }
    }
}

/// The places that are gathered, after all others.
struct Gathered {
    /// The first of them.
    first: u32,
    /// What they are copies of.
    sources: Vec<u32>,
    /// Where groups of sources begin that are gathered already.
    known: BTreeMap<Vec<u32>, u32>,
}

impl Gathered {
    fn new(first: u32) -> Self {
        Gathered { first, sources: Vec::new(), known: BTreeMap::new() }
    }

    /// The first place of copies of these; an instruction that makes them is added if none has.
    fn place(&mut self, sources: Vec<u32>, instructions: &mut Vec<Instruction>) -> u32 {
        let list = self.sources.len() as u32;
        let target = self.first + list;
        if let Some(&known) = self.known.get(&sources) {
            return known;
        }
        self.sources.extend(&sources);
        let (action, width) = (Action::Gather, sources.len() as u32);
        instructions.push(Instruction { action, width, target, operands: [list; 4] });
        self.known.insert(sources, target);
        target
    }
}
