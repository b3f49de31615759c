//! The path Σ from the recruit to p₁, its break points 𝓑 and its subgroups S_β (Sec. V-B).

use super::{Anchor, NodeId, Post};

#[cfg(any(kani, test))]
mod proofs;

/// One place of Σ: the robot that stands there at t_h and the post that it holds.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Hop<P> {
    /// The robot.
    pub robot: NodeId,
    /// The post, as the discrete layer sees it.
    pub post: Post,
    /// What else the members need to know of the place.
    pub place: P,
    /// The access points that the path passes between this place and the next.
    pub crossing: Vec<usize>,
}

/// The path Σ, from the recruit s₁ (place 0) to p₁ or, when L_b = 1, the leader.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Path<P> {
    /// The places in order.
    pub hops: Vec<Hop<P>>,
    /// L_b: whether the leader is to be released from past duties.
    pub releases_leader: bool,
}

/// A subgroup S_β = [b_β, b_{β+1})_Σ: the places `first..end`; the robot at `end` is the break
/// point that they relieve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Subgroup {
    /// b_β.
    pub first: usize,
    /// b_{β+1}, which does not move with the subgroup.
    pub end: usize,
}

/// What a robot of Σ knows of itself when it decides whether it is a break point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ties {
    /// It services a task.
    pub services_task: bool,
    /// A link to a neighbour in the tree, parent or child, is none of Σ.
    pub bears_others: bool,
}

/// The last break point of a path with this many places: the leader's when L_b = 1, else the one
/// before p₁.
pub const fn last_break_point(places: usize, releases_leader: bool) -> usize {
    places.saturating_sub(if releases_leader { 1 } else { 2 })
}

/// Whether the robot at `place` is a break point of a path whose last break point is `last`.
///
/// The paper names junctions and leaves. A robot is one in effect if it services a task, if
/// it has a link in the tree that is none of Σ, if Σ leaves the tree just before or behind it, to cross an access
/// point or from one branch to another, or if it is the last that Σ relieves; and b₁ = s₁. What is no link of the
/// tree is thus walked by one robot alone: two in a chain would hold each other back.
pub const fn is_break_point(place: usize, last: usize, ties: Ties, at_crossing: bool) -> bool {
    place == 0
        || place == last
        || place < last && (ties.services_task || ties.bears_others || at_crossing)
}

impl<P> Path<P> {
    /// The number of places.
    pub fn len(&self) -> usize {
        self.hops.len()
    }

    /// Whether there is no place at all.
    pub fn is_empty(&self) -> bool {
        self.hops.is_empty()
    }

    /// The last place that is a break point, see [`last_break_point`].
    pub fn last_break_point(&self) -> usize {
        last_break_point(self.len(), self.releases_leader)
    }

    /// Whether the robot at `place` is a break point of Σ, see [`is_break_point`].
    pub fn is_break_point(&self, place: usize, ties: Ties) -> bool {
        let leaves = |place: usize| self.leaves_tree(place);
        let at_crossing = leaves(place) || place.checked_sub(1).is_some_and(leaves);
        is_break_point(place, self.last_break_point(), ties, at_crossing)
    }

    /// Whether no link of the tree leads from `place` to the next: the path crosses an access point, or
    /// from one branch to another.
    fn leaves_tree(&self, place: usize) -> bool {
        let (Some(hop), Some(next)) = (self.hops.get(place), self.hops.get(place + 1)) else {
            return false;
        };
        let is_link = self.descends(place) || hop.post.is_child_of(next.post.id);
        !is_link || !hop.crossing.is_empty()
    }

    /// The place that `post` has on the path.
    pub fn place_of(&self, post: super::PostId) -> Option<usize> {
        self.hops.iter().position(|hop| hop.post.id == post)
    }

    /// Whether the path descends from `place` to the next: the next post is attached to this one.
    pub fn descends(&self, place: usize) -> bool {
        match (self.hops.get(place), self.hops.get(place + 1)) {
            (Some(hop), Some(next)) => next.post.is_child_of(hop.post.id),
            _ => false,
        }
    }

    /// Whether the link between the post at `place` and `other` is one of the path: that is the post before or
    /// behind, or an access point that the path crosses just there. One that it passes elsewhere is off it for
    /// this post.
    pub fn takes_link(&self, place: usize, other: Anchor) -> bool {
        let before = place.checked_sub(1).and_then(|before| self.hops.get(before));
        let [own, next] = [place, place + 1].map(|place| self.hops.get(place));
        match other {
            Anchor::Post(post) => before.into_iter().chain(next).any(|hop| hop.post.id == post),
            Anchor::Access(access) => {
                before.into_iter().chain(own).any(|hop| hop.crossing.contains(&access))
            }
        }
    }
}

