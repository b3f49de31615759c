//! Where a robot may move: its region, its links, and the consent of others (Sec. IV).

use pleach_continuous::network::LinkReliability as _;
use pleach_continuous::network::acceptance::Segment;

use super::*;
use crate::network::message::Message;
use crate::network::roll::{Absent, Roll, Wreck};
use crate::node::{Destination, Outputs};

/// The leader on its way to the east, called by the roll, and attached to none.
pub(super) fn mover() -> Robot {
    let mut robot = robot();
    robot.holds(Post { parent: None, ..primary(30, None, 13) });
    robot.advances_to(east(3.0));
    robot.membership.is_called_in(NOW);
    robot
}

/// The same, attached to the holder of post 13.
pub(super) fn attached_mover() -> Robot {
    let mut robot = mover();
    robot.holds(primary(30, None, 13));
    robot
}

pub(super) fn proposed(robot: &mut Robot) -> Option<Segment> {
    robot.measures();
    robot.propose().expect("its guards have values");
    robot.negotiation.proposal()
}

#[test]
fn a_robot_alone_goes_a_step_straight_to_its_goal() {
    let mut robot = mover();
    let segment = proposed(&mut robot).expect("nothing is in its way");
    assert_eq!(segment.from, HERE);
    assert!((segment.to - east(STEP)).norm() < 1e-6, "{segment:?}");
    robot.advances_to(HERE);
    assert_eq!(proposed(&mut robot), None, "it is there");
    robot.advances_to(east(3.0));
    robot.membership.is_called_in(0);
    assert_eq!(proposed(&mut robot), None, "it may not leave its place");
}

/// Each of two robots keeps ρ from the line half-way between them.
#[test]
fn two_robots_stay_on_their_sides_of_the_line_between_them() {
    let gap = 0.15;
    let mut robot = mover();
    robot.hears(beacon(1, east(gap), primary(31, Some(30), 30), &[]));
    let segment = proposed(&mut robot).expect("there is some room");
    let room = gap / 2.0 - CLEARANCE;
    let ahead = (segment.to - HERE).x;
    assert!(ahead <= room && ahead > room - 1e-3, "{ahead} of {room}");
}

/// Robots farther apart than 2 (σ + ρ) cannot meet in one step; nearer ones can.
#[test]
fn a_robot_nearer_than_two_steps_and_clearances_limits_a_move() {
    let kept = CLEARANCE * (1.0 + 1e-4);
    let cell = |away: f64| {
        let mut robot = mover();
        robot.hears(beacon(1, north(away), primary(31, Some(30), 30), &[]));
        proposed(&mut robot).expect("it moves east");
        robot.negotiation.problem().expect("it has moved by its problem").half_planes.len()
    };
    let near = 2.0 * (STEP + kept);
    assert_eq!(cell(near - LITTLE), cell(near + LITTLE) + 1);
}

#[test]
fn a_link_of_the_tree_ends_a_move_at_its_limit() {
    let mut robot = attached_mover();
    let build = robot.build_length();
    robot.hears(beacon(5, west(build - 0.03), fixed(13, 14), &[13, 14]));
    let segment = proposed(&mut robot).expect("there is some room");
    let ahead = (segment.to - HERE).x;
    assert!((ahead - 0.03).abs() < 1e-5, "{ahead}");
    robot.hears(beacon(5, west(build + 0.5), fixed(13, 14), &[13, 14]));
    let back = proposed(&mut robot).map_or(0.0, |segment| (segment.to - HERE).x);
    assert!(back <= 1e-6, "a link that is too long gets no longer: {back}");
}

/// The reference of its post lies ahead, and its task behind.
#[test]
fn the_holder_of_a_fixed_post_stays_within_reach_of_its_task() {
    let moved = |behind: f64| {
        let mut robot = robot();
        robot.membership.is_called_in(NOW);
        robot.knows_task(west(behind));
        let place = Post { task: Some(0), ..fixed(20, 13) };
        robot.duty.is(holding(place, east(0.09)));
        proposed(&mut robot).map_or(0.0, |segment| (segment.to - HERE).x)
    };
    let ahead = moved(SERVICE_RADIUS - 0.05);
    assert!((ahead - 0.05).abs() < 1e-5, "{ahead}");
    assert!((moved(0.0) - 0.09).abs() < 1e-5, "it returns to its post");
    let outside = moved(2.0 * SERVICE_RADIUS);
    assert!(outside < 1e-6, "it gets no farther from its task: {outside}");
}

