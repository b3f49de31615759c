//! To which node a robot attaches (Definition 5.2, Remark 5.6).

use pleach_discrete::network::{Anchor, IdSet, PostId, Role};

use super::*;
use crate::network::duty::{Bound, Hop, PathPlace, Waiting};
use crate::network::robot::attachment::PATIENCE_WITH_UNUSED_POSTS;
use crate::network::roll::{Absent, Roll};
use crate::network::scenario::Strategy;

/// To what a redundant robot wants to be attached that hears these.
fn choice(robot: &mut Robot, heard: impl IntoIterator<Item = Beacon>) -> Option<Anchor> {
    heard.into_iter().for_each(|beacon| robot.hears(beacon));
    robot.keep_place().expect("its automaton goes on");
    robot.tree.desired_parent().expect("a redundant robot looks for a parent")
}

const fn at(post: u32) -> Option<Anchor> {
    Some(Anchor::Post(PostId(post)))
}

/// That one has not heard yet that this robot has lost its way.
#[test]
fn a_robot_does_not_attach_to_one_that_is_attached_to_it() {
    let attached_to = |parent| Beacon { parent, ..beacon(1, east(0.5), fixed(11, 13), &[11, 13]) };
    assert_eq!(choice(&mut robot(), [attached_to(Some(5))]), at(11));
    let own = robot().id;
    assert_eq!(choice(&mut robot(), [attached_to(Some(own))]), None);
}

#[test]
fn a_redundant_robot_attaches_where_links_are_fewest() {
    let heard = [
        beacon(1, east(0.5), redundant(11, 12), &[11, 12, 13]),
        beacon(2, east(1.1), fixed(12, 13), &[12, 13]),
        beacon(3, west(0.7), fixed(14, 13), &[14, 15, 13]),
    ];
    assert_eq!(choice(&mut robot(), heard.clone()), at(12));
    let with_access = heard.into_iter().chain([access_point(north(1.2))]);
    assert_eq!(choice(&mut robot(), with_access), Some(Anchor::Access(0)));
}

#[test]
fn of_equally_many_links_the_most_reliable_counts() {
    for (one, other, best) in [(1.1, 1.2, 11), (1.2, 1.1, 12)] {
        let heard = [
            beacon(1, east(one), fixed(11, 13), &[11, 13]),
            beacon(2, west(other), fixed(12, 13), &[12, 13]),
        ];
        assert_eq!(choice(&mut robot(), heard), at(best));
    }
    // Up to l all are alike: the first one heard counts.
    let heard = [
        beacon(1, east(0.9), fixed(11, 13), &[11, 13]),
        beacon(2, west(0.5), fixed(12, 13), &[12, 13]),
    ];
    assert_eq!(choice(&mut robot(), heard), at(11));
}

#[test]
fn links_are_made_up_to_d_build() {
    let build = robot().build_length();
    for (length, expected) in [(build - LITTLE, at(11)), (build + LITTLE, None)] {
        let heard = [beacon(1, east(length), fixed(11, 13), &[11, 13])];
        assert_eq!(choice(&mut robot(), heard), expected, "{length} of {build}");
    }
    let robot = robot();
    assert!(robot.may_build(build.next_up()), "what rounding makes longer is as long");
}

/// Around the pillar the way is longer than the straight line between two robots.
#[test]
fn links_are_measured_along_geodesics() {
    let mut robot = robot();
    robot.body.is_at(Point::new(7.5, 6.9));
    let behind = Point::new(7.5, 8.1);
    assert!((behind - robot.body.position()).norm() < robot.build_length());
    let heard = [beacon(1, behind, fixed(11, 13), &[11, 13])];
    assert_eq!(choice(&mut robot, heard), None);
}

#[test]
fn a_parent_is_kept_up_to_d_hard_and_while_no_other_has_fewer_links() {
    let hard = robot().hard_length();
    let rival = |posts: &[u32]| beacon(2, west(0.5), fixed(12, 13), posts);
    let keeps = |length: f64, posts: &[u32]| {
        let mut robot = robot();
        robot.holds(redundant(0, 11));
        choice(&mut robot, [beacon(1, east(length), fixed(11, 13), &[11, 13]), rival(posts)])
    };
    assert_eq!(keeps(hard - LITTLE, &[12, 13]), at(11), "no fewer links");
    assert_eq!(keeps(hard - LITTLE, &[12]), at(12), "fewer links");
    assert_eq!(keeps(hard + LITTLE, &[12, 13]), at(12), "too long");
    assert_eq!(keeps(hard - LITTLE, &[12, 14, 13]), at(11), "more links");
}

