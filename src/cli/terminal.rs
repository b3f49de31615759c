//! What the terminal at the output can show.

use console::{Term, measure_text_width};

/// Whether lines may be rewritten on the error output: it is a terminal, and not a dumb one.
pub(super) fn is_lively() -> bool {
    let is_dumb = std::env::var_os("TERM").is_some_and(|name| name == "dumb" || name.is_empty());
    Term::stderr().is_term() && !is_dumb
}

/// Columns of the terminal at the standard output, if one is there.
pub(super) fn width() -> Option<usize> {
    columns(&Term::stdout())
}

/// Columns of the terminal at the error output, if one is there.
pub(super) fn error_width() -> Option<usize> {
    columns(&Term::stderr())
}

fn columns(terminal: &Term) -> Option<usize> {
    terminal.size_checked().map(|(_, columns)| usize::from(columns))
}

/// Where the second column of a summary and of a story begins.
pub(super) const SUMMARY_INDENT: usize = 22;
pub(super) const STORY_INDENT: usize = 11;

/// The lines of a text, those that are too long for `width` columns broken between words. What is
/// left of a line begins at column `indent`, or further left in a narrow terminal.
pub(super) fn wrapped(text: &str, width: Option<usize>, indent: usize) -> String {
    let Some(width) = width.filter(|&width| width > 0) else { return text.to_owned() };
    let indent = indent.min(width / 4);
    text.split_inclusive('\n').map(|line| wrapped_line(line, width, indent)).collect()
}

fn wrapped_line(line: &str, width: usize, indent: usize) -> String {
    let (mut done, mut rest) = (String::new(), line.to_owned());
    while measure_text_width(rest.trim_end()) > width {
        let start = rest.len() - rest.trim_start().len();
        // The last space in reach, or for a word that is too long by itself the first behind it.
        let spaces = rest.char_indices().filter(|&(at, c)| c == ' ' && at > start);
        let in_reach = |&(at, _): &(usize, char)| measure_text_width(&rest[..at]) <= width;
        let (near, far): (Vec<_>, Vec<_>) = spaces.partition(in_reach);
        let Some(&(at, _)) = near.last().or(far.first()) else { break };
        done += rest[..at].trim_end();
        done.push('\n');
        rest = format!("{:indent$}{}", "", rest[at..].trim_start_matches(' '));
    }
    done + &rest
}

/// The text cut to `width` columns, with an ellipsis in place of what is missing.
pub(super) fn cut(text: &str, width: Option<usize>) -> String {
    match width {
        Some(width) => console::truncate_str(text, width, "…").into_owned(),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_broken_between_words() {
        let line = "k = 677    subgroup 2, [8 9 10], starts\nshort\n";
        assert_eq!(wrapped(line, None, 11), line);
        assert_eq!(wrapped(line, Some(80), 11), line);
        let narrow = "k = 677    subgroup 2, [8 9\n       10], starts\nshort\n";
        assert_eq!(wrapped(line, Some(28), 11), narrow);
    }

    #[test]
    fn a_word_that_is_too_long_stays_whole() {
        let text = wrapped("path 11→8→12→13→14 and on\n", Some(10), 4);
        assert_eq!(text, "path\n  11→8→12→13→14\n  and on\n");
        assert_eq!(wrapped("11→8→12→13→14", Some(5), 4), "11→8→12→13→14");
    }
}
