//! Ways of fixed posts that are made shorter, so that nodes on them become redundant.

use pleach_discrete::network::Activity;

use super::*;
use crate::located::Place as _;
use crate::network::duty::{Bound, Junction};
use crate::network::robot::duties::Label;
use crate::network::scenario::Strategy;

/// Robot 0 holds a fixed post that is attached to post 13, half a unit to the west.
fn holder(strategy: Strategy) -> Robot {
    let mut scenario = hall();
    scenario.control.strategy = Some(strategy);
    let mut robot = robot_of(&scenario);
    robot.holds(fixed(30, 13));
    robot
}

/// To what that wants to be attached that hears these.
fn choice(mut robot: Robot, heard: impl IntoIterator<Item = Beacon>) -> Option<Anchor> {
    heard.into_iter().for_each(|beacon| robot.hears(beacon));
    robot.trace_lineage().expect("its automaton goes on");
    robot.keep_place().expect("its automaton goes on");
    robot.tree.desired_parent().flatten()
}

const fn at(post: u32) -> Option<Anchor> {
    Some(Anchor::Post(PostId(post)))
}

/// Its parent, on a way over the posts 14 and 15.
fn parent() -> Beacon {
    beacon(1, west(0.5), fixed(13, 14), &[13, 14, 15])
}

/// The node before, so far away.
fn grandparent(away: f64) -> Beacon {
    beacon(2, west(away), fixed(14, 15), &[14, 15])
}

#[test]
fn a_fixed_post_is_attached_past_its_parent_where_a_link_of_d_build_reaches() {
    let build = robot().build_length();
    let heard = |away| [parent(), grandparent(away)];
    assert_eq!(choice(holder(Strategy::Eager), heard(build - LITTLE)), at(14));
    assert_eq!(choice(holder(Strategy::Eager), heard(build + LITTLE)), None);
    assert_eq!(choice(holder(Strategy::Paper), heard(build - LITTLE)), None);
}

/// Robots on their way to their posts are nearer to each other than they will be.
#[test]
fn a_link_is_as_long_as_it_may_get_when_both_are_at_their_posts() {
    let [build, hard] = [robot().build_length(), robot().hard_length()];
    let chosen = |own: f64, other: f64| {
        let mut robot = holder(Strategy::Eager);
        robot.duty.is(holding(fixed(30, 13), east(own)));
        let duty = Some(holding(fixed(14, 15), west(build - 0.1 + other)));
        choice(robot, [parent(), Beacon { duty, ..grandparent(build - 0.1) }])
    };
    let most = hard - build + 0.1;
    assert_eq!((chosen(0.0, 0.0), chosen(most - LITTLE, 0.0)), (at(14), at(14)));
    assert_eq!((chosen(0.0, most - LITTLE), chosen(0.1, most - 0.1 - LITTLE)), (at(14), at(14)));
    assert_eq!((chosen(most + LITTLE, 0.0), chosen(0.0, most + LITTLE)), (None, None));
    assert_eq!(chosen(0.1, most - 0.1 + LITTLE), None, "both are on their way");
}

#[test]
fn of_the_nodes_on_its_way_the_farthest_counts() {
    let next = |away| beacon(3, west(away), fixed(15, 16), &[15]);
    let heard = |away| [parent(), grandparent(0.8), next(away)];
    assert_eq!(choice(holder(Strategy::Eager), heard(1.0)), at(15));
    assert_eq!(choice(holder(Strategy::Eager), heard(1.9)), at(14));
    let near_access = heard(1.0).into_iter().chain([access_point(west(1.1))]);
    assert_eq!(choice(holder(Strategy::Eager), near_access), Some(Anchor::Access(0)));
    let with_gap = [parent(), next(1.0)];
    assert_eq!(choice(holder(Strategy::Eager), with_gap), None, "it does not hear the one between");
}

/// A junction, and a robot that services a task, are needed whatever is attached past them.
#[test]
fn only_relays_are_passed_over() {
    let needed = |beacon: Beacon, duty: fn(Held) -> Duty| {
        let held = beacon.duty.as_ref().and_then(Duty::held).expect("it holds a post");
        Beacon { duty: Some(duty(*held)), ..beacon }
    };
    let junction = |held| Duty::Junction(Junction(held));
    let heard = [needed(parent(), junction), grandparent(0.8)];
    assert_eq!(choice(holder(Strategy::Eager), heard), None);
    let next = beacon(3, west(1.0), fixed(15, 16), &[15]);
    let heard = [parent(), needed(grandparent(0.8), junction), next];
    assert_eq!(choice(holder(Strategy::Eager), heard), at(14));
}

