//! Bids in the elections of leaders and recruits, and the way to the robot that calls (Algorithm 1,
//! Remarks 5.3 and 5.4).

use std::f64::consts::TAU;

use pleach_discrete::network::{Bid, Election, IdSet, NoticeId};

use super::*;
use crate::network::duty::Bound;
use crate::network::mission::{Idle, LeaderElection, Standstill};
use crate::network::record::Outcome;
use crate::network::roll::{Absent, Wreck};

/// Robot 0 hears that the task at `place` is announced; its way leads to the access point.
fn asked(place: Point) -> Robot {
    let mut robot = robot();
    robot.holds(Post { parent: Some(Anchor::Access(0)), ..redundant(0, 0) });
    robot.look_after_place().expect("it goes on");
    robot.is_told(Notice::Quiet);
    robot.knows_task(place);
    robot.mission.is(Mission::LeaderElection(LeaderElection));
    robot.ballot.takes_part_in(Election::new(robot.notice_id()));
    robot
}

fn leader_bid(robot: &mut Robot) -> Option<Bid> {
    robot.answer_announcement();
    assert!(robot.ballot.has_token(0), "it places its token");
    robot.ballot.bid()
}

/// In units of 10⁻⁶ of the length up to which links are made.
#[test]
fn the_nearer_to_the_task_the_better_the_bid_of_a_leader() {
    let merit = |away: f64| leader_bid(&mut asked(east(away))).expect("it competes").merit;
    let unit = 1e-6 * robot().site.usual.build;
    for away in [0.5, 1.0, 3.0] {
        assert_eq!(merit(away), -(away / unit).round() as i64, "{away}");
    }
    // Round the pillar the way is longer than the distance.
    let mut behind = asked(Point::new(8.5, 7.5));
    behind.body.is_at(Point::new(6.5, 7.5));
    let bid = leader_bid(&mut behind).expect("it competes");
    assert!(-bid.merit > (2.0 / unit) as i64);
}

/// One that begins again may have learnt a later announcement, and hear an election by an earlier one.
#[test]
fn an_election_is_not_over_by_the_roster_of_a_later_announcement() {
    let mut robot = asked(east(1.0));
    leader_bid(&mut robot);
    let (id, known) = robot.mission.notices().announced().cloned().expect("it knows the task");
    let roster = Arc::new(IdSet::singleton(0));
    let announcement = Shared::new(Announcement { roster, ..(*known).clone() });
    let by = |id: NoticeId, robot: &mut Robot| {
        robot.mission.notices_mut().follow(Some((id, announcement.clone())));
        robot.election_is_over()
    };
    assert!(by(id, &mut robot));
    let epochs_later = NoticeId::new(u32::MAX - 1, id.issuer);
    assert!(!by(epochs_later, &mut robot));
}

#[test]
fn a_task_in_a_wall_is_bid_for_only_if_a_robot_can_come_near_enough() {
    let inside = |deep: f64| leader_bid(&mut asked(Point::new(5.0, 10.0 - CLEARANCE + deep)));
    assert!(inside(SERVICE_RADIUS - 1e-3).is_some());
    assert!(inside(SERVICE_RADIUS + 1e-3).is_none());
}

#[test]
fn who_takes_part_and_belongs_to_an_eligible_tree_competes() {
    let without = |roster: &[NodeId], eligible: &[usize]| {
        let mut robot = asked(east(1.0));
        let (id, mut announcement) = {
            let (id, known) = robot.mission.notices().announced().expect("it knows the task");
            (*id, (**known).clone())
        };
        announcement.roster = Arc::new(roster.iter().copied().collect());
        announcement.eligible = Arc::new(eligible.iter().copied().collect());
        robot.mission.notices_mut().follow(Some((id, Shared::new(announcement))));
        leader_bid(&mut robot).is_some()
    };
    assert!(without(&[0, 1], &[0, 1]));
    assert!(!without(&[1, 2], &[0, 1]), "it is not on the roster");
    assert!(!without(&[0, 1], &[1]), "its tree is not eligible");
}

