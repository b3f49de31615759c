//! For each property a violation planted in a sound mission, and a sound neighbour of it.

use nalgebra::point;
use pleach_automaton::network::record::{MissionEvent, Snapshot};
use pleach_automaton::network::scenario::LinkCount;
use pleach_discrete::network::{Phase, Role};

use super::sample::{role_table, route, scenario, snapshot, stated, valid};
use super::{Extremes, Instant, Monitor, Property, TreeLinks, Violation, audit};

fn monitor() -> Monitor<'static> {
    Monitor::new(&scenario(), role_table)
}

/// Audits three snapshots, after the last two were changed.
fn run(change: impl Fn(&mut Snapshot, &mut Snapshot)) -> Result<Extremes, Violation> {
    let [opening, mut before, mut after] = [0, 1, 2].map(snapshot);
    change(&mut before, &mut after);
    audit(monitor(), [&opening, &before, &after])
}

/// Expects a change of the last two snapshots to break a property.
#[track_caller]
fn breaks(property: Property, change: impl Fn(&mut Snapshot, &mut Snapshot)) -> Violation {
    let violation = run(change).expect_err("the planted violation is caught");
    assert_eq!(violation.property, property, "{violation}");
    violation
}

/// Expects a change of the last two snapshots to break nothing.
#[track_caller]
fn keeps(change: impl Fn(&mut Snapshot, &mut Snapshot)) -> Extremes {
    run(change).unwrap_or_else(|violation| panic!("{violation}"))
}

/// Recomputes reliabilities and residuals where positions were changed.
fn reroute(snapshot: &mut Snapshot) {
    let shares: Vec<_> = snapshot.routes.iter().map(|r| (r.from, r.to, r.share)).collect();
    route(snapshot, &shares);
}

#[test]
fn a_sound_mission_passes_and_its_extremes_are_told() {
    let extremes = keeps(|_, _| {});
    let pair = extremes.pair_distance.unwrap();
    // Robots 0 and 3 are nearest at the end: (0.3, 0) and (0.2, −0.18).
    assert_eq!((pair.robots, pair.instant.time), (vec![0, 3], 2.0));
    assert!((pair.value - f64::hypot(0.1, 0.18)).abs() < 1e-12);
    let clearance = extremes.clearance.unwrap();
    assert_eq!((clearance.value, clearance.robots, clearance.instant.step), (0.8, vec![2], 0));
    let residual = extremes.residual.unwrap();
    assert!((residual.value - 0.025).abs() < 1e-12);
    let load = extremes.load.unwrap();
    assert_eq!((load.value, load.robots), (0.3, vec![0]));
    let busier = keeps(|before, _| before.routes[0].share = 0.3 + 1e-7);
    assert_eq!(busier.load.unwrap().value, 0.3 + 1e-7);
}

/// A pillar stands between robots 0 and 1, and robot 1 leaves its shadow in the end.
#[test]
fn links_of_the_tree_that_cross_walls_are_counted() {
    let mut stated = stated();
    stated.workspace.holes = vec![vec![[0.43, -0.03], [0.47, -0.03], [0.47, 0.03], [0.43, 0.03]]];
    let scenario = valid(stated);
    let [opening, before, mut after] = [0, 1, 2].map(snapshot);
    let mut links = TreeLinks::default();
    assert!(!links.are_worth_a_warning());
    links.observe(&opening, scenario.site());
    assert_eq!(links.last(), LinkCount { links: 4, through_walls: 1 });
    links.observe(&before, scenario.site());
    after.positions[1] = point![0.5, 0.3];
    after.tree.pop();
    links.observe(&after, scenario.site());
    assert_eq!(links.last(), LinkCount { links: 3, through_walls: 0 });
    let most = LinkCount { links: 4, through_walls: 1 };
    assert_eq!(links.most(), Some((most, Instant { step: 0, time: 0.0 })));
    assert!(links.are_worth_a_warning());
}

#[test]
fn a_snapshot_that_is_not_well_formed() {
    breaks(Property::Record, |_, after| after.positions[2].x = f64::NAN);
    breaks(Property::Record, |_, after| after.step = 3);
    breaks(Property::Record, |_, after| after.time = 1.0);
    breaks(Property::Record, |_, after| after.roles.truncate(3));
    breaks(Property::Record, |_, after| after.active.push(4));
    breaks(Property::Record, |_, after| after.active = vec![3, 1]);
    breaks(Property::Record, |_, after| after.routes[0].to = 5);
    breaks(Property::Record, |_, after| after.tree[0] = (0, 0));
    breaks(Property::Record, |_, after| after.serviced.push((2, 0)));
    breaks(Property::Record, |_, after| after.posts[0].reference.y = f64::INFINITY);
    breaks(Property::Record, |_, after| after.posts[0].holder = 4);
    breaks(Property::Record, |_, after| after.path = vec![2, 0, 2]);
    keeps(|_, after| after.time = 1.5);
}

