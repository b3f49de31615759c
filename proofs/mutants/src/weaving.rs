//! Sources with switches: every mutant is in the text, and at most one of them is switched on.
//!
//! ```text
//! a < b              (if none(&[7, 8]) { a < b } else if is(7) { a == b } else { a > b })
//! fn f() -> u8 {…}   fn f() -> u8 { if is(9) { return 0; } … }
//! x if y => …        x if !is(10) && (y) => …
//! ```
//!
//! The branch without mutants contains the switches of what is within it. The other branches are the
//! original text with one change.

use std::collections::BTreeMap;
use std::ops::Range;

use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use crate::Error;
use crate::listing::{Genre, Mutant, Span};

/// Where the functions are that say which mutant is switched on: see [`SWITCHES`].
const PATH: &str = "crate::mutant_switches";

/// The module that is added to the package.
pub const SWITCHES: &str = include_str!("switches.rs");

/// A source file with switches.
pub struct Woven {
    pub text: String,
    /// Stretches of the text, each with the mutants that it is there for.
    stretches: Vec<(Range<usize>, Vec<usize>)>,
}

impl Woven {
    /// The mutants that the narrowest stretch about this byte of the text is there for.
    pub fn at(&self, byte: usize) -> Option<&[usize]> {
        let around = self.stretches.iter().filter(|(range, _)| range.contains(&byte));
        around.min_by_key(|(range, _)| range.len()).map(|(_, mutants)| &**mutants)
    }

    /// The mutants that are in the text.
    pub fn mutants(&self) -> impl Iterator<Item = usize> {
        self.stretches.iter().flat_map(|(_, mutants)| mutants.iter().copied())
    }
}

/// What of the text depends on switches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Site {
    /// An expression, from byte to byte.
    Expression(usize, usize),
    /// What begins at this byte is left out.
    Body(usize),
    /// Whether an arm is considered: the end of its pattern, and its guard.
    Arm(usize, Option<(usize, usize)>),
}

/// The file with a switch for each of these mutants. Those for which there is no place in the syntax are
/// left out.
pub fn woven(file: &str, text: &str, mutants: &[&Mutant]) -> Result<Woven, Error> {
    let syntax =
        syn::parse_file(text).map_err(|source| Error::Syntax { file: file.to_owned(), source })?;
    let lines = Lines::of(text);
    let mut finder = Finder { lines: &lines, sites: BTreeMap::new() };
    finder.visit_file(&syntax);
    let mut sites: BTreeMap<Site, Vec<(usize, String)>> = BTreeMap::new();
    for mutant in mutants {
        let Span { start, end } = mutant.span;
        let span = lines.byte(start.line, start.column - 1)..lines.byte(end.line, end.column - 1);
        let Some(site) = finder.site_of(mutant, span.start) else { continue };
        let alternative = match site {
            Site::Expression(start, end) => {
                [&text[start..span.start], &*mutant.replacement, &text[span.end..end]].concat()
            }
            Site::Body(_) | Site::Arm(..) => mutant.replacement.clone(),
        };
        sites.entry(site).or_default().push((mutant.number, alternative));
    }
    Ok(assembled(text, &sites))
}

/// The text with what is put in at each site.
fn assembled(text: &str, sites: &BTreeMap<Site, Vec<(usize, String)>>) -> Woven {
    let mut pieces: Vec<Piece> =
        sites.iter().flat_map(|(site, mutants)| site.pieces(mutants)).collect();
    pieces.sort_by_key(|piece| (piece.at, piece.order));
    let mut woven = Woven { text: String::new(), stretches: Vec::new() };
    let mut open: BTreeMap<usize, usize> = BTreeMap::new();
    let mut copied = 0;
    for piece in pieces {
        woven.text += &text[copied..piece.at];
        copied = piece.at;
        let first = piece.mutants[0];
        let begin = *open.entry(first).or_insert(woven.text.len());
        for (piece, mutant) in piece.texts {
            let start = woven.text.len();
            woven.text += &piece;
            if let Some(mutant) = mutant {
                woven.stretches.push((start..woven.text.len(), vec![mutant]));
            }
        }
        if piece.ends {
            woven.stretches.push((begin..woven.text.len(), piece.mutants));
        }
    }
    woven.text += &text[copied..];
    woven
}

/// Text that is put in.
struct Piece {
    at: usize,
    /// What comes first of what is put in at the same byte: endings, from the inside; then beginnings,
    /// from the outside.
    order: isize,
    /// Each with the mutant that it is there for, if there is one alone.
    texts: Vec<(String, Option<usize>)>,
    /// All mutants of the site.
    mutants: Vec<usize>,
    /// Whether this is the last piece of the site.
    ends: bool,
}

