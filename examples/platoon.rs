//! # The vehicle platoon with lost communication
//!
//! Three vehicles follow a leader. The state of each is the excess of its gap to the vehicle ahead
//! over the desired one, in metres (x₁, x₄, x₇), the rate of that excess (x₂, x₅, x₈), and the
//! vehicle's acceleration (x₃, x₆, x₉). While the vehicles communicate, each controller uses the
//! states of all; without communication, the first two use only what they measure of the vehicle
//! ahead. The radio works for 5 s and fails for 5 s in turn.
//!
//! The benchmark is from Ben Makhlouf and Kowalewski, *Networked cooperative platoon of vehicles for
//! testing methods and verification tools* (ARCH 2014), with the gains of its two controllers as in
//! the ARCH competitions and the radio of their instance PLAD01. The leader may do anything between
//! braking with 9 m/s² and accelerating with 1 m/s², and within 20 s no gap may fall by 30 m
//! (PLAD01-BND30), which the tools of the competitions prove.
//!
//! Here the leader brakes all the time. The answer is a matrix exponential for each of the four
//! spans of 5 s; its impulse responses bound how far gaps can fall, whatever the leader does.

mod exhibit;
mod oracle;

use exhibit::{Exhibit, Shown, instants};
use oracle::Affine;
use pleach::automaton::{Rate, Vector};
use pleach::prelude::*;
use std::error::Error;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    enum Radio: Location { Up = "up", Down = "down" }
    enum Driving: Location { Together = "together", Alone = "alone" }
    enum Link: Event { Lost = "lost", Restored = "restored" }
}

coordinates! {
    struct Clock { clock = "τ" }
}

/// Excess of the gap, its rate and the acceleration, vehicle by vehicle.
type Platoon = Vector<9>;

/// What each vehicle makes of the state of all: the rate of its acceleration.
type Gains = [[f64; 9]; 3];

const TOGETHER: Gains = [
    [1.6050, 4.8680, -3.5754, -0.8198, 0.4270, -0.0450, -0.1942, 0.3626, -0.0946],
    [0.8718, 3.8140, -0.0754, 1.1936, 3.6258, -3.2396, -0.5950, 0.1294, -0.0796],
    [0.7132, 3.5730, -0.0964, 0.8472, 3.2568, -0.0876, 1.2726, 3.0720, -3.1356],
];
const ALONE: Gains = [
    [1.6050, 4.8680, -3.5754, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 1.1936, 3.6258, -3.2396, 0.0, 0.0, 0.0],
    [0.7132, 3.5730, -0.0964, 0.8472, 3.2568, -0.0876, 1.2726, 3.0720, -3.1356],
];

/// How long communication lasts and how long it is lost, in seconds.
const SPAN: f64 = 5.0;

fn radio() -> Result<Automaton<Radio, Link, Clock>, BuildError> {
    let Clock { clock } = Clock::coordinates();
    let is_over = clock.at_least(SPAN);
    Automaton::starting_in(Radio::Up)
        .initially(Clock { clock: 0.0 })
        .flow(Radio::Up, clock.rate(1.0))
        .flow(Radio::Down, clock.rate(1.0))
        .transition(
            from(Radio::Up)
                .on(Link::Lost)
                .to(Radio::Down)
                .must(is_over.clone())
                .then(clock.becomes(0.0)),
        )
        .transition(
            from(Radio::Down)
                .on(Link::Restored)
                .to(Radio::Up)
                .must(is_over)
                .then(clock.becomes(0.0)),
        )
        .build()
}

/// The flow behind a leader with that acceleration.
fn driving(gains: &Gains, leader: f64) -> Vec<Rate<Platoon>> {
    let x = Platoon::coordinates();
    let mut ahead = constant(leader);
    let mut rates = Vec::new();
    for (vehicle, gains) in x.chunks(3).zip(gains) {
        let [excess, approach, acceleration] = vehicle else { continue };
        let known = gains.iter().zip(&x).filter(|(gain, _)| **gain != 0.0);
        let command = known.map(|(gain, x)| *gain * x).reduce(|sum, term| sum + term);
        rates.push(excess.rate(approach));
        rates.push(approach.rate(ahead - acceleration));
        rates.push(acceleration.rate(command.unwrap_or(constant(0.0))));
        ahead = acceleration.into();
    }
    rates
}

fn vehicles(leader: f64) -> Result<Automaton<Driving, Link, Platoon>, BuildError> {
    use Driving::{Alone, Together};
    Automaton::starting_in(Together)
        .initially(Platoon::from([0.0; 9]))
        .flow(Together, driving(&TOGETHER, leader))
        .flow(Alone, driving(&ALONE, leader))
        .transition(from(Together).on(Link::Lost).to(Alone).may(always()))
        .transition(from(Alone).on(Link::Restored).to(Together).may(always()))
        .build()
}

