//! Compositions with one fault each.

use pleach_automaton::check::Kind;
use pleach_automaton::{Automaton, Composition, coordinates, from};
use pleach_discrete::vocabulary;
use pleach_guards::always;

use super::{faults, notes};

vocabulary! {
    enum Door: Location { Open = "open", Shut = "shut", Locked = "locked" }
    enum Handle: Event { Close = "close", Lock = "lock", Unlock = "unlock" }
    enum Guard: Location { Awake = "awake", Asleep = "asleep" }
    enum Duty: Event { Lock = "lock", Doze = "doze", Unlock = "unlock" }
    enum Dog: Location { Lying = "lying" }
    enum Bark: Event { Bark = "bark" }
}
coordinates! {
    struct Wear { angle = "α" }
    struct Watch { seen = "α", night = "n" }
}

type DoorParts = pleach_automaton::Builder<Door, Handle, Wear>;
type GuardParts = pleach_automaton::Builder<Guard, Duty, Watch>;

fn door() -> DoorParts {
    let Wear { angle } = Wear::coordinates();
    Automaton::starting_in(Door::Open)
        .initially(Wear { angle: 1.0 })
        .range(&angle, 0.0..=1.0)
        .flow(Door::Open, angle.rate(-1.0))
        .transition(from(Door::Open).on(Handle::Close).to(Door::Shut).must(angle.at_most(0.0)))
        .transition(from(Door::Shut).on(Handle::Lock).to(Door::Locked).may(always()))
        .transition(from(Door::Locked).on(Handle::Unlock).to(Door::Shut).may(always()))
}

fn guard() -> GuardParts {
    let Watch { seen, night } = Watch::coordinates();
    let [awake, asleep] = [Guard::Awake, Guard::Asleep];
    Automaton::starting_in(awake)
        .initially(Watch { seen: 0.0, night: 0.0 })
        .flow(awake, night.rate(1.0))
        .flow(asleep, night.rate(1.0))
        .transition(from(awake).on(Duty::Lock).to(awake).must(seen.at_most(0.0)))
        .transition(from(awake).on(Duty::Unlock).to(awake).may(night.at_least(3.0)))
        .transition(from(awake).on(Duty::Doze).to(asleep).may(night.at_least(9.0)))
}

fn house(door: DoorParts, guard: GuardParts) -> pleach_automaton::CompositionBuilder {
    Composition::builder()
        .add("door", &door.build().expect("the door fits"))
        .add("guard", &guard.build().expect("the guard fits"))
        .connect("door.α", "guard.α")
}

fn check(house: pleach_automaton::CompositionBuilder, expected: &[&str]) {
    let report = house.build().expect("the components fit").check();
    assert_eq!(faults(&report), expected, "{report}");
    assert_eq!(notes(&report), 0, "{report}");
}

#[test]
fn a_door_and_its_guard_are_sound() {
    check(house(door(), guard()).label("lock").label("unlock"), &[]);
}

#[test]
fn labels_that_no_other_component_has() {
    let expected = ["warning: lonely label: component `guard`, on `doze`"];
    check(house(door(), guard()).label("lock").label("unlock").label("doze"), &expected);
}

#[test]
fn labels_that_a_component_never_takes() {
    let Watch { seen, night } = Watch::coordinates();
    let [awake, asleep] = [Guard::Awake, Guard::Asleep];
    let forgetful = Automaton::starting_in(awake)
        .initially(Watch { seen: 0.0, night: 0.0 })
        .transition(from(awake).on(Duty::Lock).to(awake).must(seen.at_most(0.0)))
        .transition(from(awake).on(Duty::Doze).to(asleep).may(night.at_least(9.0)));
    let expected = ["error: refused label: component `guard`, on `unlock`"];
    check(house(door(), forgetful).label("lock").label("unlock"), &expected);
}

#[test]
fn labels_whose_takers_never_meet() {
    let Wear { angle } = Wear::coordinates();
    let Watch { seen, night } = Watch::coordinates();
    let [awake, asleep] = [Guard::Awake, Guard::Asleep];
    // It opens only together with a guard who has fallen asleep at locking, and says so by `doze`.
    let door = Automaton::starting_in(Door::Open)
        .initially(Wear { angle: 1.0 })
        .flow(Door::Open, angle.rate(-1.0))
        .transition(from(Door::Open).on(Handle::Lock).to(Door::Shut).may(always()))
        .transition(from(Door::Open).on(Handle::Unlock).to(Door::Open).may(always()))
        .transition(from(Door::Shut).on(Handle::Close).to(Door::Locked).may(angle.at_most(0.5)));
    let guard = Automaton::starting_in(awake)
        .initially(Watch { seen: 0.0, night: 0.0 })
        .transition(from(awake).on(Duty::Lock).to(asleep).may(seen.at_most(0.5)))
        .transition(from(asleep).on(Duty::Unlock).to(awake).may(night.at_least(0.0)));
    let expected = ["error: blocked label: on `unlock`"];
    check(house(door, guard).label("lock").label("unlock"), &expected);
}

