//! What the terminal at the output can show.

use console::Term;

/// Whether lines may be rewritten on the error output: it is a terminal, and not a dumb one.
pub fn is_lively() -> bool {
    let is_dumb = std::env::var_os("TERM").is_some_and(|name| name == "dumb" || name.is_empty());
    Term::stderr().is_term() && !is_dumb
}

/// Columns of the terminal at the standard output, if one is there.
pub fn width() -> Option<usize> {
    Term::stdout().size_checked().map(|(_, columns)| usize::from(columns))
}

/// The text cut to `width` columns, with an ellipsis in place of what is missing.
pub fn cut(text: &str, width: Option<usize>) -> String {
    match width {
        Some(width) => console::truncate_str(text, width, "…").into_owned(),
        None => text.to_owned(),
    }
}
