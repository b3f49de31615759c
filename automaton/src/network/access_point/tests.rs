//! What an access point makes of the beacons that it hears.

use std::sync::Arc;

use pleach_continuous::network::acceptance::Segment;
use pleach_continuous::{Point, Vector};
use pleach_discrete::network::{Election, IdSet, NodeId, Post, PostId};
use serde_json::json;

use super::attendance::{Attendee, Gone, Present, Returning, Standing, Suspended};
use super::tasks::TaskRecord;
use super::{AccessPoint, ROUNDS_UNTIL_ROSTER_SETTLES};
use crate::located::Place as _;
use crate::network::beacon::{Announcement, Beacon, Bulletin, Notice, Reports};
use crate::network::duty::{Duty, Held, Path, Standby, Station};
use crate::network::message::Message;
use crate::network::order::Order;
use crate::network::record::{MissionEvent, Outcome};
use crate::network::roll::{Absent, Roll, Wreck};
use crate::network::scenario::{Scenario, Task};
use crate::network::service::{Announced, Done, Electing, Serving, UnderWay};
use crate::network::shared::Shared;
use crate::network::site::Site;
use crate::node::{Input, Node as _, Outputs};

/// The first access point of a hall, which hears robots 0 and 1. A task that no robot can service ends the mission.
fn access_point() -> AccessPoint {
    access_point_with(json!({"unreachable": "end"}))
}

/// The same with these keys of `[mission]`.
fn access_point_with(mission: serde_json::Value) -> AccessPoint {
    let hall: Scenario = serde_json::from_value(json!({
        "name": "hall",
        "workspace": {"boundary": [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]},
        "link": {"full_range": 1.0, "max_range": 2.0},
        "control": {
            "clearance": 0.04, "service_radius": 0.2, "step_radius": 0.1,
            "tree_reliability": 0.1, "period": 0.5,
        },
        "mission": mission,
        "access_point": [{"position": [5.0, 5.0]}],
        "robot": [{"position": [4.0, 5.0], "rate": 0.1}, {"position": [6.0, 5.0], "rate": 0.1}],
        "task": [{"position": [9.0, 9.0]}],
    }))
    .expect("it is a scenario");
    AccessPoint::new(0, Arc::new(Site::new(&hall).expect("its numbers make sense")))
}

/// Where robot 0 starts.
const HERE: Point = Point::new(4.0, 5.0);

/// What a redundant robot says at `position`.
fn beacon(robot: NodeId, position: Point) -> Beacon {
    let station = Station { post: Post::redundant(PostId(robot as u32)), reference: position };
    let duty = Duty::Standby(Standby(Held { station, left: None }));
    Beacon { duty: Some(duty), ..Beacon::silent(robot, position) }
}

/// A roll by which these robots are suspended.
fn roll(called: u32, suspended: &[NodeId]) -> Roll {
    let suspended = suspended.iter().copied().collect();
    Roll { called, absent: Arc::new(Absent { suspended, ..Absent::default() }) }
}

/// Nobody relies on the robot, and the access point is asked to know of its move.
#[test]
fn it_knows_of_the_move_of_a_robot_that_asks_it_to() {
    let asked = |from: Point, witness: usize, period: u32| {
        let mut point = access_point();
        let west = Point::new(4.0, 5.0);
        point.schedule.join(7, true);
        point.hear_beacon(7, &roll(7, &[]), &Arc::new(beacon(0, west)));
        let segment = Segment { from, to: from + Vector::new(0.06, 0.0) };
        let message = Message::Proposal { period, segment, witness: Some(witness) };
        let mut outputs = Outputs::of(2);
        let heard = Input::Heard { from: 0, message: &message };
        point.step(heard, &mut outputs).expect("guards have values");
        let answers = outputs.drain_sent().count();
        point.membership.call_roll(7, roll(7, &[0]).absent.as_ref().clone());
        point.locate_wrecks();
        (answers, point.membership.wrecks()[0].astray)
    };
    let here = Point::new(4.0, 5.0);
    let (answers, astray) = asked(here, 2, 7);
    assert!(answers == 1 && (astray - 0.06).abs() < 1e-12);
    let (answers, astray) = asked(here, 1, 7);
    assert!(answers == 0 && (astray - 0.06).abs() < 1e-12, "another node is asked");
    assert_eq!(asked(here, 2, 6), (0, 0.0), "the proposal is late");
    let (answers, astray) = asked(Point::new(4.1, 5.0), 2, 7);
    assert!(answers == 1 && (astray - 0.06).abs() < 1e-12, "the beacon from there is lost");
}

