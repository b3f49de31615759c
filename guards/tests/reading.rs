//! Reading undoes printing; other spellings; and what a text that cannot be read is told.

use std::thread;

use crate::common::{odd_expressions, odd_predicates, predicates};
use pleach_guards::{
    Expression, ParseError, Predicate, always, constant, never, not, proposition, variable,
};
use proptest::prelude::*;

proptest! {
    #![proptest_config(cases::usually(1000))]

    #[test]
    fn expressions_read_back(expression in odd_expressions()) {
        let text = expression.to_string();
        prop_assert_eq!(text.parse(), Ok(expression), "{}", text);
    }

    #[test]
    fn predicates_read_back(predicate in odd_predicates()) {
        let text = predicate.to_string();
        prop_assert_eq!(text.parse(), Ok(predicate), "{}", text);
    }

    #[test]
    fn spaces_mean_nothing(predicate in predicates()) {
        let dense = predicate.to_string().replace(' ', "");
        prop_assert_eq!(dense.parse(), Ok(predicate), "{}", dense);
    }

    #[test]
    fn no_text_is_too_odd(text in SCRAPS) {
        let places = 1..=text.chars().count() + 1;
        if let Err(error) = text.parse::<Predicate>() {
            prop_assert!(places.contains(&error.column()), "{}: {}", text, error);
        }
        if let Ok(expression) = text.parse::<Expression>() {
            // NaN differs from itself, but not its text.
            let printed = expression.to_string();
            let again = printed.parse::<Expression>().map(|again| again.to_string());
            prop_assert_eq!(again, Ok(printed));
        }
    }
}

/// Signs, letters and words of the language in any order.
const SCRAPS: &str =
    "([a-z0-9. ()|,√²⁻^+−·÷<>=≤≥¬∧∨…`∞!&]|x|x ≤ |and|not|min\\(|always|[0-9]){0,16}";

#[test]
fn ascii_reads_as_unicode_does() {
    let pairs = [
        ("x<=1&&y>=2", "x ≤ 1 ∧ y ≥ 2"),
        ("x < 1 and not (y > 2) or never", "x < 1 ∧ ¬(y > 2) ∨ never"),
        ("!(x <= 1) || !!always", "¬(x ≤ 1) ∨ ¬¬always"),
        ("abs(x) <= sqrt(y) / 2", "|x| ≤ √y ÷ 2"),
        ("x^2 - 1e-3*y^-1 > x^(-0.5)", "x² − 0.001 · y⁻¹ > x^(−0.5)"),
        ("x <= -infinity", "x ≤ −∞"),
        ("x * -2 < y - -z", "x · (−2) < y − (−z)"),
        ("||x| - 1| < 1 || |y| < ||x||", "||x| − 1| < 1 ∨ |y| < ||x||"),
        ("sqrt(x)^2 < sqrt(x^2)", "(√x)² < √(x²)"),
        ("((x)) <= (((y + 1)) * 2)", "x ≤ (y + 1) · 2"),
        ("((x <= 1))", "x ≤ 1"),
        ("min(x, 2) < max (x, y)", "min(x, 2) < max(x, y)"),
        ("min < max", "min < max"),
        ("`min` < `not`", "min < `not`"),
    ];
    for (ascii, unicode) in pairs {
        let read = ascii.parse::<Predicate>().map(|predicate| predicate.to_string());
        assert_eq!(read.as_deref(), Ok(unicode), "{ascii}");
    }
}

