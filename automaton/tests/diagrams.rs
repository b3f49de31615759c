//! Diagrams show every part of an automaton.

use crate::common::{Heater, Room, Sensed, heater, window};
use pleach_automaton::{Automaton, Reset, diagram};
use pleach_discrete::{Event, Location, Row, TransitionTable, Urgency};
use pleach_guards::{Guard, always, variable};
use proptest::prelude::*;
use std::collections::BTreeSet;

#[test]
fn mermaid_is_complete() {
    let expected = "\
stateDiagram-v2
    l0 : off
    l0 : Ṫ = −1
    l1 : on
    l1 : Ṫ = 2
    l1 : while temperature ≤ 25
    [*] --> l0
    l0 --> l1 : cold [measured ≤ 19] (at once, 0)
    l1 --> l0 : warm [measured ≥ 21] (at once, 0)
";
    assert_eq!(diagram::mermaid(&heater()), expected);
}

#[test]
fn dot_is_complete() {
    let expected = r#"digraph automaton {
    node [shape=box, style=rounded, fontname="sans-serif"];
    edge [fontname="sans-serif", fontsize=11];
    initial [shape=point];
    l0 [label="shut"];
    l1 [label="open"];
    initial -> l0;
    l0 -> l1 [label="warm\n[measured ≥ 21]\n/ openings + 1\n(at once, 0)", style=bold];
    l1 -> l0 [label="fine\n[measured ≤ 20]\n(at once, 0)", style=bold];
}
"#;
    assert_eq!(diagram::dot(&window()), expected);
}

#[test]
fn the_table_is_complete() {
    let expected = "\
| location | cold | warm | fine |
| --- | --- | --- | --- |
| **shut** | — | open | — |
| **open** | — | — | shut |

| event | guard | holds where | reset |
| --- | --- | --- | --- |
| **warm** | warm | measured ≥ 21 | openings + 1 |
| **fine** | fine | measured ≤ 20 | — |
";
    assert_eq!(diagram::table(&window()), expected);
}

/// An automaton whose texts hold every character that a format could take for its own.
fn awkward() -> Automaton<Heater, Sensed, Room> {
    const TABLE: TransitionTable<Heater, Sensed> = TransitionTable::new(&[Row {
        source: Heater::Off,
        event: Sensed::Cold,
        target: Heater::Off,
        urgency: Urgency::May,
        priority: 3,
    }]);
    let guard = Guard::new("odd", variable("a\"b").abs().less_than(1.0));
    Automaton::builder(TABLE, Heater::Off)
        .on(Sensed::Cold, guard, Reset::new("x := {1; 2} \\ #3 & <4>", |_| {}))
        .build()
        .expect("the parts fit")
}

#[test]
fn formats_are_escaped() {
    let mermaid = diagram::mermaid(&awkward());
    let label =
        "cold [|`a#34;b`| #60; 1] / x #58;= #123;1#59; 2#125; #92; #35;3 & #60;4#62; (may, 3)";
    assert!(mermaid.contains(label), "{mermaid}");
    let dot = diagram::dot(&awkward());
    assert!(dot.contains(r#"[|`a\"b`| < 1]\n/ x := {1; 2} \\ #3 & <4>\n(may, 3)""#), "{dot}");
    assert!(diagram::table(&awkward()).contains(r#"\|`a"b`\| < 1"#));
    let svg = diagram::svg(&awkward());
    assert!(svg.contains(r"/ x := {1; 2} \ #3 &amp; &lt;4&gt;"), "{svg}");
}

#[test]
fn pictures_show_every_label_and_are_the_same_every_time() {
    for svg in [diagram::svg(&heater()), diagram::svg(&awkward())] {
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    }
    let svg = diagram::svg(&heater());
    for label in ["off", "on", "Ṫ = −1", "while temperature ≤ 25", "[measured ≤ 19]", "at once"]
    {
        assert!(svg.lines().any(|line| line == label), "{label}");
    }
    let heads = svg.matches("url(#head)").count();
    assert_eq!(heads, 1 + 2 + 1, "the initial arrow, two transitions, and the key");
}

/// A number out of six, as a location and as an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Number(usize);

const NUMBERS: [Number; 6] = [Number(0), Number(1), Number(2), Number(3), Number(4), Number(5)];
const NAMES: [&str; 6] = ["zero", "one", "two", "three", "four", "five"];

impl Location for Number {
    const ALL: &'static [Self] = &NUMBERS;

    fn name(self) -> &'static str {
        NAMES[self.0]
    }
}

impl Event for Number {
    const ALL: &'static [Self] = &NUMBERS;

    fn name(self) -> &'static str {
        NAMES[self.0]
    }
}

proptest! {
    #![proptest_config(cases::usually(100))]

    #[test]
    fn any_graph_can_be_drawn(targets in prop::collection::btree_map((0..6usize, 0..6usize), 0..6usize, 0..16)) {
        let row = |((source, event), target): (&(usize, usize), &usize)| Row {
            source: Number(*source),
            event: Number(*event),
            target: Number(*target),
            urgency: Urgency::Must,
            priority: 0,
        };
        let rows: Vec<_> = targets.iter().map(row).collect();
        let initial = rows.first().map_or(Number(0), |row| row.source);
        let table = TransitionTable::new(rows.leak());
        let occurs = |event: &&Number| table.rows().iter().any(|row| row.event == **event);
        let automaton = NUMBERS
            .iter()
            .filter(occurs)
            .fold(Automaton::<_, _, Room>::builder(table, initial), |builder, &event| {
                builder.on(event, Guard::new("always", always()), Reset::identity())
            })
            .build()
            .expect("the parts fit");
        let svg = diagram::svg(&automaton);
        prop_assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}", svg);
        let dots = svg.matches("<circle class=\"dot\"").count();
        prop_assert_eq!(dots, 1 + targets.len(), "the initial dot, and where each transition begins");
        let arrows: BTreeSet<_> = targets
            .iter()
            .map(|((source, event), target)| (event, target, source.cmp(target)))
            .collect();
        prop_assert_eq!(svg.matches("url(#head)").count(), 1 + arrows.len());
        let rows: BTreeSet<_> = arrows.iter().map(|(event, target, _)| (event, target)).collect();
        prop_assert_eq!(svg.matches("[always]").count(), rows.len());
        prop_assert_eq!(diagram::svg(&automaton), svg);
    }
}
