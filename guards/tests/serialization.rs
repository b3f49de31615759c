//! Expressions, predicates and guards go through JSON and come back the same.

use crate::common::{odd_expressions, odd_predicates};
use pleach_guards::{Expression, Guard, Predicate, variable};
use proptest::prelude::*;

proptest! {
    #[test]
    fn expressions_come_back(expression in odd_expressions()) {
        let text = serde_json::to_string(&expression)?;
        prop_assert_eq!(serde_json::from_str::<Expression>(&text)?, expression);
    }

    #[test]
    fn guards_come_back(name in ".*", predicate in odd_predicates()) {
        let guard = Guard::new(&name, predicate);
        let value = serde_json::to_value(&guard)?;
        prop_assert_eq!(serde_json::from_value::<Guard>(value)?, guard);
    }
}

#[test]
fn text_is_what_is_stored() {
    let predicate = variable("x").power(2.0).at_most(1.5);
    let text = serde_json::to_string(&predicate).expect("data");
    assert_eq!(text, r#""x² ≤ 1.5""#);
    let guards: Vec<Guard> =
        serde_json::from_str(r#"[{"name": "near", "predicate": "x^2 <= 1.5"}]"#).expect("guards");
    assert_eq!(guards, [Guard::new("near", predicate)]);
}

#[test]
fn a_function_is_refused_by_name() {
    let grasped = Predicate::function("grasped", |_| Ok(0.0));
    let guard = Guard::new("held", grasped.and(variable("x").at_most(1.0)));
    let error = serde_json::to_string(&guard).expect_err("a function");
    let expected = "the predicate `grasped(…) ∧ x ≤ 1` cannot be stored: \
                    `grasped` is a function and not data";
    assert_eq!(error.to_string(), expected);
}

#[test]
fn errors_name_the_text_and_the_place() {
    let error = serde_json::from_str::<Predicate>(r#""x ≤ ""#).expect_err("half a comparison");
    let expected = "`x ≤ ` is not a predicate: column 5: expected a number, a name, `(`, `|`, `√` \
                    or `−`, found the end at line 1 column 8";
    assert_eq!(error.to_string(), expected);
    let error = serde_json::from_str::<Expression>("3").expect_err("not a string");
    assert!(error.to_string().contains("expected an expression as text"), "{error}");
    let guard = r#"{"name": "a", "predicate": "always", "margin": 1}"#;
    assert!(serde_json::from_str::<Guard>(guard).is_err());
}
