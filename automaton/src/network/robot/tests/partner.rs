//! With which robot in its way a mover exchanges duties.

use pleach_discrete::network::{Offer, Reply};

use super::*;
use crate::network::beacon::TeamReport;
use crate::network::robot::{ExchangeEffect, Facts};
use crate::network::roll::Absent;
use crate::network::scenario::Strategy;

/// The leader, which has not got on for this long, 0.09 west of a parked robot that bears `held`; the
/// task is far to the east.
fn stuck(periods: u32) -> Robot {
    stuck_by(Strategy::default(), periods)
}

fn stuck_by(strategy: Strategy, periods: u32) -> Robot {
    let mut scenario = hall();
    scenario.control.strategy = Some(strategy);
    let mut robot = robot_of(&scenario);
    robot.holds(primary(30, None, 13));
    robot.advances_to(east(3.0));
    robot.body.waits(periods);
    robot.hears(beacon(5, west(0.5), fixed(13, 14), &[13, 14]));
    robot
}

fn partner(robot: &mut Robot) -> Option<NodeId> {
    robot.measures();
    robot.consider_exchange();
    robot.exchanges.partner()
}

fn parked(away: f64) -> Beacon {
    beacon(1, east(away), redundant(11, 13), &[11, 13, 14])
}

impl Robot {
    /// It has exchanged duties with this robot.
    fn remember_partner(&mut self, partner: NodeId) {
        let progress = self.progress();
        self.exchanges.conclude(partner, progress);
    }

    /// This robot has refused its offer.
    fn remember_refusal(&mut self, partner: NodeId) {
        let progress = self.progress();
        self.exchanges.carry_out(ExchangeEffect::Refused(partner), progress);
    }
}

/// As near as two robots come.
const BESIDE: f64 = 2.0 * CLEARANCE;

#[test]
fn a_mover_that_gets_on_or_has_waited_too_little_looks_for_no_partner() {
    for (periods, expected) in [(0, None), (1, None), (2, Some(1)), (30, Some(1))] {
        let mut robot = stuck(periods);
        robot.hears(parked(BESIDE));
        assert_eq!(partner(&mut robot), expected, "{periods}");
    }
}

/// It would take the other one for lost as soon as that is gone, and begin again.
#[test]
fn a_robot_that_does_not_take_part_is_no_partner() {
    let robots = || [1].into_iter().collect();
    let absent = [
        Absent::default(),
        Absent { suspended: robots(), ..Absent::default() },
        Absent { gone: robots(), ..Absent::default() },
    ];
    let found = absent.map(|absent| {
        let mut robot = stuck(5);
        robot.membership.lacks(absent);
        robot.hears(parked(BESIDE));
        partner(&mut robot)
    });
    assert_eq!(found, [Some(1), None, None]);
}

#[test]
fn partners_are_in_contact() {
    let contact = 2.6 * CLEARANCE;
    for (away, expected) in [(contact - LITTLE, Some(1)), (contact + LITTLE, None)] {
        let mut robot = stuck(5);
        robot.hears(parked(away));
        assert_eq!(partner(&mut robot), expected, "{away}");
    }
    let at_last = |away: f64| {
        let mut robot = stuck(10);
        robot.hears(parked(away * CLEARANCE));
        partner(&mut robot)
    };
    assert_eq!((at_last(4.0 - LITTLE), at_last(4.0 + LITTLE)), (Some(1), None), "a last resort");
}

