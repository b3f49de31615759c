//! Many expressions compiled together, for the right-hand sides of differential equations.
//!
//! A [`Tape`] computes a list of expressions in one pass over numbered places. Parts that occur
//! more than once, also in different expressions, are computed once, and a product that is added to
//! something is one instruction. Instructions of one kind whose operands lie side by side, as in the
//! equations of many equal parts, are carried out together. The operations and their order are
//! those of the expressions, so that the results agree with [`Expression::evaluate`] bit for bit.
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

mod ranges;
mod writer;

use std::array::from_fn;

use crate::expression::{Choice, Expression};
use crate::operator::{BinaryOperator, UnaryOperator, raise};
use crate::predicate::Relation;
use crate::table::Table;
use crate::valuation::EvaluationError;

use writer::Writer;

/// Expressions compiled together by [`Tape::compile`].
#[derive(Clone, Debug, PartialEq)]
pub struct Tape {
    /// How many of the first places hold variables.
    variables: usize,
    /// What the places after the variables hold. What is read in lanes has as
    /// many places as it takes.
    constants: Vec<f64>,
    /// How many places hold what is computed.
    computed: usize,
    instructions: Vec<Instruction>,
    /// How many instructions of one width follow each other, again and again.
    runs: Vec<u32>,
    /// The places that are gathered.
    gathered: Vec<u32>,
    tables: Vec<Table>,
    /// Where the results are, in order.
    results: Vec<Places>,
}

/// Places that follow each other.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Places {
    first: u32,
    count: u32,
}

/// What an instruction does to its operands.
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
    /// −a
    Opposite,
    /// A copy of places that do not follow each other, to places that do. Its operand is where they
    /// are listed.
    Gather,
    Root,
    Unary(UnaryOperator),
    Binary(BinaryOperator),
    /// A power, whose exponent has a place, too.
    Power,
    /// In the table with this number.
    Lookup(u32),
    /// Left and right of the condition, then what it chooses from.
    Choice(Relation),
}

/// What is done to some places, once or in lanes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Instruction {
    action: Action,
    /// How many results are computed at once, each from operands one place after those of the result
    /// before it: 1 or one of [`WIDTHS`].
    width: u32,
    /// Where the first result goes.
    target: u32,
    /// The places of the operands of the first result, from the first on as many as the action needs.
    operands: [u32; 4],
}

/// How many results an instruction computes in lanes, widest first. Widths are known to the compiler,
/// which keeps the operands of each in registers.
const WIDTHS: [usize; 3] = [8, 4, 2];

impl Action {
    /// How many operands it needs.
    fn operands(self) -> usize {
        match self {
            Action::Gather => 0,
            Action::Opposite | Action::Root | Action::Unary(_) | Action::Lookup(_) => 1,
            Action::Sum | Action::Difference | Action::Product | Action::Quotient => 2,
            Action::Binary(_) | Action::Power => 2,
            Action::ProductSum | Action::ProductLess | Action::LessProduct => 3,
            Action::Choice(_) => 4,
        }
    }