/// The same beacon again is no news; another one is, and so is silence.
#[test]
fn it_processes_what_has_changed() {
    let (mut point, all) = (access_point(), roll(1, &[]));
    let is_news = |point: &mut AccessPoint, beacon: &Arc<Beacon>| {
        point.hear_beacon(1, &all, beacon);
        let has_news = point.has_news;
        point.process_news().expect("guards have values");
        has_news
    };
    let (here, moved) = (Arc::new(beacon(0, HERE)), Arc::new(beacon(0, Point::new(4.5, 5.0))));
    assert!(is_news(&mut point, &here), "the first one");
    assert!(!is_news(&mut point, &here), "the same again");
    assert!(is_news(&mut point, &moved), "another one");
    assert!(!is_news(&mut point, &moved), "that one again");
    point.neighbours.expect_all();
    point.forget_silent();
    assert!(
        point.has_news && point.neighbours.beacons().next().is_none(),
        "nothing is heard of it any more"
    );
}

/// Robots that have not heard them themselves keep away from these places.
#[test]
fn it_tells_where_robots_that_do_not_take_part_were_heard_last() {
    let mut point = access_point();
    let mut told = |period: u32, roll: &Roll, beacons: Vec<Beacon>| {
        beacons.into_iter().for_each(|beacon| point.hear_beacon(period, roll, &Arc::new(beacon)));
        point.deliberate().expect("guards have values");
        point.public_state().wrecks.to_vec()
    };
    let wreck = Wreck::heard;
    let (west, east) = (Point::new(4.0, 5.0), Point::new(6.0, 5.0));
    let farther = Point::new(7.0, 5.0);
    let all = roll(1, &[]);
    assert_eq!(told(1, &all, vec![beacon(0, west), beacon(1, east)]), [], "all take part");
    let without_one = roll(2, &[1]);
    assert_eq!(told(2, &without_one, vec![beacon(0, west)]), [wreck(1, east, 1)]);
    // Robot 0 has heard of a later place of robot 1, and tells it.
    let wrecks = Arc::new(vec![wreck(1, farther, 2)]);
    let heard = Beacon { wrecks, ..beacon(0, west) };
    assert_eq!(told(3, &without_one, vec![heard]), [wreck(1, farther, 2)]);
    assert_eq!(told(4, &roll(4, &[]), vec![beacon(0, west)]), [], "it takes part again");
}

/// The access point begins again, or has been heard by nobody since: it cannot tell for how long the others have
/// been silent.
#[test]
fn robots_are_suspended_until_they_are_heard_by_an_access_point_that_begins_again() {
    let absent = |is_new: bool| {
        let mut point = access_point();
        point.schedule.join(7, is_new);
        point.hear_beacon(40, &roll(40, &[]), &Arc::new(beacon(0, HERE)));
        let mut absent = Vec::new();
        for period in 41..44 {
            point.schedule.join(period, point.schedule.is_new());
            point.call_roll().expect("guards have values");
            absent.push(point.membership.roll().absent.suspended.iter().collect::<Vec<_>>());
            point.hear_beacon(period, &Roll::default(), &Arc::new(beacon(0, HERE)));
            point.survey_robots();
        }
        absent
    };
    for is_new in [true, false] {
        assert_eq!(absent(is_new), [vec![0, 1], vec![1], vec![1]], "{is_new}");
    }
}

/// No roll that is valid may let a robot move that others take for gone: it stays gone for as long when it is heard.
#[test]
fn who_is_gone_stays_gone_when_an_access_point_begins_again() {
    let mut point = access_point();
    let gone = Absent { gone: [1].into_iter().collect(), ..Absent::default() };
    let called = Roll { called: 40, absent: Arc::new(gone) };
    point.hear_beacon(40, &called, &Arc::new(beacon(0, HERE)));
    let mut standing = Vec::new();
    for period in 41..44 {
        point.schedule.join(period, point.schedule.is_new());
        point.call_roll().expect("guards have values");
        let absent = &point.membership.roll().absent;
        standing.push((absent.gone.contains(1), absent.suspended.contains(1)));
        if period == 42 {
            point.hear_beacon(period, &Roll::default(), &Arc::new(beacon(1, HERE)));
            point.survey_robots();
        }
    }
    assert_eq!(standing, [(true, false), (true, false), (false, true)], "then it may return");
}

