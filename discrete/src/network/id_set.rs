//! Sets of small numbers: tokens of an election, votes along a path.

/// A set of numbers below a few thousand, as bits.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct IdSet {
    words: Vec<u64>,
}

impl IdSet {
    /// The empty set.
    pub const fn new() -> Self {
        IdSet { words: Vec::new() }
    }

    /// The set of one number.
    pub fn singleton(id: usize) -> Self {
        let mut set = IdSet::new();
        set.insert(id);
        set
    }

    /// Adds `id`; says whether it is new.
    pub fn insert(&mut self, id: usize) -> bool {
        let (word, bit) = (id / 64, 1 << (id % 64));
        if word >= self.words.len() {
            self.words.resize(word + 1, 0);
        }
        let new = self.words[word] & bit == 0;
        self.words[word] |= bit;
        new
    }

    /// Whether `id` is in the set.
    pub fn contains(&self, id: usize) -> bool {
        self.words.get(id / 64).is_some_and(|word| word & (1 << (id % 64)) != 0)
    }

    /// Adds every number of `other`; says whether any is new.
    pub fn merge(&mut self, other: &IdSet) -> bool {
        if other.words.len() > self.words.len() {
            self.words.resize(other.words.len(), 0);
        }
        let mut grown = false;
        for (mine, theirs) in self.words.iter_mut().zip(&other.words) {
            grown |= theirs & !*mine != 0;
            *mine |= theirs;
        }
        grown
    }

    /// Whether every number of `other` is in the set.
    pub fn includes(&self, other: &IdSet) -> bool {
        other.words.iter().enumerate().all(|(at, theirs)| {
            let mine = self.words.get(at).copied().unwrap_or(0);
            theirs & !mine == 0
        })
    }

    /// How many numbers there are.
    pub fn len(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Whether the set is empty.
    pub fn is_empty(&self) -> bool {
        self.words.iter().all(|&word| word == 0)
    }

    /// The numbers, ascending.
    pub fn iter(&self) -> impl Iterator<Item = usize> + '_ {
        self.words.iter().enumerate().flat_map(|(at, &word)| {
            (0..64).filter(move |bit| word & (1 << bit) != 0).map(move |bit| 64 * at + bit)
        })
    }
}

impl FromIterator<usize> for IdSet {
    fn from_iter<I: IntoIterator<Item = usize>>(ids: I) -> Self {
        let mut set = IdSet::new();
        for id in ids {
            set.insert(id);
        }
        set
    }
}