/// The goal is far to the east, so that a robot in the north is nearer by as much as it is farther east.
#[test]
fn a_partner_is_nearer_to_the_goal_or_at_last_a_little_farther() {
    let gain = |nearer: f64| {
        let goal = east(3.0);
        // On the circle about the goal.
        let turn = BESIDE / (3.0 - nearer);
        goal + Vector::new(-turn.cos(), turn.sin()) * (3.0 - nearer)
    };
    let finds = |periods: u32, nearer: f64| {
        let mut robot = stuck(periods);
        let at = gain(nearer);
        assert!((at - HERE).norm() < 2.6 * CLEARANCE);
        robot.hears(beacon(1, at, redundant(11, 13), &[11, 13, 14]));
        partner(&mut robot).is_some()
    };
    let least = 0.05 * CLEARANCE;
    assert!(finds(5, least + LITTLE) && !finds(5, least - LITTLE));
    assert!(!finds(9, -0.01) && finds(10, -0.01), "a last resort");
    let mut robot = stuck(10);
    robot.hears(beacon(1, west(2.5 * CLEARANCE), redundant(11, 13), &[11, 13, 14]));
    assert_eq!(partner(&mut robot), Some(1), "four clearances farther are conceded");
}

#[test]
fn of_two_the_nearer_to_the_goal_is_the_partner() {
    for (one, other, expected) in [(BESIDE, 0.09, 2), (0.09, BESIDE, 1)] {
        let mut robot = stuck(5);
        robot.hears(beacon(1, east(one), redundant(11, 13), &[11, 13, 14]));
        robot.hears(beacon(2, east(other), redundant(12, 13), &[12, 13, 14]));
        assert_eq!(partner(&mut robot), Some(expected));
    }
}

/// Not even where that is nearer: three robots, none of which can go on, do not hand a duty round without end, nor two
/// to and fro.
#[test]
fn no_robot_exchanges_back_to_where_it_came_from() {
    let back = |partners: &[NodeId]| {
        let mut robot = stuck(10);
        partners.iter().for_each(|&partner| robot.remember_partner(partner));
        robot.hears(beacon(1, west(BESIDE), redundant(11, 13), &[11, 13, 14]));
        partner(&mut robot)
    };
    assert_eq!((back(&[]), back(&[2]), back(&[1])), (Some(1), Some(1), None));
    assert_eq!(back(&[1, 2]), None, "another exchange between does not count");
    let mut robot = stuck(10);
    robot.remember_partner(1);
    robot.hears(parked(BESIDE));
    assert_eq!(partner(&mut robot), None, "although it is nearer");
}

#[test]
fn a_robot_that_has_refused_is_asked_again_after_all_others() {
    let mut robot = stuck(5);
    robot.hears(beacon(1, east(0.09), redundant(11, 13), &[11, 13, 14]));
    robot.hears(beacon(2, east(BESIDE), redundant(12, 13), &[12, 13, 14]));
    let nearest = partner(&mut robot).expect("there are two");
    robot.remember_refusal(nearest);
    let other = partner(&mut robot).expect("there is another");
    assert_ne!(other, nearest);
    robot.remember_refusal(other);
    assert_eq!(partner(&mut robot), Some(nearest), "both have refused");
    robot.is_told(Notice::Advance { joined: None });
    assert_eq!(partner(&mut robot), Some(nearest));
}

#[test]
fn with_another_notice_it_may_exchange_with_the_same_robots_again() {
    let mut robot = stuck(10);
    robot.remember_partner(1);
    robot.is_told(Notice::Advance { joined: None });
    robot.hears(beacon(1, west(BESIDE), redundant(11, 13), &[11, 13, 14]));
    assert_eq!(partner(&mut robot), Some(1));
}

#[test]
fn a_partner_is_parked_and_has_no_exchange_of_its_own() {
    let duty = holding(redundant(11, 13), east(BESIDE));
    let reply = Reply { to: 3, number: 1, accepted: None };
    let busy = [
        Beacon { parked: false, ..parked(BESIDE) },
        Beacon { offer: Some(Offer { to: 3, number: 1, duty }), ..parked(BESIDE) },
        Beacon { reply: Some(reply), ..parked(BESIDE) },
        Beacon { duty: None, ..parked(BESIDE) },
    ];
    for beacon in busy {
        let mut robot = stuck(5);
        robot.hears(beacon.clone());
        assert_eq!(partner(&mut robot), None, "{beacon:?}");
    }
}

