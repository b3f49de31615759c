//! The way from a post to its access point, as a path vector.
//!
//! Every robot tells its neighbours its lineage. A redundant robot hangs itself on the neighbour
//! with the shortest one; a lineage that already contains the robot's own post is refused, so
//! that no cycle can close.

use super::PostId;

/// The posts from one post up to the access point, the post itself first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lineage {
    posts: Vec<PostId>,
    root: usize,
}

/// Whether a post that hung itself on the bearer of this way would close a cycle: the way leads
/// through it.
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

    /// The lineage of a post that hangs on the bearer of this one; none if that would close a
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
