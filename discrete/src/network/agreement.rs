//! Consensus along the path Σ: which of its robots are break points, and which have arrived.
//!
//! The vectors r and t of Sec. V-C2, with one entry for each place of Σ, spread by taking
//! maxima. Entries of r start negative (unknown) and end at 0 or 1; here `voted` and `breaks`
//! hold the two bits. Every robot that passes messages on takes part in the spreading.

use super::IdSet;

#[cfg(any(kani, test))]
mod proofs;

/// What a robot knows of the agreement about one path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Agreement {
    number: u32,
    voted: IdSet,
    breaks: IdSet,
    arrived: IdSet,
}

impl Agreement {
    /// An agreement on which nothing is known yet; `number` tells paths apart.
    pub const fn new(number: u32) -> Self {
        Agreement { number, voted: IdSet::new(), breaks: IdSet::new(), arrived: IdSet::new() }
    }

    /// The number of the path.
    pub const fn number(&self) -> u32 {
        self.number
    }

    /// The robot at `place` says whether it is a break point.
    pub fn vote(&mut self, place: usize, is_break_point: bool) {
        if self.voted.insert(place) && is_break_point {
            self.breaks.insert(place);
        }
    }

    /// Whether the robot at `place` has spoken.
    pub fn has_voted(&self, place: usize) -> bool {
        self.voted.contains(place)
    }

    /// The robot at `place` has reached its destination, eq. (26).
    pub fn arrive(&mut self, place: usize) {
        self.arrived.insert(place);
    }

    /// Takes the maximum with what a neighbour sent.
    pub fn merge(&mut self, heard: &Agreement) {
        if heard.number == self.number {
            self.voted.merge(&heard.voted);
            self.breaks.merge(&heard.breaks);
            self.arrived.merge(&heard.arrived);
        }
    }

    /// Whether every place of a path with `places` places has voted.
    pub fn is_settled(&self, places: usize) -> bool {
        (0..places).all(|place| self.voted.contains(place))
    }

    /// Whether the robot at `place` has said that it is a break point.
    pub fn is_break_point(&self, place: usize) -> bool {
        self.breaks.contains(place)
    }

    /// The break points of a path with `places` places, once every place has voted.
    pub fn break_points(&self, places: usize) -> Option<Vec<usize>> {
        self.is_settled(places)
            .then(|| (0..places).filter(|&place| self.is_break_point(place)).collect())
    }

    /// Whether every place in `places` has reached its destination.
    pub fn have_arrived(&self, mut places: std::ops::Range<usize>) -> bool {
        places.all(|place| self.arrived.contains(place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn break_points_are_told_once_every_place_has_voted() {
        let mut agreement = Agreement::new(7);
        for (place, vote) in [(3, true), (0, true), (2, false)] {
            agreement.vote(place, vote);
            assert_eq!(agreement.break_points(4), None);
        }
        agreement.vote(1, false);
        assert_eq!(agreement.break_points(4), Some(vec![0, 3]));
        assert_eq!(agreement.break_points(3), Some(vec![0]));
    }

    #[test]
    fn another_path_is_not_heard() {
        let (mut mine, mut other) = (Agreement::new(7), Agreement::new(8));
        assert_eq!((mine.number(), other.number()), (7, 8));
        other.vote(0, true);
        other.arrive(0);
        mine.merge(&other);
        assert_eq!(mine, Agreement::new(7));
    }
}
