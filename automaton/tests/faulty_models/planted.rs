//! Automata with one fault each.

use pleach_automaton::check::{Kind, Severity};
use pleach_automaton::from;
use pleach_guards::{Expression, always, constant, norm, piecewise};

use super::Cue::{Back, Go, On, Turn};
use super::Room::{A, B, C};
use super::confirm::confirm;
use super::{Parts, Point, faults, machine};

/// The model has exactly these errors and warnings, and what they show is so.
fn check(parts: Parts, expected: &[&str]) {
    let machine = parts.build().expect("the parts fit");
    let report = machine.check();
    assert_eq!(faults(&report), expected, "{report}");
    for finding in report.findings().iter().filter(|one| one.severity < Severity::Note) {
        confirm(&machine, finding);
    }
}

/// All locations can be reached, so that this is not what is found: a tour that takes its time.
fn tour() -> Parts {
    let Point { x, .. } = Point::coordinates();
    machine()
        .flow(A, x.rate(1.0))
        .flow(B, x.rate(1.0))
        .flow(C, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(1.0)))
        .transition(from(B).on(Go).to(C).must(x.at_least(2.0)))
        .transition(from(C).on(Go).to(A).must(x.at_least(3.0)).then(x.becomes(0.0)))
}

#[test]
fn the_tour_is_sound() {
    check(tour(), &[]);
}

// ---- Overlap and priority ----------------------------------------------------------------------

#[test]
fn guards_that_hold_together() {
    let Point { y, .. } = Point::coordinates();
    let parts = tour().transition(from(A).on(Turn).to(C).must(y.at_most(5.0)));
    check(parts, &["warning: overlap: location `a`, on `go` and `turn`"]);
}

#[test]
fn guards_that_touch_in_one_point() {
    let Point { x, .. } = Point::coordinates();
    let parts = tour().transition(from(A).on(Turn).to(C).must(x.at_most(1.0) & x.at_least(0.5)));
    check(parts, &["warning: overlap: location `a`, on `go` and `turn`"]);
}

#[test]
fn guards_that_exclude_each_other_do_not_overlap() {
    let Point { x, .. } = Point::coordinates();
    check(tour().transition(from(A).on(Turn).to(C).may(x.less_than(1.0))), &[]);
    check(tour().transition(from(A).on(Turn).to(C).must(x.less_than(-1.0))), &[]);
}

#[test]
fn curved_guards_that_hold_together() {
    let Point { x, y } = Point::coordinates();
    let far = norm([x.clone().into(), y.clone().into()]).at_least(10.0);
    let low = (&y * &y).at_least(99.0) & x.at_most(0.5);
    let parts = tour()
        .transition(from(B).on(Turn).to(A).must(far & x.less_than(2.0)).then(x.becomes(0.0)))
        .transition(from(B).on(Back).to(C).must(low));
    check(parts, &["warning: overlap: location `b`, on `turn` and `back`"]);
}

#[test]
fn the_same_end_is_no_overlap() {
    let Point { y, .. } = Point::coordinates();
    check(tour().transition(from(A).on(Turn).to(B).must(y.at_least(5.0))), &[]);
}

#[test]
fn priorities_settle_overlaps() {
    let Point { y, .. } = Point::coordinates();
    let turn = from(A).on(Turn).to(C).must(y.at_least(5.0)).priority(1);
    check(tour().transition(turn), &[]);
}

#[test]
fn priorities_that_hide_a_transition() {
    let Point { x, .. } = Point::coordinates();
    let turn = from(A).on(Turn).to(C).must(x.at_least(2.0)).priority(1);
    check(tour().transition(turn), &["warning: shadowed priority: location `a`, on `turn`"]);
}

// ---- What never happens ------------------------------------------------------------------------

#[test]
fn guards_outside_the_ranges() {
    let Point { y, .. } = Point::coordinates();
    let parts = tour().transition(from(A).on(Turn).to(C).may(y.at_least(200.0)));
    check(parts, &["warning: never fires: location `a`, on `turn`"]);
}

#[test]
fn guards_that_contradict_themselves() {
    let Point { x, y } = Point::coordinates();
    let parts = tour().transition(from(B).on(Turn).to(A).must(x.at_least(&y) & x.less_than(&y)));
    check(parts, &["warning: never fires: location `b`, on `turn`"]);
}

#[test]
fn guards_outside_the_invariant() {
    let Point { x, .. } = Point::coordinates();
    let parts = tour()
        .invariant(B, x.at_most(5.0))
        .transition(from(B).on(Turn).to(A).may(x.more_than(6.0)));
    check(parts, &["warning: never fires: location `b`, on `turn`"]);
}