/// A robot that has come to its place of Σ hears of its way a few rounds later.
#[test]
fn a_parent_that_knows_no_way_is_kept_while_there_is_no_other() {
    let hard = robot().hard_length();
    let keeps = |length: f64, others: &[Beacon]| {
        let mut robot = robot();
        robot.holds(redundant(0, 11));
        let parent = beacon(1, east(length), fixed(11, 13), &[]);
        choice(&mut robot, [&[parent], others].concat())
    };
    assert_eq!(keeps(hard - LITTLE, &[]), at(11));
    assert_eq!(keeps(hard + LITTLE, &[]), None, "too long");
    let other = beacon(2, west(0.5), fixed(12, 14), &[12, 14]);
    assert_eq!(keeps(hard - LITTLE, &[other]), at(12), "another knows one");
    let mut robot = robot();
    robot.holds(redundant(0, 11));
    assert_eq!(choice(&mut robot, []), None, "it is not heard");
}

#[test]
fn no_robot_attaches_below_itself_nor_to_the_primary_team() {
    let mut below = robot();
    let heard = [beacon(1, east(0.5), redundant(11, 0), &[11, 0, 13])];
    assert_eq!(choice(&mut below, heard), None, "its own post is on the way");
    let heard = [beacon(1, east(0.5), primary(11, None, 13), &[11, 13])];
    assert_eq!(choice(&mut robot(), heard), None, "the team moves");
    let heard = [beacon(1, east(0.5), fixed(11, 13), &[])];
    assert_eq!(choice(&mut robot(), heard), None, "it knows no way");
}

/// A robot on the way tells a way of its own: news of it is newer than what others know.
#[test]
fn a_way_that_a_robot_on_it_contradicts_does_not_count() {
    let candidate = || beacon(1, east(0.5), fixed(11, 12), &[11, 12, 13]);
    let witness = |posts: &[u32]| beacon(2, west(1.9), fixed(12, 13), posts);
    assert_eq!(choice(&mut robot(), [candidate(), witness(&[12, 13])]), at(11));
    assert_eq!(choice(&mut robot(), [candidate(), witness(&[12, 14])]), None);
    assert_eq!(choice(&mut robot(), [candidate(), witness(&[])]), None);
    let joined = beacon(2, west(1.9), primary(12, None, 13), &[12, 13]);
    assert_eq!(choice(&mut robot(), [candidate(), joined]), None);
}

#[test]
fn a_new_parent_has_to_be_confirmed_more_recently_than_what_was_passed_on() {
    let mut robot = robot();
    robot.tree.take_over_confirmation(7);
    let heard = Arc::new(beacon(1, east(0.5), fixed(11, 13), &[11, 13]));
    for (confirmed, awaits) in [(None, true), (Some(7), true), (Some(8), false)] {
        robot.hear_beacon(NOW, confirmed, &heard);
        robot.keep_place().expect("it goes on");
        assert_eq!(robot.tree.awaits_confirmation(), awaits, "{confirmed:?}");
        assert_eq!(robot.tree.desired_parent(), (!awaits).then_some(at(11)), "{confirmed:?}");
    }
}

/// A robot that hands its post over or waits on Σ passes on nothing newer than before.
#[test]
fn a_confirmation_is_passed_on_by_robots_that_keep_their_posts() {
    let passes_on = |change: &dyn Fn(&mut Robot)| {
        let mut robot = robot();
        robot.holds(fixed(20, 11));
        let parent = Arc::new(beacon(1, east(0.5), fixed(11, 13), &[11, 13]));
        robot.hear_beacon(NOW, Some(NOW - 1), &parent);
        change(&mut robot);
        robot.pass_on_confirmation()
    };
    assert_eq!(passes_on(&|_| {}), Some(NOW - 1));
    assert_eq!(passes_on(&|robot| robot.tree.desire(None, None, true)), None);
    let waits = |robot: &mut Robot| {
        let station = Station { post: fixed(20, 11), reference: HERE };
        let held = Held { station, left: None };
        let waiting = Waiting { held, place: 1, role: Role::Node };
        robot.duty.is(Duty::Waiting(waiting));
    };
    assert_eq!(passes_on(&waits), None);
}

