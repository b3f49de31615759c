//! Lists of locations and events.

/// The place of one among all.
pub(crate) fn place_of<T: Copy + PartialEq>(all: &[T], one: T) -> Option<usize> {
    all.iter().position(|listed| *listed == one)
}

pub(crate) fn names_of<T: Copy>(all: &[T], name: fn(T) -> &'static str) -> Vec<&'static str> {
    mapped(all, |one| name(*one))
}

/// As `all.into_iter().map(change).collect()`, in a quarter of the code, which counts, since it is compiled for the types
/// of each automaton.
pub(crate) fn mapped<A, B>(all: impl IntoIterator<Item = A>, change: impl Fn(A) -> B) -> Vec<B> {
    let mut changed = Vec::new();
    for one in all {
        changed.push(change(one));
    }
    changed
}
