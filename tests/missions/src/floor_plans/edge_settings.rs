//! Small rooms with settings at the ends of their ranges.

use super::ATTEMPTS;
use super::dice::Dice;
use super::small_rooms::small_room;
use pleach::automaton::network::scenario::{
    Control, MotionSolver, RoutingMethod, Scenario, Settings, Strategy, ValidScenario,
};

/// Control periods after which a mission is given up: whether it violates an invariant shows before.
const PERIODS: usize = 2_000;

/// The small room with this seed, some of whose settings are at an end of their range.
pub fn edge_settings(seed: u64) -> ValidScenario {
    const FAMILY: u64 = 1_001;
    let name = format!("edge-settings-{seed}");
    (0..100 * ATTEMPTS)
        .map(|attempt| {
            let mut dice = Dice::new(&[FAMILY, seed, attempt]);
            let mut scenario = small_room(dice.count(1, 1_000_000) as u64).into_scenario();
            scenario.name.clone_from(&name);
            scenario.control = control(&scenario, &mut dice);
            scenario
        })
        .find_map(|scenario| ValidScenario::new(scenario).ok())
        .unwrap_or_else(|| panic!("{name}: no draft is a valid scenario"))
}

/// Each setting is left to its default or at an end of its range.
fn control(scenario: &Scenario, dice: &mut Dice) -> Control {
    let range = scenario.link.max_range;
    let mut control = Control { max_steps: Some(PERIODS), ..Control::default() };
    let strategies = [Strategy::Eager, Strategy::Paper];
    control.strategy = dice.chance(0.5).then(|| dice.pick(&strategies));
    control.clearance = dice.chance(0.3).then(|| dice.pick(&[1e-4, 0.002, 0.03, 0.06]));
    let clearance = Settings::resolve(&with(scenario, control)).clearance;
    control.position_error = dice.chance(0.2).then_some(clearance / 2.0);
    control.motion_error = dice.chance(0.2).then_some(clearance / 2.0);
    let settings = Settings::resolve(&with(scenario, control));
    let kept = settings.planning_clearance();
    let least = 2.3 * kept + settings.errors.stray() + 2.0 * settings.errors.motion;
    control.service_radius = dice.chance(0.3).then(|| dice.pick(&[least, 0.5 * range]));
    let longest = (range - 2.0 * kept - settings.link_margin()) / 2.0;
    control.step_radius = dice.chance(0.5).then(|| dice.pick(&[longest, longest, 0.05 * longest]));
    control.residual_tolerance = dice.chance(0.2).then(|| dice.pick(&[0.01, 1.0]));
    control.period = dice.chance(0.1).then(|| dice.pick(&[1e-6, 1e6]));
    control.rounds_per_period = dice.chance(0.3).then(|| dice.pick(&[1, 4, 5, 40]));
    let methods = [RoutingMethod::Dual, RoutingMethod::AcceleratedDual, RoutingMethod::Adal];
    control.routing_method = dice.chance(0.4).then(|| dice.pick(&methods));
    control.routing_iterations = dice.chance(0.3).then(|| dice.pick(&[1, 1, 100]));
    let reserve = control.routing_method.unwrap_or_default().least_reserve();
    control.routing_reserve = dice.chance(0.3).then(|| dice.pick(&[reserve, reserve, 1.0]));
    control.slope_aversion = dice.chance(0.3).then(|| dice.pick(&[0.0, 1e6]));
    control.tree_reliability = dice.chance(0.4).then(|| dice.pick(&[1e-6, 0.001, 0.5, 0.999]));
    let weakest = Settings::resolve(&with(scenario, control)).tree_reliability;
    control.build_reliability = dice.chance(0.3).then(|| dice.pick(&[weakest, 0.9999]));
    control.motion_solver = dice.chance(0.2).then_some(MotionSolver::Conic);
    control
}

fn with(scenario: &Scenario, control: Control) -> Scenario {
    Scenario { control, ..scenario.clone() }
}
