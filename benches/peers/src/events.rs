//! What events and flows of automata cost.

use std::time::Duration;

use pleach_automaton::{
    Accumulation, Automaton, Builder, Composition, Coordinates, Settings, Vector, coordinates, from,
};
use pleach_discrete::vocabulary;

use crate::measure::{fastest, ratio};
use crate::report::Report;
use crate::solvers::{MU, stiff_van_der_pol, tolerance_for};

vocabulary! {
    pub enum Place: Location { Here = "here" }
    pub enum Cue: Event { Go = "go" }
}
coordinates! {
    struct Clock { clock }
    struct Ball { height, velocity }
}
use Cue::Go;
use Place::Here;

pub fn all(report: &mut Report) {
    report.table(&["runs of automata", "ratio"]);
    clocks(report);
    thermostats(report);
    bounces(report);
    visits(report);
    rings(report);
    stiff(report);
}

/// Adds a row, and tells the times.
fn add(report: &mut Report, what: String, (time, other): (Duration, Duration)) {
    eprintln!("{what}: {time:.2?}, {other:.2?}");
    report.row([what, format!("{:.1}", ratio(time, other))]);
}

pub fn here<S: Coordinates>(start: S) -> Builder<Place, Cue, S> {
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

/// Runs with events several times, if they are among those known: 20,000 events of as many clocks
/// or thermostats as `number`, or that many bounces.
pub fn repeat(name: &str, number: u32, times: u32) -> Option<()> {
    let (composition, horizon) = match name {
        "clocks" => crowd(number, &clock(), |clock| Clock { clock }, EVENTS),
        "thermostats" => crowd(number, &thermostat(), warm, EVENTS),
        "bounces" => {
            let ball = Composition::builder().add("ball", &ball()).build().expect("it fits");
            (ball, 2.0 * f64::from(number))
        }
        _ => return None,
    };
    let settings = Settings { accumulation: Accumulation::Off, ..Settings::default() };
    for _ in 0..times {
        let jumps = composition.run_with(settings, horizon).expect("it can be run").jumps().len();
        eprintln!("{jumps} jumps");
    }
    Some(())
}

/// How many events there are in all of a crowd.
const EVENTS: f64 = 20_000.0;

/// Automata that begin in these states, and a horizon that is the shorter the more they are.
fn crowd<S: Coordinates + Clone>(
    count: u32,
    automaton: &Automaton<Place, Cue, S>,
    start: impl Fn(f64) -> S,
    horizon: f64,
) -> (Composition, f64) {
    let crowd = (0..count).fold(Composition::builder(), |crowd, number| {
        let start = start(f64::from(number) / f64::from(count));
        crowd.add_in(&format!("number {number}"), automaton, start)
    });
    (crowd.build().expect("the parts fit"), horizon / f64::from(count))
}

/// The time of an event in a crowd of automata, which begin in these states, per event.
fn event_in<S: Coordinates + Clone>(
    count: u32,
    automaton: &Automaton<Place, Cue, S>,
    start: impl Fn(f64) -> S,
) -> Duration {
    let (crowd, horizon) = crowd(count, automaton, start, EVENTS);
    let events = crowd.run(horizon).expect("it can be run").jumps().len();
    fastest(5, || crowd.run(horizon)) / u32::try_from(events).unwrap_or(1)
}

/// Independent clocks out of step with one another: the time of an event.
fn clocks(report: &mut Report) {
    let cost = |count| event_in(count, &clock(), |clock| Clock { clock });
    let one = cost(1);
    for count in [10, 100, 1000] {
        add(report, format!("an event of {count} clocks, to that of one"), (cost(count), one));
    }
    let names = (0..100_000).map(|number| format!("clock {number}"));
    let crowd = Composition::builder().add_each(names, &clock()).build().expect("the parts fit");
    let time = fastest(1, || crowd.run(3.5)) / 300_000;
    add(report, "an event of 100000 clocks, to that of one".to_owned(), (time, one));
}

/// A room that is heated and, when it is warm, aired.
fn thermostat() -> Automaton<Place, Cue, Clock> {
    let Clock { clock: temperature } = Clock::coordinates();
    here(Clock { clock: 19.0 })
        .flow(Here, temperature.rate(0.1 * (30.0 - &temperature)))
        .transition(
            from(Here)
                .on(Go)
                .to(Here)
                .must(temperature.at_least(23.0))
                .then(temperature.becomes(19.0)),
        )
        .build()
        .expect("it is sound")
}

fn warm(share: f64) -> Clock {
    Clock { clock: 19.0 + 3.9 * share }
}

/// The same with rooms whose temperatures are exponential functions of time.
fn thermostats(report: &mut Report) {
    let cost = |count| event_in(count, &thermostat(), warm);
    let times = (cost(1000), cost(1));
    add(report, "an event of 1000 thermostats, to that of one".to_owned(), times);
}

/// A ball that keeps all its speed.
fn ball() -> Automaton<Place, Cue, Ball> {
    let Ball { height, velocity } = Ball::coordinates();
    here(Ball { height: 1.0, velocity: 0.0 })
        .flow(Here, [height.rate(&velocity), velocity.rate(-2.0)])
        .transition(
            from(Here)
                .on(Go)
                .to(Here)
                .must(height.at_most(0.0) & velocity.less_than(0.0))
                .then([velocity.becomes(-1.0 * &velocity), height.becomes(0.0)]),
        )
        .build()
        .expect("it is sound")
}

/// The time of its bounces.
fn bounces(report: &mut Report) {
    let ball = ball();
    let settings = Settings { accumulation: Accumulation::Off, ..Settings::default() };
    // It falls for 1 s, then bounces every 2 s.
    let cost = |bounces: u32| {
        let horizon = 2.0 * f64::from(bounces);
        fastest(5, || ball.run_with(settings, horizon)) / bounces
    };
    let times = (cost(100_000), cost(1000));
    add(report, "a bounce of 100000, to one of 1000".to_owned(), times);
}

/// A ring of springs that is kicked at every tick of a clock: a flow that is visited again and again,
/// to the same flow by the integrator.
fn visits(report: &mut Report) {
    let x = Vector::<9>::coordinates();
    let ring = |is_linear: bool| {
        let rates = (0..9).map(|place| match place {
            8 => x[8].rate(1.0),
            0..4 => x[place].rate(&x[place + 4]),
            _ => {
                let (left, right) = (&x[(place + 3) % 4], &x[(place + 1) % 4]);
                let pull = left + right - 2.0 * &x[place - 4];
                // Of no effect, and not linear.
                let none = 0.0 * x[place].power(2.0);
                x[place].rate(if is_linear { pull } else { pull + none })
            }
        });
        here(Vector::from([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]))
            .flow(Here, rates.collect::<Vec<_>>())
            .transition(
                from(Here)
                    .on(Go)
                    .to(Here)
                    .must(x[8].at_least(1.0))
                    .then([x[4].becomes(0.9 * &x[4]), x[8].becomes(0.0)]),
            )
            .build()
            .expect("it is sound")
    };
    let time = |is_linear| {
        let ring = ring(is_linear);
        fastest(5, || ring.run(1000.0))
    };
    let what = "1000 visits of a linear flow of 8 variables, by exponentials to by the integrator";
    add(report, what.to_owned(), (time(true), time(false)));
}

/// Van der Pol's oscillator with μ = 1000, formulas and all, to the BDF method at the loosest tolerance
/// with which it is as near to the answer, which is that of the test set of F. Mazzia and C. Magherini
/// (release 2.4).
fn stiff(report: &mut Report) {
    const END: f64 = 2000.0;
    const ANSWER: f64 = 1.706_167_732_170_483;
    let [x, y] = Vector::<2>::coordinates();
    let rate = MU * (1.0 - &x * &x) * &y - &x;
    let oscillator = here(Vector::from([2.0, 0.0]))
        .flow(Here, [x.rate(&y), y.rate(rate)])
        .build()
        .expect("it is sound");
    let trajectory = oscillator.run(END).expect("it can be run");
    let error = trajectory.values_at(END).map_or(f64::NAN, |state| (state[0] - ANSWER).abs());
    let by_bdf = |relative| stiff_van_der_pol(END, relative, relative);
    let relative = tolerance_for(error, |relative| (by_bdf(relative)[0] - ANSWER).abs());
    let times = (fastest(5, || oscillator.run(END)), fastest(5, || by_bdf(relative)));
    let what = format!(
        "van der Pol, μ = 1000, error {error:.0e}, to the BDF method of `diffsol` with its Jacobian given"
    );
    add(report, what, times);
}

/// Rings of masses and springs: by exponentials up to 16 variables, by the integrator beyond.
fn rings(report: &mut Report) {
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
    let what = "a linear flow of 16 variables by exponentials, to one of 17 by the integrator";
    add(report, what.to_owned(), (ring::<16>(), ring::<17>()));
}