#[test]
fn while_a_path_is_sought_only_robots_without_a_parent_look_for_one() {
    let heard = || beacon(1, east(0.5), fixed(11, 13), &[11, 13]);
    let path = Arc::new(Path { hops: Vec::new(), releases_leader: false });
    let shift = Shift { path, subgroups: Arc::default(), arrived: 0 };
    let mut free = robot();
    free.mission.is(Mission::Shift(shift.clone()));
    assert!(free.tree_is_frozen());
    assert_eq!(choice(&mut free, [heard()]), at(11));
    let mut attached = robot();
    attached.mission.is(Mission::Shift(shift));
    attached.holds(redundant(0, 12));
    attached.hears(heard());
    attached.keep_place().expect("it goes on");
    assert_eq!(attached.tree.desired_parent(), None);
}

/// Robots that hold these posts are on Σ, which is split at its second place; its first subgroup has arrived.
fn second_subgroup_of(posts: [Post; 4]) -> Mission {
    let hop = |robot: usize, post: Post| Hop {
        robot,
        post,
        place: PathPlace { reference: HERE, position: HERE },
        crossing: Vec::new(),
    };
    let hops = posts.into_iter().zip(1..).map(|(post, robot)| hop(robot, post)).collect();
    let path = Arc::new(Path { hops, releases_leader: false });
    let subgroups = pleach_discrete::network::path::subgroups(&[0, 1, 3]).collect();
    Mission::Shift(Shift { path, subgroups, arrived: 1 })
}

impl Robot {
    /// The second subgroup of Σ has left its posts, robots 2 and 3.
    fn hears_second_subgroup_leave(&mut self, posts: [Post; 4]) {
        self.mission.is(second_subgroup_of(posts));
        for place in [1, 2] {
            let leaves = Duty::Shifting(Shifting { place, left: None });
            self.hears(Beacon { duty: Some(leaves), ..Beacon::silent(place + 1, east(0.5)) });
        }
    }
}

/// Σ leads up the tree. Robot 1 has taken the post of this robot, whose parent stood at the next place.
#[test]
fn a_robot_stands_for_the_post_that_the_one_ahead_has_left() {
    let may_set_out = |ahead: Duty, parent: Option<NodeId>| {
        let posts = [redundant(10, 11), redundant(11, 12), redundant(12, 13), fixed(13, 20)];
        let mut robot = robot();
        robot.mission.is(second_subgroup_of(posts));
        let held = Held { station: Station { post: posts[1], reference: HERE }, left: None };
        let waiting = Waiting { held, place: 1, role: Role::Redundant };
        robot.duty.is(Duty::Waiting(waiting));
        robot.hears(Beacon { duty: Some(ahead), ..Beacon::silent(3, east(0.5)) });
        robot.hears(Beacon { parent, ..beacon(1, west(0.1), posts[1], &[]) });
        robot.may_set_out()
    };
    let held = Held { station: Station { post: redundant(12, 13), reference: HERE }, left: None };
    let waits = Duty::Waiting(Waiting { held, place: 2, role: Role::Redundant });
    let leaves = Duty::Shifting(Shifting { place: 2, left: Some(PostId(12)) });
    assert!(may_set_out(waits, Some(3)), "robot 1 knows its parent");
    assert!(!may_set_out(waits, Some(0)), "robot 1 is still attached to this robot");
    assert!(may_set_out(leaves, Some(0)), "robot 1 is attached to the one that follows");
}

