//! Robots in their own half-planes are 2ρ apart.

use nalgebra::Unit;

use super::*;

/// The clearance ρ.
const CLEARANCE: f64 = 1.0;

/// Two robots on a line across the bisector, at whole coordinates −7 … 7: if they are at least 2ρ
/// apart, then any two points of their half-planes are; if they are closer, neither half-plane
/// lets its robot come nearer. Each robot may stay where it is.
///
/// The bisector is x = m, which loses nothing: distances do not depend on how the axes lie. For
/// bisectors in any direction, over the reals, see `proofs/smt/half-planes.smt2`.
#[kani::proof]
#[kani::unwind(3)]
#[kani::solver(cadical)]
fn points_in_their_own_half_planes_are_two_clearances_apart() {
    let coordinate = || kani::any_where(|x: &i8| (-4..=4).contains(x));
    // Even numbers, so that the middle is a whole number.
    let (middle, half) = (coordinate(), kani::any_where(|half: &i8| (0..=3).contains(half)));
    let at = |x: i8, y: i8| Point::new(f64::from(x), f64::from(y));
    let (own, other) = (at(middle - half, 0), at(middle + half, 0));
    let bisector = |direction: f64| HalfPlane {
        normal: Unit::new_unchecked(Vector::new(direction, 0.0)),
        offset: direction * f64::from(middle),
    };
    let mine = own_side(bisector(1.0), own, CLEARANCE);
    let theirs = own_side(bisector(-1.0), other, CLEARANCE);
    assert!(mine.contains(own) && theirs.contains(other));
    let (here, there) = (coordinate(), coordinate());
    kani::assume(mine.contains(at(here, 3)) && theirs.contains(at(there, -2)));
    kani::cover!(half == 3 && i16::from(there) - i16::from(here) == 2);
    kani::cover!(half == 0);
    let apart = i16::from(there) - i16::from(here);
    assert!(apart >= 2 || apart >= 2 * i16::from(half));
}
