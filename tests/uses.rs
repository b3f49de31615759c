//! What harnesses and planted faults are about, and where the product uses it.

/// A function or table, its file, the file that uses it, and how.
pub type Use = (&'static str, &'static str, &'static str, &'static str);

const TENSION: &str = "automaton/src/composition/tension.rs";
const ROBOT_ABSENCE: &str = "automaton/src/network/robot/absence.rs";
const ROBOT_ATTACHMENT: &str = "automaton/src/network/robot/attachment.rs";
const ROBOT_DUTIES: &str = "automaton/src/network/robot/duties.rs";
const ROBOT_EXCHANGE: &str = "automaton/src/network/robot/exchange.rs";
const ROBOT_FACTS: &str = "automaton/src/network/robot/facts.rs";
const ROBOT_LEADER: &str = "automaton/src/network/robot/leader.rs";
const ROBOT_LINEAGE: &str = "automaton/src/network/robot/lineage.rs";
const ROBOT_MISSION: &str = "automaton/src/network/robot/mission.rs";
const ROBOT: &str = "automaton/src/network/robot/mod.rs";
const ROBOT_MOTION: &str = "automaton/src/network/robot/motion.rs";
const ROBOT_PARTNER: &str = "automaton/src/network/robot/partner.rs";
const ROBOT_PATH: &str = "automaton/src/network/robot/path.rs";
const ROBOT_RESERVATION: &str = "automaton/src/network/robot/reservation.rs";
const ROBOT_ROUTING: &str = "automaton/src/network/robot/routing.rs";
const ROLL: &str = "automaton/src/network/roll.rs";
const USER: &str = "automaton/src/network/user.rs";
const CELL: &str = "continuous/src/geometry/cell.rs";
const ERRORS: &str = "continuous/src/geometry/errors.rs";
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
const SERVICE: &str = "automaton/src/network/access_point/service.rs";
const SERVICE_GUARDS: &str = "guards/src/network/service.rs";
const CROSSING: &str = "guards/src/crossing.rs";
const VERDICT: &str = "guards/src/predicate/verdict.rs";
const DUTY: &str = "verify/src/network/duty.rs";
const INSTANT: &str = "verify/src/network/instant.rs";
const PERIOD: &str = "verify/src/network/period.rs";
const TREE: &str = "verify/src/network/tree.rs";
const ZONOTOPE: &str = "verify/src/reach/zonotope.rs";

/// Offered to users of the framework; no automaton of the network uses it.
pub const FOR_USERS: &str = "";

