//! What events and flows of automata cost.

use std::time::Duration;

use pleach_automaton::{
    Accumulation, Automaton, Builder, Composition, Coordinates, Settings, Vector, coordinates, from,
};
use pleach_discrete::vocabulary;

use crate::solvers::{MU, stiff_van_der_pol};
use crate::{fastest, ratio};

vocabulary! {
    enum Place: Location { Here = "here" }
    enum Cue: Event { Go = "go" }
}
coordinates! {
    struct Clock { clock }
    struct Ball { height, velocity }
}
use Cue::Go;
use Place::Here;

pub fn all() {
    clocks();
    bounces();
    stiff();
    rings();
}

fn here<S: Coordinates>(start: S) -> Builder<Place, Cue, S> {
    Automaton::starting_in(Here).initially(start)
}

fn clock() -> Automaton<Place, Cue, Clock> {
    let Clock { clock } = Clock::coordinates();
    here(Clock { clock: 0.0 })
        .flow(Here, clock.rate(1.0))
        .transition(from(Here).on(Go).to(Here).must(clock.at_least(1.0)).then(clock.becomes(0.0)))
        .build()
        .expect("it is sound")
}

/// Independent clocks out of step with one another: the time of an event.
fn clocks() {
    let cost = |count: u32, horizon: f64| {
        let crowd = (0..count).fold(Composition::builder(), |crowd, number| {
            let start = Clock { clock: f64::from(number) / f64::from(count) };
            crowd.add_in(&format!("clock {number}"), &clock(), start)
        });
        let crowd = crowd.build().expect("the parts fit");
        let events = crowd.run(horizon).expect("it can be run").jumps().len();
        let time = fastest(5, || crowd.run(horizon));
        time / u32::try_from(events).unwrap_or(1)
    };
    let one = cost(1, 20_000.0);
    for count in [1, 10, 100, 1000] {
        let time = cost(count, 20_000.0 / f64::from(count));
        println!("  {count} clocks: {time:?} per event ({:.2} of one clock)", ratio(time, one));
    }
    let names = (0..100_000).map(|number| format!("clock {number}"));
    let crowd = Composition::builder().add_each(names, &clock()).build().expect("the parts fit");
    let time = fastest(1, || crowd.run(3.5));
    println!("  100000 clocks: {:?} per event ({:.2})", time / 300_000, ratio(time / 300_000, one));
}

/// A ball that keeps all its speed: the time of a bounce.
fn bounces() {
    let Ball { height, velocity } = Ball::coordinates();
    let ball = here(Ball { height: 1.0, velocity: 0.0 })
        .flow(Here, [height.rate(&velocity), velocity.rate(-2.0)])
        .transition(
            from(Here)
                .on(Go)
                .to(Here)
                .must(height.at_most(0.0) & velocity.less_than(0.0))
                .then([velocity.becomes(-1.0 * &velocity), height.becomes(0.0)]),
        )
        .build()
        .expect("it is sound");
    let settings = Settings { accumulation: Accumulation::Off, ..Settings::default() };
    // It falls for 1 s, then bounces every 2 s.
    let cost = |bounces: u32| {
        let horizon = 2.0 * f64::from(bounces);
        fastest(3, || ball.run_with(settings, horizon)) / bounces
    };
    let few = cost(1000);
    for bounces in [1000, 100_000] {
        let time = cost(bounces);
        println!(
            "  {bounces} bounces: {time:?} per bounce ({:.2} of that of 1000)",
            ratio(time, few)
        );
    }
}

/// Van der Pol's oscillator with μ = 1000 over two periods and a half, formulas and all.
fn stiff() {
    let [x, y] = Vector::<2>::coordinates();
    let rate = MU * (1.0 - &x * &x) * &y - &x;
    let oscillator = here(Vector::from([2.0, 0.0]))
        .flow(Here, [x.rate(&y), y.rate(rate)])
        .build()
        .expect("it is sound");
    let ours = fastest(5, || oscillator.run(4000.0));
    let other = fastest(5, || stiff_van_der_pol(4000.0, 1e-9, 1e-9));
    let trajectory = oscillator.run(4000.0).expect("it can be run");
    let pieces = trajectory.intervals().map(|one| one.samples.len());
    println!(
        "  van der Pol, μ = 1000, at 1e-9: {ours:.1?}, {} samples; diffsol bdf {other:.1?} ({:.2})",
        pieces.sum::<usize>(),
        ratio(ours, other),
    );
}

/// Rings of masses and springs: by exponentials up to 16 variables, by the integrator beyond.
fn rings() {
    fn ring<const N: usize>() -> Duration {
        let x = Vector::<N>::coordinates();
        let half = N / 2;
        let rates = (0..N).map(|place| match place.checked_sub(half) {
            None => x[place].rate(&x[place + half]),
            Some(here) if here < half => {
                let (left, right) = (&x[(here + half - 1) % half], &x[(here + 1) % half]);
                x[place].rate(left + right - 2.0 * &x[here])
            }
            Some(_) => x[place].rate(-1.0 * &x[place]),
        });
        let mut start = [0.0; N];
        start[0] = 1.0;
        let ring = here(Vector::from(start)).flow(Here, rates.collect::<Vec<_>>());
        let ring = ring.build().expect("it is sound");
        fastest(5, || ring.run(20.0))
    }
    let (sixteen, seventeen, fifty) = (ring::<16>(), ring::<17>(), ring::<50>());
    println!(
        "  rings: 16 variables {sixteen:.1?}, 17 variables {seventeen:.1?} ({:.2}), 50 variables \
         {fifty:.1?}",
        ratio(sixteen, seventeen),
    );
}