/// The subgroups that `break_points` (ascending) cut out of Σ.
pub fn subgroups(break_points: &[usize]) -> impl Iterator<Item = Subgroup> + '_ {
    break_points.windows(2).map(|pair| Subgroup { first: pair[0], end: pair[1] })
}

impl Subgroup {
    /// The places of its members.
    pub const fn places(self) -> std::ops::Range<usize> {
        self.first..self.end
    }
}

#[cfg(test)]
mod tests {
    use super::super::PostId;
    use super::*;

    /// A path of this many places up a tree and, behind `before`, across an access point and down another.
    fn path(places: usize, before: usize) -> Path<()> {
        let hop = |place| {
            let parent = match place {
                _ if place < before => Anchor::Post(PostId(place as u32 + 1)),
                _ if place > before + 1 => Anchor::Post(PostId(place as u32 - 1)),
                _ => Anchor::Access(0),
            };
            Hop {
                robot: place,
                post: Post { parent: Some(parent), ..Post::redundant(PostId(place as u32)) },
                place: (),
                crossing: if place == before { vec![0] } else { vec![] },
            }
        };
        Path { hops: (0..places).map(hop).collect(), releases_leader: true }
    }

    #[test]
    fn robots_on_both_sides_of_a_crossing_are_break_points() {
        let path = path(6, 2);
        let points: Vec<usize> =
            (0..path.len()).filter(|&place| path.is_break_point(place, Ties::default())).collect();
        assert_eq!(points, [0, 2, 3, 5]);
        let crossing = subgroups(&points).find(|subgroup| subgroup.first == 2);
        assert_eq!(crossing, Some(Subgroup { first: 2, end: 3 }), "one robot crosses alone");
    }

    /// A robot knew no way over the tree yet, and took a link that may be built.
    #[test]
    fn robots_on_both_sides_of_a_link_off_the_tree_are_break_points() {
        let mut path = path(6, 9);
        path.hops[2].post.parent = Some(Anchor::Access(0));
        let is_break_point = |place: &usize| path.is_break_point(*place, Ties::default());
        assert!((0..path.len()).filter(is_break_point).eq([0, 2, 3, 5]));
    }

    #[test]
    fn the_last_break_point_is_the_leader_or_the_one_before_the_first_of_the_team() {
        let released = path(6, 9);
        let kept = Path { releases_leader: false, ..path(6, 9) };
        assert_eq!((released.last_break_point(), kept.last_break_point()), (5, 4));
        let points = |path: &Path<()>| {
            let is_break_point = |place: &usize| path.is_break_point(*place, Ties::default());
            (0..path.len()).filter(is_break_point).collect::<Vec<_>>()
        };
        assert_eq!((points(&released), points(&kept)), (vec![0, 5], vec![0, 4]));
        assert!(!released.is_empty() && path(0, 9).is_empty());
    }

    /// Up from the recruit and down again: 0 and 4 are attached to 1 and 3, these on 2 and access point 0.
    #[test]
    fn a_path_knows_its_places_and_where_it_descends() {
        let path = path(5, 2);
        let descents = (0..6).filter(|&place| path.descends(place));
        assert!(descents.eq([3]));
        for place in 0..7 {
            let post = PostId(place as u32);
            assert_eq!(path.place_of(post), (place < 5).then_some(place));
        }
    }

    /// The path crosses access point 0 between places 2 and 3. What is attached to that elsewhere, or to a post that
    /// is not next to its own on the path, stays so by a link that is none of the path.
    #[test]
    fn a_path_takes_the_links_between_places_that_follow_each_other() {
        let path = path(5, 2);
        for place in 0..5 {
            let takes = |other: Anchor| path.takes_link(place, other);
            let posts = (0..7).filter(|&post| takes(Anchor::Post(PostId(post as u32))));
            let next: Vec<usize> = (0..5usize).filter(|post| post.abs_diff(place) == 1).collect();
            assert_eq!(posts.collect::<Vec<_>>(), next);
            let access_points: Vec<usize> =
                (0..2).filter(|&it| takes(Anchor::Access(it))).collect();
            assert_eq!(access_points, if [2, 3].contains(&place) { vec![0] } else { vec![] });
        }
    }
}