/// By file. Of an item that is used in several ways, harnesses are about the first.
pub const USES: &[Use] = &[
    (
        "reach",
        "continuous/src/geometry/geodesic.rs",
        "continuous/src/geometry/geodesic.rs",
        "path.reach(from)",
    ),
    ("by", "automaton/src/network/order.rs", USER, "Order::by(self.passed, &self.tasks)"),
    ("locate", ROLL, ROBOT_ABSENCE, "absent.locate(&mut self.wrecks, seen,"),
    (
        "lets_move",
        ROLL,
        ROBOT_ABSENCE,
        "self.roll.lets_move(self.id, self.period, self.site.roll_validity())",
    ),
    (
        "take",
        "automaton/src/node/chunks.rs",
        "automaton/src/node/ensemble.rs",
        "chunks.take(&Steps { mail: Some((mail, *deliveries)), round })?;",
    ),
    (
        "enclose",
        "continuous/src/flow/piece.rs",
        "automaton/src/composition/solver.rs",
        "piece.enclose(from, to, &mut self.enclosures)",
    ),
    ("own_side", CELL, CELL, "Some(own_side(bisector, position, clearance))"),
    ("planning_clearance", ERRORS, ROBOT_MOTION, "errors.planning_clearance(kept)"),
    ("wall_half_planes", ERRORS, ROBOT_MOTION, "errors.wall_half_planes(&site.workspace"),
    ("half_planes_beside", ERRORS, ROBOT_ABSENCE, "errors.half_planes_beside(own, wreck"),
    ("worst_corner", ACCEPTANCE, ACCEPTANCE, "worst_corner(ends(&own.axis).map(terms_from))"),
    (
        "is_acceptable",
        ACCEPTANCE,
        "automaton/src/network/robot/negotiation.rs",
        "!is_acceptable(worst, self.load() + ROUNDING)",
    ),
    ("is_admitted", MOTION, MOTION, "is_admitted(self.smallest_margin(point))"),
    (
        "replace",
        "automaton/src/network/robot/neighbours.rs",
        "automaton/src/network/robot/hearing.rs",
        "self.neighbours.replace(at, renewed);",
    ),
    ("smallest", MOTION, MOTION, "smallest(lines.chain(circles))"),
    (
        "reliability",
        "continuous/src/network/reliability.rs",
        "automaton/src/network/robot/hearing.rs",
        "site.link.reliability(distance)",
    ),
    ("new", DUAL, ROBOT_ROUTING, "DualState::new("),
    ("multiplier", DUAL, ROBOT_ROUTING, "state.multiplier()"),
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
    (
        "admits",
        "discrete/src/network/confirmation.rs",
        "automaton/src/network/robot/confirmation.rs",
        "self.confirmation.admits(neighbour.confirmed)",
    ),
    (
        "pass_on",
        "discrete/src/network/confirmation.rs",
        "automaton/src/network/robot/confirmation.rs",
        "self.confirmation.pass_on(parent.confirmed)",
    ),
    (
        "all_consent",
        "discrete/src/network/consent.rs",
        "automaton/src/network/robot/negotiation.rs",
        "all_consent(self.reliant(), &self.consents)",
    ),
    ("new", ELECTION, ROBOT_LEADER, "Election::new(robot.notice_id())"),
    ("place", ELECTION, ROBOT_LEADER, "Arc::make_mut(election).place(self.id, bid)"),
    ("merge", ELECTION, ROBOT_MISSION, "merge_election(own, heard)"),
    ("best", ELECTION, ROBOT_LEADER, "self.election.as_ref()?.best()"),
    ("is_complete", ELECTION, ROBOT_FACTS, "election.is_complete(roster)"),
    ("has_token", ELECTION, ROBOT_LEADER, "!election.has_token(self.id)"),
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
    ("new", OFFERS, ROBOT, "Offers::new()"),
    ("make_offer", OFFERS, ROBOT_EXCHANGE, "offers.make_offer(robot.partner?"),
    ("answer", OFFERS, ROBOT_EXCHANGE, "offers.answer(mover, offer, given)"),
    ("hear", OFFERS, ROBOT_EXCHANGE, "offers.hear(robot.id, reply)"),
    ("conclude", OFFERS, ROBOT_EXCHANGE, "offers.conclude(offer, offers_made)"),
    ("asks", OFFERS, ROBOT_PARTNER, "offer.asks(self.id, answered)"),
    ("is_heard", OFFERS, OFFERS, "reply.is_heard(offer)"),
    ("has_heard_reply", OFFERS, ROBOT_PARTNER, ".has_heard_reply(offer, made)"),
    ("are_under_way", OFFERS, ROBOT_PARTNER, "self.offers().are_under_way()"),
    ("offer", OFFERS, ROBOT_PARTNER, "self.offers().offer()"),
    ("offers_made", OFFERS, ROBOT, ".offers_made()"),
    ("reply", OFFERS, ROBOT, "self.offers().reply()"),
    ("is_break_point", PATH, ROBOT_PATH, "path.is_break_point(place, ties)"),
    ("last_break_point", PATH, ROBOT_FACTS, "shift.path.last_break_point()"),
    ("subgroups", PATH, ROBOT_PATH, "subgroups(&points)"),
    ("places", PATH, ROBOT_PATH, "agreement.have_arrived(subgroup.places())"),
    ("of", RESERVATION, ROBOT_RESERVATION, "Spare::of(self.lasting_outflow("),
    ("most", RESERVATION, ROBOT_RESERVATION, "spare.most(before, kept.wanted)"),
    ("grant", RESERVATION, ROBOT_RESERVATION, "spare.grant(before, flow)"),
    ("flow", RESERVATION, ROBOT_RESERVATION, "kept.lease.flow()"),
    ("until", RESERVATION, ROBOT_RESERVATION, "more.lease.until()"),
    ("part", RESERVATION, ROBOT_RESERVATION, "lease.part().map("),
    ("end", RESERVATION, ROBOT_RESERVATION, "less.lease.end()"),
    ("lasting", RESERVATION, ROBOT_RESERVATION, "self.flow.min(self.lease.lasting(period))"),
    ("promise", RESERVATION, ROBOT_RESERVATION, "lease.promise(before, until)"),
    ("hear", RESERVATION, ROBOT_RESERVATION, "held.lease.hear(kept)"),
    ("limit", RESERVATION, ROBOT_RESERVATION, "held.lease.limit(held.flow)"),
    ("pass", RESERVATION, ROBOT_RESERVATION, "held.lease.pass(period)"),
    ("MISSION", "discrete/src/network/tables.rs", ROBOT_MISSION, "Automaton::builder(MISSION,"),
    ("between_margins", CROSSING, FOR_USERS, ""),
    ("update", CROSSING, FOR_USERS, ""),
    (
        "rolls_expired",
        "guards/src/network/attendance.rs",
        "automaton/src/network/access_point/attendance.rs",
        "guards::rolls_expired()",
    ),
    (
        "heard_in_time",
        "guards/src/network/attendance.rs",
        "automaton/src/network/access_point/attendance.rs",
        "guards::heard_in_time()",
    ),
    (
        "with_starts",
        "automaton/src/network/scenario/valid.rs",
        "src/starts.rs",
        "scenario.with_starts(&starts)",
    ),
    (
        "readmitted",
        "guards/src/network/attendance.rs",
        "automaton/src/network/access_point/attendance.rs",
        "guards::readmitted()",
    ),
    ("and", VERDICT, TENSION, "forced.or(self.invariants"),
    ("opposite", VERDICT, TENSION, "self.invariants(state)?.opposite()"),
    (
        "sample_due",
        "guards/src/network/control.rs",
        "automaton/src/network/robot/control.rs",
        "guards::sample_due()",
    ),
    ("discharged", "guards/src/network/duty.rs", ROBOT_DUTIES, "guards::discharged()"),
    ("foreseen", "guards/src/network/mod.rs", ROBOT_MISSION, "guards::foreseen()"),
    ("called_again", "guards/src/network/mod.rs", ROBOT_MISSION, "guards::called_again()"),
    ("takes_link", PATH, ROBOT_PATH, "path.takes_link(place, other)"),
    ("no_bid", SERVICE_GUARDS, SERVICE, "guards::no_bid()"),
    ("end_heard", SERVICE_GUARDS, SERVICE, "guards::end_heard()"),
    ("all_serviced", SERVICE_GUARDS, SERVICE, "guards::all_serviced()"),
    ("withdraws", SERVICE_GUARDS, SERVICE, "guards::withdraws()"),
    ("judge", VERDICT, "guards/src/predicate.rs", ".judge("),
    ("are_conserved", DUTY, PERIOD, "duty::are_conserved(&before, &kept)"),
    ("is_reachable", DUTY, PERIOD, "duty::is_reachable(relation, from, to)"),
    (
        "enter",
        "verify/src/network/judge/ledger.rs",
        "verify/src/network/judge/mod.rs",
        "ledger.enter(event)?",
    ),
    (
        "observe",
        "verify/src/network/judge/fleets.rs",
        "verify/src/network/judge/referee.rs",
        "fleets.observe(snapshot, events)",
    ),
    ("first_gap", "verify/src/network/motion.rs", PERIOD, "first_gap(&mut intervals)"),
    ("leads_to_access_point", TREE, INSTANT, "tree::leads_to_access_point(&parents, robot)"),
    (
        "is_rooted",
        TREE,
        "exploration/src/network/properties.rs",
        "tree::is_rooted(&parents(protocol, state))",
    ),
    (
        "connectivity",
        INSTANT,
        "verify/src/network/monitor.rs",
        "instant::connectivity(snapshot, limits)",
    ),
    ("locations", INSTANT, "verify/src/network/judge/mod.rs", "instant::locations(snapshot)"),
    ("parents_of", TREE, INSTANT, "tree::parents_of(&snapshot.tree, &mut parents)"),
    ("mark_connected", TREE, INSTANT, "tree::mark_connected(&links, &mut connected)"),
    ("advance", "verify/src/reach/affine.rs", "verify/src/reach/flow.rs", "steps.advance(track)"),
    ("widen", ZONOTOPE, ZONOTOPE, "sum.widen(&self.slack)"),
    (
        "of_fleet",
        "verify/src/network/storm/mod.rs",
        "src/mission.rs",
        "storm::network(fleet.scenario(), &storm.of_fleet(fleet))",
    ),
    (
        "met",
        "verify/src/temporal/signal.rs",
        "verify/src/temporal/sliding.rs",
        "self.signal.met(self.left, self.reach.start, now)",
    ),
    (
        "traps",
        "exploration/src/liveness.rs",
        "exploration/src/network/campaign.rs",
        "exploration.traps(ended, Action::is_optional,",
    ),
    (
        "judged_faults",
        "verify/src/network/judge/referee.rs",
        "src/cli/judge.rs",
        "judged_faults(&Settings::resolve(reader.scenario()), reader.faults())",
    ),
];

/// How the product uses an item of a file.
pub fn uses_of(item: &str, file: &str) -> impl Iterator<Item = &'static Use> {
    USES.iter().filter(move |it| (it.0, it.1) == (item, file))
}
