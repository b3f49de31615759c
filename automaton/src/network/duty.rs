//! Duties: what a robot does for the network at present.

use pleach_continuous::Point;
use pleach_discrete::network::{Post, path};

/// A post with its reference position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// The post.
    pub post: Post,
    /// Where it is; for posts of redundant robots and of the primary team, where its holder
    /// stood when it took the post.
    pub reference: Point,
}

/// What a robot does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Duty {
    /// It holds a post.
    Hold(Station),
    /// It holds the post at `place` of the path Σ and waits to be relieved or to set out.
    Wait {
        /// What it holds.
        station: Station,
        /// Its place on Σ.
        place: usize,
    },
    /// It has left `place` of the path Σ and is on its way to the next place, eq. (25).
    Shift {
        /// The place that it left.
        place: usize,
    },
}

impl Duty {
    /// The station held, if any.
    pub const fn station(&self) -> Option<&Station> {
        match self {
            Duty::Hold(station) | Duty::Wait { station, .. } => Some(station),
            Duty::Shift { .. } => None,
        }
    }

    /// The station held, if any, to change it.
    pub const fn station_mut(&mut self) -> Option<&mut Station> {
        match self {
            Duty::Hold(station) | Duty::Wait { station, .. } => Some(station),
            Duty::Shift { .. } => None,
        }
    }

    /// The post held, if any.
    pub const fn post(&self) -> Option<&Post> {
        match self.station() {
            Some(station) => Some(&station.post),
            None => None,
        }
    }

    /// The place on Σ, of a robot that waits or is on its way.
    pub const fn place(&self) -> Option<usize> {
        match *self {
            Duty::Hold(_) => None,
            Duty::Wait { place, .. } | Duty::Shift { place } => Some(place),
        }
    }

    /// Whether the duty is to move with the primary team.
    pub fn is_primary(&self) -> bool {
        self.post().is_some_and(Post::is_primary)
    }

    /// Whether the robot holds a fixed post.
    pub fn is_fixed(&self) -> bool {
        self.post().is_some_and(Post::is_fixed)
    }

    /// Whether the robot is free to be recruited.
    pub fn is_redundant(&self) -> bool {
        self.post().is_some_and(Post::is_redundant)
    }
}

/// A place of the path Σ with its reference position and where its robot stood at t_h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The reference position of the post there.
    pub reference: Point,
    /// x(t_h) of the robot there.
    pub position: Point,
}

/// The path Σ with its geometry.
pub type Path = path::Path<Place>;
/// One place of the path Σ with its geometry.
pub type Hop = path::Hop<Place>;