/// It is heard, and cannot be attached yet.
#[test]
fn a_robot_that_knows_no_way_is_not_missed_while_it_is_heard() {
    let mut point = access_point();
    for period in 1..30 {
        point.schedule.join(period, point.schedule.is_new());
        point.call_roll().expect("guards have values");
        point.hear_beacon(period, &Roll::default(), &Arc::new(beacon(1, HERE)));
        point.survey_robots();
    }
    assert!(!point.membership.roll().absent.contains(1) && !point.roster.attending().contains(1));
}

/// It has been attached, and is too far off for a link now that the robot between has stopped.
#[test]
fn a_robot_that_knows_no_way_is_not_waited_for_for_ever() {
    let mut point = access_point();
    point.is_asked(&[Task::at(THERE)], 1);
    for robot in [0, 1] {
        point.hear_beacon(0, &Roll::default(), &Arc::new(beacon(robot, HERE)));
        point.roster.attend(&Reports { below: IdSet::singleton(robot), ..Reports::default() });
    }
    let mut reports = Reports { below: [0].into_iter().collect(), ..Reports::default() };
    reports.strays.insert(1);
    let announces_after = |point: &mut AccessPoint, rounds: usize| {
        point.roster.has_settled(rounds);
        point.update_roster(reports.clone());
        point.serve().expect("guards have values");
        matches!(point.notice(), Notice::Task(_))
    };
    point.update_roster(reports.clone());
    let patience = point.patience_with_searches();
    assert!(patience > ROUNDS_UNTIL_ROSTER_SETTLES);
    assert!(!announces_after(&mut point, ROUNDS_UNTIL_ROSTER_SETTLES), "it may find a parent");
    assert!(!announces_after(&mut point, patience - 2));
    assert!(announces_after(&mut point, patience - 1), "there is none");
}

// ---- Tasks with times ------------------------------------------------------------------------

impl AccessPoint {
    /// The user asks for these tasks as it does in a control period.
    fn is_asked(&mut self, tasks: &[Task], period: u32) {
        let message = Message::Request(Order::by(period, tasks));
        let heard = Input::Heard { from: 3, message: &message };
        self.step(heard, &mut Outputs::of(4)).expect("guards have values");
    }

    /// It heard `age` control periods ago that a task is serviced, and `silence` ago of its robot.
    fn has_heard_of(&mut self, task: usize, age: u32, silence: u32) {
        self.tasks.is_at(Serving::Done(Done { task }));
        self.expect_serviced(task);
        self.tasks.has_record(task, TaskRecord { silence, age });
    }

    /// It pursues a task, and has taken up this notice.
    fn pursues(&mut self, task: usize, notice: Notice) {
        let roster = Arc::new([0, 1].into_iter().collect());
        let announced = Some(Announced { task, roster, wayless: Arc::default(), unanswered: 0 });
        self.tasks.is_at(Serving::UnderWay(UnderWay { announced }));
        self.notices.issue(0, notice);
    }

    /// What it tells observers when it serves the user.
    fn serves_user(&mut self) -> Vec<MissionEvent> {
        self.serve().expect("guards have values");
        self.outbox.take_reports()
    }
}

const THERE: [f64; 2] = [9.0, 9.0];

#[test]
fn a_task_ends_when_it_has_lasted_and_is_heard_of() {
    let closing = |age, silence| {
        let mut point = access_point();
        point.is_asked(&[Task { lasts: Some(80), ..Task::at(THERE) }], 1);
        point.has_heard_of(0, age, silence);
        let events = point.serves_user();
        assert_eq!(point.public_state().closed.contains(0), !events.is_empty());
        (events, point.tasks.current().location())
    };
    use pleach_discrete::network::Service;
    assert_eq!(closing(79, 0), (vec![], Service::Done), "the mission waits for its end");
    assert_eq!(closing(80, 1), (vec![], Service::Done), "its robot may have stopped");
    assert_eq!(closing(80, 0), (vec![MissionEvent::TaskEnded { task: 0 }], Service::Done));
    let mut point = access_point();
    point.is_asked(&[Task::at(THERE)], 1);
    point.has_heard_of(0, 9_999, 0);
    assert_eq!(point.serves_user(), [], "it is serviced for ever");
    assert_eq!(point.tasks.current().location(), Service::Over);
}

