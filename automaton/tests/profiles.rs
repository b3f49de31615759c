//! Load profiles: rates that jump at known instants, from a table over time or from cases on a clock.
//! Steps end exactly there, so that no height of a jump and no width of a pulse is too large.

use pleach_automaton::{Automaton, Composition, Reason, Settings, Trajectory, coordinates, from};
use pleach_discrete::vocabulary;
use pleach_guards::{Expression, Table, piecewise};

vocabulary! {
    enum Plant: Location { Running = "running" }
    enum Cue: Event { Tick = "tick" }
}
coordinates! {
    struct Store { energy = "E", time = "t" }
    struct Clock { now = "t" }
}
use Cue::Tick;
use Plant::Running;

/// ẋ = (u(t) − x) ÷ τ from x = 0, where u is `height` from `on` to `off`; or ẋ = u(t) if τ is infinite.
struct Pulse {
    height: f64,
    on: f64,
    off: f64,
    lag: f64,
}

impl Pulse {
    fn exact(&self, t: f64) -> f64 {
        let risen = |t: f64| {
            let t = (t - self.on).max(0.0);
            if self.lag.is_infinite() {
                self.height * t
            } else {
                -self.height * (-t / self.lag).exp_m1()
            }
        };
        let peak = risen(t.min(self.off));
        if self.lag.is_infinite() {
            peak
        } else {
            peak * (-(t - self.off).max(0.0) / self.lag).exp()
        }
    }

    /// The rate, where the load is `load`.
    fn rate(&self, load: Expression) -> Expression {
        let energy = Store::coordinates().energy;
        if self.lag.is_infinite() { load } else { (load - &energy) / self.lag }
    }

    fn table(&self) -> Table {
        Table::steps([(0.0, 0.0), (self.on, self.height), (self.off, 0.0)]).expect("in order")
    }

    /// The run up to twice the end of the pulse.
    fn run(&self, load: Expression, clock: [f64; 2]) -> Trajectory {
        let Store { energy, time } = Store::coordinates();
        let plant = Automaton::<_, Cue, _>::starting_in(Running)
            .initially(Store { energy: 0.0, time: clock[0] })
            .flow(Running, [energy.rate(self.rate(load)), time.rate(clock[1])])
            .build()
            .expect("the model is sound");
        let settings = Settings {
            step_limit: 100_000,
            absolute_tolerance: 1e-12 * self.height,
            ..Settings::default()
        };
        plant.run_with(settings, 2.0 * self.off).expect("it runs")
    }

    fn check(&self, trajectory: &Trajectory, tolerance: f64) {
        assert_eq!(trajectory.ending().reason, Reason::Horizon, "{} at {}", self.height, self.on);
        assert!(trajectory.doubts().is_empty(), "{:?}", trajectory.doubts());
        let times = [self.on, 0.5 * (self.on + self.off), self.off, 1.5 * self.off, 2.0 * self.off];
        let size = self.exact(self.off);
        for t in times {
            let found = trajectory.values_at(t).expect("it lasts")[0];
            let exact = self.exact(t);
            assert!((found - exact).abs() <= tolerance * size, "{found} is not {exact} at {t}");
        }
    }
}

fn pulse(height: f64, on: f64, off: f64, lag: f64) -> Pulse {
    Pulse { height, on, off, lag }
}

/// From the switching of a transistor to ten years of a reservoir.
#[test]
fn jumps_of_every_height_are_met_at_every_time() {
    let pulses = [
        pulse(1e12, 1e-6, 2e-6, f64::INFINITY), // a laser pulse: W into J
        pulse(1e9, 1e-6, 5e-6, 1e-7),
        pulse(1e4, 60.0, 61.0, 1e-3), // 10 kV on an RC circuit of 1 kΩ and 1 µF
        pulse(2e6, 600.0, 660.0, f64::INFINITY),
        pulse(1e8, 1.0, 1.5, f64::INFINITY),
        pulse(1e12, 86_400.0, 90_000.0, 100.0),
        pulse(1e-3, 1e6, 1.5e6, 1e4),
        pulse(1e12, 1e8, 1.1e8, f64::INFINITY),
        pulse(1e-3, 1e8, 2e8, 1e7),
        pulse(1e12, 1e-6, 1e8, 1e6),
    ];
    for pulse in pulses {
        let load = pulse.table().at(&Store::coordinates().time);
        pulse.check(&pulse.run(load, [0.0, 1.0]), 1e-9);
    }
}