#[test]
fn waiting_for_a_partner_who_has_gone() {
    let Watch { seen, night } = Watch::coordinates();
    let [awake, asleep] = [Guard::Awake, Guard::Asleep];
    let wear = Wear::coordinates();
    let hurried = Automaton::starting_in(Door::Open)
        .initially(Wear { angle: 1.0 })
        .range(&wear.angle, 0.0..=1.0)
        .flow(Door::Open, wear.angle.rate(-1.0))
        .transition(from(Door::Open).on(Handle::Close).to(Door::Shut).must(wear.angle.at_most(0.0)))
        .transition(from(Door::Shut).on(Handle::Lock).to(Door::Locked).at_once(always()))
        .transition(from(Door::Locked).on(Handle::Unlock).to(Door::Shut).may(always()));
    let guard = Automaton::starting_in(awake)
        .initially(Watch { seen: 0.0, night: 0.0 })
        .flow(awake, night.rate(1.0))
        .transition(from(awake).on(Duty::Lock).to(awake).may(seen.at_most(0.0)))
        .transition(from(awake).on(Duty::Unlock).to(awake).may(seen.at_most(0.0)));
    let weary = guard.clone().transition(from(awake).on(Duty::Doze).to(asleep).may(always()));
    let expected = ["warning: deadlock: component `door`, location `shut`, on `lock`"];
    check(house(hurried.clone(), weary).label("lock").label("unlock"), &expected);

    // Whether the guard falls asleep before the door is shut is a question of time.
    let late = guard.transition(from(awake).on(Duty::Doze).to(asleep).may(night.at_least(9.0)));
    let house = house(hurried, late).label("lock").label("unlock").build();
    let report = house.expect("the components fit").check();
    assert!(report.is_sound(), "{report}");
    let note = report.findings().iter().find(|one| one.kind == Kind::Deadlock);
    assert!(note.is_some_and(|note| note.message.contains("is open")), "{report}");
}

vocabulary! {
    pub enum Train: Location { Far = "far", Near = "near", Past = "past" }
    pub enum Rail: Event { Approach = "approach", In = "in", Exit = "exit" }
    pub enum Bar: Location {
        Up = "up", Falling = "falling", Down = "down", Rising = "rising",
    }
    pub enum Drive: Event {
        Lower = "lower", Raise = "raise", IsDown = "is down", IsUp = "is up",
    }
    pub enum Post: Location { Idle = "idle", AboutToLower = "about to lower", AboutToRaise = "about to raise" }
    pub enum Signal: Event {
        Approach = "approach", Exit = "exit", Lower = "lower", Raise = "raise",
    }
}
coordinates! {
    pub struct Way { place = "x" }
    pub struct Slope { slope = "g" }
    pub struct Delay { since = "z" }
}

