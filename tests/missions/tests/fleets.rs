//! `teams = "per_access_point"`: the robots of each access point pursue its tasks, at the same time as the others.
//! Each mission is held against every property while it runs.

use missions::floor_plans::{Family, scenario};
use missions::{Period, read, run, shipped, shipped_mission, traced, valid};
use pleach::automaton::network::record::{End, MissionEvent, Outcome, Snapshot};
use pleach::automaton::network::scenario::{Scenario, Teams, ValidScenario};
use pleach::automaton::network::{Crash, NodeFaults};
use pleach::automaton::node::{MessageFaults, Partition};
use pleach::judge::{Verdict, judge};
use pleach::mission::{self, MissionError, Watcher};
use pleach::trace::{TraceReader, TraceWriter};
use pleach::verify::network::Property;
use pleach::verify::network::storm::Storm;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::io;
use std::sync::OnceLock;

/// Missions of each family.
const SEEDS: u64 = 4;

/// The same scenario, in which each access point has a team of its own.
fn in_teams(scenario: &Scenario) -> Scenario {
    let mut teams = scenario.clone();
    teams.control.teams = Some(Teams::PerAccessPoint);
    teams
}

/// The same scenario with one team.
fn in_one_team(scenario: &Scenario) -> Scenario {
    let mut one = scenario.clone();
    one.control.teams = None;
    one.robot.iter_mut().for_each(|robot| robot.access_point = None);
    one.task.iter_mut().for_each(|task| task.access_point = None);
    one
}

/// The same fleets, each with the tasks of the next one: their ways lead across each other's.
fn with_tasks_passed_on(scenario: &ValidScenario) -> Scenario {
    let mut passed = scenario.scenario().clone();
    for fleet in scenario.fleets() {
        let next = (fleet.access_point() + 1) % passed.access_point.len();
        for task in 0..fleet.scenario().task.len() {
            let number = fleet.outward().task(task).unwrap();
            passed.task[number].access_point = Some(next);
        }
    }
    passed
}

/// The trace of the mission of a scenario, and its outcome.
fn trace(scenario: &ValidScenario) -> (Vec<u8>, Outcome) {
    let (bytes, completed) = traced(scenario);
    (bytes, completed.end.outcome)
}

fn outcomes(end: &End) -> Vec<Outcome> {
    end.fleets.iter().map(|it| it.end.outcome).collect()
}

fn verdict(bytes: &[u8]) -> Verdict {
    judge(TraceReader::new(bytes).unwrap()).unwrap()
}

// ---- Two teams ---------------------------------------------------------------------------------

#[test]
fn two_teams_at_once_take_less_time_than_one_after_the_other() {
    let teams = &shipped_mission("two-teams").0;
    let one = run(in_one_team(&teams.scenario));
    teams.assert_serviced();
    one.assert_serviced();
    let periods = [one.periods.len(), teams.periods.len()];
    assert_eq!(periods, [436, 259]);
}

/// What there is one of, there is one of for each fleet; a fleet whose mission is over stands.
#[test]
fn a_snapshot_shows_the_fleets_side_by_side() {
    let mission = &shipped_mission("two-teams").0;
    let both_pursue = |it: &&Period| it.snapshot.fleets.iter().all(|fleet| fleet.task.is_some());
    let at_once = mission.periods.iter().filter(both_pursue).count();
    assert!(at_once > mission.periods.len() / 2, "{at_once} of {}", mission.periods.len());
    assert_eq!(mission.end.fleets.len(), 2);
    let of_one = &shipped_mission("two-clusters").0;
    assert!(of_one.periods.iter().all(|period| period.snapshot.fleets.is_empty()));
    assert!(of_one.end.fleets.is_empty());
}