#[test]
fn a_task_that_is_over_is_not_abandoned() {
    let mut point = access_point();
    point.is_asked(&[Task { lasts: Some(80), ..Task::at(THERE) }], 1);
    point.has_heard_of(0, 90, 5_000);
    assert_eq!((point.abandoned_task(), point.next_task()), (Some(0), Some(0)));
    point.close(0);
    assert_eq!((point.abandoned_task(), point.next_task()), (None, None));
}

#[test]
fn what_is_taken_back_before_it_is_announced_never_is() {
    let mut point = access_point();
    point.is_asked(&[Task::at(THERE), Task { withdrawn: Some(3), ..Task::at(THERE) }], 3);
    point.has_heard_of(0, 0, 0);
    assert_eq!(point.next_task(), Some(1));
    assert_eq!(point.serves_user(), [MissionEvent::TaskWithdrawn { task: 1 }]);
    assert_eq!(point.next_task(), None);
}

/// While a secondary team is on its way some posts have two robots that answer for them, and some none.
#[test]
fn a_task_that_is_pursued_is_given_up_when_no_secondary_team_is_on_its_way() {
    let taken_back = |notice: Notice, period: u32| {
        let mut point = access_point();
        point.is_asked(&[Task { withdrawn: Some(3), ..Task::at(THERE) }], period);
        point.pursues(0, notice);
        let epoch = point.notices.bulletin().id().epoch();
        let events = point.serves_user();
        let has_superseded = point.notices.bulletin().id().epoch() > epoch;
        assert_eq!(has_superseded, *point.notice() == Notice::Withdrawn { task: 0 });
        assert_eq!(has_superseded, point.public_state().closed.contains(0));
        events
    };
    let advance = || Notice::Advance { joined: None };
    let path = Notice::Path(Arc::new(Path { hops: Vec::new(), releases_leader: false }));
    assert_eq!(taken_back(advance(), 2), []);
    assert_eq!(taken_back(advance(), 3), [MissionEvent::TaskWithdrawn { task: 0 }]);
    assert_eq!(taken_back(path, 3), []);
}

// ---- Who is asked before a mission ends ------------------------------------------------------

impl AccessPoint {
    /// It hears that the primary team has given task 0 up.
    fn hears_of_failure(&mut self) -> Vec<MissionEvent> {
        let (outcome, reason) = (Outcome::InsufficientRobots, "too few".to_owned().into());
        let end = Notice::Ended { outcome, reason, task: Some(0) };
        let bulletin = self.notices.bulletin().next(1, Shared::new(end));
        self.neighbours.clear();
        self.neighbours.receive(&Arc::new(Beacon { bulletin, ..beacon(1, HERE) }));
        self.receive_notices().expect("guards have values");
        self.outbox.take_reports()
    }

    /// Robots 0 and 1 pursue task 0, and this robot stands like this.
    fn pursues_without(&mut self, robot: NodeId, standing: Standing) {
        self.is_asked(&[Task::at(THERE)], 1);
        self.pursues(0, Notice::Advance { joined: None });
        let validity = self.site.roll_validity();
        self.keep_attendance();
        self.roster.attend_all();
        self.survey_robots();
        self.roster.stands(robot, Attendee::absent(standing, validity));
    }

    /// The only robot of the elections for its task is robot 0.
    fn knows_one_elector(&mut self) {
        let roster = Arc::new([0].into_iter().collect());
        let announced = Some(Announced { task: 0, roster, wayless: Arc::default(), unanswered: 0 });
        self.tasks.is_at(Serving::UnderWay(UnderWay { announced }));
    }
}

#[test]
fn robots_that_have_joined_are_asked_before_a_task_is_given_up() {
    let mut point = access_point();
    point.pursues_without(1, Standing::Present(Present));
    point.knows_one_elector();
    assert_eq!(point.serves_user(), [], "the others need no help");
    let again = MissionEvent::TaskReannounced { task: 0, gone: vec![], joined: vec![1] };
    assert_eq!(point.hears_of_failure(), [again]);
    let Notice::Task(announcement) = point.notice() else { panic!("{:?}", point.notice()) };
    assert_eq!(announcement.roster.iter().collect::<Vec<_>>(), [0, 1]);
    let end = Notice::Ended { outcome: Outcome::Blocked, reason: Arc::default(), task: Some(0) };
    let late = Bulletin::first(Shared::new(Notice::Quiet)).next(1, Shared::new(end));
    assert!(point.notices.bulletin().id().is_newer_than(late.id()), "the end is superseded");
}

