//! The shipped scenarios as whole missions: how each ends, the story it was made to tell, and that an oracle that knows
//! nothing of the monitor notices what is wrong in a trace. `cargo test -p missions` shows that it agrees with the monitor
//! on all of them.

use missions::oracle::audit;
use missions::{Mission, Period, shipped_mission, shipped_names};
use pleach::automaton::network::record::{MissionEvent as Event, Outcome, Snapshot};
use pleach::automaton::network::scenario::Settings;
use pleach::continuous::Point;
use pleach::discrete::network::Role;
use pleach::trace::TraceReader;
use pleach::verify::network::SLACK;
use std::collections::BTreeSet;

/// Every shipped scenario with its outcome and the number of tasks serviced.
const SHIPPED: [(&str, Outcome, usize); 15] = [
    ("corridor", Outcome::Serviced, 2),
    ("discs", Outcome::Serviced, 3),
    ("errands", Outcome::Serviced, 3),
    ("hall", Outcome::Serviced, 6),
    ("leaf-leader", Outcome::Serviced, 3),
    ("office", Outcome::Serviced, 3),
    ("redundant-node", Outcome::Serviced, 1),
    ("ring", Outcome::Serviced, 2),
    ("study-1", Outcome::Serviced, 3),
    ("study-1b", Outcome::Serviced, 3),
    ("study-2", Outcome::Serviced, 2),
    ("too-few", Outcome::InsufficientRobots, 1),
    ("two-clusters", Outcome::Serviced, 3),
    ("two-teams", Outcome::Serviced, 4),
    ("unreachable", Outcome::UnreachableTask, 1),
];

/// The mission of a shipped scenario.
fn mission(name: &str) -> &'static Mission {
    &shipped_mission(name).0
}

// ---- How missions end --------------------------------------------------------------------------

#[test]
fn no_shipped_scenario_is_forgotten() {
    assert_eq!(shipped_names(), SHIPPED.map(|(name, ..)| name));
}

#[test]
fn every_shipped_scenario_ends_as_it_should() {
    for (name, outcome, serviced) in SHIPPED {
        let mission = mission(name);
        assert_eq!(mission.end.outcome, outcome, "{name}: {}", mission.end.reason);
        assert_eq!(mission.serviced(), serviced, "{name}");
        let is_over = |task: usize| {
            let closings = [Event::TaskEnded { task }, Event::TaskWithdrawn { task }];
            mission.events().any(|(_, event)| closings.contains(event))
        };
        let is_held = |(_, event): &(usize, &Event)| match **event {
            Event::TaskServiced { task, .. } => !is_over(task),
            _ => false,
        };
        let held = mission.events().filter(is_held).count();
        assert_eq!(mission.last().serviced.len(), held, "{name}");
    }
}

#[test]
fn the_bounds_are_kept_in_every_shipped_scenario() {
    for (name, ..) in SHIPPED {
        let mission = mission(name);
        let settings = Settings::resolve(&mission.scenario);
        let value = |extreme: &Option<_>| {
            let extreme: &pleach::verify::network::Extreme = extreme.as_ref().unwrap();
            extreme.value
        };
        assert_eq!(settings.residual_tolerance, 0.0, "{name}: the default");
        assert!(
            value(&mission.extremes.pair_distance) >= 2.0 * settings.clearance - SLACK,
            "{name}"
        );
        assert!(value(&mission.extremes.clearance) >= settings.clearance - SLACK, "{name}");
        assert!(value(&mission.extremes.residual) >= -SLACK, "{name}");
        assert!(value(&mission.extremes.load) <= 1.0 + SLACK, "{name}");
    }
}

#[test]
fn no_robot_moves_any_more_when_a_mission_ends() {
    for (name, ..) in SHIPPED {
        assert!(mission(name).last().active.is_empty(), "{name}");
    }
}

// ---- Their stories -----------------------------------------------------------------------------

#[test]
fn study_one_tells_its_story() {
    insta::assert_snapshot!("study-1", mission("study-1").story());
}

