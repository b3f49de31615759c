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

mod writer;

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
    /// What the places after the variables hold.
    constants: Vec<f64>,
    /// By instruction, which writes the next place after the constants: the places of its operands,
    /// from the first on as many as its action needs.
    operands: Vec<[u32; 4]>,
    /// The actions of the instructions, in their order.
    runs: Vec<Run>,
    tables: Vec<Table>,
    /// The places of the results.
    results: Vec<u32>,
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
    Unary(UnaryOperator),
    Binary(BinaryOperator),
    /// A power, whose exponent has a place, too.
    Power,
    /// In the table with this number.
    Lookup(u32),
    /// Left and right of the condition, then what it chooses from.
    Choice(Relation),
}

/// Instructions of one action, of which none needs what another one writes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Run {
    action: Action,
    length: u32,
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
        places.resize(places.len() + self.operands.len(), 0.0);
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
        let mut place = self.variables + self.constants.len();
        let mut left = &self.operands[..];
        for run in &self.runs {
            let operands;
            (operands, left) = left.split_at(run.length as usize);
            let (known, rest) = places.split_at_mut(place);
            self.execute(run.action, operands, known, rest);
            place += operands.len();
        }
        for (result, &place) in results.iter_mut().zip(&self.results) {
            *result = places[place as usize];
        }
    }

    /// What to do is decided once for a run of instructions and not for each.
    #[inline]
    fn execute(&self, action: Action, operands: &[[u32; 4]], known: &[f64], new: &mut [f64]) {
        match action {
            Action::Sum => each(operands, known, new, |[a, b]| a + b),
            Action::Difference => each(operands, known, new, |[a, b]| a - b),
            Action::Product => each(operands, known, new, |[a, b]| a * b),
            Action::Quotient => each(operands, known, new, |[a, b]| a / b),
            Action::ProductSum => each(operands, known, new, |[a, b, c]| a * b + c),
            Action::ProductLess => each(operands, known, new, |[a, b, c]| a * b - c),
            Action::LessProduct => each(operands, known, new, |[a, b, c]| c - a * b),
            Action::Unary(operator) => each(operands, known, new, |[a]| operator.apply(a)),
            Action::Binary(operator) => each(operands, known, new, |[a, b]| operator.apply(a, b)),
            Action::Power => each(operands, known, new, |[a, exponent]| raise(a, exponent)),
            Action::Lookup(table) => {
                let table = &self.tables[table as usize];
                each(operands, known, new, |[a]| table.value(a));
            }
            Action::Choice(relation) => each(operands, known, new, |[a, b, then, otherwise]| {
                Choice::select(relation, (a, b), (then, otherwise))
            }),
        }
    }
}

/// Writes the results of instructions with `N` operands among the known places to new ones.
#[inline]
fn each<const N: usize>(
    operands: &[[u32; 4]],
    known: &[f64],
    new: &mut [f64],
    result: impl Fn([f64; N]) -> f64,
) {
    for (place, operands) in new.iter_mut().zip(operands) {
        *place = result(std::array::from_fn(|number| known[operands[number] as usize]));
    }
}
