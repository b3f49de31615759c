//! Missions in storms: whatever becomes of messages, robots do not collide.
//!
//! `cargo run --release --example storm -- table 4` shows all kinds of storms, and what breaks in them.

use crate::stressed::stressed_scenarios;
use missions::in_storms::{DURATION, mission_of_turn};
use missions::{arguments, shipped, strategies, valid};
use pleach::automaton::network::record::{End, MissionEvent, Outcome};
use pleach::automaton::network::scenario::{Strategy, ValidScenario};
use pleach::automaton::network::{Crash, FaultyNode, Message, Network, NodeFaults};
use pleach::automaton::node::Medium;
use pleach::automaton::{Executor, HybridTime, Observer, Reason};
use pleach::continuous::Point;
use pleach::mission;
use pleach::verify::network::storm::{
    Judge, Kind, Storm, Verdict, allowing_for, draw, judged_run, network,
};
use pleach::verify::network::{Property, Violation};
use std::ops::ControlFlow;

const PERIODS: usize = 600;
/// Control periods for robots that keep larger clearances and shorter links.
const PERIODS_WITH_ERRORS: usize = 1_200;

/// A mission in a storm.
fn storm(name: &str, kind: Kind, seed: u64) -> Verdict {
    storm_for(PERIODS, name, kind, seed)
}

fn storm_for(periods: usize, name: &str, kind: Kind, seed: u64) -> Verdict {
    println!("{name}, {}, seed {seed}", kind.name());
    let scenario = valid(shipped(name));
    let scenario = allowing_for(kind, &scenario).expect("there is room for errors");
    let storm = draw(kind, seed, &scenario, DURATION);
    let is_exact = kind.errors(&scenario).are_none();
    let periods = if is_exact { periods } else { PERIODS_WITH_ERRORS };
    judged_run(&scenario, &storm, periods).expect("nodes go on whatever they receive")
}

/// A shipped scenario in the paper's order, for what happens at a certain time of its mission, or in a certain storm.
fn in_papers_order(name: &str) -> ValidScenario {
    strategies::following(Some(Strategy::Paper), valid(shipped(name)))
}

/// How the mission of a shipped scenario in the paper's order ends in which one node stops and nothing else fails; no
/// promise is broken.
fn end_although_one_stops(name: &str, node: usize, crash: Crash, periods: usize) -> End {
    end_of_mission_in_which_one_stops(&in_papers_order(name), node, crash, periods)
}

/// A scenario that is kept for what happens when one of its robots stops.
fn kept(name: &str) -> ValidScenario {
    missions::read(format!("tests/scenarios/{name}.toml"))
}

/// As [`end_although_one_stops`], in any scenario.
fn end_of_mission_in_which_one_stops(
    scenario: &ValidScenario,
    node: usize,
    crash: Crash,
    periods: usize,
) -> End {
    let (name, time) = (&scenario.name, crash.time);
    let nodes = vec![(node, NodeFaults { crash: Some(crash), ..NodeFaults::default() })];
    let storm = Storm { nodes, ..Storm::default() };
    let verdict = judged_run(scenario, &storm, periods).expect("nodes go on");
    assert_eq!(verdict.violations, [], "{name}, node {node} at {time} s");
    verdict.end.unwrap_or_else(|| panic!("{name}, node {node} at {time} s: no end"))
}

#[test]
fn no_loss_of_messages_brings_robots_into_contact_or_breaks_routes() {
    let kinds = [
        (Kind::Loss { rate: 0.3, later: false }, 2),
        (Kind::Loss { rate: 0.3, later: true }, 2),
        (Kind::Loss { rate: 0.6, later: true }, 10),
        (Kind::Delay, 2),
        (Kind::Copies, 2),
        (Kind::Silence, 2),
        (Kind::Radio, 2),
        (Kind::Late, 4),
    ];
    for name in ["corridor", "study-2"] {
        for (kind, seeds) in kinds {
            for seed in 0..seeds {
                let violations = storm(name, kind, seed).violations;
                assert_eq!(violations, [], "{name}, {}, seed {seed}", kind.name());
            }
        }
    }
}