/// To first order its load h = F/R(d) stays below 1.
#[test]
fn a_move_keeps_the_load_below_all_its_time_to_first_order() {
    let mut robot = mover();
    let away = 1.5;
    robot.hears(access_point(west(away)));
    robot.survey_links();
    robot.routing.plans(&[0.99]);
    let reliability = robot.site.link.reliability(away);
    assert!((robot.routing.links()[0].reliability - reliability).abs() < 1e-12);
    let segment = proposed(&mut robot).expect("there is a little room");
    // h = F/R(d), h' = −h R'/R: room is (1 − h)/h'.
    let steepness = 0.99 * -robot.site.link.slope(away) / reliability;
    let ahead = (segment.to - HERE).x;
    assert!((ahead - 0.01 / steepness).abs() < 1e-6, "{ahead}, not {}", 0.01 / steepness);
}

/// The load does not depend on where it stands as long as all that it sends arrives.
#[test]
fn a_move_is_free_where_its_load_does_not_change() {
    let mut robot = mover();
    robot.hears(access_point(HERE));
    robot.survey_links();
    robot.routing.plans(&[0.99]);
    let segment = proposed(&mut robot).expect("nothing is in its way");
    assert!((segment.to - east(STEP)).norm() < 1e-6, "{segment:?}");
}

/// An access point does not move.
#[test]
fn a_robot_relies_on_robots_that_it_has_heard_in_this_period() {
    let is_unsure = |heard: Beacon| {
        let mut robot = attached_mover();
        robot.hears(heard);
        robot.survey_links();
        robot.routing.plans(&[0.1]);
        robot.schedule.is_in(robot.schedule.period() + 1);
        robot.is_unsure()
    };
    assert!(!is_unsure(access_point(west(1.0))));
    assert!(is_unsure(beacon(5, west(1.0), fixed(13, 14), &[13, 14])));
}

/// A robot that has heard all its neighbours does not look at each; one that is ahead of it may have moved since.
#[test]
fn a_robot_that_hears_all_knows_where_they_are_unless_they_are_ahead() {
    let mut robot = attached_mover();
    let other = || beacon(5, west(1.0), fixed(13, 14), &[13, 14]);
    robot.hears(other());
    robot.end_round();
    assert!(robot.neighbours.have_all_been_heard_in(robot.schedule.period()));
    assert!(robot.knows_place_of(5) && !robot.knows_place_of(4));
    robot.hear_beacon(robot.schedule.period() + 1, None, &Arc::new(other()));
    assert!(!robot.knows_place_of(5));
}

/// With one round in a control period, nothing else would tell that it is silent.
#[test]
fn what_arrives_after_the_last_round_is_not_heard_in_the_next_period() {
    let mut robot = attached_mover();
    let other = Arc::new(beacon(5, west(1.0), fixed(13, 14), &[13, 14]));
    let hear = |robot: &mut Robot| robot.hear_beacon(robot.schedule.period(), None, &other);
    hear(&mut robot);
    robot.end_round();
    hear(&mut robot);
    robot.schedule.is_in(robot.schedule.period() + 1);
    robot.end_round();
    assert!(!robot.knows_place_of(5));
    assert!(!robot.neighbours.have_all_been_heard_in(robot.schedule.period()));
}

/// Three tenths of its clearance count as standing still.
#[test]
fn a_robot_that_gets_nowhere_counts_the_periods() {
    let still = 0.3 * CLEARANCE;
    for (ahead, expected) in [(still - LITTLE, 1), (still + LITTLE, 0)] {
        let mut robot = mover();
        robot.negotiation.intends(Some(Segment { from: HERE, to: east(ahead) }));
        robot.set_off();
        assert_eq!((robot.body.still_periods(), robot.body.is_moving()), (expected, true));
        robot.stay();
        assert!(!robot.body.is_moving());
    }
}

#[test]
fn a_robot_has_settled_within_a_fiftieth_of_its_clearance() {
    let robot = robot();
    let settled = 0.02 * CLEARANCE;
    assert!(!robot.is_off(east(settled - LITTLE)) && robot.is_off(east(settled + LITTLE)));
}

#[test]
fn a_certified_move_takes_a_control_period() {
    let mut robot = mover();
    robot.negotiation.intends(Some(Segment { from: HERE, to: east(0.07) }));
    robot.restart_clock();
    assert_eq!(robot.schedule.period(), NOW + 1);
    robot.set_off();
    robot.advance(robot.site.settings.period);
    assert_eq!(robot.body.position(), east(0.07));
}

