//! How long an event takes, by how many other components and earlier events there are:
//! `cost_per_event [MOST]`, with up to `MOST` clocks, 1,000 unless told otherwise.
//!
//! The cost per event should not depend on either. Run it with `--release`.

use std::error::Error;
use std::time::Instant;

use pleach_automaton::{Accumulation, Automaton, Composition, Settings, coordinates, from};
use pleach_discrete::vocabulary;

vocabulary! {
    enum Place: Location { Here = "here", There = "there" }
    enum Cue: Event { Go = "go", Back = "back" }
}
coordinates! {
    struct Clock { time = "τ" }
    struct Room { temperature = "T" }
    struct Ball { height = "h", velocity = "v" }
}
use Cue::{Back, Go};
use Place::{Here, There};

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    let most = std::env::args().nth(1).map_or(Ok(1000), |number| number.parse())?;
    let clock = clock()?;
    let room = room()?;
    let mut count: usize = 1;
    while count <= most {
        // As many events in all, whatever the number of components.
        let horizon = 20_000.0 / count as f64;
        let names = || (0..count).map(|number| format!("component {number}"));
        let clocks = Composition::builder().add_each(names(), &clock).build()?;
        report(&format!("{count} clocks"), &clocks, horizon)?;
        let rooms = Composition::builder().add_each(names(), &room).build()?;
        report(&format!("{count} thermostats"), &rooms, horizon)?;
        count *= 10;
    }
    let ball = Composition::builder().add("ball", &ball()?).build()?;
    for bounces in [1e3, 1e4, 1e5] {
        report(&format!("{bounces} bounces"), &ball, 2.0 * bounces)?;
    }
    Ok(())
}

fn report(what: &str, composition: &Composition, horizon: f64) -> Result<()> {
    let settings = Settings { accumulation: Accumulation::Off, ..Settings::default() };
    let mut best = f64::INFINITY;
    let mut events = 0;
    for _ in 0..3 {
        let start = Instant::now();
        let trajectory = composition.run_with(settings, horizon)?;
        best = best.min(start.elapsed().as_secs_f64());
        events = trajectory.jumps().len();
    }
    println!("{what:>20}  {events:>7} events  {:.2} µs each", 1e6 * best / events as f64);
    Ok(())
}

/// Set back every second.
fn clock() -> Result<Automaton<Place, Cue, Clock>> {
    let Clock { time } = Clock::coordinates();
    let tick = from(Here).on(Go).to(Here).must(time.at_least(1.0)).then(time.becomes(0.0));
    let built = Automaton::starting_in(Here).initially(Clock { time: 0.0 });
    Ok(built.flow(Here, time.rate(1.0)).transition(tick).build()?)
}

/// Warms and cools exponentially between 18 and 22 degrees, by the matrix exponential.
fn room() -> Result<Automaton<Place, Cue, Room>> {
    let Room { temperature } = Room::coordinates();
    Ok(Automaton::starting_in(Here)
        .initially(Room { temperature: 20.0 })
        .flow(Here, temperature.rate(-0.4 * &temperature))
        .flow(There, temperature.rate(16.0 - 0.4 * &temperature))
        .transition(from(Here).on(Go).to(There).must(temperature.at_most(18.0)))
        .transition(from(There).on(Back).to(Here).must(temperature.at_least(22.0)))
        .build()?)
}

/// Bounces without loss, every two seconds.
fn ball() -> Result<Automaton<Place, Cue, Ball>> {
    let Ball { height, velocity } = Ball::coordinates();
    let bounce = from(Here)
        .on(Go)
        .to(Here)
        .must(height.at_most(0.0) & velocity.less_than(0.0))
        .then([height.becomes(0.0), velocity.becomes(9.81)]);
    Ok(Automaton::starting_in(Here)
        .initially(Ball { height: 0.0, velocity: 9.81 })
        .flow(Here, [height.rate(&velocity), velocity.rate(-9.81)])
        .transition(bounce)
        .build()?)
}
