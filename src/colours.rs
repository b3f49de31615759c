//! The colours that figures and pages share, besides those of every picture.
//!
//! The colours of marks are those of Okabe and Ito, which people with any kind of colour vision
//! can tell apart; where the captions of the paper ask for a hue that they lack, the lightness
//! differs. No meaning rests on colour alone: every mark has a shape of its own too.

use pleach_drawing::style::WORDS;
pub(crate) use pleach_drawing::style::{BAND, GRID, INK, PAPER, QUIET};

/// Walls and holes.
pub(crate) const WALL: &str = "#454d5c";
/// Space in which robots may be.
pub(crate) const FLOOR: &str = "#fbfaf6";
/// The outline of W_f and limits that may not be crossed.
pub(crate) const LIMIT: &str = "#d0342c";
/// Communication links.
pub(crate) const LINK: &str = "#6cc79a";
/// Edges of the tree.
pub(crate) const TREE: &str = "#b8232f";
/// Where robots have been since the picture before.
pub(crate) const TRAIL: &str = "#e0a458";
/// Tasks.
pub(crate) const TASK: &str = "#1f6fd0";
/// Access points.
pub(crate) const ACCESS_POINT: &str = "#0072b2";
/// Leaders.
pub(crate) const LEADER: &str = "#e3262e";
/// Members of the primary team.
pub(crate) const MEMBER: &str = "#f08c00";
/// Recruits and the path Σ on which they go.
pub(crate) const RECRUIT: &str = "#8e44ad";
/// Junctions.
pub(crate) const JUNCTION: &str = "#f7dc3b";
/// Leaves.
pub(crate) const LEAF: &str = "#009e73";
/// Nodes that relay.
pub(crate) const NODE: &str = "#9aa1ac";
/// Redundant robots.
pub(crate) const REDUNDANT: &str = "#14161a";

/// Every colour that a screen needs, by its name in style sheets: on light and on dark ground.
const SCREEN: [(&str, &str, &str); 22] = [
    ("paper", PAPER, "#171a20"),
    ("wall", WALL, "#4d5666"),
    ("floor", FLOOR, "#0f1216"),
    ("ink", INK, "#e8eaee"),
    ("quiet", QUIET, "#9aa3b2"),
    ("grid", GRID, "#2b313b"),
    ("band", BAND, "#1d2128"),
    ("limit", LIMIT, "#ff6b5e"),
    ("link", LINK, "#2f8f63"),
    ("tree", TREE, "#e8505b"),
    ("trail", TRAIL, "#c98d3e"),
    ("task", TASK, "#5b9df0"),
    ("access-point", ACCESS_POINT, "#3b9be0"),
    ("leader", LEADER, "#ff4a50"),
    ("primary-team", MEMBER, "#ff9d1e"),
    ("recruit", RECRUIT, "#b678d6"),
    ("junction", JUNCTION, "#f7dc3b"),
    ("leaf", LEAF, "#17bd8d"),
    ("node", NODE, "#7d8696"),
    ("redundant", REDUNDANT, "#d9dde4"),
    ("outline", INK, "#0b0d10"),
    ("good", LEAF, "#17bd8d"),
];

/// The colours as custom properties of a style sheet, for light and dark screens. On paper
/// everything is light.
pub(crate) fn style_sheet() -> String {
    let declared = |dark: bool| {
        let screen = SCREEN
            .map(|(name, light, dim)| format!("--{name}: {};", if dark { dim } else { light }));
        let curves = CURVES.iter().zip(DARK_CURVES).enumerate().map(|(number, (light, dim))| {
            format!("--curve-{number}: {};", if dark { dim } else { light })
        });
        screen.into_iter().chain(curves).collect::<Vec<_>>().join(" ")
    };
    let (light, dark) = (declared(false), declared(true));
    let font = WORDS.families;
    format!(
        ":root {{ color-scheme: light; --font: {font}; {light} }}\n\
         @media screen and (prefers-color-scheme: dark) {{ :root {{ color-scheme: dark; {dark} }} }}\n\
         @media screen {{\n\
         :root[data-theme=\"light\"] {{ color-scheme: light; {light} }}\n\
         :root[data-theme=\"dark\"] {{ color-scheme: dark; {dark} }}\n\
         }}"
    )
}

/// Colours of curves that belong to robots; beyond them the curves are dashed.
pub(crate) const CURVES: [&str; 12] = [
    "#0072b2", "#d55e00", "#009e73", "#8e44ad", "#b8860b", "#56b4e9", "#c0392b", "#117733",
    "#cc79a7", "#5d4037", "#3f51b5", "#7f8c1f",
];

/// The same hues, lighter, for curves on dark ground.
const DARK_CURVES: [&str; 12] = [
    "#4aa3e0", "#ff8a3d", "#2cc79a", "#b678d6", "#d9a93a", "#8fd0f5", "#ff7466", "#5cb86b",
    "#e59cc6", "#b08d80", "#8391f0", "#b5c24a",
];
