//! What can be wrong with the parts of an automaton, and that the message names the place.

use crate::common::{HEATER, Heater, Room, Sensed, at_once, cold, fine, heater, warm};
use pleach_automaton::{
    Automaton, Builder, Current, Flow, Holds, Name, Reset, Transfer, from, places,
};
use pleach_discrete::{Row, TransitionTable, Urgency};
use pleach_guards::{Guard, Valuation, always, variable};

fn sound() -> Builder<Heater, Sensed, Room> {
    Automaton::builder(HEATER, Heater::Off).on(Sensed::Cold, cold(), Reset::identity()).on(
        Sensed::Warm,
        warm(),
        Reset::identity(),
    )
}

fn message(builder: Builder<Heater, Sensed, Room>) -> String {
    let example = Room { temperature: 0.0, measured: 0.0, openings: 0 };
    builder.build_for(&example).expect_err("the parts do not fit").to_string()
}

#[test]
fn events_need_a_guard() {
    let builder =
        Automaton::builder(HEATER, Heater::Off).on(Sensed::Cold, cold(), Reset::identity());
    assert_eq!(message(builder), "event `warm` has no guard: say when it happens with `on`");
}

#[test]
fn guards_need_a_row() {
    let text = "guard `fine` is given for event `fine`, which is in no row of the table";
    assert_eq!(message(sound().on(Sensed::Fine, fine(), Reset::identity())), text);
}

#[test]
fn nothing_is_given_twice() {
    let text = "`cold` is given its guard twice: keep one";
    assert_eq!(message(sound().on(Sensed::Cold, cold(), Reset::identity())), text);
    let still = || Flow::exact("still", |_: &mut Room, _| {});
    let builder = sound().flow(Heater::On, still()).flow(Heater::On, still());
    assert_eq!(message(builder), "`on` is given its flow twice: keep one");
}

#[test]
fn rows_do_not_contradict_each_other() {
    const TWICE: TransitionTable<Heater, Sensed> = TransitionTable::new(&[
        at_once(Heater::Off, Sensed::Cold, Heater::On),
        at_once(Heater::Off, Sensed::Cold, Heater::Off),
    ]);
    let text = "two rows of the table leave location `off` on event `cold`: keep one";
    assert_eq!(message(Automaton::builder(TWICE, Heater::Off)), text);
}

#[test]
fn the_initial_location_is_in_the_table() {
    const LOOP: TransitionTable<Heater, Sensed> =
        TransitionTable::new(&[at_once(Heater::Off, Sensed::Cold, Heater::Off)]);
    let text = "the initial location `on` occurs in no row of the table";
    assert_eq!(message(Automaton::builder(LOOP, Heater::On)), text);
}

#[test]
fn guards_and_invariants_read_variables_of_the_state() {
    let builder = sound().invariant(Heater::On, variable("humidity").at_most(1.0));
    let text = "the invariant of `on` names variable `humidity`, which the state does not have";
    assert_eq!(message(builder), text);
}

places! {
    enum Door: DoorLocation {
        Open(Open) = "open",
        Shut(Shut) = "shut",
    }
}
#[derive(Clone, Debug, PartialEq)]
struct Open;
#[derive(Clone, Debug, PartialEq)]
struct Shut;

#[derive(Debug)]
struct Hall {
    door: Current<Door>,
}

impl Valuation for Hall {
    fn value(&self, _: &str) -> Option<f64> {
        None
    }
}

impl Holds<Door> for Hall {
    type Effects = ();

    fn current(&self) -> &Current<Door> {
        &self.door
    }

    fn current_mut(&mut self) -> &mut Current<Door> {
        &mut self.door
    }

    fn carry_out(&mut self, (): ()) {}
}

#[test]
fn a_guard_of_a_transfer_is_named_by_its_event() {
    const TABLE: TransitionTable<DoorLocation, Sensed> = TransitionTable::new(&[
        at_once(DoorLocation::Open, Sensed::Cold, DoorLocation::Shut),
        at_once(DoorLocation::Shut, Sensed::Warm, DoorLocation::Open),
    ]);
    let shut = |_: &Open, _: &Hall, _: &mut ()| Shut;
    let open = |_: &Shut, _: &Hall, _: &mut ()| Open;
    let humid = variable("humidity").at_least(0.5);
    let error = Automaton::builder(TABLE, DoorLocation::Open)
        .carried_out(Transfer::new(Sensed::Cold, always(), "shut", shut))
        .carried_out(Transfer::new(Sensed::Warm, humid, "open", open))
        .build_for(&Hall { door: Current::new(Door::Open(Open)) })
        .expect_err("there is no humidity");
    let text = "the guard of `warm` names variable `humidity`, which the state does not have";
    assert_eq!(error.to_string(), text);
}

