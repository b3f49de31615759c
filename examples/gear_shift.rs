//! # The gear shift
//!
//! A car accelerates at full throttle. In gear n the engine turns at ω = αₙ v, gives the torque
//! T(ω) = T_m (1 − β (ω/ω_m − 1)²), and pushes the car with αₙ T(αₙ v) against rolling resistance
//! and drag. When the engine reaches its limit of 600 rad/s, the gear box *selects* the lowest gear
//! in which the engine stays below the limit.
//!
//! Selecting is a location in which no time passes: all its transitions are *at once*, and
//! priorities order them. So the car can start at any speed, and is in the right gear at (0, 1).
//!
//! The car and its numbers are those of the cruise-control example in Åström and Murray, *Feedback
//! Systems* ([2nd edition, 2021](https://fbswiki.org), section 4.1), for a mass of 1600 kg. The
//! limit of 600 rad/s is our choice; in the fifth gear the drag keeps the engine below it. Gear
//! boxes with urgent locations go back to Lindahl, Pettersson and Yi, *Formal design and analysis of
//! a gear controller* (1998), [doi:10.1007/BFb0054178](https://doi.org/10.1007/BFb0054178).
//!
//! In every gear v̇ = a + bv + cv² with c < 0 < a, a Riccati equation with two real roots r > s. In
//! closed form, from u to v it takes (F(v) − F(u))/(c (r − s)) seconds, where
//! F(v) = ln((r − v)/(v − s)).

mod exhibit;

use exhibit::{Exhibit, Shown};
use pleach::prelude::*;
use std::error::Error;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    /// The gears, and the moment between two of them.
    pub enum Gear: Location {
        Selecting = "selecting", First = "1st", Second = "2nd", Third = "3rd", Fourth = "4th",
        Fifth = "5th",
    }
    /// Out of a gear, and into one.
    pub enum Shift: Event {
        Limit = "limit", Into1 = "into 1st", Into2 = "into 2nd", Into3 = "into 3rd",
        Into4 = "into 4th", Into5 = "into 5th",
    }
}
use {Gear::*, Shift::*};

coordinates! {
    /// The speed in metres a second.
    pub struct Car { speed = "v" }
}

/// The gears with α, in radians of the engine per metre on the road.
const GEARS: [(Gear, Shift, f64); 5] = [
    (First, Into1, 40.0),
    (Second, Into2, 25.0),
    (Third, Into3, 16.0),
    (Fourth, Into4, 12.0),
    (Fifth, Into5, 10.0),
];
const LIMIT: f64 = 600.0; // rad/s
const FASTEST: f64 = 58.0; // m/s, above what the drag allows
const TORQUE: f64 = 190.0; // T_m in Nm, at PEAK
const PEAK: f64 = 420.0; // ω_m in rad/s
const ROLLOFF: f64 = 0.4; // β
const MASS: f64 = 1600.0; // kg
const ROLLING: f64 = 0.098; // C_r g in m/s², with C_r = 0.01, g = 9.8
const DRAG: f64 = 0.4992; // ½ ρ C_d A in kg/m, with ρ = 1.3, C_d = 0.32, A = 2.4

fn acceleration(speed: &Expression, ratio: f64) -> Expression {
    let torque = TORQUE * (1.0 - ROLLOFF * (ratio * speed / PEAK - 1.0).power(2.0));
    (ratio * torque - DRAG * speed.power(2.0)) / MASS - ROLLING
}

/// A car at full throttle.
pub fn gear_shift() -> Result<Automaton<Gear, Shift, Car>, BuildError> {
    let Car { speed } = Car::coordinates();
    let mut car = Automaton::starting_in(Selecting)
        .initially(Car { speed: 0.0 })
        .range(&speed, 0.0..=FASTEST);
    for (order, (gear, into, ratio)) in (0..).zip(GEARS) {
        let engine = ratio * &speed;
        let select = from(Selecting).on(into).to(gear).at_once(engine.less_than(LIMIT));
        car = car
            .flow(gear, speed.rate(acceleration(&speed, ratio)))
            .transition(select.priority(order));
        if ratio * FASTEST >= LIMIT {
            let limit = from(gear).on(Limit).to(Selecting).must(engine.at_least(LIMIT));
            car = car.transition(limit);
        }
    }
    car.build()
}

