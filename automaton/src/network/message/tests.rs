//! Every kind of message is read back as it was written, and what is malformed is refused.

use std::collections::BTreeSet;

use pleach_continuous::Point;
use pleach_discrete::Location as _;
use pleach_discrete::network::{
    Activity, Agreement, Anchor, Bid, Election, IdSet, Lineage, NoticeId, Offer, Post, PostId,
    PostKind, Reply, Role,
};
use serde_json::{Value, json};

use super::bounds::Bounds;
use super::*;
use crate::located::Place as _;
use crate::network::beacon::{Announcement, Branch, Notice, TeamReport};
use crate::network::duty::{
    AwaitingRelease, Bound, Duty, Following, Held, Hop, Junction, Leading, Leaf, Path, PathPlace,
    Relay, Shifting, Standby, Station, Waiting,
};
use crate::network::order::Errand;
use crate::network::record::Outcome;
use crate::network::robot::{GrantedPart, RequestNumber};
use crate::network::roll::{Absent, Wreck};
use crate::network::shared::Shared;

const CALL: NoticeId = NoticeId::new(7, 12);

fn post(id: u32, kind: PostKind, parent: Option<Anchor>, task: Option<usize>) -> Post {
    Post { id: PostId(id), kind, parent, task }
}

fn held(post: Post) -> Held {
    let station = Station { post, reference: Point::new(0.1, -1e-300) };
    Held { station, left: Some(PostId(u32::MAX)) }
}

/// A duty of every kind, with posts of every kind.
fn duties() -> Vec<Duty> {
    let free = held(Post::redundant(PostId(3)));
    let rooted = held(post(4, PostKind::Fixed, Some(Anchor::Access(1)), Some(2)));
    let follows = PostKind::Primary { follows: Some(PostId(4)) };
    let following = held(post(5, follows, Some(Anchor::Post(PostId(4))), None));
    let leading = held(post(6, PostKind::Primary { follows: None }, None, None));
    vec![
        Duty::Standby(Standby(free)),
        Duty::Relay(Relay(rooted)),
        Duty::Junction(Junction(rooted)),
        Duty::Leaf(Leaf(rooted)),
        Duty::Bound(Bound(rooted)),
        Duty::Waiting(Waiting { held: rooted, place: 2, role: Role::Junction }),
        Duty::AwaitingRelease(AwaitingRelease { held: rooted, place: 3 }),
        Duty::Shifting(Shifting { place: 0, left: None }),
        Duty::Following(Following(following)),
        Duty::Leading(Leading(leading)),
    ]
}

fn hops() -> Vec<Hop> {
    let place = PathPlace { reference: Point::new(1.0, 2.0), position: Point::new(0.1 + 0.2, 2.0) };
    let post = Post::redundant(PostId(3));
    vec![Hop { robot: 3, post, place, crossing: vec![0, 1] }]
}

/// A notice of every kind.
fn notices() -> Vec<Notice> {
    let set = |ids: &[usize]| Arc::new(ids.iter().copied().collect::<IdSet>());
    vec![
        Notice::Quiet,
        Notice::Task(Shared::new(Announcement {
            task: 1,
            position: Point::new(2.5, 0.0),
            before: Arc::from([Point::new(0.1 + 0.2, 1.0)]),
            roster: set(&[0, 1, 63, 64, 300]),
            eligible: set(&[]),
            again: true,
            stretched: true,
            last_resort: None,
        })),
        Notice::Call { caller: 8, releases_leader: true },
        Notice::Path(Arc::new(Path { hops: hops(), releases_leader: false })),
        Notice::Advance { joined: None },
        Notice::Advance { joined: Some((PostId(4), PostId(5))) },
        Notice::Serviced { task: 0 },
        Notice::Withdrawn { task: 1 },
        Notice::Ended {
            outcome: Outcome::Blocked,
            reason: "no way: “δ” 😀".to_owned().into(),
            task: Some(1),
        },
    ]
}

fn silent() -> Beacon {
    Beacon::silent(13, Point::origin())
}

