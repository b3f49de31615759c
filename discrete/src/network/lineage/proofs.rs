//! A lineage leads through no post twice.

use super::*;

/// Any post of four.
fn any_post() -> PostId {
    PostId(u32::from(kani::any_where(|post: &u8| *post < 4)))
}

/// The way over two posts that differ, and any third one: the way is extended exactly if the third one is not on
/// it, by that post alone; and it is known without building it whose extension a way is.
#[kani::proof]
#[kani::unwind(5)]
fn a_way_is_extended_by_posts_that_are_not_on_it() {
    let (first, second, third, other) = (any_post(), any_post(), any_post(), any_post());
    kani::assume(first != second);
    let root = Lineage::of_access_point(0);
    let (one, two) = (root.extended_by(first), root.extended_by(second));
    assert!(one.is_some() && two.is_some());
    if let (Some(one), Some(two)) = (&one, &two)
        && let Some(way) = one.extended_by(second)
    {
        assert!(way.extends(one, second) && !way.extends(two, second) && !way.extends(one, first));
        assert!(way.contains(other) == (other == first || other == second));
        let longer = way.extended_by(third);
        kani::cover!(longer.is_some());
        kani::cover!(longer.is_none() && third == first);
        assert!(longer.is_none() == (third == first || third == second));
        assert!(longer.as_ref().is_none_or(|it| it.hops() == 3 && it.root() == 0));
        assert!(longer.is_none_or(|it| it.extends(&way, third)));
    }
}