impl Site {
    /// The pieces of text that are put in for these mutants, each with its alternative.
    fn pieces(self, mutants: &[(usize, String)]) -> Vec<Piece> {
        let numbers: Vec<usize> = mutants.iter().map(|(number, _)| *number).collect();
        let piece =
            |at, order, texts, ends| Piece { at, order, texts, mutants: numbers.clone(), ends };
        let single = |text: String| vec![(text, None)];
        let is = |number: usize| format!("{PATH}::is({number})");
        match self {
            Site::Expression(start, end) => {
                let length = (end - start) as isize;
                let mut texts = single(" }".to_owned());
                for (place, (number, alternative)) in mutants.iter().enumerate() {
                    let last = place + 1 == mutants.len();
                    let test = if last { String::new() } else { format!("if {} ", is(*number)) };
                    texts.push((format!(" else {test}{{ {alternative} }}"), Some(*number)));
                }
                texts.push((")".to_owned(), None));
                let none = format!("(if {PATH}::none(&{numbers:?}) {{ ");
                vec![
                    piece(start, isize::MAX - length, single(none), false),
                    piece(end, length, texts, true),
                ]
            }
            Site::Body(at) => {
                let leave = |(number, value): &(usize, String)| {
                    (format!("if {} {{ return {value}; }} ", is(*number)), Some(*number))
                };
                vec![piece(at, isize::MIN, mutants.iter().map(leave).collect(), true)]
            }
            Site::Arm(pattern_end, None) => {
                vec![piece(pattern_end, 0, single(format!(" if !{}", is(numbers[0]))), true)]
            }
            Site::Arm(_, Some((start, end))) => {
                let length = (end - start) as isize + 1;
                let test = single(format!("!{} && (", is(numbers[0])));
                let close = single(")".to_owned());
                vec![
                    piece(start, isize::MAX - length, test, false),
                    piece(end, length, close, true),
                ]
            }
        }
    }
}

/// The sites, by the genres of mutants that change them and the bytes at which these begin.
struct Finder<'t> {
    lines: &'t Lines<'t>,
    sites: BTreeMap<(Genre, usize), Site>,
}

impl Finder<'_> {
    /// What a mutant changes that begins at this byte.
    fn site_of(&self, mutant: &Mutant, start: usize) -> Option<Site> {
        match mutant.genre {
            // The function has one type of iterator, which is not this one.
            Genre::FnValue if mutant.replacement.starts_with("::std::iter::") => None,
            Genre::FnValue => Some(Site::Body(start)),
            genre => self.sites.get(&(genre, start)).copied(),
        }
    }

    fn note(&mut self, genre: Genre, changed: &impl Spanned, expression: &impl Spanned) {
        let range = self.lines.range(expression);
        let site = Site::Expression(range.start, range.end);
        self.sites.insert((genre, self.lines.range(changed).start), site);
    }
}

impl<'a> Visit<'a> for Finder<'_> {
    fn visit_expr_binary(&mut self, binary: &'a syn::ExprBinary) {
        // A chain that binds names is none of `||`.
        if !binds_names(&binary.left) && !binds_names(&binary.right) {
            self.note(Genre::BinaryOperator, &binary.op, binary);
        }
        visit::visit_expr_binary(self, binary);
    }

    fn visit_expr_unary(&mut self, unary: &'a syn::ExprUnary) {
        self.note(Genre::UnaryOperator, &unary.op, unary);
        visit::visit_expr_unary(self, unary);
    }

    fn visit_expr_struct(&mut self, literal: &'a syn::ExprStruct) {
        for field in &literal.fields {
            self.note(Genre::StructField, field, literal);
        }
        visit::visit_expr_struct(self, literal);
    }

    fn visit_arm(&mut self, arm: &'a syn::Arm) {
        let guard = arm.guard.as_ref().map(|(_, guard)| guard);
        let range = guard.map(|guard| self.lines.range(&**guard));
        let pattern_end = self.lines.range(&arm.pat).end;
        let site = Site::Arm(pattern_end, range.map(|range| (range.start, range.end)));
        self.sites.insert((Genre::MatchArm, self.lines.range(arm).start), site);
        if let Some(guard) = guard {
            self.note(Genre::MatchArmGuard, &**guard, &**guard);
        }
        visit::visit_arm(self, arm);
    }
}

/// Whether this is a chain with `let`.
fn binds_names(expression: &syn::Expr) -> bool {
    match expression {
        syn::Expr::Let(_) => true,
        syn::Expr::Binary(binary) => binds_names(&binary.left) || binds_names(&binary.right),
        _ => false,
    }
}

