//! Each Kani harness names what it is about: an item of the product, and where the product uses it.
//!
//! `PLEACH_UPDATE_DOCS=1 cargo test --test it harnesses` writes the table in docs/proofs.md anew.

use crate::generated::{keep_up_to_date, read};
use crate::sources::{code, files_below, relative};
use crate::uses::{FOR_USERS, uses_of};
use std::collections::{BTreeMap, BTreeSet};

/// A harness, the function or table that it is about, and the file of that.
type Proof = (&'static str, &'static str, &'static str);

const ACCEPTANCE: &str = "continuous/src/network/acceptance.rs";
const RELIABILITY: &str = "continuous/src/network/reliability.rs";
const DUAL: &str = "continuous/src/network/routing/dual.rs";
const LOCAL: &str = "continuous/src/network/routing/local.rs";
const ACTIVITY: &str = "discrete/src/network/activity.rs";
const AGREEMENT: &str = "discrete/src/network/agreement.rs";
const BULLETIN: &str = "discrete/src/network/bulletin.rs";
const ELECTION: &str = "discrete/src/network/election.rs";
const LINEAGE: &str = "discrete/src/network/lineage.rs";
const OFFERS: &str = "discrete/src/network/offers.rs";
const PATH: &str = "discrete/src/network/path.rs";
const RESERVATION: &str = "discrete/src/network/reservation.rs";
const TABLES: &str = "discrete/src/network/tables.rs";
const CROSSING: &str = "guards/src/crossing.rs";
const VERDICT: &str = "guards/src/predicate/verdict.rs";
const DUTY: &str = "verify/src/network/duty.rs";
const TREE: &str = "verify/src/network/tree.rs";

/// In the order of the files.
const PROOFS: &[Proof] = &[
    (
        "points_in_their_own_half_planes_are_two_clearances_apart",
        "own_side",
        "continuous/src/geometry/cell.rs",
    ),
    ("no_corner_is_worse_than_the_worst", "worst_corner", ACCEPTANCE),
    ("smaller_terms_have_no_worse_corner", "worst_corner", ACCEPTANCE),
    ("a_sender_that_accepts_is_never_given_too_much", "is_acceptable", ACCEPTANCE),
    ("consent_to_a_move_is_consent_to_less_of_it", "is_acceptable", ACCEPTANCE),
    (
        "what_is_admitted_meets_every_constraint",
        "is_admitted",
        "continuous/src/network/motion/mod.rs",
    ),
    ("reliability_is_flat_outside_of_the_transition", "reliability", RELIABILITY),
    ("reliability_falls_from_one_to_zero", "reliability", RELIABILITY),
    ("a_projected_multiplier_is_never_negative", "projected", DUAL),
    ("a_multiplier_rises_while_the_reserve_is_missed", "dual_step", DUAL),
    ("a_positive_part_is_never_negative", "positive_part", LOCAL),
    ("the_local_minimiser_is_feasible_and_pays_for_used_time_only", "budget_price", LOCAL),
    ("an_activity_answers_every_event_in_one_way", "DUTIES", ACTIVITY),
    ("a_robot_leaves_a_fixed_post_when_it_is_replaced", "DUTIES", ACTIVITY),
    ("settled_views_tell_every_vote", "is_settled", AGREEMENT),
    ("a_vote_stands", "vote", AGREEMENT),
    ("arrivals_are_known_together_if_each_is_known", "have_arrived", AGREEMENT),
    ("a_view_of_another_path_changes_nothing", "merge", AGREEMENT),
    ("the_newest_notice_wins_in_any_order", "merge", BULLETIN),
    ("identities_are_totally_ordered", "is_newer_than", BULLETIN),
    (
        "a_robot_moves_against_nobody_that_relies_on_it",
        "all_consent",
        "discrete/src/network/consent.rs",
    ),
    ("merging_views_is_taking_a_maximum", "merge", ELECTION),
    ("a_view_of_another_election_changes_nothing", "merge", ELECTION),
    ("bids_are_ordered_by_rank_first_and_ties_go_to_the_higher_index", "best", ELECTION),
    ("a_merge_is_the_union", "merge", "discrete/src/network/id_set.rs"),
    ("a_way_is_extended_by_posts_that_are_not_on_it", "extended_by", LINEAGE),
    ("an_exchange_conserves_duties_at_every_step", "conclude", OFFERS),
    ("the_recruit_the_last_and_both_sides_of_a_crossing_break", "is_break_point", PATH),
    ("every_place_before_the_last_break_point_is_in_one_subgroup", "subgroups", PATH),
    ("no_more_is_granted_than_there_is_to_spare", "most", RESERVATION),
    ("a_lease_ends_at_the_sender_first", "promise", RESERVATION),
    ("a_phase_answers_every_step_in_one_way", "MISSION", TABLES),
    ("every_phase_is_reached", "MISSION", TABLES),
    ("the_end_is_heard_and_only_an_announcement_follows", "MISSION", TABLES),
    ("crossings_alternate", "between_margins", CROSSING),
    ("a_switch_keeps_its_state_within_the_band_only", "update", CROSSING),
    ("logic_keeps_margins_and_verdicts_together", "and", VERDICT),
    ("negation_follows_de_morgan", "opposite", VERDICT),
    ("comparisons_agree_with_their_margins", "judge", VERDICT),
    ("duties_are_conserved_exactly_by_permutations", "are_conserved", DUTY),
    ("a_shift_along_the_path_keeps_break_points_held", "last_break_point", PATH),
    ("after_each_round_a_robot_knows_one_link_more", "merge", ELECTION),
    ("robots_that_hear_each_other_elect_the_best_bidder", "is_complete", ELECTION),
    ("an_observer_may_see_what_the_table_allows", "is_reachable", DUTY),
    ("a_gap_is_found_where_there_is_one", "first_gap", "verify/src/network/motion.rs"),
    ("robots_that_have_heard_every_vote_form_the_same_subgroups", "is_break_point", AGREEMENT),
    ("the_subgroups_of_any_votes_partition_the_path", "subgroups", PATH),
    ("the_subgroups_of_any_votes_are_teams", "subgroups", PATH),
    ("a_robot_that_avoids_its_own_lineage_keeps_the_tree", "closes_cycle", LINEAGE),
    // That a tree stays one when a leaf is taken away is a lemma on trees; that robots leave only without
    // children is explored.
    ("a_robot_without_children_may_leave", "leads_to_access_point", TREE),
    ("an_exchange_of_duties_keeps_the_tree", "conclude", OFFERS),
    ("edges_give_parents_unless_a_robot_has_two", "parents_of", TREE),
    ("the_connected_are_those_with_a_way_out", "mark_connected", TREE),
];

/// The words of a text.
fn words(text: &str) -> BTreeSet<&str> {
    text.split(|letter: char| !letter.is_alphanumeric() && letter != '_').collect()
}

/// The functions of a file that begin at its margin, each with its text and its file.
fn functions(path: &str) -> BTreeMap<String, String> {
    let text = code(path);
    let heads = text.match_indices("fn ").filter(|&(at, _)| at == 0 || text[..at].ends_with('\n'));
    let end = |at: usize| text[at..].find("\n}").map_or(text.len(), |end| at + end);
    heads
        .map(|(at, _)| {
            let name = text[at + 3..].split(['(', '<']).next().unwrap();
            (name.to_owned(), text[at..end(at)].to_owned())
        })
        .collect()
}

/// Every harness, with what it and the functions that it calls in its file mention.
fn harnesses() -> BTreeMap<String, BTreeSet<String>> {
    let mut found = BTreeMap::new();
    for folder in ["guards/src", "discrete/src", "continuous/src", "verify/src"] {
        for path in files_below(folder).iter().map(|path| relative(path)) {
            let text = code(&path);
            if !text.contains("#[kani::proof]") {
                continue;
            }
            let functions = functions(&path);
            for part in text.split("#[kani::proof]").skip(1) {
                let name = part.split_once("fn ").unwrap().1.split('(').next().unwrap();
                found.insert(name.to_owned(), mentioned(name, &functions));
            }
        }
    }
    found
}

fn mentioned(name: &str, functions: &BTreeMap<String, String>) -> BTreeSet<String> {
    let (mut seen, mut open) = (BTreeSet::new(), vec![name.to_owned()]);
    while let Some(word) = open.pop() {
        if seen.insert(word.clone())
            && let Some(text) = functions.get(&word)
        {
            open.extend(words(text).into_iter().map(str::to_owned));
        }
    }
    seen
}

#[test]
fn every_harness_is_about_something_that_the_product_uses() {
    let harnesses = harnesses();
    let listed: BTreeSet<&str> = PROOFS.iter().map(|proof| proof.0).collect();
    let known: BTreeSet<&str> = harnesses.keys().map(String::as_str).collect();
    assert_eq!(listed, known, "every harness is listed, and nothing else");
    for &(harness, subject, file) in PROOFS {
        assert!(harnesses[harness].contains(subject), "{harness} does not mention {subject}");
        assert!(uses_of(subject, file).next().is_some(), "USES lacks {subject} of {file}");
    }
    let begin =
        "<!-- begin of the subjects: PLEACH_UPDATE_DOCS=1 cargo test --test it harnesses -->";
    let end = "<!-- end of the subjects -->";
    let document = read("docs/proofs.md");
    let (before, rest) = document.split_once(begin).unwrap();
    let (_, after) = rest.split_once(end).unwrap();
    let rows: String = PROOFS
        .iter()
        .map(|(harness, subject, file)| {
            let (.., user, _) = uses_of(subject, file).next().unwrap();
            let user = match *user {
                FOR_USERS => "for users; no automaton of the network uses it".to_owned(),
                user => format!("[{}](../{user})", user.rsplit_once("src/").unwrap().1),
            };
            format!("| `{harness}` | [`{subject}`](../{file}) | {user} |\n")
        })
        .collect();
    let table = format!("| harness | is about | used by |\n| --- | --- | --- |\n{rows}");
    let refreshed = format!("{before}{begin}\n\n{table}\n{end}{after}");
    keep_up_to_date("docs/proofs.md", &refreshed, "harnesses");
}