#[test]
fn guards_behind_another_that_must_be_taken() {
    let Point { x, .. } = Point::coordinates();
    let parts = tour().transition(from(C).on(Turn).to(B).may(x.at_least(4.0)));
    check(parts, &["warning: never fires: location `c`, on `turn`"]);
}

#[test]
fn strict_guards_fire_beyond_their_boundary() {
    let Point { x, .. } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .flow(B, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(x.more_than(1.0)))
        .transition(from(B).on(Go).to(C).must(x.more_than(2.0)));
    check(parts, &[]);
}

#[test]
fn locations_without_a_way_in() {
    let Point { x, .. } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .transition(from(A).on(Go).to(C).must(x.at_least(1.0)))
        .transition(from(B).on(Go).to(A).must(x.at_least(2.0)));
    check(parts, &["warning: unreachable: location `b`"]);
}

#[test]
fn locations_behind_what_never_happens() {
    let Point { x, .. } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(1.0)))
        .transition(from(A).on(Turn).to(C).may((&x * &x).less_than(-1.0)));
    let expected =
        ["warning: never fires: location `a`, on `turn`", "warning: unreachable: location `c`"];
    check(parts, &expected);
}

// ---- Blocking ----------------------------------------------------------------------------------

#[test]
fn guards_beyond_the_invariant_block() {
    let Point { x, .. } = Point::coordinates();
    check(
        tour().invariant(A, x.less_than(0.5)),
        &[
            "error: blocked: location `a`",
            "warning: never fires: location `a`, on `go`",
            "warning: unreachable: location `b`",
            "warning: unreachable: location `c`",
        ],
    );
}

#[test]
fn guards_that_forget_slow_states_block() {
    let Point { x: height, y: velocity } = Point::coordinates();
    let fast = height.at_most(0.0) & velocity.less_than(-0.1);
    let parts = machine()
        .flow(A, height.rate(1.0))
        .flow(B, [height.rate(&velocity), velocity.rate(-9.81)])
        .invariant(B, height.at_least(0.0))
        .transition(from(A).on(Go).to(B).must(height.at_least(1.0)))
        .transition(from(A).on(Turn).to(C).may(height.at_least(0.5)))
        .transition(from(B).on(Turn).to(B).must(fast).then(velocity.becomes(-0.8 * &velocity)));
    check(parts, &["error: blocked: location `b`"]);
}

#[test]
fn invariants_without_a_way_out_block() {
    let Point { x, .. } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .flow(B, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(1.0)))
        .transition(from(A).on(Turn).to(C).may(x.at_least(0.5)))
        .invariant(B, x.at_most(10.0));
    check(parts, &["error: blocked: location `b`"]);
}

#[test]
fn curved_flows_block() {
    let Point { x, y } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .flow(C, [x.rate(4.0 - &y * &y), y.rate(&x)])
        .invariant(C, x.at_least(-50.0))
        .transition(from(A).on(Go).to(C).must(x.at_least(1.0)))
        .transition(from(A).on(Turn).to(B).may(x.at_least(0.5)))
        .transition(from(C).on(Turn).to(A).may(y.at_least(-3.0)).then(x.becomes(0.0)));
    check(parts, &["error: blocked: location `c`"]);
}

#[test]
fn alternatives_of_an_invariant_are_left_one_by_one() {
    let Point { x, y } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .flow(B, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(1.0)))
        .transition(from(A).on(Turn).to(C).may(x.at_least(0.5)))
        .transition(from(B).on(Turn).to(C).may(x.at_least(20.0)))
        .invariant(B, x.at_most(20.0) | y.at_least(7.0) & x.at_most(30.0));
    check(parts, &[]);
}

#[test]
fn flows_that_rest_do_not_block() {
    let Point { x, .. } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(1.0)))
        .transition(from(A).on(Turn).to(C).may(x.at_least(0.5)))
        .invariant(B, x.at_most(10.0));
    check(parts, &[]);
}

#[test]
fn invariants_that_hold_nowhere() {
    let Point { x, y } = Point::coordinates();
    let parts = tour().invariant(C, x.at_least(&y + 1.0) & x.less_than(&y));
    check(
        parts,
        &[
            "error: lands outside: location `b`, on `go`",
            "warning: empty invariant: location `c`",
            "warning: never fires: location `c`, on `go`",
        ],
    );
}

// ---- Resets ------------------------------------------------------------------------------------

#[test]
fn resets_that_land_outside() {
    let Point { x, y } = Point::coordinates();
    let turn = from(B).on(Turn).to(C).may(y.at_most(5.0)).then(y.becomes(&y + 8.0));
    let parts = machine()
        .flow(A, x.rate(1.0))
        .invariant(C, y.at_most(10.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(1.0)))
        .transition(turn);
    check(parts, &["error: lands outside: location `b`, on `turn`"]);
}

