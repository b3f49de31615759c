//! # The thermostat
//!
//! A room cools by ẋ = −0.1 x, and warms by ẋ = 5 − 0.1 x while the heater is on. Below 19 °C the
//! heater may turn on, and below 18 °C it cannot stay off; above 21 °C it may turn off, and above
//! 22 °C it cannot stay on.
//!
//! This is the thermostat of Figure 1 in Henzinger, *The theory of hybrid automata* (1996),
//! [doi:10.1109/LICS.1996.561342](https://doi.org/10.1109/LICS.1996.561342), with its numbers. It is
//! nondeterministic: a guard allows a transition, and only the end of an invariant forces it. Two of
//! its runs are shown, the extremes: one takes every transition as soon as it may, the other as late
//! as it can.
//!
//! In closed form, cooling from a to b takes 10 ln(a/b) seconds, and warming takes 10
//! ln((50 − a)/(50 − b)) seconds.

mod exhibit;

use exhibit::{Exhibit, Shown, instants};
use pleach::prelude::*;
use std::error::Error;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    /// What the heater does.
    pub enum Heater: Location { Off = "off", On = "on" }
    /// What is done to it.
    pub enum Switch: Event { TurnOn = "turn on", TurnOff = "turn off" }
}

coordinates! {
    /// The temperature in °C.
    pub struct Room { temperature = "x" }
}

/// A room with a heater that somebody switches.
pub fn thermostat() -> Result<Automaton<Heater, Switch, Room>, BuildError> {
    use {Heater::*, Switch::*};
    let Room { temperature } = Room::coordinates();
    Automaton::starting_in(Off)
        .initially(Room { temperature: 20.0 })
        .flow(Off, temperature.rate(-0.1 * &temperature))
        .flow(On, temperature.rate(5.0 - 0.1 * &temperature))
        .invariant(Off, temperature.at_least(18.0))
        .invariant(On, temperature.at_most(22.0))
        .transition(from(Off).on(TurnOn).to(On).may(temperature.less_than(19.0)))
        .transition(from(On).on(TurnOff).to(Off).may(temperature.more_than(21.0)))
        .build()
}

// ---- The answer --------------------------------------------------------------------------------

/// How long the runs are, in seconds.
const HORIZON: f64 = 20.0;

/// The instants at which a heater switches that is turned on at `low` and off at `high`.
fn switchings(low: f64, high: f64) -> impl Iterator<Item = f64> {
    let cooling = |from: f64| 10.0 * (from / low).ln();
    let warming = 10.0 * ((50.0 - low) / (50.0 - high)).ln();
    let (first, cycle) = (cooling(20.0), warming + cooling(high));
    let instants = (0..).flat_map(move |number| {
        let turned_on = first + f64::from(number) * cycle;
        [turned_on, turned_on + warming]
    });
    instants.take_while(|t| *t <= HORIZON)
}

/// The two extreme runs.
pub fn exhibit() -> Shown {
    let thermostat = thermostat()?;
    let run = |policy| thermostat.run_with(Settings { policy, ..Settings::default() }, HORIZON);
    let (eager, patient) = (run(Policy::Early)?, run(Policy::Late)?);
    Ok(Exhibit::new("thermostat", include_str!("thermostat.rs"))
        .automaton("thermostat", &thermostat)
        .compare_all("switching early, in s", instants(&eager), switchings(19.0, 21.0), 1e-12)
        .compare_all("switching late, in s", instants(&patient), switchings(18.0, 22.0), 1e-12)
        .run("As soon as a transition may be taken", eager)
        .run("As late as the invariants allow", patient))
}

fn main() -> Result<(), Box<dyn Error>> {
    exhibit()?.show()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heater_switches_when_the_logarithms_say() {
        let exhibit = exhibit().expect("the thermostat can be run");
        assert_eq!(exhibit.disagreements(), [""; 0]);
    }

    #[test]
    fn every_run_keeps_the_temperature_between_18_and_22_degrees() {
        for policy in [Policy::Early, Policy::Late] {
            let settings = Settings { policy, ..Settings::default() };
            let thermostat = thermostat().expect("it is sound");
            let trajectory = thermostat.run_with(settings, 100.0).expect("it can be run");
            assert_eq!(trajectory.ending().reason, Reason::Horizon);
            for (at, sample) in trajectory.samples() {
                assert!((18.0 - 1e-9..=22.0 + 1e-9).contains(&sample.values[0]), "at {at}");
            }
        }
    }
}
