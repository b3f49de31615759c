//! Formulas as Unicode text and as LaTeX.
//!
//! From loosely to tightly binding: →, ∨, ∧, comparisons, 𝒰, and last ¬, □ and ◇.

use std::fmt::{self, Display, Write};

use pleach_guards::{Predicate, constant};

use super::formula::{Formula, Window};

impl Display for Formula {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        Printer { out: formatter, notation: &TEXT }.formula(self)
    }
}

impl Display for Window {
    /// As a closed interval of seconds; on the side of ∞ it is open.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        Printer { out: formatter, notation: &TEXT }.interval(*self)
    }
}

impl Formula {
    /// The formula in LaTeX, for mathematics mode; □ and ◇ need the package `amssymb`.
    ///
    /// ```
    /// use pleach_guards::variable;
    /// use pleach_verify::temporal::{always, within};
    ///
    /// let above = always(within(0.0, 5.0)?, variable("h").at_least(0.0));
    /// assert_eq!(above.to_latex(), r"\square_{[0, 5]} \left(h \ge 0\right)");
    /// # Ok::<(), pleach_verify::temporal::InvalidWindow>(())
    /// ```
    pub fn to_latex(&self) -> String {
        let mut out = String::new();
        // Writing into a string cannot fail.
        let _ = Printer { out: &mut out, notation: &LATEX }.formula(self);
        out
    }
}

/// What differs between text and LaTeX.
struct Notation {
    truth: &'static str,
    falsehood: &'static str,
    not: &'static str,
    and: &'static str,
    or: &'static str,
    implies: &'static str,
    always: &'static str,
    eventually: &'static str,
    until: &'static str,
    subscript: (&'static str, &'static str),
    parentheses: (&'static str, &'static str),
    number: fn(f64) -> String,
    predicate: fn(&Predicate) -> String,
}

static TEXT: Notation = Notation {
    truth: "true",
    falsehood: "false",
    not: "¬",
    and: " ∧ ",
    or: " ∨ ",
    implies: " → ",
    always: "□",
    eventually: "◇",
    until: "𝒰",
    subscript: ("", ""),
    parentheses: ("(", ")"),
    number: |number| constant(number).to_string(),
    predicate: Predicate::to_string,
};

static LATEX: Notation = Notation {
    truth: r"\top",
    falsehood: r"\bot",
    not: r"\lnot ",
    and: r" \land ",
    or: r" \lor ",
    implies: r" \to ",
    always: r"\square",
    eventually: r"\lozenge",
    until: r"\mathcal{U}",
    subscript: ("_{", "}"),
    parentheses: (r"\left(", r"\right)"),
    number: |number| constant(number).to_latex(),
    predicate: Predicate::to_latex,
};

/// How tightly the outermost operator of a formula binds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Implication,
    Disjunction,
    Conjunction,
    Comparison,
    Until,
    Prefix,
}

impl Binding {
    fn of(formula: &Formula) -> Binding {
        match formula {
            Formula::Holds(Predicate::Comparison(_)) => Binding::Comparison,
            Formula::Holds(Predicate::All(parts)) if !parts.is_empty() => Binding::Conjunction,
            Formula::Holds(Predicate::Any(parts)) if !parts.is_empty() => Binding::Disjunction,
            Formula::Holds(_) => Binding::Prefix,
            Formula::All(parts) | Formula::Any(parts) if parts.is_empty() => Binding::Prefix,
            Formula::All(_) => Binding::Conjunction,
            Formula::Any(_) => Binding::Disjunction,
            Formula::Implies(..) => Binding::Implication,
            Formula::Until(..) => Binding::Until,
            Formula::Not(_) | Formula::Always(..) | Formula::Eventually(..) => Binding::Prefix,
        }
    }
}

struct Printer<'a> {
    out: &'a mut dyn Write,
    notation: &'static Notation,
}