/// The platoon behind a leader with that acceleration, in m/s².
fn platoon(leader: f64) -> Result<Composition, Box<dyn Error>> {
    let platoon = Composition::builder()
        .add("radio", &radio()?)
        .add("vehicles", &vehicles(leader)?)
        .label("lost")
        .label("restored")
        .build()?;
    Ok(platoon)
}

// ---- The answer --------------------------------------------------------------------------------

/// The published horizon, in seconds, and what the leader does, in m/s².
const HORIZON: f64 = 20.0;
const BRAKING: f64 = -9.0;

fn flow(gains: &'static Gains, leader: f64) -> Affine {
    Affine::new(9, move |x| {
        let command = |row: &[f64; 9]| row.iter().zip(x).map(|(gain, x)| gain * x).sum::<f64>();
        let [first, second, third] = gains.each_ref().map(command);
        let behind = |ahead: f64, own: usize| ahead - x[own];
        vec![
            x[1],
            behind(leader, 2),
            first,
            x[4],
            behind(x[2], 5),
            second,
            x[7],
            behind(x[5], 8),
            third,
        ]
    })
}

/// The state after every 5 s behind a leader with that acceleration.
fn states(leader: f64) -> Vec<Vec<f64>> {
    let mut state = vec![0.0; 9];
    [&TOGETHER, &ALONE, &TOGETHER, &ALONE]
        .map(|gains| {
            state = flow(gains, leader).after(&state, SPAN);
            state.clone()
        })
        .into()
}

/// The platoon behind a leader that brakes hard.
pub fn exhibit() -> Shown {
    let platoon = platoon(BRAKING)?;
    let trajectory = platoon.run(HORIZON)?;
    let switches = [5.0, 10.0, 15.0, 20.0];
    let gaps = switches.map(|time| {
        let excess = |name| trajectory.value(name, time).unwrap_or(f64::NAN);
        ["vehicles.x₁", "vehicles.x₄", "vehicles.x₇"].map(excess)
    });
    let answers = states(BRAKING).into_iter().map(|x| [x[0], x[3], x[6]]);
    Ok(Exhibit::new("platoon", include_str!("platoon.rs"))
        .component("radio", &radio()?)
        .component("vehicles", &vehicles(BRAKING)?)
        .checked(&platoon.check())
        .compare_all("switches, in s", instants(&trajectory), switches, 1e-12)
        .compare_all("gaps at the switches, in m", gaps.concat(), answers.flatten(), 1e-9)
        .run("A leader that brakes with 9 m/s²", trajectory))
}

fn main() -> Result<(), Box<dyn Error>> {
    exhibit()?.show()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ACCELERATING: f64 = 1.0;

    /// How far each gap can fall within the horizon at most, whatever the leader does, in metres.
    ///
    /// The excess at T is ∫ h(T, t) a(t) dt with h(T, t) the response at T to an impulse of the leader
    /// at t: it is least for a leader that brakes where h is positive and else accelerates.
    fn worst_falls() -> [f64; 3] {
        const STEP: f64 = 0.1;
        let flows = [flow(&TOGETHER, 0.0), flow(&ALONE, 0.0)];
        let steps = (HORIZON / STEP).round() as usize;
        let steps_per_span = (SPAN / STEP).round() as usize;
        let mut lowest = vec![[0.0; 3]; steps + 1];
        for begin in 0..steps {
            // The impulse in the middle of the step, and its response at every step thereafter.
            let mut response = vec![0.0; 9];
            response[1] = 1.0;
            for end in begin..steps {
                let flow = &flows[end / steps_per_span % 2];
                response = flow.after(&response, if end == begin { STEP / 2.0 } else { STEP });
                for (fall, excess) in lowest[end + 1].iter_mut().zip(response.iter().step_by(3)) {
                    *fall += STEP * (BRAKING * excess).min(ACCELERATING * excess);
                }
            }
        }
        [0, 1, 2].map(|vehicle| lowest.iter().map(|falls| -falls[vehicle]).fold(0.0, f64::max))
    }

    #[test]
    fn gaps_are_those_of_the_matrix_exponential() {
        let exhibit = exhibit().expect("it drives");
        assert_eq!(exhibit.disagreements(), [""; 0]);
    }

    /// PLAD01-BND30.
    #[test]
    fn no_gap_falls_by_the_published_bound_whatever_the_leader_does() {
        let worst = worst_falls();
        assert!(worst.iter().all(|fall| *fall < 30.0), "{worst:?}");
        for leader in [BRAKING, ACCELERATING] {
            let trajectory = platoon(leader).expect("sound").run(HORIZON).expect("it drives");
            for (_, sample) in trajectory.samples() {
                for (excess, worst) in sample.values[1..].iter().step_by(3).zip(worst) {
                    assert!(*excess >= -worst, "{excess} is worse than {worst}");
                }
            }
        }
    }
}
