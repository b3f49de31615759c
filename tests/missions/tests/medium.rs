//! Distributed means distributed: what robots do is decided by the messages that reach them.

use missions::{
    Arrival, AskedTwice, Filtered, Mission, Period, Written, network_over, run, run_over,
    run_unmonitored, shipped, shipped_mission, valid,
};
use pleach::automaton::network::Radio;
use pleach::automaton::network::record::{End, Faults, MissionEvent as Event, Outcome};
use pleach::automaton::network::scenario::{RobotStart, Scenario, ValidScenario};
use pleach::continuous::Point;
use pleach::discrete::network::NodeId;
use pleach::discrete::network::activity::may_follow;
use pleach::verify::network::Referee;
use std::cell::Cell;
use std::collections::BTreeMap;

fn study_one() -> &'static Mission {
    &shipped_mission("study-1").0
}

// ---- Messages go over links --------------------------------------------------------------------

#[test]
fn no_message_goes_where_there_is_no_link() {
    let longest = Cell::new(0.0_f64);
    let inspect = |Arrival { sender, receiver, distance, .. }: Arrival| {
        assert_ne!(sender, receiver);
        longest.set(longest.get().max(distance.unwrap_or(0.0)));
        false
    };
    let scenario = shipped("study-1");
    let (mission, network) = run_over(scenario, |site| Filtered::new(site, inspect));
    assert_eq!(mission.periods, study_one().periods);
    assert_eq!(mission.end, study_one().end);
    assert!(network.medium().messages() > 500_000);
    let (range, longest) = (network.site().settings.link.max_range, longest.get());
    assert!(longest < range, "R = 0 over {longest}");
    assert!(longest > 0.99 * range, "the whole range is used");
}

/// Nodes share nothing but what a message says: if each is written as text and read again by each of its
/// receivers, the mission is the same.
#[test]
fn messages_that_are_written_and_read_again_lead_to_the_same_mission() {
    let scenario = shipped("redundant-node");
    let shared = run(scenario.clone());
    let (written, network) = run_over(scenario, Written::new);
    assert_eq!(written.periods, shared.periods);
    assert_eq!(written.end, shared.end);
    assert!(network.medium().bytes() > 1_000_000);
}

/// Whatever robots know of each other has gone through the medium: without it no robot learns of a
/// task, sends anything or moves.
#[test]
fn without_messages_nothing_happens() {
    let mut network = network_over(&shipped("study-1"), |site| Filtered::new(site, |_| true));
    let (periods, _) = run_unmonitored(&mut network, 50);
    for Period { snapshot, events } in &periods {
        assert_eq!(snapshot.positions, periods[0].snapshot.positions);
        assert!(snapshot.routes.is_empty());
        let of_a_robot = |event: &&Event| {
            !matches!(event, Event::TaskAnnounced { .. } | Event::RouteInfeasible { .. })
        };
        assert_eq!(events.iter().find(of_a_robot), None);
    }
}

// ---- A robot out of range of all others -----------------------------------------------------------

/// A corner of Study I in which no robot comes into range and through which none walks.
const FAR_CORNER: [f64; 2] = [2.6, 1.53];

/// How many robots there are is common knowledge, and decides how many rounds of messages come
/// before the first control period; with that many in every period it decides nothing.
const ROUNDS: usize = 32;

fn with_hermit(rate: f64) -> Scenario {
    let mut scenario = without_hermit();
    scenario.robot.push(RobotStart::at(FAR_CORNER, rate));
    scenario
}

fn without_hermit() -> Scenario {
    let mut scenario = shipped("study-1");
    scenario.control.rounds_per_period = Some(ROUNDS);
    scenario
}

