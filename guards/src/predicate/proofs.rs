//! Margins and verdicts say the same, however predicates are combined.

use super::*;

/// Any verdict that agrees with its margin.
fn any_verdict() -> Verdict {
    let verdict = Verdict { margin: kani::any(), holds: kani::any() };
    kani::assume(verdict.is_consistent());
    verdict
}

fn is_same(one: Verdict, other: Verdict) -> bool {
    one.holds == other.holds && one.margin == other.margin
}

/// Any three verdicts with any margins but NaN: conjunction, disjunction and negation stay
/// consistent, the order of parts does not matter, and a double negation is none.
#[kani::proof]
#[kani::unwind(2)]
fn logic_keeps_margins_and_verdicts_together() {
    let (one, other, third) = (any_verdict(), any_verdict(), any_verdict());
    kani::cover!(one.margin == f64::INFINITY && other.margin < 0.0 && third.margin == 0.0);
    assert!(one.and(other).is_consistent() && one.or(other).is_consistent());
    assert!(one.opposite().is_consistent() && is_same(one.opposite().opposite(), one));
    assert!(is_same(one.and(other), other.and(one)));
    assert!(is_same(one.and(other.and(third)), one.and(other).and(third)));
    assert!(is_same(one.or(other.or(third)), one.or(other).or(third)));
}

/// Any two verdicts: not both is one of the two not, and not one of the two is both not.
#[kani::proof]
#[kani::unwind(2)]
fn negation_follows_de_morgan() {
    let (one, other) = (any_verdict(), any_verdict());
    kani::cover!(one.and(other).holds);
    assert!(is_same(one.and(other).opposite(), one.opposite().or(other.opposite())));
    assert!(is_same(one.or(other).opposite(), one.opposite().and(other.opposite())));
}

/// Any two whole numbers from −8 to 7, and any relation: its verdict agrees with its margin, and
/// the opposite relation gives the opposite verdict.
#[kani::proof]
#[kani::unwind(2)]
fn comparisons_agree_with_their_margins() {
    let number = || kani::any_where(|number: &i8| (-8..8).contains(number));
    let (left, right) = (number(), number());
    let (minuend, subtrahend) = (f64::from(left), f64::from(right));
    let judge = |relation: Relation| relation.judge(minuend, subtrahend);
    let (at_most, less) = (judge(Relation::AtMost), judge(Relation::LessThan));
    let (at_least, more) = (judge(Relation::AtLeast), judge(Relation::MoreThan));
    kani::cover!(left == right);
    assert!(at_most.is_consistent() && less.is_consistent());
    assert!(at_least.is_consistent() && more.is_consistent());
    assert!(is_same(at_most.opposite(), more) && is_same(less.opposite(), at_least));
    assert!((at_most.margin > 0.0) == (left < right));
}
