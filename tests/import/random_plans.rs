//! Random noisy plans of polygons: what is valid comes out valid, and is floor where the map says so.

use super::shapes::{Dice, distance, is_inside};
use pleach::import::{self, Choices, Plan, Reading, SkeletonError};
use std::fmt::Write;
use std::path::Path;

type Ring = Vec<[f64; 2]>;

/// Rooms and walls on a grid, turned about the origin, each corner off by the noise of digitising.
struct Drawn {
    floors: Vec<Ring>,
    walls: Vec<Ring>,
}

impl Drawn {
    fn new(dice: &mut Dice) -> Self {
        let angle = 6.3 * dice.unit();
        let noise = [0.0, 1e-6, 5e-6, 1e-4][dice.below(4)];
        let size = 5.0 + 60.0 * dice.unit();
        let [floors, walls] = [1 + dice.below(3), dice.below(9)].map(|count| {
            (0..count).map(|_| Self::rectangle(dice, size / 12.0, angle, noise)).collect::<Vec<_>>()
        });
        let mut drawn = Self { floors, walls };
        let whole = [[0, 0], [12, 0], [12, 12], [0, 12]]
            .map(|[x, y]| [x, y].map(|it| f64::from(it) * size / 12.0));
        drawn.floors.push(whole.map(|corner| placed(corner, angle, noise, dice)).to_vec());
        drawn
    }

    /// Between lines of a grid, so that sides are shared and corners touch.
    fn rectangle(dice: &mut Dice, step: f64, angle: f64, noise: f64) -> Ring {
        let [column, row] = [dice.below(12), dice.below(12)].map(|it| it as f64 * step);
        let [wide, high] = [1 + dice.below(4), 1 + dice.below(4)].map(|it| it as f64 * step);
        let corners = [
            [column, row],
            [column + wide, row],
            [column + wide, row + high],
            [column, row + high],
        ];
        corners.map(|corner| placed(corner, angle, noise, dice)).to_vec()
    }

    fn text(&self) -> String {
        let mut features = Vec::new();
        for (kind, rings) in [("floor", &self.floors), ("wall", &self.walls)] {
            for ring in rings {
                let mut corners = String::new();
                for [x, y] in ring.iter().chain([&ring[0]]) {
                    let comma = if corners.is_empty() { "" } else { ", " };
                    write!(corners, "{comma}[{x}, {y}]").unwrap();
                }
                features.push(format!(
                    r#"{{"type": "Feature", "properties": {{"kind": "{kind}"}}, "geometry":
                        {{"type": "Polygon", "coordinates": [[{corners}]]}}}}"#
                ));
            }
        }
        format!(r#"{{"type": "FeatureCollection", "features": [{}]}}"#, features.join(",\n"))
    }

    fn is_floor(&self, place: [f64; 2]) -> bool {
        let is_in = |rings: &[Ring]| rings.iter().any(|ring| is_inside(&[ring], place));
        is_in(&self.floors) && !is_in(&self.walls)
    }

    fn distance(&self, place: [f64; 2]) -> f64 {
        let rings = self.floors.iter().chain(&self.walls);
        let sides = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
        sides.map(|(a, b)| distance(place, [*a, *b])).fold(f64::INFINITY, f64::min)
    }
}

fn placed([x, y]: [f64; 2], angle: f64, noise: f64, dice: &mut Dice) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    let [x, y] = [cos * x - sin * y, sin * x + cos * y];
    [x, y].map(|value| value + noise * (2.0 * dice.unit() - 1.0))
}

fn is_right(seed: u64) {
    let mut dice = Dice::new(seed);
    let drawn = Drawn::new(&mut dice);
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("random.geojson");
    std::fs::write(&path, drawn.text()).unwrap();
    let reading = Reading { planar: true, accepted_loss: 1.0, ..Reading::default() };
    let plan = match import::read(&path, &reading) {
        Ok(plan) => plan,
        // Walls may cover all.
        Err(error) if error.to_string().contains("no polygon with an area") => return,
        Err(error) => panic!("seed {seed}: {error}"),
    };
    has_a_valid_outline(&plan, seed);
    let rings: Vec<_> =
        std::iter::once(&plan.workspace.boundary).chain(&plan.workspace.holes).collect();
    for _ in 0..400 {
        let at = |axis: usize, dice: &mut Dice| {
            let values = plan.workspace.boundary.iter().map(|corner| corner[axis]);
            let (low, high) = (
                values.clone().fold(f64::INFINITY, f64::min),
                values.fold(f64::NEG_INFINITY, f64::max),
            );
            low + (high - low) * dice.unit()
        };
        let place = [at(0, &mut dice), at(1, &mut dice)];
        if drawn.distance(place) > 1e-3 && is_inside(&rings, place) {
            assert!(drawn.is_floor(place), "seed {seed}: {place:?} is no floor");
        }
    }
    let account = &plan.account;
    let floor = super::shapes::area(&plan.workspace.boundary)
        - plan.workspace.holes.iter().map(super::shapes::area).sum::<f64>();
    assert!(
        (floor - (account.stated - account.in_pieces)).abs() < 1e-6 * account.stated,
        "seed {seed}: {account:?}"
    );
}

/// Robots may find no place; the polygons must be right.
fn has_a_valid_outline(plan: &Plan, seed: u64) {
    let choices = Choices { clearance: Some(1e-3), robots: 1, ..Choices::named("random") };
    match import::skeleton(plan, &choices) {
        Ok(_) | Err(SkeletonError::NoRoom(_)) => {}
        Err(error) => panic!("seed {seed}: {error}"),
    }
}

#[test]
fn random_plans_stay_valid() {
    (0..40).for_each(is_right);
}

#[test]
#[ignore = "takes minutes"]
fn a_thousand_random_plans_stay_valid() {
    (0..1000).for_each(is_right);
}