/// Its own way has four links. So far from here it hears the first node of another way, which leads over these posts to
/// another access point.
#[test]
fn a_fixed_post_is_attached_to_another_tree_where_its_way_is_shorter() {
    let build = robot().build_length();
    let finds = |strategy: Strategy, posts: &[u32], away: f64| {
        let extended =
            |way: Lineage, post: &u32| way.extended_by(PostId(*post)).expect("they differ");
        let way = posts.iter().rev().fold(Lineage::of_access_point(1), extended);
        let node = beacon(4, east(away), fixed(posts[0], posts[1]), &[]);
        choice(holder(strategy), [parent(), Beacon { lineage: Some(Arc::new(way)), ..node }])
    };
    assert_eq!(finds(Strategy::Eager, &[40, 41], build - LITTLE), at(40));
    assert_eq!(finds(Strategy::Eager, &[40, 41], build + LITTLE), None);
    assert_eq!(finds(Strategy::Eager, &[40, 41, 42], build - LITTLE), None, "it is as long");
    assert_eq!(
        finds(Strategy::Eager, &[40, 30], build - LITTLE),
        None,
        "it leads over its own post"
    );
    assert_eq!(finds(Strategy::Paper, &[40, 41], build - LITTLE), None);
}

/// Otherwise the relays before it, which bear nothing but its post, could not be recruited until it is released.
#[test]
fn the_post_of_a_bound_leader_is_attached_past_its_parent_too() {
    let mut robot = holder(Strategy::Eager);
    let held = *robot.duty.held().expect("it holds a post");
    robot.duty.is(Duty::Bound(Bound(held)));
    let heard = [parent(), grandparent(robot.build_length() - LITTLE)];
    heard.into_iter().for_each(|beacon| robot.hears(beacon));
    robot.trace_lineage().expect("its automaton goes on");
    robot.keep_place().expect("its automaton goes on");
    robot.measures();
    robot.jump_duty(Label::Alone).expect("its automaton goes on");
    assert_eq!((robot.anchor(), robot.duty.location()), (at(14), Activity::Bound));
}

/// A team that stands still tells of the other tree, so that its robots can come to the aid of those there.
#[test]
fn any_other_tree_will_do_once_links_are_as_long_as_they_get() {
    let is_near = |stretched: bool, root: usize| {
        let mut robot = holder(Strategy::Eager);
        robot.mission.notices_mut().set_stretched(stretched);
        let extended =
            |way: Lineage, post: u32| way.extended_by(PostId(post)).expect("they differ");
        let way = [42, 41, 40].into_iter().fold(Lineage::of_access_point(root), extended);
        let node = beacon(4, east(0.5), fixed(40, 41), &[]);
        [parent(), Beacon { lineage: Some(Arc::new(way)), ..node }]
            .into_iter()
            .for_each(|beacon| robot.hears(beacon));
        robot.trace_lineage().expect("its automaton goes on");
        robot.is_near_other_tree()
    };
    assert!(is_near(true, 1));
    assert!(!is_near(false, 1), "links may become longer first");
    assert!(!is_near(true, 0), "it is in this tree");
}

#[test]
fn no_way_is_shortened_that_is_contradicted_or_while_a_path_is_sought() {
    let newer = beacon(2, west(0.8), fixed(14, 17), &[14, 17]);
    let own_way = Beacon { parent: Some(0), ..grandparent(0.8) };
    assert_eq!(choice(holder(Strategy::Eager), [parent(), newer]), at(14), "a way of its own");
    assert_eq!(
        choice(holder(Strategy::Eager), [parent(), own_way]),
        None,
        "attached to this robot"
    );
    let lost = beacon(2, west(0.8), fixed(14, 15), &[]);
    assert_eq!(choice(holder(Strategy::Eager), [parent(), lost]), None, "it knows no way");
    let mut recruiting = holder(Strategy::Eager);
    recruiting.seeks_recruit(false, false);
    assert_eq!(choice(recruiting, [parent(), grandparent(0.8)]), None);
}

/// It goes by the way that it knew before it hears that its parent is attached elsewhere, and the node before to itself.
#[test]
fn no_post_is_attached_below_itself() {
    let mut robot = holder(Strategy::Eager);
    robot.hears(parent());
    robot.trace_lineage().expect("its automaton goes on");
    let moved = beacon(1, west(0.5), fixed(13, 17), &[13, 17]);
    let heard = |posts: &[u32]| [moved.clone(), beacon(2, west(0.8), fixed(14, posts[1]), posts)];
    for (posts, chosen) in [(&[14, 15][..], at(14)), (&[14, 30, 13, 17], None)] {
        let mut robot = robot.clone();
        heard(posts).into_iter().for_each(|beacon| robot.hears(beacon));
        robot.keep_place().expect("its automaton goes on");
        assert_eq!(robot.tree.desired_parent().flatten(), chosen, "{posts:?}");
    }
}