#[test]
fn a_fleet_that_has_ended_stands_while_the_other_goes_on() {
    let mission = &shipped_mission("two-teams").0;
    let ended = |period: &Period| period.snapshot.fleets[0].ended;
    let since = mission.periods.iter().find_map(ended).expect("one ends before the other");
    let rest = &mission.periods[since..];
    assert!(rest.len() > 20, "{since}");
    assert!(rest.iter().all(|period| ended(period) == Some(since)));
    let west = |period: &Period| period.snapshot.positions[..6].to_vec();
    assert!(rest.iter().all(|period| west(period) == west(&mission.periods[since - 1])));
}

/// A team that cannot go on ends its own mission, and the other one services its tasks all the same.
#[test]
fn the_end_names_the_access_point_whose_tasks_are_not_serviced() {
    let mut short = shipped("two-teams");
    short.robot.truncate(8);
    let mission = run(short);
    assert_eq!(mission.end.outcome, Outcome::InsufficientRobots, "{}", mission.end.reason);
    assert!(mission.end.reason.starts_with("of access point 1: "), "{}", mission.end.reason);
    let outcomes: Vec<Outcome> = mission.end.fleets.iter().map(|it| it.end.outcome).collect();
    assert_eq!(outcomes, [Outcome::Serviced, Outcome::InsufficientRobots]);
    assert_eq!(mission.end.tasks, [1, 3], "{}", mission.end.reason);
}

/// What stands in the way of the team is no robot of its own.
#[test]
fn a_team_that_a_body_blocks_says_so() {
    let mission = run(read("tests/scenarios/given-up/body-in-corridor.toml").into_scenario());
    assert_eq!(mission.end.outcome, Outcome::Blocked, "{}", mission.end.reason);
    let told = "a robot of another access point stands beside robot 2";
    assert!(mission.end.reason.ends_with(told), "{}", mission.end.reason);
    let task_of_other = mission.end.fleets[1].end.outcome;
    assert_eq!(task_of_other, Outcome::Serviced, "it has none");
}

/// Flows lag behind where messages are lost. The links of the team carry all the same: what it is told to be blocked
/// by is what stands in its way.
#[test]
fn a_team_that_a_body_blocks_does_not_blame_its_links_where_messages_are_lost() {
    let scenario = read("tests/scenarios/given-up/body-in-corridor.toml");
    for (loss, seed) in [(0.05, 1), (0.1, 2), (0.2, 3), (0.3, 4)] {
        let messages = MessageFaults { loss, ..MessageFaults::default() };
        let lossy = Storm { seed, messages, nodes: Vec::new() };
        let end = mission::run_in_storm(&scenario, &lossy, &mut []).unwrap().end;
        assert_eq!(end.outcome, Outcome::Blocked, "{loss} {seed}: {}", end.reason);
        let told = "something stands in its way, and a recruit would not help";
        assert!(end.reason.ends_with(told), "{loss} {seed}: {}", end.reason);
    }
}

/// Interrupts a mission after this many control periods.
struct After(usize);

impl Watcher for After {
    fn observe(&mut self, _: &Snapshot, _: &[MissionEvent]) -> io::Result<()> {
        self.0 = self.0.saturating_sub(1);
        Ok(())
    }

    fn interruption(&self) -> Option<String> {
        (self.0 == 0).then(|| "enough is seen".to_owned())
    }
}

/// Fleet 0 has ended by then, and keeps its own end.
#[test]
fn an_interruption_and_a_limit_end_the_missions_that_go_on() {
    let scenario = valid(shipped("two-teams"));
    let mut writer = TraceWriter::new(Vec::new(), &scenario).unwrap();
    let completed = mission::run(&scenario, &mut [&mut writer, &mut After(230)]).unwrap();
    assert_eq!(completed.end.outcome, Outcome::Interrupted);
    assert_eq!(completed.end.reason, "enough is seen");
    assert_eq!(outcomes(&completed.end), [Outcome::Serviced, Outcome::Interrupted]);
    assert!(matches!(verdict(&writer.finish().unwrap()), Verdict::Sound { periods: 230, .. }));

    let mut limited = shipped("two-teams");
    limited.control.max_steps = Some(230);
    let (bytes, outcome) = trace(&valid(limited));
    assert_eq!(outcome, Outcome::StepLimit);
    assert!(matches!(verdict(&bytes), Verdict::Sound { periods: 230, .. }));
}

