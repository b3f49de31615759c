//! Compositions one step at a time, as whoever drives them sees them.

use std::ops::ControlFlow;

use pleach_automaton::composition::{Simulation, Taken};
use pleach_automaton::{
    Composition, Executor, HybridTime, Observer, Participants, Settings, System, TraceEntry, from,
};

use crate::common::body::{Body, Cue, Place, line};
use crate::common::classics::{house, house_parts};

fn assert_near(found: f64, exact: f64) {
    assert!((found - exact).abs() < 1e-8, "{found} is not {exact}");
}

/// The temperature of a room that cools from `start` for `time` seconds.
fn cooled(start: f64, time: f64) -> f64 {
    start * (-0.1 * time).exp()
}

#[test]
fn a_simulation_is_where_time_has_brought_it() {
    let house = house();
    let mut simulation = Simulation::new(&house, Settings::default(), 10.0).expect("it can be run");
    assert_eq!((simulation.locations(), &*simulation.values()), (&[0, 0][..], &[20.0][..]));
    let run = |simulation: &mut Simulation<'_>, time| {
        let executor = Executor::new(time, 10).expect("times are finite");
        executor.run(simulation, &mut ()).expect("nothing fails");
    };
    run(&mut simulation, 0.5);
    assert_near(simulation.values()[0], cooled(20.0, 0.5));
    let switch = 10.0 * (20f64 / 18.0).ln();
    let wait = simulation.time_to_jump().expect("nothing fails").expect("the heater is turned on");
    assert_near(wait, switch - 0.5);
    simulation.flow(0.25).expect("nothing fails");
    assert_near(simulation.values()[0], cooled(20.0, 0.75));
    assert_near(
        simulation.time_to_jump().expect("nothing fails").expect("as before"),
        switch - 0.75,
    );
    // The rest of the way to the switch, which is taken at once.
    run(&mut simulation, wait - 0.25);
    assert_eq!(simulation.locations(), [1, 0]);
    assert_near(simulation.values()[0], 18.0);
}

/// Who jumps: of a house and a clock beside it.
#[derive(Default)]
struct Jumpers(Vec<(String, Participants)>);

impl Observer<Simulation<'_>> for Jumpers {
    fn jumped(&mut self, entry: TraceEntry<Taken>) {
        self.0.push((entry.jump.label, entry.by));
    }
}

#[test]
fn whoever_observes_a_run_hears_who_jumps() {
    let jumpers = |composition: &Composition| {
        let mut simulation =
            Simulation::new(composition, Settings::default(), 1.5).expect("it can be run");
        let mut jumpers = Jumpers::default();
        let executor = Executor::new(1.5, 10).expect("times are finite");
        executor.run(&mut simulation, &mut jumpers).expect("nothing fails");
        jumpers.0
    };
    let together = ("turn on".to_owned(), Participants::All);
    assert_eq!(jumpers(&house()), [together]);
    let line = line()
        .transition(
            from(Place::Here)
                .on(Cue::Go)
                .to(Place::There)
                .must(Body::coordinates().time.at_least(1.25)),
        )
        .build()
        .expect("it is sound");
    let beside = house_parts().add("line", &line).build().expect("the parts fit");
    let both = ("turn on".to_owned(), Participants::Some([0, 1].into()));
    assert_eq!(jumpers(&beside), [both, ("go".to_owned(), Participants::One(2))]);
}

/// What is seen before each flow.
#[derive(Default)]
struct Seen(Vec<(f64, Vec<usize>, f64)>);

impl Observer<Simulation<'_>> for Seen {
    fn flows(
        &mut self,
        simulation: &Simulation<'_>,
        now: HybridTime,
        _duration: f64,
    ) -> ControlFlow<std::convert::Infallible> {
        self.0.push((now.t, simulation.locations().to_vec(), simulation.values()[0]));
        ControlFlow::Continue(())
    }
}

#[test]
fn whoever_observes_a_run_sees_the_state_before_each_flow() {
    let house = house();
    let mut simulation = Simulation::new(&house, Settings::default(), 3.0).expect("it can be run");
    let mut seen = Seen::default();
    let executor = Executor::new(3.0, 10).expect("times are finite");
    executor.run(&mut simulation, &mut seen).expect("nothing fails");
    let on = 10.0 * (20f64 / 18.0).ln();
    let off = on + 10.0 * (32f64 / 28.0).ln();
    let expected = [(0.0, [0, 0], 20.0), (on, [1, 0], 18.0), (off, [0, 0], 22.0)];
    assert_eq!(seen.0.len(), expected.len(), "{:?}", seen.0);
    for ((time, locations, value), (at, places, temperature)) in seen.0.iter().zip(expected) {
        assert_eq!(*locations, places);
        assert_near(*time, at);
        assert_near(*value, temperature);
    }
}
