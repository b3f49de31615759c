//! Harnesses as their sources state them.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use syn::spanned::Spanned;

use crate::sources::{code, files_below, relative};

/// A harness and what its file has besides.
pub struct Harness {
    pub name: String,
    pub file: String,
    /// The number of `#[kani::unwind]`.
    pub unwind: usize,
    pub body: syn::Block,
    /// The other functions and constants of its file.
    pub items: Rc<Vec<syn::Item>>,
    /// The words of the harness and of what it uses in its file.
    pub mentions: BTreeSet<String>,
    /// Changes when the harness does, or what it uses in its file. Its name, comments and white space do not matter.
    pub digest: String,
}

/// Every harness in the sources, in the order of the files.
pub fn harnesses() -> Vec<Harness> {
    let folders = ["guards/src", "discrete/src", "continuous/src", "verify/src"];
    let files = folders.into_iter().flat_map(files_below).map(|path| relative(&path));
    files.flat_map(|file| harnesses_of(&file, &code(&file))).collect()
}

/// The harnesses in the text of a file, which has no comments.
pub fn harnesses_of(file: &str, text: &str) -> Vec<Harness> {
    if !text.contains("#[kani::proof]") {
        return Vec::new();
    }
    let (harnesses, items): (Vec<_>, Vec<_>) =
        syn::parse_file(text).unwrap().items.into_iter().partition(
            |item| matches!(item, syn::Item::Fn(function) if attribute(function, "proof").is_some()),
        );
    let functions = harnesses.into_iter().filter_map(|item| match item {
        syn::Item::Fn(function) => Some(function),
        _ => None,
    });
    let items = Rc::new(items);
    functions.map(|function| harness(file, function, &items)).collect()
}

fn harness(file: &str, function: syn::ItemFn, items: &Rc<Vec<syn::Item>>) -> Harness {
    let name = function.sig.ident.to_string();
    let unwind = attribute(&function, "unwind").map(|it| it.parse_args::<syn::LitInt>().unwrap());
    let unwind = unwind.unwrap_or_else(|| panic!("{file}: {name} has no #[kani::unwind]"));
    let attributes: String = function.attrs.iter().map(text_of).collect();
    let texts = texts_used(attributes + &text_of(&function.block), items);
    Harness {
        name,
        file: file.to_owned(),
        unwind: unwind.base10_parse().unwrap(),
        body: *function.block,
        items: items.clone(),
        mentions: texts.iter().flat_map(|text| words(text)).map(str::to_owned).collect(),
        digest: digest(&texts),
    }
}

/// The attribute `#[kani::…]` of a function.
fn attribute<'a>(function: &'a syn::ItemFn, name: &str) -> Option<&'a syn::Attribute> {
    function.attrs.iter().find(|it| it.path().segments.last().is_some_and(|it| it.ident == name))
}

/// The source text of an item, followed by the text of every item that it uses, transitively.
fn texts_used(text: String, items: &[syn::Item]) -> Vec<String> {
    let mut unused: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for item in items {
        if let Some(name) = name_of(item) {
            unused.entry(name).or_default().push(text_of(item));
        }
    }
    let (mut used, mut next) = (vec![text], 0);
    while next < used.len() {
        let named: Vec<String> = words(&used[next]).into_iter().map(str::to_owned).collect();
        used.extend(named.iter().filter_map(|name| unused.remove(name)).flatten());
        next += 1;
    }
    used
}

/// What an item is called by those that use it; methods by their type.
fn name_of(item: &syn::Item) -> Option<String> {
    Some(match item {
        syn::Item::Fn(it) => it.sig.ident.to_string(),
        syn::Item::Const(it) => it.ident.to_string(),
        syn::Item::Struct(it) => it.ident.to_string(),
        syn::Item::Impl(it) => text_of(&*it.self_ty),
        _ => return None,
    })
}

/// The source of a part.
pub fn text_of(part: &impl Spanned) -> String {
    part.span().source_text().unwrap()
}

fn words(text: &str) -> BTreeSet<&str> {
    text.split(|letter: char| !letter.is_alphanumeric() && letter != '_').collect()
}

/// FNV-1a (64 bits) of texts without their white space.
fn digest(texts: &[String]) -> String {
    let bytes = texts.iter().flat_map(|text| text.bytes()).filter(|it| !it.is_ascii_whitespace());
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}
