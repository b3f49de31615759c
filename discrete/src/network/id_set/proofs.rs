//! Sets of bits are sets: for numbers below 8, against the bits of a byte.

use super::*;

/// The set of the bits of `mask`.
fn set_of(mask: u8) -> IdSet {
    let mut set = IdSet::new();
    for id in 0..8 {
        if mask & (1 << id) != 0 {
            set.insert(id);
        }
    }
    set
}

/// Union, inclusion, number of elements and membership of any two sets of numbers below 8.
#[kani::proof]
#[kani::unwind(10)]
fn a_merge_is_the_union() {
    let (one, other): (u8, u8) = (kani::any(), kani::any());
    let mut union = set_of(one);
    let grows = union.merge(&set_of(other));
    kani::cover!(grows && one != 0);
    kani::cover!(!grows && other != 0);
    assert!(grows == (other & !one != 0));
    assert!(union == set_of(one | other));
    assert!(union.includes(&set_of(one)) && union.includes(&set_of(other)));
    assert!(set_of(one).includes(&set_of(other)) == (other & !one == 0));
    for id in 0..8 {
        assert!(union.contains(id) == ((one | other) & (1 << id) != 0));
    }
}
