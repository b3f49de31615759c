//! The figures of invented missions: nothing is missing, nothing differs between two renderings.

use std::path::PathBuf;

use pleach_automaton::network::record::{
    End, FleetView, MissionEvent, Outcome, PostView, Route, Snapshot,
};
use pleach_automaton::network::scenario::{Scenario, ValidScenario};
use pleach_discrete::network::{Phase, Role};
use quick_xml::Reader;
use quick_xml::events::Event;

use super::{Album, Mark, Plan, Scene};
use crate::mission::Watcher;

const STUDY_ONE: &str = r#"
name = "study-1"
[workspace]
boundary = [[0,0],[1.86,0],[1.86,0.6],[1.96,0.6],[1.96,0],[2.66,0],[2.66,1.592],[1.8,1.592],[1.8,0.98],[1.66,0.98],[1.66,1.592],[0,1.592],[0,0.62],[0.62,0.62],[0.62,0.5],[0,0.5]]
holes = [[[0.7,0.8],[1.02,0.62],[1.1,1.05],[0.8,1.2]]]
[link]
full_range = 0.4
max_range = 0.5
[control]
clearance = 0.01
[[access_point]]
position = [0.5, 0.2]
[[task]]
position = [1.33, 1.42]
[[task]]
position = [1.6, 0.52]
[[task]]
position = [2.21, 0.5]
"#;

const ROBOTS: [[f64; 2]; 13] = [
    [0.20, 0.10],
    [0.33, 0.09],
    [0.46, 0.08],
    [0.60, 0.07],
    [0.74, 0.10],
    [0.16, 0.23],
    [0.29, 0.22],
    [1.05, 0.52],
    [0.77, 0.24],
    [0.22, 0.36],
    [1.33, 1.41],
    [1.20, 0.82],
    [1.29, 1.12],
];

/// Where the robots start, around the access point.
fn starts() -> impl Iterator<Item = [f64; 2]> {
    (0..13).map(|i| [0.2 + 0.1 * f64::from(i % 5), 0.1 + 0.1 * f64::from(i / 5) + 0.02])
}

fn study_one() -> Scenario {
    let starts: String =
        starts().map(|[x, y]| format!("[[robot]]\nposition = [{x}, {y}]\n")).collect();
    toml::from_str(&format!("{STUDY_ONE}{starts}")).expect("the scenario is well-formed")
}

/// A moment in which every role occurs; `share` moves robot 3 along its way.
fn moment(step: usize, share: f64) -> Snapshot {
    let mut positions = ROBOTS;
    positions[3] = [0.60 + 0.12 * share, 0.07 + 0.10 * share];
    let tree: Vec<(usize, usize)> = vec![
        (0, 13),
        (1, 13),
        (2, 13),
        (3, 13),
        (4, 13),
        (5, 6),
        (6, 13),
        (7, 8),
        (8, 13),
        (9, 13),
        (10, 12),
        (11, 7),
        (12, 11),
    ];
    let mut roles = vec![Role::Redundant; 13];
    (roles[3], roles[7], roles[8]) = (Role::Recruit, Role::Node, Role::Junction);
    (roles[10], roles[11], roles[12]) = (Role::Leaf, Role::Leader, Role::Node);
    let mut routes: Vec<Route> = tree
        .iter()
        .map(|&(from, to)| {
            let share = if to == 13 { 0.3 } else { 0.12 } + 0.02 * from as f64;
            Route { from, to, share, reliability: 0.97 }
        })
        .collect();
    routes.push(Route { from: 3, to: 2, share: 0.05, reliability: 1.0 });
    routes.push(Route { from: 0, to: 6, share: 0.04, reliability: 1.0 });
    Snapshot {
        step,
        time: step as f64,
        positions: positions.map(Into::into).to_vec(),
        roles,
        phase: Phase::Shift,
        active: vec![3, 4],
        active_team: vec![3, 4],
        primary_team: vec![7, 11],
        path: vec![3, 4, 8, 7],
        residuals: (0..13).map(|i| 0.02 + 0.01 * (step as f64 / 40.0 + i as f64).sin()).collect(),
        multipliers: (0..13).map(|i| (1.0 - (-(step as f64) / 60.0).exp()) * i as f64).collect(),
        routes,
        tree,
        task: Some(1),
        serviced: vec![(0, 10)],
        closed: Vec::new(),
        posts: vec![PostView {
            reference: [0.95, 0.40].into(),
            holder: 7,
            task: None,
            junction: false,
        }],
        robots: Vec::new(),
        absent: Vec::new(),
        fleets: Vec::new(),
    }
}