/// 2.1ρ beside the holder another robot has to be within δ of the task, too.
#[test]
fn a_holder_that_nobody_can_relieve_bids_below_those_that_can_leave() {
    let rank = |away: f64| {
        let mut robot = asked(east(1.0));
        let (id, mut known) = {
            let (id, known) = robot.mission.notices().announced().expect("it knows the task");
            (*id, (**known).clone())
        };
        (known.task, known.before) = (1, Arc::from([east(away)]));
        robot.mission.notices_mut().follow(Some((id, Shared::new(known))));
        let held = Post { parent: Some(Anchor::Access(0)), task: Some(0), ..fixed(0, 0) };
        robot.holds(held);
        robot.look_after_place().expect("it goes on");
        leader_bid(&mut robot).expect("it competes").rank
    };
    let limit = (SERVICE_RADIUS.powi(2) - (2.1 * CLEARANCE).powi(2)).sqrt();
    assert_eq!((rank(0.0), rank(limit - LITTLE), rank(limit + LITTLE)), (2, 2, 1));
}

impl Robot {
    /// Robots that have stopped stand all around it.
    fn is_shut_in(&mut self) {
        let around = |number: u8| {
            let angle = TAU * f64::from(number) / 8.0 + 0.1;
            let place = HERE + 0.4 * Vector::new(angle.cos(), angle.sin());
            Wreck::heard(40 + usize::from(number), place, NOW - 9)
        };
        let wrecks: Vec<Wreck> = (0..8).map(around).collect();
        let gone = wrecks.iter().map(|wreck| wreck.robot).collect();
        self.membership.lacks(Absent { gone, ..Absent::default() });
        self.membership.finds(wrecks);
    }
}

/// It leads only if nobody else can, and the way may be open again by then.
#[test]
fn a_robot_that_is_shut_off_from_the_task_bids_below_all_others() {
    let bid = |change: &dyn Fn(&mut Robot)| {
        let mut robot = asked(east(2.0));
        change(&mut robot);
        let bid = leader_bid(&mut robot).expect("it competes");
        (bid.rank, bid.merit)
    };
    let (free, way) = bid(&|_| {});
    assert_eq!(free, 2);
    assert_eq!(bid(&Robot::is_shut_in), (0, way));
    let (rank, longer) = bid(&|robot| {
        robot.is_shut_in();
        let first = robot.membership.wrecks()[0];
        robot.membership.finds(vec![first]);
    });
    assert!(rank == 2 && longer < way, "the way round one of them is longer");
}

/// As long as news may be under way, there and back.
#[test]
fn a_robot_that_knows_no_way_looks_for_one_before_it_answers() {
    let mut lost = asked(east(1.0));
    lost.holds(Post::redundant(PostId(0)));
    lost.look_after_place().expect("it goes on");
    lost.ballot.has_waited(2 * lost.longest_wait() - 1);
    lost.answer_announcement();
    assert!(!lost.ballot.has_token(0));
    lost.ballot.has_waited(lost.ballot.waited_rounds() + 1);
    assert_eq!(leader_bid(&mut lost), None, "it lets the others elect");
    let mut other = asked(east(1.0));
    other.is_told(Notice::Quiet);
    other.answer_announcement();
    assert!(!other.ballot.has_token(0), "it is another election");
}

/// Robot 0 hears that robot 5 calls for a recruit, and its tree neighbour 1 knows the way.
fn called(own: Post, releases_leader: bool) -> Robot {
    let mut robot = robot();
    robot.holds(own);
    robot.is_told(Notice::Call { caller: 5, releases_leader });
    robot.knows_task(east(3.0));
    robot.seeks_recruit(false, false);
    robot.ballot.takes_part_in(Election::new(robot.notice_id()));
    robot
}

fn knows_way(robot: &Robot, id: NodeId, at: Point, held: Post) -> Beacon {
    let hop = super::super::super::duty::Hop {
        robot: id,
        post: held,
        place: super::super::super::duty::PathPlace { reference: at, position: at },
        crossing: Vec::new(),
    };
    Beacon { route: Some((robot.notice_id(), Shared::new(vec![hop]))), ..beacon(id, at, held, &[]) }
}

