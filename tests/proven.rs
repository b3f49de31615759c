//! Robots run what is proven: every public function of the network that a Kani harness or a planted
//! fault is about has a caller in the product.
//!
//! The compiler warns of private functions that are never called. For public ones [`CALLS`] names a call,
//! so that this test fails when robots no longer call what is proven.

use crate::proofs::catalogue::faults;
use crate::sources::{files_below, lines_of_code, read, relative, root};
use std::collections::BTreeSet;

/// A function, its file, the file that calls it, and the call.
type Call = (&'static str, &'static str, &'static str, &'static str);

const AFFINE: &str = "verify/src/reach/affine.rs";
const AGREEMENT: &str = "discrete/src/network/agreement.rs";
const BULLETIN: &str = "discrete/src/network/bulletin.rs";
const CONFIRMATION: &str = "discrete/src/network/confirmation.rs";
const CELL: &str = "continuous/src/geometry/cell.rs";
const DUAL: &str = "continuous/src/network/routing/dual.rs";
const ELECTION: &str = "discrete/src/network/election.rs";
const OFFERS: &str = "discrete/src/network/offers.rs";
const ID_SET: &str = "discrete/src/network/id_set.rs";
const ERRORS: &str = "continuous/src/geometry/errors.rs";
const LOCAL: &str = "continuous/src/network/routing/local.rs";
const MOTION: &str = "continuous/src/network/motion/mod.rs";
const PATH: &str = "discrete/src/network/path.rs";
const ZONOTOPE: &str = "verify/src/reach/zonotope.rs";

const ROBOT_EXCHANGE: &str = "automaton/src/network/robot/exchange.rs";
const ROBOT_PARTNER: &str = "automaton/src/network/robot/partner.rs";
const ROBOT_FACTS: &str = "automaton/src/network/robot/facts.rs";
const ROBOT_MOTION: &str = "automaton/src/network/robot/motion.rs";
const ROBOT_LEADER: &str = "automaton/src/network/robot/leader.rs";
const ROBOT_MISSION: &str = "automaton/src/network/robot/mission.rs";
const ROBOT_PATH: &str = "automaton/src/network/robot/path.rs";
const ROBOT_ROUTING: &str = "automaton/src/network/robot/routing.rs";