/// A fixed post is taken over only within δ of it, and of the task that is serviced there.
#[test]
fn a_mover_could_do_what_the_parked_robot_does() {
    let takes = |reference: Point, task: Option<usize>| {
        let mut robot = stuck(5);
        let place = Post { task, ..fixed(11, 13) };
        let duty = Some(holding(place, reference));
        robot.hears(Beacon { duty, ..parked(BESIDE) });
        partner(&mut robot).is_some()
    };
    assert!(takes(east(SERVICE_RADIUS - LITTLE), None));
    assert!(!takes(east(SERVICE_RADIUS + LITTLE), None));
    assert!(!takes(east(BESIDE), Some(0)), "the task is far");
    let mut robot = stuck(5);
    robot.hears(Beacon {
        duty: Some(holding(redundant(11, 13), east(4.0 * SERVICE_RADIUS))),
        ..parked(BESIDE)
    });
    assert_eq!(partner(&mut robot), Some(1), "a redundant robot may be anywhere");
}

#[test]
fn links_of_both_hold_when_they_have_exchanged() {
    let hard = robot().hard_length();
    let with = |own_parent: f64, parent: f64, child: f64| {
        let mut robot = robot();
        robot.holds(primary(30, None, 13));
        robot.advances_to(east(3.0));
        robot.body.waits(5);
        robot.hears(beacon(5, north(own_parent), fixed(13, 14), &[13, 14]));
        robot.hears(beacon(4, south(parent), fixed(15, 14), &[15, 14]));
        robot.hears(beacon(1, east(BESIDE), redundant(11, 15), &[11, 15, 14]));
        robot.hears(beacon(2, west(child), redundant(12, 11), &[12, 11, 15, 14]));
        partner(&mut robot).is_some()
    };
    assert!(with(1.0, hard - LITTLE, 1.0));
    assert!(!with(1.0, hard + LITTLE, 1.0), "its parent is too far from the mover");
    assert!(with(1.0, 1.0, hard - LITTLE));
    assert!(!with(1.0, 1.0, hard + LITTLE), "its child is too far from the mover");
    let diagonal = |away: f64| (away * away - BESIDE * BESIDE).sqrt();
    assert!(with(diagonal(hard - LITTLE), 1.0, 1.0));
    assert!(!with(diagonal(hard + LITTLE), 1.0, 1.0), "the mover's parent is too far from it");
    let orphan = |parent: Option<NodeId>| {
        let mut robot = stuck(5);
        robot.hears(Beacon { parent, ..beacon(1, east(BESIDE), redundant(11, 99), &[11, 99]) });
        partner(&mut robot)
    };
    assert_eq!(orphan(None), None, "nobody holds the post of its parent");
    assert_eq!(orphan(Some(0)), Some(1), "the mover stands for it, and the other will");
}

/// Robot 3 may exchange duties with the mover's parent in the same instant: then it stands for the parent.
#[test]
fn no_partner_is_taken_if_a_robot_beside_the_parent_would_be_out_of_reach() {
    let hard = robot().hard_length();
    let diagonal = |away: f64| (away * away - BESIDE * BESIDE).sqrt();
    let beside_parent = |beyond: f64, post: Post| {
        let mut robot = robot();
        robot.holds(primary(30, None, 13));
        robot.advances_to(east(3.0));
        robot.body.waits(5);
        let parent = diagonal(hard) - 0.1;
        robot.hears(beacon(5, north(parent), fixed(13, 14), &[13, 14]));
        robot.hears(parked(BESIDE));
        robot.hears(beacon(3, north(parent + beyond), post, &[]));
        robot
    };
    let with = |beyond: f64, post: Post| partner(&mut beside_parent(beyond, post));
    let other = redundant(12, 14);
    assert_eq!(with(0.1 - LITTLE, other), Some(1));
    assert_eq!(with(0.1 + LITTLE, other), None, "robot 3 would be out of reach");
    let apart = 4.0 * CLEARANCE;
    assert_eq!(with(apart + LITTLE, other), Some(1), "it stands too far from the parent for that");
    assert_eq!(with(apart - LITTLE, other), None);
    let mut robot = beside_parent(0.1 + LITTLE, other);
    let absent = Absent { suspended: [3].into_iter().collect(), ..Absent::default() };
    robot.membership.lacks(absent);
    assert_eq!(partner(&mut robot), Some(1), "it takes no part");
}

