//! Small rooms with two to four robots: so few that whether they suffice can be searched out.

use super::ATTEMPTS;
use super::dice::Dice;
use super::outline::{Floor, Rectangle};
use pleach::automaton::network::scenario::{
    AccessPoint, Agenda, Control, LinkRanges, RobotStart, Scenario, Strategy, Task, ValidScenario,
};
use std::f64::consts::TAU;

/// l.
const FULL_RANGE: f64 = 0.4;
/// u.
const MAX_RANGE: f64 = 0.5;
/// How far a robot starts from the access point or from a robot before it.
const NEAR: f64 = 0.38;

/// The small room with this seed. Robots may be too few for its one or two tasks, and tasks may lie in walls.
pub fn small_room(seed: u64) -> ValidScenario {
    const FAMILY: u64 = 1_000;
    let name = format!("small-room-{seed}");
    (0..100 * ATTEMPTS)
        .filter_map(|attempt| draft(name.clone(), &mut Dice::new(&[FAMILY, seed, attempt])))
        .find_map(|scenario| ValidScenario::new(scenario).ok())
        .unwrap_or_else(|| panic!("{name}: no draft is a valid scenario"))
}

fn draft(name: String, dice: &mut Dice) -> Option<Scenario> {
    let (wide, high) = (dice.scale(0.5, 2.2), dice.scale(0.4, 1.2));
    let mut floor = Floor::of(vec![Rectangle::new(0.0, 0.0, wide, high)]);
    match dice.count(0, 3) {
        0 => {}
        1 => baffles(&mut floor, wide, high, dice),
        2 => pillars(&mut floor, wide, high, dice),
        _ => {
            baffles(&mut floor, wide, high, dice);
            pillars(&mut floor, wide, high, dice);
        }
    }
    let somewhere = |dice: &mut Dice| [dice.between(0.0, wide), dice.between(0.0, high)];
    let access_point = somewhere(dice);
    let mut places = vec![access_point];
    for _ in 0..dice.count(2, 4) {
        let [x, y] = dice.pick(&places);
        let (angle, distance) = (dice.between(0.0, TAU), NEAR * dice.between(0.0, 1.0).sqrt());
        places.push([x + distance * angle.cos(), y + distance * angle.sin()]);
    }
    let rate = dice.pick(&[0.02, 0.05, 0.075]);
    let control = Control {
        service_radius: dice.chance(0.3).then(|| rounded(dice.between(0.024, 0.07))),
        strategy: dice.chance(0.3).then_some(Strategy::Paper),
        ..Control::default()
    };
    Some(Scenario {
        name,
        description: None,
        workspace: floor.outline().map(|mut outline| {
            let polygons = [&mut outline.boundary].into_iter().chain(&mut outline.holes);
            polygons.flatten().for_each(|corner| *corner = corner.map(rounded));
            outline
        })?,
        link: LinkRanges::new(FULL_RANGE, MAX_RANGE),
        control,
        mission: Agenda::default(),
        access_point: vec![AccessPoint { position: access_point.map(rounded) }],
        robot: (places[1..].iter()).map(|place| RobotStart::at(place.map(rounded), rate)).collect(),
        task: (0..dice.count(1, 2)).map(|_| Task::at(somewhere(dice).map(rounded))).collect(),
    })
}

/// Walls from below and from above, thick or thin.
fn baffles(floor: &mut Floor, wide: f64, high: f64, dice: &mut Dice) {
    for _ in 0..dice.count(1, 3) {
        let thick = dice.scale(0.01, 0.15);
        let left = dice.between(0.05, (wide - 0.05 - thick).max(0.06));
        let long = dice.between(0.3, 0.97) * high;
        let bottom = if dice.chance(0.5) { 0.0 } else { high - long };
        floor.walls.push(Rectangle::new(left, bottom, left + thick, bottom + long));
    }
}

/// Convex polygons inside the room.
fn pillars(floor: &mut Floor, wide: f64, high: f64, dice: &mut Dice) {
    for _ in 0..dice.count(1, 3) {
        let radius = dice.scale(0.03, 0.25);
        let center = [dice.between(radius, wide - radius), dice.between(radius, high - radius)];
        let (corners, start) = (dice.count(3, 6), dice.between(0.0, TAU));
        let corner = |at: usize| {
            let angle = start + TAU * at as f64 / corners as f64;
            [center[0] + radius * angle.cos(), center[1] + radius * angle.sin()]
        };
        floor.pillars.push((0..corners).map(corner).collect());
    }
}

/// A thousandth, as a person would write it.
fn rounded(number: f64) -> f64 {
    (number * 1e3).round() / 1e3
}