#[test]
fn operators_bind_as_in_mathematics() {
    let [x, y, z] = ["x", "y", "z"].map(variable);
    let cases = [
        ("x - y - z", &x - &y - &z),
        ("x / y * z", &x / &y * &z),
        ("x + y * z", &x + &y * &z),
        ("-x^2", -x.power(2.0)),
        ("-x * y", -(&x * &y)),
        ("-2", constant(-2.0)),
        ("-2 * x", -2.0 * &x),
        ("-2^2 * x", -(constant(2.0).power(2.0) * &x)),
        ("-(2 * x)", -(2.0 * &x)),
        ("2 * -x^2", 2.0 * -x.power(2.0)),
        ("sin(x) + cos(y)", x.sin() + y.cos()),
        ("exp(ln(x))", x.ln().exp()),
    ];
    for (text, expected) in cases {
        assert_eq!(text.parse(), Ok(expected), "{text}");
    }
    let [a, b, c] = ["a", "b", "c"].map(|name| variable(name).at_most(1.0));
    let read = "a <= 1 or b <= 1 and not (c <= 1)".parse();
    assert_eq!(read, Ok(a.clone().or(b.clone().and(not(c.clone())))));
    let read = "(a <= 1 or b <= 1) and (always and c <= 1)".parse();
    let inner = Predicate::All([always(), c].into());
    assert_eq!(read, Ok(Predicate::All([a.or(b), inner].into())));
    assert_eq!("never".parse(), Ok(never()));
    assert_eq!("(never or always)".parse(), Ok(Predicate::Any([never(), always()].into())));
    assert_eq!("((not always))".parse(), Ok(not(always())));
}

#[test]
fn what_is_not_a_number_reads_back_as_such() {
    for value in [f64::NAN, -f64::NAN] {
        let read = constant(value).to_string().parse::<Expression>();
        assert!(matches!(read, Ok(Expression::Constant(value)) if value.is_nan()), "{read:?}");
    }
}

#[test]
fn errors_say_where_and_what() {
    let operand = "a number, a name, `(`, `|`, `√` or `−`";
    let relation = "`≤`, `<`, `≥` or `>` (for equality, compare |a − b| with a tolerance)";
    let cases = [
        ("", 1, operand, ""),
        ("x + 1", 6, relation, ""),
        ("x = 3", 3, relation, "="),
        ("x == 3", 3, relation, "=="),
        ("x ≤", 4, operand, ""),
        ("δ ≤ ) ", 5, operand, ")"),
        ("x ≤ 1 y", 7, "an operator or the end", "y"),
        ("0 ≤ x ≤ 1", 7, "an operator or the end", "≤"),
        ("(x ≤ 1", 7, "an operator or `)`", ""),
        ("|x ≤ 1", 4, "an operator or `|`", "≤"),
        ("¬x ≤ 1", 2, "`(`, `¬`, `always`, `never` or the name of a proposition", "x"),
        ("x & y", 3, "`&&` or `∧`", "&"),
        ("x ≤ $", 5, "a number, a name, an operator or a parenthesis", "$"),
        ("x ≤ 1e", 5, "a number", "1e"),
        ("x ≤ 1e999", 5, "a number of at most 1.7976931348623157e308, or `∞`", "1e999"),
        ("x⁻ ≤ 1", 2, "raised digits", "⁻"),
        ("x^y ≤ 1", 3, "a number as the exponent", "y"),
        ("x^(2 ≤ 1", 6, "`)` after the exponent", "≤"),
        ("√x² ≤ 1", 3, "parentheses that say which is first, root or power", "²"),
        (
            "sec(x) ≤ 1",
            1,
            "a function: abs, sqrt, sin, cos, tan, tanh, atan2, exp, ln, sign, floor, min, max, if, linear or steps",
            "sec",
        ),
        ("min(x) ≤ 1", 6, "an operator or `,`", ")"),
        ("`x ≤ 1", 1, "a closing backtick", "`x ≤ 1"),
        ("(x = 3)", 4, relation, "="),
        ("(far(…))", 2, "a comparison (a function can be given by code only)", "far"),
        ("y ≤ 1 ∧ far(…)", 9, "a comparison (a function can be given by code only)", "far"),
    ];
    for (text, column, expected, found) in cases {
        let error = text.parse::<Predicate>().expect_err(text);
        assert_eq!((error.column(), error.expected(), error.found()), (column, expected, found));
    }
    let error = "x ≤ 1".parse::<Expression>().expect_err("a predicate");
    assert_eq!(error.to_string(), "column 3: expected an operator or the end, found `≤`");
    let error = "x +".parse::<Expression>().expect_err("half a sum");
    assert_eq!(error.to_string(), format!("column 4: expected {operand}, found the end"));
}

