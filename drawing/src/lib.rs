//! The parts of every picture: a sheet, strokes and texts on it, axes with round numbers, and the
//! colours and typefaces that all pictures share.
//!
//! Functions return [`svg`] elements with a position and without a style. The caller adds the style:
//! a class of a style sheet, or colours and widths. Coordinates are in pixels, y downwards, and are
//! always written in the same way, so that equal pictures have equal bytes.
//!
//! ```
//! use pleach_drawing::{line, sheet, style, text};
//!
//! let picture = sheet([0.0, 0.0], [120.0, 40.0])
//!     .add(line([10.0, 30.0], [110.0, 30.0]).set("stroke", style::INK))
//!     .add(text("ten to one", [10.0, 20.0]));
//! assert!(picture.to_string().contains(r##"<line stroke="#1b1f24" x1="10" x2="110" y1="30" y2="30"/>"##));
//! ```

#![warn(unreachable_pub)]

mod axis;
mod paper;
pub mod style;

pub use axis::{Axis, Tick, named, power_of_ten, round_below};
pub use paper::{Spot, corners, disc, layer, line, number, polyline, rectangle, sheet, text};
pub use svg;