/// A beacon in which every field has a value.
fn talkative(duty: Duty, notice: Notice) -> Beacon {
    let mut election = Election::new(CALL);
    election.place(70, Some(Bid { rank: 1, merit: -9, economy: 4 }));
    let mut agreement = Agreement::new(CALL);
    agreement.vote(2, true);
    agreement.arrive(0);
    Beacon {
        bulletin: Bulletin::first(Shared::new(Notice::Quiet)).next(4, Shared::new(notice)),
        election: Some(Arc::new(election)),
        agreement: Some(agreement),
        route: Some((CALL, Shared::new(hops()))),
        crossing: vec![1],
        lineage: Lineage::of_access_point(0).extended_by(PostId(4)).map(Arc::new),
        parent: Some(13),
        below: Arc::new(IdSet::singleton(9)),
        strays: Arc::new(IdSet::singleton(4)),
        forgetful: Arc::new(IdSet::singleton(2)),
        serves: Arc::new(IdSet::singleton(1)),
        closed: Arc::new(IdSet::singleton(0)),
        duty: Some(duty),
        parked: true,
        way: Some(Point::new(-0.5, 0.25)),
        can_detach: true,
        offer: Some(Offer { to: 2, number: 5, duty }),
        offers_made: 5,
        reply: Some(Reply { to: 2, number: 4, accepted: Some(duty) }),
        team: Some(TeamReport {
            still: 3,
            slack: Some(1),
            saturated: Some(2),
            remaining: f64::INFINITY,
            members: 2,
            near_other_tree: true,
        }),
        stretched: true,
        longest_wait: 9,
        wrecks: Arc::new(vec![Wreck {
            robot: 3,
            place: Point::new(0.5, 0.5),
            heard_in: 6,
            astray: 0.25,
        }]),
        branches: Arc::new(vec![Branch { robot: 5, place: Point::new(0.25, 0.5) }]),
        ..silent()
    }
}

/// A message of every kind: beacons with every duty and every notice.
fn messages() -> Vec<Message> {
    let absent = Absent { suspended: IdSet::singleton(2), gone: IdSet::singleton(3) };
    let roll = Roll { called: 6, absent: Arc::new(absent) };
    let beacon = |beacon| Message::Beacon {
        period: 7,
        roll: roll.clone(),
        confirmed: Some(6),
        beacon: Arc::new(beacon),
    };
    let of_duty = |duty| beacon(talkative(duty, Notice::Quiet));
    let of_notice = |notice| beacon(talkative(duties()[0], notice));
    let news = |notice| Message::News(Bulletin::first(Shared::new(notice)));
    let report = NeighbourReport { multiplier: 0.1, mismatch: -0.2, crowding: 1.0 };
    let segment = Segment::new(Point::new(0.1, 0.2), Point::new(1.0 / 3.0, 0.2));
    let number = RequestNumber { period: 3, number: 1 };
    let errands = [
        Errand { position: Point::new(1.33, 1.42), lasts: None, priority: 0, withdrawn: true },
        Errand { position: Point::new(1.6, 0.52), lasts: Some(90), priority: -7, withdrawn: false },
    ];
    let part = GrantedPart { flow: 0.025, until: 15 };
    let mut messages = vec![
        beacon(silent()),
        Message::Multiplier { report, parent: None },
        Message::Multiplier { report, parent: Some(3) },
        Message::Flow(0.075),
        Message::Demand(f64::MIN_POSITIVE),
        Message::Shortage,
        Message::AskFlow(FlowRequest { number, held: 0.0, wanted: 0.075 }),
        Message::GrantFlow(FlowGrant { number, flow: 0.05, until: 12, part: None }),
        Message::GrantFlow(FlowGrant { number, flow: 0.05, until: 12, part: Some(part) }),
        Message::Probe(Probe { number: 3, flow: 0.05, robots: vec![2, 4] }),
        Message::Proposal { period: 5, segment, witness: Some(2) },
        Message::Objection { period: 5 },
        Message::Consent { period: 5 },
        Message::Request(Order { tasks: Arc::from([]), continues: true }),
        Message::Request(Order { tasks: Arc::from(errands), continues: false }),
    ];
    messages.extend(duties().into_iter().map(of_duty));
    messages.extend(notices().into_iter().skip(1).map(of_notice));
    messages.extend(notices().into_iter().map(news));
    messages
}

/// The name of a kind; a new kind does not compile here until it has one.
fn kind(message: &Message) -> &'static str {
    match message {
        Message::Beacon { .. } => "beacon",
        Message::Multiplier { .. } => "multiplier",
        Message::Flow(_) => "flow",
        Message::Demand(_) => "demand",
        Message::Shortage => "shortage",
        Message::AskFlow(_) => "ask_flow",
        Message::GrantFlow(_) => "grant_flow",
        Message::Probe(_) => "probe",
        Message::Proposal { .. } => "proposal",
        Message::Objection { .. } => "objection",
        Message::Consent { .. } => "consent",
        Message::Request(_) => "request",
        Message::News(_) => "news",
    }
}