/// At which byte each line begins.
struct Lines<'t> {
    text: &'t str,
    begins: Vec<usize>,
}

impl<'t> Lines<'t> {
    fn of(text: &'t str) -> Self {
        let after_breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        Lines { text, begins: std::iter::once(0).chain(after_breaks).collect() }
    }

    /// Lines are counted from one, columns from zero, in characters.
    fn byte(&self, line: usize, column: usize) -> usize {
        let begin = self.begins[line - 1];
        begin + self.text[begin..].chars().take(column).map(char::len_utf8).sum::<usize>()
    }

    fn range(&self, syntax: &impl Spanned) -> Range<usize> {
        let (start, end) = (syntax.span().start(), syntax.span().end());
        self.byte(start.line, start.column)..self.byte(end.line, end.column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::listing::Place;

    /// The mutant that puts `replacement` in place of the first `text` of the line.
    fn mutant(genre: Genre, line: &str, text: &str, replacement: &str, number: usize) -> Mutant {
        let before = line.find(text).expect("it is there");
        let place = |bytes: usize| Place { line: 1, column: line[..bytes].chars().count() + 1 };
        Mutant {
            number,
            name: String::new(),
            file: String::new(),
            genre,
            replacement: replacement.to_owned(),
            span: Span { start: place(before), end: place(before + text.len()) },
        }
    }

    fn text(line: &str, mutants: &[Mutant]) -> String {
        let mutants: Vec<&Mutant> = mutants.iter().collect();
        woven("", line, &mutants).expect("it is Rust").text.replace("crate::mutant_switches::", "")
    }

    #[test]
    fn an_operator_stands_beside_those_that_could_be_in_its_place() {
        let line = "fn f(ä: u8, b: u8) -> bool { ä < b }";
        let less = |with, number| mutant(Genre::BinaryOperator, line, "<", with, number);
        assert_eq!(
            text(line, &[less("==", 7), less(">", 8)]),
            "fn f(ä: u8, b: u8) -> bool { (if none(&[7, 8]) { ä < b } else if is(7) { ä == b } \
             else { ä > b }) }"
        );
    }

    /// What is within is switched only where the expression about it is as it was.
    #[test]
    fn switches_stand_in_the_branch_without_mutants() {
        let line = "fn f(a: i8, b: i8) -> i8 { a + -b }";
        let mutants = [
            mutant(Genre::BinaryOperator, line, "+", "-", 1),
            mutant(Genre::UnaryOperator, line, "-b", "b", 2),
        ];
        assert_eq!(
            text(line, &mutants),
            "fn f(a: i8, b: i8) -> i8 { (if none(&[1]) { a + (if none(&[2]) { -b } else { b }) } \
             else { a - -b }) }"
        );
    }

    #[test]
    fn bodies_are_left_and_arms_passed_over() {
        let line = "fn f(a: u8) -> u8 { match a { 0 => 1, b if b > 2 => 3, _ => 4 } }";
        let mutants = [
            mutant(Genre::FnValue, line, "match a", "0", 1),
            mutant(Genre::MatchArm, line, "0 => 1", "", 2),
            mutant(Genre::MatchArm, line, "b if", "", 3),
            mutant(Genre::MatchArmGuard, line, "b > 2", "true", 4),
        ];
        assert_eq!(
            text(line, &mutants),
            "fn f(a: u8) -> u8 { if is(1) { return 0; } match a { 0 if !is(2) => 1, \
             b if !is(3) && ((if none(&[4]) { b > 2 } else { true })) => 3, _ => 4 } }"
        );
    }

    #[test]
    fn chains_that_bind_names_are_left_as_they_are() {
        let line = "fn f(a: Option<u8>, b: bool) { if let Some(_) = a && b {} }";
        assert_eq!(text(line, &[mutant(Genre::BinaryOperator, line, "&&", "||", 1)]), line);
    }

    /// Of what the compiler complains is the mutant within which it stands, or all of that place.
    #[test]
    fn a_complaint_is_about_the_narrowest_stretch() {
        let line = "fn f(a: u8, b: u8) -> bool { a < b }";
        let less = |with, number| mutant(Genre::BinaryOperator, line, "<", with, number);
        let (one, two) = (less("==", 7), less(">", 8));
        let woven = woven("", line, &[&one, &two]).expect("it is Rust");
        let at = |text: &str| woven.at(woven.text.find(text).expect("it is there"));
        assert_eq!(at("a == b"), Some(&[7][..]));
        assert_eq!(at("a > b"), Some(&[8][..]));
        assert_eq!(at("a < b"), Some(&[7, 8][..]));
        assert_eq!(at("fn"), None);
    }
}