/// The judge of storms with events that are not as the mission told them.
struct Spoiled {
    judge: Judge,
    spoil: fn(&mut MissionEvent),
}

impl<M: Medium<Message, Point>> Observer<Network<M, FaultyNode>> for Spoiled {
    fn flows(
        &mut self,
        network: &Network<M, FaultyNode>,
        _: HybridTime,
        _: f64,
    ) -> ControlFlow<End> {
        let mut events = network.events();
        events.iter_mut().for_each(self.spoil);
        self.judge.observe(&network.snapshot(), &events, network.nodes());
        ControlFlow::Continue(())
    }
}

/// What the judge finds in the mission of corridor without faults, with such events.
fn found_in(spoil: fn(&mut MissionEvent)) -> Vec<Violation> {
    let (scenario, storm) = (valid(shipped("corridor")), Storm::default());
    let mut observer = Spoiled { judge: Judge::new(&scenario, &storm), spoil };
    let mut network = network(&scenario, &storm).expect("it is valid");
    let horizon = scenario.settings().period * PERIODS as f64;
    let ending =
        Executor::new(horizon, 1_000_000).expect("valid limits").run(&mut network, &mut observer);
    let Reason::Finished(end) = ending.expect("nodes go on").reason else {
        panic!("it ends in time")
    };
    observer.judge.conclude(&end);
    observer.judge.into_violations().0
}

#[test]
fn a_service_from_afar_is_not_believed() {
    assert_eq!(found_in(|_| {}), []);
    let found = found_in(|event| {
        if let MissionEvent::TaskServiced { robot, .. } = event {
            *robot = (*robot + 1) % 13;
        }
    });
    let properties = |found: Vec<Violation>| found.iter().map(|it| it.property).collect::<Vec<_>>();
    assert_eq!(properties(found), [Property::Events, Property::Outcome]);
    let found = properties(found_in(|event| {
        if let MissionEvent::TaskServiced { .. } = event {
            *event = MissionEvent::RouteInfeasible { robot: 0 };
        }
    }));
    assert!(found.contains(&Property::Service) && found.contains(&Property::Outcome), "{found:?}");
}

/// The same where rates are near what links carry and links of the tree may be weak: there a robot that
/// moves without the consent of those that rely on it overloads them, or stretches their links.
#[test]
fn no_loss_of_messages_overloads_robots_under_stress() {
    let kinds = [
        Kind::Loss { rate: 0.3, later: true },
        Kind::Loss { rate: 0.6, later: true },
        Kind::Silence,
    ];
    for (number, scenario) in stressed_scenarios().enumerate() {
        let scenario = valid(scenario);
        for kind in kinds {
            for seed in 0..3 {
                let storm = draw(kind, seed, &scenario, DURATION);
                let verdict = judged_run(&scenario, &storm, PERIODS).expect("nodes go on");
                let violations = verdict.violations;
                assert_eq!(violations, [], "stress {number}, {}, seed {seed}", kind.name());
            }
        }
    }
}

/// Robots that are cut off attach to none of those that are attached to them.
#[test]
fn no_path_up_the_tree_becomes_a_cycle_whoever_is_cut_off() {
    for (name, kind, seed, duration) in
        [("corridor", Kind::Partition, 3, 496.0), ("discs", Kind::Radio, 2, 815.0)]
    {
        let verdict = drawn_in_papers_order(name, kind, seed, duration, 650);
        assert_eq!(verdict.violations, [], "{name}, {}", kind.name());
    }
}

/// A shipped scenario in the paper's order, in a storm of this duration in seconds.
fn drawn_in_papers_order(
    name: &str,
    kind: Kind,
    seed: u64,
    duration: f64,
    periods: usize,
) -> Verdict {
    let scenario = in_papers_order(name);
    let storm = draw(kind, seed, &scenario, duration);
    judged_run(&scenario, &storm, periods).expect("nodes go on whatever they receive")
}

