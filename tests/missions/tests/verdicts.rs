//! Whether what missions say of tasks that they do not service is true, in rooms so small that this can be searched out;
//! and whether no setting within its range makes a mission violate an invariant.
//!
//! Many missions: `cargo test --release -p missions --test it verdicts -- --ignored`. To look at single ones:
//! `cargo run --release --example verdicts -- rooms FIRST_SEED COUNT FOLDER`.

use missions::arrangements::Arrangements;
use missions::floor_plans::{edge_settings, small_room};
use missions::valid;
use missions::verdicts::{Claim, Opinion, compared, verdict, violation};
use pleach::automaton::network::certificate::{Bound, Certificate};
use pleach::automaton::network::record::Outcome;
use pleach::automaton::network::scenario::{Scenario, ValidScenario};
use rayon::prelude::*;
use serde_json::json;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;

/// Missions in small rooms in every run, and in the long run.
const ROOMS: [RangeInclusive<u64>; 2] = [1..=60, 1..=500];
/// Missions with settings at the ends of their ranges.
const SETTINGS: [RangeInclusive<u64>; 2] = [1..=40, 1..=500];

/// Small rooms of whose missions the verdicts are false, by cause.
const FALSE_VERDICTS: &[(&str, &[u64])] = &[
    ("two posts or more would have to move", &[14, 30, 111, 142, 158, 198, 318, 359, 394, 413]),
    ("links would have to be longer than links of the tree are", &[7, 19, 39, 132, 303, 425]),
    ("a link would have to lead round a wall, out of reach of one of its ends", &[264, 405, 470]),
    ("posts keep their parents in the paper's order", &[49, 345]),
];
/// Missions with settings at the ends of their ranges that violate an invariant, by cause.
const VIOLATIONS: &[(&str, &[u64])] = &[];

/// What is false by seed, where that is not known.
fn unknown(
    seeds: RangeInclusive<u64>,
    known: &[(&str, &[u64])],
    falsehood: impl Fn(u64) -> Option<String> + Sync,
) -> BTreeMap<u64, String> {
    let is_known = |seed: u64| known.iter().any(|(_, seeds)| seeds.contains(&seed));
    let unknown = seeds.into_par_iter().filter(|&seed| !is_known(seed));
    unknown.filter_map(|seed| Some((seed, falsehood(seed)?))).collect()
}

/// Seeds of the known that are false no more.
fn mended(known: &[(&str, &[u64])], falsehood: impl Fn(u64) -> Option<String> + Sync) -> Vec<u64> {
    let seeds: Vec<u64> = known.iter().flat_map(|(_, seeds)| seeds.iter().copied()).collect();
    seeds.into_par_iter().filter(|&seed| falsehood(seed).is_none()).collect()
}

fn false_verdict(seed: u64) -> Option<String> {
    let falsehoods = verdict(&small_room(seed)).falsehoods;
    falsehoods.first().map(|falsehood| falsehood.to_string())
}

fn violated(seed: u64) -> Option<String> {
    violation(&edge_settings(seed)).1.map(|violation| violation.to_string())
}

#[test]
fn verdicts_in_small_rooms_are_true() {
    assert_eq!(unknown(ROOMS[0].clone(), FALSE_VERDICTS, false_verdict), BTreeMap::new());
}

#[test]
#[ignore = "takes a minute: cargo test --release -p missions --test it verdicts -- --ignored"]
fn verdicts_in_many_small_rooms_are_true() {
    assert_eq!(unknown(ROOMS[1].clone(), FALSE_VERDICTS, false_verdict), BTreeMap::new());
    assert_eq!(mended(FALSE_VERDICTS, false_verdict), [0; 0]);
}

#[test]
fn no_setting_at_the_end_of_its_range_violates_an_invariant() {
    assert_eq!(unknown(SETTINGS[0].clone(), VIOLATIONS, violated), BTreeMap::new());
}

#[test]
#[ignore = "takes minutes: cargo test --release -p missions --test it verdicts -- --ignored"]
fn no_setting_of_many_at_the_ends_of_their_ranges_violates_an_invariant() {
    assert_eq!(unknown(SETTINGS[1].clone(), VIOLATIONS, violated), BTreeMap::new());
    assert_eq!(mended(VIOLATIONS, violated), [0; 0]);
}