/// Robots 1 and 3 cross in the middle of the last period, `gap` apart.
fn cross(gap: f64) -> impl Fn(&mut Snapshot, &mut Snapshot) {
    move |before, after| {
        before.positions[3] = point![0.625 - gap, 0.0];
        before.positions[1] = point![0.625, 0.01];
        after.positions[3] = point![0.625 - gap, 0.01];
        after.positions[1] = point![0.625, 0.0];
    }
}

#[test]
fn robots_that_come_too_near_between_the_snapshots() {
    // The journey of robot 3 to the crossing breaks other bounds: only the period is asked.
    let limits = super::Limits::of(&scenario());
    let separation = |gap: f64| {
        let (mut before, mut after) = (snapshot(1), snapshot(2));
        cross(gap)(&mut before, &mut after);
        let period = super::period::Period::between(&before, &after).unwrap();
        super::period::separation(&period, &limits)
    };
    let violation = separation(0.0199).unwrap_err();
    assert_eq!((violation.property, &violation.robots[..]), (Property::Separation, &[1, 3][..]));
    assert_eq!((violation.step, violation.time), (1, 1.5));
    assert!((violation.measured - 0.0199).abs() < 1e-12);
    assert!((separation(0.0201).unwrap().unwrap().value - 0.0201).abs() < 1e-12);
}

#[test]
fn robots_that_start_too_near() {
    let mut opening = snapshot(0);
    opening.positions[2] = point![0.31, 0.0];
    let violation = monitor().observe(&opening).unwrap_err();
    assert_eq!((violation.property, violation.step), (Property::Separation, 0));
}

#[test]
fn a_robot_that_brushes_a_corner_between_the_snapshots() {
    // The tip of a spike from below stands under the middle of robot 1's first motion.
    let brush = |tip: f64| {
        let mut scenario = stated();
        let spike = [[0.595, -1.0], [0.605, tip], [0.615, -1.0]];
        scenario.workspace.boundary.splice(1..1, spike);
        audit(Monitor::new(&valid(scenario.clone()), role_table), &[0, 1].map(snapshot))
    };
    let violation = brush(-0.0099).unwrap_err();
    assert_eq!((violation.property, violation.robots), (Property::Clearance, vec![1]));
    assert!((violation.measured - 0.0099).abs() < 1e-12);
    let smallest = brush(-0.0101).unwrap().clearance.unwrap();
    assert!((smallest.value - 0.0101).abs() < 1e-12);
}

#[test]
fn a_step_beyond_the_trust_region() {
    breaks(Property::StepLength, |_, after| after.positions[1].x += 1e-5);
    keeps(|_, after| {
        after.positions[1].x += 1e-7;
        reroute(after);
    });
}

#[test]
fn a_robot_that_moves_without_being_active() {
    let nudge = |after: &mut Snapshot| {
        after.positions[2].x += 1e-15;
        reroute(after);
    };
    breaks(Property::Standstill, |_, after| nudge(after));
    keeps(|before, after| {
        before.active.insert(1, 2);
        nudge(after);
    });
}

#[test]
fn a_reliability_that_the_distance_does_not_give() {
    breaks(Property::Reliability, |_, after| after.routes[0].reliability = 0.9);
    keeps(|_, after| after.routes[0].reliability = 1.0 - 1e-9);
}

#[test]
fn shares_that_no_time_suffices_for() {
    breaks(Property::Shares, |_, after| after.routes[0].share = -0.1);
    breaks(Property::Shares, |_, after| {
        route(after, &[(0, 4, 0.6), (0, 2, 0.5), (1, 0, 0.15), (2, 4, 0.6), (3, 4, 0.1)]);
    });
    keeps(|_, after| {
        route(after, &[(0, 4, 0.5), (0, 2, 0.5), (1, 0, 0.15), (2, 4, 0.6), (3, 4, 0.1)]);
    });
}

#[test]
fn a_residual_that_the_routes_do_not_give() {
    breaks(Property::Accounting, |_, after| after.residuals[2] += 1e-5);
    keeps(|_, after| after.residuals[2] += 1e-7);
}

