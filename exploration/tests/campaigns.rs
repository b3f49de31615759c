//! The protocol, explored exhaustively: how many states there are, and that everything holds in
//! each of them.

use crate::generated::keep_up_to_date;
use pleach_exploration::network::{
    Campaign, Configuration, Faults, Findings, Medium, PlaceGraph, QUICK, THOROUGH,
};

/// What fails is told before counts are compared: a fault in the protocol changes both. After a campaign that
/// comes to no end the others are not run: they may need more memory than there is.
fn all_met(campaigns: &[Campaign]) -> Findings {
    let mut told = Vec::new();
    let mut counts = Vec::new();
    let mut all = Findings::default();
    for campaign in campaigns {
        match campaign.run() {
            Ok(findings) => {
                told.extend(findings.failures.iter().map(ToString::to_string));
                counts.push((campaign.name, findings.counts));
                all = all.and(findings);
            }
            Err(error) => {
                told.push(format!("{}: {error}", campaign.name));
                break;
            }
        }
    }
    assert!(told.is_empty(), "{}", told.join("\n"));
    let expected = campaigns.iter().map(|campaign| (campaign.name, campaign.expected));
    assert_eq!(counts, expected.collect::<Vec<_>>());
    all
}

/// In how many configurations each row of the tables is taken is kept for `docs/coverage.md`.
#[test]
fn everything_holds_in_every_state_of_the_quick_campaigns() {
    let findings = all_met(QUICK);
    let rows =
        findings.rows.iter().map(|(row, configurations)| format!("{configurations} {row}\n"));
    keep_up_to_date("tests/rows.txt", &rows.collect::<String>(), "campaigns");
}

#[test]
#[ignore = "takes minutes: cargo test --release -p pleach-exploration --test it campaigns -- --ignored"]
fn everything_holds_in_every_state_of_the_thorough_campaigns() {
    all_met(THOROUGH);
}

/// How many states a network has in all of which everything holds, and which lead to an end.
fn states_of_sound(configuration: Configuration) -> usize {
    let findings = Findings::of("this network", configuration, 1_000_000).unwrap();
    let told: Vec<String> = findings.failures.iter().map(ToString::to_string).collect();
    assert!(told.is_empty(), "{}", told.join("\n"));
    findings.counts.states
}

/// Two robots on an access point, a task beside one of them, and single messages in any order.
#[test]
fn everything_holds_in_every_order_of_single_messages() {
    let places = PlaceGraph::with_branches(2, 1, &[(0, 2), (1, 2)], &[(1, 1)]).unwrap();
    let medium = Medium::MessagesInAnyOrder;
    let states = states_of_sound(Configuration { places, medium, contacts: 0 });
    assert_eq!(states, 149_710);
}

/// Two access points, a leader that is attached to one of them and a recruit that is attached to the other and
/// does not come as far as the leader: then it says so. The state machine test found it.
#[test]
fn a_robot_that_joins_from_another_tree_and_does_not_get_there_says_why_not() {
    let graph = [(0, 1), (0, 3), (1, 2), (2, 3), (2, 4)];
    let places = PlaceGraph::with_branches(3, 2, &graph, &[(4, 2)]).unwrap();
    let medium = Medium::Rounds { faults: Faults::NONE, period: None };
    assert_eq!(states_of_sound(Configuration { places, medium, contacts: 0 }), 1_141);
}

/// p₁ exchanges duties with a robot of a lower number, to whose post the parent of p₁ is
/// attached: no robot ends up below itself. The state machine test found it.
#[test]
fn an_exchange_across_a_link_keeps_the_tree() {
    let graph = [(0, 1), (0, 3), (1, 4), (2, 3), (3, 4)];
    let places = PlaceGraph::with_branches(4, 1, &graph, &[(1, 1)]).unwrap();
    let medium = Medium::Rounds { faults: Faults::NONE, period: None };
    assert_eq!(states_of_sound(Configuration { places, medium, contacts: 1 }), 2_477);
}

/// A robot begins again when its task has been announced to others: it does not take the election that it hears
/// of for over because the robots of the later announcement have answered.
#[test]
fn a_robot_that_begins_again_ends_no_election_of_others() {
    let places = PlaceGraph::with_branches(3, 1, &[(0, 1), (1, 2), (2, 3)], &[(0, 1)]).unwrap();
    let faults = Faults { stops: 1, restarts: 1, ..Faults::NONE };
    let medium = Medium::Periods { faults, rounds: 4 };
    assert_eq!(states_of_sound(Configuration { places, medium, contacts: 0 }), 87_977);
}

/// A robot that waits on Σ has given its post up, and has not heard who holds it when the mission ends: the two
/// are not attached to each other. The campaign of five robots and a lost message found it.
#[test]
fn a_robot_does_not_attach_to_one_that_is_attached_to_it() {
    let graph = [(0, 4), (0, 5), (1, 2), (1, 3), (1, 4), (2, 3)];
    let places = PlaceGraph::with_branches(5, 1, &graph, &[(0, 1)]).unwrap();
    let medium = Medium::Rounds { faults: Faults { losses: 1, ..Faults::NONE }, period: None };
    assert_eq!(states_of_sound(Configuration { places, medium, contacts: 0 }), 2_244);
}

/// Two robots that are attached to a third, which becomes the leader, and hear each other: they look for
/// another parent at once, and not to each other. The campaign of six robots found it.
#[test]
fn robots_that_lose_their_parent_at_once_do_not_attach_to_one_another() {
    let graph = [(0, 1), (0, 4), (0, 5), (0, 6), (1, 2), (1, 3), (1, 6), (2, 3), (2, 4), (3, 4)];
    let places = PlaceGraph::with_branches(6, 1, &graph, &[(1, 1)]).unwrap();
    let medium = Medium::Rounds { faults: Faults::NONE, period: None };
    assert_eq!(states_of_sound(Configuration { places, medium, contacts: 0 }), 177);
}
