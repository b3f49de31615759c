//! What people read is written in plain technical English: the words that CONTRIBUTING.md lists as never right stand
//! neither in the pages nor in the messages of the program.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::sources::{files_below, read, relative, root};

/// Sources whose string literals are messages to people.
const MESSAGES: [&str; 2] = ["src", "verify/src/network/judge"];

/// The words of the list in CONTRIBUTING.md that are never right, in lower case.
fn never_right() -> Vec<String> {
    let document = read("CONTRIBUTING.md");
    let (_, list) = document.split_once("| never | but |").unwrap();
    let rows = list.lines().skip(2).take_while(|line| line.starts_with("| "));
    let cells = rows.map(|row| row.split('|').nth(1).unwrap());
    cells.flat_map(|cell| cell.split(',')).map(|word| word.trim().to_owned()).collect()
}

/// The words of a text, in lower case.
fn words(text: &str) -> Vec<String> {
    let words = text.split(|letter: char| !letter.is_alphabetic());
    words.filter(|word| !word.is_empty()).map(str::to_lowercase).collect()
}

/// The expressions of the list that a text has.
fn found<'a>(never: &'a [String], text: &str) -> BTreeSet<&'a str> {
    let words = words(text).join(" ");
    let padded = format!(" {words} ");
    never.iter().map(String::as_str).filter(|word| padded.contains(&format!(" {word} "))).collect()
}

/// A page without what is generated, code, and the targets of links.
fn prose(page: &str) -> String {
    let mut text = String::new();
    let (mut is_code, mut is_generated) = (false, page.starts_with("<!-- Generated"));
    for line in page.lines() {
        match line {
            _ if line.starts_with("```") => is_code = !is_code,
            _ if line.starts_with("<!-- begin") => is_generated = true,
            _ if line.starts_with("<!-- end") => is_generated = false,
            _ if !is_code && !is_generated => text.extend([line, "\n"]),
            _ => {}
        }
    }
    let spans = text.split('`').step_by(2).collect::<Vec<_>>().join(" ");
    let mut parts = spans.split("](");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + " " + part.split_once(')').map_or(part, |(_, rest)| rest))
}

#[test]
fn no_page_has_a_word_that_is_never_right() {
    let never = never_right();
    assert!(never.len() > 10, "{never:?}");
    let mut pages = files_below(root().join("docs"));
    pages.retain(|path| path.extension().is_some_and(|it| it == "md"));
    pages.push(root().join("README.md"));
    let wrong = pages.iter().filter_map(|path| {
        let text = prose(&fs::read_to_string(path).unwrap());
        let found = found(&never, &text);
        (!found.is_empty()).then(|| format!("{}: {found:?}", relative(path)))
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "see the list of words in CONTRIBUTING.md:\n{}", wrong.join("\n"));
}

/// The string literals of a source that are sentences.
#[derive(Default)]
struct Messages(Vec<String>);

impl Messages {
    fn of(path: &Path) -> Vec<String> {
        let mut messages = Messages::default();
        let source: proc_macro2::TokenStream = fs::read_to_string(path).unwrap().parse().unwrap();
        messages.collect(source);
        messages.0
    }

    /// Documentation is a literal, too: `#[doc = "…"]`; what stands in attributes of errors is a message.
    fn collect(&mut self, tokens: proc_macro2::TokenStream) {
        let mut is_documentation = false;
        for token in tokens {
            match token {
                proc_macro2::TokenTree::Group(group) => self.collect(group.stream()),
                proc_macro2::TokenTree::Ident(name) => is_documentation = name == "doc",
                proc_macro2::TokenTree::Literal(literal) if !is_documentation => {
                    let text = literal.to_string();
                    self.0.extend((text.starts_with('"') && text.contains(' ')).then_some(text));
                }
                _ => {}
            }
        }
    }
}

#[test]
fn no_message_has_a_word_that_is_never_right() {
    let never = never_right();
    let (mut wrong, mut count) = (Vec::new(), 0);
    let files = MESSAGES.iter().flat_map(|folder| files_below(root().join(folder)));
    for path in files.filter(|path| path.extension().is_some_and(|it| it == "rs")) {
        for message in Messages::of(&path) {
            count += 1;
            let found = found(&never, &message);
            if !found.is_empty() {
                wrong.push(format!("{}: {found:?} in {message}", relative(&path)));
            }
        }
    }
    assert!(count > 500, "only {count} messages are found");
    assert!(wrong.is_empty(), "see the list of words in CONTRIBUTING.md:\n{}", wrong.join("\n"));
}

#[test]
fn a_word_is_found_as_a_word_and_in_prose_only() {
    let never = ["held against".to_owned(), "anew".to_owned()];
    for wrong in ["It is held\nagainst the rules.", "Anew, it begins", "[anew](page.md)"] {
        assert_eq!(found(&never, &prose(wrong)).len(), 1, "{wrong}");
    }
    for right in ["`anew`", "```text\nanew\n```", "[page](anew.md)", "he manewed", "held"] {
        assert!(found(&never, &prose(right)).is_empty(), "{right}");
    }
}
