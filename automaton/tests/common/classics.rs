//! Small models as textbooks show them, for everything that is drawn.

use pleach_automaton::{Automaton, Composition, CompositionBuilder, coordinates, from};
use pleach_discrete::vocabulary;
use pleach_guards::always;

vocabulary! {
    pub enum Motion: Location { Falling = "falling" }
    pub enum Contact: Event { Bounce = "bounce" }
    pub enum Heater: Location { Off = "off", On = "on" }
    pub enum Controller: Location { Watching = "watching" }
    pub enum Switch: Event { TurnOn = "turn on", TurnOff = "turn off" }
    pub enum Gear: Location { First = "first", Second = "second", Third = "third", Fourth = "fourth" }
    pub enum Shift: Event { Up = "up", Down = "down", Stall = "stall", Kick = "kick down", Tick = "tick" }
}

coordinates! {
    pub struct Ball { height = "h", velocity = "v" }
    pub struct Room { temperature = "T" }
    pub struct Reading { seen = "T" }
    pub struct Car { speed = "v", clock = "τ" }
}

/// A ball that loses a fifth of its speed when it bounces.
pub fn ball() -> Automaton<Motion, Contact, Ball> {
    let Ball { height, velocity } = Ball::coordinates();
    Automaton::starting_in(Motion::Falling)
        .initially(Ball { height: 10.0, velocity: 0.0 })
        .flow(Motion::Falling, [height.rate(&velocity), velocity.rate(-9.81)])
        .invariant(Motion::Falling, height.at_least(0.0))
        .transition(
            from(Motion::Falling)
                .on(Contact::Bounce)
                .to(Motion::Falling)
                .must(height.at_most(0.0) & velocity.less_than(0.0))
                .then([velocity.becomes(-0.8 * &velocity)]),
        )
        .build()
        .expect("the model is sound")
}

/// A heater that keeps a room between 18 °C and 22 °C.
pub fn thermostat() -> Automaton<Heater, Switch, Room> {
    use Heater::{Off, On};
    let Room { temperature } = Room::coordinates();
    Automaton::starting_in(Off)
        .initially(Room { temperature: 20.0 })
        .flow(Off, temperature.rate(-0.1 * &temperature))
        .flow(On, temperature.rate(5.0 - 0.1 * &temperature))
        .invariant(Off, temperature.at_least(18.0))
        .invariant(On, temperature.at_most(22.0))
        .transition(from(Off).on(Switch::TurnOn).to(On).must(temperature.at_most(18.0)))
        .transition(from(On).on(Switch::TurnOff).to(Off).must(temperature.at_least(22.0)))
        .build()
        .expect("the model is sound")
}

/// A heater that only does as it is told, and a controller that sees the temperature.
pub fn house() -> Composition {
    house_parts().build().expect("the parts fit")
}

/// The same, for more to be added.
pub fn house_parts() -> CompositionBuilder {
    use Heater::{Off, On};
    use Switch::{TurnOff, TurnOn};
    let Room { temperature } = Room::coordinates();
    let heater = Automaton::starting_in(Off)
        .initially(Room { temperature: 20.0 })
        .flow(Off, temperature.rate(-0.1 * &temperature))
        .flow(On, temperature.rate(5.0 - 0.1 * &temperature))
        .transition(from(Off).on(TurnOn).to(On).may(always()))
        .transition(from(On).on(TurnOff).to(Off).may(always()))
        .build()
        .expect("the model is sound");
    let Reading { seen } = Reading::coordinates();
    let watching = Controller::Watching;
    let controller = Automaton::starting_in(watching)
        .initially(Reading { seen: 20.0 })
        .transition(from(watching).on(TurnOn).to(watching).must(seen.at_most(18.0)))
        .transition(from(watching).on(TurnOff).to(watching).must(seen.at_least(22.0)))
        .build()
        .expect("the model is sound");
    Composition::builder()
        .add("heater", &heater)
        .add("controller", &controller)
        .connect("heater.T", "controller.T")
        .label("turn on")
        .label("turn off")
}

/// Four gears with transitions of every kind: between neighbours, over several locations, loops,
/// and of every urgency.
pub fn gears() -> Automaton<Gear, Shift, Car> {
    use Gear::{First, Fourth, Second, Third};
    use Shift::{Down, Kick, Stall, Tick, Up};
    let Car { speed, clock } = Car::coordinates();
    let restart = || [clock.becomes(0.0)];
    let shift = |source, target, bound: f64| {
        from(source).on(Up).to(target).must(speed.at_least(bound)).then(restart())
    };
    let back = |source, target, bound: f64| {
        from(source).on(Down).to(target).at_once(speed.at_most(bound)).then(restart())
    };
    let rolling = speed.at_least(0.0) & clock.at_most(60.0);
    Automaton::starting_in(First)
        .initially(Car { speed: 0.0, clock: 0.0 })
        .flow(First, [speed.rate(2.0), clock.rate(1.0)])
        .flow(Second, [speed.rate(1.5 - 0.01 * speed.power(2.0)), clock.rate(1.0)])
        .flow(Third, [speed.rate(0.5), clock.rate(1.0)])
        .flow(Fourth, clock.rate(1.0))
        .invariant(Second, rolling)
        .transition(shift(First, Second, 5.0))
        .transition(shift(Second, Third, 10.0))
        .transition(shift(Third, Fourth, 20.0))
        .transition(back(Second, First, 3.0))
        .transition(back(Third, Second, 8.0))
        .transition(back(Fourth, Third, 16.0))
        .transition(
            from(Fourth)
                .on(Stall)
                .to(First)
                .must(speed.at_most(1.0) & clock.at_least(2.0))
                .then([speed.becomes(0.0), clock.becomes(0.0)])
                .priority(1),
        )
        .transition(from(Fourth).on(Kick).to(Second).may(speed.less_than(18.0)))
        .transition(from(First).on(Kick).to(Third).may(speed.more_than(4.0)))
        .transition(from(Second).on(Tick).to(Second).may(clock.at_least(1.0)).then(restart()))
        .transition(from(Fourth).on(Tick).to(Fourth).must(clock.at_least(5.0)).then(restart()))
        .build()
        .expect("the model is sound")
}
