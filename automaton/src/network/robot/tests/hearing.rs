//! What becomes of what a robot hears, and of those that it does not hear any more.

use pleach_continuous::Vector;
use pleach_discrete::network::Stage;

use super::*;
use crate::network::robot::hearing::{PATIENCE_WITH_CHILDREN, ROUNDS_TO_BE_HEARD};
use crate::network::robot::schedule::Schedule;
use crate::network::roll::Absent;
use crate::node::{Node as _, Outputs};

/// A round passes in which robots send, and this robot hears nobody.
fn silent_rounds(robot: &mut Robot, rounds: usize) {
    for _ in 0..rounds {
        robot.schedule.count_rounds_anew();
        robot.schedule.pass_rounds(1);
        robot.end_round();
    }
}

fn hears(robot: &Robot) -> Vec<NodeId> {
    robot.audible().map(|(id, _)| id).collect()
}

fn watch_radius(robot: &Robot) -> f64 {
    let is_near = |at: &f64| robot.site.is_near(*at);
    (0..20_000).map(|step| f64::from(step) * 1e-4).take_while(is_near).last().expect("it watches")
}

#[test]
fn a_robot_far_away_that_falls_silent_is_out_of_range_after_three_rounds() {
    let mut robot = robot();
    let far = watch_radius(&robot) + 0.1;
    robot.hears(beacon(1, east(far), redundant(11, 12), &[]));
    silent_rounds(&mut robot, 1); // the round in which it was heard
    silent_rounds(&mut robot, ROUNDS_TO_BE_HEARD - 1);
    assert_eq!(robot.audible().collect::<Vec<_>>(), [(1, ROUNDS_TO_BE_HEARD as u8 - 1)]);
    robot.changes.settle();
    silent_rounds(&mut robot, 1);
    assert!(hears(&robot).is_empty());
    assert!(robot.changes.are_news(), "it is news that a robot is out of range");
    assert_eq!(robot.membership.noted().iter().map(|seen| seen.robot).collect::<Vec<_>>(), [1]);
}

#[test]
fn a_robot_nearby_that_falls_silent_is_taken_to_stay() {
    let mut robot = robot();
    robot.hears(beacon(1, east(0.2), redundant(11, 12), &[]));
    robot.hears(access_point(west(0.2)));
    silent_rounds(&mut robot, 10);
    assert_eq!(robot.audible().collect::<Vec<_>>(), [(1, ROUNDS_TO_BE_HEARD as u8)]);
    assert!(robot.neighbour(1).expect("it is kept").is_silent());
}

/// It has granted them.
#[test]
fn a_robot_that_is_called_gone_stays_in_sight_as_long_as_packets_flow_to_it() {
    let mut robot = robot();
    robot.hears(beacon(1, east(0.2), redundant(11, 12), &[]));
    robot.sends(1, 0.1);
    let gone = [1].into_iter().collect();
    robot.membership.lacks(Absent { gone, ..Absent::default() });
    silent_rounds(&mut robot, 10);
    assert_eq!(hears(&robot), [1]);
    robot.sends(1, 0.0);
    silent_rounds(&mut robot, 1);
    assert!(hears(&robot).is_empty(), "nothing is left of the lease");
}

#[test]
fn a_robot_attached_to_this_one_is_waited_for_for_some_periods() {
    let mut robot = robot();
    robot.holds(fixed(20, 13));
    let far = watch_radius(&robot) + 0.1;
    robot.hears(beacon(1, east(far), redundant(11, 20), &[]));
    silent_rounds(&mut robot, 10);
    robot.schedule.is_in(NOW + PATIENCE_WITH_CHILDREN);
    silent_rounds(&mut robot, 1);
    assert_eq!(hears(&robot), [1]);
    robot.schedule.is_in(robot.schedule.period() + 1);
    silent_rounds(&mut robot, 1);
    assert!(hears(&robot).is_empty());
}