fn mission() -> Album {
    let scenario = study_one();
    let mut album = empty_album(&scenario);
    for step in 0..400 {
        let events = match step {
            0 => vec![MissionEvent::TaskAnnounced { task: 1 }],
            8 => vec![MissionEvent::LeaderElected { task: 1, robot: 11, conflict: true }],
            120 => vec![MissionEvent::RecruitElected {
                robot: 3,
                path: vec![3, 4, 8, 7],
                break_points: vec![8],
            }],
            230 => vec![MissionEvent::Released { robot: 11 }],
            310 => vec![MissionEvent::Stationary { robot: 7, team: vec![7, 11] }],
            350 => vec![MissionEvent::JoinedPrimary { robot: 3, team: vec![3, 7, 11] }],
            398 => vec![MissionEvent::TaskServiced { task: 1, robot: 11 }],
            _ => Vec::new(),
        };
        album.observe(&moment(step, step as f64 / 400.0), &events).expect("kept");
    }
    album
}

fn empty_album(scenario: &Scenario) -> Album {
    let valid = ValidScenario::new(scenario.clone()).expect("a mission can start");
    Album::new(&valid)
}

fn end() -> End {
    let reason = "No recruit is left: c < 0 & one more robot would be needed.".to_owned();
    End::new(Outcome::InsufficientRobots, reason, Some(2))
}

fn folder(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("pleach-figures-{name}-{}", std::process::id()))
}

fn picture() -> String {
    let plan = Plan::new(&study_one(), Vec::new());
    plan.render(&Scene { snapshot: &moment(5, 0.5), title: "a < b & c", trails: &[] })
}

/// Reads a document to its end; unbalanced or unescaped text is an error.
fn assert_well_formed(xml: &str) {
    let mut reader = Reader::from_str(xml);
    loop {
        match reader.read_event().expect("well-formed") {
            Event::Eof => break,
            Event::Text(text) => assert!(!text.contains('&'), "unescaped: {text:?}"),
            _ => {}
        }
    }
}

#[test]
fn every_link_and_every_edge_is_drawn_once() {
    let (picture, snapshot) = (picture(), moment(5, 0.5));
    assert_eq!(picture.matches("class=\"link\"").count(), snapshot.routes.len());
    assert_eq!(picture.matches("class=\"edge\"").count(), snapshot.tree.len());
}

#[test]
fn every_mark_has_its_own_colour_and_shape_and_stands_in_the_legend() {
    let picture = picture();
    let legend = &picture[picture.find("class=\"legend\"").expect("a legend")..];
    let shape = |mark: Mark| {
        let drawn = mark.draw([0.0, 0.0], 10.0, "").to_string();
        drawn.replace(mark.colour(), "")
    };
    for (index, mark) in Mark::ALL.into_iter().enumerate() {
        assert!(legend.contains(mark.name()), "{mark:?} is not in the legend");
        for other in &Mark::ALL[..index] {
            assert_ne!(mark.colour(), other.colour(), "{mark:?} and {other:?}");
            assert_ne!(shape(mark), shape(*other), "{mark:?} and {other:?}");
        }
    }
}

/// The numbers of an attribute, in the order of the document.
fn numbers(svg: &str, name: &str) -> Vec<f64> {
    let begin = format!(" {name}=\"");
    svg.split(&begin).skip(1).map(|rest| rest.split('"').next().unwrap().parse().unwrap()).collect()
}

/// A corridor is drawn over the whole width of the sheet, and nothing of its legend stands beside it.
#[test]
fn the_legend_stands_below_a_wide_plan() {
    let mut scenario = study_one();
    scenario.workspace.boundary = vec![[0.0, 0.0], [6.0, 0.0], [6.0, 1.5], [0.0, 1.5]];
    let plan = Plan::new(&scenario, Vec::new());
    let picture = plan.render(&Scene { snapshot: &moment(5, 0.5), title: "", trails: &[] });
    let (plan, legend) = picture.split_once("class=\"legend\"").expect("a legend");
    let walls = &plan[plan.find("class=\"plan\"").expect("walls")..];
    let [top, height] = ["y", "height"].map(|name| numbers(walls, name)[0]);
    assert!(numbers(walls, "width")[0] > 900.0);
    assert!(numbers(legend, "y").into_iter().all(|y| y > top + height));
    assert_eq!(legend.matches("<text").count(), Mark::ALL.len() + 1 + 3 + 6 + 2);
}