fn recruit_bid(robot: &mut Robot) -> Option<Option<Bid>> {
    robot.answer_call();
    let has_token = robot.ballot.has_token(0);
    has_token.then_some(robot.ballot.bid())
}

#[test]
fn a_redundant_robot_bids_its_residual_and_then_the_shorter_path() {
    let bid = |residual: f64| {
        let mut robot = called(redundant(0, 11), false);
        robot.routing.leaves(residual);
        robot.hears(knows_way(&robot, 1, east(0.5), fixed(11, 13)));
        let bid = recruit_bid(&mut robot).expect("it answers").expect("it competes");
        let route = &robot.ballot.route().expect("it knows its way").1;
        assert_eq!(route.iter().map(|hop| hop.robot).collect::<Vec<_>>(), [0, 1]);
        (bid.rank, bid.merit, bid.economy)
    };
    assert_eq!(bid(0.0204), (3, 20, -2));
    assert_eq!(bid(0.0206), (3, 21, -2), "in thousandths");
    assert_eq!(bid(-0.01), (3, -10, -2));
}

#[test]
fn the_way_to_the_caller_leads_over_links_of_the_tree() {
    let finds = |own: Post, held: Post, at: Point, waited: usize| {
        let mut robot = called(own, false);
        robot.ballot.has_waited(waited);
        robot.hears(knows_way(&robot, 1, at, held));
        robot.answer_call();
        robot.ballot.route().is_some()
    };
    let near = east(0.5);
    let mut waiting = called(redundant(0, 12), false);
    waiting.hears(knows_way(&waiting, 1, near, fixed(11, 13)));
    let wait = waiting.longest_wait();
    assert!(finds(redundant(0, 11), fixed(11, 13), near, 0), "its parent");
    assert!(finds(fixed(20, 13), redundant(11, 20), near, 0), "its child");
    let stranger = || fixed(11, 13);
    assert!(!finds(redundant(0, 12), stranger(), near, wait));
    assert!(finds(redundant(0, 12), stranger(), near, wait + 1), "trees that are not connected");
    assert!(!finds(redundant(0, 12), primary(11, None, 13), near, wait + 1));
    let build = robot().build_length();
    assert!(!finds(redundant(0, 12), stranger(), east(build + LITTLE), wait + 1));
    let mut rooted = called(Post { parent: Some(Anchor::Access(0)), ..redundant(0, 0) }, false);
    let known = knows_way(&rooted, 1, near, stranger()).route;
    rooted.hears(Beacon { route: known, ..access_point(west(0.5)) });
    rooted.answer_call();
    assert!(rooted.ballot.route().is_some(), "the access point that it is attached to");
}

#[test]
fn a_robot_that_bears_others_is_no_recruit() {
    let class = |change: &dyn Fn(&mut Robot)| {
        let mut robot = called(redundant(0, 11), false);
        robot.hears(knows_way(&robot, 1, east(0.5), fixed(11, 13)));
        change(&mut robot);
        recruit_bid(&mut robot).expect("it answers").map(|bid| bid.rank)
    };
    assert_eq!(class(&|_| {}), Some(3));
    let bears = |robot: &mut Robot| robot.hears(beacon(2, west(0.5), redundant(12, 0), &[]));
    assert_eq!(class(&bears), None);
    let unknown = |robot: &mut Robot| robot.mission.notices_mut().follow(None);
    assert_eq!(class(&unknown), None, "it does not take part");
    // A relay that bears the caller alone can go with it, if no other robot can come.
    let relay = |robot: &mut Robot| {
        robot.holds(fixed(20, 11));
        robot.hears(beacon(5, west(0.5), primary(30, None, 20), &[]));
    };
    assert_eq!(class(&relay), Some(2));
    assert_eq!(class(&|robot| robot.is_shut_in()), Some(1), "no way leads to the caller");
    let two = |robot: &mut Robot| {
        relay(robot);
        robot.hears(beacon(3, north(0.5), redundant(33, 20), &[]));
    };
    assert_eq!(class(&two), None);
    let releases = |robot: &mut Robot| {
        relay(robot);
        robot.is_told(Notice::Call { caller: 5, releases_leader: true });
        robot.ballot.takes_part_in(Election::new(robot.notice_id()));
        robot.hears(knows_way(robot, 1, east(0.5), fixed(11, 13)));
    };
    assert_eq!(class(&releases), None, "the leader has past duties");
}