#[test]
fn silence_counts_only_in_rounds_in_which_all_send() {
    let mut robot = robot();
    robot.hears(beacon(1, east(1.9), redundant(11, 12), &[]));
    for _ in 0..10 {
        robot.schedule.count_rounds_anew();
        robot.schedule.pass_rounds(ROUNDS_TO_BE_HEARD + 1);
        robot.end_round();
    }
    assert_eq!(robot.audible().collect::<Vec<_>>(), [(1, 0)]);
    for _ in 0..2 {
        robot.schedule.count_rounds_anew();
        robot.schedule.pass_rounds(ROUNDS_TO_BE_HEARD);
        robot.end_round();
    }
    assert_eq!(robot.audible().collect::<Vec<_>>(), [(1, 2)]);
}

/// The other one was heard in the round before, the robot stands elsewhere than when it measured the link, or it
/// takes the other one to have stopped.
#[test]
fn silence_is_news_where_it_changes_what_the_robot_knows() {
    let mut robot = robot();
    robot.hears(beacon(1, east(0.2), redundant(11, 12), &[]));
    silent_rounds(&mut robot, 1);
    let is_news = |robot: &mut Robot| {
        robot.changes.settle();
        silent_rounds(robot, 1);
        robot.changes.are_news()
    };
    assert!(is_news(&mut robot), "it was heard a round ago");
    robot.body.is_at(west(0.1));
    assert!(is_news(&mut robot), "the link is longer now");
    assert!(is_news(&mut robot), "it is silent now");
    assert!(!is_news(&mut robot), "it has been silent before");
}

#[test]
fn a_robot_that_has_gone_out_of_range_is_forgotten_at_once() {
    let mut robot = robot();
    robot.hears(beacon(1, east(1.5), redundant(11, 12), &[]));
    silent_rounds(&mut robot, 1);
    robot.body.is_at(west(0.6));
    silent_rounds(&mut robot, 1);
    assert!(hears(&robot).is_empty(), "2.1 away, and links reach 2");
}

#[test]
fn old_messages_are_ignored() {
    let mut robot = robot();
    let old = Arc::new(beacon(1, east(0.5), redundant(11, 12), &[]));
    robot.hear_beacon(NOW - 1, None, &old);
    assert!(hears(&robot).is_empty(), "it was sent in an earlier period");
    let new = Beacon { offers_made: 2, ..beacon(1, east(0.6), redundant(11, 12), &[]) };
    robot.hears(new);
    robot.hear_beacon(NOW, None, &old);
    let known = robot.neighbour(1).expect("it is heard");
    assert_eq!(known.beacon.offers_made, 2, "a newer one has been heard");
    assert!((known.distance - 0.6).abs() < 1e-12);
}

#[test]
fn a_robot_that_begins_later_than_others_learns_which_period_this_is() {
    let mut late = robot();
    late.schedule = Schedule::default();
    let heard = Arc::new(beacon(1, east(0.5), redundant(11, 12), &[]));
    late.hear_beacon(7, None, &heard);
    assert_eq!((late.schedule.period(), late.duty.is_late()), (7, true));
    late.advance_exchange().expect("its guards have values");
    assert_eq!(
        late.offers().offers_made(),
        7,
        "its next offer is newer than any that it has forgotten"
    );
    let mut first = robot();
    first.schedule = Schedule::default();
    first.hear_beacon(1, None, &heard);
    assert_eq!((first.schedule.period(), first.duty.is_late()), (1, false), "all begin together");
    let mut running = robot();
    running.hear_beacon(NOW + 1, None, &heard);
    assert_eq!(
        (running.schedule.period(), running.duty.is_late()),
        (NOW, false),
        "it is in the period before"
    );
    running.hear_beacon(NOW + 2, None, &Arc::new(beacon(2, west(0.5), redundant(12, 13), &[])));
    assert_eq!(
        (running.schedule.period(), running.duty.is_late()),
        (NOW + 1, true),
        "it has missed one"
    );
    running.advance_exchange().expect("its guards have values");
    assert_eq!(
        running.offers().offers_made(),
        NOW + 1,
        "it may have begun again, and counted periods alone until now"
    );
}

