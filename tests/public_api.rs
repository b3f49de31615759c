//! The public API of the published packages, held by a snapshot for each in `api/`.
//!
//! `cargo test --test it public_api -- --ignored` compares them with the sources, and with
//! `PLEACH_UPDATE_DOCS=1` writes them anew. A snapshot has every declaration that is `pub`, also in
//! modules that are not; what is not for users (`abstraction`) is left out.

use crate::generated::{keep_up_to_date, root};
use std::fs;
use std::path::{Path, PathBuf};

/// The published packages: name and folder.
const PACKAGES: [(&str, &str); 7] = [
    ("pleach-guards", "guards"),
    ("pleach-discrete", "discrete"),
    ("pleach-continuous", "continuous"),
    ("pleach-drawing", "drawing"),
    ("pleach-automaton", "automaton"),
    ("pleach-verify", "verify"),
    ("pleach", ""),
];

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        if ["tests", "proofs", "abstraction"].contains(&name.as_str()) {
            continue;
        }
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The declarations of a file, each on one line, with what they belong to.
fn declarations(source: &str) -> Vec<String> {
    let lines: Vec<&str> = source.lines().take_while(|line| *line != "mod tests {").collect();
    let mut found = Vec::new();
    let mut block: Option<Block> = None;
    let mut at = 0;
    while at < lines.len() {
        let (line, indent) = (lines[at], lines[at].len() - lines[at].trim_start().len());
        let text = line.trim_start();
        at += 1;
        if block.as_ref().is_some_and(|block| indent <= block.indent && text.starts_with('}')) {
            block = None;
        }
        if text.is_empty() || text.starts_with("//") || text.starts_with('#') {
            continue;
        }
        let is_head = text.starts_with("impl") && indent == 0;
        let is_member = block.as_ref().is_some_and(|block| block.has(text, indent));
        if !is_head && !text.starts_with("pub ") && !is_member {
            continue;
        }
        let mut declaration = text.to_owned();
        while !is_complete(&declaration) && at < lines.len() {
            declaration.push(' ');
            declaration.push_str(lines[at].trim());
            at += 1;
        }
        let opens = declaration.ends_with('{');
        let declaration = shortened(&declaration);
        if !is_head {
            let owner = block.as_ref().map_or(String::new(), |block| format!("{} :: ", block.head));
            found.push(format!("{owner}{declaration}"));
        }
        let is_owner = is_head
            || ["pub enum", "pub struct", "pub trait"].iter().any(|it| text.starts_with(it));
        if opens && is_owner {
            block = Some(Block { head: declaration, indent });
        }
    }
    found
}

/// An implementation, a trait, an enum or a struct that is open.
struct Block {
    head: String,
    indent: usize,
}

impl Block {
    /// Whether a line that does not say `pub` declares something public here: variants of enums
    /// and what traits ask for.
    fn has(&self, text: &str, indent: usize) -> bool {
        let is_item = ["fn ", "type ", "const ", "async "].iter().any(|it| text.starts_with(it));
        indent == self.indent + 4
            && (self.head.starts_with("pub enum") && text.starts_with(char::is_uppercase)
                || self.head.starts_with("pub trait") && is_item)
    }
}

/// Whether a declaration goes on no further.
fn is_complete(text: &str) -> bool {
    let depth = text.chars().fold(0_i32, |depth, letter| match letter {
        '(' | '[' => depth + 1,
        ')' | ']' => depth - 1,
        _ => depth,
    });
    let is_use = text.starts_with("pub use");
    let ends = text.ends_with([';', ',', '}']) || text.ends_with('{') && !is_use;
    depth == 0 && ends && (!is_use || text.ends_with(';'))
}

/// Without the body and the value.
fn shortened(text: &str) -> String {
    let is_use = text.starts_with("pub use");
    let text = text.trim_end_matches(['{', ';', ',']).trim_end();
    let text = match text.split_once(" = ") {
        Some((head, _)) if text.starts_with("pub const") || text.starts_with("pub static") => head,
        _ => text,
    };
    let text = match text.split_once(" { ") {
        Some((head, _)) if text.contains("fn ") && !is_use => head,
        _ => text,
    };
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
#[ignore = "a command for maintainers; the module says how to use it"]
fn the_snapshots_are_the_public_api() {
    for (package, folder) in PACKAGES {
        let sources = root().join(folder).join("src");
        let mut paths = Vec::new();
        files(&sources, &mut paths);
        let mut page = format!("# {package}: every public declaration, see tests/public_api.rs\n");
        for path in paths {
            let found = declarations(&fs::read_to_string(&path).unwrap());
            if found.is_empty() {
                continue;
            }
            let path = path.strip_prefix(&sources).unwrap().to_string_lossy().replace('\\', "/");
            page += &format!("\n{path}\n");
            found.iter().for_each(|declaration| page += &format!("    {declaration}\n"));
        }
        keep_up_to_date(&format!("api/{package}.txt"), &page, "public_api -- --ignored");
    }
}

#[test]
fn declarations_are_read_with_what_they_belong_to() {
    let source = "\
/// A lamp.
pub struct Lamp {
    /// Whether it is lit.
    pub is_lit: bool,
    age: f64,
}

pub(crate) fn hidden() {}

impl Lamp {
    /// Turns it.
    pub fn turn(
        &mut self,
        by: f64,
    ) -> bool {
        true
    }
}

pub enum Colour {
    Red,
    Mixed { share: f64 },
}

pub const MOST: usize = 3;
mod tests {
    pub fn never() {}
";
    let expected = [
        "pub struct Lamp",
        "pub struct Lamp :: pub is_lit: bool",
        "impl Lamp :: pub fn turn( &mut self, by: f64, ) -> bool",
        "pub enum Colour",
        "pub enum Colour :: Red",
        "pub enum Colour :: Mixed { share: f64 }",
        "pub const MOST: usize",
    ];
    assert_eq!(declarations(source), expected);
}
