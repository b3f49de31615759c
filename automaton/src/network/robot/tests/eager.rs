//! Recruits that are called for ahead of a standstill, and what the primary team does meanwhile.

use pleach_discrete::network::{Agreement, Election, Phase};

use super::*;
use crate::network::beacon::TeamReport;
use crate::network::duty::{Hop, PathPlace};
use crate::network::scenario::Strategy;

/// The strategy of the team.
fn following(strategy: Strategy) -> Robot {
    let mut scenario = hall();
    scenario.control.strategy = Some(strategy);
    robot_of(&scenario)
}

/// Robot 0 leads alone, half a unit east of the robot that it is attached to, to a task so far away.
fn leader(strategy: Strategy, away: f64) -> Robot {
    let mut robot = following(strategy);
    robot.holds(primary(30, None, 13));
    robot.advances_to(east(away));
    robot.hears(beacon(5, west(0.5), fixed(13, 14), &[13, 14]));
    robot.review_team();
    robot
}

/// How far away the task may be that a leader alone reaches.
fn reach_alone() -> f64 {
    let robot = leader(Strategy::Eager, 1.0);
    robot.hard_length() + robot.reach() - 0.5
}

#[test]
fn a_recruit_is_called_for_ahead_exactly_where_links_cannot_reach_the_task() {
    let phase = |strategy, away| next_phase(&mut leader(strategy, away));
    let reach = reach_alone();
    assert_eq!(phase(Strategy::Eager, reach - LITTLE), Phase::Advance);
    assert_eq!(phase(Strategy::Eager, reach + LITTLE), Phase::RecruitElection);
    assert_eq!(phase(Strategy::Paper, reach + LITTLE), Phase::Advance, "it does not stand still");
}

/// Each member adds a link, and only p₁ calls.
#[test]
fn a_team_reaches_as_many_links_as_it_has_members() {
    let phase = |away: f64, members: u32, change: &dyn Fn(&mut Robot)| {
        let mut robot = leader(Strategy::Eager, away);
        let report = robot.mission.team().report().expect("it leads");
        robot.mission.team_mut().review(Some(TeamReport { members, ..report }));
        change(&mut robot);
        next_phase(&mut robot)
    };
    let reach = reach_alone() + robot().hard_length();
    assert_eq!(phase(reach - LITTLE, 2, &|_| ()), Phase::Advance);
    assert_eq!(phase(reach + LITTLE, 2, &|_| ()), Phase::RecruitElection);
    let is_followed = |robot: &mut Robot| robot.mission.team_mut().follow(Some(PostId(30)));
    assert_eq!(phase(reach + LITTLE, 2, &is_followed), Phase::Advance, "it is not p₁");
    let knows_no_team = |robot: &mut Robot| robot.mission.team_mut().review(None);
    assert_eq!(phase(reach + LITTLE, 2, &knows_no_team), Phase::Advance);
}

#[test]
fn nothing_is_foreseen_while_p1_may_come_to_attach_elsewhere() {
    let phase = |other: Beacon| {
        let mut robot = leader(Strategy::Eager, reach_alone() + 1.0);
        robot.hears(other);
        next_phase(&mut robot)
    };
    let far = robot().build_length() + LITTLE;
    let node = |place| beacon(2, place, fixed(12, 14), &[12, 14]);
    assert_eq!(phase(node(east(far))), Phase::Advance, "it is nearer to the task, and may bear it");
    assert_eq!(phase(node(west(0.6))), Phase::RecruitElection, "it is no nearer to the task");
    let child = beacon(2, east(0.5), redundant(21, 30), &[21, 30, 13, 14]);
    assert_eq!(phase(child), Phase::Advance, "a redundant robot has yet to leave it");
}

/// No robot of the roster can come, as their tokens say.
fn caller(ahead: bool) -> Robot {
    let mut robot = leader(Strategy::Eager, reach_alone() + 1.0);
    robot.is_told(Notice::Call { caller: 0, releases_leader: false });
    robot.mission.notices_mut().set_stretched(true);
    robot.seeks_recruit(ahead, true);
    let mut election = Election::new(robot.notice_id());
    (0..ROBOTS).for_each(|other| election.place(other, None));
    robot.ballot.takes_part_in(election);
    robot
}

