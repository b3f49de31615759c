//! The worst corner is the worst, halving a move never makes it worse, and what is accepted overloads nobody.

use super::*;

/// Any term below a bound.
fn any_term(bound: u8) -> u16 {
    u16::from(kani::any_where(|term: &u8| *term < bound))
}

/// The terms of two receivers for both ends of the sender's move and both of their own.
fn any_terms(bound: u8) -> [[[u16; 2]; 2]; 2] {
    let pair = || [any_term(bound), any_term(bound)];
    [[pair(), pair()], [pair(), pair()]]
}

/// Two receivers, any terms below 4 as whole numbers: at no corner of the three moves is the sum
/// larger than [`worst_corner`], and at one it is as large.
#[kani::proof]
#[kani::unwind(4)]
fn no_corner_is_worse_than_the_worst() {
    let terms = any_terms(4);
    let worst = worst_corner(terms);
    let at =
        |sender: usize, one: usize, other: usize| terms[sender][0][one] + terms[sender][1][other];
    let (mut largest, mut corner) = (0, [0; 3]);
    for sender in 0..2 {
        for one in 0..2 {
            for other in 0..2 {
                assert!(at(sender, one, other) <= worst);
                if at(sender, one, other) > largest {
                    (largest, corner) = (at(sender, one, other), [sender, one, other]);
                }
            }
        }
    }
    kani::cover!(corner[0] == 1 && corner[1] == 0 && corner[2] == 1);
    assert!(largest == worst);
}

/// Two receivers, any terms below 3 as whole numbers, one of which gives way to any that is not
/// larger than those of both ends of the receiver's move: the worst corner does not get worse.
///
/// So it is when a move is halved, since its terms are convex.
#[kani::proof]
#[kani::unwind(4)]
fn smaller_terms_have_no_worse_corner() {
    let terms = any_terms(3);
    let mut halved = terms;
    let (sender, receiver) = (usize::from(kani::any::<bool>()), usize::from(kani::any::<bool>()));
    let between = any_term(3);
    kani::assume(between <= terms[sender][receiver][0].max(terms[sender][receiver][1]));
    halved[sender][receiver][1] = between;
    kani::cover!(between > terms[sender][receiver][1]);
    kani::cover!(worst_corner(halved) < worst_corner(terms));
    assert!(worst_corner(halved) <= worst_corner(terms));
}

/// Any worst loads, infinite ones and NaN among them, of moves that are judged one after the other, and a load
/// that is not too much to begin with: a sender that is given no load but those that it has accepted is never
/// given too much.
#[kani::proof]
#[kani::unwind(5)]
fn a_sender_that_accepts_is_never_given_too_much() {
    let mut load: f64 = kani::any_where(|load| *load <= FULL_LOAD);
    let worst: [f64; 3] = kani::any();
    for worst in &worst {
        if is_acceptable(*worst, load) {
            load = *worst;
        }
    }
    kani::cover!(worst[0] > 1.0 && load == worst[2]);
    kani::cover!(worst[1].is_nan() && load == worst[0]);
    assert!(load <= FULL_LOAD);
}

/// Any two worst loads, and any load where nobody moves: a sender that accepts the greater one accepts the
/// other, too. So consent to a move is consent to what is left of it when movers halve theirs; and a sender
/// that has too much already accepts what does not give it more.
#[kani::proof]
#[kani::unwind(2)]
fn consent_to_a_move_is_consent_to_less_of_it() {
    let (worst, less, present): (f64, f64, f64) = (kani::any(), kani::any(), kani::any());
    kani::assume(less <= worst);
    kani::cover!(is_acceptable(worst, present) && less < worst && worst > FULL_LOAD);
    kani::cover!(!is_acceptable(worst, present) && is_acceptable(less, present));
    assert!(!is_acceptable(worst, present) || is_acceptable(less, present));
    assert!(is_acceptable(present, present) || present.is_nan());
}
