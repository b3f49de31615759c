//! The colours and typefaces that all pictures share.

/// The sheet.
pub const PAPER: &str = "#ffffff";
/// Texts, outlines and arrows.
pub const INK: &str = "#1b1f24";
/// Texts of second rank, and axes.
pub const QUIET: &str = "#5d6773";
/// Lines of a grid.
pub const GRID: &str = "#e3e6ea";
/// The ground of every second row or column.
pub const BAND: &str = "#f4f6f9";

/// A typeface with what can be known of it without its files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Typeface {
    /// The families, the first that is installed.
    pub families: &'static str,
    /// The mean width of a character, as a share of the size of the type.
    pub character_width: f64,
}

/// For words and numbers.
pub const WORDS: Typeface = Typeface {
    families: "Inter, 'Helvetica Neue', Helvetica, Arial, 'Liberation Sans', sans-serif",
    character_width: 0.54,
};

/// For formulas: it has the signs of logic, and sets dots above letters well.
pub const FORMULAS: Typeface = Typeface {
    families: "'DejaVu Sans', 'Segoe UI', Helvetica, Arial, sans-serif",
    character_width: 0.6,
};

impl Typeface {
    /// How wide a line of text is about, in pixels, if its type has this size.
    #[must_use]
    pub fn width(&self, text: &str, size: f64) -> f64 {
        text.chars().count() as f64 * size * self.character_width
    }
}
