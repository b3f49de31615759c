//! The protocol, explored exhaustively: how many states there are, and that everything holds in
//! each of them.

#![allow(clippy::unwrap_used)] // a test that panics has failed

use pleach_verify::network::exploration::{Campaign, QUICK, THOROUGH};

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
