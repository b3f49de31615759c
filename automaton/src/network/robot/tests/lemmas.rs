//! The steps of robots are those of the lemmas about any number of robots: exhaustively, for short paths and
//! few neighbours. Those of exchanges and reservations stand beside the code.

use std::collections::{BTreeMap, BTreeSet};

use pleach_discrete::network::path::subgroups;
use pleach_discrete::network::{Agreement, IdSet};

use super::moves::{mover, proposed};
use super::*;
use crate::network::duty::{Hop, PathPlace, Waiting};
use crate::network::record::Outcome;
use crate::network::robot::{FIRST_NEW_POST, POSTS_OF_A_PERIOD};
use crate::network::roll::{Absent, Roll};

/// Places of Σ; the last break point is place 2.
const PLACES: usize = 4;
const LAST: usize = 2;
/// The post at place 0; the others follow.
const FIRST_POST: u32 = 20;

fn id_at(place: usize) -> PostId {
    PostId(FIRST_POST + place as u32)
}

/// Σ from a redundant robot to p₁, each post attached to the next. All places are here, so that robots have
/// arrived at once, or in the east, so that they have not.
fn path(reference: Point) -> Arc<Path> {
    let hop = |place: usize| {
        let id = id_at(place).0;
        let post = match place {
            0 => redundant(id, id + 1),
            3 => primary(id, None, 90),
            _ => fixed(id, id + 1),
        };
        Hop { robot: place, post, place: PathPlace { reference, position: HERE }, crossing: vec![] }
    };
    Arc::new(Path { hops: (0..PLACES).map(hop).collect(), releases_leader: false })
}

/// A robot of Σ, and what it knows of the others.
#[derive(Clone, Copy, Debug)]
struct Case {
    place: usize,
    /// Whether it is on its way to the next place.
    shifts: bool,
    /// Whether place 1 is a break point.
    is_cut: bool,
    /// How many subgroups have arrived.
    done: usize,
    /// Places of which it is known that they have arrived, and that they have given their posts up.
    arrived: [bool; PLACES],
    given_up: [bool; PLACES],
}

impl Case {
    fn break_points(&self) -> &'static [usize] {
        if self.is_cut { &[0, 1, 2] } else { &[0, 2] }
    }

    fn released(&self, place: usize) -> bool {
        self.arrived[place] || self.given_up[place]
    }

    /// Every case that may occur: posts are given up at the ends of subgroups; a robot that waits has not
    /// arrived, and one on its way belongs to the active team and, at its beginning, has given its post up.
    fn all() -> Vec<Case> {
        let sets = |bits: usize| [0, 1, 2, 3].map(|place| bits >> place & 1 == 1);
        let mut all = Vec::new();
        for code in 0..3 * 2 * 2 * 3 * 8 * 8 {
            let (place, rest) = (code % 3, code / 3);
            let (shifts, is_cut, rest) = (rest % 2 == 1, rest / 2 % 2 == 1, rest / 4);
            let (done, rest) = (rest % 3, rest / 3);
            let (arrived, given_up) = (sets(rest % 8), sets(rest / 8));
            let case = Case { place, shifts, is_cut, done, arrived, given_up };
            let groups: Vec<_> = subgroups(case.break_points()).collect();
            let ends: Vec<usize> = groups.iter().map(|group| group.end).collect();
            let active = groups.get(done);
            let is_on_way = active.is_some_and(|active| active.places().contains(&place));
            let is_first = active.is_some_and(|active| active.first == place);
            let may_occur = done <= groups.len()
                && (0..PLACES).all(|place| !given_up[place] || ends.contains(&place))
                && match shifts {
                    true => is_on_way && (!is_first || place == 0 || given_up[place]),
                    false => !arrived[place],
                };
            if may_occur {
                all.push(case);
            }
        }
        all
    }

    fn robot(&self, reference: Point) -> Robot {
        let (mut robot, path) = (robot(), path(reference));
        robot.knows_task(east(3.0));
        robot.is_told(Notice::Path(Arc::clone(&path)));
        let mut agreement = Agreement::new(robot.notice_id());
        for place in 0..PLACES {
            agreement.vote(place, self.break_points().contains(&place));
            if self.arrived[place] {
                agreement.arrive(place);
            }
            if self.given_up[place] {
                agreement.give_up(place);
            }
        }
        robot.ballot.agree(Some(agreement));
        let groups = subgroups(self.break_points()).collect();
        let shift = Shift { path: Arc::clone(&path), subgroups: groups, arrived: self.done };
        robot.mission.is(Mission::Shift(shift));
        let post = path.hops[self.place].post;
        let duty = match self.shifts {
            true => {
                let left = (self.place > 0).then_some(post.id);
                Duty::Shifting(Shifting { place: self.place, left })
            }
            false => {
                let held = Held { station: Station { post, reference }, left: None };
                let role = holding(post, reference).role();
                Duty::Waiting(Waiting { held, place: self.place, role })
            }
        };
        robot.duty.is(duty);
        robot
    }
}