/// The second subgroup of Σ has left the posts 11 and 12, of which the first has taken post 11.
#[test]
fn nobody_stands_for_a_post_that_the_subgroup_before_has_taken() {
    let posts = [redundant(10, 11), fixed(11, 20), fixed(12, 11), fixed(13, 12)];
    let mut robot = robot();
    robot.hears_second_subgroup_leave(posts);
    robot.holds(redundant(0, 12));
    assert_eq!(
        robot.named_parent(),
        Some(3),
        "robot 3 leaves post 12, and stands for it meanwhile"
    );
    robot.holds(redundant(0, 11));
    assert_eq!(robot.named_parent(), None, "robot 1 holds post 11, and is not heard");
}

/// Σ leads up the tree, and the second subgroup has left the posts 11 and 12.
#[test]
fn nobody_stands_for_a_post_that_has_not_been_left() {
    let mut robot = robot();
    let posts = [redundant(10, 11), redundant(11, 12), redundant(12, 13), fixed(13, 20)];
    robot.hears_second_subgroup_leave(posts);
    robot.holds(redundant(0, 12));
    assert_eq!(robot.named_parent(), Some(2), "robot 2 follows robot 3, which has left post 12");
    robot.holds(redundant(0, 13));
    assert_eq!(robot.named_parent(), None, "robot 4 holds post 13, and is not heard");
}

/// Robots between the two have stopped. The holder comes into range by chance, and may leave it again.
#[test]
fn the_holder_of_the_post_above_is_no_parent_where_no_link_reaches() {
    let settled = robot().settled_length();
    let parent = |away: f64, before: Option<NodeId>| {
        let mut robot = robot();
        robot.holds(fixed(20, 13));
        robot.tree.attach_to(before);
        robot.hears(beacon(5, west(away), fixed(13, 14), &[13, 14]));
        robot.tree_parent()
    };
    assert_eq!(parent(settled - LITTLE, None), Some(5));
    assert_eq!(parent(settled + LITTLE, None), None);
    assert_eq!(parent(settled + LITTLE, Some(5)), Some(5), "there was a link before");
}

/// The robot that a leaf is linked to has joined the team from post 13, and robot 6 that relieves it is out of reach.
#[test]
fn a_post_follows_the_robot_that_it_is_linked_to_where_its_successor_is_out_of_reach() {
    let settled = robot().settled_length();
    let desired = |successor: f64, linked: &[u32]| {
        let mut robot = robot();
        robot.holds(fixed(20, 13));
        robot.tree.attach_to(Some(5));
        robot.hears(beacon(5, west(settled - 0.1), fixed(21, 13), linked));
        robot.hears(beacon(6, west(successor), fixed(13, 14), &[13, 14]));
        robot.keep_place().expect("it goes on");
        robot.tree.desired_parent()
    };
    assert_eq!(desired(settled + LITTLE, &[21, 13, 14]), Some(at(21)));
    assert_eq!(desired(settled - LITTLE, &[21, 13, 14]), None, "the successor is its parent");
    assert_eq!(desired(settled + LITTLE, &[]), None, "it knows no way");
    assert_eq!(desired(settled + LITTLE, &[21, 20, 14]), None, "that is attached to it");
}

/// Robot 0 holds a fixed post whose parent, post 21, has had no holder for `periods` control periods.
fn orphan(periods: u32, heard: Beacon) -> Option<Option<Anchor>> {
    orphan_with(|held| Duty::Relay(Relay(held)), periods, heard)
}

/// As [`orphan`], with this duty.
fn orphan_with(duty: fn(Held) -> Duty, periods: u32, heard: Beacon) -> Option<Option<Anchor>> {
    let mut robot = robot();
    let held = Held { station: Station { post: fixed(20, 21), reference: HERE }, left: None };
    robot.duty.is(duty(held));
    robot.hears(heard);
    (0..periods).for_each(|_| robot.count_orphaned_periods());
    robot.keep_place().expect("it goes on");
    robot.tree.desired_parent()
}