#[test]
fn a_robot_that_sends_less_than_it_must() {
    let send = |share: f64| {
        move |_: &mut Snapshot, after: &mut Snapshot| {
            route(after, &[(0, 4, 0.3), (1, 0, 0.15), (2, 4, share), (3, 4, 0.1)]);
        }
    };
    let violation = breaks(Property::Residual, send(0.0749));
    assert_eq!(violation.robots, [2]);
    assert!((violation.measured + 1e-4).abs() < 1e-12);
    keeps(send(0.075));
    let mut unasked = Snapshot { task: None, serviced: Vec::new(), ..snapshot(1) };
    send(0.0749)(&mut snapshot(0), &mut unasked);
    let limits = super::Limits::of(&scenario());
    assert!(super::instant::residual(&unasked, &limits).is_ok_and(|smallest| smallest.is_none()));
}

/// Robot 1 sends straight to the access point with this share, at a distance from it.
fn send_far(share: f64, distance: f64) -> impl Fn(&mut Snapshot, &mut Snapshot) {
    move |before, after| {
        for (snapshot, x) in [(before, distance), (after, distance + 0.01)] {
            snapshot.positions[1] = point![x, 0.0];
            route(snapshot, &[(0, 4, 0.3), (1, 4, share), (2, 4, 0.1), (3, 4, 0.1)]);
        }
    }
}

#[test]
fn a_flow_that_cannot_be_held_during_a_motion() {
    let limits = super::Limits::of(&scenario());
    let load = |share: f64, distance: f64| {
        let (mut before, mut after) = (snapshot(1), snapshot(2));
        send_far(share, distance)(&mut before, &mut after);
        let period = super::period::Period::between(&before, &after).unwrap();
        super::period::load(&period, &limits)
    };
    // R falls from 0.5 at 0.45 to 0.352 at 0.46.
    let violation = load(0.71, 0.45).unwrap_err();
    assert_eq!((violation.property, violation.time), (Property::Load, 2.0));
    assert!((violation.measured - 0.71 * 0.5 / 0.352).abs() < 1e-9);
    assert!((load(0.70, 0.45).unwrap().unwrap().value - 0.7 * 0.5 / 0.352).abs() < 1e-9);
    assert_eq!(load(0.1, 0.492).unwrap_err().measured, f64::INFINITY);
    assert!(load(0.0, 0.492).is_ok());
}

/// A way with more links than a control period has rounds is not known at once.
#[test]
fn a_robot_that_knows_no_way_before_the_first_task_is_announced() {
    let limits = super::Limits::of(&scenario());
    let is_connected = |task: Option<usize>, is_in_tree: bool| {
        let mut before = Snapshot { task, serviced: Vec::new(), ..snapshot(1) };
        before.routes.retain(|route| route.from != 2);
        before.tree.retain(|&(robot, _)| is_in_tree || robot != 2);
        super::instant::connectivity(&before, &limits).is_ok()
    };
    assert!(is_connected(None, false));
    assert!(!is_connected(None, true), "its parent tells it a way");
    assert!(!is_connected(Some(1), false));
}

#[test]
fn a_robot_whose_information_goes_in_a_circle() {
    // Robots 2 and 3 serve each other; what they receive they send, as the residuals show.
    let circle = |tie: f64| {
        move |_: &mut Snapshot, after: &mut Snapshot| {
            after.residuals.clear();
            route(after, &[(0, 4, 0.3), (1, 0, 0.15), (2, 3, 0.3), (3, 2, 0.2), (3, 4, tie)]);
        }
    };
    let violation = run(circle(0.0)).unwrap_err();
    // Flows in a circle leave a residual below zero: both properties tell of it.
    assert_eq!(violation.property, Property::Residual);
    let mut circling = snapshot(2);
    circle(0.0)(&mut snapshot(1), &mut circling);
    let limits = super::Limits::of(&scenario());
    let violation = super::instant::connectivity(&circling, &limits).unwrap_err();
    assert_eq!((violation.property, violation.robots), (Property::Connectivity, vec![2]));
    let mut tolerant = stated();
    tolerant.control.residual_tolerance = Some(0.2);
    let mut monitor = Monitor::new(&valid(tolerant), role_table);
    let violation = monitor.observe(&circling).unwrap_err();
    assert_eq!(violation.property, Property::Connectivity);
    keeps(circle(0.2));
}

