//! Missions in storms of all kinds, in shipped scenarios and on the floor plans of every day in turn.

use pleach::automaton::network::scenario::{
    MotionSolver, RoutingMethod, Scenario, Settings, Strategy, ValidScenario,
};
use pleach::verify::network::storm::{Kind, Storm, allowing_for, draw};

use crate::floor_plans::{Dice, Family, scenario as plan};
use crate::{shipped, valid};

/// Scenarios that are tried in storms beside random ones.
pub const SHIPPED: [&str; 5] = ["study-1", "study-2", "office", "discs", "corridor"];
/// Control periods for which a mission is taken to last when its faults are drawn.
pub const DURATION: f64 = 300.0;

/// The mission of a seed, and its storm: kinds and plans take turns.
pub fn mission_in_storm(seed: u64) -> (ValidScenario, Storm) {
    let (turn, kind) = turn(seed);
    mission_of_turn(turn, kind, seed)
}

/// The same with settings that are drawn as well.
pub fn mission_with_settings_in_storm(seed: u64) -> (ValidScenario, Storm) {
    let (turn, kind) = turn(seed);
    in_storm(kind, seed, with_settings(&plan_of_turn(turn, seed), seed))
}

/// Which plan and which kind of storm have their turn.
fn turn(seed: u64) -> (usize, Kind) {
    let kinds = Kind::ALL.len();
    (seed as usize / kinds, Kind::ALL[seed as usize % kinds])
}

/// The mission on the plan whose turn it is, in a storm of this kind.
pub fn mission_of_turn(turn: usize, kind: Kind, seed: u64) -> (ValidScenario, Storm) {
    in_storm(kind, seed, plan_of_turn(turn, seed))
}

fn plan_of_turn(turn: usize, seed: u64) -> ValidScenario {
    let families: Vec<Family> = Family::of_every_day().collect();
    match turn % (SHIPPED.len() + families.len()) {
        number if number < SHIPPED.len() => valid(shipped(SHIPPED[number])),
        number => plan(families[number - SHIPPED.len()], seed),
    }
}

/// Where there is no room for errors, robots do not allow for them, and there are none.
fn in_storm(kind: Kind, seed: u64, scenario: ValidScenario) -> (ValidScenario, Storm) {
    match allowing_for(kind, &scenario) {
        Ok(scenario) => {
            let duration = DURATION * scenario.settings().period;
            let storm = draw(kind, seed, &scenario, duration);
            (scenario, storm)
        }
        Err(_) => (scenario, Storm::default()),
    }
}

/// Draws of settings that may not be valid together.
const ATTEMPTS: u64 = 50;

/// The same mission with settings drawn from this seed.
fn with_settings(scenario: &ValidScenario, seed: u64) -> ValidScenario {
    let drawn = (0..ATTEMPTS).find_map(|attempt| {
        let mut changed = scenario.scenario().clone();
        draw_settings(&mut changed, &mut Dice::new(&[seed, attempt]));
        ValidScenario::new(changed).ok()
    });
    drawn.unwrap_or_else(|| scenario.clone())
}

fn draw_settings(scenario: &mut Scenario, dice: &mut Dice) {
    let usual = Settings::resolve(scenario);
    let clearance = usual.clearance * dice.pick(&[0.4, 0.7, 1.0]);
    let control = &mut scenario.control;
    control.clearance = Some(clearance);
    control.service_radius = Some(clearance * dice.between(2.3, 9.0));
    control.step_radius = Some(clearance * dice.between(0.5, 1.5));
    control.rounds_per_period = Some(dice.pick(&[1, 2, 4, 6, 8, 12, 20]));
    control.period = Some(dice.pick(&[0.3, 1.0, 7.0]));
    control.tree_reliability = Some(dice.pick(&[0.03, 0.1, 0.4]));
    control.routing_method = Some(dice.pick(&[
        RoutingMethod::AcceleratedDual,
        RoutingMethod::Dual,
        RoutingMethod::Adal,
    ]));
    control.routing_iterations = Some(dice.pick(&[1, 5, 20]));
    control.strategy = Some(dice.pick(&[Strategy::Eager, Strategy::Eager, Strategy::Paper]));
    if dice.chance(0.2) {
        control.motion_solver = Some(MotionSolver::Conic);
    }
    if dice.chance(0.3) {
        let rate = dice.scale(0.002, 0.07);
        scenario.robot.iter_mut().for_each(|robot| robot.rate = rate);
    }
}
