//! The protocol, explored exhaustively: how many states there are, and that everything holds in
//! each of them.

#![allow(clippy::unwrap_used)] // a test that panics has failed

use pleach_verify::exploration::{Fairness, explore};
use pleach_verify::network::exploration::{
    ALWAYS, Campaign, Configuration, Faults, Medium, Places, Protocol, QUICK, THOROUGH, has_ended,
    story,
};

fn assert_met(campaign: &Campaign) {
    let findings = campaign.run().unwrap();
    let told: Vec<String> = findings.failures.iter().map(ToString::to_string).collect();
    assert_eq!(told, [""; 0], "{}", campaign.name);
    let counts = (findings.configurations, findings.states, findings.transitions);
    let expected = (campaign.configurations, campaign.states, campaign.transitions);
    assert_eq!(counts, expected, "{}", campaign.name);
}

#[test]
fn everything_holds_in_every_state_of_the_quick_campaigns() {
    QUICK.iter().for_each(assert_met);
}

#[test]
#[ignore = "takes minutes: cargo test --release -p pleach-verify --test exploration -- --ignored"]
fn everything_holds_in_every_state_of_the_thorough_campaigns() {
    THOROUGH.iter().for_each(assert_met);
}

/// Two robots on an access point, a task beside one of them, and single messages in any order.
#[test]
fn everything_holds_in_every_order_of_single_messages() {
    let places = Places::with_branches(2, 1, &[(0, 2), (1, 2)], &[(1, 1)]).unwrap();
    let medium = Medium::MessagesInAnyOrder;
    let mut protocol = Protocol::new(Configuration { places, medium, contacts: 0 }).unwrap();
    let exploration = explore(&mut protocol, ALWAYS, 1_000_000).unwrap();
    if let Some(violation) = exploration.violations().first() {
        panic!("{violation:?}\n{}", story(&protocol, &exploration, violation.state));
    }
    assert!(exploration.traps(|state| has_ended(&protocol, state), Fairness::Weak).is_empty());
    assert_eq!(exploration.states().len(), 208_278);
}

/// Two access points, a leader that hangs on one of them and a recruit that hangs on the other and
/// does not come as far as the leader: then it says so.
#[test]
fn who_joins_from_another_tree_and_does_not_get_there_says_why_not() {
    let graph = [(0, 1), (0, 3), (1, 2), (2, 3), (2, 4)];
    let places = Places::with_branches(3, 2, &graph, &[(4, 2)]).unwrap();
    let medium = Medium::Rounds { faults: Faults::NONE, period: None };
    let mut protocol = Protocol::new(Configuration { places, medium, contacts: 0 }).unwrap();
    let exploration = explore(&mut protocol, ALWAYS, 1_000_000).unwrap();
    assert_eq!(exploration.violations(), []);
    let traps = exploration.traps(|state| has_ended(&protocol, state), Fairness::Weak);
    if let Some(&trap) = traps.first() {
        panic!("{}", story(&protocol, &exploration, trap));
    }
    assert_eq!(exploration.states().len(), 557);
}
