//! The way from a post to its access point, as a path vector.
//!
//! Every robot sends its lineage to its neighbours. A redundant robot attaches to the neighbour
//! with the shortest one; a lineage that already contains the robot's own post is refused, so
//! that no cycle closes. Where messages are lost, lineages may be old: then a [`Confirmation`](super::Confirmation) tells.

use super::PostId;

#[cfg(any(kani, test))]
mod proofs;

/// The posts from one post up to the access point, the post itself first.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "super::serialization::LineageParts"))]
pub struct Lineage {
    posts: Vec<PostId>,
    root: usize,
}

/// Whether a post would close a cycle if it were attached to the last post of this path: the path
/// leads through it.
///
/// ```
/// use pleach_discrete::network::PostId;
/// use pleach_discrete::network::lineage::closes_cycle;
///
/// let way = [PostId(4), PostId(1)];
/// assert!(closes_cycle(&way, PostId(1)));
/// assert!(!closes_cycle(&way, PostId(2)));
/// ```
pub fn closes_cycle(way: &[PostId], post: PostId) -> bool {
    way.contains(&post)
}

impl Lineage {
    /// The lineage of access point `root`.
    pub const fn of_access_point(root: usize) -> Self {
        Lineage { posts: Vec::new(), root }
    }

    /// The lineage through these posts; none if it leads through one of them twice.
    #[cfg(feature = "serde")]
    pub(super) fn from_parts(posts: Vec<PostId>, root: usize) -> Option<Self> {
        let is_new = |(at, post): (usize, &PostId)| !posts[..at].contains(post);
        posts.iter().enumerate().all(is_new).then_some(Lineage { posts, root })
    }

    /// The lineage of a post that is attached to the post of this one; none if that would close a
    /// cycle.
    pub fn extended_by(&self, post: PostId) -> Option<Self> {
        if self.contains(post) {
            return None;
        }
        let mut posts = Vec::with_capacity(self.posts.len() + 1);
        posts.push(post);
        posts.extend_from_slice(&self.posts);
        Some(Lineage { posts, root: self.root })
    }

    /// Whether this is the lineage of `post` extended from `parent`, without building it.
    pub fn extends(&self, parent: &Lineage, post: PostId) -> bool {
        self.root == parent.root
            && self
                .posts
                .split_first()
                .is_some_and(|(&first, rest)| first == post && rest == parent.posts)
    }

    /// The number of links to the access point.
    pub const fn hops(&self) -> usize {
        self.posts.len()
    }

    /// The access point at the end.
    pub const fn root(&self) -> usize {
        self.root
    }

    /// Whether the way leads through `post`.
    pub fn contains(&self, post: PostId) -> bool {
        closes_cycle(&self.posts, post)
    }

    /// The posts on the way, the first being the post itself.
    pub fn posts(&self) -> &[PostId] {
        &self.posts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lineage of the last of `posts`, each attached to the one before it.
    fn lineage(root: usize, posts: &[u32]) -> Lineage {
        posts.iter().fold(Lineage::of_access_point(root), |lineage, &post| {
            lineage.extended_by(PostId(post)).expect("the posts differ")
        })
    }

    #[test]
    fn the_way_leads_up_to_the_access_point() {
        let way = lineage(3, &[4, 6, 5]);
        assert_eq!(way.posts(), [5, 6, 4].map(PostId));
        assert_eq!((way.hops(), way.root()), (3, 3));
        assert_eq!(lineage(2, &[]).hops(), 0);
        let passed = (0..9).filter(|&post| way.contains(PostId(post)));
        assert!(passed.eq([4, 5, 6]));
    }

    #[test]
    fn no_post_comes_twice() {
        let way = lineage(0, &[4, 6]);
        for post in 0..9 {
            assert_eq!(way.extended_by(PostId(post)).is_none(), [4, 6].contains(&post));
            assert_eq!(closes_cycle(way.posts(), PostId(post)), [4, 6].contains(&post));
        }
    }

    /// Posts 0 to 3 in any forest below an access point: the lineage of each, none where it knows no way.
    fn lineages(parents: &[Option<usize>; 4]) -> Vec<Option<Lineage>> {
        let mut known = vec![None; 4];
        known.push(Some(Lineage::of_access_point(0)));
        for _ in 0..4 {
            for (post, parent) in parents.iter().enumerate() {
                let way = parent.and_then(|parent| known[parent].as_ref());
                known[post] = way.and_then(|way: &Lineage| way.extended_by(PostId(post as u32)));
            }
        }
        known
    }

    /// Every forest of four posts, every post and every parent that knows a way: the lineage of the parent is
    /// extended exactly where the lemma `forest.smt2` wants it, that is, unless the parent is below the post;
    /// and then the posts above each one, as their lineages tell, are those of the lemma.
    #[test]
    fn attaching_a_post_is_the_step_of_the_lemma() {
        let mut attached = 0;
        for code in 0..6_usize.pow(4) {
            let parents = [1, 6, 36, 216].map(|unit| Some(code / unit % 6).filter(|&it| it < 5));
            let before = lineages(&parents);
            let above = |ways: &[Option<Lineage>], x: usize, y: usize| {
                x == y || ways[x].as_ref().is_some_and(|way| way.contains(PostId(y as u32)))
            };
            if (0..4).any(|post| parents[post].is_some() && before[post].is_none()) {
                continue; // in a cycle, or attached to one that knows no way
            }
            for (post, parent) in (0..4).flat_map(|post| (0..5).map(move |parent| (post, parent))) {
                let Some(way) = &before[parent] else { continue };
                let is_below = parent < 4 && above(&before, parent, post);
                assert_eq!(way.extended_by(PostId(post as u32)).is_none(), is_below);
                if is_below {
                    continue;
                }
                attached += 1;
                let mut changed = parents;
                changed[post] = Some(parent);
                let after = lineages(&changed);
                for (x, y) in (0..4).flat_map(|x| (0..4).map(move |y| (x, y))) {
                    let expected = match above(&before, x, post) {
                        true => {
                            above(&before, x, y) && above(&before, y, post)
                                || above(&before, parent, y)
                        }
                        false => above(&before, x, y),
                    };
                    assert_eq!(above(&after, x, y), expected, "{parents:?} {post} {parent}");
                }
            }
        }
        assert!(attached > 1_000, "only {attached}");
    }

    /// Root, post and parent all have to be the same; an access point extends nothing.
    #[test]
    fn an_extension_is_known_without_building_it() {
        let ways = [lineage(0, &[]), lineage(1, &[]), lineage(0, &[4]), lineage(1, &[4])];
        let ways = ways.into_iter().chain([lineage(0, &[4, 6]), lineage(0, &[6])]);
        let ways: Vec<Lineage> = ways.collect();
        for way in &ways {
            for parent in &ways {
                for post in [4, 6].map(PostId) {
                    let extends = parent.extended_by(post).as_ref() == Some(way);
                    assert_eq!(way.extends(parent, post), extends, "{way:?} {parent:?} {post:?}");
                }
            }
        }
    }
}
