//! Bodies: robots of other fleets, of which this robot knows nothing but where they are.
//!
//! At the beginning of a control period it learns where those in range of the radio are. Each of two robots keeps to
//! its own side of the half-plane between them (17), and within its cell it moves in a straight line, so that the two
//! keep 2ρ apart without a message. A body takes part in no exchange of duties and makes no way: where one rests, ways
//! lead round it.

use pleach_continuous::Point;
use pleach_continuous::geometry::Disc;
use pleach_continuous::network::reliability::LinkReliability;

use super::Robot;
use super::motion::STILL;

/// Control periods after which a body that has not moved rests.
const REST: u32 = 3;

/// The bodies near a robot.
#[derive(Clone, Debug, Default)]
pub(super) struct Bodies(Vec<Body>);

/// A robot of another fleet.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Body {
    place: Point,
    /// Where it was when it moved last.
    since: Point,
    /// Control periods since then.
    still: u32,
}

impl Bodies {
    /// Where they are in this control period. One that is within `leash` of where one has rested has not moved; where
    /// one that rests is `out_of_sight`, it is still there as far as is known.
    fn renew(&mut self, places: &[Point], leash: f64, out_of_sight: impl Fn(Point) -> bool) {
        let is_seen = |body: &Body| places.iter().any(|place| (body.since - place).norm() <= leash);
        let rests = |body: &&Body| body.still >= REST && out_of_sight(body.place) && !is_seen(body);
        let remembered: Vec<Body> = self.0.iter().filter(rests).copied().collect();
        let renewed = |&place: &Point| {
            let known = self.0.iter().find(|body| (body.since - place).norm() <= leash);
            match known {
                Some(body) => Body { place, still: body.still.saturating_add(1), ..*body },
                None => Body { place, since: place, still: 0 },
            }
        };
        self.0 = places.iter().map(renewed).chain(remembered).collect();
    }

    /// Where they are.
    pub(super) fn places(&self) -> impl Iterator<Item = Point> {
        self.0.iter().map(|body| body.place)
    }

    /// Where those are that rest.
    fn resting(&self) -> impl Iterator<Item = Point> {
        self.0.iter().filter(|body| body.still >= REST).map(|body| body.place)
    }
}

impl Robot {
    /// A control period begins: where the bodies near it are.
    pub(super) fn see_bodies(&mut self, places: &[Point]) {
        let leash = STILL * self.clearance().min(self.site.settings.step_radius);
        let (position, sight) = (self.body.position(), self.site.radio.range() - leash);
        self.neighbours
            .bodies_mut()
            .renew(places, leash, |place| (place - position).norm() > sight);
        if !places.is_empty() {
            self.note_change();
        }
    }

    /// The discs round bodies that rest, of this radius.
    pub(super) fn discs_of_bodies(&self, radius: f64) -> impl Iterator<Item = Disc> {
        self.neighbours.bodies().resting().map(move |center| Disc { center, radius })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_rests_that_stays_within_its_leash_and_moves_when_it_leaves_it() {
        let mut bodies = Bodies::default();
        let at = |x: f64| Point::new(x, 0.0);
        let mut see = |xs: &[f64]| {
            let places: Vec<Point> = xs.iter().copied().map(at).collect();
            bodies.renew(&places, 0.1, |_| false);
            (bodies.places().count(), bodies.resting().map(|place| place.x).collect::<Vec<_>>())
        };
        for still in 0..REST {
            assert_eq!(see(&[1.0, 2.0 + f64::from(still)]), (2, vec![]));
        }
        assert_eq!(see(&[1.05, 9.0]), (2, vec![1.05]));
        assert_eq!(see(&[1.08, 9.0]), (2, vec![1.08]), "it is still within its leash");
        assert_eq!(see(&[1.2]), (1, vec![]), "it has left it");
        assert_eq!(see(&[]), (0, vec![]));
    }

    /// A robot that turns round before it would turn round again as soon as it loses sight of it.
    #[test]
    fn a_body_that_rests_is_remembered_until_its_place_is_seen_empty() {
        let mut bodies = Bodies::default();
        let (resting, moving) = (Point::new(1.0, 0.0), Point::new(2.0, 0.0));
        let mut see = |places: &[Point], out_of_sight: bool| {
            bodies.renew(places, 0.1, |_| out_of_sight);
            bodies.resting().collect::<Vec<_>>()
        };
        (0..REST).for_each(|_| assert_eq!(see(&[resting], false), []));
        assert_eq!(see(&[resting, moving], false), [resting]);
        assert_eq!(see(&[], true), [resting]);
        assert_eq!(see(&[resting], true), [resting], "once");
        assert_eq!(see(&[], true), [resting]);
        assert_eq!(see(&[], false), []);
    }
}