/// Seconds that begin elsewhere, hours, and a clock that counts down; the instant is a rounded one then.
#[test]
fn clocks_of_any_start_and_unit_decide() {
    let pulse = pulse(1e8, 600.0, 660.0, f64::INFINITY);
    let time = Store::coordinates().time;
    for [first, rate] in [[7e5, 1.0], [-50.0, 1.0 / 3600.0], [1e3, -1.0], [0.1, 1e3]] {
        let seconds = (&time - first) / rate;
        pulse.check(&pulse.run(pulse.table().at(seconds), [first, rate]), 1e-9);
    }
}

/// Cases and signs of a clock are as good as a table.
#[test]
fn cases_on_a_clock_split_steps_too() {
    let pulse = pulse(1e10, 3.0, 4.0, 0.25);
    let time = Store::coordinates().time;
    let within = time.at_least(3.0) & time.less_than(4.0);
    let cases = piecewise([(within, 1e10.into())], 0.0).expect("a comparison");
    let signs = 0.5e10 * ((&time - 3.0).sign() - (&time - 4.0).sign());
    for load in [cases, signs] {
        pulse.check(&pulse.run(load, [0.0, 1.0]), 1e-9);
    }
}

/// A day in steps of a minute, with loads of megawatts, beside a kink on a curve.
#[test]
fn a_day_of_loads_is_summed_up() {
    let Store { energy, time } = Store::coordinates();
    let load = |minute: u32| 1e6 * f64::from(minute * 37 % 11);
    let points: Vec<_> = (0..1440).map(|minute| (60.0 * f64::from(minute), load(minute))).collect();
    let drawn = Table::steps(points).expect("in order").at(&time);
    let total: f64 = (0..1440).map(|minute| 60.0 * load(minute)).sum();
    for rate in [drawn.clone(), drawn + 0.0 * energy.abs()] {
        let store = Automaton::<_, Cue, _>::starting_in(Running)
            .initially(Store { energy: 0.0, time: 0.0 })
            .flow(Running, [energy.rate(rate), time.rate(1.0)])
            .build()
            .expect("the model is sound");
        let trajectory = store.run(86_400.0).expect("it runs");
        assert_eq!(trajectory.ending().reason, Reason::Horizon);
        let found = trajectory.values_at(86_400.0).expect("it lasts")[0];
        assert!((found / total - 1.0).abs() < 1e-12, "{found} is not {total}");
    }
}

/// The clock of another component decides, which ticks at the very instants and begins anew.
#[test]
fn a_clock_that_is_reset_at_the_jumps_decides_for_another_component() {
    let Clock { now } = Clock::coordinates();
    let clock = Automaton::starting_in(Running)
        .initially(Clock { now: 0.0 })
        .flow(Running, now.rate(1.0))
        .transition(
            from(Running).on(Tick).to(Running).must(now.at_least(0.3)).then([now.becomes(0.0)]),
        )
        .build()
        .expect("the model is sound");
    let Store { energy, time } = Store::coordinates();
    let load = Table::steps([(0.0, 1e9), (0.1, -1e9), (0.3, 1e12)]).expect("in order").at(&time);
    let store = Automaton::<_, Cue, _>::starting_in(Running)
        .initially(Store { energy: 0.0, time: 0.0 })
        .flow(Running, energy.rate(load))
        .build()
        .expect("the model is sound");
    let both = Composition::builder()
        .add("clock", &clock)
        .add("store", &store)
        .connect("clock.t", "store.t")
        .build()
        .expect("it fits together");
    let trajectory = both.run(30.0).expect("it runs");
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    let place = both.variables().iter().position(|name| name == "store.E").expect("it is there");
    let found = trajectory.values_at(30.0).expect("it lasts")[place];
    assert!((found / -1e10 - 1.0).abs() < 1e-9, "{found}");
}