/// What a robot of Σ says, `yield_post` and `report_arrival` of the lemma `holder.smt2`: that it gives its own
/// post up while it waits, or that it has arrived while it is on its way, and nothing of others.
#[test]
fn robots_release_posts_as_the_lemma_says() {
    let mut said = [0; 2];
    for (case, reference) in
        Case::all().into_iter().flat_map(|case| [HERE, east(2.0)].map(|place| (case, place)))
    {
        let mut robot = case.robot(reference);
        robot.hear_notices();
        let agreement = robot.ballot.agreement().expect("it takes part");
        for place in 0..PLACES {
            let (has_arrived, has_given_up) =
                (agreement.have_arrived(place..place + 1), agreement.has_given_up(place));
            let (arrives, gives_up) =
                (has_arrived && !case.arrived[place], has_given_up && !case.given_up[place]);
            assert!(has_arrived >= case.arrived[place] && has_given_up >= case.given_up[place]);
            assert!(!arrives || case.shifts && place == case.place, "{case:?}");
            assert!(!gives_up || !case.shifts && place == case.place, "{case:?}");
            said = [said[0] + usize::from(arrives), said[1] + usize::from(gives_up)];
        }
    }
    assert!(said.iter().all(|&times| times > 10), "{said:?}");
}

/// The post that a robot of Σ holds after a step of the mission, whatever it knows of the others: its own, if
/// it has not released that; the one ahead, if it knows that to be released; or a new one. These are the steps
/// of the lemma `holder.smt2`, and no post has two holders by it.
#[test]
fn robots_take_posts_as_the_lemma_says() {
    let told = |robot: &Robot| {
        let task = robot.announcement().cloned().expect("it knows one");
        let task = Notice::Task(Shared::new(task));
        let ended =
            Notice::Ended { task: None, outcome: Outcome::Serviced, reason: Arc::default() };
        let (advance, serviced) = (Notice::Advance { joined: None }, Notice::Serviced { task: 0 });
        let newest = robot.mission.notices().bulletin();
        let next = |notice| newest.next(1, Shared::new(notice));
        let overtaking = newest.superseding(1, Shared::new(advance.clone()));
        let known = newest.clone();
        [known, next(task), next(advance), next(serviced), next(ended), overtaking]
    };
    const ENDED: usize = 4;
    let mut taken: BTreeMap<&str, usize> = BTreeMap::new();
    for case in Case::all() {
        let Case { place, shifts, .. } = case;
        let robot = case.robot(east(2.0));
        for (kind, bulletin) in told(&robot).into_iter().enumerate() {
            // The team advances when all posts up to the last break point have been released.
            if kind == 2 && !(1..=LAST).all(|place| case.released(place)) {
                continue;
            }
            let mut robot = robot.clone();
            robot.mission.notices_mut().take_up(bulletin);
            if case.given_up[place] {
                let behind = Post { parent: None, ..fixed(id_at(place).0, 0) };
                robot.hears(beacon(5, west(0.3), behind, &[]));
            }
            robot.measures();
            robot.jump_once().expect("its guards have values");
            if kind == ENDED && robot.duty.place().is_some() {
                let task =
                    Notice::Task(Shared::new(robot.announcement().cloned().expect("it knows one")));
                robot.mission.notices_mut().supersede(1, task);
                robot.measures();
                robot.jump_once().expect("its guards have values");
                assert!(robot.duty.place().is_none(), "the robot leaves Σ: {case:?}");
            }
            let now = robot.duty.post().map(|post| post.id);
            let is_off = robot.duty.place().is_none();
            let step = match now {
                None => {
                    assert!(matches!(*robot.duty, Duty::Shifting(_)), "{case:?}");
                    if shifts { "goes on" } else { "sets out" }
                }
                Some(_) if !is_off => {
                    assert!(!shifts && now == Some(id_at(place)), "{case:?}");
                    "waits"
                }
                Some(post) if post == id_at(place) => {
                    let is_its_own =
                        if shifts { !case.released(place) } else { !case.given_up[place] };
                    assert!(is_its_own, "{kind} {case:?}");
                    if shifts { "takes its post again" } else { "keeps its post" }
                }
                Some(post) if post == id_at(place + 1) => {
                    assert!(shifts && case.released(place + 1), "{kind} {case:?}");
                    "takes the post ahead"
                }
                Some(post) => {
                    let is_of_the_team = robot.duty.is_primary() && !shifts;
                    assert!(post.0 >= FIRST_NEW_POST || is_of_the_team, "{kind} {case:?} {post:?}");
                    assert!((0..PLACES).all(|place| post != id_at(place)));
                    "takes a new post"
                }
            };
            *taken.entry(step).or_default() += 1;
        }
    }
    assert!(taken.len() == 7 && taken.values().all(|&times| times > 3), "{taken:?}");
}