/// Robot 0, parked at its post, and a mover beside it that offers it its duty, and that it has yet to hear.
fn parked_and_mover() -> (Robot, Beacon) {
    let mut robot = robot();
    robot.holds(fixed(20, 13));
    robot.knows_task(east(3.0));
    let duty = holding(primary(30, None, 13), west(BESIDE));
    let mut mover = beacon(1, west(BESIDE), primary(30, None, 13), &[30, 13]);
    mover.offer = Some(Offer { to: 0, number: 1, duty });
    mover.announced = robot.mission.notices().announced().cloned();
    (robot, mover)
}

/// The mover need not hear all that are attached to it.
#[test]
fn a_parked_robot_makes_room_only_where_its_own_links_hold() {
    let hard = robot().hard_length();
    let relieved = |child: f64| {
        let (mut robot, mover) = parked_and_mover();
        robot.hears(mover);
        robot.hears(Beacon {
            parent: Some(0),
            ..beacon(2, east(child - BESIDE), fixed(21, 20), &[21, 20, 13])
        });
        robot.may_be_relieved()
    };
    assert!(relieved(hard - LITTLE) && !relieved(hard + LITTLE));
}

/// The mover's parent has gone on since the mover chose its partner, or is not heard from here; or a robot that is attached
/// to the mover has gone on. Which other robots the mover hears does not matter.
#[test]
fn a_parked_robot_makes_room_only_where_it_reaches_what_the_mover_is_linked_to() {
    let hard = robot().hard_length();
    let relieved = |parent: Option<(NodeId, f64)>, child: f64, others: &[(NodeId, Point)]| {
        let (mut robot, mut mover) = parked_and_mover();
        mover.parent = Some(parent.map_or(5, |(parent, _)| parent));
        robot.hears(mover);
        if let Some((5, away)) = parent {
            robot.hears(beacon(5, west(away), fixed(13, 14), &[13, 14]));
        }
        let attached = beacon(2, west(child), primary(31, Some(30), 30), &[31, 30, 13]);
        robot.hears(Beacon { parent: Some(1), ..attached });
        for &(other, place) in others {
            robot.hears(beacon(other, place, redundant(40 + other as u32, 14), &[]));
        }
        robot.may_be_relieved()
    };
    assert!(relieved(Some((5, hard - LITTLE)), 0.5, &[]));
    assert!(!relieved(Some((5, hard + LITTLE)), 0.5, &[]) && !relieved(None, 0.5, &[]));
    assert!(!relieved(Some((5, 0.5)), hard + LITTLE, &[]), "the robot attached to it");
    assert!(relieved(Some((0, 0.0)), 0.5, &[]), "it is attached to this robot");
    assert!(relieved(Some((5, 0.5)), 0.5, &[(3, north(hard + LITTLE))]), "of no concern");
    let beside = [(3, west(hard + LITTLE))];
    assert!(!relieved(Some((5, hard - LITTLE)), 0.5, &beside), "it may stand for the parent");
}