// ---- The answer --------------------------------------------------------------------------------

/// What v̇ = a + bv + cv² is in a gear: c, and the roots r > s.
fn riccati(ratio: f64) -> (f64, f64, f64) {
    let a = ratio * TORQUE * (1.0 - ROLLOFF) / MASS - ROLLING;
    let b = 2.0 * ratio.powi(2) * TORQUE * ROLLOFF / (PEAK * MASS);
    let c = -(ratio.powi(3) * TORQUE * ROLLOFF / PEAK.powi(2) + DRAG) / MASS;
    let root = (b * b - 4.0 * a * c).sqrt();
    (c, (-b - root) / (2.0 * c), (-b + root) / (2.0 * c))
}

/// How long it takes in a gear from one speed to another.
fn time_to_accelerate(ratio: f64, from: f64, to: f64) -> f64 {
    let (c, r, s) = riccati(ratio);
    let primitive = |v: f64| ((r - v) / (v - s)).ln() / (c * (r - s));
    primitive(to) - primitive(from)
}

/// The speed after `time` in a gear.
fn speed_after(ratio: f64, from: f64, time: f64) -> f64 {
    let (c, r, s) = riccati(ratio);
    let quotient = (r - from) / (from - s) * (c * (r - s) * time).exp();
    (r + quotient * s) / (1.0 + quotient)
}

/// The instants at which a car that starts from rest leaves its gears, but for the fifth.
fn shifts() -> Vec<f64> {
    let (mut instants, mut now, mut speed) = (Vec::new(), 0.0, 0.0);
    for (_, _, ratio) in &GEARS[..4] {
        now += time_to_accelerate(*ratio, speed, LIMIT / ratio);
        speed = LIMIT / ratio;
        instants.push(now);
    }
    instants
}

/// A car from rest, for 90 s, and one that is put on the road at 30 m/s.
pub fn exhibit() -> Shown {
    let car = gear_shift()?;
    let (run, rolling) = (car.run(90.0)?, car.run_from(Car { speed: 30.0 }, 20.0)?);
    let shifts = shifts();
    // The car selects at the start, and then selects at the instant at which it leaves a gear.
    let jumps = [0.0].into_iter().chain(shifts.iter().flat_map(|&t| [t, t]));
    let fast = speed_after(10.0, LIMIT / 12.0, 90.0 - shifts[3]);
    let left = time_to_accelerate(16.0, 30.0, LIMIT / 16.0);
    let found = |run: &Trajectory, t| run.value("v", t).unwrap_or(f64::NAN);
    Ok(Exhibit::new("gear_shift", include_str!("gear_shift.rs"))
        .automaton("gears", &car)
        .compare_jumps(&run, jumps, 1e-7)
        .compare("speed after 90 s in m/s", found(&run, 90.0), fast, 1e-7)
        .compare("3rd gear left, from 30 m/s, in s", rolling.jumps()[1].at.t, left, 1e-7)
        .run("From rest", run)
        .run("From 30 m/s", rolling))
}

fn main() -> Result<(), Box<dyn Error>> {
    exhibit()?.show()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pleach::automaton::trajectory::FlowInterval;

    #[test]
    fn shifts_and_speeds_are_those_of_the_closed_form() {
        let exhibit = exhibit().expect("the car can be driven");
        assert_eq!(exhibit.disagreements(), [""; 0]);
    }

    #[test]
    fn selecting_takes_no_time() {
        let trajectory = gear_shift().expect("it is sound").run(90.0).expect("it can be run");
        let selecting = |phase: &FlowInterval| phase.locations == [Selecting as usize];
        let phases: Vec<_> = trajectory.intervals().filter(selecting).collect();
        assert_eq!(phases.len(), 5);
        assert!(phases.iter().all(|phase| phase.samples.len() == 1));
    }

    #[test]
    fn the_gear_fits_the_speed_from_the_start() {
        let car = gear_shift().expect("it is sound");
        for (speed, gear) in
            [(0.0, "1st"), (15.0, "2nd"), (30.0, "3rd"), (49.9, "4th"), (50.0, "5th")]
        {
            let trajectory = car.run_from(Car { speed }, 0.0).expect("it can be run");
            assert_eq!(trajectory.location(0, 0.0), Some(gear));
        }
    }
}
