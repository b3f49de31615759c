//! Components that share a sampling clock, run by the executor and compared with their closed form.

use std::ops::ControlFlow;

use crate::common::{Heater, Room, Sensed, Window, heater, window};
use pleach_automaton::{
    Automaton, Ending, Executor, HybridTime, Jump, Observer, Participants, Reason, Round, System,
    Trace, TransitionError,
};

/// A jump of the composition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Move {
    /// The clock runs out, and every room is measured.
    Sample,
    Heater(Jump<Heater, Sensed>),
    Window(Jump<Window, Sensed>),
}

struct Building {
    heater: Automaton<Heater, Sensed, Room>,
    window: Automaton<Window, Sensed, Room>,
    rooms: Vec<(Heater, Window, Room)>,
    clock: f64,
    period: f64,
}

impl Building {
    fn with_rooms_at(temperatures: &[f64]) -> Self {
        let (heater, window) = (heater(), window());
        let room = |&temperature: &f64| {
            let room = Room { temperature, measured: temperature, openings: 0 };
            (heater.initial(), window.initial(), room)
        };
        let rooms = temperatures.iter().map(room).collect();
        Building { heater, window, rooms, clock: 0.0, period: 1.0 }
    }
}

impl System for Building {
    type Jump = Move;
    type Finish = &'static str;
    type Error = TransitionError;

    fn finished(&self) -> Option<&'static str> {
        self.rooms.iter().any(|(_, _, room)| room.openings == 4).then_some("stuffy")
    }

    fn jump(&mut self, round: &mut Round<'_, Move>) -> Result<(), TransitionError> {
        if self.clock >= self.period {
            self.clock = 0.0;
            for (_, _, room) in &mut self.rooms {
                room.measured = room.temperature;
            }
            round.jumped_together(Move::Sample);
            return Ok(());
        }
        for (number, (heater, window, room)) in self.rooms.iter_mut().enumerate() {
            if let Some(jump) = self.heater.step(heater, room)? {
                round.jumped(2 * number, Move::Heater(jump));
            }
            if let Some(jump) = self.window.step(window, room)? {
                round.jumped(2 * number + 1, Move::Window(jump));
            }
        }
        Ok(())
    }

    fn time_to_jump(&self) -> Result<Option<f64>, TransitionError> {
        Ok(Some(self.period - self.clock))
    }

    fn flow(&mut self, duration: f64) -> Result<(), TransitionError> {
        let lands = duration == self.period - self.clock;
        self.clock = if lands { self.period } else { self.clock + duration };
        for (heater, _, room) in &mut self.rooms {
            let flow = self.heater.mode(*heater).and_then(|mode| mode.flow.as_ref());
            assert!(flow.is_some_and(|flow| flow.advance(room, duration)), "the flow is exact");
        }
        Ok(())
    }
}

fn run(building: &mut Building, horizon: f64) -> (Ending<&'static str>, Trace<Move>) {
    let mut trace = Trace::new();
    let executor = Executor::new(horizon, 10).expect("limits are valid");
    let ending = executor.run(building, &mut trace).expect("guards can be evaluated");
    (ending, trace)
}

#[test]
fn a_room_follows_its_closed_form() {
    let mut building = Building::with_rooms_at(&[20.0]);
    let (ending, trace) = run(&mut building, 7.5);

    let jumps: Vec<_> = trace
        .entries()
        .iter()
        .filter_map(|entry| match entry.jump {
            Move::Sample => None,
            Move::Heater(jump) => Some((entry.at.t, "heater", jump.target == Heater::On)),
            Move::Window(jump) => Some((entry.at.t, "window", jump.target == Window::Open)),
        })
        .collect();
    let expected = [
        (1.0, "heater", true),
        (2.0, "heater", false),
        (2.0, "window", true),
        (3.0, "window", false),
        (4.0, "heater", true),
        (5.0, "heater", false),
        (5.0, "window", true),
        (6.0, "window", false),
        (7.0, "heater", true),
    ];
    assert_eq!(jumps, expected);
    // 20 °C and, over 7.5 s, 2.5 s of warming and 5 s of cooling.
    assert_eq!(building.rooms[0].2.temperature, 20.0 + 2.5 * 2.0 - 5.0);
    let jumps_and_samples = 9 + 7;
    let at = HybridTime { t: 7.5, j: jumps_and_samples };
    assert_eq!(ending, Ending { at, reason: Reason::Horizon });
}

#[test]
fn jumps_are_numbered_and_ordered_by_component() {
    let (_, trace) = run(&mut Building::with_rooms_at(&[20.0, 21.0, 20.0]), 2.0);
    let numbers = trace.entries().iter().map(|entry| entry.at.j);
    assert!(numbers.eq(0..trace.entries().len() as u32));
    assert!(trace.entries().is_sorted_by_key(|entry| entry.at));

    let first =
        trace.entries().iter().filter(|entry| entry.at.t == 0.0).map(|entry| entry.by.clone());
    assert!(first.eq([Participants::One(3)]), "the second window opens on entry");
    let second =
        trace.entries().iter().filter(|entry| entry.at.t == 1.0).map(|entry| entry.by.clone());
    let expected =
        [Participants::All, Participants::One(0), Participants::One(3), Participants::One(4)];
    assert!(second.eq(expected));
    assert_eq!(trace.of(0).count(), 2 + 2, "two samples, on, off");
}

#[test]
fn jumps_at_the_horizon_are_taken() {
    let (ending, trace) = run(&mut Building::with_rooms_at(&[20.0]), 1.0);
    assert_eq!(trace.entries().len(), 2);
    assert_eq!(ending.at, HybridTime { t: 1.0, j: 2 });
}

#[test]
fn systems_and_observers_can_end_a_run() {
    let (ending, _) = run(&mut Building::with_rooms_at(&[20.0]), 100.0);
    assert_eq!(ending.reason, Reason::Finished("stuffy"));
    assert_eq!(ending.at.t, 11.0);

    struct Guardian;
    impl Observer<Building> for Guardian {
        fn flows(
            &mut self,
            building: &Building,
            now: HybridTime,
            duration: f64,
        ) -> ControlFlow<&'static str> {
            assert!(duration == 1.0 || now.t + duration == 100.0);
            if building.rooms[0].0 == Heater::On {
                ControlFlow::Break("on")
            } else {
                ControlFlow::Continue(())
            }
        }
    }
    let executor = Executor::new(100.0, 10).expect("limits are valid");
    let ending = executor.run(&mut Building::with_rooms_at(&[20.0]), &mut Guardian);
    let at = HybridTime { t: 1.0, j: 2 };
    assert_eq!(ending, Ok(Ending { at, reason: Reason::Interrupted("on") }));
}

#[test]
fn a_thousand_rooms_switch_at_one_instant_in_one_round() {
    let mut building = Building::with_rooms_at(&[20.0; 1000]);
    let executor = Executor::new(1.0, 2).expect("limits are valid");
    let ending = executor.run(&mut building, &mut ()).expect("guards can be evaluated");
    assert_eq!(ending.reason, Reason::Horizon);
    assert_eq!(ending.at.j, 1 + 1000);
}