#[test]
fn guards_that_cannot_be_evaluated_are_named() {
    let damp = Guard::new("damp", variable("humidity").at_least(0.5));
    let automaton = Automaton::builder(HEATER, Heater::Off)
        .on(Sensed::Cold, damp, Reset::identity())
        .on(Sensed::Warm, warm(), Reset::identity())
        .build()
        .expect("the parts fit as far as anyone can see");
    let room = Room { temperature: 0.0, measured: 0.0, openings: 0 };
    let error = automaton.enabled(Heater::Off, &room).expect_err("there is no humidity");
    let text = "guard `damp` of event `cold` in location `off`: \
                the state has no variable `humidity`";
    assert_eq!(error.to_string(), text);
}

#[test]
fn transitions_come_in_total_order_and_may_be_asked_for() {
    const fn row(event: Sensed, urgency: Urgency, priority: u8) -> Row<Heater, Sensed> {
        Row { source: Heater::Off, event, target: Heater::On, urgency, priority }
    }
    const TABLE: TransitionTable<Heater, Sensed> = TransitionTable::new(&[
        row(Sensed::Warm, Urgency::May, 0),
        row(Sensed::Fine, Urgency::Must, 2),
        row(Sensed::Cold, Urgency::AtOnce, 1),
    ]);
    let always = || Guard::new("always", pleach_guards::always());
    let automaton: Automaton<_, _, Room> = Automaton::builder(TABLE, Heater::Off)
        .on(Sensed::Cold, cold(), Reset::identity())
        .on(Sensed::Warm, always(), Reset::identity())
        .on(Sensed::Fine, always(), Reset::identity())
        .build()
        .expect("the parts fit");
    let event_at = |measured| {
        let room = Room { temperature: 0.0, measured, openings: 0 };
        let step = automaton.enabled(Heater::Off, &room).expect("guards can be evaluated");
        step.map(|step| step.jump().event)
    };
    assert_eq!(event_at(0.0), Some(Sensed::Cold));
    assert_eq!(event_at(30.0), Some(Sensed::Fine));

    let room = Room { temperature: 0.0, measured: 30.0, openings: 0 };
    let asked = |event| {
        let step = automaton.enabled_on(event, Heater::Off, &room);
        step.expect("guards can be evaluated").is_some()
    };
    assert!(asked(Sensed::Warm) && !asked(Sensed::Cold));
}

/// The initial location comes first, then those of rows, of flows and of invariants.
#[test]
fn mentioned_locations_have_one_order_whatever_is_said_first() {
    let [start, end, moving, limited] = ["start", "end", "moving", "limited"].map(Name::new);
    let edge = || from(end).on(Name::new("return")).to(start).may(always());
    let rest = || Flow::exact("rest", |_: &mut (), _| {});
    let locations = |automaton: Builder<Name, Name, ()>| {
        automaton.build().expect("the parts fit").locations().to_vec()
    };
    let begun = || Automaton::starting_in(start);
    let expected = [start, end, moving, limited];
    let forwards = begun().transition(edge()).flow(moving, rest()).invariant(limited, always());
    assert_eq!(locations(forwards), expected);
    let backwards = begun().invariant(limited, always()).flow(moving, rest()).transition(edge());
    assert_eq!(locations(backwards), expected);
}

#[test]
fn the_graph_mirrors_the_table() {
    let automaton = heater();
    let graph = automaton.graph();
    assert_eq!((graph.node_count(), graph.edge_count()), (2, HEATER.rows().len()));
    for (edge, row) in graph.edge_indices().zip(HEATER.rows()) {
        let ends = graph.edge_endpoints(edge).map(|(from, to)| (graph[from], graph[to]));
        assert_eq!(ends, Some((row.source, row.target)));
        assert_eq!(graph[edge].event, row.event);
    }
}