    /// Whether it is done in lanes where it can be: arithmetic is.
    fn is_arithmetic(self) -> bool {
        matches!(
            self,
            Action::Sum
                | Action::Difference
                | Action::Product
                | Action::Quotient
                | Action::ProductSum
                | Action::ProductLess
                | Action::LessProduct
                | Action::Opposite
        )
    }
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
        let mut writer = Writer::new(variables);
        let results = expressions
            .into_iter()
            .map(|expression| expression.fold(&mut |part, operands| writer.part(part, operands)));
        let results = results.collect::<Result<Vec<_>, _>>()?;
        Ok(writer.tape(variables.len(), &results))
    }

    /// Room for [`evaluate`](Self::evaluate), to be used again and again.
    pub fn places(&self) -> Vec<f64> {
        let mut places = vec![0.0; self.variables];
        places.extend(&self.constants);
        places.resize(places.len() + self.computed, 0.0);
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
        copy(&values[..given], &mut places[..given]);
        if given < self.variables {
            places[given..self.variables].fill(f64::NAN);
        }
        let mut ahead = &self.instructions[..];
        for run in &self.runs {
            let (instructions, rest) = ahead.split_at(*run as usize);
            match instructions[0].width {
                8 => self.in_lanes::<8>(instructions, places),
                4 => self.in_lanes::<4>(instructions, places),
                2 => self.in_lanes::<2>(instructions, places),
                _ => self.once(instructions, places),
            }
            ahead = rest;
        }
        let mut rest = results;
        for Places { first, count } in &self.results {
            let (next, later) = rest.split_at_mut((*count as usize).min(rest.len()));
            copy(&places[*first as usize..][..next.len()], next);
            rest = later;
        }
    }

    /// Computes results one by one. As below, an operand that has just been computed is not read back from
    /// its place: that would take longer than the arithmetic.
    #[inline]
    fn once(&self, instructions: &[Instruction], places: &mut [f64]) {
        let (mut latest, mut result) = (u32::MAX, 0.0);
        for Instruction { action, target, operands, .. } in instructions {
            let at = |number: usize| match operands[number] {
                place if place == latest => result,
                place => places[place as usize],
            };
            result = match *action {
                Action::Sum => at(0) + at(1),
                Action::Difference => at(0) - at(1),
                Action::Product => at(0) * at(1),
                Action::Quotient => at(0) / at(1),
                Action::ProductSum => at(0) * at(1) + at(2),
                Action::ProductLess => at(0) * at(1) - at(2),
                Action::LessProduct => at(2) - at(0) * at(1),
                Action::Gather => places[self.gathered[operands[0] as usize] as usize],
                Action::Root => at(0).sqrt(),
                Action::Opposite => -at(0),
                Action::Unary(operator) => operator.apply(at(0)),
                Action::Binary(operator) => operator.apply(at(0), at(1)),
                Action::Power => raise(at(0), at(1)),
                Action::Lookup(table) => self.tables[table as usize].value(at(0)),
                Action::Choice(relation) => {
                    Choice::select(relation, (at(0), at(1)), (at(2), at(3)))
                }
            };
            places[*target as usize] = result;
            latest = *target;
        }
    }

    /// Computes results in lanes; the writer makes such instructions of arithmetic only.
    #[inline]
    fn in_lanes<const WIDTH: usize>(&self, instructions: &[Instruction], places: &mut [f64]) {
        let (mut latest, mut results) = (u32::MAX, [0.0; WIDTH]);
        for Instruction { action, target, operands, .. } in instructions {
            let at = |number: usize| -> [f64; WIDTH] {
                if operands[number] == latest {
                    return results;
                }
                let first = operands[number] as usize;
                let row = &places[first..first + WIDTH];
                from_fn(|lane| row[lane])
            };
            results = match action {
                Action::Sum => two(at(0), at(1), |a, b| a + b),
                Action::Difference => two(at(0), at(1), |a, b| a - b),
                Action::Product => two(at(0), at(1), |a, b| a * b),
                Action::Quotient => two(at(0), at(1), |a, b| a / b),
                Action::ProductSum => three(at(0), at(1), at(2), |a, b, c| a * b + c),
                Action::ProductLess => three(at(0), at(1), at(2), |a, b, c| a * b - c),
                Action::LessProduct => three(at(0), at(1), at(2), |a, b, c| c - a * b),
                Action::Opposite => at(0).map(|a| -a),
                Action::Gather => {
                    let first = operands[0] as usize;
                    let sources = &self.gathered[first..first + WIDTH];
                    from_fn(|lane| places[sources[lane] as usize])
                }
                _ => return,
            };
            places[*target as usize..][..WIDTH].copy_from_slice(&results);
            latest = *target;
        }
    }
}

#[inline]
fn two<const WIDTH: usize>(
    a: [f64; WIDTH],
    b: [f64; WIDTH],
    result: impl Fn(f64, f64) -> f64,
) -> [f64; WIDTH] {
    from_fn(|lane| result(a[lane], b[lane]))
}

#[inline]
fn three<const WIDTH: usize>(
    a: [f64; WIDTH],
    b: [f64; WIDTH],
    c: [f64; WIDTH],
    result: impl Fn(f64, f64, f64) -> f64,
) -> [f64; WIDTH] {
    from_fn(|lane| result(a[lane], b[lane], c[lane]))
}

/// Copies numbers into a slice of the same length, in groups no wider than those in which they are
/// written and read next: loading a register from memory that was just written in smaller parts stalls.
#[inline]
fn copy(from: &[f64], to: &mut [f64]) {
    let (fours, rest) = from.as_chunks::<4>();
    let (new, last) = to.as_chunks_mut::<4>();
    for (new, row) in new.iter_mut().zip(fours) {
        *new = from_fn(|lane| row[lane]);
    }
    let (twos, rest) = rest.as_chunks::<2>();
    let (new, last) = last.as_chunks_mut::<2>();
    if let ([new], [row]) = (new, twos) {
        *new = from_fn(|lane| row[lane]);
    }
    if let ([new], [value]) = (last, rest) {
        *new = *value;
    }
}
