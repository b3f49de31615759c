//! What pictures on a screen have in common with those on paper, as data for scripts.

use serde_json::{Value, json};

use super::marks::{Mark, moment_strokes};
use super::scene::{FAINT_WIDTH, FULL_WIDTH, TREE_SHARE};
use crate::story::Moment;

/// A mark: its key, which is also the name of its colour, what legends say, and its outline.
pub(crate) fn mark_data(mark: Mark) -> Value {
    json!({ "key": mark.key(), "name": mark.name(), "shape": mark.shape() })
}

/// The mark of a moment: what legends say, and its strokes.
pub(crate) fn moment_data(moment: Moment) -> Value {
    json!({ "name": moment.name(), "strokes": moment_strokes(moment) })
}

/// How thick a link is drawn: `faint` and `full` more for T·R = 1, and the share of that which an
/// edge of the tree takes.
pub(crate) fn link_data() -> Value {
    json!({ "faint": FAINT_WIDTH, "full": FULL_WIDTH, "tree": TREE_SHARE })
}