#[test]
fn a_robot_that_finds_no_way_waits_before_it_shows_where_it_could_help() {
    let mut robot = called(Post { parent: Some(Anchor::Access(0)), ..redundant(0, 0) }, false);
    robot.look_after_place().expect("it goes on");
    robot.ballot.has_waited(2 * robot.longest_wait() - 1);
    assert_eq!(recruit_bid(&mut robot), None, "it waits");
    robot.ballot.has_waited(robot.ballot.waited_rounds() + 1);
    let bid = recruit_bid(&mut robot).expect("it answers").expect("it could help elsewhere");
    assert_eq!((bid.rank, bid.merit), (0, 0));
    assert!(!Robot::can_come(bid) && Robot::can_come(Bid { rank: 1, ..bid }));
    let mut forgetful = called(redundant(0, 11), false);
    forgetful.mission.notices_mut().forget_election(0);
    forgetful.hears(knows_way(&forgetful, 1, east(0.5), fixed(11, 13)));
    assert_eq!(recruit_bid(&mut forgetful), None, "it may have answered before it restarted");
}

/// News goes up one tree and down another, over no more links than there are nodes; five rounds are to spare.
#[test]
fn news_is_waited_for_by_the_deepest_place_that_is_heard_of() {
    let mut robot = robot();
    let waits = [0, 1, 40].map(|depth| robot.site.rounds_across(depth));
    assert_eq!(waits, [5, ROBOTS + 1, ROBOTS + 1]);
    assert_eq!(robot.longest_wait(), 5);
    for (told, waits) in [(6, 6), (4, 6), (usize::MAX, ROBOTS + 1)] {
        robot.hears(Beacon { longest_wait: told, ..beacon(1, east(0.5), fixed(11, 13), &[11]) });
        robot.hear_notices();
        assert_eq!((robot.longest_wait(), robot.public_state().longest_wait), (waits, waits));
    }
}

#[test]
fn rounds_of_an_election_are_counted_until_its_waits_are_over() {
    let mut robot = called(redundant(0, 11), false);
    let wait = robot.longest_wait();
    let due: Vec<usize> = (1..=3 * wait).filter(|_| robot.count_round()).collect();
    assert_eq!(due, [wait + 1, 2 * wait]);
    robot.mission.is(Mission::Idle(Idle));
    assert!(!robot.count_round() && robot.ballot.waited_rounds() == 3 * wait);
    let mut asked = asked(east(1.0));
    assert!(asked.counts_rounds());
    asked.answer_announcement();
    assert!(!asked.counts_rounds(), "it has answered");
}

#[test]
fn the_newest_announcement_by_which_others_go_is_learnt() {
    let mut robot = asked(east(1.0));
    assert!(robot.newer_announcement().is_none());
    let known = robot.mission.notices().announced().cloned().expect("it knows the task");
    robot.hears(Beacon {
        announced: Some(known.clone()),
        ..beacon(1, east(0.5), redundant(11, 13), &[])
    });
    assert!(robot.newer_announcement().is_none(), "it goes by that one");
    for (id, times) in [(2, 1), (3, 2)] {
        let newer = (0..times).fold(known.0, |newest, _| newest.next(4));
        let place = if id == 2 { west(0.5) } else { north(0.5) };
        let announced = Some((newer, known.1.clone()));
        robot.hears(Beacon { announced, ..beacon(id, place, redundant(10 + id as u32, 13), &[]) });
    }
    let newest = known.0.next(4).next(4);
    assert_eq!(robot.newer_announcement().map(|(id, _)| *id), Some(newest));
}