#[test]
fn a_stopped_robot_is_crossed_out_and_the_legend_says_so() {
    let plan = Plan::new(&study_one(), Vec::new());
    let of = |absent: Vec<usize>| {
        let snapshot = Snapshot { absent, ..moment(5, 0.5) };
        plan.render(&Scene { snapshot: &snapshot, title: "", trails: &[] })
    };
    for (picture, crosses) in [(of(vec![]), 0), (of(vec![2]), 2)] {
        assert_eq!(picture.matches("class=\"stopped\"").count(), crosses);
        assert_eq!(picture.contains("cross: stopped"), crosses > 0);
    }
}

#[test]
fn every_role_has_a_mark_of_its_own() {
    let mut snapshot = moment(0, 0.0);
    let marks: std::collections::BTreeSet<Mark> = Role::ALL
        .into_iter()
        .map(|role| {
            snapshot.roles[0] = role;
            Mark::of(&snapshot, 0)
        })
        .collect();
    assert_eq!(marks.len(), Role::ALL.len());
}

#[test]
fn an_album_tells_its_mission_in_order_and_to_the_byte() {
    let (first, second) = (folder("first"), folder("second"));
    let files = mission().write(&first, &end()).expect("written");
    let again = mission().write(&second, &end()).expect("written");
    let name = |path: &PathBuf| path.file_name().expect("a name").to_string_lossy().into_owned();
    let names: Vec<String> = files.iter().map(name).collect();
    assert_eq!(
        names,
        [
            "00-k00000-task-1-start.svg",
            "01-k00008-task-1-leader-11-elected.svg",
            "02-k00230-task-1-leader-11-released.svg",
            "03-k00310-task-1-stationary-at-7.svg",
            "04-k00350-task-1-recruit-3-joined.svg",
            "05-k00398-task-1-serviced.svg",
            "06-k00399-end.svg",
            "distances.svg",
            "residuals.svg",
            "multipliers.svg",
            "animation.svg",
            "index.html",
        ]
    );
    for (one, other) in files.iter().zip(&again) {
        let text = std::fs::read_to_string(one).expect("readable");
        assert_eq!(text, std::fs::read_to_string(other).expect("readable"), "{}", name(one));
        if name(one).ends_with(".svg") {
            assert_well_formed(&text);
        }
    }
    std::fs::remove_dir_all(&second).expect("removable");
    if std::env::var_os("PLEACH_KEEP_FIGURES").is_none() {
        std::fs::remove_dir_all(&first).expect("removable");
    }
}

/// Fleet 0 pursues tasks 0 and 2, with a pause between them, and fleet 1 task 1.
#[test]
fn curves_name_the_tasks_of_every_fleet_each_in_its_lane() {
    let mut album = empty_album(&study_one());
    for step in 0..=400 {
        let first = if step < 150 { Some(0) } else { (step >= 250).then_some(2) };
        let fleet = |access_point: usize, task: Option<usize>| FleetView {
            access_point,
            phase: Phase::Advance,
            task,
            active_team: Vec::new(),
            primary_team: Vec::new(),
            path: Vec::new(),
            ended: None,
        };
        let fleets = vec![fleet(0, first), fleet(1, (step >= 100).then_some(1))];
        album.observe(&Snapshot { fleets, ..moment(step, 0.0) }, &[]).expect("kept");
    }
    let folder = folder("lanes");
    album.write(&folder, &end()).expect("written");
    let chart = std::fs::read_to_string(folder.join("residuals.svg")).expect("readable");
    let (from, until) = (chart.find("\"tasks\"").unwrap(), chart.find("\"axes\"").unwrap());
    let bands = &chart[from..until];
    let named = |task: usize| -> [f64; 2] {
        let text = &bands[..bands.find(&format!("\ntask {task}\n")).expect("it is named")];
        let text = &text[text.rfind("<text").expect("in a text")..];
        ["x=\"", "y=\""].map(|name| {
            let value = &text[text.find(name).expect("it has a place") + name.len()..];
            value[..value.find('"').expect("it ends")].parse().expect("a number")
        })
    };
    let places = [0, 1, 2].map(named);
    // The plot is 810 wide and 300 high, with its upper left corner at (74, 132).
    let middle = |from: f64, until: f64| 74.0 + 810.0 * (from + until) / 2.0 / 400.0;
    let middles = [middle(0.0, 150.0), middle(100.0, 400.0), middle(250.0, 400.0)];
    for (task, (place, middle)) in places.iter().zip(middles).enumerate() {
        assert!((place[0] - middle).abs() < 0.1, "task {task} is named at {place:?}");
        let lane = 132.0 + 150.0 * [0.0, 1.0, 0.0][task];
        assert!((lane..lane + 150.0).contains(&place[1]), "task {task} is named at {place:?}");
    }
    assert_eq!(bands.matches("<rect").count(), 1, "lanes alternate, the second against the first");
    std::fs::remove_dir_all(&folder).expect("removable");
}

