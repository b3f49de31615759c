//! Missions without faults: what robots decide, how long it takes them, and how they end.

use pleach_automaton::network::record::Outcome;
use pleach_automaton::network::scenario::Strategy;

use super::story::story;
use super::{Mission, run, scenario};

/// The mission of a scenario, whose robots decide as they did before.
#[track_caller]
fn decided(path: &str) -> Mission {
    let mission = run(scenario(path));
    let name = path.rsplit('/').next().unwrap_or(path);
    insta::assert_snapshot!(name, story(&mission.events));
    mission
}

#[test]
fn robots_become_nodes_when_packets_flow_through_them_and_redundant_when_none_do() {
    decided("scenarios/redundant-node").services_all_within(138);
}

#[test]
fn a_replacement_for_a_leaf_comes_in_two_subgroups() {
    decided("scenarios/leaf-leader").services_all_within(354);
}

#[test]
fn a_recruit_comes_from_the_tree_of_another_access_point() {
    decided("scenarios/two-clusters").services_all_within(369);
}

#[test]
fn parent_and_child_hand_over_with_two_rounds_of_messages_in_a_period() {
    decided("tests/scenarios/found/two-rounds-a-period").services_all_within(80);
}

#[test]
fn a_post_that_the_team_does_not_need_is_given_up() {
    decided("tests/scenarios/found/post-that-the-team-does-not-need").services_all_within(139);
}

#[test]
fn a_recruit_goes_round_a_hole_on_the_side_of_its_link() {
    decided("tests/scenarios/found/recruit-round-a-hole").services_all_within(144);
}

#[test]
fn two_members_of_the_team_at_one_post_are_one_branch() {
    decided("tests/scenarios/found/two-of-the-team-at-one-post").services_all_within(156);
}

#[test]
fn two_robots_of_a_subgroup_pass_an_access_point() {
    decided("tests/scenarios/found/two-robots-across-an-access-point").services_all_within(247);
}

#[test]
fn a_robot_goes_between_two_parked_ones() {
    decided("tests/scenarios/found/between-two-parked-robots").services_all_within(165);
}

#[test]
fn robots_exchange_duties_on_their_path() {
    decided("tests/scenarios/found/exchange-of-duties-on-the-path").services_all_within(207);
}

#[test]
fn the_next_task_is_announced_while_robots_are_still_on_their_path() {
    decided("tests/scenarios/found/next-task-at-once").services_all_within(190);
}

#[test]
fn robots_whose_parent_joins_the_team_find_another() {
    decided("tests/scenarios/found/orphans-of-a-team").services_all_within(500);
}

#[test]
fn the_cone_program_moves_robots_too() {
    decided("tests/scenarios/found/cone-program").services_all_within(239);
}

#[test]
fn an_exchange_of_duties_ends_as_the_task_is_serviced() {
    decided("tests/scenarios/found/exchange-as-the-task-is-serviced").services_all_within(240);
}

#[test]
fn robots_exchange_duties_at_the_mouth_of_a_corridor() {
    decided("tests/scenarios/found/exchange-at-the-mouth-of-a-corridor").services_all_within(553);
}

#[test]
fn news_of_a_parent_comes_late() {
    decided("tests/scenarios/found/late-news-of-a-parent").services_all_within(352);
}

#[test]
fn a_replacer_comes_round_a_corner() {
    decided("tests/scenarios/found/service-round-a-corner").services_all_within(311);
}

#[test]
fn robots_step_aside_one_after_the_other() {
    decided("tests/scenarios/found/stepping-aside-in-a-row").services_all_within(520);
}

/// Rates are near what links carry, steps are long, and links of the tree may be weak: robots object to
/// moves. In the paper's order loads come to more than nine tenths, with recruits called for ahead to a little less.
#[test]
fn robots_object_to_moves_that_would_overload_them() {
    let mut stressed = scenario("scenarios/leaf-leader");
    stressed.control.strategy = Some(Strategy::Paper);
    stressed.robot.iter_mut().for_each(|robot| robot.rate = 0.0767);
    stressed.control.build_reliability = Some(0.5);
    stressed.control.tree_reliability = Some(0.5);
    stressed.control.slope_aversion = Some(0.0);
    stressed.control.step_radius = Some(0.12);
    let mission = run(stressed);
    mission.services_all_within(700);
    let load = mission.extremes.load.as_ref().map(|extreme| extreme.value);
    assert!(
        load.is_some_and(|load| load > 0.9),
        "no robot sends for nine tenths of its time: {load:?}"
    );
}

/// One robot walks round two walls to a task that its link to the access point reaches all along.
#[test]
fn a_link_may_lead_through_walls_that_a_robot_can_walk_around() {
    decided("tests/scenarios/found/baffles").services_all_within(171);
}

#[test]
fn a_leader_near_enough_services_its_task_where_no_robot_can_come() {
    decided("tests/scenarios/found/within-delta").services_all_within(99);
}

#[test]
fn a_leader_leaves_a_post_that_nothing_depends_on() {
    decided("tests/scenarios/found/unused-post-of-the-leader").services_all_within(85);
}

#[test]
fn two_robots_do_not_exchange_their_duties_to_and_fro() {
    decided("tests/scenarios/found/duties-to-and-fro").services_all_within(134);
}

#[test]
fn robots_that_are_too_few_stretch_their_links_and_say_so() {
    let end = decided("scenarios/too-few").end;
    assert_eq!(end.outcome, Outcome::InsufficientRobots, "{}", end.reason);
    let end = decided("tests/scenarios/room").end;
    assert_eq!(end.outcome, Outcome::InsufficientRobots, "{}", end.reason);
}

#[test]
fn a_task_that_no_robot_can_come_near_is_named() {
    let end = decided("scenarios/unreachable").end;
    assert_eq!(
        (end.outcome, &end.tasks[..]),
        (Outcome::UnreachableTask, &[1][..]),
        "{}",
        end.reason
    );
}

#[test]
fn robots_whose_links_carry_no_more_say_so() {
    let end = decided("tests/scenarios/saturated").end;
    assert_eq!(end.outcome, Outcome::Blocked, "{}", end.reason);
}
