//! Rooms with a heater and a window, which a common clock measures.
//!
//! Heater and window of a room are two automata over one state, the room. A heater warms by 2 °C/s
//! and without it a room cools by 1 °C/s, so that every run has a closed form.

pub mod body;
pub mod classics;

use pleach_automaton::{Automaton, Flow, Reset};
use pleach_discrete::{Event, Location, Row, TransitionTable, Urgency};
use pleach_guards::{Guard, Valuation, variable};

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Heater {
    Off,
    On,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Window {
    Shut,
    Open,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sensed {
    Cold,
    Warm,
    Fine,
}

impl Location for Heater {
    const ALL: &'static [Self] = &[Heater::Off, Heater::On];

    fn name(self) -> &'static str {
        match self {
            Heater::Off => "off",
            Heater::On => "on",
        }
    }
}

impl Location for Window {
    const ALL: &'static [Self] = &[Window::Shut, Window::Open];

    fn name(self) -> &'static str {
        match self {
            Window::Shut => "shut",
            Window::Open => "open",
        }
    }
}

impl Event for Sensed {
    const ALL: &'static [Self] = &[Sensed::Cold, Sensed::Warm, Sensed::Fine];

    fn name(self) -> &'static str {
        match self {
            Sensed::Cold => "cold",
            Sensed::Warm => "warm",
            Sensed::Fine => "fine",
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Room {
    pub temperature: f64,
    pub measured: f64,
    pub openings: u32,
}

impl Valuation for Room {
    fn value(&self, variable: &str) -> Option<f64> {
        match variable {
            "temperature" => Some(self.temperature),
            "measured" => Some(self.measured),
            _ => None,
        }
    }
}

pub const fn at_once<L: Copy>(source: L, event: Sensed, target: L) -> Row<L, Sensed> {
    Row { source, event, target, urgency: Urgency::AtOnce, priority: 0 }
}

pub const HEATER: TransitionTable<Heater, Sensed> = TransitionTable::new(&[
    at_once(Heater::Off, Sensed::Cold, Heater::On),
    at_once(Heater::On, Sensed::Warm, Heater::Off),
]);

pub const WINDOW: TransitionTable<Window, Sensed> = TransitionTable::new(&[
    at_once(Window::Shut, Sensed::Warm, Window::Open),
    at_once(Window::Open, Sensed::Fine, Window::Shut),
]);

pub fn cold() -> Guard {
    Guard::new("cold", variable("measured").at_most(19.0))
}

pub fn warm() -> Guard {
    Guard::new("warm", variable("measured").at_least(21.0))
}

pub fn fine() -> Guard {
    Guard::new("fine", variable("measured").at_most(20.0))
}

pub fn heater() -> Automaton<Heater, Sensed, Room> {
    Automaton::builder(HEATER, Heater::Off)
        .on(Sensed::Cold, cold(), Reset::identity())
        .on(Sensed::Warm, warm(), Reset::identity())
        .flow(Heater::Off, Flow::exact("Ṫ = −1", |room: &mut Room, time| room.temperature -= time))
        .flow(
            Heater::On,
            Flow::exact("Ṫ = 2", |room: &mut Room, time| room.temperature += 2.0 * time),
        )
        .invariant(Heater::On, variable("temperature").at_most(25.0))
        .build()
        .expect("the parts fit")
}

pub fn window() -> Automaton<Window, Sensed, Room> {
    let count = Reset::new("openings + 1", |room: &mut Room| room.openings += 1);
    Automaton::builder(WINDOW, Window::Shut)
        .on(Sensed::Warm, warm(), count)
        .on(Sensed::Fine, fine(), Reset::identity())
        .build()
        .expect("the parts fit")
}