fn sent(outputs: &mut Outputs<Message, super::super::MissionEvent>) -> Vec<Message> {
    outputs.drain_sent().map(|envelope| envelope.message).collect()
}

/// A robot that relies on this one has to consent; without that it stays.
#[test]
fn a_robot_moves_with_the_consent_of_all_that_rely_on_it() {
    let relied_on = |consents: &[NodeId]| {
        let mut robot = mover();
        robot.hears(Beacon {
            parent: Some(0),
            ..beacon(1, west(0.5), primary(31, Some(30), 30), &[])
        });
        proposed(&mut robot).expect("nothing is in its way");
        consents.iter().for_each(|&from| robot.negotiation.receive_consent(from));
        robot.stay_without_consent();
        robot.negotiation.proposal().is_some()
    };
    assert!(!relied_on(&[]) && !relied_on(&[2]) && relied_on(&[1]) && relied_on(&[2, 1, 1]));
}

/// The witness that a robot on which nobody relies asks for.
fn witness(robot: &mut Robot) -> Option<NodeId> {
    let mut outputs = Outputs::of(0);
    robot.tell_proposal(&mut outputs);
    let told = sent(&mut outputs);
    let [Message::Proposal { witness, .. }] = told[..] else { panic!("it proposes: {told:?}") };
    witness
}

#[test]
fn a_robot_on_which_nobody_relies_moves_when_a_witness_knows_of_it() {
    let mut robot = attached_mover();
    robot.hears(beacon(4, north(0.7), fixed(12, 14), &[12, 14]));
    robot.hears(beacon(5, west(0.7), fixed(13, 14), &[13, 14]));
    robot.remember_parent();
    proposed(&mut robot).expect("nothing is in its way");
    assert_eq!(witness(&mut robot), Some(5), "its parent");
    robot.stay_without_consent();
    assert_eq!(robot.negotiation.proposal(), None, "nobody knows of its move");
    proposed(&mut robot).expect("nothing is in its way");
    robot.body.waits(1);
    assert_eq!(witness(&mut robot), Some(4), "the parent may not receive it");
    robot.negotiation.receive_consent(4);
    robot.stay_without_consent();
    assert!(robot.negotiation.proposal().is_some());
    robot.hears(Beacon { parent: Some(0), ..beacon(1, west(0.5), primary(31, Some(30), 30), &[]) });
    proposed(&mut robot).expect("nothing is in its way");
    assert_eq!(witness(&mut robot), None, "robot 1 has to consent in any case");
}

/// Every robot that hears a proposal knows how far the sender may have gone, even if the sender's beacon is lost.
#[test]
fn a_witness_knows_how_far_a_robot_may_have_gone() {
    let asked = |from: Point, witness: NodeId| {
        let mut robot = robot();
        robot.holds(fixed(20, 99));
        robot.hears(beacon(5, west(1.0), redundant(13, 14), &[13, 14]));
        robot.negotiation.begin();
        let to = from + Vector::new(0.0, 0.06);
        robot.hear_proposal(5, Segment { from, to }, Some(witness));
        let mut outputs = Outputs::of(0);
        robot.judge_moves(&mut outputs);
        let consents = matches!(sent(&mut outputs)[..], [Message::Consent { period: NOW }]);
        let known = robot.membership.noted()[0];
        assert_eq!((known.robot, known.place, known.heard_in), (5, from, NOW));
        assert!((known.astray - 0.06).abs() < 1e-12, "{known:?}");
        consents
    };
    assert!(asked(west(1.0), 0));
    assert!(!asked(west(1.0), 3), "another one is asked");
    assert!(asked(west(1.1), 0), "the beacon from there is lost");
}

/// Of a robot that is heard at the end of its move nothing is left of that.
#[test]
fn a_move_that_is_over_is_forgotten() {
    let mut robot = robot();
    let gone = [5].into_iter().collect();
    robot.membership.lacks(Absent { gone, ..Absent::default() });
    let known = |robot: &mut Robot| {
        let neighbours = std::mem::take(&mut robot.neighbours);
        neighbours.iter().for_each(|lost| robot.lose_sight_of(lost));
        robot.locate_wrecks();
        robot.membership.wrecks()[0]
    };
    robot.hears(beacon(5, west(1.0), redundant(13, 14), &[13, 14]));
    let segment = Segment { from: west(1.0), to: west(0.95) };
    robot.hear_proposal(5, segment, None);
    assert_eq!(known(&mut robot), Wreck::setting_off(5, segment, NOW));
    robot.schedule.is_in(robot.schedule.period() + 1);
    robot.hears(beacon(5, west(0.95), redundant(13, 14), &[13, 14]));
    assert_eq!(known(&mut robot), Wreck::heard(5, west(0.95), NOW + 1));
}

