//! What is printed, read back by an independent reader, is the structure that was printed.

mod common;

use common::{expressions, predicates};
use pleach_guards::{Expression, Predicate, always, constant, never, not, variable};
use proptest::prelude::*;

proptest! {
    #[test]
    fn expressions_read_back(expression in expressions()) {
        let text = expression.to_string();
        let mut reader = Reader { rest: &text };
        prop_assert_eq!(reader.sum(), Some(expression), "{}", text);
        prop_assert_eq!(reader.rest, "", "{}", text);
    }

    #[test]
    fn predicates_read_back(predicate in predicates()) {
        let text = predicate.to_string();
        let mut reader = Reader { rest: &text };
        prop_assert_eq!(reader.disjunction(), Some(predicate), "{}", text);
        prop_assert_eq!(reader.rest, "", "{}", text);
    }

    #[test]
    fn latex_closes_what_it_opens(predicate in predicates()) {
        let latex = predicate.to_latex();
        let count = |part: &str| latex.matches(part).count();
        prop_assert_eq!(count("{"), count("}"), "{}", &latex);
        prop_assert_eq!(count(r"\left"), count(r"\right"), "{}", &latex);
    }
}

#[test]
fn parentheses_stand_only_where_structure_needs_them() {
    let [a, b, c] = ["a", "b", "c"].map(variable);
    let cases = [
        (&a + &b - &c, "a + b − c"),
        (&a - (&b - &c), "a − (b − c)"),
        (&a * (&b + &c), "a · (b + c)"),
        (-(&a * &b), "−a · b"),
        (-&a * &b, "(−a) · b"),
        (&a + (-&b), "a + (−b)"),
        ((&a + &b).abs().power(2.0), "|a + b|²"),
        (a.power(-12.0), "a⁻¹²"),
        (a.power(1.5), "a^1.5"),
        ((&a + &b).min(-&c), "min(a + b, −c)"),
        (2.0 / a.square_root(), "2 ÷ √a"),
    ];
    for (expression, expected) in cases {
        assert_eq!(expression.to_string(), expected);
    }
}

#[test]
fn logic_prints_with_its_precedence() {
    let [a, b, c] = ["a", "b", "c"].map(|name| variable(name).at_most(1.0));
    let mixed = a.clone().or(b.clone()).and(not(c.clone()));
    assert_eq!(mixed.to_string(), "(a ≤ 1 ∨ b ≤ 1) ∧ ¬(c ≤ 1)");
    assert_eq!(a.or(b.and(c)).to_string(), "a ≤ 1 ∨ b ≤ 1 ∧ c ≤ 1");
}

#[test]
fn latex_uses_its_commands() {
    let [speed, limit] = ["speed", "σ_max"].map(variable);
    let slow = (&speed * 2.0).power(2.0).less_than(limit.square_root());
    let text = r"\left(\mathit{speed} \cdot 2\right)^{2} < \sqrt{\sigma_{\mathit{max}}}";
    assert_eq!(slow.to_latex(), text);
    assert_eq!(not(always()).to_latex(), r"\lnot \top");
}

/// A reader of the printed text, by recursive descent.
struct Reader<'a> {
    rest: &'a str,
}

impl Reader<'_> {
    fn take(&mut self, token: &str) -> bool {
        match self.rest.strip_prefix(token) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn disjunction(&mut self) -> Option<Predicate> {
        let mut parts = vec![self.conjunction()?];
        while self.take(" ∨ ") {
            parts.push(self.conjunction()?);
        }
        Some(Predicate::any(parts))
    }

    fn conjunction(&mut self) -> Option<Predicate> {
        let mut parts = vec![self.clause()?];
        while self.take(" ∧ ") {
            parts.push(self.clause()?);
        }
        Some(Predicate::all(parts))
    }

    fn clause(&mut self) -> Option<Predicate> {
        if self.take("¬") {
            return self.negatable().map(not);
        }
        let start = self.rest;
        if let Some(comparison) = self.comparison() {
            return Some(comparison);
        }
        self.rest = start;
        self.negatable()
    }

    fn negatable(&mut self) -> Option<Predicate> {
        if self.take("always") {
            Some(always())
        } else if self.take("never") {
            Some(never())
        } else if self.take("¬") {
            self.negatable().map(not)
        } else if self.take("(") {
            let inner = self.disjunction()?;
            self.take(")").then_some(inner)
        } else {
            None
        }
    }

    fn comparison(&mut self) -> Option<Predicate> {
        let left = self.sum()?;
        if self.take(" ≤ ") {
            Some(left.at_most(self.sum()?))
        } else if self.take(" < ") {
            Some(left.less_than(self.sum()?))
        } else if self.take(" ≥ ") {
            Some(left.at_least(self.sum()?))
        } else if self.take(" > ") {
            Some(left.more_than(self.sum()?))
        } else {
            None
        }
    }

    fn sum(&mut self) -> Option<Expression> {
        let mut sum = if self.take("−") { -self.product()? } else { self.product()? };
        loop {
            if self.take(" + ") {
                sum = sum + self.product()?;
            } else if self.take(" − ") {
                sum = sum - self.product()?;
            } else {
                return Some(sum);
            }
        }
    }

    fn product(&mut self) -> Option<Expression> {
        let mut product = self.power()?;
        loop {
            if self.take(" · ") {
                product = product * self.power()?;
            } else if self.take(" ÷ ") {
                product = product / self.power()?;
            } else {
                return Some(product);
            }
        }
    }

    fn power(&mut self) -> Option<Expression> {
        if self.take("√") {
            return Some(self.atom()?.square_root());
        }
        let base = self.atom()?;
        if self.take("^(−") {
            let exponent = self.number()?;
            return self.take(")").then(|| base.power(-exponent));
        }
        if self.take("^") {
            return Some(base.power(self.number()?));
        }
        let sign = if self.take("⁻") { -1.0 } else { 1.0 };
        let mut exponent = None;
        while let Some(digit) = self
            .rest
            .chars()
            .next()
            .and_then(|raised| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().position(|c| c == raised))
        {
            self.rest = self.rest.char_indices().nth(1).map_or("", |(at, _)| &self.rest[at..]);
            exponent = Some(exponent.unwrap_or(0.0) * 10.0 + digit as f64);
        }
        Some(match exponent {
            Some(exponent) => base.power(sign * exponent),
            None => base,
        })
    }

    fn atom(&mut self) -> Option<Expression> {
        if self.take("(") {
            let inner = self.sum()?;
            return self.take(")").then_some(inner);
        }
        if self.take("|") {
            let inner = self.sum()?;
            return self.take("|").then(|| inner.abs());
        }
        for name in ["x", "y", "δ"] {
            if self.take(name) {
                return Some(variable(name));
            }
        }
        let smaller = self.take("min(");
        if smaller || self.take("max(") {
            let left = self.sum()?;
            let right = if self.take(", ") { self.sum()? } else { return None };
            let pair = if smaller { left.min(right) } else { left.max(right) };
            return self.take(")").then_some(pair);
        }
        self.number().map(constant)
    }

    fn number(&mut self) -> Option<f64> {
        let end = self
            .rest
            .find(|letter: char| !letter.is_ascii_digit() && letter != '.')
            .unwrap_or(self.rest.len());
        let (digits, rest) = self.rest.split_at(end);
        let value = digits.parse().ok()?;
        self.rest = rest;
        Some(value)
    }
}