/// The train, the gate and their controller, as in Henzinger's *The Theory of Hybrid Automata*
/// (1996): the gate is down in time, which locations alone do not show.
#[test]
fn train_and_gate() {
    let Way { place } = Way::coordinates();
    let train = Automaton::starting_in(Train::Far)
        .initially(Way { place: 5000.0 })
        .range(&place, -200.0..=5000.0)
        .flow(Train::Far, place.rate(-45.0))
        .flow(Train::Near, place.rate(-45.0))
        .flow(Train::Past, place.rate(-45.0))
        .invariant(Train::Far, place.at_least(1000.0))
        .invariant(Train::Near, place.at_least(0.0))
        .invariant(Train::Past, place.at_least(-100.0))
        .transition(from(Train::Far).on(Rail::Approach).to(Train::Near).must(place.at_most(1000.0)))
        .transition(from(Train::Near).on(Rail::In).to(Train::Past).must(place.at_most(0.0)))
        .transition(
            from(Train::Past)
                .on(Rail::Exit)
                .to(Train::Far)
                .must(place.at_most(-100.0))
                .then(place.becomes(2000.0)),
        )
        .build()
        .expect("the train fits");
    let Slope { slope } = Slope::coordinates();
    let gate = Automaton::starting_in(Bar::Up)
        .initially(Slope { slope: 90.0 })
        .range(&slope, 0.0..=90.0)
        .flow(Bar::Falling, slope.rate(-9.0))
        .flow(Bar::Rising, slope.rate(9.0))
        .invariant(Bar::Falling, slope.at_least(0.0))
        .invariant(Bar::Rising, slope.at_most(90.0))
        .transition(from(Bar::Up).on(Drive::Lower).to(Bar::Falling).may(always()))
        .transition(from(Bar::Falling).on(Drive::IsDown).to(Bar::Down).must(slope.at_most(0.0)))
        .transition(from(Bar::Down).on(Drive::Raise).to(Bar::Rising).may(always()))
        .transition(from(Bar::Rising).on(Drive::Lower).to(Bar::Falling).may(always()))
        .transition(from(Bar::Rising).on(Drive::IsUp).to(Bar::Up).must(slope.at_least(90.0)))
        .build()
        .expect("the gate fits");
    let Delay { since } = Delay::coordinates();
    let [idle, lowering, raising] = [Post::Idle, Post::AboutToLower, Post::AboutToRaise];
    let controller = Automaton::starting_in(idle)
        .initially(Delay { since: 0.0 })
        .range(&since, 0.0..=10.0)
        .flow(lowering, since.rate(1.0))
        .flow(raising, since.rate(1.0))
        .transition(
            from(idle).on(Signal::Approach).to(lowering).may(always()).then(since.becomes(0.0)),
        )
        .transition(from(idle).on(Signal::Exit).to(raising).may(always()).then(since.becomes(0.0)))
        .transition(from(lowering).on(Signal::Lower).to(idle).must(since.at_least(5.0)))
        .transition(from(raising).on(Signal::Raise).to(idle).must(since.at_least(5.0)))
        .build()
        .expect("the controller fits");
    let crossing = Composition::builder()
        .add("train", &train)
        .add("gate", &gate)
        .add("controller", &controller);
    let labels = ["approach", "exit", "lower", "raise"];
    let crossing = labels.into_iter().fold(crossing, |crossing, label| crossing.label(label));
    let crossing = crossing.build().expect("the components fit");
    let report = crossing.check();
    assert!(report.is_sound(), "{report}");
    let trajectory = crossing.run(500.0).expect("it can be run");
    assert_eq!(trajectory.ending().at.t, 500.0, "{:?}", trajectory.ending());
}

#[test]
fn inputs_that_are_never_read() {
    let dog = Automaton::<Dog, Bark, Watch>::starting_in(Dog::Lying)
        .initially(Watch { seen: 0.0, night: 0.0 })
        .transition(
            from(Dog::Lying)
                .on(Bark::Bark)
                .to(Dog::Lying)
                .may(Watch::coordinates().night.at_least(1.0)),
        )
        .build()
        .expect("the dog fits");
    let yard = house(door(), guard())
        .add("dog", &dog)
        .connect("door.α", "dog.α")
        .label("lock")
        .label("unlock");
    check(yard, &["warning: unread input: component `dog`, variable `α`"]);
}

#[test]
fn faults_of_components_name_them() {
    let Watch { seen, .. } = Watch::coordinates();
    let [awake, asleep] = [Guard::Awake, Guard::Asleep];
    // The door's angle is at most 1, which the guard's reading inherits.
    let alarmed = guard().transition(from(asleep).on(Duty::Lock).to(awake).may(seen.at_least(2.0)));
    let expected = ["warning: never fires: component `guard`, location `asleep`, on `lock`"];
    check(house(door(), alarmed).label("lock").label("unlock"), &expected);
}

#[test]
fn what_is_noted_of_several_components_is_noted_once() {
    let Wear { angle } = Wear::coordinates();
    let free = Automaton::<_, Handle, _>::starting_in(Door::Open)
        .initially(Wear { angle: 1.0 })
        .transition(from(Door::Open).on(Handle::Close).to(Door::Shut).may(angle.at_least(0.0)))
        .transition(from(Door::Open).on(Handle::Lock).to(Door::Locked).may(angle.at_least(0.5)))
        .build()
        .expect("the door fits");
    let doors = Composition::builder().add("left", &free).add("right", &free).add("back", &free);
    let report = doors.build().expect("the doors fit").check();
    assert!(report.is_sound(), "{report}");
    let [note] = report.findings() else { panic!("{report}") };
    assert_eq!(note.place.component.as_deref(), Some("left"));
    assert!(note.message.ends_with("; likewise in `right`, `back`"), "{note}");
}
