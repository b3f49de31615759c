//! What is to hold in every state of the protocol, and where every mission is to lead.
//!
//! The algebra is that of [`tree`], [`team`], [`duty`] and [`election`]; here it is read
//! off a state. While two robots exchange duties there is a moment at which one has taken over
//! and the other does not know yet: what counts is the [duty in effect](duties).

use std::collections::{BTreeMap, BTreeSet};

use pleach_automaton::network::RobotView;
use pleach_automaton::network::beacon::Notice;
use pleach_automaton::network::duty::Duty;
use pleach_automaton::network::record::Outcome;
use pleach_automaton::network::scenario::Strategy;
use pleach_discrete::network::{Anchor, NoticeId, Phase, Post, PostId, PostKind, Role, Subgroup};

use super::node::Local;
use super::protocol::{Protocol, State};
use crate::Property;
use pleach_verify::network::{duty, election, team, tree};

/// The properties that hold in every state.
pub const ALWAYS: &[Property<Protocol>] = &[
    Property { name: "the tree is rooted", holds: tree_is_rooted },
    Property { name: "robots with a duty are in the tree", holds: workers_are_in_the_tree },
    Property { name: "at most one robot leads", holds: at_most_one_leads },
    Property { name: "the primary team is one chain", holds: primary_team_is_a_chain },
    Property { name: "posts with children are held", holds: bearing_posts_are_held },
    Property { name: "serviced tasks are held", holds: serviced_tasks_are_held },
    Property { name: "no task is held twice", holds: no_task_is_held_twice },
    Property {
        name: "junctions and serviced tasks are occupied",
        holds: junctions_and_tasks_are_occupied,
    },
    Property { name: "elections agree", holds: elections_agree },
    Property { name: "the best bidder is elected", holds: the_best_bidder_is_elected },
    Property { name: "exactly one team is active", holds: exactly_one_team_is_active },
    Property { name: "subgroups agree", holds: subgroups_agree },
    Property { name: "subgroups partition the path", holds: subgroups_partition_the_path },
    Property { name: "teams are disjoint", holds: teams_are_disjoint },
    Property { name: "no post is held twice", holds: no_post_is_held_twice },
    Property { name: "the gone stay where they are", holds: the_gone_stay },
    Property { name: "what is left is sufficient where it can be", holds: the_rest_suffices },
];

/// The property with this name.
pub fn property(name: &str) -> Option<&'static Property<Protocol>> {
    ALWAYS.iter().find(|property| property.name == name)
}

/// Whether a robot has given its duty away and does not know it yet: the mover has taken it.
pub fn has_handed_over(protocol: &Protocol, state: &State, robot: RobotView<'_>) -> bool {
    let Some(reply) = robot.beacon().reply.filter(|reply| reply.accepted.is_some()) else {
        return false;
    };
    let mover = protocol.robots(state).nth(reply.to);
    mover.is_some_and(|mover| reply.is_heard(mover.beacon().offer.as_ref()))
}

/// The duty in effect of every robot that runs: the one that it has or, if that is given away, the one
/// that it gets in return.
pub fn duties(protocol: &Protocol, state: &State) -> Vec<Duty> {
    protocol
        .running(state)
        .map(|robot| match robot.taking() {
            Some(&taking) if has_handed_over(protocol, state, robot) => taking,
            _ => *robot.duty(),
        })
        .collect()
}

fn posts(protocol: &Protocol, state: &State) -> Vec<Post> {
    duties(protocol, state).iter().filter_map(|duty| duty.post().copied()).collect()
}

fn parents(protocol: &Protocol, state: &State) -> Vec<Option<usize>> {
    protocol.robots(state).map(RobotView::tree_parent).collect()
}

/// From parent to parent, every robot that has one comes to an access point. Once a robot has failed, the way
/// from post to post may end at one that nobody holds, and never leads back.
pub fn tree_is_rooted(protocol: &Protocol, state: &State) -> bool {
    match state.has_failures() {
        true => tree::is_acyclic(&parents_of_posts(protocol, state)),
        false => tree::is_rooted(&parents(protocol, state)),
    }
}

/// For each post that a running robot holds, in their order, the number of the one that it is attached to.
fn parents_of_posts(protocol: &Protocol, state: &State) -> Vec<Option<usize>> {
    let held: BTreeMap<PostId, Option<Anchor>> = protocol
        .running(state)
        .filter_map(|robot| robot.duty().post())
        .map(|post| (post.id, post.parent))
        .collect();
    let number = |post: &PostId| held.keys().position(|other| other == post);
    held.values()
        .map(|parent| match parent {
            Some(Anchor::Post(parent)) => number(parent),
            _ => None,
        })
        .collect()
}

