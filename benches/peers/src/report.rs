//! The tables that a comparison ends with.

use std::fmt::{self, Display, Write as _};
use std::path::Path;
use std::{fs, io};

/// Tables, as Markdown.
#[derive(Default)]
pub struct Report(String);

/// What stands before and after the tables in a document; the first line goes on after this.
const BEGIN: &str = "<!-- begin of the comparison";
const END: &str = "<!-- end of the comparison -->";

impl Report {
    /// Begins a table with these columns.
    pub fn table(&mut self, columns: &[&str]) {
        if !self.0.is_empty() {
            self.0.push('\n');
        }
        self.row(columns.iter().map(ToString::to_string));
        self.row(columns.iter().map(|_| "---".to_owned()));
    }

    /// Adds a row to the table.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        let cells: Vec<String> = cells.into_iter().collect();
        // Text is not lost in a string.
        let _ = writeln!(self.0, "| {} |", cells.join(" | "));
    }

    /// Replaces the tables in a document.
    pub fn put_into(&self, document: &Path) -> io::Result<()> {
        let text = fs::read_to_string(document)?;
        let missing = || io::Error::other("the document has no place for the comparison");
        let begin = text.find(BEGIN).ok_or_else(missing)?;
        let first = begin + text[begin..].find('\n').ok_or_else(missing)? + 1;
        let end = first + text[first..].find(END).ok_or_else(missing)?;
        fs::write(document, format!("{}{}{}", &text[..first], self.0, &text[end..]))
    }
}

impl Display for Report {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}