#[test]
fn a_fixed_post_changes_its_parent_when_that_has_had_no_holder_for_long() {
    let other = || beacon(1, east(0.5), fixed(11, 13), &[11, 13]);
    assert_eq!(orphan(12, other()), None);
    assert_eq!(orphan(13, other()), Some(at(11)));
    assert_eq!(orphan(40, other()), Some(at(11)));
    let below_lost = beacon(1, east(0.5), fixed(11, 21), &[11, 21]);
    assert_eq!(orphan(40, below_lost), None, "what led over the lost post leads nowhere");
    let below = beacon(1, east(0.5), fixed(11, 20), &[11, 20, 13]);
    assert_eq!(orphan(40, below), None, "it is attached to this post");
    let hard = robot().hard_length();
    let far = |length: f64| beacon(1, east(length), fixed(11, 13), &[11, 13]);
    assert_eq!(orphan(40, far(hard - LITTLE)), Some(at(11)));
    assert_eq!(orphan(40, far(hard + LITTLE)), None);
    let team = beacon(1, east(0.5), primary(11, None, 13), &[11, 13]);
    assert_eq!(orphan(40, team), None);
}

#[test]
fn a_bound_leader_whose_parent_is_gone_attaches_elsewhere() {
    let other = beacon(1, east(0.5), fixed(11, 13), &[11, 13]);
    assert_eq!(orphan_with(|held| Duty::Bound(Bound(held)), 13, other), Some(at(11)));
}

/// Robot 0 holds a fixed post that is attached to access point 0, which has been silent for `periods` control
/// periods; robot 1 leads to access point `root`.
fn orphan_of_access_point(periods: u32, root: usize) -> Option<Option<Anchor>> {
    let mut robot = robot();
    robot.holds(Post { parent: Some(Anchor::Access(0)), ..fixed(20, 0) });
    let lineage = Lineage::of_access_point(root).extended_by(PostId(11)).map(Arc::new);
    robot.hears(Beacon { lineage, ..beacon(1, east(0.5), fixed(11, 13), &[]) });
    (0..periods).for_each(|_| robot.count_orphaned_periods());
    robot.keep_place().expect("it goes on");
    robot.tree.desired_parent()
}

#[test]
fn a_fixed_post_changes_its_parent_when_its_access_point_is_not_heard_for_long() {
    assert_eq!(orphan_of_access_point(12, 1), None);
    assert_eq!(orphan_of_access_point(13, 1), Some(at(11)));
    assert_eq!(orphan_of_access_point(40, 0), None, "it leads to the one that is not heard");
    let mut robot = robot();
    robot.holds(Post { parent: Some(Anchor::Access(0)), ..fixed(20, 0) });
    assert!(robot.hears_no_parent());
    robot.hears(access_point(east(1.0)));
    assert!(!robot.hears_no_parent());
}

#[test]
fn periods_without_a_parent_are_counted_from_the_last_one_with_it() {
    let mut robot = robot();
    robot.holds(fixed(20, 11));
    (0..5).for_each(|_| robot.count_orphaned_periods());
    assert_eq!(robot.tree.orphaned_periods(), 5);
    assert!(robot.is_orphan());
    robot.hears(beacon(1, east(0.5), fixed(11, 13), &[11, 13]));
    assert!(!robot.is_orphan());
    robot.count_orphaned_periods();
    assert_eq!(robot.tree.orphaned_periods(), 0);
}

/// Nobody waits for it to be relieved by a robot that only remembers its parent.
#[test]
fn a_post_that_is_attached_to_none_has_no_parent_in_the_end() {
    let mut robot = robot();
    robot.holds(Post { parent: None, ..fixed(20, 0) });
    robot.hears(beacon(1, east(0.5), fixed(11, 13), &[11, 13]));
    robot.tree.attach_to(Some(1));
    let parents = (0..6).map(|_| {
        robot.count_orphaned_periods();
        robot.tree_parent()
    });
    assert_eq!(parents.collect::<Vec<_>>(), [Some(1), Some(1), Some(1), None, None, None]);
}

/// A way through its own post leads nowhere; a parent that is silent is waited for.
#[test]
fn a_robot_follows_the_way_of_its_parent() {
    let after = |told: &[u32]| {
        let mut robot = robot();
        robot.holds(redundant(0, 11));
        for posts in [&[11, 13], told] {
            robot.hears(beacon(1, east(0.5), fixed(11, 13), posts));
            robot.trace_lineage().expect("its guards have values");
        }
        robot.lineage().cloned()
    };
    assert_eq!(after(&[11, 14]), way(&[0, 11, 14]));
    assert_eq!(after(&[11, 0, 13]), None);
    assert_eq!(after(&[]), way(&[0, 11, 13]));
}