/// Every robot that is not redundant has a parent, as long as no robot has failed.
pub fn workers_are_in_the_tree(protocol: &Protocol, state: &State) -> bool {
    let is_member =
        |it: RobotView<'_>| tree::is_member_unless_redundant(it.role(), it.tree_parent());
    state.has_failures() || protocol.running(state).all(is_member)
}

/// The announcements that robots go by who may not know of one another's any more: all of them go by the
/// same one, as far as these properties are concerned, until a robot has failed.
fn announcements(protocol: &Protocol, state: &State) -> BTreeSet<Option<(u32, Option<usize>)>> {
    let known = protocol.running(state).map(|robot| going_by(state, robot));
    known.collect()
}

fn going_by(state: &State, robot: RobotView<'_>) -> Option<(u32, Option<usize>)> {
    state.has_failures().then(|| (robot.epoch(), robot.current_task()))
}

/// At most one robot is the leader; once a robot has failed, at most one of those that go by the same
/// announcement.
pub fn at_most_one_leads(protocol: &Protocol, state: &State) -> bool {
    announcements(protocol, state).into_iter().all(|announcement| {
        let roles: Vec<Role> = protocol
            .running(state)
            .filter(|&robot| going_by(state, robot) == announcement)
            .filter(|robot| !has_handed_over(protocol, state, *robot))
            .map(RobotView::role)
            .collect();
        team::has_at_most_one_leader(&roles)
    })
}

/// Every post of the primary team but the leader's follows another one of it, no two follow the
/// same, and each has one holder. Once a robot has failed, no two that go by the same announcement follow the
/// same, and each post has one holder.
pub fn primary_team_is_a_chain(protocol: &Protocol, state: &State) -> bool {
    announcements(protocol, state).into_iter().all(|it| team_is_a_chain(protocol, state, it))
}

fn team_is_a_chain(
    protocol: &Protocol,
    state: &State,
    announcement: Option<(u32, Option<usize>)>,
) -> bool {
    let robots = protocol.running(state).zip(duties(protocol, state));
    let team: Vec<Post> = robots
        .filter(|&(robot, _)| going_by(state, robot) == announcement)
        .filter_map(|(_, duty)| duty.post().copied())
        .filter(|post| post.is_primary())
        .collect();
    let count = |id: PostId| team.iter().filter(|post| post.id == id).count();
    team.iter().all(|post| {
        let rivals = team.iter().filter(|other| other.kind == post.kind).count();
        count(post.id) == 1
            && rivals == 1
            && match post.kind {
                // The team may have been dissolved where the notice has arrived already.
                PostKind::Primary { follows: Some(ahead) } if !state.has_failures() => {
                    posts(protocol, state).iter().any(|other| other.id == ahead)
                }
                _ => true,
            }
    })
}

/// A post with the post of a robot with a duty as a child is held, unless a subgroup of Σ is on its
/// way: then its robots stand for the posts that they have left. Not checked once a robot has failed: it holds none.
pub fn bearing_posts_are_held(protocol: &Protocol, state: &State) -> bool {
    if state.has_failures() {
        return true;
    }
    let is_on_its_way = |duty: &Duty| matches!(duty, Duty::Shifting(_));
    if duties(protocol, state).iter().any(is_on_its_way) {
        return true;
    }
    let posts = posts(protocol, state);
    posts.iter().filter(|post| !post.is_redundant()).all(|post| match post.parent {
        Some(Anchor::Post(parent)) => posts.iter().any(|other| other.id == parent),
        _ => true,
    })
}

/// How many tasks are serviced, as the node knows that has heard most.
fn serviced(protocol: &Protocol, state: &State) -> usize {
    protocol
        .locals(state)
        .map(|local| match local.notice() {
            Notice::Task(announcement) => announcement.task,
            Notice::Withdrawn { task } => *task,
            Notice::Serviced { task } => task + 1,
            _ => local.robot().and_then(RobotView::current_task).unwrap_or_default(),
        })
        .max()
        .unwrap_or_default()
}

fn holders(protocol: &Protocol, state: &State, task: usize) -> usize {
    posts(protocol, state).iter().filter(|post| post.task == Some(task)).count()
}

/// Every task that has been serviced is the duty of a robot. Not checked once a robot has failed.
pub fn serviced_tasks_are_held(protocol: &Protocol, state: &State) -> bool {
    state.has_failures()
        || (0..serviced(protocol, state)).all(|task| holders(protocol, state, task) > 0)
}