fn kind_of_notice(notice: &Notice) -> &'static str {
    match notice {
        Notice::Quiet => "quiet",
        Notice::Task(_) => "task",
        Notice::Call { .. } => "call",
        Notice::Path(_) => "path",
        Notice::Advance { .. } => "advance",
        Notice::Serviced { .. } => "serviced",
        Notice::Withdrawn { .. } => "withdrawn",
        Notice::Ended { .. } => "ended",
    }
}

#[test]
fn every_kind_of_message_is_read_back_as_it_was_written() {
    let (mut kinds, mut texts) = (BTreeSet::new(), BTreeSet::new());
    for message in messages() {
        let text = serde_json::to_string(&message).expect("it can be written");
        let read: Message =
            serde_json::from_str(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(read, message);
        assert_eq!(serde_json::to_string(&read).expect("it can be written"), text);
        assert!(
            text.starts_with(&format!("{{\"{}\":", kind(&message))) || text.len() < 12,
            "{text}"
        );
        kinds.insert(kind(&message));
        texts.insert(text);
    }
    assert_eq!(texts.len(), messages().len(), "unlike messages are written unlike");
    assert_eq!(kinds.len(), 13);
    let named: BTreeSet<_> = duties().iter().map(|duty| duty.location()).collect();
    assert_eq!(named.len(), Activity::ALL.len());
    assert_eq!(notices().iter().map(kind_of_notice).collect::<BTreeSet<_>>().len(), 8);
}

/// A user asks for a task at this place.
fn request_for(position: Value) -> Value {
    let errand = json!({"position": position, "lasts": null, "priority": 0, "withdrawn": false});
    json!({"request": {"tasks": [errand], "continues": false}})
}

/// What is said of a message that is not one.
fn refusal(message: Value) -> String {
    serde_json::from_value::<Message>(message.clone())
        .map(|read| panic!("{message} is read as {read:?}"))
        .unwrap_or_else(|error| error.to_string())
}

/// The beacon of a robot that tells something in every field, with one field changed.
fn beacon_with(field: &str, value: Value) -> Value {
    let beacon = talkative(duties()[0], notices()[1].clone());
    let mut written = serde_json::to_value(beacon).expect("it can be written");
    written[field] = value;
    json!({ "beacon": { "period": 0, "beacon": written } })
}

#[test]
fn malformed_messages_are_refused() {
    let cases = [
        (json!("hello"), "unknown variant `hello`"),
        (json!({"flow": 0.1, "demand": 0.1}), "single key"),
        (json!({"flow": null}), "expected f64"),
        (json!({"flow": "0.1"}), "expected f64"),
        (json!({"ask_flow": {"held": 0.1, "wanted": 0.2}}), "missing field `number`"),
        (
            json!({"grant_flow": {"number": {"period": -1, "number": 0}, "flow": 0.1}}),
            "invalid value",
        ),
        (
            json!({"grant_flow": {"number": {"period": 1, "number": 0}, "flow": null}}),
            "expected f64",
        ),
        (request_for(json!([0.0, null])), "expected f64"),
        (request_for(json!([0.0])), "array"),
        (json!({"request": {"tasks": []}}), "missing field `continues`"),
        (json!({"proposal": {"period": 0, "segment": {"from": [0, 0]}}}), "missing field `to`"),
        (json!({"consent": {}}), "missing field `period`"),
        (json!({"multiplier": {"parent": null}}), "missing field `report`"),
        (json!({"multiplier": {"parent": null, "surprise": 1}}), "unknown field `surprise`"),
        (json!({"beacon": {"period": 0, "surprise": 1}}), "unknown field `surprise`"),
        (beacon_with("surprise", json!(1)), "unknown field `surprise`"),
        (beacon_with("sender", json!(-1)), "invalid value"),
        (beacon_with("position", json!([0.0, 1.0, 2.0])), "array"),
        (beacon_with("below", json!([3, 3])), "ascending numbers"),
        (beacon_with("below", json!([1_000_000_000])), "ascending numbers"),
        (beacon_with("lineage", json!({"posts": [1, 1], "root": 0})), "twice"),
        (beacon_with("duty", json!({"sleeping": {}})), "unknown variant `sleeping`"),
        (beacon_with("duty", json!({"shifting": {"place": 0.5, "left": null}})), "invalid type"),
        (beacon_with("offers_made", json!(4_294_967_296_u64)), "invalid value"),
        (beacon_with("bulletin", json!({"notice": "quiet"})), "missing field `id`"),
        (
            beacon_with("election", json!({"id": "7 by 12", "tokens": [], "best": null})),
            "invalid type",
        ),
    ];
    for (message, expected) in cases {
        let said = refusal(message.clone());
        assert!(said.contains(expected), "{message}: {said}");
    }
}

/// Formats that have infinite numbers, and numbers that are not any, do not bring them in.
#[test]
fn numbers_that_are_not_finite_are_refused() {
    use serde::de::IntoDeserializer;
    use serde::de::value::{Error, F64Deserializer};
    for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let deserializer: F64Deserializer<Error> = number.into_deserializer();
        let refused: Result<f64, Error> = wire::deserialize(deserializer);
        let said = refused.expect_err("it is not finite").to_string();
        assert_eq!(said, format!("the number {number} in a message is not finite"));
    }
    let deserializer: F64Deserializer<Error> = 0.5.into_deserializer();
    assert_eq!(wire::deserialize::<f64, _>(deserializer), Ok(0.5));
}

