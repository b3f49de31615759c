//! # The heater and its controller
//!
//! The thermostat, split into two components. The heater warms the room and can be switched at any
//! time; the controller reads the temperature through a *connection* and decides when to switch.
//! Both share two *labels*, `turn on` and `turn off`, and take each in one jump.
//!
//! Composition by shared labels follows Alur et al., *The algorithmic analysis of hybrid systems*
//! (1995), [doi:10.1016/0304-3975(94)00202-T](https://doi.org/10.1016/0304-3975(94)00202-T); a
//! connection is a shared variable in the sense of Lynch, Segala and Vaandrager, *Hybrid I/O
//! automata* (2003),
//! [doi:10.1016/S0890-5401(03)00067-1](https://doi.org/10.1016/S0890-5401(03)00067-1). The rates are
//! those of the [thermostat](thermostat.md), and the thresholds its guards, 19 and 21 °C.
//!
//! The run is compared with the same system written as one automaton, at every instant, and with the
//! closed form of its switching.

mod exhibit;

use exhibit::{Exhibit, Shown};
use pleach::prelude::*;
use std::error::Error;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    /// What the heater does.
    pub enum Heater: Location { Off = "off", On = "on" }
    /// The controller needs no memory.
    pub enum Controller: Location { Watching = "watching" }
    /// What they do together.
    pub enum Switch: Event { TurnOn = "turn on", TurnOff = "turn off" }
}
use Controller::Watching;
use Heater::{Off, On};
use Switch::{TurnOff, TurnOn};

coordinates! {
    /// The temperature in °C.
    pub struct Room { temperature = "T" }
    /// The temperature as the controller sees it, in °C.
    pub struct Reading { seen = "T" }
}

const START: f64 = 20.0;
const LOW: f64 = 19.0;
const HIGH: f64 = 21.0;

/// A room with a heater that can be switched at any time.
pub fn heater() -> Result<Automaton<Heater, Switch, Room>, BuildError> {
    let Room { temperature } = Room::coordinates();
    Automaton::starting_in(Off)
        .initially(Room { temperature: START })
        .flow(Off, temperature.rate(-0.1 * &temperature))
        .flow(On, temperature.rate(5.0 - 0.1 * &temperature))
        .transition(from(Off).on(TurnOn).to(On).may(always()))
        .transition(from(On).on(TurnOff).to(Off).may(always()))
        .build()
}

/// A controller that must switch at its thresholds.
pub fn controller() -> Result<Automaton<Controller, Switch, Reading>, BuildError> {
    let Reading { seen } = Reading::coordinates();
    Automaton::starting_in(Watching)
        .initially(Reading { seen: START })
        .transition(from(Watching).on(TurnOn).to(Watching).must(seen.at_most(LOW)))
        .transition(from(Watching).on(TurnOff).to(Watching).must(seen.at_least(HIGH)))
        .build()
}

/// Both, side by side.
pub fn heater_and_controller() -> Result<Composition, Box<dyn Error>> {
    let composition = Composition::builder()
        .add("heater", &heater()?)
        .add("controller", &controller()?)
        .connect("heater.T", "controller.T")
        .label("turn on")
        .label("turn off")
        .build()?;
    Ok(composition)
}

/// The same as one automaton.
pub fn monolith() -> Result<Automaton<Heater, Switch, Room>, BuildError> {
    let Room { temperature } = Room::coordinates();
    Automaton::starting_in(Off)
        .initially(Room { temperature: START })
        .flow(Off, temperature.rate(-0.1 * &temperature))
        .flow(On, temperature.rate(5.0 - 0.1 * &temperature))
        .transition(from(Off).on(TurnOn).to(On).must(temperature.at_most(LOW)))
        .transition(from(On).on(TurnOff).to(Off).must(temperature.at_least(HIGH)))
        .build()
}

// ---- The answer --------------------------------------------------------------------------------

/// How long the runs are, in seconds.
const HORIZON: f64 = 20.0;

/// The instants of switching: a temperature decays towards 0 °C off and towards 50 °C on.
fn switchings() -> impl Iterator<Item = f64> {
    let cooling = |from: f64| 10.0 * (from / LOW).ln();
    let warming = 10.0 * ((50.0 - LOW) / (50.0 - HIGH)).ln();
    let (first, cycle) = (cooling(START), warming + cooling(HIGH));
    (0..).flat_map(move |number| {
        let turned_on = first + f64::from(number) * cycle;
        [turned_on, turned_on + warming]
    })
}

/// The temperature ten times a second.
fn temperatures(run: &Trajectory) -> impl Iterator<Item = f64> {
    run.resample(0.1).map(|(_, values)| values[0])
}

/// Composition and monolith for 20 s.
pub fn exhibit() -> Shown {
    let (composition, monolith) = (heater_and_controller()?, monolith()?);
    let (composed, alone) = (composition.run(HORIZON)?, monolith.run(HORIZON)?);
    Ok(Exhibit::new("heater_and_controller", include_str!("heater_and_controller.rs"))
        .component("heater", &heater()?)
        .component("controller", &controller()?)
        .composition("both", &composition)
        .automaton("monolith", &monolith)
        .compare_jumps(&composed, switchings(), 1e-12)
        .compare_all("temperature in °C", temperatures(&composed), temperatures(&alone), 1e-12)
        .run("Heater and controller", composed)
        .run("The monolith", alone))
}

fn main() -> Result<(), Box<dyn Error>> {
    exhibit()?.show()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_composition_switches_like_the_monolith_and_the_closed_form() {
        let exhibit = exhibit().expect("both can be run");
        assert_eq!(exhibit.disagreements(), [""; 0]);
    }

    #[test]
    fn heater_and_controller_switch_in_one_jump() {
        let trajectory =
            heater_and_controller().expect("the parts fit").run(HORIZON).expect("it can be run");
        assert!(trajectory.jumps().len() > 4);
        assert!(trajectory.jumps().iter().all(|jump| jump.moves.len() == 2));
    }
}