#[test]
fn resets_that_swap_what_should_stay() {
    let Point { x, y } = Point::coordinates();
    let parts = tour()
        .invariant(C, y.at_most(1.5))
        .transition(from(A).on(Turn).to(C).may(y.at_most(1.0)))
        .transition(
            from(B).on(Back).to(C).may(y.at_most(0.0)).then([x.becomes(&y), y.becomes(&x)]),
        );
    check(
        parts,
        &[
            "error: lands outside: location `b`, on `go`",
            "error: lands outside: location `b`, on `back`",
        ],
    );
}

#[test]
fn resets_that_leave_the_ranges() {
    let Point { y, .. } = Point::coordinates();
    let parts =
        tour().transition(from(A).on(Turn).to(A).may(y.at_most(99.5)).then(y.becomes(&y + 1.0)));
    check(parts, &["warning: leaves its range: location `a`, on `turn`"]);
}

#[test]
fn resets_that_land_outside_where_a_guard_holds() {
    let Point { x, y } = Point::coordinates();
    let turn = from(B).on(Turn).to(C).may(y.at_most(5.0)).then(y.becomes(&y + 8.0));
    let parts = machine()
        .flow(A, x.rate(1.0))
        .invariant(C, y.at_most(10.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(1.0)))
        .transition(turn);
    let home = || [x.becomes(0.0), y.becomes(0.0)];
    let back = from(C).on(Back).to(A).may(y.at_least(10.0)).then(home());
    check(parts.clone().transition(back), &["warning: lands outside: location `b`, on `turn`"]);

    let back = from(C).on(Back).to(A).must(y.at_least(10.0)).then(home());
    let report = parts.transition(back).build().expect("the parts fit").check();
    assert_eq!(faults(&report), [""; 0], "{report}");
    let note = report.findings().iter().find(|one| one.kind == Kind::LandsOutside);
    assert!(note.is_some_and(|note| note.message.contains("what has to be taken")), "{report}");
}

// ---- Timeless cycles ---------------------------------------------------------------------------

#[test]
fn thresholds_the_wrong_way_round() {
    let Point { x, .. } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .flow(B, x.rate(-1.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(18.0)))
        .transition(from(B).on(Back).to(A).must(x.at_most(22.0)))
        .transition(from(A).on(Turn).to(C).may(x.at_least(3.0)));
    check(parts, &["error: timeless cycle: location `a`, on `go` and `back`"]);
}

#[test]
fn transitions_that_are_always_due() {
    let Point { y, .. } = Point::coordinates();
    let parts = tour().transition(from(C).on(On).to(C).at_once(always()).then(y.becomes(1.0)));
    let report = parts.build().expect("the parts fit").check();
    assert!(faults(&report).contains(&"error: timeless cycle: location `c`, on `on`".to_owned()));
}

#[test]
fn rounds_of_three_that_undo_themselves() {
    let Point { x, y } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(5.0)).then(y.becomes(&y + 1.0)))
        .transition(from(B).on(Go).to(C).at_once(x.at_least(5.0)).then(y.becomes(&y - 2.0)))
        .transition(from(C).on(Go).to(A).at_once(x.at_least(4.0)).then(y.becomes(&y + 1.0)));
    let report = parts.build().expect("the parts fit").check();
    let cycle = "error: timeless cycle: location `a`, on `go` and `go` and `go`";
    assert!(faults(&report).contains(&cycle.to_owned()), "{report}");
}

#[test]
fn counting_is_no_timeless_cycle() {
    let Point { x, y } = Point::coordinates();
    let count = from(B).on(On).to(B).at_once(y.at_most(5.0)).then(y.becomes(&y + 1.0));
    let parts = machine()
        .flow(A, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(5.0)).then(y.becomes(0.0)))
        .transition(from(A).on(Turn).to(C).may(x.at_least(3.0)))
        .transition(count);
    check(parts, &[]);
}

/// x grows for ever, and with it what the transition waits for.
#[test]
fn loops_whose_reset_leaves_the_guard_true() {
    let Point { x, .. } = Point::coordinates();
    let again = from(A).on(Go).to(A).must(x.at_least(1.0)).then(x.becomes(&x + 1.0));
    let parts = machine()
        .flow(A, x.rate(1.0))
        .transition(again)
        .transition(from(A).on(Turn).to(B).may(x.at_least(0.5)))
        .transition(from(B).on(Go).to(C).may(x.at_least(0.0)));
    check(parts, &["error: timeless cycle: location `a`, on `go`"]);
}