impl Printer<'_> {
    fn formula(&mut self, formula: &Formula) -> fmt::Result {
        match formula {
            Formula::Holds(predicate) => self.out.write_str(&(self.notation.predicate)(predicate)),
            Formula::Not(inner) => {
                self.out.write_str(self.notation.not)?;
                self.part(inner, Binding::Prefix)
            }
            Formula::All(parts) if parts.is_empty() => self.out.write_str(self.notation.truth),
            Formula::Any(parts) if parts.is_empty() => self.out.write_str(self.notation.falsehood),
            Formula::All(parts) => self.joined(parts, self.notation.and, Binding::Comparison),
            Formula::Any(parts) => self.joined(parts, self.notation.or, Binding::Conjunction),
            Formula::Implies(first, second) => {
                self.part(first, Binding::Disjunction)?;
                self.out.write_str(self.notation.implies)?;
                self.part(second, Binding::Disjunction)
            }
            Formula::Always(window, inner) => self.prefixed(self.notation.always, *window, inner),
            Formula::Eventually(window, inner) => {
                self.prefixed(self.notation.eventually, *window, inner)
            }
            Formula::Until(window, first, second) => {
                self.part(first, Binding::Prefix)?;
                self.out.write_char(' ')?;
                self.prefixed(self.notation.until, *window, second)
            }
        }
    }

    fn prefixed(&mut self, symbol: &str, window: Window, inner: &Formula) -> fmt::Result {
        self.out.write_str(symbol)?;
        if window != Window::UNBOUNDED {
            let (open, close) = self.notation.subscript;
            self.out.write_str(open)?;
            self.interval(window)?;
            self.out.write_str(close)?;
        }
        self.out.write_char(' ')?;
        self.part(inner, Binding::Prefix)
    }

    fn interval(&mut self, window: Window) -> fmt::Result {
        let number = self.notation.number;
        let close = if window.end().is_finite() { ']' } else { ')' };
        write!(self.out, "[{}, {}{close}", number(window.start()), number(window.end()))
    }

    fn joined(&mut self, parts: &[Formula], separator: &str, least: Binding) -> fmt::Result {
        for (position, part) in parts.iter().enumerate() {
            if position > 0 {
                self.out.write_str(separator)?;
            }
            self.part(part, least)?;
        }
        Ok(())
    }

    fn part(&mut self, part: &Formula, least: Binding) -> fmt::Result {
        if Binding::of(part) >= least {
            return self.formula(part);
        }
        let (open, close) = self.notation.parentheses;
        self.out.write_str(open)?;
        self.formula(part)?;
        self.out.write_str(close)
    }
}

#[cfg(test)]
mod tests {
    use super::super::formula::{always, eventually, not, within};
    use super::*;
    use pleach_guards::variable;

    #[test]
    fn parentheses_appear_where_the_structure_needs_them() {
        let low = || Formula::holds(variable("x").at_most(1.0));
        let high = || Formula::holds(variable("x").at_least(2.0).and(variable("y").more_than(0.0)));
        let (soon, ever) = (within(0.5, 2.0).unwrap(), Window::UNBOUNDED);
        let late = within(1.0, f64::INFINITY).unwrap();
        let cases = [
            (always(soon, low()), "□[0.5, 2] (x ≤ 1)"),
            (always(ever, eventually(late, low())), "□ ◇[1, ∞) (x ≤ 1)"),
            (low().until(soon, high()), "(x ≤ 1) 𝒰[0.5, 2] (x ≥ 2 ∧ y > 0)"),
            (not(low().until(ever, low())), "¬((x ≤ 1) 𝒰 (x ≤ 1))"),
            (low().and(not(high())), "x ≤ 1 ∧ ¬(x ≥ 2 ∧ y > 0)"),
            (low().or(high()).and(low()), "(x ≤ 1 ∨ x ≥ 2 ∧ y > 0) ∧ x ≤ 1"),
            (low().implies(low().implies(low())), "x ≤ 1 → (x ≤ 1 → x ≤ 1)"),
            (Formula::All([].into()), "true"),
        ];
        for (formula, text) in cases {
            assert_eq!(formula.to_string(), text);
        }
        let latex = low().until(late, low()).to_latex();
        let expected = r"\left(x \le 1\right) \mathcal{U}_{[1, \infty)} \left(x \le 1\right)";
        assert_eq!(latex, expected);
    }
}
