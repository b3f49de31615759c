//! # The filtered oscillator
//!
//! In the plane, the line y = −k x separates two affine flows: above it the state tends to (0.7,
//! −0.7), which lies below it, and below it to (−0.7, 0.7), which lies above. So the state
//! oscillates. Its first coordinate passes through a chain of first-order filters, each of which
//! follows the one before by ż = 5 (u − z).
//!
//! The benchmark is from Frehse et al., *SpaceEx: scalable verification of hybrid systems* (2011),
//! [doi:10.1007/978-3-642-22110-1_30](https://doi.org/10.1007/978-3-642-22110-1_30), with the four
//! locations, the numbers (k = 0.714286) and the initial set of the published model file. The run
//! begins in the middle of this set, at (0.25, 0). The property to check is y < 0.5 up to 4 s.
//!
//! The switching instants have a closed form: with s = e⁻ᵗ the coordinates are polynomials,
//! x = 0.7 + (x₀ − 0.7) s² and y = −0.7 + (y₀ + 0.7) s, so the state meets the line where a
//! quadratic polynomial of s is 0. All runs tend to a cycle through ±(a, −k a) with a = 0.7
//! √(2k − 1)/k, half of which takes ln (0.7 + k a)/(0.7 − k a). The outputs of the filters are
//! compared with matrix exponentials.

mod exhibit;
mod oracle;

use exhibit::{Exhibit, Shown, instants};
use oracle::Affine;
use pleach::prelude::*;
use std::convert::Infallible;
use std::error::Error;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    /// Above or below the line, and on which side of the vertical axis.
    enum Part: Location {
        AboveLeft = "above, left", AboveRight = "above, right",
        BelowLeft = "below, left", BelowRight = "below, right",
    }
    enum Crossing: Event { Line = "line", Axis = "axis" }
    enum Filter: Location { Following = "following" }
}

coordinates! {
    struct Plane { x, y }
    struct Signal { input = "u", output = "z" }
}

const SLOPE: f64 = 0.714286;

fn oscillator() -> Result<Automaton<Part, Crossing, Plane>, BuildError> {
    use Crossing::{Axis, Line};
    use Part::{AboveLeft, AboveRight, BelowLeft, BelowRight};
    let Plane { x, y } = Plane::coordinates();
    let height = &y + SLOPE * &x;
    let downwards = [x.rate(1.4 - 2.0 * &x), y.rate(-0.7 - &y)];
    let upwards = [x.rate(-1.4 - 2.0 * &x), y.rate(0.7 - &y)];
    Automaton::starting_in(AboveRight)
        .initially(Plane { x: 0.25, y: 0.0 })
        .flow(AboveLeft, downwards.clone())
        .flow(AboveRight, downwards)
        .flow(BelowRight, upwards.clone())
        .flow(BelowLeft, upwards)
        .transition(from(AboveRight).on(Line).to(BelowRight).must(height.at_most(0.0)))
        .transition(from(BelowRight).on(Axis).to(BelowLeft).must(x.at_most(0.0)))
        .transition(from(BelowLeft).on(Line).to(AboveLeft).must(height.at_least(0.0)))
        .transition(from(AboveLeft).on(Axis).to(AboveRight).must(x.at_least(0.0)))
        .build()
}

fn filter() -> Result<Automaton<Filter, Infallible, Signal>, BuildError> {
    let Signal { input, output } = Signal::coordinates();
    Automaton::starting_in(Filter::Following)
        .initially(Signal { input: 0.0, output: 0.0 })
        .flow(Filter::Following, output.rate(5.0 * (&input - &output)))
        .build()
}

/// The oscillator and a chain of `order` filters.
fn filtered_oscillator(order: usize) -> Result<Composition, Box<dyn Error>> {
    let mut chain = Composition::builder().add("oscillator", &oscillator()?);
    let mut signal = "oscillator.x".to_owned();
    for number in 1..=order {
        let name = format!("filter {number}");
        chain = chain.add(&name, &filter()?).connect(&signal, &format!("{name}.u"));
        signal = format!("{name}.z");
    }
    Ok(chain.build()?)
}

// ---- The answer --------------------------------------------------------------------------------

