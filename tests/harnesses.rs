//! Kani harnesses: each is about an item that the product uses, and says something under the real tool, too.
//!
//! `PLEACH_UPDATE_DOCS=1 cargo test --test it harnesses` writes the table in docs/proofs.md anew.

#[path = "harnesses/catalogue.rs"]
pub mod catalogue;
#[path = "harnesses/demands.rs"]
mod demands;
#[path = "harnesses/shapes.rs"]
mod shapes;
#[path = "harnesses/source.rs"]
mod source;

use std::collections::{BTreeMap, BTreeSet};

use crate::generated::{keep_up_to_date, read};
use crate::uses::uses_of;
use catalogue::{Entry, Run, catalogue};
use demands::complaints;
use source::{Harness, harnesses, harnesses_of, text_of};

/// What goes through a table of the product, and that table: a harness that mentions it has a constant assertion in its
/// file that the table is shorter than `unwind` says.
const WALKS: &[(&str, &str)] =
    &[("DUTIES", "DUTIES.rows()"), ("MISSION", "MISSION.rows()"), ("closure", "Role::ALL")];

#[test]
fn every_harness_is_about_something_that_the_product_uses() {
    let harnesses = by_name();
    let listed = catalogue().harness;
    let mut names: Vec<&String> = listed.iter().map(|entry| &entry.name).collect();
    names.sort();
    assert!(names.iter().eq(&harnesses.keys().collect::<Vec<_>>()), "{names:?}");
    for Entry { name, about: (subject, file), draws, values, kani, .. } in &listed {
        assert!(!draws.is_empty() && *values > 0, "{name} should say what it draws");
        assert!(
            kani.as_ref().is_none_or(Run::is_whole),
            "{name}: a run has a time, or says why it failed"
        );
        assert!(harnesses[name].mentions.contains(subject), "{name} does not mention {subject}");
        assert!(uses_of(subject, file).next().is_some(), "USES lacks {subject} of {file}");
    }
}

