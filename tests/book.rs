//! The book has a page for every classic, written from the classic itself.
//!
//! `PLEACH_UPDATE_DOCS=1 cargo test --test it book` writes the pages anew.

#![allow(clippy::duplicate_mod)] // every example brings along what all of them do

use std::collections::BTreeSet;
use std::fs;

use crate::generated::{is_update, keep_up_to_date, read, root};

/// For every example: the example as a module, and the test of its page.
macro_rules! classics {
    ($($name:ident from $file:literal)+) => {
        $(
            #[allow(dead_code)] // its program
            #[path = $file]
            pub mod $name;
        )+

        const CLASSICS: &[&str] = &[$(stringify!($name)),+];

        mod pages {
            $(
                #[test]
                fn $name() {
                    let exhibit = super::$name::exhibit().unwrap();
                    super::keep_page(stringify!($name), &exhibit.page());
                    super::keep_diagrams(exhibit.diagrams());
                    super::keep_plots(exhibit.plots());
                }
            )+
        }
    };
}

classics! {
    bouncing_ball from "../examples/bouncing_ball.rs"
    thermostat from "../examples/thermostat.rs"
    heater_and_controller from "../examples/heater_and_controller.rs"
    two_tanks from "../examples/two_tanks.rs"
    gear_shift from "../examples/gear_shift.rs"
    navigation from "../examples/navigation.rs"
    clock_synchronisation from "../examples/clock_synchronisation.rs"
    filtered_oscillator from "../examples/filtered_oscillator.rs"
    platoon from "../examples/platoon.rs"
    two_phase_commit from "../examples/two_phase_commit.rs"
}

fn keep_page(name: &str, page: &str) {
    keep_up_to_date(&format!("docs/classics/{name}.md"), page, "book");
}

fn keep_diagrams<'a>(diagrams: impl Iterator<Item = (String, &'a str)>) {
    for (name, svg) in diagrams {
        keep_up_to_date(&format!("{PICTURES}/{name}"), svg, "book");
    }
}

/// Plots are drawn anew with everything else, and not compared: the last digits of a run are not
/// the same on every machine.
fn keep_plots<'a>(plots: impl Iterator<Item = (String, &'a str)>) {
    for (name, svg) in plots {
        let file = root().join(PICTURES).join(name);
        if is_update() {
            fs::write(&file, svg).unwrap();
        }
        assert!(file.exists(), "{} is missing", file.display());
    }
}

const PICTURES: &str = "docs/classics/pictures";

#[test]
fn every_document_has_a_line_in_the_contents() {
    let contents = read("docs/SUMMARY.md");
    for entry in fs::read_dir(root().join("docs")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let is_listed = name == "SUMMARY.md" || contents.contains(&format!("({name})"));
        assert!(is_listed || !name.ends_with(".md"), "{name} is not in SUMMARY.md");
    }
}

/// Examples that are no classics: they are about the robots.
const OTHERS: [&str; 6] = ["explore", "fuzz", "outcomes", "storm", "stress", "verdicts"];

#[test]
fn every_example_has_a_page_and_every_page_a_line_in_the_contents() {
    let files = fs::read_dir(root().join("examples")).unwrap();
    let stem = |name: String| name.strip_suffix(".rs").map(str::to_owned);
    let names: BTreeSet<String> = files
        .filter_map(|entry| stem(entry.unwrap().file_name().into_string().unwrap()))
        .filter(|name| !OTHERS.contains(&&**name))
        .collect();
    assert_eq!(names, CLASSICS.iter().map(|&name| name.to_owned()).collect());
    let (contents, overview) = (read("docs/SUMMARY.md"), read("docs/classics/README.md"));
    for name in names {
        assert!(contents.contains(&format!("(classics/{name}.md)")), "{name} is not in SUMMARY.md");
        assert!(overview.contains(&format!("({name}.md)")), "{name} is not in the overview");
    }
}