/// How long each stay in a part of the plane takes, in seconds, beginning at (0.25, 0).
fn stays() -> impl Iterator<Item = f64> {
    // Below the line everything is as above it, turned by half a turn: so each part is told as if
    // it were above.
    let (mut x, mut y, mut is_at_axis) = (0.25, 0.0, true);
    std::iter::from_fn(move || {
        let s = if is_at_axis {
            let (a, b, c) = (SLOPE * (0.7 - x), y + 0.7, 0.7 * (1.0 - SLOPE));
            (b - (b * b - 4.0 * a * c).sqrt()) / (2.0 * a)
        } else {
            (0.7 / (0.7 - x)).sqrt()
        };
        (x, y) = (0.7 + (x - 0.7) * s * s, -0.7 + (y + 0.7) * s);
        if is_at_axis {
            (x, y) = (-x, -y);
        }
        is_at_axis = !is_at_axis;
        Some(-s.ln())
    })
}

fn switches() -> impl Iterator<Item = f64> {
    stays().scan(0.0, |now, stay| {
        *now += stay;
        Some(*now)
    })
}

/// How long the cycle takes to which all runs tend, in seconds.
fn period() -> f64 {
    let height = 0.7 * (2.0 * SLOPE - 1.0).sqrt();
    2.0 * ((0.7 + height) / (0.7 - height)).ln()
}

/// What the last of `order` filters gives after `horizon` seconds.
fn output(order: usize, horizon: f64) -> f64 {
    let mut state = vec![0.0; 2 + order];
    state[0] = 0.25;
    let (mut now, mut sign) = (0.0, 1.0);
    for (number, stay) in (0..).zip(stays()) {
        let flow = Affine::new(2 + order, |state| {
            let mut rates = vec![1.4 * sign - 2.0 * state[0], -0.7 * sign - state[1]];
            let chain = std::iter::once(&state[0]).chain(&state[2..]);
            rates.extend(chain.zip(&state[2..]).map(|(input, output)| 5.0 * (input - output)));
            rates
        });
        let duration = stay.min(horizon - now);
        state = flow.after(&state, duration);
        now += stay;
        if now >= horizon {
            break;
        }
        // Every other stay ends at the line.
        sign = if number % 2 == 0 { -sign } else { sign };
    }
    state[1 + order]
}

/// The published horizon, in seconds.
const HORIZON: f64 = 4.0;
const ORDER: usize = 4;

/// The oscillator with four filters over the published horizon, and without them for long.
pub fn exhibit() -> Shown {
    let oscillator = oscillator()?;
    let chain = filtered_oscillator(ORDER)?;
    let trajectory = chain.run(HORIZON)?;
    let filtered = trajectory.value("filter 4.z", HORIZON).unwrap_or(f64::NAN);
    let long = oscillator.run(60.0)?;
    let [.., before, _, _, _, last] = long.jumps() else { return Err("it stands still".into()) };
    Ok(Exhibit::new("filtered_oscillator", include_str!("filtered_oscillator.rs"))
        .automaton("oscillator", &oscillator)
        .component("filter", &filter()?)
        .checked(&chain.check())
        .compare_all("switches, in s", instants(&trajectory).take(4), switches().take(4), 1e-12)
        .compare("output at 4 s", filtered, output(ORDER, HORIZON), 1e-9)
        .compare("period in the end, in s", last.at.t - before.at.t, period(), 1e-9)
        .run("The oscillator with four filters", trajectory))
}

fn main() -> Result<(), Box<dyn Error>> {
    exhibit()?.show()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn switches_period_and_output_are_those_of_the_answer() {
        let exhibit = exhibit().expect("it oscillates");
        assert_eq!(exhibit.disagreements(), [""; 0]);
    }

    #[test]
    fn the_published_property_holds_for_any_number_of_filters() {
        for order in [0, 4, 8, 16] {
            let system = filtered_oscillator(order).expect("the parts fit");
            let trajectory = system.run(HORIZON).expect("it oscillates");
            let y = trajectory.variables().iter().position(|name| name.ends_with('y'));
            let y = y.expect("there is y");
            assert!(trajectory.samples().all(|(_, sample)| sample.values[y] < 0.5));
        }
    }
}