#[test]
fn study_two_tells_its_story() {
    insta::assert_snapshot!("study-2", mission("study-2").story());
}

/// What the election of a leader led to.
struct Leadership<'a> {
    leader: usize,
    conflict: bool,
    /// The role of the leader just before it was elected.
    origin: Role,
    /// What happened from the election to the service of the task.
    events: Vec<&'a Event>,
}

fn leadership(mission: &Mission, task: usize) -> Leadership<'_> {
    let events: Vec<_> = mission.events().collect();
    let elected = |(k, event): &(usize, &Event)| match event {
        &&Event::LeaderElected { task: of, robot, conflict } if of == task => {
            Some((*k, robot, conflict))
        }
        _ => None,
    };
    let at = events.iter().position(|entry| elected(entry).is_some()).unwrap();
    let (k, leader, conflict) = elected(&events[at]).unwrap();
    let serviced =
        |event: &Event| matches!(event, Event::TaskServiced { task: of, .. } if *of == task);
    let rest = events[at..].iter().map(|(_, event)| *event);
    Leadership {
        leader,
        conflict,
        origin: mission.periods[k - 1].snapshot.roles[leader],
        events: rest.take_while(|event| !serviced(event)).collect(),
    }
}

impl Leadership<'_> {
    /// The subgroups that arrived before the leader was released.
    fn subgroups_that_release(&self) -> Vec<usize> {
        let released = |event: &&&Event| **event != &Event::Released { robot: self.leader };
        assert!(self.events.contains(&&Event::Released { robot: self.leader }));
        (self.events.iter().take_while(released))
            .filter_map(|event| match event {
                Event::SubgroupArrived { subgroup, .. } => Some(*subgroup),
                _ => None,
            })
            .collect()
    }
}

/// A robot outside of the active team settles at its post, and links of the tree may carry nothing.
#[test]
fn study_one_differs_from_the_paper_as_the_page_on_the_model_says() {
    let periods = &mission("study-1").periods;
    let (mut moves, mut settling, mut links, mut idle) = (0, 0, 0, 0);
    for pair in periods.windows(2) {
        let [before, after] = [&pair[0].snapshot, &pair[1].snapshot];
        let moved = |&robot: &usize| before.positions[robot] != after.positions[robot];
        let is_of_team =
            |robot: usize| [before, after].iter().any(|it| it.active_team.contains(&robot));
        for robot in (0..after.positions.len()).filter(moved) {
            moves += 1;
            settling += usize::from(!is_of_team(robot));
        }
    }
    for snapshot in periods.iter().map(|period| &period.snapshot) {
        let carries = |&&(robot, parent): &&(usize, usize)| {
            snapshot.routes.iter().any(|route| (route.from, route.to) == (robot, parent))
        };
        links += snapshot.tree.len();
        idle += snapshot.tree.len() - snapshot.tree.iter().filter(carries).count();
    }
    let page = crate::generated::read("docs/model.md");
    let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
    for count in [
        format!("{settling} of {},{:03} moves", moves / 1000, moves % 1000),
        format!("{idle} of {},{:03} links", links / 1000, links % 1000),
    ] {
        assert!(page.contains(&count), "docs/model.md should say: {count}");
    }
}

/// The third task of these two is led by the leaf of the second, which a team of subgroups
/// relieves one after another.
#[test]
fn a_leaf_is_elected_leader_and_several_subgroups_relieve_it() {
    for (name, subgroups) in [("leaf-leader", 2), ("study-1b", 3)] {
        let third = leadership(mission(name), 2);
        assert!(third.conflict, "{name}: a leaf has duties");
        assert_eq!(third.origin, Role::Leaf, "{name}");
        let relief = third.subgroups_that_release();
        assert_eq!(relief, (0..subgroups).collect::<Vec<_>>(), "{name}");
    }
}

#[test]
fn a_node_in_a_branch_is_elected_leader() {
    let second = leadership(mission("study-1b"), 1);
    assert!(second.conflict);
    assert!(matches!(second.origin, Role::Node | Role::Junction));
    assert_eq!(second.subgroups_that_release(), [0, 1]);
}