#[test]
fn only_robots_on_a_way_hand_their_duty_over() {
    let mut posted = stuck(5);
    posted.hears(parked(BESIDE));
    posted.holds(fixed(30, 13));
    assert_eq!(partner(&mut posted), None);
    let mut resting = stuck(5);
    resting.hears(parked(BESIDE));
    resting.mission.is(Mission::Idle(super::super::super::mission::Idle));
    assert_eq!(partner(&mut resting), None, "the team does not move now");
    let mut follower = stuck(5);
    follower.hears(beacon(3, east(1.0), primary(31, None, 30), &[31, 30]));
    follower.hears(parked(BESIDE));
    follower.holds(primary(30, Some(31), 13));
    assert_eq!(partner(&mut follower), Some(1));
}

/// With the eager strategy the team goes on while subgroups shift, so that a robot on Σ may be in its way.
#[test]
fn a_team_that_goes_on_hands_over_to_parked_robots_that_are_not_of_it() {
    let finds = |strategy: Strategy, post: Post| {
        let mut robot = stuck_by(strategy, 5);
        let path = Arc::new(Path { hops: Vec::new(), releases_leader: false });
        let shift = Shift { path, subgroups: Arc::default(), arrived: 0 };
        robot.mission.is(Mission::Shift(shift));
        robot.hears(Beacon { parked: true, ..beacon(1, east(BESIDE), post, &[11, 13]) });
        partner(&mut robot)
    };
    assert_eq!(finds(Strategy::Eager, redundant(11, 13)), Some(1));
    assert_eq!(finds(Strategy::Paper, redundant(11, 13)), None);
    assert_eq!(finds(Strategy::Eager, primary(11, Some(30), 13)), None);
}

/// For a round both hold the post of the one that gives it: it is held by none that relieves the other.
#[test]
fn a_robot_that_is_being_given_a_post_is_not_relieved_of_it() {
    let relieved = |reply: Option<Reply<Duty>>| {
        let mut robot = robot();
        robot.holds(fixed(20, 13));
        let giver = beacon(1, east(BESIDE), fixed(20, 13), &[20, 13]);
        robot.hears(Beacon { reply, ..giver });
        robot.is_relieved_of(PostId(20))
    };
    let reply = |to: NodeId, accepted: Option<Duty>| Some(Reply { to, number: 1, accepted });
    let duty = holding(fixed(20, 13), east(BESIDE));
    assert!(relieved(None));
    assert!(!relieved(reply(0, Some(duty))));
    assert!(relieved(reply(0, None)), "it has refused");
    assert!(relieved(reply(2, Some(duty))), "it gives it to another");
}

/// The other would stand where it does not want to stay.
#[test]
fn a_member_that_makes_way_for_the_team_looks_for_no_partner() {
    let follower = |way: Option<Point>| {
        let mut robot = stuck(5);
        robot.holds(primary(30, Some(31), 13));
        let report = |members: u32| Some(TeamReport { members, ..team::report(5, None, None) });
        robot.mission.team_mut().review(report(2));
        let ahead = beacon(2, east(2.05 * CLEARANCE), primary(31, None, 30), &[31, 30, 13]);
        robot.hears(Beacon { way, team: report(1), ..ahead });
        robot
    };
    let mut follows = follower(None);
    follows.hears(parked(BESIDE));
    assert_eq!(partner(&mut follows), Some(1));
    let mut makes_way = follower(Some(west(1.0)));
    let aside = makes_way.place_aside().expect("there is room") - HERE;
    let beside = HERE + BESIDE * aside.normalize();
    makes_way.hears(beacon(1, beside, redundant(11, 13), &[11, 13, 14]));
    assert_eq!(partner(&mut makes_way), None);
}