#[test]
fn a_call_ahead_that_is_in_vain_ends_nothing_and_is_not_repeated() {
    let mut robot = caller(true);
    assert_eq!(next_phase(&mut robot), Phase::RecruitElection);
    assert_eq!(*robot.notice(), Notice::Advance { joined: None });
    assert_eq!(next_phase(&mut robot), Phase::Advance);
    robot.review_team();
    assert_eq!(next_phase(&mut robot), Phase::Advance, "it goes on without another call");
    let mut stuck = caller(false);
    next_phase(&mut stuck);
    let is_last_resort =
        |notice: &Notice| matches!(notice, Notice::Task(task) if task.last_resort.is_some());
    assert!(is_last_resort(stuck.notice()), "it stood still when it called");
}

/// One that did not call may take over the duty of the caller in an exchange, and would call again, without end.
#[test]
fn a_call_ahead_that_is_in_vain_is_repeated_by_nobody() {
    let mut robot = leader(Strategy::Eager, reach_alone() + 1.0);
    robot.is_told(Notice::Call { caller: 1, releases_leader: false });
    robot.seeks_recruit(false, false);
    robot.is_told(Notice::Advance { joined: None });
    assert_eq!(next_phase(&mut robot), Phase::Advance);
    robot.review_team();
    assert_eq!(next_phase(&mut robot), Phase::Advance, "it goes on without another call");
}

/// Robots that could not come may come now.
#[test]
fn a_team_whose_links_have_been_stretched_calls_ahead_again() {
    let next = |stretched_before: bool| {
        let mut robot = leader(Strategy::Eager, reach_alone() + 1.0);
        robot.is_told(Notice::Call { caller: 1, releases_leader: false });
        robot.seeks_recruit(false, stretched_before);
        robot.mission.notices_mut().set_stretched(true);
        robot.is_told(Notice::Advance { joined: None });
        assert_eq!(next_phase(&mut robot), Phase::Advance);
        robot.mission.has_called_in_vain()
    };
    assert_eq!([false, true].map(next), [false, true]);
}

#[test]
fn the_team_goes_on_while_a_recruit_is_sought() {
    let goal = |strategy, away: f64| {
        let mut robot = leader(strategy, away);
        robot.seeks_recruit(false, false);
        robot.measures();
        robot.goal()
    };
    assert_eq!(goal(Strategy::Eager, 3.0), Some(east(3.0)));
    assert_eq!(goal(Strategy::Paper, 3.0), None, "it waits");
    let reach = robot().site.settings.leash_radius() - 2.2 * CLEARANCE;
    assert_eq!(goal(Strategy::Eager, reach - LITTLE), None, "its task is within reach");
}

/// One that goes on is no robot to exchange duties with.
#[test]
fn a_member_that_goes_on_is_parked_once_it_stands_still() {
    let is_parked = |strategy, still: u32| {
        let mut robot = leader(strategy, 3.0);
        robot.seeks_recruit(false, false);
        robot.body.waits(still);
        robot.is_parked()
    };
    assert_eq!([0, 3, 4].map(|still| is_parked(Strategy::Eager, still)), [false, false, true]);
    assert!(is_parked(Strategy::Paper, 0));
}

/// p₁ and the newcomer both move: what p₁ heard of it earlier is no place to attach to.
#[test]
fn p1_attaches_to_a_newcomer_that_it_hears() {
    let attaches = |strategy, silent: bool| {
        let mut robot = leader(strategy, 3.0);
        robot.is_told(Notice::Advance { joined: Some((PostId(40), PostId(30))) });
        robot.hears(beacon(2, west(0.6), primary(40, Some(30), 14), &[40, 14]));
        robot.end_round();
        if silent {
            robot.end_round();
        }
        robot.keep_place().expect("it goes on");
        robot.tree.desired_parent() == Some(Some(Anchor::Post(PostId(40))))
    };
    assert!(attaches(Strategy::Eager, false));
    assert!(!attaches(Strategy::Eager, true));
    assert!(attaches(Strategy::Paper, true), "the newcomer comes up to a robot that stands");
}

