//! What harnesses are about, and where the product uses it.

/// A function or table, its file, the file that uses it, and how.
pub type Use = (&'static str, &'static str, &'static str, &'static str);

const TENSION: &str = "automaton/src/composition/tension.rs";
const ROBOT_ATTACHMENT: &str = "automaton/src/network/robot/attachment.rs";
const BALLOT: &str = "automaton/src/network/ballot.rs";
const ROBOT_EXCHANGE: &str = "automaton/src/network/robot/exchange.rs";
const ROBOT_FACTS: &str = "automaton/src/network/robot/facts.rs";
const NOTICES: &str = "automaton/src/network/notices.rs";
const ROBOT_LEADER: &str = "automaton/src/network/robot/leader.rs";
const ROBOT_LINEAGE: &str = "automaton/src/network/robot/lineage.rs";
const ROBOT_MISSION: &str = "automaton/src/network/robot/mission.rs";
const ROBOT: &str = "automaton/src/network/robot/mod.rs";
const ROBOT_PARTNER: &str = "automaton/src/network/robot/partner.rs";
const ROBOT_PATH: &str = "automaton/src/network/robot/path.rs";
const ROBOT_RESERVATION: &str = "automaton/src/network/robot/reservation/mod.rs";
const ROBOT_HELD: &str = "automaton/src/network/robot/reservation/held.rs";
const ROBOT_KEPT: &str = "automaton/src/network/robot/reservation/kept.rs";
const ROBOT_ITERATION: &str = "automaton/src/network/robot/routing/iteration.rs";
const CELL: &str = "continuous/src/geometry/cell.rs";
const ACCEPTANCE: &str = "continuous/src/network/acceptance.rs";
const MOTION: &str = "continuous/src/network/motion/mod.rs";
const DUAL: &str = "continuous/src/network/routing/dual.rs";
const LOCAL: &str = "continuous/src/network/routing/local.rs";
const AGREEMENT: &str = "discrete/src/network/agreement.rs";
const BULLETIN: &str = "discrete/src/network/bulletin.rs";
const ELECTION: &str = "discrete/src/network/election.rs";
const ID_SET: &str = "discrete/src/network/id_set.rs";
const LINEAGE: &str = "discrete/src/network/lineage.rs";
const OFFERS: &str = "discrete/src/network/offers.rs";
const PATH: &str = "discrete/src/network/path.rs";
const RESERVATION: &str = "discrete/src/network/reservation.rs";
const CROSSING: &str = "guards/src/crossing.rs";
const VERDICT: &str = "guards/src/predicate/verdict.rs";
const DUTY: &str = "verify/src/network/duty.rs";
const INSTANT: &str = "verify/src/network/instant.rs";
const PERIOD: &str = "verify/src/network/period.rs";
const TREE: &str = "verify/src/network/tree.rs";

/// Offered to users of the framework; no automaton of the network uses it.
pub const FOR_USERS: &str = "";