/// p₁ with its parent 1.0 to the west, the task far to the east, and another node.
fn reattached(node: Beacon) -> Option<Option<Anchor>> {
    let mut robot = robot();
    robot.holds(primary(30, None, 11));
    robot.advances_to(east(4.0));
    robot.hears(beacon(1, west(1.0), fixed(11, 13), &[11, 13]));
    robot.hears(node);
    robot.keep_place().expect("it goes on");
    robot.tree.desired_parent()
}

#[test]
fn the_first_of_the_team_attaches_to_a_node_that_is_nearer_to_the_task() {
    let gain = 0.05 * robot().build_length();
    let node = |away: f64| beacon(2, west(away), fixed(12, 13), &[12, 13]);
    assert_eq!(reattached(node(1.0 - gain - LITTLE)), Some(at(12)));
    assert_eq!(reattached(node(1.0 - gain + LITTLE)), None, "it gains too little");
    let ahead = |away: f64| beacon(2, east(away), redundant(12, 13), &[12, 13]);
    let build = robot().build_length();
    assert_eq!(reattached(ahead(build - LITTLE)), Some(at(12)));
    assert_eq!(reattached(ahead(build + LITTLE)), None, "the link would be too long");
    let below = beacon(2, east(0.5), redundant(12, 30), &[12, 30, 11, 13]);
    assert_eq!(reattached(below), None, "it is attached to this post");
    let child = Beacon { parent: Some(0), ..beacon(2, east(0.5), redundant(12, 13), &[12, 13]) };
    assert_eq!(reattached(child), None, "it is attached to this robot");
    let lost = beacon(2, east(0.5), redundant(12, 13), &[]);
    assert_eq!(reattached(lost), None, "it knows no way");
}

#[test]
fn of_nodes_nearer_to_the_task_the_nearest_counts() {
    let mut robot = robot();
    robot.holds(primary(30, None, 11));
    robot.advances_to(east(4.0));
    robot.hears(beacon(1, west(1.0), fixed(11, 13), &[11, 13]));
    for (id, away) in [(2, 0.3), (3, 0.6), (4, 0.4)] {
        let number = 10 + id as u32;
        robot.hears(beacon(id, east(away), fixed(number, 19), &[number, 19]));
    }
    robot.keep_place().expect("it goes on");
    assert_eq!((robot.tree.desired_parent(), robot.tree.reattaches_to()), (Some(at(13)), Some(3)));
}

#[test]
fn a_member_with_a_follower_keeps_its_parent() {
    let mut robot = robot();
    robot.holds(primary(30, None, 11));
    robot.advances_to(east(4.0));
    robot.hears(beacon(1, west(1.0), primary(11, Some(30), 13), &[11, 13]));
    robot.hears(beacon(2, east(0.5), fixed(12, 13), &[12, 13]));
    robot.keep_place().expect("it goes on");
    assert_eq!(robot.tree.desired_parent(), None);
}

#[test]
fn the_follower_attaches_to_the_newcomer_as_soon_as_the_link_may_be_made() {
    let build = robot().build_length();
    for (away, expected) in [(build - LITTLE, Some(at(40))), (build + LITTLE, None)] {
        let mut robot = robot();
        robot.holds(primary(30, None, 11));
        robot.advances_to(east(4.0));
        robot.is_told(Notice::Advance { joined: Some((PostId(40), PostId(30))) });
        robot.hears(beacon(1, west(1.0), fixed(11, 13), &[11, 13]));
        robot.hears(beacon(2, west(away), primary(40, Some(30), 11), &[40, 11, 13]));
        robot.keep_place().expect("it goes on");
        assert_eq!(robot.tree.desired_parent(), expected, "{away}");
    }
}

