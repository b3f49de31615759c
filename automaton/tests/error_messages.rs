//! What is said about parts that do not fit: the place, what is wrong, and what would be right.
//! Every error of `build` is here, of automata and of compositions.

use pleach_automaton::{Automaton, BuildError, Composition, Reset, coordinates, from};
use pleach_discrete::{Event, Location, Row, TransitionTable, Urgency, vocabulary};
use pleach_guards::{Guard, always, proposition, variable};

vocabulary! {
    enum Lamp: Location { Off = "off", Lit = "lit", Broken = "broken" }
    enum Press: Event { Push = "push", Hold = "hold" }
}
coordinates! { struct Light { power = "p", heat = "q" } }

type Parts = pleach_automaton::Builder<Lamp, Press, Light>;

fn lamp() -> Parts {
    Automaton::starting_in(Lamp::Off)
        .initially(Light { power: 0.0, heat: 0.0 })
        .transition(from(Lamp::Off).on(Press::Push).to(Lamp::Lit).may(always()))
        .transition(from(Lamp::Lit).on(Press::Push).to(Lamp::Off).may(always()))
}

const fn row(source: Lamp, event: Press, target: Lamp) -> Row<Lamp, Press> {
    Row { source, event, target, urgency: Urgency::May, priority: 0 }
}

fn table(rows: &[Row<Lamp, Press>], initial: Lamp) -> Parts {
    Automaton::builder(TransitionTable::new(rows), initial)
}

fn light() -> Guard {
    Guard::new("bright", always())
}

/// A vocabulary whose lists lack what it has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Forgetful {
    Known,
    Forgotten,
}

impl Location for Forgetful {
    const ALL: &'static [Self] = &[Forgetful::Known];

    fn name(self) -> &'static str {
        "known"
    }
}

impl Event for Forgetful {
    const ALL: &'static [Self] = &[Forgetful::Known];

    fn name(self) -> &'static str {
        "known"
    }
}

#[test]
fn automata_say_what_does_not_fit() {
    let Light { power, heat } = Light::coordinates();
    let [off_push, off_hold] =
        [Press::Push, Press::Hold].map(|event| row(Lamp::Off, event, Lamp::Lit));
    let known = "which the state does not have";
    let expected: [(Parts, String); 16] = [
        (
            table(&[off_push], Lamp::Broken).on(Press::Push, light(), Reset::identity()),
            "the initial location `broken` occurs in no row of the table".into(),
        ),
        (
            table(&[off_push, row(Lamp::Off, Press::Push, Lamp::Broken)], Lamp::Off),
            "two rows of the table leave location `off` on event `push`: keep one".into(),
        ),
        (
            table(&[off_push, off_hold], Lamp::Off).on(Press::Push, light(), Reset::identity()),
            "event `hold` has no guard: say when it happens with `on`".into(),
        ),
        (
            table(&[off_push], Lamp::Off).on(Press::Push, light(), Reset::identity()).on(
                Press::Hold,
                light(),
                Reset::identity(),
            ),
            "guard `bright` is given for event `hold`, which is in no row of the table".into(),
        ),
        (
            table(&[off_push], Lamp::Off).on(Press::Push, light(), Reset::identity()).on(
                Press::Push,
                light(),
                Reset::identity(),
            ),
            "`push` is given its guard twice: keep one".into(),
        ),
        (
            lamp().flow(Lamp::Lit, heat.rate(1.0)).flow(Lamp::Lit, heat.rate(2.0)),
            "`lit` is given its flow twice: keep one".into(),
        ),
        (
            lamp().invariant(Lamp::Lit, always()).invariant(Lamp::Lit, always()),
            "`lit` is given its invariant twice: keep one".into(),
        ),
        (
            lamp().invariant(Lamp::Lit, variable("noise").at_most(1.0)),
            format!("the invariant of `lit` names variable `noise`, {known}"),
        ),
        (
            lamp().invariant(Lamp::Lit, proposition("plugged in")),
            format!("`lit` names proposition `plugged in`, {known}"),
        ),
        (
            lamp().transition(
                from(Lamp::Lit)
                    .on(Press::Hold)
                    .to(Lamp::Off)
                    .must(always())
                    .then(heat.becomes(variable("noise") + 1.0)),
            ),
            format!("the reset of `hold` names variable `noise`, {known}"),
        ),
        (
            lamp().flow(Lamp::Lit, [heat.rate(&power), heat.rate(1.0)]),
            "the flow of `lit` gives `q` two values: keep one".into(),
        ),
        (
            lamp().transition(
                from(Lamp::Lit)
                    .on(Press::Hold)
                    .to(Lamp::Off)
                    .must(always())
                    .then([power.becomes(0.0), power.becomes(1.0)]),
            ),
            "the reset of `hold` gives `p` two values: keep one".into(),
        ),
        (
            lamp().range(&pleach_automaton::Coordinate::new("noise"), 0.0..=1.0),
            format!("a range is declared for variable `noise`, {known}"),
        ),
        (
            lamp().range(&heat, 1.0..=0.0),
            "the range of `q` runs from 1 to 0: the first must be at most the second".into(),
        ),
        (
            lamp().transition(
                from(Lamp::Lit)
                    .on(Press::Hold)
                    .to(Lamp::Off)
                    .must(always())
                    .then(heat.becomes_within(2.0, 1.0)),
            ),
            "the reset of `hold` gives `q` a number between 2 and 1: both must be finite, and the \
             first at most the second"
                .into(),
        ),
        (
            lamp().initially(Light { power: f64::NAN, heat: 0.0 }),
            "`p` is NaN in the initial state: it must be a finite number".into(),
        ),
    ];
    for (parts, message) in expected {
        let error = parts.build().expect_err(&message);
        assert_eq!(error.to_string(), message);
    }
}

