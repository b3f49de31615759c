//! Consensus along the path Σ: which of its robots are break points, which have arrived, and which
//! give their posts up to those that have.
//!
//! The vectors r and t of Sec. V-C2, with one entry for each place of Σ, spread by taking
//! maxima. Entries of r start negative (unknown) and end at 0 or 1; here `voted` and `breaks`
//! hold the two bits. Every robot that passes messages on takes part in the spreading.

use super::{IdSet, NoticeId};

#[cfg(any(kani, test))]
mod proofs;

/// What a robot knows of the agreement about one path.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "super::serialization::AgreementParts"))]
pub struct Agreement {
    id: NoticeId,
    voted: IdSet,
    breaks: IdSet,
    arrived: IdSet,
    given_up: IdSet,
}

impl Agreement {
    /// The agreement about the path that the notice `id` announces, of which nothing is known yet.
    pub const fn new(id: NoticeId) -> Self {
        Agreement {
            id,
            voted: IdSet::new(),
            breaks: IdSet::new(),
            arrived: IdSet::new(),
            given_up: IdSet::new(),
        }
    }

    /// The agreement with these votes, arrivals and posts given up; none if a place that has not voted is a break
    /// point.
    #[cfg(feature = "serde")]
    pub(super) fn from_parts(
        id: NoticeId,
        voted: IdSet,
        breaks: IdSet,
        arrived: IdSet,
        given_up: IdSet,
    ) -> Option<Self> {
        let is_sound = voted.includes(&breaks);
        is_sound.then_some(Agreement { id, voted, breaks, arrived, given_up })
    }

    /// The notice that announced the path, which tells paths apart.
    pub const fn id(&self) -> NoticeId {
        self.id
    }

    /// The vote of the robot at `place`: whether it is a break point.
    pub fn vote(&mut self, place: usize, is_break_point: bool) {
        if self.voted.insert(place) && is_break_point {
            self.breaks.insert(place);
        }
    }

    /// The robot at `place` has reached its destination, eq. (26).
    pub fn arrive(&mut self, place: usize) {
        self.arrived.insert(place);
    }

    /// The robot at `place` gives its post up: it knows that the subgroup that relieves it has arrived.
    pub fn give_up(&mut self, place: usize) {
        self.given_up.insert(place);
    }

    /// Takes the maximum with what a neighbour sent.
    #[inline]
    pub fn merge(&mut self, heard: &Agreement) {
        if heard.id == self.id {
            self.voted.merge(&heard.voted);
            self.breaks.merge(&heard.breaks);
            self.arrived.merge(&heard.arrived);
            self.given_up.merge(&heard.given_up);
        }
    }

    /// Whether every place of a path with `places` places has voted.
    pub fn is_settled(&self, places: usize) -> bool {
        (0..places).all(|place| self.voted.contains(place))
    }

    /// Whether the robot at `place` has voted that it is a break point.
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

    /// Whether the robot at `place` has given its post up.
    pub fn has_given_up(&self, place: usize) -> bool {
        self.given_up.contains(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn break_points_are_told_once_every_place_has_voted() {
        let mut agreement = Agreement::new(NoticeId::new(7, 1));
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
        let (mine_id, other_id) = (NoticeId::new(7, 1), NoticeId::new(7, 2));
        let (mut mine, mut other) = (Agreement::new(mine_id), Agreement::new(other_id));
        assert_eq!((mine.id(), other.id()), (mine_id, other_id));
        other.vote(0, true);
        other.arrive(0);
        other.give_up(1);
        mine.merge(&other);
        assert_eq!(mine, Agreement::new(mine_id));
    }
}