/// It may be of the team by now, or on Σ.
#[test]
fn a_robot_that_has_joined_is_missed_like_the_others() {
    let again = |has_joined: bool| {
        let mut point = access_point();
        point.pursues_without(1, Standing::Present(Present));
        point.knows_one_elector();
        let announcement = point.announcement_of(0).expect("it is asked for it");
        let announcement = Announcement { roster: Arc::new(IdSet::singleton(0)), ..announcement };
        let id = point.notices.bulletin().id();
        point.notices.follow(Some((id, Shared::new(announcement))));
        if has_joined {
            point.roster.attend_all();
            point.call_roll().expect("guards have values");
            assert_eq!(*point.roster.joiners(), IdSet::singleton(1));
        }
        point.roster.stands(1, Attendee::absent(Standing::Gone(Gone), point.site.roll_validity()));
        point.serves_user()
    };
    let without = MissionEvent::TaskReannounced { task: 0, gone: vec![1], joined: vec![] };
    assert_eq!((again(true), again(false)), (vec![without], vec![]));
}

#[test]
fn a_mission_does_not_end_while_a_robot_may_come_back() {
    let becomes_of = |standing: Standing| {
        let mut point = access_point();
        point.pursues_without(1, standing);
        point.knows_one_elector();
        point.hears_of_failure();
        point.tasks.current().location()
    };
    use pleach_discrete::network::Service;
    assert_eq!(becomes_of(Standing::Returning(Returning)), Service::UnderWay);
    assert_eq!(becomes_of(Standing::Suspended(Suspended)), Service::UnderWay);
    assert_eq!(becomes_of(Standing::Gone(Gone)), Service::Over);
}

#[test]
fn what_follows_an_end_is_taken_up() {
    let mut point = access_point();
    point.pursues_without(1, Standing::Gone(Gone));
    point.knows_one_elector();
    point.hears_of_failure();
    assert!(matches!(point.notice(), Notice::Ended { .. }));
    let bulletin =
        point.notices.bulletin().superseding(5, Shared::new(Notice::Advance { joined: None }));
    point.neighbours.clear();
    point.neighbours.receive(&Arc::new(Beacon { bulletin, ..beacon(1, HERE) }));
    point.receive_notices().expect("guards have values");
    assert_eq!(*point.notice(), Notice::Advance { joined: None });
}

/// Its robot may have stopped meanwhile.
#[test]
fn a_mission_is_over_when_every_task_that_is_serviced_has_been_heard_of() {
    let ends = |silence: u32| {
        let mut point = access_point();
        point.is_asked(&[Task::at(THERE)], 1);
        point.has_heard_of(0, 30, silence);
        point.serve().expect("guards have values");
        matches!(point.notice(), Notice::Ended { .. })
    };
    assert!(ends(0) && !ends(1));
}

/// One that is missed may have issued notices that nobody has heard of yet.
#[test]
fn an_end_supersedes_what_robots_that_are_missed_may_know() {
    let supersedes = |standing: Standing| {
        let mut point = access_point();
        point.is_asked(&[Task::at(THERE)], 1);
        point.has_heard_of(0, 30, 0);
        point.keep_attendance();
        point.roster.stands(1, Attendee::absent(standing, point.site.roll_validity()));
        let epoch = point.notices.bulletin().id().epoch();
        point.serve().expect("guards have values");
        assert!(matches!(point.notice(), Notice::Ended { .. }));
        point.notices.bulletin().id().epoch() > epoch
    };
    assert!(supersedes(Standing::Gone(Gone)) && !supersedes(Standing::Present(Present)));
}

/// It is heard, and answers none of the elections.
#[test]
fn a_mission_ends_when_a_robot_does_not_answer() {
    let becomes_of = |unanswered: u32| {
        let mut point = access_point();
        point.pursues_without(1, Standing::Present(Present));
        let roster = Arc::new([0, 1].into_iter().collect());
        let announced = Some(Announced { task: 0, roster, wayless: Arc::default(), unanswered });
        point.tasks.is_at(Serving::Electing(Electing { announced }));
        point.ballot.has_waited(1_001);
        point.roster.attend_all();
        let events = point.serves_user();
        let reason = match point.notice() {
            Notice::Ended { outcome: Outcome::Blocked, reason, .. } => Some(reason.to_string()),
            _ => None,
        };
        (events, reason)
    };
    let again = MissionEvent::TaskReannounced { task: 0, gone: vec![0, 1], joined: vec![] };
    assert_eq!(becomes_of(2), (vec![again], None));
    let reason = "the election for task 0 cannot end: robots 0 and 1 do not answer any more";
    assert_eq!(becomes_of(3), (vec![], Some(reason.to_owned())));
}

