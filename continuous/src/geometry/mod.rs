//! Free space, geodesics and cells.

pub mod shape;

pub use shape::{Disc, HalfPlane};