// ---- Random missions ---------------------------------------------------------------------------

/// Missions of fleets, with tasks on their own side and on that of the next one.
fn missions() -> Vec<ValidScenario> {
    let families = [Family::TwoClusters, Family::Clusters];
    let seeds = families.into_iter().flat_map(|family| (1..=SEEDS).map(move |seed| (family, seed)));
    let pair = |(family, seed)| {
        let near = valid(in_teams(scenario(family, seed).scenario()));
        let far = valid(with_tasks_passed_on(&near));
        [near, far]
    };
    seeds.flat_map(pair).collect()
}

#[test]
fn random_missions_of_fleets_keep_their_promises_and_give_the_same_bytes() {
    let serviced = missions().into_par_iter().map(|scenario| {
        let (bytes, outcome) = trace(&scenario);
        let stated = matches!(outcome, Outcome::Serviced | Outcome::InsufficientRobots);
        assert!(stated, "{}: {outcome:?}", scenario.name);
        assert!(matches!(verdict(&bytes), Verdict::Sound { .. }), "{}", scenario.name);
        assert!(trace(&scenario).0 == bytes, "{}: another trace", scenario.name);
        usize::from(outcome == Outcome::Serviced)
    });
    let (serviced, all) = (serviced.sum::<usize>(), 4 * SEEDS as usize);
    assert!(2 * serviced >= all, "{serviced} of {all}");
}

// ---- Faults ------------------------------------------------------------------------------------

#[test]
fn fleets_may_lose_messages() {
    let messages = MessageFaults { loss: 0.2, ..MessageFaults::default() };
    let (end, _) = in_storm(&Storm { seed: 3, messages, nodes: Vec::new() });
    assert_eq!(end.outcome, Outcome::Serviced, "{}", end.reason);
}

/// Each fleet goes on with the robots that it has left: robot 1 restarts, and without robot 8, which is number 2 of
/// its fleet, there are too few of them.
#[test]
fn fleets_may_lose_robots() {
    let crash = |time, back| NodeFaults {
        crash: Some(Crash { time, inputs: 0, back }),
        ..NodeFaults::default()
    };
    let nodes = vec![(1, crash(30.0, Some(60.0))), (8, crash(40.0, None))];
    let (end, snapshots) = in_storm(&Storm { nodes, ..Storm::default() });
    assert_eq!(outcomes(&end), [Outcome::Serviced, Outcome::InsufficientRobots]);
    let absent = |period: usize| &snapshots[period].absent[..];
    assert_eq!([absent(29), absent(35), absent(50), absent(70)], [&[][..], &[1], &[1, 8], &[8]]);
    let place = |period: usize| snapshots[period].positions[8];
    assert!(snapshots[40..].iter().all(|snapshot| snapshot.positions[8] == place(40)));
}

/// Fleets hear nothing of each other anyway. The access points are nodes 12 and 13.
#[test]
fn a_partition_between_fleets_changes_nothing() {
    let divided = |side: &[usize]| {
        let partition = Partition { begin: 20.0, end: 25.0, side: side.to_vec() };
        let messages = MessageFaults { partitions: vec![partition], ..MessageFaults::default() };
        in_storm(&Storm { messages, ..Storm::default() }).1
    };
    let (_, whole) = in_storm(&Storm::default());
    assert!(divided(&[0, 1, 2, 3, 4, 5, 12]) == whole);
    assert!(divided(&[9, 10]) != whole);
}

#[test]
fn clocks_of_fleets_tick_together() {
    let shifted = NodeFaults { shift: 0.3, ..NodeFaults::default() };
    let storm = Storm { nodes: vec![(0, shifted)], ..Storm::default() };
    let refused = mission::run_in_storm(&valid(shipped("two-teams")), &storm, &mut []);
    assert!(matches!(refused, Err(MissionError::ShiftedClocksOfFleets)));
}