#[test]
fn pictures_of_an_earlier_mission_do_not_stay() {
    let folder = folder("again");
    let kept = ["notes.txt", "08-k0290-x.svg", "8-k00290-x.svg", "08-k00290-.svg", "start.svg"];
    let gone = ["07-k00275-task-0-recruit-10-joined.svg", "123-k123456-end.pdf"];
    std::fs::create_dir_all(&folder).expect("created");
    for name in kept.iter().chain(&gone) {
        std::fs::write(folder.join(name), "").expect("written");
    }
    let files = mission().write(&folder, &end()).expect("written");
    assert!(kept.iter().all(|name| folder.join(name).exists()));
    assert!(!gone.iter().any(|name| folder.join(name).exists()));
    let there = std::fs::read_dir(&folder).expect("readable").count();
    assert_eq!(there, files.len() + kept.len());
    std::fs::remove_dir_all(&folder).expect("removable");
}

#[test]
fn an_album_without_a_single_period_is_written_too() {
    let folder = folder("empty");
    let files = empty_album(&study_one()).write(&folder, &end()).expect("written");
    assert_eq!(files.len(), 5);
    std::fs::remove_dir_all(&folder).expect("removable");
}

/// A hall of 17 by 12 with pillars, and 60 robots in rows that are attached to each other.
#[test]
fn a_crowd_in_a_hall_is_drawn_with_every_number() {
    let square = |x: f64, y: f64| vec![[x, y], [x + 0.8, y], [x + 0.8, y + 0.8], [x, y + 0.8]];
    let mut scenario = study_one();
    scenario.workspace.boundary = vec![[0.0, 0.0], [17.0, 0.0], [17.0, 12.0], [0.0, 12.0]];
    scenario.workspace.holes = vec![square(8.0, 2.0), square(8.0, 8.0), square(13.0, 5.0)];
    (scenario.link.full_range, scenario.link.max_range) = (2.7, 3.4);
    scenario.control.clearance = Some(0.07);
    scenario.access_point[0].position = [0.5, 6.0];
    for (task, x) in scenario.task.iter_mut().zip([16.0, 12.0, 6.0]) {
        task.position = [x, 11.0];
    }
    let mut snapshot = moment(412, 0.0);
    let places = (0..60).map(|i| [1.2 + 0.75 * (i % 8) as f64, 0.8 + 1.4 * (i / 8) as f64]);
    snapshot.positions = places.map(Into::into).collect();
    snapshot.roles = (0..60).map(|i| Role::ALL[if i % 9 == 4 { i % 6 } else { 0 }]).collect();
    snapshot.tree = (0..60).map(|i| (i, if i % 8 == 0 { 60 } else { i - 1 })).collect();
    let links = snapshot.tree.iter();
    snapshot.routes = links
        .map(|&(from, to)| Route { from, to, share: 0.1 * (8 - from % 8) as f64, reliability: 1.0 })
        .collect();
    let plan = Plan::new(&scenario, vec![vec![[0.1, 0.1], [16.9, 0.1], [16.9, 11.9], [0.1, 11.9]]]);
    let picture = plan.render(&Scene { snapshot: &snapshot, title: "k = 412", trails: &[] });
    assert_well_formed(&picture);
    let labels = &picture[picture.find("class=\"labels\"").expect("labels")..];
    for robot in 0..60 {
        assert!(labels.contains(&format!("\n{robot}\n")), "robot {robot} has no number");
    }
    if std::env::var_os("PLEACH_KEEP_FIGURES").is_some() {
        std::fs::write(folder("hall.svg"), picture).expect("written");
    }
}
