//! The worst corner is the worst, and halving a move never makes it worse.

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
                    kani::cover!();
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