#[test]
fn parameters_say_why_they_cannot_be_set() {
    let lamp = lamp().parameter("gain", 1.0).build().expect("the parts fit");
    let why =
        |parameter: &str, value: f64| lamp.with(parameter, value).err().map(|it| it.to_string());
    assert_eq!(
        why("again", 2.0).as_deref(),
        Some("there is no parameter `again`: there is `gain`")
    );
    assert_eq!(
        why("gain", f64::NAN).as_deref(),
        Some("parameter `gain` cannot be NaN: give it a finite number")
    );
    assert_eq!(why("gain", 2.0), None);
}

#[test]
fn lists_that_lack_something_are_seen() {
    let [known, forgotten] = [Forgetful::Known, Forgetful::Forgotten];
    let build = |location, event| -> Result<_, BuildError> {
        Automaton::<_, _, Light>::starting_in(known)
            .transition(from(known).on(event).to(location).may(always()))
            .build()
    };
    let errors = [build(forgotten, known), build(known, forgotten)]
        .map(|built| built.expect_err("something is not listed").to_string());
    assert_eq!(
        errors,
        [
            "location Forgotten is missing in `Location::ALL` of its type",
            "event Forgotten is missing in `Event::ALL` of its type",
        ]
    );
}

#[test]
fn compositions_say_what_does_not_fit() {
    let Light { heat, .. } = Light::coordinates();
    let built = |parts: Parts| parts.build().expect("the parts fit");
    let lamp_of = |name: &str| Composition::builder().add(name, &built(lamp()));
    let pair = || lamp_of("left").add("right", &built(lamp()));
    let nowhere = Automaton::<Lamp, Press, Light>::starting_in(Lamp::Off).build();
    let warming = built(lamp().flow(Lamp::Lit, heat.rate(1.0)));
    let misread = "cannot be connected to";
    let expected = [
        (Composition::builder(), "a composition needs at least one component".to_owned()),
        (pair().add("left", &built(lamp())), "two components are called `left`: rename one".into()),
        (
            lamp_of("left.right"),
            "`left.right` cannot name a component: names stand before a dot and between commas, so they \
             cannot be empty, nor have a dot, a comma, a quotation mark or a line break"
                .into(),
        ),
        (
            Composition::builder().add("lamp", &nowhere.expect("the parts fit")),
            "component `lamp` has no initial state: give its automaton one with `initially`, or \
             add it with `add_in`"
                .into(),
        ),
        (
            lamp_of("left").add_in("right", &built(lamp()), Light { power: 0.0, heat: f64::NAN }),
            "`q` of component `right` is NaN in the initial state: it must be a number".into(),
        ),
        (pair().label("knock"), "label `knock` is an event of no component".into()),
        (pair().rename("knock", "push"), "the component added last has no event `knock`".into()),
        (
            pair().connect("left.q", "right.noise"),
            "no component has the variable `right.noise`: `right` has `p`, `q`".into(),
        ),
        (
            pair().connect("up.q", "left.q"),
            "no component has the variable `up.q`: write `component.coordinate`, of a component among \
             `left`, `right`"
                .into(),
        ),
        (
            pair().add("dim", &built(lamp().signal("half", 0.5 * &heat))).connect("left.q", "dim.half"),
            format!("input `dim.half` {misread} `left.q`: it is a signal, and only coordinates can be inputs"),
        ),
        (
            pair().connect("left.q", "left.q"),
            format!("input `left.q` {misread} `left.q`: a coordinate cannot read itself"),
        ),
        (
            pair().connect("left.q", "right.q").connect("left.p", "right.q"),
            format!("input `right.q` {misread} `left.p`: it is connected already"),
        ),
        (
            pair().connect("left.q", "right.q").connect("right.q", "left.p"),
            format!(
                "input `left.p` {misread} `right.q`: an input cannot be read in turn: connect \
                 both to the coordinate itself"
            ),
        ),
        (
            lamp_of("left").add("right", &warming).connect("left.q", "right.q"),
            "component `right` changes `q` in location `lit`, but reads it from another component"
                .into(),
        ),
    ];
    for (parts, message) in expected {
        let error = parts.build().err().unwrap_or_else(|| panic!("no error: {message}"));
        assert_eq!(error.to_string(), message);
    }
}
