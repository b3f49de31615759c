//! What the network, a composition of nodes, says of them and of time.

use pleach_automaton::Executor;
use pleach_automaton::network::{MemberView, Network};
use pleach_automaton::node::Observed;

use super::{JUMPS_PER_PERIOD, scenario, valid};

/// Control periods are counted, whatever they last.
#[test]
fn the_step_is_how_many_control_periods_have_passed() {
    for period in [0.25, 1.0, 3.0] {
        let mut scenario = scenario("scenarios/redundant-node");
        scenario.control.period = Some(period);
        let mut network = Network::new(&valid(scenario)).expect("its automata are well formed");
        assert_eq!(network.step(), 0);
        let executor = Executor::new(5.5 * period, JUMPS_PER_PERIOD).expect("there is time");
        network.run(&executor).expect("robots go on");
        assert_eq!(network.step(), 5, "periods of {period} s");
    }
}

/// Robots come first, then access points, then the user, each by its number.
#[test]
fn nodes_stand_in_the_order_of_their_numbers() {
    let scenario = valid(scenario("scenarios/redundant-node"));
    let network = Network::new(&scenario).expect("its automata are well formed");
    let kinds = network.nodes().iter().map(|member| match member.view() {
        MemberView::Robot(_) => "robot",
        MemberView::AccessPoint(_) => "access point",
        _ => "user",
    });
    let robots = vec!["robot"; scenario.robot.len()];
    let access_points = vec!["access point"; scenario.access_point.len()];
    assert_eq!(kinds.collect::<Vec<_>>(), [robots, access_points, vec!["user"]].concat());
}

/// What debugging shows of a network is how far it has come, and all members.
#[test]
fn a_network_tells_its_step_and_its_members() {
    let scenario = valid(scenario("scenarios/redundant-node"));
    let mut network = Network::new(&scenario).expect("its automata are well formed");
    let executor = Executor::new(2.5 * network.site().settings.period, JUMPS_PER_PERIOD);
    network.run(&executor.expect("there is time")).expect("robots go on");
    let told = format!("{network:?}");
    assert!(told.starts_with("Network { step: 2, members: ["), "{told:.40}");
    for member in network.nodes() {
        assert!(told.contains(&format!("{member:?}")));
    }
}