/// One that has begun again may have to find its way to an access point first.
#[test]
fn no_task_is_out_of_reach_while_a_robot_looks_for_its_way() {
    let becomes_of = |unanswered: u32, rounds: usize, has_found_way: bool| {
        let mut point = access_point();
        point.pursues_without(1, Standing::Present(Present));
        let roster: Arc<IdSet> = Arc::new([0, 1].into_iter().collect());
        let announcement = point.announcement_of(0).expect("it is asked for it");
        assert_eq!(*announcement.roster, *roster);
        point.roster.connects(IdSet::singleton(0));
        let announced = Announced { unanswered, ..point.announced_now(&announcement) };
        assert_eq!(*announced.wayless, IdSet::singleton(1));
        let notice = Notice::Task(Shared::new(announcement));
        point.notices.issue(3, notice);
        point.tasks.is_at(Serving::Electing(Electing { announced: Some(announced) }));
        let mut election = Election::new(point.notices.bulletin().id());
        (0..2).for_each(|robot| election.place(robot, None));
        point.ballot.takes_part_in(election);
        point.ballot.has_waited(rounds + 1);
        if has_found_way {
            point.roster.connects(roster.as_ref().clone());
        }
        let reason = |notice: &Notice| match notice {
            Notice::Ended { reason, .. } => Some(reason.to_string()),
            _ => None,
        };
        (point.serves_user(), reason(point.notice()))
    };
    let again = MissionEvent::TaskReannounced { task: 0, gone: vec![], joined: vec![1] };
    assert_eq!(becomes_of(0, 3, false), (vec![], None), "it may find one");
    assert_eq!(becomes_of(0, 3, true), (vec![again.clone()], None));
    assert_eq!(becomes_of(2, 3, true), (vec![again], None));
    assert!(becomes_of(3, 3, true).1.is_some(), "it has been asked often enough");
    let (events, reason) = becomes_of(0, 100_000, false);
    let expected = "no robot is left that can go to task 0: robot 1 knows no way to an access point \
                    any more";
    assert_eq!((events, reason.as_deref()), (vec![], Some(expected)));
}

/// One that has not begun, too: nobody else can say whether it could go.
#[test]
fn no_task_is_out_of_reach_while_a_robot_may_come() {
    let becomes_of = |standing: Option<Standing>| {
        let mut point = access_point();
        point.pursues_without(1, Standing::Present(Present));
        let attendee = match standing {
            Some(standing) => Attendee::absent(standing, point.site.roll_validity()),
            None => Attendee::new(point.site.roll_validity()),
        };
        point.roster.stands(1, attendee);
        point.survey_robots();
        let roster: Arc<IdSet> = Arc::new([0].into_iter().collect());
        let announced = Some(Announced { task: 0, roster, wayless: Arc::default(), unanswered: 0 });
        let announcement = point.announcement_of(0).expect("it is asked for it");
        let notice = Notice::Task(Shared::new(announcement));
        point.notices.issue(3, notice);
        point.tasks.is_at(Serving::Electing(Electing { announced }));
        let mut election = Election::new(point.notices.bulletin().id());
        election.place(0, None);
        point.ballot.takes_part_in(election);
        (point.serves_user(), matches!(point.notice(), Notice::Ended { .. }))
    };
    let joined = MissionEvent::TaskReannounced { task: 0, gone: vec![], joined: vec![1] };
    assert_eq!(becomes_of(None), (vec![], false), "it may begin");
    assert_eq!(becomes_of(Some(Standing::Suspended(Suspended))), (vec![], false));
    assert_eq!(becomes_of(Some(Standing::Present(Present))), (vec![joined], false));
    assert_eq!(becomes_of(Some(Standing::Gone(Gone))), (vec![], true));
}

