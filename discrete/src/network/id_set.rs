//! Sets of small numbers: tokens of an election, votes along a path.

#[cfg(any(kani, test))]
mod proofs;

/// A set of numbers, as bits in words of 64. Words without any number take no memory.
///
/// The numbers below 64 have a machine word of their own, so that the sets of most networks allocate
/// nothing.
#[derive(Clone, Debug, Default, Eq, PartialOrd, Ord, Hash)]
#[allow(clippy::derived_hash_with_manual_eq)] // sets are equal where all their words are
pub struct IdSet {
    first: u64,
    /// From 64 on, ascending.
    rest: Vec<Word>,
}

/// The numbers from `WIDTH · at` on: at least one of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct Word {
    at: usize,
    bits: u64,
}

/// How many numbers a word holds.
const WIDTH: usize = u64::BITS as usize;

/// Most sets are one word long, and beacons compare them all the time: a loop is faster than a call
/// that compares no memory at all.
impl PartialEq for IdSet {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.first == other.first
            && self.rest.len() == other.rest.len()
            && self.rest.iter().zip(&other.rest).all(|(own, others)| own == others)
    }
}

impl IdSet {
    /// The empty set.
    pub const fn new() -> Self {
        IdSet { first: 0, rest: Vec::new() }
    }

    /// The set of one number.
    pub fn singleton(id: usize) -> Self {
        let mut set = IdSet::new();
        set.insert(id);
        set
    }

    /// Adds `id`; returns whether it is new.
    pub fn insert(&mut self, id: usize) -> bool {
        self.add(Word { at: id / WIDTH, bits: 1 << (id % WIDTH) })
    }

    /// Whether `id` is in the set.
    pub fn contains(&self, id: usize) -> bool {
        self.word(id / WIDTH) & (1 << (id % WIDTH)) != 0
    }

    /// Adds every number of `other`; returns whether any is new.
    #[inline]
    pub fn merge(&mut self, other: &IdSet) -> bool {
        let mut grown = other.first & !self.first != 0;
        self.first |= other.first;
        for theirs in &other.rest {
            grown |= self.add(*theirs);
        }
        grown
    }

    /// Adds the numbers of a word; returns whether any is new.
    fn add(&mut self, word: Word) -> bool {
        let own = match self.place_of(word.at) {
            None => &mut self.first,
            Some(Ok(place)) => &mut self.rest[place].bits,
            Some(Err(place)) => {
                self.rest.insert(place, word);
                return true;
            }
        };
        let is_new = word.bits & !*own != 0;
        *own |= word.bits;
        is_new
    }

    /// Whether every number of `other` is in the set.
    #[inline]
    pub fn includes(&self, other: &IdSet) -> bool {
        other.first & !self.first == 0
            && other.rest.iter().all(|theirs| theirs.bits & !self.word(theirs.at) == 0)
    }

    /// How many numbers there are.
    pub fn len(&self) -> usize {
        self.words().map(|word| word.bits.count_ones() as usize).sum()
    }

    /// Whether the set is empty.
    pub fn is_empty(&self) -> bool {
        self.first == 0 && self.rest.is_empty()
    }

    /// The numbers, ascending.
    pub fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.words().flat_map(Word::numbers)
    }

    fn words(&self) -> impl Iterator<Item = Word> + '_ {
        std::iter::once(Word { at: 0, bits: self.first }).chain(self.rest.iter().copied())
    }

    fn word(&self, at: usize) -> u64 {
        match self.place_of(at) {
            None => self.first,
            Some(Ok(place)) => self.rest[place].bits,
            Some(Err(_)) => 0,
        }
    }

    /// Where a word is, or where it belongs; none if it is the first of all. Sets are often built in
    /// their order: the end is looked at before the middle.
    fn place_of(&self, at: usize) -> Option<Result<usize, usize>> {
        if at == 0 {
            return None;
        }
        Some(match self.rest.last() {
            Some(last) if last.at >= at => self.rest.binary_search_by_key(&at, |word| word.at),
            _ => Err(self.rest.len()),
        })
    }
}

impl Word {
    /// The numbers, ascending.
    fn numbers(self) -> impl Iterator<Item = usize> {
        let mut left = self.bits;
        std::iter::from_fn(move || {
            let bit = (left != 0).then_some(left.trailing_zeros() as usize)?;
            left &= left - 1;
            Some(WIDTH * self.at + bit)
        })
    }
}

impl FromIterator<usize> for IdSet {
    fn from_iter<I: IntoIterator<Item = usize>>(ids: I) -> Self {
        let mut set = IdSet::new();
        set.extend(ids);
        set
    }
}

impl Extend<usize> for IdSet {
    fn extend<I: IntoIterator<Item = usize>>(&mut self, ids: I) {
        for id in ids {
            self.insert(id);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    /// Numbers in the first word and beyond it; half of the time one of a few, at the ends of
    /// words, so that sets include and meet each other.
    fn id() -> impl Strategy<Value = usize> {
        prop_oneof![prop::sample::select(vec![0, 63, 64, 65, 128, 256]), 0..300_usize]
    }

    fn ids() -> impl Strategy<Value = BTreeSet<usize>> {
        let few = prop::sample::subsequence(vec![0, 63, 64, 65, 128, 256], 0..=6);
        let few = few.prop_map(|ids| ids.into_iter().collect());
        prop_oneof![few, prop::collection::btree_set(id(), 0..8)]
    }

    #[test]
    fn a_singleton_has_one_number() {
        for id in [0, 1, 63, 64, 200] {
            assert!(IdSet::singleton(id).iter().eq([id]));
        }
    }

    #[test]
    fn what_lies_beyond_the_first_word_is_merged_too() {
        let mut set = IdSet::singleton(1);
        assert!(set.merge(&IdSet::singleton(200)));
        assert!(set.iter().eq([1, 200]));
        assert!(!set.merge(&IdSet::singleton(1)));
        assert!(set.iter().eq([1, 200]));
        assert!(IdSet::new().is_empty() && !set.is_empty());
    }

    proptest! {
        #[test]
        fn a_set_of_bits_is_a_set(one in ids(), other in ids(), id in id()) {
            let bits = |ids: &BTreeSet<usize>| ids.iter().copied().collect::<IdSet>();
            let mut union = bits(&one);
            prop_assert_eq!(union.includes(&bits(&other)), one.is_superset(&other));
            prop_assert_eq!(union.merge(&bits(&other)), !one.is_superset(&other));
            let expected: BTreeSet<usize> = one.union(&other).copied().collect();
            prop_assert!(union.iter().eq(expected.iter().copied()));
            prop_assert_eq!(union.len(), expected.len());
            prop_assert_eq!(union.is_empty(), expected.is_empty());
            prop_assert_eq!(union.contains(id), expected.contains(&id));
            prop_assert_eq!(&union, &bits(&expected));
            prop_assert_eq!(union.insert(id), !expected.contains(&id));
        }
    }
}
