//! What the checks say of the automata of the network: nothing but that resets and flows are
//! functions, which they cannot see into, and that they do not look at all cycles of transitions.
//! What could be an endless cycle they cannot tell of functions anyway; robots count their jumps.

use pleach_automaton::Automaton;
use pleach_automaton::check::Kind;
use pleach_automaton::network::Automata;
use pleach_discrete::{Event, Location};
use pleach_guards::Valuation;

fn has_no_unexplained_finding<L: Location, E: Event, S: Valuation>(automaton: &Automaton<L, E, S>) {
    let report = automaton.check();
    let is_explained = |kind| matches!(kind, Kind::Unchecked | Kind::Unexplored);
    let unexplained = report.findings().iter().filter(|finding| !is_explained(finding.kind));
    let unexplained: Vec<String> = unexplained.map(ToString::to_string).collect();
    assert!(unexplained.is_empty(), "{}", unexplained.join("\n"));
}

#[test]
fn automata_of_robots_have_no_faults() {
    let automata = Automata::new().expect("the automata are well formed");
    has_no_unexplained_finding(&automata.duty);
    has_no_unexplained_finding(&automata.mission);
    has_no_unexplained_finding(&automata.exchange);
    has_no_unexplained_finding(&automata.attachment);
    has_no_unexplained_finding(&automata.control);
}

#[test]
fn automata_of_access_points_and_the_user_have_no_faults() {
    let automata = Automata::new().expect("the automata are well formed");
    has_no_unexplained_finding(&automata.service);
    has_no_unexplained_finding(&automata.attendance);
    has_no_unexplained_finding(&automata.rounds);
    has_no_unexplained_finding(&automata.request);
}
