//! Expressions and predicates as Unicode text and as LaTeX, with as few parentheses as the
//! structure allows: two different structures never print alike as text.
//!
//! From loosely to tightly binding: ∨, ∧, comparisons, ¬, sums with negation, products with
//! quotients, powers. Sums and products group to the left, so that `a + b − c` is `(a + b) − c`
//! and the other grouping shows its parentheses; addition of floating-point numbers is not
//! associative, and so the difference matters.

mod arithmetic;
mod notation;

use std::fmt::{self, Display, Write};

use crate::expression::Expression;
use crate::predicate::{Comparison, Predicate};
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

/// How tightly the outermost operator of a predicate binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Disjunction,
    Conjunction,
    Comparison,
    Opposite,
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
        self.relation(comparison.relation)?;
        self.expression(&comparison.right)
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