/// By file. Of an item that is used in several ways, harnesses are about the first.
pub const USES: &[Use] = &[
    ("own_side", CELL, CELL, "Some(own_side(bisector, position, clearance))"),
    ("worst_corner", ACCEPTANCE, ACCEPTANCE, "worst_corner(ends(&own.axis).map(terms_from))"),
    ("is_admitted", MOTION, MOTION, "is_admitted(self.smallest_margin(point))"),
    (
        "reliability",
        "continuous/src/network/reliability.rs",
        "automaton/src/network/robot/hearing.rs",
        "site.link.reliability(distance)",
    ),
    ("new", DUAL, ROBOT_ITERATION, "DualState::new("),
    ("multiplier", DUAL, ROBOT_ITERATION, "state.multiplier()"),
    ("projected", DUAL, DUAL, "multiplier: projected(extrapolated)"),
    ("projected", DUAL, DUAL, "projected(multiplier - step * (residual - reserve))"),
    ("positive_part", LOCAL, LOCAL, "positive_part((link.value(multiplier) - budget_price)"),
    (
        "DUTIES",
        "discrete/src/network/activity.rs",
        "automaton/src/network/robot/duties.rs",
        "Automaton::builder(DUTIES,",
    ),
    ("new", AGREEMENT, ROBOT_PATH, "Agreement::new(id)"),
    ("vote", AGREEMENT, ROBOT_PATH, "agreement.vote(place,"),
    ("arrive", AGREEMENT, BALLOT, "agreement.arrive(place)"),
    ("give_up", AGREEMENT, BALLOT, "agreement.give_up(place)"),
    ("has_given_up", AGREEMENT, ROBOT_PATH, "agreement.has_given_up(place)"),
    ("merge", AGREEMENT, BALLOT, "(&mut self.agreement, &beacon.agreement)"),
    ("is_settled", AGREEMENT, AGREEMENT, "self.is_settled(places)"),
    ("is_break_point", AGREEMENT, AGREEMENT, "self.is_break_point(place)"),
    ("have_arrived", AGREEMENT, ROBOT_PATH, "agreement.have_arrived(subgroup.places())"),
    ("new", BULLETIN, BULLETIN, "NoticeId::new(0, 0)"),
    ("next", BULLETIN, NOTICES, "self.bulletin.next(issuer, Shared::new(notice))"),
    ("id", BULLETIN, ROBOT, "self.mission.notices().bulletin().id()"),
    ("is_newer_than", BULLETIN, BULLETIN, "heard.id.is_newer_than(self.id)"),
    ("merge", BULLETIN, NOTICES, "self.bulletin.merge(received)"),
    ("new", ELECTION, ROBOT_LEADER, "Election::new(robot.notice_id())"),
    ("place", ELECTION, BALLOT, "Arc::make_mut(election).place(robot, bid)"),
    ("merge", ELECTION, BALLOT, "merge_election(own, heard)"),
    ("best", ELECTION, BALLOT, "self.election.as_ref()?.best()"),
    ("is_complete", ELECTION, ROBOT_FACTS, "election.is_complete(roster)"),
    ("new", ID_SET, ELECTION, "tokens: IdSet::new()"),
    ("insert", ID_SET, ELECTION, "self.tokens.insert(robot)"),
    ("contains", ID_SET, ELECTION, "self.tokens.contains(robot)"),
    ("merge", ID_SET, ELECTION, "self.tokens.merge(&heard.tokens)"),
    ("includes", ID_SET, ELECTION, "self.tokens.includes(roster)"),
    ("closes_cycle", LINEAGE, LINEAGE, "closes_cycle(&self.posts, post)"),
    ("of_access_point", LINEAGE, ROBOT_LINEAGE, "Lineage::of_access_point(access)"),
    ("extended_by", LINEAGE, ROBOT_LINEAGE, ".extended_by(robot.duty.post()?.id)"),
    ("extends", LINEAGE, ROBOT_LINEAGE, "own.extends(&way, post.id)"),
    ("contains", LINEAGE, ROBOT_LINEAGE, "way.contains(post.id)"),
    ("hops", LINEAGE, ROBOT_ATTACHMENT, "let hops = lineage.hops();"),
    ("root", LINEAGE, ROBOT_ATTACHMENT, "lineage.root() == lost"),
    ("make_offer", OFFERS, ROBOT_EXCHANGE, "offers.make_offer(robot.exchanges.partner()?"),
    ("answer", OFFERS, ROBOT_EXCHANGE, "offers.answer(mover, offer, given)"),
    ("hear", OFFERS, ROBOT_EXCHANGE, "offers.hear(robot.id, reply)"),
    ("conclude", OFFERS, ROBOT_EXCHANGE, "offers.conclude(offer, offers_made)"),
    ("asks", OFFERS, ROBOT_PARTNER, "offer.asks(self.id, answered)"),
    ("is_heard", OFFERS, OFFERS, "reply.is_heard(offer)"),
    ("are_under_way", OFFERS, ROBOT_PARTNER, "self.offers().are_under_way()"),
    ("offer", OFFERS, ROBOT_PARTNER, "self.offers().offer()"),
    ("offers_made", OFFERS, ROBOT, ".offers_made()"),
    ("reply", OFFERS, ROBOT, "self.offers().reply()"),
    ("is_break_point", PATH, ROBOT_PATH, "path.is_break_point(place, ties)"),
    ("last_break_point", PATH, ROBOT_FACTS, "shift.path.last_break_point()"),
    ("subgroups", PATH, ROBOT_PATH, "subgroups(&points)"),
    ("places", PATH, ROBOT_PATH, "agreement.have_arrived(subgroup.places())"),
    ("of", RESERVATION, ROBOT_KEPT, "Spare::of(terms.spare)"),
    ("most", RESERVATION, ROBOT_KEPT, "spare.most(before, self.wanted)"),
    ("grant", RESERVATION, ROBOT_KEPT, "spare.grant(before, flow)"),
    ("flow", RESERVATION, ROBOT_KEPT, "kept.lease.flow()"),
    ("part", RESERVATION, ROBOT_RESERVATION, "lease.part().map("),
    ("lasting", RESERVATION, ROBOT_HELD, "self.flow.min(self.lease.lasting(period))"),
    ("promise", RESERVATION, ROBOT_KEPT, "lease.promise(before, terms.until)"),
    ("hear", RESERVATION, ROBOT_HELD, "held.lease.hear(kept)"),
    ("limit", RESERVATION, ROBOT_HELD, "self.lease.limit(self.flow)"),
    ("pass", RESERVATION, ROBOT_HELD, "held.lease.pass(period)"),
    ("MISSION", "discrete/src/network/tables.rs", ROBOT_MISSION, "Automaton::builder(MISSION,"),
    ("between_margins", CROSSING, FOR_USERS, ""),
    ("update", CROSSING, FOR_USERS, ""),
    ("and", VERDICT, TENSION, "forced.or(self.invariants"),
    ("opposite", VERDICT, TENSION, "self.invariants(state)?.opposite()"),
    ("judge", VERDICT, "guards/src/predicate.rs", ".judge("),
    ("are_conserved", DUTY, PERIOD, "duty::are_conserved(&before, &kept)"),
    ("is_reachable", DUTY, PERIOD, "duty::is_reachable(relation, from, to)"),
    ("first_gap", "verify/src/network/motion.rs", PERIOD, "first_gap(&mut intervals)"),
    ("leads_to_access_point", TREE, INSTANT, "tree::leads_to_access_point(&parents, robot)"),
    ("parents_of", TREE, INSTANT, "tree::parents_of(&snapshot.tree, &mut parents)"),
    ("mark_connected", TREE, INSTANT, "tree::mark_connected(&links, &mut connected)"),
];

/// How the product uses an item of a file.
pub fn uses_of(item: &str, file: &str) -> impl Iterator<Item = &'static Use> {
    USES.iter().filter(move |it| (it.0, it.1) == (item, file))
}