/// A robot whose clock is behind takes its sample when it hears that another has begun the period, wherever its
/// move has taken it.
#[test]
fn a_control_period_begins_when_the_first_clock_is_due() {
    let mut robot = robot();
    robot.body.is_moving_by(east(0.1) - HERE);
    robot.flow(0.25);
    let place = robot.body.position();
    let heard = Arc::new(beacon(1, east(0.5), redundant(11, 12), &[]));
    robot.hear_beacon(NOW, None, &heard);
    assert_eq!(robot.time_to_tick(), Some(0.25));
    robot.hear_beacon(NOW + 1, None, &heard);
    assert_eq!(robot.time_to_tick(), Some(0.0));
    robot.tick(0, &mut Outputs::of(0)).expect("it goes on");
    assert_eq!(
        (robot.schedule.period(), robot.stage(), robot.body.position()),
        (NOW + 1, Stage::Beacons, place)
    );
    assert!(!robot.schedule.is_behind() && robot.body.clock() == 0.0);
}

#[test]
fn the_same_beacon_again_is_no_news_unless_its_sender_was_absent_or_brings_a_confirmation() {
    let mut robot = robot();
    let heard = Arc::new(beacon(1, east(0.5), redundant(11, 12), &[]));
    let is_news = |robot: &mut Robot, period: u32, confirmed: Option<u32>, hint: u32| {
        robot.schedule.is_in(period);
        robot.changes.settle();
        robot.neighbours.expect_first();
        (0..hint).for_each(|_| robot.neighbours.expect_next());
        robot.hear_beacon(period, confirmed, &heard);
        robot.changes.are_news()
    };
    assert!(is_news(&mut robot, NOW, None, 0), "the first one");
    for hint in [0, 1] {
        let now = robot.schedule.period();
        assert!(!is_news(&mut robot, now, None, hint));
        assert!(!is_news(&mut robot, now + 1, None, hint), "heard in the period before");
        assert!(is_news(&mut robot, now + 3, None, hint), "it was absent");
        assert!(!is_news(&mut robot, now + 3, Some(now), hint), "nothing awaits it");
        robot.tree.desire(None, None, true);
        assert!(!is_news(&mut robot, now + 3, Some(now), hint), "it is not newer");
        assert!(is_news(&mut robot, now + 3, Some(now + 1), hint));
        robot.tree.desire(None, None, false);
        let known = robot.neighbour(1).expect("it is heard");
        assert_eq!((known.confirmed, known.heard_in), (Some(now + 1), now + 3));
        assert!(!is_news(&mut robot, now + 3, Some(now), hint));
        assert_eq!(robot.neighbour(1).expect("it is heard").confirmed, Some(now + 1));
    }
}

#[test]
fn a_robot_moves_only_if_it_has_heard_all_that_are_near_in_this_period() {
    let mut robot = robot();
    robot.membership.is_called_in(NOW);
    let near = watch_radius(&robot);
    assert!(robot.may_leave_place());
    robot.hears(beacon(1, east(near + 0.01), redundant(11, 12), &[]));
    robot.hears(access_point(west(0.2)));
    robot.schedule.is_in(robot.schedule.period() + 1);
    assert!(robot.may_leave_place(), "neither can get in its way");
    robot.hears(beacon(2, east(near - 0.01), redundant(12, 13), &[]));
    assert!(robot.may_leave_place());
    robot.schedule.is_in(robot.schedule.period() + 1);
    assert!(!robot.may_leave_place(), "one nearby has not been heard since");
    robot.hears(beacon(2, east(near - 0.01), redundant(12, 13), &[]));
    robot.schedule.is_in(robot.schedule.period() + robot.site.roll_validity());
    robot.neighbours = Neighbours::default();
    assert!(!robot.may_leave_place(), "the roll is not valid any more");
}

