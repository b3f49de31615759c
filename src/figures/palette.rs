//! The colours and type sizes that all figures share.

pub(crate) use crate::colours::*;

/// Size of titles.
pub(crate) const TITLE_SIZE: f64 = 20.0;
/// Size of subtitles and names of axes.
pub(crate) const SUBTITLE_SIZE: f64 = 13.0;
/// Size of the legend and of numbers at axes.
pub(crate) const TEXT_SIZE: f64 = 12.0;
/// Size of the numbers beside marks.
pub(crate) const LABEL_SIZE: f64 = 10.5;
/// Width of every figure in its own units, and on paper in pixels.
pub(crate) const WIDTH: f64 = 960.0;
