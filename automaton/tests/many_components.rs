//! A thousand identical components whose guards become true at the same instant.

use pleach_automaton::{Automaton, Composition, Reason, Trajectory, coordinates, from};
use pleach_discrete::vocabulary;

vocabulary! {
    enum Heater: Location { Off = "off", On = "on" }
    enum Sensed: Event { Cold = "cold", Warm = "warm" }
}
coordinates! {
    struct Room { temperature = "T" }
}
use Heater::{Off, On};
use Sensed::{Cold, Warm};

const ROOMS: usize = 1000;

/// Cools by one degree a second from 20 to 18, then warms by two degrees a second up to 22.
fn room() -> Automaton<Heater, Sensed, Room> {
    let Room { temperature } = Room::coordinates();
    Automaton::starting_in(Off)
        .initially(Room { temperature: 20.0 })
        .flow(Off, temperature.rate(-1.0))
        .flow(On, temperature.rate(2.0))
        .transition(from(Off).on(Cold).to(On).must(temperature.at_most(18.0)))
        .transition(from(On).on(Warm).to(Off).must(temperature.at_least(22.0)))
        .build()
        .expect("the room is sound")
}

fn house(label: bool) -> Composition {
    let room = room();
    let rooms = (0..ROOMS).map(|number| format!("room {number}"));
    let house = rooms.fold(Composition::builder(), |house, name| house.add(&name, &room));
    let house = if label { house.label("cold") } else { house };
    house.build().expect("the house is sound")
}

fn run(house: &Composition) -> Trajectory {
    let trajectory = house.run(5.0).expect("the house can be run");
    assert_eq!(trajectory.ending().reason, Reason::Horizon);
    trajectory
}

#[test]
fn each_jumps_once_in_the_order_of_components() {
    let trajectory = run(&house(false));
    let (cold, warm) = trajectory.jumps().split_at(ROOMS);
    for (jumps, t, label) in [(cold, 2.0, "cold"), (warm, 4.0, "warm")] {
        assert_eq!(jumps.len(), ROOMS);
        let instant = jumps[0].at.t;
        assert!((instant - t).abs() < 1e-14);
        assert!(jumps.iter().all(|jump| jump.at.t == instant && jump.label == label));
        let movers = jumps.iter().map(|jump| jump.moves[0].component);
        assert!(movers.eq(0..ROOMS));
    }
    let numbers = trajectory.jumps().iter().map(|jump| jump.at.j);
    assert!(numbers.eq(0..2 * ROOMS as u32));
    let last = trajectory.value("room 999.T", 5.0);
    assert!(last.is_ok_and(|temperature| (temperature - 21.0).abs() < 1e-12));
}

#[test]
fn with_a_label_all_jump_as_one() {
    let trajectory = run(&house(true));
    assert_eq!(trajectory.jumps()[0].moves.len(), ROOMS);
    assert_eq!(trajectory.jumps().len(), 1 + ROOMS);
}

#[test]
fn a_recorded_run_happens_again_to_the_bit() {
    let house = house(true);
    let trajectory = run(&house);
    let mut file = Vec::new();
    trajectory.write(&mut file).expect("memory can be written");
    let read = Trajectory::read(&file[..]).expect("it can be read");
    assert_eq!(read, trajectory);
    assert_eq!(house.replay(&read), Ok(()));

    let digits = String::from_utf8(file).expect("JSON is text");
    let other = digits.replacen("20.0", "20.000000000000004", 1);
    let other = Trajectory::read(other.as_bytes()).expect("it can be read");
    assert_eq!(
        house.replay(&other).map_err(|error| error.to_string()),
        Err("from (0 s, 0) on the run differs from what was recorded".to_owned())
    );
}
