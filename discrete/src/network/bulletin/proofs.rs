//! The newest notice wins, in whatever order notices are heard.

use super::*;

/// The identity of a notice of the first steps of a mission, by any of three nodes.
fn any_id() -> NoticeId {
    let below = |end: u8| move |drawn: &u8| *drawn < end;
    NoticeId::new(kani::any_where(below(4)).into(), kani::any_where(below(3)).into())
}

/// The bulletin with this identity: a node issues at most one notice of each number.
fn bulletin(id: NoticeId) -> Bulletin<(u32, NodeId)> {
    Bulletin { id, notice: (id.number, id.issuer) }
}

/// Any three notices of four steps and three issuers, several of which may have issued a notice at
/// the same step: hearing two of them in either order, or twice, leaves the newest of the three,
/// and [`Bulletin::merge`] says whether what it heard was news.
#[kani::proof]
#[kani::unwind(2)]
fn the_newest_notice_wins_in_any_order() {
    let (known, one, other) = (any_id(), any_id(), any_id());
    let (mut forth, mut back) = (bulletin(known), bulletin(known));
    let news = forth.merge(&bulletin(one));
    forth.merge(&bulletin(other));
    back.merge(&bulletin(other));
    back.merge(&bulletin(one));
    kani::cover!(one < known && known < other);
    kani::cover!(one.number == other.number && one.issuer < other.issuer);
    assert!(news == (one > known));
    assert!(forth == back);
    assert!(forth == bulletin(known.max(one).max(other)));
    assert!(!forth.merge(&bulletin(one)));
}

/// What a node issues is newer than what it knows, the order of identities is that of the tuple of
/// number and issuer, and of two identities that differ one is newer.
#[kani::proof]
#[kani::unwind(2)]
fn identities_are_totally_ordered() {
    let (one, other) = (any_id(), any_id());
    kani::cover!(one.number == other.number && one != other);
    assert!(one.is_newer_than(other) == (one > other));
    assert!(one.is_newer_than(other) == ((one.number, one.issuer) > (other.number, other.issuer)));
    assert!(one == other || one.is_newer_than(other) || other.is_newer_than(one));
    assert!(bulletin(one).next(other.issuer, (0, 0)).id().is_newer_than(one));
}