/// Where the robots of other access points have found no recruit, and none is left to lead, robots are too few.
#[test]
fn a_task_is_not_out_of_reach_where_robots_of_others_have_been_asked_before() {
    let outcome_of = |eligible: &[usize]| {
        let mut point = access_point();
        point.pursues_without(1, Standing::Present(Present));
        point.roster.attend_all();
        let announcement = Announcement {
            eligible: Arc::new(eligible.iter().copied().collect()),
            ..point.announcement_of(0).expect("it is asked for it")
        };
        let roster = Arc::clone(&announcement.roster);
        point.roster.connects(roster.as_ref().clone());
        let notice = Notice::Task(Shared::new(announcement));
        point.notices.issue(3, notice);
        let announced = Some(Announced { task: 0, roster, wayless: Arc::default(), unanswered: 0 });
        point.tasks.is_at(Serving::Electing(Electing { announced }));
        let mut election = Election::new(point.notices.bulletin().id());
        (0..2).for_each(|robot| election.place(robot, None));
        point.ballot.takes_part_in(election);
        point.serves_user();
        match point.notice() {
            Notice::Ended { outcome, .. } => Some(*outcome),
            _ => None,
        }
    };
    assert_eq!(outcome_of(&[0]), Some(Outcome::UnreachableTask));
    assert_eq!(outcome_of(&[]), Some(Outcome::InsufficientRobots));
}

/// Its team is dissolved, and another task is announced.
#[test]
fn a_task_that_robots_have_given_up_is_skipped() {
    use pleach_discrete::network::Service;
    let mut point = access_point_with(json!({}));
    point.is_asked(&[Task::at(THERE), Task::at([4.0, 5.0])], 1);
    point.pursues_without(1, Standing::Gone(Gone));
    point.knows_one_elector();
    let epoch = point.notices.bulletin().id().epoch();
    let events = point.hears_of_failure();
    assert_eq!(
        (point.tasks.current().location(), &**point.notices.closed()),
        (Service::Done, &IdSet::singleton(0))
    );
    assert_eq!(*point.notice(), Notice::Withdrawn { task: 0 });
    assert!(point.notices.bulletin().id().epoch() > epoch, "robots that go on hear of it");
    let is_told = |event: &MissionEvent| matches!(event, MissionEvent::TaskGivenUp { task: 0, .. });
    assert!(events.iter().any(is_told), "{events:?}");
}

#[test]
fn a_mission_ends_with_the_outcome_of_the_task_that_was_given_up() {
    let end_of = |given_up: &[(usize, Outcome)]| {
        let mut point = access_point_with(json!({}));
        point.is_asked(&[Task::at(THERE), Task::at([4.0, 5.0])], 1);
        point.has_heard_of(1, 30, 0);
        for &(task, outcome) in given_up {
            point.tasks.give_up(task, outcome);
            point.close(task);
        }
        point.serve().expect("guards have values");
        match point.notice() {
            Notice::Ended { outcome, reason, .. } => Some((*outcome, reason.to_string())),
            _ => None,
        }
    };
    let (outcome, reason) = end_of(&[(0, Outcome::UnreachableTask)]).expect("it is over");
    assert_eq!(outcome, Outcome::UnreachableTask);
    assert!(reason.contains("no robot could service task 0"), "{reason}");
    let (outcome, reason) = end_of(&[]).expect("it is over");
    assert_eq!((outcome, reason.as_str()), (Outcome::Serviced, "all 2 tasks are serviced"));
}

/// The access point stands at (5, 5).
#[test]
fn tasks_come_in_the_order_of_the_mission() {
    let next = |order: &str, serviced: &[usize]| {
        let mut point = access_point_with(json!({"order": order}));
        let at = |x, priority| Task { priority: Some(priority), ..Task::at([x, 5.0]) };
        point.is_asked(&[at(9.0, 1), at(8.5, 3), at(2.0, 3), at(7.0, -1)], 1);
        for &task in serviced {
            point.tasks.has_record(task, TaskRecord { silence: 0, age: 1 });
        }
        point.next_task()
    };
    let orders = |serviced: &[usize]| ["file", "priority", "nearest"].map(|it| next(it, serviced));
    assert_eq!(orders(&[]), [Some(0), Some(1), Some(3)]);
    assert_eq!(orders(&[3]), [Some(0), Some(1), Some(1)], "from the task that is serviced");
    assert_eq!(orders(&[0, 1]), [Some(2), Some(2), Some(3)], "priorities are alike");
    assert_eq!(orders(&[0, 1, 2, 3]), [None; 3]);
}