#[test]
fn every_harness_is_one_that_the_tool_can_verify() {
    let complaints: Vec<String> = harnesses().iter().flat_map(complaints).collect();
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

#[test]
fn every_table_that_a_harness_goes_through_is_shorter_than_its_bound() {
    for harness in harnesses() {
        for (_, table) in WALKS.iter().filter(|walk| harness.mentions.contains(walk.0)) {
            let bound = format!("assert!({table}.len() < {})", harness.unwind);
            let mut constants = harness.items.iter().filter_map(|item| match item {
                syn::Item::Const(constant) => Some(text_of(&*constant.expr)),
                _ => None,
            });
            let (file, name) = (&harness.file, &harness.name);
            let is_bounded = constants.any(|it| it == bound);
            assert!(is_bounded, "{file}: `{name}` needs const _: () = {bound};");
        }
    }
}

#[test]
fn the_document_counts_the_harnesses() {
    let (catalogue, harnesses) = (catalogue(), by_name());
    let known = |entry: &Entry| {
        let run = entry.kani.as_ref()?;
        (run.digest == harnesses[&entry.name].digest).then_some(run.seconds?)
    };
    let times: Vec<f64> = catalogue.harness.iter().filter_map(known).collect();
    let (count, total) = (catalogue.harness.len(), times.iter().sum::<f64>());
    let longest = times.iter().copied().fold(0.0, f64::max);
    let table = format!(
        "{tool} has verified {verified} of the {count} harnesses in their present form, in {total:.0} s of processor \
         time; the longest took {longest:.0} s.\n\n\
         | group | harnesses | exhaustive | verified by Kani | about |\n\
         | --- | --: | --: | --: | --- |\n{rows}",
        tool = catalogue.tool,
        verified = times.len(),
        rows = groups(&catalogue.harness, &|entry| known(entry).is_some()),
    );
    let begin =
        "<!-- begin of the harnesses: PLEACH_UPDATE_DOCS=1 cargo test --test it harnesses -->";
    let end = "<!-- end of the harnesses -->";
    let document = read("docs/proofs.md");
    let (before, rest) = document.split_once(begin).unwrap();
    let (_, after) = rest.split_once(end).unwrap();
    let all = catalogue.harness.iter().filter(|entry| entry.cases.is_some()).count();
    let sentence = format!("{count} harnesses, {all} of them exhaustively");
    assert!(document.contains(&sentence), "docs/proofs.md should say: {sentence}");
    let refreshed = format!("{before}{begin}\n\n{table}\n{end}{after}");
    keep_up_to_date("docs/proofs.md", &refreshed, "harnesses");
}

/// Prints what `proofs/harnesses.toml` needs when the tool has run.
#[test]
#[ignore]
fn digests_of_the_harnesses() {
    for Harness { name, digest, .. } in harnesses() {
        println!("{digest} {name}");
    }
}

fn by_name() -> BTreeMap<String, Harness> {
    harnesses().into_iter().map(|harness| (harness.name.clone(), harness)).collect()
}

/// A row for each group, in the order of the catalogue.
fn groups(entries: &[Entry], is_verified: &dyn Fn(&Entry) -> bool) -> String {
    let row = |group: &[Entry]| {
        let count = |counts: &dyn Fn(&Entry) -> bool| group.iter().filter(|it| counts(it)).count();
        let subjects: BTreeSet<String> = (group.iter())
            .map(|Entry { about: (subject, file), .. }| format!("[`{subject}`](../{file})"))
            .collect();
        let subjects: Vec<String> = subjects.into_iter().collect();
        format!(
            "| {} | {} | {} | {} | {} |\n",
            group[0].group,
            group.len(),
            count(&|it| it.cases.is_some()),
            count(is_verified),
            subjects.join(", ")
        )
    };
    entries.chunk_by(|one, next| one.group == next.group).map(row).collect()
}

/// What is wrong with a harness of this body, with four turns of loops at the most.
fn wrong_with(body: &str) -> Vec<String> {
    let file = "#[kani::proof] #[kani::unwind(5)] fn planted() { BODY } \
        const PLACES: usize = 3; fn pair() -> [i16; 2] { [1, 2] } fn triple() -> [i16; PLACES] { [0; 3] }";
    let harnesses = harnesses_of("planted.rs", &file.replace("BODY", body));
    harnesses.iter().flat_map(complaints).collect()
}

#[test]
fn a_branch_without_a_cover_is_refused() {
    for sound in [
        "if drawn { kani::cover!(); assert!(one); } else if other { kani::cover!(two); act(); }",
        "match drawn { Some(it) => { kani::cover!(); assert!(it); } None => {} }",
        "let one = if drawn { 1 } else { 2 };",
        "for it in [1, 2] { assert!(it > 0); } for at in 0..PLACES { assert!(at < 3); }",
        "for it in found { kani::cover!(); assert!(it > 0); }",
        "kani::assume(drawn); kani::cover!(one);",
    ] {
        assert_eq!(wrong_with(sound), Vec::<String>::new(), "{sound}");
    }
    for (planted, what) in [
        ("if drawn { assert!(one); }", "a branch without a cover"),
        ("if drawn { kani::cover!(); act(); } else { act(); }", "a branch without a cover"),
        ("match drawn { Some(it) => assert!(it), None => {} }", "a branch without a cover"),
        ("for it in found { assert!(it > 0); }", "a branch without a cover"),
        ("while drawn { act(); }", "a branch without a cover"),
        ("kani::cover!(one); kani::assume(drawn);", "no cover follows the assumption"),
    ] {
        let found = wrong_with(planted);
        assert!(matches!(&found[..], [it] if it.contains(what)), "{planted}: {found:?}");
    }
}

#[test]
fn an_unwind_that_is_too_small_for_a_comparison_is_refused() {
    for sound in ["assert!(pair() == other);", "let (a, b) = (pair(), 1); assert!(a[0] == b);"] {
        assert_eq!(wrong_with(sound), Vec::<String>::new(), "{sound}");
    }
    for planted in [
        "assert!(triple() == other);",
        "let (a, b) = (triple(), 1); kani::cover!(a == b);",
        "let a: [u8; 5] = kani::any(); let b = a; assert!(drawn || c != b);",
        "assert!(other == [first, second]);",
        "let a = [0_u32; PLACES - 1]; assert!(a == other);",
    ] {
        let found = wrong_with(planted);
        assert!(
            matches!(&found[..], [it] if it.contains("bytes of an array")),
            "{planted}: {found:?}"
        );
    }
}

#[test]
fn helpers_neither_assert_nor_cover() {
    let file = "#[kani::proof] #[kani::unwind(5)] fn planted() {} fn helper() { assert!(true); }";
    let harnesses = harnesses_of("planted.rs", file);
    let found: Vec<String> = harnesses.iter().flat_map(complaints).collect();
    assert!(matches!(&found[..], [it] if it.contains("`helper` asserts or covers")), "{found:?}");
}