#[test]
fn branches_are_fixed_posts_and_the_primary_team_as_one() {
    let mut robot = robot();
    robot.holds(fixed(20, 13));
    assert!(!robot.bears_branch());
    robot.hears(beacon(1, east(0.3), redundant(11, 20), &[11, 20, 13]));
    assert_eq!(robot.branches(), 0);
    robot.hears(beacon(2, east(0.5), fixed(12, 20), &[12, 20, 13]));
    robot.hears(beacon(3, east(0.6), fixed(12, 20), &[12, 20, 13]));
    assert_eq!(robot.branches(), 1, "two robots hold one post during a hand-over");
    robot.hears(beacon(4, west(0.5), primary(14, None, 20), &[14, 20, 13]));
    robot.hears(beacon(5, west(0.7), primary(15, Some(14), 20), &[15, 20, 13]));
    assert_eq!(robot.branches(), 2, "the team is one branch");
    assert_eq!(robot.branches_of(PostId(13)), 0);
    assert!(robot.bears_branch());
}

#[test]
fn a_node_on_which_no_branch_depends_counts_the_periods() {
    let cut_off = || {
        let mut robot = robot();
        robot.holds(fixed(20, 13));
        robot.changes.rest();
        robot
    };
    let node = || {
        let mut robot = cut_off();
        robot.hears(beacon(3, west(0.5), fixed(13, 14), &[13, 14]));
        robot
    };
    let count = |change: &dyn Fn(&mut Robot)| {
        let mut robot = node();
        change(&mut robot);
        (0..PATIENCE_WITH_UNUSED_POSTS).for_each(|_| robot.count_unused_periods());
        (robot.tree.unused_periods(), robot.changes.is_quiet())
    };
    assert_eq!(count(&|_| {}), (2, false));
    assert_eq!(count(&|robot| robot.holds(redundant(20, 13))), (0, true));
    assert_eq!(count(&|robot| robot.holds(Post { task: Some(0), ..fixed(20, 13) })), (0, true));
    let branch = |robot: &mut Robot| robot.hears(beacon(1, east(0.5), fixed(11, 20), &[11, 20]));
    assert_eq!(count(&branch), (0, true));
    let frozen = |robot: &mut Robot| {
        let path = Arc::new(Path { hops: Vec::new(), releases_leader: false });
        let shift = Shift { path, subgroups: Arc::default(), arrived: 0 };
        robot.mission.is(Mission::Shift(shift));
    };
    assert_eq!(count(&frozen), (0, true));
    let mut once = node();
    once.count_unused_periods();
    assert!(once.changes.is_quiet(), "once is not for long");
    let mut cut_off = cut_off();
    (0..PATIENCE_WITH_UNUSED_POSTS).for_each(|_| cut_off.count_unused_periods());
    assert_eq!(cut_off.tree.unused_periods(), 0, "its branches may be cut off from it as well");
}

/// Nodes that the last task has left without a branch become redundant meanwhile, and can come then.
#[test]
fn a_bound_leader_waits_for_nodes_to_retire_before_it_calls() {
    let waits = |strategy: Strategy, before: &[Point]| {
        let mut scenario = hall();
        scenario.control.strategy = Some(strategy);
        let mut robot = robot_of(&scenario);
        robot.advances_to(east(3.0));
        let (id, known) = robot.mission.notices().announced().cloned().expect("it knows the task");
        robot.mission.notices_mut().follow(Some((
            id,
            Shared::new(Announcement { before: before.into(), ..(*known).clone() }),
        )));
        let held = Held { station: Station { post: fixed(20, 13), reference: HERE }, left: None };
        robot.duty.is(Duty::Bound(Bound(held)));
        (0..9)
            .take_while(|_| {
                let waits = robot.awaits_retirements();
                robot.count_unused_periods();
                waits
            })
            .count() as u32
    };
    assert_eq!(waits(Strategy::Eager, &[east(1.0)]), PATIENCE_WITH_UNUSED_POSTS + 1);
    assert_eq!(waits(Strategy::Eager, &[]), 0, "no task has been serviced");
    assert_eq!(waits(Strategy::Paper, &[east(1.0)]), 0);
}