/// What the robots of Study I did, as if the last robot had never been there: access points are
/// numbered one lower.
fn without_the_last_robot(period: &Period) -> Period {
    let hermit = period.snapshot.positions.len() - 1;
    let mut snapshot = period.snapshot.clone();
    snapshot.positions.pop();
    snapshot.roles.pop();
    snapshot.residuals.pop();
    snapshot.robots.pop();
    snapshot.multipliers.pop();
    snapshot.tree.retain(|&(child, _)| child != hermit);
    snapshot.routes.retain(|route| route.from != hermit);
    let renumber = |node: &mut usize| {
        assert_ne!(*node, hermit, "somebody knows the hermit");
        *node -= usize::from(*node > hermit);
    };
    snapshot.tree.iter_mut().for_each(|(_, parent)| renumber(parent));
    snapshot.routes.iter_mut().for_each(|route| renumber(&mut route.to));
    let mut events = period.events.clone();
    events.retain(|event| *event != Event::RouteInfeasible { robot: hermit });
    for event in &mut events {
        if let Event::Reattached { parent, .. } = event {
            renumber(parent);
        }
    }
    uncounted(&Period { snapshot, events })
}

/// Without the numbers of messages: that a robot is missed, and where it starts, is told once more.
fn uncounted(period: &Period) -> Period {
    let mut period = period.clone();
    for robot in &mut period.snapshot.robots {
        (robot.sent, robot.heard) = (0, 0);
    }
    period
}

#[test]
fn a_robot_out_of_range_changes_nothing_for_the_others() {
    assert_unchanged_by_hermit(0.0);
}

#[test]
fn a_robot_out_of_range_that_cannot_send_changes_nothing_for_the_others() {
    assert_unchanged_by_hermit(0.075);
}

fn assert_unchanged_by_hermit(rate: f64) {
    let scenario = with_hermit(rate);
    assert!(ValidScenario::new(scenario.clone()).is_err(), "no mission starts so by itself");
    let alone = run(without_hermit());
    let mut network = network_over(&scenario, Radio::new);
    let (periods, end) = run_unmonitored(&mut network, 5_000);
    let range = network.site().settings.link.max_range;
    for (period, alone) in periods.iter().zip(&alone.periods) {
        let (hermit, others) = period.snapshot.positions.split_last().unwrap();
        assert!(others.iter().all(|other| (other - hermit).norm() > range));
        assert_eq!(without_the_last_robot(period), uncounted(alone));
    }
    assert_eq!(periods.len(), alone.periods.len());
    assert_eq!(end, Some(alone.end));
}

/// The hermit itself, alone with its numbers, knows of nothing.
#[test]
fn a_robot_out_of_range_hears_of_nothing() {
    let mut network = network_over(&with_hermit(0.075), Radio::new);
    let (periods, _) = run_unmonitored(&mut network, 100);
    for Period { snapshot, .. } in periods {
        assert_eq!(snapshot.positions[13], Point::from(FAR_CORNER));
        assert!(!snapshot.active.contains(&13));
        assert_eq!(snapshot.robots[13].heard, 0);
        assert!(snapshot.routes.iter().all(|route| route.from != 13 && route.to != 13));
    }
}

// ---- Rounds of messages ------------------------------------------------------------------------

#[test]
fn one_round_a_period_and_fifty_both_service_study_one() {
    for rounds in [1, 50] {
        let mut scenario = shipped("study-1");
        scenario.control.rounds_per_period = Some(rounds);
        let mission = run(scenario);
        mission.assert_serviced();
    }
}

// ---- Notices issued at once --------------------------------------------------------------------

/// Two access points that serve the same user announce the same task at the same step of the mission. The
/// notice of the higher index wins everywhere, and the mission goes on from it.
#[test]
fn two_access_points_that_announce_at_once_do_not_tie() {
    for name in ["study-2", "two-clusters"] {
        let scenario = shipped(name);
        let mut network = network_over(&scenario, AskedTwice::new);
        let (periods, end) = run_unmonitored(&mut network, 5_000);
        let announced = |period: &Period| {
            let first = Event::TaskAnnounced { task: 0 };
            period.events.iter().filter(|event| **event == first).count()
        };
        assert!(periods.iter().any(|period| announced(period) == 2), "{name}: nothing is decided");
        let end = end.unwrap();
        assert_eq!(end.outcome, Outcome::Serviced, "{name}: {}", end.reason);
    }
}

// ---- Messages that are lost --------------------------------------------------------------------