/// Runs two teams in a storm, judges the trace, and gives the end and what was seen.
fn in_storm(storm: &Storm) -> (End, Vec<Snapshot>) {
    let scenario = valid(shipped("two-teams"));
    let mut writer = TraceWriter::with_faults(Vec::new(), &scenario, storm.faults()).unwrap();
    let mut snapshots = Snapshots(Vec::new());
    let watchers: &mut [&mut dyn Watcher] = &mut [&mut writer, &mut snapshots];
    let completed = mission::run_in_storm(&scenario, storm, watchers).unwrap();
    let verdict = verdict(&writer.finish().unwrap());
    assert!(matches!(verdict, Verdict::Sound { .. }), "{verdict:?}");
    (completed.end, snapshots.0)
}

struct Snapshots(Vec<Snapshot>);

impl Watcher for Snapshots {
    fn observe(&mut self, snapshot: &Snapshot, _: &[MissionEvent]) -> io::Result<()> {
        self.0.push(snapshot.clone());
        Ok(())
    }
}

// ---- Spoiled traces ----------------------------------------------------------------------------

/// The trace of two teams, line by line.
fn sound() -> Vec<Value> {
    static TRACE: OnceLock<Vec<Value>> = OnceLock::new();
    let lines = TRACE.get_or_init(|| {
        let bytes = trace(&valid(shipped("two-teams"))).0;
        let text = String::from_utf8(bytes).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    });
    lines.clone()
}

fn verdict_of(lines: &[Value]) -> Verdict {
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    verdict(text.as_bytes())
}

/// The step of this period.
fn step(lines: &mut [Value], k: usize) -> &mut Value {
    lines.iter_mut().find(|line| line["type"] == "step" && line["k"] == k).unwrap()
}

/// The place of the first event of this kind of a robot from this number on.
fn event(lines: &[Value], kind: &str, least: u64) -> usize {
    let is_it = |line: &Value| line["event"] == kind && line["robot"].as_u64() >= Some(least);
    lines.iter().position(is_it).unwrap()
}

fn end(lines: &mut [Value]) -> &mut Value {
    lines.last_mut().unwrap()
}

/// Control periods: more than it takes until the end is heard and robots have settled, as they may after a service.
const LATE: u64 = 11;

type Spoil = (&'static str, fn(&mut Vec<Value>), &'static [Property]);

