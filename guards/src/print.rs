//! Expressions and predicates as Unicode text and as LaTeX, with as few parentheses as the
//! structure allows: two different structures never print alike as text.
//!
//! From loosely to tightly binding: ∨, ∧, comparisons, ¬, sums with negation, products with
//! quotients, powers. Sums and products group to the left, so that `a + b − c` is `(a + b) − c`
//! and the other grouping shows its parentheses; addition of floating-point numbers is not
//! associative, and so the difference matters.

mod notation;

use std::fmt::{self, Display, Write};

use crate::expression::{BinaryOperator, Expression, UnaryOperator};
use crate::predicate::{Comparison, Predicate, Relation};
use notation::{LATEX, Notation, TEXT};

impl Display for Expression {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        Printer { out: formatter, notation: &TEXT }.expression(self)
    }
}

impl Display for Predicate {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        Printer { out: formatter, notation: &TEXT }.predicate(self)
    }
}

impl Expression {
    /// The expression in LaTeX, for mathematics mode.
    pub fn to_latex(&self) -> String {
        latex(|printer| printer.expression(self))
    }
}

impl Predicate {
    /// The predicate in LaTeX, for mathematics mode.
    ///
    /// ```
    /// use pleach_guards::variable;
    ///
    /// let close = (variable("distance") / 2.0).at_most(variable("δ_0"));
    /// assert_eq!(close.to_latex(), r"\frac{\mathit{distance}}{2} \le \delta_{0}");
    /// ```
    pub fn to_latex(&self) -> String {
        latex(|printer| printer.predicate(self))
    }
}

fn latex(print: impl FnOnce(&mut Printer) -> fmt::Result) -> String {
    let mut out = String::new();
    // Writing into a string cannot fail.
    let _ = print(&mut Printer { out: &mut out, notation: &LATEX });
    out
}

/// How tightly the outermost operator of a term binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Disjunction,
    Conjunction,
    Comparison,
    Opposite,
    Sum,
    Product,
    Power,
    Atom,
}

impl Binding {
    fn of_predicate(predicate: &Predicate) -> Binding {
        match predicate {
            Predicate::Comparison(_) => Binding::Comparison,
            Predicate::Not(_) => Binding::Opposite,
            Predicate::All(parts) | Predicate::Any(parts) if parts.is_empty() => Binding::Atom,
            Predicate::All(_) => Binding::Conjunction,
            Predicate::Any(_) => Binding::Disjunction,
            Predicate::Proposition(_) | Predicate::Function(_) => Binding::Atom,
        }
    }

    fn of_expression(expression: &Expression) -> Binding {
        match expression {
            Expression::Constant(value) if value.is_sign_negative() => Binding::Sum,
            Expression::Constant(_) | Expression::Variable(_) => Binding::Atom,
            Expression::Unary(UnaryOperator::Negation, _) => Binding::Sum,
            Expression::Unary(_, _) => Binding::Atom,
            Expression::Binary(..) if begins_negative(expression) => Binding::Sum,
            Expression::Binary(operator, ..) => match operator {
                BinaryOperator::Sum | BinaryOperator::Difference => Binding::Sum,
                BinaryOperator::Product | BinaryOperator::Quotient => Binding::Product,
                BinaryOperator::Minimum | BinaryOperator::Maximum => Binding::Atom,
            },
            Expression::Power(..) => Binding::Power,
        }
    }
}

/// The factor that a product or quotient begins with; of anything else, itself.
fn first_factor(expression: &Expression) -> &Expression {
    match expression {
        Expression::Binary(BinaryOperator::Product | BinaryOperator::Quotient, left, _) => {
            first_factor(left)
        }
        other => other,
    }
}

/// Whether a number, product or quotient begins with a minus that belongs to a number.
fn begins_negative(expression: &Expression) -> bool {
    matches!(first_factor(expression), Expression::Constant(value) if value.is_sign_negative())
}

struct Printer<'a> {
    out: &'a mut dyn Write,
    notation: &'static Notation,
}

