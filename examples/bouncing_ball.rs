//! # The bouncing ball
//!
//! A ball falls from rest under gravity, ḧ = −g, and bounces off the floor with λ times the speed of
//! the impact. Each flight is shorter than the one before by the factor λ, so infinitely many
//! impacts accumulate before a finite instant: the run is *Zeno*.
//!
//! The model is the first example of Goebel, Sanfelice and Teel, *Hybrid dynamical systems* (2009),
//! [doi:10.1109/MCS.2008.931718](https://doi.org/10.1109/MCS.2008.931718). The numbers, a drop of
//! 1 m with g = 9.81 m/s² and λ = 0.8, are those of Example 1.2 of the Hybrid Equations Toolbox,
//! [doi:10.1145/2461328.2461346](https://doi.org/10.1145/2461328.2461346).
//!
//! In closed form, the first fall takes τ = √(2h/g), the flight after impact k takes 2 λᵏ τ, and all
//! of them together take τ (1 + λ)/(1 − λ).

mod exhibit;

use exhibit::{Exhibit, Shown, accumulation};
use pleach::prelude::*;
use std::error::Error;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    /// A ball does one thing.
    pub enum Motion: Location { Falling = "falling" }
    /// And one thing happens to it.
    pub enum Contact: Event { Bounce = "bounce" }
}

coordinates! {
    /// Metres above the floor, and metres a second upwards.
    pub struct Ball { height = "h", velocity = "v" }
}

const HEIGHT: f64 = 1.0;
const GRAVITY: f64 = 9.81;
const RESTITUTION: f64 = 0.8;

/// A ball that is dropped.
pub fn bouncing_ball() -> Result<Automaton<Motion, Contact, Ball>, BuildError> {
    let Ball { height, velocity } = Ball::coordinates();
    Automaton::starting_in(Motion::Falling)
        .initially(Ball { height: HEIGHT, velocity: 0.0 })
        .flow(Motion::Falling, [height.rate(&velocity), velocity.rate(-GRAVITY)])
        .invariant(Motion::Falling, height.at_least(0.0))
        .transition(
            from(Motion::Falling)
                .on(Contact::Bounce)
                .to(Motion::Falling)
                .must(height.at_most(0.0) & velocity.less_than(0.0))
                .then(velocity.becomes(-RESTITUTION * &velocity)),
        )
        .build()
}

// ---- The answer --------------------------------------------------------------------------------

/// How long the first fall takes, in seconds.
fn first_fall() -> f64 {
    (2.0 * HEIGHT / GRAVITY).sqrt()
}

/// The instant of impact `number` ≥ 1: the fall and the geometric series of the flights, added up.
fn impact(number: i32) -> f64 {
    let flights = RESTITUTION * (1.0 - RESTITUTION.powi(number - 1)) / (1.0 - RESTITUTION);
    first_fall() * (1.0 + 2.0 * flights)
}

/// The instant at which the impacts accumulate.
fn zeno_time() -> f64 {
    first_fall() * (1.0 + RESTITUTION) / (1.0 - RESTITUTION)
}

/// The ball for ten seconds, of which it uses four.
pub fn exhibit() -> Shown {
    let ball = bouncing_ball()?;
    let trajectory = ball.run(10.0)?;
    Ok(Exhibit::new("bouncing_ball", include_str!("bouncing_ball.rs"))
        .automaton("ball", &ball)
        .compare_jumps(&trajectory, (1..=8).map(impact), 1e-12)
        .compare("Zeno time in s", accumulation(&trajectory), zeno_time(), 1e-12)
        .run("A ball dropped from 1 m", trajectory))
}

fn main() -> Result<(), Box<dyn Error>> {
    exhibit()?.show()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impacts_and_zeno_time_are_those_of_the_closed_form() {
        let exhibit = exhibit().expect("the ball can be run");
        assert_eq!(exhibit.disagreements(), [""; 0]);
    }

    /// Where the time scale is τ: 1e-9 of it is asked for, and three orders more are there.
    #[test]
    fn every_impact_is_located_to_the_last_digits() {
        let trajectory = bouncing_ball().expect("it is sound").run(10.0).expect("it can be run");
        assert!(trajectory.jumps().len() > 30);
        for (number, jump) in (1..).zip(trajectory.jumps()) {
            let error = (jump.at.t - impact(number)).abs();
            assert!(error < 1e-12 * first_fall(), "impact {number} is off by {error:e} s");
        }
    }
}