/// A name that stands where a comparison could is a proposition.
#[test]
fn propositions_are_names_by_themselves() {
    let text = "leads ∧ ¬`two words` ∨ (engaged ∧ x ≤ 1)";
    let leads = proposition("leads").and(!proposition("two words"));
    let expected = leads.or(proposition("engaged").and(variable("x").at_most(1.0)));
    assert_eq!(text.parse(), Ok(expected.clone()));
    assert_eq!("leads && not `two words` || (engaged && x <= 1)".parse(), Ok(expected.clone()));
    assert_eq!(expected.to_string().parse(), Ok(expected));
    let [p, q] = ["p", "q"].map(proposition);
    let either = p.clone().or(q.clone());
    let cases = [
        ("(p || q)", either.clone()),
        ("((p) || q)", either.clone()),
        ("(p || q) && q", either.clone().and(q.clone())),
        ("q || (p || q)", Predicate::Any([q.clone(), either].into())),
        ("(p) && q", p.clone().and(q.clone())),
        ("((p)) or q", p.clone().or(q)),
        ("(p) <= 1 && p", variable("p").at_most(1.0).and(p)),
    ];
    for (text, expected) in cases {
        assert_eq!(text.parse(), Ok(expected), "{text}");
    }
}

/// Nesting counts what is open, not what was.
#[test]
fn what_stands_side_by_side_is_not_nested() {
    for part in ["(x) + ", "|x| + ", "sin(x) + ", "min(x, x) + ", "√(x) + ", "1 - -x + "] {
        let text = part.repeat(120) + "x";
        assert!(text.parse::<Expression>().is_ok(), "{part}");
    }
    let text = "¬(x ≤ 1) ∧ ".repeat(120) + "x ≤ 1";
    assert!(text.parse::<Predicate>().is_ok());
}

/// The least stack that is common, of the main thread on Windows: 1 MiB.
const SMALL_STACK: usize = 1024 * 1024;

#[test]
fn no_text_overflows_the_stack() {
    let test = || {
        let limits = [
            ("x + ".repeat(1000) + "x", "x + ".repeat(1001) + "x"),
            (enclosed("(", 100, "x", ")"), enclosed("(", 101, "x", ")")),
            (enclosed("|", 100, "x", "|"), enclosed("|", 101, "x", "|")),
            (enclosed("sin(", 100, "x", ")"), enclosed("max(", 101, "x", ", x)")),
            (enclosed("x - (", 100, "x", ")"), enclosed("x - (", 200_000, "x", ")")),
            ("-".repeat(50) + "x", "-".repeat(101) + "x"),
            ("√(".repeat(50) + "x" + &")".repeat(50), "√(".repeat(51) + "x" + &")".repeat(51)),
        ];
        for (allowed, refused) in limits {
            let deep: Result<Expression, _> = allowed.parse();
            let deep = deep.expect("within the limits");
            assert!(deep.evaluate(&[("x", 0.5)]).is_ok());
            assert_eq!(deep.to_string().parse(), Ok(deep));
            assert!(refused.parse::<Expression>().is_err(), "{}", refused.len());
        }
        let nested = "¬(".repeat(50) + &"x + ".repeat(1000) + "x ≤ 1" + &")".repeat(50);
        let deep: Predicate = nested.parse().expect("within the limits");
        assert!(deep.holds(&[("x", 0.5)]).is_ok());
        assert_eq!(deep.to_string().parse(), Ok(deep));
        let too_deep: Result<Predicate, ParseError> = "(".repeat(1_000_000).parse();
        let error = too_deep.expect_err("beyond the limits");
        assert_eq!((error.column(), error.expected()), (102, "at most 100 levels of nesting"));
        assert!("¬".repeat(1_000_000).parse::<Predicate>().is_err());
        assert!(("x ≤ 1".to_owned() + &" ∧ x ≤ 1".repeat(10_000)).parse::<Predicate>().is_ok());
    };
    let thread = thread::Builder::new().stack_size(SMALL_STACK).spawn(test);
    thread.expect("a thread starts").join().expect("the test passes");
}

fn enclosed(open: &str, times: usize, inner: &str, close: &str) -> String {
    open.repeat(times) + inner + &close.repeat(times)
}