/// Robot 0 is attached to robot 5, 3 cm short of what its link allows.
#[test]
fn a_child_objects_to_a_move_of_its_parent_that_overstretches_their_link() {
    let judged = |ahead: f64| {
        let mut robot = robot();
        robot.holds(fixed(20, 13));
        let hard = robot.hard_length();
        robot.hears(beacon(5, west(hard - 0.03), fixed(13, 14), &[13, 14]));
        robot.remember_parent();
        robot.negotiation.begin();
        let from = west(hard - 0.03);
        robot.hear_proposal(5, Segment { from, to: from - Vector::new(ahead, 0.0) }, None);
        let mut outputs = Outputs::of(0);
        robot.judge_moves(&mut outputs);
        sent(&mut outputs)
    };
    let consents = |said: Vec<Message>| matches!(said[..], [Message::Consent { period: NOW }]);
    let objects = |said: Vec<Message>| matches!(said[..], [Message::Objection { period: NOW }]);
    assert!(consents(judged(0.03 - LITTLE)) && objects(judged(0.03 + LITTLE)));
}

/// Robot 0 is attached to robot 5, 3 cm short of what its link allows, and both want to go by 5 cm.
#[test]
fn a_robot_halves_its_move_only_if_that_is_part_of_the_cause() {
    let left = |own: f64, parent: f64| {
        let mut robot = attached_mover();
        let from = west(robot.build_length() - 0.03);
        robot.hears(beacon(5, from, fixed(13, 14), &[13, 14]));
        robot.remember_parent();
        robot.negotiation.begin();
        proposed(&mut robot).expect("it may move");
        robot.negotiation.intends(Some(Segment { from: HERE, to: east(own) }));
        let to = from - Vector::new(parent, 0.0);
        robot.hear_proposal(5, Segment { from, to }, None);
        let mut outputs = Outputs::of(0);
        robot.judge_moves(&mut outputs);
        assert!(matches!(sent(&mut outputs)[..], [Message::Objection { .. }]));
        assert!(robot.negotiation.must_judge(), "it does not accept them");
        robot.negotiation.proposal().map_or(0.0, |segment| segment.length())
    };
    let close = |one: f64, other: f64| assert!((one - other).abs() < 1e-12, "{one} is not {other}");
    close(left(-0.05, 0.05), 0.05); // it follows its parent
    close(left(0.02, 0.05), 0.02); // its parent alone goes too far
    close(left(0.02, 0.02), 0.01); // both together do
    close(left(0.05, 0.02), 0.025);
}

/// Robot 0 sends nearly all of its time to robot 5, which moves away.
#[test]
fn a_sender_objects_to_a_move_of_its_receiver_that_overloads_it() {
    let judged = |share: f64, ahead: f64| {
        let mut robot = robot();
        robot.holds(fixed(20, 99));
        robot.hears(beacon(5, west(1.2), fixed(13, 14), &[13, 14]));
        robot.survey_links();
        robot.routing.plans(&[share]);
        robot.sends(5, share * robot.routing.links()[0].reliability);
        robot.negotiation.begin();
        robot.hear_proposal(5, Segment { from: west(1.2), to: west(1.2 + ahead) }, None);
        let mut outputs = Outputs::of(0);
        robot.judge_moves(&mut outputs);
        sent(&mut outputs)
    };
    assert!(matches!(judged(0.99, 0.1)[..], [Message::Objection { .. }]));
    assert!(judged(0.5, 0.1).is_empty(), "it has never asked that one for a flow");
    let load = |away: f64| {
        let link = &robot().site.link;
        0.9 * link.reliability(1.2) / link.reliability(away)
    };
    let limit = (0..2000)
        .map(|step| f64::from(step) * 1e-4)
        .take_while(|ahead| load(1.2 + ahead) < 1.0)
        .last()
        .expect("it moves");
    assert!(judged(0.9, limit).is_empty());
    assert!(matches!(judged(0.9, limit + 2e-4)[..], [Message::Objection { .. }]));
}