#[test]
fn a_tree_that_is_none() {
    breaks(Property::SingleParent, |_, after| after.tree.push((3, 0)));
    breaks(Property::RootedTree, |_, after| after.tree = vec![(0, 1), (1, 0), (3, 4)]);
    breaks(Property::RootedTree, |_, after| after.tree = vec![(0, 4), (1, 0), (2, 3)]);
    breaks(Property::TreeMembership, |_, after| after.tree.retain(|edge| edge.0 != 3));
    keeps(|_, after| after.tree.retain(|edge| edge.0 != 2));
}

#[test]
fn a_tree_edge_out_of_range() {
    // Robot 1 is 0.61 away from the access point.
    let violation = breaks(Property::TreeRange, |before, _| before.tree[1] = (1, 4));
    assert_eq!(violation.robots, [1, 4]);
    breaks(Property::TreeRange, |_, after| after.tree[1] = (1, 4));
    // An edge that leaves the range during the period is missed by neither snapshot's tree.
    let limits = super::Limits::of(&scenario());
    let range = |end: f64| {
        let (mut before, mut after) = (snapshot(1), snapshot(2));
        before.tree[1] = (1, 4);
        before.positions[1].x = 0.495;
        after.positions[1].x = end;
        let period = super::period::Period::between(&before, &after).unwrap();
        super::period::tree_range(&period, &limits)
    };
    assert_eq!(range(0.5).unwrap_err().property, Property::TreeRange);
    assert_eq!(range(0.4999), Ok(()));
    // Robot 2 at (0.1, 0.2) is 0.45 away from robot 3 in the beginning and nears it.
    keeps(|_, after| after.tree[2] = (2, 3));
}

#[test]
fn teams_with_two_leaders_or_one_in_the_wrong_place() {
    breaks(Property::SingleLeader, |_, after| after.roles[3] = Role::Leader);
    breaks(Property::LeaderLast, |_, after| {
        after.primary_team = vec![1, 3];
        after.active_team = vec![1, 3];
    });
    breaks(Property::LeaderLast, |_, after| {
        after.roles[1] = Role::Leaf;
    });
    keeps(|_, after| {
        after.roles[1] = Role::Leaf;
        after.active_team.clear();
    });
    keeps(|_, after| {
        after.primary_team = vec![3, 1];
        after.active_team = vec![3, 1];
    });
}

#[test]
fn an_active_team_that_is_not_one_team() {
    let shift = |active_team: &[usize], active: &[usize]| {
        let (active_team, active) = (active_team.to_vec(), active.to_vec());
        move |_: &mut Snapshot, after: &mut Snapshot| {
            after.phase = Phase::Shift;
            after.path = vec![2, 0, 3, 1];
            after.active_team = active_team.clone();
            after.active = active.clone();
        }
    };
    keeps(shift(&[2, 0], &[0, 2]));
    keeps(shift(&[], &[3]));
    breaks(Property::ActiveTeam, shift(&[2, 3], &[2, 3]));
    breaks(Property::ActiveTeam, shift(&[3, 1], &[1, 3]));
    breaks(Property::ActiveTeam, shift(&[2, 0], &[2]));
}

#[test]
fn a_path_that_meets_the_primary_team_too_early() {
    breaks(Property::DisjointTeams, |_, after| after.path = vec![2, 1, 0]);
    keeps(|_, after| after.path = vec![2, 0, 1]);
}

#[test]
fn break_points_that_do_not_divide_the_path() {
    let elected = |break_points: &[usize]| {
        monitor().observe_event(&MissionEvent::RecruitElected {
            robot: 2,
            path: vec![2, 0, 3, 1],
            break_points: break_points.to_vec(),
        })
    };
    assert_eq!(elected(&[2, 0, 3]), Ok(()));
    assert_eq!(elected(&[2, 3, 0]).unwrap_err().property, Property::Subgroups);
    assert_eq!(elected(&[2, 0]).unwrap_err().property, Property::Subgroups);
}

#[test]
fn a_role_that_changes_outside_the_table() {
    breaks(Property::RoleTransition, |_, after| after.roles[0] = Role::Node);
    keeps(|_, after| after.roles[2] = Role::Recruit);
    let changed =
        |from, to| monitor().observe_event(&MissionEvent::RoleChanged { robot: 0, from, to });
    let violation = changed(Role::Leaf, Role::Node).unwrap_err();
    assert_eq!((violation.property, violation.robots), (Property::RoleTransition, vec![0]));
    assert_eq!(changed(Role::Leaf, Role::Leader), Ok(()));
}