/// A redundant robot of Study I that has no children and is never called.
const NOBODY_NEEDS: NodeId = 0;

/// Every message from or to that robot from control period `begin` on.
fn jammed_from(begin: usize) -> impl Fn(Arrival) -> bool {
    move |Arrival { period, sender, receiver, .. }| {
        period >= begin && [sender, receiver].contains(&NOBODY_NEEDS)
    }
}

/// One message of `n`.
fn one_of(n: u64) -> impl Fn(Arrival) -> bool {
    move |message| message.number % n == n - 1
}

/// On each link the first two of every three beacons.
fn beacons_but_every_third() -> impl FnMut(Arrival) -> bool {
    let mut counts = BTreeMap::new();
    move |Arrival { sender, receiver, is_beacon, .. }| {
        let count = counts.entry((sender, receiver)).or_insert(0_u64);
        *count += u64::from(is_beacon);
        is_beacon && !count.is_multiple_of(3)
    }
}

/// A beacon is repeated so often that all of these messages but one may be lost.
#[test]
fn the_mission_tolerates_the_loss_of_two_of_three_beacons() {
    for name in ["study-2", "leaf-leader"] {
        let mission =
            run_over(shipped(name), |site| Filtered::new(site, beacons_but_every_third())).0;
        mission.assert_serviced();
    }
}

/// A mission over a medium that loses messages, held against what must hold under any fault; `nodes` tells whether a robot
/// is cut off.
fn run_with_losses(
    scenario: Scenario,
    nodes: bool,
    loses: impl FnMut(Arrival) -> bool,
) -> (Vec<Period>, End) {
    let scenario = valid(scenario);
    let mut network = network_over(&scenario, |site| Filtered::new(site, loses));
    let (periods, end) = run_unmonitored(&mut network, 5_000);
    let mut referee = Referee::new(&scenario, Faults { messages: true, nodes }, may_follow);
    let name = &scenario.name;
    for Period { snapshot, events } in &periods {
        referee.observe(snapshot, events).unwrap_or_else(|broken| panic!("{name}: {broken}"));
    }
    let end = end.expect("it ends in time");
    referee.conclude(&end).unwrap_or_else(|broken| panic!("{name}: {broken}"));
    (periods, end)
}

/// A robot that is never heard is in no roster, so that no election waits for it.
#[test]
fn a_robot_that_was_never_heard_is_not_missed() {
    let (periods, end) = run_with_losses(shipped("study-1"), true, jammed_from(0));
    assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
    let first = &periods[0].snapshot.positions[NOBODY_NEEDS];
    assert!(periods.iter().all(|period| &period.snapshot.positions[NOBODY_NEEDS] == first));
}

/// A robot that falls silent is given up: the task is announced again to the others, and they service it.
#[test]
fn the_mission_goes_on_without_a_robot_that_falls_silent() {
    let (periods, end) = run_with_losses(shipped("study-1"), true, jammed_from(100));
    assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
    let mut events = periods.iter().flat_map(|period| &period.events);
    let gives_up = |event: &Event| matches!(event, Event::TaskReannounced { gone, .. } if *gone == [NOBODY_NEEDS]);
    assert!(events.any(gives_up));
}

#[test]
fn missions_are_serviced_although_every_tenth_message_is_lost() {
    for name in ["study-1", "study-2"] {
        let (_, end) = run_with_losses(shipped(name), false, one_of(10));
        assert_eq!(end.outcome, Outcome::Serviced, "{name}: {}", end.reason);
    }
}

/// Losses may end a mission by its step limit, or because a robot stands still whose messages are those that are
/// lost, and break nothing.
#[test]
fn losses_end_in_a_stated_outcome() {
    for name in ["study-2", "leaf-leader"] {
        for n in [3, 10, 100] {
            let mut scenario = shipped(name);
            scenario.control.max_steps = Some(500);
            let (_, end) = run_with_losses(scenario, false, one_of(n));
            let outcomes = [Outcome::Serviced, Outcome::StepLimit, Outcome::Blocked];
            assert!(outcomes.contains(&end.outcome), "{name}, one of {n}: {}", end.reason);
        }
    }
}
