//! Sources that hold many faults, of which at most one is in effect: the body of a function in which faults are planted
//! stands once more for each of them, and a variable of the environment says which body runs.
//!
//! ```text
//! fn f() -> u8 { 1 }    fn f() -> u8 { match crate::planted_fault() { 7 => { 2 } _ => { 1 } } }
//! ```

use std::ops::Range;

use syn::visit::Visit;

use super::catalogue::Fault;

/// The variable of the environment with the number of the fault that is in effect; 0 or none for none.
pub const CHOICE: &str = "PLEACH_PLANTED_FAULT";

/// A fault with its number, from 1.
pub type Numbered<'a> = (usize, &'a Fault);

/// A source file with faults.
pub struct Woven {
    pub text: String,
    /// Stretches of the text, each with the faults that it is there for.
    stretches: Vec<(Range<usize>, Vec<usize>)>,
}

impl Woven {
    /// The file with these faults. Those that are not within one function are left out.
    ///
    /// # Errors
    /// Where the file is no Rust.
    pub fn of(source: &str, faults: &[Numbered]) -> syn::Result<Self> {
        let mut bodies = Bodies(Vec::new());
        bodies.visit_file(&syn::parse_file(source)?);
        let mut woven = Woven { text: String::new(), stretches: Vec::new() };
        let mut copied = 0;
        for body in bodies.0 {
            let within = faults.iter().filter_map(|(number, fault)| {
                let begin = source.find(&fault.before)?;
                let end = begin + fault.before.len();
                let is_within = body.start <= begin && end <= body.end;
                let faulty =
                    || [&source[body.start..begin], &fault.after, &source[end..body.end]].concat();
                is_within.then(|| (*number, faulty()))
            });
            let within: Vec<(usize, String)> = within.collect();
            if !within.is_empty() {
                woven.text += &source[copied..body.start];
                woven.choose(&within, &source[body.clone()]);
                copied = body.end;
            }
        }
        woven.text += &source[copied..];
        Ok(woven)
    }

    /// Adds a choice between what stands there with each of these faults, and without any.
    fn choose(&mut self, faulty: &[(usize, String)], sound: &str) {
        let begin = self.text.len();
        self.text += " match crate::planted_fault() {";
        for (number, body) in faulty {
            let start = self.text.len();
            self.text += &format!(" {number} => {{{body}}}");
            self.stretches.push((start..self.text.len(), vec![*number]));
        }
        self.text += &format!(" _ => {{{sound}}} }} ");
        let numbers = faulty.iter().map(|(number, _)| *number).collect();
        self.stretches.push((begin..self.text.len(), numbers));
    }

    /// The faults that the narrowest stretch about this byte of the text is there for.
    pub fn at(&self, byte: usize) -> &[usize] {
        let around = self.stretches.iter().filter(|(range, _)| range.contains(&byte));
        around.min_by_key(|(range, _)| range.len()).map_or(&[], |(_, faults)| faults)
    }

    /// The faults that are in the text.
    pub fn faults(&self) -> impl Iterator<Item = usize> {
        self.stretches.iter().flat_map(|(_, faults)| faults.iter().copied())
    }
}

/// The function that says which fault is in effect.
pub fn decision() -> String {
    format!(
        "\npub(crate) fn planted_fault() -> usize {{\n    \
         use std::sync::LazyLock;\n    \
         static FAULT: LazyLock<usize> = LazyLock::new(|| {{\n        \
         std::env::var(\"{CHOICE}\").ok().and_then(|number| number.parse().ok()).unwrap_or(0)\n    \
         }});\n    \
         *FAULT\n}}\n"
    )
}

/// What is between the braces of each function, in the order of the file. What is within another function belongs to that
/// one. Functions that are `const` are left out: their bodies cannot ask the environment.
struct Bodies(Vec<Range<usize>>);

impl Bodies {
    fn note(&mut self, signature: &syn::Signature, body: &syn::Block) {
        if signature.constness.is_none() {
            let braces = body.brace_token.span;
            self.0.push(braces.open().byte_range().end..braces.close().byte_range().start);
        }
    }
}

impl<'a> Visit<'a> for Bodies {
    fn visit_item_fn(&mut self, function: &'a syn::ItemFn) {
        self.note(&function.sig, &function.block);
    }

    fn visit_impl_item_fn(&mut self, method: &'a syn::ImplItemFn) {
        self.note(&method.sig, &method.block);
    }

    fn visit_trait_item_fn(&mut self, method: &'a syn::TraitItemFn) {
        if let Some(body) = &method.default {
            self.note(&method.sig, body);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::Engine;

    fn fault(before: &str, after: &str) -> Fault {
        Fault {
            name: String::new(),
            wrong: String::new(),
            file: String::new(),
            before: before.to_owned(),
            after: after.to_owned(),
            engine: Engine::Test,
            command: String::new(),
            says: String::new(),
        }
    }

    fn text(source: &str, faults: &[Fault]) -> String {
        let numbered: Vec<Numbered> = (1..).zip(faults).collect();
        Woven::of(source, &numbered).expect("it is Rust").text.replace("crate::", "")
    }

    #[test]
    fn a_body_stands_once_more_for_each_fault() {
        let source = "impl A { fn f(&self) -> bool { self.ä < 3 } fn g() {} }";
        assert_eq!(
            text(source, &[fault("< 3", "<= 3"), fault("self.ä", "2")]),
            "impl A { fn f(&self) -> bool { match planted_fault() { 1 => { self.ä <= 3 } \
             2 => { 2 < 3 } _ => { self.ä < 3 } } } fn g() {} }"
        );
    }

    /// Functions within others, and those of traits, stand in bodies as well.
    #[test]
    fn functions_within_others_are_part_of_them() {
        let source = "trait T { fn f() -> u8 { fn g() -> u8 { 1 } g() } }";
        assert_eq!(
            text(source, &[fault("1", "2")]),
            "trait T { fn f() -> u8 { match planted_fault() { 1 => { fn g() -> u8 { 2 } g() } \
             _ => { fn g() -> u8 { 1 } g() } } } }"
        );
    }

    #[test]
    fn what_is_not_within_one_function_is_left_out() {
        let source =
            "const A: u8 = 1; const fn f() -> u8 { 2 } fn g(a: u8) -> u8 { 3 } fn h() { 4; }";
        let faults = ["1", "2", "a: u8", "3 } fn h() { 4"].map(|before| fault(before, "0"));
        assert_eq!(text(source, &faults), source);
    }

    /// Of what the compiler complains is the fault within which it stands, or all of that function.
    #[test]
    fn a_complaint_is_about_the_narrowest_stretch() {
        let faults = [fault("1", "2"), fault("+ 0", "+ 3")];
        let numbered: Vec<Numbered> = (1..).zip(&faults).collect();
        let woven = Woven::of("fn f() -> u8 { 1 + 0 }", &numbered).expect("it is Rust");
        let at = |text: &str| woven.at(woven.text.find(text).expect("it is there"));
        assert_eq!(at("2 + 0"), [1]);
        assert_eq!(at("1 + 3"), [2]);
        assert_eq!(at("1 + 0"), [1, 2]);
        assert!(at("fn").is_empty());
    }
}
