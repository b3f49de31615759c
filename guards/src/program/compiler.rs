//! Writing a program: operands that need no step of their own, and the steps of the others.

use super::{Instruction, Operand, Program};
use crate::expression::{BinaryOperator, Expression};
use crate::fold::Operands;
use crate::table::Table;
use crate::valuation::EvaluationError;

impl Expression {
    /// The expression as a program on slices in which place *i* holds the value of `variables[i]`;
    /// of a name that is listed twice, the first place counts.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownVariable`] if a variable of the expression is not listed.
    pub fn compile(&self, variables: &[impl AsRef<str>]) -> Result<Program, EvaluationError> {
        let mut compiler = Compiler { variables, tables: Vec::new() };
        let code = self.fold(&mut |part, operands| compiler.part(part, operands))?;
        let Code { start, instructions, depth } = code.unfolded();
        let (instructions, tables) = (instructions.into(), compiler.tables.into());
        Ok(Program { start, instructions, tables, depth })
    }
}

struct Compiler<'a, N> {
    variables: &'a [N],
    tables: Vec<Table>,
}

/// What a part of an expression is compiled to.
enum Piece {
    /// What needs no instruction of its own: the program of that part has just a start.
    Operand(Operand),
    Code(Code),
}

/// A program in the making.
struct Code {
    start: Operand,
    instructions: Vec<Instruction>,
    depth: usize,
}

impl Code {
    fn then(mut self, instruction: Instruction) -> Piece {
        self.instructions.push(instruction);
        Piece::Code(self)
    }

    /// Both programs after one another; what the first computes is on a stack of this height, above
    /// what it left there itself, while the second runs.
    fn before(mut self, other: Code, height: usize) -> Code {
        self.instructions.push(Instruction::Load(other.start));
        self.instructions.extend(other.instructions);
        self.depth = self.depth.max(height + 1 + other.depth);
        self
    }
}

impl Piece {
    fn unfolded(self) -> Code {
        match self {
            Piece::Operand(start) => Code { start, instructions: Vec::new(), depth: 0 },
            Piece::Code(code) => code,
        }
    }
}

impl<N: AsRef<str>> Compiler<'_, N> {
    /// The program of a part, given those of its operands. Operations on constants are done.
    fn part(
        &mut self,
        part: &Expression,
        operands: Operands<Piece>,
    ) -> Result<Piece, EvaluationError> {
        if let Some(value) = folded(part, &operands) {
            return Ok(Piece::Operand(Operand::Constant(value)));
        }
        Ok(match (part, operands) {
            (Expression::Variable(name), _) => Piece::Operand(Operand::Variable(self.place(name)?)),
            (Expression::Unary(operator, _), Operands::One(operand)) => {
                operand.unfolded().then(Instruction::Unary(*operator))
            }
            (Expression::Power(_, exponent), Operands::One(base)) => {
                base.unfolded().then(Instruction::Power(*exponent))
            }
            (Expression::Lookup(table, _), Operands::One(place)) => {
                self.tables.push(table.clone());
                place.unfolded().then(Instruction::Lookup(self.tables.len() - 1))
            }
            (Expression::Binary(operator, ..), Operands::Two(left, right)) => {
                binary(*operator, left, right)
            }
            (Expression::Choice(choice), Operands::Four(parts)) => {
                let [left, right, then, otherwise] = parts.map(Piece::unfolded);
                let both = left.before(right, 0).before(then, 1).before(otherwise, 2);
                both.then(Instruction::Select(choice.condition.relation))
            }
            // No part has other operands than its own.
            _ => Piece::Operand(Operand::Constant(f64::NAN)),
        })
    }

    fn place(&self, name: &str) -> Result<usize, EvaluationError> {
        self.variables
            .iter()
            .position(|listed| listed.as_ref() == name)
            .ok_or_else(|| EvaluationError::UnknownVariable { variable: name.to_string() })
    }
}

/// The value of an operation on constants.
fn folded(part: &Expression, operands: &Operands<Piece>) -> Option<f64> {
    let constant = |piece: &Piece| match piece {
        Piece::Operand(Operand::Constant(value)) => Some(*value),
        _ => None,
    };
    let all = operands.listed().into_iter().flatten().all(|piece| constant(piece).is_some());
    let values = all.then(|| operands.map_ref(|piece| constant(piece).unwrap_or(f64::NAN)))?;
    part.computed(values)
}

fn binary(operator: BinaryOperator, left: Piece, right: Piece) -> Piece {
    match (operator, left, right) {
        (
            BinaryOperator::Product,
            Piece::Operand(Operand::Variable(variable)),
            Piece::Operand(Operand::Constant(factor)),
        )
        | (
            BinaryOperator::Product,
            Piece::Operand(Operand::Constant(factor)),
            Piece::Operand(Operand::Variable(variable)),
        ) => Piece::Operand(Operand::Scaled(factor, variable)),
        (_, left, Piece::Operand(right)) => {
            left.unfolded().then(Instruction::WithRight(operator, right))
        }
        (_, Piece::Operand(left), right) => {
            right.unfolded().then(Instruction::WithLeft(operator, left))
        }
        (_, left, right) => {
            left.unfolded().before(right.unfolded(), 0).then(Instruction::Binary(operator))
        }
    }
}
