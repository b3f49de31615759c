//! Two exchanges of duties in the same instant, with a link of the tree between them. Neither knows of the other.

use pleach_discrete::network::Offer;

use super::*;
use crate::chance::Chance;

/// Each mover with the parked robot beside it.
const PAIRS: [[NodeId; 2]; 2] = [[0, 1], [2, 3]];
const SCENES: usize = 2_000;
const RANGE: f64 = 2.0;
/// A reliability near which not all robots beside the other end of a link are in range.
const FAINT: f64 = 0.01;

/// Two pairs of robots, all attached to the access point but for one that is attached to one of the other pair.
struct Scene {
    robots: Vec<Robot>,
    /// The link between the pairs: one robot of each.
    link: [NodeId; 2],
}

impl Scene {
    /// The link is about as long as it may be.
    fn draw(chance: &mut Chance, site: &Arc<Site>, stretched: bool) -> Scene {
        let link = PAIRS.map(|pair| pair[chance.below(2)]);
        let mut place = |about: Point, nearest: f64, farthest: f64| {
            let away = nearest + chance.share() * (farthest - nearest);
            let angle = std::f64::consts::TAU * chance.share();
            about + away * Vector::new(angle.cos(), angle.sin())
        };
        let hard = site.lengths(stretched).hard;
        let other = place(HERE, hard - 3.0 * CLEARANCE, hard + 3.0 * CLEARANCE);
        let [one_parked, other_parked] =
            [HERE, other].map(|mover| place(mover, 2.0 * CLEARANCE, 4.0 * CLEARANCE));
        let places = [HERE, one_parked, other, other_parked];
        let center = HERE + 0.5 * (other - HERE);
        let robots = (0..).zip(places).map(|(id, place)| {
            let mut robot = Robot::new(id, place, 0.1, Arc::clone(site));
            robot.schedule.is_in(NOW);
            robot.body.waits(12);
            robot.mission.notices_mut().set_stretched(stretched);
            robot.holds(post_of(id, link));
            robot.advances_to(east(4.0));
            robot.hears(access_point(center));
            robot
        });
        let mut scene = Scene { robots: robots.collect(), link };
        let silent = [None; 4];
        scene.hear_each_other(silent);
        scene.robots.iter_mut().for_each(Robot::remember_parent);
        scene.hear_each_other(silent);
        scene
    }

    /// All in range of each other do, with the offers that they make.
    fn hear_each_other(&mut self, partners: [Option<NodeId>; 4]) {
        let told = self.robots.iter().zip(partners).map(|(robot, partner)| Beacon {
            offer: partner.map(|to| Offer { to, number: 1, duty: *robot.duty }),
            parked: !robot.duty.is_primary(),
            ..robot.public_state()
        });
        let told: Vec<Beacon> = told.collect();
        for robot in &mut self.robots {
            let is_heard = |it: &&Beacon| (it.position - robot.body.position()).norm() < RANGE;
            let heard = told.iter().filter(|it| it.sender != robot.id).filter(is_heard);
            let heard: Vec<Beacon> = heard.cloned().collect();
            heard.into_iter().for_each(|beacon| robot.hears(beacon));
        }
    }

    /// Which pairs exchange duties.
    fn exchange(&mut self) -> [bool; 2] {
        let mut partners = [None; 4];
        for robot in &mut self.robots {
            robot.measures();
            robot.consider_exchange();
            partners[robot.id] = robot.exchanges.partner();
        }
        self.hear_each_other(partners);
        PAIRS.map(|[mover, parked]| {
            partners[mover] == Some(parked) && self.robots[parked].may_be_relieved()
        })
    }

    /// The length of the link between the pairs when these have exchanged duties.
    fn link_after(&self, exchanged: [bool; 2]) -> f64 {
        let [one, other] = [0, 1].map(|pair| {
            let [mover, parked] = PAIRS[pair];
            let holder = self.link[pair];
            let swapped = if holder == mover { parked } else { mover };
            self.robots[if exchanged[pair] { swapped } else { holder }].body.position()
        });
        (one - other).norm()
    }
}

/// The robot of the second pair is attached to that of the first one.
fn post_of(id: NodeId, link: [NodeId; 2]) -> Post {
    let number = |id: NodeId| 30 + id as u32;
    let parent = match id == link[1] {
        true => Anchor::Post(PostId(number(link[0]))),
        false => Anchor::Access(0),
    };
    let is_mover = PAIRS.iter().any(|pair| pair[0] == id);
    let post = if is_mover { primary(number(id), None, 0) } else { redundant(number(id), 0) };
    Post { parent: Some(parent), ..post }
}

#[test]
fn links_hold_after_two_exchanges_side_by_side() {
    let mut scenario = hall();
    scenario.control.tree_reliability = Some(FAINT);
    let site = Arc::new(Site::new(&scenario).expect("its numbers make sense"));
    let mut chance = Chance::new(1, 0);
    for stretched in [false, true] {
        let longest = site.lengths(stretched).hard;
        let scenes = (0..SCENES).map(|_| Scene::draw(&mut chance, &site, stretched));
        let linked = scenes.filter(|scene| scene.link_after([false; 2]) <= longest);
        let both = linked.filter_map(|mut scene| {
            let exchanged = scene.exchange();
            let after = scene.link_after(exchanged);
            assert!(after <= longest, "{:?} of {PAIRS:?}: {exchanged:?}", scene.link);
            (exchanged == [true; 2]).then_some(())
        });
        assert!(both.count() > SCENES / 50, "few exchange duties in the same instant");
    }
}