/// No task is the duty of two robots, but while one relieves the other on Σ. Not checked once a robot has failed:
/// one that is cut off may be given up while it services a task.
pub fn no_task_is_held_twice(protocol: &Protocol, state: &State) -> bool {
    if state.has_failures() {
        return true;
    }
    let relieves =
        |robot: RobotView<'_>| robot.duty().place().is_some() && robot.phase() == Phase::Shift;
    protocol.robots(state).any(relieves)
        || (0..serviced(protocol, state)).all(|task| holders(protocol, state, task) < 2)
}

/// A robot stands at every serviced task, and at the place of every post, fixed or waiting on Σ,
/// on which two branches hang: also while one robot relieves another of it. Not checked once a robot has failed.
pub fn junctions_and_tasks_are_occupied(protocol: &Protocol, state: &State) -> bool {
    if state.has_failures() {
        return true;
    }
    let places = &protocol.configuration().places;
    let duties = duties(protocol, state);
    let bears_branches = |own: PostId| {
        let children = duties.iter().filter_map(Duty::post).filter(|post| post.is_child_of(own));
        children.filter(|post| !post.is_redundant()).count() > 1
    };
    let junctions = duties
        .iter()
        .filter_map(Duty::station)
        .filter(|station| station.post.is_fixed() && bears_branches(station.post.id))
        .map(|station| places.place_at(station.reference));
    let tasks = places.task_positions().into_iter().take(serviced(protocol, state));
    let needed: Vec<usize> =
        junctions.chain(tasks.map(|position| places.place_at(position))).collect();
    let robots: Vec<usize> =
        (0..places.robots()).map(|robot| protocol.place_of(state, robot)).collect();
    duty::are_occupied(&needed, &robots)
}

/// Robots that know an election to be over know the same winner.
pub fn elections_agree(protocol: &Protocol, state: &State) -> bool {
    let over: Vec<_> = protocol.robots(state).filter_map(RobotView::concluded_election).collect();
    over.iter().all(|(id, best)| over.iter().all(|(other, b)| other != id || b == best))
}

/// The elected robot has bid best of all that took part, ties going to the higher index.
///
/// Robots that have begun a later election remember no older bid of theirs: then the
/// mission has gone on, and the election was checked before. Nor do robots that have failed.
pub fn the_best_bidder_is_elected(protocol: &Protocol, state: &State) -> bool {
    protocol.robots(state).filter_map(RobotView::concluded_election).all(|(id, winner)| {
        let took_part =
            |robot: RobotView<'_>| robot.election() == Some(id) && !state.has_failed(robot.id());
        let bids: Vec<_> = protocol.robots(state).map(|robot| robot.own_bid(id)).collect();
        !protocol.robots(state).all(took_part) || election::is_won_by_best(&bids, winner)
    })
}

/// While Σ is walked one team is active: a robot that moves for a task is in the primary team or in a
/// subgroup, all in the same one; once a robot has failed, of those that go by the newest announcement. Where
/// recruits are called for ahead of a standstill, the primary team may go on while one subgroup is active.
pub fn exactly_one_team_is_active(protocol: &Protocol, state: &State) -> bool {
    let newest = announcements(protocol, state).into_iter().next_back().flatten();
    let of = |is_member: &dyn Fn(RobotView<'_>) -> bool| -> Vec<usize> {
        let robots = protocol.running(state).filter(|&it| going_by(state, it) == newest);
        robots.filter(|robot| is_member(*robot)).map(RobotView::id).collect()
    };
    let is_shifting = |robot: RobotView<'_>| matches!(robot.duty(), Duty::Shifting(_));
    let waits_for_recruits = protocol.configuration().places.strategy() == Strategy::Paper;
    let moving = of(&|robot| {
        let counts = waits_for_recruits && robot.duty().is_primary();
        robot.is_active() && (is_shifting(robot) || counts)
    });
    let primary_team = of(&|robot| robot.duty().is_primary());
    let known = protocol.robots(state).filter_map(agreed).max_by_key(|&(id, _)| id);
    let subgroups: Vec<Vec<usize>> = known.map_or_else(Vec::new, |(_, groups)| {
        let has_left = |robot: RobotView<'_>, places: std::ops::Range<usize>| {
            is_shifting(robot) && robot.duty().place().is_some_and(|place| places.contains(&place))
        };
        groups.iter().map(|group| of(&|robot| has_left(robot, group.places()))).collect()
    });
    let subgroups: Vec<&[usize]> = subgroups.iter().map(Vec::as_slice).collect();
    team::exactly_one_is_active(&moving, &primary_team, &subgroups)
}