/// One robot services a task over the post of the other, which is the only one that can come near the next task.
#[test]
fn a_post_on_which_others_depend_is_taken_along_where_no_robot_is_left() {
    for seed in [363, 371] {
        let verdict = verdict(&small_room(seed));
        assert_eq!(verdict.outcome, Outcome::Serviced, "room {seed}");
    }
}

/// A room of this size with a task, an access point at (0.1, 0.3) and robots beside it.
fn room(boundary: &[[f64; 2]], robots: usize, task: [f64; 2]) -> ValidScenario {
    let robot = |number: usize| json!({ "position": [0.1, 0.1 + 0.05 * number as f64] });
    let scenario: Scenario = serde_json::from_value(json!({
        "name": "room",
        "workspace": { "boundary": boundary },
        "link": { "full_range": 0.4, "max_range": 0.5 },
        "access_point": [{ "position": [0.1, 0.3] }],
        "robot": (0..robots).map(robot).collect::<Vec<_>>(),
        "task": [{ "position": task }],
    }))
    .unwrap();
    valid(scenario)
}

/// By hand: δ is 0.03, and n links reach as far as 0.5 n, or 0.4 n where they are fully reliable.
#[test]
fn the_search_agrees_with_what_is_known_by_hand() {
    let hall = [[0.0, 0.0], [3.0, 0.0], [3.0, 0.6], [0.0, 0.6]];
    for (x, least, reliable) in [(0.3, 1, 1), (0.5, 1, 1), (0.7, 2, 2), (1.05, 2, 3), (2.05, 4, 5)]
    {
        let search = Arrangements::of(&room(&hall, 2, [x, 0.3]));
        assert_eq!(search.least(&[0]), Some(least), "x = {x}");
        assert_eq!(
            search.found(&[0], 0.4, 9).map(|places| places.len()),
            Some(reliable),
            "x = {x}"
        );
        assert!(search.is_in_reach(0) && !search.is_out_of_reach(0));
    }
    let beyond = Arrangements::of(&room(&hall, 2, [3.05, 0.3]));
    assert!(beyond.is_out_of_reach(0) && !beyond.is_in_reach(0));
    assert_eq!((beyond.least(&[0]), beyond.found(&[0], 0.4, 9)), (None, None));

    // A wall with a gap at its end: the robots walk round it, and links reach through it.
    let folded = [
        [0.0, 0.0],
        [0.3, 0.0],
        [0.3, 0.55],
        [0.31, 0.55],
        [0.31, 0.0],
        [0.6, 0.0],
        [0.6, 0.6],
        [0.0, 0.6],
    ];
    let search = Arrangements::of(&room(&folded, 1, [0.45, 0.3]));
    assert_eq!(search.least(&[0]), Some(1));
    assert_eq!(search.found(&[0], 0.4, 1).map(|places| places.len()), Some(1));
    // Without the gap, nobody comes there.
    let closed = folded.map(|[x, y]| if y == 0.55 { [x, 0.595] } else { [x, y] });
    let search = Arrangements::of(&room(&closed, 1, [0.45, 0.3]));
    assert!(search.is_out_of_reach(0) && !search.is_in_reach(0));
}

/// Where robots are too few, a bound that is one higher than the arrangement that is found is false, and the least
/// number that the search knows is not.
#[test]
fn a_bound_that_is_one_too_high_is_found() {
    let mut found = 0;
    for seed in ROOMS[0].clone() {
        let scenario = small_room(seed);
        let tasks: Vec<usize> = (0..scenario.task.len()).collect();
        let search = Arrangements::of(&scenario);
        let (Some(least), Some(places)) =
            (search.least(&tasks), search.found(&tasks, scenario.link.full_range, 9))
        else {
            continue;
        };
        let contradicts = |least: usize| {
            let bound =
                Bound { length: 0.0, longest_link: 0.0, least, robots: scenario.robot.len() };
            let claim = Claim {
                task: tasks[0],
                serviced: tasks[1..].to_vec(),
                outcome: Outcome::InsufficientRobots,
                reason: String::new(),
                certificate: Some(Certificate::Bound(bound)),
            };
            matches!(compared(&scenario, &search, &claim), Opinion::Contradicted(_))
        };
        assert!(contradicts(places.len() + 1), "seed {seed}");
        assert!(!contradicts(least), "seed {seed}");
        found += 1;
    }
    assert!(found > 30, "{found} rooms");
}