/// It says so: it may have been the leader, or on Σ.
#[test]
fn who_has_taken_part_and_begins_again_has_forgotten_what_became_of_it() {
    use super::super::super::duty::{Hop, Path, PathPlace};
    use super::super::mission::MissionEffect;
    let says_so = |elects: bool, on_path: Option<NodeId>| {
        let mut robot = asked(east(1.0));
        let (id, task) = robot.mission.notices().announced().cloned().expect("it knows the task");
        robot.mission.notices_mut().follow(None);
        let electors = (0..ROBOTS).filter(|&robot| robot != 0 || elects).collect();
        let task = Shared::new(Announcement { roster: Arc::new(electors), ..(*task).clone() });
        if let Some(robot_on_path) = on_path {
            let place = PathPlace { reference: east(0.5), position: east(0.5) };
            let post = fixed(11, 13);
            let hop = Hop { robot: robot_on_path, post, place, crossing: Vec::new() };
            robot.is_told(Notice::Path(Arc::new(Path { hops: vec![hop], releases_leader: false })));
        }
        let heard = beacon(1, east(0.5), redundant(11, 13), &[]);
        robot.hears(Beacon { announced: Some((id, task)), ..heard });
        let mut effects = Vec::new();
        super::super::leader::learn(&Idle, &robot, &mut effects).expect("it hears of it");
        effects.iter().any(|effect| matches!(effect, MissionEffect::Forgotten))
    };
    assert!(says_so(true, None) && says_so(false, Some(0)));
    assert!(!says_so(false, None) && !says_so(false, Some(3)));
}

/// A robot that has been cut off hears of the announcement that has superseded its task, and of the notices by
/// it: these say that the task goes on without it.
#[test]
fn an_announcement_is_learnt_after_the_notices_by_it() {
    let mut robot = asked(east(1.0));
    let (id, announcement) =
        robot.mission.notices().announced().cloned().expect("it knows the task");
    let bulletin = robot.mission.notices().bulletin().superseding(11, Shared::new(Notice::Quiet));
    let announced = Some((bulletin.id(), announcement));
    assert!(bulletin.id().epoch() > id.epoch());
    robot.hears(Beacon { announced, bulletin, ..beacon(1, east(0.5), redundant(11, 13), &[]) });
    assert!(robot.newer_announcement().is_none(), "the notice has not been read");
    robot.hear_notices();
    assert!(robot.newer_announcement().is_some());
    robot.measures();
    assert!(robot.changes.facts().overtaken && !robot.changes.facts().announcement_heard);
    robot.mission.is(Mission::Idle(Idle));
    robot.measures();
    assert!(!robot.changes.facts().overtaken, "it has no task to give up");
}

/// A team that stands near a node of another tree can be attached there, and most of its robots come to another's aid.
#[test]
fn where_no_robot_can_come_to_a_team_near_another_tree_all_are_asked_once_more() {
    let asked = |near_other_tree: bool, again: bool, stretched: bool| {
        let mut robot = robot();
        robot.knows_task(east(3.0));
        robot.mission.notices_mut().set_stretched(stretched);
        let (id, known) = robot.mission.notices().announced().cloned().expect("it knows the task");
        robot
            .mission
            .notices_mut()
            .follow(Some((id, Shared::new(Announcement { again, ..(*known).clone() }))));
        let standstill = Standstill { remaining: 1.0, saturated: None, near_other_tree };
        let next = robot.announcement_to_others(Some(standstill));
        next.map(|next| (next.eligible.iter().collect::<Vec<_>>(), next.again))
    };
    assert_eq!(asked(true, false, false), Some((vec![0], true)));
    assert_eq!(asked(true, true, false), None, "that was done");
    assert_eq!(asked(true, true, true), Some((vec![0], true)), "links were shorter then");
    assert_eq!(asked(false, false, true), None);
}