/// Of two receivers, a sender objects to the one whose move adds most to its load, if it is not overloaded without
/// that; to both if either alone is too much.
#[test]
fn a_sender_objects_to_no_more_moves_than_it_has_to() {
    let told = |first: f64, second: f64| -> Vec<NodeId> {
        let mut robot = robot();
        robot.holds(fixed(20, 99));
        for node in [5, 6] {
            robot.hears(beacon(node, west(1.2), fixed(node as u32, 14), &[14]));
        }
        robot.survey_links();
        robot.routing.plans(&[0.45; 2]);
        for node in [5, 6] {
            robot.sends(node, 0.45 * robot.routing.links()[0].reliability);
        }
        robot.negotiation.begin();
        for (node, away) in [(5, first), (6, second)] {
            robot.hear_proposal(node, Segment { from: west(1.2), to: west(1.2 + away) }, None);
        }
        let mut outputs = Outputs::of(0);
        robot.judge_moves(&mut outputs);
        let sent = outputs.drain_sent();
        sent.map(|envelope| match (envelope.to, envelope.message) {
            (Destination::One(to), Message::Objection { .. }) => to,
            other => panic!("{other:?}"),
        })
        .collect()
    };
    assert_eq!(told(0.25, -0.05), [5]);
    assert_eq!(told(-0.05, 0.25), [6]);
    assert_eq!(told(0.01, 0.25), [6], "what the other adds does no harm by itself");
    assert_eq!(told(0.25, 0.26), [5, 6]);
}

/// It has asked node 5 for a flow over its link, and relies on it from then on.
#[test]
fn a_sender_relies_on_its_receiver_and_answers_it() {
    let mut robot = robot();
    robot.holds(fixed(20, 99));
    robot.hears(beacon(5, west(1.0), fixed(13, 14), &[13, 14]));
    robot.survey_links();
    robot.routing.plans(&[0.2]);
    let mut outputs = Outputs::of(0);
    robot.ask_for_flows(&mut outputs);
    let asked = sent(&mut outputs);
    assert!(matches!(asked[..], [Message::AskFlow(_)]), "it asks: {asked:?}");
    robot.negotiation.begin();
    robot.hear_proposal(5, Segment { from: west(1.0), to: west(0.95) }, None);
    let mut outputs = Outputs::of(0);
    robot.judge_moves(&mut outputs);
    assert!(matches!(sent(&mut outputs)[..], [Message::Consent { period: NOW }]));
}

/// In the last round of a negotiation a robot that still hears an objection stays.
#[test]
fn a_robot_gives_its_move_up_at_the_last_chance() {
    use super::super::super::control::{Control, Negotiation};
    for (rounds, moves) in [(15, true), (16, false)] {
        let mut robot = mover();
        proposed(&mut robot).expect("nothing is in its way");
        robot.schedule.is_at(Control::Negotiation(Negotiation));
        robot.schedule.count_rounds_anew();
        robot.schedule.pass_rounds(rounds);
        robot.yield_to_objection();
        assert_eq!(robot.negotiation.proposal().is_some(), moves, "{rounds}");
    }
    let mut elsewhere = mover();
    proposed(&mut elsewhere).expect("nothing is in its way");
    elsewhere.schedule.pass_rounds(16);
    elsewhere.yield_to_objection();
    assert!(elsewhere.negotiation.proposal().is_some(), "rounds of another stage do not count");
}

/// Others allow for two steps from where a robot was heard last, which was not before its roll was called.
#[test]
fn a_robot_that_may_not_be_heard_stays_within_two_steps_of_where_it_has_been() {
    let ahead = |gone: f64, roll: u32| {
        let mut robot = mover();
        robot.membership.is_called_in(NOW - 3);
        robot.membership.set_off(NOW - 2, west(gone));
        robot.hear_roll(&Roll { called: roll, ..Roll::default() });
        proposed(&mut robot).map(|segment| (segment.to - HERE).x)
    };
    let close = |ahead: Option<f64>, expected: f64| {
        let ahead = ahead.expect("it moves");
        assert!((ahead - expected).abs() < 1e-6, "{ahead} is not {expected}");
    };
    close(ahead(STEP, NOW - 3), STEP);
    close(ahead(1.5 * STEP, NOW - 3), 0.5 * STEP);
    assert_eq!(ahead(2.1 * STEP, NOW - 3), None, "an error has led it farther");
    close(ahead(2.1 * STEP, NOW - 1), STEP);
    let mut robot = mover();
    proposed(&mut robot).expect("nothing is in its way");
    robot.set_off();
    assert_eq!(robot.membership.trail().collect::<Vec<_>>(), [HERE]);
}