/// A timer that starts again at its end, and so on the boundary of its own guard.
#[test]
fn loops_whose_reset_leads_to_the_boundary_of_the_guard() {
    let Point { x, .. } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .transition(from(A).on(Go).to(A).must(x.at_least(1.0)).then(x.becomes(1.0)))
        .transition(from(A).on(Turn).to(B).may(x.at_least(0.5)))
        .transition(from(B).on(Go).to(C).may(x.at_least(0.0)));
    check(parts, &["error: timeless cycle: location `a`, on `go`"]);
}

/// The way out goes first as soon as it can.
#[test]
fn loops_that_another_transition_ends() {
    let Point { x, y } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(5.0)).then(y.becomes(0.0)))
        .transition(from(A).on(Turn).to(C).may(x.at_least(3.0)))
        .transition(from(B).on(Turn).to(C).at_once(y.at_least(4.5)))
        .transition(
            from(B).on(On).to(B).at_once(y.at_least(0.0)).then(y.becomes(&y + 1.0)).priority(1),
        );
    check(parts, &["warning: leaves its range: location `b`, on `on`"]);
}

// ---- Formulas without a value ------------------------------------------------------------------

/// Goes from `a` to `b`, where y changes like this, and from there to `c`.
fn ride(rate: impl Into<Expression>) -> Parts {
    let Point { x, y } = Point::coordinates();
    machine()
        .flow(A, x.rate(1.0))
        .flow(B, [x.rate(1.0), y.rate(rate)])
        .transition(from(A).on(Go).to(B).must(x.at_least(0.5)))
        .transition(from(B).on(Go).to(C).may(x.at_least(0.75)))
}

#[test]
fn rates_that_divide_by_zero() {
    let Point { x, .. } = Point::coordinates();
    check(ride(1.0 / (&x - 1.0)), &["warning: no value: location `b`"]);
    check(ride(1.0 / (&x - 1.0)).invariant(B, x.less_than(0.9)), &[]);
}

#[test]
fn roots_logarithms_and_rates_that_are_no_numbers() {
    let Point { x, .. } = Point::coordinates();
    for rate in [(&x - 1.0).square_root(), (&x + 10.0).ln(), x.power(-2.0), constant(f64::NAN)] {
        check(ride(rate), &["warning: no value: location `b`"]);
    }
    let safe = piecewise([(x.at_least(1.0), (&x - 1.0).square_root())], 0.0);
    check(ride(safe.expect("a comparison")), &[]);
}

#[test]
fn guards_and_resets_without_a_value() {
    let Point { x, y } = Point::coordinates();
    let turn = from(B).on(Turn).to(C).may((&y - 1.0).square_root().at_least(3.0));
    check(tour().transition(turn), &["warning: no value: location `b`, on `turn`"]);
    let turn = from(B).on(Turn).to(C).may(y.at_least(1.0)).then(y.becomes((&x - 1.5).ln()));
    check(tour().transition(turn), &["warning: no value: location `b`, on `turn`"]);
}

// ---- The beginning, and what rests -------------------------------------------------------------

#[test]
fn nowhere_to_begin() {
    let Point { x, .. } = Point::coordinates();
    let parts = pleach_automaton::Automaton::starting_in(A)
        .transition(from(A).on(Go).to(B).may(x.at_least(1.0)))
        .transition(from(B).on(Go).to(C).may(x.at_least(2.0)));
    check(parts, &["warning: no initial state: location `a`"]);
}

#[test]
fn beginnings_outside_the_invariant() {
    let Point { x, .. } = Point::coordinates();
    check(
        tour().invariant(A, x.at_least(0.5)),
        &["error: starts outside: location `a`", "error: lands outside: location `c`, on `go`"],
    );
}

#[test]
fn beginnings_outside_the_invariant_where_a_guard_holds() {
    let Point { x, .. } = Point::coordinates();
    let parts = tour().initially(Point { x: 2.0, y: 0.0 }).invariant(A, x.at_most(1.0));
    check(parts, &["warning: starts outside: location `a`"]);
}

#[test]
fn beginnings_outside_the_ranges() {
    let parts = tour().initially(Point { x: 0.0, y: -101.0 });
    check(parts, &["warning: starts out of range: location `a`, variable `y`"]);
}

#[test]
fn waiting_for_what_does_not_move() {
    let Point { x, .. } = Point::coordinates();
    let parts = machine()
        .flow(A, x.rate(1.0))
        .transition(from(A).on(Go).to(B).must(x.at_least(1.0)))
        .transition(from(B).on(Go).to(C).must(x.at_least(2.0)));
    let report = parts.build().expect("the parts fit").check();
    let rests = "warning: nothing moves: location `b`, on `go`".to_owned();
    assert!(faults(&report).contains(&rests), "{report}");
}