const CALLS: &[Call] = &[
    ("new", AGREEMENT, ROBOT_PATH, "Agreement::new(id)"),
    ("id", AGREEMENT, ROBOT_FACTS, "agreement.id()"),
    ("vote", AGREEMENT, ROBOT_PATH, "agreement.vote(place,"),
    ("arrive", AGREEMENT, ROBOT_PATH, "agreement.arrive(place)"),
    ("give_up", AGREEMENT, ROBOT_PATH, "agreement.give_up(place)"),
    ("has_given_up", AGREEMENT, ROBOT_PATH, "agreement.has_given_up(place)"),
    ("merge", AGREEMENT, ROBOT_MISSION, "(&mut self.agreement, &neighbour.beacon.agreement)"),
    ("is_settled", AGREEMENT, AGREEMENT, "self.is_settled(places)"),
    ("is_break_point", AGREEMENT, AGREEMENT, "self.is_break_point(place)"),
    ("break_points", AGREEMENT, ROBOT_PATH, ".break_points(self.mission.path()?.len())"),
    ("have_arrived", AGREEMENT, ROBOT_PATH, "agreement.have_arrived(subgroup.places())"),
    ("new", BULLETIN, BULLETIN, "NoticeId::new(0, 0)"),
    ("next", BULLETIN, ROBOT_MISSION, "self.bulletin.next(self.id, Shared::new(notice))"),
    ("id", BULLETIN, ROBOT_FACTS, "self.bulletin.id()"),
    ("is_newer_than", BULLETIN, BULLETIN, "heard.id.is_newer_than(self.id)"),
    ("merge", BULLETIN, ROBOT_MISSION, "self.bulletin.merge(&neighbour.beacon.bulletin)"),
    ("new", ELECTION, ROBOT_LEADER, "Election::new(robot.notice_id())"),
    ("place", ELECTION, ROBOT_LEADER, "Arc::make_mut(election).place(self.id, bid)"),
    ("merge", ELECTION, ROBOT_MISSION, "merge_election(own, heard)"),
    ("best", ELECTION, ROBOT_LEADER, "self.election.as_ref()?.best()"),
    ("is_complete", ELECTION, ROBOT_FACTS, "election.is_complete(roster)"),
    (
        "has_token",
        ELECTION,
        "automaton/src/network/robot/leader.rs",
        "!election.has_token(self.id)",
    ),
    ("new", OFFERS, "automaton/src/network/robot/mod.rs", "Offers::new()"),
    ("make_offer", OFFERS, ROBOT_EXCHANGE, "offers.make_offer(robot.partner?"),
    ("answer", OFFERS, ROBOT_EXCHANGE, "offers.answer(mover, offer, given)"),
    ("hear", OFFERS, ROBOT_EXCHANGE, "offers.hear(robot.id, reply)"),
    ("conclude", OFFERS, ROBOT_EXCHANGE, "offers.conclude(offer, offers_made)"),
    ("asks", OFFERS, ROBOT_PARTNER, "offer.asks(self.id, answered)"),
    ("is_heard", OFFERS, OFFERS, "reply.is_heard(offer)"),
    ("has_heard_reply", OFFERS, ROBOT_PARTNER, ".has_heard_reply(offer, made)"),
    ("are_under_way", OFFERS, ROBOT_PARTNER, "self.offers().are_under_way()"),
    ("offer", OFFERS, ROBOT_PARTNER, "self.offers().offer()"),
    ("offers_made", OFFERS, "automaton/src/network/robot/mod.rs", ".offers_made()"),
    ("reply", OFFERS, "automaton/src/network/robot/mod.rs", "self.offers().reply()"),
    ("new", ID_SET, ELECTION, "tokens: IdSet::new()"),
    ("insert", ID_SET, ELECTION, "self.tokens.insert(robot)"),
    ("contains", ID_SET, ELECTION, "self.tokens.contains(robot)"),
    ("merge", ID_SET, ELECTION, "self.tokens.merge(&heard.tokens)"),
    ("includes", ID_SET, ELECTION, "self.tokens.includes(roster)"),
    (
        "locate",
        "automaton/src/network/roll.rs",
        "automaton/src/network/robot/absence.rs",
        "absent.locate(&mut self.wrecks, seen)",
    ),
    (
        "closes_cycle",
        "discrete/src/network/lineage.rs",
        "discrete/src/network/lineage.rs",
        "closes_cycle(&self.posts, post)",
    ),
    ("is_break_point", PATH, ROBOT_PATH, "path.is_break_point(place, ties)"),
    ("last_break_point", PATH, ROBOT_FACTS, "shift.path.last_break_point()"),
    ("subgroups", PATH, ROBOT_PATH, "subgroups(&points)"),
    ("places", PATH, ROBOT_PATH, "agreement.have_arrived(subgroup.places())"),
    (
        "admits",
        CONFIRMATION,
        "automaton/src/network/robot/confirmation.rs",
        "self.confirmation.admits(neighbour.confirmed)",
    ),
    (
        "lets_move",
        "automaton/src/network/roll.rs",
        "automaton/src/network/robot/absence.rs",
        "self.roll.lets_move(self.id, self.period, self.site.roll_validity())",
    ),
    (
        "rolls_expired",
        "guards/src/network/attendance.rs",
        "automaton/src/network/access_point/attendance.rs",
        "guards::rolls_expired()",
    ),
    ("planning_clearance", ERRORS, ROBOT_MOTION, "errors.planning_clearance(kept)"),
    ("wall_half_planes", ERRORS, ROBOT_MOTION, "errors.wall_half_planes(&site.workspace"),
    ("own_side", CELL, CELL, "Some(own_side(bisector, position, clearance))"),
    (
        "worst_corner",
        "continuous/src/network/acceptance.rs",
        "continuous/src/network/acceptance.rs",
        "worst_corner(ends(&own.axis).map(terms_from))",
    ),
    ("is_admitted", MOTION, MOTION, "is_admitted(self.smallest_margin(point))"),
    ("smallest", MOTION, MOTION, "smallest(lines.chain(circles))"),
    ("dual_step", DUAL, ROBOT_ROUTING, "dual_step(state.multiplier(), step, residual, reserve)"),
    ("new", DUAL, ROBOT_ROUTING, "DualState::new("),
    ("multiplier", DUAL, ROBOT_ROUTING, "state.multiplier()"),
    ("projected", DUAL, DUAL, "projected(multiplier - step * (residual - reserve))"),
    (
        "enclose",
        "continuous/src/flow/piece.rs",
        "automaton/src/composition/solver.rs",
        "piece.enclose(from, to, &mut self.enclosures)",
    ),
    ("advance", AFFINE, "verify/src/reach/flow.rs", "steps.advance(track)"),
    ("widen", ZONOTOPE, ZONOTOPE, "sum.widen(&self.slack)"),
    ("positive_part", LOCAL, LOCAL, "positive_part((link.value(multiplier) - budget_price)"),
];

/// Functions that state what is proven, or show what only those who check want to see.
const CLAIMS: &[(&str, &str)] = &[
    ("is_feasible", LOCAL),
    ("keeps_posts_held", "discrete/src/network/activity.rs"),
    ("taking", OFFERS),
];

/// The code of a file: without comments, and without the tests at its end.
fn code(path: &str) -> String {
    lines_of_code(&read(path)).map(|(_, line)| line).collect::<Vec<_>>().join("\n")
}

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

/// The public functions in which faults are planted.
fn faulty() -> BTreeSet<(String, String)> {
    let planted = faults(root()).unwrap().into_iter().filter_map(|fault| {
        let text = read(&fault.file);
        let before = &text[..text.find(&fault.before).unwrap()];
        // What stands at the left margin closes the function before.
        let last = before.lines().rev().take_while(|line| *line != "}").find_map(function)?;
        last.1.then(|| (last.0.to_owned(), fault.file))
    });
    planted.collect()
}

#[test]
fn what_is_proven_has_a_caller_in_the_product() {
    let subjects: BTreeSet<_> = harnessed().union(&faulty()).cloned().collect();
    assert!(subjects.len() > 40, "{subjects:?}");
    let is_claim = |name: &str, file: &str| CLAIMS.contains(&(name, file));
    let is_called =
        |name: &str, file: &str| CALLS.iter().any(|call| (call.0, call.1) == (name, file));
    let forgotten: Vec<_> = subjects
        .iter()
        .filter(|(name, file)| !is_claim(name, file) && !is_called(name, file))
        .collect();
    assert!(forgotten.is_empty(), "they have no call in CALLS: {forgotten:#?}");
}

#[test]
fn the_calls_stand_where_they_are_said_to() {
    for &(name, file, caller, call) in CALLS {
        assert!(public_functions(&code(file)).contains(name), "{file} has no public {name}");
        assert!(code(caller).contains(call), "{caller} does not call {name} of {file}: {call}");
    }
    for &(name, file) in CLAIMS {
        assert!(public_functions(&code(file)).contains(name), "{file} has no public {name}");
    }
}