/// The robots between it and the holder of the post above have gone: the two hear each other now and then, from farther
/// away than links are long.
#[test]
fn no_robot_is_linked_to_one_that_comes_into_range_by_chance() {
    let verdict = drawn_in_papers_order("discs", Kind::Restart, 3, 824.0, 1_000);
    assert_eq!(verdict.violations, []);
}

/// Missions, in the paper's order, in which a promise was broken before there was one rule each. Missions change with
/// every rule, so that others decide some of them by now: unit tests of robots hold each rule.
#[test]
fn storms_that_broke_a_promise_once_break_none() {
    let sixty_percent = Kind::Loss { rate: 0.6, later: true };
    let kept = [
        // The robot relieved on Σ gives its post up before the robot behind takes it, whatever is announced.
        (Kind::Partition, 13, 297, PERIODS),
        // Places of robots that are suspended are told to those that have not heard them.
        (Kind::Crash, 24, 541, PERIODS),
        // Packets flow to an access point that is not heard for a while.
        (sixty_percent, 34, 755, PERIODS),
        // A robot that restarts takes a new post before anything else.
        (Kind::Restart, 50, 1114, PERIODS),
        // Packets flow to a robot that is called gone as long as it has granted them.
        (sixty_percent, 88, 1943, PERIODS),
        // A robot that is cut off, and stops then, has not got farther than others allow for.
        (Kind::Everything, 33, 747, PERIODS),
        // Grants end no later than the flows that carry them.
        (Kind::Silence, 146, 3222, 1_500),
        // A robot outside of its region makes its way back in whole or not at all.
        (Kind::Errors(0.25), 183, 4046, 750),
        // A robot that falls silent well in range may be on its way until a roll tells.
        (Kind::Everything, 3_770, 90_503, PERIODS),
        // Nobody stands for a post that the subgroup before has taken, also where its holder is not heard.
        (Kind::Everything, 13_532, 324_791, PERIODS),
        // Nothing is raised over links of a length that is not known.
        (Kind::Everything, 16_701, 400_847, PERIODS),
    ];
    let mut broken = Vec::new();
    for (kind, turn, seed, periods) in kept {
        let (scenario, storm) = mission_of_turn(turn, kind, seed);
        let scenario = strategies::following(Some(Strategy::Paper), scenario);
        let verdict = judged_run(&scenario, &storm, periods).expect("nodes go on");
        broken.extend(verdict.violations.first().map(|first| format!("{seed}: {first}")));
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

/// The same where recruits are called for ahead of a standstill.
#[test]
fn storms_in_which_recruits_are_called_ahead_break_no_promise() {
    let kept = [
        // Σ has left the tree for a link that may be built: the robots on both sides are break points, and one whose
        // task is announced again on its way does not go back to a post that is out of reach of its parent.
        (Kind::Radio, 20_963, 503_124),
        // Robots that are cut off when others begin are known to start nearby.
        (Kind::Everything, 25_222, 605_351),
        (Kind::Everything, 25_998, 623_975),
        // An access point that begins again suspends those that it has not heard.
        (Kind::AccessPoint, 25_906, 621_766),
        // Σ crosses an access point, and later passes a post that is attached to it: its robot is a break point.
        (Kind::Everything, 50_476, 1_211_447),
        // A robot takes over the task of one with a lower number that has stopped: a snapshot names the one that runs.
        (Kind::Crash, 333_347, 8_000_341),
    ];
    for (kind, turn, seed) in kept {
        let (scenario, storm) = mission_of_turn(turn, kind, seed);
        let scenario = strategies::following(Some(Strategy::Eager), scenario);
        let verdict = judged_run(&scenario, &storm, PERIODS).expect("nodes go on");
        assert_eq!(verdict.violations, [], "{seed}");
    }
}

/// The robots of a branch whose parent has stopped are gone until the next team passes them. One of them would
/// stand in its way for good.
#[test]
fn a_branch_that_is_cut_off_takes_part_again_when_a_team_passes_it() {
    let crash = Crash { time: 282.0, inputs: 0, back: None };
    let end = end_although_one_stops("study-2", 8, crash, 1_500);
    assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
}

/// It begins again with a post of its own before others miss it. Those that were attached to its former post do
/// not hold it back.
#[test]
fn a_robot_that_begins_again_soon_holds_nobody_up() {
    let stops = [
        ("study-2", 9, 150.0),
        ("corridor", 8, 60.0),
        ("corridor", 8, 200.0),
        ("discs", 4, 60.0),
        ("office", 10, 200.0),
        ("study-1", 11, 330.0),
    ];
    for (name, robot, time) in stops {
        let crash = Crash { time, inputs: 0, back: Some(time + 2.0) };
        let end = end_although_one_stops(name, robot, crash, 2_000);
        assert_eq!(end.outcome, Outcome::Serviced, "{name}: {}", end.reason);
    }
}

/// The access point hears it, and it is too far off for a link now that the robot between has stopped.
#[test]
fn a_robot_that_is_heard_and_cannot_be_attached_holds_nobody_up() {
    let scenario = kept("in-range-without-a-link");
    let crash = Crash { time: 63.0, inputs: 0, back: None };
    let end = end_of_mission_in_which_one_stops(&scenario, 0, crash, 400);
    assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
}

/// Between it and the wall another robot just fits. The leader comes to the end of its link there, and recruits are
/// called for.
#[test]
fn a_leader_at_the_end_of_its_link_waits_beside_a_robot_that_has_stopped() {
    let scenario = kept("narrow-gap-beside-a-robot-that-has-stopped");
    let crash = Crash { time: 60.0, inputs: 0, back: None };
    let end = end_of_mission_in_which_one_stops(&scenario, 2, crash, 1_000);
    assert_eq!(end.outcome, Outcome::InsufficientRobots, "{}", end.reason);
}

/// It changes over from one access point to another. Its link to the first would take it farther on another way, on
/// which it never comes near the second.
#[test]
fn a_recruit_that_changes_over_goes_where_the_next_link_reaches() {
    let scenario = kept("another-way-than-that-of-the-link");
    let crash = Crash { time: 19.0, inputs: 0, back: Some(22.0) };
    let end = end_of_mission_in_which_one_stops(&scenario, 2, crash, 600);
    assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
}

/// They were cut off when the task was announced; those that it was announced to cannot service it alone.
#[test]
fn robots_that_come_back_are_asked_before_a_task_is_given_up() {
    for seed in [1, 2] {
        let scenario = in_papers_order("office");
        let storm = draw(Kind::Partition, seed, &scenario, 815.0);
        let verdict = judged_run(&scenario, &storm, 2_000).expect("nodes go on");
        assert_eq!(verdict.violations, [], "{seed}");
        let end = verdict.end.unwrap_or_else(|| panic!("{seed}: it does not end"));
        assert_eq!(end.outcome, Outcome::Serviced, "{seed}: {}", end.reason);
        let helps = |(_, event): &(usize, MissionEvent)| match event {
            MissionEvent::TaskReannounced { joined, .. } => !joined.is_empty(),
            _ => false,
        };
        assert!(verdict.events.iter().any(helps), "{seed}");
    }
}

/// The robot in its way stops in the very period in which it is to exchange duties with the mover, or in the one
/// before: the mover begins again, and the task is announced to all that are left.
#[test]
fn a_robot_whose_partner_stops_in_an_exchange_answers_again() {
    for (name, robot, time) in [("corridor", 10, 52.0), ("corridor", 12, 111.0)] {
        let crash = Crash { time, inputs: 0, back: None };
        let end = end_although_one_stops(name, robot, crash, 1_000);
        // The one that has stopped stands in the only way.
        let names = format!("robot {robot} has stopped");
        assert!(end.reason.contains(&names), "{name}: {}", end.reason);
    }
}

/// Control periods begin with the first clock that is due: missions take as long as with clocks that agree.
#[test]
fn missions_are_serviced_although_clocks_are_not_aligned() {
    for (name, at_most) in [("corridor", 393), ("study-2", 510)] {
        let verdict = storm(name, Kind::Clocks, 0);
        assert_eq!(verdict.violations, [], "{name}");
        let end = verdict.end.expect("it ends in time");
        assert_eq!(end.outcome, Outcome::Serviced, "{name}: {}", end.reason);
        assert!(verdict.periods <= at_most, "{name}: {}", verdict.periods);
    }
}

/// All robots begin some control periods after the access point and the user.
#[test]
fn an_access_point_waits_for_robots_that_begin_after_it() {
    let scenario = valid(shipped("redundant-node"));
    let late = NodeFaults { joins: Some(4.0), ..NodeFaults::default() };
    let nodes = (0..scenario.robot.len()).map(|robot| (robot, late.clone())).collect();
    let storm = Storm { nodes, ..Storm::default() };
    let verdict = judged_run(&scenario, &storm, PERIODS).expect("nodes go on");
    assert_eq!(verdict.violations, []);
    let end = verdict.end.expect("it ends in time");
    assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
}

/// Positions and moves are off by as much as the scenario says that they may be.
#[test]
fn errors_of_position_and_motion_that_are_allowed_for_do_no_harm() {
    for name in ["corridor", "study-2"] {
        for kind in [Kind::Errors(0.25), Kind::Motion(0.3), Kind::Position(0.003)] {
            let Verdict { end, violations, .. } = storm(name, kind, 0);
            let mission = format!("{name}, {}", kind.name());
            assert_eq!(violations, [], "{mission}");
            let end = end.expect("it ends in time");
            assert_eq!(end.outcome, Outcome::Serviced, "{mission}: {}", end.reason);
        }
    }
}

/// One message in ten is lost, and the mission takes hardly longer.
#[test]
fn the_mission_goes_on_although_messages_are_lost() {
    for later in [false, true] {
        let verdict = storm("corridor", Kind::Loss { rate: 0.1, later }, 0);
        let end = verdict.end.expect("it ends in time");
        assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
    }
}

/// A robot that joins late, or restarts with nothing known, breaks no promise, and the mission ends.
#[test]
fn robots_that_join_late_or_restart_go_on() {
    for kind in [Kind::Late, Kind::Restart] {
        for seed in 0..6 {
            let verdict = storm_for(1_500, "study-2", kind, seed);
            assert_eq!(verdict.violations, [], "{} {seed}", kind.name());
            assert!(verdict.end.is_some(), "{} {seed}: it does not end", kind.name());
        }
    }
}

/// Robots that restart learn what the others do, and the others go on without them: a member of the team
/// whose post bears another, the leader in the only way of the next one, and the last robot of the team.
#[test]
fn missions_are_serviced_although_a_robot_restarts() {
    let scenario = in_papers_order("corridor");
    for seed in [1, 2, 7] {
        let storm = draw(Kind::Restart, seed, &scenario, 497.0);
        let verdict = judged_run(&scenario, &storm, 1_500).expect("nodes go on");
        assert_eq!(verdict.violations, [], "{seed}");
        let end = verdict.end.unwrap_or_else(|| panic!("{seed}: it does not end"));
        assert_eq!(end.outcome, Outcome::Serviced, "{seed}: {}", end.reason);
    }
}

/// Sums of control periods are rounded where a period is no power of two: a robot restarts at the ticks of the others
/// all the same, and each instant is seen once.
#[test]
fn a_robot_restarts_at_the_tick_of_the_others() {
    for period in [0.01, 0.3, 0.7] {
        let mut scenario = shipped("leaf-leader");
        scenario.control.period = Some(period);
        let scenario = valid(scenario);
        let time = |step: f64| step * period;
        let crash = Crash { time: time(50.0), inputs: 0, back: Some(time(70.0)) };
        let nodes = vec![(3, NodeFaults { crash: Some(crash), ..NodeFaults::default() })];
        let storm = Storm { nodes, ..Storm::default() };
        let end = mission::run_in_storm(&scenario, &storm, &mut []).unwrap().end;
        assert_eq!(end.outcome, Outcome::Serviced, "{period} s: {}", end.reason);
    }
}

/// The first access point restarts, and has forgotten everything: it learns from the robots what is under
/// way, and who is gone. The user asks again.
#[test]
fn the_mission_goes_on_when_the_first_access_point_restarts() {
    for (name, gone, time, back) in
        [("corridor", 11, 100.0, 105.0), ("study-2", 6, 60.0, 90.0), ("corridor", 0, 3.0, 4.0)]
    {
        let scenario = valid(shipped(name));
        let first = scenario.robot.len();
        let crash = |time, back| NodeFaults {
            crash: Some(Crash { time, inputs: 0, back }),
            ..NodeFaults::default()
        };
        let nodes = vec![(gone, crash(30.0, None)), (first, crash(time, Some(back)))];
        let storm = Storm { nodes, ..Storm::default() };
        let verdict = judged_run(&scenario, &storm, 1_500).expect("nodes go on");
        assert_eq!(verdict.violations, [], "{name}, back at {back} s");
        let end = verdict.end.unwrap_or_else(|| panic!("{name}, back at {back} s: no end"));
        assert_eq!(end.outcome, Outcome::Serviced, "{name}, back at {back} s: {}", end.reason);
    }
}

/// Where another access point is in reach, robots attach to that; without the first one, the user is told.
#[test]
fn an_access_point_that_stops_is_replaced_by_another_or_named() {
    let robots = shipped("study-2").robot.len();
    let becomes_of = |access_point: usize, time| {
        let crash = Crash { time, inputs: 0, back: None };
        end_although_one_stops("study-2", robots + access_point, crash, 1_500)
    };
    for time in [30.0, 150.0, 300.0] {
        let end = becomes_of(1, time);
        assert_eq!(end.outcome, Outcome::Serviced, "{time} s: {}", end.reason);
        let end = becomes_of(0, time);
        assert_eq!(end.outcome, Outcome::Blocked, "{time} s: {}", end.reason);
        assert!(end.reason.contains("access point 0 has not been heard of"), "{}", end.reason);
    }
}

/// A robot that stops is given up, and nothing breaks. The others go round it and service all tasks, but
/// where it stands in the only way.
#[test]
fn the_mission_goes_on_without_a_robot_that_stops() {
    let mut blocked = Vec::new();
    for (name, seeds) in [("corridor", 0..4), ("study-2", 0..2)] {
        for seed in seeds {
            let verdict = storm_for(1_500, name, Kind::Crash, seed);
            assert!(verdict.violations.is_empty(), "{name} {seed}: {}", verdict.violations[0]);
            let end = verdict.end.expect("it ends in time");
            if end.outcome != Outcome::Serviced {
                blocked.push((name, seed, end.reason));
            }
        }
    }
    assert!(blocked.len() < 2, "{blocked:?}");
    assert!(
        blocked
            .iter()
            .all(|(.., reason)| reason.contains(" stopped, or no access point hears of ")),
        "{blocked:?}"
    );
}

/// The first argument of the example `storm` is a number, or names what else it does.
#[test]
fn a_number_of_missions_that_is_none_is_refused_with_what_may_stand_there() {
    assert_eq!((arguments::missions("12"), arguments::seed("0")), (Ok(12), Ok(0)));
    let refused = arguments::missions("x").unwrap_err();
    assert!(refused.starts_with("a whole number from 1 to "), "{refused}");
    assert!(refused.contains("seed, one and table"), "{refused}");
    assert!(arguments::count("0").unwrap_err().contains("from 1 to"));
    assert!(arguments::seed("-1").unwrap_err().contains("from 0 to"));
}