/// The link to a parent that is not heard could become too long unnoticed.
#[test]
fn a_robot_does_not_go_on_while_it_does_not_hear_its_parent() {
    let held = |post: Post| holding(post, HERE);
    let moves = |duty: Duty, hears_parent: bool| {
        let mut robot = robot();
        robot.membership.is_called_in(NOW);
        robot.duty.is(duty);
        if hears_parent {
            robot.hears(beacon(1, east(1.1), fixed(11, 12), &[11, 12]));
        }
        robot.may_leave_place()
    };
    let leads = held(primary(0, None, 11));
    assert!(moves(leads, true) && !moves(leads, false));
    assert!(!moves(held(primary(0, Some(10), 11)), false));
    assert!(moves(held(Post { parent: None, ..primary(0, None, 11) }), false), "it has none");
    assert!(!moves(Duty::Shifting(Shifting { place: 0, left: None }), false), "nor on Σ");
    assert!(moves(held(redundant(0, 11)), false), "it stays near its post");
}

/// A robot that has fallen silent well in range may come nearer unheard. A roll that is called late enough tells
/// whether it takes part.
#[test]
fn a_robot_that_has_fallen_silent_may_have_come_near() {
    let far = |robot: &Robot| {
        let settings = &robot.site.settings;
        settings.meeting_distance() + 10.5 * settings.longest_step()
    };
    let may_leave_after = |robot: &mut Robot, periods: u32, called: u32| {
        robot.hear_roll(&Roll { called: NOW + called, ..Roll::default() });
        robot.schedule.is_in(NOW + periods);
        robot.may_leave_place()
    };
    let lost = || {
        let mut robot = robot();
        robot.hears(beacon(1, east(far(&robot)), redundant(11, 12), &[]));
        silent_rounds(&mut robot, ROUNDS_TO_BE_HEARD + 1);
        assert!(hears(&robot).is_empty());
        robot
    };
    let mut robot = lost();
    assert!(
        may_leave_after(&mut robot, 10, 9),
        "it is more than a step farther than where they could meet"
    );
    assert!(!may_leave_after(&mut robot, 11, 10));
    assert!(!may_leave_after(&mut robot, 16, 15), "it may be on its way, and nobody misses it yet");
    assert!(
        may_leave_after(&mut robot, 17, 16),
        "it takes part, or is among those that are absent"
    );
    let mut robot = lost();
    assert!(!may_leave_after(&mut robot, 11, 10));
    robot.hears(beacon(1, east(far(&robot)), redundant(11, 12), &[]));
    assert!(may_leave_after(&mut robot, 11, 10), "it is heard");
}

/// At the beginning a robot knows where others start. One nearby that it does not hear may be cut off.
#[test]
fn a_robot_stays_where_another_starts_nearby_that_it_has_not_heard() {
    let settings = robot().site.settings;
    let met = settings.meeting_distance() + settings.longest_step();
    let may_leave = |gap: f64, hears_it: bool, called: u32| {
        let mut hall = hall();
        hall.robot[0].position = HERE.into();
        hall.robot[1].position = east(gap).into();
        let mut robot = robot_of(&hall);
        robot.schedule = Schedule::default();
        robot.schedule.join(1);
        if hears_it {
            robot.hears(beacon(1, east(gap), redundant(1, 12), &[]));
        }
        robot.look_around();
        robot.hear_roll(&Roll { called, ..Roll::default() });
        robot.may_leave_place()
    };
    assert!(may_leave(met + 0.01, false, 1), "it is too far away");
    assert!(!may_leave(met - 0.01, false, 1));
    assert!(may_leave(met - 0.01, true, 1), "it is heard");
    assert!(may_leave(met - 0.01, false, 16), "it would be named if it did not take part");
}

/// One that begins again has forgotten who is nearby, and some of these may be cut off.
#[test]
fn a_robot_that_joins_late_stays_until_it_is_told_who_is_absent() {
    let may_leave = |period: u32, called: u32| {
        let mut robot = robot();
        robot.schedule.starts();
        robot.hear_of_later_period(period);
        robot.look_around();
        robot.hear_roll(&Roll { called, ..Roll::default() });
        robot.may_leave_place()
    };
    assert!(may_leave(1, 1), "it has begun with the others");
    assert!(!may_leave(NOW, NOW) && !may_leave(NOW, NOW + 15));
    assert!(may_leave(NOW, NOW + 16));
    let mut robot = robot();
    robot.hear_of_later_period(NOW + 2);
    assert!(!robot.membership.knows_who_is_absent(), "it has heard nobody when it began again");
}