/// The leader may be in another tree by now than when its election was announced to the robots of some trees.
#[test]
fn who_has_been_asked_is_not_asked_again_because_the_team_is_in_another_tree() {
    let next = |eligible: &[usize], led_from: Option<usize>| {
        let mut robot = asked(east(3.0));
        robot.mission.is_led_from(led_from);
        let (id, known) = robot.mission.notices().announced().cloned().expect("it knows the task");
        let eligible = Arc::new(eligible.iter().copied().collect());
        robot
            .mission
            .notices_mut()
            .follow(Some((id, Shared::new(Announcement { eligible, ..(*known).clone() }))));
        let mut election = Election::new(robot.notice_id());
        election.place(4, Some(Bid { rank: 0, merit: -1, economy: 0 }));
        robot.ballot.takes_part_in(election);
        let next = robot.announcement_to_others(None);
        next.map(|next| next.eligible.iter().collect::<Vec<_>>())
    };
    assert_eq!(next(&[0, 1], Some(0)), Some(vec![1]));
    assert_eq!(next(&[1, 2], Some(1)), Some(vec![2]));
    assert_eq!((next(&[1], Some(1)), next(&[1], None)), (None, None));
}

/// Asking the others does not count as having asked all since links were stretched: the first tree has not been.
#[test]
fn all_are_asked_with_stretched_links_after_the_others_have_been() {
    let mut hall = hall();
    hall.access_point.push(AccessPoint { position: east(3.0).into() });
    let mut robot = robot_of(&hall);
    robot.mission.notices_mut().stretch();
    robot.mission.is_led_from(Some(0));
    robot.knows_task(east(3.0));
    let mut election = Election::new(robot.notice_id());
    election.place(4, Some(Bid { rank: 0, merit: -1, economy: 0 }));
    robot.ballot.takes_part_in(election);
    let mut asked = Vec::new();
    let (id, known) = robot.mission.notices().announced().cloned().expect("it knows the task");
    let mut known = Announcement { eligible: Arc::new((0..2).collect()), ..(*known).clone() };
    while asked.len() < 9 {
        robot.mission.notices_mut().follow(Some((id, Shared::new(known))));
        let Some(next) = robot.announcement_to_others(None) else { break };
        asked.push((next.eligible.iter().collect::<Vec<_>>(), next.stretched));
        known = next;
    }
    assert_eq!(asked, [(vec![1], false), (vec![0, 1], true), (vec![1], true)]);
}

/// What the leader does next is heard before every token is known where it is nearer than some of those who elect.
#[test]
fn a_robot_that_hears_of_the_leader_first_knows_in_whose_tree_that_was_elected() {
    let mut hall = hall();
    hall.access_point.push(AccessPoint { position: east(3.0).into() });
    let led_from = |notice: Notice| {
        let mut robot = robot_of(&hall);
        robot.mission.is_led_from(Some(0));
        robot.knows_task(east(3.0));
        robot.mission.is(Mission::LeaderElection(LeaderElection));
        let mut election = Election::new(robot.notice_id());
        election.place(4, Some(Bid { rank: 1, merit: -2, economy: -1 }));
        robot.ballot.takes_part_in(election);
        robot.is_told(notice);
        (next_phase(&mut robot), robot.mission.led_from())
    };
    let path = Path { hops: Vec::new(), releases_leader: true };
    assert_eq!(led_from(Notice::Advance { joined: None }), (Phase::Advance, Some(1)));
    let call = Notice::Call { caller: 4, releases_leader: true };
    assert_eq!(led_from(call), (Phase::RecruitElection, Some(1)));
    assert_eq!(led_from(Notice::Path(Arc::new(path))), (Phase::PathAgreement, Some(1)));
}

