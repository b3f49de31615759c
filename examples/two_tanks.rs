//! # Two tanks
//!
//! Two tanks leak, each by v litres a second, and a hose fills one of them at a time by w litres a
//! second. The hose changes over to a tank that runs empty. With v < w < 2v it brings more than one
//! tank loses and less than both lose, so it changes over ever faster, infinitely often before the
//! instant at which all the water is gone: the run is Zeno without any reset.
//!
//! The model is from Alur and Henzinger, *Modularity for timed and hybrid systems* (1997),
//! [doi:10.1007/3-540-63141-0_6](https://doi.org/10.1007/3-540-63141-0_6); Zhang, Johansson, Lygeros
//! and Sastry, *Zeno hybrid systems* (2001), [doi:10.1002/rnc.592](https://doi.org/10.1002/rnc.592),
//! studied its accumulation. The numbers, v = 1/2, w = 3/4 and 0 and 1 litres at the start, are
//! those of the exercise on Figure 4.17 in Lee and Seshia, *Introduction to Embedded Systems* (2nd
//! edition, 2017).
//!
//! In closed form, all the water, 1 litre, is lost at the rate 2v − w, after 4 s. Flow k + 1 takes
//! (w − v)/v = 1/2 times as long as flow k, and the first takes 1/v = 2 s.

mod exhibit;

use exhibit::{Exhibit, Shown, accumulation};
use pleach::prelude::*;
use std::error::Error;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    /// Where the hose is.
    pub enum Hose: Location { Left = "left", Right = "right" }
    /// Which tank runs empty.
    pub enum Empty: Event { LeftEmpty = "left empty", RightEmpty = "right empty" }
}

coordinates! {
    /// The levels in litres.
    pub struct Tanks { left = "x₁", right = "x₂" }
}

const INFLOW: f64 = 0.75;
const OUTFLOW: f64 = 0.5;
const GAIN: f64 = INFLOW - OUTFLOW;

/// Two tanks and a hose that follows need.
pub fn two_tanks() -> Result<Automaton<Hose, Empty, Tanks>, BuildError> {
    use {Empty::*, Hose::*};
    let Tanks { left, right } = Tanks::coordinates();
    Automaton::starting_in(Left)
        .initially(Tanks { left: 0.0, right: 1.0 })
        .flow(Left, [left.rate(GAIN), right.rate(-OUTFLOW)])
        .flow(Right, [left.rate(-OUTFLOW), right.rate(GAIN)])
        .invariant(Left, right.at_least(0.0))
        .invariant(Right, left.at_least(0.0))
        .transition(from(Left).on(RightEmpty).to(Right).must(right.at_most(0.0)))
        .transition(from(Right).on(LeftEmpty).to(Left).must(left.at_most(0.0)))
        .build()
}

// ---- The answer --------------------------------------------------------------------------------

const WATER: f64 = 1.0;

/// The instant of change-over `number` ≥ 1: a geometric series, added up.
fn change_over(number: i32) -> f64 {
    let ratio = GAIN / OUTFLOW;
    WATER / OUTFLOW * (1.0 - ratio.powi(number)) / (1.0 - ratio)
}

/// The instant at which the water is gone.
fn zeno_time() -> f64 {
    WATER / (2.0 * OUTFLOW - INFLOW)
}

/// The tanks for 10 s, of which they use four.
pub fn exhibit() -> Shown {
    let tanks = two_tanks()?;
    let trajectory = tanks.run(10.0)?;
    Ok(Exhibit::new("two_tanks", include_str!("two_tanks.rs"))
        .automaton("tanks", &tanks)
        .compare_jumps(&trajectory, (1..=8).map(change_over), 1e-12)
        .compare("Zeno time in s", accumulation(&trajectory), zeno_time(), 1e-12)
        .run("From 0 and 1 litres", trajectory))
}

fn main() -> Result<(), Box<dyn Error>> {
    exhibit()?.show()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn change_overs_and_zeno_time_are_those_of_the_closed_form() {
        let exhibit = exhibit().expect("the tanks can be run");
        assert_eq!(exhibit.disagreements(), [""; 0]);
    }

    #[test]
    fn water_is_lost_at_a_steady_rate() {
        let trajectory = two_tanks().expect("it is sound").run(10.0).expect("it can be run");
        for (at, sample) in trajectory.samples() {
            let left = WATER - (2.0 * OUTFLOW - INFLOW) * at.t;
            assert!((sample.values.iter().sum::<f64>() - left).abs() < 1e-12, "at {at}");
        }
    }

    #[test]
    fn tanks_that_get_enough_water_are_not_zeno() {
        let plenty = Tanks { left: 100.0, right: 100.0 };
        let trajectory = two_tanks().expect("it is sound").run_from(plenty, 100.0);
        assert_eq!(trajectory.expect("it can be run").ending().reason, Reason::Horizon);
    }
}