/// Σ has crossed the access point: the newcomer does not hear p₁, which has gone on since it called.
#[test]
fn a_newcomer_looks_for_p1_where_that_is_attached() {
    let goal = |strategy| {
        let mut robot = following(strategy);
        robot.holds(primary(40, Some(30), 13));
        robot.advances_to(east(3.0));
        let post = Post { parent: Some(Anchor::Access(0)), ..primary(30, None, 13) };
        let place = PathPlace { reference: north(3.0), position: north(3.0) };
        let caller = Hop { robot: 1, post, place, crossing: Vec::new() };
        let path = Path { hops: vec![caller], releases_leader: false };
        let advance = Advance { path: Some(Arc::new(path)), in_vain: false };
        robot.mission.is(Mission::Advance(advance));
        robot.team_goal()
    };
    assert_eq!(goal(Strategy::Paper), Some(north(3.0)));
    assert_eq!(goal(Strategy::Eager), Some(Point::new(1.0, 2.0)));
}

/// The next call, or the service of the task, may be the first that a robot hears after its subgroup has arrived.
#[test]
fn a_robot_on_its_way_takes_the_post_ahead_whatever_follows_the_advance() {
    let told = |strategy, notice: Notice| {
        let mut robot = following(strategy);
        let hop = |robot, post| {
            let place = PathPlace { reference: HERE, position: HERE };
            Hop { robot, post, place, crossing: Vec::new() }
        };
        let hops =
            vec![hop(0, redundant(0, 11)), hop(1, fixed(11, 13)), hop(5, primary(30, None, 11))];
        let path = Arc::new(Path { hops, releases_leader: false });
        robot.advances_to(east(3.0));
        let shift = Shift { path, subgroups: Arc::default(), arrived: 0 };
        robot.mission.is(Mission::Shift(shift));
        robot.duty.is(Duty::Shifting(Shifting { place: 0, left: None }));
        let mut agreement = Agreement::new(robot.notice_id());
        agreement.arrive(0);
        agreement.give_up(1);
        robot.ballot.agree(Some(agreement));
        robot.is_told(notice);
        let phase = next_phase(&mut robot);
        (phase, robot.duty.post().map(|post| post.id))
    };
    let call = || Notice::Call { caller: 5, releases_leader: false };
    assert_eq!(told(Strategy::Eager, call()), (Phase::RecruitElection, Some(PostId(11))));
    assert_eq!(told(Strategy::Paper, call()), (Phase::Shift, None));
    for strategy in [Strategy::Eager, Strategy::Paper] {
        let serviced = told(strategy, Notice::Serviced { task: 0 });
        assert_eq!(serviced, (Phase::Idle, Some(PostId(11))), "{strategy:?}");
    }
}

/// The newcomer goes to where the link of p₁ leads.
#[test]
fn the_first_of_the_team_keeps_its_parent_until_it_is_attached_to_the_newcomer() {
    let attached = |strategy, newcomer: Option<Beacon>| {
        let mut robot = following(strategy);
        robot.holds(primary(30, None, 11));
        robot.advances_to(east(4.0));
        robot.is_told(Notice::Advance { joined: Some((PostId(40), PostId(30))) });
        robot.hears(beacon(1, west(1.0), fixed(11, 13), &[11, 13]));
        robot.hears(beacon(2, east(0.5), fixed(12, 13), &[12, 13]));
        newcomer.into_iter().for_each(|beacon| robot.hears(beacon));
        robot.keep_place().expect("it goes on");
        robot.tree.desired_parent().flatten()
    };
    let at = |post| Some(Anchor::Post(PostId(post)));
    let newcomer = |away| Some(beacon(3, west(away), primary(40, None, 11), &[40, 11, 13]));
    assert_eq!(attached(Strategy::Eager, None), None);
    assert_eq!(attached(Strategy::Eager, newcomer(1.9)), None, "it is too far away");
    assert_eq!(attached(Strategy::Eager, newcomer(0.5)), at(40));
    assert_eq!(attached(Strategy::Paper, None), at(12), "the newcomer comes up to it");
}