/// A robot that relieves a leaf services its task from then on, and never leaves it.
#[test]
fn the_task_of_a_leaf_that_leads_passes_to_its_replacement() {
    for name in ["leaf-leader", "study-1b", "study-1"] {
        let mission = mission(name);
        let leader = leadership(mission, 2).leader;
        let answerable = |snapshot: &Snapshot| {
            snapshot.serviced.iter().find(|(task, _)| *task == 1).map(|&(_, robot)| robot)
        };
        let holders: Vec<_> =
            mission.periods.iter().filter_map(|period| answerable(&period.snapshot)).collect();
        assert_eq!(holders[0], leader, "{name}");
        assert_ne!(*holders.last().unwrap(), leader, "{name}");
    }
}

/// Remark 5.6: robot 1 carries the traffic of a branch and loses it to the second access point.
#[test]
fn a_redundant_robot_becomes_a_node_and_is_redundant_again() {
    let mission = mission("redundant-node");
    let mut roles: Vec<_> = mission.periods.iter().map(|period| period.snapshot.roles[1]).collect();
    roles.dedup();
    assert_eq!(roles, [Role::Redundant, Role::Node, Role::Redundant]);

    let hangs_on_second_access_point =
        mission.last().tree.iter().any(|&(_, parent)| parent == mission.scenario.robot.len() + 1);
    assert!(hangs_on_second_access_point);
}

/// The lanes beside the holes are 3.5ρ wide, so that no robot passes another in the corridor.
#[test]
fn robots_go_through_the_corridor_in_single_file() {
    let mission = mission("corridor");
    let is_inside = |snapshot: &Snapshot, robot: usize| {
        let mouths = 0.9..2.2;
        mouths.contains(&snapshot.positions[robot].x)
    };
    let mut longest = 0;
    let mut closest = f64::INFINITY;
    for pair in mission.periods.windows(2) {
        let [before, after] = [&pair[0].snapshot, &pair[1].snapshot];
        let mut file: Vec<_> = (0..before.positions.len())
            .filter(|&robot| is_inside(before, robot) && is_inside(after, robot))
            .collect();
        file.sort_by(|&a, &b| before.positions[a].x.total_cmp(&before.positions[b].x));
        assert!(file.is_sorted_by_key(|&robot| after.positions[robot].x), "k = {}", after.step);
        longest = longest.max(file.len());
        for pair in file.windows(2) {
            let gap = (after.positions[pair[0]] - after.positions[pair[1]]).norm();
            closest = closest.min(gap);
        }
    }
    assert!(longest >= 3, "a file of {longest} robots");
    let touch = 2.1 * Settings::resolve(&mission.scenario).clearance;
    assert!(closest < touch, "the robots queue, no nearer than {closest}");
    let exchanges = |event: &&Event| matches!(event, Event::DutiesExchanged { .. });
    assert!(mission.events().any(|(_, event)| exchanges(&event)), "duties are handed on");
}

/// Two geodesics are equally long; the first branch keeps to one side of the ring.
#[test]
fn the_first_branch_goes_round_the_ring_one_way() {
    let mission = mission("ring");
    let leader = leadership(mission, 0).leader;
    let beyond_the_sides =
        |snapshot: &&Snapshot| (0.5..1.1).contains(&snapshot.positions[leader].y);
    let east: BTreeSet<_> = (mission.periods.iter().map(|period| &period.snapshot))
        .filter(beyond_the_sides)
        .map(|snapshot| snapshot.positions[leader].x > 1.0)
        .collect();
    assert_eq!(east.len(), 1);
}

/// Remark 4.3: discs of radius 0.35 m, and they meet in aisles where one must give way.
#[test]
fn discs_meet_and_never_touch() {
    let mission = mission("discs");
    let exchanges = mission.events().filter(|(_, e)| matches!(e, Event::DutiesExchanged { .. }));
    assert!(exchanges.count() > 0);
    assert!(mission.extremes.pair_distance.as_ref().unwrap().value >= 2.0 * 0.35);
    assert!(mission.extremes.clearance.as_ref().unwrap().value >= 0.35);
}

