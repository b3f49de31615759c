//! The colours and type sizes that all figures share.
//!
//! The colours of marks are those of Okabe and Ito, which people with any kind of colour vision
//! can tell apart; where the captions of the paper ask for a hue that they lack, the lightness
//! differs. No meaning rests on colour alone: every mark has a shape of its own too.

/// Paper around the drawing.
pub(super) const PAPER: &str = "#ffffff";
/// Walls and holes.
pub(super) const WALL: &str = "#454d5c";
/// Space in which robots may be.
pub(super) const FLOOR: &str = "#fbfaf6";
/// Titles and marks' outlines.
pub(super) const INK: &str = "#1b1f27";
/// Text of second rank, axes.
pub(super) const QUIET: &str = "#5d6573";
/// Grid lines.
pub(super) const GRID: &str = "#e3e5e9";
/// Background of every second task in the curves.
pub(super) const BAND: &str = "#f4f5f8";
/// The outline of W_f and limits that may not be crossed.
pub(super) const LIMIT: &str = "#d0342c";
/// Communication links.
pub(super) const LINK: &str = "#6cc79a";
/// Edges of the tree.
pub(super) const TREE: &str = "#b8232f";
/// Where robots have been since the picture before.
pub(super) const TRAIL: &str = "#e0a458";
/// Tasks.
pub(super) const TASK: &str = "#1f6fd0";
/// Access points.
pub(super) const ACCESS_POINT: &str = "#0072b2";
/// Leaders.
pub(super) const LEADER: &str = "#e3262e";
/// Members of the primary team.
pub(super) const MEMBER: &str = "#f08c00";
/// Recruits and the path Σ on which they go.
pub(super) const RECRUIT: &str = "#8e44ad";
/// Junctions.
pub(super) const JUNCTION: &str = "#f7dc3b";
/// Leaves.
pub(super) const LEAF: &str = "#009e73";
/// Nodes that relay.
pub(super) const NODE: &str = "#9aa1ac";
/// Redundant robots.
pub(super) const REDUNDANT: &str = "#14161a";

/// Colours of curves that belong to robots; beyond them the curves are dashed.
pub(super) const CURVES: [&str; 12] = [
    "#0072b2", "#d55e00", "#009e73", "#8e44ad", "#b8860b", "#56b4e9", "#c0392b", "#117733",
    "#cc79a7", "#5d4037", "#3f51b5", "#7f8c1f",
];

/// The typefaces, the first that is installed.
pub(super) const FONT: &str =
    "Inter, 'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', sans-serif";
/// Size of titles.
pub(super) const TITLE_SIZE: f64 = 20.0;
/// Size of subtitles and names of axes.
pub(super) const SUBTITLE_SIZE: f64 = 13.0;
/// Size of the legend and of numbers at axes.
pub(super) const TEXT_SIZE: f64 = 12.0;
/// Size of the numbers beside marks.
pub(super) const LABEL_SIZE: f64 = 10.5;
/// Width of a character relative to the size of its type, on average.
pub(super) const CHARACTER_WIDTH: f64 = 0.54;
/// Width of every figure in its own units, and on paper in pixels.
pub(super) const WIDTH: f64 = 960.0;