/// A new post is none that any robot has made before, in any period, nor one of the first posts and of those
/// of the team: `is-new` of the lemma `holder.smt2`. A robot that begins again takes one before anything else.
#[test]
fn new_posts_are_new() {
    let site = robot().site;
    let (mut made, mut count) = (BTreeSet::new(), 0);
    for id in 0..ROBOTS {
        let mut robot = Robot::new(id, HERE, 0.1, Arc::clone(&site));
        for (period, posts_made) in
            (0..6).flat_map(|it| (0..POSTS_OF_A_PERIOD).map(move |n| (it, n)))
        {
            robot.schedule.is_in(period);
            robot.duty.begin_period();
            robot.duty.make_posts(posts_made);
            made.insert(robot.new_post().id.0);
            count += 1;
        }
        robot.schedule.is_in(NOW);
        robot.duty.begin_period();
        robot.duty.join_late();
        robot.measures();
        let expected = robot.new_post().id;
        assert!(robot.jump_once().expect("its guards have values"));
        assert_eq!(robot.duty.post().map(|post| post.id), Some(expected));
        assert!(robot.duty.is_redundant());
    }
    assert_eq!(made.len(), count);
    assert!(made.first().is_some_and(|&least| least >= FIRST_NEW_POST));
}

/// What a robot knows of one nearby.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Known {
    Heard,
    Silent,
    Gone,
}

/// Two robots nearby and one far away, each heard in this period, heard in the one before, or called gone; goals
/// in eight directions: the robot moves exactly where the lemma `space.smt2` lets it, and stays on its own side
/// of the line between its place and that of each robot nearby that it has heard.
#[test]
fn robots_move_as_the_lemma_says() {
    let places = [east(0.15), north(0.12), west(3.0)];
    let all = [Known::Heard, Known::Silent, Known::Gone];
    let mut moved = 0;
    for code in 0..27 * 8 * 2 {
        let known = [1, 3, 9].map(|unit: usize| all[code / unit % 3]);
        let angle = (code / 27 % 8) as f64 * std::f64::consts::FRAC_PI_4;
        let is_suspended = code / 216 == 1;
        let mut robot = mover();
        robot.advances_to(HERE + Vector::new(angle.cos(), angle.sin()));
        for (at, &place) in places.iter().enumerate() {
            robot.hears(beacon(at + 1, place, redundant(11 + at as u32, 99), &[]));
        }
        robot.schedule.is_in(robot.schedule.period() + 1);
        for (at, &place) in places.iter().enumerate().filter(|&(at, _)| known[at] == Known::Heard) {
            robot.hears(beacon(at + 1, place, redundant(11 + at as u32, 99), &[]));
        }
        let gone: IdSet = (1..4).filter(|&at| known[at - 1] == Known::Gone).collect();
        let suspended: IdSet = is_suspended.then_some(0).into_iter().collect();
        robot.membership.is_told(Roll {
            called: robot.schedule.period(),
            absent: Arc::new(Absent { suspended, gone }),
        });
        let may_leave = !is_suspended && known[..2].iter().all(|it| *it != Known::Silent);
        assert_eq!(robot.may_leave_place(), may_leave, "{known:?}");
        let proposal = proposed(&mut robot);
        assert!(may_leave || proposal.is_none(), "{known:?}");
        let Some(segment) = proposal else { continue };
        moved += 1;
        for place in (0..2).filter(|&at| known[at] == Known::Heard).map(|at| places[at]) {
            let ahead = place - HERE;
            let room = ahead.norm() / 2.0 - CLEARANCE;
            assert!((segment.to - HERE).dot(&ahead.normalize()) <= room, "{known:?} {segment:?}");
        }
    }
    assert!(moved > 50, "only {moved}");
}