/// The robots of access point 0 are those from 0 to 5, of access point 1 those from 6 to 11; its own node is 13.
const SPOILS: [Spoil; 17] = [
    (
        "a robot of one fleet stands on one of the other",
        |lines| {
            let place = step(lines, 100)["position"][2].clone();
            step(lines, 100)["position"][8] = place;
        },
        &[Property::Separation],
    ),
    (
        "an event of a fleet is left out",
        |lines| {
            let at = event(lines, "leader_elected", 6);
            lines.remove(at);
        },
        &[Property::Events, Property::Teams, Property::Stage],
    ),
    (
        "an event is told of a robot of the other fleet",
        |lines| {
            let at = event(lines, "leader_elected", 6);
            lines[at]["robot"] = json!(2);
        },
        &[Property::Record],
    ),
    (
        "an event is told of the other fleet",
        |lines| {
            let at = event(lines, "recruit_called", 6);
            lines[at]["robot"] = json!(2);
        },
        &[Property::Events],
    ),
    (
        "a robot sends to one of the other fleet",
        |lines| step(lines, 100)["route"][0][1] = json!(8),
        &[Property::Record],
    ),
    (
        "a robot is attached to the access point of the other fleet",
        |lines| step(lines, 100)["tree"][0][1] = json!(13),
        &[Property::Record],
    ),
    (
        "the teams are not those of the fleets",
        |lines| step(lines, 100)["primary_team"] = json!([]),
        &[Property::Record],
    ),
    (
        "a fleet is left out of a step",
        |lines| {
            step(lines, 100)["fleets"].as_array_mut().unwrap().pop();
        },
        &[Property::Record],
    ),
    (
        "a fleet pursues a task of the other",
        |lines| {
            let task = step(lines, 100)["fleets"][0]["task"].clone();
            step(lines, 100)["fleets"][1]["task"] = task;
        },
        &[Property::Record],
    ),
    (
        "a mission is over before it is",
        |lines| step(lines, 200)["fleets"][0]["ended"] = json!(200),
        &[Property::Record],
    ),
    (
        "a mission is over from the middle on",
        |lines| {
            for k in 200..=258 {
                step(lines, k)["fleets"][0]["ended"] = json!(200);
            }
        },
        &[Property::Outcome],
    ),
    (
        "a mission is over later than it is",
        |lines| {
            let is_step = |line: &&mut Value| line["type"] == "step";
            for step in lines.iter_mut().filter(is_step) {
                let (k, fleet) = (step["k"].as_u64().unwrap(), &mut step["fleets"][0]);
                let Some(ended) = fleet["ended"].as_u64() else { continue };
                let late = ended + LATE;
                match k < late {
                    true => drop(fleet.as_object_mut().unwrap().remove("ended")),
                    false => fleet["ended"] = json!(late),
                }
            }
        },
        &[Property::Outcome],
    ),
    (
        "there are more periods than the scenario allows",
        |lines| lines[0]["scenario"]["control"]["max_steps"] = json!(255),
        &[Property::Record],
    ),
    (
        "a fleet ended as fleets do",
        |lines| {
            let fleets = end(lines)["fleets"].clone();
            end(lines)["fleets"][0]["fleets"] = fleets;
        },
        &[Property::Outcome],
    ),
    (
        "it is not reported how a fleet ended",
        |lines| {
            end(lines)["fleets"].as_array_mut().unwrap().pop();
        },
        &[Property::Outcome],
    ),
    (
        "a fleet ended otherwise than it did",
        |lines| end(lines)["fleets"][1]["outcome"] = json!("blocked"),
        &[Property::Outcome],
    ),
    (
        "the whole ended otherwise than its fleets",
        |lines| end(lines)["outcome"] = json!("step_limit"),
        &[Property::Outcome],
    ),
];

/// A fleet is judged as a mission of its own, in which robots and tasks have numbers of their own.
#[test]
fn a_violation_says_which_robots_and_tasks_of_the_scenario_it_speaks_of() {
    let mut lines = sound();
    let at = event(&lines, "leader_elected", 6);
    lines.remove(at);
    let Verdict::Violated(violation) = verdict_of(&lines) else { panic!("it is judged sound") };
    let told = "in the mission of access point 1, whose robots [6, 7, 8, 9, 10, 11] and tasks [1, 3] are here \
                numbered from 0 in this order: ";
    assert!(violation.sentence.starts_with(told), "{violation}");
    assert!(violation.robots.iter().all(|robot| (6..12).contains(robot)), "{violation:?}");
}

#[test]
fn spoiled_traces_of_fleets_are_told_from_sound_ones() {
    assert!(matches!(verdict_of(&sound()), Verdict::Sound { periods: 259, .. }));
    for (name, spoil, properties) in SPOILS {
        let mut lines = sound();
        spoil(&mut lines);
        match verdict_of(&lines) {
            Verdict::Sound { .. } => panic!("{name}: it is judged sound"),
            Verdict::Violated(violation) => {
                assert!(properties.contains(&violation.property), "{name}: {violation}");
                let sentence = &violation.sentence;
                assert!(!sentence.contains("Some(") && !sentence.contains("None"), "{sentence}");
                assert!(!sentence.contains(" { "), "an event as the program has it: {sentence}");
            }
        }
    }
}