#[test]
fn a_task_that_is_forgotten_or_serviced_twice() {
    breaks(Property::Duties, |_, after| after.serviced.clear());
    breaks(Property::Duties, |_, after| after.serviced.push((0, 3)));
    breaks(Property::Duties, |_, after| after.serviced.extend([(1, 1), (1, 3)]));
    // A task that is serviced from the last snapshot on was not serviced before.
    let mut snapshots = [0, 1, 2].map(snapshot);
    snapshots[..2].iter_mut().for_each(|snapshot| snapshot.serviced.clear());
    audit(monitor(), &snapshots).unwrap();
}

/// Moves robot 0 to this height during the last period; its post follows.
fn lift(height: f64) -> impl Fn(&mut Snapshot, &mut Snapshot) {
    move |before, after| {
        before.active.insert(0, 0);
        after.positions[0].y = height;
        for snapshot in [before, after] {
            snapshot.posts[0].reference.y = height / 2.0;
            reroute(snapshot);
        }
    }
}

#[test]
fn a_robot_that_leaves_its_task() {
    let mut scenario = stated();
    scenario.control.step_radius = Some(0.06);
    scenario.control.service_radius = Some(0.03);
    let audit_lifted = |height: f64| {
        let (opening, mut before, mut after) = (snapshot(0), snapshot(1), snapshot(2));
        lift(height)(&mut before, &mut after);
        let monitor = Monitor::new(&valid(scenario.clone()), role_table);
        audit(monitor, [&opening, &before, &after])
    };
    breaks(Property::Service, |_, after| after.serviced = vec![(0, 2)]);
    // The task is at height 0.02.
    let violation = audit_lifted(0.0501).unwrap_err();
    assert_eq!((violation.property, violation.robots), (Property::Service, vec![0]));
    assert!((violation.time - (1.0 + 0.05 / 0.0501)).abs() < 1e-4, "{}", violation.time);
    audit_lifted(0.05).unwrap();
}

#[test]
fn a_task_stays_serviced_while_another_robot_takes_over() {
    let mut scenario = stated();
    scenario.control.step_radius = Some(0.06);
    let limits = super::Limits::of(&valid(scenario));
    // Robot 0 leaves downwards; robot 3 arrives from above, at this height.
    let relieved = |height: f64| {
        let (mut before, mut after) = (snapshot(1), snapshot(2));
        after.positions[0].y = -0.02;
        before.positions[3] = point![0.3, height];
        after.positions[3] = point![0.3, height - 0.06];
        let period = super::period::Period::between(&before, &after).unwrap();
        super::period::service(&period, &limits)
    };
    // Robot 0 is near until half of the period; robot 3 from (height − 0.05) / 0.06 on.
    assert_eq!(relieved(0.0799), Ok(()));
    let violation = relieved(0.0802).unwrap_err();
    assert_eq!(violation.property, Property::Service);
    assert!((violation.time - 1.5).abs() < 1e-3);
    assert!(violation.measured > violation.bound);
}

#[test]
fn a_junction_or_task_whose_holder_leaves() {
    breaks(Property::Occupancy, |before, _| before.posts[0].reference.y = 0.031);
    keeps(|before, _| before.posts[0].reference.y = 0.029);
    // The same for a takeover: the new holder must have arrived.
    breaks(Property::Occupancy, |_, after| after.posts[0].holder = 3);
    // The robot that held a junction when the period began stays until its end, handed over or not.
    breaks(Property::Occupancy, |before, _| {
        before.posts[1].junction = true;
        before.posts[1].reference = point![0.2, -0.22];
    });
    // The post of a mere node may be approached.
    keeps(|_, after| after.posts[1].reference.y = 0.5);
    breaks(Property::Occupancy, |_, after| after.posts[1].junction = true);
}

#[test]
fn a_violation_says_which_where_and_when() {
    let violation = breaks(Property::StepLength, |_, after| after.positions[1].x += 0.01);
    assert_eq!(
        violation.to_string(),
        "step length is violated in step 1 at t = 2.000 s: robot 1 travels 0.020000 in one \
         period, more than 0.010000"
    );
}

#[test]
fn every_property_has_its_own_name_and_one_sentence() {
    for (index, property) in Property::ALL.into_iter().enumerate() {
        assert_eq!(property as usize, index);
        let statement = property.statement();
        assert!(statement.ends_with('.') && !statement.contains('\n'), "{statement}");
        let namesakes = Property::ALL.iter().filter(|other| other.name() == property.name());
        assert_eq!(namesakes.count(), 1);
    }
}
