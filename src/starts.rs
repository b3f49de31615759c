//! Random places from which the robots of a scenario start.

use crate::automaton::network::Site;
use crate::automaton::network::scenario::ValidScenario;
use crate::continuous::Point;
use thiserror::Error;

/// Places that are tried for one robot before the draft is given up.
const TRIES: usize = 2_000;
/// Drafts that are tried before the scenario is.
const DRAFTS: u64 = 50;
/// Robots start this many clearances apart: a little more than the 2 that they keep.
const APART: f64 = 2.2;
/// The share of the longest new link within which robots start.
const REACH: f64 = 0.95;

/// No random starts were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "no random starts were found for {robots} robots in {DRAFTS} drafts; the free space within \
     reach of the access points may be too small for them, or their rates too high"
)]
pub struct NoStarts {
    /// How many robots there are.
    pub robots: usize,
}

/// The scenario with its robots at random places, from which a mission can start.
///
/// The robots are placed one after another, each within reach of an access point or of a robot
/// already placed. Equal seeds give equal places.
///
/// # Errors
/// When there is no room for the robots, or none of the drafts carries their rates.
///
/// ```
/// let scenario = pleach::scenario_file::read("scenarios/too-few.toml".as_ref())?;
/// let (one, other) = (pleach::starts::draw(&scenario, 1)?, pleach::starts::draw(&scenario, 2)?);
/// assert_ne!(one.robot, other.robot);
/// assert_eq!(one.robot, pleach::starts::draw(&scenario, 1)?.robot);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draw(scenario: &ValidScenario, seed: u64) -> Result<ValidScenario, NoStarts> {
    let robots = scenario.robot.len();
    (0..DRAFTS)
        .filter_map(|draft| {
            places(scenario.site(), robots, &mut Dice::new(seed, draft), |_, _| true)
        })
        .find_map(|starts| scenario.with_starts(&starts).ok())
        .ok_or(NoStarts { robots })
}

/// Random places for this many robots, each connected to an access point, or none if they do not
/// fit. Rates are not looked at. A robot is placed within reach of another node if this link `suits`.
pub(crate) fn places(
    site: &Site,
    robots: usize,
    dice: &mut Dice,
    suits: impl Fn(Point, Point) -> bool,
) -> Option<Vec<[f64; 2]>> {
    let reach = REACH * site.usual.build;
    let apart = APART * site.settings.planning_clearance();
    let mut nodes = site.access_points.clone();
    let fixed = nodes.len();
    for _ in 0..robots {
        let place = (0..TRIES).find_map(|_| {
            let anchor = nodes[dice.below(nodes.len())];
            let place = anchor + dice.in_disc()? * reach;
            let fits = site.free_space.contains(place)
                && nodes[fixed..].iter().all(|other| (place - other).norm() >= apart)
                && site.distance(anchor, place) <= reach
                && suits(anchor, place);
            fits.then_some(place)
        })?;
        nodes.push(place);
    }
    Some(nodes[fixed..].iter().map(|&place| place.into()).collect())
}

/// Places for this many robots as near to a place as they fit, by the length of the way; fewer if no more fit.
#[cfg(feature = "cli")]
pub(crate) fn around(site: &Site, place: Point, robots: usize) -> Vec<[f64; 2]> {
    let apart = APART * site.settings.planning_clearance();
    // Where half of the square around the place is free, it has room for all.
    let reach = (0..).map(|doubled| 1_i32 << doubled).take(RINGS);
    let mut places = Vec::new();
    for steps in reach {
        let side = -steps..=steps;
        let square = side.clone().flat_map(|row| side.clone().map(move |column| (column, row)));
        let lattice = square
            .map(|(column, row)| place + nalgebra::Vector2::new(column.into(), row.into()) * apart);
        let free = lattice.filter(|&spot| site.free_space.contains(spot));
        places = free.map(|spot| (site.distance(place, spot), spot)).collect();
        // Ways to what lies within the square may be longer than to what lies outside.
        places.retain(|(way, _)| *way <= f64::from(steps) * apart);
        if places.len() >= robots {
            break;
        }
    }
    places.sort_by(|one, other| one.0.total_cmp(&other.0));
    places.into_iter().take(robots).map(|(_, spot)| spot.into()).collect()
}

/// How often the square doubles in which robots are placed: to 128 of them in a row.
#[cfg(feature = "cli")]
const RINGS: usize = 7;

/// Random numbers by SplitMix64 (Steele, Lea and Flood, 2014): small, and the same everywhere.
#[derive(Clone, Debug)]
pub(crate) struct Dice(u64);

impl Dice {
    pub(super) fn new(seed: u64, draft: u64) -> Self {
        let mut dice = Self(seed);
        dice.0 = dice.next() ^ draft;
        dice
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// An index below `count`.
    pub(super) fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count - 1)
    }

    /// A point of the unit disc, if the point drawn from the square around it lies there.
    fn in_disc(&mut self) -> Option<nalgebra::Vector2<f64>> {
        let drawn = Point::new(2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0).coords;
        (drawn.norm() <= 1.0).then_some(drawn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_know_where_all_start() {
        let scenario = crate::scenario_file::read("scenarios/too-few.toml".as_ref()).unwrap();
        let drawn = draw(&scenario, 1).unwrap();
        for (number, robot) in drawn.robot.iter().enumerate() {
            assert_eq!(drawn.site().start_of(number), Some(robot.position.into()));
            assert_ne!(drawn.site().start_of(number), scenario.site().start_of(number));
        }
    }
}