/// Robots of other trees that have been asked before links were stretched may be able to go there now.
#[test]
fn once_links_are_stretched_all_are_asked_once_more() {
    let are_asked = |stretched: bool, has_bid: bool, were_stretched: bool| {
        let mut robot = asked(east(3.0));
        let (id, known) = robot.mission.notices().announced().cloned().expect("it knows the task");
        let known = Announcement { stretched: were_stretched, ..(*known).clone() };
        robot.mission.notices_mut().follow(Some((id, Shared::new(known))));
        let bid = Bid { rank: 0, merit: -1, economy: 0 };
        let mut election = Election::new(robot.notice_id());
        election.place(4, has_bid.then_some(bid));
        robot.ballot.takes_part_in(election);
        robot.mission.notices_mut().set_stretched(stretched);
        robot.announcement_to_others(None).is_some_and(|next| next.stretched)
    };
    assert!(are_asked(true, true, false));
    assert!(!are_asked(false, true, false), "they are as long as before");
    assert!(!are_asked(true, false, false), "no robot is redundant");
    assert!(!are_asked(true, true, true), "that was done");
}

/// A robot with a child in the east and a parent in the west, asked as a last resort to go to a task.
fn asked_with_post(task: Point, post: Post) -> Robot {
    let mut robot = robot();
    robot.holds(post);
    robot.hears(beacon(5, west(0.5), fixed(13, 14), &[13, 14]));
    robot.hears(Beacon {
        parent: Some(0),
        ..beacon(1, east(0.5), fixed(31, 30), &[31, 30, 13, 14])
    });
    robot.knows_task(task);
    robot.knows_last_resort();
    robot
}

#[test]
fn as_a_last_resort_a_robot_bids_if_its_links_hold_where_it_would_service_the_task() {
    let bids = |task: Point, post: Post| {
        let robot = asked_with_post(task, post);
        let announcement = robot.announcement().cloned().expect("it knows the task");
        robot.leader_bid(&announcement, 0).is_some()
    };
    let hard = robot().hard_length();
    assert!(bids(north(1.0), fixed(30, 13)));
    assert!(!bids(north(hard + 0.2), fixed(30, 13)), "neither link would hold");
    assert!(!bids(west(hard - 0.2), fixed(30, 13)), "its child would be out of reach");
    assert!(!bids(east(hard - 0.2), fixed(30, 13)), "its parent would be out of reach");
    let leaf = Post { task: Some(0), ..fixed(30, 13) };
    assert!(!bids(north(1.0), leaf), "it services another task from its post");
}

#[test]
fn a_leader_that_takes_its_post_along_is_not_bound_by_what_depends_on_it() {
    let mut robot = asked_with_post(north(1.0), fixed(30, 13));
    let Duty::Relay(Relay(held)) = *robot.duty else { panic!("it holds a fixed post") };
    robot.duty.is(Duty::Bound(Bound(held)));
    robot.measures();
    assert!(robot.changes.facts().may_leave_post);
    robot.holds(primary(30, None, 13));
    robot.measures();
    assert!(!robot.changes.facts().burdened);
    robot.knows_task(north(1.0));
    robot.measures();
    assert!(robot.changes.facts().burdened, "a robot could relieve it");
}

#[test]
fn where_no_post_can_come_along_the_robot_that_asked_gives_the_task_up() {
    let ends = |asked: bool, bid: Option<Bid>| {
        let mut robot = asked_with_post(north(1.0), fixed(30, 13));
        let (mut id, task) =
            robot.mission.notices().announced().cloned().expect("it knows the task");
        id.issuer = if asked { 0 } else { 4 };
        robot.mission.notices_mut().follow(Some((id, task)));
        let mut election = Election::new(robot.notice_id());
        (0..ROBOTS).for_each(|other| election.place(other, bid.filter(|_| other == 3)));
        robot.mission.is(Mission::LeaderElection(LeaderElection));
        robot.ballot.takes_part_in(election);
        next_phase(&mut robot);
        matches!(robot.notice(), Notice::Ended { outcome: Outcome::InsufficientRobots, .. })
    };
    assert!(ends(true, None));
    assert!(!ends(false, None), "it is the robot that asked who says so");
    assert!(!ends(true, Some(Bid { rank: 2, merit: -1, economy: 0 })));
}