#[test]
fn a_redundant_robot_can_detach_if_another_way_does_not_lead_over_its_parent() {
    let detaches = |other: Beacon| {
        let mut robot = robot();
        robot.holds(redundant(0, 11));
        robot.hears(beacon(1, west(0.5), redundant(11, 13), &[11, 13]));
        robot.hears(other);
        robot.look_after_place().expect("it goes on");
        robot.tree.can_detach()
    };
    assert!(detaches(beacon(2, east(0.5), fixed(12, 13), &[12, 13])));
    assert!(!detaches(beacon(2, east(0.5), redundant(12, 11), &[12, 11, 13])));
    let mut rooted = robot();
    let own = Post { parent: Some(Anchor::Access(0)), ..redundant(0, 0) };
    rooted.holds(own);
    rooted.look_after_place().expect("it goes on");
    assert!(rooted.tree.can_detach(), "access points stay");
    rooted.holds(Post { parent: Some(Anchor::Access(0)), ..fixed(0, 0) });
    rooted.look_after_place().expect("it goes on");
    assert!(!rooted.tree.can_detach(), "a fixed post keeps its parent");
}

#[test]
fn an_access_point_hears_of_whom_a_branch_reports() {
    let set = |robots: &[usize]| -> Arc<IdSet> { Arc::new(robots.iter().copied().collect()) };
    let mut robot = robot();
    robot.holds(Post { task: Some(3), ..fixed(20, 13) });
    robot.hears(beacon(1, west(0.9), fixed(13, 14), &[13, 14]));
    let child = Beacon {
        below: set(&[2, 4]),
        serves: set(&[1]),
        ..beacon(2, east(0.5), fixed(12, 20), &[12, 20, 13, 14])
    };
    robot.hears(child);
    robot.hears(beacon(3, north(0.5), redundant(16, 17), &[]));
    let other =
        Beacon { below: set(&[5]), ..beacon(5, south(0.5), redundant(15, 13), &[15, 13, 14]) };
    robot.hears(other);
    robot.look_after_place().expect("it goes on");
    assert_eq!(**robot.tree.reports()[0], *set(&[0, 2, 4]), "itself and what its children report");
    assert_eq!(**robot.tree.reports()[1], *set(&[3]), "one that knows no way");
    assert_eq!(**robot.tree.reports()[2], *set(&[1, 3]));
    assert_eq!(robot.tree.parent(), Some(1));
    // One that has not been heard in this period or the one before is not reported.
    robot.schedule.is_in(NOW + 2);
    robot.look_after_place().expect("it goes on");
    assert_eq!((&**robot.tree.reports()[0], &**robot.tree.reports()[1]), (&*set(&[0]), &*set(&[])));
}

/// A way is kept while the parent is not heard, until the robot is gone: then it counts as one that knows none, and
/// takes part again where another hears it.
#[test]
fn a_robot_that_is_gone_and_does_not_hear_its_parent_forgets_the_way() {
    let mut robot = robot();
    robot.holds(fixed(20, 13));
    let parent = beacon(1, west(0.9), fixed(13, 14), &[13, 14]);
    robot.hears(parent.clone());
    let knows_way = |robot: &mut Robot| {
        robot.look_after_place().expect("it goes on");
        robot.lineage().is_some()
    };
    assert!(knows_way(&mut robot));
    let gone = Absent { gone: IdSet::singleton(robot.id), ..Absent::default() };
    robot.membership.is_told(Roll { called: NOW, absent: Arc::new(gone) });
    assert!(knows_way(&mut robot), "it hears its parent");
    robot.neighbours = Neighbours::default();
    assert!(!knows_way(&mut robot));
    robot.membership.lacks(Absent::default());
    robot.hears(parent);
    assert!(knows_way(&mut robot));
    robot.neighbours = Neighbours::default();
    assert!(knows_way(&mut robot), "it takes part");
}

/// Others hear of a robot on Σ through the one ahead, and of those that hear nobody else: one that was missed
/// would be announced to again and again.
#[test]
fn a_robot_on_its_way_along_sigma_reports_robots_that_know_no_way() {
    let strays = |duty: Duty| {
        let mut robot = robot();
        robot.duty.is(duty);
        robot.hears(beacon(3, north(0.5), redundant(16, 17), &[]));
        robot.look_after_place().expect("it goes on");
        IdSet::clone(robot.tree.reports()[1])
    };
    assert_eq!(strays(Duty::Shifting(Shifting { place: 0, left: None })), IdSet::singleton(3));
    let detached = holding(redundant(0, 11), HERE);
    assert_eq!(strays(detached), IdSet::default(), "nobody hears of one that knows no way itself");
}
