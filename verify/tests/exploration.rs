//! The protocol, explored exhaustively: how many states there are, and that everything holds in
//! each of them.

#![allow(clippy::unwrap_used)] // a test that panics has failed

use pleach_verify::exploration::{Fairness, explore};
use pleach_verify::network::exploration::{
    ALWAYS, Campaign, Configuration, Medium, Places, Protocol, QUICK, THOROUGH, has_ended, story,
};

/// What fails is told before counts are compared: a fault in the protocol changes both.
fn assert_all_met(campaigns: &[Campaign]) {
    let mut told = Vec::new();
    let mut counts = Vec::new();
    for campaign in campaigns {
        match campaign.run() {
            Ok(findings) => {
                told.extend(findings.failures.iter().map(ToString::to_string));
                counts.push((campaign.name, findings.counts));
            }
            Err(error) => told.push(format!("{}: {error}", campaign.name)),
        }
    }
    assert!(told.is_empty(), "{}", told.join("\n"));
    let expected = campaigns.iter().map(|campaign| (campaign.name, campaign.expected));
    assert_eq!(counts, expected.collect::<Vec<_>>());
}

#[test]
fn everything_holds_in_every_state_of_the_quick_campaigns() {
    assert_all_met(QUICK);
}

#[test]
#[ignore = "takes minutes: cargo test --release -p pleach-verify --test exploration -- --ignored"]
fn everything_holds_in_every_state_of_the_thorough_campaigns() {
    assert_all_met(THOROUGH);
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