#[test]
fn both_access_points_serve_where_there_are_two() {
    for name in ["study-2", "two-clusters", "redundant-node"] {
        let mission = mission(name);
        let robots = mission.scenario.robot.len();
        let parents: BTreeSet<_> = mission.last().tree.iter().map(|&(_, parent)| parent).collect();
        assert!(parents.contains(&robots) && parents.contains(&(robots + 1)), "{name}");
    }
}

#[test]
fn each_cluster_leads_to_the_task_near_it() {
    let leads = |task| leadership(mission("two-clusters"), task).leader;
    assert!((0..7).contains(&leads(0)));
    assert!((7..14).contains(&leads(1)));
}

#[test]
fn an_end_without_service_says_why() {
    let end = &mission("too-few").end;
    assert!(end.reason.contains("no robot could service tasks 1 and 2"), "{}", end.reason);
    assert_eq!((end.task, &end.tasks[..]), (None, &[1, 2][..]));
    let end = &mission("unreachable").end;
    assert!(end.reason.contains("within the service radius of task 1"), "{}", end.reason);
    assert_eq!((end.task, &end.tasks[..]), (Some(1), &[1][..]));
}

// ---- What an oracle finds in spoiled traces ---------------------------------------------------

/// Each of these spoils one thing in a mission that is flawless otherwise.
#[test]
fn the_oracle_notices_what_is_wrong() {
    type Spoil = fn(&mut Snapshot);
    let spoils: [(Spoil, &str); 10] = [
        (|now| now.positions[0].x += 0.02, "robot 0 steps 0.0"),
        (|now| now.positions[0].x += 0.001, "robot 0 steps 0.001"),
        (|now| now.routes[0].reliability -= 0.01, "route "),
        (|now| now.routes[0].share += 0.01, "residual"),
        (|now| now.residuals[5] += 0.001, "robot 5: residual"),
        (|now| now.routes.retain(|route| route.from != 7), "residual"),
        (|now| now.tree.push((0, 1)), "robot 0 has two parents"),
        (|now| now.tree.retain(|&(child, _)| child != 9), "is attached to 9, which has no parent"),
        (|now| now.tree = vec![(0, 1), (1, 2), (2, 0)], "the tree has a cycle"),
        (|now| now.serviced.clear(), "task 0 is left"),
    ];
    for (spoil, expected) in spoils {
        let mut mission = mission("study-1").up_to(350);
        spoil(&mut mission.periods[350].snapshot);
        assert_fault(&mission, expected);
    }
}

/// The same for the way from one instant to the next, when robots may leap.
#[test]
fn the_oracle_looks_between_two_instants() {
    type Spoil = fn(&mut Snapshot);
    let spoils: [(Spoil, &str); 5] = [
        (|now| now.positions.swap(0, 1), "robots 0 and 1 are 0 apart"),
        (|now| now.positions[0] = now.positions[1], "robots 0 and 1 are 0 apart"),
        (|now| now.positions[0].x = 0.005, "robot 0 comes within 0.005"),
        (|now| now.positions[0] = Point::new(0.8, 1.4), "robot 0 comes within 0 of"),
        (|now| now.positions[12].x += 0.25, "robot 12 has load"),
    ];
    for (spoil, expected) in spoils {
        let mut mission = mission("study-1").up_to(350);
        mission.scenario.control.step_radius = Some(10.0);
        let Period { snapshot: before, .. } = &mut mission.periods[349];
        before.active = (0..before.positions.len()).collect();
        spoil(&mut mission.periods[350].snapshot);
        assert_fault(&mission, expected);
    }
}

fn assert_fault(mission: &Mission, expected: &str) {
    let text = mission.trace();
    let fault = audit(TraceReader::new(text.as_slice()).unwrap()).unwrap_err();
    assert!(fault.starts_with("k = 350: ") && fault.contains(expected), "{expected}: {fault}");
}