/// Two members of one team, which both mean to move, stand in the wrong order in a narrow corridor.
#[test]
fn a_member_that_stands_behind_is_a_partner() {
    let report =
        |members: u32, still: u32| Some(TeamReport { members, ..team::report(still, None, None) });
    let beside = |own: u32, other: u32, still: u32| {
        let mut robot = stuck(5);
        robot.mission.team_mut().review(report(own, 5));
        let team = report(other, still);
        robot.hears(Beacon {
            team,
            ..beacon(1, east(BESIDE), primary(31, Some(30), 13), &[31, 13])
        });
        robot
    };
    let finds = |own: u32, other: u32, still: u32| partner(&mut beside(own, other, still));
    let again = |times: usize| {
        let mut robot = beside(1, 2, 4);
        (0..times).for_each(|_| robot.remember_partner(1));
        partner(&mut robot)
    };
    assert_eq!(finds(1, 2, 4), Some(1));
    assert_eq!([1, 2, 3].map(again), [Some(1), Some(1), None]);
    assert_eq!(finds(1, 2, 3), None, "it may go on");
    assert_eq!((finds(2, 1, 9), finds(2, 2, 9)), (None, None), "it is ahead, or level");
    let makes_room = |own: u32, still: u32| {
        let mut robot = robot();
        robot.holds(primary(31, Some(30), 13));
        robot.advances_to(east(3.0));
        robot.mission.team_mut().review(report(own, still));
        let duty = holding(primary(30, None, 31), west(BESIDE));
        let mut mover = beacon(1, west(BESIDE), primary(30, None, 31), &[30, 31, 13]);
        mover.offer = Some(Offer { to: 0, number: 1, duty });
        (mover.announced, mover.team) =
            (robot.mission.notices().announced().cloned(), report(1, 5));
        robot.hears(mover);
        robot.may_be_relieved()
    };
    assert!(makes_room(2, 4));
    assert!(!makes_room(2, 3), "it may go on");
    assert!(!makes_room(1, 4), "it is not behind");
}

#[test]
fn a_parked_robot_makes_room_only_for_a_mover_of_the_same_mission() {
    let relieved = |change: &dyn Fn(&mut Robot, &mut Beacon)| {
        let (mut robot, mut mover) = parked_and_mover();
        change(&mut robot, &mut mover);
        robot.hears(mover);
        robot.may_be_relieved()
    };
    assert!(relieved(&|_, _| {}));
    let away = |ways: f64| relieved(&|_, mover| mover.position = west(ways * CLEARANCE));
    assert!(away(4.0 - LITTLE) && !away(4.0 + LITTLE), "it is too far away");
    assert!(!relieved(&|_, mover| mover.announced = None), "it goes by no announcement");
    assert!(
        !relieved(&|robot, _| robot.mission.notices_mut().follow(None)),
        "this one goes by none"
    );
    assert!(
        !relieved(&|robot, _| robot
            .changes
            .sees(Facts { path_announced: true, ..*robot.changes.facts() })),
        "it has yet to learn Σ"
    );
    let moves = |robot: &mut Robot, _: &mut Beacon| {
        robot.holds(primary(20, None, 13));
        robot.mission.is(Mission::Advance(Advance { path: None, in_vain: false }));
    };
    assert!(!relieved(&moves), "it moves itself");
    let on_path = |_: &mut Robot, mover: &mut Beacon| {
        let duty = Duty::Shifting(Shifting { place: 0, left: None });
        mover.offer = Some(Offer { to: 0, number: 1, duty });
        mover.agreement = Some(pleach_discrete::network::Agreement::new(mover.bulletin.id()));
    };
    assert!(!relieved(&on_path), "they are on different paths");
    let on_the_same = |phase: &dyn Fn(Shift) -> Mission| {
        relieved(&|robot, mover| {
            on_path(robot, mover);
            robot.ballot.agree(mover.agreement.clone());
            let path = Arc::new(Path { hops: Vec::new(), releases_leader: false });
            let shift = Shift { path, subgroups: Arc::default(), arrived: 0 };
            robot.mission.is(phase(shift));
        })
    };
    assert!(on_the_same(&Mission::Shift));
    let ended = |_| Mission::Ended(Ended { walk: None });
    assert!(
        !on_the_same(&ended),
        "it has heard that the mission has ended: nobody walks on Σ any more"
    );
    let offer = relieved(&|_, mover| mover.offer = None);
    assert!(offer, "nobody asks");
}
