//! Posts: the places of the tree network (Definition 5.2).
//!
//! The tree is a tree of posts, and robots hold posts. "Robot s_i adopts the role that s_{i+1}
//! had" (Algorithm 4) means that the holder of a post changes; the tree does not. Junction, leaf
//! and node are facts about a post: a leaf services a task, a junction bears several branches,
//! and one post can be both.

/// The identity of a post, unique in a mission.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct PostId(pub u32);

/// What a post is attached to: its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
pub enum Anchor {
    /// The access point with this number, from 0.
    Access(usize),
    /// Another post.
    Post(PostId),
}

/// What kind of place a post is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case", deny_unknown_fields))]
pub enum PostKind {
    /// Held by a redundant robot, wherever it stands.
    Redundant,
    /// A fixed place of the tree: its reference position does not move.
    Fixed,
    /// A place in the primary team, moving; it follows another post, or leads (eq. 24).
    Primary {
        /// The next post of the team; none for the leader's.
        follows: Option<PostId>,
    },
}

/// A post of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Post {
    /// Its identity.
    pub id: PostId,
    /// What it is.
    pub kind: PostKind,
    /// Its parent; none for a redundant robot that is not attached yet.
    pub parent: Option<Anchor>,
    /// The task serviced from it.
    pub task: Option<usize>,
}

impl Post {
    /// The post of a redundant robot that is not attached yet.
    pub const fn redundant(id: PostId) -> Self {
        Post { id, kind: PostKind::Redundant, parent: None, task: None }
    }

    /// Whether the robot that holds it may be recruited.
    pub const fn is_redundant(&self) -> bool {
        matches!(self.kind, PostKind::Redundant)
    }

    /// Whether it is a fixed place.
    pub const fn is_fixed(&self) -> bool {
        matches!(self.kind, PostKind::Fixed)
    }

    /// Whether it belongs to the primary team.
    pub const fn is_primary(&self) -> bool {
        matches!(self.kind, PostKind::Primary { .. })
    }

    /// Whether it heads the primary team.
    pub const fn is_leading(&self) -> bool {
        matches!(self.kind, PostKind::Primary { follows: None })
    }

    /// Whether it is a child of `post`.
    pub fn is_child_of(&self, post: PostId) -> bool {
        self.parent == Some(Anchor::Post(post))
    }

    /// Whether others may attach to it: posts that move with the primary team bear only the next
    /// post of the team.
    pub const fn bears_redundant(&self) -> bool {
        !self.is_primary()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Redundant, fixed, primary, leading, and whether others may attach to it.
    #[test]
    fn posts_are_what_their_kind_says() {
        let follower = PostKind::Primary { follows: Some(PostId(2)) };
        let cases = [
            (PostKind::Redundant, [true, false, false, false, true]),
            (PostKind::Fixed, [false, true, false, false, true]),
            (follower, [false, false, true, false, false]),
            (PostKind::Primary { follows: None }, [false, false, true, true, false]),
        ];
        for (kind, expected) in cases {
            let post = Post { kind, ..Post::redundant(PostId(1)) };
            let found = [post.is_redundant(), post.is_fixed(), post.is_primary()];
            assert_eq!(found, expected[..3], "{kind:?}");
            assert_eq!([post.is_leading(), post.bears_redundant()], expected[3..], "{kind:?}");
        }
    }

    #[test]
    fn a_post_is_a_child_of_its_parent_alone() {
        let free = Post::redundant(PostId(1));
        let child = Post { parent: Some(Anchor::Post(PostId(2))), ..free };
        let rooted = Post { parent: Some(Anchor::Access(2)), ..free };
        assert!(child.is_child_of(PostId(2)) && !child.is_child_of(PostId(3)));
        assert!(!free.is_child_of(PostId(2)) && !rooted.is_child_of(PostId(2)));
    }
}