impl Printer<'_> {
    fn predicate(&mut self, predicate: &Predicate) -> fmt::Result {
        match predicate {
            Predicate::Comparison(comparison) => self.comparison(comparison),
            Predicate::Not(inner) => {
                self.out.write_str(self.notation.not)?;
                self.part(inner, Binding::Opposite)
            }
            Predicate::All(parts) if parts.is_empty() => self.out.write_str(self.notation.always),
            Predicate::Any(parts) if parts.is_empty() => self.out.write_str(self.notation.never),
            Predicate::All(parts) => self.joined(parts, self.notation.and, Binding::Comparison),
            Predicate::Any(parts) => self.joined(parts, self.notation.or, Binding::Conjunction),
            Predicate::Proposition(name) => (self.notation.write_name)(self.out, name),
            Predicate::Function(function) => {
                (self.notation.write_name)(self.out, function.name())?;
                self.enclosed(self.notation.parentheses, |printer| {
                    printer.out.write_str(printer.notation.ellipsis)
                })
            }
        }
    }

    fn joined(&mut self, parts: &[Predicate], separator: &str, least: Binding) -> fmt::Result {
        for (position, part) in parts.iter().enumerate() {
            if position > 0 {
                self.out.write_str(separator)?;
            }
            self.part(part, least)?;
        }
        Ok(())
    }

    fn part(&mut self, part: &Predicate, least: Binding) -> fmt::Result {
        let loose = Binding::of_predicate(part) < least;
        self.parenthesised_if(loose, |printer| printer.predicate(part))
    }

    fn comparison(&mut self, comparison: &Comparison) -> fmt::Result {
        self.expression(&comparison.left)?;
        self.out.write_str(match comparison.relation {
            Relation::AtMost => self.notation.at_most,
            Relation::LessThan => " < ",
            Relation::AtLeast => self.notation.at_least,
            Relation::MoreThan => " > ",
        })?;
        self.expression(&comparison.right)
    }

    fn expression(&mut self, expression: &Expression) -> fmt::Result {
        match expression {
            Expression::Constant(value) => self.notation.write_number(self.out, *value),
            Expression::Variable(name) => (self.notation.write_name)(self.out, name),
            Expression::Unary(operator, operand) => self.unary(*operator, operand),
            Expression::Binary(operator, left, right) => self.binary(*operator, left, right),
            Expression::Power(base, exponent) if *exponent == 0.5 => self.root(base),
            Expression::Power(base, exponent) => {
                self.operand(base, Binding::Atom)?;
                (self.notation.write_exponent)(self.out, *exponent)
            }
        }
    }

    fn unary(&mut self, operator: UnaryOperator, operand: &Expression) -> fmt::Result {
        let (name, brackets) = match operator {
            UnaryOperator::Negation => {
                self.out.write_str(self.notation.minus)?;
                // A minus right before a number is a part of the number.
                let is_number = matches!(first_factor(operand), Expression::Constant(_));
                let is_loose = is_number || Binding::of_expression(operand) < Binding::Product;
                return self.parenthesised_if(is_loose, |printer| printer.expression(operand));
            }
            UnaryOperator::AbsoluteValue => ("", self.notation.bars),
            UnaryOperator::Sine => (self.notation.sine, self.notation.parentheses),
            UnaryOperator::Cosine => (self.notation.cosine, self.notation.parentheses),
            UnaryOperator::Exponential => (self.notation.exponential, self.notation.parentheses),
            UnaryOperator::Logarithm => (self.notation.logarithm, self.notation.parentheses),
        };
        self.out.write_str(name)?;
        self.enclosed(brackets, |printer| printer.expression(operand))
    }

    fn binary(
        &mut self,
        operator: BinaryOperator,
        left: &Expression,
        right: &Expression,
    ) -> fmt::Result {
        let (symbol, least_left, least_right) = match operator {
            BinaryOperator::Sum => (" + ", Binding::Sum, Binding::Product),
            BinaryOperator::Difference => {
                (self.notation.difference, Binding::Sum, Binding::Product)
            }
            BinaryOperator::Product => (self.notation.product, Binding::Product, Binding::Power),
            BinaryOperator::Quotient => return self.quotient(left, right),
            BinaryOperator::Minimum => return self.function(self.notation.minimum, left, right),
            BinaryOperator::Maximum => return self.function(self.notation.maximum, left, right),
        };
        self.left_operand(left, least_left)?;
        self.out.write_str(symbol)?;
        self.operand(right, least_right)
    }

    /// What stands on the left may begin with a negative number.
    fn left_operand(&mut self, operand: &Expression, least: Binding) -> fmt::Result {
        let is_loose = Binding::of_expression(operand) < least && !begins_negative(operand);
        self.parenthesised_if(is_loose, |printer| printer.expression(operand))
    }

    fn quotient(&mut self, left: &Expression, right: &Expression) -> fmt::Result {
        match self.notation.quotient {
            Some(symbol) => {
                self.left_operand(left, Binding::Product)?;
                self.out.write_str(symbol)?;
                self.operand(right, Binding::Power)
            }
            None => {
                self.out.write_str(r"\frac")?;
                self.enclosed(("{", "}"), |printer| printer.expression(left))?;
                self.enclosed(("{", "}"), |printer| printer.expression(right))
            }
        }
    }

    fn function(&mut self, name: &str, left: &Expression, right: &Expression) -> fmt::Result {
        self.out.write_str(name)?;
        self.enclosed(self.notation.parentheses, |printer| {
            printer.expression(left)?;
            printer.out.write_str(", ")?;
            printer.expression(right)
        })
    }

    fn root(&mut self, base: &Expression) -> fmt::Result {
        match self.notation.root {
            Some(symbol) => {
                self.out.write_str(symbol)?;
                self.operand(base, Binding::Atom)
            }
            None => self.enclosed((r"\sqrt{", "}"), |printer| printer.expression(base)),
        }
    }

    fn operand(&mut self, operand: &Expression, least: Binding) -> fmt::Result {
        let loose = Binding::of_expression(operand) < least;
        self.parenthesised_if(loose, |printer| printer.expression(operand))
    }

    fn parenthesised_if(
        &mut self,
        needed: bool,
        print: impl FnOnce(&mut Self) -> fmt::Result,
    ) -> fmt::Result {
        if needed { self.enclosed(self.notation.parentheses, print) } else { print(self) }
    }

    fn enclosed(
        &mut self,
        (open, close): (&str, &str),
        print: impl FnOnce(&mut Self) -> fmt::Result,
    ) -> fmt::Result {
        self.out.write_str(open)?;
        print(self)?;
        self.out.write_str(close)
    }
}