/// What a robot works out at its post stands from period to period, unless it moves, does not hear somebody, or hears
/// that one does not take part.
#[test]
fn a_robot_deliberates_anew_in_a_period_where_something_may_have_changed() {
    let standing = || {
        let mut robot = flows::router();
        robot.holds(Post { parent: Some(Anchor::Access(0)), ..redundant(20, 0) });
        robot.schedule.count_rounds_anew();
        robot.end_round();
        robot.remember_parent();
        robot.process_messages().expect("guards have values");
        robot.measures();
        robot.changes.settle();
        robot
    };
    let deliberates = |mut robot: Robot| {
        robot.restart_clock();
        robot.schedule.count_rounds_anew();
        robot.begin_period().expect("guards have values");
        robot.changes.are_news()
    };
    assert!(!deliberates(standing()));
    let changes: [fn(&mut Robot); 3] = [
        |robot| robot.body.is_moving_by(Vector::new(0.1, 0.0)),
        |robot| silent_rounds(robot, 1),
        |robot| {
            let gone = [1].into_iter().collect();
            let absent = Arc::new(Absent { gone, ..Absent::default() });
            robot.membership.is_told(Roll { called: NOW, absent });
        },
    ];
    for (number, change) in changes.into_iter().enumerate() {
        let mut robot = standing();
        change(&mut robot);
        robot.changes.settle();
        assert!(deliberates(robot), "{number}");
    }
}

#[test]
fn the_holder_of_a_post_is_the_robot_that_has_not_promised_it() {
    let mut robot = robot();
    let reply = pleach_discrete::network::Reply { to: 2, number: 1, accepted: None };
    robot.hears(Beacon { reply: Some(reply), ..beacon(1, east(0.5), fixed(11, 13), &[11, 13]) });
    assert_eq!(robot.holder(PostId(11)).map(|it| it.id()), Some(1));
    robot.hears(beacon(2, east(0.6), fixed(11, 13), &[11, 13]));
    assert_eq!(robot.holder(PostId(11)).map(|it| it.id()), Some(2));
    assert!(robot.holder(PostId(12)).is_none());
    robot.hears(access_point(west(0.5)));
    assert_eq!(robot.neighbour_at(Anchor::Access(0)).map(|it| it.id()), Some(ROBOTS));
    assert!(robot.neighbour_at(Anchor::Access(1)).is_none());
}

#[test]
fn children_are_those_whose_posts_are_attached_to_the_post_of_this_robot() {
    let mut robot = robot();
    robot.holds(fixed(20, 13));
    robot.hears(beacon(1, east(0.5), fixed(11, 20), &[11, 20, 13]));
    robot.hears(beacon(2, east(0.6), fixed(12, 11), &[12, 11, 20, 13]));
    assert_eq!(robot.children().map(|it| it.id()).collect::<Vec<_>>(), [1]);
    assert_eq!(robot.children_of(PostId(11)).map(|it| it.id()).collect::<Vec<_>>(), [2]);
}

#[test]
fn a_neighbour_is_found_by_the_post_that_it_holds_now() {
    let mut robot = robot();
    let found = |robot: &Robot| {
        [11, 14, 15].map(|post| robot.holder(PostId(post)).map(|holder| holder.id()))
    };
    robot.hears(beacon(1, east(0.2), redundant(11, 12), &[]));
    assert_eq!(found(&robot), [Some(1), None, None]);
    robot.hears(beacon(1, east(0.2), redundant(14, 12), &[]));
    assert_eq!(found(&robot), [None, Some(1), None]);
    robot.hears(beacon(1, east(0.3), redundant(15, 12), &[]));
    assert_eq!(found(&robot), [None, None, Some(1)]);
}
