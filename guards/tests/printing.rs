//! How expressions and predicates print; that they read back is tested with the reader.

use crate::common::predicates;
use pleach_guards::{Predicate, always, constant, not, variable};
use proptest::prelude::*;

proptest! {
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
        (-2.0 * &a / &b, "−2 · a ÷ b"),
        (&a + (-2.0 * &b), "a + (−2 · b)"),
        ((&a + &b).abs().power(2.0), "|a + b|²"),
        (a.power(-12.0), "a⁻¹²"),
        (a.power(1.5), "a^1.5"),
        ((&a + &b).min(-&c), "min(a + b, −c)"),
        (2.0 / a.square_root(), "2 ÷ √a"),
        ((&a + &b).sin() * a.exp().ln().power(2.0), "sin(a + b) · ln(exp(a))²"),
        (-constant(2.0).cos(), "−cos(2)"),
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
fn names_that_are_not_plain_stand_between_backticks() {
    let plain = ["end_announced", "heater.temperature", "δ_0", "x₁", "x′", "τ̇", "h2", "min", "_"];
    for name in plain {
        assert_eq!(variable(name).to_string(), name);
    }
    let others = ["path heard", "2nd", "x²", "a-b", "not", "infinity", "NaN", "", ".x"];
    for name in others {
        assert_eq!(variable(name).to_string(), format!("`{name}`"));
    }
    assert_eq!(variable("a`b").to_string(), "`a``b`");
    assert_eq!(variable("path heard").to_latex(), r"\mathit{path\ heard}");
}

#[test]
fn functions_print_their_name() {
    let grasped = Predicate::function("grasped", |_| Ok(0.0));
    let free = not(grasped).and(variable("x").at_most(1.0));
    assert_eq!(free.to_string(), "¬grasped(…) ∧ x ≤ 1");
    assert_eq!(free.to_latex(), r"\lnot \mathit{grasped}\left(\ldots\right) \land x \le 1");
}

#[test]
fn greek_letters_become_their_commands() {
    let letters = "αβγδεζηθκλμνξπρστφχψωΓΔΘΛΣΦΨΩ";
    let names = "alpha beta gamma delta varepsilon zeta eta theta kappa lambda mu nu xi pi rho \
                 sigma tau varphi chi psi omega Gamma Delta Theta Lambda Sigma Phi Psi Omega";
    for (letter, name) in letters.chars().zip(names.split(' ')) {
        assert_eq!(variable(&letter.to_string()).to_latex(), format!("\\{name}"));
        let word = variable(&format!("a{letter}")).to_latex();
        assert_eq!(word, format!("\\mathit{{a\\{name} }}"));
    }
}

#[test]
fn latex_subscripts_are_numbers_letters_or_words() {
    let cases = [
        ("x_12", "x_{12}"),
        ("x_i", "x_{i}"),
        ("x_a1", r"x_{\mathit{a1}}"),
        ("x_a_b", r"x_{\mathit{a\_b}}"),
        ("50%", r"\mathit{50\%}"),
    ];
    for (name, expected) in cases {
        assert_eq!(variable(name).to_latex(), expected);
    }
}

#[test]
fn latex_uses_its_commands() {
    let [speed, limit] = ["speed", "σ_max"].map(variable);
    let slow = (&speed * 2.0).power(2.0).less_than(limit.square_root());
    let text = r"\left(\mathit{speed} \cdot 2\right)^{2} < \sqrt{\sigma_{\mathit{max}}}";
    assert_eq!(slow.to_latex(), text);
    assert_eq!(not(always()).to_latex(), r"\lnot \top");
    assert_eq!(variable("θ").sin().to_latex(), r"\sin\left(\theta\right)");
    assert_eq!(speed.exp().ln().to_latex(), r"\ln\left(\exp\left(\mathit{speed}\right)\right)");
}