/// What is wrong with a message: nodes, access points, tasks or places that do not exist, or absurd counts.
#[test]
fn messages_that_no_node_can_have_sent_are_impossible() {
    let bounds = Bounds { robots: 301, access_points: 2 };
    assert!(!bounds.admit(&messages()[0]), "a robot has a duty");
    for message in &messages()[1..] {
        assert!(bounds.admit(message), "{message:?}");
    }
    let sound = || talkative(duties()[1], notices()[1].clone());
    let beacon = |change: &dyn Fn(&mut Beacon)| {
        let mut beacon = sound();
        change(&mut beacon);
        Message::Beacon {
            period: 7,
            roll: Roll::default(),
            confirmed: None,
            beacon: Arc::new(beacon),
        }
    };
    let told = |period, called, confirmed| Message::Beacon {
        period,
        roll: Roll { called, absent: Arc::default() },
        confirmed,
        beacon: Arc::new(sound()),
    };
    let set = |id| Arc::new(IdSet::singleton(id));
    let (nobody, shifting) = (301, |place| Duty::Shifting(Shifting { place, left: None }));
    let number = RequestNumber { period: u32::MAX, number: 1 };
    let impossible = [
        told(u32::MAX, 0, None),
        told(7, 10, None),
        told(7, 7, Some(10)),
        Message::Objection { period: u32::MAX },
        Message::AskFlow(FlowRequest { number, held: 0.0, wanted: 0.1 }),
        Message::Probe(Probe { number: 1, flow: 0.1, robots: vec![nobody] }),
        Message::Probe(Probe { number: 1, flow: 0.1, robots: vec![0; nobody + 1] }),
        Message::Probe(Probe { number: 1, flow: 0.1, robots: vec![] }),
        Message::Probe(Probe { number: 1, flow: -0.1, robots: vec![0] }),
        Message::News(Bulletin::first(Shared::new(Notice::Serviced { task: usize::MAX }))),
        Message::News(Bulletin::first(Shared::new(Notice::Call {
            caller: nobody,
            releases_leader: true,
        }))),
        beacon(&|it| it.sender = nobody),
        beacon(&|it| it.duty = Some(shifting(nobody))),
        beacon(&|it| {
            it.duty = Some(Duty::Relay(Relay(held(post(
                4,
                PostKind::Fixed,
                Some(Anchor::Access(2)),
                None,
            )))))
        }),
        beacon(&|it| it.parent = Some(304)),
        beacon(&|it| it.below = set(nobody)),
        beacon(&|it| it.serves = set(65_536)),
        beacon(&|it| it.crossing = vec![2]),
        beacon(&|it| it.lineage = Some(Arc::new(Lineage::of_access_point(2)))),
        beacon(&|it| it.offers_made = u32::MAX),
        beacon(&|it| it.offer = Some(Offer { to: nobody, number: 5, duty: shifting(0) })),
        beacon(&|it| {
            it.branches = Arc::new(vec![Branch { robot: nobody, place: Point::origin() }])
        }),
    ];
    for message in impossible {
        assert!(!bounds.admit(&message), "{message:?}");
    }
}
