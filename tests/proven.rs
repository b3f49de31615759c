//! Robots run what is proven: every public function of the network that a Kani harness is about has a caller in the
//! product.
//!
//! The compiler warns of private functions that are never called. For public ones [`USES`] names a call,
//! so that this test fails when robots no longer call what is proven.

use crate::harnesses::catalogue::catalogue;
use crate::sources::{code, files_below, relative, root};
use crate::uses::{FOR_USERS, USES, uses_of};
use std::collections::BTreeSet;

/// Functions that state what is proven, or show what only those who check want to see.
const CLAIMS: &[(&str, &str)] = &[
    ("keeps_posts_held", "discrete/src/network/activity.rs"),
    ("taking", "discrete/src/network/offers.rs"),
];

/// The name that a line of code gives to a function, and whether it is public.
fn function(line: &str) -> Option<(&str, bool)> {
    let line = line.trim_start();
    let rest = line.split_once("fn ")?;
    let is_head =
        rest.0.split(' ').all(|word| word.is_empty() || word.starts_with("pub") || word == "const");
    let name = rest.1.split(['(', '<']).next()?;
    is_head.then_some((name, line.starts_with("pub ")))
}

fn public_functions(code: &str) -> BTreeSet<String> {
    let public = code.lines().filter_map(function).filter(|&(_, is_public)| is_public);
    public.map(|(name, _)| name.to_owned()).collect()
}

/// The names that are followed by a parenthesis.
fn called(code: &str) -> BTreeSet<String> {
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
    let mut names = BTreeSet::new();
    for (at, _) in code.match_indices('(') {
        let before = &code[..at];
        names.insert(before[before.trim_end_matches(is_part).len()..].to_owned());
    }
    names
}

/// The public functions that harnesses call in the file that they stand beside, each with its file.
fn harnessed() -> BTreeSet<(String, String)> {
    let folders = ["discrete/src/network", "continuous/src/geometry", "continuous/src/network"];
    let mut harnesses: Vec<_> = folders.into_iter().flat_map(files_below).collect();
    harnesses.retain(|path| path.ends_with("proofs.rs"));
    assert!(harnesses.len() >= 14, "the harnesses are not where they are looked for");
    let mut found = BTreeSet::new();
    for harness in harnesses.iter().map(|path| relative(path)) {
        let folder = harness.strip_suffix("/proofs.rs").unwrap();
        let file = [format!("{folder}.rs"), format!("{folder}/mod.rs")]
            .into_iter()
            .find(|file| root().join(file).exists())
            .unwrap();
        let text = code(&harness);
        let own: BTreeSet<&str> = text.lines().filter_map(function).map(|(name, _)| name).collect();
        let called = called(&text);
        let names = public_functions(&code(&file)).into_iter();
        let names = names.filter(|name| called.contains(name) && !own.contains(name.as_str()));
        found.extend(names.map(|name| (name, file.clone())));
    }
    found
}

#[test]
fn what_is_proven_has_a_caller_in_the_product() {
    let subjects = harnessed();
    let is_claim = |name: &str, file: &str| CLAIMS.contains(&(name, file));
    let forgotten: Vec<_> = subjects
        .iter()
        .filter(|(name, file)| !is_claim(name, file) && uses_of(name, file).next().is_none())
        .collect();
    assert!(forgotten.is_empty(), "they have no call in USES: {forgotten:#?}");
    let listed = catalogue().harness.into_iter().map(|entry| entry.about);
    let needed: BTreeSet<_> = subjects.into_iter().chain(listed).collect();
    let others: Vec<_> =
        USES.iter().filter(|it| !needed.contains(&(it.0.to_owned(), it.1.to_owned()))).collect();
    assert!(others.is_empty(), "no harness is about them: {others:#?}");
}

#[test]
fn the_uses_stand_where_they_are_said_to() {
    for &(item, file, user, usage) in USES {
        let declared = [format!("fn {item}"), format!("const {item}:")];
        let text = code(file);
        assert!(declared.iter().any(|head| text.contains(head)), "{file} has no {item}");
        if user != FOR_USERS {
            assert!(code(user).contains(usage), "{user} does not use {item} of {file}: {usage}");
        }
    }
    for &(name, file) in CLAIMS {
        assert!(public_functions(&code(file)).contains(name), "{file} has no public {name}");
    }
}