/// The path that a robot has agreed on, by its notice, and its subgroups.
fn agreed(robot: RobotView<'_>) -> Option<(NoticeId, &[Subgroup])> {
    let id = robot.beacon().agreement?.id();
    (robot.phase() == Phase::Shift).then(|| (id, robot.subgroups()))
}

/// The subgroups of a path that the robots compute, each alone, are the same.
pub fn subgroups_agree(protocol: &Protocol, state: &State) -> bool {
    let known: Vec<_> = protocol.robots(state).filter_map(agreed).collect();
    known
        .iter()
        .all(|(id, groups)| known.iter().all(|(other, others)| other != id || groups == others))
}

/// The subgroups that a robot has formed partition Σ at the break points that its places have voted for.
pub fn subgroups_partition_the_path(protocol: &Protocol, state: &State) -> bool {
    protocol.robots(state).filter(|robot| robot.phase() == Phase::Shift).all(|robot| {
        let (Some(path), groups) = (robot.path(), robot.subgroups()) else { return true };
        let places: Vec<usize> = (0..path.len()).collect();
        let formed: Vec<&[usize]> = groups.iter().map(|group| &places[group.places()]).collect();
        let agreement = robot.beacon().agreement;
        let points = agreement.and_then(|agreement| agreement.break_points(path.len()));
        groups.is_empty()
            || points.is_some_and(|points| {
                team::subgroups_partition(&places, &points, &formed)
                    && team::break_points_divide(&places, &points)
            })
    })
}

/// No robot that waits on Σ before its last place holds a post of the primary team.
pub fn teams_are_disjoint(protocol: &Protocol, state: &State) -> bool {
    protocol.robots(state).all(|robot| {
        let Some(path) = robot.path() else { return true };
        let before_last = robot.duty().place().is_some_and(|place| place + 1 < path.len());
        !(before_last && robot.duty().post().is_some_and(Post::is_primary))
    })
}

/// No two robots count as holders of one post. Of two that exchange their duties the one that has given
/// its own does not; nor does a robot on Σ that has not heard yet that the robot behind has taken its post; nor
/// one that has just begun again, until it hears that it is late: others ignore it so far.
pub fn no_post_is_held_twice(protocol: &Protocol, state: &State) -> bool {
    let counts = |robot: &RobotView<'_>| {
        protocol.is_heeded(state, robot.id())
            && !has_handed_over(protocol, state, *robot)
            && robot.duty().place().is_none()
    };
    let held = protocol.running(state).filter(counts).filter_map(|robot| robot.duty().post());
    let mut held: Vec<PostId> = held.map(|post| post.id).collect();
    held.sort_unstable();
    held.windows(2).all(|pair| pair[0] != pair[1])
}

/// A robot that another takes to be gone goes nowhere.
pub fn the_gone_stay(protocol: &Protocol, state: &State) -> bool {
    let gone: Vec<usize> = protocol.running(state).flat_map(|it| it.gone().iter()).collect();
    let goes = |robot: RobotView<'_>| robot.may_leave_place() && robot.is_active();
    protocol.running(state).filter(|robot| gone.contains(&robot.id())).all(|robot| !goes(robot))
}

/// A mission in which a robot stops for good ends with every task serviced where all robots start next to an access
/// point, all tasks are next to one, too, and without that robot there is one more than there are tasks.
pub fn the_rest_suffices(protocol: &Protocol, state: &State) -> bool {
    let faults = protocol.configuration().medium.faults();
    if (faults.stops, faults.restarts) != (1, 0)
        || !protocol.configuration().places.can_lose_any_robot()
    {
        return true;
    }
    protocol.locals(state).all(|local| match local.notice() {
        Notice::Ended { outcome, .. } => *outcome == Outcome::Serviced,
        _ => true,
    })
}

/// Whether the mission has ended, every task serviced or with a reason, and every robot knows that news
/// can reach.
pub fn has_ended(protocol: &Protocol, state: &State) -> bool {
    let knows = |local: &Local| match local.robot() {
        Some(robot) => robot.phase() == Phase::Ended,
        None => matches!(local.notice(), Notice::Ended { .. }),
    };
    let ignorant: Vec<usize> =
        protocol.locals(state).enumerate().filter(|(_, it)| !knows(it)).map(|(id, _)| id).collect();
    let can_know = |reached: &[bool]| ignorant.iter().any(|&node| reached[node]);
    ignorant.is_empty() || state.has_failures() && !can_know(&protocol.connected(state))
}
